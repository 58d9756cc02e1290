"""Whether a part that a hole does not carry goes down through it: its shadow, in the ways it can tip."""

import functools

import numpy as np
import shapely
import shapely.affinity

from feederscrew.tooling import between_edges
from feederscrew.tooling.devices.hole_shapes import WALL_OVERCUT_M
from feederscrew.tooling.hanging import shoulder_margin
from feederscrew.tooling.holding import may_turn_and_lie_over

AZIMUTHS, FALL_TILTS = 8, 10  # ways it can tip: about level axes all round, by steps up to a right angle
SHADOW_CLEARANCE_M = 2.5e-4  # [m] a hole is larger than the shadow that goes through it, all round
OPEN_HOLE_OVERRUN_M = 0.1  # [m] a hole that is open at the track's free edge goes on so far
RECTANGLE_TOLERANCE = 1e-9  # of its box or its hull: what covers all but this, is a rectangle or convex
PARALLEL_SINE = 1e-9  # sine between two sides that do not meet
FIT_TOLERANCE_M = 1e-12  # [m] by which what fits may stand out
SHADOW_DETAIL_SHARE = 2e-4  # of the part's size: corners of a shadow that stand out by less are left out
HOLE_LENGTHS = 3.0  # of the part's size: a hole that goes on along the track is as good as endless
FAR, ONE_LINE = 10.0, 1e-6  # [m] along any hole; half the width of a line across which it is measured
PLACES, PIECES = 200, 8  # along a hole at which a part is tried; of a side of its outline


def falls_through(one, cut):
    """Return whether a hole lets an orientation through that it does not carry.

    Source: own; docs/tooling.md, "1. The method": what becomes of a part that does not pass.

    Parameters
    ----------
    one : Orientation
    cut : (K, 2) float [m]
        Unrolled: lengths along the wall and distances from it.

    Returns
    -------
    bool
        Whether the shadow of the part, tipped some way by up to a right angle, lies in the hole with
        ``SHADOW_CLEARANCE_M`` around it. Where it is tipped by less than that way, it is still on its way
        down over the edge that it leaves. What goes over the track's free edge is gone.
    """
    hole = shapely.make_valid(_open(np.asarray(cut, float), one.track.width)).buffer(
        -SHADOW_CLEARANCE_M, join_style="mitre"
    )
    if hole.is_empty:
        return False
    shadows, sizes = _shadows(one)
    extent = np.subtract(hole.bounds[2:], hole.bounds[:2])
    may = np.flatnonzero((sizes <= extent).all(axis=1))
    if hole.area > (1.0 - RECTANGLE_TOLERANCE) * extent.prod():  # it is a rectangle
        return bool(len(may))
    parts = [(part, _sides(part)) for part in shapely.get_parts(hole)]
    return any(_fits(shadows[k], *one) for k in may for one in parts)


def lets_go(device, one):
    """Return whether what a device cuts away lets an orientation go for certain that it does not carry.

    Parameters
    ----------
    device : Device
    one : Orientation
        That travels.

    Returns
    -------
    bool
        Whether the part goes over the free edge, or through a hole along the track as it lies, or down
        between two edges where no tilt of it can rest on them. True of a device that cuts nothing.
    """
    cut = device.outline_on(one.track, HOLE_LENGTHS * float(np.hypot(one.length, max(one.width, one.height))))
    if cut is None or _over_the_edge(device, one.track):
        return True
    span = device.span_on(one.track)
    if span is not None and span[0] > 0.0 and shoulder_margin(one, span) >= 0.0:
        return False
    if span is None:
        return falls_through(one, cut) and _drops_between(one, cut)
    return fits_as_it_lies(one, cut) or (falls_through(one, cut) and _slips(one, span))


@functools.lru_cache(maxsize=8192)
def surely_gone(device, one):
    """Return whether an orientation that a device does not let pass is surely returned by it.

    Source: own; docs/tooling.md, "1. The method".

    Parameters
    ----------
    device : Device
    one : Orientation
        That travels.

    Returns
    -------
    bool
        Whether it is let go of for certain, and does not turn along a swept blade that then lays it over.
    """
    turned = device.face is not None and may_turn_and_lie_over(one, device.limit)
    return lets_go(device, one) and not turned


def fits_as_it_lies(one, cut):
    """Return whether an orientation fits through a hole as it lies, somewhere on its way over it.

    Parameters
    ----------
    one, cut
        As for ``falls_through``.
    """
    hole = shapely.make_valid(_open(np.asarray(cut, float), one.track.width))
    behind = shapely.affinity.translate(hole, 0.0, -WALL_OVERCUT_M) if hole.bounds[1] <= 0.0 else hole
    hole = hole.union(behind).buffer(-SHADOW_CLEARANCE_M, join_style="mitre")
    border = shapely.segmentize(shapely.linearrings(one.outline), one.length / PIECES)
    ahead, beside = shapely.get_coordinates(border).T
    middle, radius = one.track.radius - one.distance, one.track.radius
    away = np.hypot(ahead, middle - beside)
    lies = np.column_stack([radius * np.arctan2(ahead, middle - beside), radius - away])
    if hole.is_empty or np.ptp(lies[:, 0]) > hole.bounds[2] - hole.bounds[0]:
        return False
    shifts = np.linspace(hole.bounds[0] - lies[:, 0].min(), hole.bounds[2] - lies[:, 0].max(), PLACES)
    shapely.prepare(hole)
    return any(hole.covers(shapely.Polygon(lies + [shift, 0.0])) for shift in shifts)


def _over_the_edge(device, track):
    """Whether what is cut away goes on over the free edge all along."""
    span = device.span_on(track)
    return span is not None and span[1] >= track.extent - 1e-9


def _slips(one, span):
    """Whether no tilt of a part rests on both sides of a hole along the track, over which it slides on."""
    seen = shapely.affinity.translate(one.seen, -one.distance, -one.posture.height)
    near = max(span[0], 0.0)
    return not between_edges.may_rest(seen, span[1] - near, 0.0, span[0] <= 0.0)


def _drops_between(one, cut):
    """Whether no tilt of a part ahead rests on both edges across the track of a hole as wide as the part."""
    hole = shapely.make_valid(_open(np.asarray(cut, float), one.track.width))
    low, high = one.distance + one.outline[:, 1].min(), one.distance + one.outline[:, 1].max()
    least = min(
        hole.intersection(shapely.box(-FAR, y - ONE_LINE, FAR, y + ONE_LINE)).area / (2.0 * ONE_LINE)
        for y in np.linspace(max(low, ONE_LINE), high - ONE_LINE, PIECES)
    )
    seen = shapely.affinity.translate(one.aside, 0.0, -one.posture.height)
    return least > 0.0 and not between_edges.may_rest(seen, least, one.grip)


def _open(cut, width):
    """The hole as a polygon, beyond the track's free edge where it reaches it."""
    free = cut[:, 1] >= width - 1e-9
    return shapely.Polygon(
        np.column_stack([cut[:, 0], np.where(free, cut[:, 1] + OPEN_HOLE_OVERRUN_M, cut[:, 1])])
    )


@functools.lru_cache(maxsize=512)
def _shadows(one):
    """Convex outlines (K, 2) [m] from above, as it lies and as it tips, and their sizes (S, 2) [m]."""
    shadows = list(_tipped(one))
    return shadows, np.array([np.ptp(shadow, axis=0) for shadow in shadows])


def _tipped(one):
    points = one.posture.corners
    size = np.ptp(points, axis=0).max()
    c, s = np.cos(one.heading), np.sin(one.heading)
    x, y, z = c * points[:, 0] - s * points[:, 1], s * points[:, 0] + c * points[:, 1], points[:, 2]
    for tilt in np.linspace(0.0, 0.5 * np.pi, FALL_TILTS):
        way = np.linspace(0.0, 2.0 * np.pi, AZIMUTHS, endpoint=False)[: None if tilt > 0.0 else 1, None]
        a, b = np.cos(way), np.sin(way)
        along = (a * x + b * y) * np.cos(tilt) + z * np.sin(tilt)
        beside = -b * x + a * y
        shadows = np.stack([a * along - b * beside, b * along + a * beside], axis=-1)
        rings = shapely.simplify(
            shapely.convex_hull(shapely.multipoints(shadows)), SHADOW_DETAIL_SHARE * size
        )
        yield from (shapely.get_coordinates(ring)[:-1] for ring in rings)


def _sides(part):
    """Half-planes (K, 3) [1, 1, m] that bound a convex polygon: normals and distances; None of another."""
    if part.interiors or part.area < (1.0 - RECTANGLE_TOLERANCE) * part.convex_hull.area:
        return None
    ring = shapely.get_coordinates(shapely.geometry.polygon.orient(part).exterior)
    along = np.diff(ring, axis=0)
    length = np.hypot(*along.T)
    normal = np.column_stack([along[:, 1], -along[:, 0]])[length > 0.0] / length[length > 0.0, None]
    return np.column_stack([normal, (normal * ring[:-1][length > 0.0]).sum(axis=1)])


def _fits(shadow, part, sides):
    """Whether a convex shadow can be moved to lie within a polygon."""
    return _fits_between(shadow, sides) if sides is not None else _fits_within(shadow, part)


def _fits_between(shadow, sides):
    """Whether it can be moved to lie within half-planes: some corner of where it may be moved to exists."""
    (a, b), c = sides[:, :2].T, sides[:, 2]
    room = c - (a[:, None] * shadow[:, 0] + b[:, None] * shadow[:, 1]).max(axis=1)
    one, other = np.triu_indices(len(sides), 1)
    turn = a[one] * b[other] - b[one] * a[other]
    one, other, turn = (k[np.abs(turn) > PARALLEL_SINE] for k in (one, other, turn))
    x = (room[one] * b[other] - b[one] * room[other]) / turn
    y = (a[one] * room[other] - room[one] * a[other]) / turn
    return bool((a[:, None] * x + b[:, None] * y <= room[:, None] + FIT_TOLERANCE_M).all(axis=0).any())


def _fits_within(shadow, part):
    """Whether it can be moved to lie within any polygon: what is left of it beside its own border."""
    shadow = shadow - shadow.mean(axis=0)
    rings = [part.exterior, *part.interiors]
    sides = np.concatenate([np.stack([r[:-1], r[1:]], axis=1) for r in map(shapely.get_coordinates, rings)])
    swept = np.concatenate([sides[:, :1] - shadow, sides[:, 1:] - shadow], axis=1)
    border = shapely.union_all(shapely.convex_hull(shapely.multipoints(swept)))
    return not part.difference(border).is_empty
