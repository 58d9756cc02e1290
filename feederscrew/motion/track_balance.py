"""A part on the track against the bowl wall: axes, loads, reactions, acceleration and what gives way first.

Axes of the track: X ahead, Y in the surface from the wall towards the bowl's axis, Z up from the
surface; right-handed, so that the bowl climbs counter-clockwise seen from above. The wall is
upright; the surface is banked down towards it by delta and climbs by phi. Vectors are relative to the
centre of mass.

All is per unit of mass, with the height h of the centre of mass as unit of length. Friction acts where the
normal force N does, which keeps the equations linear in N, its moments N d_x and N d_y, and R1 and R2 of the
wall. Without N in the forces along X and Y, and without N d_x and N d_y in the moment about Z, they are those
of a motion in the plane of the floor: two forces and a turning moment of the load and of each wall contact.

Seven unknowns stand against six equations: the normal force acts at a point (d_x, d_y) of the contact
polygon. Sliding along X, Coulomb friction opposes the sliding, so R3 = 0 and d_y takes the moment about X
that the thesis gives to R3. At rest friction is not determined; see `solve_rest` for our choice.

Source: the thesis, wrench equations of chapter 5; docs/equations.md, docs/mechanics.md.
"""

import itertools
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from feederscrew.base import check
from feederscrew.base.arrays import Array, Bools, Floats, Ints, Points, Reals
from feederscrew.base.columns import Column
from feederscrew.base.errors import FeederError
from feederscrew.base.geometry.polygons import cross, inset, turned
from feederscrew.base.geometry.vectors import dot, ratio
from feederscrew.bowl.record import Bowl, BowlGrid
from feederscrew.motion import cycle
from feederscrew.motion.floor_balance import HOP, ON_THE_LINE, SLIDE, STICK, TIP, UPPER_REVERSAL
from feederscrew.resting.posture import Posture

EDGE_DEPTH_SHARE = 1e-5  # of the part's size: corners above one another within this are one edge of its side


@dataclass(frozen=True, eq=False)
class Seat:
    """A part as it lies against the wall: what the equations of motion need of its geometry."""

    mass: float  # [kg]
    height: float  # [m] of the centre of mass over the surface
    heading: float  # [rad] of the body's own direction from X, counter-clockwise
    inertia: Floats  # (3,) [kg m2] I_XZ, I_YZ, I_ZZ: what resists turning about Z
    walls: Floats  # (2, 3) [m] wall contacts, the trailing one first
    contact: Floats  # (K, 2) [m] contact polygon in track axes; (0, 2) of a card

    def twist(self, bank: float) -> float:
        """Return how far a bank turns the part about its lower wall contact.

        The higher contact leans beyond the lower one by its height times tan(bank).

        Parameters
        ----------
        bank : float [rad]

        Returns
        -------
        float [rad]
        """
        (x_1, _, z_1), (x_2, _, z_2) = self.walls
        return float(np.arctan2((z_1 - z_2) * np.tan(bank), x_2 - x_1))

    def inside(self, offset: Points) -> Floats:
        """Return how far points lie inside the contact polygon.

        Parameters
        ----------
        offset : (..., 2) float [m]
            From the foot of the centre of mass.

        Returns
        -------
        (...) float [m]
            Negative outside.
        """
        return inset(self.contact, offset)


@dataclass(frozen=True, eq=False)
class SeatStack:
    """M ways in which one part lies against the wall, their equations solved together at P instants.

    The second axis, of length one, is that of the instants. Results have the axes (M, P) first.
    """

    mass: float  # [kg]
    height: Floats  # (M, 1) [m]
    inertia: Floats  # (M, 1, 3) [kg m2]
    walls: Floats  # (M, 1, 2, 3) [m]
    contacts: tuple[Floats, ...]  # M polygons (K, 2) [m]

    @classmethod
    def of(cls, seats: Sequence[Seat]) -> "SeatStack":
        """Return one or more seats of one part as a stack."""
        height, inertia, walls = (
            np.array([getattr(seat, name) for seat in seats])[:, None]
            for name in ("height", "inertia", "walls")
        )
        return cls(seats[0].mass, height, inertia, walls, tuple(seat.contact for seat in seats))

    def inside(self, offset: Points) -> Floats:
        """Return how far (M, P) [m] points (M, P, 2) [m] lie inside the contact polygon of each."""
        return np.stack([inset(contact, points) for contact, points in zip(self.contacts, offset)])


AnySeat = Seat | SeatStack


@dataclass(frozen=True, eq=False)
class TrackAxes:
    """Directions in track axes, (..., 3) each; leading axes are those of the bowl's fields."""

    up: Floats  # against gravity
    radial: Floats  # level, towards the bowl's axis
    drive: Floats  # of the vibration, forward and up
    normals: Floats  # (..., 2, 3) of the wall at the two contacts, into the bowl
    courses: Floats  # (..., 2, 3) in which each wall contact slides when the part moves on


def seat(posture: Posture, heading: float, touching: Points, lean: float) -> Seat:
    """Return a mesh part in a heading against the wall.

    Parameters
    ----------
    posture : Posture
    heading : float [rad]
    touching : (2, 2) float [m]
        Corners of the outline at the wall, in track axes, from the foot of the centre of mass.
    lean : float [1]
        Sign of the bank. With the bank the upper end of an upright side touches the wall, against it the
        lower end. On a level track the reaction may act anywhere between them and is put halfway.

    Returns
    -------
    Seat

    References
    ----------
    docs/mechanics.md, "Headings"; the height of the contacts is own.
    """
    corners, levels = np.asarray(posture.corners), []
    plan = turned(corners[:, :2], heading)
    near = EDGE_DEPTH_SHARE * np.ptp(plan, axis=0).max()
    for point in touching:
        there = corners[np.hypot(*(plan - point).T) <= near, 2]
        low, high = there.min(), there.max()
        level = 0.5 * (high + low) if lean == 0.0 else high if lean > 0.0 else low
        levels.append(level - posture.height)
    i_xz, i_yz = turned(posture.inertia[2, :2], heading)
    return Seat(
        mass=posture.mass,
        height=posture.height,
        heading=heading,
        inertia=check.frozen(np.array([i_xz, i_yz, posture.inertia[2, 2]])),
        walls=check.frozen(np.column_stack([touching, levels])),
        contact=check.frozen(turned(posture.contact, heading)),
    )


def card_seat(posture: Posture) -> Seat:
    """Return the one seat that a part card prints for this aspect, at heading 0.

    Wall contacts are at the end of the printed lever. The signs of [4.29] put R1 behind the centre of
    mass and R2 ahead of it.

    Parameters
    ----------
    posture : Posture

    Returns
    -------
    Seat

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


def frame(bowl: BowlGrid, walls: Floats) -> TrackAxes:
    """Return the directions on the track of a Bowl.

    Parameters
    ----------
    bowl : BowlGrid
        Fields may be arrays that broadcast.
    walls : (..., 2, 3) float [m]
        Wall contacts of a Seat.

    Returns
    -------
    TrackAxes
        Unit vectors [1].

    References
    ----------
    docs/mechanics.md, "Frames and signs".
    """
    phi, delta, beta, alpha, radius = np.broadcast_arrays(
        bowl.track.climb, bowl.track.bank, bowl.drive.vibration_angle, bowl.drive.direction, bowl.track.radius
    )

    def banked(x: Reals, y: Reals, z: Reals) -> Floats:
        """Return in track axes a vector given along X, level towards the bowl's axis, and square to both."""
        along = x, y * np.cos(delta) + z * np.sin(delta), z * np.cos(delta) - y * np.sin(delta)
        return np.stack(np.broadcast_arrays(*along), axis=-1)

    up = banked(np.sin(phi), 0.0, np.cos(phi))
    ahead = banked(np.cos(phi), 0.0, -np.sin(phi))  # level
    radial = banked(0.0, 1.0, 0.0)
    drive = banked(np.cos(beta) * np.cos(alpha), np.cos(beta) * np.sin(alpha), np.sin(beta))
    # The wall is a circle, so its normal at a contact is turned by sigma, sin(sigma) = (how far the contact
    # lies behind the centre of mass) / radius. That distance is level: climb and bank count.
    behind = -np.einsum("...i,...ki->...k", ahead, walls)
    sine = behind / radius[..., None]  # of sigma, positive at the trailing contact
    cosine = np.sqrt(1.0 - sine**2)
    normals = cosine[..., None] * radial[..., None, :] + sine[..., None] * ahead[..., None, :]
    level = cosine[..., None] * ahead[..., None, :] - sine[..., None] * radial[..., None, :]
    courses = np.cos(phi)[..., None, None] * level + np.sin(phi)[..., None, None] * up[..., None, :]
    return TrackAxes(up, radial, drive, normals, courses)


def loads(
    seat: AnySeat,
    bowl: BowlGrid,
    axes: TrackAxes,
    phase: Reals,
    speed: Reals = 0.0,
    *,
    without_drive: bool = False,
) -> Floats:
    """Return weight, drive and centrifugal force on the part, all at its centre of mass.

        F = m (A w^2 sin(w t) d - g u - (v + A w cos(w t) d_x)^2 / r e)

    with d the direction of the drive, u upwards, and e towards the bowl's axis.

    Parameters
    ----------
    seat : Seat or SeatStack
    bowl : BowlGrid
    axes : TrackAxes
    phase : float or (...) float [rad]
        w t.
    speed : float or (...) float [m/s]
        v of the part relative to the bowl; the bowl's own speed along the track is added.
    without_drive : bool
        Leave the vibration out, and with it the bowl's own speed.

    Returns
    -------
    (..., 3) float [N]
        In track axes.

    References
    ----------
    The loads of eq. [4.29], with the centrifugal force of docs/mechanics.md, "The track".
    """
    omega = 2.0 * np.pi * bowl.drive.frequency
    stroke = 0.0 * omega if without_drive else bowl.drive.amplitude * omega
    along = axes.drive[..., 0] * stroke * np.cos(phase) + speed
    push = (stroke * omega * np.sin(phase))[..., None] * axes.drive
    outward = (along**2 / bowl.track.radius)[..., None] * axes.radial
    return seat.mass * (push - np.asarray(bowl.gravity)[..., None] * axes.up - outward)


def bank_without_radial_friction(seat: Seat) -> float:
    """Return the bank at which R3 of eqs. [4.33], [4.35] is zero.

    The wall's reaction then passes through the centre of mass.

    Parameters
    ----------
    seat : Seat

    Returns
    -------
    float [rad]

    References
    ----------
    docs/mechanics.md, "The track".
    """
    return float(np.mean(np.arctan2(seat.walls[:, 2], -seat.walls[:, 1])))


Closed = tuple[bool, bool]  # which wall contacts press, the trailing one first
SETS = ((True, True), (True, False), (False, True), (False, False))  # closed wall contacts, in order of trial
HELD_SLIP_SHARE = 1e-6  # [1] of the slip of a part that nothing holds: less than this is none
ALONG_X = np.array([1.0, 0.0])


@dataclass(frozen=True, eq=False)
class TrackSolution:
    """Accelerations and reactions for one set of closed contacts, per unit of mass."""

    acceleration: Floats  # (..., 2) [m/s2] along X and Y
    turning: Floats  # (...) [m/s2] theta'' times h
    normal: Floats  # (...) [m/s2]
    moments: Floats  # (..., 2) [m/s2] N d / h
    walls: Floats  # (..., 2) [m/s2] R1, R2
    friction: Floats  # (..., 2) [m/s2] of the floor on the part
    couple: Floats  # (...) [m/s2] about Z that the floor holds against turning, over h
    mobilised: Floats  # (...) [1] friction over normal force along X, signed against motion ahead
    parting: Floats  # (..., 2) [m/s2] at which each wall contact opens


def solve_sliding(
    seat: AnySeat,
    axes: TrackAxes,
    load: Floats,
    closed: Closed,
    floor: Reals,
    wall: Reals,
    course: Floats = ALONG_X,
) -> TrackSolution:
    """Return accelerations and reactions of a sliding part: the wrench equations.

    They are the complete form of eqs. [4.32] to [4.37] and eqs. [4.57] to [4.62]. With the floor's friction
    put at the normal force, three of the six equations hold only R1, R2 and the motion in the plane of the
    floor; the other three then give N and the place where it acts.

    Parameters
    ----------
    seat : Seat or SeatStack
    axes : TrackAxes
    load : (..., 3) float [N]
        Everything that acts but the contacts.
    closed : (bool, bool)
        Which wall contacts press, the trailing one first.
    floor : float or (...) float [1]
        Coefficient of friction at the floor, negative where the part slides back.
    wall : float or (...) float [1]
        The same at the wall.
    course : (..., 2) float [1]
        Direction of positive sliding on the floor.

    Returns
    -------
    TrackSolution
        Per unit of mass [m/s2]; not finite where the equations are singular.

    References
    ----------
    The thesis, eqs. [4.32] to [4.37] and eqs. [4.57] to [4.62]; docs/mechanics.md, "The track".
    """
    slide = _Slide(seat, axes, load, floor, course)
    acting, walls, across, turning = slide.motion(closed, np.asarray(wall, dtype=float))
    parting = slide.rates[..., 0] * across[..., None] + slide.rates[..., 1] * turning[..., None]
    friction = slide.drag * acting.normal(walls)[..., None]
    return acting.solution(walls, (across, turning), slide.inertia, friction, 0.0, floor, parting)


def solve_rest(
    seat: AnySeat, axes: TrackAxes, load: Floats, closed: Closed, wall_share: Reals
) -> TrackSolution:
    """Return the reactions of a part at rest: least friction, one share of its limit at every contact.

    Forces at rest are not determined by the equations: there are seven unknowns and six of them. This choice
    goes over into sliding without a jump. A part that the wall does not hold across the track, or against
    turning, is held by the floor.

    Parameters
    ----------
    seat : Seat or SeatStack
    axes : TrackAxes
    load : (..., 3) float [N]
    closed : (bool, bool)
        Which wall contacts press, the trailing one first.
    wall_share : float or (...) float [1]
        Coefficient of the wall over that of the floor.

    Returns
    -------
    TrackSolution
        Per unit of mass; ``mobilised`` [1] is the coefficient that the floor needs along the track.

    References
    ----------
    The equations of ``solve_sliding`` with a choice of friction; docs/mechanics.md, "The track".
    """
    (normals, courses), force = _pushes(seat, axes), load / seat.mass

    def acting_at(mobilised: Floats) -> "_Acting":
        pushes = normals - (mobilised * wall_share)[..., None, None] * courses
        return _Acting(force, pushes, -mobilised[..., None] * ALONG_X)

    def slip(mobilised: Floats) -> tuple[Floats, Floats]:
        """Return the force left over along X times the divisor of the reactions, and that divisor."""
        acting = acting_at(mobilised)
        shares, divisor = acting.shares(closed, np.zeros(2))
        return acting.pull[..., 0] * divisor + dot(acting.planar[..., 0], shares), divisor

    # Find the friction over normal force that leaves no force along the track. Multiplied by the divisor the
    # function has no pole, so the secant rule is safe. Where friction at the wall grows without bound before
    # the slip is held, the divisor changes sign: then the floor alone counts, which is the first guess.
    unslid = np.zeros(force.shape[:-1])
    unheld, divisor = slip(unslid)
    guess = ratio(unheld, divisor) / np.maximum(-force[..., 2], 1e-3 * np.abs(force).max() + 1e-30)
    root = _zero(
        lambda mobilised: slip(mobilised)[0],
        unslid,
        unheld,
        guess,
        lambda after, step: after - np.clip(step, -10.0, 10.0),
    )
    left, divisor_there = slip(root)
    holds = (np.abs(left) <= HELD_SLIP_SHARE * np.abs(unheld)) & (root * guess >= 0.0)
    mobilised = np.where(holds & (divisor_there * divisor > 0.0), root, guess)
    acting = acting_at(mobilised)
    walls = acting.reactions(closed, np.zeros(2))  # they leave no motion across and no turning
    nothing = np.zeros(walls.shape[:-1])
    across = nothing if any(closed) else -acting.left_over(walls, 1)
    friction = np.stack([-mobilised * acting.normal(walls), across], axis=-1)
    couple = nothing if all(closed) else 0.0 - dot(acting.yaws, walls)
    parting = np.zeros((*np.shape(couple), 2))
    if sum(closed) == 1:  # how the open contact would part if the floor let go of the couple it holds
        shut, open_ = closed.index(True), closed.index(False)
        opening, turning = np.moveaxis(_gap_rates(seat, axes), -1, 0)
        shift = turning[..., shut] / opening[..., shut] * opening[..., open_]  # which keeps the other closed
        parting[..., open_] = -couple * (turning[..., open_] - shift)
    return acting.solution(walls, (nothing, nothing), np.zeros(3), friction, couple, mobilised, parting)


def _zero(
    slip: Callable[[Floats], Floats],
    before: Floats,
    slip_before: Floats,
    after: Floats,
    stepped: Callable[[Floats, Floats], Floats],
) -> Floats:
    """Return a zero of a function: the secant rule from two guesses; ``stepped`` keeps a step in bounds."""
    for _ in range(14):  # they are nearly straight
        if np.array_equal(before, after, equal_nan=True):  # it would stay there
            break
        slip_after = slip(after)
        change = slip_after - slip_before
        step = ratio(slip_after * (after - before), change, 0.0)
        before, slip_before, after = after, slip_after, stepped(after, step)
    return after


def wall_use(
    seat: AnySeat,
    axes: TrackAxes,
    load: Floats,
    closed: Closed,
    floor: Reals,
    ahead: Floats,
    course: Floats,
    turns: Bools,
) -> Floats:
    """Return friction over normal force at the one closed wall contact of a part that begins to turn.

    A part that turns moves that contact itself. The contact slides with the part, or turning drives it the
    other way, or friction between the two limits keeps it in place: the part then rolls along the wall.

    Parameters
    ----------
    seat : Seat or SeatStack
    axes : TrackAxes
    load : (..., 3) float [N]
    closed : (bool, bool)
        One of them.
    floor : float or (...) float [1]
    ahead : (...) float [1]
        Coefficient at the wall where the contact slides with the part, negative where the part slides back.
    course : (..., 2) float [1]
    turns : (...) bool
        Where the part starts from rest; elsewhere it goes on sliding and ``ahead`` is kept.

    Returns
    -------
    (...) float [1]
        Between ``ahead`` and its opposite.

    References
    ----------
    The equations of ``solve_sliding`` with one wall contact.
    """
    slide, k = _Slide(seat, axes, load, floor, course), closed.index(True)
    along = axes.courses[..., k, :2]
    lever, limit = cross(seat.walls[..., k, :2] / _widen(seat.height, 1), along), np.abs(ahead)

    def slip(use: Floats) -> Floats:
        """Return the acceleration of the contact along the wall."""
        acting, walls, across, turning = slide.motion(closed, use)
        return acting.left_over(walls, 0) * along[..., 0] + across * along[..., 1] + turning * lever

    use = _zero(slip, -ahead, slip(-ahead), ahead, lambda after, step: np.clip(after - step, -limit, limit))
    return np.where(turns, use, ahead)


class _Slide:
    """A part that slides on the floor; ``drag`` (..., 2) is the floor's friction for a normal force of 1."""

    def __init__(self, seat: AnySeat, axes: TrackAxes, load: Floats, floor: Reals, course: Floats) -> None:
        self.pushes, self.rates, self.force = _pushes(seat, axes), _gap_rates(seat, axes), load / seat.mass
        self.drag = -np.asarray(floor, dtype=float)[..., None] * course
        self.inertia = seat.inertia / (seat.mass * _widen(seat.height, 1) ** 2)
        self.resists = dot(self.drag, self.inertia[..., :2]) + self.inertia[..., 2]
        self.give = self.rates[..., 1] / (self.rates[..., 0] * self.resists[..., None])

    def motion(self, closed: Closed, use: Floats) -> tuple["_Acting", Floats, Floats, Floats]:
        """Return what acts, the wall's reactions and the accelerations across the track and in turning."""
        normals, courses = self.pushes
        acting = _Acting(self.force, normals - use[..., None, None] * courses, self.drag)
        walls = acting.reactions(closed, self.give)
        if all(closed):
            nothing = np.zeros(walls.shape[:-1])
            return acting, walls, nothing, nothing
        return acting, walls, acting.left_over(walls, 1), dot(acting.yaws, walls) / self.resists


def _pushes(seat: AnySeat, axes: TrackAxes) -> tuple[Floats, ...]:
    """Return wrenches (..., 2, 6) of forces of 1 at the wall's contacts, along normals and courses."""
    arms = seat.walls / _widen(seat.height, 2)
    normals, courses = (
        np.concatenate([force, np.cross(arms, force)], axis=-1) for force in (axes.normals, axes.courses)
    )
    return normals, courses


class _Acting:
    """A load (..., 3), wrenches of the wall's contacts (..., 2, 6) and the floor's drag, N eliminated.

    Friction of the floor is N times the drag, and N follows from the forces along Z. Put into the forces
    along X and Y and the moment about Z, this leaves ``pull`` (load), ``planar`` and ``yaws`` (wall
    contacts).
    """

    def __init__(self, force: Floats, pushes: Floats, drag: Floats) -> None:
        self.force, self.pushes = force, pushes
        self.pull = force[..., :2] - drag * force[..., 2:]
        self.planar = pushes[..., :2] - drag[..., None, :] * pushes[..., 2:3]
        self.yaws = dot(pushes[..., 3:5], drag[..., None, :]) + pushes[..., 5]

    def reactions(self, closed: Closed, give: Floats) -> Floats:
        """Return R1 and R2, (..., 2), at which the closed contacts stay closed.

        ``give`` (..., 2) is how fast a contact opens for a unit of turning moment over how fast for a unit of
        force across the track: zero where the part is kept from turning.
        """
        shares, divisor = self.shares(closed, give)
        return ratio(shares, divisor[..., None])

    def shares(self, closed: Closed, give: Floats) -> tuple[Floats, Floats]:
        """Return R1 and R2 times the divisor that they have in common, (..., 2), and that, (...)."""
        across, pull = self.planar[..., 1], -self.pull[..., 1]
        shares = np.zeros(np.broadcast_shapes(across.shape, (*pull.shape, 1)))
        if all(closed):
            shares[..., 0], shares[..., 1] = pull * self.yaws[..., 1], -pull * self.yaws[..., 0]
            return shares, across[..., 0] * self.yaws[..., 1] - across[..., 1] * self.yaws[..., 0]
        if any(closed):
            k = closed.index(True)
            shares[..., k] = pull
            return shares, (across + give * self.yaws)[..., k]
        return shares, np.ones(shares.shape[:-1])

    def left_over(self, walls: Floats, axis: int) -> Floats:
        """Return the sum of the forces along X or Y, (...)."""
        return self.pull[..., axis] + dot(self.planar[..., axis], walls)

    def normal(self, walls: Floats) -> Floats:
        """Return the floor's normal force N, (...)."""
        return -(self.force[..., 2] + dot(self.pushes[..., 2], walls))

    def solution(
        self,
        walls: Floats,
        motion: tuple[Floats, Floats],
        inertia: Floats,
        friction: Floats,
        couple: Reals,
        mobilised: Reals,
        parting: Floats,
    ) -> TrackSolution:
        """Return the record, with the moments of N that the moments about X and Y ask for."""
        across, turning = motion
        about_x, about_y = (dot(self.pushes[..., place], walls) for place in (3, 4))
        ahead = about_y - inertia[..., 1] * turning - friction[..., 0]
        offset_moment = inertia[..., 0] * turning - about_x - friction[..., 1]
        shape = walls.shape[:-1]
        return TrackSolution(
            acceleration=np.stack([self.left_over(walls, 0), across], axis=-1),
            turning=turning,
            normal=self.normal(walls),
            moments=np.stack([ahead, offset_moment], axis=-1),
            walls=walls,
            friction=friction,
            couple=np.broadcast_to(couple, shape),
            mobilised=np.broadcast_to(mobilised, shape),
            parting=parting,
        )


def _gap_rates(seat: AnySeat, axes: TrackAxes) -> Floats:
    """Return how fast each wall contact opens for an acceleration along Y and a turning, (..., 2, 2)."""
    lever = cross(seat.walls[..., :2] / _widen(seat.height, 2), axes.normals[..., :2])
    return np.stack([axes.normals[..., 1], lever], axis=-1)


def _widen(values: Reals, axes: int) -> Floats:
    """Return values with so many more axes, of length one, at the end."""
    return np.asarray(values)[(..., *[None] * axes)]


PULL_TOLERANCE = 1e-9  # of the weight: a reaction more negative than this would be a pull
FORCE_NOISE = 1e-12  # of the weight: less than this is rounding
PHASE_TOLERANCE = 1e-13  # [rad] width of the bracket in which a part breaks loose
UNBOUNDED_FRICTION = 1e9  # [1] friction in place of one that is not finite


@dataclass(frozen=True, eq=False)
class TrackMotion:
    """State of a part on the track at one or many instants; forces of the bowl on the part, in track axes."""

    state: Ints  # (...) int, places in MOTION_STATES
    normal_force: Floats  # (...) [N]; 0 while there is no contact
    walls: Floats  # (..., 2) [N] R1, R2; 0 where opened
    closed: Bools  # (..., 2) bool, whether each wall contact stays closed
    radial_friction: Floats  # (...) [N] R3, of the floor along Y
    traction: Floats  # (...) [N] R4, of the floor against motion along X
    wall_friction: Floats  # (..., 2) [N] R1f, R2f against motion along the wall
    couple: Floats  # (...) [N m] with which the floor keeps a part at rest from turning
    acceleration: Floats  # (..., 2) [m/s2] relative to the bowl along X and Y
    turning: Floats  # (...) [rad/s2] theta'', counter-clockwise; not 0 only where a contact has opened
    offset: Floats  # (..., 2) [m] d_x, d_y of the normal force from the foot of the centre of mass
    inside: Floats  # (...) [m] of that point within the contact polygon; negative: it tips
    needed: Floats  # (..., 3) [1] friction over normal force, at floor and walls, that holds it at rest
    slides: Bools  # (...) bool, also where the state says that it tips
    load: Floats  # (..., 3) [N] weight, drive and centrifugal force


TRACK_CYCLE_COLUMNS: tuple[Column[TrackMotion], ...] = (  # over a cycle
    Column("normal_force_N", lambda motion: motion.normal_force, "N"),
    Column("wall_1_N", lambda motion: motion.walls[..., 0], "N"),
    Column("wall_2_N", lambda motion: motion.walls[..., 1], "N"),
    Column("wall_1_friction_N", lambda motion: motion.wall_friction[..., 0], "N"),
    Column("wall_2_friction_N", lambda motion: motion.wall_friction[..., 1], "N"),
    Column("radial_friction_N", lambda motion: motion.radial_friction + 0.0, "N"),
    Column("traction_N", lambda motion: motion.traction, "N"),
    Column("normal_line_offset_mm", lambda motion: motion.offset[..., 0], "mm"),
    Column("normal_line_offset_y_mm", lambda motion: motion.offset[..., 1], "mm"),
    Column("acceleration_x_m_s2", lambda motion: motion.acceleration[..., 0], "m/s2"),
    Column("acceleration_y_m_s2", lambda motion: motion.acceleration[..., 1], "m/s2"),
    Column("turning_rad_s2", lambda motion: motion.turning, "rad/s2"),
    Column("floor_couple_N_mm", lambda motion: motion.couple, "N mm"),
)


def motion(
    seat: AnySeat,
    bowl: BowlGrid,
    phase: Reals = UPPER_REVERSAL,
    moving: Reals = 0.0,
    speed: Reals = 0.0,
    *,
    held: bool = False,
) -> TrackMotion:
    """Return how a part moves on the track at one phase of the vibration.

    The balance at rest is tried first. If the friction it needs is more than static friction, the part
    slides, and the equations of sliding hold. No reaction is negative: where a wall contact would have to
    pull, it is opened and the equations are solved without it. The part then turns or leaves the wall.

    Parameters
    ----------
    seat : Seat or SeatStack
    bowl : BowlGrid
        Fields may be arrays, except the track's radius and the sign of its bank, which belong to the seat.
        For a stack they are single values, and the other arguments single values or (P,).
    phase : float or (...) float [rad]
        w t; a quarter turn is the upper reversal.
    moving : float or (...) float [1]
        Sense of sliding along the track, +1 or -1; 0 for a part at rest.
    speed : float or (...) float [m/s]
        Of that sliding, for the centrifugal force.
    held : bool
        Keep a part at rest even where the least friction that holds it is more than there is.

    Returns
    -------
    TrackMotion
        Arrays (...), of a stack (M, P) [N, m/s2, rad/s2, m].

    References
    ----------
    ``solve_sliding`` and ``solve_rest``; docs/mechanics.md, "The track".
    """
    axes = frame(bowl, seat.walls)
    load = loads(seat, bowl, axes, phase, speed)
    static, kinetic, wall = _coefficients(bowl)
    still, needed = _choose_rest(seat, bowl, axes, load)
    moving = np.asarray(moving, dtype=float)
    slides = (moving != 0.0) | ~((needed[..., 0] <= static) | held)
    sense = np.where(moving == 0.0, np.sign(still["mobilised"]), moving)
    # off the wall a part goes where it is pushed: along that at rest, else as it moves
    push = load[..., :2]
    size = np.hypot(push[..., 0], push[..., 1])[..., None]
    along = ratio(push, size, 0.0)
    free = np.where((moving == 0.0)[..., None], along, sense[..., None] * ALONG_X)

    def sliding_on(closed: Closed) -> dict[str, Array]:
        course = sense[..., None] * ALONG_X if any(closed) else free
        use = sense * wall if any(closed) else 0.0 * sense * wall
        turns = (moving == 0.0) & (sum(closed) == 1)
        if turns.any():
            use = wall_use(seat, axes, load, closed, kinetic, use, course, turns)
        return vars(solve_sliding(seat, axes, load, closed, kinetic, use, course)) | {"wall_use": use}

    slipping = _choose_contacts(sliding_on, bowl.gravity) if slides.any() else still
    solution = {name: _select(slides, slipping[name], still[name]) for name in still}
    # in newtons and metres, with what holds while there is no contact
    mass, height, contact = seat.mass, seat.height, solution["normal"] > 0.0
    normal = np.where(contact, solution["normal"], 0.0)
    offset = ratio(_widen(height, 1) * solution["moments"], normal[..., None])
    inside = seat.inside(offset)
    walls = np.where(solution["closed"] & contact[..., None], np.maximum(solution["walls"], 0.0), 0.0)
    state = np.where(inside < -ON_THE_LINE, TIP, np.where(slides, SLIDE, STICK))
    friction = np.where(contact[..., None], solution["friction"], 0.0)
    noise = FORCE_NOISE * np.linalg.norm(load, axis=-1)[..., None] / mass
    walls, friction = (mass * np.where(np.abs(force) < noise, 0.0, force) for force in (walls, friction))
    return TrackMotion(
        state=np.where(contact, state, HOP),
        normal_force=mass * normal,
        walls=walls,
        closed=solution["closed"],
        radial_friction=friction[..., 1],
        traction=0.0 - friction[..., 0],
        wall_friction=solution["wall_use"][..., None] * walls,
        couple=mass * height * solution["couple"] * contact,
        acceleration=np.where(contact[..., None], solution["acceleration"], load[..., :2] / mass),
        turning=solution["turning"] / height * contact,
        offset=offset,
        inside=inside,
        needed=np.where(contact[..., None], needed, np.nan),
        slides=slides,
        load=load,
    )


def over_cycle(
    seat: Seat, bowl: Bowl, samples: int = cycle.PERIOD_SAMPLES
) -> tuple[TrackMotion, cycle.Cycle]:
    """Return ``motion`` over one settled period of the vibration; single values of the bowl.

    Flights are not followed: past the hop the state says ``hop``, and the velocity is that of a part that
    keeps to the track.

    Parameters
    ----------
    seat : Seat
    bowl : Bowl
    samples : int
        Samples in the period.

    Returns
    -------
    TrackMotion
        Of ``samples`` phases.
    Cycle
        Velocity [m/s] along the track.

    References
    ----------
    ``cycle.settle``; docs/mechanics.md, "The track".
    """
    slips = sliding_acceleration(seat, bowl, frame(bowl, seat.walls), -PULL_TOLERANCE * bowl.gravity)
    course = cycle.settle(slips, _loose_windows(seat, bowl), 1.0 / bowl.drive.frequency, samples)
    speed = course.velocity
    return motion(seat, bowl, cycle.phases(samples), np.sign(speed), speed), course


def _coefficients(bowl: BowlGrid) -> tuple[Array, ...]:
    """Return static, kinetic and wall friction, of one shape."""
    friction = bowl.friction
    return np.broadcast_arrays(*map(np.asarray, (friction.static, friction.kinetic, friction.wall)))


def _choose_rest(
    seat: AnySeat, bowl: BowlGrid, axes: TrackAxes, load: Floats
) -> tuple[dict[str, Array], Floats]:
    """Return the part at rest as in ``solve_rest``, and the friction over normal force (..., 3) it needs."""
    static, _, wall = _coefficients(bowl)
    wall_share = ratio(wall, static, 0.0)

    def holding(closed: Closed) -> dict[str, Array]:
        solution = solve_rest(seat, axes, load, closed, wall_share)
        return vars(solution) | {"wall_use": solution.mobilised * wall_share}

    still = _choose_contacts(holding, bowl.gravity)
    size, normal = np.hypot(*np.moveaxis(still["friction"], -1, 0)), still["normal"]
    floor = ratio(size, np.maximum(normal, 0.0))
    wall = np.where(still["closed"], np.abs(still["mobilised"] * wall_share)[..., None], 0.0)
    return still, np.concatenate([floor[..., None], wall], axis=-1)


def _choose_contacts(solve: Callable[[Closed], dict[str, Array]], gravity: Reals) -> dict[str, Array]:
    """Return at each instant the solution with most closed contacts of which none pulls and no gap closes."""
    least = -PULL_TOLERANCE * np.max(gravity)
    chosen: dict[str, Array] = {}
    for closed in SETS:
        solution = solve(closed)
        solution = solution | {"closed": np.broadcast_to(closed, solution["walls"].shape)}
        pushes, opens = (np.asarray((solution[name] >= least).all(axis=-1)) for name in ("walls", "parting"))
        fits = pushes & opens
        if not chosen:
            chosen, decided = solution, fits
            continue
        chosen = {name: _select(decided, chosen[name], solution[name]) for name in solution}
        decided = decided | fits
        if decided.all():
            break
    return chosen


def _select(condition: Bools, first: Array, second: Array) -> Array:
    """Return ``np.where`` with the condition widened over trailing axes."""
    wide = condition.reshape(condition.shape + (1,) * (np.ndim(first) - condition.ndim))
    return np.where(wide, first, second)


def sliding_acceleration(seat: Seat, bowl: Bowl, axes: TrackAxes, least: float) -> cycle.Acceleration:
    """Return the acceleration of a sliding part as a function of phase, speed and sense; single values.

    The equations are linear in the load. So they are solved once for a unit of load along X, Y and Z, for
    either sense and each set of closed contacts; a call then multiplies and adds a dozen numbers.

    Parameters
    ----------
    seat : Seat
    bowl : Bowl
    axes : TrackAxes
    least : float [m/s2]
        A reaction over mass more negative than this would be a pull.

    Returns
    -------
    function of phase [rad], speed [m/s] and sense of sliding
        Acceleration along the track [m/s2]; without contact that of the load.

    References
    ----------
    ``solve_sliding``, which is linear in the load.
    """
    # by sense, for each set of closed contacts, the acceleration, the normal force and two margins, for a
    # unit of load per mass along X, Y and Z
    rows: dict[float, list[tuple[list[Any], ...]]] = {1.0: [], -1.0: []}
    for sense, closed in itertools.product(rows, SETS):
        use = np.full(3, sense * bowl.friction.wall if any(closed) else 0.0)
        kinetic, course = np.full(3, bowl.friction.kinetic), np.tile(sense * ALONG_X, (3, 1))
        of_set = solve_sliding(seat, axes, seat.mass * np.eye(3), closed, kinetic, use, course)
        margins = [(of_set.walls if shut else of_set.parting)[:, k] for k, shut in enumerate(closed)]
        columns = (of_set.acceleration[:, 0], of_set.normal, *margins)
        rows[sense].append(tuple(column.tolist() for column in columns))
    omega = 2.0 * np.pi * bowl.drive.frequency
    stroke, radius = float(bowl.drive.amplitude * omega), float(bowl.track.radius)
    drive, up, radial = (vector.tolist() for vector in (axes.drive, axes.up, axes.radial))
    weight = [bowl.gravity * component for component in up]

    def at(phase: float, speed: float, sense: float) -> float:
        push = stroke * omega * math.sin(phase)
        outward = (drive[0] * stroke * math.cos(phase) + speed) ** 2 / radius
        x = push * drive[0] - weight[0] - outward * radial[0]
        y = push * drive[1] - weight[1] - outward * radial[1]
        z = push * drive[2] - weight[2] - outward * radial[2]
        chosen = rows[sense][0]
        for row in rows[sense]:
            (a, b, c), (d, e, f) = row[2], row[3]
            if a * x + b * y + c * z >= least and d * x + e * y + f * z >= least:
                chosen = row
                break
        (a, b, c), (d, e, f) = chosen[:2]
        return a * x + b * y + c * z if d * x + e * y + f * z > 0.0 else x

    return at


def _loose_windows(seat: Seat, bowl: Bowl) -> list[cycle.Window]:
    """Return the phases at which a part at rest breaks loose, as ``cycle.settle`` takes them.

    They are looked for at a multiple of four samples, so that both reversals are among them.
    """
    phase, static = cycle.phases(), bowl.friction.static
    still = motion(seat, bowl, phase)
    loose = (still.state == HOP) | ~(still.needed[:, 0] <= static)
    sense = np.where(loose, np.where(still.acceleration[:, 0] > 0.0, 1.0, -1.0), 0.0)
    change = np.flatnonzero(sense != np.roll(sense, 1))
    if len(change) == 0:
        return [(0.0, cycle.PERIOD_PHASE, float(sense[0]))] if sense[0] else []
    before, step = sense[change - 1], cycle.PERIOD_PHASE / len(phase)
    sign = np.where((before != 0.0) & (sense[change] == 0.0), -1.0, 1.0)

    def margin(at: Floats) -> Floats:
        """Return the friction needed less static friction; positive where the part breaks loose."""
        axes = frame(bowl, seat.walls)
        rest, needed = _choose_rest(seat, bowl, axes, loads(seat, bowl, axes, at))
        beyond = np.where(rest["normal"] > 0.0, needed[..., 0], np.nan) - static
        return sign * np.nan_to_num(beyond, nan=UNBOUNDED_FRICTION, posinf=UNBOUNDED_FRICTION)

    # Find the phases at which the margin passes zero: two steps of false position, then one of halving.
    # Brackets whose ends are both loose, one way and the other, close in on their lower end.
    low, high = phase[change] - step, phase[change].copy()
    left, right = margin(low), margin(high)
    for count in range(60):
        if (high - low).max() <= PHASE_TOLERANCE:
            break
        share = np.where((left < 0.0) & (right > 0.0) & (count % 3 < 2), left / (left - right), 0.5)
        middle = low + (high - low) * share
        now = margin(middle)
        below, exact = now <= 0.0, np.abs(now) <= PHASE_TOLERANCE
        low, left = np.where(below, middle, low), np.where(below, now, left)
        high, right = np.where(below, high, middle), np.where(below, right, now)
        low, high = np.where(exact, middle, low), np.where(exact, middle, high)
    # windows within one period from where each begins; a state lasts to the next one's begin
    windows = []
    for start, end, way in zip(high, np.append(high[1:], high[0] + cycle.PERIOD_PHASE), sense[change]):
        beyond = end - cycle.PERIOD_PHASE
        if way and beyond > 0.0:
            windows.append((0.0, float(beyond), float(way)))
        if way:
            windows.append((float(start), min(float(end), cycle.PERIOD_PHASE), float(way)))
    return sorted(windows)
