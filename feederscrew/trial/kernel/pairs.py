"""Compiled search for contacts between two parts of one shape: corners on faces, and edges on edges.

Everything is looked for in the body axes of the part that is touched, the second. A contact is two rows of
`trial.kernel.contact`, one for each part, with the same axes; the normal points towards the first part.
"""

import math
from typing import NamedTuple

import numpy as np

from feederscrew.dropping.kernel.body import X
from feederscrew.geometry.compiled import compiled
from feederscrew.trial.kernel.contact import MASS, add
from feederscrew.trial.kernel.edges import within
from feederscrew.trial.kernel.search import PARALLEL, SLANT

DEEP = 0.04  # how deep in each other parts are looked for, in units of their length
BESIDE = 2e-3  # by which a corner may lie beside the face it touches


class Crowd(NamedTuple):
    """Arrays for N parts of one shape with C corners and E convex edges, and room for P contacts."""

    states: np.ndarray  # (N, 13)
    before: np.ndarray  # (N, 13) at the start of a step
    turns: np.ndarray  # (N, 9)
    rows: np.ndarray  # (N, CONTACTS, WIDTH) contacts with the track
    counts: np.ndarray  # (N,) int, of them
    pairs: np.ndarray  # (2 P, WIDTH) contacts with each other, two rows each
    owners: np.ndarray  # (2 P,) int, which part a row is of
    strains: np.ndarray  # (N, 2) impulse from behind along the track, and from below, of other parts
    links: np.ndarray  # (C + 1 + 2 E,) int: where each corner's neighbours are listed, then the neighbours
    low: np.ndarray  # (3,) box of the part in its own axes
    high: np.ndarray  # (3,)
    move: np.ndarray  # (12,) rotation and place of one part in the axes of another
    spots: np.ndarray  # (C, 3) corners of one in the axes of the other
    near: np.ndarray  # (E,) int, edges of the first part
    far: np.ndarray  # (E,) int, edges of the second
    corners: np.ndarray  # (C,) int, corners of the first part
    faces: np.ndarray  # (T,) int, faces of the second
    box: np.ndarray  # (6,) what of the first part is near the second: least and greatest place
    tangent: np.ndarray  # (2,)


@compiled
def _relative(crowd, i, j):
    """Write rotation and place of part i in the body axes of part j."""
    a, b, move = crowd.turns[i], crowd.turns[j], crowd.move
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
def _touch(crowd, solid, i, j, x, y, z, u, v, w, gap, count):
    """Add a contact at a point and with a normal in the axes of part j; how many rows there are now."""
    if count + 2 > len(crowd.pairs):
        return count
    b = crowd.turns[j]
    nx, ny, nz = (
        b[0] * u + b[1] * v + b[2] * w,
        b[3] * u + b[4] * v + b[5] * w,
        b[6] * u + b[7] * v + b[8] * w,
    )
    px, py, pz = (
        b[0] * x + b[1] * y + b[2] * z,
        b[3] * x + b[4] * y + b[5] * z,
        b[6] * x + b[7] * y + b[8] * z,
    )
    first, second = crowd.states[i], crowd.states[j]
    ax, ay, az = px + second[0] - first[0], py + second[1] - first[1], pz + second[2] - first[2]
    rows, inertia, tangent = crowd.pairs, solid.inertia, crowd.tangent
    add(rows, count, crowd.turns[i], inertia, tangent, ax, ay, az, nx, ny, nz, gap, 0.0)
    add(rows, count + 1, b, inertia, tangent, px, py, pz, nx, ny, nz, gap, 0.0)
    for k in range(3):
        both = 1.0 / (1.0 / rows[count, MASS + k] + 1.0 / rows[count + 1, MASS + k])
        rows[count, MASS + k] = rows[count + 1, MASS + k] = both
    crowd.owners[count], crowd.owners[count + 1] = i, j
    return count + 2


@compiled
def _rests(crowd, k, n):
    """Whether a corner is the lowest of its surroundings over a face."""
    links, spots = crowd.links, crowd.spots
    for m in range(links[k], links[k + 1]):
        q = links[m]
        a, b, c = spots[q, 0] - spots[k, 0], spots[q, 1] - spots[k, 1], spots[q, 2] - spots[k, 2]
        if a * n[0] + b * n[1] + c * n[2] < -SLANT * math.sqrt(a * a + b * b + c * c):
            return False
    return True


@compiled
def _face(crowd, solid, faces, k, reach):
    """Triangle that a corner touches, the least deep of those it may, and the gap; -1 for none."""
    a, b, c = crowd.spots[k, 0], crowd.spots[k, 1], crowd.spots[k, 2]
    best, found = -DEEP, -1
    for f in range(faces):
        m = crowd.faces[f]
        n, first = solid.normals[m], solid.vertices[solid.triangles[m, 0]]
        off = (a - first[0]) * n[0] + (b - first[1]) * n[1] + (c - first[2]) * n[2]
        if best < off < reach and within(solid, m, a, b, c, BESIDE) and _rests(crowd, k, n):
            best, found = off, m
    return found, best


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
    low, high, count = crowd.low, crowd.high, 0
    _emptied(crowd.box)
    for k in range(len(solid.corners)):
        p = crowd.spots[k]
        if p[0] < low[0] - reach or p[1] < low[1] - reach or p[2] < low[2] - reach:
            continue
        if p[0] > high[0] + reach or p[1] > high[1] + reach or p[2] > high[2] + reach:
            continue
        crowd.corners[count] = k
        count += 1
        _taken_in(crowd.box, p)
    return count


@compiled
def _near_faces(crowd, solid, reach):
    """Write which faces of the second part come into ``crowd.box``; how many."""
    box, count = crowd.box, 0
    for m in range(len(solid.triangles)):
        t = solid.triangles[m]
        p, q, r = solid.vertices[t[0]], solid.vertices[t[1]], solid.vertices[t[2]]
        meets = True
        for e in range(3):
            if min(p[e], q[e], r[e]) > box[3 + e] + reach or max(p[e], q[e], r[e]) < box[e] - reach:
                meets = False
        if meets:
            crowd.faces[count] = m
            count += 1
    return count


@compiled
def corners_on(crowd, solid, i, j, reach, count):
    """Add contacts of the corners of part i with faces of part j; leaves the corners in ``crowd.spots``."""
    _relative(crowd, i, j)
    _shifted(solid.corners, crowd.move, crowd.spots)
    nears = _near_corners(crowd, solid, reach)
    if nears == 0:
        return count
    faces = _near_faces(crowd, solid, reach + DEEP)
    for c in range(nears):
        k = crowd.corners[c]
        m, gap = _face(crowd, solid, faces, k, reach)
        if m >= 0:
            n, p = solid.normals[m], crowd.spots[k]
            count = _touch(crowd, solid, i, j, p[0], p[1], p[2], n[0], n[1], n[2], gap, count)
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
    """Add contacts of the convex edges of part i, its corners in ``crowd.spots``, with those of part j."""
    nears = _near_edges(solid, crowd.spots, crowd.low, crowd.high, reach, crowd.near)
    _emptied(crowd.box)
    for m in range(nears):
        _taken_in(crowd.box, crowd.spots[solid.edges[crowd.near[m], 0]])
        _taken_in(crowd.box, crowd.spots[solid.edges[crowd.near[m], 1]])
    fars = 0
    if nears:
        fars = _near_edges(solid, solid.corners, crowd.box[:3], crowd.box[3:], reach, crowd.far)
    for m in range(nears):
        k = crowd.near[m]
        p, q = crowd.spots[solid.edges[k, 0]], crowd.spots[solid.edges[k, 1]]
        for f in range(fars):
            n = crowd.far[f]
            r, s = solid.corners[solid.edges[n, 0]], solid.corners[solid.edges[n, 1]]
            if not _beside(p, q, r, s, reach):
                count = _cross(crowd, solid, i, j, k, n, p, q, r, s, reach, count)
    return count


@compiled
def _cross(crowd, solid, i, j, k, n, p, q, r, s, reach, count):
    """The contact of edge k, from p to q, of part i with edge n, from r to s, of part j, if they touch."""
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
    side = solid.sides[n]
    lean = nx * (side[0] + side[3]) + ny * (side[1] + side[4]) + nz * (side[2] + side[5])
    size = -size if lean > 0.0 else size  # away from the second part
    nx, ny, nz = nx / size, ny / size, nz / size
    gap = -(x * nx + y * ny + z * nz)
    if not -DEEP < gap < reach or not _wedged(crowd.move, solid.sides[k], side, nx, ny, nz):
        return count
    at = place
    return _touch(crowd, solid, i, j, r[0] + at * u, r[1] + at * v, r[2] + at * w, nx, ny, nz, gap, count)


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
