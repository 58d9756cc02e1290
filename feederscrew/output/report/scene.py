"""The part for the viewer: its mesh once, in single precision, and a pose for each aspect."""

import base64

import numpy as np
from scipy.spatial.transform import Rotation

from feederscrew.output.columns import MM
from feederscrew.output.solid.stance import outermost, stance

MOST_FACETS = 200_000  # that a browser is shown
FINEST = 2.0**10  # cells across the part of the first grid tried on a larger mesh


def scene(part, found, rows):
    """What the viewer draws.

    Parameters
    ----------
    part : Part
        With a mesh.
    found : Aspects
    rows : sequence of int
        Which aspects.

    Returns
    -------
    dict
        For JSON: ``positions`` (float32) and ``index`` (uint32), both little-endian in base64, in mm about
        the centre of mass; ``radius``; ``facets`` shown, of ``all``; ``poses``; and the viewer's place.
    """
    points = (part.vertices - part.centre_of_mass) / MM
    vertices, faces = reduced(points, part.faces)
    radius = float(np.linalg.norm(points, axis=1).max())
    near = outermost(points / radius)
    stances = [stance(near, found.normals[row], found.heights[row] / MM / radius) for row in rows]
    back = stances[0].floor_axes @ stances[0].camera.back
    return {
        "positions": _base64(vertices, "<f4"),
        "index": _base64(faces, "<u4"),
        "radius": _short(radius),
        "facets": len(faces),
        "all": len(part.faces),
        "azimuth": _short(np.degrees(np.arctan2(back[1], back[0]))),
        "elevation": _short(np.degrees(np.arcsin(back[2]))),
        "poses": [_pose(found, row, standing) for row, standing in zip(rows, stances)],
    }


def reduced(vertices, faces, most=MOST_FACETS):
    """A mesh of at most so many facets: corners of one grid cell become one, facets that vanish go.

    Parameters
    ----------
    vertices : (V, 3) float
    faces : (F, 3) int
    most : int

    Returns
    -------
    vertices : (W, 3) float
    faces : (G, 3) int
    """
    cells, lowest = FINEST, vertices.min(axis=0)
    extent = np.ptp(vertices, axis=0).max()
    kept, corners = faces, vertices
    while len(kept) > most:
        grid = np.floor((vertices - lowest) * (cells / extent)).astype(np.int64)
        _, place = np.unique(grid, axis=0, return_inverse=True)
        place = place.ravel()
        count = np.bincount(place)
        corners = np.column_stack([np.bincount(place, vertices[:, k]) / count for k in range(3)])
        kept = place[faces]
        kept = kept[(kept != np.roll(kept, 1, axis=1)).all(axis=1)]
        cells /= np.sqrt(2.0)
    return corners, kept


def _pose(found, row, standing):
    """Name, rotation (x, y, z, w) from the file's axes to the floor's, height and contact polygon."""
    return {
        "name": found.names[row],
        "quaternion": [_short(q) for q in Rotation.from_matrix(standing.floor_axes).as_quat(canonical=True)],
        "height": _short(found.heights[row] / MM),
        "contact": [_short(x) for x in found.polygons[row].ravel() / MM],
    }


def _base64(array, kind):
    return base64.b64encode(np.ascontiguousarray(array, dtype=kind).tobytes()).decode()


def _short(value):
    return float(f"{value:.7g}")
