"""The walks of all saddles abreast, in numpy: for a hull too small for compiled code to be worth loading.

On a hull of many facets most walks are one step: the facets beside a saddle are sinks and the corners at its
ends maxima. Only where a part rolls off a facet over a corner is the step left to `walk`.
"""

import math

import numpy as np

from feederscrew.resting.tumbling import walk


def trace_saddles(edges, tops, saddles, directions, gauges, pairs, peaks, areas):
    """Fill what ``walk.trace_saddles`` fills, of the same arguments."""
    ways = edges.facets[np.stack([saddles, edges.twins[saddles]], axis=1) // 3]
    pairs[:], peaks[:] = _ends(edges, ways)[ways], walk.LOST
    sound = np.flatnonzero((pairs != walk.LOST).all(axis=1))
    if not len(sound):
        return
    ends = np.stack([edges.origins[saddles], edges.targets[saddles]])[:, sound]
    down, gauge = np.tile(directions[sound].T, 2), np.tile(gauges[pairs[sound]].T, 2)
    tips, fans = _climbs(edges, tops, down, ends.ravel(), gauge.swapaxes(0, 1))
    peaks[sound] = tips.reshape(2, -1).T
    back, ahead = fans.reshape(2, 2, -1).swapaxes(0, 1)  # from origins and targets, seen from left and right
    np.add.at(areas, pairs[sound], (ahead - back).T * (1.0, -1.0))


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


def _climbs(edges, tops, x, corners, gauges):
    """(N,) peaks and (2, N) fans [sr] as ``walk.climb`` gives them, seen from two gauges each, (2, 3, N).

    From directions x (3, N) over corners (N,).
    """
    peaks, going, steps = np.full(len(corners), walk.LOST), np.arange(len(corners)), []
    while len(going) and len(steps) < len(edges.vertices):
        rising = ~tops[corners]
        way, y = np.full(len(going), walk.LOST), _unit(edges.vertices[corners].T)
        if rising.any():
            way[rising], y[:, rising] = _next_corners(edges, x[:, rising], corners[rising])
        steps.append((going, x, y))
        peaks[going[~rising]] = corners[~rising]
        on = way != walk.LOST
        going, x, corners = going[on], y[:, on], edges.targets[way[on]]
    who, x, y = (np.concatenate(each, axis=-1) for each in zip(*steps))
    fans = [np.bincount(who, _areas(gauge[:, who], x, y), minlength=len(peaks)) for gauge in gauges]
    return peaks, np.stack(fans)


def _next_corners(edges, x, corners):
    """(N,) half-edges and (3, N) directions as ``walk.next_corner`` gives them, up the flow."""
    ways, up = _around(edges, corners), edges.vertices[corners].T
    slopes, there = edges.slopes[ways], edges.vertices[edges.targets[ways]].transpose(2, 0, 1)
    steps = np.full(ways.shape, np.inf)
    rise = np.maximum(walk.dot(x, up) - walk.dot(x[:, None], there), 0.0)
    np.divide(rise, slopes, out=steps, where=slopes > 0.0)
    best = steps.argmin(axis=0), np.arange(len(corners))
    found, step = np.isfinite(steps[best]), steps[best]
    y = np.where(found, _unit(x + np.where(found, step, 0.0) * up), x)
    return np.where(found, ways[best], walk.LOST), y


def _around(edges, corners):
    """(K, N) half-edges leaving each corner, in their order; again from the first where there are fewer."""
    ways = [edges.vertex_edges[corners]]
    back = np.zeros(len(corners), bool)
    while not back.all() and len(ways) < len(edges.origins):
        ways.append(edges.around[ways[-1]])
        back |= ways[-1] == ways[0]
    return np.stack(ways)


def _unit(x):
    """(3, N) unit vectors along x, (3, N)."""
    return x * (1.0 / np.sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]))


def _areas(a, b, c):
    """(N,) ``walk.triangle_area`` of unit vectors in columns, (3, N).

    Each angle by itself, for the same digits on every processor: numpy has an arctangent for each kind.
    """
    rest = 1.0 + walk.dot(a, b) + walk.dot(b, c) + walk.dot(c, a)
    angles = map(math.atan2, walk.triple(a, b, c).tolist(), rest.tolist())
    return 2.0 * np.fromiter(angles, float, len(rest))
