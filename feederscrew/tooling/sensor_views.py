"""What a sensor sees of an orientation, and by how much two differ."""

import functools

import numpy as np
import shapely

from feederscrew.geometry.polygons import turned

FINE = 1e-4  # [m] between places of a border at which two are compared
PLAIN = 1e-4  # of the part's size: corners that stand out by less are left out
KEPT = 1e-6  # of an area, that closing its slits may lose by rounding
SLIT = 2e-5  # [m] half the width of slits between facets that are closed


def difference(one, other, sees):
    """Return by how much [m] two orientations differ for a sensor.

    Parameters
    ----------
    one, other : Orientation
    sees : str
        'outline' from above, 'side' from the bowl's axis, or 'height'.

    Returns
    -------
    float [m]
        Greatest distance from a place of either to the other one, both with their front at the same place
        and, seen from above, as near to the wall.
    """
    if sees == "height":
        return abs(one.height - other.height)
    return 0.0 if one is other else apart(outline(one, sees), outline(other, sees))


def apart(first, second):
    """Return the greatest distance [m] from a place of either area's border to the other's."""
    return max(_reach(first, second), _reach(second, first))


def _reach(area, other):
    """Greatest distance [m] of the places of an area's border from another area's, and of holes alike."""
    places = shapely.get_coordinates(shapely.segmentize(area.boundary, 10.0 * FINE))
    return float(shapely.distance(shapely.points(places), other.boundary).max())


@functools.lru_cache(maxsize=512)
def outline(one, sees):
    """Return the area that a sensor sees of an orientation [m]: ahead from its front, and from its side.

    Parameters
    ----------
    one : Orientation
    sees : str
        'outline' from above, or 'side' from the bowl's axis.
    """
    points, faces = one.posture.surface, one.posture.solid.faces
    plan = turned(points[:, :2], one.heading)
    return area(np.column_stack([plan, points[:, 2]]), faces, sees)


def area(points, faces, sees, resolution=0.0):
    """Return the area that a sensor sees of a body.

    Parameters
    ----------
    points : (V, 3) float [m]
        Its corners: along the wall, from it, over the track.
    faces : (F, 3) int
    sees : str
        As for ``outline``.
    resolution : float [m]
        Of the sensor: corners are seen at multiples of it.

    Returns
    -------
    shapely geometry
        Its front and, from above, the side nearest to the wall at 0.
    """
    seen = points[:, :2] if sees == "outline" else points[:, [0, 2]]
    seen = seen - [seen[:, 0].max(), seen[:, 1].min() if sees == "outline" else 0.0]
    corners = (np.round(seen / resolution) * resolution if resolution > 0.0 else seen)[faces]
    a, b, c = corners.transpose(1, 0, 2)
    twice = (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]
    whole = shapely.union_all(shapely.polygons(corners[twice > 1e-14]))  # one side of it covers all
    return _without_slits(whole).simplify(PLAIN * np.ptp(points, axis=0).max())


def _without_slits(whole):
    """An area without its slits: closing it loses nothing, so a width at which it does is not taken.

    With some lengths of tiny borders the second offset comes out empty.
    """
    for width in (SLIT, 0.9 * SLIT, 1.1 * SLIT):
        closed = whole.buffer(width, join_style="mitre").buffer(-width, join_style="mitre")
        if closed.area >= (1.0 - KEPT) * whole.area:
            return closed
    return whole
