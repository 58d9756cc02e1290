"""Every key of a bowl file, once: checks, defaults and documentation are all read from here."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from feederscrew.base import units
from feederscrew.base.errors import FeederError
from feederscrew.base.signatures import Keywords
from feederscrew.bowl.friction_table import FAMILIES, LININGS
from feederscrew.bowl.record import Machine, Unbalance


@dataclass(frozen=True)
class Key:
    """One value a bowl file may give."""

    name: str  # 'drive.amplitude', as in --set
    field: str  # of the Bowl record; two keys of one field exclude each other
    dimension: str  # of units.UNITS_BY_DIMENSION
    lowest: str
    highest: str
    default: str  # a value as typed, or the name of the key whose value is taken
    meaning: str
    share: float = 1.0  # the field's value over the key's
    choices: tuple[str, ...] = ()  # words of which it is one; then it has no unit and no size

    @property
    def section(self) -> str:
        """'drive' of drive.amplitude; '' at the top level."""
        return self.name.rpartition(".")[0]

    @property
    def word(self) -> str:
        """'amplitude' of drive.amplitude: the key as the file has it."""
        return self.name.rpartition(".")[2]

    @property
    def unit(self) -> str:
        """The unit of its lowest value, in which we show it."""
        return "" if self.choices else units.split(self.lowest)[1]

    @property
    def bounds(self) -> str:
        """Return what it may be, for people: '0 mm to 20 mm', 'right or left'."""
        return " or ".join(self.choices) if self.choices else f"{self.lowest} to {self.highest}"

    def value(self, text: str) -> float | str:
        """Return a value as typed: in SI units, or the word.

        Parameters
        ----------
        text : str

        Returns
        -------
        float [SI] or str

        Raises
        ------
        QuantityError
            If it is neither.
        """
        if not self.choices:
            return units.quantity(text, self.dimension, suggest=self.unit)
        words = {_plainly(choice): choice for choice in self.choices}
        word = words.get(_plainly(text))
        if word is None:
            raise units.QuantityError(f"{units.quantity_text(text)} is not known", f"write {self.bounds}")
        return word

    @property
    def column(self) -> str:
        """Name of a table's column of its values: 'amplitude_mm'."""
        return f"{self.word}_{self.unit}".replace("/", "_").rstrip("_")


def _plainly(text: str) -> str:
    """A word without its spaces and in small letters: '60 Hz' is '60hz'."""
    return "".join(text.split()).casefold()


def _machine(word: str, dimension: str, lowest: str, highest: str, default: str, meaning: str) -> Key:
    return Key(f"machine.{word}", f"machine.{word}", dimension, lowest, highest, default, meaning)


def _rule(
    word: str, dimension: str, lowest: str, highest: str, default: str, meaning: str, source: str
) -> Key:
    return _sized(f"sizing.{word}", dimension, lowest, highest, default, f"{meaning} ({source})")


def _sized(
    name: str, dimension: str, lowest: str, highest: str, default: str, meaning: str, **choices: Any
) -> Key:
    """A key of any section that is a field of ``Sizing``."""
    return Key(
        name, f"sizing.{name.rpartition('.')[2]}", dimension, lowest, highest, default, meaning, **choices
    )


def _choice(name: str, choices: tuple[str, ...], meaning: str) -> Key:
    return _sized(name, "choice", choices[0], choices[-1], choices[0], meaning, choices=choices)


GENERATOR = "a published bowl generator"
RNA = "RNA, operating instructions"
ASSUMED = "assumption"
# a point mass at the makers' strokes of ``sizing.greatest_acceleration``, friction 0.6, 3 deg climb, 15 deg:
# 241 mm/s at 50 Hz, 207 at 60, 144 at 100, 121 at 120 (tests/machine/test_usual_speeds.py)
FASTEST_SOURCE = (
    "at makers' strokes and 15 deg: 241 mm/s at 50 Hz, 121 at 120 Hz; IQS Directory has vibratory feeders up "
    "to 100 ft/min, 508 mm/s"
)

MACHINE_KEYS = (
    _machine(
        "bowl_mass",
        "mass",
        "0.01 kg",
        "2000 kg",
        "6 kg",
        "all that stands on the springs: bowl, top frame, tooling; without parts",
    ),
    _machine(
        "bowl_inertia",
        "inertia",
        "0.000001 kg m2",
        "5000 kg m2",
        "0.06 kg m2",
        "moment of inertia of the same about the bowl's axis",
    ),
    _machine(
        "base_mass",
        "mass",
        "0.01 kg",
        "20000 kg",
        "25 kg",
        "all that stands below the springs, on the rubber feet; very heavy: held fast",
    ),
    _machine(
        "base_inertia",
        "inertia",
        "0.000001 kg m2",
        "50000 kg m2",
        "0.25 kg m2",
        "moment of inertia of the same about the bowl's axis",
    ),
    _machine(
        "spring_radius",
        "length",
        "5 mm",
        "2000 mm",
        "90 mm",
        "from the bowl's axis to the middle of the springs",
    ),
    _machine(
        "spring_angle",
        "angle",
        "1 deg",
        "89 deg",
        "30 deg",
        "of the motion at the springs, from the horizontal: the leaves' own tilt from the vertical",
    ),
    _machine("leaf_width", "length", "1 mm", "500 mm", "40 mm", "of one leaf"),
    _machine("leaf_thickness", "length", "0.1 mm", "30 mm", "2.5 mm", "of one leaf"),
    _machine("leaf_length", "length", "5 mm", "1000 mm", "80 mm", "free length, between the clamps"),
    _machine(
        "leaf_modulus",
        "stress",
        "1 GPa",
        "1000 GPa",
        "206 GPa",
        "modulus of elasticity: spring steel; glass-fibre leaves have 20 to 45 GPa",
    ),
    _machine("leaves", "count", "1", "500", "9", "number of leaves in all banks together"),
    _machine(
        "damping",
        "number",
        "0",
        "0.9",
        "0.01",
        "of the critical damping, of the bowl on its springs; it limits the stroke at resonance only",
    ),
    _machine(
        "supply",
        "supply",
        "10 Hz half wave",
        "500 Hz full wave",
        "50 Hz full wave",
        "mains and waves: 50 or 60 Hz, 'half wave' drives at the mains frequency, 'full wave' at twice it",
    ),
)

SIZING_KEYS = (
    _rule("least_diameter", "length", "10 mm", "5000 mm", "300 mm", "least diameter of a bowl", GENERATOR),
    _rule(
        "diameter_per_length",
        "number",
        "0",
        "100",
        "5.8",
        "diameter over the length of the part along the track",
        GENERATOR,
    ),
    _rule(
        "diameter_per_width", "number", "0", "100", "7.8", "diameter over the width of the track", GENERATOR
    ),
    _rule("greatest_diameter", "length", "50 mm", "50 m", "1200 mm", "no bowl is larger", ASSUMED),
    _rule("diameter_step", "length", "0.1 mm", "500 mm", "10 mm", "diameters are rounded up to it", ASSUMED),
    _rule("least_climb", "angle", "0 deg", "45 deg", "3.5 deg", "least climb of the track", GENERATOR),
    _rule("clearance", "number", "0", "2", "4.5 %", "play of the part on its track, of its width", GENERATOR),
    _rule("least_clearance", "length", "0 mm", "100 mm", "1.2 mm", "least play", GENERATOR),
    _rule("greatest_clearance", "length", "0 mm", "100 mm", "3 mm", "greatest play", GENERATOR),
    _rule(
        "headroom",
        "number",
        "0",
        "10",
        "1.3",
        "free height below the next turn of the track, of the height of the tallest aspect",
        ASSUMED,
    ),
    _rule("depth", "number", "0.01", "5", "0.3", "rise of the track over the bowl's diameter", ASSUMED),
    _rule(
        "fill_height",
        "number",
        "0.01",
        "1",
        "0.3333",
        "height of a full bowl's fill, of its depth",
        "trade: under a third",
    ),
    _rule("packing", "number", "0.01", "1", "0.5", "volume of the parts in the volume they fill", "trade"),
    _rule(
        "carried",
        "number",
        "0",
        "1",
        "10 %",
        "mass of the fill that vibrates with the bowl; the rest hops",
        ASSUMED,
    ),
    _rule(
        "fill_density",
        "density",
        "0 g/cm3",
        "30 g/cm3",
        "0 g/cm3",
        "mass of a part over the volume of its convex hull, for a fill without a part; 0: steel is assumed",
        "feeder design writes it",
    ),
    _rule("hopper_interval", "time", "1 s", "1000 h", "30 min", "from one filling to the next", ASSUMED),
    _rule("controller", "number", "1 %", "1", "80 %", "setting at which the wanted rate must come", RNA),
    _rule("retune", "number", "0", "1", "15 %", "deviation of that setting from which to tune again", RNA),
    _rule(
        "least_detuning", "number", "0", "1", "3 %", "natural frequency above the drive, at least", "trade"
    ),
    _rule(
        "greatest_detuning", "number", "0", "1", "8 %", "natural frequency above the drive, at most", "trade"
    ),
    _rule(
        "greatest_acceleration",
        "number",
        "0.1",
        "100",
        "12.1",
        "acceleration over gravity that drives are built for",
        "makers' strokes: 2.0 mm at 50 Hz, 1.5 at 60, 0.6 at 100, 0.4 at 120 are 10.1 to 12.1",
    ),
    _rule("greatest_stroke", "length", "0.01 mm", "40 mm", "3 mm", "peak to peak", "Eriez: never above"),
    _rule("leaves", "count", "1", "500", "9", "usual number of leaves: three banks of three", ASSUMED),
    _rule("banks", "count", "1", "24", "3", "banks that share the leaves, as many in each", ASSUMED),
    _rule(
        "fatigue_stress",
        "stress",
        "1 MPa",
        "2000 MPa",
        "250 MPa",
        "amplitude of bending stress that a clamped leaf bears without end",
        "assumption: half of what bare spring steel bears",
    ),
    _rule(
        "half_wave_diameter",
        "length",
        "10 mm",
        "50 m",
        "450 mm",
        "bowls larger than this take the mains frequency, smaller ones twice it",
        ASSUMED,
    ),
    _rule(
        "spring_radius", "number", "0.05", "2", "0.6", "radius of the springs over that of the bowl", ASSUMED
    ),
    _rule("least_spring_angle", "angle", "1 deg", "89 deg", "10 deg", "angle of the springs", ASSUMED),
    _rule("greatest_spring_angle", "angle", "1 deg", "89 deg", "30 deg", "angle of the springs", ASSUMED),
    _rule(
        "greatest_spring_radius",
        "number",
        "0.05",
        "2",
        "0.9",
        "where drive.vibration_angle is given, springs move outwards up to this share of the bowl's radius",
        ASSUMED,
    ),
    _rule(
        "steepest_spring_angle",
        "angle",
        "1 deg",
        "89 deg",
        "45 deg",
        "angle of the springs that are as far out as they go, where drive.vibration_angle is given",
        ASSUMED,
    ),
    _rule("base_mass", "number", "0.1", "1000", "4.2", "mass of the base over that of the bowl", ASSUMED),
    _rule("sheet", "length", "0.1 mm", "50 mm", "3 mm", "thickness of the bowl's sheet", ASSUMED),
    _rule("sheet_density", "density", "0.1 g/cm3", "30 g/cm3", "7.9 g/cm3", "of the bowl", "stainless steel"),
    _rule("tooling_mass", "number", "0", "10", "30 %", "tooling and frame, of the bare bowl's mass", ASSUMED),
    _rule("slowest", "velocity", "0 mm/s", "10000 mm/s", "20 mm/s", "bowls seldom run slower", "trade"),
    _rule(
        "fastest",
        "velocity",
        "0 mm/s",
        "10000 mm/s",
        "240 mm/s",
        "bowls seldom run faster, and a design chooses no faster drive",
        FASTEST_SOURCE,
    ),
    _rule(
        "handbook_speed",
        "velocity",
        "1 mm/s",
        "1000 mm/s",
        "25 mm/s",
        "speed behind the handbook's estimate",
        "F = 1500 E / l parts a minute, l in mm",
    ),
)


UNBALANCE_KEYS = (
    _machine(
        "centre_x",
        "length",
        "-3000 mm",
        "3000 mm",
        "0 mm",
        "of the bowl's centre of mass, off its axis; all zero: balanced",
    ),
    _machine(
        "centre_y", "length", "-3000 mm", "3000 mm", "0 mm", "of the bowl's centre of mass, off its axis"
    ),
    _machine(
        "centre_z",
        "length",
        "-3000 mm",
        "3000 mm",
        "0 mm",
        "of the bowl's centre of mass, over the upper ends of the leaves",
    ),
    *(
        _machine(
            f"inertia_{axis.lower()}",
            "inertia",
            "0 kg m2",
            "5000 kg m2",
            "0 kg m2",
            f"moment of inertia of the bowl about {axis}, at the upper ends of the leaves",
        )
        for axis in "XY"
    ),
    *(
        _machine(
            f"product_{one}{other}",
            "inertia",
            "-5000 kg m2",
            "5000 kg m2",
            "0 kg m2",
            f"sum of its masses times {one} times {other}, from there",
        )
        for one, other in ("yz", "xz", "xy")
    ),
)
UNBALANCE_NAMES = tuple(key.word for key in UNBALANCE_KEYS)
CENTRE = UNBALANCE_NAMES[:3]
UNBALANCE_TOLERANCE = 1e-9  # of what is rounded in a file


def with_unbalance(values: Mapping[str, Any], hand: str) -> Keywords:
    """Return the fields of a machine, with its unbalance in place of the keys that say it.

    A real body has second moments about its centre that are not below 0. So the tensor of the second moments,
    E = tr(I) / 2 - I less the mass at its centre, must have no negative leading minor, apart from rounding.

    Parameters
    ----------
    values : mapping of str to float or array [SI]
        By word of a key of the machine.
    hand : str
        On 'left' the track turns the other way as it rises.

    Returns
    -------
    dict of str to value
        Without unbalance where all those keys are zero: nothing is known then. Arrays are not checked.

    Raises
    ------
    FeederError
        If no body has such a centre, moments and products.

    References
    ----------
    Sylvester's criterion; docs/bowl_file.md.
    """
    rest = {word: value for word, value in values.items() if word not in UNBALANCE_NAMES}
    if not any(np.any(values.get(word, 0.0)) for word in UNBALANCE_NAMES):
        return rest
    x, y, z, xx, yy, yz, xz, xy = (values[word] for word in UNBALANCE_NAMES)
    mass = values["bowl_mass"]
    turns = -1.0 if hand == "left" else 1.0
    unbalance = Unbalance((mass * x, mass * y, mass * z), (xx, yy), (yz, xz, xy), turns)
    if not any(np.ndim(value) for value in values.values()):
        total = 0.5 * (xx + yy + values["bowl_inertia"])
        xx, yy, zz = (
            total - about - mass * at * at for about, at in ((xx, x), (yy, y), (values["bowl_inertia"], z))
        )
        yz, xz, xy = yz - mass * y * z, xz - mass * x * z, xy - mass * x * y
        whole = xx * yy * zz + 2.0 * xy * xz * yz - xx * yz * yz - yy * xz * xz - zz * xy * xy
        if min(xx, xx * yy - xy * xy, whole) < -UNBALANCE_TOLERANCE * total**2 * max(total, 1.0):
            what = "no body has such a centre of mass, moments and products of inertia"
            raise FeederError("machine.inertia_x", what, "give all eight of one body, or leave them out")
    return rest | {"unbalance": unbalance}


def unbalance_values(machine: Machine) -> dict[str, float]:
    """Return the values of those keys of a Machine, by word; None where nothing is known."""
    own = machine.unbalance
    moments = [value / machine.bowl_mass for value in own.moment]
    values = dict(zip(UNBALANCE_NAMES, (*moments, *own.upright, *own.products)))
    return values if any(values.values()) else {}


BOWL_KEYS = (
    Key(
        "drive.amplitude",
        "drive.amplitude",
        "length",
        "0 mm",
        "20 mm",
        "0.21 mm",
        "half the peak-to-peak stroke, along the vibration direction",
    ),
    Key(
        "drive.peak_to_peak",
        "drive.amplitude",
        "length",
        "0 mm",
        "40 mm",
        "drive.amplitude",
        "the whole stroke, as the trade quotes it; write one of the two",
        0.5,
    ),
    Key(
        "drive.frequency",
        "drive.frequency",
        "frequency",
        "1 Hz",
        "1000 Hz",
        "50 Hz",
        "of the vibration: that of the mains, or twice as much where both half-waves pull",
    ),
    Key(
        "drive.vibration_angle",
        "drive.vibration_angle",
        "angle",
        "0 deg",
        "90 deg",
        "25 deg",
        "beta, from the floor or track surface up to the vibration direction",
    ),
    Key(
        "drive.direction",
        "drive.direction",
        "angle",
        "-180 deg",
        "180 deg",
        "0 deg",
        "alpha, of the vibration within the surface; 0 is along the track",
    ),
    Key(
        "drive.phase",
        "drive.phase",
        "angle",
        "-180 deg",
        "180 deg",
        "0 deg",
        "by which the motion along the normal leads the one along the track: an elliptical drive",
    ),
    Key(
        "drive.second_harmonic",
        "drive.second_harmonic",
        "number",
        "0",
        "1",
        "0",
        "amplitude at twice the frequency, as a fraction of drive.amplitude",
    ),
    Key(
        "drive.second_harmonic_phase",
        "drive.second_harmonic_phase",
        "angle",
        "-360 deg",
        "360 deg",
        "0 deg",
        "psi of the motion sin(w t) + r sin(2 w t + psi), r being drive.second_harmonic",
    ),
    Key(
        "drive.second_harmonic_angle",
        "drive.second_harmonic_angle",
        "angle",
        "0 deg",
        "180 deg",
        "drive.vibration_angle",
        "vibration angle of the second harmonic, where a second mode of the springs makes it",
    ),
    Key(
        "friction.static",
        "friction.static",
        "number",
        "0",
        "10",
        "0.6",
        "part on track, at the onset of sliding",
    ),
    Key(
        "friction.kinetic",
        "friction.kinetic",
        "number",
        "0",
        "10",
        "friction.static",
        "part on track, while sliding; never above static",
    ),
    Key(
        "friction.static_backward",
        "friction.static_backward",
        "number",
        "0",
        "10",
        "friction.static",
        "at the onset of sliding down the track; higher on a bristle coating",
    ),
    Key(
        "friction.kinetic_backward",
        "friction.kinetic_backward",
        "number",
        "0",
        "10",
        "friction.kinetic",
        "while sliding down the track; never above static_backward",
    ),
    Key(
        "friction.wall",
        "friction.wall",
        "number",
        "0",
        "10",
        "friction.kinetic",
        "part on bowl wall, while sliding",
    ),
    _choice(
        "friction.lining",
        LININGS,
        "of the track, pu: polyurethane; with it friction is that of a table, unless a coefficient is given",
    ),
    _choice(
        "friction.part_material",
        FAMILIES,
        "what parts are made of, for that table; of a part whose material is known that one",
    ),
    Key(
        "restitution",
        "restitution",
        "number",
        "0",
        "0.95",
        "0.2",
        "of an impact on the track: speed after over speed before",
    ),
    Key(
        "gravity", "gravity", "acceleration", "0.1 m/s2", "100 m/s2", "9.81 m/s2", "acceleration of free fall"
    ),
    Key("track.climb", "track.climb", "angle", "-45 deg", "45 deg", "3 deg", "phi, rise along the track"),
    Key(
        "track.bank",
        "track.bank",
        "angle",
        "0 deg",
        "85 deg",
        "0 deg",
        "delta, tilt about the track's direction, down towards the wall",
    ),
    Key(
        "track.radius",
        "track.radius",
        "length",
        "5 mm",
        "100 m",
        "150 mm",
        "of the bowl wall, where the track runs",
    ),
    Key(
        "track.width",
        "track.width",
        "length",
        "0.1 mm",
        "1000 mm",
        "25 mm",
        "of the track, from the wall to its free edge",
    ),
    _choice(
        "track.hand",
        ("right", "left"),
        "of the helix: on a right-handed track parts climb counter-clockwise, seen from above; left is its "
        "mirror image",
    ),
    *MACHINE_KEYS,
    *UNBALANCE_KEYS,
    _sized(
        "machine.bolts",
        "count",
        "0",
        "100",
        "6",
        "that hold the bowl on its drive, beside the one in the middle",
    ),
    _sized("machine.bolt_hole", "length", "1 mm", "100 mm", "9 mm", "diameter of the holes of these bolts"),
    _sized(
        "machine.bolt_circle",
        "length",
        "5 mm",
        "3000 mm",
        "120 mm",
        "diameter of the circle that they stand on; left out, a solid has them at sizing.bolt_share",
    ),
    _choice(
        "machine.mains",
        ("50 Hz", "60 Hz"),
        "of the place where the bowl is to run: a drive makes the mains frequency (half wave) or twice it "
        "(full wave)",
    ),
    Key(
        "machine.controller",
        "sizing.control",
        "choice",
        "mains",
        "frequency",
        "mains",
        "what drives the magnets: 'mains', or a 'frequency' controller, which makes any frequency from 30 "
        "to 140 Hz",
        choices=("mains", "frequency"),
    ),
    *SIZING_KEYS,
    Key(
        "sizing.bolt_share",
        "sizing.bolt_share",
        "number",
        "0.05",
        "0.9",
        "0.4",
        "circle of the bolts below the bowl, over its diameter (assumption)",
    ),
    _choice(
        "sizing.shape",
        ("cylinder", "stepped", "conical"),
        "of the wall; where it steps outwards with the track each turn lies beside the one before, and not "
        "above it",
    ),
    _sized(
        "sizing.outlet_height",
        "length",
        "0 mm",
        "3000 mm",
        "0 mm",
        "of the outlet's surface over the floor's edge; 0: where the turns of the track end",
    ),
    Key(
        "sizing.outlet_angle",
        "sizing.outlet_angle",
        "angle",
        "-360 deg",
        "360 deg",
        "0 deg",
        "where the outlet leaves the wall, seen from above, from the X axis counter-clockwise",
    ),
    _sized(
        "sizing.drains", "count", "0", "500", "0", "holes at the edge of the floor through which dust leaves"
    ),
    _sized("sizing.drain_hole", "length", "0.2 mm", "100 mm", "4 mm", "diameter of these holes"),
)
BY_NAME = {key.name: key for key in BOWL_KEYS}
OPTIONAL = ("machine",)  # sections that change other keys once one of theirs is given
BOWL_SECTIONS = tuple(dict.fromkeys(key.section for key in BOWL_KEYS if key.section))


def rival(key: Key) -> Key | None:
    """Return the other key of the same field.

    Parameters
    ----------
    key : Key

    Returns
    -------
    Key or None
    """
    return next((other for other in BOWL_KEYS if other.field == key.field and other is not key), None)
