"""The part for the viewer: its mesh once, in single precision, and a pose for each aspect."""

from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from feederscrew.output import shading, tooling_views
from feederscrew.output.shading import outermost, short, stance
from feederscrew.units import MM

REACH = 1.25  # of the part's radius: how much of the track around it is seen


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
        As ``meshes.viewed``, for JSON, and ``poses``.
    """
    points = (part.vertices - part.centre_of_mass) / MM
    radius = float(np.sqrt((points**2).sum(axis=1).max()))
    near = outermost(points / radius)
    stances = [stance(near, found.normals[row], found.heights[row] / MM / radius) for row in rows]
    back = stances[0].floor_axes @ stances[0].camera.back
    return shading.viewed(part, back) | {
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
    tracks = [shading.track(*tooling_views.track_below(one, every)) for one in met]
    return shading.viewed(part, tooling_views.TO_VIEWER) | {
        "reach": REACH,
        "tracks": tracks,
        "poses": [_over_cut(one, place) for place, one in enumerate(met)],
    }


def _over_cut(met, place) -> dict[Any, Any]:
    """Name, rotation from the file's axes to the track's, height, hull of the support, and the track."""
    one = met.orientation
    hull = np.zeros((0, 3))
    if met.picture == "above" and one.kind != "hanging" and len(met.supported) > 3:
        flat = met.supported[:-1] - [0.0, one.distance]
        hull = np.column_stack([flat, np.full(len(flat), -one.posture.height)])
        hull = np.einsum("ni,ij->nj", hull, one.axes) / MM
    return {
        "name": one.name,
        "quaternion": [short(q) for q in Rotation.from_matrix(np.array(one.axes)).as_quat(canonical=True)],
        "height": short(one.posture.height / MM),
        "contact": [short(x) for x in hull.ravel()],
        "track": place,
    }


def _pose(found, row, standing) -> dict[Any, Any]:
    """Name, rotation (x, y, z, w) from the file's axes to the floor's, height and contact polygon."""
    return {
        "name": found.names[row],
        "quaternion": [
            short(q) for q in Rotation.from_matrix(np.array(standing.floor_axes)).as_quat(canonical=True)
        ],
        "height": short(found.heights[row] / MM),
        "contact": [short(x) for x in found.polygons[row].ravel() / MM],
    }
