"""Mass properties, moments, symmetries and hull against closed forms, invariances and CAD."""

import csv
from pathlib import Path

import numpy as np
import part_files as files
import pytest
import shapes
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st
from readings import loaded, refused
from scipy.spatial.transform import Rotation

from feederscrew.base.errors import MeshError
from feederscrew.part import load, mass
from feederscrew.part.hull import convex_hull
from feederscrew.part.mass import mass_balance

PARTS = Path(__file__).parents[2] / "parts"
CAD = {  # volume of the mesh and of the exact B-rep [mm3], as their maker printed them: parts/README.md
    row["name"]: row
    for row in csv.DictReader(
        line for line in (PARTS / "volumes.csv").read_text().splitlines() if not line.startswith("#")
    )
}
SIDE = st.floats(0.1, 100.0)
BOX = files.binary_stl(files.box((10, 20, 30)))
INCH = 0.0254
OUTSIDE = "the centre of mass is not inside the part's convex hull - check `centre_of_mass` and its units"
TRIPLE = "is not three numbers - write x,y,z with points and commas, as in 1.5,0,-2"
NUMBER = "is not a number - write digits with a decimal point, as in 0.4"


@given(a=SIDE, b=SIDE, c=SIDE, corner=st.tuples(*[st.floats(-1e4, 1e4)] * 3))
@settings(max_examples=60, deadline=None)
def test_box(a, b, c, corner):
    solid = mass.integrate_solid(files.box((a, b, c), corner))
    noise = 1e-11 * (1.0 + max(map(abs, corner)) / min(a, b, c))  # of the corners themselves
    assert solid.volume == pytest.approx(a * b * c, rel=noise)
    np.testing.assert_allclose(solid.centre, np.add(corner, np.divide((a, b, c), 2)), rtol=1e-12, atol=1e-9)
    want = a * b * c / 12.0 * np.diag([b * b + c * c, a * a + c * c, a * a + b * b])
    np.testing.assert_allclose(solid.inertia, want, rtol=0, atol=noise * want.max())


def test_tetrahedron():
    a, b, c = 3.0, 5.0, 7.0
    corners = np.array([[0, 0, 0], [a, 0, 0], [0, b, 0], [0, 0, c]])
    solid = mass.integrate_solid(corners[[[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]])
    volume = a * b * c / 6.0
    assert solid.volume == pytest.approx(volume, rel=1e-14)
    np.testing.assert_allclose(solid.centre, [a / 4, b / 4, c / 4], rtol=1e-14)
    diagonal = 3.0 / 80.0 * np.array([b * b + c * c, a * a + c * c, a * a + b * b])
    product = np.array([[0, a * b, a * c], [a * b, 0, b * c], [a * c, b * c, 0]]) / 80.0
    np.testing.assert_allclose(solid.inertia, volume * (np.diag(diagonal) + product), rtol=1e-13)


@pytest.mark.parametrize("sections", [16, 64, 256])
def test_cylinder_converges_with_the_square_of_the_sections(sections):
    radius, height = 3.0, 8.0
    mesh = shapes.cylinder(radius, height, sections)
    solid = mass.integrate_solid(mesh.vertices[mesh.faces])
    volume = np.pi * radius**2 * height
    across = volume * (3.0 * radius**2 + height**2) / 12.0
    short = 1.0 / sections**2
    assert 6.0 * short < 1.0 - solid.volume / volume < 6.7 * short  # 2 pi^2 / 3 = 6.58
    want = [across, across, volume * radius**2 / 2.0]
    np.testing.assert_allclose(np.diag(solid.inertia), want, rtol=14.0 * short)


@given(
    turn=st.tuples(*[st.floats(-1.0, 1.0)] * 3),
    shift=st.tuples(*[st.floats(-100.0, 100.0)] * 3),
    scale=st.floats(1e-3, 1e3),
    seed=st.integers(0, 2**32 - 1),
)
@settings(max_examples=60, deadline=None)
def test_turning_moving_scaling_shuffling(turn, shift, scale, seed):
    rng = np.random.default_rng(seed)
    mesh = shapes.prism(shapes.l_profile(), 15.0)
    triangles = mesh.vertices[mesh.faces]
    solid = mass.integrate_solid(triangles)
    rotation = Rotation.from_rotvec(turn).as_matrix()
    order = rng.permutation(len(triangles))
    moved = np.roll(triangles[order] @ rotation.T * scale + shift, rng.integers(3), axis=1)
    again = mass.integrate_solid(moved)
    assert again.volume == pytest.approx(solid.volume * scale**3, rel=1e-7)
    np.testing.assert_allclose(again.centre, rotation @ solid.centre * scale + shift, rtol=1e-7, atol=1e-7)
    want = scale**5 * rotation @ solid.inertia @ rotation.T
    np.testing.assert_allclose(again.inertia, want, rtol=0, atol=1e-6 * np.abs(want).max())


def test_inertia_about_other_points_and_a_given_centre():
    """About a corner at the origin: m (b2 + c2) / 3 on the diagonal, -m a b / 4 beside it."""
    inertia = mass.shift_inertia(np.zeros((3, 3)), 2.0, [1.0, 2.0, 3.0])
    np.testing.assert_allclose(inertia, 2.0 * np.array([[13, -2, -3], [-2, 10, -6], [-3, -6, 5]]))
    a, b, c = 10.0, 20.0, 30.0
    part = loaded(BOX, density="1 g/cm3")
    want = np.diag([b * b + c * c, a * a + c * c, a * a + b * b]) / 3.0
    want -= np.array([[0, a * b, a * c], [a * b, 0, b * c], [a * c, b * c, 0]]) / 4.0
    np.testing.assert_allclose(mass_balance(part).inertia_at_origin, part.mass * want * 1e-6, rtol=1e-6)
    plain, heavy = loaded(BOX), loaded(BOX, centre_of_mass="5,10,3")
    np.testing.assert_array_equal(heavy.inertia, plain.inertia)
    assert heavy.mass == plain.mass
    assert heavy.warnings == (
        "the centre of mass is as given and how the mass is spread is not known: "
        "the inertia is that of the homogeneous solid about its own centroid",
    )


def test_principal_axes_are_right_handed_and_diagonal(rng):
    for _ in range(50):
        root = rng.normal(size=(3, 3))
        inertia = np.trace(root @ root.T) * np.eye(3) - root @ root.T
        moments, axes = mass.principal_inertia(inertia)
        assert (np.diff(moments) >= 0.0).all()
        np.testing.assert_allclose(axes @ inertia @ axes.T, np.diag(moments), rtol=0, atol=1e-12 * moments[2])
        assert np.linalg.det(axes) == pytest.approx(1.0)
        assert all(axis[np.argmax(np.abs(axis))] > 0.0 for axis in axes[:2])


@pytest.mark.parametrize("noise", [0.0, 1e-12])
@pytest.mark.parametrize(
    ("moments", "axes"),
    [
        ([2, 2, 3], [[1, 0, 0], [0, 1, 0], [0, 0, 1]]), ([3, 3, 2], [[0, 0, 1], [1, 0, 0], [0, 1, 0]]),
        ([2, 3, 3], [[1, 0, 0], [0, 1, 0], [0, 0, 1]]), ([3, 3, 3], [[1, 0, 0], [0, 1, 0], [0, 0, 1]]),
        ([3, 2, 1], [[0, 0, 1], [0, 1, 0], [-1, 0, 0]]),
    ],
)  # fmt: skip
def test_equal_moments_take_the_axes_of_the_file(rng, moments, axes, noise):
    jitter = noise * rng.normal(size=(3, 3))
    own = mass.principal_inertia(np.diag(np.array(moments, dtype=float)) + jitter + jitter.T)[1]
    np.testing.assert_allclose(own, axes, atol=1e-8)


@pytest.mark.parametrize("name", sorted(CAD))
def test_volume_against_cad(name):
    part = load(PARTS / f"{name}.stl")
    volume = part.volume * 1e9
    assert not any("through itself" in text for text in part.warnings)
    assert volume == pytest.approx(float(CAD[name]["volume_mm3"]), rel=1e-4)
    assert volume == pytest.approx(float(CAD[name]["cad_volume_mm3"]), rel=2.5e-3)  # chords cut off arcs


@pytest.mark.parametrize(
    ("text", "units", "answer"),
    [
        ("5,10,3", None, (5e-3, 10e-3, 3e-3)), (" 5 , 10 , 3 ", "in", (5 * INCH, 10 * INCH, 3 * INCH)),
        ("5 mm,1 cm,0.12in", None, (5e-3, 10e-3, 0.12 * INCH)), ("(1e0,2.5,3)", None, (1e-3, 2.5e-3, 3e-3)),
        *((text, None, OUTSIDE) for text in ("10,10,15", "0,0,0", "50,0,0", "5,10,15 m")),
        *((text, None, f"'{text}' {TRIPLE}") for text in ("1,2", "0,5,1,2,3,1")),
        ("a,b,c", None, f"'a' {NUMBER}"),
    ],
)  # fmt: skip
def test_centre_of_mass_is_in_the_units_of_the_file(text, units, answer):
    if isinstance(answer, str):
        assert refused(BOX, centre_of_mass=text) == f"centre_of_mass: {answer}"
    else:
        centre = loaded(BOX, units=units, centre_of_mass=text).centre_of_mass
        np.testing.assert_allclose(centre, answer, rtol=1e-12)


def turns(*turns_about):
    return np.array([Rotation.from_rotvec(np.radians(a) * np.array(v) / np.linalg.norm(v)).as_matrix()
                     for a, v in turns_about])  # fmt: skip


def moments(mesh):
    return mass.Moments(mesh.vertices, mesh.faces, mesh.center_mass)


@pytest.mark.parametrize("refine", [0, 7])  # 12 facets, and 196,608: both rules of quadrature
def test_a_box_has_its_closed_form_moments(refine):
    box = moments(shapes.subdivided(shapes.box(2.0, 4.0, 6.0), refine))
    size2 = (1 + 4 + 9) / 3
    assert box.size == pytest.approx(np.sqrt(size2), rel=1e-6)
    want = [0, 9 / 3 / size2, 0, 81 / 5 / size2**2, 0, 729 / 7 / size2**3]
    np.testing.assert_allclose(box.directional(np.array([0.0, 0.0, 1.0])), want, rtol=1e-5, atol=1e-9)


def test_symmetries_of_a_box_and_of_a_pierced_cube():
    rotations = turns((180, [0, 0, 1]), (180, [1, 0, 0]), (90, [0, 0, 1]), (120, [1, 1, 1]))
    wrong = moments(shapes.box(10, 20, 30)).mismatch(rotations)
    assert (wrong < 1e-12).tolist() == [True, True, False, False]
    assert (wrong[2:] > 0.05).all()
    cube = shapes.box(20, 20, 20)
    hole = trimesh.creation.cylinder(radius=1, height=2, sections=24).apply_translation([0, 0, 9])
    faces = np.vstack([cube.faces, hole.faces[:, ::-1] + len(cube.vertices)])
    pierced = moments(trimesh.Trimesh(np.vstack([cube.vertices, hole.vertices]), faces))
    wrong = pierced.mismatch(turns((90, [0, 0, 1]), (180, [1, 0, 0]), (90, [1, 0, 0])))
    assert wrong[0] < pierced.error < wrong[1:].min()


def test_the_hull_of_a_box_and_what_has_none():
    mesh = shapes.box(2.0, 4.0, 6.0)
    hull = convex_hull(mesh.vertices, [0.0, 0.0, 0.5])
    assert sorted(set(np.round(hull.heights, 12))) == [1.0, 2.0, 2.5, 3.5]
    assert hull.areas.sum() == pytest.approx(2 * (8 + 12 + 24))
    assert hull.radius == pytest.approx(np.sqrt(1 + 4 + 3.5**2))
    assert hull.volume == pytest.approx(48.0)
    square = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], dtype=float)
    with pytest.raises(MeshError, match=r"^flat.stl: the part has no volume - export it as a closed solid$"):
        convex_hull(square, square.mean(axis=0), "flat.stl")
    for centre in ([0.5, 0, 0], [0.7, 0, 0]):
        with pytest.raises(MeshError, match=r"^b.stl: the centre of mass is not inside the part's convex"):
            convex_hull(shapes.box(1, 1, 1).vertices, centre, "b.stl")


@given(seed=st.integers(0, 2**32 - 1), count=st.integers(5, 60))
@settings(max_examples=40, deadline=None)
def test_triangles_turn_outward_and_neighbours_share_the_opposite_edge(seed, count):
    points = np.random.default_rng(seed).normal(size=(count, 3))
    hull = convex_hull(points, points.mean(axis=0))
    a, b, c = np.moveaxis(hull.corners, 1, 0)
    assert (np.einsum("ti,ti->t", np.cross(b - a, c - a), hull.normals) > 0).all()
    np.testing.assert_allclose(np.einsum("ti,ti->t", a, hull.normals), hull.heights, rtol=1e-9, atol=1e-12)
    for t, (corners, others) in enumerate(zip(hull.triangles, hull.neighbours)):
        for k, other in enumerate(others):
            assert set(np.delete(corners, k)) == set(corners) & set(hull.triangles[other]), t


@pytest.mark.parametrize("seed", range(4))
def test_a_split_and_rounded_surface_has_the_hull_of_the_whole_one(seed, rng):
    """Corners in the middle of edges and faces stand out by single precision: they are none."""
    mesh = shapes.turned(shapes.prism(shapes.l_profile(), 9.0), np.random.default_rng(seed))
    fine = shapes.subdivided(mesh, 3)
    points = fine.vertices.astype(np.float32).astype(float)
    hull = convex_hull(points, points.mean(axis=0))
    assert len(hull.vertices) == len(convex_hull(mesh.vertices, mesh.vertices.mean(axis=0)).vertices)


def test_a_fine_circle_and_a_shallow_bevel_keep_their_corners():
    turn = 2.0 * np.pi * np.arange(1000) / 12000  # as fine as a whole circle of 12000
    ring = np.vstack([np.column_stack([np.cos(turn), np.sin(turn)]), [(-1.0, -0.3)]])
    coin = np.concatenate([np.column_stack([ring, np.full(len(ring), z)]) for z in (-0.1, 0.1)])
    assert len(convex_hull(coin, np.zeros(3)).vertices) == 2 * len(ring)
    bevelled = np.vstack([shapes.box(2.0, 2.0, 2.0).vertices, [(0.0, 0.0, 1.0 + 1e-3)]])
    assert len(convex_hull(bevelled, np.zeros(3)).vertices) == 9
