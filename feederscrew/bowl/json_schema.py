"""The bowl file's JSON Schema, for editors: made from the tables that the checks read."""

import json
from os import PathLike
from pathlib import Path
from typing import Any

from feederscrew import units
from feederscrew.bowl import documentation
from feederscrew.bowl.devices import DEVICES_SECTION
from feederscrew.bowl.key import Key
from feederscrew.bowl.schema import BOWL_KEYS, BOWL_SECTIONS, BY_NAME, rival
from feederscrew.value_forms import UNITLESS, quantity

DRAFT = "http://json-schema.org/draft-07/schema#"  # the latest one that YAML editors know well
TITLE = "feeder bowl file"
SECTION_DESCRIPTIONS = {
    "drive": "How the bowl vibrates.",
    "friction": "Coefficients of friction.",
    "track": "The track and its wall.",
    "machine": "The drive unit under the bowl: springs and masses.",
    "sizing": "Rules of thumb of `feeder bowl`.",
}


def schema() -> dict[str, Any]:
    """Return the JSON Schema of a bowl file.

    Returns
    -------
    dict
        Draft 7. A value with a unit is a string with a pattern; ``x-lowest``, ``x-highest``, ``x-units`` and
        ``x-dimension`` say what the checks of `feeder` hold it to, as the draft has no bounds for strings.
    """
    properties = {key.name: _value(key) for key in BOWL_KEYS if not key.section}
    for section in BOWL_SECTIONS:
        properties[section] = _section(section)
    properties[DEVICES_SECTION] = {
        "description": "Devices along the track, in the order in which parts meet them.",
        "type": "array",
        "items": {
            "type": "object",
            "properties": {kind: _device(one) for kind, one in documentation.KINDS.items()},
            "additionalProperties": False,
            "minProperties": 1,
            "maxProperties": 1,
        },
    }
    return {
        "$schema": DRAFT,
        "title": TITLE,
        "description": "A bowl feeder: its drive, its surface, its track and its devices.",
        "type": "object",
        "properties": properties,
        "additionalProperties": False,
    }


def text() -> str:
    """Return ``schema`` as the text of a file."""
    return json.dumps(schema(), indent=1, ensure_ascii=False) + "\n"


def write_beside(path: str | PathLike[str]) -> Path:
    """Write the schema beside a bowl file, in place of an older one of ours.

    Parameters
    ----------
    path : str or Path
        Of the bowl file.

    Returns
    -------
    Path

    Raises
    ------
    FeederError
        If another file has that name, or it cannot be written.
    """
    place = Path(path).parent / documentation.SCHEMA_FILE
    ours = place.is_file() and f'"title": "{TITLE}"' in place.read_text(encoding="utf-8", errors="replace")
    documentation.write_new(place, text(), replace=ours)
    return place


def _section(section: str) -> dict[str, Any]:
    keys = [key for key in BOWL_KEYS if key.section == section]
    made = {
        "description": SECTION_DESCRIPTIONS.get(section, f"Values of {section}."),
        "type": "object",
        "properties": {key.word: _value(key) for key in keys},
        "additionalProperties": False,
    }
    pairs = ((key, rival(key)) for key in keys)
    rivals = {frozenset((key.word, other.word)) for key, other in pairs if other is not None}
    if rivals:
        made["allOf"] = [{"not": {"required": sorted(pair)}} for pair in sorted(rivals, key=sorted)]
    return made


def _value(key: Key) -> dict[str, Any]:
    """The schema of one key."""
    bounds = f"From {key.lowest} to {key.highest}."
    if key.choices:
        return _word(key)
    follows = key.default in BY_NAME
    left_out = f"Left out: as {key.default}." if follows else f"Default: {key.default}."
    made = {
        "description": f"{key.meaning}. {bounds} {left_out}",
        **quantity(key.dimension, key.lowest, key.highest),
        "x-dimension": key.dimension,
        "x-lowest": key.lowest,
        "x-highest": key.highest,
        "x-units": [unit for unit in units.UNITS_BY_DIMENSION[key.dimension] if unit],
    }
    return made if follows else {**made, "default": _typed(key.default, key.dimension)}


def _word(key: Key) -> dict[str, Any]:
    """The schema of a key that is one of several words."""
    return {
        "description": f"{key.meaning}. One of {', '.join(key.choices)}. Default: {key.default}.",
        "type": "string",
        "enum": list(key.choices),
        "x-dimension": key.dimension,
        "x-lowest": key.choices[0],
        "x-highest": key.choices[-1],
        "x-units": [],
        "default": key.default,
    }


def _typed(text: str, dimension: str) -> str | float:
    """A default as YAML reads it: a number where it has no unit."""
    number, unit = units.split(text)
    if dimension not in UNITLESS or unit:
        return text
    return int(number) if number.is_integer() else number


def _device(kind: Any) -> dict[str, Any]:
    return {"description": f"{kind.meaning}. Example: {kind.example}", **kind.form}
