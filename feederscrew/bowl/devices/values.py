"""Values of devices as a bowl file writes them, and their faults."""

import math
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from feederscrew.base import units
from feederscrew.base.documents import Entry, Node
from feederscrew.base.errors import ConfigError
from feederscrew.base.heavy import heavy

if TYPE_CHECKING:
    import shapely

    from feederscrew.base.dxf import Outlines
else:
    shapely = heavy("shapely")

Corner = tuple[float, float]  # [m]
DeviceFields = dict[str, Any]  # of a device by their names, in SI units: those that its value in a file says
CORNER_ADVICE = "write [9 mm, 8 mm]"
POLYGON = "write a list of three or more corners, as [[0 mm, 0 mm], [9 mm, 0 mm], [9 mm, 8 mm]]"
MAX_LENGTH_M = 1000.0  # [m] no bowl reaches so far
BLADE = {  # dimension and limits, in SI units, of what is said of a blade, and the field it fills
    "clearance": ("limit", "length", 1e-9, MAX_LENGTH_M),
    "sweep": ("sweep", "angle", math.radians(1.0), math.radians(90.0)),
    "friction": ("friction", "number", 0.0, 5.0),
}
NOZZLE = {  # the same of a jet
    "nozzle": ("length", 1e-4, 2e-2),
    "pressure": ("pressure", 1e3, 1e6),
    "height": ("length", 0.0, 1.0),
    "time": ("time", 1e-3, 1.0),
    "nozzles": ("count", 1.0, 20.0),
}


def length(entry: Entry) -> DeviceFields:
    """Read a length above 0.

    Parameters
    ----------
    entry : Entry

    Returns
    -------
    dict
        {'limit': float [m]}

    Raises
    ------
    ConfigError
    """
    limit = _quantity(entry.value, entry.key, "length")
    if limit <= 0.0:
        what = f"{entry.key} is {units.one_line(entry.value.text)}"
        raise ConfigError(entry.value.where, what, "give more than 0 mm")
    return {"limit": limit}


def blade(entry: Entry, more: Sequence[str] = ()) -> DeviceFields:
    """Read a clearance, or {clearance: 6 mm, sweep: 30 deg, friction: 0.2, contour: [[0 mm, 6 mm], ...]}.

    Parameters
    ----------
    entry : Entry
    more : sequence of str, optional
        Further keys, which the caller reads.

    Returns
    -------
    dict
        Fields of a wiper, in SI units.

    Raises
    ------
    ConfigError
    """
    if entry.value.kind != "mapping":
        return length(entry)
    mend, optional = "write {clearance: 6 mm, sweep: 30 deg}", ("sweep", "friction", "contour", *more)
    arguments = mapping(entry, ("clearance", *optional), mend, optional)
    fields: DeviceFields = {
        name: within(arguments, key, dimension, low, high)
        for key, (name, dimension, low, high) in BLADE.items()
        if key in arguments
    }
    if "contour" in arguments:
        fields["contour"] = tuple(_corners(arguments["contour"].value, "contour"))
    return fields


def sensor(entry: Entry, views: Sequence[str]) -> DeviceFields:
    """Read {of: A@90, play: 0.5 mm, sees: outline, resolution: 0.1 mm, jet: {nozzle: 2 mm}}.

    Parameters
    ----------
    entry : Entry
    views : sequence of str
        That 'sees' may name.

    Returns
    -------
    dict
        Fields of a vision reject, in SI units.

    Raises
    ------
    ConfigError
    """
    names, more = ("of", "play", "sees", "resolution", "jet"), ("sees", "resolution", "jet")
    arguments = mapping(entry, names, "write {of: A@90, play: 0.5 mm, sees: outline}", more)
    node = arguments["of"].value
    if node.kind == "list" and not node.items:
        raise ConfigError(node.where, "of names no orientation", "write aspect@heading, as A@90")
    first, *rest = map(_orientation, node.items if node.kind == "list" else [node])
    fields: DeviceFields = {"like": (*first, _play(arguments)), "also": tuple(rest)}
    if "sees" in arguments:
        node = arguments["sees"].value
        fields["sees"] = node.text.strip()
        if fields["sees"] not in views:
            what = f"sees is {units.quantity_text(node.text)}"
            raise ConfigError(node.where, what, f"known are {', '.join(views)}")
    if "resolution" in arguments:
        fields["resolution"] = within(arguments, "resolution", "length", 0.0, MAX_LENGTH_M)
    return fields | (nozzle(arguments["jet"], ("time", "nozzles")) if "jet" in arguments else {})


def nozzle(entry: Entry, more: Sequence[str] = (), needed: Sequence[str] = ()) -> DeviceFields:
    """Read {nozzle: 2 mm, pressure: 3 bar, height: 4 mm}, and the time of a pulse where there is one.

    Parameters
    ----------
    entry : Entry
    more : sequence of str, optional
        Further keys: 'time', 'nozzles'.
    needed : sequence of str, optional
        Keys that may not be missing.

    Returns
    -------
    dict
        Values by key, in SI units.

    Raises
    ------
    ConfigError
    """
    names = ("nozzle", "pressure", "height", *more)
    optional = [name for name in names if name not in needed]
    arguments = mapping(entry, names, "write {nozzle: 2 mm, pressure: 3 bar}", optional)
    return {name: within(arguments, name, *NOZZLE[name]) for name in names if name in arguments}


def within(entry: dict[str, Entry], name: str, dimension: str, low: float, high: float) -> float:
    """Read one value of a mapping, within limits.

    Parameters
    ----------
    entry : dict of str to Entry
        As ``mapping`` returns it.
    name : str
        Its key.
    dimension : str
        Of ``units``.
    low, high : float [SI]

    Returns
    -------
    float [SI]

    Raises
    ------
    ConfigError
    """
    node = entry[name].value
    value = _quantity(node, name, dimension)
    if low <= value <= high:
        return value
    unit, size = next(iter(units.UNITS_BY_DIMENSION[dimension].items()))
    what = f"{name} is {units.one_line(node.text)}"
    raise ConfigError(node.where, what, f"give {low / size:.4g} to {high / size:.4g} {unit}".rstrip())


def span(
    entry: Entry, more: Sequence[str] = (), needed: Sequence[str] = ()
) -> tuple[DeviceFields, dict[str, Entry]]:
    """Read {from: 2 mm, to: 5 mm} with more entries beside it.

    Parameters
    ----------
    entry : Entry
    more : sequence of str, optional
        Further keys.
    needed : sequence of str, optional
        Further keys that may not be missing.

    Returns
    -------
    fields : dict
        {'span': (float, float) [m]}
    arguments : dict of str to Entry
        All entries by key.

    Raises
    ------
    ConfigError
    """
    names = ("from", "to", *needed, *more)
    arguments = mapping(entry, names, "write {from: 2 mm, to: 5 mm}", more)
    ends = ((arguments[name].value, f"{entry.key} {name}") for name in ("from", "to"))
    first, last = (_quantity(node, name, "length") for node, name in ends)
    if not 0.0 <= first < last:
        what = f"{entry.key} runs from {arguments['from'].value.text} to {arguments['to'].value.text}"
        raise ConfigError(entry.value.where, what, "give from 0 mm or more to something larger")
    return {"span": (first, last)}, arguments


def shares(entry: Entry) -> DeviceFields:
    """Read the share that passes by aspect.

    Parameters
    ----------
    entry : Entry

    Returns
    -------
    dict
        {'shares': ((aspect, share [1]), ...)}

    Raises
    ------
    ConfigError
    """
    if entry.value.kind != "mapping" or not entry.value.entries:
        mend = "write below it one line an aspect, as 'A: 0.9'"
        raise ConfigError(entry.where, f"{entry.key} names no aspect", mend)
    pairs = []
    for aspect in entry.value.entries:
        share = _quantity(aspect.value, f"{entry.key} of {aspect.key}", "number")
        if not 0.0 <= share <= 1.0:
            what = f"{entry.key} of {aspect.key} is {units.one_line(aspect.value.text)}"
            raise ConfigError(aspect.value.where, what, "give 0 to 1")
        pairs.append((aspect.key, share))
    return {"shares": tuple(pairs)}


def polygon(entry: Entry) -> DeviceFields:
    """Read a polygon of lengths, or the DXF file that holds it.

    Parameters
    ----------
    entry : Entry

    Returns
    -------
    dict
        'corners' (K, 2) [m], and 'assumption': what was assumed of the file, a sentence.

    Raises
    ------
    ConfigError
        If it has fewer than three corners, no area, crosses itself, or the drawing does not hold it.
    """
    corners: Any
    if entry.value.kind != "mapping":
        corners, assumption = _corners(entry.value, entry.key), ""
    else:  # the one closed polyline of a layer of a DXF file
        arguments = mapping(entry, ("dxf", "layer"), "write {dxf: tooling.dxf, layer: CUT}")
        node, layer = arguments["dxf"].value, arguments["layer"].value.text
        path = Path(node.text)
        if not path.is_absolute():
            path = Path(node.where.rsplit(":", 2)[0]).parent / path
        from feederscrew.base import dxf

        read = dxf.outlines(path, layer, node.where)
        if len(read.rings) != 1:
            count = f"holds {len(read.rings)} closed polylines"
            what = f"layer {units.quantity_text(layer)} of {path.name} {count}"
            raise ConfigError(
                arguments["layer"].value.where, what, f"give each {entry.key} a layer of its own"
            )
        corners, assumption = (
            read.rings[0],
            _remark_on_drawing(read, f"{node.where}: {units.printable(path.name)}"),
        )
    where, kind = entry.value.where, entry.key
    if len(corners) < 3:
        raise ConfigError(where, f"{kind} has {len(corners)} corners", POLYGON)
    size = max(max(abs(x), abs(y)) for x, y in corners)
    if size > MAX_LENGTH_M:
        mend = f"keep its corners within {MAX_LENGTH_M:g} m"
        raise ConfigError(where, f"{kind} reaches {size:.3g} m", mend)
    if crossed(corners):
        raise ConfigError(where, f"{kind} crosses itself", "list the corners in order around it")
    following = (*corners[1:], corners[0])
    twice = sum(a[0] * b[1] - a[1] * b[0] for a, b in zip(corners, following))
    if abs(twice) <= 1e-9 * size**2:
        raise ConfigError(where, f"{kind} has no area", "move a corner off the line through the others")
    return {"corners": tuple(corners), "assumption": assumption}


def _remark_on_drawing(read: "Outlines", name: str) -> str:
    """Return a line of what was taken for granted of a drawing; '' where nothing was."""
    remarks = []
    if not read.has_unit:
        remarks.append(("names no unit ($INSUNITS), read in mm", "save it in millimetres"))
    if read.doubled:
        remarks.append(
            (f"has {units.counted(read.doubled, 'line')} drawn twice, read once", "delete doubles")
        )
    if read.gap:
        remarks.append((f"has gaps up to {1e3 * read.gap:.2g} mm, joined", "let the ends of lines meet"))
    facts, mends = (", and ".join(column) for column in zip(*remarks)) if remarks else ("", "")
    return f"{name} {facts} - {mends}" if remarks else ""


def opening(entry: Entry) -> DeviceFields:
    """Read a polygon of the opening, or {of: A@90, play: 0.2 mm}.

    Parameters
    ----------
    entry : Entry

    Returns
    -------
    dict
        As of ``polygon``, or {'like': (aspect, heading [rad], play [m])}.

    Raises
    ------
    ConfigError
    """
    if entry.value.kind != "mapping":
        return polygon(entry)
    arguments = mapping(entry, ("of", "play"), "write {of: A@90, play: 0.2 mm}")
    return {"like": (*_orientation(arguments["of"].value), _play(arguments))}


def _orientation(node: Node) -> tuple[str, float]:
    name, at, turn = node.text.partition("@")
    if not at or not name.strip():
        what = f"{units.quantity_text(node.text)} is not an orientation"
        raise ConfigError(node.where, what, "write aspect@heading, as A@90")
    return name.strip(), _parsed(f"{turn.strip().removesuffix('deg')} deg", node.where, "heading", "angle")


def _play(entry: dict[str, Entry]) -> float:
    play = _quantity(entry["play"].value, "play", "length")
    if play < 0.0:
        raise ConfigError(entry["play"].value.where, "play is negative", "give 0 mm or more")
    return play


def crossed(corners: Sequence[Corner]) -> bool:
    """Tell whether two sides of a polygon that are no neighbours meet, or two corners coincide.

    Parameters
    ----------
    corners : sequence of (float, float) [m]

    Returns
    -------
    bool
    """
    if len(set(corners)) < len(corners):
        return True
    return len(corners) > 3 and not shapely.LinearRing(corners).is_simple


def written(node: Node) -> str:
    """Return a value on one line, as it may be written in a bowl file.

    Parameters
    ----------
    node : Node

    Returns
    -------
    str
    """
    if node.kind == "list":
        return f"[{', '.join(map(written, node.items))}]"
    if node.kind == "mapping":
        entries = (f"{units.quoted(entry.key)}: {written(entry.value)}" for entry in node.entries)
        return f"{{{', '.join(entries)}}}"
    return units.quoted(" ".join(node.text.split()))


def mapping(entry: Entry, names: Sequence[str], mend: str, optional: Sequence[str] = ()) -> dict[str, Entry]:
    """Return the entries of a mapping by key.

    Parameters
    ----------
    entry : Entry
    names : sequence of str
        Keys that there may be.
    mend : str
        Says what to write where one is missing.
    optional : sequence of str, optional
        Keys that may be missing.

    Returns
    -------
    dict of str to Entry

    Raises
    ------
    ConfigError
        If a key is unknown or missing.
    """
    entries = {item.key: item for item in entry.value.entries} if entry.value.kind == "mapping" else {}
    for item in entries.values():
        if item.key not in names:
            what = f"unknown key {units.quantity_text(item.key)}"
            raise ConfigError(item.where, what, f"known are {', '.join(names)}")
    missing = [name for name in names if name not in entries and name not in optional]
    if missing:
        raise ConfigError(entry.where, f"{entry.key} has no {missing[0]}", mend)
    return entries


def _corners(node: Node, kind: str) -> list[Corner]:
    if node.kind != "list":
        raise ConfigError(node.where, f"{kind} is not a list of corners", POLYGON)
    corners = []
    for item in node.items:
        if item.kind != "list" or len(item.items) != 2:
            raise ConfigError(item.where, f"is no corner of {kind}", CORNER_ADVICE)
        x, y = (_quantity(end, f"corner of {kind}", "length") for end in item.items)
        corners.append((x, y))
    return corners


def _quantity(node: Node, name: str, dimension: str) -> float:
    if node.kind != "text":
        raise ConfigError(node.where, f"{name} is a {node.kind}", "write one value")
    return _parsed(node.text, node.where, name, dimension)


def _parsed(text: str, where: str, name: str, dimension: str) -> float:
    try:
        return units.quantity(text, dimension)
    except units.QuantityError as fault:
        raise ConfigError(where, f"{name}: {fault.what}", fault.mend) from None
