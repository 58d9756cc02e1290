"""Compiled steps of several parts on one track, which push, lift and carry each other.

As `trial.kernel.motion`, with the contacts of all parts solved together: those with the track by one part's
velocity, those between parts by the difference of two.
"""

import math
from typing import NamedTuple

import numpy as np

from feederscrew.dropping.kernel import body
from feederscrew.dropping.kernel.body import VX, VZ, W
from feederscrew.dropping.kernel.floor_contacts import IMPULSE
from feederscrew.geometry.compiled import compiled, entry
from feederscrew.trial.kernel import between, contact, motion
from feederscrew.trial.kernel.contact import GAP, TOWARDS
from feederscrew.trial.kernel.pairs import corners_on, edges_on

UPWARD = 0.5  # [1] of the normal: a part that is held so by another is carried
BEHIND, BELOW = 0, 1  # columns of the strains


class OnePart(NamedTuple):
    """One part of a crowd, as the kernel of single parts takes it."""

    state: np.ndarray
    saved: np.ndarray
    contacts: np.ndarray
    turn: np.ndarray


@compiled
def _one(crowd, n):
    return OnePart(crowd.states[n], crowd.before[n], crowd.rows[n], crowd.turns[n])


@compiled
def _copied(source, target, count):
    for n in range(count):
        for k in range(source.shape[1]):
            target[n, k] = source[n, k]


@compiled
def _forgotten(rows, count):
    for n in range(count):
        rows[n, IMPULSE] = rows[n, IMPULSE + 1] = rows[n, IMPULSE + 2] = 0.0


@compiled
def met(surface, solid, crowd, work, active, dt):
    """Find the contacts of parts with the track and with each other; how many rows the latter have."""
    reach = motion.REACH
    for n in range(len(crowd.states)):
        crowd.counts[n] = 0
        if not active[n]:
            continue
        state = crowd.states[n]
        body.keep(state, crowd.before[n])
        body.keep(state, work.state)
        body.rotation(state, work.turn)
        for k in range(9):
            crowd.turns[n, k] = work.turn[k]
        quick = math.sqrt(state[VX] ** 2 + state[VX + 1] ** 2 + state[VZ] ** 2)
        own = motion.REACH + 2.0 * dt * (quick + solid.radius * body.rate(state))
        reach = max(reach, own)
        count = motion.found(surface, solid, work, own)
        crowd.counts[n] = count
        _copied(work.contacts, crowd.rows[n], count)
    return _each_other(surface, solid, crowd, active, reach)


@compiled
def _each_other(surface, solid, crowd, active, reach):
    count = 0
    far = (2.0 * solid.radius + reach) ** 2
    for i in range(len(crowd.states)):
        x, y = crowd.states[i, 0], surface.radius - crowd.states[i, 1]
        crowd.tangent[0], crowd.tangent[1] = y / math.sqrt(x * x + y * y), x / math.sqrt(x * x + y * y)
        for j in range(i):
            if active[i] and active[j]:
                square = 0.0
                for e in range(3):
                    square += (crowd.states[i, e] - crowd.states[j, e]) ** 2
                if square < far:
                    count = corners_on(crowd, solid, i, j, reach, count)
                    count = edges_on(crowd, solid, i, j, reach, count)
                    count = corners_on(crowd, solid, j, i, reach, count)
    return count


@compiled
def _relax_part(crowd, n):
    """One step on all contacts of one part with the track; change and sum of their impulses."""
    state, change, size = crowd.states[n], 0.0, 0.0
    u, v, w = state[VX], state[VX + 1], state[VZ]
    p, q, r = state[W], state[W + 1], state[W + 2]
    for m in range(crowd.counts[n]):
        u, v, w, p, q, r, more = contact._relax(crowd.rows[n, m], True, u, v, w, p, q, r)
        change += more
        size += crowd.rows[n, m, IMPULSE + 2]
    state[VX], state[VX + 1], state[VZ] = u, v, w
    state[W], state[W + 1], state[W + 2] = p, q, r
    return change, size


@compiled
def solve(surface, crowd, pairs):
    """Find contact impulses of all parts together."""
    for n in range(len(crowd.states)):
        _forgotten(crowd.rows[n], crowd.counts[n])
    _forgotten(crowd.pairs, pairs)
    for _ in range(surface.sweeps):
        change = size = 0.0
        for n in range(len(crowd.states)):
            more, part = _relax_part(crowd, n)
            change, size = change + more, size + part
        for k in range(0, pairs, 2):
            change += between.relax(crowd, k)
            size += crowd.pairs[k, IMPULSE + 2]
        if change <= surface.converged * size:
            break


@compiled
def _moving(crowd, solid, active):
    whole = 0.0
    for n in range(len(crowd.states)):
        if active[n]:
            whole += body.moving_energy(crowd.states[n], solid.inertia)
    return whole


@compiled
def pushed(surface, solid, floor, crowd, work, active, time, dt, pairs):
    """Compute velocities after a step; deepest contact, share of the step after which a part turns round."""
    deepest, share = 0.0, 1.0
    for n in range(len(crowd.states)):
        if not active[n]:
            continue
        one = _one(crowd, n)
        body.turn_freely(one.state, solid.inertia, dt)
        motion.pull(surface, floor, time, dt, one)
        if crowd.counts[n]:
            depth, _, _ = motion.wanted(surface, one, crowd.counts[n], dt)
            deepest = min(deepest, depth)
    deepest = min(deepest, between.wanted(surface, crowd, pairs, dt))
    limit = _moving(crowd, solid, active)
    solve(surface, crowd, pairs)
    for n in range(len(crowd.states)):
        if active[n] and crowd.counts[n]:
            share = min(share, max(motion.reversal(_one(crowd, n), crowd.counts[n]), motion.AT_ONCE))
    moving = _moving(crowd, solid, active)
    if moving > limit:
        for n in range(len(crowd.states)):
            for k in range(3):
                crowd.states[n, VX + k] *= math.sqrt(limit / moving)
                crowd.states[n, W + k] *= math.sqrt(limit / moving)
    return deepest, share


@compiled
def step(surface, solid, floor, crowd, work, active, time, dt):
    """Take one step of all parts, or the share of it after which the sliding of one turns round.

    Returns
    -------
    depth of the deepest contact, time taken
    """
    pairs = met(surface, solid, crowd, work, active, dt)
    deepest, share = pushed(surface, solid, floor, crowd, work, active, time, dt, pairs)
    if motion.AT_ONCE < share < 1.0 - motion.AT_ONCE:
        dt *= share
        for n in range(len(crowd.states)):
            body.keep(crowd.before[n], crowd.states[n])
        deepest, _ = pushed(surface, solid, floor, crowd, work, active, time, dt, pairs)
    for n in range(len(crowd.states)):
        if active[n]:
            _moved(surface, solid, floor, crowd, work, n, time, dt)
    _strained(surface, crowd, pairs)
    _parted(crowd, pairs)
    return deepest, dt


@compiled
def _moved(surface, solid, floor, crowd, work, n, time, dt):
    """Move one part by the mean of its velocities, and take it out of what it is too deep in."""
    state, saved = crowd.states[n], crowd.before[n]
    for k in range(3):
        state[k] += 0.5 * dt * (state[VX + k] + saved[VX + k])
    body.rotate(
        state, 0.5 * (state[W] + saved[W]), 0.5 * (state[W + 1] + saved[W + 1]),
        0.5 * (state[W + 2] + saved[W + 2]), dt,
    )  # fmt: skip
    depth = 0.0
    for m in range(crowd.counts[n]):
        depth = min(depth, crowd.rows[n, m, GAP])
    if depth < -motion.SLOP:
        body.keep(state, work.state)
        body.keep(saved, work.saved)
        _copied(crowd.rows[n], work.contacts, crowd.counts[n])
        motion.lift(surface, solid, floor, work, time, dt, crowd.counts[n])
        body.keep(work.state, state)


@compiled
def _parted(crowd, pairs):
    """Move parts that are too deep in each other apart by a share of it, along their deepest contact."""
    worst = 0
    for k in range(0, pairs, 2):
        i, j = crowd.owners[k], crowd.owners[k + 1]
        worst = k if crowd.pairs[k, GAP] < crowd.pairs[worst, GAP] else worst
        last = k + 2 >= pairs or crowd.owners[k + 2] + crowd.owners[k + 3] != i + j
        if last or abs(crowd.owners[k + 2] - crowd.owners[k + 3]) != abs(i - j):
            row = crowd.pairs[worst]
            by = 0.5 * motion.LIFT * min(max(-row[GAP] - motion.SLOP, 0.0), motion.MOST)
            for e in range(3):
                crowd.states[crowd.owners[worst], e] += by * row[TOWARDS + e]
                crowd.states[crowd.owners[worst + 1], e] -= by * row[TOWARDS + e]
            worst = k + 2


@compiled
def _strained(surface, crowd, pairs):
    """Add up what parts push each other along the track, and what they carry of each other."""
    for k in range(0, pairs, 2):
        row, impulse = crowd.pairs[k], crowd.pairs[k, IMPULSE + 2]
        i, j = crowd.owners[k], crowd.owners[k + 1]
        x, y = crowd.states[i, 0], surface.radius - crowd.states[i, 1]
        along = (y * row[TOWARDS] + x * row[TOWARDS + 1]) / math.sqrt(x * x + y * y)
        crowd.strains[i, BEHIND] += max(along, 0.0) * impulse
        crowd.strains[j, BEHIND] += max(-along, 0.0) * impulse
        if abs(row[TOWARDS + 2]) > UPWARD:
            crowd.strains[i if row[TOWARDS + 2] > 0.0 else j, BELOW] += impulse


@entry
def follow(surface, solid, floor, crowd, work, active, time, steps):
    """Move all parts for so many steps of the floor; the greatest depth. ``crowd.strains`` is filled."""
    for n in range(len(crowd.states)):
        crowd.strains[n, BEHIND] = crowd.strains[n, BELOW] = 0.0
    sunk = 0.0
    for k in range(steps):
        rest = floor.step
        while rest > 1e-6 * floor.step:
            now = time + (k + 1) * floor.step - rest
            deepest, taken = step(surface, solid, floor, crowd, work, active, now, rest)
            sunk, rest = min(sunk, deepest), rest - taken
    return -sunk
