"""Compiled steps of one part in the bowl's frame.

The frame is fixed to the bowl: the track is z = 0, the wall a cylinder that is tangent to x at the origin,
with its axis at (0, radius). The drive is a force that changes with time, and gravity turns with the place.
Everything is without dimensions, as in `feederscrew.dropping.kernel`.
"""

import math
from typing import NamedTuple

import numpy as np

from feederscrew.dropping.kernel import body
from feederscrew.dropping.kernel import floor_motion as floors
from feederscrew.dropping.kernel.body import VX, VY, VZ, W, X, Y
from feederscrew.geometry.compiled import compiled, shared
from feederscrew.trial.kernel import contact, edges, search

REACH = 2e-3  # how far ahead contacts are looked for, beside the way of two steps
SLOP = 2e-4  # depth that is left alone
LIFT, MOST = 0.1, 0.01  # of a greater depth, taken back in a step; of so much at most
STILL = 1e-5  # speed along a contact below which it sticks while static friction holds
AT_ONCE = 0.02  # of a step: what happens sooner happens at its start


class StageSurface(NamedTuple):
    """What a part meets at one station, in units of its length; P plates, B borders."""

    radius: float  # of the wall
    gravity: np.ndarray  # (3,) ahead, from the wall inwards, up
    upright: np.ndarray  # (2,) inwards and up: the bowl's axis, along which it moves and the wall stands
    plates: np.ndarray  # (P, 17) rows as ``search`` names their columns
    borders: np.ndarray  # (B, 10) start, end, normal away, corner at the start, end of drawing, normal before
    friction: np.ndarray  # (5,) static and kinetic ahead, static and kinetic back, wall
    restitution: float
    threshold: float  # approach speed from which a contact rebounds
    sweeps: int
    converged: float
    exit: float  # way along the wall at which a part has passed
    drop: float  # by which the track lies lower there
    under: float  # height of the centre of mass below which what comes there has fallen below the track
    longest: float  # time after which it is given up
    patience: float  # time in which a part must get on
    progress: float  # ... so far along the wall, or down
    back: float  # way along the wall, behind which a part has gone back


@compiled
def forces(surface, floor, time, dt, state):
    """Return the changes of a part's velocity by gravity and by the drive over dt, and of the bowl's spin."""
    x, y = state[X], surface.radius - state[Y]
    off = math.sqrt(x * x + y * y)
    c, s = y / off, x / off
    ahead, rise = floors.quickening(floor, time, dt)
    along = dt * surface.gravity[0] - ahead * off / surface.radius
    across = dt * surface.gravity[1] - rise * surface.upright[0]
    upward = dt * surface.gravity[2] - rise * surface.upright[1]
    return c * along - s * across, s * along + c * across, upward, ahead / surface.radius


@compiled
def pull(surface, floor, time, dt, work):
    """Change velocities by gravity and by the drive over dt."""
    state = work.state
    u, v, w, spin = forces(surface, floor, time, dt, state)
    state[VX] += u
    state[VY] += v
    state[VZ] += w
    for k in range(3):
        state[W + k] -= spin * work.turn[6 + k]


@shared
def found(surface, solid, work, reach):
    """Find every contact of the part as it is; how many."""
    state, turn, contacts = work.state, work.turn, work.contacts
    x, y = state[X], surface.radius - state[Y]
    off = math.sqrt(x * x + y * y)
    tangent = work.tangent
    tangent[0], tangent[1] = y / off, x / off
    search.placed(solid.corners, turn, work.spots)
    count = 0
    if off + solid.radius > (surface.radius - reach) * surface.upright[1]:
        count = search.on_wall(
            work.shown, work.spots, state, turn, solid.inertia, surface, tangent, reach, work.low,
            contacts, count,
        )  # fmt: skip
    least = 0.0
    for k in range(len(surface.plates)):
        plate = surface.plates[k]
        back = plate[search.BACK] > 0.5
        if back and least > reach - plate[search.DEPTH]:
            continue
        least = search.seen(plate, state, work.spots, work.shown)
        if least > reach:
            continue
        lows = edges.low_edges(solid, work.shown, reach, work.edges, work.box)
        nears = edges.near_borders(plate, surface.borders, work.box, reach, work.near)
        if not back:
            count = search.corners_on(
                plate, surface.borders, work.shown, work.spots, turn, solid, tangent, reach, nears,
                work.low, contacts, count,
            )  # fmt: skip
            if nears and least <= -plate[search.ROUNDED]:
                count = edges.edges_on_posts(
                    plate, surface.borders, nears, solid, turn, reach, work, contacts, count
                )
        if nears:
            count = edges.edges_on(
                plate, surface.borders, nears, lows, solid, turn, reach, work, contacts, count
            )
            count = edges.faces_on(
                plate, surface.borders, nears, solid, state, turn, reach, work, contacts, count
            )
    return count


@compiled
def wanted(surface, work, count, dt):
    """Say how each contact shall leave a step, with which friction.

    Returns
    -------
    depth of the deepest, whether one strikes, share of the step after which the first of them does
    """
    deepest, strikes, share = 0.0, False, 1.0
    for n in range(count):
        row = work.contacts[n]
        gap, fall = row[contact.GAP], contact.speed(work.saved, row, contact.NORMAL)
        deepest = min(deepest, gap)
        row[contact.WANTED] = -max(gap, 0.0) / dt
        if fall < -surface.threshold and gap + fall * dt < 0.0:
            strikes = True
            share = min(share, max(gap, 0.0) / (-fall * dt))
            row[contact.WANTED] = -surface.restitution * fall
        slides = math.hypot(contact.speed(work.saved, row, 0), contact.speed(work.saved, row, 1)) > STILL
        if row[contact.WALL] > 0.5:
            row[contact.AHEAD] = row[contact.BACK] = surface.friction[4]
        else:
            row[contact.AHEAD] = surface.friction[int(slides)]
            row[contact.BACK] = surface.friction[2 + int(slides)]
    return deepest, strikes, share


@compiled
def reversal(work, count):
    """Return the share of a step after which sliding comes to a stand, if it does; else 1.

    Of the contact that slides fastest. What friction did less than its most against the sliding is what it
    did after the stand: without that the contact would have gone on to slide back so much faster.
    """
    first, before = -1, STILL
    for n in range(count):
        row = work.contacts[n]
        if row[contact.IMPULSE + 2] > 0.0:
            quick = math.hypot(contact.speed(work.saved, row, 0), contact.speed(work.saved, row, 1))
            if quick > before:
                first, before = n, quick
    if first < 0:
        return 1.0
    row = work.contacts[first]
    a, b = contact.speed(work.saved, row, 0) / before, contact.speed(work.saved, row, 1) / before
    after = a * contact.speed(work.state, row, 0) + b * contact.speed(work.state, row, 1)
    if after > STILL:
        return 1.0
    spared = 0.0
    for n in range(count):
        row = work.contacts[n]
        most = row[contact.BACK] if a < 0.0 else row[contact.AHEAD]
        spared += most * row[contact.IMPULSE + 2] + a * row[contact.IMPULSE] + b * row[contact.IMPULSE + 1]
    return before / (before - after + max(spared, 0.0))


@compiled
def lift(surface, solid, floor, work, time, dt, count):
    """Take a part of what is too deep back, without a speed, as far as the part's motion can pay for it."""
    state, push = work.state, work.push
    for k in range(body.STATE):
        push[k] = 0.0
    for n in range(count):
        row = work.contacts[n]
        row[contact.WANTED] = LIFT * min(max(-row[contact.GAP] - SLOP, 0.0), MOST)
    contact.solve(push, work.contacts, count, False, surface.sweeps, surface.converged, 0.0)
    work.memory[0] = -1.0
    u, v, w, _ = forces(surface, floor, time, dt, work.saved)
    cost = max(-(u * push[VX] + v * push[VY] + w * push[VZ]) / dt, 0.0)
    moving = body.moving_energy(state, solid.inertia)
    share = moving / cost if cost > moving else 1.0
    for k in range(3):
        state[k] += share * push[VX + k]
    body.rotate(state, push[W], push[W + 1], push[W + 2], share)
    _no_more(state, solid.inertia, moving - share * cost)


@compiled
def pushed(surface, solid, floor, work, time, dt, count):
    """Compute velocities after a step: gravity, drive and contacts.

    Returns
    -------
    depth of the deepest contact, whether one strikes, share of the step after which its course changes
    """
    state, inertia = work.state, solid.inertia
    body.turn_freely(state, inertia, dt)
    pull(surface, floor, time, dt, work)
    if count == 0:
        return 0.0, False, 1.0
    deepest, strikes, share = wanted(surface, work, count, dt)
    if strikes and share > AT_ONCE:
        return deepest, strikes, share
    limit = body.moving_energy(state, inertia)
    warm = 0.0 if strikes or count != work.memory[0] else dt / work.memory[1]
    contact.solve(state, work.contacts, count, True, surface.sweeps, surface.converged, warm)
    work.memory[0], work.memory[1] = -1.0 if strikes else count, dt
    share = reversal(work, count)
    _no_more(state, inertia, limit)
    return deepest, strikes, share


@compiled
def step(surface, solid, floor, work, time, dt):
    """Take one step of the part, or the share of it up to where it strikes or its sliding turns round.

    Returns
    -------
    depth of its deepest contact, time taken
    """
    state, saved = work.state, work.saved
    body.rotation(state, work.turn)
    quick = math.sqrt(state[VX] ** 2 + state[VY] ** 2 + state[VZ] ** 2) + solid.radius * body.rate(state)
    count = found(surface, solid, work, REACH + 2.0 * dt * quick)
    body.keep(state, saved)
    deepest, strikes, share = pushed(surface, solid, floor, work, time, dt, count)
    if AT_ONCE < share < 1.0 - AT_ONCE:
        dt *= share
        body.keep(saved, state)
        deepest, strikes, share = pushed(surface, solid, floor, work, time, dt, count)
    share = 1.0 if strikes else 0.5
    for k in range(3):
        state[k] += dt * (share * state[VX + k] + (1.0 - share) * saved[VX + k])
    p = share * state[W] + (1.0 - share) * saved[W]
    q = share * state[W + 1] + (1.0 - share) * saved[W + 1]
    r = share * state[W + 2] + (1.0 - share) * saved[W + 2]
    body.rotate(state, p, q, r, dt)
    if deepest < -SLOP:
        lift(surface, solid, floor, work, time, dt, count)
    return deepest, dt


@compiled
def _no_more(state, inertia, limit):
    """Scale all velocities so that the kinetic energy is at most ``limit``."""
    moving = body.moving_energy(state, inertia)
    if moving > limit:
        scale = math.sqrt(max(limit, 0.0) / moving)
        for k in range(3):
            state[VX + k] *= scale
            state[W + k] *= scale
