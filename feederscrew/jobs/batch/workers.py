"""Parts on processes of this machine, or on a Dask cluster: one that dies costs a retry, never the batch."""

import contextlib
import importlib
import logging
import os
import re
import time
from collections.abc import Callable, Generator, Iterable, Iterator
from concurrent.futures import CancelledError
from itertools import islice
from multiprocessing.connection import wait
from typing import Any

from feederscrew import __version__
from feederscrew.base.errors import ArgumentError, FeederError, MissingPackage
from feederscrew.base.processes import Process, ProcessEnded, server_context
from feederscrew.base.units import quantity_text
from feederscrew.jobs.batch.task import Outcome, Task, libraries

ATTEMPTS = 3  # of a part whose worker dies under it
LIFETIME = 200  # parts of one process: what libraries leak goes with it
WORK = "feederscrew.jobs.batch.work"  # its libraries take a second to import, which only the processes need


def work(task: Task) -> Outcome:
    """Compute everything that is asked of one part, an Outcome: as ``feederscrew.jobs.batch.work`` has it."""
    return importlib.import_module(WORK).work(task)


class Processes:
    """A crew of ``jobs`` processes at a time, each of which is replaced after ``lifetime`` parts.

    ``job`` is a function from a Task to an Outcome, importable by name.
    """

    def __init__(self, jobs: int, job: Callable[[Task], Outcome] = work, lifetime: int = LIFETIME) -> None:
        self.jobs, self.job, self.lifetime = jobs, job, lifetime
        self.context = server_context(["feederscrew.jobs.batch.preload", job.__module__])

    def outcomes(self, tasks: Iterable[Task]) -> Generator[Outcome, None, None]:
        """Yield the outcome of each task as it comes; a task is taken only when a process is free for it."""
        retries: list[Task] = []
        crew: list[_Worker] = []
        tasks, failures = iter(tasks), []
        try:
            while self._busy(crew, tasks, retries):
                lines = {worker.process.line: worker for worker in crew if worker.task is not None}
                for worker in [lines[line] for line in wait(list(lines))]:
                    task, outcome = worker.take()
                    if outcome is None:
                        failures.append(name := task.request.name)
                        if failures.count(name) < ATTEMPTS:
                            retries.append(task)
                            continue
                        lost = f"its process ended {ATTEMPTS} times before it was done"
                        reason = f"{lost}, perhaps for lack of memory - try it alone"
                        outcome = Outcome.failed(task, reason, final=False)
                    self._busy(crew, tasks, retries)  # at work while the outcome is put in place
                    yield outcome
        finally:
            for worker in crew:
                worker.process.stop()

    def _busy(self, crew: list["_Worker"], tasks: Iterator[Task], retries: list[Task]) -> list["_Worker"]:
        """Give every process work, as long as there is any; return those at work."""
        for worker in [w for w in crew if w.task is None and (w.dead or w.served >= self.lifetime)]:
            worker.process.stop()
            crew.remove(worker)
        while len(idle := [w for w in crew if w.task is None]) or len(crew) < self.jobs:
            task = retries.pop() if retries else next(tasks, None)
            if task is None:
                break
            worker = idle[0] if idle else _Worker(self.context, self.job)
            if not idle:
                crew.append(worker)
            worker.give(task)
        return [w for w in crew if w.task is not None]


class _Worker:
    """One process, the task it is at, and how many it has had."""

    def __init__(self, context: Any, job: Callable[[Task], Outcome]) -> None:
        self.process = Process(context, job)
        self.task: Task | None = None
        self.served, self.dead = 0, False

    def give(self, task: Task) -> None:
        self.task, self.served = task, self.served + 1
        self.process.give(task)

    def take(self) -> tuple[Any, ...]:
        """Return the task and its outcome; None for a worker that died over it."""
        task, self.task = self.task, None
        try:
            return task, self.process.take()
        except ProcessEnded:
            self.dead = True
            return task, None


def processors() -> int:
    """Return how many this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


CLUSTER_TIMEOUT_S = 20  # [s] for a scheduler to answer and for a first worker
TASKS_PER_THREAD = 2  # tasks sent for each thread of the cluster, so that none waits
POLL = 0.05  # [s] between looks at what has come
AT_WORK = ("pending", "lost")  # what a worker had done that died is done again by another
ADDRESS = re.compile(r"((tcp|tls|ucx|wss?)://)?[^\s/]+:\d+/?")


class Cluster:
    """The workers of a Dask scheduler at an address, 'tcp://host:8786'.

    ``job`` is a function from a Task to an Outcome, which they import from the same version of this program.
    """

    def __init__(self, address: str, job: Callable[[Task], Outcome] = work) -> None:
        self.address, self.job = address, job

    def outcomes(self, tasks: Iterable[Task]) -> Generator[Outcome, None, None]:
        """Yield the outcome of each task, as they come; only few tasks are sent at a time.

        Raises FeederError if there is no scheduler, it is lost, or its workers are of another version.
        """
        distributed = _distributed()
        if not ADDRESS.fullmatch(self.address):
            what = f"{quantity_text(self.address)} is not an address of a scheduler"
            raise ArgumentError("scheduler", what, "write it as tcp://host:8786")
        logging.getLogger("distributed").setLevel(logging.CRITICAL)  # we tell what is lost, in one line
        try:
            client = distributed.Client(self.address, timeout=CLUSTER_TIMEOUT_S, set_as_default=False)
        except (OSError, ValueError) as error:
            raise self._fault(f"no scheduler answers ({_first_line(error)})") from None
        try:
            self._check_workers(client)
            yield from self._gathered(client, iter(tasks))
        finally:
            client.close(timeout=1)

    def _check_workers(self, client: Any) -> None:
        """Check that every worker has this very program and libraries, or its bytes would not be ours."""
        try:
            client.wait_for_workers(1, timeout=CLUSTER_TIMEOUT_S)
            run = client.run(_versions)
        except OSError as error:
            raise self._fault(f"no worker answers ({_first_line(error)})") from None
        except ImportError as error:
            raise self._fault(f"a worker cannot import this program ({_first_line(error)})") from None
        for worker, versions in run.items():
            odd = [name for name, version in _versions().items() if versions.get(name) != version]
            if odd:
                raise self._fault(f"{worker} has another version of {', '.join(odd)}")

    def _gathered(self, client: Any, tasks: Iterator[Task]) -> Iterator[Outcome]:
        running: dict[Any, Task] = {}  # by its future
        while True:
            with self._attended():
                room = max(1, TASKS_PER_THREAD * sum(client.nthreads().values())) - len(running)
            for task in islice(tasks, max(room, 0)):
                with self._attended():
                    running[client.submit(self.job, task, pure=False)] = task
            if not running:
                return
            ready: list[Any] = []
            while not ready:
                if client.status != "running" or any(future.cancelled() for future in running):
                    raise self._fault("the scheduler is lost")
                ready = [future for future in running if future.done()]
                if not ready:
                    time.sleep(POLL)
            for future in ready:
                if future.status not in AT_WORK:  # not lost with its worker while another was put in place
                    yield self._outcome(future, running.pop(future))

    def _outcome(self, future: Any, task: Task) -> Outcome:
        """Return what came of a task; the cluster itself has tried again where a worker died."""
        if future.status == "finished":
            with self._attended():
                return future.result()
        if future.status == "cancelled":
            raise self._fault("the scheduler is lost")
        return Outcome.failed(task, f"{_first_line(future.exception())} - try it alone", final=False)

    @contextlib.contextmanager
    def _attended(self) -> Iterator[None]:
        """Turn what a client raises when its scheduler is lost into a FeederError."""
        try:
            yield
        except (OSError, CancelledError, _distributed().client.ClosedClientError):
            raise self._fault("the scheduler is lost") from None

    def _fault(self, what: str) -> FeederError:
        mend = "mend it, then start this command again with `resume`: what is finished is kept"
        return FeederError(self.address, what, mend)


def _distributed() -> Any:
    try:
        import distributed
    except ImportError:
        mend = "pip install 'feederscrew[dist]'"
        raise MissingPackage("scheduler", "needs the package 'distributed'", mend) from None
    return distributed


def _versions() -> dict[str, str]:
    return {"feederscrew": __version__, **libraries()}


def _first_line(error: BaseException) -> str:
    return (str(error).strip().splitlines() or [type(error).__name__])[0][:200]
