"""The thesis gone through: each table and figure with its cells, verdicts and findings."""

from collections import Counter
from dataclasses import dataclass

from feederscrew.thesis.claims import Claim, claims
from feederscrew.thesis.figure_data import FIGURES
from feederscrew.thesis.printed_cells import DIFFERS, EXACT, EXPLAINED, GIVEN, Cell
from feederscrew.thesis.printed_tables import NUMBERS, table
from feederscrew.thesis.recompute import cells

BEARS_ON = {  # findings that no single cell carries
    ("table", "3-1"): ("drawings-lost",),
    ("table", "3-2"): ("q-unit", "arc-chute-heights", "h-total", "drawings-lost"),
    ("table", "3-3"): ("arc-chute-heights", "drawings-lost"),
    ("table", "3-5"): ("q-unit", "magnet-heights", "drawings-lost"),
    ("table", "3-6"): ("magnet-heights", "drawings-lost"),
    ("table", "3-8"): ("t-shape-drawing", "t-shape-density", "pmi-class-once", "pmi-equation"),
    ("table", "3-9"): ("pmi-class-once",),
    ("table", "3-10"): ("arc-chute-heights", "drawings-lost"),
    ("table", "3-11"): ("magnet-heights", "drawings-lost"),
    ("figure", "3-6"): ("figure-references",),
    ("figure", "3-7"): ("figure-references",),
    ("figure", "3-8"): ("drawings-lost", "csa-ratio"),
}


@dataclass(frozen=True)
class Item:
    """One table or figure."""

    id: str  # '3-9'
    kind: str  # 'table' or 'figure'
    caption: str
    entries: tuple[Cell | Claim, ...]

    @property
    def counts(self):
        """Entries by verdict."""
        return Counter(entry.verdict for entry in self.entries)

    @property
    def findings(self):
        """Ids of the findings that bear on it, each once."""
        carried = [entry.finding for entry in self.entries if entry.finding and _bears(entry)]
        return tuple(dict.fromkeys((*carried, *BEARS_ON.get((self.kind, self.id), ()))))

    @property
    def stem(self):
        """Of its files: 'table_3_09'."""
        chapter, number = self.id.split("-")
        return f"{self.kind}_{chapter}_{int(number):02d}"


def items():
    """Return every table, then every figure.

    Returns
    -------
    tuple of Item
    """
    tables = [Item(number, "table", table(number).caption, cells(number)) for number in NUMBERS]
    drawn = [Item(figure.number, "figure", figure.caption, claims(figure.number)) for figure in FIGURES]
    return (*tables, *drawn)


def summary(item):
    """Return numbers of one item: cells that can be checked, by verdict, and those that are data."""
    counts = item.counts
    checked = {"exact": counts[EXACT], "explained": counts[EXPLAINED], "differs": counts[DIFFERS]}
    return {"cells": sum(checked.values()), **checked, "given": counts[GIVEN]}


def unexplained(items):
    """Return the items with a cell that differs and no finding that says why."""
    return [item for item in items if item.counts[DIFFERS]]


def _bears(entry):
    """A finding matters where it explains, and where an exact cell needed its reading of the table."""
    return (
        entry.verdict == EXPLAINED
        or not isinstance(entry, Cell)
        or entry.cut
        or entry.finding.startswith("t-")
    )
