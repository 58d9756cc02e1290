"""How far the origin lies inside the convex hull of a few points."""

import math

from feederscrew.geometry.compiled import compiled

NEAR = 1e-12  # [m] points nearer to each other are one
LEVEL = 1e-16  # [m2] of a triangle: three points nearer to one line lie on it


@compiled
def inset(points, count, far):
    """Return the signed distance of the origin to the border of the convex hull of points.

    Parameters
    ----------
    points : (N, 2) float [m]
    count : int
        How many of them count.
    far : float [m]
        Returned, negative, where there is no point.

    Returns
    -------
    float [m]
        Positive inside; outside, minus the distance to the hull.
    """
    if count == 0:
        return -far
    first = _lowest(points, count)
    here, line, away = first, math.inf, math.inf
    for _ in range(count + 1):
        there = _next(points, count, here)
        if there < 0:
            return -math.hypot(points[here, 0], points[here, 1])
        ax, ay = points[here, 0], points[here, 1]
        ux, uy = points[there, 0] - ax, points[there, 1] - ay
        long2 = ux * ux + uy * uy
        line = min(line, (ax * uy - ay * ux) / math.sqrt(long2))
        share = min(max(-(ax * ux + ay * uy) / long2, 0.0), 1.0)
        away = min(away, math.hypot(ax + share * ux, ay + share * uy))
        here = there
        if here == first:
            break
    return line if line >= 0.0 else -away


@compiled
def _lowest(points, count):
    """The point of least y, of several the one of least x."""
    best = 0
    for k in range(1, count):
        lower = points[k, 1] < points[best, 1]
        if lower or (points[k, 1] == points[best, 1] and points[k, 0] < points[best, 0]):
            best = k
    return best


@compiled
def _next(points, count, here):
    """The corner of the hull that follows counter-clockwise, of several in line the farthest; -1 for none."""
    best, bx, by, reach = -1, 0.0, 0.0, NEAR * NEAR
    for k in range(count):
        px, py = points[k, 0] - points[here, 0], points[k, 1] - points[here, 1]
        long2 = px * px + py * py
        if long2 <= NEAR * NEAR:
            continue
        turn = bx * py - by * px
        if best < 0 or turn < -LEVEL or (turn <= LEVEL and long2 > reach):
            best, bx, by, reach = k, px, py, long2
    return best
