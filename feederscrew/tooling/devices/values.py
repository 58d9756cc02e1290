"""How the values of devices are written in a bowl file, and their faults."""

import math
from pathlib import Path
from typing import Any

from feederscrew import units
from feederscrew.errors import ConfigError

CORNER_ADVICE = "write [9 mm, 8 mm]"
POLYGON = "write a list of three or more corners, as [[0 mm, 0 mm], [9 mm, 0 mm], [9 mm, 8 mm]]"
MAX_LENGTH_M = 1000.0  # [m] no bowl reaches so far
NOZZLE = {  # dimension and limits, in SI units, of what is said of a jet
    "nozzle": ("length", 1e-4, 2e-2),
    "pressure": ("pressure", 1e3, 1e6),
    "height": ("length", 0.0, 1.0),
    "time": ("time", 1e-3, 1.0),
    "nozzles": ("count", 1.0, 20.0),
}


def length(entry) -> dict[Any, Any]:
    """Read a length above 0, as {'limit': [m]}."""
    limit = _quantity(entry.value, entry.key, "length")
    if limit <= 0.0:
        what = f"{entry.key} is {units.one_line(entry.value.text)}"
        raise ConfigError(entry.value.where, what, "give more than 0 mm")
    return {"limit": limit}


def blade(entry):
    """Read a clearance, or {clearance: 6 mm, sweep: 30 deg, friction: 0.2, contour: [[0 mm, 6 mm], ...]}."""
    if entry.value.kind != "mapping":
        return length(entry)
    names = ("clearance", "sweep", "friction", "contour")
    arguments = mapping(
        entry, names, "write {clearance: 6 mm, sweep: 30 deg}", ("sweep", "friction", "contour")
    )
    numbers = (
        {"limit": within(arguments, "clearance", "length", 1e-9, MAX_LENGTH_M)}
        if "clearance" in arguments
        else {}
    )
    if "sweep" in arguments:
        numbers["sweep"] = within(arguments, "sweep", "angle", math.radians(1.0), math.radians(90.0))
    if "friction" in arguments:
        numbers["friction"] = within(arguments, "friction", "number", 0.0, 5.0)
    if "contour" in arguments:
        numbers["contour"] = tuple(_corners(arguments["contour"].value, "contour"))
    return numbers


def sensor(entry, views):
    """Read {of: A@90, play: 0.5 mm, sees: outline, resolution: 0.1 mm, jet: {nozzle: 2 mm}}.

    What is named may be a list: the first is ``like``, the others ``also``.
    """
    names, more = ("of", "play", "sees", "resolution", "jet"), ("sees", "resolution", "jet")
    arguments = mapping(entry, names, "write {of: A@90, play: 0.5 mm, sees: outline}", more)
    any_of = _any_of(arguments)
    if "sees" in arguments:
        node = arguments["sees"].value
        any_of["sees"] = node.text.strip()
        if any_of["sees"] not in views:
            raise ConfigError(
                node.where, f"sees is {units.quantity_text(node.text)}", f"known are {', '.join(views)}"
            )
    if "resolution" in arguments:
        any_of["resolution"] = within(arguments, "resolution", "length", 0.0, MAX_LENGTH_M)
    if "jet" in arguments:
        any_of |= nozzle(arguments["jet"], ("time", "nozzles"))
    return any_of


def nozzle(entry, more=(), needed=()) -> dict[Any, Any]:
    """Read {nozzle: 2 mm, pressure: 3 bar, height: 4 mm}, and the time of a pulse where there is one."""
    names = ("nozzle", "pressure", "height", *more)
    optional = [name for name in names if name not in needed]
    arguments = mapping(entry, names, "write {nozzle: 2 mm, pressure: 3 bar}", optional)
    return {name: within(arguments, name, *NOZZLE[name]) for name in names if name in arguments}


def within(entry, name, dimension, low, high):
    """Read one value of a mapping, from ``low`` to ``high`` in SI units."""
    node = entry[name].value
    value = _quantity(node, name, dimension)
    if low <= value <= high:
        return value
    unit, size = next(iter(units.UNITS_BY_DIMENSION[dimension].items()))
    what = f"{name} is {units.one_line(node.text)}"
    raise ConfigError(node.where, what, f"give {low / size:.4g} to {high / size:.4g} {unit}".rstrip())


def span(entry):
    """Read {from: 2 mm, to: 5 mm}, as {'span': (m, m)}."""
    return span_and(entry)[0]


def span_and(entry, more=(), needed=()) -> tuple[Any, ...]:
    """Read {from: 2 mm, to: 5 mm} with more entries beside it: {'span': (m, m)}, and all by key."""
    names = ("from", "to", *needed, *more)
    arguments = mapping(entry, names, "write {from: 2 mm, to: 5 mm}", more)
    first, last = (
        _quantity(arguments[name].value, f"{entry.key} {name}", "length") for name in ("from", "to")
    )
    if not 0.0 <= first < last:
        what = f"{entry.key} runs from {arguments['from'].value.text} to {arguments['to'].value.text}"
        raise ConfigError(entry.value.where, what, "give from 0 mm or more to something larger")
    return {"span": (first, last)}, arguments


def shares(entry) -> dict[Any, Any]:
    """Read the share that passes by aspect, as {'shares': ((aspect, 1), ...)}."""
    if entry.value.kind != "mapping" or not entry.value.entries:
        raise ConfigError(
            entry.where, "yield names no aspect", "write below it one line an aspect, as 'A: 0.9'"
        )
    return {"shares": tuple((orientation.key, _share(orientation)) for orientation in entry.value.entries)}


def polygon(entry) -> dict[Any, Any]:
    """Read a polygon of lengths, or the file that holds it, as 'corners' and an 'assumption'.

    The assumption is what was taken for granted of the file, a sentence; '' of nothing.
    """
    written_here = entry.value.kind != "mapping"
    corners, assumption = (_corners(entry.value, entry.key), "") if written_here else _drawn(entry)
    return {"corners": simple(corners, entry.value.where, entry.key), "assumption": assumption}


def opening(entry) -> dict[Any, Any]:
    """Read a polygon of the opening, or {of: A@90, play: 0.2 mm}, as {'corners': ...} or {'like': ...}."""
    if entry.value.kind != "mapping":
        return polygon(entry)
    arguments = mapping(entry, ("of", "play"), "write {of: A@90, play: 0.2 mm}")
    return {"like": _like(arguments)}


def _like(entry) -> tuple[Any, ...]:
    """Aspect, heading [rad] and play [m] of an orientation that is named."""
    return (*_orientation(entry["of"].value), _play(entry))


def _any_of(entry) -> dict[Any, Any]:
    """The first orientation of those named with its play, as 'like', and the others as 'also'."""
    node = entry["of"].value
    if node.kind != "list":
        return {"like": _like(entry)}
    if not node.items:
        raise ConfigError(node.where, "of names no orientation", "write aspect@heading, as A@90")
    first, *rest = (_orientation(item) for item in node.items)
    return {"like": (*first, _play(entry)), "also": tuple(rest)}


def _orientation(node) -> tuple[Any, ...]:
    """Aspect and heading [rad] of an orientation, as A@90."""
    name, at, turn = node.text.partition("@")
    if not at or not name.strip():
        what = f"{units.quantity_text(node.text)} is not an orientation"
        raise ConfigError(node.where, what, "write aspect@heading, as A@90")
    return name.strip(), _parsed(f"{turn.strip().removesuffix('deg')} deg", node.where, "heading", "angle")


def _play(entry):
    play = _quantity(entry["play"].value, "play", "length")
    if play < 0.0:
        raise ConfigError(entry["play"].value.where, "play is negative", "give 0 mm or more")
    return play


def simple(corners, where, kind) -> tuple[Any, ...]:
    """Return the corners of a polygon that neither crosses itself nor has no area.

    Parameters
    ----------
    corners : sequence of (float, float) [m]
    where, kind : str
        For the fault.

    Returns
    -------
    tuple of (float, float) [m]

    Raises
    ------
    ConfigError
    """
    if len(corners) < 3:
        raise ConfigError(where, f"{kind} has {len(corners)} corners", POLYGON)
    size = max(max(abs(x), abs(y)) for x, y in corners)
    if size > MAX_LENGTH_M:
        raise ConfigError(
            where, f"{kind} reaches {size:.3g} m", f"keep its corners within {MAX_LENGTH_M:g} m"
        )
    if crossed(corners):
        raise ConfigError(where, f"{kind} crosses itself", "list the corners in order around it")
    following = (*corners[1:], corners[0])
    twice = sum(a[0] * b[1] - a[1] * b[0] for a, b in zip(corners, following))
    if abs(twice) <= 1e-9 * size**2:
        raise ConfigError(where, f"{kind} has no area", "move a corner off the line through the others")
    return tuple(corners)


def written(node):
    """Return a value on one line, as it may be written in a bowl file."""
    if node.kind == "list":
        return f"[{', '.join(written(item) for item in node.items)}]"
    if node.kind == "mapping":
        return (
            f"{{{', '.join(f'{units.quoted(entry.key)}: {written(entry.value)}' for entry in node.entries)}}}"
        )
    return units.quoted(" ".join(node.text.split()))


def mapping(entry, names, mend, optional=()):
    """Return the entries of a mapping by key; a ConfigError for keys unknown or missing."""
    entries = (
        {orientation.key: orientation for orientation in entry.value.entries}
        if entry.value.kind == "mapping"
        else {}
    )
    for orientation in entries.values():
        if orientation.key not in names:
            raise ConfigError(
                orientation.where,
                f"unknown key {units.quantity_text(orientation.key)}",
                f"known are {', '.join(names)}",
            )
    missing = [name for name in names if name not in entries and name not in optional]
    if missing:
        raise ConfigError(entry.where, f"{entry.key} has no {missing[0]}", mend)
    return entries


def _corners(node, kind):
    if node.kind != "list":
        raise ConfigError(node.where, f"{kind} is not a list of corners", POLYGON)
    corners = []
    for item in node.items:
        if item.kind != "list" or len(item.items) != 2:
            raise ConfigError(item.where, f"is no corner of {kind}", CORNER_ADVICE)
        corners.append(
            tuple(_quantity(orientation, f"corner of {kind}", "length") for orientation in item.items)
        )
    return corners


def _drawn(entry) -> tuple[Any, ...]:
    """The one closed polyline of a layer of a DXF file, and what was taken for granted of its unit."""
    arguments = mapping(entry, ("dxf", "layer"), "write {dxf: tooling.dxf, layer: CUT}")
    node, layer = arguments["dxf"].value, arguments["layer"].value.text
    path = Path(node.text)
    if not path.is_absolute():
        path = Path(node.where.rsplit(":", 2)[0]).parent / path
    from feederscrew import dxf

    read = dxf.outlines(path, layer, node.where)
    rings = read.rings
    if len(rings) != 1:
        what = f"layer {units.quantity_text(layer)} of {path.name} holds {len(rings)} closed polylines"
        raise ConfigError(arguments["layer"].value.where, what, "give each cut_out a layer of its own")
    what = f"{node.where}: {units.printable(path.name)} names no unit ($INSUNITS), read in mm"
    return rings[0], "" if read.has_unit else f"{what} - save it in millimetres"


def _share(entry):
    share = _quantity(entry.value, f"yield of {entry.key}", "number")
    if not 0.0 <= share <= 1.0:
        what = f"yield of {entry.key} is {units.one_line(entry.value.text)}"
        raise ConfigError(entry.value.where, what, "give 0 to 1")
    return share


def _quantity(node, name, dimension):
    if node.kind != "text":
        raise ConfigError(node.where, f"{name} is a {node.kind}", "write one value")
    return _parsed(node.text, node.where, name, dimension)


def _parsed(text, where, name, dimension):
    try:
        return units.quantity(text, dimension)
    except units.QuantityError as fault:
        raise ConfigError(where, f"{name}: {fault.what}", fault.mend) from None


def crossed(corners) -> bool:
    """Return whether two sides of corners (K, 2) that are not neighbours meet, or two corners coincide."""
    sides = list(zip(corners, (*corners[1:], corners[0])))
    count = len(sides)
    for i in range(count):
        for j in range(i + 1, count):
            if sides[i][0] == sides[j][0]:
                return True
            if (j - i) % count in (1, count - 1):
                continue
            if _meet(*sides[i], *sides[j]):
                return True
    return False


def _meet(a, b, c, d):
    def left(o, p, q):
        return (p[0] - o[0]) * (q[1] - o[1]) - (p[1] - o[1]) * (q[0] - o[0])

    return left(a, b, c) * left(a, b, d) <= 0.0 and left(c, d, a) * left(c, d, b) <= 0.0
