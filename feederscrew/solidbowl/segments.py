"""A bowl cut into segments that fit a printer, with holes for dowels across the seams, and screws."""

from dataclasses import dataclass

import numpy as np
import shapely

from feederscrew import units
from feederscrew.errors import ArgumentError, FeederError
from feederscrew.solidbowl import facets, lugs
from feederscrew.solidbowl.plan import FULL_TURN
from feederscrew.solidbowl.track import fillet
from feederscrew.tooling import whole_surface
from feederscrew.units import MM

MAX_SEGMENTS = 6  # segments in one direction
SEAM_POSITIONS = 36  # positions of the seams that are tried, over a quarter turn
DOWEL_HOLE_DEPTH_M = 6e-3  # [m] of a dowel's hole in each segment
SHARE = 0.5  # of the wall: diameter of a dowel
LAND = 0.8  # of its diameter: solid round a dowel
DOWEL_SPACING_M = 25e-3  # [m] between dowels
DOWEL_GRID_M = 1.5e-3  # [m] at which places for dowels are looked for
SURFACE_DISTANCE_M = 1e-3  # [m] of a surface
OVERHANG_PLACES = "floor", "wall", "track", "outlet"  # what may hang over
DOWELS, SCREWS = JOINTS = ("dowels", "screws")


@dataclass(frozen=True, eq=False)
class Segment:
    """One piece to print, as it stands on the bed."""

    name: str
    vertices: np.ndarray  # (V, 3) [m] from the corner of its box
    faces: np.ndarray  # (F, 3)
    size: tuple[float, float, float]  # [m] of its box
    volume: float  # [m3]


@dataclass(frozen=True, eq=False)
class Segments:
    """A bowl in pieces."""

    pieces: tuple[Segment, ...]
    places: np.ndarray  # (N, 3) [m] the middle of each dowel, in axes turned with the seams
    dowel: float  # [m] diameter
    dowel_length: float  # [m]
    turned: float  # [rad] of the seams against the bowl's axes
    lugs: np.ndarray  # (N, 3, 3) of each screw: its middle [m], its direction, off the wall
    joined: tuple[np.ndarray, np.ndarray] | None  # vertices, faces of the bowl with lugs, bored; None without
    ends: tuple[int, int] = (0, 0)  # of seams, that have no screw where screws are asked for; and of how many

    @property
    def dowels(self):
        """How many."""
        return len(self.places)

    @property
    def remarks(self):
        """What must not be overlooked of its screws, a tuple of str."""
        return lugs.remarks(*self.ends)

    @property
    def screws(self):
        """The middle (N, 3) [m] of each screw, in the bowl's axes."""
        return self.lugs[:, 0]


def bed(text):
    """Return the size (x, y, z) [m] of a printer's bed as typed, '220x220x250mm'.

    Raises
    ------
    ArgumentError
    """
    sides, size = text.replace("×", "x").lower().split("x"), []
    unit = sides[-1].lstrip(" 0123456789.+-")
    try:
        if len(sides) != 3:
            raise units.QuantityError(f"{units.shown(text)} is not three lengths", "write 220x220x250mm")
        for side in sides:
            has_unit = side.strip().lstrip("0123456789.+-")
            size.append(units.quantity(side if has_unit else f"{side}{unit}", "length"))
    except units.QuantityError as fault:
        raise ArgumentError("bed", fault.what, fault.mend) from None
    if min(size) <= 0.0:
        raise ArgumentError("bed", f"{units.shown(text)} has a side of 0 or less", "write 220x220x250mm")
    return tuple(size)


def segments(made, size, joint=DOWELS):
    """Return a bowl in pieces that fit a bed, whole where it fits as it is.

    Parameters
    ----------
    made : BowlSolid
    size : (float, float, float) [m]
        Of the bed, and of the height that is printed.
    joint : str
        Of ``JOINTS``: dowels alone, or screws in lugs outside the wall as well.

    Returns
    -------
    Segments

    Raises
    ------
    FeederError
        If it takes more than six segments in one direction, or no lug for a screw has room.
    """
    counts, turn, extents = _seams(made, size, joint == SCREWS)
    body = facets.placed(made).rotate((0.0, 0.0, -float(np.degrees(turn))))
    planes = [
        (axis, low + (high - low) * k / count)
        for axis, (count, (low, high)) in enumerate(zip(counts, extents))
        for k in range(1, count)
    ]
    dowel = SHARE * min(made.plan.material.wall, made.plan.material.floor)
    holes = [one for plane in planes for one in _dowels(made, body, turn, plane, dowel)]
    joints, bare, of = _lugs(made, body, turn, planes) if joint == SCREWS else ([], 0, 0)
    body, joined = _joined(body, joints, turn)
    body = facets.without(
        body, [facets.rod(axis, middle, dowel, DOWEL_HOLE_DEPTH_M) for axis, middle in holes]
    )
    cells = facets.cut_by(body, planes)
    found = sorted(
        (piece for cell in cells for piece in facets.parts_of(cell)), key=lambda one: one.bounding_box()
    )
    pieces = tuple(_piece(f"segment_{k}", one) for k, one in enumerate(found, start=1))
    places = np.array([middle for _, middle in holes]).reshape(-1, 3)
    screwed = np.array([(one.middle, one.along, one.out) for one in joints]).reshape(-1, 3, 3)
    return Segments(
        pieces, places, dowel, 2.0 * DOWEL_HOLE_DEPTH_M, turn, _turned(screwed, turn), joined, (bare, of)
    )


def _lugs(made, body, turn, planes):
    """The lugs for the screws of all seams, and how many ends of seams have none, of how many."""
    plan = made.plan
    s = np.linspace(_tooled(plan)[0], plan.way.end + plan.outlet, 120)
    edges = [_filed(plan, plan.way.plan(s, y)) for y in (-plan.material.wall, plan.width)]
    kept = shapely.MultiLineString([_turned(one, -turn) for one in edges])
    found = lugs.lugs(body, planes, kept, _box(made.vertices, turn))
    if planes and not found[0]:
        raise FeederError("join", "no lug for a screw has room at the seams", "take dowels")
    return found


def _joined(body, joints, turn):
    """The bowl with its lugs, and its surface in the bowl's own axes."""
    if not joints:
        return body, None
    whole = facets.united([body, *(one.body for one in joints)])
    whole = facets.without(whole, [hole for one in joints for hole in one.holes])
    return whole, whole_surface.mesh(whole.rotate((0.0, 0.0, float(np.degrees(turn)))))


def _turned(places, turn):
    """Places (..., 2 or 3) turned about Z."""
    c, s = np.cos(turn), np.sin(turn)
    x, y = places[..., 0], places[..., 1]
    return np.concatenate([np.stack([c * x - s * y, s * x + c * y], axis=-1), places[..., 2:]], axis=-1)


def _piece(name, body):
    low = body.bounding_box()[:3]
    vertices, faces = whole_surface.mesh(body.translate(tuple(-x for x in low)))
    x, y, z = map(float, vertices.max(axis=0))
    return Segment(name, vertices, faces, (x, y, z), body.volume() * MM**3)


def _seams(made, size, screwed):
    """Segments along each axis, the turn of the seams, and the box (3, 2) [m] of the bowl turned back by it.

    The box has room for the lugs of screws.
    Of the turns with fewest segments the one whose seams keep farthest from the devices.
    """
    found = []
    for turn in 0.5 * np.pi * np.arange(SEAM_POSITIONS) / SEAM_POSITIONS:
        extents = _box(made.vertices, turn)
        counts = _counts(extents, size)
        if screwed and max(counts) > 1:
            extents = extents + lugs.STANDS * np.array([[-1.0, 1.0], [-1.0, 1.0], [0.0, 0.0]])
            counts = _counts(extents, size)
        rank = np.prod(counts), -round(_clear(made, turn, counts, extents), 9), float(turn)
        found.append((rank, counts, float(turn), extents))
    _, counts, turn, extents = min(found, key=lambda one: one[0])
    if max(counts) > MAX_SEGMENTS:
        least = " x ".join(f"{1e3 * (high - low) / MAX_SEGMENTS:.4g}" for low, high in extents)
        sentence = " x ".join(f"{1e3 * side:.4g}" for side in size)
        what = f"{sentence} mm takes more than {MAX_SEGMENTS} segments in one direction"
        raise FeederError("bed", what, f"give at least {least} mm, or a smaller bowl")
    return counts, turn, extents


def _counts(extents, size):
    room = extents[:, 1] - extents[:, 0]
    return tuple(int(np.ceil(one / side - 1e-9)) for one, side in zip(room, size))


def _box(vertices, turn):
    points = _turned(vertices, -turn)
    return np.column_stack([points.min(axis=0), points.max(axis=0)])


def _clear(made, turn, counts, extents):
    """Least distance [m] from an upright seam to the tooled stretch."""
    corners = _box_points(made, turn)
    found = [1.0]
    for axis in (0, 1):
        low, high = extents[axis]
        for k in range(1, counts[axis]):
            offset = corners[:, axis] - (low + (high - low) * k / counts[axis])
            crossed = offset.min() < 0.0 < offset.max()
            found.append(0.0 if crossed else float(np.abs(offset).min()))
    return min(found)


def _box_points(made, turn):
    """Places (N, 2) [m] along the devices, in the axes of the seams."""
    plan = made.plan
    first, last = _tooled(plan)
    s, y = np.meshgrid(np.linspace(first, last, 30), [0.0, plan.width])
    return _turned(_filed(plan, plan.way.plan(s.ravel(), y.ravel())), -turn)


def _tooled(plan):
    """From and to [m] along the wall where no dowel and, if it can be, no seam shall be."""
    return (plan.first, plan.way.end) if plan.stretch is not None else (plan.way.end - 1e-3, plan.way.end)


def _filed(plan, flat):
    return _turned(flat * [1.0, -1.0] if plan.left else flat, plan.turned)


def _dowels(made, body, turn, plane, size):
    """Places (axis, middle (3,) [m]) of dowels across a seam: in solid, apart, and none below a cut."""
    axis, at = plane
    areas = [
        facets.cut_face(body, axis, at + off).buffer(-LAND * size)
        for off in (-DOWEL_HOLE_DEPTH_M, 0.0, DOWEL_HOLE_DEPTH_M)
    ]
    area = areas[0].intersection(areas[1]).intersection(areas[2])
    if area.is_empty:
        return []
    low_u, low_v, high_u, high_v = area.bounds
    u, v = np.meshgrid(
        np.arange(low_u, high_u + DOWEL_GRID_M, DOWEL_GRID_M),
        np.arange(low_v, high_v + DOWEL_GRID_M, DOWEL_GRID_M),
    )
    places = np.column_stack([u.ravel(), v.ravel()])
    places = places[shapely.contains_xy(area, *places.T)]
    ring = shapely.MultiPoint(_box_points(made, turn)).convex_hull.buffer(2.0 * size)
    kept: list[tuple[int, np.ndarray]] = []
    for place in places:
        middle = np.insert(place, axis, at)
        if shapely.contains_xy(ring, *middle[:2]):
            continue
        if all(np.sum((middle - other) ** 2) > DOWEL_SPACING_M**2 for _, other in kept):
            kept.append((axis, middle))
    return kept


def overhangs(made):
    """Return what hangs over by more than 45 deg, printed as the bowl stands.

    Parameters
    ----------
    made : BowlSolid

    Returns
    -------
    dict of str to float [m2]
        Area by what it belongs to; nothing of less than a square centimetre.
    """
    plan, corners = made.plan, made.vertices[made.faces]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    area = 0.5 * np.sqrt((across**2).sum(axis=1))
    down = -across[:, 2] > (np.sqrt(0.5) + 1e-6) * 2.0 * area
    high = corners[..., 2].max(axis=1) > made.vertices[:, 2].min() + 1e-4
    where = _where(plan, facets.as_planned(plan, corners.mean(axis=1)))
    found = {name: float(area[down & high & (where == name)].sum()) for name in OVERHANG_PLACES}
    return {name: one for name, one in found.items() if one > 1e-4}


def _by_the_outlet(plan, places):
    """Whether places (N, 3) [m] belong to what is straight beyond the end of the track: (N,) bool."""
    (x, y, z), far = places.T, plan.way.radius - plan.across - plan.material.wall
    high = z > plan.outlet_height - 2.0 * plan.material.plate - fillet(plan) - plan.hanging
    return (y > -SURFACE_DISTANCE_M) & (x > far - SURFACE_DISTANCE_M) & high


def _where(plan, places):
    """What of a bowl places (N, 3) [m] belong to, outlet at the angle 0: words (N,)."""
    way, (x, y, z) = plan.way, places.T
    r, theta = np.hypot(x, y), np.arctan2(y, x)
    behind = theta - FULL_TURN * (theta > 0.0) - FULL_TURN * np.arange(int(plan.turns) + 2)[:, None]
    s = way.at(behind)  # of each turn of the track that is there
    inwards = (way.wall_radius(s) - r) / np.cos(way.bank_at(s))
    above = z - way.height(s, inwards)
    deep = -(plan.material.plate + plan.across + plan.hanging)
    beside = (inwards > -SURFACE_DISTANCE_M) & (inwards < plan.width + SURFACE_DISTANCE_M)
    on_track = (beside & (above > deep) & (above < SURFACE_DISTANCE_M)).any(axis=0)
    lowest = float(way.wall_radius(way.rises(plan.width)))
    kinds = [
        _by_the_outlet(plan, places),
        on_track,
        (r < plan.ring + SURFACE_DISTANCE_M) | ((z < SURFACE_DISTANCE_M) & (r < lowest)),
    ]
    return np.select(kinds, ["outlet", "track", "floor"], "wall")
