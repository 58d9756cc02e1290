"""How the event loops are compiled: on first need, cached on disk, free of the interpreter lock."""

import functools
import hashlib
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np

# functions that compiled ones may call, not yet registered, and how each is compiled
PENDING: list[tuple[Callable[..., Any], dict[str, Any]]] = []
NO_FOLDER = "/dev/null"  # where no folder is: what is not kept is not found
SMALL = 6000  # half-edges: a hull with fewer is walked sooner than numba is loaded
# by the room of an entry: the sources that are compiled into it, beside this one
SOURCES = {
    "conveying": ("conveying/*.py",),
    "resting": ("resting/landscape.py", "resting/half_edges.py", "resting/walks.py"),
    "dropping": ("dropping/kernel/*.py", "resting/half_edges.py", "resting/walks.py"),
    "tooling": ("tooling/kernel.py",),
    "trial": ("trial/kernel/*.py", "dropping/kernel/*.py"),
}


def record_type(*names: str, whole: tuple[str, ...] = (), flags: tuple[str, ...] = ()) -> np.dtype:
    """Return a record of numbers by name; some of them are whole, some are yes or no."""
    kinds = dict.fromkeys(whole, np.int64) | dict.fromkeys(flags, np.bool_)
    return np.dtype([(name, kinds.get(name, np.float64)) for name in names], align=True)


def zero_rows(shape: int | tuple[int, ...], kind: np.dtype) -> np.recarray:
    """Return an array of zeros, of that shape, of a kind of record."""
    return np.zeros(shape, kind).view(np.recarray)


def frozen_rows(values: Sequence[Sequence[float]], kind: np.dtype) -> np.recarray:
    """Return records of a kind with some values, a sequence each, closed to writing."""
    records = np.array([tuple(row) for row in values], kind).view(np.recarray)
    records.setflags(write=False)
    return records


def compiled(function, arrays=False):
    """Mark a function that is compiled into those that call it; called from Python it runs as it stands.

    Such a function has no way in from Python, which would take a third of the compiling, and is compiled
    once for all numbers it is handed, not once for each constant. It becomes a part of its callers, whatever
    its length: a call hands on every number behind a record. Only with ``arrays`` may it make arrays.
    """
    return _marked(function, arrays=arrays)


def outlined(function, arrays=False):
    """Mark a large function of few arguments that is called in several places: compiled once for all."""
    return _marked(function, arrays=arrays, forceinline=False)


def shared(function):
    """Mark a function that several entries call: compiled once for all of them, and kept on disk by itself.

    As ``compiled``, it has no way in from Python.
    """
    return _marked(_named(function), cache=True)


def entry(function, arrays=False):
    """Compile a function that Python calls; it fills arrays it is handed."""
    from numba import njit

    _register()
    return njit(cache=_can_keep(), nogil=True, **_options(arrays))(_named(function))


def fitting(function, half_edges, plain=None):
    """Return a marked function as it stands or compiled, whichever is done sooner on a hull of that size.

    ``plain`` does the same sooner than the function as it stands.
    """
    return (plain or function) if half_edges <= SMALL else _once(function)


def on_disk(function):
    """Whether a compiled function is in the cache already, or numba is set not to compile."""
    return not hasattr(function, "stats") or any(
        Path(function.stats.cache_path or NO_FOLDER).glob(
            f"*{function.__name__}_{_fingerprint(function.__module__)}*.nbi"
        )
    )


def due(function, half_edges):
    """Whether a marked function must be compiled for a hull of that size: some seconds, once."""
    return half_edges > SMALL and not on_disk(_once(function))


_once = functools.cache(entry)


@functools.cache
def _can_keep() -> bool:
    """Whether numba finds a place on disk that it can write; else each run compiles what it needs."""
    from numba import njit

    try:
        njit(cache=True)(_nothing)
    except RuntimeError:  # neither beside the sources nor in a folder of the user's
        return False
    return True


def _nothing() -> None:
    pass


def _marked(function, **how):
    """Note how a function is compiled, until numba is asked to."""
    PENDING.append((function, how))
    if "numba" in sys.modules:  # an entry may stand above what it calls
        _register()
    return function


def _named(function):
    """Name the files that a function has in the cache."""
    function.__qualname__ = f"{function.__name__}_{_fingerprint(function.__module__)}"
    return function


def _register() -> None:
    """Tell numba of the functions marked since, whichever room was imported first."""
    from numba.extending import register_jitable

    while PENDING:
        function, how = PENDING.pop()
        caching = {"cache": _can_keep()} if how.get("cache") else {}
        register_jitable(**{"forceinline": True} | _options(**how) | caching)(function)


def _options(arrays=False, **others) -> dict[Any, Any]:
    """Without arrays no reference counting, which costs more than the arithmetic; and no way in from C."""
    from numba.core.options import DefaultOptions

    counting = {} if arrays or not hasattr(DefaultOptions, "_nrt") else {"_nrt": False}
    return {"error_model": "numpy", "no_cfunc_wrapper": True, **counting, **others}


@functools.cache
def _fingerprint(module):
    """Digest of the sources compiled into a module's entries, and of the names of their rooms' modules.

    A changed source must not find what an older one left on disk, and what lies there names the modules of
    the records that it is handed: one that has moved since could not be loaded.
    """
    library = Path(__file__).parents[1]
    room = module.split(".")[1] if module.startswith("feederscrew.") else ""
    patterns = SOURCES.get(room, tuple(pattern for own in SOURCES.values() for pattern in own))
    rooms = sorted({pattern.split("/")[0] for pattern in patterns})
    names = sorted(
        path.relative_to(library).as_posix() for own in rooms for path in (library / own).rglob("*.py")
    )
    digest = hashlib.sha256("\n".join(names).encode())
    for path in [Path(__file__), *sorted(path for pattern in patterns for path in library.glob(pattern))]:
        digest.update(path.read_bytes())
    return digest.hexdigest()[:12]
