"""The cheapest class of devices that isolates comes first: steel alone, steady air, a sensor."""

import functools
from dataclasses import replace

import numpy as np
import pytest
import shapes
from on_track import load

from feederscrew import bowl as bowls
from feederscrew.arrivals.entry import shares
from feederscrew.bowl.devices.kinds import KINDS, CostClass, cheaper, dearer
from feederscrew.designing import tooling_trials
from feederscrew.designing.tooling_trials import TriedDesign, try_designs
from feederscrew.output import tooling as tables
from feederscrew.sorting.tooling import ToolingSearch, next_class, tooling, tooling_without


@pytest.fixture(scope="module")
def bowl():
    return bowls.read(None, [])


@pytest.fixture(scope="module")
def bolt():
    return load("hexbolt_m8x25")


@pytest.fixture(scope="module")
def wanted(bolt, bowl, tmp_path_factory):
    """What is asked of the bolt: nearly all of it lies, some stands on its head."""
    path = tmp_path_factory.mktemp("counts") / "counts.csv"
    path.write_text("aspect,count\nA,997\nB,3\nC,0\n")
    own = {"aspect_shares": shares(bolt, bowl, probabilities=path), "search": ToolingSearch(verdicts=1)}
    return {"aspect": "A", "without": "cut-out", **own}


@pytest.fixture(scope="module")
def of_class(bolt, bowl, wanted):
    """The study of a class, made once."""
    return functools.cache(lambda cost_class: tooling(bolt, bowl, **wanted, cost_class=cost_class))


@pytest.fixture(scope="module")
def study(bolt, bowl, wanted):
    return tooling(bolt, bowl, **wanted)


def test_a_class_has_the_devices_of_its_number():
    assert [one.number for one in CostClass] == [1, 2, 3]
    for one in CostClass:
        kinds = {kind.kind: kind.trade.cost_class for kind in KINDS.values()}
        assert all(kinds[name] > one.number for name in dearer(one.number))
        assert all(kinds[name] < one.number for name in cheaper(one.number))
    assert {"rails", "wiper", "cut-out"} <= set(cheaper(2)) and "air jet" in cheaper(3)
    assert "banked track" not in cheaper(3)  # it rejects nothing


def test_a_headed_part_hangs_between_rails_where_a_camera_would_do_as_well(study, of_class):
    assert "rails" in [cut.device.kind for cut in study.design.cuts]
    assert study.class_of(study.wanted) is CostClass.STEEL
    sensor = of_class("sensor")
    assert CostClass.of(sensor.design.devices) is CostClass.SENSOR and sensor.design.isolated
    # the next class is the first dearer one that isolates, and has to be of that class
    asked = []

    def propose(cost_class):
        asked.append(cost_class)
        return of_class(str(cost_class))

    following = next_class(study, propose)
    assert asked == list(CostClass)[1 : 1 + len(asked)]
    assert CostClass.of(following.devices) is asked[-1]
    said = tables.next_class_words(replace(study, dearer=following))
    share, own = 100.0 * following.efficiency, 100.0 * study.design.least
    assert f"{share:.3g} % leave for {own:.3g} %" in said and said.endswith(f"--class {asked[-1]}")
    assert next_class(sensor, propose) is None  # none is dearer


def test_every_orientation_of_the_table_has_the_class_that_isolates_it(bolt, bowl, wanted):
    table = tooling(bolt, bowl, **{name: value for name, value in wanted.items() if name != "aspect"})
    rows = tables.document(table)["orientations"]
    for place, row in enumerate(rows):
        devices = [KINDS[kind].trade.cost_class for kind in row["devices"]]
        own = None if row["class"] is None else CostClass(row["class"]).number
        assert own == (max(devices, default=1) if table.isolates(place) else None)
    assert {"steel", "sensor"} >= {row["class"] for row in rows} - {None} != set()


@pytest.mark.parametrize("cost_class", list(CostClass))
def test_a_class_that_is_asked_for_has_no_dearer_device(of_class, cost_class):
    design = of_class(str(cost_class)).design
    assert CostClass.of(design.devices).number <= cost_class.number
    assert not design.isolated or CostClass.of(design.devices) is cost_class


def test_steady_air_that_is_left_out_is_not_proposed(bolt, bowl, wanted):
    design = tooling(bolt, bowl, **wanted | {"without": "cut-out,air jet"}, cost_class="air").design
    assert "air jet" not in {cut.device.kind for cut in design.cuts}


def test_a_turning_device_that_is_left_out_is_not_proposed(bowl):
    part = shapes.part(shapes.box(30, 20, 6), "plate")
    turning = {kind.kind for kind in KINDS.values() if kind.action.turns}
    search = {"search": ToolingSearch(rule="csa", verdicts=1, turn=True, vary=False)}
    own = {"without": ["vision reject", "air jet"], **search}
    found = [tooling(part, bowl, "C", **own), tooling(part, bowl, "C", **own | {"without": sorted(turning)})]
    used = [turning & {cut.device.kind for cut in study.design.cuts} for study in found]
    assert not used[1]


def tried(study, design, faults=()):
    name = study.orientations[design.wanted].name
    return TriedDesign(name, design.wanted, (), design.efficiency, 0.4, 1.0, 6, tuple(faults))


def test_what_a_trial_confirms_is_isolated_whatever_the_rule_says(study):
    """It said 'not isolated' of a chain that a trial had just shown to sort."""
    denied = replace(study.design, isolated=False)
    places = [denied if k == study.wanted else one for k, one in enumerate(study.designs)]
    by_rule = replace(study, designs=tuple(places))
    assert not by_rule.isolates(study.wanted) and by_rule.class_of(study.wanted) is None
    shown = replace(by_rule, trials=(tried(study, denied),))
    assert shown.isolates(study.wanted) and tables.status(shown, study.wanted) == "confirmed"
    assert shown.class_of(study.wanted) is CostClass.STEEL
    assert " is isolated: of 6 parts tried" in tables.remarks(shown)[0]


def test_a_dearer_class_is_tried_where_no_cheaper_chain_holds_in_its_trials(monkeypatch, study, of_class):
    """The search of a design is asked class by class, and its first chain that holds is taken."""
    asked = []
    sensor = of_class("sensor")

    def search_chains(_, cost_class):
        asked.append(cost_class)
        if cost_class is CostClass.SENSOR:
            yield sensor

    def try_design(own, design, _):
        steel = CostClass.of(design.devices) is not CostClass.SENSOR
        return tried(own, design, ["denied"] if steel else ())

    monkeypatch.setattr(tooling_trials, "search_chains", search_chains)
    monkeypatch.setattr(tooling_trials, "_try_design", try_design)
    monkeypatch.setattr(tooling_trials, "_ways_on", lambda *_: [])

    def propose(kinds, cost_class):
        static = of_class(str(cost_class))
        nothing = replace(static.design, isolated=False)  # by the rule no dearer chain isolates
        return replace(static, designs=tuple(nothing if one else None for one in static.designs))

    found = try_designs(study, propose)
    assert asked == list(CostClass) and found.class_of(found.wanted) is CostClass.SENSOR
    assert dict(found.in_vain) == {CostClass.STEEL: 1, CostClass.AIR: 0}
    assert any("no chain of steel held in 1 trial" in line for line in tables.remarks(found))
    asked.clear()
    only = try_designs(study, propose, cost_class="steel")
    assert asked == [CostClass.STEEL] and not only.isolates(only.wanted)


def test_a_bolt_is_fed_by_two_cuts_that_its_trial_confirms(bolt, bowl, wanted, study, monkeypatch):
    """It had a camera, where a toolmaker narrows the track and cuts rails."""
    monkeypatch.setattr(tooling_trials, "MORE_PARTS", 6)

    def propose(kinds, cost_class):
        return tooling_without(kinds, bolt, bowl, **wanted | {"cost_class": cost_class})

    found = try_designs(study, propose)
    devices = found.design.devices
    assert [device.kind for device in devices] == ["narrowed track", "rails"]
    first, last = devices[-1].span
    assert last - first > 8.05e-3  # the shank of an M8
    assert found.isolates(found.wanted) and found.leaves_as == "hanging"
    first = found.trials[0]
    assert np.isclose(first.purity, 1.0) and first.efficiency > 0.6
    low, high = first.efficiency_ends
    assert low < first.efficiency < high <= 1.0
