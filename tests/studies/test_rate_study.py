"""The study of the rate: which orientation it is of, where none is asked for."""

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
import shapes

from feederscrew import bowl as bowls
from feederscrew import load, read_bowl
from feederscrew.rates import drive_settings
from feederscrew.resting.aspects import find
from feederscrew.studies import rate as rates
from feederscrew.studies.rate import Shares, most_frequent, rate, shares
from feederscrew.studies.tune import tune

PARTS = Path(__file__).parents[2] / "parts"


def test_the_rate_is_of_the_orientation_that_leaves_most_often():
    known = SimpleNamespace(
        aspects=("A", "A", "B"),
        headings=np.array([0.0, 1.0, 2.0]),
        leaving=np.diag([0.0, 1.0, 1.0]),
        leaves_as=np.arange(3),
        rules={"pmi": np.array([0.6, 0.1, 0.3]), "csa": np.array([np.nan, np.nan, np.nan])},
    )
    assert most_frequent(known, "pmi") == ("B", 2.0)  # 0.6 never passes
    assert most_frequent(known, "csa") == ("A", 0.0)


def test_no_other_orientation_has_a_higher_rate():
    """A along the wall takes more of the track than A across it, and leaves more often all the same."""
    part, bowl = load(PARTS / "lbracket_30x20x15.stl"), read_bowl()
    chosen = rate(part, bowl).rate
    across = rate(part, bowl, "A", heading=np.pi / 2.0).rate
    assert chosen.orientations.aspects[chosen.row] == "A"
    assert chosen.efficiency > 1.5 * across.efficiency


@pytest.mark.parametrize(("first", "fed"), [(0.45, [400]), (0.36, [400, None])])
def test_few_parts_show_the_likeliest_aspect_where_its_share_is_clear(monkeypatch, first, fed):
    """Intervals of 400 parts reach 0.05 to either side (Wilson): 0.45 is clear of 0.33, 0.36 is not."""
    part, counts = load(PARTS / "lbracket_30x20x15.stl"), []
    at_rest = find(part)
    p = np.zeros(len(at_rest.names))
    p[:3] = first, 0.33, 0.67 - first
    answer = replace(at_rest, recommended=replace(at_rest.recommended, p=p))

    def shares(part, bowl, *, fed=None, **_):
        counts.append(fed)
        return rates.Shares(answer, fed=True)

    monkeypatch.setattr(rates, "shares", shares)
    monkeypatch.setattr("feederscrew.dropping.arrival.MAX_ARRIVALS", 4000)  # tests feed fewer
    assert rates.likeliest(part, read_bowl()).likeliest == at_rest.names[0]
    assert counts == fed


BOWL = bowls.read(
    None, ("drive.frequency=50 Hz", "drive.amplitude=0.12 mm", "restitution=0", "friction.static=0.4")
)


TARGET = 0.2


@pytest.fixture(scope="module")
def block():
    return shapes.part(shapes.box(8, 14, 20))


@pytest.fixture(scope="module")
def arriving(block):
    """Shares that shift from the first aspect to the others as the stroke and the frequency grow."""
    known = shares(block, BOWL)
    answer = known.aspects.recommended

    def at(bowl):
        pull = bowl.drive.amplitude * bowl.drive.frequency**2
        p = answer.p * np.where(np.arange(len(answer.p)) == 0, np.exp(-1e-3 * pull), 1.0)
        p = p / p.sum()
        other = replace(answer, p=p, low=np.minimum(answer.low, p), high=np.maximum(answer.high, p))
        return Shares(replace(known.aspects, recommended=other))

    return at


@pytest.mark.parametrize("worst", [False, True])
def test_rate_says_of_each_setting_what_tune_says(block, arriving, worst):
    found = tune(block, BOWL, "A", TARGET, arriving=arriving, worst=worst)
    assert len(found.settings) >= 2
    for one in found.settings:
        there = drive_settings.turned(BOWL, one.solution.key, one.solution.value)
        back = rate(block, there, "A", aspect_shares=arriving(there)).rate
        assert back.velocity.all == pytest.approx(one.velocity.all, rel=1e-12)
        speed = back.velocity.low if worst else back.velocity.value
        met = back.parts.value * speed / back.velocity.value
        assert met == pytest.approx(one.solution.rate, rel=1e-9)
        assert met == pytest.approx(TARGET, rel=drive_settings.ACCEPTED_RATE_ERROR)


def test_each_drive_is_asked_once_what_arrives(block, arriving):
    asked = []

    def counted(bowl):
        asked.append(bowl)
        return arriving(bowl)

    tune(block, BOWL, "A", TARGET, arriving=counted)
    assert len(asked) == len(set(asked))
    assert BOWL in asked
