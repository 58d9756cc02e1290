"""Files of ``feeder inertia``."""

from typing import Any

import numpy as np

from feederscrew.output import columns, tables
from feederscrew.output import offers as offer
from feederscrew.output.tables import Frame, row_of
from feederscrew.part.density import MATERIALS
from feederscrew.studies.aspects import InertiaStudy


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
    listed = [(name, facts[name]) for name in ("density_g_cm3", "mass_g", "volume_mm3", "hull_volume_mm3")]
    tensor = ("xx", "xy", "xz", "yy", "yz", "zz")
    for name, letters, values in (
        ("bounding_box_{}_mm", "xyz", facts["bounding_box_mm"]),
        ("bounding_box_corner_{}_mm", "xyz", facts["bounding_box_corner_mm"]),
        ("centre_of_mass_{}_mm", "xyz", facts["centre_of_mass_mm"]),
        ("inertia_{}_g_mm2", tensor, facts["inertia_g_mm2"]),
        ("inertia_at_origin_{}_g_mm2", tensor, facts["inertia_at_origin_g_mm2"]),
        ("principal_moment_{}_g_mm2", "123", facts["principal_moments_g_mm2"]),
        *((f"principal_axis_{k}_{{}}", "xyz", axis) for k, axis in zip("123", facts["principal_axes"])),
    ):
        cells = np.full(len(letters), np.nan)
        if values is not None:  # rounding of the file as 0
            clean = np.where(np.abs(values) <= 1e-8 * np.abs(values).max(), 0.0, values)
            cells = clean[np.triu_indices(3)] if clean.ndim == 2 else clean
        listed += [(name.format(letter), value) for letter, value in zip(letters, cells)]
    quantities, numbers = zip(*listed)
    return tables.frame({"quantity": quantities, "value": [np.nan if v is None else v for v in numbers]})


def offers(study: InertiaStudy, format: str = "csv") -> list[offer.Offer]:
    """Offer the mass properties of a part: a document for the format 'json', else a table."""
    if format == "json":
        return [offer.document("inertia.json", document, study)]
    return [offer.table("inertia.csv", rows, study)]
