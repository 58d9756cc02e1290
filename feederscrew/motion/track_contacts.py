"""The contacts of a part on the track: the first to open as the drive grows, and any static equilibrium.

The balance at rest takes the least friction, all along the track and the same share of its limit at every
contact. Where that would need more than there is, friction across the track, up and down the wall, or more
of it at one end of the part than at the other may still hold it.

Source: reciprocal screws; Coulomb's cones as a linear programme; docs/mechanics.md.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from feederscrew.base.arrays import Floats, Points
from feederscrew.base.columns import Column
from feederscrew.base.geometry.polygons import cross, sides
from feederscrew.base.geometry.vectors import ratio
from feederscrew.base.heavy import heavy
from feederscrew.base.signatures import Keywords
from feederscrew.bowl.record import Bowl
from feederscrew.motion import track_balance
from feederscrew.motion.floor_balance import HOP
from feederscrew.motion.screws import Point, Wrench, reactions, tipping_twists
from feederscrew.motion.track_balance import Seat, TrackAxes, frame, loads

optimize = heavy("scipy.optimize")

REVERSALS = {"upper": 0.5 * np.pi, "lower": 1.5 * np.pi}
IDLE = 1e-9  # of the weight: a reaction this small at rest carries nothing
THIRD = 2  # place of the third floor point among the six wrenches: three of these, two walls, traction
WALLS = {"wall_1": 3, "wall_2": 4}  # of the walls
CONE_SIDES = 64  # of the pyramid within a friction cone: its corners lie on it, its sides 0.12 % within
CONE_MARGIN = 1e-6  # of every coefficient, so that an equilibrium on the very limit is none


@dataclass(frozen=True, eq=False)
class Opening:
    """The contact that opens first; points from the foot of the centre of mass, in track axes."""

    contact: str  # 'floor', 'wall_1' or 'wall_2'; 'none'
    drive_factor: float  # [1] times the present amplitude at which it opens; infinite for none
    reversal: str  # 'upper' or 'lower'
    point: Floats  # (3,) [m] of the axis, nearest the centre of mass
    direction: Floats  # (3,) [1] of the axis
    pitch: float  # [m] slide along the axis per radian; infinite where the part only slides


OPENING_COLUMNS: tuple[Column[Opening], ...] = (
    Column("first_to_open", lambda opening: opening.contact),
    Column("opens_at_drive_factor", lambda opening: opening.drive_factor),
    Column("opens_at_reversal", lambda opening: opening.reversal),
)
TIPPING_AXIS_COLUMNS: tuple[Column[Opening], ...] = (
    Column("point_mm", lambda opening: opening.point, "mm"),
    Column("direction", lambda opening: opening.direction),
    Column("pitch_mm", lambda opening: opening.pitch, "mm"),
)


def contact_wrenches(
    seat: Seat,
    axes: TrackAxes,
    points: Points,
    *,
    floor: float = 0.0,
    wall: ArrayLike = (0.0, 0.0),
    traction: ArrayLike = (0.0, 0.0, 0.0),
) -> Wrench:
    """Return unit wrenches of six contacts about the centre of mass: three floor points, two walls, traction.

    Parameters
    ----------
    seat : Seat
    axes : TrackAxes
    points : (3, 2) float [m]
        Points of the floor, in track axes, from the foot of the centre of mass.
    floor : float [1]
        Friction at work over normal force at the floor, against motion along X; it turns the wrench off the
        normal.
    wall : (2,) array_like of float [1]
        The same at the two wall contacts.
    traction : (3,) array_like of float [m]
        Point of the last wrench's line, which runs along X. For a part at rest that is floor friction; for a
        sliding one it is the inertia of its motion along the track, through the centre of mass.

    Returns
    -------
    Wrench
        (6,) [1, m].

    References
    ----------
    Screws of unit forces; docs/method/screws.md, "Contacts: reciprocal screws".
    """
    feet = np.column_stack([points, np.full(3, -seat.height)])
    places = np.concatenate([feet, seat.walls, [traction]])
    pressing = axes.normals - np.asarray(wall)[:, None] * axes.courses
    forces = np.concatenate([np.tile([-floor, 0.0, 1.0], (3, 1)), pressing, [[1.0, 0.0, 0.0]]])
    return Wrench(forces, np.cross(places, forces), Point("C", np.zeros(3)))


def first_to_open(seat: Seat, bowl: Bowl) -> Opening:
    """Return the contact that a growing drive opens first, at either reversal; single values.

    A part that slides goes on sliding, one that sticks goes on sticking. Each reaction grows linearly with
    the drive, lambda_i = -(load o t_i) / (w_i o t_i), where t_i is the twist reciprocal to the five other
    wrenches. The axis is that of the twist reciprocal to the normals of the other four contacts and to the
    traction: the part tips or turns about it without sliding.

    Parameters
    ----------
    seat : Seat
    bowl : Bowl

    Returns
    -------
    Opening
        'none' with an infinite ``drive_factor`` [1] where no drive opens a contact.

    References
    ----------
    Reciprocal screws; docs/method/screws.md, "Contacts: reciprocal screws".
    """
    openings = [x for name, phase in REVERSALS.items() for x in _openings(seat, bowl, name, phase)]
    nowhere = np.full(3, np.nan)
    nothing = Opening("none", np.inf, "upper", nowhere, nowhere, np.nan)
    return min(openings, key=lambda opening: opening.drive_factor, default=nothing)


def _openings(seat: Seat, bowl: Bowl, reversal: str, phase: float) -> list[Opening]:
    """Return every contact that would open at one reversal."""
    now, axes = track_balance.motion(seat, bowl, phase), frame(bowl, seat.walls)
    driven = loads(seat, bowl, axes, phase)
    resting = loads(seat, bowl, axes, phase, without_drive=True)
    weight, openings = seat.mass * bowl.gravity, []
    on_floor = np.array([0.0, np.nan_to_num(now.offset[1]), -seat.height])
    # friction over normal force and the line of the traction, as the part slides or sticks
    wall = ratio(now.wall_friction, now.walls, 0.0)
    at_work: Keywords = {} if now.state == HOP else {"wall": wall}
    if now.state != HOP and now.slides:
        at_work["floor"] = float(now.traction / now.normal_force)
    elif now.state != HOP:
        at_work["traction"] = (0.0, float(now.offset[1]), -seat.height)
    if len(seat.contact) == 0:  # of a card: the walls' share does not depend on where the floor is touched
        triangles = [np.array([[-1.0, -1.0], [1.0, -1.0], [0.0, 1.0]]) * 1e-3]
    else:  # for each side of the contact polygon its two corners and the one farthest from it
        a, b = seat.contact, np.roll(seat.contact, -1, axis=0)
        farthest = a[cross(sides(a)[:, None], a - a[:, None]).argmax(axis=1)]
        triangles = list(np.stack([a, b, farthest], axis=1))
    for place, points in enumerate(triangles):
        six = contact_wrenches(seat, axes, points, **at_work)
        still, moving = (
            reactions(six, Wrench(load, np.zeros(3), Point("C", np.zeros(3)))) / weight
            for load in (resting, driven)
        )
        twists = tipping_twists(contact_wrenches(seat, axes, points, traction=on_floor))
        # to look at with one floor triangle: its third point, and with the first the walls
        watched = ({"floor": THIRD} if len(seat.contact) else {}) | ({} if place else WALLS)
        for name, k in watched.items():
            # the multiple of the drive at which the reaction is zero
            gain, factor = moving[k] - still[k], np.inf
            if still[k] < -IDLE:
                factor = 0.0
            elif gain < -IDLE:
                factor = max(still[k], 0.0) / -gain
            if np.isfinite(factor):
                point = twists[k].axis.foot + np.array([0.0, 0.0, seat.height])
                pitch = float(twists[k].pitch)
                openings.append(Opening(name, float(factor), reversal, point, twists[k].direction, pitch))
    return openings


def has_equilibrium(seat: Seat, bowl: Bowl, phase: float = 0.5 * np.pi) -> bool:
    """Return whether forces within the friction cones balance the load on a part at rest; single values.

    The floor presses at the corners of the contact polygon, the wall at its two contacts. Each cone is
    replaced by a pyramid inside it, so that the forces are sums of rays with factors that are not negative: a
    linear programme without an aim.

    Parameters
    ----------
    seat : Seat
    bowl : Bowl
    phase : float [rad]
        w t.

    Returns
    -------
    bool
        False also for a part card without a contact polygon, of which it is not known.

    References
    ----------
    Coulomb's cones as a linear programme; docs/mechanics.md, "The track".
    """
    if len(seat.contact) == 0:
        return False
    axes = frame(bowl, seat.walls)
    load = loads(seat, bowl, axes, phase) / (seat.mass * bowl.gravity)
    # edges of the friction pyramids as wrenches about the centre of mass; its height is the unit of length,
    # so that forces and moments have like sizes
    angle = 2.0 * np.pi * np.arange(CONE_SIDES) / CONE_SIDES
    around = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    static, wall = (mu * (1.0 - CONE_MARGIN) for mu in (bowl.friction.static, bowl.friction.wall))
    floor = np.column_stack([static * around, np.ones(CONE_SIDES)])
    feet = np.column_stack([seat.contact, np.full(len(seat.contact), -seat.height)])
    places, forces = [np.repeat(feet, CONE_SIDES, axis=0)], [np.tile(floor, (len(feet), 1))]
    for place, normal, course in zip(seat.walls, axes.normals, axes.courses):
        upward = np.cross(course, normal)
        tangents = around[:, :1] * course + around[:, 1:] * upward
        places.append(np.tile(place, (CONE_SIDES, 1)))
        forces.append(normal + wall * tangents)
    place, force = np.concatenate(places) / seat.height, np.concatenate(forces)
    rays = np.concatenate([force, np.cross(place, force)], axis=1)
    right = np.concatenate([-load, np.zeros(3)])
    return optimize.linprog(np.zeros(len(rays)), A_eq=rays.T, b_eq=right, method="highs").status == 0
