"""The thesis computed again as one record, with its tables and its figures."""

from collections.abc import Collection
from dataclasses import dataclass
from typing import TYPE_CHECKING

from feederscrew.errors import ArgumentError
from feederscrew.output.tables import data_frame
from feederscrew.records import Shown
from feederscrew.thesis.pages import figures, files
from feederscrew.thesis.pages.files import BY_NUMBER
from feederscrew.thesis.reproduction import Item, items
from feederscrew.units import listed

if TYPE_CHECKING:
    from feederscrew.records import DataFrame, Figure


@dataclass(frozen=True, eq=False)
class Reproduction(Shown):
    """Every table of the thesis, then every figure."""

    items: tuple[Item, ...]

    def to_frame(self, name: str | None = None) -> "DataFrame":
        """Return a table as ``Shown.to_frame``: each item's cells by verdict, or the cells of '3-9'."""
        if name is None:
            return data_frame(files.overview(self.items))
        of = {item.id: item for item in self.items}
        _known(name, of, "table or figure")
        return data_frame((files.cells if of[name].kind == "table" else files.statements)(of[name]))

    def plot(self, name: str | None = None) -> "Figure":
        """Return a figure of the thesis as ``Shown.plot``: the first, or '5-6'."""
        name = next(iter(BY_NUMBER)) if name is None else name
        _known(name, BY_NUMBER, "figure")
        return figures.drawn(BY_NUMBER[name])


def reproduced() -> Reproduction:
    """Compute every table and figure again.

    Returns
    -------
    Reproduction
    """
    return Reproduction(items())


def _known(name: str, of: Collection[str], what: str) -> None:
    if name not in of:
        raise ArgumentError("name", f"there is no {what} {name!r}", f"give one of {listed(list(of))}")
