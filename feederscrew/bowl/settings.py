"""The values in effect: what the user gave, completed by the defaults, each with where it came from."""

import dataclasses
from collections.abc import Container, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from feederscrew import units
from feederscrew.bowl import schema
from feederscrew.bowl.devices import DEVICES_SECTION
from feederscrew.bowl.record import Bowl, Drive, Friction, Machine, Sizing, Track, vibration_angle
from feederscrew.bowl.schema import BOWL_KEYS, BY_NAME, OPTIONAL, Key, rival
from feederscrew.tooling.devices.base import Device

RECORDS = {"drive": Drive, "friction": Friction, "track": Track, "machine": Machine, "sizing": Sizing}
OVERRIDES = "overrides"  # the argument that goes over the file; ``--set`` of the commands
OF_THE_MACHINE = ("drive.vibration_angle", "drive.frequency")  # keys that a machine gives, where there is one
DEPENDENT_KEYS = {
    f"{name}.{field.name}"
    for name, kind in RECORDS.items()
    for field in dataclasses.fields(kind)
    if field.default is None
}


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
        """What the field of the record holds [SI], of a key that is no word."""
        return self.value * self.key.share

    @property
    def overrides(self) -> bool:
        """Whether it goes over the file."""
        return self.is_own and self.where == f"{OVERRIDES} {self.key.name}"

    @property
    def origin(self) -> str:
        """Where it came from, for people: 'bowl.yaml:2', '--set', 'default'."""
        if not self.is_own:
            return self.where
        return "--set" if self.overrides else self.where.rpartition(":")[0]


def effective(own_settings: Mapping[str, Setting]) -> tuple[Setting, ...]:
    """Return complete settings.

    Parameters
    ----------
    own_settings : dict of str to Setting
        What the user gave, by key name; of two keys of one field at most one.

    Returns
    -------
    tuple of Setting
        One a key, in the order of ``schema.BOWL_KEYS``, then one a device.
    """
    keyed = tuple(_effective(key, own_settings) for key in BOWL_KEYS)
    return (*keyed, *(s for name, s in own_settings.items() if name not in BY_NAME))


def of_device(place: int, device: Device) -> Setting:
    """Return a device as the Setting 'devices.1', for people: 'gap: 9 mm'."""
    key = Key(f"{DEVICES_SECTION}.{place}", DEVICES_SECTION, "", "", "", "", device.meaning)
    return Setting(key, f"{device.kind}: {device.text}", device, device.where)


def chain(settings: Iterable[Setting]) -> tuple[Device, ...]:
    """Return the devices (Device, ...) among settings, in the order parts meet them."""
    return tuple(s.value for s in settings if s.key.field == DEVICES_SECTION)


def record(settings: Sequence[Setting]) -> Bowl:
    """Return the Bowl of complete settings; a field is an array where its setting's value is one.

    A field that may be None, 'as the other one', stays so until its key is given: a Bowl in which the other
    is replaced later must not keep the old value.
    """
    keyed = [s for s in settings if s.key.field != DEVICES_SECTION]
    fields = {s.key.field: s.value if s.key.choices else s.size for s in keyed}
    fields |= {s.key.field: None for s in keyed if s.key.field in DEPENDENT_KEYS and not s.is_own}
    sections: dict[str, dict[str, Any]] = {name: {} for name in RECORDS}
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


def swept(settings: Sequence[Setting], values: Mapping[str, Any]) -> Bowl:
    """Return the Bowl of settings of which some are varied.

    Parameters
    ----------
    settings : tuple of Setting
    values : dict of str to array_like [SI]
        By key name; arrays that broadcast together. A key that takes its value from
        a varied one varies with it.

    Returns
    -------
    Bowl
        Varied fields are those arrays.
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
    """Return whether a key of what moves the bowl is among those given; its bolts do not.

    Parameters
    ----------
    own_settings : dict of str to Setting
        By key name.
    """
    return any(name in BY_NAME and BY_NAME[name].field.startswith("machine.") for name in own_settings)


def assumptions(settings: Sequence[Setting]) -> tuple[str, ...]:
    """Return what was taken for granted as devices were read, a sentence each."""
    return tuple(device.assumption for device in chain(settings) if device.assumption)


def remarks(settings: Sequence[Setting]) -> tuple[str, ...]:
    """Return what a user must not overlook in a bowl file, a sentence each."""
    return (*by_machine(settings), *assumptions(settings))


def by_machine(settings: Sequence[Setting]) -> tuple[str, ...]:
    """Return what a machine of which little is given makes of the drive, a tuple of at most one sentence.

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
        return ()
    first_key = next(name for name in BY_NAME if name in own_settings and has_machine({name}))
    return (
        f"{first_key}: is given, so {' and '.join(moved)} - write drive.frequency and drive.vibration_angle",
    )


def default(key: Key) -> Setting:
    """Return the Setting of a key while the user gives nothing."""
    return _effective(key, {})


def replaced(key: Key, own_settings: Container[str]) -> bool:
    """Return whether another key of the same field is given."""
    other = rival(key)
    return other is not None and other.name in own_settings


def _effective(key: Key, own_settings: Mapping[str, Setting]) -> Setting:
    if key.name in own_settings:
        return own_settings[key.name]
    other = rival(key)
    if other is not None and (replaced(key, own_settings) or key.default == other.name):
        return _converted(key, _effective(other, own_settings))
    if key.name in OF_THE_MACHINE and has_machine(own_settings):
        return _of_the_machine(key, own_settings)
    if key.name == "machine.supply" and "machine.mains" in own_settings:
        text = f"{own_settings['machine.mains'].text} full wave"
        return Setting(key, text, key.value(text), "from machine.mains", is_own=False)
    if key.default in BY_NAME:
        source = _effective(BY_NAME[key.default], own_settings)
        return Setting(key, source.text, source.value, f"as {key.default}", is_own=False)
    return Setting(key, key.default, key.value(key.default), "default", is_own=False)


def _converted(key: Key, source: Setting) -> Setting:
    """The same field said by its other key."""
    value = source.value * source.key.share / key.share
    text = f"{value / units.factor(key.unit, key.dimension):.6g} {key.unit}" if source.text else ""
    return Setting(key, text, value, f"from {source.key.name}", is_own=False)


def _of_the_machine(key: Key, own_settings: Mapping[str, Setting]) -> Setting:
    """The value that a machine's springs or its supply give to a key of the drive."""
    if key.name == "drive.frequency":
        supply = _effective(BY_NAME["machine.supply"], own_settings)
        return _derived(key, supply.value, "from machine.supply")
    own = [
        key_of_machine
        for key_of_machine in BOWL_KEYS
        if key_of_machine.field.startswith("machine.") and key_of_machine.word not in schema.UNBALANCE_NAMES
    ]
    names = [key_of_machine.name for key_of_machine in own]
    machine = Machine(
        **{name.partition(".")[2]: _effective(BY_NAME[name], own_settings).value for name in names}
    )
    radius, climb = (
        _effective(BY_NAME[name], own_settings).value for name in ("track.radius", "track.climb")
    )
    return _derived(key, vibration_angle(machine, radius, climb), "from machine")


def _derived(key: Key, value: Any, where: str) -> Setting:
    text = "" if np.ndim(value) else f"{value / units.factor(key.unit, key.dimension):.6g} {key.unit}"
    return Setting(key, text, value, where, is_own=False)
