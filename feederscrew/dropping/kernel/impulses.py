"""Compiled impulses of all contacts together: at impacts, and in steps on the floor."""

import math

from feederscrew.dropping.kernel.body import VX, VZ, W, energy, keep
from feederscrew.dropping.kernel.floor_contacts import (
    CHANGE,
    IMPULSE,
    LAST,
    LEVER,
    MASS,
    RATE,
    WANTED,
    WIDTH,
    coupling,
    masses,
    push,
    speed,
)
from feederscrew.dropping.kernel.slipping import slide
from feederscrew.geometry.compiled import apart, compiled

EVERY = 6  # sweeps from one leap to the next
STRAIGHT = 0.95**2  # squared cosine between two changes that lead the same way
FURTHEST = 1000.0  # a leap, in changes of a sweep


@compiled
def stick(state, row, friction):
    """Hold one contact, a row (WIDTH,), still by an impulse [sqrt(g L)]; return whether friction can."""
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
    """Return the velocity [sqrt(g L)] of contact n: of the centre, and of the rates on the lever at k.

    Source: v + w x r of a rigid body.
    """
    return v + c[n, k] * p + c[n, k + 1] * q + c[n, k + 2] * r


@compiled
def spun(c, n, k, impulse, p, q, r):
    """Return the rates [sqrt(g/L)] after an impulse [sqrt(g L)] along the axis whose RATE column is k.

    Source: I w = r x p of a rigid body.
    """
    return p + c[n, k] * impulse, q + c[n, k + 1] * impulse, r + c[n, k + 2] * impulse


@compiled
def relax(c, n, friction, moves):
    """Do one projected Gauss-Seidel step on contact n; return velocities [sqrt(g L)] and rates (6,)."""
    u, v, w, p, q, r = moves
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
    return u, v, w, p, q, r


@compiled
def noted(contacts, count):
    """Keep what the last sweep changed of impulses [sqrt(g L)] of contacts (N, WIDTH), and the impulses."""
    for n in range(count):
        for e in range(3):
            contacts[n, CHANGE + e] = contacts[n, IMPULSE + e] - contacts[n, LAST + e]
            contacts[n, LAST + e] = contacts[n, IMPULSE + e]


@compiled
def leap(contacts, count):
    """Return how often [1] the last sweep's change may be repeated before a contact pulls; 0 for never.

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


@apart
def solve(state, contacts, count, friction, sweeps, converged):
    """Give contacts (N, WIDTH) impulses [sqrt(g L)] with Coulomb friction: they leave as wanted or faster.

    One or two contacts directly where that goes; else swept from the impulses that the contacts hold, until
    a whole sweep changes the body's velocities by no more than ``converged`` of what presses it: between many
    contacts impulses may creep on for long.
    """
    if count == 1 and stick(state, contacts[0], friction):
        return
    if count > 2 or not slide(state, contacts, count, friction, converged):
        sweep(state, contacts, count, friction, sweeps, converged)


@compiled
def sweep(state, contacts, count, friction, sweeps, converged):
    """Give contacts (N, WIDTH) impulses [sqrt(g L)] by projected Gauss-Seidel sweeps, from what they hold."""
    for n in range(count):
        masses(contacts[n])
        for e in range(3):
            push(state, contacts[n], e, contacts[n, IMPULSE + e])
    u, v, w = state[VX], state[VX + 1], state[VZ]
    p, q, r = state[W], state[W + 1], state[W + 2]
    for turn in range(sweeps):
        if turn % EVERY >= EVERY - 2:
            noted(contacts, count)
        state[VX], state[VX + 1], state[VZ] = u, v, w
        state[W], state[W + 1], state[W + 2] = p, q, r
        size = 0.0
        for n in range(count):
            u, v, w, p, q, r = relax(contacts, n, friction, (u, v, w, p, q, r))
            size += contacts[n, IMPULSE + 2]
        change = abs(u - state[VX]) + abs(v - state[VX + 1]) + abs(w - state[VZ])
        change += abs(p - state[W]) + abs(q - state[W + 1]) + abs(r - state[W + 2])
        if change <= converged * size:
            break
        if turn % EVERY == EVERY - 1:
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
    """Do an impact: contacts (N, WIDTH) that approach faster than the threshold [sqrt(g L)] rebound."""
    before = energy(state, inertia)
    keep(state, saved)
    for trial in range(4):
        bounce = restitution * (1.0 - trial / 3.0)  # less where friction would make Newton's rule win energy
        for n in range(count):
            row = contacts[n]
            fall = speed(state, row, 2)
            row[WANTED] = -bounce * fall if fall < -steps.threshold else 0.0
            row[IMPULSE] = row[IMPULSE + 1] = row[IMPULSE + 2] = 0.0
        solve(state, contacts, count, friction, steps.sweeps, steps.converged)
        if energy(state, inertia) <= before + 1e-12:
            return
        keep(saved, state)


@compiled
def steepest(state, contacts, count):
    """Return the upward speed [sqrt(g L)] of that of the contacts (N, WIDTH) which falls fastest."""
    fall = math.inf
    for n in range(count):
        fall = min(fall, speed(state, contacts[n], 2))
    return fall


@compiled
def hold(state, contacts, count, friction, steps, share):
    """Give contacts (N, WIDTH) impulses [sqrt(g L)] that let nothing fall further, without rebound."""
    for n in range(count):
        contacts[n, WANTED] = 0.0
        for k in range(IMPULSE, LAST):
            contacts[n, k] *= share
        for k in range(LAST, WIDTH):
            contacts[n, k] = 0.0
    solve(state, contacts, count, friction, steps.sweeps, steps.converged)
