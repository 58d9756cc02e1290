"""Calibration of a part's surface exponent from a file of counts."""

from dataclasses import dataclass

import numpy as np

from feederscrew.errors import FeederError
from feederscrew.resting.counts.calibration import Calibration, calibrate
from feederscrew.resting.tumbling.by_class import ground


@dataclass(frozen=True, eq=False)
class Fit:
    """One column of counts and the exponent it asks for."""

    name: str
    counts: np.ndarray  # (A,)
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
    found = ground(part, aspects)
    rows = len(aspects.names)
    shares = np.bincount(found.rows, found.tips.shares, minlength=rows)
    weighted = np.bincount(found.rows, found.tips.shares * np.nan_to_num(found.tips.heights), minlength=rows)
    heights = weighted / np.where(shares > 0.0, shares, 1.0)
    columns = [profile for profile in measured.profiles if profile.counted]
    if not columns:
        raise FeederError(
            measured.source, "has no column of counts", "give whole numbers of parts, not shares"
        )
    return [_fit(measured.source, column, shares, heights, found.hull.radius) for column in columns]


def _fit(source, column, shares, heights, radius):
    try:
        return Fit(column.name, column.values, calibrate(column.values, shares, heights, radius))
    except ValueError as fault:
        raise FeederError(f"{source}: {column.name}", str(fault), "count on at least two aspects") from fault
