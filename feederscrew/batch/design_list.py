"""The list of ``feeder design --batch``: parts and the rates wanted of them, and one table of what holds."""

import csv
import io
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from feederscrew import documents, units
from feederscrew.errors import ConfigError, FeederError
from feederscrew.output import tables
from feederscrew.output.tables import Frame

LIST_COLUMNS = ("part", "target", "aspect")
MAX_BYTES = 2_000_000
FAILED = "failed"
DESIGN_COLUMNS = {  # columns of the table, from the document of a design
    "status": "status",
    "wanted": "wanted",
    "delivered_per_minute": "delivered_per_minute",
    "why": "why",
}


@dataclass(frozen=True)
class DesignOrder:
    """One part of the list."""

    source: str
    target: float | None  # [1/s]; None: that of the command line
    aspect: str | None
    line: str  # 'list.csv:3'


def read_orders(path: str) -> tuple[DesignOrder, ...]:
    """Return the parts of a list; their paths count from its folder.

    Parameters
    ----------
    path : str
        A CSV whose first line names columns out of ``LIST_COLUMNS``; lines that begin with # are comments.

    Returns
    -------
    tuple of DesignOrder

    Raises
    ------
    ConfigError
        If it cannot be read, lists no part, or a target is no rate.
    """
    text = documents.decoded(documents.content(path, MAX_BYTES, "a CSV file"), path)
    rows = [
        (number, [cell.strip() for cell in cells])
        for number, cells in enumerate(csv.reader(io.StringIO(text)), 1)
        if "".join(cells).strip() and not cells[0].startswith("#")
    ]
    (first, head), *lines = rows or [(1, [])]
    if "part" not in head or set(head) - set(LIST_COLUMNS):
        raise ConfigError(
            f"{path}:{first}", "is not the head of a list", f"begin with {','.join(LIST_COLUMNS)}"
        )
    if not lines:
        raise ConfigError(path, "lists no part", "write a line a part")
    return tuple(_order(path, number, dict(zip(head, cells))) for number, cells in lines)


def _order(path: str, number: int, row: dict[str, str]) -> DesignOrder:
    where = f"{path}:{number}"
    if not row.get("part"):
        raise ConfigError(where, "names no part", "write its file, or leave the line out")
    try:
        target = units.quantity(row["target"], "rate") if row.get("target") else None
    except ValueError as error:
        raise ConfigError(where, f"target {row['target'][:40]!r} is no rate", "write 40/min") from error
    if target is not None and not target > 0.0:
        raise ConfigError(where, "a target is not above 0", "write 40/min")
    return DesignOrder(str(Path(path).parent / row["part"]), target, row.get("aspect") or None, where)


def row_of(order: DesignOrder, target: float, document: dict[str, Any]) -> dict[str, Any]:
    """Return the row of a design that was made."""
    own = {name: document.get(key) for name, key in DESIGN_COLUMNS.items()}
    return {"part": order.source, "target_per_minute": target / units.PER_MINUTE} | own


def row_of_fault(order: DesignOrder, target: float, fault: FeederError) -> dict[str, Any]:
    """Return the row of a part that could not be designed."""
    return row_of(order, target, {"status": FAILED, "why": str(fault)})


def table(rows: list[dict[str, Any]]) -> Frame:
    """Return what holds, a row a part."""
    return tables.frame({name: [row[name] for row in rows] for name in rows[0]})
