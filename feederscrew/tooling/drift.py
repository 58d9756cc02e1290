"""Sideways drift of parts on a vibrating track, and the force that moves one off it.

Source: averaged Coulomb friction on a vibrating surface; docs/tooling.md.
"""

import functools
import math

FORCE_BISECTIONS = 60


def speed(push, friction, swing, gravity):
    """Return the velocity [m/s] at which a steady sideways push moves what slips on a vibrating track.

    Source: v = a pi V / (2 mu g ln(4 V / v)); docs/tooling.md, "1. The method".

    Parameters
    ----------
    push : float [m/s2]
        Force over mass.
    friction : float [1]
    swing : float [m/s]
        Amplitude of the relative velocity along the track.
    gravity : float [m/s2]

    Returns
    -------
    float [m/s]
        Infinite where friction does not hold the push back at all.

    Notes
    -----
    push = 2 mu g v ln(4 V / v) / (pi V), the mean of Coulomb friction over a sine, for v well below V; it
    rises with v up to v = 4 V / e, where the push is 8 mu g / (pi e): 0.94 of what holds on a still track.
    """
    fastest = 4.0 * swing / math.e
    if swing <= 0.0:
        return 0.0 if push <= friction * gravity else math.inf

    def holding(v):
        return 2.0 * friction * gravity * v * math.log(4.0 * swing / v) / (math.pi * swing)

    if push <= 0.0:
        return 0.0
    if push >= holding(fastest):
        return math.inf
    low, high = 0.0, fastest
    for _ in range(FORCE_BISECTIONS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if holding(middle) < push else (low, middle)
    return high


def force_to_clear(one, wide, height):
    """Return the least sideways force [N] that takes an orientation off the track as it passes.

    Source: docs/tooling.md, "1. The method".

    Parameters
    ----------
    one : Orientation
        That travels.
    wide : float [m]
        Way along the track over which the force acts.
    height : float [m]
        Over the track, at which it acts.

    Notes
    -----
    It drifts to the free edge in the time it takes to pass, or slides outright; or it tips over the side of
    its foot, where force times height is beyond weight times the way from its centre of mass to that side.
    """
    side, weight = one.foot_reach, one.posture.mass * one.gravity
    tips = weight * side / height if height > 0.0 else math.inf
    return min(_force_to_shift(one, wide), tips)


@functools.lru_cache(maxsize=1024)
def _force_to_shift(one, wide):
    """The least sideways force [N] that drifts an orientation off the track over a way, or slides it off."""
    weight, friction = one.posture.mass * one.gravity, max(one.grip, 1e-3)
    way = max(one.track.width - one.distance, 0.0)
    low, high = 0.0, friction * weight
    for _ in range(FORCE_BISECTIONS):
        middle = 0.5 * (low + high)
        found = speed(middle / one.posture.mass, friction, one.swing, one.gravity)
        gone = found * wide >= way * one.speed
        low, high = (low, middle) if gone else (middle, high)
    return high
