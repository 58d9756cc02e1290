"""Probability profiles: of the rules, of counts by aspect and by device; the CSV files of counts."""

import csv
import hashlib
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields
from functools import partial
from os import PathLike
from pathlib import Path

import numpy as np

from feederscrew.base import check, documents
from feederscrew.base.arrays import Floats
from feederscrew.base.columns import Column
from feederscrew.base.documents import hint
from feederscrew.base.errors import Faults, FeederError
from feederscrew.base.signatures import Keywords
from feederscrew.base.units import counted, quantity_text
from feederscrew.part.record import Part
from feederscrew.resting.aspects import Aspects
from feederscrew.resting.rules.recommended import LAUNCH_NAMES

HEAD_LINE = re.compile(r"#\s*([A-Za-z_ -]{1,30}?)\s*:\s*(.*)")
DIGEST = re.compile(r"(?:sha256:)?([0-9a-f]{8,64})", re.IGNORECASE)
MAX_VALUE_LETTERS = 500  # letters of a value
MAX_COUNTS_BYTES = 1_000_000  # [bytes] a thousand aspects in a hundred columns
MAX_ROWS = 10_000
MAX_COLUMNS = 200
MAX_FAULTS_LISTED = 20  # faults of one file that are shown
COUNTS_EXAMPLE = "give a header 'aspect,counts' and one row an aspect"


@dataclass(frozen=True)
class Head:
    """Lines '# key: value' at the head of a file of counts; empty where they are silent."""

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
    def reading(self) -> Keywords:
        """Return the keywords of ``feederscrew.part.load`` with which the part file is read."""
        values = {name: getattr(self, name) for name in ("units", "density", "centre_of_mass", "body")}
        return {name: value for name, value in values.items() if value}


NO_HEAD = Head()
HEAD_KEYS = tuple(field.name for field in fields(Head))


class FaultList:
    """The first faults of a file, and how many more there are."""

    def __init__(self, where: str) -> None:
        self.where, self.more = where, 0
        self.faults: list[FeederError] = []

    def add(self, where: str, what: str, mend: str | Callable[[], str]) -> None:
        """Add a fault; ``mend`` may be a function, asked only where the fault is listed."""
        if len(self.faults) < MAX_FAULTS_LISTED:
            self.faults.append(FeederError(where, what, mend() if callable(mend) else mend))
        else:
            self.more += 1

    def raise_any(self) -> None:
        """Raise all faults in one go; return if there is none."""
        if self.more:
            self.faults.append(FeederError(self.where, f"and {self.more} more faults", "mend these first"))
        if self.faults:
            raise Faults(self.faults)


@dataclass(frozen=True)
class CountSheet:
    """The table of one file, and the head above it."""

    head: Head
    first: int  # line of the header
    header: tuple[str, ...]
    rows: tuple[tuple[int, list[str]], ...]  # number of the line, and its cells


def read_count_text(path: str | PathLike[str]) -> tuple[str, str]:
    """Return the text of a file of counts and the sha256 of its bytes.

    Parameters
    ----------
    path : str or path

    Returns
    -------
    text : str
    sha256 : str

    Raises
    ------
    FeederError
        Which repeats the path as typed, if it cannot be read, is too large or not UTF-8.
    """
    if documents.found_as(Path.is_dir, path):
        raise FeederError(path, "cannot be read (Is a directory)", "name a CSV file of counts in it")
    data = documents.content(path, MAX_COUNTS_BYTES, "a CSV file of counts", FeederError)
    if len(data) > MAX_COUNTS_BYTES:
        what = f"has more than {MAX_COUNTS_BYTES // 1_000_000} MB"
        raise FeederError(path, what, "name a CSV file with one row an aspect")
    return documents.decoded(data, str(path)), hashlib.sha256(data).hexdigest()


def parse_count_sheet(text: str, where: str) -> CountSheet:
    """Split the text of a file of counts into its head and its rows.

    Lines that begin with '#' are comments. Above the header a comment '# key: value' with a key of ``Head``
    is part of the head.

    Parameters
    ----------
    text : str
    where : str
        Name of the file in fault lines.

    Returns
    -------
    CountSheet

    Raises
    ------
    FeederError
        If the text is empty, not CSV, or has too many rows or columns, or for faults of the head.
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
    # what is not '# key: value' with a key of ``Head`` is a comment
    values: dict[str, str] = {}
    faults: list[tuple[str, str, str]] = []
    for number, line in lines:
        match = HEAD_LINE.match(line.strip()) if number < first else None
        key = match[1].lower().replace(" ", "_").replace("-", "_") if match else ""
        if match is None or key not in HEAD_KEYS:
            continue
        value, place, digest = match[2], f"{where}:{number}", DIGEST.fullmatch(match[2])
        if key in values:
            faults.append((place, f"{key} is given twice", "keep one of them"))
        elif not value:
            faults.append((place, f"{key} has no value", "give one, or remove the line"))
        elif len(value) > MAX_VALUE_LETTERS:
            faults.append((place, f"{key} is longer than {MAX_VALUE_LETTERS} letters", "say it shorter"))
        elif key == "launch" and value not in LAUNCH_NAMES:
            what = f"there is no launch {quantity_text(value)}"
            faults.append((place, what, hint(value, list(LAUNCH_NAMES))))
        elif key == "mesh" and not digest:
            what = f"mesh: {quantity_text(value)} is not a sha256"
            faults.append((place, what, "give its hexadecimal digits, at least 8, as in run.json"))
        else:
            values[key] = digest[1].lower() if key == "mesh" and digest else value
    if faults:
        raise Faults([FeederError(*fault) for fault in faults[:MAX_FAULTS_LISTED]])
    rows = tuple((k, split_cells(where, k, line)) for k, line in table[1:])
    return CountSheet(Head(**values), first, tuple(names), rows)


def split_cells(where: str, number: int, line: str, mend: str = COUNTS_EXAMPLE) -> list[str]:
    """Return the cells of one line of CSV.

    Parameters
    ----------
    where : str
        Name of the file in a fault line.
    number : int
        Number of the line.
    line : str
    mend : str
        How to mend the fault.

    Returns
    -------
    list of str
        Without spaces around them.

    Raises
    ------
    FeederError
        If the line is not CSV.
    """
    try:
        return [cell.strip() for cell in next(csv.reader([line]), [])]
    except csv.Error as error:
        raise FeederError(f"{where}:{number}", f"is not CSV ({error})", mend) from None


SUM_TOLERANCE = 0.005  # of the whole: how far printed fractions may miss their sum
COLUMN_SUM = {"counts": 0.0, "fractions": 1.0, "percent": 100.0}  # what a column sums to; counts, to anything
DROPPED = ("height_mm", "count")  # columns by which a table of ``feeder drop`` is known
# the first column says what a table counts by
BY_ASPECT = "aspect"
BY_ORIENTATION = "orientation"
BY_DEVICE = "device"
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
    values: Floats  # (A,) as given
    fractions: Floats  # (A,) [1] of counts; else as given, not made to sum to 1

    @property
    def has_counts(self) -> bool:
        """Return whether the values are counts, which a test needs."""
        return self.kind == "counts"


PROFILE_COLUMNS: tuple[Column[AspectProfile], ...] = (
    Column("name", lambda profile: profile.name),
    Column("kind", lambda profile: profile.kind),
    Column("values", lambda profile: profile.values),
    Column("fractions", lambda profile: profile.fractions),
)


@dataclass(frozen=True, eq=False)
class CountFile:
    """The profiles of one file."""

    source: str  # the path as given
    sha256: str  # of the file's bytes
    profiles: tuple[AspectProfile, ...]
    head: Head = NO_HEAD
    orientations: tuple[tuple[str, float], ...] = ()  # (M,) aspect and heading [rad]
    by_orientation: Floats | None = None  # (M, profiles) as given

    def warnings(self, part: Part) -> tuple[str, ...]:
        """Return a sentence each where the head was not written for a part."""
        return mesh_warnings(self.source, self.head, part)

    @property
    def notes(self) -> tuple[str, ...]:
        """Return how the columns were understood, a line a kind."""
        notes = []
        for kind, whole in COLUMN_SUM.items():
            sums = {profile.name: profile.values.sum() for profile in self.profiles if profile.kind == kind}
            names = [f"{n} (sum {s:.6g})" if abs(s - whole) >= 1e-9 else n for n, s in sums.items()]
            notes += [f"{self.source}: {kind}: {', '.join(names)}"] if names else []
        return tuple(notes)


def mesh_warnings(source: str, head: Head, part: Part) -> tuple[str, ...]:
    """Return a sentence where the head of a file was not written for a part.

    Parameters
    ----------
    source : str
        Name of the file.
    head : Head
    part : Part

    Returns
    -------
    tuple of str
        One sentence, or no sentence.
    """
    digest = part.file_sha256 if head.body and part.file_sha256 else part.sha256
    if digest.startswith(head.mesh):
        return ()
    sentence = f"{source}: counted with another part file: its mesh is {head.mesh[:8]}"
    return (f"{sentence}, that of {part.source} {part.sha256[:8]}",)


def rule_profiles(aspects: Aspects) -> tuple[AspectProfile, ...]:
    """Return the profile of every rule over the stable aspects, as the thesis names it: 'PMI', 'CSA'.

    Parameters
    ----------
    aspects : Aspects

    Returns
    -------
    tuple of AspectProfile
        Without rules for which a part card gives no data.
    """
    chosen = {rule: p[aspects.stable] for rule, p in aspects.probabilities.items()}
    return tuple(profile_of(rule.upper(), "rule", p) for rule, p in chosen.items() if np.isfinite(p).all())


def read_profile(path: str | PathLike[str], names: Sequence[str]) -> CountFile:
    """Read the profiles of a CSV file: the aspect, then one column a profile; as in ``parse_profiles``.

    Parameters
    ----------
    path : str or Path
    names : sequence of str
        Aspects of the part.

    Returns
    -------
    CountFile

    Raises
    ------
    FeederError
        If the file cannot be read, or for faults of its text.
    """
    text, sha256 = read_count_text(path)
    return parse_profiles(parse_count_sheet(text, str(path)), str(path), sha256, names)


def parse_profiles(
    table: CountSheet, where: str, sha256: str, names: Sequence[str], rule_names: Sequence[str] = ()
) -> CountFile:
    """Return the profiles of a table of counts: orientations summed up by aspect, and as they are.

    Whole numbers are counts; fractions sum to 1 and percents to 100, both within ``SUM_TOLERANCE`` of the
    whole. Of a table of ``feeder drop`` only the counts are taken. Rows are aspects or, where the first
    column is 'orientation', aspects at a heading in degrees: 'A@180'.

    Parameters
    ----------
    table : CountSheet
    where : str
        Name of the file in fault lines.
    sha256 : str
        Of the file's bytes.
    names : sequence of A str
        Aspects of the part; the profiles come in this order.
    rule_names : sequence of str
        Names that no column may have: those of the rules.

    Returns
    -------
    CountFile

    Raises
    ------
    FeederError
        For faults of the text, each with its line; the first of many.
    """
    header, rows = table.header, table.rows
    if header[1:3] == DROPPED:  # of our own drop.csv its first column and its counts
        header = (header[0], *header[2:3])
        rows = tuple((number, [row[0], *row[2:3]]) for number, row in rows)
    line = f"{where}:{table.first}"
    columns = _columns(line, header, rule_names)
    cells: dict[tuple[str, float | None], tuple[int, list[str]]] = {}  # by aspect and heading: line and texts
    by, faults = header[0].lower(), FaultList(where)
    for number, (name, *values) in rows:
        place, aspect, heading = f"{where}:{number}", name, None
        if by != BY_ASPECT:
            aspect, _, degrees = name.rpartition("@")
            if not aspect or not DECIMAL_PATTERN.fullmatch(degrees) or not abs(float(degrees)) <= FULL_TURN:
                what = f"{quantity_text(name)} is not an aspect at a heading"
                faults.add(place, what, "write it as feeder tooling does: A@180")
                continue
            heading = float(np.radians(float(degrees)))
        if aspect not in names:
            what = f"the part has no aspect {quantity_text(aspect)}"
            faults.add(place, what, partial(hint, aspect, list(names)))
            continue
        key = aspect, heading
        if key in cells:
            what = f"{by} {quantity_text(name)} is already in line {cells[key][0]}"
            faults.add(place, what, "keep one of them")
        elif len(values) != len(columns):
            what = f"has {counted(len(values), 'value')}, the header names {len(columns)}"
            faults.add(place, what, "give one value a column")
        else:
            for column, value in zip(columns, values, strict=True):
                what = f"{column[:MAX_COUNT_NAME_LETTERS]}: {quantity_text(value)}"
                if not DECIMAL_PATTERN.fullmatch(value):
                    faults.add(place, f"{what} is not a number", "write digits with a decimal point")
                elif float(value) < 0.0:
                    faults.add(place, f"{what} is negative", "give a number from 0")
                elif float(value) > MAX_PARTS_COUNTED:
                    faults.add(place, f"{what} is too large", f"give a number up to {MAX_PARTS_COUNTED:g}")
        cells.setdefault(key, (number, values))
    if missing := [name for name in names if name not in {aspect for aspect, _ in cells}]:
        faults.add(where, f"has no row for aspect {', '.join(missing)}", "add it, 0 if never seen")
    faults.raise_any()
    orientations = [(name, turn) for name in names for aspect, turn in cells if aspect == name]
    texts = zip(*(cells[key][1] for key in orientations), strict=True)
    profiles = tuple(
        _profile_of_column(line, name, column, faults) for name, column in zip(columns, texts, strict=True)
    )
    faults.raise_any()
    if by == BY_ASPECT:
        return CountFile(where, sha256, profiles, table.head)
    own = np.array([names.index(name) for name, _ in orientations])
    headings = tuple((name, turn) for name, turn in orientations if turn is not None)
    as_given = np.column_stack([profile.values for profile in profiles])
    together = []  # summed up over the headings of each aspect
    for profile in profiles:
        sums = (np.bincount(own, of, minlength=len(names)) for of in (profile.values, profile.fractions))
        together.append(AspectProfile(profile.name, profile.kind, *map(check.frozen, sums)))
    return CountFile(where, sha256, tuple(together), table.head, headings, check.frozen(as_given))


def _columns(where: str, header: Sequence[str], rule_names: Sequence[str]) -> list[str]:
    """Return the profiles' names."""
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
    if rule := next((name for name in columns if name in rule_names), None):
        what = f"column {quantity_text(rule)} has the name of a rule"
        raise FeederError(where, what, "give it another name")
    return columns


def _profile_of_column(where: str, name: str, texts: Sequence[str], faults: FaultList) -> AspectProfile:
    """Return one column as a profile; faults that keep it from being one are added to ``faults``."""
    values = np.array([float(text) for text in texts])
    total = values.sum()
    if total == 0.0:
        what = f"column {quantity_text(name)} holds only zeros"
        faults.add(where, what, "give at least one count above 0")
    elif all(INTEGER.fullmatch(text) for text in texts) and total != 1.0:
        return profile_of(name, "counts", values, total)
    else:
        for kind, whole in COLUMN_SUM.items():
            if abs(total - whole) <= SUM_TOLERANCE * whole:
                return profile_of(name, kind, values, whole)
        what = f"column {quantity_text(name)} sums to {total:.6g}"
        faults.add(where, what, "give whole counts, fractions that sum to 1 or percents that sum to 100")
    return profile_of(name, "", values)


def profile_of(name: str, kind: str, values: Floats, whole: float = 1.0) -> AspectProfile:
    """Return a profile of values that are shares of a whole.

    Parameters
    ----------
    name : str
    kind : str
        As in ``AspectProfile``.
    values : (A,) float [any]
    whole : float [any]
        Sum of all shares.

    Returns
    -------
    AspectProfile
        Its fractions are ``values`` / ``whole`` [1].
    """
    return AspectProfile(name, kind, check.frozen(values), check.frozen(values / whole))


# the columns after the device, in either order
PASSED = "passed"
REJECTED = "rejected"
PASSED_EXAMPLE = "give a header 'device,passed,rejected' and one row a device"


@dataclass(frozen=True, eq=False)
class DeviceCounts:
    """One feeding test; D devices that were counted, in the order of the file."""

    source: str  # the path as given
    sha256: str  # of the file's bytes
    lines: tuple[int, ...]  # (D,) of the file
    names: tuple[str, ...]  # (D,) as written
    passed: Floats  # (D,) parts that went on
    rejected: Floats  # (D,) parts that went back into the bowl
    head: Head = NO_HEAD

    @property
    def shares(self) -> Floats:
        """Return the share (D,) [1] that passed, of the parts that came."""
        return self.passed / (self.passed + self.rejected)

    @property
    def notes(self) -> tuple[str, ...]:
        """Return how the file was understood, one line."""
        return (f"{self.source}: parts at {counted(len(self.names), 'device')}",)

    def warnings(self, part: Part) -> tuple[str, ...]:
        """Return a sentence each where the head was not written for a part."""
        return mesh_warnings(self.source, self.head, part)


def counts_by_device(table: CountSheet) -> bool:
    """Return whether a CountSheet counts by device."""
    return table.header[0].lower() == BY_DEVICE


def device_counts(table: CountSheet, where: str, sha256: str) -> DeviceCounts:
    """Return the parts of a feeding test: a device a row, whole numbers of the parts that passed or not.

    Parameters
    ----------
    table : CountSheet
    where : str
        Name of the file in fault lines.
    sha256 : str
        Of the file's bytes.

    Returns
    -------
    DeviceCounts
        D devices.

    Raises
    ------
    FeederError
        For faults of the text, each with its line; the first of many.
    """
    columns = tuple(name.lower() for name in table.header[1:])
    if sorted(columns) != [PASSED, REJECTED]:
        what = f"the columns after device are {', '.join(table.header[1:]) or 'missing':.60}"
        raise FeederError(f"{where}:{table.first}", what, PASSED_EXAMPLE)
    lines: dict[str, int] = {}
    faults = FaultList(where)
    for number, (name, *cells) in table.rows:
        place, title = f"{where}:{number}", f"device {quantity_text(name)}"
        odd = [
            f"{column}: {quantity_text(cell)}"
            for column, cell in zip(columns, cells)
            if not INTEGER.fullmatch(cell) or float(cell) > MAX_PARTS_COUNTED
        ]
        if name in lines:
            faults.add(place, f"{title} is already in line {lines[name]}", "keep one of them")
        elif len(cells) != len(columns):
            what = f"has {counted(len(cells), 'value')} after the device"
            faults.add(place, what, "give the parts that passed and those that were rejected")
        elif odd:
            mend = f"give a whole number up to {MAX_PARTS_COUNTED:g}"
            faults.add(place, f"{odd[0]} is not a number of parts", mend)
        elif not any(float(cell) for cell in cells):
            faults.add(place, f"no part came to {title}", "remove the row")
        lines.setdefault(name, number)
    if not table.rows:
        faults.add(where, "has no device", PASSED_EXAMPLE)
    faults.raise_any()
    counts = np.array([[float(cell) for cell in row[1:]] for _, row in table.rows])
    passed, rejected = (check.frozen(counts[:, columns.index(name)]) for name in (PASSED, REJECTED))
    return DeviceCounts(where, sha256, tuple(lines.values()), tuple(lines), passed, rejected, table.head)


def one_profile(measured: CountFile) -> AspectProfile:
    """Return the only column of counts of a file.

    Raises FeederError where it has several.
    """
    if len(measured.profiles) != 1:
        names = ", ".join(profile.name for profile in measured.profiles[:5])
        what = f"has {len(measured.profiles)} columns of shares ({names})"
        raise FeederError(measured.source, what, "leave one of them in the file")
    return measured.profiles[0]
