"""Forms of what a bowl file writes, as JSON Schema: quantities, mappings of them, polygons."""

import re
from collections.abc import Sequence
from typing import Any

from feederscrew.base import units

NUMBER_TEXT = r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?"
UNITLESS = ("number", "count")  # dimensions without a unit
JsonSchema = dict[str, Any]  # one schema, or a part of one, in the words of json-schema.org, 2020-12


def quantity(dimension: str, lowest: str | None = None, highest: str | None = None) -> JsonSchema:
    """Return the JSON Schema form of a value with its unit.

    Parameters
    ----------
    dimension : str
        Of ``units``.
    lowest, highest : str, optional
        Bounds of a number without a unit.

    Returns
    -------
    dict
        A text; where the dimension has no unit also a number within the bounds.
    """
    text = {"type": "string", "pattern": pattern(dimension)}
    if dimension not in UNITLESS:
        return text
    number: JsonSchema = {"type": "number"}
    if lowest is not None and highest is not None:
        number |= {
            "minimum": units.quantity(lowest, dimension),
            "maximum": units.quantity(highest, dimension),
        }
    return {"anyOf": [number, text]}


def pattern(dimension: str) -> str:
    """Return the regular expression of a quantity as a bowl file writes it.

    Parameters
    ----------
    dimension : str
        Of ``units``.

    Returns
    -------
    str
        Of number and unit, in every spelling that ``units.quantity`` reads; the unit may be left out where
        the dimension is a plain number.
    """
    spelt = [
        *units.UNITS_BY_DIMENSION[dimension],
        *(name for name, unit in units.SPELLINGS.items() if unit in units.UNITS_BY_DIMENSION[dimension]),
    ]
    ends = sorted({_loose(name) for name in spelt if name}, key=lambda end: (-len(end), end))
    behind = f"\\s*({'|'.join(ends)})" if ends else ""
    return f"^\\s*{NUMBER_TEXT}{behind}{'?' if dimension in UNITLESS and ends else ''}\\s*$"


def _loose(unit: str) -> str:
    """A unit with a superscript or a caret where it has a power, and any blanks."""
    escaped = re.escape(unit).replace("\\ ", r"[\s*·]+").replace("\\-", "-")
    return escaped.replace("2", r"\^?[2²]").replace("3", r"\^?[3³]")


def either(*forms: JsonSchema) -> JsonSchema:
    """Return the form of a value that is written in one of several ways.

    Parameters
    ----------
    *forms : dict
        JSON Schema of each.

    Returns
    -------
    dict
    """
    return {"anyOf": list(forms)}


def by_name(form: JsonSchema) -> JsonSchema:
    """Return the form of values of one form, each with a name, one at least.

    Parameters
    ----------
    form : dict
        JSON Schema of a value.

    Returns
    -------
    dict
    """
    return {"type": "object", "minProperties": 1, "additionalProperties": form}


def mapping(optional: Sequence[str] = (), /, **values: JsonSchema) -> JsonSchema:
    """Return the form of a mapping of exactly these keys.

    Parameters
    ----------
    optional : sequence of str, optional
        Keys that may be missing.
    **values : dict
        JSON Schema of the value of each key. A key that Python keeps for itself ends in '_': 'from_' is
        'from'.

    Returns
    -------
    dict
    """
    named = {name.rstrip("_"): value for name, value in values.items()}
    needed = [name for name in named if name not in optional]
    return {"type": "object", "properties": named, "required": needed, "additionalProperties": False}


LENGTH_FORM = quantity("length")
ANGLE_FORM = quantity("angle")
POLYGON: JsonSchema = {
    "type": "array",
    "minItems": 3,
    "items": {"type": "array", "items": LENGTH_FORM, "minItems": 2, "maxItems": 2},
}
TEXT_FORM = {"type": "string"}
NAMED = {"type": "string", "pattern": "^.+@.+$"}  # an orientation: A@90
