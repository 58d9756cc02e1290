"""What becomes of a part that a device does not carry: it falls through, rests or is held beside its foot."""

import functools
import itertools
import math
from collections.abc import Iterator
from typing import Any

import numpy as np
import shapely
import shapely.affinity

from feederscrew.geometry.polygons import cross, outline, sides, turned
from feederscrew.tooling.devices.openings import WALL_OVERCUT_M
from feederscrew.tooling.orientations import CUT_BORDER_RADIUS_M, neck, rolls_across, shoulder_margin

FOREMOST_TOLERANCE = 1e-6  # of the part's height: places so near to the foremost one are met with it
WALL_CONTACT_SHARE = 1e-2  # of the part's height: places so near to the wall lean on it
BEYOND_FOOT_M = 10.0  # [m] beyond any foot
LEVER = 0.1  # of the length, from the head to the weight: in trials those with 0.15 hang, with 0.04 not
OFF_WALL = 9e-5  # [m] by which a head that hangs stays off the wall at least


def may_lay_over(orientation, low):
    """Return whether a blade across the track may lay a part over instead of holding it up.

    Source: moments about the rear side of the foot, Coulomb's friction; docs/tooling.md,
    "1. The method".

    Parameters
    ----------
    orientation : Orientation
        That travels: it knows the friction of its track.
    low : float [m]
        Height of the blade's edge, or from which on an opening is too narrow.

    Returns
    -------
    bool
        False where friction cannot: it is held up as it lies.

    Notes
    -----
    In the mean over strokes the track pushes with at most mu N, N being the weight and what the blade presses
    down by its own friction; the blade pushes back as much, at the height z of the foremost place over its
    edge, which lies L before the rear side of the foot. The part tips backwards over that side, b behind the
    weight, where F (z - mu L) + h sin(climb) > b cos(climb), F (1 - mu^2) = mu cos(climb) - sin(climb) in
    weights. More than the mean no drive can push for long; a real one pushes less.
    """
    ahead, height = _first_contact(orientation, low)
    behind = _behind(orientation)
    mu, c, s = orientation.grip, math.cos(orientation.track.climb), math.sin(orientation.track.climb)
    lever = height - mu * (behind + ahead)
    if mu >= 1.0 or mu * c <= s:  # nothing limits the push, or there is none
        return mu * c > s and lever > 0.0
    return (mu * c - s) / (1.0 - mu * mu) * lever + orientation.posture.height * s > behind * c


def may_lay_aside(orientation, low, sweep) -> bool:
    """Return whether a swept blade may lay a part over towards the free edge as it slides along the face.

    Source: moments about a side of the foot, Coulomb's friction; docs/tooling.md, "1. The method".

    Parameters
    ----------
    orientation : Orientation
        That travels.
    low : float [m]
        Height of the blade's edge.
    sweep : float [rad]
        Of its face to the direction of travel.

    Notes
    -----
    The face pushes across itself, back and towards the free edge, with no more than the track drags: mu N.
    Over a side of the foot, b from the weight and with its normal at an angle a to that push, the part tips
    where mu z cos(a) > b, z the height of the edge.
    """
    foot_sides = _foot_sides(orientation)
    if foot_sides is None:
        return True
    away, reach = foot_sides
    push = away[:, 1] * math.cos(sweep) - away[:, 0] * math.sin(sweep)
    return bool((orientation.grip * low * push > reach).any())


def may_turn_and_lie_over(orientation, low):
    """Return whether a swept blade may lay a part over once it has turned along the face.

    Source: ``may_lay_aside`` with a side of the foot along the face; docs/tooling.md, "1. The method".

    Parameters
    ----------
    orientation : Orientation
        That travels.
    low : float [m]
        Height of the blade's edge.

    Notes
    -----
    What slides along a blade turns until a side of it lies there, whichever comes: the push of
    ``may_lay_aside`` is then square to some side of the foot, and tips it over the nearest where mu z > b.
    """
    foot_sides = _foot_sides(orientation)
    return foot_sides is None or bool((orientation.grip * low > foot_sides[1]).any())


def _foot_sides(orientation) -> tuple[Any, ...] | None:
    """Normals (K, 2) of the sides of a foot and their distances (K,) [m] from its weight; None of a line."""
    hull = shapely.MultiPoint(orientation.foot.corners).convex_hull
    if hull.geom_type != "Polygon":
        return None
    corners = shapely.get_coordinates(shapely.geometry.polygon.orient(hull))
    sides = np.diff(corners, axis=0)
    away = np.column_stack([sides[:, 1], -sides[:, 0]]) / np.hypot(*sides.T)[:, None]
    return away, away[:, 0] * corners[:-1, 0] + away[:, 1] * corners[:-1, 1]


def may_wedge(orientation, span):
    """Return whether a head that comes first may stick between rails as a wedge.

    Source: a wedge between two angles of friction; docs/tooling.md, "1. The method".

    Parameters
    ----------
    orientation : Orientation
        That travels, its head ahead of the shank.
    span : (float, float) [m]
        Of the slot, from the wall.

    Returns
    -------
    bool
        Whether both sides on which the head rests are steep enough together: friction then holds whatever
        presses it in, and the shank's weight need not turn it down.
    """
    outward = turned(orientation.posture.surface[:, :2], orientation.heading)[:, 1]
    ring = outline(np.column_stack([outward, orientation.posture.surface[:, 2]]))
    after = np.roll(ring, -1, axis=0)
    under = after[:, 0] > ring[:, 0]  # counter-clockwise: the lower half runs to the right
    start, end = ring[under], after[under]
    lean = 0.0
    for side in span:
        edge = side - orientation.distance
        spans_edge = (start[:, 0] <= edge) & (edge < end[:, 0])
        if not spans_edge.any():
            return False
        (run, rise) = (end - start)[np.argmax(spans_edge)]
        lean += math.atan2(run, abs(rise))
    return lean <= 2.0 * math.atan(orientation.grip)


def hangs_free(orientation, span):
    """Return whether a head that hangs in a slot stays off the wall, and its weight turns the shank down.

    Source: own; docs/tooling.md, "1. The method": what touches rail and wall at once may wedge.
    """
    headed = neck(orientation)
    return headed is not None and too_near(headed, span) <= 0.0 and headed.lever >= LEVER * orientation.length


def too_near(headed, span):
    """Return how much farther [m] from the wall a slot must be for a head not to touch it, 0 if it is."""
    return max(OFF_WALL - span[0] - 0.5 * (headed.shank - headed.widest), 0.0)


def wall_holds(orientation, width):
    """Return by how much [m] a canyon may be wider than a part passes by its foot, and still let it through.

    Source: own; docs/tooling.md, "1. The method": the wall holds what turns towards it.

    Parameters
    ----------
    orientation : Orientation
        That travels.
    width : float [m]
        Of the strip removed along the wall.

    Notes
    -----
    The weight lies x over the strip and turns the part towards the wall, on which it leans at height H while
    its foot slides out over the edge of the strip. Its centre of mass, at height h, thereby rises by
    (2 H - h) angle^2 / 2 - x angle: without any friction it comes to rest at the angle x / (2 H - h), and
    with friction sooner. So it dips into the strip by ``width`` times that, and is held at the strip's end
    unless that is less than ``one.climbs``.
    """
    points = orientation.posture.surface
    across = turned(points[:, :2], orientation.heading)[:, 1]
    high = points[across <= across.min() + WALL_CONTACT_SHARE * orientation.height, 2].max()
    return max(orientation.climbs * (2.0 * high - orientation.posture.height) / width, 0.0)


def rides_over(orientation, width, length):
    """Return whether a part on its round side along the track rides over a hole by its sides.

    Source: own; docs/tooling.md, "1. The method".

    Parameters
    ----------
    orientation : Orientation
        That travels.
    width, length : float [m]
        Of the hole across and along the track; infinite length of one that goes on.

    Notes
    -----
    It sinks between the sides by radius - sqrt(radius^2 - width^2 / 4), and comes out at the end of the hole
    where the speed of the drive lifts its weight far enough. Over a hole that is shorter than the part it
    dips, tilted over the edge that it leaves; its weight then rises by (length - ahead) / length of that, a
    part that reaches ahead of its weight by so much.
    """
    radius = orientation.posture.height
    if orientation.kind != "rolling" or rolls_across(orientation) or width >= 2.0 * radius:
        return False
    places = orientation.foot.corners[:, 0]
    share = 1.0 - float(places.max()) / length if length < np.ptp(places) else 1.0
    sunk = radius - math.sqrt(radius**2 - 0.25 * width**2)
    return share * (sunk - CUT_BORDER_RADIUS_M) < orientation.climbs - CUT_BORDER_RADIUS_M


def greatest_width(corners):
    """Return the greatest width [m] across the track of a hole with some corners (K, 2) [m]."""
    area = shapely.Polygon(corners)
    lines = [shapely.LineString([(x, -BEYOND_FOOT_M), (x, BEYOND_FOOT_M)]) for x, _ in corners]
    return max(area.intersection(line).length for line in lines)


def _first_contact(orientation, low) -> tuple[Any, ...]:
    """How far ahead of the weight a part reaches over a height [m], and at which height it first does so."""
    points, faces = orientation.posture.surface, orientation.posture.solid.faces
    ahead, height = turned(points[:, :2], orientation.heading)[:, 0], points[:, 2]
    a, b = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]).T
    crossed = (height[a] > low) != (height[b] > low)
    a, b = a[crossed], b[crossed]
    share = (low - height[a]) / (height[b] - height[a])
    reach = np.concatenate([ahead[height >= low], ahead[a] + share * (ahead[b] - ahead[a])])
    level = np.concatenate([height[height >= low], np.full(len(a), low)])
    return float(reach.max()), float(
        level[reach >= reach.max() - FOREMOST_TOLERANCE * orientation.height].min()
    )


def _behind(orientation):
    """Way [m] from where the weight meets the track back to the border of the supported hull."""
    hull = shapely.MultiPoint(orientation.foot.corners).convex_hull
    rearward = hull.intersection(
        shapely.LineString([(0.0, -orientation.shift), (-BEYOND_FOOT_M, -orientation.shift)])
    )
    least = orientation.foot.corners[:, 0].min() if rearward.is_empty else rearward.bounds[0]
    return max(float(-least), 0.0)


REST_TILTS = 60  # steps of a tilt up to a right angle, to either side
CONVEX_FILL_SHARE = 0.99  # of its convex outline: a part that fills less may catch an edge by its own corners
FORCE_SHARE_TOLERANCE = 1e-12  # of a share of a force


def may_rest(section, width, friction, wall=False) -> bool:
    """Return whether a part may come to rest between two edges, tilted some way.

    Source: Coulomb's cones at two edges; docs/method/trial.md, "What other parts said of the rules".

    Parameters
    ----------
    section : shapely geometry
        What is seen of it along the edges, its centre of mass at (0, any height) [m]; see ``centred``.
    width : float [m]
        Between the edges.
    friction : float [1]
        At both edges: none of those along which the part slides, since the track shakes.
    wall : bool
        Whether a wall stands in place of the first edge, on which the part leans at any height.

    Returns
    -------
    bool
        True also of one that is not convex as it is seen: it may catch an edge by a corner of its own.

    Notes
    -----
    Two edges: the part hangs by the chord of its outline that is as long as the hole is wide. With a wall,
    what is foremost leans on it. With friction the force at each edge lies within the cone about the side of
    the part that it meets; without, the part settles where its centre of mass is lowest. Statics alone: the
    shaking of the drive and what speed is left only loosen it.
    """
    hull = section.convex_hull
    if section.area < CONVEX_FILL_SHARE * hull.area:
        return True
    ring = outline(shapely.get_coordinates(hull))
    tilts = np.linspace(-0.5 * np.pi, 0.5 * np.pi, 2 * REST_TILTS + 1)
    supports = [(_leans if wall else _bridges)(turned(ring, turn), width) for turn in tilts]
    if friction > 0.0:
        return any(two is not None and _holds(two, friction) for two in supports)
    heights = np.array([np.inf if two is None else -two[1][0][1] for two in supports])
    return _settles(np.where(np.isinf(heights), -np.inf, heights), 1e-9 * np.ptp(ring, axis=0).max())


def _settles(heights, same) -> bool:
    """Whether the height of a centre of mass has a lowest place among tilts at which the part is held."""
    around = np.concatenate([[np.inf], heights, [np.inf]])
    lowest = (heights <= around[:-2] + same) & (heights <= around[2:] + same)
    return bool((lowest & np.isfinite(heights)).any())


def _leans(ring, width) -> tuple[Any, ...] | None:
    """Where a convex outline touches a wall and an edge at some distance from it, as ``_bridges``."""
    place = ring[:, 0].min() + width
    if ring[:, 0].max() <= place:
        return None
    foremost = ring[int(np.argmin(ring[:, 0]))]
    along = sides(ring)
    under = np.flatnonzero((along[:, 0] > 0.0) & (ring[:, 0] <= place) & (place < ring[:, 0] + along[:, 0]))
    k = int(under[0])
    on = ring[k] + along[k] * (place - ring[k, 0]) / along[k, 0]
    normal = np.array([-along[k, 1], along[k, 0]]) / np.hypot(*along[k])
    return (foremost, np.array([1.0, 0.0])), (on, normal)


def _bridges(ring, width) -> tuple[Any, ...] | None:
    """Where a convex outline lies on two edges: (point, normal into the part) of both; None: it goes through.

    Its lower level chord is as long as the edges are apart.
    """
    levels = np.unique(ring[:, 1])
    spans = _spans(ring, levels)
    wide = np.flatnonzero(spans >= width)
    if not len(wide):
        return None
    level, k = levels[0], int(wide[0])
    if k > 0:
        share = (width - spans[k - 1]) / (spans[k] - spans[k - 1])
        level = levels[k - 1] + share * (levels[k] - levels[k - 1])
    places, normals = _at(ring, level)
    return tuple((np.array([places[end], level]), normals[end]) for end in (places.argmin(), places.argmax()))


def _spans(ring, levels):
    """Return how long (L,) the chords of a convex outline at some levels (L,) are: as ``_at`` has them."""
    along, start = sides(ring), ring[:, 1]
    low, high = np.minimum(start, start + along[:, 1]), np.maximum(start, start + along[:, 1])
    crosses = (low <= levels[:, None]) & (levels[:, None] <= high)
    rise = np.where(along[:, 1] == 0.0, 1.0, along[:, 1])
    share = np.clip((levels[:, None] - start) / rise, 0.0, 1.0)
    places = ring[:, 0] + share * along[:, 0]
    return np.where(crosses, places, -np.inf).max(axis=1) - np.where(crosses, places, np.inf).min(axis=1)


def _at(ring, level) -> tuple[Any, ...]:
    """Where the sides of a convex outline meet a level, and their normals into it."""
    along, start = sides(ring), ring[:, 1]
    low, high = np.minimum(start, start + along[:, 1]), np.maximum(start, start + along[:, 1])
    crosses = (low <= level) & (level <= high)
    rise = np.where(along[crosses, 1] == 0.0, 1.0, along[crosses, 1])
    share = np.clip((level - start[crosses]) / rise, 0.0, 1.0)
    normals = np.column_stack([-along[crosses, 1], along[crosses, 0]]) / np.hypot(*along[crosses].T)[:, None]
    return ring[crosses, 0] + share * along[crosses, 0], normals


def _holds(two, friction) -> bool:
    """Whether forces within cones of friction at two places hold a weight at (0, any height)."""
    wrenches = []
    for point, normal in two:
        for side in (-1.0, 1.0):
            push = turned(normal, side * np.arctan(friction))
            wrenches.append([*push, cross(point, push)])
    rows, weight = np.array(wrenches), np.array([0.0, 1.0, 0.0])
    size = np.abs(rows[:, 2]).max()
    rows[:, 2] /= size if size > 0.0 else 1.0
    for three in itertools.combinations(rows, 3):
        basis = np.array(three)
        if abs(_det(basis)) < FORCE_SHARE_TOLERANCE:
            continue
        if (_shares(basis, weight) >= -FORCE_SHARE_TOLERANCE).all():
            return True
    return False


def _det(basis):
    a, b, c = basis
    return (
        a[0] * (b[1] * c[2] - b[2] * c[1])
        - a[1] * (b[0] * c[2] - b[2] * c[0])
        + a[2] * (b[0] * c[1] - b[1] * c[0])
    )


def _shares(basis, weight) -> np.ndarray:
    """How much of each of three wrenches makes a weight: Cramer's rule."""
    whole = _det(basis)
    return np.array([_det(np.where(np.arange(3)[:, None] == k, weight, basis)) / whole for k in range(3)])


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


def falls_through(orientation, cut) -> bool:
    """Return whether a hole lets an orientation through that it does not carry.

    Source: own; docs/tooling.md, "1. The method": what becomes of a part that does not pass.

    Parameters
    ----------
    orientation : Orientation
    cut : (K, 2) float [m]
        Unrolled: lengths along the wall and distances from it.

    Returns
    -------
    bool
        Whether the shadow of the part, tipped some way by up to a right angle, lies in the hole with
        ``SHADOW_CLEARANCE_M`` around it. Where it is tipped by less than that way, it is still on its way
        down over the edge that it leaves. What goes over the track's free edge is gone.
    """
    hole = shapely.make_valid(_open(np.asarray(cut, float), orientation.track.width)).buffer(
        -SHADOW_CLEARANCE_M, join_style="mitre"
    )
    if hole.is_empty:
        return False
    shadows, sizes = _shadows(orientation)
    extent = np.subtract(hole.bounds[2:], hole.bounds[:2])
    may = np.flatnonzero((sizes <= extent).all(axis=1))
    if hole.area > (1.0 - RECTANGLE_TOLERANCE) * extent.prod():  # it is a rectangle
        return bool(len(may))
    parts = [(part, _sides(part)) for part in shapely.get_parts(hole)]
    return any(_fits(shadows[k], *part) for k in may for part in parts)


def lets_go(device, orientation):
    """Return whether what a device cuts away lets an orientation go for certain that it does not carry.

    Parameters
    ----------
    device : Device
    orientation : Orientation
        That travels.

    Returns
    -------
    bool
        Whether the part goes over the free edge, or through a hole along the track as it lies, or down
        between two edges where no tilt of it can rest on them. True of a device that cuts nothing.
    """
    cut = device.outline_on(
        orientation.track,
        HOLE_LENGTHS * float(np.hypot(orientation.length, max(orientation.width, orientation.height))),
    )
    if cut is None or _over_the_edge(device, orientation.track):
        return True
    span = device.span_on(orientation.track)
    if span is not None and span[0] > 0.0 and shoulder_margin(orientation, span) >= 0.0:
        return False
    if span is None:
        return falls_through(orientation, cut) and _drops_between(orientation, cut)
    return fits_as_it_lies(orientation, cut) or (
        falls_through(orientation, cut) and _slips(orientation, span)
    )


@functools.lru_cache(maxsize=8192)
def surely_gone(device, orientation):
    """Return whether an orientation that a device does not let pass is surely returned by it.

    Source: own; docs/tooling.md, "1. The method".

    Parameters
    ----------
    device : Device
    orientation : Orientation
        That travels.

    Returns
    -------
    bool
        Whether it is let go of for certain, and does not turn along a swept blade that then lays it over.
    """
    turned = device.face is not None and may_turn_and_lie_over(orientation, device.limit)
    return lets_go(device, orientation) and not turned


def fits_as_it_lies(orientation, cut) -> bool:
    """Return whether an orientation fits through a hole as it lies, somewhere on its way over it.

    Parameters
    ----------
    one, cut
        As for ``falls_through``.
    """
    hole = shapely.make_valid(_open(np.asarray(cut, float), orientation.track.width))
    behind = shapely.affinity.translate(hole, 0.0, -WALL_OVERCUT_M) if hole.bounds[1] <= 0.0 else hole
    hole = hole.union(behind).buffer(-SHADOW_CLEARANCE_M, join_style="mitre")
    border = shapely.segmentize(shapely.linearrings(orientation.outline), orientation.length / PIECES)
    ahead, across = shapely.get_coordinates(border).T
    middle, radius = orientation.track.radius - orientation.distance, orientation.track.radius
    away = np.hypot(ahead, middle - across)
    lies = np.column_stack([radius * np.arctan2(ahead, middle - across), radius - away])
    if hole.is_empty or np.ptp(lies[:, 0]) > hole.bounds[2] - hole.bounds[0]:
        return False
    shifts = np.linspace(hole.bounds[0] - lies[:, 0].min(), hole.bounds[2] - lies[:, 0].max(), PLACES)
    shapely.prepare(hole)
    return any(hole.covers(shapely.Polygon(lies + [shift, 0.0])) for shift in shifts)


def _over_the_edge(device, track):
    """Whether what is cut away goes on over the free edge all along."""
    span = device.span_on(track)
    return span is not None and span[1] >= track.extent - 1e-9


def _slips(orientation, span) -> bool:
    """Whether no tilt of a part rests on both sides of a hole along the track, over which it slides on."""
    silhouette = shapely.affinity.translate(
        orientation.view_ahead, -orientation.distance, -orientation.posture.height
    )
    near = max(span[0], 0.0)
    return not may_rest(silhouette, span[1] - near, 0.0, span[0] <= 0.0)


def _drops_between(orientation, cut):
    """Whether no tilt of a part ahead rests on both edges across the track of a hole as wide as the part."""
    hole = shapely.make_valid(_open(np.asarray(cut, float), orientation.track.width))
    low, high = (
        orientation.distance + orientation.outline[:, 1].min(),
        orientation.distance + orientation.outline[:, 1].max(),
    )
    least = min(
        hole.intersection(shapely.box(-FAR, y - ONE_LINE, FAR, y + ONE_LINE)).area / (2.0 * ONE_LINE)
        for y in np.linspace(max(low, ONE_LINE), high - ONE_LINE, PIECES)
    )
    side_view = shapely.affinity.translate(orientation.aside, 0.0, -orientation.posture.height)
    return least > 0.0 and not may_rest(side_view, least, orientation.grip)


def _open(cut, width):
    """The hole as a polygon, beyond the track's free edge where it reaches it."""
    free = cut[:, 1] >= width - 1e-9
    return shapely.Polygon(
        np.column_stack([cut[:, 0], np.where(free, cut[:, 1] + OPEN_HOLE_OVERRUN_M, cut[:, 1])])
    )


@functools.lru_cache(maxsize=512)
def _shadows(orientation) -> tuple[Any, ...]:
    """Convex outlines (K, 2) [m] from above, as it lies and as it tips, and their sizes (S, 2) [m]."""
    shadows = list(_tipped(orientation))
    return shadows, np.array([np.ptp(shadow, axis=0) for shadow in shadows])


def _tipped(orientation) -> Iterator[Any]:
    points = orientation.posture.corners
    size = np.ptp(points, axis=0).max()
    c, s = np.cos(orientation.heading), np.sin(orientation.heading)
    x, y, z = c * points[:, 0] - s * points[:, 1], s * points[:, 0] + c * points[:, 1], points[:, 2]
    for tilt in np.linspace(0.0, 0.5 * np.pi, FALL_TILTS):
        azimuths = np.linspace(0.0, 2.0 * np.pi, AZIMUTHS, endpoint=False)[: None if tilt > 0.0 else 1, None]
        a, b = np.cos(azimuths), np.sin(azimuths)
        along = (a * x + b * y) * np.cos(tilt) + z * np.sin(tilt)
        across = -b * x + a * y
        shadows = np.stack([a * along - b * across, b * along + a * across], axis=-1)
        rings = shapely.simplify(
            shapely.convex_hull(shapely.multipoints(shadows)), SHADOW_DETAIL_SHARE * size
        )
        yield from (shapely.get_coordinates(ring)[:-1] for ring in rings)


def _sides(part) -> np.ndarray | None:
    """Half-planes (K, 3) [1, 1, m] that bound a convex polygon: normals and distances; None of another."""
    if part.interiors or part.area < (1.0 - RECTANGLE_TOLERANCE) * part.convex_hull.area:
        return None
    ring = shapely.get_coordinates(shapely.geometry.polygon.orient(part).exterior)
    along = np.diff(ring, axis=0)
    length = np.hypot(*along.T)
    normal = np.column_stack([along[:, 1], -along[:, 0]])[length > 0.0] / length[length > 0.0, None]
    return np.column_stack([normal, (normal * ring[:-1][length > 0.0]).sum(axis=1)])


def _fits(shadow, part, sides) -> bool:
    """Whether a convex shadow can be moved to lie within a polygon."""
    return _fits_between(shadow, sides) if sides is not None else _fits_within(shadow, part)


def _fits_between(shadow, sides) -> bool:
    """Whether it can be moved to lie within half-planes: some corner of where it may be moved to exists."""
    (a, b), c = sides[:, :2].T, sides[:, 2]
    room = c - (a[:, None] * shadow[:, 0] + b[:, None] * shadow[:, 1]).max(axis=1)
    orientation, other = np.triu_indices(len(sides), 1)
    turn = a[orientation] * b[other] - b[orientation] * a[other]
    orientation, other, turn = (k[np.abs(turn) > PARALLEL_SINE] for k in (orientation, other, turn))
    x = (room[orientation] * b[other] - b[orientation] * room[other]) / turn
    y = (a[orientation] * room[other] - room[orientation] * a[other]) / turn
    return bool((a[:, None] * x + b[:, None] * y <= room[:, None] + FIT_TOLERANCE_M).all(axis=0).any())


def _fits_within(shadow, part) -> bool:
    """Whether it can be moved to lie within any polygon: what is left of it beside its own border."""
    shadow = shadow - shadow.mean(axis=0)
    rings = [part.exterior, *part.interiors]
    sides = np.concatenate([np.stack([r[:-1], r[1:]], axis=1) for r in map(shapely.get_coordinates, rings)])
    swept = np.concatenate([sides[:, :1] - shadow, sides[:, 1:] - shadow], axis=1)
    border = shapely.union_all(shapely.convex_hull(shapely.multipoints(swept)))
    return not part.difference(border).is_empty
