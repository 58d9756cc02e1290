"""How far the origin lies inside the convex hull of a few points."""

import math

from feederscrew.geometry.compiled import compiled

POINT_TOLERANCE_M = 1e-12  # [m] points nearer to each other are one
LINE_TOLERANCE_M = 1e-12  # [m] of a point from the line of two others: nearer it lies on it


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
def _next(points, count, ax, ay):
    """The corner of the hull that follows counter-clockwise, of several in line the farthest; -1 for none."""
    best, bx, by, reach = -1, 0.0, 0.0, POINT_TOLERANCE_M * POINT_TOLERANCE_M
    for k in range(count):
        px, py = points[k, 0] - ax, points[k, 1] - ay
        long2 = px * px + py * py
        if long2 <= POINT_TOLERANCE_M * POINT_TOLERANCE_M:
            continue
        turn = bx * py - by * px
        level = LINE_TOLERANCE_M * math.sqrt(max(long2, reach))
        in_line = abs(turn) <= level and bx * px + by * py > 0.0
        if best < 0 or (turn < 0.0 and not in_line) or (in_line and long2 > reach):
            best, bx, by, reach = k, px, py, long2
    return best


@compiled
def inset(points, count, far):
    """Return the signed distance of the origin to the border of the convex hull of points.

    Source: R. A. Jarvis, "On the identification of the convex hull of a finite set of points in the
    plane", Information Processing Letters 2(1), 18-21, 1973.

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
        there = _next(points, count, points[here, 0], points[here, 1])
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
def inset_beside(points, count, foot, keep, moving=False):
    """Return the same of a foot of which some corners are kept, its own hull known.

    Parameters
    ----------
    points : (N, 2) float [m]
        The corners kept and the points that replace the others.
    count : int
    foot : Foot
    keep : (V,) int
        Which of its corners are kept.
    moving : bool
        Leave out the sides of the foot's own hull, which hide how the others move; infinite without others.

    Returns
    -------
    float [m]
    """
    total, first = len(foot.hull), -1
    for k in range(total):
        if keep[foot.hull[k]]:
            first = k
            break
    if first < 0:
        return inset(points, count, foot.reach)
    line = math.inf
    for step in range(total):
        k = (first + step) % total
        if not keep[foot.hull[k]]:
            continue
        last = k + 1
        while not keep[foot.hull[last % total]]:
            last += 1
        own = last == k + 1
        if own and moving:
            continue
        own_inset = foot.insets[k] if own else _between(points, count, foot, k, last, moving)
        if own_inset < 0.0:
            return inset(points, count, foot.reach)
        line = min(line, own_inset)
    return line


@compiled
def _between(points, count, foot, k, last, moving):
    """The least line distance along the hull from one kept corner of the foot to the next, or less than 0.

    A line along one of the foot's own sides does not move.
    """
    total = len(foot.hull)
    aside, behind = foot.insets[k], foot.insets[(last - 1) % total]
    last %= total
    ax, ay = foot.corners[foot.hull[k], 0], foot.centre - foot.corners[foot.hull[k], 1]
    ex, ey = foot.corners[foot.hull[last], 0], foot.centre - foot.corners[foot.hull[last], 1]
    line = math.inf
    for _ in range(count + 1):
        there = _next(points, count, ax, ay)
        if there < 0:
            return -1.0
        bx, by = points[there, 0], points[there, 1]
        distance = (ax * (by - ay) - ay * (bx - ax)) / math.sqrt((bx - ax) ** 2 + (by - ay) ** 2)
        if not moving or (
            abs(distance - aside) > LINE_TOLERANCE_M and abs(distance - behind) > LINE_TOLERANCE_M
        ):
            line = min(line, distance)
        ax, ay = bx, by
        if line < 0.0 or (abs(ax - ex) < POINT_TOLERANCE_M and abs(ay - ey) < POINT_TOLERANCE_M):
            break
    return line
