"""What becomes of an answer when the bowl is not quite what the file says."""

import math
from dataclasses import dataclass, replace
from typing import Any

from feederscrew.conveying.answer import answer, scaled

SENSITIVITY_CHANGE = 0.1  # of stroke, friction and angle, each by itself
FRICTION_DOUBT = 0.2  # what a coefficient of friction is seldom known better than
RESTITUTION_DOUBT = 0.16
"""[1] Relative standard deviation of the restitution of single impacts of one body on one surface. 1,718
filmed impacts have the quartiles 0.53, 0.60, 0.66, and half of that width is 0.67 standard deviations."""
MAX_RESTITUTION = 0.99  # [1] restitution: at 1 a part never comes to rest on the track
SENSITIVE_QUANTITIES = ("amplitude", "friction", "angle")


@dataclass(frozen=True)
class Neighbours:
    """Velocities on both sides of an operating point."""

    less: float  # [m/s] NaN where there is no steady state
    more: float  # [m/s]

    def elasticity(self, velocity, change=SENSITIVITY_CHANGE) -> float:
        """Return per cent of velocity for one per cent of the quantity; NaN where the part stands."""
        return (self.more - self.less) / (2.0 * change * velocity) if velocity else math.nan


def sensitivity(bowl) -> dict[str, Neighbours]:
    """Return velocities with each quantity a tenth lower and higher.

    Parameters
    ----------
    bowl : Bowl

    Returns
    -------
    dict of str to Neighbours
        By 'amplitude', 'friction' (all of its coefficients) and 'angle'.
    """
    return {name: _neighbours(bowl, name, SENSITIVITY_CHANGE) for name in SENSITIVE_QUANTITIES}


def friction_doubt(bowl) -> Neighbours:
    """Return neighbours for friction a fifth lower and higher."""
    return _neighbours(bowl, "friction", FRICTION_DOUBT)


def surfaces(bowl, hops):
    """Return the bowl on the surfaces that may be there, its own first.

    Source: docs/validation.md, "Restitution is a spread".

    Parameters
    ----------
    bowl : Bowl
        Its drive and friction may be arrays that broadcast together.
    hops : bool
        Whether parts may leave the track: without that restitution decides nothing.

    Returns
    -------
    list of Bowl
        As it is, friction ``FRICTION_DOUBT`` lower and higher, and both ends of ``even_range`` [1].
    """
    bowls = [bowl, *(scaled(bowl, friction=1.0 + sign * FRICTION_DOUBT) for sign in (-1.0, 1.0))]
    return bowls + ([replace(bowl, restitution=end) for end in rebounds(bowl)] if hops else [])


def rebounds(bowl) -> tuple[Any, ...]:
    """Return both ends of the spread of a bowl's restitution [1], not above ``MOST``."""
    return tuple(min(end, MAX_RESTITUTION) for end in even_range(bowl.restitution))


def restitution_doubt(bowl) -> Neighbours:
    """Return neighbours for both ends of the spread of restitution."""
    return Neighbours(*(answer(replace(bowl, restitution=end)).velocity for end in rebounds(bowl)))


def even_range(restitution) -> tuple[float, float]:
    """Return both ends of the even range round a restitution with ``RESTITUTION_DOUBT`` as deviation.

    A uniform range has 1 / sqrt(12) of its width as its standard deviation. It ends at 0 and 1.
    Source: the standard deviation of a uniform distribution.

    Parameters
    ----------
    restitution : float [1]

    Returns
    -------
    (float [1], float [1])
    """
    half = min(math.sqrt(3.0) * RESTITUTION_DOUBT * restitution, 1.0 - restitution)
    return restitution - half, restitution + half


def _neighbours(bowl, name, change) -> Neighbours:
    return Neighbours(*(answer(scaled(bowl, **{name: 1.0 + sign * change})).velocity for sign in (-1.0, 1.0)))
