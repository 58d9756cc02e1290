"""Contact polygons: the outline of the corners a part stands on."""

import numpy as np

from feederscrew.geometry import vectors

TINY = np.finfo(float).tiny
ON_A_LINE = 1e-6  # of the contact's size: a corner off the line between its neighbours by less is none


def outline(points, normal):
    """Return the convex outline of points about a plane.

    Parameters
    ----------
    points : (N, 3) float [m]
    normal : (3,) float [1]
        Of the plane, outward.

    Returns
    -------
    (K, 3) float [m]
        Counter-clockwise seen against the normal, no corner on a line between its neighbours; the points as
        they are where they lie on one line.
    """
    k = int(np.argmax(np.abs(normal)))
    x, y = points.T[[k - 2, k - 1] if normal[k] > 0.0 else [k - 1, k - 2]]  # seen along an axis of the file
    around = np.argsort(np.arctan2(y - y.mean(), x - x.mean()))
    if _turns_at_every_corner(x[around], y[around]):
        return points[around]
    return _of_extreme_points(points, normal)


def _of_extreme_points(points, normal):
    """The same where some of the points lie within the outline or straight between others."""
    from scipy.spatial import ConvexHull, QhullError

    first = np.eye(3)[np.argmin(np.abs(normal))]
    u = vectors.unit(vectors.cross(normal, first))
    plane = vectors.product(points, np.column_stack([u, vectors.cross(normal, u)]))
    try:
        corners = points[ConvexHull(plane).vertices]
    except QhullError:  # a contact line: a sliver of the hull
        return points
    return _without_straight_corners(corners)


def _turns_at_every_corner(x, y):
    """Whether a polygon of corners (K,) and (K,) turns left at every one, none of them on a line."""
    before = np.arange(len(x)) - 1
    u, v = x - x[before], y - y[before]
    p, q = u[before], v[before]
    off = (p * v - q * u) / np.maximum(np.hypot(p + u, q + v), TINY)
    return bool((off > ON_A_LINE * np.hypot(np.ptp(x), np.ptp(y))).all())


def _without_straight_corners(corners):
    """Corners (K, 3) of a polygon without those on a line between their neighbours.

    A finer triangulation of the same face brings such corners, and rules that average over the edges of a
    contact would count its edges twice.
    """
    size = vectors.length(np.ptp(corners, axis=0))
    while len(corners) > 3:
        before, after = np.roll(corners, 1, axis=0), np.roll(corners, -1, axis=0)
        twice = vectors.length(vectors.cross(corners - before, after - corners))
        off = twice / np.maximum(vectors.length(after - before), TINY)
        straight = int(np.argmin(off))
        if off[straight] > ON_A_LINE * size:
            break
        corners = np.delete(corners, straight, axis=0)
    return corners
