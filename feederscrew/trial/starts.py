"""How parts begin: laid on the track as they lie, or falling onto it."""

from typing import Any

import numpy as np

from feederscrew.dropping.kernel import body
from feederscrew.dropping.launch_conditions import sample
from feederscrew.geometry import vectors
from feederscrew.trial import part_poses

MAX_START_PLAY_M = 5e-5  # [m] from the wall, at most, where a part is laid down
MAX_START_HEADING = np.radians(0.1)  # [rad] of its heading, at most
START_TILT = np.radians(
    0.2
)  # [rad] out of level: standard deviation, about any axis along the track's surface
WALL_CLEARANCE = 1.02  # of the part's radius: as near to the wall as its centre of mass may come down


def laid_down(
    bowl,
    orientations,
    entered,
    solid,
    principal,
    length,
    seed,
    *,
    play=MAX_START_PLAY_M,
    turn=MAX_START_HEADING,
    tilt=START_TILT,
) -> tuple[Any, ...]:
    """Return parts laid on the track, a little from the wall, askew and tilted, at any phase of the drive.

    Each lies out of level by ``tilt``, drawn from a normal distribution, about an axis in any direction along
    the track's surface. What is exactly level keeps a steady state that the least tilt ends: docs/trial.md.

    Parameters
    ----------
    bowl : Bowl
    orientations : sequence of Orientation
        Of the part.
    entered : (N,) int
        In which of them each is laid.
    solid : TrueSolid
    principal : (3, 3) float [1]
    length : float [m]
        Both from ``solid_of``.
    seed : int
        Each part draws its own numbers.
    play : float [m]
        From the wall, at most.
    turn : float [rad]
        Of its heading, at most to either side.
    tilt : float [rad]
        Standard deviation.

    Returns
    -------
    states : (N, 13) float [L, sqrt(g L), 1, sqrt(g/L)]
        At the place 0, the lowest corner on the track.
    times : (N,) float [s]
    """
    states, times = np.zeros((len(entered), body.STATE)), np.zeros(len(entered))
    for n, k in enumerate(entered):
        rng = np.random.default_rng((seed, n))
        away, askew, phase = rng.random(3)
        states[n] = part_poses.pose_on_track(
            orientations[k], principal, length, bowl.track, place=0.0,
            turn=turn * (2.0 * askew - 1.0),
        )  # fmt: skip
        states[n] = tilted(states[n], solid.corners, rng, tilt)
        states[n] = clear(
            states[n], solid, orientations[k].track, length, play * away, orientations[k].wall_leans
        )
        times[n] = phase / bowl.drive.frequency
    return states, times


def tilted(state, corners, rng, spread=START_TILT):
    """Return a part's state (13,) out of level about a level axis, its lowest corner on the track.

    Parameters
    ----------
    state : (13,) float [L, sqrt(g L), 1, sqrt(g/L)]
    corners : (C, 3) float [L]
    rng : numpy.random.Generator
        Two numbers of it are drawn.
    spread : float [rad]
        Standard deviation of how far it is out of level.
    """
    angle, direction = spread * rng.standard_normal(), 2.0 * np.pi * rng.random()
    x, y, c, s = np.cos(direction), np.sin(direction), np.cos(angle), np.sin(angle)
    turn = np.array(
        [
            [c + x * x * (1.0 - c), x * y * (1.0 - c), y * s],
            [x * y * (1.0 - c), c + y * y * (1.0 - c), -x * s],
            [-y * s, x * s, c],
        ]
    )
    out = np.array(state)
    out[body.Q : body.Q + 4] = part_poses.quaternion(vectors.product(turn, part_poses.matrix(state)))
    out[body.Z] -= lowest(corners, out)
    return out


def clear(state, solid, track, length, play, leans=0.0):
    """Return a part's state moved along the track's width until it is ``play`` [m] from the wall.

    The wall is upright, or ``leans`` [rad] back from that beside a groove.
    """
    spots = state[:3] + vectors.product(solid.corners, part_poses.matrix(state).T)
    radius, off = track.radius / length, track.bank - leans
    lean, up = np.sin(off), np.cos(off)
    gap = up * (radius - np.hypot(spots[:, 0], radius - spots[:, 1])) - lean * spots[:, 2]
    out = state[:2] - [0.0, radius]
    state[:2] += out / np.hypot(*out) * (gap.min() - play / length) / up
    return state


def falling(bowl, launch, shape, count, length, seed) -> tuple[Any, ...]:
    """Return parts that fall onto the track as a launch says, anywhere over its width.

    Parameters
    ----------
    bowl : Bowl
    launch : Launch
        Its height, spin and speed; friction and restitution are those of the bowl.
    shape : Shape
        Of the part, its axes those of ``solid_of``.
    count : int
    length : float [m]
    seed : int

    Returns
    -------
    states : (N, 13) float [L, sqrt(g L), 1, sqrt(g/L)]
        At the place 0.
    times : (N,) float [s]
    """
    rng = np.random.default_rng((seed, count))
    states = np.array(sample(launch, shape, count, rng).states)
    place, phase = np.random.default_rng((seed, count, 1)).random((2, count))
    near = WALL_CLEARANCE * shape.solid.radius
    states[:, body.Y] = near + place * max(bowl.track.width / length - near, 0.0)
    return states, phase / bowl.drive.frequency


def lowest(corners, state):
    """Return the height [L] of the lowest of the corners (C, 3) [L] of a part in a state (13,)."""
    return state[body.Z] + vectors.product(corners, part_poses.matrix(state)[2]).min()
