"""The thesis's tables as data, every cell computed again, and the misprints among them."""

import numpy as np
import pytest
from published_cells import MISPRINTS, cases

from feederscrew.thesis import digits
from feederscrew.thesis.printed_cells import DIFFERS, EXACT, EXPLAINED, GIVEN, Cell
from feederscrew.thesis.printed_tables import NUMBERS, table
from feederscrew.thesis.recompute import cells

SHAPES = {  # rows without the total, columns
    "3-1": (5, 2), "3-2": (5, 5), "3-3": (5, 4), "3-4": (5, 6), "3-5": (3, 4), "3-6": (3, 4), "3-7": (3, 6),
    "3-8": (5, 4), "3-9": (5, 6), "3-10": (5, 4), "3-11": (3, 4), "3-12": (11, 1), "3-13": (11, 1),
}  # fmt: skip


@pytest.mark.parametrize("number", NUMBERS)
def test_a_table_says_where_it_is_from_and_is_whole(number):
    printed = table(number)
    assert printed.number == number
    assert "chapter 3" in printed.source
    assert printed.units
    assert (len(printed.names), len(printed.columns)) == SHAPES[number]
    assert all(printed.text(row, column) for row in printed.names for column in printed.columns)


@pytest.mark.parametrize("cell", list(cases(*NUMBERS)))
def test_a_printed_number_follows(cell):
    assert digits.prints_as(cell.recomputed, cell.published, cell.cut)


@pytest.mark.parametrize("number", NUMBERS)
def test_every_misprint_is_explained_by_a_finding(number):
    explained = {(number, c.row, c.column) for c in cells(number) if c.verdict == EXPLAINED}
    assert explained == {key for key in MISPRINTS if key[0] == number}


@pytest.mark.parametrize("number", NUMBERS)
def test_no_cell_differs_without_a_reason(number):
    assert not [cell for cell in cells(number) if cell.verdict == DIFFERS]


def test_most_cells_are_exact_to_print():
    verdicts = [cell.verdict for number in NUMBERS for cell in cells(number)]
    assert verdicts.count(EXACT) == 153
    assert verdicts.count(EXPLAINED) == len(MISPRINTS)
    assert verdicts.count(GIVEN) == 94


@pytest.mark.parametrize("number", ["3-4", "3-7"])
def test_measured_fractions_sum_to_one(number):
    printed = table(number)
    sums = [printed.numbers(column).sum() for column in printed.columns]
    np.testing.assert_allclose(sums, 1.0, rtol=0, atol=1e-12)


@pytest.mark.parametrize(
    ("value", "text", "cut", "fits"),
    [
        (0.8054, "0.805", False, True),
        (0.8055001, "0.805", False, False),
        (0.8059, "0.805", True, True),
        (0.806, "0.805", True, False),
        (0.8049, "0.805", True, False),
        (12.5, "12.5", True, True),
        (0.3, "0.3", True, True),
        (99.9, "100", False, True),
        (-1.26, "-1.3", False, True),
        (-1.26, "-1.2", True, True),
    ],
)
def test_digits_in_print(value, text, cut, fits):
    assert digits.prints_as(value, text, cut) is fits


@pytest.mark.parametrize(("text", "slip"), [("804.1.73", True), ("804.1.74", False), ("84.1.73", False)])
def test_a_slip_is_one_character(text, slip):
    assert digits.slip(804.10731, text) is slip


@pytest.mark.parametrize(
    ("cell", "verdict"),
    [
        (Cell("a", "b", "0.12", 0.121), EXACT),
        (Cell("a", "b", "0.12", 0.129), DIFFERS),
        (Cell("a", "b", "0.12", 0.129, cut=True), EXACT),
        (Cell("a", "b", "0.12", 0.3, finding="x", explaining=0.119), EXPLAINED),
        (Cell("a", "b", "0.12", 0.3, finding="x", explaining=0.13), DIFFERS),
        (Cell("a", "b", "0.12", 0.3, finding="x", explaining=0.13, within=0.02), EXPLAINED),
        (Cell("a", "b", "0.12", 0.3, explaining=0.12), DIFFERS),
        (Cell("a", "b", "1.2.3", 1.203, finding="x"), EXPLAINED),
        (Cell("a", "b", "1.2.3", 1.204, finding="x"), DIFFERS),
        (Cell("a", "b", "0.12", float("nan")), GIVEN),
    ],
)
def test_an_explanation_must_fit_the_print(cell, verdict):
    assert cell.verdict == verdict
