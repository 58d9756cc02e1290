"""A part on the bowl floor: forces, acceleration and the line of action of the normal force.

Body axes x', y' lie in the floor, z up; the thesis calls them Z', Y', X'. Angles run counter-clockwise
seen from above: alpha is the drive's direction, theta the part's heading, both from a line in the bowl.
Seen from the bowl, the drive is the force m A w^2 sin(w t) along (beta, alpha); at the upper reversal,
w t = 90 deg, it points forward and up and the normal force is least.

Every field of the Bowl may be an array; the results broadcast.
"""

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from feederscrew.base.arrays import Bools, Floats, Ints, Reals
from feederscrew.base.columns import Column
from feederscrew.base.geometry import vectors
from feederscrew.base.geometry.polygons import inset
from feederscrew.bowl.record import Bowl, BowlGrid, Friction
from feederscrew.motion import cycle
from feederscrew.resting.posture import Posture

MOTION_STATES = ("stick", "slide", "hop", "tip")  # a state code is a place in this list
STICK = 0
SLIDE = 1
HOP = 2
TIP = 3
UPPER_REVERSAL = 0.5 * np.pi
ON_THE_LINE = 1e-9  # [m] a normal force this near the contact polygon's border does not tip the part
SLIP_HALVINGS = 90  # of the interval of slip accelerations: down to rounding


@dataclass(frozen=True, eq=False)
class FloorMotion:
    """State of a part at one or many instants; vectors in body axes along the last axis."""

    state: Ints  # (...) int, places in MOTION_STATES
    normal_force: Floats  # (...) [N], 0 while there is no contact
    friction: Floats  # (..., 2) [N] force of the floor on the part
    acceleration: Floats  # (..., 2) [m/s2] of the centre of mass relative to the bowl: V'_z, V'_y
    turning: Floats  # (...) [rad/s2] theta'', counter-clockwise
    offset: Floats  # (..., 2) [m] d, where the normal force acts, from the foot of the centre of mass
    inside: Floats  # (...) [m] of that point within the contact polygon; negative: it tips
    limiting_friction: Floats  # (...) [1] least static friction that holds the part; NaN without contact


FLOOR_CYCLE_COLUMNS: tuple[Column[FloorMotion], ...] = (  # over a cycle
    Column("normal_force_N", lambda motion: motion.normal_force, "N"),
    Column("friction_z_N", lambda motion: motion.friction[..., 0], "N"),
    Column("friction_y_N", lambda motion: motion.friction[..., 1], "N"),
    Column("limiting_friction", lambda motion: motion.limiting_friction),
    Column("acceleration_z_m_s2", lambda motion: motion.acceleration[..., 0], "m/s2"),
    Column("acceleration_y_m_s2", lambda motion: motion.acceleration[..., 1], "m/s2"),
    Column("alignment_acceleration_rad_s2", lambda motion: motion.turning + 0.0, "rad/s2"),
)
FLOOR_LINE_COLUMNS: tuple[Column[FloorMotion], ...] = (
    Column("normal_line_offset_mm", lambda motion: motion.offset[..., 0], "mm"),
    Column("normal_line_offset_y_mm", lambda motion: motion.offset[..., 1], "mm"),
)


def drive_force(mass: float, bowl: BowlGrid, heading: Reals, phase: Reals = UPPER_REVERSAL) -> Floats:
    """Return the inertial force of the vibration on a mass, as seen from the bowl.

        F = m A w^2 sin(w t) (cos b cos(alpha - theta), cos b sin(alpha - theta), sin b)

    Parameters
    ----------
    mass : float [kg]
    bowl : BowlGrid
        Its drive: amplitude A, frequency, vibration angle b, direction alpha.
    heading : float or (...) float [rad]
        theta of the part.
    phase : float or (...) float [rad]
        w t.

    Returns
    -------
    (..., 3) float [N]
        Along the body axes x', y' and up.

    References
    ----------
    d'Alembert's force of the harmonic motion, in the thesis's floor wrench, eq. [4.13].
    """
    drive = bowl.drive
    size = mass * drive.amplitude * (2.0 * np.pi * drive.frequency) ** 2 * np.sin(phase)
    level, turn = size * np.cos(drive.vibration_angle), drive.direction - heading
    along = (level * np.cos(turn), level * np.sin(turn), size * np.sin(drive.vibration_angle))
    return np.stack(np.broadcast_arrays(*along), axis=-1)


def motion(
    posture: Posture, bowl: BowlGrid, heading: Reals, phase: Reals = UPPER_REVERSAL, moving: Reals = 0.0
) -> FloorMotion:
    """Return how a part moves on the level bowl floor at one phase of the vibration.

    The normal force is N = m g - m A w^2 sin(b) sin(w t), eq. [4.14]. A part at rest breaks loose where the
    drive along the floor exceeds mu_s N, eq. [4.28]; a sliding part feels mu_k N against its motion,
    eq. [4.26], and accelerates by eqs. [4.15] and [4.16]. The drive turns a sliding part, theta'' = e F_y' /
    I, eq. [4.17].

    The normal force acts where it balances the moment of friction, d = h R / N, eqs. [4.18] and [4.19]; a
    part that turns shifts it further by its products of inertia. Where that point lies outside the contact
    polygon, the part tips.

    Friction is a vector against the sliding, so the factor cos(alpha - theta) of [4.27] is absent: the
    thesis's form holds where a wall takes the force across.

    Parameters
    ----------
    posture : Posture
        Its ``offset`` e [m] is a parameter of the published model: the lever by which the drive turns the
        part, from the foot of the centre of mass to the centroid of the contact polygon. Inertia itself acts
        at the centre of mass; with e = 0 nothing turns.
    bowl : BowlGrid
        Drive, friction and gravity; the floor is level. Fields may be arrays that broadcast.
    heading : float or (...) float [rad]
        theta.
    phase : float or (...) float [rad]
        w t; a quarter turn is the upper reversal.
    moving : float or (...) float [1]
        Sense in which the part slides along the drive's direction, +1 or -1. A part at rest has 0 and breaks
        loose only against static friction. A rolling part is taken from rest.

    Returns
    -------
    FloorMotion
        Arrays (...) [N, m/s2, rad/s2, m].

    References
    ----------
    The thesis, eqs. [4.14] to [4.19], [4.26] and [4.28]; docs/mechanics.md, "The floor".
    """
    force = drive_force(posture.mass, bowl, heading, phase)
    normal = posture.mass * bowl.gravity - force[..., 2]  # eq. [4.14]
    contact = normal > 0.0
    normal = np.where(contact, normal, 0.0)
    if rolls(posture):  # it is taken from rest, and its axes do not depend on the heading
        forces = solve_rolling(posture, bowl.friction, force[..., :2], normal)
        friction, acceleration = forces.friction, forces.acceleration
        slides, needed = forces.slips, forces.limiting_friction
    else:
        # Coulomb friction under a flat part
        push, turn = force[..., :2], np.asarray(bowl.drive.direction - heading)
        along = np.stack([np.cos(turn), np.sin(turn)], axis=-1)
        size = (push * along).sum(axis=-1)  # negative in the half period that pushes back
        needed = vectors.ratio(np.abs(size), normal)  # eq. [4.28]
        slides = (np.asarray(moving) != 0.0) | ~(needed <= bowl.friction.static)
        sense = np.where(np.asarray(moving) == 0.0, np.sign(size), moving)
        held = np.where(slides, sense * bowl.friction.kinetic * normal, size)  # eq. [4.26]
        friction = -held[..., None] * along
        acceleration = (push + friction) / posture.mass  # eqs. [4.15], [4.16]
    lever = np.where(slides & contact, posture.offset, 0.0)
    turning = lever * force[..., 1] / posture.turning_inertia  # eq. [4.17]
    # where the normal force acts: moments about x' and y' through the centre of mass balance
    products = np.where(np.isfinite(posture.inertia[2, :2]), posture.inertia[2, :2], 0.0)
    across = np.array([-products[1], products[0]])
    moment = -posture.height * friction + np.asarray(turning)[..., None] * across  # eqs. [4.18], [4.19]
    offset = vectors.ratio(moment, normal[..., None])
    if rolls(posture) and posture.axis is not None:
        offset = vectors.product(offset, posture.axis)[..., None] * posture.axis
    elif rolls(posture):
        offset = np.where(np.broadcast_to((normal > 0.0)[..., None], moment.shape), 0.0, offset)
    inside = inset(posture.contact, offset)
    state = np.where(slides, SLIDE, STICK)
    state = np.where(inside < -ON_THE_LINE, TIP, state)
    return FloorMotion(
        state=np.where(contact, state, HOP),
        normal_force=normal,
        friction=friction,
        acceleration=acceleration,
        turning=turning,
        offset=offset,
        inside=inside,
        limiting_friction=needed,
    )


def over_cycle(
    posture: Posture, bowl: Bowl, heading: float, samples: int = cycle.PERIOD_SAMPLES
) -> tuple[FloorMotion, cycle.Cycle]:
    """Return ``motion`` over one settled period of the vibration; single values of the bowl.

    Flights are not followed: past the hop the state says ``hop``, and the velocity is that of a part that
    keeps to the plane. Friction does not bring a rolling part to rest: its velocity is the swing about the
    one it began with. A flat part breaks loose by eq. [4.28].

    Parameters
    ----------
    posture : Posture
    bowl : Bowl
    heading : float [rad]
        theta.
    samples : int
        Samples in the period.

    Returns
    -------
    FloorMotion
        Of ``samples`` phases, the sense of sliding being that of the cycle.
    Cycle
        Velocity [m/s] along the drive's direction.
    """
    phase, turn = cycle.phases(samples), bowl.drive.direction - heading
    along = np.array([np.cos(turn), np.sin(turn)])
    if rolls(posture):
        rest = motion(posture, bowl, heading, phase)
        return rest, cycle.swing(vectors.product(rest.acceleration, along), 1.0 / bowl.drive.frequency)
    drive, mu, windows = bowl.drive, bowl.friction, []
    size = drive.amplitude * (2.0 * math.pi * drive.frequency) ** 2
    push, lift = size * math.cos(drive.vibration_angle), size * math.sin(drive.vibration_angle)

    def acceleration(phase: float, speed: float, sense: float) -> float:
        """Acceleration [m/s2] of a sliding flat part."""
        s = math.sin(phase)
        return push * s - sense * mu.kinetic * max(bowl.gravity - lift * s, 0.0)

    # A flat part at rest breaks loose where push s > mu (g - lift s), s = sin(w t): between the onset and its
    # mirror image about the reversal.
    for sense, start in ((1.0, 0.0), (-1.0, math.pi)):
        gain, held = push + sense * mu.static * lift, mu.static * bowl.gravity  # eq. [4.28]
        if gain > held:
            onset = math.asin(held / gain)
            windows.append((start + onset, start + math.pi - onset, sense))
    course = cycle.settle(acceleration, windows, 1.0 / drive.frequency, samples)
    return motion(posture, bowl, heading, phase, np.sign(course.velocity)), course


def rolls(posture: Posture) -> bool:
    """Tell whether the part stands on a rolling aspect: about an axis, or as a ball about any.

    Parameters
    ----------
    posture : Posture

    Returns
    -------
    bool
    """
    return posture.kind == "rolling" and (posture.axis is not None or posture.corners is not None)


def regime(states: Ints) -> str:
    """Return the state that names a whole cycle: contact lost, else tipping, else sliding, else sticking.

    Parameters
    ----------
    states : (...) int
        Codes of the states, HOP, TIP, SLIDE and STICK; one at least.

    Returns
    -------
    str
    """
    present = set(np.ravel(states).tolist())
    return next(MOTION_STATES[code] for code in (HOP, TIP, SLIDE, STICK) if code in present)


def stable_heading(posture: Posture, bowl: BowlGrid) -> Any:
    """Return the heading to which the drive turns the part, by the sign of eq. [4.17].

    theta'' is proportional to e sin(alpha - theta): with e > 0 the part turns to the drive's direction alpha,
    with e < 0 to the opposite one.

    Parameters
    ----------
    posture : Posture
    bowl : BowlGrid
        Its drive's direction may be an array.

    Returns
    -------
    (...) float [rad]
        NaN where nothing turns the part.
    """
    if not np.isfinite(posture.offset) or posture.offset == 0.0:
        return np.full(np.shape(bowl.drive.direction), np.nan)[()]
    return bowl.drive.direction + (0.0 if posture.offset > 0.0 else np.pi)


def with_friction(bowl: BowlGrid, friction: Reals) -> BowlGrid:
    """Return the bowl with one coefficient for sticking and sliding; the wall keeps its own.

    Parameters
    ----------
    bowl : BowlGrid
    friction : float or (...) float [1]

    Returns
    -------
    BowlGrid
    """
    return replace(bowl, friction=replace(bowl.friction, static=friction, kinetic=friction))


@dataclass(frozen=True, eq=False)
class Rolling:
    """Forces on a rolling part; vectors in body axes, (..., 2)."""

    friction: Floats  # (..., 2) [N] of the floor on the part
    acceleration: Floats  # (..., 2) [m/s2] of the axis relative to the bowl
    rolling_acceleration: Floats  # (...) [rad/s2] about the axis, or the y axis; right-handed
    slips: Bools  # (...) bool, as well as rolling
    limiting_friction: Floats  # (...) [1] least static friction with which it only rolls


def solve_rolling(posture: Posture, coefficients: Friction[Reals], push: Floats, normal: Floats) -> Rolling:
    """Return the forces on a part of a rolling aspect, from rest.

    The rolling axis goes through the centre of mass, ``height`` h above the floor; a ball has none and rolls
    every way. While the part only rolls, its contact line stays at rest. Then friction across the axis is

        R = T I / (I + m h^2)

    of the drive T: a third of it for a solid cylinder, two sevenths for a ball. Along the axis nothing rolls,
    and friction takes the whole drive. Where the sum exceeds static friction the part slips as well: kinetic
    friction acts against the slip of the contact line.

    Parameters
    ----------
    posture : Posture
    coefficients : Friction
        Static friction decides whether the part slips, kinetic friction how.
    push : (..., 2) float [N]
        Drive along the floor, in body axes.
    normal : (...) float [N]
        Normal force.

    Returns
    -------
    Rolling

    References
    ----------
    The thesis, chapter 1, on Diaz (2004): friction of a rolling cylinder is found, not assumed to be mu N.
    """
    axis = np.array([0.0, 1.0]) if posture.axis is None else posture.axis
    frame = np.array([[-axis[1], axis[0]], axis])  # rows: across, along
    level = posture.inertia[:2, :2]
    inertia, other = (float(vectors.dot(vectors.product(line, level), line)) for line in frame[::-1])
    turning = np.array([1.0 / inertia, 1.0 / other if posture.axis is None else 0.0])  # for a moment of 1
    # acceleration of the contact line for a force of 1 there, across and along: the part moves and turns
    ease = 1.0 / posture.mass + posture.height**2 * turning
    drive = vectors.product(push, frame.T) / posture.mass
    need = drive / ease
    limiting = vectors.ratio(np.hypot(need[..., 0], need[..., 1]), normal)
    slips = ~(limiting <= coefficients.static)
    # Kinetic friction has a known strength and acts against the slip, and the slip is what the drive leaves
    # under that friction: slip s = drive - strength * ease * s / |s|. For a trial size |s| the direction
    # follows, and |s| is right where this direction has length 1. Halving finds it.
    strength = np.asarray(coefficients.kinetic * normal)[..., None]
    drive = np.broadcast_to(drive, (*np.broadcast_shapes(drive.shape[:-1], strength.shape[:-1]), 2))
    low, high = np.zeros(drive.shape[:-1]), np.hypot(drive[..., 0], drive[..., 1])

    def direction(slip: Floats) -> Floats:
        """Direction of a slip of given acceleration; of length 1 for the one that happens."""
        return vectors.ratio(drive, slip[..., None] + strength * ease, 0.0)

    for _ in range(SLIP_HALVINGS):
        slip = 0.5 * (low + high)
        towards = direction(slip)
        too_slow = np.hypot(towards[..., 0], towards[..., 1]) > 1.0
        low, high = np.where(too_slow, slip, low), np.where(too_slow, high, slip)
    resisted = np.where(slips[..., None], strength * direction(high), need)
    friction = -vectors.product(resisted, frame)
    return Rolling(
        friction=friction,
        acceleration=(push + friction) / posture.mass,
        rolling_acceleration=resisted[..., 0] * posture.height / inertia * -1.0,
        slips=slips,
        limiting_friction=limiting,
    )
