"""The part for the viewer: its mesh once, in single precision, and a pose for each aspect."""

import base64

import numpy as np
from scipy.spatial.transform import Rotation

from feederscrew.output.columns import MM
from feederscrew.output.solid.stance import outermost, stance
from feederscrew.output.tooling import relief

REACH = 1.25  # of the part's radius: how much of the track around it is seen
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


def over_cuts(part, met, every):
    """Return what the viewer draws of a part over the cuts of a track.

    Parameters
    ----------
    part : Part
        With a mesh.
    met : sequence of Passage
        Each becomes a pose, its device's section of track with it.
    every : sequence of Orientation
        Of the part.

    Returns
    -------
    dict
        As ``scene``, with ``tracks``: the sections in mm, ahead, inwards and up from the foot of the centre
        of mass; and ``reach``, how far the view goes, in radii of the part.
    """
    points = (part.vertices - part.centre_of_mass) / MM
    vertices, faces = reduced(points, part.faces)
    tracks = [relief.track_below(one, every) for one in met]
    return {
        "positions": _base64(vertices, "<f4"),
        "index": _base64(faces, "<u4"),
        "radius": _short(np.sqrt((points**2).sum(axis=1).max())),
        "facets": len(faces),
        "all": len(part.faces),
        "azimuth": _short(np.degrees(np.arctan2(relief.VIEW[1], relief.VIEW[0]))),
        "elevation": _short(np.degrees(np.arctan2(relief.VIEW[2], np.hypot(*relief.VIEW[:2])))),
        "reach": REACH,
        "tracks": [{"positions": _base64(v / MM, "<f4"), "index": _base64(f, "<u4")} for v, f in tracks],
        "poses": [_over_cut(one, place) for place, one in enumerate(met)],
    }


def _over_cut(met, place):
    """Name, rotation from the file's axes to the track's, height, hull of the support, and the track."""
    one = met.orientation
    hull = np.zeros((0, 3))
    if met.picture == "above" and one.kind != "hanging" and len(met.supported) > 3:
        flat = met.supported[:-1] - [0.0, one.distance]
        hull = np.column_stack([flat, np.full(len(flat), -one.posture.height)])
        hull = np.einsum("ni,ij->nj", hull, one.axes) / MM
    return {
        "name": one.name,
        "quaternion": [_short(q) for q in Rotation.from_matrix(one.axes).as_quat(canonical=True)],
        "height": _short(one.posture.height / MM),
        "contact": [_short(x) for x in hull.ravel()],
        "track": place,
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
