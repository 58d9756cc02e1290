"""Compiled way of parts along a stretch of track: one until it is done with it, or many for some time."""

import math

from feederscrew.dropping.kernel import body
from feederscrew.dropping.kernel.body import VX, VY, X, Y, Z
from feederscrew.geometry.compiled import apart, compiled, entry
from feederscrew.trial.kernel import corners_met, jets, motion, pairs
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
    """Move an island's parts through a step of the floor; ``notes`` gets depth [L] and energy [g L].

    What strikes or turns its sliding round within it ends a share of the step, and the rest follows.
    """
    rest = floor.step
    while rest > LEFT * floor.step:
        now, taken = time + floor.step - rest, rest
        motion.ready(surface, crowd, island)
        reach = 0.0
        for m in range(island[0], island[1]):
            own = motion.ahead(solid, crowd.states[crowd.order[m]], taken)
            corners_met.found(surface, solid, crowd, crowd.order[m], own)
            reach = max(reach, own)
        crowd.paired[0] = 0
        for m in range(island[0], island[1]):
            for k in range(island[0], m):
                pairs.met(solid, crowd, crowd.order[m], crowd.order[k], reach)
        deepest, strikes, share = motion.pushed(surface, solid, floor, crowd, island, now, taken)
        once = motion.at_once(floor, taken)
        if once <= share < 1.0 - once:
            taken *= share
            motion.back(crowd, island)
            deepest, strikes, share = motion.pushed(surface, solid, floor, crowd, island, now, taken)
        motion.moved(crowd, island, 1.0 if strikes else 0.5, taken)
        if deepest < -motion.TROUBLE:
            motion.lift(surface, solid, crowd, island, taken)
        notes[SUNK] = max(notes[SUNK], -deepest)
        rest -= taken
        notes[NOTES] += motion.unpaid(solid, crowd, island, taken)
        notes[NOTES + 1] = min(notes[NOTES + 1], notes[NOTES])
        notes[WON] = max(notes[WON], notes[NOTES] - notes[NOTES + 1])


@compiled
def _sent_off(crowd, sent, n):
    """Lay the n-th part that is sent onto the track, with nothing known of what it touches."""
    for k in range(body.STATE):
        crowd.states[0, k] = sent.states[n, k]
    crowd.lasted[0] = crowd.made[0, REACHES] = crowd.blown[0, jets.AGAIN] = -1.0
    crowd.knowns[0] = crowd.order[0] = 0


@compiled
def _note(place, state, time):
    """Write time, position and attitude into a place (8,) of a path."""
    place[0] = time
    for e in range(3):
        place[1 + e] = state[e]
    for e in range(4):
        place[4 + e] = state[body.Q + e]


@compiled
def _what_became(surface, limits, solid, state):
    """Return RUNNING, or how a part with that state has left the stretch."""
    if state[Z] < -solid.radius - limits.drop or across(surface, state) > limits.free:
        return RETURNED
    place = way(surface, state)
    if place > limits.exit:
        held = state[Z] > limits.under and slides_to(surface, state) < limits.edge
        return PASSED if held else RETURNED
    return ROLLED if place < limits.back else RUNNING


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
def ride(surface, limits, solid, floor, crowd, sent, together):
    """Follow every part that is sent from its start, one at a time; where none is, move a crowd on.

    One entry and one function for both: what they share is most of it, and is compiled once.

    Parameters
    ----------
    surface : Surface
    limits : Limits
        Of the parts that are sent.
    solid : TrueSolid
    floor : Floor
        Its ``step`` is the time step.
    crowd : Crowd
        Of one part where any is sent; else ``strains`` (N, 2) [sqrt(g L)] are added to.
    sent : Sent
        Outcomes are PASSED, RETURNED, STANDS, ROLLED or, of one whose time was up, RUNNING.
    together : Together
    """
    dt, state = floor.step, crowd.states[0]
    for k in range(together.steps):
        found = _islands(solid, crowd, together.active, dt)
        for m in range(found):
            island = (crowd.islands[m], crowd.islands[m + 1])
            over(surface, solid, floor, crowd, island, together.time + k * dt, together.notes)
    often = math.ceil(limits.patience / dt)
    for n in range(len(sent.states)):
        _sent_off(crowd, sent, n)
        path, notes, begun, outcome = sent.paths[n], sent.notes[n], sent.times[n], RUNNING
        start, level, time = way(surface, state), state[Z], begun
        mark = start
        for k in range(math.ceil(limits.longest / dt)):
            if k % often == often - 1:
                place = way(surface, state)
                on = -BACKWARDS * limits.progress < place - mark < limits.progress
                if on and level - state[Z] < limits.progress:
                    outcome = STANDS
                    break
                mark, level = place, state[Z]
            if k % sent.every == 0 and k // sent.every < len(path):
                _note(path[k // sent.every], state, time - begun)
            over(surface, solid, floor, crowd, (0, 1), time, notes)
            time = begun + (k + 1) * dt
            outcome = _what_became(surface, limits, solid, state)
            if outcome != RUNNING:
                break
        notes[TIME], notes[MOVED], sent.outcomes[n] = time - begun, way(surface, state) - start, outcome
        body.keep(state, sent.states[n])
