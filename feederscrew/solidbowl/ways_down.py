"""Whether what falls through a cut reaches the floor: rays straight down through the finished solid."""

import numpy as np
import shapely

from feederscrew.errors import FeederError
from feederscrew.solidbowl import facets

PLACES = 7  # along and across each cut
EDGE = 5e-4  # [m] from the border of a cut, where no ray is cast
LOWEST = 3e-3  # [m] over the floor: what lies there is the lead-in, where it grows from the floor


def check_ways_down(made):
    """Raise the fault of a cut below which there is something other than the floor.

    Parameters
    ----------
    made : BowlSolid

    Raises
    ------
    FeederError
    """
    plan = made.plan
    if plan.stretch is None:
        return
    whole = facets.unplaced(made)
    for cut in plan.stretch.cuts:
        for s, y in _places(cut, plan.width):
            place = plan.way.places(plan.first + s, y)
            met = facets.below(whole, place)
            floor = float(plan.floor(np.hypot(*place[:2])))
            if met is None or met > floor + LOWEST:
                _refuse(cut, s, met)


def _refuse(cut, s, met):
    there = "nothing" if met is None else f"the track at {1e3 * met:.3g} mm"
    what = f"what falls through it {1e3 * s:.3g} mm behind the start of the devices meets {there}"
    raise FeederError(f"devices: {cut.label}", what, "give a lower sizing.outlet_height, or fewer devices")


def _places(cut, width):
    """Places (s, y) [m] spread over a cut, of those within the track."""
    area = shapely.Polygon(cut.ring).buffer(0.0).intersection(shapely.box(-1.0, EDGE, 1e3, width))
    area = area.buffer(-EDGE)
    if area.is_empty:
        return []
    low_s, low_y, high_s, high_y = area.bounds
    s, y = np.meshgrid(np.linspace(low_s, high_s, PLACES), np.linspace(low_y, high_y, PLACES))
    grid = shapely.points(s.ravel(), y.ravel())
    return [(one.x, one.y) for one in grid[shapely.intersects(area, grid)]]
