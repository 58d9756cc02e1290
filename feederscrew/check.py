"""Checks of what a caller hands to a numerics function; each names the argument."""

import numpy as np


def shaped(name, value, shape):
    """Finite float array of a given shape.

    Parameters
    ----------
    name : str
        The argument, as the caller knows it.
    value : array_like
        What was handed over.
    shape : tuple of int
        Expected shape; -1 stands for any length.

    Returns
    -------
    array of ``shape``

    Raises
    ------
    ValueError
        If the shape is wrong or an entry is not finite.
    """
    array = np.asarray(value, dtype=float)
    fits = array.ndim == len(shape) and all(
        want in (-1, got) for want, got in zip(shape, array.shape, strict=True)
    )
    if not fits:
        raise ValueError(f"{name} has shape {array.shape}, not {shape}")
    if not np.isfinite(array).all():
        raise ValueError(f"{name} has an entry that is not finite")
    return array


def positive(name, value):
    """Finite number above zero; raises ValueError otherwise."""
    number = float(value)
    if not (np.isfinite(number) and number > 0.0):
        raise ValueError(f"{name} is {value}, not a positive number")
    return number


def frozen(array):
    """The same array, closed to writing: what a record holds must not change under it."""
    array = np.ascontiguousarray(array)
    array.setflags(write=False)
    return array
