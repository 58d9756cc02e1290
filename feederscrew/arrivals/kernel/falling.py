"""Compiled motion of one body from event to event: in the air, at impacts, and on the floor."""

import math
from typing import NamedTuple

import numpy as np

from feederscrew.arrivals.kernel import body, floor_contacts
from feederscrew.arrivals.kernel import floor_motion as floors
from feederscrew.arrivals.kernel.body import VX, W, X, Z
from feederscrew.arrivals.kernel.floor_contacts import Pairing, Scratch, Steps
from feederscrew.arrivals.kernel.floor_motion import Floor
from feederscrew.arrivals.rounded_hull import RoundedHull, Shape
from feederscrew.base import check
from feederscrew.base.arrays import Floats
from feederscrew.base.geometry.compiled import compiled, outlined, zero_rows

# Speed at which a point that touches may go on falling: a step errs by less, landings do not.
CREEP_SPEED = 1e-4


def scratch(shape: Shape, rows: int = 0) -> Scratch:
    """Make working arrays for a shape, with a trace of so many rows."""
    size = len(shape.solid.vertices)
    room = size + floor_contacts.FLAT_RIM_POINTS * len(shape.solid.rims)
    return Scratch(
        state=np.zeros(body.STATE),
        saved=np.zeros(body.STATE),
        ahead=np.zeros(body.STATE),
        turn=np.zeros(9),
        later=np.zeros(9),
        visited=np.zeros(size, bool),
        queue=np.zeros(size, int),
        spots=np.zeros((room, 3)),
        owners=np.zeros(room, int),
        contacts=zero_rows(floor_contacts.MAX_CONTACTS, floor_contacts.FLOOR_CONTACT),
        pressed=np.zeros(2),
        trace=np.zeros((rows, 1 + body.STATE)),
        rows=np.zeros(1, int),
    )


class Launched(NamedTuple):
    """How N bodies are let go, and how each of them and the floor meet."""

    states: Floats  # (N, STATE)
    restitutions: Floats  # (N,)
    frictions: Floats  # (N,)


def launched_one(state: Floats, restitution: float, friction: float) -> Launched:
    """Return one body that is let go in a state (STATE,), in arrays as the kernels know them."""
    return Launched(*(check.frozen(np.array([value], float)) for value in (state, restitution, friction)))


@compiled
def gap_after(
    solid: RoundedHull, work: Scratch, floor: Floor, time: float, corner: int, dt: float
) -> tuple[int, float]:
    """Fly from the saved state over ``dt`` [sqrt(L/g)]; return the corner to look on from and the height [L].

    Source: docs/resting.md, "The drop test".
    """
    state = work.state
    body.keep(work.saved, state)
    body.fly(state, solid.inertia, dt)
    ahead, forth, rise, up = floors.gained(floor, time, dt)
    state[X] -= ahead
    state[Z] -= rise
    u, v, w = body.velocity(state)
    body.set_velocity(state, u - forth, v, w - up)
    body.rotation(state, work.turn)
    corner, level = body.bottom(solid, work.turn, corner)
    return corner, state[Z] + level


@compiled
def approach(
    solid: RoundedHull, work: Scratch, floor: Floor, time: float, corner: int, gap: float, steps: Steps
) -> tuple[int, float, float]:
    """Take one step through the air, ended on the floor; return corner, gap [L] and time taken [sqrt(L/g)].

    No point comes down faster than ``down``, and what gravity adds, whatever way the body turns: all its
    rotational energy may come to be about the easiest axis.
    """
    state = work.state
    i, j, k = solid.inertia[0], solid.inertia[1], solid.inertia[2]
    quickest = math.sqrt(2.0 * body.spin_energy(state, solid.inertia) / min(i, j, k))
    down = quickest * solid.radius - body.velocity(state)[2]
    soonest = math.sqrt(down * down + 2.0 * max(gap, 0.0)) - down
    dt = min(max(soonest, steps.flight), steps.turn / (body.rate(state) + 1e-9))
    dt = min(min(dt, 0.5), floor.step)
    early, late, above, below, trial = 0.0, dt, max(gap, 0.0), 0.0, 0
    body.keep(state, work.saved)
    while True:
        corner, after = gap_after(solid, work, floor, time, corner, dt)
        trial += 1
        if (after >= 0.0 and (trial == 1 or after <= steps.tolerance)) or trial > 30:
            return corner, after, dt
        if after > 0.0:
            early, above = dt, after
        else:
            late, below = dt, after
        share = min(max(above / (above - below), 0.1), 0.9)
        dt = early + share * (late - early)


@compiled
def _press_on(
    solid: RoundedHull,
    work: Scratch,
    floor: Floor,
    time: float,
    corner: int,
    count: int,
    friction: float,
    steps: Steps,
) -> tuple[int, float, float]:
    """Take one step on the floor, to where another point lands; return corner, gap and time.

    Of first order in the step, as measured (benchmarks/convergence.py): positions follow the mean velocity
    and forces act half of the step ahead, but speeds are wanted at its end.
    """
    state, saved = work.state, work.saved
    whole = min(min(steps.contact, floor.step), steps.swing / (body.rate(state) + 1e-9))
    ahead, rise = floors.quickening(floor, time, whole)
    before = body.moving_energy(state, solid.inertia)
    body.keep(state, work.saved)
    floor_contacts.levers_ahead(solid, work, count, whole)
    body.turn_freely(state, solid.inertia, whole)
    u, v, w = body.velocity(state)
    body.set_velocity(state, u - ahead, v, w - (whole + rise))
    share = whole / work.pressed[1] if count == work.pressed[0] else 0.0
    floor_contacts.hold(state, work.contacts, count, friction, steps, share)
    work.pressed[0], work.pressed[1] = count, whole
    lever = steps.pivot
    for n in range(count):
        if work.owners[n] != floor_contacts.CORNER_OWNER:
            lever = steps.rolling
    # rolling resistance takes its work out of the rotation
    spinning = body.spin_energy(state, solid.inertia)
    if spinning > 0.0:
        scale = math.sqrt(max(1.0 - lever * body.rate(state) * whole / spinning, 0.0))
        for k in range(3):
            state[W + k] *= scale
    early, late, dt = 0.0, whole, whole
    while True:
        # move at the mean of saved and present velocities
        for k in range(3):
            state[k] = saved[k] + 0.5 * dt * (saved[VX + k] + state[VX + k])
        for k in range(4):
            state[body.Q + k] = saved[body.Q + k]
        p, q, r = saved[W] + state[W], saved[W + 1] + state[W + 1], saved[W + 2] + state[W + 2]
        body.rotate(state, 0.5 * p, 0.5 * q, 0.5 * r, dt)
        body.rotation(state, work.turn)
        corner, level = body.bottom(solid, work.turn, corner)
        gap = state[Z] + level
        if gap < -0.5 * steps.tolerance:
            late = dt
        elif dt < whole and gap > 0.5 * steps.tolerance:
            early = dt
        else:
            break
        if late - early <= 0.05 * whole:
            break
        dt = 0.5 * (early + late)
    # lift a body that sank in; leave it the energy it had and what forces gave
    pull, press = -ahead / whole, -1.0 - rise / whole
    left = before + pull * (state[X] - saved[X]) + press * (state[Z] - saved[Z])
    lift = max(-gap, 0.0)
    if press < 0.0:
        lift = min(lift, left / -press)
    state[Z] += lift
    moving, left = body.moving_energy(state, solid.inertia), left + press * lift
    if moving > left:  # velocities along the floor are scaled last
        u, v, w = body.velocity(state)
        along = 0.5 * (u * u + v * v)
        if along > left:
            scale = math.sqrt(max(left, 0.0) / along)
            u, v = scale * u, scale * v
        scale = math.sqrt(max(left - along, 0.0) / (moving - along)) if moving > along else 0.0
        body.set_velocity(state, u, v, scale * w)
        for k in range(3):
            state[W + k] *= scale
    return corner, max(gap, 0.0), dt


@outlined
def advance(
    solid: RoundedHull,
    work: Scratch,
    floor: Floor,
    time: float,
    corner: int,
    gap: float,
    pairing: Pairing,
    steps: Steps,
) -> tuple[int, float, float, int, bool]:
    """Take one step of the body: through the air, or on the floor after the impact if it falls.

    Returns corner, gap [L], time taken [sqrt(L/g)], points that touched the floor before, whether they
    struck it.
    """
    state, contacts, count, struck, rise = work.state, work.contacts, 0, False, math.inf
    if gap <= steps.tolerance:
        count = floor_contacts.touching(solid, work, state[Z], corner, steps.tolerance)
        floor_contacts.arms(work, count)
        rise = floor_contacts.steepest(state, contacts, count)
        struck = rise < -steps.threshold
        if struck or rise < -CREEP_SPEED:
            floor_contacts.levers(solid.inertia, work, count)
        if struck:
            floor_contacts.strike(solid.inertia, state, work.saved, contacts, count, pairing, steps)
            rise = floor_contacts.steepest(state, contacts, count)
            work.pressed[0] = 0.0
        elif rise < -CREEP_SPEED:
            floor_contacts.hold(state, contacts, count, pairing.friction, steps, 0.0)
            rise = work.pressed[0] = 0.0
    if rise > steps.threshold:
        work.pressed[0] = 0.0
        corner, gap, dt = approach(solid, work, floor, time, corner, gap, steps)
    else:
        corner, gap, dt = _press_on(solid, work, floor, time, corner, count, pairing.friction, steps)
    return corner, gap, dt, count, struck


@compiled
def start(solid: RoundedHull, work: Scratch) -> tuple[int, float]:
    """Return the corner from which to look for the body's lowest point as it stands, and its height [L].

    Source: docs/resting.md, "The drop test".
    """
    work.pressed[0] = 0.0
    body.rotation(work.state, work.turn)
    corner, level = body.bottom(solid, work.turn, 0)
    return corner, work.state[Z] + level
