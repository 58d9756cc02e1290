"""Where a part lands that a device turns over, quasi-statically, from the barriers of its convex hull.

A step (a drop of the track) makes a part pitch over its leading edge; a ledge beyond which its weight lies
makes it turn inwards. Either way the direction that is down moves on a great circle of the part until the
centre of mass stands over a corner or edge of the hull, its barrier; beyond it the part rolls down, and comes
to lie on the face below. It stays there if what is left of its momentum lifts it over no further edge: else,
and between what cannot turn and what must, momentum decides, and only a trial tells.

Source: docs/tooling.md, section 4; barriers as in docs/resting.md.
"""

import functools
import math
from dataclasses import dataclass, replace

import numpy as np

from feederscrew import check
from feederscrew.geometry import vectors
from feederscrew.geometry.compiled import fitting
from feederscrew.geometry.polygons import barrier, cross, outline
from feederscrew.mechanics.wall import sameness
from feederscrew.mechanics.wall import stable_headings as wall
from feederscrew.part.hull import convex_hull
from feederscrew.resting.tumbling import half_edges as tumbling
from feederscrew.resting.tumbling import walk
from feederscrew.tooling.devices.ledge_edges import below_ledge

BARRIER_OVERSHOOT_RAD = 1e-7  # [rad] past the barrier a part rolls down by itself
TOUCHES = 1e-5  # of the part's size: hull corners that low rest on the track
SKEW = 0.2  # sine of the angle from which a side of the foot is neither along the track nor across it


@dataclass(frozen=True)
class Turn:
    """How an orientation turns over, and into which."""

    angle: float  # [rad] at which the centre of mass stands over its barrier
    lift: float  # [m] by which it is then higher than lying
    back: float  # [m] the same over the side behind it
    sure: float  # [m] drop of the track from which the part turns over without any momentum
    holds: float  # [m] drop from which its momentum may carry it further; infinite where none does
    onto: int  # place of the orientation it lands in
    beyond: int  # ... and of that into which it goes if it is carried further


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


def over_step(one, every, height):
    """Return what a step does with an orientation.

    A drop below the barrier leaves every part as it lies: what it falls through lifts it over no more, unless
    the rear, as it follows, carries it on over its rear edge. From the height at which the track's edge tilts
    the lying part up to its barrier, every part turns. In between momentum decides; the share is taken to
    grow evenly with the height. So it does where the face on which it lands may not hold it: half of the
    parts are taken to go on over the next edge.

    Source: docs/tooling.md, "4. Turning parts over".

    Parameters
    ----------
    one : Orientation
    every : tuple of Orientation
    height : float [m]
        Of the step.

    Returns
    -------
    turned : tuple of (int, float [1])
        Places of orientations that it is turned into, with their shares.
    margin : float [m]
        Negative where momentum decides.
    """
    turn = pitched(one, every)
    room = turn.sure - turn.lift
    share = (height - turn.lift) / room if room > 0.0 else float(height >= turn.lift)
    stays = min(turn.lift - height, turn.back - _rear(one, height), _skew_lift(one) - height)
    margin = max(stays, _certain(one, every, turn, height))
    return _turned(turn, min(max(share, 0.0), 1.0), height), margin


def _rear(one, height):
    """Height [m] to which its momentum still lifts a part whose rear has followed it down a step."""
    foot = one.foot.corners[:, 0]
    if not len(foot):
        return math.inf
    tilt = math.asin(min(height / np.ptp(foot), 1.0)) if np.ptp(foot) > 0.0 else 0.5 * math.pi
    fell = foot.max() * math.sin(tilt) - one.posture.height * (1.0 - math.cos(tilt))
    return _carries_on(_arm(one, one.axes[1]), foot.max(), foot.min(), one.posture.height) * max(fell, 0.0)


def beyond_ledge(one, every, width):
    """Return what becomes of an orientation whose weight lies beyond a ledge, over a second track.

    It tips about the edge until it leans on both tracks. If the second one lies so low that the part has
    passed its barrier by then, wherever the edge is below its foot, it turns over. If it does not pass it
    with what is left of the momentum of the fall, it slides down and lies as before, unless what it has still
    to fall is enough to pitch it over on its way.

    Source: docs/tooling.md, "4. Turning parts over".

    Parameters
    ----------
    one : Orientation
    every : tuple of Orientation
    width : float [m]
        Of the ledge.

    Returns
    -------
    turned : tuple of (int, float [1])
    margin : float [m]
        As for ``over_step``; of what stays, the height by which it misses its barriers.
    """
    turn, drop = rolled(one, every), below_ledge(every)
    if drop >= turn.sure:
        return _turned(turn, 1.0, drop), _certain(one, every, turn, drop)
    missed, left = _leaning(one, turn, width, drop)
    if missed > 0.0:
        return (), min(missed, pitched(one, every).lift - left, _skew_lift(one) - drop)
    return _turned(turn, 0.5, drop), drop - turn.sure


def _certain(one, every, turn, drop):
    """Margin [m] by which a part turns over at a drop and stays on the face below."""
    landed = every[turn.onto]
    fall = drop + one.posture.height - landed.posture.height
    skew = min(_skew_lift(one) - drop, _skew_lift(landed) - fall)
    return min(drop - turn.sure, turn.holds - drop, skew)


def _skew_lift(one):
    """Least rise [m] of the centre of mass over a side of the foot that is askew; infinite without one.

    A part that can leave its plane of motion over such a side is sure only where its whole fall is less.
    """
    if len(one.foot.corners) < 3:
        return math.inf
    ring = outline(one.foot.corners)
    along = np.roll(ring, -1, axis=0) - ring
    size = np.hypot(*along.T)
    askew = np.abs(along).min(axis=1) > SKEW * size
    beside = np.abs(cross(along, ring)) / size
    lifts = np.hypot(beside, one.posture.height) - one.posture.height
    return float(lifts[askew].min(initial=math.inf))


def _turned(turn, share, drop):
    """Orientations it is turned into, with their shares: half of them further where momentum may carry on."""
    if drop <= turn.holds:
        return ((turn.onto, share),) if share > 0.0 else ()
    return ((turn.onto, 0.5 * share), (turn.beyond, 0.5 * share)) if share > 0.0 else ()


def _leaning(one, turn, width, drop):
    """How a part leans over a ledge, one corner on the second track, onto which it has fallen.

    It turns about the edge, falls onto its inner corner and goes on about that, without rebound: its angular
    momentum about the corner stays.

    Returns
    -------
    height [m] by which it misses its barrier, negative where it may pass it; how far it has still to fall
    """
    over, height = one.distance - width, one.posture.height
    reach = (one.foot.corners[:, 1].max() if len(one.foot.corners) else 0.0) + over
    tilt = math.asin(min(drop / reach, 1.0)) if reach > 0.0 else 0.5 * math.pi
    fell = height * (1.0 - math.cos(tilt)) + over * math.sin(tilt)
    if tilt >= turn.angle:
        return 0.0, drop - fell
    left = _carries_on(_arm(one, one.axes[0]), over, over - reach, height) * fell
    return turn.lift + fell - drop - left, drop - fell


def _carries_on(arm, first, last, height):
    """Share of the energy that is left of turning about one point of a plane when the part lands on another.

    Both lie below the centre of mass by ``height``, and ``first`` and ``last`` [m] beside it; ``arm`` [m2] is
    the square of its radius of gyration. Nothing rebounds (G. W. Housner, "The behavior of inverted pendulum
    structures during earthquakes", Bull. Seism. Soc. Am. 53, 403-417, 1963).
    """
    near, far = arm + first**2 + height**2, arm + last**2 + height**2
    return max(arm + first * last + height**2, 0.0) ** 2 / (near * far)


def _arm(one, axis):
    """Square of the radius of gyration [m2] about an axis (3,) in the file's axes."""
    solid = one.posture.solid
    return float(np.einsum("i,ij,j->", axis, solid.inertia, axis)) / solid.mass


@functools.lru_cache(maxsize=2048)
def _turn(one, every, inwards):
    solid = one.posture.solid
    hull = convex_hull(solid.vertices, solid.centre_of_mass, solid.source)
    x, y, z = one.axes
    lying = (y, x, -z) if inwards else (x, y, -z)
    angle, height, landed = _tipped(hull, lying, inwards)
    lift = max(height - one.posture.height, 0.0)
    behind = barrier(vectors.product(hull.vertices, np.column_stack([-lying[0], lying[2]])))[1]
    foot = one.foot.corners[:, int(inwards)]
    long = float(np.ptp(foot)) if len(foot) else (one.width if inwards else one.length)
    return Turn(
        angle=angle,
        lift=lift,
        back=max(behind - one.posture.height, 0.0),
        sure=max(long * math.sin(min(angle, 0.5 * math.pi)), lift),
        holds=_holds(hull, one, landed),
        onto=_landed(one, hull, _axes(landed, inwards), every),
        beyond=_landed(one, hull, _axes(_tipped(hull, landed, inwards)[2], inwards), every),
    )


def _tipped(hull, frame, inwards):
    """How a part tips from one frame of its own into another.

    A frame is three directions (3,) in the file's axes: to the side it tips to, along its axis, and down.

    Returns
    -------
    angle of the barrier, height of the centre of mass there, the frame in which it comes to rest
    """
    side, kept, down = frame
    angle, height = barrier(vectors.product(hull.vertices, np.column_stack([side, down])))
    past = math.cos(angle + BARRIER_OVERSHOOT_RAD) * down + math.sin(angle + BARRIER_OVERSHOOT_RAD) * side
    rests = _end(hull, past)
    kept = vectors.carried(kept, past, rests)
    return angle, height, (np.cross(kept, rests) if inwards else np.cross(rests, kept), kept, rests)


def _axes(frame, inwards):
    """Axes (3, 3) of the track, ahead, inwards and up, of a frame."""
    side, kept, down = frame
    return np.array([kept, side, -down] if inwards else [side, kept, -down])


def _holds(hull, one, frame):
    """Drop of the track [m] up to which a part that rolls onto a face stays on it; infinite for any drop."""
    side, kept, down = frame
    points = vectors.product(hull.vertices, np.column_stack([side, down]))
    height = points[:, 1].max()
    below = points[points[:, 1] > height - TOUCHES * np.ptp(points, axis=0).max(), 0]
    left = _carries_on(_arm(one, kept), below.min(), below.max(), height)
    rise = barrier(points)[1] - height
    return max(rise / left + height - one.posture.height, 0.0) if left > 0.0 else math.inf


def _end(hull, down):
    """The direction (3,) down in which a part comes to rest that is let go with another one down."""
    found = tumbling.half_edges(hull)
    ends = np.empty(1, dtype=np.int64)
    fitting(walk.rolls, len(found.origins))(found, np.array([down]), ends)
    return found.normals[ends[0]] if ends[0] >= 0 else down


def _landed(one, hull, axes, every):
    """Place of the orientation that a part takes against the wall, set down with its axes (3, 3)."""
    corners = vectors.product(hull.vertices, axes.T)
    height = -corners[:, 2].min()
    corners[:, 2] += height
    lying = replace(
        one.posture,
        height=float(height),
        outline=outline(corners[:, :2]),
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
