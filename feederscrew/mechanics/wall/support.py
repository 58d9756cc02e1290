"""Whether the track holds the weight of a part on the side of its free edge."""

import numpy as np
from numpy.typing import NDArray

from feederscrew.geometry import vectors
from feederscrew.geometry.polygons import cross, turned

PLACE_TOLERANCE_M = 1e-12  # [m] places along the track nearer than this are one
EDGE_TOLERANCE = 1e-6  # of the outline's size: nearer than this to the edge is on it


def reaches(headings, posture, track) -> list[NDArray[np.float64]]:
    """Return how far from the wall a track of some radius and width supports a part in each of its headings.

    Parameters
    ----------
    headings : Headings
    posture : Posture
    track : Track

    Returns
    -------
    list of (K, 2) float [m]
        Places along the track and how far it reaches there, as seen from the centre of mass; none where it
        supports nothing.
    """
    where = zip(headings.headings, headings.distances)
    return [_reach(_on_track(turned(posture.feet, angle), wall, track)) for angle, wall in where]


def falls(posture, reach, track) -> bool:
    """Return whether the weight's line meets the surface beyond what the track supports, at its free edge.

    Source: own; docs/mechanics.md, "Headings".

    Parameters
    ----------
    posture : Posture
    reach : (K, 2) float [m]
        Of one heading, from `reaches`.
    track : Track

    Returns
    -------
    bool
        Towards the wall the part leans on it, and ahead or behind it tips without leaving the track. One
        that rolls touches along a line through the foot of its centre of mass: it falls where the track
        ends before that, however wide the strip of its file is.
    """
    if len(reach) == 0:
        return True
    slope = np.array([np.sin(track.climb), np.cos(track.climb) * np.sin(track.bank)])
    ahead, inward = -posture.height * slope / (np.cos(track.climb) * np.cos(track.bank))
    size = np.ptp(posture.outline, axis=0).max()
    most = reach[:, 1].max()
    if posture.kind == "rolling":
        return bool(inward > most + EDGE_TOLERANCE * size)
    along, off = reach.T
    return bool(inward > np.interp(ahead, along, off, left=most, right=most) + EDGE_TOLERANCE * size)


def _reach(points) -> NDArray[np.float64]:
    """(K, 2) the side of the hull of points that is away from the wall, along the track."""
    places = np.column_stack([PLACE_TOLERANCE_M * np.round(points[:, 0] / PLACE_TOLERANCE_M), points[:, 1]])
    chain: list[np.ndarray] = []
    for point in places[np.lexsort((-places[:, 1], places[:, 0]))]:
        if chain and point[0] == chain[-1][0]:
            continue  # nearer to the wall than the one before
        while len(chain) > 1 and cross(chain[-1] - chain[-2], point - chain[-1]) >= 0.0:
            chain.pop()
        chain.append(point)
    return np.array(chain).reshape(-1, 2)


def _on_track(edges, to_wall, track) -> NDArray[np.float64]:
    """Ends (K, 2) of what lies over the track of edges (E, 2, 2) that touch it."""
    corners, edge = edges.reshape(-1, 2), track.radius - track.width
    if edge <= 0.0:
        return corners
    centre = np.array([0.0, track.radius - to_wall])
    on = corners[np.hypot(*(corners - centre).T) >= edge]
    return np.concatenate([on, centre + _crossings(edges[:, 0] - centre, edges[:, 1] - centre, edge)])


def _crossings(start, end, radius) -> NDArray[np.float64]:
    """Points (K, 2) where edges cross a circle about the origin."""
    along = end - start
    a, b, c = vectors.dot(along, along), vectors.dot(start, along), vectors.dot(start, start) - radius**2
    meets = (b * b - a * c > 0.0) & (a > 0.0)
    start, along, a, b, c = start[meets], along[meets], a[meets], b[meets], c[meets]
    shares = (-b + np.sqrt(b * b - a * c) * np.array([[-1.0], [1.0]])) / a
    side, edge = np.nonzero((shares >= 0.0) & (shares <= 1.0))
    return start[edge] + shares[side, edge][:, None] * along[edge]
