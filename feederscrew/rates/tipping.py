"""Orientations that the drive turns over on the track, apart from those that it only rocks.

While the line of action of the normal force lies outside the contact polygon, the part turns about the
nearest side. Over a settled cycle the moments about that side hold it down, or the bare track would not carry
it: it rocks. It turns over where that, followed from stroke to stroke, lifts its centre of mass over a side.

A part that hops is not followed. In flight nothing holds it; each landing strikes its foot from below and
drags it along the track, and the wall drags it back. ``landing`` says when neither can turn it.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from feederscrew import check
from feederscrew.bowl.record import Bowl
from feederscrew.conveying import answer
from feederscrew.conveying.hop import hop
from feederscrew.errors import ConfigError
from feederscrew.geometry.polygons import convex, cross, inset, sides
from feederscrew.mechanics import limits
from feederscrew.mechanics.cycle import phases
from feederscrew.mechanics.floor.balance import HOP, TIP
from feederscrew.mechanics.track import balance
from feederscrew.mechanics.track.frame import Seat, seat
from feederscrew.rates.rocking import goes_over, rocker
from feederscrew.tooling.orientations import Orientation, gyration, rolls_across, travel_speed, travelling
from feederscrew.units import factor, listed

TIPPING_PHASES = 12  # of one period
MM = factor("mm", "length")
HOP_REMARK = (
    "at this drive parts hop {:.2g} mm high and fly {:.2g} mm along the track: margins at edges across the "
    "track are less that way, all others less that height"
)
LANDING_REMARK = (
    "{}: a landing may tip it over, or the wall turn it, so no verdict on it is sure - see feeder trial"
)
FLAT_KIND = (
    "flat"  # a part that rolls lies on a line: it rolls where others tip, and tips over the line's ends
)
ROUND_OUTLINE_RATIO = (
    0.98  # of the farthest place of an outline, the nearest: it is round, and no heading of it is another
)
MAX_FORCE_OFFSET_HEIGHTS = 10.0  # heights of the centre of mass: no force of a bowl acts so far beside it


@dataclass(frozen=True, eq=False)
class TrackTipping:
    """What the drive does to M orientations that lie on the track."""

    tips: np.ndarray  # (M,) bool, at some instant of the cycle
    tilt: np.ndarray  # (M,) [rad] that one stroke brings at most; 0 where it does not tip
    balance: np.ndarray  # (M,) [rad] from which it goes on by itself; NaN where it does not tip
    over: np.ndarray  # (M,) bool, whether its rocking turns it over


STAYS, ROCKS, OVER, BACK, THROWN = "stays on its aspect", "rocks", "turns over", "rolls back", "is thrown"


@dataclass(frozen=True)
class Stands:
    """What the drive does to one orientation on the track: the verdict that the rate reckons with."""

    way: str  # STAYS, ROCKS, OVER, BACK or THROWN
    tilt: float = 0.0  # [rad] that one stroke brings at most
    lean: float = np.inf  # [rad] from which it goes on by itself; infinite where it stays

    @property
    def said(self) -> str:
        """The verdict in words, with its angles."""
        if self.way == ROCKS:
            tilt, lean = np.degrees(self.tilt), np.degrees(self.lean)
            return f"rocks by {tilt:.2g} deg a stroke; turns over from {lean:.3g} deg on"
        return {OVER: "turns over, goes back into the bowl", BACK: "rolls back down the climb"}.get(
            self.way, self.way
        )


def stands(one: Orientation, bowl: Bowl, hops: bool) -> Stands:
    """Return what the drive of a bowl does to an orientation on the bare track.

    Parameters
    ----------
    one : Orientation
    bowl : Bowl
        Single values.
    hops : bool
        Whether the drive throws it: what it comes down on is not followed then.

    Returns
    -------
    Stands
    """
    (known,), found = marked((one,), bowl)
    angles = float(found.tilt[0]), float(found.balance[0])
    if known.turns_over:
        return Stands(OVER, *angles)
    if known.may_roll_back:
        return Stands(BACK)
    if found.tips[0]:
        return Stands(ROCKS, *angles)
    return Stands(THROWN if hops else STAYS)


def marked(lying: Sequence[Orientation], bowl: Bowl) -> tuple[tuple[Orientation, ...], TrackTipping]:
    """Return orientations that know what the drive of a bowl does to them on the bare track, and what tips.

    Parameters
    ----------
    lying : sequence of Orientation
        M of them.
    bowl : Bowl
        Single values.

    Returns
    -------
    tuple of Orientation, TrackTipping
    """
    found, energy = tipping(lying, bowl), landing_energy(bowl)
    known = tuple(replace(one, turns_over=bool(turns)) for one, turns in zip(lying, found.over))
    if energy > 0.0 or bowl.track.bank > 0.0:  # a bank presses parts to the wall, thrown or not
        known = tuple(landing(one, bowl, energy) for one in known)
    return travelling(known, bowl), found


def remark(lying: Sequence[Orientation]) -> tuple[str, ...]:
    """Say what a drive turns over, how parts hop, and which of them may turn as they do: a sentence each."""
    over = [one.name for one in lying if one.turns_over]
    said = [f"{listed(over)} can tip over on the track at this drive and count as returned"] if over else []
    hop, flight = max(((one.hop, one.flight) for one in lying), default=(0.0, 0.0))
    if hop > 0.0:
        said.append(HOP_REMARK.format(hop / MM, flight / MM))
    turning = [one.name for one in lying if one.may_turn and one.hop > 0.0]
    return (*said, LANDING_REMARK.format(listed(turning))) if turning else tuple(said)


def tipping(lying: Sequence[Orientation], bowl: Bowl) -> TrackTipping:
    """Return which orientations tip on the track of a bowl, and which turn over there.

    Parameters
    ----------
    lying : sequence of Orientation
        M of them, that know where they touch the wall.
    bowl : Bowl
        Single values.

    Returns
    -------
    TrackTipping
        None tips where that is not known: a part that rolls or hops, a drive that is not straight.

    Notes
    -----
    The greatest moment about a side is taken for half a period, on the moment of inertia m (r^2 + h^2) of the
    centre of mass about that side, r beside it and h above it: an upper estimate. It is over at atan(r/h).
    After the stroke its weight brings it back, by g r / (r^2 + h^2) at most. Where it is then still tilted at
    the next one, or over already, its rocking is followed: ``rocking.goes_over``.
    """
    found = [_one(one, bowl) for one in lying] if plain(bowl) else [_NO_TIPPING] * len(lying)
    return TrackTipping(*(check.frozen(np.array(column)) for column in zip(*found)))


def landing_energy(bowl: Bowl) -> float:
    """Return the energy of the hardest landing of a part, as a height; 0 where it never leaves the track.

    Source: u^2 / 2 g, u the velocity of a point mass towards the track as it lands.

    Parameters
    ----------
    bowl : Bowl
        Single values.

    Returns
    -------
    float [m]
    """
    if travel_speed(bowl) <= 0.0 or hop(bowl).height <= 0.0:
        return 0.0
    return float(answer.answer(bowl).hardest_impact ** 2 / (2.0 * bowl.gravity))


def landing(one: Orientation, bowl: Bowl, energy: float) -> Orientation:
    """Return an orientation that knows whether a landing may tip it over, or the wall turn it.

    Source: own; docs/tooling.md, "Parts that hop".

    Parameters
    ----------
    one : Orientation
    bowl : Bowl
        Single values.
    energy : float [m]
        From ``landing_energy``: of 0 nothing tips so.
    """
    if one.falls_off or one.touching is None:
        return one
    contact = seated(one, bowl.track.bank).contact
    tips = energy > 0.0 and may_tip(contact, one, bowl, energy)
    return replace(one, may_tip=tips, may_yaw=may_yaw(one, bowl))


def may_tip(contact: np.ndarray, one: Orientation, bowl: Bowl, energy: float, margin: float = 0.0) -> bool:
    """Return whether a landing may tip an orientation over a side of what carries it.

    Source: own; moments of an impact about a side with Coulomb's friction, and the energy to rise over it.

    Parameters
    ----------
    contact : (K, 2) float [m]
        Corners of what carries it, in track axes from the foot of the centre of mass.
    one, bowl, energy
        As for ``landing``.
    margin : float [m]
        By which that is taken to be smaller all round.

    Notes
    -----
    The track drags the foot by at most mu times what it strikes it with. Over a side b from the foot of the
    centre of mass, of which the normal lies at an angle a to the track, that tips a part of which the centre
    of mass is at the height h where mu h |cos a| > b. Where it is less, the part has to be lifted by
    sqrt(h^2 + b^2) - h. Along the track the whole energy E of the landing may do that. Across it nothing
    drags the part: struck at a place beside its centre of mass it keeps (1 + e)^2 / 4 of E as rotation at
    most, e being the restitution. The wall holds a part over a side that faces it; a groove holds it over the
    sides that face both its surfaces.
    """
    ring = contact[convex(contact)]
    if len(ring) < 3:
        return True
    edges = sides(ring)
    outward = np.column_stack([edges[:, 1], -edges[:, 0]]) / np.hypot(*edges.T)[:, None]
    along, across = np.abs(outward[:, 0]), np.abs(outward[:, 1]) if one.groove else -outward[:, 1]
    reach = np.maximum((outward * ring).sum(axis=1) - margin, 0.0)
    height, struck = one.posture.height, 0.25 * (1.0 + bowl.restitution) ** 2
    spent = energy * np.where(along > np.abs(outward[:, 1]), 1.0, struck)
    tips = (bowl.friction.static * height * along > reach) | (np.hypot(height, reach) - height < spent)
    return bool((tips & (across < along)).any())


def may_yaw(one: Orientation, bowl: Bowl) -> bool:
    """Return whether the wall may turn an orientation out of its heading: a shaken track does not hold it.

    Source: own; docs/tooling.md, "Parts that hop": the couple of the wall's friction.

    Parameters
    ----------
    one : Orientation
        That knows where it touches the wall.
    bowl : Bowl

    Notes
    -----
    The wall drags the part back with mu N, the distance d beside the centre of mass, and so moves its own
    force N ahead of that by mu d. It keeps its heading while that is within what touches the wall.
    """
    outline = one.outline
    along = sides(outline)
    nearest = (outline[:, 0] * along[:, 1] - outline[:, 1] * along[:, 0]) / np.hypot(*along.T)
    if one.groove or nearest.min() > ROUND_OUTLINE_RATIO * np.hypot(*outline.T).max() or one.touching is None:
        return False
    return bool(bowl.friction.wall * one.distance > one.touching[1, 0])


_NO_TIPPING = (False, 0.0, np.nan, False)


def plain(bowl: Bowl) -> bool:
    """Return whether a bowl's drive and conveyor are of the plain kind, for which tipping is followed."""
    try:
        return limits.plain(bowl) is bowl
    except ConfigError:
        return False


def _one(one: Orientation, bowl: Bowl) -> tuple[bool, float, float, bool]:
    """Whether one orientation tips, how far a stroke tilts it, from where it goes on, if it goes over."""
    if one.falls_off or one.touching is None or (one.kind != FLAT_KIND and rolls_across(one)):
        return _NO_TIPPING
    place, phase = seated(one, bowl.track.bank), phases(TIPPING_PHASES)
    rest = balance.motion(place, bowl, phase)
    if (rest.state == HOP).any() or not (rest.state == TIP).any():
        return _NO_TIPPING
    motions = [rest] + [balance.motion(place, bowl, phase, np.full(TIPPING_PHASES, s)) for s in (-1.0, 1.0)]
    force = np.concatenate([found.normal_force for found in motions])
    offset = np.concatenate([found.offset for found in motions])
    moment = force * np.maximum(-inset(place.contact, offset), 0.0)
    worst = int(np.nanargmax(moment))
    beside = _to_side(place.contact, offset[worst])
    arm = beside**2 + place.height**2
    stroke = 0.5 / bowl.drive.frequency
    rate = moment[worst] / (place.mass * arm) * stroke
    tilt, back = 0.5 * rate * stroke, bowl.gravity * beside / arm
    late = rate + np.sqrt(rate**2 + 2.0 * back * tilt) > back * stroke
    lean = np.arctan2(beside, place.height)
    over = (late or tilt >= lean) and goes_over(rocker(place, partial(gyration, one), bowl), 2.0 * stroke)
    return True, float(tilt), float(lean), bool(over)


def seated(one: Orientation, bank: float) -> Seat:
    """Return how an orientation lies on a track of some bank [rad], a Seat.

    One that rolls tips over the ends of its line only, so its contact is wide beside that.
    """
    place = seat(one.posture, one.heading, one.touching, bank)
    if one.kind == FLAT_KIND:
        return place
    back, ahead = place.contact[:, 0].min(), place.contact[:, 0].max()
    side = MAX_FORCE_OFFSET_HEIGHTS * place.height
    return replace(place, contact=np.array([[back, -side], [ahead, -side], [ahead, side], [back, side]]))


def _to_side(contact: np.ndarray, point: np.ndarray) -> float:
    """Distance of the foot of the centre of mass from the side that a point lies farthest beyond [m]."""
    along = sides(contact)
    along = along / np.hypot(*along.T)[:, None]
    beyond = cross(along, point - contact)
    return max(float(cross(along, -contact)[np.argmin(beyond)]), 0.0)
