"""Named points, and the array habits the whole room shares."""

from dataclasses import dataclass

import numpy as np

from feederscrew import check


def vectors(name, value):
    """Return a finite float copy of an array of 3-vectors, closed to writing.

    Parameters
    ----------
    name : str
        The argument, as the caller knows it.
    value : (..., 3) array_like [any]
        Any leading axes.

    Returns
    -------
    (..., 3) float [the same]

    Raises
    ------
    ValueError
        If the last axis is not of length 3 or an entry is not finite.
    """
    array = np.array(value, dtype=float)
    if array.ndim == 0 or array.shape[-1] != 3:
        raise ValueError(f"{name} has shape {array.shape}, not (..., 3)")
    if not np.isfinite(array).all():
        raise ValueError(f"{name} has an entry that is not finite")
    return check.frozen(array)


def dot(u, v):
    """Return the scalar product (...,) over the last axis of (..., 3) and (..., 3) [any units].

    Source: its definition.
    """
    return np.einsum("...i,...i->...", u, v)


def length(u):
    """Return the length (...,) of vectors (..., 3), in their unit [any]; no square overflows or vanishes.

    Source: own: scaled by the largest component.
    """
    return np.hypot(np.hypot(u[..., 0], u[..., 1]), u[..., 2])


def skew(u):
    """Return the matrix of u x, (..., 3) to (..., 3, 3)."""
    matrix = np.zeros((*u.shape, 3))
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        matrix[..., k, j], matrix[..., j, k] = u[..., i], -u[..., i]
    return matrix


@dataclass(frozen=True, eq=False)
class Point:
    """A point with a name for people and coordinates for the arithmetic.

    The coordinates decide; the name only says in print what a moment or a velocity is taken about, so that
    ``v_C`` cannot be read as ``v_O``. A moving point is one point with a leading axis.

    Parameters
    ----------
    name : str
        As in the drawing: 'C' for a centre of mass, 'O' for the origin.
    coordinates : (..., 3) float [m]
        In the axes of the vectors it goes with.
    """

    name: str
    coordinates: np.ndarray

    def __post_init__(self):
        object.__setattr__(self, "coordinates", vectors(f"point {self.name}", self.coordinates))

    def __sub__(self, other):
        """The vector from the other point to this one, (..., 3) [m]."""
        return self.coordinates - other.coordinates


ORIGIN = Point("O", np.zeros(3))
