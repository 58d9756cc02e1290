"""The answer, the table and the picture of a record: what a notebook shows."""

import base64
import inspect
import math
import sys
import tempfile
import webbrowser
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, fields, is_dataclass
from html import escape
from importlib import import_module
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from feederscrew import bowl as bowls
from feederscrew import check
from feederscrew.arrays import Array, Floats
from feederscrew.bowl import Bowl
from feederscrew.columns import Frame
from feederscrew.errors import ArgumentError
from feederscrew.heavy import heavy
from feederscrew.mechanics.floor_balance import MOTION_STATES
from feederscrew.output import offers, style, tables
from feederscrew.output.folder import ResultFolder, safe_name
from feederscrew.output.offers import Offer
from feederscrew.output.part_facts import conditions
from feederscrew.part.record import Part
from feederscrew.studies.arguments import settings_of
from feederscrew.units import DEGREE, GRAM, MINUTE, MM, counted, listed, printable

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from pandas import DataFrame

    from feederscrew.conveying.answer import Answer
    from feederscrew.designing.families import FamilyStudy
    from feederscrew.designing.record import DesignStudy
    from feederscrew.rates.well_oriented import Rate
    from feederscrew.resting.aspects import Aspects
    from feederscrew.sorting.orientations import Orientation
    from feederscrew.studies.aspects import InertiaStudy
    from feederscrew.studies.bowl import MachineSheet
    from feederscrew.studies.compare import CalibrateStudy
    from feederscrew.studies.drop import PlateStudy
    from feederscrew.studies.floor import FloorStudy
    from feederscrew.studies.headings import HeadingsStudy
    from feederscrew.studies.report import ReportStudy
    from feederscrew.studies.slide import SlideStudy
    from feederscrew.studies.tooling import ToolingStudy
    from feederscrew.studies.track import TrackStudy
    from feederscrew.studies.trial import TrialStudy
    from feederscrew.studies.tune import TuneStudy

shading = heavy("feederscrew.output.shading")
PERCENT = 0.01  # [SI]
MOST_SHARES = 8  # aspects in a line
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
    line = _view_of(record).line
    return None if line is None else line(record)


def _number(value: float | Array | None, unit_in_si: float = 1.0) -> str:
    if value is None or np.ndim(value):
        return "-" if value is None else f"<{np.size(value)} values>"
    return "-" if math.isnan(value) else f"{value / unit_in_si:.3g}"


def _part(part: Part) -> str:
    mass = f"{_number(part.mass, GRAM)} g"
    if part.vertices is None or part.faces is None:
        return f"{part.name}: a part card, {mass}, {counted(len(part.aspects), 'aspect')}"
    size = " x ".join(_number(side, MM) for side in np.ptp(part.vertices, axis=0))
    open_surface = ", open surface" * part.open_surface
    return f"{part.name}: {size} mm, {mass} ({part.material}), {len(part.faces)} facets{open_surface}"


def _bowl(bowl: Bowl) -> str:
    """The bowl after where it is from: 'bowl.yaml, 2 overrides', 'defaults'; 'changed' after it was read."""
    origin = "changed after it was read"
    if bowl.settings:
        own = [setting for setting in bowl.settings if setting.is_own]
        files = list(dict.fromkeys(s.where.rsplit(":", 2)[0] for s in own if not s.overrides))
        overrides = sum(setting.overrides for setting in own)
        last = [counted(overrides, "override")] if overrides else []
        origin = ", ".join([*(files or ["defaults"]), *last])
    drive, friction, track = bowl.drive, bowl.friction, bowl.track
    devices = ", ".join(device.kind for device in bowl.devices) or "none"
    return (
        f"{origin}: amplitude {_number(drive.amplitude, MM)} mm at {_number(drive.frequency)} Hz and "
        f"{_number(drive.vibration_angle, DEGREE)} deg, friction {_number(friction.static)}, "
        f"track {_number(track.width, MM)} mm wide, radius {_number(track.radius, MM)} mm, "
        f"climb {_number(track.climb, DEGREE)} deg, bank {_number(track.bank, DEGREE)} deg, "
        f"devices: {devices:.120}"
    )


def _shares(names: Sequence[str], shares: Floats) -> str:
    """Names with their shares, the largest first: 'A 42 %, B 17 %'."""
    ranked = sorted(zip(names, np.nan_to_num(shares)), key=lambda pair: -pair[1])
    texts = [f"{name} {_number(share, PERCENT)} %" for name, share in ranked[:MOST_SHARES]]
    texts += [f"{len(ranked) - MOST_SHARES} more"] if len(ranked) > MOST_SHARES else []
    return ", ".join(texts)


def _aspects(aspects: "Aspects") -> str:
    shares = _shares(aspects.names, aspects.chances[aspects.ranking])
    return f"rests on {shares} ({aspects.source(aspects.ranking)})"


def _convey(answer: "Answer") -> str:
    return (
        f"{_number(answer.velocity, MM)} mm/s up the track, {answer.status}, regime {answer.regime}, "
        f"throw number {_number(answer.throw_number)}"
    )


def _rate(rate: "Rate") -> str:
    orientation, parts = rate.orientations.lying[rate.row], rate.parts
    low, value, high = (_number(end * MINUTE) for end in (parts.low, parts.value, parts.high))
    return (
        f"{_orientation(orientation)}: {value} parts/min ({low} to {high}), "
        f"efficiency {_number(rate.efficiency, PERCENT)} %, purity {_number(rate.purity, PERCENT)} %"
    )


def _orientation(orientation: "Orientation") -> str:
    """An orientation in words: 'A at heading 90 deg', 'A hanging'."""
    lying = f"at heading {_number(orientation.heading, DEGREE)} deg"
    return f"{orientation.aspect} {'hanging' if orientation.kind == 'hanging' else lying}"


def _tune(study: "TuneStudy") -> str:
    solutions = (tuned.solution for tuned in study.settings)
    settings = (f"{s.key.name} {s.number:.4g} {s.key.unit}".rstrip() for s in solutions)
    return f"{study.part.name}: {_number(study.target * MINUTE)} parts/min with {' or '.join(settings)}"


def _slide(study: "SlideStudy") -> str:
    return "; ".join(
        f"at {_number(slide_map.beta, DEGREE)} deg regime {slide_map.regime}, "
        f"limiting friction {_number(slide_map.at_bowl['mu_limit'])}"
        for slide_map in study.maps[:4]
    )


def _motion(study: "FloorStudy | TrackStudy", heading: str) -> str:
    states = listed([MOTION_STATES[code] for code in np.unique(study.cycle.state)])
    return f"{study.part.name} on {study.posture.name} at {heading} deg: {states} over a period of the drive"


def _track(study: "TrackStudy") -> str:
    lying = study.headings
    return _motion(study, f"heading {_number(None if lying is None else lying.headings[study.row], DEGREE)}")


def _headings(study: "HeadingsStudy") -> str:
    lines = [
        f"{stable.aspect} at {', '.join(_number(angle, DEGREE) for angle in stable.headings[:3])} deg"
        for stable in study.headings[:MOST_SHARES]
    ]
    return f"{study.part.name}: {'; '.join(lines)}"


def _machine(sheet: "MachineSheet") -> str:
    text = (
        f"bowl of {_number(2.0 * sheet.bowl.track.radius, MM)} mm, "
        f"{_number(sheet.stroke.peak_to_peak, MM)} mm peak to peak at {_number(sheet.stroke.frequency)} Hz, "
        f"{_number(sheet.answer.velocity, MM)} mm/s"
    )
    order = sheet.order
    asked = f"{order.part.name} at {_number(order.target * MINUTE)} parts/min: " if order is not None else ""
    return f"{asked}{text}"


def _tooling(study: "ToolingStudy") -> str:
    """Designs in words: 'A at heading 90 deg isolated by wiper (efficiency 80 %, purity 100 %)'."""
    texts = []
    for design in (design for design in study.designs if design is not None):
        text = f"{_orientation(study.orientations[design.wanted])} {'not ' * (not design.isolated)}isolated"
        cuts = [cut.device.kind for cut in design.cuts]
        if design.isolated or cuts:
            efficiency, purity = _number(design.efficiency, PERCENT), _number(design.purity, PERCENT)
            by = ", ".join(cuts) or "the devices of the bowl"
            text += f" by {by} (efficiency {efficiency} %, purity {purity} %)"
        texts.append(text)
    more = f"; {len(texts) - 4} more" if len(texts) > 4 else ""
    return f"{study.part.name}: {'; '.join(texts[:4])}{more}"


def _trial(study: "TrialStudy") -> str:
    runs = [
        f"at {_number(run.bowl.drive.amplitude, MM)} mm {int(run.counts[:, 0].sum())} of "
        f"{int(run.counts.sum())} parts pass, efficiency {_number(run.efficiency, PERCENT)} %, "
        f"purity {_number(run.purity, PERCENT)} %"
        for run in study.runs[:4]
    ]
    return f"{study.part.name}: {'; '.join(runs)}"


def _design(study: "DesignStudy") -> str:
    if study.bowl is None:
        return f"{study.part.name}: {study.status} - {study.why:.300}"
    value, low, high = (_number(rate * MINUTE) for rate in study.delivered)
    return (
        f"{study.part.name}: {study.status}, {study.wanted} at {value} parts/min ({low} to {high}) through "
        f"{', '.join(device.kind for device in study.devices) or 'no device'}"
        + (f" - {study.why:.240}" if study.why else "")
    )


def _family(study: "FamilyStudy") -> str:
    members = ", ".join(f"{member.part.name} {member.status}" for member in study.members)
    return f"{study.status}, {'one bowl for all' if study.shared else 'a bowl for each'}: {members}"


def _calibrate(study: "CalibrateStudy") -> str:
    fits = [
        f"{fit.name} exponent {_number(fit.calibration.exponent)} "
        f"({_number(fit.calibration.low)} to {_number(fit.calibration.high)})"
        for fit in study.fits[:4]
    ]
    return f"{study.part.name}: {'; '.join(fits)}"


def _plate(study: "PlateStudy") -> str:
    plates = [
        f"throw number {_number(plate.throw_number)}: {_shares(study.aspects.names, plate.occupancy.plate)}"
        for plate in study.plates[:3]
    ]
    return f"{study.part.name}: {'; '.join(plates)}"


def _inertia(study: "InertiaStudy") -> str:
    centre = ", ".join(_number(value, MM) for value in study.part.centre_of_mass)
    moments = ", ".join(_number(value, 1e-9) for value in study.balance.moments)
    mass = _number(study.part.mass, GRAM)
    return f"{study.part.name}: {mass} g, centre of mass {centre} mm, principal moments {moments} g mm2"


def _design_files(study: "DesignStudy") -> list[Offer]:
    """The files of a design, with the machine below its bowl."""
    from feederscrew.designing.design import Built, build_machine, with_machine
    from feederscrew.output import design_pages

    settings = () if study.bowl is None else settings_of(study.bowl)
    built = Built() if study.partial else build_machine(study, settings)
    return design_pages.offers(with_machine(study, built), settings, built)


def _tooling_files(study: "ToolingStudy") -> list[Offer]:
    """The files of tooling, with a bowl file that says what the study's bowl is."""
    from feederscrew.output import tooling

    return tooling.offers(study, settings_of(study.bowl))


def _report_files(study: "ReportStudy") -> list[Offer]:
    """The page of a report."""
    from feederscrew.output import report
    from feederscrew.output.page.as_html import html as page_of

    return [offers.text("report.html", lambda: page_of(report.page(study)))]


@dataclass(frozen=True)
class RecordView:
    """View of a record: its answer in a line, and the function that offers the files of its command."""

    line: Callable[[Any], str] | None = None
    offers: str = ""  # module of ``output`` and its function, '' of a record that is no study
    arguments: tuple[Any, ...] = ()  # that it is handed as well
    command: str = ""  # under which the files are recorded; '' : the module of ``output``
    files: Callable[[Any], list[Offer]] | None = None  # what is saved, where that takes more


VIEWS = {  # by the name of the record's class
    "Part": RecordView(_part),
    "Bowl": RecordView(_bowl),
    "Aspects": RecordView(_aspects),
    "AdviceStudy": RecordView(lambda x: f"{x.part.name}: {x.answer}", "advise.offers"),
    "AspectsStudy": RecordView(lambda x: f"{x.part.name} {_aspects(x.aspects)}", "aspects.offers"),
    "Shares": RecordView(lambda x: _aspects(x.aspects)),
    "Answer": RecordView(_convey),
    "ConveyStudy": RecordView(lambda x: _convey(x.answer), "convey.offers"),
    "ConveyCurve": RecordView(None, "convey.curve_offers"),
    "ConveyPhase": RecordView(None, "convey.phase_offers"),
    "ConveyMap": RecordView(None, "convey.map_offers"),
    "SlideStudy": RecordView(_slide, "slide.offers"),
    "HeadingsStudy": RecordView(_headings, "headings.offers"),
    "FloorStudy": RecordView(lambda x: _motion(x, _number(x.heading, DEGREE)), "floor.offers"),
    "TrackStudy": RecordView(_track, "track.offers"),
    "Rate": RecordView(_rate),
    "RateStudy": RecordView(lambda x: f"{x.part.name} {_rate(x.rate)}", "rate.offers"),
    "TuneStudy": RecordView(_tune, "rate.tune_offers", (), "tune"),
    "MachineSheet": RecordView(_machine, "machine.offers", (), "bowl"),
    "ToolingStudy": RecordView(_tooling, "tooling.offers", ((),), "tooling", _tooling_files),
    "TrialStudy": RecordView(_trial, "trial.tables.offers"),
    "DesignStudy": RecordView(_design, "design_pages.offers", ((),), "design", _design_files),
    "FamilyStudy": RecordView(_family, "design_pages.family_offers", (), "design"),
    "CompareStudy": RecordView(
        lambda x: f"{x.part.name}: {counted(len(x.rules), 'rule')} beside counts of {x.measured.source}",
        "compare.offers",
    ),
    "SetsStudy": RecordView(None, "compare.sets_offers"),
    "FeedingStudy": RecordView(None, "compare.offers"),
    "CalibrateStudy": RecordView(_calibrate, "compare.calibration_offers", (), "calibrate"),
    "DropStudy": RecordView(
        lambda x: f"{x.part.name}: {x.drops} drops, {_shares(x.aspects.names, x.tally.p)}", "drop.offers"
    ),
    "PlateStudy": RecordView(_plate, "plate.offers", (), "drop"),
    "InertiaStudy": RecordView(_inertia, "inertia.offers"),
    "ReportStudy": RecordView(
        lambda x: f"{x.part.name} {_aspects(x.shares.aspects)}", "", (), "report", _report_files
    ),
}


def _view_of(record: object) -> RecordView:
    """The RecordView of a record's class or of one that it is made from; an empty one without any."""
    names = (kind.__name__ for kind in type(record).__mro__)
    return next((VIEWS[name] for name in names if name in VIEWS), RecordView())


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


def _document_numbers(record: object) -> dict[str, Any]:
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
    view = _view_of(record)
    if view.files is None and not view.offers:
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
    place.keep(view.command or view.offers.partition(".")[0], effective=effective, warnings=warnings)
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
    from feederscrew.output import report
    from feederscrew.output.page.as_html import html as page_of
    from feederscrew.output.page.blocks import Chapter, Page
    from feederscrew.studies.aspects import aspects

    views = Chapter(tuple(report.aspect_views(part, aspects(part, drops=0))))
    return page_of(Page(part.name, _part(part), (views,), "part"))


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
    view = _view_of(record)
    if view.offers:
        module, _, function = view.offers.rpartition(".")
        return getattr(import_module(f"feederscrew.output.{module}"), function)(record, *view.arguments)
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


def _numbers(record: Any, before: str = "") -> dict[str, Any]:
    """Fields of a record and of those in it by their names: single ones, and one for each of several."""
    numbers: dict[str, Any] = {}
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
