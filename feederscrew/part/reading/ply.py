"""PLY files, as text or binary in either order of bytes: facets of any size, other properties passed over."""

import re
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np

from feederscrew.part.reading import facets
from feederscrew.part.reading.decimals import Decimals
from feederscrew.part.reading.formats import plain
from feederscrew.part.reading.soup import LARGEST_TEXT, DamageError, Soup, TooManyFacetsError, refuse_crowds

TYPES = {  # names of the specification, and of later writers
    **{"char": "i1", "uchar": "u1", "short": "i2", "ushort": "u2", "int": "i4", "uint": "u4"},
    **{"int8": "i1", "uint8": "u1", "int16": "i2", "uint16": "u2", "int32": "i4", "uint32": "u4"},
    **{"float": "f4", "double": "f8", "float32": "f4", "float64": "f8", "int64": "i8", "uint64": "u8"},
}
ORDERS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}
CORNERS = ("vertex_indices", "vertex_index")
HEAD_END = re.compile(rb"(?m)^[ \t]*end_header[ \t]*(?:\r\n|\n|\r)")
ANNOUNCES = "it announces more than it holds"


@dataclass(frozen=True)
class PlyProperty:
    """One property of an element: a number, or a list of numbers."""

    name: str
    type: str  # of numpy, without the order of bytes
    count: str = ""  # type of the length that precedes a list; '' for a number


@dataclass(frozen=True)
class PlyElement:
    """A kind of rows, as the header announces them."""

    name: str
    rows: int
    properties: list[PlyProperty] = field(default_factory=list)


def soup(data: bytes) -> Soup:
    """Return the triangles of a PLY file.

    Raises
    ------
    ValueError
        If its header cannot be read, or it holds less than that announces.
    """
    end = HEAD_END.search(data)
    if end is None:
        raise DamageError("its header does not end")
    order, elements = _header(data[: end.start()].decode("ascii", "replace"))
    decimals = Decimals()
    if order == "":
        if len(data) > LARGEST_TEXT:
            raise TooManyFacetsError(f"is text of more than {LARGEST_TEXT >> 20} MB")
        columns = _from_text(plain(data[end.end() :]).split(), elements, decimals)
    else:
        columns = _from_bytes(data, end.end(), elements, order)
    if "vertex.x" not in columns:
        raise DamageError("it has no corners")
    vertices = np.stack([np.asarray(columns[f"vertex.{axis}"], dtype=float) for axis in "xyz"], axis=1)
    empty = np.empty(0, dtype=np.int64)
    sizes, corners = next(
        (columns[f"face.{name}"] for name in CORNERS if f"face.{name}" in columns), (empty, empty)
    )
    refuse_crowds(len(vertices), int(sizes.sum()) - 2 * len(sizes))
    faces, _ = facets.triangles(vertices, sizes, corners)
    return Soup(vertices, faces, "ply", warnings=decimals.warnings)


def _header(text):
    """The order of bytes, '' for text, and the elements announced."""
    order, elements = None, []
    for words in (line.split() for line in text.splitlines()[1:]):
        match words:
            case ["format", name, *_]:
                order = ORDERS[name]
            case ["element", name, rows]:
                if not rows.isascii() or not rows.isdigit():
                    raise DamageError(f"element {name}: no number of rows")
                elements.append(PlyElement(name, int(rows)))
            case ["property", "list", count, type, name]:
                elements[-1].properties.append(PlyProperty(name, TYPES[type], TYPES[count]))
            case ["property", type, name]:
                elements[-1].properties.append(PlyProperty(name, TYPES[type]))
    if order is None:
        raise DamageError("its header names no format")
    for element in elements:
        if element.name in ("tristrips", "tristrip") and element.rows:
            raise DamageError("triangle strips are not read")
    return order, elements


def _from_bytes(data, at, elements, order):
    """Columns by 'element.property' of binary rows; lists as their sizes and all their numbers."""
    columns: dict[str, Any] = {}
    for element in elements:
        if not element.rows or not element.properties:
            continue
        least = sum(np.dtype(one.count or one.type).itemsize for one in element.properties)
        if element.rows * least > len(data) - at:
            raise DamageError(ANNOUNCES)
        refuse_crowds(element.rows, 0 if element.name == "vertex" else element.rows)
        read = _rows_alike(data, at, element, order) or _row_by_row(data, at, element, order)
        columns |= {f"{element.name}.{name}": column for name, column in read[0].items()}
        at = read[1]
    return columns


def _rows_alike(data, at, element, order):
    """Columns and the end of rows whose lists are as long as those of the first; None if they are not."""
    fields: list[Any] = []
    end = at
    for k, one in enumerate(element.properties):
        length = 0
        if one.count:
            width = np.dtype(one.count).itemsize
            if end + width > len(data):
                raise DamageError(ANNOUNCES)
            length = int(np.frombuffer(data, order + one.count, 1, end)[0])
            if not 0 <= length * np.dtype(one.type).itemsize <= len(data) - end:
                raise DamageError(ANNOUNCES)
            fields.append((f"n{k}", order + one.count))
            end += width
        fields.append((f"v{k}", order + one.type, (length,)) if one.count else (f"v{k}", order + one.type))
        end += np.dtype(one.type).itemsize * (length if one.count else 1)
    dtype = np.dtype(fields)
    if at + dtype.itemsize * element.rows > len(data):
        if any(one.count for one in element.properties):
            return None
        raise DamageError(ANNOUNCES)
    rows = np.frombuffer(data, dtype, element.rows, at)
    columns = {}
    for k, one in enumerate(element.properties):
        if one.count and (rows[f"n{k}"] != rows[f"n{k}"][0]).any():
            return None
        column = rows[f"v{k}"]
        columns[one.name] = (
            (rows[f"n{k}"].astype(np.int64), column.ravel().astype(np.int64)) if one.count else column
        )
    return columns, at + dtype.itemsize * element.rows


def _row_by_row(data, at, element, order):
    """Columns and the end of rows whose lists differ in length; of the lists those of corners only."""
    kept = next((one for one in element.properties if one.count and one.name in CORNERS), None)
    steps = [
        (one is kept, np.dtype(one.count).itemsize if one.count else 0, np.dtype(one.type).itemsize)
        for one in element.properties
    ]
    little: Literal["little", "big"] = "little" if order == "<" else "big"
    sizes, pieces = [], []
    for _ in range(element.rows):
        for wanted, counted, width in steps:
            length = 1
            if counted:
                length = int.from_bytes(data[at : at + counted], little)
                at += counted
            end = at + length * width
            if end > len(data):
                raise DamageError(ANNOUNCES)
            if wanted:
                sizes.append(length)
                pieces.append(data[at:end])
            at = end
    if kept is None:
        return {}, at
    corners = np.frombuffer(b"".join(pieces), order + kept.type).astype(np.int64)
    return {kept.name: (np.array(sizes, dtype=np.int64), corners)}, at


def _from_text(words, elements, decimals):
    """Columns as ``_from_bytes`` has them, of rows in text."""
    columns: dict[str, Any] = {}
    at = 0
    for element in elements:
        if element.rows * len(element.properties) > len(words) - at:
            raise DamageError(ANNOUNCES)
        refuse_crowds(element.rows, 0 if element.name == "vertex" else element.rows)
        if not any(one.count for one in element.properties):
            width = len(element.properties)
            end = at + width * element.rows
            for k, one in enumerate(element.properties):
                if element.name == "vertex" and one.name in "xyz":
                    columns[f"vertex.{one.name}"] = decimals.read(words[at + k : end : width])
            at = end
            continue
        lists: dict[str, Any] = {one.name: ([], []) for one in element.properties if one.name in CORNERS}
        for _ in range(element.rows):
            for one in element.properties:
                length = 1
                if one.count:
                    length, at = int(words[at]), at + 1
                if not 0 <= length <= len(words) - at:
                    raise DamageError(ANNOUNCES)
                if one.name in lists:
                    lists[one.name][0].append(length)
                    lists[one.name][1].extend(words[at : at + length])
                at += length
        for name, (sizes, corners) in lists.items():
            whole = np.array([int(word) for word in corners], dtype=np.int64)
            columns[f"{element.name}.{name}"] = (np.array(sizes, dtype=np.int64), whole)
    return columns
