"""Compiled contacts of a part with anything: rows of WIDTH numbers, and the impulses at them.

A row begins as one of `floor_contacts`: along each of its axes the lever in body axes and the rates
that one unit of impulse gives; the effective masses; the speed along the normal wanted after the impulse; the
impulse. Here the axes are its own, in the bowl's frame, two along the contact and its normal, towards the
part; then come the friction against sliding ahead and back, the gap, and whether it is with the wall.
"""

import math

from feederscrew.dropping.kernel.body import VX, VZ, W
from feederscrew.dropping.kernel.floor_contacts import IMPULSE, LEVER, MASS, RATE, WANTED, masses, rates
from feederscrew.geometry.compiled import compiled

AXES = IMPULSE + 3
AHEAD, BACK, GAP, WALL, WIDTH = (AXES + 9 + k for k in range(5))
NORMAL = 2  # which of the axes
TOWARDS = AXES + 3 * NORMAL  # where it is


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
    u, v, w = u * size, v * size, w * size
    p, q, r = ny * w - nz * v, nz * u - nx * w, nx * v - ny * u
    _arm(row, 0, turn, x, y, z, u, v, w)
    _arm(row, 1, turn, x, y, z, p, q, r)
    _arm(row, NORMAL, turn, x, y, z, nx, ny, nz)
    rates(inertia, row)
    masses(row)
    row[GAP], row[WALL] = gap, wall
    return count + 1


@compiled
def _arm(row, e, turn, x, y, z, a, b, c):
    """Write an axis and its lever, (x, y, z) x (a, b, c) in body axes."""
    row[AXES + 3 * e], row[AXES + 3 * e + 1], row[AXES + 3 * e + 2] = a, b, c
    p, q, r = y * c - z * b, z * a - x * c, x * b - y * a
    for k in range(3):
        row[LEVER + 3 * e + k] = turn[k] * p + turn[3 + k] * q + turn[6 + k] * r


@compiled
def speed(state, row, e):
    """Return the velocity of a contact along one of its axes."""
    a, k = AXES + 3 * e, LEVER + 3 * e
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
def rubbing(ahead, aside, most):
    """Return impulses along a contact, of the size that friction allows at most."""
    size = ahead * ahead + aside * aside
    scale = most / math.sqrt(size) if size > most * most else 1.0
    return scale * ahead, scale * aside


@compiled
def _relax(row, rough, u, v, w, p, q, r):
    """One projected Gauss-Seidel step on a contact: velocities, rates and the change of its impulse."""
    x, y, z = row[IMPULSE], row[IMPULSE + 1], row[IMPULSE + 2]
    up = max(z + row[MASS + 2] * (row[WANTED] - _speed(row, TOWARDS, LEVER + 6, u, v, w, p, q, r)), 0.0)
    u, v, w, p, q, r = _pushed(row, TOWARDS, RATE + 6, up - z, u, v, w, p, q, r)
    change = abs(up - z)
    if rough and (up > 0.0 or z > 0.0):
        ahead = x - row[MASS] * _speed(row, AXES, LEVER, u, v, w, p, q, r)
        aside = y - row[MASS + 1] * _speed(row, AXES + 3, LEVER + 3, u, v, w, p, q, r)
        ahead, aside = rubbing(ahead, aside, up * (row[BACK] if ahead > 0.0 else row[AHEAD]))
        u, v, w, p, q, r = _pushed(row, AXES, RATE, ahead - x, u, v, w, p, q, r)
        u, v, w, p, q, r = _pushed(row, AXES + 3, RATE + 3, aside - y, u, v, w, p, q, r)
        row[IMPULSE], row[IMPULSE + 1] = ahead, aside
        change += abs(ahead - x) + abs(aside - y)
    row[IMPULSE + 2] = up
    return u, v, w, p, q, r, change


@compiled
def solve(state, contacts, count, rough, sweeps, converged, warm):
    """Find impulses that let each contact leave at its wanted speed or faster; with friction if rough.

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
                u, v, w, p, q, r = _pushed(
                    row, AXES + 3 * e, RATE + 3 * e, row[IMPULSE + e], u, v, w, p, q, r
                )
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
