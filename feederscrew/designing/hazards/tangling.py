"""Parts that hook into each other or nest: pairs that reach into each other, pulled apart in the engine."""

from dataclasses import dataclass

import numpy as np

from feederscrew import check
from feederscrew.designing.hazards.pulling import HELD, Pulled
from feederscrew.dropping.kernel import body
from feederscrew.geometry import vectors
from feederscrew.geometry.lattice import Cells, cells, handles
from feederscrew.part.record import Part
from feederscrew.trial import part_poses
from feederscrew.trial.shape import solid_of

CELLS = 36  # along the longest side of a part
HOLLOW = 0.03  # of its hull that is not of the part: with less nothing reaches into it
TRIES, POSES = 3000, 24  # pairs that are laid out by chance; of them, the deepest that are pulled
DEEP = 0.02  # of both parts that lies in the other's hull: less is no hooking
BESIDE = 0.4  # of a part's radius by which poses differ that are both pulled
LOOSE = 0.8  # of the pulls: a closed ring that holds in more of them was never apart, as a link of a chain
THINNEST = 0.25  # of a part: its edges and corners are less of it than its thinnest limb


@dataclass(frozen=True, eq=False)
class Tangle:
    """Two parts of one shape that reach into each other, and how well they hold."""

    turn: np.ndarray  # (3, 3) [1] of the second part in the file's axes of the first
    place: np.ndarray  # (3,) [m] of its centre of mass from that of the first, in those axes
    pulls: int
    held: int  # of them that did not part the two
    opening: float  # [m] through which they come to hook; NaN where they part in some direction
    section: float  # [m] thinnest of the part

    @property
    def share(self) -> float:
        """Share of the pulls that do not part them [1]."""
        return self.held / self.pulls


def tangle(part: Part, friction: tuple[float, float], seed: int = 1) -> Tangle | None:
    """Return the pair of a part that holds best of those that reach into each other; None where none holds.

    Pairs are laid out by chance, one of the second part's cells in a hollow of the first. Those that do not
    overlap and reach deepest into each other's hulls are pulled apart in the trial's engine, in directions
    that lead their centres of mass away from each other, without gravity and track. What is never parted
    counts only where the part has a mouth through which its thinnest section comes: a ring does not.

    Parameters
    ----------
    part : Part
        From a mesh.
    friction : (float, float) [1]
        Static and kinetic, of part on part.
    seed : int

    Returns
    -------
    Tangle or None
    """
    solid, length, principal = solid_of(part)
    grid = cells(solid.vertices, solid.triangles, CELLS)
    if 1.0 - grid.solid.sum() / grid.hull.sum() < HOLLOW:
        return None
    section, mouth = _section(grid), _mouth(grid)
    closed = mouth < section if np.isfinite(mouth) else handles(grid.solid) > 0
    most = LOOSE if closed else 1.0
    pulled = Pulled(solid, grid, length, friction)
    tried = [pulled.tried(turn, place, most) for turn, place in poses(grid, np.random.default_rng(seed))]
    found = [one for one in tried if one is not None and HELD <= one[3] / one[2] <= most]
    mouth = mouth if mouth >= section else np.nan
    if not found:
        return None
    turn, place, pulls, held = max(found, key=lambda one: one[3] / one[2])
    turn = vectors.product(vectors.product(principal, turn), principal.T)
    place = length * vectors.product(principal, place)
    return Tangle(check.frozen(turn), check.frozen(place), pulls, held, length * mouth, length * section)


def poses(grid: Cells, rng: np.random.Generator) -> list[tuple[np.ndarray, np.ndarray]]:
    """Return the deepest poses of a part in another of its kind that do not overlap: rotations and places.

    Parameters
    ----------
    grid : Cells
        Of the part, about its centre of mass.
    rng : numpy Generator

    Returns
    -------
    list of ((3, 3) float [1], (3,) float [L])
        Deepest first, no two alike.
    """
    own, rim = grid.middles(grid.solid), grid.middles(grid.rim)
    hollow = grid.middles(grid.hull & ~grid.solid & (grid.away > grid.size))
    if not len(hollow):
        return []
    made = []
    for _ in range(TRIES):
        turn = _turn(rng.standard_normal(4))
        q, p = own[rng.integers(len(own))], hollow[rng.integers(len(hollow))]
        place = p - vectors.product(turn, q)
        if (grid.away[grid.at(place + vectors.product(rim, turn.T))] <= 0.0).any():
            continue
        back = vectors.product(own - place, turn)
        deep = min(_within(grid, place + vectors.product(own, turn.T)), _within(grid, back))
        if deep > DEEP:
            made.append((deep, turn, place))
    return _apart(sorted(made, key=lambda one: -one[0]), float(vectors.length(rim).max()))


def _within(grid: Cells, points: np.ndarray) -> float:
    """Share of points (N, 3) in the hull."""
    return float(grid.hull[grid.at(points)].mean())


def _apart(
    made: list[tuple[float, np.ndarray, np.ndarray]], radius: float
) -> list[tuple[np.ndarray, np.ndarray]]:
    """The first of the poses of which none is like one before it."""
    found: list[tuple[np.ndarray, np.ndarray]] = []
    for _, turn, place in made:
        differs = (
            vectors.length(place - other) + radius * np.abs(turn - spun).max() > BESIDE * radius
            for spun, other in found
        )
        if all(differs):
            found.append((turn, place))
        if len(found) == POSES:
            break
    return found


def _turn(numbers: np.ndarray) -> np.ndarray:
    state = np.zeros(body.STATE)
    state[body.Q : body.Q + 4] = numbers / vectors.norm(numbers)
    return part_poses.matrix(state)


def _section(grid: Cells) -> float:
    """Diameter [L] of the ball that fits into a part wherever it is, but for its edges and corners."""
    own, inside = np.argwhere(grid.solid), grid.inside[grid.solid]
    beside = np.max([np.roll(grid.inside, step, axis) for axis in range(3) for step in (-1, 1)], axis=0)
    ridge = np.flatnonzero(inside >= beside[grid.solid] - 0.5 * grid.size)
    least = np.zeros(len(own))
    for k in ridge[np.argsort(inside[ridge], kind="stable")]:
        least[((own - own[k]) ** 2).sum(axis=1) * grid.size**2 < inside[k] ** 2] = inside[k]
    return 2.0 * float(np.quantile(least, THINNEST)) - grid.size


def _mouth(grid: Cells) -> float:
    """Width [L] of the slit that closes a ring of the part; NaN where none does.

    The part grows on all sides, until it has a handle more than it had.
    """
    own, step = handles(grid.solid), 0.5 * grid.size
    least = min(grid.solid.shape) // 2
    wide = np.pad(grid.away, 0)
    for k in range(1, 4 * least):
        if handles(wide <= k * step) > own:
            return 2.0 * k * step
    return np.nan
