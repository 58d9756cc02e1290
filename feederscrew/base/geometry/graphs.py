"""Components of a graph: nodes that hang together; groups of unlike lengths in one array."""

import itertools
from collections.abc import Sequence
from typing import Any

import numpy as np

from feederscrew.base.arrays import Array, Ints


def components(i: Ints, j: Ints, count: int) -> tuple[int, Ints]:
    """Return the number of components of a graph, and the component of each node.

    scipy has the same function, but it takes a tenth of a short command to load.

    Parameters
    ----------
    i, j : (N,) int
        The two ends of each link.
    count : int
        Nodes.

    Returns
    -------
    int
        Components.
    (count,) int
        The component of each node. Components are numbered in the order of their first nodes.
    """
    component = np.arange(count)
    while len(i):  # each node takes the least number of its neighbours, then that of the node it names
        least = np.minimum(component[i], component[j])
        after = component.copy()
        np.minimum.at(after, component[i], least)
        np.minimum.at(after, component[j], least)
        while not np.array_equal(after, after[after]):
            after = after[after]
        if np.array_equal(after, component):
            break
        component = after
    first, component = np.unique(component, return_inverse=True)
    return len(first), component


def component_of(pairs: Ints, count: int) -> Ints:
    """Return the component of each node of a graph.

    Parameters
    ----------
    pairs : (N, 2) int
        The two ends of each link.
    count : int
        Nodes.

    Returns
    -------
    (count,) int
        As of ``components``.
    """
    first, second = pairs.T
    return components(first, second, count)[1]


def join_groups(groups: Sequence[Ints]) -> tuple[Ints, Ints]:
    """Return the members of groups in one array, and the owner of each.

    Parameters
    ----------
    groups : sequence of (K,) int
        One at least.

    Returns
    -------
    members : (N,) int
    owners : (N,) int
        Places of the groups, ascending.
    """
    counts = np.fromiter(map(len, groups), int, len(groups))
    return np.concatenate(groups), np.repeat(np.arange(len(groups)), counts)


def group_starts(owners: Ints, count: int) -> Ints:
    """Return the place of the first member of each group.

    Parameters
    ----------
    owners : (N,) int
        The group of each member, ascending.
    count : int
        Groups, G.

    Returns
    -------
    (G,) int
        An empty group has the place where its members would stand.
    """
    return np.searchsorted(owners, np.arange(count))


def split_groups(members: Array, owners: Ints, count: int) -> list[Array]:
    """Return the members of each group as an array of its own.

    Parameters
    ----------
    members : (N, ...) array
    owners : (N,) int
        The group of each member, ascending.
    count : int
        Groups, G.

    Returns
    -------
    list of arrays
        G of them, views of ``members``; an empty group has no rows.
    """
    bounds = group_starts(owners, count + 1).tolist()
    return [members[start:stop] for start, stop in itertools.pairwise(bounds)]


def group_sums(values: Array, owners: Ints, count: int) -> Any:
    """Return the sums over the members of each group.

    Parameters
    ----------
    values : (N,) or (K, N) array [any unit]
        Of one quantity, or of several, a row each.
    owners : (N,) int
        The group of each member, ascending. No group is empty: ``numpy.add.reduceat`` would give it the value
        of the next member.
    count : int
        Groups, G.

    Returns
    -------
    (G,) or (G, K) array [unit of the values]
    """
    return np.add.reduceat(values, group_starts(owners, count), axis=-1).T
