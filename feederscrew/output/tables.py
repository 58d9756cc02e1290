"""Tables and documents as text: for people, for spreadsheets, for programs."""

import csv
import io
import json
import math
from typing import Any

import numpy as np

from feederscrew import units
from feederscrew.output import window

COLUMN_UNITS = {  # the end of a column's name, and how a heading writes it
    "_n_per_mm": "N/mm",
    "_per_minute": "1/min",
    "_percent": "%",
    "_kg_m2": "kg m2",
    "_mpa": "MPa",
    "_kg": "kg",
    "_hz": "Hz",
    "_g_mm2": "g mm2",
    "_kg_m3": "kg/m3",
    "_g_cm3": "g/cm3",
    "_rad_s2": "rad/s2",
    "_m_s2": "m/s2",
    "_mm_s": "mm/s",
    "_mm4": "mm4",
    "_mm3": "mm3",
    "_mm2": "mm2",
    "_mm": "mm",
    "_um": "um",
    "_sr": "sr",
    "_deg": "deg",
    "_rad": "rad",
    "_Hz": "Hz",
    "_mJ": "mJ",
    "_uJ": "uJ",
    "_N": "N",
    "_g": "g",
    "_s": "s",
}
SHARES = ("share", "efficiency", "purity")  # last words of columns of shares ...
PASSED = ("passes", "passes_devices", "passed_low", "passed_high")  # ... and whole names of others
TABLE_DIGITS = 4  # significant, in a table for people
COLUMN_NOISE = 1e-12  # of a column's largest value: rounding, shown as 0
MIXED = "value"  # a column whose rows have units of their own: none is rounding beside another
PAGE = 100  # letters of a line that a table for people should not be wider than


class Frame(dict):
    """A table: equally long columns by name, in their order; in a document, a list of rows.

    A column is an array where all its cells are numbers or all are true or false, else a list. A DataFrame
    does the same; importing pandas takes longer than most answers.
    """

    def rows(self) -> list[Any]:
        """Return the rows, each a dict of cells by column."""
        return [dict(zip(self, cells)) for cells in zip(*self.values())]

    def only(self, names) -> "Frame":
        """Return a table of these columns, in this order."""
        return Frame({name: self[name] for name in names})

    def without(self, names) -> "Frame":
        """Return a table of all columns but these."""
        return Frame({name: column for name, column in self.items() if name not in names})


def frame(columns):
    """Return a table of equally long columns, in the order given.

    Parameters
    ----------
    columns : dict of str to sequence
        Values by column name; the name ends in the unit (``height_mm``).

    Returns
    -------
    Frame
        NaN or None stands for an empty cell; None among numbers becomes NaN.

    Raises
    ------
    ValueError
        If the columns are not equally long.
    """
    table = Frame({name: _as_column(values) for name, values in columns.items()})
    if len(lengths := {len(column) for column in table.values()}) > 1:
        raise ValueError(f"columns of one table are not of the same length: {sorted(lengths)}")
    return table


def data_frame(frame):
    """Return the table as a pandas DataFrame, as users of the library expect one."""
    import pandas as pd

    return pd.DataFrame(frame)


def is_numeric(column):
    """Return whether a column of a Frame holds numbers."""
    return isinstance(column, np.ndarray) and column.dtype.kind in "iuf"


def _as_column(values):
    if isinstance(values, np.ndarray) and values.dtype.kind in "iufb":
        return values
    cells = list(values)
    kinds = {type(cell) for cell in cells}
    if kinds and kinds <= {bool, np.bool_}:
        return np.array(cells)
    numbers = {kind for kind in kinds if issubclass(kind, (int, float, np.number)) and kind is not bool}
    if numbers and kinds - numbers <= {type(None)}:
        return np.array([np.nan if cell is None else cell for cell in cells])
    return cells


def text(frame, format, width=None):
    """Return a frame as ``'csv'`` (six significant digits) or as a ``'table'`` for people.

    Parameters
    ----------
    frame : Frame
        From ``frame``.
    format : str
        ``'table'`` or ``'csv'``.
    width : int, optional
        Letters of a line of the window. Texts of a wider table go on below; where that is not enough, it is
        folded, its first column at the head of each piece.

    Returns
    -------
    str
        Lines that end in a newline; the same frame always gives the same bytes.
    """
    if format == "csv":
        lines = io.StringIO()
        writer = csv.writer(lines, lineterminator="\n")
        writer.writerow(frame)
        writer.writerows(zip(*([_cell(value) for value in column] for column in frame.values())))
        return lines.getvalue()
    if format == "table":
        return _aligned(frame, width)
    raise ValueError(f"format is {format!r}, not 'table' or 'csv'")


def to_page(frame, spare, width=PAGE) -> tuple[Any, ...]:
    """Leave columns out of a table for people until its lines have no more letters than a page.

    ``spare`` names those that may go, in groups that go together, the first group first. Returns the
    frame, and the headings of what went.
    """
    gone = window.spared({name: len(_column(name, cells)[0]) for name, cells in frame.items()}, spare, width)
    return frame.without(gone), [heading(name)[0] for name in gone]


def _cell(value):
    if isinstance(value, (float, np.floating)):
        return "" if math.isnan(value) else f"{value:.6g}"
    return units.printable(value) if isinstance(value, str) else "" if value is None else value


def encoded(content):
    """Return text as the bytes of a file: UTF-8, an escape for what a file name holds that is no letter."""
    return content if isinstance(content, bytes) else content.encode(errors="backslashreplace")


def json_text(document):
    """Return a document as JSON: full precision, null for NaN and infinity, keys in the order given.

    Parameters
    ----------
    document : dict
        Of numbers, texts, sequences, arrays, frames (a list of rows) and dicts of these.

    Returns
    -------
    str
        Ends in a newline.
    """
    return json.dumps(_plain(document), indent=1, allow_nan=False) + "\n"


def _plain(value):
    """The same value in JSON's own types."""
    if isinstance(value, Frame):
        return [_plain(row) for row in value.rows()]
    if isinstance(value, dict):
        return {str(key): _plain(entry) for key, entry in value.items()}
    if isinstance(value, (list, tuple, np.ndarray)):
        return [_plain(entry) for entry in value]
    if isinstance(value, np.generic):
        return _plain(value.item())
    return None if isinstance(value, float) and not math.isfinite(value) else value


def heading(name, numeric=True) -> tuple[Any, ...]:
    """Return a column's name and unit for people.

    Parameters
    ----------
    name : str
        'height_mm', 'p_pmi', 'purity'.
    numeric : bool
        Whether the column holds numbers: a share that is a word has no unit.

    Returns
    -------
    tuple of str
        ('height', '[mm]'), ('PMI', '[%]'); no unit is ''. The ends of an interval, which follow their
        value, are ('low', '[%]') and ('high', '[%]').
    """
    if is_share(name) and not name.startswith("p_"):
        return name.replace("_", " "), "[%]" if numeric else ""
    if is_share(name):
        rule = name.removeprefix("p_").replace("_", " ")
        if rule.endswith((" low", " high")):
            return rule.rsplit(" ", 1)[1], "[%]"
        return (rule.upper() if _is_abbreviation(rule) else rule), "[%]"
    ending = next((ending for ending in COLUMN_UNITS if name.endswith(ending) and name != ending), "")
    return name.removesuffix(ending).replace("_", " "), f"[{COLUMN_UNITS[ending]}]" if ending else ""


def _is_abbreviation(name):
    """Whether a rule is written in capitals."""
    from feederscrew.resting.rules import registry

    return name in registry.RULE_OF and registry.RULE_OF[name].is_abbreviation


def is_share(name):
    """Return whether a column holds shares, which people read in percent and programs as fractions."""
    if name.startswith("p_"):
        return name != "p_value"
    return name in PASSED or name.rpartition("_")[2] in SHARES


def _aligned(frame, width) -> str:
    """Columns side by side: texts to the left, numbers with their points in one line."""
    columns = {name: _column(name, column) for name, column in frame.items()}
    if width is None or not columns:
        pieces = [list(columns.values())]
    else:
        texts = [name for name, column in frame.items() if not is_numeric(column)]
        side_by_side = window.narrowed(columns, texts, width)
        pieces = window.folded(columns, width) if side_by_side is None else [side_by_side]
    return "\n".join("".join(f"{line}\n" for line in _lines(piece) if line) for piece in pieces)


def _lines(columns) -> list[Any]:
    """Line by line; a line of units is empty where no column has one."""
    return [window.GAP.join(cells).rstrip() for cells in zip(*columns)]


def _column(name, values) -> list[Any]:
    """Name, unit and cells of one column, all of one width."""
    numeric = is_numeric(values)
    cells = _numbers(name, values) if numeric else [_word(value) for value in values]
    cells = [*heading(name, numeric), *cells]
    width = max(map(len, cells))
    return [cell.rjust(width) if numeric else cell.ljust(width) for cell in cells]


def _numbers(name, values) -> list[Any]:
    """Cells of a column of numbers, their points under each other."""
    if np.issubdtype(values.dtype, np.integer):
        return [str(value) for value in values]
    values = values * (100.0 if is_share(name) else 1.0)
    largest = max(np.abs(values[np.isfinite(values)]), default=0.0)
    nothing = 0.0 if name == MIXED else COLUMN_NOISE * largest
    cells = [_number(0.0 if abs(value) <= nothing else value) for value in values]
    tails = [len(cell) - cell.find(".") if "." in cell else 0 for cell in cells]
    return [cell + " " * (max(tails, default=0) - tail) for cell, tail in zip(cells, tails)]


def _number(value) -> str:
    if not math.isfinite(value):
        return "-" if math.isnan(value) else str(value)
    if value == 0.0:
        return "0"
    if not 1e-4 <= abs(value) < 1e7:
        return f"{value:.{TABLE_DIGITS - 1}e}"
    exponent = int(f"{value:.{TABLE_DIGITS - 1}e}".partition("e")[2])  # after rounding: 9.9999 is 10.00
    return f"{value:.{max(0, TABLE_DIGITS - 1 - exponent)}f}"


def _word(value):
    if isinstance(value, (bool, np.bool_)):
        return "yes" if value else "no"
    return "-" if value is None or value != value else units.printable(str(value))
