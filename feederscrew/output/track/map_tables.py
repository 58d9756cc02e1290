"""Maps of the part on the track over two values of the bowl, as tables."""

import numpy as np

from feederscrew import bowl as bowls
from feederscrew.output import tables
from feederscrew.output.floor.tables import none_slides
from feederscrew.units import MM

IN_MM = {
    "normal_line_offset_m": "normal_line_offset_mm",
    "normal_line_offset_across_m": "normal_line_offset_y_mm",
}


def cells(grid):
    """Return every cell of a grid of ``TrackStudy.over``, as a frame."""
    columns = grid.columns()
    return tables.frame(
        {IN_MM.get(name, name): values / MM if name in IN_MM else values for name, values in columns.items()}
    )


def remarks(grid):
    """Return what a reader of a map should know, a sentence each."""
    shares = grid.shares()
    lines = [] if shares["slide"] or shares["leaves the wall"] else [none_slides(grid)]
    unfit = int(np.round(shares["does not fit"] * grid.codes.size))
    if unfit:
        lines.append(f"the part does not fit the track in {unfit} of {grid.codes.size} cells")
    return lines


def labels(grid):
    """Return what the axes of a map are called."""
    return tuple(" ".join(tables.heading(axis.column)) for axis in (grid.first, grid.second))


def own_point(grid, bowl):
    """Return the bowl's own values in the units of the map's axes."""
    return tuple(_value(bowl, axis) for axis in (grid.first, grid.second))


def _value(bowl, axis):
    key = next(key for key in bowls.schema.BOWL_KEYS if key.column == axis.column)
    section, _, word = key.field.rpartition(".")
    value = getattr(getattr(bowl, section) if section else bowl, word)
    return value / key.share / axis.unit
