"""Whether a part that a hole does not carry goes down through it: its shadow, in the ways it can tip."""

import functools

import numpy as np
import shapely

from feederscrew.geometry.polygons import outline

AZIMUTHS, TILTS = 8, 10  # ways it can tip: about level axes all round, by steps up to a right angle
CLEAR = 2.5e-4  # [m] a hole is larger than the shadow that goes through it, all round
BEYOND = 0.1  # [m] a hole that is open at the track's free edge goes on so far
SQUARE = 1e-9  # of its own box: what less a hole covers, it is still a rectangle
PLAIN = 2e-4  # of the part's size: corners of a shadow that stand out by less are left out


def falls_through(one, cut):
    """Return whether a hole lets an orientation through that it does not carry.

    Parameters
    ----------
    one : Orientation
    cut : (K, 2) float [m]
        Unrolled: lengths along the wall and distances from it.

    Returns
    -------
    bool
        Whether the shadow of the part, tipped some way by up to a right angle, lies in the hole with
        ``CLEAR`` around it. Where it is tipped by less than that way, it is still on its way down over the
        edge that it leaves. What goes over the track's free edge is gone.
    """
    hole = shapely.make_valid(_open(np.asarray(cut, float), one.track.width)).buffer(
        -CLEAR, join_style="mitre"
    )
    if hole.is_empty:
        return False
    return any(_fits(shadow, hole) for shadow in _shadows(one))


def _open(cut, width):
    """The hole as a polygon, beyond the track's free edge where it reaches it."""
    free = cut[:, 1] >= width - 1e-9
    return shapely.Polygon(np.column_stack([cut[:, 0], np.where(free, cut[:, 1] + BEYOND, cut[:, 1])]))


@functools.lru_cache(maxsize=512)
def _shadows(one):
    """Convex outlines (K, 2) [m] from above, as it lies and as it tips."""
    return list(_tipped(one))


def _tipped(one):
    points = one.posture.corners
    size = np.ptp(points, axis=0).max()
    c, s = np.cos(one.heading), np.sin(one.heading)
    x, y, z = c * points[:, 0] - s * points[:, 1], s * points[:, 0] + c * points[:, 1], points[:, 2]
    for tilt in np.linspace(0.0, 0.5 * np.pi, TILTS):
        for azimuth in np.linspace(0.0, 2.0 * np.pi, AZIMUTHS, endpoint=False)[: None if tilt > 0.0 else 1]:
            a, b = np.cos(azimuth), np.sin(azimuth)
            along = (a * x + b * y) * np.cos(tilt) + z * np.sin(tilt)
            beside = -b * x + a * y
            ring = outline(np.column_stack([a * along - b * beside, b * along + a * beside]))
            yield shapely.get_coordinates(shapely.Polygon(ring).simplify(PLAIN * size))[:-1]


def _fits(shadow, hole):
    """Whether a convex shadow can be moved to lie within a hole: what is left of it beside its own border."""
    low, high = shadow.min(axis=0), shadow.max(axis=0)
    extent = np.subtract(hole.bounds[2:], hole.bounds[:2])
    if (high - low > extent).any():
        return False
    if hole.area > (1.0 - SQUARE) * extent.prod():  # it is a rectangle
        return True
    shadow = shadow - shadow.mean(axis=0)
    for part in shapely.get_parts(hole):
        rings = [part.exterior, *part.interiors]
        sides = np.concatenate(
            [np.stack([r[:-1], r[1:]], axis=1) for r in map(shapely.get_coordinates, rings)]
        )
        swept = np.concatenate([sides[:, :1] - shadow, sides[:, 1:] - shadow], axis=1)
        border = shapely.union_all(shapely.convex_hull(shapely.multipoints(swept)))
        if not part.difference(border).is_empty:
            return True
    return False
