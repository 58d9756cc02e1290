"""Facets of any number of corners, split into triangles."""

import numpy as np
from numpy.typing import NDArray

from feederscrew.geometry import vectors
from feederscrew.part.reading.soup import DamageError
from feederscrew.units import counted

TINY = 1e-300  # [unit of the file] a facet smaller than that is a point
STRAIGHT = 1e-9  # [1] of the facet's area: a corner that turns by less does not make a fan
MOST_CORNERS_OF_ONE = 20_000  # of one facet


def triangles(
    vertices: NDArray[np.float64], sizes: NDArray[np.int64], corners: NDArray[np.int64]
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Split facets into triangles, concave ones within their outline.

    Parameters
    ----------
    vertices : (V, 3) float [unit of the file]
    sizes : (N,) int
        Corners of each facet.
    corners : (sum of sizes,) int
        Indices into ``vertices``, facet after facet.

    Returns
    -------
    faces : (F, 3) int
        In the order of the facets; those of fewer than three corners give none.
    facet : (F,) int
        The facet that each is from.

    Raises
    ------
    ValueError
        If a facet names a corner that is not there, has too many corners, or its outline crosses itself.
    """
    if len(corners) and (corners.min() < 0 or corners.max() >= len(vertices)):
        raise DamageError("a facet names a corner that is not there")
    if len(sizes) and sizes.max() > MOST_CORNERS_OF_ONE:
        raise DamageError(f"a facet of more than {MOST_CORNERS_OF_ONE} corners")
    start = np.cumsum(sizes) - sizes
    faces, facet = [np.empty((0, 3), dtype=np.int64)], [np.empty(0, dtype=np.int64)]
    for size in np.unique(sizes[sizes >= 3]).tolist():
        chosen = np.flatnonzero(sizes == size)
        rings = corners[start[chosen][:, None] + np.arange(size)]
        faces.append(_split(vertices, rings).reshape(-1, 3))
        facet.append(np.repeat(chosen, size - 2))
    order = np.argsort(np.concatenate(facet), kind="stable")
    return np.concatenate(faces)[order], np.concatenate(facet)[order]


def split_warning(sizes: NDArray[np.int64], noun: str = "facet") -> tuple[str, ...]:
    """Return what to say where a format of triangles has facets of more corners."""
    more = int((sizes > 3).sum())
    if not more:
        return ()
    kind = "four corners" if set(sizes[sizes > 3].tolist()) == {4} else "more than three corners"
    return (f"{counted(more, noun)} with {kind}: split into triangles",)


def _split(vertices, rings):
    """(N, S - 2, 3) triangles of N facets of S corners."""
    size = rings.shape[1]
    fan = np.stack([np.zeros(size - 2, dtype=int), np.arange(1, size - 1), np.arange(2, size)], axis=1)
    faces = rings[:, fan]
    if size == 3:
        return faces
    points = np.nan_to_num(vertices[rings], posinf=0.0, neginf=0.0)
    points = points / np.maximum(np.abs(points).max(axis=(1, 2), keepdims=True), TINY)
    points = points - points[:, :1]
    following = np.roll(points, -1, axis=1)
    normals = vectors.cross(points, following).sum(axis=1)  # Newell's: twice the area
    along = following - points
    turns = vectors.cross(np.roll(along, 1, axis=1), along)
    area = vectors.norm(normals)
    rising = np.einsum("nsi,ni->ns", turns, normals)
    concave = ~(rising > STRAIGHT * area[:, None] ** 2).all(axis=1)
    for one in np.flatnonzero(concave & (area > 0.0)).tolist():
        faces[one] = rings[one][_ears(points[one], normals[one] / area[one])]
    return faces


def _ears(points, normal):
    """(S - 2, 3) corners of the triangles of one concave facet (S, 3)."""
    from manifold3d import triangulate

    across = np.eye(3)[np.argmin(np.abs(normal))]
    first = vectors.cross(normal, across)
    first = first / vectors.norm(first)
    second = vectors.cross(normal, first)
    flat = np.stack([np.einsum("si,i->s", points, axis) for axis in (first, second)], axis=1)
    flat = flat / np.abs(flat).max()  # of a facet with an area
    ears = np.asarray(triangulate([flat]), dtype=np.int64).reshape(-1, 3)
    if len(ears) != len(points) - 2:
        raise DamageError(f"the outline of a facet of {len(points)} corners crosses itself")
    return ears
