"""The devices along the track, as a bowl file lists them."""

import math
from collections.abc import Container, Iterable, Sequence
from dataclasses import fields, is_dataclass, replace

from feederscrew.base import documents, units
from feederscrew.base.documents import Entry
from feederscrew.base.errors import ConfigError, FeederError
from feederscrew.bowl.devices.base import WRITTEN_STEP_M, Device
from feederscrew.bowl.devices.trade import Action
from feederscrew.bowl.devices.values import written

DEVICES_SECTION = "devices"  # of a bowl file
THREADED_SHANK = (  # files of bolts often have the minor diameter of the thread as shank
    "rails fit the shank of the file; a thread is as thick as its major diameter - check the file's shank"
)
WRITTEN_SHARE = 1e-6  # [1] of a value, within which it is that of its text


def listed(entry: Entry, faults: list[FeederError]) -> tuple[Device, ...]:
    """Return the devices of a bowl file's list, in the order parts meet them.

    Parameters
    ----------
    entry : Entry
        Of the key ``devices``.
    faults : list of FeederError
        The faults of the list are added to it.

    Returns
    -------
    tuple of Device
        Those that could be read.
    """
    if entry.value.kind != "list":
        faults.append(ConfigError(entry.where, "devices is not a list", "write one '- wiper: 6 mm' a line"))
        return ()
    devices_read = []
    for item in entry.value.items:
        try:
            devices_read.append(_device(item))
        except ConfigError as fault:
            faults.append(fault)
    return tuple(devices_read)


def misplaced(chain: Sequence[Device], width: float) -> list[ConfigError]:
    """Return the faults of devices that do not fit their track, or that those before them leave no meaning.

    Parameters
    ----------
    chain : sequence of Device
        In the order parts meet them.
    width : float [m]
        Of the track.

    Returns
    -------
    list of ConfigError

    References
    ----------
    docs/bowl_file.md.
    """
    return [fault for device in chain for fault in device.misfits(width)] + unfit(chain)


def unfit(chain: Sequence[Device]) -> list[ConfigError]:
    """Return the faults of devices where those before them leave them no meaning."""
    # behind rails, to parts that hang
    first = next((place for place, device in enumerate(chain) if device.action is Action.HANG), len(chain))
    faults = [
        ConfigError(
            device.where,
            f"{device.kind} has no meaning for parts that hang between rails",
            "list it before the rails",
        )
        for device in chain[first:]
        if not device.action.suits_hanging
    ]
    # in a groove, which holds parts on both its faces, where one is cut or stood over alone
    grooved = False
    for device in chain:
        grooved = device.action is Action.GROOVE or (grooved and device.action is not Action.BANK)
        if grooved and device.action.has_place and (not device.action.leans or device.on_side):
            mend = "list 'banked track: 6 deg' before it, which ends the groove"
            faults.append(ConfigError(device.where, f"{device.kind} stands in a groove", mend))
    # at a twist, behind which parts are on their side
    twisted = False
    for device in chain:
        if twisted and device.action.has_place and device.action is not Action.CLIMB:
            mend = "list the twist last, and leave it out of a file that is designed"
            faults.append(ConfigError(device.where, f"{device.kind} stands on a track that is twisted", mend))
        twisted = twisted or device.action is Action.TWIST
    return faults


def unknown_aspects(chain: Sequence[Device], aspects: Sequence[str]) -> list[str]:
    """Return remarks on yields that are of aspects which a part does not have.

    The file may be meant for other parts as well, so that is no fault.

    Parameters
    ----------
    chain : sequence of Device
    aspects : sequence of str
        Names of the part's aspects; case does not matter.

    Returns
    -------
    list of str
        A line each.
    """
    aspect_names = {name.casefold() for name in aspects}
    return [
        f"{device.where}: {device.kind} names aspect {units.quantity_text(name)}, "
        "which this part does not have"
        for device in chain
        for name, _ in device.shares
        if name.casefold() not in aspect_names
    ]


def shank_remarks(chain: Iterable[Device]) -> tuple[str, ...]:
    """Return what to say of a chain in which parts hang by their heads, a line; else nothing."""
    return (THREADED_SHANK,) if any(device.action is Action.HANG for device in chain) else ()


def value_text(device: Device) -> str:
    """Return the value of a device as a bowl file has it; a hole with its corners, as files move."""
    return device.value_text() if device.corners else device.text


def check_written(chain: Iterable[Device], name: str) -> None:
    """Refuse devices that a bowl file would not give back as they were tried.

    Each device is written as the file has it, read again, and compared attribute by attribute.

    Parameters
    ----------
    chain : iterable of Device
    name : str
        Of the file, for the fault.

    Returns
    -------
    None

    Raises
    ------
    FeederError
        If a text does not name a device, or some attribute of that device differs.
    """
    for device in chain:
        line = f"{device.kind}: {value_text(device)}"
        try:
            root, faults = documents.load(f"- {line}\n", name)
            documents.raise_all(faults)
            other = differences(device, _device(root.items[0]))
        except FeederError as fault:
            other = [fault.what]
        if other:
            what = f"'{units.one_line(line)}' is not the device that was tried: {'; '.join(other)}"
            raise FeederError(name, what, "this is a fault of feeder: report it with the command you gave")


def differences(
    first: object, second: object, unlike: Container[str] = ("where", "text", "assumption")
) -> list[str]:
    """Return in which attributes two records differ by more than the digits that a file has.

    Parameters
    ----------
    first, second : dataclass instances
    unlike : container of str
        Attributes that may differ: place and wording.

    Returns
    -------
    list of str
        A clause for each attribute; one alone where the records are of different classes.
    """
    if type(first) is not type(second):
        return [f"it is a {type(second).__name__} and not a {type(first).__name__}"]
    rows = ((field.name, getattr(first, field.name), getattr(second, field.name)) for field in fields(first))  # type: ignore[arg-type]
    return [
        f"{name} is {b!r} and not {a!r}"
        for name, a, b in rows
        if name not in unlike and not _same_device(a, b)
    ]


def _same_device(a: object, b: object) -> bool:
    """Return whether two values are equal but for the digits that a file has."""
    if isinstance(a, tuple) and isinstance(b, tuple):
        return len(a) == len(b) and all(map(_same_device, a, b))
    if isinstance(a, float | int) and isinstance(b, float | int):
        return math.isclose(a, b, rel_tol=WRITTEN_SHARE, abs_tol=0.51 * WRITTEN_STEP_M)
    if is_dataclass(a) and is_dataclass(b):
        return not differences(a, b)
    return a == b


def _device(item: documents.Node) -> Device:
    from feederscrew.bowl.devices.kinds import KINDS, find_kind  # 20 ms, where a bowl has devices

    if item.kind != "mapping" or len(item.entries) != 1:
        raise ConfigError(item.where, "is not a device", "write one '- wiper: 6 mm' a line")
    entry = item.entries[0]
    kind = find_kind(entry.key)
    if kind is None:
        what = f"unknown device {units.quantity_text(entry.key)}"
        raise ConfigError(entry.where, what, documents.hint(entry.key, list(KINDS)))
    named = replace(entry, key=kind.kind)  # faults of a file of before have the name of today
    return kind(entry.where, text=written(entry.value), **kind.read(named))
