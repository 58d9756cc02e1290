"""A part on the track against the bowl wall: reactions, acceleration and what gives way first.

Seven unknowns stand against six equations: the normal force acts at a point (d_x, d_y) of the contact
polygon. Sliding along X, Coulomb friction opposes the sliding, so R3 = 0 and d_y takes the moment about X
that the thesis gives to R3. At rest friction is not determined; see ``system.held`` for our choice.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from feederscrew.geometry.polygons import inset
from feederscrew.mechanics import cycle
from feederscrew.mechanics.floor.balance import HOP, ON_THE_LINE, SLIDE, STICK, TIP, UPPER_REVERSAL
from feederscrew.mechanics.track import system
from feederscrew.mechanics.track.frame import frame, loads

PULL_TOLERANCE = 1e-9  # of the weight: a reaction more negative than this would be a pull
FORCE_NOISE = 1e-12  # of the weight: less than this is rounding
PHASE_TOLERANCE = 1e-13  # [rad] width of the bracket in which a part breaks loose
BRACKETING_STEPS = 60
UNBOUNDED_FRICTION = 1e9  # [1] friction in place of one that is not finite


@dataclass(frozen=True, eq=False)
class TrackMotion:
    """State of a part on the track at one or many instants; forces of the bowl on the part, in track axes."""

    state: np.ndarray  # (...) int, places in floor.STATES
    normal_force: np.ndarray  # (...) [N]; 0 while there is no contact
    walls: np.ndarray  # (..., 2) [N] R1, R2; 0 where opened
    closed: np.ndarray  # (..., 2) bool, whether each wall contact stays closed
    radial_friction: np.ndarray  # (...) [N] R3, of the floor along Y
    traction: np.ndarray  # (...) [N] R4, of the floor against motion along X
    wall_friction: np.ndarray  # (..., 2) [N] R1f, R2f against motion along the wall
    couple: np.ndarray  # (...) [N m] with which the floor keeps a part at rest from turning
    acceleration: np.ndarray  # (..., 2) [m/s2] relative to the bowl along X and Y
    turning: np.ndarray  # (...) [rad/s2] theta'', counter-clockwise; not 0 only where a contact has opened
    offset: np.ndarray  # (..., 2) [m] d_x, d_y of the normal force from the foot of the centre of mass
    inside: np.ndarray  # (...) [m] of that point within the contact polygon; negative: it tips
    needed: (
        np.ndarray
    )  # (..., 3) [1] friction over normal force at the floor and the walls that holds it at rest
    slides: np.ndarray  # (...) bool, also where the state says that it tips
    load: np.ndarray  # (..., 3) [N] weight, drive and centrifugal force


def motion(seat, bowl, phase=UPPER_REVERSAL, moving=0.0, speed=0.0, *, held=False) -> TrackMotion:
    """Return what a part on the track does at one phase of the vibration.

    Source: ``system.sliding`` and ``system.held``; docs/mechanics.md, "The track".

    Parameters
    ----------
    seat : Seat
        How it lies against the wall.
    bowl : Bowl
        Fields may be arrays, except the track's radius and the sign of its bank, which belong to the seat.
    phase : array_like [rad]
        w t; a quarter turn is the upper reversal.
    moving : array_like [1]
        Sense of sliding along the track, +1 or -1; 0 for a part at rest.
    speed : array_like [m/s]
        Of that sliding, for the centrifugal force.
    held : bool
        Keep a part at rest even where the least friction that holds it is more than there is.

    Returns
    -------
    TrackMotion
        No reaction is negative: where a wall contact would have to pull, it is opened and the equations are
        solved without it, the part then turning or leaving the wall.
    """
    axes = frame(bowl, seat.walls)
    load = loads(seat, bowl, axes, phase, speed)
    static, kinetic, wall = _coefficients(bowl)
    still, needed = _still(seat, bowl, axes, load)
    moving = np.asarray(moving, dtype=float)
    slides = (moving != 0.0) | ~((needed[..., 0] <= static) | held)
    sense = np.where(moving == 0.0, np.sign(still["mobilised"]), moving)
    free = _course(load, moving, sense)

    def sliding_on(closed) -> dict[Any, Any]:
        """Along the track while a wall contact is closed; a part off the wall goes where it is pushed."""
        course = sense[..., None] * system.ALONG_X if any(closed) else free
        use = sense * wall if any(closed) else 0.0 * sense * wall
        turns = (moving == 0.0) & (sum(closed) == 1)
        if turns.any():
            use = system.wall_use(seat, axes, load, closed, kinetic, use, course, turns)
        return vars(system.sliding(seat, axes, load, closed, kinetic, use, course)) | {"wall_use": use}

    slipping = _chosen(sliding_on, bowl.gravity) if slides.any() else still
    solution = {name: _where(slides, slipping[name], still[name]) for name in still}
    return _motion(seat, solution, slides, needed, load)


def needed_at_rest(seat, bowl, phase) -> NDArray[np.float64]:
    """Return friction over normal force that holds a part at rest, (..., 3) [1]: floor and walls.

    Source: Coulomb's law for the reactions of ``system.held``; docs/mechanics.md, "The track".

    Parameters
    ----------
    seat, bowl, phase
        As for ``motion``.
    """
    axes = frame(bowl, seat.walls)
    still, needed = _still(seat, bowl, axes, loads(seat, bowl, axes, phase))
    return np.where(still["normal"][..., None] > 0.0, needed, np.nan)


def over_cycle(seat, bowl, samples=cycle.PERIOD_SAMPLES) -> tuple[TrackMotion, Any]:
    """Return the same over one settled period.

    Parameters
    ----------
    seat, bowl
        As for ``motion``; single values.
    samples : int
        N, of the period.

    Returns
    -------
    tuple of TrackMotion of shape (N,), Cycle
        Flights are not followed: past the hop the state says ``hop`` and the velocity is that of a part that
        keeps to the track.
    """
    slips = sliding_acceleration(seat, bowl, frame(bowl, seat.walls), -PULL_TOLERANCE * bowl.gravity)
    loose = loose_windows(
        lambda phase: motion(seat, bowl, phase),
        lambda phase: needed_at_rest(seat, bowl, phase)[..., 0],
        bowl.friction.static,
    )
    course = cycle.settle(slips, loose, 1.0 / bowl.drive.frequency, samples)
    speed = course.velocity
    return motion(seat, bowl, cycle.phases(samples), np.sign(speed), speed), course


def _coefficients(bowl) -> tuple[NDArray[Any], ...]:
    """Static, kinetic and wall friction, of one shape."""
    friction = bowl.friction
    return np.broadcast_arrays(*map(np.asarray, (friction.static, friction.kinetic, friction.wall)))


def _still(seat, bowl, axes, load) -> tuple[dict, NDArray[np.float64]]:
    """The part at rest as ``system.held`` has it, and the friction that holds it there."""
    static, _, wall = _coefficients(bowl)
    ratio = np.divide(wall, static, out=np.zeros(np.shape(static)), where=static > 0.0)

    def holding(closed) -> dict[Any, Any]:
        solution = system.held(seat, axes, load, closed, ratio)
        return vars(solution) | {"wall_use": solution.mobilised * ratio}

    still = _chosen(holding, bowl.gravity)
    return still, _needed(still, ratio)


def _course(load, moving, sense) -> NDArray[np.float64]:
    """Direction of sliding of a part that no wall holds: along the push at rest, else as it moves."""
    push = load[..., :2]
    size = np.hypot(push[..., 0], push[..., 1])
    along = np.divide(push, size[..., None], out=np.zeros(push.shape), where=size[..., None] > 0.0)
    return np.where((moving == 0.0)[..., None], along, sense[..., None] * system.ALONG_X)


def _chosen(solve, gravity) -> dict[Any, Any]:
    """At each instant the solution with most closed contacts of which none pulls and no gap closes."""
    least = -PULL_TOLERANCE * np.max(gravity)
    chosen: dict[str, np.ndarray] = {}
    for closed in system.SETS:
        solution = solve(closed)
        solution = solution | {"closed": np.broadcast_to(closed, solution["walls"].shape)}
        fits = (solution["walls"] >= least).all(axis=-1) & (solution["parting"] >= least).all(axis=-1)
        if not chosen:
            chosen, decided = solution, fits
            continue
        chosen = {name: _where(decided, chosen[name], solution[name]) for name in solution}
        decided = decided | fits
        if decided.all():
            break
    return chosen


def _needed(still, ratio) -> NDArray[np.float64]:
    """Friction over normal force that holds the part, at the floor and at each wall contact."""
    size, normal = np.hypot(*np.moveaxis(still["friction"], -1, 0)), still["normal"]
    floor = np.divide(size, normal, out=np.full(size.shape, np.nan), where=normal > 0.0)
    wall = np.where(still["closed"], np.abs(still["mobilised"] * ratio)[..., None], 0.0)
    return np.concatenate([floor[..., None], wall], axis=-1)


def _motion(seat, solution, slides, needed, load) -> TrackMotion:
    """The record, in newtons and metres, with what holds while there is no contact."""
    mass, height = seat.mass, seat.height
    contact = solution["normal"] > 0.0
    normal = np.where(contact, solution["normal"], 0.0)
    offset = np.divide(
        height * solution["moments"], normal[..., None],
        out=np.full(solution["moments"].shape, np.nan), where=contact[..., None],
    )  # fmt: skip
    inside = inset(seat.contact, offset)
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


def _where(condition, first, second) -> Any:
    """np.where with the condition widened over trailing axes."""
    wide = condition.reshape(condition.shape + (1,) * (np.ndim(first) - condition.ndim))
    return np.where(wide, first, second)


def sliding_acceleration(seat, bowl, axes, least) -> Callable[..., Any]:
    """Return the acceleration of a sliding part as a function of phase, speed and sense.

    Source: ``system.sliding``, which is linear in the load.

    Parameters
    ----------
    seat : Seat
    bowl : Bowl
        Single values.
    axes : TrackAxes
    least : float [m/s2]
        A reaction per unit of mass more negative than this would be a pull.

    Returns
    -------
    callable
        From phase [rad], speed [m/s] along the track and sense, +1 or -1, to an acceleration [m/s2]; of a
        part that has lost contact, what the load gives it.
    """
    rows = {sense: _sliding_rows(seat, bowl, axes, sense) for sense in (1.0, -1.0)}
    omega = 2.0 * np.pi * bowl.drive.frequency
    stroke, radius = float(bowl.drive.amplitude * omega), float(bowl.track.radius)
    drive, up, radial = (vector.tolist() for vector in (axes.drive, axes.up, axes.radial))
    weight = [bowl.gravity * component for component in up]

    def at(phase, speed, sense) -> float:
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


def loose_windows(rest, needed, static, samples=cycle.PERIOD_SAMPLES) -> list[Any]:
    """Return the phases at which a part at rest breaks loose.

    Source: Coulomb's law on the reactions of ``system.held``; docs/mechanics.md, "The track".

    Parameters
    ----------
    rest : callable
        From phases, (N,) float [rad], to the TrackMotion of a part at rest.
    needed : callable
        From the same to the friction that holds it, (N,) float [1]; NaN or infinite where none does.
    static : float [1]
    samples : int
        At which it is looked for; a multiple of four, so that both reversals are among them.

    Returns
    -------
    list of (float [rad], float [rad], float [1])
        As ``cycle.settle`` takes them.
    """
    phase = cycle.phases(samples)
    sense = _loose_sense(rest(phase), static)
    change = np.flatnonzero(sense != np.roll(sense, 1))
    if len(change) == 0:
        return [(0.0, cycle.PERIOD_PHASE, float(sense[0]))] if sense[0] else []
    before, step = sense[change - 1], cycle.PERIOD_PHASE / samples
    low, high = phase[change] - step, phase[change].copy()
    edges = _loose_edges(lambda at: needed(at) - static, low, high, (before != 0.0) & (sense[change] == 0.0))
    return _cut_windows(edges, sense[change])


def _loose_edges(beyond, low, high, falls) -> NDArray[np.float64]:
    """Phases at which a margin passes zero, each within a bracket; where it is not finite, it is positive.

    Brackets whose ends are both loose, one way and the other, close in on their lower end.
    """
    sign = np.where(falls, -1.0, 1.0)

    def margin(at) -> NDArray[np.float64]:
        return sign * np.nan_to_num(beyond(at), nan=UNBOUNDED_FRICTION, posinf=UNBOUNDED_FRICTION)

    left, right = margin(low), margin(high)
    for count in range(BRACKETING_STEPS):
        if (high - low).max() <= PHASE_TOLERANCE:
            break
        share = np.where((left < 0.0) & (right > 0.0) & (count % 3 < 2), left / (left - right), 0.5)
        middle = low + (high - low) * share
        now = margin(middle)
        below, exact = now <= 0.0, np.abs(now) <= PHASE_TOLERANCE
        low, left = np.where(below, middle, low), np.where(below, now, left)
        high, right = np.where(below, high, middle), np.where(below, right, now)
        low, high = np.where(exact, middle, low), np.where(exact, middle, high)
    return high


def _cut_windows(starts, senses) -> list[tuple[float, float, float]]:
    """Windows within one period from where each begins; a state lasts to the next one's begin."""
    windows = []
    for start, end, sense in zip(starts, np.append(starts[1:], starts[0] + cycle.PERIOD_PHASE), senses):
        if sense and end > cycle.PERIOD_PHASE:
            windows += [
                (0.0, float(end - cycle.PERIOD_PHASE), float(sense)),
                (float(start), cycle.PERIOD_PHASE, float(sense)),
            ]
        elif sense:
            windows.append((float(start), float(end), float(sense)))
    return sorted(windows)


def _loose_sense(rest, static) -> NDArray[np.float64]:
    """Way in which a part at rest breaks loose: +1, -1, or 0 where it is held."""
    loose = (rest.state == HOP) | ~(rest.needed[:, 0] <= static)
    return np.where(loose, np.where(rest.acceleration[:, 0] > 0.0, 1.0, -1.0), 0.0)


def _sliding_rows(seat, bowl, axes, sense) -> list[tuple[list, list, list, list[Any]]]:
    """For each set of closed contacts the rows of acceleration, normal force and two margins.

    Each row is a list of three numbers: the value for a unit of load per mass along X, Y and Z.
    """
    unit = seat.mass * np.eye(3)
    course = np.tile(sense * system.ALONG_X, (3, 1))
    wall, sets = sense * bowl.friction.wall, []
    for closed in system.SETS:
        use = np.full(3, wall if any(closed) else 0.0)
        motion_of_set = system.sliding(
            seat, axes, unit, closed, np.full(3, bowl.friction.kinetic), use, course
        )
        conditions = [
            motion_of_set.walls[:, k] if shut else motion_of_set.parting[:, k]
            for k, shut in enumerate(closed)
        ]
        rows = (motion_of_set.acceleration[:, 0], motion_of_set.normal, *conditions)
        along, normal, *conditions = (row.tolist() for row in rows)
        sets.append((along, normal, *conditions))
    return sets
