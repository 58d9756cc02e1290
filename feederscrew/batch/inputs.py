"""From what was typed to one request a part and bowl: folders, patterns, and CSV lists of parts."""

import csv
import glob
import io
import os
import re
import unicodedata
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from feederscrew import bowl as bowls
from feederscrew import documents
from feederscrew.batch.task import Conditions, Request
from feederscrew.conveying import answer
from feederscrew.documents import found_as, raise_all
from feederscrew.errors import ConfigError, FeederError
from feederscrew.output.folder import safe_name
from feederscrew.part.card import read_aspect_names
from feederscrew.part.formats import CARD_FORMAT, MESH_FORMATS
from feederscrew.part.record import AspectNames

PART, NAMES, ASPECT, CONFIG = "part", "names", "aspect", "config"
LISTED_OPTIONS = ("units", "density", "centre_of_mass", "body")
LISTING_COLUMNS = (PART, *LISTED_OPTIONS, NAMES, ASPECT, CONFIG)
MAX_LISTING_BYTES = 20_000_000  # [bytes] a few hundred thousand parts


@dataclass(frozen=True)
class ListedPart:
    """One part of a list."""

    source: str
    options: tuple[tuple[str, str], ...] = ()  # those given
    config: str | None = None  # bowl file; None for those of the command line
    line: str = ""  # 'parts.csv:3'
    aspect: str | None = None  # the one wanted
    names: str | None = None  # file of names of its aspects


def read_listing(path, faults) -> list[Any]:
    """Read the parts of a list; their paths count from its folder.

    Parameters
    ----------
    path : str
        A CSV whose first line names columns out of ``LISTING_COLUMNS``; lines that begin with # are comments.
    faults : list of ConfigError
        What is wrong in it is added.

    Returns
    -------
    list of Row
    """
    try:
        lines = list(enumerate(csv.reader(io.StringIO(_text(path)), strict=True), 1))
    except ConfigError as fault:
        faults.append(fault)
        return []
    except csv.Error as error:
        faults.append(ConfigError(path, f"is not CSV ({error})", "check its quotes and commas"))
        return []
    filled = [(n, [cell.strip() for cell in cells]) for n, cells in lines if "".join(cells).strip()]
    (first, header), *rows = [line for line in filled if not line[1][0].startswith("#")] or [(1, [])]
    wrong = _header_faults(path, first, header)
    faults += wrong if wrong or rows else [ConfigError(path, "lists no part", "write a line a part")]
    return [] if wrong else [row for n, cells in rows for row in _row(path, n, header, cells, faults)]


def _text(path):
    data = documents.content(path, MAX_LISTING_BYTES, "a CSV file")
    if len(data) > MAX_LISTING_BYTES:
        raise ConfigError(path, f"has more than {MAX_LISTING_BYTES // 10**6} MB", "split the list")
    return documents.decoded(data, path)


def _header_faults(path, line, header) -> list[Any]:
    where = f"{path}:{line}"
    if PART not in header:
        return [
            ConfigError(
                where, "has no column 'part'", f"begin with a line such as {','.join(LISTING_COLUMNS)}"
            )
        ]
    odd = dict.fromkeys(name for name in header if name not in LISTING_COLUMNS)
    twice = dict.fromkeys(name for name in header if header.count(name) > 1)
    return [
        *(
            ConfigError(where, f"unknown column {name[:40]!r}", documents.hint(name, LISTING_COLUMNS))
            for name in odd
        ),
        *(ConfigError(where, f"column '{name}' is there twice", "keep one") for name in twice),
    ]


def _row(path, line, header, cells, faults) -> list[Any]:
    """Return the part of a line, or none."""
    where, texts = f"{path}:{line}", dict(zip(header, cells))
    if len(cells) > len(header):
        faults.append(ConfigError(where, "has more cells than the first line", "quote cells with commas"))
        return []
    if not texts.get(PART):
        faults.append(ConfigError(where, "names no part", "fill its first column, or remove the line"))
        return []
    folder = Path(path).parent
    options = tuple((name, texts[name]) for name in LISTED_OPTIONS if texts.get(name))
    config, names = (str(folder / texts[file]) if texts.get(file) else None for file in (CONFIG, NAMES))
    return [ListedPart(str(folder / texts[PART]), options, config, where, texts.get(ASPECT) or None, names)]


MESHES = {
    suffix
    for name, file_format in MESH_FORMATS.items()
    if name != CARD_FORMAT
    for suffix in file_format.suffixes
}
CARDS = set(MESH_FORMATS[CARD_FORMAT].suffixes)
CARD_KEY = re.compile(rb"^(mass|inertia|aspects)\s*:", re.MULTILINE)
LONGEST, MOST_BYTES = 80, 160  # letters and bytes of a folder's name


def gather(sources, configs=(), overrides=(), density=None) -> tuple[Any, ...]:
    """Gather every part in every bowl, each with a folder name of its own.

    Parameters
    ----------
    sources : sequence of str
        Part files, folders of them, patterns ('parts/**/*.stl') and lists ('parts.csv').
    configs : sequence of str
        Bowl files, folders of them and patterns; none for the defaults.
    overrides : sequence of str
        'drive.frequency=50 Hz', for every bowl.
    density : str, optional
        Material or value of each part that names none in a list.

    Returns
    -------
    tuple of Request
        In the order given; a folder's or a pattern's in the order of their names.

    Raises
    ------
    FeederError, Faults
        If a folder or a pattern holds no part, or a list or a bowl cannot be used.
    """
    faults: list[FeederError] = []
    wanted = [path for config in configs for path in _expanded(config, CARDS, "bowl")] or [None]
    rows = [_of_density(row, density) for source in sources for row in _rows(source, faults)]
    lines = dict.fromkeys(wanted, "")
    for row in rows:
        if row.config:
            lines.setdefault(row.config, row.line)
    bowls_by_path = {path: _conditions(path, overrides, faults, line) for path, line in lines.items()}
    names = _names(rows, faults)
    raise_all(faults)
    requests = dict.fromkeys(
        _request(row, bowls_by_path[path], names[row.names])
        for row in rows
        for path in ([row.config] if row.config else wanted)
    )
    return _named(list(requests))


def _of_density(row, density):
    """The row with a density, unless it names one or is a part card, which says its own."""
    if density is None or "density" in dict(row.options) or Path(row.source).suffix[1:].lower() in CARDS:
        return row
    return replace(row, options=(*row.options, ("density", density)))


def _request(row, conditions, names) -> Request:
    return Request(row.source, conditions, row.options, line=row.line, aspect=row.aspect, names=names)


def _names(rows, faults):
    """Read the names of the aspects by the file that a row asks for; None where it has faults."""
    names_by_file: dict[str | None, AspectNames | None] = {None: None}
    for row in rows:
        if row.names not in names_by_file:
            names_by_file[row.names] = None
            try:
                names_by_file[row.names] = read_aspect_names(row.names)
            except FeederError as fault:
                located = ConfigError(f"{row.line}: {fault.where}", fault.what, fault.mend)
                faults += getattr(fault, "faults", [located])
    return names_by_file


def _rows(source, faults) -> list[Any]:
    """Return the parts that one argument stands for."""
    if Path(source).suffix.lower() == ".csv" and not found_as(Path.is_dir, source):
        return read_listing(source, faults)
    return [ListedPart(path) for path in _expanded(source, MESHES | CARDS, "part")]


def _expanded(typed, suffixes, kind):
    """Return the files of a folder or of a pattern by name; a file itself, there or not."""
    path = Path(typed)
    if found_as(Path.is_dir, path):
        paths = [str(p) for p in sorted(path.iterdir()) if _fits(p, suffixes, kind)]
        return _some(paths, typed, f"holds no {kind} file", f"name a folder of {kind} files, or a pattern")
    if glob.has_magic(typed) and not found_as(Path.exists, path):
        paths = _once(p for p in sorted(glob.glob(typed, recursive=True)) if _there(Path(p)))  # noqa: PTH207 - takes any path
        return _some(paths, typed, "fits no file", "check the pattern")
    return [typed]


def _fits(path, suffixes, kind):
    """Return whether a file of a folder is meant: parts and bowls may lie side by side."""
    suffix = path.suffix.lower().removeprefix(".")
    if suffix not in suffixes or not _there(path) or path.name.startswith("."):
        return False
    if suffix not in CARDS or not path.is_file():
        return True
    held = documents.content(path, documents.MAX_DOCUMENT_BYTES, "a YAML file")
    return (CARD_KEY.search(held) is not None) == (kind == "part")


def _there(path):
    """Return whether a file is meant: one that is there, or a link that leads nowhere, to be reported."""
    return path.is_file() or (path.is_symlink() and not path.exists())


def _once(paths) -> list[Any]:
    """Keep each file by its shortest way: links between folders may lead round in a circle."""
    shortest: dict[tuple[Path, str], str] = {}
    for path in sorted(paths, key=lambda path: (len(Path(path).parts), path)):
        shortest.setdefault((Path(path).parent.resolve(), Path(path).name), path)
    return sorted(shortest.values())


def _some(matches, typed, what, mend):
    if not matches:
        raise FeederError(typed, what, mend)
    return matches


def _conditions(path, overrides, faults, line) -> Conditions | None:
    """Read the bowl of a file, asked for in a line of a list or in none; None where it has faults."""
    try:
        settings = bowls.settings(path, overrides)
        bowl = answer.conveying(bowls.record(settings))
        texts = tuple(bowls.texts(settings).items())
        remarks = bowls.remarks(settings)
        return Conditions(
            bowls.name(path),
            bowl,
            texts,
            has_file=path is not None,
            warnings=remarks,
            tried=bowls.verified(path),
        )
    except FeederError as fault:
        faults += getattr(fault, "faults", [_placed(fault, path, line)])
        return None


def _placed(fault, path, line):
    """Make a fault of a bowl say of which, once there are several, and the line that asks for it."""
    if path is not None and not str(fault.where).startswith(str(path)):
        fault = ConfigError(path, f"{fault.where} {fault.what}", fault.mend)
    return ConfigError(f"{line}: {fault.where}", fault.what, fault.mend) if line else fault


def _named(requests) -> tuple[Any, ...]:
    """Give the requests folder names that differ on every file system."""
    several = len({request.conditions for request in requests}) > 1
    labels = [_label(request, several) for request in requests]
    taken = set(map(_folded, labels))
    named: set[str] = set()
    labelled = []
    for request, label in zip(requests, labels):
        name = _unlike(label, named, taken)
        named.add(_folded(name))
        labelled.append(replace(request, name=name))
    return tuple(labelled)


def _label(request, several):
    stem = unicodedata.normalize("NFC", Path(request.source).stem)
    name = f"{stem}-{request.conditions.name}" if several else stem
    return safe_name(os.fsencode(safe_name(name)[:LONGEST])[:MOST_BYTES].decode(errors="ignore"))


def _unlike(label, named, taken):
    """Return the label, or the label with the first number that no other part has or wants."""
    if _folded(label) not in named:
        return label
    number = 2
    while _folded(f"{label}-{number}") in named | taken:
        number += 1
    return f"{label}-{number}"


def _folded(name):
    """Return a name as a file system sees it that takes upper and lower case for the same."""
    return unicodedata.normalize("NFC", name).casefold()
