"""What processes take: processor time, time by the clock, memory."""

import contextlib
import ctypes
import os
import subprocess
import time
from dataclasses import dataclass
from pathlib import Path

MIB = 1024.0  # KiB
LOOK = 0.2  # [s] between looks at memory
ADOPTS = 36  # prctl(2): what a process started and left behind becomes this one's, which waits for it


@dataclass(frozen=True)
class Spent:
    """What one process took."""

    cpu: float  # [s] with its children
    wall: float  # [s]
    memory: float  # [MiB] most at a time, of the largest process, those it waited for among them


def spent(*command, fails=False, **environment):
    """Run one process to its end; what it took."""
    return at_once([command], fails=fails, **environment)


def at_once(commands, fails=False, **environment):
    """Run processes side by side to their ends; what they took together."""
    start, used = time.perf_counter(), []
    running = {_started(command, environment): command for command in commands}
    while running:
        child, status, took = os.wait4(-1, 0)
        command = running.pop(child, ())
        if status and command and not fails:
            raise SystemExit(f"failed: {' '.join(command)}")
        used.append(took)
    wall = time.perf_counter() - start
    used += _left_behind()
    cpu = sum(one.ru_utime + one.ru_stime for one in used)
    return Spent(cpu, wall, max(one.ru_maxrss for one in used) / MIB)


def _started(command, environment):
    """Its number; it prints nothing, and keeps the bytecode of what it imports."""
    given = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
    with Path(os.devnull).open("wb") as nothing:
        actions = [(os.POSIX_SPAWN_DUP2, nothing.fileno(), 1), (os.POSIX_SPAWN_DUP2, nothing.fileno(), 2)]
        return os.posix_spawn(command[0], command, given | environment, file_actions=actions)


def _left_behind():
    """What processes used that outlived who started them, as the server of a batch does."""
    with contextlib.suppress(ChildProcessError):
        while True:
            yield os.wait4(-1, 0)[2]


def adopt():
    """Let what outlives its parent be waited for here; Linux only, elsewhere it is not counted."""
    with contextlib.suppress(AttributeError, OSError, TypeError):
        ctypes.CDLL(None).prctl(ADOPTS, 1, 0, 0, 0)


def family(leader):
    """Memory of each process of a session [MB], its leader's first; pages shared are counted once each."""
    found = []
    for entry in Path("/proc").glob("[0-9]*"):
        try:
            if os.getsid(int(entry.name)) == leader:
                lines = (entry / "smaps_rollup").read_text().splitlines()
                kilobytes = next(int(line.split()[1]) for line in lines if line.startswith("Pss:"))
                found.append((entry.name != str(leader), kilobytes / 1024))
        except OSError:
            continue
    return [megabytes for _, megabytes in sorted(found)] or [0.0]


def finished(out):
    """How many parts of a batch have their folder."""
    return sum(1 for _ in (out / "parts").glob("*")) if out.exists() else 0


def together(command, late):
    """The most memory that a session of processes takes at a time [MiB], before and since ``late()``."""
    child = subprocess.Popen(command, start_new_session=True, stdout=subprocess.DEVNULL)
    halves = [0.0, 0.0]
    while child.poll() is None:
        half = int(late())
        halves[half] = max(halves[half], sum(family(child.pid)))
        time.sleep(LOOK)
    for _ in _left_behind():  # its server ends after it, and is not to be counted with the next process
        pass
    return halves
