"""Walks along the flow of a part that rolls without momentum.

Directions are "down" in the part's axes, as tuples of three. Over corner v the flow leaves v along great
circles; where the foot of the centre of mass lies between the two corners of an edge the flow gathers on
the arc between the normals of its two facets.
"""

import math

from feederscrew.base.arrays import Bools, Floats, Ints, Points
from feederscrew.base.geometry.compiled import compiled
from feederscrew.resting.half_edges import Edges

Triple = tuple[float, float, float]

LOST_WALK = -1  # a walk that ends nowhere: the hull is not closed and convex


@compiled
def row(array: Points, k: int) -> Triple:
    """Return a row of an array as a tuple, which compiled code handles without memory of its own.

    Parameters
    ----------
    array : (N, 3) float [any]
    k : int

    Returns
    -------
    (3,) float [any]
    """
    return array[k, 0], array[k, 1], array[k, 2]


@compiled
def dot(a: Triple, b: Triple) -> float:
    """Return the scalar product of two triples in the product of their units.

    Parameters
    ----------
    a : (3,) float [any]
    b : (3,) float [any]

    Returns
    -------
    float [any]

    References
    ----------
    Its definition.
    """
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@compiled
def triple(a: Triple, b: Triple, c: Triple) -> float:
    """Return a . (b x c): of unit vectors, a volume.

    Parameters
    ----------
    a : (3,) float [1]
    b : (3,) float [1]
    c : (3,) float [1]

    Returns
    -------
    float [1]

    References
    ----------
    Its definition.
    """
    return (
        a[0] * (b[1] * c[2] - b[2] * c[1])
        + a[1] * (b[2] * c[0] - b[0] * c[2])
        + a[2] * (b[0] * c[1] - b[1] * c[0])
    )


@compiled
def toward(a: Triple, b: Triple, step: float) -> Triple:
    """Return the unit vector along a + step b.

    Parameters
    ----------
    a : (3,) float [any]
    b : (3,) float [any]
    step : float [1]

    Returns
    -------
    (3,) float [1]

    References
    ----------
    A point of the great circle through both.
    """
    x, y, z = a[0] + step * b[0], a[1] + step * b[1], a[2] + step * b[2]
    n = 1.0 / math.sqrt(x * x + y * y + z * z)
    return n * x, n * y, n * z


@compiled
def next_corner(edges: Edges, x: Triple, corner: int, sign: float) -> tuple[int, Triple]:
    """Return where the great circle through direction x and a corner leaves the corner's region.

    Parameters
    ----------
    edges : Edges
    x : (3,) float [1]
        Direction down.
    corner : int
    sign : float [1]
        -1 down the flow, away from the corner; +1 up it, towards the corner.

    Returns
    -------
    int
        Half-edge to the corner that takes over, or LOST_WALK.
    (3,) float [1]
        Direction there.

    References
    ----------
    Own; docs/resting.md, "Exact tumbling".
    """
    # Along x + t v the corner's depth x . v and a neighbour's change at different rates. The neighbour takes
    # over where both are as deep; the first of them counts.
    # Along x + t v the corner's depth x . v and a neighbour's change at different rates. The neighbour takes
    # over where both are as deep; the first of them counts.
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
def support(edges: Edges, x: Triple, corner: int) -> int:
    """Return the corner furthest along a direction, climbing from a corner.

    On a convex body a corner that is further out than its neighbours is the furthest of all.

    Parameters
    ----------
    edges : Edges
    x : (3,) float [1]
    corner : int
        Where to begin; nearer is faster.

    Returns
    -------
    int
    """
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
def roll_from_corner(edges: Edges, x: Triple, corner: int) -> int:
    """Return the facet first reached by a part rolling over a corner.

    A corner in the middle of a facet or an edge gives way to the lowest corner of the facet.

    Parameters
    ----------
    edges : Edges
    x : (3,) float [1]
        Direction down.
    corner : int

    Returns
    -------
    int
        LOST_WALK if there is none.
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
def next_facet(edges: Edges, facet: int) -> int:
    """Return the facet to which a part first rolls from a facet.

    Parameters
    ----------
    edges : Edges
    facet : int

    Returns
    -------
    int
        The facet itself where the part rests; LOST_WALK if the walk ends nowhere.
    """
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
def roll_from_facet(edges: Edges, facet: int) -> int:
    """Return the facet on which a part comes to rest that is set down on a facet.

    Parameters
    ----------
    edges : Edges
    facet : int

    Returns
    -------
    int
        LOST_WALK if the walk ends nowhere.
    """
    for _ in range(len(edges.normals) + 1):
        if facet == LOST_WALK:
            return LOST_WALK
        onward = next_facet(edges, facet)
        if onward == facet:
            return facet
        facet = onward
    return LOST_WALK


@compiled
def rolls(edges: Edges, directions: Floats, ends: Ints) -> None:
    """Fill in the facet on which a part comes to rest that is set down with each direction down.

    Parameters
    ----------
    edges : Edges
    directions : (N, 3) float [1]
    ends : (N,) int
        Filled.

    Returns
    -------
    None
    """
    corner = edges.origins[edges.facet_edges[0]]
    for n in range(len(directions)):
        x = row(directions, n)
        corner = support(edges, x, corner)
        ends[n] = roll_from_facet(edges, roll_from_corner(edges, x, corner))


@compiled
def triangle_area(a: Triple, b: Triple, c: Triple) -> float:
    """Return the signed area of a triangle of unit vectors on the sphere; counter-clockwise is positive.

        tan(area / 2) = a . (b x c) / (1 + a . b + b . c + c . a)

    Parameters
    ----------
    a : (3,) float [1]
    b : (3,) float [1]
    c : (3,) float [1]

    Returns
    -------
    float [sr]

    References
    ----------
    A. van Oosterom, J. Strackee, "The solid angle of a plane triangle", IEEE Trans. Biomed. Eng. BME-30(2),
    125-126, 1983.
    """
    return 2.0 * math.atan2(triple(a, b, c), 1.0 + dot(a, b) + dot(b, c) + dot(c, a))


@compiled
def climb(
    edges: Edges, tops: Bools, x: Triple, corner: int, left: Triple, right: Triple
) -> tuple[int, float, float]:
    """Follow the flow back from a direction over a corner up to a maximum.

    Parameters
    ----------
    edges : Edges
    tops : (V,) bool
        Corners that are maxima.
    x : (3,) float [1]
        Direction down.
    corner : int
    left : (3,) float [1]
        Point of the sphere from which the fan on the left is seen.
    right : (3,) float [1]

    Returns
    -------
    int
        Corner of the maximum, or LOST_WALK.
    float [sr]
        Fan swept on the way, seen from ``left``.
    float [sr]
        The same, seen from ``right``.

    References
    ----------
    The area of a basin as a sum of triangles from one point to the pieces of its border.
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
def trace_saddles(
    edges: Edges,
    tops: Bools,
    saddles: Ints,
    directions: Floats,
    gauges: Floats,
    pairs: Ints,
    peaks: Ints,
    areas: Floats,
) -> None:
    """Find the sinks joined by each saddle, and the boundary integral of every facet's basin.

    Parameters
    ----------
    edges : Edges
    tops : (V,) bool
        Corners that are maxima.
    saddles : (E,) int
        Half-edge of each saddle.
    directions : (E, 3) float [1]
        Direction down on each saddle.
    gauges : (M, 3) float [1]
        Point of the sphere from which the border of each facet's basin is seen.
    pairs : (E, 2) int
        Filled: facets on which the part comes to rest on both sides.
    peaks : (E, 2) int
        Filled: maxima at both ends of the border.
    areas : (M,) float [sr]
        Added to: boundary integrals.

    Returns
    -------
    None

    References
    ----------
    Own; docs/resting.md, "Exact tumbling".
    """
    for e in range(len(saddles)):
        h, x = saddles[e], row(directions, e)
        s = roll_from_facet(edges, edges.facets[h // 3])
        t = roll_from_facet(edges, edges.facets[edges.twins[h] // 3])
        pairs[e, 0], pairs[e, 1] = s, t
        peaks[e, 0] = peaks[e, 1] = LOST_WALK
        if s == LOST_WALK or t == LOST_WALK:
            continue
        # the border between the two basins runs from the saddle up to a maximum, both ways
        # the border between the two basins runs from the saddle up to a maximum, both ways
        left, right = row(gauges, s), row(gauges, t)
        peaks[e, 0], back_s, back_t = climb(edges, tops, x, edges.origins[h], left, right)
        peaks[e, 1], ahead_s, ahead_t = climb(edges, tops, x, edges.targets[h], left, right)
        areas[s] += ahead_s - back_s
        areas[t] += back_t - ahead_t
