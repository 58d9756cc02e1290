"""The height of the centre of mass over every way down: sinks, saddles and what lies between.

H(n), the height of the centre of mass when direction n points down, has its minima at hull triangles. The
way from one triangle to the next leads over their common edge; the lowest such ways make a tree, and
cutting it at saddles that rise too little above the shallower side leaves one basin per resting place.

Source: docs/resting.md, "Exact tumbling" and "Barriers and the tipping graph".
"""

from dataclasses import dataclass

import numpy as np

from feederscrew.base.arrays import Bools, Floats, Ints
from feederscrew.base.geometry import vectors
from feederscrew.base.geometry.compiled import compiled, fitting
from feederscrew.part.hull import Hull

NAMELESS = -1  # a sink of no face


def find_roots(forest: Ints) -> Ints:
    """Return the root of every member of a forest.

    Parameters
    ----------
    forest : (N,) int
        The place of each member's parent in itself; a root's own place.

    Returns
    -------
    (N,) int
    """
    while not np.array_equal(further := forest[forest], forest):
        forest = further
    return forest


@compiled
def find_root(forest: Ints, k: int) -> int:
    """Return the root of a member of a forest, and cut the way to it short.

    Parameters
    ----------
    forest : (N,) int
        Place of each member's parent; a root names itself. Changed: members on the way point nearer to the
        root.
    k : int

    Returns
    -------
    int
    """
    while forest[k] != k:
        forest[k] = forest[forest[k]]
        k = forest[k]
    return k


@compiled
def join_trees(
    heights: Floats,
    limits: Floats,
    lefts: Ints,
    rights: Ints,
    tops: Floats,
    region: Ints,
    basin: Ints,
    stands: Bools,
) -> None:
    """Join sinks along ways sorted by height where the shallower side rises no more than its limit.

    This is union and find: a way between sinks that lower ways have led to each other is passed over.

    Parameters
    ----------
    heights : (B,) float [m]
        Of the sinks.
    limits : (B,) float [m]
        Rise up to which the shallower side is joined.
    lefts : (W,) int
        Sink on one side of each way.
    rights : (W,) int
    tops : (W,) float [m]
        Height of each way, ascending.
    region : (B,) int
        Filled: forest of all sinks that ways so far have led to each other.
    basin : (B,) int
        Filled: forest of the sinks that are joined.
    stands : (W,) bool
        Filled: ways that rise by more than the limit.

    Returns
    -------
    None

    References
    ----------
    Own; docs/resting.md, "Exact tumbling".
    """
    for k in range(len(tops)):
        i, j = lefts[k], rights[k]
        low, high = find_root(region, i), find_root(region, j)
        if low == high:
            continue
        if heights[low] > heights[high]:
            low, high = high, low
        region[high] = low
        stands[k] = tops[k] - heights[high] > limits[high]
        if not stands[k]:
            deep, shallow = find_root(basin, i), find_root(basin, j)
            if heights[deep] > heights[shallow]:
                deep, shallow = shallow, deep
            basin[shallow] = deep


@compiled
def adopt_tree(pairs: Ints, tops: Floats, tie: float, names: Ints, parent: Ints, claims: Ints) -> int:
    """Let every nameless sink be claimed by the face behind its lowest saddle, or saddles where they tie.

    Parameters
    ----------
    pairs : (E, 2) int
        Sinks on both sides of each saddle.
    tops : (E,) float [m]
        Heights of the saddles, ascending.
    tie : float [m]
        Difference within which saddles are as low as each other.
    names : (S,) int
        Face of each sink; changed where a sink is claimed.
    parent : (S,) int
        Changed: forest of nameless sinks that saddles join.
    claims : (E, 2) int
        Filled: root of the claimed sinks, and the sink that claims them.

    Returns
    -------
    int
        Number of claims.

    References
    ----------
    Own; docs/resting.md, "Exact tumbling".
    """
    count = start = 0
    while start < len(pairs):
        stop = start
        # saddles that tie are looked at together: first nameless sinks on both sides join, then each of their
        # trees takes every name beside it
        # saddles that tie are looked at together: first nameless sinks on both sides join, then each of their
        # trees takes every name beside it
        while stop == start or (stop < len(pairs) and tops[stop] - tops[start] <= tie):
            i, j = find_root(parent, pairs[stop, 0]), find_root(parent, pairs[stop, 1])
            if names[i] == NAMELESS and names[j] == NAMELESS:
                parent[j] = i
            stop += 1
        first = count
        for e in range(start, stop):
            i, j = find_root(parent, pairs[e, 0]), find_root(parent, pairs[e, 1])
            if names[i] == NAMELESS:
                i, j = j, i
            if names[i] != NAMELESS and names[j] == NAMELESS:
                claims[count, 0], claims[count, 1] = j, i
                count += 1
        for c in range(first, count):
            names[claims[c, 0]] = names[claims[c, 1]]
        start = stop
    return count


SMOOTH_ANGLE = np.radians(25.0)  # a sharper edge is meant: a bar of 12 sides has flats, one of 16 rolls
GENTLE_COSINE = np.cos(SMOOTH_ANGLE)  # of two normals, their product
RIPPLE_OF_RADIUS = 2e-3  # noise and tessellation leave barriers below this share of the part's radius ...
RIPPLE_OF_HEIGHT = 2e-2  # ... and below this share of the height, or slender parts would lose their sides
MIN_BARRIER_SHARE = 1e-4  # of the radius, 1 um on a small part: a lower one holds nothing, however sharp
STRIP_ANGLE = 1e-6  # [rad] between halves of one strip
MIN_TRIANGLE_WIDTH = 1e-3  # of the radius: a narrower triangle has no direction of its own


@dataclass(frozen=True, eq=False)
class Landscape:
    """Basins of a hull; T triangles, E edges, B basins, R ripples."""

    pairs: Ints  # (E, 2) triangles on either side of each edge of the hull
    basins: Ints  # (T,) the triangle at the bottom of each triangle's basin
    sinks: Ints  # (B,) those bottom triangles
    ripples: Ints  # (R, 2) sinks on either side of a smooth edge that were too deep to merge
    rises: Floats  # (R,) [1] height of the way over that edge, above the higher side, as a share of it
    bends: Floats  # (R,) [rad] between the lowest triangles on either side
    lows: Ints  # (L,) triangles from which no way leads down, before any were merged


def passes(hull: Hull, pairs: Ints, ends: Ints) -> Floats:
    """Return the height of the centre of mass at the highest point of the way over each edge.

    Tipping over an edge turns the part about it. The centre of mass climbs until it stands over the edge, if
    that happens on the way; else the way is downhill and its top is the higher side.

    Parameters
    ----------
    hull : Hull
    pairs : (E, 2) int
        Triangles on either side of each edge.
    ends : (E, 2) int
        Corners of each edge.

    Returns
    -------
    (E,) float [m]

    References
    ----------
    docs/resting.md, "Barriers and the tipping graph".
    """
    p, q = vectors.columns_at(hull.vertices, ends)
    n1, n2 = vectors.columns_at(hull.normals, pairs)
    along = q - p
    square = np.maximum(vectors.dot_columns(along, along), np.finfo(float).tiny)
    foot = p - along * (vectors.dot_columns(p, along) / square)  # of the centre
    sides = ((n1, n2), (n1, foot), (foot, n2))
    turn, before, after = (vectors.dot_columns(vectors.cross_columns(*side), along) for side in sides)
    # the foot on the edge is passed where it lies between the two normals, in the sense of the turn
    # the foot on the edge is passed where it lies between the two normals, in the sense of the turn
    between = (before * turn > 0.0) & (after * turn > 0.0)
    higher = np.maximum(*hull.heights[pairs.T])
    return np.where(between, np.maximum(np.sqrt(vectors.dot_columns(foot, foot)), higher), higher)


def landscape(hull: Hull) -> Landscape:
    """Return the basins of the hull with ripples merged by persistence.

    A triangle whose way down is cut off by a ripple (noise, a tessellated curve, the diagonal of a flat face)
    belongs to the basin behind the ripple. A low barrier over a sharp edge, like the one around the end of a
    slender pin, is no ripple.

    Parameters
    ----------
    hull : Hull

    Returns
    -------
    Landscape

    References
    ----------
    H. Edelsbrunner, D. Letscher, A. Zomorodian, "Topological persistence and simplification", Discrete
    Comput. Geom. 28, 511-533, 2002.
    """
    # every edge once: the triangles on either side, and its corners
    first, second = np.repeat(np.arange(len(hull.triangles)), 3), hull.neighbours.ravel()
    once = np.flatnonzero(first < second)
    pairs = np.column_stack([first[once], second[once]])
    corners = [hull.triangles[:, order].ravel()[once] for order in ([1, 2, 0], [2, 0, 1])]
    tops = passes(hull, pairs, np.column_stack(corners))
    height = hull.heights
    ripple = np.minimum(RIPPLE_OF_RADIUS * hull.radius, RIPPLE_OF_HEIGHT * height)
    nothing = np.full(len(height), MIN_BARRIER_SHARE * hull.radius)
    # neighbour each triangle rolls to when no step may climb; itself where there is none
    steps = np.concatenate([pairs, pairs[:, ::-1]])
    falls = (height[steps[:, 1]] < height[steps[:, 0]]) & (np.tile(tops, 2) <= height[steps[:, 0]])
    steps = steps[falls]
    steps = steps[np.argsort(-height[steps[:, 1]], kind="stable")]
    below = np.arange(len(height))
    below[steps[:, 0]] = steps[:, 1]  # of several ways down the lowest is written last
    smooth = gentle(_broad_normals(hull, below), pairs)
    local = find_roots(below)
    basins, deep = _join_basins(hull, local, pairs[smooth], tops[smooth], ripple)
    strips, crest = local[pairs[smooth][deep]], tops[smooth][deep]
    basins, _ = _join_basins(hull, basins, pairs, tops, nothing)
    return Landscape(
        pairs=pairs,
        basins=basins,
        sinks=_sinks(basins),
        ripples=basins[strips],
        rises=crest / hull.heights[basins[strips]].max(axis=1, initial=0.0) - 1.0,
        bends=angle(hull.normals[strips[:, 0]], hull.normals[strips[:, 1]]),
        lows=_sinks(local),
    )


def angle(u: Floats, v: Floats) -> Floats:
    """Return angles between vectors, true down to the smallest.

    Parameters
    ----------
    u : (..., 3) float [any]
    v : (..., 3) float [any]

    Returns
    -------
    (...) float [rad]
        From 0 to pi. The arc cosine of the scalar product would lose half the digits of a small angle.

    References
    ----------
    Its sine and cosine are the cross and the scalar product over one and the same length.
    """
    along = u[..., 0] * v[..., 0] + u[..., 1] * v[..., 1] + u[..., 2] * v[..., 2]
    return np.arctan2(vectors.norm(vectors.cross(u, v)), along)


def gentle(normals: Floats, pairs: Ints) -> Bools:
    """Return whether two planes meet in a bend so gentle that it may be part of a curve.

    Parameters
    ----------
    normals : (N, 3) float [1]
        Unit vectors.
    pairs : (E, 2) int
        Planes, by their rows.

    Returns
    -------
    (E,) bool

    References
    ----------
    Own; docs/resting.md, "The drop test": turns of less than 25 degrees.
    """
    return vectors.dot_columns(*vectors.columns_at(normals, pairs)) > GENTLE_COSINE


def _broad_normals(hull: Hull, below: Ints) -> Floats:
    """Return the normal (T, 3) of each triangle, of a sliver that of the first broad one on its way down.

    A corner moved by noise, or a chamfer too small to see, leads round a sharp edge by gentle bends.
    """
    a, b, c = vectors.columns_at(hull.vertices, hull.triangles)
    edges_of = (b - c, c - a, a - b)  # opposite each corner
    sides = [np.sqrt(vectors.dot_columns(side, side)) for side in edges_of]
    thin = 2.0 * hull.areas < MIN_TRIANGLE_WIDTH * hull.radius * np.maximum(np.maximum(*sides[:2]), sides[2])
    end = find_roots(np.where(thin, below, np.arange(len(thin))))
    still = np.flatnonzero(thin & (end == np.arange(len(thin))))  # no way down, or half of a flat strip
    lengths, neighbours = np.column_stack(sides)[still], hull.neighbours[still]
    # slivers at the rim of a flat end lead over their longest sides; two that share it, as those of a narrow
    # chamfer, stand for themselves
    longest, end = neighbours[np.arange(len(still)), lengths.argmax(axis=1)], end.copy()
    while (still_thin := thin[end[still]] & ~thin[end[longest]]).any():
        end[still[still_thin]] = end[longest[still_thin]]
    level = angle(hull.normals[still, None], hull.normals[neighbours]) < STRIP_ANGLE
    best = np.where(thin[end[neighbours]], 0.0, np.where(level, np.inf, lengths)).argmax(axis=1)
    out = np.arange(len(thin))
    out[still] = np.where(thin[end[still]], end[hull.neighbours[still, best]], end[still])
    return hull.normals[out[end]]


def _join_basins(hull: Hull, basins: Ints, pairs: Ints, tops: Floats, limit: Floats) -> tuple[Ints, Ints]:
    """Return basins (T,) joined where the way between them rises by no more than the shallower one's limit.

    Returned too are the edges (indices) of the lowest ways that rise by more.
    """
    sinks = _sinks(basins)
    place = np.searchsorted(sinks, basins)
    firsts, seconds = place[pairs].T
    crossings = np.flatnonzero(firsts != seconds)
    crossings = crossings[np.argsort(tops[crossings], kind="stable")]
    region, basin = np.arange(len(sinks)), np.arange(len(sinks))
    stands = np.zeros(len(crossings), dtype=bool)
    join = fitting(join_trees, 3 * len(basins))
    ways = firsts[crossings], seconds[crossings], tops[crossings]
    join(hull.heights[sinks], limit[sinks], *ways, region, basin, stands)
    return sinks[find_roots(basin)][place], crossings[stands]


def _sinks(basins: Ints) -> Ints:
    """Return the triangles (B,) at the bottom of their own basins."""
    return np.flatnonzero(basins == np.arange(len(basins)))
