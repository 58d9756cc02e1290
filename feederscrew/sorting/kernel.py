"""The compiled verdict: a foot over a hole, followed over the whole passage, exact from event to event.

Polar about the bowl's axis: theta counter-clockwise from the foot of the centre of mass, r from the axis.
A hole's edge is theta = alpha + kappa r + asin(gamma / r) between two radii, or an arc of one radius; the
hole is shifted by phi, which falls as the part advances. On a stretch of a side over which the shift of its
crossing with an edge is monotone, the crossing exists while phi is between the shifts of its two ends.
"""

import math
from typing import NamedTuple

import numpy as np

from feederscrew.base.arrays import Floats, Ints, Points
from feederscrew.base.geometry.compiled import compiled, entry, outlined, record_type
from feederscrew.bowl.devices.openings import HoleEdges

POINT_TOLERANCE_M = 1e-12  # [m] points nearer to each other are one
LINE_TOLERANCE_M = 1e-12  # [m] of a point from the line of two others: nearer it lies on it
MARGIN_ROUNDING_M = 1e-12  # [m] of a margin: what is sure by more cannot come out lower
MARGIN_STEP_M = 1e-9  # [m] a lower margin is looked for if it may be lower by more
INSTANT = 1e-12  # [rad] a shorter piece is one of rounding
SAMPLES_PER_PIECE = 4  # parts of a piece that may hold the least margin
MAX_MARGIN_SLOPE = 2.0  # of a point's mean speed in a piece: no faster does a margin fall beside a sample
GOLDEN_RATIO = 0.5 * (math.sqrt(5.0) - 1.0)
SLOPE_STEP = 1e-3  # of a sample's distance: there the margin is seen to rise or to fall
UNHELD_SAMPLES = 8  # parts of a piece between two events
STRETCH = record_type("side", "edge", "t0", "t1", "phi0", "phi1", whole=("side", "edge"))  # of a side
CUTS = 10  # at most that many ends of stretches on a side
SHORT_SIDE = 1e-13  # [1] of a side
TINY = 1e-300
SAFE_RADIUS = 1e-9  # [1] of a radius: a circle that a side misses by more, it misses for certain


class Foot(NamedTuple):
    """Footprint of a part about the bowl's axis: x ahead, q away from the axis."""

    sides: Floats  # (E, 4) [m] start and vector
    closed: Ints  # (E,) 1 where the side bounds an area
    corners: Points  # (V, 2) [m] from the foot of the centre of mass: ahead, and towards the axis
    polar: Floats  # (V, 2) [rad, m] theta and r of the corners
    centre: float  # [m] q of the foot of the centre of mass, at x = 0
    hull: Ints  # (H,) int, corners of the convex hull, counter-clockwise seen from above
    insets: Floats  # (H,) [m] from the foot of the centre of mass to the line of the side behind each
    reach: float  # [m] from there to the farthest corner
    all_corners: Ints  # (V,) int, all corners
    sector: Floats  # (4,) [rad, m] theta and r between which its areas lie for certain


class Line(NamedTuple):
    """A side of a foot, for its crossings with the edges of a hole."""

    a: float  # [m2] square of its length
    foot: float  # [1] share of it at which its line is nearest to the axis
    moment: float  # [m2] of its vector about the axis
    start: float  # [m] from the axis to its start ...
    end: float  # ... and to its end
    theta: float  # [rad] of its start ...
    theta_end: float  # ... and of its end
    nearest: float  # [m] no place of it is nearer to the axis for certain ...
    farthest: float  # ... or farther from it


class Buffers(NamedTuple):
    """Arrays the verdict works in."""

    rows: np.recarray  # (N,) STRETCH
    events: Floats  # (2 N,) [rad]
    bounds: Floats  # (2 N,) [m] the margin between two events is not less
    movements: Floats  # (2 N,) [m] how far any of its points moves between two events
    cuts: Floats  # (CUTS,)
    keep: Ints  # (V,) int, corners with track below
    crossings: Ints  # (V,) int, edges of the hole at the radius of each corner
    angles: Floats  # (V, M) [rad] of these, as many as there are
    held: Ints  # (P,) int, corners of the hole with the foot above
    active: Ints  # (N,) int, stretches crossed now
    points: Points  # (V + N + P + M, 2)
    moved_points: Points  # (V + N + P + M, 2)


@entry
def least(foot: Foot, hole: HoleEdges, scratch: Buffers, low: float, high: float, out: Floats) -> None:
    """Fill the least margin over a passage and the shift of the hole at which it occurs.

    The passage is cut at the events where a corner or a crossing comes or goes; between two events the margin
    is exact at both ends, and no point moves by more than is looked for.

    Parameters
    ----------
    foot : Foot
    hole : HoleEdges
    scratch : Buffers
    low, high : float [m]
        A margin below ``low`` is as it comes first, not the lowest; one above ``high`` is any that is above.
    out : (2,) float [m, rad]
        Filled.

    References
    ----------
    docs/tooling.md, "1. The method".
    """
    for k in range(len(foot.corners)):
        scratch.keep[k] = 1
    out[0], out[1] = min(_kept_inset(foot, scratch, foot.all_corners), high + 2.0 * MARGIN_STEP_M), 0.0
    pieces = _events(foot, hole, scratch) - 1
    first = 0 if low == -math.inf else pieces // 2  # midway the hole is below the foot
    for step in range(pieces):
        if out[0] < low:
            return
        i = (first + step) % pieces
        scratch.bounds[i] = _bound(foot, hole, scratch, i, out)
    for i in range(pieces):
        if out[0] < low:
            return
        if scratch.bounds[i] < out[0] - MARGIN_STEP_M:
            _within(foot, hole, scratch, i, out)


@entry
def longest(foot: Foot, hole: HoleEdges, scratch: Buffers, enough: float) -> float:
    """Return the longest turn of the hole through which the margin stays below zero.

    Between samples the margin is taken to change evenly.

    Parameters
    ----------
    foot : Foot
    hole : HoleEdges
    scratch : Buffers
    enough : float [rad]
        A turn that is longer is returned as soon as it is so long; infinite for the longest.

    Returns
    -------
    float [rad]
    """
    best = turn = 0.0
    for i in range(_events(foot, hole, scratch) - 1):
        step = (scratch.events[i + 1] - scratch.events[i]) / UNHELD_SAMPLES
        if step * UNHELD_SAMPLES <= INSTANT:
            continue
        if _is_carried(foot, scratch, i, 0.0):
            turn = 0.0
            continue
        active = _status(foot, hole, scratch, i)
        before = _margin(foot, hole, scratch, scratch.events[i], active, False)
        for k in range(1, UNHELD_SAMPLES + 1):
            after = _margin(foot, hole, scratch, scratch.events[i] + k * step, active, False)
            if before < 0.0 and after < 0.0:
                turn += step
            elif before < 0.0:
                best, turn = max(best, turn + step * before / (before - after)), 0.0
            else:
                turn = step * after / (after - before) if after < 0.0 else 0.0
            before = after
        best = max(best, turn)
        if best >= enough:
            break
    return best


@entry
def over_ring(foot: Foot, low: float, high: float, scratch: Buffers) -> float:
    """Return the margin of a foot over the ring between two radii: a balcony, a canyon, a slot.

    Parameters
    ----------
    foot : Foot
    low, high : float [m]
        About the bowl's axis.
    scratch : Buffers

    Returns
    -------
    float [m]

    References
    ----------
    docs/tooling.md, "1. The method".
    """
    count, points = 0, scratch.points
    for k in range(len(foot.corners)):
        held = not low < foot.polar[k, 1] < high
        scratch.keep[k] = 1 if held else 0
        if held:
            count = _add(points, count, foot.corners[k, 0], foot.corners[k, 1])
    for k in range(len(foot.sides)):
        side = foot.sides[k]
        for radius in (low, high):
            for share in _on_circle(side, radius):
                if 0.0 <= share <= 1.0:
                    y = foot.centre - side[1] - share * side[3]
                    count = _add(points, count, side[0] + share * side[2], y)
    if low > 0.0:  # track left on the side of the axis bulges: its nearest point, and points beside it
        count = _points_under(foot, 0.0, low, points, count)
        for share in (1e-3, 0.1, 0.4):
            theta = share * foot.reach / low
            count = _points_under(foot, theta, low, points, count)
            count = _points_under(foot, -theta, low, points, count)
    return _inset_beside(points, count, foot, scratch.keep, False)


@entry
def farthest(places: Points, sides: Floats) -> float:
    """Return how far the farthest of some places is from the nearest of some sides.

    Parameters
    ----------
    places : (P, 2) float [m]
    sides : (S, 4) float [m]
        Start, and the way to the end, which is not 0.

    Returns
    -------
    float [m]

    References
    ----------
    docs/tooling.md, "1. The method".
    """
    largest = 0.0
    for i in range(len(places)):
        nearest = math.inf
        for k in range(len(sides)):
            x, y = places[i, 0] - sides[k, 0], places[i, 1] - sides[k, 1]
            along, across = sides[k, 2], sides[k, 3]
            share = min(max((x * along + y * across) / (along * along + across * across), 0.0), 1.0)
            x, y = x - share * along, y - share * across
            nearest = min(nearest, x * x + y * y)
            if nearest <= largest:
                break
        largest = max(largest, nearest)
    return math.sqrt(largest)


# -- the margin from event to event


@compiled
def _events(foot: Foot, hole: HoleEdges, scratch: Buffers) -> int:
    """Fill the shifts at which a corner of either crosses the border of the other, sorted; their number."""
    for k in range(len(foot.corners)):  # the angles of the hole's edges at its radius
        radius, number = foot.polar[k, 1], 0
        for j in range(len(hole.edges)):
            edge = hole.edges[j]
            if edge.arc or not edge.low <= radius < edge.high:
                continue
            bend = 0.0 if edge.gamma == 0.0 else math.asin(min(edge.gamma / radius, 1.0))
            scratch.angles[k, number] = edge.alpha + edge.kappa * radius + bend
            number += 1
        scratch.crossings[k] = number
    # the stretches of every side with every edge, as many as there is room for
    count, rows = 0, scratch.rows
    for k in range(len(foot.sides)):
        side, line = foot.sides[k], _line(foot.sides[k])
        for j in range(len(hole.edges)):
            edge = hole.edges[j]
            if not edge.arc:
                # nothing where the side lies outside the ring of the edge's radii for certain
                if line.farthest >= edge.low and line.nearest <= edge.high:
                    count = _on_slant(side, line, edge, k, j, rows, count, scratch.cuts)
                continue
            for t in _on_circle(side, edge.low):
                if 0.0 <= t <= 1.0 and count < len(rows):
                    theta = math.atan2(side[0] + t * side[2], side[1] + t * side[3])
                    _write(rows[count], k, j, t, t, theta - edge.kappa, theta - edge.alpha)
                    count += 1
    if count < len(rows):
        rows[count].side = -1
    for k in range(count):
        scratch.events[2 * k], scratch.events[2 * k + 1] = rows[k].phi0, rows[k].phi1
    _sort(scratch.events, 2 * count)
    return 2 * count


@compiled
def _bound(foot: Foot, hole: HoleEdges, scratch: Buffers, i: int, out: Floats) -> float:
    """Return a lower bound of the margin in a piece, from its ends; infinite where not below ``out``."""
    low, high = scratch.events[i], scratch.events[i + 1]
    if high - low <= INSTANT or _is_carried(foot, scratch, i, out[0]):
        return math.inf
    active = _status(foot, hole, scratch, i)
    # the margins at both ends, and how far any point moves between them
    first = _gather(foot, hole, scratch, low, active, scratch.points)
    before = _inset_beside(scratch.points, first, foot, scratch.keep, False)
    second = _gather(foot, hole, scratch, high, active, scratch.moved_points)
    after = _inset_beside(scratch.moved_points, second, foot, scratch.keep, False)
    _lower(out, before, low)
    _lower(out, after, high)
    movement = 0.0
    for k in range(active):
        dx = scratch.points[k, 0] - scratch.moved_points[k, 0]
        movement = max(movement, math.hypot(dx, scratch.points[k, 1] - scratch.moved_points[k, 1]))
    for k in range(len(hole.nodes)):
        if hole.nodes[k, 2] == 0.0 or scratch.held[k]:
            movement = max(movement, hole.nodes[k, 1] * (high - low))
    scratch.movements[i] = movement
    return 0.5 * (before + after - movement)


@compiled
def _lower(out: Floats, margin: float, phi: float) -> None:
    if margin < out[0]:
        out[0], out[1] = margin, phi


@compiled
def _within(foot: Foot, hole: HoleEdges, scratch: Buffers, i: int, out: Floats) -> None:
    """Look for a lower margin within a piece: some samples, then the golden section about the lowest."""
    _keep_corners(foot, scratch, i, foot.all_corners)
    active = _status(foot, hole, scratch, i)
    start, step = scratch.events[i], (scratch.events[i + 1] - scratch.events[i]) / SAMPLES_PER_PIECE
    lowest, at = math.inf, 0
    for k in range(SAMPLES_PER_PIECE + 1):
        margin = _margin(foot, hole, scratch, start + k * step, active, True)
        if margin < lowest:
            lowest, at = margin, k
    _lower(out, lowest, start + at * step)
    if lowest - MAX_MARGIN_SLOPE * scratch.movements[i] / SAMPLES_PER_PIECE > out[0]:
        return
    for side in (at - 1, at + 1):  # an end may be the lowest sample, and the margin still fall from there
        if 0 <= side <= SAMPLES_PER_PIECE:
            movement = (side - at) * step
            if _margin(foot, hole, scratch, start + at * step + SLOPE_STEP * movement, active, True) < lowest:
                _section(foot, hole, scratch, i, start + at * step, start + side * step, active, out)


@compiled
def _section(
    foot: Foot, hole: HoleEdges, scratch: Buffers, i: int, start: float, end: float, active: int, out: Floats
) -> None:
    """Put into ``out`` the least margin between two shifts of piece ``i``, by the golden section."""
    low, high = start, end
    steepest = MAX_MARGIN_SLOPE * scratch.movements[i] / (scratch.events[i + 1] - scratch.events[i])
    first, second = high - GOLDEN_RATIO * (high - low), low + GOLDEN_RATIO * (high - low)
    here = _margin(foot, hole, scratch, first, active, True)
    there = _margin(foot, hole, scratch, second, active, True)
    for _ in range(40):
        if here < there:
            high, second, there = second, first, here
            first = high - GOLDEN_RATIO * (high - low)
            here = _margin(foot, hole, scratch, first, active, True)
        else:
            low, first, here = first, second, there
            second = low + GOLDEN_RATIO * (high - low)
            there = _margin(foot, hole, scratch, second, active, True)
        if abs(high - low) * foot.centre < MARGIN_STEP_M:
            break
        if min(here, there) - steepest * abs(high - low) > out[0]:
            return
    _lower(out, min(here, there), first if here < there else second)


@outlined
def _margin(foot: Foot, hole: HoleEdges, scratch: Buffers, phi: float, active: int, is_moving: bool) -> float:
    count = _gather(foot, hole, scratch, phi, active, scratch.points)
    return _inset_beside(scratch.points, count, foot, scratch.keep, is_moving)


@compiled
def _status(foot: Foot, hole: HoleEdges, scratch: Buffers, i: int) -> int:
    """Fill which corners of the hole are below the foot and which stretches are crossed; their number."""
    phi = 0.5 * (scratch.events[i] + scratch.events[i + 1])
    for k in range(len(hole.nodes)):
        if hole.nodes[k, 2] != 0.0:
            scratch.held[k] = _points_under(foot, hole.nodes[k, 0] + phi, hole.nodes[k, 1], scratch.points, 0)
    active = 0
    for k in range(len(scratch.rows)):
        if scratch.rows[k].side < 0:
            break
        first, last = scratch.rows[k].phi0, scratch.rows[k].phi1
        if min(first, last) < phi < max(first, last):
            scratch.active[active] = k
            active += 1
    return active


@compiled
def _gather(foot: Foot, hole: HoleEdges, scratch: Buffers, phi: float, active: int, points: Points) -> int:
    """Fill the points whose hull is the supported area: crossings first; return their number."""
    for k in range(active):
        row = scratch.rows[scratch.active[k]]
        side = foot.sides[row.side]
        t = _place(side, hole.edges[row.edge], row, phi)
        _add(points, k, side[0] + t * side[2], foot.centre - side[1] - t * side[3])
    count = active
    for k in range(len(foot.corners)):
        if scratch.keep[k]:
            count = _add(points, count, foot.corners[k, 0], foot.corners[k, 1])
    # of the hole's border what lies under the foot; of its corners those that do in the piece
    for k in range(len(hole.nodes)):
        theta, radius = hole.nodes[k, 0] + phi, hole.nodes[k, 1]
        if hole.nodes[k, 2] == 0.0:
            count = _points_under(foot, theta, radius, points, count)
        elif scratch.held[k]:
            y = foot.centre - radius * math.cos(theta)
            count = _add(points, count, radius * math.sin(theta), y)
    for j in range(len(hole.edges)):  # of an arc the point nearest to the foot of the centre of mass
        edge = hole.edges[j]
        if edge.arc and edge.bulge and edge.alpha + phi <= 0.0 <= edge.kappa + phi:
            count = _points_under(foot, 0.0, edge.low, points, count)
    return count


@compiled
def _points_under(foot: Foot, theta: float, radius: float, points: Points, count: int) -> int:
    """Add a point if it lies under an area of the foot; return how many there are."""
    if not foot.sector[2] < radius < foot.sector[3]:
        return count
    if not foot.sector[0] < theta < foot.sector[1] and abs(theta) < math.pi:
        return count
    x, q, inside = radius * math.sin(theta), radius * math.cos(theta), False
    for k in range(len(foot.sides)):
        if not foot.closed[k]:
            continue
        q0, q1 = foot.sides[k, 1], foot.sides[k, 1] + foot.sides[k, 3]
        if (q0 > q) != (q1 > q):
            share = (q - q0) / foot.sides[k, 3]
            if foot.sides[k, 0] + share * foot.sides[k, 2] > x:
                inside = not inside
    return _add(points, count, x, foot.centre - q) if inside else count


@compiled
def _add(points: Points, count: int, x: float, y: float) -> int:
    points[count, 0], points[count, 1] = x, y
    return count + 1


# -- which corners of a foot keep track below while a hole passes, and what these alone carry


@outlined
def _is_carried(foot: Foot, scratch: Buffers, i: int, margin: float) -> bool:
    """Tell whether the corners that have track below in a piece carry a foot by a margin [m] for certain.

    More track can only carry it better, so the few corners of its hull are asked first; with all of them it
    is carried as on the whole track, to the last digit. Fills ``keep`` where that is not certain.
    """
    _keep_corners(foot, scratch, i, foot.hull)
    whole = len(foot.hull) > 0
    for k in foot.hull:
        whole = whole and scratch.keep[k] == 1
    inset = _kept_inset(foot, scratch, foot.hull)
    if inset > margin + MARGIN_ROUNDING_M or (whole and inset >= max(margin, 0.0)):
        return True
    _keep_corners(foot, scratch, i, foot.all_corners)
    return _kept_inset(foot, scratch, foot.all_corners) > margin + MARGIN_ROUNDING_M


@outlined
def _kept_inset(foot: Foot, scratch: Buffers, corners: Ints) -> float:
    """The margin [m] on no more than those of some corners of a foot that have track below."""
    count = 0
    for k in corners:
        if scratch.keep[k]:
            count = _add(scratch.points, count, foot.corners[k, 0], foot.corners[k, 1])
    return _inset_beside(scratch.points, count, foot, scratch.keep, False)


@compiled
def _keep_corners(foot: Foot, scratch: Buffers, i: int, corners: Ints) -> None:
    """Fill which of some corners of the foot have track below in a piece between two events."""
    phi = 0.5 * (scratch.events[i] + scratch.events[i + 1])
    for k in corners:
        theta, over = foot.polar[k, 0] - phi, False
        for j in range(scratch.crossings[k]):
            if scratch.angles[k, j] > theta:
                over = not over
        scratch.keep[k] = 0 if over else 1


# -- how far the origin lies inside the convex hull of a few points


@compiled
def _inset(points: Points, count: int, far: float) -> float:
    """The signed distance [m] of the origin to the hull's border of ``count`` points; ``-far`` without any.

    Source: R. A. Jarvis, "On the identification of the convex hull of a finite set of points in the plane",
    Information Processing Letters 2(1), 18-21, 1973.
    """
    if count == 0:
        return -far
    first = 0  # the point of least y, of several the one of least x
    for k in range(1, count):
        lower = points[k, 1] < points[first, 1]
        if lower or (points[k, 1] == points[first, 1] and points[k, 0] < points[first, 0]):
            first = k
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
def _next(points: Points, count: int, ax: float, ay: float) -> int:
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
def _inset_beside(points: Points, count: int, foot: Foot, keep: Ints, is_moving: bool) -> float:
    """The same [m] of a foot of which some corners are kept, its own hull known.

    ``points``: the corners kept and those that replace the others. ``is_moving``: leave out the sides of the
    foot's own hull, which hide how the others move; infinite without others.
    """
    total, first = len(foot.hull), -1
    for k in range(total):
        if keep[foot.hull[k]]:
            first = k
            break
    if first < 0:
        return _inset(points, count, foot.reach)
    line = math.inf
    for step in range(total):
        k = (first + step) % total
        if not keep[foot.hull[k]]:
            continue
        last = k + 1
        while not keep[foot.hull[last % total]]:
            last += 1
        own = last == k + 1
        if own and is_moving:
            continue
        own_inset = foot.insets[k] if own else _inset_between(points, count, foot, k, last, is_moving)
        if own_inset < 0.0:
            return _inset(points, count, foot.reach)
        line = min(line, own_inset)
    return line


@compiled
def _inset_between(points: Points, count: int, foot: Foot, k: int, last: int, is_moving: bool) -> float:
    """The least line distance along the hull from one kept corner of the foot to the next, or less than 0."""
    total = len(foot.hull)
    aside, behind = foot.insets[k], foot.insets[(last - 1) % total]
    last %= total
    ax, ay = foot.corners[foot.hull[k], 0], foot.corners[foot.hull[k], 1]
    ex, ey = foot.corners[foot.hull[last], 0], foot.corners[foot.hull[last], 1]
    line = math.inf
    for _ in range(count + 1):
        there = _next(points, count, ax, ay)
        if there < 0:
            return -1.0
        bx, by = points[there, 0], points[there, 1]
        distance = (ax * (by - ay) - ay * (bx - ax)) / math.sqrt((bx - ax) ** 2 + (by - ay) ** 2)
        if not is_moving or (
            abs(distance - aside) > LINE_TOLERANCE_M and abs(distance - behind) > LINE_TOLERANCE_M
        ):
            line = min(line, distance)
        ax, ay = bx, by
        if line < 0.0 or (abs(ax - ex) < POINT_TOLERANCE_M and abs(ay - ey) < POINT_TOLERANCE_M):
            break
    return line


# -- where the sides of a foot cross the edges of a hole


@compiled
def _line(side: Floats) -> Line:
    """Return the numbers of a side that all edges need."""
    x, q = side[0] + side[2], side[1] + side[3]
    start, end = math.hypot(side[0], side[1]), math.hypot(x, q)
    a = side[2] * side[2] + side[3] * side[3]
    foot = -(side[0] * side[2] + side[1] * side[3]) / a
    share = min(max(foot, 0.0), 1.0)
    return Line(
        a,
        foot,
        side[2] * side[1] - side[0] * side[3],
        start,
        end,
        math.atan2(side[0], side[1]),
        math.atan2(x, q),
        math.hypot(side[0] + share * side[2], side[1] + share * side[3]) * (1.0 - SAFE_RADIUS),
        max(start, end) * (1.0 + SAFE_RADIUS),
    )


@compiled
def _on_circle(side: Floats, radius: float) -> tuple[float, float]:
    """The two shares of a side's line at which it crosses a circle about the axis; -1 for none."""
    a = side[2] * side[2] + side[3] * side[3]
    nearest = -(side[0] * side[2] + side[1] * side[3]) / a
    low = math.hypot(side[0] + nearest * side[2], side[1] + nearest * side[3])
    if radius <= low:
        return -1.0, -1.0
    half = math.sqrt((radius - low) * (radius + low) / a)
    return nearest - half, nearest + half


@compiled
def _on_slant(
    side: Floats, line: Line, edge: np.record, k: int, j: int, out: np.recarray, count: int, cuts: Floats
) -> int:
    # it is cut at both radii, where its distance from the axis is least, and where the edge touches it
    cuts[0], cuts[1], number = 0.0, 1.0, 2
    for radius in (edge.low, edge.high):
        if line.nearest <= radius <= line.farthest:
            for share in _on_circle(side, radius):
                number = _add_cut(cuts, number, share)
    number = _add_cut(cuts, number, line.foot)
    if edge.kappa != 0.0:
        a, moment = line.a, line.moment  # d theta / dt = moment / r^2
        height2, pull2 = moment * moment / a, (moment / edge.kappa) ** 2
        # kappa^2 (p v)^2 r^2 = moment^2, with p v = a tau and r^2 = height2 + a tau^2
        b = a * a * height2
        z = 2.0 * pull2 / max(b + math.sqrt(b * b + 4.0 * a * a * a * pull2), TINY)
        number = _add_cut(cuts, number, line.foot + math.copysign(math.sqrt(z), moment / edge.kappa))
    if number > 2:
        _sort(cuts, number)
    for i in range(number - 1):
        t0, t1 = cuts[i], cuts[i + 1]
        if t1 - t0 < SHORT_SIDE or count >= len(out):
            continue
        middle = 0.5 * (t0 + t1)
        radius = math.hypot(side[0] + middle * side[2], side[1] + middle * side[3])
        if edge.low <= radius <= edge.high:
            first = _turn(edge, line.theta, line.start) if t0 == 0.0 else _shift(side, edge, t0)
            last = _turn(edge, line.theta_end, line.end) if t1 == 1.0 else _shift(side, edge, t1)
            _write(out[count], k, j, t0, t1, first, last)
            count += 1
    return count


@compiled
def _add_cut(cuts: Floats, number: int, share: float) -> int:
    if 0.0 < share < 1.0:
        cuts[number] = share
        number += 1
    return number


@compiled
def _write(row: np.record, k: int, j: int, t0: float, t1: float, phi0: float, phi1: float) -> None:
    row.side, row.edge, row.t0, row.t1, row.phi0, row.phi1 = k, j, t0, t1, phi0, phi1


@compiled
def _shift(side: Floats, edge: np.record, t: float) -> float:
    """The shift [rad] at which an edge crosses a side at share ``t`` of its length."""
    x, q = side[0] + t * side[2], side[1] + t * side[3]
    return _turn(edge, math.atan2(x, q), math.hypot(x, q))


@compiled
def _turn(edge: np.record, theta: float, radius: float) -> float:
    """The shift [rad] at which an edge crosses a place at an angle [rad] and a radius [m]."""
    bend = 0.0 if edge.gamma == 0.0 else math.asin(min(edge.gamma / radius, 1.0))
    return theta - edge.alpha - edge.kappa * radius - bend


@compiled
def _place(side: Floats, edge: np.record, row: np.record, phi: float) -> float:
    """The share [1] of a side at which an edge shifted by ``phi`` [rad] crosses it, on one stretch."""
    low, high = row.t0, row.t1
    if low == high:
        return low
    below, above = row.phi0 - phi, row.phi1 - phi
    if below == 0.0 or above == 0.0 or (below > 0.0) == (above > 0.0):
        return low if abs(below) <= abs(above) else high
    t = low - below * (high - low) / (above - below)
    for _ in range(60):
        value = _shift(side, edge, t) - phi
        low, high = (t, high) if (value > 0.0) == (below > 0.0) else (low, t)
        # the derivative of the shift by the share of the side
        x, q = side[0] + t * side[2], side[1] + t * side[3]
        radius2 = x * x + q * q
        outward, radius = x * side[2] + q * side[3], math.sqrt(radius2)
        slope = (side[2] * q - side[3] * x) / radius2 - edge.kappa * outward / radius
        if edge.gamma != 0.0:
            slope += edge.gamma * outward / (radius2 * math.sqrt(max(radius2 - edge.gamma**2, TINY)))
        step = -value / slope if slope != 0.0 else 0.0
        if abs(step) < SHORT_SIDE and slope != 0.0:
            return min(max(t + step, low), high)
        t = t + step if low < t + step < high and slope != 0.0 else 0.5 * (low + high)
        if high - low < SHORT_SIDE:
            return t
    return t


@compiled
def _sort(values: Floats, count: int) -> None:
    """Sort the first values of an array in place (Shell, with Ciura's gaps)."""
    for gap in (1750, 701, 301, 132, 57, 23, 10, 4, 1):
        for i in range(gap, count):
            value, k = values[i], i - gap
            while k >= 0 and values[k] > value:
                values[k + gap] = values[k]
                k -= gap
            values[k + gap] = value
