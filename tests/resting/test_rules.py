"""Rules of probability: formulas as published, the registry that lists them, and the cascade of hops."""

import dataclasses
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from feederscrew.output import style, tables
from feederscrew.part import load
from feederscrew.resting import profiles
from feederscrew.resting.aspects import find
from feederscrew.resting.barriers import Tipping
from feederscrew.resting.rules import formulas, registry
from feederscrew.resting.rules.formulas import KEPT_ENERGY_EXPONENT, hop_shares
from feederscrew.resting.rules.registry import ClassQuantities

BRACKET = Path(__file__).parents[2] / "parts/lbracket_30x20x15.stl"
SHARES, HEIGHTS, TOPS = np.array([0.5, 0.3, 0.2]), np.array([0.3, 0.45, 0.6]), np.array([0.62, 0.8])
WAYS = np.array([[0, 1], [1, 2]])


@pytest.mark.parametrize("rule", [formulas.pmi, formulas.csa, formulas.stability])
def test_each_rule_divides_its_quantity_by_the_height(rule):
    """Eqs. [section 3.1], [Table 3-2], [Table 3-3]."""
    weights = rule(np.array([1, 2]), np.array([3.0, 4.0]), np.array([2.0, 5.0]))
    np.testing.assert_allclose(weights, [1.5, 1.6])
    assert "Source:" in rule.__doc__ or "thesis" in rule.__doc__


def test_unstable_aspects_are_left_out_and_an_unknown_weight_leaves_no_probability():
    shares = formulas.normalised(np.array([3.0, 9.0, 1.0]), np.array([True, False, True]))
    assert shares.tolist() == [0.75, 0.0, 0.25]
    for weights in (np.array([3.0, np.nan]), np.zeros(2)):  # without a warning
        assert np.isnan(formulas.normalised(weights, np.array([True, True]))).all()


def test_a_rule_needs_quantities_of_its_kind_and_names_its_source():
    assert (
        len({r.name for r in registry.RULES})
        == len({r.colour for r in registry.RULES})
        == len(registry.RULES)
    )
    for rule in registry.RULES:
        assert set(rule.needs) <= set(rule.of.__dataclass_fields__)
        assert rule.reference and rule.weights.__doc__
        assert style.method(rule.name) == (rule.label, rule.colour)


def test_a_part_has_a_probability_by_every_rule_and_one_entry_adds_a_rule_everywhere(monkeypatch):
    resting = find(load(BRACKET))
    assert tuple(resting.probabilities) == registry.RULE_NAMES
    assert tuple(resting.chances) == registry.CHOICES
    assert [profile.name.lower() for profile in profiles.of_rules(resting)] == list(registry.RULE_NAMES)
    lowest = replace(
        registry.RULES[0], name="low", label="LOW", colour="#123456", of=ClassQuantities, needs=("heights",),
        weights=lambda heights: 1.0 / heights,
    )  # fmt: skip
    monkeypatch.setattr(registry, "RULES", (*registry.RULES, lowest))
    monkeypatch.setitem(registry.RULE_OF, "low", lowest)
    resting = find(load(BRACKET))
    weights = 1.0 / resting.heights
    np.testing.assert_allclose(resting.probabilities["low"], weights / weights.sum(), rtol=1e-12)
    assert style.method("low") == ("LOW", "#123456")
    assert tables.heading("p_low") == ("LOW", "[%]")


def tipping(shares=SHARES, heights=HEIGHTS, tops=TOPS):
    """A chain of faces, each tipping into the next."""
    return Tipping(np.array(shares), np.array(heights), WAYS, np.array(tops), np.zeros((2, 3)), ())


def walked(tips, count, rng):
    """Shares of walkers that hop one by one, energies drawn without any levels."""
    ended = np.zeros(len(tips.shares))
    neighbours = {k: [] for k in range(len(ended))}
    for (first, second), top in zip(tips.pairs, tips.tops):
        neighbours[first].append((second, top))
        neighbours[second].append((first, top))
    for face in rng.choice(len(ended), size=count, p=tips.shares):
        energy = 1.0
        while True:
            depth = energy - tips.heights
            ways = [(face, tips.shares[face] * depth[face])]
            ways += [
                (other, tips.shares[other] * depth[other] * (energy - top) / depth[face])
                for other, top in neighbours[face]
                if top < energy
            ]
            weights = np.array([weight for _, weight in ways])
            face = ways[rng.choice(len(ways), p=weights / weights.sum())][0]
            kept = rng.random() ** (1.0 / KEPT_ENERGY_EXPONENT)
            energy = tips.heights[face] + (energy - tips.heights[face]) * kept
            if all(top >= energy for _, top in neighbours[face]):
                break
        ended[face] += 1
    return ended / count


def test_hops_are_what_walkers_do():
    count = 6000
    walks, exact = walked(tipping(), count, np.random.default_rng(8)), hop_shares(tipping(), 1.0)
    assert np.abs(walks - exact).max() < 4.0 * np.sqrt(0.25 / count)
    assert exact[0] > SHARES[0] + 0.05 and exact[2] < SHARES[2]  # a deep face gains
    easier = dataclasses.replace(tipping(), tops=np.array([0.62, 0.65]))
    assert hop_shares(easier, 1.0)[2] < exact[2]  # and a lower saddle helps


def test_units_cancel_and_faces_keep_their_place():
    exact = hop_shares(tipping(), 1.0)
    assert hop_shares(tipping(heights=1e-3 * HEIGHTS, tops=1e-3 * TOPS), 1e-3) == pytest.approx(
        exact, rel=1e-9
    )
    turned = tipping(SHARES[::-1], HEIGHTS[::-1], TOPS[::-1])
    assert hop_shares(turned, 1.0)[::-1] == pytest.approx(exact, rel=1e-9)
    empty = tipping([*SHARES, 0.0], [*HEIGHTS, np.nan])  # a face without a sink
    assert hop_shares(empty, 1.0).tolist() == [*exact, 0.0]
