"""Compiled lists of what of a part may come to touch what, made once in a while.

They hold as long as no corner of the part has moved further than the lists look around it: a part that slides
or lies moves by that in many steps, so that a step costs what touches and not what is in the file.
"""

import math

from feederscrew.dropping.kernel.body import Q, X, Y, Z
from feederscrew.geometry.compiled import apart, compiled
from feederscrew.trial.kernel.crowd_records import BOX, DEPTH, END, FIRST, LAST, LEAN, VERTS
from feederscrew.trial.kernel.near_borders import BLOCK, near_edges, near_faces
from feederscrew.trial.kernel.plate_views import DEEP, beside, inside, off_wall, placed, seen_by

AROUND, FURTHER = 0.02, 3.0  # how far around a part is looked, at least, and times how far contacts are
SIDED = 4  # where it is counted how many borders near corners there are


@compiled
def hold(crowd, solid, n, reach):
    """Say whether the lists of a part still hold for contacts ``reach`` [L] ahead."""
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
    """Make the lists of a part anew, of what may come within ``reach`` [L]."""
    state, made = crowd.states[n], crowd.made[n]
    margin = reach + max(AROUND, FURTHER * reach)
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
    state, count = crowd.states[n], 0
    x, y = state[X], surface.radius - state[Y]
    if math.sqrt(x * x + y * y) + solid.radius > (surface.radius - margin) * crowd.leans[n, LEAN + 1]:
        for j in range(len(solid.corner_blocks)):
            block = solid.corner_blocks[j]
            p = 0.5 * (block[0] + block[3]), 0.5 * (block[1] + block[4]), 0.5 * (block[2] + block[5])
            x, y, z = block[3] - p[0], block[4] - p[1], block[5] - p[2]
            if _off_wall(surface, crowd, n, p) > margin + math.sqrt(x * x + y * y + z * z):
                continue
            for m in range(BLOCK * j, min(BLOCK * (j + 1), len(solid.grouped))):
                k = solid.grouped[m]
                p = solid.corners[k, 0], solid.corners[k, 1], solid.corners[k, 2]
                if solid.outer[k] and _off_wall(surface, crowd, n, p) < margin:
                    count += 1
                    crowd.walled[n, count] = k
    crowd.walled[n, 0] = count


@compiled
def _off_wall(surface, crowd, n, p):
    """How far a point of a body is from the wall."""
    state, turn = crowd.states[n], crowd.turns[n]
    x = state[X] + turn[0] * p[0] + turn[1] * p[1] + turn[2] * p[2]
    y = state[Y] + turn[3] * p[0] + turn[4] * p[1] + turn[5] * p[2]
    z = state[Z] + turn[6] * p[0] + turn[7] * p[1] + turn[8] * p[2]
    return off_wall(surface, crowd.leans[n], x, y, z)


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
    plate = surface.plates[k]
    corners = _seen_corners(solid, crowd, plate, margin)
    blocks = _seen_edges(solid, crowd, plate, margin)
    nears, every = _near_borders(plate, surface.borders, crowd.box, margin, crowd.near)
    _near_corners(surface, solid, crowd, n, k, (nears, every, corners), margin)
    for m in range(nears):
        near_edges(surface, solid, crowd, n, plate, (crowd.near[m], blocks), margin)
    near_faces(surface, solid, crowd, n, plate, nears, margin)


@compiled
def _level(frame, block):
    """Least and greatest height over a plate of what is in a box."""
    middle, half = frame[11], 0.0
    for e in range(3):
        middle += 0.5 * frame[6 + e] * (block[e] + block[3 + e])
        half += 0.5 * abs(frame[6 + e]) * (block[3 + e] - block[e])
    return middle - half, middle + half


@compiled
def _seen_corners(solid, crowd, plate, margin):
    """Write which corners are as high as a plate, and where it sees them; how many."""
    count, top, bottom = 0, margin, -plate[DEPTH] - margin
    for j in range(len(solid.corner_blocks)):
        low, high = _level(crowd.frame, solid.corner_blocks[j])
        if low > top or high < bottom:
            continue
        for m in range(BLOCK * j, min(BLOCK * (j + 1), len(solid.grouped))):
            k = solid.grouped[m]
            a, b, c = placed(crowd.frame, solid.corners[k])
            if bottom <= c <= top:
                crowd.seen[count] = k
                crowd.shown[count, 0], crowd.shown[count, 1], crowd.shown[count, 2] = a, b, c
                count += 1
    return count


@compiled
def _seen_edges(solid, crowd, plate, margin):
    """Write which blocks of edges come to a plate's height, where it sees those, and their box; how many."""
    box, count, top, bottom = crowd.box, 0, margin, -plate[DEPTH] - margin
    for e in range(3):
        box[2 * e], box[2 * e + 1] = math.inf, -math.inf
    for j in range(len(solid.edge_blocks)):
        low, high = _level(crowd.frame, solid.edge_blocks[j])
        if low > top + DEEP or high < bottom - DEEP:
            continue
        crowd.blocks[count] = j
        count += 1
        for m in range(BLOCK * j, min(BLOCK * (j + 1), len(solid.edges))):
            p = placed(crowd.frame, solid.corners[solid.edges[m, 0]])
            q = placed(crowd.frame, solid.corners[solid.edges[m, 1]])
            for e in range(3):
                crowd.spans[m, e], crowd.spans[m, 3 + e] = p[e], q[e]
            if min(p[2], q[2]) <= top and max(p[2], q[2]) >= bottom:
                for e in range(2):
                    box[2 * e] = min(box[2 * e], p[e], q[e])
                    box[2 * e + 1] = max(box[2 * e + 1], p[e], q[e])
    return count


@compiled
def _near_borders(plate, borders, box, margin, found):
    """Write which borders come into a box, those where the drawing ends last; how many, and all of them."""
    count, ends = 0, 0
    for turn in range(2):
        for k in range(int(plate[FIRST]), int(plate[LAST])):
            if (borders[k, END] > 0.5) == (turn == 1) and _comes(borders[k], box, margin):
                found[count + ends] = k
                if turn == 0:
                    count += 1
                else:
                    ends += 1
    return count, count + ends


@compiled
def _comes(border, box, wide):
    """Whether a border may come into a box."""
    p, q, u, v = border[0], border[1], border[2], border[3]
    if min(p, u) > box[1] + wide or max(p, u) < box[0] - wide:
        return False
    return min(q, v) <= box[3] + wide and max(q, v) >= box[2] - wide


@compiled
def _near_corners(surface, solid, crowd, n, k, found, margin):
    """Add the corners near a plate, each with the borders near it, of so many borders and corners."""
    nears, every, corners = found
    crowd.low[SIDED] = crowd.verts[n, 2, crowd.low[VERTS] - 1] if crowd.low[VERTS] else 0
    for begin in range(0, corners, BLOCK):
        end, box, few, plain = min(begin + BLOCK, corners), crowd.box, 0, True
        for e in range(2):
            box[2 * e] = box[2 * e + 1] = crowd.shown[begin, e]
        for m in range(begin + 1, end):
            for e in range(2):
                box[2 * e] = min(box[2 * e], crowd.shown[m, e])
                box[2 * e + 1] = max(box[2 * e + 1], crowd.shown[m, e])
        for e in range(every):
            if _comes(surface.borders[crowd.near[e]], box, margin + DEEP):
                plain = False
                if e < nears:
                    crowd.close[few] = crowd.near[e]
                    few += 1
        if plain:
            plate, a, b = surface.plates[k], crowd.shown[begin, 0], crowd.shown[begin, 1]
            if not inside(surface.borders, int(plate[FIRST]), int(plate[LAST]), a, b):
                continue
        for m in range(begin, end):
            if nears or solid.outer[crowd.seen[m]]:
                _near_corner(surface, crowd, n, k, (m, few, plain), margin)


@compiled
def _near_corner(surface, crowd, n, k, which, margin):
    """Add a corner with the borders near it, of the few that come near to those around it."""
    plate, borders, (m, few, plain) = surface.plates[k], surface.borders, which
    a, b, c = crowd.shown[m, 0], crowd.shown[m, 1], crowd.shown[m, 2]
    count, begun = crowd.low[VERTS], crowd.low[SIDED]
    sides = begun
    for e in range(few):
        if abs(beside(borders[crowd.close[e]], a, b)) < margin + DEEP and sides < crowd.sides.shape[1]:
            crowd.sides[n, sides] = crowd.close[e]
            sides += 1
    if sides == begun:
        if -plate[DEPTH] + DEEP + margin < c < -DEEP - margin:
            return
        if not plain and not inside(borders, int(plate[FIRST]), int(plate[LAST]), a, b):
            return
    if count < crowd.verts.shape[2]:
        crowd.verts[n, 0, count], crowd.verts[n, 1, count], crowd.verts[n, 2, count] = (
            crowd.seen[m],
            begun,
            sides,
        )
        crowd.low[VERTS], crowd.low[SIDED] = count + 1, sides
