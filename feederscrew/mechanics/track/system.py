"""The six wrench equations of a part on the track, for a given set of closed wall contacts.

All is per unit of mass, with the height h of the centre of mass as unit of length. Friction acts where the
normal force N does, which keeps the equations linear in N, its moments N d_x and N d_y, and R1 and R2 of the
wall. Without N in the forces along X and Y, and without N d_x and N d_y in the moment about Z, they are those
of a motion in the plane of the floor: two forces and a turning moment of the load and of each wall contact.

Source: the thesis, wrench equations of chapter 5; docs/equations.md, docs/mechanics.md.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from feederscrew.geometry.polygons import cross
from feederscrew.geometry.vectors import dot

SETS = ((True, True), (True, False), (False, True), (False, False))  # closed wall contacts, in order of trial
SECANT_STEPS = 14  # of the secant rule; the functions are nearly straight
HELD_SLIP_SHARE = 1e-6  # [1] of the slip of a part that nothing holds: less than this is none
ALONG_X = np.array([1.0, 0.0])


@dataclass(frozen=True, eq=False)
class TrackSolution:
    """Accelerations and reactions for one set of closed contacts, per unit of mass."""

    acceleration: np.ndarray  # (..., 2) [m/s2] along X and Y
    turning: np.ndarray  # (...) [m/s2] theta'' times h
    normal: np.ndarray  # (...) [m/s2]
    moments: np.ndarray  # (..., 2) [m/s2] N d / h
    walls: np.ndarray  # (..., 2) [m/s2] R1, R2
    friction: np.ndarray  # (..., 2) [m/s2] of the floor on the part
    couple: np.ndarray  # (...) [m/s2] about Z that the floor holds against turning, over h
    mobilised: np.ndarray  # (...) [1] friction over normal force along X, signed against motion ahead
    parting: np.ndarray  # (..., 2) [m/s2] at which each wall contact opens


def sliding(seat, axes, load, closed, floor, wall, course=ALONG_X) -> TrackSolution:
    """Solve the wrench equations of a sliding part: accelerations and reactions.

    Parameters
    ----------
    seat : Seat
    axes : TrackAxes
    load : (..., 3) float [N]
        All that acts but contacts.
    closed : pair of bool
        Which wall contacts press.
    floor, wall : (...) float [1]
        Coefficients of friction, negative where the part slides back.
    course : (..., 2) float [1]
        Direction of positive sliding on the floor.

    Returns
    -------
    TrackSolution
        Not finite where the equations are singular.

    Notes
    -----
    The complete form of eqs. [4.32] to [4.37] and eqs. [4.57] to [4.62].
    """
    slide = _Slide(seat, axes, load, floor, course)
    acting, walls, across, turning = slide.motion(closed, np.asarray(wall, dtype=float))
    parting = slide.rates[..., 0] * across[..., None] + slide.rates[..., 1] * turning[..., None]
    friction = slide.drag * acting.normal(walls)[..., None]
    return acting.solution(walls, (across, turning), slide.inertia, friction, 0.0, floor, parting)


def held(seat, axes, load, closed, ratio) -> TrackSolution:
    """Return the reactions of a part at rest: least friction, one share of its limit at every contact.

    Source: the equations of ``sliding`` with a choice of friction; docs/mechanics.md, "The track".

    Parameters
    ----------
    seat, axes, load, closed
        As for ``sliding``.
    ratio : (...) float [1]
        The wall's coefficient over the floor's.

    Returns
    -------
    TrackSolution
        Its ``mobilised`` is the coefficient that the floor needs along the track. A part that the wall
        does not hold across the track, or against turning, is held by the floor.

    Notes
    -----
    Forces at rest are not determined by the equations. This choice goes over into sliding without a jump.
    """
    wall, force = _Wall(seat, axes), load / seat.mass

    def resting(mobilised) -> "tuple[_Acting, NDArray[np.float64]]":
        """What acts, and the reactions that leave no motion across and no turning."""
        acting = wall.acting(force, mobilised * ratio, -mobilised[..., None] * ALONG_X)
        return acting, acting.reactions(closed, np.zeros(2))

    def slip(mobilised) -> tuple[Any, ...]:
        """What is left over along the track, and the divisor of the wall's reactions that it is of."""
        return wall.acting(force, mobilised * ratio, -mobilised[..., None] * ALONG_X).undivided(closed)

    mobilised = _mobilised(slip, force)
    acting, walls = resting(mobilised)
    across = np.zeros(walls.shape[:-1]) if any(closed) else -acting.left_over(walls, 1)
    friction = np.stack([-mobilised * acting.normal(walls), across], axis=-1)
    couple = np.zeros(walls.shape[:-1]) if all(closed) else 0.0 - dot(acting.yaws, walls)
    nothing = np.zeros(walls.shape[:-1])
    parting = _released(seat, axes, closed, couple)
    return acting.solution(walls, (nothing, nothing), np.zeros(3), friction, couple, mobilised, parting)


def _mobilised(slip, force) -> NDArray[np.float64]:
    """Friction over normal force that leaves no slip along the track.

    Where friction at the wall grows without bound before the slip is held, what the floor alone would need.
    """
    nothing = np.zeros(force.shape[:-1])
    unheld, divisor = slip(nothing)
    guess = _ratio(unheld, divisor) / np.maximum(-force[..., 2], 1e-3 * np.abs(force).max() + 1e-30)
    root = _zero(
        lambda mobilised: slip(mobilised)[0], nothing, unheld, guess,
        lambda after, step: after - np.clip(step, -10.0, 10.0),
    )  # fmt: skip
    left, at_found = slip(root)
    holds = (
        (np.abs(left) <= HELD_SLIP_SHARE * np.abs(unheld))
        & (root * guess >= 0.0)
        & (at_found * divisor > 0.0)
    )
    return np.where(holds, root, guess)


def _zero(slip, before, slip_before, after, stepped) -> Any:
    """Where a function is zero, by the secant rule from two guesses; ``stepped`` keeps a step in bounds."""
    for _ in range(SECANT_STEPS):
        if np.array_equal(before, after, equal_nan=True):  # it would stay there
            break
        slip_after = slip(after)
        change = slip_after - slip_before
        step = np.divide(slip_after * (after - before), change, out=np.zeros(change.shape), where=change != 0)
        before, slip_before, after = after, slip_after, stepped(after, step)
    return after


def _released(seat, axes, closed, couple) -> NDArray[np.float64]:
    """How the open one of two wall contacts would part if the floor let go of the couple it holds."""
    parting = np.zeros((*np.shape(couple), 2))
    if sum(closed) == 1:
        shut, open_ = closed.index(True), closed.index(False)
        rates = _opening(seat, axes)
        across, turning = np.moveaxis(rates, -1, 0)
        shift = turning[..., shut] / across[..., shut] * across[..., open_]  # which keeps the other closed
        parting[..., open_] = -couple * (turning[..., open_] - shift)
    return parting


def wall_use(seat, axes, load, closed, floor, ahead, course, turns) -> NDArray[np.float64]:
    """Return friction over normal force at the only closed wall contact of a part that starts to turn.

    Source: the equations of ``sliding`` with one wall contact.

    Parameters
    ----------
    seat, axes, load, closed, floor, course
        As for ``sliding``; one contact is closed.
    ahead : (...) float [1]
        The coefficient at the wall, negative where the part slides back.
    turns : (...) bool
        Where the part starts from rest; elsewhere it goes on sliding and ``ahead`` is kept.

    Returns
    -------
    (...) float [1]
        ``ahead`` where the contact slides with the part, its opposite where turning drives it the other way,
        and between them what keeps it in place: the part then rolls along the wall.
    """
    slide, k = _Slide(seat, axes, load, floor, course), closed.index(True)
    along = axes.courses[..., k, :2]
    lever, limit = cross(seat.walls[k, :2] / seat.height, along), np.abs(ahead)

    def slip(use) -> Any:
        """Acceleration of the contact along the wall."""
        acting, walls, across, turning = slide.motion(closed, use)
        return acting.left_over(walls, 0) * along[..., 0] + across * along[..., 1] + turning * lever

    use = _zero(slip, -ahead, slip(-ahead), ahead, lambda after, step: np.clip(after - step, -limit, limit))
    return np.where(turns, use, ahead)


class _Slide:
    """A part that slides on the floor; (..., 2) ``drag`` is the floor's friction for a normal force of 1."""

    def __init__(self, seat, axes, load, floor, course) -> None:
        self.wall, self.rates, self.force = _Wall(seat, axes), _opening(seat, axes), load / seat.mass
        self.drag = -np.asarray(floor, dtype=float)[..., None] * course
        self.inertia = seat.inertia / (seat.mass * seat.height**2)
        self.resists = dot(self.drag, self.inertia[:2]) + self.inertia[2]
        self.give = self.rates[..., 1] / (self.rates[..., 0] * self.resists[..., None])

    def motion(self, closed, use) -> Any:
        """Return what acts, the wall's reactions and the accelerations across the track and in turning."""
        acting = self.wall.acting(self.force, use, self.drag)
        walls = acting.reactions(closed, self.give)
        if all(closed):
            return acting, walls, *np.zeros((2, *walls.shape[:-1]))
        return acting, walls, acting.left_over(walls, 1), dot(acting.yaws, walls) / self.resists


class _Wall:
    """What the wall does at its two contacts, for any friction there."""

    def __init__(self, seat, axes) -> None:
        arms = seat.walls / seat.height
        self.normals, self.courses = (
            np.concatenate([force, np.cross(arms, force)], axis=-1) for force in (axes.normals, axes.courses)
        )

    def acting(self, force, use, drag) -> "_Acting":
        """Return what acts on the part for a friction over normal force of ``use`` at the wall."""
        return _Acting(force, self.normals - use[..., None, None] * self.courses, drag)


class _Acting:
    """A load (..., 3), wrenches of the wall's contacts (..., 2, 6) and the floor's drag, N eliminated."""

    def __init__(self, force, pushes, drag) -> None:
        self.force, self.pushes = force, pushes
        self.pull = force[..., :2] - drag * force[..., 2:]
        self.planar = pushes[..., :2] - drag[..., None, :] * pushes[..., 2:3]
        self.yaws = dot(pushes[..., 3:5], drag[..., None, :]) + pushes[..., 5]

    def reactions(self, closed, give) -> NDArray[np.float64]:
        """Return R1 and R2, (..., 2), at which the closed contacts stay closed.

        ``give`` (..., 2) is how fast a contact opens for a unit of turning moment over how fast for a unit of
        force across the track: zero where the part is kept from turning.
        """
        shares, divisor = self._shares(closed, give)
        return _ratio(shares, divisor[..., None])

    def undivided(self, closed) -> tuple[Any, ...]:
        """Return what is left over along X of a part at rest, times the reactions' divisor, and that."""
        shares, divisor = self._shares(closed, np.zeros(2))
        return self.pull[..., 0] * divisor + dot(self.planar[..., 0], shares), divisor

    def _shares(self, closed, give) -> tuple[Any, ...]:
        """R1 and R2 times the divisor that they have in common, (..., 2), and that, (...)."""
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

    def left_over(self, walls, axis) -> Any:
        """Sum of the forces along X or Y, (...)."""
        return self.pull[..., axis] + dot(self.planar[..., axis], walls)

    def normal(self, walls) -> Any:
        """Return the floor's normal force N, (...)."""
        return -(self.force[..., 2] + dot(self.pushes[..., 2], walls))

    def solution(self, walls, motion, inertia, friction, couple, mobilised, parting) -> TrackSolution:
        """Return the record, with the moments of N that the moments about X and Y ask for."""
        across, turning = motion
        about_x, about_y = (dot(self.pushes[..., place], walls) for place in (3, 4))
        ahead = about_y - inertia[1] * turning - friction[..., 0]
        offset_moment = inertia[0] * turning - about_x - friction[..., 1]
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


def _opening(seat, axes) -> NDArray[np.float64]:
    """How fast each wall contact opens for an acceleration along Y and a turning, (..., 2, 2)."""
    lever = cross(seat.walls[:, :2] / seat.height, axes.normals[..., :2])
    return np.stack([axes.normals[..., 1], lever], axis=-1)


def _ratio(above, below) -> NDArray[np.float64]:
    """Their ratio; NaN where it has none."""
    shape = np.broadcast_shapes(np.shape(above), np.shape(below))
    return np.divide(above, below, out=np.full(shape, np.nan), where=below != 0.0)
