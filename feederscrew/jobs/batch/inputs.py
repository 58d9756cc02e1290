"""From what was typed to one request a part and bowl: folders, patterns, lists of parts and of designs."""

import contextlib
import csv
import glob
import io
import os
import re
import unicodedata
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from feederscrew import bowl as bowls
from feederscrew.base import documents, units
from feederscrew.base.columns import Cells, Document, Frame
from feederscrew.base.documents import found_as, raise_all
from feederscrew.base.errors import ConfigError, Faults, FeederError
from feederscrew.jobs.batch.task import FAILED as FAILED
from feederscrew.jobs.batch.task import Conditions, Request
from feederscrew.motion import conveying as answer
from feederscrew.output.folder import safe_name
from feederscrew.part.card import read_aspect_names
from feederscrew.part.formats import CARD_FORMAT, MESH_FORMATS
from feederscrew.part.record import AspectNames

PART = "part"
NAMES = "names"
ASPECT = "aspect"
CONFIG = "config"
LISTED_OPTIONS = ("units", "density", "centre_of_mass", "body")
LISTING_COLUMNS = (PART, *LISTED_OPTIONS, NAMES, ASPECT, CONFIG)
ORDER_COLUMNS = (PART, "target", ASPECT)
MAX_LISTING_BYTES = 20_000_000  # [bytes] a few hundred thousand parts
CARDS = set(MESH_FORMATS[CARD_FORMAT].suffixes)
MESHES = {suffix for form in MESH_FORMATS.values() for suffix in form.suffixes} - CARDS
CARD_KEY = re.compile(rb"^(mass|inertia|aspects)\s*:", re.MULTILINE)
# of a folder's name
LONGEST = 80  # letters
MOST_BYTES = 160  # bytes
Rows = list[tuple[int, list[str]]]


@dataclass(frozen=True)
class ListedPart:
    """One part of a list."""

    source: str
    options: tuple[tuple[str, str], ...] = ()  # those given
    config: str | None = None  # bowl file; None for those of the command line
    line: str = ""  # 'parts.csv:3'
    aspect: str | None = None  # the one wanted
    names: str | None = None  # file of names of its aspects


@dataclass(frozen=True)
class DesignOrder:
    """One part of the list of ``feeder design --batch``."""

    source: str
    target: float | None  # [1/s]; None: that of the command line
    aspect: str | None
    line: str  # 'list.csv:3'


def read_orders(path: str) -> tuple[DesignOrder, ...]:
    """Return the parts of a list of designs; their paths count from its folder.

    ``path`` is a CSV whose first line names columns out of ``ORDER_COLUMNS``; lines that begin with # are
    comments. Raises ConfigError if it cannot be read, lists no part, or a target is no rate.
    """
    (first, head), *lines = _lines(path)
    if PART not in head or set(head) - set(ORDER_COLUMNS):
        mend = f"begin with {','.join(ORDER_COLUMNS)}"
        raise ConfigError(f"{path}:{first}", "is not the head of a list", mend)
    if not lines:
        raise ConfigError(path, "lists no part", "write a line a part")
    orders = []
    for number, cells in lines:
        where, row, target = f"{path}:{number}", dict(zip(head, cells)), None
        if not row.get(PART):
            raise ConfigError(where, "names no part", "write its file, or leave the line out")
        if typed := row.get("target"):
            try:
                target = units.quantity(typed, "rate")
            except ValueError as error:
                raise ConfigError(where, f"target {typed[:40]!r} is no rate", "write 40/min") from error
            if not target > 0.0:
                raise ConfigError(where, "a target is not above 0", "write 40/min")
        orders.append(DesignOrder(str(Path(path).parent / row[PART]), target, row.get(ASPECT) or None, where))
    return tuple(orders)


def order_row(order: DesignOrder, target: float, document: Document) -> Cells:
    """Return the row of a design, from its document.

    Parameters
    ----------
    order : DesignOrder
    target : float [1/s]
        Parts that the design was asked for.
    document : dict
        Of the design; of a part that failed it has ``status`` and ``why``.

    Returns
    -------
    dict of str to value
        A column each; None where the document says nothing.
    """
    columns = ("status", "wanted", "delivered_per_minute", "why")
    own = {name: document.get(name) for name in columns}
    return {"part": order.source, "target_per_minute": target / units.PER_MINUTE} | own


def order_table(rows: list[Cells]) -> Frame:
    """Return what holds, a row a part."""
    return Frame.of({name: [row[name] for row in rows] for name in rows[0]})


def _lines(path: str) -> Rows:
    """The lines of a CSV that are neither empty nor comments, numbered; (1, []) where there is none."""
    data = documents.content(path, MAX_LISTING_BYTES, "a CSV file")
    if len(data) > MAX_LISTING_BYTES:
        raise ConfigError(path, f"has more than {MAX_LISTING_BYTES // 10**6} MB", "split the list")
    try:
        lines = list(enumerate(csv.reader(io.StringIO(documents.decoded(data, path)), strict=True), 1))
    except csv.Error as error:
        raise ConfigError(path, f"is not CSV ({error})", "check its quotes and commas") from error
    filled = [(n, [cell.strip() for cell in cells]) for n, cells in lines if "".join(cells).strip()]
    return [line for line in filled if not line[1][0].startswith("#")] or [(1, [])]


def read_listing(path: str, faults: list[FeederError]) -> list[ListedPart]:
    """Return the parts of a list; paths in it count from its folder.

    Parameters
    ----------
    path : str
        CSV whose first line names columns of ``LISTING_COLUMNS``; lines that begin with # are comments.
    faults : list of FeederError
        The faults of the list are added to it, each with its line.

    Returns
    -------
    list of ListedPart
        Empty where the first line is wrong.
    """
    try:
        (first, header), *rows = _lines(path)
    except ConfigError as fault:
        faults.append(fault)
        return []
    where, before = f"{path}:{first}", len(faults)
    if PART not in header:
        mend = f"begin with a line such as {','.join(LISTING_COLUMNS)}"
        faults.append(ConfigError(where, "has no column 'part'", mend))
        return []
    for name in dict.fromkeys(name for name in header if name not in LISTING_COLUMNS):
        mend = documents.hint(name, LISTING_COLUMNS)
        faults.append(ConfigError(where, f"unknown column {name[:40]!r}", mend))
    for name in dict.fromkeys(name for name in header if header.count(name) > 1):
        faults.append(ConfigError(where, f"column '{name}' is there twice", "keep one"))
    if len(faults) > before:
        return []
    if not rows:
        faults.append(ConfigError(path, "lists no part", "write a line a part"))
    parts = []
    folder = Path(path).parent
    for line, cells in rows:
        where, texts = f"{path}:{line}", dict(zip(header, cells))
        if len(cells) > len(header):
            faults.append(ConfigError(where, "has more cells than the first line", "quote cells with commas"))
        elif not texts.get(PART):
            faults.append(ConfigError(where, "names no part", "fill its first column, or remove the line"))
        else:
            options = tuple((name, texts[name]) for name in LISTED_OPTIONS if texts.get(name))
            config, names = (str(folder / texts[k]) if texts.get(k) else None for k in (CONFIG, NAMES))
            source, aspect = str(folder / texts[PART]), texts.get(ASPECT) or None
            parts.append(ListedPart(source, options, config, where, aspect, names))
    return parts


def gather(
    sources: Sequence[str],
    configs: Sequence[str] = (),
    overrides: Sequence[str] = (),
    density: str | None = None,
) -> tuple[Request, ...]:
    """Gather every part in every bowl, each with a folder name of its own.

    Parameters
    ----------
    sources : sequence of str
        Part files, folders of them, patterns ('parts/**/*.stl') and lists ('parts.csv'). A folder that holds
        no part itself is read one folder deeper; ``find_folders_within`` says so.
    configs : sequence of str
        Bowl files, folders of them and patterns; none for the defaults.
    overrides : sequence of str
        'drive.frequency=50 Hz', for every bowl.
    density : str, optional
        For each part that names none in a list.

    Returns
    -------
    tuple of Request
        In the order given; those of a folder or a pattern in the order of their names.

    Raises
    ------
    FeederError, Faults
        If a folder or a pattern holds no part, or a list or a bowl cannot be used.
    """
    faults: list[FeederError] = []
    wanted: list[str | None] = [path for config in configs for path in _expanded(config, CARDS, "bowl")]
    wanted = wanted or [None]
    rows: list[ListedPart] = []
    for source in sources:
        if Path(source).suffix.lower() == ".csv" and not found_as(Path.is_dir, source):
            rows += read_listing(source, faults)
        else:
            rows += [ListedPart(path) for path in _expanded(source, MESHES | CARDS, "part")]
    lines = dict.fromkeys(wanted, "")  # of a list, by the bowl file that it asks for
    for row in rows:
        if row.config:
            lines.setdefault(row.config, row.line)
    bowls_by_path: dict[str | None, Any] = {}
    for path, line in lines.items():
        try:
            settings = bowls.settings(path, overrides)
            bowls_by_path[path] = Conditions(
                bowls.name(path),
                answer.conveying(bowls.record(settings)),
                tuple(bowls.texts(settings).items()),
                has_file=path is not None,
                warnings=bowls.remarks(settings),
                tried=bowls.verified(path),
            )
        except Faults as several:
            faults += several.faults
        except FeederError as fault:
            where, what = fault.where, fault.what  # of which bowl, and in which line it is asked for
            if path is not None and not str(where).startswith(str(path)):
                where, what = path, f"{where} {what}"
            located = ConfigError(f"{line}: {where}" if line else where, what, fault.mend)
            faults.append(located if path is not None or line else fault)
    names: dict[str | None, AspectNames | None] = {None: None}  # of the aspects, by the file asked for
    for row in rows:
        if row.names is not None and row.names not in names:
            names[row.names] = None
            try:
                names[row.names] = read_aspect_names(row.names)
            except Faults as several:
                faults += several.faults
            except FeederError as fault:
                faults.append(ConfigError(f"{row.line}: {fault.where}", fault.what, fault.mend))
    raise_all(faults)
    requests: dict[Request, None] = {}
    for row in rows:
        options = row.options
        is_card = Path(row.source).suffix[1:].lower() in CARDS  # which says its own density
        if density is not None and "density" not in dict(options) and not is_card:
            options = (*options, ("density", density))
        for path in [row.config] if row.config else wanted:
            conditions, aspect = bowls_by_path[path], row.aspect
            request = Request(row.source, conditions, options, aspect=aspect, names=names[row.names])
            requests.setdefault(replace(request, line=row.line))
    return _named(list(requests))


def find_folders_within(sources: Sequence[str]) -> tuple[str, ...]:
    """Return a line for each folder of ``sources`` whose own folders hold parts: whether they are read.

    A folder is read one folder deeper where it holds no part itself.

    Parameters
    ----------
    sources : sequence of str
        As of ``gather``.

    Returns
    -------
    tuple of str
    """
    lines = []
    for source in sources:
        path = Path(source)
        if not found_as(Path.is_dir, path):
            continue
        deeper = _files_deeper(path, MESHES | CARDS, "part")
        folders = units.counted(len({Path(file).parent for file in deeper}), "folder")
        count = units.counted(len(deeper), "part")
        if deeper and any(_fits(p, MESHES | CARDS, "part") for p in path.iterdir()):
            pattern = units.printable(str(path / "*" / f"*{Path(deeper[0]).suffix}"))
            lines.append(f"{units.printable(source)}: {count} in {folders} of it left out - add '{pattern}'")
        elif deeper:
            lines.append(f"{units.printable(source)}: holds no part itself: read {count} in {folders} of it")
    return tuple(lines)


def _files_deeper(folder: Path, suffixes: set[str], kind: str) -> list[str]:
    """The files one folder deeper, by folder and name; none of hidden folders, or that cannot be read."""
    files = []
    for inner in sorted(folder.iterdir()):
        if not inner.name.startswith("."):
            with contextlib.suppress(OSError):
                files += [str(p) for p in sorted(inner.iterdir()) if _fits(p, suffixes, kind)]
    return files


def _expanded(typed: str, suffixes: set[str], kind: str) -> list[str]:
    """The files of a folder, or one folder deeper, or of a pattern by name; a file itself, there or not."""
    path = Path(typed)
    if found_as(Path.is_dir, path):
        paths = [str(p) for p in sorted(path.iterdir()) if _fits(p, suffixes, kind)]
        if not paths and kind == "part":
            paths = _files_deeper(path, suffixes, kind)
        what, mend = f"holds no {kind} file", f"name a folder of {kind} files, or a pattern"
    elif glob.has_magic(typed) and not found_as(Path.exists, path):
        # each file by its shortest path: links between folders may lead round in a circle
        shortest: dict[tuple[Path, str], str] = {}
        matches = (p for p in glob.glob(typed, recursive=True) if _is_there(Path(p)))  # noqa: PTH207 - takes any path
        for match in sorted(matches, key=lambda match: (len(Path(match).parts), match)):
            shortest.setdefault((Path(match).parent.resolve(), Path(match).name), match)
        paths, what, mend = sorted(shortest.values()), "fits no file", "check the pattern"
    else:
        return [typed]
    if not paths:
        raise FeederError(typed, what, mend)
    return paths


def _fits(path: Path, suffixes: set[str], kind: str) -> bool:
    """Return whether a file of a folder is meant: parts and bowls may lie side by side."""
    suffix = path.suffix.lower().removeprefix(".")
    if suffix not in suffixes or not _is_there(path) or path.name.startswith("."):
        return False
    if suffix not in CARDS or not path.is_file():
        return True
    content = documents.content(path, documents.MAX_DOCUMENT_BYTES, "a YAML file")
    return (CARD_KEY.search(content) is not None) == (kind == "part")


def _is_there(path: Path) -> bool:
    """Return whether a file is there, or a link that leads nowhere, to be reported."""
    return path.is_file() or (path.is_symlink() and not path.exists())


def _named(requests: list[Request]) -> tuple[Request, ...]:
    """The requests with folder names that differ on every file system: upper and lower case are the same."""
    several = len({request.conditions for request in requests}) > 1
    labels = []
    for request in requests:
        stem = unicodedata.normalize("NFC", Path(request.source).stem)
        name = f"{stem}-{request.conditions.name}" if several else stem
        short = os.fsencode(safe_name(name)[:LONGEST])[:MOST_BYTES].decode(errors="ignore")
        labels.append(safe_name(short))
    taken, named, labelled = set(map(_folded, labels)), set[str](), []
    for request, label in zip(requests, labels):
        name, number = label, 2
        while _folded(name) in (named if name == label else named | taken):  # that no other has or wants
            name, number = f"{label}-{number}", number + 1
        named.add(_folded(name))
        labelled.append(replace(request, name=name))
    return tuple(labelled)


def _folded(name: str) -> str:
    return unicodedata.normalize("NFC", name).casefold()
