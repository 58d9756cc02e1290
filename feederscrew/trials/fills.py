"""Fills of a queue, low, normal and high, as a buyer accepts a feeder, and what leaves each of them.

A fill says how closely parts come. ``feeder design`` proves a bowl at each of them, and ``feeder trial
--fill`` follows one of them again.
"""

import enum
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from feederscrew.arrivals.ensemble import wilson
from feederscrew.base.arrays import Bools, Floats
from feederscrew.base.columns import Column
from feederscrew.bowl.record import Bowl
from feederscrew.feeding.stream import Orientations
from feederscrew.part.record import Part
from feederscrew.resting.aspects import Aspects
from feederscrew.sorting.orientations import Hanging, Orientation
from feederscrew.sorting.tooled_track import lay_out, size_of_part
from feederscrew.trials.queue import PartsQueue, bare_track, room_within_turn
from feederscrew.trials.queue_counts import QueuedParts
from feederscrew.trials.supply import MEAN_GAP_SHARE, QueuePlan
from feederscrew.trials.wanted import find_poses, wanted_rows

TOUCHING_PARTS = 12  # in a row of parts that touch
BARE_TRACK = ""  # name of the place before any device


class FillLevel(enum.StrEnum):
    """Density of parts in a row; files print the word."""

    LOW = "low"  # a third of the row is empty
    NORMAL = "normal"
    HIGH = "high"  # parts touch: a full track, as before an escapement

    @property
    def gaps(self) -> float:
        """Return the mean free way between parts as they come, over their length [1]."""
        return {FillLevel.LOW: 0.5, FillLevel.NORMAL: MEAN_GAP_SHARE, FillLevel.HIGH: 0.0}[self]

    @property
    def parts(self) -> int:
        """Return how many parts are in a row that is as long as ``TOUCHING_PARTS`` parts."""
        return round(TOUCHING_PARTS / (1.0 + self.gaps))


def plan_of_fill(fill: FillLevel, seconds: float, *, parts: int | None = None, frames: int = 0) -> QueuePlan:
    """Return the plan of a queue at a fill.

    Parameters
    ----------
    fill : FillLevel
    seconds : float [s]
        For which it is followed.
    parts : int, optional
        In the row; those of the fill without it.
    frames : int, optional
        Poses of all parts that are noted for a film.

    Returns
    -------
    QueuePlan
    """
    is_apart = fill.gaps > 0.0
    return QueuePlan(parts or fill.parts, seconds, fill.gaps, frames, is_balanced=True, is_ridden=is_apart)


def require_room(bowl: Bowl, orientations: Sequence[Orientation]) -> None:
    """Make sure that a turn of a bowl has room for its devices and for a row of parts at any fill.

    Parameters
    ----------
    bowl : Bowl
        With its devices.
    orientations : sequence of Orientation
        In which parts come.

    Raises
    ------
    FeederError
        If it has none.
    """
    tooled, size = lay_out(bowl.track, bowl.devices, orientations, whole=True), size_of_part(orientations)
    for fill in FillLevel:
        room_within_turn(tooled, size, *bare_track(bowl, orientations, plan_of_fill(fill, 1.0)))


class PoseKind(enum.Enum):
    """Knowledge of the pose in which a part left."""

    ORIENTATION = enum.auto()
    HEADING_OFF = enum.auto()  # on an aspect, at a heading that is none of the listed ones
    UNKNOWN = enum.auto()


@dataclass(frozen=True)
class LeavingPose:
    """A pose, other than wanted, in which parts left a queue."""

    kind: PoseKind
    aspect: str = ""  # '' of parts that hang, or lie in no known pose
    name: str = ""  # of the orientation; '' of the other kinds

    @property
    def text(self) -> str:
        """Return the pose in words: 'A@90', 'C, heading off', 'in no known pose'."""
        match self.kind:
            case PoseKind.ORIENTATION:
                return self.name
            case PoseKind.HEADING_OFF:
                return f"{self.aspect}, heading off"
            case PoseKind.UNKNOWN:
                return "in no known pose"


LeavingCounts = tuple[tuple[LeavingPose, int], ...]  # the most first


def join_leaving_counts(*counts: LeavingCounts) -> LeavingCounts:
    """Return poses with their numbers of parts added up.

    Parameters
    ----------
    *counts : LeavingCounts
        (pose, number) pairs, a tuple of them for each queue.

    Returns
    -------
    LeavingCounts
        Each pose once, the most first.
    """
    total = Counter[LeavingPose]()
    for count in counts:
        total.update(dict(count))
    return tuple(total.most_common())


class JammedParts(NamedTuple):
    """Parts of one orientation that stood at one device of a queue and were taken out."""

    name: str  # of the orientation in which they came
    place: int  # of the device along the chain of what stands on the track, from 1; 0 before the first
    kind: str  # of the device; '' of the bare track
    parts: int


@dataclass(frozen=True)
class FilledQueue:
    """Counts of a queue at one fill."""

    fill: str  # 'low', 'normal', 'high'
    gaps: float  # [1] mean free way between parts as they come, over their length
    parts: int
    seconds: float  # [s] followed
    counted: float  # [s] of them since the first part came to the outlet
    delivered: float  # parts that left
    right: int  # of the whole ones those in the wanted orientation
    left: int  # whole ones that left
    returned: int
    jams: int
    climbs: int
    partial: bool = False  # stopped by the user
    left_instead: LeavingCounts = ()  # in which poses other parts left, and how many, the most first
    # by the orientation in which whole parts came: how many something became of, how many left as wanted
    counts_by_entry: tuple[tuple[int, int], ...] = ()
    # where parts that came as wanted fell back: names of devices, '' the bare track, and how many, most first
    wanted_returned_at: tuple[tuple[str, int], ...] = ()
    jammed: tuple[JammedParts, ...] = ()  # what was taken out, the most first
    overlaps: int = 0  # stood too deep in another part or in the track: faults of the trial, no jams

    @property
    def rate(self) -> float:
        """Return wanted parts that leave [1/s]: delivered ones times the wanted share of whole ones."""
        if not self.counted > 0.0 or not self.left:
            return 0.0
        return self.delivered / self.counted * self.right / self.left

    @property
    def ends(self) -> tuple[float, float]:
        """Return the ends of the 95 % interval of that rate [1/s]: pace times the interval of the share."""
        if not self.pace > 0.0:
            return 0.0, 0.0
        low, high = share_interval((self,))
        return self.pace * low, self.pace * high

    @property
    def offered(self) -> int:
        """Return the number of whole parts of which something became."""
        return self.left + self.returned

    @property
    def pace(self) -> float:
        """Return the parts that are offered [1/s]; 0 where none leaves as wanted."""
        return self.rate * self.offered / self.right if self.right else 0.0


FILL_COLUMNS: tuple[Column[FilledQueue], ...] = (  # at the head of a row
    Column("fill", lambda filled: filled.fill),
    Column("free_way", lambda filled: filled.gaps),
    Column("parts", lambda filled: filled.parts),
    Column("seconds", lambda filled: filled.seconds),
)
FILL_COUNT_COLUMNS: tuple[Column[FilledQueue], ...] = (
    Column("left", lambda filled: filled.left),
    Column("right", lambda filled: filled.right),
    Column("returned", lambda filled: filled.returned),
    Column("jams", lambda filled: filled.jams),
    Column("overlaps", lambda filled: filled.overlaps),
    Column("climbs", lambda filled: filled.climbs),
)


def share_interval(queues: Iterable[FilledQueue]) -> tuple[float, float]:
    """Return the 95 % interval of the share of parts that leave as wanted, of those something became of.

    Parts come in their orientations in exact shares, so only what becomes of each orientation is left to
    chance. The proportions p of the orientations, each with its Wilson interval (l, u), are added up by their
    shares w of the parts:

        sum(w p) - sqrt(sum((w (p - l))^2))  to  sum(w p) + sqrt(sum((w (u - p))^2)),

    cut off at 0 and 1.

    Parameters
    ----------
    queues : iterable of FilledQueue
        Of one supply: their counts are added up. Where one does not know its counts by orientation, all parts
        are taken as of one.

    Returns
    -------
    low, high : float [1]
        0 and 1 where nothing became of any part.

    References
    ----------
    W. G. Cochran, "Sampling techniques", 3rd ed., 1977, sec. 5.3, for the sum over strata.
    G. Y. Zou, A. Donner, Statist. Med. 27, 1693-1702, 2008, for its interval.
    """
    queues = tuple(queues)
    right, offered = sum(queue.right for queue in queues), sum(queue.offered for queue in queues)
    if not offered:
        return 0.0, 1.0
    counts = [queue.counts_by_entry for queue in queues]
    strata = [(offered, right)]
    if all(counts):
        strata = [(sum(n for n, _ in entry), sum(k for _, k in entry)) for entry in zip(*counts, strict=True)]
    parts, wanted = np.array([row for row in strata if row[0]], float).T
    ends = [wilson([k], n) for n, k in zip(parts, wanted, strict=True)]
    lows, highs = np.array(ends)[:, :, 0].T
    share, of_each, weights = right / offered, wanted / parts, parts / offered
    down, up = (np.sqrt(((weights * (end - of_each)) ** 2).sum()) for end in (lows, highs))
    return max(float(share - down), 0.0), min(float(share + up), 1.0)


@dataclass(frozen=True, eq=False)
class FedRow:
    """Parts of one kind in a row along one track, and what of them is wanted; M orientations."""

    part: Part
    bowl: Bowl  # with its devices
    aspects: Aspects
    orientations: Orientations  # M of them
    shares: Floats  # (M,) [1] in which they come to the tooling
    states: tuple[int, ...]  # in which parts are wanted to leave
    any_heading: tuple[str, ...] = ()  # aspects on which parts are wanted, whatever their heading
    # (M,) [1] in which they come where they touch on their way: as they entered the track; as shares without
    touching: Floats | None = None

    def queue(
        self, fill: FillLevel, seconds: float, seed: int, *, parts: int | None = None, frames: int = 0
    ) -> PartsQueue:
        """Return the queue of a fill, not yet followed.

        Parameters
        ----------
        fill : FillLevel
        seconds : float [s]
            For which it is planned.
        seed : int
            Of play, gaps and the order of the orientations.
        parts : int, optional
            In the row; those of the fill without it.
        frames : int, optional
            Poses of all parts that are noted for a film.

        Returns
        -------
        PartsQueue
        """
        poses = find_poses(self.orientations, self.states, self.any_heading)
        plan = plan_of_fill(fill, seconds, parts=parts, frames=frames)
        shares = self.shares if plan.is_ridden or self.touching is None else self.touching
        supply = self.orientations.lying, shares
        return PartsQueue(self.part, self.bowl, self.aspects, supply, poses, plan, seed)

    @property
    def _free(self) -> tuple[str, ...]:
        """Aspects on which parts that lie are wanted at any heading."""
        return () if isinstance(self.orientations.states[self.states[0]], Hanging) else self.any_heading

    def _is_wanted(self, shape: tuple[int, ...]) -> Bools:
        """Which orientations (rows) and aspects in which parts leave are wanted, (S + 1, A + 1)."""
        lying, names, free = self.orientations.states, list(self.aspects.names), self._free
        right = np.zeros(shape, bool)  # a part of such a heading on such an aspect counts once
        right[:, [names.index(name) for name in free]] = True
        right[[k for k in self.states if lying[k].aspect not in free], :] = True
        return right

    def wanted_parts(self, outcome: QueuedParts) -> int:
        """Return how many whole parts left a queue as it was asked for.

        On an aspect that counts at any heading a part counts by the face below it, as at the outlet, whatever
        its heading. Any other counts in the orientations that are wanted.

        Parameters
        ----------
        outcome : QueuedParts

        Returns
        -------
        int
        """
        return int(outcome.whole[self._is_wanted(outcome.whole.shape)].sum())

    def left_instead(self, outcome: QueuedParts) -> LeavingCounts:
        """Return in which poses whole parts left otherwise than wanted.

        Parameters
        ----------
        outcome : QueuedParts

        Returns
        -------
        LeavingCounts
            Each pose with its number of parts, the most first; poses without any are left out.
        """
        lying, names, free = self.orientations.states, list(self.aspects.names), self._free
        counts, counted_headings = Counter[LeavingPose](), Counter[str]()
        for k, orientation in enumerate(lying):
            hangs = isinstance(orientation, Hanging)
            counted_headings["" if hangs else orientation.aspect] += int(outcome.leaving_counts[k])
            if k not in self.states and (hangs or orientation.aspect not in free):
                aspect = "" if hangs else orientation.aspect
                pose = LeavingPose(PoseKind.ORIENTATION, aspect, orientation.name)
                counts[pose] += int(outcome.leaving_counts[k])
        for k, name in enumerate(names):
            if name not in free:
                off = max(int(outcome.aspects[k]) - counted_headings[name], 0)
                counts[LeavingPose(PoseKind.HEADING_OFF, name)] += off
        rest = int(outcome.leaving_counts.sum()) - self.wanted_parts(outcome) - counts.total()
        counts[LeavingPose(PoseKind.UNKNOWN)] += max(rest, 0)
        return tuple((pose, number) for pose, number in counts.most_common() if number)

    def count(self, fill: FillLevel, outcome: QueuedParts) -> FilledQueue:
        """Return the counts of a queue that was followed.

        Parameters
        ----------
        fill : FillLevel
            At which its parts came.
        outcome : QueuedParts

        Returns
        -------
        FilledQueue
        """
        left = outcome.left_by_entry
        is_wanted = self._is_wanted(outcome.whole.shape)
        as_wanted = left[:, is_wanted].sum(axis=1)
        offered = left.sum(axis=(1, 2)) + outcome.returned_by_entry
        # where parts that came as wanted fell back
        rows = wanted_rows(self.orientations, self.states)
        fallen = outcome.returned_at[rows].sum(axis=0) if outcome.returned_at.size else np.zeros(0, int)
        names = [BARE_TRACK, *(device.kind for device in self.bowl.devices if device.action.has_place)]
        stood = Counter[tuple[str, int, str]]()
        for row, place in np.argwhere(outcome.jammed_at).tolist():
            key = self.orientations.lying[row].name, place, names[place]
            stood[key] += int(outcome.jammed_at[row, place])
        lost = Counter[str]()
        for name, number in zip(names, fallen.tolist()):
            lost[name] += number
        return FilledQueue(
            fill=fill,
            gaps=fill.gaps,
            parts=outcome.parts,
            seconds=outcome.seconds,
            counted=outcome.counted_seconds,
            delivered=outcome.delivered,
            right=self.wanted_parts(outcome),
            left=int(outcome.leaving_counts.sum()),
            returned=outcome.returned,
            jams=outcome.jams,
            climbs=outcome.climbs,
            partial=outcome.partial,
            left_instead=self.left_instead(outcome),
            counts_by_entry=tuple(zip(offered.tolist(), as_wanted.tolist(), strict=True)),
            wanted_returned_at=tuple((name, n) for name, n in lost.most_common() if n),
            jammed=tuple(JammedParts(*key, n) for key, n in stood.most_common()),
            overlaps=outcome.overlaps,
        )
