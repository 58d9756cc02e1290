"""Compiled steps of parts that may touch each other, one or many: an island of them at a time."""

import math

from feederscrew.dropping.kernel import body
from feederscrew.dropping.kernel.body import VX, VY, VZ, W, X, Y
from feederscrew.dropping.kernel.floor_contacts import IMPULSE, WANTED
from feederscrew.geometry.compiled import apart, compiled
from feederscrew.trial.kernel import contact, pushes, track_leans
from feederscrew.trial.kernel.contact import GAP

REACH = 2e-3  # how far ahead contacts are looked for, beside the way of two steps
FREE = 1e-9  # work against gravity and the drive that is rounding, of one part alone, and ...
APART = 2e-6  # ... of parts that are pushed apart, by impulses that are not wholly converged
SLOP, TROUBLE = 3e-4, 6e-4  # depth that is left, and from which on it is made less
LIFT, MOST = 0.1, 0.01  # of a greater depth, taken back in a step; of so much at most
AT_ONCE = 0.02  # of a step: what happens sooner happens at its start
UPWARD = 0.5  # [1] of the normal: a part that is held so by another is carried
BEHIND, BELOW = 0, 1  # columns of the strains


@compiled
def ahead(solid, state, dt):
    """Return how far ahead [L] contacts of a part with a state (13,) are looked for in a step [sqrt(L/g)]."""
    quick = math.sqrt(state[VX] ** 2 + state[VY] ** 2 + state[VZ] ** 2) + solid.radius * body.rate(state)
    return REACH + 2.0 * dt * quick


@compiled
def ready(surface, crowd, island):
    """Note where and how an island's parts are as a step begins, and how the track leans there."""
    for m in range(island[0], island[1]):
        n = crowd.order[m]
        state = crowd.states[n]
        body.keep(state, crowd.before[n])
        body.rotation(state, crowd.turns[n])
        x, y = state[X], surface.radius - state[Y]
        off = math.sqrt(x * x + y * y)
        crowd.tangents[n, 0], crowd.tangents[n, 1] = y / off, x / off
        track_leans.lean_here(surface, crowd, n)


@compiled
def _moving(solid, crowd, island):
    whole = 0.0
    for m in range(island[0], island[1]):
        whole += body.moving_energy(crowd.states[crowd.order[m]], solid.inertia)
    return whole


@compiled
def _scaled(crowd, island, scale):
    """Scale the velocities of an island's parts."""
    for m in range(island[0], island[1]):
        for k in range(3):
            crowd.states[crowd.order[m], VX + k] *= scale
            crowd.states[crowd.order[m], W + k] *= scale


@compiled
def _no_more(solid, crowd, island, limit):
    """Scale all velocities so that the kinetic energy is at most ``limit``."""
    moving, limit = _moving(solid, crowd, island), max(limit, 0.0)
    if moving > limit:
        _scaled(crowd, island, math.sqrt(limit / moving))


@compiled
def _no_more_than_given(solid, crowd, island, late):
    """Scale all velocities so that a step wins no more than gravity, drive and jets give along its way.

    The way is that of the velocities after the step, by a share ``late`` [1], and of those before it.
    """
    moving, begun, by_end = 0.0, 0.0, 0.0
    for m in range(island[0], island[1]):
        n = crowd.order[m]
        start, end, given = crowd.before[n], crowd.states[n], crowd.given[n]
        moving += body.moving_energy(end, solid.inertia)
        begun += body.moving_energy(start, solid.inertia)
        for k in range(3):
            begun += (1.0 - late) * given[k] * start[VX + k]
            by_end += late * given[k] * end[VX + k]
            begun += 0.5 * given[3 + k] * solid.inertia[k] * crowd.free[n, k]
            by_end += 0.5 * given[3 + k] * solid.inertia[k] * end[W + k]
    if moving > max(begun + by_end, 0.0):
        scale = (by_end + math.sqrt(max(by_end**2 + 4.0 * moving * begun, 0.0))) / (2.0 * moving)
        _scaled(crowd, island, min(max(scale, 0.0), 1.0))


@compiled
def at_once(floor, dt):
    """Return the share [1] of a step ``dt`` [sqrt(L/g)] in which what happens, happens at its start."""
    return min(AT_ONCE * floor.step / dt, 1.0)


@apart
def pushed(surface, solid, floor, crowd, island, time, dt):
    """Compute velocities after a step: gravity, drive, jets and contacts.

    Returns
    -------
    depth of the deepest contact, whether one strikes, share of the step after which its course changes
    """
    deepest, first = pushes.wanted_of_pairs(surface, crowd, dt)
    count, warm, once = crowd.paired[0], 1.0, at_once(floor, dt)
    for m in range(island[0], island[1]):
        n = crowd.order[m]
        state = crowd.states[n]
        body.turn_freely(state, solid.inertia, dt)
        pushes.give(surface, solid, floor, crowd, n, time, dt)
        for k in range(3):
            state[VX + k] += crowd.given[n, k]
            crowd.free[n, k] = state[W + k]
            state[W + k] += crowd.given[n, 3 + k]
        depth, share = pushes.wanted(surface, crowd, n, dt)
        deepest, first = min(deepest, depth), min(first, share)
        count += crowd.counts[n]
        warm = dt / crowd.lasted[n] if warm > 0.0 and crowd.lasted[n] > 0.0 else 0.0
    strikes, share = first <= 1.0, min(first, 1.0)
    if count == 0 or (strikes and share > once):
        return deepest, strikes, share
    if strikes:
        pushes.rebounds_of_pairs(surface, crowd, dt)
        for m in range(island[0], island[1]):
            pushes.rebounds(surface, crowd, crowd.order[m], dt, once)
    contact.solve(surface, crowd, crowd.states, island, True, 0.0 if strikes else warm)
    share = 1.0
    for m in range(island[0], island[1]):
        n = crowd.order[m]
        crowd.lasted[n] = -1.0 if strikes else dt
        turned = pushes.reversal(crowd, n)
        share = min(share, turned) if turned > once else share
    _no_more_than_given(solid, crowd, island, 1.0 if strikes else 0.5)
    if strikes:
        for m in range(island[0], island[1]):
            share = min(share, max(once, pushes.next_strike(crowd, crowd.order[m], dt)))
    return deepest, strikes, share


@apart
def lift(surface, solid, crowd, island, dt):
    """Take a part of what is too deep [L] back, without a speed, as far as the motion can pay for it."""
    push, cost = crowd.push, 0.0
    for m in range(island[0], island[1]):
        n = crowd.order[m]
        for k in range(body.STATE):
            push[n, k] = 0.0
        for k in range(crowd.counts[n]):
            crowd.rows[n, k, WANTED] = LIFT * min(max(-crowd.rows[n, k, GAP] - SLOP, 0.0), MOST)
    for k in range(0, crowd.paired[0], 2):
        crowd.pairs[k, WANTED] = LIFT * min(max(-crowd.pairs[k, GAP] - SLOP, 0.0), MOST)
    contact.solve(surface, crowd, push, island, False, 0.0)
    for m in range(island[0], island[1]):
        n = crowd.order[m]
        for k in range(3):
            cost -= crowd.given[n, k] * push[n, VX + k] / dt
    moving, cost = _moving(solid, crowd, island), max(cost, 0.0)
    free = APART if crowd.paired[0] else FREE
    share = moving / cost if cost > moving + free else 1.0
    for m in range(island[0], island[1]):
        n = crowd.order[m]
        for k in range(3):
            crowd.states[n, k] += share * push[n, VX + k]
        body.rotate(crowd.states[n], push[n, W], push[n, W + 1], push[n, W + 2], share)
    _no_more(solid, crowd, island, moving - share * cost)


@compiled
def _moved(crowd, n, share, dt):
    """Move a part by its velocities: a share of those after the step, the rest of those before it."""
    state, saved = crowd.states[n], crowd.before[n]
    for k in range(3):
        state[k] += dt * (share * state[VX + k] + (1.0 - share) * saved[VX + k])
    p = share * state[W] + (1.0 - share) * saved[W]
    q = share * state[W + 1] + (1.0 - share) * saved[W + 1]
    r = share * state[W + 2] + (1.0 - share) * saved[W + 2]
    body.rotate(state, p, q, r, dt)


@compiled
def _strained(crowd):
    """Add up what parts push each other along the track, and what they carry of each other."""
    for k in range(0, crowd.paired[0], 2):
        row, impulse = crowd.pairs[k], crowd.pairs[k, IMPULSE + 2]
        i, j = crowd.owners[k], crowd.owners[k + 1]
        towards = contact.TOWARDS
        along = crowd.tangents[i, 0] * row[towards] + crowd.tangents[i, 1] * row[towards + 1]
        crowd.strains[i, BEHIND] += max(along, 0.0) * impulse
        crowd.strains[j, BEHIND] += max(-along, 0.0) * impulse
        if abs(row[towards + 2]) > UPWARD:
            crowd.strains[i if row[towards + 2] > 0.0 else j, BELOW] += impulse


@compiled
def moved(crowd, island, share, dt):
    """Move an island's parts by their velocities, a share of those after the step; keep their impulses."""
    for m in range(island[0], island[1]):
        n = crowd.order[m]
        contact.remember(crowd, n)
        _moved(crowd, n, share, dt)
    _strained(crowd)


@compiled
def back(crowd, island):
    """Take an island's parts back to where and how they were at the start of a step."""
    for m in range(island[0], island[1]):
        body.keep(crowd.before[crowd.order[m]], crowd.states[crowd.order[m]])


@compiled
def unpaid(solid, crowd, island, taken):
    """Return the change of the energy over mass [g L] in a step, less the work of gravity, drive and jets.

    Both in the bowl's frame, in which the drive is a force.
    """
    found = 0.0
    for m in range(island[0], island[1]):
        n = crowd.order[m]
        start, end, given = crowd.before[n], crowd.states[n], crowd.given[n]
        found += body.moving_energy(end, solid.inertia) - body.moving_energy(start, solid.inertia)
        for k in range(3):
            found -= given[k] * (end[k] - start[k]) / taken
            found -= given[3 + k] * solid.inertia[k] * 0.5 * (crowd.free[n, k] + end[W + k])
    return found
