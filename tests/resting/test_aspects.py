"""Resting aspects of whole parts: closed forms, curved and noisy parts, symmetry, names that stay."""

import numpy as np
import pytest
import shapes
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st

from feederscrew.geometry import vectors
from feederscrew.resting.aspects import find
from feederscrew.resting.faces import contact_outlines

SIDES = st.integers(1, 40)  # sides that differ by less than 1e-4 count as equal


def aspects(mesh, **options):
    return find(shapes.part(mesh), **options)


def rectangle(a, b, h):
    return 4 * np.arcsin(a * b / np.sqrt((a * a + 4 * h * h) * (b * b + 4 * h * h)))


@given(a=SIDES, b=SIDES, c=SIDES)
@settings(max_examples=40, deadline=None)
def test_a_box_has_its_closed_forms(a, b, c):
    found = aspects(shapes.box(a, b, c))
    assert found.faces.sum() == 6
    mass = 7850e-9 * a * b * c
    for k, height in enumerate(found.heights):
        x, y = min(((b, c), (a, c), (a, b)), key=lambda xy: abs(a * b * c / (xy[0] * xy[1]) / 2e3 - height))
        assert found.contact_areas[k] == pytest.approx(x * y * 1e-6, rel=1e-9)
        assert found.solid_angles[k] == pytest.approx(rectangle(x, y, height * 1e3), rel=1e-9)
        assert found.polar_inertias[k] == pytest.approx(mass * (x * x + y * y) / 12 * 1e-6, rel=1e-9)
    for chance in found.probabilities.values():
        assert chance.sum() == pytest.approx(1, rel=1e-12)
    assert (found.faces * found.solid_angles).sum() == pytest.approx(4 * np.pi, rel=1e-9)


@pytest.mark.parametrize(
    ("mesh", "faces"),
    [
        (shapes.box(8, 8, 8), [6]),
        (shapes.box(8, 8, 20), [4, 2]),
        (shapes.box(8, 9, 20), [2, 2, 2]),
        (shapes.cylinder(5, 20, 6), [6, 2]),
        (shapes.cylinder(5, 20, 12), [12, 2]),
        (trimesh.creation.icosahedron(), [20]),
    ],
    ids=["cube", "square bar", "box", "hexagonal bar", "12-sided bar", "icosahedron"],
)
def test_equal_faces_make_one_class(mesh, faces):
    found = aspects(mesh)
    assert found.faces.tolist() == faces
    assert set(found.kinds) == {"flat"}


@pytest.mark.parametrize("sections", [16, 24, 31, 64, 257, 500])
def test_a_cylinder_rolls_on_its_side(sections):
    found = aspects(shapes.turned(shapes.cylinder(5, 20, sections), np.random.default_rng(sections)))
    assert sorted(zip(found.kinds, found.faces)) == [("flat", 2), ("rolling", 1)]
    side, end = found.kinds.index("rolling"), found.kinds.index("flat")
    assert abs(found.axes[side] @ found.normals[end]) == pytest.approx(1, abs=1e-6)
    assert found.heights[side] == pytest.approx(5e-3, rel=1e-6)  # of the circle, whatever the file's sections
    exact = 2 * np.pi * (1 - 10 / np.hypot(10, 5))
    assert found.solid_angles[end] == pytest.approx(exact, rel=8 / sections**2)


def test_the_height_over_two_circles_is_that_over_their_common_line():
    found = aspects(trimesh.creation.revolve([(0, 0), (6, 0), (3, 8), (0, 8)], sections=32))
    middle = 8.0 * (6.0**2 + 2 * 6.0 * 3.0 + 3 * 3.0**2) / (4 * (6.0**2 + 6.0 * 3.0 + 3.0**2))
    side = found.kinds.index("rolling")
    exact = (6.0 - middle * 3.0 / 8.0) / np.hypot(1.0, 3.0 / 8.0)
    assert found.heights[side] == pytest.approx(1e-3 * exact, rel=1e-6)


@pytest.mark.parametrize("sections", [24, 48, 96])
@pytest.mark.parametrize("off_mm", [0.2, 1.0])
def test_a_cylinder_heavy_on_one_side_rolls_on_its_whole_side(sections, off_mm):
    part = shapes.part(shapes.cylinder(5, 20, sections))
    object.__setattr__(part, "centre_of_mass", part.centre_of_mass + np.array([off_mm * 1e-3, 0, 0]))
    found = find(part)
    assert sorted(zip(found.kinds, found.faces)) == [("flat", 2), ("rolling", 1)]
    side = found.kinds.index("rolling")
    assert found.contact_areas[side] * 1e6 == pytest.approx(
        sections * 2 * 5 * np.sin(np.pi / sections) * 20, rel=1e-9
    )
    assert (found.faces * found.solid_angles).sum() == pytest.approx(4 * np.pi, rel=1e-9)


@pytest.mark.parametrize("subdivisions", [2, 3, 4])
def test_a_ball_is_one_rolling_class_and_says_so(subdivisions):
    found = aspects(shapes.ball(5, subdivisions))
    assert (found.kinds, found.names) == (("rolling",), ("A",))
    assert np.isnan(found.axes).all()
    assert "ball" in found.warnings[0]


@pytest.mark.parametrize("noise", [1e-6, 1e-5, 1e-4, 1e-3, 5e-3])
def test_noise_leaves_a_box_its_three_classes(noise, rng):
    box = shapes.subdivided(shapes.box(10, 20, 30), 4)
    found = aspects(shapes.noisy(box, noise * 30, rng))
    assert found.faces.tolist() == [2, 2, 2]
    np.testing.assert_allclose(found.heights * 1e3, [5, 10, 15], rtol=0, atol=0.01 + 2 * noise * 30)
    np.testing.assert_allclose(found.contact_areas * 1e6, [600, 300, 200], rtol=0.02 + 10 * noise)


def test_mirror_images_stay_apart():
    found = aspects(shapes.prism(shapes.l_profile(), 15))
    sides = [k for k, normal in enumerate(found.normals) if abs(normal[2]) > 0.99]
    assert [found.faces[k] for k in sides] == [1, 1]
    assert found.probabilities["csa"][sides[0]] == pytest.approx(
        found.probabilities["csa"][sides[1]], rel=1e-9
    )


def test_the_symmetry_is_the_part_s_and_not_its_hull_s():
    cube = shapes.box(20, 20, 20)
    bore = trimesh.creation.cylinder(radius=3, height=20 - 1e-9, sections=32)  # a closed cavity along z
    hollow = trimesh.Trimesh(
        np.vstack([cube.vertices, bore.vertices]),
        np.vstack([cube.faces, bore.faces[:, ::-1] + len(cube.vertices)]),
    )
    assert sorted(aspects(hollow).faces.tolist()) == [2, 4]


@given(seed=st.integers(0, 2**32 - 1), scale=st.sampled_from([1.0, 0.3, 4.0]))
@settings(max_examples=25, deadline=None)
def test_turning_moving_scaling_and_shuffling_change_nothing(seed, scale):
    rng = np.random.default_rng(seed)
    mesh = shapes.prism(shapes.l_profile(), 15)
    moved = shapes.turned(mesh, rng).apply_scale(scale)
    moved = trimesh.Trimesh(moved.vertices, rng.permutation(moved.faces), process=False)
    first, second = aspects(mesh), aspects(moved)
    assert (first.names, first.kinds) == (second.names, second.kinds)
    np.testing.assert_allclose(second.heights, first.heights * scale, rtol=1e-9)
    np.testing.assert_allclose(second.contact_areas, first.contact_areas * scale**2, rtol=1e-9)
    for rule, chance in first.probabilities.items():
        np.testing.assert_allclose(second.probabilities[rule], chance, rtol=1e-9)


def test_a_turned_part_keeps_the_names_of_mirrored_aspects(rng):
    mesh = shapes.prism(shapes.l_profile(), 15)
    first = aspects(mesh)
    for _ in range(10):
        matrix = trimesh.transformations.random_rotation_matrix(rng.random(3))
        second = aspects(mesh.copy().apply_transform(matrix))
        np.testing.assert_allclose(second.normals, first.normals @ matrix[:3, :3].T, atol=1e-9)


def test_unstable_facets_are_listed_last_with_no_probability():
    mesh = shapes.prism([(0, 0), (10, 0), (40, 20), (30, 20)], 8)
    found = aspects(mesh, unstable=True)
    stable = aspects(mesh)
    assert found.names[: len(stable.names)] == stable.names
    assert not found.stable[len(stable.names) :].any() and len(found.names) > len(stable.names)
    assert all((chance[~found.stable] == 0).all() for chance in found.probabilities.values())
    assert (found.faces * found.solid_angles).sum() == pytest.approx(4 * np.pi, rel=1e-9)


def test_as_published_counts_each_class_once():
    mesh = shapes.box(10, 20, 30)
    every, once = aspects(mesh), aspects(mesh, as_published=True)
    weight = every.polar_inertias / every.heights
    np.testing.assert_allclose(once.probabilities["pmi"], weight / weight.sum(), rtol=1e-12)
    np.testing.assert_allclose(once.probabilities["csa"], every.probabilities["csa"], rtol=1e-12)


@pytest.mark.parametrize("strips", [8, 9, 10, 12, 13, 14, 16, 24, 48, 200])
def test_a_half_cylinder_rocks_on_its_whole_curved_side(strips):
    turn = np.linspace(0.0, np.pi, strips + 1)
    half = shapes.prism(np.column_stack([8.0 * np.cos(turn), 8.0 * np.sin(turn)]), 25.0)
    found = find(shapes.part(half))
    assert sorted(zip(found.kinds, found.faces)) == [("flat", 1), ("flat", 2), ("rolling", 1)]
    side, height = found.kinds.index("rolling"), 8e-3 * (1.0 - 4.0 / (3.0 * np.pi))  # [m] of the smooth one
    assert found.heights[side] == pytest.approx(height, rel=2.0 / strips**2 + 0.01)
    assert found.contact_areas[side] * 1e6 == pytest.approx(
        strips * 16.0 * np.sin(0.5 * np.pi / strips) * 25.0
    )


def test_the_half_turns_of_an_ellipsoid_do_not_depend_on_the_file():
    egg = shapes.ball(1.0, 4).apply_transform(np.diag([10.0, 7.0, 5.0, 1.0]))
    for mesh in (egg, shapes.turned(egg, np.random.default_rng(2))):
        assert find(shapes.part(mesh)).faces.tolist() == [2]


def test_an_outline_is_that_seen_along_its_normal(rng):
    """Of corners not quite in one plane: another view takes one of them for a corner, or for none."""
    normal, plane = np.array([0.0, 0.0, 1.0]), np.array([[-3, -2, 0], [3, -2, 0], [3, 2, 0], [-3, 2, 0.0]])
    for _ in range(20):
        side = np.array([rng.uniform(-2.0, 2.0), 2.0 + rng.choice([-1e-3, 1e-3]), 0.05])
        points = np.concatenate([plane, [side]])
        turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
        turn *= np.sign(np.linalg.det(turn))
        turned = vectors.product(points, turn.T)
        (found,) = contact_outlines(
            turned, np.arange(5), np.zeros(5, int), vectors.product(turn, normal)[None]
        )
        assert len(found) == (5 if side[1] > 2.0 else 4)


@pytest.mark.parametrize("seed", range(4))
def test_slivers_at_sharp_edges_leave_every_aspect(seed):
    rng = np.random.default_rng(seed)
    body = trimesh.convex.convex_hull(rng.normal(size=(12, 3)) * [10.0, 7.0, 4.0])
    rough = shapes.noisy(shapes.subdivided(body, 1), 1e-6 * body.extents.max(), rng)
    exact, found = find(shapes.part(body)), find(shapes.part(rough))
    assert found.heights == pytest.approx(exact.heights, rel=1e-4)
    assert found.probabilities["csa"] == pytest.approx(exact.probabilities["csa"], abs=1e-3)
