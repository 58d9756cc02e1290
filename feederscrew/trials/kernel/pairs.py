"""Compiled search for contacts between two parts of one shape: corners on faces, and edges on edges.

Everything is looked for in the body axes of the part that is touched, the second: ``work.frame`` (12,) has
the first part's turn in them, 9 entries by rows, and its place. Which part is the second changes on the way.
A contact is two records of `workspace.CONTACT`, one for each part, with the same axes; the normal points
towards the first part. Lengths are in the size L of the part. Grounds and figures: docs/method/trial.md,
"Depths".
"""

import math

from feederscrew.arrivals.kernel.body import X
from feederscrew.base.arrays import Floats, Ints, Rows, Triple
from feederscrew.base.geometry.compiled import compiled, outlined
from feederscrew.trials.kernel.contact import set_axes, set_levers
from feederscrew.trials.kernel.plate_views import (
    BLOCK,
    CROSSING_SINE,
    EDGE_EXTENSION,
    MAX_DEPTH,
    NORMAL_SLACK,
    box_is_off,
    cross,
    distance_beside_face,
    dot,
    extent_of,
    height_over_face,
    is_over_face,
    place_of,
    point_along,
    rotate,
    rotate_back,
    subtract,
)
from feederscrew.trials.kernel.workspace import IntPair, TrueSolid, Vec3, Workspace

FACE_MARGIN = 2e-3  # [L] by which a corner may lie outside the face it touches
# [L] a deeper contact is one only where the place between the two is in the body: as deep as the band beside
# a face is wide, in which corners in the air count as over it
CHECKED_DEPTH = FACE_MARGIN
ROUNDING = 1e-9  # [L] more than rounding moves a box
# lists look ahead by the greater of these beyond the reach
LEAST_LIST_MARGIN = 0.05  # [L]
LIST_MARGIN_SHARE = 2.0  # [1] times the reach
MAX_NORMAL_TURN = 0.5  # [1] sine of the angle by which the normal of two edges may turn while lists hold
LIST_REACH = 0.1  # [L] greater than any reach: what touches a part is within its radius and that


@outlined
def find_pair_contacts(solid: TrueSolid, work: Workspace, i: int, j: int, reach: float) -> None:
    """Add contacts of two parts with each other, if they come within ``reach`` [L].

    Which corners may touch which faces, and which edges cross, is listed once in a while. The lists hold as
    long as neither part has moved further, as the other sees it, than they look ahead: L. Verlet, Phys. Rev.
    159, 98-103, 1967. They never decide what touches: every contact is the same as without them. Listed is
    every pair that could touch before that. Not listed are corners that cannot become the lowest, and edges
    whose normal cannot come between their faces. Beside each pair stands ``off``, a lower bound of how much
    nearer it must come. Lists that hold more than they have room for have a ``reach`` below 0: then all is
    looked at in every step. New ones have 0.
    """
    if _balls_are_apart(solid, work, i, j, reach + FACE_MARGIN):
        return
    _place_in(work, i, j)
    if not _boxes_meet(work, reach):
        return
    slot = 0
    while slot < len(work.pair_lists[i]) and work.pair_lists[i, slot].partner != j:
        slot += 1
    if slot == len(work.pair_lists[i]):
        slot = work.next_lists[i]  # the one that was made longest ago makes room
        work.next_lists[i] = (slot + 1) % len(work.pair_lists[i])
        work.pair_lists[i, slot].partner, work.pair_lists[i, slot].reach = j, 0.0
    lists = work.pair_lists[i, slot]
    own, theirs, edges = work.own_corners[i, slot], work.their_corners[i, slot], work.near_crossings[i, slot]
    far = _shift_of(solid, work.frame, work.pair_frames[i, slot]) + reach
    if far > abs(lists.reach):
        for e in range(12):
            work.pair_frames[i, slot, e] = work.frame[e]
        wide = reach + max(LEAST_LIST_MARGIN, LIST_MARGIN_SHARE * reach)
        lists.own = _list_corners(work, solid, wide, wide - reach, own)
        lists.edges = _list_edges(work, solid, wide, edges)
        _place_in(work, j, i)
        lists.theirs = _list_corners(work, solid, wide, wide - reach, theirs)
        _place_in(work, i, j)
        lists.nearest = min(
            _nearest_of(own, lists.own), _nearest_of(edges, lists.edges), _nearest_of(theirs, lists.theirs)
        )
        far = reach
        is_full = lists.own == len(own) or lists.theirs == len(theirs) or lists.edges == len(edges)
        lists.reach = -wide if is_full else wide
    if lists.reach < 0.0:  # there is more than they have room for
        count = _add_corners(work, solid, i, j, reach, work.pair_rows[0])
        count = _add_edges(work, solid, i, j, reach, count)
        _place_in(work, j, i)
        work.pair_rows[0] = _add_corners(work, solid, j, i, reach, count)
        return
    if lists.nearest > far:
        return
    count = _touch_corners(work, solid, (i, j), own, lists.own, reach, far, work.pair_rows[0])
    count = _touch_edges(work, solid, (i, j), edges, lists.edges, reach, far, count)
    _place_in(work, j, i)
    work.pair_rows[0] = _touch_corners(work, solid, (j, i), theirs, lists.theirs, reach, far, count)


@compiled
def _nearest_of(near: Rows, count: int) -> float:
    """Return how much nearer [L] the first of so many that are listed must come to touch."""
    nearest = math.inf
    for m in range(count):
        nearest = min(nearest, near[m].off)
    return nearest


@compiled
def _shift_of(solid: TrueSolid, now: Floats, before: Floats) -> float:
    """Return how far [L] at most a point of a part has moved since, seen by the other one.

    Frames (12,) as ``work.frame``. The same bound holds for points of either part: their distances do not
    depend on whose axes they are seen in.
    """
    turned = moved = 0.0
    for e in range(9):
        turned += (now[e] - before[e]) ** 2
    for e in range(9, 12):
        moved += (now[e] - before[e]) ** 2
    # The root of half the sum of squares of a difference of rotations is the longest chord of a unit ball,
    # 2 sin(t/2) of a turn by t; a thousandth more than rounding
    return math.sqrt(moved) + 1.001 * math.sqrt(0.5 * turned) * (solid.radius + LIST_REACH)


@compiled
def may_meet(solid: TrueSolid, work: Workspace, i: int, j: int, reach: float) -> bool:
    """Say whether two parts come within ``reach`` [L] of each other, by balls and boxes around them."""
    if _balls_are_apart(solid, work, i, j, reach):
        return False
    _place_in(work, i, j)
    if not _boxes_meet(work, reach):
        return False
    _place_in(work, j, i)
    return _boxes_meet(work, reach)


@compiled
def _balls_are_apart(solid: TrueSolid, work: Workspace, i: int, j: int, reach: float) -> bool:
    """Tell whether the balls around two parts are further than ``reach`` [L] from each other."""
    square = 0.0
    for e in range(3):
        square += (work.states[i, X + e] - work.states[j, X + e]) ** 2
    return square > (2.0 * solid.radius + reach) ** 2


@compiled
def _boxes_meet(work: Workspace, reach: float) -> bool:
    """Tell whether the box of one part comes to the other's, along the other's axes, as ``work.frame``."""
    move = work.frame
    for p in range(3):
        middle, half = move[9 + p], reach
        for q in range(3):
            middle += move[3 * p + q] * 0.5 * (work.least[q] + work.most[q])
            half += abs(move[3 * p + q]) * 0.5 * (work.most[q] - work.least[q])
        if middle + half < work.least[p] or middle - half > work.most[p]:
            return False
    return True


@compiled
def _place_in(work: Workspace, i: int, j: int) -> None:
    """Write rotation and place of part i in the body axes of part j."""
    a, b, move = work.turns[i], work.turns[j], work.frame
    for p in range(3):
        move[9 + p] = 0.0
        for q in range(3):
            move[3 * p + q] = b[p] * a[q] + b[3 + p] * a[3 + q] + b[6 + p] * a[6 + q]
            move[9 + p] += b[3 * q + p] * (work.states[i, X + q] - work.states[j, X + q])


@compiled
def _add_contact(
    work: Workspace, solid: TrueSolid, parts: IntPair, spot: Vec3, normal: Triple, gap: float, count: int
) -> int:
    """Add a contact at a spot and with a normal in the second part's axes; how many rows there are now."""
    if count + 2 > len(work.pairs):
        return count
    i, j = parts
    move, first, second = work.frame, work.pairs[count], work.pairs[count + 1]
    axis = rotate(work.turns[j], normal)
    set_axes(first, work.tangents[i], axis)
    set_axes(second, work.tangents[i], axis)
    own = rotate_back(move, subtract(spot, (move[9], move[10], move[11])))
    set_levers(first, work.turns[i], solid.inertia, own)
    set_levers(second, work.turns[j], solid.inertia, spot)
    first.along_mass = second.along_mass = 1.0 / (1.0 / first.along_mass + 1.0 / second.along_mass)
    first.aside_mass = second.aside_mass = 1.0 / (1.0 / first.aside_mass + 1.0 / second.aside_mass)
    first.normal_mass = second.normal_mass = 1.0 / (1.0 / first.normal_mass + 1.0 / second.normal_mass)
    first.along_impulse = first.aside_impulse = first.normal_impulse = 0.0
    first.gap = gap
    work.owners[count], work.owners[count + 1] = i, j
    return count + 2


@compiled
def _touched_face(
    work: Workspace, solid: TrueSolid, near: Rows, faces: IntPair, p: Triple, reach: float, far: float
) -> tuple[int, float]:
    """Triangle that a corner at a place touches, the least deep of some it may, and the gap; -1 for none.

    ``near`` (R,) are corners and triangles, ``faces`` where those of the corner begin and end. Those that had
    to come nearer by more than ``far`` [L] are not looked at.
    """
    gap, face, k = -MAX_DEPTH, -1, near[faces[0]].ours
    for f in range(faces[0], faces[1]):
        if near[f].off > far:
            continue
        m = near[f].theirs
        off = height_over_face(solid, m, p[0], p[1], p[2])
        if not gap < off < reach or not is_over_face(solid, m, p[0], p[1], p[2], FACE_MARGIN):
            continue
        if not _is_lowest(work, solid, k, m, p, NORMAL_SLACK):
            continue
        if off > -CHECKED_DEPTH or is_inside(solid, p, solid.normals[m], FACE_MARGIN - off):
            gap, face = off, m
    return face, gap


@outlined
def is_inside(solid: TrueSolid, p: Vec3, out: Vec3, length: float) -> bool:
    """Return whether a place (3,) [L] in a body's axes is inside it, by a line ``length`` [L] along ``out``.

    ``out`` (3,) [1] leads to a surface that is so near, and the line has to end outside. A place behind the
    plane of a face need not be in the body: it may lie beside it, before another face, or behind a thin wall.
    The line from a place inside leaves the body once more than it enters it. The mesh has to be closed, its
    normals outwards.
    """
    q, crossings = point_along(p, length, out), 0
    for block in range(len(solid.face_blocks)):
        if box_is_off(solid.face_blocks[block], p, q, 0.0):
            continue
        for m in range(block * BLOCK, min((block + 1) * BLOCK, len(solid.triangles))):
            lean = dot(solid.normals[m], out)
            fall = -height_over_face(solid, m, p[0], p[1], p[2])
            if lean == 0.0 or not 0.0 <= fall / lean <= length:
                continue
            rows, side = solid.triangles[m], 1.0 if lean > 0.0 else -1.0
            a, b = subtract(solid.vertices[rows[0]], p), subtract(solid.vertices[rows[1]], p)
            c = subtract(solid.vertices[rows[2]], p)
            if min(dot(out, cross(a, b)) * side, dot(out, cross(b, c)) * side) < 0.0:
                continue
            if dot(out, cross(c, a)) * side >= 0.0:
                crossings += int(side)
    return crossings > 0


@compiled
def _is_lowest(work: Workspace, solid: TrueSolid, k: int, m: int, p: Triple, slack: float) -> bool:
    """Tell whether corner k, at a place, is the lowest of those around it over triangle m, by a slack [1]."""
    for n in range(solid.firsts[k], solid.firsts[k + 1]):
        away = subtract(place_of(work.frame, solid.corners[solid.neighbours[n]]), p)
        height = dot(away, solid.normals[m])
        if height < 0.0 and height < -slack * math.sqrt(dot(away, away)):
            return False
    return True


@compiled
def _empty_box(box: Floats) -> None:
    for e in range(3):
        box[e], box[3 + e] = math.inf, -math.inf


@compiled
def _extend_box(box: Floats, p: Vec3) -> None:
    for e in range(3):
        box[e], box[3 + e] = min(box[e], p[e]), max(box[3 + e], p[e])


@compiled
def _near_blocks(blocks: Floats, box: Floats, reach: float, near: Ints) -> int:
    """Write which blocks of the second part's faces, or of its edges, come to a box; how many."""
    count = 0
    for m in range(len(blocks)):
        if not box_is_off(blocks[m], box[:3], box[3:], reach):
            near[count] = m
            count += 1
    return count


@compiled
def _may_come(work: Workspace, block: Floats, reach: float) -> bool:
    """Tell whether a box of the first part, placed by ``work.frame``, may come to one of the second."""
    for e in range(3):
        low, high = extent_of(work.frame, block, e)
        if low > work.most[e] + reach + ROUNDING or high < work.least[e] - reach - ROUNDING:
            return False
    return True


@compiled
def _near_corners(work: Workspace, solid: TrueSolid, reach: float) -> int:
    """Write which corners of the part that ``work.frame`` places come to the other's box, and their own box.

    They are written to ``work.indices`` in their order, for it is that in which contacts are solved.
    """
    low, high, near = work.least, work.most, 0
    _empty_box(work.box)
    for b in range(len(solid.corner_blocks)):
        if not _may_come(work, solid.corner_blocks[b], reach):
            continue
        for m in range(BLOCK * b, min(BLOCK * (b + 1), len(solid.corners))):
            k = solid.block_order[m]
            p = place_of(work.frame, solid.corners[k])
            if not _is_in_box(p, low, high, reach):
                continue
            place = near
            while place > 0 and work.indices[place - 1] > k:
                work.indices[place] = work.indices[place - 1]
                place -= 1
            work.indices[place] = k
            near += 1
            _extend_box(work.box, p)
    return near


@compiled
def _is_in_box(p: Triple, low: Floats, high: Floats, reach: float) -> bool:
    if p[0] < low[0] - reach or p[1] < low[1] - reach or p[2] < low[2] - reach:
        return False
    return p[0] <= high[0] + reach and p[1] <= high[1] + reach and p[2] <= high[2] + reach


@compiled
def _list_faces(
    work: Workspace,
    solid: TrueSolid,
    blocks: int,
    k: int,
    reach: float,
    margin: float,
    near: Rows,
    count: int,
) -> int:
    """Add the faces that corner k may touch to ``near`` (R,), after so many; how many there are then.

    They are looked for ``reach`` [L] ahead, by ``margin`` [L] of it because the parts move on. It is R where
    there are more than that.
    """
    p, slack = place_of(work.frame, solid.corners[k]), NORMAL_SLACK + ROUNDING
    if margin > 0.0:
        slack += _turn_within(solid, reach)
    for f in range(blocks):
        block = work.face_blocks[f]
        if box_is_off(solid.face_blocks[block], p, p, reach + MAX_DEPTH):
            continue
        for m in range(block * BLOCK, min((block + 1) * BLOCK, len(solid.triangles))):
            off = height_over_face(solid, m, p[0], p[1], p[2])
            if not -MAX_DEPTH - margin < off < reach or count == len(near):
                continue
            beside = distance_beside_face(solid, m, p[0], p[1], p[2]) - FACE_MARGIN - ROUNDING
            if beside < margin and _is_lowest(work, solid, k, m, p, slack):
                near[count].ours, near[count].theirs, near[count].off = k, m, max(off, beside)
                count += 1
    return count


@compiled
def _turn_within(solid: TrueSolid, wide: float) -> float:
    """Return by how much [1] directions of two parts turn at most against each other while lists hold."""
    return wide / (solid.radius + LIST_REACH)


@compiled
def _list_corners(work: Workspace, solid: TrueSolid, reach: float, margin: float, near: Rows) -> int:
    """Write which corners may touch which faces to ``near`` (R,); how many, R where there are more."""
    corners, count = _near_corners(work, solid, reach), 0
    blocks = _near_blocks(solid.face_blocks, work.box, reach + MAX_DEPTH, work.face_blocks) if corners else 0
    for c in range(corners):
        count = _list_faces(work, solid, blocks, work.indices[c], reach, margin, near, count)
    return count


@compiled
def _touch_corners(
    work: Workspace,
    solid: TrueSolid,
    parts: IntPair,
    near: Rows,
    listed: int,
    reach: float,
    far: float,
    count: int,
) -> int:
    """Add contacts of the first part's corners with faces of the other, among so many that are listed.

    ``far`` [L] is the reach and what the parts have moved since.
    """
    begin = 0
    while begin < listed:
        k, end, comes = near[begin].ours, begin, False
        while end < listed and near[end].ours == k:
            comes = comes or near[end].off <= far
            end += 1
        if comes:
            p = place_of(work.frame, solid.corners[k])
            if _is_in_box(p, work.least, work.most, reach):
                m, gap = _touched_face(work, solid, near, (begin, end), p, reach, far)
                if m >= 0:
                    n = solid.normals[m]
                    count = _add_contact(work, solid, parts, p, (n[0], n[1], n[2]), gap, count)
        begin = end
    return count


@compiled
def _add_corners(work: Workspace, solid: TrueSolid, i: int, j: int, reach: float, count: int) -> int:
    """Add contacts of part i's corners within ``reach`` [L] of faces of j, without lists."""
    corners, near = _near_corners(work, solid, reach), work.faces_of_corner
    blocks = _near_blocks(solid.face_blocks, work.box, reach + MAX_DEPTH, work.face_blocks) if corners else 0
    for c in range(corners):
        faces = _list_faces(work, solid, blocks, work.indices[c], reach, 0.0, near, 0)
        count = _touch_corners(work, solid, (i, j), near, faces, reach, math.inf, count)
    return count


@compiled
def _near_edges(work: Workspace, solid: TrueSolid, reach: float) -> int:
    """Write which edges come to the other part's box, and which blocks of its edges come to theirs.

    Edges are written to ``work.first_edges``, blocks to ``work.second_blocks``; how many edges, then blocks.
    """
    near = 0
    _empty_box(work.box)
    for b in range(len(solid.edge_blocks)):
        if not _may_come(work, solid.edge_blocks[b], reach):
            continue
        for k in range(BLOCK * b, min(BLOCK * (b + 1), len(solid.edges))):
            p = place_of(work.frame, solid.corners[solid.edges[k, 0]])
            q = place_of(work.frame, solid.corners[solid.edges[k, 1]])
            beyond = False
            for e in range(3):
                beyond = beyond or min(p[e], q[e]) > work.most[e] + reach
                beyond = beyond or max(p[e], q[e]) < work.least[e] - reach
            if not beyond:
                work.first_edges[near] = k
                near += 1
                _extend_box(work.box, p)
                _extend_box(work.box, q)
    return near


@compiled
def _list_edges(work: Workspace, solid: TrueSolid, reach: float, near: Rows) -> int:
    """Write which edges may cross which to ``near`` (R,); how many, R where there are more."""
    far = reach + EDGE_EXTENSION
    edges, count = _near_edges(work, solid, far), 0
    blocks = _near_blocks(solid.edge_blocks, work.box, far, work.second_blocks) if edges else 0
    for m in range(edges):
        k = work.first_edges[m]
        p = place_of(work.frame, solid.corners[solid.edges[k, 0]])
        q = place_of(work.frame, solid.corners[solid.edges[k, 1]])
        for f in range(blocks):
            block = work.second_blocks[f]
            if box_is_off(solid.edge_blocks[block], p, q, far):
                continue
            for n in range(block * BLOCK, min((block + 1) * BLOCK, len(solid.edges))):
                r, s = solid.corners[solid.edges[n, 0]], solid.corners[solid.edges[n, 1]]
                if count == len(near) or _edges_are_apart((p, q), (r, s), far):
                    continue
                off = _distance_to_crossing(work, solid, (k, n), (p, q), reach)
                if off < reach:
                    near[count].ours, near[count].theirs, near[count].off = k, n, off
                    count += 1
    return count


@compiled
def _distance_to_crossing(
    work: Workspace, solid: TrueSolid, edges: IntPair, ends: tuple[Triple, Triple], wide: float
) -> float:
    """Return how much nearer [L] two edges (2,) of two parts must come at least to touch, as ``_add_edge``.

    Of all motions for which lists that look so far hold; infinite where none lets them touch. Directions that
    turn by t turn the normal of edges that cross at an angle c by t / sin c.
    """
    (ours, theirs), (p, q) = edges, ends
    r, s = solid.corners[solid.edges[theirs, 0]], solid.corners[solid.edges[theirs, 1]]
    a, u, way = subtract(q, p), subtract(s, r), subtract(r, p)
    across, turn = cross(a, u), _turn_within(solid, wide)
    size, most = math.sqrt(dot(across, across)), math.sqrt(dot(a, a) * dot(u, u))
    if turn * most > MAX_NORMAL_TURN * size:  # it may be any direction
        return -math.inf
    # more than the chord of an angle whose sine is up to MAX_NORMAL_TURN, 1.04 times the sine
    slack = 1.2 * turn * most / size
    blur, off = slack * (math.sqrt(dot(way, way)) + wide), math.inf
    own, side = solid.sides[ours], solid.sides[theirs]
    for _ in range(2):
        size = -size  # either way
        normal = across[0] / size, across[1] / size, across[2] / size
        by_first = rotate_back(work.frame, normal)
        most = max(dot(side[:3], normal), dot(side[3:], normal))
        least = min(dot(own[:3], by_first), dot(own[3:], by_first))
        if most <= NORMAL_SLACK + slack and least >= -NORMAL_SLACK - slack - turn:
            off = min(off, -dot(way, normal) - blur)
    return off


@compiled
def _touch_edges(
    work: Workspace,
    solid: TrueSolid,
    parts: IntPair,
    near: Rows,
    listed: int,
    reach: float,
    far: float,
    count: int,
) -> int:
    """Add contacts of the first part's edges with those of the other, among so many that are listed.

    ``far`` [L] is the reach and what the parts have moved since.
    """
    last = -1
    p = q = (0.0, 0.0, 0.0)
    for m in range(listed):
        if near[m].off > far:
            continue
        k = near[m].ours
        if k != last:
            p = place_of(work.frame, solid.corners[solid.edges[k, 0]])
            q = place_of(work.frame, solid.corners[solid.edges[k, 1]])
            last = k
        count = _add_edge(work, solid, parts, (k, near[m].theirs), (p, q), reach, count)
    return count


@compiled
def _add_edges(work: Workspace, solid: TrueSolid, i: int, j: int, reach: float, count: int) -> int:
    """Add contacts of convex edges of part i, as ``work.frame`` places it, with those of j, without lists."""
    far = reach + EDGE_EXTENSION
    edges = _near_edges(work, solid, far)
    blocks = _near_blocks(solid.edge_blocks, work.box, far, work.second_blocks) if edges else 0
    for m in range(edges):
        k = work.first_edges[m]
        p = place_of(work.frame, solid.corners[solid.edges[k, 0]])
        q = place_of(work.frame, solid.corners[solid.edges[k, 1]])
        for f in range(blocks):
            block = work.second_blocks[f]
            if box_is_off(solid.edge_blocks[block], p, q, far):
                continue
            for n in range(block * BLOCK, min((block + 1) * BLOCK, len(solid.edges))):
                count = _add_edge(work, solid, (i, j), (k, n), (p, q), reach, count)
    return count


@compiled
def _edges_are_apart(ours: tuple[Vec3, Vec3], theirs: tuple[Vec3, Vec3], reach: float) -> bool:
    """Tell whether the boxes of two edges are further than ``reach`` [L] from each other along an axis."""
    (p, q), (r, s) = ours, theirs
    for e in range(3):
        if min(p[e], q[e]) > max(r[e], s[e]) + reach or max(p[e], q[e]) < min(r[e], s[e]) - reach:
            return True
    return False


@compiled
def _add_edge(
    work: Workspace,
    solid: TrueSolid,
    parts: IntPair,
    edges: IntPair,
    ends: tuple[Triple, Triple],
    reach: float,
    count: int,
) -> int:
    """Add the contact of two edges (2,) of two parts (2,), if they touch; how many rows there are now.

    ``ends`` are those of the first edge, as the second part sees them. Where an edge ends at a hollow edge it
    goes on by its share of ``solid.extensions``. There neither a corner nor another pair of edges touches,
    and two parts would pass through each other.
    """
    (ours, theirs), (p, q) = edges, ends
    r, s = solid.corners[solid.edges[theirs, 0]], solid.corners[solid.edges[theirs, 1]]
    if _edges_are_apart((p, q), (r, s), reach + EDGE_EXTENSION):
        return count
    a, u = subtract(q, p), subtract(s, r)
    across = cross(a, u)
    aa, uu, au = dot(a, a), dot(u, u), dot(a, u)
    size = math.sqrt(dot(across, across))
    if size <= CROSSING_SINE * math.sqrt(aa * uu):
        return count
    way = subtract(r, p)
    pa, pu = dot(way, a), dot(way, u)
    share, place = (pa * uu - pu * au) / size**2, (pa * au - pu * aa) / size**2
    more, rest = solid.extensions[ours], solid.extensions[theirs]
    if not (-more[0] <= share <= 1.0 + more[1] and -rest[0] <= place <= 1.0 + rest[1]):
        return count
    own, side = solid.sides[ours], solid.sides[theirs]
    lean = dot(across, (side[0] + side[3], side[1] + side[4], side[2] + side[5]))
    size = -size if lean > 0.0 else size  # away from the second part
    normal = across[0] / size, across[1] / size, across[2] / size
    gap = -dot(way, normal)
    if not -MAX_DEPTH < gap < reach:
        return count
    by_first = rotate_back(work.frame, normal)  # it lies between the faces of both edges
    if dot(side[:3], normal) > NORMAL_SLACK or dot(own[:3], by_first) < -NORMAL_SLACK:
        return count
    if dot(side[3:], normal) > NORMAL_SLACK or dot(own[3:], by_first) < -NORMAL_SLACK:
        return count
    spot = point_along(r, place, u)
    if gap < -CHECKED_DEPTH:
        middle = point_along(spot, 0.5 * gap, normal)
        if not is_inside(solid, middle, normal, FACE_MARGIN - gap):
            return count
        move = work.frame
        middle = rotate_back(move, subtract(middle, (move[9], move[10], move[11])))
        if not is_inside(solid, middle, (-by_first[0], -by_first[1], -by_first[2]), FACE_MARGIN - gap):
            return count
    return _add_contact(work, solid, parts, spot, normal, gap, count)
