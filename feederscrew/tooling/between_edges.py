"""Whether a part that a hole does not carry may come to rest in it: between two edges, or by the wall.

Looked at in the plane across the two edges, the part tilts until it lies on both. It may rest there, if
forces within the cones of friction at both of them hold its weight.
"""

import itertools

import numpy as np
import shapely

from feederscrew.geometry.polygons import cross, outline, sides, turned

REST_TILTS = 60  # steps of a tilt up to a right angle, to either side
CONVEX_FILL_SHARE = 0.99  # of its convex outline: a part that fills less may catch an edge by its own corners
FORCE_SHARE_TOLERANCE = 1e-12  # of a share of a force


def may_rest(section, width, friction, wall=False):
    """Return whether a part may come to rest between two edges, tilted some way.

    Source: Coulomb's cones at two edges; docs/trial.md, "What other parts said of the rules".

    Parameters
    ----------
    section : shapely geometry
        What is seen of it along the edges, its centre of mass at (0, any height) [m]; see ``centred``.
    width : float [m]
        Between the edges.
    friction : float [1]
        At both edges: none of those along which the part slides, since the track shakes.
    wall : bool
        Whether a wall stands in place of the first edge, on which the part leans at any height.

    Returns
    -------
    bool
        True also of one that is not convex as it is seen: it may catch an edge by a corner of its own.

    Notes
    -----
    Two edges: the part hangs by the chord of its outline that is as long as the hole is wide. With a wall,
    what is foremost leans on it. With friction the force at each edge lies within the cone about the side of
    the part that it meets; without, the part settles where its centre of mass is lowest. Statics alone: the
    shaking of the drive and what speed is left only loosen it.
    """
    hull = section.convex_hull
    if section.area < CONVEX_FILL_SHARE * hull.area:
        return True
    ring = outline(shapely.get_coordinates(hull))
    tilts = np.linspace(-0.5 * np.pi, 0.5 * np.pi, 2 * REST_TILTS + 1)
    met = [(_leans if wall else _bridges)(turned(ring, turn), width) for turn in tilts]
    if friction > 0.0:
        return any(two is not None and _holds(two, friction) for two in met)
    heights = np.array([np.inf if two is None else -two[1][0][1] for two in met])
    return _settles(np.where(np.isinf(heights), -np.inf, heights), 1e-9 * np.ptp(ring, axis=0).max())


def _settles(heights, same):
    """Whether the height of a centre of mass has a lowest place among tilts at which the part is held."""
    around = np.concatenate([[np.inf], heights, [np.inf]])
    lowest = (heights <= around[:-2] + same) & (heights <= around[2:] + same)
    return bool((lowest & np.isfinite(heights)).any())


def _leans(ring, width):
    """Where a convex outline touches a wall and an edge at some distance from it, as ``_bridges``."""
    place = ring[:, 0].min() + width
    if ring[:, 0].max() <= place:
        return None
    foremost = ring[int(np.argmin(ring[:, 0]))]
    along = sides(ring)
    under = np.flatnonzero((along[:, 0] > 0.0) & (ring[:, 0] <= place) & (place < ring[:, 0] + along[:, 0]))
    k = int(under[0])
    on = ring[k] + along[k] * (place - ring[k, 0]) / along[k, 0]
    normal = np.array([-along[k, 1], along[k, 0]]) / np.hypot(*along[k])
    return (foremost, np.array([1.0, 0.0])), (on, normal)


def _bridges(ring, width):
    """Where a convex outline lies on two edges: (point, normal into the part) of both; None: it goes through.

    Its lower level chord is as long as the edges are apart.
    """
    levels = np.unique(ring[:, 1])
    spans = _spans(ring, levels)
    wide = np.flatnonzero(spans >= width)
    if not len(wide):
        return None
    level, k = levels[0], int(wide[0])
    if k > 0:
        share = (width - spans[k - 1]) / (spans[k] - spans[k - 1])
        level = levels[k - 1] + share * (levels[k] - levels[k - 1])
    places, normals = _at(ring, level)
    return tuple((np.array([places[end], level]), normals[end]) for end in (places.argmin(), places.argmax()))


def _spans(ring, levels):
    """Return how long (L,) the chords of a convex outline at some levels (L,) are: as ``_at`` has them."""
    along, start = sides(ring), ring[:, 1]
    low, high = np.minimum(start, start + along[:, 1]), np.maximum(start, start + along[:, 1])
    met = (low <= levels[:, None]) & (levels[:, None] <= high)
    rise = np.where(along[:, 1] == 0.0, 1.0, along[:, 1])
    share = np.clip((levels[:, None] - start) / rise, 0.0, 1.0)
    places = ring[:, 0] + share * along[:, 0]
    return np.where(met, places, -np.inf).max(axis=1) - np.where(met, places, np.inf).min(axis=1)


def _at(ring, level):
    """Where the sides of a convex outline meet a level, and their normals into it."""
    along, start = sides(ring), ring[:, 1]
    low, high = np.minimum(start, start + along[:, 1]), np.maximum(start, start + along[:, 1])
    met = (low <= level) & (level <= high)
    rise = np.where(along[met, 1] == 0.0, 1.0, along[met, 1])
    share = np.clip((level - start[met]) / rise, 0.0, 1.0)
    normals = np.column_stack([-along[met, 1], along[met, 0]]) / np.hypot(*along[met].T)[:, None]
    return ring[met, 0] + share * along[met, 0], normals


def _holds(two, friction):
    """Whether forces within cones of friction at two places hold a weight at (0, any height)."""
    wrenches = []
    for point, normal in two:
        for side in (-1.0, 1.0):
            push = turned(normal, side * np.arctan(friction))
            wrenches.append([*push, cross(point, push)])
    rows, weight = np.array(wrenches), np.array([0.0, 1.0, 0.0])
    size = np.abs(rows[:, 2]).max()
    rows[:, 2] /= size if size > 0.0 else 1.0
    for three in itertools.combinations(rows, 3):
        basis = np.array(three)
        if abs(_det(basis)) < FORCE_SHARE_TOLERANCE:
            continue
        if (_shares(basis, weight) >= -FORCE_SHARE_TOLERANCE).all():
            return True
    return False


def _det(basis):
    a, b, c = basis
    return (
        a[0] * (b[1] * c[2] - b[2] * c[1])
        - a[1] * (b[0] * c[2] - b[2] * c[0])
        + a[2] * (b[0] * c[1] - b[1] * c[0])
    )


def _shares(basis, weight):
    """How much of each of three wrenches makes a weight: Cramer's rule."""
    whole = _det(basis)
    return np.array([_det(np.where(np.arange(3)[:, None] == k, weight, basis)) / whole for k in range(3)])
