"""Files of ``feeder convey``: at one point, along a curve, over the phase, over a map."""

from collections.abc import Mapping, Sequence
from operator import attrgetter
from typing import Any

import numpy as np

from feederscrew import bowl as bowls
from feederscrew.base.arrays import Array, Bools, Floats
from feederscrew.base.columns import Document, Frame, of_arrays, quantities, values
from feederscrew.base.geometry.grids import Grid
from feederscrew.base.heavy import heavy
from feederscrew.base.units import MM_S, factor
from feederscrew.bowl.record import Bowl
from feederscrew.motion import conveying as answer
from feederscrew.motion import steady
from feederscrew.motion.convey import ConveyCurve, ConveyMap, ConveyPhase, ConveyStudy
from feederscrew.motion.conveying import (
    ANSWER_COLUMNS,
    BEST_PHASE_COLUMNS,
    NEIGHBOUR_COLUMNS,
    OVER_FRICTION_COLUMNS,
    Neighbours,
    throw_of_flight,
)
from feederscrew.motion.limits import Regime
from feederscrew.motion.operating_point import PHASES
from feederscrew.motion.steady import MotionStatus
from feederscrew.output import offers as offer
from feederscrew.output import style
from feederscrew.output.offers import RecordView
from feederscrew.output.record_lines import convey_text
from feederscrew.output.tables import PHASE_WORDS, regime_words

matplotlib = heavy("matplotlib")
mpl_colors = heavy("matplotlib.colors")
mpl_patches = heavy("matplotlib.patches")

UNSTEADY_WORDS = {
    answer.UnsteadyMotion.SLIDES_DOWN: "the part slides down the track without stopping",
    answer.UnsteadyMotion.KEEPS_SPEED: "without friction a part on the level keeps whatever speed it has",
}


def document(study: ConveyStudy) -> Document:
    """Return conveying at one operating point as the JSON document, ``convey.json``.

    Parameters
    ----------
    study : ConveyStudy

    Returns
    -------
    dict
        Units stand in the names of its keys.
    """
    conveying = study.answer

    def change_entry(pair: Neighbours, change: float) -> Document:
        return {
            "change_percent": 100.0 * change,
            **values(NEIGHBOUR_COLUMNS, pair),
            "percent_per_percent": pair.elasticity(conveying.velocity, change),
        }

    nearby = study.nearby.items()
    return {
        **values(ANSWER_COLUMNS, conveying),
        "sensitivity": {name: change_entry(pair, answer.SENSITIVITY_CHANGE) for name, pair in nearby},
        "friction_doubt": change_entry(study.doubt, answer.FRICTION_DOUBT),
        "restitution_doubt": restitution_entry(study.bowl, study.rebound),
        "validity": study.validity,
        "bowl": bowls.texts(study.bowl.settings),
    }


def restitution_entry(bowl: Bowl, neighbours: Neighbours | None) -> Document | None:
    """Return a document's entry on the spread of restitution.

    Parameters
    ----------
    bowl : Bowl
    neighbours : Neighbours or None
        Velocities at the lowest and at the highest restitution; None where nothing is thrown up.

    Returns
    -------
    dict or None
        None where nothing is thrown up.
    """
    if neighbours is None:
        return None
    ends = dict(zip(("restitution_low", "restitution_high"), answer.rebounds(bowl)))
    return ends | values(NEIGHBOUR_COLUMNS, neighbours)


def summary(document: Mapping[str, Any]) -> Frame:
    """Return the document of one operating point as a frame for people.

    Parameters
    ----------
    document : mapping
        Of ``document``.

    Returns
    -------
    Frame
    """
    d, margins = document, document["margins"]

    def limit(value: float, margin: float) -> str:
        return "never holds" if np.isnan(value) else f"{_number(value)} (margin {_number(margin)})"

    def change(name: str, pair: Mapping[str, Any]) -> tuple[str, str]:
        less, more = _number(pair["velocity_less_mm_s"]), _number(pair["velocity_more_mm_s"])
        return f"velocity for {name} -/+ {pair['change_percent']:g} % [mm/s]", f"{less} / {more}"

    rows = [
        ("velocity [mm/s]", "no steady velocity" if d["unsteady"] else _number(d["velocity_mm_s"])),
        ("lowest to highest [mm/s]", _range_text(d["velocity_low_mm_s"], d["velocity_high_mm_s"])),
    ]
    if d["period"] != 1 and not d["unsteady"]:  # single periods are not all alike
        rows.append(("slowest to fastest period [mm/s]", _slowest_to_fastest(d)))
    periods = f", every {d['period']} periods" if d["period"] > 1 else ""
    rows += [
        ("status", d["status"] + periods),
        ("regime", regime_words(d["regime"])),
        ("acceleration ratio A w2/g", _number(d["acceleration_ratio"])),
        ("throw number", limit(d["throw_number"], margins["hop"])),
        ("friction that stops slip up the track", limit(d["mu_forward"], margins["forward"])),
        ("friction that stops slip down the track", limit(d["mu_backward"], margins["backward"])),
        *((f"time it {PHASE_WORDS[name]} [%]", _number(100.0 * x)) for name, x in d["fractions"].items()),
        ("longest flight [periods]", _number(d["longest_flight_periods"])),
        ("hardest impact [mm/s]", _number(d["hardest_impact_mm_s"])),
        *(change(name, pair) for name, pair in d["sensitivity"].items()),
        change("friction", d["friction_doubt"]),
    ]
    if spread := d["restitution_doubt"]:
        ends = " / ".join(_number(spread[f"restitution_{end}"]) for end in ("low", "high"))
        speeds = " / ".join(_number(spread[f"velocity_{end}_mm_s"]) for end in ("less", "more"))
        rows.append((f"velocity for restitution {ends} [mm/s]", speeds))
    return quantities([*rows, ("validity", d["validity"])])


def remarks(document: Mapping[str, Any]) -> list[str]:
    """Return what a reader of the document of one operating point must not overlook, a sentence each.

    Parameters
    ----------
    document : mapping
        Of ``document``.

    Returns
    -------
    list of str
    """
    low, high = document["velocity_low_mm_s"], document["velocity_high_mm_s"]
    if document["unsteady"]:
        return [f"no steady state: {UNSTEADY_WORDS[document['unsteady']]}, and no velocity is steady"]
    lines = []
    if document["runs_away"]:
        lines.append(
            "this velocity is reached from rest; a part that once slides down fast enough does not stop "
            "again: the climb is as steep as kinetic friction or steeper"
        )
    if document["status"] == MotionStatus.AVERAGED:
        lines.append(
            f"not periodic: an average; means over {steady.AVERAGED_PERIODS} periods span "
            f"{_range_text(low, high)} mm/s, single periods {_slowest_to_fastest(document)}"
        )
    elif high - low > answer.COEXISTING_VELOCITY_GAP * abs(high):
        lines.append(
            f"several steady velocities, {_range_text(low, high)} mm/s, depending on how the part arrives"
        )
    return lines


def _slowest_to_fastest(document: Mapping[str, Any]) -> str:
    return _range_text(*(document[f"velocity_{which}_period_mm_s"] for which in ("slowest", "fastest")))


def _range_text(low: float, high: float) -> str:
    return f"{_number(low)} to {_number(high)}"


def _number(value: float) -> str:
    return "none" if np.isnan(value) else f"{value:.4g}"


def cell_remarks(status: Array, several: Bools) -> list[str]:
    """Return how many cells of a map or a curve have no steady velocity, no period, several velocities.

    Parameters
    ----------
    status : array of MotionStatus
        Of each cell.
    several : array of bool, of its shape
        Whether several velocities are possible there.

    Returns
    -------
    list of str
        A sentence for each that occurs.
    """
    counts = {
        "no steady state": (status == MotionStatus.NO_STEADY_STATE).sum(),
        "no period (averaged)": (status == MotionStatus.AVERAGED).sum(),
        "several velocities": several.sum(),
    }
    return [f"{count} of {status.size} cells: {what}" for what, count in counts.items() if count]


def phase_document(study: ConveyPhase) -> Document:
    """Return the best phase of a drive as the JSON document.

    Parameters
    ----------
    study : ConveyPhase

    Returns
    -------
    dict
    """
    phase = study.best
    over = of_arrays(OVER_FRICTION_COLUMNS, phase)
    best_phase = values(BEST_PHASE_COLUMNS, phase) | {"over_friction": over}
    return {"best_phase": best_phase, "bowl": bowls.texts(study.bowl.settings)}


def phase_summary(document: Mapping[str, Any]) -> Frame:
    """Return the document of the best phase as a frame for people.

    Parameters
    ----------
    document : mapping
        Of ``phase_document``.

    Returns
    -------
    Frame
    """
    best = document["best_phase"]
    tenths = _range_text(best["nine_tenths_from_deg"], best["nine_tenths_to_deg"])
    rows = [
        ("best drive.phase [deg]", _number(best["phase_deg"])),
        ("velocity there [mm/s]", _number(best["velocity_mm_s"])),
        ("velocity of a straight drive [mm/s]", _number(best["straight_mm_s"])),
        ("times as fast", _number(best["gain"])),
        ("nine tenths of it at phases [deg]", tenths),
    ]
    for row in best["over_friction"].rows():
        name = f"at {row['friction']:g} times the friction, best / straight [mm/s]"
        rows.append((name, f"{_number(row['velocity_mm_s'])} / {_number(row['straight_mm_s'])}"))
    return quantities(rows)


def offers(study: ConveyStudy) -> list[offer.Offer]:
    """Offer the files of conveying at one operating point.

    Parameters
    ----------
    study : ConveyStudy

    Returns
    -------
    list of Offer
    """
    return [
        offer.document("convey.json", document, study),
        offer.picture(
            "convey.png",
            "Plate and part over one steady cycle",
            lambda: cycle(study.trace(), study.bowl.drive.amplitude, study.answer),
        ),
    ]


def curve_offers(study: ConveyCurve) -> list[offer.Offer]:
    """Offer the files of a curve of velocities.

    Parameters
    ----------
    study : ConveyCurve

    Returns
    -------
    list of Offer
    """
    name, alt = f"convey_{study.kind}", f"Velocity over {study.over}"
    return [offer.table(f"{name}.csv", study.table), offer.picture(f"{name}.png", alt, _curve, study, alt)]


def phase_offers(study: ConveyPhase) -> list[offer.Offer]:
    """Offer the files of the best phase, with its curve.

    Parameters
    ----------
    study : ConveyPhase

    Returns
    -------
    list of Offer
    """
    return [offer.document("convey_phase.json", phase_document, study), *curve_offers(study.curve)]


def map_offers(study: ConveyMap) -> list[offer.Offer]:
    """Offer the files of a map of velocities; over angle and stroke a bowl is drawn by its radius.

    Parameters
    ----------
    study : ConveyMap

    Returns
    -------
    list of Offer
    """
    keys, line = [span.key for span in study.ranges], None
    names = (key.name.rpartition(".")[2].replace("_", " ") for key in keys)
    if study.line is not None and {key.field for key in keys} == {"drive.vibration_angle", "drive.amplitude"}:
        values = [attrgetter(key.field)(study.line) / key.share for key in keys]
        line = [np.atleast_1d(x) / factor(key.unit, key.dimension) for x, key in zip(values, keys)]
    alt = f"Velocity and regimes over {' and '.join(names)}"
    return [
        offer.table("convey_map.csv", study.table),
        offer.picture("convey_map.png", alt, velocity_map, study.grid, line),
    ]


PHASE_COLOURS = {"stick": "#5c6b78", "forward": "#009e73", "backward": "#d55e00", "flight": "#0072b2"}
PLATE = "#aab4bd"
PHASE_LINES = {"stick": "-", "forward": "-", "backward": "--", "flight": ":"}
CONVEY_COLOURS: dict[str, str] = {  # what a designer wants is the strongest
    Regime.STICK: "#eef2f5",
    Regime.FORWARD: "#79bfa4",
    Regime.BACKWARD: "#e3a08a",
    Regime.BOTH: "#f3dfae",
    Regime.HOP: "#c9dcea",
    Regime.NO_STEADY_STATE: "#8c8c8c",
}
THROW_NAMES = {  # near 3 the velocity per stroke has its first peak, without rebound
    1.0: "hop",
    3.0: "first peak",
    round(throw_of_flight(1.0), 4): "one period",
}
SEVERAL_HATCH = "////"


def cycle(trace: steady.CycleTrace, amplitude: float, solution: answer.Answer) -> "style.Figure":
    """Draw plate and part over the trace of an answer.

    Parameters
    ----------
    trace : CycleTrace
    amplitude : float [m]
        Of the plate.
    solution : Answer
        That the trace is of.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure = style.figure(6.4, 5.2)
    top, bottom = figure.subplots(2, 1, sharex=True)
    style.tidy(top, title=cycle_title(trace, solution), y="along the track [mm]")
    style.tidy(bottom, x="time [periods of the drive]", y="along its normal [mm]")
    scale = amplitude * 1e3
    for axes, plate, part in (
        (top, trace.plate_along, trace.part_along),
        (bottom, trace.plate_normal, trace.part_normal),
    ):
        axes.plot(trace.time, plate * scale, color=PLATE, linewidth=2.6, label="plate")
        for place, name in enumerate(PHASES):  # each phase in its colour, drawn once, with gaps
            if (trace.phase == place).any():
                in_phase = np.where(trace.phase == place, part * scale, np.nan)
                look = {"color": PHASE_COLOURS[name], "linestyle": PHASE_LINES[name], "linewidth": 1.6}
                axes.plot(trace.time, in_phase, label=f"part {PHASE_WORDS[name]}", **look)
    top.legend(**style.BESIDE)
    return figure


def cycle_title(trace: steady.CycleTrace, solution: answer.Answer) -> str:
    """Return what of a motion a trace shows, and how fast it is.

    Parameters
    ----------
    trace : CycleTrace
    solution : Answer

    Returns
    -------
    str
    """
    periods, velocity = round(trace.time[-1]), f"{solution.velocity * 1e3:.4g} mm/s"
    if solution.unsteady == answer.UnsteadyMotion.KEEPS_SPEED:
        return f"No steady state: {periods} periods without friction, from rest"
    if solution.unsteady:
        return f"No steady state: {periods} periods of a slide that does not stop"
    if solution.status is MotionStatus.AVERAGED:
        return f"{periods} periods of a motion that does not repeat: {velocity} on average"
    if periods < solution.period:
        return f"{periods} of the {solution.period} periods of a steady cycle: {velocity}"
    return f"One steady cycle: {velocity}" if periods == solution.period else f"Steady motion: {velocity}"


def velocity_map(grid: Grid, curve: Sequence[Floats] | None = None) -> "style.Figure":
    """Draw velocity and regimes over two keys of the bowl; hatched where several velocities coexist.

    Parameters
    ----------
    grid : Grid
        Of a ConveyMap.
    curve : two (N,) arrays, optional
        Operating points of one bowl over its radius, in the units of the axes.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure = style.figure(11.0, 4.6)
    left, right = figure.subplots(1, 2, sharey=True)
    x, y = grid.first.in_unit, grid.second.in_unit
    names = [axis.head.title for axis in (grid.first, grid.second)]
    velocity, several = grid.values["velocity"].T / MM_S, grid.values["several"].T
    finite = velocity[np.isfinite(velocity)]
    has_signs = bool(finite.size) and finite.min() < 0.0 < finite.max()
    title = "Velocity [mm/s], from rest" + ("; line: 0" if has_signs else "")  # a legend hides cells
    style.tidy(left, title=title, x=names[0], y=names[1], grid="none")
    lowest, highest = finite.min(initial=0.0), finite.max(initial=1e-9)
    largest = max(highest, -lowest)
    shades = matplotlib.colormaps["PuOr_r"].with_extremes(bad="#8c8c8c")
    norm = mpl_colors.TwoSlopeNorm(0.0, -largest, largest)
    mesh = left.pcolormesh(x, y, velocity, cmap=shades, norm=norm, shading="nearest", rasterized=True)
    if finite.size:
        bar = figure.colorbar(mesh, ax=left, fraction=0.05, pad=0.02).ax
        bar.tick_params(labelsize=8)
        bar.set_ylim(lowest, highest)
        if has_signs:
            left.contour(x, y, velocity, [0.0], colors=style.INK, linewidths=1.2)
        if several.any():
            with matplotlib.rc_context({"hatch.linewidth": 0.5}):
                left.contourf(x, y, several.astype(float), [0.5, 1.5], colors="none", hatches=[SEVERAL_HATCH])
    else:
        words = "no steady velocity anywhere"
        left.text(0.97, 0.93, words, transform=left.transAxes, ha="right", color="white")
    style.tidy(right, title="Regimes", x=names[0], grid="none")
    codes = {"vmin": -0.5, "vmax": len(grid.names) - 0.5, "shading": "nearest"}
    colours = mpl_colors.ListedColormap([CONVEY_COLOURS[name] for name in grid.names])
    right.pcolormesh(x, y, grid.codes.T, cmap=colours, **codes)
    handles = [
        mpl_patches.Patch(facecolor=CONVEY_COLOURS[name], label=regime_words(name))
        for code, name in enumerate(grid.names)
        if (grid.codes == code).any()
    ]
    if several.any():
        look = {"fill": False, "linewidth": 0, "hatch": SEVERAL_HATCH}
        handles.append(mpl_patches.Patch(label="several velocities (left)", **look))
    right.legend(handles=handles, **style.BESIDE)
    # lines of equal throw number: the hop, the first peak of the velocity, a flight of one period
    throw = grid.values["throw_number"].T
    levels = [level for level in sorted(THROW_NAMES) if throw.min() < level < throw.max()]

    def throw_label(level: float) -> str:
        return f"k = {level:.2g} ({THROW_NAMES[min(THROW_NAMES, key=lambda k: abs(k - level))]})"

    for axes in (left, right):
        if levels:
            look = {"colors": style.INK, "linewidths": 0.8, "linestyles": "--"}
            for text in axes.clabel(axes.contour(x, y, throw, levels, **look), fmt=throw_label, fontsize=7):
                text.set_path_effects(style.halo())
        if curve is not None:
            axes.plot(*curve, color=style.ACCENT, linewidth=2.0)
            axes.plot(curve[0][-1], curve[1][-1], "o", color=style.ACCENT, markersize=5)
            axes.set(xlim=(x[0], x[-1]), ylim=(y[0], y[-1]))
    return figure


def _curve(study: ConveyCurve, title: str, ax: "style.Axes | None" = None) -> "style.Figure":
    frame = study.table()
    column = next(iter(frame))
    figure, axes = style.chart(ax=ax, title=title, x=frame.heads[column].title, y="velocity [mm/s]")
    x = frame[column]
    low, high = frame["velocity_low_mm_s"], frame["velocity_high_mm_s"]
    if (high > low).any():
        axes.fill_between(x, low, high, color=PLATE, alpha=0.6, linewidth=0, label="all starts")
    axes.plot(x, frame["velocity_mm_s"], color=style.ACCENT, label="from rest")
    axes.legend(**style.LEGEND)
    return figure


CONVEY_VIEW = RecordView(lambda study: convey_text(study.answer), offers, "convey")
CURVE_VIEW = RecordView(None, curve_offers, "convey")
PHASE_VIEW = RecordView(None, phase_offers, "convey")
MAP_VIEW = RecordView(None, map_offers, "convey")
