"""Every orientation of a part in the queue, and what becomes of it at each device."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from feederscrew import check
from feederscrew.bowl.record import Bowl
from feederscrew.documents import hint
from feederscrew.errors import FeederError
from feederscrew.rates.tipping import TrackTipping, marked
from feederscrew.resting.profiles import DeviceCounts
from feederscrew.tooling import orientations as tooling
from feederscrew.tooling.clearing import seconds
from feederscrew.tooling.devices.base import UNSURE, Device
from feederscrew.tooling.fates import at_entry, course
from feederscrew.tooling.orientations import Orientation, travel_speed


def on_stretch(bowl: Bowl, orientation: Orientation) -> Bowl:
    """Return a bowl in which parts travel as on the stretch on which an orientation lies.

    Source: the balance of forces of a part on both faces of a groove; docs/tooling.md, "A groove".

    Parameters
    ----------
    bowl : Bowl
    orientation : Orientation
        As it is there: its track, and the groove that it lies in.

    Returns
    -------
    Bowl
        In a groove each face carries 1 / (2 cos(angle)) of the weight, so friction acts as mu / cos(angle).
    """
    if not orientation.groove:
        return replace(
            bowl, track=replace(bowl.track, climb=orientation.track.climb, bank=orientation.track.bank)
        )
    mu, more = bowl.friction, 1.0 / np.cos(orientation.groove)
    static_back, kinetic_back = mu.backward
    friction = replace(
        mu,
        static=mu.static * more,
        kinetic=mu.kinetic * more,
        static_backward=static_back * more,
        kinetic_backward=kinetic_back * more,
    )
    return replace(
        bowl, friction=friction, track=replace(bowl.track, climb=orientation.track.climb, bank=0.0)
    )


def queueing(bowl: Bowl, lying: Sequence[Orientation]) -> Bowl:
    """Return the bowl as parts queue in it, before the first device that does more than lean the track.

    Source: own; docs/tooling.md, "A groove".

    Parameters
    ----------
    bowl : Bowl
    lying : sequence of Orientation
        As they are at its entry: a bank or a groove that is listed first begins there. A steeper stretch
        does not: it is where a queue comes apart.
    """
    orientation = lying[0]
    return on_stretch(bowl, replace(orientation, track=replace(orientation.track, climb=bowl.track.climb)))


def needed_spacing(chain: Sequence[Device], lying: Sequence[Orientation], bowl: Bowl) -> float:
    """Return the free way [m] between parts at the track's entry that the devices need.

    Source: own; docs/tooling.md, "1. The method".

    Parameters
    ----------
    chain : sequence of Device
    lying : sequence of Orientation
        Of the part.
    bowl : Bowl

    Returns
    -------
    float [m]
        0 where they need none. Behind a stretch on which parts travel r times as fast, their pitch is r times
        as large.
    """
    here, gap = lying[0], 0.0
    first = travel_speed(queueing(bowl, lying))
    shortest = min(orientation.length for orientation in lying)
    for device in chain:
        here = device.onward(here)
        now = travel_speed(on_stretch(bowl, here))
        free = max(device.gap(orientation, now) for orientation in lying)
        if free > 0.0:
            ratio = now / first if first > 0.0 else np.inf
            gap = max(gap, (free + shortest) / ratio - shortest if ratio > 0.0 else np.inf)
    return float(gap)


@dataclass(frozen=True, eq=False)
class Orientations:
    """Every way a part can lie on the track, an aspect and a heading a row; M rows."""

    lying: tuple[Orientation, ...]  # the rows themselves
    stations: tuple[str, ...]  # the track itself, then each device
    passes: np.ndarray  # (M, stations) share each station lets pass; the rest goes back into the bowl
    margins: np.ndarray  # (M, stations) [m] by which it passes or fails; NaN where that is not known
    states: tuple[Orientation, ...]  # S of them parts may leave in: the rows, then those that hang
    leaving: np.ndarray  # (M, S) share of each row that leaves in each state
    leaves_as: np.ndarray  # (M,) int, the state in which parts wanted as a row are fed
    rules: dict[str, np.ndarray]  # (M,) probability of aspect and heading by each rule
    interval: np.ndarray  # (M, 2) lowest and highest probability by the recommended rule
    decided: np.ndarray  # (M,) bool, whether statics tells what the devices do; momentum may where they turn
    fates: tuple[str, ...]  # (M,) what becomes of most: carried, returned or stopped
    stops: np.ndarray  # (M, stations) share of each that stands before each station
    clearing: np.ndarray  # (M,) [s] how long what devices return blocks the track, in the mean of the row
    doubtful: np.ndarray  # (M,) [1] share of each that leaves as well where no verdict is sure to return it
    gap: float = 0.0  # [m] free between parts at the entry, which the devices need
    tipping: TrackTipping | None = None  # on the track of a bowl; None where no drive is known

    @property
    def names(self) -> tuple[Any, ...]:
        """Of the stations: 'track', 'wiper_1', 'gap_2'."""
        return tuple(f"{name}_{place}" if place else name for place, name in enumerate(self.stations))

    @property
    def aspects(self) -> tuple[Any, ...]:
        """(M,) names of the aspects."""
        return tuple(orientation.aspect for orientation in self.lying)

    @property
    def headings(self) -> np.ndarray:
        """(M,) [rad]."""
        return np.array([orientation.heading for orientation in self.lying])

    @property
    def heading_shares(self) -> np.ndarray:
        """(M,) of the parts on that aspect; headings equal under a turn of the part are one."""
        return np.array([orientation.heading_share for orientation in self.lying])

    @property
    def lengths(self) -> np.ndarray:
        """(M,) [m] along the track."""
        return np.array([orientation.length for orientation in self.lying])

    @property
    def widths(self) -> np.ndarray:
        """(M,) [m] across it."""
        return np.array([orientation.width for orientation in self.lying])

    @property
    def rolls_back(self) -> np.ndarray:
        """(M,) bool, whether it lies on its round side, not along the track, and rolls down the climb."""
        return np.array([orientation.may_roll_back for orientation in self.lying], dtype=bool)

    @property
    def stays(self):
        """(M,) share that the bare track carries: what falls off, turns over or rolls back does not queue."""
        return np.where(self.rolls_back, 0.0, self.passes[:, 0])

    @property
    def leaves(self):
        """(M,) share that leaves the bowl, in any state."""
        return np.where(self.rolls_back, 0.0, self.through)

    @property
    def may_leave(self):
        """(M,) share that leaves the bowl, or is not sure to be returned."""
        return np.where(self.rolls_back, 0.0, self.through + self.doubtful)

    @property
    def carried(self) -> "Orientations":
        """The same orientations, were those that roll back carried as what slides."""
        return replace(
            self, lying=tuple(replace(orientation, may_roll_back=False) for orientation in self.lying)
        )

    @property
    def through(self):
        """(M,) share that passes every station."""
        return self.passes.prod(axis=1)

    @property
    def margin(self):
        """(M,) [m] of the first device that returns it, or the least by which it passes all; NaN without any.

        One that momentum, friction or the wall may undo is none.
        To the devices behind the first that returns it, it does not come as it lies.
        """
        margins = np.where(np.isnan(self.margins), np.inf, self.margins)
        returns = np.isfinite(margins) & (self.passes < 0.5)
        first = np.take_along_axis(margins, returns.argmax(axis=1)[:, None], axis=1)[:, 0]
        least = np.where(returns.any(axis=1), first, margins.min(axis=1))
        return np.where(np.isinf(least) | (np.abs(least) <= UNSURE), np.nan, least)

    @property
    def sure(self):
        """(M,) bool, whether it comes along the bare track as it lies, and no momentum decides at a device.

        On the track it shall neither rock nor roll, nor a landing turn it: nothing holds what is round at
        the wall without a bank, and no bank brings back to it what rolls along the track, since that does not
        slip.
        """
        rocks = False if self.tipping is None else self.tipping.tips & ~self.tipping.over
        level = [
            orientation.kind == "rolling" and orientation.track.bank <= 0.0 for orientation in self.lying
        ]
        loose = np.array(level, dtype=bool) | [orientation.along_a_bank for orientation in self.lying]
        tips, yaws = np.array(
            [(orientation.may_tip, orientation.may_yaw) for orientation in self.lying], dtype=bool
        ).T
        turns = tips | (yaws & ~self._gone_at_any_heading)
        return self.decided & ~(self.rolls_back | rocks | loose | turns)

    @property
    def _gone_at_any_heading(self) -> np.ndarray:
        """(M,) bool, whether devices return every heading of its aspect by some margin."""
        gone = np.isfinite(self.margin) & (self.through <= 0.0)
        gone |= np.array([orientation.returned for orientation in self.lying], dtype=bool)
        left = {aspect for aspect, lost in zip(self.aspects, gone) if not lost}
        return np.array([aspect not in left for aspect in self.aspects], dtype=bool)


def follow_orientations(part, aspects, track, chain=(), sigma=0.0, bowl=None) -> Orientations:
    """Return every stable aspect and heading of a part, and what becomes of it at each device.

    Source: docs/tooling.md, "1. The method".

    Parameters
    ----------
    part : Part
        From a mesh.
    aspects : Aspects
        Of that part.
    track : Track
    chain : sequence of Device
    sigma : float [m]
        Standard deviation of play and tolerance together, of every device.
    bowl : Bowl, optional
        Of that track: what its drive turns over on the track goes back, as what falls off does.

    Returns
    -------
    Orientations
    """
    return along(tooling.orientations(part, aspects, track), aspects, chain, sigma, bowl)


def along(lying, aspects, chain=(), sigma=0.0, bowl=None, rows=None) -> Orientations:
    """Return what becomes of known orientations, or of some rows alone; the rest as for ``orientations``."""
    lying, tips = (lying, None) if bowl is None else marked(lying, bowl)
    lying = at_entry(lying, chain)
    flow = course(chain, lying, sigma, rows)
    rules = {rule: np.array([orientation.chances[rule] for orientation in lying]) for rule in aspects.chances}
    return Orientations(
        lying=lying,
        stations=("track", *(device.kind for device in chain)),
        passes=flow.passes,
        margins=flow.margins,
        states=flow.states,
        leaving=flow.leaving,
        leaves_as=check.frozen(np.array([flow.leaves_as(row) for row in range(len(lying))])),
        rules={rule: check.frozen(chance) for rule, chance in rules.items()},
        interval=check.frozen(_interval(aspects, lying)),
        decided=flow.decided,
        fates=flow.fates,
        stops=flow.stops,
        clearing=check.frozen(_clearing(flow, lying, chain, bowl)),
        doubtful=flow.doubtful,
        gap=0.0 if bowl is None else needed_spacing(chain, lying, bowl),
        tipping=tips,
    )


def _clearing(passes, lying, chain, bowl):
    """Time [s] for which each orientation blocks the track on its way off it, in the mean."""
    times = np.zeros(len(lying))
    for step, device in enumerate(chain if bowl is not None else ()):
        for row in np.flatnonzero(passes.ends[:, 0, 1 + step] > 0.0):
            times[row] += passes.ends[row, 0, 1 + step] * seconds(device, lying[row], bowl)
    return times


def _interval(aspects, lying) -> np.ndarray:
    limits = aspects.recommended
    if limits is None:
        return np.full((len(lying), 2), np.nan)
    rows = [aspects.names.index(orientation.aspect) for orientation in lying]
    shares = np.array([orientation.heading_share for orientation in lying])
    return np.column_stack([limits.low[rows] * shares, limits.high[rows] * shares])


def counted_stations(queue: Orientations, counts: DeviceCounts) -> np.ndarray:
    """Return the stations of a chain that were counted.

    Source: docs/counts.md, "A feeding test, device by device".

    Parameters
    ----------
    queue : Orientations
    counts : DeviceCounts
        Its devices are named as the stations are, 'gap_2', or by a kind that is there once.

    Returns
    -------
    (D,) int [1]

    Raises
    ------
    FeederError
        If one is not there, or is counted twice.
    """
    stations = {name: place for place, name in enumerate(queue.names)}
    once = {kind: queue.stations.index(kind) for kind in queue.stations if queue.stations.count(kind) == 1}
    counted_stations: list[int] = []
    for line, name in zip(counts.lines, counts.names):
        place, where = (once | stations).get(name), f"{counts.source}:{line}"
        if place is None:
            what = f"the bowl has no device {name[:30]!r}"
            raise FeederError(where, what, hint(name, list(stations)))
        if place in counted_stations:
            what = f"device {name!r} is that of line {counts.lines[counted_stations.index(place)]}"
            raise FeederError(where, what, "keep one of them")
        counted_stations.append(place)
    return np.array(counted_stations)


def station_shares(queue: Orientations, names: Sequence[str]) -> np.ndarray:
    """Return which share of each aspect's parts comes to each station, and which goes on from it.

    Source: own; docs/counts.md, "A feeding test, device by device".

    Parameters
    ----------
    queue : Orientations
    names : sequence of str
        Of the A aspects.

    Returns
    -------
    (2, stations, A) float [1]
    """
    on = np.cumprod(queue.passes, axis=1)
    came = np.column_stack([np.ones(len(on)), on[:, :-1]])
    of = np.zeros((len(on), len(names)))
    of[np.arange(len(on)), [names.index(name) for name in queue.aspects]] = queue.heading_shares
    return check.frozen(np.einsum("kms,ma->ksa", np.stack([came, on]), of))


def passing_shares(flow: np.ndarray, shares: np.ndarray) -> np.ndarray:
    """Return the share that passes of the parts that come, (D,) [1]; NaN where none comes.

    Source: own; docs/counts.md, "A feeding test, device by device".

    Parameters
    ----------
    flow : (2, D, A) float [1]
        From ``ways``.
    shares : (A,) float [1]
        Of the aspects.
    """
    came, on = np.einsum("kda,a->kd", flow, np.nan_to_num(shares))
    return np.where(came > 0.0, on / np.where(came > 0.0, came, 1.0), np.nan)


def passing_ends(flow: np.ndarray, low: np.ndarray, high: np.ndarray) -> tuple[np.ndarray, ...]:
    """Return the least and the greatest share that passes if every aspect's share lies within its ends.

    Source: a linear programme over a simplex with bounds; docs/conveying.md, "Commands".

    Parameters
    ----------
    flow : (2, D, A) float [1]
        From ``ways``.
    low, high : (A,) float [1]
        Of the shares of the aspects; that they sum to 1 is not used.

    Returns
    -------
    low, high : (D,) float [1]
        NaN where no part can come.

    Notes
    -----
    A ratio of two linear functions on a box is greatest where the aspects of which most passes have their
    greatest share and the others their least; each place for the cut between them is tried.
    """
    ends = [_extremes(came, on, np.nan_to_num(low), np.nan_to_num(high)) for came, on in zip(*flow)]
    return tuple(np.array(ends).T)


def _extremes(came: np.ndarray, on: np.ndarray, low: np.ndarray, high: np.ndarray) -> tuple[float, float]:
    each = np.where(came > 0.0, on / np.where(came > 0.0, came, 1.0), 0.0)
    order = np.argsort(each, kind="stable")
    came, on, low, high = came[order], on[order], low[order], high[order]
    above = np.tri(len(came) + 1, len(came), -1, dtype=bool)  # row c: the first c aspects
    ends = []
    for shares in (np.where(above, high, low), np.where(above, low, high)):
        total = (shares * came).sum(axis=1)
        ends.append(
            np.where(total > 0.0, (shares * on).sum(axis=1) / np.where(total > 0.0, total, 1.0), np.nan)
        )
    if np.isnan(ends).all():
        return np.nan, np.nan
    return float(np.nanmin(ends[0])), float(np.nanmax(ends[1]))
