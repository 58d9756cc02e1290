"""How the event loops are compiled: cached on disk, free of the interpreter lock."""

import hashlib
from pathlib import Path

from numba import njit
from numba.core.options import DefaultOptions

QUICK = {"_nrt": False} if hasattr(DefaultOptions, "_nrt") else {}
"""No reference counting, which costs more than the arithmetic: such a function may not make arrays."""

SOURCES = ("tumbling_*.py", "drop/body.py", "drop/contact.py", "drop/kernel.py")


def _fingerprint():
    """Digest of the compiled sources: a changed source must not find what an older one left on disk."""
    here = Path(__file__).parent
    files = sorted(path for pattern in SOURCES for path in here.glob(pattern))
    return hashlib.sha256(b"".join(path.read_bytes() for path in files)).hexdigest()[:12]


FINGERPRINT = _fingerprint()


def compiled(function):
    """Compile a function that fills arrays it is handed and makes none of its own."""
    function.__qualname__ = f"{function.__name__}_{FINGERPRINT}"  # names the files of the cache
    return njit(cache=True, nogil=True, error_model="numpy", **QUICK)(function)


def on_disk(function):
    """Whether a compiled function is in the cache already: its first call takes no compiler."""
    return any(Path(function.stats.cache_path).glob(f"*{function.__name__}_{FINGERPRINT}*.nbi"))
