"""Files of ``feeder aspects``: its tables and documents, its chart and its sheet of views."""

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any

import numpy as np

from feederscrew.arrivals.aspects_study import AspectsStudy
from feederscrew.arrivals.heap_count import HEAP_COLUMNS
from feederscrew.base import columns
from feederscrew.base.arrays import Array, Floats, Points, Vector
from feederscrew.base.columns import Document, Frame
from feederscrew.base.documents import hint, nearest
from feederscrew.base.errors import ArgumentError
from feederscrew.base.heavy import heavy
from feederscrew.base.units import MM, quantity_text
from feederscrew.output import offers as offer
from feederscrew.output import part_facts, style, tables
from feederscrew.output.offers import RecordView
from feederscrew.output.record_lines import aspects_text
from feederscrew.part.record import Part
from feederscrew.resting.aspects import Aspects, names_text
from feederscrew.resting.exact_tumbling import Transition
from feederscrew.resting.rules.recommended import Recommended

shading = heavy("feederscrew.output.shading")

MOST_DRAWN_ASPECTS = 24  # rows that a picture shows
TIPPING_ALT = "Tipping graph: which aspect tips into which, and the lift it takes"
RECOMMENDED_COLUMNS = ("p_recommended", "p_recommended_low", "p_recommended_high")
DROP_COLUMNS = ("p_drop", "p_drop_low", "p_drop_high")
PRINTED = (  # the table for people, unless they ask for more
    "aspect",
    "lies",
    "stable",
    "height_mm",
    *RECOMMENDED_COLUMNS,
    "p_pmi",
    "p_csa",
    "p_stability",
    "surface",
    "tumbling",
)


def select_columns(frame: Frame, choice: str | None = None) -> Frame:
    """Return the columns of the table of aspects that are printed for people.

    Parameters
    ----------
    frame : Frame
        Of an AspectsStudy.
    choice : str, optional
        Names, or what the table heads them, with commas between, or 'all'; without it those of ``PRINTED``
        that there are, the likeliest answer first.

    Returns
    -------
    Frame

    Raises
    ------
    ArgumentError
        If there is no such column.
    """
    if choice is None:
        table = frame.only(name for name in PRINTED if name in frame)
        if RECOMMENDED_COLUMNS[0] not in table:
            return table
        shares = np.nan_to_num(np.asarray(table[RECOMMENDED_COLUMNS[0]], dtype=float), nan=-1.0)
        order = np.argsort(-shares, kind="stable")
        return table.taking({name: [column[row] for row in order] for name, column in table.items()})
    names = list(frame) if choice.strip() == "all" else [name.strip() for name in choice.split(",")]
    # by what a table heads them, 'height' and 'pmi'; without what heads several, 'low'
    words = [tables.head_of(frame, name).heading.casefold() for name in frame]
    headed = {word: name for word, name in zip(words, frame) if words.count(word) == 1}
    names = [name if name in frame else headed.get(name.casefold(), name) for name in names]
    for name in names:
        if name not in frame:
            what = f"there is no column {quantity_text(name)}"
            near = nearest(name, frame)
            value = None if near is None else ",".join(near if each == name else each for each in names)
            raise ArgumentError("columns", what, hint(name, list(frame)), value=value)
    return frame.only(names)


def check_columns(study: AspectsStudy, choice: str) -> None:
    """Refuse before a part is dropped what ``select_columns`` will.

    Parameters
    ----------
    study : AspectsStudy
        Of the closed form, without drops.
    choice : str
        As for ``select_columns``.

    Raises
    ------
    ArgumentError
        If there is no such column.
    """
    frame = study.table()
    dropped = frame.taking(dict.fromkeys(DROP_COLUMNS, frame["aspect"]))
    select_columns(dropped.with_headings({DROP_COLUMNS[0]: "drop"}), choice)


def document(study: AspectsStudy) -> Document:
    """Return all of a part and its aspects as the JSON document.

    Parameters
    ----------
    study : AspectsStudy

    Returns
    -------
    dict
        ``recommended``, the rule of that answer, is None for a card.
    """
    return part_facts.part(study.part, study.aspects.warnings) | {
        "recommended": None if study.recommended is None else study.recommended.rule,
        "aspects": study.table(),
        "heap": None if study.heap is None else columns.values(HEAP_COLUMNS, study.heap),
    }


def remarks(study: AspectsStudy) -> list[str]:
    """Return what a user should know of pictures that are missing or not whole, a line each.

    Parameters
    ----------
    study : AspectsStudy

    Returns
    -------
    list of str
    """
    count = len(study.aspects.names)
    if study.part.vertices is None:
        return ["a part card has no shape to draw: no aspects.png"]
    whole = count <= MOST_DRAWN_ASPECTS
    return [] if whole else [f"aspects.png shows the first {MOST_DRAWN_ASPECTS} of {count} rows"]


def offers(study: AspectsStudy, *, with_graph: bool = False) -> list[offer.Offer]:
    """Offer the table of aspects and its pictures.

    ``names.yaml``, the aspects by name to be edited and read again, and ``aspects.png`` only of a part that
    has a shape.

    Parameters
    ----------
    study : AspectsStudy
    with_graph : bool, optional
        Whether the tipping graph is offered too.

    Returns
    -------
    list of Offer
    """
    by_rule = "Probability of each aspect by every rule"
    offered = [
        offer.table("aspects.csv", study.table),
        offer.document("aspects.json", document, study),
        offer.picture("probabilities.png", by_rule, _probability_chart, study),
    ]
    if study.part.vertices is not None:
        rows = range(min(len(study.aspects.names), MOST_DRAWN_ASPECTS))
        drawn = study.part, study.aspects, rows, study.recommended
        what = "The part as it rests on each aspect"
        offered.append(offer.text("names.yaml", names_text, study.part, study.aspects))
        offered.append(offer.picture("aspects.png", what, aspect_views, *drawn))
    if with_graph:
        rules = study.aspects.probabilities
        offered += [
            offer.table("graph.csv", study.transitions_table),
            offer.picture(
                "graph.png",
                TIPPING_ALT,
                lambda: draw_tipping_graph(study, study.transitions, rules["quasistatic"]),
            ),
        ]
    return offered


def _probability_chart(study: AspectsStudy, ax: "style.Axes | None" = None) -> "style.Figure":
    """The probability of each of the first stable aspects: the recommended answer first, then every rule."""
    part, aspects, answer = study.part, study.aspects, study.recommended
    title = f"{part.name} (open surface)" if part.open_surface else part.name
    stable = np.flatnonzero(aspects.stable)[:MOST_DRAWN_ASPECTS]
    names = [aspects.names[row] for row in stable]
    by_rule = {rule: p[stable] for rule, p in aspects.probabilities.items()}
    if answer is None:
        return profile_bars(names, by_rule, title=title, ax=ax)
    shares = np.array([answer.p[stable], answer.low[stable], answer.high[stable]])
    return answer_bars(names, shares, by_rule, title=title, ax=ax)


PROBABILITIES = {"x": "aspect", "y": "probability [%]", "grid": "y"}
NARROW_IN, WIDE_IN = 5.2, 12.0  # [in] limits of the figure's width
MARKS = "osD^vPX*<>hp"  # of the rules: who does not see their colours tells them apart by shape


def profile_bars(
    names: Sequence[str], profiles: Mapping[str, Floats], title: str = "", ax: "style.Axes | None" = None
) -> "style.Figure":
    """Draw profiles as bars, grouped by the names of the aspects; NaN draws no bar.

    Parameters
    ----------
    names : sequence of str
        Of A aspects.
    profiles : mapping of str to (A,) array [1]
        Shares by rule or experiment.
    title : str, optional
    ax : matplotlib.axes.Axes, optional
        The user's own.

    Returns
    -------
    matplotlib.figure.Figure
    """
    width = float(np.clip(len(names) * (len(profiles) + 1.0) * 0.34 + 1.0, NARROW_IN, WIDE_IN))
    room = (width - 1.0) / (len(names) * (len(profiles) + 1.0))  # [in] of paper that a bar has
    figure, axes = style.chart(width, 3.4, ax=ax, title=title, **PROBABILITIES)
    places, wide, highest = np.arange(len(names)), 1.0 / (len(profiles) + 1.0), 0.0
    for place, (name, values) in enumerate(profiles.items()):
        label, colour = style.method(name, place)
        percent = 100.0 * np.nan_to_num(np.asarray(values, dtype=float))
        highest = max(highest, percent.max())
        x = places + (place - 0.5 * (len(profiles) - 1)) * wide
        axes.bar(x, percent, 0.9 * wide, color=colour, label=label)
        style.numbers(axes, x, percent, 100.0 * np.asarray(values, dtype=float), room < 0.31)
    style.named_ticks(axes, places, names)
    reach = max(0.5 * len(names), 1.0) + 0.5 * wide
    axes.set(xlim=(places.mean() - reach, places.mean() + reach), ylim=(0.0, highest * 1.14))
    style.legend(figure, ax=ax, ncols=min(len(profiles), 6))
    return figure


def answer_bars(
    names: Sequence[str],
    answer: Floats,
    profiles: Mapping[str, Floats],
    title: str = "",
    ax: "style.Axes | None" = None,
) -> "style.Figure":
    """Draw the recommended answer with its interval as a bar, and every rule as a small mark beside it.

    Parameters
    ----------
    names : sequence of str
        Of A aspects.
    answer : (3, A) array [1]
        The probability of each aspect, and the ends of its interval.
    profiles : mapping of str to (A,) array [1]
        Probabilities by rule.
    title : str, optional
    ax : matplotlib.axes.Axes, optional
        The user's own.

    Returns
    -------
    matplotlib.figure.Figure
    """
    width = float(np.clip(len(names) + 1.0, NARROW_IN, WIDE_IN))
    figure, axes = style.chart(width, 3.4, ax=ax, title=title, **PROBABILITIES)
    places, (share, low, high) = np.arange(len(names)), 100.0 * np.asarray(answer, dtype=float)
    bars = axes.bar(places - 0.22, share, 0.3, color=style.ANSWER, label="recommended, with interval")
    reach = np.maximum([share - low, high - share], 0.0)
    axes.errorbar(places - 0.22, share, reach, fmt="none", ecolor=style.INK, elinewidth=1.4, capsize=3)
    style.numbers(axes, places - 0.22, np.maximum(share, high), share, fontweight="bold")
    handles, highest = [bars], [high]
    for place, (step, (name, values)) in enumerate(
        zip(np.linspace(0.0, 0.36, len(profiles)), profiles.items())
    ):
        label, colour = style.method(name, place)
        look = {"marker": MARKS[place % len(MARKS)], "markersize": 4.2, "linestyle": "none", "color": colour}
        highest.append(100.0 * np.asarray(values))
        handles += axes.plot(places + step, highest[-1], label=label, **look)
    style.named_ticks(axes, places, names)
    axes.set_xlim(-0.55, len(names) - 0.45)
    axes.set_ylim(0.0, 1.12 * np.nanmax(highest))
    style.legend(figure, ax=ax, handles=handles, ncols=5 if width >= 6.0 else 3, fontsize=7.5)
    return figure


MOST_ACROSS = 4  # panels in a row
PANEL_PX, SINGLE_PANEL_PX = 400, 720  # [px] width of one panel, and of one that is alone
LINE_PX, SMALL_LINE_PX = 24, 17  # [px] of text, and of the rules' smaller text
BAR_PX, BARS_PX = 94, 140  # [px] length of a bar for a probability of 1, and where it starts


def aspect_views(
    part: Part, aspects: Aspects, rows: Sequence[int], answer: Recommended | None = None
) -> "style.Figure":
    """Draw a part on some of its aspects.

    Parameters
    ----------
    part : Part
        From a mesh.
    aspects : Aspects
    rows : sequence of int
        Of those that are drawn, in this order.
    answer : Recommended, optional
        Stands first below each, with its interval.

    Returns
    -------
    matplotlib.figure.Figure
    """
    solid, count = shading.Rays(part.vertices, part.faces, part.centre_of_mass), len(rows)
    points = shading.outer_points(solid.points)
    stances = [
        shading.stance(points, aspects.normals[row], aspects.heights[row] / solid.size) for row in rows
    ]
    # the edge of one pixel [size], the same in every panel, with room about the largest part in it
    columns = count if count <= MOST_ACROSS else 3 if count in (5, 6, 9) else MOST_ACROSS
    wide, tall = 1.1 * np.max([np.ptp(standing.shadow_box, axis=0) for standing in stances], axis=0)
    width = PANEL_PX if count > 1 else SINGLE_PANEL_PX
    pixel = max(wide / width, tall / (1.15 * PANEL_PX))
    height = max(int(np.ceil(tall / pixel)), PANEL_PX // 3)
    caption = LINE_PX * (2 + (answer is not None)) + SMALL_LINE_PX * len(aspects.probabilities)
    sheet = style.Panels(columns, width, [height] * -(-count // columns), caption, head=92, foot=76)
    # head: name, material, mass and a scale bar
    (width, height), colour = sheet.page, style.ACCENT if part.open_surface else style.INK
    figure, page = style.sheet(width, height)
    longest = (width - 200) // 22  # letters beside the scale bar
    name = part.name if len(part.name) <= longest else f"{part.name[: longest - 3]}..."
    page.text(30, height - 34, name, fontsize=13, fontweight="bold", color=style.INK, va="center")
    facts = f"{part.material}, {1e3 * part.mass:.4g} g" + ", open surface" * part.open_surface
    page.text(30, height - 66, facts, fontsize=8, color=colour, va="center")
    shading.scale_bar(page, width - 30, height - 66, pixel * solid.size)
    for panel, (row, standing) in enumerate(zip(rows, stances)):
        # the part in the middle of its panel
        place = sheet.place(panel)
        (x, y, width, height) = place
        left, bottom = 0.5 * np.sum(standing.shadow_box, axis=0) - 0.5 * pixel * np.array([width, height])
        frame = shading.Shot(left, bottom, pixel, width, height)
        colour = shading.STEEL_COLOUR if aspects.stable[row] else shading.PALE_COLOUR
        axes = style.inset(figure, page, place)
        axes.set_axis_off()
        image = shading.picture(solid, standing, frame, colour)
        axes.imshow(image, extent=frame.extent, interpolation="nearest")
        shading.contact(axes, solid, standing, aspects.polygons[row] / solid.size)
        shading.rolling_axis(axes, solid, standing, aspects.axes[row])
        shading.centre_of_mass(axes, 11.0 * pixel)
        below = style.inset(figure, page, (x, y - caption, width, caption))
        below.set_axis_off()
        below.set(xlim=(0, width), ylim=(-caption, 0))
        _caption(below, aspects, row, answer)
    shading.marks_legend(page, 30, 30, rolling=bool(np.isfinite(aspects.axes[list(rows)]).any()))
    return figure


def _caption(axes: "style.Axes", aspects: Aspects, row: int, answer: Recommended | None) -> None:
    """Name, count, lying of a class; the recommended answer with its interval, then every rule, smaller."""
    what = f"{aspects.lies[row]} ×{aspects.faces[row]}" if aspects.stable[row] else "not stable"
    look: style.Look = {"color": style.INK, "va": "center"}
    name = axes.text(30, -0.6 * LINE_PX, aspects.names[row], fontsize=11, fontweight="bold", **look)
    after_name: style.Look = {"xycoords": name, "xytext": (6, 0), "textcoords": "offset points"}
    axes.annotate(what, (1.0, 0.5), fontsize=8, **after_name, **look)
    if not aspects.stable[row]:
        return
    y, bars = -1.55 * LINE_PX, list[Any]()  # label, share, height [px], colour, words and their look
    if answer is not None:
        share, low, high = (float(ends[row]) for ends in (answer.p, answer.low, answer.high))
        words = f"{100.0 * share:.0f} % ({100.0 * low:.0f}–{100.0 * high:.0f})"
        bold = {"fontsize": 6.5, "fontweight": "bold"}
        bars.append((y, "recommended", share, 13, style.ANSWER, words, bold))
        y -= LINE_PX
    for place, (rule, values) in enumerate(aspects.probabilities.items()):
        label, colour = style.method(rule, place)
        words, plain = f"{100.0 * values[row]:.1f} %", {"fontsize": 6.0}
        bars.append((y - place * SMALL_LINE_PX, label, values[row], 5, colour, words, plain))
    for y, label, share, height, colour, words, size in bars:
        axes.text(30, y, label, fontsize=6, **look)
        axes.barh(y, BAR_PX, height=height, left=BARS_PX, color=style.FAINT, alpha=0.5)
        axes.barh(y, BAR_PX * share, height=height, left=BARS_PX, color=colour)
        axes.text(370, y, words, ha="right", **look, **size)
    if answer is not None:
        ends = [BARS_PX + BAR_PX * low, BARS_PX + BAR_PX * high]
        axes.plot(ends, [bars[0][0]] * 2, "|-", color=style.INK, linewidth=1.2, markersize=4)


# --- feeder aspects --graph: which aspect tips into which, and by what lift ---


MOST_GRAPH_ASPECTS = 12  # aspects a picture can show
BEND = 0.12  # of an arrow, so that there and back lie apart
LIFT_SPOTS = (  # of the way: where the lift may be written, the first that is free
    0.3,
    0.27,
    0.33,
    0.24,
    0.36,
    0.21,
    0.39,
    0.42,
    0.45,
    0.48,
    0.54,
    0.6,
    0.66,
    0.72,
)
LETTER_SIZE = (0.041, 0.109)  # width and height of one, over the ring's radius
HALF_DISC = 0.22  # over the ring's radius
EQUAL_LIFT = 1.001  # of the lowest lift out of a disc, up to which another is as easy
RING_REACH = 1.45  # of the picture, where the ring of discs has radius 1


def tipping_graph(
    title: str,
    names: Sequence[str],
    tips: Sequence[Transition],
    shares: Floats,
    draw_aspect: Callable[[int], Array] | None = None,
) -> "style.Figure":
    """Draw the aspects on a ring, joined by arrows that carry the lift in mm.

    Parameters
    ----------
    title : str
    names : sequence of str
        Of A aspects.
    tips : sequence of Transition
    shares : (A,) array [1]
        Quasi-static probabilities: an aspect where it is NaN is left out.
    draw_aspect : callable, optional
        Returns the picture (H, W, C) of an aspect by its row; without it a disc stands for each aspect, whose
        area grows with its share.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure = style.figure(6.4, 6.4)
    axes, head = figure.add_subplot(), f"{title}: lift to tip [mm]"
    axes.text(-RING_REACH, RING_REACH, head, ha="left", va="top", fontsize=10, color=style.INK)
    visible = [k for k in range(len(names)) if np.isfinite(shares[k])][:MOST_GRAPH_ASPECTS]
    turn = np.pi / 2 - 2.0 * np.pi * np.arange(len(visible)) / max(len(visible), 1)
    places = {k: np.array([np.cos(a), np.sin(a)]) for k, a in zip(visible, turn)}
    sizes = 500.0 + 2500.0 * np.nan_to_num(shares)  # [pt2] squares about the discs
    sizes = sizes if draw_aspect is None else np.full(len(names), 4200.0)
    _arrows(axes, tips, places, sizes, names)
    for k, place in places.items():
        edge = style.INK if draw_aspect is None else style.FAINT
        axes.scatter(*place, s=sizes[k], color="white", edgecolor=edge, zorder=3)
        look = {"ha": "center", "color": style.INK}
        if draw_aspect is None:  # a letter within its disc, a longer name across it
            letter = len(names[k]) <= 2
            box = {} if letter else {"bbox": {"facecolor": "white", "edgecolor": "none", "pad": 1.0}}
            axes.annotate(names[k], place, va="center", fontsize=11 if letter else 9, zorder=4, **look, **box)
        else:  # the part as it rests on the aspect, name and share below
            image = draw_aspect(k)
            half = 0.15 * np.array([1.0, image.shape[0] / image.shape[1]])
            (left, low), (right, high) = place - half + [0.0, 0.03], place + half + [0.0, 0.03]
            axes.imshow(image, extent=(left, right, low, high), zorder=4, interpolation="antialiased")
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


def draw_tipping_graph(study: AspectsStudy, tips: Sequence[Transition], shares: Floats) -> "style.Figure":
    """Draw the tipping graph with the part in each aspect, where it has a shape.

    Parameters
    ----------
    study : AspectsStudy
    tips : sequence of Transition
    shares : (A,) array [1]
        As for ``tipping_graph``.

    Returns
    -------
    matplotlib.figure.Figure
    """
    part, aspects = study.part, study.aspects
    if part.vertices is None:
        return tipping_graph(part.name, aspects.names, tips, shares)
    solid = shading.Rays(part.vertices, part.faces, part.centre_of_mass)
    draw_aspect = partial(shading.thumbnail, solid, aspects, size=(160, 120))
    return tipping_graph(part.name, aspects.names, tips, shares, draw_aspect)


def _arrows(
    axes: "style.Axes",
    tips: Sequence[Transition],
    places: Mapping[int, Vector],
    sizes: Floats,
    names: Sequence[str],
) -> None:
    """The easiest way between every two discs that are shown, bent to leave room for the way back.

    The easiest out of each disc stands out. A lift is written where it covers the least.
    """
    lowest: dict[int, float] = {}
    lifts: dict[tuple[int, int], float] = {}
    for tip in tips:
        lowest[tip.start] = min(tip.lift, lowest.get(tip.start, np.inf))
        pair = (tip.start, tip.end)
        if set(pair) <= set(places) and tip.lift < lifts.get(pair, np.inf):
            lifts[pair] = tip.lift
    # boxes of discs and labels: middle, half width, half height
    boxes = [(*place, max(HALF_DISC, _half(names[k])[0]), HALF_DISC) for k, place in places.items()]
    curves = {pair: _curve(places[pair[0]], places[pair[1]], np.linspace(0.0, 1.0, 60)) for pair in lifts}
    bent = {"connectionstyle": f"arc3,rad={BEND}", "arrowstyle": "-|>,head_length=0.5,head_width=0.22"}
    box = {"facecolor": "white", "edgecolor": "none", "pad": 0.8}
    look: style.Look = {"ha": "center", "va": "center", "fontsize": 9, "zorder": 5, "bbox": box}
    for pair, lift in sorted(lifts.items(), key=lambda item: -item[1]):  # the easy ones on top
        start, end = (places[k] for k in pair)
        easiest, text = lift <= EQUAL_LIFT * lowest[pair[0]], f"{lift / MM:.3g}"
        half, spot = np.array(_half(text)), 1.32 * start
        if not np.allclose(start, end):
            shrunk = {f"shrink{e}": 0.5 * np.sqrt(sizes[k]) + 4.0 for e, k in zip("AB", pair)}
            line = {"color": style.ACCENT if easiest else "#9ba3aa", "linewidth": 1.1}
            ends, arrow = (tuple(end), tuple(start)), {**bent, **shrunk, **line}
            axes.annotate("", *ends, arrowprops=arrow, zorder=2 if easiest else 1)
            # area of discs and labels that are covered, and points of other arrows
            crossed = np.vstack([np.zeros((0, 2)), *(curve for key, curve in curves.items() if key != pair)])
            spots, covers = _curve(start, end, np.array(LIFT_SPOTS)), []
            for place in spots:
                sides = [
                    [max(half[k] + near[k + 2] - abs(place[k] - near[k]), 0.0) for k in (0, 1)]
                    for near in boxes
                ]
                under = (np.abs(crossed - place) < half).all(axis=1).sum()
                covers.append(sum(wide * high for wide, high in sides) + 2e-3 * under)
            spot = spots[int(np.argmin(covers))]
        axes.annotate(text, tuple(spot), color=style.ACCENT if easiest else style.INK, **look)
        boxes.append((*spot, *half))


def _curve(start: Vector, end: Vector, shares: Floats) -> Points:
    """The points (K, 2) of a bent arrow at shares (K,) of its way."""
    along = end - start
    offset = np.array([along[1], -along[0]]) * BEND  # of the middle control point of the arc
    return start + shares[:, None] * along + 2.0 * (shares * (1.0 - shares))[:, None] * offset


def _half(text: str) -> tuple[float, float]:
    return 0.5 * LETTER_SIZE[0] * len(text), 0.5 * LETTER_SIZE[1]


ASPECTS_VIEW = RecordView(lambda study: f"{study.part.name} {aspects_text(study.aspects)}", offers, "aspects")
