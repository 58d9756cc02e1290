"""A CSV file of counts as its head and rows with the numbers of their lines, within limits."""

import csv
import hashlib
import re
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

from feederscrew import documents
from feederscrew.documents import hint
from feederscrew.errors import Faults, FeederError
from feederscrew.resting.rules.recommended import LAUNCH_NAMES
from feederscrew.units import quantity_text

HEAD_LINE = re.compile(r"#\s*([A-Za-z_ -]{1,30}?)\s*:\s*(.*)")
DIGEST = re.compile(r"(?:sha256:)?([0-9a-f]{8,64})", re.IGNORECASE)
MAX_VALUE_LETTERS = 500  # letters of a value


@dataclass(frozen=True)
class Head:
    """What the lines '# key: value' of a file of counts say; empty where they are silent."""

    part: str = ""  # path of the part file, from the folder of the counts
    mesh: str = ""  # sha256 of the part file, or how it begins
    units: str = ""  # how the part file is read: as --units, --density, --centre-of-mass
    density: str = ""
    centre_of_mass: str = ""
    body: str = ""  # which of several bodies in the part file: as --body
    names: str = ""  # path of the file that names the aspects, from the folder of the counts
    config: str = ""  # path of the bowl file, from the folder of the counts
    launch: str = ""  # what was done to the part: a name of ``recommended.LAUNCH_NAMES``
    surface: str = ""  # it landed on
    series: str = ""  # files of one series are summed up in one line
    who: str = ""
    when: str = ""
    source: str = ""  # where it was published
    note: str = ""

    @property
    def reading(self) -> dict[Any, Any]:
        """What the part file is read with, as keywords of ``feederscrew.part.load``."""
        values = {name: getattr(self, name) for name in ("units", "density", "centre_of_mass", "body")}
        return {name: value for name, value in values.items() if value}


NO_HEAD = Head()
HEAD_KEYS = tuple(field.name for field in fields(Head))


def parse_head(lines, where) -> tuple[Any, ...]:
    """Read the head from the comment lines above a table.

    Parameters
    ----------
    lines : sequence of (int, str)
        Number and text of each line that begins with '#'. What is not '# key: value' with a key of ``Head``
        is a comment.
    where : str
        The file, for the fault lines.

    Returns
    -------
    Head
    faults : list of FeederError
        A key given twice or without a value, a launch or a digest that is none.
    """
    values: dict[str, str] = {}
    faults = []
    for number, line in lines:
        match = HEAD_LINE.match(line.strip())
        if match is None:
            continue
        key = match[1].lower().replace(" ", "_").replace("-", "_")
        if key not in HEAD_KEYS:
            continue
        fault = _fault(f"{where}:{number}", key, match[2], values)
        if fault:
            faults.append(fault)
        else:
            value = match[2]
            digest = DIGEST.fullmatch(value) if key == "mesh" else None
            values[key] = value if digest is None else digest[1].lower()
    return Head(**values), faults


def _fault(where, key, value, choices) -> FeederError | None:
    """What is wrong with one line of the head, or None."""
    if key in choices:
        return FeederError(where, f"{key} is given twice", "keep one of them")
    if not value:
        return FeederError(where, f"{key} has no value", "give one, or remove the line")
    if len(value) > MAX_VALUE_LETTERS:
        return FeederError(where, f"{key} is longer than {MAX_VALUE_LETTERS} letters", "say it shorter")
    if key == "launch" and value not in LAUNCH_NAMES:
        return FeederError(
            where, f"there is no launch {quantity_text(value)}", hint(value, list(LAUNCH_NAMES))
        )
    if key == "mesh" and not DIGEST.fullmatch(value):
        what = f"mesh: {quantity_text(value)} is not a sha256"
        return FeederError(where, what, "give its hexadecimal digits, at least 8, as in run.json")
    return None


MAX_COUNTS_BYTES = 1_000_000  # [bytes] a thousand aspects in a hundred columns
MAX_ROWS, MAX_COLUMNS = 10_000, 200
MAX_FAULTS_LISTED = 20  # faults of one file that are shown
COUNTS_EXAMPLE = "give a header 'aspect,counts' and one row an aspect"


class FaultList:
    """The first faults of a file, and how many more there are."""

    def __init__(self, where) -> None:
        self.where, self.more = where, 0
        self.kept: list[Any] = []

    def add(self, where, what, mend) -> None:
        """Keep a fault; ``mend`` may be a function, asked only where the fault is kept."""
        if len(self.kept) < MAX_FAULTS_LISTED:
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


def read_count_text(path) -> tuple[str, ...]:
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
    data = documents.content(path, MAX_COUNTS_BYTES, "a CSV file of counts", FeederError)
    if len(data) > MAX_COUNTS_BYTES:
        what = f"has more than {MAX_COUNTS_BYTES // 1_000_000} MB"
        raise FeederError(path, what, "name a CSV file with one row an aspect")
    return documents.decoded(data, str(path)), hashlib.sha256(data).hexdigest()


def parse_count_sheet(text, where) -> CountSheet:
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
    if len(table) > MAX_ROWS:
        raise FeederError(where, f"has more than {MAX_ROWS} rows", "give one row an aspect")
    if not table:
        raise FeederError(where, "is empty", COUNTS_EXAMPLE)
    first, header = table[0]
    names = split_cells(where, first, header)
    if len(names) > MAX_COLUMNS:
        raise FeederError(f"{where}:{first}", f"has more than {MAX_COLUMNS} columns", "split the file")
    head, faults = parse_head([line for line in lines if line[0] < first], where)
    if faults:
        raise Faults(faults[:MAX_FAULTS_LISTED])
    return CountSheet(
        head, first, tuple(names), tuple((k, split_cells(where, k, line)) for k, line in table[1:])
    )


def split_cells(where, number, line, mend=COUNTS_EXAMPLE) -> list[str]:
    """Return the cells of one line of CSV; raises a FeederError that ends in ``mend`` if it is none."""
    try:
        return [cell.strip() for cell in next(csv.reader([line]), [])]
    except csv.Error as error:
        raise FeederError(f"{where}:{number}", f"is not CSV ({error})", mend) from None
