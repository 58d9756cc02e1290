"""Loops over trees of ways between basins: which of them are one."""

from feederscrew.resting.compiled import compilable

NAMELESS = -1  # a sink of no face


@compilable
def root(forest, k):
    """The tree's root, and the way to it cut short."""
    while forest[k] != k:
        forest[k] = forest[forest[k]]
        k = forest[k]
    return k


@compilable
def join(heights, limits, pairs, tops, region, basin, standing):
    """Join sinks along ways sorted by height where the shallower side rises no more than its limit.

    Parameters
    ----------
    heights, limits : (B,) float [m], of the sinks
    pairs : (W, 2) sinks on either side of each way
    tops : (W,) float [m], ascending
    region, basin : (B,) int, each sink its own; two forests, their roots the lowest of each tree
    standing : (W,) bool, filled with the ways that join no basins
    """
    for k in range(len(tops)):
        i, j = pairs[k, 0], pairs[k, 1]
        low, high = root(region, i), root(region, j)
        if heights[low] > heights[high]:
            low, high = high, low
        region[high] = low
        standing[k] = tops[k] - heights[high] > limits[high]
        if not standing[k]:
            deep, shallow = root(basin, i), root(basin, j)
            if heights[deep] > heights[shallow]:
                deep, shallow = shallow, deep
            basin[shallow] = deep


@compilable
def adopt(pairs, names, parent):
    """Let each nameless sink follow the named one behind its lowest saddle.

    Parameters
    ----------
    pairs : (E, 2) sinks on both sides of each saddle, lowest first
    names : (S,) int, NAMELESS where a sink has none
    parent : (S,) int, each sink its own; filled with a forest
    """
    for e in range(len(pairs)):
        i, j = root(parent, pairs[e, 0]), root(parent, pairs[e, 1])
        if i != j and (names[i] == NAMELESS or names[j] == NAMELESS):
            if names[i] == NAMELESS:
                i, j = j, i
            parent[j] = i
