"""OBJ files: corners and facets of any size, by object or group."""

import numpy as np

from feederscrew.part.reading import facets
from feederscrew.part.reading.decimals import Decimals
from feederscrew.part.reading.formats import plain
from feederscrew.part.reading.soup import MOST_CORNERS, MOST_FACETS, DamageError, Soup, refuse_crowds

FROM_ZERO = "its facets count corners from 0, OBJ counts them from 1: read as counted from 0"


def soup(data: bytes) -> Soup:
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
            if len(words) > 3 * MOST_CORNERS:
                refuse_crowds(len(words) // 3, 0)
        elif parts[0] in (b"f", b"fo"):
            indices = [int(word.partition(b"/")[0]) for word in parts[1:]]
            if min(indices, default=1) < 0:
                relative = True
                indices = [k if k > 0 else len(words) // 3 + 1 + k for k in indices]
            sizes.append(len(indices))
            corners += indices
            objects.append(len(names) - 1)
            if len(sizes) > MOST_FACETS:
                refuse_crowds(0, len(sizes))
        elif parts[0] == (b"o" if named else b"g"):
            names.append(b" ".join(parts[1:]))
    refuse_crowds(len(words) // 3, len(corners) - 2 * len(sizes))
    decimals = Decimals()
    vertices = decimals.read([plain(word) for word in words]).reshape(-1, 3)
    whole, begins, warnings = np.array(corners, dtype=np.int64), 1, decimals.warnings
    if len(whole) and whole.min() == 0:
        if relative or whole.max() >= len(vertices):
            raise DamageError("a facet names corner 0; OBJ counts from 1")
        begins, warnings = 0, (*warnings, FROM_ZERO)
    faces, facet = facets.triangles(vertices, np.array(sizes, dtype=np.int64), whole - begins)
    shown = tuple(name.decode(errors="replace") for name in names)
    return Soup(faces=faces, vertices=vertices, format="obj", warnings=warnings, names=shown,
                objects=np.array(objects, dtype=np.int64)[facet])  # fmt: skip
