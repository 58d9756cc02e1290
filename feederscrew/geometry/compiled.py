"""How the event loops are compiled: on first need, cached on disk, free of the interpreter lock."""

import functools
import hashlib
from pathlib import Path

PLAIN = []  # functions that run as they stand and may be called from compiled ones, not yet registered
SMALL = 6000  # half-edges: a hull with fewer is walked sooner than numba is loaded
SOURCES = (
    "geometry/compiled.py",
    "resting/basins/forest.py",
    "resting/tumbling/*.py",
    "dropping/kernel/*.py",
    "tooling/kernel/*.py",
    "trial/kernel/*.py",
)


def compilable(function):
    """Mark a function that runs as it stands on a small hull and is compiled for a large one."""
    PLAIN.append(function)
    return function


def fitting(function, half_edges):
    """A compilable function as it stands or compiled, whichever is done sooner on a hull of that size."""
    return function if half_edges <= SMALL else _once(function)


def compiled(function, **options):
    """Compile a function that fills arrays it is handed and makes none of its own."""
    from numba import njit

    _register()
    function.__qualname__ = f"{function.__name__}_{_fingerprint()}"  # names the files of the cache
    return njit(cache=True, nogil=True, **_options(), **options)(function)


def inlined(function):
    """Compile a function into its callers: where handing it its records would cost more than its work."""
    return compiled(function, forceinline=True)


def on_disk(function):
    """Whether a compiled function is in the cache already, or numba is told not to compile."""
    return not hasattr(function, "stats") or any(
        Path(function.stats.cache_path).glob(f"*{function.__name__}_{_fingerprint()}*.nbi")
    )


def due(function, half_edges):
    """Whether a compilable function must be compiled for a hull of that size: some seconds, once."""
    return half_edges > SMALL and not on_disk(_once(function))


_once = functools.cache(compiled)


def _register():
    """Tell numba of the functions marked since, whichever room was imported first."""
    from numba.extending import register_jitable

    while PLAIN:
        register_jitable(**_options())(PLAIN.pop())


@functools.cache
def _options():
    """No reference counting, which costs more than the arithmetic: such a function may not make arrays."""
    from numba.core.options import DefaultOptions

    return {"error_model": "numpy"} | ({"_nrt": False} if hasattr(DefaultOptions, "_nrt") else {})


@functools.cache
def _fingerprint():
    """Digest of the compiled sources: a changed source must not find what an older one left on disk."""
    library = Path(__file__).parents[1]
    files = sorted(path for pattern in SOURCES for path in library.glob(pattern))
    return hashlib.sha256(b"".join(path.read_bytes() for path in files)).hexdigest()[:12]
