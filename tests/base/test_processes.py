"""Processes beside this one: what they return, how they end, and what is left of them."""

import contextlib
import multiprocessing
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from feederscrew.base.processes import Process, ProcessEnded, server_context

CONTEXTS = {
    "forked": lambda: multiprocessing.get_context("fork"),
    "of a server": lambda: server_context(["feederscrew.base.errors"]),
}
if not hasattr(os, "fork"):
    del CONTEXTS["forked"]
LEFT_ALONE = """
import os, signal
from feederscrew.base.processes import Process
import test_processes
process = Process(test_processes.CONTEXTS[{name!r}](), test_processes.halve)
process.give(8)
print(process.take()[1], flush=True)
os.kill(os.getpid(), signal.SIGKILL)
"""


def halve(number):
    if number < 0:
        os._exit(3)
    return number / 2, os.getpid()


@pytest.mark.parametrize("name", CONTEXTS)
def test_a_process_does_task_after_task_and_one_that_dies_says_so(name):
    process = Process(CONTEXTS[name](), halve)
    for number in (3, 5.0):
        process.give(number)
        result, pid = process.take()
        assert result == number / 2 and pid != os.getpid()
    process.give(-1)
    for _ in range(2):
        with pytest.raises(ProcessEnded):
            process.take()
        process.give(4)  # nobody is there to take it
    process.stop()


@pytest.mark.skipif(sys.platform != "linux", reason="looks for processes as Linux lists them")
@pytest.mark.parametrize("name", CONTEXTS)
def test_a_process_ends_with_a_program_that_is_killed(name, tmp_path):
    path = os.pathsep.join([str(Path(__file__).parent), *sys.path])
    with (tmp_path / "pid").open("w") as file:  # of a pipe the process that is left would hold the end
        call = [sys.executable, "-c", LEFT_ALONE.format(name=name)]
        subprocess.run(call, stdout=file, env=os.environ | {"PYTHONPATH": path})
    pid, end = int((tmp_path / "pid").read_text()), time.monotonic() + 10.0
    process = Path("/proc", str(pid))
    try:
        while process.exists() and time.monotonic() < end:
            time.sleep(0.02)
        assert not process.exists()
    finally:
        with contextlib.suppress(ProcessLookupError):
            os.kill(pid, signal.SIGKILL)
