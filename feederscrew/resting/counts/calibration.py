"""The surface exponent that a user's own counts ask for."""

from dataclasses import dataclass

import numpy as np
from scipy import optimize, stats

from feederscrew import check
from feederscrew.resting.counts.deviation import ChiSquare, chi_square
from feederscrew.resting.rules.surface import surface_shares

LOWEST, HIGHEST = -2.0, 8.0  # [1] exponents tried
CONFIDENCE = 0.95


@dataclass(frozen=True, eq=False)
class Calibration:
    """Maximum-likelihood exponent of the surface-weighted closed form."""

    exponent: float  # [1]
    low: float  # [1] ends of the 95 % profile-likelihood interval
    high: float
    bounded: bool  # an end of the interval, or the exponent itself, is the end of the range tried
    shares: np.ndarray  # (A,) [1] fitted
    chi_square: ChiSquare  # of the counts against them, as ``deviation.chi_square`` makes it


def calibrate(counts, shares, heights, radius):
    """Fit the exponent of surface_shares to counts by maximum likelihood.

    Parameters
    ----------
    counts : (A,) float [1]
        Parts found on each aspect.
    shares : (A,) float [1]
        Quasi-static probabilities.
    heights : (A,) float [m]
        Of the centre of mass on each aspect.
    radius : float [m]
        Largest distance from the centre of mass to a corner.

    Returns
    -------
    Calibration

    Raises
    ------
    ValueError
        If shapes differ, a count is negative, fewer than two aspects can be told apart or parts were
        counted on an aspect of share zero.

    References
    ----------
    S. S. Wilks, "The large-sample distribution of the likelihood ratio for testing composite hypotheses",
    Ann. Math. Statist. 9(1), 60-62, 1938.
    """
    counts, shares, heights = _aligned(counts, shares, heights)
    known = shares > 0.0

    def loss(exponent):
        fitted = surface_shares(shares, heights, radius, exponent)
        return -float((counts[known] * np.log(fitted[known])).sum())

    best = optimize.minimize_scalar(loss, bounds=(LOWEST, HIGHEST), method="bounded", options={"xatol": 1e-9})
    limit = best.fun + 0.5 * stats.chi2.ppf(CONFIDENCE, 1)
    ends = [_crossing(loss, limit, best.x, end) for end in (LOWEST, HIGHEST)]
    fitted = surface_shares(shares, heights, radius, best.x)
    return Calibration(
        exponent=float(best.x),
        low=ends[0],
        high=ends[1],
        bounded=LOWEST in ends or HIGHEST in ends,
        shares=check.frozen(fitted),
        chi_square=chi_square(counts, fitted, estimated=1),
    )


def _aligned(counts, shares, heights):
    counts = check.shaped("counts", counts, (-1,))
    shares = check.shaped("shares", shares, counts.shape)
    heights = check.shaped("heights", heights, counts.shape)
    if (counts < 0.0).any() or counts.sum() == 0.0:
        raise ValueError("counts must not be negative, nor all zero")
    if (counts[shares <= 0.0] > 0.0).any():
        raise ValueError("counts has parts on an aspect that no direction rolls to")
    if np.ptp(heights[shares > 0.0]) <= 1e-9 * heights.max():
        raise ValueError("heights are all the same: the counts say nothing about the exponent")
    return counts, shares, heights


def _crossing(loss, limit, best, end):
    """Exponent between the best and one end of the range where the loss reaches its limit, or that end."""
    if loss(end) <= limit:
        return end
    return float(optimize.brentq(lambda exponent: loss(exponent) - limit, best, end))
