"""Normals for shading: smooth over tessellated curves, sharp at edges."""

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

SMOOTH = np.radians(20.0)  # facets that meet under less are one curved side
MOST_FACETS = 200_000  # beyond it a facet is smaller than a pixel


def corner_normals(points, faces):
    """Return the outward normal at each corner of each facet, averaged over the curved side it belongs to.

    Parameters
    ----------
    points : (V, 3) float
        Corners of the surface.
    faces : (F, 3) int
        Corner indices, counter-clockwise seen from outside.

    Returns
    -------
    (F, 3, 3) float or None
        Unit normals by facet and corner; None where there are too many facets to need it.
    """
    if len(faces) > MOST_FACETS:
        return None
    a, b, c = np.moveaxis(points[faces], 1, 0)
    areas = np.cross(b - a, c - a)  # (F, 3) normals times twice the area
    own = _units(areas)
    labels = curved_sides(faces, own)
    keys = faces.astype(np.int64) * (labels.max(initial=0) + 1) + labels[:, None]
    _, place = np.unique(keys, return_inverse=True)
    place = place.reshape(-1)
    sums = np.column_stack([np.bincount(place, np.repeat(areas[:, k], 3)) for k in range(3)])
    mean = _units(sums)[place].reshape(-1, 3, 3)
    bent = np.einsum("fki,fi->fk", mean, own) < np.cos(SMOOTH)
    return np.where(bent[..., None], own[:, None, :], mean)


def curved_sides(faces, normals):
    """Return the facets joined across every edge that bends less than ``SMOOTH``.

    Parameters
    ----------
    faces : (F, 3) int
        Corner indices.
    normals : (F, 3) float
        Outward unit normals.

    Returns
    -------
    (F,) int
        The side each facet belongs to.
    """
    first, second = _across_edges(faces)
    cosine = np.einsum("ei,ei->e", normals[first], normals[second])
    joined = cosine > np.cos(SMOOTH)
    size = len(faces)
    graph = coo_matrix((np.ones(joined.sum()), (first[joined], second[joined])), shape=(size, size))
    return connected_components(graph, directed=False)[1]


def _across_edges(faces):
    """Pairs of facets that share an edge, as two index arrays."""
    edges = np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
    facet = np.tile(np.arange(len(faces)), 3)
    order = np.lexsort((edges[:, 1], edges[:, 0]))
    same = (edges[order][1:] == edges[order][:-1]).all(axis=1)
    return facet[order[:-1][same]], facet[order[1:][same]]


def _units(vectors):
    return vectors / np.maximum(np.linalg.norm(vectors, axis=1, keepdims=True), 1e-30)
