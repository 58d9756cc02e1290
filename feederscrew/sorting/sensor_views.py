"""View of an orientation by a sensor, and by how much two differ."""

import functools
from typing import NamedTuple

import numpy as np
import shapely

from feederscrew.base.arrays import Floats, Points
from feederscrew.base.geometry.polygons import turned
from feederscrew.base.geometry.vectors import product
from feederscrew.base.heavy import heavy
from feederscrew.resting.posture import Posture
from feederscrew.sorting.footprints import visible_area
from feederscrew.sorting.orientations import Orientation

kernel = heavy("feederscrew.sorting.kernel")

BORDER_STEP_M = 1e-4  # [m] between places of a border at which two are compared
VIEW_TURNS_RAD = tuple(np.radians((-4.0, -2.0, 0.0, 2.0, 4.0)))  # by which parts come turned
MAX_VIEW_TURN_RAD = np.radians(10.0)  # by which an outline is turned, either way, until it fits
# turns that are tried first, then between them
COARSE = 9
SHRINKS = 10
GOLDEN = 0.5 * (np.sqrt(5.0) - 1.0)

View = tuple[Posture, float, float]  # heading [rad], and how far from the sensor's line [m]


class Border(NamedTuple):
    """The border of an area, with that of its holes."""

    places: Points  # (P, 2) [m] at which it is compared, its corners among them
    sides: Floats  # (S, 4) [m] start and vector


def difference(orientation: Orientation, other: Orientation, sees: str) -> float:
    """Return by how much two orientations differ for a sensor.

    It is the greatest distance from a place of either border to the other one, both with their front at the
    same place and, seen from above, as near to the wall. The least counts of how they may come: from above
    the outline is turned until it fits, seen otherwise the first may come askew.

    Parameters
    ----------
    orientation, other : Orientation
    sees : str
        'outline' from above, 'side' from the bowl's axis, 'height', or 'relief' along the line over which the
        other one's centre of mass goes.

    Returns
    -------
    float [m]

    References
    ----------
    docs/tooling.md, "1. The method".
    """
    if sees == "height":
        return abs(orientation.height - other.height)
    if orientation is other:
        return 0.0
    return _difference(_lies(orientation, other.distance, sees), _lies(other, other.distance, sees), sees)


@functools.lru_cache(maxsize=4096)
def _difference(lies: View, wanted_lies: View, sees: str) -> float:
    wanted = _outline_border(wanted_lies, sees)
    if sees == "outline":
        return _fit_difference(_outline_border(lies, sees), wanted, 0.0)
    return min(border_distance(_outline_border(lies, sees, turn), wanted) for turn in VIEW_TURNS_RAD)


def askew(orientation: Orientation, sees: str) -> float:
    """Return by how much an orientation may differ from itself for a sensor, as parts come askew.

    Parameters
    ----------
    orientation : Orientation
    sees : str
        As for ``difference``.

    Returns
    -------
    float [m]
        0 of an outline, which is turned until it fits, and of a height.
    """
    if sees in ("outline", "height"):
        return 0.0
    return _askew(_lies(orientation, orientation.distance, sees), sees)


@functools.lru_cache(maxsize=512)
def _askew(lies: View, sees: str) -> float:
    straight = _outline_border(lies, sees)
    return max(border_distance(_outline_border(lies, sees, turn), straight) for turn in VIEW_TURNS_RAD)


def _lies(orientation: Orientation, line: float, sees: str) -> View:
    """Return all that a sensor's view depends on: posture, heading, and how far off its line it lies [m]."""
    return orientation.posture, orientation.heading, orientation.distance - line if sees == "relief" else 0.0


def fit_difference(view: shapely.Geometry, wanted: shapely.Geometry, enough: float = 0.0) -> float:
    """Return by how much an area seen from above differs from another one, turned until it fits best.

    Parameters
    ----------
    view, wanted : shapely geometry [m]
    enough : float [m], optional
        Once they differ by no more, or by more at any turn, no better fit is sought.

    Returns
    -------
    float [m]
    """
    return _fit_difference(border(view), border(wanted), enough)


def _fit_difference(view: Border, wanted: Border, enough: float) -> float:
    def misfit(turn: float) -> float:
        # turned about the middle, its front and its side laid where they were
        places, sides = view.places, view.sides
        if turn:
            axes = np.array([[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]])
            places = product(places, axes)
            sides = np.concatenate([product(sides[:, :2], axes), product(sides[:, 2:], axes)], axis=1)
        corner = np.array([places[:, 0].max(), places[:, 1].min()])
        return border_distance(Border(places - corner, sides - [*corner, 0.0, 0.0]), wanted)

    best = misfit(0.0)
    if best <= enough:
        return best
    turns = np.linspace(-MAX_VIEW_TURN_RAD, MAX_VIEW_TURN_RAD, COARSE)
    misfits = [misfit(turn) for turn in turns]
    k = int(np.argmin(misfits))
    # between turns it may fit better by no more than this: half a step moves no place by more than its
    # distance from the middle times that, and its front and its side, to which it is laid, as far again
    far = np.sqrt((view.places**2).sum(axis=1)).max()
    if misfits[k] - float((1.0 + np.sqrt(2.0)) * far * 0.5 * (turns[1] - turns[0])) > enough > 0.0:
        return min(best, misfits[k])
    low, high = turns[max(k - 1, 0)], turns[min(k + 1, COARSE - 1)]
    first, second = high - GOLDEN * (high - low), low + GOLDEN * (high - low)
    here, there = misfit(first), misfit(second)
    for _ in range(SHRINKS):
        if here < there:
            high, second, there = second, first, here
            first = high - GOLDEN * (high - low)
            here = misfit(first)
        else:
            low, first, here = first, second, there
            second = low + GOLDEN * (high - low)
            there = misfit(second)
    return min(best, here, there)


def border(area: shapely.Geometry) -> Border:
    """Return the border of an area, with places along it and its sides.

    Parameters
    ----------
    area : shapely geometry [m]

    Returns
    -------
    Border
    """
    rings = area.boundary
    places = shapely.get_coordinates(shapely.segmentize(rings, 10.0 * BORDER_STEP_M))
    corners, ring = shapely.get_coordinates(shapely.get_parts(rings), return_index=True)
    sides = np.concatenate([corners[:-1], corners[1:] - corners[:-1]], axis=1)
    return Border(places, sides[(ring[1:] == ring[:-1]) & (sides[:, 2:] != 0.0).any(axis=1)])


def border_distance(first: Border, second: Border) -> float:
    """Return the greatest distance from a place of either border to the other one.

    Parameters
    ----------
    first, second : Border

    Returns
    -------
    float [m]
    """
    return max(kernel.farthest(a.places, b.sides) for a, b in ((first, second), (second, first)))


def outline_distance(first: shapely.Geometry, second: shapely.Geometry) -> float:
    """Return the greatest distance from a place of either area's border to the other's.

    Parameters
    ----------
    first, second : shapely geometry [m]

    Returns
    -------
    float [m]
    """
    return border_distance(border(first), border(second))


def outline(orientation: Orientation, sees: str, line: float = 0.0) -> shapely.Geometry:
    """Return the area that a sensor sees of an orientation: ahead from its front, and from its side.

    Parameters
    ----------
    orientation : Orientation
    sees : str
        As for ``difference``.
    line : float [m], optional
        Of a 'relief': over which line, off the wall.

    Returns
    -------
    shapely geometry [m]
    """
    return _outline(_lies(orientation, line, sees), sees)


@functools.lru_cache(maxsize=2048)
def _outline_border(lies: View, sees: str, turn: float = 0.0) -> Border:
    return border(_outline(lies, sees, turn))


@functools.lru_cache(maxsize=2048)
def _outline(lies: View, sees: str, turn: float = 0.0) -> shapely.Geometry:
    posture, heading, away = lies
    points, faces = posture.surface, posture.facets
    plan = turned(points[:, :2], heading + turn)
    return visible_area(np.column_stack([plan + [0.0, away], points[:, 2]]), faces, sees)
