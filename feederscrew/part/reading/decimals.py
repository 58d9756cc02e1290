"""Numbers of text formats, with a decimal point or, in files of some programs, with a comma."""

import re

import numpy as np
from numpy.typing import NDArray

from feederscrew.part.reading.soup import DamageError

COMMA_NUMBERS = re.compile(rb"(?:[-+]?(?:\d+(?:,\d*)?|,\d+)(?:[eE][-+]?\d+)?\s*)*")
GROUPS = re.compile(rb"[-+]?\d{1,3}(?:,\d{3})+")  # thousands, or three decimals
READ_COMMAS = "its numbers have decimal commas: read as decimal points"


class CommaError(ValueError):
    """Commas that may not stand for decimal points."""


class Decimals:
    """Reads the numbers of one file, and remembers whether they have points or commas."""

    def __init__(self) -> None:
        self.points = self.commas = self.whole = False  # whether there are such, and numbers with neither
        self.grouped = True  # whether every comma has three digits behind it

    def read(self, words: list[bytes]) -> NDArray[np.float64]:
        """Return words as (N,) numbers [unit of the file].

        Raises
        ------
        CommaError
            If there are commas in other places than that of a decimal point, or points in other numbers.
        ValueError
            If a word is not a number.
        """
        text = b" ".join(words)
        if b"_" in text:
            raise DamageError("an underscore in a number")
        self.points = self.points or b"." in text
        if b"," in text:
            self.commas = True
            if not COMMA_NUMBERS.fullmatch(text):
                raise CommaError("a comma in a number")
            self.grouped = self.grouped and all(GROUPS.fullmatch(word) for word in words if b"," in word)
            self.whole = self.whole or any(b"," not in word for word in words)
            words = text.replace(b",", b".").split()
        elif words and not self.points:
            self.whole = True
        if self.points and self.commas:
            raise CommaError("numbers with a comma and numbers with a point")
        if self.commas and self.whole and self.grouped:
            raise CommaError("commas that may part thousands or decimals")
        return np.array(words, dtype=float)

    @property
    def warnings(self) -> tuple[str, ...]:
        """What to say of the numbers that were read."""
        return (READ_COMMAS,) if self.commas else ()
