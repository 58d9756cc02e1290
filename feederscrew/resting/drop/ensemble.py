"""Many drops of one part: run on several cores, counted by face, with intervals."""

from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np

from feederscrew import check
from feederscrew.resting.drop import kernel
from feederscrew.resting.drop.launch import sample

BATCH = 250  # drops a core takes at a time
ROUND = 8 * BATCH  # drops between two looks at the intervals, whatever the number of jobs
MOST = 1_000_000  # drops at which ``until`` gives up
NORMAL = 1.959963984540054  # two-sided 95 % point


@dataclass(frozen=True, eq=False)
class Drops:
    """What became of N drops, in the order of their seeds."""

    faces: np.ndarray  # (N,) face each rests on, UNSETTLED for none
    times: np.ndarray  # (N,) in units of sqrt(L / g)
    energies: np.ndarray  # (N,) of the launch, in units of m g L
    partial: bool  # stopped by the user before all were done


@dataclass(frozen=True, eq=False)
class Tally:
    """Drops counted by class; A classes."""

    counts: np.ndarray  # (A,) int
    unsettled: int
    p: np.ndarray  # (A,) [1] of all drops, the unsettled ones too
    low: np.ndarray  # (A,) [1] ends of the 95 % Wilson interval
    high: np.ndarray
    gentle: np.ndarray  # (A,) [1] among the third of the drops launched with the least energy
    violent: np.ndarray  # (A,) [1] ... with the most


def drop(shape, launch, rng, *, count=None, narrow=None, jobs=1, steps=None, progress=None):
    """Drop a part again and again.

    Parameters
    ----------
    shape : Shape
    launch : Launch
    rng : numpy.random.Generator
        Drop n gets the n-th set of numbers: the outcome does not depend on ``jobs``.
    count : int, optional
        How many drops, above 0; with ``narrow``, at most so many.
    narrow : function, optional
        Told the (N,) faces so far after every ROUND drops; true ends the run.
    jobs : int
        Cores to use.
    steps : kernel.Steps, optional
    progress : function, optional
        Told how many drops are done and how many there will be.

    Returns
    -------
    Drops
        An interrupt from the keyboard after the first round ends the run and is noted as ``partial``.
    """
    steps, count = steps or kernel.Steps(), MOST if count is None else int(count)
    done, partial = [], False
    with ThreadPoolExecutor(jobs) as pool:
        try:
            for first in range(0, count, ROUND):
                starts = sample(launch, shape, min(ROUND, count - first), rng)
                done.append((*_round(pool, shape, starts, steps), starts.energies))
                if progress:
                    progress(first + len(starts.energies), count)
                if narrow and narrow(np.concatenate([faces for faces, *_ in done])):
                    break
        except KeyboardInterrupt:
            if not done:
                raise
            partial = True
    return Drops(*(check.frozen(np.concatenate(each)) for each in zip(*done)), partial)


def tally(drops, rows, count):
    """Count drops by class.

    Parameters
    ----------
    drops : Drops
    rows : (F,) int
        Class of each face.
    count : int
        Classes.

    Returns
    -------
    Tally
    """
    total = len(drops.faces)
    counts = counted(drops.faces, rows, count)
    low, high = wilson(counts, total)
    order, third = np.argsort(drops.energies, kind="stable"), max(total // 3, 1)
    ends = [counted(drops.faces[part], rows, count) / third for part in (order[:third], order[-third:])]
    return Tally(
        counts=check.frozen(counts),
        unsettled=int(total - counts.sum()),
        p=check.frozen(counts / total),
        low=check.frozen(low),
        high=check.frozen(high),
        gentle=check.frozen(ends[0]),
        violent=check.frozen(ends[1]),
    )


def counted(faces, rows, count):
    """(A,) drops by class, from the (N,) faces they rest on."""
    return np.bincount(rows[faces[faces != kernel.UNSETTLED]], minlength=count)


def wilson(counts, total):
    """Ends of the 95 % interval of a share, from counts.

    Parameters
    ----------
    counts : (A,) int
    total : int

    Returns
    -------
    low, high : (A,) float [1]
        They hold counts / total, and are not empty where a count is 0 or ``total``.

    References
    ----------
    E. B. Wilson, "Probable inference, the law of succession, and statistical inference", J. Amer.
    Statist. Assoc. 22, 209-212, 1927.
    """
    p, spread = np.asarray(counts) / total, NORMAL**2 / total
    middle = (p + 0.5 * spread) / (1.0 + spread)
    half = np.sqrt(spread * p * (1.0 - p) + 0.25 * spread**2) / (1.0 + spread)
    return np.minimum(np.maximum(middle - half, 0.0), p), np.maximum(np.minimum(middle + half, 1.0), p)


def narrow_to(width, rows, count):
    """Test for ``drop``: every class's 95 % interval is at most ``width`` [1] wide on either side."""

    def narrow(faces):
        low, high = wilson(counted(faces, rows, count), len(faces))
        return bool((high - low <= 2.0 * width).all())

    return narrow


def _round(pool, shape, starts, steps):
    """Faces and times of one round, its batches spread over the pool."""
    count = len(starts.energies)
    faces, times = np.full(count, kernel.UNSETTLED), np.zeros(count)

    def batch(first):
        part = slice(first, first + BATCH)
        kernel.settle_all(
            shape, kernel.scratch(shape), starts.states[part], starts.restitutions[part],
            starts.frictions[part], steps, faces[part], times[part],
        )  # fmt: skip

    list(pool.map(batch, range(0, count, BATCH)))
    return faces, times
