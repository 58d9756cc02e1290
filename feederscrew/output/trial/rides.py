"""Parts of a trial to be seen: those worth a picture, the station as solids, what the viewer plays."""

import itertools
from dataclasses import dataclass

import numpy as np
import shapely
from scipy.spatial.transform import Rotation

from feederscrew.arrivals.kernel import body
from feederscrew.base.arrays import Floats
from feederscrew.base.columns import Document
from feederscrew.base.units import MM
from feederscrew.bowl.record import Track
from feederscrew.output import shading, tooling_views
from feederscrew.output.shading import Mesh, encode_base64, join_meshes, short
from feederscrew.output.trial.figures import solids, unroll_path
from feederscrew.part.record import Part
from feederscrew.sorting import solid
from feederscrew.sorting.tooled_track import along_wall, bend_ring
from feederscrew.trials import course, looks, runs
from feederscrew.trials.course import Fate
from feederscrew.trials.result import TrialRun
from feederscrew.trials.shape import solid_of
from feederscrew.trials.staging import Stage

ALWAYS = (-np.inf, np.inf)  # [s] when a steady jet blows
WALL = 3e-3  # [m] thickness of the wall that is drawn
SIDES = 24  # of a nozzle, and of the cone of its air
NOZZLE_LENGTH = 6.0  # of the radius of its mouth
SENSOR_HEIGHT, SENSOR_SIZE = 2.3, 0.7  # of the part's radius: off the track or its edge; its sides
REACH = 1.9  # of the part's radius: how much of the track around it is seen
STILL, AFTER = 0.05, 0.3  # [mm], [s] a part that moves no more than that to the end is left out after so long


@dataclass(frozen=True, eq=False)
class DeviceRide:
    """One part at one station."""

    place: int  # station
    orientation: str  # it was laid down in
    fate: Fate
    path: Floats  # (K, 8) time [s], position [m], attitude w x y z (principal axes to bowl)
    looked: float = np.nan  # [s] when the sensor looks at it; NaN without one
    blows: tuple[float, float] | None = None  # [s] from when to when jets blow at it; None where none does
    becomes: str = ""  # the orientation in which it goes on, where the device turned it

    def title(self, sent: course.Course) -> str:
        """Return 'A@0 at gap 9 mm: returned'; of a device of several values its kind alone."""
        return f"{self.orientation} {self.caption(sent)}"

    def caption(self, sent: course.Course) -> str:
        """Return the same without the orientation: 'at gap 9 mm: returned', 'at step 5 mm: becomes B@90'."""
        device = sent.stations[self.place].device
        value = device.short if device.is_one_value else ""
        where = f"{device.kind} {value}".strip()
        outcome = f"becomes {self.becomes}" if self.becomes else self.fate.word.replace("_", " ")
        return f"at {where}: {outcome}"


def rides_to_show(part: Part, *tried: TrialRun) -> list[DeviceRide]:
    """Return a part that passes and one that does not, if there are both, at the device that decides.

    ``tried`` are runs of the same bowl: the device is that of the first of them that loses a part at a
    device.
    """
    losing = (run for run in tried if any((r.outcomes != runs.PASSED).any() for r in run.course.rides[1:]))
    place = deciding_station(next(losing, tried[0]).course)
    rides = []
    for passes in (True, False):
        for run in tried:
            sent = run.course
            if place >= len(sent.rides):  # no part comes so far
                continue
            ride = sent.rides[place]
            riders = np.flatnonzero((ride.outcomes == runs.PASSED) == passes)
            if not len(riders):
                continue
            number, path = sent.riders[place][riders[0]], ride.paths[riders[0]]
            path = path[np.isfinite(path[:, 0])]
            fate = Fate.PASSED if passes else Fate(int(sent.fates[number]))
            name = run.orientations.lying[sent.entry_rows[number]].name
            air = _air_at(part, run, sent.stations[place], path)
            rides.append(DeviceRide(place, name, fate, path, *air, _becomes(run, place, number) * passes))
            break
    return rides


def _becomes(run: TrialRun, place: int, number: int) -> str:
    """The orientation into which a station turned a part; '' where it goes on as it came."""
    before, after = run.course.orientations[place : place + 2, number].tolist()
    if after == before or after < looks.OTHER:
        return ""
    return "another pose" if after == looks.OTHER else run.orientations.states[after].name


def deciding_station(sent: course.Course) -> int:
    """Return the device where most do not pass while others do; where all do the last station."""
    lost = [int((ride.outcomes != runs.PASSED).sum()) for ride in sent.rides]
    some = [0 < count < len(ride.outcomes) for count, ride in zip(lost, sent.rides)]
    if not any(lost[1:]):
        return len(lost) - 1
    return max(range(1, len(lost)), key=lambda place: (some[place], lost[place], -place))


def _air_at(
    part: Part, run: TrialRun, stage: Stage, path: Floats
) -> tuple[float, tuple[float, float] | None]:
    """When [s] a sensor looks at a part on its path, NaN without one; when jets blow, or None."""
    if not stage.air.watches:
        return np.nan, ALWAYS if len(stage.air.jets) else None
    watch, along = stage.air.watches[0], unroll_path(path, run.bowl.track.radius, stage.middle)[0]
    if not (along >= watch.place).any():
        return np.nan, None
    first = int(np.argmax(along >= watch.place))
    looked, (solid, length, _) = float(path[first, 0]), solid_of(part)
    state = np.zeros((1, body.STATE))
    state[0, :3], state[0, body.Q : body.Q + 4] = path[first, 1:4] / length, path[first, 4:]
    if not runs.blows_off(watch.sensor, runs.setting(solid, length, run.bowl), state):
        return looked, None
    speed = max((along[first] - along[0]) / max(looked - path[0, 0], 1e-9), runs.STANDING_SPEED_M_S)
    begin = looked + max(watch.nozzles - along[first], 0.0) / speed
    return looked, (begin, begin + watch.seconds)


def section(station: Stage, track: Track, height: float) -> Mesh:
    """Return the track with cuts, gates and its wall as a mesh in the bowl's frame.

    Parameters
    ----------
    station : Stage
    track : Track
    height : float [m]
        Of the wall.

    Returns
    -------
    vertices : (V, 3) float [m]
    faces : (F, 3) int
    """
    meshes = []
    for k, row in enumerate(station.plates):  # each plate as a body as deep as it is, ended at the wall
        area = shapely.Polygon()
        for ring in solids(station, k):
            area = area.symmetric_difference(shapely.make_valid(shapely.Polygon(ring)))
        if k == 0:
            area = area.intersection(shapely.Point(0.0, track.radius).buffer(track.radius, quad_segs=256))
        vertices, faces = solid.prism(area, -row.depth, 0.0)
        axes = np.array([_vector(row, name) for name in ("first", "second", "front")])
        meshes.append((_vector(row, "origin") + np.einsum("vi,ij->vj", vertices, axes), faces))
    # the wall behind the track, stretch by stretch: upright, or leaning back as the other face of a groove
    corners = np.concatenate(solids(station))
    along = along_wall(corners, track.radius, station.middle)
    low, high = along.min(), along.max()
    turns = [
        (slope.place, slope.wall and slope.wall - (slope.bank or 0.0))
        for slope in station.air.slopes
        if slope.wall is not None
    ]
    ends = [(low, 0.0), *((max(place, low), lean) for place, lean in turns), (high, 0.0)]
    for (begin, lean), (end, _) in itertools.pairwise(ends):
        if lean and end > begin:
            meshes.append(solid.leaning_wall(track.radius, begin, end, lean, height))
        elif end > begin:
            ring = np.array([[begin, -WALL], [end, -WALL], [end, 0.0], [begin, 0.0]])
            wall = shapely.Polygon(bend_ring(ring, track.radius))
            meshes.append(solid.prism(wall, -station.plates.depth[0], height))
    return join_meshes(meshes)


def fittings(stage: Stage, radius: float, size: float) -> list[Mesh]:
    """Return sensors and nozzles as bodies in the bowl's frame.

    A nozzle ends at its mouth in the wall. A sensor is a box: over the track, or beside its free edge where
    it sees parts from the bowl's axis. It is a sign, not the size of a real one.

    Parameters
    ----------
    stage : Stage
    radius : float [m]
        Of the wall.
    size : float [m]
        Of the part.

    Returns
    -------
    list of ((V, 3) float [m], (F, 3) int)
    """
    bodies = []
    for jet in stage.air.jets:
        mouth, direction, wide = _vector(jet, "mouth"), _vector(jet, "towards"), jet.radius
        start = mouth - NOZZLE_LENGTH * wide * direction
        bodies.append(_cone(start, direction, NOZZLE_LENGTH * wide, 2.0 * wide, 2.0 * wide))
    for watch in stage.air.watches:
        off, up = watch.sensor.wanted[0].distance, SENSOR_HEIGHT * size
        if watch.sensor.sees == "side":
            off, up = min(stage.width, radius) + SENSOR_HEIGHT * size, 0.5 * watch.sensor.wanted[0].height
        angle = watch.place / radius
        ahead = np.array([np.cos(angle), np.sin(angle), 0.0])
        inwards = np.array([-np.sin(angle), np.cos(angle), 0.0])
        axes = 0.5 * SENSOR_SIZE * size * np.array([ahead, inwards, [0.0, 0.0, 1.0]])
        middle = np.array([0.0, radius, up]) - (radius - off) * inwards
        corners, faces = solid.prism(shapely.box(-1.0, -1.0, 1.0, 1.0), -1.0, 1.0)
        bodies.append((middle + corners @ axes, faces))
    return bodies


def air_cones(stage: Stage, track_width: float) -> list[Mesh]:
    """Return the air of each nozzle of a stretch of track as a cone, as wide as the trial has it.

    Parameters
    ----------
    stage : Stage
    track_width : float [m]

    Returns
    -------
    list of ((V, 3) float [m], (F, 3) int)
    """
    cones = []
    for jet in stage.air.jets:
        mouth, long = (_vector(jet, "mouth"), _vector(jet, "towards")), min(jet.reach, 1.5 * track_width)
        cones.append(_cone(*mouth, long, jet.radius, jet.radius + jet.spread * long))
    return cones


def _vector(row: np.record, name: str) -> Floats:
    return np.array([row[f"{name}_{e}"] for e in "xyz"])


def _cone(start: Floats, direction: Floats, long: float, wide: float, wider: float) -> Mesh:
    """A truncated cone from a place [m] along a direction, of two radii [m]."""
    aside = np.cross(direction, np.eye(3)[np.argmin(np.abs(direction))])
    aside /= np.linalg.norm(aside)
    turns = 2.0 * np.pi * np.arange(SIDES) / SIDES
    ring = np.outer(np.cos(turns), aside) + np.outer(np.sin(turns), np.cross(direction, aside))
    corners = np.concatenate(
        [start + wide * ring, start + long * direction + wider * ring, [start, start + long * direction]]
    )
    here, after = np.arange(SIDES), (np.arange(SIDES) + 1) % SIDES
    far, first, last = SIDES + here, np.full(SIDES, 2 * SIDES), np.full(SIDES, 2 * SIDES + 1)
    sides = (here, after, far), (after, SIDES + after, far), (after, here, first), (far, SIDES + after, last)
    return corners, np.concatenate([np.column_stack(side) for side in sides])


def scene(part: Part, *tried: TrialRun) -> tuple[Document, list[tuple[str, str]]]:
    """Return what the viewer plays, and captions: one part that passes a device, one that does not.

    For JSON: mesh, ``tracks`` and view as in the report's other scenes; ``paths`` (K, 8) float32 in
    base64: time [s], centre of mass [mm] and attitude x y z w, from the file's axes to the bowl's;
    ``poses`` at the start of each, with the number of its path.
    """
    rides, run, sent = rides_to_show(part, *tried), tried[0], tried[0].course
    view = shading.scene_of_part(part, tooling_views.TO_VIEWER)
    cut = section(sent.stations[rides[0].place], run.bowl.track, 1.5 * view["radius"] * MM)
    paths, poses = [], []
    for place, ride in enumerate(rides):
        # time [s], place [mm] and attitude, x y z w, up to where it moves no more (K, 8)
        principal = Rotation.from_matrix(np.array(sent.principal)).inv()
        turns = Rotation.from_quat(ride.path[:, [5, 6, 7, 4]]) * principal
        path = np.column_stack([ride.path[:, 0], ride.path[:, 1:4] / MM, turns.as_quat()])
        moving = np.flatnonzero(np.abs(path[:, 1:4] - path[-1, 1:4]).max(axis=1) > STILL)
        last = path[moving[-1], 0] + AFTER if len(moving) else AFTER
        path = path[path[:, 0] <= max(last, path[min(1, len(path) - 1), 0])]
        start = {"quaternion": [short(q) for q in path[0, 4:]], "height": short(path[0, 3])}
        poses.append({"name": ride.orientation, **start, "contact": [], "track": 0, "path": place})
        paths.append(encode_base64(path, "<f4"))
    captions = [(ride.orientation, ride.caption(sent)) for ride in rides]
    return view | {"reach": REACH, "tracks": [shading.track(*cut)], "paths": paths, "poses": poses}, captions
