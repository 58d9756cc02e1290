"""One page over the whole batch, complete in itself: it opens without a network and moves with its folder."""

from urllib.parse import quote

from feederscrew.batch import summary
from feederscrew.batch.store import PARTS
from feederscrew.batch.task import DONE, THUMBNAIL
from feederscrew.output.page.blocks import Chapter, MarkedCell, Matrix, Page, Picture
from feederscrew.units import counted

INDEX_FILE = "index.html"
INDEX_HEADINGS = (
    "", "part", "bowl", "mass [g]", "aspects", "leaves on", "velocity [mm/s]", "parts a minute",
    "what to know",
)  # fmt: skip
SUMMARY_LINK_TABLE = Matrix(
    ("all numbers",), ((MarkedCell(summary.SUMMARY_FILE, link=summary.SUMMARY_FILE),),)
)


def page(store, rows):
    """Build the page of a batch: a line a part, with its picture and a link to its folder.

    Parameters
    ----------
    store : Store
    rows : sequence of dict
        From ``summary.rows``.

    Returns
    -------
    Page
    """
    failed = sum(row["status"] != DONE for row in rows)
    text = counted(len(rows), "part") + (f", {failed} of them failed" if failed else "")
    lines = tuple(_row(store, row) for row in rows)
    return Page(text, "", (Chapter((Matrix(INDEX_HEADINGS, lines, sortable=True), SUMMARY_LINK_TABLE)),))


def _row(store, row):
    said = "; ".join(filter(None, (row["reason"], row["note"], row["warnings"])))
    folder = MarkedCell(row["folder"], link=f"{PARTS}/{quote(row['folder'])}/")
    start = (MarkedCell("", picture=_picture(store, row)), folder, MarkedCell(row["config"]))
    if row["status"] != DONE:
        return (*start, MarkedCell("failed", "failed"), *[MarkedCell("")] * 4, MarkedCell(said, "failed"))
    leaves = row["orientation"] or "-"
    numbers = [_number(row[name]) for name in ("mass_g", "aspects")]
    rates = [_number(row[name]) for name in ("velocity_mm_s", "parts_per_minute")]
    return (*start, *numbers, MarkedCell(leaves), *rates, MarkedCell(said))


def _number(value):
    return MarkedCell("-" if value is None else f"{value:.4g}", "number")


def _picture(store, row):
    content = store.file(row["folder"], THUMBNAIL) if row["status"] == DONE else None
    return (
        None
        if content is None
        else Picture(
            THUMBNAIL, content, f"{row['folder']} on aspect {row['aspect'] or 'it rests on most often'}"
        )
    )
