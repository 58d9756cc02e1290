"""The thesis's figures drawn again."""

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

import matplotlib
import numpy as np

from feederscrew.mechanics.limits import published_ratio
from feederscrew.output import compare, slide, tables
from feederscrew.output import style as plots
from feederscrew.output.tables import Frame
from feederscrew.thesis import figures
from feederscrew.thesis.figures import Bars, ByRatio, Curves, Figure, FigureGrid

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure as Drawing
    from numpy.typing import NDArray

ASPECT_LINES = (  # of the T shape, A to E: colour and dashes
    ("#0072b2", "-"),
    ("#e69f00", "-"),
    ("#009e73", "-"),
    ("#cc79a7", "--"),
    ("#545f6b", "-"),
)
PRINT_MARKERS = (("o", False), ("D", True))  # of what is in print, and whether it is filled
LABEL_BOX = {"facecolor": "white", "edgecolor": "none", "boxstyle": "round,pad=0.25"}
BETA_AXIS, FRICTION_AXIS = "vibration angle β [deg]", "friction μ [1]"
FREQUENCY_AXIS, AMPLITUDE_AXIS = "frequency f [Hz]", "amplitude A [mm]"
ACCELERATION_AXIS = "acceleration V'z [m/s²]"


def draw(figure: Figure) -> "Drawing":
    """Return a figure of the thesis as a matplotlib Figure."""
    data, title = figure.data(), f"Figure {figure.number}. {figure.caption}"
    if isinstance(data, Bars):
        return _bars(title, data)
    if isinstance(data, ByRatio):
        return _by_ratio(title, data)
    if isinstance(data, Curves):
        return _curves(title, data)
    if figure.number == "5-5":
        return _contours(title, data, np.radians(figures.BETA_OF["5-5"]))
    if figure.number in figures.BETA_OF:
        return _limit_surface(title, data)
    if figure.number == "5-6":
        return _acceleration(title, data, BETA_AXIS, FRICTION_AXIS, np.degrees(data.x), data.y)
    return _acceleration(title, data, FREQUENCY_AXIS, AMPLITUDE_AXIS, data.x, 1e3 * data.y)


def numbers(figure: Figure) -> Frame:
    """Return the numbers a figure draws, as a table."""
    data = figure.data()
    if isinstance(data, Bars):
        printed = {f"{name}_printed": values for name, values in data.printed.items()}
        return tables.frame({"aspect": data.aspects, **data.profiles, **printed})
    if isinstance(data, ByRatio):
        return tables.frame({"aspect_ratio": data.ratios, **data.lines})
    if isinstance(data, Curves):
        limits = {f"mu_limit_beta_{beta:g}": values for beta, values in data.limits.items()}
        return tables.frame({"acceleration_ratio": data.ratios, **limits})
    return _cells(figure.number, data)


def _cells(number: str, data: FigureGrid) -> Frame:
    """A surface's cells, row by row."""
    names = {
        "5-6": ("beta_deg", "friction", "acceleration_z_m_s2", np.degrees(data.x), data.y),
        "5-7": ("frequency_Hz", "amplitude_mm", "acceleration_z_m_s2", data.x, 1e3 * data.y),
    }
    limit = ("alpha_minus_theta_deg", "acceleration_ratio", "mu_limit", np.degrees(data.x), data.y)
    first, second, value, x, y = names.get(number, limit)
    across, up = np.meshgrid(x, y)
    columns = {first: across, second: up, value: data.values, "hops": data.hops}
    return tables.frame({name: np.ravel(array) for name, array in columns.items()})


def _bars(title: str, data: Bars) -> "Drawing":
    room = 0.42 if len(data.profiles) < 4 else 0.30
    width = float(np.clip(len(data.aspects) * (len(data.profiles) + 0.9) * room + 1.0, 4.6, 9.5))
    figure = plots.figure(width, 3.6)
    axes = plots.tidy(figure.add_subplot(), title=title, x="aspect", y="probability [%]", grid="y")
    room = (width - 0.9) / (len(data.aspects) * (len(data.profiles) + 0.9))
    compare.bars(axes, data.aspects, data.profiles, data.printed, room)
    handles = list(axes.containers)
    if data.printed:
        handles += axes.plot([], [], color=plots.INK, linewidth=1.1, label="in print")
    _legend_below(figure, handles)
    return figure


def _by_ratio(title: str, data: ByRatio) -> "Drawing":
    figure = plots.figure(6.6, 4.4)
    x, y = "aspect ratio, thickness / width [1]", f"probability by {data.rule} [%]"
    axes = plots.tidy(figure.add_subplot(), title=title, x=x, y=y)
    handles = []
    for (name, values), (colour, dashes) in zip(data.lines.items(), ASPECT_LINES):
        handles += axes.plot(
            data.ratios, 100.0 * values, dashes, color=colour, linewidth=1.8, label=f"aspect {name}"
        )
    for (label, (ratios, rows)), (marker, filled) in zip(data.points.items(), PRINT_MARKERS):
        handles += _points(axes, label, ratios, rows, marker, filled)
    axes.set_ylim(bottom=0.0)
    _legend_below(figure, handles)
    return figure


def _points(
    axes: "Axes", label: str, ratios: "NDArray", values: dict[str, "NDArray"], marker: str, filled: bool
) -> list:
    """What is in print, a marker each in its aspect's colour; the handle for the legend."""
    look: dict[str, Any] = {"markersize": 5.5, "linestyle": "none", "marker": marker}
    for column, (colour, _) in zip(values.values(), ASPECT_LINES):
        face = colour if filled else "white"
        axes.plot(ratios, 100.0 * column, color=colour, markerfacecolor=face, clip_on=False, **look)
    face = plots.INK if filled else "white"
    return axes.plot([], [], color=plots.INK, markerfacecolor=face, label=label, **look)


def _legend_below(figure: "Drawing", handles: "Sequence[Artist]") -> None:
    ncols = min(len(handles), 4 if figure.get_figwidth() < 9.0 else 8)
    figure.legend(handles=handles, loc="outside lower center", ncols=ncols, frameon=False, fontsize=8)


def _curves(title: str, data: Curves) -> "Drawing":
    """As published, and over G: there the curves part, and cross."""
    figure = plots.figure(9.4, 4.2)
    left, right = figure.subplots(1, 2)
    plots.tidy(left, title=title, x=slide.RATIO, y=slide.FRICTION)
    plots.tidy(right, title="The same, divided by G", x=slide.RATIO, y="limiting friction / G [1]")
    shades = matplotlib.colormaps[slide.LEVEL_COLOURS](np.linspace(0.05, 0.8, len(data.limits)))
    for (beta, values), shade in zip(data.limits.items(), shades):
        left.plot(data.ratios, values, color=shade, linewidth=1.8, label=f"β = {beta:g}°")
        right.plot(data.ratios[1:], values[1:] / data.ratios[1:], color=shade, linewidth=1.8)
        right.plot(*_turning(beta), "o", color=shade, markersize=5)
    right.plot([], [], "o", color=plots.INK, markersize=5, label="G = sin β: beyond, μ grows with β")
    for axes in (left, right):
        axes.set(xlim=(0.0, data.ratios[-1]))
        axes.legend(fontsize=8, frameon=False, loc="upper left", labelcolor=plots.INK)
    left.set_ylim(bottom=0.0)
    return figure


def _turning(beta: float) -> tuple[float, float]:
    """Where limiting friction over G is least sensitive to beta: G = sin(beta), and the ratio there."""
    return np.sin(np.radians(beta)), 1.0 / np.cos(np.radians(beta))


def _limit_surface(title: str, data: FigureGrid) -> "Drawing":
    figure = plots.figure(6.4, 5.0)
    axes = figure.add_subplot(projection="3d", computed_zorder=False)
    shades: dict[str, Any] = {"cmap": slide.LEVEL_COLOURS, "vmin": 0.0, "vmax": slide.HIGHEST}
    lines: dict[str, Any] = {"rcount": 34, "ccount": 46, "edgecolor": "white", "linewidth": 0.2}
    axes.plot_surface(np.degrees(data.x), data.y[:, None], data.values, **shades, **lines)
    _dress_3d(axes, title, (slide.ANGLE, slide.RATIO, slide.FRICTION))
    axes.set(xlim=(-90, 90), ylim=(0.0, figures.DRIVE_RATIOS[-1]))
    axes.set_zlim(bottom=0.0)
    axes.set_xticks(np.arange(-90, 91, 30))
    return figure


def _contours(title: str, data: FigureGrid, beta: float) -> "Drawing":
    figure = plots.figure(6.6, 4.2)
    axes = plots.tidy(figure.add_subplot(), title=title, x=slide.ANGLE, y=slide.RATIO, grid="none")
    levels = [level for level in slide.LEVELS if level <= data.values.max()]
    shades = matplotlib.colormaps[slide.LEVEL_COLOURS](np.linspace(0.05, 0.75, len(levels)))
    angles = np.linspace(-89.9, 89.9, 361)
    for level, shade in zip(levels, shades):
        ratios = published_ratio(level, beta, np.radians(angles))
        axes.plot(angles, ratios, color=shade, linewidth=1.4)
        style: dict[str, Any] = {"fontsize": 7.5, "ha": "center", "va": "center", "bbox": LABEL_BOX}
        axes.text(0.0, ratios[180], f"μ = {level:g}", color=shade, **style)
    axes.set(xlim=(-90, 90), ylim=(0.0, data.y[-1]))
    axes.set_xticks(np.arange(-90, 91, 30))
    return figure


def _acceleration(
    title: str, data: FigureGrid, x_label: str, y_label: str, x: "NDArray", y: "NDArray"
) -> "Drawing":
    """As published, and from above with the part that no part follows."""
    figure = plots.figure(10.4, 4.6)
    left, right = figure.add_gridspec(1, 2, width_ratios=(1.0, 1.15))
    solid = figure.add_subplot(left, projection="3d", computed_zorder=False)
    across, up = np.meshgrid(x, y)
    solid.plot_surface(
        across,
        up,
        data.values,
        cmap=slide.LEVEL_COLOURS,
        rcount=46,
        ccount=46,
        edgecolor="white",
        linewidth=0.2,
    )
    _dress_3d(solid, "As published", (x_label, y_label, ACCELERATION_AXIS))
    flat = plots.tidy(
        figure.add_subplot(right), title="Where the part slides", x=x_label, y=y_label, grid="none"
    )
    filled = flat.contourf(x, y, data.values, 14, cmap=slide.LEVEL_COLOURS)
    _hop_region(flat, x, y, data)
    _stick_region(flat, x, y, data)
    bar = figure.colorbar(filled, ax=flat, pad=0.02)
    bar.set_label(ACCELERATION_AXIS, fontsize=9, color=plots.INK)
    bar.ax.tick_params(labelsize=8, colors=plots.INK)
    bar.outline.set_visible(False)
    figure.suptitle(title, x=0.01, ha="left", fontsize=10, color=plots.INK, fontweight="bold")
    return figure


def _hop_region(axes: "Axes", x: "NDArray", y: "NDArray", data: FigureGrid) -> None:
    """White hatching where contact is lost."""
    with matplotlib.rc_context({"hatch.color": "white", "hatch.linewidth": 0.4}):
        axes.contourf(x, y, data.throw, [1.0, np.inf], colors="none", hatches=["///"])
    axes.contour(x, y, data.throw, [1.0], colors="white", linewidths=1.8)
    row, column = (int(np.mean(places)) for places in np.nonzero(data.hops))
    text = "hops: the formula's value,\nnot a part's"
    axes.text(
        x[column], y[row], text, fontsize=8.5, color=plots.INK, ha="center", va="center", bbox=LABEL_BOX
    )


def _stick_region(axes: "Axes", x: "NDArray", y: "NDArray", data: FigureGrid) -> None:
    """A dashed line where friction holds the part: the formula is negative within."""
    sticks = data.values < 0.0
    if not sticks.any():
        return
    axes.contour(x, y, data.values, [0.0], colors="white", linewidths=1.4, linestyles="--")
    row = len(y) // 2
    style: dict[str, Any] = {"fontsize": 8.5, "color": "white", "ha": "center", "va": "center"}
    axes.text(x[sticks[row].sum() // 2], y[row], "sticks", **style)


def _dress_3d(axes: Any, title: str, labels: Iterable[str]) -> None:
    axes.set_title(title, loc="left", fontsize=10, color=plots.INK, fontweight="bold")
    for set_label, text in zip((axes.set_xlabel, axes.set_ylabel, axes.set_zlabel), labels):
        set_label(text, fontsize=9, color=plots.INK)
    axes.tick_params(labelsize=8, colors=plots.INK)
    axes.set_box_aspect(None, zoom=0.92)
    axes.view_init(elev=28, azim=-118)
