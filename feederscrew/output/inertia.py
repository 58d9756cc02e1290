"""Files of ``feeder inertia``."""

from typing import Any

import numpy as np

from feederscrew.output import columns, tables
from feederscrew.output import offers as offer
from feederscrew.output.tables import Frame, row_of
from feederscrew.part.density import MATERIALS
from feederscrew.studies.aspects import InertiaStudy

AXIS_LETTERS = "xyz"
TENSOR_NOISE = 1e-8  # of the largest of a vector or matrix: rounding of the file, 0 in the table


def document(study: InertiaStudy) -> dict[str, Any]:
    """Return everything ``feeder inertia`` says, by names with units; None where a card is silent."""
    facts, balance = columns.part(study.part), study.balance
    warnings = facts.pop("warnings")
    return facts | {
        **row_of(
            balance,
            "inertia_at_origin_g_mm2 principal_moments_g_mm2=moments principal_axes=axes hull_volume_mm3",
            "bounding_box_mm=extents bounding_box_corner_mm=corner",
        ),
        "warnings": warnings,
    }


def materials() -> Frame:
    """Return the materials of parts: ``material``, ``density_g_cm3``, ``aliases``, ``source``."""
    table = tables.table_of(MATERIALS, "material=name density_g_cm3 aliases source")
    return tables.frame(table | {"aliases": [", ".join(names) for names in table["aliases"]]})


def rows(study: InertiaStudy) -> Frame:
    """Return the numbers of a part, one a row: ``quantity`` and ``value``; NaN where a card is silent."""
    facts = document(study)
    scalars = ("density_g_cm3", "mass_g", "volume_mm3", "hull_volume_mm3")
    listed = [
        *((name, facts[name]) for name in scalars),
        *_vector(facts["bounding_box_mm"], "bounding_box_{}_mm"),
        *_vector(facts["bounding_box_corner_mm"], "bounding_box_corner_{}_mm"),
        *_vector(facts["centre_of_mass_mm"], "centre_of_mass_{}_mm"),
        *_matrix(facts["inertia_g_mm2"], "inertia_{}_g_mm2"),
        *_matrix(facts["inertia_at_origin_g_mm2"], "inertia_at_origin_{}_g_mm2"),
        *_vector(facts["principal_moments_g_mm2"], "principal_moment_{}_g_mm2", "123"),
    ]
    for number, axis in zip("123", facts["principal_axes"]):
        listed += _vector(axis, f"principal_axis_{number}_{{}}")
    quantities, values = zip(*listed)
    return tables.frame({"quantity": quantities, "value": [np.nan if v is None else v for v in values]})


def _vector(values: Any, name: str, letters: str = AXIS_LETTERS) -> list[Any]:
    values = [None] * len(letters) if values is None else _clean(values)
    return [(name.format(letter), value) for letter, value in zip(letters, values)]


def _matrix(values: Any, name: str) -> list[Any]:
    values = _clean(values)
    return [
        (name.format(AXIS_LETTERS[i] + AXIS_LETTERS[j]), values[i][j]) for i in range(3) for j in range(i, 3)
    ]


def _clean(values: Any) -> Any:
    return np.where(np.abs(values) <= TENSOR_NOISE * np.abs(values).max(), 0.0, values)


def offers(study: InertiaStudy, format: str = "csv") -> list[offer.Offer]:
    """Offer the mass properties of a part: a document for the format 'json', else a table."""
    if format == "json":
        return [offer.document("inertia.json", document, study)]
    return [offer.table("inertia.csv", rows, study)]
