"""Mass properties of a part beyond those it carries: at the origin, along its principal axes."""

from dataclasses import dataclass

import numpy as np

from feederscrew.part import mass


@dataclass(frozen=True, eq=False)
class Balance:
    """How a part's mass and shape are spread; None where a part card is silent."""

    inertia_at_origin: np.ndarray  # (3, 3) [kg m2] along the file's axes
    moments: np.ndarray  # (3,) [kg m2] principal, about the centre of mass, ascending
    axes: np.ndarray  # (3, 3) [1] principal axes, one a row, right-handed
    hull_volume: float | None  # [m3]
    corner: np.ndarray | None  # (3,) [m] of the bounding box, the lowest
    extents: np.ndarray | None  # (3,) [m] of the bounding box


def balance(part):
    """Return the mass properties of a part.

    Parameters
    ----------
    part : Part

    Returns
    -------
    Balance
    """
    moments, axes = mass.principal(part.inertia)
    at_origin = mass.shifted(part.inertia, part.mass, part.centre_of_mass)
    if part.vertices is None:
        return Balance(at_origin, moments, axes, None, None, None)
    corner, extents = part.vertices.min(axis=0), np.ptp(part.vertices, axis=0)
    hull_volume = part.hull and part.hull.volume
    return Balance(at_origin, moments, axes, hull_volume, corner, extents)
