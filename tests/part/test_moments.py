"""Moments of a solid, and which rotations leave it alone."""

from math import factorial

import numpy as np
import pytest
import shapes
import trimesh

from feederscrew.part import mass


def turn(axis, degrees):
    return trimesh.transformations.rotation_matrix(np.radians(degrees), axis)[:3, :3]


def of(mesh):
    return mass.Moments(mesh.vertices, mesh.faces, mesh.center_mass)


@pytest.mark.parametrize("refine", [0, 7])  # 12 facets, and 196,608: both rules of quadrature
def test_a_box_has_its_closed_form_moments(refine):
    got = of(shapes.subdivided(shapes.box(2.0, 4.0, 6.0), refine))
    size2 = (1 + 4 + 9) / 3
    assert got.size == pytest.approx(np.sqrt(size2), rel=1e-6)
    orders = got.directional(np.array([0.0, 0.0, 1.0]))
    expected = [0, 9 / 3 / size2, 0, 81 / 5 / size2**2, 0, 729 / 7 / size2**3]
    np.testing.assert_allclose(orders, expected, rtol=1e-5, atol=1e-9)


def test_only_the_half_turns_of_a_box_are_symmetries():
    rotations = [turn([0, 0, 1], 180), turn([1, 0, 0], 180), turn([0, 0, 1], 90), turn([1, 1, 1], 120)]
    wrong = of(shapes.box(10, 20, 30)).mismatch(np.array(rotations))
    assert (wrong < 1e-12).tolist() == [True, True, False, False]
    assert (wrong[2:] > 0.05).all()


def test_a_small_blind_hole_breaks_the_symmetry_of_a_cube():
    cube = shapes.box(20, 20, 20)
    hole = trimesh.creation.cylinder(radius=1, height=2, sections=24).apply_translation([0, 0, 9])
    pierced = trimesh.Trimesh(
        np.vstack([cube.vertices, hole.vertices]),
        np.vstack([cube.faces, hole.faces[:, ::-1] + len(cube.vertices)]),
    )
    got = of(pierced)
    wrong = got.mismatch(np.array([turn([0, 0, 1], 90), turn([1, 0, 0], 180), turn([1, 0, 0], 90)]))
    assert wrong[0] < got.error < wrong[1:].min()


@pytest.mark.parametrize(("rule", "order"), [(mass._fourth_order, 4), (mass._sixth_order, 6)])
def test_a_rule_is_exact_to_its_order(rule, order):
    """The mean of u^i v^j over a triangle, u and v barycentric, is 2 i! j! / (i + j + 2)!."""
    nodes, shares = rule()
    for i, j in np.argwhere(np.add.outer(range(order + 1), range(order + 1)) <= order):
        want = 2 * factorial(i) * factorial(j) / factorial(i + j + 2)
        assert (shares * nodes[:, 0] ** i * nodes[:, 1] ** j).sum() == pytest.approx(want, rel=1e-13)
