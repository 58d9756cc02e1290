"""Units of the shop, mm, g, degrees, and what every document says of its part."""

from typing import Any

import numpy as np

from feederscrew.part.record import Part
from feederscrew.units import MM, factor

MM2, MM3 = factor("mm2", "area"), factor("mm3", "volume")
UJ = factor("uJ", "energy")
GRAM, G_MM2, G_CM3 = factor("g", "mass"), factor("g mm2", "inertia"), factor("g/cm3", "density")


def part(solid: Part, warnings=()) -> dict[str, Any]:
    """Return what every document says of its part; ``warnings`` are those since it was read."""
    return {
        "part": solid.name,
        "units": solid.units,
        "material": solid.material,
        "density_g_cm3": _in(solid.density, G_CM3),
        "mass_g": solid.mass / GRAM,
        "volume_mm3": _in(solid.volume, MM3),
        "centre_of_mass_mm": np.asarray(solid.centre_of_mass) / MM,
        "inertia_g_mm2": np.asarray(solid.inertia) / G_MM2,
        "open_surface": solid.open_surface,
        "warnings": [*solid.warnings, *warnings],
    }


def conditions(solid: Part) -> dict[str, Any]:
    """Return what was assumed of a part, for ``run.json``."""
    facts = part(solid)
    names = ("units", "material", "density_g_cm3", "centre_of_mass_mm", "open_surface")
    return {name: facts[name] for name in names}


def _in(value, unit):
    return None if value is None else value / unit
