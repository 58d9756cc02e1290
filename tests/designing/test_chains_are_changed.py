"""What a trial denies changes the chain: drops before it, wider slots, values moved."""

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
import shapes

from feederscrew import bowl as bowls
from feederscrew.designing import proposals, short_trials
from feederscrew.designing.proposals import (
    PULSE_RESERVE,
    PULSE_STEP_S,
    SHORTEST_PULSE_STEPS,
    longer,
    quickened,
)
from feederscrew.designing.record import DesignRequest
from feederscrew.part import load
from feederscrew.rates import stream
from feederscrew.resting.aspects import find
from feederscrew.running import RunSettings
from feederscrew.tooling import sensor_views
from feederscrew.tooling.devices.kinds import make_device
from feederscrew.tooling.devices.pneumatics import PULSE
from feederscrew.tooling.isolating.chain import Cut, judge_cut
from feederscrew.tooling.verdicts import DeviceEncounter, verdict

PARTS = Path(__file__).resolve().parents[2] / "parts"


@pytest.fixture(scope="module")
def block():
    """A block of 20 x 12 x 5 mm along a track without a device, and how it lies there."""
    part = shapes.part(shapes.box(20, 12, 5))
    ways = proposals.known_through(part, find(part), bowls.default())
    return part, ways, {one.name: k for k, one in enumerate(ways.lying)}


def tried(ways, right, wrong, held, row):
    """A short trial of all orientations, two of each."""
    count = len(ways.lying)
    own = [np.array([2 * (k in some) for k in range(count)]) for some in (right, wrong, held)]
    return short_trials.Tried(
        ways, np.full(count, 1.0 / count), np.arange(count), np.full(count, 2), *own,
        places=tuple({"stopped at gap": 2} if k in held else {} for k in range(count)), velocity=0.05,
        state=row, states=(row,), deepest=0.0,
    )  # fmt: skip


def test_a_drop_is_put_before_what_is_carried_through(block):
    _, ways, names = block
    across, along = names["A@90"], names["A@0"]
    proposal = proposals.Proposal(along, (), (), "no device")
    seen = tried(ways, {along}, {across}, (), along)
    better = proposals.better(proposal, seen, ways.lying)
    (cut,) = better.cuts
    values = proposals.limits(type(cut.device), ways.lying)
    sign = 1.0 if cut.device.bound == "lower" else -1.0
    assert sign * values[across] < sign * cut.device.limit < sign * values[along]
    assert "A@90" in cut.returns and "A@0" not in cut.returns


def test_an_aspect_that_may_be_up_as_well_counts_as_the_wanted_one(block):
    part, ways, names = block
    along, across = names["A@0"], names["A@90"]
    assert proposals.equivalent_rows(ways.lying, along, ()) == ()
    same = proposals.equivalent_rows(ways.lying, along, ("a",))
    assert (
        along not in same and across in same and len(same) == sum(one.aspect == "A" for one in ways.lying) - 1
    )
    states = short_trials.wanted_states(ways, (along, *same))
    assert states[0] == ways.leaves_as[along] and ways.leaves_as[across] in states
    shares = np.arange(1.0, len(ways.lying) + 1.0)
    assert short_trials.gain(ways, shares, states) == pytest.approx(shares[[along, *same]].sum())
    bowl = bowls.default()
    one = {"rows": (along, across), "each": 1, "run": RunSettings(1)}
    alone = short_trials.single(part, bowl, ways, shares, along, **one)
    both = short_trials.single(part, bowl, ways, shares, (along, *same), **one)
    assert (list(alone.right), list(alone.wrong)) == ([1, 0], [0, 1])
    assert (list(both.right), list(both.wrong)) == ([1, 1], [0, 0])
    assert short_trials.faults(alone) and not short_trials.faults(both)


def test_of_what_counts_as_the_wanted_one_a_loss_is_no_fault_but_a_stop_is(block):
    _, ways, names = block
    along, across = names["A@0"], names["A@90"]
    states = short_trials.wanted_states(ways, (along, across))
    lost = replace(tried(ways, {along}, (), (), along), states=states)
    assert not short_trials.faults(lost)
    assert short_trials.faults(replace(lost, right=0 * lost.right))  # the wanted one itself has to leave
    stays = replace(tried(ways, {along}, (), {across}, along), states=states)
    assert short_trials.faults(stays) == ["A@90 stays (stopped at gap)"]
    carried = replace(tried(ways, {along}, {across}, (), along), states=states)
    assert short_trials.faults(carried) == [f"A@90{short_trials.CARRIED}"]


def test_trials_of_different_orientations_are_joined(block):
    _, ways, _ = block
    whole = tried(ways, {0, 1}, {2}, (), 0)
    first, second = (
        replace(whole, **{n: getattr(whole, n)[part] for n in ("rows", "parts", "right", "wrong", "held")},
                places=whole.places[part])
        for part in (slice(0, 2), slice(2, None))
    )  # fmt: skip
    joined = first.joined(second)
    assert (joined.efficiency, joined.carried) == pytest.approx((whole.efficiency, whole.carried))
    assert joined.places == whole.places


def test_more_parts_of_one_orientation_count_with_the_first(block):
    _, ways, _ = block
    first = tried(ways, {0, 1}, {2}, {3}, 0)
    second = replace(
        first, rows=np.array([2, 0]), parts=np.array([5, 3]), right=np.array([1, 3]), wrong=np.array([4, 0]),
        held=np.array([0, 0]), places=({"stopped at gap": 1}, {}), turns=({"turned at gap": 2}, {}),
    )  # fmt: skip
    both = first.joined(second)
    assert both.rows.tolist() == first.rows.tolist() and both.places[2] == {"stopped at gap": 1}
    assert both.parts[[0, 1, 2]].tolist() == [5, 2, 7] and both.right[[0, 2]].tolist() == [5, 1]
    assert both.wrong[2] == 6 and both.held[3] == 2 and both.turns[2] == {"turned at gap": 2}
    even = 1.0 / len(ways.lying)
    assert both.efficiency == pytest.approx(even * (1.0 + 1.0 + 1.0 / 7.0))


def test_a_sensor_is_drawn_with_other_play_and_the_drawn_part_s_name(block):
    _, ways, names = block
    one = ways.lying[names["A@0"]]
    sorter = make_device("sorter", "test", like=(one.aspect, one.heading, 1e-3), text="test")
    rng = np.random.default_rng(1)
    drawn = short_trials.drawn_bowl(replace(bowls.default(), devices=(sorter,)), ways.lying, rng).devices[0]
    assert drawn.like[:2] == sorter.like[:2] and 0.0 < abs(drawn.like[2] - 1e-3) <= short_trials.CUT


def test_a_chain_costs_what_its_dearest_device_does():
    gap = make_device("gap", "test", limit=9e-3, text="9 mm")
    jet, sorter = make_device("jet", "test", text="test"), make_device("sorter", "test", text="test")
    costs = [
        proposals.Proposal(0, (), chain, "test").cost_class
        for chain in ((), (gap,), (gap, jet), (sorter, gap))
    ]
    assert costs == [1, 1, 2, 3]


@pytest.mark.parametrize("cost_class, dearer", [(1, {"jet", "sorter"}), (3, set())])
def test_a_cost_class_is_proposed_without_dearer_devices_and_the_widest_margin_comes_first(
    cost_class, dearer
):
    ways = proposals.recipes_of(cost_class, DesignRequest(target=1.0))
    assert all(dearer <= set(way.without) for way in ways)
    assert any("sorter" not in way.without for way in ways) == (cost_class == 3)
    margins = [way.margin for way in ways if not way.turns and not way.holes]
    assert margins == sorted(margins, reverse=True) and len(set(margins)) == 2
    assert [way.outcome for way in ways if way.holes] == ["lying"] * (cost_class == 1)


def test_no_way_is_left_of_a_class_whose_devices_are_not_to_be_used():
    assert proposals.recipes_of(3, DesignRequest(target=1.0, without=("sorter",))) == []
    hung = proposals.recipes_of(1, DesignRequest(target=1.0, outcome="hanging"))
    assert {way.outcome for way in hung} == {"hanging"} and not any(way.turns for way in hung)


def test_a_blade_at_which_parts_stay_is_swept_otherwise(block):
    _, ways, names = block
    wanted, others = names["A@0"], names["C@0"]
    wiper = make_device("wiper", "test", limit=8e-3, sweep=np.radians(30.0)).rewritten()
    cut = Cut(wiper, 1e-3, 1e-3, wiper, wiper, ())
    proposal = proposals.Proposal(wanted, (cut,), (), "test")
    seen = tried(ways, {wanted}, (), {others}, wanted)
    assert proposals.swept(proposal, seen, ways.lying) is None  # it stays at a gap
    seen = replace(seen, places=tuple({"stopped at wiper": 2} if one else {} for one in seen.places))
    sweeps = []
    while proposal is not None:
        proposal = proposals.swept(proposal, seen, ways.lying)
        sweeps += [] if proposal is None else [round(np.degrees(proposal.devices[0].sweep))]
    assert sweeps[:2] == [35, 20] and len(set(sweeps)) == len(sweeps) and 30 not in sweeps


def test_a_wanted_part_that_comes_back_denies_a_draw_only_where_most_of_the_others_do_too(block):
    _, ways, names = block
    along, across = names["A@0"], names["A@90"]
    seen = tried(ways, {along}, (), (), along)
    back = replace(
        seen, places=tuple({"returned at gap": 2} if k == across else {} for k in range(len(ways.lying)))
    )
    assert short_trials.came_back(back, across) and not short_trials.came_back(back, along)
    pair = replace(
        back, **{n: getattr(back, n)[[along, across]] for n in ("rows", "parts", "right", "wrong", "held")}
    )
    assert short_trials.comes_through(pair, {along: 0.5, across: 0.5})  # half of them leave
    assert not short_trials.comes_through(pair, {along: 0.4, across: 0.6})
    assert short_trials.comes_through(pair, {along: 0.7, across: 0.3}, 0.7)  # and all that the target needs
    assert not short_trials.comes_through(pair, {along: 0.7, across: 0.3}, 0.75)
    assert not short_trials.comes_through(replace(pair, held=np.array([0, 1])), {along: 0.9, across: 0.1})


def test_what_comes_back_of_several_wanted_ones_is_no_fault_while_another_leaves(block):
    _, ways, names = block
    along, across = names["A@0"], names["A@90"]
    leaving = ways.leaving.copy()
    leaving[across] = leaving[along]  # both leave in the one state, as parts that hang do
    both = replace(ways, leaving=leaving)
    seen = tried(both, {along}, (), (), along)
    back = {"returned at narrowed track": 2}
    seen = replace(seen, places=tuple(back if k == across else {} for k in range(len(both.lying))))
    assert short_trials.spared_rows(seen) == (across,) and not list(short_trials.denied(seen))
    stays = replace(seen, held=2 * (np.arange(len(both.lying)) == across))
    assert short_trials.spared_rows(stays) == () and list(short_trials.denied(stays))
    assert short_trials.spared_rows(replace(seen, right=0 * seen.right)) == ()  # none of them leaves


def test_a_sensor_sees_something_of_every_drawn_part():
    bracket = load(PARTS / "lbracket_30x20x15.stl")
    other = short_trials.drawn_part(bracket, 1e-4, np.random.default_rng((1, 1)))
    bowl = bowls.default()
    ways = stream.follow_orientations(other, find(other), bowl.track, (), bowl=bowl)
    turned = next(
        one for one in ways.lying if one.name == "B@264"
    )  # closing its slits by 0.02 mm left nothing
    assert sensor_views.outline(turned, "outline").area > 9.5e-5
    assert min(sensor_views.outline(one, "side").area for one in ways.lying) > 5e-5


def test_of_a_drawn_part_only_what_is_tried_is_judged(monkeypatch, block):
    """Through a sorter and rails: what is asked for becomes of it what becomes of it among all others."""
    part, ways, names = block
    one = ways.lying[names["A@0"]]
    like = {"like": (one.aspect, one.heading, 1e-3), "text": "test"}
    chain = (make_device("gap", "test", limit=7e-3, text="7 mm"), make_device("sorter", "test", **like))
    own = {"aspects": find(part), "chain": chain, "bowl": bowls.default()}
    whole, judged = stream.along(ways.lying, **own), []
    monkeypatch.setattr(
        "feederscrew.tooling.fates.verdict",
        lambda device, one, *more: judged.append(one) or verdict(device, one, *more),
    )
    rows = [names["A@90"], names["A@0"], names["B@0"]]
    some = stream.along(ways.lying, **own, rows=set(rows))
    assert np.array_equal(some.leaving[rows], whole.leaving[rows])
    assert [one.name for one in some.states] == [one.name for one in whole.states]
    assert np.array_equal(some.leaves_as[rows], whole.leaves_as[rows])
    assert [some.fates[k] for k in rows] == [whole.fates[k] for k in rows]
    assert len(judged) == len(rows) + int((whole.passes[rows, 1] > 0.0).sum()) < 2 * len(ways.lying)
    assert {some.fates[names["A@0"]], some.fates[names["A@90"]]} == {"carried", "returned"}


def test_what_draws_carry_through_is_cut_by_more(block):
    """A drop moves from the value in the middle towards the greatest that the block still passes."""
    _, ways, names = block
    across, along = names["A@90"], names["A@0"]
    seen = tried(ways, {along}, {across}, (), along)
    proposal = proposals.better(proposals.Proposal(along, (), (), "no device"), seen, ways.lying)
    drawn = short_trials.RobustRun(20, 18, "A@90 is carried through in 2 of 20")
    (before,), (after,) = proposal.cuts, proposals.better(proposal, seen, ways.lying, drawn).cuts
    middle = 0.5 * (before.device.limit + before.largest.limit)
    assert after.device.limit == pytest.approx(middle, abs=proposals.VALUE_STEP_M)
    assert after.margin_pass > 0.0 and "A@90" in after.returns
    other = replace(drawn, worst="A@0 is carried through in 2 of 20")  # nothing tells it from itself
    assert proposals.better(proposal, seen, ways.lying, other) is None


def test_what_left_a_queue_instead_is_cut_by_more(block):
    _, ways, names = block
    across, along = names["A@90"], names["A@0"]
    seen = tried(ways, {along}, {across}, (), along)
    proposal = proposals.better(proposals.Proposal(along, (), (), "no device"), seen, ways.lying)
    candidate = SimpleNamespace(proposal=proposal, tried=seen, orientations=ways)
    changed = proposals.purer(candidate, (("in no known pose", 3), ("A@90", 2)))
    (before,), (after,) = proposal.cuts, changed.cuts
    assert abs(after.device.limit - after.largest.limit) < abs(before.device.limit - before.largest.limit)
    assert proposals.purer(candidate, (("in no known pose", 3),)) is None


def test_a_pressure_break_carries_what_is_wanted_and_lets_it_reach_over_the_ledge(block):
    """A ledge under a block of 12 mm: wider than half of that by the margin, and narrower than it."""
    _, ways, names = block
    seen = tried(ways, {names["A@0"]}, (), (), names["A@0"])
    candidate = SimpleNamespace(
        proposal=proposals.Proposal(names["A@0"], (), (), "test"), tried=seen, orientations=ways
    )
    changed = proposals.relieved(candidate)
    (cut,) = changed.cuts
    assert cut.device.kind == "pressure_break" and not cut.returns.count("A@0")
    assert 6e-3 + proposals.MARGINS[-1] <= cut.device.limit <= 12e-3 - proposals.MARGINS[-1]
    candidate.proposal = changed
    assert proposals.relieved(candidate) is None  # it has one


def test_draws_end_once_more_have_failed_than_may(monkeypatch, block):
    part, ways, _ = block
    results = iter([["B is lost"], [], ["B is lost"], [], []])
    monkeypatch.setattr(short_trials, "_draw", lambda *_: (next(results), 0.05))
    shares = np.full(len(ways.lying), 1.0)
    own = {"draws": 5, "tolerance": 1e-4, "run": RunSettings(1)}
    drawn = short_trials.robust_run(part, bowls.default(), ways, shares, 0, allowed=1, **own)
    assert (drawn.draws, drawn.held, drawn.partial) == (3, 1, False)
    results = iter([[], [], [], ["B is lost"], []])
    drawn = short_trials.robust_run(part, bowls.default(), ways, shares, 0, allowed=1, **own)
    assert (drawn.draws, drawn.held) == (5, 4)


def tried_pulses(ways, right, wrong):
    """A short trial of all orientations, one of each, on their way to the first state."""
    count = len(ways.lying)
    own = [np.array([int(k in some) for k in range(count)]) for some in (right, wrong, ())]
    return short_trials.Tried(
        ways, np.full(count, 1.0 / count), np.arange(count), np.ones(count, int), *own,
        places=({},) * count, velocity=0.05, state=0, states=(0,), deepest=0.0,
    )  # fmt: skip


@pytest.fixture(scope="module")
def wedge():
    """A wedge of 24 x 13 mm on a banked track, a sorter of its first orientation, and what that returns."""
    corners = np.array([[0, 0], [0.024, 0], [0.024, 0.004], [0.004, 0.013]])
    part = shapes.part(shapes.prism(1e3 * corners, 7.0))
    bowl = bowls.read(None, ["track.bank=5 deg", "track.width=30 mm"])
    ways = proposals.known_through(part, find(part), bowl)
    one = ways.lying[0]
    like = {"like": (one.aspect, one.heading, 1e-3), "text": "{of: A@0, play: 1 mm, sees: outline}"}
    device = make_device("sorter", "test", **like)
    must = np.arange(len(ways.lying)) > 0
    return ways, judge_cut(ways.lying, 0, device, must, device, device)


def reserve(cut, every, time):
    """The least way [m] beyond the edge over which a share of a pulse carries what the cut returns."""
    gone = [DeviceEncounter(one, every) for one in every if one.name in cut.returns]
    return min(met.blown(*cut.device.jet.push(met.orientation, every), time / PULSE_RESERVE) for met in gone)


def weighing(every, times):
    """Orientations of a part so many times as heavy."""
    return [replace(one, posture=replace(one.posture, mass=times * one.posture.mass)) for one in every]


def test_a_pulse_is_the_shortest_with_its_reserve_and_the_file_says_so(wedge):
    ways, cut = wedge
    found = []
    for times in (0.2, 0.9, 1.2, 50.0):
        every = weighing(ways.lying, times)
        device = quickened(cut, every).device
        found.append(device.time)
        if device.time < PULSE:
            assert reserve(cut, every, device.time) > 0.0
            assert (
                device.text
                == f"{cut.device.rewritten().text[:-1]}, jet: {{time: {1e3 * device.time:.0f} ms}}}}"
            )
            assert device.gap(every[0], 0.2) == pytest.approx(
                cut.device.gap(every[0], 0.2) - 0.2 * (PULSE - device.time)
            )
        if device.time > PULSE_STEP_S * SHORTEST_PULSE_STEPS:
            assert reserve(cut, every, device.time - PULSE_STEP_S) <= 0.0
    assert found[0] == PULSE_STEP_S * SHORTEST_PULSE_STEPS < found[1] < found[2] <= found[3] == PULSE


def test_what_is_carried_through_makes_the_pulse_longer_up_to_that_of_before(wedge):
    ways, cut = wedge
    proposal = proposals.Proposal(0, (quickened(cut, weighing(ways.lying, 0.2)),), (), "test")
    slipped = next(k for k, one in enumerate(ways.lying) if one.name in cut.returns)
    seen, times = tried_pulses(ways, {0}, {slipped}), []
    assert longer(proposal, tried_pulses(ways, {0}, ()), ways.lying) is None
    for _ in range(3):
        other = longer(proposal, seen, ways.lying)
        if other is None:
            break
        assert proposals.better(proposal, seen, ways.lying).chain == other.chain
        (device,) = other.devices
        times.append(device.time)
        assert other.step == f"pulse of {1e3 * device.time:.0f} ms" and ("jet" in device.text) == (
            device.time < PULSE
        )
        proposal = other
    assert other is None and times == pytest.approx([0.04]) and times[-1] == PULSE
