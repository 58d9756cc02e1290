"""Names that a user gives the aspects of a part: a YAML file with the direction that is down on each."""

import hashlib
import re
from dataclasses import dataclass
from typing import Any

import numpy as np

from feederscrew import documents, units
from feederscrew.errors import ConfigError

MAX_NAME_LETTERS = 12  # letters of a name
NAME_MARKS = "-_."  # that may stand between the letters and digits of a name
RESERVED_NAMES = ("none",)  # what tables say where there is no aspect
EQUAL_DIRECTIONS_RAD = 1e-4  # [rad] directions closer than this are one
ASPECT_LINE_EXAMPLE = "write a line an aspect such as 'head_up: [0, 0, -1]' below 'aspects:'"


@dataclass(frozen=True)
class AspectNames:
    """The names of one file, each with a direction in the axes of the part file."""

    source: str  # the path as given
    sha256: str  # of the file's bytes
    directions: tuple[tuple[str, tuple[float, float, float]], ...]  # unit vectors; down on that aspect

    @property
    def names(self) -> tuple[str, ...]:
        """The names in the order of the file."""
        return tuple(name for name, _ in self.directions)


def read_aspect_names(path) -> Any:
    """Read a file of names.

    Parameters
    ----------
    path : str or Path
        YAML: below 'aspects:' one line 'name: [x, y, z]' an aspect.

    Returns
    -------
    AspectNames

    Raises
    ------
    Faults
        Every fault of the file, one a line.
    ConfigError
        If it cannot be read or is not YAML.
    """
    if str(path) == "-":
        raise ConfigError("-", "standard input is for the part", "save the names and give the file")
    data = documents.content(path, documents.MAX_DOCUMENT_BYTES, "a YAML file of names")
    root, faults = documents.load(data, str(path))
    directions = _directions(_aspect_entries(root, faults), faults)
    documents.raise_all(faults)
    return AspectNames(str(path), hashlib.sha256(data).hexdigest(), directions)


def _aspect_entries(root, faults):
    """The entries below 'aspects:'."""
    if root.kind != "mapping":
        raise ConfigError(root.where, "is not a block of names", ASPECT_LINE_EXAMPLE)
    for entry in root.entries:
        if entry.key != "aspects":
            what = f"unknown key {units.quantity_text(entry.key)}"
            faults.append(ConfigError(entry.where, what, documents.hint(entry.key, ["aspects"])))
    block = root.find("aspects")
    if block is None or block.value.kind != "mapping" or not block.value.entries:
        faults.append(
            ConfigError(root.where if block is None else block.where, "names no aspect", ASPECT_LINE_EXAMPLE)
        )
        return ()
    return block.value.entries


def _directions(entries, faults) -> tuple[Any, ...]:
    """Names with their unit vectors; what is wrong is added to ``faults``."""
    named_directions: dict[str, tuple[str, tuple[float, ...]]] = {}  # by folded name: name, vector
    for entry in entries:
        try:
            name, down = _name(entry, named_directions), _direction(entry)
            _refuse_repeated_direction(entry, down, named_directions)
            named_directions[name.casefold()] = name, down
        except ConfigError as fault:
            faults.append(fault)
    return tuple(named_directions.values())


def _name(entry, named_directions) -> str:
    """The name of one line, fit for tables, files and pictures."""
    name = entry.key
    shape = rf"[^\W_](?:[\w{re.escape(NAME_MARKS)}]{{0,{MAX_NAME_LETTERS - 2}}}\w)?"
    if not re.fullmatch(shape, name) or name.casefold() in RESERVED_NAMES:
        what = f"{units.quantity_text(entry.key)} cannot be the name of an aspect"
        mend = (
            f"give 1 to {MAX_NAME_LETTERS} letters, digits, '-', '_' and '.', the first a letter or a digit"
        )
        raise ConfigError(
            entry.where, what, mend if name.casefold() not in RESERVED_NAMES else "choose another"
        )
    if name.casefold() in named_directions:
        what = f"{units.quantity_text(name)} and '{named_directions[name.casefold()][0]}' differ in case only"
        raise ConfigError(entry.where, what, "give each its own name")
    return name


def _direction(entry) -> tuple[float, float, float]:
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


def _refuse_repeated_direction(entry, down, named_directions) -> None:
    """Refuse a direction that another name has."""
    for name, other in named_directions.values():
        if np.abs(np.subtract(down, other)).max() < EQUAL_DIRECTIONS_RAD:
            what = f"{units.quantity_text(entry.key)} has the direction of '{name}'"
            raise ConfigError(entry.where, what, "keep one of them")
