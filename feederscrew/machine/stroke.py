"""The stroke of a bowl at its track, between its springs, on a sticker and on an accelerometer."""

from dataclasses import dataclass

import numpy as np

from feederscrew.bowl.record import Bowl, Machine, Track, direction, shares

FULL_TURN_RAD = 2.0 * np.pi  # [rad]
INNERMOST = 0.5  # of the track's radius, where the list of angles starts
RADII = 6  # in it, besides the springs'


@dataclass(frozen=True)
class Stroke:
    """How a bowl moves, and what is read on it where its track runs."""

    frequency: float  # [Hz]
    peak_to_peak: float  # [m] along the motion: what a sticker shows
    angle: float  # [rad] of the motion to the horizontal
    springs: float  # [m] half the stroke between bowl and base, at the springs
    acceleration: float  # [m/s2] peak, along the motion
    rms: float  # [m/s2] of the same
    horizontal: float  # [m/s2] peak
    vertical: float  # [m/s2] peak


def stroke(bowl: Bowl) -> Stroke:
    """Compute how a bowl moves.

    Parameters
    ----------
    bowl : Bowl
        With a machine.

    Returns
    -------
    Stroke
    """
    drive, machine = bowl.drive, bowl.machine
    angle = drive.vibration_angle + bowl.track.climb
    peak = drive.amplitude * (FULL_TURN_RAD * drive.frequency) ** 2
    turn = drive.amplitude * np.cos(angle) / bowl.track.radius  # [rad] of the bowl
    against_base = turn / shares(machine)[1] * machine.spring_radius
    return Stroke(
        frequency=drive.frequency,
        peak_to_peak=2.0 * drive.amplitude,
        angle=angle,
        springs=float(against_base / np.cos(machine.spring_angle)),
        acceleration=peak,
        rms=peak / np.sqrt(2.0),
        horizontal=float(peak * np.cos(angle)),
        vertical=float(peak * np.sin(angle)),
    )


def angles(machine: Machine, track: Track) -> tuple[np.ndarray, np.ndarray]:
    """Return radii and the angle of the bowl's motion to the horizontal at each.

    Parameters
    ----------
    machine : Machine
    track : Track

    Returns
    -------
    two (N,) float [m], [rad]
        From the smaller of the springs' radius and half the track's, outwards.
    """
    evenly = track.radius * np.linspace(INNERMOST, 1.0, RADII)
    off_springs = np.abs(evenly - machine.spring_radius) > 1e-9 * track.radius
    radii = np.sort(np.append(evenly[off_springs], machine.spring_radius))
    return radii, direction(machine, radii)


def greatest_amplitude(bowl: Bowl) -> float:
    """Return half the stroke that drives are built for at a frequency [m]."""
    rules = bowl.sizing
    by_acceleration = rules.greatest_acceleration * bowl.gravity / (FULL_TURN_RAD * bowl.drive.frequency) ** 2
    return min(by_acceleration, 0.5 * rules.greatest_stroke)
