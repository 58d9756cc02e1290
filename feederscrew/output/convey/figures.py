"""Pictures of conveying: one steady cycle, maps over two keys of the bowl, the curve over the radius."""

import matplotlib
import numpy as np
from matplotlib.colors import ListedColormap, TwoSlopeNorm
from matplotlib.patches import Patch

from feederscrew.conveying.flights import throw_of_flight
from feederscrew.conveying.setting import PHASES
from feederscrew.output import style
from feederscrew.output.motion_words import PHASE_WORDS
from feederscrew.output.tables import heading
from feederscrew.units import MM_S, factor

PHASE_COLOURS = {"stick": "#5c6b78", "forward": "#009e73", "backward": "#d55e00", "flight": "#0072b2"}
PLATE = "#aab4bd"
PHASE_LINES = {"stick": "-", "forward": "-", "backward": "--", "flight": ":"}
REGIMES = {  # colour and label; what a designer wants is the strongest
    "stick": ("#eef2f5", "sticks"),
    "forward": ("#79bfa4", "slips forward only"),
    "backward": ("#e3a08a", "slips back only"),
    "both": ("#f3dfae", "slips both ways"),
    "hop": ("#c9dcea", "hops"),
    "no steady state": ("#8c8c8c", "no steady state"),
}
FIRST_PEAK = 3.0  # [1] near here the velocity per stroke has its first peak, without rebound
THROWS = {1.0: "hop", FIRST_PEAK: "first peak", round(throw_of_flight(1.0), 4): "one period"}
HATCH = "////"
LEAST = 1e-9  # [mm/s] a scale of velocities is at least this wide
NOWHERE = "no steady velocity anywhere"
WAY = "[mm]"


def cycle(trace, amplitude, found):
    """Draw plate and part over one steady cycle, along the track and along its normal.

    Parameters
    ----------
    trace : CycleTrace
    amplitude : float [m]
    found : Answer
        To the same setting.

    Returns
    -------
    Figure
    """
    figure = style.figure(6.4, 5.2)
    top, bottom = figure.subplots(2, 1, sharex=True)
    style.tidy(top, title=cycle_title(trace, found), y=f"along the track {WAY}")
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


def cycle_title(trace, found):
    """Return what of a motion a trace shows, and how fast it is."""
    shown, velocity = round(trace.time[-1]), f"{found.velocity * 1e3:.4g} mm/s"
    if found.status == "no steady state":
        return f"No steady state: {shown} periods of a slide that does not stop"
    if found.status == "averaged":
        return f"{shown} periods of a motion that does not repeat: {velocity} on average"
    if shown < found.period:
        return f"{shown} of the {found.period} periods of a steady cycle: {velocity}"
    return f"One steady cycle: {velocity}" if shown == found.period else f"Steady motion: {velocity}"


def velocity_map(grid, curve=None):
    """Draw velocity and regimes over two keys of the bowl.

    Parameters
    ----------
    grid : Grid
        Of a ConveyMap.
    curve : two (N,) float, optional
        The operating points of one bowl over its radius, in the units of the axes.

    Returns
    -------
    Figure
        Hatched where several velocities coexist.
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


def curve(frame, title):
    """Draw velocity over the first column, with its range where several coexist.

    Parameters
    ----------
    frame : Frame
        Of ``tables.points``.
    title : str

    Returns
    -------
    Figure
    """
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


def on_axes(spans, bowl):
    """Return operating points of a bowl in the units of a map's axes.

    Parameters
    ----------
    spans : two KeyRange
    bowl : Bowl
        One operating point, or arrays of them as of ``radius.at_radius``.

    Returns
    -------
    two (N,) float, or None
        None where the axes are not vibration angle and stroke.
    """
    values = {"drive.vibration_angle": bowl.drive.vibration_angle, "drive.amplitude": bowl.drive.amplitude}
    if {span.key.field for span in spans} != set(values):
        return None
    return tuple(np.atleast_1d(values[span.key.field]) / span.key.share / _unit(span.key) for span in spans)


def _unit(key):
    return factor(key.unit, key.dimension)


def _by_phase(axes, trace, way):
    """The part's line, each phase in its colour; drawn once a phase, with gaps."""
    for place, name in enumerate(PHASES):
        inside = trace.phase == place
        if inside.any():
            shown = np.where(inside, way, np.nan)
            look = {"color": PHASE_COLOURS[name], "linestyle": PHASE_LINES[name], "linewidth": 1.6}
            axes.plot(trace.time, shown, label=f"part {PHASE_WORDS[name]}", **look)


def _velocity(figure, axes, grid):
    style.tidy(axes, title="Velocity [mm/s], from rest", grid="none")
    axes.set(xlabel=_label(grid.first), ylabel=_label(grid.second))
    velocity = grid.values["velocity"].T / MM_S
    known = velocity[np.isfinite(velocity)]
    lowest, highest = known.min(initial=0.0), known.max(initial=LEAST)
    largest = max(highest, -lowest)
    shades = matplotlib.colormaps["PuOr_r"].with_extremes(bad="#8c8c8c")
    norm = TwoSlopeNorm(0.0, -largest, largest)
    x, y = grid.first.shown, grid.second.shown
    mesh = axes.pcolormesh(x, y, velocity, cmap=shades, norm=norm, shading="nearest", rasterized=True)
    if not known.size:
        axes.text(0.97, 0.93, NOWHERE, transform=axes.transAxes, ha="right", color="white")
        return
    bar = figure.colorbar(mesh, ax=axes, fraction=0.05, pad=0.02).ax
    bar.tick_params(labelsize=8)
    bar.set_ylim(lowest, highest)
    if known.min() < 0.0 < known.max():
        axes.contour(x, y, velocity, [0.0], colors=style.INK, linewidths=1.2)
        style.tidy(axes, title="Velocity [mm/s], from rest; line: 0", grid="none")  # a legend hides cells
        axes.set(xlabel=_label(grid.first), ylabel=_label(grid.second))
    several = grid.values["several"].T.astype(float)
    if several.any():
        with matplotlib.rc_context({"hatch.linewidth": 0.5}):
            axes.contourf(x, y, several, [0.5, 1.5], colors="none", hatches=[HATCH])


def _regimes(axes, grid):
    style.tidy(axes, title="Regimes", x=_label(grid.first), grid="none")
    colours = ListedColormap([REGIMES[name][0] for name in grid.names])
    axes.pcolormesh(
        *(grid.first.shown, grid.second.shown, grid.codes.T),
        **{"cmap": colours, "vmin": -0.5, "vmax": len(grid.names) - 0.5, "shading": "nearest"},
    )
    present = [name for code, name in enumerate(grid.names) if (grid.codes == code).any()]
    handles = [Patch(facecolor=REGIMES[name][0], label=REGIMES[name][1]) for name in present]
    if grid.values["several"].any():
        handles.append(Patch(fill=False, linewidth=0, hatch=HATCH, label="several velocities (left)"))
    axes.legend(
        handles=handles,
        fontsize=8,
        frameon=False,
        loc="upper left",
        bbox_to_anchor=(1.0, 1.0),
        labelcolor=style.INK,
    )


def _throws(axes, grid):
    """Lines of equal throw number: the hop, the first peak of the velocity, a flight of one period."""
    throw = grid.values["throw_number"].T
    levels = [level for level in sorted(THROWS) if throw.min() < level < throw.max()]
    if levels:
        x, y = grid.first.shown, grid.second.shown
        lines = axes.contour(x, y, throw, levels, colors=style.INK, linewidths=0.8, linestyles="--")
        texts = axes.clabel(lines, fmt=lambda level: f"k = {level:.2g} ({_throw_name(level)})", fontsize=7)
        for text in texts:
            text.set_path_effects(style.HALO)


def _throw_name(level):
    return THROWS[min(THROWS, key=lambda known: abs(known - level))]


def _label(axis):
    return " ".join(heading(axis.column))


def _ends(axis):
    return axis.shown[0], axis.shown[-1]
