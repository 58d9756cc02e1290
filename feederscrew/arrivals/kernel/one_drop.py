"""Compiled drop: one body on a floor at rest, until its resting face is decided."""

import math

import numpy as np

from feederscrew.arrivals.kernel import body
from feederscrew.arrivals.kernel.body import W, Z
from feederscrew.arrivals.kernel.falling import (
    Launched,
    Pairing,
    Scratch,
    Steps,
    advance,
    launched_one,
    start,
)
from feederscrew.arrivals.kernel.floor_motion import at_rest
from feederscrew.arrivals.rounded_hull import Shape
from feederscrew.base.arrays import Floats, Ints
from feederscrew.base.geometry.compiled import compiled, entry
from feederscrew.resting.walks import LOST_WALK, roll_from_corner, roll_from_facet

UNSETTLED = -1
REST_ENERGY = 1e-6  # kinetic energy below which a part does not move
BALANCED_STEPS = 32  # it must not move: at the turning point of a slow rocking it stands still for fewer
STEADY_ROLL_SHARE = 0.3  # of the barrier: what a steadily rolling part may have beside its rolling energy


@compiled
def face_below(shape: Shape, turn: Floats, corner: int) -> int:
    """Return the face [1] the body would roll to if set down as ``turn`` (9,) has it."""
    down = -turn[6], -turn[7], -turn[8]
    facet = roll_from_facet(shape.edges, roll_from_corner(shape.edges, down, corner))
    return shape.faces[facet] if facet != LOST_WALK else UNSETTLED


@compiled
def rolling_energy(shape: Shape, state: Floats, turn: Floats, face: int) -> float:
    """Return the energy [g L] of rolling about the axis of a rolling face: no impact turns it into height.

    Source: own; docs/resting.md, "The drop test".
    """
    a = shape.axes[face]
    x = turn[0] * a[0] + turn[1] * a[1] + turn[2] * a[2]
    y = turn[3] * a[0] + turn[4] * a[1] + turn[5] * a[2]
    flat = math.sqrt(x * x + y * y)
    u, v, _ = body.velocity(state)
    about = state[W] * a[0] + state[W + 1] * a[1] + state[W + 2] * a[2]
    across = (u * y - v * x) / flat if flat > 0.5 else 0.0
    inertia = shape.solid.inertia
    moment = inertia[0] * a[0] * a[0] + inertia[1] * a[1] * a[1] + inertia[2] * a[2] * a[2]
    return 0.5 * (moment * about * about + across * across)


@compiled
def _decided(
    shape: Shape,
    state: Floats,
    turn: Floats,
    corner: int,
    count: int,
    friction: float,
    quiet: int,
    steps: Steps,
) -> int:
    """The face on which the body is bound to rest after ``quiet`` steps; UNSETTLED if it can leave."""
    total = body.energy(state, shape.solid.inertia)
    if total >= shape.ceiling and count < 2:
        return UNSETTLED
    face = face_below(shape, turn, corner)
    if face == UNSETTLED:
        return UNSETTLED
    if quiet >= BALANCED_STEPS:
        return face  # balanced on an edge by rolling resistance
    if not steps.early:
        still = total - shape.heights[face] < min(1e-3, 0.02 * shape.barriers[face])
        return face if still else UNSETTLED
    above = total - shape.heights[face]
    if above < shape.barriers[face] - steps.margin:
        return face
    if shape.rolls[face] and count >= 2:
        above -= rolling_energy(shape, state, turn, face)
        return face if above < STEADY_ROLL_SHARE * shape.barriers[face] - steps.margin else UNSETTLED
    if count < 3:
        return UNSETTLED
    # where it lies flat, whether friction cannot tip it while it slides
    around = state[W] * turn[6] + state[W + 1] * turn[7] + state[W + 2] * turn[8]
    quick, rise = body.rate(state), abs(body.velocity(state)[2])
    rocking = quick * quick - around * around
    flat = state[Z] - shape.heights[face] < 2e-3 and rocking < 1e-4 and rise < 1e-2
    still = rocking < 1e-8 and rise < 1e-4
    most = (0.98 if still else 0.9) * shape.margins[face]  # that the centre of pressure may be off
    return face if flat and friction * shape.heights[face] < most else UNSETTLED


@entry
def settle_all(
    shape: Shape, work: Scratch, launched: Launched, steps: Steps, faces: Ints, times: Floats
) -> None:
    """Drop all N bodies that are launched; fills (N,) faces and times."""
    floor = at_rest()
    for n in range(len(launched.states)):
        pairing = Pairing(launched.restitutions[n], launched.frictions[n])
        for k in range(body.STATE):
            work.state[k] = launched.states[n, k]
        face, time, rows, rests, quiet = UNSETTLED, 0.0, 0, 0, 0
        corner, gap = start(shape.solid, work)
        for _ in range(steps.most):
            if time >= steps.longest:
                break
            if rows < len(work.trace):
                work.trace[rows, 0] = time
                for k in range(body.STATE):
                    work.trace[rows, 1 + k] = work.state[k]
                rows += 1
            corner, gap, dt, count, struck = advance(
                shape.solid, work, floor, time, corner, gap, pairing, steps
            )
            time += dt
            if count == 0:
                continue
            rests = 0 if struck else rests + 1
            quiet = quiet + 1 if body.moving_energy(work.state, shape.solid.inertia) < REST_ENERGY else 0
            if rests % (2 if count >= 3 else 8) == 0:
                face = _decided(shape, work.state, work.turn, corner, count, pairing.friction, quiet, steps)
                if face != UNSETTLED:
                    break
        faces[n], times[n], work.rows[0] = face, time, rows


def settle(
    shape: Shape, work: Scratch, restitution: float, friction: float, steps: Steps
) -> tuple[int, float, int]:
    """Follow one body until its face is decided; return face, time [sqrt(L/g)] and rows of the trace filled.

    The ``state`` of ``work`` holds the start, and the end afterwards; its ``trace`` is filled.
    Source: docs/resting.md, "The drop test".
    """
    faces, times = np.zeros(1, int), np.zeros(1)
    settle_all(shape, work, launched_one(work.state, restitution, friction), steps, faces, times)
    return int(faces[0]), float(times[0]), int(work.rows[0])
