"""The bowl with parts on its track, for the viewer of a page."""

import numpy as np

from feederscrew.output.solid import meshes
from feederscrew.output.solidbowl.bowl_picture import HIGH, SIDE, parts
from feederscrew.units import factor

MM = factor("mm", "length")
UPRIGHT = (0.0, 0.0, 0.0, 1.0)  # quaternion x, y, z, w
MOST = 60_000  # facets of all parts together


def scene(solid, part):
    """Return what the viewer draws of a bowl with its parts.

    Parameters
    ----------
    solid : BowlSolid
    part : Part
        With a mesh.

    Returns
    -------
    dict
        As ``report.scene.over_cuts`` has it: the parts in place of one, the bowl in place of the track, both
        in mm about the bowl's middle.
    """
    middle = 0.5 * (solid.vertices.min(axis=0) + solid.vertices.max(axis=0))
    points, faces = parts(solid, part)
    points, faces = meshes.reduced((points - middle) / MM, faces, MOST)
    bowl = solid.vertices - middle
    return {
        **meshes.track(points * MM, faces),
        "radius": meshes.short(np.sqrt((bowl**2).sum(axis=1).max()) / MM),
        "facets": len(faces),
        "all": len(faces),
        "azimuth": meshes.short(np.degrees(solid.plan.turned) + SIDE),
        "elevation": meshes.short(HIGH),
        "unmarked": True,
        "tracks": [meshes.track(bowl, solid.faces)],
        "poses": [{"name": "bowl", "quaternion": UPRIGHT, "height": 0.0, "contact": [], "track": 0}],
    }
