"""What a caller of the library may hand over, and the one line that names an argument it may not."""

import math
from collections.abc import Mapping, Sequence
from os import PathLike
from typing import Any, TypeAlias, TypedDict, cast

from feederscrew import bowl as bowls
from feederscrew import check
from feederscrew.bowl import Bowl
from feederscrew.dropping.conditions import KEYS
from feederscrew.errors import ArgumentError
from feederscrew.part import Part
from feederscrew.rates.well_oriented import RECOMMENDED
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


class ProbabilitySource(TypedDict, total=False):
    """Whose probabilities are taken: the keywords of every function that needs them."""

    rule: str  # 'recommended' without it
    launch: str  # on a floor at rest: 'place', 'drop', 'flip', 'roll' or 'feed'
    probabilities: Path  # a file of counts in place of an answer of ours
    fed: int  # parts onto the moving floor of the bowl; until the shares are known to 2 % without it
    seed: int  # of these parts, 1 without it
    known: Shares  # as ``shares`` returned it: nothing is computed again


class AlongTrack(ProbabilitySource, total=False):
    """And how parts stand on the track."""

    gap: Quantity  # [m] between one part and the next
    fill: float  # [1] share of the track that is occupied


class BowlFile(TypedDict, total=False):
    """The bowl of a function that sizes what the file leaves open: the keywords of ``read_bowl``."""

    path: Path | None
    overrides: str | Sequence[str]


def a_part(part: object, *, mesh: bool = False) -> Part:
    """Return the part; raises ArgumentError where it is none, or a card where a mesh is needed."""
    check.kind("part", part, Part, PART)
    found = cast(Part, part)
    if mesh and found.vertices is None:
        raise ArgumentError("part", "is a part card, which has no shape", "load a mesh")
    return found


def a_bowl(bowl: object) -> Bowl:
    """Return the bowl; raises ArgumentError where it is none."""
    check.kind("bowl", bowl, Bowl, BOWL)
    return cast(Bowl, bowl)


def some_bowls(given: object) -> tuple[Bowl, ...]:
    """Return one bowl, or several, as a tuple."""
    if isinstance(given, Bowl):
        return (given,)
    found = several("bowls", given, Bowl, f"{BOWL}, or several in a list")
    if not found:
        raise ArgumentError("bowls", "is empty", BOWL)
    return found


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
        A key of ``units.UNITS``.
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


def searched(given: Mapping[str, Any], kinds: Mapping[str, str]) -> dict[str, Any]:
    """Return the keywords of a search, quantities in SI units.

    Parameters
    ----------
    given : dict
        By name: a text or a number.
    kinds : dict of str to str
        What each may be: a dimension of ``units.UNITS``, 'share', 'count', 'seed', 'aspect', or 'any'
        for what the search looks at itself.

    Raises
    ------
    ArgumentError
        If one is not what it may be; the line names it.
    TypeError
        If there is no such keyword.
    """
    _understood(given, tuple(kinds))
    return {name: _as(name, value, kinds[name]) for name, value in given.items()}


def _as(name: str, value: Any, kind: str) -> Any:
    """One keyword of a search."""
    if kind == "aspect":
        return an_aspect(value)
    if kind == "any" or value is None:
        return value
    if kind == "share":
        return check.argument(name, value, 0.0, 1.0)
    if kind in ("count", "seed"):
        return count(name, value, 0 if kind == "seed" else 1)
    return amount(name, value, kind, 0.0)


def angle(name: str, value: Quantity | None) -> float | None:
    """Return an angle [rad] of '90 deg' or of radians; None stays None."""
    return None if value is None else amount(name, value, "angle")


def conditions(given: Mapping[str, Condition]) -> dict[str, str | None]:
    """Return the conditions of a launch as typed: '20 mm:50 mm'.

    Parameters
    ----------
    given : dict
        By name: a text, a number in SI units, or the smaller and the larger of either.

    Raises
    ------
    ArgumentError
        If there is no such condition.
    """
    if strange := sorted(set(given) - set(KEYS)):
        raise ArgumentError(strange[0], "is not a condition of a launch", f"give {listed(list(KEYS))}")
    return {name: _typed(name, value) for name, value in given.items()}


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


def rule(asked: ProbabilitySource) -> str:
    """Return whose probabilities are asked for."""
    return asked.get("rule", RECOMMENDED)


def answered(part: Part, bowl: Bowl, asked: ProbabilitySource) -> Shares:
    """Return the aspects of a part with the answer that was asked for."""
    own: dict[str, Any] = dict(asked)
    for name in ("gap", "fill"):
        own.pop(name, None)
    own["rule"] = rule(asked)
    known = own.pop("known", None)
    _understood(own, ("rule", "launch", "probabilities", "fed", "seed"))
    if own.get("probabilities") is not None:
        a_file("probabilities", own["probabilities"])
    own["fed"] = count("fed", own.get("fed"))
    own["seed"] = count("seed", own.pop("seed", 1), 0)
    return shares(part, bowl, **own) if the_shares(known) is None else known


def settings(asked: BowlFile) -> tuple[Any, ...]:
    """Return the settings of a bowl file with overrides."""
    _understood(asked, ("path", "overrides"))
    path = asked.get("path")
    path = None if path is None else a_file("path", path)
    return bowls.settings(path, overrides(asked.get("overrides", ())))


def overrides(given: object) -> tuple[str, ...]:
    """Return the settings that go before a file's, of one text or of several."""
    if isinstance(given, str):
        return (given,)
    return several("overrides", given, str, "give texts, 'drive.frequency=50 Hz'")


def _understood(given: Mapping[str, object], names: Sequence[str]) -> None:
    """Raise the TypeError of a keyword that is not one of some names, and say those."""
    if strange := sorted(set(given) - set(names)):
        raise TypeError(f"unexpected keyword argument {strange[0]!r} - known here are {listed(names)}")


def _typed(name: str, value: Condition) -> str | None:
    if value is None or isinstance(value, str):
        return value
    unit = SI[KEYS[name][0]]
    ends: Sequence[Quantity] = value if isinstance(value, (tuple, list)) else (value,)
    return ":".join(
        end if isinstance(end, str) else f"{check.argument(name, end)!r} {unit}".strip() for end in ends
    )
