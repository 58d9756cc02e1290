"""The published rules as formulas."""

import numpy as np
import pytest

from feederscrew.resting.rules import formulas

RULES = (formulas.pmi, formulas.csa, formulas.stability)


def test_each_rule_divides_its_quantity_by_the_height():
    """Eqs. [section 3.1], [Table 3-2], [Table 3-3]."""
    faces, height = np.array([1, 2]), np.array([2.0, 5.0])
    for rule in RULES:
        np.testing.assert_allclose(rule(faces, np.array([3.0, 4.0]), height), [1.5, 1.6])


def test_unstable_aspects_are_left_out_and_the_rest_renormalised():
    got = formulas.normalised(np.array([3.0, 9.0, 1.0]), np.array([True, False, True]))
    assert got.tolist() == [0.75, 0.0, 0.25]


def test_an_unknown_weight_leaves_no_probability():
    assert np.isnan(formulas.normalised(np.array([3.0, np.nan]), np.array([True, True]))).all()
    assert np.isnan(formulas.normalised(np.zeros(2), np.array([True, True]))).all()  # without a warning


@pytest.mark.parametrize("rule", RULES)
def test_every_rule_names_its_source(rule):
    text = rule.__doc__
    assert "Source:" in text or "thesis" in text
