"""Checks of what a caller hands to a numerics function; each names the argument."""

from collections.abc import Collection, Mapping
from dataclasses import fields
from typing import Any, TypeVar, cast

import numpy as np

from feederscrew.errors import ArgumentError

Options = TypeVar("Options")


def shaped(name: str, value: Any, shape: tuple[int, ...]) -> np.ndarray:
    """Return a finite float array of a given shape.

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


def positive(name: str, value: Any) -> float:
    """Return a finite number above zero; raises ValueError otherwise."""
    number = float(value)
    if not (np.isfinite(number) and number > 0.0):
        raise ValueError(f"{name} is {value}, not a positive number")
    return number


def kind(name: str, value: object, wanted: type | tuple[type, ...], mend: str) -> None:
    """Raise an ArgumentError that names the argument where a value is not of a class.

    Parameters
    ----------
    name : str
        The argument, as the caller of the library knows it.
    value : object
    wanted : type or tuple of type
    mend : str
        What to give: 'give a part, as load returns it'.
    """
    if not isinstance(value, wanted):
        raise ArgumentError(name, f"is {_shape_text(value)}", mend)


def _shape_text(value: object) -> str:
    """A value as a line shows it; of a record its class."""
    plain = isinstance(value, (int, float, str, type(None), list))
    return f"{value!r:.40}" if plain else f"a {type(value).__name__}"


def frozen(array: Any) -> np.ndarray:
    """Return the same array, closed to writing: what a record holds must not change under it."""
    array = np.ascontiguousarray(array)
    array.setflags(write=False)
    return array


def ranged(
    name: str,
    array: np.ndarray,
    shape: tuple[int, ...],
    low: float = -np.inf,
    high: float = np.inf,
    *,
    whole: bool = False,
    gaps: bool = False,
) -> np.ndarray:
    """Return an array that was read from a file, closed to writing, once every number in it is in its range.

    Parameters
    ----------
    name : str
    array : array
    shape : tuple of int
        Expected shape; -1 stands for any length.
    low, high : float
    whole : bool
        Whether its numbers are whole; floats otherwise.
    gaps : bool
        Whether NaN stands for a number that is not known.

    Returns
    -------
    array of ``shape``

    Raises
    ------
    ValueError
        If the shape or the kind of number is another one, or a number is not finite or out of range.
    """
    fits = len(array.shape) == len(shape) and all(
        want in (-1, size) for want, size in zip(shape, array.shape, strict=True)
    )
    if not fits or array.dtype.kind != ("i" if whole else "f"):
        raise ValueError(f"{name} is an array {array.shape} of {array.dtype}, not {shape}")
    ranged = np.isfinite(array) & (array >= low) & (array <= high)
    if not (ranged | np.isnan(array) if gaps else ranged).all():
        raise ValueError(f"{name} has a number that is not within {low:g} to {high:g}")
    array.setflags(write=False)
    return array


def of_an_aspect(aspect: str | None, heading: float | None) -> None:
    """Raise an ArgumentError where a heading is given without the aspect that it is a heading of."""
    if heading is not None and aspect is None:
        raise ArgumentError("heading", "is given without an aspect", "name the aspect as well")


def argument(name: str, value: Any, low: float = -np.inf, high: float = np.inf) -> float:
    """Return a finite number from low to high.

    Parameters
    ----------
    name : str
        The argument, as the caller of the library knows it.
    value : float
    low, high : float

    Returns
    -------
    float

    Raises
    ------
    ArgumentError
        If it is not such a number; the line names the argument.
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


def options(
    function: str, kind: type[Options], values: Mapping[str, Any], extra: Collection[str] = ()
) -> Options:
    """Return the record of the keywords of a function that has many; its fields hold their defaults.

    Parameters
    ----------
    function : str
        The name that its callers know.
    kind : type
        A dataclass with a field for each keyword.
    values : dict
        The keywords by name.
    extra : collection of str
        Keywords that the function takes as well, but hands on as they are.

    Returns
    -------
    object of ``kind``

    Raises
    ------
    TypeError
        If the function has no such keyword, as Python says it of any other.
    """
    make = cast(Any, kind)
    own = {field.name for field in fields(make)}
    for name in values:
        if name not in own and name not in extra:
            raise TypeError(f"{function}() got an unexpected keyword argument {name!r}")
    return cast(Options, make(**{name: value for name, value in values.items() if name in own}))
