"""A pose on the track in words: on what the part lies, where its long side points, and what is ahead."""

import numpy as np
import shapely

from feederscrew.base.arrays import Vector
from feederscrew.base.geometry import vectors
from feederscrew.base.geometry.polygons import centroid, sides, turned
from feederscrew.base.units import DEG
from feederscrew.sorting.footprints import visible_area
from feederscrew.sorting.orientations import HANGING, Hanging, Orientation, head_first, neck

LONG_SHARE = 1.15  # [1] sides of the outline whose lengths differ by less are not told
ALIGNED_RAD = np.radians(15.0)  # so near to the track's direction, or to square across it, a side is along it
HOLE_SHARE = 0.01  # [1] of the box around the outline: smaller holes are not named
OFF_SHARE = 0.04  # [1] of the size that way: what is nearer to the middle is not told


def describe_pose(orientation: Orientation) -> str:
    """Return how a part lies on the track, in words, as people at the bowl tell one pose from another.

    The parts of the sentence are: on what it lies; where its long side points; and what leads, a head, an
    open hole that is seen from above, or the heavier end. What the shape does not show is left out.

    Parameters
    ----------
    orientation : Orientation
        On the track, or hanging between rails.

    Returns
    -------
    str
        'on its largest face, long side along the track, hole ahead'; of what hangs 'hanging by its head
        between the rails, shank down'.
    """
    if isinstance(orientation, Hanging):
        return f"{HANGING} by its head between the rails, shank down"
    words = [orientation.posture.lies or f"on aspect {orientation.aspect}"]
    words += filter(None, (_long_side(orientation), _leads(orientation), _heavy_side(orientation)))
    return ", ".join(words)


def _long_side(orientation: Orientation) -> str:
    """Where the long side of the outline from above points; '' of a round or square one."""
    plan = orientation.outline
    along = sides(plan)
    along = along / np.hypot(*along.T)[:, None]
    lengths = np.ptp(vectors.product(along, plan.T), axis=1)
    widths = np.ptp(vectors.product(np.column_stack([-along[:, 1], along[:, 0]]), plan.T), axis=1)
    least = int(np.argmin(lengths * widths))
    if max(lengths[least], widths[least]) < LONG_SHARE * min(lengths[least], widths[least]):
        return ""
    x, y = along[least] if lengths[least] >= widths[least] else (-along[least, 1], along[least, 0])
    angle = float(np.arctan2(abs(y), abs(x)))
    if angle <= ALIGNED_RAD:
        return "long side along the track"
    if angle >= 0.5 * np.pi - ALIGNED_RAD:
        return "long side across the track"
    return f"long side at {angle / DEG:.0f}° to the track"


def _leads(orientation: Orientation) -> str:
    """Return what of a part is ahead or behind, at the wall or at the free edge; '' if nothing tells it."""
    if neck(orientation) is not None:
        return "head ahead" if head_first(orientation) else "head behind"
    plan, free = orientation.outline, -1.0 if orientation.at_inner_wall else 1.0
    low, high = plan.min(axis=0), plan.max(axis=0)
    middle, size = 0.5 * (low + high), high - low
    hole = _largest_hole(orientation)
    if hole is not None:
        return _where("hole", hole, size, free) or "hole in the middle"
    return _where("heavier end", -middle, size, free)  # the centre of mass is at 0, 0


def _largest_hole(orientation: Orientation) -> Vector | None:
    """Centroid (2,) [m] of the largest hole that is seen from above, from the outline's middle; or None."""
    points = orientation.posture.surface
    plan = np.column_stack([turned(points[:, :2], orientation.heading), points[:, 2]])
    area = visible_area(plan, orientation.posture.facets, "outline")
    left, low, right, high = area.bounds
    rings = [ring for part in shapely.get_parts(area) for ring in getattr(part, "interiors", ())]
    holes = [shapely.get_coordinates(ring)[:-1] for ring in rings]
    sizes = [float(shapely.Polygon(hole).area) for hole in holes]
    if not sizes or max(sizes) < HOLE_SHARE * (right - left) * (high - low):
        return None
    middle = np.array([0.5 * (left + right), 0.5 * (low + high)])
    return np.asarray(centroid(holes[int(np.argmax(sizes))])) - middle


def _where(what: str, off: Vector, size: Vector, free: float) -> str:
    """'hole ahead': where something is off the middle by more than ``OFF_SHARE``; '' where it is not.

    The free edge is inwards where ``free`` is 1, and outwards where it is -1.
    """
    x, y = off / size
    if max(abs(x), abs(y)) < OFF_SHARE:
        return ""
    if abs(x) >= abs(y):
        return f"{what} {'ahead' if x > 0.0 else 'behind'}"
    return f"{what.replace(' end', ' side')} {'at the free edge' if free * y > 0.0 else 'at the wall'}"


def _heavy_side(orientation: Orientation) -> str:
    """Tell whether the heavier half is down or up; '' where neither is, and of a part that rolls."""
    off = orientation.posture.height / orientation.height - 0.5
    if abs(off) < OFF_SHARE or orientation.kind == "rolling":
        return ""
    return "heavier side down" if off < 0.0 else "heavier side up"
