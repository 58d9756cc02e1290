"""An orientation at a device: where it drifts, what turns it over or lays it in a groove, and the verdict.

Source, where no other is named: own; docs/tooling.md, "1. The method".
"""

import functools
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any, cast

import numpy as np
import shapely

from feederscrew.base import check
from feederscrew.base.arrays import Floats, Points, Vector
from feederscrew.base.geometry import vectors
from feederscrew.base.geometry.compiled import fitting
from feederscrew.base.geometry.polygons import barrier, cross, outline
from feederscrew.bowl.devices.asked import PlaceShares
from feederscrew.bowl.devices.base import GRIP, UNSURE, Device, Verdict, share
from feederscrew.bowl.devices.ledges import below_ledge
from feederscrew.motion import headings as wall
from feederscrew.motion import sameness
from feederscrew.part.hull import Hull, convex_hull
from feederscrew.resting import half_edges as tumbling
from feederscrew.resting import walks
from feederscrew.resting.posture import Posture
from feederscrew.sorting import falling, footprints, on_side, sensor_views
from feederscrew.sorting.orientations import Hanging, Orientation, head_first, neck, shoulder_margin

BARRIER_OVERSHOOT_RAD = 1e-7  # [rad] past the barrier a part rolls down by itself
TOUCHES = 1e-5  # of the part's size: hull corners that low rest on the track
SKEW = 0.2  # sine of the angle from which a side of the foot is neither along the track nor across it
WORN = 2.5e-4  # [m] what an opening holds by less does not hold a part up
# of the shank's radius: how far beyond a rail the middle of its tip has to lie, unless its tip lies no
# farther aside from its weight than a share of the shank's diameter: in trials of four screws, six of each,
# those with up to 0.33 lay askew over the slot to its end, or some of them, and those with 0.39 went down
TIP_BEYOND_RAIL_SHARE, STRAIGHT_SHANK_SHARE = 0.38, 0.05
BEYOND_OPENING_M = 10.0  # [m] an opening goes on so far below the track and behind the wall
# [rad] steps of the way down into a groove, the largest and the smallest, and the axes about which one turns
FIRST_STEP_RAD = np.radians(6.0)
LAST_STEP_RAD = np.radians(0.02)
STEP_AXES = 24
YAW_RAD = np.radians(5.0)  # [rad] askew to either side, as it comes to a groove


def verdict(
    device: Device, orientation: Orientation, orientations: Sequence[Orientation] = (), sigma: float = 0.0
) -> Verdict:
    """Return what a device does with an orientation.

    Parameters
    ----------
    device : Device
    orientation : Orientation
    orientations : sequence of Orientation, optional
        All of the part: a device may name any.
    sigma : float [m], optional
        Standard deviation of play and tolerance together. With it the share that passes is Phi(margin /
        sigma), not 0 or 1.

    Returns
    -------
    Verdict

    Raises
    ------
    ConfigError
        If the part does not have an orientation that the device names.
    """
    return _verdict(device, orientation, tuple(orientations), sigma)


@functools.lru_cache(maxsize=8192)
def _verdict(
    device: Device, orientation: Orientation, orientations: tuple[Orientation, ...], sigma: float
) -> Verdict:
    encounter = DeviceEncounter(orientation, orientations, sigma)
    outcome, blur = device.judged(encounter), device.hop_blur(orientation)
    margin = outcome.margin
    if not blur > 0.0 or not np.isfinite(margin) or margin == 0.0 or -UNSURE <= margin < 0.0:
        return outcome
    # hopping takes of the margin; within what it takes the verdict is not sure either way
    left = np.copysign(max(abs(margin) - blur, 0.0), margin)
    left = left if margin > 0.0 else min(left, -UNSURE)
    passes = outcome.passes if outcome.onto else encounter.share(left)
    if outcome.onto and margin > 0.0 and left == 0.0:
        left = -UNSURE
    return replace(outcome, passes=passes, margin=float(left))


# -- off the free edge


def drift_speed(push: float, friction: float, swing: float, gravity: float) -> float:
    """Return the velocity at which a steady sideways push moves what slips on a vibrating track.

    It solves v = a pi V / (2 mu g ln(4 V / v)), the mean of Coulomb friction over a sine, for v well below V.

    Parameters
    ----------
    push : float [m/s2]
        a, force over mass.
    friction : float [1]
        mu.
    swing : float [m/s]
        V, the amplitude of the relative velocity along the track.
    gravity : float [m/s2]
        g.

    Returns
    -------
    float [m/s]
        Infinite where friction does not hold the push back at all: beyond v = 4 V / e, where it is 0.94 of
        what holds on a still track.

    References
    ----------
    docs/tooling.md, "1. The method".
    """
    fastest = 4.0 * swing / math.e
    if swing <= 0.0:
        return 0.0 if push <= friction * gravity else math.inf

    def holding(v: float) -> float:
        return 2.0 * friction * gravity * v * math.log(4.0 * swing / v) / (math.pi * swing)

    if push <= 0.0:
        return 0.0
    return (
        math.inf if push >= holding(fastest) else footprints.halve(lambda v: holding(v) >= push, fastest)[1]
    )


def force_to_clear(orientation: Orientation, wide: float, height: float) -> float:
    """Return the least sideways force that takes an orientation off the track as it passes.

    The part drifts to the free edge in the time it takes to pass, or slides outright; or it tips over the
    side of its foot, where force times height is beyond weight times the way from its centre of mass to that
    side.

    Parameters
    ----------
    orientation : Orientation
        It travels: it knows its speed and its track's friction.
    wide : float [m]
        The way along the track over which the force acts.
    height : float [m]
        Over the track, at which it acts.

    Returns
    -------
    float [N]

    References
    ----------
    docs/tooling.md, "1. The method".
    """
    weight = orientation.posture.mass * orientation.gravity
    reach = float(orientation.foot.corners[:, 1].max()) + orientation.shift  # of its foot, to the free edge
    tips = weight * reach / height if height > 0.0 else math.inf
    return min(_force_to_shift(orientation, wide), tips)


@functools.lru_cache(maxsize=1024)
def _force_to_shift(orientation: Orientation, wide: float) -> float:
    mass, friction = orientation.posture.mass, max(orientation.grip, 1e-3)
    distance = max(orientation.track.width - orientation.distance, 0.0)

    def clears(force: float) -> bool:
        drift = drift_speed(force / mass, friction, orientation.swing, orientation.gravity)
        return drift * wide >= distance * orientation.speed

    return footprints.halve(clears, friction * (mass * orientation.gravity))[1]


# -- turned over


Frame = tuple[Vector, Vector, Vector]  # [1] in the file's axes: to the side, along the turn's axis, down


@dataclass(frozen=True)
class Turn:
    """A way in which an orientation turns over, and into which."""

    angle: float  # [rad] at which the centre of mass stands over its barrier
    lift: float  # [m] by which it is then higher than lying
    rear_lift: float  # [m] the same over the side behind it
    sure: float  # [m] drop of the track from which the part turns over without any momentum
    holds: float  # [m] drop from which its momentum may carry it further; infinite where none does
    onto: int  # place of the orientation it lands in
    beyond: int  # ... and of that into which it goes if it is carried further


def over_step(
    orientation: Orientation, orientations: Sequence[Orientation], height: float
) -> tuple[PlaceShares, float]:
    """Return what a step does with an orientation.

    Parameters
    ----------
    orientation : Orientation
    orientations : sequence of Orientation
        All of the part.
    height : float [m]
        Of the step.

    Returns
    -------
    shares : tuple of (int, float [1])
        The orientations into which it is turned, by their places, and the share of each.
    margin : float [m]
        Negative where momentum decides.

    References
    ----------
    docs/tooling.md, "4. Turning parts over".
    """
    turn = turn_over(orientation, tuple(orientations), False)
    room = turn.sure - turn.lift
    share = (height - turn.lift) / room if room > 0.0 else float(height >= turn.lift)
    # the rear, as it follows, may carry it on over its rear edge, up to the height its momentum lifts it
    foot, high, rear = orientation.foot.corners[:, 0], orientation.posture.height, math.inf
    if len(foot):
        tilt = math.asin(min(height / np.ptp(foot), 1.0)) if np.ptp(foot) > 0.0 else 0.5 * math.pi
        fell = foot.max() * math.sin(tilt) - high * (1.0 - math.cos(tilt))
        left = _carries_on(orientation, orientation.axes[1], foot.max(), foot.min(), high)
        rear = left * max(fell, 0.0)
    stays = min(turn.lift - height, turn.rear_lift - rear, _skew_lift(orientation) - height)
    margin = max(stays, _certain(orientation, orientations, turn, height))
    return _split_turn(turn, min(max(share, 0.0), 1.0), height), margin


def beyond_ledge(
    orientation: Orientation, orientations: Sequence[Orientation], width: float
) -> tuple[PlaceShares, float]:
    """Return what becomes of an orientation that has its weight beyond a ledge.

    Parameters
    ----------
    orientation : Orientation
    orientations : sequence of Orientation
        All of the part.
    width : float [m]
        Of the ledge.

    Returns
    -------
    shares : tuple of (int, float [1])
        As ``over_step``; empty where it stays.
    margin : float [m]
        Of what stays, the height by which it misses its barriers.

    References
    ----------
    docs/tooling.md, "4. Turning parts over".
    """
    turn, drop = turn_over(orientation, tuple(orientations), True), below_ledge(orientations)
    if drop >= turn.sure:
        return _split_turn(turn, 1.0, drop), _certain(orientation, orientations, turn, drop)
    over, height, corners = orientation.distance - width, orientation.posture.height, orientation.foot.corners
    reach = (corners[:, 1].max() if len(corners) else 0.0) + over
    tilt = math.asin(min(drop / reach, 1.0)) if reach > 0.0 else 0.5 * math.pi
    fell, missed = height * (1.0 - math.cos(tilt)) + over * math.sin(tilt), 0.0
    if tilt < turn.angle:
        left = _carries_on(orientation, orientation.axes[0], over, over - reach, height) * fell
        missed = turn.lift + fell - drop - left
    if missed > 0.0:
        pitch = turn_over(orientation, tuple(orientations), False).lift - (drop - fell)
        return (), min(missed, pitch, _skew_lift(orientation) - drop)
    return _split_turn(turn, 0.5, drop), drop - turn.sure


def _certain(orientation: Orientation, orientations: Sequence[Orientation], turn: Turn, drop: float) -> float:
    """Margin [m] by which a part turns over at a drop and stays on the face below."""
    landed = orientations[turn.onto]
    fall = drop + orientation.posture.height - landed.posture.height
    skew = min(_skew_lift(orientation) - drop, _skew_lift(landed) - fall)
    return min(drop - turn.sure, turn.holds - drop, skew)


def _skew_lift(orientation: Orientation) -> float:
    """Least rise [m] of the centre of mass over a side of the foot that is askew; infinite without one."""
    if len(orientation.foot.corners) < 3:
        return math.inf
    ring = outline(orientation.foot.corners)
    along = np.roll(ring, -1, axis=0) - ring
    size = np.hypot(*along.T)
    askew = np.abs(along).min(axis=1) > SKEW * size
    height = orientation.posture.height
    lifts = np.hypot(np.abs(cross(along, ring)) / size, height) - height
    return float(lifts[askew].min(initial=math.inf))


def _split_turn(turn: Turn, share: float, drop: float) -> PlaceShares:
    """Orientations it is turned into, with their shares: half of them further where momentum may carry on."""
    if not share > 0.0:
        return ()
    if drop <= turn.holds:
        return ((turn.onto, share),)
    return (turn.onto, 0.5 * share), (turn.beyond, 0.5 * share)


def _carries_on(orientation: Orientation, axis: Vector, first: float, last: float, height: float) -> float:
    """Share of the energy that is left of turning about one point of a plane when the part lands on another.

    Both lie below the centre of mass by ``height``, and ``first`` and ``last`` [m] beside it; ``axis`` (3,)
    is that of the turn, in the file's axes.
    Source: G. W. Housner, "The behavior of inverted pendulum structures during earthquakes", Bull. Seism.
    Soc. Am. 53, 403-417, 1963: nothing rebounds.
    """
    solid = orientation.solid
    arm = float(np.einsum("i,ij,j->", axis, solid.inertia, axis)) / solid.mass  # radius of gyration, squared
    near, far = arm + first**2 + height**2, arm + last**2 + height**2
    return max(arm + first * last + height**2, 0.0) ** 2 / (near * far)


@functools.lru_cache(maxsize=2048)
def turn_over(orientation: Orientation, orientations: tuple[Orientation, ...], inwards: bool) -> Turn:
    """Return how an orientation turns over an edge, and into which.

    Parameters
    ----------
    orientation : Orientation
    orientations : tuple of Orientation
        All of the part.
    inwards : bool
        Towards the bowl's axis, as at a ledge; else over its leading edge, as at a step.

    Returns
    -------
    Turn

    References
    ----------
    docs/tooling.md, "4. Turning parts over".
    """
    solid, high = orientation.solid, orientation.posture.height
    hull = convex_hull(cast(Points, solid.vertices), solid.centre_of_mass, solid.source)
    x, y, z = orientation.axes
    lying = (y, x, -z) if inwards else (x, y, -z)
    angle, height, landed = _tip_over(hull, lying, inwards)
    lift = max(height - high, 0.0)
    behind = barrier(vectors.product(hull.vertices, np.column_stack([-lying[0], lying[2]])))[1]
    foot = orientation.foot.corners[:, int(inwards)]
    long = float(np.ptp(foot)) if len(foot) else (orientation.width if inwards else orientation.length)
    # the drop up to which it stays on the face onto which it rolls
    side, rear, down = landed
    points = vectors.product(hull.vertices, np.column_stack([side, down]))
    low = points[:, 1].max()
    below = points[points[:, 1] > low - TOUCHES * np.ptp(points, axis=0).max(), 0]
    left, rise = _carries_on(orientation, rear, below.min(), below.max(), low), barrier(points)[1] - low
    return Turn(
        angle=angle,
        lift=lift,
        rear_lift=max(behind - high, 0.0),
        sure=max(long * math.sin(min(angle, 0.5 * math.pi)), lift),
        holds=max(rise / left + low - high, 0.0) if left > 0.0 else math.inf,
        onto=_find_landing(orientation, hull, landed, inwards, orientations),
        beyond=_find_landing(orientation, hull, _tip_over(hull, landed, inwards)[2], inwards, orientations),
    )


def _tip_over(hull: Hull, frame: Frame, inwards: bool) -> tuple[float, float, Frame]:
    """The barrier's angle, its height, and the frame a part tips into: to the side, along its axis, down."""
    side, rear, down = frame
    angle, height = barrier(vectors.product(hull.vertices, np.column_stack([side, down])))
    past = math.cos(angle + BARRIER_OVERSHOOT_RAD) * down + math.sin(angle + BARRIER_OVERSHOOT_RAD) * side
    # let go there, it comes to rest with another direction down
    edges, ends = tumbling.half_edges(hull), np.empty(1, dtype=np.int64)
    fitting(walks.rolls, len(edges.origins))(edges, np.array([past]), ends)
    rests = edges.normals[ends[0]] if ends[0] >= 0 else past
    rear = vectors.carried(rear, past, rests)
    return angle, height, (np.cross(rear, rests) if inwards else np.cross(rests, rear), rear, rests)


def _find_landing(
    orientation: Orientation, hull: Hull, frame: Frame, inwards: bool, orientations: Sequence[Orientation]
) -> int:
    """Place of the orientation that a part takes against the wall, set down in a frame."""
    side, rear, down = frame
    axes = np.array([rear, side, -down] if inwards else [side, rear, -down])  # ahead, inwards and up
    corners = vectors.product(hull.vertices, axes.T)
    height = -corners[:, 2].min()
    corners[:, 2] += height
    posture = replace(
        orientation.posture,
        height=float(height),
        outline=outline(corners[:, :2]),
        corners=check.frozen(corners),
        axes=check.frozen(axes),
    )
    stable = wall.headings(posture, orientation.track)
    turn = stable.headings[wall.settled(stable, 0.0)]
    (supports,), _ = sameness.looks(posture, [turn])
    differences = [np.abs(_look(other) - supports[0]).max() for other in orientations]
    return int(np.argmin(np.round(differences, 6)))


@functools.lru_cache(maxsize=1024)
def _look(orientation: Orientation) -> Floats:
    return sameness.looks(orientation.posture, [orientation.heading])[0][0, 0]


# -- laid in a groove, a V of two faces, where its weight finds the lowest place


def becomes_in_groove(
    orientation: Orientation, orientations: Sequence[Orientation], angle: float
) -> tuple[tuple[int, float], ...]:
    """Return what an orientation becomes in a groove; it comes askew, one way as often as the other.

    Parameters
    ----------
    orientation : Orientation
    orientations : sequence of Orientation
        All of the part.
    angle : float [rad]
        Of both faces from level.

    Returns
    -------
    tuple of (int, float [1])
        The orientations that it becomes, by their places, -1 for an unknown one, and the share of each.

    References
    ----------
    docs/tooling.md, "A groove".
    """
    shares: dict[int, float] = {}
    own = DeviceEncounter(orientation, orientations).place
    for turn in (-YAW_RAD, YAW_RAD):
        reach = _reach_in_groove(orientation.posture, orientation.heading + turn, angle)
        off = [
            float(np.abs(on_side.reaches(other.posture, other.heading) - reach).max(axis=1).min())
            for other in orientations
        ]
        size = on_side.REACH_TOLERANCE * float(reach.max())
        best = own if off[own] < size else int(np.argmin(off))
        place = best if off[best] < size else -1
        shares[place] = shares.get(place, 0.0) + 0.5
    return tuple(shares.items())


def groove_height(points: Points, angle: float) -> Floats:
    """Return how high over the bottom of a groove a centre of mass is, its part resting on both faces.

    With d and e its distances to the inner and the outer face it is (d + e) / (2 cos(angle)).

    Parameters
    ----------
    points : (..., V, 3) float [m]
        Of the part from its centre of mass: ahead, inwards along the inner face, square to that face.
    angle : float [rad]
        Of both faces from level.

    Returns
    -------
    (...) float [m]

    References
    ----------
    docs/tooling.md, "A groove".
    """
    s, c = np.sin(2.0 * angle), np.cos(2.0 * angle)
    inner = -points[..., 2].min(axis=-1)
    outer = -(s * points[..., 1] + c * points[..., 2]).min(axis=-1)
    return (inner + outer) / (2.0 * np.cos(angle))


def settled_in_groove(points: Points, angle: float) -> Floats:
    """Return a part as it comes to lie in a groove: turned downhill until no turn leads lower.

    Parameters
    ----------
    points : (V, 3) float [m]
        As of ``groove_height``.
    angle : float [rad]
        Of both faces from level.

    Returns
    -------
    (V, 3) float [m]

    References
    ----------
    docs/tooling.md, "A groove".
    """
    step, here = FIRST_STEP_RAD, float(groove_height(points, angle))
    while step > LAST_STEP_RAD:
        turned = vectors.product(points, _turns(step))
        heights = groove_height(turned, angle)
        best = int(np.argmin(heights))
        if heights[best] < here * (1.0 - 1e-9):
            points, here = turned[best], float(heights[best])
        else:
            step *= 0.5
    return points


@functools.lru_cache(maxsize=32)
def _turns(step: float) -> Floats:
    """Matrices (2 STEP_AXES, 3, 3) that turn rows by a step [rad] about axes spread over the sphere."""
    axes = sameness.directions()
    axes = axes[:: len(axes) // STEP_AXES][:STEP_AXES]
    s, c = np.sin(step), np.cos(step)
    rotations = []
    for x, y, z in np.concatenate([axes, -axes]):
        across = np.array([[0.0, z, -y], [-z, 0.0, x], [y, -x, 0.0]])
        rotations.append(c * np.eye(3) + s * across + (1.0 - c) * np.outer([x, y, z], [x, y, z]))
    return np.array(rotations)


@functools.lru_cache(maxsize=2048)
def _reach_in_groove(posture: Posture, heading: float, angle: float) -> Floats:
    """Return how far a part that comes at a heading reaches (REACH_DIRECTIONS,) [m], lying in a groove."""
    return on_side.reach_of(settled_in_groove(on_side.corners_from_centre(posture, heading), angle))


# -- what a device asks, and how it says what becomes of an orientation


def _asks(function: Callable[..., Any]) -> Callable[..., Any]:
    """A method that hands a function its orientation: devices lie below this module, and ask through it."""
    return lambda self, *arguments: function(self.orientation, *arguments)


def _asks_among(function: Callable[..., Any]) -> Callable[..., Any]:
    """The same, with all orientations of the part."""
    return lambda self, *arguments: function(self.orientation, self.orientations, *arguments)


class DeviceEncounter:
    """One orientation at a device: answers what a device asks of it, and makes verdicts.

    Parameters
    ----------
    orientation : Orientation
    orientations : sequence of Orientation, optional
        All of the part.
    sigma : float [m], optional
        Standard deviation of play and tolerance together.
    """

    def __init__(
        self, orientation: Orientation, orientations: Sequence[Orientation] = (), sigma: float = 0.0
    ) -> None:
        self.orientation, self.orientations, self.sigma = orientation, tuple(orientations), sigma
        self.hanging = isinstance(orientation, Hanging)  # between rails
        # [1] friction of the track: of one that is only placed, that of a bowl of the defaults
        self.grip = orientation.grip if orientation.grip > 0.0 else GRIP

    @property
    def place(self) -> int:
        """Return its place among the orientations, also where the track leans otherwise by now."""
        own = self.orientation
        for k, other in enumerate(self.orientations):
            if other is own or (other.posture is own.posture and other.heading == own.heading):
                return k
        raise ValueError(f"{own.name} is not one of the orientations")

    @property
    def mouth(self) -> float:
        """Return how far [m] its weight is from the rim that it stands on: of a cup mouth down; else 0."""
        return self.orientation.foot.mouth

    def passing(self) -> Verdict:
        """Return the verdict of a device that does nothing."""
        return Verdict(1.0, float("nan"))

    def verdict(self, margin: float, shift: float = 0.0, hangs: bool = False) -> Verdict:
        """Return the verdict of a margin.

        Parameters
        ----------
        margin : float [m]
        shift : float [rad], optional
            As in Verdict.
        hangs : bool, optional
            As in Verdict.

        Returns
        -------
        Verdict
        """
        return Verdict(self.share(margin), float(margin), float(shift), hangs)

    def turning(self, shares: PlaceShares, margin: float) -> Verdict:
        """Return the verdict of a device that turns shares of it into others.

        Parameters
        ----------
        shares : tuple of (int, float [1])
            Places of orientations, and the share of each.
        margin : float [m]

        Returns
        -------
        Verdict
            The rest goes on as it came.
        """
        here, stays = self.place, 1.0 - sum(part for _, part in shares)
        return Verdict(1.0, float(margin), onto=(((here, stays),) if stays > 0.0 else ()) + tuple(shares))

    def share(self, margin: float) -> float:
        """Return the share that passes at a margin.

        Parameters
        ----------
        margin : float [m]

        Returns
        -------
        float [1]
        """
        return share(margin, self.sigma)

    def over_span(self, span: tuple[float, ...]) -> float:
        """Return its margin on a track without what lies between two distances off the wall.

        Parameters
        ----------
        span : tuple of float [m]
            From and to, off the wall.

        Returns
        -------
        float [m]
        """
        radius, (first, last) = self.orientation.track.radius, span
        high = radius - first if first > 0.0 else 2.0 * radius
        return footprints.over_ring(self.orientation.axial_foot, max(radius - last, 0.0), high)

    def over_slot(self, span: tuple[float, ...]) -> float:
        """Return its margin as ``over_span``; not sure where it may ride over the hole on its sides.

        Parameters
        ----------
        span : tuple of float [m]
            From and to, off the wall.

        Returns
        -------
        float [m]
        """
        margin = self.over_span(span)
        return max(margin, -UNSURE) if self.rides(span[1] - span[0], np.inf) else margin

    over_hole = _asks(lambda orientation, hole: footprints.least(orientation.axial_foot, hole))
    unheld = _asks(lambda orientation, hole: footprints.unheld(orientation.axial_foot, hole))
    astride = _asks(falling.astride)  # (ahead)
    leans = _asks(falling.wall_holds)  # (width)
    rides = _asks(falling.rides_over)  # (width, length)
    falls_through = _asks(falling.falls_through)  # (cut)
    held_by_shoulders = _asks(shoulder_margin)  # (span)
    differs = _asks(sensor_views.difference)  # (other, sees)
    askew = _asks(sensor_views.askew)  # (sees)
    force_to_clear = _asks(force_to_clear)  # (wide, height)
    pitched = _asks_among(turn_over)  # (inwards)
    pitched_over = _asks_among(over_step)  # (height)
    rolled_over = _asks_among(beyond_ledge)  # (width)

    def held_by_head(self, width: float, widest: float) -> float:
        """Return by how much a slot lets the shank down and holds the head.

        Parameters
        ----------
        width : float [m]
            Of the slot.
        widest : float [m]
            The slot's greatest width, at which it has to hold the head.

        Returns
        -------
        float [m]
            Negative where it does not do both; -inf of a part without a head.
        """
        own_neck = neck(self.orientation)
        return -np.inf if own_neck is None else min(width - own_neck.shank, own_neck.head - widest)

    def may_catch(self, entry: tuple[float, ...], span: tuple[float, ...]) -> bool:
        """Tell whether its head may stick between rails as a wedge, or its shank not turn down.

        Parameters
        ----------
        entry, span : tuple of float [m]
            Of the rails' slot at its begin and behind it: from and to, off the wall.

        Returns
        -------
        bool
            False of an orientation that is only placed.
        """
        own, own_neck = self.orientation, neck(self.orientation)
        if own.grip <= 0.0:
            return False
        if own_neck is None or (head_first(own) and falling.may_wedge(own, entry)):
            return True
        is_straight = abs(own_neck.tip) <= STRAIGHT_SHANK_SHARE * own_neck.shank
        beyond = own.distance + own_neck.tip - entry[0]
        goes_down = is_straight or beyond >= TIP_BEYOND_RAIL_SHARE * 0.5 * own_neck.shank
        return not (goes_down and falling.hangs_free(own, span))

    def blown(self, force: float, down: float, seconds: float) -> float:
        """Return how far a force carries it over a track that stands still, less its way to the free edge.

        With the speed v = (F - mu N) t / m after a time t it goes v t / 2, and then v^2 / (2 g mu).

        Parameters
        ----------
        force : float [N]
            F, sideways.
        down : float [N]
            Presses it on the track meanwhile: N is its weight and that.
        seconds : float [s]
            t.

        Returns
        -------
        float [m]
            Negative where it stays, as what hangs between rails does.
        """
        orientation, gravity = self.orientation, self.orientation.gravity
        mass, to_edge = orientation.posture.mass, orientation.track.width - orientation.distance
        left = force - self.grip * max(mass * gravity + down, 0.0)
        if self.hanging or left <= 0.0:
            return -to_edge
        speed = left * seconds / mass
        distance = 0.5 * speed * seconds + speed**2 / (2.0 * gravity * self.grip)
        return float(distance - to_edge)

    def unless_laid_over(self, margin: float, low: float, sweep: float = 0.0) -> float:
        """Return the margin of a part that a blade holds up; not sure where it may lay the part over.

        Parameters
        ----------
        margin : float [m]
        low : float [m]
            Height of the blade's edge.
        sweep : float [rad], optional
            Of its face to the direction of travel: such a blade may lay it over to the side as well.

        Returns
        -------
        float [m]
        """
        if not margin < 0.0 < self.orientation.grip:
            return margin
        over = falling.may_lay_over(self.orientation, low) or (
            sweep > 0.0 and falling.may_lay_aside(self.orientation, low, sweep)
        )
        return max(margin, -UNSURE) if over else margin

    def through(self, opening: shapely.Geometry) -> float:
        """Return its margin in an opening: not sure where the gate may lay over a part that travels.

        Parameters
        ----------
        opening : shapely geometry [m]
            Distance from the wall, and height.

        Returns
        -------
        float [m]
        """
        orientation, margin = self.orientation, opening_margin(opening, self.orientation)
        if margin >= 0.0 or orientation.grip <= 0.0:
            return margin
        worn = _gate_area(opening.buffer(min(WORN, -0.5 * margin)), orientation.track.width)
        return self.unless_laid_over(margin, orientation.view_ahead.intersection(worn).bounds[1])

    def laid_in_groove(self, angle: float) -> Verdict:
        """Return the verdict of a groove: sure of what lies in it as it came.

        Parameters
        ----------
        angle : float [rad]
            Of both faces from level.

        Returns
        -------
        Verdict
        """
        here, landed = self.place, becomes_in_groove(self.orientation, self.orientations, angle)
        if landed == ((here, 1.0),):
            return self.passing()
        return Verdict(1.0, -UNSURE, onto=tuple((here if k < 0 else k, part) for k, part in landed))

    def stood_on_side(self, angle: float) -> Verdict:
        """Return the verdict of a track that twists with its wall.

        Parameters
        ----------
        angle : float [rad]
            By which it is twisted at its end, where the levers are least.

        Returns
        -------
        Verdict
            Its margin is the least lever of the weight at that angle. Not sure where the track's friction may
            tip it ahead or back; nor where it turns into the corner, or lies on none of its aspects: then it
            counts as it came.
        """
        own, levers = self.orientation, on_side.side_levers(self.orientation, angle)
        (x, y, z), solid = own.axes, own.solid
        axes, margin = np.array([x, -z, y]), levers.least
        if levers.out < 0.0:  # it tips once more, away from the floor that has become a wall
            hull = convex_hull(cast(Points, solid.vertices), solid.centre_of_mass, solid.source)
            side, rear, down = _tip_over(hull, (z, x, -y), False)[2]
            axes = np.array([rear, -side, -down])
        elif levers.along < self.grip * levers.height:  # friction may tip it over an end of its side
            margin = -UNSURE
        lies = on_side.find_on_side(self.orientations, axes)
        if lies is None or not min(levers.back, levers.along) >= 0.0:
            return Verdict(1.0, -UNSURE, onto=((self.place, 1.0),))
        place = next((k for k, other in enumerate(self.orientations) if other is lies), -1)
        if place < 0:
            return Verdict(1.0, margin, lands=lies)
        return Verdict(1.0, margin, onto=((place, 1.0),))


def opening_margin(opening: shapely.Geometry, orientation: Orientation) -> float:
    """Return by how much a part, as it is seen over the track, stays within an opening.

    Track and wall are no border of it, and what of the part is beyond the track's free edge meets no gate.

    Parameters
    ----------
    opening : shapely geometry [m]
        Distance from the wall, and height.
    orientation : Orientation

    Returns
    -------
    float [m]
        Negative by how far it reaches into the gate.

    References
    ----------
    docs/tooling.md, "1. The method".
    """
    width = orientation.track.width
    over_track = shapely.box(-BEYOND_OPENING_M, -BEYOND_OPENING_M, width, BEYOND_OPENING_M)
    silhouette = orientation.view_ahead.intersection(over_track)
    inside = silhouette.distance(_gate_area(opening, width))
    if inside > 0.0:
        return inside
    return -float(shapely.distance(shapely.points(shapely.get_coordinates(silhouette)), opening).max())


def _gate_area(opening: shapely.Geometry, width: float) -> shapely.Geometry:
    """A gate as wide as the track, without its opening; track and wall themselves are none of it."""
    return shapely.box(0.0, 0.0, width, BEYOND_OPENING_M).difference(opening)
