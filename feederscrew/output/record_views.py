"""The answer, the table, the picture and the files of a record, by the view that its class names."""

import base64
import inspect
import sys
import tempfile
import webbrowser
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, fields, is_dataclass
from html import escape
from importlib import import_module
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from feederscrew import bowl as bowls
from feederscrew.base import check
from feederscrew.base.columns import Cells, Frame
from feederscrew.base.errors import ArgumentError
from feederscrew.base.heavy import heavy
from feederscrew.base.units import listed, printable
from feederscrew.bowl import Bowl
from feederscrew.bowl.arguments import settings_of
from feederscrew.output import offers, style, tables
from feederscrew.output.folder import ResultFolder, safe_name
from feederscrew.output.offers import RecordView
from feederscrew.output.part_facts import conditions
from feederscrew.output.record_lines import part_text
from feederscrew.part.record import Part

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from pandas import DataFrame


shading = heavy("feederscrew.output.shading")
View = Callable[..., Any]  # makes the frame or the figure of an offer
VIEW_PX = 360, 280  # [px] of a part


def answer(record: object) -> str | None:
    """Return what a record answers, without its class: 'bracket: A 42 %, B 17 %'.

    Parameters
    ----------
    record : object

    Returns
    -------
    str or None
        None of a class without such a line.
    """
    line = view_of(record).line
    return None if line is None else line(record)


def view_of(record: object) -> RecordView:
    """Return the view that the class of a record names; an empty one where it names none."""
    module, _, name = getattr(record, "_view_name", "").rpartition(".")
    return getattr(import_module(f"feederscrew.output.{module}"), name) if module else RecordView()


def frame(record: object, name: str | None = None) -> "DataFrame":
    """Return a table of a record; of one that is no study its numbers in SI units.

    Parameters
    ----------
    record : object
    name : str, optional
        Of the table, where there are several.

    Returns
    -------
    pandas.DataFrame
    """
    offered = _views_of(record, ".csv")
    if name is not None or offered:
        return tables.data_frame(_choose_view(record, offered, name, "table")())
    numbers = _document_numbers(record) or _numbers(record)
    # arrays of one length are columns where a record has rows, else its single numbers are one row
    lengths = [len(value) for name, value in numbers.items() if not _single(value) and "." not in name]
    rows = max(set(lengths), key=lengths.count, default=0)
    if lengths.count(rows) > 1:
        columns = {k: v for k, v in numbers.items() if not _single(v) and len(v) == rows}
    else:
        columns = {name: [value] for name, value in numbers.items() if _single(value)}
    return tables.data_frame(Frame.of(columns))


def row(record: object) -> "DataFrame":
    """Return a record in one row: the numbers and words of the document that its command writes.

    Of a record without such a document it is its table.

    Parameters
    ----------
    record : object

    Returns
    -------
    pandas.DataFrame
    """
    numbers = _document_numbers(record)
    return tables.data_frame(Frame.of({k: [v] for k, v in numbers.items()})) if numbers else frame(record)


def _document_numbers(record: object) -> Cells:
    """Single numbers and words of the document of a record's command; none where it writes none."""
    for item in _offers_of(record):
        if item.name.endswith(".json") and item.view is not None:
            return {key: value for key, value in item.view().items() if _single(value)}
    return {}


def plot(record: object, name: str | None = None, ax: "Axes | None" = None) -> "Figure":
    """Return a picture of a record as a matplotlib Figure, as ``records.ReadableRecord.plot`` says."""
    views = _views_of(record, ".png")
    if ax is None:
        return _choose_view(record, views, name, "picture")()
    into = {key: view for key, view in views.items() if "ax" in inspect.signature(view).parameters}
    if name in views and name not in into:
        mend = f"leave it out, or draw {listed(list(into))}" if into else "leave it out"
        raise ArgumentError("ax", f"picture {name!r} has several panels", mend)
    return _choose_view(record, into, name, "picture of one chart")(ax=ax)


def save(record: Any, folder: str | PathLike[str], pictures: bool = True) -> Path:
    """Write the files of a record's command, as ``records.ReadableRecord.save`` says."""
    view = view_of(record)
    if view.files is None and view.offers is None:
        what = f"no command writes files of a {type(record).__name__}"
        raise ArgumentError("folder", what, "save the record that a command gives")
    order, bowl = getattr(record, "order", None), getattr(record, "bowl", None)  # an order of a machine
    part = getattr(record if order is None else order, "part", None)
    source = None if bowl is None else bowl.source
    inputs = {} if part is None else dict(part.inputs)
    inputs |= getattr(record, "inputs", {}) | bowls.identity(source)
    place = ResultFolder(
        check.path("folder", folder), bowls.name(source) if part is None else part.name, inputs
    )
    offers.write(place, _offers_of(record) if view.files is None else view.files(record), pictures=pictures)
    effective = ({} if part is None else conditions(part)) | (
        {} if bowl is None else bowls.texts(settings_of(bowl))
    )
    warnings = [str(line) for line in getattr(record, "warnings", ())]
    place.keep(view.command, effective=effective, warnings=warnings)
    return place.path


@dataclass(frozen=True)
class ShownPart:
    """A page that shows a part, to be turned."""

    path: Path
    page: str

    def __repr__(self) -> str:
        return f"ShownPart({str(self.path)!r})"

    def _repr_html_(self) -> str:
        """Return the page in a frame, as a notebook shows it."""
        return f'<iframe srcdoc="{escape(self.page)}" style="width:100%;height:520px;border:0"></iframe>'


def part_page(part: Part) -> str:
    """Return the page of a part on each of its aspects, to be turned: HTML that needs no other file."""
    from feederscrew.arrivals.aspects_study import aspects
    from feederscrew.output import report_page as report
    from feederscrew.output.page.as_html import html as page_of
    from feederscrew.output.page.blocks import Chapter, Page

    views = Chapter(tuple(report.aspect_views(part, aspects(part, drops=0))))
    return page_of(Page(part.name, part_text(part), (views,), "part"))


def shown(part: Part) -> ShownPart:
    """Return the page of a part; opened in a browser where no notebook shows it."""
    page = part_page(part)
    path = Path(tempfile.mkdtemp(prefix="feeder-")) / f"{safe_name(part.name)}.html"
    path.write_text(page, encoding="utf-8")
    if "ipykernel" not in sys.modules:
        webbrowser.open(path.as_uri())
    return ShownPart(path, page)


def html(record: object) -> str:
    """Return what a notebook shows of a record, all of it escaped: its answer, and its table or its view."""
    line = f"<p>{escape(repr(record))}</p>"
    if isinstance(record, Part) and record.vertices is not None:
        # on the lowest side of its file, shaded
        solid = shading.Rays(record.vertices, record.faces, record.centre_of_mass)
        colours = np.round(255.0 * shading.on_its_lowest(solid, VIEW_PX)[..., :3])
        content = base64.b64encode(style.png(style.pixels(colours.astype(np.uint8)))).decode()
        name = escape(printable(record.name))
        return f'{line}<img width="{VIEW_PX[0]}" alt="{name}" src="data:image/png;base64,{content}">'
    if isinstance(record, Bowl) and record.settings:
        # the keys that somebody gave, with where they come from; all of them where none was
        own = [setting for setting in record.settings if setting.is_own] or record.settings
        cells = ((setting.key.name, setting.text, setting.origin) for setting in own)
        table = tables.data_frame(Frame.of_cells(("key", "value", "from"), cells))
    else:
        table = frame(record)
    table = table.map(lambda cell: printable(cell) if isinstance(cell, str) else cell)
    return line + table.to_html(index=False, max_rows=60, na_rep="", border=0)


def _views_of(record: object, end: str) -> dict[str, View]:
    """The views of the tables or pictures that a record's command offers, by name."""
    offered = ((offer.name, offer.view) for offer in _offers_of(record) if offer.name.endswith(end))
    return {name.removesuffix(end): view for name, view in offered if view is not None}


def _offers_of(record: object) -> Iterable[offers.Offer]:
    view = view_of(record)
    if view.offers is not None:
        return view.offers(record)
    resting = getattr(record, "resting", None)  # a report begins with it
    return [] if resting is None else _offers_of(resting)


def _choose_view(record: object, views: Mapping[str, View], name: str | None, what: str) -> View:
    if name is None and views:
        return next(iter(views.values()))
    if name is not None and name in views:
        return views[name]
    mend = f"give one of {listed(list(views))}" if views else "ask the record that a command gives"
    kind = type(record).__name__
    raise ArgumentError("name", f"{kind} has no {what}{f' {name!r}' if name else ''}", mend)


def _numbers(record: Any, before: str = "") -> Cells:
    """Fields of a record and of those in it by their names: single ones, and one for each of several."""
    numbers: Cells = {}
    for field in fields(record):
        value = getattr(record, field.name)
        row = isinstance(value, tuple) and len(value) > 0 and all(map(_single, value))
        if is_dataclass(value):
            numbers |= _numbers(value, f"{before}{field.name}.")
        elif _single(value) or row or (isinstance(value, np.ndarray) and value.ndim == 1):
            numbers[f"{before}{field.name}"] = value
    return numbers


def _single(value: object) -> bool:
    return value is None or isinstance(value, (str, bool, int, float, np.number))
