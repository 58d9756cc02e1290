"""Footprint of a part on the track: facets, edges and points of its mesh, its verdicts, and its views.

The verdicts of feet over holes are compiled: ``kernel``. Source: own; docs/tooling.md, "1. The method".
"""

import math
import threading
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING

import numpy as np
import shapely

from feederscrew.base import check
from feederscrew.base.arrays import Bools, Floats, Ints, Points, Triangles
from feederscrew.base.geometry import polygons, shaded
from feederscrew.base.geometry.compiled import zero_rows
from feederscrew.base.geometry.polygons import turned
from feederscrew.base.heavy import heavy
from feederscrew.bowl.devices.openings import WALL_OVERCUT_M, HoleEdges, gap
from feederscrew.resting.lying import TOUCHING_SHARE
from feederscrew.resting.posture import Posture

if TYPE_CHECKING:
    from feederscrew.sorting.kernel import Buffers, Foot

kernel = heavy("feederscrew.sorting.kernel")

MAX_SPARE = 16  # sizes of arrays for verdicts that a thread keeps
SPOT = 1e-7  # [m] half the length of a single point of contact
SECTOR_TOLERANCE = 1e-9  # [1] of an angle or a distance: what is beyond by more is so for certain
ROLLING_FOOT_SHARE = 0.03  # of a rolling part's height of the centre of mass: its underside is foot
SLIVER = 1e-6  # of the part's size squared: smaller areas and holes of them are leftovers of rounding
SLOT_CHORD_M = 2e-7  # [m] by which the edge of a slot may be seen too flat
FOOT_DETAIL_SHARE = 1e-4  # of the part's size: corners that stand out by less are left out
SILHOUETTE_STEP_M = 3e-5  # [m] to which a silhouette is exact on a curved track
FOOT_GRID_M = 1e-8  # [m] of its corners
VIEW_DETAIL_SHARE = 1e-4  # of the part's size: corners that stand out by less are left out
SLIT_AREA_TOLERANCE = 1e-6  # of an area, that closing its slits may lose by rounding
SECTION_GRID_M = 1e-6  # [m] to which sections are rounded: where facets meet they meet
MIN_FEATURE_M = 1e-7  # [m] of what is not there
SLIT = 2e-5  # [m] half the width of slits between facets that are closed


@dataclass(frozen=True, eq=False)
class Footprint:
    """Places where a part touches the track, in track axes from the foot of the centre of mass."""

    rings: tuple[Points, ...] = ()  # (K, 2) [m] borders of areas, holes of them as rings of their own
    edges: Floats = field(default_factory=lambda: np.empty((0, 2, 2)))  # (E, 2, 2) [m] lines of contact
    points: Points = field(default_factory=lambda: np.empty((0, 2)))  # (P, 2) [m] points of contact

    @cached_property
    def corners(self) -> Points:
        """Return every corner of it (V, 2) [m]."""
        return np.concatenate([*self.rings, self.edges.reshape(-1, 2), self.points])

    @cached_property
    def mouth(self) -> float:
        """Return how far [m] the weight is from a rim all round it, on which it stands; 0 without one."""
        area = shapely.Polygon()
        for ring in self.rings:
            area = area.symmetric_difference(shapely.Polygon(ring))
        area, here = area.buffer(SLIT), shapely.Point(0.0, 0.0)  # closes slits between facets of the rim
        holes = [shapely.Polygon(hole) for part in shapely.get_parts(area) for hole in part.interiors]
        return next((hole.exterior.distance(here) + SLIT for hole in holes if hole.contains(here)), 0.0)


# -- verdicts of a foot


@lru_cache(maxsize=512)
def axial_foot(foot: Footprint, distance: float, radius: float, shift: float = 0.0) -> "Foot":
    """Return a foot about the bowl's axis, as the compiled verdict takes it.

    Parameters
    ----------
    foot : Footprint
    distance : float [m]
        From the wall to the foot of the centre of mass.
    radius : float [m]
        Of the wall.
    shift : float [m], optional
        By which the weight meets a banked track nearer to the wall.

    Returns
    -------
    Foot
    """
    # single points are short lines along the track: an edge that comes is noticed there
    middle, edges = radius - distance, foot.edges
    if len(foot.points):
        lines = foot.points[:, None] + np.array([[-SPOT, 0.0], [SPOT, 0.0]])
        edges = np.concatenate([foot.edges.reshape(-1, 2, 2), lines])
        foot = Footprint(rings=foot.rings, edges=edges)
    start = np.concatenate([*foot.rings, edges[:, 0]])
    end = np.concatenate([*(np.roll(ring, -1, axis=0) for ring in foot.rings), edges[:, 1]])
    closed = np.arange(len(start)) < sum(len(ring) for ring in foot.rings)
    has_length = np.hypot(*(end - start).T) > 1e-12
    start, end, closed = start[has_length], end[has_length], closed[has_length]
    corners = np.column_stack([foot.corners[:, 0], middle - foot.corners[:, 1]])
    # its convex hull about the foot of the centre of mass, and the insets of the hull's sides
    about = np.column_stack([corners[:, 0], middle + shift - corners[:, 1]])
    hull, insets = polygons.convex(about), np.empty(0)
    if len(hull) < 3:
        hull = np.empty(0, dtype=np.int64)
    else:
        first = about[hull]
        along = np.roll(first, -1, axis=0) - first
        insets = (first[:, 0] * along[:, 1] - first[:, 1] * along[:, 0]) / np.hypot(*along.T)
    # angles and distances about the axis between which its areas lie for certain
    ring_start, ring_end = (np.array([1.0, -1.0]) * (ends[closed] - [0.0, middle]) for ends in (start, end))
    sector = np.array([-np.inf, np.inf, 0.0, np.inf])
    if len(ring_start) and ring_start[:, 1].min() > 0.0:
        way = ring_end - ring_start
        share = np.clip(-(ring_start * way).sum(axis=1) / (way * way).sum(axis=1), 0.0, 1.0)
        nearest, far = np.hypot(*(ring_start + share[:, None] * way).T).min(), np.hypot(*ring_start.T).max()
        theta = np.arctan2(*ring_start.T)
        sector[:2] = theta.min() - SECTOR_TOLERANCE, theta.max() + SECTOR_TOLERANCE
        sector[2:] = nearest * (1.0 - SECTOR_TOLERANCE), far * (1.0 + SECTOR_TOLERANCE)
    return kernel.Foot(
        hull=hull,
        insets=insets,
        sides=np.column_stack([start[:, 0], middle - start[:, 1], (end - start) * [1.0, -1.0]]),
        closed=closed.astype(np.int64),
        corners=about,
        polar=np.column_stack([np.arctan2(*corners.T), np.hypot(*corners.T)]),
        centre=middle + shift,
        reach=float(np.hypot(corners[:, 0], corners[:, 1] - middle - shift).max()),
        all_corners=np.arange(len(corners)),
        sector=sector,
    )


def scratch(*feet: "Foot", edges: int = 1, nodes: int = 0) -> "Buffers":
    """Return arrays for the verdict of some feet over a hole.

    Parameters
    ----------
    *feet : Foot
        The largest sets the sizes.
    edges, nodes : int, optional
        Of the hole; by default a ring.

    Returns
    -------
    Buffers
    """
    rows = 6 * max(len(foot.sides) for foot in feet) * edges + 1
    corners = max(len(foot.corners) for foot in feet)
    points = corners + rows + nodes + edges
    return kernel.Buffers(
        rows=zero_rows(rows, kernel.STRETCH),
        events=np.empty(2 * rows),
        bounds=np.empty(2 * rows),
        movements=np.empty(2 * rows),
        cuts=np.empty(kernel.CUTS),
        keep=np.empty(corners, dtype=np.int64),
        crossings=np.empty(corners, dtype=np.int64),
        angles=np.empty((corners, edges)),
        held=np.empty(nodes, dtype=np.int64),
        active=np.empty(rows, dtype=np.int64),
        points=np.empty((points, 2)),
        moved_points=np.empty((points, 2)),
    )


class _Spare(threading.local):
    """Arrays of a thread for verdicts, by their sizes: to make them takes longer than most verdicts."""

    def __init__(self) -> None:
        self.known: dict[tuple[int, ...], Buffers] = {}

    def of(self, foot: "Foot", edges: int = 1, nodes: int = 0) -> "Buffers":
        key = len(foot.sides), len(foot.corners), edges, nodes
        if key not in self.known:
            if len(self.known) >= MAX_SPARE:
                self.known.clear()
            self.known[key] = scratch(foot, edges=edges, nodes=nodes)
        return self.known[key]


SPARE = _Spare()


def _scratch_of(foot: "Foot", hole: HoleEdges) -> "Buffers":
    return SPARE.of(foot, len(hole.edges), len(hole.nodes))


def least(
    foot: "Foot", hole: HoleEdges, work: "Buffers | None" = None, low: float = -np.inf, high: float = np.inf
) -> tuple[float, float]:
    """Return the least margin of a foot over a hole's passage, and where it is.

    The margin is how far the foot of the centre of mass lies inside the convex hull of what is supported,
    over every place of the hole below the part.

    Parameters
    ----------
    foot : Foot
    hole : HoleEdges
    work : Buffers, optional
        Of ``scratch``, to be used again.
    low, high : float [m], optional
        A margin below ``low`` may be given as any that is below it, one above ``high`` as any above.

    Returns
    -------
    margin : float [m]
        Negative where the foot is not carried.
    shift : float [rad]
        Of the hole, where it is.

    References
    ----------
    docs/tooling.md, "1. The method".
    """
    out = np.empty(2)
    kernel.least(foot, hole, work or _scratch_of(foot, hole), low, high, out)
    return float(out[0]), float(out[1])


def unheld(foot: "Foot", hole: HoleEdges, work: "Buffers | None" = None, enough: float = np.inf) -> float:
    """Return the longest way over which a hole leaves a foot without support.

    Parameters
    ----------
    foot : Foot
    hole : HoleEdges
    work : Buffers, optional
        Of ``scratch``, to be used again.
    enough : float [m], optional
        A way that is longer may be given as any that is longer.

    Returns
    -------
    float [m]

    References
    ----------
    docs/tooling.md, "1. The method".
    """
    turn = enough * (1.0 + SECTOR_TOLERANCE) / foot.centre
    return float(kernel.longest(foot, hole, work or _scratch_of(foot, hole), turn)) * foot.centre


def over_ring(foot: "Foot", low: float, high: float) -> float:
    """Return the margin of a foot on a track without what lies between two radii about the axis.

    Parameters
    ----------
    foot : Foot
    low, high : float [m]
        The radii.

    Returns
    -------
    float [m]
        Negative where the foot is not carried.

    References
    ----------
    docs/tooling.md, "1. The method".
    """
    return float(kernel.over_ring(foot, low, high, SPARE.of(foot)))


def balcony(foot: "Foot", radius: float) -> float:
    """Return the least width of track that carries a foot.

    Parameters
    ----------
    foot : Foot
    radius : float [m]
        Of the wall.

    Returns
    -------
    float [m]
        Infinite where no width does.

    References
    ----------
    docs/tooling.md, "1. The method".
    """
    work, widest = SPARE.of(foot), _extent(foot, radius)

    def carries(width: float) -> bool:
        return kernel.over_ring(foot, 0.0, radius - width, work) >= 0.0

    return halve(carries, widest)[1] if carries(widest) else math.inf


def canyon(foot: "Foot", radius: float) -> float:
    """Return the greatest width of a strip removed along the wall that a foot passes.

    Parameters
    ----------
    foot : Foot
    radius : float [m]
        Of the wall.

    Returns
    -------
    float [m]
        0 where it passes none.
    """
    work = SPARE.of(foot)

    def falls(width: float) -> bool:
        return kernel.over_ring(foot, radius - width, 2.0 * radius, work) < 0.0

    return 0.0 if falls(0.0) else halve(falls, _extent(foot, radius))[0]


def halve(holds: Callable[[float], bool], high: float) -> tuple[float, float]:
    """Return the values between which something begins to hold, next to each other, by sixty halvings.

    Parameters
    ----------
    holds : callable
        Of a value; false at 0, true at ``high``, with one change between them.
    high : float [any]

    Returns
    -------
    low, high : float [any]
        It does not hold at the first, and holds at the second.
    """
    low = 0.0
    for _ in range(60):
        middle = 0.5 * (low + high)
        if not low < middle < high:  # nothing lies between them: they are next to each other
            break
        low, high = (low, middle) if holds(middle) else (middle, high)
    return low, high


def longest_gap(foot: "Foot", radius: float) -> float:
    """Return the greatest gap across the track that a foot passes.

    Parameters
    ----------
    foot : Foot
    radius : float [m]
        Of the wall.

    Returns
    -------
    float [m]
        0 where it passes none.
    """
    low, high, width = 0.0, 2.0 * foot.reach, _extent(foot, radius)
    work = _scratch_of(foot, gap(high, radius, width))

    def passes(length: float) -> bool:
        return least(foot, gap(length, radius, width), work, low=0.0, high=0.0)[0] >= 0.0

    if not passes(1e-9):
        return 0.0
    while high - low > 1e-12:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if passes(middle) else (low, middle)
    return low


def _extent(foot: "Foot", radius: float) -> float:
    """How far [m] from the wall a foot reaches, and a little on; a straight side is nearest in between."""
    (x, y), (u, v) = foot.sides[:, :2].T, foot.sides[:, 2:].T
    share = np.clip(-(x * u + y * v) / (u * u + v * v), 0.0, 1.0)
    nearest = min(foot.polar[:, 1].min(), np.hypot(x + share * u, y + share * v).min())
    return min(float(radius - nearest + WALL_OVERCUT_M), radius)


# -- what touches the track


@lru_cache(maxsize=128)
def find_footprint(posture: Posture, heading: float) -> Footprint:
    """Find where a part touches the track, in track axes from the foot of the centre of mass.

    A part that rolls touches with the strip of its underside that a hole's edge would carry, up to
    ``ROLLING_FOOT_SHARE`` of its height, however finely its round side is cut into facets. Where nothing of
    the mesh is low enough to carry it, the contact polygon does.

    Parameters
    ----------
    posture : Posture
    heading : float [rad]
        As in Orientation.

    Returns
    -------
    Footprint
    """
    rolls = posture.kind == "rolling"
    polygon = Footprint(rings=(check.frozen(turned(posture.contact, heading)),))
    if not rolls and not posture.on_floor.any():
        return polygon
    points, faces = posture.surface, posture.facets
    size = np.ptp(posture.outline, axis=0).max()
    near = TOUCHING_SHARE * size
    depth = ROLLING_FOOT_SHARE * posture.height if rolls else near
    plan, low = turned(points[:, :2], heading), points[:, 2] < depth
    area = area_below(plan, points[:, 2], faces, depth, rolls)
    area = area.simplify(FOOT_DETAIL_SHARE * size) if not area.is_empty else area
    # edges and points of the mesh on the track that no area covers
    around = area.buffer(near) if not area.is_empty else area
    ends = edges_of(posture)
    edges = plan[ends[low[ends].all(axis=1)]].reshape(-1, 2, 2)
    edges = edges[np.hypot(*(edges[:, 1] - edges[:, 0]).T) > near]
    edges = edges[~_is_covered(edges.mean(axis=1), around)]
    single = np.unique(plan[low], axis=0)
    single = single[~_is_covered(single, around)]
    lines = shapely.union_all(shapely.linestrings(edges)).buffer(near) if len(edges) else shapely.Polygon()
    single = single[~_is_covered(single, lines)]
    if area.is_empty and len(edges) + len(single) < 1:
        return polygon
    return Footprint(rings(area, SLIVER * size**2), check.frozen(edges), check.frozen(single))


def area_below(plan: Points, height: Floats, faces: Triangles, depth: float, cut: bool) -> shapely.Geometry:
    """Return the union of the facets lower than a depth, seen from above.

    Parameters
    ----------
    plan : (V, 2) float [m]
        Corners from above.
    height : (V,) float [m]
        Of the corners.
    faces : (F, 3) int
        Facets between corners.
    depth : float [m]
    cut : bool
        Whether facets that are partly lower count with that part.

    Returns
    -------
    shapely geometry [m]
    """
    low = height[faces] < depth
    pieces = list(shapely.polygons(plan[faces[low.all(axis=1)]]))
    for face in faces[low.any(axis=1) & ~low.all(axis=1)] if cut else ():
        ring, corners, heights = [], plan[face], height[face]
        for a, b, za, zb in zip(corners, np.roll(corners, -1, axis=0), heights, np.roll(heights, -1)):
            if za < depth:
                ring.append(a)
            if (za < depth) != (zb < depth):
                ring.append(a + (depth - za) / (zb - za) * (b - a))
        pieces.append(shapely.Polygon(ring))
    areas = np.array(pieces, dtype=object)
    areas = areas[shapely.area(areas) > 0.0]
    return shapely.union_all(shapely.make_valid(areas), grid_size=1e-9) if len(areas) else shapely.Polygon()


@lru_cache(maxsize=128)
def edges_of(posture: Posture) -> Ints:
    """Return the edges of a posture's mesh.

    Parameters
    ----------
    posture : Posture

    Returns
    -------
    (E, 2) int
        Corners by their rows in ``surface``, each edge once, ascending.
    """
    faces = posture.facets
    ends = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    return check.frozen(np.unique(np.sort(ends, axis=1), axis=0))


def _is_covered(points: Points, area: shapely.Geometry) -> Bools:
    return shapely.contains_xy(area, points) if not area.is_empty else np.zeros(len(points), dtype=bool)


def rings(area: shapely.Geometry, least: float = 0.0) -> tuple[Points, ...]:
    """Return the borders of an area, those of its holes too.

    Parameters
    ----------
    area : shapely geometry [m]
    least : float [m2], optional
        Areas and holes that are not larger are left out.

    Returns
    -------
    tuple of (K, 2) float [m]
        Without the first corner repeated at the end.
    """
    parts = shapely.get_parts(area)
    areas = [piece for piece in parts if piece.geom_type == "Polygon" and piece.area > least]
    lines = [ring for polygon in areas for ring in (polygon.exterior, *polygon.interiors)]
    lines = [ring for ring in lines if shapely.Polygon(ring).area > least]
    return tuple(check.frozen(np.array(ring.coords)[:-1]) for ring in lines)


def ring(span: tuple[float, ...], distance: float, radius: float, reach: float) -> shapely.Polygon:
    """Return the area between two distances from the wall, about the foot of the centre of mass.

    Parameters
    ----------
    span : tuple of float [m]
        The distances.
    distance : float [m]
        From the wall to the foot of the centre of mass.
    radius : float [m]
        Of the wall.
    reach : float [m]
        How far the area goes on ahead and behind.

    Returns
    -------
    shapely.Polygon [m]
    """
    most = min(reach / max(radius - span[1], 0.1 * radius), 0.999 * np.pi)
    count = 2 + int(2.0 * most * np.sqrt(radius / (8.0 * SLOT_CHORD_M)))
    turn = np.linspace(-most, most, count)
    sides = [radius - span[0] + WALL_OVERCUT_M * (span[0] <= 0.0), max(radius - span[1], 0.0)]
    middle = radius - distance
    outer, inner = (np.column_stack([r * np.sin(turn), middle - r * np.cos(turn)]) for r in sides)
    return shapely.Polygon(np.vstack([outer, inner[::-1]]))


def rest_beside_slot(foot: Footprint, span: tuple[float, ...], distance: float, radius: float) -> Footprint:
    """Return the part of a footprint that rests beside a slot.

    Parameters
    ----------
    foot : Footprint
    span : tuple of float [m]
        The slot: from and to, off the wall.
    distance : float [m]
        From the wall to the foot of the centre of mass.
    radius : float [m]
        Of the wall.

    Returns
    -------
    Footprint
    """
    if not len(foot.corners):
        return foot
    return _cut_away(foot, ring(span, distance, radius, 2.0 * np.hypot(*foot.corners.T).max()))


@lru_cache(maxsize=512)
def clip_to_track(foot: Footprint, distance: float, radius: float, width: float) -> Footprint:
    """Return the part of a footprint that lies over a track.

    Parameters
    ----------
    foot : Footprint
    distance : float [m]
        From the wall to the foot of the centre of mass.
    radius : float [m]
        Of the wall.
    width : float [m]
        Of the track.

    Returns
    -------
    Footprint
        Where none of it does, its corner nearest to the wall, which supports nothing.
    """
    middle, edge = radius - distance, radius - width
    if edge <= 0.0 or not len(foot.corners):
        return foot
    away = np.hypot(foot.corners[:, 0], middle - foot.corners[:, 1])
    if away.min() >= edge:
        axis = shapely.Point(0.0, middle)
        lines = [*map(shapely.LinearRing, foot.rings), *map(shapely.LineString, foot.edges)]
        if min((line.distance(axis) for line in lines), default=np.inf) >= edge:
            return foot
    reach = np.hypot(*foot.corners.T).max()
    turn = np.linspace(-1.0, 1.0, 2001) * min(3.0 * reach / edge, 0.999 * np.pi)
    inner = np.array([[0.0, middle]])
    off = np.concatenate([np.column_stack([edge * np.sin(turn), middle - edge * np.cos(turn)]), inner])
    left = _cut_away(foot, shapely.Polygon(off))
    return left if len(left.corners) else Footprint(points=check.frozen(foot.corners[[np.argmax(away)]]))


def _cut_away(foot: Footprint, off: shapely.Geometry) -> Footprint:
    """Return the part of a footprint that lies outside an area."""
    area = shapely.union_all([shapely.Polygon()])
    for border in foot.rings:
        area = area.symmetric_difference(shapely.Polygon(border))
    lines = shapely.difference(shapely.linestrings(foot.edges), off) if len(foot.edges) else []
    pieces = (piece for line in lines for piece in shapely.get_parts(line) if not piece.is_empty)
    edges = np.array([np.array(piece.coords)[[0, -1]] for piece in pieces]).reshape(-1, 2, 2)
    points = foot.points[~shapely.contains_xy(off, foot.points)] if len(foot.points) else foot.points
    return Footprint(rings=rings(area.difference(off)), edges=edges, points=points)


def silhouette(posture: Posture, heading: float, distance: float, radius: float) -> tuple[Points, ...]:
    """Return the outline of a part seen along the track, swept past a radial gate.

    Parameters
    ----------
    posture : Posture
    heading : float [rad]
    distance : float [m]
        From the wall to the foot of the centre of mass.
    radius : float [m]
        Of the wall.

    Returns
    -------
    tuple of (K, 2) float [m]
        Rings of distance from the wall and height over the track, exact to ``SILHOUETTE_STEP_M``.
    """
    points, faces = posture.surface, posture.facets
    plan = turned(points[:, :2], heading)
    corners = np.column_stack([plan[:, 0], radius - distance - plan[:, 1], points[:, 2]])[faces]
    # triangles are halved along the track until none is longer than the curve allows
    short, longest = [], np.sqrt(8.0 * radius * SILHOUETTE_STEP_M)
    while len(corners):
        along = corners[..., 0]
        side = np.abs(np.roll(along, -1, axis=1) - along)
        k, small = side.argmax(axis=1), side.max(axis=1) <= longest
        short.append(corners[small])
        corners, k = corners[~small], k[~small]
        rows = np.arange(len(corners))
        a, b, c = corners[rows, k], corners[rows, (k + 1) % 3], corners[rows, (k + 2) % 3]
        middle = 0.5 * (a + b)
        corners = np.concatenate([np.stack([a, middle, c], axis=1), np.stack([middle, b, c], axis=1)])
    corners = np.concatenate(short)
    profile = np.stack([radius - np.hypot(corners[..., 0], corners[..., 1]), corners[..., 2]], axis=-1)
    a, b, c = profile[:, 0], profile[:, 1], profile[:, 2]
    twice = (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]
    whole = shapely.union_all(shapely.polygons(profile[twice > 1e-14]), grid_size=FOOT_GRID_M)
    size = np.ptp(points, axis=0).max()
    return rings(whole.simplify(FOOT_DETAIL_SHARE * size), SLIVER * size**2)


def visible_area(
    points: Points, faces: Triangles, sees: str, resolution: float = 0.0, line: float = 0.0
) -> shapely.Geometry:
    """Return the area that a sensor sees of a body: its front and, from above, its wall side at 0.

    Parameters
    ----------
    points : (V, 3) float [m]
        Its corners: along the wall, from it, over the track.
    faces : (F, 3) int
    sees : str
        'outline', 'side' or 'relief', as for ``sensor_views.difference``.
    resolution : float [m], optional
        Of the sensor: corners of what it sees are at multiples of it.
    line : float [m], optional
        Of a 'relief': over which line, off the wall.

    Returns
    -------
    shapely geometry [m]
    """
    if sees != "relief":
        projected = points[:, :2] if sees == "outline" else points[:, [0, 2]]
        projected = projected - [projected[:, 0].max(), projected[:, 1].min() if sees == "outline" else 0.0]
        detail = VIEW_DETAIL_SHARE * np.ptp(points, axis=0).max()
        whole = shaded.area(projected, faces)
        for width in (SLIT, 0.9 * SLIT, 1.1 * SLIT):  # closing slits loses nothing: with some widths it does
            closed = whole.buffer(width, join_style="mitre").buffer(-width, join_style="mitre")
            if closed.area >= (1.0 - SLIT_AREA_TOLERANCE) * whole.area:
                whole = closed
                break
        whole = whole.simplify(detail)
        coarse = shapely.set_precision(whole, resolution) if resolution > 0.0 else whole
        return whole if coarse.is_empty else coarse
    # below what a laser over a line along the wall sees: from its front, up
    facets = points[faces]
    off = facets[:, :, 1] - line
    crossing = (off.min(axis=1) < 0.0) & (off.max(axis=1) >= 0.0)
    facets, off = facets[crossing], off[crossing]
    nothing = shapely.box(-MIN_FEATURE_M, 0.0, 0.0, MIN_FEATURE_M)
    if not len(facets):
        return nothing
    row, k = np.nonzero((off < 0.0) != (np.roll(off, -1, axis=1) < 0.0))  # two sides of each cross the line
    first, last, before, beyond = (of[row, at] for of in (facets, off) for at in (k, (k + 1) % 3))
    ends = first + (last - first) * (before / (before - beyond))[:, None]
    ends = ends.reshape(-1, 2, 3)[:, :, [0, 2]]
    ends = ends - [ends[:, :, 0].max(), 0.0]
    ends = np.round(ends / resolution) * resolution if resolution > 0.0 else ends
    profile = shaded.below(np.stack([ends[:, :, 0], np.maximum(ends[:, :, 1], 0.0)], axis=2), SECTION_GRID_M)
    return nothing if profile.is_empty else profile  # the line may graze a corner
