"""The queue at low, normal and high fill, as a buyer accepts a feeder."""

import math
import queue as fifo
import threading
from collections import Counter
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from scipy.stats import binom

from feederscrew.arrays import Bools, Floats
from feederscrew.bowl.record import Bowl
from feederscrew.designing import short_trials
from feederscrew.designing.findings import LeavingCounts, LeavingPose, PoseKind, join_leaving_counts
from feederscrew.designing.record import (
    PURE,
    RATE_KEPT,
    DesignStudy,
    FilledQueue,
    share_interval,
)
from feederscrew.dropping.ensemble import wilson
from feederscrew.part.record import Part
from feederscrew.rates.stream import Orientations
from feederscrew.resting.aspects import Aspects
from feederscrew.tooling.orientations import Hanging
from feederscrew.trial.queue import MEAN_GAP_SHARE, PartsQueue, QueuedParts, QueuePlan

# mean free way between parts over their length
FILLS = (("low", short_trials.LOW), ("normal", MEAN_GAP_SHARE), ("high", 0.0))
TOUCHING_PARTS, FILL_SECONDS = 12, 60.0  # that touch in a queue; [s] of each fill at the most
PLANNED_PARTS = 150  # that left all fills: where so many are pure, its time need not be over
FIRST_LOOK_S = 15.0  # [s] of each fill before anything is said to hold, and in which the track has filled
LOOK_EVERY_S = 5.0  # [s] of each fill after which all of them are looked at
SLOW_AFTER_S = 20.0  # [s] of a fill before it is said to be too slow: few parts have come until then
VERDICT_RISK = 0.1  # [1] chance that all parts would turn the verdict, at a purity just enough
MORE_TIMES = 3  # times as long again at the fill that brings least, at most, where that decides
ADDED = ("seconds", "counted", "delivered", "right", "left", "returned", "jams", "climbs")


@dataclass(frozen=True, eq=False)
class FollowedRow:
    """Parts in a row along one track, and how they are followed."""

    part: Part
    bowl: Bowl  # with its devices
    aspects: Aspects
    orientations: Orientations  # M of them
    shares: Floats  # (M,) [1] in which they come
    states: tuple[int, ...]  # in which parts are wanted to leave
    seed: int
    tell: Callable | None = None  # called with what is being followed, a sentence
    least: float = 0.0  # wanted parts [1/s] below which a fill does not hold
    any_heading: tuple[str, ...] = ()  # aspects on which parts are wanted, whatever their heading
    progress: Callable[[int, int], None] | None = None  # told how many periods are done, of how many
    # (M,) [1] in which they come where they touch on their way: as they entered the track; as shares without
    touching: Floats | None = None
    jobs: int = 1  # cores: fills are then followed side by side, with the same outcome

    def queue(self, gaps: float, seed: int) -> PartsQueue:
        """Return a queue of parts that come with a mean free way of so many lengths between them."""
        poses = short_trials.find_poses(self.orientations, self.states, self.any_heading)
        shares = self.shares if gaps > 0.0 or self.touching is None else self.touching
        plan = QueuePlan(parts_in_row(gaps), FILL_SECONDS, gaps, is_balanced=True, is_ridden=gaps > 0.0)
        lying = self.orientations.lying, shares
        return PartsQueue(self.part, self.bowl, self.aspects, lying, poses, plan, seed)

    def follow_fill(self, fill: str, gaps: float, seed: int) -> FilledQueue:
        """Return what a queue did in FILL_SECONDS."""
        self.say(fill, FILL_SECONDS)
        queue, stopped = self.queue(gaps, seed), False
        try:
            queue.follow(FILL_SECONDS, self.tell_periods(0))
        except KeyboardInterrupt:
            if not queue.periods:
                raise
            stopped = True
        return self.count(fill, gaps, queue.result(partial=stopped))

    def say(self, fill: str, seconds: float) -> None:
        """Tell which fill is followed, and until when [s]."""
        if self.tell:
            self.tell(f"queue of {parts_in_row(dict(FILLS)[fill])} at {fill} fill, to {seconds:g} s")

    def tell_periods(self, before: int) -> Callable[[int, int], None]:
        """Return what is told how many periods of a queue are done; ``before`` of other fills are."""

        def tell(done: int, _: int) -> None:
            if self.progress:
                self.progress(before + done, len(FILLS) * math.ceil(FILL_SECONDS * self.bowl.drive.frequency))

        return tell

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
        """
        return int(outcome.whole[self._is_wanted(outcome.whole.shape)].sum())

    def left_instead(self, outcome: QueuedParts) -> LeavingCounts:
        """Return in which poses whole parts left otherwise than wanted, and how many, the most first."""
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

    def count(self, fill: str, gaps: float, outcome: QueuedParts) -> FilledQueue:
        """Return what a queue did as a FilledQueue."""
        left = outcome.left_by_entry
        wanted = left[:, self._is_wanted(outcome.whole.shape)].sum(axis=1)
        offered = left.sum(axis=(1, 2)) + outcome.returned_by_entry
        return FilledQueue(
            fill=fill,
            gaps=gaps,
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
            counts_by_entry=tuple(zip(offered.tolist(), wanted.tolist(), strict=True)),
        )


def parts_in_row(gaps: float) -> int:
    """Return how many parts make a row as long as TOUCHING_PARTS, with a free way over their length [1]."""
    return round(TOUCHING_PARTS / (1.0 + gaps))


def planned_parts(least_rate: float) -> float:
    """Return how many pure parts that left all fills are enough for a design: PLANNED_PARTS at the least.

    Of a high rate its parts of three minutes. ``least_rate`` [1/s] of wanted parts is that below which a
    fill does not hold, RATE_KEPT of the rate that is asked for.
    """
    return max(PLANNED_PARTS, least_rate / RATE_KEPT * len(FILLS) * FILL_SECONDS)


def follow_fills(row: FollowedRow, *, whole: bool = True) -> tuple[FilledQueue, ...]:
    """Follow a queue at each fill, in turn by some seconds.

    Each is followed for FIRST_LOOK_S seconds, then each LOOK_EVERY_S seconds further, to FILL_SECONDS, or
    until the planned parts have left. Unless ``whole``, it is asked after each bit whether they surely do not
    hold, and after each round whether they surely do (``is_sure``). There are fewer, or of less time, where
    the user stopped it or it was plain before how it ends. Raises KeyboardInterrupt if the user stops it
    before anything was seen.
    """
    running: dict[str, PartsQueue] = {}
    queue_of_fill: dict[str, FilledQueue] = {}
    for seconds in rounds():
        with _Fills(row, running, seconds) as followers:
            for name, gaps in FILLS:
                try:
                    row.say(name, seconds)
                    for until in followers.times[name]:
                        last = queue_of_fill[name] = followers.follow(name, gaps, until)
                        if not whole and is_denied(tuple(queue_of_fill.values()), last, row.least):
                            return tuple(queue_of_fill.values())
                except KeyboardInterrupt:
                    followers.stop()
                    # what was seen until then, marked
                    if name in running and running[name].periods:
                        queue_of_fill[name] = row.count(name, gaps, running[name].result(partial=True))
                    if not queue_of_fill:
                        raise
                    stopped = name if name in queue_of_fill else next(reversed(queue_of_fill))
                    queue_of_fill[stopped] = replace(queue_of_fill[stopped], partial=True)
                    return tuple(queue_of_fill.values())
        fills = tuple(queue_of_fill.values())
        if has_enough(fills, row.least) or (not whole and is_sure(fills, row.least)):
            break
    return tuple(queue_of_fill.values())


class _Fills:
    """The queues of all fills through one round: each followed when it is asked for, or on several cores.

    There all of them begin at once, the densest first: it takes longest. ``times`` [s] are those at which
    each fill is looked at.
    """

    def __init__(self, row: FollowedRow, running: dict[str, PartsQueue], seconds: float) -> None:
        self.row, self.running = row, running
        self.times: dict[str, list[float]] = {}
        for name, _ in FILLS:
            begin = running[name].time if name in running else 0.0
            count = max(math.ceil((seconds - begin) / LOOK_EVERY_S - 1e-6), 1)
            self.times[name] = [begin + (seconds - begin) * (k + 1) / count for k in range(count)]
        self.stopped, self.pool = threading.Event(), None
        if row.jobs > 1:
            self.counted: dict[str, fifo.SimpleQueue] = {name: fifo.SimpleQueue() for name, _ in FILLS}
            self.pool = pool = ThreadPoolExecutor(row.jobs)
            self.tasks = {name: pool.submit(self._follow_all, name, gaps) for name, gaps in reversed(FILLS)}

    def __enter__(self) -> "_Fills":
        return self

    def __exit__(self, *fault: object) -> None:
        self.stop()

    def stop(self) -> None:
        """Follow no fill any further; threads end after the period that they are in."""
        self.stopped.set()
        if self.pool is not None:
            self.pool.shutdown(cancel_futures=True)

    def follow(self, name: str, gaps: float, until: float) -> FilledQueue:
        """Return what a fill did until a time [s]."""
        if self.pool is not None:
            outcome = self.counted[name].get()
            if outcome is None:
                self.tasks[name].result()  # raises what ended it
            self.row.tell_periods(0)(sum(queue.periods for queue in list(self.running.values())), 0)
            return outcome
        queue = self._queue(name, gaps)
        periods_elsewhere = sum(other.periods for other in self.running.values() if other is not queue)
        queue.follow(until, self.row.tell_periods(periods_elsewhere))
        return self.row.count(name, gaps, queue.result())

    def _queue(self, name: str, gaps: float) -> PartsQueue:
        if name not in self.running:
            self.running[name] = self.row.queue(gaps, self.row.seed)
        return self.running[name]

    def _follow_all(self, name: str, gaps: float) -> None:
        """Follow one fill through the round, in a thread."""

        def end_where_stopped(*_: int) -> None:
            if self.stopped.is_set():
                raise KeyboardInterrupt

        try:
            queue = self._queue(name, gaps)
            for until in self.times[name]:
                queue.follow(until, end_where_stopped)
                self.counted[name].put(self.row.count(name, gaps, queue.result()))
        finally:
            self.counted[name].put(None)  # nothing more comes: who waits learns what ended it


def rounds() -> tuple[float, ...]:
    """Return the times [s] to which all fills are followed, one after the other."""
    count = max(math.ceil((FILL_SECONDS - FIRST_LOOK_S) / LOOK_EVERY_S), 0)
    return tuple(min(FIRST_LOOK_S + k * LOOK_EVERY_S, FILL_SECONDS) for k in range(count + 1))


def follow_longer(row: FollowedRow, study: DesignStudy) -> tuple[FilledQueue, ...]:
    """Follow the queue that brings least for longer, where that decides what its parts cannot tell.

    How long is settled beforehand, so that it does not end when it happens to look well. It ends earlier
    where the parts still to come would turn the verdict with a chance of VERDICT_RISK at the most. Returned
    are the queues of the study, that one with what was seen since.
    """
    queues, count = study.queues, minutes(study)
    place = queues.index(study.slowest) if count else 0
    for k in range(count):
        least = queues[place]
        if k and is_settled(queues, row.least, _parts_to_come(least, count - k)):
            break
        more = row.follow_fill(least.fill, least.gaps, row.seed + k + 1)  # both count as one queue
        sums = {name: getattr(least, name) + getattr(more, name) for name in ADDED}
        pairs = zip(least.counts_by_entry, more.counts_by_entry, strict=True)
        joined = replace(
            least,
            **sums,
            partial=more.partial,
            left_instead=join_leaving_counts(least.left_instead, more.left_instead),
            counts_by_entry=tuple((a[0] + b[0], a[1] + b[1]) for a, b in pairs),
        )
        queues = (*queues[:place], joined, *queues[place + 1 :])
        if joined.partial:
            break
    return queues


def minutes(study: DesignStudy) -> int:
    """Return for how many times FILL_SECONDS a queue is to be followed further: 0 where that decides nothing.

    The rate is undecided where it would hold with the same shares of more parts; purity, where what is
    asked for lies in its interval and the parts of these times may well turn the verdict.
    """
    queues, need = study.queues, RATE_KEPT * study.request.target
    if len(queues) < len(FILLS) or study.jams or study.partial:
        return 0
    right, left = _sums(queues, "right", "left")
    own, rate = study.slowest, study.delivered[0]
    if not right or own is None or float(wilson([right], left)[1][0]) < PURE:
        return 0
    times = range(MORE_TIMES + 1)
    share = right / sum(queue.offered for queue in queues)
    lows = [share_interval(queues, 1.0 + k * FILL_SECONDS / study.queue_seconds)[0] for k in times]
    enough = next((k for k, low in enumerate(lows) if rate * low / share >= need), None)
    if enough is None or right >= PURE * left:
        return enough or 0
    return 0 if is_settled(queues, need, _parts_to_come(own, MORE_TIMES)) else MORE_TIMES


def _sums(fills: Sequence[FilledQueue], *names: str) -> list[Any]:
    return [sum(getattr(queue, name) for queue in fills) for name in names]


def _parts_to_come(queue: FilledQueue, count: int) -> int:
    """Parts that leave a queue in ``count`` times FILL_SECONDS more, at its pace so far."""
    return math.ceil(queue.left * count * FILL_SECONDS / max(queue.seconds, 1e-300))


def is_settled(fills: Sequence[FilledQueue], least_rate: float, parts_to_come: int) -> bool:
    """Return whether parts still to come, so many, would hardly turn the verdict of fills.

    Were the purity only just PURE, they would do so with a chance of VERDICT_RISK at the most (binomial), and
    where the purity is enough so is the lower end of the rate. Below ``least_rate`` wanted parts [1/s] fills
    do not hold.
    """
    right, left = _sums(fills, "right", "left")
    allowed = math.floor((1.0 - PURE) * (left + parts_to_come) + 1e-9) - (left - right)
    if float(binom.cdf(allowed, parts_to_come, 1.0 - PURE)) <= VERDICT_RISK:  # hardly any other may come
        return True
    low = min(queue.pace for queue in fills) * share_interval(fills)[0]
    return float(binom.sf(allowed, parts_to_come, 1.0 - PURE)) <= VERDICT_RISK and low >= least_rate


def is_complete(fills: Sequence[FilledQueue]) -> bool:
    """Return whether queues were followed to their end, in time or parts, or until they were sure."""
    if len(fills) < len(FILLS):
        return False
    return (
        all(queue.seconds > 0.99 * FILL_SECONDS for queue in fills)
        or has_enough(fills, 0.0)
        or (all(queue.seconds > 0.99 * FIRST_LOOK_S for queue in fills) and is_sure(fills, 0.0))
    )


def has_enough(fills: Sequence[FilledQueue], least_rate: float) -> bool:
    """Return whether as many parts as planned have left, and are pure, after FIRST_LOOK_S seconds at least.

    ``least_rate`` [1/s] is that of ``planned_parts``. How often that errs: docs/design.md.
    """
    right, left, jams = _sums(fills, "right", "left", "jams")
    long_enough = len(fills) == len(FILLS) and all(queue.seconds > 0.99 * FIRST_LOOK_S for queue in fills)
    return long_enough and not jams and left >= planned_parts(least_rate) and right >= PURE * left


def is_sure(fills: Sequence[FilledQueue], least_rate: float) -> bool:
    """Return whether queues hold so surely that they need not be followed to their end.

    They do where nothing has jammed, as many wanted parts have left as FILL_SECONDS at each fill would bring
    at the rate that is asked for, and the lower end of the delivered rate (95 %) is that rate itself. Were
    the purity only just PURE, the parts still to come of those planned would turn the verdict with a chance
    of VERDICT_RISK at the most (binomial). The queues are one at each fill, of the same time; ``least_rate``
    [1/s] is that of ``planned_parts``.

    A bowl whose purity is too low so gets through at most 1 / (1 - VERDICT_RISK) times as often as after all
    its parts. Of 400 drawn runs at each purity of 96, 98 and 99.5 %, 3 % at the most ended early that all
    parts would have denied. Source: K. K. G. Lan, R. Simon, M. Halperin, "Stochastically curtailed tests in
    long-term clinical trials", Sequential Analysis 1, 207-219, 1982; docs/design.md.
    """
    right, left, jams = _sums(fills, "right", "left", "jams")
    target, planned = least_rate / RATE_KEPT, len(FILLS) * FILL_SECONDS
    if len(fills) < len(FILLS) or jams or not right or right < target * planned:
        return False
    pace = min(queue.pace for queue in fills)
    if pace * share_interval(fills)[0] < target or any(queue.ends[1] < least_rate for queue in fills):
        return False
    coming = math.ceil(max(min(_parts_by_time(fills), planned_parts(least_rate)) - left, 0.0))
    allowed = math.floor((1.0 - PURE) * (left + coming) + 1e-9) - (left - right)
    return float(binom.sf(allowed, coming, 1.0 - PURE)) <= VERDICT_RISK


def _parts_by_time(fills: Sequence[FilledQueue]) -> float:
    """Parts that would have left after FILL_SECONDS of each fill, at the pace so far."""
    left, seconds = _sums(fills, "left", "seconds")
    return left * max(len(FILLS) * FILL_SECONDS / seconds, 1.0)


def is_denied(fills: Sequence[FilledQueue], last_fill: FilledQueue, least_rate: float) -> bool:
    """Return whether fills are none of a design that holds, whatever is seen of the rest of them.

    One has jammed, more of another orientation have left than all of them may have at this pace, or the
    upper end of the last one's rate is below the least [1/s].
    """
    left, right = _sums(fills, "left", "right")
    whole = _parts_by_time(fills)
    slow = last_fill.seconds > 0.99 * SLOW_AFTER_S and last_fill.ends[1] < least_rate
    return bool(last_fill.jams or left - right > (1.0 - PURE) * whole or slow)
