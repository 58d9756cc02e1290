"""How far a long run is, on a terminal."""

import sys
import time

import click


class Progress:
    """One line on stderr that is written over: how many are done, and how long the rest will take.

    Parameters
    ----------
    total : int
        How many there are.
    shown : bool
        False for nothing at all; nothing is shown either where stderr is no terminal.
    """

    def __init__(self, total, shown=True):
        self.total, self.shown = total, shown and sys.stderr.isatty()
        self.computed, self.kept, self.start, self.width = 0, 0, time.monotonic(), 0

    def __enter__(self):
        return self

    def __exit__(self, *fault):
        self._write("")

    def tell(self, kept):
        """Count one more; ``kept`` if it was there already and took no time."""
        self.computed, self.kept = self.computed + (not kept), self.kept + kept
        done = self.computed + self.kept
        self._write(f"{done} of {self.total} parts{self._remaining(self.total - done)}")

    def _remaining(self, left):
        if not self.computed or not left:
            return ""
        return f", {lasting((time.monotonic() - self.start) / self.computed * left)} left"

    def _write(self, line):
        if self.shown:
            click.echo(f"\r{line.ljust(self.width)}" + ("" if line else "\r"), err=True, nl=False)
            self.width = len(line)


def lasting(seconds):
    """A time for people: '40 s', '12 min', '3 h 20 min'."""
    if seconds < 90:
        return f"{seconds:.0f} s"
    minutes = round(seconds / 60)
    return f"{minutes} min" if minutes < 90 else f"{minutes // 60} h {minutes % 60} min"
