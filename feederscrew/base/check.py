"""Checks of what a caller hands to a numerics function; each names the argument."""

import enum
from os import PathLike
from typing import Any, SupportsFloat, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from feederscrew.base.arrays import Array
from feederscrew.base.errors import ArgumentError

Chosen = TypeVar("Chosen", bound=enum.StrEnum)


def shaped(name: str, value: ArrayLike, shape: tuple[int, ...]) -> Array:
    """Return a finite float array of a given shape.

    Parameters
    ----------
    name : str
        Of the argument, for the fault.
    value : array_like
    shape : tuple of int
        -1 stands for any length.

    Returns
    -------
    array of float
        Of that shape, in the unit of the value.

    Raises
    ------
    ValueError
        If the shape is another one, or an entry is not finite.
    """
    array = np.asarray(value, dtype=float)
    if not _fits(array, shape):
        raise ValueError(f"{name} has shape {array.shape}, not {shape}")
    if not np.isfinite(array).all():
        raise ValueError(f"{name} has an entry that is not finite")
    return array


def _fits(array: Array, shape: tuple[int, ...]) -> bool:
    return array.ndim == len(shape) and all(want in (-1, size) for want, size in zip(shape, array.shape))


def positive(name: str, value: SupportsFloat) -> float:
    """Return a finite number above zero.

    Parameters
    ----------
    name : str
        Of the argument, for the fault.
    value : number

    Returns
    -------
    float
        In the unit of the value.

    Raises
    ------
    ValueError
        If it is not finite, or not above zero.
    """
    number = float(value)
    if not (np.isfinite(number) and number > 0.0):
        raise ValueError(f"{name} is {value}, not a positive number")
    return number


def kind(name: str, value: object, wanted: type | tuple[type, ...], mend: str) -> Any:
    """Return a value once it is of a class.

    Parameters
    ----------
    name : str
        Of the argument, for the fault.
    value : object
    wanted : type or tuple of types
    mend : str
        What to give: 'give a part, as load returns it'.

    Returns
    -------
    object
        The same value.

    Raises
    ------
    ArgumentError
        If it is of another class.
    """
    if not isinstance(value, wanted):
        raise ArgumentError(name, f"is {_shape_text(value)}", mend)
    return value


def _shape_text(value: object) -> str:
    """A value as a line shows it; of a record its class."""
    plain = isinstance(value, (int, float, str, type(None), list))
    return f"{value!r:.40}" if plain else f"a {type(value).__name__}"


def path(name: str, value: object) -> Any:
    """Return the path of a file.

    Parameters
    ----------
    name : str
        Of the argument, for the fault.
    value : object

    Returns
    -------
    str or path
        The same value.

    Raises
    ------
    ArgumentError
        If it is anything else.
    """
    return kind(name, value, (str, PathLike), "give the path of a file")


def frozen(array: ArrayLike) -> Array:
    """Return an array that is closed to writing: what a record holds must not change under it.

    Parameters
    ----------
    array : array_like [any]

    Returns
    -------
    array [any]
        The array given, now closed, where it is contiguous; else a copy.
    """
    array = np.ascontiguousarray(array)
    array.setflags(write=False)
    return array


def ranged(
    name: str,
    array: Array,
    shape: tuple[int, ...],
    low: float = -np.inf,
    high: float = np.inf,
    *,
    whole: bool = False,
    gaps: bool = False,
) -> Array:
    """Return an array that was read from a file, closed to writing, once every number is in its range.

    Parameters
    ----------
    name : str
        Of the array, for the fault.
    array : array
    shape : tuple of int
        -1 stands for any length.
    low, high : float
        Ends of the range, both allowed.
    whole : bool
        Its numbers are int; else float.
    gaps : bool
        NaN stands for a number that is not known.

    Returns
    -------
    array
        The same one.

    Raises
    ------
    ValueError
        If the shape or the kind of number is another one, or a number is not finite or out of range.
    """
    if not _fits(array, shape) or array.dtype.kind != ("i" if whole else "f"):
        raise ValueError(f"{name} is an array {array.shape} of {array.dtype}, not {shape}")
    ranged = np.isfinite(array) & (array >= low) & (array <= high)
    if not (ranged | np.isnan(array) if gaps else ranged).all():
        raise ValueError(f"{name} has a number that is not within {low:g} to {high:g}")
    array.setflags(write=False)
    return array


def of_an_aspect(aspect: str | None, heading: float | None) -> None:
    """Refuse a heading that is given without the aspect that it is a heading of.

    Parameters
    ----------
    aspect : str or None
    heading : float [rad] or None

    Returns
    -------
    None

    Raises
    ------
    ArgumentError
        If there is a heading alone.
    """
    if heading is not None and aspect is None:
        raise ArgumentError("heading", "is given without an aspect", "name the aspect as well")


def argument(name: str, value: Any, low: float = -np.inf, high: float = np.inf) -> float:
    """Return a finite number within a range.

    Parameters
    ----------
    name : str
        Of the argument, for the fault.
    value : number
    low, high : float
        Ends of the range, both allowed.

    Returns
    -------
    float
        In the unit of the value.

    Raises
    ------
    ArgumentError
        If it is not such a number.
    """
    try:
        number = float(value)
    except (TypeError, ValueError):
        raise ArgumentError(name, f"is {_shape_text(value)}, not a number", "give a number") from None
    if low <= number <= high and np.isfinite(number):
        return number
    ends = [f"from {low:g}"] if np.isfinite(low) else []
    ends += [f"to {high:g}"] if np.isfinite(high) else []
    raise ArgumentError(
        name, f"is {number:g}", f"give a number {' '.join(ends)}" if ends else "give a number"
    )


def choice(name: str, value: str, kinds: type[Chosen]) -> Chosen:
    """Return the member of an enumeration that a word names.

    Parameters
    ----------
    name : str
        Of the argument, for the message.
    value : str
        As the user gave it.
    kinds : type of enum.StrEnum
        The words that there are.

    Returns
    -------
    member of ``kinds``

    Raises
    ------
    ArgumentError
        If it is none of them.
    """
    if value not in list(kinds):
        raise ArgumentError(name, f"is {value!r}", f"give {' or '.join(kinds)}")
    return kinds(value)
