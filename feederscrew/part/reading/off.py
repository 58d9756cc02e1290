"""OFF files: corners with or without normals and colours, facets of any size."""

import re

import numpy as np

from feederscrew.part.reading import facets
from feederscrew.part.reading.decimals import Decimals
from feederscrew.part.reading.formats import plain
from feederscrew.part.reading.soup import DamageError, Soup, refuse_crowds

COMMENT = re.compile(rb"#[^\n]*")
KEYWORD = re.compile(rb"\s*(?:ST)?C?N?OFF\b")


def soup(data: bytes) -> Soup:
    """Return the triangles of an OFF file.

    Raises
    ------
    ValueError
        If it announces more than it holds, or a line cannot be read.
    """
    text = COMMENT.sub(b"", plain(data).replace(b"\r\n", b"\n").replace(b"\r", b"\n"))
    text = KEYWORD.sub(b"", text, count=1)
    lines = [line for line in text.splitlines() if line.strip()]
    head = lines[0].split() if lines else []
    if head[:1] == [b"BINARY"]:
        raise DamageError("binary OFF is not read")
    words = head[3:] if len(lines) == 1 else None  # all in one line
    corners, count = (int(word) for word in head[:2])
    if not 0 <= corners + count <= len(text) or corners < 0 or count < 0:
        raise DamageError("it announces more than it holds")
    refuse_crowds(corners, count)
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
    refuse_crowds(0, int(sizes.sum()) - 2 * len(sizes))
    faces, _ = facets.triangles(vertices, sizes, np.array([k for ring in indices for k in ring], np.int64))
    return Soup(vertices, faces, "off", warnings=decimals.warnings)


def _ring(words):
    """Corners of the facet of one line; a colour may follow them."""
    size = int(words[0])
    if not 0 <= size < len(words):
        raise DamageError("a facet of fewer corners than it announces")
    return [int(word) for word in words[1 : size + 1]]


def _rings(words, count):
    """Corners of facets whose lines are not kept."""
    rings, at = [], 0
    for _ in range(count):
        if at >= len(words):
            raise DamageError("it announces more than it holds")
        rings.append(_ring(words[at : at + 1 + int(words[at])]))
        at += 1 + len(rings[-1])
    return rings
