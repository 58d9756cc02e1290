"""What of a part touches the track, facets, edges and points of its mesh, and the verdicts of its foot.

The verdicts of feet over holes are compiled: ``kernel``.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
import shapely

from feederscrew import check
from feederscrew.geometry import polygons
from feederscrew.geometry.compiled import zero_rows
from feederscrew.geometry.polygons import turned
from feederscrew.heavy import heavy
from feederscrew.resting.posture import TOUCHING_SHARE
from feederscrew.tooling.devices.openings import WALL_OVERCUT_M, gap

crossing = heavy("feederscrew.tooling.kernel.crossing")
passage = heavy("feederscrew.tooling.kernel.passage")
ring_kernel = heavy("feederscrew.tooling.kernel.ring")
unheld_kernel = heavy("feederscrew.tooling.kernel.unheld")

SPOT = 1e-7  # [m] half the length of a single point of contact
SECTOR_TOLERANCE = 1e-9  # [1] of an angle or a distance: what is beyond by more is so for certain


@dataclass(frozen=True, eq=False)
class Footprint:
    """What of a part touches the track, in track axes from the foot of the centre of mass."""

    rings: tuple[np.ndarray, ...]  # (K, 2) [m] borders of areas, holes of them as rings of their own
    edges: np.ndarray  # (E, 2, 2) [m] lines of contact
    points: np.ndarray  # (P, 2) [m] points of contact

    @cached_property
    def corners(self) -> np.ndarray:
        """(V, 2) [m] every corner of it."""
        return np.concatenate([*self.rings, self.edges.reshape(-1, 2), self.points])


def standing(foot, distance, radius, shift=0.0):
    """Return a foot about the bowl's axis.

    Parameters
    ----------
    foot : Footprint
    distance : float [m]
        From the wall to the foot of the centre of mass.
    radius : float [m]
        Of the wall.
    shift : float [m]
        By which the weight meets the track nearer to the wall, on a banked track.

    Returns
    -------
    passage.Foot
    """

    foot, middle = _spots(foot), radius - distance
    starts = [*foot.rings, foot.edges[:, 0]]
    ends = [*(np.roll(ring, -1, axis=0) for ring in foot.rings), foot.edges[:, 1]]
    start, end = np.concatenate(starts), np.concatenate(ends)
    closed = np.arange(len(start)) < sum(len(ring) for ring in foot.rings)
    has_length = np.hypot(*(end - start).T) > 1e-12
    start, end, closed = start[has_length], end[has_length], closed[has_length]
    along = (end - start) * [1.0, -1.0]
    corners = np.column_stack([foot.corners[:, 0], middle - foot.corners[:, 1]])
    hull, insets = _hull(corners[:, 0], middle + shift - corners[:, 1])
    return passage.Foot(
        hull=hull,
        insets=insets,
        sides=np.column_stack([start[:, 0], middle - start[:, 1], along]),
        closed=closed.astype(np.int64),
        corners=corners,
        polar=np.column_stack([np.arctan2(*corners.T), np.hypot(*corners.T)]),
        centre=middle + shift,
        reach=float(np.hypot(corners[:, 0], corners[:, 1] - middle - shift).max()),
        all_corners=np.arange(len(corners)),
        sector=_sector(start[closed], end[closed], middle),
    )


def _spots(foot):
    """A foot whose single points are short lines along the track: an edge that comes is noticed there."""
    if not len(foot.points):
        return foot
    lines = foot.points[:, None] + np.array([[-SPOT, 0.0], [SPOT, 0.0]])
    edges = np.concatenate([foot.edges.reshape(-1, 2, 2), lines])
    return Footprint(rings=foot.rings, edges=edges, points=np.empty((0, 2)))


def _sector(start, end, middle) -> np.ndarray:
    """Angles and distances about the axis (4,) [rad, m] between which areas of such sides lie."""
    start, end = ([1.0, -1.0] * (ends - [0.0, middle]) for ends in (start, end))
    if len(start) == 0 or not start[:, 1].min() > 0.0:
        return np.array([-np.inf, np.inf, 0.0, np.inf])
    along = end - start
    share = np.clip(-(start * along).sum(axis=1) / (along * along).sum(axis=1), 0.0, 1.0)
    nearest = np.hypot(*(start + share[:, None] * along).T).min()
    theta, far = np.arctan2(*start.T), np.hypot(*start.T).max()
    least, most = theta.min() - SECTOR_TOLERANCE, theta.max() + SECTOR_TOLERANCE
    return np.array([least, most, nearest * (1.0 - SECTOR_TOLERANCE), far * (1.0 + SECTOR_TOLERANCE)])


def scratch(foot, hole):
    """Return arrays for the verdict of feet and holes no larger than these."""

    rows = 6 * len(foot.sides) * len(hole.edges) + 1
    points = len(foot.corners) + rows + len(hole.nodes) + len(hole.edges)
    return passage.VerdictArrays(
        rows=zero_rows(rows, crossing.STRETCH),
        events=np.empty(2 * rows),
        bounds=np.empty(2 * rows),
        movements=np.empty(2 * rows),
        cuts=np.empty(crossing.CUTS),
        keep=np.empty(len(foot.corners), dtype=np.int64),
        held=np.empty(len(hole.nodes), dtype=np.int64),
        active=np.empty(rows, dtype=np.int64),
        points=np.empty((points, 2)),
        moved_points=np.empty((points, 2)),
    )


def least(foot, hole, work=None, low=-np.inf, high=np.inf) -> tuple[Any, ...]:
    """Return the least margin [m] of a foot over a hole's passage, and the shift [rad] where it is.

    A margin below ``low`` may be given as any that is below it, one above ``high`` as any above.

    Source: docs/tooling.md, "1. The method".
    """

    out = np.empty(2)
    passage.least(foot, hole, work or scratch(foot, hole), low, high, out)
    return float(out[0]), float(out[1])


def unheld(foot, hole, work=None, enough=np.inf):
    """Return the longest way [m] over which a hole leaves a foot without support.

    One longer than ``enough`` may be given as any that is longer.

    Source: own; docs/tooling.md, "1. The method".
    """

    turn = enough * (1.0 + SECTOR_TOLERANCE) / foot.centre
    return float(unheld_kernel.longest(foot, hole, work or scratch(foot, hole), turn)) * foot.centre


def _hull(x, y) -> tuple[Any, ...]:
    """Corners of the convex hull about the origin, counter-clockwise, and the insets of its sides."""
    points = np.column_stack([x, y])
    order = polygons.convex(points)
    if len(order) < 3:
        return np.empty(0, dtype=np.int64), np.empty(0)
    start = points[order]
    along = np.roll(start, -1, axis=0) - start
    return order, (start[:, 0] * along[:, 1] - start[:, 1] * along[:, 0]) / np.hypot(*along.T)


def over_ring(foot, low, high) -> float:
    """Return the margin [m] of a foot on a track without what lies between two radii [m] about the axis.

    Source: docs/tooling.md, "1. The method".
    """

    return float(ring_kernel.over_ring(foot, low, high, ring_scratch(foot)))


def balcony(foot, radius) -> float:
    """Return the least width of track [m] that carries a foot; infinite where none does.

    Source: docs/tooling.md, "1. The method".
    """

    return float(ring_kernel.balcony(foot, radius, _extent(foot, radius), ring_scratch(foot)))


def canyon(foot, radius):
    """Return the greatest width [m] of a strip removed along the wall that a foot passes; 0 for none."""

    return max(float(ring_kernel.canyon(foot, radius, _extent(foot, radius), ring_scratch(foot))), 0.0)


def longest_gap(foot, radius):
    """Return the greatest gap [m] across the track that a foot passes; 0 for none."""
    low, high = 0.0, 2.0 * foot.reach
    width = _extent(foot, radius)
    work = scratch(foot, gap(high, radius, width))

    def passes(length):
        return least(foot, gap(length, radius, width), work, low=0.0, high=0.0)[0] >= 0.0

    if not passes(1e-9):
        return 0.0
    while high - low > 1e-12:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if passes(middle) else (low, middle)
    return low


def _extent(foot, radius):
    """How far from the wall a foot reaches [m], and a little more."""
    return min(float(radius - foot.polar[:, 1].min() + WALL_OVERCUT_M), radius)


def ring_scratch(foot):
    """Return arrays for the verdict of a foot on a ring."""
    return scratch(foot, RingSize(edges=np.empty((1, 7)), nodes=np.empty((0, 3))))


class RingSize(NamedTuple):
    """The sizes of a hole that a ring needs."""

    edges: np.ndarray
    nodes: np.ndarray


ROLLING_FOOT_SHARE = (
    0.03  # of the centre of mass's height: how much of a rolling part's underside counts as its foot
)
SLIVER = 1e-6  # of the part's size squared: smaller areas and holes of them are leftovers of rounding
SLOT_CHORD_M = 2e-7  # [m] by which the edge of a slot may be seen too flat
FOOT_DETAIL_SHARE = 1e-4  # of the part's size: corners that stand out by less are left out
SILHOUETTE_STEP_M = 3e-5  # [m] to which a silhouette is exact on a curved track
FOOT_GRID_M = 1e-8  # [m] of its corners


def find_footprint(posture, heading) -> Footprint:
    """Return what touches the track.

    Source: own; docs/tooling.md, "1. The method".

    Parameters
    ----------
    posture : Posture
        Of a part with a mesh.
    heading : float [rad]

    Returns
    -------
    Footprint
        In track axes from the foot of the centre of mass. A part that rolls touches with the strip of its
        underside that a hole's edge would carry, up to ``ROLLING_FOOT_SHARE`` of its height, however finely
        its round side is cut into facets. Where none of the mesh is low enough to carry it, the contact
        polygon does.
    """
    rolls = posture.kind == "rolling"
    if not rolls and not posture.on_floor.any():
        return _of_polygon(turned(posture.contact, heading))
    points, faces = posture.surface, posture.solid.faces
    size = np.ptp(posture.outline, axis=0).max()
    depth = ROLLING_FOOT_SHARE * posture.height if rolls else TOUCHING_SHARE * size
    plan = turned(points[:, :2], heading)
    area = area_below(plan, points[:, 2], faces, depth, rolls)
    area = area.simplify(FOOT_DETAIL_SHARE * size) if not area.is_empty else area
    edges, single = _bare(plan, points[:, 2] < depth, faces, area, TOUCHING_SHARE * size)
    if area.is_empty and len(edges) + len(single) < 1:
        return _of_polygon(turned(posture.contact, heading))
    borders = rings(area, SLIVER * size**2)
    return Footprint(rings=borders, edges=check.frozen(edges), points=check.frozen(single))


def _of_polygon(corners) -> Footprint:
    """The foot of a part that stands on the whole of a polygon (K, 2) [m]."""
    return Footprint(rings=(check.frozen(corners),), edges=np.empty((0, 2, 2)), points=np.empty((0, 2)))


def area_below(plan, height, faces, depth, cut):
    """Return the union of the facets lower than a depth [m], with ``cut`` also of their parts below it.

    Parameters
    ----------
    plan : (V, 2) float [m]
    height : (V,) float [m]
    faces : (F, 3) int
    depth : float [m]
    cut : bool

    Returns
    -------
    shapely geometry
    """
    low = height[faces] < depth
    whole = plan[faces[low.all(axis=1)]]
    polygons = [shapely.polygons(whole)] if len(whole) else []
    if cut:
        some = faces[low.any(axis=1) & ~low.all(axis=1)]
        polygons.append(np.array([_below(plan[f], height[f], depth) for f in some], dtype=object))
    pieces = np.concatenate(polygons) if polygons else np.array([])
    pieces = pieces[shapely.area(pieces) > 0.0] if len(pieces) else pieces
    return shapely.union_all(shapely.make_valid(pieces), grid_size=1e-9) if len(pieces) else shapely.Polygon()


def _below(corners, height, depth):
    """The part of a triangle that is lower than a depth."""
    out = []
    for k in range(3):
        a, b, za, zb = corners[k], corners[(k + 1) % 3], height[k], height[(k + 1) % 3]
        if za < depth:
            out.append(a)
        if (za < depth) != (zb < depth):
            out.append(a + (depth - za) / (zb - za) * (b - a))
    return shapely.Polygon(out)


def _bare(plan, low, faces, area, near) -> tuple[Any, ...]:
    """Edges and points of the mesh on the track that no area covers."""
    around = area.buffer(near) if not area.is_empty else area
    ends = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    ends = np.unique(np.sort(ends[low[ends].all(axis=1)], axis=1), axis=0)
    edges = plan[ends].reshape(-1, 2, 2)
    edges = edges[np.hypot(*(edges[:, 1] - edges[:, 0]).T) > near]
    edges = edges[~_covered(edges.mean(axis=1), around)]
    points = np.unique(plan[low], axis=0)
    points = points[~_covered(points, around)]
    lines = shapely.union_all(shapely.linestrings(edges)).buffer(near) if len(edges) else shapely.Polygon()
    return edges, points[~_covered(points, lines)]


def _covered(points, area):
    return shapely.contains_xy(area, points) if not area.is_empty else np.zeros(len(points), dtype=bool)


def rings(area, least=0.0) -> tuple[Any, ...]:
    """Return the borders of an area, those of its holes too, as corners (K, 2) without the one repeated.

    Parameters
    ----------
    area : shapely geometry
    least : float [m2]
        Areas and holes that are not larger are left out.

    Returns
    -------
    tuple of (K, 2) float [m]
    """
    polygons = [
        piece for piece in shapely.get_parts(area) if piece.geom_type == "Polygon" and piece.area > least
    ]
    lines = [ring for polygon in polygons for ring in (polygon.exterior, *polygon.interiors)]
    lines = [ring for ring in lines if shapely.Polygon(ring).area > least]
    return tuple(check.frozen(np.array(ring.coords)[:-1]) for ring in lines)


def ring(span, distance, radius, reach):
    """Return the area between two distances from the wall, about the foot of the centre of mass.

    Parameters
    ----------
    span : (float, float) [m]
        From the wall.
    distance, radius : float [m]
        From the wall to the foot, and of the wall.
    reach : float [m]
        How far it goes on ahead and behind.

    Returns
    -------
    shapely Polygon
    """
    most = min(reach / max(radius - span[1], 0.1 * radius), 0.999 * np.pi)
    count = 2 + int(2.0 * most * np.sqrt(radius / (8.0 * SLOT_CHORD_M)))
    turn = np.linspace(-most, most, count)
    sides = [radius - span[0] + WALL_OVERCUT_M * (span[0] <= 0.0), max(radius - span[1], 0.0)]
    middle = radius - distance
    sides = [np.column_stack([r * np.sin(turn), middle - r * np.cos(turn)]) for r in sides]
    return shapely.Polygon(np.vstack([sides[0], sides[1][::-1]]))


def outside_slot(foot, span, distance, radius):
    """Return what of a footprint rests beside a slot between two distances from the wall.

    Source: own; docs/tooling.md, "1. The method".

    Parameters
    ----------
    foot : Footprint
    span : (float, float) [m]
    distance, radius : float [m]
        From the wall to the foot of the centre of mass, and of the wall.

    Returns
    -------
    Footprint
    """
    if not len(foot.corners):
        return foot
    return _without(foot, ring(span, distance, radius, 2.0 * np.hypot(*foot.corners.T).max()))


def within(foot, distance, radius, width):
    """Return what of a footprint lies over a track of some width.

    Source: own; docs/tooling.md, "1. The method".

    Parameters
    ----------
    foot : Footprint
    distance : float [m]
        From the wall to the foot of the centre of mass.
    radius, width : float [m]
        Of the wall and of the track.

    Returns
    -------
    Footprint
        Where none of it does, its corner nearest to the wall, which supports nothing.
    """
    middle = radius - distance
    edge = radius - width
    if edge <= 0.0 or not len(foot.corners):
        return foot
    away = np.hypot(foot.corners[:, 0], middle - foot.corners[:, 1])
    if away.min() >= edge and _nearest_side(foot, middle) >= edge:
        return foot
    reach = np.hypot(*foot.corners.T).max()
    turn = np.linspace(-1.0, 1.0, 2001) * min(3.0 * reach / edge, 0.999 * np.pi)
    inner = np.array([[0.0, middle]])
    off = np.concatenate([np.column_stack([edge * np.sin(turn), middle - edge * np.cos(turn)]), inner])
    left = _without(foot, shapely.Polygon(off))
    if len(left.corners):
        return left
    nearest = foot.corners[[np.argmax(away)]]
    return Footprint(rings=(), edges=np.empty((0, 2, 2)), points=check.frozen(nearest))


def _without(foot, off) -> Footprint:
    """What of a footprint lies outside an area."""
    area = shapely.union_all([shapely.Polygon()])
    for border in foot.rings:
        area = area.symmetric_difference(shapely.Polygon(border))
    lines = shapely.difference(shapely.linestrings(foot.edges), off) if len(foot.edges) else []
    pieces = [
        np.array(piece.coords) for line in lines for piece in shapely.get_parts(line) if not piece.is_empty
    ]
    edges = np.array([[piece[0], piece[-1]] for piece in pieces]).reshape(-1, 2, 2)
    points = foot.points[~shapely.contains_xy(off, foot.points)] if len(foot.points) else foot.points
    return Footprint(rings=rings(area.difference(off)), edges=edges, points=points)


def _nearest_side(foot, middle):
    axis = shapely.Point(0.0, middle)
    rings = [shapely.LinearRing(ring).distance(axis) for ring in foot.rings]
    lines = [shapely.LineString(edge).distance(axis) for edge in foot.edges]
    return min([*rings, *lines], default=np.inf)


def silhouette(posture, heading, distance, radius) -> tuple[Any, ...]:
    """Return the outline of a part seen along the track.

    Parameters
    ----------
    posture : Posture
        Of a part with a mesh.
    heading : float [rad]
    distance : float [m]
        From the wall to the foot of the centre of mass.
    radius : float [m]
        Of the wall.

    Returns
    -------
    tuple of (K, 2) float [m]
        Rings of distance from the wall and height over the track, swept past a radial gate.
    """
    points, faces = posture.surface, posture.solid.faces
    plan = turned(points[:, :2], heading)
    corners = np.column_stack([plan[:, 0], radius - distance - plan[:, 1], points[:, 2]])[faces]
    corners = _short(corners, np.sqrt(8.0 * radius * SILHOUETTE_STEP_M))
    profile = np.stack([radius - np.hypot(corners[..., 0], corners[..., 1]), corners[..., 2]], axis=-1)
    a, b, c = profile[:, 0], profile[:, 1], profile[:, 2]
    twice = (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]
    whole = shapely.union_all(shapely.polygons(profile[twice > 1e-14]), grid_size=FOOT_GRID_M)
    size = np.ptp(points, axis=0).max()
    return rings(whole.simplify(FOOT_DETAIL_SHARE * size), SLIVER * size**2)


def _short(corners, longest) -> np.ndarray:
    """Triangles halved along the track until none is longer than the curve allows."""
    done = []
    while len(corners):
        along = corners[..., 0]
        side = np.abs(np.roll(along, -1, axis=1) - along)
        k = side.argmax(axis=1)
        small = side.max(axis=1) <= longest
        done.append(corners[small])
        corners, k = corners[~small], k[~small]
        rows = np.arange(len(corners))
        a, b, c = corners[rows, k], corners[rows, (k + 1) % 3], corners[rows, (k + 2) % 3]
        middle = 0.5 * (a + b)
        corners = np.concatenate([np.stack([a, middle, c], axis=1), np.stack([middle, b, c], axis=1)])
    return np.concatenate(done)
