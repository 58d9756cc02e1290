"""Two parts without gravity and track, which are pulled apart in the engine of the trial."""

from dataclasses import replace

import numpy as np

from feederscrew import check
from feederscrew.bowl import default
from feederscrew.bowl.record import Track
from feederscrew.dropping.kernel import body
from feederscrew.geometry import vectors
from feederscrew.geometry.compiled import zero_rows
from feederscrew.geometry.lattice import Cells
from feederscrew.trial import air, arrays, crowd, part_poses, runs, staging
from feederscrew.trial.kernel.workspace import JOURNAL, Together
from feederscrew.trial.shape import TrueSolid

HELD = 0.75  # of the pulls, that do not part the two: then they may hook
PULL, SECONDS = 0.12, 0.06  # [sqrt(g L)] by which a pull changes their velocities; [sqrt(L/g)] to the next
PULLS, SHAKES, SHAKEN = 40, 15, 1  # in one direction; then in any, away from each other in the mean; seed
LEAKS, SEEN, SURE = 1.7, 400, 7  # cells deep; so many of its cells are looked at; pulls that hold, of a ring
SUNK = 0.02  # of the unit of length: so deep in each other no two parts are
HIGH, FAR = 1e3, 1e6  # over the track and from the wall, in units of length; radius of the wall


class Pulled:
    """Two parts without gravity, which are pulled apart."""

    def __init__(self, solid: TrueSolid, grid: Cells, length: float, friction: tuple[float, float]) -> None:
        bowl = default()
        track = replace(bowl.track, climb=0.0, bank=0.0, radius=FAR * length)
        bowl = replace(bowl, drive=replace(bowl.drive, amplitude=0.0), track=track, devices=())
        rim = grid.middles(grid.rim)
        self.solid, self.grid, self.rim = solid, grid, rim[:: max(len(rim) // SEEN, 1)]
        self.known = known = runs.setting(solid, length, bowl)
        static, kinetic = friction
        known = replace(known, friction=np.array([static, kinetic, static, kinetic, static]))
        self.pair = crowd.PartsOnTrack(known, _nowhere(track, length), 2)

    def tried(
        self, turn: np.ndarray, place: np.ndarray, most: float
    ) -> tuple[np.ndarray, np.ndarray, int, int] | None:
        """Return a pose with how often it was pulled, and how often in vain; None where no pose was tried.

        It ends as soon as too few can hold, or of what is to hold in a share ``most`` [1], as too many do.
        """
        away = vectors.unit(place) if vectors.norm(place) > 0.0 else place
        ways = [way for way in WAYS if vectors.dot(way, away) > -1e-9]
        held = pulls = 0
        for left, way in zip(range(len(ways))[::-1], ways):
            parted = self.parted(turn, place, way)
            held += parted is False
            pulls += parted is not None
            few = held + left < HELD * len(ways)
            if few or (most < 1.0 and held == pulls == SURE):
                return None
        return turn, place, pulls, held

    def parted(self, turn: np.ndarray, place: np.ndarray, way: np.ndarray) -> bool | None:
        """Return whether a pull (3,) [1] parts the two, or shaking after it; None where they overlap then."""
        states = np.zeros((2, body.STATE))
        states[:, 1:3] = HIGH
        states[1, :3] += place
        states[0, body.Q] = 1.0
        states[1, body.Q : body.Q + 4] = part_poses.quaternion(turn)
        for n in (0, 1):
            self.pair.lay(n, states[n])
        rng = np.random.default_rng(SHAKEN)
        for k in range(PULLS + SHAKES):
            own = way if k < PULLS else vectors.unit(self.apart) + vectors.unit(rng.standard_normal(3))
            depth = self.pull(PULL * own)
            if self.through or (k == 0 and depth > SUNK):
                return None
            if vectors.norm(self.apart) > 2.0 * self.solid.radius:
                return True
        return False

    @property
    def through(self) -> bool:
        """Whether the two have come through each other."""
        first, second = self.pair.arrays.states
        spots = self.apart + vectors.product(self.rim, part_poses.matrix(second).T)
        spots = vectors.product(spots, part_poses.matrix(first))
        return bool((self.grid.inside[self.grid.at(spots)] > LEAKS * self.grid.size).any())

    @property
    def apart(self) -> np.ndarray:
        """From one centre of mass to the other, (3,) [L]."""
        return self.pair.arrays.states[1, :3] - self.pair.arrays.states[0, :3]

    def pull(self, way: np.ndarray) -> float:
        """Pull both by a velocity (3,) [sqrt(g L)] away from each other; how deep they were in each other."""
        pair, states, journals = self.pair, self.pair.arrays.states, zero_rows(1, JOURNAL)
        states[:, 3:6] -= states[:, 3:6].mean(axis=0)  # they fall freely: that is left out
        states[:, 2] += HIGH - states[:, 2].mean()
        states[0, 3:6] -= way
        states[1, 3:6] += way
        steps = max(round(SECONDS / self.known.floor.step), 1)
        arrays.move_on(self.known, pair.surface, pair.arrays, Together(pair.on, 0.0, steps, journals))
        return float(journals.depth[0])


def _nowhere(track: Track, length: float) -> crowd.CrowdedTrack:
    """A track that is too far away to be met."""
    made = staging.built([], track, length, (-length, length))
    stage = staging.Stage(
        staging.BARE_TRACK,
        *made,
        begin=-length,
        exit=np.inf,
        air=air.STILL_AIR,
        size=length,
        width=track.width,
    )
    none = np.zeros((0, 2))
    return crowd.CrowdedTrack(stage, -length, none, np.zeros(1), length)


def _ways() -> np.ndarray:
    """Directions (26, 3) to faces, edges and corners of a cube."""
    found = np.array([(x, y, z) for x in (-1, 0, 1) for y in (-1, 0, 1) for z in (-1, 0, 1) if x or y or z])
    return vectors.unit(found.astype(float))


WAYS = check.frozen(_ways())
