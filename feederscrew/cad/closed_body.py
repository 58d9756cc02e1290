"""The bowl as one body: made of swept, turned and extruded pieces."""

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from types import ModuleType
from typing import TYPE_CHECKING

import numpy as np
import shapely

from feederscrew.base.arrays import Floats, Points, Triangles, Vector
from feederscrew.base.columns import Column
from feederscrew.base.errors import FeederError
from feederscrew.bowl.devices.features import Blade
from feederscrew.bowl.record import Unbalance
from feederscrew.cad import facets, track
from feederscrew.cad.facets import Body
from feederscrew.cad.plan import BOLT_CLEARANCE_M, CONICAL, FULL_TURN_RAD, BowlPlan
from feederscrew.cad.segments import Segments
from feederscrew.part import mass
from feederscrew.sorting import whole_surface
from feederscrew.sorting.tooled_track import PlacedDevice

if TYPE_CHECKING:
    from feederscrew.cad.exact.exact_file import StepFile

PIECE_OVERLAP_M = 1e-3  # [m] by which one piece reaches into another
BEYOND_BOWL_M = 1.0  # [m] beyond everything
GATE_PLAY_M = 1e-4  # [m] of a gate in its notch, to each side
SHORTER = 0.99  # of the turns that were asked for: less is said
BLADE_REACH_M = 2e-6  # [m] from wall and track: a blade that is as near goes on into them
BLADE_STEP_M = 1e-3  # [m] between places of a blade that are lifted onto the track
BEYOND_PLATE_M = 0.05  # [m] above and below a blade
EARS = 4e-3  # [m] by which a gate stands out of the wall
WALL_LIFT_M = 3e-4  # [m] by which the wall ends higher than the floor below it
QUARTER_TURN_POINTS = 16  # places in a quarter turn that a curve is led through


@dataclass(frozen=True, eq=False)
class BowlSolid:
    """A bowl as a closed surface, with what it is and weighs."""

    plan: BowlPlan
    vertices: Points  # (V, 3) [m]
    faces: Triangles  # (F, 3)
    gates: tuple[tuple[str, Points, Triangles], ...]  # name, vertices and faces of each part of its own
    volume: float  # [m3]
    mass: float  # [kg] gates included
    tensor: Floats  # (3, 3) [kg m2] inertia about its centre of mass
    centre: Vector  # (3,) [m]
    falls: dict = field(default_factory=dict)  # where what falls through each cut comes to lie
    turns_of_sheet: float = 0.0  # that the sheet has, and the solid may not have room for
    riders: tuple = ()  # (Orientation, s [m]) of parts along its track, to draw
    segments: Segments | None = None  # where it is cut to fit a printer
    step: "StepFile | None" = None  # where it was asked for

    @property
    def inertia(self) -> float:
        """Inertia [kg m2] about the axis."""
        return float(self.tensor[2, 2] + self.mass * (self.centre[0] ** 2 + self.centre[1] ** 2))

    @property
    def unbalance(self) -> Unbalance:
        """Return how its mass lies about the axis, over its underside: that lies on the leaves."""
        place = self.centre - [0.0, 0.0, self.plan.underside]
        about = mass.shift_inertia(self.tensor, self.mass, place)
        x, y, z = map(float, self.mass * place)
        return Unbalance(
            moment=(x, y, z),
            upright=(float(about[0, 0]), float(about[1, 1])),
            products=(float(-about[1, 2]), float(-about[0, 2]), float(-about[0, 1])),
            turns=-1.0 if self.plan.left else 1.0,
        )

    @property
    def balance(self) -> tuple[float, float]:
        """Mass [kg] and angle about Z [rad] of a weight on the wall that centres it."""
        x, y, _ = self.centre
        return float(self.mass * np.hypot(x, y) / self.balanced_at), float(np.arctan2(-y, -x))

    @property
    def balanced_at(self) -> float:
        """Radius [m] at which that weight is: of the wall's outer face."""
        return self.plan.path.radius + self.plan.material.wall

    @property
    def weight(self) -> tuple[float, tuple[float, float, float]]:
        """The weight as mass [kg] and place (3,) [m] over the underside, as high as the centre of mass."""
        kilograms, angle = self.balance
        x, y = self.balanced_at * np.cos(angle), self.balanced_at * np.sin(angle)
        return kilograms, (float(x), float(y), float(self.centre[2] - self.plan.underside))

    @property
    def remarks(self) -> tuple[str, ...]:
        """Return what must not be overlooked, a tuple of str."""
        remarks = () if self.segments is None else self.segments.remarks
        if self.plan.stairs is not None or self.plan.turns >= SHORTER * self.turns_of_sheet:
            return remarks
        turns = f"{self.plan.turns:.3g} turns in place of {self.turns_of_sheet:.3g}"
        what = f"{turns}, or what falls through a cut would stay on the turn below"
        shortened = FeederError("sizing.outlet_height", what, "sizing.shape: stepped has room for more")
        return (str(shortened), *remarks)

    @property
    def with_lugs(self) -> "BowlSolid":
        """The bowl as its segments make it up, with the lugs of their screws; itself without."""
        if self.segments is None or self.segments.joined is None:
            return self
        vertices, faces = self.segments.joined
        volume = float(mass.integrate_solid(vertices[faces]).volume)
        return replace(self, vertices=vertices, faces=faces, volume=volume)


SOLID_COLUMNS: tuple[Column[BowlSolid], ...] = (
    Column("diameter_mm", lambda solid: 2.0 * solid.plan.path.radius, "mm"),
    Column("solid_volume_mm3", lambda solid: solid.volume, "mm3"),
    Column("solid_mass_kg", lambda solid: solid.mass, "kg"),
    Column("solid_inertia_kg_m2", lambda solid: solid.inertia, "kg m2"),
    Column("solid_centre_of_mass_mm", lambda solid: solid.centre, "mm"),
    Column("balance_weight_kg", lambda solid: solid.balance[0], "kg"),
    Column("balance_angle_deg", lambda solid: solid.balance[1], "deg"),
    Column("balance_radius_mm", lambda solid: solid.balanced_at, "mm"),
    Column("solid_extent_mm", lambda solid: np.ptp(solid.vertices, axis=0), "mm"),
    Column("solid_facets", lambda solid: len(solid.faces)),
    Column("material", lambda solid: solid.plan.material.name),
    Column("shape", lambda solid: "cylinder" if solid.plan.stairs is None else solid.plan.stairs.shape),
    Column("falls_to", lambda solid: solid.falls),
    Column("hand", lambda solid: "left" if solid.plan.left else "right"),
    Column("wall_mm", lambda solid: solid.plan.material.wall, "mm"),
    Column("floor_mm", lambda solid: solid.plan.material.floor, "mm"),
    Column("track_plate_mm", lambda solid: solid.plan.material.plate, "mm"),
    Column("wall_height_mm", lambda solid: solid.plan.top, "mm"),
    Column("dome_rise_mm", lambda solid: solid.plan.dome, "mm"),
    Column("solid_turns", lambda solid: solid.plan.turns),
    Column("outlet_height_mm", lambda solid: solid.plan.outlet_height, "mm"),
    Column("outlet_angle_deg", lambda solid: solid.plan.turned, "deg"),
    Column("bolts", lambda solid: solid.plan.bolts),
    Column("bolt_hole_mm", lambda solid: solid.plan.bolt, "mm"),
    Column("bolt_circle_mm", lambda solid: solid.plan.bolt_circle, "mm"),
    Column("chord_mm", lambda solid: solid.plan.chord, "mm"),
    Column("separate_parts", lambda solid: [name for name, _, _ in solid.gates]),
)


def body(plan: BowlPlan) -> BowlSolid:
    """Return the bowl of a plan as one closed solid, and its gates.

    Parameters
    ----------
    plan : BowlPlan

    Returns
    -------
    BowlSolid

    Raises
    ------
    FeederError
        If cuts leave a piece loose.
    """
    whole, gates = pieces(plan)
    (_, vertices, faces), *extra = (
        (name, *whole_surface.mesh(facets.placed_as(piece, mirrored=plan.left, turned=plan.turned)))
        for name, piece in [("bowl", whole), *gates]
    )
    solids = [mass.integrate_solid(v[f]) for v, f in [(vertices, faces), *(gate[1:] for gate in extra)]]
    total, centre, inertia = _weighed(plan, solids)
    volume = float(solids[0].volume)
    return BowlSolid(plan, vertices, faces, tuple(extra), volume, total, inertia, centre)


def screwed(solid: BowlSolid, weight: float) -> BowlSolid:
    """Return a bowl in segments that weighs what it does with its lugs and screws.

    Each screw is a point mass m: I = I_0 + sum m (r^2 E - r r^T), about the new centre of mass.

    Parameters
    ----------
    solid : BowlSolid
    weight : float [kg]
        Of one screw.

    Returns
    -------
    BowlSolid
        As it is where it has no screws.

    References
    ----------
    Steiner's theorem, ``part.mass.shift_inertia``.
    """
    if solid.segments is None or solid.segments.joined is None:
        return solid
    vertices, faces = solid.segments.joined
    bodies = [mass.integrate_solid(v[f]) for v, f in ((vertices, faces), *(gate[1:] for gate in solid.gates))]
    bare, middle, tensor = _weighed(solid.plan, bodies)
    at = solid.segments.screws
    total = bare + weight * len(at)
    centre = (bare * middle + weight * at.sum(axis=0)) / total
    tensor = mass.shift_inertia(tensor, bare, middle - centre)
    for item in at:
        tensor = mass.shift_inertia(tensor, weight, item - centre)
    return replace(solid, mass=float(total), centre=centre, tensor=tensor)


def _weighed(plan: BowlPlan, parts: list[mass.Solid]) -> tuple[float, Vector, Floats]:
    """Mass [kg], centre (3,) [m] and inertia (3, 3) [kg m2] about it of a bowl with its gates."""
    density = plan.material.density
    weights = [density * part.volume for part in parts]
    total = float(sum(weights))
    centre = sum((w * part.centre for w, part in zip(weights, parts)), np.zeros(3)) / total
    inertia = np.zeros((3, 3))
    for w, part in zip(weights, parts):
        inertia = inertia + mass.shift_inertia(density * part.inertia, w, part.centre - centre)
    return total, centre, inertia


def pieces(plan: BowlPlan, kit: ModuleType = facets) -> tuple[Body, list[tuple[str, Body]]]:
    """Return the bowl as one body, and its gates, the outlet at the angle 0.

    Wall, floor, track, plates and groove walls are made one by one, cut, and united. Gates stay apart: they
    are screwed into a notch of the wall.

    Parameters
    ----------
    plan : BowlPlan
    kit : module
        ``facets`` or ``exact_body``, which the bodies are made with.

    Returns
    -------
    Body [mm]
        The bowl.
    list of (str, Body [mm])
        Name and body of each gate.

    Raises
    ------
    FeederError
        If cuts leave a piece loose.
    """
    chain = () if plan.stretch is None else plan.stretch.devices
    blades = [(placed, blade) for placed in chain for blade in placed.features.blades]
    own_gates = [(placed, blade) for placed, blade in blades if blade.is_gate]
    wall, *ends = walls(plan, kit)
    # the outlet passes through the wall
    end, far = plan.path.end, plan.path.end + 2.0 * plan.outlet
    outlet = np.array([[end, 0.0], [far, 0.0], [far, plan.width], [end, plan.width]])
    low, lift = plan.outlet_height - 0.5 * plan.material.plate, plan.width * np.sin(plan.path.bank_at(end))
    open_wall = [kit.over(plan.path, outlet, low, plan.top + lift + BEYOND_BOWL_M, plan.chord)]
    open_wall += [_notch(plan, kit, *gate) for gate in own_gates]
    standing = [blade for blade in blades if not blade[1].is_gate]
    tooled = tooled_bodies(plan, kit, kit.without(wall, open_wall), standing)
    added = [*track.sides(plan, kit), *track.yokes(plan, kit)]
    whole = kit.united([*_floor(plan, kit), *ends, *tooled, *added])
    # holes of the bolts, in the middle and on their circle, and drain holes
    holes = [((0.0, 0.0), plan.bolt)]
    for r, count, size, phase in (
        (0.5 * plan.bolt_circle, plan.bolts, plan.bolt, 0.5),
        (plan.ring + BOLT_CLEARANCE_M - plan.drain, plan.drains, plan.drain, 0.0),
    ):
        angles = FULL_TURN_RAD * (np.arange(count) + phase) / max(count, 1)
        holes += [((r * np.cos(a), r * np.sin(a)), size) for a in angles]
    low, high = plan.underside - PIECE_OVERLAP_M, plan.dome + PIECE_OVERLAP_M
    drilled = [kit.disc(at, size, low, high) for at, size in holes]
    whole = kit.without(whole, [*track.holes(plan, kit, hang=True), *drilled])
    gates = [(f"gate_{k + 1}", _plate(plan, kit, *gate)) for k, gate in enumerate(own_gates)]
    return kit.one_piece(whole, "devices"), gates


def tooled_bodies(
    plan: BowlPlan, kit: ModuleType, wall: Body, blades: Sequence[tuple[PlacedDevice, Blade]]
) -> list[Body]:
    """Return the wall and the track with what devices cut and set: of a bowl, and of a section to print.

    Slots that parts hang in are not cut yet: they go through all that stands in their way.

    Parameters
    ----------
    plan : BowlPlan
    kit : module
        ``facets`` or ``exact_body``, which the bodies are made with.
    wall : Body [mm]
        Whole, but for its outlet.
    blades : sequence of (PlacedDevice, Blade)
        Those that stand on the track as a part of it.

    Returns
    -------
    list of Body [mm]
        To be united.
    """
    cuts, leaning = track.groove_walls(plan, kit)
    chain = () if plan.stretch is None else plan.stretch.devices
    deep = 2.0 * (plan.material.wall + PIECE_OVERLAP_M)
    drilled: list[Body] = []
    for placed, bore in [(item, bore) for item in chain for bore in item.features.bores]:
        s = plan.first + placed.begin + bore.place
        begin, outwards = plan.path.bore(s, bore.height, PIECE_OVERLAP_M, bore.angle)
        drilled.append(kit.bore(begin, outwards, bore.diameter, deep / math.sin(bore.angle)))
    slab = kit.without(track.slab(plan, kit), track.holes(plan, kit, hang=False))
    plates = [_plate(plan, kit, *blade) for blade in blades]
    if drilled:  # a nozzle's bore goes through the root of a blade within the wall, not through its face
        within = [kit.without(one, [kit.without(one, [wall])]) for one in drilled]
        plates = [kit.without(plate, within) for plate in plates]
    return [kit.without(wall, [*cuts, *drilled]), slab, *plates, *track.ledges(plan, kit), *leaning]


def _floor(plan: BowlPlan, kit: ModuleType) -> list[Body]:
    """Floor with its dome, and the hub below it."""
    low, inner, outer = plan.underside, plan.ring, plan.path.radius + plan.material.wall
    edge = []
    if plan.stairs is not None:
        # between the floor and the wall, which is no surface of revolution
        outer = inner + PIECE_OVERLAP_M
        hole = inner - 0.7 * PIECE_OVERLAP_M, low - PIECE_OVERLAP_M, PIECE_OVERLAP_M
        theta = np.linspace(-FULL_TURN_RAD, 0.0, (64 if kit.HAS_EXACT_CURVES else plan.segments) + 1)[:-1]
        sections = plan.stairs.sections(plan.path, theta, low - 2e-3)
        r = np.array([np.interp(0.0, each[:, 1], each[:, 0]) for each in sections]) + 0.3 * plan.material.wall
        rim = np.column_stack([r * np.cos(theta), r * np.sin(theta)])
        edge = [kit.without(kit.patch(rim, low, 0.0), [track.drum(plan, kit, *hole)])]
    top = [(outer, 0.0), (inner, 0.0), (0.0, plan.dome)]
    if plan.material.flat:
        return [kit.turned([(0.0, low), (outer, low), *top], plan.segments), *edge]
    shell = [(0.0, plan.dome + low), (inner, low), (outer, low), *top]
    below_hub, middle = float(plan.floor(plan.hub)) + 0.5 * low, plan.dome + 0.5 * low
    hub = [(0.0, low), (plan.hub, low), (plan.hub, below_hub), (0.0, middle)]
    return [kit.united([kit.turned(profile, plan.segments) for profile in (shell, hub)]), *edge]


def walls(plan: BowlPlan, kit: ModuleType) -> list[Body]:
    """Return the bodies that make the wall, the outlet at the angle 0.

    Parameters
    ----------
    plan : BowlPlan
    kit : module
        ``facets`` or ``exact_body``, which the bodies are made with.

    Returns
    -------
    list of Body [mm]
        The wall; of a stepped or conical bowl also the plate that closes its last turn.
    """
    if plan.stairs is None:
        r, far, low = plan.path.radius, plan.path.radius + plan.material.wall, plan.underside
        profile = [(r, low + PIECE_OVERLAP_M), (far, low), (far, plan.top), (r, plan.top)]
        return [kit.turned(profile, plan.segments)]
    legs, places = [], QUARTER_TURN_POINTS if kit.HAS_EXACT_CURVES else plan.segments // 4
    quarters = FULL_TURN_RAD * np.array([-1.0, -0.75, -0.5, -0.25, 0.0])
    for start, end in itertools.pairwise(quarters.tolist()):
        theta = np.linspace(start, end, places + 1)
        inner = plan.stairs.sections(plan.path, theta, plan.underside - 2e-3)
        inner = np.concatenate([inner, inner[:, -1:]], axis=1)
        inner[:, -1, 1] = plan.top
        outer = inner + [plan.material.wall, 0.0]
        outer[:, 1:-2, 1] -= plan.material.wall
        # no corner of the track's own: an edge on its surface cuts badly; of a cone all feet lie on one line
        last = inner.shape[1] - 1
        corners = [k for k in range(last + 1) if k % 3 or k in (0, last)]
        if plan.stairs.shape == CONICAL:
            corners = [0, last - 1, last]
        sections = np.concatenate([outer[:, corners], inner[:, corners[::-1]]], axis=1)
        sine = np.where(theta == -FULL_TURN_RAD, 0.0, np.sin(theta))  # the two ends meet there
        towards = np.stack([np.cos(theta), sine], axis=-1)
        legs.append((sections, np.stack([np.zeros_like(towards), towards], axis=1)))
    wall = kit.united([kit.swept(legs[:2]), kit.swept(legs[2:])])
    inner = plan.stairs.sections(plan.path, np.zeros(1), plan.underside - 2e-3)[0]
    low, rest, half = inner[-4], inner[-4:], 0.5 * plan.material.wall
    under = plan.outlet_height - 0.5 * plan.material.plate
    ring = [*(rest[1:3] + [half, -half]), [rest[3][0] + half, under], [low[0] + half, under]]
    axes = np.column_stack([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])
    end = kit.plank(shapely.Polygon(ring), plan.material.wall, axes, [0.0, 0.0, 0.0])
    return [kit.above(body, plan.underside + WALL_LIFT_M) for body in (wall, end)]


def _plate(plan: BowlPlan, kit: ModuleType, placed: PlacedDevice, blade: Blade) -> Body:
    """A blade on the track, carried on into the wall; a gate of its own has an ear through that."""
    axes, foot = plan.path.blade_frame(blade, plan.first + placed.begin)
    s = plan.first + placed.begin + blade.foot[0]
    into = 0.5 * plan.material.wall
    if not blade.is_gate:
        area = _above_track(plan, blade.carried_into(into, into, BLADE_REACH_M), axes, foot, s)
        plate = kit.plank(shapely.normalize(area), blade.thickness, axes, foot)
        # what leans with a banked track, or is swept back, stays within the wall
        inner = float(plan.path.wall_radius(s)) + into
        low, high = float(foot[2]) - into - BEYOND_PLATE_M, float(foot[2]) + blade.top + BEYOND_PLATE_M
        ring = [(inner, low), (2.0 * inner, low), (2.0 * inner, high), (inner, high)]
        return kit.without(plate, [kit.turned(ring, plan.segments)])
    area = blade.carried_into(into, 0.0, BLADE_REACH_M).intersection(
        shapely.box(-into, 0.0, BEYOND_BOWL_M, blade.top)
    )
    area = _above_track(plan, area, axes, foot, s)
    # it stands on the track: a gate is fixed by its ear
    ear = shapely.box(-plan.material.wall - EARS, 0.0, PIECE_OVERLAP_M - into, blade.top)
    return kit.plank(shapely.normalize(shapely.union_all([area, ear])), blade.thickness, axes, foot)


def _above_track(
    plan: BowlPlan, area: shapely.Geometry, axes: Floats, foot: Vector, begin: float
) -> shapely.Geometry:
    """The face of a blade, its heights those over the track everywhere, and not over a straight line."""

    def lifted(points: Points) -> Points:
        along = np.maximum(points[:, 0], 0.0)
        return np.column_stack([points[:, 0], points[:, 1] + plan.path.rise_along(axes, foot, begin, along)])

    bent = shapely.transform(shapely.segmentize(area, BLADE_STEP_M), lifted)
    return shapely.simplify(bent, BLADE_REACH_M)


def _notch(plan: BowlPlan, kit: ModuleType, placed: PlacedDevice, blade: Blade) -> Body:
    """The notch of a gate in the wall, open above, with play to each side."""
    axes, foot = plan.path.blade_frame(blade, plan.first + placed.begin)
    bank = max(float(plan.path.bank_at(plan.first + placed.begin)), 0.0)
    inner = PIECE_OVERLAP_M + plan.top * np.tan(bank)  # on a banked track the wall leans over it
    area = shapely.box(-plan.material.wall - PIECE_OVERLAP_M, -GATE_PLAY_M, inner, BEYOND_BOWL_M)
    behind = axes[:, 2]
    return kit.plank(area, blade.thickness + 2.0 * GATE_PLAY_M, axes, foot - GATE_PLAY_M * behind)
