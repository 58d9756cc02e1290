"""Compiled drop: flight, impacts and rolling of one body until its resting face is decided."""

import math
from typing import NamedTuple

import numpy as np

from feederscrew.resting.compiled import compiled
from feederscrew.resting.drop import body, contact
from feederscrew.resting.drop.body import VX, VY, VZ, W, Z
from feederscrew.resting.tumbling_walk import LOST, roll_from_corner, roll_from_facet

UNSETTLED = -1
STEADY = 0.3  # of the barrier: what a steadily rolling part may have beside its rolling energy


class Scratch(NamedTuple):
    """Arrays the kernel writes to: one set for each thread."""

    state: np.ndarray  # (STATE,)
    saved: np.ndarray  # (STATE,)
    turn: np.ndarray  # (9,)
    seen: np.ndarray  # (V,) bool
    found: np.ndarray  # (V + MOST,)
    contacts: np.ndarray  # (MOST, WIDTH)
    trace: np.ndarray  # (N, 14) time and state at the start of each step, until it is full


def scratch(shape, rows=0):
    """Fresh working arrays for a shape, with a trace of so many rows."""
    size = len(shape.vertices)
    return Scratch(
        state=np.zeros(body.STATE),
        saved=np.zeros(body.STATE),
        turn=np.zeros(9),
        seen=np.zeros(size, bool),
        found=np.zeros(size + contact.MOST, int),
        contacts=np.zeros((contact.MOST, contact.WIDTH)),
        trace=np.zeros((rows, 1 + body.STATE)),
    )


class Steps(NamedTuple):
    """Step sizes and tolerances of a drop, dimensionless."""

    flight: float = 0.01  # shortest step in the air
    turn: float = 0.06  # [rad] largest turn in a step in the air
    contact: float = 0.006  # step on the floor
    tolerance: float = 1e-3  # corners this near the floor touch it
    threshold: float = 0.05  # approach speed from which a contact rebounds
    sweeps: int = 20  # of the contact solver
    margin: float = 2e-3  # energy below the lowest saddle at which the face is decided
    rolling: float = 2e-3  # rolling resistance: lever of the normal force
    longest: float = 400.0  # time after which a drop counts as unsettled
    early: bool = True  # stop as soon as the face is decided, not at rest


@compiled
def gap_after(points, links, inertia, state, saved, turn, corner, dt):
    """Fly from the saved state over dt; lowest corner and its height over the floor."""
    body.keep(saved, state)
    body.fly(state, inertia, dt)
    body.rotation(state, turn)
    corner, level = body.lowest(points, links, turn, corner)
    return corner, state[Z] + level


@compiled
def approach(points, links, inertia, radius, state, saved, turn, corner, gap, steps):
    """One step through the air, ended on the floor if it would go below; corner, gap and time taken."""
    rate = math.sqrt(state[W] ** 2 + state[W + 1] ** 2 + state[W + 2] ** 2)
    quickest = abs(state[VZ]) + rate * radius + 1e-9
    dt = min(max(gap / quickest, steps.flight), steps.turn / (rate + 1e-9), 0.5)
    body.keep(state, saved)
    corner, after = gap_after(points, links, inertia, state, saved, turn, corner, dt)
    if after >= 0.0:
        return corner, after, dt
    early, late, above, below = 0.0, dt, max(gap, 0.0), after
    for _ in range(30):
        share = min(max(above / (above - below), 0.1), 0.9)
        dt = early + share * (late - early)
        corner, after = gap_after(points, links, inertia, state, saved, turn, corner, dt)
        if 0.0 <= after <= steps.tolerance:
            break
        if after > 0.0:
            early, above = dt, after
        else:
            late, below = dt, after
    return corner, after, dt


@compiled
def move(points, links, state, saved, turn, corner, dt):
    """Move the saved positions at the present velocities over dt; lowest corner and its height."""
    for k in range(3):
        state[k] = saved[k] + dt * state[VX + k]
    for k in range(4):
        state[body.Q + k] = saved[body.Q + k]
    body.rotate(state, state[W], state[W + 1], state[W + 2], dt)
    body.rotation(state, turn)
    corner, level = body.lowest(points, links, turn, corner)
    return corner, state[Z] + level


@compiled
def press_on(points, links, inertia, state, saved, turn, corner, contacts, count, friction, steps):
    """One step on the floor, ended where another corner lands; corner, gap and time taken."""
    dt, before = steps.contact, body.energy(state, inertia)
    body.keep(state, saved)
    body.spin(state, inertia, dt)
    contact.press(state, contacts, count, friction, dt, steps.sweeps)
    resist(state, inertia, steps.rolling, dt)
    corner, gap = move(points, links, state, saved, turn, corner, dt)
    early, late = 0.0, dt
    while gap < -0.5 * steps.tolerance and late - early > 0.05 * steps.contact:
        dt = 0.5 * (early + late)
        corner, gap = move(points, links, state, saved, turn, corner, dt)
        if gap < -0.5 * steps.tolerance:
            late = dt
        elif gap > 0.5 * steps.tolerance:
            early = dt
        else:
            break
    state[Z] = min(state[Z] - min(gap, 0.0), before)
    body.slow_down(state, inertia, before)
    return corner, max(gap, 0.0), dt


@compiled
def resist(state, inertia, lever, dt):
    """Take the work of rolling resistance out of the rotation."""
    spinning = body.spin_energy(state, inertia)
    rate = math.sqrt(state[W] ** 2 + state[W + 1] ** 2 + state[W + 2] ** 2)
    if spinning > 0.0:
        scale = math.sqrt(max(1.0 - lever * rate * dt / spinning, 0.0))
        for k in range(3):
            state[W + k] *= scale


@compiled
def face_below(shape, turn, corner):
    """Face the body would roll to if set down as it is."""
    down = -turn[6], -turn[7], -turn[8]
    facet = roll_from_facet(shape.edges, roll_from_corner(shape.edges, down, corner))
    return shape.faces[facet] if facet != LOST else UNSETTLED


@compiled
def rolling_energy(shape, state, turn, face):
    """Energy of rolling about the axis of a rolling face, which no impact turns into height."""
    a = shape.axes[face]
    x = turn[0] * a[0] + turn[1] * a[1] + turn[2] * a[2]
    y = turn[3] * a[0] + turn[4] * a[1] + turn[5] * a[2]
    flat = math.sqrt(x * x + y * y)
    about = state[W] * a[0] + state[W + 1] * a[1] + state[W + 2] * a[2]
    across = (state[VX] * y - state[VY] * x) / flat if flat > 0.5 else 0.0
    moment = shape.inertia[0] * a[0] ** 2 + shape.inertia[1] * a[1] ** 2 + shape.inertia[2] * a[2] ** 2
    return 0.5 * (moment * about**2 + across**2)


@compiled
def slides_flat(shape, state, turn, face, friction):
    """True where the body lies flat on the floor and friction cannot tip it while it slides."""
    around = state[W] * turn[6] + state[W + 1] * turn[7] + state[W + 2] * turn[8]
    rocking = state[W] ** 2 + state[W + 1] ** 2 + state[W + 2] ** 2 - around**2
    flat = state[Z] - shape.heights[face] < 2e-3 and rocking < 1e-4 and abs(state[VZ]) < 1e-2
    return flat and friction * shape.heights[face] < 0.9 * shape.margins[face]


@compiled
def decided(shape, state, turn, corner, count, friction, rests, steps):
    """Face on which the body is bound to rest, ``rests`` steps on the floor; UNSETTLED if it can leave."""
    total = body.energy(state, shape.inertia)
    if total >= shape.ceiling and count < 2:
        return UNSETTLED
    face = face_below(shape, turn, corner)
    if face == UNSETTLED:
        return UNSETTLED
    if rests >= 64 and total - state[Z] < 1e-7:
        return face  # balanced on an edge by rolling resistance
    if not steps.early:
        still = total - shape.heights[face] < min(1e-3, 0.02 * shape.barriers[face])
        return face if still else UNSETTLED
    above = total - shape.heights[face]
    if above < shape.barriers[face] - steps.margin:
        return face
    if shape.rolls[face] and count >= 2:
        above -= rolling_energy(shape, state, turn, face)
        return face if above < STEADY * shape.barriers[face] - steps.margin else UNSETTLED
    return face if count >= 3 and slides_flat(shape, state, turn, face, friction) else UNSETTLED


@compiled
def settle(shape, work, restitution, friction, steps):
    """Follow one body until its face is decided.

    Parameters
    ----------
    shape : Shape
    work : Scratch
        Its ``state`` holds the start, and the end afterwards; its ``trace`` is filled.
    restitution, friction : float
    steps : Steps

    Returns
    -------
    face, time, rows of the trace filled
    """
    points, links, inertia, radius = shape.vertices, shape.links, shape.inertia, shape.radius
    state, saved, turn, contacts = work.state, work.saved, work.turn, work.contacts
    time, rows, rests = 0.0, 0, 0
    body.rotation(state, turn)
    corner, level = body.lowest(points, links, turn, 0)
    gap = state[Z] + level
    while time < steps.longest:
        if rows < len(work.trace):
            record(work.trace, rows, time, state)
            rows += 1
        if gap > steps.tolerance:
            corner, gap, dt = approach(points, links, inertia, radius, state, saved, turn, corner, gap, steps)
            time += dt
            continue
        count = contact.touching(
            points, links, turn, state[Z], corner, steps.tolerance, work.seen, work.found
        )
        contact.levers(points, inertia, turn, work.found, count, contacts)
        fall = contact.steepest(state, contacts, count)
        rests += 1
        if fall < -steps.threshold:
            contact.strike(inertia, state, saved, contacts, count, restitution, friction, steps)
            fall = contact.steepest(state, contacts, count)
            rests = 0
        if rests % 8 == 0:
            face = decided(shape, state, turn, corner, count, friction, rests, steps)
            if face != UNSETTLED:
                return face, time, rows
        if fall > steps.threshold:
            corner, gap, dt = approach(points, links, inertia, radius, state, saved, turn, corner, gap, steps)
        else:
            corner, gap, dt = press_on(
                points, links, inertia, state, saved, turn, corner, contacts, count, friction, steps
            )
        time += dt
    return UNSETTLED, time, rows


@compiled
def record(trace, k, time, state):
    """Write one row of a trace."""
    trace[k, 0] = time
    for j in range(body.STATE):
        trace[k, 1 + j] = state[j]


@compiled
def settle_all(shape, work, starts, restitutions, frictions, steps, faces, times):
    """Drop every row of (N, 13) starts; fills (N,) faces and times."""
    for n in range(len(starts)):
        for k in range(body.STATE):
            work.state[k] = starts[n, k]
        faces[n], times[n], _ = settle(shape, work, restitutions[n], frictions[n], steps)
