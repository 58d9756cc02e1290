"""Members of ZIP archives, unpacked piece by piece and no further than a limit."""

import io
import lzma
import re
import zipfile
import zlib
from collections.abc import Iterator
from pathlib import PurePosixPath

from feederscrew.part.reading.soup import LARGEST, DamageError

DAMAGED = (zipfile.BadZipFile, zlib.error, lzma.LZMAError)  # what damaged archives raise
MOST_MEMBERS = 20_000
MOST_TIMES = 200  # a member unpacks to so many times its size: coordinates pack to a tenth or a thirtieth
SMALL = 1 << 24  # [bytes] below it any packing is harmless
PIECE = 1 << 20  # [bytes]
ENCRYPTED = 1  # of the flags of a member: APPNOTE.TXT of PKWARE, 4.4.4
ENTRY = b"PK\x01\x02"
STEP_NAME = re.compile(r"(?i)\.ste?p$")


class BombError(ValueError):
    """An archive that unpacks to more than is read."""


def opened(data: bytes) -> zipfile.ZipFile:
    """Return an archive of not too many members.

    Raises
    ------
    BombError
        If it has too many members.
    zipfile.BadZipFile, ValueError
        If it is damaged.
    """
    if data.count(ENTRY) > MOST_MEMBERS:
        raise BombError(f"is an archive of more than {MOST_MEMBERS} files")
    try:
        return zipfile.ZipFile(io.BytesIO(data))
    except (NotImplementedError, OSError):  # zipfile's, of a version or an offset of no archive
        raise DamageError("its archive is of a kind that is not read") from None


def pieces(archive: zipfile.ZipFile, name: str, most: int = LARGEST) -> Iterator[bytes]:
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
    _refuse_size(entry.file_size, entry.compress_size, most)  # as announced, which may be a lie
    try:
        member = archive.open(name)
    except (OSError, RuntimeError):  # zipfile's, of a password or of a packing that it does not know
        locked = bool(entry.flag_bits & ENCRYPTED)
        how = "locked by a password" if locked else "packed in a way that is not read"
        raise DamageError(f"its archive is {how}") from None
    with member:
        while piece := _next(member):
            size += len(piece)
            _refuse_size(size, entry.compress_size, most)
            yield piece


def _next(member):
    try:
        return member.read(PIECE)
    except OSError:  # bz2's
        raise DamageError("its archive is damaged") from None


def _refuse_size(size, packed, most):
    if size > most:
        raise BombError(f"unpacks to more than {most >> 20} MB")
    if size > max(SMALL, MOST_TIMES * packed):
        raise BombError(f"unpacks to more than {MOST_TIMES} times its size")


def content(archive: zipfile.ZipFile, name: str, most: int = LARGEST) -> bytes:
    """Return the whole of a member; raises as ``pieces``."""
    return b"".join(pieces(archive, name, most))


def step(data: bytes) -> bytes:
    """Return the one STEP file of a zipped one (.stpz).

    Raises
    ------
    ValueError
        If there are several, or it unpacks to too much.
    """
    with opened(data) as archive:
        names = [name for name in archive.namelist() if STEP_NAME.search(PurePosixPath(name).name)]
        if len(names) != 1:
            raise DamageError(f"an archive of {len(names)} STEP files")
        return content(archive, names[0])
