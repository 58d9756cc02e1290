"""A bowl cut into segments that fit a printer, with dowels or screwed lugs across the seams."""

import itertools
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import shapely

from feederscrew.base import units
from feederscrew.base.arrays import Floats, Points, Triangles, Vector
from feederscrew.base.columns import Column, values
from feederscrew.base.errors import ArgumentError, FeederError
from feederscrew.base.units import MM
from feederscrew.cad import facets
from feederscrew.cad.facets import Body
from feederscrew.cad.plan import FULL_TURN_RAD, BowlPlan
from feederscrew.cad.track import fillet
from feederscrew.sorting import whole_surface

if TYPE_CHECKING:
    from feederscrew.cad.closed_body import BowlSolid

Frame = tuple[Vector, Vector, Vector, Vector]  # place, along, out, across

HOLE = 3.4e-3  # [m] for a screw M3, ISO 273
# the pocket for a nut, ISO 4032 and 0.2 mm of play
FLATS = 5.7e-3  # [m] over its flats
LUG_DEPTH_M = 2.6e-3  # [m]
SCREW_LENGTH_M = 16e-3  # [m] of the screw, and of both halves of a lug
SCREW_NAME = "M3 x 16"
WEIGHT = 1.5e-3  # [kg] of a screw, ISO 4762, with its nut
LUG_HALF_WIDTH_M = 5e-3  # [m] of a lug to either side of its screw
OFF = 6e-3  # [m] from the wall to the screw
OVER = 5e-3  # [m] from the screw to the lug's outer face
LUG_OVERLAP_M = 5e-4  # [m] by which a lug reaches into the wall
SCREW_SPACING_M = 40e-3  # [m] between screws of a seam, about
LUG_CLEARANCE_M = 15e-3  # [m] from devices and outlet
MAX_WALL_BULGE_M = 8e-4  # [m] by which the wall may bulge between places of a lug
MAX_LUG_LEAN_M = 16e-3  # [m] by which the wall may lean away over a lug: 45 deg
POKE = 1e-11  # [m3] of it on the inner side of the wall at most
BEYOND_LUGS_M = 10.0  # [m] beyond everything
SCREW_HOLE_SIDES = 24  # corners of a hole
STANDS = OFF + OVER  # [m] of a lug over the wall, at least


@dataclass(frozen=True, eq=False)
class Lug:
    """A lug across a seam, with its screw; the seam lies in the middle of it."""

    middle: Vector  # (3,) [m] of the screw, in the seam
    along: Vector  # (3,) the screw's direction, from its nut to its head
    out: Vector  # (3,) off the wall
    body: Body  # [mm] without its holes
    under: float  # [m] by which it goes on beyond its nut, where it is carried at 45 deg

    @property
    def holes(self) -> list[Body]:
        """The hole of its screw and the pocket of its nut."""
        side = np.cross(self.along, self.out)
        axes = np.column_stack([self.out, side, self.along])
        more = 1e-3 + self.under
        end = self.middle - (0.5 * SCREW_LENGTH_M + more) * self.along
        return [
            facets.plank(_regular(SCREW_HOLE_SIDES, HOLE), SCREW_LENGTH_M + more + 1e-3, axes, end),
            facets.plank(_regular(6, FLATS), LUG_DEPTH_M + more, axes, end),
        ]


def _regular(corners: int, across: float) -> shapely.Polygon:
    """A regular polygon [m] by the distance of its flats, one of them outwards."""
    turns = FULL_TURN_RAD * (np.arange(corners) + 0.5) / corners
    size = 0.5 * across / np.cos(np.pi / corners)
    return shapely.Polygon(size * np.column_stack([np.cos(turns), np.sin(turns)]))


def place_lugs(
    body: Body, planes: Sequence[tuple[int, float]], tooled_area: shapely.Geometry, extents: Points
) -> tuple[list[Lug], int, int]:
    """Return the lugs along the seams of a bowl.

    A lug is left out where it would be near a device, the outlet, another lug or another seam, or where it
    would stick out within the wall. An upright seam has two ends; a level one goes round and counts once.

    Parameters
    ----------
    body : Body [mm]
        Turned as its seams are.
    planes : sequence of (int, float [m])
        Axis and place of each seam.
    tooled_area : shapely geometry [m]
        Devices and outlet, seen from above.
    extents : (3, 2) float [m]
        The bowl's box, in those axes.

    Returns
    -------
    list of Lug
    int
        Ends of seams without a lug.
    int
        Ends of seams.
    """
    lugs: list[Lug] = []
    with_lug, seam_points = set(), set()
    for axis, at in planes:
        for frame in _lug_frames(axis, at, extents):
            end = axis, at, *(frame[2] if axis < 2 else ())
            seam_points.add(end)
            lug = _lug(body, frame, axis == 2, extents[2, 0])
            # clear of devices, other lugs and seams, and not out within the wall
            if lug is None or tooled_area.distance(shapely.Point(lug.middle[:2])) < LUG_CLEARANCE_M:
                continue
            if any(np.sum((lug.middle - other.middle) ** 2) < (2.0 * SCREW_LENGTH_M) ** 2 for other in lugs):
                continue
            own = int(np.argmax(np.abs(lug.along)))
            if any(other != own and abs(lug.middle[other] - x) <= SCREW_LENGTH_M for other, x in planes):
                continue
            if len(facets.parts_of(facets.without(lug.body, [body]), POKE)) == 1:
                lugs.append(lug)
                with_lug.add(end)
    return lugs, len(seam_points - with_lug), len(seam_points)


def _lug_frames(axis: int, at: float, extents: Points) -> Iterator[Frame]:
    """Frames (place, along, out, across) of lugs at both ends of an upright seam, or round a level one."""
    unit, up = np.eye(3), np.array([0.0, 0.0, 1.0])
    if axis == 2:
        count = int(np.pi * (extents[0, 1] - extents[0, 0]) / SCREW_SPACING_M / 2.0)
        for turn in FULL_TURN_RAD * (np.arange(count) + 0.5) / count:
            out = np.array([np.cos(turn), np.sin(turn), 0.0])
            yield at * up, up, out, np.cross(up, out)
        return
    low, high = extents[2] + [LUG_HALF_WIDTH_M + STANDS + 2e-3, -LUG_HALF_WIDTH_M - 1e-3]
    count = 1 + int((high - low) / SCREW_SPACING_M)
    heights = np.linspace(low, high, count) if count > 1 else [0.5 * (low + high)]
    along = unit[axis] if at >= 0.0 else -unit[axis]
    for side, z in itertools.product((1.0, -1.0), heights if high >= low else ()):
        yield at * unit[axis] + z * up, along, side * unit[1 - axis], up


def _lug(body: Body, frame: Frame, level: bool, low: float) -> Lug | None:
    """A lug on the wall's outer face; None where that is not smooth there."""
    place, along, out, across = frame
    n, t = 0.5 * SCREW_LENGTH_M * np.linspace(-1.0, 1.0, 5), LUG_HALF_WIDTH_M * np.linspace(-1.0, 1.0, 3)
    off = np.array([[_wall(body, place + a * along + b * across, out) for b in t] for a in n])
    if not np.isfinite(off).all() or np.ptp(off) > MAX_LUG_LEAN_M:
        return None
    if max(np.abs(np.diff(off, 2, axis=k)).max() for k in (0, 1)) > MAX_WALL_BULGE_M:
        return None
    top = off.max() + STANDS
    foot = [(a, b, off[i, j] - LUG_OVERLAP_M) for i, a in enumerate(n) for j, b in enumerate(t)]
    rim = [(a, b, top) for a in n[[0, -1]] for b in t[[0, -1]]]
    deep = top - off.min()
    under = [(n[0] - deep, b) for b in t] if level else [(a, t[0] - deep) for a in n]
    if (place + under[0][0] * along + under[0][1] * across)[2] < low:
        return None
    foot += [(a, b, _wall(body, place + a * along + b * across, out) - LUG_OVERLAP_M) for a, b in under]
    corners = np.array([*foot, *rim])
    if not np.isfinite(corners).all():
        return None
    places = place + corners[:, :1] * along + corners[:, 1:2] * across + corners[:, 2:] * out
    return Lug(place + (off.max() + OFF) * out, along, out, facets.hull(places), deep if level else 0.0)


def _wall(body: Body, place: Points, out: Points) -> float:
    """Return how far out [m] the outer face of the wall lies from a place; not a number without one."""
    first_met = facets.first_met(body, place + BEYOND_LUGS_M * out, place)
    return BEYOND_LUGS_M - first_met[0] if first_met else np.nan


MAX_SEGMENTS = 6  # segments in one direction
SEAM_POSITIONS = 36  # positions of the seams that are tried, over a quarter turn
DOWEL_HOLE_DEPTH_M = 6e-3  # [m] of a dowel's hole in each segment
SHARE = 0.5  # of the wall: diameter of a dowel
LAND = 0.8  # of its diameter: solid round a dowel
DOWEL_SPACING_M = 25e-3  # [m] between dowels
DOWEL_GRID_M = 1.5e-3  # [m] at which places for dowels are looked for
SURFACE_DISTANCE_M = 1e-3  # [m] of a surface
DOWELS = "dowels"
SCREWS = "screws"
JOINTS = (DOWELS, SCREWS)


@dataclass(frozen=True, eq=False)
class Segment:
    """One piece to print, as it stands on the bed."""

    name: str
    vertices: Points  # (V, 3) [m] from the corner of its box
    faces: Triangles  # (F, 3)
    size: tuple[float, float, float]  # [m] of its box
    volume: float  # [m3]


PIECE_COLUMNS: tuple[Column[Segment], ...] = (
    Column("name", lambda piece: piece.name),
    Column("size_mm", lambda piece: np.array(piece.size), "mm"),
    Column("volume_mm3", lambda piece: piece.volume, "mm3"),
)


@dataclass(frozen=True, eq=False)
class Segments:
    """A bowl in pieces."""

    pieces: tuple[Segment, ...]
    places: Points  # (N, 3) [m] the middle of each dowel, in axes turned with the seams
    dowel: float  # [m] diameter
    dowel_length: float  # [m]
    turned: float  # [rad] of the seams against the bowl's axes
    lugs: Floats  # (N, 3, 3) of each screw: its middle [m], its direction, off the wall
    joined: tuple[Points, Triangles] | None  # vertices, faces of the bowl with lugs, bored; None without
    ends: tuple[int, int] = (0, 0)  # of seams, that have no screw where screws are asked for; and of how many

    @property
    def dowels(self) -> int:
        """Return how many."""
        return len(self.places)

    @property
    def remarks(self) -> tuple[str, ...]:
        """Return what must not be overlooked of ends of seams that have no screw, a tuple of str."""
        bare, ends = self.ends
        if not bare:
            return ()
        what = f"{bare} of {ends} ends of seams have no room for a lug: dowels alone hold them there"
        return (str(FeederError("join", what, "glue those seams, or take a larger bed")),)

    @property
    def screws(self) -> Points:
        """The middle (N, 3) [m] of each screw, in the bowl's axes."""
        return self.lugs[:, 0]


SEGMENTS_COLUMNS: tuple[Column[Segments], ...] = (
    Column("segments", lambda cut: [values(PIECE_COLUMNS, piece) for piece in cut.pieces]),
    Column("dowels", lambda cut: cut.dowels),
    Column("dowel_mm", lambda cut: cut.dowel, "mm"),
    Column("dowel_length_mm", lambda cut: cut.dowel_length, "mm"),
    Column("screws", lambda cut: len(cut.screws)),
    Column("screw", lambda cut: SCREW_NAME if len(cut.screws) else None),
    Column("seam_ends", lambda cut: cut.ends[1]),
    Column("seam_ends_without_screw", lambda cut: cut.ends[0]),
    Column("seams_deg", lambda cut: cut.turned, "deg"),
)


def bed(text: str) -> tuple[float, ...]:
    """Return the size of a printer's bed as typed.

    Parameters
    ----------
    text : str
        '220x220x250mm'

    Returns
    -------
    tuple of float [m]
        x, y, z.

    Raises
    ------
    ArgumentError
        If it is not three lengths above 0.
    """
    sides, size = text.replace("×", "x").lower().split("x"), []
    unit = sides[-1].lstrip(" 0123456789.+-")
    try:
        if len(sides) != 3:
            what = f"{units.quantity_text(text)} is not three lengths"
            raise units.QuantityError(what, "write 220x220x250mm")
        for side in sides:
            has_unit = side.strip().lstrip("0123456789.+-")
            size.append(units.quantity(side if has_unit else f"{side}{unit}", "length"))
    except units.QuantityError as fault:
        raise ArgumentError("bed", fault.what, fault.mend) from None
    if min(size) <= 0.0:
        what = f"{units.quantity_text(text)} has a side of 0 or less"
        raise ArgumentError("bed", what, "write 220x220x250mm")
    return tuple(size)


def segments(solid: "BowlSolid", size: tuple[float, ...], joint: str = DOWELS) -> Segments:
    """Return a bowl in pieces that fit a printer's bed, whole where it fits as it is.

    Parameters
    ----------
    solid : BowlSolid
    size : (float, float, float) [m]
        Of the bed, and of the height that is printed.
    joint : str
        Of ``JOINTS``: dowels alone, or screws in lugs outside the wall as well.

    Returns
    -------
    Segments
        Each piece with its lowest corner at the origin.

    Raises
    ------
    FeederError
        If it takes more than six segments in one direction, or no lug for a screw has room.
    """
    plan, screwed = solid.plan, joint == SCREWS
    counts, turn, extents = _seams(solid, size, screwed)
    body = facets.placed(solid).rotate((0.0, 0.0, -float(np.degrees(turn))))
    planes = [
        (axis, low + (high - low) * k / count)
        for axis, (count, (low, high)) in enumerate(zip(counts, extents))
        for k in range(1, count)
    ]
    dowel = SHARE * min(plan.material.wall, plan.material.floor)
    holes = [hole for plane in planes for hole in _dowels(solid, body, turn, plane, dowel)]
    lugs: list[Lug] = []
    bare, ends, joined = 0, 0, None
    if screwed:
        s = np.linspace(_tooled(plan)[0], plan.path.end + plan.outlet, 120)
        edges = [facets.as_filed(plan, plan.path.plan(s, y)) for y in (-plan.material.wall, plan.width)]
        tooled_lines = shapely.MultiLineString([facets.about_axis(edge, -turn) for edge in edges])
        lugs, bare, ends = place_lugs(body, planes, tooled_lines, _box(solid.vertices, turn))
        if planes and not lugs:
            raise FeederError("join", "no lug for a screw has room at the seams", "take dowels")
    if lugs:
        # the bowl with its lugs, and its surface in the bowl's own axes
        body = facets.united([body, *(lug.body for lug in lugs)])
        body = facets.without(body, [hole for lug in lugs for hole in lug.holes])
        joined = whole_surface.mesh(body.rotate((0.0, 0.0, float(np.degrees(turn)))))
    placed = np.array([(lug.middle, lug.along, lug.out) for lug in lugs]).reshape(-1, 3, 3)
    rods = [facets.rod(axis, middle, dowel, DOWEL_HOLE_DEPTH_M) for axis, middle in holes]
    cells = facets.cut_by(facets.without(body, rods), planes)
    loose = [piece for cell in cells for piece in facets.parts_of(cell)]
    pieces = []
    for k, piece in enumerate(sorted(loose, key=lambda piece: piece.bounding_box()), start=1):
        on_bed = tuple(-low for low in piece.bounding_box()[:3])
        vertices, faces = whole_surface.mesh(piece.translate(on_bed))
        x, y, z = map(float, vertices.max(axis=0))
        pieces.append(Segment(f"segment_{k}", vertices, faces, (x, y, z), piece.volume() * MM**3))
    return Segments(
        pieces=tuple(pieces),
        places=np.array([middle for _, middle in holes]).reshape(-1, 3),
        dowel=dowel,
        dowel_length=2.0 * DOWEL_HOLE_DEPTH_M,
        turned=turn,
        lugs=facets.about_axis(placed, turn),
        joined=joined,
        ends=(bare, ends),
    )


def _seams(
    solid: "BowlSolid", size: tuple[float, ...], screwed: bool
) -> tuple[tuple[int, ...], float, Points]:
    """Segments along each axis, the turn of the seams, and the box (3, 2) [m] of the bowl turned back by it.

    The box has room for the lugs of screws.
    Of the turns with fewest segments the one whose seams keep farthest from the devices.
    """
    seams = []
    for turn in 0.5 * np.pi * np.arange(SEAM_POSITIONS) / SEAM_POSITIONS:
        extents = _box(solid.vertices, turn)
        counts = _counts(extents, size)
        if screwed and max(counts) > 1:
            extents = extents + STANDS * np.array([[-1.0, 1.0], [-1.0, 1.0], [0.0, 0.0]])
            counts = _counts(extents, size)
        # the least distance from an upright seam to the tooled stretch
        corners, clearance = _box_points(solid, turn), 1.0
        for axis, (low, high) in enumerate(extents[:2]):
            for k in range(1, counts[axis]):
                offset = corners[:, axis] - (low + (high - low) * k / counts[axis])
                crossed = offset.min() < 0.0 < offset.max()
                clearance = min(clearance, 0.0 if crossed else float(np.abs(offset).min()))
        seams.append(((np.prod(counts), -round(clearance, 9), float(turn)), counts, float(turn), extents))
    _, counts, turn, extents = min(seams, key=lambda seam: seam[0])
    if max(counts) > MAX_SEGMENTS:
        least = " x ".join(f"{1e3 * (high - low) / MAX_SEGMENTS:.4g}" for low, high in extents)
        sentence = " x ".join(f"{1e3 * side:.4g}" for side in size)
        what = f"{sentence} mm takes more than {MAX_SEGMENTS} segments in one direction"
        raise ArgumentError("bed", what, f"give at least {least} mm, or a smaller bowl")
    return counts, turn, extents


def _box(vertices: Points, turn: float) -> Points:
    points = facets.about_axis(vertices, -turn)
    return np.column_stack([points.min(axis=0), points.max(axis=0)])


def _counts(extents: Points, size: tuple[float, ...]) -> tuple[int, ...]:
    """Return how many beds of a size a box (3, 2) takes along each axis."""
    return tuple(int(np.ceil((high - low) / side - 1e-9)) for (low, high), side in zip(extents, size))


def _box_points(solid: "BowlSolid", turn: float) -> Points:
    """Places (N, 2) [m] along the devices, in the axes of the seams."""
    plan = solid.plan
    first, last = _tooled(plan)
    s, y = np.meshgrid(np.linspace(first, last, 30), [0.0, plan.width])
    return facets.about_axis(facets.as_filed(plan, plan.path.plan(s.ravel(), y.ravel())), -turn)


def _tooled(plan: BowlPlan) -> tuple[float, float]:
    """From and to [m] along the wall where no dowel and, if it can be, no seam shall be."""
    return (plan.first, plan.path.end) if plan.stretch is not None else (plan.path.end - 1e-3, plan.path.end)


def _dowels(
    solid: "BowlSolid", body: Body, turn: float, plane: tuple[int, float], size: float
) -> list[tuple[int, Points]]:
    """Places (axis, middle (3,) [m]) of dowels across a seam: in solid, apart, and none below a cut."""
    axis, at = plane
    offs = (-DOWEL_HOLE_DEPTH_M, 0.0, DOWEL_HOLE_DEPTH_M)
    areas = [facets.cut_face(body, axis, at + off).buffer(-LAND * size) for off in offs]
    area = areas[0].intersection(areas[1]).intersection(areas[2])
    if area.is_empty:
        return []
    low_u, low_v, high_u, high_v = area.bounds
    ends = (low_u, high_u), (low_v, high_v)
    u, v = np.meshgrid(*(np.arange(low, high + DOWEL_GRID_M, DOWEL_GRID_M) for low, high in ends))
    places = np.column_stack([u.ravel(), v.ravel()])
    places = places[shapely.contains_xy(area, *places.T)]
    ring = shapely.MultiPoint(_box_points(solid, turn)).convex_hull.buffer(2.0 * size)
    dowels: list[tuple[int, Vector]] = []
    for place in places:
        middle = np.insert(place, axis, at)
        if shapely.contains_xy(ring, *middle[:2]):
            continue
        if all(np.sum((middle - other) ** 2) > DOWEL_SPACING_M**2 for _, other in dowels):
            dowels.append((axis, middle))
    return dowels


def overhangs(solid: "BowlSolid") -> dict[str, float]:
    """Return the area that hangs over by more than 45 deg, printed as a bowl stands.

    Parameters
    ----------
    solid : BowlSolid

    Returns
    -------
    dict of str to float [m2]
        By what it belongs to; nothing of less than a square centimetre.
    """
    plan, corners = solid.plan, solid.vertices[solid.faces]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    area = 0.5 * np.sqrt((across**2).sum(axis=1))
    down = -across[:, 2] > (np.sqrt(0.5) + 1e-6) * 2.0 * area
    high = corners[..., 2].max(axis=1) > solid.vertices[:, 2].min() + 1e-4
    # what of the bowl each facet belongs to, by its middle with the outlet at the angle 0
    path, (x, y, z) = plan.path, facets.as_planned(plan, corners.mean(axis=1)).T
    r, theta = np.hypot(x, y), np.arctan2(y, x)
    behind = theta - FULL_TURN_RAD * (theta > 0.0) - FULL_TURN_RAD * np.arange(int(plan.turns) + 2)[:, None]
    s = path.at(behind)  # of each turn of the track that is there
    inwards = (path.wall_radius(s) - r) / np.cos(path.bank_at(s))
    above = z - path.height(s, inwards)
    deep = -(plan.material.plate + plan.across + plan.hanging)
    aside = (inwards > -SURFACE_DISTANCE_M) & (inwards < plan.width + SURFACE_DISTANCE_M)
    on_track = (aside & (above > deep) & (above < SURFACE_DISTANCE_M)).any(axis=0)
    lowest = float(path.wall_radius(path.rises(plan.width)))
    # what is straight beyond the end of the track
    far = path.radius - plan.across - plan.material.wall
    above = z > plan.outlet_height - 2.0 * plan.material.plate - fillet(plan) - plan.hanging
    outlet = (y > -SURFACE_DISTANCE_M) & (x > far - SURFACE_DISTANCE_M) & above
    floor = (r < plan.ring + SURFACE_DISTANCE_M) | ((z < SURFACE_DISTANCE_M) & (r < lowest))
    where = np.select([outlet, on_track, floor], ["outlet", "track", "floor"], "wall")
    names = "floor", "wall", "track", "outlet"
    areas = {name: float(area[down & high & (where == name)].sum()) for name in names}
    return {name: overhang for name, overhang in areas.items() if overhang > 1e-4}
