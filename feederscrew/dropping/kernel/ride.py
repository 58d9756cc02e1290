"""Compiled ride: one body on a vibrating floor, looked at again and again."""

import math

import numpy as np

from feederscrew import check
from feederscrew.dropping.kernel import body
from feederscrew.dropping.kernel.body import VX, VY, W, X, Y
from feederscrew.dropping.kernel.falling import advance, start
from feederscrew.dropping.kernel.one_drop import STEADY, UNSETTLED, face_below, rolling_energy
from feederscrew.geometry.compiled import compiled, entry

SURE = 0.5  # of the barrier: what tilt and spin of a part that lies on a face may hold together
CALM = 3  # periods for which a part must lie on one face to stay, on a floor that throws nothing up
ROLLING = 15  # ... and on a face on which it rolls
PATIENCE = 50  # steps for each that a floor without events would take


@compiled
def lying(shape, state, turn, corner):
    """Return the face on which the body of a state (13,) lies, travelling or spinning, or UNSETTLED."""
    face = face_below(shape, turn, corner)
    if face == UNSETTLED:
        return UNSETTLED
    corner, level = body.bottom(shape.solid, turn, corner)
    held = rocking_energy(shape, state, turn) - level - shape.heights[face]
    if shape.rolls[face]:
        held -= rolling_energy(shape, state, turn, face)
    return face if held < SURE * shape.barriers[face] else UNSETTLED


@compiled
def rocking_energy(shape, state, turn):
    """Return the rotational energy [g L] of a state (13,) without the spin about the vertical."""
    around = state[W] * turn[6] + state[W + 1] * turn[7] + state[W + 2] * turn[8]
    energy = 0.0
    for k in range(3):
        rocks = state[W + k] - around * turn[6 + k]
        energy += 0.5 * shape.solid.inertia[k] * rocks * rocks
    return energy


@compiled
def held_fast(shape, state, turn, corner, kick):
    """Return the face that the floor, which gives a part ``kick`` [g L] at most, cannot tip it off."""
    total = body.energy(state, shape.solid.inertia) + kick
    if total >= shape.ceiling:
        return UNSETTLED
    face = face_below(shape, turn, corner)
    if face == UNSETTLED:
        return UNSETTLED
    share = STEADY if shape.rolls[face] else 1.0
    above = total - shape.heights[face]
    if shape.rolls[face]:
        above -= rolling_energy(shape, state, turn, face)
    return face if above < share * shape.barriers[face] else UNSETTLED


@compiled
def calm_enough(shape, floor, face, calm):
    """Tell whether a part that lay on a face for so many periods stays, on a floor that throws nothing up."""
    if face == UNSETTLED or floor.up * floor.rate * floor.rate >= 1.0:
        return False
    return calm >= (ROLLING if shape.rolls[face] else CALM)


@entry
def ride_all(shape, work, floor, starts, restitutions, frictions, steps, looks, faces, places, taken, kick):
    """Ride every row of (N, 13) starts; fills (N, K) faces, (N, K, 2) places and (N,) looks taken.

    With a finite ``kick``, a part that so much energy cannot tip any more, or that has come to lie still on
    a floor that throws nothing up, stays on its face and where it is at all looks that are left.
    """
    state, most = work.state, int(PATIENCE * looks[-1] / min(steps.contact, floor.step))
    period = 2.0 * math.pi / floor.rate if floor.rate > 0.0 else math.inf
    for n in range(len(starts)):
        for k in range(body.STATE):
            state[k] = starts[n, k]
        time, look, rests, periods, calm, before, stays = 0.0, 0, 0, 1, 0, UNSETTLED, UNSETTLED
        corner, gap = start(shape.solid, work)
        for _ in range(most):
            if kick < math.inf and time >= periods * period:
                periods += 1
                face = lying(shape, state, work.turn, corner)
                calm, before = (calm + 1 if face == before else 0), face
                if calm_enough(shape, floor, face, calm):
                    stays = face
            while look < len(looks) and (time >= looks[look] or stays != UNSETTLED):
                here = stays != UNSETTLED
                faces[n, look] = stays if here else lying(shape, state, work.turn, corner)
                late = 0.0 if here else time - looks[look]
                places[n, look, 0] = state[X] - late * state[VX]
                places[n, look, 1] = state[Y] - late * state[VY]
                look += 1
            if look == len(looks):
                break
            corner, gap, dt, count, struck = advance(
                shape.solid, work, floor, time, corner, gap, restitutions[n], frictions[n], steps
            )
            time += dt
            rests = 0 if struck else rests + min(count, 1)
            if kick < math.inf and count > 0 and rests % (2 if count >= 3 else 8) == 0:
                stays = held_fast(shape, state, work.turn, corner, kick)
        taken[n] = look


def ride(shape, work, floor, restitution, friction, steps, looks, faces, places):
    """Follow one body on a moving floor.

    Source: docs/resting.md, "On the vibrating plate".

    Parameters
    ----------
    shape : Shape
    work : Scratch
        Its ``state`` holds the start, relative to the floor, and the end afterwards.
    floor : Floor
    restitution, friction : float [1]
    steps : Steps
    looks : (K,) float [sqrt(L/g)]
        Times at which to look, ascending.
    faces : (K,) int
        Filled with the face it lies on, UNSETTLED while it may be tipping over.
    places : (K, 2) float [L]
        Filled with where its centre of mass is over the floor.

    Returns
    -------
    int
        Looks taken; fewer than K only where the motion takes far more steps than it should.
    """
    given = (check.frozen(np.array(one, float)) for one in ([work.state], [restitution], [friction]))
    taken = np.zeros(1, int)
    ride_all(shape, work, floor, *given, steps, looks, faces[None], places[None], taken, math.inf)
    return int(taken[0])
