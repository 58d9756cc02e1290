"""A part's true surface without dimensions, as the trial's kernel needs it.

Round sides that are round are circles of its hull, which touch as circles.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from scipy.spatial import ConvexHull

from feederscrew.arrivals.rounded_hull import principal_axes
from feederscrew.base import check
from feederscrew.base.arrays import Bools, Floats, Ints, Points
from feederscrew.base.errors import FeederError
from feederscrew.base.geometry import vectors
from feederscrew.base.geometry.compiled import frozen_rows
from feederscrew.part.hull import convex_hull
from feederscrew.part.record import Part, refuse_many_facets
from feederscrew.trials.kernel.plate_views import BLOCK, EDGE_EXTENSION
from feederscrew.trials.kernel.workspace import CIRCLE, TrueSolid

FLAT_ANGLE = 2e-3  # [rad] facets that meet at a smaller angle are one face
FINE_CORNERS_ANGLE = np.radians(6.0)  # between corners of a circle, for the borders of cuts that it touches
COARSE_CORNERS_ANGLE = np.radians(45.0)  # further apart they belong to a polygon, as of a hexagon's head, ...
CLOSE_CORNERS_ANGLE = np.radians(10.0)  # ... and about an axis on which the part does not roll, these
MIN_CIRCLE_CORNERS = 9
MAX_BULGE = 0.01  # of the unit of length: a circle bulges so far at most where no surface joins its corners
SAME_CIRCLE_DISTANCE = 2e-3  # of the unit of length: corners that far apart may be of one circle
SAME_AXIS_COSINE = 1.0 - 1e-6  # [1] cosine between axes that are one


def solid_of(part: Part) -> tuple[TrueSolid, float, Floats]:
    """Return a part's surface without dimensions, its unit of length and its principal axes.

    Parameters
    ----------
    part : Part

    Returns
    -------
    solid : TrueSolid
        About the centre of mass, along the principal axes.
    length : float [m]
        The unit of length: the cube root of the hull's volume.
    principal : (3, 3) float [1]
        Principal axes as columns, in the file's axes.

    Raises
    ------
    FeederError
        If the part has no surface, or one of more than ``MAX_FACETS`` facets.
    """
    if part.vertices is None or part.faces is None:
        raise FeederError(part.source, "has no surface, as a part card", "give the part as a mesh")
    refuse_many_facets(part)
    hull = convex_hull(part.vertices, part.centre_of_mass, part.source)
    length = float(np.cbrt(hull.volume))
    moments, principal = principal_axes(part.inertia)
    corners = vectors.product(part.vertices - part.centre_of_mass, principal) / length
    # Unit normals; zero of a facet without area.
    a, b, c = (corners[part.faces[:, k]] for k in range(3))
    normals = np.cross(b - a, c - a)
    size = vectors.length(normals)
    normals = normals / np.where(size > 0.0, size, 1.0)[:, None]
    ends, sides, hollow = _convex_edges(corners, part.faces, normals)
    order = order_in_blocks(corners[ends].mean(axis=1))
    ends, sides = ends[order], sides[order]
    # Corners in which convex edges end come first.
    touches = np.zeros(len(corners), bool)
    touches[ends] = True
    order = np.argsort(~touches, kind="stable")
    place = np.argsort(order, kind="stable")
    corners, edges, faces = check.frozen(corners[order]), place[ends], place[part.faces]
    order = order_in_blocks(corners[faces].mean(axis=1))
    triangles, normals = faces[order], normals[order]
    count = int(touches.sum())
    touching, none = corners[:count], np.zeros(count, bool)
    singles, single_blocks = _singles(touching, none)
    # Which of them are joined by an edge of a triangle.
    pairs = np.concatenate([triangles[:, [k, m]] for k in range(3) for m in range(3) if k != m])
    pairs = np.unique(pairs[(pairs < count).all(axis=1)], axis=0)
    # An edge goes on a little within the body where a hollow edge meets its end.
    along = vectors.length(corners[edges[:, 1]] - corners[edges[:, 0]])
    extensions = np.where(np.isin(ends, hollow), EDGE_EXTENSION / along[:, None], 0.0)
    block_order = order_in_blocks(touching)
    solid = TrueSolid(
        vertices=corners,
        corners=touching,
        edges=check.frozen(edges),
        sides=check.frozen(sides),
        extensions=check.frozen(extensions),
        firsts=check.frozen(np.searchsorted(pairs[:, 0], np.arange(count + 1))),
        neighbours=check.frozen(np.ascontiguousarray(pairs[:, 1])),
        triangles=check.frozen(triangles),
        normals=check.frozen(normals),
        outer=check.frozen(_on_hull(touching)),
        block_order=check.frozen(block_order),
        corner_blocks=check.frozen(_boxes(touching[block_order][:, None])),
        edge_blocks=check.frozen(_boxes(corners[edges])),
        face_blocks=check.frozen(_boxes(corners[triangles])),
        circles=frozen_rows([], CIRCLE),
        on_circle=check.frozen(none),
        singles=singles,
        single_blocks=single_blocks,
        inertia=check.frozen(moments / (part.mass * length**2)),
        radius=float(vectors.length(corners).max()),
    )
    return solid, length, principal


def _singles(corners: Points, on_circle: Bools) -> tuple[Ints, Floats]:
    """``singles`` and ``single_blocks`` of corners of which some are on circles, (C,) bool."""
    own = np.flatnonzero(_on_hull(corners) & ~on_circle)
    own = own[order_in_blocks(corners[own])] if len(own) else own
    return check.frozen(own), check.frozen(_boxes(corners[own][:, None]))


def _on_hull(corners: Points) -> Bools:
    """Return which corners (C, 3) are corners of their hull, (C,) bool."""
    return np.isin(np.arange(len(corners)), ConvexHull(corners).vertices)


def order_in_blocks(points: Points) -> Ints:
    """Return an order of points in which those of each block of ``BLOCK`` lie together.

    They are halved across where they lie furthest apart, by whole blocks, over and over.

    Parameters
    ----------
    points : (N, 3) float [L]

    Returns
    -------
    (N,) int
    """
    groups, waiting = [], [np.arange(len(points))]
    while waiting:
        own = waiting.pop()
        if len(own) <= BLOCK:
            groups.append(own)
            continue
        axis = int(np.argmax(np.ptp(points[own], axis=0)))
        own = own[np.argsort(points[own, axis], kind="stable")]
        half = BLOCK * ((len(own) // BLOCK + 1) // 2)
        waiting += [own[half:], own[:half]]
    return np.concatenate(groups)


def _boxes(features: Floats) -> Floats:
    """The box (B, 6) [L], least places and greatest, around each block of features (N, K, 3) [L]."""
    blocks = [features[k : k + BLOCK] for k in range(0, len(features), BLOCK)]
    return np.array([[*block.min(axis=(0, 1)), *block.max(axis=(0, 1))] for block in blocks]).reshape(-1, 6)


def _convex_edges(corners: Points, faces: Ints, normals: Floats) -> tuple[Ints, Floats, Ints]:
    """Ends (E, 2) and sides (E, 6) of the edges at which a surface turns outwards, as in TrueSolid.

    With them the corners (H,) of those at which it turns inwards. Faces are counter-clockwise from outside.
    """
    pairs = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    owners = np.tile(np.arange(len(faces)), 3)
    key = np.sort(pairs, axis=1)
    order = np.lexsort((key[:, 1], key[:, 0]))
    key, owners, pairs = key[order], owners[order], pairs[order]
    two = np.flatnonzero((key[1:] == key[:-1]).all(axis=1))
    ends, first, second = pairs[two], owners[two], owners[two + 1]
    along = corners[ends[:, 1]] - corners[ends[:, 0]]
    into_first = np.cross(normals[first], along)  # into the first face: it runs the edge as given
    into_second = -np.cross(normals[second], along)
    size = vectors.length(along)[:, None]
    into_first, into_second = into_first / size, into_second / size
    bend = np.arctan2(-vectors.dot(into_second, normals[first]), vectors.dot(normals[first], normals[second]))
    keep = bend > FLAT_ANGLE
    return ends[keep], np.hstack([into_first, into_second])[keep], np.unique(ends[bend < -FLAT_ANGLE])


def round_circles(solid: TrueSolid, axes: Sequence[Floats]) -> TrueSolid:
    """Return a part whose circles touch surfaces as circles, not with facets.

    It has points between corners of circles that are far apart; the chords between the corners stay as edges:
    they lie inside the circles.

    Parameters
    ----------
    solid : TrueSolid
    axes : sequence of (3,) float [1]
        Those about which it rolls, in its own. Circles about its principal axes are looked for, too, of
        nearer corners.

    Returns
    -------
    TrueSolid
        The one given, where it has no circles.
    """
    searches = [(axis, COARSE_CORNERS_ANGLE) for axis in axes]
    for principal in np.eye(3):
        if not any(abs(vectors.dot(principal, axis)) > SAME_AXIS_COSINE for axis in axes):
            searches.append((principal, CLOSE_CORNERS_ANGLE))
    first = np.repeat(np.arange(len(solid.firsts) - 1), np.diff(solid.firsts))
    joins = set(zip(first.tolist(), solid.neighbours.tolist()))
    rings = [ring for axis, gap in searches for ring in find_circles(solid.corners, axis, gap, joins)]
    rings = [ring for ring in rings if solid.outer[ring.corners].mean() > 0.5]
    if not rings:
        return solid
    count, points = len(solid.corners), np.concatenate([ring.points for ring in rings])
    more = len(points)
    if more:
        # Further corners, the points of the circles.
        ends = np.concatenate([ring.ends for ring in rings])
        far = np.array([np.argmax(vectors.length(solid.corners - point)) for point in points])
        own = np.column_stack([ends, far])
        vertices = np.concatenate([solid.corners, points, solid.vertices[count:]])
        corners = vertices[: count + more]
        block_order = order_in_blocks(corners)
        firsts = np.concatenate([solid.firsts, solid.firsts[-1] + 3 * (1 + np.arange(more))])
        solid = solid._replace(
            vertices=check.frozen(vertices),
            corners=check.frozen(corners),
            firsts=check.frozen(firsts),
            neighbours=check.frozen(np.concatenate([solid.neighbours, own.ravel()])),
            block_order=check.frozen(block_order),
            corner_blocks=check.frozen(_boxes(vertices[block_order][:, None])),
            outer=check.frozen(_on_hull(corners)),
            triangles=check.frozen(solid.triangles + more * (solid.triangles >= count)),
            radius=float(vectors.length(vertices).max()),
        )
    on_circle = np.zeros(len(solid.corners), bool)
    on_circle[count:] = True
    for ring in rings:
        on_circle[ring.corners] = True
    records = [(*ring.centre, *ring.axis, ring.radius) for ring in rings]
    singles, single_blocks = _singles(solid.corners, on_circle)
    return solid._replace(
        circles=frozen_rows(records, CIRCLE),
        on_circle=check.frozen(on_circle),
        singles=singles,
        single_blocks=single_blocks,
    )


class Circle(NamedTuple):
    """A circle through corners of a part; P points between them."""

    corners: Ints  # which corners
    centre: Floats  # (3,)
    axis: Floats  # (3,) [1]
    radius: float
    points: Floats  # (P, 3) between neighbouring corners that are further apart than FINE_CORNERS_ANGLE
    ends: Ints  # (P, 2) those corners


def find_circles(
    corners: Points,
    axis: Floats,
    gap: float = COARSE_CORNERS_ANGLE,
    joins: set[tuple[int, int]] | None = None,
) -> list[Circle]:
    """Return the circles through corners about an axis through the origin.

    Between the tips of teeth, or at the sides of a slot, nothing is round: where no edge of the surface joins
    two neighbours, a circle has no points, and what would bulge there by more than MAX_BULGE is no circle.

    Parameters
    ----------
    corners : (C, 3) float [L]
    axis : (3,) float [1]
    gap : float [rad], optional
        Neighbouring corners further apart are of a polygon.
    joins : set of (int, int), optional
        Pairs of corners that an edge joins; without it all count as joined.

    Returns
    -------
    list of Circle
    """
    across = vectors.unit(np.cross(axis, np.eye(3)[np.argmin(np.abs(axis))]))
    aside = np.cross(axis, across)
    along, x, y = (vectors.product(corners, direction) for direction in (axis, across, aside))
    away, turn = np.hypot(x, y), np.arctan2(y, x)
    # Corners that lie at one place along the axis and at one distance from it, a ring each.
    order = np.lexsort((away, np.round(along / SAME_CIRCLE_DISTANCE)))
    apart = np.maximum(np.abs(np.diff(along[order])), np.abs(np.diff(away[order])))
    rings = []
    for ring in np.split(order, np.flatnonzero(apart > SAME_CIRCLE_DISTANCE) + 1):
        if len(ring) < MIN_CIRCLE_CORNERS:
            continue
        ring = ring[np.argsort(turn[ring])]
        gaps = np.diff(turn[ring], append=turn[ring[0]] + 2.0 * np.pi)
        if gaps.max() > gap:
            continue
        centre, radius = along[ring].mean() * axis, away[ring].max()
        solid = np.ones(len(ring), bool)
        if joins is not None:
            solid = np.array([pair in joins for pair in zip(ring.tolist(), np.roll(ring, -1).tolist())])
        if radius * (1.0 - np.cos(0.5 * gaps[~solid].max(initial=0.0))) > MAX_BULGE:
            continue
        points, ends = [np.empty((0, 3))], [np.empty((0, 2), int)]
        for k, wide in enumerate(gaps):
            # at least one: a changed mesh may have two corners at one place, no angle apart
            steps = max(int(np.ceil(wide / FINE_CORNERS_ANGLE)), 1) if solid[k] else 1
            at = turn[ring[k]] + wide * np.arange(1, steps)[:, None] / steps
            points.append(centre + radius * (np.cos(at) * across + np.sin(at) * aside))
            ends.append(np.tile([ring[k], ring[(k + 1) % len(ring)]], (steps - 1, 1)))
        between = np.concatenate(points), np.concatenate(ends)
        rings.append(Circle(ring, centre, np.array(axis, float), float(radius), *between))
    return rings
