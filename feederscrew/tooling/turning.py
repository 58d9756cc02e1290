"""Where a part lands that a device turns over, quasi-statically, from the barriers of its convex hull.

A step (a drop of the track) makes a part pitch over its leading edge; a ledge beyond which its weight lies
makes it turn inwards. Either way the direction that is down moves on a great circle of the part until the
centre of mass stands over a corner or edge of the hull, its barrier; beyond it the part rolls down without
momentum. What momentum does on top of that, only a trial tells.
"""

import functools
import math
from dataclasses import dataclass, replace

import numpy as np

from feederscrew import check
from feederscrew.geometry import vectors
from feederscrew.geometry.compiled import fitting
from feederscrew.geometry.polygons import outline
from feederscrew.mechanics.wall import headings as wall
from feederscrew.mechanics.wall import sameness
from feederscrew.part.hull import convex_hull
from feederscrew.resting.tumbling import edges as tumbling
from feederscrew.resting.tumbling import walk

BEYOND = 1e-7  # [rad] past the barrier a part rolls down by itself
TOUCHES = 1e-5  # of the part's size: hull corners that low rest on the track
RIPPLE = 2e-3  # of the part's size: a lower barrier is one of a round side cut into facets


@dataclass(frozen=True)
class Turn:
    """How an orientation turns over, and into which."""

    angle: float  # [rad] at which the centre of mass stands over its barrier
    lift: float  # [m] by which it is then higher than lying
    sure: float  # [m] drop of the track from which the part turns over without any momentum
    onto: int  # place of the orientation it lands in


def pitched(one, every):
    """Return how an orientation turns over its leading edge, as a part does at a step: a Turn.

    Parameters
    ----------
    one : Orientation
    every : tuple of Orientation
        Of the part on the track.
    """
    return _turn(one, tuple(every), False)


def rolled(one, every):
    """Return how an orientation turns over inwards, as a part does at a ledge: a Turn."""
    return _turn(one, tuple(every), True)


def share_over_step(one, every, height):
    """Return the share that turns over at a step, and the margin by which that is certain.

    A drop below the barrier leaves every part as it lies: what it falls through lifts it over no more. From
    the height at which the track's edge tilts the lying part up to its barrier, every part turns. In between
    momentum decides; the share is taken to grow evenly with the height.

    Parameters
    ----------
    one : Orientation
    every : tuple of Orientation
    height : float [m]
        Of the step.

    Returns
    -------
    (float [1], float [m])
        The margin is negative where momentum decides.
    """
    turn = pitched(one, every)
    room = turn.sure - turn.lift
    share = (height - turn.lift) / room if room > 0.0 else float(height >= turn.lift)
    return min(max(share, 0.0), 1.0), max(turn.lift - height, height - turn.sure)


@functools.lru_cache(maxsize=2048)
def _turn(one, every, inwards):
    solid = one.posture.solid
    hull = convex_hull(solid.vertices, solid.centre_of_mass, solid.source)
    x, y, z = one.axes
    side, kept, down = (y, x, -z) if inwards else (x, y, -z)
    angle, height = barrier(vectors.product(hull.vertices, np.column_stack([side, down])))
    lift = max(height - one.posture.height, 0.0)
    past = math.cos(angle + BEYOND) * down + math.sin(angle + BEYOND) * side
    rests = _end(hull, past)
    kept, up = _carried(kept, past, rests), -rests
    axes = [kept, np.cross(up, kept), up] if inwards else [np.cross(kept, up), kept, up]
    long = float(np.ptp(one.foot.corners[:, 0])) if len(one.foot.corners) else one.length
    sure = max(long * math.sin(min(angle, 0.5 * math.pi)), lift)
    return Turn(angle, lift, sure, _landed(one, hull, np.array(axes), every))


def barrier(points):
    """Return where a part that is turned in a plane first stands over a corner.

    Parameters
    ----------
    points : (V, 2) float [m]
        Corners about the centre of mass: towards the side it turns to, and down.

    Returns
    -------
    angle : float [rad]
        By which it is turned then.
    height : float [m]
        Of the centre of mass; ripples of a round side count for nothing.
    """
    ring = outline(points)
    turn, far = np.arctan2(*ring.T), np.hypot(*ring.T)
    turn = np.where(turn < 0.0, turn + 2.0 * np.pi, turn)
    heights = (np.sin(turn)[:, None] * ring[:, 0] + np.cos(turn)[:, None] * ring[:, 1]).max(axis=1)
    stands = heights <= far * (1.0 + 1e-9)  # no other corner is lower there
    high = far >= ring[:, 1].max() + RIPPLE * far.max()
    some = np.flatnonzero(stands & high)
    some = some if len(some) else np.flatnonzero(stands)
    first = some[np.argmin(turn[some])]
    return float(turn[first]), float(far[first])


def _end(hull, down):
    """The direction (3,) down in which a part comes to rest that is let go with another one down."""
    found = tumbling.half_edges(hull)
    ends = np.empty(1, dtype=np.int64)
    fitting(walk.rolls, len(found.origins))(found, np.array([down]), ends)
    return found.normals[ends[0]] if ends[0] >= 0 else down


def _carried(axis, start, end):
    """A unit vector (3,) turned as the shortest turn takes one direction to another, made level."""
    middle = vectors.unit(start + end)
    turned = axis - 2.0 * vectors.dot(axis, middle) * middle
    turned = turned - 2.0 * vectors.dot(turned, end) * end  # two mirrors make the turn
    return vectors.unit(turned - end * vectors.dot(turned, end))


def _landed(one, hull, axes, every):
    """Place of the orientation that a part takes against the wall, set down with its axes (3, 3)."""
    corners = vectors.product(hull.vertices, axes.T)
    height = -corners[:, 2].min()
    corners[:, 2] += height
    low = corners[corners[:, 2] < TOUCHES * np.ptp(corners, axis=0).max(), :2]
    plan = outline(corners[:, :2])
    lying = replace(
        one.posture,
        height=float(height),
        contact=outline(low) if len(low) > 2 else plan,
        outline=plan,
        corners=check.frozen(corners),
        axes=check.frozen(axes),
    )
    found = wall.headings(lying, one.track)
    turn = found.headings[wall.settled(found, 0.0)]
    (supports,), _ = sameness.looks(lying, [turn])
    apart = [np.abs(_look(other) - supports[0]).max() for other in every]
    return int(np.argmin(np.round(apart, 6)))


@functools.lru_cache(maxsize=1024)
def _look(one):
    return sameness.looks(one.posture, [one.heading])[0][0, 0]
