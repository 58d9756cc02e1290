"""Materials and densities as typed."""

import pytest

from feederscrew.errors import ConfigError
from feederscrew.part.density import HEAVIEST_SOLID_KG_M3, LIGHTEST_SOLID_KG_M3, MATERIALS, find_density

BARE = (("7.85", "g/cm3"), ("7850", "kg/m3"))
NO_MATERIAL, NO_SOLID = "no material is called '{}' - ", "'{}' is the density of no solid - did you mean {}?"


@pytest.mark.parametrize(
    ("text", "value", "label"),
    [
        (None, 7850.0, "steel (default)"), ("steel", 7850.0, "steel"), ("brass", 8470.0, "brass"),
        ("Stainless", 7900.0, "stainless steel"), ("STAINLESS_STEEL", 7900.0, "stainless steel"),
        ("aluminum", 2700.0, "aluminium"), ("nylon", 1130.0, "pa6"), ("ABS", 1050.0, "abs"),
        ("7.85 g/cm3", 7850.0, "7.85 g/cm3"), ("7.85 g/cm³", 7850.0, "7.85 g/cm³"),
        ("7850kg/m^3", 7850.0, "7850kg/m^3"), ("  0.9   g/cm3 ", 900.0, "0.9 g/cm3"),
        ("0.284 lb/in3", 0.284 * 0.45359237 / 0.0254**3, "0.284 lb/in3"), ("30 kg/m3", 30.0, "30 kg/m3"),
        (".9 g/cm3", 900.0, ".9 g/cm3"),
    ],
)  # fmt: skip
def test_density_as_typed(text, value, label):
    assert find_density(*([text] if text else [])) == (pytest.approx(value, rel=1e-12), label)


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("steal", NO_MATERIAL.format("steal") + "did you mean steel?"),
        ("alumnium", NO_MATERIAL.format("alumnium") + "did you mean aluminium?"),
        *((text, NO_MATERIAL.format(text.strip()) + "give a value, as in ") for text in ("", "  ", "wood")),
        ("7.85 kg/m3", NO_SOLID.format("7.85 kg/m3", "7.85 g/cm3")),
        ("7850 g/cm3", NO_SOLID.format("7850 g/cm3", "7850 kg/m3")),
        ("100 g/cm3", NO_SOLID.format("100 g/cm3", "100 kg/m3")),
        *((text, "must be above 0 - e.g. 7.85 g/cm3") for text in ("0 g/cm3", "0", "-7.85 g/cm3")),
        *((number, f"'{number}' has no unit - write {number} {unit}") for number, unit in BARE),
    ],
)
def test_density_that_cannot_be(text, line):
    with pytest.raises(ConfigError) as error:
        find_density(text)
    full = str(error.value)
    assert full.startswith(f"density: {line}") and "\n" not in full
    if "give a value" in line:
        assert all(material.name in full for material in MATERIALS)


def test_the_table_is_sound():
    names = [name for material in MATERIALS for name in (material.name, *material.aliases)]
    assert len(names) == len(set(names))
    for material in MATERIALS:
        assert LIGHTEST_SOLID_KG_M3 < material.density < HEAVIEST_SOLID_KG_M3
        assert material.source and material.name == material.name.lower()
        assert find_density(material.name) == (material.density, material.name)
