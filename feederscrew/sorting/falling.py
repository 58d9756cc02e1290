"""What becomes of a part that a device does not carry: it falls through, rests, is held beside its foot, or
slides along the face of a blade off the free edge.

Source: docs/tooling.md, "What becomes of a part that does not pass".
"""

import functools
import itertools
import math
from typing import cast

import numpy as np
import shapely
import shapely.affinity

from feederscrew.base.arrays import Bools, Floats, Points, Vector
from feederscrew.base.errors import FeederError
from feederscrew.base.geometry.polygons import cross, outline, sides, turned
from feederscrew.bowl.devices.base import Device, opening_at
from feederscrew.bowl.devices.openings import WALL_OVERCUT_M
from feederscrew.bowl.record import Bowl
from feederscrew.resting.posture import Posture
from feederscrew.sorting import footprints
from feederscrew.sorting.orientations import CUT_BORDER_RADIUS_M, Neck, Orientation, neck, shoulder_margin

FOREMOST_TOLERANCE = 1e-6  # of the part's height: places so near to the foremost one are met with it
WALL_CONTACT_SHARE = 1e-2  # of the part's height: places so near to the wall lean on it
FAR = 10.0  # [m] beyond any foot and along any hole
LEVER = 0.1  # of the length, from the head to the weight: in trials those with 0.15 hang, with 0.04 not
OFF_WALL = 9e-5  # [m] by which a head that hangs stays off the wall at least
REST_TILTS = 60  # steps of a tilt up to a right angle, to either side
CONVEX_FILL_SHARE = 0.99  # of its convex outline: a part that fills less may catch an edge by its own corners
FORCE_SHARE_TOLERANCE = 1e-12  # of a share of a force
AZIMUTHS, FALL_TILTS = 8, 10  # ways it can tip: about level axes all round, by steps up to a right angle
SHADOW_CLEARANCE_M = 2.5e-4  # [m] a hole is larger than the shadow that goes through it, all round
OPEN_HOLE_OVERRUN_M = 0.1  # [m] a hole that is open at the track's free edge goes on so far
RECTANGLE_TOLERANCE = 1e-9  # of its box or its hull: what covers all but this, is a rectangle or convex
PARALLEL_SINE = 1e-9  # sine between two sides that do not meet
FIT_TOLERANCE_M = 1e-12  # [m] by which what fits may stand out
SHADOW_DETAIL_SHARE = 2e-4  # of the part's size: corners of a shadow that stand out by less are left out
ONE_LINE = 1e-6  # [m] half the width of a line across which a hole is measured
PLACES, PIECES = 200, 8  # along a hole at which a part is tried; of a side of its outline
PERIODS, SETTLED = 60, 20  # of the drive, in all and until the motion along a blade is taken
CLEARING_STEPS = 240  # of one period
RESTS = 4.0  # of what gravity gives in a step: what comes down more slowly rests on the track
AIR_DECIMALS = 4  # of what air gives [m/s2]: speeds along a blade are kept
REST_SPEED = 1e-6  # [m/s] what slides more slowly does not leave

Supports = list[tuple[Vector, Vector]]  # two edges: a point [m], and the normal into the part [1]


# -- what a blade holds up, or lays over


def may_lay_over(orientation: Orientation, low: float) -> bool:
    """Tell whether a blade across the track may lay a part over instead of holding it up.

    The track pushes the part with friction mu; it turns about the rear side of its foot where the moment of
    the push at the blade is beyond that of the weight:

        (mu cos(climb) - sin(climb)) / (1 - mu^2) (z - mu (b + a)) + h sin(climb) > b cos(climb),

    z the height at which the part first meets the blade, a how far ahead of the weight that is, b how far
    behind it the rear side of the foot, h the height of the centre of mass. With mu of 1 or more nothing
    limits the push, and z - mu (b + a) > 0 decides alone.

    Parameters
    ----------
    orientation : Orientation
        It travels: it knows its track's friction.
    low : float [m]
        Height of the blade's edge, or from which on an opening is too narrow.

    Returns
    -------
    bool

    References
    ----------
    Moments about the rear side of the foot, Coulomb's friction; docs/tooling.md, "1. The method".
    """
    # how far ahead of the weight it reaches over the edge, and at which height it first does so
    points = orientation.posture.surface
    forward, height = turned(points[:, :2], orientation.heading)[:, 0], points[:, 2]
    a, b = footprints.edges_of(orientation.posture).T
    crossed = (height[a] > low) != (height[b] > low)
    a, b = a[crossed], b[crossed]
    share = (low - height[a]) / (height[b] - height[a])
    reach = np.concatenate([forward[height >= low], forward[a] + share * (forward[b] - forward[a])])
    level = np.concatenate([height[height >= low], np.full(len(a), low)])
    ahead = float(reach.max())
    first = float(level[reach >= reach.max() - FOREMOST_TOLERANCE * orientation.height].min())
    # the way from where the weight meets the track back to the border of the supported hull
    corners, shift = orientation.foot.corners, orientation.shift
    line = shapely.LineString([(0.0, -shift), (-FAR, -shift)])
    rearward = shapely.MultiPoint(corners).convex_hull.intersection(line)
    behind = max(float(-(corners[:, 0].min() if rearward.is_empty else rearward.bounds[0])), 0.0)
    mu, c, s = orientation.grip, math.cos(orientation.track.climb), math.sin(orientation.track.climb)
    lever = first - mu * (behind + ahead)
    if mu >= 1.0 or mu * c <= s:  # nothing limits the push, or there is none
        return mu * c > s and lever > 0.0
    return (mu * c - s) / (1.0 - mu * mu) * lever + orientation.posture.height * s > behind * c


def may_lay_aside(orientation: Orientation, low: float, sweep: float | None = None) -> bool:
    """Tell whether a swept blade may lay a part over towards the free edge as it slides along the face.

    A part that slides along a blade turns until a side of it lies there, whichever comes: without a ``sweep``
    the push is square to some side, and tips it over the nearest. It tips over a side of the foot where mu z
    times the share of the push across that side is beyond the way from the weight to the side.

    Parameters
    ----------
    orientation : Orientation
        It travels: it knows its track's friction mu.
    low : float [m]
        Height z of the blade's edge.
    sweep : float [rad], optional
        Of its face to the direction of travel.

    Returns
    -------
    bool
        True also of a foot without an area.

    References
    ----------
    Moments about a side of the foot, Coulomb's friction; docs/tooling.md, "1. The method".
    """
    hull = shapely.MultiPoint(orientation.foot.corners).convex_hull
    if hull.geom_type != "Polygon":
        return True
    corners = shapely.get_coordinates(shapely.geometry.polygon.orient(hull))
    along = np.diff(corners, axis=0)
    away = np.column_stack([along[:, 1], -along[:, 0]]) / np.hypot(*along.T)[:, None]
    reach = away[:, 0] * corners[:-1, 0] + away[:, 1] * corners[:-1, 1]
    push = 1.0 if sweep is None else away[:, 1] * math.cos(sweep) - away[:, 0] * math.sin(sweep)
    return bool((orientation.grip * low * push > reach).any())


def clearing_limit(friction: float) -> float:
    """Return the sweep below which a swept face clears itself: 90 deg less the angle of friction.

    Parameters
    ----------
    friction : float [1]
        Of the face.

    Returns
    -------
    float [rad]

    References
    ----------
    docs/tooling.md, "1. The method".
    """
    return 0.5 * math.pi - math.atan(friction)


def clearing_time(device: Device, orientation: Orientation, bowl: Bowl) -> float:
    """Return how long an orientation that a device returns blocks the track.

    It is the way from the weight to the free edge over the velocity along the blade. Air along the blade
    adds its force where that is least; no part is gone sooner than one that starts from rest with that alone.

    Parameters
    ----------
    device : Device
    orientation : Orientation
    bowl : Bowl

    Returns
    -------
    float [s]
        0 of a device without a face: what it returns drops at once. Infinite where nothing slides along it.

    Raises
    ------
    FeederError
        If the motion along the blade has no end.

    References
    ----------
    docs/tooling.md, "1. The method".
    """
    if device.face is None:
        return 0.0
    sweep, friction = device.face
    along, off = device.force_along_face(orientation)
    if along or off:  # over the mass
        along, off = along / orientation.posture.mass, off / orientation.posture.mass
    grip = bowl.friction.static if friction is None else friction
    speed = along_blade(bowl, sweep, grip, (round(along, AIR_DECIMALS), round(off, AIR_DECIMALS)))
    distance = max(orientation.track.width - orientation.distance, 0.0)
    if not speed > REST_SPEED:
        return math.inf
    inwards = along * math.sin(sweep) + off * math.cos(sweep)
    return max(distance / speed, math.sqrt(2.0 * distance / inwards) if inwards > 0.0 else 0.0)


@functools.lru_cache(maxsize=64)
def along_blade(bowl: Bowl, sweep: float, friction: float, air: tuple[float, float] = (0.0, 0.0)) -> float:
    """Return the mean velocity [m/s] towards the free edge of a point mass before a swept face.

    The point flies where the drive throws it, and comes down with the restitution of the bowl. Nothing pushes
    it from behind, so a queue moves it at least as fast.

    Parameters
    ----------
    bowl : Bowl
        Its drive, friction, restitution, climb and bank, which leans the track towards the wall.
    sweep : float [rad]
        Of the face to the direction of travel.
    friction : float [1]
        Of the face.
    air : (float, float) [m/s2], optional
        Of its force along the face and off it, over the mass.

    Returns
    -------
    float [m/s]
        0 where it does not slide along the face.

    Raises
    ------
    FeederError
        If the motion has no end.

    Notes
    -----
    Steps of a part of the period. With the normal impulse J of the track, friction takes at most mu J of the
    velocity relative to it. The face takes what goes into it, and at most friction times that along it.
    Source: Coulomb's friction and Newton's restitution; docs/tooling.md, "1. The method". Nothing is fitted.
    Beside 1,181 trials of 23 parts at four drives and four blades (`benchmarks/blades.py`): the medians
    below 45 deg are 0.7 to 1.12 of it; docs/method/tooling.md, "Swept blades".
    """
    if sweep >= clearing_limit(friction) and not any(air):
        return 0.0
    drive, grip, g = bowl.drive, bowl.friction, bowl.gravity
    w, dt = 2.0 * math.pi * drive.frequency, 1.0 / drive.frequency / CLEARING_STEPS
    fore = drive.amplitude * w * math.cos(drive.vibration_angle)
    lift = drive.amplitude * w * w * math.sin(drive.vibration_angle)
    pull = -g * math.sin(bowl.track.climb), -g * math.sin(bowl.track.bank)
    normal = g * math.cos(bowl.track.climb) * math.cos(bowl.track.bank)
    c, s = math.cos(sweep), math.sin(sweep)
    pull = pull[0] + air[0] * c - air[1] * s, pull[1] + air[0] * s + air[1] * c
    x = y = u = v = start = 0.0
    above = rise = 0.0  # [m], [m/s] of the point over the track, relative to it
    for step in range(PERIODS * CLEARING_STEPS):
        if step == SETTLED * CLEARING_STEPS:
            start = y
        phase = w * dt * step
        u, v = u + pull[0] * dt, v + pull[1] * dt
        rise -= (normal - lift * math.sin(phase + drive.phase)) * dt
        above += rise * dt
        if above <= 0.0:  # on the track: what stops it falling presses it on
            bounce = bowl.restitution if -rise > RESTS * normal * dt else 0.0
            press = (1.0 + bounce) * max(-rise, 0.0)
            above, rise = 0.0, max(rise, -bounce * rise)
            track = fore * math.cos(phase)  # friction takes of what is relative to it
            slip = math.hypot(u - track, v)
            left = max(1.0 - grip.kinetic * press / slip, 0.0) if slip > 0.0 else 0.0
            u, v = track + (u - track) * left, v * left
        into = u * s - v * c
        if x * s - y * c >= 0.0 and into > 0.0:  # at the face, and into it
            along = u * c + v * s
            along -= math.copysign(min(abs(along), friction * into), along)
            u, v = along * c, along * s
        x, y = x + u * dt, y + v * dt
        if x * s - y * c > 0.0:
            over = x * s - y * c
            x, y = x - over * s, y + over * c
    mean_velocity = (y - start) / ((PERIODS - SETTLED) / drive.frequency)
    if not math.isfinite(mean_velocity):
        raise FeederError("devices", "the motion along a blade has no end", "lower the drive")
    return max(mean_velocity, 0.0)


# -- what holds a part beside its foot


def may_wedge(orientation: Orientation, span: tuple[float, ...]) -> bool:
    """Tell whether a head that comes first may stick between rails as a wedge.

    Friction then holds whatever presses it in, and the shank's weight need not turn it down: the angles at
    which its underside meets both rails add up to no more than two angles of friction.

    Parameters
    ----------
    orientation : Orientation
        It travels: it knows its track's friction.
    span : tuple of float [m]
        Of the slot: from and to, off the wall.

    Returns
    -------
    bool
        False where a rail does not meet it from below.

    References
    ----------
    A wedge between two angles of friction; docs/tooling.md, "1. The method".
    """
    outward = turned(orientation.posture.surface[:, :2], orientation.heading)[:, 1]
    ring = outline(np.column_stack([outward, orientation.posture.surface[:, 2]]))
    after = np.roll(ring, -1, axis=0)
    under = after[:, 0] > ring[:, 0]  # counter-clockwise: the lower half runs to the right
    start, end, lean = ring[under], after[under], 0.0
    for side in span:
        edge = side - orientation.distance
        spans_edge = (start[:, 0] <= edge) & (edge < end[:, 0])
        if not spans_edge.any():
            return False
        (run, rise) = (end - start)[np.argmax(spans_edge)]
        lean += math.atan2(run, abs(rise))
    return lean <= 2.0 * math.atan(orientation.grip)


def hangs_free(orientation: Orientation, span: tuple[float, ...]) -> bool:
    """Tell whether a head that hangs in a slot stays off the wall, and its weight turns the shank down.

    Parameters
    ----------
    orientation : Orientation
        As it lies before.
    span : tuple of float [m]
        Of the slot: from and to, off the wall.

    Returns
    -------
    bool
        False of a part without a head. What touches rail and wall at once may wedge.

    References
    ----------
    docs/tooling.md, "1. The method".
    """
    own_neck = neck(orientation)
    if own_neck is None or too_near(own_neck, span) > 0.0:
        return False
    return own_neck.lever >= LEVER * orientation.length


def too_near(own_neck: Neck, span: tuple[float, ...]) -> float:
    """Return how much farther from the wall a slot must be for a head not to touch it.

    Parameters
    ----------
    own_neck : Neck
    span : tuple of float [m]
        Of the slot: from and to, off the wall.

    Returns
    -------
    float [m]
        0 where it is far enough: the head stays ``OFF_WALL`` off the wall with its shank at the near rail.
    """
    return max(OFF_WALL - span[0] - 0.5 * (own_neck.shank - own_neck.widest), 0.0)


def wall_holds(orientation: Orientation, width: float) -> float:
    """Return by how much a strip along the wall may be wider than a part passes by itself.

    The wall holds a part that turns towards it: c (2 z - h) / w, with c the height over which the drive lifts
    it, z that at which it leans on the wall, h that of its centre of mass and w the strip's width; 0 at
    least.

    Parameters
    ----------
    orientation : Orientation
        It travels: it knows the height over which the drive lifts it.
    width : float [m]
        Of the strip.

    Returns
    -------
    float [m]

    References
    ----------
    docs/tooling.md, "1. The method".
    """
    points = orientation.posture.surface
    across = turned(points[:, :2], orientation.heading)[:, 1]
    high = points[across <= across.min() + WALL_CONTACT_SHARE * orientation.height, 2].max()
    return max(orientation.climbs * (2.0 * high - orientation.posture.height) / width, 0.0)


def astride(orientation: Orientation, ahead: float) -> float:
    """Return how far the weight of a part is from the sides of its foot, from below it up to a way ahead.

    Over an edge across the track that far ahead, or nearer, the part does not tip to its side.

    Parameters
    ----------
    orientation : Orientation
    ahead : float [m]
        Up to which the edge is ahead of the weight.

    Returns
    -------
    float [m]
        Negative where the weight is beside the foot; -inf where there is no foot.
    """
    hull = shapely.MultiPoint(orientation.foot.corners).convex_hull
    least = math.inf
    # a convex outline is narrowest at an end of a stretch
    for place in (0.0, ahead):
        across = hull.intersection(shapely.LineString([(place, -FAR), (place, FAR)]))
        if across.is_empty:
            return -math.inf
        low, high = across.bounds[1], across.bounds[3]
        least = min(least, high + orientation.shift, -orientation.shift - low)
    return least


def rides_over(orientation: Orientation, width: float, length: float) -> bool:
    """Tell whether a part on its round side along the track rides over a hole by its sides.

    A round part of radius r sinks r - sqrt(r^2 - w^2 / 4) between edges w apart; the drive has to lift it so
    far.

    Parameters
    ----------
    orientation : Orientation
        It travels: it knows the height over which the drive lifts it.
    width : float [m]
        Of the hole across the track, w.
    length : float [m]
        Along it; infinite of a hole that goes on.

    Returns
    -------
    bool
        False of a part that does not lie on a round side, or rolls along the track.

    References
    ----------
    docs/tooling.md, "1. The method".
    """
    radius = orientation.posture.height
    if orientation.kind != "rolling" or orientation.rolls_across or width >= 2.0 * radius:
        return False
    places = orientation.foot.corners[:, 0]
    share = 1.0 - float(places.max()) / length if length < np.ptp(places) else 1.0
    sunk = radius - math.sqrt(radius**2 - 0.25 * width**2)
    return share * (sunk - CUT_BORDER_RADIUS_M) < orientation.climbs - CUT_BORDER_RADIUS_M


# -- between two edges


def may_rest(section: shapely.Geometry, width: float, friction: float, wall: bool = False) -> bool:
    """Tell whether a part may come to rest between two edges, tilted some way.

    Parameters
    ----------
    section : shapely geometry [m]
        The part as seen along the edges, its centre of mass at (0, 0).
    width : float [m]
        Between the edges.
    friction : float [1]
        At both; 0 at edges along which the part slides, since the track shakes.
    wall : bool, optional
        Whether a wall stands in place of the first edge: the part leans on it at any height.

    Returns
    -------
    bool
        True also of a part that is not convex as it is seen: it may catch an edge by a corner of its own.

    References
    ----------
    Coulomb's cones at two edges; docs/method/trial.md, "What other parts said of the rules".
    """
    hull = section.convex_hull
    if section.area < CONVEX_FILL_SHARE * hull.area:
        return True
    ring = outline(shapely.get_coordinates(hull))
    tilts = np.linspace(-0.5 * np.pi, 0.5 * np.pi, 2 * REST_TILTS + 1)
    supports = [(_leans if wall else _bridges)(turned(ring, turn), width) for turn in tilts]
    if friction > 0.0:
        return any(two is not None and _holds(two, friction) for two in supports)
    # without friction, a tilt at which the centre of mass is nowhere lower beside it
    heights = np.array([-np.inf if two is None else -two[1][0][1] for two in supports])
    around, same = np.concatenate([[np.inf], heights, [np.inf]]), 1e-9 * np.ptp(ring, axis=0).max()
    lowest = (heights <= around[:-2] + same) & (heights <= around[2:] + same)
    return bool((lowest & np.isfinite(heights)).any())


def _leans(ring: Points, width: float) -> Supports | None:
    """Where a convex outline touches a wall and an edge at some distance from it, as ``_bridges``."""
    place = ring[:, 0].min() + width
    if ring[:, 0].max() <= place:
        return None
    along = sides(ring)
    under = (along[:, 0] > 0.0) & (ring[:, 0] <= place) & (place < ring[:, 0] + along[:, 0])
    k = int(np.flatnonzero(under)[0])
    on = ring[k] + along[k] * (place - ring[k, 0]) / along[k, 0]
    normal = np.array([-along[k, 1], along[k, 0]]) / np.hypot(*along[k])
    return [(ring[int(np.argmin(ring[:, 0]))], np.array([1.0, 0.0])), (on, normal)]


def _bridges(ring: Points, width: float) -> Supports | None:
    """Both edges on which an outline lies by its lower chord, (point, normal into the part), or None."""
    levels = np.unique(ring[:, 1])
    crosses, places = _chords(ring, levels)
    spans = np.where(crosses, places, -np.inf).max(axis=1) - np.where(crosses, places, np.inf).min(axis=1)
    wide = np.flatnonzero(spans >= width)
    if not len(wide):
        return None
    level, k = levels[0], int(wide[0])
    if k > 0:
        share = (width - spans[k - 1]) / (spans[k] - spans[k - 1])
        level = levels[k - 1] + share * (levels[k] - levels[k - 1])
    (crossed,), (places,) = _chords(ring, np.array([level]))
    along = sides(ring)[crossed]
    places = places[crossed]
    normals = np.column_stack([-along[:, 1], along[:, 0]]) / np.hypot(*along.T)[:, None]
    return [(np.array([places[end], level]), normals[end]) for end in (places.argmin(), places.argmax())]


def _chords(ring: Points, levels: Floats) -> tuple[Bools, Floats]:
    """Which sides (L, K) of a convex outline meet some levels (L,) [m], and where."""
    along, start = sides(ring), ring[:, 1]
    low, high = np.minimum(start, start + along[:, 1]), np.maximum(start, start + along[:, 1])
    rise = np.where(along[:, 1] == 0.0, 1.0, along[:, 1])
    share = np.clip((levels[:, None] - start) / rise, 0.0, 1.0)
    return (low <= levels[:, None]) & (levels[:, None] <= high), ring[:, 0] + share * along[:, 0]


def _holds(two: Supports, friction: float) -> bool:
    """Tell whether forces within cones of friction at two places hold a weight at (0, any height)."""
    wrenches = []
    for point, normal in two:
        for side in (-1.0, 1.0):
            push = turned(normal, side * np.arctan(friction))
            wrenches.append([*push, cross(point, push)])
    rows = np.array(wrenches)
    size = np.abs(rows[:, 2]).max()
    rows[:, 2] /= size if size > 0.0 else 1.0
    for a, b, c in itertools.combinations(rows, 3):
        minors = np.cross([b, c, a], [c, a, b])
        whole = (a * minors[0]).sum()
        # Cramer's rule: how much of each makes a weight of 1
        if abs(whole) >= FORCE_SHARE_TOLERANCE and (minors[:, 1] / whole >= -FORCE_SHARE_TOLERANCE).all():
            return True
    return False


# -- through a hole


def falls_through(orientation: Orientation, cut: Points) -> bool:
    """Tell whether a hole lets an orientation through that it does not carry.

    The part goes down by one of its shadows, as it lies or tipped about a level axis, that fits into the hole
    with ``SHADOW_CLEARANCE_M`` all round.

    Parameters
    ----------
    orientation : Orientation
    cut : (K, 2) float [m]
        The hole, unrolled: along the wall, and from it.

    Returns
    -------
    bool

    References
    ----------
    docs/tooling.md, "1. The method".
    """
    hole = _open(cut, orientation.track.width).buffer(-SHADOW_CLEARANCE_M, join_style="mitre")
    if hole.is_empty:
        return False
    shadows, sizes = _shadows(orientation.posture, orientation.heading)
    extent = np.subtract(hole.bounds[2:], hole.bounds[:2])
    may = np.flatnonzero((sizes <= extent).all(axis=1))
    if hole.area > (1.0 - RECTANGLE_TOLERANCE) * extent.prod():  # it is a rectangle
        return bool(len(may))
    parts = [(part, _half_planes(part)) for part in shapely.get_parts(hole)]
    return any(_fits(shadows[k], *part) for k in may for part in parts)


@functools.lru_cache(maxsize=8192)
def surely_gone(device: Device, orientation: Orientation) -> bool:
    """Tell whether an orientation that a device does not let pass is surely returned by it.

    Parameters
    ----------
    device : Device
    orientation : Orientation
        It travels.

    Returns
    -------
    bool
        False also where a swept blade may lay it over instead.
    """
    lays_over = device.face is not None and may_lay_aside(orientation, device.limit)
    return lets_go(device, orientation) and not lays_over


def lets_go(device: Device, orientation: Orientation) -> bool:
    """Tell whether what a device cuts away lets an orientation go for certain.

    The part goes over the free edge, or through a hole along the track as it lies, or down between two edges
    where no tilt of it can rest on them.

    Parameters
    ----------
    device : Device
    orientation : Orientation
        It travels.

    Returns
    -------
    bool
        True of a device that cuts nothing.
    """
    track = orientation.track
    opening = opening_at(device, orientation)
    if opening is None or (opening.span is not None and opening.span[1] >= track.extent - 1e-9):
        return True
    cut, span = opening.ring, opening.span
    height = orientation.posture.height
    if span is None:
        if not falls_through(orientation, cut):
            return False
        if device.swings_clear(orientation):
            return True
        # no tilt of it ahead may rest on both edges across the track of a hole as wide as the part
        hole = _open(cut, track.width)
        across = orientation.distance + orientation.outline[:, 1]
        low, high = across.min(), across.max()
        least = min(
            hole.intersection(shapely.box(-FAR, y - ONE_LINE, FAR, y + ONE_LINE)).area / (2.0 * ONE_LINE)
            for y in np.linspace(max(low, ONE_LINE), high - ONE_LINE, PIECES)
        )
        side_view = shapely.affinity.translate(orientation.aside, 0.0, -height)
        return least > 0.0 and not may_rest(side_view, least, orientation.grip)
    if span[0] > 0.0 and shoulder_margin(orientation, span) >= 0.0:
        return False
    if fits_as_it_lies(orientation, cut):
        return True
    # no tilt of it may rest on both sides of a hole along the track, over which it slides on
    view = shapely.affinity.translate(orientation.view_ahead, -orientation.distance, -height)
    near = max(span[0], 0.0)
    return falls_through(orientation, cut) and not may_rest(view, span[1] - near, 0.0, span[0] <= 0.0)


def fits_as_it_lies(orientation: Orientation, cut: Points) -> bool:
    """Tell whether an orientation fits through a hole as it lies, anywhere on its way.

    Parameters
    ----------
    orientation : Orientation
    cut : (K, 2) float [m]
        The hole, unrolled: along the wall, and from it.

    Returns
    -------
    bool
    """
    hole = _open(cut, orientation.track.width)
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


def _open(cut: Points, width: float) -> shapely.Geometry:
    """The hole as an area, beyond the track's free edge where it reaches it."""
    x, y = np.asarray(cut, float).T
    beyond = np.where(y >= width - 1e-9, y + OPEN_HOLE_OVERRUN_M, y)
    return shapely.make_valid(shapely.Polygon(np.column_stack([x, beyond])))


@functools.lru_cache(maxsize=512)
def _shadows(posture: Posture, heading: float) -> tuple[list[Points], Floats]:
    """Convex outlines (K, 2) [m] from above, as it lies and as it tips, and their sizes (S, 2) [m]."""
    points, outlines = cast(Points, posture.corners), []
    size = np.ptp(points, axis=0).max()
    c, s = np.cos(heading), np.sin(heading)
    x, y, z = c * points[:, 0] - s * points[:, 1], s * points[:, 0] + c * points[:, 1], points[:, 2]
    for tilt in np.linspace(0.0, 0.5 * np.pi, FALL_TILTS):
        azimuths = np.linspace(0.0, 2.0 * np.pi, AZIMUTHS, endpoint=False)[: None if tilt > 0.0 else 1, None]
        a, b = np.cos(azimuths), np.sin(azimuths)
        along = (a * x + b * y) * np.cos(tilt) + z * np.sin(tilt)
        across = -b * x + a * y
        shadows = np.stack([a * along - b * across, b * along + a * across], axis=-1)
        hulls = shapely.convex_hull(shapely.multipoints(shadows))
        simple = shapely.simplify(hulls, SHADOW_DETAIL_SHARE * size)
        outlines += [shapely.get_coordinates(ring)[:-1] for ring in simple]
    return outlines, np.array([np.ptp(shadow, axis=0) for shadow in outlines])


def _half_planes(part: shapely.Polygon) -> Floats | None:
    """Half-planes (K, 3) [1, 1, m] that bound a convex polygon: normals and distances; None of another."""
    if part.interiors or part.area < (1.0 - RECTANGLE_TOLERANCE) * part.convex_hull.area:
        return None
    ring = shapely.get_coordinates(shapely.geometry.polygon.orient(part).exterior)
    along = np.diff(ring, axis=0)
    length = np.hypot(*along.T)
    normal = np.column_stack([along[:, 1], -along[:, 0]])[length > 0.0] / length[length > 0.0, None]
    return np.column_stack([normal, (normal * ring[:-1][length > 0.0]).sum(axis=1)])


def _fits(shadow: Points, part: shapely.Polygon, half_planes: Floats | None) -> bool:
    """Tell whether a convex shadow can be moved to lie within a polygon."""
    if half_planes is None:  # something is left of the polygon beside the shadow swept along its border
        shadow = shadow - shadow.mean(axis=0)
        rings = map(shapely.get_coordinates, [part.exterior, *part.interiors])
        edges = np.concatenate([np.stack([ring[:-1], ring[1:]], axis=1) for ring in rings])
        swept = np.concatenate([edges[:, :1] - shadow, edges[:, 1:] - shadow], axis=1)
        border = shapely.union_all(shapely.convex_hull(shapely.multipoints(swept)))
        return not part.difference(border).is_empty
    # some corner of where it may be moved to exists
    (a, b), c = half_planes[:, :2].T, half_planes[:, 2]
    room = c - (a[:, None] * shadow[:, 0] + b[:, None] * shadow[:, 1]).max(axis=1)
    i, j = np.triu_indices(len(half_planes), 1)
    turn = a[i] * b[j] - b[i] * a[j]
    i, j, turn = (k[np.abs(turn) > PARALLEL_SINE] for k in (i, j, turn))
    x, y = (room[i] * b[j] - b[i] * room[j]) / turn, (a[i] * room[j] - room[i] * a[j]) / turn
    return bool((a[:, None] * x + b[:, None] * y <= room[:, None] + FIT_TOLERANCE_M).all(axis=0).any())
