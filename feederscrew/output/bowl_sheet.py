"""The drawing sheet of a bowl: A3, to scale, vector; its dimensions are measured on the solid."""

import io
from dataclasses import replace

import numpy as np
from matplotlib.backends.backend_pdf import FigureCanvasPdf
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.patches import PathPatch
from matplotlib.path import Path as Outline

from feederscrew.output import machine_sheet as sheets
from feederscrew.output import marking, style
from feederscrew.output import solidbowl_views as views
from feederscrew.output.tooling_drawing import EDGES
from feederscrew.solidbowl import facets, lugs
from feederscrew.solidbowl.measuring import measures
from feederscrew.units import MM, PER_MINUTE, factor

SCALES = (1.0, 0.5, 0.4, 0.2, 0.1, 0.05, 0.02)  # ISO 5455, with 1 : 2.5
ROOM = 134.0  # [mm] of paper for the bowl across
HIGH = 56.0  # and upright, in each of two views
TOP, BETWEEN = 276.0, 21.0  # [mm] where the upper of them begins, and from its foot to the lower one
STRIP = 205.0, 26.0  # [mm] of paper for the unrolled track
FRAME = 20.0, 10.0, 410.0, 287.0
LITRE = factor("l", "volume")
CUT = "±0.1"  # [mm] of an edge that parts meet
GENERAL = "ISO 2768-m"
MOST = 12  # rows of a list
LONG = 46  # letters of a line in the title block
NARROW_LETTERS = 38  # letters of its left column
NARROW = 5.0  # [mm] of paper: a cut that has no room for its number
HOLE, PLATE = "#d55e00", "#0072b2"
A3 = 420.0, 297.0  # [mm]
INCH = 25.4  # [mm]
THICK, THIN = 0.5 * 72.0 / INCH, 0.18 * 72.0 / INCH  # [pt] of half a millimetre and of 0.18
LETTERS = 2.5  # [mm] height of letters
POINT = 72.0 / INCH / 0.72  # [pt] of a font whose letters are one millimetre high
ARROW = {"arrowstyle": "<|-|>,head_length=0.28,head_width=0.07", "color": style.INK, "linewidth": THIN,
         "shrinkA": 0, "shrinkB": 0}  # fmt: skip


def pdf(study, tried=None, mark=None):
    """Return the drawing sheet of a bowl as the bytes of a PDF.

    Parameters
    ----------
    study : MachineSheet
        With its order and its solid.
    tried : Verified, optional
        What a trial of the bowl has shown.
    mark : str, optional
        Across the sheet; that of the trial without it.

    Returns
    -------
    bytes
    """
    title = marking.marked_title(f"{study.order.part.name}: bowl", marking.of_trial(tried, mark))
    return draw_sheet(study, tried, mark).pdf(title)


def draw_sheet(study, tried=None, mark=None):
    """Return the drawing sheet of a bowl as a Paper; what falls short bears a mark across it."""
    paper, solid = Paper(), study.solid.with_lugs
    found = measures(study.solid)
    found = replace(found, extent=tuple(float(x) for x in np.ptp(solid.vertices, axis=0)))
    scale = min(_scale(max(found.extent[:2]) / MM, ROOM), _scale(found.height / MM, HIGH))
    paper.box(*FRAME, width=THICK)
    _above(paper, solid, found, scale)
    _section(paper, solid, found, scale)
    _from_outside(paper, solid, found, scale)
    _standing(paper, solid)
    _unrolled(paper, solid)
    _list_cuts(paper, study, (25.0, 84.0))
    _list_parts(paper, study, (246.0, 134.0))
    _list_title(paper, study, found, scale, tried)
    marking.across(paper.figure, marking.of_trial(tried, mark))
    return paper


def _scale(size, room):
    return next((one for one in SCALES if one * size <= room), SCALES[-1])


def named(scale):
    """Return a scale as it is written: 1 : 2.5."""
    return f"1 : {1.0 / scale:g}"


def _placed(pieces, at, scale):
    return np.asarray(pieces) / MM * scale + np.asarray(at)


def _above(paper, solid, found, scale):
    """The bowl from above, with its diameter, the track's width and the bolts."""
    at, plan = np.array([95.0, 207.0]), solid.plan
    looked = views.camera(-90.0, 90.0)
    paper.lines(_placed(views.lines(solid.vertices, solid.faces, looked), at, scale), THIN * 1.6)
    r = 0.5 * found.diameter / MM * scale
    low = at[1] - 0.5 * max(found.extent[:2]) / MM * scale - 6.0
    if plan.stairs is None:
        text = f"Ø{found.diameter / MM:.4g}"
        paper.dimension((at[0] - r, at[1]), (at[0] + r, at[1]), text, (0.0, low - at[1]))
    else:
        _radius(paper, plan, found, at, scale)
    _track_width(paper, plan, found, at, scale)
    circle = np.linspace(0.0, 2.0 * np.pi, 181)
    ring = 0.5 * plan.bolt_circle / MM * scale * np.column_stack([np.cos(circle), np.sin(circle)]) + at
    paper.lines([ring], THIN, linestyles="dashdot")
    text = f"{plan.bolts} x Ø{plan.bolt / MM:.4g} on Ø{plan.bolt_circle / MM:.4g}, and one in the middle"
    paper.text(25.0, 276.5, text, size=2.2)
    paper.lines([[at - [r + 6, 0], at + [r + 6, 0]]], THIN, linestyles="dashdot")
    for side in (-1, 1):
        paper.text(at[0] + side * (r + 5.0), at[1] + 1.2, "A", size=3.0, ha="center", fontweight="bold")
    paper.text(25.0, 281.0, f"from above  {named(scale)}", size=3.0, fontweight="bold")


def _radius(paper, plan, found, at, scale):
    """The radius of a stepped wall where the outlet leaves it, and of the floor."""
    out = np.array([np.cos(plan.turned), np.sin(plan.turned)])
    r = 0.5 * found.diameter / MM
    paper.dimension(at, at + r * scale * out, f"R{r:.4g} at the outlet", (0.0, 0.0), size=2.2)
    lowest = float(plan.way.wall_radius(0.0)) / MM
    paper.text(25.0, 272.5, f"R{lowest:.4g} of the wall where the track begins", size=2.2)


def _track_width(paper, plan, found, at, scale):
    """The width of the track, a quarter turn before the outlet."""
    turn = plan.turned + (1.0 if plan.left else -1.0) * 0.5 * np.pi
    outward, r = np.array([np.cos(turn), np.sin(turn)]), 0.5 * found.diameter / MM * scale
    bank = float(plan.way.bank_at(plan.way.at(-0.5 * np.pi)))
    wide = found.track_width * np.cos(bank) / MM * scale
    paper.lines([[at + outward * (r - wide - 7.0), at + outward * r]])
    text = f"track {found.track_width / MM:.4g}"
    paper.text(*(at + outward * (r - wide - 9.5)), text, size=2.2, ha="center", va="center")


def _section(paper, solid, found, scale):
    """The section A-A."""
    rings = facets.section(facets.placed(solid), 0.0)
    at = np.array([255.0, TOP - solid.vertices[:, 2].max() / MM * scale])
    rings = [_placed(ring, at, scale) for ring in rings]
    paper.hatched(rings)
    low = at[1] + solid.vertices[:, 2].min() / MM * scale
    left = min(ring[:, 0].min() for ring in rings)
    right = max(ring[:, 0].max() for ring in rings)
    paper.dimension(
        (left, low), (left, low + found.height / MM * scale), f"{found.height / MM:.4g}", (-6.0, 0.0)
    )
    foot, text = (right, at[1]), f"{found.outlet_height / MM:.4g}"
    paper.dimension(foot, (right, at[1] + found.outlet_height / MM * scale), text, (6.0, 0.0))
    paper.text(190.0, 281.0, f"A-A  {named(scale)}", size=3.0, fontweight="bold")
    plate = solid.plan.material.plate / MM
    text = f"wall {found.wall / MM:.3g}, floor {found.floor / MM:.3g}, track {plate:.3g}"
    paper.text(at[0], low - 8.0, f"{text}; outlet {found.outlet_height / MM:.4g} over the floor's edge",
               size=2.2, ha="center")  # fmt: skip


def _from_outside(paper, solid, found, scale):
    """The bowl from the side that its outlet leaves to."""
    top = TOP - found.height / MM * scale - BETWEEN
    at = np.array([255.0, top - solid.vertices[:, 2].max() / MM * scale])
    turn = np.degrees(solid.plan.turned) + (-90.0 if solid.plan.left else 90.0)
    looked = views.camera(turn, 0.0)
    drawn = _placed(views.lines(solid.vertices, solid.faces, looked), at, scale)
    paper.lines(drawn, THIN * 1.6)
    low = at[1] + solid.vertices[:, 2].min() / MM * scale
    wide = 0.5 * found.diameter + found.wall
    ends, text = np.array([-wide, wide]) / MM * scale + at[0], f"Ø{2.0 * wide / MM:.4g}"
    if solid.plan.stairs is not None:
        ends = drawn[..., 0].min(), drawn[..., 0].max()
        text = f"{(ends[1] - ends[0]) / scale:.4g}"
    paper.dimension((ends[0], low), (ends[1], low), text, (0.0, -6.0))
    paper.text(190.0, top + 3.0, f"towards the outlet  {named(scale)}", size=3.0, fontweight="bold")


def _standing(paper, solid):
    """The bowl as it stands, not to scale."""
    looked = views.camera(np.degrees(solid.plan.turned) - 125.0, 42.0)
    pieces = views.lines(solid.vertices, solid.faces, looked)
    low, high = pieces.reshape(-1, 2).min(axis=0), pieces.reshape(-1, 2).max(axis=0)
    scale = min(72.0 / (high - low)[0], 80.0 / (high - low)[1])
    paper.lines((pieces - 0.5 * (low + high)) * scale + [371.0, 235.0], THIN)
    paper.text(335.0, 281.0, "not to scale", size=2.2)


def _unrolled(paper, solid):
    """The tooled stretch unrolled, seen from above: the wall below, parts move to the right."""
    plan, stretch = solid.plan, solid.plan.stretch
    if stretch is None:
        paper.text(25.0, 125.0, "no devices on the track", size=2.5)
        return
    scale = min(_scale(stretch.length / MM, STRIP[0]), _scale(plan.width / MM, STRIP[1]))
    at = np.array([27.0, 94.0])

    length, wide = stretch.length / MM * scale, plan.width / MM * scale
    _draw_stretch(paper, plan, at, scale)
    paper.dimension(at, at + [length, 0.0], f"{stretch.length / MM:.4g}", (0.0, -6.5), size=2.2)
    text = f"{plan.width / MM:.4g}"
    paper.dimension(at + [length, 0.0], at + [length, wide], text, (6.0, 0.0), size=2.2)
    head = f"track unrolled  {named(scale)}: wall below, parts move to the right; its end lies "
    behind = (plan.way.end - plan.first - stretch.length) / MM
    paper.text(25.0, 127.0, f"{head}{behind:.4g} mm before the outlet", size=2.5, fontweight="bold")


def _list_cuts(paper, study, at):
    """Draw the table of cuts and blades at its upper left corner [mm]."""
    stretch, plan = study.solid.plan.stretch, study.solid.plan
    rows = [["no.", "device", "from [mm]", "to [mm]", "tolerance [mm]"]]
    for _, words, start, end in number_devices(stretch):
        far = f"{end / MM:.5g}" if np.isfinite(end) else "outlet, open"
        rows.append([str(len(rows)), words, f"{start / MM:.5g}", far, CUT])
    left = len(rows) - MOST
    rows = rows if left <= 0 else [*rows[: MOST - 1], ["", f"and {left + 1} more in bowl.json", "", "", ""]]
    low = paper.table(*at, [9.0, 90.0, 32.0, 32.0, 32.0], rows)
    listed = [
        f"from and to: along the wall from the begin of the stretch; cuts {CUT}, everything else {GENERAL}",
        f"arcs are facets within {plan.chord / MM:.3g} mm; {EDGES}",
    ]
    for k, line in enumerate(listed):
        paper.text(at[0], low - 4.0 - 3.6 * k, line, size=2.2)


def _list_parts(paper, study, at):
    """Draw the parts list at its upper left corner [mm]."""
    plan, under = study.solid.plan, study.bowl.machine
    leaf = " x ".join(
        f"{side / MM:.3g}" for side in (under.leaf_width, under.leaf_thickness, under.leaf_length)
    )
    rows = [["pos.", "quantity", "what"]]
    rows.append(["1", "1", f"bowl, {plan.material.name}, {study.solid.mass:.4g} kg"])
    weight, angle = study.solid.balance
    rows.append(
        ["2", "1", f"weight to balance it, {1e3 * weight:.3g} g on the wall at {np.degrees(angle):.0f}°"]
    )
    for name, _, _ in study.solid.gates:
        rows.append([str(len(rows)), "1", f"{name.replace('_', ' ')}, in its notch of the wall"])
    cut = study.solid.segments
    if cut is not None and cut.dowels:
        size = f"{cut.dowel / MM:.3g} x {cut.dowel_length / MM:.3g} mm"
        text = f"dowels {size}, between {len(cut.pieces)} segments"
        rows.append([str(len(rows)), str(cut.dowels), text])
    if cut is not None and len(cut.screws):
        text = f"screws ISO 4762 {lugs.NAME} with nuts ISO 4032, in lugs of the segments; floor: dowels"
        rows.append([str(len(rows)), str(len(cut.screws)), text])
    rows.append([str(len(rows)), str(plan.bolts + 1), f"bolts for holes of {plan.bolt / MM:.4g} mm"])
    rows.append([str(len(rows)), f"{under.leaves:.0f}", f"leaves {leaf} mm"])
    rows.append(
        [
            str(len(rows)),
            "1",
            f"coil, force amplitude {study.force:.3g} N, {sheets.supply(study.stroke.frequency)} Hz",
        ]
    )
    peak = study.stroke.peak_to_peak / MM
    share = 100.0 * study.bowl.sizing.controller
    rows.append([str(len(rows)), "1", f"controller, set to {share:.3g} %: {peak:.3g} mm peak to peak"])
    paper.table(*at, [10.0, 18.0, 136.0], rows)


def _list_title(paper, study, found, scale, tried=None):
    """Draw the title block in the lower right corner; of a bowl that was tried as it was tried."""
    left, low, right, high = 246.0, 10.0, 410.0, 78.0
    paper.box(left, low, right, high, 1.2)
    solid, order = study.solid, study.order
    paper.text(left + 2.0, high - 6.0, f"Bowl for {_short(order.part.name)}", size=4.0, fontweight="bold")
    for k, line in enumerate(_not_made(study)):
        paper.text(left, high + 5.4 - 3.2 * k, line, size=1.85, color="#d55e00")
    pairs = _fields(study, solid, found, scale, tried)
    half = (len(pairs) + 1) // 2
    for k, (name, value) in enumerate(pairs):
        x, y = left + 2.0 + 82.0 * (k // half), high - 13.0 - 5.6 * (k % half)
        paper.text(x, y, name, size=1.9, color="#5b6b78")
        paper.text(x + 27.0, y, value, size=2.1)


def _not_made(study):
    """What of its drive the springs do not make, at most two lines."""
    said = sheets.two_axis(study.bowl.drive)
    if said:
        yield said
    if study.mismatch is not None:
        yield f"these springs make {study.mismatch.machine.text}"


def _short(words, letters=LONG):
    return words if len(words) <= letters else f"{words[: letters - 1]}…"


def _fields(study, solid, found, scale, tried):
    """Names and values of the title block."""
    plan, order = solid.plan, study.order
    centre = ", ".join(f"{x / MM:.1f}" for x in solid.centre)
    extent = " x ".join(f"{x / MM:.4g}" for x in found.extent)
    wanted = (
        "all that pass"
        if order.wanted is None
        else f"{order.wanted[0]} at {np.degrees(order.wanted[1]):.3g}°"
    )
    return [
        ("drawing of part", _short(order.part.source.rpartition("/")[2])),
        ("rate asked for", f"{order.target / PER_MINUTE:.4g} a minute"),
        ("orientation", wanted if tried is None else _short(tried.wanted, NARROW_LETTERS)),
        *(
            []
            if tried is None
            else [("rate of its trial", _short(sheets.rate_of_trial(tried), NARROW_LETTERS))]
        ),
        ("part material", sheets.material(order.part)),
        ("fill, hopper", f"{study.fill.mass:.3g} kg, {order.hopper / LITRE:.3g} l"),
        ("drive", f"{study.stroke.frequency:.4g} Hz, {study.stroke.peak_to_peak / MM:.3g} mm"),
        ("vibration angle", sheets.angles(study, phase=False)),
        ("natural frequency", f"{study.springs.natural_frequency:.4g} Hz"),
        ("climb, bank", f"{np.degrees(plan.way.climb):.3g}°, {_banks(plan.way)}"),
        (
            "hand",
            f"{'left' if plan.left else 'right'}: parts climb {'' if plan.left else 'counter-'}clockwise",
        ),
        ("turns", f"{study.turns:.3g}"),
        ("material", f"{plan.material.name}, {plan.material.density:.4g} kg/m³"),
        ("mass, volume", f"{solid.mass:.4g} kg, {solid.with_lugs.volume / MM**3:.6g} mm³"),
        ("inertia about axis", f"{solid.inertia:.4g} kg m²"),
        ("centre of mass", f"{centre} mm"),
        ("size", f"{extent} mm"),
        ("general tolerance", f"{GENERAL}; cuts {CUT} mm"),
        ("scale, sheet", f"1 : {1.0 / scale:g}, A3, sizes in mm"),
        ("drawn by", "feeder bowl" if tried is None else "feeder design, feeder bowl"),
    ]


def _banks(way):
    """'0°', '0° to 12°': the banks of the track, one after the other."""
    return " to ".join(f"{np.degrees(bank):.3g}°" for bank in (way.bank, *(one[2] for one in way.leans)))


def number_devices(stretch):
    """Return what a stretch is made of, in the order of its numbers: (what it is, words, from, to [m]).

    Parameters
    ----------
    stretch : Stretch

    Returns
    -------
    list of (record, str, float, float)
        Nothing is given of a track without devices; a cut open to the outlet ends at infinity.
    """
    if stretch is None:
        return []
    found = [(one, one.label, one.span[0], np.inf if one.hangs else one.span[1]) for one in stretch.cuts]
    found += [(one, one.label, one.start, one.start + one.thickness) for one in stretch.blades]
    for one in stretch.bores:
        words = f"Ø{one.size / MM:.4g} in the wall, {one.height / MM:.4g} over the track: {one.label}"
        found.append((one, words, one.place - 0.5 * one.size, one.place + 0.5 * one.size))
    below = {one.start for one in stretch.ledges}
    for at, drop in stretch.drops:
        if at not in below:
            found.append(((at, drop), f"step {drop / MM:.4g} mm down", at, at))
    for one in stretch.ledges:
        words = (
            f"ledge {one.width / MM:.4g} wide, track {one.drop / MM:.4g} lower; to {one.end / MM:.5g} level"
        )
        found.append((one, words, one.start, one.end + one.ramp))
    for start, end, bank in stretch.leans:
        found.append(((start, end, bank), f"twists to a bank of {np.degrees(bank):.3g}°", start, end))
    for start, end, lean, _ in stretch.grooves:
        words = f"groove: the wall leans back by {np.degrees(lean):.3g}°"
        found.append(((start, end, lean), words, max(start, 0.0), end))
    return found


def _draw_stretch(paper, plan, at, scale):
    """Draw the stretch of a plan at its lower left corner [mm], in a scale: wall below, parts move right."""
    stretch, wide = plan.stretch, plan.width / MM * scale
    length = stretch.length / MM * scale
    paper.box(at[0], at[1], at[0] + length, at[1] + wide, THICK)
    paper.lines([[at + [0.0, -0.8], at + [length, -0.8]]], 3.0 * THICK)
    for number, (one, _, start, end) in enumerate(number_devices(stretch), start=1):
        x = at[0] + np.array([start, min(end, stretch.length)]) / MM * scale
        if hasattr(one, "ring"):
            place, side = _draw_cut(paper, plan, one, at, scale)
        elif hasattr(one, "thickness"):
            x[1] = max(x[1], x[0] + 0.4)
            paper.axes.fill(x[[0, 1, 1, 0]], at[1] + wide * np.array([0.0, 0.0, 1.0, 1.0]), color=PLATE)
            place, side = (x[1] + 0.8, at[1] + 0.5 * wide), "left"
        elif hasattr(one, "height"):
            middle = x.mean()
            paper.lines([[(middle, at[1] - 1.6), (middle, at[1] + 0.25 * wide)]], THIN, linestyles="dashdot")
            place, side = (middle + 0.8, at[1] + 0.25 * wide), "left"
        else:
            place, side = _draw_change(paper, one, x, at, wide, scale)
            place = place if np.isfinite(end) else (x[0] + 0.8, place[1])  # it goes on: within the strip
        paper.text(*place, str(number), size=2.5, ha=side, va="center")


def _draw_cut(paper, plan, cut, at, scale):
    """A hole in the track; where its number stands."""
    ring = cut.ring.copy()
    if cut.hangs:
        ring[ring[:, 0] >= cut.span[1] - 1e-9, 0] = plan.stretch.length
    ring = np.column_stack([ring[:, 0], np.clip(ring[:, 1], 0.0, plan.width)]) / MM * scale + at
    paper.axes.fill(*ring.T, facecolor="white", edgecolor=HOLE, linewidth=THICK)
    if np.ptp(ring[:, 0]) < NARROW:
        return (ring[:, 0].max() + 0.8, ring[:, 1].mean()), "left"
    return ring.mean(axis=0), "center"


def _draw_change(paper, one, x, at, wide, scale):
    """A step, a ledge, or where the bank changes; where its number stands."""
    low, high = at[1], at[1] + wide
    if hasattr(one, "ramp"):
        high, level = low + one.width / MM * scale, at[0] + one.end / MM * scale
        paper.box(x[0], low, x[1], high, THICK)
        paper.lines([[(x[0], low), (x[0], at[1] + wide)], [(level, low), (level, high)]], THICK)
        return (0.5 * (x[0] + level), 0.5 * (low + high)), "center"
    paper.lines([[(place, low), (place, high)] for place in np.unique(x)], THICK, linestyles="dashed")
    return (x[1] + 0.8, low + 0.8 * wide), "left"


class Paper:
    """An A3 sheet; all places in millimetres from its lower left corner."""

    def __init__(self):
        self.figure = Figure(figsize=(A3[0] / INCH, A3[1] / INCH), facecolor="white")
        self.axes = self.figure.add_axes((0, 0, 1, 1))
        self.axes.set(xlim=(0, A3[0]), ylim=(0, A3[1]))
        self.axes.set_axis_off()

    def lines(self, pieces, width=THIN, **look):
        """Draw pieces (N, 2, 2)."""
        self.axes.add_collection(LineCollection(pieces, colors=style.INK, linewidths=width, **look))

    def box(self, left, low, right, high, width=THIN):
        """Draw a rectangle."""
        self.axes.plot([left, right, right, left, left], [low, low, high, high, low],
                       color=style.INK, linewidth=width)  # fmt: skip

    def text(self, x, y, words, size=LETTERS, **look):
        """Write words, one line or several."""
        look = {"ha": "left", "va": "baseline", "color": style.INK} | look
        return self.axes.text(x, y, words.replace("$", r"\$"), fontsize=size * POINT, **look)

    def hatched(self, rings):
        """Draw the cut face of closed outlines, holes among them."""
        corners = np.concatenate([np.vstack([ring, ring[:1]]) for ring in rings])
        codes = np.concatenate(
            [[Outline.MOVETO, *[Outline.LINETO] * (len(ring) - 1), Outline.CLOSEPOLY] for ring in rings]
        )
        face = Outline(corners, codes)
        look = {"facecolor": "#dfe6ec", "edgecolor": style.INK, "linewidth": THICK}
        self.axes.add_patch(PathPatch(face, **look, zorder=3))

    def dimension(self, one, other, text, off=(0.0, 0.0), size=LETTERS):
        """Draw a dimension between two places, its line moved off by a vector, with helping lines."""
        one, other, off = (np.asarray(p, float) for p in (one, other, off))
        self.lines([[p, p + off * (1.0 + 1.5 / max(np.hypot(*off), 1e-9))] for p in (one, other)])
        a, b = one + off, other + off
        self.axes.annotate("", a, b, arrowprops=ARROW)
        along = b - a
        turn = np.degrees(np.arctan2(along[1], along[0]))
        turn = (turn + 90.0) % 180.0 - 90.0
        turn = 90.0 if abs(turn + 90.0) < 1e-6 else turn
        up = np.array([-np.sin(np.radians(turn)), np.cos(np.radians(turn))])
        x, y = 0.5 * (a + b) + 0.8 * up
        self.text(x, y, text, size=size, ha="center", va="bottom", rotation=turn, rotation_mode="anchor")

    def table(self, left, top, widths, rows, size=2.2, line=4.6):
        """Draw a table whose first row is its head; return the height of its lower border."""
        right, low = left + sum(widths), top - line * len(rows)
        borders = [[(left, top - line * k), (right, top - line * k)] for k in range(len(rows) + 1)]
        edges = left + np.concatenate([[0.0], np.cumsum(widths)])
        self.lines([*borders, *([(x, top), (x, low)] for x in edges)])
        for k, row in enumerate(rows):
            for x, words in zip(edges, row):
                weight = "bold" if k == 0 else "normal"
                self.text(x + 1.0, top - line * (k + 1) + 1.2, words, size=size, fontweight=weight)
        return low

    def pdf(self, title):
        """Return the sheet as a PDF without a date."""
        file = io.BytesIO()
        FigureCanvasPdf(self.figure).print_pdf(file, metadata={"Title": title, "CreationDate": None})
        return file.getvalue()
