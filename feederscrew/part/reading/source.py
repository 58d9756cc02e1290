"""From a path or standard input to triangles as the file has them, nothing mended yet."""

import hashlib
import struct
import sys
import warnings
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from feederscrew import documents
from feederscrew.errors import MeshError, printable
from feederscrew.part.reading import archives, formats, obj, off, ply, scenes, stl, threemf
from feederscrew.part.reading.decimals import CommaError
from feederscrew.part.reading.formats import CARD, FORMATS
from feederscrew.part.reading.soup import LARGEST, LARGEST_TEXT, DamageError, TooManyFacetsError

AGAIN = "export the part again"
FEWER = "export it with fewer facets"
POINTS = "write numbers with a decimal point"
TEXTS = {"obj": obj.soup, "off": off.soup}
REFUSED: tuple[type[Exception], ...] = (  # what our readers raise on damaged bytes; no bugs
    ArithmeticError,
    EOFError,
    LookupError,
    RecursionError,
    ValueError,
    struct.error,
    *archives.DAMAGED,
    DeprecationWarning,
)
REASONS = (  # the first that fits, of faults whose own words are for programmers
    (archives.DAMAGED, "its archive is damaged"),
    (UnicodeError, "its text cannot be read"),
    ((EOFError, struct.error), "it is cut short"),
    (RecursionError, "it is nested too deep"),
    (ArithmeticError, "a number is out of range"),
    (LookupError, "something in it is missing"),
    ((ValueError, DeprecationWarning), "a value in it cannot be read"),
)
MENDS = {
    formats.UTF16: "save it as ASCII or UTF-8 text",
    documents.POINTER: documents.PULL,
}
EXPORT = "export the part as STL, OBJ, PLY, OFF, GLB, 3MF or STEP"


@dataclass(frozen=True)
class File:
    """The bytes of a part file and what to call it."""

    source: str  # as given, '-' for standard input
    where: str  # for error lines
    name: str  # file stem, printable
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
    return File(source, where, printable(path.stem), path.suffix.lower().removeprefix("."), data, digest)


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
        mend = MENDS.get(alien, EXPORT)
        raise MeshError(file.where, alien or "is a part card, not a mesh", mend)
    read = _read(file, kind)
    if not len(read.faces):
        left_out = "".join(f"; {text}" for text in read.warnings) if kind == "3mf" else ""
        raise MeshError(file.where, f"has no facets{left_out}", "export the part again as a solid")
    return replace(read, format=kind, warnings=_misnamed(file, kind) + read.warnings)


def _read(file, kind):
    """The triangles of a file of a known format; what its reader raises on damaged bytes is a line."""
    title, data = FORMATS[kind].title, file.data
    try:
        with warnings.catch_warnings(), np.errstate(all="ignore"):  # what is not finite, the gate names
            warnings.simplefilter("error", DeprecationWarning)  # numpy's way to say 'not a number'
            if kind in TEXTS:
                if len(data) > LARGEST_TEXT:
                    raise TooManyFacetsError(f"is text of more than {LARGEST_TEXT >> 20} MB")
                return TEXTS[kind](bytes(data).removeprefix(b"\xef\xbb\xbf"))
            if kind == "ply":
                return ply.soup(data)
            if kind == "3mf":
                return threemf.soup(data, file.where)
            return (stl.soup if kind.startswith("stl") else scenes.soup)(data, kind, file.where)
    except CommaError as error:
        raise MeshError(file.where, f"has {error}", POINTS) from None
    except (TooManyFacetsError, archives.BombError) as error:
        raise MeshError(file.where, f"is too large: it {error}", FEWER) from None
    except MemoryError:
        raise MeshError(file.where, "needs more memory than there is", FEWER) from None
    except REFUSED as error:
        raise MeshError(file.where, f"is a damaged {title} ({_reason(error)})", AGAIN) from None


def _reason(error):
    """What is wrong with damaged bytes: our own words, or what the class of another's fault stands for."""
    if not isinstance(error, DamageError):
        return next(text for kinds, text in REASONS if isinstance(error, kinds))
    words = " ".join(str(error).split())
    return words if len(words) <= 60 else words[:57] + "..."


def is_card(file):
    """Return whether the file is a part card: by its name, or by its content on standard input."""
    if file.suffix in FORMATS[CARD].suffixes:
        return True
    return formats.detect(file.data, file.suffix)[0] == CARD


def _bytes(source, where, stdin):
    if source != "-" and stdin is None:
        return documents.content(source, LARGEST, "a part file", MeshError)
    try:
        return bytes(documents.upto(stdin or sys.stdin.buffer, LARGEST))
    except (OSError, ValueError) as error:
        raise MeshError(where, f"cannot be read ({error})", "check what it comes from") from None


def _misnamed(file, kind):
    known = {suffix for format in FORMATS.values() for suffix in format.suffixes}
    if file.suffix not in known or file.suffix in FORMATS[kind].suffixes:
        return ()
    return (f"named .{file.suffix} but its content is {FORMATS[kind].title}: read as that",)
