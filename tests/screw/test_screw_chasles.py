"""Rigid displacements and their finite twists."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.linalg import expm
from scipy.spatial.transform import Rotation
from screw_samples import directions, displacements, few, grid, near, points, same, screws, vectors

from feederscrew.screw import ORIGIN, Displacement, Point, Screw, Twist, displacement, finite_twist, notation


@few
@given(vectors, vectors, points, st.integers(-12, 0))
def test_round_trip(turn, moment, point, power):
    turn = turn * 10.0**power * min(1.0, 3.1 / max(np.linalg.norm(turn), 1e-9))
    twist = Twist(turn, moment, point)
    again = finite_twist(displacement(twist), point)
    near(again.resultant, twist.resultant, max(1.0, np.abs(turn).max()))
    near(again.moment, twist.moment, 10.0)


@few
@given(displacements)
def test_round_trip_from_the_displacement(moved):
    again = displacement(finite_twist(moved))
    near(again.rotation, moved.rotation)
    near(again.translation, moved.translation, 10.0)


@few
@given(vectors, directions, grid)
def test_half_turn(foot, direction, slide):
    """Built by hand: R = 2 u u^T - 1, about the line through foot."""
    unit = direction / np.linalg.norm(direction)
    rotation = 2.0 * np.outer(unit, unit) - np.eye(3)
    twist = finite_twist(Displacement(rotation, foot - rotation @ foot + slide * unit))
    assert twist.magnitude == pytest.approx(np.pi, rel=1e-15)
    sense = np.sign(twist.direction @ unit)
    near(twist.direction, sense * unit)
    near(twist.norm.dual, sense * slide, 10.0)
    near(np.cross(twist.axis.foot - foot, unit), np.zeros(3), 10.0)
    again = displacement(twist)
    near(again.rotation, rotation)


@pytest.mark.parametrize("short", 10.0 ** -np.arange(1, 17))
def test_near_a_half_turn(short):
    unit = np.array([2.0, -1.0, 2.0]) / 3.0
    twist = Twist((np.pi - short) * unit, (0.3, 0.2, -0.5))
    again = finite_twist(displacement(twist))
    sense = np.sign(again.direction @ unit)
    assert again.magnitude == pytest.approx(np.pi - short, rel=0, abs=1e-15 * 4)
    near(again.direction, sense * unit)
    if short > 1e-13:
        assert sense == 1.0
        near(again.moment, twist.moment)


@pytest.mark.parametrize("angle", 10.0 ** -np.arange(0, 300, 23.0))
def test_small_angles_keep_their_digits(angle):
    twist = Twist(angle * np.array([0.6, 0.0, 0.8]), (1.0, 2.0, 3.0))
    again = finite_twist(displacement(twist))
    np.testing.assert_allclose(again.resultant, twist.resultant, rtol=0, atol=1e-14 * angle)
    near(again.moment, twist.moment)


@pytest.mark.parametrize("angle", [0.0999999, 0.1, 0.1000001])
def test_the_series_meets_the_closed_form(angle):
    spin, v = angle * np.array([1.0, 2.0, 2.0]) / 3.0, np.array([1.0, -2.0, 0.5])
    moved = displacement(Twist(spin, v))
    exact = expm(notation.lie_matrix(Twist(spin, v)))
    np.testing.assert_allclose(moved.matrix, exact, rtol=0, atol=3e-15)
    np.testing.assert_allclose(finite_twist(moved).moment, v, rtol=0, atol=3e-15)


def test_pure_translation_has_no_axis():
    twist = finite_twist(Displacement(np.eye(3), (0, 3, 4)))
    np.testing.assert_array_equal(twist.resultant, [0, 0, 0])
    np.testing.assert_array_equal(twist.moment, [0, 3, 4])
    assert twist.pitch == np.inf
    np.testing.assert_array_equal(displacement(twist).matrix, Displacement(np.eye(3), (0, 3, 4)).matrix)


def test_identity_is_the_zero_twist():
    twist = finite_twist(Displacement(np.eye(3), (0, 0, 0)))
    np.testing.assert_array_equal([*twist.resultant, *twist.moment], np.zeros(6))
    np.testing.assert_array_equal(displacement(twist).matrix, np.eye(4))


@few
@given(vectors, directions, st.floats(0.01, 3.1), grid)
def test_chasles_finds_the_line_angle_and_slide(foot, direction, angle, slide):
    unit = direction / np.linalg.norm(direction)
    rotation = Rotation.from_rotvec(angle * unit).as_matrix()
    twist = finite_twist(Displacement(rotation, foot - rotation @ foot + slide * unit))
    near(twist.norm.real, angle)
    near(twist.norm.dual, slide, 10.0)
    near(twist.direction, unit, 1.0 / angle)
    near(np.cross(twist.axis.foot - foot, unit), np.zeros(3), 10.0 / angle**2)


@few
@given(screws(Twist), st.floats(0.0, 7.0))
def test_against_the_matrix_exponential(twist, angle):
    size = max(twist.magnitude, np.abs(twist.at(ORIGIN).moment).max(), 1e-300)
    twist = (angle / size) * twist
    near(displacement(twist).matrix, expm(notation.lie_matrix(twist.at(ORIGIN))), 10.0)


def test_points_of_the_axis_only_slide():
    twist = Twist.on_axis((1, 2, 3), (0, 0.6, 0.8), magnitude=2.0, pitch=0.5)
    for along in (-1.0, 0.0, 4.0):
        point = Point("A", np.array([1, 2, 3]) + along * np.array([0, 0.6, 0.8]))
        moved = displacement(twist) @ point
        assert moved.name == "A'"
        near(moved - point, 1.0 * np.array([0, 0.6, 0.8]), 10.0)


def test_more_than_a_turn_keeps_its_slide():
    screw = Twist.on_axis((1, 0, 0), (0, 0, 1), magnitude=2 * np.pi + 0.3, pitch=0.1)
    back = finite_twist(displacement(screw))
    near(back.norm.real, 0.3, 10.0)
    near(back.norm.dual, 0.1 * (2 * np.pi + 0.3))


@few
@given(screws(Twist), grid, grid)
def test_turning_twice_about_one_axis_adds_up(twist, first, second):
    twist = twist / max(twist.magnitude, 1e-300)
    together = displacement(first * twist) @ displacement(second * twist)
    near(together.matrix, displacement((first + second) * twist).matrix, 100.0)


@few
@given(displacements, screws(Twist))
def test_a_moved_twist_makes_the_moved_displacement(moved, twist):
    twist = twist / max(twist.magnitude, 1e-300)
    conjugate = moved @ displacement(twist) @ moved.inverse()
    near(displacement(moved @ twist).matrix, conjugate.matrix, 100.0)


@few
@given(displacements, displacements, screws(Screw))
def test_displacements_compose_on_screws_and_points(first, second, screw):
    same((second @ first) @ screw, second @ (first @ screw), reach=100.0)
    same(first.inverse() @ (first @ screw), screw, reach=100.0)
    near((second @ first @ ORIGIN).coordinates, (second @ (first @ ORIGIN)).coordinates, 10.0)


def test_the_moved_axis_is_the_axis_of_the_moved_screw():
    moved = displacement(Twist((0.3, -1, 2), (1, 1, 0)))
    screw = Screw.on_axis((1, 2, 3), (0, 1, 1), 2.0, 0.7)
    axis, foot = (moved @ screw).axis, (moved @ Point("F", screw.axis.foot)).coordinates
    near(axis.foot, foot)
    near(axis.direction, moved.rotation @ screw.axis.direction)


def test_a_batch_is_its_rows():
    rng = np.random.default_rng(8)
    twists = Twist(*rng.normal(size=(2, 3, 4, 3)))
    twists = Twist(np.where(np.arange(4)[:, None] == 2, 0.0, twists.resultant), twists.moment)
    moved = displacement(twists)
    back = finite_twist(moved)
    for i in range(3):
        for j in range(4):
            near(moved.matrix[i, j], displacement(twists[i, j]).matrix)
            same(back[i, j], twists[i, j])


@pytest.mark.parametrize(
    ("rotation", "says"),
    [
        (np.diag([1.0, 1.0, -1.0]), "^rotation is not a proper rotation matrix$"),
        (1.001 * np.eye(3), "^rotation is not a proper rotation matrix$"),
        (np.ones((2, 3)), r"^rotation has shape \(2, 3\), not \(\.\.\., 3, 3\)$"),
    ],
)
def test_wrong_rotations(rotation, says):
    with pytest.raises(ValueError, match=says):
        Displacement(rotation, (0, 0, 0))


def test_only_points_screws_and_displacements_are_moved():
    with pytest.raises(
        ValueError, match=r"^a displacement moves points, screws and displacements, not ndarray$"
    ):
        Displacement(np.eye(3), (0, 0, 0)) @ np.ones(3)
