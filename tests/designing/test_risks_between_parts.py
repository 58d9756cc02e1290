"""What may go wrong between parts, against angles that are drawn."""

from dataclasses import replace

import numpy as np
import pytest
import shapely
import shapes
import trimesh
from design_counts import queue

from feederscrew import bowl as bowls
from feederscrew.base.geometry import vectors
from feederscrew.base.geometry.lattice import cells, chords, handles
from feederscrew.bowl.record import Track
from feederscrew.designing import hazards
from feederscrew.output import designs
from feederscrew.resting.aspects import find
from feederscrew.sorting.orientations import orientations
from feederscrew.trials import tangling

LEVEL = Track(climb=0.0, bank=0.0, radius=100.0, width=0.2)
RUBBED = 0.6, 0.5
ASKEW = trimesh.transformations.rotation_matrix(0.9, (1.0, -2.0, 0.7), (5.0, 1.0, -3.0))


def lying(part, kind="flat"):
    every = orientations(part, find(part), LEVEL)
    return sorted((one for one in every if one.kind == kind), key=lambda one: one.height)


@pytest.fixture(scope="module")
def keel():
    """A bar whose ends rise from a narrower foot by 20 and by 60 degrees, lying on that foot."""
    a, b = 5.0 / np.tan(np.radians(20.0)), 5.0 / np.tan(np.radians(60.0))
    part = shapes.part(shapes.prism([(-10, 0), (10, 0), (10 + a, 5), (-10 - b, 5)], 12))
    low = [one for one in lying(part) if one.height < 5.1e-3]
    return [one for one in low if np.ptp(one.foot.corners[:, 0]) == pytest.approx(20e-3, rel=1e-3)][:2]


def found(one, friction, queues=(), width=1.0):
    """Risks of an orientation on a track of a width [m], at one friction [1] everywhere."""
    plain = bowls.default()
    rubbed = replace(plain.friction, static=friction, kinetic=friction, wall=friction)
    bowl = replace(plain, friction=rubbed, track=replace(plain.track, width=width))
    return list(hazards.risks(one, bowl, queues))


def lathe(*outline):
    return shapes.part(trimesh.creation.revolve(np.array(outline), sections=64))


def disc(thick):
    return lathe((0.0, 0.0), (6.0, 0.0), (6.0, thick), (0.0, thick))


def test_a_foot_under_sides_that_rise_wedges_by_the_flatter_one_and_climbs_are_said(keel):
    """The one that shingles is drawn touching the next and higher, lapping by what the flatter side gives."""
    for one in keel:
        assert np.degrees(hazards.wedge(one)[0]) == pytest.approx(20.0, abs=1e-6)
        (said,) = found(one, 0.6)
        assert said.text.startswith(f"{one.name} may shingle: where one lies 0.25 mm higher than the next it")
        assert "pushed up a side of 20 deg, and friction holds it up to 31 deg" in said.text
        assert found(one, np.tan(np.radians(19.0))) == []
        along, aside, up = said.pair.axes @ said.pair.place
        assert (aside, abs(up)) == pytest.approx((0.0, hazards.LIFT), abs=1e-9)
        lap = hazards.LIFT / np.tan(np.radians(20.0))
        assert along == pytest.approx(np.ptp(one.outline[:, 0]) - lap, abs=1e-6)
    seen = queue(20, counted=29.0, seconds=30.0, climbs=3)
    (said,) = found(keel[0], 0.3, (seen, replace(seen, climbs=0)))
    assert said.text == "parts climbed on others 3 times in 60 s of queue" and said.pair is None


def rim(chamfer):
    """A washer whose edges are broken by 30 deg."""
    s = chamfer * np.tan(np.radians(30.0))
    ring = [(3.2, 0.0), (6.0 - chamfer, 0.0), (6.0, s), (6.0, 1.6 - s), (6.0 - chamfer, 1.6), (3.2, 1.6)]
    return lathe(*ring, ring[0])


def taper(low, high):
    rise = 3.0 * np.tan(np.radians(25.0))
    return lathe((0.0, 0.0), (low, 0.0), (high, rise), (0.0, rise))


@pytest.mark.parametrize(("part", "degrees", "near"), [
    (disc(0.2), 0.0, 0.0),
    (disc(0.5), 90.0, 1e-6),
    (rim(0.6), 90.0, 1e-6),  # once the flattest side over the track counted, however short: 30 deg here
    # on the large face its rim climbs the next one's side: once its front, that leans back, was no risk
    (taper(6.0, 3.0), 25.0, 0.2),
    (taper(3.0, 6.0), 25.0, 0.2),
])  # fmt: skip
def test_a_part_wedges_by_the_side_that_meets_the_next(part, degrees, near):
    for one in lying(part)[: None if degrees == 25.0 else 1]:
        assert np.degrees(hazards.wedge(one)[0]) == pytest.approx(degrees, abs=near)
    if degrees == 0.0:
        (said,) = found(lying(part)[0], 0.1)
        assert said.text.endswith("higher than the next it slides onto it")


@pytest.mark.parametrize("sections", [24, 90])
def test_round_sides_meet_half_way_up_whatever_their_facets(sections):
    """Once the lowest facet counted: 11 deg of 32, 5 of 72."""
    pin = shapes.part(shapes.cylinder(3.0, 20.0, sections))
    shortest = min(lying(pin, "rolling"), key=lambda one: one.length)
    exact = 90.0 - np.degrees(np.arcsin(hazards.LIFT / 6e-3))
    assert np.degrees(hazards.wedge(shortest)[0]) == pytest.approx(exact, abs=180.0 / sections)


@pytest.mark.parametrize("heading", [0.0, 0.4])
def test_a_strut_between_walls_is_held_up_to_the_angle_of_friction(heading):
    """A plate of 30 x 12 mm, whichever way it lies: its diagonal is the strut. A disc is none."""
    one = lying(shapes.part(shapes.box(30, 12, 3)))[0]
    one = replace(one, heading=one.heading + heading)
    longest = np.hypot(30e-3, 12e-3)
    low, high = hazards.walls_between(one, 0.5)
    breadth = np.ptp(one.outline[:, 1])
    assert high == pytest.approx(longest, rel=1e-9)
    assert low == pytest.approx(max(longest / np.sqrt(1.0 + 0.5**2), breadth), rel=1e-9)
    width = 0.5 * (low + high)
    turn = hazards.strut(one, width)
    x, y = one.outline.T
    assert np.ptp(np.sin(turn) * x + np.cos(turn) * y) == pytest.approx(width, rel=5e-3)
    (said,) = found(one, 0.5, width=width)
    assert said.kind == "wedges" and said.pair.walls == pytest.approx(width)
    assert found(one, 0.5, width=1.01 * high) == found(one, 0.5, width=0.99 * low) == []
    assert hazards.walls_between(lying(disc(3.0))[0], 0.6) is None


@pytest.mark.parametrize("kind", ["shingles", "wedges"])
def test_each_pair_is_drawn_without_one_in_the_other(keel, kind):
    (one, _) = keel
    width = np.mean(hazards.walls_between(one, 0.6))
    said = next(some for some in found(one, 0.6, width=width) if some.kind == kind)
    first, second = designs.bodies(one.posture.solid, said.pair)
    bodies = [trimesh.Trimesh(*some) for some in (first, second)]
    assert not bodies[1].contains(first[0]).any() and not bodies[0].contains(second[0]).any()
    assert any(axes.images for axes in designs.risk_picture(one.posture.solid, said).axes)


def split_ring(slit, *, radius=6.0, wide=1.2, count=24):
    """A ring of a square wire [mm] with a slit of so many degrees, lying askew in its file."""
    turns = np.radians(np.linspace(0.5 * slit, 360.0 - 0.5 * slit, count))
    ring = np.column_stack([np.cos(turns), np.sin(turns)])
    return extruded(np.vstack([(radius + 0.5 * wide) * ring, (radius - 0.5 * wide) * ring[::-1]]), wide)


def extruded(outline, height):
    mesh = trimesh.creation.extrude_polygon(shapely.Polygon(outline), height)
    return shapes.part(mesh.apply_transform(ASKEW))


def cup(low, high, *, wall=0.8, sections=40):
    """A cup 14 mm high whose outside widens from one radius [mm] to another."""
    outline = [(0, 0), (low, 0), (high, 14), (high - wall, 14), (low - wall, 0.8), (0, 0.8)]
    mesh = trimesh.creation.revolve(np.array(outline, float), sections=sections)
    return shapes.part(mesh.apply_transform(ASKEW))


def test_split_rings_hook_through_their_slit_and_only_where_the_wire_goes_through():
    """The pair does not overlap, and each goes through the other."""
    part = split_ring(30.0)
    pair = tangling.tangle(part, RUBBED)
    slit = 2.0 * (6.0 - 0.6) * np.sin(np.radians(15.0))
    assert (1e3 * pair.opening, 1e3 * pair.section) == pytest.approx((slit, 1.2), abs=0.25)
    assert pair.share > 0.8
    assert tangling.tangle(split_ring(8.0), RUBBED) is None  # 0.75 mm wide, for 1.2 mm of wire
    centre = part.vertices - part.centre_of_mass
    corners = vectors.product(centre, pair.turn.T) + pair.place
    first, second = (trimesh.Trimesh(some, part.faces) for some in (centre, corners))
    assert not first.contains(corners).any() and not second.contains(centre).any()
    assert first.convex_hull.contains(corners).any() and second.convex_hull.contains(centre).any()


def test_what_never_comes_together_or_comes_apart_by_itself_is_no_risk():
    block, pin = shapes.part(shapes.box(30, 20, 15)), shapes.part(shapes.cylinder(3.0, 20.0, 32))
    for part in (block, pin, extruded([(0, 0), (30, 0), (30, 3), (3, 3), (3, 20), (0, 20)], 15.0)):
        assert tangling.tangle(part, RUBBED) is hazards.stack(part, 0.6) is None


@pytest.mark.parametrize("sections", [24, 60])
def test_cups_nest_where_their_sides_are_steeper_than_friction_holds(sections):
    """The inside of one meets the next one's foot, of 6 mm, where it is as wide: 4.32 mm up."""
    part = cup(6.0, 9.0, sections=sections)
    found = hazards.stack(part, 0.6)
    apart = 0.8 + 0.8 * 13.2 / 3.0
    assert 1e3 * found.height == pytest.approx(14.0, rel=1e-6)
    assert 1e3 * (found.height - found.depth) == pytest.approx(apart, rel=0.05)
    assert np.degrees(found.side) == pytest.approx(np.degrees(np.arctan(3.0 / 13.2)), abs=0.3)
    assert hazards.stack(part, np.tan(np.radians(11.0))) is None
    assert hazards.stack(cup(3.0, 17.0), 0.6) is None  # 45 deg: it lets go


def test_handles_and_chords_of_plain_bodies():
    """Cells count holes through a body; the longest chord of a ball is its diameter, of a tube its length."""
    tube = trimesh.creation.annulus(3.0, 6.0, 20.0, sections=40)
    ball = trimesh.creation.icosphere(3, 5.0)
    two = trimesh.util.concatenate([tube, tube.copy().apply_translation((30.0, 0.0, 0.0))])
    for mesh, count in ((ball, 0), (tube, 1), (shapes.box(10, 20, 30), 0), (two, 1)):
        grid = cells(np.array(mesh.vertices), mesh.faces, 40)
        assert handles(grid.solid) == count  # two bodies: two handles less one body more
    assert grid.solid.sum() * grid.size**3 == pytest.approx(two.volume, rel=0.05)
    for mesh, length in ((tube, 20.0), (ball, 10.0)):
        found, low, high = chords(np.array(mesh.vertices), mesh.faces, 50)
        assert found.max() == pytest.approx(length, rel=0.01)
        assert (mesh.face_normals[low][:, 2] <= 0.0).all() and (mesh.face_normals[high][:, 2] >= 0.0).all()
