"""Plates and leaning walls as bodies; the one door of this stage to manifold3d."""

from typing import TYPE_CHECKING

import numpy as np
import shapely

from feederscrew.base.arrays import Points, Triangles
from feederscrew.base.heavy import heavy
from feederscrew.base.units import MM
from feederscrew.sorting.tooled_track import DRAWN_SAGITTA_M

if TYPE_CHECKING:
    from manifold3d import Manifold

manifold3d = heavy("manifold3d")

PLATE, WALL = 3e-3, 3e-3  # [m] thickness of track and wall
WALL_OVERLAP_M = 1e-3  # [m] by which wall and gates reach into plate and wall, so that they are one body


def leaning_wall(
    radius: float, start: float, stop: float, lean: float, high: float
) -> tuple[Points, Triangles]:
    """Return the surface of a wall that leans back, between two places along it.

    Parameters
    ----------
    radius : float [m]
        Of the wall, at its foot.
    start, stop : float [m]
    lean : float [rad]
        Back from upright.
    high : float [m]

    Returns
    -------
    vertices : (V, 3) float [m]
    faces : (F, 3) int

    References
    ----------
    docs/tooling.md, "A groove".
    """
    return _surface(_revolve_leaning(radius, start, stop, lean, high))


def leaning_profile(radius: float, lean: float, high: float) -> Points:
    """Return the section of a wall that leans back.

    Parameters
    ----------
    radius : float [m]
        Of the wall, at its foot.
    lean : float [rad]
        Back from upright.
    high : float [m]
        Along the wall.

    Returns
    -------
    (4, 2) float [m]
        Distance from the axis, and height.
    """
    up, out = np.array([np.sin(lean), np.cos(lean)]), np.array([np.cos(lean), -np.sin(lean)])
    low, top = -WALL_OVERLAP_M * up, high * up
    return np.array([low, low + WALL * out, top + WALL * out, top]) + [radius, 0.0]


def _revolve_leaning(radius: float, start: float, stop: float, lean: float, high: float) -> "Manifold":
    """A body [mm]: a wall from the track's outer edge on, as wide as ``high`` [m] up its slope."""
    across = leaning_profile(radius, lean, high)
    round_once = int(np.ceil(np.pi / np.sqrt(2.0 * DRAWN_SAGITTA_M / radius)))
    turned, first = np.degrees((stop - start) / radius), np.degrees(start / radius) - 90.0
    body = manifold3d.Manifold.revolve(manifold3d.CrossSection([across / MM]), round_once, turned)
    return body.rotate((0.0, 0.0, first)).translate((0.0, radius / MM, 0.0))


def prism(area: shapely.Geometry, low: float, high: float) -> tuple[Points, Triangles]:
    """Return the closed surface of a body over an area, between two heights.

    Parameters
    ----------
    area : shapely geometry [m]
    low, high : float [m]

    Returns
    -------
    vertices : (V, 3) float [m]
    faces : (F, 3) int
        Corners counter-clockwise seen from outside.
    """
    return _surface(extrude(area, low, high))


def _surface(body: "Manifold") -> tuple[Points, Triangles]:
    mesh = body.to_mesh64()
    return np.asarray(mesh.vert_properties)[:, :3] * MM, np.asarray(mesh.tri_verts).astype(int)


def extrude(area: shapely.Geometry, low: float, high: float) -> "Manifold":
    """Return a body over an area of the plane, between two heights.

    Parameters
    ----------
    area : shapely geometry [m]
    low, high : float [m]

    Returns
    -------
    manifold3d.Manifold [mm]
    """
    polygons = [part for part in shapely.get_parts(area) if part.geom_type == "Polygon"]
    rings = [ring for part in polygons for ring in (part.exterior, *part.interiors)]
    corners = [np.asarray(ring.coords)[:-1] / MM for ring in rings]
    flat = manifold3d.CrossSection(corners, manifold3d.FillRule.EvenOdd)
    return manifold3d.Manifold.extrude(flat, (high - low) / MM).translate((0.0, 0.0, low / MM))
