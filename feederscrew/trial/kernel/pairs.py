"""Compiled search for contacts between two parts of one shape: corners on faces, and edges on edges.

Everything is looked for in the body axes of the part that is touched, the second. A contact is two rows of
`trial.kernel.contact`, one for each part, with the same axes; the normal points towards the first part.
"""

import math

from feederscrew.dropping.kernel.body import X
from feederscrew.geometry.compiled import apart, compiled
from feederscrew.trial.kernel.contact import GAP, IMPULSE, MASS, axes, levers
from feederscrew.trial.kernel.near_borders import BLOCK
from feederscrew.trial.kernel.plate_views import PARALLEL, SLANT, within

DEEP = 0.04  # how deep in each other parts are looked for, in units of their length
BESIDE = 2e-3  # by which a corner may lie beside the face it touches


@apart
def met(solid, crowd, i, j, reach):
    """Add contacts of two parts with each other, if they come within ``reach`` [L]."""
    _relative(crowd, i, j)
    if not _meet(crowd, reach):
        return
    count = corners_on(crowd, solid, i, j, reach, crowd.paired[0])
    count = edges_on(crowd, solid, i, j, reach, count)
    crowd.paired[0] = corners_on(crowd, solid, j, i, reach, count)


@compiled
def may_meet(solid, crowd, i, j, reach):
    """Say whether two parts come within ``reach`` [L] of each other, by balls and boxes around them."""
    square = 0.0
    for e in range(3):
        square += (crowd.states[i, X + e] - crowd.states[j, X + e]) ** 2
    if square > (2.0 * solid.radius + reach) ** 2:
        return False
    _relative(crowd, i, j)
    if not _meet(crowd, reach):
        return False
    _relative(crowd, j, i)
    return _meet(crowd, reach)


@compiled
def _meet(crowd, reach):
    """Whether the box of one part comes to that of the other, along the other's axes, as ``crowd.frame``."""
    move = crowd.frame
    for p in range(3):
        middle, half = move[9 + p], reach
        for q in range(3):
            middle += move[3 * p + q] * 0.5 * (crowd.least[q] + crowd.most[q])
            half += abs(move[3 * p + q]) * 0.5 * (crowd.most[q] - crowd.least[q])
        if middle + half < crowd.least[p] or middle - half > crowd.most[p]:
            return False
    return True


@compiled
def _relative(crowd, i, j):
    """Write rotation and place of part i in the body axes of part j."""
    a, b, move = crowd.turns[i], crowd.turns[j], crowd.frame
    for p in range(3):
        move[9 + p] = 0.0
        for q in range(3):
            move[3 * p + q] = b[p] * a[q] + b[3 + p] * a[3 + q] + b[6 + p] * a[6 + q]
            move[9 + p] += b[3 * q + p] * (crowd.states[i, X + q] - crowd.states[j, X + q])


@compiled
def _shifted(points, move, spots):
    """Write points of one part in the axes of the other."""
    for k in range(len(points)):
        a, b, c = points[k, 0], points[k, 1], points[k, 2]
        for p in range(3):
            spots[k, p] = move[3 * p] * a + move[3 * p + 1] * b + move[3 * p + 2] * c + move[9 + p]


@compiled
def _touch(crowd, solid, parts, spot, normal, gap, count):
    """Add a contact at a spot and with a normal in the second part's axes; how many rows there are now."""
    if count + 2 > len(crowd.pairs):
        return count
    i, j = parts
    b, rows, move = crowd.turns[j], crowd.pairs, crowd.frame
    x, y, z = spot
    u, v, w = normal
    n = (
        b[0] * u + b[1] * v + b[2] * w,
        b[3] * u + b[4] * v + b[5] * w,
        b[6] * u + b[7] * v + b[8] * w,
    )
    axes(rows[count], crowd.tangents[i], n)
    axes(rows[count + 1], crowd.tangents[i], n)
    x, y, z = x - move[9], y - move[10], z - move[11]
    own = (
        move[0] * x + move[3] * y + move[6] * z,
        move[1] * x + move[4] * y + move[7] * z,
        move[2] * x + move[5] * y + move[8] * z,
    )
    levers(rows[count], crowd.turns[i], solid.inertia, own)
    levers(rows[count + 1], b, solid.inertia, spot)
    for k in range(3):
        both = 1.0 / (1.0 / rows[count, MASS + k] + 1.0 / rows[count + 1, MASS + k])
        rows[count, MASS + k] = rows[count + 1, MASS + k] = both
        rows[count, IMPULSE + k] = 0.0
    rows[count, GAP] = gap
    crowd.owners[count], crowd.owners[count + 1] = i, j
    return count + 2


@compiled
def _rests(crowd, solid, k, n):
    """Whether a corner is the lowest of its surroundings over a face."""
    spots = crowd.shown
    for m in range(solid.firsts[k], solid.firsts[k + 1]):
        q = solid.beside[m]
        a, b, c = spots[q, 0] - spots[k, 0], spots[q, 1] - spots[k, 1], spots[q, 2] - spots[k, 2]
        if a * n[0] + b * n[1] + c * n[2] < -SLANT * math.sqrt(a * a + b * b + c * c):
            return False
    return True


@compiled
def _face(crowd, solid, blocks, k, reach):
    """Triangle that a corner touches, the least deep of those it may, and the gap; -1 for none."""
    p = crowd.shown[k]
    a, b, c = p[0], p[1], p[2]
    best, found = -DEEP, -1
    for f in range(blocks):
        block = crowd.faces[f]
        if _off(solid.face_blocks[block], p, p, reach + DEEP):
            continue
        for m in range(block * BLOCK, min((block + 1) * BLOCK, len(solid.triangles))):
            n, first = solid.normals[m], solid.vertices[solid.triangles[m, 0]]
            off = (a - first[0]) * n[0] + (b - first[1]) * n[1] + (c - first[2]) * n[2]
            if best < off < reach and within(solid, m, a, b, c, BESIDE) and _rests(crowd, solid, k, n):
                best, found = off, m
    return found, best


@compiled
def _off(box, p, q, reach):
    """Whether the box around two points lies farther than ``reach`` from another, along one of the axes."""
    for e in range(3):
        least, most = min(p[e], q[e]), max(p[e], q[e])
        if least > box[3 + e] + reach or most < box[e] - reach:
            return True
    return False


@compiled
def _emptied(box):
    for e in range(3):
        box[e], box[3 + e] = math.inf, -math.inf


@compiled
def _taken_in(box, p):
    for e in range(3):
        box[e], box[3 + e] = min(box[e], p[e]), max(box[3 + e], p[e])


@compiled
def _near_corners(crowd, solid, reach):
    """Write which corners of the first part come into the box of the second, and their own box; how many."""
    low, high, count = crowd.least, crowd.most, 0
    _emptied(crowd.box)
    for k in range(len(solid.corners)):
        p = crowd.shown[k]
        if p[0] < low[0] - reach or p[1] < low[1] - reach or p[2] < low[2] - reach:
            continue
        if p[0] > high[0] + reach or p[1] > high[1] + reach or p[2] > high[2] + reach:
            continue
        crowd.low[count] = k
        count += 1
        _taken_in(crowd.box, p)
    return count


@compiled
def _near_blocks(blocks, box, reach, found):
    """Write which blocks of the second part's faces, or of its edges, come to a box; how many."""
    count = 0
    for m in range(len(blocks)):
        if not _off(blocks[m], box[:3], box[3:], reach):
            found[count] = m
            count += 1
    return count


@compiled
def corners_on(crowd, solid, i, j, reach, count):
    """Add contacts of part i's corners within ``reach`` [L] of faces of j; fills ``crowd.shown`` (C, 3)."""
    _relative(crowd, i, j)
    _shifted(solid.corners, crowd.frame, crowd.shown)
    nears = _near_corners(crowd, solid, reach)
    if nears == 0:
        return count
    blocks = _near_blocks(solid.face_blocks, crowd.box, reach + DEEP, crowd.faces)
    for c in range(nears):
        k = crowd.low[c]
        m, gap = _face(crowd, solid, blocks, k, reach)
        if m >= 0:
            n, p = solid.normals[m], crowd.shown[k]
            count = _touch(crowd, solid, (i, j), (p[0], p[1], p[2]), (n[0], n[1], n[2]), gap, count)
    return count


@compiled
def _near_edges(solid, spots, low, high, reach, found):
    """Write which edges between the spots come into a box; how many."""
    count = 0
    for k in range(len(solid.edges)):
        p, q = spots[solid.edges[k, 0]], spots[solid.edges[k, 1]]
        meets = True
        for e in range(3):
            if min(p[e], q[e]) > high[e] + reach or max(p[e], q[e]) < low[e] - reach:
                meets = False
        if meets:
            found[count] = k
            count += 1
    return count


@compiled
def _beside(p, q, r, s, reach):
    """Whether two edges lie apart along one of the axes."""
    for e in range(3):
        if min(p[e], q[e]) > max(r[e], s[e]) + reach or max(p[e], q[e]) < min(r[e], s[e]) - reach:
            return True
    return False


@compiled
def edges_on(crowd, solid, i, j, reach, count):
    """Add contacts of convex edges of part i, corners in ``crowd.shown`` (C, 3) [L], with those of j."""
    nears = _near_edges(solid, crowd.shown, crowd.least, crowd.most, reach, crowd.ours)
    _emptied(crowd.box)
    for m in range(nears):
        _taken_in(crowd.box, crowd.shown[solid.edges[crowd.ours[m], 0]])
        _taken_in(crowd.box, crowd.shown[solid.edges[crowd.ours[m], 1]])
    blocks = 0
    if nears:
        blocks = _near_blocks(solid.edge_blocks, crowd.box, reach, crowd.theirs)
    for m in range(nears):
        k = crowd.ours[m]
        p, q = crowd.shown[solid.edges[k, 0]], crowd.shown[solid.edges[k, 1]]
        for f in range(blocks):
            block = crowd.theirs[f]
            if _off(solid.edge_blocks[block], p, q, reach):
                continue
            for n in range(block * BLOCK, min((block + 1) * BLOCK, len(solid.edges))):
                r, s = solid.corners[solid.edges[n, 0]], solid.corners[solid.edges[n, 1]]
                if not _beside(p, q, r, s, reach):
                    count = _cross(crowd, solid, (i, j), (k, n), reach, count)
    return count


@compiled
def _cross(crowd, solid, parts, edges, reach, count):
    """Add the contact of two edges (2,) of two parts (2,), if they touch; how many rows there are now."""
    ours, theirs = edges
    p, q = crowd.shown[solid.edges[ours, 0]], crowd.shown[solid.edges[ours, 1]]
    r, s = solid.corners[solid.edges[theirs, 0]], solid.corners[solid.edges[theirs, 1]]
    a, b, c = q[0] - p[0], q[1] - p[1], q[2] - p[2]
    u, v, w = s[0] - r[0], s[1] - r[1], s[2] - r[2]
    nx, ny, nz = b * w - c * v, c * u - a * w, a * v - b * u
    aa, uu, au = a * a + b * b + c * c, u * u + v * v + w * w, a * u + b * v + c * w
    size = math.sqrt(nx * nx + ny * ny + nz * nz)
    if size <= PARALLEL * math.sqrt(aa * uu):
        return count
    x, y, z = r[0] - p[0], r[1] - p[1], r[2] - p[2]
    pa, pu = x * a + y * b + z * c, x * u + y * v + z * w
    share, place = (pa * uu - pu * au) / size**2, (pa * au - pu * aa) / size**2
    if not (0.0 <= share <= 1.0 and 0.0 <= place <= 1.0):
        return count
    side = solid.sides[theirs]
    lean = nx * (side[0] + side[3]) + ny * (side[1] + side[4]) + nz * (side[2] + side[5])
    size = -size if lean > 0.0 else size  # away from the second part
    nx, ny, nz = nx / size, ny / size, nz / size
    gap = -(x * nx + y * ny + z * nz)
    if not -DEEP < gap < reach or not _wedged(crowd.frame, solid.sides[ours], side, nx, ny, nz):
        return count
    spot = (r[0] + place * u, r[1] + place * v, r[2] + place * w)
    return _touch(crowd, solid, parts, spot, (nx, ny, nz), gap, count)


@compiled
def _wedged(move, first, second, nx, ny, nz):
    """Whether a normal lies between the faces of both edges."""
    x = move[0] * nx + move[3] * ny + move[6] * nz
    y = move[1] * nx + move[4] * ny + move[7] * nz
    z = move[2] * nx + move[5] * ny + move[8] * nz
    for e in range(2):
        if second[3 * e] * nx + second[3 * e + 1] * ny + second[3 * e + 2] * nz > SLANT:
            return False
        if first[3 * e] * x + first[3 * e + 1] * y + first[3 * e + 2] * z < -SLANT:
            return False
    return True
