"""What ``feeder tooling`` says of its own proposal: the trial comes first, and the next best are tried."""

from dataclasses import dataclass, replace
from types import SimpleNamespace

import numpy as np
import pytest
import shapes

from feederscrew import bowl as bowls
from feederscrew.designing import tooling_trials
from feederscrew.output import tooling as tables
from feederscrew.studies.tooling import tooling, tooling_without
from feederscrew.tooling.devices.kinds import make_device

PART = shapes.part(shapes.box(20, 12, 5))


@pytest.fixture(scope="module")
def study():
    return tooling(PART, bowls.read(None, []), "A", rule="csa", verdicts=1)


@dataclass
class Verdicts:
    """Stands for the trial: denies as many chains as it is told."""

    denials: int

    def __call__(self, study, one, *_):
        self.denials -= 1
        faults = ("nothing leaves as wanted",) if self.denials >= 0 else ()
        devices, name = tooling_trials._devices(one), study.orientations[one.wanted].name
        return tooling_trials.TriedDesign(name, one.wanted, devices, one.efficiency, 0.0, np.nan, 6, faults)


def tried(monkeypatch, study, denials):
    monkeypatch.setattr(tooling_trials, "_tried", Verdicts(denials))

    def again(kinds):
        found = tooling_without(kinds, PART, study.bowl, "A", rule="csa", verdicts=1)
        assert not {cut.device.kind for cut in found.design.cuts} & set(kinds)
        return found

    return tooling_trials.own_trials(study, again)


def test_a_confirmed_design_is_said_to_isolate(monkeypatch, study):
    found = tried(monkeypatch, study, 0)
    assert tables.document(found)["status"] == "confirmed"
    assert tables.document(found)["isolated"] is True
    assert tables.remarks(found)[0].endswith("and the trial agrees")


def test_what_the_trial_denies_is_not_isolated_and_the_next_best_are_tried(monkeypatch, study):
    found = tried(monkeypatch, study, 3)
    assert found.design is study.design
    assert 2 <= len(found.trials) <= tooling_trials.TRIES
    told = tables.document(found)
    assert (told["status"], told["isolated"], told["isolated_static"]) == ("denied", False, True)
    assert found.isolates(found.wanted) is False
    assert tables.remarks(found)[0].startswith(
        f"{found.orientations[found.wanted].name} is not isolated: the"
    )
    assert "the trial denies it: nothing leaves as wanted" in tables.remarks(found)[0]
    denied, agreed = tables.trials(found)
    assert len(denied) == len(found.trials) - 1 and not agreed
    assert all(text.startswith("tried as well, ") for text in denied)
    assert "# DENIED by its trial: nothing leaves as wanted." in tables.bowl_file(found, ())


def test_the_next_best_that_holds_is_taken(monkeypatch, study):
    found = tried(monkeypatch, study, 1)
    assert found.design.devices != study.design.devices
    assert not found.trials[0].faults and found.trials[1].faults
    assert tables.document(found)["status"] == "confirmed"
    holds = [one.static_efficiency for one in found.trials if not one.faults]
    assert found.trials[0].static_efficiency == found.design.efficiency == max(holds)


def test_of_those_that_hold_the_most_efficient_is_taken(monkeypatch, study):
    """After the first is denied, what is tried holds: 50, 90 and then 70 % of what the first promised."""
    shares, asked = iter([0.5, 0.9, 0.7]), []

    def again(kinds):
        found = tooling_without(kinds, PART, study.bowl, "A", rule="csa", verdicts=1)
        share = next(shares, None)
        if share is None:
            return replace(found, designs=tuple(replace(one, isolated=False) for one in found.designs))
        asked.append(kinds)
        wiper = replace(make_device("wiper", "here", limit=1e-3), text=f"{len(asked)} mm")
        cut = replace(found.design.cuts[0], device=wiper)
        less = replace(found.design, cuts=(cut,), isolated=True, efficiency=share * study.design.efficiency)
        return replace(found, designs=tuple(less for _ in found.designs))

    monkeypatch.setattr(tooling_trials, "_tried", Verdicts(1))
    monkeypatch.setattr(tooling_trials, "_ways_on", lambda *_: [("wiper",)] * 3)
    found = tooling_trials.own_trials(study, again)
    assert len(asked) == 3 and len(found.trials) == 4
    assert found.design.efficiency == pytest.approx(0.9 * study.design.efficiency)
    assert [bool(one.faults) for one in found.trials] == [False, True, False, False]


def test_of_a_chain_that_is_denied_as_well_less_is_tried(study):
    first = tooling_trials._ways_on((), study.design)
    assert all(("rails", *kinds) in tooling_trials._ways_on(("rails",), study.design) for kinds in first)


@pytest.mark.parametrize(("limit", "tries", "searches"), [("TRIES", 3, 2), ("SEARCHES", 4, 3)])
def test_the_search_for_another_chain_has_an_end(monkeypatch, study, limit, tries, searches):
    """Where every other chain is another one and none holds."""
    asked = []

    def again(kinds):
        asked.append(kinds)
        found = tooling_without(kinds[:1], PART, study.bowl, "A", rule="csa", verdicts=1)
        wiper = replace(make_device("wiper", "here", limit=1e-3), text=f"{len(asked)} mm")
        cut = replace(study.design.cuts[0], device=wiper)
        other = replace(study.design, cuts=(cut,), isolated=True)
        return replace(found, designs=tuple(other for _ in found.designs))

    monkeypatch.setattr(tooling_trials, "_tried", Verdicts(99))
    monkeypatch.setattr(tooling_trials, "_ways_on", lambda *_: [("wiper",)] * 3)
    monkeypatch.setattr(tooling_trials, limit, 3)
    found = tooling_trials.own_trials(study, again)
    assert (len(found.trials), len(asked)) == (tries, searches)


def test_without_a_trial_the_static_rule_is_named(study):
    assert tables.document(study)["status"] == "static"
    none = replace(study, designs=tuple(SimpleNamespace(isolated=False) for _ in study.designs))
    assert tables.status(none, 0) == "none"
    assert "# By the static rule, not tried: see feeder trial." in tables.bowl_file(study, ())
