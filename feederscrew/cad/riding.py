"""A part as it lies on the track of a bowl, along its wall."""

import numpy as np

from feederscrew.base.arrays import Points, Values
from feederscrew.base.geometry.vectors import product
from feederscrew.cad import facets, track
from feederscrew.cad.plan import CONICAL, FULL_TURN_RAD, BowlPlan
from feederscrew.sorting.orientations import Orientation

SPACED = 1.3  # of its length: from part to part
FIRST_RIDER_POSITION = 0.12  # of the track: where the first of them is
MAX_SETTLING_STEPS = 60  # steps in which a part comes to touch wall and track, at most
RIDER_CONTACT_M = 5e-6  # [m]
BELOW = 1e-4  # [m] under the track: a part that reaches so deep hangs, and does not touch the wall


def place_rider(plan: BowlPlan, orientation: Orientation, vertices: Points, s: float) -> Points:
    """Return a part on the track of a bowl, its side at the wall; one that hangs as it hangs.

    A bent track and a leaning wall move the part from where it lies on a straight one. So it is moved off the
    wall and onto the track in turn, until it is nearer than ``RIDER_CONTACT_M`` to both. On a track that
    stands on edge it stays where it lies on a straight one.

    Parameters
    ----------
    plan : BowlPlan
    orientation : Orientation
        Of the part, on the track of that bowl.
    vertices : (V, 3) float [m]
        Of the part, in its file's axes, about its centre of mass.
    s : float [m]
        Length along the wall at which its centre of mass is.

    Returns
    -------
    (V, 3) float [m]
        In the bowl's axes as its files have them.
    """
    path, points, distance = plan.path, product(vertices, orientation.axes.T), orientation.distance
    points[:, 2] += orientation.posture.height
    as_on_straight = points[:, 2].min() < -BELOW or path.bank_at(s) > track.STEEP_BANK_RAD
    for step in range(MAX_SETTLING_STEPS + 1):
        placed = path.places(s, distance) + product(points, np.stack(frame(plan, s, distance)))
        if as_on_straight or step == MAX_SETTLING_STEPS:
            break
        # the farthest beyond the wall, which may lean: it is met at each point's height
        x, y, z = placed.T
        theta = np.arctan2(y, x)
        theta = theta + FULL_TURN_RAD * np.round((float(path.angle(s)) - theta) / FULL_TURN_RAD)
        straight = theta > 0.0
        along = np.where(straight, path.end + y, path.at(theta))
        out = np.where(straight, x, np.hypot(x, y)) - path.wall_radius(along)
        beyond = float((out - np.maximum(z - path.height(along), 0.0) * leaning(plan, along)).max())
        # and the lowest over the track
        inward = -out / np.cos(path.bank_at(along))
        on_track = inward < plan.width
        over = (z - path.height(along, np.maximum(inward, 0.0)))[on_track].min() if on_track.any() else 0.0
        if max(abs(beyond), abs(over)) < RIDER_CONTACT_M:
            break
        distance += beyond / float(np.cos(path.bank_at(s)))
        points[:, 2] -= over
    return facets.as_filed(plan, placed)


def leaning(plan: BowlPlan, s: Values) -> Values:
    """Return how far the wall leans outwards over its height.

    Parameters
    ----------
    plan : BowlPlan
    s : float or array [m]
        Lengths along the wall.

    Returns
    -------
    float or array [1]
        Tangent of the lean; 0 where the wall is upright.
    """
    if plan.stairs is not None and plan.stairs.shape == CONICAL:  # upright above the last turn but one
        return np.where(plan.path.angle(s) < -FULL_TURN_RAD, 1.0 / np.tan(plan.stairs.slope), 0.0)
    lean = np.zeros(np.shape(s))
    for groove in track.groove_spans(plan):
        there = (s >= groove.begin) & (s <= groove.closed)
        lean = np.where(there, np.tan(track.lean_at(groove, s)), lean)
    return lean


def frame(plan: BowlPlan, s: float, y: float) -> tuple[Points, Points, Points]:
    """Return the track's axes at a place, the outlet at the angle 0.

    By central differences of the surface: ``up`` is square to both its directions, and ``inwards`` completes
    the three.

    Parameters
    ----------
    plan : BowlPlan
    s, y : float [m]
        Length along the wall, and distance from it.

    Returns
    -------
    (3,) float [1]
        Ahead.
    (3,) float [1]
        Inwards.
    (3,) float [1]
        Off the surface.
    """
    path, d = plan.path, 1e-5
    ahead = path.places(s + d, y) - path.places(s - d, y)
    inward = path.places(s, y + d) - path.places(s, y - d)
    up = np.cross(ahead, inward)
    ahead, up = ahead / np.sqrt((ahead**2).sum()), up / np.sqrt((up**2).sum())
    return ahead, np.cross(up, ahead), up


def riders(
    plan: BowlPlan, orientation: Orientation, hung: Orientation | None
) -> list[tuple[Orientation, float]]:
    """Return parts along the track of a bowl, one behind the other.

    Parameters
    ----------
    plan : BowlPlan
    orientation : Orientation
        In which they come along.
    hung : Orientation or None
        In which they hang from the last rails on.

    Returns
    -------
    list of (Orientation, float [m])
        Each with its length along the wall.
    """
    step = SPACED * orientation.length
    last = plan.first if plan.stretch is not None else plan.path.end - orientation.length
    ahead = [(orientation, s) for s in np.arange(FIRST_RIDER_POSITION * plan.path.end, last, step)]
    behind = orientation if hung is None else hung
    start = last if plan.stretch is None else plan.first + plan.stretch.length
    end = plan.path.end + plan.outlet - 0.5 * behind.length
    return ahead + [(behind, s) for s in np.arange(start, end, SPACED * behind.length)]
