"""The surface exponent that a user's own counts ask for."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy import optimize, stats

from feederscrew.base import check
from feederscrew.base.arrays import Floats
from feederscrew.base.errors import FeederError
from feederscrew.part.record import Part
from feederscrew.resting.aspects import Aspects, require_ground
from feederscrew.resting.deviation import ChiSquare, chi_square, chi_square_passes
from feederscrew.resting.profiles import CountFile, DeviceCounts
from feederscrew.resting.rules.formulas import surface_shares

LOWEST = -2.0  # [1] least exponent tried
HIGHEST = 8.0  # [1] greatest exponent tried
CONFIDENCE = 0.95
EQUAL_SHARE_TOLERANCE = 1e-9  # [1] so near two heights or shares are the same
DEVICES_FIT = "devices"  # the name of the fit to a feeding test


@dataclass(frozen=True, eq=False)
class Calibration:
    """Maximum-likelihood exponent of the surface-weighted closed form."""

    exponent: float  # [1]
    low: float  # [1] ends of the 95 % profile-likelihood interval
    high: float
    reaches_end: bool  # an end of the interval, or the exponent itself, is the end of the range tried
    shares: Floats  # (A,) [1] fitted
    chi_square: ChiSquare  # of the counts against them, as ``deviation.chi_square`` makes it


@dataclass(frozen=True, eq=False)
class Fit:
    """One column of counts and the exponent it asks for."""

    name: str
    parts: float  # counted; of a feeding test, at the device to which most came
    calibration: Calibration


def calibrate(counts: ArrayLike, shares: ArrayLike, heights: ArrayLike, radius: float) -> Calibration:
    """Fit the exponent of ``surface_shares`` to counts by maximum likelihood.

    The interval holds the exponents whose log-likelihood lies within half the 95 % quantile of chi-square
    with one degree of freedom of the greatest.

    Parameters
    ----------
    counts : (A,) array_like of float [1]
        Parts on each aspect.
    shares : (A,) array_like of float [1]
        Quasi-static probabilities.
    heights : (A,) array_like of float [m]
        Of the centre of mass on each aspect.
    radius : float [m]
        Largest distance from the centre of mass to a corner.

    Returns
    -------
    Calibration

    Raises
    ------
    ValueError
        If shapes differ, a count is negative, fewer than two aspects can be told apart, or parts were counted
        on an aspect of share zero.

    References
    ----------
    S. S. Wilks, "The large-sample distribution of the likelihood ratio for testing composite hypotheses",
    Ann. Math. Statist. 9(1), 60-62, 1938.
    """
    counts = check.shaped("counts", counts, (-1,))
    shares = check.shaped("shares", shares, counts.shape)
    heights = check.shaped("heights", heights, counts.shape)
    if (counts < 0.0).any() or counts.sum() == 0.0:
        raise ValueError("counts must not be negative, nor all zero")
    if (counts[shares <= 0.0] > 0.0).any():
        raise ValueError("counts has parts on an aspect that no direction rolls to")
    if np.ptp(heights[shares > 0.0]) <= EQUAL_SHARE_TOLERANCE * heights.max():
        raise ValueError("heights are all the same: the counts say nothing about the exponent")
    present = shares > 0.0

    def loss(p: Floats) -> float:
        return -float((counts[present] * np.log(p[present])).sum())

    return _likeliest(loss, lambda p: chi_square(counts, p, fitted_count=1), shares, heights, radius)


def _likeliest(
    loss: Callable[[Floats], float],
    test: Callable[[Floats], ChiSquare],
    shares: Floats,
    heights: Floats,
    radius: float,
) -> Calibration:
    """Return the exponent whose shares have the least loss, with its interval and a test of these shares."""

    def shares_at(exponent: float) -> Floats:
        return surface_shares(shares, heights, radius, exponent)

    def excess(exponent: float) -> float:
        return loss(shares_at(exponent)) - limit

    limit, bounds = 0.0, (LOWEST, HIGHEST)
    best = optimize.minimize_scalar(excess, bounds=bounds, method="bounded", options={"xatol": 1e-9})
    limit = best.fun + 0.5 * stats.chi2.ppf(CONFIDENCE, 1)
    ends = [
        end if loss(shares_at(end)) <= limit else float(optimize.brentq(excess, best.x, end))
        for end in bounds
    ]  # where the loss reaches its limit, or the end of the range
    likeliest = shares_at(best.x)
    reaches_end = LOWEST in ends or HIGHEST in ends
    return Calibration(float(best.x), ends[0], ends[1], reaches_end, check.frozen(likeliest), test(likeliest))


def fit_counts(part: Part, aspects: Aspects, table: CountFile) -> list[Fit]:
    """Fit the surface exponent to every column of counts of a part with a mesh.

    Parameters
    ----------
    part : Part
    aspects : Aspects
        Of that part.
    table : CountFile

    Returns
    -------
    list of Fit
        One a column of counts.

    Raises
    ------
    FeederError
        If the part has no shape, no column holds counts, or the counts do not tell an exponent.
    """
    tumbling = _tumbling_by_aspect(part, aspects)
    columns = [profile for profile in table.profiles if profile.has_counts]
    if not columns:
        mend = "give whole numbers of parts, not shares"
        raise FeederError(table.source, "has no column of counts", mend)
    fits = []
    for column in columns:
        try:
            fits.append(Fit(column.name, float(column.values.sum()), calibrate(column.values, *tumbling)))
        except ValueError as fault:
            where = f"{table.source}: {column.name}"
            raise FeederError(where, str(fault), "count on at least two aspects") from fault
    return fits


def fit_passes(part: Part, aspects: Aspects, counts: DeviceCounts, paths: Floats) -> Fit:
    """Fit the surface exponent to the parts that passed the devices of a bowl, by maximum likelihood.

    Each device is one binomial count: of the parts that come to it, the share that goes on follows from the
    shares of the aspects. A device that all aspects pass alike says nothing of the exponent and is left out.

    Parameters
    ----------
    part : Part
    aspects : Aspects
        Of that part.
    counts : DeviceCounts
        D devices.
    paths : (2, D, A) float [1]
        Share of each aspect's parts that comes to each device, and that goes on from it.

    Returns
    -------
    Fit

    Raises
    ------
    FeederError
        If the part has no shape, or the devices do not tell an exponent.

    References
    ----------
    Maximum likelihood with a profile interval; docs/resting.md, "Surface-weighted tumbling".
    """
    shares, heights, radius = _tumbling_by_aspect(part, aspects)
    came, on = np.asarray(paths)[:, :, shares > 0.0]
    each = np.where(came > 0.0, on / np.where(came > 0.0, came, 1.0), np.nan)
    highest, lowest = np.nanmax(each, axis=1, initial=0.0), np.nanmin(each, axis=1, initial=1.0)
    telling, mend = ~(highest - lowest <= EQUAL_SHARE_TOLERANCE), "count on the aspects themselves"
    if not telling.any() or np.ptp(heights[shares > 0.0]) <= EQUAL_SHARE_TOLERANCE * heights.max():
        what = "the devices pass all aspects alike: the counts say nothing about the exponent"
        raise FeederError(counts.source, what, mend)
    passed, rejected = (np.asarray(parts, float)[telling] for parts in (counts.passed, counts.rejected))
    came, on = np.asarray(paths)[:, telling]

    def pass_shares(p: Floats) -> Floats:
        return np.einsum("da,a->d", on, p) / np.einsum("da,a->d", came, p)

    def loss(p: Floats) -> float:
        share = pass_shares(p)
        return -float((passed * np.log(share) + rejected * np.log1p(-share)).sum())

    def test(p: Floats) -> ChiSquare:
        return chi_square_passes(passed, rejected, pass_shares(p), fitted_count=1)

    try:
        calibration = _likeliest(loss, test, shares, heights, radius)
    except ValueError as fault:
        raise FeederError(counts.source, str(fault), mend) from fault
    return Fit(DEVICES_FIT, float((counts.passed + counts.rejected).max()), calibration)


def _tumbling_by_aspect(part: Part, aspects: Aspects) -> tuple[Floats, Floats, float]:
    """Return exact tumbling by aspect: shares (A,) [1], heights (A,) [m], and the part's radius [m]."""
    basis = require_ground(part, aspects)
    rows = len(aspects.names)
    shares: Floats = np.bincount(basis.rows, basis.tips.shares, minlength=rows).astype(float)
    weighted = np.bincount(basis.rows, basis.tips.shares * np.nan_to_num(basis.tips.heights), minlength=rows)
    return shares, weighted / np.where(shares > 0.0, shares, 1.0), basis.hull.radius
