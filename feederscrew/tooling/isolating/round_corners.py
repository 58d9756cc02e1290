"""Holes as a cutter or a laser leaves them: with round corners."""

import numpy as np
import shapely

from feederscrew.tooling.isolating import hole_search
from feederscrew.tooling.isolating.chain import judged
from feederscrew.tooling.isolating.shop_values import SHOP_ROUNDING_M

ARC = 6  # chords of a quarter of a round corner
BEYOND_HOLE_M = 1.0  # [m] beyond any hole


def with_corners(given, made, radius):
    """Return a hole with corners of a radius [m], as a cutter leaves them, or None where it then does not do.

    Source: own; docs/tooling.md, "1. The method".

    Parameters
    ----------
    given : DesignTask
    made : (Cut, sequence of int)
        From ``cut_out``.
    radius : float [m]
    """
    cut, held = made
    open_ = [(x, y if y > 0.0 else -BEYOND_HOLE_M) for x, y in cut.device.corners]  # it goes on into the wall
    round_ = shapely.Polygon(open_).buffer(-radius).buffer(radius, quad_segs=ARC)
    round_ = round_.intersection(shapely.box(-BEYOND_HOLE_M, 0.0, BEYOND_HOLE_M, BEYOND_HOLE_M))
    if round_.geom_type != "Polygon" or round_.is_empty:
        return None
    corners = np.round(shapely.get_coordinates(round_.exterior)[:-1] / SHOP_ROUNDING_M) * SHOP_ROUNDING_M
    must, ends = np.isin(np.arange(len(given.every)), held), (cut.smallest, cut.largest)
    found = judged(given.every, given.wanted, hole_search.device_of(corners), must, *ends)
    return (found, held) if min(found.margin_pass, found.margin_reject) >= given.margin else None
