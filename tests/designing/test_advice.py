"""Advice on a part: its grade follows from data, and a change counts by what the part with it brings."""

import json
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

import feederscrew as fs
from feederscrew.bowl.devices.kinds import CostClass, make_device
from feederscrew.designing import advice, tooling_trials
from feederscrew.designing.advice import Grade, ReasonKind, Way, advise
from feederscrew.designing.findings import Fault, FaultKind
from feederscrew.designing.record import RiskKind
from feederscrew.output import advise as advise_output
from feederscrew.sorting.orientations import orientations


def way(devices=(), efficiency=0.5, rate=1.0):
    return Way("A@0", 0.0, "A@0", "on a face", tuple(devices), efficiency, 1.0, rate, 2.0 * rate)


@pytest.fixture(scope="module", autouse=True)
def asked_once():
    """The static rule is asked once for each shape and orientation: the bowl is the same in this file."""
    known, real = {}, advice.tooling_without

    def remembered(kinds, part, bowl, aspect, *, heading, aspect_shares, search, cost_class):
        key = tuple(kinds), part.vertices.tobytes(), aspect, heading, repr(search), cost_class
        if key not in known:
            own = {"heading": heading, "aspect_shares": aspect_shares, "search": search}
            known[key] = real(kinds, part, bowl, aspect, **own, cost_class=cost_class)
        return known[key]

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(advice, "tooling_without", remembered)
        yield


@pytest.fixture(scope="module")
def washer():
    """The washer, graded by the static rule: any heading of it is one."""
    return advise(fs.load("parts/washer_m6.stl"), fs.read_bowl(), with_trials=False, rule="closed")


def graded(monkeypatch, *, efficiency=0.5, rate=1.0, risks=()):
    """The grade of a washer whose way brings what is given, with the steps of its reasons."""
    rate_of = SimpleNamespace(
        efficiency=efficiency,
        purity=1.0,
        parts=SimpleNamespace(value=rate),
        offered=SimpleNamespace(value=rate / efficiency),
    )
    monkeypatch.setattr(advice, "rate", lambda *_, **__: SimpleNamespace(rate=rate_of))
    given = [SimpleNamespace(kind=kind, text=str(kind)) for kind in risks]
    monkeypatch.setattr(advice, "risks", lambda *_, **__: given)
    part = fs.load("parts/washer_m6.stl")
    study = advise(part, fs.read_bowl(), with_trials=False, with_changes=False, rule="closed")
    return study.grade, {reason.kind: reason.steps for reason in study.reasons}


HOOKS, NESTS, SHINGLES = RiskKind.HOOKS, RiskKind.NESTS, RiskKind.SHINGLES


@pytest.mark.parametrize(
    ("given", "grade"),
    [
        ({}, Grade.A),
        ({"efficiency": 0.251}, Grade.A),
        ({"efficiency": 0.249}, Grade.B),  # less than 25 % come right
        ({"rate": 30.1 / 60}, Grade.A),
        ({"rate": 29.9 / 60}, Grade.B),  # less than 30 a minute
        ({"risks": [SHINGLES]}, Grade.A),
        ({"risks": [NESTS]}, Grade.B),
        ({"risks": [HOOKS]}, Grade.C),
        ({"risks": [HOOKS, NESTS], "efficiency": 0.2, "rate": 0.1}, Grade.D),  # five less: D is the last
    ],
)
def test_a_grade_falls_by_the_table_of_the_page(monkeypatch, given, grade):
    """docs/advice.md: a grade for little yield, for a low rate and for nesting, two for hooking."""
    assert graded(monkeypatch, **given)[0] is grade


def test_the_cheapest_class_gives_the_grade_and_e_is_for_no_way():
    assert [advice.BY_CLASS[one] for one in CostClass] == [Grade.A, Grade.B, Grade.C]
    assert [Grade.E.worse(steps) for steps in (0, 1, 5)] == [Grade.E] * 3
    assert [Grade.B.worse(steps) for steps in (0, 1, 2, 3)] == [Grade.B, Grade.C, Grade.D, Grade.D]


def test_what_comes_often_is_looked_at_the_most_frequent_first(monkeypatch):
    """Two in a hundred or more, six at most; of the bracket more come than that."""
    part, bowl = fs.load("parts/lbracket_30x20x15.stl"), fs.read_bowl()
    asked, real = [], advice.tooling_without

    def noted(kinds, own, record, aspect, **request):
        asked.append((aspect, request["heading"]))
        return real(kinds, own, record, aspect, **request)

    monkeypatch.setattr(advice, "tooling_without", noted)
    study = advise(part, bowl, with_trials=False, with_changes=False, rule="closed")
    every = orientations(part, study.aspects, bowl.track)
    shares = {(one.aspect, one.heading): one.chances["closed"] for one in every}
    expected = sorted((share for share in shares.values() if share >= 0.02), reverse=True)[:6]
    assert [shares[one] for one in asked] == pytest.approx(expected)
    assert len(asked) == 6 or min(shares.values()) < 0.02


def tried_as(monkeypatch, verdict):
    """Every chain is tried at once, with the faults and the efficiency that ``verdict`` gives.

    Parts are not pulled apart: that has tests of its own, and takes half of the time.
    """
    names = []
    monkeypatch.setattr(advice, "risks", lambda *_, **__: [])

    def try_designs(study, *_, **__):
        own = study.orientations[study.wanted]
        names.append(own.name)
        faults, efficiency = verdict(own, len(names))
        trial = tooling_trials.TriedDesign(
            own.name, study.wanted, (), 0.5, efficiency, 1.0, 40, faults, purity_ends=(0.9, 1.0)
        )
        return replace(study, trials=(trial,))

    monkeypatch.setattr(advice.tooling_trials, "try_designs", try_designs)
    return names


DENIED = (Fault(FaultKind.NOT_RUN, reason="denied"),)


def test_every_orientation_that_comes_often_is_tried_before_a_part_has_no_way(monkeypatch):
    """A wider bushing was graded E once after two of six orientations."""
    part, bowl = fs.load("parts/lbracket_30x20x15.stl"), fs.read_bowl()
    names = tried_as(monkeypatch, lambda _, number: (DENIED if number < 4 else (), 0.3))
    study = advise(part, bowl, with_changes=False, rule="closed")
    assert len(names) == len(set(names)) == 4
    assert study.way.orientation == names[-1] and study.way.is_tried and study.way.efficiency == 0.3
    assert "40 parts, one at a time: 90 % or more" in study.reasons[0].text
    names = tried_as(monkeypatch, lambda _, __: (DENIED, 0.3))
    study = advise(part, bowl, with_changes=False, rule="closed")
    assert (study.grade, study.way, study.partial) == (Grade.E, None, False)
    assert (
        f"any of the {len(names)} orientations" in study.reasons[0].text
        and "by trials" in study.reasons[0].text
    )


def test_steel_ends_the_search_and_a_dearer_way_is_set_beside_one_more(monkeypatch):
    part, bowl = fs.load("parts/lbracket_30x20x15.stl"), fs.read_bowl()
    names = tried_as(monkeypatch, lambda _, __: ((), 0.3))
    study = advise(part, bowl, with_changes=False, rule="closed")
    is_steel = study.way.cost_class is CostClass.STEEL
    assert len(names) == (1 if is_steel and study.way.orientation == names[0] else 2)
    rare = tried_as(monkeypatch, lambda _, __: ((), 0.05))  # too little for any class
    advise(part, bowl, with_changes=False, rule="closed")
    assert len(rare) == 2


def test_a_limit_that_strikes_first_leaves_the_grade_of_the_rule_and_says_so():
    """It was graded E, as if no way had been found."""
    part = fs.load("parts/washer_m6.stl")
    study = advise(part, fs.read_bowl(), seconds=0.0, rule="closed")
    assert study.partial and not study.is_tried and study.way is not None
    assert study.grade is not Grade.E and "by the static rule" in study.reasons[0].text
    assert any("stopped" in line for line in study.warnings)


def test_an_interrupt_within_a_trial_ends_the_advice(monkeypatch):
    calls = []

    def stopped(study, *_, **__):
        calls.append(study)
        return replace(study, partial=True)

    monkeypatch.setattr(advice.tooling_trials, "try_designs", stopped)
    study = advise(fs.load("parts/lbracket_30x20x15.stl"), fs.read_bowl(), with_changes=False, rule="closed")
    assert study.partial and len(calls) == 1 and not study.is_tried


def test_changes_that_were_tried_come_first_then_those_that_gain(monkeypatch):
    part = fs.load("parts/washer_m6.stl")
    tried_as(monkeypatch, lambda _, __: ((), 0.3))
    study = advise(part, fs.read_bowl(), rule="closed")
    order = [(changed.is_tried, changed.gains) for changed in study.changes]
    assert order == sorted(order, reverse=True)
    assert sum(changed.is_tried for changed in study.changes) == min(3, len(study.changes))
    for changed in study.changes:
        assert changed.before is not None and changed.before.is_tried is changed.is_tried


def test_a_way_of_little_yield_comes_after_a_dearer_class():
    """Steel that lets one part of a hundred leave is no way to feed a part."""
    rare, common = way(efficiency=0.01, rate=0.1), way([_camera()], efficiency=0.4)
    assert common.merit > rare.merit
    assert way(efficiency=0.101, rate=0.1).merit > common.merit > way(efficiency=0.099, rate=9.0).merit


def _camera():
    """A vision reject; that a design of this class has one, test_cost_classes.py says."""
    return make_device("vision reject", "test", like=("A", 0.0, 2e-3), sees="height")


def test_a_washer_is_judged_with_each_of_its_changes(washer):
    assert washer.way is not None and washer.grade in set(Grade) - {Grade.E}
    assert washer.reasons[0].kind is ReasonKind.CLASS
    least = sum(reason.steps for reason in washer.reasons)
    assert washer.grade is advice.BY_CLASS[washer.way.cost_class].worse(least)
    assert len(washer.changes) >= 2
    for changed in washer.changes:
        assert changed.before is washer.way and not changed.is_tried
        assert changed.outcome.endswith("by the static rule)") or changed.way is None
        if changed.way is not None:
            better = changed.way.merit > washer.way.merit
            assert better or not changed.gains
    gains = [changed.gains for changed in washer.changes]
    assert gains == sorted(gains, reverse=True)


def test_the_same_way_is_no_gain_and_a_tenth_more_is(washer):
    one = replace(washer.changes[0], found=washer.changes[0].found_before)
    assert not one.gains

    def found(rate):
        return replace(one.found, way=replace(washer.way, rate=rate * washer.way.rate))

    none = replace(one.found, way=None)
    assert replace(one, found=found(1.11)).gains and not replace(one, found=found(1.09)).gains
    assert not replace(one, found=none).gains and replace(one, found_before=none).gains


def test_a_table_of_tried_and_untried_changes_says_what_each_stands_beside(washer):
    """Of two changes that gain, the one that was not tried has the part by the rule beside it."""
    one = replace(washer.changes[0], found_before=replace(washer.changes[0].found, way=None))
    own = way() if one.way is None else one.way
    ruled = replace(one, found=replace(one.found, way=own))
    tried = replace(one, found=replace(one.found, way=replace(own, is_tried=True), by_trial=True))

    def lines(*changes):
        return len(advise_output.remarks(replace(washer, changes=changes))) - 1 - len(washer.reasons)

    assert (lines(tried), lines(ruled), lines(tried, ruled)) == (1, 1, 2)
    assert lines(tried, tried, tried, tried, ruled) == advise_output.SHOWN + 1


def test_a_study_says_itself_and_saves_the_files_of_the_command(washer, tmp_path):
    assert f"grade {washer.grade}" in repr(washer)
    washer.save(tmp_path)
    names = {path.name for path in tmp_path.rglob("*") if path.is_file()}
    assert {"advice.json", "changes.csv", "advice.html"} <= names
    document = json.loads(next(tmp_path.rglob("advice.json")).read_text())
    assert document["grade"] == washer.grade and len(document["changes"]) == len(washer.changes)
    frame = washer.to_frame()
    assert len(frame) == len(washer.changes) and np.all(frame["volume_share"] > 0.0)
    page = next(tmp_path.rglob("advice.html")).read_text()
    assert all(changed.change.text.split(" (")[0] in page for changed in washer.changes)
