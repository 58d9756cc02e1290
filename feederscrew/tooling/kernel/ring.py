"""The margin of a foot over a hole that runs along the track without end: a balcony, a canyon, a slot."""

import math

from feederscrew.geometry.compiled import compiled, entry, outlined
from feederscrew.tooling.kernel.hull_depth import inset_beside
from feederscrew.tooling.kernel.passage import points_under


@entry
def over_ring(foot, low, high, scratch):
    """Return the margin [m] of a foot over the ring between two radii.

    Source: own; docs/tooling.md, "1. The method".

    Parameters
    ----------
    foot : Foot
    low, high : float [m]
        Radii about the bowl's axis between which there is not a track.
    scratch : VerdictArrays

    Returns
    -------
    float [m]
    """
    return _ring_margin(foot, low, high, scratch)


@outlined
def _ring_margin(foot, low, high, scratch):
    """The margin [m] of a foot over the ring between two radii [m]."""
    count, points = 0, scratch.points
    for k in range(len(foot.corners)):
        held = not low < foot.polar[k, 1] < high
        scratch.keep[k] = 1 if held else 0
        if held:
            points[count, 0] = foot.corners[k, 0]
            points[count, 1] = foot.centre - foot.corners[k, 1]
            count += 1
    for k in range(len(foot.sides)):
        count = _crossed(foot, foot.sides[k], low, points, count)
        count = _crossed(foot, foot.sides[k], high, points, count)
    if low > 0.0:  # track left on the side of the axis bulges: its nearest point, and points beside it
        count = points_under(foot, 0.0, low, points, count)
        for share in (1e-3, 0.1, 0.4):
            theta = share * foot.reach / low
            count = points_under(foot, theta, low, points, count)
            count = points_under(foot, -theta, low, points, count)
    return inset_beside(points, count, foot, scratch.keep)


@compiled
def _crossed(foot, side, radius, points, count):
    """Add the points at which a side crosses a circle about the axis."""
    a = side[2] * side[2] + side[3] * side[3]
    nearest = -(side[0] * side[2] + side[1] * side[3]) / a
    low = math.hypot(side[0] + nearest * side[2], side[1] + nearest * side[3])
    if radius <= low:
        return count
    half = math.sqrt((radius - low) * (radius + low) / a)
    for share in (nearest - half, nearest + half):
        if 0.0 <= share <= 1.0:
            points[count, 0] = side[0] + share * side[2]
            points[count, 1] = foot.centre - side[1] - share * side[3]
            count += 1
    return count


@entry
def balcony(foot, radius, farthest, scratch):
    """Return the least width [m] of track that carries a foot; beyond ``farthest`` where none does."""
    low, high = 0.0, farthest
    if _ring_margin(foot, 0.0, radius - farthest, scratch) < 0.0:
        return math.inf
    for _ in range(60):
        middle = 0.5 * (low + high)
        if _ring_margin(foot, 0.0, radius - middle, scratch) >= 0.0:
            high = middle
        else:
            low = middle
    return high


@entry
def canyon(foot, radius, farthest, scratch):
    """Return the greatest width [m] of a strip removed along the wall that carries a foot; -1 for none."""
    low, high = 0.0, farthest
    if _ring_margin(foot, radius, 2.0 * radius, scratch) < 0.0:
        return -1.0
    for _ in range(60):
        middle = 0.5 * (low + high)
        if _ring_margin(foot, radius - middle, 2.0 * radius, scratch) >= 0.0:
            low = middle
        else:
            high = middle
    return low
