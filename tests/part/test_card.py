"""Part cards: the shipped ones as printed, each fault with its line and column; densities as typed."""

import csv
from pathlib import Path

import numpy as np
import pytest
from readings import loaded

from feederscrew.base.errors import ConfigError, FeederError
from feederscrew.part import load
from feederscrew.part.density import HEAVIEST_SOLID_KG_M3, LIGHTEST_SOLID_KG_M3, MATERIALS, find_density

PARTS = Path(__file__).parents[2] / "parts"
TABLES = PARTS.parent / "feederscrew" / "thesis" / "data"
G_MM2, MM, MM2 = 1e-9, 1e-3, 1e-6

ASYMMETRIC = "the inertia matrix is not symmetric (signs differ): its upper half is used"
GOOD = """\
mass: 2 g
centre_of_mass: [1 mm, 2 mm, 3 mm]
inertia:
  - [30 g mm2, 1 g mm2, 0 g mm2]
  - [1 g mm2, 40 g mm2, 0 g mm2]
  - [0 g mm2, 0 g mm2, 50 g mm2]
aspects:
  - {aspect: 1, height: 4 mm, polar_inertia: 30 g mm2}
  - {aspect: top, height: 5 mm, faces: 2, contact_area: 7 mm2, solid_angle: 1.5 sr}
floor: {aspect: top, drive_offset: -1 mm}
"""
NO_BODY = "no body has the principal moments {} g mm2 - the largest must not exceed the sum of the others"
FLOOR = "floor: {aspect: top, drive_offset: -1 mm}"
PUBLISHED = {"arc_chute": ("3_10", "3_02", "3_03"), "magnet": ("3_11", "3_05", "3_06")}
MATRICES = {  # mass [kg], centre of mass [m], inertia [g mm2], as printed
    "arc_chute": (1.982e-3, [3.3104e-3, 0.0, 8.9961e-3],
                  [[95.32, 0, -24.48], [0, 109.57, 0], [-24.48, 0, 114.75]]),
    "magnet": (4.63e-3, [2.16e-3, 2.66e-3, 25.68e-3],
               [[755.91, 10.91, 0], [10.91, 755.09, 0], [0, 0, 49.92]]),
}  # fmt: skip
BARE = (("7.85", "g/cm3"), ("7850", "kg/m3"))
NO_MATERIAL, NO_SOLID = "no material is called '{}' - ", "'{}' is the density of no solid - did you mean {}?"


def test_a_card_in_si_units():
    part = loaded(GOOD)
    assert (part.mass, part.units, part.material) == (pytest.approx(2e-3), "mm", "part card")
    assert (part.density, part.volume, part.vertices, part.faces, part.hull) == (None,) * 5
    np.testing.assert_allclose(part.centre_of_mass, [1e-3, 2e-3, 3e-3])
    np.testing.assert_allclose(part.inertia, np.array([[30, 1, 0], [1, 40, 0], [0, 0, 50]]) * G_MM2)
    first, second = part.aspects
    assert (first.name, first.faces, first.contact_area, first.csa_height) == ("1", 1, None, None)
    assert (first.height, first.polar_inertia) == pytest.approx((4 * MM, 30 * G_MM2))
    assert (second.name, second.faces, second.contact_area) == ("top", 2, pytest.approx(7 * MM2))
    assert (second.solid_angle, second.solid_angle_in_sr) == (1.5, True)
    assert part.printed == {"floor": {"aspect": "top", "drive_offset": -1e-3}}
    assert (part.warnings, part.open_surface) == ((), False)


@pytest.mark.parametrize(
    ("old", "new", "lines"),
    [
        ("mass: 2 g", "mas: 2 g", ["1:1: unknown key 'mas' - did you mean mass?"]),
        ("mass: 2 g", "mass: -2 g", ["1:7: mass is -2 g - give more than zero"]),
        ("mass: 2 g", "mass: 2e300 g", [
            "1:7: mass is 2e300 g, which no fed part has - check its digits and its unit, as in 1.98 g"]),
        ("mass: 2 g", "mass:", ["1:6: mass has no value - write 1.98 g"]),
        ("mass: 2 g", "mass: 2 g\nmass: 3 g", ["2:1: key 'mass' is already in line 1 - keep one of them"]),
        ("[1 mm, 2 mm, 3 mm]", "[1 mm, 2 mm]", [
            "2:17: centre_of_mass is not a list of 3 - write [3.3 mm, 0 mm, 9 mm]"]),
        ("[1 mm, 2 mm, 3 mm]", "[1 mm, 2, 3 mm]", ["2:24: centre_of_mass: '2' has no unit - write 2 mm"]),
        ("[1 g mm2, 40", "[2 g mm2, 40", [
            "4:3: the inertia matrix is not symmetric - make its halves equal"]),
        ("50 g mm2", "90 g mm2", ["4:3: " + NO_BODY.format("29.9, 40.1, 90")]),
        ("50 g mm2", "-50 g mm2", ["4:3: " + NO_BODY.format("-50, 29.9, 40.1")]),
        ("height: 4 mm", "heigth: 4 mm", [
            "8:5: without height - add height: 6.9 mm",
            "8:17: unknown key 'heigth' - did you mean height?"]),
        ("aspect: top, height", "aspect: 1, height", [
            "9:5: aspect '1' is already in line 8 - keep one of them",
            "10:17: floor: the card lists no aspect 'top' - known are 1, 1"]),
        ("faces: 2", "faces: 1.5", ["9:40: faces is 1.5 - give a whole number"]),
        ("faces: 2", "faces: 2 mm", [
            "9:40: faces: '2 mm' has a unit, and this is a plain number - write the number alone"]),
        ("floor: {aspect: top", "floor: {aspect: 7", [
            "10:17: floor: the card lists no aspect '7' - known are 1, top"]),
        (FLOOR, "track: {axes: askew}", ["10:15: axes is 'askew' - give tilted or level"]),
        (FLOOR, "floor: 3", [
            "10:8: is not a block of 'key: value' lines"
            " - give it aspect, drive_offset, centroid_height, polar_inertia"]),
        (GOOD, "- mass: 2 g\n", [
            "1:1: no 'key: value' line - write mass, centre_of_mass, inertia, aspects"]),
        (GOOD, "mass: 2 g\n", [
            "1:1: without centre_of_mass and inertia and aspects - add centre_of_mass: ["]),
        (GOOD, "mass: [2 g\n", ["2:1: is not YAML (expected ',' or ']', but got '<stream end>') - "]),
    ],
)  # fmt: skip
def test_fault_in_a_card(tmp_path, old, new, lines):
    assert old in GOOD
    path = tmp_path / "card.yaml"
    path.write_text(GOOD.replace(old, new, 1))
    with pytest.raises(FeederError) as error:
        load(path)
    texts = [text.removeprefix(f"{path}:") for text in error.value.lines]
    assert [text[: len(line)] for text, line in zip(texts, lines)] == lines if old == GOOD else texts == lines


@pytest.mark.parametrize(
    ("option", "value"), [("units", "mm"), ("density", "steel"), ("centre_of_mass", "0,0,0")]
)
def test_a_card_has_its_own(option, value):
    with pytest.raises(FeederError) as error:
        load(PARTS / "magnet.yaml", **{option: value})
    assert str(error.value) == f"{option}: a part card has its own - leave it out"


@pytest.mark.parametrize("name", PUBLISHED)
def test_shipped_card_has_the_published_tables(name):
    tables = []
    for number in PUBLISHED[name]:
        lines = (TABLES / f"table_{number}.csv").read_text().splitlines()
        rows = csv.DictReader(line for line in lines if not line.startswith("#"))
        tables.append([row for row in rows if row["aspect"] != "total"])
    aspects = load(PARTS / f"{name}.yaml").aspects
    assert [aspect.name for aspect in aspects] == [row["aspect"] for row in tables[0]]
    for aspect, pmi, csa, stability in zip(aspects, *tables):
        lengths = (aspect.height / MM, aspect.csa_height / MM, aspect.stability_height / MM)
        printed = [float(row["h"]) for row in (pmi, csa, stability)]
        assert lengths == pytest.approx(printed, rel=1e-12)
        others = (aspect.polar_inertia / G_MM2, aspect.contact_area / MM2)
        assert others == pytest.approx((float(pmi["I"]), float(stability["A"])), rel=1e-12)
        assert (aspect.solid_angle, aspect.solid_angle_in_sr, aspect.faces) == (float(csa["Q"]), False, 1)


@pytest.mark.parametrize("name", MATRICES)
def test_shipped_card_as_printed(name):
    path = PARTS / f"{name}.yaml"
    part, (mass, centre, inertia) = load(path), MATRICES[name]
    assert part.mass == pytest.approx(mass)
    np.testing.assert_allclose(part.centre_of_mass, centre)
    np.testing.assert_allclose(part.inertia, np.array(inertia) * G_MM2)
    floor, track = part.printed["floor"], part.printed["track"]
    if name == "magnet":
        assert part.warnings == (f"{path}:14:3: {ASYMMETRIC}",)
        assert floor["polar_inertia"] == pytest.approx(755.91e-9)
        assert track["wall_x"] == pytest.approx((24.55e-3, 23.85e-3))
        return
    assert part.warnings == ()
    assert floor == pytest.approx(
        {"aspect": "5", "drive_offset": 3.15e-3, "centroid_height": 3.31e-3, "polar_inertia": 95.32e-9}
    )
    assert {key: track[key] for key in floor} == pytest.approx(floor)
    assert (track["wall_lever"], track["wall_lever_angle"]) == pytest.approx((8.01e-3, np.radians(64.22)))
    assert track["wall_x"] == pytest.approx((6.7e-3, 8.99e-3))
    assert (track["wall_y"], track["wall_friction_y"]) == pytest.approx((4.05e-3, 4.01e-3))


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
    assert all(LIGHTEST_SOLID_KG_M3 < one.density < HEAVIEST_SOLID_KG_M3 and one.source for one in MATERIALS)
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
