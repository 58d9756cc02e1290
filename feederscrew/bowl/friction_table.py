"""Friction by what a part is made of and by the lining of the track, with where each number is from.

A table is a place to begin: oil, dust and wear change friction more than the pair of materials does. Tilt the
track until the part slides: the tangent of that angle is the static coefficient.
"""

import enum
from collections.abc import Sequence
from dataclasses import dataclass

from feederscrew.part.density import MATERIAL_BY_NAME, MATERIALS


class Lining(enum.StrEnum):
    """What parts slide on; the first: friction is as the other keys say."""

    UNSAID = "unsaid"
    STEEL = "steel"  # bare, ground stainless steel
    NICKEL = "nickel"  # plated
    POLYURETHANE = "pu"  # polyurethane, sprayed or glued, 80 to 90 Shore A
    BRUSH = "brush"  # bristles that lean the way parts travel


class Family(enum.StrEnum):
    """What parts are made of, as far as friction tells it."""

    STEEL = "steel"
    BRASS = "brass"
    COPPER = "copper"
    ALUMINIUM = "aluminium"
    ZINC = "zinc"
    PLASTIC = "plastic"
    RUBBER = "rubber"
    GLASS = "glass"


@dataclass(frozen=True)
class TabledFriction:
    """Coefficients of a part on a lining; backward: down the track, where a lining has a direction."""

    static: float  # [1]
    kinetic: float  # [1]
    source: str
    static_backward: float | None = None  # [1]
    kinetic_backward: float | None = None  # [1]


CHART = "Schneider & Company, coefficient of friction reference chart, clean and dry (static)"
LUST = "Lust, engineering guide CDA3000, table 7.21: middle of the range, dry"
TEXTBOOK = "university textbook table, dry"
RUBBER_RANGE = (
    "0.2 (hard) to 2 or 3 (soft): Gallagher Corporation, polyurethane design guide; middle: assumption"
)
STEEL_RANGE = "0.45 to 0.80 static, 0.40 to 0.70 kinetic in public tables: middle"
ASSUMPTION = "assumption"

ON_STEEL = {
    Family.STEEL: TabledFriction(0.6, 0.55, STEEL_RANGE),
    Family.BRASS: TabledFriction(0.51, 0.44, f"{CHART}; kinetic: public tables"),
    Family.COPPER: TabledFriction(0.53, 0.36, TEXTBOOK),
    Family.ALUMINIUM: TabledFriction(0.61, 0.47, TEXTBOOK),
    Family.ZINC: TabledFriction(0.5, 0.4, ASSUMPTION),
    Family.PLASTIC: TabledFriction(0.33, 0.27, LUST),
    Family.RUBBER: TabledFriction(0.8, 0.7, ASSUMPTION),
    Family.GLASS: TabledFriction(0.6, 0.5, f"{CHART}: glass on metal 0.5 to 0.7; kinetic: {ASSUMPTION}"),
}
METAL_ON_NICKEL = TabledFriction(0.4, 0.38, f"{ASSUMPTION}: a hard, smooth metal")
ON_NICKEL = {
    family: METAL_ON_NICKEL if family not in (Family.PLASTIC, Family.RUBBER, Family.GLASS) else own
    for family, own in ON_STEEL.items()
} | {
    Family.PLASTIC: TabledFriction(0.3, 0.25, f"{ASSUMPTION}: no more than on steel"),
    Family.GLASS: TabledFriction(0.78, 0.6, f"{CHART}; kinetic: {ASSUMPTION}"),
}
ON_POLYURETHANE = dict.fromkeys(Family, TabledFriction(0.7, 0.6, RUBBER_RANGE)) | {
    Family.PLASTIC: TabledFriction(0.8, 0.7, f"{RUBBER_RANGE}, more on smooth plastic than on ground steel"),
    Family.RUBBER: TabledFriction(0.9, 0.8, ASSUMPTION),
}
ON_BRUSH = dict.fromkeys(
    Family, TabledFriction(0.4, 0.35, f"{ASSUMPTION}: bristles hold a part that slides back", 0.9, 0.8)
)
TABLE: dict[Lining, dict[Family, TabledFriction]] = {
    Lining.STEEL: ON_STEEL,
    Lining.NICKEL: ON_NICKEL,
    Lining.POLYURETHANE: ON_POLYURETHANE,
    Lining.BRUSH: ON_BRUSH,
}
LININGS, FAMILIES = tuple(map(str, Lining)), tuple(map(str, Family))
PLASTICS = {
    "abs", "pa6", "pa66", "pa66-gf30", "pom", "pp", "pe-hd", "pe-ld", "pc", "pvc", "pet", "pbt", "pmma", "ps",
    "ptfe", "peek",
}  # fmt: skip
BY_MATERIAL = (
    {material.name: Family.PLASTIC for material in MATERIALS if material.name in PLASTICS}
    | dict.fromkeys(("rubber", "epdm", "silicone"), Family.RUBBER)
    | dict.fromkeys(("steel", "stainless steel", "stainless steel 1.4401", "cast iron"), Family.STEEL)
    | {"brass": Family.BRASS, "bronze": Family.BRASS, "copper": Family.COPPER, "zinc": Family.ZINC}
    | {"aluminium": Family.ALUMINIUM, "glass": Family.GLASS, "alumina": Family.GLASS}
)


def find_family(material: str) -> Family | None:
    """Return what a material of the material table counts as; None of one that the table of friction lacks.

    Parameters
    ----------
    material : str
        As of a Part: 'brass', 'pp'; 'steel (default)' and densities are None.

    Returns
    -------
    Family or None
    """
    known = MATERIAL_BY_NAME.get(material.casefold())
    return None if known is None else BY_MATERIAL.get(known.name)


def find_friction(family: str, lining: str) -> TabledFriction | None:
    """Return the friction of parts on a lining; None where the lining is not said.

    Parameters
    ----------
    family : str
        Of ``FAMILIES``.
    lining : str
        Of ``LININGS``.

    Returns
    -------
    TabledFriction or None
    """
    own = TABLE.get(Lining(lining))
    return None if own is None else own[Family(family)]


def rows() -> Sequence[tuple[str, str, TabledFriction]]:
    """Return the whole table: family, lining, friction."""
    return [(family, lining, own[family]) for lining, own in TABLE.items() for family in Family]
