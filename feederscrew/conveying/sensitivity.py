"""What becomes of an answer when the bowl is not quite what the file says."""

import math
from dataclasses import dataclass

from feederscrew.conveying.answer import answer, scaled

CHANGE = 0.1  # of stroke, friction and angle, each by itself
FRICTION_DOUBT = 0.2  # what a coefficient of friction is seldom known better than
QUANTITIES = ("amplitude", "friction", "angle")


@dataclass(frozen=True)
class Neighbours:
    """Velocities on both sides of an operating point."""

    less: float  # [m/s] NaN where there is no steady state
    more: float  # [m/s]

    def elasticity(self, velocity, change=CHANGE):
        """Return per cent of velocity for one per cent of the quantity; NaN where the part stands."""
        return (self.more - self.less) / (2.0 * change * velocity) if velocity else math.nan


def sensitivity(bowl):
    """Return velocities with each quantity a tenth lower and higher.

    Parameters
    ----------
    bowl : Bowl

    Returns
    -------
    dict of str to Neighbours
        By 'amplitude', 'friction' (all of its coefficients) and 'angle'.
    """
    return {name: _neighbours(bowl, name, CHANGE) for name in QUANTITIES}


def friction_doubt(bowl):
    """Return neighbours for friction a fifth lower and higher."""
    return _neighbours(bowl, "friction", FRICTION_DOUBT)


def _neighbours(bowl, name, change):
    return Neighbours(*(answer(scaled(bowl, **{name: 1.0 + sign * change})).velocity for sign in (-1.0, 1.0)))
