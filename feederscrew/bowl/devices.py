"""The devices along the track, as a bowl file lists them: one table of their kinds."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from feederscrew import documents, units
from feederscrew.bowl import device_values as values
from feederscrew.errors import ConfigError

SECTION = "devices"  # of a bowl file


@dataclass(frozen=True)
class DeviceKind:
    """One kind of device: how it is written, what it means, what its value is."""

    reader: Callable  # (entry, faults' name) -> what of Device's fields it gives
    dimension: str  # 'length', 'span', 'polygon', 'opening', 'shares'
    example: str  # as written after 'kind:'
    meaning: str
    hanging: bool = True  # whether it means anything to parts that hang between rails
    turns: bool = False  # whether it turns parts over instead of returning them


@dataclass(frozen=True)
class Device:
    """One device of the chain."""

    kind: str  # of KINDS
    where: str  # 'bowl.yaml:20:5'
    limit: float = np.nan  # [m] clearance, width or length
    shares: tuple[tuple[str, float], ...] = ()  # of a yield: share that passes, by aspect
    span: tuple[float, float] = ()  # [m] from the wall, of a slot or of rails
    corners: tuple[tuple[float, float], ...] = ()  # [m] of a cut_out unrolled, of a profile (y, z)
    like: tuple[str, float, float] = ()  # of a profile: aspect, heading [rad], play [m]
    text: str = ""  # its value as written


KINDS = {
    "wiper": DeviceKind(
        values.length, "length", "6 mm",
        "blade at a clearance over the track; returns orientations that stand higher",
    ),
    "height_bar": DeviceKind(
        values.length, "length", "6 mm",
        "bar across the track at a clearance; returns orientations that stand higher",
    ),
    "narrowed_track": DeviceKind(
        values.length, "length", "9 mm",
        "track of a lesser width, a balcony; returns orientations whose foot of the centre of mass is not "
        "supported",
    ),
    "pressure_break": DeviceKind(
        values.length, "length", "10 mm",
        "gap where the queue pushes parts off; returns orientations wider than the ledge left",
        hanging=False,
    ),
    "canyon": DeviceKind(
        values.length, "length", "8 mm",
        "strip of that width removed along the wall; returns orientations whose foot lies over it",
    ),
    "gap": DeviceKind(
        values.length, "length", "9 mm",
        "gap of that length across the track, its edges parallel, the one that is left radial",
    ),
    "slot": DeviceKind(
        values.span, "span", "{from: 2 mm, to: 5 mm}",
        "long hole along the track between two distances from the wall",
    ),
    "profile": DeviceKind(
        values.opening, "opening", "{of: A@90, play: 0.2 mm}",
        "gate with an opening: a polygon of distances from the wall and heights, or an orientation's own "
        "outline with play",
    ),
    "cut_out": DeviceKind(
        values.polygon, "polygon", "[[0 mm, 0 mm], [9 mm, 0 mm], [9 mm, 8 mm]]",
        "hole in the track: lengths along the wall and distances from it, unrolled; or "
        "{dxf: file, layer: CUT}",
    ),
    "hold_down": DeviceKind(
        values.length, "length", "6 mm",
        "bar above the queue that keeps parts down; returns orientations that do not fit below",
    ),
    "step": DeviceKind(
        values.length, "length", "5 mm",
        "drop of the track by that height: orientations of a lower barrier pitch over their leading edge; "
        "quasi-static, until a trial confirms it",
        hanging=False, turns=True,
    ),
    "tip": DeviceKind(
        values.length, "length", "6 mm",
        "ledge of that width above a second track, half the part's greatest length lower: orientations whose "
        "weight lies beyond it turn over it if that drop takes them past their barrier; quasi-static, until "
        "a trial confirms it",
        hanging=False, turns=True,
    ),
    "rails": DeviceKind(
        values.span, "span", "{from: 4.5 mm, to: 8.5 mm}",
        "slot between two rails, by their distances from the wall: headed parts whose centre of mass lies "
        "over it hang in it by the head from there on; what falls through is returned",
    ),
    "yield": DeviceKind(
        values.shares, "shares", "{A: 0.9}",
        "share that passes, by aspect, as measured; aspects not named pass",
    ),
}  # fmt: skip


def listed(entry, faults):
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


def misplaced(chain, width):
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
    return [fault for device in chain for fault in _misfit(device, width)] + beyond_rails(chain)


def beyond_rails(chain):
    """Return the faults of devices behind rails that mean nothing to parts that hang.

    Parameters
    ----------
    chain : sequence of Device

    Returns
    -------
    list of ConfigError
    """
    first = next((place for place, device in enumerate(chain) if device.kind == "rails"), len(chain))
    return [
        ConfigError(
            device.where,
            f"{device.kind} has no meaning for parts that hang between rails",
            "list it before the rails",
        )
        for device in chain[first:]
        if not KINDS[device.kind].hanging
    ]


def strangers(chain, aspects):
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
        f"{device.where}: yield names aspect {units.shown(name)}, which this part does not have"
        for device in chain
        for name, _ in device.shares
        if name.casefold() not in known
    ]


def _device(item):
    if item.kind != "mapping" or len(item.entries) != 1:
        raise ConfigError(item.where, "is not a device", "write one '- wiper: 6 mm' a line")
    entry = item.entries[0]
    if entry.key not in KINDS:
        what = f"unknown device {units.shown(entry.key)}"
        raise ConfigError(entry.where, what, documents.hint(entry.key, list(KINDS)))
    return Device(entry.key, entry.where, text=values.written(entry.value), **KINDS[entry.key].reader(entry))


def _misfit(device, width):
    told, mend = f"the track is {1e3 * width:.4g} mm wide", "give a smaller one, or a wider track"
    if device.kind == "canyon" and device.limit >= width:
        yield ConfigError(device.where, f"canyon leaves no track: {told}", mend)
    if device.span and device.span[0] <= 0.0 and device.span[1] >= width:
        yield ConfigError(device.where, f"{device.kind} leaves no track: {told}", mend)
    if device.span and device.span[0] >= width:
        what = f"{device.kind} lies beside the track: {told}"
        yield ConfigError(device.where, what, "move it onto the track")
    if device.kind == "cut_out":
        across = [y for _, y in device.corners]
        if max(across) <= 0.0 or min(across) >= width:
            yield ConfigError(
                device.where, f"cut_out lies beside the track: {told}", "move it onto the track"
            )
