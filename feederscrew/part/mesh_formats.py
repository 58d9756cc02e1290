"""Readers of OBJ, OFF, PLY and STL: files of one mesh, as text or binary.

Each returns a ``Soup``, and raises ValueError where a line cannot be read, a facet names a corner that is not
there, or the file holds less than it announces.
"""

import re
from dataclasses import dataclass, field
from itertools import chain, repeat
from typing import Any, Literal

import numpy as np

from feederscrew.base.arrays import Ints, Triangles
from feederscrew.base.errors import MeshError
from feederscrew.base.units import counted, quantity_text
from feederscrew.part import formats
from feederscrew.part.formats import (
    ANNOUNCES_MORE,
    DamageError,
    Decimals,
    Soup,
    mask_non_ascii,
    refuse_size,
    split_facets,
)

# By 'element.property': an array; of a list the sizes of its rows (R,), and all its numbers in one array.
PlyColumns = dict[str, Any]


def read_obj(data: bytes) -> Soup:
    """Return the triangles of an OBJ file; its objects, or without any its groups, keep their names.

    Parameters
    ----------
    data : bytes
        The file, without a byte order mark.

    Returns
    -------
    Soup

    Raises
    ------
    ValueError
        If it is damaged, or has more corners or facets than are read.
    """
    words: list[bytes] = []  # coordinates
    sizes: list[int] = []
    corners: list[int] = []  # counted from 1
    names: list[bytes] = [b""]
    objects: list[int] = []
    relative = False
    named = any(line.startswith(b"o ") for line in data[: 1 << 20].splitlines())  # groups are within objects
    for line in data.replace(b"\\\r\n", b" ").replace(b"\\\n", b" ").splitlines():
        parts = line.partition(b"#")[0].split()
        if not parts:
            continue
        if parts[0] == b"v":
            if len(parts) < 4:
                raise DamageError("a corner of fewer than three numbers")
            words += parts[1:4]
            if len(words) > 3 * formats.MAX_READ_CORNERS:
                refuse_size(len(words) // 3, 0)
        elif parts[0] in (b"f", b"fo"):
            indices = [int(word.partition(b"/")[0]) for word in parts[1:]]
            if min(indices, default=1) < 0:
                relative = True
                indices = [k if k > 0 else len(words) // 3 + 1 + k for k in indices]
            sizes.append(len(indices))
            corners += indices
            objects.append(len(names) - 1)
            if len(sizes) > formats.MAX_READ_FACETS:
                refuse_size(0, len(sizes))
        elif parts[0] == (b"o" if named else b"g"):
            names.append(b" ".join(parts[1:]))
    refuse_size(len(words) // 3, len(corners) - 2 * len(sizes))
    decimals = Decimals()
    vertices = decimals.read([mask_non_ascii(word) for word in words]).reshape(-1, 3)
    whole, begins, warnings = np.array(corners, dtype=np.int64), 1, decimals.warnings
    if len(whole) and whole.min() == 0:
        if relative or whole.max() >= len(vertices):
            raise DamageError("a facet names corner 0; OBJ counts from 1")
        begins = 0
        warnings += ("its facets count corners from 0, OBJ counts them from 1: read as counted from 0",)
    faces, facet = split_facets(vertices, np.array(sizes, dtype=np.int64), whole - begins)
    titles = tuple(name.decode(errors="replace") for name in names)
    of_object = np.array(objects, dtype=np.int64)[facet]
    return Soup(vertices, faces, "obj", warnings=warnings, names=titles, objects=of_object)


def read_off(data: bytes) -> Soup:
    """Return the triangles of an OFF file, in text.

    Parameters
    ----------
    data : bytes
        The file, without a byte order mark.

    Returns
    -------
    Soup

    Raises
    ------
    ValueError
        If it is damaged, binary, or has more corners or facets than are read.
    """
    text = mask_non_ascii(data).replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    text = re.sub(rb"\s*(?:ST)?C?N?OFF\b", b"", re.sub(rb"#[^\n]*", b"", text), count=1)
    lines = [line.split() for line in text.splitlines() if line.strip()]
    head = lines[0] if lines else []
    if head[:1] == [b"BINARY"]:
        raise DamageError("binary OFF is not read")
    corners, count = (int(word) for word in head[:2])
    if not 0 <= corners + count <= len(text) or corners < 0 or count < 0:
        raise DamageError(ANNOUNCES_MORE)
    refuse_size(corners, count)
    rows, coordinates, rings = lines[1:], [], []
    if len(lines) > 1 and len(rows) >= corners + count:  # a corner or a facet a line; a colour may follow
        if min(map(len, rows[:corners]), default=3) < 3:
            raise DamageError("a corner of fewer than three numbers")
        coordinates = [word for row in rows[:corners] for word in row[:3]]
        rings = [_ring(row) for row in rows[corners : corners + count]]
    else:  # lines that say nothing
        words = head[3:] if len(lines) == 1 else [word for row in rows for word in row]
        coordinates, at = words[: 3 * corners], 3 * corners
        for _ in range(count):
            if at >= len(words):
                raise DamageError(ANNOUNCES_MORE)
            rings.append(_ring(words[at : at + 1 + int(words[at])]))
            at += 1 + len(rings[-1])
    decimals = Decimals()
    vertices = decimals.read(coordinates).reshape(-1, 3)
    if len(vertices) != corners:
        raise DamageError(ANNOUNCES_MORE)
    sizes = np.array([len(ring) for ring in rings], dtype=np.int64)
    refuse_size(0, int(sizes.sum()) - 2 * len(sizes))
    faces, _ = split_facets(vertices, sizes, np.array([k for ring in rings for k in ring], np.int64))
    return Soup(vertices, faces, "off", warnings=decimals.warnings)


def _ring(words: list[bytes]) -> list[int]:
    size = int(words[0])
    if not 0 <= size < len(words):
        raise DamageError("a facet of fewer corners than it announces")
    return [int(word) for word in words[1 : size + 1]]


PLY_TYPES = {  # names of the specification, and of later writers
    **{"char": "i1", "uchar": "u1", "short": "i2", "ushort": "u2", "int": "i4", "uint": "u4"},
    **{"int8": "i1", "uint8": "u1", "int16": "i2", "uint16": "u2", "int32": "i4", "uint32": "u4"},
    **{"float": "f4", "double": "f8", "float32": "f4", "float64": "f8", "int64": "i8", "uint64": "u8"},
}
PLY_BYTE_ORDERS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}
PLY_STRIPS = ("tristrips", "tristrip")  # elements of triangles that share sides, as scanners write them
PLY_CORNER_LISTS = ("vertex_indices", "vertex_index")


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


def read_ply(data: bytes) -> Soup:
    """Return the triangles of a PLY file, in text or binary, from its facets and its triangle strips.

    Parameters
    ----------
    data : bytes
        The whole file.

    Returns
    -------
    Soup

    Raises
    ------
    ValueError
        If it is damaged, or has more corners or facets than are read.
    LookupError
        If its header names a type or an order of bytes that PLY has not.
    """
    end = re.search(rb"(?m)^[ \t]*end_header[ \t]*(?:\r\n|\n|\r)", data)
    if end is None:
        raise DamageError("its header does not end")
    order, elements = None, list[PlyElement]()
    for words in (line.split() for line in data[: end.start()].decode("ascii", "replace").splitlines()[1:]):
        match words:
            case ["format", name, *_]:
                order = PLY_BYTE_ORDERS[name]
            case ["element", name, rows]:
                if not rows.isascii() or not rows.isdigit():
                    raise DamageError(f"element {name}: no number of rows")
                elements.append(PlyElement(name, int(rows)))
            case ["property", "list", count, type, name]:
                elements[-1].properties.append(PlyProperty(name, PLY_TYPES[type], PLY_TYPES[count]))
            case ["property", type, name]:
                elements[-1].properties.append(PlyProperty(name, PLY_TYPES[type]))
    if order is None:
        raise DamageError("its header names no format")
    decimals = Decimals()
    if order == "":
        formats.refuse_text_size(data)
        columns = _ply_from_text(mask_non_ascii(data[end.end() :]).split(), elements, decimals)
    else:
        columns = _ply_from_bytes(data, end.end(), elements, order)
    if "vertex.x" not in columns:
        raise DamageError("it has no corners")
    vertices = np.stack([np.asarray(columns[f"vertex.{axis}"], dtype=float) for axis in "xyz"], axis=1)
    empty = np.empty(0, dtype=np.int64)
    lists = (columns[f"face.{name}"] for name in PLY_CORNER_LISTS if f"face.{name}" in columns)
    sizes, corners = next(lists, (empty, empty))
    refuse_size(len(vertices), int(sizes.sum()) - 2 * len(sizes))
    faces, _ = split_facets(vertices, sizes, corners)
    for name in PLY_STRIPS:
        lists = (columns[f"{name}.{kind}"] for kind in PLY_CORNER_LISTS if f"{name}.{kind}" in columns)
        faces = np.concatenate([faces, *(_strip_facets(size, ends, len(vertices)) for size, ends in lists)])
    return Soup(vertices, faces, "ply", warnings=decimals.warnings)


def _strip_facets(sizes: Ints, corners: Ints, count: int) -> Triangles:
    """Triangles (F, 3) of strips among ``count`` corners; a corner below 0 begins the next strip.

    Every other triangle runs the other way round. Ends where a corner repeats have no area, and are none.
    """
    if len(corners) and corners.max() >= count:
        raise DamageError("a strip names a corner that is not there")
    refuse_size(0, len(corners))
    strip = np.repeat(np.arange(len(sizes)), sizes)
    new = np.append(True, (strip[1:] != strip[:-1]) | (corners[:-1] < 0))[: len(corners)]
    first = np.maximum.accumulate(np.where(new, np.arange(len(corners)), 0))
    at = np.arange(max(len(corners) - 2, 0))
    at = at[(first[at] == first[at + 2]) & (corners[at + 2] >= 0)] if len(at) else at
    odd = (at - first[at]) % 2
    faces = np.stack([corners[at], corners[at + 1 + odd], corners[at + 2 - odd]], axis=1)
    return faces[(faces != np.roll(faces, 1, axis=1)).all(axis=1)]


def _ply_from_bytes(data: bytes, at: int, elements: list[PlyElement], order: str) -> PlyColumns:
    """Columns by 'element.property' of binary rows; lists as their sizes and all their numbers."""
    columns: PlyColumns = {}
    for element in elements:
        if not element.rows or not element.properties:
            continue
        least = sum(np.dtype(prop.count or prop.type).itemsize for prop in element.properties)
        if element.rows * least > len(data) - at:
            raise DamageError(ANNOUNCES_MORE)
        refuse_size(element.rows, 0 if element.name == "vertex" else element.rows)
        alike = _rows_alike(data, at, element, order)
        if alike is not None:
            columns |= {f"{element.name}.{name}": column for name, column in alike[0].items()}
            at = alike[1]
            continue
        # row by row where lists differ in length; of the lists those of corners only
        lists = (prop for prop in element.properties if prop.count and prop.name in PLY_CORNER_LISTS)
        corner_list = next(lists, None)
        widths = [[np.dtype(kind or "V0").itemsize for kind in (p.count, p.type)] for p in element.properties]
        byteorder: Literal["little", "big"] = "little" if order == "<" else "big"
        sizes, pieces = [], []
        row = list(zip(element.properties, widths))
        for prop, (head, width) in chain.from_iterable(repeat(row, element.rows)):
            length = int.from_bytes(data[at : at + head], byteorder) if head else 1
            end = at + head + length * width
            if end > len(data):
                raise DamageError(ANNOUNCES_MORE)
            if prop is corner_list:
                sizes.append(length)
                pieces.append(data[at + head : end])
            at = end
        if corner_list is not None:
            corners = np.frombuffer(b"".join(pieces), order + corner_list.type).astype(np.int64)
            columns[f"{element.name}.{corner_list.name}"] = (np.array(sizes, dtype=np.int64), corners)
    return columns


def _rows_alike(data: bytes, at: int, element: PlyElement, order: str) -> tuple[PlyColumns, int] | None:
    """Columns and the end of rows whose lists are as long as those of the first; None if they are not."""
    fields: list[Any] = []
    end = at
    for k, prop in enumerate(element.properties):
        width = np.dtype(prop.type).itemsize
        if not prop.count:
            fields.append((f"v{k}", order + prop.type))
            end += width
            continue
        head = np.dtype(prop.count).itemsize
        if end + head > len(data):
            raise DamageError(ANNOUNCES_MORE)
        length = int(np.frombuffer(data, order + prop.count, 1, end)[0])
        if not 0 <= length * width <= len(data) - end:
            raise DamageError(ANNOUNCES_MORE)
        fields += [(f"n{k}", order + prop.count), (f"v{k}", order + prop.type, (length,))]
        end += head + width * length
    dtype = np.dtype(fields)
    if at + dtype.itemsize * element.rows > len(data):
        if any(prop.count for prop in element.properties):
            return None
        raise DamageError(ANNOUNCES_MORE)
    rows = np.frombuffer(data, dtype, element.rows, at)
    columns: PlyColumns = {prop.name: rows[f"v{k}"] for k, prop in enumerate(element.properties)}
    for k, prop in enumerate(element.properties):
        if prop.count:
            lengths = rows[f"n{k}"]
            if (lengths != lengths[0]).any():
                return None
            columns[prop.name] = lengths.astype(np.int64), columns[prop.name].ravel().astype(np.int64)
    return columns, at + dtype.itemsize * element.rows


def _ply_from_text(words: list[bytes], elements: list[PlyElement], decimals: Decimals) -> PlyColumns:
    """Columns as ``_ply_from_bytes`` has them, of rows in text."""
    columns: PlyColumns = {}
    at = 0
    for element in elements:
        width = len(element.properties)
        if element.rows * width > len(words) - at:
            raise DamageError(ANNOUNCES_MORE)
        refuse_size(element.rows, 0 if element.name == "vertex" else element.rows)
        if not any(prop.count for prop in element.properties):
            end = at + width * element.rows
            for k, prop in enumerate(element.properties):
                if element.name == "vertex" and prop.name in "xyz":
                    columns[f"vertex.{prop.name}"] = decimals.read(words[at + k : end : width])
            at = end
            continue
        lists: dict[str, tuple[list[int], list[bytes]]] = {
            prop.name: ([], []) for prop in element.properties if prop.name in PLY_CORNER_LISTS
        }
        for _ in range(element.rows):
            for prop in element.properties:
                length = 1
                if prop.count:
                    length, at = int(words[at]), at + 1
                if not 0 <= length <= len(words) - at:
                    raise DamageError(ANNOUNCES_MORE)
                if prop.name in lists:
                    lists[prop.name][0].append(length)
                    lists[prop.name][1].extend(words[at : at + length])
                at += length
        for name, (sizes, corners) in lists.items():
            whole = np.array([int(word) for word in corners], dtype=np.int64)
            columns[f"{element.name}.{name}"] = (np.array(sizes, dtype=np.int64), whole)
    return columns


STL_RECORD = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
UNKNOWN_COUNTS = (0, 0xFFFFFFFF)  # what streaming exporters leave in the header
STL_SOLID_BEGIN = re.compile(rb"(?i)\s*solid\b([^\n]*?)(?=\bfacet\s+normal\b|\n|\Z)")  # and its name
STL_SOLID_END = re.compile(rb"(?i)\bendsolid\b[^\n]*?(?=\bsolid\b[^\n]{0,80}?\bfacet\s+normal\b|\n|\Z)")
STL_NEXT_SOLID = re.compile(rb"(?i)\bendfacet\s+(?=solid\b)")  # before the last one has ended
NOT_BLANK = re.compile(rb"\S")
STL_TAIL_BYTES = 2000  # [bytes] at the end of a text, the last name in them
STL_TRIANGLE = (
    b"facet normal - - - outer loop vertex - - - vertex - - - vertex - - - endloop endfacet".split()
)
STL_MARKS = [
    (at, word) for at, word in enumerate(STL_TRIANGLE) if word in (b"facet", b"outer", b"vertex", b"endfacet")
]
STL_COORDINATES = [at for at, word in enumerate(STL_TRIANGLE) if word == b"-" and at > 5]
EXPORT_OR_COPY_AGAIN = "export the part again, or copy the whole file"


def read_stl(data: bytes, kind: str, where: str) -> Soup:
    """Return the triangles of an STL file.

    Parameters
    ----------
    data : bytes
        The whole file.
    kind : str
        'stl' for the binary form, 'stl-ascii' for text.
    where : str
        The file, for error lines.

    Returns
    -------
    Soup
        With warnings where the file announces fewer facets than it has, or has bytes behind the last one.

    Raises
    ------
    MeshError
        If it is cut short, or has other words than an STL.
    TooManyFacetsError
        If it has more facets than are read.
    """
    if kind == formats.ASCII_STL:
        return _stl_from_text(data, where)
    if len(data) < formats.STL_HEADER_BYTES:
        what = f"is cut short: {len(data)} bytes, less than an STL header"
        raise MeshError(where, what, EXPORT_OR_COPY_AGAIN)
    count = formats.claimed_facets(data)
    warnings: tuple[str, ...] = ()
    whole, rest = divmod(len(data) - formats.STL_HEADER_BYTES, formats.STL_FACET_BYTES)
    if count != whole or rest:
        if rest == 0 and (count in UNKNOWN_COUNTS or count < whole):
            warnings = (f"the header says {count} facets, the file has {whole}: all of them are read",)
            count = whole
        elif count == 0 or count > whole:
            promised = "an unknown number of" if count in UNKNOWN_COUNTS else f"{count}"
            what = f"is cut short: {promised} facets announced, {whole} are there"
            raise MeshError(where, what, EXPORT_OR_COPY_AGAIN)
        else:
            extra = len(data) - formats.STL_HEADER_BYTES - formats.STL_FACET_BYTES * count
            warnings = (f"{extra} bytes after the last facet are left out",)
    refuse_size(0, count)
    records = np.frombuffer(data, STL_RECORD, count, formats.STL_HEADER_BYTES)
    with np.errstate(invalid="ignore"):  # a signalling NaN; the gate names it
        vertices = records["corners"].reshape(-1, 3).astype(float)
    return Soup(vertices, np.arange(len(vertices)).reshape(-1, 3), formats.BINARY_STL, warnings=warnings)


class WordError(ValueError):
    """A word that a text STL has not, or not there."""


@dataclass
class StlText:
    """The facets of a text, as they are read."""

    sizes: list[int] = field(default_factory=list)
    words: list[bytes] = field(default_factory=list)  # coordinates
    names: list[bytes] = field(default_factory=list)  # of the solids
    solids: list[int] = field(default_factory=list)  # of each facet
    whole: bool = True  # whether the last facet ends

    def take(self, block: bytes, name: bytes) -> None:
        """Add the facets of one solid.

        Parameters
        ----------
        block : bytes
            The text between the lines 'solid' and 'endsolid'.
        name : bytes
            Of the solid.

        Raises
        ------
        ValueError
            If a line that is no facet's is among them.
        """
        words = re.sub(rb"(?:#|//|;)[^\n]*", b"", block).lower().split()
        first, each = len(self.sizes), len(STL_TRIANGLE)
        if len(words) % each or any(set(words[at::each]) - {mark} for at, mark in STL_MARKS):
            self._take_word_by_word(words)
        else:  # facets of three corners and nothing else
            count = len(words) // each
            coordinates = [b""] * (9 * count)
            for k, at in enumerate(STL_COORDINATES):
                coordinates[k::9] = words[at::each]
            self.sizes += [3] * count
            self.words += coordinates
        self.names.append(name.strip())
        self.solids += [len(self.names) - 1] * (len(self.sizes) - first)

    def _take_word_by_word(self, words: list[bytes]) -> None:
        """Take facets of any number of corners, whose normals may be missing."""
        at, last = 0, len(words)
        while at < last:
            if words[at] != b"facet":
                raise WordError(words[at])
            try:
                at = words.index(b"outer", at, at + 7) + 2
            except ValueError:
                self.whole = last - at > 7
                if self.whole:
                    raise WordError(words[at + 1]) from None
                return
            size = 0
            while words[at : at + 1] == [b"vertex"]:
                if at + 4 > last:
                    self.whole = False
                    return
                if b"vertex" in words[at + 1 : at + 4] or b"endloop" in words[at + 1 : at + 4]:
                    raise DamageError("a corner of fewer than three numbers")
                self.words += words[at + 1 : at + 4]
                size, at = size + 1, at + 4
            self.sizes.append(size)
            if words[at : at + 2] != [b"endloop", b"endfacet"][: last - at]:
                raise WordError(words[at])
            if at + 2 > last:
                self.whole = False
                return
            at += 2


def _stl_from_text(data: bytes, where: str) -> Soup:
    whole = data.rstrip(b"\0")
    padding = len(data) - len(whole)
    warnings: tuple[str, ...] = (f"{padding} NUL bytes after the text are left out",) if padding else ()
    formats.refuse_text_size(whole)
    text = whole.removeprefix(b"\xef\xbb\xbf").replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    text = re.sub(rb"(?m)^[ \t]*(?:#|//|;)[^\n]*$", b"", text)
    read, decimals = StlText(), Decimals()
    cut = MeshError(where, "is cut short: the text does not end with 'endsolid'", EXPORT_OR_COPY_AGAIN)

    def ends() -> bool:
        return STL_SOLID_END.search(text, max(0, len(text) - STL_TAIL_BYTES)) is not None

    try:
        # solid by solid
        at, end = 0, STL_SOLID_END.search(text)
        while NOT_BLANK.search(text, at):
            begin = STL_SOLID_BEGIN.match(text, at)
            name, at = (begin[1], begin.end()) if begin else (b"", at)
            end = STL_SOLID_END.search(text, at) if end else None  # after the last there is none
            following = STL_NEXT_SOLID.search(text, at, end.start() if end else len(text))
            stop = following.start() + len(b"endfacet") if following else end.start() if end else len(text)
            read.take(text[at:stop], mask_non_ascii(name))
            at = end.end() if end and not following else stop
        if not read.whole:
            raise cut
        refuse_size(len(read.words) // 3, sum(read.sizes) - 2 * len(read.sizes))
        vertices = decimals.read(read.words).reshape(-1, 3)
    except formats.CommaError as error:
        raise MeshError(where, f"has {error}", "write numbers with a decimal point") from None
    except formats.TooManyFacetsError:
        raise
    except WordError as error:
        if not ends():
            raise cut from None
        what = f"has {quantity_text(error.args[0].decode(errors='replace'))} where an STL has none"
        raise MeshError(where, what, "remove it, or export the part again") from None
    except ValueError:
        if not ends():
            raise cut from None
        what = "has a 'vertex' line that is not three numbers"
        raise MeshError(where, what, "export the part again") from None
    sizes = np.array(read.sizes, dtype=np.int64)
    faces, facet = split_facets(vertices, sizes, np.arange(len(vertices)))
    if end is None:
        warnings += ("the text does not end with 'endsolid', and its last facet is whole: read to there",)
    names = tuple(name.decode(errors="replace") for name in read.names)
    warnings += decimals.warnings
    if len(larger := sizes[sizes > 3]):
        kind = "four corners" if (larger == 4).all() else "more than three corners"
        warnings += (f"{counted(len(larger), 'facet')} with {kind}: split into triangles",)
    objects = np.array(read.solids, np.int64)[facet]
    return Soup(vertices, faces, formats.ASCII_STL, warnings=warnings, names=names, objects=objects)
