"""Check what a caller of the library hands over, and turn it into SI units; read a bowl."""

import functools
import inspect
import math
import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import fields, replace
from os import PathLike
from typing import Any, TypeAlias, TypeVar, Unpack, cast

from feederscrew import bowl as bowls
from feederscrew.base import check, documents
from feederscrew.base import units as si
from feederscrew.base.errors import ArgumentError
from feederscrew.base.signatures import Keywords, with_shown_signature
from feederscrew.base.units import Quantity
from feederscrew.bowl import Bowl
from feederscrew.bowl.devices.orientation_names import split_name
from feederscrew.bowl.reading import OVERRIDES, Setting, record, settings_of_text, with_part_material
from feederscrew.bowl.values import BowlValues, Overrides, adjusted, refuse_unknown, value_texts
from feederscrew.part.record import PART_MEND, Part
from feederscrew.resting.aspects import Aspects
from feederscrew.resting.rules.formulas import EXPONENTS

Path: TypeAlias = str | PathLike[str]
Condition: TypeAlias = Quantity | tuple[Quantity, Quantity] | None  # or the smaller and the larger
Function = TypeVar("Function", bound=Callable[..., object])
Fold: TypeAlias = Callable[[Keywords, Any], None]  # puts a former keyword's value into the arguments
EXPONENT_RANGE = -10.0, 10.0  # [1] of a surface: calibrate tries some below 0 as well
BOWL_MEND = "give a Bowl, as read_bowl returns it"


def former_keywords(
    into: str = "bowl", former: Mapping[str, Fold] | None = None, **records: type
) -> Callable[[Function], Function]:
    """Return a decorator of a function that still takes the keywords of an earlier release.

    Each of them is folded into an argument of today, and a DeprecationWarning says what to write. A keyword
    that never was one is a TypeError, which says what is near.

    Parameters
    ----------
    into : str
        The argument that takes keys of a bowl and ``overrides``: 'bowl', or 'bowls' of several.
    former : dict, optional
        Of other former keywords: a function that puts the value into the arguments.
    **records : type
        Arguments that are records, whose fields were keywords.

    Returns
    -------
    callable
        It takes a function and returns one with its name, signature and docstring.
    """

    def decorate(function: Function) -> Function:
        parameters = inspect.signature(function).parameters
        of_record = {f.name: name for name, record in records.items() for f in fields(record)}

        @functools.wraps(function)
        def call(*arguments: object, **keywords: Any) -> object:
            old = {name: keywords.pop(name) for name in [*keywords] if name not in parameters}
            if not old:
                return function(*arguments, **keywords)
            of_bowl = {k: v for k, v in old.items() if k not in of_record and k not in (former or {})}
            overrides = of_bowl.pop(OVERRIDES, ())
            refuse_unknown(function.__name__, of_bowl, [*parameters])
            bound = inspect.signature(function).bind(*arguments, **keywords)
            mends = []
            for name, value in old.items():
                if name in (former or {}):
                    cast(Mapping[str, Fold], former)[name](bound.arguments, value)
                    mends.append(f"{name}: see help({function.__name__})")
                elif name in of_record:
                    argument = of_record[name]
                    known = bound.arguments.get(argument) or records[argument]()
                    bound.arguments[argument] = replace(known, **{name: value})
                    mends.append(f"{name}: write {argument}={records[argument].__name__}({name}=...)")
            if of_bowl or overrides:
                own = bound.arguments.get(into)
                if isinstance(own, (list, tuple)):
                    changed: Any = [adjusted(a_bowl(one), overrides, of_bowl) for one in own]
                else:
                    changed = adjusted(a_bowl(own or bowls.default()), overrides, of_bowl)
                bound.arguments[into] = changed
                names = ", ".join(f"{name}=..." for name in of_bowl) or "..."
                mends.append(f"{', '.join(of_bowl) or OVERRIDES}: write bowl.with_values({names})")
            text = f"{function.__name__}() takes these keywords for one more release: {'; '.join(mends)}"
            warnings.warn(text, DeprecationWarning, stacklevel=2)
            return function(*bound.args, **bound.kwargs)

        return with_shown_signature(cast(Function, call))

    return decorate


def a_part(part: object) -> Part:
    """Return the part; raises ArgumentError where it is none."""
    return check.kind("part", part, Part, PART_MEND)


def a_bowl(bowl: object) -> Bowl:
    """Return the bowl; raises ArgumentError where it is none."""
    return cast(Bowl, check.kind("bowl", bowl, Bowl, BOWL_MEND))


def part_in_bowl(part: object, bowl: object) -> tuple[Part, Bowl]:
    """Return a part and the bowl with the friction of that part, where its lining says it.

    Parameters
    ----------
    part : Part
    bowl : Bowl

    Returns
    -------
    (Part, Bowl)

    Raises
    ------
    ArgumentError
        If either is none.
    """
    own, given = a_part(part), a_bowl(bowl)
    settings = with_part_material(given.settings, own.material) if given.settings else given.settings
    return own, given if settings == given.settings else record_in_place(given, settings)


def record_in_place(bowl: Bowl, settings: Sequence[Setting]) -> Bowl:
    """Return the bowl of some settings, of the same file as another one: what was tried may hold for it."""
    changed = record(settings)
    object.__setattr__(changed, "source", bowl.source)
    return changed


def some_bowls(bowls: object) -> tuple[Bowl, ...]:
    """Return one bowl, or several, as a tuple; raises ArgumentError where one is none, or there is none."""
    mend = f"{BOWL_MEND}, or several in a list"
    each = (bowls,) if isinstance(bowls, Bowl) else several("bowls", bowls, Bowl, mend)
    if not each:
        raise ArgumentError("bowls", "is empty", BOWL_MEND)
    return each


def bowl_of_file(keywords: Mapping[str, Any]) -> Bowl:
    """Return the bowl of a dict of path and overrides; raises ArgumentError where it has another key."""
    if strange := sorted(set(keywords) - {"path", OVERRIDES}):
        raise ArgumentError("bowl", f"has a key {strange[0]!r}", BOWL_MEND)
    return read_bowl(**keywords)


def settings_of(bowl: Bowl) -> tuple[Setting, ...]:
    """Return the settings of a bowl; of one that was changed after it was read each value that is no default.

    Raises FeederError if no file can say what it is.
    """
    return bowl.settings or settings_of_text(bowl.to_yaml(), "bowl")


def an_aspect(name: str | None) -> str | None:
    """Return the name of an aspect; None stays None."""
    return None if name is None else check.kind("aspect", name, str, "give the name of an aspect, 'A'")


def an_orientation(aspect: str | None, heading: Quantity | None) -> tuple[str | None, float | None]:
    """Return the aspect and the heading that two arguments name together.

    Parameters
    ----------
    aspect : str or None
        'A', or as tables print it with its heading: 'A@354'.
    heading : str, float [rad], a quantity of pint or None
        Of that aspect.

    Returns
    -------
    str or None
        Name of the aspect.
    float [rad] or None
        None where neither says a heading.

    Raises
    ------
    ArgumentError
        If they are no aspect and no angle, or name two headings.
    """
    name, own = an_aspect(aspect), angle("heading", heading)
    if name is None:
        return name, own
    name, named = split_name(name)
    if named is not None and own is not None:
        raise ArgumentError("heading", f"{aspect} has a heading of its own", "leave one of the two out")
    return name, own if named is None else named


def several(name: str, items: object, wanted: type, mend: str) -> tuple[Any, ...]:
    """Return the items of a list as a tuple, once each is of a class.

    Parameters
    ----------
    name : str
        Of the argument, for the fault.
    items : tuple or list
    wanted : type
        Class of each item.
    mend : str
        What to give: 'give parts, as load returns them'.

    Returns
    -------
    tuple

    Raises
    ------
    ArgumentError
        If it is not a list, or an item is of another class.
    """
    listed = check.kind(name, items, (tuple, list), mend)
    return tuple(check.kind(name, item, wanted, mend) for item in listed)


def count(name: str, value: int | None, low: int = 1) -> int | None:
    """Return a whole number from a lowest one on; None stays None.

    Parameters
    ----------
    name : str
        Of the argument, for the fault.
    value : int or None
    low : int
        The lowest one.

    Returns
    -------
    int or None

    Raises
    ------
    ArgumentError
        If the value is not a whole number, or is below the lowest.
    """
    return None if value is None else whole(name, value, low)


def whole(name: str, value: int, low: int = 1) -> int:
    """Return a whole number from a lowest one on.

    Parameters
    ----------
    name : str
        Of the argument, for the fault.
    value : int
        A float without a fraction is taken as well.
    low : int
        The lowest one.

    Returns
    -------
    int

    Raises
    ------
    ArgumentError
        If the value is not a whole number, or is below the lowest.
    """
    if not check.argument(name, value, low).is_integer():
        raise ArgumentError(name, f"is {value}", "give a whole number")
    return int(value)


def share(name: str, value: float, low: float = 0.0) -> float:
    """Return a share.

    Parameters
    ----------
    name : str
        Of the argument, for the fault.
    value : float [1]
    low : float [1]
        The lowest one.

    Returns
    -------
    float [1]

    Raises
    ------
    ArgumentError
        If it is below the lowest or above 1.
    """
    return check.argument(name, value, low, 1.0)


def amount(name: str, value: Quantity, dimension: str, low: float = -math.inf) -> float:
    """Return a quantity in SI units.

    Parameters
    ----------
    name : str
        Of the argument, for the fault.
    value : str, float [SI] or a quantity of pint
        '2 mm'.
    dimension : str
        Of ``units``: 'length'.
    low : float [SI]
        The lowest one.

    Returns
    -------
    float [SI]

    Raises
    ------
    ArgumentError
        If the value is of another dimension, not a number, or below the lowest.
    """
    try:
        number: Any = si.from_quantity(value, dimension)
        number = si.quantity(number, dimension) if isinstance(number, str) else number
    except si.QuantityError as fault:
        raise ArgumentError(name, fault.what, fault.mend, value=fault.value) from None
    return check.argument(name, number, low)


def angle(name: str, value: Quantity | None) -> float | None:
    """Return an angle; None stays None.

    Parameters
    ----------
    name : str
        Of the argument, for the fault.
    value : str, float [rad], a quantity of pint or None
        '90 deg'.

    Returns
    -------
    float [rad] or None

    Raises
    ------
    ArgumentError
        If the value is not an angle.
    """
    return None if value is None else amount(name, value, "angle")


def pair(name: str, value: object, dimension: str) -> tuple[float, float]:
    """Return the smaller and the larger of two quantities; one stands for both.

    Parameters
    ----------
    name : str
        Of the argument, for the fault.
    value : quantity, or (quantity, quantity)
        Each as for ``amount``, none below 0.
    dimension : str
        Of ``units``: 'length'.

    Returns
    -------
    float [SI]
        The smaller.
    float [SI]
        The larger.

    Raises
    ------
    ArgumentError
        If there are more than two, one is not such a quantity, or the first is the larger.
    """
    ends = value if isinstance(value, (tuple, list)) else (value, value)
    if len(ends) != 2:
        raise ArgumentError(name, f"has {len(ends)} values", "give one, or the smaller and the larger")
    low, high = (amount(name, end, dimension, 0.0) for end in ends)
    if low > high:
        raise ArgumentError(name, f"is from {low:g} to {high:g}", "give the smaller and the larger")
    return low, high


def a_rule(rule: str, aspects: Aspects) -> str:
    """Return the name of a rule that gives a part probabilities.

    Parameters
    ----------
    rule : str
    aspects : Aspects
        Of the part.

    Returns
    -------
    str
        The same name.

    Raises
    ------
    ArgumentError
        If the rule gives this part none.
    """
    if rule not in aspects.chances:
        mend = documents.hint(rule, list(aspects.chances))
        raise ArgumentError(f"rule {rule}", "has no probabilities of this part", mend)
    return rule


def surface(value: str | float | None) -> float | None:
    """Return the exponent that stands for a surface, of its name or as it is; None stays None."""
    if isinstance(value, str):
        if value not in EXPONENTS:
            mend = f"give {si.listed(list(EXPONENTS))} or an exponent"
            raise ArgumentError("surface", f"is {value!r}", mend)
        return EXPONENTS[value]
    return None if value is None else check.argument("surface", value, *EXPONENT_RANGE)


@with_shown_signature
def read_bowl(path: Path | None = None, overrides: Overrides = (), **values: Unpack[BowlValues]) -> Bowl:
    """Read a bowl from its file, from values, or take the defaults.

    Parameters
    ----------
    path : str or Path, optional
        Bowl file (YAML).
    overrides : dict, str or sequence of str
        {'drive.frequency': '50 Hz'} or 'drive.frequency=50 Hz'; the last of one key holds.
    **values : str or float [SI] or quantity of pint
        Keys of a bowl file by their last word, amplitude='0.3 mm'. They go over the overrides, and these
        over the file.

    Returns
    -------
    Bowl

    Raises
    ------
    Faults
        Every fault of the file and of the overrides.
    """
    refuse_unknown("read_bowl", values, ("path", OVERRIDES))
    return bowls.read(None if path is None else check.path("path", path), value_texts(overrides, values))
