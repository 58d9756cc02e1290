"""The drawing sheet of a bowl: A3, to scale, vector; its dimensions are measured on the solid."""

from dataclasses import replace

import numpy as np

from feederscrew.output import marking
from feederscrew.output.solidbowl import lists, unrolled_strip, views
from feederscrew.output.solidbowl.paper import THICK, THIN, Paper
from feederscrew.solidbowl import facets
from feederscrew.solidbowl.measuring import measures
from feederscrew.units import MM

SCALES = (1.0, 0.5, 0.4, 0.2, 0.1, 0.05, 0.02)  # ISO 5455, with 1 : 2.5
ROOM = 134.0  # [mm] of paper for the bowl across
HIGH = 56.0  # and upright, in each of two views
TOP, BETWEEN = 276.0, 21.0  # [mm] where the upper of them begins, and from its foot to the lower one
STRIP = 205.0, 26.0  # [mm] of paper for the unrolled track
FRAME = 20.0, 10.0, 410.0, 287.0


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
    return sheet(study, tried, mark).pdf(title)


def sheet(study, tried=None, mark=None):
    """Return the drawing sheet of a bowl as a Paper; what falls short bears a mark across it."""
    paper, solid = Paper(), study.solid.with_lugs
    found = measures(study.solid)
    found = replace(found, extent=tuple(float(x) for x in np.ptp(solid.vertices, axis=0)))
    scale = min(_scale(max(found.extent[:2]) / MM, ROOM), _scale(found.height / MM, HIGH))
    paper.box(*FRAME, width=THICK)
    _above(paper, solid, found, scale)
    _cut(paper, solid, found, scale)
    _from_outside(paper, solid, found, scale)
    _standing(paper, solid)
    _unrolled(paper, solid)
    lists.cuts(paper, study, (25.0, 84.0))
    lists.parts(paper, study, (246.0, 134.0))
    lists.title(paper, study, found, scale, tried)
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
    lowest = float(plan.path.wall_radius(0.0)) / MM
    paper.text(25.0, 272.5, f"R{lowest:.4g} of the wall where the track begins", size=2.2)


def _track_width(paper, plan, found, at, scale):
    """The width of the track, a quarter turn before the outlet."""
    turn = plan.turned + (1.0 if plan.left else -1.0) * 0.5 * np.pi
    outward, r = np.array([np.cos(turn), np.sin(turn)]), 0.5 * found.diameter / MM * scale
    bank = float(plan.path.bank_at(plan.path.at(-0.5 * np.pi)))
    wide = found.track_width * np.cos(bank) / MM * scale
    paper.lines([[at + outward * (r - wide - 7.0), at + outward * r]])
    text = f"track {found.track_width / MM:.4g}"
    paper.text(*(at + outward * (r - wide - 9.5)), text, size=2.2, ha="center", va="center")


def _cut(paper, solid, found, scale):
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
    unrolled_strip.drawn(paper, plan, at, scale)
    paper.dimension(at, at + [length, 0.0], f"{stretch.length / MM:.4g}", (0.0, -6.5), size=2.2)
    text = f"{plan.width / MM:.4g}"
    paper.dimension(at + [length, 0.0], at + [length, wide], text, (6.0, 0.0), size=2.2)
    head = f"track unrolled  {named(scale)}: wall below, parts move to the right; its end lies "
    behind = (plan.path.end - plan.first - stretch.length) / MM
    paper.text(25.0, 127.0, f"{head}{behind:.4g} mm before the outlet", size=2.5, fontweight="bold")
