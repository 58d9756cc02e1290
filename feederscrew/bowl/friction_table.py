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


class PartMaterial(enum.StrEnum):
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
GLASS_RANGE = f"{CHART}: glass on metal 0.5 to 0.7; kinetic: {ASSUMPTION}"
SMOOTH_PLASTIC = f"{RUBBER_RANGE}, more on smooth plastic than on ground steel"

ON_STEEL = {
    PartMaterial.STEEL: TabledFriction(0.6, 0.55, STEEL_RANGE),
    PartMaterial.BRASS: TabledFriction(0.51, 0.44, f"{CHART}; kinetic: public tables"),
    PartMaterial.COPPER: TabledFriction(0.53, 0.36, TEXTBOOK),
    PartMaterial.ALUMINIUM: TabledFriction(0.61, 0.47, TEXTBOOK),
    PartMaterial.ZINC: TabledFriction(0.5, 0.4, ASSUMPTION),
    PartMaterial.PLASTIC: TabledFriction(0.33, 0.27, LUST),
    PartMaterial.RUBBER: TabledFriction(0.8, 0.7, ASSUMPTION),
    PartMaterial.GLASS: TabledFriction(0.6, 0.5, GLASS_RANGE),
}
ON_NICKEL = dict.fromkeys(
    PartMaterial, TabledFriction(0.4, 0.38, f"{ASSUMPTION}: a metal on a hard, smooth metal")
) | {
    PartMaterial.PLASTIC: TabledFriction(0.3, 0.25, f"{ASSUMPTION}: no more than on steel"),
    PartMaterial.RUBBER: ON_STEEL[PartMaterial.RUBBER],
    PartMaterial.GLASS: TabledFriction(0.78, 0.6, f"{CHART}; kinetic: {ASSUMPTION}"),
}
ON_POLYURETHANE = dict.fromkeys(PartMaterial, TabledFriction(0.7, 0.6, RUBBER_RANGE)) | {
    PartMaterial.PLASTIC: TabledFriction(
        0.8, 0.7, f"{RUBBER_RANGE}, more on smooth plastic than on ground steel"
    ),
    PartMaterial.RUBBER: TabledFriction(0.9, 0.8, ASSUMPTION),
}
ON_BRUSH = dict.fromkeys(
    PartMaterial, TabledFriction(0.4, 0.35, f"{ASSUMPTION}: bristles hold a part that slides back", 0.9, 0.8)
)
TABLE: dict[Lining, dict[PartMaterial, TabledFriction]] = {
    Lining.STEEL: ON_STEEL,
    Lining.NICKEL: ON_NICKEL,
    Lining.POLYURETHANE: ON_POLYURETHANE,
    Lining.BRUSH: ON_BRUSH,
}
LININGS, FAMILIES = tuple(map(str, Lining)), tuple(map(str, PartMaterial))
PLASTICS = {
    "abs", "pa6", "pa66", "pa66-gf30", "pom", "pp", "pe-hd", "pe-ld", "pc", "pvc", "pet", "pbt", "pmma", "ps",
    "ptfe", "peek",
}  # fmt: skip
BY_MATERIAL = (
    {material.name: PartMaterial.PLASTIC for material in MATERIALS if material.name in PLASTICS}
    | dict.fromkeys(("rubber", "epdm", "silicone"), PartMaterial.RUBBER)
    | dict.fromkeys(("steel", "stainless steel", "stainless steel 1.4401", "cast iron"), PartMaterial.STEEL)
    | {
        "brass": PartMaterial.BRASS,
        "bronze": PartMaterial.BRASS,
        "copper": PartMaterial.COPPER,
        "zinc": PartMaterial.ZINC,
    }
    | {"aluminium": PartMaterial.ALUMINIUM, "glass": PartMaterial.GLASS, "alumina": PartMaterial.GLASS}
)


def find_family(material: str) -> PartMaterial | None:
    """Return what a material of the material table counts as; None of one that the table of friction lacks.

    Parameters
    ----------
    material : str
        As of a Part: 'brass', 'pp'; 'steel (default)' and densities are None.

    Returns
    -------
    PartMaterial or None
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
    return None if own is None else own[PartMaterial(family)]


def rows() -> Sequence[tuple[str, str, TabledFriction]]:
    """Return the whole table: family, lining, friction."""
    return [(family, lining, own[family]) for lining, own in TABLE.items() for family in PartMaterial]
