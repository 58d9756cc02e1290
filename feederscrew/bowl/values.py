"""Values of a bowl as a program gives them: by keyword, in a dict, or as texts."""

import difflib
from collections.abc import Collection, Mapping, Sequence
from typing import Any, TypeAlias, TypedDict

from feederscrew.base import check, units
from feederscrew.base.errors import ArgumentError
from feederscrew.base.units import Quantity
from feederscrew.bowl.reading import adjust, checked, find_key
from feederscrew.bowl.record import Bowl
from feederscrew.bowl.schema import BOWL_KEYS, Key

Value: TypeAlias = Quantity | None  # '2 mm', a number in SI units, of pint, a word; None: as the bowl has it
Overrides: TypeAlias = str | Sequence[str] | Mapping[str, Quantity]  # or a dict, by the full name of a key
BY_WORD = {key.word: key for key in BOWL_KEYS}
OVERRIDES_MEND = "give a dict, {'drive.frequency': '50 Hz'}, or texts, 'drive.frequency=50 Hz'"

BowlValues = TypedDict(  # noqa: UP013 - a line for each of eighty keys says no more
    "BowlValues",
    {  # written by docs/bowl_file.py
        "amplitude": Value, "peak_to_peak": Value, "frequency": Value, "vibration_angle": Value,
        "direction": Value, "phase": Value, "second_harmonic": Value, "second_harmonic_phase": Value,
        "second_harmonic_angle": Value, "static": Value, "kinetic": Value, "static_backward": Value,
        "kinetic_backward": Value, "wall": Value, "lining": Value, "part_material": Value,
        "restitution": Value, "gravity": Value, "climb": Value, "bank": Value, "radius": Value,
        "width": Value, "hand": Value, "bowl_mass": Value, "bowl_inertia": Value, "base_inertia": Value,
        "spring_angle": Value, "leaf_width": Value, "leaf_thickness": Value, "leaf_length": Value,
        "leaf_modulus": Value, "damping": Value, "supply": Value, "centre_x": Value, "centre_y": Value,
        "centre_z": Value, "inertia_x": Value, "inertia_y": Value, "product_yz": Value, "product_xz": Value,
        "product_xy": Value, "bolts": Value, "bolt_hole": Value, "bolt_circle": Value, "mains": Value,
        "least_diameter": Value, "diameter_per_length": Value, "diameter_per_width": Value,
        "greatest_diameter": Value, "diameter_step": Value, "least_climb": Value, "clearance": Value,
        "least_clearance": Value, "greatest_clearance": Value, "headroom": Value, "depth": Value,
        "fill_height": Value, "packing": Value, "carried": Value, "fill_density": Value,
        "hopper_interval": Value, "retune": Value, "least_detuning": Value, "greatest_detuning": Value,
        "greatest_acceleration": Value, "greatest_stroke": Value, "banks": Value, "fatigue_stress": Value,
        "half_wave_diameter": Value, "least_spring_angle": Value, "greatest_spring_angle": Value,
        "greatest_spring_radius": Value, "steepest_spring_angle": Value, "sheet": Value,
        "sheet_density": Value, "tooling_mass": Value, "slowest": Value, "fastest": Value,
        "handbook_speed": Value, "bolt_share": Value, "shape": Value, "outlet_height": Value,
        "outlet_angle": Value, "drains": Value, "drain_hole": Value,
    },
    total=False,
)  # fmt: skip


def adjusted(bowl: Bowl, overrides: Overrides, values: Mapping[str, Any]) -> Bowl:
    """Return a bowl with other values, as ``Bowl.with_values`` says; the same one where none is given.

    Parameters
    ----------
    bowl : Bowl
    overrides : mapping or iterable of str
        Values by key name, or texts 'drive.frequency=50 Hz'.
    values : mapping of str to value
        By word of a key: 'amplitude'.

    Returns
    -------
    Bowl

    Raises
    ------
    TypeError
        If a keyword is not a key of a bowl.
    Faults
        Every fault of the values, one a line.
    """
    refuse_unknown("with_values", values)
    texts = value_texts(overrides, values)
    if not texts:
        return bowl
    changed = adjust(bowl, texts)
    object.__setattr__(changed, "source", bowl.source)  # a trial in that file holds while values are the same
    return changed


def refuse_unknown(function: str, keywords: Collection[str], own: Sequence[str] = ()) -> None:
    """Refuse keywords that are no keys of a bowl, nor a function's own.

    Parameters
    ----------
    function : str
        Its name, for the fault.
    keywords : collection of str
        That were given.
    own : sequence of str
        Keywords of the function itself.

    Returns
    -------
    None

    Raises
    ------
    TypeError
        If a keyword is unknown. The line says which key is near, or by which full name to give a key that
        several sections have.
    """
    words = BowlValues.__optional_keys__
    unknown = next((name for name in keywords if name not in words and name not in own), None)
    if unknown is None:
        return
    sections = [key.name for key in BOWL_KEYS if key.word == unknown]
    if sections:
        full = " or ".join(f"{{'{name}': ...}}" for name in sections)
        fault = f"has no keyword {unknown!r}, a key of {len(sections)} sections - write with_values({full})"
    else:
        near = difflib.get_close_matches(unknown, [*own, *sorted(words)], n=1)
        known = f"known are {', '.join(own) or 'the keys of a bowl file'}"
        mend = f"did you mean {near[0]!r}?" if near else known
        fault = f"got an unexpected keyword argument {unknown!r} - {mend}"
    raise TypeError(f"{function}() {fault}")


def value_texts(overrides: Overrides, values: Mapping[str, Any]) -> tuple[str, ...]:
    """Return overrides and values by keyword as texts, 'drive.frequency=50 Hz'; of one key the last holds.

    Parameters
    ----------
    overrides : dict, str or sequence of str
        A dict is by the full name of a key; numbers in it are in SI units.
    values : dict
        By keyword of ``BowlValues``; None leaves the bowl's own.

    Returns
    -------
    tuple of str

    Raises
    ------
    ArgumentError
        If a value is not one that its key may have, or there is no such key.
    """
    texts: list[str] = []

    def add(key: Key, given: object, argument: str) -> None:
        try:
            value = given if key.choices else units.from_quantity(given, key.dimension)
        except units.QuantityError as fault:
            raise ArgumentError(argument, fault.what, fault.mend) from None
        if isinstance(value, str):
            text = value
        elif key.choices:
            raise ArgumentError(argument, f"is {value!r:.40}", f"give {key.bounds}")
        else:
            number = check.argument(argument, value)
            unit = next(
                unit for unit, scale in units.UNITS_BY_DIMENSION[key.dimension].items() if scale == 1.0
            )
            text = f"{number!r} {unit}".strip()
        try:
            checked(key, text, argument, kind=ArgumentError)
        except ArgumentError as fault:
            raise ArgumentError(argument, fault.what.removeprefix(f"{key.name}: "), fault.mend) from None
        texts.append(f"{key.name}={text}")

    if isinstance(overrides, Mapping):
        for name, value in overrides.items():
            check.kind("overrides", name, str, OVERRIDES_MEND)
            add(find_key(name, f"overrides {units.one_line(name)}"), value, name)
    elif isinstance(overrides, str):
        texts.append(overrides)
    else:
        listed = check.kind("overrides", overrides, (tuple, list), OVERRIDES_MEND)
        texts += [check.kind("overrides", text, str, OVERRIDES_MEND) for text in listed]
    for name, value in values.items():
        if value is not None:
            add(BY_WORD[name], value, name)
    return tuple(texts)
