"""Poses of parts and their starts: laid on the track or falling onto it, moved about the bowl's axis.

A state (13,) is without dimensions: [L, sqrt(g L), 1, sqrt(g/L)].
"""

from collections.abc import Sequence

import numpy as np

from feederscrew.arrivals.kernel import body
from feederscrew.arrivals.launch_conditions import Launch, sample
from feederscrew.arrivals.rounded_hull import Shape
from feederscrew.base.arrays import Floats, Ints, Points
from feederscrew.base.geometry import vectors
from feederscrew.bowl.record import Bowl, Track
from feederscrew.sorting.orientations import Orientation
from feederscrew.sorting.tooled_track import along_wall
from feederscrew.trials.kernel.workspace import TrueSolid

State = Floats  # (13,)
States = Floats  # (N, 13)

MAX_START_PLAY_M = 5e-5  # from the wall, at most, where a part is laid down
MAX_START_HEADING = np.radians(0.1)  # [rad] of its heading, at most
START_TILT = np.radians(0.2)  # [rad] out of level: standard deviation, about any axis along the surface
WALL_CLEARANCE = 1.02  # of the part's radius: as near to the wall as its centre of mass may come down


def lay_down(
    bowl: Bowl,
    orientations: Sequence[Orientation],
    rows: Ints,
    solid: TrueSolid,
    principal: Floats,
    length: float,
    seed: int,
    *,
    play: float = MAX_START_PLAY_M,
    turn: float = MAX_START_HEADING,
    tilt: float = START_TILT,
) -> tuple[Floats, Floats]:
    """Return parts laid on the track, a little from the wall, askew and tilted, at any phase of the drive.

    Each lies out of level by an angle drawn from a normal distribution, about an axis in any direction along
    the track's surface. What is exactly level keeps a steady state that the least tilt ends: docs/trial.md.

    Parameters
    ----------
    bowl : Bowl
    orientations : sequence of Orientation
    rows : (N,) int
        The orientation in which each part is laid.
    solid : TrueSolid
        The part, as ``solid_of`` returns it with its principal axes and its unit of length.
    principal : (3, 3) float [1]
    length : float [m]
    seed : int
        From it each part draws its own numbers.
    play : float [m], optional
        From the wall, at most.
    turn : float [rad], optional
        Of its heading, at most to either side.
    tilt : float [rad], optional
        Standard deviation of its angle out of level.

    Returns
    -------
    states : (N, 13) float [L, sqrt(g L), 1, sqrt(g/L)]
        At the place 0, at rest, the lowest corner on the track.
    times : (N,) float [s]
        Within one period of the drive: the phase.
    """
    states, times = np.zeros((len(rows), body.STATE)), np.zeros(len(rows))
    for n, k in enumerate(rows):
        rng = np.random.default_rng((seed, n))
        away, askew, phase = rng.random(3)
        orientation, askew = orientations[k], turn * (2.0 * askew - 1.0)
        state = pose_on_track(orientation, principal, length, bowl.track, place=0.0, turn=askew)
        state = tilt_state(state, solid.corners, rng, tilt)
        states[n] = set_play(state, solid, orientation.track, length, play * away, orientation.wall_leans)
        times[n] = phase / bowl.drive.frequency
    return states, times


def tilt_state(state: State, corners: Points, rng: np.random.Generator, spread: float = START_TILT) -> State:
    """Return a part's state out of level about a level axis, its lowest corner on the track.

    Parameters
    ----------
    state : (13,) float [L, sqrt(g L), 1, sqrt(g/L)]
    corners : (C, 3) float [L]
        Of the part, in its own axes.
    rng : numpy.random.Generator
        Two numbers are drawn.
    spread : float [rad], optional
        Standard deviation of the tilt.

    Returns
    -------
    (13,) float [L, sqrt(g L), 1, sqrt(g/L)]
    """
    angle, direction = spread * rng.standard_normal(), 2.0 * np.pi * rng.random()
    x, y, c, s = np.cos(direction), np.sin(direction), np.cos(angle), np.sin(angle)
    xy = x * y * (1.0 - c)
    turn = np.array(
        [[c + x * x * (1.0 - c), xy, y * s], [xy, c + y * y * (1.0 - c), -x * s], [-y * s, x * s, c]]
    )
    out = np.array(state)
    out[body.Q : body.Q + 4] = quaternion(vectors.product(turn, matrix(state)))
    out[body.Z] -= lowest_height(corners, out)
    return out


def lowest_height(corners: Points, state: State) -> float:
    """Return the height of the lowest of the corners of a part.

    Parameters
    ----------
    corners : (C, 3) float [L]
        In its own axes.
    state : (13,) float [L, sqrt(g L), 1, sqrt(g/L)]

    Returns
    -------
    float [L]
    """
    return state[body.Z] + vectors.product(corners, matrix(state)[2]).min()


def set_play(
    state: State, solid: TrueSolid, track: Track, length: float, play: float, leans: float = 0.0
) -> State:
    """Move a part across the track until it is so far from the wall; its state is changed in place.

    Parameters
    ----------
    state : (13,) float [L, sqrt(g L), 1, sqrt(g/L)]
    solid : TrueSolid
    track : Track
    length : float [m]
        The unit of length L.
    play : float [m]
        From the wall to the part's nearest corner.
    leans : float [rad], optional
        Of the wall, back.

    Returns
    -------
    (13,) float [L, sqrt(g L), 1, sqrt(g/L)]
        The state given.
    """
    spots = state[:3] + vectors.product(solid.corners, matrix(state).T)
    radius, off = track.radius / length, track.bank - leans
    lean, up = np.sin(off), np.cos(off)
    gap = up * (radius - np.hypot(spots[:, 0], radius - spots[:, 1])) - lean * spots[:, 2]
    out = state[:2] - [0.0, radius]
    state[:2] += out / np.hypot(*out) * (gap.min() - play / length) / up
    return state


def draw_falling(
    bowl: Bowl, launch: Launch, shape: Shape, count: int, length: float, seed: int
) -> tuple[Floats, Floats]:
    """Return parts that fall onto the track at the place 0, anywhere over its width, and their times.

    Parameters
    ----------
    bowl : Bowl
    launch : Launch
        Height, spin and speed; friction and restitution are those of the bowl.
    shape : Shape
        In the axes of ``solid_of``.
    count : int
        Of parts, N.
    length : float [m]
        The unit of length L.
    seed : int

    Returns
    -------
    states : (N, 13) float [L, sqrt(g L), 1, sqrt(g/L)]
    times : (N,) float [s]
        Within one period of the drive: the phase.
    """
    rng = np.random.default_rng((seed, count))
    states = np.array(sample(launch, shape, count, rng).states)
    place, phase = np.random.default_rng((seed, count, 1)).random((2, count))
    near = WALL_CLEARANCE * shape.solid.radius
    states[:, body.Y] = near + place * max(bowl.track.width / length - near, 0.0)
    return states, phase / bowl.drive.frequency


def pose_on_track(
    orientation: Orientation,
    principal: Floats,
    length: float,
    track: Track,
    *,
    place: float,
    aside: float = 0.0,
    turn: float = 0.0,
) -> State:
    """Return the state of a part laid on the track in an orientation, at rest.

    Parameters
    ----------
    orientation : Orientation
    principal : (3, 3) float [1]
        Principal axes as columns, from ``solid_of``.
    length : float [m]
        The unit of length L, from ``solid_of``.
    track : Track
    place : float [m]
        Of its centre of mass, along the wall.
    aside : float [m], optional
        From the wall, beyond where the part touches it.
    turn : float [rad], optional
        Added to its heading, counter-clockwise from above.

    Returns
    -------
    (13,) float [L, sqrt(g L), 1, sqrt(g/L)]
    """
    theta, angle = place / track.radius, place / track.radius + orientation.heading + turn
    c, s = np.cos(angle), np.sin(angle)
    about_z = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    axes = vectors.product(about_z, vectors.product(np.asarray(orientation.posture.axes), principal))
    off, state = track.radius - orientation.distance - aside, np.zeros(body.STATE)
    state[:3] = off * np.sin(theta), track.radius - off * np.cos(theta), orientation.posture.height
    state[:3] /= length
    state[body.Q : body.Q + 4] = quaternion(axes)
    return state


def quaternion(axes: Floats) -> Floats:
    """Return the quaternion of a rotation matrix.

    Parameters
    ----------
    axes : (3, 3) float [1]

    Returns
    -------
    (4,) float [1]
        w, x, y, z; of the two that turn alike, the one whose largest component is positive.
    """
    trace = np.array([axes.trace(), *np.diag(axes)])
    spun = [axes[2, 1] - axes[1, 2], axes[0, 2] - axes[2, 0], axes[1, 0] - axes[0, 1]]
    wxyz, k = np.array([1.0 + trace[0], *spun]), int(np.argmax(trace))
    if k > 0:
        i, j, m = k - 1, k % 3, (k + 1) % 3
        wxyz[0], wxyz[1 + i] = spun[i], 1.0 + axes[i, i] - axes[j, j] - axes[m, m]
        wxyz[1 + j], wxyz[1 + m] = axes[j, i] + axes[i, j], axes[m, i] + axes[i, m]
    return wxyz / vectors.length(wxyz)


def matrix(state: State) -> Floats:
    """Return the rotation matrix of a state, from the part's axes to the bowl's.

    Parameters
    ----------
    state : (13,) or (13, N) float [L, sqrt(g L), 1, sqrt(g/L)]

    Returns
    -------
    (3, 3) or (3, 3, N) float [1]
    """
    a, b, c, d = state[body.Q : body.Q + 4]
    return np.array(
        [
            [1.0 - 2.0 * (c * c + d * d), 2.0 * (b * c - a * d), 2.0 * (b * d + a * c)],
            [2.0 * (b * c + a * d), 1.0 - 2.0 * (b * b + d * d), 2.0 * (c * d - a * b)],
            [2.0 * (b * d - a * c), 2.0 * (c * d + a * b), 1.0 - 2.0 * (b * b + c * c)],
        ]
    )


def ways_along_wall(states: Floats, radius: float, middle: float = 0.0) -> Floats:
    """Return how far along the wall parts are.

    Parameters
    ----------
    states : (N, 13) float [L, sqrt(g L), 1, sqrt(g/L)]
    radius : float [L]
        Of the wall.
    middle : float [L], optional
        Of the track that they are on, as of ``Stage``.

    Returns
    -------
    (N,) float [L]
        Within half a turn of it.
    """
    return along_wall(states[:, :2], radius, middle)


def reaches(states: Floats, corners: Points, radius: float, middle: float = 0.0) -> Floats:
    """Return how far parts reach along the wall and down.

    Parameters
    ----------
    states : (N, 13) float [L, sqrt(g L), 1, sqrt(g/L)]
    corners : (C, 3) float [L]
        Of the part, in its own axes.
    radius : float [L]
        Of the wall.
    middle : float [L], optional
        As of ``ways_along_wall``.

    Returns
    -------
    (N, 3) float [L]
        Rear and front along the wall, and the height of the lowest point.
    """
    turns = np.ascontiguousarray(matrix(states.T).transpose(2, 0, 1))
    x, y, z = states[:, :3].T[:, :, None] + np.einsum("nij,cj->inc", turns, corners)
    ways = ways_along_wall(states, radius, middle)[:, None]  # no part is torn where a turn begins anew
    along = along_wall(np.stack([x, y], axis=-1), radius, ways)
    return np.stack([along.min(axis=1), along.max(axis=1), z.min(axis=1)], axis=1)


def move_along_wall(states: Floats, distance: float | Floats, radius: float) -> Floats:
    """Return the states of parts turned about the bowl's axis, by ways along the wall.

    Parameters
    ----------
    states : (N, 13) float [L, sqrt(g L), 1, sqrt(g/L)]
    distance : float or (N,) float [L]
    radius : float [L]
        Of the wall.

    Returns
    -------
    (N, 13) float [L, sqrt(g L), 1, sqrt(g/L)]
        With velocities and attitudes turned along.
    """
    theta = np.broadcast_to(np.asarray(distance) / radius, len(states))
    c, s = np.cos(theta), np.sin(theta)
    out = np.array(states, float)
    for first, middle in ((0, radius), (3, 0.0)):
        x, y = states[:, first], states[:, first + 1] - middle
        out[:, first], out[:, first + 1] = c * x - s * y, s * x + c * y + middle
    a, d = np.cos(0.5 * theta), np.sin(0.5 * theta)
    w, x, y, z = (states[:, body.Q + k] for k in range(4))
    out[:, body.Q : body.Q + 4] = np.column_stack(
        [a * w - d * z, a * x - d * y, a * y + d * x, a * z + d * w]
    )
    return out
