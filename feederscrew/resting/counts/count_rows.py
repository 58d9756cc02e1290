"""A CSV file of counts as rows with the numbers of their lines, within limits; nothing is understood yet."""

import csv
import hashlib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from feederscrew import documents
from feederscrew.errors import Faults, FeederError
from feederscrew.resting.counts import head as heads
from feederscrew.resting.counts.head import Head

MAX_FILE_BYTES = 1_000_000  # [bytes] a thousand aspects in a hundred columns
ROWS, COLUMNS = 10_000, 200
TOLD = 20  # faults of one file that are shown
COUNTS_EXAMPLE = "give a header 'aspect,counts' and one row an aspect"


class Few:
    """The first faults of a file, and how many more there are."""

    def __init__(self, where) -> None:
        self.where, self.more = where, 0
        self.kept: list[Any] = []

    def add(self, where, what, mend) -> None:
        """Keep a fault; ``mend`` may be a function, asked only where the fault is kept."""
        if len(self.kept) < TOLD:
            self.kept.append(FeederError(where, what, mend() if callable(mend) else mend))
        else:
            self.more += 1

    def raise_any(self) -> None:
        """Raise what was found in one go; return if that is nothing."""
        if self.more:
            self.kept.append(FeederError(self.where, f"and {self.more} more faults", "mend these first"))
        if self.kept:
            raise Faults(self.kept)


@dataclass(frozen=True)
class CountSheet:
    """The table of one file, and the head above it."""

    head: Head
    first: int  # line of the header
    header: tuple[str, ...]
    rows: tuple[tuple[int, list[str]], ...]  # number of the line, and its cells


def content(path) -> tuple[str, ...]:
    """Read the text of a file of counts.

    Parameters
    ----------
    path : str or Path
        As the user typed it; faults repeat it.

    Returns
    -------
    text, sha256 : str

    Raises
    ------
    FeederError
        If it cannot be read, is too large or not UTF-8.
    """
    if documents.found_as(Path.is_dir, path):
        raise FeederError(path, "cannot be read (Is a directory)", "name a CSV file of counts in it")
    data = documents.content(path, MAX_FILE_BYTES, "a CSV file of counts", FeederError)
    if len(data) > MAX_FILE_BYTES:
        what = f"has more than {MAX_FILE_BYTES // 1_000_000} MB"
        raise FeederError(path, what, "name a CSV file with one row an aspect")
    return documents.decoded(data, str(path)), hashlib.sha256(data).hexdigest()


def parse(text, where) -> CountSheet:
    """Split the text of a file of counts into its head and its rows.

    Parameters
    ----------
    text : str
        Lines that begin with '#' are comments; above the header they may be its head.
    where : str
        The file, for the fault lines.

    Returns
    -------
    CountSheet

    Raises
    ------
    FeederError
        If it is empty, not CSV or has too many rows or columns; faults of the head.
    """
    lines = [(number, line) for number, line in enumerate(text.splitlines(), 1) if line.strip()]
    table = [(number, line) for number, line in lines if not line.lstrip().startswith("#")]
    table = [(number, line) for number, line in table if line.strip(", \t")]
    if len(table) > ROWS:
        raise FeederError(where, f"has more than {ROWS} rows", "give one row an aspect")
    if not table:
        raise FeederError(where, "is empty", COUNTS_EXAMPLE)
    first, header = table[0]
    names = cells(where, first, header)
    if len(names) > COLUMNS:
        raise FeederError(f"{where}:{first}", f"has more than {COLUMNS} columns", "split the file")
    head, faults = heads.parse([line for line in lines if line[0] < first], where)
    if faults:
        raise Faults(faults[:TOLD])
    return CountSheet(head, first, tuple(names), tuple((k, cells(where, k, line)) for k, line in table[1:]))


def cells(where, number, line, mend=COUNTS_EXAMPLE) -> list[str]:
    """Return the cells of one line of CSV; raises a FeederError that ends in ``mend`` if it is none."""
    try:
        return [cell.strip() for cell in next(csv.reader([line]), [])]
    except csv.Error as error:
        raise FeederError(f"{where}:{number}", f"is not CSV ({error})", mend) from None
