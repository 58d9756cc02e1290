"""What a bowl's own floor delivers, and when that is not settled."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
import shapes

from feederscrew import bowl as bowls
from feederscrew.dropping import arrival, plate_test
from feederscrew.errors import FeederError
from feederscrew.rates import stream
from feederscrew.resting.aspects import find
from feederscrew.studies.rate import shares

HALF = replace(plate_test.EXACT_PACE, seconds=0.5)


def plate(amplitude):
    return bowls.record(bowls.settings(path=None, overrides=(f"drive.amplitude={amplitude} mm",)))


@pytest.fixture(scope="module")
def shaken():
    """Few parts on a gentle floor."""
    part = shapes.part(shapes.box(8.0, 12.0, 15.0))
    aspects = find(part)
    return part, aspects, plate_test.test(part, aspects, [plate(0.02)], "feed", {}, drops=30, pace=HALF)[0]


def changed(shaken, **values):
    """The run with other findings."""
    values = {name: np.asarray(value) for name, value in values.items()}
    return replace(shaken, occupancy=replace(shaken.occupancy, **values))


def test_a_gentle_floor_settles_the_shares(shaken):
    part, aspects, _ = shaken
    found = arrival.arrival(part, aspects, plate(0.02), drops=30)
    assert found.settled and found.reason == "" and found.p.sum() == pytest.approx(1.0)
    assert (found.low <= found.p).all() and (found.p <= found.high).all()
    assert found.shaken.seconds == pytest.approx(arrival.FLOOR_TIMES_S[0], rel=0.05)


def test_shares_that_still_change_are_undecided(shaken):
    found = arrival.judge(changed(shaken[2], changing=[True, False, False]))
    assert not found.settled and found.reason == arrival.MOVING_REMARK.format(shaken[2].seconds)


def test_rates_that_lead_elsewhere_are_undecided_and_in_the_interval(shaken):
    run = changed(
        shaken[2], start=[0.5, 0.3, 0.2], plate=[0.5, 0.3, 0.2], plate_low=[0.4, 0.2, 0.1],
        plate_high=[0.6, 0.4, 0.3], limit=[0.9, 0.1, 0.0], limit_low=[0.8, 0.05, 0.0],
        limit_high=[0.95, 0.15, 0.05], changing=[False] * 3, counts=[[0, 0, 0], [9, 0, 0], [0, 0, 0]],
    )  # fmt: skip
    found = arrival.judge(run)
    assert not found.settled and found.low == pytest.approx([0.4, 0.05, 0.0])
    assert found.high == pytest.approx([0.95, 0.4, 0.3])
    near = arrival.judge(changed(run, limit=[0.53, 0.28, 0.19]))
    assert near.settled and near.low == pytest.approx([0.4, 0.2, 0.1])
    few = arrival.judge(changed(run, counts=[[0, 0, 0], [0, 0, 0], [0, 0, 0]]))
    assert few.settled and few.low == pytest.approx([0.4, 0.2, 0.1])


def test_parts_that_lie_on_nothing_are_told(shaken):
    found = arrival.judge(changed(shaken[2], plate=[0.3, 0.2, 0.1]))
    assert not found.settled and found.p == pytest.approx([1 / 2, 1 / 3, 1 / 6])
    assert found.reason == arrival.UNSEEN_REMARK.format(12, 30)
    nothing = arrival.judge(changed(shaken[2], plate=[0.0, 0.0, 0.0]))
    assert np.isnan(nothing.p).all() and nothing.low.tolist() == [0.0] * 3


def test_a_part_too_small_to_be_followed_on_its_floor_ends_at_once():
    """A file in a wrong unit, 30 nm long, took 50 times 300,000 steps for each of its parts."""
    part, bowl = shapes.part(shapes.box(3e-5, 2e-5, 1e-5)), bowls.read(None)
    known = shares(part, bowl)
    assert not known.fed
    assert known.aspects.recommended.rule == known.aspects.closed.rule
    assert known.aspects.warnings[-1] == stream.TOO_LONG
    with pytest.raises(FeederError, match=r"a part so small takes .* steps at this drive for so long"):
        plate_test.test(part, known.aspects, [bowl], "feed", {})


def test_on_a_floor_that_throws_parts_as_many_are_followed_as_the_share_needs(monkeypatch):
    """The cap at a throw number of 1.7: 800 parts at 82 % are known to 2.7 % only."""
    part, bowl = shapes.part(shapes.box(8.0, 12.0, 20.0)), plate(0.4)
    runs = []

    def test(*_, drops, pace, **__):
        runs.append((drops, pace.seconds, pace.done))
        error = np.array([0.4, 0.4, 0.0]) / np.sqrt(drops)
        seen = SimpleNamespace(error=error, plate_low=np.full(3, 0.3), plate_high=np.full(3, 0.4))
        return [plate_test.PlateResult(bowl, {}, 1.7, drops, pace.seconds, seen, 0, False, rides="kept")]

    def judge(run):
        return arrival.Arrival(0, 0, 0, run.seconds == arrival.FLOOR_TIMES_S[1], "", run)

    for name, count in (("FIRST_PARTS", 400), ("LONGER_TIME_PARTS", 800), ("MAX_ARRIVALS", 4000)):
        monkeypatch.setattr(arrival, name, count)
    monkeypatch.setattr(plate_test, "test", test)
    monkeypatch.setattr(arrival, "judge", judge)
    arrival.arrival(part, find(part), bowl)
    short, long = arrival.FLOOR_TIMES_S
    assert runs == [(400, short, None), (800, long, None), (1600, long, "kept")]
    assert 1.96 * 0.4 / np.sqrt(1600) <= arrival.ARRIVAL_HALF_WIDTH < 1.96 * 0.4 / np.sqrt(1200)


def test_on_a_floor_that_throws_parts_that_lie_still_are_followed_no_further():
    """The same parts on the same faces as of those that are followed to the end, on a floor of throw 1.5."""
    part = shapes.part(shapes.box(8.0, 12.0, 15.0))
    aspects, bowl = find(part), plate(0.35)
    assert plate_test.throw_number(bowl) > 1.0
    pace = replace(arrival.ARRIVAL_PACE, settling=arrival.THROWN_SETTLING, seconds=0.5, keep=True)
    own = {"drops": 60, "run": replace(plate_test.USUAL_RUN, seed=3)}
    stopped, whole = (
        plate_test.test(part, aspects, [bowl], "feed", {}, pace=replace(pace, kick=kick), **own)[0]
        for kick in (pace.kick, np.inf)
    )
    assert (stopped.rides.faces[:, -1] == whole.rides.faces[:, -1]).mean() >= 0.98
    pace = replace(pace, coarse=1.0, flight=1.0)
    fine = plate_test.test(part, aspects, [bowl], "feed", {}, pace=pace, **own)[0]
    assert (stopped.rides.faces[:, -1] == fine.rides.faces[:, -1]).mean() >= 0.95
    resting = (np.diff(stopped.rides.places, axis=1) == 0.0).all(axis=2).mean()
    assert resting > 0.3  # of the looks: where they lie is noted without a step
