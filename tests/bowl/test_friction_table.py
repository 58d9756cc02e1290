"""Friction by lining and material: the table holds where no coefficient is given, and a line says it."""

from dataclasses import replace

import pytest
import shapes

from feederscrew import bowl as bowls
from feederscrew.base.errors import FeederError
from feederscrew.bowl import arguments, friction_table, schema
from feederscrew.bowl.friction_table import FAMILIES, LININGS, Lining, PartMaterial
from feederscrew.part.density import MATERIALS


def bowl(*lines):
    return bowls.record(bowls.settings(None, lines))


def test_without_a_lining_friction_is_as_before_whatever_parts_are_made_of():
    plain = bowls.default().friction
    assert (plain.static, plain.kinetic, plain.wall) == (0.6, 0.6, 0.6)
    assert bowl("friction.part_material=plastic").friction == plain


@pytest.mark.parametrize("lining", LININGS[1:])
def test_the_table_orders_what_slides_as_its_sources_do(lining):
    for family in FAMILIES:
        own = bowl(f"friction.lining={lining}", f"friction.part_material={family}").friction
        row = friction_table.find_friction(family, lining)
        assert (own.static, own.kinetic, own.wall) == (row.static, row.kinetic, row.kinetic) and row.source
        assert 0.0 < row.kinetic <= row.static
        static, kinetic = own.backward
        assert kinetic <= static and static >= own.static  # a brush holds what slides back
        assert (static > own.static) == (lining == "brush")
    plastic, brass = (friction_table.find_friction(one, "steel").static for one in ("plastic", "brass"))
    assert plastic < brass < friction_table.find_friction("steel", "steel").static  # 0.33, 0.51, 0.60
    assert friction_table.find_friction("plastic", "pu").static > plastic


def test_a_coefficient_that_is_given_is_kept():
    own = bowl("friction.lining=pu", "friction.static=0.25").friction
    assert (own.static, own.kinetic, own.backward) == (0.25, 0.25, (0.25, 0.25))
    own = bowl("friction.lining=pu", "friction.wall=0.1").friction
    assert (own.static, own.wall) == (0.7, 0.1)
    with pytest.raises(FeederError, match="is not known"):
        bowl("friction.lining=velvet")


def test_a_part_whose_material_is_known_has_its_own_row(tmp_path):
    part = replace(shapes.part(shapes.box(10.0, 8.0, 5.0)), material="pp")
    steel = bowl("friction.lining=steel")
    assert steel.friction.static == 0.6
    same, in_bowl = arguments.part_in_bowl(part, steel)
    assert same is part and (in_bowl.friction.static, in_bowl.friction.kinetic) == (0.33, 0.27)
    # what the file says of parts goes before, and without a lining nothing changes
    said = bowl("friction.lining=steel", "friction.part_material=brass")
    assert arguments.part_in_bowl(part, said)[1] is said
    plain = bowl("track.bank=3 deg")
    assert arguments.part_in_bowl(part, plain)[1] is plain
    # a bowl file of it reads back as the same bowl
    (tmp_path / "b.yaml").write_text(in_bowl.to_yaml())
    assert bowls.read(tmp_path / "b.yaml").friction == in_bowl.friction


def test_where_friction_is_the_default_a_line_says_what_the_table_has():
    def said(material, *lines):
        return bowls.friction_remarks(bowls.settings(None, lines), material)

    (line,) = said("pp")
    assert "0.33 static and 0.27 kinetic" in line and "--lining steel" in line
    assert said("steel (default)") == said("steel") == said("7.85 g/cm3") == ()
    assert said("pp", "friction.static=0.4") == ()
    settings = bowls.with_part_material(bowls.settings(None, ("friction.lining=pu",)), "brass")
    (line,) = bowls.friction_remarks(settings, "brass")
    assert "0.7 static" in line and "brass on pu" in line and "Gallagher" in line


def test_every_material_that_parts_may_have_is_in_a_family_or_in_none():
    families = {material.name: friction_table.find_family(material.name) for material in MATERIALS}
    assert (
        families["pp"] == families["pa66-gf30"] == PartMaterial.PLASTIC
        and families["bronze"] == PartMaterial.BRASS
    )
    assert families["stainless steel"] == PartMaterial.STEEL and families["neodymium magnet"] is None
    assert set(filter(None, families.values())) == set(PartMaterial)
    assert schema.BY_NAME["friction.lining"].choices == tuple(map(str, Lining))
