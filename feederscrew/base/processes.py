"""Processes that work beside this one, each with a line to it: those of a batch, and the one that draws.

`concurrent.futures` is not taken. There one process that dies takes all tasks at work with it and names no
culprit. Processes that are replaced after some tasks may hang (Python 3.11 to 3.13). Those of a program that
is killed stay behind.
"""

import contextlib
import gc
import multiprocessing
import signal
from collections.abc import Callable, Sequence
from multiprocessing import forkserver, resource_tracker
from typing import Any


class ProcessEnded(Exception):
    """A process that ended before its task was done."""


class Process:
    """A process that does one task at a time by a function, and ends with the process that started it.

    Ctrl-C does not reach it: whoever started it decides when to ``stop``.

    Parameters
    ----------
    context : multiprocessing context
        How it is started. Forked, it has ``job`` and all that this process knows; else both are handed on.
    job : callable
        Takes a task, and returns what becomes of it.
    """

    def __init__(self, context: Any, job: Callable[[Any], Any]) -> None:
        self.line, theirs = context.Pipe()
        is_forked = context.get_start_method() == "fork"  # it has our end of the line then: none would break
        self._process = context.Process(
            target=_serve, args=(theirs, job, self.line if is_forked else None), daemon=True
        )
        self._process.start()
        theirs.close()  # so that the line breaks when the process does

    def give(self, task: Any) -> None:
        """Send a task to the process; it is not waited for.

        Parameters
        ----------
        task : object
            What can be sent between processes. Whether the process has ended shows when its result is taken.
        """
        with contextlib.suppress(OSError):
            self.line.send(task)

    def take(self) -> Any:
        """Return the outcome of the task, once it is done.

        Returns
        -------
        object
            As the job returned it.

        Raises
        ------
        ProcessEnded
            If the process ended over it.
        """
        try:
            return self.line.recv()
        except (EOFError, OSError):
            raise ProcessEnded from None

    def stop(self) -> None:
        """End the process, whatever it does."""
        self._process.kill()
        self._process.join()
        self.line.close()


def server_context(preload: Sequence[str]) -> Any:
    """Return the context whose processes are forked from one that imports some modules, once.

    Parameters
    ----------
    preload : sequence of str
        Names of the modules.

    Returns
    -------
    multiprocessing context
        Where the system cannot fork, each process begins anew.
    """
    methods = multiprocessing.get_all_start_methods()
    context = multiprocessing.get_context("forkserver" if "forkserver" in methods else "spawn")
    context.set_forkserver_preload([*preload])
    if context.get_start_method() == "forkserver":  # deaf to Ctrl-C, as what it forks
        resource_tracker.ensure_running()  # it would let the signal through again
        before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
        try:
            forkserver.ensure_running()
        finally:
            signal.pthread_sigmask(signal.SIG_SETMASK, before)
    return context


def _serve(line: Any, job: Callable[[Any], Any], other_end: Any) -> None:
    """Do tasks until the other end of the line is gone."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    for name in (
        "SIGTERM",
        "SIGHUP",
    ):  # a handler of the other process would raise an interrupt; Windows has one
        if hasattr(signal, name):
            signal.signal(getattr(signal, name), signal.SIG_DFL)
    if other_end is not None:
        other_end.close()
    gc.freeze()  # what was there before the fork stays shared, and is not searched after every task
    gc.enable()
    with contextlib.suppress(EOFError, OSError):
        while True:
            line.send(job(line.recv()))
