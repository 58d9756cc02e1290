"""Solid angles against closed forms and the whole sphere."""

import numpy as np
import pytest
import shapes

from feederscrew.geometry.vectors import solid_angles


@pytest.mark.parametrize(("a", "b", "h"), [(1.0, 1.0, 0.5), (10.0, 20.0, 15.0), (3.0, 0.1, 40.0)])
def test_a_rectangle_from_over_its_middle(a, b, h):
    corners = np.array([[-a, -b, -2 * h], [a, -b, -2 * h], [a, b, -2 * h], [-a, b, -2 * h]]) / 2
    got = solid_angles(np.zeros(3), corners[[[0, 2, 1], [0, 3, 2]]]).sum()
    assert got == pytest.approx(
        4 * np.arcsin(a * b / np.sqrt((a * a + 4 * h * h) * (b * b + 4 * h * h))), rel=1e-12
    )


@pytest.mark.parametrize("apex", [(0, 0, 0), (0.4, -0.9, 1.4), (0.99999, 0, 0)])
def test_a_closed_surface_fills_the_sphere_from_anywhere_inside(apex):
    mesh = shapes.box(2, 2, 3)
    total = solid_angles(np.array(apex, dtype=float), mesh.vertices[mesh.faces]).sum()
    assert total == pytest.approx(4 * np.pi, rel=1e-12)


def test_a_point_outside_sees_nothing_in_sum():
    mesh = shapes.box(2, 2, 3)
    assert solid_angles(np.array([5.0, 1, 2]), mesh.vertices[mesh.faces]).sum() == pytest.approx(
        0.0, abs=1e-12
    )


def test_a_wrong_shape_names_the_argument():
    with pytest.raises(ValueError, match="triangles has shape"):
        solid_angles(np.zeros(3), np.zeros((4, 3)))
    with pytest.raises(ValueError, match="apex has an entry that is not finite"):
        solid_angles(np.array([0, np.nan, 0]), np.zeros((4, 3, 3)))
