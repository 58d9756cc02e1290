"""What a caller of the library may hand over, quantities as text or in SI units; and what is read first."""

import difflib
import functools
import inspect
import math
from collections.abc import Callable, Mapping, Sequence
from os import PathLike
from typing import Any, TypeAlias, TypedDict, TypeVar, Unpack, cast

from feederscrew import bowl as bowls
from feederscrew import check, documents
from feederscrew import units as si
from feederscrew.bowl import Bowl
from feederscrew.bowl.reading import checked, find_key
from feederscrew.bowl.schema import BOWL_KEYS, Key
from feederscrew.dropping import launch_conditions as condition_keys
from feederscrew.errors import ArgumentError
from feederscrew.part.record import PART_MEND, Part
from feederscrew.resting.aspects import Aspects
from feederscrew.resting.rules.formulas import EXPONENTS

Setting: TypeAlias = str | float | None  # '2 mm', a number in SI units, a word; None: as the bowl has it
Overrides: TypeAlias = str | Sequence[str] | Mapping[str, str | float]  # or a dict, by the full name of a key
Path: TypeAlias = str | PathLike[str]
Quantity: TypeAlias = str | float  # '2 mm', or a number in SI units
Condition: TypeAlias = Quantity | tuple[Quantity, Quantity] | None  # or the smaller and the larger
Function = TypeVar("Function", bound=Callable[..., object])
BY_WORD = {key.word: key for key in BOWL_KEYS}
SI = {"length": "m", "angular velocity": "rad/s", "velocity": "m/s", "number": ""}
EXPONENT_RANGE = -10.0, 10.0  # [1] of a surface: calibrate tries some below 0 as well
BOWL_MEND = "give a Bowl, as read_bowl returns it"
OVERRIDES_MEND = "give a dict, {'drive.frequency': '50 Hz'}, or texts, 'drive.frequency=50 Hz'"

DriveSettings = TypedDict(  # noqa: UP013 - a line for each of eighty keys says no more
    "DriveSettings",
    {  # written by docs/bowl_file.py
        "amplitude": Setting, "peak_to_peak": Setting, "frequency": Setting, "vibration_angle": Setting,
        "direction": Setting, "phase": Setting, "second_harmonic": Setting,
        "second_harmonic_phase": Setting, "second_harmonic_angle": Setting, "static": Setting,
        "kinetic": Setting, "static_backward": Setting, "kinetic_backward": Setting, "wall": Setting,
        "gravity": Setting, "climb": Setting, "bank": Setting, "radius": Setting, "width": Setting,
        "hand": Setting, "bowl_mass": Setting, "bowl_inertia": Setting, "base_inertia": Setting,
        "spring_angle": Setting, "leaf_width": Setting, "leaf_thickness": Setting, "leaf_length": Setting,
        "leaf_modulus": Setting, "damping": Setting, "supply": Setting, "centre_x": Setting,
        "centre_y": Setting, "centre_z": Setting, "inertia_x": Setting, "inertia_y": Setting,
        "product_yz": Setting, "product_xz": Setting, "product_xy": Setting, "bolts": Setting,
        "bolt_hole": Setting, "bolt_circle": Setting, "mains": Setting, "least_diameter": Setting,
        "diameter_per_length": Setting, "diameter_per_width": Setting, "greatest_diameter": Setting,
        "diameter_step": Setting, "least_climb": Setting, "clearance": Setting, "least_clearance": Setting,
        "greatest_clearance": Setting, "headroom": Setting, "depth": Setting, "fill_height": Setting,
        "packing": Setting, "carried": Setting, "fill_density": Setting, "hopper_interval": Setting,
        "retune": Setting, "least_detuning": Setting, "greatest_detuning": Setting,
        "greatest_acceleration": Setting, "greatest_stroke": Setting, "banks": Setting,
        "fatigue_stress": Setting, "half_wave_diameter": Setting, "least_spring_angle": Setting,
        "greatest_spring_angle": Setting, "greatest_spring_radius": Setting,
        "steepest_spring_angle": Setting, "sheet": Setting, "sheet_density": Setting,
        "tooling_mass": Setting, "slowest": Setting, "fastest": Setting, "handbook_speed": Setting,
        "bolt_share": Setting, "shape": Setting, "outlet_height": Setting, "outlet_angle": Setting,
        "drains": Setting, "drain_hole": Setting,
    },
    total=False,
)  # fmt: skip


class BowlSettings(DriveSettings, total=False):
    """The same with ``restitution``, which drops have as well."""

    restitution: Setting


class BowlFile(TypedDict, total=False):
    """The bowl of a report: keywords of ``read_bowl``."""

    path: Path | None
    overrides: Overrides


def with_settings(function: Function) -> Function:
    """Return a function that says its settings one by one.

    ``inspect.signature`` lists each in place of ``**settings``, and the TypeError of an unknown keyword says
    which one is near.
    """
    signature = inspect.signature(function)
    own = [p for p in signature.parameters.values() if p.kind is not inspect.Parameter.VAR_KEYWORD]
    words = [key.word for key in BOWL_KEYS if key.word in BowlSettings.__optional_keys__]
    settings = [
        inspect.Parameter(word, inspect.Parameter.KEYWORD_ONLY, default=None, annotation=Setting)
        for word in words
        if word not in signature.parameters
    ]
    names = [parameter.name for parameter in (*own, *settings)]

    @functools.wraps(function)
    def with_known_keywords(*arguments: object, **keywords: object) -> object:
        unknown = next((name for name in keywords if name not in names), None)
        if unknown is None:
            return function(*arguments, **keywords)
        sections = [key.name for key in BOWL_KEYS if key.word == unknown and unknown not in words]
        if sections:
            full = " or ".join(f"overrides={{'{name}': ...}}" for name in sections)
            fault = f"has no keyword {unknown!r}, a key of {len(sections)} sections - write {full}"
        else:
            near = difflib.get_close_matches(unknown, names, n=1)
            known = f"known are {', '.join(p.name for p in own)} and the keys of a bowl file"
            mend = f"did you mean {near[0]!r}?" if near else known
            fault = f"got an unexpected keyword argument {unknown!r} - {mend}"
        raise TypeError(f"{function.__name__}() {fault}")

    cast(Any, with_known_keywords).__signature__ = signature.replace(parameters=[*own, *settings])
    return cast(Function, with_known_keywords)


def override_texts(overrides: Overrides, settings: Mapping[str, Any]) -> tuple[str, ...]:
    """Return overrides and settings as texts, 'drive.frequency=50 Hz'; of one key the last holds.

    A dict of ``overrides`` is by the full name of a key, ``settings`` by keyword of ``BowlSettings``;
    numbers are in SI units. Raises ArgumentError if a value is not one that its key may have, or no such
    key exists.
    """
    texts: list[str] = []

    def add(key: Key, value: object, argument: str) -> None:
        if isinstance(value, str):
            text = value
        elif key.choices:
            raise ArgumentError(argument, f"is {value!r:.40}", f"give {key.bounds}")
        else:
            number = check.argument(argument, value)
            unit = next(unit for unit, scale in si.UNITS_BY_DIMENSION[key.dimension].items() if scale == 1.0)
            text = f"{number!r} {unit}".strip()
        try:
            checked(key, text, argument, kind=ArgumentError)
        except ArgumentError as fault:
            raise ArgumentError(argument, fault.what.removeprefix(f"{key.name}: "), fault.mend) from None
        texts.append(f"{key.name}={text}")

    if isinstance(overrides, Mapping):
        for name, value in overrides.items():
            check.kind("overrides", name, str, OVERRIDES_MEND)
            add(find_key(name, f"overrides {si.one_line(name)}"), value, name)
    elif isinstance(overrides, str):
        texts.append(overrides)
    else:
        texts += several("overrides", overrides, str, OVERRIDES_MEND)
    for name, setting in settings.items():
        if setting is not None:
            add(BY_WORD[name], setting, name)
    return tuple(texts)


def a_part(part: object) -> Part:
    """Return the part; raises ArgumentError where it is none."""
    return check.kind("part", part, Part, PART_MEND)


def a_bowl(bowl: object, overrides: Overrides = (), settings: Mapping[str, Any] | None = None) -> Bowl:
    """Return the bowl with overrides and settings in it; raises ArgumentError where it is none."""
    own: Bowl = check.kind("bowl", bowl, Bowl, BOWL_MEND)
    texts = override_texts(overrides, settings or {})
    return bowls.adjust(own, texts) if texts else own


def some_bowls(
    bowls: object, overrides: Overrides = (), settings: Mapping[str, Any] | None = None
) -> tuple[Bowl, ...]:
    """Return one bowl, or several, as a tuple, each with overrides and settings in it."""
    mend = f"{BOWL_MEND}, or several in a list"
    each = (bowls,) if isinstance(bowls, Bowl) else several("bowls", bowls, Bowl, mend)
    if not each:
        raise ArgumentError("bowls", "is empty", BOWL_MEND)
    return tuple(a_bowl(bowl, overrides, settings) for bowl in each)


def an_aspect(name: str | None) -> str | None:
    """Return the name of an aspect; None stays None."""
    return None if name is None else check.kind("aspect", name, str, "give the name of an aspect, 'A'")


def a_file_of_bowl(value: object) -> BowlFile:
    """Return the keywords of ``read_bowl``; raises ArgumentError where they are no dict of these."""
    mend = "give a dict of path and overrides"
    keywords = {} if value is None else check.kind("bowl", value, Mapping, mend)
    if strange := sorted(set(keywords) - {"path", "overrides"}):
        raise ArgumentError("bowl", f"has a key {strange[0]!r}", mend)
    return cast(BowlFile, keywords)


def several(name: str, items: object, wanted: type, mend: str) -> tuple[Any, ...]:
    """Return what is given in a list as a tuple; raises ArgumentError where one is of another class."""
    listed = check.kind(name, items, (tuple, list), mend)
    return tuple(check.kind(name, item, wanted, mend) for item in listed)


def count(name: str, value: int | None, low: int = 1) -> int | None:
    """Return a whole number from a lowest one; None stays None."""
    return None if value is None else whole(name, value, low)


def whole(name: str, value: int, low: int = 1) -> int:
    """Return a whole number from a lowest one."""
    if not check.argument(name, value, low).is_integer():
        raise ArgumentError(name, f"is {value}", "give a whole number")
    return int(value)


def share(name: str, value: float, low: float = 0.0) -> float:
    """Return a share [1]; raises ArgumentError where it is below the lowest or above 1."""
    return check.argument(name, value, low, 1.0)


def amount(name: str, value: Quantity, dimension: str, low: float = -math.inf) -> float:
    """Return a quantity of a dimension of ``units``, '2 mm' or a number in SI units, in SI units.

    Raises ArgumentError if ``value`` is neither, or below ``low`` [SI]; the line names the argument.
    """
    try:
        number = si.quantity(value, dimension) if isinstance(value, str) else value
    except si.QuantityError as fault:
        raise ArgumentError(name, fault.what, fault.mend) from None
    return check.argument(name, number, low)


def angle(name: str, value: Quantity | None) -> float | None:
    """Return an angle [rad] of '90 deg' or of radians; None stays None."""
    return None if value is None else amount(name, value, "angle")


def pair(name: str, value: object, dimension: str) -> tuple[float, float]:
    """Return the smaller and the larger of two quantities in SI units; one stands for both."""
    ends = value if isinstance(value, (tuple, list)) else (value, value)
    if len(ends) != 2:
        raise ArgumentError(name, f"has {len(ends)} values", "give one, or the smaller and the larger")
    low, high = (amount(name, end, dimension, 0.0) for end in ends)
    if low > high:
        raise ArgumentError(name, f"is from {low:g} to {high:g}", "give the smaller and the larger")
    return low, high


def conditions(**ranges: Condition) -> dict[str, str | None]:
    """Return the conditions of a launch that are given, as typed: '20 mm:50 mm'."""
    texts: dict[str, str | None] = {}
    for name, value in ranges.items():
        if value is not None:
            unit = SI[condition_keys.CONDITION_KEYS[name][0]]
            ends = value if isinstance(value, (tuple, list)) else (value,)
            texts[name] = ":".join(
                end if isinstance(end, str) else f"{check.argument(name, end)!r} {unit}".strip()
                for end in ends
            )
    return texts


def a_rule(rule: str, aspects: Aspects) -> str:
    """Return the name of a rule; raises ArgumentError where it gives this part no probabilities."""
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


@with_settings
def read_bowl(path: Path | None = None, overrides: Overrides = (), **settings: Unpack[BowlSettings]) -> Bowl:
    """Read a bowl from its file, from settings, or take the defaults.

    Parameters
    ----------
    path : str or Path, optional
        Bowl file (YAML).
    overrides : dict, str or sequence of str
        {'drive.frequency': '50 Hz'} or 'drive.frequency=50 Hz'; the last of one key holds.
    **settings : str or float [SI]
        Keys of a bowl file by their last word, amplitude='0.3 mm'. They go over the overrides, and these
        over the file.

    Raises
    ------
    Faults
        Every fault of the file and of the overrides.
    """
    texts = override_texts(overrides, settings)
    return bowls.read(None if path is None else check.path("path", path), texts)
