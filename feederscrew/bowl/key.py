"""One key of a bowl file."""

from dataclasses import dataclass

from feederscrew import units


@dataclass(frozen=True)
class Key:
    """One value a bowl file may give."""

    name: str  # 'drive.amplitude', as in --set
    field: str  # of the Bowl record; two keys of one field exclude each other
    dimension: str  # of units.UNITS
    lowest: str
    highest: str
    default: str  # a value as typed, or the name of the key whose value is taken
    meaning: str
    share: float = 1.0  # the field's value over the key's

    @property
    def section(self):
        """'drive' of drive.amplitude; '' at the top level."""
        return self.name.rpartition(".")[0]

    @property
    def word(self):
        """'amplitude' of drive.amplitude: the key as the file has it."""
        return self.name.rpartition(".")[2]

    @property
    def unit(self):
        """The unit of its lowest value, in which we show it."""
        return units.split(self.lowest)[1]

    @property
    def column(self):
        """Name of a table's column of its values: 'amplitude_mm'."""
        return f"{self.word}_{self.unit}".replace("/", "_").rstrip("_")
