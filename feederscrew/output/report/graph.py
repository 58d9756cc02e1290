"""The tipping graph: aspects, and the lift that tips the part from one into another."""

import numpy as np

from feederscrew.output import style
from feederscrew.units import factor

MM = factor("mm", "length")
MOST = 12  # aspects that a circle shows
LARGEST = 1500.0  # [pt2] of a disc for a probability of 1
LEAST = 260.0
DISC, ARROW = "#0072b2", "#7b8794"
ROOM = 0.32  # round the circle, of its radius
TAIL = 0.36  # of the way: where the lift is written
BEND = 0.18  # of an arrow, so that there and back lie apart


def tipping(names, shares, ways, title):
    """Arrows between the aspects, the wider the lower the lift.

    Parameters
    ----------
    names : sequence of str
    shares : (A,) float [1]
        Of the discs' areas.
    ways : sequence of Transition
        Those between two of the aspects given; the lift stands by the arrow's tail.
    title : str

    Returns
    -------
    Figure
    """
    figure = style.figure(6.0, 5.2)
    axes = figure.add_subplot()
    axes.set_title(style.words(title), loc="left", fontsize=10, color=style.INK, fontweight="bold")
    angles = np.pi / 2.0 - 2.0 * np.pi * np.arange(len(names)) / len(names)
    places = np.column_stack([np.cos(angles), np.sin(angles)])
    lowest = min((way.lift for way in ways if way.lift > 0.0), default=1.0)
    for way in ways:
        _arrow(axes, places[way.start], places[way.end], way.lift, lowest)
    axes.scatter(
        *places.T, s=LEAST + LARGEST * np.nan_to_num(shares), color=DISC, zorder=3, edgecolor="white"
    )
    for name, (x, y) in zip(names, places):
        axes.text(
            x, y, name, ha="center", va="center", color="white", fontweight="bold", fontsize=9, zorder=4
        )
    low, high = places[:, 1].min() - ROOM, places[:, 1].max() + ROOM
    axes.set(xlim=(-1.0 - ROOM, 1.0 + ROOM), ylim=(low, high), aspect="equal")
    axes.set_axis_off()
    return figure


def _arrow(axes, start, end, lift, lowest):
    """An arrow bent to its right with its lift in mm a third of the way along."""
    width = 0.6 + 2.4 * lowest / max(lift, lowest)
    axes.annotate(
        "", end, start, zorder=1,
        arrowprops={
            "arrowstyle": "-|>", "connectionstyle": f"arc3,rad={BEND}", "color": ARROW, "linewidth": width,
            "shrinkA": 14, "shrinkB": 15, "mutation_scale": 9,
        },
    )  # fmt: skip
    step = end - start
    beside = np.array([step[1], -step[0]]) * BEND  # of the middle control point of the arc
    x, y = start + TAIL * step + 2.0 * TAIL * (1.0 - TAIL) * beside
    axes.text(
        x, y, f"{lift / MM:.3g}", fontsize=7, color=style.INK, ha="center", va="center", zorder=2,
        bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.8},
    )  # fmt: skip
