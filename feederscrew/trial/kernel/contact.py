"""Compiled contacts of a part with anything: rows of WIDTH numbers, and the impulses at them.

A row begins as one of `dropping.kernel.floor_contacts`: along each of its axes the lever in body axes and
the rates that one unit of impulse gives; the effective masses; the speed along the normal wanted after the
impulse; the impulse. Here the axes are its own, in the bowl's frame, two along the contact and its normal,
towards the part; then come the friction against sliding ahead and back, the gap, the friction of what is
touched where that is its own, which contact it is, and where it is, in body axes.
"""

import math

from feederscrew.dropping.kernel.body import VX, VZ, W
from feederscrew.dropping.kernel.floor_contacts import IMPULSE, LEVER, MASS, RATE, WANTED, masses, rates
from feederscrew.geometry.compiled import apart, compiled

AXES = IMPULSE + 3
AHEAD, BACK, GAP, RUB, KEY, SPOT = (AXES + 9 + k for k in range(6))
WIDTH = SPOT + 3
KINDS = 8.0  # [1] of a contact's key: its kind, then what touches
NORMAL = 2  # which of the axes
TOWARDS = AXES + 3 * NORMAL  # where it is


@compiled
def axes(row, tangent, normal):
    """Write the axes (9,) [1] of a contact with a normal, the first along the track where it can be."""
    nx, ny, nz = normal
    u, v, w = tangent[0], tangent[1], 0.0
    across = u * nx + v * ny
    if abs(across) > 0.9:
        u, v, w, across = 0.0, 0.0, 1.0, nz
    u, v, w = u - across * nx, v - across * ny, w - across * nz
    size = 1.0 / math.sqrt(u * u + v * v + w * w)
    u, v, w = u * size, v * size, w * size
    row[AXES], row[AXES + 1], row[AXES + 2] = u, v, w
    row[AXES + 3], row[AXES + 4], row[AXES + 5] = ny * w - nz * v, nz * u - nx * w, nx * v - ny * u
    row[AXES + 6], row[AXES + 7], row[AXES + 8] = nx, ny, nz


@compiled
def levers(row, turn, inertia, spot):
    """Write the levers [L] of a contact at a spot (3,) [L] in body axes, its rates [1/L] and masses [1]."""
    x, y, z = spot
    for e in range(3):
        u, v, w = row[AXES + 3 * e], row[AXES + 3 * e + 1], row[AXES + 3 * e + 2]
        a = turn[0] * u + turn[3] * v + turn[6] * w
        b = turn[1] * u + turn[4] * v + turn[7] * w
        c = turn[2] * u + turn[5] * v + turn[8] * w
        k = LEVER + 3 * e
        row[k], row[k + 1], row[k + 2] = y * c - z * b, z * a - x * c, x * b - y * a
    rates(inertia, row)
    masses(row)


@compiled
def put(crowd, n, solid, spot, normal, gap, rub, key):
    """Add a contact of part n at a spot (3,) [L] in its axes, with a normal (3,) [1] in the bowl's frame."""
    count = crowd.counts[n]
    if count >= crowd.rows.shape[1]:
        return
    row = crowd.rows[n, count]
    row[TOWARDS], row[TOWARDS + 1], row[TOWARDS + 2] = normal
    row[GAP], row[RUB], row[KEY] = gap, rub, key
    row[SPOT], row[SPOT + 1], row[SPOT + 2] = spot
    _filled(row, crowd.tangents[n], crowd.turns[n], solid.inertia)
    crowd.counts[n] = count + 1


@apart
def _filled(row, tangent, turn, inertia):
    """Write axes, levers, rates and masses of a contact with its normal and spot."""
    axes(row, tangent, (row[TOWARDS], row[TOWARDS + 1], row[TOWARDS + 2]))
    levers(row, turn, inertia, (row[SPOT], row[SPOT + 1], row[SPOT + 2]))


@compiled
def speed(state, row, e):
    """Return the velocity [sqrt(g L)] of a contact, a row (WIDTH,), along its axis e."""
    a, k = AXES + 3 * e, LEVER + 3 * e
    found = row[a] * state[VX] + row[a + 1] * state[VX + 1] + row[a + 2] * state[VZ]
    return found + row[k] * state[W] + row[k + 1] * state[W + 1] + row[k + 2] * state[W + 2]


@compiled
def apart_by(states, crowd, k, e):
    """Return the velocity [sqrt(g L)] of a pair's first part against the second, along one of their axes."""
    first, second = states[crowd.owners[k]], states[crowd.owners[k + 1]]
    return speed(first, crowd.pairs[k], e) - speed(second, crowd.pairs[k + 1], e)


@compiled
def _speed(row, a, k, moves):
    """Velocity along the axis at ``a``, with levers at ``k``, from a body's velocities and rates (6,)."""
    u, v, w, p, q, r = moves
    along = row[a] * u + row[a + 1] * v + row[a + 2] * w
    return along + row[k] * p + row[k + 1] * q + row[k + 2] * r


@compiled
def _pushed(row, a, k, impulse, moves):
    """Velocities and rates (6,) of a body after an impulse along the axis at ``a``, with rates at ``k``."""
    u, v, w, p, q, r = moves
    u, v, w = u + row[a] * impulse, v + row[a + 1] * impulse, w + row[a + 2] * impulse
    return u, v, w, p + row[k] * impulse, q + row[k + 1] * impulse, r + row[k + 2] * impulse


@compiled
def _rubbing(ahead, aside, most):
    """Impulses along a contact, of the size that friction allows at most."""
    size = ahead * ahead + aside * aside
    scale = most / math.sqrt(size) if size > most * most else 1.0
    return scale * ahead, scale * aside


@compiled
def _relax(row, rough, moves):
    """One projected Gauss-Seidel step on a contact: velocities and rates (6,), its impulse's change."""
    x, y, z = row[IMPULSE], row[IMPULSE + 1], row[IMPULSE + 2]
    up = max(z + row[MASS + 2] * (row[WANTED] - _speed(row, TOWARDS, LEVER + 6, moves)), 0.0)
    moves = _pushed(row, TOWARDS, RATE + 6, up - z, moves)
    change = abs(up - z)
    if rough and (up > 0.0 or z > 0.0):
        ahead = x - row[MASS] * _speed(row, AXES, LEVER, moves)
        aside = y - row[MASS + 1] * _speed(row, AXES + 3, LEVER + 3, moves)
        ahead, aside = _rubbing(ahead, aside, up * (row[BACK] if ahead > 0.0 else row[AHEAD]))
        moves = _pushed(row, AXES, RATE, ahead - x, moves)
        moves = _pushed(row, AXES + 3, RATE + 3, aside - y, moves)
        row[IMPULSE], row[IMPULSE + 1] = ahead, aside
        change += abs(ahead - x) + abs(aside - y)
    row[IMPULSE + 2] = up
    return moves, change


@compiled
def _begun(state, rows, count, warm):
    """Begin with a share of the impulses that are in the rows."""
    for m in range(count):
        row = rows[m]
        for e in range(3):
            row[IMPULSE + e] *= warm
            impulse = row[IMPULSE + e]
            if impulse != 0.0:
                for k in range(3):
                    state[VX + k] += row[AXES + 3 * e + k] * impulse
                    state[W + k] += row[RATE + 3 * e + k] * impulse


@compiled
def _relax_part(state, rows, count, rough):
    """One step on all contacts of one part with the track; change and sum of their impulses."""
    change = size = 0.0
    moves = state[VX], state[VX + 1], state[VZ], state[W], state[W + 1], state[W + 2]
    for m in range(count):
        moves, more = _relax(rows[m], rough, moves)
        change += more
        size += rows[m, IMPULSE + 2]
    state[VX], state[VX + 1], state[VZ], state[W], state[W + 1], state[W + 2] = moves
    return change, size


@compiled
def _both(states, crowd, k, e, impulse):
    """Give both parts of a pair's contact an impulse along one of its axes, against each other."""
    for side in range(2):
        state, row = states[crowd.owners[k + side]], crowd.pairs[k + side]
        for m in range(3):
            state[VX + m] += impulse * row[AXES + 3 * e + m]
            state[W + m] += impulse * row[RATE + 3 * e + m]
        impulse = -impulse


@compiled
def _relax_pair(states, crowd, k, rough):
    """One step on a contact of two parts; the change of its impulse."""
    row = crowd.pairs[k]
    x, y, z = row[IMPULSE], row[IMPULSE + 1], row[IMPULSE + 2]
    up = max(z + row[MASS + 2] * (row[WANTED] - apart_by(states, crowd, k, NORMAL)), 0.0)
    _both(states, crowd, k, NORMAL, up - z)
    row[IMPULSE + 2] = up
    if not rough or (up == 0.0 and z == 0.0):
        return abs(up - z)
    ahead = x - row[MASS] * apart_by(states, crowd, k, 0)
    aside = y - row[MASS + 1] * apart_by(states, crowd, k, 1)
    ahead, aside = _rubbing(ahead, aside, row[AHEAD] * up)
    _both(states, crowd, k, 0, ahead - x)
    _both(states, crowd, k, 1, aside - y)
    row[IMPULSE], row[IMPULSE + 1] = ahead, aside
    return abs(up - z) + abs(ahead - x) + abs(aside - y)


@apart
def solve(surface, crowd, states, island, rough, warm):
    """Find impulses that let each contact of some parts leave at its wanted speed or faster.

    Parameters
    ----------
    surface : Surface
    crowd : Crowd
    states : (N, 13) float [L, sqrt(g L), 1, sqrt(g/L)]
        Whose velocities are changed.
    island : (int, int)
        From where to where in ``crowd.order`` those parts are.
    rough : bool
        With friction.
    warm : float [1]
        Times the impulses in the rows is begun with.
    """
    for m in range(island[0], island[1]):
        n = crowd.order[m]
        _begun(states[n], crowd.rows[n], crowd.counts[n], warm)
    pairs = crowd.paired[0]
    for k in range(0, pairs, 2):
        for e in range(3):
            crowd.pairs[k, IMPULSE + e] *= warm
            _both(states, crowd, k, e, crowd.pairs[k, IMPULSE + e])
    for _ in range(surface.sweeps):
        change = size = 0.0
        for m in range(island[0], island[1]):
            n = crowd.order[m]
            more, part = _relax_part(states[n], crowd.rows[n], crowd.counts[n], rough)
            change, size = change + more, size + part
        for k in range(0, pairs, 2):
            change += _relax_pair(states, crowd, k, rough)
            size += crowd.pairs[k, IMPULSE + 2]
        if change <= surface.converged * size:
            break


@compiled
def remembered(crowd, n):
    """Begin the contacts of a part with the impulses [sqrt(g L)] that they had a step before."""
    start = 0
    for m in range(crowd.counts[n]):
        row = crowd.rows[n, m]
        row[IMPULSE] = row[IMPULSE + 1] = row[IMPULSE + 2] = 0.0
        for k in range(start, crowd.knowns[n]):  # they come in nearly the same order
            if crowd.known[n, k, 0] == row[KEY]:
                for e in range(3):
                    row[IMPULSE + e] = crowd.known[n, k, 1 + e]
                start = k + 1
                break


@compiled
def remember(crowd, n):
    """Keep the impulses [sqrt(g L)] of a part's contacts for the next step."""
    crowd.knowns[n] = crowd.counts[n]
    for m in range(crowd.counts[n]):
        crowd.known[n, m, 0] = crowd.rows[n, m, KEY]
        for e in range(3):
            crowd.known[n, m, 1 + e] = crowd.rows[n, m, IMPULSE + e]
