"""Axes, loads and wall contacts of a part on the banked, climbing track.

Axes of the track: X ahead, Y in the surface from the wall towards the bowl's axis, Z up from the
surface; right-handed, so that the bowl climbs counter-clockwise seen from above. The wall is
upright; the surface is banked down towards it by delta and climbs by phi. Vectors are relative to the
centre of mass.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from feederscrew import check
from feederscrew.errors import FeederError
from feederscrew.geometry.polygons import turned

EDGE_DEPTH_SHARE = 1e-5  # of the part's size: corners above one another within this are one edge of its side


@dataclass(frozen=True, eq=False)
class Seat:
    """A part as it lies against the wall: what the equations of motion need of its geometry."""

    mass: float  # [kg]
    height: float  # [m] of the centre of mass over the surface
    heading: float  # [rad] of the body's own direction from X, counter-clockwise
    inertia: np.ndarray  # (3,) [kg m2] I_XZ, I_YZ, I_ZZ: what resists turning about Z
    walls: np.ndarray  # (2, 3) [m] wall contacts, the trailing one first
    contact: np.ndarray  # (K, 2) [m] contact polygon in track axes; (0, 2) of a card

    def twist(self, bank) -> float:
        """Return how far [rad] a bank turns the part, its higher wall contact leaning beyond the lower."""
        (x_1, _, z_1), (x_2, _, z_2) = self.walls
        return float(np.arctan2((z_1 - z_2) * np.tan(bank), x_2 - x_1))


@dataclass(frozen=True, eq=False)
class TrackAxes:
    """Directions in track axes, (..., 3) each; leading axes are those of the bowl's fields."""

    up: np.ndarray  # against gravity
    radial: np.ndarray  # level, towards the bowl's axis
    drive: np.ndarray  # of the vibration, forward and up
    normals: np.ndarray  # (..., 2, 3) of the wall at the two contacts, into the bowl
    courses: np.ndarray  # (..., 2, 3) in which each wall contact slides when the part moves on


def seat(posture, heading, touching, lean) -> Seat:
    """Return a mesh part in a heading against the wall.

    Source: docs/mechanics.md, "Headings"; the height of the contacts is own.

    Parameters
    ----------
    posture : Posture
    heading : float [rad]
    touching : (2, 2) float [m]
        Corners of the outline at the wall in track axes, from the foot of the centre of mass.
    lean : float [1]
        Sign of the bank: with it the upper end of an upright side touches the wall, against it the lower
        end; upright, the reaction may act anywhere between and is put halfway.

    Returns
    -------
    Seat
    """
    plan = turned(posture.corners[:, :2], heading)
    levels = [_level(plan, posture.corners[:, 2], point, lean) - posture.height for point in touching]
    i_xz, i_yz = turned(posture.inertia[2, :2], heading)
    return Seat(
        mass=posture.mass,
        height=posture.height,
        heading=heading,
        inertia=check.frozen(np.array([i_xz, i_yz, posture.inertia[2, 2]])),
        walls=check.frozen(np.column_stack([touching, levels])),
        contact=check.frozen(turned(posture.contact, heading)),
    )


def card_seat(posture) -> Seat:
    """Return the one seat that a part card prints, at heading 0.

    Parameters
    ----------
    posture : Posture
        Of a card with ``track`` data for this aspect.

    Returns
    -------
    Seat
        Wall contacts at the end of the printed lever. The signs of [4.29] put R1 behind the centre of mass
        and R2 ahead of it.

    Raises
    ------
    FeederError
        If the card has no such data.
    """
    block = (posture.printed or {}).get("track") or {}
    missing = [word for word in ("wall_lever", "wall_lever_angle", "wall_x") if word not in block]
    if missing:
        what = f"the card has no {missing[0]} for this aspect in its track block"
        mend = "choose the aspect that its track block names, or give the part as a mesh"
        raise FeederError(f"part card, aspect {posture.name}", what, mend)
    lever, angle, (behind, ahead) = block["wall_lever"], block["wall_lever_angle"], block["wall_x"]
    side, level = -lever * np.cos(angle), lever * np.sin(angle)
    return Seat(
        mass=posture.mass,
        height=posture.height,
        heading=0.0,
        inertia=posture.inertia[2],
        walls=check.frozen(np.array([[-behind, side, level], [ahead, side, level]])),
        contact=posture.contact,
    )


def frame(bowl, walls) -> TrackAxes:
    """Return the directions on the track of a bowl.

    Source: docs/mechanics.md, "Frames and signs".

    Parameters
    ----------
    bowl : Bowl
        Fields may be arrays.
    walls : (2, 3) float [m]
        Contacts with the wall.

    Returns
    -------
    TrackAxes
    """
    phi, delta, beta, alpha, radius = np.broadcast_arrays(
        bowl.track.climb, bowl.track.bank, bowl.drive.vibration_angle, bowl.drive.direction, bowl.track.radius
    )

    def banked(x, y, z) -> NDArray[np.float64]:
        """Track axes of a vector given along X, level towards the bowl's axis, and square to both."""
        along = x, y * np.cos(delta) + z * np.sin(delta), z * np.cos(delta) - y * np.sin(delta)
        return np.stack(np.broadcast_arrays(*along), axis=-1)

    up = banked(np.sin(phi), 0.0, np.cos(phi))
    ahead = banked(np.cos(phi), 0.0, -np.sin(phi))  # level
    radial = banked(0.0, 1.0, 0.0)
    drive = banked(np.cos(beta) * np.cos(alpha), np.cos(beta) * np.sin(alpha), np.sin(beta))
    behind = -np.einsum("...i,ki->...k", ahead, walls)  # of the centre of mass, level: climb and bank count
    sine = behind / radius[..., None]  # of sigma, positive at the trailing contact
    cosine = np.sqrt(1.0 - sine**2)
    normals = cosine[..., None] * radial[..., None, :] + sine[..., None] * ahead[..., None, :]
    level = cosine[..., None] * ahead[..., None, :] - sine[..., None] * radial[..., None, :]
    courses = np.cos(phi)[..., None, None] * level + np.sin(phi)[..., None, None] * up[..., None, :]
    return TrackAxes(up, radial, drive, normals, courses)


def loads(seat, bowl, axes, phase, speed=0.0, *, without_drive=False) -> NDArray[np.float64]:
    """Return weight, drive and centrifugal force on the part, all at its centre of mass.

    Source: the loads of eq. [4.29], with the centrifugal force of docs/mechanics.md, "The track".

    Parameters
    ----------
    seat : Seat
    bowl : Bowl
    axes : TrackAxes
    phase : array_like [rad]
        w t.
    speed : array_like [m/s]
        Of the part relative to the bowl; the bowl's own speed along the track is added to it.
    without_drive : bool
        Leave the vibration out, and with it the bowl's own speed.

    Returns
    -------
    (..., 3) float [N]
    """
    omega = 2.0 * np.pi * bowl.drive.frequency
    stroke = 0.0 * omega if without_drive else bowl.drive.amplitude * omega
    along = axes.drive[..., 0] * stroke * np.cos(phase) + speed
    push = (stroke * omega * np.sin(phase))[..., None] * axes.drive
    outward = (along**2 / bowl.track.radius)[..., None] * axes.radial
    return seat.mass * (push - np.asarray(bowl.gravity)[..., None] * axes.up - outward)


def bank_without_radial_friction(seat) -> float:
    """Return the bank [rad] at which the wall's reaction passes through the centre of mass: R3 is zero.

    Source: eqs. [4.33] and [4.35] with R3 = 0; docs/mechanics.md, "The track".
    """
    return float(np.mean(np.arctan2(seat.walls[:, 2], -seat.walls[:, 1])))


def _level(plan, levels, point, lean) -> float:
    """Height at which the edge of a side above ``point`` touches the wall."""
    size = np.ptp(plan, axis=0).max()
    there = levels[np.hypot(*(plan - point).T) <= EDGE_DEPTH_SHARE * size]
    if lean == 0.0:
        return 0.5 * (there.max() + there.min())
    return there.max() if lean > 0.0 else there.min()
