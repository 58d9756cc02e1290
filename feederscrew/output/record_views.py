"""The answer, the table and the picture of a record: what a notebook shows."""

import base64
import math
from collections.abc import Callable
from dataclasses import dataclass, fields, is_dataclass
from html import escape
from importlib import import_module
from typing import Any

import numpy as np

from feederscrew.errors import ArgumentError
from feederscrew.heavy import heavy
from feederscrew.mechanics.floor_balance import MOTION_STATES
from feederscrew.output import offers, style, tables
from feederscrew.units import DEGREE, MINUTE, MM, counted, listed, printable

shading = heavy("feederscrew.output.shading")
UM, GRAM, PERCENT = 1e-6, 1e-3, 0.01  # [SI]
MOST_SHARES = 8  # aspects in a line


def answer(record: Any) -> str | None:
    """Return what a record answers, without its class: 'bracket: A 42 %, B 17 %'; None of another class."""
    line = view_of(record).line
    return None if line is None else line(record)


def number(value: Any, unit_in_si: float = 1.0, digits: int = 3) -> str:
    """Return a number in a unit; of an array its shape, '-' of what is not known."""
    if value is None or np.ndim(value):
        return "-" if value is None else f"<{np.size(value)} values>"
    return "-" if math.isnan(value) else f"{value / unit_in_si:.{digits}g}"


def _part(part: Any) -> str:
    mass = f"{number(part.mass, GRAM)} g"
    if part.vertices is None:
        return f"{part.name}: a part card, {mass}, {counted(len(part.aspects), 'aspect')}"
    size = " x ".join(number(side, MM) for side in np.ptp(part.vertices, axis=0))
    open_surface = ", open surface" * part.open_surface
    return f"{part.name}: {size} mm, {mass} ({part.material}), {len(part.faces)} facets{open_surface}"


def _bowl_line(bowl: Any) -> str:
    drive, friction, track = bowl.drive, bowl.friction, bowl.track
    devices = ", ".join(device.name for device in bowl.devices) or "none"
    return (
        f"{_origin(bowl)}: amplitude {number(drive.amplitude, MM)} mm at {number(drive.frequency)} Hz and "
        f"{number(drive.vibration_angle, DEGREE)} deg, friction {number(friction.static)}, "
        f"track {number(track.width, MM)} mm wide, radius {number(track.radius, MM)} mm, "
        f"climb {number(track.climb, DEGREE)} deg, bank {number(track.bank, DEGREE)} deg, "
        f"devices: {devices:.120}"
    )


def _origin(bowl: Any) -> str:
    """Where a bowl is from: 'bowl.yaml, 2 overrides', 'defaults'; 'changed' after it was read."""
    if not bowl.settings:
        return "changed after it was read"
    own = [setting for setting in bowl.settings if setting.is_own]
    files = list(dict.fromkeys(s.where.rsplit(":", 2)[0] for s in own if not s.overrides))
    overrides = sum(setting.overrides for setting in own)
    return ", ".join([*(files or ["defaults"]), *([counted(overrides, "override")] if overrides else [])])


def _shares(names: Any, shares: Any) -> str:
    """Names with their shares, the largest first: 'A 42 %, B 17 %'."""
    ranked = sorted(zip(names, np.nan_to_num(shares)), key=lambda pair: -pair[1])
    texts = [f"{name} {number(share, PERCENT)} %" for name, share in ranked[:MOST_SHARES]]
    return ", ".join([*texts, *([f"{len(ranked) - MOST_SHARES} more"] if len(ranked) > MOST_SHARES else [])])


def _aspects(aspects: Any) -> str:
    shares = _shares(aspects.names, aspects.chances[aspects.ranking])
    return f"rests on {shares} ({aspects.source(aspects.ranking)})"


def _convey(answer: Any) -> str:
    return (
        f"{number(answer.velocity, MM)} mm/s up the track, {answer.status}, regime {answer.regime}, "
        f"throw number {number(answer.throw_number)}"
    )


def _rate(rate: Any) -> str:
    orientation, parts = rate.orientations.lying[rate.row], rate.parts
    low, value, high = (number(end * MINUTE) for end in (parts.low, parts.value, parts.high))
    return (
        f"{_orientation(orientation)}: {value} parts/min ({low} to {high}), "
        f"efficiency {number(rate.efficiency, PERCENT)} %, purity {number(rate.purity, PERCENT)} %"
    )


def _orientation(orientation: Any) -> str:
    """An orientation in words: 'A at heading 90 deg', 'A hanging'."""
    lying = f"at heading {number(orientation.heading, DEGREE)} deg"
    return f"{orientation.aspect} {'hanging' if orientation.kind == 'hanging' else lying}"


def _tune(study: Any) -> str:
    settings = [
        f"{tuned.solution.key.name} {tuned.solution.number:.4g} {tuned.solution.key.unit}".rstrip()
        for tuned in study.settings
    ]
    return f"{study.part.name}: {number(study.target * MINUTE)} parts/min with {' or '.join(settings)}"


def _slide(study: Any) -> str:
    lines = [
        f"at {number(slide_map.beta, DEGREE)} deg regime {slide_map.regime}, "
        f"limiting friction {number(slide_map.at_bowl['mu_limit'])}"
        for slide_map in study.maps[:4]
    ]
    return "; ".join(lines)


def _floor(study: Any) -> str:
    where = f"{study.part.name} on {study.posture.name} at {number(study.heading, DEGREE)} deg"
    return f"{where}: {_states(study.cycle.state)} over a period of the drive"


def _track(study: Any) -> str:
    heading = number(study.headings.headings[study.row], DEGREE) if study.headings is not None else "-"
    where = f"{study.part.name} on {study.posture.name} at heading {heading} deg"
    return f"{where}: {_states(study.cycle.state)} over a period of the drive"


def _states(codes: Any) -> str:
    """States of a part in the order of their codes: 'stick and slide'."""
    return listed([MOTION_STATES[code] for code in np.unique(codes)])


def _headings(study: Any) -> str:
    lines = [
        f"{stable.aspect} at {', '.join(number(angle, DEGREE) for angle in stable.headings[:3])} deg"
        for stable in study.headings[:MOST_SHARES]
    ]
    return f"{study.part.name}: {'; '.join(lines)}"


def _machine(sheet: Any) -> str:
    text = (
        f"bowl of {number(2.0 * sheet.bowl.track.radius, MM)} mm, {number(sheet.stroke.peak_to_peak, MM)} mm "
        f"peak to peak at {number(sheet.stroke.frequency)} Hz, {number(sheet.answer.velocity, MM)} mm/s"
    )
    if sheet.order is None:
        return text
    return f"{sheet.order.part.name} at {number(sheet.order.target * MINUTE)} parts/min: {text}"


def _tooling(study: Any) -> str:
    designs = [_isolated(study.orientations, design) for design in study.designs if design is not None]
    more = f"; {len(designs) - 4} more" if len(designs) > 4 else ""
    return f"{study.part.name}: {'; '.join(designs[:4])}{more}"


def _isolated(orientations: Any, design: Any) -> str:
    """A design in words: 'A at heading 90 deg isolated by wiper (efficiency 80 %, purity 100 %)'."""
    where, cuts = _orientation(orientations[design.wanted]), [cut.device.name for cut in design.cuts]
    if not design.isolated and not cuts:
        return f"{where} not isolated"
    shares = f"efficiency {number(design.efficiency, PERCENT)} %, purity {number(design.purity, PERCENT)} %"
    word = "isolated" if design.isolated else "not isolated"
    return f"{where} {word} by {', '.join(cuts) or 'the devices of the bowl'} ({shares})"


def _trial(study: Any) -> str:
    runs = [
        f"at {number(run.bowl.drive.amplitude, MM)} mm {int(run.counts[:, 0].sum())} of "
        f"{int(run.counts.sum())} parts pass, efficiency {number(run.efficiency, PERCENT)} %, "
        f"purity {number(run.purity, PERCENT)} %"
        for run in study.runs[:4]
    ]
    return f"{study.part.name}: {'; '.join(runs)}"


def _design(study: Any) -> str:
    if study.bowl is None:
        return f"{study.part.name}: {study.status} - {study.why:.300}"
    value, low, high = (number(rate * MINUTE) for rate in study.delivered)
    return (
        f"{study.part.name}: {study.status}, {study.wanted} at {value} parts/min ({low} to {high}) through "
        f"{', '.join(device.name for device in study.devices) or 'no device'}{_why(study)}"
    )


def _why(study: Any) -> str:
    return f" - {study.why:.240}" if study.why else ""


def _family(study: Any) -> str:
    members = ", ".join(f"{member.part.name} {member.status}" for member in study.members)
    return f"{study.status}, {'one bowl for all' if study.shared else 'a bowl for each'}: {members}"


def _compare(study: Any) -> str:
    return f"{study.part.name}: {counted(len(study.rules), 'rule')} beside counts of {study.measured.source}"


def _calibrate(study: Any) -> str:
    fits = [
        f"{fit.name} exponent {number(fit.calibration.exponent)} "
        f"({number(fit.calibration.low)} to {number(fit.calibration.high)})"
        for fit in study.fits[:4]
    ]
    return f"{study.part.name}: {'; '.join(fits)}"


def _drop(study: Any) -> str:
    return f"{study.part.name}: {study.drops} drops, {_shares(study.aspects.names, study.tally.p)}"


def _plate(study: Any) -> str:
    plates = [
        f"throw number {number(plate.throw_number)}: {_shares(study.aspects.names, plate.occupancy.plate)}"
        for plate in study.plates[:3]
    ]
    return f"{study.part.name}: {'; '.join(plates)}"


def _inertia(study: Any) -> str:
    centre = ", ".join(number(value, MM) for value in study.part.centre_of_mass)
    moments = ", ".join(number(value, 1e-9) for value in study.balance.moments)
    mass = number(study.part.mass, GRAM)
    return f"{study.part.name}: {mass} g, centre of mass {centre} mm, principal moments {moments} g mm2"


@dataclass(frozen=True)
class RecordView:
    """How a record is shown: its answer in a line, and what offers the files of its command."""

    line: Callable[[Any], str] | None = None
    offers: str = ""  # module of ``output`` and its function, '' of a record that is no study
    arguments: tuple[Any, ...] = ()  # that it is handed as well


VIEWS = {  # by the name of the record's class
    "Part": RecordView(_part),
    "Bowl": RecordView(_bowl_line),
    "Aspects": RecordView(_aspects),
    "AspectsStudy": RecordView(
        lambda study: f"{study.part.name} {_aspects(study.aspects)}", "aspects.offers"
    ),
    "Shares": RecordView(lambda shares: _aspects(shares.aspects)),
    "Answer": RecordView(_convey),
    "ConveyStudy": RecordView(lambda study: _convey(study.answer), "convey.offers"),
    "ConveyCurve": RecordView(None, "convey.curve_offers"),
    "ConveyPhase": RecordView(None, "convey.phase_offers"),
    "ConveyMap": RecordView(None, "convey.map_offers"),
    "SlideStudy": RecordView(_slide, "slide.offers"),
    "HeadingsStudy": RecordView(_headings, "headings.offers"),
    "FloorStudy": RecordView(_floor, "floor.offers"),
    "TrackStudy": RecordView(_track, "track.offers"),
    "Rate": RecordView(_rate),
    "RateStudy": RecordView(lambda study: f"{study.part.name} {_rate(study.rate)}", "rate.offers"),
    "TuneStudy": RecordView(_tune, "tune.offers"),
    "MachineSheet": RecordView(_machine, "machine.offers"),
    "ToolingStudy": RecordView(_tooling, "tooling.offers", ((),)),
    "TrialStudy": RecordView(_trial, "trial.tables.offers"),
    "DesignStudy": RecordView(_design, "design_pages.offers", ((),)),
    "FamilyStudy": RecordView(_family, "design_pages.family_offers"),
    "CompareStudy": RecordView(_compare, "compare.offers"),
    "SetsStudy": RecordView(None, "compare.sets_offers"),
    "FeedingStudy": RecordView(None, "compare.feeding_offers"),
    "CalibrateStudy": RecordView(_calibrate, "compare.calibration_offers"),
    "DropStudy": RecordView(_drop, "drop.offers"),
    "PlateStudy": RecordView(_plate, "plate.offers"),
    "InertiaStudy": RecordView(_inertia, "inertia.offers"),
    "ReportStudy": RecordView(lambda study: f"{study.part.name} {_aspects(study.shares.aspects)}"),
}


def view_of(record: Any) -> RecordView:
    """Return the RecordView of a record's class or of one that it is made from; an empty one without any."""
    return next(
        (VIEWS[kind.__name__] for kind in type(record).__mro__ if kind.__name__ in VIEWS), RecordView()
    )


MOST_ROWS = 60  # of a table in a notebook
VIEW_PX = 360, 280  # [px] of a part


def frame(record, name=None):
    """Return a table of a record as a DataFrame, as ``records.ReadableRecord.to_frame`` says.

    Parameters
    ----------
    record : ReadableRecord
    name : str, optional

    Returns
    -------
    DataFrame
        Of a record that is no study: a row of its numbers in SI units, or a row for each entry of its arrays.
    """
    offered = _named(record, ".csv")
    if name is not None or offered:
        return tables.data_frame(_chosen(record, offered, name, "table").view())
    numbers = _document(record) or _numbers(record)
    return tables.data_frame(_columns(numbers))


def plot(record, name=None):
    """Return a picture of a record as a matplotlib Figure, as ``records.ReadableRecord.plot`` says.

    Parameters
    ----------
    record : ReadableRecord
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
    record : ReadableRecord

    Returns
    -------
    str
        Whatever a file or a user wrote is escaped.
    """
    line = f"<p>{escape(repr(record))}</p>"
    names = {kind.__name__ for kind in type(record).__mro__}
    if "Part" in names and record.vertices is not None:
        name = escape(printable(record.name))
        return f'{line}<img width="{VIEW_PX[0]}" alt="{name}" src="{_view_uri(record)}">'
    frame_of = _settings if "Bowl" in names and record.settings else frame
    cells = frame_of(record).map(lambda cell: printable(cell) if isinstance(cell, str) else cell)
    return line + cells.to_html(index=False, max_rows=MOST_ROWS, na_rep="", border=0)


def _view_uri(part) -> str:
    """A part on the lowest side of its file, shaded, as the address of an image."""
    solid = shading.Rays(part.vertices, part.faces, part.centre_of_mass)
    image = style.pixels(np.round(255.0 * shading.on_its_lowest(solid, VIEW_PX)[..., :3]).astype(np.uint8))
    return f"data:image/png;base64,{base64.b64encode(style.png(image)).decode()}"


def _settings(bowl):
    """The keys of a bowl that somebody gave, with where they come from; all of them where none was."""
    own = [setting for setting in bowl.settings if setting.is_own] or bowl.settings
    columns = {"key": [s.key.name for s in own], "value": [s.text for s in own]}
    return tables.data_frame(tables.frame(columns | {"from": [s.origin for s in own]}))


def _named(record, end) -> dict[Any, Any]:
    """What the command of a record offers with files of one kind, by the names without it."""
    return {offer.name.removesuffix(end): offer for offer in _offered(record) if offer.name.endswith(end)}


def _offered(record):
    view = view_of(record)
    if view.offers:
        module, _, function = view.offers.rpartition(".")
        return getattr(import_module(f"feederscrew.output.{module}"), function)(record, *view.arguments)
    resting = getattr(record, "resting", None)  # a report begins with it
    return [] if resting is None else _offered(resting)


def _chosen(record, offered, name, what):
    """The offer of a name, or the first."""
    if name is None and offered:
        return next(iter(offered.values()))
    if name in offered:
        return offered[name]
    mend = f"give one of {listed(list(offered))}" if offered else "ask the record that a command gives"
    kind = type(record).__name__
    raise ArgumentError("name", f"{kind} has no {what}{f' {name!r}' if name else ''}", mend)


def _document(record) -> dict[Any, Any]:
    """Numbers and words of the document that a command writes where it writes no table."""
    for offer in _offered(record):
        if isinstance(offer, offers.Offer) and offer.name.endswith(".json") and offer.view is not None:
            return {key: value for key, value in offer.view().items() if _single(value)}
    return {}


def _numbers(record, before=""):
    """Fields of a record and of those in it by their names: single ones, and arrays."""
    numbers: dict[str, Any] = {}
    for field in fields(record):
        value = getattr(record, field.name)
        if is_dataclass(value):
            numbers |= _numbers(value, f"{before}{field.name}.")
        elif _single(value) or _row(value):
            numbers[f"{before}{field.name}"] = value
    return numbers


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
