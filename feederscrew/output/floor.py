"""Files of ``feeder floor``: the cycle, the headings, and the maps."""

import textwrap
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from feederscrew.arrivals.floor import FLOOR_COLUMNS, FloorStudy
from feederscrew.base.arrays import Array, Bools, Floats, Ints, Points, Vector
from feederscrew.base.columns import Cells, Document, Frame, quantities, values
from feederscrew.base.geometry.grids import Grid
from feederscrew.base.geometry.polygons import centroid, turned
from feederscrew.base.heavy import heavy
from feederscrew.base.units import DEGREE, MM
from feederscrew.bowl import texts
from feederscrew.bowl.record import Bowl
from feederscrew.motion import floor_balance
from feederscrew.motion.cycle import Cycle
from feederscrew.motion.floor_balance import (
    FLOOR_CYCLE_COLUMNS,
    FLOOR_LINE_COLUMNS,
    HOP,
    MOTION_STATES,
    FloorMotion,
)
from feederscrew.motion.track_balance import TrackMotion
from feederscrew.output import offers as offer
from feederscrew.output import style
from feederscrew.output.offers import RecordView
from feederscrew.output.record_lines import figure, motion_text
from feederscrew.resting.posture import Posture
from feederscrew.sorting.track import TrackStudy

mpl_lines = heavy("matplotlib.lines")
mpl_patches = heavy("matplotlib.patches")
shading = heavy("feederscrew.output.shading")
matplotlib = heavy("matplotlib")
mpl_ticker = heavy("matplotlib.ticker")

TABLE_CELLS, PICTURE_CELLS = 46, 181  # values of each quantity of a map in a table, and in a picture
MAPS: dict[str, tuple[Any, ...]] = {  # method of the study, axes, picture, the bowl's own point
    "beta_friction": (
        FloorStudy.over_angle_and_friction,
        ("vibration angle β [deg]", "friction μ [1]"),
        "Acceleration along the heading over vibration angle and friction",
        lambda bowl: (np.degrees(bowl.drive.vibration_angle), bowl.friction.kinetic),
    ),
    "frequency_amplitude": (
        FloorStudy.over_frequency_and_amplitude,
        ("frequency f [Hz]", "amplitude A [mm]"),
        "Acceleration along the heading over frequency and amplitude",
        lambda bowl: (bowl.drive.frequency, 1e3 * bowl.drive.amplitude),
    ),
}
OUTSIDE = "line of action of N outside the contact"  # at that instant; over the strokes it may only rock
STATE_WORDS = {"tip": "line of action outside the contact", "stick": "held by friction"}  # else as it is
SAMPLE_STEP = 5  # of the samples of a cycle, in tables and documents
FLOOR_LABELS = {  # what people read
    "normal_force_N": "normal force N [N]",
    "alignment_acceleration_rad_s2": "alignment acceleration theta'' [rad/s2]",
    "stable_heading_deg": "stable heading [deg]",
    "limiting_friction": "limiting friction",
    "acceleration_y_m_s2": "acceleration across the heading, V'_y [m/s2]",
    "acceleration_z_m_s2": "acceleration along the heading, V'_z [m/s2]",
    "friction_N": "friction [N]",
    "greatest_friction_N": "greatest static friction, mu N [N]",
    "normal_line_offset_mm": "line of action of N, d along the heading [mm]",
    "normal_line_offset_y_mm": "line of action of N, across the heading [mm]",
    "tips": OUTSIDE,
}

XY = Sequence[float] | Vector  # (2,)


def instant(motion: Any, posture: Posture, bowl: Bowl) -> Document:
    """Return the upper reversal under the names of the JSON contract.

    Parameters
    ----------
    motion : FloorMotion or PrintedFloor
    posture : Posture
    bowl : Bowl

    Returns
    -------
    dict
    """
    size, friction = np.hypot(*motion.acceleration), {}
    along, across = motion.offset if np.ndim(motion.offset) else (motion.offset, np.nan)
    if hasattr(motion, "friction"):  # the print has no such vector
        limit = float(bowl.friction.static * motion.normal_force)
        friction = {"friction_N": float(np.hypot(*motion.friction)), "greatest_friction_N": limit}
    return {
        "normal_force_N": motion.normal_force[()],
        "alignment_acceleration_rad_s2": float(motion.turning) + 0.0,
        "stable_heading_deg": float(np.degrees(floor_balance.stable_heading(posture, bowl))),
        "limiting_friction": motion.limiting_friction[()],
        "acceleration_y_m_s2": drop_rounding(motion.acceleration[1], size),
        "acceleration_z_m_s2": drop_rounding(motion.acceleration[0], size),
        "normal_line_offset_mm": float(along) / MM,
        "normal_line_offset_y_mm": float(across) / MM + 0.0,
        **friction,
        "tips": is_tipping(getattr(motion, "inside", np.nan)),
        "state": MOTION_STATES[int(motion.state)],
    }


def cycle_columns(motion: FloorMotion, course: Cycle) -> Cells:
    """Return one period as columns.

    Parameters
    ----------
    motion : FloorMotion of shape (N,)
    course : Cycle

    Returns
    -------
    dict of str to array
    """
    columns = {
        **values(FLOOR_CYCLE_COLUMNS, motion),
        "velocity_m_s": course.velocity,
        **values(FLOOR_LINE_COLUMNS, motion),
    }
    return samples(motion, course, columns)


def samples(motion: FloorMotion | TrackMotion, course: Cycle, columns: Mapping[str, Array]) -> Cells:
    """Return columns over a cycle, phase and state before and ``tips`` behind them.

    Parameters
    ----------
    motion : FloorMotion or TrackMotion of shape (N,)
    course : Cycle
    columns : mapping of str to (N,) array

    Returns
    -------
    dict of str to array
        Every ``SAMPLE_STEP``-th sample.
    """
    first: Cells = {"phase_deg": phases(course), "state": np.array(MOTION_STATES)[motion.state]}
    cells = first | dict(columns) | {"tips": [is_tipping(inside) for inside in motion.inside]}
    return {name: values[::SAMPLE_STEP] for name, values in cells.items()}


def phases(course: Cycle) -> Floats:
    """Return the phase of each sample of a cycle.

    Parameters
    ----------
    course : Cycle
        Of N samples.

    Returns
    -------
    (N,) array [deg]
    """
    return np.linspace(0.0, 360.0, len(course.velocity), endpoint=False)


def document(study: FloorStudy) -> Document:
    """Return all of a part on the floor as the JSON document; of one as published, print's reversal too.

    Parameters
    ----------
    study : FloorStudy

    Returns
    -------
    dict
    """
    bowl, printed = study.bowl, {}
    now = instant(study.now, study.posture, bowl)
    if study.printed is not None:
        printed = {"instant": instant(study.printed, study.posture, bowl)}
        printed["difference"] = difference(printed["instant"], now, study.terms)  # type: ignore[attr-defined]
    return {
        **values(FLOOR_COLUMNS, study),
        "instant": now,
        **printed,
        "mean_velocity_m_s": mean_velocity(study),
        "settled": study.course.settled,
        "cycle": cycle_columns(study.cycle, study.course),
        "bowl": texts(bowl.settings),
    }


def printout(document: Mapping[str, Any], format: str, summary: Callable[..., Frame]) -> Frame:
    """Return what is printed: the cycle as CSV; for people its summary, or what print leaves out.

    Parameters
    ----------
    document : mapping
        Of a part on the floor or on the track.
    format : str
        'csv' or 'table'.
    summary : callable
        Returns the frame of a document for people.

    Returns
    -------
    Frame
    """
    if format == "csv":
        return Frame.of(document["cycle"])
    return document.get("difference", summary(document))


def summary(document: Mapping[str, Any]) -> Frame:
    """Return the upper reversal for people, a row a quantity.

    Parameters
    ----------
    document : mapping
        Of ``document``.

    Returns
    -------
    Frame
    """
    return people_table(label_values(document, FLOOR_LABELS))


def label_values(document: Mapping[str, Any], labels: Mapping[str, str]) -> Document:
    """Return the instant of a document and its regime by the names that people read, with units.

    Parameters
    ----------
    document : mapping
        Of a part on the floor or on the track.
    labels : mapping of str to str
        What people read, by the names of the document; others are left out.

    Returns
    -------
    dict
    """
    now = document["instant"]
    rows = {text: now[name] for name, text in labels.items() if name in now}
    states = (("state at the upper reversal", now["state"]), ("regime over the cycle", document["regime"]))
    return rows | {name: STATE_WORDS.get(state, state) for name, state in states}


def people_table(rows: Mapping[str, Any]) -> Frame:
    """Return numbers, texts and verdicts by name as a table for people.

    Parameters
    ----------
    rows : mapping of str to number, str, bool or None

    Returns
    -------
    Frame
    """

    def words(value: Any) -> str:
        if value is None or value != value:
            return "-"
        if isinstance(value, bool):
            return "yes" if value else "no"
        return value if isinstance(value, str) else "never" if np.isinf(value) else f"{value:.5g}"

    return quantities((name, words(value)) for name, value in rows.items())


def difference(published: Mapping[str, Any], complete: Mapping[str, Any], terms: Mapping[str, str]) -> Frame:
    """Return printed against complete values by quantity, with the omitted term of each.

    Parameters
    ----------
    published : mapping
        Values as printed, by name.
    complete : mapping
        The same of the complete equations.
    terms : mapping of str to str
        What print omits, by name: these quantities are compared.

    Returns
    -------
    Frame
    """
    first, second = ([values[name] for name in terms] for values in (published, complete))
    gap = np.array(first, dtype=float) - np.array(second, dtype=float)
    is_equal = np.abs(gap) <= 1e-9 * np.maximum(np.abs(first), np.abs(second))
    omitted = ["-" if same else term for same, term in zip(is_equal, terms.values())]
    columns = {"quantity": list(terms), "as_published": first, "complete": second}
    return Frame.of(columns | {"difference": gap, "omitted_term": omitted})


def remarks(study: FloorStudy) -> list[str]:
    """Return what a reader of a part on the floor should know, a sentence each.

    Parameters
    ----------
    study : FloorStudy

    Returns
    -------
    list of str
    """
    posture, lines = study.posture, aspect_remark(study)
    if len(posture.contact) == 0:
        lines.append("a part card has no contact polygon: whether it tips is not known")
    if floor_balance.rolls(posture):
        lines.append(
            f"rolling aspect, {posture.form}: it rolls, and slips as well where static friction is below"
            f" {float(study.now.limiting_friction):.3g}"
        )
    if np.isfinite(posture.rolling_circle):
        lines.append(
            f"it rolls in a circle: its centre of mass stays {posture.rolling_circle / MM:.4g} mm from the"
            " point where its axis meets the floor; the straight line of these numbers is not its path"
        )
    if HOP in study.cycle.state:
        lines.append(
            "the part loses contact within the cycle: its flight is not followed here, but by feeder convey"
        )
    if not np.isfinite(posture.offset):
        lines.append(f"the card gives no drive offset for aspect {posture.name}: theta'' is not known")
    return lines


def map_remarks(study: FloorStudy) -> list[str]:
    """Return what a reader of the maps should know, a sentence each.

    Parameters
    ----------
    study : FloorStudy

    Returns
    -------
    list of str
    """
    return [line for kind, (over, *_) in MAPS.items() for line in _map_notes(kind, over(study, TABLE_CELLS))]


def _map_notes(kind: str, grid: Grid) -> list[str]:
    slides = MOTION_STATES.index("slide") in grid.codes
    return [] if slides else [f"{kind.replace('_', ' and ')}: {none_slides(grid)}."]


def none_slides(grid: Grid) -> str:
    """Say what a map shows on which nothing slides: of which instant it is, and what happens there.

    Parameters
    ----------
    grid : Grid

    Returns
    -------
    str
    """
    words = {"stick": "is held", "tip": "has its line of action outside the contact", "hop": "is in the air"}
    shares = ((words[name], 100 * share) for name, share in grid.shares().items() if name in words)
    outcomes = ", ".join(f"{word} in {share:.3g} %" for word, share in shares if share > 0.0)
    return (
        f"at the upper reversal the part slides in no cell of the map, it {outcomes} of them; the map is "
        "of that instant, the velocity of the whole cycle"
    )


def _alignment(study: FloorStudy) -> Document:
    headings, cells = study.alignment()
    names = ("alignment_acceleration_rad_s2", "published_alignment_rad_s2")
    return {"heading_deg": np.degrees(headings), **{name: cells[name] for name in names if name in cells}}


def mean_velocity(study: FloorStudy | TrackStudy) -> float | None:
    """Return the mean velocity of the cycle.

    Parameters
    ----------
    study : FloorStudy or TrackStudy

    Returns
    -------
    float [m/s] or None
        None where the part hops, or gets faster with every period.
    """
    return None if HOP in study.cycle.state or not study.course.settled else study.course.mean


def aspect_remark(study: FloorStudy | TrackStudy) -> list[str]:
    """Return which aspect was taken, in one line, where none was asked for.

    Parameters
    ----------
    study : FloorStudy or TrackStudy

    Returns
    -------
    list of str
        Empty where one was asked for.
    """
    return [f"Aspect {study.posture.name}, {study.why}"] if study.why else []


def drop_rounding(value: Floats | float, scale: Floats | float) -> float:
    """Return the rounding of an exact zero as zero.

    Parameters
    ----------
    value : float
    scale : float
        What it came out of, in the same unit.

    Returns
    -------
    float
    """
    return 0.0 if np.abs(value) <= 1e-9 * max(float(np.abs(scale)), 1e-12) else float(value)


def is_tipping(inside: Floats | float) -> bool | None:
    """Tell whether a part tips.

    Parameters
    ----------
    inside : float [m]
        How far its line of action stays inside the contact polygon; negative outside.

    Returns
    -------
    bool or None
        None where the contact polygon or the contact is missing.
    """
    return None if np.isnan(inside) else bool(inside < -floor_balance.ON_THE_LINE)


def offers(study: FloorStudy) -> list[offer.Offer]:
    """Offer the files of a FloorStudy."""
    of, heading = f"{study.part.name}, aspect {study.posture.name}", np.degrees(study.heading)
    title = f"{of}, heading {heading:.4g}°"
    offered = [
        offer.document("floor.json", document, study),
        offer.table("floor_cycle.csv", cycle_columns, study.cycle, study.course),
        offer.table("floor_heading.csv", _alignment, study),
        offer.picture(
            "floor_heading.png", "Alignment acceleration over the heading", _alignment_figure, study, of
        ),
        offer.picture("floor_cycle.png", "Forces and velocity over one cycle", _cycle, study, title),
    ]
    for kind, (over, _, alt, _) in MAPS.items():
        cells = offer.table(f"floor_{kind}.csv", lambda over=over: over(study, TABLE_CELLS).columns())
        offered += [cells, offer.picture(f"floor_{kind}.png", alt, _map, study, kind, title)]
    if len(study.posture.outline):
        above, drawn = "The part from above, with the forces on it", (study.posture, study.heading, study.now)
        offered.append(offer.picture("floor_plan.png", above, plan, *drawn))
    return offered


def _map(study: FloorStudy, kind: str, title: str, ax: "style.Axes | None" = None) -> "style.Figure":
    over, labels, _, own_point = MAPS[kind]
    grid = over(study, PICTURE_CELLS)
    return regime_map(
        grid,
        "acceleration_z_m_s2",
        title=title,
        labels=labels,
        value="acceleration V'_z [m/s²]",
        bowl_point=own_point(study.bowl),
        note=_map_notes(kind, grid),
        ax=ax,
    )


PART, CONTACT = "#dfe6ec", style.ACCENT
DRIVE = "#0072b2"
FRICTION = "#b5482a"
MOTION = "#2f7d5b"
NORMAL = "#5b3a8e"


def plan(
    posture: Posture, heading: float, motion: FloorMotion, ax: "style.Axes | None" = None
) -> "style.Figure":
    """Draw the part from above at the upper reversal, a FloorMotion, at a heading [rad], with its forces."""
    spread = np.ptp(turned(posture.outline, heading), axis=0)
    aspect = f"Aspect {posture.name}" + (" (rolls)" if posture.rolls else "")
    state = MOTION_STATES[int(motion.state)]
    title = f"{aspect}, heading {np.degrees(heading):.4g}° at the upper reversal: {state}"
    height = 1.5 + 5.0 * float(np.clip(1.3 * spread[1] / spread[0], 0.5, 1.0))
    figure, axes = style.chart(
        6.4, height, ax=ax, title=title, x="x in the floor [mm]", y="y in the floor [mm]"
    )
    size = np.ptp(posture.outline, axis=0).max() / MM
    outline, contact = turned(posture.outline, heading) / MM, turned(posture.contact, heading) / MM
    polygon(axes, outline)
    polygon(axes, contact, CONTACT, alpha=0.25, linewidth=1.2, zorder=3)
    axes.plot(*outline.T, alpha=0)
    shading.centre_of_mass(axes, 0.022 * size, (0.0, 0.0))
    end = 0.72 * size * np.array([np.cos(heading), np.sin(heading)])  # x', the thesis's Z'
    axes.plot([0, end[0]], [0, end[1]], color=style.INK, linewidth=0.8, linestyle=(0, (6, 3)), zorder=4)
    style.note(axes, "x'", end, (3, 10), fontsize=9, style="italic")
    axes.plot(*centroid(contact), "+", color=CONTACT, markersize=9, markeredgewidth=1.6, zorder=5)
    centre: style.Look = {"marker": "+", "color": CONTACT, "markeredgewidth": 1.6}
    handles = [
        mpl_patches.Patch(facecolor=CONTACT, alpha=0.35, label="contact polygon"),
        mpl_lines.Line2D([], [], linestyle="", label="its centroid", **centre),
    ]
    # forces along the floor, the longest a share of the part's size
    pushed = turned(motion.acceleration * posture.mass - motion.friction, heading)
    forces = (("drive", pushed, DRIVE), ("friction", turned(motion.friction, heading), FRICTION))
    longest = max(np.hypot(*force) for _, force, _ in forces)
    for name, force, color in forces:
        if longest > 0.0 and np.hypot(*force) > 1e-6 * longest:
            arrow(axes, (0, 0), 0.62 * size * force / longest, f"{name} {newtons(np.hypot(*force))}", color)
    if np.isfinite(motion.offset).all() and motion.normal_force > 0.0:
        place = turned(motion.offset, heading) / MM
        look: style.Look = {"marker": "x", "color": NORMAL, "markeredgewidth": 2}
        axes.plot(*place, linestyle="", markersize=8, zorder=7, **look)
        _note(axes, place, f"N = {newtons(float(motion.normal_force))}", NORMAL, (8, -12))
        handles.append(mpl_lines.Line2D([], [], linestyle="", label="normal force acts here", **look))
    if posture.axis is not None:
        along = turned(posture.axis, heading) * 0.6 * size
        axes.plot([-along[0], along[0]], [-along[1], along[1]], zorder=4, **shading.ROLLING_AXIS_LINE)
        handles.append(mpl_lines.Line2D([], [], label="rolling axis", **shading.ROLLING_AXIS_LINE))
    axes.set_aspect("equal")
    axes.margins(0.4, 0.24)
    style.legend(figure, ax=ax, handles=handles, ncols=len(handles), labelcolor=style.INK)
    return figure


def polygon(axes: "style.Axes", points: Points, color: str | None = None, **look: Any) -> None:
    """Draw a polygon filled, as a part or in a colour of its own.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
    points : (K, 2) float [mm]
    color : str, optional
    **look : object
        As of ``matplotlib.patches.Polygon``.
    """
    edges = {"facecolor": PART, "edgecolor": style.INK, "linewidth": 1.4, "zorder": 2}
    edges |= {} if color is None else {"facecolor": color, "edgecolor": color}
    axes.add_patch(mpl_patches.Polygon(points, closed=True, **(edges | look)))


def _cycle(study: FloorStudy, title: str) -> "style.Figure":
    motion, course, phase = study.cycle, study.course, phases(study.course)
    figure = style.figure(6.8, 5.6)
    upper, lower = figure.subplots(2, 1, sharex=True)
    style.tidy(upper, title=title, y="force [N]")
    upper.plot(phase, motion.normal_force, color=NORMAL, label="normal force N")
    upper.plot(phase, np.hypot(*motion.friction.T), color=FRICTION, label="friction")
    upper.axhline(0, color=style.INK, linewidth=0.8)
    upper.set_ylim(top=1.28 * max(motion.normal_force.max(), 1e-12))
    upper.legend(loc="upper right", bbox_to_anchor=(1, 0.96), ncols=2, **style.LEGEND)
    style.tidy(lower, x="phase ωt [deg]; upper reversal at 90°", y="velocity [mm/s]")
    lower.plot(phase, course.velocity / MM, color=MOTION)
    lower.axhline(course.mean / MM, color=MOTION, linestyle="--", linewidth=0.9)
    lower.axhline(0, color=style.INK, linewidth=0.8)
    mean = f" mean on a level floor {course.mean / MM:.3g} mm/s"
    look = {"fontsize": 8, "color": MOTION, "va": "bottom", "path_effects": style.halo()}
    lower.text(2, course.mean / MM, mean, **look)
    dress_phases(figure, (upper, lower), phase, motion.state)
    return figure


def dress_phases(figure: "style.Figure", panels: Sequence["style.Axes"], phase: Floats, states: Ints) -> None:
    """Dress panels over the phase: the reversals, and on the first a band in the colour of each state."""
    for axes in panels:
        axes.set_xlim(0, 360)
        axes.set_xticks(np.arange(0, 361, 45))
        for reversal in (90, 270):
            axes.axvline(reversal, color=style.FAINT, linewidth=1.2, zorder=0)
    half, codes = 180.0 / len(phase), np.asarray(states)
    for code, name in enumerate(MOTION_STATES):
        indices = np.flatnonzero(codes == code)
        for run in np.split(indices, np.flatnonzero(np.diff(indices) > 1) + 1):
            if len(run):
                ends = phase[run[0]] - half, phase[run[-1]] + half
                panels[0].axvspan(*ends, ymin=0.965, color=STATES[name], linewidth=0)
    present = [name for code, name in enumerate(MOTION_STATES) if code in codes]
    handles = [mpl_patches.Patch(color=STATES[name], label=name) for name in present]
    style.legend(figure, handles=handles, ncols=len(handles))


def _alignment_figure(study: FloorStudy, title: str, ax: "style.Axes | None" = None) -> "style.Figure":
    """The alignment acceleration over the heading, where known by print, with the stable heading."""
    grid, direction = _alignment(study), float(np.degrees(study.stable_heading))
    labels = {"x": "heading θ [deg]", "y": "alignment acceleration θ'' [rad/s²]"}
    figure, axes = style.chart(6.4, 3.8, ax=ax, title=title, **labels)
    if (printed := grid.get("published_alignment_rad_s2")) is not None:
        label = "as published [4.17], sliding or not"
        axes.plot(grid["heading_deg"], printed, color=style.SPARE_COLOURS[3], linestyle="--", label=label)
    turning = grid["alignment_acceleration_rad_s2"]
    axes.plot(grid["heading_deg"], turning, color=DRIVE, label="sliding only", linewidth=1.8)
    axes.axhline(0, color=style.INK, linewidth=0.8)
    if np.isfinite(direction):
        axes.plot(direction, 0, "o", color=style.ACCENT, markersize=7, markeredgecolor="white", zorder=5)
        _note(axes, (direction, 0), f"stable: {direction:.4g}°", style.ACCENT, (8, 8))
    axes.set_xlim(-180, 180)
    axes.set_xticks(np.arange(-180, 181, 45))
    axes.legend(**style.LEGEND)
    return figure


def arrow(
    axes: "style.Axes",
    start: XY,
    step: Vector,
    text: str,
    color: str,
    *,
    is_push: bool = False,
    side: int = 0,
) -> None:
    """Draw a force arrow with its value.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
    start : (float, float) [mm]
    step : (2,) float [mm]
    text, color : str
    is_push : bool, optional
        Whether it ends at the start, from outside; else it begins there.
    side : int, optional
        Writes the value to the left (-1) or right (1) of the middle instead of beyond the head.
    """
    tail = np.asarray(start) - step if is_push else np.asarray(start)
    head, end = tail + step, -9.0 if is_push else 9.0
    look = {"arrowstyle": "-|>", "color": color, "linewidth": 2.0, "shrinkA": 0, "shrinkB": 0}
    axes.annotate("", tuple(head), tuple(tail), arrowprops=look, zorder=6)
    axes.plot(*(tail if is_push else head), alpha=0)
    shift = end * np.asarray(step) / max(float(np.hypot(*step)), 1e-12)
    if side:
        _note(axes, 0.4 * tail + 0.6 * head, text, color, (8.0 * side, 0.0))
    else:
        _note(axes, tail if is_push else head, text, color, shift, is_centred=True)


def newtons(force: float) -> str:
    """Return a force for people.

    Parameters
    ----------
    force : float [N]

    Returns
    -------
    str
        In N, below 0.1 N in mN.
    """
    return f"{force:.3g} N" if force >= 0.1 else f"{1e3 * force:.3g} mN"


def _note(axes: "style.Axes", place: XY, text: str, color: str, shift: XY, is_centred: bool = False) -> None:
    x, y = shift
    sideways = "center" if is_centred and abs(x) < abs(y) else "left" if x >= 0 else "right"
    look = {"color": color, "fontweight": "bold", "ha": sideways, "va": "center", "zorder": 8}
    box = {"facecolor": "white", "alpha": 0.75, "linewidth": 0, "pad": 0.8}
    style.note(axes, text, place, tuple(shift), bbox=box, **look)


HATCHES = {  # regime: hatch, colour of the face, what it says
    "hop": ("////", "#e1e5e8", "hops: contact is lost (dashed: throw number k)"),
    "tip": ("....", "#f2d3c4", "tips"),
    "stick": ("", "#eef2f5", "sticks"),
    "leaves the wall": ("\\\\\\\\", "#dfe9d2", "leaves the wall"),
    "does not fit": ("xxx", "#d9d2e3", "does not fit: falls off the track"),
}
COVERED_REGIMES = ("hop", "stick", "does not fit")  # regimes whose values mean nothing, or are zero
STATES = {"stick": "#9fb3c4", "slide": "#4f9d7f", "hop": "#c9ced3", "tip": style.ACCENT}
THROW_LEVELS = (1.2, 1.5, 2.0, 2.5, 3.0, 4.0, 6.0, 10.0, 20.0, 50.0, 100.0)  # that a line may be drawn for
HATCH_COLOUR = "#8d979f"


def regime_map(
    grid: Grid,
    column: str,
    *,
    title: str,
    labels: Sequence[str],
    value: str,
    bowl_point: Sequence[float] | None = None,
    note: Sequence[str] = (),
    ax: "style.Axes | None" = None,
) -> "style.Figure":
    """Draw a column of a grid in colour with contour lines, and every region where it means something else.

    Parameters
    ----------
    grid : Grid
    column : str
        Name of its values.
    title : str
    labels : sequence of two str
        Of the axes.
    value : str
        Of the colour bar.
    bowl_point : (float, float), optional
        The bowl's own, in the units of the axes.
    note : sequence of str, optional
        Lines under the title.
    ax : matplotlib.axes.Axes, optional
        The user's own.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure, axes = style.chart(6.8, 4.8, ax=ax, title=title, x=labels[0], y=labels[1], grid="none")
    x, y, values = grid.first.in_unit, grid.second.in_unit, np.asarray(grid.values[column]).T
    if np.isfinite(values).any():
        places = [grid.names.index(name) for name in COVERED_REGIMES if name in grid.names]
        _values(figure, axes, (x, y, values), value, np.isin(grid.codes.T, places))
    regions = []
    hatching = {"hatch.color": HATCH_COLOUR, "hatch.linewidth": 0.6}
    for name in (name for name in HATCHES if name in grid.names):
        inside = np.equal(grid.codes.T, grid.names.index(name))
        if not inside.any():
            continue
        (hatch, colour, label), cover = HATCHES[name], np.where(inside, 1.0, 0.0)
        edge = {"edgecolor": HATCH_COLOUR, "linewidth": 0.4}
        with matplotlib.rc_context(hatching):
            axes.contourf(
                x,
                y,
                cover,
                [0.5, 1.5],
                colors=[colour],
                alpha=1.0 if name in COVERED_REGIMES else 0.55,
                hatches=[hatch or None],
                zorder=3,
            )
            regions.append(mpl_patches.Patch(facecolor=colour, hatch=hatch, label=label, **edge))
        if not inside.all():
            axes.contour(x, y, cover, [0.5], colors=style.INK, linewidths=0.9, zorder=4)
    _throws(axes, grid)
    if bowl_point is not None:
        style.own_point(axes, bowl_point, "this bowl", (8, 6))
    if note:  # sentences under the title, each from a line of its own
        listed = [piece for line in note for piece in textwrap.wrap(line, 100)]
        look = {"transform": axes.transAxes, "fontsize": 7.5, "color": style.INK, "va": "bottom"}
        axes.text(0.0, 1.01, "\n".join(listed), **look)
        look = {"loc": "left", "fontsize": 10, "color": style.INK, "fontweight": "bold"}
        axes.set_title(title, pad=6 + 10 * len(listed), **look)
    axes.set(xlim=(x[0], x[-1]), ylim=(y[0], y[-1]))
    if regions:
        with matplotlib.rc_context(hatching):
            style.legend(figure, "lower left", ax=ax, handles=regions, ncols=len(regions))
    return figure


def _values(
    figure: "style.Figure", axes: "style.Axes", data: tuple[Floats, ...], label: str, is_covered: Bools
) -> None:
    """Colours with their bar, and contour lines where nothing covers them."""
    x, y, values = data
    finite = values[np.isfinite(values)]
    low, high = finite.min(), finite.max()
    high = high if high - low > 1e-12 * max(abs(high), 1e-300) else low + 1.0
    mesh = axes.pcolormesh(x, y, values, cmap="cividis", vmin=low, vmax=high, shading="nearest", zorder=1)
    bar: Any = figure.colorbar(mesh, ax=axes, pad=0.02)
    bar.set_label(label, fontsize=9, color=style.INK)
    bar.ax.tick_params(labelsize=8, colors=style.INK)
    bar.outline.set_visible(False)
    open_to_view: Any = np.ma.masked_invalid(np.where(is_covered, np.nan, values))
    if min(values.shape) > 1 and open_to_view.count() and np.ptp(open_to_view.compressed()) > 0.0:
        lines = axes.contour(x, y, open_to_view, 8, colors="white", linewidths=0.6, zorder=2)
        for text in axes.clabel(lines, fmt="%g", fontsize=6.5):
            text.set_path_effects(style.rim())


def _throws(axes: "style.Axes", grid: Grid) -> None:
    """Lines of equal throw number where the part hops: all that this balance can say there."""
    if "hop" not in grid.names or "throw_number" not in grid.values or min(grid.codes.shape) < 2:
        return
    hops = grid.codes == grid.names.index("hop")
    throw = np.ma.masked_invalid(np.where(hops, grid.values["throw_number"], np.nan).T)
    if not throw.count() or throw.min() == throw.max():
        return
    levels: Any = [level for level in THROW_LEVELS if throw.min() < level < throw.max()]
    if len(levels) < 2:
        levels = mpl_ticker.MaxNLocator(5).tick_values(throw.min(), throw.max())
    look: Any = {"colors": style.INK, "linewidths": 0.8, "linestyles": "--", "zorder": 5}
    lines = axes.contour(grid.first.in_unit, grid.second.in_unit, throw, levels, **look)
    for text in axes.clabel(lines, fmt=lambda k: f"k = {k:g}", fontsize=7):
        text.set_path_effects(style.halo())


FLOOR_VIEW = RecordView(lambda study: motion_text(study, figure(study.heading, DEGREE)), offers, "floor")
