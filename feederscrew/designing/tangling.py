"""Parts that hook into each other or nest: pairs that reach into each other, pulled apart in the engine."""

from dataclasses import dataclass, replace

import numpy as np

from feederscrew import check
from feederscrew.bowl import default
from feederscrew.dropping.kernel import body
from feederscrew.geometry import vectors
from feederscrew.geometry.cells import cells, chords, handles
from feederscrew.trial import air, crowd, runs, staging, stations, whereabouts
from feederscrew.trial.kernel import travel
from feederscrew.trial.shape import solid_of

CELLS = 36  # along the longest side of a part
HOLLOW = 0.03  # of its hull that is not of the part: with less nothing reaches into it
TRIES, POSES = 3000, 24  # pairs that are laid out by chance; of them, the deepest that are pulled
DEEP = 0.02  # of both parts that lies in the other's hull: less is no hooking
BESIDE = 0.4  # of a part's radius by which poses differ that are both pulled
PULL, SECONDS = 0.12, 0.06  # [sqrt(g L)] by which a pull changes their velocities; [sqrt(L/g)] to the next
PULLS, SHAKES, SHAKEN = 40, 15, 1
HELD = 0.75  # of the pulls, that do not part the two: then they may hook
LOOSE = 0.8  # of the pulls: a closed ring that holds in more of them was never apart, as a link of a chain
LINES, NEAR, NESTED = 60, 0.02, 0.3  # lines through a part; of their longest; of a part that is in its like
ROUND = 0.5  # mean of the sides' normals: what touches on one side only slides off
LEAKS, SEEN, SURE = 1.7, 400, 7  # cells deep; so many of its cells are looked at; pulls that hold, of a ring
SUNK = 0.02  # of the unit of length: so deep in each other no two parts are
THINNEST = 0.25  # of a part: its edges and corners are less of it than its thinnest limb
HIGH, FAR = 1e3, 1e6  # over the track and from the wall, in units of length; radius of the wall


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
    def share(self):
        """Share of the pulls that do not part them [1]."""
        return self.held / self.pulls


@dataclass(frozen=True, eq=False)
class Stack:
    """A part in its like, shifted and not turned."""

    place: np.ndarray  # (3,) [m] of the second part from the first, in the file's axes
    height: float  # [m] of one of them along that direction
    side: float  # [rad] between that direction and the sides on which they touch

    @property
    def depth(self):
        """How far the one is in the other [m]."""
        return self.height - float(vectors.norm(self.place))


def tangle(part, friction, seed=1):
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
    pulled = _Pulled(solid, grid, length, friction)
    found = [pulled.tried(*pose, most) for pose in poses(grid, np.random.default_rng(seed))]
    found = [one for one in found if one is not None and HELD <= one[3] / one[2] <= most]
    mouth = mouth if mouth >= section else np.nan
    if not found:
        return None
    turn, place, pulls, held = max(found, key=lambda one: one[3] / one[2])
    turn = vectors.product(vectors.product(principal, turn), principal.T)
    place = length * vectors.product(principal, place)
    return Tangle(check.frozen(turn), check.frozen(place), pulls, held, length * mouth, length * section)


def poses(grid, rng):
    """Return the deepest poses of a part in its like that do not overlap: rotations and places.

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
        if (grid.away[_at(grid, place + vectors.product(rim, turn.T))] <= 0.0).any():
            continue
        back = vectors.product(own - place, turn)
        deep = min(_within(grid, place + vectors.product(own, turn.T)), _within(grid, back))
        if deep > DEEP:
            made.append((deep, turn, place))
    return _apart(sorted(made, key=lambda one: -one[0]), float(vectors.length(rim).max()))


def _at(grid, points):
    return tuple(grid.places(points).T)


def _within(grid, points):
    """Share of points (N, 3) in the hull."""
    return float(grid.hull[_at(grid, points)].mean())


def _apart(made, radius):
    """The first of the poses of which none is like one before it."""
    found = []
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


def _turn(numbers):
    state = np.zeros(body.STATE)
    state[body.Q : body.Q + 4] = numbers / vectors.norm(numbers)
    return whereabouts.matrix(state)


def _section(grid):
    """Diameter [L] of the ball that fits into a part wherever it is, but for its edges and corners."""
    own, inside = np.argwhere(grid.solid), grid.inside[grid.solid]
    beside = np.max([np.roll(grid.inside, step, axis) for axis in range(3) for step in (-1, 1)], axis=0)
    ridge = np.flatnonzero(inside >= beside[grid.solid] - 0.5 * grid.size)
    least = np.zeros(len(own))
    for k in ridge[np.argsort(inside[ridge], kind="stable")]:
        least[((own - own[k]) ** 2).sum(axis=1) * grid.size**2 < inside[k] ** 2] = inside[k]
    return 2.0 * float(np.quantile(least, THINNEST)) - grid.size


def _mouth(grid):
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


def stack(part, friction):
    """Return how a part sits in its like, shifted and not turned, where friction holds it; else None.

    Two such parts touch where the upright chord of the one is longest, its hollows counted in: that is how
    far apart they are. Where their sides all round are steeper there than friction holds, they stay so.

    Source: own; docs/design.md, "7. Risks between parts".

    Parameters
    ----------
    part : Part
        From a mesh.
    friction : float [1]
        Of part on part.

    Returns
    -------
    Stack or None
        Of all directions the one in which it goes in deepest.
    """
    solid, length, principal = solid_of(part)
    found = []
    for way in WAYS[len(WAYS) // 2 :]:
        axes = _upright(way)
        corners = vectors.product(solid.vertices, axes.T)
        chord, low, high = chords(corners, solid.triangles, LINES)
        whole = float(np.ptp(corners[:, 2]))
        touching = chord > (1.0 - NEAR) * chord.max()
        sides = [vectors.product(solid.normals[own[touching]], axes.T) for own in (low, high)]
        steep = [np.arctan2(np.abs(one[:, 2]), np.hypot(one[:, 0], one[:, 1])) for one in sides]
        side = float(np.median(np.maximum(*steep)))
        lean = np.hypot(*sides[1][:, :2].mean(axis=0))  # 0 where they touch all round
        deep = 1.0 - float(chord.max()) / whole
        if deep > NESTED and side < np.arctan(friction) and lean < ROUND:
            place = length * float(chord.max()) * vectors.product(principal, way)
            found.append(Stack(check.frozen(place), length * whole, side))
    return min(found, key=lambda one: vectors.norm(one.place) / one.height, default=None)


def _upright(way):
    """Axes (3, 3) as rows, of which the third is a direction (3,)."""
    aside = np.cross(way, np.eye(3)[int(np.argmin(np.abs(way)))])
    aside = vectors.unit(aside)
    return np.array([aside, np.cross(way, aside), way])


class _Pulled:
    """Two parts without gravity, which are pulled apart."""

    def __init__(self, solid, grid, length, friction):
        bowl = default()
        track = replace(bowl.track, climb=0.0, bank=0.0, radius=FAR * length)
        bowl = replace(bowl, drive=replace(bowl.drive, amplitude=0.0), track=track, devices=())
        rim = grid.middles(grid.rim)
        self.solid, self.grid, self.rim = solid, grid, rim[:: max(len(rim) // SEEN, 1)]
        self.known = known = runs.setting(solid, length, bowl)
        static, kinetic = friction
        known = replace(known, friction=np.array([static, kinetic, static, kinetic, static]))
        self.pair = crowd.PartsOnTrack(known, _nowhere(track, length), 2)

    def tried(self, turn, place, most):
        """Return a pose with how often it was pulled, and how often in vain; None of none.

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

    def parted(self, turn, place, way):
        """Return whether a pull (3,) [1] parts the two, or shaking after it; None where they overlap then."""
        states = np.zeros((2, body.STATE))
        states[:, 1:3] = HIGH
        states[1, :3] += place
        states[0, body.Q] = 1.0
        states[1, body.Q : body.Q + 4] = whereabouts.quaternion(turn)
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
    def through(self):
        """Whether the two have come through each other."""
        first, second = self.pair.arrays.states
        spots = self.apart + vectors.product(self.rim, whereabouts.matrix(second).T)
        spots = vectors.product(spots, whereabouts.matrix(first))
        return bool((self.grid.inside[_at(self.grid, spots)] > LEAKS * self.grid.size).any())

    @property
    def apart(self):
        """From one centre of mass to the other, (3,) [L]."""
        return self.pair.arrays.states[1, :3] - self.pair.arrays.states[0, :3]

    def pull(self, way):
        """Pull both by a velocity (3,) [sqrt(g L)] away from each other; how deep they were in each other."""
        pair, states = self.pair, self.pair.arrays.states
        states[:, 3:6] -= states[:, 3:6].mean(axis=0)  # they fall freely: that is left out
        states[:, 2] += HIGH - states[:, 2].mean()
        states[0, 3:6] -= way
        states[1, 3:6] += way
        notes, floor = np.zeros(travel.NOTES + 2), self.known.floor
        steps = max(round(SECONDS / floor.step), 1)
        travel.follow(pair.surface, self.solid, floor, pair.arrays, pair.on, 0.0, steps, notes)
        return notes[travel.SUNK]


def _nowhere(track, length):
    """A track that is too far away to be met."""
    made = staging.built([], track, length, (-length, length))
    stage = staging.Stage(
        stations.BARE, *made, begin=-length, exit=np.inf, air=air.STILL, size=length, width=track.width
    )
    none = np.zeros((0, 2))
    return crowd.CrowdedTrack(stage, -length, none, np.zeros(1), length)


def _ways():
    """Directions (26, 3) to faces, edges and corners of a cube."""
    found = np.array([(x, y, z) for x in (-1, 0, 1) for y in (-1, 0, 1) for z in (-1, 0, 1) if x or y or z])
    return vectors.unit(found.astype(float))


WAYS = check.frozen(_ways())
