"""The table and the picture of a record: what its command writes, for a person with a notebook."""

import base64
from dataclasses import fields, is_dataclass
from html import escape
from importlib import import_module
from typing import Any

import numpy as np

from feederscrew.errors import ArgumentError
from feederscrew.output import offers, tables
from feederscrew.units import listed, printable

MOST_ROWS = 60  # of a table in a notebook
VIEW = 360, 280  # [px] of a part
# record: module and function that offer the files of its command, and what else that is handed
OF: dict[str, tuple[Any, ...]] = {
    "AspectsStudy": ("aspects.files", "offers"),
    "CalibrateStudy": ("calibrate.files", "offers"),
    "CompareStudy": ("compare.files", "offers"),
    "SetsStudy": ("compare.sets", "offers"),
    "ConveyStudy": ("convey.files", "offers", {}),
    "ConveyCurve": ("convey.files", "curve_offers"),
    "ConveyPhase": ("convey.files", "phase_offers", {}),
    "ConveyMap": ("convey.files", "map_offers"),
    "DesignStudy": ("designs.files", "offers", ()),
    "DropStudy": ("drop.files", "offers"),
    "FamilyStudy": ("designs.family_page", "offers"),
    "FeedingStudy": ("compare.feeding", "offers"),
    "FloorStudy": ("floor.files", "offers", {}),
    "HeadingsStudy": ("headings.files", "offers", {}),
    "InertiaStudy": ("inertia.files", "offers"),
    "MachineSheet": ("machine", "offers"),
    "PlateStudy": ("plate.files", "offers"),
    "RateStudy": ("rate.files", "offers"),
    "SlideStudy": ("slide.files", "offers"),
    "ToolingStudy": ("tooling.files", "offers", ()),
    "TrackStudy": ("track.files", "at_one_point"),
    "TrialStudy": ("trial.files", "offers"),
    "TuneStudy": ("tune.files", "offers"),
}


def frame(record, name=None):
    """Return a table of a record as a DataFrame, as ``records.Shown.to_frame`` says.

    Parameters
    ----------
    record : Shown
    name : str, optional

    Returns
    -------
    DataFrame
        Of a record that is no study: a row of its numbers in SI units, or a row for each entry of its arrays.
    """
    found = _named(record, ".csv")
    if name is not None or found:
        return tables.data_frame(_chosen(record, found, name, "table").view())
    numbers = _document(record) or _numbers(record)
    return tables.data_frame(_columns(numbers))


def plot(record, name=None):
    """Return a picture of a record as a matplotlib Figure, as ``records.Shown.plot`` says.

    Parameters
    ----------
    record : Shown
    name : str, optional

    Returns
    -------
    matplotlib Figure
    """
    return _chosen(record, _named(record, ".png"), name, "picture").view()


def html(record):
    """Return what a notebook shows of a record: its answer, and its table or its view.

    Parameters
    ----------
    record : Shown

    Returns
    -------
    str
        Whatever a file or a user wrote is escaped.
    """
    line = f"<p>{escape(repr(record))}</p>"
    names = {kind.__name__ for kind in type(record).__mro__}
    if "Part" in names and record.vertices is not None:
        return (
            f'{line}<img width="{VIEW[0]}" alt="{escape(printable(record.name))}" src="{_view_uri(record)}">'
        )
    frame_of = _settings if "Bowl" in names and record.settings else frame
    cells = frame_of(record).map(lambda cell: printable(cell) if isinstance(cell, str) else cell)
    return line + cells.to_html(index=False, max_rows=MOST_ROWS, na_rep="", border=0)


def _view_uri(part):
    """A part on the lowest side of its file, shaded, as the address of an image."""
    from feederscrew.output import style
    from feederscrew.output.solid import render, thumbnail

    solid = render.Rays(part.vertices, part.faces, part.centre_of_mass)
    image = style.pixels(np.round(255.0 * thumbnail.on_its_lowest(solid, VIEW)[..., :3]).astype(np.uint8))
    return f"data:image/png;base64,{base64.b64encode(style.png(image)).decode()}"


def _settings(bowl):
    """The keys of a bowl that somebody gave, with where they come from; all of them where none was."""
    given = [setting for setting in bowl.settings if setting.is_own] or bowl.settings
    columns = {"key": [s.key.name for s in given], "value": [s.text for s in given]}
    return tables.data_frame(tables.frame(columns | {"from": [s.origin for s in given]}))


def _named(record, end):
    """What the command of a record offers with files of one kind, by the names without it."""
    return {one.name.removesuffix(end): one for one in _offered(record) if one.name.endswith(end)}


def _offered(record):
    for kind in type(record).__mro__:
        if kind.__name__ in OF:
            module, function, *more = OF[kind.__name__]
            return getattr(import_module(f"feederscrew.output.{module}"), function)(record, *more)
    resting = getattr(record, "resting", None)  # a report begins with it
    return [] if resting is None else _offered(resting)


def _chosen(record, found, name, what):
    """The offer of a name, or the first."""
    if name is None and found:
        return next(iter(found.values()))
    if name in found:
        return found[name]
    mend = f"give one of {listed(list(found))}" if found else "ask the record that a command gives"
    kind = type(record).__name__
    raise ArgumentError("name", f"{kind} has no {what}{f' {name!r}' if name else ''}", mend)


def _document(record):
    """Numbers and words of the document that a command writes where it writes no table."""
    for one in _offered(record):
        if isinstance(one, offers.Offer) and one.name.endswith(".json") and one.view is not None:
            return {key: value for key, value in one.view().items() if _single(value)}
    return {}


def _numbers(record, before=""):
    """Fields of a record and of those in it by their names: single ones, and arrays."""
    found: dict[str, Any] = {}
    for field in fields(record):
        value = getattr(record, field.name)
        if is_dataclass(value):
            found |= _numbers(value, f"{before}{field.name}.")
        elif _single(value) or _row(value):
            found[f"{before}{field.name}"] = value
    return found


def _row(value):
    """Whether a value is one number or word for each of several."""
    if isinstance(value, np.ndarray):
        return value.ndim == 1
    return isinstance(value, tuple) and len(value) > 0 and all(map(_single, value))


def _single(value):
    return value is None or isinstance(value, (str, bool, int, float, np.number))


def _columns(numbers):
    """Arrays of one length as columns where a record has rows, else its single numbers as one row."""
    lengths = [len(value) for name, value in numbers.items() if not _single(value) and "." not in name]
    rows = max(set(lengths), key=lengths.count, default=0)
    if lengths.count(rows) > 1:
        return tables.frame({k: v for k, v in numbers.items() if not _single(v) and len(v) == rows})
    return tables.frame({name: [value] for name, value in numbers.items() if _single(value)})
