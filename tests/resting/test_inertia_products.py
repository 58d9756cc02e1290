"""Products of inertia in the PMI rule, against closed forms of a plane tensor and of Table 3-8's T."""

from dataclasses import replace

import numpy as np
import pytest
import shapes
from command_lines import BRACKET

from feederscrew.part import load
from feederscrew.resting.aspects import find
from feederscrew.resting.inertia_products import find_products
from feederscrew.thesis.parts import t_part


def test_a_part_that_is_symmetric_about_its_normals_has_none():
    part = shapes.part(shapes.box(30, 20, 5))
    aspects = find(part)
    off = find_products(aspects, part.inertia)
    assert off.products == pytest.approx(0.0, abs=1e-12 * aspects.polar_inertias.max())
    assert off.probabilities == pytest.approx(aspects.probabilities["pmi"], rel=1e-12)
    assert off.largest_change(aspects) == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("product", [0.3, -0.3])
def test_a_tensor_with_one_product_by_hand(product):
    """Mohr's circle: principal moments (a + b) / 2 +- hypot((a - b) / 2, p)."""
    a, b, c, p = 2.0, 3.0, 4.5, product
    aspects = find(shapes.part(shapes.box(30, 20, 5)))
    off = find_products(aspects, np.array([[a, -p, 0.0], [-p, b, 0.0], [0.0, 0.0, c]]))
    middle, radius = 0.5 * (a + b), np.hypot(0.5 * (a - b), p)
    for k, normal in enumerate(np.abs(aspects.normals)):
        axis = int(normal.argmax())
        assert off.products[k] == pytest.approx((abs(p), abs(p), 0.0)[axis])
        assert off.principal[k] == pytest.approx((middle - radius, middle + radius, c)[axis])
    along = np.array([a, b, c])[np.abs(aspects.normals).argmax(axis=1)]
    weights = aspects.probabilities["pmi"] * off.principal / along
    assert off.probabilities == pytest.approx(weights / weights.sum())


def test_a_normal_in_a_plane_of_equal_moments_is_principal():
    """Of a bolt every radius is an axis: the one that is nearest has the moment of all of them."""
    aspects = find(shapes.part(shapes.box(30, 20, 5)))
    turn = np.array([[0.6, 0.8, 0.0], [-0.8, 0.6, 0.0], [0.0, 0.0, 1.0]])
    off = find_products(aspects, turn @ np.diag([2.0, 2.0, 5.0]) @ turn.T)
    assert off.principal[np.abs(aspects.normals[:, 2]) < 0.5] == pytest.approx(2.0)


def test_of_the_t_only_the_leaning_aspect_changes():
    """Table 3-8 has it as D; its plane of symmetry has the products of both other aspects."""
    part = t_part(0.6)
    aspects = find(part, as_published=True)
    off = find_products(aspects, part.inertia)
    leaning = np.abs(aspects.normals).max(axis=1) < 0.999
    assert leaning.sum() == 1 and (off.products[leaning] > 0.0).all()
    assert off.products[~leaning] == pytest.approx(0.0, abs=1e-9 * aspects.polar_inertias.max())
    assert off.principal[~leaning] == pytest.approx(aspects.polar_inertias[~leaning])
    assert off.largest_change(aspects) == pytest.approx(0.0031, abs=1e-4)


def test_a_turned_file_has_the_same_ones_and_the_table_shows_them(run_json, rng):
    part = load(BRACKET)
    aspects = find(part)
    off = find_products(aspects, part.inertia)
    turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    turned = replace(aspects, normals=aspects.normals @ turn.T)
    same = find_products(turned, turn @ part.inertia @ turn.T)
    assert same.products == pytest.approx(off.products, abs=1e-9 * off.products.max())
    assert same.probabilities == pytest.approx(off.probabilities)
    rows = run_json("aspects", BRACKET, "--rule", "closed")["aspects"]
    assert [row["p_pmi_principal"] for row in rows] == pytest.approx(off.probabilities)
    assert max(abs(row["p_pmi_principal"] - row["p_pmi"]) for row in rows) == pytest.approx(0.0303, abs=1e-4)
