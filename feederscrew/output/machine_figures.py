"""The bowl from above and in section, in one scale, and what it does from full to empty."""

import numpy as np
from matplotlib.patches import Circle, Polygon, Rectangle, Wedge

from feederscrew.base.arrays import Vector
from feederscrew.base.units import DEG, MM, PER_MINUTE
from feederscrew.bowl.verified import Verified
from feederscrew.machine.sheet import MachineSheet
from feederscrew.output import machine_sheet as sheets
from feederscrew.output import style

MACHINE_PAGE_WIDTH_PX, MACHINE_PAGE_HEIGHT_PX = 1760, 1500  # [px] of the page
SHEET_EDGE = "#22303c"
TRACK_RING_FACE = "#b9cbd8"
FLOOR = "#eef2f5"
FILL = "#e9d9b6"
BASE = "#c9d0d6"
SPRING_FACE = "#7d8b97"
SIZE_TEXT_PT = 8.5  # [pt]
PITCH = 2.2  # thicknesses from leaf to leaf: one between them as a spacer
CENTRED: style.Look = {"color": style.INK, "ha": "center", "va": "center"}
HEAD = {"fontsize": 10, "fontweight": "bold", "color": style.INK, "va": "top"}
DIMENSION = {"arrowstyle": "<->", "color": style.INK, "linewidth": 0.8, "shrinkA": 0, "shrinkB": 0}
LEADER = {"arrowstyle": "-", "color": style.INK, "linewidth": 0.7, "shrinkA": 1, "shrinkB": 0}


def bowl(study: MachineSheet, trial: Verified | None = None) -> "style.Figure":
    """Draw a bowl with its machine, and what a trial of it has shown.

    Parameters
    ----------
    study : MachineSheet
    trial : Verified, optional

    Returns
    -------
    matplotlib.figure.Figure
    """
    page = style.page(MACHINE_PAGE_WIDTH_PX, MACHINE_PAGE_HEIGHT_PX)
    words, moved = "The machine of this bowl", study.stroke
    if study.order is not None:
        rate = study.order.target / PER_MINUTE
        words = f"{study.order.part.name}: a bowl for {rate:.4g} parts a minute"
    elif trial is not None:
        words = f"A bowl for {trial.target / PER_MINUTE:.4g} parts a minute"
    if trial is not None:
        words += f", {trial.wanted}: its trial delivers {sheets.rate_of_trial(trial)}"
    facts = f"{moved.frequency:.4g} Hz, {moved.peak_to_peak / MM:.3g} mm peak to peak, "
    facts += f"{1e3 * study.answer.velocity:.3g} mm/s; {sheets.angles(study)}"
    page.text(0.02, 0.965, words, fontsize=14, fontweight="bold", color=style.INK, va="center")
    line = {"fontsize": 9.5, "va": "center"}
    page.text(0.02, 0.935, f"{facts}; both views in one scale, sizes in mm", color=style.INK, **line)
    if study.mismatch is not None:
        remark = f"the springs do not make it: they make {study.mismatch.machine.text}"
        page.text(0.02, 0.912, remark, color=style.ACCENT, **line)
    half = 1.34 * study.bowl.track.radius / MM  # shown to each side
    above, section = page.add_axes((0.015, 0.40, 0.475, 0.50)), page.add_axes((0.51, 0.40, 0.475, 0.50))
    share = 0.50 * MACHINE_PAGE_HEIGHT_PX / (0.475 * MACHINE_PAGE_WIDTH_PX)
    for axes, words in ((above, "from above"), (section, "in section")):
        axes.set_axis_off()
        axes.set(xlim=(-half, half), ylim=(-half * share, half * share))
        axes.text(-half, half * share, words, **HEAD)
    _draw_from_above(above, study, half * share)
    _draw_section(section, study, half * share)
    # rate or velocity, and natural frequency, from a full bowl to an empty one
    left, right = page.add_axes((0.065, 0.065, 0.41, 0.27)), page.add_axes((0.565, 0.065, 0.41, 0.27))
    fill = 100.0 * study.emptying.levels
    ordered = study.order is not None
    courses = study.velocities, study.controlled
    free, held = (study.rates(v) / PER_MINUTE if ordered else 1e3 * v for v in courses)
    what = "Parts a minute as the bowl empties" if ordered else "Velocity as the bowl empties [mm/s]"
    style.tidy(left, title=what, x="fill [%]")
    left.plot(fill, free, color="#d55e00", marker="o", markersize=3, label="amplitude left alone")
    left.plot(fill, held, color="#0072b2", linewidth=1.8, label="amplitude controlled")
    top = 1.22 * max(np.nanmax(free), np.nanmax(held), 1e-9)
    left.set(xlim=(103, -3), ylim=(min(0.0, 1.05 * np.nanmin(free)), top))
    left.legend(fontsize=8, frameon=False, loc="upper right", labelcolor=style.INK, ncols=2)
    style.tidy(right, title="Natural frequency as the bowl empties [Hz]", x="fill [%]")
    natural, drive = study.emptying.natural_frequencies, study.stroke.frequency
    right.plot(fill, natural, color=style.INK, linewidth=1.8)
    right.axhline(drive, color=style.ACCENT, linewidth=1.2, linestyle="--")
    low, high = min(natural.min(), drive), max(natural.max(), drive)
    right.set(xlim=(103, -3), ylim=(low - 0.25 * (high - low), high + 0.15 * (high - low)))
    below = drive - 0.04 * (high - low)
    right.text(100, below, f"drive {drive:.4g} Hz", fontsize=8, color=style.ACCENT, va="top")
    return page


def _draw_from_above(axes: "style.Axes", study: MachineSheet, half: float) -> None:
    track, machine = study.bowl.track, study.bowl.machine
    radius, width, at = track.radius / MM, track.width / MM, machine.spring_radius / MM
    axes.add_patch(Circle((0, 0), radius - width, facecolor=FLOOR, edgecolor=SPRING_FACE, linewidth=0.8))
    axes.add_patch(Wedge((0, 0), radius, 0, 360, width=width, facecolor=TRACK_RING_FACE, edgecolor="none"))
    axes.add_patch(Circle((0, 0), radius, fill=False, edgecolor=SHEET_EDGE, linewidth=2.2))
    dashed = {"edgecolor": SPRING_FACE, "linewidth": 0.9, "linestyle": (0, (5, 3))}
    axes.add_patch(Circle((0, 0), at, fill=False, **dashed))
    # the banks, leaf by leaf, each as thick as it is: its width lies along the radius
    wide, thick = machine.leaf_width / MM, machine.leaf_thickness / MM
    square = ((-1, -1), (1, -1), (1, 1), (-1, 1))
    banks = sheets.spring_banks(study.bowl)
    for place, leaves in zip(banks.angles, banks.counts):
        outward, along = _axes_at(place)
        for step in PITCH * thick * (np.arange(leaves) - 0.5 * (leaves - 1)):
            corners = [
                at * outward + x * 0.5 * wide * outward + (step + y * 0.5 * thick) * along for x, y in square
            ]
            leaf = {"facecolor": SPRING_FACE, "edgecolor": SHEET_EDGE, "linewidth": 0.5}
            axes.add_patch(Polygon(corners, closed=True, **leaf))
    if study.order is not None:
        # the part along the wall, as often as it fits on a quarter of the track
        outline, to_wall = study.order.shape.outline / MM, study.order.shape.to_wall / MM
        step, first = 1.12 * (study.order.shape.length / MM) / radius, np.radians(118)
        for place in first + step * np.arange(max(1, int(np.radians(118) / step))):
            outward, ahead = _axes_at(place)
            ring = np.outer(radius - to_wall - outline[:, 1], outward) + np.outer(outline[:, 0], ahead)
            part = {"facecolor": "#f2c48f", "edgecolor": SHEET_EDGE, "linewidth": 0.7, "zorder": 3}
            axes.add_patch(Polygon(ring, closed=True, **part))
    # an arrow the way the parts climb: counter-clockwise
    middle, turn = radius - 0.5 * width, np.radians(np.linspace(28, 78, 40))
    axes.plot(middle * np.cos(turn), middle * np.sin(turn), color=style.INK, linewidth=1.1)
    end, before = turn[-1], turn[-4]
    axes.annotate(
        "",
        (middle * np.cos(end + 0.03), middle * np.sin(end + 0.03)),
        (middle * np.cos(before), middle * np.sin(before)),
        arrowprops={"arrowstyle": "-|>", "color": style.INK, "linewidth": 1.1},
    )
    # the diameter, the track's width and the springs' radius
    y = -radius - 0.10 * half
    for x in (-radius, radius):
        axes.plot([x, x], [0, y - 0.02 * radius], color=style.INK, linewidth=0.5, zorder=0)
    axes.annotate("", (-radius, y), (radius, y), arrowprops=DIMENSION)
    white = {"facecolor": "white", "edgecolor": "none", "pad": 1.5}
    axes.text(0, y, f"D {2 * radius:.4g}", fontsize=10, bbox=white, **CENTRED)
    on_track, label = tuple(middle * _axes_at(np.radians(-38))[0]), (1.17 * radius, -0.72 * radius)
    look: style.Look = {"fontsize": SIZE_TEXT_PT, "arrowprops": LEADER, **CENTRED}
    axes.annotate(f"track {width:.3g}", on_track, label, **look)
    axes.text(0, 0, f"springs on\nradius {at:.4g}", fontsize=SIZE_TEXT_PT, **CENTRED)


def _axes_at(turn: float) -> tuple[Vector, Vector]:
    """Unit vectors outwards and counter-clockwise at an angle [rad]."""
    return np.array([np.cos(turn), np.sin(turn)]), np.array([-np.sin(turn), np.cos(turn)])


def _draw_section(axes: "style.Axes", study: MachineSheet, half: float) -> None:
    track, machine, rules = study.bowl.track, study.bowl.machine, study.bowl.sizing
    radius, width, depth = track.radius / MM, track.width / MM, study.depth / MM
    sheet, leaf = rules.sheet / MM, machine.leaf_length / MM * np.cos(machine.spring_angle)
    base = min(0.42 * radius, 0.9 * half)
    foot = -0.5 * (depth + base + leaf) + base + leaf  # the bowl's floor, so that all stands in the middle
    level, top = rules.fill_height * depth, foot - sheet
    axes.add_patch(Rectangle((-radius, foot), 2 * radius, level, facecolor=FILL, edgecolor="none"))
    # the track cut at both sides, half a turn higher on the left
    rise = np.pi * 2.0 * radius * np.tan(track.climb)
    cut: style.Look = {"facecolor": SPRING_FACE, "edgecolor": SHEET_EDGE, "linewidth": 0.5}
    for left, start in ((radius - width, 0.0), (-radius, 0.5)):
        for height in rise * (start + np.arange(60)) if rise > 0.0 else (0.0,):
            if height > depth + 1e-9:
                break
            axes.add_patch(Rectangle((left, foot + height - sheet), width, sheet, **cut))
    axes.add_patch(Rectangle((-radius, top), 2 * radius, sheet, color=SHEET_EDGE))
    tilt, length = machine.spring_angle, machine.leaf_length / MM
    count = sheets.spring_banks(study.bowl).counts[0]
    lean = 0.5 * length * np.sin(tilt)
    for side in (-1, 1):
        wall = (side * radius - (side < 0) * sheet, top)
        axes.add_patch(Rectangle(wall, sheet, depth + sheet, color=SHEET_EDGE))
        # a bank of leaves at its tilt, as many as there are
        for step in np.arange(count) - 0.5 * (count - 1):
            x = side * machine.spring_radius / MM + PITCH * step * machine.leaf_thickness / MM
            ends = [x - lean, x + lean], [top - length * np.cos(tilt), top]
            axes.plot(*ends, color=SHEET_EDGE, linewidth=1.4)
    reach, low = 1.25 * machine.spring_radius / MM, foot - leaf - base
    axes.add_patch(Rectangle((-reach, low), 2 * reach, base, facecolor=BASE, edgecolor=SPRING_FACE))
    leaves = f"{machine.leaves:.0f} leaves {sheets.leaf_words(machine)}"
    base_words = f"base {machine.base_mass:.3g} kg\n{machine.base_inertia:.3g} kg m²"
    climb = f"climb {track.climb / DEG:.3g}°" if track.climb > 0.0 else "level track"
    climb += f", {study.turns:.3g} turns" if np.isfinite(study.turns) else ""
    climb += f"\nbowl {machine.bowl_mass:.3g} kg, {machine.bowl_inertia:.3g} kg m²"
    for y, words, align in (
        (foot - leaf - 0.5 * base, base_words, "center"),
        (foot - 0.5 * leaf, f"{leaves}\nmotion there {machine.spring_angle / DEG:.3g}°", "center"),
        (foot + 0.5 * level, f"full {study.fill.mass:.3g} kg", "center"),
        (foot + depth, climb, "top"),
    ):
        axes.text(0, y, words, fontsize=SIZE_TEXT_PT, color=style.INK, ha="center", va=align)
    _dimension_height(axes, 1, radius, foot, foot + depth)
    if 0.0 < 1.5 * rise <= depth:
        _dimension_height(axes, -1, radius, foot + 0.5 * rise, foot + 1.5 * rise)


def _dimension_height(axes: "style.Axes", side: int, radius: float, low: float, high: float) -> None:
    """A height beside the wall, on the right (1) or on the left (-1)."""
    x = side * 1.13 * radius
    for y in (low, high):
        axes.plot([side * radius, x + 0.02 * side * radius], [y, y], color=style.INK, linewidth=0.5, zorder=0)
    axes.annotate("", (x, low), (x, high), arrowprops=DIMENSION)
    align = "left" if side > 0 else "right"
    place = (x + 0.03 * side * radius, 0.5 * (low + high))
    axes.text(*place, f"{high - low:.3g}", fontsize=9, color=style.INK, va="center", ha=align)
