"""Counts by device, as a feeding test gives them: how many parts passed each, how many it rejected."""

from dataclasses import dataclass

import numpy as np

from feederscrew import check
from feederscrew.errors import FeederError
from feederscrew.resting.counts import count_rows
from feederscrew.resting.counts.count_rows import Few
from feederscrew.resting.counts.head import NO_HEAD, Head
from feederscrew.resting.counts.profiles import DEVICE, INTEGER, MAX_PARTS_COUNTED, of_another_part
from feederscrew.units import quantity_text

PASSED, REJECTED = "passed", "rejected"  # the columns after the device, in either order
PASSED_EXAMPLE = "give a header 'device,passed,rejected' and one row a device"


@dataclass(frozen=True, eq=False)
class DeviceCounts:
    """One feeding test; D devices that were counted, in the order of the file."""

    source: str  # the path as given
    sha256: str  # of the file's bytes
    lines: tuple[int, ...]  # (D,) of the file
    names: tuple[str, ...]  # (D,) as written
    passed: np.ndarray  # (D,) parts that went on
    rejected: np.ndarray  # (D,) parts that went back into the bowl
    head: Head = NO_HEAD

    @property
    def shares(self):
        """(D,) [1] share that passed, of the parts that came."""
        return self.passed / (self.passed + self.rejected)

    @property
    def notes(self):
        """What the file was taken for, one line."""
        return (f"{self.source}: parts at {len(self.names)} device{'s' * (len(self.names) != 1)}",)

    def warnings(self, part):
        """Say, a sentence each, where the head was not written for a part."""
        return of_another_part(self.source, self.head, part)


def by_device(table) -> bool:
    """Return whether a CountSheet counts by device."""
    return table.header[0].lower() == DEVICE


def device_counts(table, where, sha256):
    """Understand the table of a feeding test.

    Parameters
    ----------
    table : CountSheet
        A device a row, whole numbers of the parts that passed and that were rejected.
    where : str
        The file, for the fault lines.
    sha256 : str
        Of its bytes.

    Returns
    -------
    DeviceCounts

    Raises
    ------
    FeederError
        Faults of the text, each with its line; the first of many.
    """
    columns = tuple(name.lower() for name in table.header[1:])
    if sorted(columns) != [PASSED, REJECTED]:
        result = ", ".join(table.header[1:]) or "missing"
        raise FeederError(
            f"{where}:{table.first}", f"the columns after device are {result:.60}", PASSED_EXAMPLE
        )
    lines: dict[str, int] = {}
    faults = Few(where)
    for number, row in table.rows:
        _judge(f"{where}:{number}", row, columns, lines, faults)
        lines.setdefault(row[0], number)
    if not table.rows:
        faults.add(where, "has no device", PASSED_EXAMPLE)
    faults.raise_any()
    counts = np.array([[float(cell) for cell in row[1:]] for _, row in table.rows])
    passed, rejected = (check.frozen(counts[:, columns.index(name)]) for name in (PASSED, REJECTED))
    return DeviceCounts(where, sha256, tuple(lines.values()), tuple(lines), passed, rejected, table.head)


def read(path):
    """Read the counts by device of a CSV file, as ``device_counts`` does."""
    text, sha256 = count_rows.content(path)
    return device_counts(count_rows.parse(text, str(path)), str(path), sha256)


def _judge(where, row, columns, lines, faults) -> None:
    """Add what is wrong with a row to ``faults``."""
    name, cells = row[0], row[1:]
    if name in lines:
        faults.add(
            where, f"device {quantity_text(name)} is already in line {lines[name]}", "keep one of them"
        )
    elif len(cells) != len(columns):
        what = f"has {len(cells)} value{'s' * (len(cells) != 1)} after the device"
        faults.add(where, what, "give the parts that passed and those that were rejected")
    elif odd := [
        f"{column}: {quantity_text(cell)}" for column, cell in zip(columns, cells) if not _whole(cell)
    ]:
        faults.add(
            where, f"{odd[0]} is not a number of parts", f"give a whole number up to {MAX_PARTS_COUNTED:g}"
        )
    elif not any(float(cell) for cell in cells):
        faults.add(where, f"no part came to device {quantity_text(name)}", "remove the row")


def _whole(cell):
    return INTEGER.fullmatch(cell) is not None and float(cell) <= MAX_PARTS_COUNTED
