"""The thesis's tables, as printed: the digits are part of the data."""

import csv
import functools
from dataclasses import dataclass
from importlib import resources

import numpy as np

NUMBERS = tuple(f"3-{n}" for n in range(1, 14))
KEYS = ("aspect", "quantity", "first", "second")  # columns that name a row
TOTAL = "total"


@dataclass(frozen=True)
class PrintedTable:
    """One table of the thesis; every cell is the text in print, '' where print leaves it blank."""

    number: str  # as the thesis counts: '3-9'
    caption: str
    source: str
    units: str
    columns: tuple[str, ...]  # that hold numbers
    rows: dict[str, dict[str, str]]  # column -> text, by row name; a pair's names joined by ' - '

    @property
    def names(self):
        """Row names without the total."""
        return tuple(name for name in self.rows if name != TOTAL)

    def text(self, row, column):
        """One cell as printed."""
        return self.rows[row][column]

    def numbers(self, column):
        """One column without its total, as an array."""
        return np.array([float(self.rows[name][column]) for name in self.names])


@functools.cache
def table(number):
    """Table by its number in the thesis, or 'chapter 4' for the inertial data printed there.

    Parameters
    ----------
    number : str
        One of ``NUMBERS``, or 'chapter 4'.

    Returns
    -------
    PrintedTable
    """
    lines = (resources.files("feederscrew.thesis") / "data" / _file(number)).read_text().splitlines()
    head = dict(line[2:].split(": ", 1) for line in lines if line.startswith("#"))
    reader = csv.DictReader(line for line in lines if not line.startswith("#"))
    names = reader.fieldnames or ()
    keys = [name for name in names if name in KEYS]
    columns = tuple(name for name in names if name not in keys)
    rows = {" - ".join(row[key] for key in keys): {c: row[c] for c in columns} for row in reader}
    return PrintedTable(head["table"], head["caption"], head["source"], head["units"], columns, rows)


def _file(number):
    if number == "chapter 4":
        return "chapter_4.csv"
    chapter, _, count = number.partition("-")
    return f"table_{chapter}_{int(count):02d}.csv"
