"""Pictures of tooling: each orientation at the worst place of each device, and what isolates each."""

import textwrap

import numpy as np
import shapely
from matplotlib.patches import Polygon
from shapely import affinity

from feederscrew.output import style
from feederscrew.output.tooling import ink, leaving, profile, tables
from feederscrew.tooling import track_sections
from feederscrew.tooling.isolating.proposal import (
    LEAST_SHARE,  # orientations that come less often have no row
)
from feederscrew.units import MM

WIDTH = 1200  # pixels
LEAST = 900  # pixels: room for the lines over the rows
LEFT, COLUMN, ROW, HEAD, FOOT, OUT = 230, 300, 170, 134, 30, 210  # pixels
PASSES, FALLS = "#0072b2", "#d55e00"
TRACK, AIR, PART, TOUCHING = "#e3e8ec", "#ffffff", "#9fb3c4", "#56697a"
WIDEST = 420  # pixels of a column
LONG, BROAD = 9, 2200  # rows from which there are two panels of them, if no more pixels wide than so
LINE = 17  # pixels between lines of text
KEY = (
    "from above: wall below, parts move to the right",
    "light: part, dark: what touches the track, outline: hull of the support, dot: weight",
)
LETTERS = 38  # of a line of text in the last column
NARROW = 24  # the same in the first column


def chain(devices, every, shares, wanted=None):
    """Draw each orientation at the worst place of each device that it meets, a row each.

    Parameters
    ----------
    devices : sequence of Device
        In the order parts meet them.
    every : sequence of Orientation
    shares : (M,) float [1]
    wanted : int, optional
        The orientation that shall leave, drawn first.

    Returns
    -------
    Figure
    """
    shown = [device for device in devices if device.placed]
    rows = _rows(every, shares, wanted)
    wide = LEFT + min(max(COLUMN, (WIDTH - LEFT) / max(len(shown), 1)), WIDEST) * len(shown) + OUT
    wide = max(LEAST, wide)
    panels = 2 if len(rows) > LONG and 2 * wide <= BROAD else 1
    high = -(-len(rows) // panels)
    page = style.page(panels * wide, HEAD + ROW * high + FOOT)
    column = (wide - LEFT - OUT) / max(len(shown), 1)
    title = "Each orientation where each device bears least" if wanted is None else (
        f"What lets {every[wanted].name} leave: each orientation where each device bears least"
    )  # fmt: skip
    _heading(page, title, _missing(every, rows, shares))
    for panel in range(panels):
        for place, device in enumerate(shown):
            left = panel * wide + LEFT + place * column + 8
            ink.text(page, left, HEAD - 22, _device(device, place), weight="bold")
        ink.text(page, (panel + 1) * wide - OUT + 8, HEAD - 22, "as it leaves", weight="bold")
    size = _scale(every, rows, column)
    leaving.bar_on_page(page, panels * wide - 16, 66, size)  # below the title, which may be as long
    for place, k in enumerate(rows):
        panel, line = divmod(place, high)
        left, top = panel * wide, HEAD + line * ROW
        found = track_sections.until_returned(shown, every[k], every)
        if panel == 0:
            ink.rule(page, top)
        _told(page, (left + 16, top), every[k], shares[k], found, k == wanted)
        for step, one in enumerate(found):
            _cell(page, (left + LEFT + step * column, top, column, ROW), one, size)
        if found and all(one.verdict.passes > 0.0 for one in found):
            box = left + wide - OUT + 8, top + 8, OUT - 24, ROW - 38
            leaving.column(page, box, found[-1].after, size, PASSES)
        if every[k].returned:
            _bare(page, (left + LEFT, top, column, ROW), every[k], size)
    return page


def limits(study):
    """Draw every orientation on the track with its limits, and what isolates it, a row each.

    Parameters
    ----------
    study : ToolingStudy

    Returns
    -------
    Figure
    """
    every, shares = study.orientations, study.shares
    rows = _rows(every, shares, None)
    page = style.page(WIDTH, HEAD + ROW * len(rows) + FOOT)
    _heading(page, tables.isolated(study), _missing(every, rows, shares))
    for left, text in (
        (LEFT + 8, "from above"),
        (LEFT + COLUMN + 8, "along the track"),
        (830, "isolated by"),
    ):
        ink.text(page, left, HEAD - 22, text, weight="bold")
    size = _scale(every, rows, COLUMN)
    for place, k in enumerate(rows):
        top, one, found = HEAD + place * ROW, every[k], study.designs[k]
        ink.rule(page, top)
        _measured(page, top, one, shares[k])
        colour = style.INK if found is None else PASSES if study.isolates(k) else FALLS
        _above(_axes(page, (LEFT, top, COLUMN, ROW), size, True), one, None, None, colour)
        _ahead(_axes(page, (LEFT + COLUMN, top, COLUMN, ROW), size, False), one, None, colour)
        for line, text in enumerate(_isolated(study, k)):
            ink.text(page, 830, top + 30 + line * LINE, text, colour=colour)
    return page


def _cell(page, box, found, size):
    """One orientation at one device."""
    good = found.verdict.passes > 0.0
    colour = PASSES if good else FALLS
    axes = _axes(page, box, size, found.picture == "above")
    if found.picture == "turned":
        _turned(page, axes, found, box, colour)
        return
    if found.picture == "above":
        _above(axes, found.orientation, found.hole, found, colour)
    else:
        _ahead(axes, found.after if found.device.leans else found.orientation, found.opening, colour)
    if found.verdict.onto:
        ink.text(page, box[0] + 8, box[1] + ROW - 12, profile.turned_into(found), colour=colour)
        return
    word = "hangs" if found.verdict.hangs else "passes" if good else f"is {found.fate}"
    ink.text(page, box[0] + 8, box[1] + ROW - 12, f"{word}, {ink.margin(found.verdict)}", colour=colour)


def _bare(page, box, one, size):
    """One orientation that the bare track returns: it meets no device."""
    _above(_axes(page, box, size, True), one, None, None, FALLS)
    ink.text(page, box[0] + 8, box[1] + ROW - 12, "meets no device", colour=FALLS)


def _turned(page, axes, found, box, colour):
    """The part before and after a device that may turn it: along a step, across a ledge."""
    along = not found.device.inwards
    turned = found.after is not found.orientation
    one, other = (_side(k, along) for k in (found.orientation, found.after))
    wide = one.bounds[2] - one.bounds[0]
    if turned:
        room = 0.5 * (axes.get_xlim()[1] - wide - (other.bounds[2] - other.bounds[0]))
        other = affinity.translate(other, wide + max(min(room, 12.0), 2.0) - other.bounds[0], 0.0)
        ink.fill(axes, other, f"{PART}b0", colour, 4, width=1.8)
    one = affinity.translate(one, -one.bounds[0], 0.0)
    ink.fill(axes, one, "none" if turned else f"{PART}b0", "#4d5b68" if turned else colour, 5, width=1.2)
    right = (other if turned else one).bounds[2]
    axes.plot([0.0, right], [0.0, 0.0], color=style.INK, lw=1.5, zorder=6)
    share = max(share for _, share in found.verdict.onto)
    word = f"turns into {found.after.name}" if turned else "stays as it lies"
    word += f", {100.0 * share:.3g} %" if share < 0.9995 else ""
    ink.text(page, box[0] + 8, box[1] + ROW - 12, f"{word}, quasi-static", colour=colour)


def _side(one, along):
    """What is seen of an orientation from the side, or along the track [mm], from its own left end."""
    x, y, up = one.posture.corners.T
    turn = one.heading
    level = np.cos(turn) * x - np.sin(turn) * y if along else np.sin(turn) * x + np.cos(turn) * y
    return shapely.MultiPoint(np.column_stack([level, up]) / MM).convex_hull


def _above(axes, one, hole, found, colour):
    """The part on the track from above: wall below, moving to the right."""
    right = axes.get_xlim()[1]
    half = min(0.95 * max(one.length, one.width) / MM, right)
    track = shapely.box(-half, 0.0, half, one.track.width / MM)
    curved = profile.sunk(track, one.track.radius / MM)
    ink.fill(axes, curved if hole is None else curved.difference(ink.mm(hole)), TRACK, "#b8c2cb", 1)
    outline = np.add(one.outline, [0.0, one.distance]) / MM
    axes.add_patch(Polygon(outline, fc=PART, ec="#4d5b68", lw=0.9, alpha=0.45, zorder=3))
    touching = ink.mm(track_sections.foot_area(one))
    if hole is not None:
        ink.fill(axes, ink.mm(hole).intersection(curved), "none", style.INK, 6, width=0.8)
    left_over = touching if hole is None else touching.difference(ink.mm(hole))
    ink.fill(axes, left_over, TOUCHING, TOUCHING, 4)
    hull = left_over.convex_hull if found is None else shapely.MultiPoint(found.supported / MM).convex_hull
    ink.fill(axes, hull, "none", colour, 5, width=1.8)
    weight = 0.0, (one.distance - one.shift) / MM
    axes.plot(*weight, "o", ms=5.5, color=colour, mec="white", mew=0.8, zorder=7)


def _ahead(axes, one, opening, colour):
    """The part seen along the track, the wall at the left, in the opening of a gate."""
    top = axes.get_ylim()[1]
    right = min(axes.get_xlim()[1], one.track.width / MM, 1.5 * max(one.length, one.width) / MM)
    if opening is not None:
        plate = shapely.box(0.0, 0.0, right, top).difference(ink.mm(opening))
        ink.fill(axes, plate, "#c3ccd4", "#8593a0", 2)
    shown, line = profile.along(one, top, right)
    axes.plot(*line.T, color=style.INK, lw=1.5, zorder=6)
    ink.fill(axes, shown, f"{PART}b0", "none", 4)
    ink.fill(axes, shown, "none", colour, 5, width=1.8)


def _axes(page, box, size, middle):
    """Axes [mm] in a box of pixels, ``size`` mm a pixel; X = 0 in its middle or at its left."""
    left, top, width, height = box[0] + 6, box[1] + 8, box[2] - 18, box[3] - 38
    wide, high = page.get_size_inches() * style.DPI
    place = left / wide, 1.0 - (top + height) / high, width / wide, height / high
    axes = page.add_axes(place)
    start = -0.5 * width * size if middle else -4.0 * size
    axes.set(xlim=(start, start + width * size), ylim=(-3.0 * size, (height - 3.0) * size))
    axes.axis("off")
    return axes


def _scale(every, rows, column):
    """Millimetres a pixel at which every row's part fits its cell."""
    needed = [(1.25 * max(one.length, one.width) / column, 1.2 * max(one.width, one.height) / (ROW - 38))
              for one in (every[k] for k in rows)]  # fmt: skip
    return max(max(pair) for pair in needed) / MM


def _heading(page, title, missing):
    ink.text(page, 16, 26, title, size=11, weight="bold")
    for line, text in enumerate([*KEY, missing]):
        ink.text(page, 16, 50 + LINE * line, text, size=8)


def _told(page, at, one, share, found, is_wanted):
    """What becomes of an orientation, at the left of its row."""
    left, top = at
    if all(passage.verdict.passes > 0.0 for passage in found):
        word = track_sections.passage_fate(one, found)
        colour = PASSES if word.startswith("leaves") else FALLS
    else:
        word, colour = f"{found[-1].fate} by {found[-1].device.name}", FALLS
    ink.text(page, left, top + 30, one.name, size=12, weight="bold", colour=colour)
    ink.text(page, left, top + 52, f"{100.0 * share:.3g} % of the parts")
    lines = textwrap.wrap(word, NARROW)
    for line, text in enumerate(lines):
        ink.text(page, left, top + 52 + (1 + line) * LINE, text, colour=colour)
    if is_wanted:
        ink.text(page, left, top + 52 + (1 + len(lines)) * LINE, "wanted", weight="bold")


def _measured(page, top, one, share):
    """Share and limits of an orientation, at the left of its row."""
    ink.text(page, 16, top + 24, one.name, size=12, weight="bold")
    balcony = f"{one.balcony / MM:.2f} mm" if np.isfinite(one.balcony) else "none"
    lines = [
        ("of the parts", f"{100.0 * share:.3g} %"), ("track at least", balcony),
        ("canyon up to", f"{one.canyon / MM:.2f} mm"),
        ("gap up to", f"{one.gap / MM:.2f} mm"), ("height", f"{one.height / MM:.2f} mm"),
    ]  # fmt: skip
    for place, (name, value) in enumerate(lines):
        ink.text(page, 16, top + 50 + place * LINE, name)
        ink.text(page, 138, top + 50 + place * LINE, value)


def _isolated(study, place):
    """Lines on what isolates an orientation, or why nothing does: the trial's word first."""
    found, tried = study.designs[place], study.trial_of(place)
    if found is None:
        return ["not asked for"]
    result = textwrap.wrap(" and ".join(cut.device.name for cut in found.cuts) or "no device", LETTERS)
    if study.isolates(place):
        margin = f"margin {found.margin / MM:.2f} mm" if np.isfinite(found.margin) else ""
        return [
            *result,
            f"{100.0 * tables.leaving(study, place)['efficiency']:.3g} % of the parts leave",
            margin,
        ]
    reasons = (*(() if tried is None else tried.faults), *found.reasons)
    why = textwrap.shorten("; ".join(reasons), 4 * LETTERS, placeholder=" ...")
    return ["not isolated", *textwrap.wrap(why, LETTERS)]


def _device(device, place):
    value = f" {device.text}" if np.isfinite(device.limit) else ""
    value += " {:.4g} to {:.4g} mm".format(*np.divide(device.span, MM)) if device.span else ""
    play = f" {device.like[2] / MM:.3g} mm" if device.like else ""
    return f"{place + 1}  {device.name}{value}{play}"


def _rows(every, shares, wanted):
    """The orientations that have a row: the wanted one, then what comes often enough, likeliest first."""
    often = [k for k in range(len(every)) if shares[k] >= LEAST_SHARE and k != wanted]
    often.sort(key=lambda k: -round(float(shares[k]), 9))
    return ([] if wanted is None else [wanted]) + (often or ([] if wanted is not None else [0]))


def _missing(every, rows, shares):
    left = [every[k].name for k in range(len(every)) if k not in rows]
    if not left:
        return ""
    return f"without a row, as less than {100.0 * LEAST_SHARE:g} % of the parts come so: {', '.join(left)}"
