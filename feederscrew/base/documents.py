"""YAML files as trees that remember where each word stands; every scalar stays text."""

import difflib
import math
import os
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, BinaryIO

from feederscrew.base.errors import ArgumentError, ConfigError, Faults, FeederError
from feederscrew.base.heavy import heavy
from feederscrew.base.units import quantity_text

yaml = heavy("yaml")
MAX_DOCUMENT_BYTES = 200_000  # [bytes] a bowl file or part card has a few hundred; longer ones parse slowly
READ_CHUNK_BYTES = 1 << 22  # [bytes] of a stream that are asked for at once
DEEPEST = 12  # levels of nesting
POINTER_HEAD = b"version https://git-lfs.github.com/spec/"
POINTER = "is a pointer file of git LFS, not the file it stands for"
PULL = "fetch the file with `git lfs pull`"
MAX_FAULTS = 50  # of a file that are listed


@dataclass(frozen=True)
class Node:
    """One value of a document: text, a mapping or a list."""

    where: str  # 'bowl.yaml:2:14'
    kind: str  # 'text', 'mapping' or 'list'
    text: str = ""  # of a text, as typed but for its quotes; '' also where nothing was written
    entries: tuple["Entry", ...] = ()  # of a mapping, in order, duplicates left out
    items: tuple["Node", ...] = ()  # of a list

    def find(self, key: str) -> "Entry | None":
        """Return the entry of a mapping under a key.

        Parameters
        ----------
        key : str

        Returns
        -------
        Entry or None
            None where the mapping has no such key, or the node is no mapping.
        """
        return next((entry for entry in self.entries if entry.key == key), None)


@dataclass(frozen=True)
class Entry:
    """One 'key: value' of a mapping."""

    key: str
    where: str  # of the key
    value: Node


def read(path: str | os.PathLike[str]) -> tuple[Node, list[FeederError]]:
    """Return the tree of a YAML file, and the faults that do not hide the rest.

    Parameters
    ----------
    path : str or path
        As the user typed it: every ``where`` opens with it.

    Returns
    -------
    root : Node
    faults : list of ConfigError
        As ``load`` returns them.

    Raises
    ------
    ConfigError
        If the file cannot be read, is a stream, or is not one YAML document.
    """
    if str(path) == "-" or found_as(Path.is_fifo, path):
        what = "is a stream, and a bowl file is read more than once"
        raise ConfigError(path, what, "save it and name the file")
    return load(content(path, MAX_DOCUMENT_BYTES, "a YAML file"), str(path))


def found_as(kind: Callable[[Path], bool], path: str | os.PathLike[str]) -> bool:
    """Return whether a path is of a kind; False if the system refuses it.

    Parameters
    ----------
    kind : callable
        Such as ``Path.is_dir``.
    path : str or path

    Returns
    -------
    bool
    """
    try:
        return kind(Path(path))
    except OSError:
        return False


def content(
    path: str | os.PathLike[str], most: int, wanted: str, kind: type[FeederError] = ConfigError
) -> bytes | bytearray:
    """Return the bytes of a file as the user named it, at most one more than are of use.

    The one more shows that the file is too long.

    Parameters
    ----------
    path : str or path
    most : int
        Bytes that are of use.
    wanted : str
        What to name in place of a folder: 'a YAML file'.
    kind : class
        Of the fault.

    Returns
    -------
    bytes or bytearray

    Raises
    ------
    FeederError
        Of the ``kind``, if the file cannot be read, or is the pointer of a large file that is not fetched.
    """
    if not str(path):
        raise kind("''", "is an empty path", f"name {wanted}")
    try:
        with Path(path).open("rb") as file:
            data = upto(file, most)
    except FileNotFoundError:
        if Path(path).is_symlink():
            raise kind(path, "is a link to a file that is not there", "mend or remove the link") from None
        raise kind(path, "no such file", "check the path") from None
    except IsADirectoryError:
        raise kind(path, "is a folder", f"name {wanted} in it") from None
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise kind(path, f"cannot be read ({reason})", "check the path and its permissions") from None
    if data.startswith(POINTER_HEAD):
        raise kind(path, POINTER, PULL)
    return data


def upto(file: BinaryIO, most: int) -> bytes | bytearray:
    """Read a binary file, or a stream in pieces, up to one byte more than are of use.

    An ordinary file is read at once. A pipe has no size, so it is read until it ends.

    Parameters
    ----------
    file : binary file
    most : int
        Bytes that are of use.

    Returns
    -------
    bytes or bytearray
    """
    try:
        size = os.fstat(file.fileno()).st_size
    except (OSError, ValueError):  # one in memory has no descriptor
        size = 0
    data = file.read(min(size, most) + 1)
    if len(data) <= most and (piece := file.read(min(READ_CHUNK_BYTES, most + 1 - len(data)))):
        longer = bytearray(data)
        while piece:
            longer += piece
            piece = file.read(min(READ_CHUNK_BYTES, max(most + 1 - len(longer), 0)))
        return bytes(longer) if len(longer) <= most else longer
    return data


def load(text: str | bytes | bytearray, name: str) -> tuple[Node, list[FeederError]]:
    """Return the tree of a YAML text, and the faults that do not hide the rest.

    Parameters
    ----------
    text : str or bytes
        Bytes as UTF-8.
    name : str
        Of the file: every ``where`` opens with it.

    Returns
    -------
    Node
        The root.
    list of ConfigError
        Duplicate keys, anchors and tags.

    Raises
    ------
    ConfigError
        If the text is empty, too long, not UTF-8 or not one YAML document.
    """
    if len(text) > MAX_DOCUMENT_BYTES:
        what = f"has more than {MAX_DOCUMENT_BYTES // 1000} kB"
        raise ConfigError(name, what, "name a YAML file of settings")
    text = text if isinstance(text, str) else decoded(text, name)
    builder = _Builder(name)
    try:
        root = builder.document(_events(text))
    except yaml.reader.ReaderError as error:
        line = text.count("\n", 0, error.position) + 1
        what = f"has the character U+{error.character:04X}, which no text file needs"
        raise ConfigError(f"{name}:{line}", what, "remove it") from None
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        where = f"{name}:{mark.line + 1}:{mark.column + 1}" if mark else name
        what = " ".join(f"is not YAML ({error.problem or error.context})".split())
        raise ConfigError(where, what, "check the colons, quotes and indentation here") from None
    return root, builder.faults


def decoded(data: bytes | bytearray, name: str) -> str:
    """Return the bytes of a text file as text.

    Parameters
    ----------
    data : bytes
        UTF-8, with a byte order mark or without.
    name : str
        Of the file.

    Returns
    -------
    str

    Raises
    ------
    ConfigError
        If it is not UTF-8; it names the line.
    """
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        what = f"byte 0x{data[error.start]:02x} is not UTF-8"
        raise ConfigError(f"{name}:{line}", what, "save the file as UTF-8 text") from None


def raise_all(faults: Iterable[FeederError]) -> None:
    """Raise the faults of a file together; without any, do nothing.

    Parameters
    ----------
    faults : iterable of FeederError
        In any order. Of those of one place the first counts.

    Raises
    ------
    Faults
        Up to MAX_FAULTS, in the order of the file's lines, and a line that counts the others.
    """
    first: dict[str, FeederError] = {}
    for fault in faults:
        first.setdefault(str(fault.where), fault)

    def position(fault: FeederError) -> tuple[float, ...]:
        """Line and column of a file; what is in no file comes last, in its order."""
        numbers = str(fault.where).rsplit(":", 2)[1:]
        in_file = len(numbers) == 2 and all(number.isdecimal() for number in numbers)
        return tuple(map(int, numbers)) if in_file else (math.inf, 0)

    listed = sorted(first.values(), key=position)
    if len(listed) > MAX_FAULTS:
        where = str(listed[MAX_FAULTS].where)
        more = f"the first of {len(listed) - MAX_FAULTS} further faults"
        kind = ArgumentError if all(isinstance(fault, ArgumentError) for fault in listed) else ConfigError
        listed = [*listed[:MAX_FAULTS], kind(where, more, "mend those above first")]
    if listed:
        raise Faults(listed)


def hint(word: str, candidates: Iterable[str]) -> str:
    """Return how to mend an unknown word: the nearest known one, or the list of them.

    Parameters
    ----------
    word : str
    candidates : iterable of str
        Known words.

    Returns
    -------
    str
        'did you mean steel?'
    """
    near = nearest(word, candidates)
    return f"did you mean {near}?" if near is not None else f"known are {', '.join(candidates)}"


def nearest(word: str, candidates: Iterable[str]) -> str | None:
    """Return the known word that an unknown one is likely meant for.

    Parameters
    ----------
    word : str
    candidates : iterable of str
        Known words; case does not matter.

    Returns
    -------
    str or None
        None where none is near.
    """
    folded = {name.lower(): name for name in candidates}
    near = difflib.get_close_matches(word.lower(), folded, n=1, cutoff=0.6)
    return folded[near[0]] if near else None


def _events(text: str) -> Iterator[Any]:
    """Events of a YAML text: of libyaml, ten times as fast; faults, which it words otherwise, of PyYAML."""
    try:
        return iter(list(yaml.parse(text, Loader=yaml.CSafeLoader)))
    except (AttributeError, yaml.YAMLError):
        return yaml.parse(text, Loader=yaml.SafeLoader)


class _Builder:
    """Turns parser events into nodes, noting what a settings file has no use for."""

    def __init__(self, name: str) -> None:
        self.name, self.faults = name, list[FeederError]()

    def document(self, events: Iterator[Any]) -> Node:
        """Return the one document of the stream."""
        root = None
        for event in events:
            if isinstance(event, yaml.DocumentStartEvent) and root is not None:
                raise self.fault(event, "a second document begins", "keep one document in a file")
            if isinstance(event, yaml.NodeEvent):
                root = self.node(event, events, 0)
        if root is None or (root.kind, root.text) == ("text", ""):
            raise ConfigError(self.name, "is empty", "write at least one 'key: value' line")
        return root

    def node(self, event: Any, events: Iterator[Any], depth: int) -> Node:
        if depth > DEEPEST:
            raise self.fault(event, f"is nested deeper than {DEEPEST} levels", "write it flatter")
        extra = None  # what a plain settings file has no use for
        if isinstance(event, yaml.AliasEvent):
            extra, mend = f"alias {quantity_text('*' + event.anchor)}", "write the value itself"
        elif event.anchor is not None:
            extra, mend = f"anchor {quantity_text('&' + event.anchor)}", "write the value alone"
        elif event.tag is not None:
            extra, mend = f"tag {quantity_text(event.tag)}", "write the value alone"
        if extra is not None:
            self.faults.append(self.fault(event, f"{extra} is not allowed", mend))
        where = self.where(event)
        if isinstance(event, yaml.SequenceStartEvent):
            items: list[Node] = []
            while not isinstance(event := next(events), yaml.SequenceEndEvent):
                items.append(self.node(event, events, depth + 1))
            return Node(where, "list", items=tuple(items))
        if not isinstance(event, yaml.MappingStartEvent):
            return Node(where, "text", text=getattr(event, "value", ""))
        entries: dict[str, Entry] = {}
        while not isinstance(event := next(events), yaml.MappingEndEvent):
            key = self.node(event, events, depth + 1)
            value = self.node(next(events), events, depth + 1)
            if key.kind != "text":
                self.faults.append(ConfigError(key.where, "a key is not plain text", "write 'key: value'"))
            elif key.text in entries:
                line = entries[key.text].where.rsplit(":", 2)[1]
                what = f"key {quantity_text(key.text)} is already in line {line}"
                self.faults.append(ConfigError(key.where, what, "keep one of them"))
            else:
                entries[key.text] = Entry(key.text, key.where, value)
        return Node(where, "mapping", entries=tuple(entries.values()))

    def fault(self, event: Any, what: str, mend: str) -> ConfigError:
        return ConfigError(self.where(event), what, mend)

    def where(self, event: Any) -> str:
        return f"{self.name}:{event.start_mark.line + 1}:{event.start_mark.column + 1}"
