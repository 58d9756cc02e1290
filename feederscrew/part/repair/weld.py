"""Corners that coincide, joined."""

import numpy as np

from feederscrew.geometry import graphs

MIX = tuple(
    np.uint64(odd) for odd in (0x9E3779B97F4A7C15, 0xBF58476D1CE4E5B9, 0x94D049BB133111EB, 0xD6E8FEB86659FD93)
)
MOST_PAIRS = 10_000_000  # near pairs: what a few hundred MB hold


def welded(vertices, faces):
    """Triangles with each distinct corner once.

    Parameters
    ----------
    vertices : (V, 3) float [unit of the file]
        Finite.
    faces : (F, 3) int

    Returns
    -------
    vertices : (V', 3) float [unit of the file]
        Distinct, and all in use.
    faces : (F', 3) int
        Facets that have collapsed to an edge or a point are left out: their sides cancel.
    """
    first, group = distinct(vertices)
    return compacted(vertices[first], group[faces])


def compacted(vertices, faces) -> tuple[np.ndarray, np.ndarray]:
    """The same triangles without collapsed facets and without corners that no facet uses."""
    a, b, c = faces.T
    collapsed = (a == b) | (b == c) | (c == a)
    if collapsed.any():
        faces = faces[~collapsed]
    used = np.zeros(len(vertices), dtype=bool)
    used[faces] = True
    if used.all():
        return vertices, faces
    return vertices[used], (np.cumsum(used) - 1)[faces]


def distinct(rows):
    """Which rows are the same.

    Parameters
    ----------
    rows : (N, K) float [any]
        K up to 4. Finite; minus zero counts as zero.

    Returns
    -------
    first : (M,) int
        One row of each kind.
    group : (N,) int
        The kind of each row, an index into ``first``.
    """
    rows = np.ascontiguousarray(rows, dtype=float) + 0.0
    first, group = _grouped(_hashed(rows))
    if not np.array_equal(rows[first[group]], rows):  # two kinds share a hash: one in 1e6 files of 1e6 facets
        _, first, group = np.unique(rows, axis=0, return_index=True, return_inverse=True)
    return first, group.reshape(-1)


def near(vertices, candidates, tolerance):
    """For each corner, the one it is joined with; only candidates closer than a tolerance are.

    Parameters
    ----------
    vertices : (V, 3) float [unit of the file]
    candidates : (N,) int
    tolerance : float [unit of the file]

    Returns
    -------
    (V,) int
    """
    from scipy.spatial import cKDTree

    target = np.arange(len(vertices))
    tree = cKDTree(vertices[candidates])
    if tree.count_neighbors(tree, tolerance) > MOST_PAIRS:
        return target
    i, j = tree.query_pairs(tolerance, output_type="ndarray").T
    _, cluster = graphs.components(i, j, len(candidates))
    _, first = np.unique(cluster, return_index=True)
    target[candidates] = candidates[first[cluster]]
    return target


def _hashed(rows):
    """(N,) one 64-bit number a row; wraps round on purpose."""
    bits = rows.view(np.uint64)
    mixed = np.zeros(len(rows), dtype=np.uint64)
    for column, odd in zip(bits.T, MIX):
        mixed += column
        mixed *= odd
        mixed ^= mixed >> np.uint64(31)
    return mixed


def _grouped(keys):
    order = np.argsort(keys)
    ordered = keys[order]
    new = np.ones(len(keys), dtype=bool)
    np.not_equal(ordered[1:], ordered[:-1], out=new[1:])
    group = np.empty(len(keys), dtype=np.int64)
    group[order] = np.cumsum(new) - 1
    return order[new], group
