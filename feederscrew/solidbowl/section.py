"""The printed section: the tooled track in its own plane as one body, of facets or with exact faces.

The same calls make both: plates, ledges, walls, blades and bores come from a ``TooledTrack``, and ``kit`` is
``facets`` or ``exact_body``. The track's surface lies in one plane: its climb and bank are those of the place
where the section is screwed on, and a wall that stands upright beside a banked track leans over it here.
"""

import itertools
from types import ModuleType

import numpy as np
import shapely

from feederscrew import check
from feederscrew.arrays import Floats, Points, Triangles
from feederscrew.solidbowl import facets
from feederscrew.solidbowl.facets import Body
from feederscrew.solidbowl.plan import TrackPath
from feederscrew.sorting import whole_surface
from feederscrew.sorting.devices.features import box_ring
from feederscrew.sorting.devices.openings import beyond_borders
from feederscrew.sorting.solid import PLATE, WALL, WALL_OVERLAP_M, leaning_profile
from feederscrew.sorting.tooled_track import DRAWN_CHORD_M, Ledge, TooledTrack, walls_of
from feederscrew.units import MM

WALL_MARGIN_M = 5e-3  # [m] of the wall above the tallest part
BLADE_REACH_M = 2e-6  # [m] from wall and track: a blade that is as near goes on into them
CUT_MARGIN_M = 1e-3  # [m] by which a cut goes on above and below the plate
RAMP_SINK_M = 3e-5  # [m] by which a ledge lies lower than the plate before it: no face lies on a face
NO_LEAN_RAD = 1e-6  # [rad] a wall that leans by less is upright


def solid(tooled: TooledTrack) -> tuple[Points, Triangles]:
    """Return the closed surface of a tooled track as a printed section.

    Parameters
    ----------
    tooled : TooledTrack

    Returns
    -------
    (V, 3) float [m]
        Vertices: the wall is tangent to X at the origin, the bowl's axis is at (0, radius), the surface of
        the track lies in the plane Z = 0, parts move towards +X.
    (F, 3) int
        Faces, corners counter-clockwise seen from outside, in one order however they were made.
    """
    vertices, places = np.unique(triangles(tooled).reshape(-1, 3), axis=0, return_inverse=True)
    return check.frozen(vertices), check.frozen(places.reshape(-1, 3))


def triangles(tooled: TooledTrack) -> Floats:
    """Return the triangles of the printed section.

    Parameters
    ----------
    tooled : TooledTrack

    Returns
    -------
    (F, 3, 3) float [m]
        Corners by triangle, counter-clockwise seen from outside.
    """
    points, faces = whole_surface.mesh(section_body(tooled, facets))
    # each from its first corner on, in the order of the corners
    corners = points[faces]
    first = np.array([min(range(3), key=lambda k: tuple(corner[k])) for corner in corners])
    turned = corners[np.arange(len(corners))[:, None], (first[:, None] + np.arange(3)) % 3]
    return turned[np.lexsort(turned.reshape(len(turned), 9).T[::-1])]


def section_body(tooled: TooledTrack, kit: ModuleType) -> Body:
    """Return the printed section as one body.

    Parameters
    ----------
    tooled : TooledTrack
    kit : module
        ``facets`` or ``exact_body``, which the bodies are made with.

    Returns
    -------
    Body [mm]
        In the axes of ``solid``.
    """
    radius, width, overlap = tooled.track.radius, tooled.width, WALL_OVERLAP_M
    path = TrackPath(radius, 0.0, 0.0, 2.0 * tooled.length, drops=tooled.drops)
    # between steps of the track: from, to a little into the next, height
    steps = [(0.0, 0.0), *tooled.drops, (tooled.length, 0.0)]
    lows = -np.cumsum([drop for _, drop in steps])
    levels = [(at - overlap * (at > 0.0), end, float(low)) for (at, _), (end, _), low in
              zip(steps, steps[1:], lows)]  # fmt: skip

    def over(ring: Points, low: float, high: float) -> Body:
        return kit.over(path, ring, low, high, 2.0 * DRAWN_CHORD_M)

    plates = [over(box_ring(start, end, -WALL, width), low - PLATE, low) for start, end, low in levels]
    plates += [
        over(box_ring(end - WALL, end, -WALL, width), low - PLATE, high - 0.5 * PLATE)
        for (_, end, high), (_, _, low) in itertools.pairwise(levels)
    ]
    plates += [_ledge(tooled, kit, path, ledge) for ledge in tooled.ledges]
    low, high = levels[-1][2] - PLATE - CUT_MARGIN_M, CUT_MARGIN_M
    tools = []
    for _, opening in tooled.openings:
        # cut on through the end of the section, where it is open there
        places = opening.ring[:, 0] + overlap * (opening.ring[:, 0] >= tooled.length - 1e-9)
        clear = np.column_stack([places, np.maximum(opening.ring[:, 1], kit.SEAM_M)])
        tools.append(over(np.array(beyond_borders(clear.tolist(), width - 1e-9, overlap)), low, high))
    bodies = [kit.without(kit.united(plates), tools)]
    walls = _walls(tooled, kit, path, -overlap + levels[-1][2])
    bores = [
        kit.bore(*path.bore(placed.begin + jet.at[0], jet.at[2], CUT_MARGIN_M), 2.0 * jet.radius, 3.0 * WALL)
        for placed in tooled.devices
        for jet in placed.features.jets
    ]
    bodies.append(kit.without(kit.united(walls), bores))
    for placed in tooled.devices:
        for blade in placed.features.blades:
            axes, foot = path.blade_frame(blade, placed.begin)
            area = shapely.normalize(blade.carried_into(overlap, overlap, BLADE_REACH_M))
            bodies.append(kit.plank(area, blade.thickness, axes, foot))
    body = kit.placed_as(kit.united(bodies), mirrored=False, turned=path.end / radius - 0.5 * np.pi)
    return kit.moved(body, (0.0, radius / MM, 0.0))


def _walls(tooled: TooledTrack, kit: ModuleType, path: TrackPath, low: float) -> list[Body]:
    """The wall [mm], stretch by stretch: upright a cylinder from a height [m] on, leaning a cone."""
    radius, overlap, bodies = path.radius, WALL_OVERLAP_M, []
    high = max(tooled.tallest + WALL_MARGIN_M, tooled.top)
    round_once = int(np.ceil(np.pi / np.sqrt(2.0 * DRAWN_CHORD_M / radius)))
    for begin, end, lean in walls_of(tooled):  # each goes on into the next one, and not to the ends
        start, stop = max(begin, overlap), min(end + overlap, tooled.length - overlap)
        if abs(lean) < NO_LEAN_RAD:
            ring = box_ring(start, stop, overlap - WALL, 0.0)
            bodies.append(kit.over(path, ring, low, high, 2.0 * DRAWN_CHORD_M))
            continue
        across = leaning_profile(radius, lean, high)
        bodies.append(kit.turned(across, round_once, float(path.angle(start)), (stop - start) / radius))
    return bodies


def _ledge(tooled: TooledTrack, kit: ModuleType, path: TrackPath, ledge: Ledge) -> Body:
    """A ledge [mm] along the wall, on the lower track beside it, and the ramp on which it comes down."""
    high = float(path.height(ledge.start - 1e-9)) - RAMP_SINK_M
    low, down = high - ledge.drop - 0.5 * PLATE, ledge.end + ledge.ramp * (1.0 + 0.4 * PLATE / ledge.drop)
    legs = []
    for start, stop in ((ledge.start - 0.5 * PLATE, ledge.end), (ledge.end, down)):
        pieces = max(int((stop - start) / np.sqrt(8.0 * path.radius * DRAWN_CHORD_M)), 3) + 1
        s = np.linspace(start, stop, pieces)
        top = high - ledge.drop * np.maximum((s - ledge.end) / ledge.ramp, 0.0)
        inward, level = np.array([WALL_OVERLAP_M, -ledge.width]), np.ones((pieces, 1))
        out = np.hstack([inward * level, inward[::-1] * level])
        up = np.hstack([top[:, None], top[:, None], low * level, low * level])
        theta = path.angle(s)
        outward = np.stack([np.cos(theta), np.sin(theta)], axis=-1)
        legs.append((np.stack([out, up], axis=-1), np.stack([path.plan(s, 0.0), outward], axis=1)))
    return kit.swept(legs)
