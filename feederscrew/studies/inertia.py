"""The study of ``feeder inertia``: mass properties of one part."""

from dataclasses import dataclass

from feederscrew.part.mass import MassBalance, mass_balance
from feederscrew.part.record import Part
from feederscrew.records import ReadableRecord
from feederscrew.studies import arguments


@dataclass(frozen=True, eq=False)
class InertiaStudy(ReadableRecord):
    """A part, and what follows from its volume, mass and inertia."""

    part: Part
    balance: MassBalance


def inertia(part: Part) -> InertiaStudy:
    """Return the mass properties of a part, as ``feeder inertia``.

    Parameters
    ----------
    part : Part

    Returns
    -------
    InertiaStudy
    """
    part = arguments.a_part(part)
    return InertiaStudy(part, mass_balance(part))
