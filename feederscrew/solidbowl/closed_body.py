"""The bowl as one body: made of swept, turned and extruded pieces."""

from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
import shapely

from feederscrew.bowl.record import Unbalance
from feederscrew.errors import FeederError
from feederscrew.part import mass
from feederscrew.solidbowl import facets, stairs, track
from feederscrew.solidbowl.plan import BOLT_CLEARANCE_M, FULL_TURN_RAD, BowlPlan
from feederscrew.solidbowl.segments import Segments
from feederscrew.tooling import whole_surface

PIECE_OVERLAP_M = 1e-3  # [m] by which one piece reaches into another
BEYOND_BOWL_M = 1.0  # [m] beyond everything
GATE_PLAY_M = 1e-4  # [m] of a gate in its notch, to each side
SHORTER = 0.99  # of the turns that were asked for: less is said
EARS = 4e-3  # [m] by which a gate stands out of the wall


@dataclass(frozen=True, eq=False)
class BowlSolid:
    """A bowl as a closed surface, with what it is and weighs."""

    plan: BowlPlan
    vertices: np.ndarray  # (V, 3) [m]
    faces: np.ndarray  # (F, 3)
    gates: tuple[tuple[str, np.ndarray, np.ndarray], ...]  # name, vertices and faces of each part of its own
    volume: float  # [m3]
    mass: float  # [kg] gates included
    tensor: np.ndarray  # (3, 3) [kg m2] inertia about its centre of mass
    centre: np.ndarray  # (3,) [m]
    falls: dict = field(default_factory=dict)  # where what falls through each cut comes to lie
    turns_of_sheet: float = 0.0  # that the sheet has, and the solid may not have room for
    riders: tuple = ()  # (Orientation, s [m]) of parts along its track, to draw
    segments: Segments | None = None  # where it is cut to fit a printer
    step: object = None  # exact_file.StepFile, where it was asked for

    @property
    def inertia(self) -> float:
        """Inertia [kg m2] about the axis."""
        return float(self.tensor[2, 2] + self.mass * (self.centre[0] ** 2 + self.centre[1] ** 2))

    @property
    def unbalance(self) -> Unbalance:
        """How its mass lies about the axis, over its underside: that lies on the leaves."""
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
    def balance(self) -> tuple[Any, ...]:
        """Mass [kg] and angle about Z [rad] of a weight on the wall that centres it."""
        x, y, _ = self.centre
        return float(self.mass * np.hypot(x, y) / self.balanced_at), float(np.arctan2(-y, -x))

    @property
    def balanced_at(self):
        """Radius [m] at which that weight is: of the wall's outer face."""
        return self.plan.path.radius + self.plan.material.wall

    @property
    def weight(self) -> tuple[Any, ...]:
        """The weight as mass [kg] and place (3,) [m] over the underside, as high as the centre of mass."""
        kilograms, angle = self.balance
        x, y = self.balanced_at * np.cos(angle), self.balanced_at * np.sin(angle)
        return kilograms, (float(x), float(y), float(self.centre[2] - self.plan.underside))

    @property
    def remarks(self) -> tuple[Any, ...]:
        """What must not be overlooked, a tuple of str."""
        return (*self._shortened, *([] if self.segments is None else self.segments.remarks))

    @property
    def with_lugs(self):
        """The bowl as its segments make it up, with the lugs of their screws; itself without."""
        if self.segments is None or self.segments.joined is None:
            return self
        vertices, faces = self.segments.joined
        volume = float(mass.integrate_solid(vertices[faces]).volume)
        return replace(self, vertices=vertices, faces=faces, volume=volume)

    @property
    def _shortened(self) -> tuple[Any, ...]:
        if self.plan.stairs is not None or self.plan.turns >= SHORTER * self.turns_of_sheet:
            return ()
        what = (
            f"{self.plan.turns:.3g} turns in place of {self.turns_of_sheet:.3g}, or what falls through a cut"
        )
        what += " would stay on the turn below"
        return (str(FeederError("sizing.outlet_height", what, "sizing.shape: stepped has room for more")),)


def body(plan) -> BowlSolid:
    """Return the bowl of a plan.

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
    vertices, faces = whole_surface.mesh(facets.placed_as(whole, mirrored=plan.left, turned=plan.turned))
    solid = mass.integrate_solid(vertices[faces])
    extra = tuple(
        (name, *whole_surface.mesh(facets.placed_as(gate, mirrored=plan.left, turned=plan.turned)))
        for name, gate in gates
    )
    total, centre, inertia = _weighed(plan, [solid, *(mass.integrate_solid(v[f]) for _, v, f in extra)])
    return BowlSolid(plan, vertices, faces, extra, float(solid.volume), total, inertia, centre)


def screwed(solid, weight):
    """Return a bowl in segments that weighs as much as it does with its lugs and screws.

    Parameters
    ----------
    solid : BowlSolid
        With its segments; without screws it stays as it is.
    weight : float [kg]
        Of a screw with its nut.

    Returns
    -------
    BowlSolid
    """
    if solid.segments.joined is None:
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


def _weighed(plan, parts) -> tuple[Any, ...]:
    """Mass [kg], centre (3,) [m] and inertia (3, 3) [kg m2] about it of a bowl with its gates."""
    density = plan.material.density
    weights = [density * part.volume for part in parts]
    total = float(sum(weights))
    centre = sum(w * part.centre for w, part in zip(weights, parts)) / total
    inertia = sum(
        mass.shift_inertia(density * part.inertia, w, part.centre - centre) for w, part in zip(weights, parts)
    )
    return total, centre, inertia


def pieces(plan, kit=facets) -> tuple[Any, ...]:
    """Return the bowl as one body [mm] of a kit and its gates (name, body), the outlet at the angle 0."""
    wall, *ends = [_wall(plan, kit)] if plan.stairs is None else stairs.shell(plan, kit)
    notches = [_notch(plan, kit, gate) for gate in _gates(plan)]
    ring = kit.without(
        wall, [*_opening(plan, kit), *notches, *_bores(plan, kit), *track.groove_wall_cuts(plan, kit)]
    )
    slab = kit.without(track.slab(plan, kit), [_hole(plan, kit, cut) for cut in _holes(plan)])
    blades = [_plate(plan, kit, blade) for blade in _blades(plan) if not blade.alone]
    added = [*track.sides(plan, kit), *track.yokes(plan, kit), *blades, *track.ledges(plan, kit)]
    added += track.groove_faces(plan, kit)
    whole = kit.united([*_floor(plan, kit), ring, *ends, slab, *added])
    whole = kit.without(whole, [*track.slots(plan, kit), *_drilled(plan, kit)])
    gates = [(f"gate_{k + 1}", _plate(plan, kit, gate)) for k, gate in enumerate(_gates(plan))]
    return kit.one_piece(whole, "devices"), gates


def _floor(plan, kit) -> list[Any]:
    """Floor with its dome, and the hub below it."""
    low, inner, outer = plan.underside, plan.ring, plan.path.radius + plan.material.wall
    edge = []
    if plan.stairs is not None:
        outer = inner + PIECE_OVERLAP_M
        inside = kit.drum(
            inner - 0.7 * PIECE_OVERLAP_M, low - PIECE_OVERLAP_M, PIECE_OVERLAP_M, plan.segments
        )
        edge = [kit.without(kit.patch(stairs.floor_edge(plan, kit), low, 0.0), [inside])]
    top = [(outer, 0.0), (inner, 0.0), (0.0, plan.dome)]
    if plan.material.flat:
        return [kit.turned([(0.0, low), (outer, low), *top], plan.segments), *edge]
    shell = [(0.0, plan.dome + low), (inner, low), (outer, low), *top]
    rim, middle = float(plan.floor(plan.hub)) + 0.5 * low, plan.dome + 0.5 * low
    hub = [(0.0, low), (plan.hub, low), (plan.hub, rim), (0.0, middle)]
    return [kit.united([kit.turned(item, plan.segments) for item in (shell, hub)]), *edge]


def _wall(plan, kit):
    inner, outer = plan.path.radius, plan.path.radius + plan.material.wall
    return kit.turned(
        [
            (inner, plan.underside + PIECE_OVERLAP_M),
            (outer, plan.underside),
            (outer, plan.top),
            (inner, plan.top),
        ],
        plan.segments,
    )


def _opening(plan, kit) -> list[Any]:
    """Where the outlet passes through the wall."""
    end, far = plan.path.end, plan.path.end + 2.0 * plan.outlet
    ring = np.array([[end, 0.0], [far, 0.0], [far, plan.width], [end, plan.width]])
    low, lift = plan.outlet_height - 0.5 * plan.material.plate, plan.width * np.sin(plan.path.bank_at(end))
    return [kit.over(plan.path, ring, low, plan.top + lift + BEYOND_BOWL_M, plan.chord)]


def _drilled(plan, kit) -> list[Any]:
    """Holes of the bolts, in the middle and on their circle, and drain holes."""
    angles = FULL_TURN_RAD * (np.arange(plan.bolts) + 0.5) / plan.bolts
    circle = [(0.0, 0.0)] + [
        (0.5 * plan.bolt_circle * np.cos(a), 0.5 * plan.bolt_circle * np.sin(a)) for a in angles
    ]
    holes = [(item, plan.bolt) for item in circle]
    edge = plan.ring + BOLT_CLEARANCE_M - plan.drain
    angles = FULL_TURN_RAD * np.arange(plan.drains) / max(plan.drains, 1)
    holes += [((edge * np.cos(a), edge * np.sin(a)), plan.drain) for a in angles]
    return [
        kit.disc(at, size, plan.underside - PIECE_OVERLAP_M, plan.dome + PIECE_OVERLAP_M)
        for at, size in holes
    ]


def _bores(plan, kit):
    """Holes of the nozzles through the wall, level and square to it."""
    solid = []
    for item in () if plan.stretch is None else plan.stretch.bores:
        s = plan.first + item.place
        theta = float(plan.path.angle(s))
        towards = np.array([np.cos(theta), np.sin(theta), 0.0])
        near = plan.path.places(s, 0.0) + [0.0, 0.0, item.height] - PIECE_OVERLAP_M * towards
        solid.append(kit.bore(near, towards, item.size, plan.material.wall + 2.0 * PIECE_OVERLAP_M))
    return solid


def _holes(plan) -> tuple[Any, ...]:
    return () if plan.stretch is None else tuple(cut for cut in plan.stretch.cuts if not cut.hangs)


def _blades(plan):
    return () if plan.stretch is None else plan.stretch.blades


def _gates(plan) -> list[Any]:
    return [blade for blade in _blades(plan) if blade.alone]


def _hole(plan, kit, cut):
    """The body that a cut takes out of the track."""
    ring = cut.ring + [plan.first, 0.0]
    heights = plan.path.height(ring[:, 0], ring[:, 1])
    deep = plan.material.plate + track.fillet(plan) + PIECE_OVERLAP_M
    return kit.over(plan.path, ring, heights.min() - deep, heights.max() + PIECE_OVERLAP_M, 0.2 * plan.chord)


def _plate(plan, kit, blade):
    """A blade across the track, at its height over the higher of its two faces."""
    s = plan.first + blade.start
    area = blade.area
    if blade.alone:
        x0, _, _, x3 = area.bounds
        ear = shapely.box(-plan.material.wall - EARS, 0.0, x0 + PIECE_OVERLAP_M, x3)
        area = shapely.union_all([area, ear])
    return _standing(plan, kit, s, blade.thickness, area, blade.lean)


def _standing(plan, kit, s, thickness, area, lean=0.0):
    """An area of distances from the wall and heights over the track, as a plate across the track.

    A swept one leans ahead with the distance; its edge keeps its height over the track at both ends.
    """
    from_wall, theta = s + thickness, plan.path.angle(s)
    far = plan.path.places(from_wall + lean * plan.width, plan.width)
    across = (far - plan.path.places(from_wall, 0.0)) / plan.width
    ahead, upright = np.array([-np.sin(theta), np.cos(theta), 0.0]), np.array([0.0, 0.0, 1.0])
    foot = np.array([*plan.path.plan(s, 0.0), float(plan.path.height(from_wall))])
    return kit.plank(area, thickness, np.column_stack([across, upright, ahead]), foot)


def _notch(plan, kit, blade):
    """The notch of the wall in which a gate stands, open above."""
    z = -GATE_PLAY_M
    area = shapely.box(-plan.material.wall - PIECE_OVERLAP_M, z, PIECE_OVERLAP_M, BEYOND_BOWL_M)
    return _standing(
        plan, kit, plan.first + blade.start - GATE_PLAY_M, blade.thickness + 2.0 * GATE_PLAY_M, area
    )
