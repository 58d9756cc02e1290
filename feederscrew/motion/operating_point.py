"""One operating point of a track without units: its equations of motion, and what a part can do on it.

An acceleration for every phase, a pull for every onset; and the five numbers that decide how fast a part
travels where there is one coefficient of friction: along the track lengths scale with the amplitude along it,
along the normal with the amplitude there; friction couples the two by mu tan(beta) alone.
"""

import math
from typing import NamedTuple

import numpy as np

from feederscrew.base import check
from feederscrew.motion.waves import Harmonic, Wave, above, harmonic, peak, value

PHASES = ("stick", "forward", "backward", "flight")  # a phase code is a place in this list
STICK = 0
FORWARD = 1
BACKWARD = 2
FLIGHT = 3
OVERTONE_RATIO = 4.0  # accelerations of the second harmonic over those of the first, for equal ways


class OperatingPoint(NamedTuple):
    """Everything the velocity in units of A w depends on.

    The plate moves A cos(angle) s(w t + lead) along the track and A sin(angle) s(w t) along its normal, with
    s(x) = sin x + second sin(2 x + second_phase); A is half the stroke of the first harmonic. The second
    harmonic swings in a direction of its own, ``angle + second_turn``.
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
    second_turn: float = 0.0  # [rad] by which the second harmonic swings steeper than the first


def plain(
    ratio: float, angle: float, climb: float, friction: float, restitution: float = 0.0
) -> OperatingPoint:
    """Return a track with one coefficient of friction, as most closed forms assume.

    Parameters
    ----------
    ratio : float [1]
        A w^2 / g.
    angle : float [rad]
        Vibration angle.
    climb : float [rad]
    friction : float [1]
    restitution : float [1]

    Returns
    -------
    OperatingPoint

    References
    ----------
    docs/conveying.md, "The model".
    """
    return OperatingPoint(ratio, angle, climb, friction, friction, friction, friction, restitution)


def checked(setting: OperatingPoint) -> OperatingPoint:
    """Return the setting itself, if it is a track.

    Parameters
    ----------
    setting : OperatingPoint
        Its fields may be arrays.

    Returns
    -------
    OperatingPoint

    Raises
    ------
    ValueError
        If a field is out of its range or not finite, or kinetic friction is above static friction.
    """
    angle, kinetic = setting.angle, np.minimum(setting.kinetic, setting.kinetic_back)
    reasons = (
        (np.isfinite(np.stack(np.broadcast_arrays(*setting))), "an entry of the setting is not finite"),
        (setting.ratio > 0.0, "the amplitude is zero: nothing moves"),
        ((angle >= 0.0) & (angle <= np.pi / 2), "the vibration angle is not from 0 to 90 deg"),
        (setting.kinetic <= setting.static, "kinetic friction is above static friction"),
        (setting.kinetic_back <= setting.static_back, "kinetic friction is above static friction"),
        (kinetic >= 0.0, "a coefficient of friction is negative"),
        ((setting.restitution >= 0.0) & (setting.restitution < 1.0), "restitution is not from 0 to below 1"),
    )
    for holds, reason in reasons:
        if not np.all(holds):
            raise ValueError(reason)
    return setting


class Law(NamedTuple):
    """Accelerations of the part relative to the plate, in units of A w^2."""

    lift: Harmonic  # along the normal; pressed on while negative
    free: Harmonic  # along the track, in flight
    onset: Harmonic  # what pulls a sticking part up the track beyond static friction
    onset_back: Harmonic  # the same down the track
    slip: Harmonic  # growth of the speed while slipping up the track
    slip_back: Harmonic  # the same down the track
    kinetic: float
    kinetic_back: float
    restitution: float


def law(setting: OperatingPoint) -> Law:
    """Return the equations of motion of a setting: lift and pull as waves, with their zeros.

    Parameters
    ----------
    setting : OperatingPoint

    Returns
    -------
    Law
    """
    return Law(
        harmonic(lift_wave(setting)),
        harmonic(pull_wave(setting, 1.0, 0.0)),
        harmonic(pull_wave(setting, 1.0, setting.static)),
        harmonic(pull_wave(setting, -1.0, setting.static_back)),
        harmonic(pull_wave(setting, 1.0, setting.kinetic)),
        harmonic(pull_wave(setting, -1.0, setting.kinetic_back)),
        setting.kinetic,
        setting.kinetic_back,
        setting.restitution,
    )


def lift_wave(setting: OperatingPoint) -> Wave:
    """Return the acceleration along the normal of a part in flight, relative to the plate.

    While it is negative the part is pressed on.

    Parameters
    ----------
    setting : OperatingPoint

    Returns
    -------
    Wave [A w2]

    References
    ----------
    docs/conveying.md, "The model".
    """
    weight = math.cos(setting.climb) / setting.ratio
    normal, phase = math.sin(setting.angle), setting.second_phase
    second = math.sin(setting.angle + setting.second_turn) * OVERTONE_RATIO * setting.second
    return Wave(-weight, normal, 0.0, second * math.cos(phase), second * math.sin(phase))


def pull_wave(setting: OperatingPoint, direction: float, friction: float) -> Wave:
    """Return the acceleration left after friction of a part that slips or is about to slip.

    The normal force is the negative of ``lift_wave``. Friction is a multiple of it, so pull and friction
    together are one wave again: cos(angle) of the drive along the track plus friction times sin(angle).

    Parameters
    ----------
    setting : OperatingPoint
    direction : float [1]
        Of the slip and of the acceleration, +1 up the track, -1 down it.
    friction : float [1]
        Coefficient.

    Returns
    -------
    Wave
        In units of A w^2.

    References
    ----------
    Newton's law along the track less Coulomb's friction; docs/conveying.md, "The model".
    """
    along, normal = direction * math.cos(setting.angle), friction * math.sin(setting.angle)
    resist = friction * math.cos(setting.climb) / setting.ratio
    level = -direction * math.sin(setting.climb) / setting.ratio - resist
    lead, second, phase = setting.lead, OVERTONE_RATIO * setting.second, setting.second_phase
    turned = phase + 2.0 * lead  # a lead is a shift of the whole motion in time
    second_angle = setting.angle + setting.second_turn
    along_2, normal_2 = direction * math.cos(second_angle), friction * math.sin(second_angle)
    return Wave(
        level,
        along * math.cos(lead) + normal,
        along * math.sin(lead),
        second * (along_2 * math.cos(turned) + normal_2 * math.cos(phase)),
        second * (along_2 * math.sin(turned) + normal_2 * math.sin(phase)),
    )


def throw_number(rules: Law) -> float:
    """Return the plate's greatest downward acceleration over a part's own; the part hops above 1.

    Parameters
    ----------
    rules : Law

    Returns
    -------
    float [1]

    References
    ----------
    docs/conveying.md, "The model".
    """
    return 1.0 - peak(rules.lift) / rules.lift.level


def contact(rules: Law, angle: float, speed: float) -> int:
    """Return the phase of a part that touches the plate.

    Parameters
    ----------
    rules : Law
    angle : float [rad]
        Of the drive.
    speed : float [A w]
        Along the track, relative to the plate.

    Returns
    -------
    int
        Place in ``PHASES``.
    """
    if above(rules.lift, angle):
        return FLIGHT
    if speed > 0.0 or (speed == 0.0 and value(rules.onset, angle) > 0.0):
        return FORWARD
    if speed < 0.0 or value(rules.onset_back, angle) > 0.0:
        return BACKWARD
    return STICK


class Numbers(NamedTuple):
    """The five numbers that fix v / (A w cos(beta)) where there is one coefficient of friction."""

    coupling: float  # mu tan(beta)
    steepness: float  # tan(climb) / mu
    throw: float  # throw number
    restitution: float
    phase: float = 0.0  # [rad] by which the motion along the normal leads the one along the track


def numbers(setting: OperatingPoint) -> Numbers:
    """Return the five numbers of a setting.

    Parameters
    ----------
    setting : OperatingPoint
        Harmonic, with one coefficient of friction above 0.

    Returns
    -------
    Numbers
    """
    throw = setting.ratio * math.sin(setting.angle) / math.cos(setting.climb)
    coupling, steepness = setting.static * math.tan(setting.angle), math.tan(setting.climb) / setting.static
    return Numbers(coupling, steepness, throw, setting.restitution, -setting.lead)


def with_numbers(five: Numbers, friction: float) -> OperatingPoint:
    """Return one of the many settings that have the five numbers.

        tan(beta) = coupling / mu,   tan(climb) = steepness mu,   ratio = throw cos(climb) / sin(beta)

    Parameters
    ----------
    five : Numbers
    friction : float [1]
        mu.

    Returns
    -------
    OperatingPoint

    Raises
    ------
    ValueError
        If the friction, the coupling or the throw number is not above 0.

    References
    ----------
    Own; the five numbers of docs/conveying.md, "The model".
    """
    check.positive("coupling", five.coupling)
    check.positive("throw", five.throw)
    angle = math.atan(five.coupling / check.positive("friction", friction))
    climb = math.atan(five.steepness * friction)
    ratio = five.throw * math.cos(climb) / math.sin(angle)
    return plain(ratio, angle, climb, friction, five.restitution)._replace(lead=-five.phase)
