"""Orienting devices along the track: which orientations each lets pass and which it returns to the bowl."""

from dataclasses import dataclass, replace

import numpy as np

from feederscrew import documents, units
from feederscrew.errors import ConfigError
from feederscrew.mechanics.wall.headings import headings

SECTION = "devices"  # of a bowl file
HEIGHTS = ("wiper", "height_bar")  # return what stands higher than their clearance
WIDTHS = ("narrowed_track", "pressure_break")
YIELD = "yield"
KINDS = (*HEIGHTS, *WIDTHS, YIELD)
MEANINGS = {
    "wiper": "blade at a clearance over the track; returns orientations that stand higher",
    "height_bar": "bar across the track at a clearance; returns orientations that stand higher",
    "narrowed_track": "track of a lesser width; returns orientations whose centre of mass is beyond its edge",
    "pressure_break": "gap where the queue pushes parts off; returns orientations wider than the ledge left",
    "yield": "share that passes, by aspect, as measured; aspects not named pass",
}
CLOSE = 1e-9  # [m] a part this much over a limit still passes


@dataclass(frozen=True)
class Device:
    """One device of the chain."""

    kind: str  # of KINDS
    where: str  # 'bowl.yaml:20:5'
    limit: float = np.nan  # [m] clearance or width
    shares: tuple[tuple[str, float], ...] = ()  # of a yield: share that passes, by aspect


def read(path):
    """The chain of a bowl file, in the order parts meet it.

    Parameters
    ----------
    path : str or Path or None
        Bowl file; its list ``devices:`` is read.

    Returns
    -------
    tuple of Device
        Empty without a file or without a list.

    Raises
    ------
    Faults
        Every fault, one a line.
    """
    if path is None:
        return ()
    root, faults = documents.read(path)
    entry = root.find(SECTION)
    if entry is None:
        return ()
    found = []
    for item in _items(entry, faults):
        try:
            found.append(_device(item))
        except ConfigError as fault:
            faults.append(fault)
    documents.raise_all(faults)
    return tuple(found)


def strangers(chain, aspects):
    """What is odd in a chain for one part: yields of aspects that it has not.

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
        f"{device.where}: yield names aspect {units.shown(name)}, which this part has not"
        for device in chain
        for name, _ in device.shares
        if name.casefold() not in known
    ]


def passed(device, posture, found, track):
    """Share of each heading of one aspect that a device lets pass.

    Parameters
    ----------
    device : Device
    posture : Posture
    found : Headings
        Of that posture on that track; M rows.
    track : Track

    Returns
    -------
    (M,) float
        1 passes, 0 is returned to the bowl.
    """
    if device.kind == YIELD:
        shares = {name.casefold(): share for name, share in device.shares}
        return np.full(len(found.headings), shares.get(posture.name.casefold(), 1.0))
    if device.kind in HEIGHTS:
        top = posture.corners[:, 2].max()
        return np.full(len(found.headings), float(top <= device.limit + CLOSE))
    if device.kind == "pressure_break":
        return (found.widths <= device.limit + CLOSE).astype(float)
    narrowed = headings(posture, replace(track, width=min(device.limit, track.width)))
    return 1.0 - narrowed.falls_off.astype(float)


def _items(entry, faults):
    if entry.value.kind == "list":
        return entry.value.items
    faults.append(ConfigError(entry.where, "devices is not a list", "write one '- wiper: 6 mm' a line"))
    return ()


def _device(item):
    if item.kind != "mapping" or len(item.entries) != 1:
        raise ConfigError(item.where, "is no device", "write one '- wiper: 6 mm' a line")
    entry = item.entries[0]
    if entry.key not in KINDS:
        what = f"unknown device {units.shown(entry.key)}"
        raise ConfigError(entry.where, what, documents.hint(entry.key, KINDS))
    if entry.key == YIELD:
        return Device(YIELD, entry.where, shares=_shares(entry))
    limit = _quantity(entry.value, entry.key, "length")
    if limit <= 0.0:
        what = f"{entry.key} is {units.one_line(entry.value.text)}"
        raise ConfigError(entry.value.where, what, "give more than 0 mm")
    return Device(entry.key, entry.where, limit)


def _shares(entry):
    if entry.value.kind != "mapping" or not entry.value.entries:
        raise ConfigError(
            entry.where, "yield names no aspect", "write below it one line an aspect, as 'A: 0.9'"
        )
    return tuple((one.key, _share(one)) for one in entry.value.entries)


def _share(entry):
    share = _quantity(entry.value, f"yield of {entry.key}", "number")
    if not 0.0 <= share <= 1.0:
        what = f"yield of {entry.key} is {units.one_line(entry.value.text)}"
        raise ConfigError(entry.value.where, what, "give 0 to 1")
    return share


def _quantity(node, name, dimension):
    if node.kind != "text":
        raise ConfigError(node.where, f"{name} is a {node.kind}", "write one value")
    try:
        return units.quantity(node.text, dimension)
    except units.QuantityError as fault:
        raise ConfigError(node.where, f"{name}: {fault.what}", fault.mend) from None
