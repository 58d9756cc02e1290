"""Simulations kept on disk from run to run, for the part, the floor and the code that they were made with.

Without a place to write nothing is kept, and nothing is said: the same is then simulated again.
"""

import contextlib
import functools
import hashlib
import importlib.metadata
import os
import pickle
import sys
import tempfile
from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import Any

import numpy as np

VARIABLE = "FEEDER_CACHE"  # names the folder; empty: nothing is kept
LARGEST = 4_000_000  # bytes of one
MOST = 500  # of them: the oldest go
END = ".simulated"  # of their names: nothing else in the folder is touched
DIGEST = hashlib.sha256().digest_size
MADE_WITH = ("numpy", "scipy", "numba")


def read(key: bytes) -> Any:
    """Return what is kept under a key; None where nothing is, or not as it was written."""
    folder = _folder()
    if folder is None:
        return None
    try:
        told = (folder / _name(key)).read_bytes()
    except OSError:
        return None
    digest, data = told[:DIGEST], told[DIGEST:]
    return _frozen(pickle.loads(data)) if hashlib.sha256(data).digest() == digest else None


def write(key: bytes, made: Any) -> None:
    """Keep what was made under a key, where there is room for it."""
    folder, data = _folder(), pickle.dumps(made)
    if folder is None or len(data) > LARGEST:
        return
    with contextlib.suppress(OSError):
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.NamedTemporaryFile(dir=folder, suffix=END, delete=False) as file:
            file.write(hashlib.sha256(data).digest() + data)
        Path(file.name).replace(folder / _name(key))
        oldest = sorted(folder.glob(f"*{END}"), key=lambda one: one.stat().st_mtime)
        for one in oldest[: max(len(oldest) - MOST, 0)]:
            one.unlink()


def _folder() -> Path | None:
    told = os.environ.get(VARIABLE)
    if told is not None:
        return Path(told) if told else None
    base = os.environ.get("XDG_CACHE_HOME")
    with contextlib.suppress(RuntimeError):  # a user without a home
        return Path(base or Path.home() / ".cache") / "feeder"
    return None


def _name(key: bytes) -> str:
    return hashlib.sha256(key + _code()).hexdigest() + END


@functools.cache
def _code() -> bytes:
    """Digest of the library's sources and of what they run on: what other code made is not found."""
    library = Path(__file__).parents[2]
    made = hashlib.sha256(sys.version.encode())
    for name in MADE_WITH:
        made.update(importlib.metadata.version(name).encode())
    for path in sorted(library.rglob("*.py")):
        made.update(path.read_bytes())
    return made.digest()


def _frozen(made: Any) -> Any:
    """The same with arrays that cannot be written, as they were made."""
    if isinstance(made, np.ndarray):
        made.flags.writeable = False
    elif is_dataclass(made):
        for one in fields(made):
            _frozen(getattr(made, one.name))
    return made
