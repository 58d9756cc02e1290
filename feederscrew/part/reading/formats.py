"""Which format a part file has, recognised by its bytes; members of archives, unpacked up to a limit."""

import io
import lzma
import re
import zipfile
import zlib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import PurePosixPath
from typing import Any

from feederscrew.documents import POINTER, POINTER_HEAD
from feederscrew.part.reading.soup import MAX_MESH_BYTES, DamageError

CARD_FORMAT, BINARY_STL, ASCII_STL = "card", "stl", "stl-ascii"
STL_HEADER_BYTES, STL_FACET_BYTES = 84, 50  # [bytes] of a binary STL
FORMAT_HEAD_BYTES = 1 << 16  # [bytes] looked at


@dataclass(frozen=True)
class Format:
    """What a format is called, and the unit its specification or its files state."""

    title: str
    suffixes: tuple[str, ...]
    needs: tuple[str, ...] = ()  # modules of an extra
    extra: str = ""


MESH_FORMATS = {
    BINARY_STL: Format("binary STL", ("stl",)),
    ASCII_STL: Format("ASCII STL", ("stl",)),
    "obj": Format("OBJ", ("obj",)),
    "ply": Format("PLY", ("ply",)),
    "off": Format("OFF", ("off",)),
    "glb": Format("GLB", ("glb",)),
    "3mf": Format("3MF", ("3mf",)),
    "step": Format("STEP", ("step", "stp", "stpz"), ("cascadio",), "step"),
    CARD_FORMAT: Format("a part card", ("yaml", "yml")),
}
FORMAT_MARKS = (  # pattern at the start of a file, and its format
    (rb"glTF", "glb"),
    (rb"ply[ \t]*[\r\n]", "ply"),
    (rb"(?:#[^\n]*\n|\s)*(?:ST)?C?N?OFF\b", "off"),
    (rb"\s*(?:/\*[^*]*\*/\s*)?ISO-10303-21", "step"),
)
UTF16_FAULT = "is text in UTF-16"
OTHER_FILES = (  # what people save under a mesh's name by mistake
    (re.escape(POINTER_HEAD), POINTER),
    (rb"\xff\xfe[\t-~]\0|\xfe\xff\0[\t-~]|(?:[\t-~]\0){8}|(?:\0[\t-~]){8}", UTF16_FAULT),
    (rb"(?i)\s*solid\b[^\0]*\bfacet\s+normal[^\0]*\0", "is ASCII STL with NUL bytes in the middle"),
    (rb"(?is)\s*<.{,2000}?(?<=<)(?:!doctype\s+html|html\b|head\b|body\b)", "is an HTML page, not a part"),
    (rb"(?s)\s*<\?xml.*<amf", "is an AMF file, which is not read"),
    (rb"\s*<", "is an XML file, not a part"),
    (rb"PK\x03\x04", "is a ZIP archive without a 3MF model"),
    (rb"\x1f\x8b|7z\xbc\xaf|Rar!", "is a compressed archive"),
    (rb"\x89PNG|\xff\xd8\xff|GIF8|BM", "is a picture, not a part"),
    (rb"%PDF", "is a PDF document, not a part"),
    (rb"\xd0\xcf\x11\xe0", "is a native CAD or Office file, which is not read"),
    (rb"\s*\{", "is a JSON file (glTF is read as .glb only)"),
)
ASCII_ONLY = bytes(byte if byte < 128 else ord("?") for byte in range(256))
OBJ_LINE = re.compile(rb"(?m)^[ \t]*v[ \t]+[-+.\d]\S*[ \t]+[-+.\d]\S*[ \t]+[-+.\d]")
MODEL_MEMBER = re.compile(rb"(?i)\.model")
STEP_MEMBER = re.compile(rb"(?i)\.ste?p")
STL_HEAD = re.compile(rb"(?i)(?:\s++|(?:#|//|;)[^\n]*\n)*+(?:solid\b|facet\s+normal\b)")
CARD_LINE = re.compile(rb"(?m)^(?:mass|centre_of_mass|inertia|aspects|floor|track)[ \t]*:")


def detect_format(data, suffix="") -> Any:
    """Return the format of a part file.

    Parameters
    ----------
    data : bytes
        The whole file.
    suffix : str
        Of its name, lower case, without the dot.

    Returns
    -------
    kind : str or None
        A key of ``MESH_FORMATS``; None where there is no mesh.
    alien : str or None
        What the file is instead.
    """
    if fits_binary_stl(data):
        return BINARY_STL, None
    head = data.rstrip(b"\0")[:FORMAT_HEAD_BYTES].removeprefix(b"\xef\xbb\xbf")
    kind = _format_by_mark(data, head) or _format_by_text(head, suffix)
    if kind:
        return kind, None
    alien = next((text for mark, text in OTHER_FILES if re.match(mark, head)), None)
    if alien is None and (suffix == "stl" or (b"\0" in head and len(data) > STL_HEADER_BYTES)):
        return BINARY_STL, None
    return None, alien or "is not a mesh: it has the marks of no known format"


def fits_binary_stl(data) -> bool:
    """Return whether the facet count of a binary STL agrees with the file's size."""
    return len(data) > STL_HEADER_BYTES and len(data) == STL_HEADER_BYTES + STL_FACET_BYTES * claimed_facets(
        data
    )


def mask_non_ascii(text) -> bytes:
    """Return the text with '?' for every letter beyond ASCII: numbers have none, names and comments do."""
    return text.translate(ASCII_ONLY)


def claimed_facets(data) -> int:
    """Return the facet count in the header of a binary STL."""
    return int.from_bytes(data[STL_HEADER_BYTES - 4 : STL_HEADER_BYTES], "little")


def _format_by_mark(data, head) -> str | None:
    if head.startswith(b"PK\x03\x04"):
        return "3mf" if MODEL_MEMBER.search(data) else "step" if STEP_MEMBER.search(data) else None
    return next((kind for mark, kind in FORMAT_MARKS if re.match(mark, head, re.DOTALL)), None)


def _format_by_text(head, suffix) -> Any:
    if b"\0" in head:
        return None
    if STL_HEAD.match(head) and re.search(rb"(?i)facet|endsolid", head):
        return ASCII_STL
    if OBJ_LINE.search(head):
        return "obj"
    if suffix == "" and CARD_LINE.search(head):
        return CARD_FORMAT
    return None


DAMAGED_ARCHIVE_ERRORS = (zipfile.BadZipFile, zlib.error, lzma.LZMAError)  # what damaged archives raise
MAX_ARCHIVE_MEMBERS = 20_000
MAX_PACKING_RATIO = (
    200  # a member unpacks to so many times its size: coordinates pack to a tenth or a thirtieth
)
HARMLESS_SIZE_BYTES = 1 << 24  # [bytes] below it any packing is harmless
UNPACK_PIECE_BYTES = 1 << 20  # [bytes]
ENCRYPTED_FLAG = 1  # of the flags of a member: APPNOTE.TXT of PKWARE, 4.4.4
ARCHIVE_ENTRY_MARK = b"PK\x01\x02"
STEP_FILE_NAME = re.compile(r"(?i)\.ste?p$")


class BombError(ValueError):
    """An archive that unpacks to more than is read."""


def open_archive(data: bytes) -> zipfile.ZipFile:
    """Return an archive of not too many members.

    Raises
    ------
    BombError
        If it has too many members.
    zipfile.BadZipFile, ValueError
        If it is damaged.
    """
    if data.count(ARCHIVE_ENTRY_MARK) > MAX_ARCHIVE_MEMBERS:
        raise BombError(f"is an archive of more than {MAX_ARCHIVE_MEMBERS} files")
    try:
        return zipfile.ZipFile(io.BytesIO(data))
    except (NotImplementedError, OSError):  # zipfile's, of a version or an offset of no archive
        raise DamageError("its archive is of a kind that is not read") from None


def unpack_pieces(archive: zipfile.ZipFile, name: str, most: int = MAX_MESH_BYTES) -> Iterator[bytes]:
    """Unpack a member piece by piece.

    Parameters
    ----------
    archive : ZipFile
    name : str
        Of the member.
    most : int [bytes]

    Yields
    ------
    bytes

    Raises
    ------
    BombError
        As soon as more is unpacked than ``most``, or than a mesh of its packed size can be.
    ValueError
        If it is locked by a password, packed in a way that is not read, or damaged.
    """
    entry, size = archive.getinfo(name), 0
    _refuse_unpacked_size(entry.file_size, entry.compress_size, most)  # as announced, which may be a lie
    try:
        member = archive.open(name)
    except (OSError, RuntimeError):  # zipfile's, of a password or of a packing that it does not know
        locked = bool(entry.flag_bits & ENCRYPTED_FLAG)
        how = "locked by a password" if locked else "packed in a way that is not read"
        raise DamageError(f"its archive is {how}") from None
    with member:
        while piece := _read_piece(member):
            size += len(piece)
            _refuse_unpacked_size(size, entry.compress_size, most)
            yield piece


def _read_piece(member) -> bytes:
    try:
        return member.read(UNPACK_PIECE_BYTES)
    except OSError:  # bz2's
        raise DamageError("its archive is damaged") from None


def _refuse_unpacked_size(size, packed, most) -> None:
    if size > most:
        raise BombError(f"unpacks to more than {most >> 20} MB")
    if size > max(HARMLESS_SIZE_BYTES, MAX_PACKING_RATIO * packed):
        raise BombError(f"unpacks to more than {MAX_PACKING_RATIO} times its size")


def unpack_member(archive: zipfile.ZipFile, name: str, most: int = MAX_MESH_BYTES) -> bytes:
    """Return the whole of a member; raises as ``pieces``."""
    return b"".join(unpack_pieces(archive, name, most))


def unpack_step(data: bytes) -> bytes:
    """Return the one STEP file of a zipped one (.stpz).

    Raises
    ------
    ValueError
        If there are several, or it unpacks to too much.
    """
    with open_archive(data) as archive:
        names = [name for name in archive.namelist() if STEP_FILE_NAME.search(PurePosixPath(name).name)]
        if len(names) != 1:
            raise DamageError(f"an archive of {len(names)} STEP files")
        return unpack_member(archive, names[0])
