"""What a caller of the library may hand over: quantities as text or in SI units, and keys of a bowl file."""

import difflib
import functools
import inspect
import math
from collections.abc import Callable, Mapping, Sequence
from os import PathLike
from typing import Any, TypeAlias, TypedDict, TypeVar, cast

from feederscrew import bowl as bowls
from feederscrew import check, units
from feederscrew.bowl import Bowl
from feederscrew.bowl.reading import checked, find_key
from feederscrew.bowl.schema import BOWL_KEYS, Key
from feederscrew.dropping import launch_conditions as condition_keys
from feederscrew.errors import ArgumentError
from feederscrew.part import Part
from feederscrew.resting.aspects import Aspects
from feederscrew.resting.rules.formulas import EXPONENTS
from feederscrew.units import QuantityError, listed, quantity

Setting: TypeAlias = str | float | None  # '2 mm', a number in SI units, a word; None: as the bowl has it
Overrides: TypeAlias = str | Sequence[str] | Mapping[str, str | float]  # or a dict, by the full name of a key
BY_WORD = {key.word: key for key in BOWL_KEYS}
Function = TypeVar("Function", bound=Callable[..., object])
OVERRIDES_MEND = "give a dict, {'drive.frequency': '50 Hz'}, or texts, 'drive.frequency=50 Hz'"


class DriveSettings(TypedDict, total=False):
    """Every key of a bowl file whose name is in one section only, without ``restitution``, which drops have.

    Their meanings: docs/bowl_file.md.
    """

    # keys, written by docs/bowl_file.py
    amplitude: Setting
    peak_to_peak: Setting
    frequency: Setting
    vibration_angle: Setting
    direction: Setting
    phase: Setting
    second_harmonic: Setting
    second_harmonic_phase: Setting
    second_harmonic_angle: Setting
    static: Setting
    kinetic: Setting
    static_backward: Setting
    kinetic_backward: Setting
    wall: Setting
    gravity: Setting
    climb: Setting
    bank: Setting
    radius: Setting
    width: Setting
    hand: Setting
    bowl_mass: Setting
    bowl_inertia: Setting
    base_inertia: Setting
    spring_angle: Setting
    leaf_width: Setting
    leaf_thickness: Setting
    leaf_length: Setting
    leaf_modulus: Setting
    damping: Setting
    supply: Setting
    centre_x: Setting
    centre_y: Setting
    centre_z: Setting
    inertia_x: Setting
    inertia_y: Setting
    product_yz: Setting
    product_xz: Setting
    product_xy: Setting
    bolts: Setting
    bolt_hole: Setting
    bolt_circle: Setting
    mains: Setting
    least_diameter: Setting
    diameter_per_length: Setting
    diameter_per_width: Setting
    greatest_diameter: Setting
    diameter_step: Setting
    least_climb: Setting
    clearance: Setting
    least_clearance: Setting
    greatest_clearance: Setting
    headroom: Setting
    depth: Setting
    fill_height: Setting
    packing: Setting
    carried: Setting
    fill_density: Setting
    hopper_interval: Setting
    retune: Setting
    least_detuning: Setting
    greatest_detuning: Setting
    greatest_acceleration: Setting
    greatest_stroke: Setting
    banks: Setting
    fatigue_stress: Setting
    half_wave_diameter: Setting
    least_spring_angle: Setting
    greatest_spring_angle: Setting
    greatest_spring_radius: Setting
    steepest_spring_angle: Setting
    sheet: Setting
    sheet_density: Setting
    tooling_mass: Setting
    slowest: Setting
    fastest: Setting
    handbook_speed: Setting
    bolt_share: Setting
    shape: Setting
    outlet_height: Setting
    outlet_angle: Setting
    drains: Setting
    drain_hole: Setting
    # end of keys


class BowlSettings(DriveSettings, total=False):
    """The same with ``restitution``."""

    restitution: Setting


def with_settings(function: Function) -> Function:
    """Return a function that says its settings one by one.

    ``inspect.signature`` lists each in place of ``**settings``, and the TypeError of an unknown keyword says
    which one is near.
    """
    signature = inspect.signature(function)
    own = [
        parameter
        for parameter in signature.parameters.values()
        if parameter.kind is not inspect.Parameter.VAR_KEYWORD
    ]
    settings = [
        inspect.Parameter(key.word, inspect.Parameter.KEYWORD_ONLY, default=None, annotation=Setting)
        for key in BOWL_KEYS
        if key.word in BowlSettings.__optional_keys__ and key.word not in signature.parameters
    ]
    names = [parameter.name for parameter in (*own, *settings)]

    @functools.wraps(function)
    def with_known_keywords(*arguments: Any, **keywords: Any) -> object:
        if unknown := next((name for name in keywords if name not in names), None):
            raise TypeError(
                f"{function.__name__}() {_unknown(unknown, [parameter.name for parameter in own], names)}"
            )
        return function(*arguments, **keywords)

    cast(Any, with_known_keywords).__signature__ = signature.replace(parameters=[*own, *settings])
    return cast(Function, with_known_keywords)


def _unknown(name: str, own: Sequence[str], names: Sequence[str]) -> str:
    """What is wrong with a keyword that a function does not have."""
    if keys := [key for key in BOWL_KEYS if key.word == name and name not in BowlSettings.__optional_keys__]:
        full = [f"overrides={{'{key.name}': ...}}" for key in keys]
        return f"has no keyword {name!r}, a key of {len(keys)} sections - write {' or '.join(full)}"
    near = difflib.get_close_matches(name, names, n=1)
    mend = f"did you mean {near[0]!r}?" if near else f"known are {', '.join(own)} and the keys of a bowl file"
    return f"got an unexpected keyword argument {name!r} - {mend}"


def override_texts(overrides: Overrides, settings: Mapping[str, Any]) -> tuple[str, ...]:
    """Return overrides and settings as texts, 'drive.frequency=50 Hz'; of one key the last holds.

    A dict of ``overrides`` is by the full name of a key, ``settings`` by keyword of ``BowlSettings``;
    numbers are in SI units. Raises ArgumentError if a value is not one that its key may have, or no such
    key exists.
    """
    texts = [_override(key, value, key.name) for key, value in _by_key(overrides)]
    for name, value in settings.items():
        if value is not None:
            texts.append(_override(BY_WORD[name], value, name))
    return (*_plain(overrides), *texts)


def adjust_bowl(bowl: Bowl, overrides: Overrides, settings: Mapping[str, Any]) -> Bowl:
    """Return a bowl with overrides and settings in place of its own values; see ``bowl.adjust``."""
    texts = override_texts(overrides, settings)
    return bowls.adjust(bowl, texts) if texts else bowl


def _plain(overrides: Overrides) -> tuple[str, ...]:
    """Overrides that are texts already."""
    if isinstance(overrides, str):
        return (overrides,)
    if isinstance(overrides, Mapping):
        return ()
    check.kind("overrides", overrides, (tuple, list), OVERRIDES_MEND)
    for text in overrides:
        check.kind("overrides", text, str, OVERRIDES_MEND)
    return tuple(overrides)


def _by_key(overrides: Overrides) -> list[tuple[Key, str | float]]:
    """Overrides of a dict."""
    if not isinstance(overrides, Mapping):
        return []
    for name in overrides:
        check.kind("overrides", name, str, OVERRIDES_MEND)
    return [(find_key(name, f"overrides {units.one_line(name)}"), value) for name, value in overrides.items()]


def _override(key: Key, value: object, argument: str) -> str:
    """A value of a key as an override, if it is one."""
    text = value if isinstance(value, str) else _text_in_si(key, value, argument)
    try:
        checked(key, text, argument, kind=ArgumentError)
    except ArgumentError as fault:
        raise ArgumentError(argument, fault.what.removeprefix(f"{key.name}: "), fault.mend) from None
    return f"{key.name}={text}"


def _text_in_si(key: Key, value: object, argument: str) -> str:
    """A number in SI units as a text with its unit."""
    if key.choices:
        raise ArgumentError(argument, f"is {value!r:.40}", f"give {key.bounds}")
    number = check.argument(argument, value)
    unit = next(unit for unit, factor in units.UNITS_BY_DIMENSION[key.dimension].items() if factor == 1.0)
    return f"{number!r} {unit}".strip()


Path: TypeAlias = str | PathLike[str]
Quantity: TypeAlias = str | float  # '2 mm', or a number in SI units
Condition: TypeAlias = Quantity | tuple[Quantity, Quantity] | None  # or the smaller and the larger
SI = {"length": "m", "angular velocity": "rad/s", "velocity": "m/s", "number": ""}
PART_MEND = "give a Part, as load returns it"
BOWL = "give a Bowl, as read_bowl returns it"
SEVERAL_BOWLS = f"{BOWL}, or several in a list"


class BowlFile(TypedDict, total=False):
    """The bowl of a report: keywords of ``read_bowl``."""

    path: Path | None
    overrides: Overrides


def a_part(part: object) -> Part:
    """Return the part; raises ArgumentError where it is none."""
    check.kind("part", part, Part, PART_MEND)
    return cast(Part, part)


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


def the_aspects(aspects: object) -> Aspects:
    """Return the aspects; raises ArgumentError where they are none."""
    check.kind("aspects", aspects, Aspects, "give Aspects, as find_aspects returns them")
    return cast(Aspects, aspects)


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


def several(name: str, items: object, wanted: type, mend: str) -> tuple[Any, ...]:
    """Return what is given in a list as a tuple; raises ArgumentError where one is of another class."""
    check.kind(name, items, (tuple, list), mend)
    for item in (values := tuple(cast(list[object], items))):
        check.kind(name, item, wanted, mend)
    return values


def amount(name: str, value: Quantity, dimension: str, low: float = -math.inf) -> float:
    """Return a quantity of a dimension of ``units``, '2 mm' or a number in SI units, in SI units.

    Raises ArgumentError if ``value`` is neither, or below ``low`` [SI]; the line names the argument.
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


def a_file_of_bowl(value: object) -> BowlFile:
    """Return the keywords of ``read_bowl``; raises ArgumentError where they are no dict of these."""
    mend = "give a dict of path and overrides"
    check.kind("bowl", {} if value is None else value, Mapping, mend)
    bowl_file = cast(BowlFile, value or {})
    if strange := sorted(set(bowl_file) - {"path", "overrides"}):
        raise ArgumentError("bowl", f"has a key {strange[0]!r}", mend)
    return bowl_file


def surface(value: str | float | None) -> str | float | None:
    """Return a surface by its name, or the exponent that stands for it; None stays None."""
    if isinstance(value, str):
        if value not in EXPONENTS:
            raise ArgumentError("surface", f"is {value!r}", f"give {listed(list(EXPONENTS))} or an exponent")
        return value
    return None if value is None else check.argument("surface", value, 0.0)


def _typed(name: str, value: Condition) -> str | None:
    if value is None or isinstance(value, str):
        return value
    unit = SI[condition_keys.CONDITION_KEYS[name][0]]
    ends: Sequence[Quantity] = value if isinstance(value, (tuple, list)) else (value,)
    return ":".join(
        end if isinstance(end, str) else f"{check.argument(name, end)!r} {unit}".strip() for end in ends
    )
