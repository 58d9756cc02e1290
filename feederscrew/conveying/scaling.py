"""The five numbers that decide how fast a part travels on a track with one coefficient of friction.

Along the track lengths scale with the amplitude along it, along the normal with the amplitude there; friction
couples the two by mu tan(beta) alone.
"""

import math
from typing import NamedTuple

from feederscrew import check
from feederscrew.conveying.operating_point import plain


class Numbers(NamedTuple):
    """What v / (A w cos(beta)) depends on, and on nothing else."""

    coupling: float  # mu tan(beta)
    steepness: float  # tan(climb) / mu
    throw: float  # throw number
    restitution: float
    phase: float = 0.0  # [rad] by which the motion along the normal leads the one along the track


def numbers(setting) -> Numbers:
    """Return the five numbers of a setting.

    Parameters
    ----------
    setting : OperatingPoint
        Harmonic, with one coefficient of friction above 0.

    Returns
    -------
    Numbers
    """
    friction = setting.static
    throw = setting.ratio * math.sin(setting.angle) / math.cos(setting.climb)
    coupling, steepness = friction * math.tan(setting.angle), math.tan(setting.climb) / friction
    return Numbers(coupling, steepness, throw, setting.restitution, -setting.lead)


def with_numbers(velocity, friction):
    """Return a setting with given numbers.

    Source: own; the five numbers of docs/conveying.md, "The model".

    Parameters
    ----------
    velocity : Numbers
        Coupling and throw number above 0.
    friction : float [1]
        Above 0: one of the many settings with these numbers.

    Returns
    -------
    OperatingPoint

    Raises
    ------
    ValueError
        If one of them is not above 0.
    """
    check.positive("coupling", velocity.coupling)
    check.positive("throw", velocity.throw)
    angle = math.atan(velocity.coupling / check.positive("friction", friction))
    climb = math.atan(velocity.steepness * friction)
    ratio = velocity.throw * math.cos(climb) / math.sin(angle)
    return plain(ratio, angle, climb, friction, velocity.restitution)._replace(lead=-velocity.phase)
