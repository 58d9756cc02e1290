"""Compiled lists of what of a part may come to touch what, made once in a while.

They hold as long as no corner of the part has moved further than the lists look around it: a part that slides
or lies moves by that in many steps, so that a step costs what touches and not what is in the file.
"""

import math

from feederscrew.dropping.kernel.body import Q, X, Y, Z
from feederscrew.geometry.compiled import apart, compiled
from feederscrew.trial.kernel.crowd_records import (
    BOX,
    DEPTH,
    END,
    FIRST,
    FREE,
    FRONT,
    LAST,
    LISTS,
    MOVED,
    REACHES,
    ROUND,
    VERTS,
)
from feederscrew.trial.kernel.near_borders import BLOCK, comes, near_edges, near_faces
from feederscrew.trial.kernel.near_circles import near_rims
from feederscrew.trial.kernel.near_wall import near_wall
from feederscrew.trial.kernel.plate_views import DEEP, beside, inside, level, placed, seen_by

ALONG = 0.25  # so far, in units of its length, along a bare track its lists hold
AROUND, FURTHER = 0.02, 3.0  # how far around a part is looked, at least, and times how far contacts are
SIDED = LISTS  # where it is counted how many borders near corners there are


@compiled
def hold(surface, solid, crowd, n, reach):
    """Say whether the lists of a part still hold for contacts ``reach`` [L] ahead."""
    state, made = crowd.states[n], crowd.made[n]
    x, y = state[X] - made[X], state[Y] - made[Y]
    square, c, s = x * x + y * y, 1.0, 0.0
    if square < made[FREE] * made[FREE]:  # along the bare track, turned about its axis, it sees the same
        back, new = crowd.made_at[n], crowd.tangents[n]
        c, s = back[0] * new[0] + back[1] * new[1], back[0] * new[1] - back[1] * new[0]
        off = (state[X] * new[1]) + (surface.radius - state[Y]) * new[0] - back[2]
        square = off * off
    square += (state[Z] - made[Z]) ** 2
    half = math.sqrt(0.5 + 0.5 * c)
    p, q = half, 0.5 * s / half
    w, x, y = p * made[3] - q * made[6], p * made[4] - q * made[5], p * made[5] + q * made[4]
    z = p * made[6] + q * made[3]
    a, b, c, d = state[Q], state[Q + 1], state[Q + 2], state[Q + 3]
    turned = (a - w) ** 2 + (b - x) ** 2 + (c - y) ** 2 + (d - z) ** 2
    other = (a + w) ** 2 + (b + x) ** 2 + (c + y) ** 2 + (d + z) ** 2
    made[MOVED] = math.sqrt(square) + 2.1 * solid.radius * math.sqrt(min(turned, other))
    return made[MOVED] + reach < made[REACHES]


@apart
def look_around(surface, solid, crowd, n, reach):
    """Make the lists of a part anew, of what may come within ``reach`` [L]."""
    state, made = crowd.states[n], crowd.made[n]
    margin = reach + max(AROUND, FURTHER * reach)
    for k in range(3):
        made[k] = state[k]
    for k in range(4):
        made[3 + k] = state[Q + k]
    made[REACHES], made[MOVED] = margin, 0.0
    for k in range(2):
        crowd.made_at[n, k] = crowd.tangents[n, k]
    crowd.made_at[n, 2] = state[X] * crowd.tangents[n, 1] + (surface.radius - state[Y]) * crowd.tangents[n, 0]
    near_wall(surface, solid, crowd, n, margin)
    for e in range(LISTS):
        crowd.low[e] = 0  # how many are in each list
    made[FREE] = ALONG
    for k in range(len(surface.plates)):
        plate = surface.plates[k]
        seen_by(plate, state, crowd.turns[n], crowd.frame)
        if _meets(plate, crowd.frame, solid.radius + margin + ALONG):
            if plate[FRONT + 2] < 1.0 or _round_it(solid, crowd, plate, surface.borders, margin + ALONG):
                made[FREE] = 0.0
            _near_plate(surface, solid, crowd, n, k, margin)
        for e in range(LISTS):
            crowd.ends[n, k, e] = crowd.low[e]


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
    nears = every = blocks = 0
    if _round_it(solid, crowd, plate, surface.borders, margin):
        _rounds(crowd, n, plate, surface.borders, margin)
        blocks = _seen_edges(solid, crowd, plate, margin)
        nears, every = _near_borders(plate, surface.borders, crowd.box, margin, crowd.near)
    corners = _seen_corners(solid, crowd, plate, margin, nears == 0)
    near_rims(surface, solid, crowd, n, k, every, margin)
    _near_corners(surface, solid, crowd, n, k, (nears, every, corners), margin)
    for m in range(nears):
        near_edges(surface, solid, crowd, n, plate, (crowd.near[m], blocks), margin)
    near_faces(surface, solid, crowd, n, plate, nears, margin)


@compiled
def _round_it(solid, crowd, plate, borders, margin):
    """Whether any border of a plate comes into the box of a ball around the part."""
    box, far, found = crowd.box, solid.radius, False
    for e in range(2):
        box[2 * e], box[2 * e + 1] = crowd.frame[9 + e] - far, crowd.frame[9 + e] + far
    for k in range(int(plate[FIRST]), int(plate[LAST])):
        found = found or comes(borders[k], box, margin)
    return found


@compiled
def _rounds(crowd, n, plate, borders, margin):
    """Add the borders that a line along the plate from a point of the part, in ``crowd.box``, may cross."""
    box, count = crowd.box, crowd.low[ROUND]
    for k in range(int(plate[FIRST]), int(plate[LAST])):
        q, s = borders[k, 1], borders[k, 3]
        beside = max(q, s) >= box[2] - margin and min(q, s) <= box[3] + margin
        if beside and max(borders[k, 0], borders[k, 2]) >= box[0] - margin:
            crowd.rounds[n, count] = k
            count += 1
    crowd.low[ROUND] = count


@compiled
def _seen_corners(solid, crowd, plate, margin, plain):
    """Write which corners are as high as a plate, and where it sees them; how many.

    Where no border is near, ``plain``, only those of the hull that are on no circle: no others touch it.
    """
    if plain:
        return _seen_of(solid, crowd, plate, margin, solid.singles, solid.single_blocks)
    return _seen_of(solid, crowd, plate, margin, solid.grouped, solid.corner_blocks)


@compiled
def _seen_of(solid, crowd, plate, margin, which, blocks):
    count, top, bottom = 0, margin, -plate[DEPTH] - margin
    for j in range(len(blocks)):
        low, high = level(crowd.frame, blocks[j])
        if low > top or high < bottom:
            continue
        for m in range(BLOCK * j, min(BLOCK * (j + 1), len(which))):
            k = which[m]
            a, b, c = placed(crowd.frame, solid.corners[k])
            if bottom <= c <= top:
                crowd.seen[count] = k
                crowd.shown[count, 0], crowd.shown[count, 1], crowd.shown[count, 2] = a, b, c
                count += 1
    return count


@compiled
def _seen_edges(solid, crowd, plate, margin):
    """Write which blocks of edges come to a plate's height, and their box; how many."""
    box, frame, count, top, bottom = crowd.box, crowd.frame, 0, margin, -plate[DEPTH] - margin
    for e in range(2):
        box[2 * e], box[2 * e + 1] = math.inf, -math.inf
    for j in range(len(solid.edge_blocks)):
        block = solid.edge_blocks[j]
        low, high = level(frame, block)
        if low > top + DEEP or high < bottom - DEEP:
            continue
        crowd.blocks[count] = j
        count += 1
        if low > top or high < bottom:
            continue
        for e in range(2):
            middle, half = frame[9 + e], 0.0
            for i in range(3):
                middle += 0.5 * frame[3 * e + i] * (block[i] + block[3 + i])
                half += 0.5 * abs(frame[3 * e + i]) * (block[3 + i] - block[i])
            box[2 * e] = min(box[2 * e], middle - half)
            box[2 * e + 1] = max(box[2 * e + 1], middle + half)
    return count


@compiled
def _near_borders(plate, borders, box, margin, found):
    """Write which borders come into a box, those where the drawing ends last; how many, and all of them."""
    count, ends = 0, 0
    for turn in range(2):
        for k in range(int(plate[FIRST]), int(plate[LAST])):
            if (borders[k, END] > 0.5) == (turn == 1) and comes(borders[k], box, margin):
                found[count + ends] = k
                if turn == 0:
                    count += 1
                else:
                    ends += 1
    return count, count + ends


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
            if comes(surface.borders[crowd.near[e]], box, margin + DEEP):
                plain = False
                if e < nears:
                    crowd.close[few] = crowd.near[e]
                    few += 1
        if plain:
            plate, a, b = surface.plates[k], crowd.shown[begin, 0], crowd.shown[begin, 1]
            if not inside(surface.borders, int(plate[FIRST]), int(plate[LAST]), a, b):
                continue
        for m in range(begin, end):
            _near_corner(surface, solid, crowd, n, k, (m, few, plain), margin)


@compiled
def _grow(box, p, new):
    """Let a box hold a point (3,) as well, or that alone."""
    for e in range(3):
        box[e] = p[e] if new else min(box[e], p[e])
        box[3 + e] = p[e] if new else max(box[3 + e], p[e])


@compiled
def _near_corner(surface, solid, crowd, n, k, which, margin):
    """Add a corner with the borders near it, of the few that come near to those around it."""
    plate, borders, (m, few, plain) = surface.plates[k], surface.borders, which
    a, b, c = crowd.shown[m, 0], crowd.shown[m, 1], crowd.shown[m, 2]
    count, begun = crowd.low[VERTS], crowd.low[SIDED]
    sides, nearest = begun, math.inf
    for e in range(few):
        off = beside(borders[crowd.close[e]], a, b)
        if abs(off) < margin + DEEP and sides < crowd.sides.shape[1]:
            crowd.sides[n, sides] = crowd.close[e]
            sides += 1
            nearest = off if abs(off) < abs(nearest) else nearest
    if sides == begun:
        if -plate[DEPTH] + DEEP + margin < c and (c < -DEEP - margin or solid.ringed[crowd.seen[m]]):
            return
        if not plain and not inside(borders, int(plate[FIRST]), int(plate[LAST]), a, b):
            return
    if count < crowd.verts.shape[2]:
        crowd.verts[n, 0, count], crowd.verts[n, 1, count], crowd.verts[n, 2, count] = (
            crowd.seen[m],
            begun,
            sides,
        )
        crowd.offs[n, count] = c if sides == begun else max(c, nearest)
        _grow(crowd.groups[n, count // BLOCK], solid.corners[crowd.seen[m]], count % BLOCK == 0)
        crowd.low[VERTS], crowd.low[SIDED] = count + 1, sides
