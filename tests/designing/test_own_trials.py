"""What ``feeder tooling`` says of its own proposal: the trial comes first, and the next best are tried."""

from dataclasses import dataclass, replace

import numpy as np
import pytest
import shapes

from feederscrew import bowl as bowls
from feederscrew.arrivals.ensemble import wilson
from feederscrew.bowl.devices.kinds import CostClass, make_device
from feederscrew.designing import short_trials, tooling_trials
from feederscrew.designing.findings import Fault, FaultKind
from feederscrew.output import tooling as tables
from feederscrew.resting.aspects import find
from feederscrew.sorting.isolating import chain
from feederscrew.sorting.orientations import orientations
from feederscrew.sorting.tooling import ToolingSearch, tooling, tooling_without


@pytest.fixture(scope="module")
def study(block):
    return tooling(block.part, bowls.read(None, []), "A", search=ToolingSearch(rule="csa", verdicts=1))


@dataclass
class Verdicts:
    denials: int

    def __call__(self, study, one, *_):
        self.denials -= 1
        faults = (Fault(FaultKind.NOTHING_LEAVES),) if self.denials >= 0 else ()
        devices, name = tooling_trials._devices(one), study.orientations[one.wanted].name
        return tooling_trials.TriedDesign(name, one.wanted, devices, one.efficiency, 0.0, np.nan, 6, faults)


def searched(study, kinds, cost_class=None):
    own = {"search": ToolingSearch(rule="csa", verdicts=1), "cost_class": cost_class}
    return tooling_without(kinds, study.part, study.bowl, "A", **own)


@pytest.fixture
def try_static(monkeypatch, study):
    """Try chains of the static rule alone, of its own class or of all."""
    monkeypatch.setattr(tooling_trials, "search_chains", lambda *_: iter(()))
    own = CostClass.of(study.design.devices)
    return lambda again, **asked: tooling_trials.try_designs(study, again, **{"cost_class": own} | asked)


@pytest.mark.parametrize("denials", [0, 1, 3])
def test_what_the_trial_denies_is_not_isolated_and_the_next_best_are_tried(
    monkeypatch, study, try_static, denials
):
    monkeypatch.setattr(tooling_trials, "_try_design", Verdicts(denials))

    def again(kinds, cost_class):
        found = searched(study, kinds, cost_class)
        assert not {cut.device.kind for cut in found.design.cuts} & set(kinds)
        return found

    found = try_static(again, cost_class=None)
    told, said = tables.document(found), tables.remarks(found)[0]
    if denials < 3:
        assert (told["status"], told["isolated"]) == ("confirmed", True) and said.endswith("the trial agrees")
        assert (found.design.devices != study.design.devices) == (denials > 0)
        assert [bool(one.faults) for one in found.trials][: 1 + denials] == [False, True][: 1 + denials]
        return
    assert found.design is study.design and 2 <= len(found.trials) <= 3 * tooling_trials.TRIES
    assert (told["status"], told["isolated"], told["isolated_static"]) == ("denied", False, True)
    assert found.isolates(found.wanted) is False
    assert said.startswith(f"{found.orientations[found.wanted].name} is not isolated: the")
    assert "the trial denies it: nothing leaves as wanted" in said
    denied, agreed = tables.trials(found)
    assert len(denied) == len(found.trials) - 1 and not agreed
    assert all(text.startswith("tried as well, ") for text in denied)
    assert "# DENIED by its trial: nothing leaves as wanted." in tables.bowl_file(found, ())


def with_wiper(design, number, **more):
    """The design with another device in place of its first: another chain, that holds."""
    wiper = replace(make_device("wiper", "here", limit=1e-3), text=f"{number} mm")
    return replace(design, cuts=(replace(design.cuts[0], device=wiper),), isolated=True, **more)


@pytest.fixture
def ways_on(monkeypatch):
    monkeypatch.setattr(tooling_trials, "_ways_on", lambda *_: [("wiper",)] * 3)


def test_of_those_that_hold_the_most_efficient_is_taken(monkeypatch, study, ways_on, try_static):
    """After the first is denied, what is tried holds: 50, 90 and then 70 % of what the first promised."""
    shares, asked = iter([0.5, 0.9, 0.7]), []

    def again(kinds, _):
        found = searched(study, kinds)
        share = next(shares, None)
        if share is None:
            return replace(found, designs=tuple(replace(one, isolated=False) for one in found.designs))
        asked.append(kinds)
        less = with_wiper(found.design, len(asked), efficiency=share * study.design.efficiency)
        return replace(found, designs=(less,) * len(found.designs))

    monkeypatch.setattr(tooling_trials, "_try_design", Verdicts(1))
    found = try_static(again)
    assert len(asked) == 3 and len(found.trials) == 4
    assert found.design.efficiency == pytest.approx(0.9 * study.design.efficiency)
    assert [bool(one.faults) for one in found.trials] == [False, True, False, False]


@pytest.mark.parametrize(("limit", "tries", "searches"), [("TRIES", 3, 2), ("SEARCHES", 4, 3)])
def test_the_search_for_another_chain_has_an_end(
    monkeypatch, study, ways_on, try_static, limit, tries, searches
):
    asked = []

    def again(kinds, _):
        asked.append(kinds)
        found = searched(study, kinds[:1])
        return replace(found, designs=(with_wiper(study.design, len(asked)),) * len(found.designs))

    monkeypatch.setattr(tooling_trials, "_try_design", Verdicts(99))
    monkeypatch.setattr(tooling_trials, limit, 3)
    found = try_static(again)
    assert (len(found.trials), len(asked)) == (tries, searches)


def told(ways, shares, purity=1.0):
    """What is said of no device at all, behind which the first orientation is wanted."""
    task = chain.design_task(ways.lying, np.array(shares), 0, 1e-4, purity, ())
    return chain.propose(task, (), np.zeros(len(ways.lying), bool))


def test_a_rare_orientation_is_not_isolated_by_others_that_are_rare_too(ways):
    """0.4 % come as wanted, as many in each other way: a fifth of what leaves, or less, is wanted."""
    count = len(ways.lying)
    rare = told(ways, [0.004] * count)
    assert rare.purity < 0.5 and not rare.isolated
    assert any("of what leaves is so" in reason for reason in rare.reasons)
    pure = told(ways, [0.4] + [1e-3] * (count - 1))
    assert pure.purity > 0.98 and pure.isolated
    mixed = told(ways, [0.1] + [4e-3] * (count - 1))
    assert not mixed.isolated and told(ways, [0.1] + [4e-3] * (count - 1), purity=0.5).isolated


def counted(ways, shares, rows, parts, right, wrong):
    own = (np.array(values) for values in (shares, rows, parts, right, wrong))
    none, places = np.zeros(len(rows), int), tuple({} for _ in rows)
    return short_trials.ShortTrial(ways, *own, none, places, 0.05, (0,))


def test_the_shares_of_a_trial_have_an_interval_that_holds_the_true_ones_and_narrows(ways):
    """Of one orientation alone the interval is Wilson's; what was not tried counts as the rule says."""
    count = len(ways.lying)
    alone = np.zeros(count)
    alone[0] = 1.0
    efficiency, purity = tooling_trials.shares_leaving(counted(ways, alone, [0], [20], [15], [5]))
    low, high = (float(end[0]) for end in wilson([15], 20))
    assert efficiency == pytest.approx((0.75, low, high))
    assert purity[0] == pytest.approx(0.75) and purity[1] < 0.75 < purity[2]
    even = np.full(count, 1.0 / count)
    others = float((even * ways.leaves)[1:].sum())
    efficiency, purity = tooling_trials.shares_leaving(counted(ways, even, [0], [20], [20], [0]))
    assert efficiency[0] == pytest.approx(1.0 / count)
    assert purity[0] == pytest.approx((1.0 / count) / (1.0 / count + others))
    # of 60, 30 and 10 %; with two of each the interval of a clean trial is 0.60 wide, then 0.24
    counts = tooling_trials.further_parts(np.array([0.6, 0.3, 0.1]))
    assert counts.tolist() == [12, 6, 2] and tooling_trials.further_parts(np.zeros(3)).tolist() == [0, 0, 0]
    shares = np.zeros(len(ways.lying))
    shares[:3] = 0.6, 0.3, 0.1
    widths = []
    for parts in (np.full(3, 2), 2 + counts):
        one = counted(ways, shares, [0, 1, 2], parts, [parts[0], 0, 0], [0, 0, 0])
        (_, low, high), _ = tooling_trials.shares_leaving(one)
        widths.append(high - low)
    assert widths == pytest.approx([0.60, 0.24], abs=0.01)
    # Drawn from known chances, 4 of each: the ends hold them in at least 19 of 20
    rng, count = np.random.default_rng(5), len(ways.lying)
    shares, chance = rng.dirichlet(np.ones(count)), np.array([0.9, *rng.uniform(0.0, 0.3, count - 1)])
    rows, parts, held = np.arange(count), np.full(count, 4), []
    right_chance = np.where(rows == 0, chance, 0.0)
    wrong_chance = np.where(rows == 0, 0.0, chance)
    true = float((shares * right_chance).sum())
    pure = true / (true + float((shares * wrong_chance).sum()))
    for _ in range(200):
        one = counted(ways, shares, rows, parts, rng.binomial(4, right_chance), rng.binomial(4, wrong_chance))
        (_, low, high), (_, least, most) = tooling_trials.shares_leaving(one)
        held.append(low <= true <= high and least <= pure <= most)
    assert np.mean(held) >= 0.95


@pytest.fixture
def single(monkeypatch, ways, study):
    """Stands for single parts: what is wanted leaves right, a share of the others wrong; calls are noted."""
    calls, wrong_share = [], [0.0]

    def call(part, bowl, ways, shares, wanted, *, rows, count, run, **_):
        rows, count = np.array(rows), np.broadcast_to(count, len(rows))
        calls.append((run.seed, int(count.sum())))
        wanted_rows, state = rows == study.wanted, int(ways.leaves_as[study.wanted])
        right, wrong = np.where(wanted_rows, count, 0), np.where(wanted_rows, 0, wrong_share[0] * count)
        none, places = np.zeros(len(rows), int), tuple({} for _ in rows)
        own = rows, count, right, wrong, none, places, 0.05, (state,)
        return short_trials.ShortTrial(ways, shares, *own)

    monkeypatch.setattr(short_trials, "try_parts", call)
    return calls, wrong_share


def test_only_what_the_trial_does_not_deny_is_tried_with_more_and_purity_denies(monkeypatch, study, single):
    calls, _ = single
    (one,) = tooling_trials.try_designs(study, seed=3).trials
    assert [seed for seed, _ in calls] == [3, 4] and 18 <= calls[1][1] <= 22
    assert one.parts == calls[0][1] + calls[1][1]
    calls.clear()
    monkeypatch.setattr(tooling_trials, "find_denials", lambda _: ("nothing leaves as wanted",))
    tooling_trials.try_designs(study, seed=3)
    assert [seed for seed, _ in calls] == [3]
    # the rule lets the others go back; the trial carries half of one that comes as often
    single[1][0] = 0.5
    monkeypatch.setattr(tooling_trials, "find_denials", lambda _: ())
    (one,) = tooling_trials.try_designs(study).trials
    assert one.purity < 0.98 and one.faults and not one.agrees
    document = tables.document(replace(study, trials=(one,)))
    assert document["isolated"] is False and document["status"] == "denied"
    assert document["purity"] == one.purity


@pytest.mark.parametrize("hangs", [False, True])
def test_a_table_whose_designs_are_all_denied_has_what_the_search_finds(monkeypatch, study, hangs):
    """The search is that of --aspect: a table said no of the README's bolt, and --aspect A said yes."""
    place, found = study.wanted, study.design
    other = next(k for k in range(len(study.orientations)) if k != place)
    designs = [None] * len(study.orientations)
    designs[place] = designs[other] = found
    designs[other] = replace(found, wanted=other, efficiency=0.5 * found.efficiency)
    table = replace(study, wanted=None, designs=tuple(designs))
    first = Verdicts(2)

    def tried(one_study, one, *_):
        return replace(first(one_study, one), left=(study.orientations[other].name,))

    asked = []

    def chains(one, cost_class):
        asked.append((one.study.orientations[one.study.wanted].name, one.heading_given, cost_class))
        rails = make_device("rails", "test", span=(1e-3, 2e-3))
        cuts = (replace(found.cuts[0], device=rails),) if hangs else found.cuts
        own = list(designs)
        own[place] = replace(found, cuts=cuts)
        yield replace(table, designs=tuple(own), wanted=place)

    monkeypatch.setattr(tooling_trials, "_try_design", tried)
    monkeypatch.setattr(tooling_trials, "search_chains", chains)
    result = tooling_trials.try_designs(table, lambda *_: pytest.fail("nothing static is proposed"))
    assert asked[0] == (study.orientations[place].name, False, CostClass.STEEL) and len(asked) == 1
    assert result.isolates(place) and result.isolates(other) is hangs
    assert result.wanted is None and {trial.wanted for trial in result.trials} == {place, other}
    denied, agreed = tables.trials(result)
    assert (len(denied), len(agreed)) == ((0, 2) if hangs else (1, 1))
    assert all(f"--aspect {study.orientations[other].name} tries" in line for line in denied)
    # where the trial confirms one, a cheaper class alone is looked for
    own = CostClass.of(found.devices)
    for asked_class, searched_in in ((own, []), (None, [CostClass.STEEL])):
        monkeypatch.setattr(tooling_trials, "_try_design", Verdicts(1))
        asked.clear()
        tooling_trials.try_designs(table, lambda *_: None, cost_class=asked_class)
        assert [cost for *_, cost in asked] == (searched_in if own is not CostClass.STEEL else [])
    monkeypatch.setattr(tooling_trials, "_try_design", Verdicts(9))
    again = tooling_trials.try_designs(table, lambda *_: None)
    assert not any(again.isolates(k) for k in (place, other)) and len(again.trials) == 2


def test_no_trial_begins_after_the_limit(monkeypatch, study, single):
    """Parts were sent through three proposals after the time was over: a limit of 25 s took 40."""
    calls = single[0]
    late = tooling_trials.try_designs(study, until=-np.inf)
    assert late.trials == () and not calls and not late.partial
    assert len(tooling_trials.try_designs(study, until=np.inf).trials) == 1


def test_what_is_printed_is_the_trials_and_a_least_without_one(study):
    found, place = study.design, study.wanted
    whole, half = found.efficiency, 0.5 * found.efficiency
    static = tables.efficiency_and_purity(found, study.trial_of(place))
    assert static["efficiency"] == found.least <= whole == static["efficiency_static"]
    less = replace(study, designs=(replace(found, surely=half),) * len(study.designs))
    assert tables.document(less)["efficiency"] == pytest.approx(half)
    assert "at least" in tables.remarks(less)[0]
    ends = (0.8 * half, 1.2 * half), (0.97, 1.0)
    one = tooling_trials.TriedDesign("A@0", place, (), whole, half, 0.99, 40, (), *ends)
    own = replace(study, trials=(one,))
    document = tables.document(own)
    assert document["efficiency"] == pytest.approx(half)
    assert (document["purity"], document["purity_low"]) == (0.99, 0.97)
    assert document["efficiency_static"] == pytest.approx(whole)
    assert not one.agrees and "agrees" not in tables.remarks(own)[0]
    wider = replace(one, efficiency_ends=(0.0, 1.0))
    assert wider.agrees and "the trial agrees" in tables.remarks(replace(study, trials=(wider,)))[0]


@pytest.mark.parametrize("angle", [80, 68])
def test_of_a_file_with_a_twist_its_own_chain_is_tried_and_holds_as_the_rule_says(
    monkeypatch, tmp_path, angle
):
    """Nothing may stand behind a twist: no other chain is looked for, of any class."""
    lines = "wiper: {clearance: 6 mm, sweep: 30 deg}", "narrowed track: 11 mm"
    lines = (*lines, f"twisted track: {{angle: {angle} deg, length: 120 mm}}")
    path = tmp_path / "bowl.yaml"
    path.write_text("track: {width: 30 mm}\ndevices:\n" + "".join(f"  - {line}\n" for line in lines))
    part, bowl = shapes.part(shapes.box(24, 14, 4)), bowls.read(path)
    aspects, asked = find(part), {"search": ToolingSearch(rule="closed")}
    (wanted,) = (one for one in orientations(part, aspects, bowl.track) if one.name == "B@0")
    assert wanted.height == pytest.approx(0.014)  # on the side that was at the wall
    asked["aspect_shares"] = aspects
    static = tooling(part, bowl, wanted.name, **asked)

    def again(kinds, cost_class=None):
        return tooling_without(kinds, part, bowl, wanted.name, cost_class=cost_class, **asked)

    tried = tooling_trials.try_designs(static, again)
    (own,) = tried.trials
    with monkeypatch.context() as patched:  # also where a trial denies it
        patched.setattr(tooling_trials, "_try_design", Verdicts(9))
        patched.setattr(tooling_trials, "search_chains", lambda *_: pytest.fail("nothing is searched"))
        assert [bool(one.faults) for one in tooling_trials.try_designs(static, again).trials] == [True]
    assert own.agrees and own.devices == tuple(f"{one.kind}: {one.text}" for one in bowl.devices)
    assert tried.isolates(tried.wanted) and tried.design.devices == bowl.devices
    assert own.efficiency == pytest.approx(static.design.efficiency, abs=0.01)
