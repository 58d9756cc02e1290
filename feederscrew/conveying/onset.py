"""Least static friction that keeps a part from slipping, whatever the drive."""

import math

from feederscrew.conveying import law, waves
from feederscrew.mechanics import limits

STEPS = 50
SAME = 1e-15  # relative


def limits_of_slip(setting):
    """Return the least static friction against slip up and down the track.

    Source: ``limits.forward_limit`` and ``limits.backward_limit``; an elliptical drive by Dinkelbach's
    method.

    Parameters
    ----------
    setting : OperatingPoint
        Its own friction does not matter.

    Returns
    -------
    (float, float) [1]
        Zero or less where no slip comes on any surface; NaN past the hop where it comes on every one.
    """
    if setting.lead == 0.0 and setting.second == 0.0:
        where = (setting.ratio, setting.angle, 0.0, setting.climb)
        return float(limits.forward_limit(*where)), float(limits.backward_limit(*where))
    if law.throw_number(law.law(setting)) >= 1.0 - limits.ROUNDING:
        return math.nan, math.nan
    return _least(setting, 1.0), _least(setting, -1.0)


def _least(setting, direction):
    """Greatest over the cycle of pull over normal force.

    References
    ----------
    W. Dinkelbach, "On nonlinear fractional programming", Management Science 13(7), 492-498, 1967: the
    ratio where the difference is greatest is the next estimate.
    """
    pull = law.pull_wave(setting, direction, 0.0)
    press = law.lift_wave(setting)
    mu = waves.height(pull, 0.0) / -waves.height(press, 0.0)
    for _ in range(STEPS):
        angle = waves.crest(law.pull_wave(setting, direction, mu))
        new = waves.height(pull, angle) / -waves.height(press, angle)
        if abs(new - mu) <= SAME * abs(new):
            break
        mu = new
    return new
