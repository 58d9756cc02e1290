"""How the floor moves: at rest, or vibrating in a straight line or an ellipse.

Everything is in the floor's frame: a floor that moves is a force on the body that changes with time. The
floor moves along its x axis and along its normal z, each as s(rate t) with the second harmonic of the drive.
"""

import math
from typing import NamedTuple

from feederscrew.geometry.compiled import compiled


class Floor(NamedTuple):
    """Motion of the floor, without dimensions: lengths over L, times over sqrt(L / g).

    It is ``along`` s(rate t + lead) ahead and ``up`` s(rate t) high, with s(x) = sin x + second
    sin(2 x + second_phase).
    """

    rate: float  # angular frequency of the drive; 0 for a floor at rest
    along: float  # amplitudes
    up: float
    lead: float  # [rad]
    second: float  # of the first harmonic
    second_phase: float  # [rad]
    step: float  # longest step in time: a small part of the period


@compiled
def at_rest():
    """Return the floor of a drop test."""
    return Floor(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, math.inf)


@compiled
def place(floor, amplitude, angle):
    """Return where the floor is along one axis [L], at a phase [rad] of its motion.

    Source: a harmonic drive; docs/conveying.md, "The model".
    """
    return amplitude * (math.sin(angle) + floor.second * math.sin(2.0 * angle + floor.second_phase))


@compiled
def speed(floor, amplitude, angle):
    """Return how fast the floor moves along one axis [sqrt(g L)], at a phase [rad] of its motion.

    Source: a harmonic drive; docs/conveying.md, "The model".
    """
    turned = math.cos(angle) + 2.0 * floor.second * math.cos(2.0 * angle + floor.second_phase)
    return amplitude * floor.rate * turned


@compiled
def quickening(floor, time, dt):
    """Return the change of the floor's velocity [sqrt(g L)] over a step [sqrt(L/g)], along x and z.

    Source: a harmonic drive; docs/conveying.md, "The model".
    """
    if floor.rate == 0.0:
        return 0.0, 0.0
    now, then = floor.rate * time, floor.rate * (time + dt)
    ahead = speed(floor, floor.along, then + floor.lead) - speed(floor, floor.along, now + floor.lead)
    return ahead, speed(floor, floor.up, then) - speed(floor, floor.up, now)


@compiled
def gained(floor, time, dt):
    """Return the floor's way [L] over dt [sqrt(L/g)] beyond its present velocity times dt, along x and z."""
    if floor.rate == 0.0:
        return 0.0, 0.0
    now, then = floor.rate * time, floor.rate * (time + dt)
    a, b = now + floor.lead, then + floor.lead
    ahead = place(floor, floor.along, b) - place(floor, floor.along, a) - dt * speed(floor, floor.along, a)
    rise = place(floor, floor.up, then) - place(floor, floor.up, now) - dt * speed(floor, floor.up, now)
    return ahead, rise
