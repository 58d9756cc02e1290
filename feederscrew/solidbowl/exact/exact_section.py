"""The section of track of ``feeder tooling`` with exact faces: cylinders, cones, planes and ruled splines."""

import itertools
from typing import Any

import numpy as np
import shapely
from numpy.typing import ArrayLike, NDArray

from feederscrew.errors import FeederError
from feederscrew.solidbowl.exact import exact_body, exact_file
from feederscrew.solidbowl.plan import TrackPath
from feederscrew.tooling import solid
from feederscrew.tooling.devices.openings import beyond_borders
from feederscrew.tooling.track_sections import TrackSection
from feederscrew.units import MM

SECTION_VOLUME_TOLERANCE = 2e-3  # [1] of the volume of the facets, whose chords lie within the arcs
BESIDE_WALL_M = 1e-10  # [m] a cut begins so far from the wall: not at its face, which it would go through
CUT_MARGIN_M = 1e-3  # [m] by which a cut goes on above and below the track


def section_file(section: TrackSection) -> bytes:
    """Return the section of track with its cuts as the bytes of a STEP file in millimetres.

    Parameters
    ----------
    section : TrackSection

    Returns
    -------
    bytes
        One solid in the axes of ``tooling.solid.solid``: the wall is tangent to X at the origin.

    Raises
    ------
    MissingPackage
        If OpenCASCADE is not installed.
    FeederError
        If what it makes is not the section of the facets.
    """
    exact_body.check()
    vertices, faces = solid.solid(section)
    a, b, c = np.moveaxis(vertices[faces] / MM, 1, 0)
    facets = float(np.einsum("fk,fk->f", a, np.cross(b, c)).sum()) / 6.0
    size = np.nan
    for near in exact_body.FUZZY_TOLERANCES_MM:
        with exact_body.meeting(near):
            body = exact_body.one_piece(section_body(section), "tooling.step")
        size = exact_body.volume(body)
        if exact_body.valid(body) and abs(size / facets - 1.0) <= SECTION_VOLUME_TOLERANCE:
            return exact_file.step_bytes([body], "track section")
    what = f"OpenCASCADE makes a section of {size:.6g} mm3, not {facets:.6g}"
    raise FeederError("tooling.step", what, "take tooling.stl")


def section_body(section: TrackSection) -> Any:
    """Return the section as a body of OpenCASCADE [mm]; for its axes see ``section_file``."""
    radius, width = section.track.radius, section.width
    path = TrackPath(radius, 0.0, 0.0, 2.0 * section.length)
    levels = solid.stretch_levels(section)
    holes = [_clear(station.hole, width) for station in section.stations if station.hole is not None]

    def over(start: float, end: float, low: float, high: float) -> Any:
        ring = np.array([[start, -solid.WALL], [end, -solid.WALL], [end, width], [start, width]])
        return exact_body.over(path, ring, low, high, 0.0)

    plates = [over(start, end, level - solid.PLATE, level) for start, end, level in levels]
    for (_, end, upper), (_, _, lower) in itertools.pairwise(levels):
        plates.append(over(end - solid.WALL, end, lower - solid.PLATE, upper - 0.5 * solid.PLATE))
    low, high = levels[-1][2] - solid.PLATE - CUT_MARGIN_M, levels[0][2] + CUT_MARGIN_M
    tools = [exact_body.over(path, hole, low, high, 0.0) for hole in holes]
    plate = exact_body.without(exact_body.united(plates), tools)
    walls = [_wall(path, section, levels[-1][2], *stretch) for stretch in section.walls]
    bladed = [station for station in section.stations if station.blade is not None]
    gates = [_gate(section, station, path, levels) for station in bladed]
    body = exact_body.united([*walls, plate, *gates])
    body = exact_body.placed_as(body, mirrored=False, turned=path.end / radius - 0.5 * np.pi)
    return exact_body.moved(body, (0.0, radius / MM, 0.0))


def _clear(hole: NDArray[np.float64], width: float) -> NDArray[np.float64]:
    """A hole up to the wall, and on over the track's other edge."""
    corners = np.column_stack([hole[:, 0], np.maximum(hole[:, 1], BESIDE_WALL_M)])
    return np.array(beyond_borders(corners.tolist(), width, solid.WALL_OVERLAP_M))


def _wall(path: TrackPath, section: TrackSection, level: float, begin: float, end: float, lean: float) -> Any:
    """A stretch of the wall: upright a cylinder, leaning back [rad] a cone."""
    start, stop = solid.wall_ends(section, begin, end)
    high = section.tallest + solid.WALL_MARGIN_M
    if lean:
        across = solid.leaning_profile(path.radius, lean, high)
        return exact_body.turned_part(across, float(path.angle(start)), (stop - start) / path.radius)
    inside = solid.WALL_OVERLAP_M - solid.WALL
    ring = np.array([[start, inside], [stop, inside], [stop, 0.0], [start, 0.0]])
    return exact_body.over(path, ring, level - solid.WALL_OVERLAP_M, high, 0.0)


def _gate(section: TrackSection, station: Any, path: TrackPath, levels: ArrayLike) -> Any:
    """The blade of a gate across the track, without its opening."""
    area, thick, lean = solid.gate_area(section, station)
    turn = float(path.angle(station.blade[0, 0]))
    outward, ahead = np.array([np.cos(turn), np.sin(turn), 0.0]), np.array([-np.sin(turn), np.cos(turn), 0.0])
    axes = np.column_stack([lean * ahead - outward, [0.0, 0.0, 1.0], ahead])
    foot = path.radius * outward + [0.0, 0.0, solid.level_at(levels, station)]
    return exact_body.plank(shapely.normalize(area), thick, axes, foot)
