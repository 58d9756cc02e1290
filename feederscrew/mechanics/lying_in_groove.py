"""How a part comes to lie in a groove: a V of two faces, where its weight finds the lowest place."""

import functools
from typing import Any

import numpy as np

from feederscrew.geometry import vectors
from feederscrew.mechanics.sameness import directions

FIRST_STEP_RAD, LAST_STEP_RAD = (
    np.radians(6.0),
    np.radians(0.02),
)  # [rad] steps of the way down, the largest and the smallest
STEP_AXES = 24  # about which a step may turn it, either way
YAW_RAD = np.radians(5.0)  # [rad] askew to either side, as it comes
HEADING_OFFSETS = np.radians(np.linspace(-10.0, 10.0, 11))  # by which one may lie turned and be known
REACH_DIRECTIONS = 160  # directions in which reaches are compared
REACH_TOLERANCE = 0.05  # of the part's size, by which they may differ


def height(points, angle):
    """Return how high over the bottom of a groove a centre of mass is, its part resting on both faces.

    Source: own; docs/tooling.md, "A groove". Each face holds off the farthest point of the part.

    Parameters
    ----------
    points : (..., V, 3) float [m]
        Of the part from its centre of mass: ahead, inwards along the inner face, square to that face.
    angle : float [rad]
        Of both faces from level.

    Returns
    -------
    (...) float [m]
    """
    s, c = np.sin(2.0 * angle), np.cos(2.0 * angle)
    inner = -points[..., 2].min(axis=-1)
    outer = -(s * points[..., 1] + c * points[..., 2]).min(axis=-1)
    return (inner + outer) / (2.0 * np.cos(angle))


def settled(points, angle):
    """Return a part (V, 3) [m] as it comes to lie in a groove: turned downhill until no turn leads lower.

    Source: own; docs/tooling.md, "A groove". Parameters as for ``height``. What moves slips both ways on a
    vibrating track, so friction holds nothing across it.
    """
    step, here = FIRST_STEP_RAD, float(height(points, angle))
    while step > LAST_STEP_RAD:
        turned = vectors.product(points, _turns(step))
        heights = height(turned, angle)
        best = int(np.argmin(heights))
        if heights[best] < here * (1.0 - 1e-9):
            points, here = turned[best], float(heights[best])
        else:
            step *= 0.5
    return points


@functools.lru_cache(maxsize=32)
def _turns(step) -> np.ndarray:
    """Matrices (2 STEP_AXES, 3, 3) that turn rows by a step [rad] about axes spread over the sphere."""
    axes = directions()[:: len(directions()) // STEP_AXES][:STEP_AXES]
    s, c = np.sin(step), np.cos(step)
    rotations = []
    for x, y, z in np.concatenate([axes, -axes]):
        across = np.array([[0.0, z, -y], [-z, 0.0, x], [y, -x, 0.0]])
        rotations.append(c * np.eye(3) + s * across + (1.0 - c) * np.outer([x, y, z], [x, y, z]))
    return np.array(rotations)


@functools.lru_cache(maxsize=2048)
def _comes_to_lie(posture, heading, angle, turn):
    """What one that comes turned by ``turn`` [rad] reaches (REACH_DIRECTIONS,) [m] as it lies in a groove."""
    return _reach(settled(_standing(posture, heading + turn), angle))


def _standing(posture, heading):
    """A part (V, 3) [m] from its centre of mass as it lies on the track at a heading [rad]."""
    c, s = np.cos(heading), np.sin(heading)
    turn = np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
    return vectors.product(posture.corners - [0.0, 0.0, posture.height], turn)


def _reach(points):
    sample = directions()[:: len(directions()) // REACH_DIRECTIONS][:REACH_DIRECTIONS]
    return vectors.product(points, sample.T).max(axis=-2)


@functools.lru_cache(maxsize=2048)
def _reach_of_orientation(posture, heading) -> np.ndarray:
    """What an orientation reaches (N, REACH_DIRECTIONS) [m], turned a little."""
    return np.array([_reach(_standing(posture, heading + by)) for by in HEADING_OFFSETS])


def becomes(orientation, orientations, angle) -> tuple[Any, ...]:
    """Return what an orientation becomes in a groove, ((place, share) ...); place -1 is none of the known.

    Source: own; docs/tooling.md, "A groove".

    Parameters
    ----------
    orientation : Orientation
        It comes a little askew, one way as often as the other.
    orientations : sequence of Orientation
        Of the part.
    angle : float [rad]
        Of both faces from level.
    """
    shares: dict[int, float] = {}
    for turn in (-YAW_RAD, YAW_RAD):
        reach = _comes_to_lie(orientation.posture, orientation.heading, angle, turn)
        place = _like(reach, orientation, orientations)
        shares[place] = shares.get(place, 0.0) + 0.5
    return tuple(shares.items())


def _like(reach, orientation, orientations):
    """Place of the orientation that reaches so, that of ``orientation`` first; -1 where none does."""
    off = [
        float(np.abs(_reach_of_orientation(k.posture, k.heading) - reach).max(axis=1).min())
        for k in orientations
    ]
    size = REACH_TOLERANCE * float(reach.max())
    own = [
        other.posture is orientation.posture and other.heading == orientation.heading
        for other in orientations
    ].index(True)
    best = own if off[own] < size else int(np.argmin(off))
    return best if off[best] < size else -1
