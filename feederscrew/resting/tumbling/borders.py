"""Borders of the facets of a hull: straight edges between corners at which three facets or more meet.

The walks of `tumbling.walk` rely on a convex body: convex facets, three of them or more at each corner, three
corners or more to each facet. Noise in a file leaves corners on the edge between two facets, needles
(triangles whose corners are the ends of one edge and such a corner between them), and planes of which some
triangles are coplanar within the tolerance of merging and others are not. Arrays have one entry for each of
the H half-edges of the triangles.
"""

from typing import NamedTuple

import numpy as np

from feederscrew.geometry import vectors
from feederscrew.geometry.graphs import components

FEWEST = 3  # facets at a corner
STRAIGHT = 1e-9  # [1] of the radius: what a corner may lie behind the line between its neighbours


class Borders(NamedTuple):
    """Half-edges of which only some part two facets."""

    targets: np.ndarray  # (H,) corner a half-edge ends at
    twins: np.ndarray  # (H,) the same edge seen from the other side
    part: np.ndarray  # (H,) bool: parts two facets, from one corner of three facets to the next
    ahead: np.ndarray  # (H,) next half-edge along the border of the same facet
    facets: np.ndarray  # (H,) facet of each half-edge

    @property
    def around(self):
        """(H,) next border half-edge leaving the same corner; the first half-edge off the borders."""
        edges = np.flatnonzero(self.part)
        around = np.zeros_like(self.ahead)
        around[self.ahead[edges]] = self.twins[edges]
        return around


def borders(hull, origins, targets, twins, facets):
    """Return the borders between facets, as a convex body has them.

    Parameters
    ----------
    hull : Hull
    origins, targets, twins : (H,) int
        Its half-edges: 3 t to 3 t + 2 run around triangle t.
    facets : (H,) int
        Facet of coplanar triangles each half-edge belongs to.

    Returns
    -------
    Borders
        Every corner with three edges or more, every facet likewise and convex; facets are numbered
        without gaps. A facet that would not be convex is left in triangles, and one left with two edges
        (a needle) becomes part of its neighbour.
    """
    facets = _convex(hull, origins, twins, facets)
    while True:
        found = _straightened(origins, _bordered(targets, twins, facets))
        needles = _of_two_edges(found)
        if not len(needles):
            return found if np.bincount(facets).all() else found._replace(facets=_numbered(facets))
        facets = _joined(facets, facets[needles], facets[found.twins[needles]])


def _bordered(targets, twins, facets):
    part = facets != facets[twins]
    return Borders(targets, twins, part, _ahead(twins, part), facets)


def _ahead(twins, part):
    """(H,) next border along each facet, over the edges within it; meaningless off the borders."""
    following = np.arange(len(twins)).reshape(-1, 3)[:, [1, 2, 0]].ravel()
    ahead = following.copy()
    inside = np.flatnonzero(part & ~part[ahead])
    while len(inside):
        ahead[inside] = following[twins[ahead[inside]]]
        inside = inside[~part[ahead[inside]]]
    return ahead


def _convex(hull, origins, twins, facets):
    """(H,) facets, those with a reflex corner taken apart into their triangles."""
    targets, single = origins[twins], np.arange(len(facets)) // 3
    while True:
        found = _bordered(targets, twins, facets)
        merged = np.bincount(facets[::3])[facets] > 1
        edges = np.flatnonzero(found.part & merged)
        corner = hull.vertices[targets[edges]]
        before, after = hull.vertices[origins[edges]], hull.vertices[targets[found.ahead[edges]]]
        across = vectors.cross(corner - before, after - corner)
        turn = (across * _normals(hull, facets)[facets[edges]]).sum(axis=1)
        reflex = turn < -STRAIGHT * hull.radius * np.sqrt(((after - before) ** 2).sum(axis=1))
        if not reflex.any():
            return facets
        apart = np.isin(facets, facets[edges[reflex]])
        facets = _numbered(np.where(apart, facets.max() + 1 + single, facets))


def _numbered(facets):
    """(H,) facets numbered without gaps."""
    return np.unique(facets, return_inverse=True)[1].ravel()


def _normals(hull, facets):
    """(M, 3) unit normals of the facets, by the areas of their triangles."""
    weighted = hull.areas[:, None] * hull.normals
    sums = np.stack([np.bincount(facets[::3], column) for column in weighted.T], axis=1)
    return sums / np.maximum(np.sqrt((sums**2).sum(axis=1)), np.finfo(float).tiny)[:, None]


def _straightened(origins, found):
    """Borders with one edge where several met at corners of two facets."""
    valence = np.bincount(origins[found.part], minlength=origins.max() + 1)
    passing = found.part & (valence[found.targets] < FEWEST)  # ends at a corner of two facets
    if not passing.any():
        return found
    starts = np.flatnonzero(found.part & ~passing[found.twins])
    last, going = starts.copy(), np.flatnonzero(passing[starts])
    while len(going):
        last[going] = found.ahead[last[going]]
        going = going[passing[last[going]]]
    targets, twins, ahead = (array.copy() for array in (found.targets, found.twins, found.ahead))
    targets[starts], twins[starts], ahead[starts] = targets[last], twins[last], ahead[last]
    part = np.zeros_like(found.part)
    part[starts] = True
    return Borders(targets, twins, part, ahead, found.facets)


def _of_two_edges(found):
    """Half-edges of facets with two edges, one of the two."""
    edges = np.flatnonzero(found.part)
    return edges[(found.ahead[found.ahead[edges]] == edges) & (edges < found.ahead[edges])]


def _joined(facets, first, second):
    """(H,) facets, each of ``first`` joined with that of ``second``."""
    return components(first, second, facets.max() + 1)[1][facets]
