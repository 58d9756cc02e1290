"""One page over the whole batch, complete in itself: it opens without a network and moves with its folder."""

import base64
from html import escape
from urllib.parse import quote

from feederscrew.batch import summary
from feederscrew.batch.store import PARTS
from feederscrew.batch.task import DONE
from feederscrew.batch.work import THUMBNAIL

NAME = "index.html"
HEADINGS = (
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
STYLE = """
body { font: 15px/1.4 system-ui, sans-serif; color: #22303c; margin: 2rem; }
table { border-collapse: collapse; }
th, td { text-align: left; padding: .3rem .8rem; border-bottom: 1px solid #d5dbe1; }
td.number { text-align: right; font-variant-numeric: tabular-nums; }
tr.failed td { color: #a33c00; }
img { width: 120px; display: block; }
@media print { body { margin: 0; font-size: 9pt; } tr { break-inside: avoid; } }
"""


def html(store, rows):
    """The page.

    Parameters
    ----------
    store : Store
    rows : sequence of dict
        From ``summary.rows``.

    Returns
    -------
    str
    """
    failed = sum(row["status"] != DONE for row in rows)
    told = f"{len(rows)} parts" + (f", {failed} of them failed" if failed else "")
    head = "".join(f"<th>{heading}</th>" for heading in HEADINGS)
    body = "\n".join(_row(store, row) for row in rows)
    return (
        f'<!DOCTYPE html>\n<html lang="en">\n<head><meta charset="utf-8"><title>{told}</title>\n'
        f"<style>{STYLE}</style></head>\n<body>\n<h1>{told}</h1>\n"
        f'<p>All numbers: <a href="{summary.NAME}">{summary.NAME}</a></p>\n'
        f"<table>\n<thead><tr>{head}</tr></thead>\n<tbody>\n{body}\n</tbody>\n</table>\n</body>\n</html>\n"
    )


def _row(store, row):
    link = f'<a href="{PARTS}/{quote(row["folder"])}/">{escape(row["folder"])}</a>'
    said = escape("; ".join(filter(None, (row["reason"], row["note"], row["warnings"]))))
    start = f"<td>{_picture(store, row)}</td><td>{link}</td><td>{escape(row['config'])}</td>"
    if row["status"] != DONE:
        return f'<tr class="failed">{start}<td colspan="5">failed</td><td>{said}</td></tr>'
    leaves = f"{row['aspect']} at {row['heading_deg']:.4g}&deg;" if row["aspect"] else "-"
    cells = (row["mass_g"], row["aspects"], leaves, row["velocity_mm_s"], row["parts_per_minute"])
    return f"<tr>{start}{''.join(map(_cell, cells))}<td>{said}</td></tr>"


def _cell(value):
    if isinstance(value, str):
        return f"<td>{value}</td>"
    return f'<td class="number">{"-" if value is None else f"{value:.4g}"}</td>'


def _picture(store, row):
    picture = store.file(row["folder"], THUMBNAIL) if row["status"] == DONE else None
    if picture is None:
        return ""
    data = base64.b64encode(picture).decode()
    return f'<img src="data:image/png;base64,{data}" alt="{escape(row["folder"])} on aspect A">'
