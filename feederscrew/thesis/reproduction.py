"""Each table and figure of the thesis with its cells, verdicts and findings: as files and as one page."""

import inspect
import math
from collections import Counter
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from feederscrew.base.columns import Document, Frame, of_records
from feederscrew.base.errors import ArgumentError
from feederscrew.base.records import ReadableRecord
from feederscrew.base.units import listed
from feederscrew.output import style
from feederscrew.output.page.as_html import html
from feederscrew.output.page.as_markdown import markdown
from feederscrew.output.page.blocks import Chapter, Heading, Links, MarkedCell, Matrix, Page, Picture, Text
from feederscrew.output.tables import data_frame, text
from feederscrew.thesis import figures
from feederscrew.thesis.figures import FIGURE_OF, THESIS_FIGURES, Claim
from feederscrew.thesis.findings import FINDING_COLUMNS, FINDING_OF, FINDINGS
from feederscrew.thesis.parts import cells
from feederscrew.thesis.recommendations import RECOMMENDATION_COLUMNS, recommendations
from feederscrew.thesis.tables import DIFFERS, EXACT_TO_PRINT, EXPLAINED, NOT_CHECKED, TABLES, Cell, table

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from feederscrew.base.records import DataFrame
    from feederscrew.base.records import Figure as DrawnFigure

BEARS_ON = {  # findings that no single cell carries
    "table 3-1": ("drawings-lost",),
    "table 3-2": ("q-unit", "arc-chute-heights", "h-total", "drawings-lost"),
    "table 3-3": ("arc-chute-heights", "drawings-lost"),
    "table 3-5": ("q-unit", "magnet-heights", "drawings-lost"),
    "table 3-6": ("magnet-heights", "drawings-lost"),
    "table 3-8": ("t-shape-drawing", "t-shape-density", "pmi-class-once", "pmi-equation"),
    "table 3-9": ("pmi-class-once",),
    "table 3-10": ("arc-chute-heights", "drawings-lost"),
    "table 3-11": ("magnet-heights", "drawings-lost"),
    "figure 3-6": ("figure-references",),
    "figure 3-7": ("figure-references",),
    "figure 3-8": ("drawings-lost", "csa-ratio"),
}
LOST_DRAWINGS = {  # drawings of which nothing survives but what other numbers give: no item has them
    "3-1": "Axes of the T shape",
    "3-2": "Resting aspects of the T shape",
    "3-3": "Dimensions of the T shape",
    "3-4": "Resting aspects of the Arc Chute",
    "3-5": "Resting aspects of the Magnet",
}
CONCLUSIONS = {  # of chapter 6, and what bears on each
    "1": ("conclusion-1", "dominant-aspect"),
    "2": ("conclusion-2", "csa-ratio"),
    "3": ("conclusion-2",),
    "4": ("conclusion-4",),
    "5": ("conclusion-5", "wall-pulls"),
    "6": ("beta-sliding",),
    "7": ("hop",),
    "8": ("conclusion-8",),
}
MARK_OF = {EXACT_TO_PRINT: "exact", EXPLAINED: "explained", DIFFERS: "differs", NOT_CHECKED: "given"}
COUNTS = ("cells", "exact", "explained", "differs", "given")
CELL_COLUMNS = ("row", "column", "published", "recomputed", "deviation", "verdict", "explaining", "finding")
CLAIM_COLUMNS = ("statement", "published", "recomputed", "verdict", "finding")
ORDER_OF_THESIS = (
    *[f"table 3-{n}" for n in range(1, 12)],
    *[f"figure 3-{n}" for n in range(6, 14)],
    *["table 3-12", "table 3-13"],
    *[f"figure 5-{n}" for n in range(1, 8)],
)
PAGE_OPENING = (
    "Every table and figure of chapters 3 and 5 of A Screw Theory Approach to Analyze the Dynamics of Parts "
    "in a Vibratory Bowl Feeder, computed again: the T shape from its solid, the Arc Chute and the Magnet "
    "from their own printed columns, chapter 5 from its equations. Where print and computation part, a "
    "finding says why; the last section lists them all.",
    "A cell in plain type is exact to print: our number gives the printed digits. A cell with an arrow is "
    "explained: print → ours, and in brackets what a finding below the table makes of it. A cell in italics "
    "is given: measured, or read off a drawing that is lost. A cell marked DIFFERS has no explanation.",
)


@dataclass(frozen=True)
class Item:
    """One table or figure."""

    id: str  # '3-9'
    kind: str  # 'table' or 'figure'
    caption: str
    entries: tuple[Cell | Claim, ...]

    @property
    def name(self) -> str:
        """Return the name for people, kind and number: 'table 3-9'."""
        return f"{self.kind} {self.id}"

    @property
    def stem(self) -> str:
        """Return the stem of the names of its files: 'table_3_09'."""
        chapter, number = self.id.split("-")
        return f"{self.kind}_{chapter}_{int(number):02d}"

    @property
    def verdicts(self) -> Counter[str]:
        """Number of entries by verdict."""
        return Counter(entry.verdict for entry in self.entries)

    @property
    def counts(self) -> dict[str, int]:
        """Cells that can be checked, by verdict, and those that are data."""
        counts = self.verdicts
        return {"cells": len(self.entries) - counts[NOT_CHECKED]} | {
            mark: counts[verdict] for verdict, mark in MARK_OF.items()
        }

    @property
    def findings(self) -> tuple[str, ...]:
        """Ids of the findings that bear on it, each once."""
        # where it explains, and where an exact cell needed its reading of the table
        carried = [
            entry.finding
            for entry in self.entries
            if entry.verdict == EXPLAINED
            or (entry.finding and (isinstance(entry, Claim) or entry.cut or entry.finding[:2] == "t-"))
        ]
        return tuple(dict.fromkeys((*carried, *BEARS_ON.get(self.name, ()))))


@dataclass(frozen=True, eq=False)
class Reproduction(ReadableRecord):
    """Every table of the thesis, then every figure."""

    items: tuple[Item, ...]

    def to_frame(self, name: str | None = None) -> "DataFrame":
        """Return a table: each item's cells by verdict, or the cells of '3-9'."""
        if name is None:
            return data_frame(overview(self.items))
        item_of = {item.id: item for item in self.items}
        _require(name, item_of, "table or figure")
        return data_frame(entries(item_of[name]))

    def plot(self, name: str | None = None, ax: "Axes | None" = None) -> "DrawnFigure":
        """Return a figure of the thesis as ``ReadableRecord.plot``: the first, or '5-6'."""
        name = THESIS_FIGURES[0].number if name is None else name
        _require(name, FIGURE_OF, "figure")
        draws = inspect.signature(FIGURE_OF[name].draw_data).parameters
        if ax is not None and "ax" not in draws:
            raise ArgumentError("ax", f"figure {name} has several pictures", "leave `ax` out")
        return figures.draw(FIGURE_OF[name], ax)


def reproduce() -> Reproduction:
    """Compute every table and every figure of the thesis again, and compare each cell with what it prints.

    Returns
    -------
    Reproduction
        An item for each table, then for each figure; ``to_frame("3-9")`` is a table with its verdicts.
    """
    tables = [Item(number, "table", table(number).caption, cells(number)) for number in TABLES]
    drawn = [Item(figure.number, "figure", figure.caption, figure.claims) for figure in THESIS_FIGURES]
    return Reproduction((*tables, *drawn))


def unexplained_items(items: Sequence[Item]) -> list[Item]:
    """Return the items with a cell that differs and no finding that says why."""
    return [item for item in items if item.verdicts[DIFFERS]]


def overview(items: Sequence[Item]) -> Frame:
    """Return one row an item: its cells by verdict; then lost drawings, conclusions and recommendations."""
    without_cells: dict[str, tuple[str, ...]] = {
        f"figure {number}": ("drawings-lost",) for number in LOST_DRAWINGS
    }
    without_cells |= {f"conclusion {number}": ids for number, ids in CONCLUSIONS.items()}
    advice = {f"recommendation {each.number}": each.title for each in recommendations()}
    others = [*without_cells, *advice]
    columns: dict[str, list] = {"item": [item.name for item in items] + others}
    columns |= {name: [item.counts[name] for item in items] + [0] * len(others) for name in COUNTS}
    ids = [item.findings for item in items] + list(without_cells.values())
    titles = ["; ".join(FINDING_OF[id].title for id in each) for each in ids]
    return Frame.of(columns | {"findings": titles + list(advice.values())})


def entries(item: Item) -> Frame:
    """Return the cells of a table, or what print states on a figure, with ours, verdict and finding."""
    columns = CELL_COLUMNS if item.kind == "table" else CLAIM_COLUMNS
    rows: dict[str, list] = {name: [getattr(entry, name) for entry in item.entries] for name in columns}
    if item.kind == "table":
        for name in ("recomputed", "explaining"):
            rows[name] = [_digits(entry.published, value) for entry, value in zip(item.entries, rows[name])]
    return Frame.of(rows)


def document(items: Sequence[Item], files: Mapping[str, Sequence[str]]) -> Document:
    """Return the items of the thesis as one JSON document.

    Parameters
    ----------
    items : sequence of Item
    files : mapping of str to sequence of str
        Files that were written, by the item's stem.

    Returns
    -------
    dict
        Items, lost drawings, conclusions, recommendations and findings.
    """
    return {
        "items": [
            {
                "id": item.id,
                "kind": item.kind,
                "caption": item.caption,
                **item.counts,
                "findings": item.findings,
                "files": files.get(item.stem, []),
            }
            for item in items
        ],
        "lost": [{"id": number, "kind": "figure", "caption": text} for number, text in LOST_DRAWINGS.items()],
        "conclusions": [{"id": f"conclusion {n}", "findings": ids} for n, ids in CONCLUSIONS.items()],
        "recommendations": of_records(RECOMMENDATION_COLUMNS, recommendations()),
        "findings": _findings(),
    }


def _findings() -> Frame:
    return of_records(FINDING_COLUMNS, FINDINGS)


def write(save: Callable[[str, str | bytes], object], items: Sequence[Item]) -> dict[str, list[str]]:
    """Write tables, pictures and the page of the thesis.

    Parameters
    ----------
    save : callable
        Called with the name and the content of each file.
    items : sequence of Item

    Returns
    -------
    dict of str to list of str
        Files of tables and figures, by the item's stem.
    """
    files, pictures = {}, {}
    for item in items:
        files[item.stem] = [f"{item.stem}.csv"]
        if item.kind == "table":
            save(f"{item.stem}.csv", text(entries(item), "csv"))
            continue
        figure = FIGURE_OF[item.id]
        pictures[f"{item.stem}.png"] = style.png(figures.draw(figure))
        files[item.stem] += [f"{item.stem}.png", f"{item.stem}_statements.csv"]
        save(f"{item.stem}.csv", text(figures.numbers(figure), "csv"))
        save(f"{item.stem}_statements.csv", text(entries(item), "csv"))
    for name, content in pictures.items():
        save(name, content)
    whole = page(items, pictures)
    save("thesis.md", markdown(whole))
    save("thesis.html", html(whole))
    save("summary.csv", text(overview(items), "csv"))
    save("findings.csv", text(_findings(), "csv"))
    return files


def page(items: Sequence[Item], pictures: Mapping[str, bytes]) -> Page:
    """Build the page of the whole thesis.

    Parameters
    ----------
    items : sequence of Item
    pictures : mapping of str to bytes
        PNG of each figure, by file name.

    Returns
    -------
    Page
    """
    item_of = {item.name: item for item in items}
    counts: Counter[str] = sum((item.verdicts for item in items), Counter())
    totals = (
        f"{counts[EXACT_TO_PRINT]} cells are exact to print, {counts[EXPLAINED]} are explained, "
        f"{counts[DIFFERS]} differ; {counts[NOT_CHECKED]} are given."
    )
    summary = tuple(
        (
            MarkedCell(item.name.capitalize()),
            MarkedCell(item.caption),
            *[MarkedCell(str(item.counts[name]), "number") for name in COUNTS],
        )
        for item in items
    )
    chapters = {n: [name for name in ORDER_OF_THESIS if f" {n}-" in name] for n in "35"}
    third, fifth = (
        tuple(block for name in names for block in _blocks(item_of[name], pictures))
        for names in chapters.values()
    )
    carried = {id for item in items for id in item.findings}
    fourth = tuple(  # what no table or figure carries
        (each.id, each.title, f"{each.where}. {each.what} {each.evidence}")
        for each in FINDINGS
        if (each.id not in carried or "4." in each.where) and not each.id.startswith("conclusion-")
    )
    conclusions = tuple(
        (MarkedCell(number), MarkedCell("; ".join(FINDING_OF[id].what for id in ids)))
        for number, ids in CONCLUSIONS.items()
    )
    advice = tuple(
        (MarkedCell(each.what), MarkedCell(each.met), MarkedCell(each.lacks)) for each in recommendations()
    )
    errata: list[Heading | Text] = []  # each finding, with its evidence and the items it bears on
    for finding in FINDINGS:
        names = [item.name for item in items if finding.id in item.findings]
        bears = f" Bears on {', '.join(names)}." if names else ""
        errata += [
            Heading(f"{finding.title[:1].upper()}{finding.title[1:]}: {finding.where}", finding.id),
            Text(f"{finding.what} {finding.evidence}{bears}"),
        ]
    sections = (
        ("summary", "Summary", (Text(totals), Matrix(("item", "caption", *COUNTS), summary))),
        ("chapter-3", "Chapter 3: natural resting aspects", third),
        (
            "chapter-4",
            "Chapters 2 and 4: screws, inertial data, levers and equations",
            (
                Text(
                    "Chapters 2 and 4 have no tables, but their equations and data feed chapter 5. "
                    "What checking them showed:"
                ),
                Links(fourth),
            ),
        ),
        ("chapter-5", "Chapter 5: simulation results", fifth),
        (
            "chapter-6",
            "Chapter 6.1: conclusions",
            (Matrix(("conclusion", "what checking it showed"), conclusions),),
        ),
        (
            "chapter-6-2",
            "Chapter 6.2: recommendations",
            (Matrix(("recommendation", "where it is met", "what is not"), advice),),
        ),
        ("findings", "Findings and errata", tuple(errata)),
    )
    return Page(
        "The thesis, number by number",
        "",
        (
            Chapter(tuple(Text(paragraph) for paragraph in PAGE_OPENING)),
            *(Chapter(blocks, anchor=anchor, title=title) for anchor, title, blocks in sections),
        ),
    )


def print_and_ours(entry: Cell) -> str:
    """Return print and ours in one cell, as the page's opening describes."""
    if entry.verdict in (EXACT_TO_PRINT, NOT_CHECKED):
        return entry.published
    ours, result = (_digits(entry.published, value) for value in (entry.recomputed, entry.explaining))
    if entry.verdict == DIFFERS:
        return f"{entry.published} → {ours} DIFFERS"
    return f"{entry.published} → {ours}" + ("" if result in ("", ours) else f" ({result})")


def _digits(published: str, value: float) -> str:
    """A number with one digit more than print has; '' for NaN."""
    decimals = len(published.rpartition(".")[2]) if "." in published else 0
    return "" if math.isnan(value) else f"{value:.{decimals + 1}f}"


def _blocks(item: Item, pictures: Mapping[str, bytes]) -> list:
    """A table as it is laid out in print, its cells marked by their verdicts; of a figure what print says."""
    blocks: list = [Heading(f"{item.name.capitalize()}. {item.caption}", item.stem)]
    if item.kind == "figure":
        statements = tuple(
            (
                MarkedCell(claim.statement),
                MarkedCell(claim.published),
                MarkedCell(f"{claim.recomputed:.4g}"),
                MarkedCell(claim.verdict, MARK_OF[claim.verdict]),
            )
            for claim in item.entries
            if isinstance(claim, Claim) and not math.isnan(claim.recomputed)
        )
        file = f"{item.stem}.png"
        matrix = Matrix(("what print states", "in print", "ours", "verdict"), statements)
        blocks += [Picture(file, pictures[file], item.caption), matrix]
    else:
        printed = table(item.id)
        cell_at = {(cell.row, cell.column): cell for cell in item.entries if isinstance(cell, Cell)}
        rows = tuple(
            (
                MarkedCell(name),
                *(
                    MarkedCell(print_and_ours(cell), MARK_OF[cell.verdict]) if cell else MarkedCell("")
                    for cell in (cell_at.get((name, column)) for column in printed.columns)
                ),
            )
            for name in dict.fromkeys(row for row, _ in cell_at)
        )
        source = Text(f"Source: {printed.source}. Units: {printed.units}.")
        blocks += [source, Matrix(("", *printed.columns), rows)]
    if item.findings:
        blocks.append(Links(tuple((id, FINDING_OF[id].title, FINDING_OF[id].what) for id in item.findings)))
    return blocks


def _require(name: str, choices: Collection[str], noun: str) -> None:
    if name not in choices:
        raise ArgumentError("name", f"there is no {noun} {name!r}", f"give one of {listed(list(choices))}")
