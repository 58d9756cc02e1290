"""Small changes of a part's shape, each made on its mesh: a wider flange, a flat, a chamfer, a moved hole.

A part is looked at along each axis of its file, the axes in which it was drawn. Along an axis it is cut into
**steps**: stretches within which its outline stays the same. A step that is wider than what is beside it is a
head or a collar; an inner ring of an outline that goes on from step to step is a hole; what an outline gains
when it is closed is a slot. A change adds to these or takes from them,
by no more than ``MOST_VOLUME`` of the part.
"""

import itertools
import math
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from enum import StrEnum
from typing import TYPE_CHECKING

import numpy as np
import shapely
import shapely.affinity

from feederscrew.base.arrays import Floats, Points, Triangles
from feederscrew.base.errors import MeshError
from feederscrew.base.heavy import heavy
from feederscrew.base.units import MM
from feederscrew.part.record import Part

if TYPE_CHECKING:
    from manifold3d import Manifold

manifold3d = heavy("manifold3d")

MOST_LEVELS = 60  # heights at which a part is cut along an axis, at most
ALIKE = 0.01  # [1] of the larger outline, by which outlines of one step differ at most
ROUND = 0.985  # [1] of 4 pi area / perimeter squared, from which an outline is a circle
WIDER_MM = 0.5  # of a head over its neck, to either side: a millimetre of the diameter
LEAST_MM = 0.3  # of any change: less is within the tolerances of moulding and turning
OVERLAP_MM = 1e-3  # by which what is added reaches into the part
MOST_VOLUME = 0.15  # [1] of the part, that a change adds or takes
LEAST_VOLUME = 2e-3  # [1] of the part, that a change adds or takes: less is no change
TURNED = 0.5  # [1] of a part's volume in round steps, from which it is a turned part along that axis
LEAST_END = 0.2  # [1] of the largest outline, that an end has on which a lug may stand
MOST_HOLE = 0.5  # [1] of a filled outline, above which its opening is the inside of a hollow part, not a hole
SAME_HOLE = 0.1  # [1] of a hole, by which its outline may change from step to step: it may have a draft
SAME_SHAPE = 1e-5  # [1] of volume and inertia, within which two changed parts are one


class ChangeKind(StrEnum):
    """What is changed on a part."""

    WIDER_FLANGE = "wider flange"
    THICKER_HEAD = "thicker head"
    FLAT = "flat"
    CHAMFER = "chamfer"
    LUG = "lug"
    MOVED_HOLE = "moved hole"
    CLOSED_SLOT = "closed slot"
    MADE_SYMMETRIC = "made symmetric"


# what a person reads of a change; `size` in mm, `axis` of the file
TEXTS = {
    ChangeKind.WIDER_FLANGE: "a flange wider by {size} mm to every side (it lies across {axis})",
    ChangeKind.THICKER_HEAD: "a head thicker by {size} mm (at its {end} end along {axis})",
    ChangeKind.FLAT: "a flat {size} mm deep on its round side (along {axis})",
    ChangeKind.CHAMFER: "a chamfer of {size} mm on one edge along {axis}",
    ChangeKind.LUG: "a lug {size} mm high on one side of its {end} end along {axis}",
    ChangeKind.MOVED_HOLE: "the hole along {axis} moved by {size} mm",
    ChangeKind.CLOSED_SLOT: "the slot along {axis} closed, {size} mm wide",
    ChangeKind.MADE_SYMMETRIC: "made the same from both ends along {axis}, the fuller end at both",
}


@dataclass(frozen=True, eq=False)
class Change:
    """One change of a part, and the surface of the part that has it."""

    kind: ChangeKind
    size: float  # [m] see TEXTS; of a part made symmetric the edge of a cube of what is added
    axis: int  # of the file: 0, 1 or 2
    high_end: bool  # whether it is made at the upper end along the axis, where it has an end
    share: float  # [1] of the part's volume, that it adds and takes
    vertices: Points  # (V, 3) [m] in the file's axes
    faces: Triangles  # (F, 3) corners counter-clockwise seen from outside

    @property
    def text(self) -> str:
        """Say what is changed, by how much and where: 'a flat 0.6 mm deep on its round side (along z)'."""
        end = "upper" if self.high_end else "lower"
        return TEXTS[self.kind].format(size=f"{self.size / MM:.3g}", axis="xyz"[self.axis], end=end)


@dataclass(frozen=True, eq=False)
class OutlineStep:
    """A stretch of a part along an axis, within which its outline stays the same."""

    low: float  # [mm] along the axis
    high: float  # [mm]
    outline: shapely.Geometry  # [mm] across the axis

    @property
    def filled(self) -> shapely.Geometry:
        """The outline without its holes [mm]."""
        return shapely.union_all([shapely.Polygon(part.exterior) for part in polygons(self.outline)])

    @property
    def radius(self) -> float:
        """Radius of a circle of the area of the outline without its holes [mm]."""
        return math.sqrt(self.filled.area / math.pi)

    @property
    def is_round(self) -> bool:
        """Whether the outline, without its holes, is a circle."""
        return is_circle(self.filled)


@dataclass(frozen=True, eq=False)
class AxisView:
    """A part as seen along one axis of its file, which is the third here."""

    axis: int
    body: "Manifold"  # [mm] with that axis as z
    steps: tuple[OutlineStep, ...]  # from the lower end on

    @property
    def low(self) -> float:
        """Where the part begins along the axis [mm]."""
        return self.steps[0].low

    @property
    def high(self) -> float:
        """Where the part ends along the axis [mm]."""
        return self.steps[-1].high

    @property
    def long(self) -> float:
        """Length of the part along the axis [mm]."""
        return self.high - self.low

    @property
    def is_turned(self) -> bool:
        """Whether most of the part is round about this axis."""
        sizes = [(step.filled.area * (step.high - step.low), step.is_round) for step in self.steps]
        return sum(size for size, is_round in sizes if is_round) >= TURNED * sum(size for size, _ in sizes)


@dataclass(frozen=True, eq=False)
class _Made:
    """A change as it was made along an axis, before it is judged."""

    kind: ChangeKind
    size: float  # [mm]
    high_end: bool
    body: "Manifold"  # [mm]


def polygons(area: shapely.Geometry) -> list[shapely.Polygon]:
    """Return the polygons of an area, without lines and points.

    Parameters
    ----------
    area : shapely.Geometry

    Returns
    -------
    list of shapely.Polygon
    """
    return [part for part in shapely.get_parts(area) if part.geom_type == "Polygon" and part.area > 0.0]


def is_circle(area: shapely.Geometry) -> bool:
    """Tell whether an area is a circle: no other has so large an area for its perimeter.

    Parameters
    ----------
    area : shapely.Geometry

    Returns
    -------
    bool
    """
    return area.length > 0.0 and 4.0 * math.pi * area.area / area.length**2 > ROUND


def _sides(area: shapely.Geometry) -> tuple[float, float]:
    """The shorter and the longer side [mm] of the smallest rectangle, at any angle, about an area."""
    corners = shapely.get_coordinates(shapely.oriented_envelope(area))
    first, second = np.hypot(*np.diff(corners, axis=0)[:2].T).tolist()
    return min(first, second), max(first, second)


def list_changes(part: Part) -> tuple[Change, ...]:
    """Return the small changes that the shape of a part allows.

    Changes that give the same solid, as chamfers of two alike edges, are listed once: volume and the
    invariants of its second moments tell. A change that adds or takes more than ``MOST_VOLUME`` of the part,
    or leaves it in several pieces, is none.

    Parameters
    ----------
    part : Part
        From a mesh.

    Returns
    -------
    tuple of Change
        In the order of ``ChangeKind``, the least change of the volume first within a kind.

    Raises
    ------
    MeshError
        If the part is a part card or an open surface, which has no body to change.
    """
    if part.vertices is None or part.faces is None:
        raise MeshError(part.source, "is a part card, it has no shape to change", "give a mesh")
    if part.open_surface:
        raise MeshError(part.source, "is an open surface, it has no body to change", "give a closed mesh")
    whole = _body(part.vertices / MM, part.faces)
    before = float(whole.volume())
    found: list[Change] = []
    known: list[tuple[ChangeKind, Floats]] = []
    views = [view for view in (_view(part, axis) for axis in range(3)) if view is not None]
    turned = [view for view in views if view.is_turned]
    for view in views:
        makers = MAKERS if not turned or view in turned else (_make_symmetric,)
        for made in itertools.chain.from_iterable(make(view) for make in makers):
            added, taken = made.body - view.body, view.body - made.body
            share = (float(added.volume()) + float(taken.volume())) / before
            if not LEAST_VOLUME <= share <= MOST_VOLUME or len(made.body.decompose()) != 1:
                continue
            vertices, faces = _surface(made.body, view.axis)
            print_of_shape = _moments(vertices, faces)
            if any(kind is made.kind and _alike(print_of_shape, other) for kind, other in known):
                continue
            known.append((made.kind, print_of_shape))
            found.append(
                Change(made.kind, made.size * MM, view.axis, made.high_end, share, vertices * MM, faces)
            )
    order = list(ChangeKind)
    return tuple(sorted(found, key=lambda change: (order.index(change.kind), change.share)))


def _body(points: Points, faces: Triangles) -> "Manifold":
    """The body of a closed surface [mm]."""
    return manifold3d.Manifold(
        manifold3d.Mesh64(np.ascontiguousarray(points), np.ascontiguousarray(faces, dtype=np.uint64))
    )


def _surface(body: "Manifold", axis: int) -> tuple[Points, Triangles]:
    """The surface [mm] of a body that has an axis of the file as z, in the file's axes."""
    mesh = body.to_mesh64()
    points = np.asarray(mesh.vert_properties)[:, :3]
    return np.roll(points, axis - 2, axis=1), np.asarray(mesh.tri_verts).astype(int)


def _view(part: Part, axis: int) -> AxisView | None:
    """A part along an axis; None where its surface is no body there."""
    points = np.roll(part.mesh.vertices / MM, 2 - axis, axis=1)  # a turn of the axes, not a mirror
    body = _body(points, part.mesh.faces)
    if body.status() != manifold3d.Error.NoError or body.is_empty():
        return None
    levels = np.unique(np.round(points[:, 2], 6))
    levels = levels[np.concatenate([[True], np.diff(levels) > OVERLAP_MM])]
    if len(levels) > MOST_LEVELS:
        levels = levels[np.unique(np.linspace(0, len(levels) - 1, MOST_LEVELS).round().astype(int))]
    steps: list[OutlineStep] = []
    for low, high in itertools.pairwise(levels.tolist()):
        outline = _slice(body, 0.5 * (low + high))
        if not outline.area > 0.0:
            continue
        last = steps[-1] if steps else None
        if last is not None and outline.symmetric_difference(last.outline).area <= ALIKE * max(
            outline.area, last.outline.area
        ):
            steps[-1] = OutlineStep(last.low, high, last.outline)
        else:
            steps.append(OutlineStep(low, high, outline))
    return AxisView(axis, body, tuple(steps)) if steps else None


def _slice(body: "Manifold", height: float) -> shapely.Geometry:
    """The section of a body at a height, with its holes [mm]."""
    rings = [np.asarray(ring) for ring in body.slice(height).to_polygons()]
    areas = [shapely.make_valid(shapely.Polygon(ring)) for ring in rings if len(ring) > 2]
    section: shapely.Geometry = shapely.Polygon()
    for area in sorted(areas, key=lambda one: -one.area):  # a ring within one is its hole
        section = section.symmetric_difference(area)
    return section


def _prism(area: shapely.Geometry, low: float, high: float) -> "Manifold":
    """A body over an area between two heights [mm]; empty over none."""
    rings = [ring for part in polygons(area) for ring in (part.exterior, *part.interiors)]
    if not rings or not high > low:
        return manifold3d.Manifold()
    corners = [np.asarray(ring.coords)[:-1] for ring in rings]
    flat = manifold3d.CrossSection(corners, manifold3d.FillRule.EvenOdd)
    return manifold3d.Manifold.extrude(flat, high - low).translate((0.0, 0.0, low))


def _moments(vertices: Points, faces: Triangles) -> Floats:
    """Volume and invariants of the second moments of a solid about its centre (4,): a print of its shape.

    Trace, sum of the principal minors and determinant do not change as the part turns. Each is taken to the
    power that makes it a second moment.
    """
    corners = vertices[faces] - vertices.mean(axis=0)
    six = (corners[:, 0] * np.cross(corners[:, 1], corners[:, 2])).sum(axis=1)
    sums = corners.sum(axis=1)
    volume = six.sum() / 6.0
    centre = (six[:, None] * sums).sum(axis=0) / (24.0 * volume)

    def moment(i: int, j: int) -> float:
        own = (corners[:, :, i] * corners[:, :, j]).sum(axis=1) + sums[:, i] * sums[:, j]
        return float((six * own).sum() / 120.0 - volume * centre[i] * centre[j])

    xx, yy, zz, xy, yz, zx = (moment(*pair) for pair in ((0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (2, 0)))
    minors = xx * yy + yy * zz + zz * xx - xy**2 - yz**2 - zx**2
    determinant = xx * yy * zz + 2.0 * xy * yz * zx - xx * yz**2 - yy * zx**2 - zz * xy**2
    return np.array([volume, xx + yy + zz, math.sqrt(max(minors, 0.0)), max(determinant, 0.0) ** (1.0 / 3.0)])


def _alike(one: Floats, other: Floats) -> bool:
    return bool(np.allclose(one, other, rtol=SAME_SHAPE, atol=0.0))


def _heads(view: AxisView) -> Iterator[tuple[list[OutlineStep], bool]]:
    """The steps of each head and collar, and whether it is the upper end of the part.

    Steps whose radii differ by no more than ``WIDER_MM`` are one section: the edge of a head is rounded.
    """
    sections: list[list[OutlineStep]] = []
    for step in view.steps:
        own = max((one.radius for one in sections[-1]), default=0.0) if sections else 0.0
        if sections and abs(step.radius - own) <= WIDER_MM:
            sections[-1].append(step)
        else:
            sections.append([step])
    widths = [max(step.radius for step in section) for section in sections]
    for k, section in enumerate(sections):
        beside = [widths[n] for n in (k - 1, k + 1) if 0 <= n < len(sections)]
        if beside and all(widths[k] - width > WIDER_MM for width in beside):
            yield section, k == len(sections) - 1


def _widen_flange(view: AxisView) -> Iterator[_Made]:
    """A head or a collar, half a millimetre wider to every side."""
    for section, at_high_end in _heads(view):
        step = max(section, key=lambda one: one.high - one.low)  # not its rounded edges
        ring = step.filled.buffer(WIDER_MM).difference(step.filled.buffer(-OVERLAP_MM))
        body = view.body + _prism(ring, step.low, step.high)
        yield _Made(ChangeKind.WIDER_FLANGE, WIDER_MM, at_high_end, body)


def _thicken_head(view: AxisView) -> Iterator[_Made]:
    """A head at an end, a fifth thicker, towards the neck: it keeps its rounded end.

    What is added lies round the neck: a bore through the neck stays open.
    """
    for section, at_high_end in _heads(view):
        if section[0] is not view.steps[0] and section[-1] is not view.steps[-1]:
            continue
        size = max(LEAST_MM, 0.2 * (section[-1].high - section[0].low))
        if at_high_end:
            inner, low, high = section[0], section[0].low - size, section[0].low + OVERLAP_MM
        else:
            inner, low, high = section[-1], section[-1].high - OVERLAP_MM, section[-1].high + size
        body = view.body
        for step in view.steps:  # a neck may taper
            begin, end = max(low, step.low), min(high, step.high)
            neck = shapely.Polygon() if step in section else step.filled.buffer(-OVERLAP_MM)
            body = body + _prism(inner.outline.difference(neck), begin, end)
        if view.low < low and high < view.high:
            yield _Made(ChangeKind.THICKER_HEAD, size, at_high_end, body)


def _cut_flat(view: AxisView) -> Iterator[_Made]:
    """A flat on the longest round step that has the material for it, a tenth of its diameter deep."""
    round_steps = [step for step in view.steps if step.is_round]
    for step in sorted(round_steps, key=lambda one: one.low - one.high):
        size = max(LEAST_MM, 0.2 * step.radius)
        _, y_low, x_high, y_high = step.filled.bounds
        wall = step.filled.intersection(shapely.box(x_high - size - LEAST_MM, y_low, x_high, y_high))
        if wall.difference(step.outline).area > ALIKE * wall.area:  # the wall of a tube is too thin
            continue
        beyond = shapely.box(x_high - size, y_low - 1.0, x_high + 1.0, y_high + 1.0)
        yield _Made(ChangeKind.FLAT, size, False, view.body - _prism(beyond, step.low, step.high))
        return


def _cut_chamfer(view: AxisView) -> Iterator[_Made]:
    """A chamfer along the axis, on the edge of the part's box of which it takes most."""
    if all(step.is_round for step in view.steps):
        return
    x_low, y_low, x_high, y_high = shapely.union_all([step.filled for step in view.steps]).bounds
    size = max(LEAST_MM, 0.2 * min(x_high - x_low, y_high - y_low))
    cuts = []
    for x, right in ((x_low, -1.0), (x_high, 1.0)):
        for y, up in ((y_low, -1.0), (y_high, 1.0)):
            corner = [(x + right, y + up), (x - right * size, y + up), (x - right * size, y)]
            corner += [(x, y - up * size), (x + right, y - up * size)]
            kept = [(x - right * size, y), (x, y - up * size), (x - right * size, y - up * size)]
            wedge = shapely.Polygon(corner).convex_hull.difference(shapely.Polygon(kept))
            cuts.append(view.body - _prism(wedge, view.low - 1.0, view.high + 1.0))
    yield _Made(ChangeKind.CHAMFER, size, False, min(cuts, key=lambda body: body.volume()))


def _add_lug(view: AxisView) -> Iterator[_Made]:
    """A lug at one side of an end, a tenth of the part high."""
    for k, at_high_end in ((0, False), (len(view.steps) - 1, True)):
        step = view.steps[k]
        if step.outline.area < LEAST_END * max(one.outline.area for one in view.steps):
            continue
        x_low, y_low, x_high, y_high = step.outline.bounds
        wide = 0.2 * min(x_high - x_low, y_high - y_low)
        size = max(LEAST_MM, 0.1 * view.long)
        rim = step.outline.intersection(shapely.box(x_high - wide, y_low, x_high, y_high))
        middle = max(polygons(rim), key=lambda one: one.area).centroid.y
        foot = rim.intersection(shapely.box(x_high - wide, middle - wide, x_high, middle + wide))
        span = (step.high - OVERLAP_MM, step.high + size)
        if not at_high_end:
            span = (step.low - size, step.low + OVERLAP_MM)
        yield _Made(ChangeKind.LUG, size, at_high_end, view.body + _prism(foot, *span))


def _holes(view: AxisView) -> Iterator[tuple[shapely.Polygon, list[OutlineStep]]]:
    """The holes along an axis that can be moved, and the steps through which each goes.

    A hole is empty, of one outline from step to step, and ends in the open or in a floor.
    The inside of a hollow part, a hole round a pin and one step of a hole with several widths are none.
    """
    seen: list[shapely.Polygon] = []
    for k, step in enumerate(view.steps):
        for hole in _empty_rings(step):
            if any(_is_same_hole(hole, other) for other in seen):
                continue
            last = k
            while last + 1 < len(view.steps) and any(
                _is_same_hole(hole, other) for other in _empty_rings(view.steps[last + 1])
            ):
                last += 1
            seen.append(hole)
            own = view.steps[k : last + 1]
            ends = [view.steps[n] if 0 <= n < len(view.steps) else None for n in (k - 1, last + 1)]
            is_open = [end is None or _share_within(hole, end.filled) < ALIKE for end in ends]
            is_floor = [end is not None and _share_within(hole, end.outline) > 1.0 - ALIKE for end in ends]
            if all(a or b for a, b in zip(is_open, is_floor)):
                yield hole, list(own)


def _empty_rings(step: OutlineStep) -> list[shapely.Polygon]:
    """The openings of an outline in which nothing stands, no larger than ``MOST_HOLE`` of it."""
    rings = [shapely.Polygon(ring) for part in polygons(step.outline) for ring in part.interiors]
    most = MOST_HOLE * step.filled.area
    return [ring for ring in rings if ring.area <= most and _share_within(ring, step.outline) < ALIKE]


def _share_within(hole: shapely.Polygon, area: shapely.Geometry) -> float:
    """The share of a hole [1] that lies in an area."""
    return float(hole.intersection(area).area) / float(hole.area)


def _is_same_hole(hole: shapely.Polygon, other: shapely.Polygon) -> bool:
    return bool(hole.symmetric_difference(other).area <= SAME_HOLE * hole.area)


def _move_hole(view: AxisView) -> Iterator[_Made]:
    """A hole, moved by a tenth of the outline's length along its longer side, away from its middle."""
    widest = max(view.steps, key=lambda step: step.filled.area)
    x_low, y_low, x_high, y_high = widest.filled.bounds
    along = np.array([1.0, 0.0] if x_high - x_low >= y_high - y_low else [0.0, 1.0])
    middle = widest.filled.centroid
    size = max(LEAST_MM, 0.1 * max(x_high - x_low, y_high - y_low))
    wall = max(LEAST_MM, 0.1 * min(x_high - x_low, y_high - y_low))
    for hole, own in _holes(view):
        centre = hole.centroid
        is_bore = is_circle(hole) and widest.is_round and centre.distance(middle) < ALIKE * widest.radius
        if is_bore:
            continue  # the bore of a round part is where it works
        offset = float(np.sum(along * [centre.x - middle.x, centre.y - middle.y]))
        for way in (1.0, -1.0) if offset >= 0.0 else (-1.0, 1.0):
            moved = shapely.affinity.translate(hole, *(way * size * along).tolist())
            if all(step.outline.union(hole).contains(moved.buffer(wall)) for step in own):
                low, high = own[0].low, own[-1].high
                body = view.body
                for step in own:
                    body = body + _prism(hole.buffer(OVERLAP_MM), step.low, step.high)
                yield _Made(ChangeKind.MOVED_HOLE, size, False, body - _prism(moved, low, high))
                break


def _close_slot(view: AxisView) -> Iterator[_Made]:
    """The slots of an outline that are narrower than a third of it, filled.

    Widths are those of the smallest rectangles about them: a part may be drawn at any angle.
    """
    reach = _sides(max(view.steps, key=lambda step: step.filled.area).filled)[0] / 6.0
    body, widest = view.body, 0.0
    for step in view.steps:
        filled = step.filled
        closed = filled.buffer(reach, join_style="mitre").buffer(-reach, join_style="mitre")
        for pocket in polygons(closed.difference(filled)):
            wide = _sides(pocket)[0]
            if wide < LEAST_MM:
                continue
            body = body + _prism(pocket.buffer(OVERLAP_MM).intersection(closed), step.low, step.high)
            widest = max(widest, wide)
    if widest > 0.0:
        yield _Made(ChangeKind.CLOSED_SLOT, widest, False, body)


def _make_symmetric(view: AxisView) -> Iterator[_Made]:
    """The part and its mirror image in the middle across the axis, united."""
    middle = view.low + view.high
    mirrored = view.body.mirror((0.0, 0.0, 1.0)).translate((0.0, 0.0, middle))
    body = view.body + mirrored
    added = float(body.volume()) - float(view.body.volume())
    yield _Made(ChangeKind.MADE_SYMMETRIC, max(added, 0.0) ** (1.0 / 3.0), True, body)


MAKERS: tuple[Callable[[AxisView], Iterable[_Made]], ...] = (
    _widen_flange,
    _thicken_head,
    _cut_flat,
    _cut_chamfer,
    _add_lug,
    _move_hole,
    _close_slot,
    _make_symmetric,
)
