"""Dual numbers."""

import numpy as np
import pytest
from hypothesis import given
from screw_samples import few, near, random_screws, vectors

from feederscrew.screw import Dual, Screw


@few
@given(vectors, vectors.filter(lambda v: v[0] != 0.0))
def test_dual_numbers_are_a_ring_with_quotients(p, q):
    a, b, c = Dual(p[0], p[1]), Dual(q[0], q[1]), Dual(p[2], q[2])
    for left, right in ((a * b, b * a), (a * (b + c), a * b + a * c), (a / b * b, a), (a - b + b, a)):
        near([left.real, left.dual], [right.real, right.dual], 1e3)
    assert (2 - a).real == 2 - a.real
    assert ((1 / b) * b).real == pytest.approx(1.0, rel=1e-14)


def test_dual_functions():
    a = Dual(0.7, 3.0)
    one = a.sin() * a.sin() + a.cos() * a.cos()
    near([one.real, one.dual], [1.0, 0.0])
    root = (a * a).sqrt()
    near([root.real, root.dual], [0.7, 3.0])
    step = 1e-6  # eps^2 = 0 makes the dual part a derivative
    near((np.sin(0.7 + step) - np.sin(0.7 - step)) / (2 * step) * 3.0, a.sin().dual, 100.0)


def test_a_dual_number_without_real_part_has_no_inverse():
    assert not np.isfinite((1 / Dual(0.0, 2.0)).dual)


def test_the_norm_squared_is_the_screw_times_itself():
    screw = random_screws(np.random.default_rng(4), Screw, 7)
    square, again = screw.norm * screw.norm, screw.dot(screw)
    near(square.real, again.real)
    near(square.dual, again.dual)


def test_erratum_the_printed_quotient_of_dual_numbers_has_its_sign_reversed():
    a, b, c, d = 2.0, 3.0, 5.0, 7.0
    printed = Dual(a * c / c**2, (a * d - b * c) / c**2)
    right = Dual(a, b) / Dual(c, d)
    assert (right * Dual(c, d)).dual == pytest.approx(b, rel=1e-15)
    assert (printed * Dual(c, d)).dual != pytest.approx(b, rel=1e-2)
    assert right.dual == pytest.approx(-printed.dual, rel=1e-15)
