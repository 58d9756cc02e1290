"""The folder of one part's results, all of a run's files or none, with their record; and rules for make."""

import contextlib
import json
import os
import platform
import shutil
import tempfile
import time
from collections.abc import Iterable, Iterator, Mapping, Sequence
from importlib import metadata
from pathlib import Path, PurePosixPath
from typing import Any

from feederscrew import __version__
from feederscrew.base.columns import Document
from feederscrew.base.errors import FeederError
from feederscrew.output import tables

RECORD, ANOTHER = "run.json", "give another folder to `directory`"
STAGING_PREFIX = ".feeder."  # of a folder that is being written
STAGING_AGE_S = 3600.0  # older ones were left by a run that was killed
LIBRARIES = ("embreex", "matplotlib", "numba", "numpy", "pandas", "scipy")
NO_FILE = {"path": "", "sha256": ""}  # in place of an input where all is by default
RESERVED = {"CON", "PRN", "AUX", "NUL", *(f"{port}{n}" for port in ("COM", "LPT") for n in range(1, 10))}
NO_LETTERS = {chr(0xDC00 + byte) for byte in range(256)}  # bytes of a file name that are not UTF-8


class ResultFolder:
    """Collects the files of one command on one input and puts them in place together.

    Files are held back until ``keep``; a run that fails or is interrupted leaves the disk as it was.
    Several commands share the folder: each replaces its own files only. ``root`` is the folder of ``-o``,
    ``name`` that of the part or bowl file, ``identity`` the sha256 of each input by its path, the one
    that names the folder first. Raises FeederError if the folder cannot be written, or holds the results
    of another input.
    """

    def __init__(self, root: str | Path, name: str, identity: Mapping[str, str]) -> None:
        self.root, self.identity = Path(root), dict(identity)
        self.path = self.root / safe_name(name)
        self.staged: dict[str, bytes] = {}
        self.left_out: list[str] = []  # pictures that an interrupt kept from being drawn
        self.untouched = False  # what an earlier run has left stays as it is
        check_place(self.path)
        self._records()

    def write(self, name: str, content: str | bytes) -> None:
        """Hold back one file, until ``keep``.

        Parameters
        ----------
        name : str
            '/' in it makes folders.
        content : str or bytes
        """
        if not _inside(name) or name == RECORD:
            raise ValueError(f"{name!r} is not a name for a result")
        self.staged[name] = tables.file_bytes(content)

    def has_file(self, command: str, name: str) -> bool:
        """Tell whether an earlier run of a command has left a file of a name here.

        Parameters
        ----------
        command, name : str

        Returns
        -------
        bool
        """
        return name in self._records().get(command, {}).get("files", [])

    def document(self, name: str) -> Document:
        """Return a JSON document that lies here already.

        Parameters
        ----------
        name : str
            Of the file.

        Returns
        -------
        dict
            Empty where there is none, or none that can be read.
        """
        try:
            read = json.loads((self.path / name).read_text(encoding="utf-8"))
        except (OSError, ValueError, RecursionError):
            return {}
        return read if isinstance(read, dict) else {}

    def keep(
        self,
        command: str,
        *,
        arguments: Sequence[str] = (),
        effective: Mapping[str, Any] | None = None,
        warnings: Sequence[str] = (),
    ) -> None:
        """Put every file in place and record the run; a command's files of an earlier run are replaced.

        Parameters
        ----------
        command : str
        arguments : sequence of str, optional
            As typed.
        effective : mapping of str to object, optional
            The parameters that led to the numbers.
        warnings : sequence of str, optional
            As given.
        """
        record = {
            "version": __version__,
            "arguments": list(arguments),
            "inputs": [{"path": self._seen_from_here(p), "sha256": s} for p, s in self.identity.items()],
            "effective": effective or {},
            "warnings": list(warnings),
            "libraries": {"python": platform.python_version(), **{n: metadata.version(n) for n in LIBRARIES}},
            "files": sorted(self.staged),
        }
        new_folders = [p for p in (self.path, *self.path.parents) if not p.exists()]  # the innermost first
        try:
            self.path.mkdir(parents=True, exist_ok=True)
            with _lock(self.path):
                self._replace_files(command, record)
        except OSError as error:
            raise FeederError(self.path, f"cannot be written ({error.strerror})", ANOTHER) from error
        finally:
            for folder in new_folders:
                with contextlib.suppress(OSError):
                    folder.rmdir()  # goes only if nothing came into it

    def _replace_files(self, command: str, record: Document) -> None:
        records = self._records()
        old = records.get(command, {}).get("files", [])
        records[command] = record
        for left in self.root.glob(f"{STAGING_PREFIX}*"):  # of runs that were killed, half-written
            with contextlib.suppress(OSError):
                if left.lstat().st_mtime < time.time() - STAGING_AGE_S:
                    shutil.rmtree(left, ignore_errors=True)
        staging = Path(tempfile.mkdtemp(prefix=STAGING_PREFIX, dir=self.root))
        try:
            contents = {**self.staged, RECORD: tables.json_text(dict(sorted(records.items()))).encode()}
            for name, content in contents.items():
                _write(staging / name, content)
            for name in contents:
                (self.path / name).parent.mkdir(parents=True, exist_ok=True)
                (staging / name).replace(self.path / name)
        finally:
            shutil.rmtree(staging, ignore_errors=True)
        for name in old:
            if name not in self.staged and _inside(name):
                (self.path / name).unlink(missing_ok=True)

    def _records(self) -> Document:
        """The record of each command with results here, once it is sure that they are of this input."""
        file = self.path / RECORD
        try:
            records = json.loads(file.read_text())
            owners = [(record["inputs"] or [NO_FILE])[0] for record in records.values()]
        except FileNotFoundError:
            return {}
        except (OSError, ValueError, LookupError, TypeError, AttributeError) as error:
            mend = "remove that folder, or give another to `directory`"
            raise FeederError(file, "is not a record of a run", mend) from error
        path, sha256 = next(iter(self.identity.items()), (None, NO_FILE["sha256"]))
        for owner in (owner for owner in owners if owner["sha256"] != sha256):
            if path in (None, "-") or owner["path"] != self._seen_from_here(path):
                held = "a run without a file" if owner == NO_FILE else f"another file, {owner['path']}"
                mend = ANOTHER + (", or rename the file" if path else "")
                raise FeederError(self.path, f"holds the results of {held}", mend)
        return records

    def _seen_from_here(self, path: str) -> str:
        """An input's path from this folder: the same wherever the project lies and one stands."""
        if path == "-":
            return path
        try:
            return Path(os.path.relpath(path, self.path)).as_posix()
        except ValueError:  # another drive
            return Path(path).absolute().as_posix()


def check_place(folder: Path, mend: str = ANOTHER) -> None:
    """Refuse a folder that is a file, or cannot be made or written to.

    Parameters
    ----------
    folder : Path
    mend : str, optional
        Says what to do.

    Raises
    ------
    FeederError
    """
    nearest = next(p for p in (folder.absolute(), *folder.absolute().parents) if p.exists())
    if not nearest.is_dir():
        raise FeederError(nearest, "is a file, not a folder", mend)
    try:  # what the rights say is not all: a file system may be read-only, or of the kernel
        if os.access(nearest, os.W_OK | os.X_OK):
            Path(tempfile.mkdtemp(prefix=STAGING_PREFIX, dir=nearest)).rmdir()
            return
    except OSError:
        pass
    raise FeederError(nearest, "may not be written to", mend)


def safe_name(name: str) -> str:
    """Return a name that any file system takes as one folder.

    Parameters
    ----------
    name : str

    Returns
    -------
    str
        With '_' for letters that are refused, and behind a name that is reserved.
    """
    refused = {*'<>:"/\\|?*', *map(chr, range(32)), *NO_LETTERS}
    letters = "".join("_" if letter in refused else letter for letter in name).rstrip(". ")
    return f"{letters}_" if letters.split(".")[0].upper() in RESERVED or not letters else letters


def _inside(name: str) -> bool:
    path = PurePosixPath(name)
    return bool(path.parts) and not path.is_absolute() and ".." not in path.parts and "\\" not in name


def _write(path: Path, content: bytes) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(content)


@contextlib.contextmanager
def _lock(folder: Path) -> Iterator[None]:
    """Two commands on one part take turns at its record."""
    try:
        import fcntl
    except ImportError:  # Windows
        yield
        return
    handle = os.open(folder, os.O_RDONLY)
    try:
        fcntl.flock(handle, fcntl.LOCK_EX)
        yield
    finally:
        os.close(handle)


def write_rule(path: str | Path, targets: Iterable[str | Path], inputs: Iterable[str | Path]) -> None:
    """Write one rule, to be included by a Makefile, as a whole file.

    Parameters
    ----------
    path : str or Path
    targets : iterable of str or Path
        Files that are made.
    inputs : iterable of str or Path
        Files that they are made from.

    Raises
    ------
    FeederError
        If it cannot be written.
    """
    path = Path(path)
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        handle, staged = tempfile.mkstemp(dir=path.parent, prefix=".depfile.")
        with os.fdopen(handle, "wb") as file:
            file.write(os.fsencode(rule(targets, inputs)))
        Path(staged).chmod(0o644)
        Path(staged).replace(path)
    except OSError as error:
        raise FeederError(path, f"cannot be written ({error.strerror})", "give another `depfile`") from error


def rule(targets: Iterable[str | Path], inputs: Iterable[str | Path]) -> str:
    """Return the text of a rule for make.

    Parameters
    ----------
    targets, inputs : iterable of str or Path
        As for ``write_rule``.

    Returns
    -------
    str
    """
    target_words, input_words = ([_escape(path) for path in paths] for paths in (targets, inputs))
    first = f"{' '.join(target_words)}: " + " \\\n  ".join(input_words)
    return "".join(f"{line.rstrip()}\n" for line in (first, *(f"{path}:" for path in input_words)))


def _escape(path: str | Path) -> str:
    """A path with what make takes for its own marked."""
    text = Path(path).as_posix().replace("$", "$$")
    return "".join(f"\\{letter}" if letter in " #:%" else letter for letter in text)
