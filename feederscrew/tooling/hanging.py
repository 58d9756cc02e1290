"""Headed parts: a slot between rails lets the shank down and holds the head; from there on they hang."""

from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache
from typing import cast

import numpy as np
import shapely

from feederscrew import check
from feederscrew.geometry import vectors
from feederscrew.geometry.polygons import convex, cross, outline, sides
from feederscrew.tooling import touching
from feederscrew.tooling.foot import Footprint
from feederscrew.tooling.orientations import Orientation

SLICES = 80  # along the part
MAX_SHANK_ANGLE_RAD = np.radians(
    45.0
)  # a part that stands or lies across the track does not go down by its shank
SAME_HEAD_COSINE = np.cos(
    np.radians(5.0)
)  # parts that hang by the same head hang alike, however they lay before
HANGING = "hanging"  # what the hanging pose is called, in place of an aspect
TIP_BEYOND_RAIL_SHARE = (
    0.38  # of the shank's radius: how far beyond a rail the middle of its tip has to lie ...
)
STRAIGHT_SHANK_SHARE = (
    0.05  # of its diameter: ... unless its tip lies no farther aside than that from its weight
)
BARE, FULL = 1.05, 0.9  # of the shank's and of its own width: where the underside of a head begins and ends
SEATED = 0.1  # of the head's height: how much of a cone's underside counts as resting on the rails


@dataclass(frozen=True, eq=False)
class Neck:
    """Shank and head of a part, across its own long axis."""

    shank: float  # [m] greatest width of the stretch that holds the centre of mass and reaches to one end
    head: float  # [m] of the other end, in the way it is narrowest
    widest: float  # [m] of that end, in any way it turns about the long axis
    tip: float  # [m] from the foot of the centre of mass, inwards: the long axis at the shank's end
    rise: float  # [1] of the head's underside from the shank outwards: 0 of a flat one, 1 of a cone of 90 deg
    lever: float  # [m] from the head's end to the centre of mass, along the long axis
    down: np.ndarray  # (3,) [1] from head to shank, in the file's axes


@dataclass(frozen=True, eq=False)
class Hanging(Orientation):
    """A part that hangs by its head between rails: its foot is what of the head rests on them."""

    neck: Neck = field(kw_only=True)
    span: tuple[float, ...] = ()  # [m] of the slot, from the wall
    lies_on: tuple[float, ...] = ()  # [m] shank's and head's middle from the foot of the centre of mass

    @property
    def name(self):
        """'hanging'; of a part with two heads also 'hanging 2'."""
        return self.aspect

    @property
    def shift(self):
        """A hanging part's weight pulls through its own slot, however the track is banked."""
        return 0.0

    @cached_property
    def foot(self):
        """What of the head rests on the rails: a Footprint."""
        size = np.ptp(cast(np.ndarray, self.posture.corners), axis=0).max()
        for depth in (touching.TOUCHING * size, SEATED * self.height):
            rings = touching.rings(self._rests(depth), touching.SLIVER * size**2)
            if len(rings) > 1 or depth > touching.TOUCHING * size:
                break
        return Footprint(rings=rings, edges=np.empty((0, 2, 2)), points=np.empty((0, 2)))

    def over(self, span):
        """Return the margin [m] by which shank and head fit rails at another distance; negative if not."""
        first, last = (end - self.distance for end in span)
        (shank, head), wide = self.lies_on, self.neck
        free = min(shank - 0.5 * wide.shank - first, last - shank - 0.5 * wide.shank)
        return float(min(free, first - head + 0.5 * wide.head, head + 0.5 * wide.head - last))

    def _rests(self, depth):
        """What of the part lies lower over the rails than a depth, as an area about the foot."""
        points, faces = self.posture.surface, self.posture.facets
        area = touching.area_below(points[:, :2], points[:, 2], faces, depth, True)
        reach = np.hypot(*cast(np.ndarray, self.posture.corners)[:, :2].T).max()
        return area.difference(touching.ring(self.span, self.distance, self.track.radius, 2.0 * reach))


def neck(one):
    """Return shank and head of a part, as it lies.

    Parameters
    ----------
    one : Orientation

    Returns
    -------
    Neck or None
        None where no end is wider than the rest of the part, or its long axis does not lie along the track.
    """
    return _neck(_Lying(one))


class _Lying:
    """An orientation, equal to any other of the same solid that is turned alike, on whatever track."""

    def __init__(self, one):
        self.one, self.solid, self.axes = one, one.posture.solid, one.axes.tobytes()

    def __eq__(self, other):
        return self.solid is other.solid and self.axes == other.axes

    def __hash__(self):
        return hash((id(self.solid), self.axes))


@lru_cache(maxsize=512)
def _neck(lying):
    one = lying.one
    axis = _axis(one)
    if abs(axis[2]) > np.sin(MAX_SHANK_ANGLE_RAD) or abs(axis[1]) > np.sin(MAX_SHANK_ANGLE_RAD) * np.hypot(
        axis[0], axis[1]
    ):
        return None
    places, widths = _widths(one, axis)
    found = []
    for sign, along, across in ((1.0, places, widths), (-1.0, -places[::-1], widths[::-1])):
        for k in range(1, len(across)):
            if along[k] > 0.0:  # the head must end before the centre of mass
                break
            head, shank = across[:k].max(), across[k:].max()
            found.append((head - shank, shank, head, sign, float(along[k])))
    step, shank, head, sign, end = max(found, default=(0.0, 0.0, 0.0, 1.0, 0.0))
    least, widest = _turned_about(one, sign * axis, end)
    head = min(head, least)
    if not step > 0.0 or head <= shank:
        return None
    down, tip = np.einsum("ij,i->j", one.axes, sign * axis), sign * axis[1] * max(sign * places)
    between = (sign * places <= end) & (widths > BARE * shank) & (widths < FULL * head)
    rise = float(between.sum() * np.ptp(places) / SLICES / (0.5 * step))
    lever = max(-one[4] for one in found if one[3] == sign and one[0] > 0.95 * step)
    return Neck(float(shank), float(head), widest, float(tip), rise, lever, check.frozen(down))


def _turned_about(one, axis, end):
    """Least width and diameter [m] of a head that turns about its axis: one that is flat turns edge on."""
    solid = one.posture.solid
    points = vectors.product(solid.vertices - solid.centre_of_mass, one.axes.T)
    points = points[vectors.product(points, axis) <= end]
    across = vectors.unit(np.array([-axis[1], axis[0], 0.0]))
    flat = np.column_stack([vectors.product(points, across), vectors.product(points, np.cross(axis, across))])
    if len(convex(flat)) < 3:  # the head ends in an edge: it is as narrow as that
        return 0.0, 0.0
    ring = outline(flat)
    along = sides(ring)
    along = along / np.hypot(*along.T)[:, None]
    least = min(float(np.ptp(cross(unit, ring))) for unit in along)
    return least, 2.0 * float(np.hypot(*ring.T).max())


def head_first(one):
    """Return whether a part with a head that lies along the track comes with its head ahead of its shank."""
    found = neck(one)
    return found is not None and vectors.dot(one.axes[0], found.down) < 0.0


def hanging_margin(one, width, widest=None):
    """Return by how much [m] a slot of some width lets the shank down and holds the head; negative if not.

    The head is held where the slot is ``widest``, if that is another width.

    Source: docs/tooling.md, "1. The method".
    """
    found, widest = neck(one), width if widest is None else widest
    return -np.inf if found is None else min(width - found.shank, found.head - widest)


def tip_goes_down(one, near):
    """Return whether the end of a shank that lies askew goes down beside the rail at the wall.

    Source: own; docs/tooling.md, "1. The method": rails begin with a lead-in.

    Parameters
    ----------
    one : Orientation
    near : float [m]
        From the wall: where the slot begins.

    Notes
    -----
    A round end whose middle lies x beyond the rail's edge rests on it by a flank that leans by asin(x / r):
    the less, the less it is pushed aside. In trials of four screws, six of each, those with up to 0.33 r
    lay askew over the slot to its end, or some of them, and those with 0.39 r and more went down.
    """
    found = neck(one)
    if found is None:
        return False
    beyond = one.distance + found.tip - near
    return (
        abs(found.tip) <= STRAIGHT_SHANK_SHARE * found.shank
        or beyond >= TIP_BEYOND_RAIL_SHARE * 0.5 * found.shank
    )


@dataclass(frozen=True, eq=False)
class Shoulders:
    """What of a part, as it lies, goes down into a slot, and what then holds it on both sides."""

    stem: float  # [m] width across the track of what goes down
    nearest: float  # [m] from the foot of the centre of mass, inwards: what of it comes nearest to the wall
    middle: float  # [m] of it, from the foot of the centre of mass
    drop: float  # [m] by which it goes down
    spare: float  # [m] from the foot to the border of what holds it: by how much it stands upright there


def shoulders(one, width):
    """Return how a part goes down into a slot along the track as it lies and is held: a T-nut, stem down.

    Source: own; docs/tooling.md, "1. The method".

    Parameters
    ----------
    one : Orientation
    width : float [m]
        Of the slot, in whose middle what goes down is taken to lie.

    Returns
    -------
    Shoulders or None
        None where nothing goes down, or what rests on both sides then does not hold the centre of mass; of a
        part that has a head and a shank along the track, too.
    """
    if isinstance(one, Hanging) or one.kind == "rolling" or neck(one) is not None:
        return None
    return _shoulders(_Lying(one), one.posture.height, one.track.radius, one.distance, width)


@lru_cache(maxsize=512)
def _shoulders(lying, height, radius, distance, width):
    """Shoulders of what lies so on a track of some radius at some distance from its wall [m]."""
    one = lying.one
    solid = one.posture.solid
    points = vectors.product(solid.vertices - solid.centre_of_mass, one.axes.T)
    points = points + [0.0, 0.0, height]
    size = float(np.ptp(points, axis=0).max())
    flat = touching.TOUCHING * size
    foot = points[points[:, 2] < flat]
    stem, middle = float(np.ptp(foot[:, 1])), float(0.5 * (foot[:, 1].min() + foot[:, 1].max()))
    if stem >= width or np.abs(points[:, 1] - middle).max() < 0.5 * width:
        return None
    drop = _underside(points, solid.faces, middle, 0.5 * width)
    if not flat < drop <= np.ptp(foot[:, 0]):
        return None
    area = touching.area_below(points[:, :2], points[:, 2] - drop, solid.faces, flat, True)
    half = 0.5 * width
    beside = area.difference(shapely.box(-2.0 * size, middle - half, 2.0 * size, middle + half))
    hull, weight = beside.convex_hull, shapely.Point(0.0, 0.0)
    if beside.area <= touching.SLIVER * size**2 or not hull.contains(weight):
        return None
    centre = radius - distance
    nearest = centre - np.hypot(foot[:, 0], centre - foot[:, 1]).max()  # the wall is curved
    return Shoulders(stem, float(nearest), middle, drop, float(hull.exterior.distance(weight)))


def shoulder_margin(one, span):
    """Return by how much [m] shoulders hold a part in a slot between two distances from the wall.

    0 where it has to move across the track before its stem goes down; -inf where none hold it.
    """
    found = shoulders(one, span[1] - span[0])
    if found is None:
        return -np.inf
    inner = one.distance + found.nearest - span[0]
    outer = span[1] - one.distance - found.middle - 0.5 * found.stem
    return float(max(min(inner, outer, found.spare), 0.0))


def hung(one, span, known=()):
    """Return a part hanging between rails that it came to lying: docs/tooling.md, "1. The method".

    Parameters
    ----------
    one : Orientation
        From which it goes down by its shank.
    span : (float, float) [m]
        Of the slot, from the wall.
    known : sequence of Hanging
        That hang in this slot already: parts that hang by the same head are one orientation, however they
        lay before and however they are turned about the vertical.

    Returns
    -------
    Hanging
    """
    held = shoulders(one, span[1] - span[0])
    found = neck(one) if held is None else _neck_of(one, held)
    for other in known:
        if vectors.dot(found.down, other.neck.down) > SAME_HEAD_COSINE:
            return other
    if held is not None:
        solid = one.posture.solid
        points = vectors.product(solid.vertices - solid.centre_of_mass, one.axes.T)
        rail = held.drop - one.posture.height
        return _hanging(one, found, span, one.axes, points, rail, held.middle, len(known))
    up = -found.down
    across = one.axes[1] - up * vectors.dot(one.axes[1], up)
    across = vectors.unit(across)
    axes = np.array([np.cross(across, up), across, up])
    points = vectors.product(one.posture.solid.vertices - one.posture.solid.centre_of_mass, axes.T)
    below = points[:, 2] < 0.0
    shank = float(0.5 * (points[below, 1].min() + points[below, 1].max()))
    rail = _underside(points, one.posture.solid.faces, shank, 0.5 * (span[1] - span[0]))
    return _hanging(one, found, span, axes, points, rail, shank, len(known))


def _neck_of(one, held):
    """The Neck of a part that its shoulders hold as it lies: its stem is the shank."""
    solid = one.posture.solid
    points = vectors.product(solid.vertices - solid.centre_of_mass, one.axes.T)
    head = points[
        points[:, 2] > held.drop - one.posture.height - touching.TOUCHING * np.ptp(points, axis=0).max()
    ]
    wide, lever = float(np.ptp(head[:, 1])), float(points[:, 2].max())
    down = check.frozen(np.einsum("ij,i->j", one.axes, [0.0, 0.0, -1.0]))
    return Neck(held.stem, wide, wide, held.middle, 0.0, lever, down)


def _hanging(one, found, span, axes, points, rail, shank, count):
    """The record, from corners (V, 3) about the centre of mass and the height of the rails over it [m]."""
    points = points - [0.0, 0.0, rail]
    head = points[points[:, 2] > 0.0, 1]
    plan, distance = outline(points[:, :2]), 0.5 * sum(span) - shank
    lying = replace(
        one.posture,
        name=HANGING,
        kind=HANGING,
        height=float(-rail),
        inertia=check.frozen(vectors.product(vectors.product(axes, one.posture.solid.inertia), axes.T)),
        contact=check.frozen(plan),
        outline=check.frozen(plan),
        corners=check.frozen(points),
        axes=check.frozen(axes),
    )
    return Hanging(
        posture=lying,
        track=one.track,
        aspect=HANGING if not count else f"{HANGING} {count + 1}",
        heading=0.0,
        heading_share=1.0,
        chances={},
        length=float(np.ptp(points[:, 0])),
        width=float(distance + points[:, 1].max()),
        height=float(points[:, 2].max()),
        distance=float(distance),
        falls_off=False,
        kind=HANGING,
        neck=found,
        span=tuple(span),
        lies_on=(shank, float(0.5 * (head.min() + head.max()))),
    )


def _underside(points, faces, middle, half):
    """Height [m] of the lowest place of a surface beyond half a slot's width to either side of its middle."""
    away = np.abs(points[:, 1] - middle)
    ends = np.unique(np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])), axis=0)
    a, b = points[ends[:, 0]], points[ends[:, 1]]
    heights = [points[away >= half, 2]]
    for side in (middle - half, middle + half):
        met = (a[:, 1] > side) != (b[:, 1] > side)
        share = (side - a[met, 1]) / (b[met, 1] - a[met, 1])
        heights.append(a[met, 2] + share * (b[met, 2] - a[met, 2]))
    return float(np.concatenate(heights).min())


def _axis(one):
    """The part's own long axis (3,) in the track's axes: the principal one nearest to that of its outline."""
    turn = _long_axis(one.outline)
    near = np.array([np.cos(turn), np.sin(turn), 0.0])
    _, found = vectors.eigen(one.posture.solid.inertia)
    found = vectors.product(found.T, one.axes.T)
    best = found[np.argmax(np.round(np.abs(vectors.product(found, near)), 9))]
    return best if best[0] > 0.0 else -best


def _widths(one, axis):
    """Places along an axis from the centre of mass (N,) [m], and the part's level width there (N,) [m]."""
    solid = one.posture.solid
    points = vectors.product(solid.vertices - solid.centre_of_mass, one.axes.T)
    across = vectors.unit(np.array([-axis[1], axis[0], 0.0]))
    along, level = vectors.product(points, axis), vectors.product(points, across)
    faces = solid.faces
    ends = np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
    ends = np.unique(ends, axis=0)
    a, b = along[ends[:, 0]], along[ends[:, 1]]
    places = along.min() + (np.arange(SLICES) + 0.5) / SLICES * np.ptp(along)
    rise = b - a
    crossed = (a > places[:, None]) != (b > places[:, None])
    share = (places[:, None] - a) / np.where(rise == 0.0, 1.0, rise)
    y = level[ends[:, 0]] + share * (level[ends[:, 1]] - level[ends[:, 0]])
    top, bottom = np.where(crossed, y, -np.inf).max(axis=1), np.where(crossed, y, np.inf).min(axis=1)
    return places, np.maximum(top - bottom, 0.0)


def _long_axis(outline):
    """Direction [rad] across which a convex outline is narrowest."""
    along = sides(outline)
    along = along / np.hypot(*along.T)[:, None]
    extents = [np.ptp(cross(unit, outline)) for unit in along]
    best = along[int(np.argmin(extents))]
    return float(np.arctan2(best[1], best[0]))
