"""Every orientation of a part in the queue, and what becomes of it at each device."""

import re
from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from feederscrew.arrivals.ensemble import wilson
from feederscrew.base import check
from feederscrew.base.arrays import Bools, Floats, Ints
from feederscrew.base.columns import Column
from feederscrew.base.documents import hint
from feederscrew.base.errors import FeederError
from feederscrew.bowl.devices.base import UNSURE, Device
from feederscrew.bowl.devices.kinds import find_kind
from feederscrew.bowl.devices.orientation_names import place
from feederscrew.bowl.devices.trade import Action
from feederscrew.bowl.record import Bowl, Friction, Track
from feederscrew.part.record import Part
from feederscrew.resting.aspects import Aspects
from feederscrew.resting.profiles import CountFile, DeviceCounts, one_profile
from feederscrew.resting.rules import registry
from feederscrew.sorting import orientations as tooling
from feederscrew.sorting.falling import clearing_time
from feederscrew.sorting.fates import at_entry, course
from feederscrew.sorting.orientations import Orientation, travel_speed
from feederscrew.sorting.tipping import TrackTipping, marked

if TYPE_CHECKING:
    pass


def on_stretch(bowl: Bowl, orientation: Orientation) -> Bowl:
    """Return a bowl in which parts travel as on the stretch of track on which an orientation lies.

    In a groove each face carries 1 / (2 cos(angle)) of the weight, so friction acts as mu / cos(angle): the
    balance of forces of a part on both faces. The groove holds the part, so the bank counts as 0 there.

    Parameters
    ----------
    bowl : Bowl
    orientation : Orientation
        Its track has climb, bank [rad]; its groove the angle of each face [rad], 0 without a groove.

    Returns
    -------
    Bowl

    References
    ----------
    docs/tooling.md, "A groove".
    """
    track = replace(bowl.track, climb=orientation.track.climb, bank=orientation.track.bank)
    if not orientation.groove:
        return replace(bowl, track=track)
    mu, more = bowl.friction, 1.0 / np.cos(orientation.groove)
    static_back, kinetic_back = (coefficient * more for coefficient in mu.backward)
    friction = Friction(mu.static * more, mu.kinetic * more, mu.wall, static_back, kinetic_back)
    return replace(bowl, friction=friction, track=replace(track, bank=0.0))


def queueing(bowl: Bowl, orientations: Sequence[Orientation]) -> Bowl:
    """Return the bowl as parts queue in it, before the first device that does more than lean the track.

    A bank or a groove that is listed first begins at the track's entry. A steeper stretch does not: there a
    queue comes apart.

    Parameters
    ----------
    bowl : Bowl
    orientations : (M,) sequence of Orientation
        As they lie at the entry.

    Returns
    -------
    Bowl

    References
    ----------
    Own; docs/tooling.md, "A groove".
    """
    orientation = orientations[0]
    return on_stretch(bowl, replace(orientation, track=replace(orientation.track, climb=bowl.track.climb)))


def needed_spacing(chain: Sequence[Device], orientations: Sequence[Orientation], bowl: Bowl) -> float:
    """Return the free way between parts at the track's entry that the devices need.

    Behind a stretch on which parts travel r times as fast, their pitch is r times as large. So a device that
    needs the free way d behind it asks for (d + l) / r - l at the entry, l the shortest part.

    Parameters
    ----------
    chain : (D,) sequence of Device
    orientations : (M,) sequence of Orientation
        As they lie at the entry.
    bowl : Bowl

    Returns
    -------
    float [m]
        0 where no device needs one; infinite where parts stand on the stretch of a device that does.

    References
    ----------
    Own; docs/tooling.md, "1. The method".
    """
    if not chain:
        return 0.0
    here, gap = orientations[0], 0.0
    first = travel_speed(queueing(bowl, orientations))
    shortest = min(orientation.length for orientation in orientations)
    for device in chain:
        here = device.onward(here)
        now = travel_speed(on_stretch(bowl, here))
        free = max(device.gap(orientation, now) for orientation in orientations)
        if free > 0.0:
            ratio = now / first if first > 0.0 else np.inf
            gap = max(gap, (free + shortest) / ratio - shortest if ratio > 0.0 else np.inf)
    return float(gap)


@dataclass(frozen=True, eq=False)
class Orientations:
    """Every way a part can lie on the track, an aspect and a heading a row; M rows."""

    lying: tuple[Orientation, ...]  # the rows themselves
    stations: tuple[str, ...]  # the track itself, then each device
    passes: Floats  # (M, stations) share each station lets pass; the rest goes back into the bowl
    margins: Floats  # (M, stations) [m] by which it passes or fails; NaN where that is not known
    states: tuple[Orientation, ...]  # S of them parts may leave in: the rows, then those that hang
    leaving: Floats  # (M, S) share of each row that leaves in each state
    leaves_as: Ints  # (M,) int, the state in which parts wanted as a row are fed
    rules: dict[str, Floats]  # (M,) probability of aspect and heading by each rule
    interval: Floats  # (M, 2) lowest and highest probability by the recommended rule
    decided: Bools  # (M,) bool, whether statics tells what the devices do; momentum may where they turn
    fates: tuple[str, ...]  # (M,) what becomes of most: carried, returned or stopped
    stops: Floats  # (M, stations) share of each that stands before each station
    clearing: Floats  # (M,) [s] how long what devices return blocks the track, in the mean of the row
    doubtful: Floats  # (M,) [1] share of each that leaves as well where no verdict is sure to return it
    gap: float = 0.0  # [m] free between parts at the entry, which the devices need
    tipping: TrackTipping | None = None  # on the track of a bowl; None where no drive is known

    @property
    def names(self) -> tuple[str, ...]:
        """Return the names of the stations, as heads of columns: 'track', 'wiper_1', 'vision_reject_2'."""
        heads = (re.sub(r"\W+", "_", name) for name in self.stations)
        return tuple(f"{name}_{place}" if place else name for place, name in enumerate(heads))

    @property
    def aspects(self) -> tuple[str, ...]:
        """Return the names of the aspects (M,)."""
        return tuple(orientation.aspect for orientation in self.lying)

    def leaves_as_names(self) -> list[str | None]:
        """Return in which state most parts of each row leave; None where they are returned."""
        leaving = self.leaving[: len(self.lying)]
        return [self.states[int(row.argmax())].name if row.any() else None for row in leaving]

    @property
    def headings(self) -> Floats:
        """Return the headings (M,) [rad]."""
        return np.array([orientation.heading for orientation in self.lying])

    @property
    def heading_shares(self) -> Floats:
        """Return the share of the parts on that aspect (M,); headings alike under a turn count as one."""
        return np.array([orientation.heading_share for orientation in self.lying])

    @property
    def lengths(self) -> Floats:
        """Return the lengths along the track (M,) [m]."""
        return np.array([orientation.length for orientation in self.lying])

    @property
    def widths(self) -> Floats:
        """Return the widths across the track (M,) [m]."""
        return np.array([orientation.width for orientation in self.lying])

    @property
    def rolls_back(self) -> Bools:
        """Return whether each lies on its round side across the track and rolls down the climb (M,)."""
        return np.array([orientation.may_roll_back for orientation in self.lying], dtype=bool)

    @property
    def stays(self) -> Bools:
        """Return the share that the bare track carries (M,).

        What falls off, turns over or rolls back does not queue.
        """
        return np.where(self.rolls_back, 0.0, self.passes[:, 0])

    @property
    def leaves(self) -> Floats:
        """Return the share that leaves the bowl (M,), in any state."""
        return np.where(self.rolls_back, 0.0, self.through)

    @property
    def may_leave(self) -> Floats:
        """Return the share that leaves the bowl, or is not sure to be returned (M,)."""
        return np.where(self.rolls_back, 0.0, self.through + self.doubtful)

    @property
    def carried(self) -> "Orientations":
        """Return the same orientations with those that roll back carried like those that slide."""
        return replace(self, lying=tuple(replace(one, may_roll_back=False) for one in self.lying))

    @property
    def through(self) -> Floats:
        """Return the share that passes every station (M,)."""
        return self.passes.prod(axis=1)

    @property
    def margin(self) -> Floats:
        """Return the margin of the first device that returns it, or the least of all it passes (M,) [m].

        NaN where there is no margin. A margin that momentum, friction or the wall may undo does not count.
        To the devices behind the first that returns it, a part does not come as it lies.
        """
        margins = np.where(np.isnan(self.margins), np.inf, self.margins)
        returns = np.isfinite(margins) & (self.passes < 0.5)
        first = np.take_along_axis(margins, returns.argmax(axis=1)[:, None], axis=1)[:, 0]
        least = np.where(returns.any(axis=1), first, margins.min(axis=1))
        return np.where(np.isinf(least) | (np.abs(least) <= UNSURE), np.nan, least)

    @property
    def sure(self) -> Bools:
        """Return whether it comes along the track as it lies, and no momentum decides at a device (M,).

        On the track it shall neither rock nor roll, nor a landing turn it. Without a bank nothing holds what
        is round at the wall. No bank brings back to the wall what rolls along the track, since that does not
        slip.
        """
        rocks = False if self.tipping is None else self.tipping.tips & ~self.tipping.over
        loose = np.array(
            [one.along_a_bank or (one.kind == "rolling" and one.track.bank <= 0.0) for one in self.lying],
            dtype=bool,
        )
        # devices that return every heading of its aspect by some margin make a turn on the track harmless
        gone = np.isfinite(self.margin) & (self.through <= 0.0)
        left = {one.aspect for one, lost in zip(self.lying, gone) if not (lost or one.returned)}
        turns = [one.may_tip or (one.may_yaw and one.aspect in left) for one in self.lying]
        return self.decided & ~(self.rolls_back | rocks | loose | np.array(turns, dtype=bool))


def orientation_columns(queue: Orientations, rule: str) -> list[Column[Orientations]]:
    """Return the columns of the orientations at the devices: what each station does with each.

    Parameters
    ----------
    queue : Orientations
    rule : str
        Whose probabilities stand there, a key of ``queue.rules``.

    Returns
    -------
    list of Column
        Of arrays, a row an orientation; ``leaves_as`` is None where it is returned.
    """
    return [
        *ORIENTATION_COLUMNS,
        Column(f"p_{rule}", lambda queue: queue.rules[rule], "share", registry.heading(rule)),
        Column("margin_mm", lambda queue: queue.margin, "mm"),
        Column("fate", lambda queue: queue.fates),
        Column("leaves_as", lambda queue: queue.leaves_as_names()),
        *(_station_column(place, name) for place, name in enumerate(queue.names)),
        Column("passes", lambda queue: queue.through, "share"),
    ]


def _station_column(place: int, name: str) -> Column[Orientations]:
    """Return the column of the share that a station lets pass."""
    return Column(name, lambda queue: queue.passes[:, place], "share")


ORIENTATION_COLUMNS: tuple[Column[Orientations], ...] = (  # a row an orientation
    Column("aspect", lambda queue: queue.aspects),
    Column("heading_deg", lambda queue: queue.headings, "deg"),
    Column("length_mm", lambda queue: queue.lengths, "mm"),
    Column("width_mm", lambda queue: queue.widths, "mm"),
)


def follow_orientations(
    part: Part,
    aspects: Aspects,
    track: Track,
    chain: Sequence[Device] = (),
    sigma: float = 0.0,
    bowl: Bowl | None = None,
) -> Orientations:
    """Return every stable aspect and heading of a part from a mesh, and what becomes of it at each device.

    What the drive of the bowl turns over on the track goes back, as what falls off does.

    Parameters
    ----------
    part : Part
        From a mesh.
    aspects : Aspects
        Of the part.
    track : Track
    chain : (D,) sequence of Device
        Along the track, in the order parts meet them.
    sigma : float [m]
        Standard deviation of play and tolerance together, of every device.
    bowl : Bowl, optional
        Its drive moves the track; None where no drive is known.

    Returns
    -------
    Orientations

    References
    ----------
    docs/tooling.md, "1. The method".
    """
    return along(tooling.orientations(part, aspects, track), aspects, chain, sigma, bowl)


def along(
    orientations: Sequence[Orientation],
    aspects: Aspects,
    chain: Sequence[Device] = (),
    sigma: float = 0.0,
    bowl: Bowl | None = None,
    rows: Collection[int] | None = None,
) -> Orientations:
    """Return what becomes of given orientations at each device, or of some rows alone.

    Parameters
    ----------
    orientations : (M,) sequence of Orientation
        As they lie on the bare track.
    aspects : Aspects
        Of the part.
    chain : (D,) sequence of Device
        Along the track, in the order parts meet them.
    sigma : float [m]
        Standard deviation of play and tolerance together, of every device.
    bowl : Bowl, optional
        Its drive moves the track; None where no drive is known.
    rows : collection of int, optional
        Places of the orientations that are followed; None follows all.

    Returns
    -------
    Orientations
        All M rows; shares and rules are those of the whole part.

    References
    ----------
    docs/tooling.md, "1. The method".
    """
    # what a device turns becomes another one, of which has to be known whether it stays
    alone = None if any(device.action.turns or device.action is Action.GROOVE for device in chain) else rows
    orientations, tips = (tuple(orientations), None) if bowl is None else marked(orientations, bowl, alone)
    orientations = at_entry(orientations, chain)
    flow = course(chain, orientations, sigma, rows)
    # how long each blocks the track on its way off it, in the mean
    clearing = np.zeros(len(orientations))
    if bowl is not None:
        for step, device in enumerate(chain):
            for row in np.flatnonzero(flow.ends[:, 0, 1 + step] > 0.0):
                clearing[row] += flow.ends[row, 0, 1 + step] * clearing_time(device, orientations[row], bowl)
    return Orientations(
        lying=orientations,
        stations=("track", *(device.kind for device in chain)),
        passes=flow.passes,
        margins=flow.margins,
        states=flow.states,
        leaving=flow.leaving,
        leaves_as=check.frozen(np.array([flow.leaves_as(row) for row in range(len(orientations))])),
        rules=_rules(orientations, aspects),
        interval=_interval(orientations, aspects),
        decided=flow.decided,
        fates=flow.fates,
        stops=flow.stops,
        clearing=check.frozen(clearing),
        doubtful=flow.doubtful,
        gap=0.0 if bowl is None else needed_spacing(chain, orientations, bowl),
        tipping=tips,
    )


def with_shares(queue: Orientations, aspects: Aspects) -> Orientations:
    """Return the same orientations, devices and drive where the aspects arrive in other shares.

    Parameters
    ----------
    queue : Orientations
    aspects : Aspects
        Of the same part, with the other shares.

    Returns
    -------
    Orientations
        A row's probability is that of its aspect times the share of its heading.
    """
    rows = [aspects.names.index(orientation.aspect) for orientation in queue.lying]
    lying = tuple(
        replace(
            orientation,
            chances={rule: float(p[row]) * orientation.heading_share for rule, p in aspects.chances.items()},
        )
        for orientation, row in zip(queue.lying, rows)
    )
    return replace(queue, lying=lying, rules=_rules(lying, aspects), interval=_interval(lying, aspects))


def _rules(orientations: Sequence[Orientation], aspects: Aspects) -> dict[str, Floats]:
    """Return the probability (M,) [1] of each orientation by every rule."""
    chances = {rule: [orientation.chances[rule] for orientation in orientations] for rule in aspects.chances}
    return {rule: check.frozen(np.array(chance)) for rule, chance in chances.items()}


def _interval(orientations: Sequence[Orientation], aspects: Aspects) -> Floats:
    """Return the lowest and highest probability by the recommended rule (M, 2) [1]; NaN without it."""
    ends = aspects.recommended
    if ends is None:
        return check.frozen(np.full((len(orientations), 2), np.nan))
    rows = [aspects.names.index(orientation.aspect) for orientation in orientations]
    shares = np.array([orientation.heading_share for orientation in orientations])
    return check.frozen(np.column_stack([ends.low[rows] * shares, ends.high[rows] * shares]))


def counted_stations(queue: Orientations, counts: DeviceCounts) -> Floats:
    """Return the stations of a chain that were counted.

    Parameters
    ----------
    queue : Orientations
    counts : DeviceCounts
        Its devices are named as the stations are, 'gap_2', or by a kind that is there once,
        as ``find_kind`` takes it.

    Returns
    -------
    (D,) int [1]
        Places in ``queue.stations``, in the order of the counts.

    Raises
    ------
    FeederError
        If a device is not there, or is counted twice.

    References
    ----------
    docs/counts.md, "A feeding test, device by device".
    """
    places: list[int] = []
    for line, name in zip(counts.lines, counts.names):
        place, where = _station(queue, name), f"{counts.source}:{line}"
        if place is None:
            what = f"the bowl has no device {name[:30]!r}"
            raise FeederError(where, what, hint(name, list(queue.names)))
        if place in places:
            what = f"device {name!r} is that of line {counts.lines[places.index(place)]}"
            raise FeederError(where, what, "keep one of them")
        places.append(place)
    return np.array(places)


def _station(queue: Orientations, name: str) -> int | None:
    """Place of the station that a name means: 'track', 'wiper_1', or a kind that is there once; or None."""
    if name in queue.names:
        return queue.names.index(name)
    numbered = re.fullmatch(r"(.*)_(\d+)", name)
    kind = find_kind(numbered[1] if numbered else name)
    places = [place for place, own in enumerate(queue.stations) if kind is not None and own == kind.kind]
    if numbered:
        return next((place for place in places if str(place) == numbered[2]), None)
    return places[0] if len(places) == 1 else None


def station_shares(queue: Orientations, names: Sequence[str]) -> Floats:
    """Return which share of each aspect's parts comes to each station, and which goes on from it.

    Parameters
    ----------
    queue : Orientations
    names : (A,) sequence of str
        Of the aspects.

    Returns
    -------
    (2, stations, A) float [1]
        Shares that come, then shares that go on.

    References
    ----------
    Own; docs/counts.md, "A feeding test, device by device".
    """
    on = np.cumprod(queue.passes, axis=1)
    came = np.column_stack([np.ones(len(on)), on[:, :-1]])
    of = np.zeros((len(on), len(names)))
    of[np.arange(len(on)), [names.index(name) for name in queue.aspects]] = queue.heading_shares
    return check.frozen(np.einsum("kms,ma->ksa", np.stack([came, on]), of))


def passing_shares(flow: Floats, shares: Floats) -> Floats:
    """Return the share that passes of the parts that come to each device.

    Parameters
    ----------
    flow : (2, D, A) float [1]
        Of ``station_shares``.
    shares : (A,) float [1]
        Of the aspects; NaN counts as 0.

    Returns
    -------
    (D,) float [1]
        NaN where no part comes.

    References
    ----------
    Own; docs/counts.md, "A feeding test, device by device".
    """
    came, on = np.einsum("kda,a->kd", flow, np.nan_to_num(shares))
    return np.where(came > 0.0, on / np.where(came > 0.0, came, 1.0), np.nan)


def passing_ends(flow: Floats, low: Floats, high: Floats) -> tuple[Floats, ...]:
    """Return the least and the greatest share that passes if every aspect's share lies within its ends.

    A ratio of two linear functions on a box is greatest where the aspects of which most passes have their
    greatest share and the others their least; each place for the cut between them is tried. That the shares
    sum to 1 is not used.

    Parameters
    ----------
    flow : (2, D, A) float [1]
        Of ``station_shares``.
    low : (A,) float [1]
        Least share of each aspect; NaN counts as 0.
    high : (A,) float [1]
        Greatest share.

    Returns
    -------
    (D,) float [1]
        Least share that passes; NaN where no part can come.
    (D,) float [1]
        Greatest share.

    References
    ----------
    A linear programme over a simplex with bounds; docs/conveying.md, "Commands".
    """
    low, high = np.nan_to_num(low), np.nan_to_num(high)
    ends = np.full((2, flow.shape[1]), np.nan)
    above = np.tri(len(low) + 1, len(low), -1, dtype=bool)  # row c: the first c aspects
    for device, (came, on) in enumerate(zip(*flow)):
        order = np.argsort(np.where(came > 0.0, on / np.where(came > 0.0, came, 1.0), 0.0), kind="stable")
        came, on, least, most = came[order], on[order], low[order], high[order]
        drawn = np.where(above, most, least), np.where(above, least, most)
        for row, (extreme, shares) in enumerate(zip((np.fmin, np.fmax), drawn)):
            total = (shares * came).sum(axis=1)
            passing = np.where(
                total > 0.0, (shares * on).sum(axis=1) / np.where(total > 0.0, total, 1.0), np.nan
            )
            ends[row, device] = extreme.reduce(passing)  # NaN where all are
    return ends[0], ends[1]


def oriented(queue: Orientations, measured: CountFile | None) -> Orientations:
    """Return the orientations with the shares that were counted for each of them.

    Parameters
    ----------
    queue : Orientations
    measured : CountFile or None

    Returns
    -------
    Orientations
        As they were where aspects were counted, or nothing.

    Raises
    ------
    FeederError
        If a part was counted in an orientation that it cannot have on this track.
    """
    if measured is None or measured.by_orientation is None:
        return queue
    values = np.zeros(len(queue.lying))
    for (aspect, heading), count in zip(measured.orientations, measured.by_orientation[:, 0]):
        if count > 0.0:
            row = place(queue.aspects, queue.headings, aspect, heading, measured.source, "counts")
            values[row] += count
    shares = values / values.sum()
    low, high = wilson(values, values.sum()) if one_profile(measured).has_counts else (shares, shares)
    ends = np.column_stack([np.minimum(low, shares), np.maximum(high, shares)])
    rules = queue.rules | {"recommended": check.frozen(shares)}
    return replace(queue, rules=rules, interval=check.frozen(ends))
