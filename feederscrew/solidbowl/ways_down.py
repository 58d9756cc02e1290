"""Whether what falls through a cut comes back: rays straight down the finished solid, and down slopes."""

import numpy as np
import shapely

from feederscrew.errors import FeederError
from feederscrew.solidbowl import facets
from feederscrew.solidbowl.stairs import STAIRS_TURN, SURE

CUT_RAYS = 7  # along and across each cut
CUT_EDGE_MARGIN_M = 5e-4  # [m] from the border of a cut, where no ray is cast
LEAD_IN_HEIGHT_M = 3e-3  # [m] over the floor: what lies there is the lead-in, where it grows from the floor
SLOPE_STEP_M = 1e-3  # [m] inwards, from place to place down a slope
FACE_TOLERANCE_M = 5e-4  # [m] from a face: what lies on it
ON_FLOOR, ON_TURN = "the floor", "the turn of the track before"


def ways_down(made):
    """Return where what falls through each cut comes to lie.

    Parameters
    ----------
    made : BowlSolid

    Returns
    -------
    dict of str to str
        By the label of the cut: straight down on the floor; where the wall steps outwards down its slope too,
        on the floor or on the turn before, upstream of every device.

    Raises
    ------
    FeederError
        If it comes to lie on something else.
    """
    found: dict[str, str] = {}
    plan = made.plan
    if plan.stretch is None:
        return found
    whole = facets.unplaced(made)
    for cut in plan.stretch.cuts:
        lain = {_lies(plan, whole, cut, s, y) for s, y in _places(cut, plan.width)}
        if lain:
            found[cut.label] = " or ".join(sorted(lain))
    return found


def _lies(plan, whole, cut, s, y):
    """Where what falls at a place of a cut comes to lie."""
    place = plan.way.places(plan.first + s, y)
    met = facets.below(whole, place)
    if met is not None and plan.stairs is not None:
        place, met = _slid(plan, whole, place, met)
    if met is not None and met <= float(plan.floor(np.hypot(*place[:2]))) + LEAD_IN_HEIGHT_M:
        return ON_FLOOR
    if met is not None and plan.stairs is not None and _on_the_turn_before(plan, place, met):
        return ON_TURN
    raise _refused(cut, s, met)


def _slid(plan, whole, place, met):
    """Place and height where a part holds still that slides inwards from a place down steep slopes."""
    r = np.hypot(*place[:2])
    outward, steep = place / r * [1.0, 1.0, 0.0], np.tan(plan.stairs.slope - SURE)
    place = np.array([*place[:2], met])
    while r > SLOPE_STEP_M:
        r -= SLOPE_STEP_M
        over = r * outward + [0.0, 0.0, met + 0.2 * SLOPE_STEP_M]
        lower = facets.below(whole, over)
        if lower is None or lower > met - steep * SLOPE_STEP_M:
            break
        place, met = over, lower
    return place, met


def _on_the_turn_before(plan, place, met):
    """Whether a place lies on the track a turn before, and that before the first device."""
    way = plan.way
    s = float(way.at(np.arctan2(place[1], place[0]) % -STAIRS_TURN - STAIRS_TURN))
    y = (float(way.wall_radius(s)) - np.hypot(*place[:2])) / float(np.cos(way.bank_at(s)))
    off = met - float(way.height(s, y))
    return (
        -FACE_TOLERANCE_M < y < plan.width + FACE_TOLERANCE_M
        and abs(off) < FACE_TOLERANCE_M + plan.material.plate
        and s < plan.first
    )


def _refused(cut, s, met):
    there = "nothing" if met is None else f"the track at {1e3 * met:.3g} mm"
    what = f"what falls through it {1e3 * s:.3g} mm behind the start of the devices meets {there}"
    mend = "give a lower sizing.outlet_height, sizing.shape: stepped, or fewer devices"
    return FeederError(f"devices: {cut.label}", what, mend)


def _places(cut, width):
    """Places (s, y) [m] spread over a cut, of those within the track."""
    area = (
        shapely.Polygon(cut.ring).buffer(0.0).intersection(shapely.box(-1.0, CUT_EDGE_MARGIN_M, 1e3, width))
    )
    area = area.buffer(-CUT_EDGE_MARGIN_M)
    if area.is_empty:
        return []
    low_s, low_y, high_s, high_y = area.bounds
    s, y = np.meshgrid(np.linspace(low_s, high_s, CUT_RAYS), np.linspace(low_y, high_y, CUT_RAYS))
    grid = shapely.points(s.ravel(), y.ravel())
    return [(one.x, one.y) for one in grid[shapely.intersects(area, grid)]]
