"""How far a long run is: a bar on a terminal, now and then a line elsewhere."""

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

    def __init__(self, total, shown=True, what="parts"):
        hidden = not (shown and sys.stderr.isatty())
        self.lines, self.what = shown and not sys.stderr.isatty(), what
        self.begun = self.last_line = time.monotonic()
        self.bar = click.progressbar(
            itertools.repeat(None),  # never asked: they are counted by hand
            length=total,
            label=what,
            show_pos=True,
            item_show_func=_said,
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

    def tell(self, kept):
        """Count one more; one that was ``kept`` took no time and leaves the bar altogether."""
        self.reach(self.bar.pos + (not kept), self.bar.length - kept)

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


def _said(widest):
    return None if widest is None else f"widest interval ±{100.0 * widest:.2g} %"
