"""Pictures of tooling: each orientation at the worst place of each device, and what isolates each."""

import textwrap
from collections.abc import Collection, Sequence
from typing import Any

import numpy as np
import shapely
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import PathPatch, Polygon
from matplotlib.path import Path
from shapely import affinity

from feederscrew.base.arrays import Floats
from feederscrew.base.units import MM
from feederscrew.bowl.devices.base import Device, Verdict
from feederscrew.bowl.devices.trade import Action
from feederscrew.designing import texts
from feederscrew.output import style
from feederscrew.sorting import device_passages
from feederscrew.sorting.device_passages import Passage
from feederscrew.sorting.isolating.chain import LEAST_SHARE  # what comes less often has no row
from feederscrew.sorting.orientations import Hanging, Orientation
from feederscrew.sorting.tooling import ToolingStudy

LIMITS_PAGE_WIDTH_PX = 1200  # pixels
# pixels
FATE_COLUMN_PX = 230
DEVICE_COLUMN_PX = 300
ROW = 170
PAGE_HEAD_PX = 134
PAGE_FOOT_PX = 30
OUT = 210
PASSED_COLOUR, REJECTED_COLOUR = "#0072b2", "#d55e00"
TRACK_FACE = "#e3e8ec"
PART_FACE = "#9fb3c4"
TOUCHING = "#56697a"
MAX_ROWS_OF_ONE_PANEL, MAX_TWO_PANELS_PX = 9, 2200  # more rows: two panels, if no wider [px]
TEXT_LINE_PX = 17  # pixels between lines of text
HEAD_LETTER_PX = 9.8  # [px] of a letter in the bold head of a column
READING_NOTES = (
    "from above: wall below, parts move to the right",
    "light: part, dark: what touches the track, outline: hull of the support, dot: weight",
)
LAST_COLUMN_LETTERS = 38  # of a line of text in the last column
Box = tuple[float, float, float, float]  # [px] left, top, width, height, from the upper left corner
RAIL_FACE, RAIL_DEPTH_MM = "#c3ccd4", 2.0  # [mm] of a rail as drawn


def chain(
    devices: Sequence[Device],
    orientations: Sequence[Orientation],
    shares: Floats,
    wanted_row: int | None = None,
    left_in_trial: Collection[str] = (),
) -> Figure:
    """Draw each orientation at the worst place of each device that it meets, the one wanted first.

    What left in a trial is drawn as what leaves, with what the static rule says of it.

    Parameters
    ----------
    devices : sequence of Device
        In the order parts meet them.
    orientations : sequence of Orientation
        M of them.
    shares : (M,) float [1]
        In which they come.
    wanted_row : int, optional
    left_in_trial : collection of str
        Names of orientations of which a part left in a trial.

    Returns
    -------
    matplotlib.figure.Figure
    """
    placed = [device for device in devices if device.action.has_place]
    rows, count = _rows(orientations, shares, wanted_row), max(len(placed), 1)
    room = min(max(DEVICE_COLUMN_PX, (LIMITS_PAGE_WIDTH_PX - FATE_COLUMN_PX) / count), 420)
    wide = max(900, FATE_COLUMN_PX + room * len(placed) + OUT)  # the lines over the rows need 900
    panels = 2 if len(rows) > MAX_ROWS_OF_ONE_PANEL and 2 * wide <= MAX_TWO_PANELS_PX else 1
    high = -(-len(rows) // panels)
    column = (wide - FATE_COLUMN_PX - OUT) / count
    heads = [_device_head(place, device, column) for place, device in enumerate(placed, start=1)]
    # more than two lines would run into the notes below the title
    lines = max([0, *map(len, heads)])
    begin = PAGE_HEAD_PX + (TEXT_LINE_PX * (lines - 2) + 6 if lines > 2 else 0)
    page = style.page(panels * wide, begin + ROW * high + PAGE_FOOT_PX)
    title = "Each orientation where each device supports it least"
    if wanted_row is not None:
        title = f"What lets {orientations[wanted_row].name} leave: {title[0].lower()}{title[1:]}"
    _heading(page, title, orientations, rows)
    for panel in range(panels):
        for place, head in enumerate(heads):
            left = panel * wide + FATE_COLUMN_PX + place * column + 8
            for above, text in enumerate(reversed(head)):
                write_text(page, left, begin - 22 - above * TEXT_LINE_PX, text, weight="bold")
        write_text(page, (panel + 1) * wide - OUT + 8, begin - 22, "as it leaves", weight="bold")
    size = _scale(orientations, rows, column)
    _draw_scale_bar(page, panels * wide - 16, 66, size)  # below the title, which may be as long
    for place, k in enumerate(rows):
        panel, line = divmod(place, high)
        left, top = panel * wide, begin + line * ROW
        orientation = orientations[k]
        passages = device_passages.until_returned(placed, orientation, orientations)
        if panel == 0:
            _draw_rule(page, top)
        # what becomes of it, at the left of its row
        through = all(passage.verdict.passes > 0.0 for passage in passages)
        if through:
            word = device_passages.passage_fate(orientation, passages)
            if orientation.returned and (other := _would_return(placed, orientation, orientations)):
                word = f"{word}; else returned by {other.kind}"
        else:
            word = f"{passages[-1].fate} by {passages[-1].device.kind}"
        last = passages[-1].after if passages else orientation
        leaves = through and not last.returned
        if not leaves and orientation.name in left_in_trial:
            leaves, word = True, left_words(word)
        colour = PASSED_COLOUR if leaves else REJECTED_COLOUR
        write_text(page, left + 16, top + 30, orientation.name, size=12, weight="bold", colour=colour)
        write_text(page, left + 16, top + 52, f"{100.0 * shares[k]:.3g} % of the parts")
        texts: list[tuple[str, style.Look]] = [(text, {"colour": colour}) for text in textwrap.wrap(word, 24)]
        texts += [("wanted", {"weight": "bold"})] if k == wanted_row else []
        for below, (text, look) in enumerate(texts, start=1):
            write_text(page, left + 16, top + 52 + below * TEXT_LINE_PX, text, **look)
        for step, passage in enumerate(passages):
            cell = left + FATE_COLUMN_PX + step * column, top, column, ROW
            _cell(page, cell, passage, size, leaves=leaves)
        if passages and through:
            box = left + wide - OUT + 8, top + 8, OUT - 24, ROW - 38
            _draw_leaving(page, box, passages[-1].after, size, PASSED_COLOUR)
        if orientation.returned:  # by the bare track
            cell = left + FATE_COLUMN_PX, top, column, ROW
            _draw_from_above(_axes(page, cell, size, True), orientation, None, None, colour)
            write_text(page, cell[0] + 8, top + ROW - 12, "before it meets a device", colour=colour)
    return page


def _device_head(number: int, device: Device, column: float) -> list[str]:
    """The lines of the head of a device's column, which is so many pixels wide."""
    value = f" {device.text}" if np.isfinite(device.limit) else ""
    value += " {:.4g} to {:.4g} mm".format(*np.divide(device.span, MM)) if device.span else ""
    value += f" {device.like[2] / MM:.3g} mm" if device.like else ""
    return textwrap.wrap(f"{number}  {device.kind}{value}", int((column - 16) / HEAD_LETTER_PX))


def left_words(rule: str) -> str:
    """Return what is said of an orientation that left in a trial and not by the static rule.

    Parameters
    ----------
    rule : str
        What becomes of it by the rule: 'stopped by wiper'.

    Returns
    -------
    str
    """
    return f"leaves in the trial (by the rule {rule})"


def _would_return(
    devices: Sequence[Device], orientation: Orientation, orientations: Sequence[Orientation]
) -> Device | None:
    """The first device that returns an orientation, should the bare track carry it after all."""
    passages = (device_passages.worst_passage(device, orientation, orientations) for device in devices)
    return next((passage.device for passage in passages if passage.verdict.passes <= 0.0), None)


def limits(study: ToolingStudy, words: str) -> Figure:
    """Draw every orientation of a study with its limits and what isolates it.

    Parameters
    ----------
    study : ToolingStudy
    words : str
        The title.

    Returns
    -------
    matplotlib.figure.Figure
    """
    orientations, shares = study.orientations, study.shares
    rows = _rows(orientations, shares, None)
    page = style.page(LIMITS_PAGE_WIDTH_PX, PAGE_HEAD_PX + ROW * len(rows) + PAGE_FOOT_PX)
    _heading(page, words, orientations, rows)
    second = FATE_COLUMN_PX + DEVICE_COLUMN_PX
    heads = (FATE_COLUMN_PX + 8, "from above"), (second + 8, "along the track"), (830, "isolated by")
    for left, text in heads:
        write_text(page, left, PAGE_HEAD_PX - 22, text, weight="bold")
    size = _scale(orientations, rows, DEVICE_COLUMN_PX)
    for place, k in enumerate(rows):
        top, orientation = PAGE_HEAD_PX + place * ROW, orientations[k]
        _draw_rule(page, top)
        # share and limits at the left of the row
        write_text(page, 16, top + 24, orientation.name, size=12, weight="bold")
        narrowed = f"{orientation.balcony / MM:.2f} mm" if np.isfinite(orientation.balcony) else "none"
        for line, (name, value) in enumerate(
            (
                ("of the parts", f"{100.0 * shares[k]:.3g} %"),
                ("narrowed to", narrowed),
                ("canyon up to", f"{orientation.canyon / MM:.2f} mm"),
                ("gap up to", f"{orientation.gap / MM:.2f} mm"),
                ("height", f"{orientation.height / MM:.2f} mm"),
            )
        ):
            write_text(page, 16, top + 50 + line * TEXT_LINE_PX, name)
            write_text(page, 138, top + 50 + line * TEXT_LINE_PX, value)
        colour = PASSED_COLOUR if study.isolates(k) else REJECTED_COLOUR
        colour = style.INK if study.designs[k] is None else colour
        cell = top, DEVICE_COLUMN_PX, ROW
        _draw_from_above(_axes(page, (FATE_COLUMN_PX, *cell), size, True), orientation, None, None, colour)
        _draw_ahead(_axes(page, (second, *cell), size, False), orientation, None, colour)
        # what isolates it, or why nothing does: the trial's word first
        design, tried = study.designs[k], study.trial_of(k)
        if design is None:
            lines = ["not searched: stopped before" if study.partial else "not asked for"]
        elif study.isolates(k):
            named = " and ".join(cut.device.kind for cut in design.cuts) or "no device"
            leave = 100.0 * (design.least if tried is None else tried.efficiency)
            margin = f"margin {design.margin / MM:.2f} mm" if np.isfinite(design.margin) else ""
            lines = [*textwrap.wrap(named, LAST_COLUMN_LETTERS), f"{leave:.3g} % of the parts leave", margin]
        else:
            reasons = (*(() if tried is None else texts.fault_texts(tried.faults)), *design.reasons)
            why = textwrap.shorten("; ".join(reasons), 4 * LAST_COLUMN_LETTERS, placeholder=" ...")
            lines = ["not isolated", *textwrap.wrap(why, LAST_COLUMN_LETTERS)]
        for line, text in enumerate(lines):
            write_text(page, 830, top + 30 + line * TEXT_LINE_PX, text, colour=colour)
    return page


def _cell(page: Figure, box: Box, passage: Passage, size: float, *, leaves: bool) -> None:
    """An orientation at a device; ``leaves`` where a trial let it through, whatever the rule says."""
    good = passage.verdict.passes > 0.0
    colour = PASSED_COLOUR if good or leaves else REJECTED_COLOUR
    axes = _axes(page, box, size, passage.picture == "above")
    word = "hangs" if passage.verdict.hangs else "passes" if good else f"is {passage.fate}"
    word = f"by the rule {word}" if leaves and not good else word
    words = turned_words(passage) if passage.verdict.onto else f"{word}, {margin_words(passage.verdict)}"
    if passage.picture == "turned":
        words = _draw_turned(axes, passage, colour)
    elif passage.picture == "above":
        _draw_from_above(axes, passage.orientation, passage.hole, passage, colour)
    else:
        _draw_ahead(
            axes,
            passage.after if passage.device.action.leans else passage.orientation,
            passage.plate,
            colour,
        )
    write_text(page, box[0] + 8, box[1] + ROW - 12, words, colour=colour)


def _draw_turned(axes: Axes, passage: Passage, colour: str) -> str:
    """The part from the side before a device turns it and after; returned are the words below."""
    turned, sides = passage.after is not passage.orientation, []
    for orientation in (passage.orientation, passage.after):
        x, y, up = np.asarray(orientation.posture.corners).T
        c, s = np.cos(orientation.heading), np.sin(orientation.heading)
        level = s * x + c * y if passage.device.action is Action.ROLL else c * x - s * y
        sides.append(shapely.MultiPoint(np.column_stack([level, up]) / MM).convex_hull)
    before, after = sides
    wide = before.bounds[2] - before.bounds[0]
    face = f"{PART_FACE}b0"
    if turned:
        room = 0.5 * (axes.get_xlim()[1] - wide - (after.bounds[2] - after.bounds[0]))
        after = affinity.translate(after, wide + max(min(room, 12.0), 2.0) - after.bounds[0], 0.0)
        _fill_area(axes, after, face, colour, 4, width=1.8)
    before = affinity.translate(before, -before.bounds[0], 0.0)
    look = ("none", "#4d5b68") if turned else (face, colour)
    _fill_area(axes, before, *look, 5, width=1.2)
    right = (after if turned else before).bounds[2]
    axes.plot([0.0, right], [0.0, 0.0], color=style.INK, lw=1.5, zorder=6)
    share = max(share for _, share in passage.verdict.onto)
    word = f"turns into {passage.after.name}" if turned else "stays as it lies"
    return f"{word}{f', {100.0 * share:.3g} %' if share < 0.9995 else ''}, quasi-static"


def _draw_from_above(
    axes: Axes, orientation: Orientation, hole: shapely.Geometry | None, passage: Passage | None, colour: str
) -> None:
    """The part on the track from above: wall below, moving to the right."""
    right = axes.get_xlim()[1]
    half = min(0.95 * max(orientation.length, orientation.width) / MM, right)
    # the track between the curved wall and its inner edge
    x, radius = np.linspace(-half, half, 41), orientation.track.radius / MM
    wall, inner = radius - np.sqrt(radius**2 - x**2), radius - orientation.track.width / MM
    far = radius - np.sqrt(np.maximum(inner**2 - x**2, 0.0)) if inner > half else np.full(41, 1e3)
    curved = shapely.Polygon(np.vstack([np.column_stack([x, wall]), np.column_stack([x, far])[::-1]]))
    _fill_area(axes, curved if hole is None else curved.difference(in_mm(hole)), TRACK_FACE, "#b8c2cb", 1)
    outline = np.add(orientation.outline, [0.0, orientation.distance]) / MM
    axes.add_patch(Polygon(outline, fc=PART_FACE, ec="#4d5b68", lw=0.9, alpha=0.45, zorder=3))
    touching = in_mm(device_passages.foot_area(orientation))
    if hole is not None:
        _fill_area(axes, in_mm(hole).intersection(curved), "none", style.INK, 6, width=0.8)
    left_over = touching if hole is None else touching.difference(in_mm(hole))
    _fill_area(axes, left_over, TOUCHING, TOUCHING, 4)
    bearing = left_over if passage is None else shapely.MultiPoint(passage.supported / MM)
    _fill_area(axes, bearing.convex_hull, "none", colour, 5, width=1.8)
    weight = 0.0, (orientation.distance - orientation.shift) / MM
    axes.plot(*weight, "o", ms=5.5, color=colour, mec="white", mew=0.8, zorder=7)


def _draw_ahead(axes: Axes, orientation: Orientation, plate: shapely.Geometry | None, colour: str) -> None:
    """The part seen along the track, the wall at the left, at the plate of a blade or gate."""
    top = axes.get_ylim()[1]
    long = max(orientation.length, orientation.width)
    right = min(axes.get_xlim()[1], orientation.track.width / MM, 1.5 * long / MM)
    if plate is not None:
        seen = in_mm(plate).intersection(shapely.box(0.0, 0.0, right, top))
        _fill_area(axes, seen, "#c3ccd4", "#8593a0", 2)
    profile, line = _profile_along_track(orientation, top, right)
    axes.plot(*line.T, color=style.INK, lw=1.5, zorder=6)
    _fill_area(axes, profile, f"{PART_FACE}b0", "none", 4)
    _fill_area(axes, profile, "none", colour, 5, width=1.8)


def _axes(page: Figure, box: Box, size: float, middle: bool) -> Axes:
    """Axes [mm] in a box of pixels, ``size`` mm a pixel; X = 0 in its middle or at its left."""
    left, top, width, height = box[0] + 6, box[1] + 8, box[2] - 18, box[3] - 38
    axes = page.add_axes(_share_of_page(page, (left, top, width, height)))
    start = -0.5 * width * size if middle else -4.0 * size
    axes.set(xlim=(start, start + width * size), ylim=(-3.0 * size, (height - 3.0) * size))
    axes.axis("off")
    return axes


def _share_of_page(page: Figure, box: Box) -> tuple[float, float, float, float]:
    """Left, low, width and height over those of a page, of a box of pixels from its upper left corner."""
    left, top, width, height = box
    wide, high = page.get_size_inches() * style.DPI
    return left / wide, 1.0 - (top + height) / high, width / wide, height / high


def _scale(orientations: Sequence[Orientation], rows: Sequence[int], column: float) -> float:
    needed = []
    for orientation in (orientations[k] for k in rows):
        high = 1.2 * max(orientation.width, orientation.height) / (ROW - 38)
        needed.append((1.25 * max(orientation.length, orientation.width) / column, high))
    return max(max(pair) for pair in needed) / MM


def _heading(page: Figure, title: str, orientations: Sequence[Orientation], rows: Sequence[int]) -> None:
    rare = [orientation.name for k, orientation in enumerate(orientations) if k not in rows]
    less = f"without a row, as less than {100.0 * LEAST_SHARE:g} % of the parts come so: {', '.join(rare)}"
    write_text(page, 16, 26, title, size=11, weight="bold")
    for line, text in enumerate([*READING_NOTES, less if rare else ""]):
        write_text(page, 16, 50 + TEXT_LINE_PX * line, text, size=8)


def _rows(orientations: Sequence[Orientation], shares: Floats, wanted_row: int | None) -> list[int]:
    often = [k for k in range(len(orientations)) if shares[k] >= LEAST_SHARE and k != wanted_row]
    often.sort(key=lambda k: -round(float(shares[k]), 9))
    return ([] if wanted_row is None else [wanted_row]) + (often or ([] if wanted_row is not None else [0]))


def _fill_area(
    axes: Axes, area: shapely.Geometry, face: str, edge: str, order: float, width: float = 0.8
) -> None:
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


def in_mm(area: shapely.Geometry) -> shapely.Geometry:
    """Return a shapely geometry [m] in millimetres.

    Parameters
    ----------
    area : shapely.Geometry [m]

    Returns
    -------
    shapely.Geometry [mm]
    """
    return shapely.transform(area, lambda points: points / MM)


def margin_words(verdict: Verdict) -> str:
    """Return the margin of a verdict in words; a device that only sets parts apart has none.

    Parameters
    ----------
    verdict : Verdict

    Returns
    -------
    str
    """
    if np.isnan(verdict.margin):
        return "no margin"
    return f"margin {verdict.margin / MM:+.2f} mm" if verdict.sure else "not sure"


def _draw_rule(page: Figure, top: float) -> None:
    wide, high = page.get_size_inches() * style.DPI
    y = 1.0 - top / high
    page.add_artist(Line2D([16.0 / wide, 1.0 - 16.0 / wide], [y, y], color=style.FAINT, lw=0.8))


def write_text(
    page: Figure,
    x: float,
    y: float,
    text: str,
    *,
    size: float = 9,
    colour: str = style.INK,
    weight: str = "normal",
) -> None:
    """Write a line of text on a page.

    Parameters
    ----------
    page : matplotlib.figure.Figure
    x, y : float [pixel]
        From its upper left corner.
    text : str
    size : float [pt], optional
    colour, weight : str, optional
    """
    wide, high = page.get_size_inches() * style.DPI
    look: style.Look = {"fontsize": 0.82 * size, "color": colour, "fontweight": weight, "va": "center"}
    page.text(x / wide, 1.0 - y / high, text, **look)


def _profile_along_track(orientation: Orientation, top: float, right: float) -> tuple[Any, Any]:
    """Return what is seen of an orientation, and wall and track (K, 2), up to ``top`` and ``right`` [mm]."""
    profile = in_mm(orientation.view_ahead)
    if not orientation.groove:
        return profile, np.array([[0.0, top], [0.0, 0.0], [right, 0.0]])
    angle, lean = orientation.groove, 2.0 * orientation.groove - 0.5 * np.pi
    y, z = np.concatenate([np.asarray(ring) for ring in orientation.silhouette]).T / MM
    shift = -float((y - z * np.tan(lean)).min())  # the other face begins at the wall's foot
    profile = affinity.rotate(affinity.translate(profile, shift), angle, origin=(0.0, 0.0), use_radians=True)
    c, s = np.cos(angle), np.sin(angle)
    left = max(1.0 - profile.bounds[0], 0.0)
    faces = np.array([[-left, left * s / c], [0.0, 0.0], [right * c, right * s]])
    return affinity.translate(profile, left), faces + [left, 0.0]


def turned_words(passage: Passage) -> str:
    """Say what a stretch that leans the track turns an orientation into, where statics tells.

    Parameters
    ----------
    passage : Passage

    Returns
    -------
    str
    """
    if passage.after.name == passage.orientation.name:
        return "may turn, not sure"
    return f"turns into {passage.after.name}, not sure"


def scale_bar_length(size: float) -> float:
    """Return the length of a scale bar, 1, 2 or 5 times a power of ten.

    Parameters
    ----------
    size : float [mm]
        Of a pixel.

    Returns
    -------
    float [mm]
    """
    return style.round_length(120 * size)


def _draw_scale_bar(page: Figure, right: float, y: float, size: float) -> None:
    """Draw a scale bar that ends ``right`` pixels from the left edge, ``y`` from the upper one."""
    wide, high = page.get_size_inches() * style.DPI
    length = scale_bar_length(size)
    left = right - length / size
    ends = [left / wide, right / wide], [1.0 - y / high] * 2
    page.add_artist(Line2D(*ends, color=style.INK, lw=2.0, solid_capstyle="butt"))
    write_text(page, left, y - 10, f"{length:g} mm", size=8)


def _draw_leaving(page: Figure, box: Box, orientation: Orientation, size: float, colour: str) -> None:
    """Draw an orientation as it leaves in a box of pixels, ``size`` mm a pixel or, if need be, more."""
    left, top_px, wide, high = box
    _, below, across, up = (end / MM for end in orientation.view_ahead.bounds)
    low, hangs = min(below, 0.0), isinstance(orientation, Hanging)
    if isinstance(orientation, Hanging):
        across = max(across, *(end / MM for end in orientation.span))
    own = max(size, 1.05 * (across + hangs * RAIL_DEPTH_MM) / wide, 1.05 * (up - low) / high)
    axes = page.add_axes(_share_of_page(page, box))
    begin = min(low, -3.0 * own)
    axes.set(xlim=(-4.0 * own, (wide - 4.0) * own), ylim=(begin - 2.0 * own, begin + (high - 2.0) * own))
    axes.axis("off")
    # the wall at the left, the track below it, rails cut across
    profile, top, right = in_mm(orientation.view_ahead), axes.get_ylim()[1], axes.get_xlim()[1]
    if isinstance(orientation, Hanging):
        first, last = (end / MM for end in orientation.span)
        for begin, end in ((0.0, first), (last, right)):
            _fill_area(axes, shapely.box(begin, -RAIL_DEPTH_MM, end, 0.0), RAIL_FACE, style.INK, 3)
        line = np.array([[0.0, min(profile.bounds[1], -RAIL_DEPTH_MM)], [0.0, top]])
    else:
        profile, line = _profile_along_track(orientation, top, right)
    axes.plot(*line.T, color=style.INK, lw=1.5, zorder=6)
    _fill_area(axes, profile, f"{PART_FACE}b0", colour, 5, width=1.6)
    if own > 1.02 * size:
        _draw_scale_bar(page, left + wide - 4.0, top_px + high + 24.0, own)
