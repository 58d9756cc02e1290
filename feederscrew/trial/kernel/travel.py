"""Compiled way of one part past one station, until it has passed, has dropped out or is given up."""

import math

from feederscrew.dropping.kernel import body
from feederscrew.dropping.kernel.body import X, Y, Z
from feederscrew.geometry.compiled import compiled, entry
from feederscrew.trial.kernel.balance import unpaid
from feederscrew.trial.kernel.motion import step

RUNNING, PASSED, RETURNED, STANDS, ROLLED = range(5)  # STANDS gets on no more, ROLLED went back
TIME, MOVED, SUNK, WON, NOTES = 0, 1, 2, 3, 4  # what a run notes: time, way, depth, energy; how many
LEFT = 1e-6  # of a step: less is nothing


@compiled
def way(surface, state):
    """Return how far along the wall the centre of mass is."""
    return surface.radius * math.atan2(state[X], surface.radius - state[Y])


@compiled
def travel(surface, solid, floor, work, time, every, path, notes):
    """Follow a part until it has passed, has dropped out or its time is up.

    Parameters
    ----------
    surface : StageSurface
    solid : TrueSolid
    floor : Floor
        Its ``step`` is the time step.
    work : WorkingArrays
        Its ``state`` holds the start, and the end afterwards.
    time : float
        At the start: the phase of the drive.
    every : int
        Steps between two places noted.
    path : (K, 8) float
        Filled with time, position and attitude, from the first row on; nothing more once it is full.
    notes : (NOTES,) float
        Filled with the time taken, the way along the wall, the greatest depth and the greatest rise of the
        energy over what gravity and the drive gave.

    Returns
    -------
    int
        PASSED, RETURNED, STANDS, ROLLED or, where its time was up, RUNNING.
    """
    state, dt, begun, start = work.state, floor.step, time, way(surface, work.state)
    work.memory[0] = -1.0
    steps, noted, sunk, outcome = math.ceil(surface.longest / dt), 0, 0.0, RUNNING
    excess = lowest = won = 0.0
    apart, mark, level = math.ceil(surface.patience / dt), start, state[Z]
    for k in range(steps):
        if k % apart == apart - 1:
            place = way(surface, state)
            if place - mark < surface.progress and level - state[Z] < surface.progress:
                outcome = STANDS if place - mark > -surface.progress else ROLLED
                break
            mark, level = place, state[Z]
        if k % every == 0 and noted < len(path):
            path[noted, 0] = time - begun
            for e in range(3):
                path[noted, 1 + e] = state[e]
            for e in range(4):
                path[noted, 4 + e] = state[body.Q + e]
            noted += 1
        rest = dt
        while rest > LEFT * dt:
            now = begun + (k + 1) * dt - rest
            deepest, taken = step(surface, solid, floor, work, now, rest)
            sunk, rest = min(sunk, deepest), rest - taken
            excess += unpaid(surface, solid, floor, work, now, taken)
            lowest = min(lowest, excess)
            won = max(won, excess - lowest)
        time = begun + (k + 1) * dt
        if state[Z] < -solid.radius - surface.drop:
            outcome = RETURNED
            break
        place = way(surface, state)
        if place > surface.exit:
            outcome = PASSED if state[Z] > surface.under else RETURNED
            break
        if place < surface.back:
            outcome = ROLLED
            break
    notes[TIME], notes[MOVED] = time - begun, way(surface, state) - start
    notes[SUNK], notes[WON] = -sunk, won
    return outcome


@entry
def travel_all(surface, solid, floor, work, starts, times, every, paths, notes, outcomes):
    """Follow every row of (N, 13) starts, which hold the ends afterwards; fills paths, notes and outcomes."""
    for n in range(len(starts)):
        for k in range(body.STATE):
            work.state[k] = starts[n, k]
        outcomes[n] = travel(surface, solid, floor, work, times[n], every, paths[n], notes[n])
        for k in range(body.STATE):
            starts[n, k] = work.state[k]
