"""Which facets meet at which edge, and which way round they run along it."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np


@dataclass(frozen=True, eq=False)
class MeshEdges:
    """The E edges of F facets; each facet has three sides, side s being one of facet s // 3."""

    corners: int  # how many there are: V
    keys: np.ndarray  # (E,) low corner times V plus high corner
    order: np.ndarray  # (3F,) sides, edge by edge
    start: np.ndarray  # (E,) where in ``order`` an edge's sides begin
    count: np.ndarray  # (E,) sides at each edge
    net: np.ndarray  # (E,) sides from the low to the high corner, less those back

    @cached_property
    def closed(self):
        """Whether every side has one that runs back along it."""
        return not self.net.any()

    @cached_property
    def paired(self):
        """Whether every edge joins exactly two facets, wound the same way round."""
        return self.closed and bool((self.count == 2).all())

    @property
    def low(self):
        """(E,) lower corner of each edge."""
        return self.keys // self.corners

    @property
    def high(self):
        """(E,) higher corner of each edge."""
        return self.keys % self.corners

    def mates(self, edges):
        """(N, 2) the two facets at edges that have two; ``edges`` is a mask or indices."""
        start = self.start[edges]
        return np.column_stack([self.order[start], self.order[start + 1]]) // 3

    def rim(self):
        """Open sides from corner to corner, as (N,) and (N,), each as often as it is open."""
        times = np.abs(self.net)
        at = np.repeat(np.arange(len(times)), times)
        forward = self.net[at] > 0
        return np.where(forward, self.low[at], self.high[at]), np.where(forward, self.high[at], self.low[at])


def table(faces, corners):
    """The edges of facets.

    Parameters
    ----------
    faces : (F, 3) int
        No corner twice in a facet.
    corners : int
        How many there are.

    Returns
    -------
    MeshEdges
    """
    tails, heads = faces, faces[:, [1, 2, 0]]
    keys = np.minimum(tails, heads) * corners + np.maximum(tails, heads)
    keys = (2 * keys + (tails > heads)).ravel()
    order = np.argsort(keys)
    keys = keys[order]
    back, keys = keys & 1, keys >> 1
    start = np.flatnonzero(np.concatenate([[True], keys[1:] != keys[:-1]]))
    count = np.diff(start, append=len(keys))
    net = count - 2 * np.add.reduceat(back, start)
    return MeshEdges(corners, keys[start], order, start, count, net)
