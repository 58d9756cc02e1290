"""Grids over two quantities: values, regime codes, NaN where there is no answer."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from feederscrew.base import check
from feederscrew.base.arrays import Array, Floats, Ints
from feederscrew.base.columns import ColumnHead

GridFunction = Callable[[Floats, Floats], dict[str, Array]]


@dataclass(frozen=True, eq=False)
class GridAxis:
    """One quantity of a grid and the values it takes."""

    column: str  # in tables, with its unit: 'beta_deg'
    values: Floats  # (N,) in SI
    unit: float = 1.0  # SI units in one unit of the column
    label: str = ""  # of that unit: 'deg'

    @property
    def head(self) -> ColumnHead:
        """Return what people read above the column, or along an axis of a picture."""
        return ColumnHead.of_name(self.column, self.label)

    @property
    def in_unit(self) -> Floats:
        """Return the values in the column's unit, (N,)."""
        return self.values / self.unit


@dataclass(frozen=True, eq=False)
class Grid:
    """Values at every pair of two axes, the first along axis 0."""

    first: GridAxis
    second: GridAxis
    values: dict[str, Array]  # (N1, N2) by column name
    codes: Ints  # (N1, N2) places in ``names``
    names: tuple[str, ...]  # of the regimes

    def columns(self) -> dict[str, Array]:
        """Return the cells as columns of a table, the second axis running fastest."""
        first, second = np.meshgrid(self.first.in_unit, self.second.in_unit, indexing="ij")
        return {
            self.first.column: first.ravel(),
            self.second.column: second.ravel(),
            **{name: array.ravel() for name, array in self.values.items()},
            "regime": np.asarray(self.names)[self.codes.ravel()],
        }

    def shares(self) -> dict[str, float]:
        """Return the fraction of the cells in each regime, by name."""
        counts = np.bincount(self.codes.ravel(), minlength=len(self.names))
        return {name: float(count / self.codes.size) for name, count in zip(self.names, counts)}

    def unanswered(self, column: str) -> int:
        """Return the number of cells without a value.

        Parameters
        ----------
        column : str

        Returns
        -------
        int
        """
        return int(np.isnan(self.values[column]).sum())


def evaluate(
    first: GridAxis,
    second: GridAxis,
    function: GridFunction,
    names: Sequence[str] = (),
    rows: int | None = None,
) -> Grid:
    """Evaluate a function of two quantities on a grid.

    Parameters
    ----------
    first, second : GridAxis
        Of N1 and N2 values.
    function : callable
        It takes (N1, 1) and (1, N2) arrays in SI and returns arrays that broadcast to (N1, N2), by column
        name; under 'regime' the places in ``names``.
    names : sequence of str
        Of the regimes; without any, every code is 0.
    rows : int, optional
        So many values of the first axis are handed over at a time, for a function that makes many arrays on
        its way; all at once without it.

    Returns
    -------
    Grid
        Its arrays are closed to writing.
    """
    shape = (len(first.values), len(second.values))
    rows = rows or len(first.values)
    parts = [
        function(first.values[k : k + rows, None], second.values[None, :]) for k in range(0, shape[0], rows)
    ]
    values = parts[0]
    if len(parts) > 1:
        values = {name: np.concatenate([part[name] for part in parts]) for name in values}
    full = {name: check.frozen(np.broadcast_to(array, shape)) for name, array in values.items()}
    codes = full.pop("regime", np.zeros(shape, dtype=int))
    return Grid(first, second, full, codes, tuple(names) or ("",))


def span(column: str, low: float, high: float, count: int, unit: float = 1.0, label: str = "") -> GridAxis:
    """Return an axis of evenly spaced values, both ends included.

    Parameters
    ----------
    column : str
        Its name in tables, with the unit: 'beta_deg'.
    low, high : float [SI]
    count : int
    unit : float [SI]
        One unit of the column.

    Returns
    -------
    GridAxis
    """
    return GridAxis(column, check.frozen(np.linspace(low, high, count)), unit, label)
