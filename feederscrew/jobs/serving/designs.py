"""Designs that a browser asks for: the call of ``feeder design``, the process, and what it left."""

import contextlib
import json
import os
import shutil
import signal
import subprocess
import sys
import threading
import time
from collections import deque
from collections.abc import Callable, Sequence
from enum import StrEnum
from pathlib import Path

from feederscrew.base.columns import Document
from feederscrew.base.errors import printable
from feederscrew.base.running import STAGE_VARIABLE
from feederscrew.jobs.serving import guard
from feederscrew.jobs.serving.orders import PageOrder
from feederscrew.jobs.serving.refusal import Refusal, in_words_of_the_page

MOST_DESIGNS = 100  # of one run: each keeps its folder
LINES_SHOWN = 400  # of what a design says
STOPPED = (130, 143)  # exit statuses of a design that was stopped, as the command line has them
STOP_WITHIN_S = 20.0  # after an interrupt
KILL_WITHIN_S = 5.0  # after a termination
OTHERWISE = "choose another rate, machine or material, or give this part to feeder design on the command line"


class DesignState(StrEnum):
    """State of a design so far."""

    RUNNING = "running"
    STOPPING = "stopping"
    DONE = "done"
    STOPPED = "stopped"
    FAILED = "failed"


class Guard:
    """The process that ends designs and removes the folder of a server that was killed."""

    def __init__(self, folder: Path) -> None:
        self._process = subprocess.Popen(
            [sys.executable, "-I", "-S", guard.__file__, str(folder)],
            stdin=subprocess.PIPE,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            text=True,
            start_new_session=True,
        )
        self._turn = threading.Lock()

    def tell(self, word: str, process: int) -> None:
        """Tell the guard of a group of processes; a guard that has ended is told nothing.

        Parameters
        ----------
        word : str
            'run' or 'end'.
        process : int
            The id of the process that leads the group.
        """
        with self._turn, contextlib.suppress(OSError, ValueError):
            if self._process.stdin is not None:
                self._process.stdin.write(f"{word} {process}\n")
                self._process.stdin.flush()

    def close(self) -> None:
        """End the guard: it removes the folder."""
        with self._turn, contextlib.suppress(OSError, ValueError):
            if self._process.stdin is not None:
                self._process.stdin.close()
        with contextlib.suppress(subprocess.TimeoutExpired):
            self._process.wait(KILL_WITHIN_S)


class DesignJob:
    """A command that designs, with what it says and the files it leaves in a folder of results."""

    def __init__(
        self,
        key: str,
        program: Sequence[str],
        order: PageOrder,
        folder: Path,
        tell_guard: Callable[[str, int], None],
    ) -> None:
        self.id, self.order, self.folder, self._tell_guard = key, order, folder, tell_guard
        self.results, self._stage_file = folder / "results", folder / "stage.json"
        self._lines: deque[str] = deque(maxlen=LINES_SHOWN)
        self._stop_asked = False
        self._began, self._ended = time.monotonic(), 0.0
        self._answer: Document | None = None
        try:
            self.results.mkdir(parents=True)
            # beside its files the call is the one that the page shows, and so are those that it ends in
            _place(order.upload.path, folder)
            if order.bowl is not None:
                _place(order.bowl.path, folder)
            self._process = subprocess.Popen(
                [*program, *order.arguments],
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                text=True,
                errors="replace",
                cwd=folder,
                start_new_session=True,  # Ctrl-C in the terminal of the server reaches the server alone
                env={**os.environ, "NO_COLOR": "1", STAGE_VARIABLE: str(self._stage_file)},
            )
        except BaseException:
            shutil.rmtree(folder, ignore_errors=True)
            raise
        tell_guard("run", self._process.pid)
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def _read(self) -> None:
        output = self._process.stdout
        if output is not None:
            with output:
                self._lines.extend(line.rstrip() for line in output)
        self._process.wait()
        self._ended = time.monotonic()
        self._tell_guard("end", self._process.pid)

    @property
    def is_running(self) -> bool:
        """Tell whether the design is still at work."""
        return self._process.poll() is None

    @property
    def lines(self) -> list[str]:
        """Return the last lines that the design said, with the name of the part in place of its path."""
        if not self.is_running:
            self._reader.join(timeout=1.0)
        upload = self.order.upload
        return [printable(line).replace(upload.path.name, upload.name) for line in self._lines]

    @property
    def state(self) -> DesignState:
        """Return the state of the design so far."""
        if self.is_running:
            return DesignState.STOPPING if self._stop_asked else DesignState.RUNNING
        if self._process.returncode and (self._stop_asked or self._process.returncode in STOPPED):
            return DesignState.STOPPED
        return DesignState.DONE if self._process.returncode == 0 or self.answer else DesignState.FAILED

    @property
    def fault(self) -> str:
        """Return the reason why it failed, in the words of the page; '' where it did not."""
        if self.state != DesignState.FAILED:
            return ""
        faults = [line.removeprefix("Error: ") for line in self.lines if line.startswith("Error: ")]
        return in_words_of_the_page(
            faults[-1] if faults else "the design: ended without an answer", OTHERWISE
        )

    @property
    def stage(self) -> Document:
        """Return its progress: stage, done, total, seconds gone and to go; empty where nothing is said."""
        return _json_file(self._stage_file) if self.is_running else {}

    def files(self) -> dict[str, Path]:
        """Return the files that it left, by their path below the folder of its part; empty while it runs."""
        if self.is_running:
            return {}
        return {
            "/".join(path.relative_to(self.results).parts[1:]): path
            for path in sorted(self.results.rglob("*"))
            if path.is_file() and not path.is_symlink()
        }

    @property
    def answer(self) -> Document:
        """Return the document of its answer, ``design.json``; empty where there is none, or none yet."""
        if self._answer is None and not self.is_running:
            self._answer = _json_file(self.files().get("design.json"))
        return self._answer or {}

    def document(self) -> Document:
        """Return the row of the design in a list of designs, as JSON has it."""
        answer = self.answer
        names = ("status", "wanted", "delivered_per_minute")
        return {
            "id": self.id,
            "part": self.order.upload.document,
            "order": self.order.values,
            "state": self.state,
            **{name: answer.get(name) for name in names},
        }

    def progress(self) -> Document:
        """Return all that a page shows of it but the links to its files."""
        return {
            **self.document(),
            "lines": self.lines,
            "stage": self.stage,
            "seconds": (self._ended or time.monotonic()) - self._began,
            "fault": self.fault,
            "why": self.answer.get("why") or "",
            "command": self.order.command,
            "next": [f"{step['label']}: {step['why']}" for step in self.steps],
        }

    @property
    def steps(self) -> list[Document]:
        """Return what to try after it, as its document and the command line have it."""
        return self.answer.get("next") or []

    def order_after(self, place: object) -> PageOrder:
        """Return the order that a step to try asks for.

        Parameters
        ----------
        place : object
            Of the step in ``steps``, from 0, as a browser sent it.

        Returns
        -------
        PageOrder

        Raises
        ------
        Refusal
            If there is no such step.
        """
        if isinstance(place, bool) or not isinstance(place, int) or not 0 <= place < len(self.steps):
            raise Refusal(400, "that step is not one of the design - reload the page")
        step = self.steps[place]
        return self.order.after(step["options"], step["settings"])

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


def _place(path: Path, folder: Path) -> None:
    """Put a file into a folder, without a copy of it where the disk can."""
    try:
        os.link(path, folder / path.name)
    except OSError:
        shutil.copyfile(path, folder / path.name)


def _json_file(path: Path | None) -> Document:
    """The document in a file; empty where there is none, or no document."""
    if path is not None:
        with contextlib.suppress(OSError, ValueError, RecursionError):
            document = json.loads(path.read_text(encoding="utf-8"))
            return document if isinstance(document, dict) else {}
    return {}
