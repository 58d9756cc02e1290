"""Compiled search for contacts of a part's edges with a plate's borders, and of its faces with corners."""

import math

from feederscrew.dropping.kernel.body import X, Y, Z
from feederscrew.geometry.compiled import compiled
from feederscrew.trial.kernel.contact import add
from feederscrew.trial.kernel.search import ACROSS, ALONG, DEEP, FIRST, FRONT, LAST, ROUNDED, _crossing

BEND, END = 6, 7  # columns of a border: a convex corner at its start; no border but the end of the drawing
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
def near_borders(plate, borders, state, radius, found):
    """Write which borders a part of a radius may touch; how many."""
    x, y, z = state[X] - plate[0], state[Y] - plate[1], state[Z] - plate[2]
    a = plate[ACROSS] * x + plate[ACROSS + 1] * y + plate[ACROSS + 2] * z
    b = plate[ALONG] * x + plate[ALONG + 1] * y + plate[ALONG + 2] * z
    count = 0
    for k in range(int(plate[FIRST]), int(plate[LAST])):
        p, q, u, v = borders[k, 0] - a, borders[k, 1] - b, borders[k, 2] - a, borders[k, 3] - b
        if min(p, u) > radius or max(p, u) < -radius or min(q, v) > radius or max(q, v) < -radius:
            continue
        if borders[k, END] < 0.5:
            found[count] = k
            count += 1
    return count


@compiled
def edges_on(plate, borders, near, nears, solid, shown, spots, turn, tangent, reach, work, contacts, count):
    """Contacts of the part's edges with borders."""
    edges = solid.edges
    for k in range(len(edges)):
        i, j = edges[k, 0], edges[k, 1]
        low, high = shown[i, 2], shown[j, 2]
        if min(low, high) > reach or max(low, high) < -DEEP:
            continue
        ready = False
        p, q = shown[i], shown[j]
        for m in range(nears):
            n = near[m]
            if _apart(p, q, borders[n], reach):
                continue
            if not ready:
                ready, s = True, solid.sides[k]
                _vector(plate, turn, s[0], s[1], s[2], work[0])
                _vector(plate, turn, s[3], s[4], s[5], work[1])
            share, u, v, w, gap = _crossing(p, q, borders[n], work, plate[ROUNDED], reach)
            if gap < math.inf:
                x = spots[i, 0] + share * (spots[j, 0] - spots[i, 0])
                y = spots[i, 1] + share * (spots[j, 1] - spots[i, 1])
                z = spots[i, 2] + share * (spots[j, 2] - spots[i, 2])
                count = _front(plate, solid.inertia, turn, tangent, x, y, z, u, v, w, gap, contacts, count)
    return count


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
def _front(plate, inertia, turn, tangent, x, y, z, u, v, w, gap, contacts, count):
    """Add a contact whose normal is given in a plate's coordinates."""
    nx = u * plate[ACROSS] + v * plate[ALONG] + w * plate[FRONT]
    ny = u * plate[ACROSS + 1] + v * plate[ALONG + 1] + w * plate[FRONT + 1]
    nz = u * plate[ACROSS + 2] + v * plate[ALONG + 2] + w * plate[FRONT + 2]
    return add(contacts, count, turn, inertia, tangent, x, y, z, nx, ny, nz, gap, 0.0)


@compiled
def faces_on(plate, borders, near, nears, solid, state, turn, tangent, reach, work, contacts, count):
    """Contacts of the part's faces with the convex corners of borders."""
    for m in range(nears):
        border = borders[near[m]]
        if border[BEND] < 0.5:
            continue
        _corner(plate, border, state, work[2])
        x, y, z = work[2, 0], work[2, 1], work[2, 2]
        if x * x + y * y + z * z > (solid.radius + reach) ** 2:
            continue
        a = turn[0] * x + turn[3] * y + turn[6] * z
        b = turn[1] * x + turn[4] * y + turn[7] * z
        c = turn[2] * x + turn[5] * y + turn[8] * z
        k, off = _face_at(solid, plate, turn, a, b, c, reach, work)
        if k >= 0:
            n = solid.normals[k]
            nx = -(turn[0] * n[0] + turn[1] * n[1] + turn[2] * n[2])
            ny = -(turn[3] * n[0] + turn[4] * n[1] + turn[5] * n[2])
            nz = -(turn[6] * n[0] + turn[7] * n[1] + turn[8] * n[2])
            count = add(contacts, count, turn, solid.inertia, tangent, x, y, z, nx, ny, nz, off, 0.0)
    return count


@compiled
def _corner(plate, border, state, vector):
    """Write where a border starts, from the centre of mass."""
    for e in range(3):
        vector[e] = plate[e] + border[0] * plate[ACROSS + e] + border[1] * plate[ALONG + e] - state[e]


@compiled
def _face_at(solid, plate, turn, a, b, c, reach, work):
    """Triangle of the part that a corner touches, and the gap; -1 for none."""
    _inverse(plate, turn, work[2])
    u, v, w = work[2, 0], work[2, 1], work[2, 2]
    best, found = math.inf, -1
    for k in range(len(solid.triangles)):
        n = solid.normals[k]
        if n[0] * u + n[1] * v + n[2] * w > -STEEP:
            continue
        first = solid.vertices[solid.triangles[k, 0]]
        off = (a - first[0]) * n[0] + (b - first[1]) * n[1] + (c - first[2]) * n[2]
        if -DEEP < off < reach and off < best and _within(solid, k, a, b, c):
            best, found = off, k
    return found, best


@compiled
def _inverse(plate, turn, vector):
    """Write a plate's front in body axes."""
    for e in range(3):
        vector[e] = turn[e] * plate[FRONT] + turn[3 + e] * plate[FRONT + 1] + turn[6 + e] * plate[FRONT + 2]


@compiled
def _within(solid, k, a, b, c):
    """Whether a point lies over a triangle."""
    n = solid.normals[k]
    for i in range(3):
        p, q = solid.vertices[solid.triangles[k, i]], solid.vertices[solid.triangles[k, (i + 1) % 3]]
        u, v, w = q[0] - p[0], q[1] - p[1], q[2] - p[2]
        x, y, z = a - p[0], b - p[1], c - p[2]
        side = n[0] * (v * z - w * y) + n[1] * (w * x - u * z) + n[2] * (u * y - v * x)
        if side < 0.0:
            return False
    return True
