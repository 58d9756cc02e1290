"""Bowl files and overrides, checked against the schema; every fault is reported with its place.

Bowls at several strokes, ``--amplitude 78%,80%``, and one key over a range, KEY=a:b:n.
"""

import itertools
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from os import PathLike
from pathlib import Path
from typing import Any

from feederscrew import documents, units
from feederscrew.bowl import devices, verified
from feederscrew.bowl.record import Bowl
from feederscrew.bowl.schema import BOWL_KEYS, BOWL_SECTIONS, BY_NAME, Key, rival
from feederscrew.bowl.settings import (
    OVERRIDES,
    Setting,
    chain,
    default,
    effective,
    of_device,
    record,
    replaced,
)
from feederscrew.documents import Entry, Node
from feederscrew.errors import ArgumentError, ConfigError, FeederError

SMALLEST = 1e-15  # [SI] a number nearer to 0 is 0: squared, or divided by, it would leave the range of floats
TOP_LEVEL = (
    *BOWL_SECTIONS,
    devices.DEVICES_SECTION,
    verified.VERIFIED_SECTION,
    *(key.name for key in BOWL_KEYS if not key.section),
)


def settings(path: str | PathLike[str] | None = None, overrides: Iterable[str] = ()) -> tuple[Setting, ...]:
    """Return every value in effect.

    Parameters
    ----------
    path : str or Path or None
        Bowl file; None for the defaults alone.
    overrides : sequence of str
        'drive.frequency=50 Hz'; the last of one key holds.

    Returns
    -------
    tuple of Setting
        One a key, in the order of ``schema.BOWL_KEYS``, then one a device.

    Raises
    ------
    Faults
        Every fault of the file and of the overrides, one a line; those of overrides are `ArgumentError`.
    """
    in_file, faults = ({}, []) if path is None else _from_file(path)
    return _overridden(in_file, overrides, faults)


def adjust(bowl: Bowl, overrides: Iterable[str]) -> Bowl:
    """Return a bowl with overrides over the settings that it was read from.

    A key that takes its value from another one follows it, as in a file: without ``friction.kinetic`` there,
    the override of ``friction.static`` is that of both. A bowl that was changed after it was read has its
    values alone: then an override replaces one value, and nothing follows.

    Parameters
    ----------
    bowl : Bowl
    overrides : sequence of str
        'drive.frequency=50 Hz'; the last of one key holds.

    Returns
    -------
    Bowl

    Raises
    ------
    Faults
        Every fault of the overrides; where a key of the machine is given for a bowl that was changed: what
        its drive would be is not known.
    """
    if bowl.settings:
        return record(_overridden({s.key.name: s for s in bowl.settings if s.is_own}, overrides, []))
    faults: list[FeederError] = []
    for setting in _from_overrides(overrides, faults).values():
        section, _, word = setting.key.field.rpartition(".")
        holder: Any = getattr(bowl, section) if section else bowl
        if section == "machine" or holder is None:
            what = "is given for a bowl that was changed after it was read"
            faults.append(ArgumentError(setting.where, what, "give it to read_bowl"))
            continue
        changed = replace(holder, **{word: setting.value if setting.key.choices else setting.size})
        fields: dict[str, Any] = {section: changed}
        bowl = replace(bowl, **fields) if section else changed
    if bowl.friction.kinetic > bowl.friction.static:
        what = f"friction.kinetic {bowl.friction.kinetic:g} is above friction.static {bowl.friction.static:g}"
        faults.append(ArgumentError(OVERRIDES, what, "give both of them"))
    documents.raise_all([*faults, *devices.misplaced(bowl.devices, bowl.track.width)])
    return bowl


def _overridden(
    in_file: Mapping[str, Setting], overrides: Iterable[str], faults: list[FeederError]
) -> tuple[Setting, ...]:
    """Every value in effect of what is given and of overrides; raises all faults together."""
    typed = _from_overrides(overrides, faults)
    settings_by_key = {name: s for name, s in in_file.items() if not replaced(s.key, typed)} | typed
    in_effect = effective(settings_by_key)
    faults += [
        *_kinetic_above_static(settings_by_key),
        *devices.misplaced(chain(in_effect), _width(in_effect)),
    ]
    documents.raise_all(faults)
    return in_effect


def settings_of_text(text: str, name: str) -> tuple[Setting, ...]:
    """Return every value in effect of the text of a bowl file; the rest as for ``settings``."""
    settings_by_key, faults = _settings_of(*documents.load(text, name))
    in_effect = effective(settings_by_key)
    faults += [
        *_kinetic_above_static(settings_by_key),
        *devices.misplaced(chain(in_effect), _width(in_effect)),
    ]
    documents.raise_all(faults)
    return in_effect


def _width(lines: Iterable[Setting]) -> float:
    return next(s.value for s in lines if s.key.name == "track.width")


def checked(
    key: Key, text: str, where: str, *, bare: bool = False, kind: type[ConfigError] = ConfigError
) -> Setting:
    """Return one value as a Setting.

    Parameters
    ----------
    key : Key
    text : str
        As typed.
    where : str
        For the fault, which names the key itself unless ``where`` does.
    bare : bool
        Whether a number without a unit is taken in ``key.unit``.
    kind : type of ConfigError
        Of the fault: `ArgumentError` where ``where`` begins with the name of an argument.

    Returns
    -------
    Setting

    Raises
    ------
    ConfigError
        If it is not a quantity of the key's dimension and range.
    """
    subject = "" if where.endswith(key.name) else f"{key.name}: "
    try:
        unit = key.unit if bare else None
        value: Any = (
            key.value(text)
            if key.choices
            else units.quantity(text, key.dimension, suggest=key.unit, bare=unit)
        )
    except units.QuantityError as fault:
        raise kind(where, f"{subject}{fault.what}", fault.mend) from None
    if key.choices:
        return Setting(key, str(value), value, where)
    value = 0.0 if abs(value) < SMALLEST else value
    low, high = (units.quantity(limit, key.dimension) for limit in (key.lowest, key.highest))
    if not low <= value <= high:
        what = f"{subject}{units.quantity_text(text)} is out of range"
        raise kind(where, what, f"give {key.lowest} to {key.highest}")
    if key.dimension == "count" and value % 1.0:
        raise kind(where, f"{subject}{units.quantity_text(text)} is not a whole number", "give 9 or 10")
    return Setting(key, " ".join(text.split()), value, where)


def _from_file(path: str | PathLike[str]) -> tuple[dict[str, Setting], list[FeederError]]:
    return _settings_of(*documents.read(path))


def _settings_of(root: Node, faults: list[FeederError]) -> tuple[dict[str, Setting], list[FeederError]]:
    """Settings of the tree of a bowl file by key name, and what is wrong with it."""
    if root.kind != "mapping":
        raise ConfigError(root.where, "no 'key: value' line", "start from 'feeder config init'")
    settings_by_key: dict[str, Setting] = {}
    for entry in root.entries:
        if entry.key in BOWL_SECTIONS:
            _read_section(entry, settings_by_key, faults)
        elif entry.key in BY_NAME and not BY_NAME[entry.key].section:
            _read_value(BY_NAME[entry.key], entry, settings_by_key, faults)
        elif entry.key == devices.DEVICES_SECTION:
            settings_by_key |= {
                s.key.name: s for s in map(of_device, itertools.count(1), devices.listed(entry, faults))
            }
        elif entry.key != verified.VERIFIED_SECTION:
            faults.append(_unknown(entry, "", TOP_LEVEL))
    return settings_by_key, faults


def _read_section(section: Entry, settings_by_key: dict[str, Setting], faults: list[FeederError]) -> None:
    value = section.value
    if value.kind == "list" or value.text:
        what = f"'{section.key}' is a section, not a value"
        faults.append(ConfigError(value.where, what, f"indent its keys below '{section.key}:'"))
    words = [key.word for key in BOWL_KEYS if key.section == section.key]
    for entry in value.entries:
        if entry.key in words:
            _read_value(BY_NAME[f"{section.key}.{entry.key}"], entry, settings_by_key, faults)
        else:
            faults.append(_unknown(entry, section.key, words))


def _read_value(
    key: Key, entry: Entry, settings_by_key: dict[str, Setting], faults: list[FeederError]
) -> None:
    try:
        setting = _from_node(key, entry.value)
    except ConfigError as fault:
        faults.append(fault)
        return
    if replaced(key, settings_by_key):
        faults.append(_both(key, rival(key), entry.where))
    settings_by_key[key.name] = setting


def _from_node(key: Key, node: Node) -> Setting:
    if node.kind != "text":
        raise ConfigError(
            node.where, f"{key.name} is a {node.kind}", f"write one value, such as {default(key).text}"
        )
    if not node.text:
        raise ConfigError(node.where, f"{key.name} has no value", f"write {default(key).text}")
    return checked(key, node.text, node.where)


def _unknown(entry: Entry, section: str, key_names: Sequence[str]) -> ConfigError:
    """The fault of a key that does not exist here; it may exist elsewhere."""
    elsewhere = next((k for k in BOWL_KEYS if entry.key in (k.word, k.name) and k.section != section), None)
    mend = documents.hint(entry.key, key_names)
    if elsewhere is not None:
        mend = f"write {elsewhere.word} " + (
            f"below '{elsewhere.section}:'" if elsewhere.section else "without indent"
        )
    return ConfigError(entry.where, f"unknown key {units.quantity_text(entry.key)}", mend)


def _from_overrides(overrides: Iterable[str], faults: list[FeederError]) -> dict[str, Setting]:
    """Settings of overrides by key name; what is wrong is added to ``faults``."""
    settings_by_key: dict[str, Setting] = {}
    for override in overrides:
        try:
            setting = _from_override(override)
        except ConfigError as fault:
            faults.append(fault)
            continue
        if replaced(setting.key, settings_by_key):
            faults.append(_both(setting.key, rival(setting.key), setting.where, ArgumentError))
        settings_by_key[setting.key.name] = setting
    return settings_by_key


def _from_override(override: str) -> Setting:
    name, equals, text = override.partition("=")
    name = name.strip()
    where = f"{OVERRIDES} {units.one_line(name)}"
    if not equals:
        raise ArgumentError(where, "has no '='", 'write KEY=VALUE, as in "drive.frequency=50 Hz"')
    key = find_key(name, where)
    if not text.strip():
        raise ArgumentError(where, "has no value", f"write {default(key).text}")
    return checked(key, text, where, kind=ArgumentError)


def find_key(name: str, where: str) -> Key:
    """Return the key that an argument names.

    Parameters
    ----------
    name, where : str

    Returns
    -------
    Key

    Raises
    ------
    ArgumentError
        If there is no such key, or if a section or the devices are named.
    """
    if name in BY_NAME:
        return BY_NAME[name]
    if name in BOWL_SECTIONS:
        first = next(key.name for key in BOWL_KEYS if key.section == name)
        raise ArgumentError(where, f"'{name}' is a section, not a key", f"write one of its keys, as {first}")
    if name == devices.DEVICES_SECTION:
        raise ArgumentError(where, "devices are a list", "write them in a bowl file")
    raise ArgumentError(
        where, f"unknown key {units.quantity_text(name)}", documents.hint(name, list(BY_NAME))
    )


def _both(key: Key, other: Key | None, where: str, kind: type[ConfigError] = ConfigError) -> ConfigError:
    names = " and ".join(part.name for part in (key, other) if part is not None)
    return kind(where, f"{names} are both given", "keep one of them")


def _kinetic_above_static(settings_by_key: dict[str, Setting]) -> list[ConfigError]:
    """The faults of kinetic coefficients above static ones, each reported at the last word on either."""
    held = {s.key.name: s for s in effective(settings_by_key)}
    listed = []
    for suffix in ("", "_backward"):
        static, kinetic = held[f"friction.static{suffix}"], held[f"friction.kinetic{suffix}"]
        if kinetic.value > static.value and (static.is_own or kinetic.is_own):
            listed.append(_above(static, kinetic))
    return listed


def _above(static: Setting, kinetic: Setting) -> ConfigError:
    static_last = not kinetic.is_own or (static.overrides and not kinetic.overrides)
    last, other = (static, kinetic) if static_last else (kinetic, static)
    place = "given as well" if other.overrides else other.where
    what = f"{kinetic.key.name} {kinetic.text} is above {static.key.name} {static.text} ({place})"
    kind = ArgumentError if last.overrides else ConfigError
    return kind(last.where, what, "lower the kinetic coefficient or raise the static one")


AMPLITUDES_KEY = "amplitudes"
MAX_STROKES = 50  # strokes of one call
FULL = 5.0  # of the bowl's own amplitude, at most


def at_strokes(bowl: Bowl, text: str | None = None) -> tuple[Bowl, ...]:
    """Return the bowl at each amplitude of its drive.

    Parameters
    ----------
    bowl : Bowl
    text : str or None
        '78%,80%,82%' of the bowl's own amplitude, or '0.3 mm,0.4 mm'; None for that one alone.

    Returns
    -------
    tuple of Bowl

    Raises
    ------
    ConfigError
        If an entry is neither, or out of range.
    """
    if text is None:
        return (bowl,)
    entries = text.split(",")
    if len(entries) > MAX_STROKES:
        raise ArgumentError(AMPLITUDES_KEY, f"{len(entries)} amplitudes", f"give at most {MAX_STROKES}")
    amplitudes = [_amplitude(bowl.drive.amplitude, entry) for entry in entries]
    return tuple(replace(bowl, drive=replace(bowl.drive, amplitude=amplitude)) for amplitude in amplitudes)


def bowl_names(paths: Sequence[str | None]) -> list[str]:
    """Return what bowl files are called side by side: their stems, their paths where two stems are the same.

    Parameters
    ----------
    paths : sequence of (str or None)
        None for the defaults.

    Returns
    -------
    list of str
    """
    stems = ["defaults" if path is None else Path(path).stem for path in paths]
    if len(set(stems)) == len(stems):
        return stems
    return [stem if path is None else str(path) for stem, path in zip(stems, paths)]


def _amplitude(full: float, entry: str) -> float:
    if not entry.strip().endswith("%"):
        try:
            return checked(BY_NAME["drive.amplitude"], entry, AMPLITUDES_KEY).value
        except ConfigError as fault:
            raise ArgumentError(fault.where, fault.what, fault.mend) from None
    try:
        share = units.quantity(entry, "number")
    except units.QuantityError as fault:
        raise ArgumentError(AMPLITUDES_KEY, fault.what, fault.mend) from None
    if not 0.0 <= share <= FULL:
        raise ArgumentError(
            AMPLITUDES_KEY,
            f"{units.quantity_text(entry)} is out of range",
            f"give 0% to {FULL:.0%} of drive.amplitude",
        )
    return share * full


MAX_RANGE_VALUES = 2000  # values of one key


@dataclass(frozen=True)
class KeyRange:
    """Evenly spaced values of one key."""

    key: Key
    values: tuple[float, ...]  # [SI]


def key_ranges(texts: Iterable[str]) -> tuple[KeyRange, ...]:
    """Return the ranges of one command.

    Parameters
    ----------
    texts : sequence of str
        'drive.vibration_angle=5:60:200': from 5 to 60 in 200 values. Both ends may carry a
        unit, '0.05mm:0.6mm:20'; without one they are in the unit of the key's limits.

    Returns
    -------
    tuple of KeyRange

    Raises
    ------
    Faults
        Every fault of every text, one a line; also a field varied twice.
    """
    ranges: dict[str, KeyRange] = {}
    faults: list[ConfigError] = []
    for text in texts:
        try:
            key_range = _range(text)
            if key_range.key.field in ranges:
                raise ArgumentError(
                    f"vary {key_range.key.name}", "is varied twice", "vary two different keys"
                )
            ranges[key_range.key.field] = key_range
        except ConfigError as fault:
            faults.append(fault)
    documents.raise_all(faults)
    return tuple(ranges.values())


def _range(text: str) -> KeyRange:
    name, _, span = (part.strip() for part in text.partition("="))
    where = f"vary {units.one_line(name)}"
    key = find_key(name, where)
    if key.choices:
        raise ArgumentError(where, "is a word, not a number", f"set it to {key.bounds}")
    ends = span.split(":")
    if len(ends) != 3:
        what = f"{units.quantity_text(span)} is not a range"
        raise ArgumentError(where, what, f"write FROM:TO:COUNT, as in {name}={_example(key)}")
    low, high = (checked(key, end, where, bare=True, kind=ArgumentError).value for end in ends[:2])
    if low == high:
        raise ArgumentError(where, "begins where it ends", "give two different values, or set the one")
    steps = _range_count(ends[2], where) - 1
    return KeyRange(key, tuple((low * (steps - i) + high * i) / steps for i in range(steps + 1)))


def _range_count(text: str, where: str) -> int:
    if text.strip().isascii() and text.strip().isdigit() and 2 <= int(text.strip()[:9]) <= MAX_RANGE_VALUES:
        return int(text.strip())
    raise ArgumentError(
        where,
        f"{units.quantity_text(text)} is not a count",
        f"give a whole number from 2 to {MAX_RANGE_VALUES}",
    )


def _example(key: Key) -> str:
    return f"{key.lowest}:{key.highest}:20".replace(" ", "")
