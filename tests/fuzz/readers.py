"""Readers of files given damaged ones in this process, without a command: hundreds to thousands a second.

A command tries far fewer in the same time; what a reader lets through, the kinds of ``harness.PLAN`` try on.
"""

import contextlib
import functools
import hashlib
import importlib
import json
import os
import traceback
import unittest.mock
import warnings
import zipfile
from pathlib import Path

import numpy as np

ROOT = Path(__file__).parent.parent.parent
COUNTED = ("docs/measured/cuboid_047.csv", "docs/measured/arc_chute.csv", "docs/measured/example/feeding.csv")
CONTENT_TYPES = (
    '<?xml version="1.0"?><Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">'
    '<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>'
    '<Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/>'
    "</Types>"
)
RELATIONS = (
    '<?xml version="1.0"?><Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">'
    '<Relationship Target="/3D/3dmodel.model" Id="r0" '
    'Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>'
)


def _load(name, **own):
    """A part that is accepted has mass, and no principal moment above the sum of the others."""
    from feederscrew.part import load

    part = load(name, **own)
    small, middle, large = np.linalg.eigvalsh(part.inertia)
    assert part.mass > 0 and small >= 0
    assert large <= (small + middle) * (1 + 1e-6), (small, middle, large)


def _zipped(name):
    """Read a 3MF whose model is the given XML: damage of an archive's own bytes hardly gets further."""
    packed = Path(name).with_suffix(".3mf")
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("[Content_Types].xml", CONTENT_TYPES)
        archive.writestr("_rels/.rels", RELATIONS)
        archive.write(name, "3D/3dmodel.model")
    _load(packed)


def _read(module, function, *arguments, of=str):
    """A reader that calls one function of the library with the file's name, or what ``of`` makes of it."""

    def read(name):
        return getattr(importlib.import_module(f"feederscrew.{module}"), function)(of(name), *arguments)

    return read


def _verified(name):
    """A block that is believed has figures that can be; one that is not says why in plain letters."""
    from feederscrew import __version__, bowl

    block = bowl.verified(name)
    if block is None:
        return
    said = list(block.void(None, bowl.default(), __version__))
    if hasattr(block, "sentence"):
        said.append(block.sentence)
        if not (0.0 <= block.low <= block.delivered <= block.high and 0 <= block.held <= block.draws):
            raise ValueError(f"believed: {block}")
    if not all(line.isprintable() for line in said):
        raise ValueError(f"control characters: {said}")


def _cache(name):
    """Read a damaged entry of the cache, under a digest that fits it where it is still JSON."""
    from feederscrew.arrivals import simulation_cache
    from feederscrew.base import caches

    damaged, key = Path(name).read_bytes(), {"part": "of the fuzzer"}
    with unittest.mock.patch.dict(os.environ, {caches.SIMULATIONS_VARIABLE: "kept"}):
        simulation_cache.write(key, {"shares": np.array([0.25, 0.75])})
        (entry,) = Path("kept").iterdir()
        with contextlib.suppress(ValueError, KeyError, TypeError, RecursionError):
            whole = json.loads(entry.read_bytes()) | {"arrays": json.loads(damaged)["arrays"]}
            signed = json.dumps([whole["key"], whole["arrays"]], sort_keys=True).encode()
            damaged = json.dumps(whole | {"sha256": hashlib.sha256(signed).hexdigest()}).encode()
        entry.write_bytes(damaged)
        arrays = simulation_cache.read(key)
        assert arrays is None or all(array.dtype.kind in "fib" for array in arrays.values())


HOLE = _read("base.dxf", "outlines", "CUT", "bowl.yaml:3", of=Path)
CUBES = ("tests/fuzz/cube.stl", "tests/fuzz/text.stl")
BOWLS = ("docs/measured/example/bowl.yaml", "configs/thesis.yaml")
READERS = {  # seeds, how the damaged file is called, and what reads it
    "read stl": (("tests/fuzz/cube.stl", "parts/key_a_d12x20.stl", "tests/fuzz/text.stl"), "part.stl", _load),
    "read open stl": (CUBES, "part.stl", functools.partial(_load, allow_open=True)),
    "read obj": (("tests/fuzz/cube.obj",), "part.obj", _load),
    "read ply": (("tests/fuzz/cube.ply", "tests/fuzz/quads.ply"), "part.ply", _load),
    "read off": (("tests/fuzz/quads.off",), "part.off", _load),
    "read glb": (("tests/fuzz/cube.glb",), "part.glb", _load),
    "read 3mf": (("tests/fuzz/bodies.3mf",), "part.3mf", _load),
    "read 3mf model": (("tests/fuzz/bodies.model", "tests/fuzz/project.model"), "part.model", _zipped),
    "read bowl": (BOWLS, "bowl.yaml", _read("bowl", "read")),
    "read verified": (("tests/fuzz/verified.yaml",), "bowl.yaml", _verified),
    "read card": (("parts/magnet.yaml", "parts/arc_chute.yaml"), "card.yaml", _load),
    "read cache": (("tests/fuzz/entry.json",), "entry.json", _cache),
    "read names": (("tests/fuzz/names.yaml",), "names.yaml", _read("part.card", "read_aspect_names")),
    "read counts": (COUNTED, "counts.csv", _read("resting.profiles", "read_profile", tuple("ABCDE"))),
    "read list": (
        ("tests/fuzz/list.csv",),
        "list.csv",
        _read("jobs.batch", "gather", of=lambda name: [name]),
    ),
    "read launches": (("tests/fuzz/tosses.csv",), "tosses.csv", _read("arrivals.toss_runs", "read_launches")),
    "read dxf": (("tests/fuzz/hole.dxf", "tests/fuzz/few.dxf"), "hole.dxf", lambda name: HOLE(name).rings),
}


def fault(kind, name):
    """What is wrong with how a reader takes a file of the working folder; '' if nothing is."""
    return outcome(READERS[kind][2], name)


def outcome(read, argument):
    """What is wrong with a call: what it says, a traceback, or a warning of Python's; '' if nothing is."""
    from feederscrew.base.errors import FeederError

    said = ""

    with warnings.catch_warnings(record=True) as noise:
        warnings.simplefilter("always")
        try:
            said = read(argument)
        except FeederError as told:
            if not all(": " in line and " - " in line for line in told.lines):
                return f"no place or no mend: {told}"
        except Exception:  # noqa: BLE001 - any other is what is looked for
            return traceback.format_exc()
    if noise:
        return f"Python warns: {noise[0].message} ({noise[0].filename}:{noise[0].lineno})"
    return said if isinstance(said, str) else ""
