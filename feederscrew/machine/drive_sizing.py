"""The drive and the leaves of a bowl that bring a rate from the full bowl to the empty one.

A drive unit where the user has none: masses from sheet, springs; and whether the machine makes the drive that
was tried.
"""

from collections.abc import Callable, Collection, Iterable
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from feederscrew import bowl as bowls
from feederscrew.base.columns import Column
from feederscrew.base.errors import ArgumentError
from feederscrew.base.signatures import Keywords
from feederscrew.base.units import MM_S, MPA, factor, listed
from feederscrew.bowl import schema
from feederscrew.bowl.reading import Setting, default
from feederscrew.bowl.record import UNBALANCE_UNKNOWN, Bowl, Drive, Machine, Sizing, shares, vibration_angle
from feederscrew.bowl.schema import BY_NAME
from feederscrew.bowl.size import Size
from feederscrew.machine import sizing, springs
from feederscrew.machine.springs import (
    analyse_springs,
    gain,
    leaf_stress,
    stroke,
    tuned_leaf_sets,
    upright_pull,
)
from feederscrew.motion import conveying as answer

RADIUS_STEP_M = 1e-4  # of a springs' circle that is chosen


def machine_for(bowl: Bowl, size: Size, user_words: Collection[str], *, exact: bool = False) -> Machine:
    """Return the machine under a bowl of sheet on springs, what the user gave of it kept.

    Floor, wall and track of sheet of mass s per area: m = (1 + k) s [pi R^2 + 2 pi R H + n pi (R^2 - r^2)]
    and I = (1 + k) [m_f R^2 / 2 + m_w R^2 + m_t (R^2 + r^2) / 2], with the tooling's share k, n turns and the
    track's inner radius r. The base has a multiple of both. Where the bowl is known as a solid, its mass and
    inertia are taken.

    Parameters
    ----------
    bowl : Bowl
        Its machine, its rules, and the vibration angle that is wanted at the track.
    size : Size
    user_words : collection of str
        Fields of the machine that the user gave, 'leaf_width': these stay.
    exact : bool
        The vibration angle is given, and the machine has to make it: the springs move outwards, then stand
        steeper, as far as ``sizing`` allows. Without it the springs keep their circle, and the angle at the
        track follows from them.

    Returns
    -------
    Machine
        Its springs lean by whole degrees where the user did not say how much.

    References
    ----------
    Thin plates and shells of sheet; docs/bowl.md, "How it is computed", and the keys of ``sizing``.
    """
    rules, radius = bowl.sizing, 0.5 * size.diameter
    # mass and inertia [kg], [kg m2]: of the solid, or of floor, wall and track of sheet with tooling
    if size.mass is not None and size.inertia is not None:
        mass, inertia = size.mass, size.inertia
    else:
        weight = rules.sheet * rules.sheet_density  # [kg/m2]
        floor = weight * np.pi * radius**2
        wall = weight * 2.0 * np.pi * radius * size.depth
        inside = max(radius - size.track_width, 0.0)
        track = weight * np.pi * (radius**2 - inside**2) * (size.turns if np.isfinite(size.turns) else 1.0)
        extra = 1.0 + rules.tooling_mass
        around = 0.5 * floor * radius**2 + wall * radius**2 + 0.5 * track * (radius**2 + inside**2)
        mass, inertia = float(extra * (floor + wall + track)), float(extra * around)
    guess: Keywords = {
        "bowl_mass": mass,
        "bowl_inertia": inertia,
        "base_mass": rules.base_mass * mass,
        "base_inertia": rules.base_mass * inertia,
        "spring_radius": rules.spring_radius * radius,
    }
    built = replace(bowl.machine, **{name: value for name, value in guess.items() if name not in user_words})
    if not set(schema.UNBALANCE_NAMES) & set(user_words):
        unbalance = UNBALANCE_UNKNOWN
        if size.mass is not None and size.inertia is not None:
            # how the mass of the solid lies, in the measure of a mass and an inertia that the user gave
            heavy, inert, own = built.bowl_mass / size.mass, built.bowl_inertia / size.inertia, size.unbalance
            (x, y, z), (xx, yy), (yz, xz, xy) = own.moment, own.upright, own.products
            unbalance = replace(
                own,
                moment=(heavy * x, heavy * y, heavy * z),
                upright=(inert * xx, inert * yy),
                products=(inert * yz, inert * xz, inert * xy),
            )
        built = replace(built, unbalance=unbalance)
    upright, own_angle = bowl.drive.vibration_angle + size.climb, "spring_angle" in user_words
    if exact:
        return _exact(built, upright, radius, rules, user_words)
    return built if own_angle else replace(built, spring_angle=_spring_angle(upright, radius, built, rules))


def machine_on(bowl: Bowl, user_words: Collection[str], *, exact: bool = False) -> Machine:
    """Return the machine under a bowl of which only the track is known.

    Its depth is that of ``sizing``, a share of the bowl's diameter; the rest is as for ``machine_for``.

    Parameters
    ----------
    bowl : Bowl
    user_words : collection of str
        Names of the keys that the user gave, 'machine.bowl_mass'. Note the section: ``machine_for`` goes
        without.
    exact : bool
        As for ``machine_for``.

    Returns
    -------
    Machine

    References
    ----------
    docs/bowl.md, "How it is computed".
    """
    track, depth = bowl.track, 2.0 * bowl.sizing.depth * bowl.track.radius
    pitch = 2.0 * np.pi * track.radius * np.tan(track.climb)
    size = Size(
        diameter=2.0 * track.radius,
        least={},
        track_width=track.width,
        clearance=0.0,
        bend=0.0,
        climb=track.climb,
        depth=depth,
        turns=depth / pitch if pitch > 0.0 else np.nan,
        pitch=pitch,
    )
    return machine_for(bowl, size, _words(user_words), exact=exact)


def _words(user_keys: Collection[str]) -> set[str]:
    """Fields of the machine among names of keys: 'bowl_mass' of 'machine.bowl_mass'."""
    return {name.partition(".")[2] for name in user_keys if name.startswith("machine.")}


def _spring_angle(wanted: float, radius: float, machine: Machine, rules: Sizing) -> float:
    """Angle of the springs, in whole degrees, that moves the bowl at its track in a wanted direction."""
    whole = np.radians(np.round(np.degrees(needed_angle(machine, radius, wanted))))
    return float(np.clip(whole, rules.least_spring_angle, rules.greatest_spring_angle))


def needed_angle(machine: Machine, radius: float, wanted: float) -> float:
    """Return the angle of springs on their circle that moves the bowl in a wanted direction at a radius.

    Parameters
    ----------
    machine : Machine
        With the circle of its springs.
    radius : float [m]
    wanted : float [rad]
        Of the motion there, from the horizontal.

    Returns
    -------
    float [rad]

    References
    ----------
    ``bowl.record.direction``, solved for the springs; docs/bowl.md, "How it is computed".
    """
    rise, turn = shares(machine)
    return float(np.arctan(np.tan(wanted) * radius / machine.spring_radius * turn / rise))


def _exact(
    machine: Machine, wanted: float, radius: float, rules: Sizing, user_words: Collection[str]
) -> Machine:
    """The machine whose springs move the bowl at its track in a wanted direction, as nearly as they can."""
    usual = machine.spring_radius
    farthest = max(min(rules.greatest_spring_radius * radius, radius - 0.5 * machine.leaf_width), usual)
    if "spring_angle" in user_words:
        if "spring_radius" in user_words:
            return machine
        return replace(machine, spring_radius=_circle(machine, wanted, radius, (usual, farthest)))
    if "spring_radius" in user_words:
        tenth = np.radians(np.round(np.degrees(needed_angle(machine, radius, wanted)), 1))
        angle = float(np.clip(tenth, rules.least_spring_angle, rules.steepest_spring_angle))
        return replace(machine, spring_angle=angle)
    angle = _spring_angle(wanted, radius, machine, rules)
    there = _circle(replace(machine, spring_angle=angle), wanted, radius, (machine.leaf_width, radius))
    if there > farthest:
        outside = replace(machine, spring_radius=farthest)
        whole = np.radians(np.ceil(np.degrees(needed_angle(outside, radius, wanted))))
        angle = float(np.clip(whole, rules.least_spring_angle, rules.steepest_spring_angle))
        there = _circle(replace(machine, spring_angle=angle), wanted, radius, (usual, farthest))
    return replace(machine, spring_angle=angle, spring_radius=there)


def _circle(machine: Machine, wanted: float, radius: float, ends: tuple[float, float]) -> float:
    """Radius of springs of their angle that move the bowl in a wanted direction, within two ends [m]."""
    rise, turn = shares(machine)
    there = radius * np.tan(wanted) / np.tan(machine.spring_angle) * turn / rise
    return float(np.clip(np.round(there / RADIUS_STEP_M) * RADIUS_STEP_M, *ends))


SAME_ANGLE = np.radians(0.5)  # angles at the track that are nearer than this count as one
SAME_PHASE = np.radians(0.05)
LEAF_SPRING = "leaf-spring drive"
TWO_AXIS = "two-axis drive"
TWO_MAGNETS = "needs two magnets and a two-channel controller: one set of leaf springs cannot make it"


@dataclass(frozen=True)
class DriveFigures:
    """A drive in the numbers that decide how parts travel."""

    spring_angle: float  # [rad] of the motion at the springs' circle, from the horizontal
    track_angle: float  # [rad] from the track to the motion there
    phase: float  # [rad] by which the motion along the normal leads the one along the track
    throw_number: float  # [1]
    velocity: float  # [m/s] of a part; NaN where there is no steady one

    @property
    def text(self) -> str:
        """The same in words."""
        travels = "no steady speed" if np.isnan(self.velocity) else f"{self.velocity / MM_S:.3g} mm/s"
        phase = f", phase {np.degrees(self.phase):.4g} deg" if abs(self.phase) > SAME_PHASE else ""
        return (
            f"{np.degrees(self.spring_angle):.3g} deg at the springs, {np.degrees(self.track_angle):.3g} deg "
            f"to the track{phase}, throw number {self.throw_number:.3g}, {travels}"
        )


DRIVE_FIGURE_COLUMNS: tuple[Column[DriveFigures], ...] = (
    Column("vibration_angle_at_the_springs_deg", lambda drive: drive.spring_angle, "deg"),
    Column("vibration_angle_at_the_track_deg", lambda drive: drive.track_angle, "deg"),
    Column("phase_deg", lambda drive: drive.phase, "deg"),
    Column("throw_number", lambda drive: drive.throw_number),
    Column("velocity_mm_s", lambda drive: drive.velocity, "mm/s"),
)


@dataclass(frozen=True)
class DriveMismatch:
    """A drive that was asked for, and the one that the machine makes at the same stroke."""

    wanted: DriveFigures
    machine: DriveFigures
    two_axis: bool  # the drive asked for is out of phase
    other_angle: bool  # the springs do not make its angle
    second_harmonic: bool = False  # it has one, and springs are tuned to one frequency

    @property
    def reasons(self) -> tuple[bool, bool, bool]:
        """Which of three reasons it has: two axes, another angle, a second harmonic."""
        return self.two_axis, self.other_angle, self.second_harmonic

    @property
    def text(self) -> str:
        """Return what is wrong, and both drives, in one sentence."""
        reasons = []
        if self.two_axis:
            reasons.append(f"out of phase by {np.degrees(self.wanted.phase):.4g} deg, {TWO_MAGNETS}")
        if self.other_angle:
            wanted, own = np.degrees((self.wanted.track_angle, self.machine.track_angle))
            what = f"{wanted:.4g} deg as given, and the springs make it {own:.4g} deg at the track"
            reasons.append(f"its angle is {what}" if reasons else f"is {what}")
        if self.second_harmonic:
            reasons.append("springs that are tuned to one frequency do not make its second harmonic")
        return f"{'; '.join(reasons)}: asked for {self.wanted.text}; the springs make {self.machine.text}"


def is_two_axis(drive: Drive) -> bool:
    """Tell whether a drive is out of phase, which one set of leaf springs cannot make.

    Parameters
    ----------
    drive : Drive

    Returns
    -------
    bool
    """
    return bool(abs(drive.phase) > SAME_PHASE)


def can_make(bowl: Bowl) -> DriveMismatch | None:
    """Return what keeps the machine of a bowl from making the drive of that bowl.

    The machine's drive has the amplitude of the bowl's, as a sticker on the rim shows it.

    Parameters
    ----------
    bowl : Bowl

    Returns
    -------
    DriveMismatch or None
        None where it makes it.

    References
    ----------
    A rigid bowl on inclined leaves moves in one direction, that of its springs.
    """
    drive, track, machine = bowl.drive, bowl.track, bowl.machine
    by_springs = float(vibration_angle(machine, track.radius, track.climb))
    two_axis, second = is_two_axis(drive), bool(drive.second_harmonic)
    other_angle = bool(abs(by_springs - drive.vibration_angle) > SAME_ANGLE)
    if not (two_axis or other_angle or second):
        return None
    makes = replace(drive, vibration_angle=by_springs, phase=0.0, second_harmonic=0.0)
    needed = needed_angle(machine, track.radius, drive.vibration_angle + track.climb)
    figures = []
    for own, spring_angle in ((drive, needed), (makes, machine.spring_angle)):
        how = answer.answer(replace(bowl, drive=own))
        angle, phase = own.vibration_angle, own.phase
        figures.append(DriveFigures(spring_angle, angle, phase, how.throw_number, how.velocity))
    return DriveMismatch(figures[0], figures[1], two_axis, other_angle, second)


# amplitude of the pull of all magnets: B^2 / (4 mu_0) at 1 T on six poles of 40 x 40 mm (assumption)
GREATEST_PULL_N = 1900.0
FLOW_TOLERANCE_SHARE = 1e-9  # [1] flows closer than this are equal
MAX_DRIVE_ITERATIONS = 4  # of strokes and leaves that follow from each other
# fields of an Emptying
ALONE = "strokes"
CONTROLLED = "controlled"
STROKE_CONTROL_LABELS = {ALONE: "amplitude left alone", CONTROLLED: "amplitude controlled"}


@dataclass(frozen=True, eq=False)
class DriveSearch:
    """A bowl whose drive is sought."""

    bowl: Bowl  # with its track
    size: Size  # of it
    settings: tuple[Setting, ...]  # that say what the user gave
    target: float  # [1/s] counted parts
    bulk: float  # [kg/m3] of the parts' hulls


def user_keys(settings: Iterable[Setting], section: str = "") -> set[str]:
    """Return the words of the keys of a section that the user gave.

    Parameters
    ----------
    settings : iterable of Setting
    section : str
        'drive'; '' for keys of no section.

    Returns
    -------
    set of str
        {'amplitude', 'frequency'}
    """
    return {s.key.word for s in settings if s.is_own and s.key.section == section}


def bring_target(search: DriveSearch, flow: Callable[[Bowl | None], sizing.Flow]) -> tuple[Bowl, sizing.Flow]:
    """Find the bowl whose drive brings the target, without the parts that this drive turns over.

    A faster drive turns more orientations over, and then fewer parts count. So drive and flow are found in
    turn until the flow that a drive leaves is the one it was sized for. There are only so many orientations
    to turn over; where flows alternate, the drive that brings enough is taken.

    Parameters
    ----------
    search : DriveSearch
    flow : callable
        From a Bowl, or from None for no drive at all, to the Flow along its track.

    Returns
    -------
    Bowl
        With drive and machine.
    Flow
        Along its track, under that drive.

    Raises
    ------
    ArgumentError
        If no stroke that drives are built for brings so many parts.

    References
    ----------
    docs/bowl.md, "1. The part, and the rate".
    """
    now, tried = flow(None), set()
    while True:
        driven = _driven(search, now)
        own = flow(driven)
        enough = own.parts >= now.parts * (1.0 - FLOW_TOLERANCE_SHARE)
        if enough and (own.parts <= now.parts * (1.0 + FLOW_TOLERANCE_SHARE) or now.parts in tried):
            return driven, own
        tried.add(now.parts)
        now = own  # there are only so many orientations to turn over


def with_own_drive(search: DriveSearch) -> Bowl:
    """Return the bowl with the drive of its file as it stands, and the machine that is sized for it.

    Parameters
    ----------
    search : DriveSearch
        What the user gave of the machine is kept, as for ``bring_target``.

    Returns
    -------
    Bowl
    """
    plain, settings = search.bowl, search.settings
    under = machine_for(plain, search.size, user_keys(settings, "machine"), exact=True)
    built = replace(plain, machine=replace(under, supply=plain.drive.frequency))
    return _with_stroke(built, plain.drive.amplitude, settings)


def _driven(search: DriveSearch, flow: sizing.Flow) -> Bowl:
    """The bowl with machine, frequency and the smallest stroke that reaches the target."""
    plain, settings, velocity = search.bowl, search.settings, search.target / flow.parts
    angle_given = "vibration_angle" in user_keys(settings, "drive")
    angle = plain.drive.vibration_angle if angle_given else default(BY_NAME["drive.vibration_angle"]).value
    wanted = replace(plain, drive=replace(plain.drive, vibration_angle=angle))
    under = machine_for(wanted, search.size, user_keys(settings, "machine"), exact=angle_given)
    if not angle_given:
        angle = float(vibration_angle(under, plain.track.radius, plain.track.climb))
    # the frequency as given; else that of the size, then the other wave of the mains
    mains = plain.sizing.mains_frequency
    frequencies = [2.0 * mains, mains]
    if "frequency" in user_keys(settings, "drive") or "supply" in user_keys(settings, "machine"):
        frequencies = [plain.drive.frequency]
    elif 2.0 * plain.track.radius > plain.sizing.half_wave_diameter:
        frequencies.reverse()
    fastest = []
    for frequency in frequencies:
        drive = replace(plain.drive, vibration_angle=angle, frequency=frequency)
        driven = replace(plain, drive=drive, machine=replace(under, supply=frequency))
        amplitudes, too_slow = sizing.amplitude_for(driven, velocity)
        if amplitudes is not None:
            empty = _with_stroke(driven, amplitudes[0], settings)
            held = (_smallest_stroke(empty, search, velocity, control) for control in STROKE_CONTROL_LABELS)
            return next((candidate for candidate in held if candidate is not None), empty)
        if too_slow is not None:
            fastest.append(too_slow)
    (speed, amplitude), minute = max(fastest), factor("/min", "rate")
    most = f"{max(speed, 0.0) * flow.parts / minute:.4g}/min at {2e3 * amplitude:.3g} mm peak to peak"
    what = f"no bowl reaches {search.target / minute:.6g}/min of this part: the most is {most}"
    mend = "split it over several bowls or tracks, or let more orientations pass"
    raise ArgumentError("target", what, mend)


def _smallest_stroke(empty: Bowl, search: DriveSearch, velocity: float, control: str) -> Bowl | None:
    """The bowl with the smallest stroke whose lowest velocity, from full to empty, is enough, or None."""
    bowl, strokes, size = empty, np.ones(1), search.size  # of the empty bowl
    room = size.room or search.bowl.track.radius
    full = sizing.full_bowl(room, size.depth, search.bulk, search.bowl.sizing)
    for _ in range(MAX_DRIVE_ITERATIONS):
        emptied = sizing.emptying(bowl, full)
        if np.array_equal(getattr(emptied, control), strokes):
            return bowl
        strokes = getattr(emptied, control)
        amplitudes, _ = sizing.amplitude_for(bowl, velocity, strokes, emptied.angles)
        if amplitudes is None:
            return None
        bowl = _with_stroke(bowl, amplitudes[0], search.settings)
    return bowl


def _with_stroke(bowl: Bowl, amplitude: float, settings: Iterable[Setting]) -> Bowl:
    """The bowl at a stroke, on the leaves that tune it then, unless the user gave their number."""
    bowl = replace(bowl, drive=replace(bowl.drive, amplitude=amplitude))
    words = user_keys(settings, "machine")
    return bowl if "leaves" in words else replace(bowl, machine=on_leaves(bowl, words))


def on_leaves(bowl: Bowl, user_words: Collection[str]) -> Machine:
    """Return the machine of a bowl with the leaves that tune it to its drive at its stroke.

    Taken are leaves that last and that a maker would take first: at most ``springs.USUAL_A_BANK`` in a bank,
    tuned to the upper half of the detuning [1], because parts in the bowl lower the natural frequency. Of
    these, the ones of the width in use, of about the length in use, and of a usual number. If none lasts,
    those of least stress are taken.

    Parameters
    ----------
    bowl : Bowl
        Its drive, machine and rules.
    user_words : collection of str
        Fields of the machine that the user gave, 'leaf_width': these stay.

    Returns
    -------
    Machine
        As it is where no set of leaves tunes it.

    References
    ----------
    ``springs.tuned_leaf_sets``; docs/bowl.md, "1. The part, and the rate".
    """
    machine, rules, at_springs = bowl.machine, bowl.sizing, stroke(bowl).springs
    middle = 0.5 * (rules.least_detuning + rules.greatest_detuning)
    own_thickness = machine.leaf_thickness if "leaf_thickness" in user_words else None
    widths = (machine.leaf_width, *(() if "leaf_width" in user_words else springs.LEAF_WIDTHS_M))
    lengths = (machine.leaf_length, *(() if "leaf_length" in user_words else springs.LEAF_LENGTHS_M))

    def unusual(row: tuple[Machine, springs.LeafSet]) -> tuple[bool, bool, bool, float, float]:
        # many in a bank, tuned low, of another width, length, number
        long, leaves = row
        return (
            leaves.leaves > springs.USUAL_A_BANK * rules.banks,
            leaves.detuning < middle,
            long.leaf_width != machine.leaf_width,
            round(abs(float(np.log(long.leaf_length / machine.leaf_length))), 6),
            abs(leaves.leaves - rules.leaves),
        )

    rows: list[tuple[Machine, springs.LeafSet]] = []
    best = None
    for width in widths:
        for length in lengths:
            long = replace(machine, leaf_width=width, leaf_length=length)
            tuned = tuned_leaf_sets(long, bowl.drive.frequency, at_springs, rules)
            rows += [(long, own) for own in tuned if own_thickness in (None, own.thickness)]
        lasting = [row for row in rows if row[1].stress <= rules.fatigue_stress]
        best = min(lasting, key=unusual, default=None)
        if best is not None and not any(unusual(best)[:2]):
            break
    if not rows:
        return machine
    long, leaves = best or min(rows, key=lambda row: row[1].stress)
    return replace(long, leaves=float(leaves.leaves), leaf_thickness=leaves.thickness)


@lru_cache(maxsize=4096)
def drive_shortfall(bowl: Bowl, user_words: frozenset[str]) -> str:
    """Return why the machine under a bowl does not make its leaf-spring drive; '' where it does.

    The machine is sized from the track alone. Looked at are the angle of the springs, the tuning of the
    leaves, their stress, and the pull of the magnets.

    Parameters
    ----------
    bowl : Bowl
    user_words : frozenset of str
        Names of the keys that the user gave, 'machine.leaves': these stay.

    Returns
    -------
    str
        The first reason, a clause for a sentence: 'its leaves bend to 210 MPa'.

    References
    ----------
    ``leaf_shortfall``, whose formulas are those of ``springs``.
    """
    under = machine_on(bowl, user_words, exact=True)
    built = replace(bowl, machine=under)
    other = can_make(built)
    if other is not None:
        return other.text
    if "machine.leaves" not in user_words:
        built = replace(built, machine=on_leaves(built, _words(user_words)))
    return leaf_shortfall(built)


def leaf_shortfall(bowl: Bowl) -> str:
    """Return what keeps the leaves and the magnets of a machine from making its drive.

    Parameters
    ----------
    bowl : Bowl

    Returns
    -------
    str
        Detuning, stress or pull, with its number; '' for nothing.
    """
    rules, machine, moved = bowl.sizing, bowl.machine, stroke(bowl)
    sprung = analyse_springs(machine)
    natural = sprung.natural_frequency
    detuning = natural / moved.frequency - 1.0
    if not rules.least_detuning <= detuning <= rules.greatest_detuning:
        return f"its leaves tune it to {natural:.4g} Hz, {100.0 * detuning:.2g} % above the drive"
    stress = leaf_stress(machine, moved.springs)
    if stress > rules.fatigue_stress:
        return f"its leaves bend to {stress / MPA:.4g} MPa"
    leaf_gain = gain(moved.frequency, natural, machine.damping)
    pull = upright_pull(sprung.stiffness * moved.springs / leaf_gain, machine)
    return f"its magnets have to pull with {pull:.4g} N" if pull > GREATEST_PULL_N else ""


UNIT_SPRING_ANGLE = np.radians(30.0)  # of the motion at the springs, from the horizontal (assumption)
SPRING_CIRCLE = 0.7  # [1] radius of the springs over that of the bowl (assumption)
TYPICAL = "typical, not from a data sheet"
# greatest stroke [m] peak to peak at the frequency of the drive [Hz]
STROKES_M = {50.0: 2.0e-3, 60.0: 1.5e-3, 100.0: 0.6e-3, 120.0: 0.4e-3}


@dataclass(frozen=True)
class DriveUnit:
    """A drive unit on leaf springs with the bowl that it carries."""

    diameter: float  # [m] of the bowl
    mains: float  # [Hz]
    wave: str  # 'half wave': the drive has the frequency of the mains, 'full wave': twice that

    @property
    def name(self) -> str:
        """As the command line has it: 'd300-100hz'."""
        return f"d{1e3 * self.diameter:.0f}-{self.frequency:.0f}hz"

    @property
    def frequency(self) -> float:
        """Frequency of the drive [Hz]."""
        return self.mains * (2.0 if self.wave == "full wave" else 1.0)


DRIVE_UNITS = (
    *(DriveUnit(diameter, 50.0, "full wave") for diameter in (0.15, 0.20, 0.25, 0.30)),
    *(DriveUnit(diameter, 50.0, "half wave") for diameter in (0.30, 0.40, 0.60)),
    *(DriveUnit(diameter, 60.0, "full wave") for diameter in (0.15, 0.30)),
    *(DriveUnit(diameter, 60.0, "half wave") for diameter in (0.30, 0.45, 0.60)),
)


def unit(name: str) -> DriveUnit:
    """Return the drive unit of a name.

    Parameters
    ----------
    name : str
        'd300-100hz', in any case.

    Returns
    -------
    DriveUnit

    Raises
    ------
    ArgumentError
        If there is none of that name.
    """
    units = {drive_unit.name: drive_unit for drive_unit in DRIVE_UNITS}
    drive_unit = units.get(name.strip().casefold())
    if drive_unit is None:
        raise ArgumentError(f"machine {name!r}", "is not known", f"give {listed(list(units))}")
    return drive_unit


def _bowl(drive_unit: DriveUnit) -> Bowl:
    """The bowl of a drive unit at its greatest stroke: masses by rule, leaves that tune it then."""
    plain = bowls.default()
    track = replace(plain.track, radius=0.5 * drive_unit.diameter)
    circle = round(SPRING_CIRCLE * track.radius, 3)
    under = replace(
        plain.machine, spring_angle=UNIT_SPRING_ANGLE, spring_radius=circle, supply=drive_unit.frequency
    )
    plain = replace(plain, track=track, machine=under)
    guess = machine_on(plain, ("machine.spring_angle", "machine.spring_radius"))
    # to two digits, as a list of machines has them
    names = ("bowl_mass", "bowl_inertia", "base_mass", "base_inertia")
    masses: Keywords = {name: float(f"{getattr(guess, name):.2g}") for name in names}
    under = replace(guess, **masses)
    drive = replace(
        plain.drive,
        amplitude=0.5 * STROKES_M[drive_unit.frequency],
        frequency=drive_unit.frequency,
        vibration_angle=float(vibration_angle(under, track.radius, track.climb)),
    )
    driven = replace(plain, drive=drive, machine=under)
    return replace(driven, machine=on_leaves(driven, ()))


def lines() -> tuple[str, ...]:
    """Return what ``feeder config init --machine list`` prints.

    Returns
    -------
    tuple of str
        A line for each drive unit.
    """
    rows = []
    for drive_unit in DRIVE_UNITS:
        bowl = _bowl(drive_unit)
        at_springs, at_track = np.degrees((UNIT_SPRING_ANGLE, bowl.drive.vibration_angle))
        supply, greatest = f"{drive_unit.mains:.0f} Hz {drive_unit.wave}", STROKES_M[drive_unit.frequency]
        rows.append(
            f"{drive_unit.name:<11} {1e3 * drive_unit.diameter:4.0f} mm  {drive_unit.frequency:4.0f} Hz "
            f"({supply})  {at_springs:.0f} deg springs, {at_track:.0f} deg track  "
            f"{1e3 * greatest:.1f} mm p-p  {bowl.machine.bowl_mass:4.1f} kg  {TYPICAL}"
        )
    return tuple(rows)


def bowl_file(drive_unit: DriveUnit) -> str:
    """Return a bowl file that describes a drive unit; the amplitude is left to the design.

    Parameters
    ----------
    drive_unit : DriveUnit

    Returns
    -------
    str
    """
    bowl = _bowl(drive_unit)
    under = bowl.machine
    angle = np.degrees(bowl.drive.vibration_angle)
    return f"""\
# yaml-language-server: $schema=feeder.schema.json
# Drive unit {drive_unit.name}: {TYPICAL}. Replace what the sheet of your own machine says.
# Stroke: strokes that makers state, as for sizing.greatest_acceleration.
# Masses: rules of sizing: sheet of 3 mm, depth 0.3 of the diameter, tooling 30 %.
# Leaves that makers stock, tuned 5.5 to 8 % above the drive. Angle and circle of the springs: assumption.
# By the machine below the drive runs at {drive_unit.frequency:.0f} Hz and {angle:.3g} deg at the track.
# feeder design looks for the stroke. To keep a stroke of your own, write it:
# drive:
#   peak_to_peak: {1e3 * STROKES_M[drive_unit.frequency]:.1f} mm
track:
  radius: {5e2 * drive_unit.diameter:g} mm
machine:
  mains: {drive_unit.mains:.0f} Hz
  controller: mains
  supply: {drive_unit.mains:.0f} Hz {drive_unit.wave}
  bowl_mass: {under.bowl_mass:g} kg
  bowl_inertia: {under.bowl_inertia:g} kg m2
  base_mass: {under.base_mass:g} kg
  base_inertia: {under.base_inertia:g} kg m2
  spring_radius: {1e3 * under.spring_radius:g} mm
  spring_angle: {np.degrees(under.spring_angle):g} deg
  leaf_width: {1e3 * under.leaf_width:g} mm
  leaf_thickness: {1e3 * under.leaf_thickness:g} mm
  leaf_length: {1e3 * under.leaf_length:g} mm
  leaves: {under.leaves:.0f}
sizing:
  greatest_stroke: {1e3 * STROKES_M[drive_unit.frequency]:g} mm
"""
