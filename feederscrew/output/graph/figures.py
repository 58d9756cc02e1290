"""The tipping graph drawn: what a part tips into, and how high it must be lifted for it."""

import numpy as np

from feederscrew.output import style
from feederscrew.output.columns import MM

MOST = 12  # aspects a picture can show
CLEAR = 4.0  # [pt] between an arrow and a disc
BEND = 0.12  # of an arrow, so that there and back lie apart
TAIL = 0.36  # of the way: where the lift is written
REACH = 1.45  # of the picture, where the ring of discs has radius 1


def graph(title, names, ways, shares):
    """Draw discs on a ring, one an aspect, joined by arrows that carry the lift in mm.

    Parameters
    ----------
    title : str
    names : sequence of str
        Of the A aspects.
    ways : sequence of Transition
    shares : (A,) float [1]
        Quasi-static probability; the area of a disc grows with it. An aspect where it is NaN is left out.

    Returns
    -------
    Figure
    """
    figure = style.figure(6.4, 6.4)
    axes = figure.add_subplot()
    axes.set_title(f"{title}: lift to tip [mm]", loc="left", fontsize=10, color=style.INK)
    shown = [k for k in range(len(names)) if np.isfinite(shares[k])][:MOST]
    turn = np.pi / 2 - 2.0 * np.pi * np.arange(len(shown)) / max(len(shown), 1)
    places = {k: np.array([np.cos(a), np.sin(a)]) for k, a in zip(shown, turn)}
    sizes = 500.0 + 2500.0 * np.nan_to_num(shares)  # [pt2] squares about the discs
    _arrows(axes, ways, places, sizes)
    for k, place in places.items():
        axes.scatter(*place, s=sizes[k], color="white", edgecolor=style.INK, zorder=3)
        axes.annotate(names[k], place, ha="center", va="center", fontsize=11, zorder=4, color=style.INK)
    axes.set_xlim(-REACH, REACH)
    axes.set_ylim(-REACH, REACH)
    axes.set_aspect("equal")
    axes.axis("off")
    return figure


def _arrows(axes, ways, places, sizes):
    """Every way between two discs that are shown; the easiest out of each stands out."""
    lowest = {}
    for way in ways:
        lowest[way.start] = min(way.lift, lowest.get(way.start, np.inf))
    for way in ways:
        if way.start in places and way.end in places:
            ends = (places[way.start], sizes[way.start]), (places[way.end], sizes[way.end])
            arrow(axes, *ends, way.lift, way.lift <= lowest[way.start])


def arrow(axes, begin, end, lift, easiest):
    """Draw one way between two discs (place, size), bent to leave room for the way back."""
    (start, from_size), (end, to_size) = begin, end
    colour = style.ACCENT if easiest else style.INK
    look = {"arrowstyle": "->", "color": colour, "alpha": 1.0 if easiest else 0.45}
    if np.allclose(start, end):
        axes.annotate(_shown(lift), 1.32 * start, ha="center", va="center", fontsize=7, color=colour)
        return
    axes.annotate(
        "",
        end,
        start,
        arrowprops={
            **look,
            "connectionstyle": f"arc3,rad={BEND}",
            "shrinkA": 0.5 * np.sqrt(from_size) + CLEAR,
            "shrinkB": 0.5 * np.sqrt(to_size) + CLEAR,
        },
    )
    along = end - start
    beside = np.array([along[1], -along[0]]) * BEND  # of the middle control point of the arc
    axes.annotate(
        _shown(lift), start + TAIL * along + 2.0 * TAIL * (1.0 - TAIL) * beside,
        ha="center", va="center", fontsize=7, color=colour, zorder=5,
        bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.8},
    )  # fmt: skip


def _shown(lift):
    return f"{lift / MM:.3g}"
