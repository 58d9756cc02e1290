"""Pictures of a part on the bowl floor: seen from above, over a cycle, over its heading."""

import numpy as np
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Polygon

from feederscrew.geometry.polygons import centroid, turned
from feederscrew.mechanics.floor.balance import MOTION_STATES
from feederscrew.output import style as plots
from feederscrew.output.floor.map_figures import phase_axis, state_band, state_legend
from feederscrew.output.solid import marks
from feederscrew.units import MM

PART, CONTACT = "#dfe6ec", plots.ACCENT
DRIVE, FRICTION, MOTION, NORMAL = "#0072b2", "#b5482a", "#2f7d5b", "#5b3a8e"
LONGEST = 0.62  # of the part's size: the longest arrow


def plan(posture, heading, found):
    """Draw the part from above at the upper reversal, with what acts on it along the floor.

    Parameters
    ----------
    posture : Posture
        With an outline.
    heading : float [rad]
        theta.
    found : FloorMotion
        At that instant.

    Returns
    -------
    Figure
    """
    spread = np.ptp(turned(posture.outline, heading), axis=0)
    figure = plots.figure(6.4, 1.5 + 5.0 * float(np.clip(1.3 * spread[1] / spread[0], 0.5, 1.0)))
    axes = plots.tidy(figure.add_subplot(), x="x in the floor [mm]", y="y in the floor [mm]", grid="both")
    size = np.ptp(posture.outline, axis=0).max() / MM
    _part(axes, posture, heading, size)
    pushed = turned(found.acceleration * posture.mass - found.friction, heading)
    forces = [("drive", pushed, DRIVE), ("friction", turned(found.friction, heading), FRICTION)]
    _arrows(axes, forces, size)
    pressed = bool(np.isfinite(found.offset).all() and found.normal_force > 0.0)
    if pressed:
        place = turned(found.offset, heading) / MM
        axes.plot(*place, "x", color=NORMAL, markersize=8, markeredgewidth=2, zorder=7)
        _note(axes, place, f"N = {newtons(found.normal_force)}", NORMAL, (8, -12))
    state = MOTION_STATES[int(found.state)]
    axes.set_title(
        f"{_aspect(posture)}, heading {np.degrees(heading):.4g}° at the upper reversal: {state}",
        loc="left", fontsize=10, color=plots.INK, fontweight="bold",
    )  # fmt: skip
    axes.set_aspect("equal")
    axes.margins(0.4, 0.24)
    _legend(figure, posture, pressed)
    return figure


def cycle(found, course, title):
    """Draw forces, acceleration and velocity over one settled period.

    Parameters
    ----------
    found : FloorMotion of shape (N,)
    course : Cycle
    title : str

    Returns
    -------
    Figure
    """
    figure = plots.figure(6.8, 5.6)
    upper, lower = figure.subplots(2, 1, sharex=True)
    phase = np.linspace(0.0, 360.0, len(course.velocity), endpoint=False)
    plots.tidy(upper, title=title, y="force [N]")
    upper.plot(phase, found.normal_force, color=NORMAL, label="normal force N")
    upper.plot(phase, np.hypot(*found.friction.T), color=FRICTION, label="friction")
    upper.axhline(0, color=plots.INK, linewidth=0.8)
    upper.set_ylim(top=1.28 * max(found.normal_force.max(), 1e-12))
    upper.legend(
        fontsize=8, frameon=False, loc="upper right", bbox_to_anchor=(1, 0.96), ncols=2, labelcolor=plots.INK
    )
    plots.tidy(lower, x="phase ωt [deg]; upper reversal at 90°", y="velocity [mm/s]")
    lower.plot(phase, course.velocity / MM, color=MOTION)
    lower.axhline(course.mean / MM, color=MOTION, linestyle="--", linewidth=0.9)
    lower.axhline(0, color=plots.INK, linewidth=0.8)
    lower.text(
        2, course.mean / MM, f" mean on a level floor {course.mean / MM:.3g} mm/s",
        fontsize=8, color=MOTION, va="bottom", path_effects=plots.HALO,
    )  # fmt: skip
    for axes in (upper, lower):
        phase_axis(axes)
    state_band(upper, phase, found.state, MOTION_STATES)
    state_legend(figure, found.state, MOTION_STATES)
    return figure


def alignment(grid, direction, title):
    """Draw the alignment acceleration over the heading, where known by print, with the stable heading.

    Parameters
    ----------
    grid : dict of str to array
        ``heading_deg``, ``alignment_acceleration_rad_s2`` and, where known, ``published_alignment_rad_s2``.
    direction : float [deg]
        Stable heading, NaN for none.
    title : str

    Returns
    -------
    Figure
    """
    figure = plots.figure(6.4, 3.8)
    axes = plots.tidy(
        figure.add_subplot(), title=title, x="heading θ [deg]", y="alignment acceleration θ'' [rad/s²]"
    )
    if (printed := grid.get("published_alignment_rad_s2")) is not None:
        label = "as published [4.17], sliding or not"
        axes.plot(grid["heading_deg"], printed, color=plots.SPARE[3], linestyle="--", label=label)
    axes.plot(
        grid["heading_deg"],
        grid["alignment_acceleration_rad_s2"],
        color=DRIVE,
        label="sliding only",
        linewidth=1.8,
    )
    axes.axhline(0, color=plots.INK, linewidth=0.8)
    if np.isfinite(direction):
        axes.plot(direction, 0, "o", color=plots.ACCENT, markersize=7, markeredgecolor="white", zorder=5)
        _note(axes, (direction, 0), f"stable: {direction:.4g}°", plots.ACCENT, (8, 8))
    axes.set_xlim(-180, 180)
    axes.set_xticks(np.arange(-180, 181, 45))
    axes.legend(fontsize=8, frameon=False, labelcolor=plots.INK)
    return figure


def arrow(axes, start, step, text, color, *, pushing=False, beside=0):
    """A force arrow with its value: from ``start`` on or, ``pushing``, towards it from outside.

    ``beside`` writes the value to the left (-1) or right (1) of the middle instead of beyond the head.
    """
    tail = np.asarray(start) - step if pushing else np.asarray(start)
    head = tail + step
    style = {"arrowstyle": "-|>", "color": color, "linewidth": 2.0, "shrinkA": 0, "shrinkB": 0}
    axes.annotate("", head, tail, arrowprops=style, zorder=6)
    axes.plot(*(tail if pushing else head), alpha=0)
    shift = (-9.0 if pushing else 9.0) * np.asarray(step) / max(float(np.hypot(*step)), 1e-12)
    if beside:
        _note(axes, 0.4 * tail + 0.6 * head, text, color, (8.0 * beside, 0.0))
    else:
        _note(axes, tail if pushing else head, text, color, shift, centred=True)


def newtons(force):
    """Return a force for people."""
    return f"{force:.3g} N" if force >= 0.1 else f"{1e3 * force:.3g} mN"


def _part(axes, posture, heading, size):
    outline, contact = turned(posture.outline, heading) / MM, turned(posture.contact, heading) / MM
    axes.add_patch(
        Polygon(outline, closed=True, facecolor=PART, edgecolor=plots.INK, linewidth=1.4, zorder=2)
    )
    axes.add_patch(
        Polygon(
            contact, closed=True, facecolor=CONTACT, edgecolor=CONTACT, alpha=0.25, linewidth=1.2, zorder=3
        )
    )
    axes.plot(*outline.T, alpha=0)
    marks.centre_of_mass(axes, 0.022 * size, (0.0, 0.0))
    _heading_line(axes, heading, size)
    middle = centroid(contact)
    axes.plot(*middle, "+", color=CONTACT, markersize=9, markeredgewidth=1.6, zorder=5)
    if posture.axis is not None:
        along = turned(posture.axis, heading) * 0.6 * size
        axes.plot([-along[0], along[0]], [-along[1], along[1]], zorder=4, **marks.AXIS)


def _heading_line(axes, heading, size):
    """The body's own direction, x' (the thesis's Z')."""
    end = 0.72 * size * np.array([np.cos(heading), np.sin(heading)])
    axes.plot([0, end[0]], [0, end[1]], color=plots.INK, linewidth=0.8, linestyle=(0, (6, 3)), zorder=4)
    axes.annotate("x'", end, (3, 10), textcoords="offset points", fontsize=9, color=plots.INK, style="italic")


def _legend(figure, posture, pressed):
    handles = [
        Patch(facecolor=CONTACT, alpha=0.35, label="contact polygon"),
        Line2D([], [], marker="+", linestyle="", color=CONTACT, markeredgewidth=1.6, label="its centroid"),
    ]
    if pressed:
        label = "normal force acts here"
        handles.append(Line2D([], [], marker="x", linestyle="", color=NORMAL, markeredgewidth=2, label=label))
    if posture.axis is not None:
        handles.append(Line2D([], [], label="rolling axis", **marks.AXIS))
    figure.legend(
        handles=handles,
        fontsize=8,
        frameon=False,
        loc="outside lower center",
        ncols=len(handles),
        labelcolor=plots.INK,
    )


def _arrows(axes, forces, size):
    longest = max(np.hypot(*force) for _, force, _ in forces)
    for name, force, color in forces:
        if longest > 0.0 and np.hypot(*force) > 1e-6 * longest:
            arrow(
                axes, (0, 0), LONGEST * size * force / longest, f"{name} {newtons(np.hypot(*force))}", color
            )


def _note(axes, place, text, color, shift, centred=False):
    sideways = "center" if centred and abs(shift[0]) < abs(shift[1]) else "left" if shift[0] >= 0 else "right"
    axes.annotate(
        text, place, tuple(shift), textcoords="offset points", fontsize=8, color=color, fontweight="bold",
        ha=sideways, va="center", zorder=8,
        bbox={"facecolor": "white", "alpha": 0.75, "linewidth": 0, "pad": 0.8},
    )  # fmt: skip


def _aspect(posture):
    return f"Aspect {posture.name}" + (" (rolling)" if posture.kind == "rolling" else "")
