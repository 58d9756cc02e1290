"""One number in print beside ours, and what to say about the pair."""

import math
from dataclasses import dataclass

from feederscrew.thesis import digits

EXACT = "exact to print"
EXPLAINED = "explained"
DIFFERS = "differs"
GIVEN = "given"  # measured, or read off a drawing that is lost: nothing to compute it from
VERDICTS = (EXACT, EXPLAINED, DIFFERS, GIVEN)


@dataclass(frozen=True)
class Cell:
    """A printed number and ours; an explanation counts only if its own number fits the print."""

    row: str
    column: str
    published: str  # as printed
    recomputed: float  # in the print's unit; NaN where there is nothing to compute it from
    cut: bool = False  # the table drops digits instead of rounding
    finding: str = ""  # id of the finding that bears on the cell
    explaining: float = math.nan  # what the finding makes of the number
    within: float = 0.0  # how far the explaining number may be from the print, in the print's unit

    @property
    def printed(self):
        """The printed number; NaN where print holds no number."""
        return float(self.published) if digits.is_number(self.published) else math.nan

    @property
    def deviation(self):
        """Ours minus theirs, in the print's unit."""
        return self.recomputed - self.printed

    @property
    def verdict(self):
        """One of ``VERDICTS``."""
        if math.isnan(self.recomputed):
            return GIVEN
        if math.isnan(self.printed):
            return EXPLAINED if self.finding and digits.slip(self.recomputed, self.published) else DIFFERS
        if digits.prints_as(self.recomputed, self.published, self.cut):
            return EXACT
        return EXPLAINED if self.finding and self._explained() else DIFFERS

    def _explained(self):
        near = abs(self.explaining - self.printed) <= self.within
        return near or digits.prints_as(self.explaining, self.published, self.cut)


def given(row, column, published):
    """Return a cell that is data: nothing else in the thesis leads to it."""
    return Cell(row, column, published, math.nan)
