"""The area that the facets of a body cover, seen along one axis, and that below its highest sides."""

from typing import Any

import numpy as np
import shapely

from feederscrew.base.arrays import Points, Triangles

LEAST_AREA_M2 = 1e-14  # [m2] twice the area of a facet that counts


def area(corners: Points, faces: Triangles) -> Any:
    """Return the area covered by facets that are seen from their outer side: all of a closed body.

    The sides along which two such facets do not go on border the pieces that are covered or not. How many
    facets cover a piece is how often those sides go round it.

    Parameters
    ----------
    corners : (V, 2) float [m]
        As seen along the axis.
    faces : (F, 3) int
        Counter-clockwise as seen where their outer side is.

    Returns
    -------
    shapely geometry [m]
        Facets of less than half ``LEAST_AREA_M2`` count for nothing.

    References
    ----------
    Own.
    """
    a, b, c = corners[faces].transpose(1, 0, 2)
    twice = (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]
    # the sides that no facet beside them undoes, and how often each is left
    outer, count = faces[twice > LEAST_AREA_M2], len(corners)
    first, last = outer.ravel(), np.roll(outer, -1, axis=1).ravel()
    keys, own = np.unique(np.minimum(first, last) * count + np.maximum(first, last), return_inverse=True)
    times = np.bincount(own, weights=np.where(first < last, 1.0, -1.0), minlength=len(keys)).astype(int)
    keys, times = keys[times != 0], times[times != 0]
    here, there = corners[keys // count], corners[keys % count]
    long = (here != there).any(axis=1)
    here, there, times = here[long], there[long], times[long]
    sides = shapely.union_all(shapely.linestrings(np.stack([here, there], axis=1)))
    pieces = shapely.get_parts(shapely.polygonize(shapely.get_parts(sides)))
    inside = shapely.get_coordinates(shapely.point_on_surface(pieces))
    # how often the directed sides go round a place within each piece
    x, y = inside[:, None, 0], inside[:, None, 1]
    aside = (there - here)[:, 0] * (y - here[:, 1]) - (there - here)[:, 1] * (x - here[:, 0])
    up, down = (here[:, 1] <= y) & (there[:, 1] > y), (there[:, 1] <= y) & (here[:, 1] > y)
    rounds = ((up & (aside > 0.0)) * times - (down & (aside < 0.0)) * times).sum(axis=1)
    return shapely.union_all(pieces[rounds > 0])


def below(sides: Points, least: float) -> Any:
    """Return the area between a level and the highest of some sides over each place along it.

    Between two neighbouring ends of sides one of the sides is the highest all along.

    Parameters
    ----------
    sides : (N, 2, 2) float [m]
        The two ends of each, a row an end: along the level, and over it.
    least : float [m]
        Ends nearer to each other along the level are one.

    Returns
    -------
    shapely geometry [m]
        In pieces where there is no side between them.

    References
    ----------
    Own.
    """
    order = np.argsort(sides[:, :, 0], axis=1)
    (x, z), (far, high) = np.take_along_axis(sides, order[:, :, None], axis=1).transpose(1, 2, 0)
    x, far = (np.round(ends / least).astype(int) for ends in (x, far))
    places = np.unique(np.concatenate([x, far]))
    begin, end = places[:-1], places[1:]
    over = (x[:, None] <= begin) & (end <= far[:, None])
    slope = (high - z) / np.maximum(far - x, 1)
    tops = [z[:, None] + slope[:, None] * (at - x[:, None]) for at in (begin, end)]
    best = np.where(over, tops[0] + tops[1], -np.inf).argmax(axis=0)
    first, last = (np.maximum(top[best, np.arange(len(best))], 0.0) for top in tops)
    # one piece for sides that follow each other, from the first begin to the last end
    covered = over.any(axis=0) & (first + last > 0.0)
    steps = np.flatnonzero(np.diff(np.concatenate([[0], covered.astype(int), [0]])))
    pieces = []
    for low, up in zip(steps[::2].tolist(), steps[1::2].tolist()):
        left, right = least * begin[low:up], least * end[low:up]
        top = np.stack([left, first[low:up], right, last[low:up]], axis=1).reshape(-1, 2)
        pieces.append(shapely.polygons(np.concatenate([[(left[0], 0.0)], top, [(right[-1], 0.0)]])))
    whole = shapely.multipolygons(pieces) if len(pieces) > 1 else pieces[0] if pieces else shapely.Polygon()
    return (whole if whole.is_valid else shapely.union_all(pieces)).simplify(least)
