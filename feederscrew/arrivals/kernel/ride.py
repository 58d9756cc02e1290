"""Compiled ride: one body on a vibrating floor, looked at again and again."""

import math
from typing import NamedTuple

import numpy as np

from feederscrew.arrivals.kernel import body
from feederscrew.arrivals.kernel.body import W, X, Y
from feederscrew.arrivals.kernel.falling import (
    Launched,
    Pairing,
    Scratch,
    Steps,
    advance,
    launched_one,
    start,
)
from feederscrew.arrivals.kernel.floor_motion import Floor
from feederscrew.arrivals.kernel.one_drop import STEADY_ROLL_SHARE, UNSETTLED, face_below, rolling_energy
from feederscrew.arrivals.rounded_hull import Shape
from feederscrew.base.arrays import Floats, Ints
from feederscrew.base.geometry.compiled import compiled, entry

SURE_BARRIER_SHARE = 0.5  # of the barrier: what tilt and spin of a part that lies on a face may hold together
CALM_PERIODS = 3  # periods for which a part must lie on one face to stay, on a floor that throws nothing up
CALM_ROLLING_PERIODS = 15  # ... and on a face on which it rolls
THROWN_CALM_PERIODS = 5  # ... on a floor that throws parts up: 1 of 5,600 left its face later
THROWN_SWING_SHARE = 0.1  # of the barrier: what tilt and spin hold then at every look
THROWN_ROLLING_SHARE = 0.25  # of ``kick``: the barrier of a face on which it rolls, at least
MAX_STEPS_FACTOR = 50  # steps for each that a floor without events would take


class RideLooks(NamedTuple):
    """What is seen of N bodies at K looks."""

    looks: Floats  # (K,) times at which to look, ascending
    faces: Ints  # (N, K) int, face it lies on, UNSETTLED while it may be tipping over
    places: Floats  # (N, K, 2) of its centre of mass over the floor, NaN where no look was taken
    taken: Ints  # (N,) int, looks taken; fewer than K only where the motion took far too many steps


def empty_looks(count: int, looks: Floats) -> RideLooks:
    """Return what is to be filled in of so many bodies."""
    faces = np.full((count, len(looks)), UNSETTLED)
    return RideLooks(looks, faces, np.full((*faces.shape, 2), np.nan), np.zeros(count, int))


@compiled
def lying(shape: Shape, state: Floats, turn: Floats, corner: int, share: float) -> int:
    """Return the face on which the body of a state (13,) lies, travelling or spinning, or UNSETTLED.

    What tilt and spin hold together is below a ``share`` of the barrier.
    """
    face = face_below(shape, turn, corner)
    if face == UNSETTLED:
        return UNSETTLED
    # rotational energy without the spin about the vertical
    around, energy = state[W] * turn[6] + state[W + 1] * turn[7] + state[W + 2] * turn[8], 0.0
    for k in range(3):
        rocks = state[W + k] - around * turn[6 + k]
        energy += 0.5 * shape.solid.inertia[k] * rocks * rocks
    corner, level = body.bottom(shape.solid, turn, corner)
    held = energy - level - shape.heights[face]
    if shape.rolls[face]:
        held -= rolling_energy(shape, state, turn, face)
    return face if held < share * shape.barriers[face] else UNSETTLED


@compiled
def _held_fast(shape: Shape, state: Floats, turn: Floats, corner: int, kick: float) -> int:
    """The face that the floor, which gives a part ``kick`` [g L] at most, cannot tip it off."""
    total = body.energy(state, shape.solid.inertia) + kick
    if total >= shape.ceiling:
        return UNSETTLED
    face = face_below(shape, turn, corner)
    if face == UNSETTLED:
        return UNSETTLED
    share, above = 1.0, total - shape.heights[face]
    if shape.rolls[face]:
        share = STEADY_ROLL_SHARE
        above -= rolling_energy(shape, state, turn, face)
    return face if above < share * shape.barriers[face] else UNSETTLED


@compiled
def _calm_enough(shape: Shape, thrown: bool, face: int, calm: int, kick: float) -> bool:
    """Return whether a part that lay on a face for so many periods stays."""
    if face == UNSETTLED:
        return False
    if shape.rolls[face]:
        sure = not thrown or shape.barriers[face] >= THROWN_ROLLING_SHARE * kick
        return sure and calm >= CALM_ROLLING_PERIODS
    return calm >= (THROWN_CALM_PERIODS if thrown else CALM_PERIODS)


@entry
def ride_all(
    shape: Shape,
    work: Scratch,
    floor: Floor,
    launched: Launched,
    steps: Steps,
    record: RideLooks,
    kick: float,
) -> None:
    """Let all N bodies that are launched ride, and fill in what is seen of them.

    With a finite ``kick``, a part that so much energy cannot tip any more, or that has come to lie still,
    stays on its face and where it is at all looks that are left.
    """
    state, looks = work.state, record.looks
    most = int(MAX_STEPS_FACTOR * looks[-1] / min(steps.contact, floor.step))
    period = 2.0 * math.pi / floor.rate if floor.rate > 0.0 else math.inf
    thrown = (floor.up + 4.0 * floor.second_up) * floor.rate * floor.rate >= 1.0
    swing = THROWN_SWING_SHARE if thrown else SURE_BARRIER_SHARE
    for n in range(len(launched.states)):
        pairing = Pairing(launched.restitutions[n], launched.frictions[n])
        for k in range(body.STATE):
            state[k] = launched.states[n, k]
        time, look, rests, periods, calm, before, stays = 0.0, 0, 0, 1, 0, UNSETTLED, UNSETTLED
        corner, gap = start(shape.solid, work)
        for _ in range(most):
            if kick < math.inf and time >= periods * period:
                periods += 1
                face = lying(shape, state, work.turn, corner, swing)
                calm, before = (calm + 1 if face == before else 0), face
                if _calm_enough(shape, thrown, face, calm, kick):
                    stays = face
            while look < len(looks) and (time >= looks[look] or stays != UNSETTLED):
                face, late = stays, 0.0
                if stays == UNSETTLED:
                    face = lying(shape, state, work.turn, corner, SURE_BARRIER_SHARE)
                    late = time - looks[look]
                record.faces[n, look] = face
                u, v, _ = body.velocity(state)
                record.places[n, look, 0] = state[X] - late * u
                record.places[n, look, 1] = state[Y] - late * v
                look += 1
            if look == len(looks):
                break
            corner, gap, dt, count, struck = advance(
                shape.solid, work, floor, time, corner, gap, pairing, steps
            )
            time += dt
            rests = 0 if struck else rests + min(count, 1)
            if kick < math.inf and count > 0 and rests % (2 if count >= 3 else 8) == 0:
                stays = _held_fast(shape, state, work.turn, corner, kick)
        record.taken[n] = look


def ride(
    shape: Shape, work: Scratch, floor: Floor, pairing: Pairing, steps: Steps, looks: Floats
) -> RideLooks:
    """Follow one body on a moving floor.

    The ``state`` of ``work`` holds the start, relative to the floor, and the end afterwards; ``looks`` (K,)
    [sqrt(L/g)]: times at which to look, ascending. Returns the RideLooks of the one body.
    Source: docs/resting.md, "On the vibrating plate".
    """
    record = empty_looks(1, looks)
    ride_all(shape, work, floor, launched_one(work.state, *pairing), steps, record, math.inf)
    return record
