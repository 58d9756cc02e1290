"""A CSV that lists parts: one a line, with its density, units and bowl."""

import csv
import io
from dataclasses import dataclass
from pathlib import Path

from feederscrew import documents
from feederscrew.errors import ConfigError

PART, NAMES, ASPECT, CONFIG = "part", "names", "aspect", "config"
LISTED_OPTIONS = ("units", "density", "centre_of_mass", "body")
LISTING_COLUMNS = (PART, *LISTED_OPTIONS, NAMES, ASPECT, CONFIG)
MAX_LISTING_BYTES = 20_000_000  # [bytes] a few hundred thousand parts


@dataclass(frozen=True)
class Row:
    """One part of a list."""

    source: str
    options: tuple[tuple[str, str], ...] = ()  # those given
    config: str | None = None  # bowl file; None for those of the command line
    line: str = ""  # 'parts.csv:3'
    aspect: str | None = None  # the one wanted
    names: str | None = None  # file of names of its aspects


def read(path, faults):
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


def _header_faults(path, line, header):
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


def _row(path, line, header, cells, faults):
    """Return the part of a line, or none."""
    where, given = f"{path}:{line}", dict(zip(header, cells))
    if len(cells) > len(header):
        faults.append(ConfigError(where, "has more cells than the first line", "quote cells with commas"))
        return []
    if not given.get(PART):
        faults.append(ConfigError(where, "names no part", "fill its first column, or remove the line"))
        return []
    beside = Path(path).parent
    options = tuple((name, given[name]) for name in LISTED_OPTIONS if given.get(name))
    config, names = (str(beside / given[file]) if given.get(file) else None for file in (CONFIG, NAMES))
    return [Row(str(beside / given[PART]), options, config, where, given.get(ASPECT) or None, names)]
