"""The dual angle between two screws: how far apart and how much turned their axes are."""

import numpy as np

from feederscrew.screw.dual import Dual
from feederscrew.screw.point import dot, length

PARALLEL_BELOW = 16.0 * np.finfo(float).eps  # [rad] the rounding of two unit vectors' cross product


def dual_angle(first, second):
    """Return the angle and distance between the axes of two screws, a + eps d.

    Parameters
    ----------
    first, second : Screw of shape (...,)
        Of any kinds; only their axes matter.

    Returns
    -------
    Dual of shape (...,)
        real : a [rad], 0 to pi. dual : d [m] along the common normal n = s1 x s2, positive where the second
        axis lies on the side n points to; parallel axes have many normals and d >= 0. Where a screw has no
        axis (couple, translation) d is NaN and a is taken from its free vector; NaN for the zero screw.

    References
    ----------
    E. Study, "Geometrie der Dynamen", Teubner, Leipzig, 1903.
    """
    axis, other = first.axis, second.at(first.reference).axis
    normal = np.cross(axis.direction, other.direction)
    sine, cosine = length(normal), dot(axis.direction, other.direction)
    between = other.foot - axis.foot
    beside = length(between - dot(between, axis.direction)[..., None] * axis.direction)
    parallel = sine < PARALLEL_BELOW
    along = dot(between, normal) / np.where(parallel, 1.0, sine)
    return Dual(np.arctan2(sine, cosine), np.where(parallel, beside, along))
