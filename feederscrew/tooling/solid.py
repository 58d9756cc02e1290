"""Plates and leaning walls as bodies; the one door of this stage to manifold3d."""

from typing import TYPE_CHECKING

import numpy as np
import shapely

from feederscrew.arrays import Points, Triangles
from feederscrew.heavy import heavy
from feederscrew.tooling.tooled_track import DRAWN_CHORD_M
from feederscrew.units import MM

if TYPE_CHECKING:
    from manifold3d import Manifold

manifold3d = heavy("manifold3d")

PLATE, WALL = 3e-3, 3e-3  # [m] thickness of track and wall
WALL_OVERLAP_M = 1e-3  # [m] by which wall and gates reach into plate and wall, so that they are one body


def leaning_wall(
    radius: float, start: float, stop: float, lean: float, high: float
) -> tuple[Points, Triangles]:
    """Return the vertices and faces of a wall that leans back [rad] between two places [m].

    Source: own; docs/tooling.md, "A groove".
    """
    return _surface(_revolve_leaning(radius, start, stop, lean, high))


def leaning_profile(radius: float, lean: float, high: float) -> Points:
    """Return the section (4, 2) [m] of a wall that leans back [rad]: distance from the axis, height."""
    up, out = np.array([np.sin(lean), np.cos(lean)]), np.array([np.cos(lean), -np.sin(lean)])
    low, top = -WALL_OVERLAP_M * up, high * up
    return np.array([low, low + WALL * out, top + WALL * out, top]) + [radius, 0.0]


def _revolve_leaning(radius: float, start: float, stop: float, lean: float, high: float) -> "Manifold":
    """A body [mm]: a wall from the track's outer edge on, as wide as ``high`` [m] up its slope."""
    across = leaning_profile(radius, lean, high)
    round_once = int(np.ceil(np.pi / np.sqrt(2.0 * DRAWN_CHORD_M / radius)))
    turned, first = np.degrees((stop - start) / radius), np.degrees(start / radius) - 90.0
    body = manifold3d.Manifold.revolve(manifold3d.CrossSection([across / MM]), round_once, turned)
    return body.rotate((0.0, 0.0, first)).translate((0.0, radius / MM, 0.0))


def prism(area: shapely.Geometry, low: float, high: float) -> tuple[Points, Triangles]:
    """Return the closed surface of a body over an area [m], shapely, between two heights [m].

    Vertices (V, 3) [m] and faces (F, 3) int, corners counter-clockwise seen from outside.
    """
    return _surface(extrude(area, low, high))


def _surface(body: "Manifold") -> tuple[Points, Triangles]:
    mesh = body.to_mesh64()
    return np.asarray(mesh.vert_properties)[:, :3] * MM, np.asarray(mesh.tri_verts).astype(int)


def extrude(area: shapely.Geometry, low: float, high: float) -> "Manifold":
    """Return a body [mm] over a shapely area [m] of the plane between two heights [m]."""
    polygons = [part for part in shapely.get_parts(area) if part.geom_type == "Polygon"]
    rings = [ring for part in polygons for ring in (part.exterior, *part.interiors)]
    corners = [np.asarray(ring.coords)[:-1] / MM for ring in rings]
    flat = manifold3d.CrossSection(corners, manifold3d.FillRule.EvenOdd)
    return manifold3d.Manifold.extrude(flat, (high - low) / MM).translate((0.0, 0.0, low / MM))
