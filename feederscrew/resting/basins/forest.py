"""Loops over trees of ways between basins: which of them are one."""

import numpy as np

from feederscrew.geometry.compiled import compiled

NAMELESS = -1  # a sink of no face


def roots(forest):
    """Return the root of every member of a forest (N,) of places in itself."""
    while True:
        further = forest[forest]
        if np.array_equal(further, forest):
            return forest
        forest = further


def on_lists(function):
    """Return a function that runs another on lists, in plain Python the faster, and fills its arrays."""

    def run(*arrays):
        lists = [array.tolist() for array in arrays]
        made = function(*lists)
        for array, filled in zip(arrays, lists):
            array[:] = filled
        return made

    return run


@compiled
def root(forest, k):
    """Return the root of a member of a forest (N,), and cut the way to it short."""
    while forest[k] != k:
        forest[k] = forest[forest[k]]
        k = forest[k]
    return k


@compiled
def join(heights, limits, ones, others, tops, region, basin, standing):
    """Join sinks along ways sorted by height where the shallower side rises no more than its limit.

    A way between sinks that lower ways have led to each other is passed over.

    Source: own; docs/resting.md, "Exact tumbling".

    Parameters
    ----------
    heights, limits : (B,) float [m], of the sinks
    ones, others : (W,) int, sinks on either side of each way
    tops : (W,) float [m], ascending
    region, basin : (B,) int, each sink its own; two forests, their roots the lowest of each tree
    standing : (W,) bool, filled with the ways that join regions but no basins
    """
    for k in range(len(tops)):
        i, j = ones[k], others[k]
        low, high = root(region, i), root(region, j)
        if low == high:
            continue
        if heights[low] > heights[high]:
            low, high = high, low
        region[high] = low
        standing[k] = tops[k] - heights[high] > limits[high]
        if not standing[k]:
            deep, shallow = root(basin, i), root(basin, j)
            if heights[deep] > heights[shallow]:
                deep, shallow = shallow, deep
            basin[shallow] = deep


@compiled
def adopt(pairs, tops, tie, names, parent, claims):
    """Let every nameless sink be claimed by what lies behind its lowest saddle, or saddles where they tie.

    Source: own; docs/resting.md, "Exact tumbling".

    Parameters
    ----------
    pairs : (E, 2) sinks on both sides of each saddle
    tops : (E,) float [m], ascending
    tie : float [m], saddles that differ by less are as high as each other
    names : (S,) int, NAMELESS where a sink has none; filled at the roots of ``parent``
    parent : (S,) int, each sink its own; filled with a forest of nameless sinks that are claimed as one
    claims : (E, 2) filled with the root of the claimed and that of the claiming

    Returns
    -------
    int
        Claims made.
    """
    count = start = 0
    while start < len(pairs):
        stop = start
        while stop == start or (stop < len(pairs) and tops[stop] - tops[start] <= tie):
            i, j = root(parent, pairs[stop, 0]), root(parent, pairs[stop, 1])
            if names[i] == NAMELESS and names[j] == NAMELESS:
                parent[j] = i
            stop += 1
        first = count
        for e in range(start, stop):
            i, j = root(parent, pairs[e, 0]), root(parent, pairs[e, 1])
            if names[i] == NAMELESS:
                i, j = j, i
            if names[i] != NAMELESS and names[j] == NAMELESS:
                claims[count, 0], claims[count, 1] = j, i
                count += 1
        for c in range(first, count):
            names[claims[c, 0]] = names[claims[c, 1]]
        start = stop
    return count
