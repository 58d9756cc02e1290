"""Measures of the finished solid, by rays on its surface; whether what falls through comes back."""

from dataclasses import dataclass

import numpy as np
import shapely

from feederscrew.base.errors import FeederError
from feederscrew.cad import facets, track
from feederscrew.cad.closed_body import BowlSolid
from feederscrew.cad.facets import Body
from feederscrew.cad.plan import FULL_TURN_RAD, SEEN, SURE, BowlPlan

WALL_RAY_HEIGHT_M = 5e-4  # [m] over the track, where its wall is met
RIM_SECTION_RAD = -0.3  # [rad] before the outlet: there is the rim
BESIDE_CORNER_RAD = 1e-6  # [rad] so near to corners of facets, which lie on the circle, a ray meets the wall


@dataclass(frozen=True)
class Measures:
    """Lengths [m] of a solid, as a shop would measure them."""

    diameter: float  # inner, of the wall where the outlet leaves it
    wall: float
    floor: float  # thickness by the wall
    height: float  # from the underside to the rim
    track_width: float  # half a turn before the outlet, along the surface
    outlet_height: float  # of the outlet's surface over the floor's edge, by the wall
    extent: tuple[float, float, float]  # of a box around it


def measures(solid: BowlSolid) -> Measures:
    """Measure a bowl by rays on its surface.

    Parameters
    ----------
    solid : BowlSolid

    Returns
    -------
    Measures
    """
    plan, body = solid.plan, facets.unplaced(solid)
    path, far = plan.path, 3.0 * plan.path.radius

    def towards(theta: float, z: float) -> tuple[float, float, float]:
        return far * np.cos(theta), far * np.sin(theta), z

    # rim and wall: before every groove, where the wall is open
    high = plan.top - 1e-3
    starts = [float(path.angle(groove.begin)) - 0.1 for groove in track.groove_spans(plan)]
    step = FULL_TURN_RAD / plan.segments
    at = step * float(np.floor(min([RIM_SECTION_RAD, *starts]) / step)) - BESIDE_CORNER_RAD
    rim = facets.first_met(body, (0.0, 0.0, high), towards(at, high))
    # floor: where it lies bare by the wall, or about, opposite to the track's first rise
    bare = float(path.angle(0.0)) - 0.1
    r = float(path.wall_radius(path.at(bare))) - 1e-3
    place = np.array([r * np.cos(bare), r * np.sin(bare)])
    floor = facets.first_met(body, (*place, 5e-4), (*place, -far))
    # outlet: at the wall, seen where there is metal beside it; rails leave a slot
    outlet = path.end + 0.5 * plan.outlet
    outlet_height = float(path.height(outlet, 0.0))
    for across in (1e-3, 5e-4, 0.5 * plan.width, plan.width - 1e-3):
        below = facets.below(body, path.places(outlet, across) + [0.0, 0.0, 1e-3])
        if below is not None:
            outlet_height = below - across * float(np.sin(path.bank_at(outlet)))
            break
    x, y, z = map(float, np.ptp(solid.vertices, axis=0))
    return Measures(
        diameter=2.0 * (rim[0] + path.radius - float(path.wall_radius(path.at(at)))),
        wall=rim[1] - rim[0],
        floor=floor[1] - floor[0],
        height=float(np.ptp(solid.vertices[:, 2])),
        track_width=track_width(plan, body, float(path.at(-0.5 * np.pi))),
        outlet_height=outlet_height,
        extent=(x, y, z),
    )


def track_width(plan: BowlPlan, body: Body, s: float) -> float:
    """Return the width of the track at a length along the wall, along its surface.

    Rays run from the middle of the track along its surface to the wall, at two heights h and 2 h: a wall may
    lean, and is carried on straight to the surface, 2 d(h) - d(2 h). One more runs from within, below the
    surface, to the free edge.

    Parameters
    ----------
    plan : BowlPlan
    body : Body [mm]
        Right-handed, the outlet at the angle 0.
    s : float [m]
        Length along the wall.

    Returns
    -------
    float [m]
    """
    path = plan.path
    theta, half, bank = float(path.angle(s)), 0.5 * plan.width, float(path.bank_at(s))
    outward, middle = np.array([np.cos(theta), np.sin(theta), 0.0]), path.places(s, half)
    along = np.cos(bank) * outward - [0.0, 0.0, np.sin(bank)]
    low, high = (
        facets.first_met(body, start, start + 3.0 * path.radius * along)[0]
        for start in (middle + [0.0, 0.0, WALL_RAY_HEIGHT_M], middle + [0.0, 0.0, 2.0 * WALL_RAY_HEIGHT_M])
    )
    under = float(path.height(s, plan.width)) - SEEN * plan.material.plate
    to_middle = float(path.wall_radius(s)) - half * float(np.cos(bank))
    start = to_middle - plan.across  # over the floor, of which the dome may rise above the track further in
    near = start * outward + [0.0, 0.0, under]
    far = 3.0 * path.radius * outward + [0.0, 0.0, under]
    to_edge = start + facets.first_met(body, near, far)[0]
    return (2.0 * low - high) + (to_middle - to_edge) / float(np.cos(bank))


def track_heights(plan: BowlPlan, body: Body, s: float, y: float) -> float | None:
    """Return the height of the first surface below a place a little over the track.

    Parameters
    ----------
    plan : BowlPlan
    body : Body [mm]
        Right-handed, the outlet at the angle 0.
    s, y : float [m]
        Length along the wall, and distance from it.

    Returns
    -------
    float [m] or None
        None where there is nothing below, as in a cut.
    """
    place = plan.path.places(s, y)
    return facets.below(body, place + [0.0, 0.0, 0.5 * plan.headroom])


CUT_RAYS = 7  # along and across each cut
CUT_EDGE_MARGIN_M = 5e-4  # [m] from the border of a cut, where no ray is cast
LEAD_IN_HEIGHT_M = 3e-3  # [m] over the floor: what lies there is the lead-in, where it grows from the floor
SLOPE_STEP_M = 1e-3  # [m] inwards, from place to place down a slope
FACE_TOLERANCE_M = 5e-4  # [m] from a face: what lies on it
ON_FLOOR = "the floor"
ON_TURN = "the turn of the track before"


def ways_down(solid: BowlSolid) -> dict[str, str]:
    """Return where what falls through each cut of a bowl comes to lie.

    That is straight down on the floor; where the wall steps outwards down its slope too, on the floor or on
    the turn before, upstream of every device.

    Parameters
    ----------
    solid : BowlSolid

    Returns
    -------
    dict of str to str
        By the label of the cut.

    Raises
    ------
    FeederError
        If it comes to lie on something else.
    """
    plan, ways = solid.plan, {}
    if plan.stretch is None:
        return {}
    whole = facets.unplaced(solid)
    for placed, opening in plan.stretch.openings:
        # places spread over the cut, of those within the track
        within = shapely.box(-1.0, CUT_EDGE_MARGIN_M, 1e3, plan.width)
        area = shapely.Polygon(opening.ring).buffer(0.0).intersection(within).buffer(-CUT_EDGE_MARGIN_M)
        if area.is_empty:
            continue
        low_s, low_y, high_s, high_y = area.bounds
        s, y = np.meshgrid(np.linspace(low_s, high_s, CUT_RAYS), np.linspace(low_y, high_y, CUT_RAYS))
        grid = shapely.points(s.ravel(), y.ravel())
        places = grid[shapely.intersects(area, grid)]
        lain = {_lies(plan, whole, placed.label, place.x, place.y) for place in places}
        if lain:
            ways[placed.label] = " or ".join(sorted(lain))
    return ways


def _lies(plan: BowlPlan, whole: Body, label: str, s: float, y: float) -> str:
    """Where what falls at a place of a cut comes to lie."""
    path, place = plan.path, plan.path.places(plan.first + s, y)
    meet = facets.below(whole, place)
    if meet is not None and plan.stairs is not None:
        # a part slides inwards down slopes steeper than those on which it holds still
        r, steep = np.hypot(*place[:2]), np.tan(plan.stairs.slope - SURE)
        outward, place = place / r * [1.0, 1.0, 0.0], np.array([*place[:2], meet])
        while r > SLOPE_STEP_M:
            r -= SLOPE_STEP_M
            over = r * outward + [0.0, 0.0, meet + 0.2 * SLOPE_STEP_M]
            lower = facets.below(whole, over)
            if lower is None or lower > meet - steep * SLOPE_STEP_M:
                break
            place, meet = over, lower
    if meet is not None and meet <= float(plan.floor(np.hypot(*place[:2]))) + LEAD_IN_HEIGHT_M:
        return ON_FLOOR
    if meet is not None and plan.stairs is not None:
        # on the track a turn before, and that before the first device
        before = float(path.at(np.arctan2(place[1], place[0]) % -FULL_TURN_RAD - FULL_TURN_RAD))
        inward = (float(path.wall_radius(before)) - np.hypot(*place[:2])) / float(
            np.cos(path.bank_at(before))
        )
        off = abs(meet - float(path.height(before, inward)))
        on_track = -FACE_TOLERANCE_M < inward < plan.width + FACE_TOLERANCE_M
        if on_track and off < FACE_TOLERANCE_M + plan.material.plate and before < plan.first:
            return ON_TURN
    there = "nothing" if meet is None else f"the track at {1e3 * meet:.3g} mm"
    what = f"what falls through it {1e3 * s:.3g} mm behind the start of the devices meets {there}"
    other = "" if plan.stairs is not None else "sizing.shape: stepped, "
    mend = f"give a lower sizing.outlet_height, {other}or fewer devices"
    raise FeederError(f"devices: {label}", what, mend)
