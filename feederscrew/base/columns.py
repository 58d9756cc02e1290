"""Columns of results: each has its name, value, unit and heading declared once, beside its record.

A tuple of ``Column`` says everything of a table. Printed table, CSV, JSON, data frame and notebook are made
from it. The value of a column is a function of the record, so that a type checker knows its attributes:

    PITCH_COLUMNS: tuple[Column[Rate], ...] = (
        Column("pitch_mm", lambda rate: rate.pitch, "mm"),
        Column("purity", lambda rate: rate.purity, "share"),
    )
"""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Generic, Literal, NamedTuple, TypeVar

import numpy as np

from feederscrew.base.units import UNITS_BY_DIMENSION

R = TypeVar("R")  # the record of a row, or one that holds an array for each column
UnitName = Literal[
    "",
    "share",
    "%",
    "mm",
    "um",
    "mm2",
    "mm3",
    "mm4",
    "l",
    "deg",
    "rad",
    "sr",
    "s",
    "Hz",
    "1/s",
    "1/min",
    "mm/s",
    "m/s",
    "m/s2",
    "rad/s2",
    "g",
    "kg",
    "g/cm3",
    "kg/m3",
    "g mm2",
    "kg m2",
    "mJ",
    "uJ",
    "1/h",
    "N",
    "mN",
    "N mm",
    "N/mm",
    "MPa",
]
ENDINGS = {
    "%": "_percent",
    "1/s": "_per_s",
    "1/min": "_per_minute",
    "1/h": "_per_hour",
    "N/mm": "_n_per_mm",
}  # of names; of others the unit
ENDS = ("low", "high")  # of an interval

# One JSON object, as a command writes it or a browser is sent it: entries by name, other objects and lists of
# them among these. It is made of declared columns and read by programs of others; no code of ours decides on
# it. What our own code hands on is a record.
Document = dict[str, Any]
Cells = dict[str, Any]  # columns of a table by name, or the cells of one of its rows


class Unit(NamedTuple):
    """A unit: how a heading writes it, and what it is in SI units."""

    label: str  # 'mm/s', '' of a plain number
    size: float  # [SI] of one in files
    shown: float = 1.0  # what people read for 1 in files: 100 of a share


def _units() -> dict[str, Unit]:
    """Every unit by its name; a share is a fraction in files and in percent for people."""
    sizes = {name: size for sizes in UNITS_BY_DIMENSION.values() for name, size in sizes.items()}
    sizes |= {"mm4": 1e-12, "rad/s2": 1.0, "N mm": 1e-3}
    return {name: Unit(name, size) for name, size in sizes.items()} | {
        "": Unit("", 1.0),
        "share": Unit("%", 1.0, 100.0),
    }


UNITS = _units()


class ColumnHead(NamedTuple):
    """What people read above a column, and by how much its numbers in files are multiplied for them."""

    heading: str
    unit: str = ""  # '' of a word and of a plain number
    shown: float = 1.0
    is_mixed: bool = False  # rows with units of their own: none is rounding beside another

    @classmethod
    def of_name(cls, name: str, label: str, shown: float = 1.0) -> "ColumnHead":
        """Return the words of a name without its unit, and that unit: 'height', 'mm' of 'height_mm'."""
        ending = ENDINGS.get(label, "_" + label.replace(" ", "_").replace("/", "_"))
        if label and shown == 1.0 and name.lower().endswith(ending.lower()) and name != ending:
            name = name[: -len(ending)]
        return cls(name.replace("_", " "), label, shown)

    @property
    def title(self) -> str:
        """Return heading and unit in one text: 'height [mm]'."""
        return f"{self.heading} [{self.unit}]" if self.unit else self.heading


def share_head(name: str) -> ColumnHead:
    """Return what people read above a share that is a fraction in files: its name, in percent."""
    return ColumnHead.of_name(name, "%", 100.0)


@dataclass(frozen=True)
class Column(Generic[R]):
    """One column of a table, or one entry of a document.

    Parameters
    ----------
    name : str
        In files; it ends in its unit: 'pitch_mm'.
    attribute : callable
        Returns the value [SI] of a record: a number, a text, an array, None where there is none; with
        ``interval`` an object with ``value``, ``low`` and ``high``.
    unit : str
        Of the value in files; 'share' is a fraction in files and in percent for people.
    heading : str
        For people; without it the name, without its unit.
    interval : bool
        Whether two columns follow: 'rate_low' and 'rate_high'.
    hidden : bool
        Whether the table for people leaves the column out.
    """

    name: str
    attribute: Callable[[R], Any]
    unit: UnitName = ""
    heading: str = ""
    interval: bool = False
    hidden: bool = False

    @property
    def head(self) -> ColumnHead:
        """Return what people read above the column."""
        unit = UNITS[self.unit]
        head = ColumnHead.of_name(self.name, unit.label, unit.shown)
        return head._replace(heading=self.heading) if self.heading else head

    @property
    def heads(self) -> dict[str, ColumnHead]:
        """Return the names in files, and what people read above each: three of an interval."""
        head = self.head
        if not self.interval:
            return {self.name: head}
        ends = {f"{self.name}_{end}": head._replace(heading=f"{head.heading} {end}") for end in ENDS}
        return {self.name: head} | ends

    def values(self, record: R) -> Document:
        """Return the value of a record in the column's unit by its name; three of an interval."""
        value = self.attribute(record)
        if not self.interval:
            return {self.name: in_unit(value, self.unit)}
        ends = {f"{self.name}_{end}": in_unit(getattr(value, end), self.unit) for end in ENDS}
        return {self.name: in_unit(value.value, self.unit)} | ends


def in_unit(value: Any, unit: UnitName) -> Any:
    """Return a value in a unit.

    Parameters
    ----------
    value : float, array, str or None [SI]
    unit : str
        One of ``UNITS``.

    Returns
    -------
    float, array, str or None
        None, texts and plain numbers as they are.
    """
    size = UNITS[unit].size
    if isinstance(value, np.ndarray) and value.ndim == 0:
        value = value[()]  # a number
    if isinstance(value, dict):
        return {name: in_unit(entry, unit) for name, entry in value.items()}
    if value is None or size == 1.0:
        return value
    return 100.0 * value if unit == "%" else value / size


class Frame(dict[str, Any]):
    """A table: equally long columns by name, in their order; in a document, a list of rows.

    A column is an array where all its cells are numbers or all are true or false, else a list. A DataFrame
    does the same; importing pandas takes longer than most answers. ``heads`` says what people read above
    each column; of one that is not in it this is its name.
    """

    heads: dict[str, ColumnHead]
    hidden: frozenset[str]  # columns that a table for people leaves out

    def __init__(
        self,
        columns: Mapping[str, Any] | None = None,
        heads: Mapping[str, ColumnHead] | None = None,
        hidden: Iterable[str] = (),
    ) -> None:
        super().__init__(columns or {})
        self.heads, self.hidden = dict(heads or {}), frozenset(hidden)

    @classmethod
    def of(cls, columns: Mapping[str, Any], heads: Mapping[str, ColumnHead] | None = None) -> "Frame":
        """Return a table of columns by name, in the order given; a name ends in its unit (``height_mm``).

        Parameters
        ----------
        columns : mapping of str to sequence
            Cells by column. NaN or None stands for an empty cell; None among numbers becomes NaN.
        heads : mapping of str to ColumnHead, optional
            What people read above each; without it those of ``columns`` if that is a Frame, else the names.

        Raises
        ------
        ValueError
            If the columns are not equally long.
        """
        old = columns if isinstance(columns, Frame) else Frame()
        table = Frame(None, old.heads if heads is None else heads, old.hidden)
        for name, values in columns.items():
            if not isinstance(values, np.ndarray) or values.dtype.kind not in "iufb":
                values = list(values)
                kinds = {type(cell) for cell in values}
                numbers = {kind for kind in kinds - {bool} if issubclass(kind, (int, float, np.number))}
                if kinds and kinds <= {bool, np.bool_}:
                    values = np.array(values)
                elif numbers and kinds - numbers <= {type(None)}:
                    values = np.array([np.nan if cell is None else cell for cell in values])
            table[name] = values
        if len(lengths := {len(column) for column in table.values()}) > 1:
            raise ValueError(f"columns of one table are not of the same length: {sorted(lengths)}")
        return table

    @classmethod
    def of_rows(cls, rows: Sequence[Mapping[str, Any]], names: Iterable[str] | None = None) -> "Frame":
        """Return rows, dicts of cells, as a table of these columns; without ``names`` those of the first."""
        return cls.of({name: [row[name] for row in rows] for name in (rows[0] if names is None else names)})

    @classmethod
    def of_cells(cls, names: Iterable[str], rows: Iterable[Sequence[Any]]) -> "Frame":
        """Return rows, sequences of cells in the order of the columns, as a table."""
        cells = list(rows)
        return cls.of({name: [row[place] for row in cells] for place, name in enumerate(names)})

    def rows(self) -> list[Cells]:
        """Return the rows, each a dict of cells by column."""
        return [dict(zip(self, cells)) for cells in zip(*self.values())]

    def only(self, names: Iterable[str]) -> "Frame":
        """Return a table of these columns, in this order."""
        return Frame({name: self[name] for name in names}, self.heads, self.hidden)

    def without(self, names: Iterable[str]) -> "Frame":
        """Return a table of all columns but these."""
        left_out = set(names)
        return self.only(name for name in self if name not in left_out)

    def at(self, rows: Sequence[int] | np.ndarray) -> "Frame":
        """Return a table of these rows, in this order."""
        return self.taking({name: [column[row] for row in rows] for name, column in self.items()})

    def for_people(self) -> "Frame":
        """Return a table of the columns that are not hidden."""
        return self.without(self.hidden)

    def headed(self, heads: Mapping[str, ColumnHead]) -> "Frame":
        """Return the table with other words above some of its columns."""
        return Frame(self, self.heads | dict(heads), self.hidden)

    def with_headings(self, headings: Mapping[str, str]) -> "Frame":
        """Return the table with other words above some of its columns, in the units they have."""
        heads = {
            name: self.heads.get(name, ColumnHead(name))._replace(heading=t) for name, t in headings.items()
        }
        return self.headed(heads)

    def taking(self, columns: Mapping[str, Any]) -> "Frame":
        """Return the table with other cells in some of its columns, under the same headings."""
        return Frame.of(Frame(dict(self) | dict(columns), self.heads, self.hidden))


def values(columns: Iterable[Column[R]], record: R) -> Document:
    """Return the values of a record by the names of its columns, each in its unit: entries of a document.

    Parameters
    ----------
    columns : iterable of Column
    record : object
        Of the class that the columns are declared for.

    Returns
    -------
    dict of str
        Arrays stay arrays, and None stays None.
    """
    return {name: value for column in columns for name, value in column.values(record).items()}


def heads(columns: Iterable[Column[R]]) -> dict[str, ColumnHead]:
    """Return what people read above columns, by their names in files.

    Parameters
    ----------
    columns : iterable of Column

    Returns
    -------
    dict of str to ColumnHead
        Three of an interval.
    """
    return {name: head for column in columns for name, head in column.heads.items()}


def of_records(columns: Sequence[Column[R]], records: Iterable[R]) -> Frame:
    """Return a table with a row for each record.

    Parameters
    ----------
    columns : sequence of Column
    records : iterable

    Returns
    -------
    Frame
        Without records a table of no rows.
    """
    rows = [values(columns, record) for record in records]
    names = [name for column in columns for name in column.heads]
    return _declared(columns, {name: [row[name] for row in rows] for name in names})


def of_arrays(columns: Sequence[Column[R]], record: R) -> Frame:
    """Return a table of one record, whose columns are arrays or sequences of the same length.

    A column that is a single value has it in every row.

    Parameters
    ----------
    columns : sequence of Column
    record : object

    Returns
    -------
    Frame
    """
    return _declared(columns, _as_rows(values(columns, record)))


def of_pieces(columns: Sequence[Column[R]], records: Iterable[R]) -> Frame:
    """Return the tables of several records, each of arrays, below each other.

    Parameters
    ----------
    columns : sequence of Column
    records : iterable
        One at least.

    Returns
    -------
    Frame
    """
    pieces = [_as_rows(values(columns, record)) for record in records]
    return _declared(columns, {name: np.concatenate([piece[name] for piece in pieces]) for name in pieces[0]})


def _as_rows(cells: Mapping[str, Any]) -> Cells:
    """Return columns of one length: a single value stands in every row."""
    lengths = [len(column) for column in cells.values() if _is_column(column)]
    count = max(lengths, default=1)
    return {name: cell if _is_column(cell) else [cell] * count for name, cell in cells.items()}


def _is_column(cell: Any) -> bool:
    return isinstance(cell, (list, tuple)) or (isinstance(cell, np.ndarray) and cell.ndim > 0)


def _declared(columns: Sequence[Column[R]], cells: Mapping[str, Any]) -> Frame:
    hidden = [name for column in columns if column.hidden for name in column.heads]
    return Frame(Frame.of(cells), heads(columns), hidden)


def quantities(rows: Iterable[Sequence[Any]]) -> Frame:
    """Return pairs as a table for people: the columns ``quantity`` and ``value``."""
    return Frame.of_cells(("quantity", "value"), rows).headed({"value": ColumnHead("value", is_mixed=True)})
