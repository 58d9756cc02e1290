"""Where a surface passes through itself: pairs of facets that cut each other along a line."""

from dataclasses import dataclass

import numpy as np

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
    found = [_cuts(vertices, faces, pairs, tolerance) for pairs in _candidates(vertices[faces], faces)]
    return Crossings(*(np.concatenate(column) for column in zip(_none(), *found)))


def _none():
    return np.empty((0, 2), dtype=int), np.empty(0), np.empty((0, 3))


def _candidates(corners, faces):
    """(N, 2) pairs of facets whose boxes overlap and that share one corner at most, some at a time."""
    import shapely

    if len(corners) > MOST:
        return
    low, high, plane = corners.min(axis=1), corners.max(axis=1), _planes(corners)
    x, y, z = np.argsort(-np.ptp(low, axis=0), kind="stable")
    boxes = shapely.box(low[:, x], low[:, y], high[:, x], high[:, y])
    tree = shapely.STRtree(boxes)
    seen, step = 0, max(1, CHUNK // len(boxes))
    for start in range(0, len(boxes), step):
        i, j = tree.query(boxes[start : start + step])
        i, seen = i + start, seen + len(i)
        if seen > MOST_PAIRS:
            return
        kept = (i < j) & (plane[i] != plane[j])
        i, j = i[kept], j[kept]
        kept = (low[i, z] <= high[j, z]) & (low[j, z] <= high[i, z])
        i, j = i[kept], j[kept]
        shared = (faces[i][:, :, None] == faces[j][:, None, :]).sum(axis=(1, 2))
        yield np.column_stack([i, j])[shared < 2]


def _planes(corners):
    """(F,) int the plane of each facet, those of one plane mostly the same: they do not cut each other."""
    normals = _normals(corners)
    offsets = np.einsum("fx,fx->f", normals, corners[:, 0]) / np.abs(corners).max()
    keys = np.round(np.column_stack([normals, offsets]) * FINE)
    return np.unique(keys, axis=0, return_inverse=True)[1].reshape(-1)


def _cuts(vertices, faces, pairs, tolerance):
    """Those of the pairs that cut each other along a line longer than the tolerance."""
    for one, other in ((0, 1), (1, 0)):  # each passes through the plane of the other
        sides = _sides(vertices, faces, pairs[:, one], pairs[:, other], tolerance)
        pairs = pairs[_through(sides) > 0.0]
    if not len(pairs):
        return _none()
    first, second = (vertices[faces[pairs[:, k]]] for k in (0, 1))
    along = np.cross(_normals(first), _normals(second))
    length = np.linalg.norm(along, axis=1)
    along = along / np.where(length > 0.0, length, 1.0)[:, None]
    of_first = _sides(vertices, faces, pairs[:, 0], pairs[:, 1], tolerance)
    of_second = _sides(vertices, faces, pairs[:, 1], pairs[:, 0], tolerance)
    (a, b), (c, d) = _interval(first, of_first, along), _interval(second, of_second, along)
    start, end = np.maximum(a, c), np.minimum(b, d)
    depths = np.minimum(end - start, np.minimum(_through(of_first), _through(of_second)))
    cut = (end - start > tolerance) & (length > 0.0)
    return pairs[cut], depths[cut], _points(first, of_first, along, start)[cut]


def _normals(corners):
    """(N, 3) unit normals; zero for a facet without area."""
    a, b, c = np.moveaxis(corners, 1, 0)
    normals = np.cross(b - a, c - a)
    length = np.linalg.norm(normals, axis=1)[:, None]
    return normals / np.where(length > 0.0, length, 1.0)


def _sides(vertices, faces, ones, others, tolerance):
    """(N, 3) [unit of the file] how far corners of ``ones`` lie above ``others``; 0 within tolerance."""
    planes = vertices[faces[others]]
    above = np.einsum("nkx,nx->nk", vertices[faces[ones]] - planes[:, :1], _normals(planes))
    return np.where(np.abs(above) <= tolerance, 0.0, above)


def _through(sides):
    """(N,) how far facets pass through planes: the less of both sides, 0 where they do not."""
    return np.minimum(sides.max(axis=1), -sides.min(axis=1)).clip(0.0)


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
