"""Batches of drops on several cores, of which an interrupt keeps what is done."""

from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from itertools import takewhile
from typing import Any

import numpy as np

from feederscrew.base.arrays import Array


def gather(work: Callable[[Callable[..., Future]], None], jobs: int) -> tuple[list[Any], bool]:
    """Return the results of batches, in order, and whether an interrupt from the keyboard cut them short.

    Parameters
    ----------
    work : callable
        Called with ``begin(function, *arguments)``, which queues a batch and gives its task. It queues them
        in order, and returns once all it wants are done.
    jobs : int
        Threads; compiled batches run beside each other.

    Returns
    -------
    list
        After an interrupt the results up to the first batch that was not finished.
    bool

    Raises
    ------
    KeyboardInterrupt
        If no batch was finished.
    """
    tasks: list[Future] = []
    partial, pool = False, ThreadPoolExecutor(jobs)

    def begin(function: Callable[..., Any], *arguments: Any) -> Future:
        tasks.append(pool.submit(function, *arguments))
        return tasks[-1]

    try:
        work(begin)
    except KeyboardInterrupt:
        pool.shutdown(cancel_futures=True)  # a thread cannot be stopped: this waits for running batches
        partial = True
        tasks = list(
            takewhile(lambda task: task.done() and not task.cancelled() and not task.exception(), tasks)
        )
        if not tasks:
            raise
    finally:
        pool.shutdown(cancel_futures=True)
    ended = takewhile(lambda task: not task.cancelled(), tasks)  # work may end before all it has begun
    return [task.result() for task in ended], partial


def in_batches(
    batch: Callable[[slice], Any],
    count: int,
    size: int,
    jobs: int,
    progress: Callable[[int], None] | None = None,
) -> tuple[list[Array], bool]:
    """Return what a function makes of many items, a batch of them at a time.

    Parameters
    ----------
    batch : callable
        Called with a slice of the items; gives arrays with a row for each.
    count : int
        Items, N.
    size : int
        Items a batch.
    jobs : int
        Threads.
    progress : callable, optional
        Called after every batch with how many items are done.

    Returns
    -------
    list of array
        N rows each; fewer after an interrupt, as in ``gather``.
    bool
        Whether an interrupt cut them short.

    Raises
    ------
    KeyboardInterrupt
        If no batch was finished.
    """

    def work(begin: Callable[..., Future]) -> None:
        cuts = [slice(first, min(first + size, count)) for first in range(0, count, size)]
        for cut, task in [(cut, begin(batch, cut)) for cut in cuts]:
            task.result()
            if progress:
                progress(cut.stop)

    results, partial = gather(work, jobs)
    return [np.concatenate(column) for column in zip(*results)], partial
