"""How the floor moves: at rest, or vibrating in a straight line or an ellipse.

Everything is in the floor's frame: a floor that moves is a force on the body that changes with time. The
floor moves along its x axis and along its normal z, each harmonically, with a second harmonic.
"""

import math
from typing import NamedTuple

from feederscrew.geometry.compiled import compiled


class Floor(NamedTuple):
    """Motion of the floor, without dimensions: lengths over L, times over sqrt(L / g).

    It is ``along`` sin x + ``second_along`` sin(2 x + second_phase) ahead, at x = rate t + lead, and
    ``up`` sin x + ``second_up`` sin(2 x + second_phase) high, at x = rate t.
    """

    rate: float  # angular frequency of the drive; 0 for a floor at rest
    along: float  # amplitudes
    up: float
    lead: float  # [rad]
    second_along: float  # amplitudes of the second harmonic
    second_up: float
    second_phase: float  # [rad]
    step: float  # longest step in time: a small part of the period


@compiled
def at_rest():
    """Return the floor of a drop test."""
    return Floor(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, math.inf)


@compiled
def place(floor, amplitude, second, angle):
    """Return where the floor is along one axis [L], at a phase [rad] of its motion.

    Source: a harmonic drive; docs/conveying.md, "The model".
    """
    return amplitude * math.sin(angle) + second * math.sin(2.0 * angle + floor.second_phase)


@compiled
def speed(floor, amplitude, second, angle):
    """Return how fast the floor moves along one axis [sqrt(g L)], at a phase [rad] of its motion.

    Source: a harmonic drive; docs/conveying.md, "The model".
    """
    first, rate = amplitude * floor.rate * math.cos(angle), 2.0 * floor.rate
    return first + second * rate * math.cos(2.0 * angle + floor.second_phase)


@compiled
def quickening(floor, time, dt):
    """Return the change of the floor's velocity [sqrt(g L)] over a step [sqrt(L/g)], along x and z.

    Source: a harmonic drive; docs/conveying.md, "The model".
    """
    if floor.rate == 0.0:
        return 0.0, 0.0
    now, then = floor.rate * time, floor.rate * (time + dt)
    along, up = (floor.along, floor.second_along), (floor.up, floor.second_up)
    ahead = speed(floor, *along, then + floor.lead) - speed(floor, *along, now + floor.lead)
    return ahead, speed(floor, *up, then) - speed(floor, *up, now)


@compiled
def gained(floor, time, dt):
    """Return the floor's way [L] over dt [sqrt(L/g)] beyond its present velocity times dt, along x and z."""
    if floor.rate == 0.0:
        return 0.0, 0.0
    now, then = floor.rate * time, floor.rate * (time + dt)
    a, b = now + floor.lead, then + floor.lead
    along, up = (floor.along, floor.second_along), (floor.up, floor.second_up)
    ahead = place(floor, *along, b) - place(floor, *along, a) - dt * speed(floor, *along, a)
    rise = place(floor, *up, then) - place(floor, *up, now) - dt * speed(floor, *up, now)
    return ahead, rise
