"""Where a surface is open, and the triangles that close it for ``allow_open``."""

from dataclasses import dataclass

import numpy as np

from feederscrew.geometry import vectors

LARGE = 60  # corners: rims with more are closed by a fan


@dataclass(frozen=True, eq=False)
class Holes:
    """The holes of an open surface."""

    rims: list[list[int]]  # corners of each, against the sense of the facets beside it
    width: float  # [unit of the file] across the widest
    middle: np.ndarray  # (3,) [unit of the file] of the widest


def holes(vertices, edges):
    """The holes of an open surface.

    Parameters
    ----------
    vertices : (V, 3) float [unit of the file]
    edges : MeshEdges
        Not closed.

    Returns
    -------
    Holes
    """
    tails, heads = edges.rim()
    rims = _rims(heads.tolist(), tails.tolist())
    hole = np.repeat(np.arange(len(rims)), [len(rim) for rim in rims])
    corners = vertices[np.concatenate(rims)]
    sums = np.column_stack([np.bincount(hole, column) for column in corners.T])
    middles = sums / np.bincount(hole)[:, None]
    radii = np.zeros(len(rims))
    np.maximum.at(radii, hole, np.linalg.norm(corners - middles[hole], axis=1))
    widest = int(np.argmax(radii))
    return Holes(rims, 2.0 * float(radii[widest]), middles[widest])


def caps(vertices, rims):
    """Triangles that close holes.

    Parameters
    ----------
    vertices : (V, 3) float [unit of the file]
    rims : list of list of int

    Returns
    -------
    (N, 3, 3) float [unit of the file]
        Of least area in all for a rim of at most ``LARGE`` corners, else a fan from its middle; either is
        exact where the rim is flat.
    """
    return np.concatenate([(_patch if len(rim) <= LARGE else _fan)(vertices[rim]) for rim in rims])


def _rims(tails, heads):
    """Sides strung together to closed rims that pass no corner twice, as lists of corners."""
    onward: dict[int, list[int]] = {}
    for tail, head in zip(tails, heads):
        onward.setdefault(tail, []).append(head)
    rims = []
    for start in list(onward):
        path, place = [start], {start: 0}
        while onward[path[-1]]:
            corner = onward[path[-1]].pop()
            if corner in place:
                rim, path = path[place[corner] :], path[: place[corner] + 1]
                rims.append(rim)
                for passed in rim[1:]:
                    del place[passed]
            else:
                place[corner] = len(path)
                path.append(corner)
    return rims


def _fan(rim):
    middle = np.broadcast_to(rim.mean(axis=0), rim.shape)
    return np.stack([rim, np.roll(rim, -1, axis=0), middle], axis=1)


def _patch(rim):
    """(K - 2, 3, 3) triangles of least area over a closed polygon of K corners in space.

    Dynamic programming over its chords (G. Barequet, M. Sharir, "Filling gaps in the boundary of a
    polyhedron", Comput. Aided Geom. Des. 12(2), 207-229, 1995).
    """
    count = len(rim)
    least, apex = np.zeros((count, count)), np.zeros((count, count), dtype=int)
    for step in range(2, count):
        for i in range(count - step):
            j, k = i + step, np.arange(i + 1, i + step)
            areas = 0.5 * vectors.norm(vectors.cross(rim[k] - rim[i], rim[j] - rim[i]))
            total = least[i, k] + least[k, j] + areas
            apex[i, j] = k[np.argmin(total)]
            least[i, j] = total.min()
    chords, triangles = [(0, count - 1)], []
    while chords:
        i, j = chords.pop()
        if j - i > 1:
            triangles.append((i, apex[i, j], j))
            chords += [(i, apex[i, j]), (apex[i, j], j)]
    return rim[np.array(triangles, dtype=int).reshape(-1, 3)]
