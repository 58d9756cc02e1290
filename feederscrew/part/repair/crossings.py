"""Where a surface passes through itself: pairs of facets that cut each other along a line."""

from dataclasses import dataclass

import numpy as np

from feederscrew.geometry import coordinates, vectors
from feederscrew.part.repair import weld

MOST, MOST_PAIRS = 300_000, 20_000_000  # facets, and pairs of boxes that overlap: looked at within seconds
FINE = 1e7  # steps of a unit in which planes are told apart
CHUNK = 4_000_000  # pairs of boxes at a time, at most: what a hundred MB hold


@dataclass(frozen=True, eq=False)
class Crossings:
    """Pairs of facets that cut each other."""

    pairs: np.ndarray  # (N, 2) int
    depths: np.ndarray  # (N,) [unit of the file] how far each goes through, the least of all directions
    points: np.ndarray  # (N, 3) [unit of the file] one point of each cut


def crossings(vertices, faces, tolerance):
    """Find the facets that cut others they share no side with.

    Parameters
    ----------
    vertices : (V, 3) float [unit of the file]
    faces : (F, 3) int
    tolerance : float [unit of the file]
        What goes less deep only touches.

    Returns
    -------
    Crossings
        None are looked for in more than ``MOST`` facets, nor after ``MOST_PAIRS`` pairs.

    References
    ----------
    T. Möller, "A fast triangle-triangle intersection test", J. Graphics Tools 2(2), 25-30, 1997.
    """
    corners = vertices[faces]
    normals = _normals(corners)
    planes = _in_columns(corners, normals)
    near = [_piercing(*planes, pairs, tolerance) for pairs in _candidates(corners, normals)]
    pairs = np.concatenate([np.empty((0, 2), dtype=int), *near])
    if not len(pairs):
        return Crossings(pairs, np.empty(0), np.empty((0, 3)))
    return _cuts(corners, normals, _through_both(corners, normals, pairs, tolerance), tolerance)


def _candidates(corners, normals):
    """(N, 2) pairs of facets whose boxes overlap, but for many of one plane, some at a time."""
    import shapely

    if len(corners) > MOST:
        return
    a, b, c = corners.transpose(1, 0, 2)
    low, high = np.minimum(np.minimum(a, b), c), np.maximum(np.maximum(a, b), c)
    x, y, z = np.argsort(-np.ptp(low, axis=0), kind="stable")
    boxes = shapely.linestrings(np.stack([low[:, [x, y]], high[:, [x, y]]], axis=1))  # made sooner than boxes
    tree, plane = shapely.STRtree(boxes), _planes(corners, normals)
    floor, top = np.ascontiguousarray(low[:, z]), np.ascontiguousarray(high[:, z])
    seen, step = 0, max(1, CHUNK // len(boxes))
    for start in range(0, len(boxes), step):
        i, j = tree.query(boxes[start : start + step])
        i, seen = i + start, seen + len(i)
        if seen > MOST_PAIRS:
            return
        once = i < j
        i, j = i[once], j[once]
        kept = (plane[i] != plane[j]) & (floor[i] <= top[j]) & (floor[j] <= top[i])
        yield np.column_stack([i[kept], j[kept]])


def _planes(corners, normals):
    """(F,) int the plane of each facet, those of one plane mostly the same: they do not cut each other."""
    offsets = np.einsum("fx,fx->f", normals, corners[:, 0]) / np.abs(corners).max()
    return weld.distinct(np.round(np.column_stack([normals, offsets]) * FINE))[1]


def _in_columns(corners, normals) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(3, 3, F) coordinates of the corners from one of them, (3, F) normals, (F,) offsets of the planes."""
    places = np.ascontiguousarray((corners - corners[0, 0]).transpose(1, 2, 0))
    normals = np.ascontiguousarray(normals.T)
    return places, normals, coordinates.dot(normals, places[0])


def _piercing(places, normals, offsets, pairs, tolerance):
    """Those of the pairs of which each has corners on both sides of the other, by half the tolerance."""
    for one, other in ((0, 1), (1, 0)):
        ones, others = pairs[:, one], pairs[:, other]
        normal, offset = normals[:, others], offsets[others]
        a, b, c = (coordinates.dot(normal, corner[:, ones]) - offset for corner in places)
        above, below = np.maximum(np.maximum(a, b), c), np.minimum(np.minimum(a, b), c)
        pairs = pairs[(above > 0.5 * tolerance) & (below < -0.5 * tolerance)]
    return pairs


def _through_both(corners, normals, pairs, tolerance):
    """Those of the pairs of which each passes through the plane of the other: none that share a side."""
    for one, other in ((0, 1), (1, 0)):
        through = _through(_sides(corners, normals, pairs[:, one], pairs[:, other], tolerance))
        pairs = pairs[through > 0.0]
    return pairs


def _cuts(corners, normals, pairs, tolerance):
    """Those of the pairs that cut each other along a line longer than the tolerance."""
    i, j = pairs.T
    along = vectors.cross(normals[i], normals[j])
    length = vectors.norm(along)
    along = along / np.where(length > 0.0, length, 1.0)[:, None]
    of_first, of_second = (_sides(corners, normals, *order, tolerance) for order in ((i, j), (j, i)))
    (a, b), (c, d) = _interval(corners[i], of_first, along), _interval(corners[j], of_second, along)
    start, end = np.maximum(a, c), np.minimum(b, d)
    depths = np.minimum(end - start, np.minimum(_through(of_first), _through(of_second)))
    cut = (end - start > tolerance) & (length > 0.0)
    return Crossings(pairs[cut], depths[cut], _points(corners[i], of_first, along, start)[cut])


def _normals(corners):
    """(N, 3) unit normals; zero for a facet without area."""
    a, b, c = np.moveaxis(corners, 1, 0)
    normals = vectors.cross(b - a, c - a)
    length = vectors.norm(normals)[:, None]
    return normals / np.where(length > 0.0, length, 1.0)


def _sides(corners, normals, ones, others, tolerance):
    """(N, 3) [unit of the file] how far corners of ``ones`` lie above ``others``; 0 within tolerance."""
    above = np.einsum("nkx,nx->nk", corners[ones] - corners[others, :1], normals[others])
    return np.where(np.abs(above) <= tolerance, 0.0, above)


def _through(sides):
    """(N,) how far facets pass through planes: the less of both sides, 0 where they do not."""
    a, b, c = sides.T
    above, below = np.maximum(np.maximum(a, b), c), np.minimum(np.minimum(a, b), c)
    return np.minimum(above, -below).clip(0.0)


def _interval(corners, sides, along):
    """Where facets meet planes they pass through: from and to, (N,) and (N,), along a direction."""
    t = np.einsum("nkx,nx->nk", corners, along)
    u, s = np.roll(t, -1, axis=1), np.roll(sides, -1, axis=1)
    across = sides * s < 0.0
    cut = np.where(across, t + (u - t) * sides / np.where(across, sides - s, 1.0), np.nan)
    met = np.concatenate([cut, np.where(sides == 0.0, t, np.nan)], axis=1)
    return np.fmin.reduce(met, axis=1), np.fmax.reduce(met, axis=1)


def _points(corners, sides, along, start):
    """(N, 3) the points where cuts begin: on the line of the facet's own crossing, at ``start`` along it."""
    s = np.roll(sides, -1, axis=1)
    k = np.argmax(sides * s < 0.0, axis=1)
    n = np.arange(len(k))
    a, b = corners[n, k], corners[n, (k + 1) % 3]
    share = sides[n, k] / np.where(sides[n, k] == s[n, k], 1.0, sides[n, k] - s[n, k])
    point = a + share[:, None] * (b - a)
    return point + (start - np.einsum("nx,nx->n", point, along))[:, None] * along
