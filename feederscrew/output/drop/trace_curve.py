"""Energy of one drop over time, with the heights it must come down to."""

import numpy as np
from matplotlib.ticker import FuncFormatter, LogLocator

from feederscrew.output import style
from feederscrew.units import MM

HEIGHT = "#0072b2"  # colour of the height of the centre of mass
APART = 0.075  # of the axis: labels closer than this would touch
ABOVE = 0.4  # room over the highest reference line, of that below it, on the logarithmic axis
LEGEND = (0.96, 0.87)  # places of its lines, of the axis


def curve(axes, trace, aspects, rows):
    """Draw the energy and height of the centre of mass over time, with the stills' numbers.

    Parameters
    ----------
    axes : Axes
        To draw on.
    trace : DropTrace
    aspects : Aspects
    rows : (S,) int
        Rows of the stills.
    """
    times, energies, heights = 1e3 * trace.times, trace.energies / MM, trace.positions[:, 2] / MM
    style.tidy(axes, x="time [ms]", y="energy as height [mm]", grid="none")
    axes.plot(times, energies, color=style.ACCENT, linewidth=1.6, label="energy", zorder=3)
    axes.plot(times, heights, color=HEIGHT, linewidth=1.0, label="of which height", zorder=2)
    lines = references(trace, aspects)
    lowest = 0.88 * min(heights.min(), *(height for height, _, _ in lines))
    highest = max(height for height, _, _ in lines)
    axes.set_yscale("log")
    axes.set_ylim(lowest, max(highest * (highest / lowest) ** ABOVE, 1.25 * energies.max()))
    axes.set_xlim(0.0, 1.015 * times[-1])
    axes.yaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axes.yaxis.set_minor_locator(LogLocator(subs=()))
    _named(axes, lines)
    for number, row in enumerate(rows, start=1):
        badge(axes, times[row], energies[row], number)
    if trace.row >= 0:
        certain = 1e3 * trace.decided
        axes.axvline(certain, color=style.INK, linewidth=0.8, linestyle=(0, (1, 2)))
        axes.text(certain, 1.01, f"from here {aspects.names[trace.row]} is certain", fontsize=7, va="bottom",
                  ha="center", color=style.INK, transform=axes.get_xaxis_transform())  # fmt: skip
    axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.03), fontsize=7, frameon=False, borderpad=0.0)


def references(trace, aspects):
    """Return heights to compare with: (mm, text, style), of every aspect and of the way out of the last.

    Parameters
    ----------
    trace : DropTrace
    aspects : Aspects

    Returns
    -------
    list of (float, str, dict)
    """
    plain = {"color": style.FAINT, "linewidth": 0.9, "zorder": 0}
    strong = {"color": style.INK, "linewidth": 0.9, "zorder": 1}
    lines = []
    if trace.row >= 0:
        height = aspects.heights[trace.row]
        name, barrier = aspects.names[trace.row], aspects.barriers[trace.row]
        lines.append((height / MM, f"rests on {name}", strong))
        if np.isfinite(barrier):
            saddle = (height + barrier) / MM
            lines.append((saddle, f"tips from {name}", strong | {"linestyle": (0, (5, 3))}))
    for row in np.flatnonzero(aspects.stable):
        if row != trace.row:
            lines.append((aspects.heights[row] / MM, f"rests on {aspects.names[row]}", plain))
    return lines


def badge(axes, x, y, number):
    """Draw a still's number in a disc."""
    disc = {"boxstyle": "circle,pad=0.25", "facecolor": "white", "edgecolor": style.INK, "linewidth": 0.7}
    axes.text(x, y, str(number), fontsize=6, ha="center", va="center", color=style.INK, bbox=disc, zorder=6,
              clip_on=False)  # fmt: skip


def _named(axes, lines):
    """Reference lines, their names at the right from the first on; one without room is left out."""
    low, high = np.log(axes.get_ylim())
    taken = list(LEGEND)
    for height, text, look in lines:
        axes.axhline(height, **look)
        place = (np.log(height) - low) / (high - low)
        if all(abs(place - other) >= APART for other in taken):
            taken.append(place)
            axes.text(1.01, place, f"{text} {height:.3g}", transform=axes.transAxes, fontsize=7, va="center",
                      color=style.INK)  # fmt: skip
