"""Arithmetic, products, pitch, axis and degenerate cases of screws."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from screw_samples import (
    directions,
    displacements,
    few,
    grid,
    kinds,
    lines,
    near,
    points,
    random_screws,
    same,
    screws,
    vectors,
)

from feederscrew.screw import ORIGIN, Momentum, Point, Screw, Twist, Wrench


def test_velocity_of_another_point_of_a_turning_body():
    wheel = Twist((0, 0, 2), (0, 0, 0), Point("hub", (1, 0, 0)))
    np.testing.assert_array_equal(wheel.at(Point("rim", (1, 3, 0))).velocity, [-6, 0, 0])


def test_moment_of_a_force_about_another_point():
    lift = Wrench((0, 0, 5), (0, 0, 0), Point("A", (2, 0, 0)))
    np.testing.assert_array_equal(lift.at(ORIGIN).moment, [0, -10, 0])


@few
@given(screws(), points, points)
def test_change_of_reference_has_no_memory(screw, there, further):
    same(screw.at(there).at(further), screw.at(further))
    same(screw.at(there), screw)


@few
@given(screws(), screws(), points)
def test_sum_does_not_depend_on_the_reference(a, b, point):
    size = max(np.abs(s.resultant).max() for s in (a, b)) * 10 + max(np.abs(s.moment).max() for s in (a, b))
    for left, right in ((b + a, a + b), (a.at(point) + b, a + b), ((a + b) - b, a)):
        near(left.at(ORIGIN).resultant, right.at(ORIGIN).resultant, size)
        near(left.at(ORIGIN).moment, right.at(ORIGIN).moment, size)


def test_sum_is_at_the_first_screws_point():
    there = Point("P", (1, 0, 0))
    assert (Wrench((1, 0, 0), (0, 0, 0), there) + Wrench((0, 1, 0), (0, 0, 0))).reference is there


@pytest.mark.parametrize("verb", ["add", "subtract"])
def test_kinds_do_not_mix(verb):
    twist, wrench = Twist((0, 0, 1), (0, 0, 0)), Wrench((0, 0, 1), (0, 0, 0))
    with pytest.raises(ValueError, match=f"^a Twist and a Wrench do not {verb}$"):
        twist + wrench if verb == "add" else twist - wrench


def test_two_screws_have_no_plain_product():
    with pytest.raises(ValueError, match=r"^two screws have three products: dot, cross and reciprocal$"):
        Twist((0, 0, 1), (0, 0, 0)) * Wrench((0, 0, 1), (0, 0, 0))


@few
@given(lines(), points, displacements)
def test_pitch_and_magnitude_are_invariant(screw, point, moved):
    lever = np.abs(screw.moment).max() / screw.magnitude + 10.0
    for other in (screw.at(point), moved @ screw, (moved @ screw).at(point), screw.reduced()):
        near(other.magnitude, screw.magnitude)
        near(other.pitch, screw.pitch, lever)
        near(other.norm.dual, screw.norm.dual, lever * screw.magnitude)


@few
@given(screws(), screws(), points, displacements)
def test_scalar_and_reciprocal_products_are_invariant(a, b, point, moved):
    real = a.magnitude * b.magnitude
    spread = [np.abs(s.resultant).max() * 20 + np.abs(s.moment).max() for s in (a, b)]
    for left, right in ((a.at(point), b), (a, b.at(point)), (moved @ a, moved @ b), (b, a)):
        near(left.dot(right).real, a.dot(b).real, real)
        near(left.reciprocal(right), a.reciprocal(b), np.prod(spread))


@few
@given(lines(), points, grid)
def test_on_the_axis_the_moment_is_parallel(screw, point, along):
    axis = screw.at(point).axis
    there = screw.at(Point("A", axis.foot + along * axis.direction))
    size = np.abs(screw.moment).max() + 10 * screw.magnitude
    near(there.moment, screw.pitch * screw.resultant, size)
    near(np.dot(axis.foot - point.coordinates, axis.direction), 0.0, size / screw.magnitude)


@few
@given(lines(), st.integers(-9, 9))
def test_axis_and_pitch_do_not_depend_on_magnitude(screw, power):
    bigger = 10.0**power * screw
    size = 1.0 + np.abs(screw.moment).max() / screw.magnitude
    near(bigger.axis.foot, screw.axis.foot, size)
    near(bigger.axis.direction, screw.axis.direction)
    near(bigger.pitch, screw.pitch, size)
    near(bigger.magnitude, 10.0**power * screw.magnitude)


def test_squares_neither_vanish_nor_overflow():
    for size in (1e-300, 1e300):
        screw = Screw(size * np.array([0, 3, 4]), size * np.array([0, 6, 8]))
        assert screw.pitch == pytest.approx(2.0, rel=1e-12)
        assert screw.magnitude == pytest.approx(5 * size, rel=1e-12, abs=0)


@few
@given(kinds, vectors, directions, grid, grid.filter(lambda k: k > 0), points)
def test_line_pitch_and_magnitude_make_the_screw(kind, foot, direction, pitch, magnitude, point):
    screw = kind.on_axis(foot, direction, magnitude, pitch, point)
    assert type(screw) is kind
    near(screw.pitch, pitch, 20.0)
    near(screw.magnitude, magnitude)
    near(np.cross(screw.axis.foot - foot, direction), np.zeros(3), 40.0)
    same(kind.on_axis(screw.axis.foot, screw.axis.direction, screw.magnitude, screw.pitch), screw)


def test_pure_force_has_no_pitch():
    force = Wrench.on_axis((1, 2, 3), (0, 0, 2), magnitude=7)
    assert force.pitch == 0.0
    np.testing.assert_array_equal(force.axis.foot, [1, 2, 0])
    np.testing.assert_array_equal(force.moment, [14, -7, 0])


@pytest.mark.parametrize("kind", [Twist, Wrench, Momentum])
def test_couple_or_translation_has_a_direction_and_no_place(kind):
    free = kind((0, 0, 0), (0, 3, 4))
    assert free.pitch == np.inf
    assert free.magnitude == 5.0
    assert (free.norm.real, free.norm.dual) == (0.0, 5.0)
    assert np.isnan(free.axis.foot).all()
    np.testing.assert_array_equal(free.axis.direction, [0, 0.6, 0.8])
    np.testing.assert_array_equal(free.at(Point("P", (9, 8, 7))).moment, free.moment)
    np.testing.assert_array_equal(free.reduced().moment, free.moment)
    same(kind.on_axis((np.nan,) * 3, free.direction, free.magnitude, free.pitch), free)


def test_zero_screw():
    zero = Screw((0, 0, 0), (0, 0, 0))
    assert zero.magnitude == 0.0
    assert np.isnan(zero.pitch)
    assert np.isnan([*zero.axis.foot, *zero.axis.direction]).all()
    assert (zero.norm.real, zero.norm.dual) == (0.0, 0.0)
    for same_again in (zero.unit(), zero.reduced(), zero.at(Point("P", (1, 2, 3)))):
        np.testing.assert_array_equal([*same_again.resultant, *same_again.moment], np.zeros(6))


@few
@given(screws(), screws(), screws())
def test_jacobi_identity(a, b, c):
    terms = [x.cross(y.cross(z)).at(ORIGIN) for x, y, z in ((a, b, c), (b, c, a), (c, a, b))]
    scale = np.prod([np.abs(s.at(ORIGIN).moment).max() + 3 * np.abs(s.resultant).max() for s in (a, b, c)])
    near(sum(t.resultant for t in terms), np.zeros(3), scale)
    near(sum(t.moment for t in terms), np.zeros(3), scale)


@few
@given(screws(), screws(), points, displacements)
def test_dual_cross_product_is_the_same_screw_everywhere(a, b, point, moved):
    scale = np.prod([np.abs(s.moment).max() + 30 * np.abs(s.resultant).max() for s in (a, b)])
    wanted = a.cross(b).at(ORIGIN)
    back = moved.inverse() @ (moved @ a).cross(moved @ b)
    for got in (a.at(point).cross(b), a.cross(b.at(point)), -b.cross(a), back):
        near(got.at(ORIGIN).resultant, wanted.resultant, scale)
        near(got.at(ORIGIN).moment, wanted.moment, scale)


def test_only_a_twist_carries_a_momentum_into_a_wrench():
    twist, momentum, wrench = (kind((1, 2, 3), (4, 5, 6)) for kind in (Twist, Momentum, Wrench))
    assert type(twist.cross(momentum)) is Wrench
    pairs = (momentum, twist), (twist, wrench), (wrench, wrench), (momentum, momentum), (twist, twist)
    assert {type(a.cross(b)) for a, b in pairs} == {Screw}


def test_cross_product_of_crossing_lines_is_their_common_normal():
    x = Screw.on_axis((0, 0, 1), (1, 0, 0))
    y = Screw.on_axis((0, 0, 4), (0, 1, 0))
    normal = x.cross(y)
    np.testing.assert_allclose(normal.axis.direction, [0, 0, 1], atol=1e-15)
    np.testing.assert_allclose(normal.axis.foot, [0, 0, 0], atol=1e-15)
    assert normal.pitch == pytest.approx(0.0, abs=1e-15)
    assert normal.norm.real == pytest.approx(1.0, rel=1e-15)


def test_power_is_the_sum_over_the_points_of_force_times_velocity():
    rng = np.random.default_rng(1)
    force, place = rng.normal(size=(2, 8, 3))
    twist = random_screws(rng, Twist)
    total = Wrench.on_axis(place, force, np.linalg.norm(force, axis=-1)).sum()
    velocity = twist.velocity + np.cross(twist.angular_velocity, place - twist.reference.coordinates)
    near(twist.reciprocal(total), (force * velocity).sum())


def test_sum_of_a_batch_whose_points_differ():
    rng = np.random.default_rng(2)
    forces, moments, places = rng.normal(size=(3, 4, 5, 3))
    batch = Wrench(forces, moments, Point("P", places))
    near(batch.sum().moment, (moments + np.cross(places, forces)).sum(axis=1))


@few
@given(lines(), vectors)
def test_dual_number_times_a_line_makes_a_screw(screw, parts):
    line = Screw.on_axis(screw.axis.foot, screw.axis.direction)
    same(screw.norm * line, screw, reach=10 + np.abs(screw.moment).max() / screw.magnitude)
    same(line * screw.norm, screw.norm * line)


def test_arithmetic_with_numbers_and_arrays():
    batch = Wrench(np.ones((4, 3)), np.full((4, 3), 2.0))
    factors = np.arange(1.0, 5.0)
    for scaled in (factors * batch, batch * factors, batch / (1.0 / factors)):
        np.testing.assert_allclose(scaled.force[:, 1], factors, rtol=1e-15, atol=0)
        np.testing.assert_allclose(scaled.moment[:, 1], 2.0 * factors, rtol=1e-15, atol=0)
    np.testing.assert_array_equal((np.float64(2) * batch - batch).force, batch.force)
    with pytest.raises(ValueError, match="not finite"):
        batch / 0.0


def test_a_batch_is_its_rows():
    rng = np.random.default_rng(3)
    a = Twist(*rng.normal(size=(2, 4, 5, 3)), Point("P", rng.normal(size=(4, 5, 3))))
    b = Momentum(*rng.normal(size=(2, 5, 3)))
    product, pitches, feet = a.cross(b), a.pitch, a.axis.foot
    assert (a.shape, product.shape, pitches.shape, feet.shape) == ((4, 5), (4, 5), (4, 5), (4, 5, 3))
    for i in range(4):
        for j in range(5):
            same(product[i, j], a[i, j].cross(b[j]))
            near(pitches[i, j], a[i, j].pitch)
            near(feet[i, j], a[i][j].axis.foot)
    assert a[:, 2:].shape == (4, 3)
    assert a[..., 0].reference.coordinates.shape == (4, 3)


def test_degenerate_rows_do_not_disturb_a_batch():
    batch = Wrench([[0, 0, 1], [0, 0, 0], [0, 0, 0]], [[0, 0, 2], [0, 0, 2], [0, 0, 0]])
    np.testing.assert_array_equal(batch.pitch, [2.0, np.inf, np.nan])
    np.testing.assert_array_equal(np.isnan(batch.axis.foot).any(axis=-1), [False, True, True])
    np.testing.assert_array_equal(batch.magnitude, [1.0, 2.0, 0.0])


def test_a_screw_cannot_be_changed_under_its_owner():
    force = np.array([0.0, 0.0, 1.0])
    wrench = Wrench(force, (0, 0, 0))
    force[2] = 9.0
    assert wrench.force[2] == 1.0
    for array in (wrench.resultant, wrench.moment, wrench.reference.coordinates):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 1.0


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda: Screw((1, 2), (1, 2, 3)), "shape"),
        (lambda: Screw((1, 2, 3, 4), (1, 2, 3, 4)), "shape"),
        (lambda: Screw(np.ones((2, 3)), np.ones((4, 3))), "broadcast"),
        (lambda: Screw((1, 2, np.nan), (1, 2, 3)), "^resultant has an entry that is not finite$"),
        (lambda: Screw((1, 2, 3), (1, np.inf, 3)), "^moment has an entry that is not finite$"),
        (lambda: Point("C", (1, 2)), r"^point C has shape \(2,\), not \(\.\.\., 3\)$"),
        (lambda: Screw.on_axis((0, 0, 0), (0, 0, 0)), "^direction has no length$"),
    ],
)
def test_wrong_calls(make, says):
    with pytest.raises(ValueError, match=says):
        make()
