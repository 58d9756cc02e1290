"""Every number of Tables 3-1 to 3-13 computed again, cell by cell."""

import functools
from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from feederscrew.resting.deviation import deviation
from feederscrew.resting.rules import formulas
from feederscrew.thesis import parts
from feederscrew.thesis.tables import TOTAL, Cell, PrintedTable, is_number, last_digit, table

THINNER_RATIO = 0.4  # aspect ratio whose CSA profile Table 3-1 prints under 0.6
INPUT_DECIMALS = 2  # the thesis rounds I [g mm2] and h [mm] before it divides them
IMPLIED_ROW = "sum, not printed"
CSA_TOLERANCE_POINTS = 1.0  # [percentage points] between Table 3-1's CSA column, without decimals, and ours
Cells = Iterator[Cell]


def cells(number: str) -> tuple[Cell, ...]:
    """Return printed and recomputed value of each cell of a table.

    Parameters
    ----------
    number : str
        As the thesis counts: '3-9'.

    Returns
    -------
    tuple of Cell
        In the order of the print, row by row; what print only implies comes last.
    """
    printed = table(number)
    computed = {(cell.row, cell.column): cell for cell in RECIPES[number](printed)}
    order = [(row, column) for row in printed.rows for column in printed.columns if printed.text(row, column)]
    listed = [computed.pop(key, Cell(*key, printed.text(*key))) for key in order]
    return (*listed, *computed.values())


def rounded_shares(
    ratio: float,
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Return moments, heights and PMI probabilities of the T shape with the thesis's roundings.

    Parameters
    ----------
    ratio : float [1]
        Thickness over width.

    Returns
    -------
    moments : (5,) float [g mm2]
    heights : (5,) float [mm]
    shares : (5,) float [1]
    """
    aspects = parts.t_aspects(ratio)
    moments = np.round(aspects.moments / parts.G_MM2, INPUT_DECIMALS)
    heights = np.round(aspects.heights / parts.MM, INPUT_DECIMALS)
    ones = np.ones(len(heights))
    return moments, heights, formulas.normalised(formulas.pmi(ones, moments, heights), ones > 0)


def _table_3_1(printed: PrintedTable) -> Cells:
    """CSA at the printed ratio, explained by that of a thinner prism."""
    ours, thinner = (100.0 * parts.t_aspects(ratio).csa for ratio in (0.6, THINNER_RATIO))
    for row, value, other in zip(printed.names, ours, thinner, strict=True):
        text = printed.text(row, "csa")
        yield Cell(
            row, "csa", text, value, finding="csa-ratio", explaining=other, within=CSA_TOLERANCE_POINTS
        )
    yield _sum(printed, "csa")
    yield replace(_sum(printed, "experiment", finding="experiment-total"), explaining=100.0)


def _table_3_8(printed: PrintedTable) -> Cells:
    """PMI of the T shape, from its solid."""
    aspects = parts.t_aspects(0.6)
    moments, heights, shares = rounded_shares(0.6)
    for k, row in enumerate(printed.names):
        yield Cell(row, "I", printed.text(row, "I"), aspects.moments[k] / parts.G_MM2)
        yield Cell(row, "h", printed.text(row, "h"), aspects.heights[k] / parts.MM)
        yield _ratio(printed, row, "I_over_h", moments[k] / heights[k], cut=True)
        yield Cell(row, "probability", printed.text(row, "probability"), shares[k])
    yield _total_of_cut(printed, "I_over_h", (moments / heights).sum())
    yield _total_of_rounded(printed)


def _table_3_9(printed: PrintedTable) -> Cells:
    """PMI of the T shape, from the six solids."""
    for ratio in parts.T_RATIOS:
        shares = 100.0 * rounded_shares(float(ratio))[2]
        for row, share in zip(printed.names, shares, strict=True):
            yield Cell(row, ratio, printed.text(row, ratio), share, finding="t-shape-rounded")
        yield Cell(TOTAL, ratio, printed.text(TOTAL, ratio), shares.sum())


def _quotients(weight: str, part: str, rule: str, printed: PrintedTable) -> Cells:
    """A table of weight, height, their quotient and its share."""
    column = f"{weight}_over_h"
    cut = printed.number == "3-10"
    quotient = printed.numbers(weight) / printed.numbers("h")
    for row, value, share in zip(printed.names, quotient, parts.rule(part, rule), strict=True):
        yield _ratio(printed, row, column, value, cut)
        yield Cell(row, "probability", printed.text(row, "probability"), share)
    yield from _cross_checks(printed, part, rule)
    last = printed.rows[TOTAL]
    if last[weight]:
        yield _sum(printed, weight, finding="q-total" if printed.number == "3-2" else "rounded-inputs")
    if last[column] and cut:
        yield _total_of_cut(printed, column, quotient.sum())
    elif last[column]:
        finding = "" if is_number(last[column]) else "magnet-total"
        yield Cell(TOTAL, column, last[column], quotient.sum(), finding=finding)
    if printed.number == "3-10":
        yield _total_of_rounded(printed)
    elif printed.number == "3-11":
        step = last_digit(last["probability"])
        yield _sum(printed, "probability", finding="magnet-probability-total", within=1.01 * step)
    else:
        yield _sum(printed, "probability")


def _cross_checks(printed: PrintedTable, part: str, rule: str) -> Cells:
    """Cells that another place of the thesis leads to: chapter 4's matrix, or one height for a column."""
    if rule == "csa" and "h_total_over_h" in printed.columns:
        heights = printed.numbers("h")
        implied = (heights * printed.numbers("h_total_over_h")).mean()
        for row, height in zip(printed.names, heights, strict=True):
            yield Cell(row, "h_total_over_h", printed.text(row, "h_total_over_h"), implied / height)
    inertia, centre = (parts.card(part).inertia / parts.G_MM2, parts.card(part).centre_of_mass / parts.MM)
    if rule == "pmi" and part == "arc_chute":  # 2, 3 and 5 lie along its axes; 5 once x and z are exchanged
        for row in ("2", "3"):
            yield Cell(row, "I", printed.text(row, "I"), inertia[1, 1])
        moment = printed.text("5", "I")
        yield Cell("5", "I", moment, inertia[0, 0], finding="axes-swapped", explaining=inertia[2, 2])
        yield Cell("5", "h", printed.text("5", "h"), centre[0])
    if rule == "pmi" and part == "magnet":  # 2 and 3 lie along y and x of its axes
        yield Cell("2", "I", printed.text("2", "I"), inertia[1, 1])
        yield Cell("2", "h", printed.text("2", "h"), centre[1])
        text = printed.text("3", "h")
        within = 1.01 * last_digit(text)
        yield Cell("3", "h", text, centre[0], finding="magnet-height", explaining=centre[0], within=within)


def _deviations(part: str, printed: PrintedTable) -> Cells:
    """Deviation between any two profiles; those with the Magnet's CSA follow from mixed heights."""
    profiles = parts.profiles(part)
    mixed = profiles | {"CSA": parts.mixed_heights()} if part == "magnet" else profiles
    for row in printed.rows:
        first, second = row.split(" - ")
        value, other = deviation(profiles[first], profiles[second]), deviation(mixed[first], mixed[second])
        finding = "magnet-csa-mixed" if part == "magnet" and "CSA" in row else "cut-deviations"
        text = printed.text(row, "deviation")
        yield Cell(row, "deviation", text, value, cut=True, finding=finding, explaining=other)


def _measured(printed: PrintedTable) -> Cells:
    """An experiment's table: nothing leads to its entries, but each column is a whole."""
    for column in printed.columns:
        yield Cell(IMPLIED_ROW, column, "1", printed.numbers(column).sum())


def _ratio(printed: PrintedTable, row: str, column: str, value: float, cut: bool = False) -> Cell:
    """A quotient's cell; the rounding of its two printed terms is what may explain a last digit."""
    text = printed.text(row, column)
    terms = [printed.text(row, name) for name in (column.partition("_")[0], "h")]
    spread = value * sum(0.5 * last_digit(term) / float(term) for term in terms)
    within = spread + 0.5 * last_digit(text)
    finding = "cut-ratios" if cut else "rounded-inputs"
    return Cell(row, column, text, value, cut=cut, finding=finding, explaining=value, within=within)


def _sum(printed: PrintedTable, column: str, finding: str = "", within: float = 0.0) -> Cell:
    """A column's total, from the printed entries."""
    text, values = printed.text(TOTAL, column), printed.numbers(column)
    explaining = values.sum()
    if finding == "rounded-inputs":
        spread = sum(0.5 * last_digit(printed.text(row, column)) for row in printed.names)
        within = spread + 0.5 * last_digit(text)
    if finding == "q-total":
        explaining = values[1:].sum()
    return Cell(TOTAL, column, text, values.sum(), finding=finding, explaining=explaining, within=within)


def _total_of_cut(printed: PrintedTable, column: str, total: float) -> Cell:
    """A total of quotients that were cut off before they were added."""
    text = printed.text(TOTAL, column)
    return Cell(TOTAL, column, text, total, finding="cut-ratios", explaining=printed.numbers(column).sum())


def _total_of_rounded(printed: PrintedTable) -> Cell:
    """A total of probabilities that were rounded before they were added; unrounded they give 1."""
    text, added = printed.text(TOTAL, "probability"), printed.numbers("probability").sum()
    return Cell(TOTAL, "probability", text, 1.0, finding="sum-of-rounded", explaining=added)


RECIPES: dict[str, Callable[[PrintedTable], Cells]] = {
    "3-1": _table_3_1,
    "3-2": functools.partial(_quotients, "Q", "arc_chute", "csa"),
    "3-3": functools.partial(_quotients, "A", "arc_chute", "stability"),
    "3-4": _measured,
    "3-5": functools.partial(_quotients, "Q", "magnet", "csa"),
    "3-6": functools.partial(_quotients, "A", "magnet", "stability"),
    "3-7": _measured,
    "3-8": _table_3_8,
    "3-9": _table_3_9,
    "3-10": functools.partial(_quotients, "I", "arc_chute", "pmi"),
    "3-11": functools.partial(_quotients, "I", "magnet", "pmi"),
    "3-12": functools.partial(_deviations, "arc_chute"),
    "3-13": functools.partial(_deviations, "magnet"),
}
