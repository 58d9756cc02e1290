"""Risks that are said before steel is cut: parts that shingle, and parts that climbed in the queue."""

import math

import numpy as np

from feederscrew.geometry.polygons import turned
from feederscrew.units import counted

LIFT = (
    0.25e-3  # [m] by which one part may lie higher than the next: play, burrs and dirt, as a design's margin
)
CLEARS = 2  # status of a linear programme without a solution: so much higher nothing meets


def wedge(one, lift=LIFT):
    """Return the angle [rad] at which a part is pushed up on its like where it lies a little higher.

    Two parts of one orientation follow each other along the track, one of them higher by ``lift``. They come
    together until their hulls touch, L apart. Pushed on, the higher one rises as the plane does in which they
    touch: by -dL/d(lift) along the track for each unit upwards.

    Source: own; docs/design.md, "7. Limitations".

    Parameters
    ----------
    one : Orientation
    lift : float [m]

    Returns
    -------
    float
        The smaller angle above the track of the two: either the part behind is higher or the one before. A
        quarter of a turn where upright sides meet, more where the plane pushes the higher one down, 0 where
        one clears the other.
    """
    return min(_rise(one, sign, lift) for sign in (1.0, -1.0))


def _rise(one, sign, lift):
    """The angle where the part behind is higher (+1) or the part before (-1).

    L is the largest q_x - p_x of points q of the part behind and p of the part before that meet: a linear
    programme in the shares of the corners, whose multiplier of the height is dL/d(lift).
    """
    from scipy.optimize import linprog

    points = one.posture.surface
    x, y = turned(points[:, :2], one.heading).T
    z, count = points[:, 2], len(points)
    whole, none = np.ones(count), np.zeros(count)
    rows = [np.append(whole, none), np.append(none, whole), np.append(y, -y), np.append(-z, z)]
    right = [1.0, 1.0, 0.0, sign * lift]  # shares of q, of p; beside each other; p_z - q_z
    found = linprog(np.append(-x, x), A_eq=rows, b_eq=right, method="highs")
    if found.status == CLEARS:
        return 0.0
    return math.atan2(1.0, sign * found.eqlin.marginals[3])


def risks(one, friction, queues):
    """Say what may go wrong between parts, a sentence each.

    Parameters
    ----------
    one : Orientation
        That is wanted.
    friction : float [1]
        Of part on part.
    queues : sequence of FilledQueue
        What was seen.
    """
    found, held = [], math.atan(friction)
    angle, higher = wedge(one), f"where one lies {1e3 * LIFT:.3g} mm higher than the next it"
    if angle <= 0.0:
        found.append(f"{one.name} may shingle: {higher} slides onto it")
    elif angle < held:
        found.append(
            f"{one.name} may shingle: {higher} is pushed up a side of {math.degrees(angle):.3g} deg, and "
            f"friction holds it up to {math.degrees(held):.3g} deg"
        )
    climbs = sum(seen.climbs for seen in queues)
    if climbs:
        seconds = sum(seen.seconds for seen in queues)
        found.append(f"parts climbed on others {counted(climbs, 'time')} in {seconds:.3g} s of queue")
    return tuple(found)
