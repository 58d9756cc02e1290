"""The thesis's equations of a part on the track, as printed, with their printed levers and omissions."""

from dataclasses import dataclass, replace

import numpy as np

from feederscrew.geometry import vectors
from feederscrew.part.card_schema import AXES

AS_PRINTED = AXES  # of the Arc Chute's and of the Magnet's equations


@dataclass(frozen=True)
class Levers:
    """What the printed equations know of a part."""

    mass: float  # [kg]
    height: float  # [m] h, of the centre of mass
    offset: float  # [m] e, of the drive ahead of the centre of mass
    wall: float  # [m] from the centre of mass to the wall contact, in the Y-Z plane
    wall_angle: float  # [rad] of that lever above the level
    behind: float  # [m] of the contact of R1 behind the centre of mass
    ahead: float  # [m] of the contact of R2 ahead of it
    beside: float  # [m] of both contacts to the side
    friction_beside: float  # [m] the same, as printed where it goes with wall friction
    axes: str = "tilted"  # one of AS_PRINTED


@dataclass(frozen=True, eq=False)
class PrintedTrack:
    """Solution of the printed equations; negative reactions are left as they come out."""

    normal_force: np.ndarray  # (...) [N] F_N
    walls: np.ndarray  # (..., 2) [N] R1, R2
    radial_friction: np.ndarray  # (...) [N] R3
    traction: np.ndarray  # (...) [N] R4
    offset: np.ndarray  # (...) [m] d
    acceleration: np.ndarray  # (...) [m/s2] V'_X
    slides: np.ndarray  # (...) bool


def levers(seat, offset, axes="tilted"):
    """Return the printed equations' levers of any part against the wall.

    Parameters
    ----------
    seat : Seat
        The two contacts' heights and sides are averaged, as the thesis has one of each.
    offset : float [m]
        e.
    axes : str
        One of ``AS_PRINTED``.

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
        beside=side,
        friction_beside=side,
        axes=axes,
    )


def printed_levers(found, track):
    """Return the same with the sides that a card prints in place of its polar lever's.

    Parameters
    ----------
    found : Levers
    track : dict of str to float
        The card's ``track`` block.
    """
    beside = track.get("wall_y", found.beside)
    return replace(found, beside=beside, friction_beside=track.get("wall_friction_y", beside))


def motion(part, bowl, heading, phase=0.5 * np.pi):
    """Solve the printed equations.

    Parameters
    ----------
    part : Levers
    bowl : Bowl
        Fields may be arrays; ``track.radius`` sets sigma.
    heading : array_like [rad]
        theta.
    phase : array_like [rad]
        w t.

    Returns
    -------
    PrintedTrack
        With R4 = mu F_N while V'_X > 0, else with V'_X = 0 and R4 as much as that needs.

    References
    ----------
    The thesis, eqs. [4.32] to [4.37] (axes tilted by the bank) and eqs. [4.57] to [4.62] (level axes): the
    parts of the wrenches of eqs. [4.29], [4.54]. In [4.36] the drive's moment is taken from [4.29], of which
    it is a copy with a term lost.
    """
    drive = _drive(part, bowl, heading, phase)
    known = _known(part, bowl, drive)
    x = _solved(_matrix(part, bowl, known.shape[:-1], sliding=True), known)
    slides = x[..., 0] > 0.0
    rest = _solved(_matrix(part, bowl, known.shape[:-1], sliding=False), known)
    friction = bowl.friction.kinetic * x[..., 1]
    x, traction = np.where(slides[..., None], x, rest), np.where(slides, friction, rest[..., 0])
    return PrintedTrack(
        normal_force=x[..., 1],
        walls=x[..., 2:4],
        radial_friction=x[..., 4],
        traction=traction,
        offset=np.divide(x[..., 5], x[..., 1], out=np.full(slides.shape, np.nan), where=x[..., 1] != 0.0),
        acceleration=np.where(slides, x[..., 0], 0.0),
        slides=slides,
    )


def half_angle(part, radius):
    """Return sigma [rad] of two contacts on a wall of that radius; the thesis leaves it open."""
    return np.arcsin(0.5 * (part.behind + part.ahead) / np.asarray(radius))


def _drive(part, bowl, heading, phase):
    """m A w^2 along X, level across, up, (..., 3)."""
    size = part.mass * bowl.drive.amplitude * (2.0 * np.pi * bowl.drive.frequency) ** 2 * np.sin(phase)
    beta, turn = bowl.drive.vibration_angle, bowl.drive.direction - heading
    along = (size * np.cos(beta) * np.cos(turn), size * np.cos(beta) * np.sin(turn), size * np.sin(beta))
    shape = (bowl.track.bank, bowl.track.climb, bowl.track.radius, bowl.gravity, bowl.friction.kinetic)
    return np.stack(np.broadcast_arrays(*along, *map(np.asarray, shape))[:3], axis=-1)


def _known(part, bowl, drive):
    """Return the terms without unknowns: three forces [N], three moments [N m], (..., 6)."""
    delta, phi, weight = bowl.track.bank, bowl.track.climb, part.mass * bowl.gravity
    x, y, z = np.moveaxis(drive, -1, 0)
    c, s = np.cos(delta), np.sin(delta)
    forces = {
        "tilted": (y * c + z * s, z * c - y * s - weight * np.cos(phi) * c),  # eqs. [4.33], [4.34]
        "level": (y, z - weight * np.cos(phi)),  # eqs. [4.58], [4.59]
    }[part.axes]
    h, e = part.height, part.offset
    about_y = e * z * c + h * x * c - e * y * s  # eqs. [4.29], [4.36], [4.61]
    about_z = -(e * z * s + h * x * s + e * y * c)  # eqs. [4.37], [4.62]
    along = x - weight * np.sin(phi)  # eqs. [4.32], [4.57]
    return np.stack(np.broadcast_arrays(along, *forces, 0.0, about_y, about_z), axis=-1)


def _matrix(part, bowl, shape, sliding):
    """Columns of V'_X (or R4), F_N, R1, R2, R3 and d F_N; (..., 6, 6)."""
    delta, sigma = np.asarray(bowl.track.bank), half_angle(part, bowl.track.radius)
    mu, wall = (bowl.friction.kinetic, bowl.friction.wall) if sliding else (0.0, 0.0)
    c, s, h = np.cos(delta), np.sin(delta), part.height
    first = (-part.mass, 0, 0, 0, 0, 0) if sliding else (-1.0, 0, 0, 0, -h, 0)
    normal = (-mu, 0, 1, 0, -h * mu, 0) if part.axes == "tilted" else (-mu, -s, c, 0, -h * mu, 0)
    radial = (0, 1, 0, -h, 0, 0) if part.axes == "tilted" else (0, c, s, -h, 0, 0)
    walls = [
        _wall(part, side, lever, delta, sigma, wall)
        for side, lever in ((1.0, part.behind), (-1.0, -part.ahead))
    ]
    columns = [first, normal, *walls, radial, (0, 0, 0, 0, 1, 0)]
    stacked = [np.stack([np.broadcast_to(entry, shape) for entry in column], axis=-1) for column in columns]
    return np.stack(stacked, axis=-1)


def _wall(part, side, lever, delta, sigma, wall):
    """Column of one wall reaction: ``side`` +1 for R1, -1 for R2."""
    c, s, raised = np.cos(delta), np.sin(delta), part.wall * np.sin(part.wall_angle - delta)
    cosine, sine = np.cos(sigma), side * np.sin(sigma)
    across = (cosine * c, -cosine * s) if part.axes == "tilted" else (cosine, 0.0)
    turning = lever * cosine + part.friction_beside * wall - part.beside * sine
    # eqs. [4.35], [4.60]; eqs. [4.36], [4.61]; eqs. [4.37], [4.62]
    about = (raised * cosine, -raised * sine * c + turning * s, raised * sine * s + turning * c)
    return (sine - wall, *across, *about)


def _solved(matrix, known):
    return vectors.solve(matrix, -known)
