"""The bowl's drive as the drop kernel needs it."""

import math
from dataclasses import replace

from feederscrew.conveying import answer
from feederscrew.dropping.kernel.falling import Steps
from feederscrew.dropping.kernel.floor_motion import Floor

PERIOD = 200  # steps of a period, at least: eight times as many change a flat part's velocity by 2 % at most
FINER = 2.0  # than the steps of a drop
SLOW = 0.1  # of the plate's greatest speed upwards: slower contacts do not rebound


def floor_of(bowl, length, coarse=1.0):
    """Return the plate that moves as the bowl's floor does; level, its x axis along the drive.

    Source: docs/resting.md, "On the vibrating plate".

    Parameters
    ----------
    bowl : Bowl
    length : float [m]
        Of the part, cube root of its hull's volume.
    coarse : float [1]
        By how much steps are longer than those that velocities need.

    Returns
    -------
    Floor
    """
    drive, time = bowl.drive, math.sqrt(length / bowl.gravity)
    rate = 2.0 * math.pi * drive.frequency * time
    return Floor(
        rate=rate,
        along=drive.amplitude * math.cos(drive.vibration_angle) / length,
        up=drive.amplitude * math.sin(drive.vibration_angle) / length,
        lead=-drive.phase,
        second=drive.second_harmonic,
        second_phase=drive.second_harmonic_phase,
        step=coarse * 2.0 * math.pi / rate / PERIOD,
    )


def steps_of(floor, coarse=1.0):
    """Return steps for a plate: finer than a drop's unless ``coarse``, and rebounds as slow as its own."""
    usual, once = Steps(), min(coarse, FINER)
    return usual._replace(
        flight=coarse * usual.flight / FINER,
        contact=coarse * usual.contact / FINER**2,
        swing=once * usual.swing / FINER,
        tolerance=once * usual.tolerance / FINER,
        threshold=min(usual.threshold, max(SLOW * floor.up * floor.rate, 1e-4)),
    )


def throw_number(bowl):
    """Return the level floor's greatest downward acceleration over gravity [1], as of a track.

    Source: the normal force of eq. [4.14] at the upper reversal; docs/conveying.md, "The model".
    """
    if bowl.drive.amplitude == 0.0:
        return 0.0
    return float(answer.throw_number(replace(bowl, track=replace(bowl.track, climb=0.0, bank=0.0))))


def kick_of(floor, times):
    """Return the energy [m g L] of a point at so many ``times`` that of the floor's quickest motion.

    Source: docs/resting.md, "On the vibrating plate".
    """
    quickest = floor.rate * math.hypot(floor.along, floor.up) * (1.0 + 2.0 * abs(floor.second))
    return times * 0.5 * quickest**2
