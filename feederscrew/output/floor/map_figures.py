"""Maps over two quantities with regions marked, and states along a cycle: what floor and track share."""

import textwrap
from collections.abc import Sequence

import matplotlib
import numpy as np
from matplotlib.patches import Patch
from matplotlib.ticker import MaxNLocator

from feederscrew.output import style

HATCHES = {  # regime: hatch, colour of the face, what it says
    "hop": ("////", "#e1e5e8", "hops: contact is lost (dashed: throw number k)"),
    "tip": ("....", "#f2d3c4", "tips"),
    "stick": ("", "#eef2f5", "sticks"),
    "leaves the wall": ("\\\\\\\\", "#dfe9d2", "leaves the wall"),
    "does not fit": ("xxx", "#d9d2e3", "does not fit: falls off the track"),
}
SOLID = ("hop", "stick", "does not fit")  # regimes whose values mean nothing, or are zero
STATES = {"stick": "#9fb3c4", "slide": "#4f9d7f", "hop": "#c9ced3", "tip": style.ACCENT}
HATCH = "#8d979f"
SHADES = "cividis"
HALF = 0.5
THROWS = (1.2, 1.5, 2.0, 2.5, 3.0, 4.0, 6.0, 10.0, 20.0, 50.0, 100.0)  # that a line may be drawn for
LETTERS = 100  # of a line under a title


def regime_map(grid, column, *, title, labels, value, own=None, note=()):
    """Draw values in colour with contour lines, and every region where they mean something else.

    Parameters
    ----------
    grid : Grid
        Of maps.evaluate.
    column : str
        Whose values are shown.
    title : str
    labels : pair of str
        Of the two axes.
    value : str
        What the colour bar shows.
    own : pair of float, optional
        The bowl's own point, in the axes' units.
    note : sequence of str
        Told under the title, a line each.

    Returns
    -------
    Figure
    """
    figure = style.figure(6.8, 4.8)
    axes = style.tidy(figure.add_subplot(), title=title, x=labels[0], y=labels[1], grid="none")
    x, y, shown = grid.first.shown, grid.second.shown, np.asarray(grid.values[column]).T
    if np.isfinite(shown).any():
        _values(figure, axes, (x, y, shown), value, np.isin(grid.codes.T, _places(grid, SOLID)))
    found = [name for name in HATCHES if _region(axes, grid, name)]
    _throws(axes, grid)
    if own is not None:
        _own_point(axes, own)
    if note:
        _note(axes, note)
    axes.set(xlim=(x[0], x[-1]), ylim=(y[0], y[-1]))
    _legend(figure, found)
    return figure


def _note(axes, lines):
    """Sentences under the title, each from a line of its own."""
    listed = [piece for line in lines for piece in textwrap.wrap(line, LETTERS)]
    axes.text(
        0.0, 1.01, "\n".join(listed), transform=axes.transAxes, fontsize=7.5, color=style.INK, va="bottom"
    )
    axes.set_title(
        axes.get_title(loc="left"), loc="left", fontsize=10, color=style.INK, fontweight="bold",
        pad=6 + 10 * len(listed),
    )  # fmt: skip


def state_band(axes, phase, states, names):
    """A band along the top of an Axes in the colour of each instant's state."""
    step = 360.0 / len(phase)
    for code, name in enumerate(names):
        for run in _runs(np.asarray(states) == code):
            axes.axvspan(
                phase[run[0]] - HALF * step, phase[run[-1]] + HALF * step,
                ymin=0.965, color=STATES[name], linewidth=0,
            )  # fmt: skip


def state_legend(figure, states, names):
    """Colours of the states that occur, below the figure."""
    present = [name for code, name in enumerate(names) if code in np.asarray(states)]
    handles = [Patch(color=STATES[name], label=name) for name in present]
    figure.legend(handles=handles, loc="outside lower center", ncols=len(handles), fontsize=8, frameon=False)


def phase_axis(axes):
    """Phase of the vibration along x, the reversals marked."""
    axes.set_xlim(0, 360)
    axes.set_xticks(np.arange(0, 361, 45))
    for phase in (90, 270):
        axes.axvline(phase, color=style.FAINT, linewidth=1.2, zorder=0)


def _places(grid, names):
    return [grid.names.index(name) for name in names if name in grid.names]


def _values(figure, axes, data, label, covered):
    x, y, shown = data
    finite = shown[np.isfinite(shown)]
    low, high = finite.min(), finite.max()
    high = high if high - low > 1e-12 * max(abs(high), 1e-300) else low + 1.0
    mesh = axes.pcolormesh(x, y, shown, cmap=SHADES, vmin=low, vmax=high, shading="nearest", zorder=1)
    bar = figure.colorbar(mesh, ax=axes, pad=0.02)
    bar.set_label(label, fontsize=9, color=style.INK)
    bar.ax.tick_params(labelsize=8, colors=style.INK)
    bar.outline.set_visible(False)
    open_to_view = np.ma.masked_invalid(np.where(covered, np.nan, shown))
    if min(shown.shape) > 1 and open_to_view.count() and np.ptp(open_to_view.compressed()) > 0.0:
        lines = axes.contour(x, y, open_to_view, 8, colors="white", linewidths=0.6, zorder=2)
        for text in axes.clabel(lines, fmt="%g", fontsize=6.5):
            text.set_path_effects(style.RIM)


def _region(axes, grid, name):
    """Hatch one regime; whether it occurs."""
    if name not in grid.names:
        return False
    inside = grid.names.index(name) == grid.codes.T
    if not inside.any():
        return False
    hatch, colour, _ = HATCHES[name]
    with matplotlib.rc_context({"hatch.color": HATCH, "hatch.linewidth": 0.6}):
        cover = np.where(inside, 1.0, 0.0)
        axes.contourf(
            grid.first.shown, grid.second.shown, cover, [HALF, 1.5], colors=[colour],
            alpha=1.0 if name in SOLID else 0.55, hatches=[hatch or None], zorder=3,
        )  # fmt: skip
    if not inside.all():
        axes.contour(
            grid.first.shown, grid.second.shown, cover, [HALF], colors=style.INK, linewidths=0.9, zorder=4
        )
    return True


def _throws(axes, grid):
    """Lines of equal throw number where the part hops: all that this balance can say there."""
    if "hop" not in grid.names or "throw_number" not in grid.values or min(grid.codes.shape) < 2:
        return
    throw = np.where(grid.names.index("hop") == grid.codes, grid.values["throw_number"], np.nan).T
    known = throw[np.isfinite(throw)]
    if not known.size or known.min() == known.max():
        return
    levels: Sequence[float] = [level for level in THROWS if known.min() < level < known.max()]
    if len(levels) < 2:
        levels = MaxNLocator(5).tick_values(known.min(), known.max())
    if len(levels):
        x, y, shown = grid.first.shown, grid.second.shown, np.ma.masked_invalid(throw)
        lines = axes.contour(x, y, shown, levels, colors=style.INK, linewidths=0.8, linestyles="--", zorder=5)
        for text in axes.clabel(lines, fmt=lambda level: f"k = {level:g}", fontsize=7):
            text.set_path_effects(style.HALO)


def _own_point(axes, own):
    axes.plot(*own, "o", markersize=7, color=style.ACCENT, markeredgecolor="white", zorder=6)
    axes.annotate(
        "this bowl", own, (8, 6), textcoords="offset points", fontsize=8, color=style.ACCENT,
        fontweight="bold", zorder=6, bbox={"facecolor": "white", "alpha": 0.8, "linewidth": 0, "pad": 1.0},
    )  # fmt: skip


def _legend(figure, names):
    if not names:
        return
    with matplotlib.rc_context({"hatch.color": HATCH, "hatch.linewidth": 0.6}):
        handles = [
            Patch(
                facecolor=HATCHES[n][1],
                hatch=HATCHES[n][0],
                label=HATCHES[n][2],
                edgecolor=HATCH,
                linewidth=0.4,
            )
            for n in names
        ]
        figure.legend(
            handles=handles, loc="outside lower left", ncols=len(handles), fontsize=8, frameon=False
        )


def _runs(flags):
    indices = np.flatnonzero(flags)
    return [run for run in np.split(indices, np.flatnonzero(np.diff(indices) > 1) + 1) if len(run)]
