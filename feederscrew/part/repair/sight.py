"""Which facets of a closed surface may cut others: all but those that an axis through the part sees alone."""

import numpy as np

from feederscrew.geometry import coordinates, vectors

SHORT = 0.25  # [1] of the part's reach across its axis: how far the axis ends before the part does
AWAY = 1e-12  # [1] sine beyond which rounding does not decide whether a facet faces away from a point
NEAR = 1e-9  # [1] of the axis: feet closer than that may be one
NARROW = 1e-2  # [1] of the axis: shorter stretches are not looked at


def unseen(vertices, faces, solid):
    """Return the facets among which are all that cut each other.

    Parameters
    ----------
    vertices : (V, 3) float [unit of the file]
    faces : (F, 3) int
        Closed: every side has one that runs back along it.
    solid : Solid
        What they enclose.

    Returns
    -------
    (N,) int
        Empty for a surface that the axis sees whole; also those for which rounding might decide it.

    Notes
    -----
    The axis is a segment of the line about which the part is most slender. Every point off it has a foot, the
    nearest point of the segment, and the rays from each foot through the points that have it fill space once.
    Of the facets that a ray meets, those that face away from its foot less those that face it are as many as
    the turns of the surface round the foot. Where all with a foot there face away and the surface goes round
    once, every ray meets one facet. Beside a line along which two facets cut each other it would meet both.
    """
    along, across = vectors.eigen(solid.inertia)[1].T[:2]
    axes = np.array([along, across, vectors.cross(along, across)])
    places = np.einsum("ij,vj->iv", axes, vertices - solid.centre)
    short = SHORT * np.sqrt((places[1] ** 2 + places[2] ** 2).max())
    low, high = min(places[0].min() + short, 0.0), max(places[0].max() - short, 0.0)
    first, last, away = _feet(places, faces, low, high)
    near = NEAR * (high - low)
    alone = np.zeros(len(faces), dtype=bool)
    for start, end in _stretches(first[~away] - near, last[~away] + near, low, high):
        if _goes_round_once(places, faces, 0.5 * (max(start, low) + min(end, high))):
            alone |= (first > start) & (last < end)
    return np.flatnonzero(~alone)


def _feet(places, faces, low, high):
    """(F,) and (F,) first and last foot of each facet, (F,) whether it faces away from all of its feet."""
    a, b, c = places[:, faces.T].swapaxes(0, 1)
    u, v = b - a, c - a
    normal = coordinates.cross(u, v)
    feet = np.clip(places[0], low, high)
    i, j, k = feet[faces.T]
    first, last = np.minimum(np.minimum(i, j), k), np.maximum(np.maximum(i, j), k)
    offset = coordinates.dot(normal, a)
    sure = AWAY * np.abs(places).max() * np.sqrt(coordinates.dot(u, u) * coordinates.dot(v, v))
    away = np.minimum(offset - normal[0] * first, offset - normal[0] * last) > sure
    return first, last, away


def _stretches(first, last, low, high):
    """Stretches (start, end) of the axis from ``low`` to ``high`` outside all of some intervals."""
    order = np.argsort(first)
    starts = np.append(-np.inf, np.maximum.accumulate(last[order]))
    ends = np.append(first[order], np.inf)
    wide = np.minimum(ends, high) - np.maximum(starts, low) >= NARROW * (high - low)
    return zip(starts[wide], ends[wide])


def _goes_round_once(places, faces, foot):
    """Whether the section of the surface across the axis at a foot goes round it once."""
    above = places[0] > foot
    a, b, c = above[faces.T]
    through = faces[(a != b) | (b != c)]
    up = above[through]
    rises = (~up & np.roll(up, -1, axis=1)).argmax(axis=1)
    falls = (up & ~np.roll(up, -1, axis=1)).argmax(axis=1)
    (x, y), (z, w) = (_met(places, through, side, foot) for side in (rises, falls))
    return np.abs(np.arctan2(x * w - y * z, x * z + y * w).sum()) < 3.0 * np.pi  # a whole number of 2 pi


def _met(places, faces, side, foot):
    """(2, N) where one side of each facet passes through the plane across the axis at a foot."""
    n = np.arange(len(faces))
    one, other = places[:, faces[n, side]], places[:, faces[n, (side + 1) % 3]]
    share = (foot - one[0]) / (other[0] - one[0])
    return one[1:] + share * (other[1:] - one[1:])
