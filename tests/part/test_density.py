"""Materials and densities as typed."""

import pytest

from feederscrew.errors import ConfigError
from feederscrew.part.density import HEAVIEST_SOLID_KG_M3, LIGHTEST_SOLID_KG_M3, MATERIALS, find_density


def refused(text):
    with pytest.raises(ConfigError) as error:
        find_density(text)
    return str(error.value)


def test_default_is_steel_and_says_so():
    assert find_density() == (7850.0, "steel (default)")
    assert find_density("steel") == (7850.0, "steel")


@pytest.mark.parametrize(
    ("text", "value", "label"),
    [
        ("brass", 8470.0, "brass"),
        ("Stainless", 7900.0, "stainless steel"),
        ("STAINLESS_STEEL", 7900.0, "stainless steel"),
        ("aluminum", 2700.0, "aluminium"),
        ("nylon", 1130.0, "pa6"),
        ("ABS", 1050.0, "abs"),
        ("7.85 g/cm3", 7850.0, "7.85 g/cm3"),
        ("7.85 g/cm³", 7850.0, "7.85 g/cm³"),
        ("7850kg/m^3", 7850.0, "7850kg/m^3"),
        ("  0.9   g/cm3 ", 900.0, "0.9 g/cm3"),
        ("0.284 lb/in3", 0.284 * 0.45359237 / 0.0254**3, "0.284 lb/in3"),
        ("30 kg/m3", 30.0, "30 kg/m3"),
        (".9 g/cm3", 900.0, ".9 g/cm3"),
    ],
)
def test_density_as_typed(text, value, label):
    found, told = find_density(text)
    assert found == pytest.approx(value, rel=1e-12)
    assert told == label


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("steal", "density: no material is called 'steal' - did you mean steel?"),
        ("alumnium", "density: no material is called 'alumnium' - did you mean aluminium?"),
        ("7.85 kg/m3", "density: '7.85 kg/m3' is the density of no solid - did you mean 7.85 g/cm3?"),
        ("7850 g/cm3", "density: '7850 g/cm3' is the density of no solid - did you mean 7850 kg/m3?"),
        ("0 g/cm3", "density: must be above 0 - e.g. 7.85 g/cm3"),
        ("0", "density: must be above 0 - e.g. 7.85 g/cm3"),
        ("-7.85 g/cm3", "density: must be above 0 - e.g. 7.85 g/cm3"),
        ("100 g/cm3", "density: '100 g/cm3' is the density of no solid - did you mean 100 kg/m3?"),
        ("7.85", "density: '7.85' has no unit - write 7.85 g/cm3"),
        ("7850", "density: '7850' has no unit - write 7850 kg/m3"),
        ("7,85 g/cm3", "density: '7,85 g/cm3' has a comma - write 7.85"),
        ("7.85 mm", "density: '7.85 mm' is a length, not a density - give it in g/cm3"),
    ],
)
def test_density_that_cannot_be(text, line):
    assert refused(text).startswith(line)
    assert "\n" not in refused(text)


@pytest.mark.parametrize("text", ["", "  ", "wood"])
def test_unknown_material_lists_the_known(text):
    line = refused(text)
    assert line.startswith(f"density: no material is called '{text.strip()}' - give a value, as in ")
    assert all(material.name in line for material in MATERIALS)


def test_the_table_is_sound():
    names = [name for material in MATERIALS for name in (material.name, *material.aliases)]
    assert len(names) == len(set(names))
    for material in MATERIALS:
        assert LIGHTEST_SOLID_KG_M3 < material.density < HEAVIEST_SOLID_KG_M3
        assert material.source
        assert material.name == material.name.lower()
        assert find_density(material.name) == (material.density, material.name)
