"""Mass properties against closed forms, invariances and CAD."""

import csv
import io
from pathlib import Path

import numpy as np
import part_files as files
import pytest
import shapes
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from feederscrew.part import load, mass
from feederscrew.part.mass import mass_balance

PARTS = Path(__file__).parents[2] / "parts"
CAD = {  # volume of the mesh and of the exact B-rep [mm3], as their maker printed them: parts/README.md
    row["name"]: row
    for row in csv.DictReader(
        line for line in (PARTS / "volumes.csv").read_text().splitlines() if not line.startswith("#")
    )
}
SIDE = st.floats(0.1, 100.0)


def cuboid(a, b, c, corner=(0.0, 0.0, 0.0)):
    return files.box((a, b, c), corner)


@given(a=SIDE, b=SIDE, c=SIDE, corner=st.tuples(*[st.floats(-1e4, 1e4)] * 3))
@settings(max_examples=60, deadline=None)
def test_box(a, b, c, corner):
    found = mass.integrate_solid(cuboid(a, b, c, corner))
    volume = a * b * c
    noise = 1e-11 * (1.0 + max(map(abs, corner)) / min(a, b, c))  # of the corners themselves
    assert found.volume == pytest.approx(volume, rel=noise)
    np.testing.assert_allclose(found.centre, np.add(corner, np.divide((a, b, c), 2)), rtol=1e-12, atol=1e-9)
    want = volume / 12.0 * np.diag([b * b + c * c, a * a + c * c, a * a + b * b])
    np.testing.assert_allclose(found.inertia, want, rtol=0, atol=noise * want.max())


def test_tetrahedron():
    a, b, c = 3.0, 5.0, 7.0
    corners = np.array([[0, 0, 0], [a, 0, 0], [0, b, 0], [0, 0, c]])
    found = mass.integrate_solid(corners[[[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]])
    volume = a * b * c / 6.0
    assert found.volume == pytest.approx(volume, rel=1e-14)
    np.testing.assert_allclose(found.centre, [a / 4, b / 4, c / 4], rtol=1e-14)
    diagonal = 3.0 / 80.0 * np.array([b * b + c * c, a * a + c * c, a * a + b * b])
    product = np.array([[0, a * b, a * c], [a * b, 0, b * c], [a * c, b * c, 0]]) / 80.0
    np.testing.assert_allclose(found.inertia, volume * (np.diag(diagonal) + product), rtol=1e-13)


@pytest.mark.parametrize("sections", [16, 64, 256])
def test_cylinder_converges_with_the_square_of_the_sections(sections):
    radius, height = 3.0, 8.0
    mesh = shapes.cylinder(radius, height, sections)
    found = mass.integrate_solid(mesh.vertices[mesh.faces])
    volume = np.pi * radius**2 * height
    across = volume * (3.0 * radius**2 + height**2) / 12.0
    want = np.array([across, across, volume * radius**2 / 2.0])
    short = 1.0 / sections**2
    assert 6.0 * short < 1.0 - found.volume / volume < 6.7 * short  # 2 pi^2 / 3 = 6.58
    np.testing.assert_allclose(np.diag(found.inertia), want, rtol=14.0 * short)


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
    found = mass.integrate_solid(triangles)
    rotation = Rotation.from_rotvec(turn).as_matrix()
    order = rng.permutation(len(triangles))
    moved = np.roll(triangles[order] @ rotation.T * scale + shift, rng.integers(3), axis=1)
    again = mass.integrate_solid(moved)
    assert again.volume == pytest.approx(found.volume * scale**3, rel=1e-7)
    np.testing.assert_allclose(again.centre, rotation @ found.centre * scale + shift, rtol=1e-7, atol=1e-7)
    want = scale**5 * rotation @ found.inertia @ rotation.T
    np.testing.assert_allclose(again.inertia, want, rtol=0, atol=1e-6 * np.abs(want).max())


def test_parallel_axes():
    inertia = mass.shift_inertia(np.zeros((3, 3)), 2.0, [1.0, 2.0, 3.0])
    np.testing.assert_allclose(inertia, 2.0 * np.array([[13, -2, -3], [-2, 10, -6], [-3, -6, 5]]))


def test_at_the_origin_agrees_with_integrals_there():
    """About a corner at the origin: m (b2 + c2) / 3 on the diagonal, -m a b / 4 beside it."""
    a, b, c = 10.0, 20.0, 30.0
    part = load("-", density="1 g/cm3", stdin=io.BytesIO(files.binary_stl(cuboid(a, b, c))))
    want = np.diag([b * b + c * c, a * a + c * c, a * a + b * b]) / 3.0
    want -= np.array([[0, a * b, a * c], [a * b, 0, b * c], [a * c, b * c, 0]]) / 4.0
    np.testing.assert_allclose(mass_balance(part).inertia_at_origin, part.mass * want * 1e-6, rtol=1e-6)


def test_principal_axes_are_right_handed_and_diagonal(rng):
    for _ in range(50):
        root = rng.normal(size=(3, 3))
        inertia = np.trace(root @ root.T) * np.eye(3) - root @ root.T
        moments, axes = mass.principal_inertia(inertia)
        assert (np.diff(moments) >= 0.0).all()
        np.testing.assert_allclose(axes @ inertia @ axes.T, np.diag(moments), rtol=0, atol=1e-12 * moments[2])
        assert np.linalg.det(axes) == pytest.approx(1.0)
        for axis in axes[:2]:
            assert axis[np.argmax(np.abs(axis))] > 0.0


@pytest.mark.parametrize("noise", [0.0, 1e-12])
@pytest.mark.parametrize(
    ("moments", "axes"),
    [
        ([2, 2, 3], [[1, 0, 0], [0, 1, 0], [0, 0, 1]]),
        ([3, 3, 2], [[0, 0, 1], [1, 0, 0], [0, 1, 0]]),
        ([2, 3, 3], [[1, 0, 0], [0, 1, 0], [0, 0, 1]]),
        ([3, 3, 3], [[1, 0, 0], [0, 1, 0], [0, 0, 1]]),
        ([3, 2, 1], [[0, 0, 1], [0, 1, 0], [-1, 0, 0]]),
    ],
)
def test_equal_moments_take_the_axes_of_the_file(rng, moments, axes, noise):
    inertia = np.diag(np.array(moments, dtype=float))
    jitter = noise * rng.normal(size=(3, 3))
    _, found = mass.principal_inertia(inertia + jitter + jitter.T)
    np.testing.assert_allclose(found, axes, atol=1e-8)


@pytest.mark.parametrize("name", sorted(CAD))
def test_volume_against_cad(name):
    volume = load(PARTS / f"{name}.stl").volume * 1e9
    assert volume == pytest.approx(float(CAD[name]["volume_mm3"]), rel=1e-4)
    assert volume == pytest.approx(float(CAD[name]["cad_volume_mm3"]), rel=2.5e-3)  # chords cut off arcs


def test_given_centre_of_mass_moves_the_inertia_along():
    box = io.BytesIO(files.binary_stl(cuboid(10, 20, 30)))
    plain = load("-", stdin=io.BytesIO(box.getvalue()))
    heavy = load("-", centre_of_mass="5,10,3", stdin=box)
    np.testing.assert_allclose(heavy.centre_of_mass, [5e-3, 10e-3, 3e-3], rtol=1e-12)
    np.testing.assert_array_equal(heavy.inertia, plain.inertia)
    assert heavy.mass == plain.mass
    assert heavy.warnings == (
        "the centre of mass is as given and how the mass is spread is not known: "
        "the inertia is that of the homogeneous solid about its own centroid",
    )


@pytest.mark.parametrize(
    ("text", "units", "metres"),
    [
        ("5,10,3", None, (5e-3, 10e-3, 3e-3)),
        (" 5 , 10 , 3 ", "in", (5 * 0.0254, 10 * 0.0254, 3 * 0.0254)),
        ("5 mm,1 cm,0.12in", None, (5e-3, 10e-3, 0.12 * 0.0254)),
        ("(1e0,2.5,3)", None, (1e-3, 2.5e-3, 3e-3)),
    ],
)
def test_centre_of_mass_is_in_the_units_of_the_file(tmp_path, text, units, metres):
    path = files.written(tmp_path, cuboid(10, 20, 30))
    part = load(path, units=units, centre_of_mass=text)
    np.testing.assert_allclose(part.centre_of_mass, metres, rtol=1e-12)


OUTSIDE = (
    "centre_of_mass: the centre of mass is not inside the part's convex hull - "
    "check `centre_of_mass` and its units"
)
TRIPLE = "write x,y,z with points and commas, as in 1.5,0,-2"


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("10,10,15", OUTSIDE),
        ("0,0,0", OUTSIDE),
        ("50,0,0", OUTSIDE),
        ("5,10,15 m", OUTSIDE),
        ("1,2", f"centre_of_mass: '1,2' is not three numbers - {TRIPLE}"),
        ("0,5,1,2,3,1", f"centre_of_mass: '0,5,1,2,3,1' is not three numbers - {TRIPLE}"),
        ("a,b,c", "centre_of_mass: 'a' is not a number - write digits with a decimal point, as in 0.4"),
        ("nan,1,1", "centre_of_mass: 'nan' is not a number - write digits with a decimal point, as in 0.4"),
        ("1 kg,1,1", "centre_of_mass: '1 kg' is a mass, not a length - give it in mm"),
    ],
)
def test_centre_of_mass_that_cannot_be(tmp_path, text, line):
    assert files.refused(files.written(tmp_path, cuboid(10, 20, 30)), centre_of_mass=text) == line
