"""The bowl with parts on its track, for the viewer of a page."""

import numpy as np

from feederscrew.output import marking, shading
from feederscrew.output.page.blocks import Notes, Views
from feederscrew.output.solidbowl.bowl_picture import HIGH, SIDE, parts
from feederscrew.units import MM

UPRIGHT = (0.0, 0.0, 0.0, 1.0)  # quaternion x, y, z, w
TURN = (
    "The bowl as one closed body, parts on its track. Drag it to turn it, or use the arrow keys; "
    "double-click sets it back."
)
CLOSE = 0.9  # of how far other views reach: from every side the whole bowl is seen
MOST = 60_000  # facets of all parts together


def blocks(solid, part, why="", mark=""):
    """Return what a page shows of a bowl: the solid to be turned, or why there is none.

    Parameters
    ----------
    solid : BowlSolid or None
    part : Part
        With a mesh.
    why : str
        There is none.
    mark : str
        Across it.

    Returns
    -------
    list of blocks
    """
    if solid is None:
        return [Notes((f"the bowl as a solid: {why}",))] if why else []
    text = f"{2.0 * solid.plan.way.radius / MM:.4g} mm, {solid.mass:.3g} kg as {solid.plan.material.name}"
    captions = ((marking.marked_title("bowl", mark), text, ()),)
    return [Views(scene(solid, part), captions, "solid-bowl", "The", hint=TURN, printed=True, mark=mark)]


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
    points, faces = shading.reduced_mesh((points - middle) / MM, faces, MOST)
    bowl = solid.vertices - middle
    return {
        **shading.track(points * MM, faces),
        "radius": shading.short(np.sqrt((bowl**2).sum(axis=1).max()) / MM),
        "facets": len(faces),
        "all": len(faces),
        "azimuth": shading.short(np.degrees(solid.plan.turned) + SIDE),
        "elevation": shading.short(HIGH),
        "unmarked": True,
        "colour": "parts",
        "reach": CLOSE,
        "tracks": [shading.track(bowl, solid.faces)],
        "poses": [{"name": "bowl", "quaternion": UPRIGHT, "height": 0.0, "contact": [], "track": 0}],
    }
