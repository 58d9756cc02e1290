"""The tooled stretch of a bowl unrolled, and the numbers that its devices have on a drawing sheet."""

import numpy as np

from feederscrew.output.solidbowl.paper import THICK, THIN
from feederscrew.units import MM

NARROW = 5.0  # [mm] of paper: a cut that has no room for its number
HOLE, PLATE = "#d55e00", "#0072b2"


def numbered(stretch):
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


def drawn(paper, plan, at, scale):
    """Draw the stretch of a plan at its lower left corner [mm], in a scale: wall below, parts move right."""
    stretch, wide = plan.stretch, plan.width / MM * scale
    length = stretch.length / MM * scale
    paper.box(at[0], at[1], at[0] + length, at[1] + wide, THICK)
    paper.lines([[at + [0.0, -0.8], at + [length, -0.8]]], 3.0 * THICK)
    for number, (one, _, start, end) in enumerate(numbered(stretch), start=1):
        x = at[0] + np.array([start, min(end, stretch.length)]) / MM * scale
        if hasattr(one, "ring"):
            place, side = _cut(paper, plan, one, at, scale)
        elif hasattr(one, "thickness"):
            x[1] = max(x[1], x[0] + 0.4)
            paper.axes.fill(x[[0, 1, 1, 0]], at[1] + wide * np.array([0.0, 0.0, 1.0, 1.0]), color=PLATE)
            place, side = (x[1] + 0.8, at[1] + 0.5 * wide), "left"
        elif hasattr(one, "height"):
            middle = x.mean()
            paper.lines([[(middle, at[1] - 1.6), (middle, at[1] + 0.25 * wide)]], THIN, linestyles="dashdot")
            place, side = (middle + 0.8, at[1] + 0.25 * wide), "left"
        else:
            place, side = _change(paper, one, x, at, wide, scale)
            place = place if np.isfinite(end) else (x[0] + 0.8, place[1])  # it goes on: within the strip
        paper.text(*place, str(number), size=2.5, ha=side, va="center")


def _cut(paper, plan, cut, at, scale):
    """A hole in the track; where its number stands."""
    ring = cut.ring.copy()
    if cut.hangs:
        ring[ring[:, 0] >= cut.span[1] - 1e-9, 0] = plan.stretch.length
    ring = np.column_stack([ring[:, 0], np.clip(ring[:, 1], 0.0, plan.width)]) / MM * scale + at
    paper.axes.fill(*ring.T, facecolor="white", edgecolor=HOLE, linewidth=THICK)
    if np.ptp(ring[:, 0]) < NARROW:
        return (ring[:, 0].max() + 0.8, ring[:, 1].mean()), "left"
    return ring.mean(axis=0), "center"


def _change(paper, one, x, at, wide, scale):
    """A step, a ledge, or where the bank changes; where its number stands."""
    low, high = at[1], at[1] + wide
    if hasattr(one, "ramp"):
        high, level = low + one.width / MM * scale, at[0] + one.end / MM * scale
        paper.box(x[0], low, x[1], high, THICK)
        paper.lines([[(x[0], low), (x[0], at[1] + wide)], [(level, low), (level, high)]], THICK)
        return (0.5 * (x[0] + level), 0.5 * (low + high)), "center"
    paper.lines([[(place, low), (place, high)] for place in np.unique(x)], THICK, linestyles="dashed")
    return (x[1] + 0.8, low + 0.8 * wide), "left"
