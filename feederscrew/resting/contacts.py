"""Contact polygons: the outline of the corners a part stands on."""

import numpy as np

from feederscrew.geometry import groups, vectors

TINY = np.finfo(float).tiny
ON_A_LINE = 1e-6  # of the contact's size: a corner off the line between its neighbours by less is none


def outlines(vertices, corners, owners, normals):
    """Return the convex outlines of points about planes.

    Source: own; docs/resting.md, "Barriers and the tipping graph".

    Parameters
    ----------
    vertices : (V, 3) float [m]
    corners, owners : (N,) int
        The points of the outlines, and to which of them each belongs, ascending.
    normals : (F, 3) float [1]
        Of the planes, outward.

    Returns
    -------
    list of (K, 3) float [m]
        Counter-clockwise seen against the normal, no corner on a line between its neighbours; the points as
        they are where they lie on one line.
    """
    points, count = vertices[corners], len(normals)
    x, y = (vectors.dot(points, axes[owners]) for axes in _across(normals))
    u, v = (seen - (groups.sums(seen, owners, count) / np.bincount(owners))[owners] for seen in (x, y))
    around = np.lexsort((np.arctan2(v, u), owners))
    convex = _turn_at_every_corner(x[around], y[around], owners, count)
    turned, as_given = (groups.split(of, owners, count) for of in (points[around], points))
    return [
        polygon if sound else _of_extreme_points(own, normal)
        for polygon, sound, own, normal in zip(turned, convex, as_given, normals)
    ]


def _of_extreme_points(points, normal):
    """The same where some of the points lie within the outline or straight between others."""
    from scipy.spatial import ConvexHull, QhullError

    plane = vectors.product(points, np.column_stack(_across(normal)))
    try:
        corners = points[ConvexHull(plane).vertices]
    except QhullError:  # a contact line: a sliver of the hull
        return points
    return _without_straight_corners(corners)


def _across(normals):
    """Unit vectors (..., 3) and (..., 3) in planes of normals (..., 3), the three right-handed."""
    first = np.eye(3)[np.abs(normals).argmin(axis=-1)]
    u = vectors.unit(vectors.cross(normals, first))
    return u, vectors.cross(normals, u)


def _turn_at_every_corner(x, y, owners, count):
    """(F,) whether polygons of corners (N,) and (N,) turn left at every one, none of them on a line."""
    first = groups.starts(owners, count)
    before = np.arange(len(x)) - 1
    before[first] = np.append(first[1:], len(x)) - 1
    u, v = x - x[before], y - y[before]
    p, q = u[before], v[before]
    off = (p * v - q * u) / np.maximum(np.hypot(p + u, q + v), TINY)
    width, depth = (np.maximum.reduceat(at, first) - np.minimum.reduceat(at, first) for at in (x, y))
    return np.logical_and.reduceat(off > ON_A_LINE * np.hypot(width, depth)[owners], first)


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
