"""The queues of a design at low, normal and high fill, each followed until it is settled."""

import math
import queue as fifo
import threading
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace

from feederscrew.designing import fill_verdicts
from feederscrew.designing.fill_verdicts import FillState
from feederscrew.trials.fills import FedRow, FilledQueue, FillLevel
from feederscrew.trials.queue import PartsQueue

FILLS = (
    FillLevel.HIGH,
    FillLevel.NORMAL,
    FillLevel.LOW,
)  # in turn: the fullest track first, for it fails most often
LOOK_EVERY_S = 1.0  # [s] of each fill after which it is looked at
KNOWN_AFTER_S = 60.0  # [s] of a fill for its figures alone, once another one is refused
SLIGHT_S = 1e-6  # [s] rounding of a time
# [1] times the processor time of a part and second at high fill, where parts push: 2.0 of a T-nut, 1.9 and
# 2.9 of a bracket
PUSHED_COST = 2.0
USUAL_PARTS = 100  # right parts of a pure fill until it is settled: of which progress makes its guess


@dataclass(frozen=True, eq=False, kw_only=True)
class FollowedRow(FedRow):
    """A row of parts, and how it is followed."""

    seed: int
    tell: Callable | None = None  # called with what is being followed, a sentence
    least: float = 0.0  # wanted parts [1/s] below which a fill does not hold
    longest: float = 600.0  # [s] for which each fill is followed at the most
    # told how many part-seconds are done, of how many as it looks by now
    progress: Callable[[int, int], None] | None = None
    jobs: int = 1  # cores: fills are then followed side by side, with the same outcome

    def say(self, fill: FillLevel, seconds: float) -> None:
        """Tell which fill is followed, and until when.

        Parameters
        ----------
        fill : FillLevel
        seconds : float [s]
        """
        if self.tell:
            end = (
                f"to {seconds:g} s"
                if seconds < self.longest
                else f"until it is settled, {seconds:g} s at most"
            )
            self.tell(f"queue of {fill.parts} at {fill} fill, {end}")

    def time_of(self, fill: FillLevel, seen: Mapping[FillLevel, FilledQueue]) -> float:
        """Return a guess of the seconds for which a fill is followed, from what was seen of it and of others.

        Parameters
        ----------
        fill : FillLevel
        seen : mapping of FillLevel to FilledQueue

        Returns
        -------
        float [s]
            By its own rate; by the mean of the others where it was not seen yet, and by the rate that is
            asked for where none was.
        """
        if fill in seen:
            is_open = self.judge(seen[fill]) is FillState.OPEN
            return fill_verdicts.time_to_settle(seen[fill], self.longest) if is_open else seen[fill].seconds
        if seen:
            return sum(self.time_of(other, seen) for other in seen) / len(seen)
        rate = fill_verdicts.RATE_KEPT * USUAL_PARTS / self.least if self.least > 0.0 else self.longest
        return min(rate, self.longest)

    def work(self, seen: Mapping[FillLevel, FilledQueue]) -> float:
        """Return a guess of the part-seconds of all fills: a second of a row counts by its ``cost``.

        Parameters
        ----------
        seen : mapping of FillLevel to FilledQueue

        Returns
        -------
        float
        """
        return sum(cost(fill) * self.time_of(fill, seen) for fill in FILLS)

    def judge(self, queue: FilledQueue) -> FillState:
        """Return what a fill has shown so far.

        Parameters
        ----------
        queue : FilledQueue

        Returns
        -------
        FillState
        """
        return fill_verdicts.judge_fill(queue, self.least, self.longest)


def cost(fill: FillLevel) -> float:
    """Return what a second of a fill costs beside others: its parts, and more where they push.

    Parameters
    ----------
    fill : FillLevel

    Returns
    -------
    float
        In parts of a row that does not push.
    """
    return fill.parts * (PUSHED_COST if fill is FillLevel.HIGH else 1.0)


def follow_fills(
    row: FollowedRow, *, whole: bool = True, running: dict[FillLevel, PartsQueue] | None = None
) -> tuple[FilledQueue, ...]:
    """Follow a queue at each fill until it is settled: a first look at all of them, then one after the other.

    Each is followed for FIRST_LOOK_S seconds. Then, the fullest first, each goes on until it holds or is
    refused, or to the longest time of the row; it is looked at every LOOK_EVERY_S seconds.

    Parameters
    ----------
    row : FollowedRow
    whole : bool
        Each fill ends by its own parts, however slow it is. Once one is refused, those after it are followed
        for KNOWN_AFTER_S at the most: the design does not hold, and they only say how it does there. Without
        it all of them end as soon as one is refused.
    running : dict, optional
        Queues of the same row, by their fills, that go on where they are. It gets those that are followed
        here.

    Returns
    -------
    tuple of FilledQueue
        In the order of ``FillLevel``. There are fewer where the user stopped it or one was refused before.
        It is the same on any number of cores.

    Raises
    ------
    KeyboardInterrupt
        If the user stops it before anything was seen.
    """
    if whole:
        row = replace(row, least=0.0)
    running = {} if running is None else running
    queue_of_fill: dict[FillLevel, FilledQueue] = {}

    def found() -> tuple[FilledQueue, ...]:
        return tuple(queue_of_fill[fill] for fill in FillLevel if fill in queue_of_fill)

    seconds, going = min(fill_verdicts.FIRST_LOOK_S, row.longest), list(FILLS)
    limit = row.longest
    while going:
        with _Fills(row, running, going, seconds, queue_of_fill) as followers:
            for fill in tuple(going):
                try:
                    row.say(fill, min(seconds, limit))
                    for until in followers.times[fill]:
                        if until > limit:
                            followers.leave(fill)
                            break
                        queue = queue_of_fill[fill] = followers.follow(fill, until)
                        state = row.judge(queue)
                        if state is FillState.REFUSED and not whole:
                            followers.stop()
                            _drop_unasked(running, queue_of_fill)
                            return found()
                        if state is FillState.REFUSED:
                            limit = min(limit, KNOWN_AFTER_S)
                        if state is not FillState.OPEN:
                            going.remove(fill)
                            break
                except KeyboardInterrupt:
                    followers.stop()
                    # what was seen until then, marked
                    if fill in running and running[fill].periods:
                        queue_of_fill[fill] = row.count(fill, running[fill].result(partial=True))
                    if not queue_of_fill:
                        raise
                    stopped = fill if fill in queue_of_fill else next(reversed(queue_of_fill))
                    queue_of_fill[stopped] = replace(queue_of_fill[stopped], partial=True)
                    return found()
        if seconds >= row.longest:
            break
        seconds = row.longest
    _drop_unasked(running, queue_of_fill)
    return found()


def _drop_unasked(running: dict[FillLevel, PartsQueue], seen: dict[FillLevel, FilledQueue]) -> None:
    """Drop queues that other cores followed further than was asked for: they are not gone on with."""
    for name in list(running):
        if name not in seen or running[name].time > seen[name].seconds + SLIGHT_S:
            del running[name]


class _Fills:
    """The queues that are not settled, through one round: followed when asked for, or on several cores.

    There all of them begin at once. ``times`` [s] are those at which each fill is looked at; ``seen`` is what
    the looks have shown.
    """

    def __init__(
        self,
        row: FollowedRow,
        running: dict[FillLevel, PartsQueue],
        going: Sequence[FillLevel],
        seconds: float,
        seen: Mapping[FillLevel, FilledQueue],
    ) -> None:
        self.row, self.running, self.seen = row, running, seen
        self.times: dict[FillLevel, list[float]] = {}
        for name in going:
            begin = running[name].time if name in running else 0.0
            # one that goes on is looked at as it is, before it is followed
            first = max(math.floor(begin / LOOK_EVERY_S + SLIGHT_S), 1)
            last = max(math.ceil(seconds / LOOK_EVERY_S - SLIGHT_S), first)
            self.times[name] = [min(k * LOOK_EVERY_S, seconds) for k in range(first, last + 1)]
        self.stopped, self.pool = threading.Event(), None
        self.left: set[FillLevel] = set()
        if row.jobs > 1 and len(going) > 1:
            self.counted: dict[FillLevel, fifo.SimpleQueue] = {name: fifo.SimpleQueue() for name in going}
            self.pool = pool = ThreadPoolExecutor(row.jobs)
            self.tasks = {name: pool.submit(self._follow_all, name) for name in going}

    def __enter__(self) -> "_Fills":
        return self

    def __exit__(self, *fault: object) -> None:
        self.stop()

    def stop(self) -> None:
        """Follow no fill any further; threads end after the period that they are in."""
        self.stopped.set()
        if self.pool is not None:
            self.pool.shutdown(cancel_futures=True)

    def leave(self, name: FillLevel) -> None:
        """Follow a fill no further; its thread ends after the period that it is in."""
        self.left.add(name)

    def follow(self, name: FillLevel, until: float) -> FilledQueue:
        """Return what a fill did until a time [s]."""
        if self.pool is not None:
            outcome = self.counted[name].get()
            if outcome is None:
                self.tasks[name].result()  # raises what ended it
            self._tell(self.row.work(self.seen))
            return outcome
        queue, expected = self._queue(name), self.row.work(self.seen)
        queue.follow(until, lambda *_: self._tell(expected))
        return self.row.count(name, queue.result())

    def _tell(self, expected: float) -> None:
        if self.row.progress:
            done = sum(cost(fill) * queue.time for fill, queue in list(self.running.items()))
            self.row.progress(math.floor(done), math.ceil(max(expected, done)))

    def _queue(self, name: FillLevel) -> PartsQueue:
        if name not in self.running:
            self.running[name] = self.row.queue(name, self.row.longest, self.row.seed)
        return self.running[name]

    def _follow_all(self, name: FillLevel) -> None:
        """Follow one fill through the round, in a thread."""

        def end_where_stopped(*_: int) -> None:
            if self.stopped.is_set() or name in self.left:
                raise KeyboardInterrupt

        try:
            queue = self._queue(name)
            for until in self.times[name]:
                queue.follow(until, end_where_stopped)
                seen = self.row.count(name, queue.result())
                self.counted[name].put(seen)
                if self.row.judge(seen) is not FillState.OPEN:
                    break
        finally:
            self.counted[name].put(None)  # nothing more comes: who waits learns what ended it


def is_complete(fills: Sequence[FilledQueue], longest: float) -> bool:
    """Tell whether queues were followed to their end: each has settled its purity, or had its time.

    Parameters
    ----------
    fills : sequence of FilledQueue
    longest : float [s]
        The time of each at the most; KNOWN_AFTER_S where one is refused.

    Returns
    -------
    bool
    """
    if len(fills) < len(FILLS):
        return False
    states = [fill_verdicts.judge_fill(queue, 0.0, longest) for queue in fills]
    needed = min(longest, KNOWN_AFTER_S) if FillState.REFUSED in states else longest
    return all(
        queue.seconds > 0.99 * needed or state is not FillState.OPEN
        for queue, state in zip(fills, states, strict=True)
    )
