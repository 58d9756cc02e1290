"""A convex outline pushed against the inside of a bowl wall: where it touches, which ways it can lie.

Seen from the part, the bowl's axis O may lie anywhere within the wall's radius of every corner. Pushed
outward, the part moves until O is as far from the centre of mass's foot G as that allows: on a corner of
this region, where two corners of the outline touch the wall. The radius may be infinite: a straight wall.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from feederscrew import check
from feederscrew.geometry.polygons import cross, inset

SAME_TOP_SHARE = 0.1  # of that depth: tops of a curved end that differ by less are one, and halved
MIN_DIP_SHARE = 1e-2  # of the outline's size: dips between headings shallower than this are facets of a curve


@dataclass(frozen=True, eq=False)
class Rests:
    """Every way an outline lies against the wall, M of them, by angle of the outward direction."""

    outward: np.ndarray  # (M,) [rad] of the direction to the wall through the foot, in body axes, -pi to pi
    touching: np.ndarray  # (M, 2, 2) [m] the two corners at the wall, the trailing one first
    distance: np.ndarray  # (M,) [m] from the foot to the wall along that direction
    share: np.ndarray  # (M,) [1] of the circle of directions that end there when pushed
    start: np.ndarray  # (M,) [rad] where that range of directions begins, counter-clockwise
    rounded: bool = False  # the outline is round as far as is known: every direction is as good


def rests(outline, radius, merge=MIN_DIP_SHARE) -> Rests:
    """Return how an outline can lie against a wall.

    Source: own; docs/mechanics.md, "Headings".

    Parameters
    ----------
    outline : (J, 2) float [m]
        Convex, counter-clockwise seen from above, from the foot of the centre of mass.
    radius : float [m]
        Of the wall, not below the outline's greatest extent; infinite for a straight wall.
    merge : float [1]
        Headings divided by a lesser rise of the centre of mass's distance, over the outline's size, count
        as one: the facets of a tessellated curve.

    Returns
    -------
    Rests
        Shares sum to 1. A part laid down in any direction and pushed outward turns to the rest in whose
        range of directions it was: the plane's counterpart of quasi-static tumbling.

    Raises
    ------
    ValueError
        If the outline is not an array of corners, or the foot is not inside it.
    """
    outline = check.shaped("outline", outline, (-1, 2))
    if not inset(outline, np.zeros(2)) > 0.0:
        raise ValueError("the outline does not hold the foot of the centre of mass")
    corners = _touching_corners(outline, radius)
    after = np.roll(corners, -1, axis=0)
    outward, distance = _pushed(corners, after, radius)
    towards = np.arctan2(corners[:, 1], corners[:, 0])
    stable = (_ahead(towards, outward) > 0.0) & (_ahead(outward, np.roll(towards, -1)) > 0.0)
    balanced = (_ahead(np.roll(outward, 1), towards) > 0.0) & (_ahead(towards, outward) > 0.0)
    lowest, highest = np.flatnonzero(stable), np.flatnonzero(balanced)
    tops = highest[np.searchsorted(highest, lowest, side="right") - 1]  # the corner it tips over backwards
    merged, start, share, rounded = _merged(
        distance[lowest], np.hypot(*corners[tops].T), towards[tops], merge * np.hypot(*corners.T).max()
    )
    chosen = lowest[merged]
    return Rests(
        outward=check.frozen(outward[chosen]),
        touching=check.frozen(np.stack([corners[chosen], after[chosen]], axis=1)),
        distance=check.frozen(distance[chosen]),
        share=check.frozen(share),
        start=check.frozen(start),
        rounded=rounded,
    )


def _chord(first, second) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Middle of two corners, unit vector into the outline, half their distance."""
    along = second - first
    length = np.hypot(along[..., 0], along[..., 1])
    inward = np.stack([-along[..., 1], along[..., 0]], axis=-1) / length[..., None]
    return 0.5 * (first + second), inward, 0.5 * length


def _touching_corners(corners, radius) -> NDArray[np.float64]:
    """The corners that can reach the wall: those its curve does not bridge."""
    while len(corners) > 2 and np.isfinite(radius):
        before, after = np.roll(corners, 1, axis=0), np.roll(corners, -1, axis=0)
        middle, inward, half = _chord(before, after)
        depth = radius - np.sqrt(radius**2 - half**2)  # of the wall behind the chord
        sideways, behind = cross(inward, corners - middle), -np.einsum("ki,ki->k", inward, corners - middle)
        gap = depth - behind - (radius - np.sqrt(radius**2 - sideways**2))
        if gap.max() < 0.0:
            break
        corners = np.delete(corners, np.argmax(gap), axis=0)
    return corners


def _pushed(first, second, radius) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Direction to the wall through the foot, and the foot's distance from it, two corners touching."""
    middle, inward, half = _chord(first, second)
    in_line = np.einsum("ki,ki->k", middle, inward)
    if np.isinf(radius):
        return np.arctan2(-inward[:, 1], -inward[:, 0]), -in_line
    reach = np.sqrt(radius**2 - half**2)
    centre = middle + reach[:, None] * inward
    far = np.hypot(*centre.T)
    gap = half**2 - np.einsum("ki,ki->k", middle, middle) - 2.0 * reach * in_line  # radius^2 - far^2, exactly
    return np.arctan2(-centre[:, 1], -centre[:, 0]), gap / (radius + far)


def _ahead(start, end) -> NDArray[np.float64]:
    """Angle from one direction on to another, -pi to pi."""
    return np.mod(end - start + np.pi, 2.0 * np.pi) - np.pi


def _merged(lows, tops, borders, least) -> tuple[Any, ...]:
    """Join dips with their neighbour over borders that rise less than ``least`` above them.

    Parameters are per dip: its depth, the height of the border before it and where that border lies.
    """
    dips = list(range(len(lows)))
    edges = dict(enumerate(tops))
    while len(dips) > 1:
        rises = [min(edges[k], edges[dips[(i + 1) % len(dips)]]) - lows[k] for i, k in enumerate(dips)]
        i = int(np.argmin(rises))
        if rises[i] >= least:
            break
        _join(dips, edges, i)
    rounded = bool(max(tops) - min(lows) < 2.0 * least)
    starts = np.array(
        [_border(tops, borders, dips[i - 1], k, SAME_TOP_SHARE * least) for i, k in enumerate(dips)]
    )
    share = np.mod(np.roll(starts, -1) - starts, 2.0 * np.pi) / (2.0 * np.pi)
    return np.array(dips), starts, np.where(share > 0.0, share, 1.0), rounded


def _join(dips, edges, i) -> None:
    """Give dip i to the neighbour behind the lower of its two borders."""
    here, following = dips[i], dips[(i + 1) % len(dips)]
    edges[following] = max(edges[here], edges[following])
    dips.pop(i)


def _border(tops, borders, before, after, level) -> float:
    """Middle of the highest tops between two dips that are left, so that an even end is shared evenly."""
    between = (before + 1 + np.arange((after - before - 1) % len(tops) + 1)) % len(tops)
    highest = borders[between[tops[between] >= tops[between].max() - level]]
    return highest[0] + 0.5 * np.mod(highest[-1] - highest[0], 2.0 * np.pi)
