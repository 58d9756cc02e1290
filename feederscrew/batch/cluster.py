"""Parts on the workers of an existing Dask cluster: the same work, the same bytes."""

import contextlib
import logging
import re
import time
from concurrent.futures import CancelledError
from itertools import islice
from typing import Any

from feederscrew import __version__
from feederscrew.batch.task import Outcome, Task, libraries
from feederscrew.batch.workers import work
from feederscrew.errors import ArgumentError, FeederError, MissingPackage
from feederscrew.units import shown

CLUSTER_TIMEOUT_S = 20  # [s] for a scheduler to answer and for a first worker
TASKS_PER_THREAD = 2  # tasks sent for each thread of the cluster, so that none waits
POLL = 0.05  # [s] between looks at what has come
AT_WORK = ("pending", "lost")  # what a worker had done that died is done again by another
ADDRESS = re.compile(r"((tcp|tls|ucx|wss?)://)?[^\s/]+:\d+/?")
RESUME_CLUSTER_ADVICE = "mend it, then start this command again with `resume`: what is finished is kept"


class Cluster:
    """The workers of a Dask scheduler.

    Parameters
    ----------
    address : str
        'tcp://host:8786'.
    job : function
        From a Task to an Outcome; the workers import it from the same version of this program.
    """

    def __init__(self, address, job=work):
        self.address, self.job = address, job

    def outcomes(self, tasks):
        """Yield the outcome of each task, as they come; few tasks are on the way at a time.

        Parameters
        ----------
        tasks : iterable of Task

        Yields
        ------
        Outcome

        Raises
        ------
        FeederError
            If there is no scheduler, it is lost, or its workers are of another version.
        """
        client = self._client()
        try:
            self._check_workers(client)
            yield from self._gathered(client, iter(tasks))
        finally:
            client.close(timeout=1)

    def each(self, function, items):
        """Yield what a function gives for each of some items; here, as it is little work."""
        return map(function, items)

    def _client(self):
        distributed = _distributed()
        if not ADDRESS.fullmatch(self.address):
            what = f"{shown(self.address)} is not an address of a scheduler"
            raise ArgumentError("scheduler", what, "write it as tcp://host:8786")
        logging.getLogger("distributed").setLevel(logging.CRITICAL)  # we tell what is lost, in one line
        try:
            return distributed.Client(self.address, timeout=CLUSTER_TIMEOUT_S, set_as_default=False)
        except (OSError, ValueError) as error:
            raise self._fault(f"no scheduler answers ({_first_line(error)})") from None

    def _check_workers(self, client):
        """Check that every worker has this very program and libraries, or its bytes would not be ours."""
        try:
            client.wait_for_workers(1, timeout=CLUSTER_TIMEOUT_S)
            found = client.run(_versions)
        except OSError as error:
            raise self._fault(f"no worker answers ({_first_line(error)})") from None
        except ImportError as error:
            raise self._fault(f"a worker cannot import this program ({_first_line(error)})") from None
        for worker, versions in found.items():
            odd = [name for name, version in _versions().items() if versions.get(name) != version]
            if odd:
                raise self._fault(f"{worker} has another version of {', '.join(odd)}")

    def _gathered(self, client, tasks):
        running: dict[Any, Task] = {}  # by its future
        while True:
            with self._attended():
                room = max(1, TASKS_PER_THREAD * sum(client.nthreads().values())) - len(running)
            for task in islice(tasks, max(room, 0)):
                with self._attended():
                    running[client.submit(self.job, task, pure=False)] = task
            if not running:
                return
            for future in self._finished(client, running):
                if future.status not in AT_WORK:  # not lost with its worker while another was put in place
                    yield self._outcome(future, running.pop(future))

    def _finished(self, client, running):
        """Wait for those that have come, at least one."""
        while True:
            if client.status != "running" or any(future.cancelled() for future in running):
                raise self._fault("the scheduler is lost")
            ready = [future for future in running if future.done()]
            if ready:
                return ready
            time.sleep(POLL)

    def _outcome(self, future, task):
        """Return what came of a task; the cluster itself has tried again where a worker died."""
        if future.status == "finished":
            with self._attended():
                return future.result()
        if future.status == "cancelled":
            raise self._fault("the scheduler is lost")
        return Outcome.failed(task, f"{_first_line(future.exception())} - try it alone", final=False)

    @contextlib.contextmanager
    def _attended(self):
        """Turn what a client raises when its scheduler is lost into a FeederError."""
        try:
            yield
        except (OSError, CancelledError, _distributed().client.ClosedClientError):
            raise self._fault("the scheduler is lost") from None

    def _fault(self, what):
        return FeederError(self.address, what, RESUME_CLUSTER_ADVICE)


def _distributed():
    try:
        import distributed
    except ImportError:
        mend = "pip install 'feederscrew[dist]'"
        raise MissingPackage("scheduler", "needs the package 'distributed'", mend) from None
    return distributed


def _versions():
    return {"feederscrew": __version__, **libraries()}


def _first_line(error):
    return (str(error).strip().splitlines() or [type(error).__name__])[0][:200]
