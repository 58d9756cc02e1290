"""The schema for people and editors: a commented bowl file, and the bowl file's JSON Schema."""

import json
from os import PathLike
from pathlib import Path

from feederscrew.base import units
from feederscrew.base.errors import FeederError
from feederscrew.base.value_forms import UNITLESS, JsonSchema, quantity
from feederscrew.bowl.device_list import DEVICES_SECTION
from feederscrew.bowl.devices.base import Device
from feederscrew.bowl.devices.kinds import KINDS
from feederscrew.bowl.reading import OF_THE_MACHINE, default
from feederscrew.bowl.schema import BOWL_KEYS, BOWL_SECTIONS, BY_NAME, OPTIONAL, Key, rival

SCHEMA_FILE = "feeder.schema.json"  # what the JSON Schema is called beside a bowl file
EDITORS = f"# yaml-language-server: $schema={SCHEMA_FILE}"  # the line by which editors find it
SLOWEST, FASTEST = (BY_NAME[f"sizing.{name}"].default.partition(" ")[0] for name in ("slowest", "fastest"))
WHY = f"""\
The defaults are a typical bowl: steel on a dry steel track that climbs 3 deg, driven at the 50 Hz of a
half-wave supply with 0.42 mm from end to end. Parts travel at 25 mm/s, the speed behind the handbook's
estimate of 1500 parts a minute over the part's length in mm; bowls run {SLOWEST} to {FASTEST} mm/s.
The part slides without hopping, whether its friction is a fifth lower or half as high again, so that its
forces on floor and track can be followed; drives that throw it run faster (100 Hz, 0.15 mm and 20 deg:
56 mm/s).
Measure your own: tilt the track until the part slides, and write the tangent of that angle as static
friction. friction.lining takes it from a table by lining and part: ranges and assumptions, not measurements.
"""


def template() -> str:
    """Return a bowl file of all defaults, commented: what ``feeder config init`` writes.

    Returns
    -------
    str
    """
    lines = [
        EDITORS,
        "# A bowl feeder: its drive, its surface and its track. Write a unit after every dimensional value.",
    ]
    lines += [f"# {line}" for line in WHY.splitlines()]
    section = ""
    for key in BOWL_KEYS:
        if key.section != section:
            section = key.section
            lines.append("")
            if section in OPTIONAL:  # behind comment signs
                lines.append("# Take the '# ' away from these lines to describe your own drive unit.")
            lines += [f"{'# ' if section in OPTIONAL else ''}{section}:"] if section else []
        # 'amplitude: 0.05 mm  # ...'; a key that follows another stands behind a comment sign
        of_machine, follows = key.name in OF_THE_MACHINE, key.default in BY_NAME
        behind = "# " if follows or of_machine or section in OPTIONAL else ""
        indent, left_out = "  " if section else "", ""
        if of_machine:
            left_out = f" (left out: {key.default}, or from machine)"
        elif follows:
            left_out = f" (left out: {'as' if rival(key) is None else 'from'} {key.default})"
        start = behind + indent if section in OPTIONAL else indent + behind
        lines.append(f"{f'{start}{key.word}: {default(key).text}':<25}  # {key.meaning}{left_out}")
    lines += ["", f"# {DEVICES_SECTION}:  # along the track, in the order parts meet them"]
    lines += [f"#   - {kind}: {key.trade.example}  # {key.trade.meaning}" for kind, key in KINDS.items()]
    return "\n".join(lines) + "\n"


def write_new(path: str | Path, text: str, *, replace: bool = False) -> None:
    """Write a text to a file that is not there or has that text already.

    Parameters
    ----------
    path : str or path
    text : str
        Written as UTF-8, with line feeds on every system.
    replace : bool
        Replace a file of another text.

    Returns
    -------
    None

    Raises
    ------
    FeederError
        If the file has another text and is not to be replaced, or cannot be made.
    """
    if Path(path).is_dir():
        raise FeederError(path, "is a folder", f"name a file in it, such as {Path(path) / 'bowl.yaml'}")
    try:
        with Path(path).open("w" if replace else "x", encoding="utf-8", newline="\n") as file:
            file.write(text)
    except FileExistsError:
        if Path(path).is_file() and Path(path).read_bytes() == text.encode():
            return
        mend = "name another file, or pass `replace` to replace it"
        raise FeederError(path, "exists already", mend) from None
    except OSError as error:
        what = f"cannot be written ({error.strerror})"
        raise FeederError(path, what, "name a file in a folder of yours") from None


DRAFT = "http://json-schema.org/draft-07/schema#"  # the latest one that YAML editors know well
TITLE = "feeder bowl file"
SECTION_DESCRIPTIONS = {
    "drive": "How the bowl vibrates.",
    "friction": "Coefficients of friction.",
    "track": "The track and its wall.",
    "machine": "The drive unit under the bowl: springs and masses.",
    "sizing": "Rules of thumb of `feeder bowl`.",
}


def json_schema() -> JsonSchema:
    """Return the JSON Schema of a bowl file, draft 7.

    A value with a unit is a string with a pattern; ``x-lowest``, ``x-highest``, ``x-units`` and
    ``x-dimension`` say what the checks of `feeder` hold it to, as the draft has no bounds for strings.

    Returns
    -------
    dict of str to object
    """
    properties = {key.name: _value(key) for key in BOWL_KEYS if not key.section}
    for section in BOWL_SECTIONS:
        keys = [key for key in BOWL_KEYS if key.section == section]
        properties[section] = part = {
            "description": SECTION_DESCRIPTIONS.get(section, f"Values of {section}."),
            "type": "object",
            "properties": {key.word: _value(key) for key in keys},
            "additionalProperties": False,
        }
        pairs = ((key, rival(key)) for key in keys)
        rivals = {frozenset((key.word, other.word)) for key, other in pairs if other is not None}
        if rivals:
            part["allOf"] = [{"not": {"required": sorted(pair)}} for pair in sorted(rivals, key=sorted)]
    properties[DEVICES_SECTION] = {
        "description": "Devices along the track, in the order in which parts meet them.",
        "type": "array",
        "items": {
            "type": "object",
            "properties": {
                name: _device_form(kind) | ({"deprecated": True} if name == kind.trade.old_name else {})
                for kind in KINDS.values()
                for name in filter(None, (kind.kind, kind.trade.old_name))
            },
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


def schema_text() -> str:
    """Return ``schema`` as the text of a file."""
    return json.dumps(json_schema(), indent=1, ensure_ascii=False) + "\n"


def write_beside(path: str | PathLike[str]) -> Path:
    """Write the schema beside a bowl file, in place of an older one of ours.

    Parameters
    ----------
    path : str or path
        Of the bowl file.

    Returns
    -------
    Path
        Of the schema.

    Raises
    ------
    FeederError
        If another file has that name, or it cannot be written.
    """
    place = Path(path).parent / SCHEMA_FILE
    ours = place.is_file() and f'"title": "{TITLE}"' in place.read_text(encoding="utf-8", errors="replace")
    write_new(place, schema_text(), replace=ours)
    return place


def _device_form(kind: type[Device]) -> JsonSchema:
    """The schema of one kind of device."""
    return {"description": f"{kind.trade.meaning}. Example: {kind.trade.example}", **kind.trade.form}


def _value(key: Key) -> JsonSchema:
    """The schema of one key."""
    part: JsonSchema = {"x-dimension": key.dimension}
    if key.choices:
        meaning = f"{key.meaning}. One of {', '.join(key.choices)}. Default: {key.default}."
        form: JsonSchema = {"type": "string", "enum": list(key.choices)}
        part |= {"x-lowest": key.choices[0], "x-highest": key.choices[-1], "x-units": []}
        return {"description": meaning, **form, **part, "default": key.default}
    follows = key.default in BY_NAME
    left_out = f"Left out: as {key.default}." if follows else f"Default: {key.default}."
    meaning = f"{key.meaning}. From {key.lowest} to {key.highest}. {left_out}"
    part |= {"x-lowest": key.lowest, "x-highest": key.highest}
    part["x-units"] = [unit for unit in units.UNITS_BY_DIMENSION[key.dimension] if unit]
    if not follows:  # a default as YAML reads it: a number where it has no unit
        number, unit = units.split(key.default)
        plain = key.dimension in UNITLESS and not unit
        part["default"] = (int(number) if number.is_integer() else number) if plain else key.default
    return {"description": meaning, **quantity(key.dimension, key.lowest, key.highest), **part}
