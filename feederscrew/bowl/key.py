"""One key of a bowl file."""

from dataclasses import dataclass

from feederscrew import units


@dataclass(frozen=True)
class Key:
    """One value a bowl file may give."""

    name: str  # 'drive.amplitude', as in --set
    field: str  # of the Bowl record; two keys of one field exclude each other
    dimension: str  # of units.UNITS_BY_DIMENSION
    lowest: str
    highest: str
    default: str  # a value as typed, or the name of the key whose value is taken
    meaning: str
    share: float = 1.0  # the field's value over the key's
    choices: tuple[str, ...] = ()  # words of which it is one; then it has no unit and no size

    @property
    def section(self) -> str:
        """'drive' of drive.amplitude; '' at the top level."""
        return self.name.rpartition(".")[0]

    @property
    def word(self) -> str:
        """'amplitude' of drive.amplitude: the key as the file has it."""
        return self.name.rpartition(".")[2]

    @property
    def unit(self) -> str:
        """The unit of its lowest value, in which we show it."""
        return "" if self.choices else units.split(self.lowest)[1]

    @property
    def bounds(self) -> str:
        """What it may be, for people: '0 mm to 20 mm', 'right or left'."""
        return " or ".join(self.choices) if self.choices else f"{self.lowest} to {self.highest}"

    def value(self, text: str) -> float | str:
        """Return a value as typed: in SI units, or the word; QuantityError where it is neither."""
        if not self.choices:
            return units.quantity(text, self.dimension, suggest=self.unit)
        words = {_plainly(choice): choice for choice in self.choices}
        word = words.get(_plainly(text))
        if word is None:
            raise units.QuantityError(f"{units.shown(text)} is not known", f"write {self.bounds}")
        return word

    @property
    def column(self) -> str:
        """Name of a table's column of its values: 'amplitude_mm'."""
        return f"{self.word}_{self.unit}".replace("/", "_").rstrip("_")


def _plainly(text: str) -> str:
    """A word without its spaces and in small letters: '60 Hz' is '60hz'."""
    return "".join(text.split()).casefold()
