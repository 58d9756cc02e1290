"""Files of ``feeder drop --plate``."""

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from feederscrew.arrivals.drop import (
    PLATE_COLUMNS,
    PLATE_RATE_COLUMNS,
    PLATE_TEST_COLUMNS,
    PlateOf,
    PlateStudy,
)
from feederscrew.arrivals.plate_test import MIN_TRANSITIONS, Occupancy, PlateResult
from feederscrew.base.arrays import Floats
from feederscrew.base.columns import Document, Frame, of_arrays, values
from feederscrew.base.heavy import heavy
from feederscrew.base.units import MM, MM_S, counted
from feederscrew.bowl import Bowl
from feederscrew.output import offers as offer
from feederscrew.output import style
from feederscrew.output.offers import RecordView
from feederscrew.output.record_lines import plate_text
from feederscrew.resting.rules import registry

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

matplotlib = heavy("matplotlib")

SURFACE = ("restitution", "friction")  # of a launch: the plate's own
COLOURS = [rule.colour for rule in registry.RULES] + list(style.SPARE_COLOURS)
LABELLED = 0.02  # share of the parts from which an aspect carries its name, or a line in a trend


def spare(frame: Frame) -> list[tuple[str, ...]]:
    """Return groups of columns to leave out of a table for people that is too wide; empty ones go first.

    Parameters
    ----------
    frame : Frame
        Of a PlateStudy.

    Returns
    -------
    list of tuple of str
    """
    limit = ("p_limit", "p_limit_low", "p_limit_high")
    groups = [limit, ("height_mm",), ("throw_number",), ("p_start",)]
    return groups if np.isnan(frame["p_limit"]).all() else groups[1:] + groups[:1]


def summary(study: PlateStudy) -> Iterator[str]:
    """Yield how fast parts travel on each plate, a line each.

    Parameters
    ----------
    study : PlateStudy

    Yields
    ------
    str
    """
    for plate, name in zip(study.plates, study.names):
        yield f"{_where(plate, name)}: {_travels(plate, 4)}, {plate.transitions} transitions seen"


def _travels(result: PlateResult, digits: int) -> str:
    speed, low, high = (f"{end:.{digits}g}" for end in result.occupancy.velocity / MM_S)
    return f"travels at {speed} mm/s" + f" ({low} to {high})" * (result.parts > 1)


def document(study: PlateStudy) -> Document:
    """Return a dynamic bowl test as one JSON document.

    Parameters
    ----------
    study : PlateStudy

    Returns
    -------
    dict
    """
    listed = [
        values(PLATE_TEST_COLUMNS, plate)
        | {"aspects": of_arrays(PLATE_COLUMNS, plate), "rates": of_arrays(PLATE_RATE_COLUMNS, plate)}
        for plate in study.each
    ]
    return {
        "part": study.part.name,
        "seed": study.seed,
        "launch": {name: value for name, value in study.plates[0].launch.items() if name not in SURFACE},
        "partial": study.partial,
        "plates": listed,
    }


def remarks(study: PlateStudy) -> list[str]:
    """Return what a user must know of a test, a line each.

    Parameters
    ----------
    study : PlateStudy

    Returns
    -------
    list of str
    """
    listed = []
    for _, plate, name in study.each:
        where = _where(plate, name)
        if changing := PlateOf(study.aspects, plate, name).changing():
            share = f"the share of {', '.join(changing)}"
            listed.append(f"{where}: {share} still changes; give a longer `seconds`")
        if plate.unsettled:
            listed.append(f"{where}: {plate.unsettled} of {plate.parts} parts lay on no aspect to the end")
        if plate.lost:
            listed.append(f"{where}: {counted(plate.lost, 'part')} could not be followed, not counted")
        if 0 < plate.transitions < MIN_TRANSITIONS:
            few = f"too few transitions ({plate.transitions}) for p_limit"
            listed.append(f"{where}: {few}; give more `drops` or `seconds`")
    if study.partial:
        listed.append(f"partial: stopped after {counted(plate.parts, 'part')} on the plate of {where}")
    return listed


def notes(bowls: Sequence[Bowl]) -> Iterator[str]:
    """Yield what is simplified in a bowl's plate, a line each.

    Parameters
    ----------
    bowls : sequence of Bowl

    Yields
    ------
    str
    """
    if any(bowl.friction.kinetic < bowl.friction.static for bowl in bowls):
        yield "the plate has one coefficient of friction: the kinetic one, for sticking too"
    if any(bowl.friction.backward != (bowl.friction.static, bowl.friction.kinetic) for bowl in bowls):
        yield "the plate has the same friction in every direction: that of slip up the track"


def _where(result: PlateResult, name: str) -> str:
    return f"{name} at {result.bowl.drive.amplitude / MM:.4g} mm"


def offers(study: PlateStudy) -> list[offer.Offer]:
    """Offer the tables of a dynamic bowl test, its document and its chart.

    Parameters
    ----------
    study : PlateStudy

    Returns
    -------
    list of Offer
    """
    draw = _plate_figure if len(study.plates) == 1 else _trend  # over time, or over the throw number
    return [
        offer.table("plate.csv", study.table),
        offer.table("plate_rates.csv", study.rates_table),
        offer.table("plate_time.csv", study.course_table),
        offer.table("plate_drives.csv", study.drives_table),
        offer.document("plate.json", document, study),
        offer.picture("plate.png", "Shares of the aspects on the plate", draw, study),
    ]


def _plate_figure(study: PlateStudy) -> "Figure":
    aspects, result, figure = study.aspects, study.plates[0], style.figure(8.2, 3.8)
    left, right = figure.subplots(1, 2, width_ratios=(1.15, 1.0))
    title = f"{study.part.name}: {counted(result.parts, 'part')}, throw number {result.throw_number:.3g}"
    style.tidy(left, title=title, x="time on the plate [s]", y="parts [%]", grid="y")
    title = _travels(result, 3) + ", partial" * result.partial
    style.tidy(right, title=title, x="aspect", y="share [%]", grid="y")
    # the stacked share of each aspect at every look; what is white above was not down yet
    course = 100.0 * result.occupancy.course
    time = np.linspace(0.0, result.seconds, len(course))
    left.stackplot(time, course.T, colors=[_colour(k) for k in range(course.shape[1])], alpha=0.85, lw=0.0)
    middle = np.cumsum(course, axis=1) - 0.5 * course
    for k, name in enumerate(aspects.names):
        if course[-1, k] > 100.0 * LABELLED:
            style.note(left, name, (time[-1], middle[-1, k]), (4, 0), va="center", annotation_clip=False)
    left.set(xlim=(0.0, time[-1]), ylim=(0.0, 100.0))
    # how parts lay at first and in the second half, with its interval, and where the rates lead
    places = np.arange(len(aspects.names))
    (second, error), (limit, spread) = (_interval(result.occupancy, name) for name in ("plate", "limit"))
    right.bar(places - 0.2, 100.0 * result.occupancy.start, 0.36, color="#aab4bd", label="at first")
    right.bar(places + 0.2, second, 0.36, color=style.INK, alpha=0.8, label="second half")
    right.errorbar(places + 0.2, second, error, fmt="none", ecolor=style.INK, capsize=3, lw=1.0)
    label = None if np.isnan(limit).all() else "where the rates lead"
    look = {"fmt": "_", "ms": 9, "mew": 2, "color": style.ACCENT, "capsize": 3, "lw": 1.0}
    right.errorbar(places + 0.3, limit, spread, label=label, **look)
    style.named_ticks(right, places, aspects.names)
    right.legend(loc="upper right", **style.LEGEND)
    return figure


def _interval(occupancy: Occupancy, name: str) -> tuple[Floats, Floats]:
    """Shares [%], and how far their intervals reach below and above."""
    value, low, high = (100.0 * getattr(occupancy, f"{name}{end}") for end in ("", "_low", "_high"))
    return value, np.stack([value - low, high - value])


def _trend(study: PlateStudy) -> "Figure":
    aspects, figure = study.aspects, style.figure(8.2, 3.8)
    left, right = figure.subplots(1, 2, width_ratios=(1.15, 1.0))
    title = f"{study.part.name} on {len(study.plates)} plates" + ", partial" * study.plates[-1].partial
    style.tidy(left, title=title, x="throw number", y="share in the second half [%]")
    style.tidy(right, title="Transport", x="throw number", y="velocity [mm/s]")
    order = np.argsort([result.throw_number for result in study.plates], kind="stable")
    results, names = [study.plates[k] for k in order], [study.names[k] for k in order]
    x = np.array([result.throw_number for result in results])
    occupancies = [result.occupancy for result in results]
    drawn = np.flatnonzero(np.max([occupancy.plate for occupancy in occupancies], axis=0) > LABELLED).tolist()
    for place, k in enumerate(drawn):  # set a little apart
        at = x + 0.012 * np.ptp(x) * (place - 0.5 * (len(drawn) - 1))
        value, reach = zip(*(_interval(occupancy, "plate") for occupancy in occupancies))
        ends = np.array(reach)[:, :, k].T
        points = {"marker": "o", "ms": 4, "capsize": 2, "label": aspects.names[k]}
        left.errorbar(at, np.array(value)[:, k], ends, color=_colour(k), **points)
        start = [100.0 * occupancy.start[k] for occupancy in occupancies]
        left.plot(at, start, ls=":", lw=1.0, color=_colour(k))
    velocity = np.array([occupancy.velocity for occupancy in occupancies]) / MM_S
    ends = np.abs(velocity[:, 1:] - velocity[:, :1]).T
    right.errorbar(x, velocity[:, 0], ends, color=style.INK, marker="o", ms=4, capsize=2)
    label_strokes(right, x, results, names)
    gone = len(aspects.names) - len(drawn)
    title = "dotted: at first"
    title += f"; {gone} aspects never above {100.0 * LABELLED:g} % left out" if gone else ""
    handles, labels = left.get_legend_handles_labels()
    look: style.Look = {"ncols": 12, "labelcolor": style.INK, "title": title, "title_fontsize": 8}
    style.legend(figure, handles=handles, labels=labels, **look)
    return figure


def label_strokes(axes: "Axes", x: Floats, results: Sequence[PlateResult], names: Sequence[str]) -> None:
    """Draw the stroke of each plate over its point, and the bowl's name where there are several.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
    x : (N,) array
        Of each plate, in the unit of the axis.
    results : sequence of PlateResult
        N of them.
    names : sequence of str
        Of the bowls, N.
    """
    for at, result, name in zip(x, results, names):
        stroke = f"{result.bowl.drive.amplitude / MM:.3g} mm"
        text = f"{name} {stroke}" if len(set(names)) > 1 else stroke
        place = at, np.nanmax(result.occupancy.velocity) / MM_S
        style.note(axes, text, place, (0, 4), ha="center", fontsize=7)
    axes.margins(x=0.2, y=0.15)


def _colour(k: int) -> Any:
    return COLOURS[k] if k < len(COLOURS) else matplotlib.colormaps["viridis"]((0.37 * k) % 1.0)


PLATE_VIEW = RecordView(plate_text, offers, "drop")
