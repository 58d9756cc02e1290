"""Simulations that are made once in a run, and kept on the disk for the next.

An entry is one line of JSON: its key, a digest, and arrays of plain numbers. Nothing in it is ever run.
Whoever reads it compares the key and checks the numbers. Without a folder that is the user's own nothing is
kept, and the same is simulated again.
"""

import base64
import binascii
import contextlib
import functools
import hashlib
import itertools
import json
import os
import secrets
import sys
import time
from collections import OrderedDict
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TypeVar

import numpy as np

from feederscrew.base import caches
from feederscrew.base.arrays import Array
from feederscrew.base.heavy import heavy
from feederscrew.part.record import Part
from feederscrew.resting.aspects import Aspects

metadata = heavy("importlib.metadata")  # and with it all of email: only a digest needs it

MAX_ENTRY_BYTES = 4_000_000
MAX_ENTRIES = 500  # the oldest go
MAX_FILES = 20_000  # in the folder: of more nothing is tidied up
ENTRY_SUFFIX = ".simulated"  # nothing else in the folder is touched
PARTIAL_PREFIX = "tmp"  # of an entry that is being written
PARTIAL_AGE_S = 3600.0  # older ones were left by a run that was killed
MADE_WITH = ("numpy", "scipy", "numba")
ARRAY_KINDS = {"float": "<f8", "int": "<i8", "bool": "|b1"}  # of arrays, by the name that an entry gives

Arrays = Mapping[str, Array]


def read(key: Mapping[str, str]) -> dict[str, Array] | None:
    """Return the arrays that are kept under a key.

    Parameters
    ----------
    key : mapping of str to str
        All that decides them.

    Returns
    -------
    dict of str to array, or None
        Arrays of float, int or bool, closed to writing. None where there is no entry, or one that is damaged,
        too large, of another key, no regular file, or in a folder that others may write to.
    """
    folder = caches.simulation_folder()
    if folder is None or refusal() is not None:
        return None
    full = {**key, "code": library_digest()}
    try:
        entry = json.loads(caches.read_own(folder / f"{_digest(full)}{ENTRY_SUFFIX}", MAX_ENTRY_BYTES))
        if entry["key"] != full or _digest([full, entry["arrays"]]) != entry["sha256"]:
            return None
        arrays = {}
        for name, array in entry["arrays"].items():
            kind, shape, data = (array[word] for word in ("kind", "shape", "data"))
            flat = np.frombuffer(base64.b64decode(data, validate=True), ARRAY_KINDS[kind])
            if len(array) != 3 or not all(type(n) is int and 0 <= n <= MAX_ENTRY_BYTES for n in shape):
                return None
            arrays[str(name)] = flat.reshape(shape)  # of bytes: closed to writing
        return arrays
    except (ValueError, TypeError, LookupError, AttributeError, RecursionError, binascii.Error):
        return None


def write(key: Mapping[str, str], arrays: Arrays) -> None:
    """Keep arrays of float, int or bool under a key.

    The key holds a digest of the library's code as well, so a changed program reads nothing of an older one.
    A file gets its name once it is complete. A full disk or a folder that refuses leaves nothing behind.

    Parameters
    ----------
    key : mapping of str to str
        All that decides the result.
    arrays : mapping of str to array

    Returns
    -------
    None
    """
    folder = caches.simulation_folder()
    if folder is None:
        return
    full = {**key, "code": library_digest()}
    packed = {}
    for name, array in arrays.items():
        kind = {"f": "float", "i": "int", "b": "bool"}[np.asarray(array).dtype.kind]
        data = np.ascontiguousarray(array).astype(ARRAY_KINDS[kind]).tobytes()
        text = base64.b64encode(data).decode()
        packed[name] = {"kind": kind, "shape": list(np.shape(array)), "data": text}
    data = _line({"key": full, "arrays": packed, "sha256": _digest([full, packed])})
    if len(data) > MAX_ENTRY_BYTES:
        return
    with contextlib.suppress(OSError):
        if not folder.is_dir():
            caches.make_folder(folder)
        if refusal() is not None:
            return
        # under a name of its own, then in its place; what fails is taken away
        partial = folder / f"{PARTIAL_PREFIX}{secrets.token_hex(8)}{ENTRY_SUFFIX}"
        try:
            flags = os.O_WRONLY | os.O_CREAT | os.O_EXCL | getattr(os, "O_BINARY", 0)
            with open(os.open(partial, flags, 0o600), "wb") as file:  # noqa: PTH123 - a descriptor
                file.write(data)
            partial.replace(folder / f"{_digest(full)}{ENTRY_SUFFIX}")
        finally:
            with contextlib.suppress(OSError):
                partial.unlink()
        _tidy(folder)


def refusal() -> str | None:
    """Return why the folder of the cache is not used, and how to mend that; None where it is used."""
    folder = caches.simulation_folder()
    reason = caches.why_unsafe(folder, caches.SIMULATIONS_VARIABLE) if folder else None
    return f"the cache {folder} is not used: {reason}" if reason else None


def entries() -> list[Path]:
    """Return the files that the cache has written, in a folder that it uses; none of anything else."""
    folder = caches.simulation_folder()
    if folder is None or refusal() is not None:
        return []
    with contextlib.suppress(OSError), os.scandir(folder) as files:
        return sorted(
            Path(file.path)
            for file in itertools.islice(files, MAX_FILES)
            if file.name.endswith(ENTRY_SUFFIX) and file.is_file(follow_symlinks=False)
        )
    return []


def clear() -> int:
    """Delete the files of ``entries``; how many went."""
    count = 0
    for path in entries():
        with contextlib.suppress(OSError):
            path.unlink()
            count += 1
    return count


def _tidy(folder: Path) -> None:
    """Delete the oldest entries beyond MAX_ENTRIES, and what a killed run has left half-written."""
    entries = []  # when each was changed [s], its name and its path
    with os.scandir(folder) as files:
        for file in itertools.islice(files, MAX_FILES):
            if file.name.endswith(ENTRY_SUFFIX) and not file.is_dir(follow_symlinks=False):
                with contextlib.suppress(OSError):
                    entries.append((file.stat(follow_symlinks=False).st_mtime, file.name, Path(file.path)))
    excess = len(entries) - MAX_ENTRIES
    for k, (changed, name, path) in enumerate(sorted(entries)):
        if k < excess or (name.startswith(PARTIAL_PREFIX) and changed < time.time() - PARTIAL_AGE_S):
            with contextlib.suppress(OSError):
                path.unlink()


def _line(value: object) -> bytes:
    return json.dumps(value, sort_keys=True).encode()


def _digest(value: object) -> str:
    return hashlib.sha256(_line(value)).hexdigest()


@functools.cache
def library_digest() -> str:
    """Return the digest of the library's sources and of what they run on: results of other code do not count.

    Returns
    -------
    str
    """
    library = Path(__file__).parents[1]
    digest = hashlib.sha256(sys.version.encode())
    for name in MADE_WITH:
        digest.update(metadata.version(name).encode())
    for path in sorted(library.rglob("*.py")):
        digest.update(path.read_bytes())
    return digest.hexdigest()


MAX_RECORDS = 32
_RECORDS: OrderedDict = OrderedDict()

Record = TypeVar("Record")


def once(
    part: Part,
    aspects: Aspects,
    kind: str,
    settings: tuple,
    make: Callable[[], Record],
    is_whole: Callable[[Record], bool],
    to_arrays: Callable[[Record], Arrays],
    from_arrays: Callable[[Arrays], Record],
) -> Record:
    """Return a simulation of a part from memory or disk, or make it and keep it if it is whole.

    Parameters
    ----------
    part : Part
    aspects : Aspects
        Of the part.
    kind : str
        'arrival' or 'drop'.
    settings : tuple
        All that decides the result beside part and kind; its ``repr`` is the same whenever it is the same.
    make : callable
        Makes the record.
    is_whole : callable
        Says whether the record may be kept; one that the user stopped may not.
    to_arrays : callable
        Gives the plain arrays that stand for the record on a disk.
    from_arrays : callable
        Gives the record of such arrays; raises ValueError or KeyError if they are of another one.

    Returns
    -------
    Record
        Of this part, or of one that no number tells from it.
    """
    key = part_key(part, aspects, kind, settings)
    place = tuple(key.values())
    if place not in _RECORDS:
        record = None
        if (held := read(key)) is not None:
            with contextlib.suppress(ValueError, KeyError):  # numbers that cannot be of this simulation
                record = from_arrays(held)
        if record is None:
            record = make()
            if not is_whole(record):
                return record
            write(key, to_arrays(record))
        _RECORDS[place] = record
        while len(_RECORDS) > MAX_RECORDS:
            _RECORDS.popitem(last=False)
    return _RECORDS[place]


def part_key(part: Part, aspects: Aspects, kind: str, settings: tuple) -> dict[str, str]:
    """Return the key of what is simulated of a part, as ``read`` and ``write`` take it.

    Parameters
    ----------
    part : Part
    aspects : Aspects
        Of the part.
    kind : str
        Of the simulation: 'arrival', 'drop'.
    settings : tuple
        All that decides it beside the part, written out the same whenever it is the same.

    Returns
    -------
    dict of str
    """
    digest = hashlib.sha256(repr((float(part.mass), aspects.names)).encode())
    arrays = (part.vertices, part.faces, part.centre_of_mass, part.inertia, aspects.normals, aspects.stable)
    for array in arrays:
        digest.update(np.ascontiguousarray(array).tobytes())
    return {"kind": kind, "part": digest.hexdigest(), "settings": repr(settings)}


def forget() -> None:
    """Forget all that was simulated: for tests that simulate it otherwise."""
    _RECORDS.clear()
