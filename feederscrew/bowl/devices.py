"""The devices along the track, as a bowl file lists them."""

from collections.abc import Sequence

from feederscrew import documents, units
from feederscrew.documents import Entry
from feederscrew.errors import ConfigError, FeederError
from feederscrew.tooling.devices.base import Device
from feederscrew.tooling.devices.kinds import KINDS
from feederscrew.tooling.devices.values import written

SECTION = "devices"  # of a bowl file


def listed(entry: Entry, faults: list[FeederError]) -> tuple[Device, ...]:
    """Return the devices of a bowl file's list, in the order parts meet them.

    Parameters
    ----------
    entry : Entry
        ``devices:`` of the file.
    faults : list of FeederError
        What is wrong is added.

    Returns
    -------
    tuple of Device
    """
    if entry.value.kind != "list":
        faults.append(ConfigError(entry.where, "devices is not a list", "write one '- wiper: 6 mm' a line"))
        return ()
    found = []
    for item in entry.value.items:
        try:
            found.append(_device(item))
        except ConfigError as fault:
            faults.append(fault)
    return tuple(found)


def misplaced(chain: Sequence[Device], width: float) -> list[ConfigError]:
    """Return the faults of devices that do not fit a track.

    Parameters
    ----------
    chain : sequence of Device
    width : float [m]
        Of the track.

    Returns
    -------
    list of ConfigError
    """
    return [fault for device in chain for fault in device.misfits(width)] + unfit(chain)


def unfit(chain: Sequence[Device]) -> list[ConfigError]:
    """Return the faults of devices where those before them leave them no meaning.

    Parameters
    ----------
    chain : sequence of Device

    Returns
    -------
    list of ConfigError
    """
    return [*_beyond_rails(chain), *_in_grooves(chain)]


def _beyond_rails(chain: Sequence[Device]) -> list[ConfigError]:
    """Devices behind rails that mean nothing to parts that hang."""
    first = next((place for place, device in enumerate(chain) if device.hangs), len(chain))
    return [
        ConfigError(
            device.where,
            f"{device.kind} has no meaning for parts that hang between rails",
            "list it before the rails",
        )
        for device in chain[first:]
        if not device.hanging
    ]


def _in_grooves(chain: Sequence[Device]) -> list[ConfigError]:
    """Devices in a groove, which holds parts on both its faces, where one is cut or stood over alone."""
    faults, grooved = [], False
    for device in chain:
        grooved = grooved if device.grooved is None else device.grooved
        if grooved and device.placed and not device.leans:
            mend = "list 'bank: 6 deg' before it, which ends the groove"
            faults.append(ConfigError(device.where, f"{device.kind} stands in a groove", mend))
    return faults


def strangers(chain: Sequence[Device], aspects: Sequence[str]) -> list[str]:
    """Return what is odd in a chain for one part: yields of aspects that it does not have.

    Parameters
    ----------
    chain : sequence of Device
    aspects : sequence of str
        Names of the part's aspects.

    Returns
    -------
    list of str
        One line each; the file may be meant for other parts as well, so it is no fault.
    """
    known = {name.casefold() for name in aspects}
    return [
        f"{device.where}: {device.kind} names aspect {units.shown(name)}, which this part does not have"
        for device in chain
        for name, _ in device.shares
        if name.casefold() not in known
    ]


def _device(item: documents.Node) -> Device:
    if item.kind != "mapping" or len(item.entries) != 1:
        raise ConfigError(item.where, "is not a device", "write one '- wiper: 6 mm' a line")
    entry = item.entries[0]
    if entry.key not in KINDS:
        what = f"unknown device {units.shown(entry.key)}"
        raise ConfigError(entry.where, what, documents.hint(entry.key, list(KINDS)))
    kind = KINDS[entry.key]
    return kind(entry.where, text=written(entry.value), **kind.read(entry))
