"""Risks that are said before steel is cut: parts that shingle, hook, nest, wedge, or climbed in the queue."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from feederscrew.base import check
from feederscrew.base.arrays import Floats
from feederscrew.base.geometry import vectors
from feederscrew.base.geometry.lattice import chords
from feederscrew.base.geometry.polygons import turned
from feederscrew.base.units import MM, counted
from feederscrew.bowl.record import Bowl
from feederscrew.designing import short_trials, texts
from feederscrew.designing.findings import Hooking, SeldomPart
from feederscrew.designing.record import Pair, Risk, RiskKind
from feederscrew.designing.short_trials import ShortTrial
from feederscrew.part.record import Part
from feederscrew.sorting.isolating.chain import in_mm
from feederscrew.sorting.orientations import Orientation
from feederscrew.trials.fills import FilledQueue
from feederscrew.trials.heap import heap
from feederscrew.trials.shape import solid_of
from feederscrew.trials.tangling import CUBE_DIRECTIONS, tangle

LIFT = 0.25e-3  # [m] that one part may lie higher than the next: play, burrs, dirt; as a design's margin


def wedge(orientation: Orientation, lift: float = LIFT) -> tuple[float, float, float]:
    """Return the angle at which a part is pushed up on another where it lies a little higher.

    The parts meet in a plane on which the higher one rises by -dL/d(lift) along the track. L, how far they
    are apart where they meet, is the largest q_x - p_x of points q of the part behind and p of the part
    before that meet: a linear programme in the shares of the corners, whose multiplier of the height is
    dL/d(lift).

    Parameters
    ----------
    orientation : Orientation
    lift : float [m], optional
        By which it lies higher.

    Returns
    -------
    angle : float [rad]
        The least of two, of the part behind and of the one before as the higher one; 0 where one clears the
        other. A quarter of a turn where upright sides meet, more where the plane pushes the higher one down.
    distance : float [m]
        L.
    sign : float [1]
        +1 where the part behind is higher, -1 where the one before is.

    References
    ----------
    docs/method/design.md.
    """
    from scipy.optimize import linprog

    points = orientation.posture.surface
    x, y = turned(points[:, :2], orientation.heading).T
    z, count, meetings = points[:, 2], len(points), []
    whole, none = np.ones(count), np.zeros(count)
    rows = [np.append(whole, none), np.append(none, whole), np.append(y, -y), np.append(-z, z)]
    for sign in (1.0, -1.0):
        right = [1.0, 1.0, 0.0, sign * lift]  # shares of q, of p; beside each other; p_z - q_z
        solution = linprog(np.append(-x, x), A_eq=rows, b_eq=right, method="highs")
        if solution.status == 2:  # no solution: so much higher nothing meets
            meetings.append((0.0, 0.5 * float(np.ptp(x)), sign))
        else:
            angle = math.atan2(1.0, sign * solution.eqlin.marginals[3])
            meetings.append((angle, -float(solution.fun), sign))
    return min(meetings)


def risks(
    orientation: Orientation,
    bowl: Bowl,
    queues: Sequence[FilledQueue],
    *,
    orientations: Sequence[Orientation] = (),
    seed: int = 1,
) -> tuple[Risk, ...]:
    """Return what may go wrong between parts, after queues that were followed.

    Parameters
    ----------
    orientation : Orientation
        The wanted one, of a part from a mesh.
    bowl : Bowl
        Its friction is also that of part on part.
    queues : sequence of FilledQueue
    orientations : sequence of Orientation, optional
        All that come often enough to matter.
    seed : int, optional
        Of the pairs that may tangle.

    Returns
    -------
    tuple of Risk
    """
    part, mu = orientation.posture.solid, bowl.friction
    listed: list[Risk] = []
    angle, distance, sign = wedge(orientation)
    if angle < math.atan(mu.kinetic):
        higher = f"{orientation.name} may shingle: where one lies {1e3 * LIFT:.3g} mm higher than the next it"
        text = f"{higher} slides onto it"
        if angle > 0.0:
            text = (
                f"{higher} is pushed up a side of {math.degrees(angle):.3g} deg, "
                f"and friction holds it up to {math.degrees(math.atan(mu.kinetic)):.3g} deg"
            )
        before = vectors.product(np.array([distance, 0.0, -sign * LIFT]), orientation.axes)
        listed.append(Risk(RiskKind.SHINGLES, text, Pair(orientation.axes, np.eye(3), check.frozen(before))))
    climbs = sum(queue.climbs for queue in queues)
    if climbs:
        seconds = sum(queue.seconds for queue in queues)
        text = f"parts climbed on others {counted(climbs, 'time')} in {seconds:.3g} s of queue"
        listed.append(Risk(RiskKind.CLIMBS, text))
    nested = None if part is None else stack(part, mu.static)
    if nested is not None:
        held, side = math.degrees(math.atan(mu.static)), math.degrees(nested.side)
        text = (
            f"parts may nest: one goes {in_mm(nested.depth)} of {in_mm(nested.height)} into the "
            f"next; its sides are {side:.3g} deg off that way, and friction holds it up to {held:.3g} deg"
        )
        listed.append(Risk(RiskKind.NESTS, text, Pair(np.eye(3), np.eye(3), nested.place)))
    tangled = None if part is None else tangle(part, (mu.static, mu.kinetic), seed)
    if part is not None and tangled is not None:
        pulls = f"{tangled.held} of {tangled.pulls} pulls do not part two of them"
        text = f"parts may catch in each other: {pulls}"
        if np.isfinite(tangled.opening):
            text = (
                f"parts may hook into each other: {pulls}; {in_mm(tangled.section)} of them come through a "
                f"mouth of {in_mm(tangled.opening)}"
            )
        count = heap(part, bowl, seed)
        text = f"{text}; {count.words}"
        hooking = Hooking(tangled.pulls, tangled.held, tangled.opening, tangled.section, count)
        pair = Pair(np.eye(3), tangled.turn, tangled.place)
        listed.append(Risk(RiskKind.HOOKS, text, pair, hooking))
    # those that come between the wall and what stands at the free edge, such as the chute's other wall
    width = bowl.track.width
    for other in orientations or (orientation,):
        between = walls_between(other, mu.wall)
        if between is None or not between[0] < width < between[1]:
            continue
        text = (
            f"{other.name} may wedge across a chute as wide as the track, {in_mm(width)}: friction "
            f"holds it between walls {between[0] / MM:.3g} mm to {between[1] / MM:.3g} mm apart"
        )
        c, s = math.cos(strut(other, width)), math.sin(strut(other, width))
        x, y, z = other.axes
        listed.append(
            Risk(RiskKind.WEDGES, text, Pair(np.array([c * x - s * y, s * x + c * y, z]), walls=width))
        )
        break
    return tuple(listed)


def seldom_risks(trial: ShortTrial, highs: Floats, queues: Sequence[FilledQueue]) -> tuple[Risk, ...]:
    """Return what leaves, or stands at a device, beside what is wanted, and is no fault: it comes seldom.

    Parameters
    ----------
    trial : ShortTrial
        The short trial of the design, with M orientations.
    highs : (M,) array [1]
        Upper ends of the intervals of their shares.
    queues : sequence of FilledQueue
        Of its fills: what leaves there as wanted and otherwise, of the parts offered. The trial's own
        shares are taken where there is none.

    Returns
    -------
    tuple of Risk
        In the order of the trial. The break-even share is the least of all fills.
    """
    offered = [queue for queue in queues if queue.offered]
    shares = [
        (queue.right / queue.offered, (queue.left - queue.right) / queue.offered) for queue in offered
    ] or [(trial.efficiency, trial.wrong_share)]
    wanted, listed = set(trial.wanted), list[Risk]()
    for place, row in enumerate(trial.rows.tolist()):
        wrong, held, parts = (int(counts[place]) for counts in (trial.wrong, trial.held, trial.parts))
        if row in wanted or not wrong + held:
            continue
        share = float(trial.shares[row])
        known = trial.orientations.lying[row].name, parts, wrong, held, share, max(share, float(highs[row]))
        if wrong:
            break_even = min(short_trials.break_even(*own, wrong / parts) for own in shares)
            leaving = SeldomPart(*known, break_even)
            listed.append(Risk(RiskKind.LEAVES, texts.seldom_text(leaving), seldom=leaving))
        if held:
            standing = SeldomPart(*known, None)
            listed.append(Risk(RiskKind.STANDS, texts.seldom_text(standing), seldom=standing))
    return tuple(listed)


# times its breadth along the wall: a part that is no longer, however turned, is no strut
LEAST_STRUT_RATIO = 1.02


def walls_between(orientation: Orientation, friction: float) -> tuple[float, float] | None:
    """Return between which distances of two parallel walls a part may wedge.

    Friction holds a part there whose longest line l is within its angle of square to the walls: from max(l
    cos(atan mu), breadth) to l. Walls that are nearer than the part is broad let none in; walls that are
    further apart never touch it at once.

    Parameters
    ----------
    orientation : Orientation
    friction : float [1]

    Returns
    -------
    (float, float) [m] or None
        None where it cannot.

    References
    ----------
    docs/method/design.md.
    """
    corners = orientation.outline
    breadth = float(np.ptp(corners[:, 1]))
    longest = float(np.sqrt(((corners[:, None] - corners[None]) ** 2).sum(axis=-1)).max())
    if longest <= LEAST_STRUT_RATIO * breadth:
        return None
    return max(longest * math.cos(math.atan(friction)), breadth), longest


def strut(orientation: Orientation, width: float) -> float:
    """Return the heading by which a part is turned further where it touches two parallel walls.

    Parameters
    ----------
    orientation : Orientation
    width : float [m]
        Between the walls.

    Returns
    -------
    float [rad]
    """
    angles = np.linspace(-math.pi / 2.0, math.pi / 2.0, 721)
    x, y = orientation.outline.T
    wide = [float(np.ptp(math.sin(turn) * x + math.cos(turn) * y)) for turn in angles]
    return float(angles[int(np.argmin(np.abs(np.array(wide) - width)))])


LINES = 60  # lines through a part
NEAR = 0.02  # of their longest
NESTED = 0.3  # of a part that is in another
ONE_SIDED_LEAN = 0.5  # mean of the sides' normals: what touches on one side only slides off


@dataclass(frozen=True, eq=False)
class Stack:
    """A part in another of its kind, shifted and not turned."""

    place: Floats  # (3,) [m] of the second part from the first, in the file's axes
    height: float  # [m] of one of them along that direction
    side: float  # [rad] between that direction and the sides on which they touch

    @property
    def depth(self) -> float:
        """Return how far the one is in the other [m]."""
        return self.height - float(vectors.norm(self.place))


def stack(part: Part, friction: float) -> Stack | None:
    """Return how a part sits deepest in another, shifted and not turned.

    They touch where the upright chord of the one is longest, its hollows counted in, and stay so where their
    sides all round are steeper there than friction holds.

    Parameters
    ----------
    part : Part
        From a mesh.
    friction : float [1]
        Of part on part.

    Returns
    -------
    Stack or None
        None where none holds.

    References
    ----------
    docs/method/design.md.
    """
    solid, length, principal = solid_of(part)
    stacks = []
    for direction in CUBE_DIRECTIONS[len(CUBE_DIRECTIONS) // 2 :]:
        aside = vectors.unit(np.cross(direction, np.eye(3)[int(np.argmin(np.abs(direction)))]))
        axes = np.array([aside, np.cross(direction, aside), direction])
        corners = vectors.product(solid.vertices, axes.T)
        chord, low, high = chords(corners, solid.triangles, LINES)
        whole = float(np.ptp(corners[:, 2]))
        touching = chord > (1.0 - NEAR) * chord.max()
        sides = [vectors.product(solid.normals[own[touching]], axes.T) for own in (low, high)]
        steep = [
            np.arctan2(np.abs(normals[:, 2]), np.hypot(normals[:, 0], normals[:, 1])) for normals in sides
        ]
        side = float(np.median(np.maximum(*steep)))
        lean = np.hypot(*sides[1][:, :2].mean(axis=0))  # 0 where they touch all round
        deep = 1.0 - float(chord.max()) / whole
        if deep > NESTED and side < np.arctan(friction) and lean < ONE_SIDED_LEAN:
            place = length * float(chord.max()) * vectors.product(principal, direction)
            stacks.append(Stack(check.frozen(place), length * whole, side))
    return min(stacks, key=lambda nested: vectors.norm(nested.place) / nested.height, default=None)
