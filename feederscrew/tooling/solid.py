"""The stretch of track as a solid: plate, wall and gates without the cuts; the one door to manifold3d."""

import itertools
from typing import Any

import numpy as np
import shapely
from shapely import affinity

from feederscrew import check
from feederscrew.heavy import heavy
from feederscrew.tooling import whole_surface
from feederscrew.tooling.devices.openings import beyond_borders
from feederscrew.tooling.track_sections import DRAWN_CHORD_M, bend_ring
from feederscrew.units import MM

manifold3d = heavy("manifold3d")

PLATE, WALL = 3e-3, 3e-3  # [m] thickness of track and wall
WALL_MARGIN_M = 5e-3  # [m] of the wall above the tallest part
WALL_OVERLAP_M = 1e-3  # [m] by which wall and gates reach into plate and wall, so that they are one body
SEAM_WIDTH_M = 2e-5  # [m] of the plate left along the wall


def solid(section) -> tuple[Any, ...]:
    """Return the closed surface of a TrackSection with its cuts, as it lies in the bowl.

    Vertices (V, 3) [m] and faces (F, 3) int, corners counter-clockwise seen from outside, in one order
    however they were made. The wall is tangent to X at the origin, the bowl's axis is at (0, radius), the
    track's surface lies in the plane Z = 0, parts move towards +X.
    """
    corners = triangles(section)
    vertices, places = np.unique(corners.reshape(-1, 3), axis=0, return_inverse=True)
    return check.frozen(vertices), check.frozen(places.reshape(-1, 3))


def triangles(section) -> np.ndarray:
    """Return the triangles (F, 3, 3) [m] of the section, counter-clockwise seen from outside."""
    radius, width = section.track.radius, section.width
    cut = [station.hole for station in section.stations if station.hole is not None]
    holes = [_bent(cleared(hole, width), radius) for hole in cut]
    levels = stretch_levels(section)
    low, high, bodies = -WALL_OVERLAP_M + levels[-1][2], section.tallest + WALL_MARGIN_M, []
    for begin, end, lean in section.walls:  # upright, or leaning back where it is the other face of a groove
        start, stop = wall_ends(section, begin, end)
        if lean:
            bodies.append(_leaning(radius, start, stop, lean, high))
        else:
            ring = [[start, WALL_OVERLAP_M - WALL], [stop, WALL_OVERLAP_M - WALL], [stop, 0.0], [start, 0.0]]
            bodies.append(extruded(_bent(ring, radius), low, high))
    body = sum(bodies[1:], bodies[0])
    holes = shapely.union_all(holes)
    for start, end, level in levels:
        plate = _bent([[start, -WALL], [end, -WALL], [end, width], [start, width]], radius)
        body += extruded(plate.difference(holes), level - PLATE, level)
    for (_, end, upper), (_, _, lower) in itertools.pairwise(levels):
        riser = _bent([[end - WALL, -WALL], [end, -WALL], [end, width], [end - WALL, width]], radius)
        body += extruded(riser, lower - PLATE, upper - 0.5 * PLATE)
    for station in section.stations:
        if station.blade is None:
            continue
        # the blade of a gate: a plate [mm] (off the wall, height, thickness) without its opening
        area, thick, lean = gate_area(section, station)
        c, s = np.cos(station.blade[0, 0] / radius), np.sin(station.blade[0, 0] / radius)
        ahead, inwards = np.array([c, s, 0.0]), np.array([-s, c, 0.0])
        place = np.array([radius / MM * s, radius / MM - radius / MM * c, 0.0])
        across = np.column_stack([inwards + lean * ahead, [0.0, 0.0, 1.0], ahead, place])
        gate = extruded(area, 0.0, thick).transform(across)
        body += gate.translate((0.0, 0.0, level_at(levels, station) / MM))
    points, faces = whole_surface.mesh(body)
    # each from its first corner on, in the order of the corners
    corners = points[faces]
    first = np.array([min(range(3), key=lambda k: tuple(corner[k])) for corner in corners])
    turned = corners[np.arange(len(corners))[:, None], (first[:, None] + np.arange(3)) % 3]
    return turned[np.lexsort(turned.reshape(len(turned), 9).T[::-1])]


def wall_ends(section, begin, end) -> tuple[float, float]:
    """Return from where to where [m] the wall of a stretch is drawn: into the next one, not to the ends."""
    return max(begin, WALL_OVERLAP_M), min(end + WALL_OVERLAP_M, section.length - WALL_OVERLAP_M)


def leaning_wall(radius, start, stop, lean, high) -> tuple[Any, ...]:
    """Return the vertices and faces of a wall that leans back [rad] between two places [m].

    Source: own; docs/tooling.md, "A groove".
    """
    return _surface(_leaning(radius, start, stop, lean, high))


def leaning_profile(radius, lean, high) -> np.ndarray:
    """Return the section (4, 2) [m] of a wall that leans back [rad]: distance from the axis, height."""
    up, out = np.array([np.sin(lean), np.cos(lean)]), np.array([np.cos(lean), -np.sin(lean)])
    low, top = -WALL_OVERLAP_M * up, high * up
    return np.array([low, low + WALL * out, top + WALL * out, top]) + [radius, 0.0]


def _leaning(radius, start, stop, lean, high) -> Any:
    """A body [mm]: a wall from the track's outer edge on, as wide as ``high`` [m] up its slope."""
    across = leaning_profile(radius, lean, high)
    round_once = int(np.ceil(np.pi / np.sqrt(2.0 * DRAWN_CHORD_M / radius)))
    turned, first = np.degrees((stop - start) / radius), np.degrees(start / radius) - 90.0
    body = manifold3d.Manifold.revolve(manifold3d.CrossSection([across / MM]), round_once, turned)
    return body.rotate((0.0, 0.0, first)).translate((0.0, radius / MM, 0.0))


def prism(area, low, high) -> tuple[Any, ...]:
    """Return the closed surface of a body over an area [m], shapely, between two heights [m].

    Vertices (V, 3) [m] and faces (F, 3) int, corners counter-clockwise seen from outside.
    """
    return _surface(extruded(area, low, high))


def _surface(body) -> tuple[np.ndarray, np.ndarray]:
    mesh = body.to_mesh64()
    return np.asarray(mesh.vert_properties)[:, :3] * MM, np.asarray(mesh.tri_verts).astype(int)


def stretch_levels(section) -> list[Any]:
    """Return the stretches of the track between steps: from, to (a little into the next one), height [m]."""
    levels, start, level = [], 0.0, 0.0
    for station in section.stations:
        if station.drop > 0.0:
            middle = station.start + 0.5 * station.length
            levels.append((start, middle, level))
            start, level = middle - WALL_OVERLAP_M, level - station.drop
    return [*levels, (start, section.length, level)]


def level_at(levels, station) -> float:
    """Return the height [m] of the track where a gate stands."""
    place = station.blade[0, 0]
    return next(level for start, end, level in levels if place <= end)


def cleared(ring, width, seam=SEAM_WIDTH_M) -> np.ndarray:
    """Return a hole (K, 2) [m] a seam off the wall and on over the track's other edge.

    Source: own; no two faces of bodies that are cut may coincide.
    """
    clear = np.column_stack([ring[:, 0], np.maximum(ring[:, 1], seam)])
    return np.array(beyond_borders(clear.tolist(), width, WALL_OVERLAP_M))


def _bent(ring, radius) -> Any:
    return shapely.make_valid(shapely.Polygon(bend_ring(np.asarray(ring), radius)))


def extruded(area, low, high) -> Any:
    """Return a body [mm] over a shapely area [m] of the plane between two heights [m]."""
    polygons = [part for part in shapely.get_parts(area) if part.geom_type == "Polygon"]
    rings = [ring for part in polygons for ring in (part.exterior, *part.interiors)]
    corners = [np.asarray(ring.coords)[:-1] / MM for ring in rings]
    flat = manifold3d.CrossSection(corners, manifold3d.FillRule.EvenOdd)
    return manifold3d.Manifold.extrude(flat, (high - low) / MM).translate((0.0, 0.0, low / MM))


def gate_area(section, station) -> tuple[Any, float, float]:
    """Return the blade of a gate without its opening: from the wall and up [m], thickness [m], lean [1]."""
    free = shapely.union_all([shapely.Polygon(ring) for ring in station.openings])
    free = shapely.union_all(
        [affinity.translate(free, *by) for by in ((0, 0), (-2 * WALL_OVERLAP_M, 0), (0, -2 * WALL_OVERLAP_M))]
    )
    frame = shapely.box(-WALL_OVERLAP_M, -WALL_OVERLAP_M, section.width - WALL_OVERLAP_M, station.top)
    lean = (station.blade[3, 0] - station.blade[0, 0]) / section.width
    return frame.difference(free), station.blade[1, 0] - station.blade[0, 0], lean
