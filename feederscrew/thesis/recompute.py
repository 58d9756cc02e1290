"""Every number of Tables 3-1 to 3-13 computed again, cell by cell."""

from dataclasses import replace

import numpy as np

from feederscrew.resting.counts.deviation import deviation
from feederscrew.resting.rules import published
from feederscrew.thesis import digits, parts
from feederscrew.thesis.printed_cells import Cell, given
from feederscrew.thesis.printed_tables import TOTAL, table
from feederscrew.thesis.t_shape import RATIOS

THINNER = 0.4  # aspect ratio whose CSA profile Table 3-1 prints under 0.6
DIGITS = 2  # the thesis rounds I [g mm2] and h [mm] before it divides them
IMPLIED = "sum, not printed"
POINT = 1.0  # [percentage points] how closely Table 3-1's CSA column follows, a column with no decimals


def cells(number):
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
    found = {(cell.row, cell.column): cell for cell in RECIPES[number](table(number))}
    printed = table(number)
    order = [(row, column) for row in printed.rows for column in printed.columns if printed.text(row, column)]
    listed = [found.pop(key, None) or given(*key, printed.text(*key)) for key in order]
    return (*listed, *found.values())


def rounded_shares(ratio):
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
    moments, heights = (
        np.round(aspects.moments / parts.G_MM2, DIGITS),
        np.round(aspects.heights / parts.MM, DIGITS),
    )
    ones = np.ones(len(heights))
    return moments, heights, published.normalised(published.pmi(ones, moments, heights), ones > 0)


def _ngoi(printed):
    """Table 3-1: CSA at the printed ratio, explained by that of a thinner prism."""
    ours, thinner = (100.0 * parts.t_aspects(ratio).csa for ratio in (0.6, THINNER))
    for row, value, other in zip(printed.names, ours, thinner, strict=True):
        text = printed.text(row, "csa")
        yield Cell(row, "csa", text, value, finding="csa-ratio", explaining=other, within=POINT)
    yield _sum(printed, "csa")
    yield replace(_sum(printed, "experiment", finding="experiment-total"), explaining=100.0)


def _t_pmi(printed):
    """Table 3-8, from the solid."""
    aspects = parts.t_aspects(0.6)
    moments, heights, shares = rounded_shares(0.6)
    for k, row in enumerate(printed.names):
        yield Cell(row, "I", printed.text(row, "I"), aspects.moments[k] / parts.G_MM2)
        yield Cell(row, "h", printed.text(row, "h"), aspects.heights[k] / parts.MM)
        yield _ratio(printed, row, "I_over_h", moments[k] / heights[k], cut=True)
        yield Cell(row, "probability", printed.text(row, "probability"), shares[k])
    yield _total_of_cut(printed, "I_over_h", (moments / heights).sum())
    yield _total_of_rounded(printed)


def _t_by_ratio(printed):
    """Table 3-9, from the six solids."""
    for ratio in RATIOS:
        shares = 100.0 * rounded_shares(float(ratio))[2]
        for row, share in zip(printed.names, shares, strict=True):
            yield Cell(row, ratio, printed.text(row, ratio), share, finding="t-shape-rounded")
        yield Cell(TOTAL, ratio, printed.text(TOTAL, ratio), shares.sum())


def _quotients(weight, part, key, cut=False):
    """Recipe of a table of weight, height, their quotient and its share."""

    def recipe(printed):
        quotient = printed.numbers(weight) / printed.numbers("h")
        shares = parts.rule(part, key)
        for k, row in enumerate(printed.names):
            yield _ratio(printed, row, f"{weight}_over_h", quotient[k], cut)
            yield Cell(row, "probability", printed.text(row, "probability"), shares[k])
        yield from _cross_checks(printed, part, key)
        yield from _totals(printed, weight, quotient, cut)

    return recipe


def _totals(printed, weight, quotient, cut):
    """Total row of a table of quotients."""
    last = printed.rows[TOTAL]
    if last[weight]:
        yield _sum(printed, weight, finding="q-total" if printed.number == "3-2" else "rounded-inputs")
    if last[f"{weight}_over_h"]:
        total = _total_of_cut if cut else _total_of_quotients
        yield total(printed, f"{weight}_over_h", quotient.sum())
    if printed.number == "3-10":
        yield _total_of_rounded(printed)
    elif printed.number == "3-11":
        one_digit = digits.last_digit(last["probability"])
        yield _sum(printed, "probability", finding="magnet-probability-total", within=1.01 * one_digit)
    else:
        yield _sum(printed, "probability")


def _cross_checks(printed, part, key):
    """Cells of a table that another place of the thesis leads to."""
    if key == "csa" and "h_total_over_h" in printed.columns:
        implied = printed.numbers("h") * printed.numbers("h_total_over_h")
        for row, height in zip(printed.names, printed.numbers("h"), strict=True):
            yield Cell(row, "h_total_over_h", printed.text(row, "h_total_over_h"), implied.mean() / height)
    if key == "pmi":
        inertia, centre = (parts.card(part).inertia / parts.G_MM2, parts.card(part).centre_of_mass / parts.MM)
        yield from CROSS[part](printed, inertia, centre)


def _arc_chute_checks(printed, inertia, centre):
    """Aspects 2, 3 and 5 lie along the axes of chapter 4's matrix; 5 only once x and z are exchanged."""
    for row in ("2", "3"):
        yield Cell(row, "I", printed.text(row, "I"), inertia[1, 1])
    yield Cell(
        "5", "I", printed.text("5", "I"), inertia[0, 0], finding="axes-swapped", explaining=inertia[2, 2]
    )
    yield Cell("5", "h", printed.text("5", "h"), centre[0])


def _magnet_checks(printed, inertia, centre):
    """Aspects 2 and 3 lie along y and x of chapter 4's axes."""
    yield Cell("2", "I", printed.text("2", "I"), inertia[1, 1])
    yield Cell("2", "h", printed.text("2", "h"), centre[1])
    text = printed.text("3", "h")
    within = 1.01 * digits.last_digit(text)
    yield Cell("3", "h", text, centre[0], finding="magnet-height", explaining=centre[0], within=within)


def _deviations(part):
    """Recipe of a table of deviations."""

    def recipe(printed):
        profiles = parts.profiles(part)
        mixed = profiles | {"CSA": parts.mixed_heights()} if part == "magnet" else profiles
        for row in printed.rows:
            first, second = row.split(" - ")
            value = deviation(profiles[first], profiles[second])
            other = deviation(mixed[first], mixed[second])
            finding = "magnet-csa-mixed" if part == "magnet" and "CSA" in row else "cut-deviations"
            text = printed.text(row, "deviation")
            yield Cell(row, "deviation", text, value, cut=True, finding=finding, explaining=other)

    return recipe


def _measured(printed):
    """An experiment's table: nothing leads to its entries, but each column is a whole."""
    for column in printed.columns:
        yield Cell(IMPLIED, column, "1", printed.numbers(column).sum())


def _ratio(printed, row, column, value, cut=False):
    """A quotient's cell; the rounding of its two printed terms is what may explain a last digit."""
    text = printed.text(row, column)
    terms = [printed.text(row, name) for name in (column.partition("_")[0], "h")]
    spread = value * sum(0.5 * digits.last_digit(term) / float(term) for term in terms)
    within = spread + 0.5 * digits.last_digit(text)
    finding = "cut-ratios" if cut else "rounded-inputs"
    return Cell(row, column, text, value, cut=cut, finding=finding, explaining=value, within=within)


def _sum(printed, column, finding="", within=0.0):
    """A column's total, from the printed entries."""
    text, values = printed.text(TOTAL, column), printed.numbers(column)
    explaining = values.sum()
    if finding == "rounded-inputs":
        spread = sum(0.5 * digits.last_digit(printed.text(row, column)) for row in printed.names)
        within = spread + 0.5 * digits.last_digit(text)
    if finding == "q-total":
        explaining = values[1:].sum()
    return Cell(TOTAL, column, text, values.sum(), finding=finding, explaining=explaining, within=within)


def _total_of_quotients(printed, column, total):
    text = printed.text(TOTAL, column)
    finding = "" if digits.is_number(text) else "magnet-total"
    return Cell(TOTAL, column, text, total, finding=finding)


def _total_of_cut(printed, column, total):
    """A total of quotients that were cut off before they were added."""
    text = printed.text(TOTAL, column)
    return Cell(TOTAL, column, text, total, finding="cut-ratios", explaining=printed.numbers(column).sum())


def _total_of_rounded(printed):
    """A total of probabilities that were rounded before they were added; unrounded they give 1."""
    text, added = printed.text(TOTAL, "probability"), printed.numbers("probability").sum()
    return Cell(TOTAL, "probability", text, 1.0, finding="sum-of-rounded", explaining=added)


CROSS = {"arc_chute": _arc_chute_checks, "magnet": _magnet_checks}
RECIPES = {
    "3-1": _ngoi,
    "3-2": _quotients("Q", "arc_chute", "csa"),
    "3-3": _quotients("A", "arc_chute", "stability"),
    "3-4": _measured,
    "3-5": _quotients("Q", "magnet", "csa"),
    "3-6": _quotients("A", "magnet", "stability"),
    "3-7": _measured,
    "3-8": _t_pmi,
    "3-9": _t_by_ratio,
    "3-10": _quotients("I", "arc_chute", "pmi", cut=True),
    "3-11": _quotients("I", "magnet", "pmi"),
    "3-12": _deviations("arc_chute"),
    "3-13": _deviations("magnet"),
}
