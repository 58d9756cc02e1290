"""The same batch on a Dask cluster: the same bytes, and one line where it is lost."""

import os
import signal
import subprocess
import sys
from contextlib import contextmanager, suppress
from pathlib import Path
from types import SimpleNamespace

import pytest
from command_lines import ROOT
from test_batch import Here, asked, block, ran, three, tree  # noqa: F401

from feederscrew.base.errors import FeederError
from feederscrew.jobs import batch
from feederscrew.jobs.batch.work import work

distributed = pytest.importorskip("distributed", reason="needs the extra dist")
pytestmark = pytest.mark.filterwarnings("ignore")  # of the cluster's own libraries


@contextmanager
def cluster(folder, workers=2):
    """A scheduler and workers as processes of their own; their address and the processes, scheduler first."""
    place = Path(folder) / "scheduler.json"
    settings = {**os.environ, "PYTHONPATH": os.pathsep.join([str(ROOT), str(ROOT / "tests"), *sys.path])}
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL, "env": settings, "cwd": folder}
    start = [sys.executable, "-m", "distributed.cli.dask_scheduler", "--no-dashboard", "--port", "0"]
    running = [subprocess.Popen([*start, "--host", "127.0.0.1", "--scheduler-file", str(place)], **quiet)]
    worker = [sys.executable, "-m", "distributed.cli.dask_worker", "--no-dashboard", "--nthreads", "1"]
    worker += ["--no-nanny", "--scheduler-file", str(place)]
    running += [subprocess.Popen(worker, **quiet) for _ in range(workers)]
    try:
        with distributed.Client(scheduler_file=str(place), timeout=60, set_as_default=False) as client:
            client.wait_for_workers(workers, timeout=60)
            yield client.scheduler.address, running
    finally:
        for process in running:
            with suppress(OSError):
                process.kill()
            process.wait()


@pytest.mark.long
def test_a_cluster_may_lose_a_worker_and_says_when_it_loses_its_scheduler(tmp_path, three, monkeypatch):  # noqa: F811
    """It gives the bytes of the processes. Without a scheduler: one line, and what is finished is kept."""
    for number in range(3):
        block(tmp_path / f"in/more_{number}.stl", 5.0 + number, 4.0, 3.0)
    requests = asked(tmp_path / "in")
    ran(requests, tmp_path / "here", workers=Here(job=work))
    with cluster(tmp_path) as (address, running):
        with monkeypatch.context() as older:
            older.setattr("feederscrew.jobs.batch.workers.__version__", "0.0.1")
            with pytest.raises(FeederError, match=r"has another version of feederscrew - "):
                ran(requests, tmp_path / "there", workers=batch.Cluster(address))
        finished = []

        def lose_one(is_reused):
            finished.append(is_reused)
            if len(finished) == 2:
                running[-1].send_signal(signal.SIGKILL)

        ran(requests, tmp_path / "there", workers=batch.Cluster(address), tell=lose_one)
        assert len(finished) == 6 and tree(tmp_path / "there") == tree(tmp_path / "here")
        lost = batch.Cluster(address)
        with pytest.raises(FeederError) as fault:
            ran(requests, tmp_path / "out", workers=lost, tell=lambda is_reused: running[0].kill())
    assert fault.value.lines == (
        f"{address}: the scheduler is lost - mend it, then start this command again with `resume`:"
        " what is finished is kept",
    )
    rest = Here(job=work)
    ran(requests, tmp_path / "out", workers=rest, resume=True)
    assert len(rest.done) < 6 and tree(tmp_path / "out") == tree(tmp_path / "here")


class Future(SimpleNamespace):
    """A future as the client of a cluster shows it."""

    __hash__ = object.__hash__

    def done(self):
        return self.status == "finished"

    def cancelled(self):
        return self.status == "cancelled"

    def result(self):
        return self.task


def test_what_a_worker_had_done_before_it_died_is_waited_for_again(monkeypatch):
    """Two results have come; while the first is put in place the worker that holds the other dies."""
    futures = []

    def submit(job, task, pure):
        futures.append(Future(task=task, status="finished"))
        return futures[-1]

    client = SimpleNamespace(status="running", nthreads=lambda: {"one": 1}, submit=submit)
    gathered = batch.Cluster("tcp://127.0.0.1:1")._gathered(client, iter("ab"))
    assert next(gathered) == "a"
    futures[1].status = "lost"
    sleep = "feederscrew.jobs.batch.workers.time.sleep"
    monkeypatch.setattr(sleep, lambda _: setattr(futures[1], "status", "finished"))
    assert list(gathered) == ["b"]


def test_no_scheduler_is_one_line(monkeypatch):
    monkeypatch.setattr("feederscrew.jobs.batch.workers.CLUSTER_TIMEOUT_S", 0.3)
    nonsense = r"^scheduler: 'nonsense' is not an address of a scheduler - write it as tcp://"
    for address, said in (("tcp://127.0.0.1:1", r"^tcp://127.0.0.1:1: no scheduler"), ("nonsense", nonsense)):
        with pytest.raises(FeederError, match=said):
            list(batch.Cluster(address).outcomes([]))
