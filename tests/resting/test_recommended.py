"""The recommended answer and its interval."""

import numpy as np
import pytest
import shapes
from drop_bodies import cuboids

from feederscrew.dropping import ensemble
from feederscrew.resting.aspects import find
from feederscrew.resting.rules import recommended

BOTH = np.array([True, True])


def tally(faces, energies):
    """Counts of drops that ended on the faces given, launched with the energies given."""
    drops = ensemble.Drops(np.array(faces), np.zeros(len(faces)), np.array(energies, float), False)
    return ensemble.tally(drops, np.array([0, 1]), 2)


def test_the_closed_form_spans_all_answers_and_the_models_error():
    p, other = np.array([0.7, 0.3]), np.array([0.5, 0.5])
    found = recommended.closed_form("surface, hard", p, [other], BOTH)
    assert found.rule == "surface, hard" and found.p.tolist() == p.tolist()
    assert found.low == pytest.approx([0.5 - recommended.MODEL, 0.3 - recommended.MODEL])
    assert found.high == pytest.approx([0.7 + recommended.MODEL, 0.5 + recommended.MODEL])


def test_the_ends_stay_shares():
    found = recommended.closed_form("surface, hard", np.array([0.98, 0.02]), [], BOTH)
    assert found.high[0] == 1.0 and found.low[1] == 0.0


def test_what_the_part_rolls_off_is_not_in_doubt():
    found = recommended.closed_form(
        "surface, hard", np.array([0.6, 0.4, 0.0]), [], np.array([True, True, False])
    )
    assert (found.low[2], found.high[2]) == (0.0, 0.0)


def test_a_part_with_one_class_is_certain():
    found = recommended.closed_form("surface, hard", np.array([1.0]), [], np.array([True]))
    assert (found.low[0], found.high[0]) == (1.0, 1.0)


def test_a_drop_test_spans_gentle_and_violent_launches():
    faces = [0] * 300 + [1] * 300 + [0, 1] * 150  # gentle ones on 0, middle ones on 1, violent ones on both
    counted = tally(faces, range(900))
    found = recommended.dropped(counted, BOTH)
    assert found.rule == f"drop, {recommended.LAUNCH}"
    assert found.p == pytest.approx([0.5, 0.5])
    assert found.high == pytest.approx([1.0, counted.high[1] + recommended.MODEL])
    assert found.low == pytest.approx([counted.low[0] - recommended.MODEL, 0.0])


@pytest.mark.parametrize(("exponent", "name"), [(2.0, "hard"), (0.0, "soft"), (1.5, "exponent 1.5")])
def test_the_answer_of_a_part_says_its_rule(exponent, name):
    found = find(shapes.part(shapes.box(4.0, 7.0, 11.0)), exponent=exponent)
    answer = found.recommended
    assert answer.rule == f"surface, {name}"
    assert answer.p.tolist() == found.probabilities["surface"].tolist()
    for rule in ("quasistatic", "hops", "surface"):
        assert (answer.low <= found.probabilities[rule]).all()
        assert (answer.high >= found.probabilities[rule]).all()


def test_measured_tosses_fall_inside():
    for x, measured, tosses in cuboids():
        found = find(shapes.part(shapes.box(10.0 * x, 10.0, 10.0)))
        row = int(np.argmin(np.abs(1e3 * found.heights - 5.0 * x)))
        slack = 2.0 * np.sqrt(measured * (1.0 - measured) / tosses)
        assert found.recommended.low[row] - slack < measured < found.recommended.high[row] + slack
