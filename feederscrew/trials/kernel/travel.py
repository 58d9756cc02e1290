"""Compiled way of parts along a stretch of track: one until it is done with it, or many for some time."""

import math

from feederscrew.arrivals.kernel import body
from feederscrew.arrivals.kernel.body import VX, VY, X, Y, Z
from feederscrew.arrivals.kernel.floor_motion import Floor
from feederscrew.base.arrays import Bools, Floats, Row
from feederscrew.base.geometry.compiled import compiled, entry, outlined
from feederscrew.trials.kernel import pairs, steps
from feederscrew.trials.kernel.steps import place_along_wall
from feederscrew.trials.kernel.track_contacts import find_contacts
from feederscrew.trials.kernel.workspace import (
    Island,
    Limits,
    QueueSteps,
    Solo,
    Surface,
    TrueSolid,
    Workspace,
)

RUNNING = 0
PASSED = 1
RETURNED = 2
STANDS = 3  # gets on no more
ROLLED = 4  # went back
BACKWARDS = 5.0  # times as far as a part must get on: so far back in that time it rolls back
LEAST_STEP_SHARE = 1e-6  # [1] of a step: less is nothing
LEAST_FRICTION = 1e-6  # [1] below which a part slides on for good


@compiled
def distance_from_wall(surface: Surface, state: Floats) -> float:
    """Return how far from the wall [L] the centre of mass of a state (13,) is, anywhere round the bowl."""
    x, y = state[X], surface.radius - state[Y]
    return surface.radius - math.sqrt(x * x + y * y)


@compiled
def slides_to(surface: Surface, state: Floats) -> float:
    """Return how far from the wall [L] a part (13,) gets that slides on as it is until friction stops it.

    What was blown off may come past the end of a stretch before it is beyond the free edge.
    """
    x, y = state[X], surface.radius - state[Y]
    outwards = (state[VY] * y - state[VX] * x) / math.sqrt(x * x + y * y)
    braking = max(surface.friction[1], LEAST_FRICTION)
    return distance_from_wall(surface, state) + 0.5 * max(outwards, 0.0) ** 2 / braking


@outlined
def step_island(
    surface: Surface,
    solid: TrueSolid,
    floor: Floor,
    work: Workspace,
    island: Island,
    time: float,
    journal: Row,
) -> None:
    """Move an island's parts through a step of the floor; ``journal`` gets depth [L] and energy [g L].

    What strikes or turns its sliding round within it ends a share of the step, and the rest follows.
    """
    rest = floor.step
    while rest > LEAST_STEP_SHARE * floor.step:
        now, taken = time + floor.step - rest, rest
        steps.begin_step(surface, work, island)
        reach = 0.0
        for m in range(island[0], island[1]):
            n = work.order[m]
            own = steps.reach_ahead(solid, work.states[n], taken)
            find_contacts(surface, solid, work, n, own)
            reach = max(reach, own)
        work.pair_rows[0] = 0
        for m in range(island[0], island[1]):
            for k in range(island[0], m):
                pairs.find_pair_contacts(solid, work, work.order[m], work.order[k], reach)
        deepest, strikes, share = steps.push_island(surface, solid, floor, work, island, now, taken)
        start_share = steps.share_at_once(floor, taken)
        if start_share <= share < 1.0 - start_share:
            taken *= share
            for m in range(island[0], island[1]):
                body.keep(work.starts[work.order[m]], work.states[work.order[m]])
            deepest, strikes, share = steps.push_island(surface, solid, floor, work, island, now, taken)
        steps.move_island(work, island, 1.0 if strikes else 0.5, taken)
        if deepest < -steps.DEEP_CONTACT:
            steps.lift_island(surface, solid, work, island, taken)
        journal.depth = max(journal.depth, -deepest)
        rest -= taken
        energy = journal.energy + steps.energy_gain(solid, work, island, taken)
        least = min(journal.least_energy, energy)
        journal.energy, journal.least_energy, journal.gain = energy, least, max(journal.gain, energy - least)


@compiled
def _outcome(surface: Surface, limits: Limits, solid: TrueSolid, state: Floats) -> int:
    """Return RUNNING, or how a part with that state has left the stretch."""
    if state[Z] < -solid.radius - limits.drop or distance_from_wall(surface, state) > limits.free:
        return RETURNED
    place = place_along_wall(surface, state)
    if place > limits.exit:
        on_track = state[Z] > limits.fall_height and slides_to(surface, state) < limits.edge
        return PASSED if on_track else RETURNED
    return ROLLED if place < limits.back_limit else RUNNING


@compiled
def _find_islands(solid: TrueSolid, work: Workspace, active: Bools, dt: float) -> int:
    """Write which parts may touch each other in a step, by islands; how many islands there are."""
    count, islands = 0, 0
    for n in range(len(work.states)):
        if active[n]:
            body.rotation(work.states[n], work.turns[n])
            work.reaches[n] = steps.reach_ahead(solid, work.states[n], dt)
            work.order[count] = n
            count += 1
    first = 0
    while first < count:
        work.islands[islands] = first
        islands += 1
        last = first + 1
        while first < last:
            n = work.order[first]
            for m in range(last, count):
                k = work.order[m]
                if pairs.may_meet(solid, work, n, k, work.reaches[n] + work.reaches[k]):
                    work.order[m], work.order[last] = work.order[last], k
                    last += 1
            first += 1
    work.islands[islands] = count
    return islands


@entry
def ride(
    surface: Surface, solid: TrueSolid, floor: Floor, work: Workspace, solo: Solo, crowd: QueueSteps
) -> None:
    """Follow every part that is sent from its start, one at a time; where none is, move a crowd on.

    One entry and one function for both: what they share is most of it, and is compiled once. The time step is
    that of the ``floor``. ``work`` is of one part where any is sent; else its ``strains`` (N, 2) [sqrt(g L)]
    are added to. Outcomes are PASSED, RETURNED, STANDS, ROLLED or, of one whose time was up, RUNNING.
    """
    dt, state = floor.step, work.states[0]
    for k in range(crowd.steps):
        for m in range(_find_islands(solid, work, crowd.active, dt)):
            island = (work.islands[m], work.islands[m + 1])
            step_island(surface, solid, floor, work, island, crowd.time + k * dt, crowd.journals[0])
    limits = solo.limits
    often = math.ceil(limits.patience / dt)
    for n in range(len(solo.states)):
        body.keep(solo.states[n], state)
        work.last_steps[0] = work.list_states[0].reach = work.jets_until[0] = -1.0  # nothing is known of it
        work.last_counts[0] = work.order[0] = 0
        path, journal, begun, outcome = solo.paths[n], solo.journals[n], solo.times[n], RUNNING
        start, level, time = place_along_wall(surface, state), state[Z], begun
        mark = start
        for k in range(math.ceil(limits.longest / dt)):
            if k % often == often - 1:
                place = place_along_wall(surface, state)
                on = -BACKWARDS * limits.progress < place - mark < limits.progress
                if on and level - state[Z] < limits.progress:
                    outcome = STANDS
                    break
                mark, level = place, state[Z]
            if k % solo.stride == 0 and k // solo.stride < len(path):
                noted = path[k // solo.stride]
                noted[0] = time - begun
                for e in range(3):
                    noted[1 + e] = state[e]
                for e in range(4):
                    noted[4 + e] = state[body.Q + e]
            step_island(surface, solid, floor, work, (0, 1), time, journal)
            time = begun + (k + 1) * dt
            outcome = _outcome(surface, limits, solid, state)
            if outcome != RUNNING:
                break
        journal.time, journal.way = time - begun, place_along_wall(surface, state) - start
        solo.outcomes[n] = outcome
        body.keep(state, solo.states[n])
