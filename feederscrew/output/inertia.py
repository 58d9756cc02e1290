"""Files of ``feeder inertia``."""

from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

import numpy as np

from feederscrew.base.arrays import Vector
from feederscrew.base.columns import (
    Column,
    ColumnHead,
    Document,
    Frame,
    UnitName,
    of_records,
    quantities,
    values,
)
from feederscrew.output import offers as offer
from feederscrew.output import part_facts
from feederscrew.output.offers import RecordView
from feederscrew.output.record_lines import inertia_text
from feederscrew.part.density import MATERIAL_COLUMNS, MATERIALS
from feederscrew.part.inertia import INERTIA_COLUMNS, InertiaStudy


def document(study: InertiaStudy) -> Document:
    """Return everything ``feeder inertia`` says, by names with units.

    Parameters
    ----------
    study : InertiaStudy

    Returns
    -------
    dict
        None where a card is silent.
    """
    facts = part_facts.part(study.part)
    warnings = facts.pop("warnings")
    return facts | values(INERTIA_COLUMNS, study) | {"warnings": warnings}


def materials() -> Frame:
    """Return the materials of parts: ``material``, ``density_g_cm3``, ``aliases``, ``source``."""
    return of_records(MATERIAL_COLUMNS, MATERIALS)


TENSOR = ("xx", "xy", "xz", "yy", "yz", "zz")
ROUNDING = 1e-8  # [1] of the largest number of a vector or tensor: less is the file's, and 0


def _cells(
    name: str, letters: Sequence[str], of: Callable[[InertiaStudy], Any], unit: UnitName
) -> list[Column[InertiaStudy]]:
    """A column for each number of a vector or of a symmetric tensor; NaN where a card is silent."""

    def cell(study: InertiaStudy, place: int) -> float:
        numbers = of(study)
        if numbers is None:
            return np.nan
        clean = np.where(np.abs(numbers) <= ROUNDING * np.abs(numbers).max(), 0.0, numbers)
        return float((clean[np.triu_indices(3)] if clean.ndim == 2 else clean)[place])

    return [
        Column(name.format(letter), partial(cell, place=place), unit) for place, letter in enumerate(letters)
    ]


QUANTITIES: tuple[Column[InertiaStudy], ...] = (  # a row each
    Column("density_g_cm3", lambda study: study.part.density, "g/cm3"),
    Column("mass_g", lambda study: study.part.mass, "g"),
    Column("volume_mm3", lambda study: study.part.volume, "mm3"),
    Column("hull_volume_mm3", lambda study: study.balance.hull_volume, "mm3"),
    *_cells("bounding_box_{}_mm", "xyz", lambda study: study.balance.extents, "mm"),
    *_cells("bounding_box_corner_{}_mm", "xyz", lambda study: study.balance.corner, "mm"),
    *_cells("centre_of_mass_{}_mm", "xyz", lambda study: study.part.centre_of_mass, "mm"),
    *_cells("inertia_{}_g_mm2", TENSOR, lambda study: study.part.inertia, "g mm2"),
    *_cells("inertia_at_origin_{}_g_mm2", TENSOR, lambda study: study.balance.inertia_at_origin, "g mm2"),
    *_cells("principal_moment_{}_g_mm2", "123", lambda study: study.balance.moments, "g mm2"),
    *_cells("principal_axis_1_{}", "xyz", lambda study: _axis(study, 0), ""),
    *_cells("principal_axis_2_{}", "xyz", lambda study: _axis(study, 1), ""),
    *_cells("principal_axis_3_{}", "xyz", lambda study: _axis(study, 2), ""),
)


def _axis(study: InertiaStudy, place: int) -> Vector:
    return study.balance.axes[place]


def rows(study: InertiaStudy) -> Frame:
    """Return the numbers of a part, one a row.

    Parameters
    ----------
    study : InertiaStudy

    Returns
    -------
    Frame
        Columns ``quantity`` and ``value``; NaN where a card is silent.
    """
    numbers = values(QUANTITIES, study)
    listed = {"quantity": list(numbers), "value": [np.nan if v is None else v for v in numbers.values()]}
    return Frame.of(listed, {"value": ColumnHead("value", is_mixed=True)})


def facts(study: InertiaStudy, names: Sequence[str]) -> Frame:
    """Return some numbers of a part for people: quantities with their units, and values.

    Parameters
    ----------
    study : InertiaStudy
    names : sequence of str
        Of the quantities, 'mass_g'.

    Returns
    -------
    Frame
    """
    chosen = [column for column in QUANTITIES if column.name in names]
    numbers = values(chosen, study).values()
    return quantities((column.head.title, value) for column, value in zip(chosen, numbers))


def offers(study: InertiaStudy, format: str = "csv") -> list[offer.Offer]:
    """Offer the mass properties of a part.

    Parameters
    ----------
    study : InertiaStudy
    format : str
        'json' for a document, else a table.

    Returns
    -------
    list of Offer
    """
    if format == "json":
        return [offer.document("inertia.json", document, study)]
    return [offer.table("inertia.csv", rows, study)]


INERTIA_VIEW = RecordView(inertia_text, offers, "inertia")
