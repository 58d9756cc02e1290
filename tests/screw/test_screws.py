"""Arithmetic, products, pitch, axis and degenerate cases of screws, and the examples of their page."""

import doctest
import re
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from screw_samples import (
    directions,
    displacements,
    few,
    grid,
    lines,
    moved,
    near,
    points,
    same,
    screws,
    vectors,
)

from feederscrew.screw import ORIGIN, Dual, Momentum, Point, Screw, Twist, Wrench


@few
@given(screws(), screws(), points, points)
def test_sums_do_not_depend_on_the_reference(a, b, there, further):
    same(a.at(there).at(further), a.at(further))
    size = max(np.abs(s.resultant).max() for s in (a, b)) * 10 + max(np.abs(s.moment).max() for s in (a, b))
    assert (a + b).reference is a.reference
    for left, right in ((b + a, a + b), (a.at(there) + b, a + b), ((a + b) - b, a)):
        near(left.at(ORIGIN).resultant, right.at(ORIGIN).resultant, size)
        near(left.at(ORIGIN).moment, right.at(ORIGIN).moment, size)


@few
@given(lines(), screws(), points, displacements, grid)
def test_axis_pitch_magnitude_and_products_go_with_the_body(a, b, point, displacement, along):
    lever = np.abs(a.moment).max() / a.magnitude + 10.0
    spread = [np.abs(s.resultant).max() * 20 + np.abs(s.moment).max() for s in (a, b)]
    for first, second in (
        (a.at(point), b),
        (a, b.at(point)),
        (moved(a, displacement), moved(b, displacement)),
    ):
        near(first.magnitude, a.magnitude)
        near(first.pitch, a.pitch, lever)
        near(first.dot(second).real, a.dot(b).real, a.magnitude * b.magnitude)
        near(second.reciprocal(first), a.reciprocal(b), np.prod(spread))
    axis = a.at(point).axis
    there = a.at(Point("A", axis.foot + along * axis.direction))
    near(there.moment, a.pitch * a.resultant, (lever + 20.0) * a.magnitude)
    near(np.dot(axis.foot - point.coordinates, axis.direction), 0.0, lever + 20.0)


@few
@given(vectors, directions, grid, grid.filter(lambda k: k > 0), points, st.integers(-9, 9))
def test_line_pitch_and_magnitude_make_the_screw(foot, direction, pitch, magnitude, point, power):
    screw = Twist.on_axis(foot, direction, magnitude, pitch, point)
    assert type(screw) is Twist
    near(screw.pitch, pitch, 20.0)
    near(screw.magnitude, magnitude)
    near(np.cross(screw.axis.foot - foot, direction), np.zeros(3), 40.0)
    same(Twist.on_axis(screw.axis.foot, screw.axis.direction, screw.magnitude, screw.pitch), screw)
    same(screw.unit() * magnitude, screw)
    larger = 10.0**power * screw
    near(larger.axis.foot, screw.axis.foot, 20.0)
    near(larger.pitch, screw.pitch, 20.0)


def test_pure_force_couple_and_zero_screw():
    force = Wrench.on_axis((1, 2, 3), (0, 0, 2), magnitude=7)
    assert force.pitch == 0.0
    np.testing.assert_array_equal(force.axis.foot, [1, 2, 0])
    np.testing.assert_array_equal(force.moment, [14, -7, 0])
    couple = Wrench((0, 0, 0), (0, 3, 4))
    assert (couple.pitch, couple.magnitude) == (np.inf, 5.0)
    assert np.isnan(couple.axis.foot).all()
    np.testing.assert_array_equal(couple.axis.direction, [0, 0.6, 0.8])
    np.testing.assert_array_equal(couple.at(Point("P", (9, 8, 7))).moment, couple.moment)
    same(Wrench.on_axis((np.nan,) * 3, couple.direction, couple.magnitude, couple.pitch), couple)
    zero = Screw((0, 0, 0), (0, 0, 0))
    assert zero.magnitude == 0.0
    assert np.isnan([zero.pitch, *zero.axis.foot, *zero.axis.direction]).all()
    np.testing.assert_array_equal(zero.unit().moment, np.zeros(3))


@few
@given(screws(), screws(), screws(), displacements)
def test_dual_cross_product(a, b, c, displacement):
    """Jacobi's identity, and the same screw in every axis system."""
    scale = np.prod([np.abs(s.at(ORIGIN).moment).max() + 30 * np.abs(s.resultant).max() for s in (a, b, c)])
    terms = [x.cross(y.cross(z)).at(ORIGIN) for x, y, z in ((a, b, c), (b, c, a), (c, a, b))]
    near(sum(t.resultant for t in terms), np.zeros(3), scale)
    near(sum(t.moment for t in terms), np.zeros(3), scale)
    scale = np.prod([np.abs(s.moment).max() + 30 * np.abs(s.resultant).max() for s in (a, b)])
    wanted = moved(a.cross(b), displacement).at(ORIGIN)
    cross = moved(a, displacement).cross(moved(b, displacement)).at(ORIGIN)
    near(cross.resultant, wanted.resultant, scale)
    near(cross.moment, wanted.moment, scale)


def test_kinds():
    """They do not mix; only a twist carries a momentum into a wrench."""
    twist, momentum, wrench = (kind((1, 2, 3), (4, 5, 6)) for kind in (Twist, Momentum, Wrench))
    assert type(twist.cross(momentum)) is Wrench
    pairs = (momentum, twist), (twist, wrench), (momentum, momentum), (twist, twist)
    assert {type(a.cross(b)) for a, b in pairs} == {Screw}
    with pytest.raises(ValueError, match=r"^a Twist and a Wrench do not add$"):
        twist + wrench
    with pytest.raises(ValueError, match=r"do not subtract$"):
        twist - wrench
    with pytest.raises(ValueError, match=r"^two screws have three products"):
        twist * wrench


def test_batches():
    """Sums, factors and products of many screws, whose points may differ, are those of each one."""
    rng = np.random.default_rng(3)
    a = Twist(*rng.normal(size=(2, 4, 5, 3)), Point("P", rng.normal(size=(4, 5, 3))))
    b, factors = Momentum(*rng.normal(size=(2, 5, 3))), np.arange(1.0, 6.0)
    product, pitches, feet = a.cross(b), a.pitch, a.axis.foot
    assert (a.shape, product.shape, pitches.shape, feet.shape) == ((4, 5), (4, 5), (4, 5), (4, 5, 3))
    for i in range(4):
        for j in range(5):
            same(product[i, j], a[i, j].cross(b[j]))
            same((factors * a)[i, j], a[i, j] / (1.0 / factors[j]))
            near(pitches[i, j], a[i, j].pitch)
            near(feet[i, j], a[i][j].axis.foot)
    assert a[:, 2:].shape == (4, 3)
    wanted = (a.moment - np.cross(a.resultant, a.reference.coordinates)).sum(axis=1)
    near(a.sum().at(ORIGIN).moment, wanted, 10.0)
    odd = Wrench([[0, 0, 1], [0, 0, 0], [0, 0, 0]], [[0, 0, 2], [0, 0, 2], [0, 0, 0]])
    np.testing.assert_array_equal(odd.pitch, [2.0, np.inf, np.nan])
    np.testing.assert_array_equal(odd.magnitude, [1.0, 2.0, 0.0])


@few
@given(vectors, vectors.filter(lambda v: v[0] != 0.0))
def test_dual_numbers_are_a_ring_with_quotients(p, q):
    """With eps^2 = 0: section 2.2 of the thesis."""
    a, b, c = Dual(p[0], p[1]), Dual(q[0], q[1]), Dual(p[2], q[2])
    for left, right in ((a * b, b * a), (a * (b + c), a * b + a * c), (a / b * b, a), (a - b + b, a)):
        near([left.real, left.dual], [right.real, right.dual], 1e3)
    assert (Dual(0.0, 1.0) * Dual(0.0, 1.0)).dual == 0.0
    assert not np.isfinite((a / Dual(0.0, 2.0)).dual)


def test_dual_number_times_a_line_makes_a_screw():
    """(1 + eps h) times a line is a screw of pitch h; a screw times itself has the dual part 2 s.s0."""
    line = Screw.on_axis((1, 2, 3), (0, 3, 4))
    screw = Dual(2.0, 2.0 * 0.7) * line
    assert (screw.magnitude, screw.pitch) == pytest.approx((2.0, 0.7))
    near(screw.axis.foot, line.axis.foot)
    square = screw.dot(screw)
    assert (square.real, square.dual) == pytest.approx((4.0, 2.0 * 2.0 * 1.4))


def test_erratum_the_printed_quotient_of_dual_numbers_has_its_sign_reversed():
    a, b, c, d = 2.0, 3.0, 5.0, 7.0
    printed = Dual(a * c / c**2, (a * d - b * c) / c**2)
    right = Dual(a, b) / Dual(c, d)
    assert (right * Dual(c, d)).dual == pytest.approx(b, rel=1e-15)
    assert right.dual == pytest.approx(-printed.dual, rel=1e-15)


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda: Screw((1, 2), (1, 2, 3)), "shape"),
        (lambda: Screw((1, 2, 3, 4), (1, 2, 3, 4)), "shape"),
        (lambda: Screw(np.ones((2, 3)), np.ones((4, 3))), "broadcast"),
        (lambda: Screw((1, 2, np.nan), (1, 2, 3)), "^resultant has an entry that is not finite$"),
        (lambda: Screw((1, 2, 3), (1, 2, 3)) / 0.0, "not finite$"),
        (lambda: Point("C", (1, 2)), r"^point C has shape \(2,\), not \(\.\.\., 3\)$"),
        (lambda: Screw.on_axis((0, 0, 0), (0, 0, 0)), "^direction has no length$"),
    ],
)
def test_wrong_calls(make, says):
    with pytest.raises(ValueError, match=says):
        make()


def test_the_examples_of_the_page_run():
    """Each of docs/method/screws.md prints what it says, in one session, as a reader would type them."""
    page = Path(__file__).parents[2] / "docs" / "method" / "screws.md"
    blocks = re.findall(r"^```python\n(.*?)^```$", page.read_text(), re.MULTILINE | re.DOTALL)
    assert len(blocks) >= 6 and all(">>>" in block for block in blocks)
    examples = doctest.DocTestParser().get_doctest("\n".join(blocks), {}, page.name, str(page), 0)
    report = []
    failed, tried = doctest.DocTestRunner(verbose=False).run(examples, out=report.append)
    assert not failed, "".join(report)
    assert tried > 20
