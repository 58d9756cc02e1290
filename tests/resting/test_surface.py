"""The surface-weighted closed form and its calibration."""

import numpy as np
import pytest

from feederscrew.resting.calibration import HIGHEST, calibrate
from feederscrew.resting.deviation import chi_square
from feederscrew.resting.rules.formulas import EXPONENTS, surface_shares, surface_weights

SHARES = np.array([0.5, 0.3, 0.15, 0.05])
HEIGHTS = np.array([1.0, 1.4, 1.9, 2.5])
RADIUS = 3.0


def test_a_dead_landing_is_quasi_static():
    assert surface_shares(SHARES, HEIGHTS, RADIUS, EXPONENTS["soft"]) == pytest.approx(SHARES)


def test_a_harder_surface_favours_the_deeper_faces():
    profiles = [
        surface_shares(SHARES, HEIGHTS, RADIUS, EXPONENTS[name]) for name in ("soft", "medium", "hard")
    ]
    assert profiles[0][0] < profiles[1][0] < profiles[2][0]
    assert all(profile.sum() == pytest.approx(1.0) for profile in profiles)


def test_the_weight_is_the_power_of_the_depth():
    weights = surface_weights(SHARES, HEIGHTS, RADIUS, 2.0)
    assert weights[1] / weights[0] == pytest.approx(0.3 / 0.5 * (1.6 / 2.0) ** 2)


def test_wrong_calls():
    with pytest.raises(ValueError, match="radius"):
        surface_weights(SHARES, HEIGHTS, 0.0, 1.0)
    with pytest.raises(ValueError, match="exponent"):
        surface_weights(SHARES, HEIGHTS, 3.0, np.nan)


@pytest.mark.parametrize("exponent", [0.0, 0.8, 2.0])
def test_expected_counts_give_their_exponent_back(exponent):
    fit = calibrate(1e5 * surface_shares(SHARES, HEIGHTS, RADIUS, exponent), SHARES, HEIGHTS, RADIUS)
    assert fit.exponent == pytest.approx(exponent, abs=1e-5)
    assert fit.low < exponent < fit.high and not fit.bounded
    assert fit.chi_square.statistic == pytest.approx(0.0, abs=1e-4)
    assert fit.chi_square.degrees_of_freedom == 2


@pytest.mark.parametrize("counts", [[200, 90, 40, 10], [300, 40, 3, 1], [60, 3, 1, 0]])
def test_its_chi_square_is_the_one_of_compare_but_for_the_fitted_exponent(counts):
    fit = calibrate(counts, SHARES, HEIGHTS, RADIUS)
    same = chi_square(counts, fit.shares)
    assert fit.chi_square.joined == same.joined
    if same.degrees_of_freedom > 1:
        assert fit.chi_square.statistic == same.statistic
        assert fit.chi_square.degrees_of_freedom == same.degrees_of_freedom - 1
        assert fit.chi_square.p_value < same.p_value
    else:
        assert fit.chi_square.degrees_of_freedom == 0 and np.isnan(fit.chi_square.p_value)


def test_the_interval_narrows_with_the_root_of_the_counts():
    profile = surface_shares(SHARES, HEIGHTS, RADIUS, 1.0)
    few, many = (calibrate(n * profile, SHARES, HEIGHTS, RADIUS) for n in (1e3, 1e5))
    assert (few.high - few.low) / (many.high - many.low) == pytest.approx(10.0, rel=0.05)


def test_the_interval_ends_where_the_likelihood_has_fallen_by_half_of_chi_square():
    """Wilks 1938: 3.8415 / 2 for 95 %."""
    counts = np.array([210, 120, 55, 15])
    fit = calibrate(counts, SHARES, HEIGHTS, RADIUS)
    likelihood = [
        (counts * np.log(surface_shares(SHARES, HEIGHTS, RADIUS, exponent))).sum()
        for exponent in (fit.low, fit.exponent, fit.high)
    ]
    assert np.subtract(likelihood[1], likelihood[::2]) == pytest.approx(3.8415 / 2.0, rel=1e-4)


def test_counts_on_one_aspect_only_bound_the_exponent_from_below():
    fit = calibrate([1000, 0, 0, 0], SHARES, HEIGHTS, RADIUS)
    assert fit.bounded and fit.high == HIGHEST and fit.low > 2.0


@pytest.mark.parametrize(
    ("counts", "shares", "heights", "words"),
    [
        ([1, -1], [0.5, 0.5], [1, 2], "negative"),
        ([0, 0], [0.5, 0.5], [1, 2], "zero"),
        ([1, 1], [1.0, 0.0], [1, 2], "no direction"),
        ([1, 1], [0.5, 0.5], [2, 2], "the same"),
        ([1, 1], [0.5, 0.5, 0.0], [1, 2, 3], "shape"),
    ],
)
def test_counts_that_say_nothing(counts, shares, heights, words):
    with pytest.raises(ValueError, match=words):
        calibrate(counts, shares, heights, 3.0)
