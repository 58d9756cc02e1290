"""The long proof of a design: its queues followed for as long as an order asks, until jams an hour are shown.

One jam an hour is shown at 95 % by three hours of bowl time without a jam. These are many runs of some
minutes at each fill, each of a seed of its own and from an empty track. Each is kept in the cache of
simulations as soon as it is done: a proof that was stopped or killed goes on where it was.
"""

import contextlib
import functools
import hashlib
import math
import os
import sys
from collections.abc import Callable, Generator, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, fields

import numpy as np

from feederscrew.arrivals import simulation_cache
from feederscrew.base import check, processes, units
from feederscrew.base.arrays import Array, Ints
from feederscrew.base.errors import FeederError
from feederscrew.base.running import RunSettings
from feederscrew.designing import evidence
from feederscrew.designing.queues import FILLS
from feederscrew.trials.fills import FedRow, FilledQueue, FillLevel
from feederscrew.trials.queue_counts import QueuedParts

RUN_S = 300.0  # [s] of bowl time of one run, at the most: what an end in mid run can lose
REFUSED_CONFIDENCE = 0.99  # [1] one-sided, that a fill jams more often than was agreed: it ends there
KIND = "long proof"  # of the entries in the cache


@dataclass(frozen=True)
class LongPlan:
    """Plan by which a fill is followed: so many runs, and for how long each [s]."""

    runs: int
    seconds: float

    @classmethod
    def to_show(cls, agreed_jams: float, longest_run: float = RUN_S) -> "LongPlan":
        """Return the plan that shows fewer jams than were agreed where none comes.

        Parameters
        ----------
        agreed_jams : float [1/s]
            Jams that the buyer tolerates.
        longest_run : float [s]
            Of bowl time, of one run.

        Returns
        -------
        LongPlan
            Its runs take ``evidence.time_to_run(agreed_jams, 0)`` together: of 1 an hour 2.996 h.
        """
        needed = evidence.time_to_run(agreed_jams, 0)
        runs = max(math.ceil(needed / longest_run - 1e-9), 1)
        return cls(runs, needed / runs)


@dataclass(frozen=True)
class Run:
    """One run of the proof: all that decides it beside the row of parts."""

    fill: FillLevel
    seed: int
    seconds: float  # [s]


@dataclass(frozen=True, eq=False)
class RunCounts:
    """Counts of one run; M orientations come, S may leave, A aspects, D devices on the track."""

    seconds: float  # [s] followed
    counted: float  # [s] of them since the first part came to the outlet
    delivered: float  # parts that left
    jams: int
    climbs: int
    overlaps: int  # faults of the trial
    left: Ints  # (M, S + 1, A + 1) whole parts that left, as of ``QueuedParts``
    returned: Ints  # (M, D + 1) parts that fell back, and where

    @classmethod
    def of(cls, outcome: QueuedParts) -> "RunCounts":
        """Return what a queue counted.

        Parameters
        ----------
        outcome : QueuedParts

        Returns
        -------
        RunCounts
        """
        return cls(
            outcome.seconds,
            outcome.counted_seconds,
            outcome.delivered,
            outcome.jams,
            outcome.climbs,
            outcome.overlaps,
            outcome.left_by_entry,
            outcome.returned_at,
        )

    def __add__(self, other: "RunCounts") -> "RunCounts":
        return RunCounts(*(getattr(self, each.name) + getattr(other, each.name) for each in fields(self)))

    def to_arrays(self) -> dict[str, Array]:
        """Return the arrays that stand for it in a file."""
        return {each.name: np.asarray(getattr(self, each.name)) for each in fields(self)}

    @classmethod
    def from_arrays(cls, arrays: Mapping[str, Array], row: FedRow, run: Run) -> "RunCounts":
        """Return the counts that arrays of a file stand for.

        Parameters
        ----------
        arrays : mapping of str to array
            As of ``to_arrays``.
        row : FedRow
            That was run.
        run : Run
            How it was run.

        Returns
        -------
        RunCounts

        Raises
        ------
        ValueError
            If they are not of such a run, or contradict each other.
        """
        known, aspects, devices = row.orientations, row.aspects.names, row.bowl.devices
        shapes = {
            "left": (len(known.lying), len(known.states) + 1, len(aspects) + 1),
            "returned": (len(known.lying), sum(device.action.has_place for device in devices) + 1),
        }
        if set(arrays) != {each.name for each in fields(cls)}:
            raise ValueError("other counts")
        for each in fields(cls):
            array = arrays[each.name]
            is_right = array.shape == shapes.get(each.name, ()) and array.dtype.kind == (
                "f" if each.type is float else "i"
            )
            if not (is_right and np.isfinite(array).all() and (array >= 0).all()):
                raise ValueError(each.name)
        seconds, counted, delivered = (float(arrays[name]) for name in ("seconds", "counted", "delivered"))
        jams, climbs, overlaps = (int(arrays[name]) for name in ("jams", "climbs", "overlaps"))
        left, returned = (np.asarray(arrays[name], int) for name in ("left", "returned"))
        counts = cls(seconds, counted, delivered, jams, climbs, overlaps, left, returned)
        # as long as it was to be, and whole parts beside those that are just leaving
        is_whole = 0.0 <= counts.seconds - run.seconds <= 1.0 / row.bowl.drive.frequency + 1e-6
        leaving = abs(counts.delivered - counts.left.sum()) if counts.counted else counts.delivered
        if not (is_whole and counts.counted <= counts.seconds and leaving <= run.fill.parts):
            raise ValueError("counts that contradict each other")
        return counts

    def outcome(self, parts: int, *, partial: bool) -> QueuedParts:
        """Return the counts as a queue has them.

        Parameters
        ----------
        parts : int
            In the row.
        partial : bool
            Whether it was stopped.

        Returns
        -------
        QueuedParts
        """
        by_entry = self.returned.sum(axis=1)
        return QueuedParts(
            parts=parts,
            on_track=parts,
            is_poured=False,
            seconds=self.seconds,
            counted_seconds=self.counted,
            delivered=self.delivered,
            whole=check.frozen(self.left.sum(axis=0)),
            left_by_entry=check.frozen(self.left),
            returned_by_entry=check.frozen(by_entry),
            returned_at=check.frozen(self.returned),
            returned=int(by_entry.sum()),
            jams=self.jams,
            climbs=self.climbs,
            velocity=np.nan,
            gap=np.nan,
            touching=np.nan,
            pressure=np.full(self.returned.shape[1] - 1, np.nan),
            depth_in_track=np.nan,
            depth_in_part=np.nan,
            partial=partial,
            overlaps=self.overlaps,
        )


def follow_long(
    row: FedRow,
    plan: LongPlan,
    agreed_jams: float,
    run: RunSettings,
    tell: Callable[[str], None] | None = None,
) -> tuple[FilledQueue, ...]:
    """Follow every fill by a plan, and return what its runs counted together.

    A fill ends before its plan does where its jams alone show (``REFUSED_CONFIDENCE``) that they are more
    than was agreed. The outcome is the same for any number of ``run.jobs``, and of runs that were kept.

    Parameters
    ----------
    row : FedRow
    plan : LongPlan
    agreed_jams : float [1/s]
        That the buyer tolerates.
    run : RunSettings
        Its progress is told how many runs are done, of how many.
    tell : callable, optional
        Told a sentence: how many runs there are, and how many were kept.

    Returns
    -------
    tuple of FilledQueue
        In the order of ``FillLevel``; marked as partial, or fewer, where the user stopped it.

    Raises
    ------
    KeyboardInterrupt
        If the user stops it before any run was done.
    FeederError
        If a process ends over a run, for lack of memory perhaps.
    """
    runs = {
        fill: [Run(fill, _seed(run.seed, number), plan.seconds) for number in range(plan.runs)]
        for fill in FILLS
    }
    keys = {each: run_key(row, each) for own in runs.values() for each in own}
    counts = {each: made for each, key in keys.items() if (made := _kept(row, each, key)) is not None}

    def missing() -> Iterator[Run]:
        for number in range(plan.runs):  # the fills in turn: the fullest first
            for fill in FILLS:
                each = runs[fill][number]
                if each not in counts and not _decisive(runs[fill], counts, agreed_jams)[1]:
                    yield each

    if tell:
        again = f", {len(counts)} of them kept from an earlier proof" if counts else ""
        tell(f"long proof: {len(keys)} runs of {plan.seconds / units.MINUTE:.3g} min, at each fill{again}")
    run.tell(len(counts), len(keys))
    is_stopped = False
    try:
        with contextlib.closing(_follow_all(row, missing(), run.jobs)) as followed:
            for each, made in followed:
                simulation_cache.write(keys[each], made.to_arrays())
                counts[each] = made
                run.tell(len(counts), len(keys))
    except KeyboardInterrupt:
        is_stopped = True
        if not counts:
            raise
    filled = []
    for fill in FillLevel:
        used, is_over = _decisive(runs[fill], counts, agreed_jams)
        if used:
            total = functools.reduce(RunCounts.__add__, used)
            filled.append(row.count(fill, total.outcome(fill.parts, partial=is_stopped and not is_over)))
    return tuple(filled)


def _decisive(
    runs: Sequence[Run], counts: Mapping[Run, RunCounts], agreed_jams: float
) -> tuple[list[RunCounts], bool]:
    """The counts of a fill's runs in their order, as far as they decide it, and whether it is over."""
    used: list[RunCounts] = []
    for each in runs:
        if each not in counts:
            return used, False
        used.append(counts[each])
        jams, seconds = sum(made.jams for made in used), sum(made.seconds for made in used)
        if evidence.rate_at_least(jams, seconds, REFUSED_CONFIDENCE) > agreed_jams:
            break
    return used, True


# --- Runs that are kept ---


def _seed(seed: int, number: int) -> int:
    """The seed of a run: no two runs of a proof have the same."""
    return int(np.random.SeedSequence((seed, number)).generate_state(1)[0])


def run_key(row: FedRow, run: Run) -> dict[str, str]:
    """Return all that decides a run, under which it is kept.

    Parameters
    ----------
    row : FedRow
    run : Run

    Returns
    -------
    dict of str
    """
    bowl, digest = row.bowl, hashlib.sha256()
    for shares in (row.shares, row.shares if row.touching is None else row.touching):
        digest.update(np.ascontiguousarray(shares, float).tobytes())
    names = [orientation.name for orientation in (*row.orientations.lying, *row.orientations.states)]
    settings = (
        bowl.drive,
        bowl.friction,
        bowl.track,
        bowl.restitution,
        bowl.gravity,
        bowl.devices,
        names,
        digest.hexdigest(),
        row.states,
        row.any_heading,
        run,
        run.fill.gaps,
        run.fill.parts,
    )
    return simulation_cache.part_key(row.part, row.aspects, KIND, settings)


def _kept(row: FedRow, run: Run, key: Mapping[str, str]) -> RunCounts | None:
    """The counts of a run that was kept; None where there is none, or its file is not of such a run."""
    arrays = simulation_cache.read(key)
    with contextlib.suppress(ValueError):
        return None if arrays is None else RunCounts.from_arrays(arrays, row, run)
    return None


# --- Runs on several cores ---


def _follow_all(row: FedRow, runs: Iterable[Run], jobs: int) -> Generator[tuple[Run, RunCounts], None, None]:
    """Yield each run with its counts as it is done; a run is taken only when a process is free for it."""
    if jobs < 2:
        for each in runs:
            yield each, _follow(row, each)
        return
    job = functools.partial(_follow_beside, row)
    try:
        yield from processes.work_on(runs, lambda: _begin_process(job), jobs)
    except processes.ProcessEnded as ended:
        what = f"a process ended over a run at {ended.task.fill} fill, perhaps for lack of memory"
        mend = "start the same design again, with fewer --jobs: the runs that are done are kept"
        raise FeederError("long proof", what, mend) from None


def _begin_process(job: Callable[[Run], RunCounts]) -> processes.Process:
    """A process for runs. A forked one needs no guard in the caller's script; with threads none is forked."""
    if processes.can_fork():
        return processes.forked_process(job)
    return processes.Process(processes.server_context([__name__]), job)


def _follow(row: FedRow, run: Run, tell: Callable[[int, int], None] | None = None) -> RunCounts:
    """Follow one run."""
    queue = row.queue(run.fill, run.seconds, run.seed)
    queue.follow(run.seconds, tell)
    return RunCounts.of(queue.result())


def _follow_beside(row: FedRow, run: Run) -> RunCounts:
    """Follow one run in a process that ends with the one that began it, in mid run too."""
    parent = os.getppid()

    def end_with_parent(*_: int) -> None:
        if os.getppid() != parent:
            sys.exit(1)

    return _follow(row, run, end_with_parent)
