"""The recommended answer and its interval."""

import numpy as np
import pytest
import shapes
from drop_bodies import cuboids

from feederscrew.dropping import ensemble
from feederscrew.resting.aspects import find
from feederscrew.resting.rules import recommended, registry
from feederscrew.studies.aspects import aspects

BOTH = np.array([True, True])


def tally(faces, energies):
    """Counts of drops that ended on the faces given, launched with the energies given."""
    drops = ensemble.Drops(
        np.array(faces), np.zeros(len(faces)), np.array(energies, float), np.zeros(len(faces)), False
    )
    return ensemble.tally(drops, np.array([0, 1]), 2)


FLAT = ("flat", "flat")


def chances(p, **others):
    """Probabilities by every rule: p, but for those given."""
    return dict.fromkeys(registry.RULE_NAMES, np.array(p)) | {k: np.array(q) for k, q in others.items()}


def test_the_answer_names_its_rule_and_its_launch():
    known = chances([0.5, 0.5], quasistatic=[0.4, 0.6], hops=[0.9, 0.1])
    found = recommended.closed_form(known, BOTH, FLAT, "drop")
    assert (found.rule, found.launch) == ("tempered hops, launch drop", "drop")
    rules = {one: recommended.closed_form(known, BOTH, FLAT, one).rule for one in ("place", "roll")}
    assert rules == {"place": "quasi-static, launch place", "roll": "hops, launch roll"}


def test_tempered_hops_lead_from_dead_landings_to_hops():
    known = {"quasistatic": np.array([0.2, 0.8, 0.0]), "hops": np.array([0.8, 0.2, 0.0])}
    assert recommended.tempered(known, 0.0)[1].tolist() == [0.2, 0.8, 0.0]
    assert recommended.tempered(known, 0.5)[1].tolist() == pytest.approx([0.5, 0.5, 0.0])
    assert recommended.tempered(known, 1.0)[1].tolist() == [0.8, 0.2, 0.0]


@pytest.mark.parametrize("launch", recommended.LAUNCH_NAMES)
@pytest.mark.parametrize("kinds", [FLAT, ("flat", "rolling")])
def test_every_launch_has_an_interval_that_is_widest_at_a_half(launch, kinds):
    found = recommended.closed_form(chances([0.5, 0.5]), BOTH, kinds, launch)
    small = recommended.closed_form(chances([0.05, 0.95]), BOTH, kinds, launch)
    width = recommended.SHARE_WIDTHS[launch, "rolling" in kinds]
    assert found.high - found.p == pytest.approx(np.minimum(width, 0.5))
    assert (small.high - small.low < found.high - found.low).all()


def test_the_users_own_surface_is_the_answer_whatever_the_launch():
    found = recommended.closed_form(chances([0.7, 0.3], surface=[0.4, 0.6]), BOTH, FLAT, "flip", "soft")
    assert found.rule == "surface, soft, launch flip" and found.p.tolist() == [0.4, 0.6]


def test_what_the_part_rolls_off_is_not_in_doubt():
    stable = np.array([True, True, False])
    found = recommended.closed_form(chances([0.6, 0.4, 0.0]), stable, (*FLAT, "flat"), "feed")
    assert (found.low[2], found.high[2]) == (0.0, 0.0)


def test_a_drop_test_holds_its_sampling():
    faces = [0] * 300 + [1] * 300 + [0, 1] * 150  # gentle ones on 0, middle ones on 1, violent ones on both
    counted = tally(faces, range(900))
    found = recommended.dropped(counted, "flip")
    assert (found.rule, found.launch) == ("drop test, launch flip", "flip")
    assert found.p == pytest.approx([0.5, 0.5])
    sampling, _ = ensemble.wilson(np.array([450, 450]), 900)
    assert found.low == pytest.approx(
        0.5 - np.sqrt((0.5 - sampling) ** 2 + ensemble.NUMERICAL_SHARE_ERROR**2 + recommended.LAUNCH_WIDTH**2)
    )
    assert found.high == pytest.approx(1.0 - found.low)


@pytest.mark.parametrize(("exponent", "name"), [(2.0, "hard"), (0.0, "soft"), (1.5, "exponent 1.5")])
def test_the_answer_of_a_part_says_its_rule(exponent, name):
    found = find(shapes.part(shapes.box(4.0, 7.0, 11.0)), exponent=exponent)
    answer = found.recommended
    assert answer.rule == f"surface, {name}, launch feed"
    assert answer.p.tolist() == found.probabilities["surface"].tolist()


def test_measured_tosses_fall_inside():
    """In the intervals of the closed form and of the drop test: all but one at most."""
    held = np.zeros(2, int)
    for x, measured, tosses in cuboids():
        study = aspects(shapes.part(shapes.box(10.0 * x, 10.0, 10.0)), launch="roll", drops=1000)
        row = int(np.argmin(np.abs(1e3 * study.aspects.heights - 5.0 * x)))
        slack = 2.0 * np.sqrt(measured * (1.0 - measured) / tosses)
        for k, found in enumerate((study.aspects.closed, study.tally)):
            held[k] += found.low[row] - slack < measured < found.high[row] + slack
    assert (held >= 7).all()
