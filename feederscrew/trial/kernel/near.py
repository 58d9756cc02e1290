"""Compiled lists of what of a part may come to touch what, made once in a while.

They hold as long as no corner of the part has moved further than the lists look around it: a part that slides
or lies moves by that in many steps, so that a step costs what touches and not what is in the file.
"""

import math

from feederscrew.dropping.kernel.body import Q, X, Y, Z
from feederscrew.geometry.compiled import apart, compiled
from feederscrew.trial.kernel.crowd_records import (
    BEND,
    BOX,
    CORNERS,
    DEPTH,
    EDGES,
    END,
    FIRST,
    LAST,
    LEAN,
    POSTS,
    VERTS,
)
from feederscrew.trial.kernel.plate_views import (
    DEEP,
    beside,
    in_body,
    inside,
    off_wall,
    placed,
    seen_by,
    within,
)

AROUND = 0.02  # how far around a part is looked
BLOCK = 16  # edges, or faces, that have a box together


@compiled
def hold(crowd, solid, n, reach):
    """Say whether the lists of a part still hold for contacts that far ahead."""
    state, made = crowd.states[n], crowd.made[n]
    square = turned = other = 0.0
    for k in range(3):
        square += (state[k] - made[k]) ** 2
    for k in range(4):
        turned += (state[Q + k] - made[3 + k]) ** 2
        other += (state[Q + k] + made[3 + k]) ** 2
    moved = math.sqrt(square) + 2.1 * solid.radius * math.sqrt(min(turned, other))
    return moved + reach < made[7]


@apart
def look_around(surface, solid, crowd, n, reach):
    """Make the lists of a part anew."""
    state, made = crowd.states[n], crowd.made[n]
    margin = reach + max(AROUND, 2.0 * reach)
    for k in range(3):
        made[k] = state[k]
    for k in range(4):
        made[3 + k] = state[Q + k]
    made[7] = margin
    _near_wall(surface, solid, crowd, n, margin)
    for e in range(4):
        crowd.low[e] = 0  # how many are in each list
    for k in range(len(surface.plates)):
        plate = surface.plates[k]
        seen_by(plate, state, crowd.turns[n], crowd.frame)
        if _meets(plate, crowd.frame, solid.radius + margin):
            _near_plate(surface, solid, crowd, n, k, margin)
        for e in range(4):
            crowd.ends[n, k, e] = crowd.low[e]


@compiled
def _near_wall(surface, solid, crowd, n, margin):
    state, turn, count = crowd.states[n], crowd.turns[n], 0
    x, y = state[X], surface.radius - state[Y]
    if math.sqrt(x * x + y * y) + solid.radius > (surface.radius - margin) * crowd.leans[n, LEAN + 1]:
        for k in range(len(solid.corners)):
            if solid.outer[k]:
                p = solid.corners[k]
                x = state[X] + turn[0] * p[0] + turn[1] * p[1] + turn[2] * p[2]
                y = state[Y] + turn[3] * p[0] + turn[4] * p[1] + turn[5] * p[2]
                z = state[Z] + turn[6] * p[0] + turn[7] * p[1] + turn[8] * p[2]
                if off_wall(surface, crowd.leans[n], x, y, z) < margin:
                    count += 1
                    crowd.walled[n, count] = k
    crowd.walled[n, 0] = count


@compiled
def _meets(plate, frame, far):
    """Whether a ball about the body's centre comes to a plate."""
    if frame[11] > far or frame[11] < -plate[DEPTH] - far:
        return False
    if frame[9] < plate[BOX] - far or frame[9] > plate[BOX + 1] + far:
        return False
    return plate[BOX + 2] - far <= frame[10] <= plate[BOX + 3] + far


@compiled
def _near_plate(surface, solid, crowd, n, k, margin):
    """Add what of a part is near one plate; ``crowd.frame`` is how that sees it."""
    plate, shown, box = surface.plates[k], crowd.shown, crowd.box
    for e in range(3):
        box[2 * e], box[2 * e + 1] = math.inf, -math.inf
    for m in range(len(solid.corners)):
        a, b, c = placed(crowd.frame, solid.corners[m])
        shown[m, 0], shown[m, 1], shown[m, 2] = a, b, c
        box[4], box[5] = min(box[4], c), max(box[5], c)
    if box[4] > margin or box[5] < -plate[DEPTH] - margin:
        return
    for m in range(len(solid.edges)):
        p, q = shown[solid.edges[m, 0]], shown[solid.edges[m, 1]]
        if min(p[2], q[2]) <= margin and max(p[2], q[2]) >= -plate[DEPTH] - margin:
            for e in range(2):
                box[2 * e] = min(box[2 * e], p[e], q[e])
                box[2 * e + 1] = max(box[2 * e + 1], p[e], q[e])
    nears = _near_borders(plate, surface.borders, box, margin, crowd.near)
    _near_corners(surface, solid, crowd, n, k, nears, margin)
    if nears:
        for m in range(nears):
            _near_edges(surface, solid, crowd, n, plate, crowd.near[m], margin)
        _near_faces(surface, solid, crowd, n, plate, nears, margin)


@compiled
def _near_borders(plate, borders, box, margin, found):
    """Write which borders come into a box; how many."""
    count = 0
    for k in range(int(plate[FIRST]), int(plate[LAST])):
        p, q, u, v = borders[k, 0], borders[k, 1], borders[k, 2], borders[k, 3]
        if min(p, u) > box[1] + margin or max(p, u) < box[0] - margin:
            continue
        if min(q, v) > box[3] + margin or max(q, v) < box[2] - margin or borders[k, END] > 0.5:
            continue
        found[count] = k
        count += 1
    return count


@compiled
def _near_corners(surface, solid, crowd, n, k, nears, margin):
    """Add the corners near a plate, each with the borders near it."""
    plate, borders, shown = surface.plates[k], surface.borders, crowd.shown
    count = crowd.low[VERTS]
    sides = crowd.verts[n, 2, count - 1] if count else 0
    first, last = int(plate[FIRST]), int(plate[LAST])
    for m in range(len(shown)):
        a, b, c = shown[m, 0], shown[m, 1], shown[m, 2]
        if c > margin or c < -plate[DEPTH] - margin or (nears == 0 and not solid.outer[m]):
            continue
        begun = sides
        for e in range(nears):
            if abs(beside(borders[crowd.near[e]], a, b)) < margin + DEEP and sides < crowd.sides.shape[1]:
                crowd.sides[n, sides] = crowd.near[e]
                sides += 1
        within_it = -plate[DEPTH] + DEEP + margin < c < -DEEP - margin
        if sides == begun and (within_it or not inside(borders, first, last, a, b)):
            continue
        if count < crowd.verts.shape[2]:
            crowd.verts[n, 0, count], crowd.verts[n, 1, count] = m, begun
            crowd.verts[n, 2, count] = sides
            count += 1
    crowd.low[VERTS] = count


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
def _near_edges(surface, solid, crowd, n, plate, k, margin):
    """Add the edges near one border, in front or at the back, and near what runs back from its start."""
    border, shown, depth, box = surface.borders[k], crowd.shown, plate[DEPTH], crowd.box
    wide = margin + DEEP
    for what in range(3):
        if what == 2 and border[BEND] < 0.5:
            continue
        level = -depth if what == 1 else 0.0
        first = (border[0], border[1], level)
        second = (border[0], border[1], -depth) if what == 2 else (border[2], border[3], level)
        _box_of(crowd.frame, first, second, wide, box)
        for j in range(len(solid.edge_blocks)):
            if _apart(box, solid.edge_blocks[j]):
                continue
            for m in range(BLOCK * j, min(BLOCK * (j + 1), len(solid.edges))):
                p, q = shown[solid.edges[m, 0]], shown[solid.edges[m, 1]]
                if what == 2:
                    _add_post(crowd, n, m, k, _past(p, q, border, wide) and _between(p, q, depth, margin))
                else:
                    _add_edge(crowd, n, (m, k, what), _may_cross(p, q, border, level, wide))


@compiled
def _between(p, q, depth, margin):
    """Whether an edge comes between the front and the back of a plate."""
    return min(p[2], q[2]) <= margin and max(p[2], q[2]) >= -depth - margin


@compiled
def _add_edge(crowd, n, found, meets):
    count = crowd.low[EDGES]
    if meets and count < crowd.edges.shape[1]:
        for e in range(3):
            crowd.edges[n, count, e] = found[e]
        crowd.low[EDGES] = count + 1


@compiled
def _add_post(crowd, n, m, k, meets):
    count = crowd.low[POSTS]
    if meets and count < crowd.posts.shape[1]:
        crowd.posts[n, count, 0], crowd.posts[n, count, 1] = m, k
        crowd.low[POSTS] = count + 1


@compiled
def _may_cross(p, q, border, level, wide):
    """Whether an edge and a border, at a level of its plate, come as near to each other as that."""
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
    return x * x + y * y + z * z < wide * wide


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
def _near_faces(surface, solid, crowd, n, plate, nears, margin):
    """Add the faces of a part near the convex corners of near borders."""
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
