"""Round sides that are round: the circles of a part's hull, which touch as circles."""

from typing import Any, NamedTuple

import numpy as np

from feederscrew import check
from feederscrew.geometry import vectors
from feederscrew.geometry.compiled import frozen_rows
from feederscrew.trial.kernel import workspace
from feederscrew.trial.shape import boxes, on_hull, singles_of, together

FINE_CORNERS_ANGLE = np.radians(
    6.0
)  # between two corners of a circle, for what it touches the borders of cuts with
COARSE_CORNERS_ANGLE = np.radians(
    45.0
)  # corners further apart belong to a polygon, as of a hexagon's head, ...
CLOSE_CORNERS_ANGLE = np.radians(10.0)  # ... and about an axis on which the part does not roll, these
MIN_CIRCLE_CORNERS = 9  # corners of a circle
MAX_BULGE = 0.01  # of the unit of length: a circle bulges so far at most where no surface joins its corners
SAME_CIRCLE_DISTANCE = 2e-3  # of the unit of length: corners that far apart may be of one circle
SAME_AXIS_COSINE = 1.0 - 1e-6  # [1] cosine between axes that are one


def rounded(solid, axes):
    """Return a part whose circles touch surfaces as circles, not with facets.

    Parameters
    ----------
    solid : TrueSolid
    axes : (N, 3) float [1]
        About which it rolls, in the axes of the solid; circles about its principal axes are looked for, too,
        of nearer corners.

    Returns
    -------
    TrueSolid
        With these circles, and with points between corners of them that are far apart. The chords between
        the corners stay as edges; they lie inside the circles.
    """
    straight = [
        principal
        for principal in np.eye(3)
        if not any(abs(vectors.dot(principal, axis)) > SAME_AXIS_COSINE for axis in axes)
    ]
    searches = [(axis, COARSE_CORNERS_ANGLE) for axis in axes] + [
        (axis, CLOSE_CORNERS_ANGLE) for axis in straight
    ]
    joined = joined_pairs(solid)
    circles_found = [ring for axis, gap in searches for ring in circles(solid.corners, axis, gap, joined)]
    circles_found = [ring for ring in circles_found if solid.outer[ring.corners].mean() > 0.5]
    if not circles_found:
        return solid
    solid = _with_points(solid, circles_found)
    on_circle = np.zeros(len(solid.corners), bool)
    for ring in circles_found:
        on_circle[ring.corners] = True
    on_circle[len(solid.corners) - sum(len(ring.points) for ring in circles_found) :] = True
    rings = [(*ring.centre, *ring.axis, ring.radius) for ring in circles_found]
    return solid._replace(
        circles=frozen_rows(rings, workspace.CIRCLE),
        on_circle=check.frozen(on_circle),
        **singles_of(solid.corners, on_circle),
    )


def _with_points(solid, rings):
    """A part with further corners, the points of its circles."""
    points = np.concatenate([ring.points for ring in rings])
    if not len(points):
        return solid
    ends = np.concatenate([ring.ends for ring in rings])
    count, more = len(solid.corners), len(points)
    far = np.array([np.argmax(vectors.length(solid.corners - point)) for point in points])
    own = np.column_stack([ends, far])
    vertices = np.concatenate([solid.corners, points, solid.vertices[count:]])
    grouped = together(vertices[: count + more])
    return solid._replace(
        vertices=check.frozen(vertices),
        corners=check.frozen(vertices[: count + more]),
        firsts=check.frozen(np.concatenate([solid.firsts, solid.firsts[-1] + 3 * (1 + np.arange(more))])),
        neighbours=check.frozen(np.concatenate([solid.neighbours, own.ravel()])),
        grouped=check.frozen(grouped),
        corner_blocks=check.frozen(boxes(vertices[grouped][:, None])),
        outer=check.frozen(on_hull(vertices[: count + more])),
        triangles=check.frozen(solid.triangles + more * (solid.triangles >= count)),
        radius=float(vectors.length(vertices).max()),
    )


class Circle(NamedTuple):
    """A circle through corners of a part; P points between them."""

    corners: np.ndarray  # int, which corners
    centre: np.ndarray  # (3,)
    axis: np.ndarray  # (3,) [1]
    radius: float
    points: np.ndarray  # (P, 3) between neighbouring corners that are further apart than FINE
    ends: np.ndarray  # (P, 2) int, those corners


def joined_pairs(solid) -> set[Any]:
    """Return which corners of a TrueSolid an edge of its surface joins, a set of (int, int)."""
    first = np.repeat(np.arange(len(solid.firsts) - 1), np.diff(solid.firsts))
    return set(zip(first.tolist(), solid.neighbours.tolist()))


def circles(corners, axis, gap=COARSE_CORNERS_ANGLE, joined=None):
    """Return the circles (a list of Circle) through corners, about an axis through the origin.

    Between the tips of teeth, or at the sides of a slot, nothing is round: where the surface does not join
    two neighbours a circle has no points, and what would bulge there by more than BRIDGED is no circle.

    Parameters
    ----------
    corners : (C, 3) float [L]
    axis : (3,) float [1]
    gap : float [rad]
        Neighbouring corners further apart are of a polygon.
    joined : set of (int, int), optional
        Corners that the surface joins, of ``joined_pairs``; all neighbours without it.
    """
    across = np.cross(axis, np.eye(3)[np.argmin(np.abs(axis))])
    across = vectors.unit(across)
    aside = np.cross(axis, across)
    along, x, y = (vectors.product(corners, direction) for direction in (axis, across, aside))
    away, turn = np.hypot(x, y), np.arctan2(y, x)
    rings = []
    for ring in (ring for ring in _rings(along, away) if len(ring) >= MIN_CIRCLE_CORNERS):
        ring = ring[np.argsort(turn[ring])]
        gaps = np.diff(turn[ring], append=turn[ring[0]] + 2.0 * np.pi)
        if gaps.max() > gap:
            continue
        centre, radius = along[ring].mean() * axis, away[ring].max()
        solid = np.ones(len(ring), bool)
        if joined is not None:
            solid = np.array([pair in joined for pair in zip(ring.tolist(), np.roll(ring, -1).tolist())])
        if radius * (1.0 - np.cos(0.5 * gaps[~solid].max(initial=0.0))) > MAX_BULGE:
            continue
        points, ends = [np.empty((0, 3))], [np.empty((0, 2), int)]
        for k, wide in enumerate(gaps):
            steps = int(np.ceil(wide / FINE_CORNERS_ANGLE)) if solid[k] else 1
            at = turn[ring[k]] + wide * np.arange(1, steps)[:, None] / steps
            points.append(centre + radius * (np.cos(at) * across + np.sin(at) * aside))
            ends.append(np.tile([ring[k], ring[(k + 1) % len(ring)]], (steps - 1, 1)))
        between = np.concatenate(points), np.concatenate(ends)
        rings.append(Circle(ring, centre, np.array(axis, float), float(radius), *between))
    return rings


def _rings(along, away):
    """Corners that lie at one place along an axis and at one distance from it, a ring each."""
    order = np.lexsort((away, np.round(along / SAME_CIRCLE_DISTANCE)))
    breaks = (np.abs(np.diff(along[order])) > SAME_CIRCLE_DISTANCE) | (
        np.abs(np.diff(away[order])) > SAME_CIRCLE_DISTANCE
    )
    return np.split(order, np.flatnonzero(breaks) + 1)
