"""Distances between two probability profiles."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np
from numpy.typing import ArrayLike

from feederscrew.base import check
from feederscrew.base.arrays import Floats
from feederscrew.base.columns import Column
from feederscrew.base.heavy import heavy
from feederscrew.resting.profiles import AspectProfile

special = heavy("scipy.special")

MIN_EXPECTED_COUNT = 5.0  # expected count below which the chi-square distribution is no longer trusted


@dataclass(frozen=True)
class ChiSquare:
    """Pearson's test; NaN where it cannot be made."""

    statistic: float
    degrees_of_freedom: int  # 0 where there is no test
    p_value: float
    joined_aspects: int = 0  # aspects counted as one because fewer than ``MIN_EXPECTED_COUNT`` were expected


NO_TEST = ChiSquare(np.nan, 0, np.nan)


@dataclass(frozen=True)
class Comparison:
    """Two profiles and every measure between them."""

    first: AspectProfile
    second: AspectProfile
    deviation: float
    total_variation: float
    chi_square: ChiSquare


PAIR_COLUMNS: tuple[Column[Comparison], ...] = (  # the test is empty where neither profile holds counts
    Column("first", lambda pair: pair.first.name),
    Column("second", lambda pair: pair.second.name),
    Column("deviation", lambda pair: pair.deviation),
    Column("total_variation", lambda pair: pair.total_variation),
    Column("chi_square", lambda pair: pair.chi_square.statistic),
    Column("degrees_of_freedom", lambda pair: pair.chi_square.degrees_of_freedom or None),
    Column("p_value", lambda pair: pair.chi_square.p_value),
)


def deviation(first: ArrayLike, second: ArrayLike) -> float:
    """Return the root mean square difference: the 'standard deviation' of eq. [Table 3-12] and Table 3-13.

    Parameters
    ----------
    first : (A,) array_like of float [1]
        Probabilities or fractions by aspect.
    second : (A,) array_like of float [1]

    Returns
    -------
    float [1]

    Raises
    ------
    ValueError
        If the shapes differ.
    """
    first, second = _pair(first, second)
    return float(np.sqrt(np.mean((first - second) ** 2)))


def total_variation(first: ArrayLike, second: ArrayLike) -> float:
    """Return half the sum of absolute differences: the share of parts that would have to land elsewhere.

    Parameters
    ----------
    first : (A,) array_like of float [1]
        Probabilities or fractions by aspect.
    second : (A,) array_like of float [1]

    Returns
    -------
    float [1]
        From 0 to 1.

    Raises
    ------
    ValueError
        If the shapes differ.

    References
    ----------
    Half the L1 distance of two distributions.
    """
    first, second = _pair(first, second)
    return float(0.5 * np.abs(first - second).sum())


def chi_square(counts: ArrayLike, fractions: ArrayLike, fitted_count: int = 0) -> ChiSquare:
    """Test whether counts may come from given probabilities (goodness of fit).

        chi2 = sum (count - expected)^2 / expected

    It holds where enough parts are expected on each aspect. Aspects of which fewer than
    ``MIN_EXPECTED_COUNT`` are expected are joined, the weakest first, until the group expects enough.

    Parameters
    ----------
    counts : (A,) int
        Observed, by aspect.
    fractions : (A,) array_like of float [1]
        Expected; scaled to the sum of the counts.
    fitted_count : int
        Parameters of the fractions that were fitted to these counts. Each costs a degree of freedom.

    Returns
    -------
    ChiSquare
        Infinity and p = 0 if an aspect was seen though its probability is 0. An aspect that was neither seen
        nor expected is left out. ``joined_aspects`` says how many are counted as one. There is no test
        without a degree of freedom: groups less one, less the parameters that were fitted.

    Raises
    ------
    ValueError
        If a shape is wrong, an entry negative or a sum zero.

    References
    ----------
    K. Pearson, "On the criterion that a given system of deviations ...", Phil. Mag. 50, 157-175, 1900. W. G.
    Cochran, "Some methods for strengthening the common chi-square tests", Biometrics 10(4), 417-451, 1954.
    """
    counts, fractions = (_weights(values) for values in _pair(counts, fractions))
    expected = counts.sum() * fractions / fractions.sum()
    if counts[expected == 0.0].any():
        return ChiSquare(np.inf, max(int(np.count_nonzero(counts + expected)) - 1 - fitted_count, 1), 0.0)
    expected_some = expected > 0.0
    return _test(counts[None, expected_some], expected[None, expected_some], fitted_count)


def chi_square_between(first: ArrayLike, second: ArrayLike) -> ChiSquare:
    """Test whether two sets of counts may come from the same probabilities (homogeneity).

    Parameters
    ----------
    first : (A,) int
        Observed, by aspect.
    second : (A,) int

    Returns
    -------
    ChiSquare
        Aspects are joined as in ``chi_square``, by the lower of the two expected counts.

    Raises
    ------
    ValueError
        If a shape is wrong, an entry negative or a sum zero.

    References
    ----------
    K. Pearson, as in ``chi_square``.
    """
    observed = np.array([_weights(values) for values in _pair(first, second)])
    observed = observed[:, observed.any(axis=0)]
    expected = np.outer(observed.sum(axis=1), observed.sum(axis=0)) / observed.sum()
    return _test(observed, expected)


def chi_square_passes(
    passed: ArrayLike, rejected: ArrayLike, expected: ArrayLike, fitted_count: int = 0
) -> ChiSquare:
    """Test whether parts that passed several devices may come from given shares (one binomial a device).

        chi2 = sum (passed - n p)^2 / (n p (1 - p)),   n = passed + rejected

    Parameters
    ----------
    passed : (D,) int
        Observed, by device.
    rejected : (D,) int
    expected : (D,) array_like of float [1]
        p, shares that pass, above 0 and below 1.
    fitted_count : int
        As in ``chi_square``.

    Returns
    -------
    ChiSquare
        Devices at which fewer than ``MIN_EXPECTED_COUNT`` are expected to pass or to be rejected are left
        out, and counted in ``joined_aspects``.

    Raises
    ------
    ValueError
        If a shape is wrong, an entry negative or a sum zero.

    References
    ----------
    Pearson's chi-square; docs/resting.md, "Surface-weighted tumbling".
    """
    passed, rejected = (_weights(values) for values in _pair(passed, rejected))
    came, expected = passed + rejected, check.shaped("expected", expected, passed.shape)
    enough = came * np.minimum(expected, 1.0 - expected) >= MIN_EXPECTED_COUNT
    freedom, few = int(enough.sum()) - fitted_count, int((~enough).sum())
    if freedom <= 0:
        return ChiSquare(np.nan, 0, np.nan, few)
    away = (passed - came * expected) ** 2 / (came * expected * (1.0 - expected))
    return _chi_square_of(float(away[enough].sum()), freedom, few)


def compare(profiles: Sequence[AspectProfile]) -> list[Comparison]:
    """Return every measure between every two profiles over the same aspects in the same order.

    Parameters
    ----------
    profiles : sequence of AspectProfile

    Returns
    -------
    list of Comparison
        With a chi-square test wherever one of the two holds counts.
    """
    comparisons = []
    for a, b in combinations(profiles, 2):
        if a.has_counts and b.has_counts:
            test = chi_square_between(a.values, b.values)
        elif a.has_counts:
            test = chi_square(a.values, b.fractions)
        else:
            test = chi_square(b.values, a.fractions) if b.has_counts else NO_TEST
        both = a.fractions, b.fractions
        comparisons.append(Comparison(a, b, deviation(*both), total_variation(*both), test))
    return comparisons


def _test(observed: Floats, expected: Floats, fitted_count: int = 0) -> ChiSquare:
    """Return Pearson's statistic over groups that expect enough."""
    # the weakest columns are added up until each expects ``MIN_EXPECTED_COUNT`` in every row
    order, joined = np.argsort(expected.min(axis=0), kind="stable"), 0
    observed, expected = observed[:, order], expected[:, order]
    weak = int((expected.min(axis=0) < MIN_EXPECTED_COUNT).sum())
    if weak:
        enough = np.flatnonzero(expected.cumsum(axis=1).min(axis=0) >= MIN_EXPECTED_COUNT)
        joined = max(weak, 1 + int(enough[0])) if len(enough) else expected.shape[1]
        observed, expected = (
            np.column_stack([table[:, :joined].sum(axis=1), table[:, joined:]])
            for table in (observed, expected)
        )
    freedom = expected.shape[1] - 1 - fitted_count
    if freedom <= 0:
        return ChiSquare(np.nan, 0, np.nan, joined)
    return _chi_square_of(float(((observed - expected) ** 2 / expected).sum()), freedom, joined)


def _chi_square_of(statistic: float, freedom: int, joined: int) -> ChiSquare:
    return ChiSquare(statistic, freedom, float(special.gammaincc(0.5 * freedom, 0.5 * statistic)), joined)


def _pair(first: ArrayLike, second: ArrayLike) -> tuple[Floats, Floats]:
    first = check.shaped("first", first, (-1,))
    return first, check.shaped("second", second, first.shape)


def _weights(values: Floats) -> Floats:
    if (values < 0.0).any() or values.sum() <= 0.0:
        raise ValueError("a profile has a negative entry or sums to zero")
    return values
