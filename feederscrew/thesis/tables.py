"""The thesis's tables as printed, and one printed number beside ours: the digits are part of the data."""

import csv
import functools
import math
from dataclasses import dataclass
from importlib import resources
from typing import Any

import numpy as np

from feederscrew.base.arrays import Floats

TABLES = tuple(f"3-{n}" for n in range(1, 14))
ROW_NAME_COLUMNS = ("aspect", "quantity", "first", "second")
TOTAL = "total"
EXACT_TO_PRINT = "exact to print"
EXPLAINED = "explained"
DIFFERS = "differs"
NOT_CHECKED = "given"  # measured, or read off a drawing that is lost: nothing to compute it from
PRINT_SLACK = 1e-9  # of the last digit: a half of it is not exact in binary


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
    def names(self) -> tuple[str, ...]:
        """Row names without the total."""
        return tuple(name for name in self.rows if name != TOTAL)

    def text(self, row: str, column: str) -> str:
        """One cell as printed."""
        return self.rows[row][column]

    def cell(self, row: str, column: str, recomputed: float = math.nan, **explanation: Any) -> "Cell":
        """One cell as printed beside ours, with the further fields of a ``Cell``."""
        return Cell(row, column, self.rows[row][column], recomputed, **explanation)

    def numbers(self, column: str) -> Floats:
        """One column without its total, as an array."""
        return np.array([float(self.rows[name][column]) for name in self.names])


@functools.cache
def table(number: str) -> PrintedTable:
    """Return a table by its number in the thesis, of ``TABLES``, or 'chapter 4' for its inertial data."""
    chapter, _, count = number.partition("-")
    name = f"table_{chapter}_{int(count):02d}.csv" if count else "chapter_4.csv"
    lines = (resources.files("feederscrew.thesis") / "data" / name).read_text().splitlines()
    head = dict(line[2:].split(": ", 1) for line in lines if line.startswith("#"))
    reader = csv.DictReader(line for line in lines if not line.startswith("#"))
    names = reader.fieldnames or ()
    keys = [name for name in names if name in ROW_NAME_COLUMNS]
    columns = tuple(name for name in names if name not in keys)
    rows = {" - ".join(row[key] for key in keys): {c: row[c] for c in columns} for row in reader}
    return PrintedTable(head["table"], head["caption"], head["source"], head["units"], columns, rows)


def chapter_4(part: str) -> dict[str, float]:
    """Return the numbers that chapter 4 prints of 'arc_chute' or 'magnet', by their name there."""
    return {row: float(cells[part]) for row, cells in table("chapter 4").rows.items() if cells[part]}


@dataclass(frozen=True)
class Cell:
    """A printed number and ours; an explanation counts only if its own number fits the print."""

    row: str
    column: str
    published: str  # as printed
    recomputed: float = math.nan  # in the print's unit; NaN where there is nothing to compute it from
    cut: bool = False  # the table drops digits instead of rounding
    finding: str = ""  # id of the finding that bears on the cell
    explaining: float = math.nan  # what the finding makes of the number
    tolerance: float = 0.0  # how far the explaining number may be from the print, in the print's unit

    @property
    def printed_value(self) -> float:
        """The printed number; NaN where print holds no number."""
        return float(self.published) if is_number(self.published) else math.nan

    @property
    def deviation(self) -> float:
        """Ours minus theirs, in the print's unit."""
        return self.recomputed - self.printed_value

    @property
    def verdict(self) -> str:
        """``EXACT_TO_PRINT``, ``EXPLAINED``, ``DIFFERS`` or ``NOT_CHECKED``."""
        if math.isnan(self.recomputed):
            return NOT_CHECKED
        if math.isnan(self.printed_value):
            fits = is_slip(self.recomputed, self.published)
        elif prints_as(self.recomputed, self.published, self.cut):
            return EXACT_TO_PRINT
        else:
            near = abs(self.explaining - self.printed_value) <= self.tolerance
            fits = near or prints_as(self.explaining, self.published, self.cut)
        return EXPLAINED if self.finding and fits else DIFFERS


def last_digit(text: str) -> float:
    """Return the weight of the last printed digit: '0.805' gives 0.001."""
    return 10.0 ** -len(text.partition(".")[2])


def is_number(text: str) -> bool:
    """Return whether the printed text is a number at all."""
    try:
        float(text)
    except ValueError:
        return False
    return True


def prints_as(value: float, text: str, cut: bool = False) -> bool:
    """Return whether a value gives a printed text, once it is rounded or cut off after the last digit.

    ``PRINT_SLACK`` of a digit is allowed for rounding on the way.

    Parameters
    ----------
    value : float
    text : str
        '0.805'.
    cut : bool
        Digits beyond the last are cut off, not rounded.

    Returns
    -------
    bool
    """
    error = (value - float(text)) / last_digit(text)
    if cut:
        return -PRINT_SLACK <= error * math.copysign(1.0, value) < 1.0 - PRINT_SLACK
    return abs(error) <= 0.5 + PRINT_SLACK


def is_slip(value: float, text: str) -> bool:
    """Return whether one wrong character keeps a printed text from being a value: '804.1.73' for 804.1073.

    Parameters
    ----------
    value : float
    text : str
        As printed, with a point.

    Returns
    -------
    bool
    """
    right = f"{value:.{len(text) - text.index('.') - 1}f}"
    return len(right) == len(text) and sum(a != b for a, b in zip(right, text)) == 1
