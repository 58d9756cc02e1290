"""Likeness of a part from other headings: judged by its surfaces, not by corners of its mesh.

Two ways of lying are one where a turn carries the convex hull onto itself, seen by its support function in
directions all around, and carries the solid onto itself, seen by its moments, which also know of holes.
"""

import functools
from collections.abc import Iterable

import numpy as np

from feederscrew.base.arrays import Floats, Ints, Points
from feederscrew.base.geometry import vectors
from feederscrew.part.mass import Moments
from feederscrew.part.record import Part
from feederscrew.resting.posture import Posture

SAME_SURFACE = 1e-3  # of the part's size: support functions that differ by less are equal
SAME_SOLID = 5e-4  # [1] mismatch of moments; a tessellated turn leaves 1e-6, another shape 1e-2
Look = tuple[Floats, Floats | None]  # a row of ``looks``: its supports, its moments
LOOK_DIRECTIONS = 750  # on half the sphere; their images by mirroring are the other half


def looks(posture: Posture, headings: Iterable[float]) -> tuple[Floats, Floats | None]:
    """Return the appearance of a Posture in each of some headings, as numbers that can be compared.

    The support function of a body in a direction is how far the body reaches that way. Two convex hulls are
    the same if their support functions are. Directional moments tell solids apart that share a hull, such as
    a block with a hole on one side.

    Parameters
    ----------
    posture : Posture
        With the corners of its hull.
    headings : iterable of M float [rad]

    Returns
    -------
    (M, 2, N) float [1]
        Support function about the centre of mass in N directions of the track's axes, and in their images
        under x -> -x, in units of the part's size.
    (M, 2, n, 6) float [1] or None
        Directional moments of the solid, likewise; None where only the hull is known.

    References
    ----------
    Own; docs/mechanics.md, "Headings".
    """
    corners = np.asarray(posture.corners) - [0.0, 0.0, posture.height]
    size, supports = np.ptp(corners, axis=0).max(), []
    for turn in headings:
        x, y, z = np.moveaxis(_with_images(directions(), turn), -1, 0)
        greatest = np.full(x.shape, -np.inf)
        for corner in corners:
            np.maximum(greatest, corner[0] * x + corner[1] * y + corner[2] * z, out=greatest)
        supports.append(greatest / size)
    if posture.solid is None:
        return np.array(supports), None
    # moments are smooth: some 24 directions tell them apart
    solid, there = _moments(posture.solid), directions()[:: LOOK_DIRECTIONS // 24]
    axes = np.asarray(posture.axes)
    ways = [np.einsum("ji,...j->...i", axes, _with_images(there, turn)) for turn in headings]
    return np.array(supports), np.array([solid.directional(way) for way in ways])


def looks_alike(first: Look, second: Look, mirrored: bool = False) -> bool:
    """Return whether two rows of ``looks`` are the same, or each other's mirror image fore and aft.

    Parameters
    ----------
    first : (2, N) float [1] and (2, n, 6) float [1] or None
        Supports and moments of one heading.
    second : (2, N) float [1] and (2, n, 6) float [1] or None
        Those of the other.
    mirrored : bool
        Compare with the mirror image of the second.

    Returns
    -------
    bool

    References
    ----------
    Own; docs/mechanics.md, "Headings".
    """
    (hull, solid), (other_hull, other_solid), place = first, second, int(mirrored)
    if np.abs(hull[0] - other_hull[place]).max() > SAME_SURFACE:
        return False
    if solid is None or other_solid is None:
        return True
    change = np.abs(solid[0] - other_solid[place]) / np.arange(1, solid.shape[-1] + 1)
    return bool(change.max() < SAME_SOLID)


def first_alike(posture: Posture, headings: Floats) -> Ints:
    """Return for each heading the first one of the list that is the same orientation.

    Parameters
    ----------
    posture : Posture
    headings : (M,) float [rad]

    Returns
    -------
    (M,) int
        Places in the list; a place of its own where no earlier heading is the same.

    References
    ----------
    Own; what counts as one is in docs/tooling.md, "1. The method".
    """
    if posture.corners is None or len(headings) < 2:
        return np.arange(len(headings))
    # Likeness within a tolerance is not transitive, so each heading is compared with the first of each kind.
    supports, moments = looks(posture, headings)
    rows = [(supports[k], None if moments is None else moments[k]) for k in range(len(headings))]
    first = np.arange(len(headings))
    for row in range(len(headings)):
        earlier = (k for k in np.unique(first[:row]) if looks_alike(rows[row], rows[k]))
        first[row] = next(earlier, row)
    return first


def _with_images(there: Points, turn: float) -> Floats:
    """Return directions (n, 3) of the track and their images, (2, n, 3), in axes of the turned posture."""
    both = np.stack([there, there * [-1.0, 1.0, 1.0]])
    c, s = np.cos(turn), np.sin(turn)
    x, y, z = both[..., 0], both[..., 1], both[..., 2]
    return np.stack([c * x + s * y, c * y - s * x, z], axis=-1)


@functools.lru_cache(maxsize=1)
def directions() -> Floats:
    """Return unit vectors spread over the sphere, in which parts are compared.

    Returns
    -------
    (LOOK_DIRECTIONS, 3) float [1]
    """
    return vectors.spiral(LOOK_DIRECTIONS)


@functools.lru_cache(maxsize=4)
def _moments(part: Part) -> Moments:
    return Moments(np.asarray(part.vertices), np.asarray(part.faces), part.centre_of_mass)
