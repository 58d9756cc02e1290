"""One station as solids to be seen: its track as the trial's kernel had it, its sensor, nozzles and air."""

import itertools
from collections.abc import Sequence
from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray

from feederscrew.output.trial.figures import solids, unrolled
from feederscrew.tooling import solid
from feederscrew.tooling.track_sections import bend_ring
from feederscrew.trial.staging import Stage

WALL = 3e-3  # [m] thickness of the wall that is drawn
SIDES = 24  # of a nozzle, and of the cone of its air
NOZZLE_LENGTH = 6.0  # of the radius of its mouth
SENSOR_HEIGHT, SENSOR_SIZE = (
    2.3,
    0.7,
)  # of the part's radius: over the track, or off its free edge; and its sides
AIR_BEYOND = 1.5  # of the width of the track: how far a jet is drawn
Mesh = tuple[NDArray[np.float64], NDArray[np.int64]]  # corners (V, 3) [m] and faces (F, 3)


def section(station, track, height) -> tuple[Any, ...]:
    """Return the track with its cuts, its wall and its gates as one mesh in the bowl's frame.

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
    meshes = [_plate(station, k, track) for k in range(len(station.plates))]
    return joined(meshes + _wall(station, track, height))


def joined(meshes: Sequence[Mesh]) -> Mesh:
    """Return several meshes as one."""
    first = np.cumsum([0] + [len(vertices) for vertices, _ in meshes])
    corners = np.concatenate([vertices for vertices, _ in meshes])
    return corners, np.concatenate([faces + n for (_, faces), n in zip(meshes, first)])


def fittings(stage: Stage, radius: float, size: float) -> list[Mesh]:
    """Return the sensors and the nozzles of a stretch of track as bodies in the bowl's frame.

    A nozzle ends at its mouth in the wall. A sensor is a box: over the track, or beside
    its free edge where it sees parts from the bowl's axis. It is a sign, not the size of a real one.

    Parameters
    ----------
    stage : Stage
    radius : float [m]
        Of the wall.
    size : float [m]
        Radius of the part.

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
        ahead, inwards = (
            np.array([np.cos(angle), np.sin(angle), 0.0]),
            np.array([-np.sin(angle), np.cos(angle), 0.0]),
        )
        axes = 0.5 * SENSOR_SIZE * size * np.array([ahead, inwards, [0.0, 0.0, 1.0]])
        middle = np.array([0.0, radius, up]) - (radius - off) * inwards
        corners, faces = solid.prism(shapely.box(-1.0, -1.0, 1.0, 1.0), -1.0, 1.0)
        bodies.append((middle + corners @ axes, faces))
    return bodies


def air_cones(stage: Stage, track_width: float) -> list[Mesh]:
    """Return the air of each nozzle of a stretch of track as a cone, as wide as the trial has it."""
    cones = []
    for jet in stage.air.jets:
        long, wide = min(jet.reach, AIR_BEYOND * track_width), jet.radius
        cones.append(
            _cone(_vector(jet, "mouth"), _vector(jet, "towards"), long, wide, wide + jet.spread * long)
        )
    return cones


def _vector(row: np.record, name: str) -> NDArray[np.float64]:
    """Three fields of a record as a vector (3,)."""
    return np.array([row[f"{name}_{e}"] for e in "xyz"])


def _cone(
    start: NDArray[np.float64], direction: NDArray[np.float64], long: float, wide: float, wider: float
) -> Mesh:
    """A truncated cone from a place [m] along a direction, of two radii [m]."""
    aside = np.cross(direction, np.eye(3)[np.argmin(np.abs(direction))])
    aside /= np.linalg.norm(aside)
    turns = 2.0 * np.pi * np.arange(SIDES) / SIDES
    ring = np.outer(np.cos(turns), aside) + np.outer(np.sin(turns), np.cross(direction, aside))
    corners = np.concatenate(
        [start + wide * ring, start + long * direction + wider * ring, [start, start + long * direction]]
    )
    here, after = np.arange(SIDES), (np.arange(SIDES) + 1) % SIDES
    sides = [(here, after, SIDES + here), (after, SIDES + after, SIDES + here)]
    ends = [
        (after, here, np.full(SIDES, 2 * SIDES)),
        (SIDES + here, SIDES + after, np.full(SIDES, 2 * SIDES + 1)),
    ]
    return corners, np.concatenate([np.column_stack(side) for side in sides + ends])


def _plate(station, k, track) -> tuple[Any, ...]:
    """One plate as a body (V, 3) [m], as deep as it is, ended at the wall."""
    row = station.plates[k]
    area = shapely.Polygon()
    for ring in solids(station, k):
        area = area.symmetric_difference(shapely.make_valid(shapely.Polygon(ring)))
    if k == 0:
        area = area.intersection(shapely.Point(0.0, track.radius).buffer(track.radius, quad_segs=256))
    vertices, faces = solid.prism(area, -row.depth, 0.0)
    axes = np.array([_vector(row, name) for name in ("first", "second", "front")])
    return _vector(row, "origin") + np.einsum("vi,ij->vj", vertices, axes), faces


def _wall(station, track, height) -> list[Any]:
    """The wall behind the track, over its length, stretch by stretch."""
    corners = np.concatenate(solids(station))
    along, _ = unrolled(np.column_stack([np.zeros(len(corners)), corners]), track.radius)
    low, high = along.min(), along.max()
    turns = [(place, wall and wall - bank) for place, _, bank, wall in station.air.slopes if wall is not None]
    ends = [(low, 0.0), *((max(place, low), lean) for place, lean in turns), (high, 0.0)]
    return [
        _stretch(station, track, height, begin, end, lean)
        for (begin, lean), (end, _) in itertools.pairwise(ends)
        if end > begin
    ]


def _stretch(station, track, height, low, high, lean):
    """The wall between two places, upright or leaning back as the other face of a groove."""
    if lean:
        return solid.leaning_wall(track.radius, low, high, lean, height)
    ring = bend_ring(np.array([[low, -WALL], [high, -WALL], [high, 0.0], [low, 0.0]]), track.radius)
    return solid.prism(shapely.Polygon(ring), -station.plates.depth[0], height)
