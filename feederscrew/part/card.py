"""YAML files about parts: part cards, of parts known by published data only, and names of aspects."""

import hashlib
import re
from dataclasses import dataclass
from os import PathLike
from typing import Any

import numpy as np

from feederscrew.base import check, documents, units
from feederscrew.base.arrays import Floats
from feederscrew.base.documents import Entry, Node
from feederscrew.base.errors import ConfigError, FeederError
from feederscrew.part import mass
from feederscrew.part.formats import PartFile
from feederscrew.part.record import AspectNames, CardAspect, CardBlock, Part


@dataclass(frozen=True)
class CardKey:
    """One key of a part card."""

    word: str
    dimension: str  # of feederscrew.base.units, or 'text', 'section', 'rows'
    example: str
    is_required: bool = False
    shape: tuple[int, ...] = ()  # of a list; () for one value
    positive: bool = True
    choices: tuple[str, ...] = ()  # of a text; any text where it is empty


MATRIX_EXAMPLE = "three rows of three, as in [95.3 g mm2, 0 g mm2, -24.5 g mm2]"
TRACK_EQUATION_AXES = ("tilted", "level")  # by the bank of the track, or not: of the printed track equations
CARD_KEYS = (
    CardKey("mass", "mass", "1.98 g", is_required=True),
    CardKey("centre_of_mass", "length", "[3.3 mm, 0 mm, 9 mm]", is_required=True, shape=(3,), positive=False),
    CardKey("inertia", "inertia", MATRIX_EXAMPLE, is_required=True, shape=(3, 3), positive=False),
    CardKey("aspects", "rows", "- {aspect: 1, height: 6.9 mm}", is_required=True),
    CardKey("floor", "section", "{aspect: 1, drive_offset: 3.2 mm}"),
    CardKey("track", "section", "{wall_lever: 8 mm, wall_lever_angle: 64 deg}"),
)
ASPECT_KEYS = (
    CardKey("aspect", "text", "1", is_required=True),
    CardKey("height", "length", "6.9 mm", is_required=True),
    CardKey("faces", "number", "2"),
    CardKey("polar_inertia", "inertia", "90.8 g mm2"),
    CardKey("contact_area", "area", "100 mm2"),
    CardKey("solid_angle", "solid angle", "1.8 sr"),
    CardKey("csa_height", "length", "10.1 mm"),
    CardKey("stability_height", "length", "10.1 mm"),
)
FLOOR_KEYS = (
    CardKey("aspect", "text", "5"),
    CardKey("drive_offset", "length", "3.2 mm", positive=False),
    CardKey("centroid_height", "length", "3.3 mm"),
    CardKey("polar_inertia", "inertia", "95.3 g mm2"),
)
TRACK_KEYS = (
    *FLOOR_KEYS,
    CardKey("wall_lever", "length", "8 mm"),
    CardKey("wall_lever_angle", "angle", "64 deg"),
    CardKey("wall_x", "length", "[6.7 mm, 9 mm]", shape=(2,)),
    CardKey("wall_y", "length", "4 mm"),
    CardKey("wall_friction_y", "length", "4 mm"),
    CardKey("axes", "text", "tilted", choices=TRACK_EQUATION_AXES),
)
SYMMETRY_TOLERANCE = 1e-9  # [1] of an entry: closer magnitudes are equal
TRIANGLE_TOLERANCE = 1e-3  # [1] by which rounded moments may miss the triangle inequality
PRINTED_BLOCKS = (("floor", FLOOR_KEYS), ("track", TRACK_KEYS))
RELATIVE_UNIT = "relative"  # in place of sr, where a source states no unit
SMALLEST_QUANTITY_SI, LARGEST_QUANTITY_SI = 1e-18, 1e9  # of every length, area, mass and moment of a part


def read_card(file: PartFile) -> Part:
    """Return a part from a part card, a ``PartFile``: without volume, density and surface.

    Where print gives an inertia matrix whose halves differ in sign alone, the card keeps it as printed; the
    upper half is used and a warning says so. Their mean would lose the product of inertia.

    Parameters
    ----------
    file : PartFile
        The bytes of a YAML file with the keys of ``CARD_KEYS``.

    Returns
    -------
    Part
        Its ``vertices``, ``faces`` and ``hull`` are None; ``aspects`` and ``printed`` hold the published
        data.

    Raises
    ------
    Faults
        With every fault of the card, one a line.
    ConfigError
        If the file is not YAML, or not a block of 'key: value' lines.
    """
    root, faults = documents.load(file.data, file.where)
    if root.kind != "mapping":
        needed = ", ".join(key.word for key in CARD_KEYS if key.is_required)
        raise ConfigError(root.where, "no 'key: value' line", f"write {needed}")
    values = _read_block(root, CARD_KEYS, faults)
    aspects = _aspects(values.get("aspects"), faults)
    names = [aspect.get("name") for aspect in aspects]
    printed = {key: _read_block(values[key], keys, faults) for key, keys in PRINTED_BLOCKS if key in values}
    for block, own in printed.items():
        if "aspect" in own and own["aspect"] not in names:
            where = root.find(block).value.find("aspect").value.where  # type: ignore[union-attr]
            what = f"{block}: the card lists no aspect {units.quantity_text(own['aspect'])}"
            faults.append(ConfigError(where, what, f"known are {', '.join(map(str, names))}"))
    inertia, remarks = _inertia(root, values.get("inertia"), faults)
    documents.raise_all(faults)
    return Part(
        name=file.name,
        source=file.source,
        sha256=file.sha256,
        units="mm",
        material="part card",
        density=None,
        volume=None,
        mass=values["mass"],
        centre_of_mass=check.frozen(np.array(values["centre_of_mass"])),
        inertia=check.frozen(inertia),
        aspects=tuple(CardAspect(**aspect) for aspect in aspects),
        printed=printed or None,
        warnings=remarks,
    )


def _read_block(node: Node, keys: tuple[CardKey, ...], faults: list[FeederError]) -> CardBlock:
    """Values by word, in SI units; what is wrong is added to ``faults``."""
    if node.kind != "mapping":
        what = "is not a block of 'key: value' lines"
        faults.append(ConfigError(node.where, what, f"give it {', '.join(key.word for key in keys)}"))
        return {}
    key_by_word = {key.word: key for key in keys}
    values = {}
    for entry in node.entries:
        if entry.key not in key_by_word:
            faults.append(_unknown_key(entry, list(key_by_word)))
            continue
        key = key_by_word[entry.key]
        try:
            plain = key.dimension in ("section", "rows")
            values[entry.key] = entry.value if plain else _value(key, entry.value, key.shape)
        except ConfigError as fault:
            faults.append(fault)
    words = {entry.key for entry in node.entries}
    missing = [key for key in keys if key.is_required and key.word not in words]
    if missing:
        what = f"without {' and '.join(key.word for key in missing)}"
        faults.append(ConfigError(node.where, what, f"add {missing[0].word}: {missing[0].example}"))
    return values


def _unknown_key(entry: Entry, words: list[str]) -> ConfigError:
    what = f"unknown key {units.quantity_text(entry.key)}"
    return ConfigError(entry.where, what, documents.hint(entry.key, words))


def _value(key: CardKey, node: Node, shape: tuple[int, ...]) -> Any:
    """A text, a quantity [SI], or a list of these of some shape."""
    if shape:
        if node.kind != "list" or len(node.items) != shape[0]:
            raise ConfigError(node.where, f"{key.word} is not a list of {shape[0]}", f"write {key.example}")
        return tuple(_value(key, item, shape[1:]) for item in node.items)
    if node.kind != "text" or not node.text:
        raise ConfigError(node.where, f"{key.word} has no value", f"write {key.example}")
    if key.choices and node.text not in key.choices:
        what = f"{key.word} is {units.quantity_text(node.text)}"
        raise ConfigError(node.where, what, f"give {' or '.join(key.choices)}")
    if key.dimension == "text":
        return node.text
    try:
        relative = key.dimension == "solid angle" and units.split(node.text)[1] == RELATIVE_UNIT
        value = units.split(node.text)[0] if relative else units.quantity(node.text, key.dimension)
    except units.QuantityError as fault:
        raise ConfigError(node.where, f"{key.word}: {fault.what}", fault.mend) from None
    what = f"{key.word} is {units.one_line(node.text)}"
    if key.positive and not value > 0.0:
        raise ConfigError(node.where, what, "give more than zero")
    if value and not SMALLEST_QUANTITY_SI < abs(value) < LARGEST_QUANTITY_SI:
        mend = f"check its digits and its unit, as in {key.example}"
        raise ConfigError(node.where, f"{what}, which no fed part has", mend)
    if key.dimension == "number" and value % 1.0:
        raise ConfigError(node.where, what, "give a whole number")
    return value


def _aspects(rows: Node | None, faults: list[FeederError]) -> list[CardBlock]:
    """Keywords of each CardAspect, and the fault of an aspect given twice."""
    if rows is None:
        return []
    if rows.kind != "list" or not rows.items:
        faults.append(ConfigError(rows.where, "aspects is not a list", "write - {aspect: 1, height: 6.9 mm}"))
        return []
    aspects, lines = [], dict[Any, str]()
    for row in rows.items:
        values = _read_block(row, ASPECT_KEYS, faults)
        name, angle = values.pop("aspect", None), row.find("solid_angle")
        if name in lines:
            what = f"aspect {units.quantity_text(name)} is already in line {lines[name].rsplit(':', 2)[1]}"
            faults.append(ConfigError(row.where, what, "keep one of them"))
        elif name is not None:
            lines[name] = row.where
        in_sr = angle is None or not angle.value.text.strip().endswith(RELATIVE_UNIT)
        own = values if name is None else {"name": name, **values}
        aspects.append(own | {"faces": int(values.get("faces", 1)), "solid_angle_in_sr": in_sr})
    return aspects


def _inertia(
    root: Node, rows: tuple[tuple[float, ...], ...] | None, faults: list[FeederError]
) -> tuple[Floats, tuple[str, ...]]:
    """(3, 3) [kg m2] symmetric inertia of a card, and what to say of it."""
    if rows is None:
        return np.zeros((3, 3)), ()
    printed, where = np.array(rows), root.find("inertia").value.where  # type: ignore[union-attr]
    upper = np.triu(printed) + np.triu(printed, 1).T
    if np.allclose(printed, upper, rtol=SYMMETRY_TOLERANCE, atol=0.0):
        remarks: tuple[str, ...] = ()
    elif np.allclose(np.abs(printed), np.abs(upper), rtol=SYMMETRY_TOLERANCE, atol=0.0):
        remarks = (f"{where}: the inertia matrix is not symmetric (signs differ): its upper half is used",)
    else:
        faults.append(ConfigError(where, "the inertia matrix is not symmetric", "make its halves equal"))
        return upper, ()
    moments, _ = mass.principal_inertia(upper)
    if moments[0] <= 0.0 or moments[0] + moments[1] < moments[2] * (1.0 - TRIANGLE_TOLERANCE):
        text = ", ".join(f"{moment / units.factor('g mm2', 'inertia'):.4g}" for moment in moments)
        what = f"no body has the principal moments {text} g mm2"
        faults.append(ConfigError(where, what, "the largest must not exceed the sum of the others"))
    return upper, remarks


MAX_NAME_LETTERS = 12  # letters of a name; 'none' is what tables say where there is no aspect
ASPECT_NAME = rf"[^\W_](?:[\w\-_.]{{0,{MAX_NAME_LETTERS - 2}}}\w)?"
EQUAL_DIRECTIONS_RAD = 1e-4  # [rad] directions closer than this are one
ASPECT_LINE_EXAMPLE = "write a line an aspect such as 'head_up: [0, 0, -1]' below 'aspects:'"


def read_aspect_names(path: str | PathLike[str]) -> AspectNames:
    """Return the names of a YAML file: below 'aspects:' one line 'name: [x, y, z]' an aspect.

    The vector points down when the part rests on that aspect, in the axes of the part file; its length does
    not matter.

    Parameters
    ----------
    path : str or path
        '-' is refused: standard input is for the part.

    Returns
    -------
    AspectNames

    Raises
    ------
    Faults
        With every fault of the file, one a line.
    ConfigError
        If the file cannot be read or is not YAML.
    """
    if str(path) == "-":
        raise ConfigError("-", "standard input is for the part", "save the names and give the file")
    data = documents.content(path, documents.MAX_DOCUMENT_BYTES, "a YAML file of names")
    root, faults = documents.load(data, str(path))
    if root.kind != "mapping":
        raise ConfigError(root.where, "is not a block of names", ASPECT_LINE_EXAMPLE)
    faults += [_unknown_key(entry, ["aspects"]) for entry in root.entries if entry.key != "aspects"]
    block = root.find("aspects")
    if block is None or block.value.kind != "mapping" or not block.value.entries:
        where = root.where if block is None else block.where
        faults.append(ConfigError(where, "names no aspect", ASPECT_LINE_EXAMPLE))
    vectors: dict[str, tuple[str, tuple[float, float, float]]] = {}  # by folded name: name, vector
    for entry in () if block is None or block.value.kind != "mapping" else block.value.entries:
        name, folded, quoted = entry.key, entry.key.casefold(), units.quantity_text(entry.key)
        try:
            # a name fit for tables, files and pictures
            if folded == "none" or not re.fullmatch(ASPECT_NAME, name):
                form = f"give 1 to {MAX_NAME_LETTERS} letters, digits, '-', '_' and '.'"
                mend = "choose another" if folded == "none" else f"{form}, the first a letter or a digit"
                raise ConfigError(entry.where, f"{quoted} cannot be the name of an aspect", mend)
            if folded in vectors:
                what = f"{quoted} and '{vectors[folded][0]}' differ in case only"
                raise ConfigError(entry.where, what, "give each its own name")
            down = _direction(entry)
            for other, own in vectors.values():
                if np.abs(np.subtract(down, own)).max() < EQUAL_DIRECTIONS_RAD:
                    what = f"{quoted} has the direction of '{other}'"
                    raise ConfigError(entry.where, what, "keep one of them")
            vectors[folded] = name, down
        except ConfigError as fault:
            faults.append(fault)
    documents.raise_all(faults)
    return AspectNames(str(path), hashlib.sha256(data).hexdigest(), tuple(vectors.values()))


def _direction(entry: Entry) -> tuple[float, float, float]:
    """(3,) the unit vector of one line."""
    node, mend = entry.value, "write three numbers, as [0, 0, -1]"
    what = f"the direction of {units.quantity_text(entry.key)}"
    if node.kind != "list" or len(node.items) != 3 or any(item.kind != "text" for item in node.items):
        raise ConfigError(node.where, f"{what} is not a list of three", mend)
    try:
        down = np.array([units.quantity(item.text, "number") for item in node.items])
    except units.QuantityError as fault:
        raise ConfigError(node.where, f"{what}: {fault.what}", mend) from None
    largest = np.abs(down).max()
    if largest == 0.0:
        raise ConfigError(node.where, f"{what} is zero", mend)
    down = down / largest
    return tuple((down / np.sqrt((down**2).sum())).tolist())
