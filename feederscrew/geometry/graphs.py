"""Which nodes of a graph hang together; groups of unlike lengths in one array."""

import itertools
from collections.abc import Sequence
from typing import Any

import numpy as np

from feederscrew.arrays import Array, Ints


def components(i: Ints, j: Ints, count: int) -> tuple[int, Ints]:
    """Return the number of components of a graph of ``count`` nodes, and that of each node (count,).

    ``i``, ``j`` (N,) int are the two ends of each link. They are numbered in the order of their first nodes.
    scipy's own function takes a tenth of a short command to load.
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
    """Return of each node its component (count,) int; pairs (N, 2) int are the two ends of each link."""
    first, second = pairs.T
    return components(first, second, count)[1]


def join_groups(groups: Sequence[Ints]) -> tuple[Ints, Ints]:
    """Return the members (N,) of groups of int in one array, and the owner (N,) of each, ascending."""
    counts = np.fromiter(map(len, groups), int, len(groups))
    return np.concatenate(groups), np.repeat(np.arange(len(groups)), counts)


def group_starts(owners: Ints, count: int) -> Ints:
    """Return the place (G,) of the first member of each of ``count`` groups, by ascending owners (N,)."""
    return np.searchsorted(owners, np.arange(count))


def split_groups(members: Array, owners: Ints, count: int) -> list[Array]:
    """Return the members (N, ...) of each of ``count`` groups, by ascending owners (N,): a list of arrays."""
    bounds = group_starts(owners, count + 1).tolist()
    return [members[start:stop] for start, stop in itertools.pairwise(bounds)]


def group_sums(values: Array, owners: Ints, count: int) -> Any:
    """Return the sums (G,) or (G, K) over the members of each of ``count`` groups, none of them empty.

    Values (N,) are of one quantity, or (K, N) of several, a row each; the owners (N,) ascend.
    """
    return np.add.reduceat(values, group_starts(owners, count), axis=-1).T
