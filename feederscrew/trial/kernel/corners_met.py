"""Compiled contacts of a part with what stands along the track, among what is near it.

Of a plate there can touch: a corner of the part its surface, its back or a side; an edge of the part a
border, in front or at the back, or what runs straight back from a border's convex corner; such a corner a
face of the part. Each is a contact where it is a least distance of both: the normal lies between the faces
of either.
"""

import math

from feederscrew.dropping.kernel.body import X, Y, Z
from feederscrew.geometry.compiled import apart, compiled
from feederscrew.trial.kernel import circles_met, contact, edges_met, near, plate_views, supports, track_leans
from feederscrew.trial.kernel.contact import GAP, KINDS, SPOT, put
from feederscrew.trial.kernel.crowd_records import (
    CORNERS,
    DEPTH,
    EDGES,
    MOVED,
    NORMAL,
    POSTS,
    RIMS,
    ROUNDED,
    RUBS,
    VERTS,
    WALL,
)
from feederscrew.trial.kernel.edges_met import first_of
from feederscrew.trial.kernel.near_borders import BLOCK
from feederscrew.trial.kernel.plate_views import DEEP, SLANT, in_body, in_bowl, level, placed

SHALLOW = 1e-3  # a contact less deep is not looked at again
ROUNDING = 1e-9  # more than rounding moves a point
AS_FAR = 4.0  # times its depth: a deeper contact is none where so near to it another is shallower


@apart
def found(surface, solid, crowd, n, reach):
    """Find every contact of part n within ``reach`` [L]; its turn and tangent are of its place."""
    if not near.hold(surface, solid, crowd, n, reach):
        near.look_around(surface, solid, crowd, n, reach)
    crowd.counts[n] = 0
    if crowd.walled[n, 0] or crowd.rims_walled[n, 0]:
        _on_wall(surface, solid, crowd, n, reach)
    for k in range(len(surface.plates)):
        fewer = max(k - 1, 0)
        if k and (
            crowd.ends[n, k, VERTS] == crowd.ends[n, fewer, VERTS]
            and crowd.ends[n, k, EDGES] == crowd.ends[n, fewer, EDGES]
            and crowd.ends[n, k, POSTS] == crowd.ends[n, fewer, POSTS]
            and crowd.ends[n, k, RIMS] == crowd.ends[n, fewer, RIMS]
            and crowd.ends[n, k, CORNERS] == crowd.ends[n, fewer, CORNERS]
        ):
            continue
        plate_views.seen_by(surface.plates[k], crowd.states[n], crowd.turns[n], crowd.frame)
        begun = crowd.counts[n]
        _dips(surface, solid, crowd, n, k)
        lying = _corners_on(surface, solid, crowd, n, k, reach)
        lying = circles_met.rims_on(surface, solid, crowd, n, k, reach, lying)
        lying = edges_met.edges_on(surface, solid, crowd, n, k, reach, lying)
        edges_met.edges_on_posts(surface, solid, crowd, n, k, reach)
        lying = edges_met.faces_on(surface, solid, crowd, n, k, reach, lying)
        _put_lying(crowd, solid, n, surface.plates[k], lying)
        _without_deeper(crowd, n, begun)
    contact.remembered(crowd, n)


@compiled
def _on_wall(surface, solid, crowd, n, reach):
    """Add contacts with the wall, a cone in the track's frame where that is banked."""
    state, turn, lows = crowd.states[n], crowd.turns[n], 0
    lean, up, radius = crowd.leans[n, WALL], crowd.leans[n, WALL + 1], surface.radius
    rub = track_leans.wall_friction(surface, crowd.leans[n])
    far = crowd.made[n, MOVED] + reach
    for m in range(1, crowd.walled[n, 0] + 1):
        if crowd.wall_gaps[n, m] > far:
            continue
        p = solid.corners[crowd.walled[n, m]]
        x = turn[0] * p[0] + turn[1] * p[1] + turn[2] * p[2]
        y = turn[3] * p[0] + turn[4] * p[1] + turn[5] * p[2]
        z = turn[6] * p[0] + turn[7] * p[1] + turn[8] * p[2]
        gap = plate_views.off_wall(surface, crowd.leans[n], state[X] + x, state[Y] + y, state[Z] + z)
        if gap < reach:
            place = crowd.tangents[n, 0] * x + crowd.tangents[n, 1] * y, z
            key = -KINDS * (1 + crowd.walled[n, m])
            lows = supports.add(crowd.levels, lows, place, gap, p, key)
    lows = circles_met.rims_on_wall(surface, solid, crowd, n, reach, lows)
    for m in range(supports.outermost(crowd.levels, crowd.best, lows)):
        row = crowd.levels[m]
        p = row[supports.SPOT], row[supports.SPOT + 1], row[supports.SPOT + 2]
        x = state[X] + turn[0] * p[0] + turn[1] * p[1] + turn[2] * p[2]
        y = state[Y] + turn[3] * p[0] + turn[4] * p[1] + turn[5] * p[2] - radius
        far = math.sqrt(x * x + y * y)
        normal = (-up * x / far, -up * y / far, -lean)
        put(crowd, n, solid, p, normal, row[supports.GAP], rub, row[supports.KEY])


@compiled
def _put_lying(crowd, solid, n, plate, count):
    """Add the contacts that carry the part on a plate's surface."""
    normal = in_bowl(plate, 0.0, 0.0, 1.0)
    for m in range(supports.outermost(crowd.levels, crowd.best, count)):
        row = crowd.levels[m]
        spot = row[supports.SPOT], row[supports.SPOT + 1], row[supports.SPOT + 2]
        put(crowd, n, solid, spot, normal, row[supports.GAP], plate[RUBS], row[supports.KEY])


@compiled
def _foremost(solid, k, a, b, c):
    """Whether a corner of the part is its foremost against a direction, as far as its neighbours tell."""
    p = solid.corners[k]
    for n in range(solid.firsts[k], solid.firsts[k + 1]):
        q = solid.corners[solid.beside[n]]
        x, y, z = q[0] - p[0], q[1] - p[1], q[2] - p[2]
        ahead = a * x + b * y + c * z
        if ahead < 0.0 and ahead * ahead > SLANT * SLANT * (x * x + y * y + z * z):
            return False
    return True


@compiled
def _dips(surface, solid, crowd, n, k):
    """Write how deep corners of the part come beside each border near them."""
    first, last = first_of(crowd, n, k, VERTS), crowd.ends[n, k, VERTS]
    if first == last or crowd.verts[n, 1, first] == crowd.verts[n, 2, last - 1]:
        return
    for e in range(crowd.verts[n, 1, first], crowd.verts[n, 2, last - 1]):
        crowd.dips[crowd.sides[n, e]] = 0.0
    frame = crowd.frame
    for g in range(first // BLOCK, (last + BLOCK - 1) // BLOCK):
        if level(frame, crowd.groups[n, g])[0] > ROUNDING:
            continue
        for m in range(max(first, BLOCK * g), min(last, BLOCK * (g + 1))):
            p = solid.corners[crowd.verts[n, 0, m]]
            c = frame[6] * p[0] + frame[7] * p[1] + frame[8] * p[2] + frame[11]
            for e in range(crowd.verts[n, 1, m], crowd.verts[n, 2, m]):
                side = crowd.sides[n, e]
                crowd.dips[side] = min(crowd.dips[side], c)


@compiled
def _corners_on(surface, solid, crowd, n, k, reach):
    """Add contacts of the part's corners with a plate's sides and back; how many lie on its surface."""
    frame, lows, far = crowd.frame, 0, crowd.made[n, MOVED] + reach
    first, last = first_of(crowd, n, k, VERTS), crowd.ends[n, k, VERTS]
    for g in range(first // BLOCK, (last + BLOCK - 1) // BLOCK):
        if level(frame, crowd.groups[n, g])[0] > reach + ROUNDING:
            continue
        for m in range(max(first, BLOCK * g), min(last, BLOCK * (g + 1))):
            if crowd.offs[n, m] <= far:
                lows = _corner_on(surface, solid, crowd, n, k, (m, reach), lows)
    return lows


@compiled
def _corner_on(surface, solid, crowd, n, k, which, lows):
    """Add the contact of one of the corners near a plate, as ``_corners_on``."""
    plate, frame, (m, reach) = surface.plates[k], crowd.frame, which
    corner = crowd.verts[n, 0, m]
    p = solid.corners[corner]
    c = frame[6] * p[0] + frame[7] * p[1] + frame[8] * p[2] + frame[11]
    if c > reach or c < -plate[DEPTH] - reach:
        return lows
    a, b, c = placed(frame, p)
    alone = not solid.ringed[corner]  # else its circle touches, unless a border is near
    if crowd.verts[n, 1, m] == crowd.verts[n, 2, m]:
        on_top = c > -DEEP
        if plate[DEPTH] + c < DEEP and _foremost(solid, corner, -frame[6], -frame[7], -frame[8]):
            normal, key = in_bowl(plate, 0.0, 0.0, -1.0), 1.0 + KINDS * (corner + 1e6 * k)
            put(crowd, n, solid, (p[0], p[1], p[2]), normal, -plate[DEPTH] - c, plate[RUBS], key)
    else:
        on_top, alone = _by_borders(surface, solid, crowd, n, k, (m, reach, a, b, c)), True
    if on_top and alone:
        lows = supports.add(crowd.levels, lows, (a, b), c, p, KINDS * (corner + 1e6 * k))
    return lows


@compiled
def _by_borders(surface, solid, crowd, n, k, where):
    """Add the contact of a corner near borders with a side or the back; whether it touches the surface."""
    plate, frame = surface.plates[k], crowd.frame
    m, reach, a, b, c = where
    corner, depth, off, side = crowd.verts[n, 0, m], plate[DEPTH], math.inf, 0
    for e in range(crowd.verts[n, 1, m], crowd.verts[n, 2, m]):
        far = plate_views.beside(surface.borders[crowd.sides[n, e]], a, b)
        if abs(far) < abs(off):
            off, side = far, crowd.sides[n, e]
    catches = min(c, crowd.dips[side]) < -plate[ROUNDED] and -depth < c < 0.0
    if off > 0.0 and (off > reach or not catches):
        return False
    on_top = False
    best = DEEP
    if off <= 0.0 and c > -best and _foremost(solid, corner, frame[6], frame[7], frame[8]):
        on_top, best = True, -c
    if off <= 0.0 and depth + c < best and _foremost(solid, corner, -frame[6], -frame[7], -frame[8]):
        best, on_top = depth + c, False
        u, v, w = 0.0, 0.0, -1.0
        kind = 1.0
    else:
        kind = 0.0
        u = v = w = 0.0
    if -off < best and catches:
        border = surface.borders[side]
        x, y, z = in_body(frame, border[NORMAL], border[NORMAL + 1], 0.0)
        if _foremost(solid, corner, x, y, z):
            best, on_top, kind = -off, False, 2.0
            u, v, w = border[NORMAL], border[NORMAL + 1], 0.0
    if kind > 0.0:
        p, normal = solid.corners[corner], in_bowl(plate, u, v, w)
        key = kind + KINDS * (corner + 1e6 * k)
        put(crowd, n, solid, (p[0], p[1], p[2]), normal, -best, plate[RUBS], key)
    return on_top


@compiled
def _without_deeper(crowd, n, first):
    """Leave out contacts with a plate that are deeper than others near them: those are what is to be left."""
    kept = first
    for m in range(first, crowd.counts[n]):
        row, none = crowd.rows[n, m], False
        if row[GAP] < -SHALLOW:
            for e in range(first, crowd.counts[n]):
                other = crowd.rows[n, e]
                if 0.5 * row[GAP] < other[GAP] < SHALLOW and e != m:
                    x, y = row[SPOT] - other[SPOT], row[SPOT + 1] - other[SPOT + 1]
                    z = row[SPOT + 2] - other[SPOT + 2]
                    none = none or x * x + y * y + z * z < (AS_FAR * row[GAP]) ** 2
        if not none:
            crowd.low[kept - first] = m
            kept += 1
    if kept < crowd.counts[n]:
        for m in range(first, kept):
            other = crowd.low[m - first]
            if other != m:
                for e in range(contact.WIDTH):
                    crowd.rows[n, m, e] = crowd.rows[n, other, e]
        crowd.counts[n] = kept
