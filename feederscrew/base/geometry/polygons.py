"""Polygons in the floor: outlines seen from above, their centroids, what lies inside them."""

from typing import Any

import numpy as np

from feederscrew.base.arrays import Floats, Ints, Points, Vector

FLAT_CORNER_SHARE = 1e-6  # of the outline's size: a corner that stands out by less is none
BARRIER_RIPPLE_SHARE = 2e-3  # of its size: a lower barrier is one of a round side cut into facets


def outline(points: Points) -> Points:
    """Return the convex outline of points in a plane, without corners in the middle of a straight side.

    Parameters
    ----------
    points : (V, 2) float [m]
        Three at least, not all on one line.

    Returns
    -------
    (J, 2) float [m]
        Counter-clockwise.
    """
    from scipy.spatial import ConvexHull

    corners = points[ConvexHull(points).vertices]
    least = FLAT_CORNER_SHARE * np.ptp(corners, axis=0).max()
    while len(corners) > 3:  # one at a time: of two corners in one place one must stay
        before, after = np.roll(corners, 1, axis=0), np.roll(corners, -1, axis=0)
        chord = after - before
        standing_out = cross(corners - before, chord) / np.hypot(*chord.T)
        k = int(np.argmin(standing_out))
        if standing_out[k] > least:
            break
        corners = np.delete(corners, k, axis=0)
    return corners


def centroid(polygon: Points) -> Any:
    """Return the centroid of the area of a polygon.

    Parameters
    ----------
    polygon : (K, 2) float [m]

    Returns
    -------
    (2,) float [m]
        Of its corners where it has no area.
    """
    start = polygon[0]
    a, b = polygon - start, np.roll(polygon, -1, axis=0) - start
    twice = cross(a, b)
    if abs(twice.sum()) <= 1e-12 * np.square(np.ptp(polygon, axis=0)).sum():
        return polygon.mean(axis=0)
    return start + (twice[:, None] * (a + b)).sum(axis=0) / (3.0 * twice.sum())


def sides(polygon: Points) -> Points:
    """Return the vectors from each corner of a polygon to the next.

    Parameters
    ----------
    polygon : (K, 2) float [any length]

    Returns
    -------
    (K, 2) float [any length]
    """
    return np.roll(polygon, -1, axis=0) - polygon


def inset(polygon: Points, points: Points) -> Any:
    """Return how far points lie inside a convex polygon.

    That is the distance to the line of the nearest side. Outside it is negative; beyond a corner its size is
    less than the distance to the polygon.

    Parameters
    ----------
    polygon : (K, 2) float [m]
        Counter-clockwise.
    points : (..., 2) float [m]

    Returns
    -------
    (...,) float [m]
        NaN where the polygon has no corners.
    """
    if len(polygon) == 0:
        return np.full(np.shape(points)[:-1], np.nan)
    along = sides(polygon)
    along = along / np.hypot(*along.T)[:, None]
    return cross(along, np.asarray(points)[..., None, :] - polygon).min(axis=-1)


def surrounds(points: Points) -> bool:
    """Tell whether the origin lies inside the convex hull of points.

    Parameters
    ----------
    points : (V, 2) float [any length]

    Returns
    -------
    bool
        False on its border.
    """
    if len(points) == 0:
        return False
    angles = np.sort(np.arctan2(points[:, 1], points[:, 0]))
    return bool(np.diff(angles, append=angles[0] + 2.0 * np.pi).max() < np.pi)


def turned(points: Points, angle: float | Floats) -> Points:
    """Return points in a plane turned counter-clockwise about the origin.

    Parameters
    ----------
    points : (..., 2) float [any unit]
    angle : float or array [rad]
        It broadcasts with (...).

    Returns
    -------
    (..., 2) float [unit of the points]
    """
    c, s = np.cos(angle), np.sin(angle)
    return np.stack(
        [c * points[..., 0] - s * points[..., 1], s * points[..., 0] + c * points[..., 1]], axis=-1
    )


def cross(u: Floats, v: Floats) -> Any:
    """Return the third component of u x v, over the last axis: u1 v2 - u2 v1.

    It is positive where v lies to the left of u.

    Parameters
    ----------
    u, v : (..., 2) float [any units]

    Returns
    -------
    (...,) float [product of their units]
    """
    return u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0]


def barrier(points: Points) -> tuple[float, float]:
    """Return the angle by which a part that is turned in a plane first stands over a corner.

    Ripples of a round side count for nothing.

    Parameters
    ----------
    points : (V, 2) float [m]
        Its corners about the centre of mass: towards the side it turns to, and down.

    Returns
    -------
    angle : float [rad]
    height : float [m]
        Of its centre of mass then.
    """
    ring = outline(points)
    turn, far = np.arctan2(*ring.T), np.hypot(*ring.T)
    turn = np.where(turn < 0.0, turn + 2.0 * np.pi, turn)
    heights = (np.sin(turn)[:, None] * ring[:, 0] + np.cos(turn)[:, None] * ring[:, 1]).max(axis=1)
    stands = heights <= far * (1.0 + 1e-9)  # no other corner is lower there
    high = far >= ring[:, 1].max() + BARRIER_RIPPLE_SHARE * far.max()
    some = np.flatnonzero(stands & high)
    some = some if len(some) else np.flatnonzero(stands)
    first = some[np.argmin(turn[some])]
    return float(turn[first]), float(far[first])


def convex(points: Points) -> Ints:
    """Return the corners of a convex hull.

    Parameters
    ----------
    points : (V, 2) float [any length]

    Returns
    -------
    (H,) int
        Counter-clockwise; fewer than 3 where all points lie on a line.
    """

    def is_right(a: Vector, b: Vector, c: Vector) -> bool:
        """Return whether the way from a over b to c does not turn left."""
        return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) <= 1e-16

    order = np.lexsort((points[:, 1], points[:, 0]))
    chains = []
    for places in (order, order[::-1]):
        chain: list[int] = []
        for k in places.tolist():
            while len(chain) > 1 and is_right(points[chain[-2]], points[chain[-1]], points[k]):
                chain.pop()
            chain.append(k)
        chains += chain[:-1]
    return np.array(chains, dtype=np.int64)
