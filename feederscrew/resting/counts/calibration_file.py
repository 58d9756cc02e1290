"""Calibration of a part's surface exponent from a file of counts."""

from dataclasses import dataclass

import numpy as np

from feederscrew.errors import FeederError
from feederscrew.resting.counts.calibration import Calibration, calibrate, calibrate_passes
from feederscrew.resting.tumbling.by_class import ground

DEVICES = "devices"  # the name of the fit to a feeding test


@dataclass(frozen=True, eq=False)
class Fit:
    """One column of counts and the exponent it asks for."""

    name: str
    parts: float  # counted; of a feeding test, at the device to which most came
    calibration: Calibration


def fits(part, aspects, measured):
    """Fit the surface exponent to every column of counts.

    Parameters
    ----------
    part : Part
        With a mesh.
    aspects : Aspects
        Of that part.
    measured : Measured
        As ``profiles.read`` gives it.

    Returns
    -------
    list of Fit

    Raises
    ------
    FeederError
        If the part has no shape, no column holds counts, or they do not tell an exponent.
    """
    known = _tumbled(part, aspects)
    columns = [profile for profile in measured.profiles if profile.counted]
    if not columns:
        raise FeederError(
            measured.source, "has no column of counts", "give whole numbers of parts, not shares"
        )
    return [_fit(measured.source, column, known) for column in columns]


def fit_of_passes(part, aspects, counts, ways):
    """Fit the surface exponent to what passed the devices of a bowl.

    Source: maximum likelihood; docs/resting.md, "Surface-weighted tumbling".

    Parameters
    ----------
    part : Part
        With a mesh.
    aspects : Aspects
        Of that part.
    counts : DeviceCounts
    ways : (2, D, A) float [1]
        Share of each aspect's parts that comes to each counted device, and that goes on from it.

    Returns
    -------
    Fit

    Raises
    ------
    FeederError
        If the part has no shape, or the devices do not tell an exponent.
    """
    known = _tumbled(part, aspects)
    try:
        found = calibrate_passes(counts.passed, counts.rejected, ways, *known)
    except ValueError as fault:
        raise FeederError(counts.source, str(fault), "count on the aspects themselves") from fault
    return Fit(DEVICES, float((counts.passed + counts.rejected).max()), found)


def _tumbled(part, aspects):
    """Exact tumbling by aspect: (A,) shares [1], (A,) heights [m], and the part's radius [m]."""
    found = ground(part, aspects)
    rows = len(aspects.names)
    shares = np.bincount(found.rows, found.tips.shares, minlength=rows)
    weighted = np.bincount(found.rows, found.tips.shares * np.nan_to_num(found.tips.heights), minlength=rows)
    return shares, weighted / np.where(shares > 0.0, shares, 1.0), found.hull.radius


def _fit(source, column, known):
    try:
        return Fit(column.name, float(column.values.sum()), calibrate(column.values, *known))
    except ValueError as fault:
        raise FeederError(f"{source}: {column.name}", str(fault), "count on at least two aspects") from fault
