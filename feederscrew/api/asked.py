"""What a caller of the library may hand over, and the one line that names an argument it may not."""

import math
from collections.abc import Mapping, Sequence
from os import PathLike
from typing import Any, TypeAlias, TypedDict, cast

from feederscrew import check
from feederscrew.api.bowl_settings import Overrides, adjust_bowl
from feederscrew.bowl import Bowl
from feederscrew.dropping.conditions import KEYS
from feederscrew.errors import ArgumentError
from feederscrew.part import Part
from feederscrew.rates.well_oriented import RECOMMENDED_RULE
from feederscrew.resting.aspects import Aspects
from feederscrew.resting.rules.surface import EXPONENTS
from feederscrew.studies.rate import Shares, shares
from feederscrew.units import QuantityError, listed, quantity

Path: TypeAlias = str | PathLike[str]
Quantity: TypeAlias = str | float  # '2 mm', or a number in SI units
Condition: TypeAlias = Quantity | tuple[Quantity, Quantity] | None  # or the smaller and the larger
SI = {"length": "m", "angular velocity": "rad/s", "velocity": "m/s", "number": ""}
PART = "give a Part, as load returns it"
BOWL = "give a Bowl, as read_bowl returns it"
SEVERAL_BOWLS = f"{BOWL}, or several in a list"


class BowlFile(TypedDict, total=False):
    """The bowl of a report: keywords of ``read_bowl``."""

    path: Path | None
    overrides: Overrides


def a_part(part: object, *, mesh: bool = False) -> Part:
    """Return the part; raises ArgumentError where it is none, or a card where a mesh is needed."""
    check.kind("part", part, Part, PART)
    found = cast(Part, part)
    if mesh and found.vertices is None:
        raise ArgumentError("part", "is a part card, which has no shape", "load a mesh")
    return found


def a_bowl(bowl: object, overrides: Overrides = (), settings: Mapping[str, Any] | None = None) -> Bowl:
    """Return the bowl with overrides and settings in it; raises ArgumentError where it is none."""
    check.kind("bowl", bowl, Bowl, BOWL)
    return adjust_bowl(cast(Bowl, bowl), overrides, settings or {})


def some_bowls(
    bowls: object, overrides: Overrides = (), settings: Mapping[str, Any] | None = None
) -> tuple[Bowl, ...]:
    """Return one bowl, or several, as a tuple, each with overrides and settings in it."""
    several_bowls = (bowls,) if isinstance(bowls, Bowl) else several("bowls", bowls, Bowl, SEVERAL_BOWLS)
    if not several_bowls:
        raise ArgumentError("bowls", "is empty", BOWL)
    return tuple(a_bowl(bowl, overrides, settings) for bowl in several_bowls)


def the_aspects(found: object) -> Aspects:
    """Return the aspects; raises ArgumentError where they are none."""
    check.kind("found", found, Aspects, "give Aspects, as find_aspects returns them")
    return cast(Aspects, found)


def a_file(name: str, path: object) -> Path:
    """Return the path of a file; raises ArgumentError where it is none."""
    check.kind(name, path, (str, PathLike), "give the path of a file")
    return cast(Path, path)


def count(name: str, value: int | None, low: int = 1) -> int | None:
    """Return a whole number from a lowest one; None stays None."""
    if value is None:
        return None
    if not float(check.argument(name, value, low)).is_integer():
        raise ArgumentError(name, f"is {value}", "give a whole number")
    return int(value)


def whole(name: str, value: int, low: int = 1) -> int:
    """Return a whole number from a lowest one."""
    check.argument(name, value, low)
    return cast(int, count(name, value, low))


def several(name: str, given: object, wanted: type, mend: str) -> tuple[Any, ...]:
    """Return what is given in a list as a tuple; raises ArgumentError where one is of another class."""
    check.kind(name, given, (tuple, list), mend)
    for one in (found := tuple(cast(list[object], given))):
        check.kind(name, one, wanted, mend)
    return found


def amount(name: str, value: Quantity, dimension: str, low: float = -math.inf) -> float:
    """Return a quantity in SI units.

    Parameters
    ----------
    name : str
        The argument.
    value : str or float
        '2 mm', or a number in SI units.
    dimension : str
        A key of ``units.UNITS_BY_DIMENSION``.
    low : float [SI]
        The least that can be used.

    Returns
    -------
    float

    Raises
    ------
    ArgumentError
        If it is neither; the line names the argument.
    """
    try:
        number = quantity(value, dimension) if isinstance(value, str) else value
    except QuantityError as fault:
        raise ArgumentError(name, fault.what, fault.mend) from None
    return check.argument(name, number, low)


def pair(name: str, value: Any, dimension: str) -> tuple[float, float]:
    """Return the smaller and the larger of two quantities in SI units; one stands for both."""
    ends = value if isinstance(value, (tuple, list)) else (value, value)
    if len(ends) != 2:
        raise ArgumentError(name, f"has {len(ends)} values", "give one, or the smaller and the larger")
    low, high = (amount(name, end, dimension, 0.0) for end in ends)
    if low > high:
        raise ArgumentError(name, f"is from {low:g} to {high:g}", "give the smaller and the larger")
    return low, high


def angle(name: str, value: Quantity | None) -> float | None:
    """Return an angle [rad] of '90 deg' or of radians; None stays None."""
    return None if value is None else amount(name, value, "angle")


def conditions(**ranges: Condition) -> dict[str, str | None]:
    """Return the conditions of a launch that are given, as typed: '20 mm:50 mm'."""
    return {name: _typed(name, value) for name, value in ranges.items() if value is not None}


def share(name: str, value: float, low: float = 0.0) -> float:
    """Return a share [1]; raises ArgumentError where it is below the lowest or above 1."""
    return check.argument(name, value, low, 1.0)


def an_aspect(name: str | None) -> str | None:
    """Return the name of an aspect; None stays None."""
    check.kind("aspect", "" if name is None else name, str, "give the name of an aspect, 'A'")
    return name


def the_shares(known: object) -> Shares | None:
    """Return shares as ``shares`` gave them; None stays None."""
    if known is not None:
        check.kind("known", known, Shares, "give what shares returned")
    return cast(Shares | None, known)


def a_file_of_bowl(given: object) -> BowlFile:
    """Return the keywords of ``read_bowl``; raises ArgumentError where they are no dict of these."""
    mend = "give a dict of path and overrides"
    check.kind("bowl", {} if given is None else given, Mapping, mend)
    found = cast(BowlFile, given or {})
    if strange := sorted(set(found) - {"path", "overrides"}):
        raise ArgumentError("bowl", f"has a key {strange[0]!r}", mend)
    return found


def surface(given: str | float | None) -> str | float | None:
    """Return a surface by its name, or the exponent that stands for it; None stays None."""
    if isinstance(given, str):
        if given not in EXPONENTS:
            raise ArgumentError("surface", f"is {given!r}", f"give {listed(list(EXPONENTS))} or an exponent")
        return given
    return None if given is None else check.argument("surface", given, 0.0)


def probabilities(
    part: Part,
    bowl: Bowl,
    *,
    rule: str = RECOMMENDED_RULE,
    launch: str | None = None,
    probabilities: Path | None = None,
    fed: int | None = None,
    seed: int = 1,
    known: Shares | None = None,
) -> Shares:
    """Return the aspects of a part with the answer that was asked for; see ``rate``."""
    if probabilities is not None:
        a_file("probabilities", probabilities)
    count("fed", fed)
    count("seed", seed, 0)
    if (shared := the_shares(known)) is not None:
        return shared
    own = {"launch": launch, "probabilities": probabilities, "fed": fed, "seed": seed}
    return shares(part, bowl, rule=rule, **own)  # type: ignore[arg-type]


def _typed(name: str, value: Condition) -> str | None:
    if value is None or isinstance(value, str):
        return value
    unit = SI[KEYS[name][0]]
    ends: Sequence[Quantity] = value if isinstance(value, (tuple, list)) else (value,)
    return ":".join(
        end if isinstance(end, str) else f"{check.argument(name, end)!r} {unit}".strip() for end in ends
    )
