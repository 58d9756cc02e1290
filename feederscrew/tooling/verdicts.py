"""An orientation at a device: where it drifts, what turns it over, and the device's verdict."""

import functools
import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import shapely

from feederscrew import check
from feederscrew.geometry import vectors
from feederscrew.geometry.compiled import fitting
from feederscrew.geometry.polygons import barrier, cross, outline
from feederscrew.mechanics import headings as wall
from feederscrew.mechanics import sameness
from feederscrew.mechanics.lying_in_groove import becomes
from feederscrew.part.hull import convex_hull
from feederscrew.resting import half_edges as tumbling
from feederscrew.resting import walks
from feederscrew.tooling import footprints, sensor_views
from feederscrew.tooling.devices.base import GRIP, UNSURE, Verdict, share
from feederscrew.tooling.devices.ledges import below_ledge
from feederscrew.tooling.falling import (
    falls_through,
    greatest_width,
    hangs_free,
    may_lay_aside,
    may_lay_over,
    may_wedge,
    rides_over,
    wall_holds,
)
from feederscrew.tooling.orientations import (
    Hanging,
    hanging_margin,
    head_first,
    shoulder_margin,
    tip_goes_down,
)

FORCE_BISECTIONS = 60


def drift_speed(push, friction, swing, gravity):
    """Return the velocity [m/s] at which a steady sideways push moves what slips on a vibrating track.

    Source: v = a pi V / (2 mu g ln(4 V / v)); docs/tooling.md, "1. The method".

    Parameters
    ----------
    push : float [m/s2]
        Force over mass.
    friction : float [1]
    swing : float [m/s]
        Amplitude of the relative velocity along the track.
    gravity : float [m/s2]

    Returns
    -------
    float [m/s]
        Infinite where friction does not hold the push back at all.

    Notes
    -----
    push = 2 mu g v ln(4 V / v) / (pi V), the mean of Coulomb friction over a sine, for v well below V; it
    rises with v up to v = 4 V / e, where the push is 8 mu g / (pi e): 0.94 of what holds on a still track.
    """
    fastest = 4.0 * swing / math.e
    if swing <= 0.0:
        return 0.0 if push <= friction * gravity else math.inf

    def holding(v):
        return 2.0 * friction * gravity * v * math.log(4.0 * swing / v) / (math.pi * swing)

    if push <= 0.0:
        return 0.0
    if push >= holding(fastest):
        return math.inf
    low, high = 0.0, fastest
    for _ in range(FORCE_BISECTIONS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if holding(middle) < push else (low, middle)
    return high


def force_to_clear(orientation, wide, height):
    """Return the least sideways force [N] that takes an orientation off the track as it passes.

    Source: docs/tooling.md, "1. The method".

    Parameters
    ----------
    orientation : Orientation
        That travels.
    wide : float [m]
        Way along the track over which the force acts.
    height : float [m]
        Over the track, at which it acts.

    Notes
    -----
    It drifts to the free edge in the time it takes to pass, or slides outright; or it tips over the side of
    its foot, where force times height is beyond weight times the way from its centre of mass to that side.
    """
    side, weight = orientation.foot_reach, orientation.posture.mass * orientation.gravity
    tips = weight * side / height if height > 0.0 else math.inf
    return min(_force_to_shift(orientation, wide), tips)


@functools.lru_cache(maxsize=1024)
def _force_to_shift(orientation, wide):
    """The least sideways force [N] that drifts an orientation off the track over a way, or slides it off."""
    weight, friction = orientation.posture.mass * orientation.gravity, max(orientation.grip, 1e-3)
    distance = max(orientation.track.width - orientation.distance, 0.0)
    low, high = 0.0, friction * weight
    for _ in range(FORCE_BISECTIONS):
        middle = 0.5 * (low + high)
        drift = drift_speed(
            middle / orientation.posture.mass, friction, orientation.swing, orientation.gravity
        )
        gone = drift * wide >= distance * orientation.speed
        low, high = (low, middle) if gone else (middle, high)
    return high


BARRIER_OVERSHOOT_RAD = 1e-7  # [rad] past the barrier a part rolls down by itself
TOUCHES = 1e-5  # of the part's size: hull corners that low rest on the track
SKEW = 0.2  # sine of the angle from which a side of the foot is neither along the track nor across it


@dataclass(frozen=True)
class Turn:
    """How an orientation turns over, and into which."""

    angle: float  # [rad] at which the centre of mass stands over its barrier
    lift: float  # [m] by which it is then higher than lying
    rear_lift: float  # [m] the same over the side behind it
    sure: float  # [m] drop of the track from which the part turns over without any momentum
    holds: float  # [m] drop from which its momentum may carry it further; infinite where none does
    onto: int  # place of the orientation it lands in
    beyond: int  # ... and of that into which it goes if it is carried further


def pitch_over(orientation, orientations) -> Turn:
    """Return how an orientation turns over its leading edge, as a part does at a step: a Turn.

    Parameters
    ----------
    orientation : Orientation
    orientations : tuple of Orientation
        Of the part on the track.
    """
    return _turn(orientation, tuple(orientations), False)


def roll_over(orientation, orientations) -> Turn:
    """Return how an orientation turns over inwards, as a part does at a ledge: a Turn."""
    return _turn(orientation, tuple(orientations), True)


def over_step(orientation, orientations, height) -> tuple[Any, ...]:
    """Return what a step does with an orientation.

    A drop below the barrier leaves every part as it lies: what it falls through lifts it over no more, unless
    the rear, as it follows, carries it on over its rear edge. From the height at which the track's edge tilts
    the lying part up to its barrier, every part turns. In between momentum decides; the share is taken to
    grow evenly with the height. So it does where the face on which it lands may not hold it: half of the
    parts are taken to go on over the next edge.

    Source: docs/tooling.md, "4. Turning parts over".

    Parameters
    ----------
    orientation : Orientation
    orientations : tuple of Orientation
    height : float [m]
        Of the step.

    Returns
    -------
    turned : tuple of (int, float [1])
        Places of orientations that it is turned into, with their shares.
    margin : float [m]
        Negative where momentum decides.
    """
    turn = pitch_over(orientation, orientations)
    room = turn.sure - turn.lift
    share = (height - turn.lift) / room if room > 0.0 else float(height >= turn.lift)
    stays = min(
        turn.lift - height, turn.rear_lift - _rear(orientation, height), _skew_lift(orientation) - height
    )
    margin = max(stays, _certain(orientation, orientations, turn, height))
    return _turned(turn, min(max(share, 0.0), 1.0), height), margin


def _rear(orientation, height):
    """Height [m] to which its momentum still lifts a part whose rear has followed it down a step."""
    foot = orientation.foot.corners[:, 0]
    if not len(foot):
        return math.inf
    tilt = math.asin(min(height / np.ptp(foot), 1.0)) if np.ptp(foot) > 0.0 else 0.5 * math.pi
    fell = foot.max() * math.sin(tilt) - orientation.posture.height * (1.0 - math.cos(tilt))
    return _carries_on(
        _arm(orientation, orientation.axes[1]), foot.max(), foot.min(), orientation.posture.height
    ) * max(fell, 0.0)


def beyond_ledge(orientation, orientations, width) -> tuple[Any, ...]:
    """Return what becomes of an orientation whose weight lies beyond a ledge, over a second track.

    It tips about the edge until it leans on both tracks. If the second one lies so low that the part has
    passed its barrier by then, wherever the edge is below its foot, it turns over. If it does not pass it
    with what is left of the momentum of the fall, it slides down and lies as before, unless what it has still
    to fall is enough to pitch it over on its way.

    Source: docs/tooling.md, "4. Turning parts over".

    Parameters
    ----------
    orientation : Orientation
    orientations : tuple of Orientation
    width : float [m]
        Of the ledge.

    Returns
    -------
    turned : tuple of (int, float [1])
    margin : float [m]
        As for ``over_step``; of what stays, the height by which it misses its barriers.
    """
    turn, drop = roll_over(orientation, orientations), below_ledge(orientations)
    if drop >= turn.sure:
        return _turned(turn, 1.0, drop), _certain(orientation, orientations, turn, drop)
    missed, left = _leaning(orientation, turn, width, drop)
    if missed > 0.0:
        return (), min(
            missed, pitch_over(orientation, orientations).lift - left, _skew_lift(orientation) - drop
        )
    return _turned(turn, 0.5, drop), drop - turn.sure


def _certain(orientation, orientations, turn, drop):
    """Margin [m] by which a part turns over at a drop and stays on the face below."""
    landed = orientations[turn.onto]
    fall = drop + orientation.posture.height - landed.posture.height
    skew = min(_skew_lift(orientation) - drop, _skew_lift(landed) - fall)
    return min(drop - turn.sure, turn.holds - drop, skew)


def _skew_lift(orientation):
    """Least rise [m] of the centre of mass over a side of the foot that is askew; infinite without one.

    A part that can leave its plane of motion over such a side is sure only where its whole fall is less.
    """
    if len(orientation.foot.corners) < 3:
        return math.inf
    ring = outline(orientation.foot.corners)
    along = np.roll(ring, -1, axis=0) - ring
    size = np.hypot(*along.T)
    askew = np.abs(along).min(axis=1) > SKEW * size
    offsets = np.abs(cross(along, ring)) / size
    lifts = np.hypot(offsets, orientation.posture.height) - orientation.posture.height
    return float(lifts[askew].min(initial=math.inf))


def _turned(turn, share, drop) -> tuple[Any, ...]:
    """Orientations it is turned into, with their shares: half of them further where momentum may carry on."""
    if drop <= turn.holds:
        return ((turn.onto, share),) if share > 0.0 else ()
    return ((turn.onto, 0.5 * share), (turn.beyond, 0.5 * share)) if share > 0.0 else ()


def _leaning(orientation, turn, width, drop) -> tuple[Any, ...]:
    """How a part leans over a ledge, one corner on the second track, onto which it has fallen.

    It turns about the edge, falls onto its inner corner and goes on about that, without rebound: its angular
    momentum about the corner stays.

    Returns
    -------
    height [m] by which it misses its barrier, negative where it may pass it; how far it has still to fall
    """
    over, height = orientation.distance - width, orientation.posture.height
    reach = (orientation.foot.corners[:, 1].max() if len(orientation.foot.corners) else 0.0) + over
    tilt = math.asin(min(drop / reach, 1.0)) if reach > 0.0 else 0.5 * math.pi
    fell = height * (1.0 - math.cos(tilt)) + over * math.sin(tilt)
    if tilt >= turn.angle:
        return 0.0, drop - fell
    left = _carries_on(_arm(orientation, orientation.axes[0]), over, over - reach, height) * fell
    return turn.lift + fell - drop - left, drop - fell


def _carries_on(arm, first, last, height):
    """Share of the energy that is left of turning about one point of a plane when the part lands on another.

    Both lie below the centre of mass by ``height``, and ``first`` and ``last`` [m] beside it; ``arm`` [m2] is
    the square of its radius of gyration. Nothing rebounds (G. W. Housner, "The behavior of inverted pendulum
    structures during earthquakes", Bull. Seism. Soc. Am. 53, 403-417, 1963).
    """
    near, far = arm + first**2 + height**2, arm + last**2 + height**2
    return max(arm + first * last + height**2, 0.0) ** 2 / (near * far)


def _arm(orientation, axis):
    """Square of the radius of gyration [m2] about an axis (3,) in the file's axes."""
    solid = orientation.posture.solid
    return float(np.einsum("i,ij,j->", axis, solid.inertia, axis)) / solid.mass


@functools.lru_cache(maxsize=2048)
def _turn(orientation, orientations, inwards) -> Turn:
    solid = orientation.posture.solid
    hull = convex_hull(solid.vertices, solid.centre_of_mass, solid.source)
    x, y, z = orientation.axes
    lying = (y, x, -z) if inwards else (x, y, -z)
    angle, height, landed = _tipped(hull, lying, inwards)
    lift = max(height - orientation.posture.height, 0.0)
    behind = barrier(vectors.product(hull.vertices, np.column_stack([-lying[0], lying[2]])))[1]
    foot = orientation.foot.corners[:, int(inwards)]
    long = float(np.ptp(foot)) if len(foot) else (orientation.width if inwards else orientation.length)
    return Turn(
        angle=angle,
        lift=lift,
        rear_lift=max(behind - orientation.posture.height, 0.0),
        sure=max(long * math.sin(min(angle, 0.5 * math.pi)), lift),
        holds=_holds(hull, orientation, landed),
        onto=_landed(orientation, hull, _axes(landed, inwards), orientations),
        beyond=_landed(orientation, hull, _axes(_tipped(hull, landed, inwards)[2], inwards), orientations),
    )


def _tipped(hull, frame, inwards) -> tuple[Any, ...]:
    """How a part tips from one frame of its own into another.

    A frame is three directions (3,) in the file's axes: to the side it tips to, along its axis, and down.

    Returns
    -------
    angle of the barrier, height of the centre of mass there, the frame in which it comes to rest
    """
    side, rear, down = frame
    angle, height = barrier(vectors.product(hull.vertices, np.column_stack([side, down])))
    past = math.cos(angle + BARRIER_OVERSHOOT_RAD) * down + math.sin(angle + BARRIER_OVERSHOOT_RAD) * side
    rests = _end(hull, past)
    rear = vectors.carried(rear, past, rests)
    return angle, height, (np.cross(rear, rests) if inwards else np.cross(rests, rear), rear, rests)


def _axes(frame, inwards) -> np.ndarray:
    """Axes (3, 3) of the track, ahead, inwards and up, of a frame."""
    side, rear, down = frame
    return np.array([rear, side, -down] if inwards else [side, rear, -down])


def _holds(hull, orientation, frame):
    """Drop of the track [m] up to which a part that rolls onto a face stays on it; infinite for any drop."""
    side, rear, down = frame
    points = vectors.product(hull.vertices, np.column_stack([side, down]))
    height = points[:, 1].max()
    below = points[points[:, 1] > height - TOUCHES * np.ptp(points, axis=0).max(), 0]
    left = _carries_on(_arm(orientation, rear), below.min(), below.max(), height)
    rise = barrier(points)[1] - height
    return max(rise / left + height - orientation.posture.height, 0.0) if left > 0.0 else math.inf


def _end(hull, down):
    """The direction (3,) down in which a part comes to rest that is let go with another one down."""
    edges = tumbling.half_edges(hull)
    ends = np.empty(1, dtype=np.int64)
    fitting(walks.rolls, len(edges.origins))(edges, np.array([down]), ends)
    return edges.normals[ends[0]] if ends[0] >= 0 else down


def _landed(orientation, hull, axes, orientations) -> int:
    """Place of the orientation that a part takes against the wall, set down with its axes (3, 3)."""
    corners = vectors.product(hull.vertices, axes.T)
    height = -corners[:, 2].min()
    corners[:, 2] += height
    lying = replace(
        orientation.posture,
        height=float(height),
        outline=outline(corners[:, :2]),
        corners=check.frozen(corners),
        axes=check.frozen(axes),
    )
    stable = wall.headings(lying, orientation.track)
    turn = stable.headings[wall.settled(stable, 0.0)]
    (supports,), _ = sameness.looks(lying, [turn])
    differences = [np.abs(_look(other) - supports[0]).max() for other in orientations]
    return int(np.argmin(np.round(differences, 6)))


@functools.lru_cache(maxsize=1024)
def _look(orientation):
    return sameness.looks(orientation.posture, [orientation.heading])[0][0, 0]


WORN = 2.5e-4  # [m] what an opening holds by less does not hold a part up
BEYOND_OPENING_M = 10.0  # [m] an opening goes on so far below the track and behind the wall


def verdict(device, orientation, orientations=(), sigma=0.0):
    """Return what a device does with an orientation.

    Source: own; docs/tooling.md, "1. The method".

    Parameters
    ----------
    device : Device
    orientation : Orientation
    orientations : sequence of Orientation
        Of the part, which a device may name.
    sigma : float [m]
        Standard deviation of play and tolerance together: the share that passes is then
        Phi(margin / sigma), not 0 or 1.

    Returns
    -------
    Verdict

    Raises
    ------
    ConfigError
        If a device names an orientation that the part does not have.
    """
    meeting = DeviceEncounter(orientation, orientations, sigma)
    outcome, blur = device.judged(meeting), device.hop_blur(orientation)
    return _less(outcome, blur, meeting) if blur > 0.0 else outcome


def _less(outcome, blur, meeting):
    """A verdict with its margin less what hopping takes of it [m]; within that it is not sure either way."""
    if not np.isfinite(outcome.margin) or outcome.margin == 0.0 or -UNSURE <= outcome.margin < 0.0:
        return outcome
    left = np.copysign(max(abs(outcome.margin) - blur, 0.0), outcome.margin)
    left = left if outcome.margin > 0.0 else min(left, -UNSURE)
    passes = outcome.passes if outcome.onto else meeting.share(left)
    if outcome.onto and outcome.margin > 0.0 and left == 0.0:
        left = -UNSURE
    return replace(outcome, passes=passes, margin=float(left))


class DeviceEncounter:
    """One orientation at a device: what a device asks of it, and how it says what becomes of it."""

    def __init__(self, orientation, orientations=(), sigma=0.0) -> None:
        self.orientation, self.orientations, self.sigma = orientation, tuple(orientations), sigma

    @property
    def size(self) -> float:
        """Its greatest length [m] in the plane of the track or across it."""
        return float(np.hypot(self.orientation.length, max(self.orientation.width, self.orientation.height)))

    @property
    def grip(self):
        """Friction [1] of the track: of one that is only placed, that of a bowl of the defaults."""
        return self.orientation.grip if self.orientation.grip > 0.0 else GRIP

    def falls_through(self, cut):
        """Return whether a hole (K, 2) [m] that does not carry it lets it through."""
        return falls_through(self.orientation, cut)

    def differs(self, other, sees):
        """Return by how much [m] a sensor sees it differ from another orientation."""
        return sensor_views.difference(self.orientation, other, sees)

    def askew(self, sees):
        """Return by how much [m] a sensor may see it differ from itself, as it comes askew."""
        return sensor_views.askew(self.orientation, sees)

    def force_to_clear(self, wide, height):
        """Return the least force [N] over a way along the track that takes it off it, at a height [m]."""
        return force_to_clear(self.orientation, wide, height)

    def blown(self, force, down, seconds):
        """Return how far [m] a force [N] for some time [s] carries it over a track that stands still.

        ``down`` [N] presses it on the track meanwhile. Less what it has to go to leave it: negative where
        it stays, as what hangs between rails does.
        """
        if self.hanging:
            return self.orientation.distance - self.orientation.track.width
        gravity = self.orientation.gravity
        weight = self.orientation.posture.mass * gravity
        left = force - self.grip * max(weight + down, 0.0)
        if left <= 0.0:
            return self.orientation.distance - self.orientation.track.width
        speed = left * seconds / self.orientation.posture.mass
        distance = 0.5 * speed * seconds + speed**2 / (2.0 * gravity * self.grip)
        return float(distance - (self.orientation.track.width - self.orientation.distance))

    @property
    def hanging(self) -> bool:
        """Whether it comes hanging between rails."""
        return isinstance(self.orientation, Hanging)

    @property
    def place(self):
        """Its place among the orientations, also where the track leans otherwise by now."""
        orientation = self.orientation
        for k, other in enumerate(self.orientations):
            if other is orientation or (
                other.posture is orientation.posture and other.heading == orientation.heading
            ):
                return k
        raise ValueError(f"{orientation.name} is not one of the orientations")

    def passing(self) -> Verdict:
        """Return the verdict of a device that does nothing."""
        return Verdict(1.0, float("nan"))

    def verdict(self, margin, shift=0.0, hangs=False) -> Verdict:
        """Return the verdict of a margin [m]; ``shift`` [rad] and ``hangs`` as in Verdict."""
        return Verdict(self.share(margin), float(margin), float(shift), hangs)

    def turning(self, turned, margin) -> Verdict:
        """Return the verdict of a device that turns shares of it into others: (place, share) each."""
        here = self.place
        stays = 1.0 - sum(part for _, part in turned)
        return Verdict(1.0, float(margin), onto=(((here, stays),) if stays > 0.0 else ()) + tuple(turned))

    def share(self, margin):
        """Return the share that passes at a margin [m]."""
        return share(margin, self.sigma)

    def over_span(self, span):
        """Return its margin [m] on a track without what lies between two distances off the wall."""
        radius, (first, last) = self.orientation.track.radius, span
        high = radius - first if first > 0.0 else 2.0 * radius
        return footprints.over_ring(self.orientation.standing, max(radius - last, 0.0), high)

    def over_slot(self, span):
        """Return the same, unless it may ride over the hole on its sides: it is then not sure."""
        margin = self.over_span(span)
        return max(margin, -UNSURE) if self.rides(span[1] - span[0], np.inf) else margin

    def over_hole(self, hole):
        """Return its least margin [m] over the passage of HoleEdges, and the shift [rad] where it is."""
        return footprints.least(self.orientation.standing, hole)

    def unheld(self, hole):
        """Return the longest way [m] over which HoleEdges leave it without support."""
        return footprints.unheld(self.orientation.standing, hole)

    def leans(self, width):
        """Return by how much [m] a strip along the wall may be wider than it passes, as it leans there."""
        return wall_holds(self.orientation, width)

    def rides(self, width, length):
        """Return whether it rides on its round sides over a hole of a width and a length [m]."""
        return rides_over(self.orientation, width, length)

    def widest(self, corners):
        """Return the greatest width [m] across the track of a hole with some corners (K, 2) [m]."""
        return greatest_width(corners)

    def unless_laid_over(self, margin, low, sweep=0.0):
        """Return the margin [m] of what a blade from a height on holds up: none where it may lay it over.

        A face with a ``sweep`` [rad] to the direction of travel may do so to the side as well.
        """
        if not margin < 0.0 < self.orientation.grip:
            return margin
        over = may_lay_over(self.orientation, low) or (
            sweep > 0.0 and may_lay_aside(self.orientation, low, sweep)
        )
        return max(margin, -UNSURE) if over else margin

    def through(self, opening):
        """Return its margin [m] in an opening: ``gate_margin``."""
        return gate_margin(opening, self.orientation)

    def held_by_head(self, width, widest=None):
        """Return by how much [m] a slot of some width, at its widest, holds its head and not its shank."""
        return hanging_margin(self.orientation, width, widest)

    def held_by_shoulders(self, span):
        """Return by how much [m] its shoulders hold it in a slot, its stem down; -inf if not."""
        return shoulder_margin(self.orientation, span)

    def wedges(self, span):
        """Return whether its head, which comes first, may stick between rails as a wedge."""
        return (
            self.orientation.grip > 0.0 and head_first(self.orientation) and may_wedge(self.orientation, span)
        )

    def hangs_free(self, span):
        """Return whether its weight turns its shank down, and its head then stays off the wall."""
        return self.orientation.grip <= 0.0 or hangs_free(self.orientation, span)

    def goes_down(self, near):
        """Return whether the tip of its shank goes down beside a rail that ends ``near`` [m] the wall."""
        return self.orientation.grip <= 0.0 or tip_goes_down(self.orientation, near)

    def pitched(self) -> Turn:
        """Return how it turns over its leading edge: a Turn."""
        return pitch_over(self.orientation, self.orientations)

    def pitched_over(self, height) -> tuple[Any, ...]:
        """Return what a step of some height [m] turns it into, and the margin [m]."""
        return over_step(self.orientation, self.orientations, height)

    def laid_in_groove(self, angle):
        """Return the verdict of a groove, of two faces at an angle [rad]: what it lies in as it came passes.

        What turns there, or comes to lie as none of the known does, is not sure.
        """
        here, landed = self.place, becomes(self.orientation, self.orientations, angle)
        if landed == ((here, 1.0),):
            return self.passing()
        return Verdict(1.0, -UNSURE, onto=tuple((here if k < 0 else k, part) for k, part in landed))

    def rolled_over(self, width) -> tuple[Any, ...]:
        """Return what a ledge of some width [m] turns it into if its weight lies beyond, and the margin."""
        return beyond_ledge(self.orientation, self.orientations, width)


def gate_margin(opening, orientation):
    """Return ``opening_margin`` [m] of an orientation that travels: none where the gate may lay it over."""
    margin = opening_margin(opening, orientation)
    if margin >= 0.0 or orientation.grip <= 0.0:
        return margin
    worn = opening.buffer(min(WORN, -0.5 * margin))
    return DeviceEncounter(orientation).unless_laid_over(margin, _beside_opening(worn, orientation).bounds[1])


def opening_margin(opening, orientation):
    """Return by how much [m] what is seen of a part over the track stays within an opening.

    Source: own; docs/tooling.md, "1. The method".

    Parameters
    ----------
    opening : shapely geometry
        In distance from the wall and height [m]; track and wall themselves are no border of it.
    orientation : Orientation
        What of it is beyond the track's free edge meets no gate.
    """
    silhouette = orientation.view_ahead.intersection(
        shapely.box(-BEYOND_OPENING_M, -BEYOND_OPENING_M, orientation.track.width, BEYOND_OPENING_M)
    )
    inside = silhouette.distance(_gate_area(opening, orientation.track.width))
    if inside > 0.0:
        return inside
    corners = shapely.get_coordinates(silhouette)
    return -float(shapely.distance(shapely.points(corners), opening).max())


def _gate_area(opening, width):
    """A gate as wide as the track, without its opening; track and wall themselves are none of it."""
    gate = shapely.box(0.0, 0.0, width, BEYOND_OPENING_M)
    return gate.difference(opening)


def _beside_opening(opening, orientation):
    """What is seen of an orientation beside an opening."""
    return orientation.view_ahead.intersection(_gate_area(opening, orientation.track.width))
