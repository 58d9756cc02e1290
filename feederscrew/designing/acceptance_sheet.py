"""An acceptance sheet that was filled in at the machine, beside what was computed."""

import csv
import io
from dataclasses import dataclass
from pathlib import Path

from feederscrew import documents, units
from feederscrew.dropping.ensemble import wilson
from feederscrew.errors import FeederError

SHEET_COLUMNS = ("quantity", "fill", "computed", "low", "high", "unit", "measured", "sample")
TEXT = ("quantity", "fill", "unit")  # columns that are no numbers
RATE, YIELD, JAMS = "good parts at the discharge", "yield, good of what leaves", "jams"
MAX_BYTES, MAX_HEAD_BYTES = 200_000, 1000  # of a sheet; of its first line
SAMPLE = 100  # parts, where the sheet does not say how many were looked at
UNBOUNDED_TOLERANCE = 0.1  # [1] of a computed value without ends, from which a measured one is another


@dataclass(frozen=True)
class SheetLine:
    """One line of the sheet."""

    quantity: str
    fill: str
    computed: float
    low: float | None
    high: float | None
    unit: str
    measured: float | None  # None where nobody measured
    sample: float | None  # parts, or seconds

    @property
    def ends(self) -> tuple[float, float]:
        """Ends within which the measured value agrees: those of the sheet, or of a sample of its size."""
        low, high = self.low, self.high
        if self.quantity == YIELD:
            sample = self.sample or SAMPLE
            return 100.0 * float(wilson([0.01 * self.computed * sample], sample)[0][0]), 100.0
        if low is None and high is None:
            return (1.0 - UNBOUNDED_TOLERANCE) * self.computed, (1.0 + UNBOUNDED_TOLERANCE) * self.computed
        return (0.0 if low is None else low), (float("inf") if high is None else high)

    @property
    def agrees(self) -> bool | None:
        """Whether it does what was computed, or better; None where nobody measured."""
        if self.measured is None:
            return None
        low, high = self.ends
        if self.quantity in (RATE, YIELD):  # more is no fault
            return self.measured >= low
        return self.measured <= high if self.quantity == JAMS else low <= self.measured <= high


def is_sheet(path: str | Path) -> bool:
    """Return whether a file is an acceptance sheet, by its first line."""
    try:
        with Path(path).open("rb") as file:
            first = file.read(MAX_HEAD_BYTES).decode("utf-8-sig", errors="replace").splitlines()
        return tuple(cell.strip() for cell in next(csv.reader(first[:1]), ())) == SHEET_COLUMNS
    except (OSError, csv.Error):
        return False


def sheet(path: str | Path) -> tuple[SheetLine, ...]:
    """Read an acceptance sheet, as ``feeder design`` writes it and someone has filled it in.

    Raises FeederError if it cannot be read or is too large, a number is not one, or nothing was measured.
    """
    data = documents.content(path, MAX_BYTES, "an acceptance sheet", FeederError)
    if len(data) > MAX_BYTES:
        raise FeederError(path, f"has more than {MAX_BYTES // 1000} kB", "give an acceptance sheet")
    lines = []
    try:
        text = io.StringIO(documents.decoded(data, str(path)), newline="")
        for place, row in enumerate(csv.DictReader(text), start=2):
            texts: dict = {name: units.printable((row.get(name) or "").strip()) for name in TEXT}
            values: dict = {n: _number(path, place, n, row.get(n)) for n in SHEET_COLUMNS if n not in TEXT}
            if values["computed"] is None:
                raise FeederError(f"{path}:{place}", "has no computed value", "leave that column as it was")
            lines.append(SheetLine(**texts, **values))
    except csv.Error as error:
        raise FeederError(path, f"is not CSV ({error})", "check its quotes and commas") from None
    if all(line.measured is None for line in lines):
        raise FeederError(str(path), "nothing was measured", "fill in the column 'measured'")
    return tuple(lines)


def _number(path: str | Path, place: int, name: str, text: str | None) -> float | None:
    """A cell as a number; None where it is empty."""
    if text is None or not text.strip():
        return None
    try:
        return units.decimal(text.replace(",", "."))
    except units.QuantityError as fault:
        mend = "write a number alone, the unit is in its own column"
        raise FeederError(f"{path}:{place}", f"{name}: {fault.what}", mend) from fault
