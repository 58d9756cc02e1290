"""Rules of probability: formulas as published, the registry, the cascade of hops, the recommended answer."""

import dataclasses
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import shapes
from drop_bodies import cuboids

from feederscrew.arrivals import ensemble
from feederscrew.arrivals.aspects_study import aspects
from feederscrew.output import style
from feederscrew.part import load
from feederscrew.resting import profiles
from feederscrew.resting.aspects import find
from feederscrew.resting.barriers import Tipping
from feederscrew.resting.calibration import HIGHEST, calibrate
from feederscrew.resting.rules import formulas, recommended, registry
from feederscrew.resting.rules.formulas import EXPONENTS, hop_shares, surface_shares, surface_weights
from feederscrew.resting.rules.registry import ClassQuantities

BRACKET = Path(__file__).parents[2] / "parts/lbracket_30x20x15.stl"
SHARES, HEIGHTS, TOPS = np.array([0.5, 0.3, 0.2]), np.array([0.3, 0.45, 0.6]), np.array([0.62, 0.8])
WAYS = np.array([[0, 1], [1, 2]])
FLAT = ("flat", "flat")
FACE_SHARES = np.array([0.5, 0.3, 0.15, 0.05])
FACE_HEIGHTS = np.array([1.0, 1.4, 1.9, 2.5])
BODY = FACE_SHARES, FACE_HEIGHTS, 3.0


@pytest.mark.parametrize("rule", [formulas.pmi, formulas.csa, formulas.stability])
def test_each_rule_divides_its_quantity_by_the_height(rule):
    """Eqs. [section 3.1], [Table 3-2], [Table 3-3]."""
    weights = rule(np.array([1, 2]), np.array([3.0, 4.0]), np.array([2.0, 5.0]))
    np.testing.assert_allclose(weights, [1.5, 1.6])
    assert "References" in rule.__doc__ or "thesis" in rule.__doc__


def test_unstable_aspects_are_left_out_and_an_unknown_weight_leaves_no_probability():
    shares = formulas.normalise(np.array([3.0, 9.0, 1.0]), np.array([True, False, True]))
    assert shares.tolist() == [0.75, 0.0, 0.25]
    for weights in (np.array([3.0, np.nan]), np.zeros(2)):  # without a warning
        assert np.isnan(formulas.normalise(weights, np.array([True, True]))).all()


def test_a_rule_needs_quantities_of_its_kind_and_names_its_source(monkeypatch):
    names, colours = ({getattr(rule, key) for rule in registry.RULES} for key in ("name", "colour"))
    assert len(names) == len(colours) == len(registry.RULES)
    for rule in registry.RULES:
        assert set(rule.needs) <= set(rule.of.__dataclass_fields__)
        assert rule.reference and rule.weights.__doc__
        assert style.method(rule.name) == (rule.label, rule.colour)
    # A part has a probability by every rule, and one entry adds a rule everywhere.
    resting = find(load(BRACKET))
    assert tuple(resting.probabilities) == registry.RULE_NAMES
    assert tuple(resting.chances) == registry.CHOICES
    assert [profile.name.lower() for profile in profiles.rule_profiles(resting)] == list(registry.RULE_NAMES)
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
    assert registry.heading("low") == "LOW"


def tipping(shares=SHARES, heights=HEIGHTS, tops=TOPS):
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
            kept = rng.random() ** (1.0 / formulas.KEPT_ENERGY_EXPONENT)
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
    # Units cancel, and faces keep their place.
    exact = hop_shares(tipping(), 1.0)
    small = tipping(heights=1e-3 * HEIGHTS, tops=1e-3 * TOPS)
    assert hop_shares(small, 1e-3) == pytest.approx(exact, rel=1e-9)
    turned = tipping(SHARES[::-1], HEIGHTS[::-1], TOPS[::-1])
    assert hop_shares(turned, 1.0)[::-1] == pytest.approx(exact, rel=1e-9)
    empty = tipping([*SHARES, 0.0], [*HEIGHTS, np.nan])  # a face without a sink
    assert hop_shares(empty, 1.0).tolist() == [*exact, 0.0]


def closed(p, launch, kinds=FLAT, own=None, stable=(True, True), **others):
    """The answer where probabilities by every rule are p, but for those given."""
    chances = dict.fromkeys(registry.RULE_NAMES, np.array(p)) | {k: np.array(q) for k, q in others.items()}
    return recommended.closed_form(chances, np.array(stable), kinds, launch, *([own] if own else []))


@pytest.mark.parametrize(
    ("launch", "surface", "rule", "p"),
    [
        ("drop", None, "tempered hops, launch drop", None),
        ("place", None, "quasi-static, launch place", [0.4, 0.6]),
        ("roll", None, "hops, launch roll", [0.9, 0.1]),
        ("flip", "soft", "surface, soft, launch flip", [0.2, 0.8]),  # the user's own, whatever the launch
    ],
)
def test_the_answer_names_its_rule_and_its_launch(launch, surface, rule, p):
    rules = {"quasistatic": [0.4, 0.6], "hops": [0.9, 0.1], "surface": [0.2, 0.8]}
    answer = closed([0.5, 0.5], launch, own=surface, **rules)
    assert (answer.rule, answer.launch) == (rule, launch)
    assert p is None or answer.p.tolist() == p


def test_tempered_hops_and_what_the_part_rolls_off():
    chances = {"quasistatic": np.array([0.2, 0.8, 0.0]), "hops": np.array([0.8, 0.2, 0.0])}
    for share, p in ((0.0, [0.2, 0.8, 0.0]), (0.5, [0.5, 0.5, 0.0]), (1.0, [0.8, 0.2, 0.0])):
        assert recommended.temper_shares(chances, share)[1] == pytest.approx(p)
    answer = closed([0.6, 0.4, 0.0], "feed", (*FLAT, "flat"), stable=(True, True, False))
    assert (answer.low[2], answer.high[2]) == (0.0, 0.0)


@pytest.mark.parametrize("launch", recommended.LAUNCH_NAMES)
@pytest.mark.parametrize("kinds", [FLAT, ("flat", "rolling")])
def test_every_launch_has_an_interval_that_is_widest_at_a_half(launch, kinds):
    half, small = (closed(p, launch, kinds) for p in ([0.5, 0.5], [0.05, 0.95]))
    width = recommended.SHARE_WIDTHS[launch, "rolling" in kinds]
    assert half.high - half.p == pytest.approx(np.minimum(width, 0.5))
    assert (small.high - small.low < half.high - half.low).all()


def test_a_drop_test_holds_its_sampling():
    faces = [0] * 300 + [1] * 300 + [0, 1] * 150  # gentle ones on 0, middle ones on 1, violent ones on both
    empty = np.zeros(900)
    drops = ensemble.Drops(np.array(faces), empty, np.arange(900.0), empty, False)
    answer = ensemble.tally(drops, np.array([0, 1]), 2).answer("flip")
    assert (answer.rule, answer.launch) == ("drop test, launch flip", "flip")
    assert answer.p == pytest.approx([0.5, 0.5])
    sampling, _ = ensemble.wilson(np.array([450, 450]), 900)
    squares = (0.5 - sampling) ** 2 + ensemble.NUMERICAL_SHARE_ERROR**2 + recommended.LAUNCH_WIDTH**2
    assert answer.low == pytest.approx(0.5 - np.sqrt(squares))
    assert answer.high == pytest.approx(1.0 - answer.low)


def test_measured_tosses_fall_inside():
    """In the intervals of the closed form and of the drop test: all but one at most."""
    held = np.zeros(2, int)
    for x, measured, tosses in cuboids():
        study = aspects(shapes.part(shapes.box(10.0 * x, 10.0, 10.0)), launch="roll", drops=1000)
        row = int(np.argmin(np.abs(1e3 * study.aspects.heights - 5.0 * x)))
        slack = 2.0 * np.sqrt(measured * (1.0 - measured) / tosses)
        for k, answer in enumerate((study.aspects.closed, study.tally)):
            held[k] += answer.low[row] - slack < measured < answer.high[row] + slack
    assert (held >= 7).all()


def test_a_harder_surface_favours_the_deeper_faces():
    """A dead landing is quasi-static, and the weight is the power of the depth."""
    soft, medium, hard = (surface_shares(*BODY, EXPONENTS[name]) for name in ("soft", "medium", "hard"))
    assert soft == pytest.approx(FACE_SHARES)
    assert soft[0] < medium[0] < hard[0]
    assert [medium.sum(), hard.sum()] == pytest.approx([1.0, 1.0])
    weights = surface_weights(*BODY, 2.0)
    assert weights[1] / weights[0] == pytest.approx(0.3 / 0.5 * (1.6 / 2.0) ** 2)


@pytest.mark.parametrize("exponent", [0.0, 0.8, 2.0])
def test_expected_counts_give_their_exponent_back(exponent):
    fit = calibrate(1e5 * surface_shares(*BODY, exponent), *BODY)
    assert fit.exponent == pytest.approx(exponent, abs=1e-5)
    assert fit.low < exponent < fit.high and not fit.reaches_end
    assert fit.chi_square.statistic == pytest.approx(0.0, abs=1e-4)
    assert fit.chi_square.degrees_of_freedom == 2


def test_the_interval_of_an_exponent():
    """Wilks 1938: 3.8415 / 2 for 95 %; it narrows with the root of the counts."""
    counts = np.array([210, 120, 55, 15])
    fit = calibrate(counts, *BODY)
    exponents = (fit.low, fit.exponent, fit.high)
    likelihood = [(counts * np.log(surface_shares(*BODY, exponent))).sum() for exponent in exponents]
    assert np.subtract(likelihood[1], likelihood[::2]) == pytest.approx(3.8415 / 2.0, rel=1e-4)
    few, many = (calibrate(n * surface_shares(*BODY, 1.0), *BODY) for n in (1e3, 1e5))
    assert (few.high - few.low) / (many.high - many.low) == pytest.approx(10.0, rel=0.05)
    fit = calibrate([1000, 0, 0, 0], *BODY)
    assert fit.reaches_end and fit.high == HIGHEST and fit.low > 2.0


@pytest.mark.parametrize(
    ("call", "values", "words"),
    [
        (surface_weights, (FACE_SHARES, FACE_HEIGHTS, 0.0, 1.0), "radius"),
        (surface_weights, (FACE_SHARES, FACE_HEIGHTS, 3.0, np.nan), "exponent"),
        (calibrate, ([1, -1], [0.5, 0.5], [1, 2], 3.0), "negative"),
        (calibrate, ([0, 0], [0.5, 0.5], [1, 2], 3.0), "zero"),
        (calibrate, ([1, 1], [1.0, 0.0], [1, 2], 3.0), "no direction"),
        (calibrate, ([1, 1], [0.5, 0.5], [2, 2], 3.0), "the same"),
        (calibrate, ([1, 1], [0.5, 0.5, 0.0], [1, 2, 3], 3.0), "shape"),
    ],
)
def test_wrong_calls_and_counts_that_say_nothing(call, values, words):
    with pytest.raises(ValueError, match=words):
        call(*values)
