"""Readers of OBJ, OFF, PLY and STL: files of one mesh, as text or binary."""

import re
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from feederscrew.errors import MeshError
from feederscrew.part.reading import soup
from feederscrew.part.reading.formats import (
    ASCII_STL,
    BINARY_STL,
    STL_FACET_BYTES,
    STL_HEADER_BYTES,
    claimed_facets,
    mask_non_ascii,
)
from feederscrew.part.reading.soup import (
    MAX_READ_CORNERS,
    MAX_READ_FACETS,
    MAX_TEXT_BYTES,
    CommaError,
    DamageError,
    Decimals,
    Soup,
    TooManyFacetsError,
    refuse_size,
)
from feederscrew.units import quantity_text

OBJ_FROM_ZERO_WARNING = "its facets count corners from 0, OBJ counts them from 1: read as counted from 0"


def read_obj(data: bytes) -> Soup:
    """Return the triangles of an OBJ file.

    Raises
    ------
    ValueError
        If a line cannot be read, or a facet names a corner that is not there.
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
            if len(words) > 3 * MAX_READ_CORNERS:
                refuse_size(len(words) // 3, 0)
        elif parts[0] in (b"f", b"fo"):
            indices = [int(word.partition(b"/")[0]) for word in parts[1:]]
            if min(indices, default=1) < 0:
                relative = True
                indices = [k if k > 0 else len(words) // 3 + 1 + k for k in indices]
            sizes.append(len(indices))
            corners += indices
            objects.append(len(names) - 1)
            if len(sizes) > MAX_READ_FACETS:
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
        begins, warnings = 0, (*warnings, OBJ_FROM_ZERO_WARNING)
    faces, facet = soup.split_facets(vertices, np.array(sizes, dtype=np.int64), whole - begins)
    titles = tuple(name.decode(errors="replace") for name in names)
    return Soup(faces=faces, vertices=vertices, format="obj", warnings=warnings, names=titles,
                objects=np.array(objects, dtype=np.int64)[facet])  # fmt: skip


OFF_COMMENT = re.compile(rb"#[^\n]*")
OFF_KEYWORD = re.compile(rb"\s*(?:ST)?C?N?OFF\b")


def read_off(data: bytes) -> Soup:
    """Return the triangles of an OFF file.

    Raises
    ------
    ValueError
        If it announces more than it holds, or a line cannot be read.
    """
    text = OFF_COMMENT.sub(b"", mask_non_ascii(data).replace(b"\r\n", b"\n").replace(b"\r", b"\n"))
    text = OFF_KEYWORD.sub(b"", text, count=1)
    lines = [line for line in text.splitlines() if line.strip()]
    head = lines[0].split() if lines else []
    if head[:1] == [b"BINARY"]:
        raise DamageError("binary OFF is not read")
    words = head[3:] if len(lines) == 1 else None  # all in one line
    corners, count = (int(word) for word in head[:2])
    if not 0 <= corners + count <= len(text) or corners < 0 or count < 0:
        raise DamageError("it announces more than it holds")
    refuse_size(corners, count)
    rows = lines[1:]
    if words is None and len(rows) >= corners + count:
        split = [row.split() for row in rows[:corners]]
        if min((len(row) for row in split), default=3) < 3:
            raise DamageError("a corner of fewer than three numbers")
        coordinates = [word for row in split for word in row[:3]]
        indices = [_ring(row.split()) for row in rows[corners : corners + count]]
    else:
        words = [word for row in rows for word in row.split()] if words is None else words
        coordinates, indices = words[: 3 * corners], _rings(words[3 * corners :], count)
    decimals = Decimals()
    vertices = decimals.read(coordinates).reshape(-1, 3)
    if len(vertices) != corners:
        raise DamageError("it announces more than it holds")
    sizes = np.array([len(ring) for ring in indices], dtype=np.int64)
    refuse_size(0, int(sizes.sum()) - 2 * len(sizes))
    faces, _ = soup.split_facets(vertices, sizes, np.array([k for ring in indices for k in ring], np.int64))
    return Soup(vertices, faces, "off", warnings=decimals.warnings)


def _ring(words) -> list[Any]:
    """Corners of the facet of one line; a colour may follow them."""
    size = int(words[0])
    if not 0 <= size < len(words):
        raise DamageError("a facet of fewer corners than it announces")
    return [int(word) for word in words[1 : size + 1]]


def _rings(words, count) -> Any:
    """Corners of facets whose lines are not kept."""
    rings, at = [], 0
    for _ in range(count):
        if at >= len(words):
            raise DamageError("it announces more than it holds")
        rings.append(_ring(words[at : at + 1 + int(words[at])]))
        at += 1 + len(rings[-1])
    return rings


PLY_TYPES = {  # names of the specification, and of later writers
    **{"char": "i1", "uchar": "u1", "short": "i2", "ushort": "u2", "int": "i4", "uint": "u4"},
    **{"int8": "i1", "uint8": "u1", "int16": "i2", "uint16": "u2", "int32": "i4", "uint32": "u4"},
    **{"float": "f4", "double": "f8", "float32": "f4", "float64": "f8", "int64": "i8", "uint64": "u8"},
}
PLY_BYTE_ORDERS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}
PLY_CORNER_LISTS = ("vertex_indices", "vertex_index")
PLY_HEAD_END = re.compile(rb"(?m)^[ \t]*end_header[ \t]*(?:\r\n|\n|\r)")
ANNOUNCES_MORE = "it announces more than it holds"


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
    """Return the triangles of a PLY file.

    Raises
    ------
    ValueError
        If its header cannot be read, or it holds less than that announces.
    """
    end = PLY_HEAD_END.search(data)
    if end is None:
        raise DamageError("its header does not end")
    order, elements = _header(data[: end.start()].decode("ascii", "replace"))
    decimals = Decimals()
    if order == "":
        if len(data) > MAX_TEXT_BYTES:
            raise TooManyFacetsError(f"is text of more than {MAX_TEXT_BYTES >> 20} MB")
        columns = _ply_from_text(mask_non_ascii(data[end.end() :]).split(), elements, decimals)
    else:
        columns = _ply_from_bytes(data, end.end(), elements, order)
    if "vertex.x" not in columns:
        raise DamageError("it has no corners")
    vertices = np.stack([np.asarray(columns[f"vertex.{axis}"], dtype=float) for axis in "xyz"], axis=1)
    empty = np.empty(0, dtype=np.int64)
    sizes, corners = next(
        (columns[f"face.{name}"] for name in PLY_CORNER_LISTS if f"face.{name}" in columns), (empty, empty)
    )
    refuse_size(len(vertices), int(sizes.sum()) - 2 * len(sizes))
    faces, _ = soup.split_facets(vertices, sizes, corners)
    return Soup(vertices, faces, "ply", warnings=decimals.warnings)


def _header(text) -> Any:
    """The order of bytes, '' for text, and the elements announced."""
    order, elements = None, []
    for words in (line.split() for line in text.splitlines()[1:]):
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
    for element in elements:
        if element.name in ("tristrips", "tristrip") and element.rows:
            raise DamageError("triangle strips are not read")
    return order, elements


def _ply_from_bytes(data, at, elements, order) -> Any:
    """Columns by 'element.property' of binary rows; lists as their sizes and all their numbers."""
    columns: dict[str, Any] = {}
    for element in elements:
        if not element.rows or not element.properties:
            continue
        least = sum(np.dtype(prop.count or prop.type).itemsize for prop in element.properties)
        if element.rows * least > len(data) - at:
            raise DamageError(ANNOUNCES_MORE)
        refuse_size(element.rows, 0 if element.name == "vertex" else element.rows)
        read = _rows_alike(data, at, element, order) or _row_by_row(data, at, element, order)
        columns |= {f"{element.name}.{name}": column for name, column in read[0].items()}
        at = read[1]
    return columns


def _rows_alike(data, at, element, order) -> tuple[Any, ...] | None:
    """Columns and the end of rows whose lists are as long as those of the first; None if they are not."""
    fields: list[Any] = []
    end = at
    for k, prop in enumerate(element.properties):
        length = 0
        if prop.count:
            width = np.dtype(prop.count).itemsize
            if end + width > len(data):
                raise DamageError(ANNOUNCES_MORE)
            length = int(np.frombuffer(data, order + prop.count, 1, end)[0])
            if not 0 <= length * np.dtype(prop.type).itemsize <= len(data) - end:
                raise DamageError(ANNOUNCES_MORE)
            fields.append((f"n{k}", order + prop.count))
            end += width
        fields.append((f"v{k}", order + prop.type, (length,)) if prop.count else (f"v{k}", order + prop.type))
        end += np.dtype(prop.type).itemsize * (length if prop.count else 1)
    dtype = np.dtype(fields)
    if at + dtype.itemsize * element.rows > len(data):
        if any(prop.count for prop in element.properties):
            return None
        raise DamageError(ANNOUNCES_MORE)
    rows = np.frombuffer(data, dtype, element.rows, at)
    columns = {}
    for k, prop in enumerate(element.properties):
        if prop.count and (rows[f"n{k}"] != rows[f"n{k}"][0]).any():
            return None
        column = rows[f"v{k}"]
        columns[prop.name] = (
            (rows[f"n{k}"].astype(np.int64), column.ravel().astype(np.int64)) if prop.count else column
        )
    return columns, at + dtype.itemsize * element.rows


def _row_by_row(
    data, at, element, order
) -> tuple[dict[str, tuple[NDArray[np.int64], NDArray[np.int64]]], int]:
    """Columns and the end of rows whose lists differ in length; of the lists those of corners only."""
    corner_list = next(
        (prop for prop in element.properties if prop.count and prop.name in PLY_CORNER_LISTS), None
    )
    steps = [
        (
            prop is corner_list,
            np.dtype(prop.count).itemsize if prop.count else 0,
            np.dtype(prop.type).itemsize,
        )
        for prop in element.properties
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
                raise DamageError(ANNOUNCES_MORE)
            if wanted:
                sizes.append(length)
                pieces.append(data[at:end])
            at = end
    if corner_list is None:
        return {}, at
    corners = np.frombuffer(b"".join(pieces), order + corner_list.type).astype(np.int64)
    return {corner_list.name: (np.array(sizes, dtype=np.int64), corners)}, at


def _ply_from_text(words, elements, decimals) -> Any:
    """Columns as ``_ply_from_bytes`` has them, of rows in text."""
    columns: dict[str, Any] = {}
    at = 0
    for element in elements:
        if element.rows * len(element.properties) > len(words) - at:
            raise DamageError(ANNOUNCES_MORE)
        refuse_size(element.rows, 0 if element.name == "vertex" else element.rows)
        if not any(prop.count for prop in element.properties):
            width = len(element.properties)
            end = at + width * element.rows
            for k, prop in enumerate(element.properties):
                if element.name == "vertex" and prop.name in "xyz":
                    columns[f"vertex.{prop.name}"] = decimals.read(words[at + k : end : width])
            at = end
            continue
        lists: dict[str, Any] = {
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
STL_COMMENT_LINE = re.compile(rb"(?m)^[ \t]*(?:#|//|;)[^\n]*$")
STL_COMMENT = re.compile(rb"(?:#|//|;)[^\n]*")
STL_SOLID_BEGIN = re.compile(
    rb"(?i)\s*solid\b([^\n]*?)(?=\bfacet\s+normal\b|\n|\Z)"
)  # a name ends with its line
STL_SOLID_END = re.compile(rb"(?i)\bendsolid\b[^\n]*?(?=\bsolid\b[^\n]{0,80}?\bfacet\s+normal\b|\n|\Z)")
STL_NEXT_SOLID = re.compile(
    rb"(?i)\bendfacet\s+(?=solid\b)"
)  # where a solid begins before the last one has ended
NOT_BLANK = re.compile(rb"\S")
STL_TAIL_BYTES = 2000  # [bytes] at the end of a text, the last name in them
STL_FACET_WORDS = 21  # of a facet of three corners
EXPORT_OR_COPY_AGAIN = "export the part again, or copy the whole file"


def read_stl(data, kind, where) -> Soup:
    """Read the triangles of an STL file.

    Parameters
    ----------
    data : bytes
    kind : str
        'stl' or 'stl-ascii'.
    where : str
        The file, for error lines.

    Returns
    -------
    Soup

    Raises
    ------
    MeshError
        If the file is cut short or not readable.
    """
    return _binary(data, where) if kind == BINARY_STL else _ascii(data, where)


def _binary(data, where) -> Soup:
    data, warnings = _honest(data, where)
    refuse_size(0, (len(data) - STL_HEADER_BYTES) // STL_FACET_BYTES)
    records = np.frombuffer(data, dtype=STL_RECORD, offset=STL_HEADER_BYTES)
    with np.errstate(invalid="ignore"):  # a signalling NaN; the gate names it
        vertices = records["corners"].reshape(-1, 3).astype(float)
    return Soup(vertices, np.arange(len(vertices)).reshape(-1, 3), BINARY_STL, warnings=warnings)


def _honest(data, where) -> tuple[Any, ...]:
    """A binary STL whose count agrees with its size, and what had to be done for that."""
    if len(data) < STL_HEADER_BYTES:
        raise MeshError(
            where, f"is cut short: {len(data)} bytes, less than an STL header", EXPORT_OR_COPY_AGAIN
        )
    count = claimed_facets(data)
    whole, rest = divmod(len(data) - STL_HEADER_BYTES, STL_FACET_BYTES)
    if count == whole and rest == 0:
        return data, ()
    if rest == 0 and (count in UNKNOWN_COUNTS or count < whole):
        sentence = f"the header says {count} facets, the file has {whole}: all of them are read"
        return _recounted(data, whole), (sentence,)
    if count == 0 or count > whole:
        promised = "an unknown number of" if count in UNKNOWN_COUNTS else f"{count}"
        raise MeshError(
            where, f"is cut short: {promised} facets announced, {whole} are there", EXPORT_OR_COPY_AGAIN
        )
    extra = len(data) - STL_HEADER_BYTES - STL_FACET_BYTES * count
    return data[:-extra], (f"{extra} bytes after the last facet are left out",)


def _recounted(data, count) -> bytes:
    return data[: STL_HEADER_BYTES - 4] + count.to_bytes(4, "little") + data[STL_HEADER_BYTES:]


def _ascii(data, where) -> Soup:
    whole = data.rstrip(b"\0")
    padding = len(data) - len(whole)
    warnings = (f"{padding} NUL bytes after the text are left out",) if padding else ()
    if len(whole) > MAX_TEXT_BYTES:
        raise TooManyFacetsError(f"is text of more than {MAX_TEXT_BYTES >> 20} MB")
    text = whole.removeprefix(b"\xef\xbb\xbf").replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    return _stl_from_text(STL_COMMENT_LINE.sub(b"", text), warnings, where)


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

        Raises
        ------
        ValueError
            If a line that is no facet's is among them.
        """
        words = (STL_COMMENT.sub(b"", block) if re.search(rb"#|//|;", block) else block).lower().split()
        first = len(self.sizes)
        if not self._triangles(words):
            self._facets(words)
        self.names.append(name.strip())
        self.solids += [len(self.names) - 1] * (len(self.sizes) - first)

    def _triangles(self, words) -> bool:
        """Take words that are facets of three corners and nothing else."""
        if len(words) % STL_FACET_WORDS:
            return False
        marks = (
            (0, b"facet"),
            (5, b"outer"),
            (7, b"vertex"),
            (11, b"vertex"),
            (15, b"vertex"),
            (20, b"endfacet"),
        )
        if any(set(words[at::STL_FACET_WORDS]) - {mark} for at, mark in marks):
            return False
        count = len(words) // STL_FACET_WORDS
        coordinates = [b""] * (9 * count)
        for k, at in enumerate((8, 9, 10, 12, 13, 14, 16, 17, 18)):
            coordinates[k::9] = words[at::STL_FACET_WORDS]
        self.sizes += [3] * count
        self.words += coordinates
        return True

    def _facets(self, words) -> None:
        """Take the words one by one; a facet may have any number of corners, and its normal be missing."""
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


def _stl_from_text(text, warnings, where) -> Soup:
    read, decimals = StlText(), Decimals()
    try:
        ended = _read_solids(text, read)
        if not read.whole:
            raise _stl_cut_short(where)
        refuse_size(len(read.words) // 3, sum(read.sizes) - 2 * len(read.sizes))
        vertices = decimals.read(read.words).reshape(-1, 3)
    except CommaError as error:
        raise MeshError(where, f"has {error}", "write numbers with a decimal point") from None
    except TooManyFacetsError:
        raise
    except WordError as error:
        if STL_SOLID_END.search(text, max(0, len(text) - STL_TAIL_BYTES)) is None:
            raise _stl_cut_short(where) from None
        word = quantity_text(error.args[0].decode(errors="replace"))
        raise MeshError(
            where, f"has {word} where an STL has none", "remove it, or export the part again"
        ) from None
    except ValueError:
        raise (
            _stl_garbled if STL_SOLID_END.search(text, max(0, len(text) - STL_TAIL_BYTES)) else _stl_cut_short
        )(where) from None
    sizes = np.array(read.sizes, dtype=np.int64)
    faces, facet = soup.split_facets(vertices, sizes, np.arange(len(vertices)))
    if not ended:
        warnings += ("the text does not end with 'endsolid', and its last facet is whole: read to there",)
    names = tuple(name.decode(errors="replace") for name in read.names)
    all_warnings = (*warnings, *decimals.warnings, *soup.split_warning(sizes))
    return Soup(
        vertices,
        faces,
        ASCII_STL,
        warnings=all_warnings,
        names=names,
        objects=np.array(read.solids, np.int64)[facet],
    )


def _read_solids(text, read) -> bool | None:
    """Take the text solid by solid; whether the last one ends."""
    at, end = 0, STL_SOLID_END.search(text)
    while NOT_BLANK.search(text, at):
        begin = STL_SOLID_BEGIN.match(text, at)
        name, at = (begin[1], begin.end()) if begin else (b"", at)
        end = STL_SOLID_END.search(text, at) if end else None  # after the last there is none
        following = STL_NEXT_SOLID.search(text, at, end.start() if end else len(text))
        stop = following.start() + len(b"endfacet") if following else end.start() if end else len(text)
        read.take(text[at:stop], mask_non_ascii(name))
        at = end.end() if end and not following else stop
    return end is not None


def _stl_cut_short(where) -> MeshError:
    return MeshError(where, "is cut short: the text does not end with 'endsolid'", EXPORT_OR_COPY_AGAIN)


def _stl_garbled(where) -> MeshError:
    return MeshError(where, "has a 'vertex' line that is not three numbers", "export the part again")
