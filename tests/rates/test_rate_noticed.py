"""Terms of the chain of a rate that a chain of plain devices, all parts carried, would not show."""

from dataclasses import replace
from types import SimpleNamespace

import awkward
import numpy as np
import pytest

from feederscrew.mechanics.track_balance import seat
from feederscrew.rates import stream, tipping, well_oriented
from feederscrew.rates.well_oriented import Range
from feederscrew.tooling.devices.kinds import make_device

SPEED = Range(0.04, 0.03, 0.05)


@pytest.fixture(scope="module")
def known():
    """Every orientation of the skew body behind a blade that some of them do not pass."""
    part, aspects = awkward.part()
    bowl = awkward.bowl()
    return stream.follow_orientations(
        part, aspects, bowl.track, [make_device("wiper", "test", limit=14e-3)], bowl=bowl
    )


def target(known, row):
    return known.aspects[row], known.headings[row]


def first(known):
    """The first orientation that leaves, as what it is."""
    return int(np.flatnonzero((known.leaves > 0.5) & (known.leaves_as == np.arange(len(known.aspects))))[0])


def test_what_is_not_sure_to_be_returned_counts_in_purity(known):
    """Wanted parts over all that may leave: the doubtful ones too, but for the wanted row, which is sure."""
    row = first(known)
    doubtful = np.where(known.leaves < 0.5, 0.3, 0.0)
    assert doubtful.any()
    doubt = replace(known, doubtful=doubtful)
    chance = known.rules["csa"]
    wanted = float(chance[row] * known.leaves[row])
    others = float((chance * (known.leaves + doubtful)).sum() - chance[row] * known.leaves[row])
    made_of = well_oriented.rate(doubt, SPEED, target(known, row), "csa")
    assert made_of.purity == pytest.approx(wanted / (wanted + others))
    assert made_of.purity < well_oriented.rate(known, SPEED, target(known, row), "csa").purity


def test_the_probability_of_a_rule_ranges_over_all_rules(known):
    row = first(known)
    found = well_oriented.rate(known, SPEED, target(known, row), "csa").probability
    chances = [chance[row] for chance in known.rules.values() if not np.isnan(chance[row])]
    assert found.all == (known.rules["csa"][row], min(chances), max(chances)) and found.low < found.high


def test_what_rolls_back_is_carried_in_the_highest_rate_only(known):
    """Half of the orientations roll back: those that are left share the track among themselves."""
    row = first(known)
    rolls = replace(
        known, lying=tuple(replace(one, may_roll_back=k != row) for k, one in enumerate(known.lying))
    )
    found = well_oriented.rate(rolls, SPEED, target(known, row), "csa").parts
    alone = well_oriented.rate(known, SPEED, target(known, row), "csa").parts
    assert found.value == pytest.approx(SPEED.value / (known.lengths[row] + known.gap))
    assert found.value > alone.value and found.high >= alone.high
    only = replace(known, lying=tuple(replace(one, may_roll_back=True) for one in known.lying))
    gone = well_oriented.rate(only, SPEED, target(known, row), "csa").parts
    assert gone.value == 0.0 and gone.high == pytest.approx(alone.high)


def test_a_part_that_is_swept_off_keeps_the_others_waiting(known):
    """So often as it comes, for so long: the time between two parts is that much longer."""
    row = first(known)
    chance = known.rules["csa"]
    swept = np.where(known.leaves < 0.5, 0.8, 0.0)
    slow = replace(known, clearing=swept)
    speed = 0.037
    lying = tuple(replace(one, speed=speed) for one in slow.lying)
    slow = replace(slow, lying=lying)
    waits = float((chance * swept).sum() / (chance * known.stays).sum())
    freely = well_oriented.parts_per_metre(known, target(known, row), "csa")
    share = well_oriented.efficiency(known, row, "csa")
    density = 1.0 / (share / freely + waits * speed)  # all parts on a metre
    told = well_oriented.parts_per_metre(slow, target(known, row), "csa")
    assert told == pytest.approx(share * density) and told < 0.95 * freely
    stands = replace(slow, lying=tuple(replace(one, speed=0.0) for one in lying))
    assert well_oriented.parts_per_metre(stands, target(known, row), "csa") == pytest.approx(freely)


def test_what_tips_lies_on_its_foot_and_what_rolls_on_its_line():
    for one in awkward.lying():
        if one.falls_off or one.touching is None:
            continue
        place = seat(one.posture, one.heading, one.touching, np.radians(3.0))
        np.testing.assert_array_equal(
            tipping.seat_in_groove(replace(one, kind="flat"), np.radians(3.0)).contact, place.contact
        )
        line = tipping.seat_in_groove(replace(one, kind="rolling"), np.radians(3.0)).contact
        assert (line[:, 0].min(), line[:, 0].max()) == (place.contact[:, 0].min(), place.contact[:, 0].max())
        assert np.abs(line[:, 1]).min() > np.abs(place.contact[:, 1]).max()


def test_what_the_first_device_that_returns_it_may_leave_is_not_surely_gone(monkeypatch):
    lying = [SimpleNamespace(returned=back) for back in (False, True, False, False)]
    passes = np.array([[1.0, 1.0, 0.0], [1.0, 0.0, 1.0], [1.0, 0.0, 0.0], [1.0, 1.0, 1.0]])
    monkeypatch.setattr(tipping, "surely_gone", lambda device, one: device == "sure")
    assert tipping.is_surely_gone(["unsure", "sure"], lying, passes).tolist() == [True, True, False, True]


def test_no_more_leave_than_fit_on_the_track_behind_what_turns_them_lengthwise(known):
    """All of them turned into the longest orientation: one a length, however many came."""
    row = int(np.argmax(known.lengths))
    leaving = np.zeros_like(known.leaving)
    leaving[:, row] = 1.0
    states = np.arange(len(known.aspects))
    turned = replace(known, leaving=leaving, passes=np.ones_like(known.passes), leaves_as=states)
    long = known.lengths[row]
    assert well_oriented.mean_length(turned, "csa") < 0.9 * long
    assert well_oriented.parts_per_metre(turned, target(known, row), "csa") == pytest.approx(1.0 / long)
    parts = well_oriented.rate(turned, SPEED, target(known, row), "csa").parts
    assert parts.all == pytest.approx([speed / long for speed in SPEED.all])
