"""Views of a record: a short text, a table, a picture; made outside of the stage it is from.

The module that ``views`` names makes tables and pictures, and is imported when one is asked for.
"""

from collections.abc import Callable
from dataclasses import fields, is_dataclass
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

from feederscrew.base.units import printable
from feederscrew.base.views import views

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from pandas import DataFrame

MAX_TEXT_LENGTH = 360  # characters of a text in all,
MAX_FIELD_LENGTH = 44  # and of one field
MOST_LETTERS = 500  # of a text that says an answer


class ReadableRecord:
    """A record whose text is short, and that has a table and, where its command draws, pictures."""

    _view_name: ClassVar[str] = ""  # of a ``RecordView``: its module among the pages, and its name

    def __init_subclass__(cls, view: str = "", **keywords: Any) -> None:
        """Note the view of a class; a class without one shows that of the class it is made from."""
        super().__init_subclass__(**keywords)
        if view:
            cls._view_name = view
        cls.__repr__ = ReadableRecord.__repr__  # type: ignore[method-assign]  # or a dataclass makes its own

    def __repr__(self) -> str:
        answer = views().answer(self)
        if answer is None:
            return text(self)
        line = printable(answer)
        line = line if len(line) <= MOST_LETTERS else f"{line[: MOST_LETTERS - 3]}..."
        return f"{type(self).__name__}({line})"

    def _repr_html_(self) -> str:
        """Return what a notebook shows: the answer and the table, of a part its view."""
        return _view("html")(self)

    def to_frame(self, name: str | None = None) -> "DataFrame":
        """Return the table that the command of this record writes.

        Parameters
        ----------
        name : str, optional
            Of a table where there are several, 'convey_map'; the first without it.

        Returns
        -------
        DataFrame
            Its columns name their units.

        Raises
        ------
        ArgumentError
            If there is no such table; the line names those there are.
        """
        return _view("frame")(self, name)

    def plot(self, name: str | None = None, ax: "Axes | None" = None) -> "Figure":
        """Draw the picture that the command of this record writes.

        Parameters
        ----------
        name : str, optional
            Of a picture where there are several, 'aspects'; the first without it.
        ax : matplotlib Axes, optional
            To draw into, of a picture that is one chart. Without a name the first such picture is drawn.

        Returns
        -------
        matplotlib Figure

        Raises
        ------
        ArgumentError
            If there is no such picture, or none at all; the line names those there are. If ``ax`` is given
            for a picture of several panels.
        """
        return _view("plot")(self, name, ax)

    def save(self, folder: "str | PathLike[str]", *, pictures: bool = True) -> Path:
        """Write the files that the command of this record writes with ``-o``.

        Parameters
        ----------
        folder : str or Path
            The results stand below it in a folder of the part's or the bowl's name, as with ``-o``.
        pictures : bool
            Whether pictures are written; tables and documents are.

        Returns
        -------
        Path
            The folder with the files and ``run.json``.

        Raises
        ------
        ArgumentError
            If no command writes files of such a record.
        FeederError
            If the folder cannot be written, or holds the results of another part or bowl.
        """
        return _view("save")(self, folder, pictures)


def text(record: Any) -> str:
    """Return a record in a line: its fields, arrays by their shape, long ones cut.

    Parameters
    ----------
    record : dataclass instance

    Returns
    -------
    str
        'Part(name='nut', ...)'. Fields that are None, or not of the ``repr``, are left out.
    """
    parts: list[str] = []
    for field in fields(record):
        value = getattr(record, field.name)
        if value is not None and field.repr:
            parts.append(f"{field.name}={_field(value)}")
        if sum(map(len, parts)) + 2 * len(parts) > MAX_TEXT_LENGTH:
            parts[-1] = "..."
            break
    return f"{type(record).__name__}({', '.join(parts)})"


def _field(value: Any) -> str:
    if isinstance(getattr(value, "shape", None), tuple) and value.shape:
        return f"<{' x '.join(map(str, value.shape))} array>"
    if isinstance(value, float):
        return f"{value:.6g}"
    if is_dataclass(value):
        if isinstance(name := getattr(value, "name", None), str):
            return f"{type(value).__name__} {name!r}"
        within = text(value)
        return within if len(within) <= MAX_FIELD_LENGTH else f"{type(value).__name__}(...)"
    if isinstance(value, (tuple, list)) and not all(isinstance(item, (str, int, float)) for item in value):
        return f"<{len(value)} {type(value[0]).__name__}>"
    if isinstance(value, dict):
        return f"<{len(value)} by name>"
    field_text = repr(value)
    return field_text if len(field_text) <= MAX_FIELD_LENGTH else f"{field_text[: MAX_FIELD_LENGTH - 3]}..."


def _view(kind: str) -> Callable[..., Any]:
    return getattr(views(), kind)
