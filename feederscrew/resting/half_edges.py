"""Half-edges of a convex hull, its facets with their borders, and the signs that steer a part rolling on it.

Half-edge 3 t + k of triangle t runs from its corner k + 1 to its corner k + 2, opposite corner k; arrays
have one entry for each of the H half-edges. The walks of `tumbling.walk` rely on a convex body: convex
facets, three of them or more at each corner, three corners or more to each facet. Noise in a file leaves
corners on the edge between two facets, needles (triangles whose corners are the ends of one edge and such a
corner between them), and planes of which some triangles are coplanar within the tolerance of merging and
others are not.
"""

from typing import NamedTuple

import numpy as np

from feederscrew.base import check
from feederscrew.base.arrays import Bools, Floats, Ints, Points
from feederscrew.base.geometry import vectors
from feederscrew.base.geometry.graphs import components
from feederscrew.part.hull import Hull

COPLANAR = 1e-10  # [1] of the radius: depth below a neighbour's plane that is still the same facet
NEEDLE_WIDTH = 1e-9  # [1] of the radius: a triangle narrower than this has no plane of its own
PLANE = 1e-14  # [1] error of a triangle's plane at the far end of the part, times its width over the radius
MIN_FACETS_AT_CORNER = 3  # facets at a corner
STRAIGHTNESS_TOLERANCE = 1e-9  # [1] of the radius: of a corner behind the line of its neighbours


class Edges(NamedTuple):
    """Half-edges of a hull of T triangles, H = 3 T, and its facets of coplanar triangles.

    Only half-edges on a border lead somewhere: from one corner of three facets or more to the next.
    A named tuple, so that compiled code can read it.
    """

    vertices: Points  # (V, 3) [m] about the centre of mass
    origins: Ints  # (H,) corner a half-edge starts from
    targets: Ints  # (H,) corner it ends at
    twins: Ints  # (H,) the same edge seen from the other side
    facets: Ints  # (T,) facet of each triangle
    borders: Bools  # (H,) bool: parts two facets
    ahead: Ints  # (H,) next border half-edge of the same facet
    around: Ints  # (H,) next border half-edge leaving the same corner
    slopes: Floats  # (H,) [m2] origin . (target - origin): negative where the foot is ahead
    sides: Floats  # (H,) [m2] not negative where the foot of the facet is inside this edge
    normals: Floats  # (M, 3) outward unit normals of the M facets
    facet_edges: Ints  # (M,) a bordering half-edge of each facet
    vertex_edges: Ints  # (V,) a bordering half-edge leaving each corner, or one of a facet it lies on


def half_edges(hull: Hull) -> Edges:
    """Return half-edges of a hull, coplanar triangles merged into facets.

    Parameters
    ----------
    hull : Hull
        The centre of mass lies strictly inside.

    Returns
    -------
    Edges
    """
    origins = hull.triangles[:, [1, 2, 0]].ravel().astype(int)
    targets = hull.triangles[:, [2, 0, 1]].ravel().astype(int)
    neighbours = hull.neighbours
    owners, beyond = np.repeat(np.arange(len(neighbours)), 3), neighbours.ravel().astype(int)
    first, second = (np.ascontiguousarray(column)[beyond] == owners for column in neighbours.T[:2])
    twins = 3 * beyond + np.where(first, 0, np.where(second, 1, 2))
    borders = facet_borders(hull, origins, targets, twins, np.repeat(_facets(hull, twins), 3))
    facets, edges = borders.facets[::3], np.flatnonzero(borders.part)
    normals = _facet_normals(hull, facets)
    # slopes and sides, from each half-edge's corners and facet
    corners, of_facets = np.ascontiguousarray(hull.vertices.T), np.ascontiguousarray(normals.T)
    u, w = corners[:, origins], corners[:, borders.targets]
    sides = vectors.dot_columns(of_facets[:, borders.facets], vectors.cross_columns(u, w))
    slopes = _one_way_out(vectors.dot_columns(u, w - u), sides, borders)
    by_facet, by_vertex = np.zeros(len(normals), int), np.zeros(len(hull.vertices), int)
    by_facet[borders.facets[edges]] = edges
    by_vertex[origins] = by_facet[borders.facets]
    by_vertex[origins[edges]] = edges
    around = np.zeros_like(borders.ahead)  # the first half-edge off the borders
    around[borders.ahead[edges]] = borders.twins[edges]
    arrays = Edges(
        hull.vertices,
        origins,
        borders.targets,
        borders.twins,
        facets,
        borders.part,
        borders.ahead,
        around,
        slopes,
        sides,
        normals,
        by_facet,
        by_vertex,
    )
    return Edges(*map(check.frozen, arrays))


def _one_way_out(slopes: Floats, sides: Floats, borders: "Borders") -> Floats:
    """Return slopes (H,) [m2] with which every facet is left one way: over an edge, over a corner or not.

    The foot of the centre of mass lies nearest to one place of a convex polygon. Where a corner of the border
    lies on or, by rounding, behind the line between its neighbours, the signs may name two places or none.
    Then the nearest is taken; at the others the foot counts as past the corner on the other side of it.
    """
    edges, before = np.flatnonzero(borders.part), np.zeros_like(borders.ahead)
    before[borders.ahead[edges]] = edges
    slopes, leaves = slopes.copy(), sides[edges] < 0.0
    over_edge = leaves & (slopes[edges] <= 0.0) & (slopes[borders.twins[edges]] <= 0.0)
    over_corner = (slopes[edges] > 0.0) & (slopes[borders.twins[before[edges]]] > 0.0)
    facet, twins, tiny = borders.facets[edges], borders.twins, np.finfo(float).tiny
    exits, unstable = np.bincount(facet, over_edge * 1 + over_corner), np.bincount(facet, leaves) > 0
    for doubtful in np.flatnonzero(exits != unstable):
        own = facet == doubtful
        # how far away the edges and corners are that the facet is left over; those with the foot beyond them
        places = sorted(
            ((sides[h] ** 2 + corner * slopes[h] ** 2) / -(slopes[h] + slopes[twins[h]]), corner, h)
            for corner, over in enumerate((over_edge, over_corner))
            for h in edges[own & over].tolist()
        )
        leaving = edges[own & leaves].tolist()
        if leaving and not places:
            end = min((max(h, twins[h], key=slopes.__getitem__) for h in leaving), key=slopes.__getitem__)
            slopes[end] = 0.0
        for _, corner, h in places[1:] if leaving else places:
            ends = (h, twins[before[h]]) if corner else (h, twins[h])
            end = min(ends, key=lambda end: abs(slopes[end]))
            slopes[end] = -tiny if corner else tiny
    return slopes


def sinks(edges: Edges) -> Ints:
    """Return the facets that hold the foot of the centre of mass: the part rests on them.

    Parameters
    ----------
    edges : Edges

    Returns
    -------
    (S,) int [index]
    """
    leaves = edges.borders & (edges.sides < 0.0)
    return np.setdiff1d(np.arange(len(edges.normals)), np.repeat(edges.facets, 3)[leaves])


def saddles(edges: Edges) -> Ints:
    """Return the half-edges, one of each pair, over which the part can be balanced.

    The foot of the centre of mass lies between the two corners and neither facet rolls over the edge.

    Parameters
    ----------
    edges : Edges

    Returns
    -------
    (E,) int [index]
    """
    ahead = (edges.slopes <= 0.0) & (edges.sides >= 0.0) & edges.borders
    return np.flatnonzero(ahead & ahead[edges.twins] & (np.arange(len(ahead)) < edges.twins))


def maxima(edges: Edges) -> Ints:
    """Return the corners on which the part can be balanced: no neighbour is further out.

    Parameters
    ----------
    edges : Edges

    Returns
    -------
    (M,) int [index]
    """
    origins = edges.origins[edges.borders]
    return np.setdiff1d(origins, origins[edges.slopes[edges.borders] > 0.0])


def _facets(hull: Hull, twins: Ints) -> Ints:
    """Return the facet of each triangle: triangles joined across flat edges."""
    owners = np.repeat(np.arange(len(hull.triangles)), 3)
    # how far the corner off each edge, of the neighbour, lies below the triangle's plane
    corners = np.ascontiguousarray(hull.vertices.T)[:, hull.triangles.ravel()[twins]]
    normals = np.ascontiguousarray(hull.normals.T)
    depths = hull.heights[owners] - vectors.dot_columns(normals[:, owners], corners)
    near = np.flatnonzero(np.minimum(depths, depths[twins]) <= COPLANAR * hull.radius)
    if not len(near):
        return np.arange(len(hull.triangles))
    # Both triangles must lie in each other's plane as far as rounding lets that be known; a sliver joins the
    # neighbour across its longest edge only, or it would glue the facets on both its sides.
    inside, sliver, across = np.ones(len(near), bool), np.zeros(len(near), bool), np.zeros(len(near), bool)
    for sides in (near, twins[near]):
        triangle, edge = sides // 3, sides % 3
        ends = hull.vertices[hull.triangles[triangle]]
        lengths = vectors.norm(ends[:, [2, 0, 1]] - ends[:, [1, 2, 0]])  # opposite each corner
        width = 2.0 * hull.areas[triangle] / lengths.max(axis=1) / hull.radius
        narrow = width < NEEDLE_WIDTH
        inside &= depths[sides] <= hull.radius * (COPLANAR + PLANE / np.maximum(width, NEEDLE_WIDTH))
        across |= narrow & (edge == lengths.argmax(axis=1))
        sliver |= narrow
    flat = near[across | (inside & ~sliver)]
    return components(owners[flat], owners[twins[flat]], len(hull.triangles))[1]


def _facet_normals(hull: Hull, facets: Ints) -> Floats:
    """Return unit normals (M, 3) of the facets, by the areas of their triangles."""
    if len(hull.triangles) == facets.max() + 1:
        return hull.normals[np.argsort(facets)]
    weighted = hull.areas[:, None] * hull.normals
    sums = np.stack([np.bincount(facets, column) for column in weighted.T], axis=1)
    return sums / np.maximum(vectors.norm(sums), np.finfo(float).tiny)[:, None]


class Borders(NamedTuple):
    """Half-edges of which only some part two facets."""

    targets: Ints  # (H,) corner a half-edge ends at
    twins: Ints  # (H,) the same edge seen from the other side
    part: Bools  # (H,) bool: parts two facets, from one corner of three facets to the next
    ahead: Ints  # (H,) next half-edge along the border of the same facet
    facets: Ints  # (H,) facet of each half-edge


def facet_borders(hull: Hull, origins: Ints, targets: Ints, twins: Ints, facets: Ints) -> Borders:
    """Return the borders between facets, as a convex body has them.

    Every corner has three edges or more, every facet likewise and is convex. A facet that would not be convex
    is left in triangles. A facet left with two edges (a needle) becomes part of its neighbour.

    Parameters
    ----------
    hull : Hull
    origins : (H,) int
        Corner each half-edge starts from; half-edges 3 t to 3 t + 2 run around triangle t.
    targets : (H,) int
        Corner it ends at.
    twins : (H,) int
        The same edge seen from the other side.
    facets : (H,) int
        Facet of coplanar triangles that each half-edge belongs to.

    Returns
    -------
    Borders
        Facets are numbered without gaps.

    References
    ----------
    Own.
    """
    single, reflex = np.arange(len(facets)) // 3, np.ones(1, bool)
    while reflex.any():  # take facets with a reflex corner apart
        bordered = _find_borders(targets, twins, facets)
        edges = np.flatnonzero(bordered.part & (np.bincount(facets[::3])[facets] > 1))
        corner = hull.vertices[targets[edges]]
        before, after = hull.vertices[origins[edges]], hull.vertices[targets[bordered.ahead[edges]]]
        across = vectors.cross(corner - before, after - corner)
        turn = (across * _facet_normals(hull, facets[::3])[facets[edges]]).sum(axis=1)
        reflex = turn < -STRAIGHTNESS_TOLERANCE * hull.radius * np.sqrt(((after - before) ** 2).sum(axis=1))
        if reflex.any():
            split = np.isin(facets, facets[edges[reflex]])
            facets = _number_facets(np.where(split, facets.max() + 1 + single, facets))
    while True:
        borders = _straighten_borders(origins, _find_borders(targets, twins, facets))
        edges, ahead = np.flatnonzero(borders.part), borders.ahead  # needles are facets of two edges
        needles = edges[(ahead[ahead[edges]] == edges) & (edges < ahead[edges])]
        if not len(needles):
            return borders._replace(facets=_number_facets(facets))
        first, second = facets[needles], facets[borders.twins[needles]]
        facets = components(first, second, facets.max() + 1)[1][facets]


def _find_borders(targets: Ints, twins: Ints, facets: Ints) -> Borders:
    """Return the borders between facets before corners of two facets are removed."""
    part = facets != facets[twins]
    # next border along each facet, over the edges within it; meaningless off the borders
    following = np.arange(len(twins)).reshape(-1, 3)[:, [1, 2, 0]].ravel()
    ahead = following.copy()
    inside = np.flatnonzero(part & ~part[ahead])
    while len(inside):
        ahead[inside] = following[twins[ahead[inside]]]
        inside = inside[~part[ahead[inside]]]
    return Borders(targets, twins, part, ahead, facets)


def _number_facets(facets: Ints) -> Ints:
    """Return facets (H,) numbered without gaps."""
    return np.unique(facets, return_inverse=True)[1].ravel()


def _straighten_borders(origins: Ints, borders: Borders) -> Borders:
    """Return borders with one edge where several met at corners of two facets."""
    valence = np.bincount(origins[borders.part], minlength=origins.max() + 1)
    # passing half-edges end at a corner of two facets
    passing = borders.part & (valence[borders.targets] < MIN_FACETS_AT_CORNER)
    if not passing.any():
        return borders
    starts = np.flatnonzero(borders.part & ~passing[borders.twins])
    last, going = starts.copy(), np.flatnonzero(passing[starts])
    while len(going):
        last[going] = borders.ahead[last[going]]
        going = going[passing[last[going]]]
    targets, twins, ahead = (array.copy() for array in (borders.targets, borders.twins, borders.ahead))
    targets[starts], twins[starts], ahead[starts] = targets[last], twins[last], ahead[last]
    part = np.zeros_like(borders.part)
    part[starts] = True
    return Borders(targets, twins, part, ahead, borders.facets)
