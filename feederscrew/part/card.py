"""Part cards: parts known by published data only, as YAML with units in the text; every key of one."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from feederscrew import check, documents, units
from feederscrew.errors import ConfigError
from feederscrew.part import mass
from feederscrew.part.record import CardAspect, Part


@dataclass(frozen=True)
class CardKey:
    """One key of a part card."""

    word: str
    dimension: str  # of feederscrew.units, or 'text', 'section', 'rows'
    example: str
    required: bool = False
    shape: tuple[int, ...] = ()  # of a list; () for one value
    positive: bool = True
    choices: tuple[str, ...] = ()  # of a text; any text where it is empty


MATRIX_EXAMPLE = "three rows of three, as in [95.3 g mm2, 0 g mm2, -24.5 g mm2]"

TRACK_EQUATION_AXES = ("tilted", "level")  # by the bank of the track, or not: of the printed track equations

CARD_KEYS = (
    CardKey("mass", "mass", "1.98 g", required=True),
    CardKey("centre_of_mass", "length", "[3.3 mm, 0 mm, 9 mm]", required=True, shape=(3,), positive=False),
    CardKey("inertia", "inertia", MATRIX_EXAMPLE, required=True, shape=(3, 3), positive=False),
    CardKey("aspects", "rows", "- {aspect: 1, height: 6.9 mm}", required=True),
    CardKey("floor", "section", "{aspect: 1, drive_offset: 3.2 mm}"),
    CardKey("track", "section", "{wall_lever: 8 mm, wall_lever_angle: 64 deg}"),
)
ASPECT_KEYS = (
    CardKey("aspect", "text", "1", required=True),
    CardKey("height", "length", "6.9 mm", required=True),
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
SMALLEST_QUANTITY_SI, LARGEST_QUANTITY_SI = (
    1e-18,
    1e9,
)  # in SI units: between lies every length, area, mass and moment of a part


def read_card(file) -> Part | None:
    """Read a part from a part card.

    Parameters
    ----------
    file : feederscrew.part.loading.File

    Returns
    -------
    Part
        Without volume, density and surface.

    Raises
    ------
    Faults
        Every fault of the card, one a line.
    ConfigError
        If it is not YAML.

    Notes
    -----
    Where print gives an inertia matrix whose halves differ in sign alone, the card keeps it as printed; the
    upper half is used and a warning says so. Their mean would lose the product of inertia.
    """
    root, faults = documents.load(file.data, file.where)
    if root.kind != "mapping":
        needed = ", ".join(key.word for key in CARD_KEYS if key.required)
        raise ConfigError(root.where, "no 'key: value' line", f"write {needed}")
    values = _mapping(root, CARD_KEYS, faults)
    aspects = _aspects(values.get("aspects"), faults)
    printed = {key: _mapping(values[key], keys, faults) for key, keys in PRINTED_BLOCKS if key in values}
    faults += _unlisted_aspects(root, printed, aspects)
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


def _mapping(node, keys, faults):
    """Values by word, in SI units; what is wrong is added to ``faults``."""
    if node.kind != "mapping":
        what = "is not a block of 'key: value' lines"
        faults.append(ConfigError(node.where, what, f"give it {', '.join(key.word for key in keys)}"))
        return {}
    key_by_word = {key.word: key for key in keys}
    values = {}
    for entry in node.entries:
        if entry.key not in key_by_word:
            what = f"unknown key {units.quantity_text(entry.key)}"
            faults.append(ConfigError(entry.where, what, documents.hint(entry.key, list(key_by_word))))
            continue
        try:
            values[entry.key] = _value(key_by_word[entry.key], entry.value)
        except ConfigError as fault:
            faults.append(fault)
    words = {entry.key for entry in node.entries}
    missing = [key for key in keys if key.required and key.word not in words]
    if missing:
        what = f"without {' and '.join(key.word for key in missing)}"
        faults.append(ConfigError(node.where, what, f"add {missing[0].word}: {missing[0].example}"))
    return values


def _value(key, node):
    if key.dimension in ("section", "rows"):
        return node
    return _listed(key, node, key.shape)


def _listed(key, node, shape):
    if shape:
        if node.kind != "list" or len(node.items) != shape[0]:
            raise ConfigError(node.where, f"{key.word} is not a list of {shape[0]}", f"write {key.example}")
        return tuple(_listed(key, item, shape[1:]) for item in node.items)
    if node.kind != "text" or not node.text:
        raise ConfigError(node.where, f"{key.word} has no value", f"write {key.example}")
    if key.choices and node.text not in key.choices:
        what = f"{key.word} is {units.quantity_text(node.text)}"
        raise ConfigError(node.where, what, f"give {' or '.join(key.choices)}")
    return node.text if key.dimension == "text" else _quantity(key, node)


def _quantity(key, node) -> float:
    try:
        if key.dimension == "solid angle" and units.split(node.text)[1] == RELATIVE_UNIT:
            value = units.split(node.text)[0]
        else:
            value = units.quantity(node.text, key.dimension)
    except units.QuantityError as fault:
        raise ConfigError(node.where, f"{key.word}: {fault.what}", fault.mend) from None
    if key.positive and not value > 0.0:
        raise ConfigError(node.where, f"{key.word} is {units.one_line(node.text)}", "give more than zero")
    if value and not SMALLEST_QUANTITY_SI < abs(value) < LARGEST_QUANTITY_SI:
        what = f"{key.word} is {units.one_line(node.text)}, which no fed part has"
        raise ConfigError(node.where, what, f"check its digits and its unit, as in {key.example}")
    if key.dimension == "number" and value % 1.0:
        raise ConfigError(node.where, f"{key.word} is {units.one_line(node.text)}", "give a whole number")
    return value


def _aspects(rows, faults):
    """Keywords of each CardAspect, and the fault of an aspect given twice."""
    if rows is None:
        return []
    if rows.kind != "list" or not rows.items:
        faults.append(ConfigError(rows.where, "aspects is not a list", "write - {aspect: 1, height: 6.9 mm}"))
        return []
    aspects, lines = [], dict[Any, str]()
    for row in rows.items:
        values = _mapping(row, ASPECT_KEYS, faults)
        name = values.get("aspect")
        if name in lines:
            what = f"aspect {units.quantity_text(name)} is already in line {lines[name].rsplit(':', 2)[1]}"
            faults.append(ConfigError(row.where, what, "keep one of them"))
        elif name is not None:
            lines[name] = row.where
        aspects.append(_keywords(values, row))
    return aspects


def _keywords(values, row) -> Any:
    angle = row.find("solid_angle")
    in_sr = angle is None or not angle.value.text.strip().endswith(RELATIVE_UNIT)
    renamed = {"name" if word == "aspect" else word: value for word, value in values.items()}
    return renamed | {"faces": int(values.get("faces", 1)), "solid_angle_in_sr": in_sr}


def _unlisted_aspects(root, printed, aspects) -> list[Any]:
    """Faults of blocks that name an aspect the card does not list."""
    names = [aspect.get("name") for aspect in aspects]
    return [
        ConfigError(
            root.find(block).value.find("aspect").value.where,
            f"{block}: the card lists no aspect {units.quantity_text(values['aspect'])}",
            f"known are {', '.join(map(str, names))}",
        )
        for block, values in printed.items()
        if "aspect" in values and values["aspect"] not in names
    ]


def _inertia(root, rows, faults) -> tuple[Any, ...]:
    """(3, 3) [kg m2] symmetric inertia of a card, and what to say of it."""
    if rows is None:
        return np.zeros((3, 3)), ()
    printed, where = np.array(rows), root.find("inertia").value.where
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
