"""Whose shares a rate takes: counts, orientations that were counted, the bowl's own floor."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
import shapes

from feederscrew import bowl as bowls
from feederscrew.errors import FeederError
from feederscrew.rates import stream
from feederscrew.resting import profiles
from feederscrew.resting.aspects import find
from feederscrew.studies import rate as study


@pytest.fixture(scope="module")
def part():
    return shapes.part(shapes.box(8.0, 12.0, 20.0))


@pytest.fixture(scope="module")
def plain():
    return bowls.record(bowls.settings(path=None, overrides=("track.width=40 mm",)))


@pytest.fixture
def counts(tmp_path):
    """Write a file of counts; its path."""

    def write(text):
        (tmp_path / "c.csv").write_text(text)
        return str(tmp_path / "c.csv")

    return write


def test_counts_are_the_answer_with_wilsons_interval(part, plain, counts):
    path = counts("# launch: roll\naspect,tray\nA,60\nB,30\nC,10\n")
    known = study.shares(part, plain, probabilities=path)
    answer = known.aspects.recommended
    assert answer.p.tolist() == pytest.approx([0.6, 0.3, 0.1]) and answer.launch == "roll"
    assert answer.rule == f"{path}, 100 parts" and list(known.inputs) == [path]
    assert (answer.low[2], answer.high[2]) == pytest.approx((0.0552, 0.1744), abs=1e-4)  # Wilson's, 10 of 100
    ways = study.rate(part, plain, aspect_shares=known).rate.orientations
    total = dict.fromkeys("ABC", 0.0)
    for one, share in zip(ways.lying, ways.rules["recommended"], strict=True):
        total[one.aspect] += share
    assert list(total.values()) == pytest.approx([0.6, 0.3, 0.1])


def test_orientations_that_were_counted_stand_as_they_are(part, plain, counts):
    known = study.rate(part, plain).rate.orientations
    a, b = (next(one.name for one in known.lying if one.aspect == name) for name in "AB")

    def counted(text):
        shares = study.shares(part, plain, probabilities=counts(f"orientation,track\n{text}C@0,0\n"))
        return study.rate(part, plain, aspect_shares=shares).rate.orientations

    found = counted(f"{a},30\n{b},10\n")
    names = [one.name for one in found.lying]
    taken = dict(zip(names, found.rules["recommended"]))
    assert taken.pop(a) == 0.75 and taken.pop(b) == 0.25 and not any(taken.values())
    low, high = found.interval[names.index(a)]
    assert low < 0.75 < high
    with pytest.raises(FeederError, match=r"counts orientation A@47, which the part does not have - known"):
        counted(f"A@47,30\n{b},10\n")


def test_several_columns_are_refused(part, plain, counts):
    said = r"has 2 columns of shares \(x, y\) - leave one of them in the file"
    with pytest.raises(FeederError, match=said):
        study.shares(part, plain, probabilities=counts("aspect,x,y\nA,60,1\nB,30,1\nC,10,1\n"))


def arrival(**values):
    ends = {"low": np.array([0.5, 0.1, 0.0]), "high": np.array([0.8, 0.4, 0.2])}
    usual = {"p": np.array([0.7, 0.2, 0.1]), **ends, "settled": True, "reason": ""}
    return SimpleNamespace(**(usual | values), shaken=SimpleNamespace(parts=80, partial=False))


def test_what_arrives_is_named_and_what_is_undecided_is_said(part):
    aspects = find(part)
    found = stream.arrived(aspects, arrival(), 1)
    assert found.recommended.rule == "fed onto the moving floor, 80 parts, seed 1"
    assert found.recommended.p.tolist() == [0.7, 0.2, 0.1] and found.warnings == aspects.warnings
    doubtful = stream.arrived(aspects, arrival(settled=False, reason="they change - wait"), 1)
    assert doubtful.warnings[-1] == "the shares at the track's entry are undecided: they change - wait"
    stopped = arrival()
    stopped.shaken.partial = True
    assert stream.arrived(aspects, stopped, 1).warnings[-1] == "the parts on the floor were stopped after 80"
    nothing = stream.arrived(aspects, arrival(p=np.full(3, np.nan)), 1)
    assert nothing.recommended is aspects.recommended and nothing.warnings[-1] == stream.NO_ARRIVALS_MESSAGE


@pytest.fixture(scope="module")
def gentle(part, plain):
    """A bowl whose floor hardly moves, and the shares of 100 parts fed onto it."""
    bowl = replace(plain, drive=replace(plain.drive, amplitude=0.02e-3))
    return bowl, study.shares(part, bowl, fed=100).aspects


def test_a_bowl_of_its_own_feeds_parts_onto_its_floor(part, gentle):
    """The interval of an orientation is its share of that of its aspect."""
    bowl, aspects = gentle
    answer = aspects.recommended
    assert answer.rule.startswith("fed onto the moving floor, 100 parts")
    assert answer.p.sum() == pytest.approx(1.0) and (answer.low <= answer.p).all()
    assert (answer.high > answer.p).all() and answer.p[0] > answer.p[1] > answer.p[2]
    low, high = stream.follow_orientations(part, aspects, bowl.track).interval.T
    assert low.sum() == pytest.approx(answer.low.sum())
    assert high.sum() == pytest.approx(answer.high.sum()) and (low <= high).all()
    assert (low < high).any()


def test_a_stop_before_the_longer_spell_keeps_the_shorter(part, plain, monkeypatch):
    from feederscrew.dropping import arrival as floor

    monkeypatch.setattr(floor, "judge", lambda _: floor.Arrival(0, 0, 0, False, "open", ran[0]))
    ran = []

    def test(*_, pace, **__):
        if ran:
            raise KeyboardInterrupt
        ran.append(floor.plate_test.PlateResult(plain, {}, 1.0, 5, pace.seconds, None, 0, False))
        return ran

    monkeypatch.setattr(floor.plate_test, "test", test)
    found = floor.arrival(part, None, plain)
    assert found.shaken.partial and not found.settled


def test_a_measured_file_without_counts_has_no_interval(part):
    aspects = find(part)
    sheet = profiles.parse_count_sheet("aspect,x\nA,0.5\nB,0.25\nC,0.25\n", "c")
    made = profiles.measured(sheet, "c.csv", "", "ABC")
    answer = stream.counted(aspects, made).recommended
    np.testing.assert_array_equal(answer.low, answer.high)
