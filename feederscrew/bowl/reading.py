"""The values in effect of a bowl: those of a file and of overrides, checked against the schema, and defaults.

Every fault is reported with its place. Bowls at several strokes, ``--amplitude 78%,80%``, and one key over a
range, KEY=a:b:n.
"""

import dataclasses
import itertools
from collections.abc import Container, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

from feederscrew.base import check, documents, units
from feederscrew.base.columns import Column
from feederscrew.base.documents import Entry, Node
from feederscrew.base.errors import ArgumentError, ConfigError, FeederError
from feederscrew.base.geometry.grids import GridAxis
from feederscrew.base.signatures import Keywords
from feederscrew.bowl import device_list as devices
from feederscrew.bowl import friction_table, schema, verified
from feederscrew.bowl.devices.base import Device
from feederscrew.bowl.record import Bowl, BowlGrid, Drive, Friction, Machine, Sizing, Track, vibration_angle
from feederscrew.bowl.schema import BOWL_KEYS, BOWL_SECTIONS, BY_NAME, OPTIONAL, Key, rival

DEVICES_SECTION = devices.DEVICES_SECTION
RECORDS = {"drive": Drive, "friction": Friction, "track": Track, "machine": Machine, "sizing": Sizing}
OVERRIDES = "overrides"  # the argument that goes over the file; ``--set`` of the commands
OF_THE_MACHINE = ("drive.vibration_angle", "drive.frequency")  # keys that a machine gives, where there is one
DEPENDENT_KEYS = {
    f"{name}.{field.name}"
    for name, kind in RECORDS.items()
    for field in dataclasses.fields(kind)
    if field.default is None
}
TABLED_WORDS = ("static", "kinetic", "static_backward", "kinetic_backward")
FROM_LINING = "from friction.lining"  # where a coefficient is from
SMALLEST = 1e-15  # [SI] a number nearer to 0 is 0: squared, or divided by, it would leave the range of floats
TOP_LEVEL = (
    *BOWL_SECTIONS,
    devices.DEVICES_SECTION,
    verified.VERIFIED_SECTION,
    *(key.name for key in BOWL_KEYS if not key.section),
)


@dataclass(frozen=True, eq=False)
class Setting:
    """The value in effect of one key."""

    key: Key
    text: str  # as typed: '0.5 mm'
    value: Any  # [SI] a number, or an array while the key is varied; a word; a Device
    where: str  # 'bowl.yaml:2:14', 'overrides drive.amplitude', 'default', 'as friction.static'
    is_own: bool = True  # by the user

    @property
    def size(self) -> Any:
        """Return what the field of the record holds [SI], of a key that is no word."""
        return self.value * self.key.share

    @property
    def overrides(self) -> bool:
        """Return whether it goes over the file."""
        return self.is_own and self.where == f"{OVERRIDES} {self.key.name}"

    @property
    def origin(self) -> str:
        """Where it came from, for people: 'bowl.yaml:2', '--set', 'default'."""
        if not self.is_own:
            return self.where
        return "--set" if self.overrides else self.where.rpartition(":")[0]


SETTING_COLUMNS: tuple[Column[Setting], ...] = (
    Column("key", lambda setting: setting.key.name),
    Column("value", lambda setting: setting.text),
    Column("from", lambda setting: setting.origin),
    Column("lowest", lambda setting: setting.key.lowest),
    Column("highest", lambda setting: setting.key.highest),
    Column("meaning", lambda setting: setting.key.meaning),
)


def settings(path: str | PathLike[str] | None = None, overrides: Iterable[str] = ()) -> tuple[Setting, ...]:
    """Return every value in effect: of a bowl file, or the defaults, and of overrides over it.

    Parameters
    ----------
    path : str or path, optional
        Of a bowl file; without it the defaults.
    overrides : iterable of str
        'drive.frequency=50 Hz'; of one key the last holds.

    Returns
    -------
    tuple of Setting
        One a key, in the order of ``schema.BOWL_KEYS``, then one a device.

    Raises
    ------
    Faults
        Every fault of the file and of the overrides, one a line; those of overrides are `ArgumentError`.
    """
    in_file, faults = ({}, []) if path is None else _settings_of(*documents.read(path))
    return _overridden(in_file, overrides, faults)


def settings_of_text(text: str, name: str) -> tuple[Setting, ...]:
    """Return every value in effect of the text of a bowl file.

    Parameters
    ----------
    text : str
        YAML.
    name : str
        What a fault calls the text.

    Returns
    -------
    tuple of Setting
        As of ``settings``.

    Raises
    ------
    Faults
        Every fault of the text, one a line.
    """
    in_text, faults = _settings_of(*documents.load(text, name))
    return _overridden(in_text, (), faults)


def adjust(bowl: Bowl, overrides: Iterable[str]) -> Bowl:
    """Return a bowl with overrides over the settings that it was read from.

    A key that takes its value from another one follows it, as in a file: without ``friction.kinetic`` there,
    the override of ``friction.static`` is that of both. A bowl that was changed after it was read has its
    values alone: then an override replaces one value, and nothing follows.

    Parameters
    ----------
    bowl : Bowl
    overrides : iterable of str
        'drive.frequency=50 Hz'.

    Returns
    -------
    Bowl

    Raises
    ------
    Faults
        Every fault of the overrides, one a line. Among them is a key of the machine for a bowl that was
        changed, because its drive is then not known.
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
        fields: Keywords = {section: changed}
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
    by_name = {s.key.name: s for s in in_effect}
    for suffix in ("", "_backward"):  # each fault is reported at the last word on either coefficient
        static, kinetic = by_name[f"friction.static{suffix}"], by_name[f"friction.kinetic{suffix}"]
        if kinetic.value > static.value and (static.is_own or kinetic.is_own):
            static_last = not kinetic.is_own or (static.overrides and not kinetic.overrides)
            last, other = (static, kinetic) if static_last else (kinetic, static)
            place = "given as well" if other.overrides else other.where
            what = f"{kinetic.key.name} {kinetic.text} is above {static.key.name} {static.text} ({place})"
            kind = ArgumentError if last.overrides else ConfigError
            faults.append(kind(last.where, what, "lower the kinetic coefficient or raise the static one"))
    documents.raise_all([*faults, *devices.misplaced(chain(in_effect), by_name["track.width"].value)])
    return in_effect


def effective(own_settings: Mapping[str, Setting]) -> tuple[Setting, ...]:
    """Return complete settings of what the user gave, by key name; of two keys of one field at most one.

    They are one a key, in the order of ``schema.BOWL_KEYS``, then one a device.
    """
    keyed = tuple(_effective(key, own_settings) for key in BOWL_KEYS)
    return (*keyed, *(s for name, s in own_settings.items() if name not in BY_NAME))


def of_device(place: int, device: Device) -> Setting:
    """Return a device as a setting, for people: 'devices.1', 'gap: 9 mm'.

    Parameters
    ----------
    place : int
        In the list, from 1.
    device : Device

    Returns
    -------
    Setting
    """
    key = Key(f"{DEVICES_SECTION}.{place}", DEVICES_SECTION, "", "", "", "", device.trade.meaning)
    return Setting(key, f"{device.kind}: {device.text}", device, device.where)


def chain(settings: Iterable[Setting]) -> tuple[Device, ...]:
    """Return the devices (Device, ...) among settings, in the order parts meet them."""
    return tuple(s.value for s in settings if s.key.field == DEVICES_SECTION)


def record(settings: Sequence[Setting]) -> Bowl:
    """Return the bowl of complete settings; a field is an array where its setting's value is one.

    A field that may be None, 'as the other one', stays so until its key is given. A bowl in which the other
    is replaced later must not keep the old value.

    Parameters
    ----------
    settings : sequence of Setting
        As of ``settings``.

    Returns
    -------
    Bowl

    Raises
    ------
    FeederError
        If no body has the machine's centre of mass, moments and products of inertia.
    """
    keyed = [s for s in settings if s.key.field != DEVICES_SECTION]
    fields = {s.key.field: s.value if s.key.choices else s.size for s in keyed}
    kept = [s for s in keyed if s.is_own or s.where == FROM_LINING]
    fields |= {s.key.field: None for s in keyed if s.key.field in DEPENDENT_KEYS and s not in kept}
    sections: dict[str, Keywords] = {name: {} for name in RECORDS}
    for name, value in fields.items():
        section, _, word = name.rpartition(".")
        sections.setdefault(section, {})[word] = value
    sections["machine"] = schema.with_unbalance(sections["machine"], sections["sizing"]["hand"])
    top_level = sections.pop("")
    bowl = Bowl(
        **{name: RECORDS[name](**values) for name, values in sections.items()},
        **top_level,
        devices=chain(settings),
    )
    object.__setattr__(bowl, "settings", tuple(settings))
    return bowl


def swept(settings: Sequence[Setting], values: Mapping[str, Any]) -> BowlGrid:
    """Return the bowl of settings of which some are varied, and with them the keys that follow these.

    Parameters
    ----------
    settings : sequence of Setting
        As of ``settings``.
    values : mapping of str to array [SI]
        By key name; the arrays broadcast together.

    Returns
    -------
    BowlGrid
        The varied fields are those arrays.
    """
    varied = {name: Setting(BY_NAME[name], "", value, "varied") for name, value in values.items()}
    own_settings = {s.key.name: s for s in settings if s.is_own and not replaced(s.key, varied)}
    return record(effective(own_settings | varied))


def texts(settings: Sequence[Setting]) -> dict[str, str]:
    """Return the settings by key name as text, for run.json; without an optional section not given."""
    listed = {s.key.section for s in settings if s.is_own}
    silent = [name for name in OPTIONAL if name not in listed]
    return {s.key.name: s.text for s in settings if s.key.section not in silent}


def has_machine(own_settings: Iterable[str]) -> bool:
    """Return whether a key of what moves the bowl is among those given, by name; its bolts do not."""
    return any(name in BY_NAME and BY_NAME[name].field.startswith("machine.") for name in own_settings)


def assumptions(settings: Sequence[Setting]) -> tuple[str, ...]:
    """Return what was taken for granted as devices were read, a sentence each."""
    return tuple(device.assumption for device in chain(settings) if device.assumption)


def remarks(settings: Sequence[Setting]) -> tuple[str, ...]:
    """Return what a user must not overlook in a bowl file, a sentence each.

    As soon as one key of the machine is given, its springs and its supply set the drive: whoever gives
    neither may not expect that.
    """
    own_settings = {s.key.name for s in settings if s.is_own}
    set_by = {"drive.frequency": "machine.supply", "drive.vibration_angle": "machine.spring_angle"}
    moved = [
        f"{s.key.name} is {s.text} by the machine, not {default(s.key).text}"
        for s in settings
        if has_machine(own_settings)
        and s.where.startswith("from machine")
        and set_by.get(s.key.name) not in own_settings
    ]
    if not moved:
        return assumptions(settings)
    first_key = next(name for name in BY_NAME if name in own_settings and has_machine({name}))
    mend = "write drive.frequency and drive.vibration_angle"
    return f"{first_key}: is given, so {' and '.join(moved)} - {mend}", *assumptions(settings)


def default(key: Key) -> Setting:
    """Return the Setting of a key while the user gives nothing."""
    return _effective(key, {})


def replaced(key: Key, own_settings: Container[str]) -> bool:
    """Return whether another key of the same field is given, as ``peak_to_peak`` for ``amplitude``.

    Parameters
    ----------
    key : Key
    own_settings : container of str
        Names of the keys that are given.

    Returns
    -------
    bool
    """
    other = rival(key)
    return other is not None and other.name in own_settings


def _effective(key: Key, own_settings: Mapping[str, Setting]) -> Setting:
    if key.name in own_settings:
        return own_settings[key.name]
    other = rival(key)
    if other is not None and (replaced(key, own_settings) or key.default == other.name):
        # the same field said by its other key
        source = _effective(other, own_settings)
        converted = _derived(key, source.value * source.key.share / key.share, f"from {source.key.name}")
        return converted if source.text else replace(converted, text="")
    if key.name == "drive.frequency" and has_machine(own_settings):
        supply = _effective(BY_NAME["machine.supply"], own_settings)
        return _derived(key, supply.value, "from machine.supply")
    if key.name == "drive.vibration_angle" and has_machine(own_settings):
        own = [each for each in BOWL_KEYS if each.field.startswith("machine.")]
        own = [each for each in own if each.word not in schema.UNBALANCE_NAMES]
        machine = Machine(**{each.word: _effective(each, own_settings).value for each in own})
        names = ("track.radius", "track.climb")
        radius, climb = (_effective(BY_NAME[name], own_settings).value for name in names)
        return _derived(key, vibration_angle(machine, radius, climb), "from machine")
    if key.name == "machine.supply" and "machine.mains" in own_settings:
        text = f"{own_settings['machine.mains'].text} full wave"
        return Setting(key, text, key.value(text), "from machine.mains", is_own=False)
    tabled = _tabled(key, own_settings)
    if tabled is not None:
        return tabled
    if key.default in BY_NAME:
        followed = _effective(BY_NAME[key.default], own_settings)
        return Setting(key, followed.text, followed.value, f"as {key.default}", is_own=False)
    return Setting(key, key.default, key.value(key.default), "default", is_own=False)


def _tabled(key: Key, own_settings: Mapping[str, Setting]) -> Setting | None:
    """A coefficient of friction by the lining of the track; None where one is given, or no lining is."""
    word = key.name.removeprefix("friction.")
    if word not in TABLED_WORDS or any(f"friction.{name}" in own_settings for name in TABLED_WORDS):
        return None
    family, lining = (
        _effective(BY_NAME[f"friction.{name}"], own_settings).value for name in ("part_material", "lining")
    )
    own = friction_table.find_friction(family, lining)
    value = None if own is None else getattr(own, word)
    if value is None:
        return None
    return Setting(key, f"{value:g}", value, FROM_LINING, is_own=False)


def with_part_material(settings: Sequence[Setting], material: str) -> tuple[Setting, ...]:
    """Return settings in which the table of friction takes a part for what it is made of.

    Parameters
    ----------
    settings : sequence of Setting
        As of ``settings``.
    material : str
        Of the part: 'brass', 'pp'.

    Returns
    -------
    tuple of Setting
        The same where no lining is given, where the file says what parts are made of, or where the material
        is not known.
    """
    own_settings = {s.key.name: s for s in settings if s.is_own}
    family = friction_table.find_family(material)
    key = BY_NAME["friction.part_material"]
    if "friction.lining" not in own_settings or key.name in own_settings or family is None:
        return tuple(settings)
    return effective(
        own_settings | {key.name: Setting(key, str(family), str(family), f"{OVERRIDES} {key.name}")}
    )


def friction_remarks(settings: Sequence[Setting], material: str) -> tuple[str, ...]:
    """Return what the table of friction has for a part, where friction is the default: a line, or none.

    With a lining the line says which numbers were taken, and where they are from.

    Parameters
    ----------
    settings : sequence of Setting
        As of ``settings``, with the part's material.
    material : str
        Of the part.

    Returns
    -------
    tuple of str
    """
    by_name = {s.key.name: s for s in settings}
    static = by_name["friction.static"]
    family = friction_table.find_family(material)
    if static.where == FROM_LINING:
        words = by_name["friction.part_material"].text, by_name["friction.lining"].text
        own = friction_table.find_friction(*words)
        return () if own is None else (f"friction {_pair(own)} of {' on '.join(words)}: {own.source}",)
    given = any(by_name[f"friction.{word}"].is_own for word in TABLED_WORDS)
    own = None if family is None else friction_table.find_friction(family, friction_table.Lining.STEEL)
    if given or own is None or family == friction_table.PartMaterial.STEEL:
        return ()
    what = f"{static.text} is the default, of steel; for {family} on steel the table has {_pair(own)}"
    return (f"friction: {what} ({own.source}) - give --lining steel, or friction.static",)


def _pair(own: friction_table.TabledFriction) -> str:
    return f"{own.static:g} static and {own.kinetic:g} kinetic"


def _derived(key: Key, value: float, where: str) -> Setting:
    text = "" if np.ndim(value) else f"{value / units.factor(key.unit, key.dimension):.6g} {key.unit}"
    return Setting(key, text, value, where, is_own=False)


def checked(
    key: Key, text: str, where: str, *, bare: bool = False, kind: type[ConfigError] = ConfigError
) -> Setting:
    """Return one value as a setting, from its text as typed.

    Parameters
    ----------
    key : Key
        Dimension, range and unit, or the words to choose from.
    text : str
        '0.3 mm'.
    where : str
        Place for the fault. The fault names the key itself unless ``where`` ends with it.
    bare : bool
        Take a number without a unit in ``key.unit``.
    kind : class
        Of the fault: `ArgumentError` where ``where`` begins with the name of an argument.

    Returns
    -------
    Setting
        Its value in SI units, or the word. A value below ``SMALLEST`` is 0.

    Raises
    ------
    ConfigError
        Of the ``kind``, if the text is not a quantity of the key's dimension and range, or not one of its
        words.
    """
    subject = "" if where.endswith(key.name) else f"{key.name}: "
    try:
        if key.choices:
            word = str(key.value(text))
            return Setting(key, word, word, where)
        value = units.quantity(text, key.dimension, suggest=key.unit, bare=key.unit if bare else None)
    except units.QuantityError as fault:
        raise kind(where, f"{subject}{fault.what}", fault.mend, value=fault.value) from None
    value = 0.0 if abs(value) < SMALLEST else value
    low, high = (units.quantity(limit, key.dimension) for limit in (key.lowest, key.highest))
    if not low <= value <= high:
        what = f"{subject}{units.quantity_text(text)} is out of range"
        raise kind(where, what, f"give {key.lowest} to {key.highest}")
    if key.dimension == "count" and value % 1.0:
        raise kind(where, f"{subject}{units.quantity_text(text)} is not a whole number", "give 9 or 10")
    return Setting(key, " ".join(text.split()), value, where)


def _settings_of(root: Node, faults: list[FeederError]) -> tuple[dict[str, Setting], list[FeederError]]:
    """Settings of the tree of a bowl file by key name, and what is wrong with it."""
    if root.kind != "mapping":
        raise ConfigError(root.where, "no 'key: value' line", "start from 'feeder config init'")
    settings_by_key: dict[str, Setting] = {}
    for entry in root.entries:
        if entry.key in BOWL_SECTIONS:
            node, section = entry.value, entry.key
            if node.kind == "list" or node.text:
                what = f"'{section}' is a section, not a value"
                faults.append(ConfigError(node.where, what, f"indent its keys below '{section}:'"))
            words = [key.word for key in BOWL_KEYS if key.section == section]
            for inner in node.entries:
                if inner.key in words:
                    _read_value(BY_NAME[f"{section}.{inner.key}"], inner, settings_by_key, faults)
                else:
                    faults.append(_unknown(inner, section, words))
        elif entry.key in BY_NAME and not BY_NAME[entry.key].section:
            _read_value(BY_NAME[entry.key], entry, settings_by_key, faults)
        elif entry.key == devices.DEVICES_SECTION:
            chain_settings = map(of_device, itertools.count(1), devices.listed(entry, faults))
            settings_by_key |= {s.key.name: s for s in chain_settings}
        elif entry.key != verified.VERIFIED_SECTION:
            faults.append(_unknown(entry, "", TOP_LEVEL))
    return settings_by_key, faults


def _read_value(
    key: Key, entry: Entry, settings_by_key: dict[str, Setting], faults: list[FeederError]
) -> None:
    node = entry.value
    try:
        if node.kind != "text" or not node.text:
            is_text, example = node.kind == "text", default(key).text
            mend = f"write {example}" if is_text else f"write one value, such as {example}"
            what = "has no value" if is_text else f"is a {node.kind}"
            raise ConfigError(node.where, f"{key.name} {what}", mend)
        setting = checked(key, node.text, node.where)
    except ConfigError as fault:
        faults.append(fault)
        return
    if replaced(key, settings_by_key):
        faults.append(_both(key, entry.where))
    settings_by_key[key.name] = setting


def _unknown(entry: Entry, section: str, key_names: Sequence[str]) -> ConfigError:
    """The fault of a key that does not exist here; it may exist elsewhere."""
    elsewhere = next((k for k in BOWL_KEYS if entry.key in (k.word, k.name) and k.section != section), None)
    mend = documents.hint(entry.key, key_names)
    if elsewhere is not None:
        place = f"below '{elsewhere.section}:'" if elsewhere.section else "without indent"
        mend = f"write {elsewhere.word} {place}"
    return ConfigError(entry.where, f"unknown key {units.quantity_text(entry.key)}", mend)


def _from_overrides(overrides: Iterable[str], faults: list[FeederError]) -> dict[str, Setting]:
    """Settings of overrides by key name; what is wrong is added to ``faults``."""
    settings_by_key: dict[str, Setting] = {}
    for override in overrides:
        name, equals, text = (part.strip() for part in override.partition("="))
        where = f"{OVERRIDES} {units.one_line(name)}"
        try:
            if not equals:
                example = default(BY_NAME[name]).text if name in BY_NAME else ""
                whole = f"{name}={example}" if example else "drive.frequency=50 Hz"
                raise ArgumentError(where, "has no '='", f'write KEY=VALUE, as in "{whole}"', value=whole)
            key = find_key(name, where, text)
            if not text:
                example = default(key).text
                raise ArgumentError(where, "has no value", f"write {example}", value=f"{name}={example}")
            try:
                setting = checked(key, text, where, kind=ArgumentError)
            except ArgumentError as fault:
                mended = None if fault.value is None else f"{name}={fault.value}"
                raise ArgumentError(where, fault.what, fault.mend, value=mended) from None
        except ConfigError as fault:
            faults.append(fault)
            continue
        if replaced(key, settings_by_key):
            faults.append(_both(key, where, ArgumentError))
        settings_by_key[key.name] = setting
    return settings_by_key


def find_key(name: str, where: str, text: str = "") -> Key:
    """Return the key that an argument names.

    Parameters
    ----------
    name : str
        'drive.frequency'.
    where : str
        Place for the fault.
    text : str
        Value that was given with it, for a mended call in the fault.

    Returns
    -------
    Key

    Raises
    ------
    ArgumentError
        If there is none of that name, or a section or the devices are named.
    """
    if name in BY_NAME:
        return BY_NAME[name]
    if name in BOWL_SECTIONS:
        first = next(key.name for key in BOWL_KEYS if key.section == name)
        raise ArgumentError(where, f"'{name}' is a section, not a key", f"write one of its keys, as {first}")
    if name == DEVICES_SECTION:
        raise ArgumentError(where, "devices are a list", "write them in a bowl file")
    what, near = f"unknown key {units.quantity_text(name)}", documents.nearest(name, BY_NAME)
    value = f"{near}={text}" if near is not None and text else None
    raise ArgumentError(where, what, documents.hint(name, list(BY_NAME)), value=value)


def _both(key: Key, where: str, kind: type[ConfigError] = ConfigError) -> ConfigError:
    names = " and ".join(each.name for each in (key, rival(key)) if each is not None)
    return kind(where, f"{names} are both given", "keep one of them")


AMPLITUDES_KEY = "amplitudes"
MAX_STROKES = 50  # strokes of one call
FULL = 5.0  # of the bowl's own amplitude, at most


def at_strokes(bowl: Bowl, text: str | None = None) -> tuple[Bowl, ...]:
    """Return the bowl at each of some amplitudes.

    Parameters
    ----------
    bowl : Bowl
    text : str, optional
        '78%,80%,82%', shares of the bowl's own amplitude, or '0.3 mm,0.4 mm'.

    Returns
    -------
    tuple of Bowl
        In the order of the text, each amplitude once; the bowl alone without a text.

    Raises
    ------
    ConfigError
        If an entry is neither a share nor an amplitude, or out of range, or there are more than
        ``MAX_STROKES``.
    """
    if text is None:
        return (bowl,)
    entries, full = text.split(","), bowl.drive.amplitude
    if len(entries) > MAX_STROKES:
        raise ArgumentError(AMPLITUDES_KEY, f"{len(entries)} amplitudes", f"give at most {MAX_STROKES}")
    amplitudes = []
    for place, entry in enumerate(entries):
        if not entry.strip().endswith("%"):
            key = BY_NAME["drive.amplitude"]
            try:
                amplitudes.append(checked(key, entry, AMPLITUDES_KEY, kind=ArgumentError).value)
            except ArgumentError as fault:
                mended = [*entries[:place], fault.value, *entries[place + 1 :]] if fault.value else None
                value = ",".join(filter(None, mended)) if mended else None
                raise ArgumentError(AMPLITUDES_KEY, fault.what, fault.mend, value=value) from None
            continue
        try:
            share = units.quantity(entry, "number")
        except units.QuantityError as fault:
            raise ArgumentError(AMPLITUDES_KEY, fault.what, fault.mend) from None
        if not 0.0 <= share <= FULL:
            what = f"{units.quantity_text(entry)} is out of range"
            raise ArgumentError(AMPLITUDES_KEY, what, f"give 0% to {FULL:.0%} of drive.amplitude")
        amplitudes.append(share * full)
    each_once = dict.fromkeys(amplitudes)
    return tuple(replace(bowl, drive=replace(bowl.drive, amplitude=amplitude)) for amplitude in each_once)


def bowl_names(paths: Sequence[str | None]) -> list[str]:
    """Return what bowl files are called side by side; None stands for the defaults.

    That is their stems, or their paths where two stems are the same.
    """
    stems = ["defaults" if path is None else Path(path).stem for path in paths]
    if len(set(stems)) == len(stems):
        return stems
    return [stem if path is None else str(path) for stem, path in zip(stems, paths)]


MAX_RANGE_VALUES = 2000  # values of one key


@dataclass(frozen=True)
class KeyRange:
    """Evenly spaced values of one key."""

    key: Key
    values: tuple[float, ...]  # [SI]

    @property
    def axis(self) -> GridAxis:
        """Its values as an axis of a grid."""
        unit = units.factor(self.key.unit, self.key.dimension)
        return GridAxis(self.key.column, check.frozen(np.array(self.values)), unit, self.key.unit)


def key_ranges(texts: Iterable[str]) -> tuple[KeyRange, ...]:
    """Return the ranges of keys that are varied.

    Both ends may carry a unit, '0.05mm:0.6mm:20'; without one they are in the unit of the key's limits.
    Values lie evenly between the ends, both included.

    Parameters
    ----------
    texts : iterable of str
        'drive.vibration_angle=5:60:200', from 5 to 60 in 200 values.

    Returns
    -------
    tuple of KeyRange

    Raises
    ------
    Faults
        Every fault of every text, one a line; also a field that is varied twice.
    """
    ranges: dict[str, KeyRange] = {}
    faults: list[ConfigError] = []
    for text in texts:
        name, _, span = (part.strip() for part in text.partition("="))
        where = f"vary {units.one_line(name)}"
        try:
            key = find_key(name, where, span)
            if key.choices:
                raise ArgumentError(where, "is a word, not a number", f"set it to {key.bounds}")
            ends = [end.strip() for end in span.split(":")]
            if len(ends) != 3:
                example = f"{name}={key.lowest}:{key.highest}:20".replace(" ", "")
                what = f"{units.quantity_text(span)} is not a range"
                raise ArgumentError(where, what, f"write FROM:TO:COUNT, as in {example}")
            low, high = (checked(key, end, where, bare=True, kind=ArgumentError).value for end in ends[:2])
            if low == high:
                mend = "give two different values, or set the one"
                raise ArgumentError(where, "begins where it ends", mend)
            count = ends[2]
            if not (count.isascii() and count.isdigit() and 2 <= int(count[:9]) <= MAX_RANGE_VALUES):
                what = f"{units.quantity_text(count)} is not a count"
                raise ArgumentError(where, what, f"give a whole number from 2 to {MAX_RANGE_VALUES}")
            if key.field in ranges:
                raise ArgumentError(f"vary {key.name}", "is varied twice", "vary two different keys")
        except ConfigError as fault:
            faults.append(fault)
            continue
        steps = int(count) - 1
        values = tuple((low * (steps - i) + high * i) / steps for i in range(steps + 1))
        ranges[key.field] = KeyRange(key, values)
    documents.raise_all(faults)
    return tuple(ranges.values())
