"""Probability profiles: what the rules give, and what somebody measured."""

import csv
import hashlib
import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from feederscrew import check
from feederscrew.documents import decoded, hint
from feederscrew.errors import Faults, FeederError
from feederscrew.units import shown

ROUNDING = 0.005  # of the whole: how far printed fractions may miss their sum
WHOLE = {"counts": 0.0, "fractions": 1.0, "percent": 100.0}  # what a column sums to; counts, to anything
DROPPED = ["height_mm", "count"]  # columns by which a table of ``feeder drop`` is known
EXAMPLE = "give a header 'aspect,counts' and one row an aspect"
INTEGER = re.compile(r"\+?\d+", re.ASCII)
DECIMAL = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?", re.ASCII)


@dataclass(frozen=True, eq=False)
class Profile:
    """One number for each aspect of a part."""

    name: str
    kind: str  # 'rule', 'counts', 'fractions' or 'percent'
    values: np.ndarray  # (A,) as given
    fractions: np.ndarray  # (A,) [1] of counts; else as given, not made to sum to 1

    @property
    def counted(self):
        """Whether the values are counts, which a test needs."""
        return self.kind == "counts"


@dataclass(frozen=True, eq=False)
class Measured:
    """The profiles of one file."""

    source: str  # the path as given
    sha256: str  # of the file's bytes
    profiles: tuple[Profile, ...]

    @property
    def notes(self):
        """What the columns were taken for, a line a kind."""
        told = {kind: [_told(p) for p in self.profiles if p.kind == kind] for kind in WHOLE}
        return tuple(f"{self.source}: {kind}: {', '.join(names)}" for kind, names in told.items() if names)


def of_rules(aspects):
    """Return the profile of every rule over the stable aspects.

    Parameters
    ----------
    aspects : Aspects

    Returns
    -------
    tuple of Profile
        Named as the thesis's tables do: 'PMI', 'CSA', 'STABILITY'. A rule that a part card gives no
        data for is left out.
    """
    chosen = {rule: p[aspects.stable] for rule, p in aspects.probabilities.items()}
    return tuple(_profile(rule.upper(), "rule", p) for rule, p in chosen.items() if np.isfinite(p).all())


def read(path, names, taken=()):
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
        Every fault of the file, each with its line.
    """
    try:
        data = Path(path).read_bytes()
    except FileNotFoundError:
        raise FeederError(path, "no such file", "check the path") from None
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise FeederError(path, f"cannot be read ({reason})", "check the path") from None
    found = parse(decoded(data, str(path)), str(path), names, taken)
    return Measured(str(path), hashlib.sha256(data).hexdigest(), found)


def parse(text, where, names, taken=()):
    """Read the profiles of a CSV text.

    Parameters
    ----------
    text : str
        Lines that open with '#' are comments. Whole numbers are counts; fractions sum to 1 and
        percents to 100, both within ``ROUNDING`` of the whole. Of a table of ``feeder drop`` only the
        counts are taken.
    where : str
        The file, for the fault lines.
    names : sequence of str
        Of the part's aspects.
    taken : sequence of str
        Names no column may have: the rules'.

    Returns
    -------
    tuple of Profile

    Raises
    ------
    FeederError
        Every fault of the text, each with its line.
    """
    lines = [(k, row) for k, row in _rows(text, where) if any(cell for cell in row)]
    if not lines:
        raise FeederError(where, "is empty", EXAMPLE)
    (first, header), *rows = _counted(lines)
    columns = _columns(f"{where}:{first}", header, taken)
    faults, cells = [], {}
    for number, row in rows:
        faults += _row_faults(f"{where}:{number}", row, columns, cells, names)
        cells.setdefault(row[0], (number, row[1:]))
    if missing := [name for name in names if name not in cells]:
        faults.append(
            FeederError(where, f"has no row for aspect {', '.join(missing)}", "add it, 0 if never seen")
        )
    if faults:
        raise Faults(faults)
    table = zip(*(cells[name][1] for name in names), strict=True)
    made = [_measured(f"{where}:{first}", name, column) for name, column in zip(columns, table, strict=True)]
    if faults := [entry for entry in made if isinstance(entry, FeederError)]:
        raise Faults(faults)
    return tuple(made)


def _rows(text, where):
    """Every row that is not a comment, with the number of its line."""
    lines = [(k, line) for k, line in enumerate(text.splitlines(), 1) if not line.lstrip().startswith("#")]
    try:
        return [(k, [cell.strip() for cell in next(csv.reader([line]), [])]) for k, line in lines]
    except csv.Error as error:
        raise FeederError(where, f"is not CSV ({error})", EXAMPLE) from None


def _counted(lines):
    """The lines of a file; of our own ``drop.csv`` its first column and its counts."""
    header = lines[0][1]
    if header[1:3] != DROPPED:
        return lines
    return [(number, [row[0], *row[2:3]]) for number, row in lines]


def _columns(where, header, taken):
    """The profiles' names."""
    first, *columns = header
    if ";" in first or "\t" in first:
        raise FeederError(where, "the columns are not separated by commas", "separate them by commas")
    if first.lower() != "aspect":
        raise FeederError(where, f"the first column is {shown(first)}, not aspect", EXAMPLE)
    if not columns:
        raise FeederError(where, "has no profile", EXAMPLE)
    if "" in columns:
        raise FeederError(where, "a column has no name", "give each its own name")
    if double := next((name for name in columns if columns.count(name) > 1), None):
        raise FeederError(where, f"two columns are called {shown(double)}", "give each its own name")
    if rule := next((name for name in columns if name in taken), None):
        raise FeederError(where, f"column {shown(rule)} has the name of a rule", "give it another name")
    return columns


def _row_faults(where, row, columns, cells, names):
    """What is wrong with one row."""
    name, values = row[0], row[1:]
    if name not in names:
        return [FeederError(where, f"the part has no aspect {shown(name)}", hint(name, list(names)))]
    if name in cells:
        what = f"aspect {shown(name)} is already in line {cells[name][0]}"
        return [FeederError(where, what, "keep one of them")]
    if len(values) != len(columns):
        what = f"has {len(values)} value{'s' * (len(values) != 1)}, the header names {len(columns)}"
        return [FeederError(where, what, "give one value a column")]
    found = [_value_fault(where, column, value) for column, value in zip(columns, values, strict=True)]
    return [fault for fault in found if fault]


def _value_fault(where, column, value):
    what = f"{column}: {shown(value)}"
    if not DECIMAL.fullmatch(value):
        return FeederError(where, f"{what} is not a number", "write digits with a decimal point")
    if float(value) < 0.0:
        return FeederError(where, f"{what} is negative", "give a number from 0")
    if not np.isfinite(float(value)):
        return FeederError(where, f"{what} is too large", "give a finite number")
    return None


def _measured(where, name, texts):
    """One column as a profile, or the fault that keeps it from being one."""
    values = np.array([float(text) for text in texts])
    total = values.sum()
    if total == 0.0:
        return FeederError(where, f"column {shown(name)} holds only zeros", "give at least one count above 0")
    if all(INTEGER.fullmatch(text) for text in texts) and total != 1.0:
        return _profile(name, "counts", values, total)
    for kind, whole in WHOLE.items():
        if abs(total - whole) <= ROUNDING * whole:
            return _profile(name, kind, values, whole)
    what = f"column {shown(name)} sums to {total:.6g}"
    return FeederError(where, what, "give whole counts, fractions that sum to 1 or percents that sum to 100")


def _told(profile):
    """A column's name, with its sum where that is not understood."""
    total = profile.values.sum()
    return profile.name if abs(total - WHOLE[profile.kind]) < 1e-9 else f"{profile.name} (sum {total:.6g})"


def _profile(name, kind, values, whole=1.0):
    return Profile(name, kind, check.frozen(values), check.frozen(values / whole))
