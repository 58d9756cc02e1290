"""The four notations of one screw."""

import numpy as np
import pytest
from hypothesis import given
from screw_samples import few, kinds, near, screws

from feederscrew.screw import Momentum, Point, Screw, Twist, Wrench, notation

C = Point("C", (1, 0, 0))


def test_a_twist_in_four_lines():
    assert notation.text(Twist((0, 0, 2), (1, 0, 3), C)) == "\n".join(
        [
            "vectors   (omega, v_C) = ((0, 0, 2), (1, 0, 3))",
            "dual      omega + eps v_C = (2 + eps 3) ((0, 0, 1) + eps (0.5, 0, 0))",
            "Pluecker  [v_C; omega] = 2 [(0.5, 0, 1.5); (0, 0, 1)]",
            "Lie       [0 -2 0 1; 2 0 0 0; 0 0 0 3; 0 0 0 0], (1, 0, 3, 0, 0, 2)",
        ]
    )


def test_a_wrench_in_four_lines():
    assert notation.text(Wrench.on_axis((0, 2, 0), (0, 0, 1), 5.0, 0.1)) == "\n".join(
        [
            "vectors   (f, m_O) = ((0, 0, 5), (10, 0, 0.5))",
            "dual      f + eps m_O = (5 + eps 0.5) ((0, 0, 1) + eps (2, 0, 0))",
            "Pluecker  [f; m_O] = 5 [(0, 0, 1); (2, 0, 0.1)]",
            "Lie       [0 -5 0 10; 5 0 0 0; 0 0 0 0.5; 0 0 0 0], (0, 0, 5, 10, 0, 0.5)",
        ]
    )


def test_a_couple_has_a_direction_and_no_lever():
    lines = notation.text(Wrench((0, 0, 0), (0, 3, 4))).splitlines()
    assert lines[1] == "dual      f + eps m_O = (0 + eps 5) ((0, 0.6, 0.8) + eps (0, 0, 0))"
    assert lines[2] == "Pluecker  [f; m_O] = 5 [(0, 0, 0); (0, 0.6, 0.8)]"


def test_zero_screw_prints_noughts():
    zeros = Screw((0, 0, 0), (0, -0.0, 0))
    assert "nan" not in notation.text(zeros)
    assert "-0" not in notation.text(zeros)
    assert notation.text(zeros).splitlines()[2] == "Pluecker  [s; s_O] = 0 [(0, 0, 0); (0, 0, 0)]"


def test_momentum_has_its_own_letters():
    assert notation.text(Momentum((1, 0, 0), (0, 0, 0), C)).startswith("vectors   (q, H_C) = ")


def test_rounding_is_not_printed():
    assert "(0, 0, 1)" in notation.text(Wrench((1e-17, 0, 1), (0, 0, 0))).splitlines()[0]


def test_a_batch_does_not_print():
    with pytest.raises(ValueError, match=r"^there are \(2,\) screws to print, not one$"):
        notation.text(Screw(np.ones((2, 3)), np.ones((2, 3))))


@few
@given(kinds.flatmap(screws))
def test_every_notation_reads_back(screw):
    kind, point = type(screw), screw.reference
    for again in (
        notation.from_pluecker(kind, notation.pluecker(screw), point),
        notation.from_lie_matrix(kind, notation.lie_matrix(screw), point),
    ):
        assert type(again) is kind
        np.testing.assert_array_equal(again.resultant, screw.resultant)
        np.testing.assert_array_equal(again.moment, screw.moment)


@few
@given(screws(), screws())
def test_the_dual_cross_product_is_the_commutator_of_the_matrices(a, b):
    b = b.at(a.reference)
    first, second = notation.lie_matrix(a), notation.lie_matrix(b)
    product = np.abs(first).max() * np.abs(second).max()
    near(notation.lie_matrix(a.cross(b)), first @ second - second @ first, 10 * product)


def test_the_matrix_gives_the_velocity_of_every_point():
    twist = Twist((1, 2, 3), (4, 5, 6), C)
    there = Point("P", (0.3, -2, 5))
    velocity = notation.lie_matrix(twist) @ np.append(there - C, 1.0)
    near(velocity, np.append(twist.at(there).velocity, 0.0))


def test_pluecker_coordinates_of_twist_and_wrench_multiply_to_power():
    rng = np.random.default_rng(16)
    twist, wrench = Twist(*rng.normal(size=(2, 6, 3)), C), Wrench(*rng.normal(size=(2, 6, 3)), C)
    power = (notation.pluecker(twist) * notation.pluecker(wrench)).sum(-1)
    near(power, twist.reciprocal(wrench))


def test_wrong_shapes():
    with pytest.raises(ValueError, match=r"^coordinates has shape \(5,\), not \(\.\.\., 6\)$"):
        notation.from_pluecker(Twist, np.ones(5))
    with pytest.raises(ValueError, match=r"^matrix has shape \(3, 3\), not \(\.\.\., 4, 4\)$"):
        notation.from_lie_matrix(Twist, np.eye(3))
