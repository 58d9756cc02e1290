"""Resting aspects of whole parts: closed forms, curved and noisy parts, symmetry, names that stay."""

import re
from pathlib import Path

import numpy as np
import part_files as files
import pytest
import shapes
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st

from feederscrew.base.errors import FeederError
from feederscrew.base.geometry import vectors
from feederscrew.base.geometry.polygons import centroid, inset, outline
from feederscrew.part import load
from feederscrew.part.hull import convex_hull
from feederscrew.resting.aspects import find
from feederscrew.resting.faces import contact_outlines
from feederscrew.resting.posture import posture

SIDES = st.integers(1, 40)  # sides that differ by less than 1e-4 count as equal
LOPSIDED = shapes.prism([(0, 0), (30, 0), (30, 5), (12, 5), (5, 14), (0, 14)], 7.0)


def aspects(mesh, **options):
    return find(shapes.part(mesh), **options)


def whole_sphere(resting):
    assert (resting.faces * resting.solid_angles).sum() == pytest.approx(4 * np.pi, rel=1e-9)


def rectangle(a, b, h):
    return 4 * np.arcsin(a * b / np.sqrt((a * a + 4 * h * h) * (b * b + 4 * h * h)))


@given(a=SIDES, b=SIDES, c=SIDES)
@settings(max_examples=40, deadline=None)
def test_a_box_has_its_closed_forms(a, b, c):
    resting = aspects(shapes.box(a, b, c))
    assert resting.faces.sum() == 6
    mass = 7850e-9 * a * b * c
    for k, height in enumerate(resting.heights):
        x, y = min(((b, c), (a, c), (a, b)), key=lambda xy: abs(a * b * c / (xy[0] * xy[1]) / 2e3 - height))
        assert resting.contact_areas[k] == pytest.approx(x * y * 1e-6, rel=1e-9)
        assert resting.solid_angles[k] == pytest.approx(rectangle(x, y, height * 1e3), rel=1e-9)
        assert resting.polar_inertias[k] == pytest.approx(mass * (x * x + y * y) / 12 * 1e-6, rel=1e-9)
    assert all(p.sum() == pytest.approx(1.0) for p in resting.probabilities.values())
    whole_sphere(resting)


@pytest.mark.parametrize(
    ("mesh", "faces"),
    [
        (shapes.box(8, 8, 8), [6]), (shapes.box(8, 8, 20), [4, 2]), (shapes.box(8, 9, 20), [2, 2, 2]),
        (shapes.cylinder(5, 20, 6), [6, 2]), (shapes.cylinder(5, 20, 12), [12, 2]),
        (trimesh.creation.icosahedron(), [20]),
    ],
    ids=["cube", "square bar", "box", "hexagonal bar", "12-sided bar", "icosahedron"],
)  # fmt: skip
def test_equal_faces_make_one_class(mesh, faces):
    resting = aspects(mesh)
    assert resting.faces.tolist() == faces
    assert set(resting.kinds) == {"flat"}


@pytest.mark.parametrize("sections", [16, 31, 64, 257, 500])
def test_a_cylinder_rolls_on_its_side(sections):
    resting = aspects(shapes.turned(shapes.cylinder(5, 20, sections), np.random.default_rng(sections)))
    assert sorted(zip(resting.kinds, resting.faces)) == [("flat", 2), ("rolling", 1)]
    side, end = resting.kinds.index("rolling"), resting.kinds.index("flat")
    assert abs(resting.axes[side] @ resting.normals[end]) == pytest.approx(1, abs=1e-6)
    assert resting.heights[side] == pytest.approx(5e-3, rel=1e-6)  # of the circle, whatever the sections
    exact = 2 * np.pi * (1 - 10 / np.hypot(10, 5))
    assert resting.solid_angles[end] == pytest.approx(exact, rel=8 / sections**2)


def test_the_height_over_two_circles_is_that_over_their_common_line():
    resting = aspects(trimesh.creation.revolve([(0, 0), (6, 0), (3, 8), (0, 8)], sections=32))
    middle = 8.0 * (6.0**2 + 2 * 6.0 * 3.0 + 3 * 3.0**2) / (4 * (6.0**2 + 6.0 * 3.0 + 3.0**2))
    exact = (6.0 - middle * 3.0 / 8.0) / np.hypot(1.0, 3.0 / 8.0)
    assert resting.heights[resting.kinds.index("rolling")] == pytest.approx(1e-3 * exact, rel=1e-6)


@pytest.mark.parametrize("sections", [24, 96])
@pytest.mark.parametrize("off_mm", [0.2, 1.0])
def test_a_cylinder_heavy_on_one_side_rolls_on_its_whole_side(sections, off_mm):
    part = shapes.part(shapes.cylinder(5, 20, sections))
    object.__setattr__(part, "centre_of_mass", part.centre_of_mass + np.array([off_mm * 1e-3, 0, 0]))
    resting = find(part)
    assert sorted(zip(resting.kinds, resting.faces)) == [("flat", 2), ("rolling", 1)]
    area = sections * 2 * 5 * np.sin(np.pi / sections) * 20
    assert resting.contact_areas[resting.kinds.index("rolling")] * 1e6 == pytest.approx(area, rel=1e-9)
    whole_sphere(resting)


@pytest.mark.parametrize("strips", [8, 9, 10, 12, 13, 14, 16, 24, 48, 200])
def test_a_half_cylinder_rocks_on_its_whole_curved_side(strips):
    turn = np.linspace(0.0, np.pi, strips + 1)
    resting = aspects(shapes.prism(np.column_stack([8.0 * np.cos(turn), 8.0 * np.sin(turn)]), 25.0))
    assert sorted(zip(resting.kinds, resting.faces)) == [("flat", 1), ("flat", 2), ("rolling", 1)]
    side, height = resting.kinds.index("rolling"), 8e-3 * (1.0 - 4.0 / (3.0 * np.pi))  # [m] of the smooth one
    assert resting.heights[side] == pytest.approx(height, rel=2.0 / strips**2 + 0.01)
    area = strips * 16.0 * np.sin(0.5 * np.pi / strips) * 25.0
    assert resting.contact_areas[side] * 1e6 == pytest.approx(area)


@pytest.mark.parametrize("subdivisions", [2, 3, 4])
def test_a_ball_is_one_rolling_class_and_says_so(subdivisions):
    resting = aspects(shapes.ball(5, subdivisions))
    assert (resting.kinds, resting.names) == (("rolling",), ("A",))
    assert np.isnan(resting.axes).all()
    assert "ball" in resting.warnings[0]


@pytest.mark.parametrize("noise", [1e-6, 1e-5, 1e-4, 1e-3, 5e-3])
def test_noise_leaves_a_box_its_three_classes(noise, rng):
    resting = aspects(shapes.noisy(shapes.subdivided(shapes.box(10, 20, 30), 4), noise * 30, rng))
    assert resting.faces.tolist() == [2, 2, 2]
    np.testing.assert_allclose(resting.heights * 1e3, [5, 10, 15], rtol=0, atol=0.01 + 2 * noise * 30)
    np.testing.assert_allclose(resting.contact_areas * 1e6, [600, 300, 200], rtol=0.02 + 10 * noise)


def test_the_symmetry_is_the_parts_and_no_mirror():
    resting = aspects(shapes.prism(shapes.l_profile(), 15))
    sides = np.abs(resting.normals[:, 2]) > 0.99
    assert resting.faces[sides].tolist() == [1, 1]
    assert np.ptp(resting.probabilities["csa"][sides]) < 1e-9
    cube = shapes.box(20, 20, 20)
    bore = trimesh.creation.cylinder(radius=3, height=20 - 1e-9, sections=32)  # a closed cavity along z
    faces = np.vstack([cube.faces, bore.faces[:, ::-1] + len(cube.vertices)])
    hollow = trimesh.Trimesh(np.vstack([cube.vertices, bore.vertices]), faces)
    assert sorted(aspects(hollow).faces.tolist()) == [2, 4]
    egg = shapes.ball(1.0, 4).apply_transform(np.diag([10.0, 7.0, 5.0, 1.0]))
    for mesh in (egg, shapes.turned(egg, np.random.default_rng(2))):
        assert aspects(mesh).faces.tolist() == [2]


@given(seed=st.integers(0, 2**32 - 1), scale=st.sampled_from([1.0, 0.3, 4.0]))
@settings(max_examples=25, deadline=None)
def test_turning_moving_scaling_and_shuffling_change_nothing(seed, scale):
    """Mirrored aspects keep their names as well."""
    rng = np.random.default_rng(seed)
    mesh = shapes.prism(shapes.l_profile(), 15)
    matrix = trimesh.transformations.random_rotation_matrix(rng.random(3))
    matrix[:3, 3] = rng.uniform(-50, 50, 3)
    moved = mesh.copy().apply_transform(matrix).apply_scale(scale)
    first = aspects(mesh)
    second = aspects(trimesh.Trimesh(moved.vertices, rng.permutation(moved.faces), process=False))
    assert (first.names, first.kinds) == (second.names, second.kinds)
    np.testing.assert_allclose(second.normals, first.normals @ matrix[:3, :3].T, atol=1e-9)
    np.testing.assert_allclose(second.heights, first.heights * scale, rtol=1e-9)
    np.testing.assert_allclose(second.contact_areas, first.contact_areas * scale**2, rtol=1e-9)
    for rule, chance in first.probabilities.items():
        np.testing.assert_allclose(second.probabilities[rule], chance, rtol=1e-9)


def test_unstable_facets_and_classes_as_published():
    mesh = shapes.prism([(0, 0), (10, 0), (40, 20), (30, 20)], 8)
    every, stable = aspects(mesh, unstable=True), aspects(mesh)
    assert every.names[: len(stable.names)] == stable.names
    assert not every.stable[len(stable.names) :].any() and len(every.names) > len(stable.names)
    assert all((chance[~every.stable] == 0).all() for chance in every.probabilities.values())
    whole_sphere(every)
    mesh = shapes.box(10, 20, 30)
    every, once = aspects(mesh), aspects(mesh, as_published=True)
    weight = every.polar_inertias / every.heights
    np.testing.assert_allclose(once.probabilities["pmi"], weight / weight.sum(), rtol=1e-12)
    np.testing.assert_allclose(once.probabilities["csa"], every.probabilities["csa"], rtol=1e-12)


def test_an_outline_is_that_seen_along_its_normal(rng):
    """Of corners not quite in one plane: another view takes one of them for a corner, or for none."""
    normal, plane = np.array([0.0, 0.0, 1.0]), np.array([[-3, -2, 0], [3, -2, 0], [3, 2, 0], [-3, 2, 0.0]])
    for _ in range(20):
        side = np.array([rng.uniform(-2.0, 2.0), 2.0 + rng.choice([-1e-3, 1e-3]), 0.05])
        turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
        turn *= np.sign(np.linalg.det(turn))
        turned = vectors.product(np.concatenate([plane, [side]]), turn.T)
        along = vectors.product(turn, normal)[None]
        (outline,) = contact_outlines(turned, np.arange(5), np.zeros(5, int), along)
        assert len(outline) == (5 if side[1] > 2.0 else 4)


def of_file(folder, mesh):
    return load(files.written(folder, files.obj(np.array(mesh.triangles)), "part.obj"))


def by_hand(part):
    """Weights I/h, Q/h and A/h of every plane of the hull with the foot inside, from the triangles alone."""
    hull, rows = part.hull, []
    keys = np.unique(hull.normals.round(6), axis=0, return_inverse=True)[1].ravel()
    for key in range(keys.max() + 1):
        own = np.flatnonzero(keys == key)
        normal, height = hull.normals[own[0]], hull.heights[own[0]]
        sides = np.roll(hull.corners[own], -1, axis=1) - hull.corners[own]
        if (np.cross(sides, height * normal - hull.corners[own]) @ normal >= 0.0).all(axis=1).any():
            angle, area = hull.solid_angles[own].sum(), hull.areas[own].sum()
            rows.append((normal @ part.inertia @ normal / height, angle / height, area / height))
    return np.array(rows)


def test_what_the_published_rules_give_with_every_facet(tmp_path):
    """A box of 20 x 16 x 12 mm whose top is a flat roof of four planes that meet off the middle."""
    corners = [[x, y, z] for z in (-6.0, 6.0) for x in (-10, 10) for y in (-8, 8)]
    part = of_file(tmp_path, trimesh.Trimesh([*corners, [-4.0, 0.1, 6.6], [5.0, 0.1, 6.6]]).convex_hull)
    resting, weights = find(part), by_hand(part)
    assert len(weights) > resting.faces[resting.stable].sum()  # the part stands on more than it lists
    text = next(line for line in resting.warnings if "facet" in line)
    for rule, weight in zip(("pmi", "csa", "stability"), weights.T):
        complete = np.sort(weight / weight.sum())
        for chance in resting.complete[rule] / resting.faces:  # each class with its share of all facets
            assert np.abs(complete - chance).min() < 1e-6
        change = resting.probabilities[rule] - resting.complete[rule]
        name, new, old = re.search(rf"p_{rule} of (\w+) ([\d.]+) for ([\d.]+)", text).groups()
        row = resting.names.index(name)
        assert float(old) - float(new) == pytest.approx(change[row], abs=1.1e-3)
        assert np.abs(change[row]) == np.abs(change).max()


PARTS = Path(__file__).parents[2] / "parts"


def standing(mesh, name="A"):
    part = shapes.part(mesh)
    return posture(part, find(part), name)


def test_box_on_its_largest_face():
    stood = standing(shapes.box(30, 10, 5))
    mass = shapes.STEEL * 30 * 10 * 5e-9
    assert stood.height == pytest.approx(2.5e-3)
    assert stood.offset == 0.0
    assert np.ptp(stood.outline, axis=0) == pytest.approx([0.03, 0.01])
    assert np.ptp(stood.contact, axis=0) == pytest.approx([0.03, 0.01])
    moments = mass / 12 * np.array([10**2 + 5**2, 30**2 + 5**2, 30**2 + 10**2]) * 1e-6
    np.testing.assert_allclose(stood.inertia, np.diag(moments), rtol=1e-9, atol=1e-9 * moments.max())


@pytest.mark.parametrize("name", ["A", "B", "C"])
def test_the_frame_of_a_lopsided_part(name, rng):
    """Right-handed: x from the foot to the contact's centroid, polygons counter-clockwise from above."""
    part = shapes.part(LOPSIDED)
    stood = posture(part, find(part), name)
    np.testing.assert_allclose(centroid(stood.contact), [stood.offset, 0.0], rtol=1e-9, atol=1e-12)
    assert name != "A" or stood.offset > 1e-4
    for polygon in (stood.contact, stood.outline):
        x, y = polygon.T
        assert (x * np.roll(y, -1) - y * np.roll(x, -1)).sum() > 0.0
    assert inset(stood.outline, stood.contact).min() > -1e-9
    assert inset(stood.contact, np.zeros(2)) > 0.0
    in_file = convex_hull(part.vertices, part.centre_of_mass).vertices[:3]
    on_floor = stood.corners[:3] - [0.0, 0.0, stood.height]
    assert abs(np.linalg.det(in_file)) > 0.0
    assert np.linalg.det(on_floor) == pytest.approx(np.linalg.det(in_file), rel=1e-9)
    turned = standing(shapes.turned(LOPSIDED, rng), name)
    assert turned.height == pytest.approx(stood.height, rel=1e-9)
    assert turned.offset == pytest.approx(stood.offset, rel=1e-6)
    size = np.abs(stood.inertia).max()
    np.testing.assert_allclose(turned.inertia, stood.inertia, rtol=0, atol=1e-7 * size)
    assert np.linalg.norm(turned.outline[:, None] - stood.outline, axis=-1).min(axis=1).max() < 1e-8


def test_postures_of_rolling_classes_and_of_cards():
    stood = standing(shapes.cylinder(3.0, 20.0, 64))
    assert stood.kind == "rolling"
    np.testing.assert_allclose(np.abs(stood.axis), [1.0, 0.0], rtol=0, atol=1e-6)
    part = load(PARTS / "arc_chute.yaml")
    aspects = find(part)
    stood = posture(part, aspects, "5")
    assert (stood.offset, stood.height, stood.turning_inertia) == pytest.approx((3.15e-3, 3.31e-3, 95.32e-9))
    assert stood.corners is None
    assert np.isnan(posture(part, aspects, "1").offset)
    with pytest.raises(FeederError) as fault:
        standing(shapes.box(30, 10, 5), "Z")
    assert str(fault.value) == "aspect of part.stl: there is no aspect 'Z' - choose one of A, B, C"


def test_polygons_of_outlines():
    square = 2.0 * np.array([[0, 0], [1, 0], [1, 1], [0, 1]])
    more = [[1, 0], [1, 2], [1, 1]]  # on straight sides, and within
    shift = np.array([1e-9, -1e-9])  # of corners in one place
    for points in (np.vstack([square, more]), np.vstack([square, square + shift, square - shift])):
        corners = outline(points)
        assert len(corners) == 4
        assert np.abs(np.sort(corners, axis=0) - np.sort(square, axis=0)).max() < 1e-8
    assert centroid(np.array([[0.0, 0.0], [3.0, 0.0], [0.0, 3.0]])) == pytest.approx([1.0, 1.0])
    assert centroid(np.array([[0.0, 0.0], [2.0, 0.0]])) == pytest.approx([1.0, 0.0])
    assert inset(square, np.array([[0.5, 1.0], [2.25, 1.0]])) == pytest.approx([0.5, -0.25])
    assert np.isnan(inset(np.empty((0, 2)), np.zeros(2)))
