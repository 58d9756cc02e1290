"""The study of ``feeder tune``: what it says of a setting is what ``rate`` says there."""

from dataclasses import replace

import numpy as np
import pytest
import shapes

from feederscrew import bowl as bowls
from feederscrew.rates import drive_settings
from feederscrew.studies.rate import Shares, rate, shares
from feederscrew.studies.tune import tune

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
