"""Surface-weighted tumbling: a closed form between dead landings and violent ones."""

import numpy as np
from numpy.typing import NDArray

from feederscrew import check

EXPONENTS = {"soft": 0.0, "medium": 1.2, "hard": 2.0}  # [1] by what the part lands on
"""Soft: dead landings, exact quasi-static tumbling. Medium and hard: what drop simulations of restitution
0.5 and of tumbling launches on a hard plane follow; 2 was chosen with measured cuboids in view."""


def named(exponent) -> str:
    """Return the surface of an exponent, 'hard'; 'exponent 1.5' where it has no name."""
    names = {value: name for name, value in EXPONENTS.items()}
    return names.get(exponent, f"exponent {exponent:g}")


def surface_weights(shares, heights, radius, exponent) -> NDArray[np.float64]:
    """Return the shares of a part that bounces before it settles, not normalised.

    Source: own; docs/resting.md, "Surface-weighted tumbling".

    Parameters
    ----------
    shares : (F,) float [1]
        Quasi-static probabilities.
    heights : (F,) float [m]
        Of the centre of mass on each face; NaN where the share is zero.
    radius : float [m]
        Largest distance from the centre of mass to a corner: the part's highest way to stand.
    exponent : float [1]
        0 for a dead landing; larger for harder surfaces and livelier launches.

    Returns
    -------
    (F,) float [1]
        share (1 - height / radius)^exponent: a bouncing part visits every face and stays where it lies deep.

    Raises
    ------
    ValueError
        If an argument is not finite or the radius not positive.

    Notes
    -----
    Where radius - height is nearly zero for all faces (a nearly round body) the weight means nothing.
    """
    radius, exponent = check.positive("radius", radius), float(exponent)
    if not np.isfinite(exponent):
        raise ValueError(f"exponent is {exponent}, not a finite number")
    depth = np.clip(1.0 - np.asarray(heights, float) / radius, np.finfo(float).tiny, 1.0)
    return np.where(np.asarray(shares) > 0.0, shares * depth**exponent, 0.0)


def surface_shares(shares, heights, radius, exponent) -> NDArray[np.float64]:
    """Return ``surface_weights`` (F,) [1] that sum to 1.

    Source: own; docs/resting.md, "Surface-weighted tumbling".
    """
    weights = surface_weights(shares, heights, radius, exponent)
    return weights / weights.sum()
