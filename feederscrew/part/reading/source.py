"""From a path or standard input to triangles as the file has them, nothing mended yet."""

import hashlib
import sys
from dataclasses import dataclass
from pathlib import Path

from feederscrew import documents
from feederscrew.errors import MeshError
from feederscrew.part.reading import formats, scenes, stl
from feederscrew.part.reading.formats import CARD, FORMATS
from feederscrew.part.reading.soup import LARGEST, Soup

EXPORT = "export the part as STL, OBJ, PLY, OFF, GLB, 3MF or STEP"


@dataclass(frozen=True)
class File:
    """The bytes of a part file and what to call it."""

    source: str  # as given, '-' for standard input
    where: str  # for error lines
    name: str  # file stem
    suffix: str  # lower case, without the dot; '' for standard input
    data: bytes
    sha256: str


def file(source, stdin=None):
    """Read the bytes of a part file.

    Parameters
    ----------
    source : str or Path
        '-' reads standard input.
    stdin : binary file, optional
        Read in place of the file or of the process's own standard input.

    Returns
    -------
    File

    Raises
    ------
    MeshError
        If there is no such file, it cannot be read, is empty or is too large.
    """
    source = str(source)
    where = "standard input" if source == "-" else source
    data = _bytes(source, where, stdin)
    if not data:
        raise MeshError(where, "is empty", "export the part again")
    if len(data) > LARGEST:
        raise MeshError(where, f"is larger than {LARGEST >> 20} MB", "export it with fewer facets")
    path = Path("stdin" if source == "-" else source)
    digest = hashlib.sha256(data).hexdigest()
    return File(source, where, path.stem, path.suffix.lower().removeprefix("."), data, digest)


def soup(file):
    """Read the triangles of a mesh file.

    Parameters
    ----------
    file : File

    Returns
    -------
    Soup

    Raises
    ------
    MeshError
        If the content is of no known format, or is cut short or damaged.
    """
    kind, alien = formats.detect(file.data, file.suffix)
    if kind in (None, CARD):
        mend = "save it as ASCII or UTF-8 text" if alien == formats.UTF16 else EXPORT
        raise MeshError(file.where, alien or "is a part card, not a mesh", mend)
    reader = stl.soup if kind.startswith("stl") else scenes.soup
    found = reader(file.data, kind, file.where)
    if not len(found.faces):
        raise MeshError(file.where, "has no facets", "export the part again as a solid")
    return Soup(found.vertices, found.faces, kind, found.unit, _misnamed(file, kind) + found.warnings)


def is_card(file):
    """Return whether the file is a part card: by its name, or by its content on standard input."""
    if file.suffix in FORMATS[CARD].suffixes:
        return True
    return formats.detect(file.data, file.suffix)[0] == CARD


def _bytes(source, where, stdin):
    if source != "-" and stdin is None:
        return documents.content(source, LARGEST, "a part file", MeshError)
    try:
        return documents.upto(stdin or sys.stdin.buffer, LARGEST)
    except (OSError, ValueError) as error:
        raise MeshError(where, f"cannot be read ({error})", "check what it comes from") from None


def _misnamed(file, kind):
    known = {suffix for format in FORMATS.values() for suffix in format.suffixes}
    if file.suffix not in known or file.suffix in FORMATS[kind].suffixes:
        return ()
    return (f"named .{file.suffix} but its content is {FORMATS[kind].title}: read as that",)
