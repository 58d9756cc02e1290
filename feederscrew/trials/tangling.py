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
CELLS_ALONG_PART = 36  # cells along the longest side of a part
HOLLOW = 0.03  # [1] share of the hull that is not part: below it nothing reaches into the hull
TRIES = 3000  # pairs that are laid at random
POSES = 24  # of them, the deepest, that are pulled
LEAST_DEPTH_SHARE = 0.02  # [1] share of each part in the other's hull: with less they do not hook
POSE_DIFFERENCE = 0.4  # [1] difference of two poses that are both pulled, over the part's radius
LOOSE = 0.8  # [1] share of pulls that hold: closed rings with more were never apart, as links of a chain
THINNEST = 0.25  # [1] share of a part's cells: edges and corners are less of it than its thinnest limb


@dataclass(frozen=True, eq=False)
class Tangle:
    """Two parts of one shape that reach into each other, and how well they hold."""

    turn: Floats  # (3, 3) [1] of the second part in the file's axes of the first
    place: Floats  # (3,) [m] of its centre of mass from that of the first, in those axes
    pulls: int
    held: int  # of them that did not separate the two
    opening: float  # [m] of the slit through which they come to hook; NaN of a part without one
    section: float  # [m] diameter of the part's thinnest limb

    @property
    def share(self) -> float:
        """Share of the pulls that do not separate them [1]."""
        return self.held / self.pulls


def is_hollow(grid: Cells) -> bool:
    """Tell whether a part has hollows into which another part may reach.

    Parameters
    ----------
    grid : Cells
        Of the part.

    Returns
    -------
    bool
        Whether at least ``HOLLOW`` of its hull is not part.
    """
    return bool(1.0 - grid.solid.sum() / grid.hull.sum() >= HOLLOW)


@dataclass(frozen=True, eq=False)
class Limb:
    """How thick a part is where it is thin, and through which mouth another comes into its hollow."""

    section: float  # [L] diameter of the thinnest limb
    mouth: float  # [L] width of the slit that closes a ring of the part; NaN where none does
    is_closed: bool  # whether the part has a ring that no other part of this shape can come into


def measure_limb(grid: Cells) -> Limb:
    """Return the thinnest limb of a part and the mouth of its ring.

    The thinnest limb has the diameter of the largest ball that fits at every place of the part, edges and
    corners left out. For the mouth the solid grows cell by cell: where a slit closes, the solid has one more
    handle.

    Parameters
    ----------
    grid : Cells
        Of the part. The limb has the unit of length of its cells.

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
    mouth, own_handles, step = np.nan, handles(grid.solid), 0.5 * grid.size
    for k in range(1, 4 * (min(grid.solid.shape) // 2)):
        if handles(grid.away <= k * step) > own_handles:
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
        Diameter of its thinnest limb: a slit that is narrower counts as closed.

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
    """Return the pose of a pair of parts in which most pulls do not separate them.

    Pairs are laid at random. Those that reach deepest into each other's hulls are pulled in the trial's
    engine, in many directions.

    Parameters
    ----------
    part : Part
        From a mesh.
    friction : (float, float) [1]
        Of part on part, static and kinetic.
    seed : int, optional
        Of the random poses.

    Returns
    -------
    Tangle or None
        None if no pair holds.

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
    """Return the poses in which a second part reaches deepest into the first without overlapping it.

    How deep they are is the share of a part in the other's hull: the smaller one of both shares.

    Parameters
    ----------
    grid : Cells
        Of the part, about its centre of mass.
    rng : numpy.random.Generator

    Returns
    -------
    list of ((3, 3) float [1], (3,) float [L])
        Rotation of the second part, and place of its centre of mass, as the first part sees them. The
        deepest comes first, and no two are alike.
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


HOLDING_SHARE = 0.75  # [1] share of pulls that do not separate the two: with more they may hook
PULL = 0.12  # [sqrt(g L)] by which a pull changes the velocity of each part
SECONDS = 0.06  # [sqrt(L/g)] from one pull to the next
PULLS = 40  # pulls in one direction
SHAKES = 15  # pulls after these, in random directions away from each other
SHAKEN = 1  # seed of those directions
LEAKS = 1.7  # cells by which a part that has come through another is in it
SEEN = 400  # cells of a part's surface that are looked at for this
SURE = 7  # pulls that have all held, after which closed rings are taken as linked
OVERLAP_DEPTH = 0.02  # [L] by which two parts may overlap as the first pull begins
HIGH, FAR = 1e3, 1e6  # [L] of the parts over the track and from the wall; radius of the wall


class PullTest:
    """Two parts without gravity and far from any track, which are pulled apart."""

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
        """Return how often a pair was pulled, and how often the pull did not separate it.

        Directions that push the parts together are left out. The test ends as soon as fewer than
        ``HOLDING_SHARE`` of the pulls can hold. If ``most`` is below 1, it also ends as soon as the first
        ``SURE`` pulls have all held.

        Parameters
        ----------
        turn : (3, 3) float [1]
            Rotation of the second part, as the first part sees it.
        place : (3,) float [L]
            Centre of mass of the second part from that of the first, as the first part sees it.
        most : float [1]
            Share of pulls that hold above which the pair does not count as hooked.

        Returns
        -------
        (int, int)
            Pulls, and those that held; 0 and 0 if the test ended early.
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
        """Tell whether pulls in one direction, and shaking after them, separate the two parts.

        Parameters
        ----------
        turn : (3, 3) float [1]
        place : (3,) float [L]
            As for ``pull_all``.
        direction : (3,) float [1]
            In which the second part is pulled, as the first part sees it; the first is pulled against it.
        overlap : float [L], optional
            By which they may overlap as the first pull begins.

        Returns
        -------
        bool or None
            True if their centres of mass come further apart than twice the part's radius. None if they
            overlap more than ``overlap`` at first, or have come through each other.
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
