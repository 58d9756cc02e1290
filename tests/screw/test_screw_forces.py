"""Poinsot's reduction of forces and couples."""

import time
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from screw_samples import few, near, points, same, sizes, vectors

from feederscrew.screw import ORIGIN, Point, Wrench, poinsot

systems = st.lists(st.tuples(vectors, vectors), min_size=1, max_size=6)


def exact(forces, places, couples, about):
    """Resultant and moment in rational arithmetic: what rounding would have to be free of."""
    rational = [
        [[Fraction(float(x)) for x in row] for row in rows] for rows in (forces, places, couples, [about])
    ]
    forces, places, couples, (about,) = rational
    total = [sum(f[i] for f in forces) for i in range(3)]
    moment = [sum((c[i] for c in couples), Fraction(0)) for i in range(3)]
    for force, place in zip(forces, places, strict=True):
        lever = [p - q for p, q in zip(place, about, strict=True)]
        for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
            moment[i] += lever[j] * force[k] - lever[k] * force[j]
    return np.array(total, dtype=float), np.array(moment, dtype=float)


@pytest.mark.parametrize("size", [1e-9, 1.0, 1e9])
@pytest.mark.parametrize("seed", range(5))
def test_against_rational_arithmetic(seed, size):
    rng = np.random.default_rng(seed)
    forces, places, couples = size * rng.normal(size=(9, 3)), rng.normal(size=(9, 3)), rng.normal(size=(2, 3))
    about = Point("A", rng.normal(size=3))
    wrench = poinsot(forces, places, couples, about)
    total, moment = exact(forces, places, couples, about.coordinates)
    np.testing.assert_allclose(wrench.force, total, rtol=0, atol=1e-15 * np.abs(forces).sum())
    bulk = np.abs(forces).sum() * np.abs(places - about.coordinates).max() + np.abs(couples).sum()
    np.testing.assert_allclose(wrench.moment, moment, rtol=0, atol=1e-15 * bulk)


@few
@given(systems, vectors, points, sizes)
def test_round_trip_over_line_and_pitch(system, couple, about, size):
    forces, places = (np.array(column) for column in zip(*system, strict=True))
    wrench = poinsot(size * forces, places, size * couple[None], about)
    bulk = size * (np.abs(forces).sum() * 10 + np.abs(couple).sum())
    reduced = wrench.reduced()
    if wrench.magnitude > 0.0:
        again = Wrench.on_axis(wrench.axis.foot, wrench.direction, wrench.magnitude, wrench.pitch)
        near(again.at(about).moment, wrench.moment, bulk)
        near(again.force, wrench.force, bulk)
        near(np.cross(reduced.moment, reduced.force), np.zeros(3), bulk**2)
    near(reduced.at(about).moment, wrench.moment, bulk)


@few
@given(systems, points, points)
def test_the_reference_changes_nothing(system, here, there):
    forces, places = (np.array(column) for column in zip(*system, strict=True))
    near(
        poinsot(forces, places, reference=here).at(there).moment,
        poinsot(forces, places, reference=there).moment,
        20 * np.abs(forces).sum(),
    )


def test_a_wrench_by_hand():
    wrench = poinsot([(0, 0, 3), (0, 0, 1)], [(0, 0, 0), (4, 0, 0)], couples=[(0, 0, 8)])
    assert wrench.magnitude == 4.0
    assert wrench.pitch == 2.0
    np.testing.assert_array_equal(wrench.axis.foot, [1, 0, 0])
    np.testing.assert_array_equal(wrench.reduced().moment, [0, 0, 8])


def test_two_opposite_forces_are_a_couple():
    couple = poinsot([(0, 0.1, 0), (0, -0.1, 0)], [(3, 0, 0), (1, 0, 0)])
    assert couple.pitch == np.inf
    np.testing.assert_allclose(couple.moment, [0, 0, 0.2], rtol=1e-15)


@pytest.mark.parametrize("size", [1e-9, 1.0, 1e9])
def test_forces_that_cancel_up_to_rounding_are_a_couple(size):
    forces = size * np.array([(0.1, 0, 0), (0.2, 0, 0), (-0.3, 0, 0)])  # their plain sum is 5.6e-17
    wrench = poinsot(forces, [(0, 0, 0), (0, 0, 0), (0, 1, 0)])
    np.testing.assert_array_equal(wrench.force, [0, 0, 0])
    np.testing.assert_allclose(wrench.moment, [0, 0, 0.3 * size], rtol=1e-14, atol=0)
    assert wrench.pitch == np.inf


def test_a_small_true_resultant_is_kept():
    wrench = poinsot([(1.0, 0, 0), (-1.0 + 1e-13, 0, 0)], [(0, 0, 0), (0, 0, 0)])
    assert wrench.magnitude == pytest.approx(1e-13, rel=1e-2, abs=0)


def test_equals_the_sum_of_its_line_forces():
    rng = np.random.default_rng(5)
    forces, places = rng.normal(size=(2, 3, 7, 3))
    lines = Wrench.on_axis(places, forces, np.linalg.norm(forces, axis=-1))
    same(poinsot(forces, places, reference=Point("A", (1, 2, 3))), lines.sum())


def test_every_row_of_a_batch_may_have_its_own_point():
    rng = np.random.default_rng(6)
    forces, places = rng.normal(size=(2, 4, 7, 3))
    about = Point("A", rng.normal(size=(4, 3)))
    batch = poinsot(forces, places, reference=about)
    for i in range(4):
        same(batch[i], poinsot(forces[i], places[i]))


def test_a_hundred_thousand_reductions_in_well_under_a_second():
    rng = np.random.default_rng(7)
    forces, places = rng.normal(size=(2, 100_000, 6, 3))
    times = []
    for _ in range(3):
        start = time.process_time()
        wrench = poinsot(forces, places)
        assert np.isfinite(wrench.pitch).all()
        assert np.isfinite(wrench.axis.foot).all()
        times.append(time.process_time() - start)
    assert min(times) < 0.8


def test_wrong_calls():
    with pytest.raises(ValueError, match=r"^forces and points need an axis that counts them"):
        poinsot((0, 0, 1), (0, 0, 0), reference=ORIGIN)
    with pytest.raises(ValueError, match=r"^points has an entry that is not finite$"):
        poinsot([(0, 0, 1)], [(0, 0, np.nan)])
