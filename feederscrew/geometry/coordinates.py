"""Vectors as columns, a row for each coordinate: faster than `vectors` on many of them."""

import numpy as np


def at(rows, places):
    """Return the vectors at some places as columns.

    Parameters
    ----------
    rows : (M, 3) float
    places : (N, K) int

    Returns
    -------
    (K, 3, N) float
    """
    return np.ascontiguousarray(rows.T)[:, places.T].swapaxes(0, 1)


def dot(u, v):
    """Return the scalar products (N,) of columns (3, N)."""
    return u[0] * v[0] + u[1] * v[1] + u[2] * v[2]


def cross(u, v):
    """Return the vector products (3, N) of columns (3, N)."""
    return np.stack([u[k - 2] * v[k - 1] - u[k - 1] * v[k - 2] for k in range(3)])
