"""The least margin of a foot while a hole passes below it: exact from event to event."""

import math
from typing import NamedTuple

import numpy as np

from feederscrew.geometry.compiled import compiled, entry, outlined
from feederscrew.tooling.kernel.carried_corners import carried, keep_corners, kept_inset
from feederscrew.tooling.kernel.crossing import place, sort, stretches
from feederscrew.tooling.kernel.hull_depth import inset_beside

MARGIN_STEP_M = 1e-9  # [m] a lower margin is looked for if it may be lower by more
INSTANT = 1e-12  # [rad] a shorter piece is one of rounding
SAMPLES_PER_PIECE = 4  # parts of a piece that may hold the least margin
MAX_MARGIN_SLOPE = 2.0  # of a point's mean speed in a piece: no faster does a margin fall beside a sample
GOLDEN_SECTIONS = 40
SLOPE_STEP = 1e-3  # of a sample's distance: there the margin is seen to rise or to fall
GOLDEN_RATIO = 0.5 * (math.sqrt(5.0) - 1.0)


class Foot(NamedTuple):
    """What touches the track, about the bowl's axis: x ahead, q away from the axis."""

    sides: np.ndarray  # (E, 4) [m] start and vector
    closed: np.ndarray  # (E,) 1 where the side bounds an area
    corners: np.ndarray  # (V, 2) [m]
    polar: np.ndarray  # (V, 2) [rad, m] theta and r of the corners
    centre: float  # [m] q of the foot of the centre of mass, at x = 0
    hull: np.ndarray  # (H,) int, corners of the convex hull, counter-clockwise seen from above
    insets: np.ndarray  # (H,) [m] from the foot of the centre of mass to the line of the side behind each
    reach: float  # [m] from there to the farthest corner
    all_corners: np.ndarray  # (V,) int, all corners
    sector: np.ndarray  # (4,) [rad, m] theta and r between which its areas lie for certain


class VerdictArrays(NamedTuple):
    """Arrays the verdict works in."""

    rows: np.recarray  # (N,) STRETCH
    events: np.ndarray  # (2 N,) [rad]
    bounds: np.ndarray  # (2 N,) [m] the margin between two events is not less
    movements: np.ndarray  # (2 N,) [m] how far any of its points moves between two events
    cuts: np.ndarray  # (10,)
    keep: np.ndarray  # (V,) int, corners with track below
    held: np.ndarray  # (P,) int, corners of the hole with the foot above
    active: np.ndarray  # (N,) int, stretches crossed now
    points: np.ndarray  # (V + N + P + M, 2)
    moved_points: np.ndarray  # (V + N + P + M, 2)


@entry
def least(foot, hole, scratch, low, high, out):
    """Fill the least margin over a passage and the shift of the hole at which it occurs.

    Source: own; docs/tooling.md, "1. The method": exact from event to event.

    Parameters
    ----------
    foot : Foot
    hole : HoleEdges
    scratch : VerdictArrays
    low : float [m]
        A margin below it is returned as it is found, wherever it is lowest; minus infinity for none.
    high : float [m]
        A margin above it is returned as any that is above; infinite for none.
    out : (2,) float [m, rad]
        To be filled.
    """
    for k in range(len(foot.corners)):
        scratch.keep[k] = 1
    out[0], out[1] = min(kept_inset(foot, scratch, foot.all_corners), high + 2.0 * MARGIN_STEP_M), 0.0
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


@compiled
def _bound(foot, hole, scratch, i, out):
    """What the margin in a piece is not below, from its two ends; infinite where it is not below ``out``."""
    low, high = scratch.events[i], scratch.events[i + 1]
    if high - low <= INSTANT:
        return math.inf
    if carried(foot, hole, scratch, i, out[0]):
        return math.inf
    active = status(foot, hole, scratch, i)
    before, after, movement = _ends(foot, hole, scratch, low, high, active, out)
    scratch.movements[i] = movement
    return 0.5 * (before + after - movement)


@compiled
def _events(foot, hole, scratch):
    """Fill the shifts at which a corner of either crosses the border of the other, sorted; their number."""
    count = stretches(foot.sides, hole.edges, scratch.rows, scratch.cuts)
    if count < len(scratch.rows):
        scratch.rows[count].side = -1
    for k in range(count):
        scratch.events[2 * k] = scratch.rows[k].phi0
        scratch.events[2 * k + 1] = scratch.rows[k].phi1
    sort(scratch.events, 2 * count)
    return 2 * count


@compiled
def status(foot, hole, scratch, i):
    """Fill which corners of the hole are below the foot and which stretches are crossed; their number."""
    phi = 0.5 * (scratch.events[i] + scratch.events[i + 1])
    for k in range(len(hole.nodes)):
        if hole.nodes[k, 2] != 0.0:
            scratch.held[k] = points_under(foot, hole.nodes[k, 0] + phi, hole.nodes[k, 1], scratch.points, 0)
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
def _ends(foot, hole, scratch, low, high, active, out):
    """Margins at both ends of a piece, written to ``out``, and how far any point moves between them."""
    first = _gather(foot, hole, scratch, low, active, True, scratch.points)
    before = inset_beside(scratch.points, first, foot, scratch.keep)
    second = _gather(foot, hole, scratch, high, active, True, scratch.moved_points)
    after = inset_beside(scratch.moved_points, second, foot, scratch.keep)
    _lower(out, before, low)
    _lower(out, after, high)
    movement = 0.0
    for k in range(active):
        dx = scratch.points[k, 0] - scratch.moved_points[k, 0]
        movement = max(movement, math.hypot(dx, scratch.points[k, 1] - scratch.moved_points[k, 1]))
    for k in range(len(hole.nodes)):
        if hole.nodes[k, 2] == 0.0 or scratch.held[k]:
            movement = max(movement, hole.nodes[k, 1] * (high - low))
    return before, after, movement


@compiled
def _lower(out, margin, phi):
    if margin < out[0]:
        out[0], out[1] = margin, phi


@compiled
def _within(foot, hole, scratch, i, out):
    """Look for a lower margin within a piece: some samples, then the golden section about the lowest.

    Of the hull's sides only those that move count: the others are known at the ends.
    """
    keep_corners(foot, hole, scratch, i, foot.all_corners)
    active = status(foot, hole, scratch, i)
    start, step = scratch.events[i], (scratch.events[i + 1] - scratch.events[i]) / SAMPLES_PER_PIECE
    lowest, at = math.inf, 0
    for k in range(SAMPLES_PER_PIECE + 1):
        margin = _margin(foot, hole, scratch, start + k * step, active)
        if margin < lowest:
            lowest, at = margin, k
    _lower(out, lowest, start + at * step)
    if lowest - MAX_MARGIN_SLOPE * scratch.movements[i] / SAMPLES_PER_PIECE > out[0]:
        return
    for side in (at - 1, at + 1):  # an end may be the lowest sample, and the margin still fall from there
        if 0 <= side <= SAMPLES_PER_PIECE:
            movement = (side - at) * step
            if _margin(foot, hole, scratch, start + at * step + SLOPE_STEP * movement, active) < lowest:
                _section(foot, hole, scratch, i, start + at * step, start + side * step, active, out)


@compiled
def _section(foot, hole, scratch, i, start, end, active, out):
    """Tell ``out`` of the least margin between two shifts of piece ``i``, by the golden section."""
    low, high = start, end
    steepest = MAX_MARGIN_SLOPE * scratch.movements[i] / (scratch.events[i + 1] - scratch.events[i])
    first, second = high - GOLDEN_RATIO * (high - low), low + GOLDEN_RATIO * (high - low)
    here = _margin(foot, hole, scratch, first, active)
    there = _margin(foot, hole, scratch, second, active)
    for _ in range(GOLDEN_SECTIONS):
        if here < there:
            high, second, there = second, first, here
            first = high - GOLDEN_RATIO * (high - low)
            here = _margin(foot, hole, scratch, first, active)
        else:
            low, first, here = first, second, there
            second = low + GOLDEN_RATIO * (high - low)
            there = _margin(foot, hole, scratch, second, active)
        if abs(high - low) * foot.centre < MARGIN_STEP_M:
            break
        if min(here, there) - steepest * abs(high - low) > out[0]:
            return
    _lower(out, min(here, there), first if here < there else second)


@outlined
def _margin(foot, hole, scratch, phi, active):
    count = _gather(foot, hole, scratch, phi, active, True, scratch.points)
    return inset_beside(scratch.points, count, foot, scratch.keep, True)


@compiled
def _gather(foot, hole, scratch, phi, active, present, points):
    """Fill the points whose hull is the supported area: crossings first; return their number."""
    for k in range(active):
        row = scratch.rows[scratch.active[k]]
        side = foot.sides[row.side]
        t = place(side, hole.edges[row.edge], row, phi)
        points[k, 0] = side[0] + t * side[2]
        points[k, 1] = foot.centre - side[1] - t * side[3]
    count = active
    for k in range(len(foot.corners)):
        if scratch.keep[k]:
            points[count, 0] = foot.corners[k, 0]
            points[count, 1] = foot.centre - foot.corners[k, 1]
            count += 1
    return _border(foot, hole, scratch.held, phi, points, count) if present else count


@compiled
def _border(foot, hole, held, phi, points, count):
    """Add points of the hole's border that lie under the foot; of its corners those that do in the piece."""
    for k in range(len(hole.nodes)):
        theta, radius = hole.nodes[k, 0] + phi, hole.nodes[k, 1]
        if hole.nodes[k, 2] == 0.0:
            count = points_under(foot, theta, radius, points, count)
        elif held[k]:
            points[count, 0] = radius * math.sin(theta)
            points[count, 1] = foot.centre - radius * math.cos(theta)
            count += 1
    for j in range(len(hole.edges)):  # of an arc the point nearest to the foot of the centre of mass
        edge = hole.edges[j]
        if edge.arc and edge.bulge and edge.alpha + phi <= 0.0 <= edge.kappa + phi:
            count = points_under(foot, 0.0, edge.low, points, count)
    return count


@compiled
def points_under(foot, theta, radius, points, count):
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
    if inside:
        points[count, 0], points[count, 1] = x, foot.centre - q
        count += 1
    return count
