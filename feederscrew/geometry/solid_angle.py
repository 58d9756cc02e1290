"""Solid angles of flat faces seen from a point."""

import numpy as np

from feederscrew import check
from feederscrew.geometry import vectors


def solid_angles(apex, triangles):
    """Return the solid angle of each triangle, seen from one point.

    Parameters
    ----------
    apex : (3,) float [m]
        Viewpoint; for resting aspects, the part's centre of mass.
    triangles : (T, 3, 3) float [m]
        Corners by triangle, counter-clockwise seen from outside.

    Returns
    -------
    (T,) float [sr]
        Positive where the outer side faces away from ``apex``; triangles closed around it sum to
        4 pi. On a triangle, plus or minus 2 pi by rounding.

    Raises
    ------
    ValueError
        If a shape is wrong or an entry is not finite.

    References
    ----------
    A. van Oosterom, J. Strackee, "The solid angle of a plane triangle", IEEE Trans. Biomed. Eng.
    BME-30(2), 125-126, 1983.
    """
    apex = check.shaped("apex", apex, (3,))
    triangles = check.shaped("triangles", triangles, (-1, 3, 3))

    a, b, c = np.moveaxis(triangles - apex, 1, 0)  # corners from the apex, each (T, 3)
    la, lb, lc = (vectors.norm(corner) for corner in (a, b, c))
    triple = _dot(a, vectors.cross(b, c))
    rest = la * lb * lc + _dot(a, b) * lc + _dot(b, c) * la + _dot(c, a) * lb
    return 2.0 * np.arctan2(triple, rest)  # arctan would fold past half a sphere


def _dot(u, v):
    return np.einsum("ti,ti->t", u, v)
