"""Pictures of a part on the track: from above, from behind, over a cycle."""

import numpy as np
from matplotlib.patches import Polygon

from feederscrew.geometry.polygons import outline, turned
from feederscrew.mechanics.floor.balance import MOTION_STATES
from feederscrew.mechanics.track.frame import frame
from feederscrew.output import style as plots
from feederscrew.output.floor.figures import CONTACT, DRIVE, FRICTION, NORMAL, PART, arrow, newtons
from feederscrew.output.floor.map_figures import phase_axis, state_band, state_legend
from feederscrew.output.solid import marks
from feederscrew.units import MM

WALL, SURFACE, WEIGHT = "#5d6b78", "#e9edf0", "#22303c"
SHADES = ("#b5482a", "#e08a3c")  # of R1 and R2
LONGEST = 0.55  # of the part's size: the longest arrow
LEAST = 1e-3  # of the longest: shorter arrows are left out
BARE = 0.02  # [m] size of a picture of a part card, which has no outline


def part(found, title):
    """The part on the track at the upper reversal, seen from above and from behind, with what acts on it.

    Parameters
    ----------
    found : TrackStudy
    title : str

    Returns
    -------
    Figure
    """
    figure = plots.figure(11.0, 5.4)
    above, behind = figure.subplots(1, 2)
    state = MOTION_STATES[int(found.now.state)]
    figure.suptitle(
        f"{title}, upper reversal: {state}; arrow length ∝ √force",
        x=0.01,
        ha="left",
        fontsize=11,
        color=plots.INK,
        fontweight="bold",
    )
    _above(above, found)
    _behind(behind, found)
    for axes in (above, behind):
        axes.set_aspect("equal")
        axes.margins(0.16)
        axes.tick_params(labelsize=8)
    return figure


def cycle(found, course, title):
    """Draw reactions and velocity over one settled period.

    Parameters
    ----------
    found : TrackMotion of shape (N,)
    course : Cycle
    title : str

    Returns
    -------
    Figure
    """
    figure = plots.figure(6.8, 6.4)
    upper, middle, lower = figure.subplots(3, 1, sharex=True)
    phase = np.linspace(0.0, 360.0, len(course.velocity), endpoint=False)
    plots.tidy(upper, title=title, y="force [N]")
    upper.plot(phase, found.normal_force, color=NORMAL, label="normal force N")
    upper.plot(phase, found.traction, color=FRICTION, label="traction R4")
    upper.set_ylim(top=1.28 * max(found.normal_force.max(), 1e-12))
    plots.tidy(middle, y="wall [N]")
    for k, color in enumerate(SHADES):
        middle.plot(phase, found.walls[:, k], color=color, label=f"R{k + 1}")
    middle.plot(phase, found.radial_friction, color=NORMAL, linestyle="--", label="R3")
    plots.tidy(lower, x="phase ωt [deg]; upper reversal at 90°", y="velocity [mm/s]")
    lower.plot(phase, course.velocity / MM, color="#2f7d5b", label=mean(course))
    for axes in (upper, middle, lower):
        phase_axis(axes)
        axes.axhline(0, color=plots.INK, linewidth=0.8)
        axes.legend(
            fontsize=8, frameon=False, loc="upper left", bbox_to_anchor=(1.0, 1.0), labelcolor=plots.INK
        )
    state_band(upper, phase, found.state, MOTION_STATES)
    state_legend(figure, found.state, MOTION_STATES)
    return figure


def mean(course):
    """Say the mean velocity of a cycle, and of what it is; a part that rolls or gets faster has none."""
    velocity = f"{course.mean / MM:.3g} mm/s" if course.settled else "none: it gets faster"
    return f"mean, with the\nwall's friction:\n{velocity}"


def _above(axes, found):
    """Across the track surface: X to the right, the wall below."""
    seat, now, posture = found.seat, found.now, found.posture
    plots.tidy(
        axes,
        title="from above, the wall below",
        x="along the track [mm]",
        y="away from the wall [mm]",
        grid="none",
    )
    size = _size(posture)
    _arcs(axes, found, size)
    if len(posture.outline):
        _body(axes, turned(posture.outline, seat.heading) / MM)
        _contact(axes, seat.contact / MM)
    side = frame(found.bowl, seat.walls)
    scale = _Scale(now, size)
    for k, color in enumerate(SHADES):
        start = seat.walls[k, :2] / MM
        scale.draw(axes, start, side.normals[k, :2], now.walls[k], f"R{k + 1}", color, pushing=True)
        scale.draw(axes, start, -side.courses[k, :2], now.wall_friction[k], f"R{k + 1}f", color)
    foot = now.offset / MM if np.isfinite(now.offset).all() else np.zeros(2)
    scale.draw(axes, foot, np.array([-1.0, 0.0]), now.traction, "R4", FRICTION)
    scale.draw(axes, foot, np.array([0.0, 1.0]), now.radial_friction, "R3", FRICTION)
    scale.draw(axes, np.zeros(2), *_unit(_drive(found)[:2]), "drive", DRIVE)
    if now.normal_force > 0.0 and np.isfinite(now.offset).all():
        axes.plot(*foot, "x", color=NORMAL, markersize=8, markeredgewidth=2, zorder=7)
    marks.centre_of_mass(axes, 0.02 * size / MM)


def _behind(axes, found):
    """Across the track: the wall to the right, up as gravity has it."""
    seat, now, posture = found.seat, found.now, found.posture
    plots.tidy(
        axes, title="from behind, the wall to the right", x="towards the wall [mm]", y="up [mm]", grid="none"
    )
    bank, size = float(found.bowl.track.bank), _size(posture)
    _section(axes, found, bank, size)
    scale = _Scale(now, size)

    def place(point):
        return turned(np.asarray(point)[1:], bank) * [-1.0, 1.0] / MM

    side = frame(found.bowl, seat.walls)
    for k, color in enumerate(SHADES):
        lift = np.array([0.0, 0.04 - 0.08 * k]) * size / MM  # or two reactions at one height hide each other
        push = _unit(place(side.normals[k]) * now.walls[k] * MM)
        scale.draw(axes, place(seat.walls[k]) + lift, *push, f"R{k + 1}", color, pushing=True)
    foot = np.array([0.0, 0.0 if np.isnan(now.offset[1]) else now.offset[1], -seat.height])
    scale.draw(axes, place(foot), *_unit(place([0, 0, 1.0]) * now.normal_force * MM), "N", NORMAL, beside=1)
    scale.draw(axes, place(foot), *_unit(place([0, 1.0, 0]) * now.radial_friction * MM), "R3", FRICTION)
    weight = seat.mass * float(found.bowl.gravity)
    scale.draw(axes, np.zeros(2), np.array([0.0, -1.0]), weight, "weight", WEIGHT)
    scale.draw(axes, np.zeros(2), *_unit(place(_drive(found)) * MM), "drive", DRIVE, beside=-1)
    marks.centre_of_mass(axes, 0.02 * size / MM)


class _Scale:
    """Arrows of one picture in one scale; their lengths go with the root of the force."""

    def __init__(self, now, size):
        self.longest = max(float(now.normal_force), float(np.linalg.norm(now.load)), *now.walls)
        self.length = LONGEST * size / MM

    def draw(self, axes, start, direction, value, name, color, **style):
        """One force of so many newtons along a unit vector; none where it is zero."""
        if abs(value) > LEAST * self.longest:
            step = np.sign(value) * self.length * np.sqrt(abs(value) / self.longest) * np.asarray(direction)
            arrow(axes, start, step, f"{name} {newtons(abs(value))}", color, **style)


def _size(posture):
    return float(np.ptp(posture.outline, axis=0).max()) if len(posture.outline) else BARE


def _drive(found):
    """Inertial force of the drive in track axes."""
    bowl = found.bowl
    push = found.seat.mass * bowl.drive.amplitude * (2.0 * np.pi * bowl.drive.frequency) ** 2
    return push * frame(bowl, found.seat.walls).drive


def _unit(vector) -> tuple[np.ndarray, float]:
    """Direction and size."""
    size = float(np.hypot(*vector))
    return (vector / size if size > 0.0 else np.zeros(2)), size


def _arcs(axes, found, size):
    """The wall and the track's free edge."""
    track, seat = found.bowl.track, found.seat
    centre = seat.walls[:, 1].mean() + np.sqrt(track.radius**2 - np.square(seat.walls[:, 0]).mean())
    reach = np.linspace(-0.75, 0.75, 121) * size / track.radius
    for radius, style in ((track.radius, "-"), (track.radius - track.width, (0, (5, 3)))):
        x, y = radius * np.sin(reach), centre - radius * np.cos(reach)
        axes.plot(
            x / MM, y / MM, color=WALL, linewidth=2.4 if style == "-" else 1.2, linestyle=style, zorder=1
        )
        if style == "-":
            axes.fill_between(
                x / MM, y / MM, y / MM - 0.06 * size / MM, color=WALL, alpha=0.35, linewidth=0, zorder=1
            )
        axes.annotate(
            "bowl wall" if style == "-" else "track edge",
            (x[-1] / MM, y[-1] / MM), (4, -14 if style == "-" else 4),
            textcoords="offset points", fontsize=8, color=WALL, ha="right", va="bottom",
        )  # fmt: skip


def _section(axes, found, bank, size):
    """Track, wall and part across the direction of travel."""
    seat, posture, track = found.seat, found.posture, found.bowl.track
    at_wall = seat.walls[:, 1].mean()
    ends = np.array([[at_wall, -seat.height], [at_wall + track.width, -seat.height]])
    if posture.corners is not None:
        points = posture.corners - [0.0, 0.0, seat.height]
        across = np.column_stack([turned(points[:, :2], seat.heading)[:, 1], points[:, 2]])
        _body(axes, outline(turned(across, bank)) * [-1.0, 1.0] / MM)
        on_floor = np.column_stack([seat.contact[:, 1], np.full(len(seat.contact), -seat.height)])
        low, high = on_floor[on_floor[:, 0].argmin()], on_floor[on_floor[:, 0].argmax()]
        span = turned(np.array([low, high]), bank) * [-1.0, 1.0] / MM
        axes.plot(*span.T, color=CONTACT, linewidth=3.5, solid_capstyle="butt", zorder=3)
    surface = turned(ends, bank) * [-1.0, 1.0] / MM
    touch = -float(turned(seat.walls[:, 1:], bank)[:, 0].min()) / MM
    surface[0] = surface[0] + (touch - surface[0, 0]) * (surface[0] - surface[1]) / (
        surface[0, 0] - surface[1, 0]
    )
    axes.plot(*surface.T, color=WALL, linewidth=2.4, zorder=1)
    axes.plot(
        [touch, touch], [surface[0, 1], surface[0, 1] + 0.9 * size / MM], color=WALL, linewidth=2.4, zorder=1
    )


def _body(axes, polygon):
    axes.add_patch(
        Polygon(polygon, closed=True, facecolor=PART, edgecolor=plots.INK, linewidth=1.3, zorder=2)
    )
    axes.plot(*polygon.T, alpha=0)


def _contact(axes, polygon):
    axes.add_patch(Polygon(polygon, closed=True, facecolor=CONTACT, edgecolor=CONTACT, alpha=0.25, zorder=3))
