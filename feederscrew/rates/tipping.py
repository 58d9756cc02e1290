"""Orientations that the drive turns over on the track, apart from those that it only rocks.

While the line of action of the normal force lies outside the contact polygon, the part turns about the
nearest side. Over a settled cycle the moments about that side hold it down, or the bare track would not carry
it: it rocks. It turns over where one stroke alone is enough to lift its centre of mass over the side, and
where its rocking grows: a stroke tilts it by more than ``GROWS`` of that, and the next meets it still tilted.
"""

from dataclasses import dataclass, replace

import numpy as np

from feederscrew import check
from feederscrew.errors import ConfigError
from feederscrew.geometry.polygons import cross, inset, sides
from feederscrew.mechanics import limits
from feederscrew.mechanics.cycle import phases
from feederscrew.mechanics.floor.balance import HOP, TIP
from feederscrew.mechanics.track import balance
from feederscrew.mechanics.track.frame import seat
from feederscrew.tooling.orientations import travelling
from feederscrew.units import listed

INSTANTS = 12  # of one period
GROWS = 0.125  # in trials pins that a stroke tilts by 0.12 to 0.32 of their balance fell, by 0.05 stood
FLAT = "flat"  # a part that rolls lies on a line, and rolls where others tip


@dataclass(frozen=True, eq=False)
class TrackTipping:
    """What the drive does to M orientations that lie on the track."""

    tips: np.ndarray  # (M,) bool, at some instant of the cycle
    tilt: np.ndarray  # (M,) [rad] that one stroke brings at most; 0 where it does not tip
    balance: np.ndarray  # (M,) [rad] from which it goes on by itself; NaN where it does not tip
    grows: np.ndarray  # (M,) bool, whether one stroke adds to what the one before has tilted it by

    @property
    def over(self):
        """(M,) bool, whether one stroke is enough to turn it over, or its rocking grows until it does."""
        return self.tips & (self.grows | (self.tilt >= np.nan_to_num(self.balance, nan=np.inf)))


def marked(lying, bowl):
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
    found = tipping(lying, bowl)
    over = tuple(replace(one, turns_over=bool(turns)) for one, turns in zip(lying, found.over))
    return travelling(over, bowl), found


def remark(lying):
    """Say which orientations the drive turns over: one sentence, or none."""
    over = [one.name for one in lying if one.turns_over]
    return (f"{listed(over)} can tip over on the track at this drive and count as returned",) if over else ()


def tipping(lying, bowl):
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
    After the stroke its weight brings it back, by g r / (r^2 + h^2) at most; in a trial an upright pin of
    6 x 20 mm that is tilted by 2 deg a stroke was over after twelve of them.
    """
    found = [_one(one, bowl) for one in lying] if _plain(bowl) else [_NEVER] * len(lying)
    return TrackTipping(*(check.frozen(np.array(column)) for column in zip(*found)))


_NEVER = (False, 0.0, np.nan, False)


def _plain(bowl):
    try:
        return limits.plain(bowl) is bowl
    except ConfigError:
        return False


def _one(one, bowl):
    """Whether one orientation tips, how far a stroke tilts it, from where it goes on, whether it rocks on."""
    if one.falls_off or one.kind != FLAT or one.touching is None:
        return _NEVER
    place, phase = seat(one.posture, one.heading, one.touching, bowl.track.bank), phases(INSTANTS)
    rest = balance.motion(place, bowl, phase)
    if (rest.state == HOP).any() or not (rest.state == TIP).any():
        return _NEVER
    motions = [rest] + [balance.motion(place, bowl, phase, np.full(INSTANTS, s)) for s in (-1.0, 1.0)]
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
    return True, float(tilt), float(lean), bool(late and tilt > GROWS * lean)


def _to_side(contact, point):
    """Distance of the foot of the centre of mass from the side that a point lies farthest beyond [m]."""
    along = sides(contact)
    along = along / np.hypot(*along.T)[:, None]
    beyond = cross(along, point - contact)
    return max(float(cross(along, -contact)[np.argmin(beyond)]), 0.0)
