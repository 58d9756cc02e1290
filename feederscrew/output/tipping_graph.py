"""The tipping graph of ``feeder aspects --graph``: which aspect tips into which, and by what lift."""

from functools import partial
from typing import Any

import numpy as np

from feederscrew.heavy import heavy
from feederscrew.output import offers as offer
from feederscrew.output import style, tables
from feederscrew.output.columns import UJ
from feederscrew.output.tables import Frame
from feederscrew.studies.aspects import AspectsStudy
from feederscrew.units import GRAVITY, MM

shading = heavy("feederscrew.output.shading")


def transitions(study: AspectsStudy) -> Frame:
    """Return the tipping graph, a row a way from one aspect into another or its equal: ``graph.csv``."""
    tips, names = study.transitions, study.aspects.names
    axes = np.array([tip.axis for tip in tips]).reshape(-1, 3)
    lifts = np.array([tip.lift for tip in tips], dtype=float)
    return tables.frame(
        {
            "from": [names[tip.start] for tip in tips],
            "to": [names[tip.end] for tip in tips],
            "barrier_mm": lifts / MM,
            "barrier_uJ": study.part.mass * GRAVITY * lifts / UJ,
            **dict(zip(("axis_x", "axis_y", "axis_z"), axes.T)),
        }
    )


def offers(study: AspectsStudy) -> list[offer.Offer]:
    """Offer the table and the drawing of what tips into what."""
    alt = "Tipping graph: which aspect tips into which, and the lift it takes"

    def draw() -> Any:
        return of_part(study, study.transitions, study.aspects.probabilities["quasistatic"])

    return [offer.table("graph.csv", transitions, study), offer.picture("graph.png", alt, draw)]


MOST_GRAPH_ASPECTS = 12  # aspects a picture can show
LABEL_CLEARANCE = 4.0  # [pt] between an arrow and a disc
BEND = 0.12  # of an arrow, so that there and back lie apart
LIFT_SPOTS = (  # of the way: where the lift may be written, the first that is free
    0.3, 0.27, 0.33, 0.24, 0.36, 0.21, 0.39, 0.42, 0.45, 0.48, 0.54, 0.6, 0.66, 0.72,
)  # fmt: skip
CROSSED = 2e-3  # of a point of another arrow under a label, as an overlap
LETTER_SIZE = (0.041, 0.109)  # width and height of one, over the ring's radius
DISC_SIZE = (0.22, 0.22)  # half a disc, over the ring's radius
FRAMED = 4200.0  # [pt2] square about the disc behind a drawn aspect
PICTURE_HALF_WIDTH = 0.15  # width of a drawn aspect, over the ring's diameter
ASPECT_PICTURE_PX = (160, 120)  # [px] of it
LIFT_DIGITS = 2  # of a name that fits into a disc
PALE_ARROW = "#9ba3aa"  # of ways that are not the easiest
EQUAL_LIFT = 1.001  # of the lowest lift out of a disc, up to which another is as easy
RING_REACH = 1.45  # of the picture, where the ring of discs has radius 1


def graph(title: str, names: Any, tips: Any, shares: Any, drawn: Any = None) -> Any:
    """Draw the A aspects on a ring, joined by arrows that carry the lift in mm.

    ``tips`` are Transitions, ``shares`` (A,) [1] quasi-static probabilities: an aspect where it is NaN is
    left out. ``drawn`` gives the picture (H, W, C) of an aspect by its row; without it a disc stands for
    each aspect, whose area grows with its share.
    """
    figure = style.figure(6.4, 6.4)
    axes = figure.add_subplot()
    head = f"{title}: lift to tip [mm]"
    axes.text(-RING_REACH, RING_REACH, head, ha="left", va="top", fontsize=10, color=style.INK)
    visible = [k for k in range(len(names)) if np.isfinite(shares[k])][:MOST_GRAPH_ASPECTS]
    turn = np.pi / 2 - 2.0 * np.pi * np.arange(len(visible)) / max(len(visible), 1)
    places = {k: np.array([np.cos(a), np.sin(a)]) for k, a in zip(visible, turn)}
    sizes = 500.0 + 2500.0 * np.nan_to_num(shares)  # [pt2] squares about the discs
    sizes = sizes if drawn is None else np.full(len(names), FRAMED)
    _arrows(axes, tips, places, sizes, names)
    for k, place in places.items():
        edge = style.INK if drawn is None else style.FAINT
        axes.scatter(*place, s=sizes[k], color="white", edgecolor=edge, zorder=3)
        look = {"ha": "center", "color": style.INK}
        if drawn is None:  # a letter within its disc, a longer name across it
            letter = len(names[k]) <= LIFT_DIGITS
            box = {} if letter else {"bbox": {"facecolor": "white", "edgecolor": "none", "pad": 1.0}}
            axes.annotate(names[k], place, va="center", fontsize=11 if letter else 9, zorder=4, **look, **box)
        else:  # the part as it rests on the aspect, name and share below
            shown = drawn(k)
            half = PICTURE_HALF_WIDTH * np.array([1.0, shown.shape[0] / shown.shape[1]])
            (left, low), (right, high) = place - half + [0.0, 0.03], place + half + [0.0, 0.03]
            axes.imshow(shown, extent=(left, right, low, high), zorder=4, interpolation="antialiased")
            text, below = f"{names[k]}  {100.0 * shares[k]:.3g} %", place - [0.0, half[1] - 0.02]
            axes.annotate(text, below, va="top", fontsize=9, fontweight="bold", zorder=5, **look)
    note = (
        "orange: the easiest way off each aspect\n"
        "below each aspect: the share of all attitudes from which the part, let go without speed, ends on it"
    )
    axes.text(0.0, -RING_REACH, note, ha="center", va="bottom", fontsize=8, color=style.INK)
    axes.set_xlim(-RING_REACH, RING_REACH)
    axes.set_ylim(-RING_REACH, RING_REACH)
    axes.set_aspect("equal")
    axes.axis("off")
    return figure


def of_part(study: Any, tips: Any, shares: Any) -> Any:
    """Draw the graph of an AspectsStudy or report case with the part in each aspect, where it has a shape."""
    part, resting = study.part, study.aspects
    if part.vertices is None:
        return graph(part.name, resting.names, tips, shares)
    solid = shading.Rays(part.vertices, part.faces, part.centre_of_mass)
    drawn = partial(shading.thumbnail, solid, resting, size=ASPECT_PICTURE_PX)
    return graph(part.name, resting.names, tips, shares, drawn)


def _arrows(axes: Any, tips: Any, places: Any, sizes: Any, names: Any) -> None:
    """The easiest way between every two discs that are shown; the easiest out of each stands out."""
    lowest: dict[int, float] = {}
    between: dict[tuple[int, int], float] = {}
    for tip in tips:
        lowest[tip.start] = min(tip.lift, lowest.get(tip.start, np.inf))
        pair = (tip.start, tip.end)
        if set(pair) <= set(places) and tip.lift < between.get(pair, np.inf):
            between[pair] = tip.lift
    taken = [(*place, max(DISC_SIZE[0], _half(names[k])[0]), DISC_SIZE[1]) for k, place in places.items()]
    curves = {pair: _curve(places[pair[0]], places[pair[1]], np.linspace(0.0, 1.0, 60)) for pair in between}
    for (start, end), lift in sorted(between.items(), key=lambda item: -item[1]):  # the easy ones on top
        ends = (places[start], sizes[start]), (places[end], sizes[end])
        other_labels = [curve for pair, curve in curves.items() if pair != (start, end)]
        taken.append(_arrow(axes, *ends, lift, lift <= EQUAL_LIFT * lowest[start], taken, other_labels))


def _arrow(
    axes: Any, begin: Any, end: Any, lift: float, easiest: bool, taken: Any, other_labels: Any
) -> tuple[float, ...]:
    """Draw one way between two discs (place, size), bent to leave room for the way back.

    ``lift`` [m] is its label; the ``easiest`` out of that disc stands out. ``taken`` are boxes of discs
    and labels that are there already: middle, half width, half height. ``other_labels`` are (K, 2) points
    of the other arrows: a number stands where it is none of theirs. Returns the box of its own label.
    """
    (start, from_size), (end, to_size) = begin, end
    colour, text = style.ACCENT if easiest else PALE_ARROW, f"{lift / MM:.3g}"
    box = {"facecolor": "white", "edgecolor": "none", "pad": 0.8}
    look = {"ha": "center", "va": "center", "fontsize": 9, "zorder": 5, "bbox": box}
    look["color"] = style.ACCENT if easiest else style.INK
    if np.allclose(start, end):
        axes.annotate(text, 1.32 * start, **look)
        return (*1.32 * start, *_half(text))
    bent = {"connectionstyle": f"arc3,rad={BEND}", "arrowstyle": "-|>,head_length=0.5,head_width=0.22"}
    shrunk = {f"shrink{e}": 0.5 * np.sqrt(s) + LABEL_CLEARANCE for e, s in (("A", from_size), ("B", to_size))}
    order = {"zorder": 2 if easiest else 1}
    axes.annotate("", end, start, arrowprops={**bent, **shrunk, "color": colour, "linewidth": 1.1}, **order)
    spots = _curve(start, end, np.array(LIFT_SPOTS))
    crossed = np.reshape(np.concatenate([*other_labels, np.zeros((0, 2))]), (-1, 2))
    half = np.array(_half(text))
    # where it covers least: area of discs and labels, and points of other arrows
    hidden = []
    for spot in spots:
        sides = [[max(half[k] + box[k + 2] - abs(spot[k] - box[k]), 0.0) for k in (0, 1)] for box in taken]
        under = (np.abs(crossed - spot) < half).all(axis=1).sum()
        hidden.append(sum(wide * high for wide, high in sides) + CROSSED * under)
    spot = spots[int(np.argmin(hidden))]
    axes.annotate(text, spot, **look)
    return (*spot, *_half(text))


def _curve(start: Any, end: Any, shares: Any) -> Any:
    """The points (K, 2) of a bent arrow at shares (K,) of its way."""
    along = end - start
    offset = np.array([along[1], -along[0]]) * BEND  # of the middle control point of the arc
    return start + shares[:, None] * along + 2.0 * (shares * (1.0 - shares))[:, None] * offset


def _half(text: str) -> tuple[float, float]:
    return 0.5 * LETTER_SIZE[0] * len(text), 0.5 * LETTER_SIZE[1]
