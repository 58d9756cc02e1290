"""The printed section: the tooled stretch of track as one body, cut out of a bowl.

The bowl's own calls make it (``closed_body.tooled_bodies``), and ``kit`` is ``facets`` or ``exact_body``.
"""

from dataclasses import replace
from types import ModuleType

import numpy as np

from feederscrew.base import check
from feederscrew.base.arrays import Floats, Points, Triangles
from feederscrew.base.units import MM
from feederscrew.cad import closed_body, facets, track
from feederscrew.cad.facets import Body
from feederscrew.cad.plan import FULL_TURN_RAD, BowlMaterial, BowlPlan, TrackPath
from feederscrew.cad.track import GROOVE_CUT_MARGIN_M
from feederscrew.sorting import whole_surface
from feederscrew.sorting.solid import PLATE, WALL, WALL_OVERLAP_M
from feederscrew.sorting.tooled_track import DRAWN_SAGITTA_M, TooledTrack

WALL_MARGIN_M = 5e-3  # [m] of the wall above the tallest part
LEAD_M = 5e-3  # [m] of track before and behind the stretch, which is cut off
BEYOND_M = 1.0  # [m] beyond any bowl's track


def solid(tooled: TooledTrack) -> tuple[Points, Triangles]:
    """Return the closed surface of a tooled track as a printed section.

    Parameters
    ----------
    tooled : TooledTrack

    Returns
    -------
    (V, 3) float [m]
        Vertices: the wall is tangent to X at the origin, the bowl's axis is at (0, radius), the track begins
        by the wall at Z = 0, parts move towards +X.
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
    """Return the printed section as one body: the stretch that holds the devices, cut out of a bowl's track.

    The bowl is that of ``section_plan``; wall, track, cuts and blades are made by the bowl's own calls. A
    gate is part of it.

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
    plan = section_plan(tooled)
    path, radius = plan.path, plan.path.radius
    low = -tooled.fallen - 0.5 * PLATE
    outer, top = radius + plan.material.wall, plan.top
    wall = kit.turned([(radius, low), (outer, low), (outer, top), (radius, top)], plan.segments)
    blades = [
        (placed, replace(blade, is_gate=False))
        for placed in tooled.devices
        for blade in placed.features.blades
    ]
    bodies = closed_body.tooled_bodies(plan, kit, wall, blades)
    # all but the stretch
    first, last = (float(path.angle(plan.first + s)) for s in (0.0, tooled.length))
    box = [(0.0, -BEYOND_M), (BEYOND_M, -BEYOND_M), (BEYOND_M, BEYOND_M), (0.0, BEYOND_M)]
    others = kit.turned(box, plan.segments, last, FULL_TURN_RAD - (last - first))
    body = kit.without(kit.united(bodies), [*track.holes(plan, kit, hang=True), others])
    body = kit.placed_as(body, mirrored=False, turned=-0.5 * np.pi - first)
    return kit.moved(body, (0.0, radius / MM, 0.0))


def section_plan(tooled: TooledTrack) -> BowlPlan:
    """Return the bowl that a printed section is cut out of: level along the track, banked as the bowl is.

    Its track begins so far before the stretch that a groove of the entry has opened. The climb is left out,
    as a printer's bed is level: over a stretch of 0.1 m at 3.5 deg, 24 mm wide and 0.15 m from the axis, the
    helix is 0.5 mm off the section, which bends by as much as it is screwed on.

    Parameters
    ----------
    tooled : TooledTrack

    Returns
    -------
    BowlPlan
    """
    first = GROOVE_CUT_MARGIN_M + tooled.longest + LEAD_M
    made_of = BowlMaterial("print", WALL - WALL_OVERLAP_M, BEYOND_M, PLATE, 0.0, supported=True, flat=True)
    path = TrackPath(
        tooled.track.radius,
        0.0,
        tooled.track.bank,
        first + tooled.length + LEAD_M,
        drops=tuple((first + at, drop) for at, drop in tooled.drops),
        leans=tuple((first + start, first + end, bank) for start, end, bank in tooled.banks),
    )
    return BowlPlan(
        path=path,
        width=tooled.width,
        material=made_of,
        stretch=tooled,
        first=first,
        outlet=0.0,
        hanging=LEAD_M,
        headroom=tooled.tallest,
        top=max(tooled.tallest + WALL_MARGIN_M, tooled.top),
        hub=0.0,
        bolts=0,
        bolt=0.0,
        bolt_circle=0.0,
        drains=0,
        drain=0.0,
        turned=0.0,
        left=False,
        chord=DRAWN_SAGITTA_M,
        is_section=True,
    )
