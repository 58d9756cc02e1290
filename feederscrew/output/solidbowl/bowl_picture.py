"""The bowl with parts on its track, as a picture."""

import numpy as np

from feederscrew.output import shading as shading_output
from feederscrew.output import style
from feederscrew.output.shading import SINGLE, Rays
from feederscrew.output.solidbowl import views
from feederscrew.solidbowl import riding

COLUMNS, ROWS = 1500, 1050  # [px]
SIDE, HIGH = -118.0, 40.0  # [deg] from where it is seen, from the outlet's begin
PART = np.array([0.93, 0.55, 0.20])
MARGIN = 1.03
BAND = 16  # rows of pixels at a time


def figure(study):
    """Return the figure of a bowl with parts on its track.

    Parameters
    ----------
    study : MachineSheet
        With its order and its solid.

    Returns
    -------
    Figure
    """
    return style.pixels(_image(study.solid.with_lugs, study.order.part, COLUMNS, ROWS))


def parts(solid, part):
    """Return the parts along the track of a bowl as one mesh, vertices (V, 3) [m] and faces (F, 3)."""
    own = part.vertices - part.centre_of_mass
    placed = [riding.laid(solid.plan, one, own, s) for one, s in solid.riders]
    if not placed:
        return np.zeros((0, 3)), np.zeros((0, 3), int)
    faces = [part.faces + len(own) * k for k in range(len(placed))]
    return np.concatenate(placed), np.concatenate(faces)


def _image(solid, part, columns, rows):
    looked = views.camera(np.degrees(solid.plan.turned) + SIDE, HIGH)
    points, faces = parts(solid, part)
    centre = 0.5 * (solid.vertices.min(axis=0) + solid.vertices.max(axis=0))
    corners = np.concatenate([solid.vertices, points])
    whole = Rays(corners, np.concatenate([solid.faces, faces + len(solid.vertices)]), centre)
    across, up = _frame(looked.project(whole.points), columns, rows)
    image = np.full((rows, columns, 3), 255, dtype=np.uint8)  # numbers of eight bytes: 100 MB more
    each = shading_output.SAMPLES
    for first in range(0, rows, BAND):
        place = slice(max(0, each * first - 2), each * (first + BAND) + 2)
        drawn = _drawn(whole, len(solid.faces), looked, across, up[place])
        kept = drawn[each * first - place.start :][: each * min(BAND, rows - first)]
        image[first : first + BAND] = np.rint(255.0 * shading_output.averaged(kept, each))
    return image


def _frame(seen, columns, rows):
    """Positions of the samples across and up the picture."""
    low, high = seen.min(axis=0), seen.max(axis=0)
    pixel = MARGIN * max((high - low)[0] / columns, (high - low)[1] / rows) / shading_output.SAMPLES
    middle = 0.5 * (low + high)
    counts = columns * shading_output.SAMPLES, rows * shading_output.SAMPLES
    across, up = (pixel * (np.arange(n) + 0.5 - 0.5 * n) for n in counts)
    return middle[0] + across, (middle[1] + up)[::-1]


def _drawn(whole, bowl, looked, across, up):
    """The samples of some rows; the first ``bowl`` facets are the bowl's, the others those of parts."""
    depths, normals, met = looked.meet(whole, across, up)
    image = np.ones((*depths.shape, 3), dtype=SINGLE)
    for drawn, colour in (((met >= 0) & (met < bowl), shading_output.STEEL), (met >= bowl, PART)):
        image[drawn] = shading_output.lit(normals[drawn], looked, colour)
    image[shading_output.edges(depths, normals, looked, up[0] - up[1])] = shading_output.EDGE
    return image
