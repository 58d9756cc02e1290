"""One row a part for summary and contact sheets; and the index, in pages with a line a part."""

from collections import Counter
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING
from urllib.parse import quote

from feederscrew.base.columns import Cells, ColumnHead, Document, Frame, share_head
from feederscrew.base.units import counted
from feederscrew.jobs.batch.task import DONE, NOT_COMPUTED, PARTS, THUMBNAIL, Request
from feederscrew.output.batch import ACROSS, DOWN
from feederscrew.output.page.blocks import Chapter, MarkedCell, Matrix, Page, Picture

if TYPE_CHECKING:
    from feederscrew.jobs.batch.batch_run import Store

SUMMARY_FILE = "summary.csv"
PARTIAL = "summary_partial.csv"  # of a run that was stopped, beside the tables of an earlier one
SUMMARY_COLUMNS = (
    "part",
    "folder",
    "config",
    "status",
    "reason",
    "material",
    "mass_g",
    "aspects",
    "aspect",
    "heading_deg",
    "orientation",
    "rule",
    "answer",
    "p_orientation",
    "passes_devices",
    "velocity_mm_s",
    "regime",
    "pitch_mm",
    "parts_per_minute",
    "parts_per_minute_low",
    "parts_per_minute_high",
    "drops",
    "drop_aspect",
    "p_drop",
    "note",
    "warnings",
)
Rows = tuple[Cells, ...]
SUMMARY_HEADS = {  # of a table for people
    **{name: share_head(name) for name in ("passes_devices",)},
    **{f"p_{name}": share_head(name) for name in ("orientation", "drop")},
    **{name: ColumnHead.of_name(name, unit) for name, unit in {
        "mass_g": "g", "heading_deg": "deg", "velocity_mm_s": "mm/s", "pitch_mm": "mm",
        "parts_per_minute": "1/min", "parts_per_minute_low": "1/min", "parts_per_minute_high": "1/min",
    }.items()},
}  # fmt: skip
FORMULA = ("=", "+", "-", "@", "\t", "\r")
TILES = ACROSS * DOWN
HIDDEN_SUMMARY_COLUMNS = (  # from a table for people; reasons stand above it, a line each
    "reason",
    "folder",
    "aspects",
    "material",
    "aspect",
    "heading_deg",
    "rule",
    "answer",
    "regime",
    "passes_devices",
    "drops",
    "drop_aspect",
    "p_drop",
    "note",
    "warnings",
)
NO_RATE = "; rate is 0"  # what a note ends in where the number says it already
INDEX_FILE = "index.html"
LATER_INDEX_FILE = "index_{}.html"
INDEX_ROWS = 200  # parts of one page of the index: what a browser lays out at once
INDEX_HEADINGS = (
    "",
    "part",
    "bowl",
    "mass [g]",
    "aspects",
    "leaves on",
    "velocity [mm/s]",
    "parts a minute",
    "what to know",
)
SUMMARY_LINK_TABLE = Matrix(("all numbers",), ((MarkedCell(SUMMARY_FILE, link=SUMMARY_FILE),),))


def rows(store: "Store", requests: Sequence[Request], finished: set[str] | None = None) -> Rows:
    """Return what the disk says of each part of a batch.

    Parameters
    ----------
    store : Store
        Of the batch.
    requests : sequence of Request
    finished : set of str, optional
        Folders of parts that are done. What lies in others is of an earlier run and is not read.

    Returns
    -------
    tuple of dict
        By ``SUMMARY_COLUMNS``; None where there is nothing to say.
    """
    rows, titles = [], _titles({request.source for request in requests})
    for request in requests:
        is_done = finished is None or request.name in finished
        record: Document = store.record(request.name) if is_done else {"status": NOT_COMPUTED}
        numbers = record.get("row", {}) | {
            "part": titles[request.source],
            "folder": request.name,
            "config": request.conditions.name,
            "status": record["status"],
            "reason": record.get("reason") or None,
            "warnings": "; ".join(record.get("warnings", ())) or None,
        }
        rows.append({name: numbers.get(name) for name in SUMMARY_COLUMNS})
    return tuple(rows)


def _titles(sources: set[str]) -> dict[str, str]:
    """Return each file's title: its name, and as many folders as tell it from others of that name."""
    titles = {source: Path(source).name for source in sources}
    length = dict.fromkeys(sources, 1)
    while len(several := [name for name, count in Counter(titles.values()).items() if count > 1]):
        longer = [source for source in sources if titles[source] in several]
        for source in longer:
            length[source] += 1
            titles[source] = Path(*Path(source).parts[-length[source] :]).as_posix()
        if all(length[source] > len(Path(source).parts) for source in longer):
            return titles | {source: source for source in longer}
    return titles


def frame(rows: Rows) -> Frame:
    """Return the rows as a table; a text that a spreadsheet would take for a formula is marked as text."""

    def marked(value: object) -> object:
        return f"'{value}" if isinstance(value, str) and value.startswith(FORMULA) else value

    return Frame.of({name: [marked(row[name]) for row in rows] for name in SUMMARY_COLUMNS}, SUMMARY_HEADS)


def sheets(store: "Store", rows: Rows) -> Iterator[list[tuple[bytes | None, str, str]]]:
    """Yield the tiles of each contact sheet, up to ``TILES`` parts.

    Parameters
    ----------
    store : Store
        Of the batch.
    rows : tuple of dict
        From ``rows``.

    Returns
    -------
    iterator of lists of (bytes or None, str, str)
        Of each part its picture, its name, and its rate or why it has none. A sheet without a picture is left
        out.
    """
    for first in range(0, len(rows), TILES):
        tiles = [
            (store.file(row["folder"], THUMBNAIL), row["folder"], _words(row))
            for row in rows[first : first + TILES]
        ]
        if any(picture for picture, *_ in tiles):
            yield tiles


def _words(row: Cells) -> str:
    if row["status"] != DONE:  # without the path of its file in front
        reason = row["reason"] or ""
        place, colon, rest = reason.partition(": ")
        is_path = colon and Path(place.split(":")[0]).name == Path(row["part"]).name
        return f"failed: {rest if is_path else reason}"
    number, note = row["parts_per_minute"], row.get("note")
    if number is None and note:
        return note
    text = f"{row['orientation'] or '-'}: " + ("no rate" if number is None else f"{number:.3g} / min")
    return f"{text}, {note.removesuffix(NO_RATE)}" if number == 0.0 and note else text


def index_pages(store: "Store", rows: Rows) -> dict[str, Page]:
    """Build the index of a batch: a line a part, with its picture and a link to its folder.

    Pictures stay in the folders of the parts, so a page takes some 400 bytes a part.

    Parameters
    ----------
    store : Store
        Of the batch.
    rows : tuple of dict
        From ``rows``.

    Returns
    -------
    dict of str to Page
        By file name, ``INDEX_FILE`` first; each page leads to all others.
    """
    failed = sum(row["status"] != DONE for row in rows)
    text = counted(len(rows), "part") + (f", {failed} of them failed" if failed else "")
    starts = range(0, max(len(rows), 1), INDEX_ROWS)
    links = []
    for k, start in enumerate(starts, 1):
        ends = [rows[n]["folder"] for n in (start, min(start + INDEX_ROWS, len(rows)) - 1)] if rows else []
        file = LATER_INDEX_FILE.format(k) if k > 1 else INDEX_FILE
        links.append((MarkedCell(" to ".join(ends), link=file),))
    page_links = [Matrix(("pages",), tuple(links))] if len(links) > 1 else []
    pages: dict[str, Page] = {}
    for k, ((link,), start) in enumerate(zip(links, starts), 1):
        lines = tuple(_index_row(store, row) for row in rows[start : start + INDEX_ROWS])
        blocks = (Matrix(INDEX_HEADINGS, lines, sortable=True), *page_links, SUMMARY_LINK_TABLE)
        pages[link.link] = Page(text, f"page {k} of {len(links)}" if page_links else "", (Chapter(blocks),))
    return pages


def _index_row(store: "Store", row: Cells) -> tuple[MarkedCell, ...]:
    name, path = row["folder"], f"{PARTS}/{quote(row['folder'])}/"
    remarks = "; ".join(filter(None, (row["reason"], row["note"], row["warnings"])))
    picture = None
    if row["status"] == DONE and (store.parts / name / THUMBNAIL).exists():
        text = f"{name} on aspect {row['aspect'] or 'it rests on most often'}"
        picture = Picture(THUMBNAIL, b"", text, link=f"{path}{THUMBNAIL}")
    start = (MarkedCell("", picture=picture), MarkedCell(name, link=path), MarkedCell(row["config"]))
    if row["status"] != DONE:
        return (*start, MarkedCell("failed", "failed"), *[MarkedCell("")] * 4, MarkedCell(remarks, "failed"))
    mass, aspects, velocity, rate = (
        MarkedCell("-" if row[name] is None else f"{row[name]:.4g}", "number")
        for name in ("mass_g", "aspects", "velocity_mm_s", "parts_per_minute")
    )
    leaves = MarkedCell(row["orientation"] or "-")
    return (*start, mass, aspects, leaves, velocity, rate, MarkedCell(remarks))
