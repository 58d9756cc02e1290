"""Groups of unlike lengths in one array, the members of each behind those of the one before."""

import itertools

import numpy as np


def joined(groups) -> tuple[np.ndarray, np.ndarray]:
    """Return the members of groups in one array, and to which of them each belongs.

    Parameters
    ----------
    groups : sequence of G int arrays
        At least one.

    Returns
    -------
    members, owners : (N,) int
        The owners ascend.
    """
    counts = np.fromiter(map(len, groups), int, len(groups))
    return np.concatenate(groups), np.repeat(np.arange(len(groups)), counts)


def starts(owners, count):
    """Return the place (G,) of the first member of each of ``count`` groups, by ascending owners (N,)."""
    return np.searchsorted(owners, np.arange(count))


def split(members, owners, count):
    """Return the members (N, ...) of each of ``count`` groups, by ascending owners (N,): a list of arrays."""
    bounds = starts(owners, count + 1).tolist()
    return [members[start:stop] for start, stop in itertools.pairwise(bounds)]


def sums(values, owners, count):
    """Return the sums over the members of each of ``count`` groups, none of them empty.

    Parameters
    ----------
    values : (N,) or (K, N) float
        Of one quantity, or of several, a row each.
    owners : (N,) int
        Ascending.
    count : int

    Returns
    -------
    (G,) or (G, K) float
    """
    return np.add.reduceat(values, starts(owners, count), axis=-1).T
