"""Probability profiles: of the rules, of measured counts by aspect, and of counts by device."""

import re
from dataclasses import dataclass
from typing import Any

import numpy as np

from feederscrew import check
from feederscrew.documents import hint
from feederscrew.errors import Faults, FeederError
from feederscrew.resting.counts import count_files
from feederscrew.resting.counts.count_files import COUNTS_EXAMPLE, NO_HEAD, FaultList, Head
from feederscrew.units import quantity_text

SUM_TOLERANCE = 0.005  # of the whole: how far printed fractions may miss their sum
COLUMN_SUM = {"counts": 0.0, "fractions": 1.0, "percent": 100.0}  # what a column sums to; counts, to anything
DROPPED = ("height_mm", "count")  # columns by which a table of ``feeder drop`` is known
BY_ASPECT, BY_ORIENTATION, BY_DEVICE = (
    "aspect",
    "orientation",
    "device",
)  # what a file counts by: its first column
INTEGER = re.compile(r"\+?\d+", re.ASCII)
FULL_TURN = 360.0  # [deg]
MAX_PARTS_COUNTED = 1e12  # of a count
MAX_COUNT_NAME_LETTERS = 40  # of a column's name in a message
DECIMAL_PATTERN = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?", re.ASCII)


@dataclass(frozen=True, eq=False)
class AspectProfile:
    """One number for each aspect of a part."""

    name: str
    kind: str  # 'rule', 'counts', 'fractions' or 'percent'
    values: np.ndarray  # (A,) as given
    fractions: np.ndarray  # (A,) [1] of counts; else as given, not made to sum to 1

    @property
    def counted(self) -> bool:
        """Whether the values are counts, which a test needs."""
        return self.kind == "counts"


@dataclass(frozen=True, eq=False)
class Measured:
    """The profiles of one file."""

    source: str  # the path as given
    sha256: str  # of the file's bytes
    profiles: tuple[AspectProfile, ...]
    head: Head = NO_HEAD
    lying: tuple[tuple[str, float], ...] = ()  # (M,) aspect and heading [rad] where it counts orientations
    by_orientation: np.ndarray | None = None  # (M, profiles) as given

    def warnings(self, part) -> tuple[Any, ...]:
        """Say, a sentence each, where the head was not written for a part."""
        return of_another_part(self.source, self.head, part)

    @property
    def notes(self) -> tuple[str, ...]:
        """What the columns were taken for, a line a kind."""
        document = {kind: [_name_with_sum(p) for p in self.profiles if p.kind == kind] for kind in COLUMN_SUM}
        return tuple(
            f"{self.source}: {kind}: {', '.join(names)}" for kind, names in document.items() if names
        )


def of_another_part(source, head, part) -> tuple[Any, ...]:
    """Say, a sentence each, where the head of a file was not written for a part."""
    digest = part.file_sha256 if head.body and part.file_sha256 else part.sha256
    if digest.startswith(head.mesh):
        return ()
    sentence = f"{source}: counted with another part file: its mesh is {head.mesh[:8]}"
    return (f"{sentence}, that of {part.source} {part.sha256[:8]}",)


def of_rules(aspects) -> tuple[Any, ...]:
    """Return the profile of every rule over the stable aspects.

    Parameters
    ----------
    aspects : Aspects

    Returns
    -------
    tuple of AspectProfile
        Named as the thesis's tables do: 'PMI', 'CSA', 'STABILITY'. A rule that a part card gives no
        data for is left out.
    """
    chosen = {rule: p[aspects.stable] for rule, p in aspects.probabilities.items()}
    return tuple(_profile(rule.upper(), "rule", p) for rule, p in chosen.items() if np.isfinite(p).all())


def answer_profile(shares) -> AspectProfile:
    """Return the profile of the recommended answer, (A,) [1]."""
    return _profile("recommended", "rule", shares)


def read_profile(path, names, taken=()) -> Measured:
    """Read the profiles of a CSV file: first column the aspect, then one column a profile.

    Parameters
    ----------
    path : str or Path
        As the user typed it; faults repeat it.
    names : sequence of str
        Of the part's aspects; the profiles come in this order.
    taken : sequence of str
        Names no column may have: the rules'.

    Returns
    -------
    Measured

    Raises
    ------
    FeederError
        Faults of the file, each with its line.
    """
    text, sha256 = count_files.read_count_text(path)
    return measured(count_files.parse_count_sheet(text, str(path)), str(path), sha256, names, taken)


def parse_profile(text, where, names, taken=()) -> tuple[Any, ...]:
    """Read the profiles of a CSV text, as ``measured`` does."""
    return measured(count_files.parse_count_sheet(text, where), where, "", names, taken).profiles


def measured(table, where, sha256, names, taken=()) -> Measured:
    """Understand the table of a file of counts.

    Parameters
    ----------
    table : CountSheet
        Whole numbers are counts; fractions sum to 1 and percents to 100, both within ``SUM_TOLERANCE`` of the
        whole. Of a table of ``feeder drop`` only the counts are taken. Rows are aspects or, where the first
        column is 'orientation', aspects at a heading in degrees: 'A@180'.
    where : str
        The file, for the fault lines.
    sha256 : str
        Of its bytes.
    names : sequence of str
        Of the part's aspects.
    taken : sequence of str
        Names no column may have: the rules'.

    Returns
    -------
    Measured
        Orientations summed up by aspect, and as they are.

    Raises
    ------
    FeederError
        Faults of the text, each with its line; the first of many.
    """
    header, rows = _counted(table)
    line = f"{where}:{table.first}"
    columns = _columns(line, header, taken)
    cells: dict[Any, tuple[int, list[str]]] = {}  # by aspect and heading: line and texts
    by, faults = header[0].lower(), FaultList(where)
    for number, row in rows:
        key = _row(f"{where}:{number}", row, columns, cells, names, by, faults)
        cells.setdefault(key, (number, row[1:]))
    if missing := [name for name in names if name not in {key[0] for key in cells if key}]:
        faults.add(where, f"has no row for aspect {', '.join(missing)}", "add it, 0 if never seen")
    faults.raise_any()
    lying = [(name, turn) for name in names for aspect, turn in cells if aspect == name]
    texts = list(zip(*(cells[key][1] for key in lying), strict=True))
    profiles = _profiles(line, columns, texts)
    if by == BY_ASPECT:
        return Measured(where, sha256, profiles, table.head)
    rows = np.array([names.index(name) for name, _ in lying])
    values = np.column_stack([profile.values for profile in profiles])
    together = tuple(_by_aspect(profile, rows, len(names)) for profile in profiles)
    return Measured(where, sha256, together, table.head, tuple(lying), check.frozen(values))


def _profiles(where, columns, texts) -> tuple[Any, ...]:
    columns_read = [_measured(where, name, column) for name, column in zip(columns, texts, strict=True)]
    if faults := [entry for entry in columns_read if isinstance(entry, FeederError)]:
        raise Faults(faults[: count_files.MAX_FAULTS_LISTED])
    return tuple(columns_read)


def _by_aspect(profile, rows, count) -> AspectProfile:
    """A profile over orientations, summed up over the headings of each aspect."""
    values, fractions = (np.bincount(rows, of, minlength=count) for of in (profile.values, profile.fractions))
    return AspectProfile(profile.name, profile.kind, check.frozen(values), check.frozen(fractions))


def _counted(table) -> tuple[Any, ...]:
    """Header and rows; of our own ``drop.csv`` its first column and its counts."""
    if table.header[1:3] != DROPPED:
        return table.header, table.rows
    rows = [(number, [row[0], *row[2:3]]) for number, row in table.rows]
    return (table.header[0], *table.header[2:3]), rows


def _columns(where, header, taken) -> list[str]:
    """The profiles' names."""
    first, *columns = header
    if ";" in first or "\t" in first:
        raise FeederError(where, "the columns are not separated by commas", "separate them by commas")
    if first.lower() == BY_DEVICE:
        what = "counts by device, which does not say how often the part lies on each aspect"
        raise FeederError(where, what, "give counts by aspect or by orientation")
    if first.lower() not in (BY_ASPECT, BY_ORIENTATION):
        raise FeederError(where, f"the first column is {quantity_text(first)}, not aspect", COUNTS_EXAMPLE)
    if not columns:
        raise FeederError(where, "has no profile", COUNTS_EXAMPLE)
    if "" in columns:
        raise FeederError(where, "a column has no name", "give each its own name")
    if double := next((name for name in columns if columns.count(name) > 1), None):
        raise FeederError(where, f"two columns are called {quantity_text(double)}", "give each its own name")
    if rule := next((name for name in columns if name in taken), None):
        raise FeederError(
            where, f"column {quantity_text(rule)} has the name of a rule", "give it another name"
        )
    return columns


def _row(where, row, columns, cells, names, by, faults) -> tuple[Any, ...] | None:
    """Aspect and heading of a row, None where it has none; what is wrong is added to ``faults``."""
    name, values = row[0], row[1:]
    key = (name, None) if by == BY_ASPECT else _oriented(where, name, faults)
    if key is None:
        return None
    if key[0] not in names:
        faults.add(
            where, f"the part has no aspect {quantity_text(key[0])}", lambda: hint(key[0], list(names))
        )
        return None
    if key in cells:
        faults.add(
            where, f"{by} {quantity_text(name)} is already in line {cells[key][0]}", "keep one of them"
        )
    elif len(values) != len(columns):
        what = f"has {len(values)} value{'s' * (len(values) != 1)}, the header names {len(columns)}"
        faults.add(where, what, "give one value a column")
    else:
        for column, value in zip(columns, values, strict=True):
            _judge_aspect_row(where, column, value, faults)
    return key


def _oriented(where, name, faults) -> tuple[str, float] | None:
    """Aspect and heading [rad] of 'A@180'; None where it is not of that form."""
    aspect, _, degrees = name.rpartition("@")
    if not aspect or not DECIMAL_PATTERN.fullmatch(degrees) or not abs(float(degrees)) <= FULL_TURN:
        what = f"{quantity_text(name)} is not an aspect at a heading"
        faults.add(where, what, "write it as feeder tooling does: A@180")
        return None
    return aspect, float(np.radians(float(degrees)))


def _judge_aspect_row(where, column, value, faults) -> None:
    what = f"{column[:MAX_COUNT_NAME_LETTERS]}: {quantity_text(value)}"
    if not DECIMAL_PATTERN.fullmatch(value):
        faults.add(where, f"{what} is not a number", "write digits with a decimal point")
    elif float(value) < 0.0:
        faults.add(where, f"{what} is negative", "give a number from 0")
    elif float(value) > MAX_PARTS_COUNTED:
        faults.add(where, f"{what} is too large", f"give a number up to {MAX_PARTS_COUNTED:g}")


def _measured(where, name, texts) -> Any:
    """One column as a profile, or the fault that keeps it from being one."""
    values = np.array([float(text) for text in texts])
    total = values.sum()
    if total == 0.0:
        return FeederError(
            where, f"column {quantity_text(name)} holds only zeros", "give at least one count above 0"
        )
    if all(INTEGER.fullmatch(text) for text in texts) and total != 1.0:
        return _profile(name, "counts", values, total)
    for kind, whole in COLUMN_SUM.items():
        if abs(total - whole) <= SUM_TOLERANCE * whole:
            return _profile(name, kind, values, whole)
    what = f"column {quantity_text(name)} sums to {total:.6g}"
    return FeederError(where, what, "give whole counts, fractions that sum to 1 or percents that sum to 100")


def _name_with_sum(profile) -> str:
    """A column's name, with its sum where that is not understood."""
    total = profile.values.sum()
    return (
        profile.name if abs(total - COLUMN_SUM[profile.kind]) < 1e-9 else f"{profile.name} (sum {total:.6g})"
    )


def _profile(name, kind, values, whole=1.0) -> AspectProfile:
    return AspectProfile(name, kind, check.frozen(values), check.frozen(values / whole))


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
    def notes(self) -> tuple[Any, ...]:
        """What the file was taken for, one line."""
        return (f"{self.source}: parts at {len(self.names)} device{'s' * (len(self.names) != 1)}",)

    def warnings(self, part) -> tuple[Any, ...]:
        """Say, a sentence each, where the head was not written for a part."""
        return of_another_part(self.source, self.head, part)


def counts_by_device(table) -> bool:
    """Return whether a CountSheet counts by device."""
    return table.header[0].lower() == BY_DEVICE


def device_counts(table, where, sha256) -> DeviceCounts:
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
    faults = FaultList(where)
    for number, row in table.rows:
        _judge_device_row(f"{where}:{number}", row, columns, lines, faults)
        lines.setdefault(row[0], number)
    if not table.rows:
        faults.add(where, "has no device", PASSED_EXAMPLE)
    faults.raise_any()
    counts = np.array([[float(cell) for cell in row[1:]] for _, row in table.rows])
    passed, rejected = (check.frozen(counts[:, columns.index(name)]) for name in (PASSED, REJECTED))
    return DeviceCounts(where, sha256, tuple(lines.values()), tuple(lines), passed, rejected, table.head)


def read_device_counts(path) -> DeviceCounts:
    """Read the counts by device of a CSV file, as ``device_counts`` does."""
    text, sha256 = count_files.read_count_text(path)
    return device_counts(count_files.parse_count_sheet(text, str(path)), str(path), sha256)


def _judge_device_row(where, row, columns, lines, faults) -> None:
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
