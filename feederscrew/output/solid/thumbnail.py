"""A part on one of its aspects, small and in the middle of its picture."""

import numpy as np

from feederscrew.output.solid import shading
from feederscrew.output.solid.shading import Shot
from feederscrew.output.solid.stance import outermost, stance

DOWN = np.array([0.0, 0.0, -1.0])
ROOM = 1.08  # of the picture over the part in it


def pixels(solid, found, row, size):
    """Return the picture of a solid on one aspect.

    Parameters
    ----------
    solid : Rays
    found : Aspects
        Of the same part.
    row : int
        Of the aspect.
    size : (2,) int [px]
        Width and height.

    Returns
    -------
    (height, width, C) float [1]
    """
    standing = stance(outermost(solid.points), found.normals[row], found.heights[row] / solid.size)
    return _framed(solid, standing, size)


def on_its_lowest(solid, size):
    """Return the picture of a solid on the lowest side of its file, (height, width, C) float [1].

    Parameters
    ----------
    solid : Rays
    size : (2,) int [px]
        Width and height.
    """
    standing = stance(outermost(solid.points), DOWN, -float(solid.points[:, 2].min()))
    return _framed(solid, standing, size)


def _framed(solid, standing, size):
    """The picture of a solid in the middle of it."""
    lowest, highest = standing.framed
    pixel = ROOM * max((highest - lowest) / size)
    left, bottom = 0.5 * (lowest + highest) - 0.5 * pixel * np.array(size)
    return np.clip(shading.picture(solid, standing, Shot(left, bottom, pixel, *size)), 0.0, 1.0)
