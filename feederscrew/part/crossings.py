"""Where a surface passes through itself: pairs of facets that cut each other along a line."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from feederscrew.geometry import vectors
from feederscrew.heavy import heavy
from feederscrew.part import topology
from feederscrew.part.mass import Solid
from feederscrew.part.topology import Points, Triangles

shapely = heavy("shapely")

AXIS_END_SHARE = 0.25  # [1] of the part's reach across its axis: how far the axis ends before the part does
FACING_AWAY_SINE = 1e-12  # [1] beyond it rounding does not decide whether a facet faces away from a point
EQUAL_FEET_SHARE = 1e-9  # [1] of the axis: feet closer than that may be one
NARROW_STRETCH_SHARE = 1e-2  # [1] of the axis: shorter stretches are not looked at
Floats = NDArray[np.float64]


def unseen_facets(vertices: Points, faces: Triangles, solid: Solid) -> NDArray[np.int64]:
    """Return the facets (N,) among which are all that cut each other.

    ``vertices`` (V, 3) [unit of the file]; ``faces`` (F, 3) int: closed, every side has one that runs back
    along it; ``solid``: what they enclose. None of a surface that the axis sees whole; also those for which
    rounding might decide it.

    The axis is a segment of the line about which the part is most slender. Every point off it has a foot, the
    nearest point of the segment, and the rays from each foot through the points that have it fill space once.
    Of the facets that a ray meets, those that face away from its foot less those that face it are as many as
    the turns of the surface round the foot. Where all with a foot there face away and the surface goes round
    once, every ray meets one facet. Beside a line along which two facets cut each other it would meet both.
    """
    along, across = vectors.eigen(solid.inertia)[1].T[:2]
    axes = np.array([along, across, vectors.cross(along, across)])
    places = np.einsum("ij,vj->iv", axes, vertices - solid.centre)
    short = AXIS_END_SHARE * np.sqrt((places[1] ** 2 + places[2] ** 2).max())
    low, high = min(places[0].min() + short, 0.0), max(places[0].max() - short, 0.0)
    # first and last foot of each facet, and whether it faces away from all of its feet
    a, b, c = places[:, faces.T].swapaxes(0, 1)
    u, v = b - a, c - a
    normal = vectors.cross_columns(u, v)
    i, j, k = np.clip(places[0], low, high)[faces.T]
    first, last = np.minimum(np.minimum(i, j), k), np.maximum(np.maximum(i, j), k)
    offset = vectors.dot_columns(normal, a)
    lengths = np.sqrt(vectors.dot_columns(u, u) * vectors.dot_columns(v, v))
    sure = FACING_AWAY_SINE * np.abs(places).max() * lengths
    away = np.minimum(offset - normal[0] * first, offset - normal[0] * last) > sure
    # stretches of the axis outside the feet of all facets that do not
    near = EQUAL_FEET_SHARE * (high - low)
    begin, stop = first[~away] - near, last[~away] + near
    order = np.argsort(begin)
    starts = np.append(-np.inf, np.maximum.accumulate(stop[order]))
    ends = np.append(begin[order], np.inf)
    wide = np.minimum(ends, high) - np.maximum(starts, low) >= NARROW_STRETCH_SHARE * (high - low)
    alone = np.zeros(len(faces), dtype=bool)
    for start, end in zip(starts[wide], ends[wide]):
        if _goes_round_once(places, faces, 0.5 * (max(start, low) + min(end, high))):
            alone |= (first > start) & (last < end)
    return np.flatnonzero(~alone)


def _goes_round_once(places: Floats, faces: Triangles, foot: float) -> bool:
    """Whether the section of the surface across the axis at a foot goes round it once."""
    above = places[0] > foot
    a, b, c = above[faces.T]
    through = faces[(a != b) | (b != c)]
    up = above[through]
    n, points = np.arange(len(through)), []
    for side in (
        (~up & np.roll(up, -1, axis=1)).argmax(axis=1),
        (up & ~np.roll(up, -1, axis=1)).argmax(axis=1),
    ):
        # where that side of each facet passes through the plane
        first, second = places[:, through[n, side]], places[:, through[n, (side + 1) % 3]]
        share = (foot - first[0]) / (second[0] - first[0])
        points.append(first[1:] + share * (second[1:] - first[1:]))
    (x, y), (z, w) = points
    return np.abs(np.arctan2(x * w - y * z, x * z + y * w).sum()) < 3.0 * np.pi  # a whole number of 2 pi


MAX_CROSSING_FACETS, MAX_BOX_PAIRS = 300_000, 20_000_000  # facets, and boxes that overlap: some seconds
PLANE_STEPS = 1e7  # steps of a unit in which planes are told apart
BOX_PAIRS_AT_ONCE = 4_000_000  # pairs of boxes at a time, at most: what a hundred MB hold


@dataclass(frozen=True, eq=False)
class Crossings:
    """Pairs of facets that cut each other."""

    pairs: np.ndarray  # (N, 2) int
    depths: np.ndarray  # (N,) [unit of the file] how far each goes through, the least of all directions
    points: np.ndarray  # (N, 3) [unit of the file] one point of each cut


def find_crossings(vertices: Points, faces: Triangles, tolerance: float) -> Crossings:
    """Find the facets that cut others they share no side with.

    ``vertices`` (V, 3) [unit of the file]; ``faces`` (F, 3) int; ``tolerance`` [unit of the file]: what goes
    less deep only touches. None are looked for in more than ``MAX_CROSSING_FACETS`` facets, nor after
    ``MAX_BOX_PAIRS`` pairs.
    Source: T. Möller, "A fast triangle-triangle intersection test", J. Graphics Tools 2(2), 25-30, 1997.
    """
    corners = vertices[faces]
    # unit normals; zero for a facet without area
    a, b, c = np.moveaxis(corners, 1, 0)
    normals = vectors.cross(b - a, c - a)
    length = vectors.norm(normals)[:, None]
    normals = normals / np.where(length > 0.0, length, 1.0)
    # each has corners on both sides of the other, by half the tolerance; in columns, from one corner
    places = np.ascontiguousarray((corners - corners[0, 0]).transpose(1, 2, 0))
    columns = np.ascontiguousarray(normals.T)
    offsets = vectors.dot_columns(columns, places[0])
    near = [np.empty((0, 2), dtype=int)]
    for pairs in _candidates(corners, normals):
        for own, other in ((0, 1), (1, 0)):
            first, second = pairs[:, own], pairs[:, other]
            normal, offset = columns[:, second], offsets[second]
            a, b, c = (vectors.dot_columns(normal, corner[:, first]) - offset for corner in places)
            above, below = np.maximum(np.maximum(a, b), c), np.minimum(np.minimum(a, b), c)
            pairs = pairs[(above > 0.5 * tolerance) & (below < -0.5 * tolerance)]
        near.append(pairs)
    pairs = np.concatenate(near)
    if not len(pairs):
        return Crossings(pairs, np.empty(0), np.empty((0, 3)))
    # each passes through the plane of the other: none that share a side
    for own, other in ((0, 1), (1, 0)):
        through = _through(_sides(corners, normals, pairs[:, own], pairs[:, other], tolerance))
        pairs = pairs[through > 0.0]
    # along a line longer than the tolerance
    i, j = pairs.T
    along = vectors.cross(normals[i], normals[j])
    length = vectors.norm(along)
    along = along / np.where(length > 0.0, length, 1.0)[:, None]
    of_first, of_second = (_sides(corners, normals, *order, tolerance) for order in ((i, j), (j, i)))
    (a, b), (c, d) = _interval(corners[i], of_first, along), _interval(corners[j], of_second, along)
    start, end = np.maximum(a, c), np.minimum(b, d)
    depths = np.minimum(end - start, np.minimum(_through(of_first), _through(of_second)))
    cut = (end - start > tolerance) & (length > 0.0)
    return Crossings(pairs[cut], depths[cut], _points(corners[i], of_first, along, start)[cut])


def _candidates(corners: Floats, normals: Floats) -> Iterator[NDArray[np.int64]]:
    """(N, 2) pairs of facets whose boxes overlap, but for many of one plane, some at a time."""
    if len(corners) > MAX_CROSSING_FACETS:
        return
    a, b, c = corners.transpose(1, 0, 2)
    low, high = np.minimum(np.minimum(a, b), c), np.maximum(np.maximum(a, b), c)
    x, y, z = np.argsort(-np.ptp(low, axis=0), kind="stable")
    boxes = shapely.linestrings(np.stack([low[:, [x, y]], high[:, [x, y]]], axis=1))  # made sooner than boxes
    tree = shapely.STRtree(boxes)
    # the plane of each facet, those of one plane mostly the same: they do not cut each other
    offsets = np.einsum("fx,fx->f", normals, corners[:, 0]) / np.abs(corners).max()
    plane = topology.distinct_points(np.round(np.column_stack([normals, offsets]) * PLANE_STEPS))[1]
    floor, top = np.ascontiguousarray(low[:, z]), np.ascontiguousarray(high[:, z])
    box_pairs, step = 0, max(1, BOX_PAIRS_AT_ONCE // len(boxes))
    for start in range(0, len(boxes), step):
        i, j = tree.query(boxes[start : start + step])
        i, box_pairs = i + start, box_pairs + len(i)
        if box_pairs > MAX_BOX_PAIRS:
            return
        once = i < j
        i, j = i[once], j[once]
        overlaps = (plane[i] != plane[j]) & (floor[i] <= top[j]) & (floor[j] <= top[i])
        yield np.column_stack([i[overlaps], j[overlaps]])


def _sides(
    corners: Floats, normals: Floats, facets: NDArray[np.int64], crossed: NDArray[np.int64], tolerance: float
) -> Floats:
    """(N, 3) [unit of the file] how far corners of ``facets`` lie above ``crossed``; 0 within tolerance."""
    above = np.einsum("nkx,nx->nk", corners[facets] - corners[crossed, :1], normals[crossed])
    return np.where(np.abs(above) <= tolerance, 0.0, above)


def _through(sides: Floats) -> Floats:
    """(N,) how far facets pass through planes: the less of both sides, 0 where they do not."""
    a, b, c = sides.T
    above, below = np.maximum(np.maximum(a, b), c), np.minimum(np.minimum(a, b), c)
    return np.minimum(above, -below).clip(0.0)


def _interval(corners: Floats, sides: Floats, along: Floats) -> tuple[Floats, Floats]:
    """Where facets meet planes they pass through: from and to, (N,) and (N,), along a direction."""
    t = np.einsum("nkx,nx->nk", corners, along)
    u, s = np.roll(t, -1, axis=1), np.roll(sides, -1, axis=1)
    across = sides * s < 0.0
    cut = np.where(across, t + (u - t) * sides / np.where(across, sides - s, 1.0), np.nan)
    crossings = np.concatenate([cut, np.where(sides == 0.0, t, np.nan)], axis=1)
    return np.fmin.reduce(crossings, axis=1), np.fmax.reduce(crossings, axis=1)


def _points(corners: Floats, sides: Floats, along: Floats, start: Floats) -> Floats:
    """(N, 3) the points where cuts begin: on the line of the facet's own crossing, at ``start`` along it."""
    s = np.roll(sides, -1, axis=1)
    k = np.argmax(sides * s < 0.0, axis=1)
    n = np.arange(len(k))
    a, b = corners[n, k], corners[n, (k + 1) % 3]
    share = sides[n, k] / np.where(sides[n, k] == s[n, k], 1.0, sides[n, k] - s[n, k])
    point = a + share[:, None] * (b - a)
    return point + (start - np.einsum("nx,nx->n", point, along))[:, None] * along
