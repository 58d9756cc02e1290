"""A part standing on an aspect: frame, drive offset, what a turned file must not change."""

from pathlib import Path

import numpy as np
import pytest
import shapes

from feederscrew.errors import FeederError
from feederscrew.geometry.polygons import centroid, inset, outline
from feederscrew.part import load
from feederscrew.part.hull import convex_hull
from feederscrew.resting.aspects import find
from feederscrew.resting.posture import posture


def standing(mesh, name="A"):
    part = shapes.part(mesh)
    return posture(part, find(part), name)


def lopsided():
    return shapes.prism([(0, 0), (30, 0), (30, 5), (12, 5), (5, 14), (0, 14)], 7.0)


def test_box_on_its_largest_face():
    stood = standing(shapes.box(30, 10, 5))
    mass = shapes.STEEL * 30 * 10 * 5e-9
    assert stood.height == pytest.approx(2.5e-3)
    assert stood.offset == 0.0
    assert np.ptp(stood.outline, axis=0) == pytest.approx([0.03, 0.01])
    assert np.ptp(stood.contact, axis=0) == pytest.approx([0.03, 0.01])
    moments = mass / 12 * np.array([10**2 + 5**2, 30**2 + 5**2, 30**2 + 10**2]) * 1e-6
    np.testing.assert_allclose(stood.inertia, np.diag(moments), rtol=1e-9, atol=1e-9 * moments.max())


def test_x_points_from_the_foot_to_the_contact_centroid():
    stood = standing(lopsided())
    middle = centroid(stood.contact)
    assert stood.offset > 1e-4
    np.testing.assert_allclose(middle, [stood.offset, 0.0], rtol=1e-9, atol=1e-12)


def test_polygons_run_counter_clockwise_from_above():
    stood = standing(lopsided(), "B")
    for polygon in (stood.contact, stood.outline):
        x, y = polygon.T
        assert (x * np.roll(y, -1) - y * np.roll(x, -1)).sum() > 0.0
    assert inset(stood.outline, stood.contact).min() > -1e-9
    assert inset(stood.contact, np.zeros(2)) > 0.0


@pytest.mark.parametrize("name", ["A", "B", "C"])
def test_a_turned_file_stands_the_same(name, rng):
    before, after = standing(lopsided(), name), standing(shapes.turned(lopsided(), rng), name)
    assert after.height == pytest.approx(before.height, rel=1e-9)
    assert after.offset == pytest.approx(before.offset, rel=1e-6)
    size = np.abs(before.inertia).max()
    np.testing.assert_allclose(after.inertia, before.inertia, rtol=0, atol=1e-7 * size)
    gap = np.linalg.norm(after.outline[:, None] - before.outline, axis=-1).min(axis=1)
    assert gap.max() < 1e-8


def test_axes_are_right_handed():
    """Standing is a rotation: the triple product of any three corners keeps its sign and size."""
    part = shapes.part(lopsided())
    stood = posture(part, find(part), "B")
    inside = convex_hull(part.vertices, part.centre_of_mass).vertices[:3]
    outside = stood.corners[:3] - [0.0, 0.0, stood.height]
    assert abs(np.linalg.det(inside)) > 0.0
    assert np.linalg.det(outside) == pytest.approx(np.linalg.det(inside), rel=1e-9)


def test_a_rolling_class_has_its_axis_in_the_floor():
    stood = standing(shapes.cylinder(3.0, 20.0, 64))
    assert stood.kind == "rolling"
    np.testing.assert_allclose(np.abs(stood.axis), [1.0, 0.0], rtol=0, atol=1e-6)


def test_an_unknown_aspect_names_those_that_exist():
    with pytest.raises(FeederError) as fault:
        standing(shapes.box(30, 10, 5), "Z")
    assert str(fault.value) == "aspect of part.stl: there is no aspect 'Z' - choose one of A, B, C"


def test_cards_carry_their_printed_floor():
    part = load(Path(__file__).parents[2] / "parts/arc_chute.yaml")
    aspects = find(part)
    stood = posture(part, aspects, "5")
    assert (stood.offset, stood.height) == pytest.approx((3.15e-3, 3.31e-3))
    assert stood.turning_inertia == pytest.approx(95.32e-9)
    assert stood.corners is None
    assert np.isnan(posture(part, aspects, "1").offset)


def test_outline_drops_corners_on_straight_sides():
    square = np.array([[0, 0], [1, 0], [2, 0], [2, 2], [1, 2], [0, 2], [1, 1]], dtype=float)
    assert len(outline(square)) == 4


def test_outline_keeps_one_of_two_corners_in_one_place():
    square = np.array([[0, 0], [1, 0], [1, 1], [0, 1]], dtype=float)
    doubled = np.vstack([square, square + np.array([1e-9, -1e-9]), square - np.array([1e-9, -1e-9])])
    found = outline(doubled)
    assert len(found) == 4
    assert np.abs(np.sort(found, axis=0) - np.sort(square, axis=0)).max() < 1e-8


def test_centroid_of_a_triangle_and_of_a_line():
    assert centroid(np.array([[0.0, 0.0], [3.0, 0.0], [0.0, 3.0]])) == pytest.approx([1.0, 1.0])
    assert centroid(np.array([[0.0, 0.0], [2.0, 0.0]])) == pytest.approx([1.0, 0.0])


def test_inset_is_the_distance_to_the_nearest_side():
    square = np.array([[0, 0], [2, 0], [2, 2], [0, 2]], dtype=float)
    assert inset(square, np.array([[0.5, 1.0], [2.25, 1.0]])) == pytest.approx([0.5, -0.25])
    assert np.isnan(inset(np.empty((0, 2)), np.zeros(2)))
