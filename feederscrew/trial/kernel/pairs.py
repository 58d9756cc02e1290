"""Compiled search for contacts between two parts of one shape: corners on faces, and edges on edges.

Everything is looked for in the body axes of the part that is touched, the second. A contact is two records of
`workspace.CONTACT`, one for each part, with the same axes; the normal points towards the first part.
"""

import math

from feederscrew.arrays import Floats, Ints, Triple
from feederscrew.dropping.kernel.body import X
from feederscrew.geometry.compiled import compiled, outlined
from feederscrew.trial.kernel.contact import set_axes, set_levers
from feederscrew.trial.kernel.plate_views import (
    BLOCK,
    CROSSING_SINE,
    MAX_DEPTH,
    NORMAL_SLACK,
    box_is_off,
    cross,
    dot,
    height_over_face,
    is_over_face,
    place_of,
    point_along,
    rotate,
    rotate_back,
    subtract,
)
from feederscrew.trial.kernel.workspace import IntPair, TrueSolid, Vec3, Workspace

FACE_MARGIN = 2e-3  # by which a corner may lie outside the face it touches


@outlined
def find_pair_contacts(solid: TrueSolid, work: Workspace, i: int, j: int, reach: float) -> None:
    """Add contacts of two parts with each other, if they come within ``reach`` [L]."""
    _place_in(work, i, j)
    if not _boxes_meet(work, reach):
        return
    count = _add_corners(work, solid, i, j, reach, work.pair_rows[0])
    count = _add_edges(work, solid, i, j, reach, count)
    work.pair_rows[0] = _add_corners(work, solid, j, i, reach, count)


@compiled
def may_meet(solid: TrueSolid, work: Workspace, i: int, j: int, reach: float) -> bool:
    """Say whether two parts come within ``reach`` [L] of each other, by balls and boxes around them."""
    square = 0.0
    for e in range(3):
        square += (work.states[i, X + e] - work.states[j, X + e]) ** 2
    if square > (2.0 * solid.radius + reach) ** 2:
        return False
    _place_in(work, i, j)
    if not _boxes_meet(work, reach):
        return False
    _place_in(work, j, i)
    return _boxes_meet(work, reach)


@compiled
def _boxes_meet(work: Workspace, reach: float) -> bool:
    """Whether the box of one part comes to that of the other, along the other's axes, as ``work.frame``."""
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
def _touched_face(work: Workspace, solid: TrueSolid, blocks: int, k: int, reach: float) -> tuple[int, float]:
    """Triangle that a corner touches, the least deep of those it may, and the gap; -1 for none."""
    p, gap, face = work.views[k], -MAX_DEPTH, -1
    for f in range(blocks):
        block = work.face_blocks[f]
        if box_is_off(solid.face_blocks[block], p, p, reach + MAX_DEPTH):
            continue
        for m in range(block * BLOCK, min((block + 1) * BLOCK, len(solid.triangles))):
            off = height_over_face(solid, m, p[0], p[1], p[2])
            if not gap < off < reach or not is_over_face(solid, m, p[0], p[1], p[2], FACE_MARGIN):
                continue
            lowest = True  # of the corners around it
            for n in range(solid.firsts[k], solid.firsts[k + 1]):
                away = subtract(work.views[solid.neighbours[n]], p)
                if dot(away, solid.normals[m]) < -NORMAL_SLACK * math.sqrt(dot(away, away)):
                    lowest = False
                    break
            if lowest:
                gap, face = off, m
    return face, gap


@compiled
def _empty_box(box: Floats) -> None:
    for e in range(3):
        box[e], box[3 + e] = math.inf, -math.inf


@compiled
def _extend_box(box: Floats, p: Floats) -> None:
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
def _add_corners(work: Workspace, solid: TrueSolid, i: int, j: int, reach: float, count: int) -> int:
    """Add contacts of part i's corners within ``reach`` [L] of faces of j; fills ``work.views`` (C, 3)."""
    _place_in(work, i, j)
    low, high, near = work.least, work.most, 0
    _empty_box(work.box)
    for k in range(len(solid.corners)):
        p = work.views[k]
        p[0], p[1], p[2] = place_of(work.frame, solid.corners[k])
        if p[0] < low[0] - reach or p[1] < low[1] - reach or p[2] < low[2] - reach:
            continue
        if p[0] > high[0] + reach or p[1] > high[1] + reach or p[2] > high[2] + reach:
            continue
        work.indices[near] = k
        near += 1
        _extend_box(work.box, p)
    if near == 0:
        return count
    blocks = _near_blocks(solid.face_blocks, work.box, reach + MAX_DEPTH, work.face_blocks)
    for c in range(near):
        k = work.indices[c]
        m, gap = _touched_face(work, solid, blocks, k, reach)
        if m >= 0:
            n, p = solid.normals[m], work.views[k]
            count = _add_contact(work, solid, (i, j), (p[0], p[1], p[2]), (n[0], n[1], n[2]), gap, count)
    return count


@compiled
def _add_edges(work: Workspace, solid: TrueSolid, i: int, j: int, reach: float, count: int) -> int:
    """Add contacts of convex edges of part i, corners in ``work.views`` (C, 3) [L], with those of j."""
    near = 0
    _empty_box(work.box)
    for k in range(len(solid.edges)):
        p, q = work.views[solid.edges[k, 0]], work.views[solid.edges[k, 1]]
        beyond = False
        for e in range(3):
            beyond = beyond or min(p[e], q[e]) > work.most[e] + reach
            beyond = beyond or max(p[e], q[e]) < work.least[e] - reach
        if not beyond:
            work.first_edges[near] = k
            near += 1
            _extend_box(work.box, p)
            _extend_box(work.box, q)
    blocks = _near_blocks(solid.edge_blocks, work.box, reach, work.second_blocks) if near else 0
    for m in range(near):
        k = work.first_edges[m]
        p, q = work.views[solid.edges[k, 0]], work.views[solid.edges[k, 1]]
        for f in range(blocks):
            block = work.second_blocks[f]
            if box_is_off(solid.edge_blocks[block], p, q, reach):
                continue
            for n in range(block * BLOCK, min((block + 1) * BLOCK, len(solid.edges))):
                count = _add_edge(work, solid, (i, j), (k, n), reach, count)
    return count


@compiled
def _add_edge(
    work: Workspace, solid: TrueSolid, parts: IntPair, edges: IntPair, reach: float, count: int
) -> int:
    """Add the contact of two edges (2,) of two parts (2,), if they touch; how many rows there are now."""
    ours, theirs = edges
    p, q = work.views[solid.edges[ours, 0]], work.views[solid.edges[ours, 1]]
    r, s = solid.corners[solid.edges[theirs, 0]], solid.corners[solid.edges[theirs, 1]]
    for e in range(3):
        if min(p[e], q[e]) > max(r[e], s[e]) + reach or max(p[e], q[e]) < min(r[e], s[e]) - reach:
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
    if not (0.0 <= share <= 1.0 and 0.0 <= place <= 1.0):
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
    return _add_contact(work, solid, parts, point_along(r, place, u), normal, gap, count)
