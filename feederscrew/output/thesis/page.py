"""The thesis gone through on one page: what it says, built of blocks that `thesis_page_render` writes out."""

import math
from collections import Counter
from dataclasses import dataclass

from feederscrew.thesis.cells import DIFFERS, EXACT, EXPLAINED, GIVEN
from feederscrew.thesis.claims import Claim
from feederscrew.thesis.findings import BY_ID, FINDINGS
from feederscrew.thesis.reproduction import summary
from feederscrew.thesis.tables import table

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
CHAPTER_4 = "Chapter 4 has no tables, but its data feed chapter 5. What checking them showed:"


@dataclass(frozen=True)
class Heading:
    """A title; level 1 is the page's."""

    level: int
    text: str
    anchor: str = ""


@dataclass(frozen=True)
class Paragraph:
    """Running text."""

    text: str


@dataclass(frozen=True)
class Bullets:
    """Findings, or links to them: (anchor to link to, label, text)."""

    entries: tuple[tuple[str, str, str], ...]


@dataclass(frozen=True)
class Grid:
    """A table: its heads, and rows of (text, verdict); verdict '' for a row's name."""

    heads: tuple[str, ...]
    rows: tuple[tuple[tuple[str, str], ...], ...]


@dataclass(frozen=True)
class Picture:
    """A figure, by the name of its file."""

    file: str
    alt: str


def blocks(items):
    """The whole page.

    Parameters
    ----------
    items : sequence of thesis.reproduction.Item

    Returns
    -------
    list of block
        Heading, Paragraph, Bullets, Grid or Picture.
    """
    by_key = {(item.kind, item.id): item for item in items}
    page = [Heading(1, TITLE), *(Paragraph(text) for text in OPENING), Heading(2, "Summary")]
    page += [Paragraph(_totals(items)), _summary(items)]
    page.append(Heading(2, "Chapter 3: natural resting aspects"))
    for key in ORDER:
        if key == ("figure", "5-1"):
            page += [*_chapter_4(items), Heading(2, "Chapter 5: simulation results")]
        page += _item(by_key[key])
    return [*page, Heading(2, "Findings and errata"), *_errata(items)]


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
    told = digits(entry, entry.explaining)
    return text if told in ("", digits(entry, entry.recomputed)) else f"{text} ({told})"


def digits(entry, value):
    """A number with one digit more than the cell has in print; '' for NaN."""
    decimals = len(entry.published.rpartition(".")[2]) if "." in entry.published else 0
    return "" if math.isnan(value) else f"{value:.{decimals + EXTRA}f}"


def _summary(items):
    heads = ("item", "caption", "cells", "exact", "explained", "differs", "given")
    rows = []
    for item in items:
        counts = summary(item)
        cells = [(str(counts[name]), "") for name in heads[2:]]
        rows.append(((f"{item.kind.capitalize()} {item.id}", ""), (item.caption, ""), *cells))
    return Grid(heads, tuple(rows))


def _totals(items):
    counts = sum((item.counts for item in items), Counter())
    return (
        f"{counts[EXACT]} cells are exact to print, {counts[EXPLAINED]} are explained, "
        f"{counts[DIFFERS]} differ; {counts[GIVEN]} are given."
    )


def _item(item):
    heading = Heading(3, f"{item.kind.capitalize()} {item.id}. {item.caption}", item.stem)
    if item.kind == "figure":
        body = [Picture(f"{item.stem}.png", item.caption), _statements(item)]
    else:
        printed = table(item.id)
        body = [Paragraph(f"Source: {printed.source}. Units: {printed.units}."), _cells(item, printed)]
    return [heading, *body, *_bearing(item.findings)]


def _cells(item, printed):
    """The table as it is laid out in print."""
    found = {(entry.row, entry.column): entry for entry in item.entries}
    rows = []
    for name in dict.fromkeys(entry.row for entry in item.entries):
        cells = [found.get((name, column)) for column in printed.columns]
        rows.append(((name, ""), *[(shown(cell), cell.verdict) if cell else ("", "") for cell in cells]))
    return Grid(("", *printed.columns), tuple(rows))


def _statements(item):
    """What print says of a figure."""
    heads = ("what print states", "in print", "ours", "verdict")
    rows = [
        (
            (claim.statement, ""),
            (claim.published, ""),
            (f"{claim.recomputed:.4g}", ""),
            (claim.verdict, claim.verdict),
        )
        for claim in item.entries
        if isinstance(claim, Claim) and not math.isnan(claim.recomputed)
    ]
    return Grid(heads, tuple(rows))


def _bearing(ids):
    return [Bullets(tuple((id, id, BY_ID[id].what) for id in ids))] if ids else []


def _chapter_4(items):
    """The findings that no table or figure carries."""
    carried = {id for item in items for id in item.findings}
    rest = [finding for finding in FINDINGS if finding.id not in carried or "4." in finding.where]
    return [
        Heading(2, "Chapter 4: inertial data, levers and equations"),
        Paragraph(CHAPTER_4),
        Bullets(tuple((one.id, one.id, f"{one.where}. {one.what} {one.shown}") for one in rest)),
    ]


def _errata(items):
    """Every finding, with its evidence and the items it bears on."""
    for finding in FINDINGS:
        on = [f"{item.kind} {item.id}" for item in items if finding.id in item.findings]
        yield Heading(3, f"{finding.id}: {finding.where}", finding.id)
        bears = f" Bears on {', '.join(on)}." if on else ""
        yield Paragraph(f"{finding.what} {finding.shown}{bears}")


VERDICT_CLASSES = {EXACT: "exact", EXPLAINED: "explained", DIFFERS: "differs", GIVEN: "given", "": ""}
