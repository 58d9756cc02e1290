"""The queue at low, normal and high fill, as a buyer accepts a feeder."""

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from feederscrew.bowl.record import Bowl
from feederscrew.designing import trying
from feederscrew.designing.record import (
    HEADING_OFF,
    PURE,
    RATE_KEPT,
    DesignStudy,
    FilledQueue,
    joined_counts,
)
from feederscrew.dropping.ensemble import wilson
from feederscrew.part.record import Part
from feederscrew.rates.stream import Orientations
from feederscrew.resting.aspects import Aspects
from feederscrew.running import RunSettings
from feederscrew.tooling.hanging import Hanging
from feederscrew.trial.queue import GAPS, QueuedParts, QueuePlan, queue_of

FILLS = (("low", trying.LOW), ("normal", GAPS), ("high", 0.0))  # free way between parts over their length
PARTS, SECONDS = 12, 60.0  # in a queue at a time; for so long
FILLED = 20.0  # [s] in which the track has filled: no rate is judged before
MORE = 3  # times as long again at the fill that brings least, at most, where that decides
ADDED = ("seconds", "counted", "delivered", "right", "left", "returned", "jams", "climbs")
Denied = Callable[[FilledQueue], bool]  # of what was seen so far: whether it is known not to hold


@dataclass(frozen=True, eq=False)
class FollowedRow:
    """Parts in a row along one track, and how they are followed."""

    part: Part
    bowl: Bowl  # with its devices
    aspects: Aspects
    known: Orientations  # M of them
    shares: np.ndarray  # (M,) [1] in which they come
    states: tuple[int, ...]  # in which parts are wanted to leave
    seed: int
    told: Callable | None = None  # called with what is being followed, a sentence
    least: float = 0.0  # wanted parts [1/s] below which a fill does not hold
    any_heading: tuple[str, ...] = ()  # aspects on which parts are wanted, whatever their heading
    progress: Callable[[int, int], None] | None = None  # told how many periods are done, of how many

    def followed(self, fill: str, gaps: float, seed: int, denied: Denied | None = None) -> FilledQueue:
        """Return the FilledQueue of PARTS that come with a mean free way of so many lengths between them.

        It ends as soon as ``denied`` says of what was seen so far, a FilledQueue, that it does not hold.
        """
        if self.told:
            self.told(f"queue of {PARTS} at {fill} fill, {SECONDS:g} s")
        poses = trying.counted(self.known, self.states, self.any_heading)
        run = RunSettings(seed, progress=self.progress)

        def ends(seen: QueuedParts) -> bool:
            return denied is not None and denied(self.count(fill, gaps, seen))

        seen = queue_of(
            self.part, self.bowl, self.aspects, self.known.lying, poses, self.shares,
            QueuePlan(PARTS, SECONDS, gaps, ends if denied else None), run,
        )  # fmt: skip
        return self.count(fill, gaps, seen)

    def wanted_parts(self, seen: QueuedParts) -> int:
        """Return how many whole parts left a queue as it was asked for.

        On an aspect that counts at any heading a part counts by the face below it, as at the outlet, whether
        or not its heading is one of the known. Any other counts in the orientations that are wanted.
        """
        lying, names = self.known.states, list(self.aspects.names)
        free = () if isinstance(lying[self.states[0]], Hanging) else self.any_heading
        right = np.zeros(seen.whole.shape, bool)  # a part of such a heading on such an aspect counts once
        right[:, [names.index(name) for name in free]] = True
        right[[k for k in self.states if lying[k].aspect not in free], :] = True
        return int(seen.whole[right].sum())

    def left_instead(self, seen: QueuedParts) -> tuple[tuple[str, int], ...]:
        """Return what whole parts left otherwise than wanted, and how many, the most first.

        What lies on an aspect at a heading that is none of the known is 'C, heading off'.
        """
        lying, names = self.known.states, list(self.aspects.names)
        free = () if isinstance(lying[self.states[0]], Hanging) else self.any_heading
        counts, known = Counter[str](), Counter[str]()
        for k, one in enumerate(lying):
            hangs = isinstance(one, Hanging)
            known["" if hangs else one.aspect] += int(seen.leaving[k])
            if k not in self.states and (hangs or one.aspect not in free):
                counts[one.name] += int(seen.leaving[k])
        for k, name in enumerate(names):
            if name not in free:
                counts[f"{name}{HEADING_OFF}"] += max(int(seen.aspects[k]) - known[name], 0)
        rest = int(seen.leaving.sum()) - self.wanted_parts(seen) - counts.total()
        counts["in no known pose"] += max(rest, 0)
        return tuple((name, number) for name, number in counts.most_common() if number)

    def count(self, fill: str, gaps: float, seen: QueuedParts) -> FilledQueue:
        """Return what a queue did as a FilledQueue."""
        return FilledQueue(
            fill=fill,
            gaps=gaps,
            parts=seen.parts,
            seconds=seen.seconds,
            counted=seen.counted,
            delivered=seen.delivered,
            right=self.wanted_parts(seen),
            left=int(seen.leaving.sum()),
            returned=seen.returned,
            jams=seen.jams,
            climbs=seen.climbs,
            partial=seen.partial,
            left_instead=self.left_instead(seen),
        )


def filled(row: FollowedRow, *, whole: bool = True) -> tuple[FilledQueue, ...]:
    """Follow a queue at each fill.

    Parameters
    ----------
    row : FollowedRow
    whole : bool
        Whether each is followed to its end, and after one that does not hold the next.

    Returns
    -------
    tuple of FilledQueue
        Fewer where the user stopped it, or where one does not hold.
    """
    found: list[FilledQueue] = []

    def denied(one: FilledQueue) -> bool:
        return _denied((*found, one), row.least)

    for name, gaps in FILLS:
        try:
            one = row.followed(name, gaps, row.seed, None if whole else denied)
        except KeyboardInterrupt:  # before anything of it was seen
            if not found:
                raise
            return (*found[:-1], replace(found[-1], partial=True))
        last = one.partial or not (whole or not denied(one))
        found.append(one)
        if last:
            break
    return tuple(found)


def longer(row: FollowedRow, study: DesignStudy) -> tuple[FilledQueue, ...]:
    """Follow the queue that brings least for longer, where that decides what a minute cannot tell.

    How long is settled beforehand, so that it does not end when it happens to look well.

    Parameters
    ----------
    row : FollowedRow
    study : DesignStudy
        With its queues.

    Returns
    -------
    tuple of FilledQueue
        Those of the study, that one with what was seen since.
    """
    found, count = study.queues, minutes(study)
    place = found.index(study.slowest) if count else 0
    for k in range(1, count + 1):
        least = found[place]
        joined = _joined(least, row.followed(least.fill, least.gaps, row.seed + k))
        found = (*found[:place], joined, *found[place + 1 :])
        if joined.partial:
            break
    return found


def minutes(study: DesignStudy) -> int:
    """Return for how many times as long again a queue is to be followed: 0 where that decides nothing.

    The rate is undecided where it would hold with the same shares of more parts; purity, where what is
    asked for lies in its interval.
    """
    found, need = study.queues, RATE_KEPT * study.request.target
    if len(found) < len(FILLS) or study.jams or study.partial:
        return 0
    right, left, back = (sum(getattr(one, name) for one in found) for name in ("right", "left", "returned"))
    own, rate = study.slowest, study.delivered[0]
    if not right or own is None:
        return 0
    kept = [1.0 + k * own.seconds / study.queue_seconds for k in range(MORE + 1)]  # times as many parts
    lows = [float(wilson([right * more], (left + back) * more)[0][0]) for more in kept]
    share = right / (left + back)
    enough = [k for k, low in enumerate(lows) if rate * low / share >= need]
    if not enough or float(wilson([right], left)[1][0]) < PURE:
        return 0
    return enough[0] if right >= PURE * left else MORE


def _joined(first: FilledQueue, second: FilledQueue) -> FilledQueue:
    """Both as one queue."""
    sums = {name: getattr(first, name) + getattr(second, name) for name in ADDED}
    instead = joined_counts(first.left_instead, second.left_instead)
    return replace(first, **sums, partial=second.partial, left_instead=instead)


def _denied(found: tuple[FilledQueue, ...], least: float) -> bool:
    """Whether fills are none of a design that holds, whatever is seen of the last one and the next ones.

    One has jammed, more of another orientation have left than all of them may have at this pace, or the
    upper end of the last one's rate is below the least [1/s].
    """
    last = found[-1]
    left, right, seconds = (sum(getattr(one, name) for one in found) for name in ("left", "right", "seconds"))
    whole = left * max(len(FILLS) * SECONDS / seconds, 1.0)
    slow = last.seconds >= FILLED and last.ends[1] < least
    return bool(last.jams or left - right > (1.0 - PURE) * whole or slow)
