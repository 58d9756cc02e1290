"""The walks of all saddles abreast, in numpy: for a hull too small for compiled code to be worth loading.

On a hull of many facets most walks are one step: the facets beside a saddle are sinks and the corners at its
ends maxima. What takes further steps over corners is left to `walk`, one at a time.
"""

import math

import numpy as np

from feederscrew.resting.tumbling import walk


def trace_saddles(edges, tops, saddles, directions, gauges, pairs, peaks, areas):
    """Fill what ``walk.trace_saddles`` fills, of the same arguments."""
    ways = edges.facets[np.stack([saddles, edges.twins[saddles]], axis=1) // 3]
    pairs[:], peaks[:] = _ends(edges, ways)[ways], walk.LOST
    sound = np.flatnonzero((pairs != walk.LOST).all(axis=1))
    fans = np.empty((2, len(sound), 2))  # of the walks from origin and target; from left and right
    for k, corners in enumerate((edges.origins[saddles], edges.targets[saddles])):
        peaks[sound, k], fans[k] = _climbs(
            edges, tops, directions[sound], corners[sound], gauges[pairs[sound]]
        )
    swept = fans[1] - fans[0]
    np.add.at(areas, pairs[sound], swept * (1.0, -1.0))


def _ends(edges, starts):
    """(M + 1,) facet on which a part comes to rest that is set down on each facet; LOST if none.

    Filled where walks from ``starts`` lead; the last entry stands for a lost walk.
    """
    goes, known = _over_edges(edges)
    here, seen = np.unique(starts), np.zeros(len(known), bool)
    while len(here):
        seen[here] = True
        for facet in here[~known[here]]:
            goes[facet] = walk.next_facet(edges, facet)
        onward = goes[here]
        here = np.unique(onward[(onward != walk.LOST) & ~seen[onward]])
    ends = goes
    for _ in range(len(known).bit_length()):
        ends = ends[ends]
    return np.where(goes[ends] == ends, ends, walk.LOST)


def _over_edges(edges):
    """(M + 1,) facet to which the part rolls over an edge, (M,) where it surely stays or does so."""
    count, owners = len(edges.normals), np.repeat(edges.facets, 3)
    leaving = np.flatnonzero(edges.borders & (edges.sides < 0.0))
    over = leaving[(edges.slopes[leaving] <= 0.0) & (edges.slopes[edges.twins[leaving]] <= 0.0)]
    goes = np.append(np.arange(count), walk.LOST)
    goes[owners[over]] = owners[edges.twins[over]]
    stays = np.bincount(owners[leaving], minlength=count) == 0
    return goes, stays | (np.bincount(owners[over], minlength=count) == 1)


def _climbs(edges, tops, directions, corners, gauges):
    """(N,) peaks and (N, 2) fans [sr] as ``walk.climb`` gives them from each direction over its corner."""
    peaks, upward = corners.copy(), edges.vertices[corners].T
    upward = upward * (1.0 / np.sqrt(upward[0] * upward[0] + upward[1] * upward[1] + upward[2] * upward[2]))
    fans = np.stack([_areas(gauge.T, directions.T, upward) for gauge in gauges.swapaxes(0, 1)])
    for n in np.flatnonzero(~tops[corners]):
        left, right = (walk.row(gauges[n], k) for k in (0, 1))
        start = walk.row(directions, n)
        peaks[n], *fans[:, n] = walk.climb(edges, tops, start, corners[n], left, right)
    return peaks, fans.T


def _areas(a, b, c):
    """(N,) ``walk.triangle_area`` of unit vectors in columns, (3, N).

    Each angle by itself, for the same digits on every processor: numpy has an arctangent for each kind.
    """
    rest = 1.0 + walk.dot(a, b) + walk.dot(b, c) + walk.dot(c, a)
    angles = map(math.atan2, walk.triple(a, b, c).tolist(), rest.tolist())
    return 2.0 * np.fromiter(angles, float, len(rest))
