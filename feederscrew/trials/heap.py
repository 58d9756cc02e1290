"""A heap of parts in a bucket: parts are poured, shaken, and each is pulled out. How many come single?

Only pairs of parts are pulled in which each part reaches into the hull of the other. Two convex bodies that
do not overlap have a plane between them, and separate along it.

Lengths, speeds and times are without dimensions where a unit has L in it: L is the cube root of the volume
of the part's hull, g the acceleration of gravity.
"""

import functools
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.ndimage import distance_transform_edt

from feederscrew.arrivals.heap_count import HeapCount
from feederscrew.arrivals.kernel import body
from feederscrew.base.arrays import Bools, Floats, Points
from feederscrew.base.geometry import vectors
from feederscrew.base.geometry.compiled import zero_rows
from feederscrew.base.geometry.lattice import Cells, cells
from feederscrew.bowl import default
from feederscrew.bowl.record import Bowl
from feederscrew.part.record import Part
from feederscrew.trials import part_poses, runs, staging
from feederscrew.trials.kernel.workspace import JOURNAL, QueueSteps, TrueSolid
from feederscrew.trials.shape import solid_of
from feederscrew.trials.tangling import CELLS_ALONG_PART, PullTest, is_hollow, measure_limb, ring_discs

PARTS = 16  # in a heap
THIN_CELLS = 6  # cells over the shortest side of a part's box
MAX_CELLS = 200  # cells along its longest side, at most
# the bucket has a level floor and a round wall
LEAST_RADIUS = 0.5  # [1] radius of the bucket over the part's greatest length, at least
HEAP_HEIGHT = 0.6  # [1] height of the heap over the part's greatest length, at most
PACKING = 0.5  # [1] share of the heap's volume that the hulls of its parts fill
# parts are laid at random up to a height; it grows while they find no place
FIRST_HEIGHT = 0.25  # [1] that height at first, over the part's greatest length
GROWTH = 1.05  # [1] factor by which it grows
TRIES = 1000  # places that are tried before it grows
SEEN_CELLS = 600  # cells of a part's surface that are looked at first
FALL_TIME = 1.5  # [1] time for which the heap falls, over that of a free fall from its height
SHAKE_FREQUENCY = 50.0  # [Hz]
SHAKE_THROW = 2.5  # [1] throw number of the shaking
SHAKE_ANGLE = math.radians(60.0)  # [rad] of the shaking, from the floor
SHAKE_PERIODS = 5  # periods of the shaking
COARSE_STEP = 2.0  # [1] step of time over that of the trial: only where parts come to rest counts
HEAP_DEPTH = 0.05  # [L] by which parts of a heap may overlap as they are pulled
WITHIN_HULL = 1.5  # cells: a part reaches into a hull where it is deeper in it than this


@dataclass(frozen=True, eq=False)
class Bucket:
    """A part without dimensions and the bucket in which a heap of it is shaken."""

    solid: TrueSolid
    grid: Cells
    part_in_bowl: runs.BowlOfPart
    stage: staging.Stage
    length: float  # [m] the unit of length

    @property
    def size(self) -> float:
        """The part's greatest length about its centre of mass [L]."""
        return 2.0 * self.solid.radius

    @property
    def radius(self) -> float:
        """Of the wall [L]; it stands about an axis at (0, radius)."""
        return self.part_in_bowl.radius


@functools.lru_cache(maxsize=8)
def heap(part: Part, bowl: Bowl | None = None, seed: int = 1) -> HeapCount:
    """Return how many parts of a heap come single.

    Parts with hollows are laid as after long mixing: at random places and in random poses, so that no part
    overlaps another. Each such arrangement is equally likely. Closed rings are not linked, because they
    never were apart. Parts without hollows are laid so that their hulls do not overlap. The heap falls and
    is shaken in the trial's engine. Then the pairs that reach into each other are pulled: ``pull_pairs``.

    Parameters
    ----------
    part : Part
        From a mesh.
    bowl : Bowl, optional
        The heap has its friction, restitution and gravity; by default those of the default bowl.
    seed : int, optional
        Of the random places and poses.

    Returns
    -------
    HeapCount
        A part is left out if no pull tells, because it overlaps another part by more than ``HEAP_DEPTH``.

    Raises
    ------
    FeederError
        If the part has no surface, or one of too many facets.

    References
    ----------
    Own; docs/method/design.md.
    """
    bowl = default() if bowl is None else bowl
    solid, length, _ = solid_of(part)
    sides = np.ptp(solid.vertices, axis=0)
    count = int(np.clip(THIN_CELLS * sides.max() / sides.min(), CELLS_ALONG_PART, MAX_CELLS))
    grid = cells(solid.vertices, solid.triangles, count)
    coarse = cells(solid.vertices, solid.triangles, CELLS_ALONG_PART)  # as `tangle` measures a mouth
    is_mixed, limb = is_hollow(grid), measure_limb(coarse)
    discs = ring_discs(grid, limb.section) if limb.is_closed else np.zeros(grid.solid.shape, bool)
    bucket = make_bucket(solid, grid, length, bowl)
    states = shake(bucket, lay_heap(bucket, is_mixed, discs, np.random.default_rng(seed)))
    pulled = PullTest(solid, grid, length, (bowl.friction.static, bowl.friction.kinetic))
    held, unknown = pull_pairs(pulled, states, reaching_pairs(grid, states, bucket.size))
    known = held | ~unknown
    return HeapCount(int(known.sum()), int((known & ~held).sum()), is_mixed, seed)


def make_bucket(solid: TrueSolid, grid: Cells, length: float, bowl: Bowl) -> Bucket:
    """Return the bucket for a heap of parts: the narrowest in which it is no higher than ``HEAP_HEIGHT``.

    Parameters
    ----------
    solid : TrueSolid
    grid : Cells
    length : float [m]
        The unit of length: a hull's volume is 1.
    bowl : Bowl

    Returns
    -------
    Bucket

    References
    ----------
    Own; docs/method/design.md.
    """
    size = 2.0 * solid.radius
    floor_area = PARTS / (PACKING * HEAP_HEIGHT * size)
    radius = max(LEAST_RADIUS * size, math.sqrt(floor_area / math.pi)) * length
    amplitude = SHAKE_THROW * bowl.gravity / (2.0 * math.pi * SHAKE_FREQUENCY) ** 2 / math.sin(SHAKE_ANGLE)
    drive = replace(
        default().drive, frequency=SHAKE_FREQUENCY, amplitude=amplitude, vibration_angle=SHAKE_ANGLE
    )
    track = replace(bowl.track, radius=radius, climb=0.0, bank=0.0)
    part_in_bowl = runs.setting(solid, length, replace(bowl, drive=drive, track=track, devices=()))
    floor = part_in_bowl.floor
    part_in_bowl = replace(part_in_bowl, floor=floor._replace(step=COARSE_STEP * floor.step))
    return Bucket(solid, grid, part_in_bowl, staging.stage_level_floor(radius), length)


def lay_heap(bucket: Bucket, is_mixed: bool, discs: Bools, rng: np.random.Generator) -> Floats:
    """Return the states of parts at rest at random places of a bucket, where no part overlaps another.

    Parameters
    ----------
    bucket : Bucket
    is_mixed : bool
        Whether the hulls of two parts may overlap.
    discs : (I, J, K) bool
        Cells of the grid that closed rings of the part enclose. Two parts are linked if each comes into the
        discs of the other; such places are not taken.
    rng : numpy.random.Generator

    Returns
    -------
    (N, 13) float [L, sqrt(g L), 1, sqrt(g/L)]
        Place, velocity, attitude as a quaternion, and angular velocity of each part.
    """
    grid, size, radius, corners = bucket.grid, bucket.size, bucket.radius, bucket.solid.corners
    free = grid.away > 0.0 if is_mixed else ~grid.hull
    rim = grid.rim if is_mixed else grid.hull & (distance_transform_edt(grid.hull) < WITHIN_HULL)
    whole = grid.middles(rim)
    some = whole[:: max(len(whole) // SEEN_CELLS, 1)]  # most tries fail by these
    states, turns = list[Floats](), list[Floats]()
    height, tries = FIRST_HEIGHT * size, 0
    while len(states) < PARTS:
        tries += 1
        if tries % TRIES == 0:
            height *= GROWTH
        numbers, state = rng.standard_normal(4), np.zeros(body.STATE)
        state[body.Q : body.Q + 4] = numbers / vectors.norm(numbers)
        off, angle = radius * math.sqrt(rng.random()), 2.0 * math.pi * rng.random()
        state[:3] = off * math.cos(angle), radius + off * math.sin(angle), height * rng.random()
        turn = part_poses.matrix(state)
        x, y, z = (state[:3] + vectors.product(corners, turn.T)).T
        if z.min() < 0.0 or np.hypot(x, y - radius).max() > radius:
            continue
        near = [
            (other, spun) for other, spun in zip(states, turns) if vectors.norm(other[:3] - state[:3]) < size
        ]
        here = (state, turn)
        if (
            all(_is_free(grid, free, spots, here, there) for spots in (some, whole) for there in near)
            and all(_is_free(grid, free, whole, there, here) for there in near)
            # two rings are linked where each comes through the other: one of them must not
            and all(
                _is_free(grid, ~discs, whole, here, there) or _is_free(grid, ~discs, whole, there, here)
                for there in near
            )
        ):
            states.append(state)
            turns.append(turn)
    return np.array(states)


def _is_free(
    grid: Cells, free: Bools, spots: Points, own: tuple[Floats, Floats], other: tuple[Floats, Floats]
) -> bool:
    """Tell whether all spots (K, 3) [L] of a part lie in free cells of another part's grid.

    ``own`` and ``other`` are state (13,) and rotation (3, 3) of each.
    """
    (state, turn), (there, spun) = own, other
    placed = state[:3] + vectors.product(spots, turn.T) - there[:3]
    return bool(free[grid.at(vectors.product(placed, spun))].all())


def shake(bucket: Bucket, states: Floats) -> Floats:
    """Return the states of parts after they fell and were shaken.

    Parameters
    ----------
    bucket : Bucket
    states : (N, 13) float [L, sqrt(g L), 1, sqrt(g/L)]
        As ``lay_heap`` returns them.

    Returns
    -------
    (N, 13) float [L, sqrt(g L), 1, sqrt(g/L)]
        As ``states``.
    """
    moving = bucket.part_in_bowl
    surface = runs.surface_of(moving, bucket.stage)
    work = runs.workspace_of(bucket.solid, surface, len(states))
    work.states[:] = states
    way = max(bucket.size, float(states[:, body.Z].max()))
    step, period = moving.floor.step, 2.0 * math.pi / moving.floor.rate
    falling = replace(moving, floor=moving.floor._replace(along=0.0, up=0.0))
    active, time = np.ones(len(states), bool), 0.0
    for setting, seconds in (
        (falling, FALL_TIME * math.sqrt(2.0 * way)),
        (moving, SHAKE_PERIODS * period),
    ):
        crowd = QueueSteps(active, time, math.ceil(seconds / step), zero_rows(1, JOURNAL))
        runs.move_crowd(setting, surface, work, crowd)
        time += crowd.steps * step
    return np.array(work.states)


def reaching_pairs(grid: Cells, states: Floats, size: float) -> list[tuple[int, int]]:
    """Return the pairs of parts in which each part reaches into the hull of the other.

    Parameters
    ----------
    grid : Cells
        Of the part.
    states : (N, 13) float [L, sqrt(g L), 1, sqrt(g/L)]
    size : float [L]
        The part's greatest length.

    Returns
    -------
    list of (int, int)
        Rows of both parts, the larger first. A part that reaches into a hull whose own part does not reach
        back is in no pair.
    """
    within, own = distance_transform_edt(grid.hull) > WITHIN_HULL, grid.middles(grid.solid)
    turns = [part_poses.matrix(state) for state in states]

    def reaches(n: int, m: int) -> bool:
        spots = states[n, :3] + vectors.product(own, turns[n].T) - states[m, :3]
        return bool(within[grid.at(vectors.product(spots, turns[m]))].any())

    return [
        (n, m)
        for n in range(len(states))
        for m in range(n)
        if vectors.norm(states[n, :3] - states[m, :3]) < size and reaches(n, m) and reaches(m, n)
    ]


def pull_pairs(pulled: PullTest, states: Floats, pairs: Sequence[tuple[int, int]]) -> tuple[Bools, Bools]:
    """Return which parts of a heap hold another part, and of which it is unknown.

    The parts of each pair are pulled apart without the others: the upper one upwards and the lower one
    downwards, then to and fro.

    Parameters
    ----------
    pulled : PullTest
        Of the part.
    states : (N, 13) float [L, sqrt(g L), 1, sqrt(g/L)]
        Of the parts in the heap.
    pairs : sequence of (int, int)
        Rows of both parts, as ``reaching_pairs`` returns them.

    Returns
    -------
    held : (N,) bool
        Whether a pull did not separate the part from another one.
    unknown : (N,) bool
        Whether the part overlaps another one by more than ``HEAP_DEPTH``, so that a pull tells nothing.
    """
    held, unknown = np.zeros((2, len(states)), bool)
    for n, m in pairs:
        # as the first part sees it
        first, second = (part_poses.matrix(states[k]) for k in (n, m))
        up = np.array([0.0, 0.0, math.copysign(1.0, states[m, body.Z] - states[n, body.Z])])
        parted = pulled.pull_apart(
            vectors.product(first.T, second),
            vectors.product(first.T, states[m, :3] - states[n, :3]),
            vectors.product(first.T, up),
            HEAP_DEPTH,
        )
        held[[n, m]] |= parted is False
        unknown[[n, m]] |= parted is None
    return held, unknown
