"""Walks along the flow of a part that rolls without momentum, one by one or those of all saddles together.

Directions are "down" in the part's axes, as tuples of three. Over corner v the flow leaves v along great
circles; where the foot of the centre of mass lies between the two corners of an edge the flow gathers on
the arc between the normals of its two facets. In numpy, for a hull too small for compiled code to be worth
loading, most walks are one step: the facets beside a saddle are sinks and the corners at its ends maxima.
"""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from feederscrew.geometry.compiled import compiled

LOST_WALK = -1  # a walk that ends nowhere: the hull is not closed and convex


@compiled
def row(array, k) -> tuple[float, float, float]:
    """Return a row of an (N, 3) array as a tuple."""
    return array[k, 0], array[k, 1], array[k, 2]


@compiled
def dot(a, b) -> Any:
    """Return the scalar product of two triples (3,), in the product of their units [any].

    Source: its definition.
    """
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@compiled
def triple(a, b, c) -> NDArray[np.float64]:
    """Return a . (b x c) of triples (3,): of unit vectors, a volume [1].

    Source: its definition.
    """
    return (
        a[0] * (b[1] * c[2] - b[2] * c[1])
        + a[1] * (b[2] * c[0] - b[0] * c[2])
        + a[2] * (b[0] * c[1] - b[1] * c[0])
    )


@compiled
def toward(a, b, step) -> tuple[float, float, float]:
    """Return the unit vector [1] along a + step b, of triples (3,).

    Source: a point of the great circle through both.
    """
    x, y, z = a[0] + step * b[0], a[1] + step * b[1], a[2] + step * b[2]
    n = 1.0 / math.sqrt(x * x + y * y + z * z)
    return n * x, n * y, n * z


@compiled
def next_corner(edges, x, corner, sign) -> tuple[int, tuple[float, float, float]]:
    """Return where the great circle through direction x and a corner leaves the corner's region.

    ``sign`` is -1 down the flow, away from the corner, and +1 up it, towards the corner. Returns the
    half-edge to the corner that takes over, or LOST_WALK, and the direction there.
    """
    v = row(edges.vertices, corner)
    here = dot(x, v)
    start = h = edges.vertex_edges[corner]
    best, step = LOST_WALK, math.inf
    for _ in range(len(edges.origins)):
        slope = sign * edges.slopes[h]
        if slope > 0.0:
            t = max(here - dot(x, row(edges.vertices, edges.targets[h])), 0.0) / slope
            if t < step:
                best, step = h, t
        h = edges.around[h]
        if h == start:
            break
    return best, toward(x, v, sign * step) if best != LOST_WALK else x


@compiled
def support(edges, x, corner):
    """Return the corner furthest along direction x (3,) [1], climbing from ``corner``."""
    while True:
        height = dot(x, row(edges.vertices, corner))
        start = h = edges.vertex_edges[corner]
        best = corner
        while True:
            other = dot(x, row(edges.vertices, edges.targets[h]))
            if other > height:
                height, best = other, edges.targets[h]
            h = edges.around[h]
            if h == start:
                break
        if best == corner:
            return corner
        corner = best


@compiled
def roll_from_corner(edges, x, corner) -> int:
    """Return the facet first reached by a part that rolls over a corner from x (3,) [1]; LOST_WALK if none.

    A corner in the middle of a facet or an edge gives way to the lowest corner of the facet.
    """
    near = edges.origins[edges.vertex_edges[corner]]
    if near != corner:
        corner = support(edges, x, near)
    for _ in range(len(edges.vertices)):
        h, x = next_corner(edges, x, corner, -1.0)
        if h == LOST_WALK:
            return LOST_WALK
        if edges.slopes[edges.twins[h]] <= 0.0:  # to one of the two sides of the half-edge's arc
            u, w = row(edges.vertices, edges.origins[h]), row(edges.vertices, edges.targets[h])
            return edges.facets[(h if triple(x, u, w) >= 0.0 else edges.twins[h]) // 3]
        corner = edges.targets[h]
    return LOST_WALK


@compiled
def next_facet(edges, facet) -> int:
    """Return the facet to which a part first rolls from ``facet``: itself at rest, LOST_WALK for none."""
    start = h = edges.facet_edges[facet]
    corner, nearest = -1, math.inf
    leaves = False
    for _ in range(len(edges.origins)):
        if edges.sides[h] < 0.0:
            leaves = True
            if edges.slopes[h] <= 0.0 and edges.slopes[edges.twins[h]] <= 0.0:
                return edges.facets[edges.twins[h] // 3]  # over an edge
        u = row(edges.vertices, edges.origins[h])
        if dot(u, u) < nearest:
            nearest, corner = dot(u, u), edges.origins[h]
        h = edges.ahead[h]
        if h == start:
            break
    return roll_from_corner(edges, row(edges.normals, facet), corner) if leaves else facet


@compiled
def roll_from_facet(edges, facet) -> int:
    """Return the facet on which a part comes to rest that is set down on ``facet``; LOST_WALK if none."""
    for _ in range(len(edges.normals) + 1):
        if facet == LOST_WALK:
            return LOST_WALK
        onward = next_facet(edges, facet)
        if onward == facet:
            return facet
        facet = onward
    return LOST_WALK


@compiled
def rolls(edges, directions, ends) -> None:
    """Fill (N,) ends with the facet a part set down with each of (N, 3) directions down comes to rest on."""
    corner = edges.origins[edges.facet_edges[0]]
    for n in range(len(directions)):
        x = row(directions, n)
        corner = support(edges, x, corner)
        ends[n] = roll_from_facet(edges, roll_from_corner(edges, x, corner))


@compiled
def triangle_area(a, b, c) -> float:
    """Signed area [sr] of a spherical triangle of unit vectors, positive counter-clockwise from outside.

    Source: A. van Oosterom, J. Strackee, "The solid angle of a plane triangle", IEEE Trans. Biomed.
    Eng. BME-30(2), 125-126, 1983.
    """
    return 2.0 * math.atan2(triple(a, b, c), 1.0 + dot(a, b) + dot(b, c) + dot(c, a))


@compiled
def climb(edges, tops, x, corner, left, right) -> tuple[int, float, float]:
    """Follow the flow back from direction x over a corner up to a maximum, one of the corners ``tops``.

    Returns the maximum and the fans [sr] swept on the way, seen from ``left`` and from ``right``.
    """
    area_left = area_right = 0.0
    for _ in range(len(edges.vertices)):
        h, y = LOST_WALK, toward(row(edges.vertices, corner), x, 0.0)
        if not tops[corner]:
            h, y = next_corner(edges, x, corner, 1.0)
        area_left += triangle_area(left, x, y)
        area_right += triangle_area(right, x, y)
        if h == LOST_WALK:
            return corner if tops[corner] else LOST_WALK, area_left, area_right
        x, corner = y, edges.targets[h]
    return LOST_WALK, area_left, area_right


@compiled
def trace_saddles(edges, tops, saddles, directions, gauges, pairs, peaks, areas) -> None:
    """Sinks joined by each saddle, and the boundary integral of every facet's basin.

    ``tops`` (V,) bool; ``saddles`` (E,); ``directions`` (E, 3); ``gauges`` (M, 3); ``pairs`` (E, 2);
    ``peaks`` (E, 2); ``areas`` (M,) [sr].
    """
    for e in range(len(saddles)):
        h, x = saddles[e], row(directions, e)
        s = roll_from_facet(edges, edges.facets[h // 3])
        t = roll_from_facet(edges, edges.facets[edges.twins[h] // 3])
        pairs[e, 0], pairs[e, 1] = s, t
        peaks[e, 0] = peaks[e, 1] = LOST_WALK
        if s == LOST_WALK or t == LOST_WALK:
            continue
        left, right = row(gauges, s), row(gauges, t)
        peaks[e, 0], back_s, back_t = climb(edges, tops, x, edges.origins[h], left, right)
        peaks[e, 1], ahead_s, ahead_t = climb(edges, tops, x, edges.targets[h], left, right)
        areas[s] += ahead_s - back_s
        areas[t] += back_t - ahead_t


def trace_saddles_together(edges, tops, saddles, directions, gauges, pairs, peaks, areas) -> None:
    """Fill what ``walk.trace_saddles`` fills, of the same arguments."""
    sides = edges.facets[np.stack([saddles, edges.twins[saddles]], axis=1) // 3]
    pairs[:], peaks[:] = _ends(edges, sides)[sides], LOST_WALK
    sound = np.flatnonzero((pairs != LOST_WALK).all(axis=1))
    if not len(sound):
        return
    ends = np.stack([edges.origins[saddles], edges.targets[saddles]])[:, sound]
    down, gauge = np.tile(directions[sound].T, 2), np.tile(gauges[pairs[sound]].T, 2)
    tips, fans = _climbs(edges, tops, down, ends.ravel(), gauge.swapaxes(0, 1))
    peaks[sound] = tips.reshape(2, -1).T
    behind, ahead = fans.reshape(2, 2, -1).swapaxes(
        0, 1
    )  # from origins and targets, seen from left and right
    np.add.at(areas, pairs[sound], (ahead - behind).T * (1.0, -1.0))


def _ends(edges, starts) -> NDArray[np.int64]:
    """(M + 1,) facet on which a part comes to rest that is set down on each facet; LOST_WALK if none.

    Filled where walks from ``starts`` lead; the last entry stands for a lost walk.
    """
    # facet to which the part rolls over an edge, and where it surely stays or does so
    count, owners = len(edges.normals), np.repeat(edges.facets, 3)
    leaving = np.flatnonzero(edges.borders & (edges.sides < 0.0))
    over = leaving[(edges.slopes[leaving] <= 0.0) & (edges.slopes[edges.twins[leaving]] <= 0.0)]
    goes = np.append(np.arange(count), LOST_WALK)
    goes[owners[over]] = owners[edges.twins[over]]
    is_sure = np.bincount(owners[leaving], minlength=count) == 0
    is_sure |= np.bincount(owners[over], minlength=count) == 1
    here, visited = np.unique(starts), np.zeros(len(is_sure), bool)
    while len(here):
        visited[here] = True
        for facet in here[~is_sure[here]]:
            goes[facet] = next_facet(edges, facet)
        onward = goes[here]
        here = np.unique(onward[(onward != LOST_WALK) & ~visited[onward]])
    ends = goes
    for _ in range(len(is_sure).bit_length()):
        ends = ends[ends]
    return np.where(goes[ends] == ends, ends, LOST_WALK)


def _climbs(edges, tops, x, corners, gauges) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """(N,) peaks and (2, N) fans [sr] as ``walk.climb`` gives them, seen from two gauges each, (2, 3, N).

    From directions x (3, N) over corners (N,).
    """
    peaks, going = np.full(len(corners), LOST_WALK), np.arange(len(corners))
    steps: list[tuple[np.ndarray, np.ndarray, np.ndarray]] = []
    while len(going) and len(steps) < len(edges.vertices):
        rising = ~tops[corners]
        half_edges, y = np.full(len(going), LOST_WALK), _unit(edges.vertices[corners].T)
        if rising.any():
            half_edges[rising], y[:, rising] = _next_corners(edges, x[:, rising], corners[rising])
        steps.append((going, x, y))
        peaks[going[~rising]] = corners[~rising]
        on = half_edges != LOST_WALK
        going, x, corners = going[on], y[:, on], edges.targets[half_edges[on]]
    who, x, y = (np.concatenate(each, axis=-1) for each in zip(*steps))
    fans = [np.bincount(who, _areas(gauge[:, who], x, y), minlength=len(peaks)) for gauge in gauges]
    return peaks, np.stack(fans)


def _next_corners(edges, x, corners) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """(N,) half-edges and (3, N) directions as ``walk.next_corner`` gives them, up the flow."""
    leaving = [edges.vertex_edges[corners]]  # of each corner in their order, again from the first one
    is_closed = np.zeros(len(corners), bool)
    while not is_closed.all() and len(leaving) < len(edges.origins):
        leaving.append(edges.around[leaving[-1]])
        is_closed |= leaving[-1] == leaving[0]
    half_edges, up = np.stack(leaving), edges.vertices[corners].T
    slopes, there = edges.slopes[half_edges], edges.vertices[edges.targets[half_edges]].transpose(2, 0, 1)
    steps = np.full(half_edges.shape, np.inf)
    rise = np.maximum(dot(x, up) - dot(x[:, None], there), 0.0)
    np.divide(rise, slopes, out=steps, where=slopes > 0.0)
    best = steps.argmin(axis=0), np.arange(len(corners))
    is_up, step = np.isfinite(steps[best]), steps[best]
    y = np.where(is_up, _unit(x + np.where(is_up, step, 0.0) * up), x)
    return np.where(is_up, half_edges[best], LOST_WALK), y


def _unit(x) -> NDArray[np.float64]:
    """(3, N) unit vectors along x, (3, N)."""
    return x * (1.0 / np.sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]))


def _areas(a, b, c) -> NDArray[np.float64]:
    """(N,) ``walk.triangle_area`` of unit vectors in columns, (3, N).

    Each angle by itself, for the same digits on every processor: numpy has an arctangent for each kind.
    """
    rest = 1.0 + dot(a, b) + dot(b, c) + dot(c, a)
    angles = map(math.atan2, triple(a, b, c).tolist(), rest.tolist())
    return 2.0 * np.fromiter(angles, float, len(rest))
