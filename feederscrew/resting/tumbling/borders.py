"""Borders of the facets of a hull: straight edges between corners at which three facets or more meet.

Noise in a file leaves corners on the edge between two facets, and needles: triangles whose corners are the
ends of one edge and such a corner between them. Coplanar triangles are merged within a tolerance, so a needle
may be left with neighbours on two sides only. No convex body has such corners or such facets, and the walks
of `tumbling.walk` rely on that. Arrays have one entry for each of the H half-edges of the triangles.
"""

from typing import NamedTuple

import numpy as np

from feederscrew.resting.basins import forest

FEWEST = 3  # facets at a corner


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


def borders(origins, targets, twins, facets):
    """Return the borders between facets, as a convex body has them.

    Parameters
    ----------
    origins, targets, twins : (H,) int
        Half-edges of triangles: 3 t to 3 t + 2 run around triangle t.
    facets : (H,) int
        Facet of coplanar triangles each half-edge belongs to.

    Returns
    -------
    Borders
        Every corner with three edges or more, every facet likewise. A facet that has no border left (a
        needle on an edge) has become part of the facet beside it; facets are numbered without gaps.
    """
    part = facets != facets[twins]
    found = Borders(targets, twins, part, _ahead(twins, part), facets)
    found = _straightened(origins, found)
    while len(needles := _of_two_edges(found)):
        found = _straightened(origins, _closed_up(found, needles))
    return found._replace(facets=np.unique(found.facets, return_inverse=True)[1].ravel())


def _ahead(twins, part):
    """(H,) next border along each facet, over the edges within it; meaningless off the borders."""
    following = np.arange(len(twins)).reshape(-1, 3)[:, [1, 2, 0]].ravel()
    ahead = following.copy()
    inside = np.flatnonzero(part & ~part[ahead])
    while len(inside):
        ahead[inside] = following[twins[ahead[inside]]]
        inside = inside[~part[ahead[inside]]]
    return ahead


def _straightened(origins, found):
    """Borders with one edge where several met at corners of two facets."""
    valence = np.bincount(origins[found.part], minlength=origins.max() + 1)
    passing = found.part & (valence[found.targets] < FEWEST)
    if not passing.any():
        return found
    starts = np.flatnonzero(found.part & (valence[origins] >= FEWEST))
    last, going, closed = starts.copy(), np.flatnonzero(passing[starts]), found.part.copy()
    closed[starts] = False
    while len(going):
        last[going] = found.ahead[last[going]]
        closed[last[going]] = False
        going = going[passing[last[going]]]
    targets, twins, ahead = (array.copy() for array in (found.targets, found.twins, found.ahead))
    targets[starts], twins[starts], ahead[starts] = targets[last], twins[last], ahead[last]
    part = np.zeros_like(found.part)
    part[starts] = True
    return Borders(targets, twins, part, ahead, _without_islands(found, part, np.flatnonzero(closed)))


def _without_islands(found, part, rims):
    """(H,) facets, those within another one joined to it; ``rims`` are half-edges around such islands."""
    if not len(rims):
        return found.facets
    rooted = np.zeros(found.facets.max() + 1, bool)
    rooted[found.facets[part]] = True
    absorbed = np.arange(len(rooted))
    inner, outer = found.facets[rims], found.facets[found.twins[rims]]
    absorbed[inner[~rooted[inner]]] = outer[~rooted[inner]]
    return forest.roots(absorbed)[found.facets]


def _of_two_edges(found):
    """Half-edges of facets with two edges, one of the two."""
    edges = np.flatnonzero(found.part)
    return edges[(found.ahead[found.ahead[edges]] == edges) & (edges < found.ahead[edges])]


def _closed_up(found, needles):
    """Borders with one edge for both edges of each needle, and the needle part of a neighbour."""
    twins, part, facets = found.twins.copy(), found.part.copy(), found.facets.copy()
    for h in needles:
        first, second = twins[h], twins[found.ahead[h]]
        twins[first], twins[second] = second, first
        part[[h, found.ahead[h]]] = False
        facets[facets == facets[h]] = facets[first]
    return found._replace(twins=twins, part=part, facets=facets)
