"""STL files, read once their size and their words add up: the text by trimesh, the records by numpy."""

import io
import re
import warnings

import numpy as np

from feederscrew.errors import MeshError
from feederscrew.part.reading.formats import ASCII, BINARY, FACET, HEADER, claimed_facets, plain
from feederscrew.part.reading.soup import Soup

RECORD = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
UNKNOWN_COUNTS = (0, 0xFFFFFFFF)  # what streaming exporters leave in the header
NAME_LINE = re.compile(rb"(?im)^[ \t]*(end)?solid\b[^\n]*$")
AGAIN = "export the part again, or copy the whole file"


def soup(data, kind, where):
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
    return _binary(data, where) if kind == BINARY else _ascii(data, where)


def _binary(data, where):
    data, said = _honest(data, where)
    facets = np.frombuffer(data, dtype=RECORD, offset=HEADER)
    with np.errstate(invalid="ignore"):  # a signalling NaN; the gate names it
        vertices = facets["corners"].reshape(-1, 3).astype(float)
    return Soup(vertices, np.arange(len(vertices)).reshape(-1, 3), BINARY, warnings=said)


def _honest(data, where):
    """A binary STL whose count agrees with its size, and what had to be done for that."""
    if len(data) < HEADER:
        raise MeshError(where, f"is cut short: {len(data)} bytes, less than an STL header", AGAIN)
    count = claimed_facets(data)
    whole, rest = divmod(len(data) - HEADER, FACET)
    if count == whole and rest == 0:
        return data, ()
    if rest == 0 and (count in UNKNOWN_COUNTS or count < whole):
        sentence = f"the header says {count} facets, the file has {whole}: all of them are read"
        return _recounted(data, whole), (sentence,)
    if count == 0 or count > whole:
        promised = "an unknown number of" if count in UNKNOWN_COUNTS else f"{count}"
        raise MeshError(where, f"is cut short: {promised} facets announced, {whole} are there", AGAIN)
    extra = len(data) - HEADER - FACET * count
    return data[:-extra], (f"{extra} bytes after the last facet are left out",)


def _recounted(data, count):
    return data[: HEADER - 4] + count.to_bytes(4, "little") + data[HEADER:]


def _ascii(data, where):
    whole = data.rstrip(b"\0")
    padding = len(data) - len(whole)
    said = (f"{padding} NUL bytes after the text are left out",) if padding else ()
    return _from_text(plain(whole.removeprefix(b"\xef\xbb\xbf")), said, where)


def _from_text(text, warned, where):
    from trimesh.exchange.stl import load_stl_ascii

    text = text.replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    text = NAME_LINE.sub(lambda match: (match[1] or b"").lower() + b"solid", text)
    said = text.lower().count(b"vertex")
    if said % 3 or not re.search(rb"(?i)endsolid\s*\Z", text):
        raise MeshError(where, "is cut short: the text does not end with 'endsolid'", AGAIN)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error", DeprecationWarning)  # numpy's way to say 'not a number'
            found = load_stl_ascii(io.BytesIO(text))
    except (ValueError, DeprecationWarning):
        raise _garbled(where) from None
    solids = found["geometry"].values() if "geometry" in found else [found]
    vertices = np.concatenate([solid["vertices"] for solid in solids] or [np.empty((0, 3))])
    if len(vertices) != said:
        raise _garbled(where)
    return Soup(vertices, np.arange(len(vertices)).reshape(-1, 3), ASCII, warnings=warned)


def _garbled(where):
    return MeshError(where, "has a 'vertex' line that is not three numbers", "export the part again")
