"""What is said to a person who must wait: for the compiler, and how far a long run is."""

import contextlib
import itertools
import sys
import time

import click

LINE_EVERY_S = 15.0  # [s] between two lines where stderr is a file or a pipe


class Progress:
    """A bar on stderr: how many are done, and how long the rest will take.

    Where stderr is no terminal, a run that takes longer than ``LINE_EVERY_S`` says where it is, a line each.

    Parameters
    ----------
    total : int or None
        How many there are; None where that is not known yet.
    shown : bool
        False for nothing at all.
    what : str
        They are.
    """

    def __init__(self, total, is_shown=True, what="parts"):
        hidden = not (is_shown and sys.stderr.isatty())
        self.lines, self.what = is_shown and not sys.stderr.isatty(), what
        self.begun = self.last_line = time.monotonic()
        self.bar = click.progressbar(
            itertools.repeat(None),  # never asked: they are counted by hand
            length=total,
            label=what,
            show_pos=True,
            item_show_func=_interval_text,
            file=sys.stderr,
            hidden=hidden,
        )

    def __enter__(self):
        if self.bar.length is not None:
            self.bar.__enter__()
        return self

    def __exit__(self, *fault):
        if self.bar.entered:
            self.bar.__exit__(*fault)

    def tell(self, is_reused):
        """Count one more; one that was ``is_reused`` took no time and leaves the bar altogether."""
        self.reach(self.bar.pos + (not is_reused), self.bar.length - is_reused)

    def reach(self, done, total, widest=None):
        """So many are done of so many, and the widest interval [1] is so wide to either side."""
        self._line(done, total)
        self.bar.length, self.bar.finished = total, False  # more may be found to be needed
        if not self.bar.entered:  # nothing is shown where nothing is waited for
            self.bar.__enter__()
        self.bar.current_item = widest
        self.bar.make_step(done - self.bar.pos)
        self.bar.render_progress()

    def _line(self, done, total):
        """Say where a long run is, where no bar can."""
        now = time.monotonic()
        if not self.lines or done >= total or now - self.last_line < LINE_EVERY_S:
            return
        self.last_line, gone = now, now - self.begun
        rest = f", about {gone * (total - done) / done:.0f} s to go" if done else ""
        with contextlib.suppress(OSError):  # a full disk under stderr must not cost the answer
            click.echo(f"{self.what}: {done} of {total} after {gone:.0f} s{rest}", err=True)


class StageBar:
    """How far a run of several stages is: on stderr a bar of the time, elsewhere now and then a line.

    Parameters
    ----------
    shown : bool
        False for nothing at all.
    """

    WIDTH = 24  # letters of the bar

    def __init__(self, is_shown=True):
        self.terminal = is_shown and sys.stderr.isatty()
        self.lines, self.drawn, self.last_line = is_shown and not self.terminal, False, time.monotonic()

    def reach(self, stage, done, total, gone, rest):
        """So many of a stage are done of so many; ``gone`` and ``rest`` are seconds of the whole run."""
        if self.terminal:
            full = round(self.WIDTH * gone / max(gone + rest, 1e-9))
            bar = "#" * full + "-" * (self.WIDTH - full)
            times = f"{_time(gone)} gone, about {_time(rest)} to go"
            self._write(f"\r\033[K{_stage(stage, done, total)}  [{bar}]  {times}")
            self.drawn = True
        elif self.lines and time.monotonic() - self.last_line >= LINE_EVERY_S:
            self.last_line = time.monotonic()
            self._write(f"{_stage(stage, done, total)} after {gone:.0f} s, about {rest:.0f} s to go\n")

    def clear(self):
        """Take the bar away, so that a line can be printed; a line there is as good as one of its own."""
        if self.drawn:
            self._write("\r\033[K")
        self.drawn, self.last_line = False, time.monotonic()

    def end(self):
        """Take the bar away."""
        self.clear()

    @staticmethod
    def _write(text):
        with contextlib.suppress(OSError):  # a full disk under stderr must not cost the answer
            click.echo(text, err=True, nl=False, color=True)


def _stage(stage, done, total):
    """A stage in words: 'trial 3 of 16', 'draws: 4 of 20', 'queue: 40 %'."""
    if stage == "queue":
        return f"queue: {100.0 * done / max(total, 1):.0f} %"
    return f"trial {done + 1} of {total}" if stage == "trial" else f"{stage}: {done} of {total}"


def _time(seconds):
    return f"{seconds:.0f} s" if seconds < 100.0 else f"{seconds / 60.0:.0f} min"


def _interval_text(widest):
    return None if widest is None else f"widest interval ±{100.0 * widest:.2g} %"


def drops(out):
    """Say so when the first drop on this machine must wait for the compiler."""
    from feederscrew.dropping import drop_test

    if not drop_test.compiled():
        out.say("Compiling the drop kernel, once on this machine: about ten seconds.")


def plate(out):
    """Say so when the first plate on this machine must wait for the compiler."""
    from feederscrew.dropping import plate_test

    if not plate_test.compiled():
        out.say("Compiling the plate's kernel, once on this machine: about ten seconds.")


def trial(out):
    """Say so when the first trial on this machine must wait for the compiler."""
    from feederscrew.trial import runs

    if not runs.compiled():
        out.say("Compiling the trial's kernel, once on this machine: about a minute.")


def conveying(out):
    """Say so when the first map on this machine must wait for the compiler."""
    from feederscrew.conveying import answer

    if not answer.sweep_compiled():
        out.say("Compiling the conveying kernel, once on this machine: about ten seconds.")


def design(out):
    """Return what shows how far the search for a design is: a StageBar, hidden where nobody waits."""
    return StageBar(not out.quiet)


def progress_in_bar(out, what):
    """Return a function of how many ``what`` are done and of how many, which shows it in a bar."""
    progress_bar = bar(out, what)
    click.get_current_context().with_resource(progress_bar)
    return progress_bar.reach


def bar(out, what):
    """Return a bar of the ``what`` that are done, where a person waits; hidden elsewhere."""
    return Progress(None, not out.quiet, what)
