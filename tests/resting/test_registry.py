"""The registry of rules: one entry a rule, and everything else reads it."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from feederscrew.output import style, tables
from feederscrew.part import load
from feederscrew.resting import profiles
from feederscrew.resting.aspects import find
from feederscrew.resting.rules import registry
from feederscrew.resting.rules.registry import ClassQuantities

ROOT = Path(__file__).parent.parent.parent
BRACKET = ROOT / "parts/lbracket_30x20x15.stl"


def test_names_and_colours_are_each_of_one_rule():
    assert (
        len(set(registry.RULE_NAMES)) == len({rule.colour for rule in registry.RULES}) == len(registry.RULES)
    )


@pytest.mark.parametrize("rule", registry.RULES, ids=lambda rule: rule.name)
def test_a_rule_needs_quantities_of_its_kind_and_names_its_source(rule):
    assert set(rule.needs) <= set(rule.of.__dataclass_fields__)
    assert rule.reference
    assert rule.weights.__doc__
    assert style.method(rule.name) == (rule.label, rule.colour)


def test_a_part_has_a_probability_by_every_rule_in_the_order_of_the_registry():
    found = find(load(BRACKET))
    assert tuple(found.probabilities) == registry.RULE_NAMES
    assert tuple(found.chances) == registry.CHOICES
    assert [profile.name.lower() for profile in profiles.of_rules(found)] == list(registry.RULE_NAMES)


def test_one_entry_adds_a_rule_everywhere(monkeypatch):
    lowest = replace(
        registry.RULES[0], name="low", label="LOW", colour="#123456", of=ClassQuantities, needs=("heights",),
        weights=lambda heights: 1.0 / heights,
    )  # fmt: skip
    monkeypatch.setattr(registry, "RULES", (*registry.RULES, lowest))
    monkeypatch.setitem(registry.RULE_OF, "low", lowest)
    found = find(load(BRACKET))
    weights = 1.0 / found.heights
    np.testing.assert_allclose(found.probabilities["low"], weights / weights.sum(), rtol=1e-12)
    assert style.method("low") == ("LOW", "#123456")
    assert tables.heading("p_low") == ("LOW", "[%]")
