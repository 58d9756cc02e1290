"""What holds a part at a device or lays it over, beside its foot: a blade, sides of a slot, the wall.

Source: balances of moments with Coulomb's friction; docs/tooling.md, section 1.
"""

import math

import numpy as np
import shapely

from feederscrew.geometry.polygons import outline, turned
from feederscrew.tooling.hanging import neck
from feederscrew.tooling.orientations import CUT_BORDER_RADIUS_M, rolls_across

FOREMOST_TOLERANCE = 1e-6  # of the part's height: places so near to the foremost one are met with it
WALL_CONTACT_SHARE = 1e-2  # of the part's height: places so near to the wall lean on it
BEYOND_FOOT_M = 10.0  # [m] beyond any foot
LEVER = 0.1  # of the length, from the head to the weight: in trials those with 0.15 hang, with 0.04 not
OFF_WALL = 9e-5  # [m] by which a head that hangs stays off the wall at least


def may_lay_over(one, low):
    """Return whether a blade across the track may lay a part over instead of holding it up.

    Source: moments about the rear side of the foot, Coulomb's friction; docs/tooling.md,
    "1. The method".

    Parameters
    ----------
    one : Orientation
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
    ahead, height = _met(one, low)
    behind = _behind(one)
    mu, c, s = one.grip, math.cos(one.track.climb), math.sin(one.track.climb)
    lever = height - mu * (behind + ahead)
    if mu >= 1.0 or mu * c <= s:  # nothing limits the push, or there is none
        return mu * c > s and lever > 0.0
    return (mu * c - s) / (1.0 - mu * mu) * lever + one.posture.height * s > behind * c


def may_lay_aside(one, low, sweep):
    """Return whether a swept blade may lay a part over towards the free edge as it slides along the face.

    Source: moments about a side of the foot, Coulomb's friction; docs/tooling.md, "1. The method".

    Parameters
    ----------
    one : Orientation
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
    found = _foot_sides(one)
    if found is None:
        return True
    away, reach = found
    push = away[:, 1] * math.cos(sweep) - away[:, 0] * math.sin(sweep)
    return bool((one.grip * low * push > reach).any())


def may_turn_and_lie_over(one, low):
    """Return whether a swept blade may lay a part over once it has turned along the face.

    Source: ``may_lay_aside`` with a side of the foot along the face; docs/tooling.md, "1. The method".

    Parameters
    ----------
    one : Orientation
        That travels.
    low : float [m]
        Height of the blade's edge.

    Notes
    -----
    What slides along a blade turns until a side of it lies there, whichever comes: the push of
    ``may_lay_aside`` is then square to some side of the foot, and tips it over the nearest where mu z > b.
    """
    found = _foot_sides(one)
    return found is None or bool((one.grip * low > found[1]).any())


def _foot_sides(one):
    """Normals (K, 2) of the sides of a foot and their distances (K,) [m] from its weight; None of a line."""
    hull = shapely.MultiPoint(one.foot.corners).convex_hull
    if hull.geom_type != "Polygon":
        return None
    corners = shapely.get_coordinates(shapely.geometry.polygon.orient(hull))
    sides = np.diff(corners, axis=0)
    away = np.column_stack([sides[:, 1], -sides[:, 0]]) / np.hypot(*sides.T)[:, None]
    return away, away[:, 0] * corners[:-1, 0] + away[:, 1] * corners[:-1, 1]


def may_wedge(one, span):
    """Return whether a head that comes first may stick between rails as a wedge.

    Source: a wedge between two angles of friction; docs/tooling.md, "1. The method".

    Parameters
    ----------
    one : Orientation
        That travels, its head ahead of the shank.
    span : (float, float) [m]
        Of the slot, from the wall.

    Returns
    -------
    bool
        Whether both sides on which the head rests are steep enough together: friction then holds whatever
        presses it in, and the shank's weight need not turn it down.
    """
    seen = turned(one.posture.surface[:, :2], one.heading)[:, 1]
    ring = outline(np.column_stack([seen, one.posture.surface[:, 2]]))
    after = np.roll(ring, -1, axis=0)
    under = after[:, 0] > ring[:, 0]  # counter-clockwise: the lower half runs to the right
    start, end = ring[under], after[under]
    lean = 0.0
    for side in span:
        edge = side - one.distance
        met = (start[:, 0] <= edge) & (edge < end[:, 0])
        if not met.any():
            return False
        (run, rise) = (end - start)[np.argmax(met)]
        lean += math.atan2(run, abs(rise))
    return lean <= 2.0 * math.atan(one.grip)


def hangs_free(one, span):
    """Return whether a head that hangs in a slot stays off the wall, and its weight turns the shank down.

    Source: own; docs/tooling.md, "1. The method": what touches rail and wall at once may wedge.
    """
    found = neck(one)
    return found is not None and too_near(found, span) <= 0.0 and found.lever >= LEVER * one.length


def too_near(headed, span):
    """Return how much farther [m] from the wall a slot must be for a head not to touch it, 0 if it is."""
    return max(OFF_WALL - span[0] - 0.5 * (headed.shank - headed.widest), 0.0)


def leans(one, width):
    """Return by how much [m] a canyon may be wider than a part passes by its foot, and still let it through.

    Source: own; docs/tooling.md, "1. The method": the wall holds what turns towards it.

    Parameters
    ----------
    one : Orientation
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
    points = one.posture.surface
    across = turned(points[:, :2], one.heading)[:, 1]
    high = points[across <= across.min() + WALL_CONTACT_SHARE * one.height, 2].max()
    return max(one.climbs * (2.0 * high - one.posture.height) / width, 0.0)


def rides(one, width, length):
    """Return whether a part on its round side along the track rides over a hole by its sides.

    Source: own; docs/tooling.md, "1. The method".

    Parameters
    ----------
    one : Orientation
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
    radius = one.posture.height
    if one.kind != "rolling" or rolls_across(one) or width >= 2.0 * radius:
        return False
    places = one.foot.corners[:, 0]
    share = 1.0 - float(places.max()) / length if length < np.ptp(places) else 1.0
    sunk = radius - math.sqrt(radius**2 - 0.25 * width**2)
    return share * (sunk - CUT_BORDER_RADIUS_M) < one.climbs - CUT_BORDER_RADIUS_M


def widest(corners):
    """Return the greatest width [m] across the track of a hole with some corners (K, 2) [m]."""
    area = shapely.Polygon(corners)
    lines = [shapely.LineString([(x, -BEYOND_FOOT_M), (x, BEYOND_FOOT_M)]) for x, _ in corners]
    return max(area.intersection(line).length for line in lines)


def _met(one, low):
    """How far ahead of the weight a part reaches over a height [m], and at which height it first does so."""
    points, faces = one.posture.surface, one.posture.solid.faces
    ahead, height = turned(points[:, :2], one.heading)[:, 0], points[:, 2]
    a, b = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]).T
    crossed = (height[a] > low) != (height[b] > low)
    a, b = a[crossed], b[crossed]
    share = (low - height[a]) / (height[b] - height[a])
    reach = np.concatenate([ahead[height >= low], ahead[a] + share * (ahead[b] - ahead[a])])
    level = np.concatenate([height[height >= low], np.full(len(a), low)])
    return float(reach.max()), float(level[reach >= reach.max() - FOREMOST_TOLERANCE * one.height].min())


def _behind(one):
    """Way [m] from where the weight meets the track back to the border of the supported hull."""
    hull = shapely.MultiPoint(one.foot.corners).convex_hull
    back = hull.intersection(shapely.LineString([(0.0, -one.shift), (-BEYOND_FOOT_M, -one.shift)]))
    least = one.foot.corners[:, 0].min() if back.is_empty else back.bounds[0]
    return max(float(-least), 0.0)
