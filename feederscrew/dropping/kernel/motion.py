"""Compiled motion of one body from event to event: in the air, at impacts, and on the floor."""

import math
from typing import NamedTuple

import numpy as np

from feederscrew.dropping.kernel import body, contact
from feederscrew.dropping.kernel import floor as floors
from feederscrew.dropping.kernel.body import VX, VZ, W, X, Z
from feederscrew.geometry.compiled import inlined


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


@inlined
def gap_after(shape, work, floor, time, corner, dt):
    """Fly from the saved state over dt; lowest corner and its height over the floor."""
    state = work.state
    body.keep(work.saved, state)
    body.fly(state, shape.inertia, dt)
    ahead, rise = floors.gained(floor, time, dt)
    state[X] -= ahead
    state[Z] -= rise
    ahead, rise = floors.quickening(floor, time, dt)
    state[VX] -= ahead
    state[VZ] -= rise
    body.rotation(state, work.turn)
    corner, level = body.lowest(shape.vertices, shape.links, work.turn, corner)
    return corner, state[Z] + level


@inlined
def approach(shape, work, floor, time, corner, gap, steps):
    """One step through the air, ended on the floor if it would go below; corner, gap and time taken."""
    state = work.state
    rate = math.sqrt(state[W] ** 2 + state[W + 1] ** 2 + state[W + 2] ** 2)
    quickest = abs(state[VZ]) + rate * shape.radius + 1e-9
    dt = min(max(gap / quickest, steps.flight), steps.turn / (rate + 1e-9), 0.5, floor.step)
    body.keep(state, work.saved)
    corner, after = gap_after(shape, work, floor, time, corner, dt)
    if after >= 0.0:
        return corner, after, dt
    early, late, above, below = 0.0, dt, max(gap, 0.0), after
    for _ in range(30):
        share = min(max(above / (above - below), 0.1), 0.9)
        dt = early + share * (late - early)
        corner, after = gap_after(shape, work, floor, time, corner, dt)
        if 0.0 <= after <= steps.tolerance:
            break
        if after > 0.0:
            early, above = dt, after
        else:
            late, below = dt, after
    return corner, after, dt


@inlined
def move(shape, work, corner, dt):
    """Move the saved positions at the present velocities over dt; lowest corner and its height."""
    state, saved = work.state, work.saved
    for k in range(3):
        state[k] = saved[k] + dt * state[VX + k]
    for k in range(4):
        state[body.Q + k] = saved[body.Q + k]
    body.rotate(state, state[W], state[W + 1], state[W + 2], dt)
    body.rotation(state, work.turn)
    corner, level = body.lowest(shape.vertices, shape.links, work.turn, corner)
    return corner, state[Z] + level


@inlined
def press_on(shape, work, floor, time, corner, count, friction, steps):
    """One step on the floor, ended where another corner lands; corner, gap and time taken."""
    state, whole = work.state, min(steps.contact, floor.step)
    ahead, rise = floors.quickening(floor, time, whole)
    before = body.moving_energy(state, shape.inertia)
    body.keep(state, work.saved)
    body.spin(state, shape.inertia, whole)
    state[VX] -= ahead
    state[VZ] -= whole + rise
    contact.hold(state, work.contacts, count, friction, steps.sweeps)
    resist(state, shape.inertia, steps.rolling, whole)
    corner, gap = move(shape, work, corner, whole)
    early, late, dt = 0.0, whole, whole
    while gap < -0.5 * steps.tolerance and late - early > 0.05 * whole:
        dt = 0.5 * (early + late)
        corner, gap = move(shape, work, corner, dt)
        if gap < -0.5 * steps.tolerance:
            late = dt
        elif gap > 0.5 * steps.tolerance:
            early = dt
        else:
            break
    win_nothing(shape, work, before, gap, -ahead / whole, -1.0 - rise / whole)
    return corner, max(gap, 0.0), dt


@inlined
def win_nothing(shape, work, before, gap, pull, press):
    """Lift a body that has sunk in; leave it no more energy than it had ``before`` and the forces gave it."""
    state = work.state
    left = before + pull * (state[X] - work.saved[X]) + press * (state[Z] - work.saved[Z])
    lift = max(-gap, 0.0)
    if press < 0.0:
        lift = min(lift, left / -press)
    state[Z] += lift
    body.slow_down(state, shape.inertia, left + press * lift)


@inlined
def resist(state, inertia, lever, dt):
    """Take the work of rolling resistance out of the rotation."""
    spinning = body.spin_energy(state, inertia)
    rate = math.sqrt(state[W] ** 2 + state[W + 1] ** 2 + state[W + 2] ** 2)
    if spinning > 0.0:
        scale = math.sqrt(max(1.0 - lever * rate * dt / spinning, 0.0))
        for k in range(3):
            state[W + k] *= scale


@inlined
def meet(shape, work, corner, restitution, friction, steps):
    """Corners on the floor, after their impact if they fall: how many, how fast they rise, if it was one."""
    state, contacts = work.state, work.contacts
    count = contact.touching(
        shape.vertices, shape.links, work.turn, state[Z], corner, steps.tolerance, work.seen, work.found
    )
    contact.levers(shape.vertices, shape.inertia, work.turn, work.found, count, contacts)
    rise = contact.steepest(state, contacts, count)
    if rise >= -steps.threshold:
        return count, rise, False
    contact.strike(shape.inertia, state, work.saved, contacts, count, restitution, friction, steps)
    return count, contact.steepest(state, contacts, count), True


@inlined
def go_on(shape, work, floor, time, corner, gap, count, rise, friction, steps):
    """One step of a body that touches the floor: off it, or on; corner, gap and time taken."""
    if rise > steps.threshold:
        return approach(shape, work, floor, time, corner, gap, steps)
    return press_on(shape, work, floor, time, corner, count, friction, steps)


@inlined
def start(shape, work):
    """Lowest corner of the body as it stands, and its height over the floor."""
    body.rotation(work.state, work.turn)
    corner, level = body.lowest(shape.vertices, shape.links, work.turn, 0)
    return corner, work.state[Z] + level
