"""One design at a time, as a process of its own: it can be stopped, and its faults stay its own."""

import contextlib
import os
import signal
import subprocess
import threading
from collections import deque
from collections.abc import Sequence
from pathlib import Path

LINES_SHOWN = 400  # of what a design says
STOPPED = 130  # exit status of a design that was stopped, as the command line has it
STOP_WITHIN_S, KILL_WITHIN_S = 20.0, 5.0  # after an interrupt and after a termination


class DesignJob:
    """A command that designs, with what it says and the files it leaves.

    Parameters
    ----------
    command : sequence of str
        Program and arguments.
    results : Path
        Folder that it writes to.
    """

    def __init__(self, command: Sequence[str], results: Path) -> None:
        self.results = results
        self._lines: deque[str] = deque(maxlen=LINES_SHOWN)
        self._stop_asked = False
        self._process = subprocess.Popen(
            list(command),
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            errors="replace",
            cwd=results.parent,
            start_new_session=True,  # Ctrl-C in the terminal of the server reaches the server alone
            env={**os.environ, "NO_COLOR": "1"},
        )
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def _read(self) -> None:
        """Keep what it says, and close the pipe at its end."""
        output = self._process.stdout
        if output is not None:
            with output:
                self._lines.extend(line.rstrip() for line in output)

    @property
    def is_running(self) -> bool:
        """Whether it is still at work."""
        return self._process.poll() is None

    @property
    def lines(self) -> list[str]:
        """The last lines that it said."""
        if not self.is_running:
            self._reader.join(timeout=1.0)
        return list(self._lines)

    @property
    def state(self) -> str:
        """'running', 'stopping', 'done', 'stopped' or 'failed'."""
        if self.is_running:
            return "stopping" if self._stop_asked else "running"
        if self._process.returncode == 0:
            return "done"
        return "stopped" if self._stop_asked or self._process.returncode == STOPPED else "failed"

    def files(self) -> dict[str, Path]:
        """Return the files that it left, by their path below the folder of its part; empty while it runs."""
        if self.is_running:
            return {}
        return {
            "/".join(path.relative_to(self.results).parts[1:]): path
            for path in sorted(self.results.rglob("*"))
            if path.is_file() and not path.is_symlink()
        }

    def stop(self) -> None:
        """Ask it to end, as Ctrl-C does."""
        self._stop_asked = True
        self._signal(signal.SIGINT)

    def end(self) -> None:
        """End it and whatever it has started, within some seconds."""
        for ending, seconds in ((signal.SIGTERM, STOP_WITHIN_S), (signal.SIGKILL, KILL_WITHIN_S)):
            if not self.is_running:
                break
            self._stop_asked = True
            self._signal(ending)
            with contextlib.suppress(subprocess.TimeoutExpired):
                self._process.wait(seconds)
        self._reader.join(timeout=1.0)

    def _signal(self, number: int) -> None:
        with contextlib.suppress(ProcessLookupError):
            if self.is_running:
                os.killpg(self._process.pid, number)
