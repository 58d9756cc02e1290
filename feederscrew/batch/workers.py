"""Parts on several processes of this machine: one that dies costs a retry, never the batch."""

import contextlib
import gc
import importlib
import multiprocessing
import os
import signal
from multiprocessing import forkserver, resource_tracker
from multiprocessing.connection import wait

from feederscrew.batch.task import Outcome, Task

ATTEMPTS = 3  # of a part whose worker dies under it
LIFETIME = 200  # parts of one process: what libraries leak goes with it
PRELOAD = "feederscrew.batch.preload"  # WORK, imported sooner
WORK = "feederscrew.batch.work"  # its libraries take a second to import, which only the processes need
WORKER_LOST_MESSAGE = (
    "its process ended {} times before it was done, perhaps for lack of memory - try it alone"
)


def work(task):
    """Compute everything that is asked of one part, an Outcome: as ``feederscrew.batch.work`` has it."""
    return importlib.import_module(WORK).work(task)


class Processes:
    """A crew of processes.

    Parameters
    ----------
    jobs : int
        How many work at a time.
    job : function
        From a Task to an Outcome; importable by name.
    lifetime : int
        Parts after which a process is replaced by a fresh one.
    """

    def __init__(self, jobs, job=work, lifetime=LIFETIME):
        self.jobs, self.job, self.lifetime = jobs, job, lifetime
        methods = multiprocessing.get_all_start_methods()
        self.context = multiprocessing.get_context("forkserver" if "forkserver" in methods else "spawn")
        self.context.set_forkserver_preload([PRELOAD, job.__module__])
        _start_server(self.context)

    def outcomes(self, tasks):
        """Yield the outcome of each task, as they come; a task is taken only when a process is free for it.

        Parameters
        ----------
        tasks : iterable of Task

        Yields
        ------
        Outcome
        """
        again: list[Task] = []
        crew: list[_Worker] = []
        tasks, failures = iter(tasks), []
        try:
            while self._busy(crew, tasks, again):
                for worker in _ready(crew):
                    task, outcome = worker.take()
                    if outcome is None:
                        failures.append(name := task.request.name)
                        if failures.count(name) < ATTEMPTS:
                            again.append(task)
                            continue
                        outcome = Outcome.failed(task, WORKER_LOST_MESSAGE.format(ATTEMPTS), final=False)
                    self._busy(crew, tasks, again)  # at work while the outcome is put in place
                    yield outcome
        finally:
            for worker in crew:
                worker.stop()

    def each(self, function, items):
        """Yield what a function gives for each of some items, from a process that has its libraries already.

        Parameters
        ----------
        function : function
            Of one item; importable by name.
        items : iterable

        Yields
        ------
        object
            In the order of the items; where the process dies they are computed in this one.
        """
        worker = _Worker(self.context, function)
        try:
            for item in items:
                worker.give(item)
                _, found = worker.take()
                yield function(item) if worker.dead else found
        finally:
            worker.stop()

    def _busy(self, crew, tasks, again):
        """Give every process work, as long as there is any; return those at work."""
        for worker in [w for w in crew if w.task is None and (w.dead or w.served >= self.lifetime)]:
            worker.stop()
            crew.remove(worker)
        while len(idle := [w for w in crew if w.task is None]) or len(crew) < self.jobs:
            task = again.pop() if again else next(tasks, None)
            if task is None:
                break
            worker = idle[0] if idle else _Worker(self.context, self.job)
            if not idle:
                crew.append(worker)
            worker.give(task)
        return [w for w in crew if w.task is not None]


def _start_server(context):
    """Start what forks the processes and imports for them; deaf to Ctrl-C: the batch decides when to stop."""
    if context.get_start_method() != "forkserver":
        return
    resource_tracker.ensure_running()  # it would let the signal through again
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        forkserver.ensure_running()
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


class _Worker:
    """One process, and the line to it."""

    def __init__(self, context, job):
        self.connection, theirs = context.Pipe()
        self.process = context.Process(target=_serve, args=(theirs, job), daemon=True)
        self.process.start()
        theirs.close()  # so that the line breaks when the process does
        self.task, self.served, self.dead = None, 0, False

    def give(self, task):
        self.task, self.served = task, self.served + 1
        with contextlib.suppress(OSError):  # it is dead: ``take`` finds out
            self.connection.send(task)

    def take(self):
        """Return the task and its outcome; None for a worker that died over it."""
        task, self.task = self.task, None
        try:
            return task, self.connection.recv()
        except (EOFError, OSError):
            self.dead = True
            return task, None

    def stop(self):
        self.connection.close()
        self.process.terminate()
        self.process.join()


def _ready(crew):
    lines = {worker.connection: worker for worker in crew if worker.task is not None}
    return [lines[line] for line in wait(list(lines))]


def _serve(connection, job):
    """Answer tasks until the other end of the line is gone."""
    gc.freeze()  # what was there before the fork stays shared, and is not searched after every part
    gc.enable()
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the batch itself decides when to stop
    with contextlib.suppress(EOFError, OSError):
        while True:
            connection.send(job(connection.recv()))


def processors():
    """Return how many this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1
