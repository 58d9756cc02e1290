"""Part files with known faults, written byte by byte."""

import struct

import numpy as np

from feederscrew.base.errors import FeederError
from feederscrew.part import load

SIDES = np.array([[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]])


def box(size=(10.0, 20.0, 30.0), corner=(0.0, 0.0, 0.0)):
    """(12, 3, 3) triangles of a box, facing outwards."""
    x, y, z = size
    base = [(0, 0), (x, 0), (x, y), (0, y)]
    corners = np.array([(*p, h) for h in (0, z) for p in base], dtype=float) + corner
    quads = corners[SIDES]
    return np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])


def inside_out(triangles):
    """The same triangles, each wound the other way."""
    return triangles[:, ::-1]


def torus_twice(turns, radius=10.0, tube=9.0, along=48, around=24):
    """A tube that runs round the z axis ``turns`` times before it closes: it covers itself."""
    u = np.linspace(0.0, 2.0 * np.pi * turns, along * turns, endpoint=False)
    v = np.linspace(0.0, 2.0 * np.pi, around, endpoint=False)
    swell = 1.0 + 0.02 * np.cos(u / turns)[:, None]
    ring = radius * swell + tube * np.cos(v) * swell
    x, y = ring * np.cos(u)[:, None], ring * np.sin(u)[:, None]
    points = np.stack([x, y, tube * np.sin(v) * swell], axis=-1)
    right, up = np.roll(points, -1, axis=0), np.roll(points, -1, axis=1)
    both = np.roll(right, -1, axis=1)
    corners = ((points, right, both), (points, both, up))
    return np.concatenate([np.stack(corner, axis=2).reshape(-1, 3, 3) for corner in corners])


def binary_stl(triangles, header=b"", count=None):
    """Bytes of a binary STL; ``count`` puts another number into the header."""
    triangles = np.asarray(triangles, dtype="<f4")
    facets = np.zeros(len(triangles), dtype=[("n", "<f4", 3), ("v", "<f4", (3, 3)), ("a", "<u2")])
    facets["v"] = triangles
    head = struct.pack("<I", len(triangles) if count is None else count)
    return header.ljust(80, b"\0") + head + facets.tobytes()


def ascii_stl(triangles, name="part", end="\n"):
    """Bytes of an ASCII STL."""
    lines = [f"solid {name}"]
    for triangle in triangles:
        corners = [f"      vertex {x:.9g} {y:.9g} {z:.9g}" for x, y, z in triangle]
        lines += ["  facet normal 0 0 0", "    outer loop", *corners, "    endloop", "  endfacet"]
    return (end.join([*lines, f"endsolid {name}"]) + end).encode()


def obj(triangles, before=b""):
    """Bytes of an OBJ with each corner on its own, after lines of corners that nothing uses."""
    unused = before.count(b"\n")
    corners = [f"v {x!r} {y!r} {z!r}" for x, y, z in np.reshape(triangles, (-1, 3)).tolist()]
    faces = [f"f {k + 1} {k + 2} {k + 3}" for k in range(unused, unused + len(corners), 3)]
    return before + ("\n".join(corners + faces) + "\n").encode()


def written(folder, data, name="part.stl"):
    """The path of a file with these bytes or triangles."""
    path = folder / name
    path.write_bytes(data if isinstance(data, bytes) else binary_stl(data))
    return path


def refused(path, **options):
    """The one line a file is refused with, without the file's name."""
    try:
        load(path, **options)
    except FeederError as error:
        assert len(error.lines) == 1, error.lines
        assert "\n" not in error.lines[0], error.lines
        return error.lines[0].removeprefix(f"{path}: ")
    raise AssertionError(f"{path} was taken")
