"""Compiled contact of one body with the floor: the impulses at the points that touch.

A contact is a row of WIDTH numbers. Along floor axis e (x, y, z in turn) it holds the lever p x e in body
axes, from point p; the rates one unit of impulse along e gives, lever / inertia; its effective mass, of
both axes in the plane the smaller that serves both; then the upward speed wanted after the impulse; then
the impulse itself, (x, y, z), what it was a sweep ago, and what the sweep before that changed of it.
"""

import math

from feederscrew.dropping.kernel import body
from feederscrew.dropping.kernel.body import VX, VZ, W, energy, keep
from feederscrew.dropping.kernel.touch import CORNER, lowest_on
from feederscrew.geometry.compiled import compiled

LEVER, RATE, MASS, WANTED, IMPULSE, LAST, CHANGE, WIDTH = 0, 9, 18, 21, 22, 25, 28, 31
EVERY = 6  # sweeps from one leap to the next
STRAIGHT = 0.95**2  # squared cosine between two changes that lead the same way
FURTHEST = 1000.0  # a leap, in changes of a sweep


@compiled
def levers(inertia, work, count):
    """Fill the rows of ``work.contacts`` for the points found, where they are."""
    for n in range(count):
        arm(work.turn, work.spots[n], work.contacts[n])
        rates(inertia, work.contacts[n])
        masses(work.contacts[n])


@compiled
def levers_ahead(solid, work, count, dt):
    """Fill the rows for a step: impulses act half of it ahead, and speeds are wanted at its end.

    A rim's lowest point travels around it meanwhile.
    """
    body.keep(work.state, work.ahead)
    for half in range(2):
        p, q, r = work.ahead[W], work.ahead[W + 1], work.ahead[W + 2]
        body.rotate(work.ahead, p, q, r, 0.5 * dt)
        body.rotation(work.ahead, work.later)
        for n in range(count):
            spot, k = work.spots[n], work.owners[n]
            if k != CORNER:
                x, y, z, _ = lowest_on(solid.rims, k, work.later)
                rim = solid.rims[k]
                if rim[10] < -1.0 or x * rim[7] + y * rim[8] + z * rim[9] >= rim[10]:
                    spot[0], spot[1] = rim[0] + rim[6] * x, rim[1] + rim[6] * y
                    spot[2] = rim[2] + rim[6] * z
            arm(work.later, spot, work.contacts[n])
            if half == 0:
                rates(solid.inertia, work.contacts[n])
            else:
                masses(work.contacts[n])


@compiled
def arm(turn, spot, row):
    """Fill the levers of a contact."""
    for e in range(3):
        x, y, z = turn[3 * e], turn[3 * e + 1], turn[3 * e + 2]
        k = LEVER + 3 * e
        row[k], row[k + 1] = spot[1] * z - spot[2] * y, spot[2] * x - spot[0] * z
        row[k + 2] = spot[0] * y - spot[1] * x


@compiled
def rates(inertia, row):
    """Fill the rates of a contact from its levers."""
    for k in range(9):
        row[RATE + k] = row[LEVER + k] / inertia[k % 3]


@compiled
def masses(row):
    """Fill the effective masses of a contact from its levers and rates."""
    xx, yy, zz = 1.0 + coupling(row, 0, 0), 1.0 + coupling(row, 1, 1), 1.0 + coupling(row, 2, 2)
    lean, mean, cross = 0.5 * (xx - yy), 0.5 * (xx + yy), coupling(row, 0, 1)
    row[MASS] = row[MASS + 1] = 1.0 / (mean + math.sqrt(lean * lean + cross * cross))
    row[MASS + 2] = 1.0 / zz


@compiled
def speed(state, row, e):
    """Velocity of a contact along floor axis e."""
    k = LEVER + 3 * e
    return state[VX + e] + row[k] * state[W] + row[k + 1] * state[W + 1] + row[k + 2] * state[W + 2]


@compiled
def push(state, row, e, impulse):
    """Add an impulse to a contact along floor axis e."""
    k = RATE + 3 * e
    state[VX + e] += impulse
    state[W] += row[k] * impulse
    state[W + 1] += row[k + 1] * impulse
    state[W + 2] += row[k + 2] * impulse
    row[IMPULSE + e] += impulse


@compiled
def coupling(row, d, e):
    """Velocity along floor axis d that one unit of impulse along e gives, of the rotation alone."""
    i, j = LEVER + 3 * d, RATE + 3 * e
    return row[i] * row[j] + row[i + 1] * row[j + 1] + row[i + 2] * row[j + 2]


@compiled
def stick(state, row, friction):
    """Impulse that holds a single contact still, if friction can; returns whether it was given."""
    u, v, w = -speed(state, row, 0), -speed(state, row, 1), row[WANTED] - speed(state, row, 2)
    xx, yy, zz = 1.0 + coupling(row, 0, 0), 1.0 + coupling(row, 1, 1), 1.0 + coupling(row, 2, 2)
    xy, xz, yz = coupling(row, 0, 1), coupling(row, 0, 2), coupling(row, 1, 2)
    yx, zx, zy = coupling(row, 1, 0), coupling(row, 2, 0), coupling(row, 2, 1)
    a, b, c = yy * zz - yz * zy, yz * zx - yx * zz, yx * zy - yy * zx
    whole = xx * a + xy * b + xz * c
    along = (a * u + (xz * zy - xy * zz) * v + (xy * yz - xz * yy) * w) / whole
    across = (b * u + (xx * zz - xz * zx) * v + (xz * yx - xx * yz) * w) / whole
    up = (c * u + (xy * zx - xx * zy) * v + (xx * yy - xy * yx) * w) / whole
    most = friction * up
    holds = up >= 0.0 and along * along + across * across <= most * most
    if holds:
        push(state, row, 0, along)
        push(state, row, 1, across)
        push(state, row, 2, up)
    return holds


@compiled
def along(c, n, k, v, p, q, r):
    """Velocity of contact n along one axis: of the centre there, and of the rates on the lever at k."""
    return v + c[n, k] * p + c[n, k + 1] * q + c[n, k + 2] * r


@compiled
def spun(c, n, k, impulse, p, q, r):
    """Rates after an impulse along the axis whose RATE column is k."""
    return p + c[n, k] * impulse, q + c[n, k + 1] * impulse, r + c[n, k + 2] * impulse


@compiled
def relax(c, n, friction, u, v, w, p, q, r):
    """One projected Gauss-Seidel step on contact n: velocities, rates and the change of its impulse."""
    x, y, z = c[n, IMPULSE], c[n, IMPULSE + 1], c[n, IMPULSE + 2]
    up = max(z + c[n, MASS + 2] * (c[n, WANTED] - along(c, n, LEVER + 6, w, p, q, r)), 0.0)
    w += up - z
    p, q, r = spun(c, n, RATE + 6, up - z, p, q, r)
    ahead = x - c[n, MASS] * along(c, n, LEVER, u, p, q, r)
    aside = y - c[n, MASS + 1] * along(c, n, LEVER + 3, v, p, q, r)
    size, most = ahead * ahead + aside * aside, friction * up
    if size > most * most:
        scale = most / math.sqrt(size)
        ahead, aside = scale * ahead, scale * aside
    u += ahead - x
    p, q, r = spun(c, n, RATE, ahead - x, p, q, r)
    v += aside - y
    p, q, r = spun(c, n, RATE + 3, aside - y, p, q, r)
    c[n, IMPULSE], c[n, IMPULSE + 1], c[n, IMPULSE + 2] = ahead, aside, up
    return u, v, w, p, q, r, abs(up - z) + abs(ahead - x) + abs(aside - y)


@compiled
def noted(contacts, count):
    """Keep what the last sweep changed of the impulses, and the impulses themselves."""
    for n in range(count):
        for e in range(3):
            contacts[n, CHANGE + e] = contacts[n, IMPULSE + e] - contacts[n, LAST + e]
            contacts[n, LAST + e] = contacts[n, IMPULSE + e]


@compiled
def leap(contacts, count):
    """How often the last sweep's change may be repeated at once, as no contact comes to pull; 0 for never.

    Two sweeps that change the impulses the same way tell the rest of the geometric series (Aitken). Of two
    corners side by side the impulse creeps from one to the other, by as much in every sweep.
    """
    both = before = now = 0.0
    most = FURTHEST
    for n in range(count):
        for e in range(3):
            change = contacts[n, IMPULSE + e] - contacts[n, LAST + e]
            last = contacts[n, CHANGE + e]
            both += change * last
            before += last * last
            now += change * change
        if change < 0.0:
            most = min(most, -contacts[n, IMPULSE + 2] / change)
    if both <= 0.0 or both * both < STRAIGHT * before * now:
        return 0.0
    return min(most, both / (before - both)) if both < before else most


@compiled
def solve(state, contacts, count, friction, steps):
    """Contact impulses with Coulomb friction: each contact leaves at its wanted speed or faster.

    Swept until a whole sweep changes the impulses by no more than ``steps.converged`` of their sum.
    """
    if count == 1 and stick(state, contacts[0], friction):
        return
    u, v, w = state[VX], state[VX + 1], state[VZ]
    p, q, r = state[W], state[W + 1], state[W + 2]
    for sweep in range(steps.sweeps):
        if sweep % EVERY >= EVERY - 2:
            noted(contacts, count)
        state[VX], state[VX + 1], state[VZ] = u, v, w
        state[W], state[W + 1], state[W + 2] = p, q, r
        change = size = 0.0
        for n in range(count):
            u, v, w, p, q, r, more = relax(contacts, n, friction, u, v, w, p, q, r)
            change += more
            size += contacts[n, IMPULSE + 2]
        if change <= steps.converged * size:
            break
        if sweep % EVERY == EVERY - 1:
            on = leap(contacts, count)
            for n in range(count):
                for k in range(IMPULSE, LAST):
                    contacts[n, k] += on * (contacts[n, k] - contacts[n, k + 3])
            u, v, w = u + on * (u - state[VX]), v + on * (v - state[VX + 1]), w + on * (w - state[VZ])
            p, q = p + on * (p - state[W]), q + on * (q - state[W + 1])
            r += on * (r - state[W + 2])
    state[VX], state[VX + 1], state[VZ] = u, v, w
    state[W], state[W + 1], state[W + 2] = p, q, r


@compiled
def strike(inertia, state, saved, contacts, count, restitution, friction, steps):
    """Impact: corners that approach faster than the threshold rebound; energy is never won."""
    before = energy(state, inertia)
    keep(state, saved)
    for trial in range(4):
        bounce = restitution * (1.0 - trial / 3.0)  # less where friction would make Newton's rule win energy
        for n in range(count):
            row = contacts[n]
            fall = speed(state, row, 2)
            row[WANTED] = -bounce * fall if fall < -steps.threshold else 0.0
            row[IMPULSE] = row[IMPULSE + 1] = row[IMPULSE + 2] = 0.0
        solve(state, contacts, count, friction, steps)
        if energy(state, inertia) <= before + 1e-12:
            return
        keep(saved, state)


@compiled
def steepest(state, contacts, count):
    """Upward speed of the contact that falls fastest."""
    fall = math.inf
    for n in range(count):
        fall = min(fall, speed(state, contacts[n], 2))
    return fall


@compiled
def hold(state, contacts, count, friction, steps):
    """Contact impulses that let nothing fall further, without rebound."""
    for n in range(count):
        for k in range(WANTED, WIDTH):
            contacts[n, k] = 0.0
    solve(state, contacts, count, friction, steps)
