"""One row a part for summary and contact sheets; and the index, in pages with a line a part."""

import csv
import io
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from urllib.parse import quote

from feederscrew.batch.task import DONE, NOT_COMPUTED, PARTS, THUMBNAIL
from feederscrew.output import tables
from feederscrew.output.batch import ACROSS, DOWN
from feederscrew.output.page.blocks import Chapter, MarkedCell, Matrix, Page, Picture
from feederscrew.units import counted

SUMMARY_FILE = "summary.csv"
PARTIAL = "summary_partial.csv"  # of a run that was stopped, beside the tables of an earlier one
SUMMARY_COLUMNS = (
    "part", "folder", "config", "status", "reason", "material", "mass_g", "aspects", "aspect", "heading_deg",
    "orientation", "rule", "answer", "p_orientation", "passes_devices", "velocity_mm_s", "regime", "pitch_mm",
    "parts_per_minute", "parts_per_minute_low", "parts_per_minute_high",
    "drops", "drop_aspect", "p_drop", "note", "warnings",
)  # fmt: skip
FORMULA = ("=", "+", "-", "@", "\t", "\r")
TILES = ACROSS * DOWN
HIDDEN_SUMMARY_COLUMNS = (  # from a table for people; reasons stand above it, a line each
    "reason", "folder", "aspects", "material", "aspect", "heading_deg", "rule", "answer", "regime",
    "passes_devices", "drops", "drop_aspect", "p_drop",
    "note", "warnings",
)  # fmt: skip


def rows(store, requests, finished=None) -> tuple[Any, ...]:
    """Read what the disk says of each part.

    Parameters
    ----------
    store : Store
    requests : sequence of Request
    finished : set of str, optional
        Folders of those that are done; what lies in others is of an earlier run and is not read.

    Returns
    -------
    tuple of dict
        By ``SUMMARY_COLUMNS``, None where there is nothing to say.
    """
    nothing = {"status": NOT_COMPUTED, "reason": "", "warnings": (), "row": {}}
    return tuple(
        _row(store.record(request.name) if finished is None or request.name in finished else nothing, request)
        for request in requests
    )


def is_partial(text) -> bool:
    """Return whether the text of a summary is that of a run that was stopped."""
    return any(row.get("status") == NOT_COMPUTED for row in csv.DictReader(io.StringIO(text)))


def _row(record, request) -> dict[Any, Any]:
    columns = {
        "part": Path(request.source).name,
        "folder": request.name,
        "config": request.conditions.name,
        "status": record["status"],
        "reason": record["reason"] or None,
        "warnings": "; ".join(record["warnings"]) or None,
    }
    numbers = record["row"] | columns
    return {name: numbers.get(name) for name in SUMMARY_COLUMNS}


def frame(rows):
    """Return the rows as a table."""
    return tables.frame({name: [_harmless(row[name]) for row in rows] for name in SUMMARY_COLUMNS})


def _harmless(value):
    """Mark a text that a spreadsheet would take for a formula as text; numbers stay as they are."""
    return f"'{value}" if isinstance(value, str) and value.startswith(FORMULA) else value


def rate(row) -> str:
    """Return a row's rate for people."""
    number = row["parts_per_minute"]
    return "no rate" if number is None else f"{number:.3g} / min"


NO_RATE = "; rate is 0"  # what a note ends in where the number says it already


def sheets(store, rows) -> Iterator[Any]:
    """Yield what each contact sheet shows, up to ``TILES`` parts; a sheet without a picture is left out.

    Yields
    ------
    list of (bytes or None, str, str)
        A part's picture, or None, its name, and what is to say of it: its rate, or why it has none.
    """
    for first in range(0, len(rows), TILES):
        tiles = [_tile(store, row) for row in rows[first : first + TILES]]
        if any(picture for picture, *_ in tiles):
            yield tiles


def _tile(store, row) -> tuple[Any, ...]:
    if row["status"] != DONE:
        reason = _reason(row)
    elif row["parts_per_minute"] is None and row.get("note"):
        reason = row["note"]
    else:
        reason = f"{row['orientation'] or '-'}: {rate(row)}"
        if row["parts_per_minute"] == 0.0 and row.get("note"):
            reason += f", {row['note'].removesuffix(NO_RATE)}"
    return store.file(row["folder"], THUMBNAIL), row["folder"], reason


def _reason(row) -> str:
    """Why a part failed, without the path of its file in front."""
    reason = row["reason"] or ""
    place, colon, rest = reason.partition(": ")
    return f"failed: {rest if colon and Path(place.split(':')[0]).name == row['part'] else reason}"


INDEX_FILE, LATER_INDEX_FILE = "index.html", "index_{}.html"
INDEX_ROWS = 200  # parts of one page of the index: what a browser lays out at once
INDEX_HEADINGS = (
    "", "part", "bowl", "mass [g]", "aspects", "leaves on", "velocity [mm/s]", "parts a minute",
    "what to know",
)  # fmt: skip
SUMMARY_LINK_TABLE = Matrix(("all numbers",), ((MarkedCell(SUMMARY_FILE, link=SUMMARY_FILE),),))


def index_pages(store, rows) -> dict[str, Page]:
    """Build the index of a batch by its files: a line a part, with its picture and a link to its folder.

    Pictures stay in the folders of the parts, so a page takes some 400 bytes a part.

    Parameters
    ----------
    store : Store
    rows : sequence of dict
        From ``summary.rows``.

    Returns
    -------
    dict of str to Page
        The first one is INDEX_FILE. Each leads to all others.
    """
    failed = sum(row["status"] != DONE for row in rows)
    text = counted(len(rows), "part") + (f", {failed} of them failed" if failed else "")
    starts = range(0, max(len(rows), 1), INDEX_ROWS)
    files = [
        LATER_INDEX_FILE.format(number) if number > 1 else INDEX_FILE for number in range(1, len(starts) + 1)
    ]
    folders = [row["folder"] for row in rows]
    ends = [f"{folders[k]} to {folders[min(k + INDEX_ROWS, len(rows)) - 1]}" for k in starts] if rows else []
    page_links = [Matrix(("pages",), tuple((MarkedCell(end, link=file),) for file, end in zip(files, ends)))]
    pages: dict[str, Page] = {}
    for file, start in zip(files, starts):
        lines = tuple(_index_row(store, row) for row in rows[start : start + INDEX_ROWS])
        blocks = (
            Matrix(INDEX_HEADINGS, lines, sortable=True),
            *page_links[: len(files) > 1],
            SUMMARY_LINK_TABLE,
        )
        subtitle = f"page {len(pages) + 1} of {len(files)}" if len(files) > 1 else ""
        pages[file] = Page(text, subtitle, (Chapter(blocks),))
    return pages


def _index_row(store, row) -> tuple[Any, ...]:
    remarks = "; ".join(filter(None, (row["reason"], row["note"], row["warnings"])))
    folder = MarkedCell(row["folder"], link=f"{PARTS}/{quote(row['folder'])}/")
    start = (MarkedCell("", picture=_picture(store, row)), folder, MarkedCell(row["config"]))
    if row["status"] != DONE:
        return (*start, MarkedCell("failed", "failed"), *[MarkedCell("")] * 4, MarkedCell(remarks, "failed"))
    leaves = row["orientation"] or "-"
    numbers = [_number(row[name]) for name in ("mass_g", "aspects")]
    rates = [_number(row[name]) for name in ("velocity_mm_s", "parts_per_minute")]
    return (*start, *numbers, MarkedCell(leaves), *rates, MarkedCell(remarks))


def _number(value) -> MarkedCell:
    return MarkedCell("-" if value is None else f"{value:.4g}", "number")


def _picture(store, row) -> Picture | None:
    if row["status"] != DONE or not store.has(row["folder"], THUMBNAIL):
        return None
    text = f"{row['folder']} on aspect {row['aspect'] or 'it rests on most often'}"
    return Picture(THUMBNAIL, b"", text, link=f"{PARTS}/{quote(row['folder'])}/{THUMBNAIL}")
