"""Round sides that are round: points between the corners of the circles in which a part rolls."""

import numpy as np

from feederscrew import check
from feederscrew.geometry import vectors
from feederscrew.trial.shape import boxes, on_hull, together

FINE = np.radians(2.0)  # between two points of a circle that touches
COARSEST = np.radians(45.0)  # corners further apart belong to a polygon, as of a hexagon's head
LEAST = 9  # corners of a circle
ALIKE = 2e-3  # of the unit of length: corners that far apart may be of one circle


def rounded(solid, axes):
    """Return a part whose circles about some axes touch with points of their own, not with facets.

    Parameters
    ----------
    solid : TrueSolid
    axes : (N, 3) float [1]
        About which it rolls, in the axes of the solid.

    Returns
    -------
    TrueSolid
        The chords between the corners stay as edges; they lie inside the circles.
    """
    made = [between(solid.corners, axis) for axis in axes]
    points = np.concatenate([np.empty((0, 3)), *(found for found, _ in made)])
    if not len(points):
        return solid
    ends = np.concatenate([found for _, found in made])
    count, more = len(solid.corners), len(points)
    far = np.array([np.argmax(vectors.length(solid.corners - point)) for point in points])
    own = np.column_stack([ends, far])
    vertices = np.concatenate([solid.corners, points, solid.vertices[count:]])
    grouped = together(vertices[: count + more])
    return solid._replace(
        vertices=check.frozen(vertices),
        corners=check.frozen(vertices[: count + more]),
        firsts=check.frozen(np.concatenate([solid.firsts, solid.firsts[-1] + 3 * (1 + np.arange(more))])),
        beside=check.frozen(np.concatenate([solid.beside, own.ravel()])),
        grouped=check.frozen(grouped),
        corner_blocks=check.frozen(boxes(vertices[grouped][:, None])),
        outer=check.frozen(on_hull(vertices[: count + more])),
        triangles=check.frozen(solid.triangles + more * (solid.triangles >= count)),
        radius=float(vectors.length(vertices).max()),
    )


def between(corners, axis):
    """Return points on the circles of corners about an axis through the origin.

    Parameters
    ----------
    corners : (C, 3) float [L]
    axis : (3,) float [1]

    Returns
    -------
    points : (P, 3) float [L]
        Between neighbouring corners of a circle.
    ends : (P, 2) int
        Those corners.
    """
    across = np.cross(axis, np.eye(3)[np.argmin(np.abs(axis))])
    across = vectors.unit(across)
    aside = np.cross(axis, across)
    along, x, y = (vectors.product(corners, one) for one in (axis, across, aside))
    away, turn = np.hypot(x, y), np.arctan2(y, x)
    points, ends = [np.empty((0, 3))], [np.empty((0, 2), int)]
    for ring in _rings(along, away):
        ring = ring[np.argsort(turn[ring])]
        gaps = np.diff(turn[ring], append=turn[ring[0]] + 2.0 * np.pi)
        if len(ring) < LEAST or gaps.max() > COARSEST:
            continue
        for k, gap in enumerate(gaps):
            steps = int(np.ceil(gap / FINE))
            at = turn[ring[k]] + gap * np.arange(1, steps)[:, None] / steps
            circle = np.cos(at) * across + np.sin(at) * aside
            points.append(along[ring].mean() * axis + away[ring].max() * circle)
            ends.append(np.tile([ring[k], ring[(k + 1) % len(ring)]], (steps - 1, 1)))
    return np.concatenate(points), np.concatenate(ends)


def _rings(along, away):
    """Corners that lie at one place along an axis and at one distance from it, a ring each."""
    order = np.lexsort((away, np.round(along / ALIKE)))
    apart = (np.abs(np.diff(along[order])) > ALIKE) | (np.abs(np.diff(away[order])) > ALIKE)
    return np.split(order, np.flatnonzero(apart) + 1)
