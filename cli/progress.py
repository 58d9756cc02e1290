"""How far a long run is, on a terminal."""

import itertools
import sys

import click


class Progress:
    """A bar on stderr: how many are done, and how long the rest will take.

    Parameters
    ----------
    total : int or None
        How many there are; None where that is not known yet.
    shown : bool
        False for nothing at all; nothing is shown either where stderr is not a terminal.
    what : str
        They are.
    """

    def __init__(self, total, shown=True, what="parts"):
        hidden = not (shown and sys.stderr.isatty())
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
        self.bar.length, self.bar.finished = total, False  # more may be found to be needed
        if not self.bar.entered:  # nothing is shown where nothing is waited for
            self.bar.__enter__()
        self.bar.current_item = widest
        self.bar.make_step(done - self.bar.pos)
        self.bar.render_progress()


def _said(widest):
    return None if widest is None else f"widest interval ±{100.0 * widest:.2g} %"
