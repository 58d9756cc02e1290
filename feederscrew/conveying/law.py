"""The equations of motion of one setting: an acceleration for every phase, a pull for every onset."""

import math
from typing import NamedTuple

from feederscrew.conveying.harmonic import Harmonic, above, harmonic, peak, value
from feederscrew.conveying.setting import BACKWARD, FLIGHT, FORWARD, STICK
from feederscrew.conveying.waves import Wave

OVERTONE = 4.0  # accelerations of the second harmonic over those of the first, for equal ways


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


def law(setting):
    """Return the equations of motion of a setting.

    Parameters
    ----------
    setting : OperatingPoint

    Returns
    -------
    Law
    """
    return Law(
        harmonic(lift_wave(setting)),
        _pull(setting, 1.0, 0.0),
        _pull(setting, 1.0, setting.static),
        _pull(setting, -1.0, setting.static_back),
        _pull(setting, 1.0, setting.kinetic),
        _pull(setting, -1.0, setting.kinetic_back),
        setting.kinetic,
        setting.kinetic_back,
        setting.restitution,
    )


def lift_wave(setting):
    """Return the acceleration [A w2] along the normal of a part in flight; pressed on, what it lacks."""
    weight = math.cos(setting.climb) / setting.ratio
    normal = math.sin(setting.angle)
    second, phase = normal * OVERTONE * setting.second, setting.second_phase
    return Wave(-weight, normal, 0.0, second * math.cos(phase), second * math.sin(phase))


def pull_wave(setting, direction, friction):
    """Return the acceleration left after friction of a part about to slip.

    Source: Newton's law along the track less Coulomb's friction; docs/conveying.md, "The model".

    Parameters
    ----------
    setting : OperatingPoint
    direction : float [1]
        Of the slip and of the acceleration: +1 up the track, -1 down.
    friction : float [1]

    Returns
    -------
    Wave
    """
    along, normal = direction * math.cos(setting.angle), friction * math.sin(setting.angle)
    resist = friction * math.cos(setting.climb) / setting.ratio
    level = -direction * math.sin(setting.climb) / setting.ratio - resist
    lead, second, phase = setting.lead, OVERTONE * setting.second, setting.second_phase
    turned = phase + 2.0 * lead  # a lead is a shift of the whole motion in time
    return Wave(
        level,
        along * math.cos(lead) + normal,
        along * math.sin(lead),
        second * (along * math.cos(turned) + normal * math.cos(phase)),
        second * (along * math.sin(turned) + normal * math.sin(phase)),
    )


def _pull(setting, direction, friction):
    return harmonic(pull_wave(setting, direction, friction))


def throw_number(rules):
    """Return the plate's greatest downward acceleration over a part's own [1]; it hops above 1.

    Source: docs/conveying.md, "The model".
    """
    return 1.0 - peak(rules.lift) / rules.lift.level


def contact(rules, angle, speed):
    """Return the phase of a part that touches the plate at ``angle`` [rad], relative ``speed`` [A w]."""
    if above(rules.lift, angle):
        return FLIGHT
    if speed > 0.0 or (speed == 0.0 and value(rules.onset, angle) > 0.0):
        return FORWARD
    if speed < 0.0 or value(rules.onset_back, angle) > 0.0:
        return BACKWARD
    return STICK
