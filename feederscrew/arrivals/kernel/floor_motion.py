"""Motion of the floor: at rest, or vibrating in a straight line or an ellipse.

Everything is in the floor's frame: a floor that moves is a force on the body that changes with time. The
floor moves along its x axis and along its normal z, each harmonically, with a second harmonic.
"""

import math
from typing import NamedTuple

from feederscrew.base.geometry.compiled import compiled

Quadruple = tuple[float, float, float, float]


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
def at_rest() -> Floor:
    """Return the floor of a drop test."""
    return Floor(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, math.inf)


@compiled
def place(floor: Floor, amplitude: float, second: float, angle: float) -> float:
    """Return where the floor is along one axis [L], at a phase [rad] of its motion.

    Source: a harmonic drive; docs/conveying.md, "The model".
    """
    return amplitude * math.sin(angle) + second * math.sin(2.0 * angle + floor.second_phase)


@compiled
def speed(floor: Floor, amplitude: float, second: float, angle: float) -> float:
    """Return how fast the floor moves along one axis [sqrt(g L)], at a phase [rad] of its motion.

    Source: a harmonic drive; docs/conveying.md, "The model".
    """
    first, rate = amplitude * floor.rate * math.cos(angle), 2.0 * floor.rate
    return first + second * rate * math.cos(2.0 * angle + floor.second_phase)


@compiled
def moves(floor: Floor, time: float) -> Quadruple:
    """Return place [L] and speed [sqrt(g L)] of the floor along x, then along z, at a time [sqrt(L/g)].

    Most drives are straight and of one harmonic: one sine and one cosine then serve both axes.
    Source: a harmonic drive; docs/conveying.md, "The model".
    """
    angle = floor.rate * time
    if floor.lead == 0.0 and floor.second_along == 0.0 and floor.second_up == 0.0:
        sine, cosine = math.sin(angle), math.cos(angle)
        ahead, forth = floor.along * sine, floor.along * floor.rate * cosine
        return ahead, forth, floor.up * sine, floor.up * floor.rate * cosine
    along, up, led = (floor.along, floor.second_along), (floor.up, floor.second_up), angle + floor.lead
    ahead, forth = place(floor, *along, led), speed(floor, *along, led)
    return ahead, forth, place(floor, *up, angle), speed(floor, *up, angle)


@compiled
def quickening(floor: Floor, time: float, dt: float) -> tuple[float, float]:
    """Return the change of the floor's velocity [sqrt(g L)] over a step [sqrt(L/g)], along x and z.

    Source: a harmonic drive; docs/conveying.md, "The model".
    """
    if floor.rate == 0.0:
        return 0.0, 0.0
    _, forth, _, up = moves(floor, time)
    _, forth_then, _, up_then = moves(floor, time + dt)
    return forth_then - forth, up_then - up


@compiled
def gained(floor: Floor, time: float, dt: float) -> Quadruple:
    """Return what the floor gains over a step ``dt`` [sqrt(L/g)], along x, then along z.

    That is its way [L] beyond its present velocity times dt, and the change of its velocity [sqrt(g L)].
    Source: a harmonic drive; docs/conveying.md, "The model".
    """
    if floor.rate == 0.0:
        return 0.0, 0.0, 0.0, 0.0
    ahead, forth, high, up = moves(floor, time)
    ahead_then, forth_then, high_then, up_then = moves(floor, time + dt)
    way, rise = ahead_then - ahead - dt * forth, high_then - high - dt * up
    return way, forth_then - forth, rise, up_then - up
