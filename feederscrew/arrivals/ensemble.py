"""Many drops of one part: run on several cores, counted by face, with intervals.

Source: docs/resting.md, "The drop test".
"""

from collections.abc import Callable, Mapping
from concurrent.futures import Future
from dataclasses import dataclass
from typing import Any

import numpy as np

from feederscrew.arrivals.kernel import falling, one_drop
from feederscrew.arrivals.launch_conditions import Launch, Starts, sample
from feederscrew.arrivals.pool import gather
from feederscrew.arrivals.rounded_hull import Shape
from feederscrew.base import check
from feederscrew.base.arrays import Array, Floats, Ints
from feederscrew.base.records import ReadableRecord
from feederscrew.resting.rules.recommended import Recommended, widen_for_launch

DROPS_A_BATCH = 250  # drops a core takes at a time
DROPS_A_LOOK = 8 * DROPS_A_BATCH  # drops between two looks at the intervals, whatever the number of jobs
MAX_DROPS_UNTIL_WIDTH = 1_000_000  # drops at which ``until`` gives up
NORMAL_95 = 1.959963984540054  # two-sided 95 % point
RESTITUTION_GROUPS = 4  # of drops, by restitution
# [1] What steps and tolerances may move a share of a half: 0.009 seen, docs/resting.md.
NUMERICAL_SHARE_ERROR = 0.01


@dataclass(frozen=True, eq=False)
class Drops:
    """Outcomes of N drops, in the order of their seeds."""

    faces: Ints  # (N,) face each rests on, UNSETTLED for none
    times: Floats  # (N,) in units of sqrt(L / g)
    energies: Floats  # (N,) of the launch, in units of m g L
    restitutions: Floats  # (N,)
    partial: bool  # stopped by the user before all were done


def drops_of(arrays: Mapping[str, Array], most: int) -> Drops:
    """Return the drops of a finished run from the fields of ``Drops`` as plain arrays.

    Parameters
    ----------
    arrays : mapping of str to array
    most : int
        Drops that were asked for.

    Returns
    -------
    Drops

    Raises
    ------
    ValueError
        If a number or a shape cannot be of a drop.
    KeyError
        If a field is missing.
    """
    faces = check.ranged("faces", arrays["faces"], (-1,), one_drop.UNSETTLED, np.inf, whole=True)
    if not 1 <= len(faces) <= most:
        raise ValueError(f"{len(faces)} drops of {most}")
    size = (len(faces),)
    times, energies = (check.ranged(name, arrays[name], size, 0.0) for name in ("times", "energies"))
    restitutions = check.ranged("restitutions", arrays["restitutions"], size, 0.0, 1.0)
    return Drops(faces, times, energies, restitutions, partial=False)


@dataclass(frozen=True, eq=False)
class Tally(ReadableRecord):
    """Drops counted by class; A classes."""

    counts: Ints  # (A,) int
    unsettled: int
    unsettled_share: float  # [1] of all drops
    p: Floats  # (A,) [1] of the drops that settled; NaN where none did
    low: Floats  # (A,) [1] ends of the 95 % interval: sampling, steps, and what a launch leaves open
    high: Floats
    widest: float  # [1] half the longest of Wilson's intervals: the sampling alone
    gentle: Floats  # (A,) [1] among the third of the drops launched with the least energy
    violent: Floats  # (A,) [1] ... with the most
    restitution: Floats  # (A,) [1] half the 95 % interval that the spread of restitution makes by itself

    def answer(self, launch: str) -> Recommended:
        """Return the answer of the drop test for its launch.

        Parameters
        ----------
        launch : str
            A key of ``launch_conditions.PRESETS``.

        Returns
        -------
        Recommended
        """
        return Recommended(f"drop test, launch {launch}", launch, self.p, self.low, self.high)


@dataclass(frozen=True, eq=False)
class Aim:
    """Width that the 95 % intervals of all classes shall come below."""

    width: float  # [1] to either side
    rows: Ints  # (F,) class of each face
    count: int  # classes

    def widest(self, faces: Ints) -> float:
        """Return half the longest interval after drops.

        Parameters
        ----------
        faces : (N,) int
            On which they came to lie.

        Returns
        -------
        float [1]
        """
        counts = _count_classes(faces, self.rows, self.count)
        low, high = wilson(counts, counts.sum())
        return float(0.5 * (high - low).max())

    def needed(self, done: int, widest: float) -> int:
        """Return how many drops it takes: intervals narrow with 1 / sqrt(N).

        Parameters
        ----------
        done : int
            So far.
        widest : float [1]
            Half the longest interval after these.

        Returns
        -------
        int
            ``done`` where that is enough, else an estimate.
        """
        excess = (widest / self.width) ** 2
        return done if excess <= 1.0 else DROPS_A_LOOK * int(np.ceil(excess * done / DROPS_A_LOOK))


def drop(
    shape: Shape,
    launch: Launch,
    rng: np.random.Generator,
    *,
    count: int | None = None,
    aim: Aim | None = None,
    jobs: int = 1,
    steps: falling.Steps | None = None,
    progress: Callable[[int, int, float | None], None] | None = None,
) -> Drops:
    """Drop a part again and again.

    Drop n gets the n-th set of numbers of ``rng``: the outcome does not depend on ``jobs``. The aim is looked
    at after every ``DROPS_A_LOOK`` drops; once it is reached the run ends. After an interrupt from the
    keyboard come the batches that were finished, noted as ``partial``: a run of so many drops gives the same.

    Parameters
    ----------
    shape : Shape
    launch : Launch
    rng : Generator
    count : int, optional
        How many drops, above 0; with ``aim``, at most so many. None takes ``MAX_DROPS_UNTIL_WIDTH``.
    aim : Aim, optional
        How narrow the intervals shall become.
    jobs : int
        Threads.
    steps : Steps, optional
        None takes the usual ones.
    progress : callable, optional
        Called after every batch with how many drops are done, about how many there will be, and half the
        longest interval so far: None without an ``aim`` and in its first round.

    Returns
    -------
    Drops

    Raises
    ------
    KeyboardInterrupt
        If no batch was finished.
    """
    precise, most = steps or falling.Steps(), MAX_DROPS_UNTIL_WIDTH if count is None else int(count)

    def batch(starts: Starts, part: slice) -> tuple[Array, ...]:
        energies = starts.energies[part]
        faces, times = np.full(len(energies), one_drop.UNSETTLED), np.zeros(len(energies))
        one_drop.settle_all(shape, falling.scratch(shape), starts.launched(part), precise, faces, times)
        return faces, times, energies, starts.restitutions[part]

    def work(begin: Callable[..., Future]) -> None:
        """Begin round after round and wait for its batches, until there are enough."""
        tasks: list[Future] = []
        done, total, widest = 0, min(most, DROPS_A_LOOK) if aim else most, None
        while done < total:
            starts = sample(launch, shape, min(DROPS_A_LOOK, most - done), rng)
            firsts = range(0, len(starts.energies), DROPS_A_BATCH)
            fresh = [begin(batch, starts, slice(first, first + DROPS_A_BATCH)) for first in firsts]
            for task in fresh:
                done += len(task.result()[0])
                if progress:
                    progress(done, total, widest)
            tasks += fresh
            if aim:
                widest = aim.widest(np.concatenate([task.result()[0] for task in tasks]))
                total = min(aim.needed(done, widest), most)
                if progress:
                    progress(done, total, widest)

    results, interrupted = gather(work, jobs)
    faces, times, energies, restitutions = (check.frozen(np.concatenate(column)) for column in zip(*results))
    return Drops(faces, times, energies, restitutions, interrupted)


def tally(drops: Drops, rows: Ints, count: int, *, surface: bool = False) -> Tally:
    """Return the drops counted by class, with intervals.

    The interval holds the sampling (``wilson``), the numerical error ``NUMERICAL_SHARE_ERROR`` and what a
    launch's name leaves open. Restitution spreads from drop to drop; what that does by itself follows from
    the variance between groups of like restitution, less that of sampling.

    Parameters
    ----------
    drops : Drops
    rows : (F,) int
        Class of each face.
    count : int
        Classes, A.
    surface : bool
        Restitution is the user's own, so what its spread does is added to the interval. That of a launch's
        name has it already, in what the name leaves open.

    Returns
    -------
    Tally
    """
    total, counts = len(drops.faces), _count_classes(drops.faces, rows, count)
    settled = int(counts.sum())
    low, high = wilson(counts, settled)
    order, third = np.argsort(drops.energies, kind="stable"), max(total // 3, 1)
    gentle, violent = (
        check.frozen(np.nan_to_num(_shares(_count_classes(drops.faces[part], rows, count))))
        for part in (order[:third], order[-third:])
    )
    p = _shares(counts)
    # Half the 95 % interval of a share that restitution makes: in groups of like values the shares differ by
    # more than samples of one share do.
    values, restitution = drops.restitutions, np.zeros(count)
    groups = np.array_split(np.argsort(values, kind="stable"), RESTITUTION_GROUPS)
    grouped = np.array([_count_classes(drops.faces[group], rows, count) for group in groups])
    sizes = grouped.sum(axis=1, keepdims=True)
    if sizes.all() and np.ptp(values) != 0.0:
        mean = grouped.sum(axis=0) / sizes.sum()
        sampled = (1.0 - 1.0 / RESTITUTION_GROUPS) * mean * (1.0 - mean) * (1.0 / sizes).mean()
        excess = ((grouped / sizes - mean) ** 2).mean(axis=0) - sampled
        restitution = NORMAL_95 * np.sqrt(np.maximum(excess, 0.0))
    interval = low, high
    if settled:
        # Numerical error and restitution are independent of the sampling.
        numerical = 4.0 * NUMERICAL_SHARE_ERROR * p * (1.0 - p)
        moved = restitution if surface else 0.0
        ends = [
            np.clip(p + sign * np.hypot(np.hypot(end - p, numerical), moved), 0.0, 1.0)
            for sign, end in ((-1.0, low), (1.0, high))
        ]
        interval = widen_for_launch(p, ends[0], ends[1], np.bincount(rows, minlength=count) > 0)
    return Tally(
        counts=check.frozen(counts),
        unsettled=total - settled,
        unsettled_share=(total - settled) / max(total, 1),
        p=check.frozen(p),
        low=check.frozen(interval[0]),
        high=check.frozen(interval[1]),
        widest=float(0.5 * (high - low).max()),
        gentle=gentle,
        violent=violent,
        restitution=check.frozen(restitution),
    )


def _count_classes(faces: Ints, rows: Ints, count: int) -> Ints:
    """Return the number of drops of each class (A,) [1], from the faces (N,) they rest on."""
    return np.bincount(rows[faces[faces != one_drop.UNSETTLED]], minlength=count)


def _shares(counts: Ints) -> Floats:
    """Return the shares (A,) [1] of counts (A,); NaN where all are zero."""
    total = counts.sum()
    return counts / total if total else np.full(len(counts), np.nan)


def wilson(counts: Any, total: float) -> tuple[Floats, Floats]:
    """Return the ends of the 95 % interval of a share.

        (p + z^2 / (2 n) -+ z sqrt(p (1 - p) / n + z^2 / (4 n^2))) / (1 + z^2 / n)

    at the share p = counts / n and z = ``NORMAL_95``. The ends hold p, and differ where a count is 0 or n.

    Parameters
    ----------
    counts : (A,) float [1]
    total : float [1]
        n, of which the counts are; 0 gives the whole range.

    Returns
    -------
    (A,) float [1]
        Lower ends.
    (A,) float [1]
        Upper ends.

    References
    ----------
    E. B. Wilson, "Probable inference, the law of succession, and statistical inference", J. Amer. Statist.
    Assoc. 22, 209-212, 1927.
    """
    if not total:
        return np.zeros(len(counts)), np.ones(len(counts))
    p, spread = np.asarray(counts) / total, NORMAL_95**2 / total
    middle = (p + 0.5 * spread) / (1.0 + spread)
    half = np.sqrt(spread * p * (1.0 - p) + 0.25 * spread**2) / (1.0 + spread)
    return np.minimum(np.maximum(middle - half, 0.0), p), np.maximum(np.minimum(middle + half, 1.0), p)
