"""One row a part: what the summary, the contact sheets and the index page are made of."""

import csv
import io
from pathlib import Path

from feederscrew.batch.task import DONE, NOT_COMPUTED, THUMBNAIL
from feederscrew.output import tables
from feederscrew.output.batch import ACROSS, DOWN

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


def rows(store, requests, finished=None):
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
        _row(store.record(one.name) if finished is None or one.name in finished else nothing, one)
        for one in requests
    )


def is_partial(text):
    """Return whether the text of a summary is that of a run that was stopped."""
    return any(row.get("status") == NOT_COMPUTED for row in csv.DictReader(io.StringIO(text)))


def _row(record, request):
    known = {
        "part": Path(request.source).name,
        "folder": request.name,
        "config": request.conditions.name,
        "status": record["status"],
        "reason": record["reason"] or None,
        "warnings": "; ".join(record["warnings"]) or None,
    }
    numbers = record["row"] | known
    return {name: numbers.get(name) for name in SUMMARY_COLUMNS}


def frame(rows):
    """Return the rows as a table."""
    return tables.frame({name: [_harmless(row[name]) for row in rows] for name in SUMMARY_COLUMNS})


def _harmless(value):
    """Mark a text that a spreadsheet would take for a formula as text; numbers stay as they are."""
    return f"'{value}" if isinstance(value, str) and value.startswith(FORMULA) else value


def rate(row):
    """Return a row's rate for people."""
    number = row["parts_per_minute"]
    return "no rate" if number is None else f"{number:.3g} / min"


NO_RATE = "; rate is 0"  # what a note ends in where the number says it already


def sheets(store, rows):
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


def _tile(store, row):
    if row["status"] != DONE:
        said = _reason(row)
    elif row["parts_per_minute"] is None and row.get("note"):
        said = row["note"]
    else:
        said = f"{row['orientation'] or '-'}: {rate(row)}"
        if row["parts_per_minute"] == 0.0 and row.get("note"):
            said += f", {row['note'].removesuffix(NO_RATE)}"
    return store.file(row["folder"], THUMBNAIL), row["folder"], said


def _reason(row):
    """Why a part failed, without the path of its file in front."""
    reason = row["reason"] or ""
    place, colon, rest = reason.partition(": ")
    return f"failed: {rest if colon and Path(place.split(':')[0]).name == row['part'] else reason}"
