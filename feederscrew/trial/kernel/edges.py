"""Compiled search for contacts of a part's edges with a plate's borders, and of its faces with corners."""

import math

from feederscrew.geometry.compiled import compiled
from feederscrew.trial.kernel.contact import add
from feederscrew.trial.kernel.search import (
    ACROSS,
    ALONG,
    DEEP,
    DEPTH,
    FIRST,
    FRONT,
    LAST,
    LEVEL,
    PARALLEL,
    ROUNDED,
    SLANT,
    crossing,
    front,
    points_to,
)

BEND, END = 6, 7  # columns of a border: a convex corner at its start; no border but the end of the drawing
NORMAL, BEFORE = 4, 8  # ... where its normal begins, and that of the border before it
STEEP = 0.02  # [1] slope against a plate's front from which a face may lie on a corner


@compiled
def _vector(plate, turn, x, y, z, vector):
    """Write a vector of the body in a plate's coordinates."""
    a = turn[0] * x + turn[1] * y + turn[2] * z
    b = turn[3] * x + turn[4] * y + turn[5] * z
    c = turn[6] * x + turn[7] * y + turn[8] * z
    for e in range(3):
        k = ACROSS + 3 * e
        vector[e] = plate[k] * a + plate[k + 1] * b + plate[k + 2] * c


@compiled
def low_edges(solid, shown, reach, found, box):
    """Write which edges of the part reach a plate's surface, and the box they are in; how many."""
    box[0] = box[2] = math.inf
    box[1] = box[3] = -math.inf
    count = 0
    for k in range(len(solid.edges)):
        p, q = shown[solid.edges[k, 0]], shown[solid.edges[k, 1]]
        if min(p[2], q[2]) <= reach and max(p[2], q[2]) >= -DEEP:
            found[count] = k
            count += 1
            for e in range(2):
                box[2 * e] = min(box[2 * e], p[e], q[e])
                box[2 * e + 1] = max(box[2 * e + 1], p[e], q[e])
    return count


@compiled
def near_borders(plate, borders, box, reach, found):
    """Write which borders come into a box; how many."""
    count = 0
    for k in range(int(plate[FIRST]), int(plate[LAST])):
        p, q, u, v = borders[k, 0], borders[k, 1], borders[k, 2], borders[k, 3]
        if min(p, u) > box[1] + reach or max(p, u) < box[0] - reach:
            continue
        if min(q, v) > box[3] + reach or max(q, v) < box[2] - reach or borders[k, END] > 0.5:
            continue
        found[count] = k
        count += 1
    return count


@compiled
def edges_on(plate, borders, nears, lows, solid, turn, reach, work, contacts, count):
    """Add contacts of the part's low edges with near borders."""
    shown, spots = work.shown, work.spots
    for n in range(lows):
        k = work.edges[n]
        i, j = solid.edges[k, 0], solid.edges[k, 1]
        p, q, ready = shown[i], shown[j], False
        for m in range(nears):
            border = borders[work.near[m]]
            if _apart(p, q, border, reach):
                continue
            if not ready:
                ready, s = True, solid.sides[k]
                _vector(plate, turn, s[0], s[1], s[2], work.vectors[0])
                _vector(plate, turn, s[3], s[4], s[5], work.vectors[1])
            share, u, v, w, gap = crossing(p, q, border, work.vectors, reach)
            if gap < math.inf and not end_touches(solid, shown, i, j, border, w, gap, plate[ROUNDED]):
                x = spots[i, 0] + share * (spots[j, 0] - spots[i, 0])
                y = spots[i, 1] + share * (spots[j, 1] - spots[i, 1])
                z = spots[i, 2] + share * (spots[j, 2] - spots[i, 2])
                count = front(
                    plate, solid.inertia, turn, work.tangent, x, y, z, u, v, w, gap, contacts, count
                )
    return count


@compiled
def end_touches(solid, shown, i, j, border, level, gap, rounded):
    """Say whether an end of an edge touches a surface or its side, and so the edge not the border.

    It is nearer to that than the edge is to the border, and none of its neighbours lies beyond it. How level
    the edge's contact is, ``level``, tells surface and side apart.
    """
    u, v, w = (border[NORMAL], border[NORMAL + 1], 0.0) if level >= LEVEL else (0.0, 0.0, 1.0)
    x, y = shown[i, 0] - border[0], shown[i, 1] - border[1]
    first = u * x + v * y + w * shown[i, 2]
    x, y = shown[j, 0] - border[0], shown[j, 1] - border[1]
    second = u * x + v * y + w * shown[j, 2]
    k, height = (i, first) if first < second else (j, second)
    if level < LEVEL and height > -rounded:  # an edge that is less deep does not catch
        return True
    return height > gap and gap < -rounded and points_to(solid, shown, k, u, v, w)


@compiled
def _apart(p, q, border, reach):
    """Whether an edge and a border lie apart along one of the plate's axes."""
    if min(p[0], q[0]) > max(border[0], border[2]) + reach:
        return True
    if max(p[0], q[0]) < min(border[0], border[2]) - reach:
        return True
    if min(p[1], q[1]) > max(border[1], border[3]) + reach:
        return True
    return max(p[1], q[1]) < min(border[1], border[3]) - reach


@compiled
def edges_on_posts(plate, borders, nears, solid, turn, reach, work, contacts, count):
    """Add contacts of the part's edges with the edges that run down a plate's side from convex corners."""
    shown, spots = work.shown, work.spots
    for m in range(nears):
        border = borders[work.near[m]]
        if border[BEND] < 0.5:
            continue
        for k in range(len(solid.edges)):
            i, j = solid.edges[k, 0], solid.edges[k, 1]
            p, q = shown[i], shown[j]
            if not _past(p, q, border, plate, reach):
                continue
            s = solid.sides[k]
            _vector(plate, turn, s[0], s[1], s[2], work.vectors[0])
            _vector(plate, turn, s[3], s[4], s[5], work.vectors[1])
            share, u, v, gap = _post(p, q, border, work.vectors, reach)
            height = p[2] + share * (q[2] - p[2])
            if gap < math.inf and -plate[DEPTH] < height < -plate[ROUNDED]:
                x = spots[i, 0] + share * (spots[j, 0] - spots[i, 0])
                y = spots[i, 1] + share * (spots[j, 1] - spots[i, 1])
                z = spots[i, 2] + share * (spots[j, 2] - spots[i, 2])
                count = front(
                    plate, solid.inertia, turn, work.tangent, x, y, z, u, v, 0.0, gap, contacts, count
                )
    return count


@compiled
def _past(p, q, border, plate, reach):
    """Whether an edge comes past the corner at the start of a border, between a plate's front and back."""
    if min(p[2], q[2]) > -plate[ROUNDED] or max(p[2], q[2]) < -plate[DEPTH]:
        return False
    off = DEEP + reach
    if min(p[0], q[0]) > border[0] + off or max(p[0], q[0]) < border[0] - off:
        return False
    return min(p[1], q[1]) <= border[1] + off and max(p[1], q[1]) >= border[1] - off


@compiled
def _post(p, q, border, wedge, reach):
    """Where an edge from p to q touches the line straight back from the start of a border.

    Returns
    -------
    share of the edge, normal (2) along the plate, gap; the gap is infinite where they do not touch
    """
    a, b, c = q[0] - p[0], q[1] - p[1], q[2] - p[2]
    square = a * a + b * b
    if square <= PARALLEL * PARALLEL * (square + c * c):
        return 0.0, 0.0, 0.0, math.inf
    x, y = border[0] - p[0], border[1] - p[1]
    share, size = (x * a + y * b) / square, math.sqrt(square)
    u, v = b / size, -a / size
    if u * (border[NORMAL] + border[BEFORE]) + v * (border[NORMAL + 1] + border[BEFORE + 1]) < 0.0:
        u, v = -u, -v
    gap = -(u * x + v * y)
    if share < 0.0 or share > 1.0 or gap > reach or gap < -DEEP:
        return 0.0, 0.0, 0.0, math.inf
    # the solid goes on along this border, and back along the one before it
    along = -u * border[NORMAL + 1] + v * border[NORMAL]
    back = u * border[BEFORE + 1] - v * border[BEFORE]
    if along > SLANT or back > SLANT:
        return 0.0, 0.0, 0.0, math.inf
    for k in range(2):
        if u * wedge[k, 0] + v * wedge[k, 1] < -SLANT:
            return 0.0, 0.0, 0.0, math.inf
    return share, u, v, gap


@compiled
def low_faces(solid, plate, turn, shown, reach, found, vector):
    """Write which triangles of the part face a plate and reach its surface; how many."""
    _inverse(plate, turn, vector)
    u, v, w = vector[0], vector[1], vector[2]
    count, known = 0, len(shown)
    for k in range(len(solid.triangles)):
        n = solid.normals[k]
        if n[0] * u + n[1] * v + n[2] * w > -STEEP:
            continue
        least = math.inf
        for e in range(3):
            i = solid.triangles[k, e]
            least = min(least, shown[i, 2]) if i < known else -math.inf
        if least <= reach:
            found[count] = k
            count += 1
    return count


@compiled
def faces_on(plate, borders, nears, solid, state, turn, reach, work, contacts, count):
    """Add contacts of the part's faces with the convex corners of near borders."""
    lows, vector = -1, work.vectors[2]
    for m in range(nears):
        border = borders[work.near[m]]
        if border[BEND] < 0.5:
            continue
        if lows < 0:
            lows = low_faces(solid, plate, turn, work.shown, reach, work.faces, vector)
        _corner(plate, border, state, vector)
        x, y, z = vector[0], vector[1], vector[2]
        a = turn[0] * x + turn[3] * y + turn[6] * z
        b = turn[1] * x + turn[4] * y + turn[7] * z
        c = turn[2] * x + turn[5] * y + turn[8] * z
        k, off = _face_at(solid, work.faces, lows, a, b, c, reach)
        if k >= 0:
            n = solid.normals[k]
            nx = -(turn[0] * n[0] + turn[1] * n[1] + turn[2] * n[2])
            ny = -(turn[3] * n[0] + turn[4] * n[1] + turn[5] * n[2])
            nz = -(turn[6] * n[0] + turn[7] * n[1] + turn[8] * n[2])
            count = add(contacts, count, turn, solid.inertia, work.tangent, x, y, z, nx, ny, nz, off, 0.0)
    return count


@compiled
def _corner(plate, border, state, vector):
    """Write where a border starts, from the centre of mass."""
    for e in range(3):
        vector[e] = plate[e] + border[0] * plate[ACROSS + e] + border[1] * plate[ALONG + e] - state[e]


@compiled
def _face_at(solid, faces, lows, a, b, c, reach):
    """Triangle of the part that a corner touches, of the nearest plane, and the gap; -1 for none."""
    best, found = math.inf, -1
    for m in range(lows):
        k = faces[m]
        n, first = solid.normals[k], solid.vertices[solid.triangles[k, 0]]
        off = (a - first[0]) * n[0] + (b - first[1]) * n[1] + (c - first[2]) * n[2]
        if -DEEP < off < reach and abs(off) < abs(best) and within(solid, k, a, b, c, 0.0):
            best, found = off, k
    return found, best


@compiled
def _inverse(plate, turn, vector):
    """Write a plate's front in body axes."""
    for e in range(3):
        vector[e] = turn[e] * plate[FRONT] + turn[3 + e] * plate[FRONT + 1] + turn[6 + e] * plate[FRONT + 2]


@compiled
def within(solid, k, a, b, c, beside):
    """Say whether a point lies over a triangle, or no further than ``beside`` outside it."""
    n = solid.normals[k]
    for i in range(3):
        p, q = solid.vertices[solid.triangles[k, i]], solid.vertices[solid.triangles[k, (i + 1) % 3]]
        u, v, w = q[0] - p[0], q[1] - p[1], q[2] - p[2]
        x, y, z = a - p[0], b - p[1], c - p[2]
        side = n[0] * (v * z - w * y) + n[1] * (w * x - u * z) + n[2] * (u * y - v * x)
        if side < -beside * math.sqrt(u * u + v * v + w * w):
            return False
    return True
