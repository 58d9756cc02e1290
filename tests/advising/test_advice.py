"""Advice on a part: its grade follows from data, and a change counts by what the part with it brings."""

import json
from dataclasses import replace

import numpy as np
import pytest

import feederscrew as fs
from feederscrew.advising import advice
from feederscrew.advising.advice import Grade, Reason, ReasonKind, Way, advise
from feederscrew.designing.record import RiskKind
from feederscrew.sorting.devices.kinds import KINDS

SENSOR = KINDS["vision reject"]


def way(devices=(), efficiency=0.5, rate=1.0):
    return Way("A@0", 0.0, "A@0", "on a face", tuple(devices), efficiency, 1.0, rate, 2.0 * rate)


@pytest.fixture(scope="module")
def washer():
    """The washer, graded by the static rule: any heading of it is one."""
    return advise(fs.load("parts/washer_m6.stl"), fs.read_bowl(), with_trials=False, rule="closed")


def test_a_grade_falls_by_the_steps_of_its_reasons_and_e_is_for_no_way():
    steps = [Reason(ReasonKind.YIELD, 0.1, 1, ""), Reason(ReasonKind.TANGLES, None, 2, "")]
    assert advice._grade(None, ()) is Grade.E
    assert advice._grade(way(), ()) is Grade.A
    assert advice._grade(way(), steps[:1]) is Grade.B
    assert advice._grade(way(), steps) is Grade.D
    assert advice._grade(way(), [*steps, *steps]) is Grade.D
    assert advice.RISKS[RiskKind.HOOKS][1] > advice.RISKS[RiskKind.NESTS][1] > 0


def test_a_way_of_little_yield_comes_after_a_dearer_class():
    """Steel that lets one part of a hundred leave is no way to feed a part."""
    rare, common = way(efficiency=0.01, rate=0.1), way([_camera()], efficiency=0.4)
    assert common.merit > rare.merit
    assert way(efficiency=0.2, rate=0.1).merit > common.merit


def _camera():
    """The vision reject of a design."""
    bowl = fs.read_bowl(overrides={})
    part = fs.load("parts/lbracket_30x20x15.stl")
    study = fs.tooling(part, bowl, "A", cost_class="sensor", search=fs.ToolingSearch(rule="csa", vary=False))
    return next(device for device in study.design.devices if device.kind == SENSOR.kind)


def test_a_washer_is_judged_with_each_of_its_changes(washer):
    assert washer.way is not None and washer.grade in set(Grade) - {Grade.E}
    assert washer.reasons[0].kind is ReasonKind.CLASS
    least = sum(reason.steps for reason in washer.reasons)
    assert washer.grade is advice.BY_CLASS[washer.way.cost_class].worse(least)
    assert len(washer.changes) >= 2
    for changed in washer.changes:
        assert changed.before is washer.way and not changed.is_tried
        if changed.way is not None:
            better = changed.way.merit > washer.way.merit
            assert better or not changed.gains
    gains = [changed.gains for changed in washer.changes]
    assert gains == sorted(gains, reverse=True)


def test_the_same_way_is_no_gain_and_a_tenth_more_is(washer):
    one = replace(washer.changes[0], way=washer.way)
    assert not one.gains
    assert replace(one, way=replace(washer.way, rate=1.2 * washer.way.rate)).gains
    assert not replace(one, way=replace(washer.way, rate=1.05 * washer.way.rate)).gains
    assert not replace(one, way=None).gains and replace(one, before=None).gains


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
