"""Compiled way of parts along a stretch of track: one until it is done with it, or many for some time."""

import math

from feederscrew.dropping.kernel import body
from feederscrew.dropping.kernel.body import VX, VY, X, Y, Z
from feederscrew.geometry.compiled import apart, compiled, entry
from feederscrew.trial.kernel import jets, motion, pairs
from feederscrew.trial.kernel.crowd_records import REACHES

RUNNING, PASSED, RETURNED, STANDS, ROLLED = range(5)  # STANDS gets on no more, ROLLED went back
TIME, MOVED, SUNK, WON, NOTES = 0, 1, 2, 3, 4  # what a run notes: time, way, depth, energy; how many
BACKWARDS = 5.0  # times as far as a part must get on: so far back in that time it rolls back
LEFT = 1e-6  # of a step: less is nothing


@compiled
def way(surface, state):
    """Return how far along the wall [L] the centre of mass of a state (13,) is."""
    return surface.radius * math.atan2(state[X], surface.radius - state[Y])


@compiled
def across(surface, state):
    """Return how far from the wall [L] the centre of mass of a state (13,) is, anywhere round the bowl."""
    x, y = state[X], surface.radius - state[Y]
    return surface.radius - math.sqrt(x * x + y * y)


@compiled
def slides_to(surface, state):
    """Return how far from the wall [L] a part (13,) gets that slides on as it is until friction stops it.

    What was blown off may come past the end of a stretch before it is beyond the free edge.
    """
    x, y = state[X], surface.radius - state[Y]
    outwards = (state[VY] * y - state[VX] * x) / math.sqrt(x * x + y * y)
    return across(surface, state) + 0.5 * max(outwards, 0.0) ** 2 / max(surface.friction[1], LEFT)


@apart
def over(surface, solid, floor, crowd, island, time, notes):
    """Move an island's parts through a step of the floor; ``notes`` gets depth [L] and energy [g L]."""
    rest = floor.step
    while rest > LEFT * floor.step:
        now = time + floor.step - rest
        deepest, taken = motion.step(surface, solid, floor, crowd, island, now, rest)
        notes[SUNK] = max(notes[SUNK], -deepest)
        rest -= taken
        notes[NOTES] += motion.unpaid(solid, crowd, island, taken)
        notes[NOTES + 1] = min(notes[NOTES + 1], notes[NOTES])
        notes[WON] = max(notes[WON], notes[NOTES] - notes[NOTES + 1])


@compiled
def travel(surface, limits, solid, floor, crowd, sent, n):
    """Follow a crowd's one part, the n-th that is sent, until it passed, dropped out or its time is up."""
    state, dt, start = crowd.states[0], floor.step, way(surface, crowd.states[0])
    time, begun, path, notes = sent.times[n], sent.times[n], sent.paths[n], sent.notes[n]
    crowd.lasted[0] = crowd.made[0, REACHES] = crowd.blown[0, jets.AGAIN] = -1.0
    crowd.knowns[0] = 0
    steps, noted, outcome = math.ceil(limits.longest / dt), 0, RUNNING
    often, mark, level = math.ceil(limits.patience / dt), start, state[Z]
    for k in range(steps):
        if k % often == often - 1:
            place = way(surface, state)
            on = -BACKWARDS * limits.progress < place - mark < limits.progress
            if on and level - state[Z] < limits.progress:
                outcome = STANDS
                break
            mark, level = place, state[Z]
        if k % sent.every == 0 and noted < len(path):
            path[noted, 0] = time - begun
            for e in range(3):
                path[noted, 1 + e] = state[e]
            for e in range(4):
                path[noted, 4 + e] = state[body.Q + e]
            noted += 1
        over(surface, solid, floor, crowd, (0, 1), time, notes)
        time = begun + (k + 1) * dt
        if state[Z] < -solid.radius - limits.drop or across(surface, state) > limits.free:
            outcome = RETURNED
            break
        place = way(surface, state)
        if place > limits.exit:
            held = state[Z] > limits.under and slides_to(surface, state) < limits.edge
            outcome = PASSED if held else RETURNED
            break
        if place < limits.back:
            outcome = ROLLED
            break
    notes[TIME], notes[MOVED] = time - begun, way(surface, state) - start
    return outcome


@entry
def travel_all(surface, limits, solid, floor, crowd, sent):
    """Follow every part from its start, one at a time.

    Parameters
    ----------
    surface : Surface
    limits : Limits
    solid : TrueSolid
    floor : Floor
        Its ``step`` is the time step.
    crowd : Crowd
        Of one part.
    sent : Sent
        Outcomes are PASSED, RETURNED, STANDS, ROLLED or, of one whose time was up, RUNNING.
    """
    crowd.order[0] = 0
    for n in range(len(sent.states)):
        for k in range(body.STATE):
            crowd.states[0, k] = sent.states[n, k]
        sent.outcomes[n] = travel(surface, limits, solid, floor, crowd, sent, n)
        for k in range(body.STATE):
            sent.states[n, k] = crowd.states[0, k]


@compiled
def _islands(solid, crowd, active, dt):
    """Write which parts may touch each other in a step, by islands; how many islands there are."""
    count, found = 0, 0
    for n in range(len(crowd.states)):
        if active[n]:
            body.rotation(crowd.states[n], crowd.turns[n])
            crowd.order[count] = n
            count += 1
    first = 0
    while first < count:
        crowd.islands[found] = first
        found += 1
        last = first + 1
        while first < last:
            n = crowd.order[first]
            for m in range(last, count):
                k = crowd.order[m]
                reach = motion.ahead(solid, crowd.states[n], dt) + motion.ahead(solid, crowd.states[k], dt)
                if pairs.may_meet(solid, crowd, n, k, reach):
                    crowd.order[m], crowd.order[last] = crowd.order[last], k
                    last += 1
            first += 1
    crowd.islands[found] = count
    return found


@entry
def follow(surface, solid, floor, crowd, active, time, steps, notes):
    """Move all active parts so many steps; fills ``crowd.strains`` (N, 2) [sqrt(g L)] and ``notes``."""
    for n in range(len(crowd.states)):
        crowd.strains[n, motion.BEHIND] = crowd.strains[n, motion.BELOW] = 0.0
    for k in range(steps):
        found = _islands(solid, crowd, active, floor.step)
        for m in range(found):
            island = (crowd.islands[m], crowd.islands[m + 1])
            over(surface, solid, floor, crowd, island, time + k * floor.step, notes)
