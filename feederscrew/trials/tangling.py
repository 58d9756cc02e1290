"""Two parts of one shape that reach into each other: how they come to, and what pulls do not part them."""

import functools
import itertools
from dataclasses import dataclass, replace

import numpy as np
from scipy.ndimage import binary_fill_holes

from feederscrew.arrivals.kernel import body
from feederscrew.base import check
from feederscrew.base.arrays import Bools, Floats
from feederscrew.base.geometry import vectors
from feederscrew.base.geometry.compiled import zero_rows
from feederscrew.base.geometry.lattice import Cells, cells, handles
from feederscrew.bowl import default
from feederscrew.part.record import Part
from feederscrew.trials import part_poses, queue, runs, staging
from feederscrew.trials.kernel.workspace import JOURNAL, QueueSteps, TrueSolid
from feederscrew.trials.shape import solid_of

CUBE_DIRECTIONS = check.frozen(  # (26, 3) to faces, edges and corners of a cube
    vectors.unit(
        np.array([corner for corner in itertools.product((-1.0, 0.0, 1.0), repeat=3) if any(corner)])
    )
)
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


def is_hollow(grid: Cells) -> bool:
    """Tell whether anything may reach into the hull of a part beside it.

    Parameters
    ----------
    grid : Cells
        Of the part.

    Returns
    -------
    bool
    """
    return bool(1.0 - grid.solid.sum() / grid.hull.sum() >= HOLLOW)


@dataclass(frozen=True, eq=False)
class Limb:
    """How thick a part is where it is thin, and through which mouth another comes into its hollow."""

    section: float  # [L] diameter of the thinnest limb
    mouth: float  # [L] width of the slit that closes a ring of the part; NaN where none does
    is_closed: bool  # nothing of its kind comes into the ring: what is linked there was never apart


def measure_limb(grid: Cells) -> Limb:
    """Return the thinnest limb of a part and the mouth of its ring.

    The limb is the diameter of the ball that fits into the part wherever it is, but for its edges and
    corners. The mouth is found as the solid grows: then it has a handle more.

    Parameters
    ----------
    grid : Cells
        Of the part; lengths as its own.

    Returns
    -------
    Limb

    References
    ----------
    docs/method/design.md.
    """
    solid_cells, inside = np.argwhere(grid.solid), grid.inside[grid.solid]
    neighbours = np.max([np.roll(grid.inside, step, axis) for axis in range(3) for step in (-1, 1)], axis=0)
    ridge = np.flatnonzero(inside >= neighbours[grid.solid] - 0.5 * grid.size)
    widest = np.zeros(len(solid_cells))
    for k in ridge[np.argsort(inside[ridge], kind="stable")]:
        within = ((solid_cells - solid_cells[k]) ** 2).sum(axis=1) * grid.size**2 < inside[k] ** 2
        widest[within] = inside[k]
    section = 2.0 * float(np.quantile(widest, THINNEST)) - grid.size
    mouth, own_handles, step, padded = np.nan, handles(grid.solid), 0.5 * grid.size, np.pad(grid.away, 0)
    for k in range(1, 4 * (min(grid.solid.shape) // 2)):
        if handles(padded <= k * step) > own_handles:
            mouth = 2.0 * k * step
            break
    return Limb(section, mouth, mouth < section if np.isfinite(mouth) else own_handles > 0)


def ring_discs(grid: Cells, section: float) -> Bools:
    """Return the cells that the rings of a part enclose, in planes across one of its axes.

    Parameters
    ----------
    grid : Cells
        Of the part, along its principal axes.
    section : float [L]
        Of its thinnest limb: a mouth that is narrower closes a ring.

    Returns
    -------
    (I, J, K) bool

    References
    ----------
    docs/method/design.md.
    """
    shut = grid.away <= 0.5 * section
    across = np.ones((3, 3), bool)
    discs = np.zeros(shut.shape, bool)
    for axis in range(3):
        for k in range(shut.shape[axis]):
            cut = tuple(k if axis == other else slice(None) for other in range(3))
            discs[cut] |= binary_fill_holes(shut[cut], structure=across)
    return discs & grid.hull & ~grid.solid


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
    if not is_hollow(grid):
        return None
    limb = measure_limb(grid)
    most = LOOSE if limb.is_closed else 1.0
    pulled = PullTest(solid, grid, length, friction)
    holding = []
    for turn, place in poses(grid, np.random.default_rng(seed)):
        pulls, held = pulled.pull_all(turn, place, most)
        if pulls and HOLDING_SHARE <= held / pulls <= most:
            holding.append((turn, place, pulls, held))
    mouth = limb.mouth if limb.mouth >= limb.section else np.nan
    if not holding:
        return None
    turn, place, pulls, held = max(holding, key=lambda outcome: outcome[3] / outcome[2])
    turn = vectors.product(vectors.product(principal, turn), principal.T)
    place = length * vectors.product(principal, place)
    return Tangle(check.frozen(turn), check.frozen(place), pulls, held, length * mouth, length * limb.section)


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

    def pull_apart(
        self, turn: Floats, place: Floats, direction: Floats, overlap: float = OVERLAP_DEPTH
    ) -> bool | None:
        """Tell whether a pull parts the two, or shaking after it.

        Parameters
        ----------
        turn : (3, 3) array
        place : (3,) array [m]
            As for ``pull_all``.
        direction : (3,) array [1]
            Of the pull.
        overlap : float [L], optional
            They may be so deep in each other at first.

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
            if through.any() or (k == 0 and journals.depth[0] > overlap):
                return None
            if vectors.norm(separation) > 2.0 * self.solid.radius:
                return True
        return False
