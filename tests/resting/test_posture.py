"""A part standing on an aspect: frame, drive offset, what a turned file must not change, and words for it."""

from pathlib import Path

import numpy as np
import pytest
import shapes

from feederscrew.errors import FeederError
from feederscrew.geometry.polygons import centroid, inset, outline
from feederscrew.part import load
from feederscrew.part.hull import convex_hull
from feederscrew.resting.aspects import find, postures
from feederscrew.resting.posture import posture

PARTS = Path(__file__).parents[2] / "parts"
LOPSIDED = shapes.prism([(0, 0), (30, 0), (30, 5), (12, 5), (5, 14), (0, 14)], 7.0)


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
    """x points from the foot to the contact's centroid, and polygons run counter-clockwise from above.

    Axes are right-handed: the triple product of any three corners keeps its sign and size.
    """
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


def test_a_rolling_class_has_its_axis_in_the_floor():
    stood = standing(shapes.cylinder(3.0, 20.0, 64))
    assert stood.kind == "rolling"
    np.testing.assert_allclose(np.abs(stood.axis), [1.0, 0.0], rtol=0, atol=1e-6)


def test_an_unknown_aspect_names_those_that_exist():
    with pytest.raises(FeederError) as fault:
        standing(shapes.box(30, 10, 5), "Z")
    assert str(fault.value) == "aspect of part.stl: there is no aspect 'Z' - choose one of A, B, C"


def test_cards_carry_their_printed_floor():
    part = load(PARTS / "arc_chute.yaml")
    aspects = find(part)
    stood = posture(part, aspects, "5")
    assert (stood.offset, stood.height, stood.turning_inertia) == pytest.approx((3.15e-3, 3.31e-3, 95.32e-9))
    assert stood.corners is None
    assert np.isnan(posture(part, aspects, "1").offset)


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


# How a part lies, in words, where a person would say it without measuring.


def words(part):
    aspects = find(part)
    hull = part.hull or convex_hull(part.vertices, part.centre_of_mass)
    return dict(zip(aspects.names, postures(aspects.normals, aspects.contact_areas, aspects.kinds, hull)))


def test_words_for_how_a_part_lies(rng):
    box = {"A": "flat (largest face)", "B": "on side", "C": "on end"}
    assert words(shapes.part(shapes.box(30, 20, 5))) == box
    assert set(words(shapes.part(shapes.box(10, 10, 10))).values()) == {"on a face"}
    bolt = {"A": "flat", "B": "on end (larger face)", "C": "on end (smaller face)"}
    assert words(load(PARTS / "hexbolt_m8x25.stl")) == bolt
    for length in (20.0, 3.0):
        cylinder = words(shapes.part(shapes.cylinder(5.0, length, 48))).values()
        assert "on side (rolls)" in cylinder
        assert ("on end" in cylinder) == (length > 10.0)
    mesh = shapes.prism(shapes.l_profile(), 15.0)
    assert words(shapes.part(mesh)) == words(shapes.part(shapes.turned(mesh, rng)))
