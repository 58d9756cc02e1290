"""The thesis gone through on one page."""

import math
from collections import Counter

from feederscrew.output.page.blocks import Chapter, Heading, Links, MarkedCell, Matrix, Page, Picture, Text
from feederscrew.thesis.claims import Claim
from feederscrew.thesis.findings import BY_ID, FINDINGS
from feederscrew.thesis.printed_cells import DIFFERS, EXACT, EXPLAINED, GIVEN
from feederscrew.thesis.printed_tables import table
from feederscrew.thesis.reproduction import summary

MARKS = {EXACT: "exact", EXPLAINED: "explained", DIFFERS: "differs", GIVEN: "given"}  # of a cell, by verdict
EXTRA = 1  # digits shown beyond the printed ones
ORDER = [  # of the thesis: tables and figures as they follow each other
    *[("table", f"3-{n}") for n in range(1, 12)],
    *[("figure", f"3-{n}") for n in range(6, 14)],
    ("table", "3-12"),
    ("table", "3-13"),
    *[("figure", f"5-{n}") for n in range(1, 8)],
]
TITLE = "The thesis, number by number"
OPENING = (
    "Every table and figure of chapters 3 and 5 of A Screw Theory Approach to Analyze the Dynamics of Parts "
    "in a Vibratory Bowl Feeder, computed again: the T shape from its solid, the Arc Chute and the Magnet "
    "from their own printed columns, chapter 5 from its equations. Where print and computation part, a "
    "finding says why; the last section lists them all.",
    "A cell in plain type is exact to print: our number gives the printed digits. A cell with an arrow is "
    "explained: print → ours, and in brackets what a finding below the table makes of it. A cell in italics "
    "is given: measured, or read off a drawing that is lost. A cell marked DIFFERS has no explanation.",
)
CHAPTER_4_TITLE = "Chapter 4: inertial data, levers and equations"
CHAPTER_4 = "Chapter 4 has no tables, but its data feed chapter 5. What checking them showed:"


def page(items, pictures):
    """Build the page of the whole thesis.

    Parameters
    ----------
    items : sequence of thesis.reproduction.Item
    pictures : dict of str to bytes
        PNG of each figure, by file name.

    Returns
    -------
    Page
    """
    by_key = {(item.kind, item.id): item for item in items}
    shown = {key: _item(by_key[key], pictures) for key in ORDER}
    third, fifth = ([b for key in ORDER if key[1][0] == n for b in shown[key]] for n in "35")
    return Page(
        TITLE,
        "",
        (
            Chapter(tuple(Text(text) for text in OPENING)),
            Chapter((Text(_totals(items)), _summary(items)), anchor="summary", title="Summary"),
            Chapter(tuple(third), anchor="chapter-3", title="Chapter 3: natural resting aspects"),
            Chapter(_chapter_4(items), anchor="chapter-4", title=CHAPTER_4_TITLE),
            Chapter(tuple(fifth), anchor="chapter-5", title="Chapter 5: simulation results"),
            Chapter(tuple(_errata(items)), anchor="findings", title="Findings and errata"),
        ),
    )


def shown(entry):
    """Print and ours in one cell, as the page's opening describes.

    Parameters
    ----------
    entry : Cell

    Returns
    -------
    str
    """
    if entry.verdict in (EXACT, GIVEN):
        return entry.published
    text = f"{entry.published} → {digits(entry, entry.recomputed)}"
    if entry.verdict == DIFFERS:
        return f"{text} DIFFERS"
    result = digits(entry, entry.explaining)
    return text if result in ("", digits(entry, entry.recomputed)) else f"{text} ({result})"


def digits(entry, value):
    """Return a number with one digit more than the cell has in print; '' for NaN."""
    decimals = len(entry.published.rpartition(".")[2]) if "." in entry.published else 0
    return "" if math.isnan(value) else f"{value:.{decimals + EXTRA}f}"


def _summary(items):
    heads = ("item", "caption", "cells", "exact", "explained", "differs", "given")
    rows = []
    for item in items:
        counts = summary(item)
        cells = [MarkedCell(str(counts[name]), "number") for name in heads[2:]]
        rows.append((MarkedCell(f"{item.kind.capitalize()} {item.id}"), MarkedCell(item.caption), *cells))
    return Matrix(heads, tuple(rows))


def _totals(items):
    counts: Counter[str] = sum((item.counts for item in items), Counter())
    return (
        f"{counts[EXACT]} cells are exact to print, {counts[EXPLAINED]} are explained, "
        f"{counts[DIFFERS]} differ; {counts[GIVEN]} are given."
    )


def _item(item, pictures):
    heading = Heading(f"{item.kind.capitalize()} {item.id}. {item.caption}", item.stem)
    if item.kind == "figure":
        file = f"{item.stem}.png"
        body = [Picture(file, pictures[file], item.caption), _statements(item)]
    else:
        printed = table(item.id)
        body = [Text(f"Source: {printed.source}. Units: {printed.units}."), _cells(item, printed)]
    return [heading, *body, *_bearing(item.findings)]


def _cells(item, printed):
    """The table as it is laid out in print."""
    found = {(entry.row, entry.column): entry for entry in item.entries}
    rows = []
    for name in dict.fromkeys(entry.row for entry in item.entries):
        cells = [found.get((name, column)) for column in printed.columns]
        rows.append(
            (
                MarkedCell(name),
                *[_marked(shown(cell), cell.verdict) if cell else MarkedCell("") for cell in cells],
            )
        )
    return Matrix(("", *printed.columns), tuple(rows))


def _marked(text, verdict):
    return MarkedCell(text, MARKS[verdict])


def _statements(item):
    """What print says of a figure."""
    heads = ("what print states", "in print", "ours", "verdict")
    rows = [
        (
            MarkedCell(claim.statement),
            MarkedCell(claim.published),
            MarkedCell(f"{claim.recomputed:.4g}"),
            _marked(claim.verdict, claim.verdict),
        )
        for claim in item.entries
        if isinstance(claim, Claim) and not math.isnan(claim.recomputed)
    ]
    return Matrix(heads, tuple(rows))


def _bearing(ids):
    return [Links(tuple((id, id, BY_ID[id].what) for id in ids))] if ids else []


def _chapter_4(items):
    """The findings that no table or figure carries."""
    carried = {id for item in items for id in item.findings}
    rest = [finding for finding in FINDINGS if finding.id not in carried or "4." in finding.where]
    listed = tuple((one.id, one.id, f"{one.where}. {one.what} {one.shown}") for one in rest)
    return Text(CHAPTER_4), Links(listed)


def _errata(items):
    """Every finding, with its evidence and the items it bears on."""
    for finding in FINDINGS:
        on = [f"{item.kind} {item.id}" for item in items if finding.id in item.findings]
        yield Heading(f"{finding.id}: {finding.where}", finding.id)
        bears = f" Bears on {', '.join(on)}." if on else ""
        yield Text(f"{finding.what} {finding.shown}{bears}")
