"""Materials and densities: what ``density`` means."""

from dataclasses import dataclass

from feederscrew.base import documents, units
from feederscrew.base.columns import Column
from feederscrew.base.errors import ArgumentError

LIGHTEST_SOLID_KG_M3, HEAVIEST_SOLID_KG_M3 = 10.0, 23_000.0  # rigid foams; osmium has 22,590
DEFAULT_MATERIAL_NAME = "steel"
DEFAULT_MATERIAL = f"{DEFAULT_MATERIAL_NAME} (default)"  # of a part of which nobody said it
DENSITY_ARGUMENT = "density"
EN_1991 = "EN 1991-1-1, table A.4"
EN_10088 = "EN 10088-1, annex E"
EN_1999 = "EN 1999-1-1, 3.2.5"
COPPER = "data sheets of the Deutsches Kupferinstitut"
ZINC = "data sheets for alloys of EN 12844"
METALS = "handbook value, pure metal or alloy named"
PLASTIC = "ISO 1183 value, typical of unfilled grades (CAMPUS, matmake.com)"
FILLED = "ISO 1183 value, typical of grades with 30 % glass fibre"
RUBBER = "typical of compounds, which range over 10 % and more"


@dataclass(frozen=True)
class Material:
    """One row of the material table."""

    name: str
    density: float  # [kg/m3]
    source: str
    aliases: tuple[str, ...] = ()


MATERIAL_COLUMNS: tuple[Column[Material], ...] = (
    Column("material", lambda material: material.name),
    Column("density_g_cm3", lambda material: material.density, "g/cm3"),
    Column("aliases", lambda material: ", ".join(material.aliases)),
    Column("source", lambda material: material.source),
)
MATERIALS = (
    Material("steel", 7850.0, EN_1991, ("carbon steel", "mild steel")),
    Material("stainless steel", 7900.0, f"{EN_10088} (1.4301)", ("stainless", "inox", "1.4301", "a2")),
    Material("stainless steel 1.4401", 8000.0, f"{EN_10088} (1.4401)", ("1.4401", "a4")),
    Material("cast iron", 7200.0, f"{EN_1991}: 71 to 72.5 kN/m3", ()),
    Material("aluminium", 2700.0, EN_1999, ("aluminum", "alu")),
    Material("brass", 8470.0, f"{COPPER} (CuZn39Pb3)", ("messing",)),
    Material("bronze", 8800.0, f"{COPPER} (CuSn8)", ()),
    Material("copper", 8930.0, f"{COPPER} (Cu-ETP)", ()),
    Material("zinc", 6700.0, f"{ZINC} (ZP5)", ("zamak", "zamac", "zp5", "zp3")),
    Material("magnesium", 1810.0, f"{METALS}: AZ91", ()),
    Material("titanium", 4430.0, f"{METALS}: Ti-6Al-4V", ()),
    Material("tungsten carbide", 14_900.0, f"{METALS}: 6 % cobalt", ("carbide",)),
    Material("neodymium magnet", 7500.0, "typical of sintered NdFeB", ("ndfeb", "neodymium")),
    Material("ferrite", 4900.0, "typical of hard ferrite magnets", ()),
    Material("glass", 2500.0, "EN 572-1 (soda lime)", ()),
    Material("alumina", 3900.0, "typical of 99.7 % Al2O3", ("ceramic",)),
    Material("abs", 1050.0, PLASTIC, ()),
    Material("pa6", 1130.0, f"{PLASTIC}, dry", ("nylon", "polyamide", "pa")),
    Material("pa66", 1140.0, f"{PLASTIC}, dry", ()),
    Material("pa66-gf30", 1370.0, FILLED, ()),
    Material("pom", 1410.0, PLASTIC, ("acetal", "delrin", "polyoxymethylene")),
    Material("pp", 905.0, PLASTIC, ("polypropylene",)),
    Material("pe-hd", 955.0, PLASTIC, ("pe", "hdpe", "polyethylene")),
    Material("pe-ld", 920.0, PLASTIC, ("ldpe",)),
    Material("pc", 1200.0, PLASTIC, ("polycarbonate",)),
    Material("pvc", 1390.0, f"{PLASTIC}, rigid", ()),
    Material("pet", 1370.0, PLASTIC, ()),
    Material("pbt", 1310.0, PLASTIC, ()),
    Material("pmma", 1190.0, PLASTIC, ("acrylic",)),
    Material("ps", 1050.0, PLASTIC, ("polystyrene",)),
    Material("ptfe", 2170.0, PLASTIC, ("teflon",)),
    Material("peek", 1310.0, PLASTIC, ()),
    Material("rubber", 1200.0, f"NBR, {RUBBER}", ("nbr",)),
    Material("epdm", 1150.0, RUBBER, ()),
    Material("silicone", 1150.0, RUBBER, ()),
)


MATERIAL_BY_NAME = {name: material for material in MATERIALS for name in (material.name, *material.aliases)}


def find_density(text: str | None = None) -> tuple[float, str]:
    """Return a density [kg/m3] and what to call it: DEFAULT_MATERIAL, 'brass', '7.85 g/cm3'.

    Parameters
    ----------
    text : str, optional
        '7.85 g/cm3', or the name of a material in any case, 'stainless_steel'. Without it, steel.

    Returns
    -------
    density : float [kg/m3]
    name : str
        The name of the material, or the text with its blanks tidied.

    Raises
    ------
    ArgumentError
        If the text names no known material, is not a density, or is one that no solid has: below
        ``LIGHTEST_SOLID_KG_M3`` or above ``HEAVIEST_SOLID_KG_M3``. Its ``value`` is what was probably meant.
    """
    if text is None:
        return MATERIAL_BY_NAME[DEFAULT_MATERIAL_NAME].density, DEFAULT_MATERIAL
    plain = " ".join(text.lower().replace("_", " ").split())
    material = MATERIAL_BY_NAME.get(plain)
    if material:
        return material.density, material.name
    if not plain or not (plain[0].isdigit() or plain[0] in "+-.\N{MINUS SIGN}"):
        near, names = documents.nearest(plain, MATERIAL_BY_NAME), [material.name for material in MATERIALS]
        mend = f'give a value, as in "7.85 g/cm3", or one of {", ".join(names)}'
        mend = mend if near is None else f"did you mean {near}?"
        what = f"no material is called {units.quantity_text(text)}"
        raise ArgumentError(DENSITY_ARGUMENT, what, mend, value=near)
    try:
        number, unit = units.split(text)
        if number <= 0.0:
            raise ArgumentError(DENSITY_ARGUMENT, "must be above 0", "e.g. 7.85 g/cm3")
        value = units.quantity(text, "density", suggest=_plausible_unit(number) or "g/cm3")
    except units.QuantityError as error:
        raise ArgumentError(DENSITY_ARGUMENT, error.what, error.mend, value=error.value) from None
    if not LIGHTEST_SOLID_KG_M3 <= value <= HEAVIEST_SOLID_KG_M3:
        what = f"{units.quantity_text(text)} is the density of no solid"
        likely_unit = _plausible_unit(number, but=unit)
        likely = f"{number:g} {likely_unit}" if likely_unit else None
        mend = f"did you mean {likely}?" if likely else "steel has 7.85 g/cm3"
        raise ArgumentError(DENSITY_ARGUMENT, what, mend, value=likely)
    return value, " ".join(text.split())


def _plausible_unit(number: float, but: str | None = None) -> str | None:
    """The unit, other than ``but``, that makes this number a solid's density, or None."""
    for unit in ("g/cm3", "kg/m3"):
        density = number * units.factor(unit, "density")
        if unit != but and LIGHTEST_SOLID_KG_M3 <= density <= HEAVIEST_SOLID_KG_M3:
            return unit
    return None
