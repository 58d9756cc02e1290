"""What short trials and draws decide: every drawn quantity, and how what they deny changes the chain.

A number that is drawn evenly over a width w about c has the mean c and the standard deviation w / sqrt(12).
All samples are of fixed seeds: the Kolmogorov-Smirnov test of each is a number, not a chance.
"""

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
import shapes
import trimesh
from design_counts import carried, end_at, lost, orientation, short_trial, stays, stopped_at
from scipy import stats

from feederscrew import bowl as bowls
from feederscrew.base.running import RunSettings
from feederscrew.bowl.devices.kinds import make_device
from feederscrew.bowl.devices.pneumatics import PULSE
from feederscrew.bowl.record import Friction
from feederscrew.designing import exploring, proposals, short_trials, texts
from feederscrew.designing.findings import Move, MoveKind
from feederscrew.designing.proposals import PULSE_RESERVE, PULSE_STEP_S, SHORTEST_PULSE_STEPS, lengthen_pulse
from feederscrew.designing.record import Attempt, DesignRequest
from feederscrew.designing.search import Search
from feederscrew.feeding import stream
from feederscrew.part import load
from feederscrew.resting.aspects import find
from feederscrew.sorting import sensor_views
from feederscrew.sorting.isolating.chain import Cut, judge_cut
from feederscrew.sorting.verdicts import DeviceEncounter, verdict
from feederscrew.trials.course import Fate
from feederscrew.trials.fills import JammedParts, LeavingPose, PoseKind
from feederscrew.trials.wanted import equivalent_rows, wanted_states

DRAWS = 1500
MM = 1e-3
LEAST_P = 0.01  # of the Kolmogorov-Smirnov tests: all samples below are above it
FRICTION = {"static": 0.5, "kinetic": 0.42, "static_backward": 0.62, "kinetic_backward": 0.55, "wall": 0.27}
HOLE = np.array([[0.0, 2.0], [9.0, 2.0], [9.0, 6.0], [0.0, 6.0]]) * MM
SIDES = np.array([24.0, 14.0, 6.0]) * MM  # of a box, no two alike
PARTS = Path(__file__).resolve().parents[2] / "parts"
BOWL = bowls.default()
COUNTS = ("rows", "parts", "right", "wrong", "held")

PROPOSED, UNKNOWN = Move(MoveKind.PROPOSED), LeavingPose(PoseKind.UNKNOWN)


def is_even(values, centre, half):
    """Whether values are drawn evenly from ``half`` below to ``half`` above a centre, and reach near both."""
    values = np.asarray(values)
    assert values.mean() == pytest.approx(centre, abs=4.0 * half / np.sqrt(3.0 * len(values)))
    assert values.std() == pytest.approx(half / np.sqrt(3.0), rel=0.06)
    ends = centre - half, centre + half
    assert ends[0] <= values.min() < centre - 0.98 * half and centre + 0.98 * half < values.max() <= ends[1]
    return stats.kstest(values, stats.uniform(ends[0], 2.0 * half).cdf).pvalue > LEAST_P


@pytest.fixture(scope="module")
def bowl(block):
    """A bowl with a cut, a strip, a hole and a sensor, and frictions that all differ."""
    one = block.ways.lying[0]
    devices = (
        make_device("gap", "test", limit=9.5 * MM, text="test"),
        make_device("slot", "test", span=(2.0 * MM, 5.0 * MM), text="test"),
        make_device("cut-out", "test", corners=tuple(map(tuple, HOLE)), text="test"),
        make_device("vision reject", "test", like=(one.aspect, one.heading, 1.2 * MM), text="test"),
    )
    plain = bowls.read(None, ["drive.amplitude=0.2 mm", "restitution=0.3"])
    return replace(plain, devices=devices, friction=Friction(**FRICTION))


def draw(block, bowl, seed, count):
    lying = block.ways.lying
    return [short_trials.draw_bowl(bowl, lying, np.random.default_rng((seed, k))) for k in range(count)]


def test_what_is_drawn_of_a_bowl_is_even_and_does_not_go_together(block, bowl):
    """Friction from 0.6 to 1.4 times, stroke from 0.9 to 1.1, every cut by 0.1 mm to either side."""
    drawn = draw(block, bowl, 7, DRAWS)
    friction = {k: np.array([getattr(one.friction, k) for one in drawn]) / v for k, v in FRICTION.items()}
    strokes = [one.drive.amplitude / bowl.drive.amplitude for one in drawn]
    gaps, play = ([one.devices[k] for one in drawn] for k in (0, 3))
    gaps, play = [one.limit for one in gaps], [one.like[2] for one in play]
    ends = np.array([one.devices[1].span for one in drawn])
    assert is_even(friction["static"], 1.0, 0.4)
    for ratios in friction.values():  # all coefficients alike
        assert ratios == pytest.approx(friction["static"], rel=1e-12)
    assert is_even(strokes, 1.0, 0.1)
    assert {replace(one.drive, amplitude=1.0) for one in drawn} == {replace(bowl.drive, amplitude=1.0)}
    for values, size in ((gaps, 9.5), (ends[:, 0], 2.0), (ends[:, 1], 5.0), (play, 1.2)):
        assert is_even(values, size * MM, 0.1 * MM)
    hole = np.array([np.ptp(np.array(one.devices[2].corners), axis=0) for one in drawn])
    assert is_even(hole[:, 0], 9.0 * MM, 0.2 * MM)  # both sides of a hole by the same
    assert hole[:, 0] - 9.0 * MM == pytest.approx(hole[:, 1] - 4.0 * MM, abs=1e-9)
    restitutions = np.array([one.restitution for one in drawn])
    columns = np.array([friction["static"], strokes, restitutions, gaps, *ends.T, play])
    assert np.abs(np.corrcoef(columns) - np.eye(len(columns))).max() < 4.0 / np.sqrt(
        DRAWS
    )  # of independent ones
    # restitution is normal, of 1,718 filmed impacts with quartiles 0.53, 0.60, 0.66: docs/validation.md
    ratios = restitutions / 0.3
    assert ratios.mean() == pytest.approx(1.0, abs=4.0 * 0.16 / np.sqrt(DRAWS))
    assert ratios.std() == pytest.approx(0.16, rel=0.06)
    assert stats.kstest(ratios, stats.norm(1.0, 0.16).cdf).pvalue > LEAST_P
    assert np.ptp(np.quantile(ratios, (0.25, 0.75))) == pytest.approx((0.66 - 0.53) / 0.60, rel=0.08)


@pytest.mark.parametrize("restitution", [0.0, 0.95])
def test_restitution_stays_between_none_and_all(block, restitution):
    drawn = draw(block, replace(bowls.default(), restitution=restitution), 3, 200)
    values = [one.restitution for one in drawn]
    assert min(values) >= 0.0 and max(values) <= 1.0
    assert (len(set(values)) > 50) == (restitution > 0.0)


def drawn_sides(part, tolerance, axes, count):
    """Drawn parts, and their sizes (count, 3) [m] along axes (3, 3), the rows of a rotation."""
    parts = [short_trials.draw_part(part, tolerance, np.random.default_rng((11, k))) for k in range(count)]
    return parts, np.array([[np.ptp(one.vertices @ axis) for axis in axes] for one in parts])


@pytest.fixture(scope="module")
def askew():
    turn = trimesh.transformations.euler_matrix(0.4, -0.7, 1.1)
    mesh = shapes.box(*SIDES / MM)
    mesh.apply_transform(turn)
    return shapes.part(mesh), turn[:3, :3].T


def test_a_part_is_off_along_each_principal_axis_and_a_round_one_stays_round(askew):
    part, axes = askew
    (first, *_), sides = drawn_sides(part, 0.1 * MM, axes, 400)
    for k in range(3):
        assert is_even(sides[:, k], SIDES[k], 0.1 * MM)
    assert np.abs(np.corrcoef(sides.T) - np.eye(3)).max() < 4.0 / np.sqrt(400)
    volume = sides[0].prod()
    assert (first.mass, first.volume) == pytest.approx((shapes.STEEL * volume, volume), rel=1e-9)
    assert (first.hull.vertices @ axes.T).max(axis=0) == pytest.approx(0.5 * sides[0], rel=1e-9)
    # I = m / 12 (b^2 + c^2), for sides that are off by so much that a wrong power shows
    for one, side in zip(*drawn_sides(part, 2.0 * MM, axes, 20)):
        square = side**2
        moments = shapes.STEEL * side.prod() / 12.0 * (square.sum() - square)
        assert axes @ one.inertia @ axes.T == pytest.approx(np.diag(moments), rel=1e-9, abs=1e-9 * moments[0])
    part = shapes.part(shapes.cylinder(5, 14, 64))
    _, sides = drawn_sides(part, 0.1 * MM, np.eye(3), 60)
    assert sides[:, 0] == pytest.approx(sides[:, 1], rel=1e-9)
    assert np.ptp(sides[:, 0]) > 0.15 * MM and np.ptp(sides[:, 2]) > 0.15 * MM
    assert abs(np.corrcoef(sides[:, 0], sides[:, 2])[0, 1]) < 4.0 / np.sqrt(60)


def test_each_draw_tries_the_wanted_orientation_and_others_by_their_shares(block):
    count = len(block.ways.lying)
    shares = np.arange(1.0, count + 1.0)
    shares /= shares.sum()
    rng, seen = np.random.default_rng(5), np.zeros(count)
    for _ in range(2000):
        rows = short_trials.draw_rows(block.ways, shares, np.array([2]), rng)
        assert rows[0] == 2 and len(rows) == len(set(rows)) <= 1 + short_trials.OTHERS_DRAWN
        seen[rows] += 1
    absent = (1.0 - shares) ** 3  # of three parts as they come
    expected = np.where(np.arange(count) == 2, 1.0, 1.0 - absent)
    assert seen / 2000.0 == pytest.approx(expected, abs=4.0 * 0.5 / np.sqrt(2000.0))


@pytest.fixture
def quarter(block):
    """A quarter of the first orientation and the rest of the second: shares, and their mean length [m]."""
    shares = np.zeros(len(block.ways.lying))
    shares[:2] = 0.25, 0.75
    return shares, 0.25 * block.ways.lengths[0] + 0.75 * block.ways.lengths[1]


@pytest.mark.parametrize("apart", [0.0, 7.0 * MM])
def test_a_bowl_is_driven_for_1_6_times_what_is_asked_for(block, quarter, apart):
    """Parts 1.5 lengths and a gap apart at 0.5 a second, of which a quarter is wanted."""
    weights, mean = quarter
    search = Search.begin(block.part, DesignRequest(0.5), bowls.default())
    needed = 1.6 * 0.5 * (1.5 * mean + apart) / 0.25
    found = exploring.required_velocity(search, block.ways, weights, 0.25, apart)
    assert found == pytest.approx(needed, rel=1e-12)


def test_a_row_brings_its_velocity_over_its_pitch_times_what_leaves(block, quarter):
    """Half a length between parts, and what the devices need; never closer than wanted ones in a row."""
    ways, (shares, mean) = block.ways, quarter
    own = {"velocity": 0.06, "states": (0,), "ends": ({}, {})}
    counts = (np.array([2, 2]), np.array([2, 0]), np.array([0, 0]), np.array([0, 2]))
    seen = short_trials.ShortTrial(ways, shares, np.array([0, 1]), *counts, **own)
    for spacing in (0.0, 8.0 * MM):
        rate = 0.06 / (1.5 * mean + spacing) * 0.25
        assert replace(seen, spacing=spacing).rate == pytest.approx(rate, rel=1e-12)
    for state in (0, 1):
        as_it_lies = replace(seen, right=np.array([2, 2]), states=(state,)).rate
        longest = max(mean, ways.states[state].length)
        assert as_it_lies == pytest.approx(0.06 / (1.5 * longest), rel=1e-12)


@pytest.mark.parametrize(("rate", "share"), [(0.5, 0.9), (0.6, 0.75), (5.0, 0.5), (0.1, 1.0)])
def test_what_may_come_back_in_a_draw_is_what_the_target_does_not_take(rate, share):
    """0.9 of the target of 0.5 a second, over the rate of the short trial; half at least."""
    search = Search.begin(None, DesignRequest(0.5), bowls.default())
    attempt = Attempt("A@0", "A", (), Move(MoveKind.PROPOSED), 0.0, 0.1, 2, 1.0, 1.0, 0.0, rate, ())
    assert search.share_needed(attempt) == pytest.approx(share)


@pytest.fixture
def rows(block):
    """Ways in which the block lies: its orientations, and the rows of it along the track and across."""
    return block.ways, block.names["A@0"], block.names["A@90"]


def of_rows(seen, rows):
    ends = tuple(seen.ends[k] for k in np.arange(len(seen.ends))[rows])
    return replace(seen, ends=ends, **{name: getattr(seen, name)[rows] for name in COUNTS})


def ended(seen, which, end):
    count = len(seen.ends)
    return replace(seen, ends=tuple({end: 2} if k in which else {} for k in range(count)))


@pytest.fixture
def dropped(rows):
    """A chain with a drop before what is carried through across, and the trial that denied the bare track."""
    ways, along, across = rows
    seen = short_trial(ways, {along}, {across}, row=along)
    return proposals.mend_proposal(
        proposals.Proposal(along, (), (), Move(MoveKind.NO_DEVICE)), seen, ways.lying
    ), seen


def test_a_drop_is_put_before_what_is_carried_through_and_cuts_by_more_where_it_still_is(rows, dropped):
    """A drop moves from the value in the middle towards the greatest that the block still passes."""
    ways, along, across = rows
    proposal, seen = dropped
    (before,) = proposal.cuts
    values = proposals.limits(type(before.device), ways.lying)
    sign = 1.0 if before.device.search.bound == "lower" else -1.0
    assert sign * values[across] < sign * before.device.limit < sign * values[along]
    assert "A@90" in before.returns and "A@0" not in before.returns
    drawn = carried("A@90", across).counted_in_draws(2, 20)
    (after,) = proposals.mend_proposal(proposal, seen, ways.lying, drawn).cuts
    middle = 0.5 * (before.device.limit + before.largest.limit)
    assert after.device.limit == pytest.approx(middle, abs=proposals.VALUE_STEP_M)
    assert after.margin_pass > 0.0 and "A@90" in after.returns
    other = carried("A@0", along)  # nothing tells it from itself
    assert proposals.mend_proposal(proposal, seen, ways.lying, other) is None
    candidate = SimpleNamespace(proposal=proposal, trial=seen, orientations=ways)
    first, *others = proposals.purify(
        candidate, ((UNKNOWN, 3), (orientation("A@90"), 2))
    )  # what left a queue
    (after,) = first.cuts
    # then a drop of each other kind before it
    kinds = [other.cuts[0].device.kind for other in others]
    assert others and all(other.cuts[1:] == proposal.cuts for other in others)
    assert before.device.kind not in kinds and len({*kinds}) == len(kinds)
    assert abs(after.device.limit - after.largest.limit) < abs(before.device.limit - before.largest.limit)
    assert not list(proposals.purify(candidate, ((UNKNOWN, 3), (orientation("A@0"), 1))))


def test_a_cut_at_which_what_is_wanted_stands_in_a_queue_cuts_less(rows, dropped):
    """Half the way to its least cut; nothing of a place where no cut of the design stands, or of a sensor."""
    ways = rows[0]
    proposal, seen = dropped
    (before,) = proposal.cuts
    (after,) = proposals.ease_cut(proposal, 1, ways.lying).cuts
    middle = 0.5 * (before.device.limit + before.smallest.limit)
    assert after.device.limit == pytest.approx(middle, abs=proposals.VALUE_STEP_M)
    assert after.margin_pass > before.margin_pass
    for place in (-1, 0, 2):
        assert proposals.ease_cut(proposal, place, ways.lying) is None
    # a queue that jams at it asks for the same; what else stands there is cut more
    search = SimpleNamespace()
    candidate = SimpleNamespace(proposal=proposal, trial=seen, orientations=ways)
    mends = list(exploring.mends_of_jams(search, candidate, [JammedParts("A@0", 1, before.device.kind, 2)]))
    assert [one.cuts[0].device.limit for one in mends] == [after.device.limit]
    more, *_ = exploring.mends_of_jams(search, candidate, [JammedParts("A@90", 1, before.device.kind, 1)])
    assert abs(more.cuts[0].device.limit - before.largest.limit) < abs(
        before.device.limit - before.largest.limit
    )
    assert not list(exploring.mends_of_jams(search, candidate, ()))


def test_an_aspect_that_may_be_up_as_well_counts_as_the_wanted_one_but_for_a_stop_of_it(block, rows):
    ways, along, across = rows
    assert equivalent_rows(ways.lying, along, ()) == ()
    same = equivalent_rows(ways.lying, along, ("a",))
    assert set(same) == {k for k, one in enumerate(ways.lying) if one.aspect == "A"} - {along}
    states = wanted_states(ways, (along, *same))
    assert states[0] == ways.leaves_as[along] and ways.leaves_as[across] in states
    shares = np.arange(1.0, len(ways.lying) + 1.0)
    assert short_trials.gain(ways, shares, states) == pytest.approx(shares[[along, *same]].sum())
    one = {"rows": (along, across), "count": 1, "run": RunSettings(1)}
    for wanted, right in ((along, [1, 0]), ((along, *same), [1, 1])):
        seen = short_trials.try_parts(block.part, BOWL, ways, shares, wanted, **one)
        assert (list(seen.right), list(seen.wrong)) == (right, [1 - count for count in right])
        assert bool(short_trials.find_faults(seen)) == (0 in right)
    states = wanted_states(ways, (along, across))
    lost = short_trial(ways, {along}, row=along, states=states)
    assert not short_trials.find_faults(lost)
    assert short_trials.find_faults(replace(lost, right=0 * lost.right))  # the wanted one itself has to leave
    through = {across}, (), carried("A@90", across)
    for wrong, held, fault in (((), {across}, stays("A@90", stopped_at("gap"), row=across)), through):
        seen = short_trial(ways, {along}, wrong, held, row=along, states=states)
        assert short_trials.find_faults(seen) == [fault]


def test_trials_of_different_orientations_and_more_parts_of_one_are_joined(rows):
    ways, *_ = rows
    whole = short_trial(ways, {0, 1}, {2}, {3})
    joined = of_rows(whole, slice(0, 2)).join(of_rows(whole, slice(2, None)))
    assert (joined.efficiency, joined.wrong_share) == pytest.approx((whole.efficiency, whole.wrong_share))
    assert joined.ends == whole.ends
    turned = end_at(Fate.TURNED, "gap")
    second = replace(
        whole, rows=np.array([2, 0]), parts=np.array([5, 3]), right=np.array([1, 3]), wrong=np.array([4, 0]),
        held=np.array([0, 0]), ends=({stopped_at("gap"): 1}, {}), turns=({turned: 2}, {}),
    )  # fmt: skip
    both = whole.join(second)
    assert both.rows.tolist() == whole.rows.tolist() and both.ends[2] == {stopped_at("gap"): 1}
    assert both.parts[[0, 1, 2]].tolist() == [5, 2, 7] and both.right[[0, 2]].tolist() == [5, 1]
    assert both.wrong[2] == 6 and both.held[3] == 2 and both.turns[2] == {turned: 2}
    assert both.efficiency == pytest.approx((1.0 + 1.0 + 1.0 / 7.0) / len(ways.lying))


def test_a_drop_that_makes_no_difference_gives_way_to_one_of_another_kind(rows, dropped):
    """A canyon that let a bolt through was moved and tried again; no narrowed track was."""
    ways, *_ = rows
    proposal, seen = dropped
    first = proposal.cuts[0].device.kind
    other = proposals.replace_drop(proposal, seen, ways.lying)
    assert len(other.cuts) == 1 and other.cuts[0].device.kind != first and "A@90" in other.cuts[0].returns
    kinds = [first, other.cuts[0].device.kind]
    third = proposals.replace_drop(other, seen, ways.lying, kinds)
    assert third is None or third.cuts[0].device.kind not in kinds
    bare = replace(proposal, move=Move(MoveKind.PROPOSED))  # its first device is none that a trial asked for
    assert proposals.replace_drop(bare, seen, ways.lying) is None


def test_what_no_width_of_the_track_carries_is_dropped_by_a_narrowed_track(monkeypatch, rows):
    """Its value is infinite, and counted as no value at all: a canyon was taken, which it crosses."""
    ways, along, across = rows
    values, true_limits = {"narrowed track": np.inf, "canyon": 0.0, "gap": 0.0}, proposals.limits

    def limits(kind, orientations):
        own = true_limits(kind, orientations)
        own[across] = values.get(kind.kind, own[across])
        return own

    monkeypatch.setattr(proposals, "limits", limits)
    proposal = proposals.Proposal(along, (), (), Move(MoveKind.NO_DEVICE))
    cut = proposals.add_drop(proposal, [across], [along], ways.lying).cuts[0]
    width, own = ways.lying[along].track.width, ways.lying[along].balcony
    assert cut.device.kind == "narrowed track"
    assert cut.device.limit == pytest.approx(0.5 * (width + own), abs=proposals.VALUE_STEP_M)


@pytest.mark.parametrize("cost_class, dearer", [(1, {"air jet", "vision reject"}), (3, set())])
def test_a_cost_class_is_without_dearer_devices_and_the_widest_margin_comes_first(cost_class, dearer):
    ways = proposals.recipes_of(cost_class, DesignRequest(target=1.0))
    assert all(dearer <= set(way.excluded_kinds) for way in ways)
    assert any("vision reject" not in way.excluded_kinds for way in ways) == (cost_class == 3)
    margins = [way.margin for way in ways if not way.turns and not way.holes]
    assert margins == sorted(margins, reverse=True) and len(set(margins)) == 2
    assert [way.outcome for way in ways if way.holes] == ["lying"] * (cost_class == 1)
    hung = proposals.recipes_of(cost_class, DesignRequest(target=1.0, outcome="hanging"))
    assert {way.outcome for way in hung} == {"hanging"} and not any(way.turns for way in hung)
    assert proposals.recipes_of(3, DesignRequest(target=1.0, without=("vision reject",))) == []
    gap = make_device("gap", "test", limit=9e-3, text="9 mm")
    jet, sorter = (
        make_device("air jet", "test", text="test"),
        make_device("vision reject", "test", text="test"),
    )
    for chain, cost in (((), 1), ((gap,), 1), ((gap, jet), 2), ((sorter, gap), 3)):
        assert proposals.Proposal(0, (), chain, PROPOSED).cost_class == cost


def test_a_blade_at_which_parts_stay_is_swept_otherwise(block):
    ways, wanted, others = block.ways, block.names["A@0"], block.names["C@0"]
    wiper = make_device("wiper", "test", limit=8e-3, sweep=np.radians(30.0)).rewritten()
    proposal = proposals.Proposal(wanted, (Cut(wiper, 1e-3, 1e-3, wiper, wiper, ()),), (), PROPOSED)
    seen = short_trial(ways, {wanted}, (), {others}, row=wanted)
    assert proposals.sweep_blade(proposal, seen, ways.lying) is None  # it stays at a gap
    seen, sweeps = ended(seen, {others}, stopped_at("wiper")), []
    while proposal is not None:
        proposal = proposals.sweep_blade(proposal, seen, ways.lying)
        sweeps += [] if proposal is None else [round(np.degrees(proposal.devices[0].sweep))]
    assert sweeps[:2] == [35, 20] and len(set(sweeps)) == len(sweeps) and 30 not in sweeps


def test_a_wanted_part_that_comes_back_denies_only_where_most_of_the_others_do_too(rows):
    ways, along, across = rows
    back = ended(short_trial(ways, {along}, row=along), {across}, end_at(Fate.RETURNED, "gap"))
    assert short_trials.came_back(back, across) and not short_trials.came_back(back, along)
    pair = of_rows(back, [along, across])
    # half of them leave, and all that the target needs
    for leaves, needed, comes in ((0.5, (), 1), (0.4, (), 0), (0.7, (0.7,), 1), (0.7, (0.75,), 0)):
        assert short_trials.comes_through(pair, {along: leaves, across: 1.0 - leaves}, *needed) == comes
    assert not short_trials.comes_through(replace(pair, held=np.array([0, 1])), {along: 0.9, across: 0.1})
    leaving = ways.leaving.copy()
    leaving[across] = leaving[along]  # both leave in the one state, as parts that hang do
    both = replace(ways, leaving=leaving)
    seen = ended(short_trial(both, {along}, row=along), {across}, end_at(Fate.RETURNED, "narrowed track"))
    assert short_trials.find_returnable_rows(seen) == (across,) and not list(short_trials.find_denials(seen))
    stays = replace(seen, held=2 * (np.arange(len(both.lying)) == across))
    assert short_trials.find_returnable_rows(stays) == () and list(short_trials.find_denials(stays))
    assert short_trials.find_returnable_rows(replace(seen, right=0 * seen.right)) == ()  # none of them leaves


def test_of_a_drawn_part_only_what_is_tried_is_judged_and_sensors_see_something(monkeypatch, block):
    """Through a sorter and rails: what is asked for becomes of it what becomes of it among all others."""
    ways, names, judged = block.ways, block.names, []
    one = ways.lying[names["A@0"]]
    like = {"like": (one.aspect, one.heading, 1e-3), "text": "test"}
    chain = (
        make_device("gap", "test", limit=7e-3, text="7 mm"),
        make_device("vision reject", "test", **like),
    )
    own = {"aspects": block.aspects, "chain": chain, "bowl": BOWL}
    whole = stream.along(ways.lying, **own)
    fates = "feederscrew.sorting.fates.verdict"
    monkeypatch.setattr(fates, lambda kind, one, *more: judged.append(one) or verdict(kind, one, *more))
    rows = [names["A@90"], names["A@0"], names["B@0"]]
    some = stream.along(ways.lying, **own, rows=set(rows))
    for field in ("leaving", "leaves_as"):
        assert np.array_equal(getattr(some, field)[rows], getattr(whole, field)[rows])
    assert [one.name for one in some.states] == [one.name for one in whole.states]
    assert [some.fates[k] for k in rows] == [whole.fates[k] for k in rows]
    assert len(judged) == len(rows) + int((whole.passes[rows, 1] > 0.0).sum()) < 2 * len(ways.lying)
    assert {some.fates[names["A@0"]], some.fates[names["A@90"]]} == {"carried", "returned"}
    bracket = load(PARTS / "lbracket_30x20x15.stl")
    other = short_trials.draw_part(bracket, 1e-4, np.random.default_rng((1, 1)))
    ways = stream.follow_orientations(other, find(other), BOWL.track, (), bowl=BOWL)
    turned = next(one for one in ways.lying if one.name == "B@264")
    # closing its slits by 0.02 mm left nothing
    assert sensor_views.outline(turned, "outline").area > 9.5e-5
    assert min(sensor_views.outline(one, "side").area for one in ways.lying) > 5e-5


def test_a_pressure_break_carries_what_is_wanted_and_lets_it_reach_over_the_ledge(rows):
    """A ledge under a block of 12 mm: wider than half of that by the margin, and narrower than it."""
    ways, along, _ = rows
    proposal, seen = proposals.Proposal(along, (), (), "test"), short_trial(ways, {along}, row=along)
    changed = proposals.add_pressure_break(SimpleNamespace(proposal=proposal, trial=seen, orientations=ways))
    (cut,) = changed.cuts
    assert cut.device.kind == "pressure break" and not cut.returns.count("A@0")
    assert 6e-3 + proposals.MARGINS[-1] <= cut.device.limit <= 12e-3 - proposals.MARGINS[-1]
    again = SimpleNamespace(proposal=changed, trial=seen, orientations=ways)
    assert proposals.add_pressure_break(again) is None  # it has one


def test_a_device_at_which_draws_lose_what_is_wanted_returns_less(rows, dropped):
    """A ledge grows wider by the least margin while parts reach over it, a cut moves; not the slot behind."""
    ways, along, _ = rows
    proposal, seen = proposals.Proposal(along, (), (), "test"), short_trial(ways, {along}, row=along)
    broken = proposals.add_pressure_break(SimpleNamespace(proposal=proposal, trial=seen, orientations=ways))
    limits = [broken.cuts[0].device.limit]

    def eased(changed, trial, station=1, kind="pressure break"):
        fault = lost("A@0", end_at(Fate.RETURNED, kind, station), row=along).counted_in_draws(2, 7)
        return proposals.mend_proposal(changed, trial, ways.lying, fault)

    while (changed := eased(broken, seen)) is not None and len(limits) < 40:
        broken = changed
        limits.append(broken.cuts[0].device.limit)
    room = ways.lying[along].width - proposals.MARGINS[-1]
    assert room - proposals.MARGINS[-1] < limits[-1] <= room
    assert np.diff(limits) == pytest.approx(proposals.MARGINS[-1], abs=1e-4)
    assert eased(broken, seen, station=0) is eased(broken, seen, station=2) is None
    before, trial = dropped
    kind = before.cuts[0].device.kind
    after = eased(before, trial, kind=kind)
    assert after.cuts == proposals.ease_cut(before, 1, ways.lying).cuts
    # a part that stands there does not come along once more: no less of a cut frees it
    stands = lost("A@0", stopped_at(kind), row=along).counted_in_draws(2, 7)
    assert proposals.mend_proposal(before, trial, ways.lying, stands) is None


def test_what_a_full_track_lets_past_a_sensor_meets_a_second_one(rows):
    """The same once more, behind the first; a chain of steel and one that has two get none."""
    ways, along, _ = rows
    like = {"like": (ways.lying[along].aspect, ways.lying[along].heading, 1e-3), "text": "test"}
    sees, gap = make_device("vision reject", "test", **like), make_device("gap", "test", limit=7e-3)
    cuts = tuple(Cut(device, 1e-3, 1e-3, device, device, ("B@0",)) for device in (sees, gap))
    once = proposals.Proposal(along, cuts, (), "test")
    twice = proposals.add_second_sensor(SimpleNamespace(proposal=once))
    assert [device.kind for device in twice.devices] == ["vision reject", "vision reject", "gap"]
    assert twice.move.kind is MoveKind.SECOND_SENSOR and "second vision reject" in texts.move_text(twice.move)
    assert proposals.add_second_sensor(SimpleNamespace(proposal=twice)) is None
    steel = replace(once, cuts=cuts[1:])
    assert proposals.add_second_sensor(SimpleNamespace(proposal=steel)) is None


def test_parts_that_touch_come_apart_on_a_spacing_section_then_on_a_steeper_one(rows):
    """Before the first device; once steeper; nothing of the user's own stretches, or of no device."""
    ways, along, _ = rows
    narrow = make_device("narrowed track", "test", limit=9e-3)
    none = np.zeros(len(ways.lying), bool)
    cut = proposals.judge_cut(ways.lying, along, narrow, none, narrow, narrow)
    proposal = proposals.Proposal(along, (cut,), (), "test")
    angles = []
    for _ in range(2):
        proposal = proposals.spread_apart(SimpleNamespace(proposal=proposal))
        assert [device.kind for device in proposal.devices] == ["spacing section", "narrowed track"]
        assert proposal.move.kind is MoveKind.SPACING
        angles.append(float(np.degrees(proposal.devices[0].angle)))
    assert angles[0] == pytest.approx(-6.0) and angles[1] == pytest.approx(-10.0)
    text = proposal.devices[0].text
    assert text == "{climb: -10 deg}" and text in texts.move_text(proposal.move)
    assert proposals.spread_apart(SimpleNamespace(proposal=proposal)) is None
    bare = SimpleNamespace(proposal=replace(proposal, cuts=()))
    assert proposals.spread_apart(bare) is None
    kept = SimpleNamespace(proposal=replace(proposal, cuts=(cut,)))
    assert proposals.spread_apart(kept, ("spacing section",)) is None
    led = SimpleNamespace(proposal=replace(proposal, cuts=(cut,), before=proposal.devices[:1]))
    assert proposals.spread_apart(led) is None


@pytest.mark.parametrize(("lost", "draws", "held"), [((0, 2), 3, 1), ((3,), 5, 4)])
def test_draws_end_once_more_have_failed_than_may(monkeypatch, block, lost, draws, held):
    results = iter([[carried("B")] if k in lost else [] for k in range(5)])
    monkeypatch.setattr(short_trials, "_draw", lambda *_: (next(results), 0.05))
    own = {"draws": 5, "tolerance": 1e-4, "run": RunSettings(1)}
    shares = np.full(len(block.ways.lying), 1.0)
    drawn = short_trials.robust_run(block.part, BOWL, block.ways, shares, 0, max_failures=1, **own)
    assert (drawn.draws, drawn.held, drawn.partial) == (draws, held, False)


@pytest.fixture(scope="module")
def wedge():
    """A wedge of 24 x 13 mm on a banked track, a sorter of its first orientation, and what that returns."""
    part = shapes.part(shapes.prism([[0, 0], [24, 0], [24, 4], [4, 13]], 7.0))
    banked = bowls.read(None, ["track.bank=5 deg", "track.width=30 mm"])
    ways = proposals.follow_orientations(part, find(part), banked)
    one = ways.lying[0]
    like = {"like": (one.aspect, one.heading, 1e-3), "text": "{of: A@0, play: 1 mm, sees: outline}"}
    device = make_device("vision reject", "test", **like)
    return ways, judge_cut(ways.lying, 0, device, np.arange(len(ways.lying)) > 0, device, device)


def weighing(every, times):
    return [replace(one, posture=replace(one.posture, mass=times * one.posture.mass)) for one in every]


def test_a_pulse_is_the_shortest_with_its_reserve_and_longer_where_others_slip_through(wedge):
    ways, cut = wedge
    times = []

    def reserve(time):
        """The least way [m] beyond the edge over which a share of a pulse carries what the cut returns."""
        gone = [DeviceEncounter(one, every) for one in every if one.name in cut.returns]
        push = cut.device.jet.push
        return min(met.blown(*push(met.orientation, every), time / PULSE_RESERVE) for met in gone)

    for heavier in (0.2, 0.9, 1.2, 50.0):
        every = weighing(ways.lying, heavier)
        device = proposals.shorten_pulse(cut, every).device
        times.append(device.time)
        if device.time < PULSE:
            assert reserve(device.time) > 0.0
            text = cut.device.rewritten().text[:-1]
            assert device.text == f"{text}, jet: {{time: {1e3 * device.time:.0f} ms}}}}"
            shorter = cut.device.gap(every[0], 0.2) - 0.2 * (PULSE - device.time)
            assert device.gap(every[0], 0.2) == pytest.approx(shorter)
        if device.time > PULSE_STEP_S * SHORTEST_PULSE_STEPS:
            assert reserve(device.time - PULSE_STEP_S) <= 0.0
    assert times[0] == PULSE_STEP_S * SHORTEST_PULSE_STEPS < times[1] < times[2] <= times[3] == PULSE
    ways, cut = wedge
    proposal = proposals.Proposal(0, (proposals.shorten_pulse(cut, weighing(ways.lying, 0.2)),), (), PROPOSED)
    slipped = next(k for k, one in enumerate(ways.lying) if one.name in cut.returns)
    assert lengthen_pulse(proposal, short_trial(ways, {0}, each=1), ways.lying) is None
    seen = short_trial(ways, {0}, {slipped}, each=1)
    other = lengthen_pulse(proposal, seen, ways.lying)
    assert proposals.mend_proposal(proposal, seen, ways.lying).chain == other.chain
    (device,) = other.devices
    assert device.time == pytest.approx(0.04) == PULSE
    assert texts.move_text(other.move) == "pulse of 40 ms" and "jet" not in device.text
    assert lengthen_pulse(other, seen, ways.lying) is None
