"""Usual drive units, for people who own one and would have to type its data otherwise."""

from dataclasses import dataclass, replace

import numpy as np

from feederscrew import bowl as bowls
from feederscrew.bowl.record import Bowl, Machine, vibration_angle
from feederscrew.errors import ArgumentError
from feederscrew.machine import drive_sizing
from feederscrew.units import listed

SPRING_CIRCLE = 0.7  # [1] radius of the springs over that of the bowl (assumption)
STROKE_SOURCE = "strokes that makers state, as for sizing.greatest_acceleration"
RULE_SOURCE = "rules of sizing: sheet of 3 mm, depth 0.3 of the diameter, tooling 30 %"
LEAF_SOURCE = "Leaves that makers stock, tuned 5.5 to 8 % above the drive"
TYPICAL = "typical, not from a data sheet"
# greatest stroke [m] peak to peak at the frequency of the drive [Hz]
STROKES_M = {50.0: 2.0e-3, 60.0: 1.5e-3, 100.0: 0.6e-3, 120.0: 0.4e-3}


@dataclass(frozen=True)
class DriveUnit:
    """A drive unit on leaf springs with the bowl that it carries."""

    name: str  # 'd300-100hz'
    diameter: float  # [m] of the bowl
    mains: float  # [Hz]
    wave: str  # 'half wave': the drive has the frequency of the mains, 'full wave': twice that
    spring_angle: float = np.radians(
        30.0
    )  # [rad] of the motion at the springs, from the horizontal (assumption)

    @property
    def frequency(self) -> float:
        """Frequency of the drive [Hz]."""
        return self.mains * (2.0 if self.wave == "full wave" else 1.0)

    @property
    def greatest_stroke(self) -> float:
        """Stroke [m] peak to peak."""
        return STROKES_M[self.frequency]

    @property
    def supply(self) -> str:
        """As the key machine.supply has it."""
        return f"{self.mains:.0f} Hz {self.wave}"


DRIVE_UNITS = (
    DriveUnit("d150-100hz", 0.15, 50.0, "full wave"),
    DriveUnit("d200-100hz", 0.20, 50.0, "full wave"),
    DriveUnit("d250-100hz", 0.25, 50.0, "full wave"),
    DriveUnit("d300-100hz", 0.30, 50.0, "full wave"),
    DriveUnit("d300-50hz", 0.30, 50.0, "half wave"),
    DriveUnit("d400-50hz", 0.40, 50.0, "half wave"),
    DriveUnit("d600-50hz", 0.60, 50.0, "half wave"),
    DriveUnit("d150-120hz", 0.15, 60.0, "full wave"),
    DriveUnit("d300-120hz", 0.30, 60.0, "full wave"),
    DriveUnit("d300-60hz", 0.30, 60.0, "half wave"),
    DriveUnit("d450-60hz", 0.45, 60.0, "half wave"),
    DriveUnit("d600-60hz", 0.60, 60.0, "half wave"),
)


def unit(name: str) -> DriveUnit:
    """Return the drive unit of a name.

    Parameters
    ----------
    name : str

    Returns
    -------
    DriveUnit

    Raises
    ------
    ArgumentError
        If there is none.
    """
    for drive_unit in DRIVE_UNITS:
        if drive_unit.name == name.strip().casefold():
            return drive_unit
    raise ArgumentError(
        f"machine {name!r}", "is not known", f"give {listed([drive_unit.name for drive_unit in DRIVE_UNITS])}"
    )


def machine_of(drive_unit: DriveUnit) -> Machine:
    """Return the machine of a drive unit: masses by rule, leaves that tune it at its greatest stroke.

    Parameters
    ----------
    drive_unit : DriveUnit

    Returns
    -------
    Machine
    """
    return _bowl(drive_unit).machine


def _bowl(drive_unit: DriveUnit) -> Bowl:
    """The bowl of a drive unit at its greatest stroke."""
    plain = bowls.default()
    track = replace(plain.track, radius=0.5 * drive_unit.diameter)
    circle = round(SPRING_CIRCLE * track.radius, 3)
    under = replace(
        plain.machine, spring_angle=drive_unit.spring_angle, spring_radius=circle, supply=drive_unit.frequency
    )
    plain = replace(plain, track=track, machine=under)
    guess = drive_sizing.machine_on(plain, ("machine.spring_angle", "machine.spring_radius"))
    under = replace(
        guess,
        bowl_mass=_rounded(guess.bowl_mass),
        bowl_inertia=_rounded(guess.bowl_inertia),
        base_mass=_rounded(guess.base_mass),
        base_inertia=_rounded(guess.base_inertia),
    )
    drive = replace(
        plain.drive,
        amplitude=0.5 * drive_unit.greatest_stroke,
        frequency=drive_unit.frequency,
        vibration_angle=float(vibration_angle(under, track.radius, track.climb)),
    )
    driven = replace(plain, drive=drive, machine=under)
    return replace(driven, machine=drive_sizing.on_leaves(driven, ()))


def _rounded(value: float) -> float:
    """A value to two digits, as a list of machines has it."""
    return float(f"{value:.2g}")


def lines() -> tuple[str, ...]:
    """Return what ``feeder config init --machine list`` prints: a line for each drive unit."""
    return tuple(_line(drive_unit) for drive_unit in DRIVE_UNITS)


def _line(drive_unit: DriveUnit) -> str:
    bowl = _bowl(drive_unit)
    at_springs, at_track = np.degrees((drive_unit.spring_angle, bowl.drive.vibration_angle))
    angles = f"{at_springs:.0f} deg springs, {at_track:.0f} deg track"
    return (
        f"{drive_unit.name:<11} {1e3 * drive_unit.diameter:4.0f} mm  {drive_unit.frequency:4.0f} Hz "
        f"({drive_unit.supply})  {angles}  "
        f"{1e3 * drive_unit.greatest_stroke:.1f} mm p-p  {bowl.machine.bowl_mass:4.1f} kg  {TYPICAL}"
    )


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
# Stroke: {STROKE_SOURCE}.
# Masses: {RULE_SOURCE}.
# {LEAF_SOURCE}. Angle and circle of the springs: assumption.
# By the machine below the drive runs at {drive_unit.frequency:.0f} Hz and {angle:.3g} deg at the track.
# feeder design looks for the stroke. To keep a stroke of your own, write it:
# drive:
#   peak_to_peak: {1e3 * drive_unit.greatest_stroke:.1f} mm
track:
  radius: {5e2 * drive_unit.diameter:g} mm
machine:
  mains: {drive_unit.mains:.0f} Hz
  controller: mains
  supply: {drive_unit.supply}
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
  greatest_stroke: {1e3 * drive_unit.greatest_stroke:g} mm
"""
