"""The surface exponent that a user's own counts ask for."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import optimize, stats

from feederscrew import check
from feederscrew.errors import FeederError
from feederscrew.resting.deviation import ChiSquare, chi_square, chi_square_passes
from feederscrew.resting.exact_tumbling import require_ground
from feederscrew.resting.rules.formulas import surface_shares

LOWEST, HIGHEST = -2.0, 8.0  # [1] exponents tried
CONFIDENCE = 0.95
EQUAL_SHARE_TOLERANCE = 1e-9  # [1] so near two heights or shares are the same
DEVICES_FIT = "devices"  # the name of the fit to a feeding test


@dataclass(frozen=True, eq=False)
class Calibration:
    """Maximum-likelihood exponent of the surface-weighted closed form."""

    exponent: float  # [1]
    low: float  # [1] ends of the 95 % profile-likelihood interval
    high: float
    bounded: bool  # an end of the interval, or the exponent itself, is the end of the range tried
    shares: np.ndarray  # (A,) [1] fitted
    chi_square: ChiSquare  # of the counts against them, as ``deviation.chi_square`` makes it


def calibrate(counts, shares, heights, radius) -> Calibration:
    """Fit the exponent of surface_shares to counts by maximum likelihood.

    ``counts`` (A,) [1]: parts found on each aspect; ``shares`` (A,) [1]: quasi-static probabilities;
    ``heights`` (A,) [m]: of the centre of mass on each aspect; ``radius`` [m]: largest distance from the
    centre of mass to a corner. Raises ValueError if shapes differ, a count is negative, fewer than two
    aspects can be told apart or parts were counted on an aspect of share zero.
    Source: S. S. Wilks, "The large-sample distribution of the likelihood ratio for testing composite
    hypotheses", Ann. Math. Statist. 9(1), 60-62, 1938.
    """
    counts, shares, heights = _aligned(counts, shares, heights)
    present = shares > 0.0

    def fitted(exponent) -> NDArray[np.float64]:
        return surface_shares(shares, heights, radius, exponent)

    def loss(exponent) -> float:
        return -float((counts[present] * np.log(fitted(exponent)[present])).sum())

    return _likeliest(loss, fitted, lambda p: chi_square(counts, p, estimated=1))


def calibrate_passes(passed, rejected, paths, shares, heights, radius) -> Calibration:
    """Fit the exponent of surface_shares to what passed the devices of a bowl, by maximum likelihood.

    Source: maximum likelihood with a profile interval; docs/resting.md, "Surface-weighted tumbling".

    ``passed`` and ``rejected`` (D,) [1]: parts, by device; ``paths`` (2, D, A) [1]: share of each aspect's
    parts that comes to each device, and that goes on from it; ``shares`` and ``heights`` and ``radius``: as
    for ``calibrate``. Raises ValueError if no device passes a share that hangs on the shares of the aspects.
    A device that all aspects pass alike says nothing of the exponent and is left out.
    """
    telling = _telling(paths, shares)
    passed, rejected = (np.asarray(counts, float)[telling] for counts in (passed, rejected))
    came, on = np.asarray(paths)[:, telling]
    if not telling.any() or np.ptp(heights[shares > 0.0]) <= EQUAL_SHARE_TOLERANCE * heights.max():
        raise ValueError("the devices pass all aspects alike: the counts say nothing about the exponent")

    def fitted(exponent):
        return surface_shares(shares, heights, radius, exponent)

    def expected(p):
        return np.einsum("da,a->d", on, p) / np.einsum("da,a->d", came, p)

    def loss(exponent):
        share = expected(fitted(exponent))
        return -float((passed * np.log(share) + rejected * np.log1p(-share)).sum())

    return _likeliest(loss, fitted, lambda p: chi_square_passes(passed, rejected, expected(p), estimated=1))


def _telling(paths, shares):
    """(D,) bool, the devices of which aspects pass unlike shares."""
    came, on = np.asarray(paths)[:, :, shares > 0.0]
    each = np.where(came > 0.0, on / np.where(came > 0.0, came, 1.0), np.nan)
    equal = (
        np.nanmax(each, axis=1, initial=0.0) - np.nanmin(each, axis=1, initial=1.0) <= EQUAL_SHARE_TOLERANCE
    )
    return ~equal


def _likeliest(loss, fitted, test) -> Calibration:
    """The exponent of least loss, with its interval and a test of the shares fitted."""
    best = optimize.minimize_scalar(loss, bounds=(LOWEST, HIGHEST), method="bounded", options={"xatol": 1e-9})
    limit = best.fun + 0.5 * stats.chi2.ppf(CONFIDENCE, 1)
    ends = [_crossing(loss, limit, best.x, end) for end in (LOWEST, HIGHEST)]
    shares = fitted(best.x)
    return Calibration(
        exponent=float(best.x),
        low=ends[0],
        high=ends[1],
        bounded=LOWEST in ends or HIGHEST in ends,
        shares=check.frozen(shares),
        chi_square=test(shares),
    )


def _aligned(counts, shares, heights) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    counts = check.shaped("counts", counts, (-1,))
    shares = check.shaped("shares", shares, counts.shape)
    heights = check.shaped("heights", heights, counts.shape)
    if (counts < 0.0).any() or counts.sum() == 0.0:
        raise ValueError("counts must not be negative, nor all zero")
    if (counts[shares <= 0.0] > 0.0).any():
        raise ValueError("counts has parts on an aspect that no direction rolls to")
    if np.ptp(heights[shares > 0.0]) <= EQUAL_SHARE_TOLERANCE * heights.max():
        raise ValueError("heights are all the same: the counts say nothing about the exponent")
    return counts, shares, heights


def _crossing(loss, limit, best, end) -> float:
    """Exponent between the best and one end of the range where the loss reaches its limit, or that end."""
    if loss(end) <= limit:
        return end
    return float(optimize.brentq(lambda exponent: loss(exponent) - limit, best, end))


@dataclass(frozen=True, eq=False)
class Fit:
    """One column of counts and the exponent it asks for."""

    name: str
    parts: float  # counted; of a feeding test, at the device to which most came
    calibration: Calibration


def fit_counts(part, aspects, measured) -> list[Any]:
    """Fit the surface exponent to every column of counts.

    ``part``: with a mesh; ``aspects``: of that part; ``measured``: as ``profiles.read`` gives it. Raises
    FeederError if the part has no shape, no column holds counts, or they do not tell an exponent.
    """
    tumbled = _tumbled_by_aspect(part, aspects)
    columns = [profile for profile in measured.profiles if profile.counted]
    if not columns:
        raise FeederError(
            measured.source, "has no column of counts", "give whole numbers of parts, not shares"
        )
    return [_fit_column(measured.source, column, tumbled) for column in columns]


def fit_passes(part, aspects, counts, paths) -> Fit:
    """Fit the surface exponent to what passed the devices of a bowl.

    Source: maximum likelihood; docs/resting.md, "Surface-weighted tumbling".

    ``part``: with a mesh; ``aspects``: of that part; ``paths`` (2, D, A) [1]: share of each aspect's parts
    that comes to each counted device, and that goes on from it. Raises FeederError if the part has no shape,
    or the devices do not tell an exponent.
    """
    tumbled = _tumbled_by_aspect(part, aspects)
    try:
        calibration = calibrate_passes(counts.passed, counts.rejected, paths, *tumbled)
    except ValueError as fault:
        raise FeederError(counts.source, str(fault), "count on the aspects themselves") from fault
    return Fit(DEVICES_FIT, float((counts.passed + counts.rejected).max()), calibration)


def _tumbled_by_aspect(part, aspects) -> tuple[Any, ...]:
    """Exact tumbling by aspect: (A,) shares [1], (A,) heights [m], and the part's radius [m]."""
    basis = require_ground(part, aspects)
    rows = len(aspects.names)
    shares = np.bincount(basis.rows, basis.tips.shares, minlength=rows)
    weighted = np.bincount(basis.rows, basis.tips.shares * np.nan_to_num(basis.tips.heights), minlength=rows)
    return shares, weighted / np.where(shares > 0.0, shares, 1.0), basis.hull.radius


def _fit_column(source, column, tumbled) -> Fit:
    try:
        return Fit(column.name, float(column.values.sum()), calibrate(column.values, *tumbled))
    except ValueError as fault:
        raise FeederError(f"{source}: {column.name}", str(fault), "count on at least two aspects") from fault
