"""Distances between profiles: identities, hand numbers, SciPy as an oracle, and the odd cases."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from feederscrew.resting import deviation as measure
from feederscrew.resting.profiles import AspectProfile

shares = st.lists(st.floats(0.0, 1.0), min_size=2, max_size=8).filter(lambda p: sum(p) > 0.1)


def profile(name, kind, values):
    values = np.asarray(values, dtype=float)
    return AspectProfile(name, kind, values, values / values.sum())


def test_deviation_by_hand():
    """Eq. [Table 3-12]."""
    assert measure.deviation([0.5, 0.5], [0.2, 0.8]) == pytest.approx(0.3, rel=1e-15)
    assert measure.deviation([1, 0, 0], [0, 1, 0]) == pytest.approx(np.sqrt(2 / 3), rel=1e-15)


@given(shares, st.randoms(use_true_random=False))
def test_distances_are_symmetric_and_blind_to_order(p, random):
    p = np.array(p) / sum(p)
    q, order = np.roll(p, 1), random.sample(range(len(p)), len(p))
    for distance in (measure.deviation, measure.total_variation):
        assert distance(p, q) == distance(q, p)
        assert distance(p[order], q[order]) == pytest.approx(distance(p, q), rel=1e-12, abs=1e-15)
        assert distance(p, p) == 0.0
    bound = 2.0 * measure.total_variation(p, q) / np.sqrt(len(p))
    assert measure.deviation(p, q) <= bound + 1e-12


def test_goodness_of_fit_against_scipy():
    counts, fractions = np.array([30, 50, 20]), np.array([0.25, 0.5, 0.25])
    oracle = stats.chisquare(counts, 100 * fractions)
    found = measure.chi_square(counts, fractions)
    assert found.statistic == pytest.approx(oracle.statistic, rel=1e-12)
    assert found.p_value == pytest.approx(oracle.pvalue, rel=1e-10)
    assert (found.degrees_of_freedom, found.joined) == (2, 0)


def test_homogeneity_against_scipy():
    first, second = np.array([30, 50, 20]), np.array([60, 70, 30])
    oracle = stats.chi2_contingency([first, second], correction=False)
    found = measure.chi_square_between(first, second)
    assert found.statistic == pytest.approx(oracle.statistic, rel=1e-12)
    assert found.p_value == pytest.approx(oracle.pvalue, rel=1e-10)
    assert found.degrees_of_freedom == oracle.dof


def test_an_impossible_observation_is_infinite():
    found = measure.chi_square([9, 1, 0], [0.5, 0.0, 0.5])
    assert (found.statistic, found.p_value) == (np.inf, 0.0)
    assert found.degrees_of_freedom == 2


def test_an_aspect_neither_seen_nor_expected_is_left_out():
    assert measure.chi_square([30, 0, 70], [0.4, 0.0, 0.6]) == measure.chi_square([30, 70], [0.4, 0.6])
    assert measure.chi_square_between([30, 0, 70], [40, 0, 60]) == measure.chi_square_between(
        [30, 70], [40, 60]
    )


def test_few_expected_are_joined_the_weakest_first():
    found = measure.chi_square([60, 30, 6, 4], [0.6, 0.33, 0.04, 0.03])
    by_hand = stats.chisquare([60, 30, 10], [60, 33, 7])
    assert found.statistic == pytest.approx(by_hand.statistic, rel=1e-12)
    assert (found.degrees_of_freedom, found.joined) == (2, 2)


def test_the_p_value_is_uniform_when_the_rule_is_true(rng):
    fractions = np.array([0.2, 0.3, 0.5])
    p = [measure.chi_square(rng.multinomial(400, fractions), fractions).p_value for _ in range(2000)]
    assert stats.kstest(p, "uniform").pvalue > 1e-3


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: measure.deviation([0.5, 0.5], [1.0]), "second has shape"),
        (lambda: measure.deviation([0.5, np.nan], [0.5, 0.5]), "first has an entry that is not finite"),
        (lambda: measure.chi_square([1, -1], [0.5, 0.5]), "negative entry or sums to zero"),
        (lambda: measure.chi_square([0, 0], [0.5, 0.5]), "negative entry or sums to zero"),
    ],
)
def test_a_wrong_call_is_refused(call, message):
    with pytest.raises(ValueError, match=message):
        call()


def test_every_pair_is_compared_and_tested_where_there_are_counts():
    counts = profile("drops", "counts", [30, 70])
    other = profile("again", "counts", [35, 65])
    printed = profile("print", "fractions", [0.4, 0.6])
    rule = profile("PMI", "rule", [0.5, 0.5])
    found = measure.compare([counts, other, printed, rule])
    assert [(c.first.name, c.second.name) for c in found] == [
        ("drops", "again"), ("drops", "print"), ("drops", "PMI"),
        ("again", "print"), ("again", "PMI"), ("print", "PMI"),
    ]  # fmt: skip
    assert found[0].chi_square == measure.chi_square_between([30, 70], [35, 65])
    assert found[1].chi_square == measure.chi_square([30, 70], [0.4, 0.6])
    assert found[5].chi_square is measure.NO_TEST
    assert measure.compare([rule, counts])[0].chi_square == measure.chi_square([30, 70], [0.5, 0.5])
