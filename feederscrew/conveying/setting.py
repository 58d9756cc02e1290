"""One operating point of a track without units, and the names of what a part can do on it."""

import math
from typing import NamedTuple

TURN = 2.0 * math.pi  # [rad] one period of the drive
STICK, FORWARD, BACKWARD, FLIGHT = range(4)
PHASES = ("stick", "forward", "backward", "flight")


class OperatingPoint(NamedTuple):
    """Everything the velocity in units of A w depends on.

    The plate moves A cos(angle) s(w t + lead) along the track and A sin(angle) s(w t) along its normal, with
    s(x) = sin x + second sin(2 x + second_phase); A is half the stroke of the first harmonic.
    """

    ratio: float  # [1] A w^2 / g, the dimensionless vibration parameter
    angle: float  # [rad] beta, from the track to the direction of vibration
    climb: float  # [rad] gamma, rise along the track
    static: float  # [1] friction that holds against slip up the track; of floor and wall together
    kinetic: float  # [1] friction during slip up the track, never above static
    static_back: float  # [1] the same against slip down the track; differs for a bristle coating
    kinetic_back: float  # [1]
    restitution: float  # [1] of an impact on the track, from 0 to below 1
    lead: float = 0.0  # [rad] by which the motion along the track leads the one along the normal
    second: float = 0.0  # [1] second harmonic of the displacement, of the first
    second_phase: float = 0.0  # [rad]


def plain(ratio, angle, climb, friction, restitution=0.0):
    """Return a track with one coefficient of friction, as most closed forms assume.

    Source: docs/conveying.md, "The model".

    Parameters
    ----------
    ratio : float [1]
        A w^2 / g.
    angle, climb : float [rad]
        Vibration angle to the track; climb of the track.
    friction, restitution : float [1]

    Returns
    -------
    OperatingPoint
    """
    return OperatingPoint(ratio, angle, climb, friction, friction, friction, friction, restitution)


def checked(setting):
    """Return the setting itself, once it describes a track; raise ValueError with a reason otherwise."""
    if not all(math.isfinite(value) for value in setting):
        raise ValueError("an entry of the setting is not finite")
    if setting.ratio <= 0.0:
        raise ValueError("the amplitude is zero: nothing moves")
    if not 0.0 <= setting.angle <= math.pi / 2:
        raise ValueError("the vibration angle is not from 0 to 90 deg")
    if setting.kinetic > setting.static or setting.kinetic_back > setting.static_back:
        raise ValueError("kinetic friction is above static friction")
    if min(setting.kinetic, setting.kinetic_back) < 0.0:
        raise ValueError("a coefficient of friction is negative")
    if not 0.0 <= setting.restitution < 1.0:
        raise ValueError("restitution is not from 0 to below 1")
    return setting
