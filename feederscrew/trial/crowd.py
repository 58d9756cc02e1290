"""Several parts on one track with all its devices: they push, carry and climb each other."""

from dataclasses import dataclass

import numpy as np
import shapely
import shapely.affinity

from feederscrew import check
from feederscrew.dropping.kernel import body
from feederscrew.geometry.compiled import on_disk
from feederscrew.trial import runs, stations
from feederscrew.trial.kernel import contact, search
from feederscrew.trial.kernel import crowd as kernel
from feederscrew.trial.kernel.pairs import Crowd

PAIRS = 400  # contacts between parts at a time, at most
JOINT = 1e-4  # [m] by which neighbouring stretches of the track lie over each other where they are joined
GRID = 1e-9  # [m] on which they are
EVEN = 1e-5  # [m] steps between them that are left out: arcs are drawn with other corners
TAIL = 0.7  # of the part's size: track that is drawn behind the outlet


@dataclass(frozen=True, eq=False)
class CrowdedTrack:
    """The bare track for a row, then the devices one behind the other; D devices."""

    stage: stations.Stage
    start: float  # [m] along the wall, where the drawn track begins
    windows: np.ndarray  # (D, 2) [m] where each device's stretch begins and ends
    levels: np.ndarray  # (D + 1,) [m] of the track before the first device and behind each
    outlet: float  # [m] behind the last of them


def crowded(bowl, every, devices, room):
    """Return the track for a row of parts.

    Parameters
    ----------
    bowl : Bowl
    every : sequence of Orientation
        Of the part.
    devices : sequence of Device
        In the order parts meet them.
    room : float [m]
        Bare track before them, up to the place 0.

    Returns
    -------
    CrowdedTrack
    """
    track, place, level, windows, gates = bowl.track, 0.0, 0.0, [], []
    size = max(np.hypot(one.length, max(one.width, one.height)) for one in every)
    bare = stations.plain(track, every, room + size)
    floors = [(0.0, stations.THICK, _turned(_area(bare.borders), -room, track.radius), -room - size, 0.0)]
    made = [device for device in devices if device.kind != "yield"]
    for k, device in enumerate(made):
        stage = stations.station(device, track, every, place + (0.5 + stations.SPARE) * size)
        last = stage.exit + (TAIL * size if k + 1 == len(made) else 0.0)
        for row in stage.plates:
            frame, depth, borders = _plate(stage, row)
            frame[0, 2] += level
            if frame[3, 2] > 0.9:
                floors.append((frame[0, 2], depth, _area(borders), place, last))
            else:
                gates.append((frame, depth, borders))
        level -= stage.drop
        windows.append((place, stage.exit, level))
        place = stage.exit
    ends = -room - size, place + TAIL * size
    if not made:
        floors.append((0.0, stations.THICK, _area(bare.borders), 0.0, ends[1]))
    rows, borders = stations._stacked([*_joined(floors, track.radius, ends), *gates])
    stage = stations.Stage(stations.BARE, rows, borders, begin=-room, exit=np.inf)
    places = np.reshape(windows, (-1, 3))
    levels = np.append(0.0, places[:, 2])
    return CrowdedTrack(stage, -room, check.frozen(places[:, :2]), check.frozen(levels), place)


def _joined(floors, radius, ends):
    """One plate for each level of the track, of the stretches that lie on it."""
    for level in sorted({round(one[0], 9) for one in floors}, reverse=True):
        own = [one for one in floors if abs(one[0] - level) < 1e-9]
        areas = [_between(area, radius, first, last) for _, _, area, first, last in own]
        whole = shapely.simplify(shapely.union_all(areas, grid_size=GRID), EVEN)
        frame = np.array([[0.0, 0.0, level], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
        borders = stations._rings(whole, lambda a, b: stations._drawn_end(a, b, radius, ends))
        yield frame, max(one[1] for one in own), borders


def _turned(area, place, radius):
    """An area at another place along the wall."""
    return shapely.affinity.rotate(area, place / radius, origin=(0.0, radius), use_radians=True)


def _plate(stage, row):
    """Frame, depth and borders of a plate."""
    borders = stage.borders[int(row[search.FIRST]) : int(row[search.LAST])]
    return np.array(row[: search.DEPTH]).reshape(4, 3), row[search.DEPTH], borders


def _between(area, radius, first, last):
    """What of an area lies between two places along the wall, and a little more, to join it to the next."""
    angles = np.linspace(first - JOINT, last + JOINT, 17) / radius
    fan = [(4.0 * radius * np.sin(a), radius - 4.0 * radius * np.cos(a)) for a in angles]
    return area.intersection(shapely.Polygon([(0.0, radius), *fan]))


def _area(borders):
    """What is solid within borders (B, 10)."""
    area, ring = shapely.Polygon(), []
    for k, border in enumerate(borders):
        ring.append(border[:2])
        if k + 1 == len(borders) or np.hypot(*(borders[k + 1, :2] - border[2:4])) > GRID:
            area = area.symmetric_difference(shapely.make_valid(shapely.Polygon(ring)))
            ring = []
    return area


def arrays(solid, count):
    """Return the arrays of the kernel for so many parts."""
    ways = np.vstack([solid.edges, solid.edges[:, ::-1]])
    ways = ways[np.lexsort((ways[:, 1], ways[:, 0]))]
    size = len(solid.corners)
    first = np.searchsorted(ways[:, 0], np.arange(size + 1)) + size + 1
    return Crowd(
        states=np.zeros((count, body.STATE)),
        before=np.zeros((count, body.STATE)),
        turns=np.zeros((count, 9)),
        rows=np.zeros((count, runs.CONTACTS, contact.WIDTH)),
        counts=np.zeros(count, np.int64),
        pairs=np.zeros((2 * PAIRS, contact.WIDTH)),
        owners=np.zeros(2 * PAIRS, np.int64),
        strains=np.zeros((count, 2)),
        links=np.concatenate([first, ways[:, 1]]).astype(np.int64),
        low=np.array(solid.vertices.min(axis=0)),
        high=np.array(solid.vertices.max(axis=0)),
        move=np.zeros(12),
        spots=np.zeros((size, 3)),
        near=np.zeros(len(solid.edges), np.int64),
        far=np.zeros(len(solid.edges), np.int64),
        corners=np.zeros(size, np.int64),
        faces=np.zeros(len(solid.triangles), np.int64),
        box=np.zeros(6),
        tangent=np.array([1.0, 0.0]),
    )


class PartsOnTrack:
    """N parts on a track, moved period by period; lengths in units of the part's, along the wall.

    Parameters
    ----------
    known : runs.BowlOfPart
    track : CrowdedTrack
    count : int
        Parts at most.
    """

    def __init__(self, known, track, count):
        self.known, self.solid = known, known.solid
        self.surface = runs.surface_of(known, track.stage, (np.inf, np.inf, 0.0, np.inf))
        self.arrays, self.on = arrays(known.solid, count), np.zeros(count, bool)
        self.work = runs.scratch(known.solid, len(self.surface.borders))
        self.period = 2.0 * np.pi / known.floor.rate

    def lay(self, n, state):
        """Put part n onto the track."""
        self.arrays.states[n] = state
        self.on[n] = True

    def take(self, n):
        """Take part n off the track."""
        self.on[n] = False

    def ride(self, turn):
        """Move all through one period of the drive, the ``turn``-th; how deep anything was in anything."""
        return kernel.follow(
            self.surface, self.solid, self.known.floor, self.arrays, self.work, self.on,
            turn * self.period, round(self.period / self.known.floor.step),
        )  # fmt: skip

    @property
    def forces(self):
        """Return (N, 2) mean forces of others in the last period, from behind and below, over the weight."""
        return self.arrays.strains / self.period

    def extents(self, n):
        """Return how far part n reaches along the wall, rear and front, and its lowest point."""
        return extents(self.arrays.states[n], self.solid, self.known.radius)


def compiled():
    """Say whether the kernel of the queue is on disk already."""
    return on_disk(kernel.follow)


def extents(state, solid, radius):
    """Return how far a part reaches along the wall, rear and front, and its lowest point."""
    spots = state[:3] + np.einsum("ij,cj->ci", runs.matrix(state), solid.corners)
    ways = radius * np.arctan2(spots[:, 0], radius - spots[:, 1])
    return ways.min(), ways.max(), spots[:, 2].min()
