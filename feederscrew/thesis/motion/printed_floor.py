"""The thesis's equations of a part on the bowl floor, as printed."""

from dataclasses import dataclass

import numpy as np

from feederscrew.mechanics.floor.balance import HOP, SLIDE, STICK, UPPER_REVERSAL
from feederscrew.mechanics.limits import acceleration_ratio, published_limit


@dataclass(frozen=True, eq=False)
class PrintedFloor:
    """Solution of the printed equations at one or many instants."""

    state: np.ndarray  # (...) int, places in floor.STATES; the print knows no tipping
    normal_force: np.ndarray  # (...) [N] F_N, negative where it says so
    turning: np.ndarray  # (...) [rad/s2] theta''
    acceleration: np.ndarray  # (..., 2) [m/s2] V'_z, V'_y
    offset: np.ndarray  # (...) [m] d along Z'
    limiting_friction: np.ndarray  # (...) [1]


def motion(posture, bowl, heading, phase=UPPER_REVERSAL):
    """Solve the printed equations for a part at rest, with any part's h, e and I.

    Parameters
    ----------
    posture : Posture
    bowl : Bowl
        Fields may be arrays.
    heading : array_like [rad]
        theta.
    phase : array_like [rad]
        w t.

    Returns
    -------
    PrintedFloor
        R_z = mu F_N once it slides; R_y, which the print leaves open, is zero. The moment of [4.18] is
        projected on fixed axes, as printed.

    References
    ----------
    The thesis: the parts of the wrench of eq. [4.13], solved as eqs. [4.20] to [4.23], and with the levers
    and the inertia of the Magnet the same, eqs. [4.43] to [4.53].
    """
    m, h, e = posture.mass, posture.height, posture.offset
    beta, alpha = bowl.drive.vibration_angle, bowl.drive.direction
    ratio = acceleration_ratio(bowl.drive.amplitude, bowl.drive.frequency, bowl.gravity) * np.sin(phase)
    push = m * bowl.gravity * ratio  # m A w^2
    normal = m * bowl.gravity - push * np.sin(beta)  # eq. [4.14]
    limit = published_limit(ratio, beta, alpha - heading)  # eq. [4.27]
    ahead = push * np.cos(beta) * np.cos(alpha - heading)
    slides = ~(np.abs(limit) <= bowl.friction.static) | (normal <= 0.0)  # eq. [4.25]
    held = np.where(slides, np.sign(ahead) * bowl.friction.kinetic * normal, ahead)  # eq. [4.26]
    across = push * np.cos(beta) * np.sin(alpha - heading)
    turning = e * across / posture.turning_inertia  # eq. [4.17]
    moment = np.cos(heading) * (e * push * np.sin(beta) + h * push * np.cos(beta) * np.cos(alpha))
    return PrintedFloor(
        state=np.where(normal > 0.0, np.where(slides, SLIDE, STICK), HOP),
        normal_force=normal,
        turning=turning,
        acceleration=np.stack(
            np.broadcast_arrays((ahead - held) / m, across / m), axis=-1
        ),  # eqs. [4.15], [4.16]
        offset=(h * held - moment) / normal,  # eq. [4.18]
        limiting_friction=limit,
    )
