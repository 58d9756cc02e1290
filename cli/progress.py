"""Progress for a person who must wait: for the compiler, and how far a long run is."""

import contextlib
import importlib
import itertools
import json
import os
import sys
import time
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

import click

from feederscrew.base.running import STAGE_VARIABLE

if TYPE_CHECKING:
    from feederscrew_cli.talk import Output

LINE_EVERY_S = 15.0  # [s] between two lines where stderr is a file or a pipe
NOTE_EVERY_S = 0.3  # [s] between two such notes


class Progress:
    """A bar on stderr: how many are done, and how long the rest will take.

    Where stderr is no terminal, a run that takes longer than ``LINE_EVERY_S`` says where it is, a line each.

    Parameters
    ----------
    total : int or None
        None where it is not known yet.
    is_shown : bool, optional
        Without it nothing is said.
    what : str, optional
        Names what is counted.
    """

    shown_bar: "ClassVar[Progress | None]" = None  # the one whose line is not ended

    def __init__(self, total: int | None, is_shown: bool = True, what: str = "parts") -> None:
        is_terminal = sys.stderr.isatty()
        self.lines, self.what = is_shown and not is_terminal, what
        self.begun = self.last_line = time.monotonic()
        self.first: tuple[float, int] | None = None  # when the first ones were done, and how many
        self.bar: Any = click.progressbar(
            itertools.repeat(None),  # never asked: they are counted by hand
            length=total,
            label=what,
            show_pos=True,
            item_show_func=lambda width: None if width is None else f"widest interval ±{100.0 * width:.2g} %",
            file=sys.stderr,
            hidden=not (is_shown and is_terminal),
        )

    def __enter__(self) -> "Progress":
        if self.bar.length is not None:
            self._enter()
        return self

    def __exit__(self, *fault: object) -> None:
        if self.bar.entered:
            self.bar.render_finish()
            self.bar.entered, Progress.shown_bar = False, None

    def _enter(self) -> None:
        Progress.shown_bar = self
        self.bar.__enter__()

    def tell(self, is_reused: bool) -> None:
        """Count one more.

        Parameters
        ----------
        is_reused : bool
            Whether it took no time: then it leaves the bar altogether.
        """
        self.reach(self.bar.pos + (not is_reused), self.bar.length - is_reused)

    def reach(self, done: int, total: int, widest: float | None = None) -> None:
        """Show how many are done, and how wide the widest interval is.

        Parameters
        ----------
        done, total : int
            More may be found to be needed than before.
        widest : float [1], optional
            Half of the widest interval.
        """
        now = time.monotonic()
        if self.lines and done < total and now - self.last_line >= LINE_EVERY_S:
            self.last_line = now
            gone, rest = now - self.begun, self._rest(now, done, total)
            _write(f"{self.what}: {done} of {total} after {gone:.0f} s{rest}\n")
        if done and self.first is None:
            self.first = now, done
        self.bar.length, self.bar.finished = total, False  # more may be found to be needed
        if not self.bar.entered:  # nothing is shown where nothing is waited for
            self._enter()
        self.bar.current_item = widest
        self.bar.make_step(done - self.bar.pos)
        self.bar.render_progress()

    def _rest(self, now: float, done: int, total: int) -> str:
        """The time to go, by the pace since the first ones: before them a kernel may have been compiled."""
        since, before = self.first or (now, done)
        return (
            f", about {(now - since) * (total - done) / (done - before):.0f} s to go" if done > before else ""
        )


def end_line() -> None:
    """End the line of a bar, so that what is said next has a line of its own; the bar goes on below."""
    if Progress.shown_bar is not None:
        Progress.shown_bar.__exit__(None, None, None)


class StageBar:
    """Progress of a run of several stages: on stderr a bar of the time, elsewhere now and then a line.

    A program that runs this one can name a file for it in FEEDER_STAGE_FILE: stage, done, total, seconds gone
    and to go, and the line that says so, as JSON.

    Parameters
    ----------
    is_shown : bool, optional
        Without it nothing is said.
    """

    WIDTH = 24  # letters of the bar

    def __init__(self, is_shown: bool = True) -> None:
        self.terminal = is_shown and sys.stderr.isatty()
        self.lines, self.is_drawn, self.last_line = is_shown and not self.terminal, False, time.monotonic()
        self.notes, self.last_note = os.environ.get(STAGE_VARIABLE), -NOTE_EVERY_S

    def reach(self, stage: str, done: int, total: int, gone: float, rest: float) -> None:
        """Show how far the run is.

        Parameters
        ----------
        stage : str
            'trial', 'queue' or another name.
        done, total : int
            Of that stage.
        gone : float [s]
            Of the whole run.
        rest : float [s]
            Of it to go if the design that is tried, or proved, holds; nobody knows whether it does.
        """
        case = "" if stage == "long proof" else " if it holds"
        text = f"{stage}: {done} of {total}"
        if stage == "queue":
            text = f"queue: {100.0 * done / max(total, 1):.0f} %"
        elif stage == "trial":
            text = f"trial {done + 1} of {total}"
        if self.notes and time.monotonic() - self.last_note >= NOTE_EVERY_S:
            self.last_note = time.monotonic()
            values = {"stage": stage, "done": done, "total": total, "gone_s": gone, "to_go_s": rest}
            _note(Path(self.notes), values | {"text": text})
        if self.terminal:
            full = round(self.WIDTH * gone / max(gone + rest, 1e-9))
            bar = "#" * full + "-" * (self.WIDTH - full)
            _write(f"\r\033[K{text}  [{bar}]  {_time(gone)} gone, about {_time(rest)} to go{case}")
            self.is_drawn = True
        elif self.lines and time.monotonic() - self.last_line >= LINE_EVERY_S:
            self.last_line = time.monotonic()
            _write(f"{text} after {gone:.0f} s, about {rest:.0f} s to go{case}\n")

    def clear(self) -> None:
        """Take the bar away, so that a line can be printed; a line there is as good as one of its own."""
        if self.is_drawn:
            _write("\r\033[K")
        self.is_drawn, self.last_line = False, time.monotonic()


def _write(text: str) -> None:
    with contextlib.suppress(OSError):  # a full disk under stderr must not cost the answer
        click.echo(text, err=True, nl=False, color=True)


def _note(path: Path, values: Mapping[str, object]) -> None:
    """Put values into a file in place of those before."""
    with contextlib.suppress(OSError):  # a full disk must not cost the answer
        partial = path.with_suffix(".new")
        partial.write_text(json.dumps(values), encoding="utf-8")
        partial.replace(path)


def _time(seconds: float) -> str:
    return f"{seconds:.0f} s" if seconds < 100.0 else f"{seconds / 60.0:.0f} min"


KERNELS = {  # what waits for the compiler once: its module, and how it is told
    "drops": ("feederscrew.arrivals.drop_test", "compiled", "the drop kernel", "ten seconds"),
    "plate": ("feederscrew.arrivals.plate_test", "compiled", "the plate's kernel", "ten seconds"),
    "trial": ("feederscrew.trials.runs", "is_compiled", "the trial's kernel", "a minute"),
    "conveying": ("feederscrew.motion.conveying", "sweep_compiled", "the conveying kernel", "ten seconds"),
}


def tell_compiling(out: "Output", name: str) -> None:
    """Say so when the first run of a kernel on this machine must wait for the compiler.

    Parameters
    ----------
    out : Output
    name : str
        Of ``KERNELS``.
    """
    module, is_compiled, kernel, seconds = KERNELS[name]
    if not getattr(importlib.import_module(module), is_compiled)():
        out.say(f"Compiling {kernel}, once on this machine: about {seconds}.")


def bar(out: "Output", what: str) -> Progress:
    """Return a bar of what is done, where a person waits; hidden elsewhere.

    Parameters
    ----------
    out : Output
    what : str
        Names what is counted.

    Returns
    -------
    Progress
        Of a total that is not known yet.
    """
    return Progress(None, not out.quiet, what)
