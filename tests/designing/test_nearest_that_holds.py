"""What falls short ends with the nearest that holds, tried; the cause, and what left instead."""

import re
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
import shapes
from design_counts import (
    TURNED_ON_TRACK,
    carried,
    design_study,
    end_at,
    heading_off,
    lost,
    orientation,
    queue,
    short_trial,
    stays,
    stopped_at,
)

from feederscrew import bowl as bowls
from feederscrew.arrivals.plate_test import throw_number
from feederscrew.bowl.devices.kinds import make_device
from feederscrew.designing import calm_drive, exploring, loop, nearest, proposals, queues, verdict_texts
from feederscrew.designing.findings import Cause, Move, MoveKind
from feederscrew.designing.loop import alternatives
from feederscrew.designing.policy import USUAL_POLICY
from feederscrew.designing.progress import SearchProgress, SearchStage
from feederscrew.designing.proof import RobustRun
from feederscrew.designing.record import Attempt, DesignRequest, DesignStudy
from feederscrew.designing.search import Candidate, Search, TrackAtBank
from feederscrew.output import designs
from feederscrew.output import tables as tables_of
from feederscrew.sorting.isolating.chain import Cut
from feederscrew.trials.course import Fate
from feederscrew.trials.fills import FillLevel, LeavingPose, PoseKind

PART = shapes.part(shapes.box(20, 12, 5))
BOWL = bowls.default()
PLAIN = calm_drive.PlainBowl(BOWL, frozenset())
PROPOSED = Move(MoveKind.PROPOSED)
CARRIED = {"robust": RobustRun(14, 12, carried("B@30").counted_in_draws(1, 14)), "queues": ()}
GAP = make_device("gap", "test", limit=9e-3, text="9 mm")
SORTER = make_device("vision reject", "test", like=("A", 0.0, 1e-3), text="{of: A@0, play: 1 mm}")


def fills(right=180, left=None, returned=20, instead=(), **counts):
    """Three fills alike, to which 50 parts a minute come."""
    own = {"left_instead": instead, "seconds": 240.0, "counted": 240.0} | counts
    return tuple(queue(right, left, returned, fill=fill, **own) for fill in FillLevel)


def study(target=40.0, held=20, **more):
    return design_study(PART, target=target, held=held, **{"queues": fills()} | more)


def attempt(rate=30.0, faults=(), cause=Cause.UNKNOWN, wanted="A@0", **more):
    made = Attempt(
        wanted, wanted.partition("@")[0], (), PROPOSED, 0.0, 0.1, 8, 0.4, 1.0, 0.0, rate / 60.0, faults, cause
    )
    return replace(made, **more)


def candidate(ways, bowl=BOWL, fault=(), **more):
    tried, fields = short_trial(ways, ()), ("rows", "parts", "wrong", "held", "ends")
    first = {name: getattr(tried, name)[:1] for name in fields}
    tried = replace(tried, **first, right=np.array([2]), velocity=0.1)
    proposal = proposals.Proposal(0, (), (), PROPOSED)
    return Candidate(proposal, bowl, ways, tried.shares, tried, attempt(faults=fault, **more))


def searching(*passed, **request):
    """A search that has passed some candidates, and what it says."""
    said = []
    made = Search.begin(PART, DesignRequest(10.0, **request), BOWL, progress=SearchProgress(said.append))
    made.state.clean += passed
    return made, said


def nothing_near(search, prove, target=600.0):
    """The nearest of a design of which no queue was followed."""
    return nearest.nearest(study(target, queues=()), search, [], prove)


@pytest.fixture
def drives_tried(monkeypatch, ways):
    bowls_tried = []

    def attempted(search, made, proposal, weights, driven=None):
        bowls_tried.append(driven)
        return replace(candidate(ways, driven, rate=9.0), proposal=proposal)

    monkeypatch.setattr(exploring, "try_proposal", attempted)
    return bowls_tried


def test_a_design_that_only_lacks_rate_holds_at_a_lower_one(ways):
    """180 of 200 at each fill, 50 a minute offered: Wilson's lower end is 85.1 %."""
    slow = study(400.0)
    rate = 60.0 * nearest.rate_that_holds(slow)
    assert rate == pytest.approx(47.0) and 0.9 * rate <= 50.0 * 0.8507 < 0.9 * (rate + 1.0)
    assert nearest.only_slow(slow) and not nearest.only_slow(study(10.0))
    assert replace(slow, request=DesignRequest(rate / 60.0)).status == "holds"
    assert replace(slow, request=DesignRequest(1.05 * rate / 60.0)).status == "falls short"
    for worse in ({"held": 18}, {"queues": fills(jams=1)}, {"queues": fills(right=80, left=180)}):
        assert nearest.rate_that_holds(study(400.0, **worse)) == 0.0
    assert nearest.rate_that_holds(study(10.0)) == pytest.approx(10.0 / 60.0)  # no more than was asked for
    search, _ = searching()
    slow, one = study(400.0), candidate(ways)
    found, made = nearest.nearest(slow, search, [(slow, one)], None)
    assert made is slow and 60.0 * found.rate == pytest.approx(47.0) and "lower rate" in found.change
    assert (found.draws_held, found.parts_right, found.queue_seconds) == (20, 540, 720.0)
    ended = replace(slow, nearest=found)
    document = designs.document(ended)
    assert document["nearest"]["rate_per_minute"] == 47.0 and document["cause"] == "arrival"
    assert document["nearest"]["tried"]["draws"] == 20 and document["nearest"]["change"]
    assert "47/min with a lower rate" in ended.why
    assert "nearest that holds" in tables_of.text(designs.summary(ended), "table")
    slower = study(600.0)
    found, _ = nearest.nearest(slower, search, [(slower, one)], None)
    assert "13 such bowls bring the 600/min" in found.text  # 47 a minute each


def test_what_was_clean_and_slow_is_proved_until_one_holds_and_counted_where_none_does(ways, monkeypatch):
    search, said = searching(candidate(ways, rate=20.0), candidate(ways, rate=30.0, wanted="B@0"))
    asked = []

    def prove(_, one):
        asked.append(one.attempt.wanted)
        denied = {"held": 12, "queues": ()}  # by draws: no queue is followed
        return study(600.0, **(denied if one.attempt.wanted == "B@0" else {}))

    found, made = nothing_near(search, prove)
    assert asked == ["B@0", "A@0"] and made is not None and found.rate > 0.0
    assert len(found.denied) == 1 and "12 of 20 draws" in found.denied[0] and found.proofs == 2
    assert len([text for text in said if text.startswith("nearest that holds")]) == 2
    search, _ = searching(*(candidate(ways, rate=20.0 + k, chain=(f"gap: {k} mm",)) for k in range(9)))
    monkeypatch.setattr(exploring, "candidates", lambda free: iter(()))
    search.state.attempts += [attempt()] * 9
    found, made = nothing_near(search, lambda *_: study(600.0, queues=fills(jams=1, seconds=6.0)))
    assert made is None and found.rate is None and len(found.denied) == USUAL_POLICY.near_proofs
    assert (found.trials, found.proofs) == (9, 3) and "nothing near it holds" in found.text
    assert designs.nearest(replace(study(600.0), nearest=found))["rate_per_minute"] is None
    with pytest.raises(KeyboardInterrupt):
        nothing_near(searching(candidate(ways))[0], lambda *_: study(600.0, partial=True))


def test_no_more_designs_are_proved_nearby_once_queues_have_denied_them_long(ways, monkeypatch):
    monkeypatch.setattr(exploring, "candidates", lambda free: pytest.fail("a lower rate was searched"))
    limit = USUAL_POLICY.denied_near
    for seconds, proofs in ((0.2 * limit, 2), (0.4 * limit, 1)):  # of each of three fills
        search, _ = searching(*(candidate(ways, rate=20.0 + k, chain=(f"gap: {k} mm",)) for k in range(3)))
        search.state.denied = 7.0 * limit  # what the search before it has denied does not count
        found, _ = nothing_near(
            search, lambda *_, own=seconds: study(600.0, queues=fills(jams=1, seconds=own))
        )
        assert (found.rate, found.proofs) == (None, proofs)


def test_a_chain_is_proved_at_two_drives_at_most_and_not_twice_at_nearly_the_same(ways, monkeypatch):
    """Strokes of one chain, that of the highest rate first; that of another chain besides."""
    monkeypatch.setattr(exploring, "candidates", lambda free: iter(()))
    strokes = (0.40, 0.41, 0.30, 0.20)  # [mm]

    def driven(stroke, rate, chain):
        return candidate(
            ways, rate=rate, chain=(chain,), peak_to_peak=1e-3 * stroke, throw_number=4.0 * stroke
        )

    of_gap = [driven(stroke, 40.0 - k, "gap: 9 mm") for k, stroke in enumerate(strokes)]
    search, _ = searching(*of_gap, driven(0.40, 1.0, "wiper: 6 mm"))
    asked = []

    def prove(_, one):
        asked.append((one.attempt.chain[0], round(1e3 * one.attempt.peak_to_peak, 3)))
        return study(600.0, queues=fills(right=60, left=90, seconds=6.0))

    found, _ = nothing_near(search, prove)
    assert asked == [("gap: 9 mm", 0.4), ("gap: 9 mm", 0.3), ("wiper: 6 mm", 0.4)]
    assert found.rate is None and found.proofs == 3


def test_a_drive_that_turns_what_is_wanted_is_calmed_before_its_chain_is_given_up(monkeypatch, block):
    """At the lively drive both wanted parts turn on the track; at the calmer one both pass."""
    search, _ = searching()
    ways, strokes = block.ways, []
    search.state.shares = SimpleNamespace(aspects=block.aspects, measured=None)
    monkeypatch.setattr(exploring.stream, "oriented", lambda known, _: known)

    def short(_, bowl, ways, weights, proposal):
        strokes.append(bowl.drive.amplitude)
        right = 0 if len(strokes) == 1 else 2
        own = {"right": np.array([right]), "wrong": np.array([2 - right])}
        return replace(candidate(ways).trial, turns=({} if right else {TURNED_ON_TRACK: 2},), **own)

    monkeypatch.setattr(exploring, "_short", short)
    weights = np.full(len(ways.lying), 1.0 / len(ways.lying))
    proposal = proposals.Proposal(0, (), (), Move(MoveKind.NO_DEVICE))
    found = list(exploring._try_and_mend(search, TrackAtBank(PLAIN, ways, weights, [0], 1.0), proposal))
    first, second = search.state.attempts
    assert not found and len(search.state.clean) == 1  # clean, slower than 600 a minute
    assert first.cause == "drive" and not first.clean and second.clean and second.cause == ""
    assert first.peak_to_peak > second.peak_to_peak == 2.0 * strokes[1]
    assert first.faults[-1].is_on_bare_track and second.move.kind is MoveKind.CALMER_DRIVE


@pytest.mark.parametrize("cause, more", [
    ("arrival", {}),
    ("device", {"queues": fills(jams=2)}),
    ("drive", {"held": 15}),
    ("drive", {"queues": fills(right=0, left=33, instead=((heading_off("A"), 33),))}),
    ("part", {"queues": fills(right=20, left=45, instead=((orientation("B@0"), 25),))}),
    ("drive", {"queues": fills(right=0, left=0, returned=0)}),
    ("part", {"bowl": None, "queues": ()}),
    ("device", {"queues": (), "attempts": (attempt(0.0, (lost("A@0", stopped_at("gap")),), Cause.DEVICE),)}),
    ("arrival", {"queues": (), "attempts": (attempt(),)}),
])  # fmt: skip
def test_one_of_four_causes_is_said(cause, more):
    made = study(400.0, **more)
    made = replace(made, bowl=None, attempts=()) if "bowl" in more else made
    assert made.cause == cause and cause in list(Cause) and f"the cause is the {cause}:" in made.why
    assert designs.document(made)["cause"] == cause


def test_what_left_instead_and_what_would_hold_are_said():
    made = study(40.0, queues=fills(right=0, left=11, instead=((heading_off("A"), 11),)))
    assert made.proof.left_instead == ((heading_off("A"), 33),)
    assert "A, heading off: 11 of 11" in made.why and "--up A" in made.why
    assert designs.document(made)["queues"][0]["left_instead"] == "A, heading off: 11 of 11"
    other = study(40.0, queues=fills(right=0, left=11, instead=((orientation("B@0"), 11),)))
    assert "B@0: 11 of 11" in other.why and "--up" not in other.why
    # only where the fill lost parts of that aspect: '--up A' stood behind 'C, heading off'
    lost = [fills(right=0, left=11, instead=((heading_off(aspect), 11),)) for aspect in "CA"]
    mixed = study(40.0, queues=(*lost[0][:2], *lost[1][2:]))
    lines = [line for line in mixed.shortfalls if "heading off" in line]
    assert len(lines) == 3 and all(("--up A" in line) == ("A, heading off" in line) for line in lines)
    # of 50 parts a minute a fifth leaves: 10/min, and for 40/min four fifths have to
    made = study_with(GAP, right=40, returned=160)
    assert made.cause == "arrival" and "80 % come so" in made.why
    # never more than would: 49/min stood beside a nearest of 48/min
    for right in range(30, 50):
        made = study_with(GAP, right=right, returned=200 - right)
        (rate,) = re.findall(r"(\S+)/min would hold", made.why)
        low = 60.0 * made.proof.delivered[1] / 0.9
        assert 0.9 * low < float(rate) <= low
    cut = Cut(GAP, 1e-3, 1e-3, GAP, GAP, ("B@0",))
    found = study_with(GAP, right=160, left=180, cuts=(cut,))
    low, normal, high = found.proof.queues
    other = orientation("B@0")
    rows = (low, replace(normal, left_instead=((other, 2),)), replace(high, left_instead=((other, 9),)))
    assert "B@0: 9 of 180 (through the gap)" in found.proved_by(queues=rows).why
    assert "B@0: 9 of 180; " in replace(found.proved_by(queues=rows), cuts=()).why


def test_a_queue_names_what_left_by_aspect_and_heading(block):
    ways, aspects = block.ways, block.aspects
    names = [one.name for one in ways.states]
    own, other = (aspects.names.index(ways.states[k].aspect) for k in (0, 1))
    whole = np.zeros((len(names) + 1, len(aspects.names) + 1), int)
    whole[0, own], whole[1, other], whole[-1, own], whole[-1, -1] = 4, 2, 5, 1
    leaving, lying = whole.sum(axis=1), whole.sum(axis=0)
    seen = SimpleNamespace(leaving_counts=leaving, aspects=lying, whole=whole)
    row = queues.FollowedRow(PART, BOWL, aspects, ways, None, (0,), seed=1)
    found = dict(row.left_instead(seen))
    off = heading_off(aspects.names[own])
    assert found == {off: 5, orientation(names[1]): 2, LeavingPose(PoseKind.UNKNOWN): 1}
    assert sum(found.values()) == leaving.sum() - row.wanted_parts(seen)
    free = replace(row, any_heading=(aspects.names[own],))
    assert off not in dict(free.left_instead(seen))


def test_a_trial_is_told_with_what_came_of_the_last_one_and_the_time():
    search, said = searching(budget=7)
    order, told = [], []
    search.progress.before = lambda: order.append(len(said))
    search.progress.report = lambda *row: told.append(row)
    search.begin_trial("A@0, no device")
    search.state.attempts.append(attempt(0.0, (lost("A@0", TURNED_ON_TRACK),), Cause.DRIVE))
    search.progress.clock.end()
    search.begin_trial("A@0, calmer drive")
    assert order == [0]  # what is compiled is told before the first trial, once
    assert said[0].startswith("trial 1: A@0, no device")
    assert said[1].startswith("trial 2: ") and "trial 1: A@0 is lost (turned on the track)" in said[1]
    assert [row[:3] for row in told] == [("trial", 0, 7), ("trial", 1, 7)]
    assert all(gone >= 0.0 and rest > 0.0 for *_, gone, rest in told)
    search.begin_proof("draws: A@0")
    search.run(SearchStage.DRAWS).tell(5, 20)
    search.run(SearchStage.DRAWS).tell(20, 20)
    search.run(SearchStage.QUEUE).tell(3000, 3000)
    assert told[-1][:3] == ("queue", 3000, 3000) and told[-1][4] > 0.0


def test_what_a_lively_drive_loses_at_a_device_is_tried_at_a_calmer_one(drives_tried, ways):
    """Of the chains that failed: where parts hop, though nothing left, and where some left calmly."""
    search, _ = searching()
    lively, fast = calm_drive.drive_at(PLAIN, 0.18, hops=True), calm_drive.drive_at(PLAIN, 0.12)
    slowest = fast  # than which none is calmer
    while (calmer := calm_drive.find_calmer(PLAIN, slowest)) is not None:
        slowest = calmer
    for bowl, efficiency in ((lively, 0.0), (slowest, 0.0), (fast, 0.4), (slowest, 0.4)):
        one = candidate(
            ways,
            bowl,
            (lost("A@0", end_at(Fate.RETURNED, "vision reject")),),
            throw_number=throw_number(bowl),
        )
        search.state.failures.append(replace(one, attempt=replace(one.attempt, efficiency=efficiency)))
    found = list(nearest.variants(search, []))
    assert len(found) == len(drives_tried) == 2 and all("a calmer drive, " in one.change for one in found)
    for calmer, bowl in zip(drives_tried, (fast, lively), strict=True):
        assert calm_drive.speed(calmer) < 0.75 * calm_drive.speed(bowl)


@pytest.mark.parametrize(
    "more, word", [({"queues": fills(jams=1, seconds=6.0)}, "jam"), (CARRIED, "leaves too")]
)
def test_a_lower_rate_that_its_proof_denies_is_tried_at_a_calmer_drive(drives_tried, ways, more, word):
    """A cap of ABS at throw number 1.5: one jam in its queue; calmer it holds 16/min. At 3 draws deny it."""
    search, _ = searching(candidate(ways, calm_drive.drive_at(PLAIN, 0.18, hops=True)))
    speeds = []

    def prove(_, one):
        speeds.append(calm_drive.speed(one.bowl))
        return replace(study(600.0, **(more if len(speeds) == 1 else {})), bowl=one.bowl)

    found, made = nothing_near(search, prove)
    assert made is not None and found.rate > 0.0 and found.change.startswith("a calmer drive, ")
    assert len(speeds) == 2 and speeds[1] < 0.75 * speeds[0]
    assert len(found.denied) == 1 and word in found.denied[0]


def test_where_nothing_near_it_holds_bowls_are_sought_for_half_the_rate_of_the_trials(monkeypatch, ways):
    """A cap of ABS at 400/min: 59/min in its trial, denied by draws; a camera at a calm drive holds."""
    search, _ = searching(candidate(ways, rate=59.0))
    requests = []

    def candidates(free):
        requests.append(free.request)
        yield candidate(ways, rate=45.0, wanted="A@0")

    def prove(other, _):
        return study(60.0 * other.request.target) if other is not search else study(600.0, held=12, queues=())

    monkeypatch.setattr(calm_drive, "find_calmer", lambda *_: None)
    monkeypatch.setattr(exploring, "candidates", candidates)
    found, made = nothing_near(search, prove)
    assert [round(60.0 * one.target, 6) for one in requests] == [29.0]
    assert 60.0 * found.rate == pytest.approx(47.0) and "a lower rate, a bowl at" in found.change
    assert made.request is search.request and made.status == "falls short"


def test_any_heading_of_what_left_and_one_device_more_are_tried(monkeypatch, drives_tried, ways):
    """A third left on A at other headings, a third across: the first counts, the second is dropped."""
    search, _ = searching()
    monkeypatch.setattr(calm_drive, "find_calmer", lambda *_: None)
    across = next(one.name for one in ways.lying if one.aspect == "A" and one.name != "A@0")
    instead = ((heading_off("A"), 12), (orientation(across), 12))
    impure = study(40.0, queues=fills(right=21, left=45, instead=instead))
    heading, device = nearest.variants(search, [(impure, candidate(ways))])
    assert heading.candidate.proposal.any_heading == ("A",) and not heading.as_requested
    assert heading.search.request.up == ("A",) and "--up A" in heading.change
    assert across in device.candidate.proposal.cuts[0].returns and device.as_requested


def test_where_one_way_up_was_asked_for_others_are_tried_the_fast_ones_first(monkeypatch, ways):
    search, _ = searching(aspect="A", heading=0.0)
    search.state.attempts += [attempt(0.0, ("nothing leaves as wanted",), "device")] * 5
    asked = []

    def candidates(free):
        asked.append(free)
        free.state.clean += [candidate(ways, rate=rate, wanted="B@0") for rate in (10.0, 30.0, 20.0)]
        yield candidate(ways, rate=900.0, wanted="C@0")

    monkeypatch.setattr(exploring, "candidates", candidates)
    found = list(nearest.variants(search, []))
    assert [round(60.0 * one.candidate.attempt.rate) for one in found] == [900, 30, 20, 10]
    assert all("another way up" in one.change and not one.as_requested for one in found)
    (free,) = asked
    assert (free.request.aspect, free.request.heading, free.request.target) == (None, None, 10.0)
    assert free.limit == len(search.state.attempts) + USUAL_POLICY.other_way_trials and not search.state.clean
    assert list(nearest.variants(replace(search, request=DesignRequest(10.0)), [])) == []


def test_the_cause_is_of_what_was_asked_for_and_of_nothing_that_holds():
    """Two trials of A with one fault, then one of another way up: the cause is of A, and said once."""
    back = attempt(0.0, (lost("A@0", end_at(Fate.RETURNED, "gap")),), Cause.DEVICE, efficiency=0.0)
    made = DesignStudy(
        PART, DesignRequest(1.0, aspect="a"), None, None, None,
        attempts=(back, back, attempt(9.0, (lost("B@0", TURNED_ON_TRACK),), Cause.DRIVE, wanted="B@0")),
    )  # fmt: skip
    assert made.cause == "device" and "B@0" not in verdict_texts.reasons_text(made)
    assert made.shortfalls == ("A@0, 2 trials: lost (returned at gap)",)
    assert study(10.0).cause == study(400.0, partial=True).cause == ""
    document = designs.document(study(10.0))
    assert document["cause"] is None and document["nearest"] is None


def study_with(*devices, **more):
    counts = {name: more.pop(name) for name in ("right", "left", "returned") if name in more}
    return study(bowl=replace(BOWL, devices=devices), queues=fills(**counts), **more)


def test_the_design_that_is_the_answer_stands_for_its_class():
    """Beside an answer of 48/min with two cameras its class had 58/min with one, which is less pure."""
    slow, fast = study_with(GAP, right=30, left=30), study_with(GAP, right=40, left=45)
    assert alternatives([slow, fast], [], [1])[0].delivered == fast.proof.delivered
    assert alternatives([slow, fast], [], [1], slow)[0].delivered == slow.proof.delivered


def test_the_static_rule_promises_the_rate_at_the_gaps_that_the_devices_need(ways):
    """Of two cameras 112.6 a minute were promised, where feeder rate said 67.6 of the same bowl."""
    (search, _), made = searching(), candidate(ways)
    mean = float((made.weights * ways.lengths).sum())
    shares = SimpleNamespace(aspects=SimpleNamespace(source=lambda rule: rule))
    touching, apart = (
        loop._study_of(search, replace(made, trial=replace(made.trial, spacing=gap)), shares).static_rate
        for gap in (0.0, 8e-3)
    )
    assert apart > 0.0 and touching / apart == pytest.approx((mean + 8e-3) / mean)


def test_each_class_has_its_best_design_the_cheapest_first():
    studies = [study_with(GAP, right=30, left=45), study_with(GAP, SORTER), study_with(GAP)]
    rows = alternatives(studies, [], [1, 2, 3])
    assert [one.cost_class for one in rows] == [1, 2, 3]
    assert [one.status for one in rows] == ["holds", "none", "holds"]
    assert rows[0].delivered[0] == pytest.approx(45.0 / 60.0) and rows[0].purity == 1.0
    assert rows[0].efficiency == pytest.approx(45.0 / 50.0)  # of 180 that left and 20 that came back
    assert rows[2].sees == ("outline",) and "tells" in rows[1].why
    found = designs.document(study_with(GAP, alternatives=rows))["alternatives"]
    assert found[0]["delivered_per_minute"] == pytest.approx(45.0) and found[0]["needs"] == []
    assert found[2]["needs"] == ["1 camera from above", "1 valve", "compressed air"]
    printed = tables_of.text(designs.summary(study_with(GAP, alternatives=rows)), "table")
    assert "with steel alone" in printed and "yield 90 %" in " ".join(printed.split())
    tried = [
        attempt(faults=(carried("B@0"),), cost_class=3),
        attempt(faults=(stays("B@0"),), cost_class=3, efficiency=0.1),
    ]
    one, two, three = alternatives([study_with(GAP)], tried, [1])  # what was tried and not proved says why
    assert (one.status, two.status, three.status) == ("holds", "not tried", "none")
    assert "--alternatives" in two.why and three.why == "A@0: B@0 leaves too"


@pytest.fixture
def classes(monkeypatch):
    """A search of which no chain is looked for or tried: what is asked of it is noted."""
    asked = []
    search, _ = searching(budget=10)
    shares = np.array([0.6, 0.1])
    lying = [SimpleNamespace(name=f"{aspect}@0", aspect=aspect) for aspect in "AB"]
    for place, bank in enumerate((3.0, 0.0)):
        banked = SimpleNamespace(bowl=replace(BOWL, track=replace(BOWL.track, bank=np.radians(bank))))
        track = banked, SimpleNamespace(lying=lying), shares, [0, 1], USUAL_POLICY.bank_rank**place
        search.state.tracks.append(TrackAtBank(*track))
    monkeypatch.setattr(exploring.proposals, "propose_no_device", lambda *_: None)
    monkeypatch.setattr(exploring.hanging, "head_rows", lambda *_: [])  # neither part has a head
    monkeypatch.setattr(exploring, "_promise", lambda search, track, row, way: shares[row])

    def proposed(search, track, row, way):
        asked.append((round(np.degrees(track.plain_bowl.bowl.track.bank)), row, way))
        device = make_device("gap", "test", limit=5e-3 + 1e-3 * len(asked), text=f"{5 + len(asked)} mm")
        return proposals.Proposal(row, (), (device,), PROPOSED)

    def tried_out(search, track, proposal):
        search.state.attempts.append(attempt(faults=(carried("B@0"),), cost_class=1))
        search.state.chains.add(exploring.chain_key(track.plain_bowl.bowl.track, proposal, lying))
        yield from ()

    monkeypatch.setattr(exploring, "_propose", proposed)
    monkeypatch.setattr(exploring, "_try_and_mend", tried_out)
    return search, asked


def test_the_oftener_orientation_is_first_and_a_class_has_its_share_of_the_trials(classes):
    """Before a smaller margin of another orientation; no bank has all trials for itself."""
    search, asked = classes
    assert not list(exploring.candidates(search, 1))
    assert asked[0][:2] == (3, 0) and asked[1][1] == 0
    assert {bank for bank, _, _ in asked[:6]} == {3, 0}
    assert len(search.state.attempts) == 5  # half of ten
    for cost_class, count in ((2, 7), (3, 10)):  # the first two 70 %
        list(exploring.candidates(search, cost_class))
        assert len(search.state.attempts) == count
    search = replace(search, request=replace(search.request, budget=1000))
    list(exploring.candidates(search, 1))
    assert {row for _, row, way in asked if way.turns} == {1}


def test_the_same_chain_is_not_tried_twice_nor_one_that_differs_by_a_hair():
    def key(*devices):
        proposal = proposals.Proposal(0, (), devices, PROPOSED)
        return exploring.chain_key(BOWL.track, proposal, [SimpleNamespace(name="A@0")])

    def alike(one, other):
        return exploring._is_alike(key(*one), key(*other), USUAL_POLICY)

    first = make_device("vision reject", "test", like=("A", 0.0, 1e-3), also=(("B", 1.0),)).rewritten()
    other = make_device("vision reject", "test", like=("B", 1.0, 1e-3), also=(("A", 0.0),)).rewritten()
    assert first.text != other.text and key(first) == key(other)
    near, far = (make_device("gap", "test", limit=limit).rewritten() for limit in (9.05e-3, 9.5e-3))
    assert alike([GAP], [near]) and not alike([GAP], [far]) and not alike([GAP], [GAP, GAP])
    assert not alike([GAP], [make_device("wiper", "test", limit=9e-3)])
    # a gap that a user wrote otherwise, at another place, is the same gap
    assert key(GAP) == key(make_device("gap", "bowl.yaml:7:5", limit=9e-3, text="0.9 cm"))
    # a tenth of a degree of an angle makes no difference, two degrees do
    blade, turned, other_blade = (
        make_device("wiper", "test", limit=9e-3, sweep=np.radians(angle)) for angle in (1.0, 1.09, 3.0)
    )
    assert alike([blade], [turned]) and not alike([blade], [other_blade])
    # what a camera lets pass and how closely it looks
    coarse = make_device("vision reject", "test", like=("B", 1.0, 2e-3), also=(("A", 0.0),))
    side = make_device("vision reject", "test", like=("B", 1.0, 1e-3), also=(("A", 0.0),), sees="side")
    assert not alike([first], [coarse]) and not alike([first], [side])


@pytest.mark.parametrize("every, asked", [(False, [1]), (True, [1, 2, 3])])
def test_it_stops_at_the_first_class_that_holds_unless_alternatives_are_asked(monkeypatch, every, asked):
    searched = []

    def candidates(search, cost_class):
        searched.append(cost_class)
        yield SimpleNamespace(number=cost_class)

    def prove(search, candidate, proofs, most):
        chain = (SORTER,) if candidate.number == 3 else (GAP,)
        proofs.append((study_with(*chain, right=180 + 20 * candidate.number), candidate))  # the dearest: most

    monkeypatch.setattr(exploring, "candidates", candidates)
    monkeypatch.setattr(loop, "_prove", prove)
    found = loop.design(PART, BOWL, (), DesignRequest(40.0 / 60.0, alternatives=every))
    assert searched == asked and found.status == "holds"
    assert found.alternatives[0].status == "holds" and len(found.alternatives) == 3
    assert found.alternatives[2].status == ("holds" if every else "not tried")
    assert found.devices == (GAP,)  # the cheapest of those that hold
