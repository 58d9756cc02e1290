"""Compiled motion of a row of parts that push each other along the track: points in one dimension.

Each part slides and hops as the exact point mass does, with a friction of its own; one that would run into
the part ahead pushes it instead, without rebound. What they do across the track is left out.
"""

import math

from feederscrew.dropping.kernel import floor as floors
from feederscrew.geometry.compiled import compiled, entry

PLACE, SPEED, HEIGHT, RISE, LENGTH, FRICTION, HELD, PUSH = range(8)  # columns of a part
CHANGE = 1e-7  # of a sweep's impulses, over what they are: it has converged
SWEEPS = 200


@compiled
def _pulled(part, gravity, ahead, rise, dt, restitution):
    """Let a part fall and the track move for a step; what it is pressed on with, as an impulse."""
    free = part[RISE] + dt * gravity[2] - rise
    height = part[HEIGHT] + dt * (part[RISE] + free) * 0.5
    part[SPEED] += dt * gravity[0] - ahead
    if height > 0.0:
        part[HEIGHT], part[RISE] = height, free
        return 0.0
    rebound = -restitution * part[RISE] if part[HEIGHT] > 0.0 else 0.0
    part[HEIGHT], part[RISE] = 0.0, max(rebound, 0.0)
    return max(part[RISE] - free, 0.0)


@compiled
def _rubbed(part, most, rub):
    """Friction of a part within its limit, given what it is so far; what it becomes."""
    best = min(max(rub - part[SPEED], -most), most)
    part[SPEED] += best - rub
    return best


@compiled
def step(parts, order, gravity, floor, time, dt, restitution, loads, rubs, pushes):
    """Move a row for a step; ``order`` is from the first to the last, ``pushes`` (N,) is filled."""
    ahead, rise = floors.quickening(floor, time, dt)
    count = len(order)
    for n in range(count):
        part = parts[order[n]]
        loads[n] = part[FRICTION] * _pulled(part, gravity, ahead, rise, dt, restitution)
        rubs[n] = pushes[n] = 0.0
    for _ in range(SWEEPS):
        change = size = 0.0
        for n in range(count):
            part = parts[order[n]]
            most = math.inf if part[HELD] > 0.5 else loads[n]
            rub = _rubbed(part, most, rubs[n])
            change += abs(rub - rubs[n])
            size += abs(rub)
            rubs[n] = rub
            if n:
                first = parts[order[n - 1]]
                free = first[PLACE] - part[PLACE] - 0.5 * (first[LENGTH] + part[LENGTH])
                push = max(pushes[n] + 0.5 * (part[SPEED] - first[SPEED] - max(free, 0.0) / dt), 0.0)
                part[SPEED] -= push - pushes[n]
                first[SPEED] += push - pushes[n]
                change += abs(push - pushes[n])
                size += push
                pushes[n] = push
        if change <= CHANGE * size:
            break
    for n in range(count):
        part = parts[order[n]]
        part[PLACE] += dt * part[SPEED]
        part[PUSH] += pushes[n]


@entry
def follow(parts, order, gravity, floor, time, restitution, steps, loads, rubs, pushes):
    """Move a row for so many steps of the floor."""
    for k in range(steps):
        step(
            parts, order, gravity, floor, time + k * floor.step, floor.step, restitution, loads, rubs, pushes
        )
