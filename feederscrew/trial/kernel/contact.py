"""Compiled contacts of a part with anything: rows of WIDTH numbers, and the impulses at them.

A row holds three axes in the bowl's frame, two along the contact and its normal, towards the part; along
each axis the lever in body axes and the rates that one unit of impulse gives; the effective masses; the
speed along the normal wanted after the impulse; the impulse; the friction against sliding ahead and back;
and the gap.
"""

import math

from feederscrew.dropping.kernel.body import VX, VZ, W
from feederscrew.geometry.compiled import compiled

AXES, LEVER, RATE, MASS, WANTED, IMPULSE = 0, 9, 18, 27, 30, 31
AHEAD, BACK, GAP, WALL, WIDTH = 34, 35, 36, 37, 38
NORMAL = 2  # which of the axes


@compiled
def add(contacts, count, turn, inertia, tangent, x, y, z, nx, ny, nz, gap, wall):
    """Write a contact at (x, y, z) from the centre of mass with its normal; how many there are now."""
    if count >= len(contacts):
        return count
    row = contacts[count]
    u, v, w = tangent[0], tangent[1], 0.0
    across = u * nx + v * ny
    if abs(across) > 0.9:
        u, v, w, across = 0.0, 0.0, 1.0, nz
    u, v, w = u - across * nx, v - across * ny, w - across * nz
    size = 1.0 / math.sqrt(u * u + v * v + w * w)
    row[0], row[1], row[2] = u * size, v * size, w * size
    row[6], row[7], row[8] = nx, ny, nz
    row[3], row[4], row[5] = ny * row[2] - nz * row[1], nz * row[0] - nx * row[2], nx * row[1] - ny * row[0]
    for e in range(3):
        a, b, c = row[3 * e], row[3 * e + 1], row[3 * e + 2]
        p, q, r = y * c - z * b, z * a - x * c, x * b - y * a
        for k in range(3):
            lever = turn[k] * p + turn[3 + k] * q + turn[6 + k] * r
            row[LEVER + 3 * e + k] = lever
            row[RATE + 3 * e + k] = lever / inertia[k]
    _masses(row)
    row[GAP], row[WALL] = gap, wall
    return count + 1


@compiled
def _coupling(row, d, e):
    i, j = LEVER + 3 * d, RATE + 3 * e
    return row[i] * row[j] + row[i + 1] * row[j + 1] + row[i + 2] * row[j + 2]


@compiled
def _masses(row):
    """Fill the effective masses: of both axes along the contact the smaller that serves both."""
    xx, yy, zz = 1.0 + _coupling(row, 0, 0), 1.0 + _coupling(row, 1, 1), 1.0 + _coupling(row, 2, 2)
    lean, mean, cross = 0.5 * (xx - yy), 0.5 * (xx + yy), _coupling(row, 0, 1)
    row[MASS] = row[MASS + 1] = 1.0 / (mean + math.sqrt(lean * lean + cross * cross))
    row[MASS + 2] = 1.0 / zz


@compiled
def speed(state, row, e):
    """Velocity of a contact along one of its axes."""
    a, k = 3 * e, LEVER + 3 * e
    found = row[a] * state[VX] + row[a + 1] * state[VX + 1] + row[a + 2] * state[VZ]
    return found + row[k] * state[W] + row[k + 1] * state[W + 1] + row[k + 2] * state[W + 2]


@compiled
def _speed(row, a, k, u, v, w, p, q, r):
    along = row[a] * u + row[a + 1] * v + row[a + 2] * w
    return along + row[k] * p + row[k + 1] * q + row[k + 2] * r


@compiled
def _pushed(row, a, k, impulse, u, v, w, p, q, r):
    u, v, w = u + row[a] * impulse, v + row[a + 1] * impulse, w + row[a + 2] * impulse
    return u, v, w, p + row[k] * impulse, q + row[k + 1] * impulse, r + row[k + 2] * impulse


@compiled
def _relax(row, rough, u, v, w, p, q, r):
    """One projected Gauss-Seidel step on a contact: velocities, rates and the change of its impulse."""
    x, y, z = row[IMPULSE], row[IMPULSE + 1], row[IMPULSE + 2]
    up = max(z + row[MASS + 2] * (row[WANTED] - _speed(row, 6, LEVER + 6, u, v, w, p, q, r)), 0.0)
    u, v, w, p, q, r = _pushed(row, 6, RATE + 6, up - z, u, v, w, p, q, r)
    change = abs(up - z)
    if rough and (up > 0.0 or z > 0.0):
        ahead = x - row[MASS] * _speed(row, 0, LEVER, u, v, w, p, q, r)
        aside = y - row[MASS + 1] * _speed(row, 3, LEVER + 3, u, v, w, p, q, r)
        size, most = ahead * ahead + aside * aside, up * (row[BACK] if ahead > 0.0 else row[AHEAD])
        if size > most * most:
            scale = most / math.sqrt(size)
            ahead, aside = scale * ahead, scale * aside
        u, v, w, p, q, r = _pushed(row, 0, RATE, ahead - x, u, v, w, p, q, r)
        u, v, w, p, q, r = _pushed(row, 3, RATE + 3, aside - y, u, v, w, p, q, r)
        row[IMPULSE], row[IMPULSE + 1] = ahead, aside
        change += abs(ahead - x) + abs(aside - y)
    row[IMPULSE + 2] = up
    return u, v, w, p, q, r, change


@compiled
def solve(state, contacts, count, rough, sweeps, converged, warm):
    """Contact impulses that let each contact leave at its wanted speed or faster; with friction if rough.

    Begun with ``warm`` times the impulses in the rows.
    Swept until a whole sweep changes the impulses by no more than ``converged`` of their sum.
    """
    u, v, w = state[VX], state[VX + 1], state[VZ]
    p, q, r = state[W], state[W + 1], state[W + 2]
    for n in range(count):
        row = contacts[n]
        if warm > 0.0:
            for e in range(3):
                row[IMPULSE + e] *= warm
                u, v, w, p, q, r = _pushed(row, 3 * e, RATE + 3 * e, row[IMPULSE + e], u, v, w, p, q, r)
        else:
            row[IMPULSE] = row[IMPULSE + 1] = row[IMPULSE + 2] = 0.0
    for _ in range(sweeps):
        change = size = 0.0
        for n in range(count):
            u, v, w, p, q, r, more = _relax(contacts[n], rough, u, v, w, p, q, r)
            change += more
            size += contacts[n, IMPULSE + 2]
        if change <= converged * size:
            break
    state[VX], state[VX + 1], state[VZ] = u, v, w
    state[W], state[W + 1], state[W + 2] = p, q, r
