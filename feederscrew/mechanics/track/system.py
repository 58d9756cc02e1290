"""The six wrench equations of a part on the track, for a given set of closed wall contacts.

Unknowns, per unit of mass and with the height h of the centre of mass as unit of length: the acceleration
along X, two motions or reactions that the wall contacts decide, the normal force N, its moments N d_x and
N d_y, and the wall's R1 and R2. Friction acts where the normal force does, which keeps the system linear.
"""

from dataclasses import dataclass, replace

import numpy as np

from feederscrew.geometry import vectors
from feederscrew.geometry.polygons import cross

SETS = ((True, True), (True, False), (False, True), (False, False))  # closed wall contacts, in order of trial
STEPS = 14  # of the secant rule; the function is nearly straight
AHEAD = np.array([1.0, 0.0])


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


def sliding(seat, axes, load, closed, floor, wall, course=AHEAD):
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

    Notes
    -----
    The complete form of eqs. [4.32] to [4.37] and eqs. [4.57] to [4.62].
    """
    blocks = _contact_columns(seat, axes, floor, wall, course)
    shape = blocks[0].shape[:-1]
    inertia = np.concatenate([[0.0, 0.0, 0.0], -seat.inertia / (seat.mass * seat.height**2)])
    columns = [_unit(shape, 0, -1.0), _unit(shape, 1, -1.0), np.broadcast_to(inertia, (*shape, 6)), *blocks]
    rates = _opening(seat, axes, shape)
    rows = np.zeros((*shape, 2, 8))
    for i, presses in enumerate(closed):
        if presses:
            rows[..., i, 1:3] = rates[..., i, :]
        else:
            rows[..., i, 6 + i] = 1.0
    x = _solved(columns, rows, load / seat.mass)
    parting = np.einsum("...ij,...j->...i", rates, x[..., 1:3])
    friction = -(np.asarray(floor) * x[..., 3])[..., None] * course
    return _solution(x, x[..., 1], x[..., 2], friction, np.zeros(shape), floor, parting)


def held(seat, axes, load, closed, ratio):
    """Reactions of a part at rest: the least friction, every contact using one share of its limit.

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
    before, after = np.zeros(load.shape[:-1]), None
    slip_before = _resting(seat, axes, load, closed, before, ratio).acceleration[..., 0]
    normal = np.maximum(-load[..., 2] / seat.mass, 1e-3 * np.abs(load).max() / seat.mass + 1e-30)
    after = slip_before / normal
    for _ in range(STEPS):
        slip = _resting(seat, axes, load, closed, after, ratio).acceleration[..., 0]
        change = slip - slip_before
        step = np.divide(slip * (after - before), change, out=np.zeros(slip.shape), where=change != 0.0)
        before, slip_before, after = after, slip, after - np.clip(step, -10.0, 10.0)
    found = _resting(seat, axes, load, closed, after, ratio)
    return replace(found, parting=_released(seat, axes, closed, found.couple))


def _released(seat, axes, closed, couple):
    """How the open one of two wall contacts would part if the floor let go of the couple it holds."""
    parting = np.zeros((*np.shape(couple), 2))
    if sum(closed) == 1:
        shut, open_ = closed.index(True), closed.index(False)
        rates = _opening(seat, axes, np.shape(couple))
        across, turning = np.moveaxis(rates, -1, 0)
        shift = turning[..., shut] / across[..., shut] * across[..., open_]  # which keeps the other closed
        parting[..., open_] = -couple * (turning[..., open_] - shift)
    return parting


def wall_use(seat, axes, solve, closed, ahead, turns):
    """Friction over normal force at the one closed wall contact of a part that starts to turn about it.

    Parameters
    ----------
    seat, axes
        As for ``sliding``.
    solve : callable
        From that coefficient, (...) float [1], to a TrackSolution.
    closed : pair of bool
        Which wall contact presses.
    ahead : (...) float [1]
        The coefficient, negative where the part slides back.
    turns : (...) bool
        Where the part starts from rest; elsewhere it goes on sliding and ``ahead`` is kept.

    Returns
    -------
    (...) float [1]
        ``ahead`` where the contact slides with the part, its opposite where turning drives it the other way,
        and between them what keeps it in place: the part then rolls along the wall.
    """
    k = closed.index(True)

    def slip(use):
        """Acceleration of the contact along the wall."""
        found, course = solve(use), axes.courses[..., k, :2]
        turning = cross(seat.walls[k, :2] / seat.height, course)
        return (found.acceleration * course).sum(axis=-1) + found.turning * turning

    before, after = -ahead, ahead
    slip_before = slip(before)
    for _ in range(STEPS):
        slip_after = slip(after)
        change = slip_after - slip_before
        step = np.divide(slip_after * (after - before), change, out=np.zeros(change.shape), where=change != 0)
        before, slip_before = after, slip_after
        after = np.clip(after - step, -np.abs(ahead), np.abs(ahead))
    return np.where(turns, after, ahead)


def _resting(seat, axes, load, closed, mobilised, ratio):
    """The same for a given mobilised friction; the acceleration along X is what it leaves unbalanced."""
    blocks = _contact_columns(seat, axes, mobilised, mobilised * ratio, AHEAD)
    shape = blocks[0].shape[:-1]
    across = _unit(shape, 1) + _unit(shape, 3)
    columns = [_unit(shape, 0, -1.0), across, _unit(shape, 5), *blocks]
    rows = np.zeros((*shape, 2, 8))
    if all(closed):
        rows[..., (0, 1), (1, 2)] = 1.0  # no friction across, no couple
    elif any(closed):
        rows[..., (0, 1), (1, 6 + closed.index(False))] = 1.0
    else:
        rows[..., (0, 1), (6, 7)] = 1.0
    x = _solved(columns, rows, load / seat.mass)
    friction = np.stack([-mobilised * x[..., 3], x[..., 1]], axis=-1)
    ahead = np.divide(x[..., 4], x[..., 3], out=np.zeros(shape), where=x[..., 3] != 0.0)
    nothing = np.zeros(shape)
    couple = x[..., 2] - ahead * x[..., 1]  # so that the friction across acts where the normal force does
    return _solution(x, nothing, nothing, friction, couple, mobilised, np.zeros((*shape, 2)))


def _contact_columns(seat, axes, floor, wall, course):
    """Wrenches of N, N d_x, N d_y, R1 and R2, each for a value of 1, (..., 6)."""
    floor, wall, course = np.asarray(floor, dtype=float), np.asarray(wall, dtype=float), np.asarray(course)
    push = axes.normals - wall[..., None, None] * axes.courses
    moment = np.cross(seat.walls / seat.height, push)
    walls = np.concatenate([push, moment], axis=-1)
    shape = np.broadcast_shapes(walls.shape[:-2], floor.shape, course.shape[:-1])
    drag = np.broadcast_to(-floor[..., None] * course, (*shape, 2))
    normal = np.zeros((*shape, 6))
    normal[..., :2], normal[..., 2], normal[..., 3], normal[..., 4] = drag, 1.0, drag[..., 1], -drag[..., 0]
    first, second = _unit(shape, 4, -1.0), _unit(shape, 3)
    first[..., 5], second[..., 5] = drag[..., 1], -drag[..., 0]
    walls = np.broadcast_to(walls, (*shape, 2, 6))
    return [normal, first, second, walls[..., 0, :], walls[..., 1, :]]


def _opening(seat, axes, shape):
    """How fast each wall contact opens for an acceleration along Y and a turning, (..., 2, 2)."""
    lever = cross(seat.walls[:, :2] / seat.height, axes.normals[..., :2])
    rates = np.stack([axes.normals[..., 1], lever], axis=-1)
    return np.broadcast_to(rates, (*shape, 2, 2))


def _unit(shape, place, value=1.0):
    column = np.zeros((*shape, 6))
    column[..., place] = value
    return column


def _solved(columns, rows, load):
    """Solve sum of columns x + load = 0 together with two homogeneous rows."""
    shape = rows.shape[:-2]
    matrix = np.concatenate([np.stack(columns, axis=-1), rows], axis=-2)
    right = np.zeros((*shape, 8))
    right[..., :3] = -load
    return vectors.solve(matrix, right)


def _solution(x, across, turning, friction, couple, mobilised, parting):
    return TrackSolution(
        acceleration=np.stack([x[..., 0], across], axis=-1),
        turning=turning,
        normal=x[..., 3],
        moments=x[..., 4:6],
        walls=x[..., 6:8],
        friction=friction,
        couple=couple,
        mobilised=np.broadcast_to(mobilised, x.shape[:-1]),
        parting=parting,
    )
