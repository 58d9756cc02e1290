"""Frames and numbers as people read them on a page."""

from typing import Any

import numpy as np

from feederscrew.errors import printable
from feederscrew.output import tables

DIGITS = 4  # significant, in a cell for people
SHORT = 3  # of a percentage, and at the head of the page
PLAIN = (1e-4, 1e7)  # numbers outside are written with an exponent
NOISE = 1e-12  # of a column's largest value: rounding, shown as 0
NOTHING = "–"


def cells(frame) -> tuple[Any, ...]:
    """Return a frame as texts for people.

    Parameters
    ----------
    frame : Frame
        Columns named with their units.

    Returns
    -------
    heads : list of (str, str)
        Name and unit of each column.
    numeric : list of bool
        Whether a column is of numbers.
    rows : list of tuple of str
    """
    numeric = [tables.is_numeric(column) for column in frame.values()]
    columns = [_column(name, column) for name, column in frame.items()]
    return (
        [tables.heading(name, is_number) for name, is_number in zip(frame, numeric)],
        numeric,
        list(zip(*columns)),
    )


def number(value, digits=DIGITS):
    """Return a number for people with so many significant digits, NaN as a dash."""
    if value == 0.0 or np.isnan(value):
        return "0" if value == 0.0 else NOTHING
    if not PLAIN[0] <= abs(value) < PLAIN[1]:
        return f"{value:.{digits - 1}e}"
    exponent = int(f"{value:.{digits - 1}e}".partition("e")[2])  # after rounding: 9.9999 is 10.00
    return f"{value:.{max(0, digits - 1 - exponent)}f}"


def percent(share):
    """Return a share as a percentage without its sign."""
    return number(100.0 * share, SHORT)


def _column(name, values) -> list[Any]:
    if not tables.is_numeric(values):
        return [_word(value) for value in values]
    if np.issubdtype(values.dtype, np.integer):
        return [str(value) for value in values]
    if tables.is_share(name):
        return [percent(value) for value in values]
    noise = 0.0 if name == tables.MIXED else NOISE * np.abs(values[np.isfinite(values)]).max(initial=0.0)
    return [number(0.0 if abs(value) <= noise else value) for value in values]


def _word(value):
    if isinstance(value, (bool, np.bool_)):
        return "yes" if value else "no"
    return NOTHING if value is None or value != value else printable(str(value))
