"""Facts of a part that every document says, in units of the shop: mm, g, degrees."""

from collections.abc import Iterable

from feederscrew.base.columns import Document, values
from feederscrew.base.units import factor
from feederscrew.part.record import CONDITION_COLUMNS, PART_COLUMNS, Part

UJ = factor("uJ", "energy")


def part(solid: Part, warnings: Iterable[str] = ()) -> Document:
    """Return what every document says of its part.

    Parameters
    ----------
    solid : Part
    warnings : iterable of str, optional
        Those since it was read.

    Returns
    -------
    dict
    """
    return values(PART_COLUMNS, solid) | {"warnings": [*solid.warnings, *warnings]}


def conditions(solid: Part) -> Document:
    """Return what was assumed of a part, for ``run.json``.

    Parameters
    ----------
    solid : Part

    Returns
    -------
    dict
    """
    return values(CONDITION_COLUMNS, solid)
