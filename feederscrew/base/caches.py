"""Folders in which results and compiled code are kept between runs, and who may have written to them.

What is read from a cache decides an answer, and compiled code is run. So a folder is used only if it belongs
to the user and nobody else may write to it, and a file only if it is a regular one of the same user.
"""

import contextlib
import os
import stat
from collections.abc import Iterator
from pathlib import Path

LIBRARY = Path(__file__).parents[1]
SIMULATIONS_VARIABLE = "FEEDER_CACHE"  # names the folder of simulations; empty: nothing is kept
KERNELS_VARIABLE = "NUMBA_CACHE_DIR"  # names the folder of compiled kernels
OPEN_FLAGS = os.O_RDONLY
for _flag in ("O_NOFOLLOW", "O_NONBLOCK", "O_CLOEXEC", "O_BINARY"):  # those that the system has
    OPEN_FLAGS |= getattr(os, _flag, 0)


def simulation_folder() -> Path | None:
    """Return the folder of kept simulations.

    Returns
    -------
    Path or None
        It need not exist. None where none is wanted (``FEEDER_CACHE`` is empty) or the user has no home.
    """
    named = os.environ.get(SIMULATIONS_VARIABLE)
    if named is not None:
        return Path(named) if named else None
    base = _user_base()
    return base / "feeder" if base else None


def kernel_folder() -> Path | None:
    """Return the folder of compiled kernels, the first that is safe and can be written.

    Candidates are the folder named in NUMBA_CACHE_DIR, the one beside the sources, and the user's own.

    Returns
    -------
    Path or None
        It need not exist. None where there is no such folder: every kernel is compiled anew then.
    """
    return next((folder for folder in _kernel_folders() if _can_hold(folder)), None)


def kernel_refusals() -> list[str]:
    """Return a sentence for each folder of kernels that others could have filled, and how to mend that.

    Returns
    -------
    list of str
        Empty where every candidate of ``kernel_folder`` is safe or does not exist.
    """
    reasons = ((folder, why_unsafe(folder, KERNELS_VARIABLE)) for folder in _kernel_folders())
    return [f"the kernels in {folder} are not used: {reason}" for folder, reason in reasons if reason]


def why_unsafe(folder: Path, variable: str) -> str | None:
    """Return why a folder is not used, and how to mend that; None if it is safe or does not exist.

    Parameters
    ----------
    folder : Path
    variable : str
        The environment variable that names another folder.

    Returns
    -------
    str or None
        'it belongs to another user - name a folder of your own in FEEDER_CACHE', for instance.
    """
    try:
        held = folder.stat()
    except (OSError, ValueError):
        return None
    if not stat.S_ISDIR(held.st_mode):
        return f"it is no folder - name another in {variable}"
    if not hasattr(os, "geteuid"):  # Windows: its folders of a user are closed to others
        return None
    if held.st_uid != os.geteuid():
        return f"it belongs to another user - name a folder of your own in {variable}"
    if held.st_mode & (stat.S_IWGRP | stat.S_IWOTH):
        return "other users may write to it - run chmod go-w on it"
    return None


def make_folder(folder: Path) -> None:
    """Make a folder that only its user can read and write, unless it exists.

    Parameters
    ----------
    folder : Path
        Folders above it are made, too, as the system makes them.

    Raises
    ------
    OSError
        If it cannot be made.
    """
    folder.parent.mkdir(parents=True, exist_ok=True)
    folder.mkdir(mode=0o700, exist_ok=True)


def read_own(path: Path, most: int) -> bytes:
    """Return the content of a regular file of this user.

    Parameters
    ----------
    path : Path
        Not followed if it is a link, not waited for if it is a pipe.
    most : int
        Bytes that it may have.

    Returns
    -------
    bytes
        Nothing of a file that is larger, of another kind, of another user, or open to writing by others.
    """
    with contextlib.suppress(OSError, ValueError):
        before = path.lstat()  # where the system knows no O_NOFOLLOW
        if not stat.S_ISREG(before.st_mode) or before.st_size > most:
            return b""
        with open(os.open(path, OPEN_FLAGS), "rb") as file:  # noqa: PTH123 - a descriptor
            held = os.fstat(file.fileno())
            is_same = (held.st_dev, held.st_ino) == (before.st_dev, before.st_ino)
            is_own = not hasattr(os, "geteuid") or (
                held.st_uid == os.geteuid() and not held.st_mode & (stat.S_IWGRP | stat.S_IWOTH)
            )
            if stat.S_ISREG(held.st_mode) and is_same and is_own:
                data = file.read(most + 1)
                return data if len(data) <= most else b""
    return b""


def _user_base() -> Path | None:
    with contextlib.suppress(RuntimeError):  # a user without a home
        return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
    return None


def _kernel_folders() -> Iterator[Path]:
    if os.environ.get(KERNELS_VARIABLE):
        yield Path(os.environ[KERNELS_VARIABLE])
    yield LIBRARY / "__pycache__"
    base = _user_base()
    if base:
        yield base / "feeder-kernels"


def _can_hold(folder: Path) -> bool:
    """Return whether a folder is safe and can be written, or can be made."""
    if why_unsafe(folder, KERNELS_VARIABLE):
        return False
    with contextlib.suppress(OSError, ValueError):
        nearest = next(place for place in (folder, *folder.absolute().parents) if place.exists())
        return nearest.is_dir() and os.access(nearest, os.W_OK)
    return False
