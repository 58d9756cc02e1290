"""Where parts are: states laid on the track, turned about the bowl's axis, and how far they reach."""

from typing import Any

import numpy as np

from feederscrew.dropping.kernel import body
from feederscrew.geometry import vectors


def pose_on_track(orientation, principal, length, track, *, place, aside=0.0, turn=0.0):
    """Return the state of a part laid on the track in an orientation.

    Parameters
    ----------
    orientation : Orientation
    principal : (3, 3) float [1]
        From ``solid_of``.
    length : float [m]
        The unit of length.
    track : Track
    place : float [m]
        Of its centre of mass along the wall.
    aside : float [m]
        From the wall.
    turn : float [rad]
        Of its heading, counter-clockwise.

    Returns
    -------
    (13,) float [L, sqrt(g L), 1, sqrt(g/L)]
    """
    theta, angle = place / track.radius, place / track.radius + orientation.heading + turn
    axes = vectors.product(_about_z(angle), vectors.product(orientation.posture.axes, principal))
    off = track.radius - orientation.distance - aside
    state = np.zeros(body.STATE)
    state[:3] = off * np.sin(theta), track.radius - off * np.cos(theta), orientation.posture.height
    state[:3] /= length
    state[body.Q : body.Q + 4] = quaternion(axes)
    return state


def _about_z(angle) -> np.ndarray:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def quaternion(axes):
    """Return the quaternion (4,) [1], w x y z, of a rotation matrix (3, 3) [1]."""
    trace = np.array([axes.trace(), *np.diag(axes)])
    k = int(np.argmax(trace))
    if k == 0:
        spun = [axes[2, 1] - axes[1, 2], axes[0, 2] - axes[2, 0], axes[1, 0] - axes[0, 1]]
        wxyz = np.array([1.0 + trace[0], *spun])
    else:
        i, j, m = k - 1, k % 3, (k + 1) % 3
        wxyz = np.zeros(4)
        wxyz[0] = axes[m, j] - axes[j, m]
        wxyz[1 + i] = 1.0 + axes[i, i] - axes[j, j] - axes[m, m]
        wxyz[1 + j] = axes[j, i] + axes[i, j]
        wxyz[1 + m] = axes[m, i] + axes[i, m]
    return wxyz / vectors.length(wxyz)


def matrix(state) -> np.ndarray:
    """Return the rotation matrix (3, 3) [1] of a state (13,), body to bowl; (3, 3, N) of states (13, N)."""
    a, b, c, d = state[body.Q : body.Q + 4]
    return np.array(
        [
            [1.0 - 2.0 * (c * c + d * d), 2.0 * (b * c - a * d), 2.0 * (b * d + a * c)],
            [2.0 * (b * c + a * d), 1.0 - 2.0 * (b * b + d * d), 2.0 * (c * d - a * b)],
            [2.0 * (b * d - a * c), 2.0 * (c * d + a * b), 1.0 - 2.0 * (b * b + c * c)],
        ]
    )


def ways_along_wall(states, radius):
    """Return how far along the wall states (N, 13) are, (N,) [that of the radius]."""
    return radius * np.arctan2(states[:, 0], radius - states[:, 1])


def extents(state, corners, radius) -> tuple[Any, ...]:
    """Return how far a part reaches along the wall, rear and front, and its lowest point [any]."""
    return tuple(reaches(state[None], corners, radius)[0])


def reaches(states, corners, radius) -> np.ndarray:
    """Return how far parts reach along the wall, rear and front, and their lowest points, (N, 3) [L].

    Parameters
    ----------
    states : (N, 13) float [L, sqrt(g L), 1, sqrt(g/L)]
    corners : (C, 3) float [L]
        Of the part; those of its hull reach as far as all.
    radius : float [L]
        Of the wall.
    """
    turns = np.ascontiguousarray(matrix(states.T).transpose(2, 0, 1))
    x, y, z = states[:, :3].T[:, :, None] + np.einsum("nij,cj->inc", turns, corners)
    along = radius * np.arctan2(x, radius - y)
    return np.stack([along.min(axis=1), along.max(axis=1), z.min(axis=1)], axis=1)


def reach(state, corners, radius) -> float:
    """Return how far a part reaches from the wall [any]."""
    spots = state[:2] + vectors.product(corners, matrix(state).T)[:, :2]
    return float(radius - np.hypot(spots[:, 0], radius - spots[:, 1]).min())


def moved(states, by, radius):
    """Return states (N, 13) turned about the bowl's axis by ways along the wall, in one unit of length."""
    theta = np.broadcast_to(np.asarray(by) / radius, len(states))
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
