"""Parts that hook, catch or nest, and those that do not, against shapes whose answer is plain."""

import numpy as np
import pytest
import shapely
import shapes
import trimesh

from feederscrew.designing import hazards
from feederscrew.geometry import vectors
from feederscrew.geometry.lattice import cells, chords, handles

RUBBED = 0.6, 0.5
ASKEW = trimesh.transformations.rotation_matrix(0.9, (1.0, -2.0, 0.7), (5.0, 1.0, -3.0))


def split_ring(slit, *, radius=6.0, wide=1.2, count=24):
    """A ring of a square wire [mm] with a slit of so many degrees, lying askew in its file."""
    turns = np.radians(np.linspace(0.5 * slit, 360.0 - 0.5 * slit, count))
    ring = np.column_stack([np.cos(turns), np.sin(turns)])
    outline = np.vstack([(radius + 0.5 * wide) * ring, (radius - 0.5 * wide) * ring[::-1]])
    return extruded(outline, wide)


def extruded(outline, height):
    mesh = trimesh.creation.extrude_polygon(shapely.Polygon(outline), height)
    return shapes.part(mesh.apply_transform(ASKEW))


def cup(low, high, *, wall=0.8, sections=40):
    """A cup 14 mm high whose outside widens from one radius [mm] to another."""
    outline = [(0, 0), (low, 0), (high, 14), (high - wall, 14), (low - wall, 0.8), (0, 0.8)]
    mesh = trimesh.creation.revolve(np.array(outline, float), sections=sections)
    return shapes.part(mesh.apply_transform(ASKEW))


def angle():
    return extruded([(0, 0), (30, 0), (30, 3), (3, 3), (3, 20), (0, 20)], 15.0)


@pytest.fixture(scope="module")
def hooked():
    """A ring with a slit of 30 degrees, and how two of them hook."""
    part = split_ring(30.0)
    return part, hazards.tangle(part, RUBBED)


def test_split_rings_hook_through_their_slit_and_only_where_the_wire_goes_through(hooked):
    _, found = hooked
    slit = 2.0 * (6.0 - 0.6) * np.sin(np.radians(15.0))
    assert 1e3 * found.opening == pytest.approx(slit, abs=0.25)
    assert 1e3 * found.section == pytest.approx(1.2, abs=0.25)
    assert found.share > 0.8
    assert hazards.tangle(split_ring(8.0), RUBBED) is None  # 0.75 mm wide, for 1.2 mm of wire


def test_the_pair_that_hooks_does_not_overlap_and_each_goes_through_the_other(hooked):
    part, found = hooked
    centre = part.vertices - part.centre_of_mass
    corners = vectors.product(centre, found.turn.T) + found.place
    first, second = (trimesh.Trimesh(some, part.faces) for some in (centre, corners))
    assert not first.contains(corners).any() and not second.contains(centre).any()
    assert (first.convex_hull.contains(corners)).any() and (second.convex_hull.contains(centre)).any()


@pytest.mark.parametrize(
    "part",
    [
        shapes.part(shapes.box(30, 20, 15)),
        shapes.part(shapes.cylinder(3.0, 20.0, 32)),
        shapes.part(trimesh.creation.annulus(3.2, 6.0, 1.6, sections=20)),
        angle(),
        cup(7.0, 7.0),
    ],
    ids=["block", "pin", "washer", "angle", "straight cup"],
)
def test_what_never_comes_together_or_comes_apart_by_itself_is_no_risk(part):
    assert hazards.tangle(part, RUBBED) is None
    assert hazards.stack(part, 0.6) is None


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


def test_what_is_inside_is_as_far_from_outside_as_a_ball_is_thick():
    ball = trimesh.creation.icosphere(4, 5.0)
    grid = cells(np.array(ball.vertices), ball.faces, 40)
    deepest = grid.origin + grid.size * np.array(np.unravel_index(grid.inside.argmax(), grid.inside.shape))
    assert grid.inside.max() == pytest.approx(5.0, abs=1.5 * grid.size)
    assert np.abs(deepest).max() < 1.5 * grid.size
    assert grid.hull.sum() == pytest.approx(grid.solid.sum(), rel=0.03)
