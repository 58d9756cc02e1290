"""Compiled ride: one body on a vibrating floor, looked at again and again."""

from feederscrew.dropping.kernel import body
from feederscrew.dropping.kernel.body import VX, VY, W, X, Y
from feederscrew.dropping.kernel.drop import UNSETTLED, face_below, rolling_energy
from feederscrew.dropping.kernel.motion import advance, start
from feederscrew.geometry.compiled import compiled

SURE = 0.5  # of the barrier: what tilt and spin of a part that lies on a face may hold together
PATIENCE = 50  # steps for each that a floor without events would take


@compiled
def lying(shape, state, turn, corner):
    """Face on which the body lies, however it travels, hops or spins; UNSETTLED while it may be tipping."""
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
    """Rotational energy without the spin about the vertical."""
    around = state[W] * turn[6] + state[W + 1] * turn[7] + state[W + 2] * turn[8]
    energy = 0.0
    for k in range(3):
        energy += 0.5 * shape.solid.inertia[k] * (state[W + k] - around * turn[6 + k]) ** 2
    return energy


@compiled
def ride(shape, work, floor, restitution, friction, steps, looks, faces, places):
    """Follow one body on a moving floor.

    Parameters
    ----------
    shape : Shape
    work : Scratch
        Its ``state`` holds the start, relative to the floor, and the end afterwards.
    floor : Floor
    restitution, friction : float
    steps : Steps
    looks : (K,) float
        Times at which to look, ascending.
    faces : (K,) int
        Filled with the face it lies on, UNSETTLED while it may be tipping over.
    places : (K, 2) float
        Filled with where its centre of mass is over the floor.

    Returns
    -------
    int
        Looks taken; fewer than K only where the motion takes far more steps than it should.
    """
    time, look = 0.0, 0
    corner, gap = start(shape.solid, work)
    for _ in range(int(PATIENCE * looks[-1] / min(steps.contact, floor.step))):
        while look < len(looks) and time >= looks[look]:
            faces[look] = lying(shape, work.state, work.turn, corner)
            late = time - looks[look]
            places[look, 0] = work.state[X] - late * work.state[VX]
            places[look, 1] = work.state[Y] - late * work.state[VY]
            look += 1
        if look == len(looks):
            break
        corner, gap, dt, _, _ = advance(
            shape.solid, work, floor, time, corner, gap, restitution, friction, steps
        )
        time += dt
    return look


@compiled
def ride_all(shape, work, floor, starts, restitutions, frictions, steps, looks, faces, places, taken):
    """Ride every row of (N, 13) starts; fills (N, K) faces, (N, K, 2) places and (N,) looks taken."""
    for n in range(len(starts)):
        for k in range(body.STATE):
            work.state[k] = starts[n, k]
        taken[n] = ride(shape, work, floor, restitutions[n], frictions[n], steps, looks, faces[n], places[n])
