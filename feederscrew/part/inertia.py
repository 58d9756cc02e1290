"""The study of ``feeder inertia``: the mass properties of a part."""

from dataclasses import dataclass

from feederscrew.base import check
from feederscrew.base.columns import Column
from feederscrew.base.records import ReadableRecord
from feederscrew.part.mass import MassBalance, mass_balance
from feederscrew.part.record import PART_MEND, Part


@dataclass(frozen=True, eq=False)
class InertiaStudy(ReadableRecord, view="inertia.INERTIA_VIEW"):
    """A part, and what follows from its volume, mass and inertia."""

    part: Part
    balance: MassBalance


INERTIA_COLUMNS: tuple[Column[InertiaStudy], ...] = (  # beside those of every part
    Column("inertia_at_origin_g_mm2", lambda study: study.balance.inertia_at_origin, "g mm2"),
    Column("principal_moments_g_mm2", lambda study: study.balance.moments, "g mm2"),
    Column("principal_axes", lambda study: study.balance.axes),
    Column("hull_volume_mm3", lambda study: study.balance.hull_volume, "mm3"),
    Column("bounding_box_mm", lambda study: study.balance.extents, "mm"),
    Column("bounding_box_corner_mm", lambda study: study.balance.corner, "mm"),
)


def inertia(part: Part) -> InertiaStudy:
    """Return the mass properties of a part, as ``feeder inertia``.

    Parameters
    ----------
    part : Part

    Returns
    -------
    InertiaStudy

    Raises
    ------
    ArgumentError
        If it is not a Part.
    """
    return InertiaStudy(check.kind("part", part, Part, PART_MEND), mass_balance(part))
