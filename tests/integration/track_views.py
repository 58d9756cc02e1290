"""One tooled track as each consumer has it, in the same coordinates: s along the wall, y from it, z over it.

Each view is made of what leaves the program: the plates and borders of the trial, the mesh of the printed
section or its body with exact faces, the mesh of the bowl, and the lines of the DXF file.
"""

import functools
import io
from collections.abc import Callable
from dataclasses import dataclass, replace

import ezdxf
import numpy as np
import shapely
from shapely import affinity

from feederscrew.cad import facets
from feederscrew.cad import section as printed
from feederscrew.output import tooling_drawing

MM = 1e-3
UNDER = 6e-5  # [m] below a surface, where it is cut
FINE = 1e-3  # [m] of a line, between places that are unbent
REFINED = 2.0  # [mm] of an edge of a mesh as it is unrolled
BESIDE = 0.01  # [m] before and behind a device that is looked at with it
WALL_DEPTH = 5e-4  # [m] behind the wall's face, where bores are seen


@dataclass(frozen=True)
class View:
    """One device as a consumer has it; s from its begin, z over the track there."""

    floor: Callable  # level [m] -> material just below a surface at that level
    over: Callable  # height [m] -> material there, of what stands on the track
    bores: list  # (s, z, diameter) [m] of nozzles in the wall
    faces: list = ()  # of blades, seen along the track: distance from the wall and height [m]
    ramp: Callable | None = None  # level [m] -> what of ramps is above it


def unbent(area, radius, middle=0.0):
    """An area of the bowl's plan, the wall tangent to X at the origin, as lengths and distances [m].

    Lengths are within half a turn of ``middle`` [m].
    """

    def laid(points):
        x, y = points.T
        return np.column_stack(
            [around(np.arctan2(x, radius - y), radius, middle), radius - np.hypot(x, radius - y)]
        )

    return shapely.make_valid(shapely.transform(shapely.segmentize(area, FINE), laid))


def around(angles, radius, middle):
    """Lengths [m] along a wall at some angles [rad], those that are within half a turn of a length."""
    first = middle / radius - np.pi
    return radius * (first + (np.asarray(angles) - first) % (2.0 * np.pi))


def trial(stage, start, track, bank):
    """A stage of the trial, its device at ``start`` [m]; ``bank`` [rad] there."""
    plates = [plate_of(stage, row) for row in stage.plates]
    floors = [one for one in plates if abs(one[1][2, 2]) > 1.0 - 1e-9]
    ramps = [one for one in plates if 0.5 < abs(one[1][2, 2]) <= 1.0 - 1e-9]
    blades = [one for one in plates if abs(one[1][2, 2]) <= 0.5]

    def laid(areas):
        laid = unbent(shapely.union_all(areas), track.radius, stage.middle)
        return affinity.translate(laid, -start, 0.0)

    def floor(level):
        # a drop is upright: what is lower lies further out in the plane of the track, as the wall does
        rings = [ring for origin, _, _, ring in floors if abs(origin[2] - level * np.cos(bank)) < 1e-7]
        return affinity.translate(laid(rings), 0.0, -level * np.sin(bank))

    def ramp(level):
        """What of the ramps is above a level, seen from above."""
        areas = []
        for origin, axes, _, ring in ramps:
            high = ring.intersection(shapely.box(-1.0, -1.0, (level - origin[2]) / axes[0, 2], 1.0))
            flat = [*axes[0, :2], *axes[1, :2]]
            areas.append(affinity.affine_transform(high, [flat[0], flat[2], flat[1], flat[3], *origin[:2]]))
        return laid(areas)

    jets = stage.air.jets
    out = [around(_out_of_wall(j, track.radius), track.radius, stage.middle) for j in jets]
    bores = [(s - start, j["mouth_z"], 2.0 * j["radius"]) for s, j in zip(out, jets)]
    faces = []
    for origin, axes, _, area in blades:
        inwards = np.array([-origin[0], track.radius - origin[1]])
        inwards = inwards / np.hypot(*inwards)
        faces.append(affinity.scale(area, float((axes[0, :2] * inwards).sum()), 1.0, origin=(0.0, 0.0)))
    return View(
        floor, lambda height: laid([_slab(one, height) for one in blades]), in_order(bores), faces, ramp
    )


def _out_of_wall(jet, radius):
    """Angle [rad] at which the axis of a jet comes out of the wall."""
    x, y = jet["mouth_x"], jet["mouth_y"] - radius  # from the bowl's axis
    a, b = jet["towards_x"], jet["towards_y"]
    ahead = a * x + b * y
    way = -ahead - np.sqrt(max(ahead**2 - (a * a + b * b) * (x * x + y * y - radius**2), 0.0))
    return np.arctan2(x + way * a, -(y + way * b))


def crowded(stage, placed, track, bank):
    """A device on the track of a queue, which has all of them, as ``trial`` shows one alone."""
    whole = trial(stage, placed.begin, track, bank)
    lower, out = placed.level * np.cos(bank), placed.level * np.sin(bank)

    def own(height):
        return affinity.translate(whole.over(height + lower), 0.0, -out)

    bores = [(s, z - lower, size) for s, z, size in whole.bores]
    bores = [bore for bore in bores if placed.start < placed.begin + bore[0] < placed.end]
    return View(lambda level: whole.floor(placed.level + level), own, in_order(bores), [], whole.ramp)


def _plates(height, blades, laid):
    """What blades are, seen from above, at a height [m]."""
    return laid([_slab(one, height) for one in blades])


def plate_of(stage, row):
    """Origin (3,), axes (3, 3), depth [m] and area of a plate in its own plane."""
    names = [f"{head}_{end}" for head in ("origin", "first", "second", "front") for end in "xyz"]
    frame = np.array([row[name] for name in names]).reshape(4, 3)
    area, ring = shapely.Polygon(), []
    for border in stage.borders[row["begin"] : row["end"]]:
        ring.append((border["start_x"], border["start_y"]))
        if ring[0] == (border["end_x"], border["end_y"]):
            area, ring = area.symmetric_difference(shapely.Polygon(ring).buffer(0.0)), []
    return frame[0], frame[1:], row["depth"], area


def _slab(plate, height):
    """What a blade is, seen from above, at a height [m]."""
    origin, (along, _, front), depth, area = plate
    z = height - origin[2]
    level = shapely.LineString([(-1.0, z), (1.0, z)]).intersection(area)
    rings = []
    for near, _, far, _ in (one.bounds for one in shapely.get_parts(level) if one.length > 0.0):
        sides = ((near, 0.0), (far, 0.0), (far, depth), (near, depth))
        rings.append(shapely.Polygon([(origin + x * along - d * front)[:2] for x, d in sides]))
    return shapely.union_all(rings)


def unrolled_section(tooled):
    """The printed section, from its mesh, unrolled."""
    plan = printed.section_plan(tooled)
    vertices, faces = printed.solid(tooled)
    # as the bowl has it that it is cut out of
    turn = 0.5 * np.pi + float(plan.path.angle(plan.first))
    x, y, z = (vertices - [0.0, tooled.track.radius, 0.0]).T
    c, s = np.cos(turn), np.sin(turn)
    placed = np.column_stack([c * x - s * y, s * x + c * y, z])
    return plan, unroll(plan, mesh(placed, faces))


def _round_holes(flat, placed, start, bank):
    """Middles and diameters of round holes in an unrolled wall, beside a device; upright it leans over it."""
    bores = []
    for height, angle in sorted({(float(bore.height), bore.angle) for bore in placed.features.bores}):
        beside = height * np.tan(bank) - WALL_DEPTH
        back = beside / np.tan(angle)  # of the middle of one askew, behind where it comes out
        face = facets.cut_face(flat, 1, beside)
        for ring in (ring for part in shapely.get_parts(face) for ring in part.interiors):
            hole = shapely.Polygon(ring)
            s, z = hole.centroid.x - start - back, hole.centroid.y
            hole = affinity.scale(hole, np.sin(angle), 1.0)
            is_round = 4.0 * np.pi * hole.area / hole.length**2 > 0.95
            if is_round and placed.start < s < placed.end and abs(z - height) < 1e-4:
                bores.append((s - placed.begin, z, np.sqrt(4.0 * hole.area / np.pi)))
    return in_order(bores)


def in_order(bores):
    """Bores along the wall, those above each other upwards."""
    return sorted(bores, key=lambda bore: (round(bore[0], 4), bore[1]))


def bowl(flat, plan, placed):
    """A device on the bowl's solid, unrolled."""
    start = plan.first + placed.begin
    ends = (plan.first + placed.start - BESIDE) / MM, (plan.first + placed.end + BESIDE) / MM

    @functools.cache
    def beside(level):
        return flat(level).trim_by_plane((1.0, 0.0, 0.0), ends[0]).trim_by_plane((-1.0, 0.0, 0.0), -ends[1])

    def cut(z, level=0.0):
        return affinity.translate(facets.cut_face(beside(placed.level + level), 2, z), -start, 0.0)

    bank = float(plan.path.bank_at(start))
    bores = _round_holes(beside(placed.level), placed, plan.first, bank) if placed.features.bores else []
    return View(lambda level: cut(-UNDER, level), cut, bores)


def mesh(vertices, faces):
    """A body [mm] of a mesh [m]."""
    return facets.manifold3d.Manifold(facets.manifold3d.Mesh64(vertices / MM, faces.astype(np.uint64)))


def unrolled(made):
    """The tooled stretch of a bowl's mesh [mm], with its gates, unrolled."""
    whole = facets.unplaced(made)
    for _, vertices, faces in made.gates:
        whole = whole + mesh(vertices, faces)
    return unroll(made.plan, whole)


def unroll(plan, whole):
    """The tooled stretch of a body [mm]: s, y and height square to the track at a level."""
    way, wall = plan.path, plan.material.wall
    level = replace(way, drops=())
    ends = plan.first, way.end - 1e-4
    sides = -3.0 * wall, 1.2 * plan.width
    ring = np.array([[s, y] for y, s in ((sides[0], ends[0]), (sides[0], ends[1]), (sides[1], ends[1]),
                                         (sides[1], ends[0]))])  # fmt: skip
    low = min(float(way.height(at)) for at in np.linspace(*ends, 99)) - 2.0 * plan.material.plate
    piece = whole ^ facets.over(way, ring, low, plan.top + 1.0, 0.05 * plan.chord)

    def laid(points, below):
        x, y, z = np.asarray(points).T * MM
        theta = np.arctan2(y, x)
        s = way.at(np.where(theta > 1e-9, theta - 2.0 * np.pi, theta))
        out, up = way.wall_radius(s) - np.hypot(x, y), z - level.height(s) - below
        bank = way.bank_at(s)
        off, square = out * np.cos(bank) + up * np.sin(bank), up * np.cos(bank) - out * np.sin(bank)
        # square to its climb as well: the foot lies further along
        climb = np.arctan((level.risen(s + 1e-6) - level.risen(s - 1e-6)) / 2e-6)
        along = square * np.sin(climb) * way.wall_radius(s) / np.hypot(x, y)
        return np.column_stack([s + along, off, square * np.cos(climb)]) / MM

    piece = piece.refine_to_length(REFINED)
    return functools.cache(lambda below: piece.warp_batch(functools.partial(laid, below=below)))


@functools.cache
def drawing(tooled):
    """The outlines [m] of the DXF file by layer, its number left out, and the circles of its bores."""
    file = ezdxf.read(io.StringIO(tooling_drawing.dxf(tooled).decode()))
    rings, circles = {}, []
    for line in file.modelspace().query("LWPOLYLINE"):
        layer = line.dxf.layer.rstrip("0123456789").rstrip("_")
        rings.setdefault(layer, []).append(np.array([point[:2] for point in line.get_points()]) * MM)
    for circle in file.modelspace().query("CIRCLE"):
        middle = circle.dxf.center
        circles.append((middle.x * MM, middle.y * MM, 2.0 * circle.dxf.radius * MM))
    return rings, circles
