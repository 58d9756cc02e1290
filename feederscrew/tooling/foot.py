"""Feet and holes as the compiled verdict takes them."""

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from feederscrew.geometry import polygons
from feederscrew.tooling.devices.hole_shapes import WALL_OVERCUT_M, gap

SPOT = 1e-7  # [m] half the length of a single point of contact
SECTOR_TOLERANCE = 1e-9  # [1] of an angle or a distance: what is beyond by more is so for certain


@dataclass(frozen=True, eq=False)
class Footprint:
    """What of a part touches the track, in track axes from the foot of the centre of mass."""

    rings: tuple[np.ndarray, ...]  # (K, 2) [m] borders of areas, holes of them as rings of their own
    edges: np.ndarray  # (E, 2, 2) [m] lines of contact
    points: np.ndarray  # (P, 2) [m] points of contact

    @cached_property
    def corners(self):
        """(V, 2) [m] every corner of it."""
        return np.concatenate([*self.rings, self.edges.reshape(-1, 2), self.points])


def standing(foot, distance, radius, shift=0.0):
    """Return a foot about the bowl's axis.

    Parameters
    ----------
    foot : Footprint
    distance : float [m]
        From the wall to the foot of the centre of mass.
    radius : float [m]
        Of the wall.
    shift : float [m]
        By which the weight meets the track nearer to the wall, on a banked track.

    Returns
    -------
    passage.Foot
    """
    from feederscrew.tooling.kernel.passage import Foot

    foot, middle = _spots(foot), radius - distance
    starts = [*foot.rings, foot.edges[:, 0]]
    ends = [*(np.roll(ring, -1, axis=0) for ring in foot.rings), foot.edges[:, 1]]
    start, end = np.concatenate(starts), np.concatenate(ends)
    closed = np.arange(len(start)) < sum(len(ring) for ring in foot.rings)
    kept = np.hypot(*(end - start).T) > 1e-12
    start, end, closed = start[kept], end[kept], closed[kept]
    along = (end - start) * [1.0, -1.0]
    corners = np.column_stack([foot.corners[:, 0], middle - foot.corners[:, 1]])
    hull, insets = _hull(corners[:, 0], middle + shift - corners[:, 1])
    return Foot(
        hull=hull,
        insets=insets,
        sides=np.column_stack([start[:, 0], middle - start[:, 1], along]),
        closed=closed.astype(np.int64),
        corners=corners,
        polar=np.column_stack([np.arctan2(*corners.T), np.hypot(*corners.T)]),
        centre=middle + shift,
        reach=float(np.hypot(corners[:, 0], corners[:, 1] - middle - shift).max()),
        every=np.arange(len(corners)),
        sector=_sector(start[closed], end[closed], middle),
    )


def _spots(foot):
    """A foot whose single points are short lines along the track: an edge that comes is noticed there."""
    if not len(foot.points):
        return foot
    lines = foot.points[:, None] + np.array([[-SPOT, 0.0], [SPOT, 0.0]])
    edges = np.concatenate([foot.edges.reshape(-1, 2, 2), lines])
    return Footprint(rings=foot.rings, edges=edges, points=np.empty((0, 2)))


def _sector(start, end, middle):
    """Angles and distances about the axis (4,) [rad, m] between which areas of such sides lie."""
    start, end = ([1.0, -1.0] * (ends - [0.0, middle]) for ends in (start, end))
    if len(start) == 0 or not start[:, 1].min() > 0.0:
        return np.array([-np.inf, np.inf, 0.0, np.inf])
    along = end - start
    share = np.clip(-(start * along).sum(axis=1) / (along * along).sum(axis=1), 0.0, 1.0)
    nearest = np.hypot(*(start + share[:, None] * along).T).min()
    theta, far = np.arctan2(*start.T), np.hypot(*start.T).max()
    least, most = theta.min() - SECTOR_TOLERANCE, theta.max() + SECTOR_TOLERANCE
    return np.array([least, most, nearest * (1.0 - SECTOR_TOLERANCE), far * (1.0 + SECTOR_TOLERANCE)])


def scratch(foot, hole):
    """Return arrays for the verdict of feet and holes no larger than these."""
    from feederscrew.tooling.kernel.crossing import CUTS
    from feederscrew.tooling.kernel.passage import VerdictArrays

    rows = 6 * len(foot.sides) * len(hole.edges) + 1
    points = len(foot.corners) + rows + len(hole.nodes) + len(hole.edges)
    return VerdictArrays(
        rows=np.empty((rows, 6)),
        events=np.empty(2 * rows),
        bounds=np.empty(2 * rows),
        ways=np.empty(2 * rows),
        cuts=np.empty(CUTS),
        keep=np.empty(len(foot.corners), dtype=np.int64),
        held=np.empty(len(hole.nodes), dtype=np.int64),
        active=np.empty(rows, dtype=np.int64),
        points=np.empty((points, 2)),
        others=np.empty((points, 2)),
    )


def least(foot, hole, work=None, low=-np.inf, high=np.inf):
    """Return the least margin [m] of a foot over a hole's passage, and the shift [rad] where it is.

    A margin below ``low`` may be given as any that is below it, one above ``high`` as any above.

    Source: docs/tooling.md, "1. The method".
    """
    from feederscrew.tooling.kernel import passage

    out = np.empty(2)
    passage.least(foot, hole, work or scratch(foot, hole), low, high, out)
    return float(out[0]), float(out[1])


def unheld(foot, hole, work=None, enough=np.inf):
    """Return the longest way [m] over which a hole leaves a foot without support.

    One longer than ``enough`` may be given as any that is longer.

    Source: own; docs/tooling.md, "1. The method".
    """
    from feederscrew.tooling.kernel import unheld as kernel

    turn = enough * (1.0 + SECTOR_TOLERANCE) / foot.centre
    return float(kernel.longest(foot, hole, work or scratch(foot, hole), turn)) * foot.centre


def _hull(x, y):
    """Corners of the convex hull about the origin, counter-clockwise, and the insets of its sides."""
    points = np.column_stack([x, y])
    order = polygons.convex(points)
    if len(order) < 3:
        return np.empty(0, dtype=np.int64), np.empty(0)
    start = points[order]
    along = np.roll(start, -1, axis=0) - start
    return order, (start[:, 0] * along[:, 1] - start[:, 1] * along[:, 0]) / np.hypot(*along.T)


def over_ring(foot, low, high):
    """Return the margin [m] of a foot on a track without what lies between two radii [m] about the axis.

    Source: docs/tooling.md, "1. The method".
    """
    from feederscrew.tooling.kernel import ring

    return float(ring.over_ring(foot, low, high, ring_scratch(foot)))


def balcony(foot, radius):
    """Return the least width of track [m] that carries a foot; infinite where none does.

    Source: docs/tooling.md, "1. The method".
    """
    from feederscrew.tooling.kernel import ring

    return float(ring.balcony(foot, radius, _extent(foot, radius), ring_scratch(foot)))


def canyon(foot, radius):
    """Return the greatest width [m] of a strip removed along the wall that a foot passes; 0 for none."""
    from feederscrew.tooling.kernel import ring

    return max(float(ring.canyon(foot, radius, _extent(foot, radius), ring_scratch(foot))), 0.0)


def longest_gap(foot, radius):
    """Return the greatest gap [m] across the track that a foot passes; 0 for none."""
    low, high = 0.0, 2.0 * foot.reach
    width = _extent(foot, radius)
    work = scratch(foot, gap(high, radius, width))

    def passes(length):
        return least(foot, gap(length, radius, width), work, low=0.0, high=0.0)[0] >= 0.0

    if not passes(1e-9):
        return 0.0
    while high - low > 1e-12:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if passes(middle) else (low, middle)
    return low


def _extent(foot, radius):
    """How far from the wall a foot reaches [m], and a little more."""
    return min(float(radius - foot.polar[:, 1].min() + WALL_OVERCUT_M), radius)


def ring_scratch(foot):
    """Return arrays for the verdict of a foot on a ring."""
    return scratch(foot, RingSize(edges=np.empty((1, 7)), nodes=np.empty((0, 3))))


class RingSize(NamedTuple):
    """The sizes of a hole that a ring needs."""

    edges: np.ndarray
    nodes: np.ndarray
