"""A bowl as the text of a bowl file."""

from typing import Any

import numpy as np

from feederscrew.base import units
from feederscrew.base.errors import FeederError
from feederscrew.bowl import device_list as devices
from feederscrew.bowl import schema
from feederscrew.bowl.reading import (
    Setting,
    effective,
    of_device,
    record,
    settings_of_text,
)
from feederscrew.bowl.record import Bowl
from feederscrew.bowl.schema import BOWL_KEYS, Key

NAME = "bowl.yaml"  # what the text is called in faults
ALWAYS = ("drive.frequency", "drive.vibration_angle")  # a machine would set them otherwise
SHOWN = ("", "drive", "friction", "track")  # sections whose defaults stand there as comments
SAID_AT_LEAST = "gravity"  # the key that a bowl of defaults says: no design would set it
DIGITS = 12  # of a number in the unit of its key, where they give the same number back


def yaml_text(bowl: Bowl) -> str:
    """Return a bowl as the text of a bowl file, which ``read_bowl`` reads back as the same bowl.

    Keys that somebody gave are lines; defaults of drive, friction and track are comments, so that a design
    is as free as it was. Of a bowl that was changed after it was read each value that is no default is a
    line.

    Parameters
    ----------
    bowl : Bowl

    Returns
    -------
    str

    Raises
    ------
    FeederError
        If a file cannot say what the bowl is: a value of it is out of range, or an array.
    """
    settings = bowl.settings or stated(bowl)
    own = [s for s in settings if s.is_own and s.key.field != devices.DEVICES_SECTION]
    if not own and not bowl.devices:  # a file without a line cannot be read
        own = [s for s in settings if s.key.name == SAID_AT_LEAST]
    given = {s.key.field for s in own}
    left_out = [s for s in settings if not s.is_own and s.key.section in SHOWN and s.key.field not in given]
    lines = ["# A vibratory bowl feeder. Lines behind '#' are defaults."]
    for section in dict.fromkeys(key.section for key in BOWL_KEYS):
        keyed = [f"{s.key.word}: {units.quoted(s.text)}" for s in own if s.key.section == section]
        free = [f"# {s.key.word}: {s.text}" for s in left_out if s.key.section == section and s.text]
        if section and (keyed or free):
            lines.append(f"{section}:" if keyed else f"# {section}:")
        lines += [f"{'  ' if section else ''}{line}" for line in (*keyed, *free)]
    if bowl.devices:
        lines += [f"{devices.DEVICES_SECTION}:  # along the track, in the order parts meet them"]
        lines += [f"  - {device.kind}: {devices.value_text(device)}" for device in bowl.devices]
    text = "\n".join(lines) + "\n"
    devices.check_written(bowl.devices, NAME)
    wrong = devices.differences(bowl, record(settings_of_text(text, NAME)), ())
    if wrong:
        mend = "change it with bowl.with_values(...), which refuses what no file can say"
        raise FeederError(NAME, f"cannot say what this bowl is: {'; '.join(wrong):.200}", mend)
    return text


def stated(bowl: Bowl) -> tuple[Setting, ...]:
    """Return every value in effect of a bowl that was changed after it was read: what is no default is own.

    Raises FeederError if a value is an array.
    """
    usual = record(effective({}))
    has_machine = bowl.machine is not None and bowl.machine != usual.machine
    centre = schema.unbalance_values(bowl.machine) if has_machine else {}
    own: dict[str, Setting] = {}
    fields: set[str] = set()
    for key in BOWL_KEYS:
        if key.field in fields:
            continue
        fields.add(key.field)
        if key.section == "machine" and key.word in schema.UNBALANCE_NAMES:
            value, as_usual = centre.get(key.word), None
        else:
            value, as_usual = _field(bowl, key), _field(usual, key)
        is_told = key.name in ALWAYS or (has_machine and key.field.startswith("machine."))
        if value is None or (value == as_usual and not is_told):
            continue
        own[key.name] = Setting(key, _value_text(key, value), value, NAME)
    chain = (of_device(place, device) for place, device in enumerate(bowl.devices, start=1))
    return effective(own | {s.key.name: s for s in chain})


def _field(bowl: Bowl, key: Key) -> Any:
    """The value of the field of a key [SI, of the field's share], None where it is left out."""
    section, _, word = key.field.rpartition(".")
    holder: Any = getattr(bowl, section) if section else bowl
    value = None if holder is None else getattr(holder, word)
    if isinstance(value, np.ndarray):
        raise FeederError(NAME, f"{key.name} is an array", "give one value of it")
    return value


def _value_text(key: Key, value: Any) -> str:
    """A value as a file writes it: in the key's unit where that gives the same number, else in SI units."""
    if key.choices:
        return str(value)
    scale = units.factor(key.unit, key.dimension)
    for number in (f"{value / scale:.{DIGITS}g}", repr(float(value / scale))):
        text = f"{number} {key.unit}".rstrip()
        if key.value(text) == value:
            return text
    unit = next((unit for unit, size in units.UNITS_BY_DIMENSION[key.dimension].items() if size == 1.0), "")
    return f"{float(value)!r} {unit}".rstrip()
