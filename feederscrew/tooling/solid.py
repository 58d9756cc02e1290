"""The stretch of track as a solid: plate, wall and gates without the cuts; the one door to manifold3d."""

import itertools
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import shapely
from shapely import affinity

from feederscrew import check
from feederscrew.arrays import Floats, Points, Triangles
from feederscrew.heavy import heavy
from feederscrew.tooling import whole_surface
from feederscrew.tooling.devices.openings import beyond_borders
from feederscrew.tooling.track_sections import DRAWN_CHORD_M, TrackSection, bend_ring
from feederscrew.units import MM

if TYPE_CHECKING:
    from manifold3d import Manifold

manifold3d = heavy("manifold3d")

PLATE, WALL = 3e-3, 3e-3  # [m] thickness of track and wall
WALL_MARGIN_M = 5e-3  # [m] of the wall above the tallest part
WALL_OVERLAP_M = 1e-3  # [m] by which wall and gates reach into plate and wall, so that they are one body
SEAM_WIDTH_M = 2e-5  # [m] of the plate left along the wall


def solid(section: TrackSection) -> tuple[Points, Triangles]:
    """Return the closed surface of a TrackSection with its cuts, as it lies in the bowl.

    Vertices (V, 3) [m] and faces (F, 3) int, corners counter-clockwise seen from outside, in one order
    however they were made. The wall is tangent to X at the origin, the bowl's axis is at (0, radius), the
    track's surface lies in the plane Z = 0, parts move towards +X.
    """
    corners = triangles(section)
    vertices, places = np.unique(corners.reshape(-1, 3), axis=0, return_inverse=True)
    return check.frozen(vertices), check.frozen(places.reshape(-1, 3))


def triangles(section: TrackSection) -> Floats:
    """Return the triangles (F, 3, 3) [m] of the section, counter-clockwise seen from outside."""
    radius, pieces = section.track.radius, section_pieces(section, SEAM_WIDTH_M)
    low, high = pieces.wall_heights
    bodies = [
        _revolve_leaning(radius, start, stop, lean, high) if lean else extrude(_bend(ring, radius), low, high)
        for start, stop, lean, ring in pieces.walls
    ]
    body = sum(bodies[1:], bodies[0])
    holes = shapely.union_all([_bend(hole, radius) for hole in pieces.holes])
    for ring, bottom, top in pieces.plates:
        body += extrude(_bend(ring, radius).difference(holes), bottom, top)
    for ring, bottom, top in pieces.risers:
        body += extrude(_bend(ring, radius), bottom, top)
    for place, level, area, thick, lean in pieces.gates:
        angle, far = place / radius, radius / MM
        ahead = np.array([np.cos(angle), np.sin(angle), 0.0])
        inwards = np.array([-np.sin(angle), np.cos(angle), 0.0])
        foot = [far * np.sin(angle), far - far * np.cos(angle), 0.0]
        across = np.column_stack([inwards + lean * ahead, [0.0, 0.0, 1.0], ahead, foot])
        body += extrude(area, 0.0, thick).transform(across).translate((0.0, 0.0, level / MM))
    points, faces = whole_surface.mesh(body)
    # each from its first corner on, in the order of the corners
    corners = points[faces]
    first = np.array([min(range(3), key=lambda k: tuple(corner[k])) for corner in corners])
    turned = corners[np.arange(len(corners))[:, None], (first[:, None] + np.arange(3)) % 3]
    return turned[np.lexsort(turned.reshape(len(turned), 9).T[::-1])]


@dataclass(frozen=True, eq=False)
class SectionPieces:
    """What a section of track is united of; rings (K, 2) [m] lie along the wall and off it."""

    wall_heights: tuple[float, float]  # [m] of an upright wall
    walls: list[tuple[float, float, float, Points]]  # from, to [m], lean back [rad], upright: its ring
    plates: list[tuple[Points, float, float]]  # ring, two heights [m]: the holes are cut out of them
    risers: list[tuple[Points, float, float]]
    holes: list[Points]
    # place, level, area, thickness [m], lean [1]
    gates: list[tuple[float, float, shapely.Geometry, float, float]]


def section_pieces(section: TrackSection, seam: float) -> SectionPieces:
    """Return the pieces of a TrackSection, its holes a ``seam`` [m] off the wall.

    Source: own; no two faces of bodies that are cut may coincide.
    """

    def ring(start: float, end: float, inside: float, outside: float) -> Points:
        return np.array([[start, inside], [end, inside], [end, outside], [start, outside]])

    width, overlap = section.width, WALL_OVERLAP_M
    levels, start, level = [], 0.0, 0.0  # between steps of the track: from, to a little into the next, height
    for station in section.stations:
        if station.drop > 0.0:
            middle = station.start + 0.5 * station.length
            levels.append((start, middle, level))
            start, level = middle - overlap, level - station.drop
    levels.append((start, section.length, level))
    walls = []
    for begin, end, lean in section.walls:  # each goes on into the next one, and not to the ends
        start, stop = max(begin, overlap), min(end + overlap, section.length - overlap)
        walls.append((start, stop, lean, ring(start, stop, overlap - WALL, 0.0)))
    holes, gates = [], []
    for station in section.stations:
        if station.hole is not None:
            # cut on through the end of the section, where it is open there
            places = station.hole[:, 0] + overlap * (station.hole[:, 0] >= section.length - 1e-9)
            clear = np.column_stack([places, np.maximum(station.hole[:, 1], seam)])
            holes.append(np.array(beyond_borders(clear.tolist(), width, overlap)))
        if station.blade is not None:  # from the wall and up, without its opening
            free = shapely.union_all([shapely.Polygon(opening) for opening in station.openings])
            paths = ((0, 0), (-2 * overlap, 0), (0, -2 * overlap))
            free = shapely.union_all([affinity.translate(free, *by) for by in paths])
            frame = shapely.box(-overlap, -overlap, width - overlap, station.top)
            place, ahead, far = station.blade[[0, 1, 3], 0]
            level = next(level for _, end, level in levels if place <= end)
            gates.append((place, level, frame.difference(free), ahead - place, (far - place) / width))
    return SectionPieces(
        wall_heights=(-overlap + levels[-1][2], section.tallest + WALL_MARGIN_M),
        walls=walls,
        plates=[(ring(start, end, -WALL, width), level - PLATE, level) for start, end, level in levels],
        risers=[
            (ring(end - WALL, end, -WALL, width), lower - PLATE, upper - 0.5 * PLATE)
            for (_, end, upper), (_, _, lower) in itertools.pairwise(levels)
        ],
        holes=holes,
        gates=gates,
    )


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


def _bend(ring: Points, radius: float) -> shapely.Geometry:
    return shapely.make_valid(shapely.Polygon(bend_ring(np.asarray(ring), radius)))


def extrude(area: shapely.Geometry, low: float, high: float) -> "Manifold":
    """Return a body [mm] over a shapely area [m] of the plane between two heights [m]."""
    polygons = [part for part in shapely.get_parts(area) if part.geom_type == "Polygon"]
    rings = [ring for part in polygons for ring in (part.exterior, *part.interiors)]
    corners = [np.asarray(ring.coords)[:-1] / MM for ring in rings]
    flat = manifold3d.CrossSection(corners, manifold3d.FillRule.EvenOdd)
    return manifold3d.Manifold.extrude(flat, (high - low) / MM).translate((0.0, 0.0, low / MM))
