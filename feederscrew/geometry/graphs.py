"""Which nodes of a graph hang together."""

import numpy as np
from numpy.typing import NDArray


def components(i, j, count) -> tuple[int, NDArray[np.int64]]:
    """Return the components of a graph.

    Parameters
    ----------
    i, j : (N,) int
        The two ends of each link.
    count : int
        Nodes.

    Returns
    -------
    number : int
        Of components.
    component : (count,) int
        Of each node, numbered in the order of their first nodes.
    """
    if not len(i):
        return count, np.arange(count)
    from scipy.sparse import csr_array
    from scipy.sparse.csgraph import connected_components

    starts = np.concatenate([[0], np.cumsum(np.bincount(i, minlength=count))])
    links = csr_array((np.ones(len(i)), j[np.argsort(i)], starts), shape=(count, count))
    number, component = connected_components(links, directed=False)
    return number, component.astype(int)


def component_of(pairs, count) -> NDArray[np.int64]:
    """Return of each node its component (count,) int; pairs (N, 2) int are the two ends of each link."""
    first, second = pairs.T
    return components(first, second, count)[1]
