"""The study of ``feeder inertia``: mass properties of one part."""

from dataclasses import dataclass

from feederscrew.part.mass_balance import Balance, balance
from feederscrew.part.record import Part
from feederscrew.records import ReadableRecord


@dataclass(frozen=True, eq=False)
class InertiaStudy(ReadableRecord):
    """A part, and what follows from its volume, mass and inertia."""

    part: Part
    balance: Balance


def inertia(part: Part) -> InertiaStudy:
    """Study the mass properties of a part.

    Parameters
    ----------
    part : Part
        From a mesh or from a part card.

    Returns
    -------
    InertiaStudy
    """
    return InertiaStudy(part, balance(part))
