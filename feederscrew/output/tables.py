"""Tables and documents as text: for people, for spreadsheets, for programs; field words of both."""

import csv
import io
import json
import math
import re
import textwrap
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from feederscrew.base import units
from feederscrew.base.arrays import Array
from feederscrew.base.columns import Column as DeclaredColumn
from feederscrew.base.columns import ColumnHead
from feederscrew.base.columns import Frame as Frame
from feederscrew.base.columns import quantities as quantities
from feederscrew.motion.limits import Regime

if TYPE_CHECKING:
    from pandas import DataFrame

TABLE_DIGITS = 4  # significant, in a table for people
GAP, LEAST = "  ", 12  # between columns; letters that a column always has
SLENDER = 20  # letters of a column of texts that is never made narrower so that the others fit beside it
PAGE = 100  # letters of a line that a table for people should not be wider than
PHASE_WORDS = {"stick": "sticks", "forward": "slips forward", "backward": "slips back", "flight": "flies"}
REGIME_WORDS: dict[str, str] = {  # of a regime's name in files
    Regime.STICK: "sticks",
    Regime.FORWARD: "slips forward only",
    Regime.BACKWARD: "slips back only",
    Regime.BOTH: "slips both ways",
    Regime.HOP: "hops",
}
HEADING_ZERO = (
    "at heading 0 the middle of the face it rests on lies ahead of its centre of mass, in the direction of "
    "travel (where it lies below it: the longest side of the outline lies along the track)"
)

Cells = dict[str, list[str]]  # of one width by the name of the column


def data_frame(frame: Frame) -> "DataFrame":
    """Return the table as a pandas DataFrame, as users of the library expect one.

    Parameters
    ----------
    frame : Frame

    Returns
    -------
    pandas.DataFrame
    """
    import pandas as pd

    return pd.DataFrame(frame)


def joined(frames: "Iterable[DataFrame]") -> "DataFrame":
    """Return data frames below each other as one, its rows numbered anew.

    Parameters
    ----------
    frames : iterable of pandas.DataFrame

    Returns
    -------
    pandas.DataFrame
    """
    import pandas as pd

    return pd.concat(list(frames), ignore_index=True)


def is_numeric(column: object) -> bool:
    """Tell whether a column of a Frame holds numbers.

    Parameters
    ----------
    column : object

    Returns
    -------
    bool
    """
    return isinstance(column, np.ndarray) and column.dtype.kind in "iuf"


def text(frame: Frame, format: str, width: int | None = None) -> str:
    """Return a frame as text.

    Texts of a table that is wider than the window go on below; where that is not enough, it is folded, its
    first column at the head of each piece. The same frame always gives the same bytes.

    Parameters
    ----------
    frame : Frame
    format : str
        'csv' (six significant digits), or 'table' for people.
    width : int, optional
        Letters of a line of the window; no limit without it.

    Returns
    -------
    str

    Raises
    ------
    ValueError
        If the format is another one.
    """
    if format == "csv":
        lines = io.StringIO()
        writer = csv.writer(lines, lineterminator="\n")
        writer.writerow(frame)
        writer.writerows(zip(*([_csv_cell(value) for value in column] for column in frame.values())))
        return lines.getvalue()
    if format != "table":
        raise ValueError(f"format is {format!r}, not 'table' or 'csv'")
    columns = {name: _align_cells(head_of(frame, name), column) for name, column in frame.items()}
    if width is None or not columns:
        pieces = [list(columns.values())]
    else:
        # side by side, the widest texts made narrower, as long as they can be read
        texts = [name for name, column in frame.items() if not is_numeric(column)]
        wide = {name: len(cells[0]) for name, cells in columns.items()}
        excess = sum(wide.values()) + len(GAP) * (len(wide) - 1) - width
        while excess > 0:
            widest = max(texts, key=wide.__getitem__, default=None)
            if widest is None or wide[widest] <= SLENDER:
                break
            wide[widest] -= 1
            excess -= 1
        narrowed = [] if excess > 0 else [_break_cells(cells, wide[name]) for name, cells in columns.items()]
        pieces = [_in_lines(narrowed)] if narrowed else _fold_columns(columns, width)
    # a line of units is empty where no column has one
    printed = [[GAP.join(cells).rstrip() for cells in zip(*piece)] for piece in pieces]
    return "\n".join("".join(f"{line}\n" for line in piece if line) for piece in printed)


def to_page(frame: Frame, spare: Iterable[Sequence[str]], width: int = PAGE) -> tuple[Frame, list[str]]:
    """Leave columns out of a table for people until its lines have no more letters than a page.

    Parameters
    ----------
    frame : Frame
    spare : iterable of sequences of str
        Names of those that may go, in groups that go together, the first group first.
    width : int
        Letters of a line.

    Returns
    -------
    Frame, list of str
        The frame, and the headings of what went.
    """
    wide = {name: len(_align_cells(head_of(frame, name), cells)[0]) for name, cells in frame.items()}
    gone: list[str] = []
    for group in spare:
        left = [letters for name, letters in wide.items() if name not in gone]
        if sum(left) + len(GAP) * (len(left) - 1) <= width:
            break
        gone += [name for name in group if name in wide]
    return frame.without(gone), [head_of(frame, name).heading for name in gone]


def _fold_columns(columns: Cells, width: int) -> list[list[list[str]]]:
    """The pieces of a table that fit a window, each headed by the columns that name its rows."""
    names = list(columns)
    # how many columns, the first ones, it takes to name a row
    count = 1
    for first in range(min(3, len(names)), 0, -1):
        naming = [columns[name] for name in names[:first]]
        rows, wide = list(zip(*naming)), sum(len(column[0]) + len(GAP) for column in naming)
        count = first if len(set(rows)) == len(rows) and wide <= width // 2 else count
    widest = max((len(columns[name][0]) for name in names[count:]), default=0)
    room = max(width - count * len(GAP) - min(widest, width // 2), width // 2)
    head = [_break_cells(columns[name], max(room // count, LEAST)) for name in names[:count]]
    room = max(width - _wide(head), LEAST)
    groups: list[list[str]] = []  # a value and the ends of its interval stay together
    for name in names[count:]:
        if groups and name.endswith(("_low", "_high")):
            groups[-1].append(name)
        else:
            groups.append([name])
    pieces = [[*head]]
    for group in groups:
        added = [_break_cells(columns[name], room - len(GAP)) for name in group]
        if _wide([*pieces[-1], *added]) > width and len(pieces[-1]) > count:
            pieces.append([*head])
        pieces[-1] += added
    return [_in_lines(piece) for piece in pieces]


def _wide(columns: list[list[list[str]]]) -> int:
    return sum(len(column[0][0]) for column in columns) + len(GAP) * (len(columns) - 1)


def _break_cells(column: list[str], most: int) -> list[list[str]]:
    if len(column[0]) <= most:
        return [[cell] for cell in column]
    listed = [textwrap.wrap(cell, most, break_on_hyphens=False) or [""] for cell in column]
    width = max(len(line) for lines in listed for line in lines)
    return [[line.ljust(width) for line in lines] for lines in listed]


def _in_lines(columns: list[list[list[str]]]) -> list[list[str]]:
    heights = [max(map(len, cells)) for cells in zip(*columns)]

    def fill_lines(lines: list[str], high: int) -> list[str]:
        return [*lines, *[" " * len(lines[0])] * (high - len(lines))]

    return [[line for c, high in zip(column, heights) for line in fill_lines(c, high)] for column in columns]


def _csv_cell(value: Any) -> Any:
    if isinstance(value, (float, np.floating)):
        return "" if math.isnan(value) else f"{value:.6g}"
    return units.printable(value) if isinstance(value, str) else "" if value is None else value


def _align_cells(head: ColumnHead, values: Array | Sequence[Any]) -> list[str]:
    """Heading, unit and cells of one column, all of one width; the points of numbers under each other."""
    numeric, texts = is_numeric(values), cells(head, values)
    if numeric and not np.issubdtype(np.asarray(values).dtype, np.integer):
        tails = [len(cell) - cell.find(".") if "." in cell else 0 for cell in texts]
        texts = [cell + " " * (max(tails) - tail) for cell, tail in zip(texts, tails)]
    texts = [head.heading, f"[{head.unit}]" if head.unit else "", *texts]
    width = max(map(len, texts))
    return [cell.rjust(width) if numeric else cell.ljust(width) for cell in texts]


def cells(
    head: ColumnHead, values: Array | Sequence[Any], share_digits: int = TABLE_DIGITS, nothing: str = "-"
) -> list[str]:
    """Return the cells of a column as people read them: shares in percent, rounding as 0.

    Parameters
    ----------
    head : ColumnHead
        Of the column.
    values : array or sequence
    share_digits : int
        Significant digits of shares.
    nothing : str
        What stands for NaN and for None.

    Returns
    -------
    list of str
    """
    if not isinstance(values, np.ndarray) or not is_numeric(values):
        return [_word(value, nothing) for value in values]
    if np.issubdtype(values.dtype, np.integer):
        return [str(value) for value in values]
    scaled = head.shown * values
    # beside the largest value of a column 1e-12 of it is rounding, unless its rows have units of their own
    noise = 0.0 if head.is_mixed else 1e-12 * np.abs(scaled[np.isfinite(scaled)]).max(initial=0.0)
    digits = share_digits if head.shown != 1.0 else TABLE_DIGITS
    return [number(0.0 if abs(value) <= noise else value, digits, nothing) for value in scaled]


def _word(value: Any, nothing: str) -> str:
    if isinstance(value, (bool, np.bool_)):
        return "yes" if value else "no"
    return nothing if value is None or value != value else units.printable(str(value))


def number(value: float, digits: int = TABLE_DIGITS, nothing: str = "-") -> str:
    """Return a number for people.

    Parameters
    ----------
    value : float
    digits : int
        That are significant.
    nothing : str
        What stands for NaN.

    Returns
    -------
    str
    """
    if value == 0.0 or math.isnan(value):
        return "0" if value == 0.0 else nothing
    if not 1e-4 <= abs(value) < 1e7:
        return f"{value:.{digits - 1}e}"
    exponent = int(f"{value:.{digits - 1}e}".partition("e")[2])  # after rounding: 9.9999 is 10.00
    return f"{value:.{max(0, digits - 1 - exponent)}f}"


def head_of(frame: Frame, name: str) -> ColumnHead:
    """Return what people read above a column of a table: what is declared of it, else its name."""
    return frame.heads.get(name, ColumnHead(name.replace("_", " ")))


def row_for_people(column: DeclaredColumn[Any], document: Mapping[str, Any]) -> tuple[str, str]:
    """Return a column of a document as a row for people: its heading with the unit, and its value.

    The ends of an interval follow the value in brackets. A share is in percent.
    """
    head, value = column.head, document[column.name]

    def cell(name: str) -> str:
        entry = document[name]
        is_number = isinstance(entry, (int, float, np.number)) and not isinstance(entry, (bool, np.bool_))
        return number(head.shown * float(entry)) if is_number else _word(entry, "-")

    if isinstance(value, (list, tuple)):
        return head.title, units.listed([str(entry) for entry in value]) or "-"
    ends = f" ({cell(f'{column.name}_low')} to {cell(f'{column.name}_high')})" if column.interval else ""
    return head.title, f"{cell(column.name)}{ends}"


def file_bytes(content: str | bytes) -> bytes:
    """Return text as the bytes of a file: UTF-8, an escape for what a file name holds that is no letter.

    Parameters
    ----------
    content : str or bytes

    Returns
    -------
    bytes
    """
    return content if isinstance(content, bytes) else content.encode(errors="backslashreplace")


def json_text(document: Mapping[str, Any]) -> str:
    """Return a dict of numbers, texts, arrays, frames and dicts as JSON: full precision, null for NaN.

    Parameters
    ----------
    document : mapping

    Returns
    -------
    str
    """
    return json.dumps(_plain(document), indent=1, allow_nan=False) + "\n"


def _plain(value: Any) -> Any:
    if isinstance(value, Frame):
        return [_plain(row) for row in value.rows()]
    if isinstance(value, dict):
        return {str(key): _plain(entry) for key, entry in value.items()}
    if isinstance(value, (list, tuple, np.ndarray)):
        return [_plain(entry) for entry in value]
    if isinstance(value, np.generic):
        return _plain(value.item())
    return None if isinstance(value, float) and not math.isfinite(value) else value


def regime_words(regime: str) -> str:
    """Return a regime as people read it: 'slips back only' for 'backward'.

    Parameters
    ----------
    regime : str

    Returns
    -------
    str
    """
    return REGIME_WORDS.get(regime, regime)


def heading_note(text: str) -> str:
    """Return what the headings in a printed table or message are turned from.

    'A@188: aspect A, turned 188 deg counter-clockwise (seen from above): at heading 0 ...', as
    ``resting.posture.Posture`` has it: heading 0 has the thesis's Z' along the track.

    Parameters
    ----------
    text : str

    Returns
    -------
    str
        '' where the text names no heading.
    """
    if named := re.search(r"\b([A-Z]+)@(\d+)", text):
        turned = f"turned {named[2]} deg counter-clockwise seen from above"
        return f"{named[0]}: aspect {named[1]}, {turned}; {HEADING_ZERO}"
    if re.search(r"\bat heading \d", text) or re.search(r"\bheading\b", text.partition("\n")[0]):
        return f"heading: by how much a part is turned, counter-clockwise seen from above; {HEADING_ZERO}"
    return ""
