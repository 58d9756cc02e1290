"""Files of ``feeder convey``: at one point, along a curve, over the phase, over a map."""

from typing import Any

import numpy as np

from feederscrew import bowl as bowls
from feederscrew.conveying import answer, sensitivity, steady
from feederscrew.conveying.answer import throw_of_flight
from feederscrew.conveying.operating_point import PHASES
from feederscrew.heavy import heavy
from feederscrew.output import offers as offer
from feederscrew.output import style, tables
from feederscrew.output.tables import PHASE_WORDS, heading, regime_words
from feederscrew.studies.convey import ConveyStudy
from feederscrew.units import MM_S, factor

matplotlib = heavy("matplotlib")
mpl_colors = heavy("matplotlib.colors")
mpl_patches = heavy("matplotlib.patches")

VELOCITIES = {"velocity": "velocity_mm_s", "low": "velocity_low_mm_s", "high": "velocity_high_mm_s"}
NO_STEADY_STATE = (
    "no steady state: the part slides down the track without stopping, and no velocity is steady"
)
RUNS_AWAY = (
    "this velocity is reached from rest; a part that once slides down fast enough does not stop again: "
    "the climb is steeper than kinetic friction"
)
SLIP_DIRECTIONS = {"forward": "slip up the track", "backward": "slip down the track"}


def document(study) -> dict[Any, Any]:
    """Return a ConveyStudy as the JSON document."""
    conveying, change = study.answer, sensitivity.SENSITIVITY_CHANGE
    return {
        "status": conveying.status,
        "period": conveying.period,
        **{column: getattr(conveying, name) / MM_S for name, column in VELOCITIES.items()},
        "velocity_slowest_period_mm_s": conveying.slowest / MM_S,
        "velocity_fastest_period_mm_s": conveying.fastest / MM_S,
        "regime": conveying.regime,
        "runs_away": conveying.runs_away,
        "acceleration_ratio": conveying.setting.ratio,
        "throw_number": conveying.throw_number,
        "mu_effective": conveying.setting.static,
        "mu_effective_kinetic": conveying.setting.kinetic,
        "mu_forward": conveying.mu_forward,
        "mu_backward": conveying.mu_backward,
        "margins": conveying.margins,
        "fractions": conveying.fractions,
        "longest_flight_periods": conveying.longest_flight,
        "hardest_impact_mm_s": conveying.hardest_impact / MM_S,
        "flights_per_period": conveying.flights,
        "sensitivity": {name: _changed(conveying, pair, change) for name, pair in study.nearby.items()},
        "friction_doubt": _changed(conveying, study.doubt, sensitivity.FRICTION_DOUBT),
        "restitution_doubt": rebound(study.bowl, study.rebound),
        "validity": study.validity,
        "bowl": bowls.texts(study.bowl.settings),
    }


def summary(document):
    """Return the document of one operating point as a frame for people."""
    rows = [
        ("velocity [mm/s]", number(document["velocity_mm_s"])),
        ("lowest to highest [mm/s]", between(document["velocity_low_mm_s"], document["velocity_high_mm_s"])),
        *_single_periods(document),
        ("status", document["status"] + _of_periods(document["period"])),
        ("regime", regime_words(document["regime"])),
        ("acceleration ratio A w2/g", number(document["acceleration_ratio"])),
        ("throw number", _margin(document["throw_number"], document["margins"]["hop"])),
    ]
    for direction, meaning in SLIP_DIRECTIONS.items():
        limit, margin = document[f"mu_{direction}"], document["margins"][direction]
        rows.append((f"friction that stops {meaning}", _margin(limit, margin)))
    times = document["fractions"].items()
    rows += [(f"time it {PHASE_WORDS[name]} [%]", number(100.0 * share)) for name, share in times]
    rows += [
        ("longest flight [periods]", number(document["longest_flight_periods"])),
        ("hardest impact [mm/s]", number(document["hardest_impact_mm_s"])),
        *(_change(name, pair) for name, pair in document["sensitivity"].items()),
        _change("friction", document["friction_doubt"]),
        *_bounced(document["restitution_doubt"]),
        ("validity", document["validity"]),
    ]
    return tables.frame(dict(zip(("quantity", "value"), zip(*rows))))


def remarks(document) -> list[str]:
    """Return what a reader of the document of one operating point must not overlook, a sentence each."""
    lines = []
    low, high = document["velocity_low_mm_s"], document["velocity_high_mm_s"]
    if document["status"] == "no steady state":
        return [NO_STEADY_STATE]
    if document["runs_away"]:
        lines.append(RUNS_AWAY)
    if document["status"] == "averaged":
        lines.append(
            f"not periodic: an average; means over {steady.AVERAGED_PERIODS} periods span "
            f"{between(low, high)} mm/s, single periods {_slowest_to_fastest(document)}"
        )
    elif high - low > answer.COEXISTING_VELOCITY_GAP * abs(high):
        lines.append(
            f"several steady velocities, {between(low, high)} mm/s, depending on how the part arrives"
        )
    return lines


def cells(study):
    """Return the cells of a ConveyMap as a frame."""
    columns = _in_mm_s(study.grid.columns())
    for name in ("status", "several"):
        columns.pop(name)
    regime, throw_number = columns.pop("regime"), columns.pop("throw_number")
    last = {"regime": regime, "throw_number": throw_number, "status": study.statuses.ravel()}
    return tables.frame(columns | last)


def points(study):
    """Return the points of a ConveyCurve as a frame."""
    columns = _in_mm_s(study.cells)
    return tables.frame(
        {
            **{axis.column: axis.in_unit for axis in study.axes},
            **{column: columns[column] for column in VELOCITIES.values()},
            "regime": np.asarray(answer.SWEEP_REGIMES)[columns["regime"]],
            "throw_number": columns["throw_number"],
            "status": study.statuses,
        }
    )


def map_remarks(study) -> list[Any]:
    """Return how many cells of a ConveyMap have no steady velocity, no period or several velocities."""
    return _remarks(study.statuses, study.grid.values["several"])


def curve_remarks(study) -> list[Any]:
    """Return the same of a ConveyCurve."""
    return _remarks(study.statuses, study.several)


def _remarks(status, several) -> list[Any]:
    counts = {
        "no steady state": (status == "no steady state").sum(),
        "no period (averaged)": (status == "averaged").sum(),
        "several velocities": several.sum(),
    }
    return [f"{count} of {status.size} cells: {what}" for what, count in counts.items() if count]


def _in_mm_s(columns) -> dict[Any, Any]:
    return {VELOCITIES.get(name, name): a / MM_S if name in VELOCITIES else a for name, a in columns.items()}


def _changed(point, pair, change) -> dict[Any, Any]:
    return {
        "change_percent": 100.0 * change,
        "velocity_less_mm_s": pair.less / MM_S,
        "velocity_more_mm_s": pair.more / MM_S,
        "percent_per_percent": pair.elasticity(point.velocity, change),
    }


def rebound(bowl, neighbours) -> dict[Any, Any] | None:
    """Return a document's entry on the spread of restitution; None where nothing is thrown up.

    ``neighbours`` are those of ``sensitivity.restitution_doubt``.
    """
    if neighbours is None:
        return None
    low, high = sensitivity.rebounds(bowl)
    return {
        "restitution_low": low,
        "restitution_high": high,
        "velocity_less_mm_s": neighbours.less / MM_S,
        "velocity_more_mm_s": neighbours.more / MM_S,
    }


def _bounced(spread) -> list[Any]:
    """A row of what the spread of restitution does, where the document has one."""
    if spread is None:
        return []
    ends = (number(spread[f"restitution_{end}"]) for end in ("low", "high"))
    speeds = (number(spread[f"velocity_{end}_mm_s"]) for end in ("less", "more"))
    return [(f"velocity for restitution {' / '.join(ends)} [mm/s]", " / ".join(speeds))]


def _change(name, pair) -> tuple[Any, ...]:
    less, more = number(pair["velocity_less_mm_s"]), number(pair["velocity_more_mm_s"])
    return f"velocity for {name} -/+ {pair['change_percent']:g} % [mm/s]", f"{less} / {more}"


def _margin(limit, margin) -> str:
    return "never holds" if np.isnan(limit) else f"{number(limit)} (margin {number(margin)})"


def _single_periods(document) -> list[Any]:
    """A row with the range over single periods, where they are not all alike."""
    if document["period"] == 1 or document["status"] == "no steady state":
        return []
    return [("slowest to fastest period [mm/s]", _slowest_to_fastest(document))]


def _slowest_to_fastest(document) -> str:
    return between(*(document[f"velocity_{which}_period_mm_s"] for which in ("slowest", "fastest")))


def _of_periods(period) -> str:
    return f", every {period} periods" if period > 1 else ""


def between(low, high) -> str:
    """Return two numbers as a range for people."""
    return f"{number(low)} to {number(high)}"


def number(value) -> str:
    """Return a number for people; NaN is none."""
    return "none" if np.isnan(value) else f"{value:.4g}"


def phase_document(study) -> dict[str, Any]:
    """Return a ConveyPhase as the JSON document."""
    phase = study.best
    over = zip(phase.frictions, phase.best_over_friction, phase.straight_over_friction)
    best_phase = {
        "phase_deg": float(np.degrees(phase.phase)),
        "velocity_mm_s": phase.velocity / MM_S,
        "straight_mm_s": phase.straight / MM_S,
        "gain": phase.velocity / phase.straight if phase.straight > 0.0 else np.nan,
        "nine_tenths_from_deg": float(np.degrees(phase.lowest)),
        "nine_tenths_to_deg": float(np.degrees(phase.highest)),
        "over_friction": [
            {"friction": share, "velocity_mm_s": best / MM_S, "straight_mm_s": straight / MM_S}
            for share, best, straight in over
        ],
    }
    return {"best_phase": best_phase, "bowl": bowls.texts(study.bowl.settings)}


def phase_summary(document):
    """Return the document of the best phase as a frame for people."""
    best = document["best_phase"]
    low, high = best["nine_tenths_from_deg"], best["nine_tenths_to_deg"]
    rows = [
        ("best drive.phase [deg]", number(best["phase_deg"])),
        ("velocity there [mm/s]", number(best["velocity_mm_s"])),
        ("velocity of a straight drive [mm/s]", number(best["straight_mm_s"])),
        ("times as fast", number(best["gain"])),
        ("nine tenths of it at phases [deg]", between(low, high)),
        *(
            (
                f"at {row['friction']:g} times the friction, best / straight [mm/s]",
                f"{number(row['velocity_mm_s'])} / {number(row['straight_mm_s'])}",
            )
            for row in best["over_friction"]
        ),
    ]
    return tables.frame(dict(zip(("quantity", "value"), zip(*rows))))


def offers(study: ConveyStudy) -> list[offer.Offer]:
    """Offer the files of a ConveyStudy."""
    return [
        offer.document("convey.json", document, study),
        offer.picture("convey.png", "Plate and part over one steady cycle", _cycle, study),
    ]


def curve_offers(study) -> list[Any]:
    """Offer the files of a ConveyCurve, as a list of Offer."""
    name, alt = f"convey_{study.kind}", f"Velocity over {study.over}"
    return [
        offer.table(f"{name}.csv", points, study),
        offer.picture(f"{name}.png", alt, _curve, study, alt),
    ]


def phase_offers(study) -> list[Any]:
    """Offer the files of a ConveyPhase, as a list of Offer."""
    return [
        offer.document("convey_phase.json", phase_document, study),
        *curve_offers(study.curve),
    ]


def map_offers(study) -> list[Any]:
    """Offer the files of a ConveyMap, as a list of Offer."""
    names = " and ".join(
        key_range.key.name.rpartition(".")[2].replace("_", " ") for key_range in study.ranges
    )
    return [
        offer.table("convey_map.csv", cells, study),
        offer.picture("convey_map.png", f"Velocity and regimes over {names}", _map, study),
    ]


def _cycle(study):
    return cycle(study.trace(), study.bowl.drive.amplitude, study.answer)


def _curve(study, title):
    return curve(points(study), title)


def _map(study):
    line = None if study.line is None else on_axes(study.ranges, study.line)
    return velocity_map(study.grid, line)


PHASE_COLOURS = {"stick": "#5c6b78", "forward": "#009e73", "backward": "#d55e00", "flight": "#0072b2"}
PLATE = "#aab4bd"
PHASE_LINES = {"stick": "-", "forward": "-", "backward": "--", "flight": ":"}
CONVEY_COLOURS = {  # what a designer wants is the strongest
    "stick": "#eef2f5", "forward": "#79bfa4", "backward": "#e3a08a", "both": "#f3dfae", "hop": "#c9dcea",
    "no steady state": "#8c8c8c",
}  # fmt: skip
FIRST_PEAK = 3.0  # [1] near here the velocity per stroke has its first peak, without rebound
THROW_NAMES = {1.0: "hop", FIRST_PEAK: "first peak", round(throw_of_flight(1.0), 4): "one period"}
SEVERAL_HATCH = "////"
MIN_SCALE_MM_S = 1e-9  # [mm/s] a scale of velocities is at least this wide
NO_VELOCITY = "no steady velocity anywhere"
WAY = "[mm]"


def cycle(trace, amplitude, solved):
    """Draw plate and part over one steady cycle, along the track and along its normal.

    ``amplitude`` [m] is the plate's, ``solved`` the Answer to the setting of the CycleTrace ``trace``.
    """
    figure = style.figure(6.4, 5.2)
    top, bottom = figure.subplots(2, 1, sharex=True)
    style.tidy(top, title=cycle_title(trace, solved), y=f"along the track {WAY}")
    style.tidy(bottom, x="time [periods of the drive]", y=f"along its normal {WAY}")
    scale = amplitude * 1e3
    for axes, plate, part in (
        (top, trace.plate_along, trace.part_along),
        (bottom, trace.plate_normal, trace.part_normal),
    ):
        axes.plot(trace.time, plate * scale, color=PLATE, linewidth=2.6, label="plate")
        _by_phase(axes, trace, part * scale)
    top.legend(fontsize=8, frameon=False, loc="upper left", bbox_to_anchor=(1.0, 1.0), labelcolor=style.INK)
    return figure


def cycle_title(trace, solved) -> str:
    """Return what of a motion a trace shows, and how fast it is."""
    periods, velocity = round(trace.time[-1]), f"{solved.velocity * 1e3:.4g} mm/s"
    if solved.status == "no steady state":
        return f"No steady state: {periods} periods of a slide that does not stop"
    if solved.status == "averaged":
        return f"{periods} periods of a motion that does not repeat: {velocity} on average"
    if periods < solved.period:
        return f"{periods} of the {solved.period} periods of a steady cycle: {velocity}"
    return f"One steady cycle: {velocity}" if periods == solved.period else f"Steady motion: {velocity}"


def velocity_map(grid, curve=None):
    """Draw velocity and regimes over two keys of the bowl; hatched where several velocities coexist.

    ``grid`` is that of a ConveyMap; ``curve``, two (N,) arrays in the units of the axes, has the operating
    points of one bowl over its radius.
    """
    figure = style.figure(11.0, 4.6)
    left, right = figure.subplots(1, 2, sharey=True)
    _velocity(figure, left, grid)
    _regimes(right, grid)
    for axes in (left, right):
        _throws(axes, grid)
        if curve is not None:
            axes.plot(*curve, color=style.ACCENT, linewidth=2.0)
            axes.plot(curve[0][-1], curve[1][-1], "o", color=style.ACCENT, markersize=5)
            axes.set(xlim=_ends(grid.first), ylim=_ends(grid.second))
    return figure


def curve(frame, title: str):
    """Draw the velocity of ``points`` over the first column, with its range where several coexist."""
    figure = style.figure()
    column = next(iter(frame))
    label = " ".join(heading(column))
    axes = style.tidy(figure.add_subplot(), title=title, x=label, y="velocity [mm/s]")
    low, high = frame["velocity_low_mm_s"], frame["velocity_high_mm_s"]
    if (high > low).any():
        axes.fill_between(frame[column], low, high, color=PLATE, alpha=0.6, linewidth=0, label="all starts")
    axes.plot(frame[column], frame["velocity_mm_s"], color=style.ACCENT, label="from rest")
    axes.legend(fontsize=8, frameon=False, labelcolor=style.INK)
    return figure


def on_axes(spans, bowl) -> tuple[Any, ...] | None:
    """Return operating points of a bowl, two (N,) arrays in the units of a map's axes, of two KeyRange.

    The bowl has one operating point, or arrays of them as of ``radius.at_radius``. None where the axes
    are not vibration angle and stroke.
    """
    values = {"drive.vibration_angle": bowl.drive.vibration_angle, "drive.amplitude": bowl.drive.amplitude}
    if {span.key.field for span in spans} != set(values):
        return None
    return tuple(np.atleast_1d(values[span.key.field]) / span.key.share / _unit(span.key) for span in spans)


def _unit(key):
    return factor(key.unit, key.dimension)


def _by_phase(axes, trace, positions) -> None:
    """The part's line, each phase in its colour; drawn once a phase, with gaps."""
    for place, name in enumerate(PHASES):
        inside = trace.phase == place
        if inside.any():
            in_phase = np.where(inside, positions, np.nan)
            look = {"color": PHASE_COLOURS[name], "linestyle": PHASE_LINES[name], "linewidth": 1.6}
            axes.plot(trace.time, in_phase, label=f"part {PHASE_WORDS[name]}", **look)


def _velocity(figure, axes, grid) -> None:
    style.tidy(axes, title="Velocity [mm/s], from rest", grid="none")
    axes.set(xlabel=_label(grid.first), ylabel=_label(grid.second))
    velocity = grid.values["velocity"].T / MM_S
    finite = velocity[np.isfinite(velocity)]
    lowest, highest = finite.min(initial=0.0), finite.max(initial=MIN_SCALE_MM_S)
    largest = max(highest, -lowest)
    shades = matplotlib.colormaps["PuOr_r"].with_extremes(bad="#8c8c8c")
    norm = mpl_colors.TwoSlopeNorm(0.0, -largest, largest)
    x, y = grid.first.in_unit, grid.second.in_unit
    mesh = axes.pcolormesh(x, y, velocity, cmap=shades, norm=norm, shading="nearest", rasterized=True)
    if not finite.size:
        axes.text(0.97, 0.93, NO_VELOCITY, transform=axes.transAxes, ha="right", color="white")
        return
    bar = figure.colorbar(mesh, ax=axes, fraction=0.05, pad=0.02).ax
    bar.tick_params(labelsize=8)
    bar.set_ylim(lowest, highest)
    if finite.min() < 0.0 < finite.max():
        axes.contour(x, y, velocity, [0.0], colors=style.INK, linewidths=1.2)
        style.tidy(axes, title="Velocity [mm/s], from rest; line: 0", grid="none")  # a legend hides cells
        axes.set(xlabel=_label(grid.first), ylabel=_label(grid.second))
    several = grid.values["several"].T.astype(float)
    if several.any():
        with matplotlib.rc_context({"hatch.linewidth": 0.5}):
            axes.contourf(x, y, several, [0.5, 1.5], colors="none", hatches=[SEVERAL_HATCH])


def _regimes(axes, grid) -> None:
    style.tidy(axes, title="Regimes", x=_label(grid.first), grid="none")
    colours = mpl_colors.ListedColormap([CONVEY_COLOURS[name] for name in grid.names])
    axes.pcolormesh(
        *(grid.first.in_unit, grid.second.in_unit, grid.codes.T),
        **{"cmap": colours, "vmin": -0.5, "vmax": len(grid.names) - 0.5, "shading": "nearest"},
    )
    present = [name for code, name in enumerate(grid.names) if (grid.codes == code).any()]
    handles = [
        mpl_patches.Patch(facecolor=CONVEY_COLOURS[name], label=regime_words(name)) for name in present
    ]
    if grid.values["several"].any():
        handles.append(
            mpl_patches.Patch(fill=False, linewidth=0, hatch=SEVERAL_HATCH, label="several velocities (left)")
        )
    axes.legend(
        handles=handles,
        fontsize=8,
        frameon=False,
        loc="upper left",
        bbox_to_anchor=(1.0, 1.0),
        labelcolor=style.INK,
    )


def _throws(axes, grid) -> None:
    """Lines of equal throw number: the hop, the first peak of the velocity, a flight of one period."""
    throw = grid.values["throw_number"].T
    levels = [level for level in sorted(THROW_NAMES) if throw.min() < level < throw.max()]
    if levels:
        x, y = grid.first.in_unit, grid.second.in_unit
        lines = axes.contour(x, y, throw, levels, colors=style.INK, linewidths=0.8, linestyles="--")
        texts = axes.clabel(lines, fmt=lambda level: f"k = {level:.2g} ({_throw_name(level)})", fontsize=7)
        for text in texts:
            text.set_path_effects(style.halo())


def _throw_name(level):
    return THROW_NAMES[min(THROW_NAMES, key=lambda known: abs(known - level))]


def _label(axis) -> str:
    return " ".join(heading(axis.column))


def _ends(axis) -> tuple[Any, ...]:
    return axis.in_unit[0], axis.in_unit[-1]
