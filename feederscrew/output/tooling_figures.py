"""Pictures of tooling: each orientation at the worst place of each device, and what isolates each."""

import textwrap
from typing import Any

import numpy as np
import shapely
from matplotlib.lines import Line2D
from matplotlib.patches import PathPatch, Polygon
from matplotlib.path import Path
from shapely import affinity

from feederscrew.output import style, tooling_tables
from feederscrew.tooling import track_sections
from feederscrew.tooling.isolating.proposal import (
    LEAST_SHARE,  # orientations that come less often have no row
)
from feederscrew.tooling.orientations import Hanging
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
SHRINK = 0.82  # of a size in points
BESIDE = 1.0  # [mm] from the left end of what is drawn
SHEET, DEEP = "#c3ccd4", 2.0  # [mm] of a rail as drawn
BAR = 120  # pixels: at most as long is a bar
STEPS = (1.0, 2.0, 5.0)
ALIKE = 1.02  # scales that differ by less are one


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
            write_text(page, left, HEAD - 22, _device(device, place), weight="bold")
        write_text(page, (panel + 1) * wide - OUT + 8, HEAD - 22, "as it leaves", weight="bold")
    size = _scale(every, rows, column)
    draw_scale_bar(page, panels * wide - 16, 66, size)  # below the title, which may be as long
    for place, k in enumerate(rows):
        panel, line = divmod(place, high)
        left, top = panel * wide, HEAD + line * ROW
        found = track_sections.until_returned(shown, every[k], every)
        if panel == 0:
            draw_rule(page, top)
        _told(page, (left + 16, top), every[k], shares[k], found, k == wanted)
        for step, one in enumerate(found):
            _cell(page, (left + LEFT + step * column, top, column, ROW), one, size)
        if found and all(one.verdict.passes > 0.0 for one in found):
            box = left + wide - OUT + 8, top + 8, OUT - 24, ROW - 38
            draw_leaving(page, box, found[-1].after, size, PASSES)
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
    _heading(page, tooling_tables.isolation_words(study), _missing(every, rows, shares))
    for left, text in (
        (LEFT + 8, "from above"),
        (LEFT + COLUMN + 8, "along the track"),
        (830, "isolated by"),
    ):
        write_text(page, left, HEAD - 22, text, weight="bold")
    size = _scale(every, rows, COLUMN)
    for place, k in enumerate(rows):
        top, one, found = HEAD + place * ROW, every[k], study.designs[k]
        draw_rule(page, top)
        _measured(page, top, one, shares[k])
        colour = style.INK if found is None else PASSES if study.isolates(k) else FALLS
        _above(_axes(page, (LEFT, top, COLUMN, ROW), size, True), one, None, None, colour)
        _ahead(_axes(page, (LEFT + COLUMN, top, COLUMN, ROW), size, False), one, None, colour)
        for line, text in enumerate(_isolated(study, k)):
            write_text(page, 830, top + 30 + line * LINE, text, colour=colour)
    return page


def _cell(page, box, found, size) -> None:
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
        write_text(page, box[0] + 8, box[1] + ROW - 12, turned_words(found), colour=colour)
        return
    word = "hangs" if found.verdict.hangs else "passes" if good else f"is {found.fate}"
    write_text(page, box[0] + 8, box[1] + ROW - 12, f"{word}, {margin_words(found.verdict)}", colour=colour)


def _bare(page, box, one, size) -> None:
    """One orientation that the bare track returns: it meets no device."""
    _above(_axes(page, box, size, True), one, None, None, FALLS)
    write_text(page, box[0] + 8, box[1] + ROW - 12, "meets no device", colour=FALLS)


def _turned(page, axes, found, box, colour) -> None:
    """The part before and after a device that may turn it: along a step, across a ledge."""
    along = not found.device.inwards
    turned = found.after is not found.orientation
    one, other = (_side(k, along) for k in (found.orientation, found.after))
    wide = one.bounds[2] - one.bounds[0]
    if turned:
        room = 0.5 * (axes.get_xlim()[1] - wide - (other.bounds[2] - other.bounds[0]))
        other = affinity.translate(other, wide + max(min(room, 12.0), 2.0) - other.bounds[0], 0.0)
        fill_area(axes, other, f"{PART}b0", colour, 4, width=1.8)
    one = affinity.translate(one, -one.bounds[0], 0.0)
    fill_area(axes, one, "none" if turned else f"{PART}b0", "#4d5b68" if turned else colour, 5, width=1.2)
    right = (other if turned else one).bounds[2]
    axes.plot([0.0, right], [0.0, 0.0], color=style.INK, lw=1.5, zorder=6)
    share = max(share for _, share in found.verdict.onto)
    word = f"turns into {found.after.name}" if turned else "stays as it lies"
    word += f", {100.0 * share:.3g} %" if share < 0.9995 else ""
    write_text(page, box[0] + 8, box[1] + ROW - 12, f"{word}, quasi-static", colour=colour)


def _side(one, along):
    """What is seen of an orientation from the side, or along the track [mm], from its own left end."""
    x, y, up = one.posture.corners.T
    turn = one.heading
    level = np.cos(turn) * x - np.sin(turn) * y if along else np.sin(turn) * x + np.cos(turn) * y
    return shapely.MultiPoint(np.column_stack([level, up]) / MM).convex_hull


def _above(axes, one, hole, found, colour) -> None:
    """The part on the track from above: wall below, moving to the right."""
    right = axes.get_xlim()[1]
    half = min(0.95 * max(one.length, one.width) / MM, right)
    track = shapely.box(-half, 0.0, half, one.track.width / MM)
    curved = curved_track(track, one.track.radius / MM)
    fill_area(axes, curved if hole is None else curved.difference(in_mm(hole)), TRACK, "#b8c2cb", 1)
    outline = np.add(one.outline, [0.0, one.distance]) / MM
    axes.add_patch(Polygon(outline, fc=PART, ec="#4d5b68", lw=0.9, alpha=0.45, zorder=3))
    touching = in_mm(track_sections.foot_area(one))
    if hole is not None:
        fill_area(axes, in_mm(hole).intersection(curved), "none", style.INK, 6, width=0.8)
    left_over = touching if hole is None else touching.difference(in_mm(hole))
    fill_area(axes, left_over, TOUCHING, TOUCHING, 4)
    hull = left_over.convex_hull if found is None else shapely.MultiPoint(found.supported / MM).convex_hull
    fill_area(axes, hull, "none", colour, 5, width=1.8)
    weight = 0.0, (one.distance - one.shift) / MM
    axes.plot(*weight, "o", ms=5.5, color=colour, mec="white", mew=0.8, zorder=7)


def _ahead(axes, one, opening, colour) -> None:
    """The part seen along the track, the wall at the left, in the opening of a gate."""
    top = axes.get_ylim()[1]
    right = min(axes.get_xlim()[1], one.track.width / MM, 1.5 * max(one.length, one.width) / MM)
    if opening is not None:
        plate = shapely.box(0.0, 0.0, right, top).difference(in_mm(opening))
        fill_area(axes, plate, "#c3ccd4", "#8593a0", 2)
    shown, line = profile_along_track(one, top, right)
    axes.plot(*line.T, color=style.INK, lw=1.5, zorder=6)
    fill_area(axes, shown, f"{PART}b0", "none", 4)
    fill_area(axes, shown, "none", colour, 5, width=1.8)


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


def _heading(page, title, missing) -> None:
    write_text(page, 16, 26, title, size=11, weight="bold")
    for line, text in enumerate([*KEY, missing]):
        write_text(page, 16, 50 + LINE * line, text, size=8)


def _told(page, at, one, share, found, is_wanted) -> None:
    """What becomes of an orientation, at the left of its row."""
    left, top = at
    if all(passage.verdict.passes > 0.0 for passage in found):
        word = track_sections.passage_fate(one, found)
        colour = PASSES if word.startswith("leaves") else FALLS
    else:
        word, colour = f"{found[-1].fate} by {found[-1].device.name}", FALLS
    write_text(page, left, top + 30, one.name, size=12, weight="bold", colour=colour)
    write_text(page, left, top + 52, f"{100.0 * share:.3g} % of the parts")
    lines = textwrap.wrap(word, NARROW)
    for line, text in enumerate(lines):
        write_text(page, left, top + 52 + (1 + line) * LINE, text, colour=colour)
    if is_wanted:
        write_text(page, left, top + 52 + (1 + len(lines)) * LINE, "wanted", weight="bold")


def _measured(page, top, one, share) -> None:
    """Share and limits of an orientation, at the left of its row."""
    write_text(page, 16, top + 24, one.name, size=12, weight="bold")
    balcony = f"{one.balcony / MM:.2f} mm" if np.isfinite(one.balcony) else "none"
    lines = [
        ("of the parts", f"{100.0 * share:.3g} %"), ("track at least", balcony),
        ("canyon up to", f"{one.canyon / MM:.2f} mm"),
        ("gap up to", f"{one.gap / MM:.2f} mm"), ("height", f"{one.height / MM:.2f} mm"),
    ]  # fmt: skip
    for place, (name, value) in enumerate(lines):
        write_text(page, 16, top + 50 + place * LINE, name)
        write_text(page, 138, top + 50 + place * LINE, value)


def _isolated(study, place) -> list[Any]:
    """Lines on what isolates an orientation, or why nothing does: the trial's word first."""
    found, tried = study.designs[place], study.trial_of(place)
    if found is None:
        return ["not asked for"]
    result = textwrap.wrap(" and ".join(cut.device.name for cut in found.cuts) or "no device", LETTERS)
    if study.isolates(place):
        margin = f"margin {found.margin / MM:.2f} mm" if np.isfinite(found.margin) else ""
        return [
            *result,
            f"{100.0 * tooling_tables.leaving(study, place)['efficiency']:.3g} % of the parts leave",
            margin,
        ]
    reasons = (*(() if tried is None else tried.faults), *found.reasons)
    why = textwrap.shorten("; ".join(reasons), 4 * LETTERS, placeholder=" ...")
    return ["not isolated", *textwrap.wrap(why, LETTERS)]


def _device(device, place) -> str:
    value = f" {device.text}" if np.isfinite(device.limit) else ""
    value += " {:.4g} to {:.4g} mm".format(*np.divide(device.span, MM)) if device.span else ""
    play = f" {device.like[2] / MM:.3g} mm" if device.like else ""
    return f"{place + 1}  {device.name}{value}{play}"


def _rows(every, shares, wanted):
    """The orientations that have a row: the wanted one, then what comes often enough, likeliest first."""
    often = [k for k in range(len(every)) if shares[k] >= LEAST_SHARE and k != wanted]
    often.sort(key=lambda k: -round(float(shares[k]), 9))
    return ([] if wanted is None else [wanted]) + (often or ([] if wanted is not None else [0]))


def _missing(every, rows, shares) -> str:
    left = [every[k].name for k in range(len(every)) if k not in rows]
    if not left:
        return ""
    return f"without a row, as less than {100.0 * LEAST_SHARE:g} % of the parts come so: {', '.join(left)}"


def fill_area(axes, area, face, edge, order, width=0.8) -> None:
    """Draw a shapely geometry [mm]: areas with their holes, lines and points."""
    for part in shapely.get_parts(area):
        if part.geom_type == "Polygon":
            rings = [np.asarray(ring.coords) for ring in (part.exterior, *part.interiors)]
            path = Path.make_compound_path(*(Path(ring, closed=True) for ring in rings))
            axes.add_patch(PathPatch(path, fc=face, ec=edge, lw=width, zorder=order))
        elif part.geom_type == "LineString":
            axes.plot(*np.asarray(part.coords).T, color=edge, lw=2.0, zorder=order)
        elif part.geom_type == "Point":
            axes.plot(part.x, part.y, "s", color=edge, ms=3.0, zorder=order)


def in_mm(area):
    """Return a shapely geometry [m] in millimetres."""
    return shapely.transform(area, lambda points: points / MM)


def margin_words(verdict) -> str:
    """Return the margin of a verdict in words; a device that only sets parts apart has none."""
    if np.isnan(verdict.margin):
        return "no margin"
    return f"margin {verdict.margin / MM:+.2f} mm" if verdict.sure else "not sure"


def draw_rule(page, top) -> None:
    """Draw a line across a page, ``top`` pixels from its upper edge."""
    wide, high = page.get_size_inches() * style.DPI
    y = 1.0 - top / high
    page.add_artist(Line2D([16.0 / wide, 1.0 - 16.0 / wide], [y, y], color=style.FAINT, lw=0.8))


def write_text(page, x, y, text, *, size=9, colour=style.INK, weight="normal") -> None:
    """Write a line of text on a page, in pixels from its upper left corner."""
    wide, high = page.get_size_inches() * style.DPI
    page.text(
        x / wide, 1.0 - y / high, text, fontsize=SHRINK * size, color=colour, fontweight=weight, va="center"
    )


def profile_along_track(one, top, right) -> tuple[Any, ...]:
    """Return what is seen of an orientation [mm], and the line (K, 2) [mm] of wall and track below it.

    Parameters
    ----------
    one : Orientation
    top, right : float [mm]
        How far wall and track are drawn.
    """
    shown = in_mm(one.view_ahead)
    if not one.groove:
        return shown, np.array([[0.0, top], [0.0, 0.0], [right, 0.0]])
    angle, lean = one.groove, 2.0 * one.groove - 0.5 * np.pi
    y, z = np.concatenate([np.asarray(ring) for ring in one.silhouette]).T / MM
    shift = -float((y - z * np.tan(lean)).min())  # the other face begins at the wall's foot
    shown = affinity.rotate(affinity.translate(shown, shift), angle, origin=(0.0, 0.0), use_radians=True)
    c, s = np.cos(angle), np.sin(angle)
    left = max(BESIDE - shown.bounds[0], 0.0)
    faces = np.array([[-left, left * s / c], [0.0, 0.0], [right * c, right * s]])
    return affinity.translate(shown, left), faces + [left, 0.0]


def curved_track(track, radius):
    """Return the track [mm] between the curved wall and its inner edge."""
    left, _, right, high = track.bounds
    x = np.linspace(left, right, 41)
    wall = radius - np.sqrt(radius**2 - x**2)
    inner = radius - high
    far = radius - np.sqrt(np.maximum(inner**2 - x**2, 0.0)) if inner > abs(left) else np.full(41, 1e3)
    return shapely.Polygon(np.vstack([np.column_stack([x, wall]), np.column_stack([x, far])[::-1]]))


def turned_words(found) -> str:
    """Say what a stretch that leans the track turns an orientation into, where statics tells."""
    if found.after.name == found.orientation.name:
        return "may turn, not sure"
    return f"turns into {found.after.name}, not sure"


def scale_bar_length(size):
    """Return the length [mm] of a scale bar, 1, 2 or 5 times a power of ten, at ``size`` mm a pixel."""
    return max(step * 10.0**k for k in range(-3, 5) for step in STEPS if step * 10.0**k <= BAR * size)


def draw_scale_bar(page, right, y, size) -> None:
    """Draw a scale bar that ends ``right`` pixels from the left edge, ``y`` from the upper one."""
    wide, high = page.get_size_inches() * style.DPI
    length = scale_bar_length(size)
    left = right - length / size
    ends = [left / wide, right / wide], [1.0 - y / high] * 2
    page.add_artist(Line2D(*ends, color=style.INK, lw=2.0, solid_capstyle="butt"))
    write_text(page, left, y - 10, f"{length:g} mm", size=8)


def draw_leaving(page, box, one, size, colour) -> None:
    """Draw an orientation as it leaves in a box of pixels, ``size`` mm a pixel or, if need be, more."""
    left, top, wide, high = box
    low, up = min(one.view_ahead.bounds[1], 0.0) / MM, one.view_ahead.bounds[3] / MM
    across = max(one.view_ahead.bounds[2], *one.span) / MM if _hangs(one) else one.view_ahead.bounds[2] / MM
    own = max(size, 1.05 * (across + _hangs(one) * DEEP) / wide, 1.05 * (up - low) / high)
    page_wide, page_high = page.get_size_inches() * style.DPI
    place = left / page_wide, 1.0 - (top + high) / page_high, wide / page_wide, high / page_high
    axes = page.add_axes(place)
    begin = min(low, -3.0 * own)
    axes.set(xlim=(-4.0 * own, (wide - 4.0) * own), ylim=(begin - 2.0 * own, begin + (high - 2.0) * own))
    axes.axis("off")
    draw_along_track(axes, one, colour)
    if own > ALIKE * size:
        draw_scale_bar(page, left + wide - 4.0, top + high + 24.0, own)


def _hangs(one) -> bool:
    return isinstance(one, Hanging)


def draw_along_track(axes, one, colour) -> None:
    """Draw an orientation [mm] as it leaves: the wall at the left, the track below it, rails cut across."""
    shown, (_, top), (_, right) = in_mm(one.view_ahead), axes.get_ylim(), axes.get_xlim()
    if _hangs(one):
        first, last = (end / MM for end in one.span)
        for low, high in ((0.0, first), (last, right)):
            fill_area(axes, shapely.box(low, -DEEP, high, 0.0), SHEET, style.INK, 3)
        axes.plot([0.0, 0.0], [min(shown.bounds[1], -DEEP), top], color=style.INK, lw=1.5, zorder=6)
    else:
        shown, line = profile_along_track(one, top, right)
        axes.plot(*line.T, color=style.INK, lw=1.5, zorder=6)
    fill_area(axes, shown, f"{PART}b0", colour, 5, width=1.6)
