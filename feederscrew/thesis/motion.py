"""The thesis's equations of motion on floor and track as printed, and the terms that they leave out."""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from feederscrew.arrivals import floor as floor_study
from feederscrew.base.arrays import Array
from feederscrew.base.columns import Column, Frame, of_records
from feederscrew.base.geometry import vectors
from feederscrew.bowl.record import Bowl, BowlGrid
from feederscrew.motion.floor_balance import HOP, SLIDE, STICK, UPPER_REVERSAL, drive_force
from feederscrew.motion.limits import acceleration_ratio, published_limit
from feederscrew.motion.track_balance import Seat, TrackMotion, frame
from feederscrew.part.record import Part
from feederscrew.resting.posture import Posture
from feederscrew.sorting import track as track_study

Quantity = float | Array
FLOOR_TERMS = {  # quantity: what parts the printed from the complete value
    "normal_force_N": "none",
    "alignment_acceleration_rad_s2": "static friction, which holds a part at rest against turning",
    "limiting_friction": "the factor cos(alpha - theta): it needs a wall to take the force across",
    "acceleration_z_m_s2": "friction as a vector against the sliding: R_z = mu N cos(alpha - theta)",
    "acceleration_y_m_s2": "friction as a vector against the sliding: R_y",
    "normal_line_offset_mm": "inertia acts at the centre of mass, not in the contact plane at e [4.18]",
}
WALL_TERM = "radial gravity [4.33]; moment of the drive about X [4.35]; centripetal m V^2/r"
TRACK_TERMS = {
    "normal_force_N": "none of its own: it follows R1 + R2",
    "wall_1_N": WALL_TERM,
    "wall_2_N": WALL_TERM,
    "radial_friction_N": "d_y, offset of the normal force across the track, takes the moment about X",
    "traction_N": "friction as a vector where the part leaves the wall; else follows N",
    "normal_line_offset_mm": "inertia at the centre of mass; moment of wall friction about Y [4.36]",
    "acceleration_x_m_s2": "wall friction along the wall's tangent, turned by sigma",
}


@dataclass(frozen=True, eq=False)
class PrintedFloor:
    """Solution of the printed floor equations at one or many instants."""

    state: Array  # (...) int, places in floor.STATES; the print knows no tipping
    normal_force: Array  # (...) [N] F_N, negative where it says so
    turning: Array  # (...) [rad/s2] theta''
    acceleration: Array  # (..., 2) [m/s2] V'_z, V'_y
    offset: Array  # (...) [m] d along Z'
    limiting_friction: Array  # (...) [1]


@dataclass(frozen=True, eq=False)
class PrintedTrack:
    """Solution of the printed track equations; negative reactions are left as they come out."""

    normal_force: Array  # (...) [N] F_N
    walls: Array  # (..., 2) [N] R1, R2
    radial_friction: Array  # (...) [N] R3
    traction: Array  # (...) [N] R4
    offset: Array  # (...) [m] d
    acceleration: Array  # (...) [m/s2] V'_X
    slides: Array  # (...) bool


@dataclass(frozen=True)
class Levers:
    """Levers of a part that the printed track equations use."""

    mass: float  # [kg]
    height: float  # [m] h, of the centre of mass
    offset: float  # [m] e, of the drive ahead of the centre of mass
    wall: float  # [m] from the centre of mass to the wall contact, in the Y-Z plane
    wall_angle: float  # [rad] of that lever above the level
    behind: float  # [m] of the contact of R1 behind the centre of mass
    ahead: float  # [m] of the contact of R2 ahead of it
    side: float  # [m] of both contacts to the side
    friction_side: float  # [m] the same, as printed where it goes with wall friction
    axes: str = "tilted"  # as the Arc Chute's equations, or "level", as the Magnet's


@dataclass(frozen=True)
class Term:
    """A term that the printed track equations leave out."""

    name: str
    equation: str  # of the thesis
    value: float
    unit: str  # 'N' or 'N mm'


TERM_COLUMNS: tuple[Column[Term], ...] = (
    Column("name", lambda term: term.name),
    Column("equation", lambda term: term.equation),
    Column("value", lambda term: term.value),
    Column("unit", lambda term: term.unit),
)


@dataclass(frozen=True, eq=False, kw_only=True)
class FloorAsPublished(floor_study.FloorStudy):
    """A FloorStudy whose upper reversal, and each cell of its maps, is solved by print as well."""

    printed: PrintedFloor  # type: ignore[misc]
    terms = FLOOR_TERMS

    def cells(self, bowl: BowlGrid, heading: Quantity) -> dict[str, Array]:
        """Return what ``FloorStudy.cells`` does, and what print says of it as ``published_*``."""
        printed = solve_floor(self.posture, bowl, heading)
        return super().cells(bowl, heading) | {
            "published_z_m_s2": printed.acceleration[..., 0],  # goes on where the part has lost contact
            "published_alignment_rad_s2": printed.turning,
        }


@dataclass(frozen=True, eq=False, kw_only=True)
class TrackAsPublished(track_study.TrackStudy):
    """A TrackStudy whose upper reversal is solved by print as well."""

    printed: PrintedTrack  # type: ignore[misc]
    omitted_terms: tuple[Term, ...]  # what these leave out
    terms = TRACK_TERMS

    def omitted_terms_table(self) -> Frame:
        """Return the terms that the printed equations leave out, a row each: ``track_omitted_terms.csv``."""
        return of_records(TERM_COLUMNS, self.omitted_terms)


def floor(part: Part, bowl: Bowl, aspect: str | None = None, heading: float = 0.0) -> FloorAsPublished:
    """Study a part on the bowl's floor, by the complete equations and by the printed ones.

    Parameters
    ----------
    part : Part
    bowl : Bowl
    aspect : str, optional
        Its name; the likeliest without it.
    heading : float [rad]
        How it lies to the drive.

    Returns
    -------
    FloorAsPublished

    Raises
    ------
    FeederError
        As of ``arrivals.floor.floor``.

    References
    ----------
    ``arrivals.floor.floor`` and ``solve_floor``, each with its equations.
    """
    study = floor_study.floor(part, bowl, aspect, heading=heading)
    return FloorAsPublished(**vars(study), printed=solve_floor(study.posture, bowl, heading))


def track(
    part: Part, bowl: Bowl, aspect: str | None = None, heading: float | None = None
) -> TrackAsPublished:
    """Study a part against the wall, by the complete equations and by the printed ones.

    Parameters
    ----------
    part : Part
    bowl : Bowl
    aspect : str, optional
        Its name; the likeliest without it.
    heading : float [rad], optional
        As of ``sorting.track.track``.

    Returns
    -------
    TrackAsPublished

    Raises
    ------
    FeederError
        As of ``sorting.track.track``.

    References
    ----------
    ``sorting.track.track`` and ``solve_track``, each with its equations.
    """
    study = track_study.track(part, bowl, aspect, heading=heading)
    posture, seat = study.posture, study.seat
    card = {} if posture.corners is not None else (posture.printed or {})["track"]
    levers = levers_of(seat, float(posture.offset * np.cos(seat.heading)), card.get("axes", "tilted"))
    side = card.get("wall_y", levers.side)  # where a card prints other sides than its polar lever's
    levers = replace(levers, side=side, friction_side=card.get("wall_friction_y", side))
    return TrackAsPublished(
        **vars(study),
        printed=solve_track(levers, bowl, seat.heading),
        omitted_terms=omitted_terms(seat, bowl, study.now, levers.offset),
    )


def solve_floor(
    posture: Posture, bowl: BowlGrid, heading: Quantity, phase: Quantity = UPPER_REVERSAL
) -> PrintedFloor:
    """Solve the printed equations for a part at rest on the floor, with any part's h, e and I.

    R_z = mu F_N once the part slides; R_y, which the print leaves open, is zero. The moment of [4.18] is
    projected on fixed axes, as printed.

    Parameters
    ----------
    posture : Posture
        Of the part on its aspect: h, e and I.
    bowl : BowlGrid
        Its fields may be arrays that broadcast.
    heading : float or array [rad]
        theta.
    phase : float or array [rad]
        w t, of the drive.

    Returns
    -------
    PrintedFloor

    References
    ----------
    The thesis: the parts of the wrench of eq. [4.13], solved as eqs. [4.20] to [4.23]. With the levers and
    the inertia of the Magnet these are eqs. [4.43] to [4.53]. Steps in between: eqs. [4.14] to [4.18], [4.25]
    to [4.27].
    """
    m, h, e = posture.mass, posture.height, posture.offset
    beta, alpha = bowl.drive.vibration_angle, bowl.drive.direction
    ratio = acceleration_ratio(bowl.drive.amplitude, bowl.drive.frequency, bowl.gravity) * np.sin(phase)
    ahead, across, up = np.moveaxis(drive_force(m, bowl, heading, phase), -1, 0)
    normal = m * bowl.gravity - up  # eq. [4.14]
    limit = published_limit(ratio, beta, alpha - heading)  # eq. [4.27]
    slides = ~(np.abs(limit) <= bowl.friction.static) | (normal <= 0.0)  # eq. [4.25]
    friction = np.where(slides, np.sign(ahead) * bowl.friction.kinetic * normal, ahead)  # eq. [4.26]
    turning = e * across / posture.turning_inertia  # eq. [4.17]
    moment = np.cos(heading) * (e * up + h * drive_force(m, bowl, 0.0, phase)[..., 0])
    acceleration = np.broadcast_arrays((ahead - friction) / m, across / m)  # eqs. [4.15], [4.16]
    return PrintedFloor(
        state=np.where(normal > 0.0, np.where(slides, SLIDE, STICK), HOP),
        normal_force=normal,
        turning=turning,
        acceleration=np.stack(acceleration, axis=-1),
        offset=(h * friction - moment) / normal,  # eq. [4.18]
        limiting_friction=limit,
    )


def levers_of(seat: Seat, offset: float, axes: str = "tilted") -> Levers:
    """Return the printed equations' levers of any part against the wall.

    The two contacts' heights and sides are averaged, as the thesis has one of each.

    Parameters
    ----------
    seat : Seat
        Of the part against the wall.
    offset : float [m]
        e: the lever at which the print applies the drive.
    axes : str
        'tilted' by the bank, as the equations of the Arc Chute, or 'level', as those of the Magnet.

    Returns
    -------
    Levers
    """
    side, level = float(-seat.walls[:, 1].mean()), float(seat.walls[:, 2].mean())
    return Levers(
        mass=seat.mass,
        height=seat.height,
        offset=offset,
        wall=float(np.hypot(side, level)),
        wall_angle=float(np.arctan2(level, side)),
        behind=float(-seat.walls[0, 0]),
        ahead=float(seat.walls[1, 0]),
        side=side,
        friction_side=side,
        axes=axes,
    )


def solve_track(
    part: Levers, bowl: BowlGrid, heading: Quantity, phase: Quantity = 0.5 * np.pi
) -> PrintedTrack:
    """Solve the printed equations of a part against the wall.

    R4 = mu F_N while V'_X > 0; else V'_X = 0, and R4 is as much as that needs. In [4.36] the drive's moment
    is taken from [4.29], of which it is a copy with a term lost.

    Parameters
    ----------
    part : Levers
    bowl : BowlGrid
        Its fields may be arrays that broadcast; ``track.radius`` sets sigma.
    heading : float or array [rad]
        theta.
    phase : float or array [rad]
        w t, of the drive.

    Returns
    -------
    PrintedTrack

    References
    ----------
    The thesis, eqs. [4.32] to [4.37] (axes tilted by the bank) and eqs. [4.57] to [4.62] (level axes): the
    parts of the wrenches of eqs. [4.29], [4.54].
    """
    # the terms without unknowns: m A w^2 along X, level across, up; weight
    drive = np.moveaxis(drive_force(part.mass, bowl, heading, phase), -1, 0)
    fields = (bowl.track.bank, bowl.track.climb, bowl.track.radius, bowl.gravity, bowl.friction.kinetic)
    x, y, z = np.broadcast_arrays(*drive, *map(np.asarray, fields))[:3]
    delta, phi, weight = bowl.track.bank, bowl.track.climb, part.mass * bowl.gravity
    c, s, e, h = np.cos(delta), np.sin(delta), part.offset, part.height
    forces = {
        "tilted": (y * c + z * s, z * c - y * s - weight * np.cos(phi) * c),  # eqs. [4.33], [4.34]
        "level": (y, z - weight * np.cos(phi)),  # eqs. [4.58], [4.59]
    }[part.axes]
    about_y = e * z * c + h * x * c - e * y * s  # eqs. [4.29], [4.36], [4.61]
    about_z = -(e * z * s + h * x * s + e * y * c)  # eqs. [4.37], [4.62]
    along = x - weight * np.sin(phi)  # eqs. [4.32], [4.57]
    constants = np.stack(np.broadcast_arrays(along, *forces, 0.0, about_y, about_z), axis=-1)
    shape = constants.shape[:-1]
    sliding, rest = (vectors.solve(_matrix(part, bowl, shape, mode), -constants) for mode in (True, False))
    slides = sliding[..., 0] > 0.0
    friction = bowl.friction.kinetic * sliding[..., 1]
    unknowns = np.where(slides[..., None], sliding, rest)
    return PrintedTrack(
        normal_force=unknowns[..., 1],
        walls=unknowns[..., 2:4],
        radial_friction=unknowns[..., 4],
        traction=np.where(slides, friction, rest[..., 0]),
        offset=vectors.ratio(unknowns[..., 5], unknowns[..., 1]),
        acceleration=np.where(slides, unknowns[..., 0], 0.0),
        slides=slides,
    )


def _matrix(part: Levers, bowl: BowlGrid, shape: tuple[int, ...], slides: bool) -> Array:
    """Columns of V'_X (or R4), F_N, R1, R2, R3 and d F_N; (..., 6, 6)."""
    delta, sigma = np.asarray(bowl.track.bank), half_angle(part, bowl.track.radius)
    mu, wall = (bowl.friction.kinetic, bowl.friction.wall) if slides else (0.0, 0.0)
    c, s, h, cosine = np.cos(delta), np.sin(delta), part.height, np.cos(sigma)
    is_tilted, raised = part.axes == "tilted", part.wall * np.sin(part.wall_angle - delta)
    columns: list[tuple[Any, ...]] = [(-part.mass, 0, 0, 0, 0, 0) if slides else (-1.0, 0, 0, 0, -h, 0)]
    columns.append((-mu, 0, 1, 0, -h * mu, 0) if is_tilted else (-mu, -s, c, 0, -h * mu, 0))
    for sine, lever in ((np.sin(sigma), part.behind), (-np.sin(sigma), -part.ahead)):  # R1, R2
        across = (cosine * c, -cosine * s) if is_tilted else (cosine, 0.0)
        turning = lever * cosine + part.friction_side * wall - part.side * sine
        # eqs. [4.35], [4.60]; eqs. [4.36], [4.61]; eqs. [4.37], [4.62]
        about = (raised * cosine, -raised * sine * c + turning * s, raised * sine * s + turning * c)
        columns.append((sine - wall, *across, *about))
    columns += [(0, 1, 0, -h, 0, 0) if is_tilted else (0, c, s, -h, 0, 0), (0, 0, 0, 0, 1, 0)]
    stacked = [np.stack([np.broadcast_to(entry, shape) for entry in column], axis=-1) for column in columns]
    return np.stack(stacked, axis=-1)


def half_angle(part: Levers, radius: Quantity) -> Array:
    """Return half the angle between two contacts on a wall, sigma = asin((a + b) / (2 R)).

    The thesis leaves sigma open; this is the chord of both contacts on the wall's circle.

    Parameters
    ----------
    part : Levers
        a behind and b ahead of its centre of mass.
    radius : float or array [m]
        R of the wall, at least half the distance of both contacts.

    Returns
    -------
    (...) float [rad]
    """
    return np.arcsin(0.5 * (part.behind + part.ahead) / np.asarray(radius))


def omitted_terms(seat: Seat, bowl: Bowl, complete: TrackMotion, offset: float) -> tuple[Term, ...]:
    """Return the size of every term that the printed track equations leave out, at the upper reversal.

    Sizes are those of the complete solution. The centripetal force is that of the bowl's own greatest speed,
    at mid-stroke.

    Parameters
    ----------
    seat : Seat
        Of the part against the wall.
    bowl : Bowl
    complete : TrackMotion
        The complete solution.
    offset : float [m]
        e: the lever at which the print applies the drive.

    Returns
    -------
    tuple of Term
        In N or N mm, each with its equation.
    """
    axes, dragged = frame(bowl, seat.walls), complete.wall_friction
    drive, weight = bowl.drive, seat.mass * bowl.gravity
    speed = drive.amplitude * 2.0 * np.pi * drive.frequency * float(axes.drive[0])
    push = seat.mass * drive.amplitude * (2.0 * np.pi * drive.frequency) ** 2 * axes.drive
    sine = -seat.walls[:, 0] / bowl.track.radius
    less = 1.0 - np.sqrt(1.0 - sine**2)  # of a force turned by sigma
    height = float(vectors.dot(axes.up, seat.walls.mean(axis=0)))
    radial = -weight * np.cos(bowl.track.climb) * np.sin(bowl.track.bank)
    about_x = -1e3 * seat.height * float(vectors.dot(push, axes.radial))
    centripetal = seat.mass * speed**2 / bowl.track.radius
    drive_lever = seat.height * push[0] + offset * push[2]
    return (
        Term("radial gravity, -m g cos(phi) sin(delta)", "4.33", float(radial), "N"),
        Term("centripetal force at mid-stroke", "4.33, 4.58", centripetal, "N"),
        Term("wall friction turned by sigma, along X", "4.32, 4.57", float(vectors.dot(dragged, less)), "N"),
        Term("wall friction turned by sigma, along Y", "4.33, 4.58", float(vectors.dot(dragged, sine)), "N"),
        Term("moment of wall friction about Y", "4.36, 4.61", 1e3 * height * float(dragged.sum()), "N mm"),
        Term("moment of the drive about X", "4.35, 4.60", about_x, "N mm"),
        Term("drive at the contact plane, about Y", "4.36, 4.61", 1e3 * float(drive_lever), "N mm"),
    )
