"""What every document says of its part, in units of the shop: mm, g, degrees."""

from collections.abc import Iterable
from typing import Any

from feederscrew.output.tables import row_of
from feederscrew.part.record import Part
from feederscrew.units import factor

UJ = factor("uJ", "energy")


def part(solid: Part, warnings: Iterable[str] = ()) -> dict[str, Any]:
    """Return what every document says of its part; ``warnings`` are those since it was read."""
    of_mass = "centre_of_mass_mm inertia_g_mm2 open_surface"
    names = "part=name units material density_g_cm3 mass_g volume_mm3"
    return row_of(solid, names, of_mass) | {"warnings": [*solid.warnings, *warnings]}


def conditions(solid: Part) -> dict[str, Any]:
    """Return what was assumed of a part, for ``run.json``."""
    return row_of(solid, "units material density_g_cm3 centre_of_mass_mm open_surface")
