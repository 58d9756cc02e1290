"""Compiled lists of which edges and faces of a part are near borders, block by block of them."""

import math

from feederscrew.geometry.compiled import compiled
from feederscrew.trial.kernel.crowd_records import BEND, CORNERS, DEPTH, EDGES, POSTS
from feederscrew.trial.kernel.plate_views import DEEP, in_body, placed, within

BLOCK = 16  # corners, edges, or faces, that have a box together


@compiled
def _box_of(frame, first, second, wide, box):
    """Write the box in the body's axes of what a plate sees between two points, and so far around it."""
    p = in_body(frame, first[0] - frame[9], first[1] - frame[10], first[2] - frame[11])
    q = in_body(frame, second[0] - frame[9], second[1] - frame[10], second[2] - frame[11])
    for e in range(3):
        box[e], box[3 + e] = min(p[e], q[e]) - wide, max(p[e], q[e]) + wide


@compiled
def _apart(box, other):
    """Whether two boxes, three least places and three greatest, lie apart."""
    if box[0] > other[3] or box[3] < other[0] or box[1] > other[4] or box[4] < other[1]:
        return True
    return box[2] > other[5] or box[5] < other[2]


@compiled
def comes(border, box, wide):
    """Say whether a border (12,) may come into a box (4,) [L] of places along a plate, or so near to it."""
    p, q, u, v = border[0], border[1], border[2], border[3]
    if min(p, u) > box[1] + wide or max(p, u) < box[0] - wide:
        return False
    return min(q, v) <= box[3] + wide and max(q, v) >= box[2] - wide


@compiled
def near_edges(surface, solid, crowd, n, plate, found, margin):
    """Add the edges near one border, in front or at the back, and near what runs back from its start.

    ``found`` is which border, and in how many blocks of edges is looked.
    """
    k, blocks = found
    border, depth, box = surface.borders[k], plate[DEPTH], crowd.box
    wide = margin + DEEP
    for what in range(3):
        if what == 2 and border[BEND] < 0.5:
            continue
        level = -depth if what == 1 else 0.0
        first = (border[0], border[1], level)
        second = (border[0], border[1], -depth) if what == 2 else (border[2], border[3], level)
        _box_of(crowd.frame, first, second, wide, box)
        for i in range(blocks):
            j = crowd.blocks[i]
            if _apart(box, solid.edge_blocks[j]):
                continue
            for m in range(BLOCK * j, min(BLOCK * (j + 1), len(solid.edges))):
                p = placed(crowd.frame, solid.corners[solid.edges[m, 0]])
                q = placed(crowd.frame, solid.corners[solid.edges[m, 1]])
                if what == 2:
                    _add_post(crowd, n, m, k, _past(p, q, border, wide) and _between(p, q, depth, margin))
                elif not _far(p, q, border, level, wide):
                    _add_edge(crowd, n, (m, k, what), _between_lines(p, q, border, level), wide)


@compiled
def _far(p, q, border, level, wide):
    """Whether the boxes of an edge and a border, at a level of its plate, are further apart than that."""
    if min(p[2], q[2]) > level + wide or max(p[2], q[2]) < level - wide:
        return True
    if (
        min(p[0], q[0]) > max(border[0], border[2]) + wide
        or max(p[0], q[0]) < min(border[0], border[2]) - wide
    ):
        return True
    return (
        min(p[1], q[1]) > max(border[1], border[3]) + wide
        or max(p[1], q[1]) < min(border[1], border[3]) - wide
    )


@compiled
def _between(p, q, depth, margin):
    """Whether an edge comes between the front and the back of a plate."""
    return min(p[2], q[2]) <= margin and max(p[2], q[2]) >= -depth - margin


@compiled
def _add_edge(crowd, n, found, off, wide):
    count = crowd.low[EDGES]
    if off < wide and count < crowd.edges.shape[1]:
        for e in range(3):
            crowd.edges[n, count, e] = found[e]
        crowd.edge_gaps[n, count] = off
        crowd.low[EDGES] = count + 1


@compiled
def _add_post(crowd, n, m, k, meets):
    count = crowd.low[POSTS]
    if meets and count < crowd.posts.shape[1]:
        crowd.posts[n, count, 0], crowd.posts[n, count, 1] = m, k
        crowd.low[POSTS] = count + 1


@compiled
def _between_lines(p, q, border, level):
    """How far apart an edge and a border, at a level of its plate, are."""
    a, b, c = q[0] - p[0], q[1] - p[1], q[2] - p[2]
    u, v = border[2] - border[0], border[3] - border[1]
    x, y, z = p[0] - border[0], p[1] - border[1], p[2] - level
    ee, ff, ef = a * a + b * b + c * c, u * u + v * v, a * u + b * v
    ex, fx = a * x + b * y + c * z, u * x + v * y
    flat = ee * ff - ef * ef
    share = min(max((ef * fx - ff * ex) / flat, 0.0), 1.0) if flat > 1e-9 * ee * ff else 0.0
    place = (fx + share * ef) / ff
    if place < 0.0 or place > 1.0:
        place = min(max(place, 0.0), 1.0)
        share = min(max((place * ef - ex) / ee, 0.0), 1.0)
    x, y, z = x + share * a - place * u, y + share * b - place * v, z + share * c
    return math.sqrt(x * x + y * y + z * z)


@compiled
def _past(p, q, border, wide):
    """Whether an edge comes past the start of a border as near as that."""
    a, b = q[0] - p[0], q[1] - p[1]
    x, y = border[0] - p[0], border[1] - p[1]
    square = a * a + b * b
    share = min(max((x * a + y * b) / square, 0.0), 1.0) if square > 0.0 else 0.0
    x, y = x - share * a, y - share * b
    return x * x + y * y < wide * wide


@compiled
def near_faces(surface, solid, crowd, n, plate, nears, margin):
    """Add the faces of a part within ``margin`` [L] of the convex corners of near borders."""
    frame, box = crowd.frame, crowd.box
    for m in range(nears):
        border = surface.borders[crowd.near[m]]
        if border[BEND] < 0.5:
            continue
        for back in range(2):
            place = (border[0], border[1], -plate[DEPTH] if back else 0.0)
            _box_of(frame, place, place, margin + DEEP, box)
            for j in range(len(solid.face_blocks)):
                if _apart(box, solid.face_blocks[j]):
                    continue
                for f in range(BLOCK * j, min(BLOCK * (j + 1), len(solid.triangles))):
                    _add_face(solid, crowd, n, (crowd.near[m], back, f), margin)


@compiled
def _add_face(solid, crowd, n, found, margin):
    """Add a face near a corner, in the middle of ``crowd.box``, if it is that near."""
    box, f, count = crowd.box, found[2], crowd.low[CORNERS]
    x, y, z = 0.5 * (box[0] + box[3]), 0.5 * (box[1] + box[4]), 0.5 * (box[2] + box[5])
    t, v = solid.normals[f], solid.vertices[solid.triangles[f, 0]]
    off = (x - v[0]) * t[0] + (y - v[1]) * t[1] + (z - v[2]) * t[2]
    if -margin - DEEP < off < margin and count < crowd.corners.shape[1] and within(solid, f, x, y, z, margin):
        for e in range(3):
            crowd.corners[n, count, e] = found[e]
        crowd.low[CORNERS] = count + 1
