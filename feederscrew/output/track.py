"""Files of ``feeder track``: the cycle and the maps."""

from collections.abc import Mapping, Sequence
from functools import partial
from operator import attrgetter
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from feederscrew import bowl as bowls
from feederscrew.base.arrays import Bools, Floats, Vector
from feederscrew.base.columns import Cells, Document, Frame, heads, values
from feederscrew.base.geometry.grids import Grid
from feederscrew.base.geometry.polygons import outline, turned
from feederscrew.base.heavy import heavy
from feederscrew.base.units import MM
from feederscrew.bowl.record import Track
from feederscrew.motion.cycle import Cycle
from feederscrew.motion.floor_balance import HOP, MOTION_STATES, regime
from feederscrew.motion.track_balance import TRACK_CYCLE_COLUMNS, TrackAxes, TrackMotion, frame
from feederscrew.motion.track_contacts import OPENING_COLUMNS, TIPPING_AXIS_COLUMNS
from feederscrew.output import floor, style
from feederscrew.output import offers as offer
from feederscrew.output.floor import CONTACT, DRIVE, FRICTION, NORMAL, drop_rounding, polygon
from feederscrew.output.offers import RecordView
from feederscrew.output.record_lines import track_text
from feederscrew.sorting.track import TRACK_COLUMNS, TrackStudy

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

shading = heavy("feederscrew.output.shading")

CONTACT_NAMES = ("floor", "wall_1", "wall_2")
TRACK_LABELS = {
    "normal_force_N": "normal force N [N]",
    "wall_1_N": "wall reaction R1, trailing contact [N]",
    "wall_2_N": "wall reaction R2, leading contact [N]",
    "radial_friction_N": "radial friction R3, away from the wall [N]",
    "traction_N": "traction R4, against motion ahead [N]",
    "normal_line_offset_mm": "line of action of N, d ahead [mm]",
    "normal_line_offset_y_mm": "line of action of N, away from the wall [mm]",
    "acceleration_x_m_s2": "acceleration along the track, V'_X [m/s2]",
    "acceleration_y_m_s2": "acceleration away from the wall [m/s2]",
    "turning_rad_s2": "turning off the wall [rad/s2]",
    "tips": floor.OUTSIDE,
}
IN_MM = {
    "normal_line_offset_m": "normal_line_offset_mm",
    "normal_line_offset_across_m": "normal_line_offset_y_mm",
}
WALL = "#5d6b78"
WALL_COLOURS = ("#b5482a", "#e08a3c")  # of R1 and R2


def _instant(motion: TrackMotion) -> Document:
    """One instant under the names of the JSON contract; ``motion`` is a TrackMotion of one instant."""
    load = motion.normal_force + abs(motion.traction)
    return {
        "normal_force_N": float(motion.normal_force),
        "wall_1_N": drop_rounding(motion.walls[0], load),
        "wall_2_N": drop_rounding(motion.walls[1], load),
        "radial_friction_N": drop_rounding(motion.radial_friction, load),
        "traction_N": drop_rounding(motion.traction, load),
        "normal_line_offset_mm": drop_rounding(motion.offset[0] / MM, 1.0),
        "normal_line_offset_y_mm": drop_rounding(motion.offset[1] / MM, 1.0),
        "acceleration_x_m_s2": float(motion.acceleration[0]),
        "acceleration_y_m_s2": drop_rounding(motion.acceleration[1], motion.acceleration[0]),
        "turning_rad_s2": drop_rounding(motion.turning, motion.acceleration[0] / MM),
        "wall_1_friction_N": motion.wall_friction[0],
        "wall_2_friction_N": motion.wall_friction[1],
        "floor_couple_N_mm": float(motion.couple) / MM,
        "opened": [] if motion.state == HOP else _open_contacts(motion.closed),
        "tips": floor.is_tipping(motion.inside),
        "state": MOTION_STATES[int(motion.state)],
    }


def _printed_instant(motion: Any) -> Document:
    """The same of the printed equations; ``motion`` is a PrintedTrack of one instant."""
    return {
        "normal_force_N": float(motion.normal_force),
        "wall_1_N": motion.walls[0],
        "wall_2_N": motion.walls[1],
        "radial_friction_N": motion.radial_friction[()],
        "traction_N": motion.traction[()],
        "normal_line_offset_mm": float(motion.offset) / MM,
        "acceleration_x_m_s2": float(motion.acceleration),
        "tips": None,
        "state": "hop" if motion.normal_force <= 0.0 else "slide" if motion.slides else "stick",
    }


def over_cycle(motion: TrackMotion, course: Cycle) -> Cells:
    """Return one period as columns.

    Parameters
    ----------
    motion : TrackMotion of shape (N,)
    course : Cycle

    Returns
    -------
    dict of str to array
    """
    columns = {
        **values(TRACK_CYCLE_COLUMNS, motion),
        "velocity_m_s": course.velocity,
        "friction_needed": motion.needed[:, 0],
        "opened": [
            "in flight" if state == HOP else " ".join(_open_contacts(pair))
            for state, pair in zip(motion.state, motion.closed)
        ],
    }
    return floor.samples(motion, course, columns)


def _open_contacts(is_closed: Bools) -> list[str]:
    return [name for name, shut in zip(CONTACT_NAMES[1:], is_closed) if not shut]


def document(study: TrackStudy) -> Document:
    """Return all of a part on the track as the JSON document; of one as published, print's reversal too.

    ``stays_on_wall`` is None where it hops: the flight is not followed.

    Parameters
    ----------
    study : TrackStudy

    Returns
    -------
    dict
        ``friction_needed`` holds the part at rest through the cycle.
    """
    cycle, seat, printed = study.cycle, study.seat, {}
    if study.printed is not None:
        printed = {"instant": _printed_instant(study.printed), "difference": _differences(study)}
        printed["omitted_terms"] = study.omitted_terms_table()  # type: ignore[attr-defined]
    places = seat.walls + np.array([0.0, 0.0, seat.height])
    sigma = np.degrees(np.arcsin(-seat.walls[:, 0] / study.bowl.track.radius))
    at_rest = np.isfinite(cycle.needed).all()
    needed = cycle.needed.max(axis=0).tolist() if at_rest else [np.nan] * len(CONTACT_NAMES)
    return {
        **values(TRACK_COLUMNS, study),
        "wall_contacts": [  # from the foot of the centre of mass
            {"name": name, "place_mm": place / MM, "sigma_deg": float(angle)}
            for name, place, angle in zip(CONTACT_NAMES[1:], places, sigma)
        ],
        "as_published": study.printed is not None,
        "regime": regime(cycle.state),
        "instant": _instant(study.now),
        **printed,
        "on_the_track": None if study.stands is None else study.stands.verdict,
        "on_the_track_said": None if study.stands is None else study.stands.sentence,
        **values(OPENING_COLUMNS, study.opening),
        "tipping_axis": values(TIPPING_AXIS_COLUMNS, study.opening),
        "friction_needed": dict(zip(CONTACT_NAMES, needed)),
        "held_across": study.held_across,
        "stays_on_wall": None if HOP in cycle.state else bool(cycle.closed.any(axis=-1).all()),
        "bank_without_radial_friction_deg": float(np.degrees(study.bank_without_radial_friction)),
        "mean_velocity_m_s": floor.mean_velocity(study),
        "settled": study.course.settled,
        "cycle": over_cycle(cycle, study.course),
        "bowl": bowls.texts(study.bowl.settings),
    }


def _differences(study: Any) -> Frame:
    return floor.difference(_printed_instant(study.printed), _instant(study.now), study.terms)


def summary(document: Mapping[str, Any]) -> Frame:
    """Return what people want to know first, a row a quantity.

    Parameters
    ----------
    document : mapping
        Of ``document``.

    Returns
    -------
    Frame
    """
    velocity, needed = document["mean_velocity_m_s"], document["friction_needed"]
    rows = floor.label_values(document, TRACK_LABELS) | {
        "on the track, over the strokes": document["on_the_track_said"],
        # not that of a point mass, of convey
        "velocity along the wall, with its friction and the bank [mm/s]": velocity and velocity / MM,
        "heading [deg]": document["heading_deg"],
    }
    # which contact a growing drive opens first, and when; or which carries nothing even at rest
    contact, factor = document["first_to_open"], document["opens_at_drive_factor"]
    if factor == 0.0:
        rows["carries nothing even at rest"] = contact.replace("_", " ")
    else:
        rows |= {"first contact to open": contact, "opens at this many times the drive": factor}
    stays = document["stays_on_wall"]
    rows["stays against the wall"] = "not known: it hops" if stays is None else stays
    rows |= {f"friction needed to hold it, {name.replace('_', ' ')}": needed[name] for name in CONTACT_NAMES}
    rows["bank without radial friction [deg]"] = document["bank_without_radial_friction_deg"]
    return floor.people_table(rows)


def remarks(study: TrackStudy) -> list[str]:
    """Return what a reader of a part on the track should know, a sentence each.

    Parameters
    ----------
    study : TrackStudy

    Returns
    -------
    list of str
    """
    lines, cycle = floor.aspect_remark(study), study.cycle
    if len(study.seat.contact) == 0:
        lines.append("a part card has no contact polygon: whether it tips is not known")
    if study.held_across:
        lines.append(
            "at rest at the upper reversal, friction across the track or up the wall can hold the part; by "
            "the least friction along the track, which the reactions show and the cycle follows, it would "
            "slide"
        )
    if HOP in cycle.state:
        lines.append(
            "the part loses contact within the cycle: its flight is not followed here, but by feeder convey; "
            "whether it stays against the wall is not known"
        )
    elif not cycle.closed.all():
        share = 100.0 * np.mean(~cycle.closed.all(axis=-1))
        opened = (name.replace("_", " ") for name in _open_contacts(np.all(cycle.closed, axis=0)))
        lines.append(f"a wall contact is open for {share:.0f} % of the cycle: {' and '.join(opened)}")
        # in 10 ms less than 1 rad/s2 is less than a hundredth of a degree
        if study.posture.kind != "rolling" and np.abs(cycle.turning).max() > 1.0:
            lines.append(
                "friction turns the part about the wall contact that is left; the velocity is that of a part "
                "that keeps its heading, and too high - feeder trial follows the turning"
            )
    if study.posture.kind == "rolling":
        lines.append("rolling aspect: held by the wall, its rolling about the axis is not followed")
    turn = np.degrees(study.seat.twist(study.bowl.track.bank))
    if abs(turn) > 1.0:
        lines.append(
            f"the wall contacts lie at different heights: banked, the part turns by about {turn:.2g} deg more"
        )
    if study.headings is not None and (over := study.headings.overhangs[study.row]) > 0.0:
        lines.append(f"the part overhangs the track's edge by {over / MM:.3g} mm")
    return lines


def cells(grid: Grid) -> Frame:
    """Return every cell of a grid as a frame.

    Parameters
    ----------
    grid : Grid
        Of ``TrackStudy.over``.

    Returns
    -------
    Frame
    """
    columns = grid.columns().items()
    cells = {IN_MM.get(name, name): x / MM if name in IN_MM else x for name, x in columns}
    axes = {axis.column: axis.head for axis in (grid.first, grid.second)}
    return Frame.of(cells, heads(TRACK_CYCLE_COLUMNS) | axes)


def map_remarks(grid: Grid) -> list[str]:
    """Return what a reader of a map should know, a sentence each.

    Parameters
    ----------
    grid : Grid
        Of ``TrackStudy.over``.

    Returns
    -------
    list of str
    """
    shares = grid.shares()
    lines = [] if shares["slide"] or shares["leaves the wall"] else [floor.none_slides(grid)]
    unfit = int(np.round(shares["does not fit"] * grid.codes.size))
    if unfit:
        lines.append(f"the part does not fit the track in {unfit} of {grid.codes.size} cells")
    return lines


def offers(study: TrackStudy, grid: Grid | None = None) -> list[offer.Offer]:
    """Offer the files of a part on the track.

    Parameters
    ----------
    study : TrackStudy
    grid : Grid, optional
        Of ``study.over``: its map is offered too.

    Returns
    -------
    list of Offer
    """
    what = "The part on the track from above and from behind, with the forces on it"
    heading = f"{np.degrees(study.seat.heading):.4g}°"
    title = f"{study.part.name}, aspect {study.posture.name}, heading {heading}"
    offered = [
        offer.document("track.json", document, study),
        offer.table("track_cycle.csv", over_cycle, study.cycle, study.course),
        offer.picture("track_part.png", what, part, study, title),
        offer.picture(
            "track_cycle.png", "Reactions over one cycle", _cycle, study.cycle, study.course, title
        ),
    ]
    if study.printed is not None:
        offered.append(offer.table("track_difference.csv", _differences, study))
        terms = study.omitted_terms_table  # type: ignore[attr-defined]
        offered.append(offer.table("track_omitted_terms.csv", terms))
    if grid is not None:
        labels = [axis.head.title for axis in (grid.first, grid.second)]
        over = " and ".join(label.partition(" [")[0] for label in labels)
        offered.append(offer.table("track_map.csv", cells, grid))
        alt = f"Acceleration along the track over {over}"
        offered.append(offer.picture("track_map.png", alt, _map, study, grid, labels, title))
    return offered


def _map(
    study: TrackStudy, grid: Grid, labels: Sequence[str], title: str, ax: "Axes | None" = None
) -> "Figure":
    own = []  # the bowl's own values in the units of the axes
    for axis in (grid.first, grid.second):
        key = next(key for key in bowls.schema.BOWL_KEYS if key.column == axis.column)
        own.append(attrgetter(key.field)(study.bowl) / key.share / axis.unit)
    return floor.regime_map(
        grid,
        "acceleration_x_m_s2",
        title=title,
        labels=labels,
        value="acceleration V'_X at the upper reversal [m/s²]",
        bowl_point=own,
        note=map_remarks(grid),
        ax=ax,
    )


def _cycle(motion: TrackMotion, course: Cycle, title: str) -> "Figure":
    figure, phase = style.figure(6.8, 6.4), floor.phases(course)
    upper, middle, lower = figure.subplots(3, 1, sharex=True)
    style.tidy(upper, title=title, y="force [N]")
    upper.plot(phase, motion.normal_force, color=NORMAL, label="normal force N")
    upper.plot(phase, motion.traction, color=FRICTION, label="traction R4")
    upper.set_ylim(top=1.28 * max(motion.normal_force.max(), 1e-12))
    style.tidy(middle, y="wall [N]")
    for k, color in enumerate(WALL_COLOURS):
        middle.plot(phase, motion.walls[:, k], color=color, label=f"R{k + 1}")
    middle.plot(phase, motion.radial_friction, color=NORMAL, linestyle="--", label="R3")
    style.tidy(lower, x="phase ωt [deg]; upper reversal at 90°", y="velocity [mm/s]")
    mean = f"{course.mean / MM:.3g} mm/s" if course.settled else "none: it gets faster"
    label = f"mean, with the\nwall's friction:\n{mean}"
    lower.plot(phase, course.velocity / MM, color="#2f7d5b", label=label)
    floor.dress_phases(figure, (upper, middle, lower), phase, motion.state)
    for axes in (upper, middle, lower):
        axes.axhline(0, color=style.INK, linewidth=0.8)
        axes.legend(**style.BESIDE)
    return figure


def part(study: TrackStudy, title: str) -> "Figure":
    """Draw the part on the track at the upper reversal, from above and from behind, with what acts on it.

    Parameters
    ----------
    study : TrackStudy
    title : str

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure = style.figure(11.0, 5.4)
    above, behind = figure.subplots(1, 2)
    text = f"{title}, upper reversal: {MOTION_STATES[int(study.now.state)]}; arrow length ∝ √force"
    figure.suptitle(text, x=0.01, ha="left", fontsize=11, color=style.INK, fontweight="bold")
    shape = study.posture.outline
    size = float(np.ptp(shape, axis=0).max()) if len(shape) else 0.02  # [m] of a card, which has no outline
    # inertial force of the drive in track axes
    drive, balance = study.bowl.drive, frame(study.bowl, study.seat.walls)
    push = study.seat.mass * drive.amplitude * (2.0 * np.pi * drive.frequency) ** 2 * balance.drive
    _draw_from_above(above, study, size, balance, push)
    _draw_from_behind(behind, study, size, balance, push)
    for axes in (above, behind):
        axes.set_aspect("equal")
        axes.margins(0.16)
        axes.tick_params(labelsize=8)
    return figure


def _draw_from_above(axes: "Axes", study: TrackStudy, size: float, balance: TrackAxes, push: Vector) -> None:
    seat, now, posture, track = study.seat, study.now, study.posture, study.bowl.track
    title = "from above, the wall below"
    style.tidy(axes, title=title, x="along the track [mm]", y="away from the wall [mm]", grid="none")
    centre = seat.walls[:, 1].mean() + np.sqrt(track.radius**2 - np.square(seat.walls[:, 0]).mean())
    reach = np.linspace(-0.75, 0.75, 121) * size / track.radius
    for line, end in zip(
        wall_and_edge(axes, track, centre, reach, (2.4, 1.2), 0.06 * size), ("wall", "edge")
    ):
        words, shift = ("bowl wall", (4, -14)) if end == "wall" else ("track edge", (4, 4))
        style.note(axes, words, (line[0][-1], line[1][-1]), shift, color=WALL, ha="right", va="bottom")
    if len(posture.outline):
        shape = turned(posture.outline, seat.heading) / MM
        polygon(axes, shape, linewidth=1.3)
        axes.plot(*shape.T, alpha=0)
        polygon(axes, seat.contact / MM, CONTACT, alpha=0.25, linewidth=1.0, zorder=3)
    draw = partial(_draw_force, axes, now, size)
    for k, color in enumerate(WALL_COLOURS):
        start = seat.walls[k, :2] / MM
        draw(start, balance.normals[k, :2], now.walls[k], f"R{k + 1}", color, is_push=True)
        draw(start, -balance.courses[k, :2], now.wall_friction[k], f"R{k + 1}f", color)
    foot = now.offset / MM if np.isfinite(now.offset).all() else np.zeros(2)
    draw(foot, np.array([-1.0, 0.0]), float(now.traction), "R4", FRICTION)
    draw(foot, np.array([0.0, 1.0]), float(now.radial_friction), "R3", FRICTION)
    draw(np.zeros(2), *_unit(push[:2]), "drive", DRIVE)
    if now.normal_force > 0.0 and np.isfinite(now.offset).all():
        axes.plot(*foot, "x", color=NORMAL, markersize=8, markeredgewidth=2, zorder=7)
    shading.centre_of_mass(axes, 0.02 * size / MM)


def wall_and_edge(
    axes: "Axes", track: Track, centre: float, reach: Floats, widths: tuple[float, float], depth: float
) -> list[tuple[Floats, Floats]]:
    """Draw the shaded wall and the free edge of a track.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
        In mm.
    track : Track
    centre : float [m]
        Of the axis of the bowl, inwards of the place that is drawn about.
    reach : (N,) array [rad]
        Angles about that centre over which they are drawn.
    widths : (float, float)
        Of the two lines, in points.
    depth : float [m]
        Of the shading behind the wall.

    Returns
    -------
    list of ((N,) array [mm], (N,) array [mm])
        Of the wall, then of the edge.
    """
    lines: list[tuple[Any, Any]] = []
    for radius, width in zip((track.radius, track.radius - track.width), widths):
        x, y = radius * np.sin(reach) / MM, (centre - radius * np.cos(reach)) / MM
        dashes: Any = (0, (5, 3)) if lines else "-"
        axes.plot(x, y, color=WALL, linewidth=width, linestyle=dashes, zorder=1)
        if not lines:
            axes.fill_between(x, y, y - depth / MM, color=WALL, alpha=0.35, linewidth=0, zorder=1)
        lines.append((x, y))
    return lines


def _draw_from_behind(axes: "Axes", study: TrackStudy, size: float, balance: TrackAxes, push: Vector) -> None:
    seat, now, bank = study.seat, study.now, float(study.bowl.track.bank)
    title = "from behind, the wall to the right"
    style.tidy(axes, title=title, x="towards the wall [mm]", y="up [mm]", grid="none")
    posture, track = study.posture, study.bowl.track
    at_wall = seat.walls[:, 1].mean()
    ends = np.array([[at_wall, -seat.height], [at_wall + track.width, -seat.height]])
    if posture.corners is not None:
        points = posture.corners - [0.0, 0.0, seat.height]
        across = np.column_stack([turned(points[:, :2], seat.heading)[:, 1], points[:, 2]])
        shape = outline(turned(across, bank)) * [-1.0, 1.0] / MM
        polygon(axes, shape, linewidth=1.3)
        axes.plot(*shape.T, alpha=0)
        on_floor = np.column_stack([seat.contact[:, 1], np.full(len(seat.contact), -seat.height)])
        low, high = on_floor[on_floor[:, 0].argmin()], on_floor[on_floor[:, 0].argmax()]
        span = turned(np.array([low, high]), bank) * [-1.0, 1.0] / MM
        axes.plot(*span.T, color=CONTACT, linewidth=3.5, solid_capstyle="butt", zorder=3)
    surface = turned(ends, bank) * [-1.0, 1.0] / MM
    touch = -float(turned(seat.walls[:, 1:], bank)[:, 0].min()) / MM
    slope = (surface[0] - surface[1]) / (surface[0, 0] - surface[1, 0])
    surface[0] = surface[0] + (touch - surface[0, 0]) * slope
    axes.plot(*surface.T, color=WALL, linewidth=2.4, zorder=1)
    wall = [surface[0, 1], surface[0, 1] + 0.9 * size / MM]
    axes.plot([touch, touch], wall, color=WALL, linewidth=2.4, zorder=1)
    draw = partial(_draw_force, axes, now, size)

    def place(point: ArrayLike) -> Vector:
        return turned(np.asarray(point)[1:], bank) * [-1.0, 1.0] / MM

    for k, color in enumerate(WALL_COLOURS):
        lift = np.array([0.0, 0.04 - 0.08 * k]) * size / MM  # or two reactions at one height hide each other
        towards = _unit(place(balance.normals[k]) * now.walls[k] * MM)
        draw(place(seat.walls[k]) + lift, *towards, f"R{k + 1}", color, is_push=True)
    foot = place(np.array([0.0, 0.0 if np.isnan(now.offset[1]) else now.offset[1], -seat.height]))
    draw(foot, *_unit(place([0, 0, 1.0]) * now.normal_force * MM), "N", NORMAL, side=1)
    draw(foot, *_unit(place([0, 1.0, 0]) * now.radial_friction * MM), "R3", FRICTION)
    draw(np.zeros(2), np.array([0.0, -1.0]), seat.mass * float(study.bowl.gravity), "weight", "#22303c")
    draw(np.zeros(2), *_unit(place(push) * MM), "drive", DRIVE, side=-1)
    shading.centre_of_mass(axes, 0.02 * size / MM)


def _draw_force(
    axes: "Axes",
    now: TrackMotion,
    size: float,
    start: Vector,
    direction: Vector,
    value: float,
    name: str,
    color: str,
    **look: Any,
) -> None:
    """Draw a force [N] along a unit vector, its length by the root of it; none that is next to nothing."""
    longest = max(float(now.normal_force), float(np.linalg.norm(now.load)), *now.walls)
    if abs(value) > 1e-3 * longest:
        step = np.sign(value) * (0.55 * size / MM) * np.sqrt(abs(value) / longest) * np.asarray(direction)
        floor.arrow(axes, start, step, f"{name} {floor.newtons(abs(value))}", color, **look)


def _unit(vector: Vector) -> tuple[Vector, float]:
    size = float(np.hypot(*vector))
    return (vector / size if size > 0.0 else np.zeros(2)), size


TRACK_VIEW = RecordView(track_text, offers, "track")
