"""Risks that are said before steel is cut: parts that shingle, hook, nest, wedge, or climbed in the queue."""

import functools
import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from feederscrew.arrivals.kernel import body
from feederscrew.base import check
from feederscrew.base.arrays import Floats
from feederscrew.base.geometry import vectors
from feederscrew.base.geometry.compiled import zero_rows
from feederscrew.base.geometry.lattice import Cells, cells, chords, handles
from feederscrew.base.geometry.polygons import turned
from feederscrew.base.units import MM, counted
from feederscrew.bowl import default
from feederscrew.bowl.record import Bowl
from feederscrew.designing import short_trials, texts
from feederscrew.designing.findings import Hooking, SeldomPart
from feederscrew.designing.record import Pair, Risk, RiskKind
from feederscrew.designing.short_trials import ShortTrial
from feederscrew.part.record import Part
from feederscrew.sorting.isolating.chain import in_mm
from feederscrew.sorting.orientations import Orientation
from feederscrew.trials import part_poses, queue, runs, staging
from feederscrew.trials.fills import FilledQueue
from feederscrew.trials.kernel.workspace import JOURNAL, QueueSteps, TrueSolid
from feederscrew.trials.shape import solid_of

LIFT = 0.25e-3  # [m] that one part may lie higher than the next: play, burrs, dirt; as a design's margin
CUBE_DIRECTIONS = check.frozen(  # (26, 3) to faces, edges and corners of a cube
    vectors.unit(
        np.array([corner for corner in itertools.product((-1.0, 0.0, 1.0), repeat=3) if any(corner)])
    )
)


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
    if tangled is not None:
        pulls = f"{tangled.held} of {tangled.pulls} pulls do not part two of them"
        text = f"parts may catch in each other: {pulls}"
        if np.isfinite(tangled.opening):
            text = (
                f"parts may hook into each other: {pulls}; {in_mm(tangled.section)} of them come through a "
                f"mouth of {in_mm(tangled.opening)}"
            )
        hooking = Hooking(tangled.pulls, tangled.held, tangled.opening, tangled.section)
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


CELLS_ALONG_PART = 36  # along the longest side of a part
HOLLOW = 0.03  # of its hull that is not of the part: with less nothing reaches into it
TRIES, POSES = 3000, 24  # pairs that are laid out by chance; of them, the deepest that are pulled
LEAST_DEPTH_SHARE = 0.02  # of both parts that lies in the other's hull: less is no hooking
POSE_DIFFERENCE = 0.4  # of a part's radius by which poses differ that are both pulled
LOOSE = 0.8  # of the pulls: a closed ring that holds in more of them was never apart, as a link of a chain
THINNEST = 0.25  # of a part: its edges and corners are less of it than its thinnest limb


@dataclass(frozen=True, eq=False)
class Tangle:
    """Two parts of one shape that reach into each other, and how well they hold."""

    turn: Floats  # (3, 3) [1] of the second part in the file's axes of the first
    place: Floats  # (3,) [m] of its centre of mass from that of the first, in those axes
    pulls: int
    held: int  # of them that did not part the two
    opening: float  # [m] through which they come to hook; NaN where they part in some direction
    section: float  # [m] thinnest of the part

    @property
    def share(self) -> float:
        """Share of the pulls that do not part them [1]."""
        return self.held / self.pulls


@functools.lru_cache(maxsize=8)
def tangle(part: Part, friction: tuple[float, float], seed: int = 1) -> Tangle | None:
    """Return the pair of a part that holds best of those that reach into each other.

    Pairs that are laid out by chance and reach deepest into each other's hulls are pulled apart in the
    trial's engine.

    Parameters
    ----------
    part : Part
        From a mesh.
    friction : (float, float) [1]
        Of part on part, static and kinetic.
    seed : int, optional

    Returns
    -------
    Tangle or None
        None where none holds.

    References
    ----------
    docs/method/design.md.
    """
    solid, length, principal = solid_of(part)
    grid = cells(solid.vertices, solid.triangles, CELLS_ALONG_PART)
    if 1.0 - grid.solid.sum() / grid.hull.sum() < HOLLOW:
        return None
    # diameter [L] of the ball that fits into the part wherever it is, but for its edges and corners
    solid_cells, inside = np.argwhere(grid.solid), grid.inside[grid.solid]
    neighbours = np.max([np.roll(grid.inside, step, axis) for axis in range(3) for step in (-1, 1)], axis=0)
    ridge = np.flatnonzero(inside >= neighbours[grid.solid] - 0.5 * grid.size)
    widest = np.zeros(len(solid_cells))
    for k in ridge[np.argsort(inside[ridge], kind="stable")]:
        within = ((solid_cells - solid_cells[k]) ** 2).sum(axis=1) * grid.size**2 < inside[k] ** 2
        widest[within] = inside[k]
    section = 2.0 * float(np.quantile(widest, THINNEST)) - grid.size
    # width [L] of the slit that closes a ring of the part: it grows until it has a handle more; NaN for none
    mouth, own_handles, step, padded = np.nan, handles(grid.solid), 0.5 * grid.size, np.pad(grid.away, 0)
    for k in range(1, 4 * (min(grid.solid.shape) // 2)):
        if handles(padded <= k * step) > own_handles:
            mouth = 2.0 * k * step
            break
    closed = mouth < section if np.isfinite(mouth) else own_handles > 0
    most = LOOSE if closed else 1.0
    pulled = PullTest(solid, grid, length, friction)
    holding = []
    for turn, place in poses(grid, np.random.default_rng(seed)):
        pulls, held = pulled.pull_all(turn, place, most)
        if pulls and HOLDING_SHARE <= held / pulls <= most:
            holding.append((turn, place, pulls, held))
    mouth = mouth if mouth >= section else np.nan
    if not holding:
        return None
    turn, place, pulls, held = max(holding, key=lambda outcome: outcome[3] / outcome[2])
    turn = vectors.product(vectors.product(principal, turn), principal.T)
    place = length * vectors.product(principal, place)
    return Tangle(check.frozen(turn), check.frozen(place), pulls, held, length * mouth, length * section)


def poses(grid: Cells, rng: np.random.Generator) -> list[tuple[Floats, Floats]]:
    """Return the deepest poses of a part in another of its kind that do not overlap.

    Parameters
    ----------
    grid : Cells
        Of the part, about its centre of mass.
    rng : numpy.random.Generator

    Returns
    -------
    list of ((3, 3) float [1], (3,) float [L])
        Rotations and places, the deepest first, no two alike.
    """
    own, rim = grid.middles(grid.solid), grid.middles(grid.rim)
    hollow = grid.middles(grid.hull & ~grid.solid & (grid.away > grid.size))
    if not len(hollow):
        return []

    def within(points: Floats) -> float:
        return float(grid.hull[grid.at(points)].mean())

    overlaps = []
    for _ in range(TRIES):
        numbers, state = rng.standard_normal(4), np.zeros(body.STATE)
        state[body.Q : body.Q + 4] = numbers / vectors.norm(numbers)
        turn = part_poses.matrix(state)
        q, p = own[rng.integers(len(own))], hollow[rng.integers(len(hollow))]
        place = p - vectors.product(turn, q)
        if (grid.away[grid.at(place + vectors.product(rim, turn.T))] <= 0.0).any():
            continue
        moved_back = vectors.product(own - place, turn)
        deep = min(within(place + vectors.product(own, turn.T)), within(moved_back))
        if deep > LEAST_DEPTH_SHARE:
            overlaps.append((deep, turn, place))
    # the first of those of which none is like one before it
    radius, distinct = float(vectors.length(rim).max()), list[tuple[Floats, Floats]]()
    for _, turn, place in sorted(overlaps, key=lambda pose: -pose[0]):
        differs = (
            vectors.length(place - other) + radius * np.abs(turn - spun).max() > POSE_DIFFERENCE * radius
            for spun, other in distinct
        )
        if all(differs):
            distinct.append((turn, place))
        if len(distinct) == POSES:
            break
    return distinct


HOLDING_SHARE = 0.75  # of the pulls, that do not part the two: then they may hook
PULL, SECONDS = 0.12, 0.06  # [sqrt(g L)] by which a pull changes their velocities; [sqrt(L/g)] to the next
PULLS = 40  # in one direction
SHAKES = 15  # then in any, away from each other in the mean
SHAKEN = 1  # seed
LEAKS = 1.7  # cells deep
SEEN = 400  # so many of its cells are looked at
SURE = 7  # pulls that hold, of a ring
OVERLAP_DEPTH = 0.02  # of the unit of length: so deep in each other no two parts are
HIGH, FAR = 1e3, 1e6  # over the track and from the wall, in units of length; radius of the wall


class PullTest:
    """Two parts without gravity, which are pulled apart."""

    def __init__(self, solid: TrueSolid, grid: Cells, length: float, friction: tuple[float, float]) -> None:
        bowl = default()
        track = replace(bowl.track, climb=0.0, bank=0.0, radius=FAR * length)
        bowl = replace(bowl, drive=replace(bowl.drive, amplitude=0.0), track=track, devices=())
        rim = grid.middles(grid.rim)
        self.solid, self.grid, self.rim = solid, grid, rim[:: max(len(rim) // SEEN, 1)]
        static, kinetic = friction
        own_friction = np.array([static, kinetic, static, kinetic, static])
        self.setting = replace(runs.setting(solid, length, bowl), friction=own_friction)
        # a track that is too far away to be met
        stage = staging.Stage(
            staging.BARE_TRACK, *staging.build_track([], track, length, (-length, length)), begin=-length,
            exit=np.inf, air=staging.STILL_AIR, size=length, width=track.width,
        )  # fmt: skip
        nowhere = queue.CrowdedTrack(stage, -length, np.zeros((0, 2)), np.zeros(1), np.zeros(0), length)
        self.pair = queue.PartsOnTrack(self.setting, nowhere, 2)

    def pull_all(self, turn: Floats, place: Floats, most: float) -> tuple[int, int]:
        """Return how often a pose was pulled, and how often in vain.

        It ends as soon as too few can hold, or, where ``most`` is below 1, as soon as the first ``SURE``
        pulls that decide anything have all held.

        Parameters
        ----------
        turn : (3, 3) array
            Of the second part to the first.
        place : (3,) array [m]
            Of the second part from the first.
        most : float [1]
            Share of pulls above which the pose is no hook.

        Returns
        -------
        (int, int)
            Pulls, and those in vain; 0 of both where that decides nothing.
        """
        away = vectors.unit(place) if vectors.norm(place) > 0.0 else place
        directions = [direction for direction in CUBE_DIRECTIONS if vectors.dot(direction, away) > -1e-9]
        held = pulls = 0
        for left, direction in zip(range(len(directions))[::-1], directions):
            parted = self.pull_apart(turn, place, direction)
            held += parted is False
            pulls += parted is not None
            few = held + left < HOLDING_SHARE * len(directions)
            if few or (most < 1.0 and held == pulls == SURE):
                return 0, 0
        return pulls, held

    def pull_apart(self, turn: Floats, place: Floats, direction: Floats) -> bool | None:
        """Tell whether a pull parts the two, or shaking after it.

        Parameters
        ----------
        turn : (3, 3) array
        place : (3,) array [m]
            As for ``pull_all``.
        direction : (3,) array [1]
            Of the pull.

        Returns
        -------
        bool or None
            None where they overlap then.
        """
        states = np.zeros((2, body.STATE))
        states[:, 1:3] = HIGH
        states[1, :3] += place
        states[0, body.Q] = 1.0
        states[1, body.Q : body.Q + 4] = part_poses.quaternion(turn)
        pair = self.pair
        for n in (0, 1):
            pair.lay(n, states[n])
        rng, arrays = np.random.default_rng(SHAKEN), pair.arrays
        steps = max(round(SECONDS / self.setting.floor.step), 1)
        separation = arrays.states[1, :3] - arrays.states[0, :3]
        for k in range(PULLS + SHAKES):
            away = direction
            if k >= PULLS:
                away = vectors.unit(separation) + vectors.unit(rng.standard_normal(3))
            # both are pulled away from each other; they fall freely: that is left out
            states, journals = arrays.states, zero_rows(1, JOURNAL)
            states[:, 3:6] -= states[:, 3:6].mean(axis=0)
            states[:, 2] += HIGH - states[:, 2].mean()
            states[0, 3:6] -= PULL * away
            states[1, 3:6] += PULL * away
            runs.move_crowd(self.setting, pair.surface, arrays, QueueSteps(pair.is_on, 0.0, steps, journals))
            # whether they overlapped at first, or have come through each other since
            first, second = arrays.states
            separation = second[:3] - first[:3]
            spots = separation + vectors.product(self.rim, part_poses.matrix(second).T)
            spots = vectors.product(spots, part_poses.matrix(first))
            through = self.grid.inside[self.grid.at(spots)] > LEAKS * self.grid.size
            if through.any() or (k == 0 and journals.depth[0] > OVERLAP_DEPTH):
                return None
            if vectors.norm(separation) > 2.0 * self.solid.radius:
                return True
        return False
