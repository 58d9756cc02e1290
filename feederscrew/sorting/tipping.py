"""Orientations that the drive turns over on the track, that it only rocks, and those that stay steady."""

import itertools
import math
from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from feederscrew.base import check
from feederscrew.base.arrays import Bools, Floats
from feederscrew.base.errors import ConfigError, Detail
from feederscrew.base.geometry.polygons import convex, cross, inset, sides
from feederscrew.base.units import MM, listed
from feederscrew.bowl.devices.base import Device, opening_at
from feederscrew.bowl.devices.openings import HoleEdges, hole_edges
from feederscrew.bowl.devices.trade import Action
from feederscrew.bowl.record import Bowl
from feederscrew.motion import conveying as answer
from feederscrew.motion import limits, track_balance
from feederscrew.motion.cycle import phases
from feederscrew.motion.floor_balance import HOP, TIP
from feederscrew.motion.hop import hop
from feederscrew.motion.track_balance import Seat, SeatStack, seat
from feederscrew.sorting import footprints
from feederscrew.sorting.falling import surely_gone
from feederscrew.sorting.orientations import Orientation, add_travel, gyration, travel_speed

ROCKING_STEPS = 48  # of one period
SETTLES = 12  # periods until the sliding repeats itself
FOLLOWED = 60  # periods that the rocking is followed
REST_ANGULAR_SPEED = 1e-4  # [rad/s] a part that comes down slower lies still
SENSES = (0.0, 1.0, -1.0)  # at rest, sliding ahead, sliding back


@dataclass(frozen=True)
class Rocker:
    """A part that may tip over either of two opposite sides."""

    near: float  # [m] from the foot of the centre of mass to the side that the drive tips it over most
    far: float  # [m] to the side opposite
    height: float  # [m] of the centre of mass
    spread: float  # [m2] square of its radius of gyration about the direction of the sides
    force: Floats  # (ROCKING_STEPS,) [m/s2] of the track, over the mass
    offset: Floats  # (ROCKING_STEPS,) [m] of that force towards the near side, with the part lying
    growth: float = 0.0  # [m/s] of the distance to the near side, from where it is at the start


def rocker(place: Seat, gyration: Callable[[float], float], bowl: Bowl) -> Rocker:
    """Return a part on the track of a bowl as what rocks over its weakest side, while it lies and slides.

    The weakest side is the one about which the force of the track has the least moment N d over a period, d
    the distance of that force inside it.

    Parameters
    ----------
    place : Seat
    gyration : callable
        Of an angle from the track [rad]: the square of the radius of gyration about that direction [m2].
    bowl : Bowl
        Single values.

    Returns
    -------
    Rocker

    References
    ----------
    Housner 1963, as in ``goes_over``.
    """
    force, offset = over_period(place, bowl)
    along = _side_directions(place.contact)
    inside = cross(along, offset[:, None, :] - place.contact)
    (x, y) = along[np.argmin((force[:, None] * inside).min(axis=0))]
    reach = y * place.contact[:, 0] - x * place.contact[:, 1]
    return Rocker(
        near=float(reach.max()),
        far=float(-reach.min()),
        height=place.height,
        spread=gyration(math.atan2(y, x)),
        force=force,
        offset=y * offset[:, 0] - x * offset[:, 1],
    )


def _side_directions(contact: Floats) -> Floats:
    """Return unit vectors (K, 2) [1] along the sides of what carries a part."""
    along = sides(contact)
    return along / np.hypot(*along.T)[:, None]


def goes_over(rocker: Rocker, period: float, start: int = 0) -> bool:
    """Return whether rocking brings the centre of mass of a part over one of its sides.

    A part tilted by a small angle over a side at distance r turns by

        angle'' = N (o - r + h angle) / (k^2 + r^2 + h^2),

    N the force of the track over its mass and o its offset with the part lying. When it comes down on the
    opposite side at distance s it keeps (k^2 + h^2 - r s) / (k^2 + h^2 + s^2) of its rate, 0 where that is
    negative.

    Parameters
    ----------
    rocker : Rocker
    period : float [s]
        Of the drive.
    start : int
        Instant of the period, of ``ROCKING_STEPS``, from which the part is followed for ``FOLLOWED`` periods.

    Returns
    -------
    bool

    References
    ----------
    G. W. Housner, "The behavior of inverted pendulum structures during earthquakes", Bulletin of the
    Seismological Society of America 53(2), 403-417, 1963.
    """
    step, angle, rate = period / ROCKING_STEPS, 0.0, 0.0
    for k in range(start, start + FOLLOWED * ROCKING_STEPS):
        near = rocker.near + rocker.growth * step * (k - start)
        force, offset = rocker.force[k % ROCKING_STEPS], rocker.offset[k % ROCKING_STEPS]
        side = math.copysign(1.0, angle or rate or offset)
        lever, other = (near, rocker.far) if side > 0.0 else (rocker.far, near)
        still = rocker.spread + rocker.height**2
        turning = force * (offset - side * lever + rocker.height * angle) / (still + lever**2)
        if angle == rate == 0.0 and turning * side <= 0.0:
            continue
        rate += step * turning
        after = angle + step * rate
        if after * side <= 0.0:  # it comes down
            rate *= max((still - lever * other) / (still + other**2), 0.0)
            rate, after = (rate if abs(rate) > REST_ANGULAR_SPEED else 0.0), 0.0
        angle = after
        if abs(angle) >= math.atan2(near if angle > 0.0 else rocker.far, rocker.height):
            return True
    return False


def over_period(place: Seat, bowl: Bowl) -> tuple[Floats, Floats]:
    """Return what the track does to a part over a settled period, in which it slides as it then does.

    Parameters
    ----------
    place : Seat
    bowl : Bowl
        Single values.

    Returns
    -------
    (ROCKING_STEPS,) float [m/s2]
        Force of the track over the mass.
    (ROCKING_STEPS, 2) float [m]
        Where it acts, from the foot of the centre of mass.

    References
    ----------
    Housner 1963, the rocking block; docs/method/trial.md, "What other parts said of the rules".
    """
    phase = phases(ROCKING_STEPS)
    motions = [track_balance.motion(place, bowl, phase, np.full(ROCKING_STEPS, sense)) for sense in SENSES]
    senses = _senses(motions, 1.0 / bowl.drive.frequency / ROCKING_STEPS)
    rows = np.arange(ROCKING_STEPS)
    force = np.array([motion.normal_force for motion in motions])[senses, rows] / place.mass
    return force, np.nan_to_num(np.array([motion.offset for motion in motions])[senses, rows])


def _senses(motions: list[track_balance.TrackMotion], step: float) -> Floats:
    """Return how the part slides at each instant of a settled period.

    The entries (ROCKING_STEPS,) int are places in ``SENSES``. From rest the part begins to slide where
    friction no longer holds it. Sliding, it comes to rest where its speed changes sign.
    """
    gains = [step * motion.acceleration[:, 0] for motion in motions]
    loose, speed = motions[0].slides, 0.0
    senses = np.zeros(ROCKING_STEPS, dtype=int)
    for k in range(SETTLES * ROCKING_STEPS):
        row = k % ROCKING_STEPS
        if speed == 0.0:
            speed = gains[0][row] if loose[row] else 0.0
        else:
            after = speed + gains[1 if speed > 0.0 else 2][row]
            speed = after if after * speed > 0.0 else 0.0
        senses[row] = 0 if speed == 0.0 else 1 if speed > 0.0 else 2
    return senses


TIPPING_PHASES = 12  # of one period
# a part that rolls lies on a line: it rolls where others tip, and tips over the line's ends
FLAT_KIND = "flat"
# of the farthest place of an outline, the nearest: it is round, and no heading of it is another
ROUND_OUTLINE_RATIO = 0.98
MAX_FORCE_OFFSET_HEIGHTS = 10.0  # heights of the centre of mass: no force of a bowl acts so far beside it


@dataclass(frozen=True, eq=False)
class TrackTipping:
    """Effect of the drive on M orientations that lie on the track."""

    tips: Bools  # (M,) bool, at some instant of the cycle
    tilt: Floats  # (M,) [rad] that one stroke brings at most; 0 where it does not tip
    balance: Floats  # (M,) [rad] from which it goes on by itself; NaN where it does not tip
    over: Bools  # (M,) bool, whether its rocking turns it over


STAYS = "stays on its aspect"
ROCKS = "rocks"
OVER = "turns over"
BACK = "rolls back"
THROWN = "is thrown"


@dataclass(frozen=True)
class Stands:
    """Effect of the drive on one orientation on the track: the verdict that the rate reckons with."""

    verdict: str  # STAYS, ROCKS, OVER, BACK or THROWN
    tilt: float = 0.0  # [rad] that one stroke brings at most
    lean: float = np.inf  # [rad] from which it goes on by itself; infinite where it stays

    @property
    def sentence(self) -> str:
        """Return the verdict in words, with its angles."""
        if self.verdict == ROCKS:
            tilt, lean = np.degrees(self.tilt), np.degrees(self.lean)
            return f"rocks by {tilt:.2g} deg a stroke; turns over from {lean:.3g} deg on"
        return {OVER: "turns over, goes back into the bowl", BACK: "rolls back down the climb"}.get(
            self.verdict, self.verdict
        )


def stands(orientation: Orientation, bowl: Bowl, hops: bool) -> Stands:
    """Return what the drive of a bowl does to an orientation on the bare track.

    Parameters
    ----------
    orientation : Orientation
    bowl : Bowl
        Single values.
    hops : bool
        The drive throws the part; what it comes down on is not followed then.

    Returns
    -------
    Stands
    """
    (lying,), tips = marked((orientation,), bowl)
    angles = float(tips.tilt[0]), float(tips.balance[0])
    if lying.turns_over:
        return Stands(OVER, *angles)
    if lying.may_roll_back:
        return Stands(BACK)
    return Stands(ROCKS, *angles) if tips.tips[0] else Stands(THROWN if hops else STAYS)


def marked(
    orientations: Sequence[Orientation], bowl: Bowl, rows: Collection[int] | None = None
) -> tuple[tuple[Orientation, ...], TrackTipping]:
    """Return orientations that know what the drive of a bowl does to them on the track.

    That is whether it turns them over, a landing may tip them, or the wall may turn them out of their
    heading.

    Parameters
    ----------
    orientations : (M,) sequence of Orientation
    bowl : Bowl
        Single values.
    rows : collection of int, optional
        Places of the orientations that are looked at; the others know only how they are carried. None looks
        at all.

    Returns
    -------
    (M,) tuple of Orientation
    TrackTipping

    References
    ----------
    Own; docs/tooling.md, "Parts that hop".
    """
    tips, energy = tipping(orientations, bowl, rows), landing_energy(bowl)
    oriented = [replace(one, turns_over=bool(turns)) for one, turns in zip(orientations, tips.over)]
    presses = energy > 0.0 or bowl.track.bank > 0.0  # a bank presses parts to the wall, thrown or not
    for k, one in enumerate(oriented if presses else ()):
        if (rows is not None and k not in rows) or one.falls_off or one.touching is None:
            continue
        contact = seat_in_groove(one, bowl.track.bank).contact
        tipped = energy > 0.0 and may_tip(contact, one, bowl, energy)
        # the wall drags a part back with mu N, the distance d beside its centre of mass, and so moves its own
        # force N ahead of that by mu d: it keeps its heading while that is within what touches the wall
        outline, along = one.outline, sides(one.outline)
        nearest = (outline[:, 0] * along[:, 1] - outline[:, 1] * along[:, 0]) / np.hypot(*along.T)
        is_round = nearest.min() > ROUND_OUTLINE_RATIO * np.hypot(*outline.T).max()
        beyond = bowl.friction.wall * one.distance > one.touching[1, 0]
        oriented[k] = replace(one, may_tip=tipped, may_yaw=bool(beyond and not (one.groove or is_round)))
    return add_travel(tuple(oriented), bowl), tips


def remark(orientations: Sequence[Orientation]) -> tuple[str, ...]:
    """Return a sentence each: what a drive turns over, how parts hop, which of them may turn as they do."""
    over = [orientation.name for orientation in orientations if orientation.turns_over]
    turning = [
        orientation.name for orientation in orientations if orientation.may_turn and orientation.hop > 0.0
    ]
    hop, flight = max(
        ((orientation.hop, orientation.flight) for orientation in orientations), default=(0.0, 0.0)
    )
    remarks = []
    if over:
        remarks.append(f"{listed(over)} can tip over on the track at this drive and count as returned")
    if hop > 0.0:
        lead = f"at this drive parts hop {hop / MM:.2g} mm high and fly {flight / MM:.2g} mm along the track"
        less = "margins at edges across the track are less that way, all others less that height"
        remarks.append(Detail(f"{lead}: {less}"))
    if turning:
        lead = f"{listed(turning)}: a landing may tip it over, or the wall turn it"
        remarks.append(f"{lead}, so no verdict on it is sure - see feeder trial")
    return tuple(remarks)


def tipping(
    orientations: Sequence[Orientation], bowl: Bowl, rows: Collection[int] | None = None
) -> TrackTipping:
    """Return which orientations tip on the track of a bowl, and which turn over there.

    The greatest moment about a side is taken for half a period, on the moment of inertia m (r^2 + h^2) of the
    centre of mass about that side, r beside it and h above it: an upper estimate. It is over at atan(r / h).
    After the stroke its weight brings it back, by g r / (r^2 + h^2) at most. Where it is then still tilted at
    the next one, or over already, its rocking is followed: ``goes_over``.

    Parameters
    ----------
    orientations : (M,) sequence of Orientation
        They know where they touch the wall.
    bowl : Bowl
        Single values.
    rows : collection of int, optional
        Places of the orientations that are looked at; None looks at all.

    Returns
    -------
    TrackTipping
        No orientation tips where that is not known: a part that rolls or hops, a drive that is not straight.

    References
    ----------
    Own; Housner 1963, as in ``goes_over``.
    """
    states = [(False, 0.0, np.nan, False)] * len(orientations)
    places = {
        k: seat_in_groove(orientation, bowl.track.bank)
        for k, orientation in enumerate(orientations if _is_plain(bowl) else ())
        if (rows is None or k in rows)
        and not (orientation.falls_off or orientation.touching is None or _rolls(orientation))
    }
    phase, tips = phases(TIPPING_PHASES), []
    if places:  # those that tip at some instant at rest, and never hop
        rest = track_balance.motion(SeatStack.of(list(places.values())), bowl, phase)
        at_rest = (rest.state == TIP).any(axis=1) & ~(rest.state == HOP).any(axis=1)
        tips = [k for k, does in zip(places, at_rest) if does]
    if tips:  # what acts on them at rest and sliding either way
        stack = SeatStack.of([places[k] for k in tips])
        motions = [
            track_balance.motion(stack, bowl, phase, np.full(TIPPING_PHASES, sense)) for sense in (-1.0, 1.0)
        ]
        forces, offsets = (
            np.concatenate(
                [getattr(rest, name)[at_rest], *(getattr(other, name) for other in motions)], axis=1
            )
            for name in ("normal_force", "offset")
        )
    for row, k in enumerate(tips):
        place, force, offset = places[k], forces[row], offsets[row]
        # the greatest moment about a side
        moment = force * np.maximum(-inset(place.contact, offset), 0.0)
        worst = int(np.nanargmax(moment))
        # the side that its force lies farthest beyond, and how far the foot of the centre of mass is from it
        along = _side_directions(place.contact)
        beyond = cross(along, offset[worst] - place.contact)
        lever = max(float(cross(along, -place.contact)[np.argmin(beyond)]), 0.0)
        # half a period of that moment, and the way back by its weight
        arm, stroke = lever**2 + place.height**2, 0.5 / bowl.drive.frequency
        rate = moment[worst] / (place.mass * arm) * stroke
        tilt, restoring = 0.5 * rate * stroke, bowl.gravity * lever / arm
        late = rate + np.sqrt(rate**2 + 2.0 * restoring * tilt) > restoring * stroke
        lean = np.arctan2(lever, place.height)
        over = (late or tilt >= lean) and goes_over(
            rocker(place, partial(gyration, orientations[k]), bowl), 2.0 * stroke
        )
        states[k] = True, float(tilt), float(lean), bool(over)
    return TrackTipping(*(check.frozen(np.array(column)) for column in zip(*states)))


def landing_energy(bowl: Bowl) -> float:
    """Return the energy of the hardest landing of a part, as a height: u^2 / (2 g).

    u is the velocity of a point mass towards the track as it lands.

    Parameters
    ----------
    bowl : Bowl

    Returns
    -------
    float [m]
        0 where it never leaves the track.

    References
    ----------
    The kinetic energy of a point mass.
    """
    if travel_speed(bowl) <= 0.0 or hop(bowl).height <= 0.0:
        return 0.0
    return float(answer.answer(bowl).hardest_impact ** 2 / (2.0 * bowl.gravity))


def may_tip(
    contact: Floats, orientation: Orientation, bowl: Bowl, energy: float, margin: float = 0.0
) -> bool:
    """Return whether a landing may tip an orientation over a side of what carries it.

    The track drags the foot by at most mu times what it strikes it with. Let a side lie at the distance b
    from the foot of the centre of mass, its normal at an angle a to the track, and the centre of mass at the
    height h. Then that drag tips the part where mu h |cos a| > b. Where it is less, the part has to be lifted
    by sqrt(h^2 + b^2) - h. Along the track the whole energy E of the landing may do that. Across it nothing
    drags the part: struck at a place beside its centre of mass it keeps (1 + e)^2 / 4 of E as rotation at
    most, e being the restitution. The wall holds a part over a side that faces it; a groove holds it over the
    sides that face both its surfaces.

    Parameters
    ----------
    contact : (K, 2) float [m]
        Corners of what carries the part, in track axes from the foot of the centre of mass.
    orientation : Orientation
    bowl : Bowl
    energy : float [m]
        Of ``landing_energy``.
    margin : float [m]
        By which the contact is taken to be smaller all round.

    Returns
    -------
    bool
        True as well where the contact has no area.

    References
    ----------
    Own; moments of an impact about a side with Coulomb's friction, and the energy to rise over it.
    """
    ring = contact[convex(contact)]
    if len(ring) < 3:
        return True
    edges = sides(ring)
    outward = np.column_stack([edges[:, 1], -edges[:, 0]]) / np.hypot(*edges.T)[:, None]
    along, across = np.abs(outward[:, 0]), np.abs(outward[:, 1]) if orientation.groove else -outward[:, 1]
    reach = np.maximum((outward * ring).sum(axis=1) - margin, 0.0)
    height, struck = orientation.posture.height, 0.25 * (1.0 + bowl.restitution) ** 2
    spent = energy * np.where(along > np.abs(outward[:, 1]), 1.0, struck)
    tips = (bowl.friction.static * height * along > reach) | (np.hypot(height, reach) - height < spent)
    return bool((tips & (across < along)).any())


def _is_plain(bowl: Bowl) -> bool:
    """Return whether a bowl's drive and conveyor are of the plain kind, for which tipping is followed."""
    try:
        return limits.plain(bowl) is bowl
    except ConfigError:
        return False


def _rolls(orientation: Orientation) -> bool:
    return orientation.kind != FLAT_KIND and orientation.rolls_across


def seat_in_groove(orientation: Orientation, bank: float) -> Seat:
    """Return how an orientation lies on a track of some bank.

    One that rolls tips over the ends of its line only, so its contact is made wide beside that line.

    Parameters
    ----------
    orientation : Orientation
    bank : float [rad]

    Returns
    -------
    Seat
    """
    place = seat(orientation.posture, orientation.heading, np.asarray(orientation.touching), bank)
    if orientation.kind == FLAT_KIND:
        return place
    rear, ahead = place.contact[:, 0].min(), place.contact[:, 0].max()
    side = MAX_FORCE_OFFSET_HEIGHTS * place.height
    return replace(place, contact=np.array([[rear, -side], [ahead, -side], [ahead, side], [rear, side]]))


STEADINESS_PHASES = 12  # of one period
LANDINGS = 8  # instants of the period at which it comes to lie on the far edge
SUPPORT_LOSS_TOLERANCE_M = 1e-9  # [m] a device that leaves this much less of the support takes nothing


def steady(
    devices: Sequence[Device], orientations: Sequence[Orientation], bowl: Bowl, margin: float
) -> Bools:
    """Return which orientations the drive leaves lying on what a chain of devices leaves of their feet.

    Of the devices, which let them pass, those up to the first that lets parts hang or turns them over are
    looked at.

    A ledge, a canyon or a slot goes on: there the force of the track has to stay within what is left of the
    foot all through the cycle, as on the bare track, or the part rocks. Over an edge across the track every
    part rocks in the end, since its weight comes near that edge. It is steady if rocking, followed from
    stroke to stroke, does not take it over: ahead where least carries it, however long it stands there, and
    back over the far edge, from which it travels on at the velocity of the point mass. A landing of a part
    that hops must not tip it over what a ledge, a canyon or a slot leaves of its foot, less the margin; over
    an edge across the track the verdict itself is less the flight.

    Parameters
    ----------
    devices : (D,) sequence of Device
    orientations : (M,) sequence of Orientation
    bowl : Bowl
        Single values.
    margin : float [m]
        By which they shall not rock beside an edge along the track.

    Returns
    -------
    (M,) bool
        True also where that is not known: a drive that is not straight.

    References
    ----------
    Own; docs/method/trial.md, "What other parts said of the rules".
    """
    plain, energy = _is_plain(bowl), landing_energy(bowl)
    if energy <= 0.0 and not plain:
        return np.ones(len(orientations), dtype=bool)
    return np.array([_steady(devices, one, bowl, margin, energy) for one in orientations], dtype=bool)


def is_surely_gone(devices: Sequence[Device], orientations: Sequence[Orientation], passes: Floats) -> Bools:
    """Return which orientations the first device that does not let them pass is sure to get rid of.

    Parameters
    ----------
    devices : (D,) sequence of Device
    orientations : (M,) sequence of Orientation
    passes : (M, 1 + D) float [1]
        Share that the track and each device let pass.

    Returns
    -------
    (M,) bool
        True also of what no device returns.

    References
    ----------
    Own; docs/tooling.md, "1. The method".
    """
    gone = np.ones(len(orientations), dtype=bool)
    for row, (orientation, shares) in enumerate(zip(orientations, np.asarray(passes)[:, 1:])):
        first = next((k for k, share in enumerate(shares) if share < 0.5), None)
        if first is not None and not orientation.returned:
            gone[row] = surely_gone(devices[first], orientation)
    return gone


def _steady(
    devices: Sequence[Device], orientation: Orientation, bowl: Bowl, margin: float, energy: float
) -> bool:
    """Return whether one orientation is steady at every device.

    It is so by a margin [m], and lands with an energy [m].
    """
    if orientation.returned or orientation.touching is None:
        return True
    touched = list(
        itertools.takewhile(lambda device: not (device.action.turns or device.action is Action.HANG), devices)
    )
    touched = [device for device in touched if device.action.carries]  # as far as parts come as they lie
    if _rolls(orientation):
        return not any(_takes(device, orientation) for device in touched)
    if energy > 0.0:
        return not any(
            may_tip(_foot_beside(orientation, span), orientation, bowl, energy, margin)
            for device, span in ((device, _span_and_edges(device, orientation)[0]) for device in touched)
            if span is not None and _takes(device, orientation)
        )
    place = seat_in_groove(orientation, bowl.track.bank)
    if (track_balance.motion(place, bowl, phases(STEADINESS_PHASES)).state == HOP).any():
        return True
    force, offset = over_period(place, bowl)
    reach, period = orientation.foot.corners[:, 0], 1.0 / bowl.drive.frequency
    least = orientation.margin - SUPPORT_LOSS_TOLERANCE_M
    for device in touched:
        span, hole = _span_and_edges(device, orientation)
        if span is not None and _takes(device, orientation):
            # the force of the track stays within what is left of the foot beside a hole along the track
            left = _foot_beside(orientation, span)
            hull = left[convex(left)]
            if not (len(hull) > 2 and inset(hull, offset).min() >= margin):
                return False
        if hole is None:
            continue
        support, _ = footprints.least(orientation.axial_foot, hole)
        if support > least:
            continue
        # neither does it rock over the edge that it leaves nor back over the one that it comes to
        leaving = Rocker(
            near=max(support, 0.0),
            far=float(-reach.min()),
            height=place.height,
            spread=gyration(orientation, 0.5 * np.pi),
            force=force,
            offset=offset[:, 0],
        )
        coming = replace(leaving, far=float(reach.max()), offset=-offset[:, 0], growth=travel_speed(bowl))
        starts = range(0, len(force), len(force) // LANDINGS)
        if goes_over(leaving, period) or any(goes_over(coming, period, start) for start in starts):
            return False
    return True


def _foot_beside(orientation: Orientation, span: tuple[float, ...]) -> Floats:
    """Return the corners (K, 2) [m] of what a span of the track leaves of a foot."""
    foot, radius = orientation.foot, orientation.track.radius
    return footprints.rest_beside_slot(foot, span, orientation.distance, radius).corners


def _span_and_edges(
    device: Device, orientation: Orientation
) -> tuple[tuple[float, float] | None, HoleEdges | None]:
    """Where an opening goes on along the track [m] off the wall, and its edges if any lie across."""
    opening = opening_at(device, orientation)
    return (None, None) if opening is None else (opening.span, hole_edges(opening, orientation.track))


def _takes(device: Device, orientation: Orientation) -> bool:
    """Return whether a device takes anything from what carries an orientation."""
    span, hole = _span_and_edges(device, orientation)
    if span is not None:
        (first, last), radius = span, orientation.track.radius
        high = radius - first if first > 0.0 else 2.0 * radius
        left = footprints.over_ring(orientation.axial_foot, max(radius - last, 0.0), high)
    elif hole is not None:
        left, _ = footprints.least(orientation.axial_foot, hole)
    else:
        return False
    return left <= orientation.margin - SUPPORT_LOSS_TOLERANCE_M
