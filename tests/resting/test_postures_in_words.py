"""How a part lies, in words, where a person would say it without measuring."""

from pathlib import Path

import numpy as np
import pytest
import shapes

from feederscrew.part import load
from feederscrew.part.hull import convex_hull
from feederscrew.resting.aspects import find, postures

PARTS = Path(__file__).parents[2] / "parts"


def words(part):
    aspects = find(part)
    hull = part.hull or convex_hull(part.vertices, part.centre_of_mass)
    return dict(zip(aspects.names, postures(aspects.normals, aspects.contact_areas, aspects.kinds, hull)))


def test_a_box_lies_flat_on_its_side_and_on_end():
    part = shapes.part(shapes.box(30, 20, 5))
    heights = dict(zip(find(part).names, np.round(2e3 * find(part).heights)))
    said = {heights[name]: text for name, text in words(part).items()}
    assert said == {5.0: "flat (largest face)", 20.0: "on side", 30.0: "on end"}


def test_a_cube_lies_on_a_face():
    assert set(words(shapes.part(shapes.box(10, 10, 10))).values()) == {"on a face"}


def test_a_bolt_lies_flat_and_stands_on_its_head_or_its_tip():
    said = words(load(PARTS / "hexbolt_m8x25.stl"))
    assert said == {"A": "flat", "B": "on end (larger face)", "C": "on end (smaller face)"}


@pytest.mark.parametrize("length", [20.0, 3.0])
def test_a_cylinder_rolls_on_its_side(length):
    said = words(shapes.part(shapes.cylinder(5.0, length, 48)))
    assert "on side (rolls)" in said.values()
    assert ("on end" in said.values()) == (length > 10.0)


def test_words_do_not_depend_on_the_axes_of_the_file(rng):
    mesh = shapes.prism(shapes.l_profile(), 15.0)
    assert words(shapes.part(mesh)) == words(shapes.part(shapes.turned(mesh, rng)))
