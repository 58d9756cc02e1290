"""A solid as cells of a lattice: what is in it, what in its hull, and how far every cell is from it."""

from dataclasses import dataclass

import numpy as np
from scipy.ndimage import distance_transform_edt
from scipy.spatial import ConvexHull

from feederscrew.base import check
from feederscrew.base.arrays import Bools, Floats, Ints, Points, Triangles, Vector

COLUMN_OFFSETS = (1.37e-4, 2.91e-4)  # of a cell: columns run beside corners and edges of a drawing


@dataclass(frozen=True, eq=False)
class Cells:
    """Cells of a closed surface, N each way at most; lengths as those of its corners."""

    origin: Vector  # (3,) middle of the first cell
    size: float  # of a cell
    solid: Bools  # (I, J, K) bool
    hull: Bools  # (I, J, K) bool: in its convex hull
    away: Floats  # (I, J, K) from its middle to the nearest one in the solid; 0 in it
    inside: Floats  # (I, J, K) from its middle to the nearest one outside; 0 outside

    def middles(self, chosen: Bools) -> Points:
        """Return the middles of chosen cells.

        Parameters
        ----------
        chosen : (I, J, K) bool

        Returns
        -------
        (N, 3) float [any length]
        """
        return self.origin + self.size * np.argwhere(chosen)

    def places(self, points: Points) -> Ints:
        """Return in which cells points lie.

        Parameters
        ----------
        points : (..., 3) float [any length]

        Returns
        -------
        (..., 3) int
            Those beside the lattice are in its rim.
        """
        places = np.rint((points - self.origin) / self.size).astype(int)
        return np.clip(places, 0, np.array(self.solid.shape) - 1)

    def at(self, points: Points) -> tuple[Ints, ...]:
        """Return the cells of points as an index of the lattice's arrays.

        Parameters
        ----------
        points : (N, 3) float [any length]

        Returns
        -------
        tuple of three (N,) int
        """
        return tuple(self.places(points).T)

    @property
    def rim(self) -> Bools:
        """Cells (I, J, K) of the solid beside one that is not of it."""
        return self.solid & (self.inside < 1.5 * self.size)


def cells(corners: Points, triangles: Triangles, count: int) -> Cells:
    """Return the cubic cells of a closed surface and of its convex hull.

    A cell belongs to the solid if an odd number of facets lies under its middle. Columns of cells run
    ``COLUMN_OFFSETS`` of a cell beside the lattice, so that none meets a corner or an edge of a drawing.

    Parameters
    ----------
    corners : (V, 3) float [any length]
    triangles : (F, 3) int
        Places of the corners of each facet of the closed surface.
    count : int
        Cells along the longest side. The lattice has two more all round, so that its rim is empty.

    Returns
    -------
    Cells
        Lengths as those of the corners.
    """
    least, most = corners.min(axis=0), corners.max(axis=0)
    size = float((most - least).max()) / count
    # two empty cells all round: what lies beside the body is asked for as well
    shape = np.ceil((most - least) / size).astype(int) + 4
    origin = 0.5 * (least + most) - 0.5 * size * (shape - 1)
    solid = _filled(corners[triangles], origin, size, shape)
    hull = _filled(corners[ConvexHull(corners).simplices], origin, size, shape)
    return Cells(
        origin=check.frozen(origin),
        size=size,
        solid=check.frozen(solid),
        hull=check.frozen(hull | solid),
        away=check.frozen(size * distance_transform_edt(~solid)),
        inside=check.frozen(size * distance_transform_edt(solid)),
    )


def _filled(triangles: Floats, origin: Vector, size: float, shape: Ints) -> Bools:
    """Cells (I, J, K) whose middles lie in the surface: those an odd number of facets lies under."""
    column, height, _ = _crossed_columns((triangles - origin) / size - [*COLUMN_OFFSETS, 0.0], shape)
    above = np.clip(np.ceil(height).astype(int), 0, shape[2])
    turns = np.zeros((*shape[:2], shape[2] + 1), int)
    np.add.at(turns, (*column.T, above), 1)
    return np.cumsum(turns, axis=2)[..., :-1] % 2 == 1


def chords(corners: Points, triangles: Triangles, count: int) -> tuple[Floats, Ints, Ints]:
    """Return the chords of upright lines through a closed surface, from its lowest place to its highest.

    A line through a hollow body counts from end to end, the hollow included.

    Parameters
    ----------
    corners : (V, 3) float [any length]
    triangles : (F, 3) int
        Places of the corners of each facet.
    count : int
        Lines along the longer side of the body, seen from above.

    Returns
    -------
    (M,) float [length of the corners]
        Of each of the M lines that meet the surface.
    (M,) int
        The facet in which each begins.
    (M,) int
        The facet in which each ends.
    """
    least, most = corners[:, :2].min(axis=0), corners[:, :2].max(axis=0)
    size = float((most - least).max()) / count
    shape = np.ceil((most - least) / size).astype(int) + 1
    placed = (corners[triangles] - [*least, 0.0]) / size - [*COLUMN_OFFSETS, 0.0]
    column, height, facet = _crossed_columns(placed, shape)
    order = np.lexsort((height, column[:, 1], column[:, 0]))
    column, height, facet = column[order], height[order], facet[order]
    first = np.flatnonzero(np.append(True, (column[1:] != column[:-1]).any(axis=1)))
    last = np.append(first[1:], len(column)) - 1
    return size * (height[last] - height[first]), facet[first], facet[last]


def _crossed_columns(triangles: Floats, shape: Ints) -> tuple[Ints, Floats, Ints]:
    """Where upright lines at whole numbers meet triangles (T, 3, 3): which line, how high, which one."""
    least = np.ceil(triangles[:, :, :2].min(axis=1)).astype(int).clip(0)
    most = np.floor(triangles[:, :, :2].max(axis=1)).astype(int).clip(None, shape[:2] - 1)
    wide = (most - least + 1).clip(0)
    count = wide.prod(axis=1)
    facet = np.repeat(np.arange(len(triangles)), count)  # each with every line in the box around it
    place = np.arange(count.sum()) - np.repeat(np.cumsum(count) - count, count)
    column = least[facet] + np.stack([place // wide[facet, 1], place % wide[facet, 1]], axis=1)
    a, b, c = np.moveaxis(triangles[facet], 1, 0)
    x, y = column.T
    area = (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0])
    area = np.where(area == 0.0, np.nan, area)  # upright: no line meets it
    u = ((b[:, 0] - x) * (c[:, 1] - y) - (b[:, 1] - y) * (c[:, 0] - x)) / area
    v = ((c[:, 0] - x) * (a[:, 1] - y) - (c[:, 1] - y) * (a[:, 0] - x)) / area
    within = (u >= 0.0) & (v >= 0.0) & (u + v <= 1.0)
    height = u * a[:, 2] + v * b[:, 2] + (1.0 - u - v) * c[:, 2]
    return column[within], height[within], facet[within]


def handles(some: Bools) -> int:
    """Return how many handles less how many hollows a body of cells has.

    By Euler's characteristic of the cells as closed cubes: corners less edges plus faces less cubes.

    Parameters
    ----------
    some : (I, J, K) bool
        The cells, of one body.

    Returns
    -------
    int
    """
    full = np.pad(some, 1)
    total = 0
    for mask in range(8):
        axes = [k for k in range(3) if mask >> k & 1]
        components = full
        for k in axes:  # a corner, edge or face is there where any cube beside it is
            head = tuple(slice(None, -1) if m == k else slice(None) for m in range(3))
            tail = tuple(slice(1, None) if m == k else slice(None) for m in range(3))
            components = components[head] | components[tail]
        total += (-1) ** (3 - len(axes)) * int(components.sum())
    return 1 - total
