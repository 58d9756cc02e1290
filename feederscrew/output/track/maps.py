"""Maps of the part on the track over two values of the bowl."""

import numpy as np

from feederscrew import bowl as bowls
from feederscrew.mechanics import limits
from feederscrew.mechanics.track import cells as track_cells
from feederscrew.output import tables
from feederscrew.studies import maps
from feederscrew.units import factor

MM = factor("mm", "length")
USUAL = ("track.bank=0deg:30deg:41", "track.climb=0deg:8deg:41")
SHOWN = "acceleration_x_m_s2"
IN_MM = {
    "normal_line_offset_m": "normal_line_offset_mm",
    "normal_line_offset_across_m": "normal_line_offset_y_mm",
}


def grid(posture, settings, ranges, heading=None):
    """The upper reversal at every pair of two values of the bowl.

    Parameters
    ----------
    posture : Posture
    settings : tuple of Setting
        Of the bowl; all but the two are kept.
    ranges : sequence of Range
        Two, or none for bank and climb.
    heading : float [rad], optional
        As laid down.

    Returns
    -------
    Grid
    """
    first, second = ranges or bowls.ranges(USUAL)

    def function(x, y):
        bowl = limits.plain(bowls.swept(settings, {first.key.name: x, second.key.name: y}))
        found = track_cells.cells(posture, bowl, heading)
        return {
            IN_MM.get(name, name): values / MM if name in IN_MM else values for name, values in found.items()
        }

    return maps.evaluate(maps.axis(first), maps.axis(second), function, track_cells.REGIMES)


def cells(grid):
    """Every cell, as a frame."""
    return tables.frame(grid.columns())


def remarks(grid):
    """What a reader of a map should know, a line each."""
    shares = grid.shares()
    lines = [] if shares["slide"] or shares["leaves the wall"] else ["nothing slides anywhere on the map"]
    unfit = int(np.round(shares["does not fit"] * grid.codes.size))
    if unfit:
        lines.append(f"the part does not fit the track in {unfit} of {grid.codes.size} cells")
    return lines


def own_point(grid, bowl):
    """The bowl's own values in the units of the map's axes."""
    return tuple(_value(bowl, axis) for axis in (grid.first, grid.second))


def _value(bowl, axis):
    key = next(key for key in bowls.schema.KEYS if key.column == axis.column)
    section, _, word = key.field.rpartition(".")
    value = getattr(getattr(bowl, section) if section else bowl, word)
    return value / key.share / axis.unit
