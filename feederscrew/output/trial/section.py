"""The track of one station as a solid to be seen: what the trial's kernel had the part meet."""

import itertools
from typing import Any

import numpy as np
import shapely

from feederscrew.output.trial.figures import solids, unrolled
from feederscrew.tooling import solid
from feederscrew.tooling.track_sections import bend_ring

WALL = 3e-3  # [m] thickness of the wall that is drawn


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
    meshes += _wall(station, track, height)
    first = np.cumsum([0] + [len(vertices) for vertices, _ in meshes])
    corners = np.concatenate([vertices for vertices, _ in meshes])
    return corners, np.concatenate([faces + n for (_, faces), n in zip(meshes, first)])


def _plate(station, k, track) -> tuple[Any, ...]:
    """One plate as a body (V, 3) [m], as deep as it is, ended at the wall."""
    row = station.plates[k]
    area = shapely.Polygon()
    for ring in solids(station, k):
        area = area.symmetric_difference(shapely.make_valid(shapely.Polygon(ring)))
    if k == 0:
        area = area.intersection(shapely.Point(0.0, track.radius).buffer(track.radius, quad_segs=256))
    vertices, faces = solid.prism(area, -row.depth, 0.0)
    origin, *axes = ([row[f"{name}_{e}"] for e in "xyz"] for name in ("origin", "first", "second", "front"))
    return np.array(origin) + np.einsum("vi,ij->vj", vertices, np.array(axes)), faces


def _wall(station, track, height) -> list[Any]:
    """The wall behind the track, over its length, stretch by stretch."""
    corners = np.concatenate(solids(station))
    way, _ = unrolled(np.column_stack([np.zeros(len(corners)), corners]), track.radius)
    low, high = way.min(), way.max()
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
