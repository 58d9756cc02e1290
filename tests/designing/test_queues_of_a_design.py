"""Figures of a design from what its queues counted; queues end as soon as they surely hold, and no sooner."""

import functools
import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
import shapes
from design_counts import carried, design_study, lost, orientation, queue, stays, stopped_at
from scipy.stats import binom, hypergeom

from feederscrew import bowl as bowls
from feederscrew.base.running import RunSettings
from feederscrew.bowl.devices.kinds import make_device
from feederscrew.bowl.devices.trade import Action
from feederscrew.bowl.verified import Status
from feederscrew.designing import (
    calm_drive,
    evidence,
    fill_verdicts,
    loop,
    proposals,
    queues,
    short_trials,
    verdict_texts,
)
from feederscrew.designing.fill_verdicts import (
    DifferenceKind,
    FillLack,
    FillState,
    differing_fills,
    judge_fill,
    lacks_of_fill,
    longest_time,
    sequential_test,
    time_to_settle,
)
from feederscrew.designing.findings import Move, MoveKind
from feederscrew.designing.policy import USUAL_POLICY
from feederscrew.designing.proof import RobustRun
from feederscrew.designing.proposals import Proposal
from feederscrew.designing.record import DesignRequest, DesignStudy
from feederscrew.designing.search import Search
from feederscrew.feeding import stream
from feederscrew.output import design_pages, designs
from feederscrew.output import tables as tables_of
from feederscrew.resting.aspects import find
from feederscrew.trials import fills
from feederscrew.trials.fills import FillLevel, LeavingPose, PoseKind, share_interval
from feederscrew.trials.queue_counts import QueuedParts
from feederscrew.trials.supply import PARTS_IN_SHARES as BLOCK
from feederscrew.trials.wanted import aspects_at_any_heading

PART = shapes.part(shapes.box(10, 10, 10))
BOWL = bowls.default()
TARGET = 0.5  # [1/s] asked for
LEAST = 0.9 * TARGET
IMPURE = (0.96, 0.03, 0.03), (0.97, 0.11, 0.13), (0.98, 0.34, 0.48), (0.99, 0.80, 0.96)  # of an exact count


def study(*queues, **more):
    return design_study(PART, *queues, **more)


def test_the_rate_counts_what_is_wanted_of_the_worst_fill():
    found = queue(40, 45, 5, seconds=60.0, counted=60.0)
    assert 60.0 * found.rate == pytest.approx(40.0)
    low, high = (end / found.rate * 40.0 / 50.0 for end in found.ends)
    for end, tail in ((low, 1.0 - binom.cdf(39, 50, low)), (high, binom.cdf(40, 50, high))):
        assert 0.01 < tail < 0.05, end  # a two-sided interval of 95 %, as near as Wilson's is
    assert study().proof.jams_per_hour_high == pytest.approx(-np.log(0.05) / 200.0 * 3600.0)
    none = DesignStudy(PART, DesignRequest(1.0), None, None, None)
    assert none.status == "none" and none.why and np.isinf(none.proof.jams_per_hour_high)
    low, high = (
        queue(n, n, 225 - n, fill=fill, seconds=60.0, counted=60.0) for n, fill in ((45, "low"), (15, "high"))
    )
    some = study(low, high)
    assert 60.0 * some.proof.delivered[0] == pytest.approx(15.0)
    assert 60.0 * some.proof.delivered[1] == pytest.approx(225.0 * 0.0408, rel=1e-2)  # Wilson, 15 of 225
    slowed = some.proved_by(slowed=0.7).proof
    assert slowed.delivered_at_worst_friction == pytest.approx(0.7 * some.proof.delivered[0])
    assert some.status == "falls short" and "at high fill 15/min are delivered" in some.why


def test_jams_an_hour_are_those_of_the_fill_that_shows_least():
    """Of Poisson counts: 3.00 over the time of a fill without a jam (rule of three), 4.74 with one."""
    long, short = queue(fill="low", seconds=3600.0), queue(fill="high", seconds=60.0)
    assert study(long, short).proof.jams_per_hour_high == study(short).proof.jams_per_hour_high
    assert study(short).proof.jams_per_hour_high == pytest.approx(2.996 * 60.0, rel=1e-3)
    jammed = queue(fill="high", seconds=1200.0, jams=1)
    assert study(long, jammed).proof.jams_per_hour_high == pytest.approx(4.744 * 3.0, rel=1e-3)


@pytest.mark.parametrize(("counts", "cause", "why", "not_said"), [
    # more than 97 % is shown by 254 of 257, not told from 99 %; 1,960 of 2,000 are far from 99 %
    ({"right": 254, "left": 257}, "arrival", "has not yet decided for a purity of 99 %", "s only"),
    ({"right": 1960, "left": 2000}, "part", "refuses a purity of 99 % against 97 %", "too few parts"),
    ({"right": 80, "counted": 100.0}, "arrival", "too few parts left its queues", "s only"),
    # all that come leave as wanted: no part brings more
    ({"right": 80}, "arrival", "25/min would hold", "come so"),
    ({"seconds": 10.0}, "", "parts were followed for 10 s only", "the cause is"),
])  # fmt: skip
def test_what_a_fill_lacks_is_said_by_its_own_name(counts, cause, why, not_said):
    made = study(queue(**counts))
    assert (made.status, made.cause) == ("falls short", cause)
    assert why in made.why and not_said not in made.why


def test_draws_that_end_a_proof_are_its_cause_though_a_short_trial_was_clean():
    """No queue was followed; the short trial brought twice what is asked for."""
    clean = SimpleNamespace(efficiency=0.5, rate=80.0 / 60.0, faults=(), wanted="A@0")
    made = study(held=12).proved_by(queues=())
    made = replace(made, attempts=(clean,))
    assert made.cause == "drive" and "the cause is the drive: A@0 is lost" in made.why
    assert "comes too seldom" not in made.why


@pytest.mark.parametrize(("counts", "held", "why"), [
    ({}, 20, ""),
    ({"jams": 1}, 20, "1 jam in 200 s of queue"),
    ({"right": 160, "left": 180}, 20, "the purity is 88.9 % (160 of 180 parts), 98 % are asked for"),
    ({"right": 80}, 20, "80 of 80 parts left as wanted, which shows a purity of 96.3 %"),
    ({}, 18, "18 of 20 draws of part, friction and drive sort: A@0 is lost"),
    ({"right": 100, "returned": 65}, 20, "40/min are asked for"),
])  # fmt: skip
def test_it_holds_only_where_nothing_is_missing(counts, held, why):
    some = study(queue(**counts), held=held)
    assert (some.status, some.why == "") == (("falls short", False) if why else ("holds", True))
    assert why in some.why


def test_a_queue_that_was_stopped_or_brought_nothing_is_no_verdict_in_any_output(tmp_path):
    """Of 0.4 s of a queue: not 0 a minute, 8,150 jams an hour and a purity of nothing."""
    begun = study(queue(0, returned=0, seconds=0.4, counted=0.0, partial=True), partial=True)
    for some in (begun, study(partial=True)):
        told = designs.document(some)
        assert (some.status, told["status"]) == ("not proved", "not proved")
        assert all(told[name] is None for name in designs.PROOF)
        assert told["proved_so_far"] and told["robust"]["held"] == 20
        printed = tables_of.text(designs.summary(some), "table")
        assert "not proved" in printed and "20 of 20 draws sort" in " ".join(printed.split())
        assert not any(word in printed for word in ("holds", "falls short", "an hour", "nan"))
        names = [one.name for one in design_pages.offers(some, ())]
        assert names == ["design.json", "design_trials.csv", "design.yaml"]
        (tmp_path / "design.yaml").write_text(designs.bowl_file(some, ()))
        assert "\nverified:" not in (tmp_path / "design.yaml").read_text()
        assert bowls.verified(tmp_path / "design.yaml") is None
    assert designs.document(begun)["queues"][0]["delivered_per_minute"] is None
    assert "stopped after 0.4 s" in begun.why
    # a rate of 0 and a purity of nothing would tell of a queue; a share of nothing is no number
    without_queue = study(held=3, queues=())
    assert without_queue.status != "holds" and len(without_queue.shortfalls) == 1
    assert without_queue.shortfalls[0].startswith("3 of 20 draws")
    (tmp_path / "design.yaml").write_text(designs.bowl_file(study(queues=(), partial=True), ()))
    assert bowls.verified(tmp_path / "design.yaml") is None
    assert "Nothing is verified" in (tmp_path / "design.yaml").read_text()
    text = designs.bowl_file(study(queue(0, returned=50)), ())
    assert "\nverified:" not in text and "nan" not in text


@pytest.mark.parametrize(("right", "wrong", "returned", "seconds", "state"), [
    # 98 % are asked for and 97 % are to be shown: 99 parts with none wrong, 157 with 1, 208 with 2
    (99, 0, 0, 60.0, FillState.HOLDS),
    (98, 0, 0, 60.0, FillState.OPEN),
    (156, 1, 0, 60.0, FillState.HOLDS),
    (155, 1, 0, 60.0, FillState.OPEN),
    (99, 0, 0, 14.0, FillState.OPEN),  # the track has not filled
    (36, 4, 0, 40.0, FillState.REFUSED),  # at most 97.9 % (99 %, one-sided)
    (194, 7, 0, 60.0, FillState.OPEN),  # 7 ln 3 - 194 ln(0.99 / 0.97) is below ln 50
    (184, 7, 0, 60.0, FillState.REFUSED),
    # of 4 wrong: 97.002 % at least of 303, and r ln(0.99 / 0.97) - 4 ln 3 >= ln(1 / 0.15) from r = 309 on
    (299, 4, 0, 60.0, FillState.OPEN),
    (308, 4, 0, 60.0, FillState.OPEN),
    (309, 4, 0, 60.0, FillState.HOLDS),
    (37, 3, 0, 40.0, FillState.OPEN),
    (97, 3, 0, 200.0, FillState.OPEN),  # 300 in 600 s, of which 3 may be wrong
    (96, 4, 0, 200.0, FillState.REFUSED),
    (110, 3, 0, 590.0, FillState.REFUSED),  # 1 more comes
    # 27 a minute are asked for: of 130 offered in 60 s, 16.7 to 31 % leave as wanted (Wilson)
    (30, 0, 100, 60.0, FillState.OPEN),
    (14, 0, 151, 60.0, FillState.REFUSED),  # 13.7 % at most: 22.6 a minute
    (5, 0, 50, 19.0, FillState.OPEN),  # few have come until then
    (0, 0, 9, 60.0, FillState.REFUSED),
])  # fmt: skip
def test_a_fill_is_judged_by_its_own_parts(right, wrong, returned, seconds, state):
    found = queue(right, right + wrong, returned, seconds=seconds, counted=seconds)
    assert judge_fill(found, 0.45, 600.0) is state
    assert judge_fill(replace(found, jams=1), 0.45, 600.0) is FillState.REFUSED
    assert (judge_fill(found, 0.0, 600.0) is FillState.REFUSED) == (state is FillState.REFUSED and wrong > 0)


@functools.cache
def states_by_counts(parts):
    """State of a fill after so many parts (rows), so many of them wrong: -1 refused, 0 open, 1 holds."""
    values = {FillState.OPEN: 0, FillState.HOLDS: 1, FillState.REFUSED: -1}
    table = np.full((parts + 1, 25), -1)
    for left in range(1, parts + 1):
        for wrong in range(min(left, 25)):
            seconds = 600.0 * left / parts
            found = queue(left - wrong, left, 0, seconds=seconds, counted=seconds)
            table[left, wrong] = values[judge_fill(found, 0.0, 600.0)]
            if table[left, wrong] < 0 and wrong > 12:
                break  # more wrong ones are refused too
    return table


def settled(purity, parts):
    """Shares of fills of a purity that hold and that are refused, looked at after each of so many parts.

    Exact: how probable each number of wrong parts is, of what is open, part by part.
    """
    table, chance = states_by_counts(parts), np.zeros(25)
    chance[0], shares = 1.0, np.zeros(3)
    for left in range(1, parts + 1):
        chance[1:], chance[0] = purity * chance[1:] + (1.0 - purity) * chance[:-1], purity * chance[0]
        for state in (-1, 1):
            at = table[left] == state
            shares[state] += chance[at].sum()
            chance[at] = 0.0
    return shares[1], shares[-1]


@pytest.mark.parametrize("purity, share, faster", IMPURE)
def test_what_is_impure_holds_seldom_however_often_it_is_looked_at(purity, share, faster):
    """At 30 and 60 parts a minute, a look after each part: docs/design.md."""
    for parts, expected in ((300, share), (600, faster)):
        held, refused = settled(purity, parts)
        assert held == pytest.approx(expected, abs=0.01)
        if purity <= fill_verdicts.SHOWN_PURITY:
            assert held <= fill_verdicts.HOLDS_IN_ERROR
        if purity >= fill_verdicts.GOOD_PURITY and parts == 600:
            # beside what is surely impure, and what cannot hold any more in its time
            assert refused <= fill_verdicts.REFUSED_IN_ERROR + 0.025


def test_the_sequential_test_is_that_of_wald():
    """Acceptance numbers of a plan for 1 % and 3 % wrong (Wald 1945, sec. 5.2)."""
    right, wrong = np.log(0.99 / 0.97), np.log(0.01 / 0.03)
    for w in range(6):
        holds = (np.log(1.0 / 0.15) - w * wrong) / right  # right parts
        for r, least in ((math.floor(holds), False), (math.ceil(holds), True)):
            ratio = evidence.log_likelihood_ratio(r, r + w, 0.99, 0.97)
            assert (ratio >= np.log(1.0 / 0.15)) == least
    back = evidence.log_likelihood_ratio(7, 10, 0.97, 0.99)
    assert back == pytest.approx(-evidence.log_likelihood_ratio(7, 10, 0.99, 0.97))


def test_what_the_sequential_test_alone_decides_is_said_to_be_its():
    """Four wrong: enough is pure from 299 right parts on, the test holds from 309 on (sums by hand)."""
    lacks = {
        right: lacks_of_fill(queue(right, right + 4, seconds=60.0), 0.0) for right in (298, 299, 308, 309)
    }
    assert lacks == {
        298: (FillLack.PURITY_NOT_SHOWN,),
        299: (FillLack.PURITY_OPEN,),
        308: (FillLack.PURITY_OPEN,),
        309: (),
    }
    refused = queue(184, 191, seconds=60.0)
    assert evidence.share_at_most(184, 191, fill_verdicts.REFUSED_CONFIDENCE) > fill_verdicts.PURE
    assert sequential_test(refused) is judge_fill(refused, 0.0, 1e6) is FillState.REFUSED
    assert sequential_test(queue(194, 201)) is judge_fill(queue(194, 201), 0.0, 1e6) is FillState.OPEN


def test_a_fill_with_parts_that_stood_too_deep_neither_holds_nor_is_refused():
    """A fault of the trial refuses no device, and shows of none that it works."""
    good = queue(400, 400, seconds=600.0)
    assert judge_fill(good, 0.0, 1e6) is FillState.HOLDS
    deep = replace(good, overlaps=1)
    assert lacks_of_fill(deep, 0.0) == (FillLack.OVERLAP,)
    assert judge_fill(deep, 0.0, 1e6) is FillState.OPEN
    made = study(deep)
    assert made.status is Status.FALLS_SHORT and made.proof.jams == 0
    assert "fault of the trial" in verdict_texts.why_text(made) and "jammed" not in verdict_texts.why_text(
        made
    )


def test_how_long_a_fill_is_followed_follows_from_the_rate_that_is_asked_for():
    assert longest_time(0.5) == pytest.approx(600.0)
    assert (longest_time(100.0), longest_time(1e-6)) == (120.0, 3600.0)


def test_a_fill_is_guessed_to_be_settled_by_its_own_rate():
    """So many right parts settle a fill of which none, one or two are wrong."""
    for wrong, parts in ((0, 99), (1, 156), (2, 206)):
        seen = queue(30, 30 + wrong, seconds=20.0)
        assert time_to_settle(seen, 600.0) == pytest.approx(20.0 * parts / 30.0)
        states = [
            judge_fill(queue(n, n + wrong, seconds=70.0, counted=70.0), 0.5, 600.0)
            for n in (parts - 1, parts)
        ]
        assert states == [FillState.OPEN, FillState.HOLDS]
    assert time_to_settle(queue(0, seconds=20.0), 600.0) == 600.0
    assert time_to_settle(queue(5, seconds=300.0), 600.0) == 600.0
    # pure already, and still open: by its rate
    assert time_to_settle(queue(120, seconds=40.0), 600.0) == pytest.approx(60.0)


def test_a_cleaner_fill_improves_no_figure():
    """One fill alone is the same answer as that fill beside two that are clean."""
    low, normal, high = (
        queue(400, 400, 100, 0, FillLevel.LOW), queue(600, 600, 0, 0, "normal"), queue(36, 40, 30, 0, "high"),
    )  # fmt: skip
    alone, beside = study(high), study(low, normal, high)
    for name in ("delivered", "purity", "efficiency"):
        assert getattr(alone.proof, name) == getattr(beside.proof, name), name
    assert beside.proof.worst_fill is high and beside.status == "falls short"
    assert min(one.rate for one in beside.proof.queues) >= beside.proof.delivered[1]
    # the least of each: one fill is slow, another one impure
    slow = queue(200, 200, 0, 0, FillLevel.LOW, counted=300.0)
    both = study(slow, queue(390, 400, 0, 0, FillLevel.HIGH))
    assert both.proof.delivered[0] == slow.rate and both.proof.purity[0] == 0.975


def test_a_fill_that_differs_is_named_with_what_leaves_wrong_there_and_at_which_device():
    wrong = ((orientation("E@90"), 4),)
    cut = SimpleNamespace(returns=("E@90",), device=SimpleNamespace(kind="gap"))
    low = queue(188, 189, 30, 0, FillLevel.LOW, wanted_returned_at=(("wiper", 2),))
    high = queue(
        36, 40, 130, 0, FillLevel.HIGH, left_instead=wrong, wanted_returned_at=(("gap", 6), ("wiper", 51))
    )
    purity, share = differing_fills((low, high), (cut,))
    assert (purity.fill, purity.kind, share.kind) == ("high", DifferenceKind.PURITY, DifferenceKind.YIELD)
    # R: fisher.test(matrix(c(36, 4, 188, 1), 2))
    assert purity.chance == pytest.approx(hypergeom.sf(3, 229, 5, 40), rel=1e-9)
    assert (purity.pose, purity.count, purity.device) == (orientation("E@90"), 4, "gap")
    assert (share.right, share.total, share.device, share.count) == (36, 170, "wiper", 51)
    assert differing_fills((low, queue(39, 40, 6, 0, FillLevel.HIGH)), ()) == ()
    assert differing_fills((low,)) == ()
    some = study(low, high, cuts=(cut,))
    for text in (some.why, designs.document(some)["differences"][0]["text"]):
        assert "at high fill 36 of 40 parts" in text and "E@90 leaves there (4, past the gap)" in text
    assert "fall back at the wiper (51)" in tables_of.text(designs.summary(some), "csv").replace("\n,", " ")


@pytest.fixture
def prove(monkeypatch):
    """Prove a candidate whose studies are known by their bowls; the studies, and what was tried meanwhile."""

    def call(first, second, results):
        tried, proofs = [], []
        search = Search.begin(None, DesignRequest(1.0), BOWL)

        def attempted(search, made, proposal, weights, driven=None):
            tried.append((proposal, driven, search.state.min_speed))
            return second

        monkeypatch.setattr(loop, "prove_design", lambda search, candidate, whole: results[candidate.bowl])
        monkeypatch.setattr(loop.exploring, "try_proposal", attempted)
        monkeypatch.setattr(loop.exploring, "_screen", lambda search, candidate: candidate)
        loop._prove(search, first, proofs)
        assert search.state.min_speed == 0.0
        return [one for one, _ in proofs], tried

    return call


def candidates_of(bowl, other):
    clean, ways = SimpleNamespace(clean=True, faults=()), SimpleNamespace(lying=())
    chain = SimpleNamespace(cuts=(), devices=(), name="rails", chain=("rails: 6 mm",))
    first = SimpleNamespace(
        bowl=bowl, proposal=chain, weights=None, trial=None, orientations=ways, attempt=clean,
        plain_bowl=lambda search: None,
    )  # fmt: skip
    return first, SimpleNamespace(**vars(first) | {"bowl": replace(bowl, drive=other)})


@pytest.mark.parametrize(("speeds", "proved"), [(1.3, 2), (1.0, 1)])
def test_what_draws_lose_at_a_device_is_tried_again_at_a_faster_drive(monkeypatch, prove, speeds, proved):
    """A fifth of the draws stop what is wanted: it is proved at 1.3 times the speed, if that is another."""
    asked, other = [], replace(BOWL, drive=replace(BOWL.drive, amplitude=speeds * BOWL.drive.amplitude))
    slow = study(robust=RobustRun(20, 16, lost("A@0", stopped_at("rails")).counted_in_draws(4, 20)))
    monkeypatch.setattr(loop.proposals, "mend_proposal", lambda *chain: None)

    def driven_for(search, made, proposal, weights):
        asked.append(search.state.min_speed)
        return other

    monkeypatch.setattr(loop.exploring, "drive_for_target", driven_for)
    studies, tried = prove(*candidates_of(BOWL, other.drive), {other: study(held=19), BOWL: slow})
    assert asked == [pytest.approx(USUAL_POLICY.faster * calm_drive.speed(BOWL))]
    assert len(studies) == proved == len(tried) + 1


def test_what_one_device_more_loses_is_tried_at_a_calmer_drive(monkeypatch, prove):
    """A second sensor lost a cap that hops at 1.6 mm, which one sensor isolates at 0.5 mm as well."""
    first, second = candidates_of(BOWL, replace(BOWL.drive, amplitude=0.5 * BOWL.drive.amplitude))
    seen = SimpleNamespace(loses_wanted=True)
    hops = SimpleNamespace(**vars(first) | {"attempt": SimpleNamespace(clean=False), "trial": seen})
    impure = study(robust=RobustRun(20, 16, carried("B@0").counted_in_draws(4, 20)))
    monkeypatch.setattr(loop.proposals, "mend_proposal", lambda *chain: "a second sensor")
    for calmer, proved in ((second, 2), (None, 1)):
        monkeypatch.setattr(loop.exploring, "try_again", lambda *_: hops)
        monkeypatch.setattr(loop.exploring, "try_calmer", lambda search, candidate, own=calmer: own)
        studies, _ = prove(first, second, {BOWL: impure, second.bowl: study()})
        assert len(studies) == proved
    seen.loses_wanted = False  # it lets something else through: no drive changes that
    monkeypatch.setattr(loop.exploring, "try_calmer", lambda *_: pytest.fail("nothing was lost"))
    assert len(prove(first, second, {BOWL: impure})[0]) == 1


@pytest.mark.parametrize(
    ("lively_rate", "calm_rate", "taken"), [(2.0, 2.0, 0), (0.0, 2.0, 1), (0.0, 0.5, None)]
)
def test_what_may_hang_and_leaves_lying_is_tried_at_a_livelier_drive_and_at_a_calmer_one(
    monkeypatch, prove, lively_rate, calm_rate, taken
):
    """Of pan heads 3 of 33 left lying over the slot at 0.18 mm, none of 23 at 0.155 mm; 1/s is asked for."""
    first, second = candidates_of(BOWL, replace(BOWL.drive, amplitude=0.8 * BOWL.drive.amplitude))
    lying = SimpleNamespace(lying=(SimpleNamespace(name="A@347"),))
    first = SimpleNamespace(**vars(first) | {"orientations": lying, "shown": {0: 1.0}})

    def at_rate(rate, frequency):
        attempt = SimpleNamespace(clean=rate > 0.0, rate=rate, faults=())
        bowl = replace(BOWL, drive=replace(BOWL.drive, frequency=frequency))
        return SimpleNamespace(**vars(second) | {"attempt": attempt, "bowl": bowl})

    drives = at_rate(lively_rate, 60.0), at_rate(calm_rate, 70.0)
    over_slot = LeavingPose(PoseKind.ORIENTATION, "A", "A@347")
    impure = study(queue(150, 200, 0, left_instead=((over_slot, 50),)))
    monkeypatch.setattr(loop.exploring, "try_livelier", lambda *_: drives[0])
    monkeypatch.setattr(loop.exploring, "try_calmer", lambda *_: drives[1])
    for name in ("add_second_sensor", "spread_apart"):
        monkeypatch.setattr(loop.proposals, name, lambda *_: None)
    monkeypatch.setattr(loop.proposals, "purify", lambda *_: ())
    proved, _ = prove(first, second, {BOWL: impure} | {one.bowl: study() for one in drives})
    assert len(proved) == (1 if taken is None else 2)
    other = None if taken is None else drives[taken]
    assert loop._change_by_proof(Search.begin(None, DesignRequest(1.0), BOWL), impure, first) is other


@pytest.mark.parametrize(
    ("mended", "proved"),
    [
        ({"A": "BC", "B": "AC", "C": "AB"}, [("A", 1.0), ("B", 1.0), ("C", 1.0)]),  # each asks for the others
        ({"A": "A"}, [("A", 1.0), ("A", 1.2)]),  # a livelier drive, and back to the first
        ({"A": "B", "B": "C", "C": "D", "D": "E"}, [("A", 1.0), ("B", 1.0), ("C", 1.0), ("D", 1.0)]),
    ],
)
def test_a_chain_is_proved_once_at_a_drive_and_a_few_are(monkeypatch, mended, proved):
    """A nut's queue jammed at one width of the track, then at another: each asks for the other again."""
    first, _ = candidates_of(BOWL, BOWL.drive)
    own = vars(first.proposal)
    chains = {
        name: SimpleNamespace(**own | {"chain": (name,), "name": name, "cost_class": 1}) for name in "ABCDE"
    }

    def made(name, stroke):
        bowl = replace(BOWL, drive=replace(BOWL.drive, amplitude=stroke * BOWL.drive.amplitude))
        return SimpleNamespace(**vars(first) | {"proposal": chains[name], "bowl": bowl})

    def other_drive(search, candidate):
        return made(candidate.proposal.name, 1.2 if candidate.bowl == BOWL else 1.0)

    seen, search, proofs = [], Search.begin(None, DesignRequest(1.0), BOWL), []

    def proved_so(search, candidate, whole):
        seen.append((candidate.proposal.name, candidate.bowl.drive.amplitude / BOWL.drive.amplitude))
        return study(queue(jams=1))

    def mends(search, candidate, jammed):
        return iter([chains[name] for name in mended[candidate.proposal.name]])

    lively = other_drive if mended == {"A": "A"} else lambda *_: None
    monkeypatch.setattr(loop, "prove_design", proved_so)
    monkeypatch.setattr(loop, "hop", lambda bowl: SimpleNamespace(height=0.0))
    monkeypatch.setattr(loop.exploring, "mends_of_jams", mends)
    monkeypatch.setattr(loop.exploring, "try_again", lambda search, one, chain, bowl: made(chain.name, 1.0))
    monkeypatch.setattr(loop.exploring, "try_livelier", lively)
    monkeypatch.setattr(loop.proposals, "add_pressure_break", lambda candidate: None)
    loop._prove(search, made("A", 1.0), proofs)
    assert seen == [(name, pytest.approx(stroke)) for name, stroke in proved]
    assert len(proofs) == len(seen) <= USUAL_POLICY.proof_changes + 1
    # each queue was followed for 200 s: so long that nothing is changed after the first, or the second
    for more, count in ((150.0, 1), (350.0, 2)):
        proofs.clear()
        loop._prove(search, made("A", 1.0), proofs, search.state.denied + more)
        assert len(proofs) == count


def test_what_draws_carry_through_or_jams_is_tried_with_another_value_drive_or_break(monkeypatch, prove):
    first, second = candidates_of(BOWL, replace(BOWL.drive, frequency=2.0 * BOWL.drive.frequency))
    impure = study(robust=RobustRun(20, 16, carried("B@0").counted_in_draws(4, 20)))
    monkeypatch.setattr(loop.proposals, "mend_proposal", lambda *chain: "a narrower track")
    studies, tried = prove(first, second, {BOWL: impure, second.bowl: study()})
    assert len(studies) == 2 and tried == [("a narrower track", BOWL, 0.0)]
    # Parts that hop 0.2 mm jam for another reason: there the parts that back up are taken off
    calm = replace(BOWL, drive=replace(BOWL.drive, amplitude=0.1 * BOWL.drive.amplitude))
    first, second = candidates_of(calm, replace(BOWL.drive, frequency=50.0, amplitude=7e-4))
    jammed = study(queue(jams=1))
    monkeypatch.setattr(loop.calm_drive, "find_livelier", lambda made, own: second.bowl)
    monkeypatch.setattr(loop, "replace", lambda one, **more: one)  # proposals and bowls are stand-ins
    monkeypatch.setattr(loop.exploring, "replace", lambda one, **more: one)
    monkeypatch.setattr(loop.proposals, "add_pressure_break", lambda candidate: "with a pressure break")
    studies, tried = prove(first, second, {calm: jammed, second.bowl: jammed})
    assert [one.proof.jams for one in studies] == [1, 1]  # the stand-in for a break is the chain again
    assert [one[1] for one in tried] == [second.bowl] * 2 and tried[1][0] == "with a pressure break"
    studies, tried = prove(first, second, {calm: jammed, second.bowl: study()})
    assert [one.proof.jams for one in studies] == [1, 0] and len(tried) == 1


@pytest.mark.parametrize(("fault", "count"), [(stays("B", stopped_at("wiper")), 1), (carried("B"), 0)])
def test_what_stays_at_a_blade_is_tried_at_a_livelier_drive(monkeypatch, fault, count):
    drives = []
    wiper = SimpleNamespace(device=SimpleNamespace(action=Action.OVERHEAD, kind="wiper"))
    proposal = Proposal(0, (wiper,), (), Move(MoveKind.PROPOSED))
    first = SimpleNamespace(
        bowl="calm", proposal=proposal, weights=None, attempt=SimpleNamespace(faults=(fault,)),
        plain_bowl=lambda search: None,
        orientations=SimpleNamespace(lying=(SimpleNamespace(name="B@0"),)),
    )  # fmt: skip
    clean = SimpleNamespace(attempt=SimpleNamespace(clean=True, rate=2.0))
    search = Search.begin(None, DesignRequest(1.0), BOWL)
    monkeypatch.setattr(loop.exploring, "_screen", lambda search, candidate: candidate)
    monkeypatch.setattr(loop.exploring, "try_proposal", lambda *given: drives.append(given[-1]) or clean)
    monkeypatch.setattr(loop.calm_drive, "find_livelier", lambda made, own: bowls.default())
    with pytest.raises(StopIteration) as ended:
        next(loop.exploring._find_livelier(search, first))
    assert ended.value.value is (clean if count else None)
    assert len(drives) == len(search.state.clean) == count


def test_the_share_of_parts_that_come_in_exact_shares_is_left_to_chance_within_each_orientation():
    """All 20 of one orientation leave, none of 80 others: Wilson's ends of 20 of 20 and of 0 of 80."""
    one = queue(20, 20, 80, counted=18.0, counts_by_entry=((20, 20), (80, 0)))
    low, high = share_interval([one])
    assert low == pytest.approx(0.2 - 0.2 * (1.0 - 0.8389), abs=1e-4)
    assert high == pytest.approx(0.2 + 0.8 * 0.0458, abs=1e-4)
    pooled = share_interval([replace(one, counts_by_entry=())])
    assert pooled == pytest.approx((0.1334, 0.2888), abs=1e-4)  # Wilson's of 20 of 100
    both = share_interval([one, one])
    assert low < both[0] < 0.2 < both[1] < high


class FakeQueue:
    """Stands for a queue: so many parts leave each second, all as wanted, and it may jam."""

    def __init__(self, rate, jams_at=np.inf, stop_at=np.inf):
        self.rate, self.jams_at, self.stop_at, self.time = rate, jams_at, stop_at, 0.0

    @property
    def periods(self):
        return round(50.0 * self.time)

    def follow(self, seconds, tell):
        if seconds > self.stop_at:
            self.time = self.stop_at
            raise KeyboardInterrupt
        self.time = max(seconds, self.time)
        tell(self.periods, 0)

    def result(self, partial=False):
        return SimpleNamespace(queue=self, partial=partial)


class FakeRow(queues.FollowedRow):
    def queue(self, fill, seconds, seed):
        return self.part[fill]

    def count(self, fill, seen):
        one = seen.queue
        more = {"seconds": one.time, "counted": 0.95 * one.time, "partial": seen.partial, "fill": fill}
        return queue(int(one.rate * one.time), returned=0, jams=int(one.time >= one.jams_at), **more)


def followed(*fakes, whole=False, running=None, **more):
    """The fills of three queues, low to high, each a rate or what a fake is made of, and the queues."""
    fakes = [FakeQueue(*(one if isinstance(one, tuple) else (one,))) for one in fakes]
    bowl = SimpleNamespace(drive=SimpleNamespace(frequency=50.0))
    row = FakeRow(dict(zip(FillLevel, fakes)), bowl, None, None, None, (0,), seed=1, least=LEAST)
    made = queues.follow_fills(replace(row, **more), whole=whole, running=running)
    return [(one.fill, one.seconds, one.partial) for one in made], made


def test_each_fill_ends_as_soon_as_it_is_settled_and_no_sooner():
    """99 right parts settle a fill: in 15 s of a fast one, in 99 and 124 s of slower ones."""
    said, bars = [], []
    fills, made = followed(0.8, 1.0, 8.0, tell=said.append, progress=lambda *bar: bars.append(bar))
    assert fills == [("low", 124.0, False), ("normal", 99.0, False), ("high", 15.0, False)]
    assert queues.is_complete(made, 600.0) and not queues.is_complete(made[1:], 600.0)
    assert said[0] == "queue of 12 at high fill, to 15 s" and len(said) == 3 + 2
    # part-seconds: 12 parts, which push, for 15 s, 10 for 99 s and 8 for 124 s: known once each was looked at
    done, total = zip(*bars)
    assert done == tuple(sorted(done)) and done[-1] == 2 * 180 + 990 + 992 and total[-1] < 2380
    begun = done.index(15 * (2 * 12 + 10 + 8))
    assert max(total[: begun - 1]) > 3000 and 2280 < min(total[begun + 1 :]) <= max(total[begun + 1 :]) < 2430
    # a jam denies it, and nothing more is followed at the other fills
    fills, made = followed(1.2, 1.2, (1.2, 24.5))
    assert fills == [("low", 15.0, False), ("normal", 15.0, False), ("high", 25.0, False)]
    assert made[-1].jams == 1 and not queues.is_complete(made, 600.0)
    with pytest.raises(KeyboardInterrupt):
        followed(*[(2.0, np.inf, 0.0)] * 3)
    # too slow, and followed to the end of its time: what its parts decide decides
    fills, _ = followed(0.4, 0.5, 2.0, whole=True, longest=150.0)
    assert [seconds for _, seconds, _ in fills] == [150.0, 150.0, 50.0]


@pytest.mark.parametrize("jobs", [1, 3])
@pytest.mark.parametrize(("fakes", "seconds"), [
    ((0.8, 2.0, (1.2, 24.5)), [60.0, 50.0, 25.0]),  # 99 parts by 50 s; 48 by 60 s, and no more of them
    ((0.8, (1.2, 9.0), (1.2, 70.5)), [60.0, 9.0, 60.0]),  # it is refused before the others go on
])  # fmt: skip
def test_after_a_refused_fill_the_others_are_followed_for_their_figures_alone(fakes, seconds, jobs):
    running = {}
    fills, made = followed(*fakes, whole=True, jobs=jobs, running=running)
    assert [each for _, each, _ in fills] == seconds
    assert queues.is_complete(made, 600.0)
    assert all(running[name].time == each for name, each, _ in fills if name in running)
    open_for = [replace(made[0], jams=0, seconds=seconds, right=40, left=40) for seconds in (55.0, 60.0)]
    assert [queues.is_complete([low, *made[1:]], 600.0) for low in open_for] == [False, True]


@pytest.mark.parametrize("jobs", [1, 3])
@pytest.mark.parametrize(("fakes", "fills"), [
    ((2.0, (2.0, 9.0), 2.0), [("normal", 9.0, False), ("high", 15.0, False)]),  # a jam where it is seen
    # surely too slow, which is said after 20 s
    ((0.2, 2.0, 2.0), [("low", 20.0, False), ("normal", 50.0, False), ("high", 50.0, False)]),
    ((2.0, 2.0, 0.2), [("low", 15.0, False), ("normal", 15.0, False), ("high", 20.0, False)]),
])  # fmt: skip
def test_what_denies_it_ends_it_where_it_is_seen(fakes, fills, jobs):
    """The same on one core and on three, and so is what goes on from there."""
    running = {}
    assert followed(*fakes, jobs=jobs, running=running)[0] == fills
    assert all(running[name].time in (seconds, 15.0) for name, seconds, _ in fills if name in running)
    again, _ = followed(*fakes, jobs=jobs, whole=True, longest=60.0, running=running)
    assert again == followed(*fakes, whole=True, longest=60.0)[0]


@pytest.mark.parametrize("jobs", [1, 3])
def test_beside_a_fill_that_jams_the_others_are_followed_for_a_minute(jobs):
    """Each is to be shown, and none decides anything any more: the third of them is open for 10 min."""
    running = {}
    fills, _ = followed(0.3, 0.1, (2.0, 9.0), whole=True, jobs=jobs, running=running)
    assert fills == [("low", 60.0, False), ("normal", 60.0, False), ("high", 9.0, False)]
    assert all(made.time <= 60.0 for made in running.values())
    # what was followed before the jam was seen stays as it is
    fills, _ = followed((2.0, 16.0), 0.3, 0.3, whole=True, jobs=jobs, longest=90.0)
    assert fills == [("low", 16.0, False), ("normal", 90.0, False), ("high", 90.0, False)]


@pytest.mark.parametrize(("fakes", "fills"), [
    ((2.0, (2.0, np.inf, 13.0), 2.0), [("normal", 13.0, True), ("high", 15.0, False)]),
    ((2.0, (2.0, np.inf, 0.0), 2.0), [("high", 15.0, True)]),
])  # fmt: skip
def test_what_the_user_stops_is_marked(fakes, fills):
    assert followed(*fakes)[0] == fills


def test_touching_parts_come_as_they_entered_the_track(monkeypatch):
    offered = {}  # apart they come in the shares behind the ride
    monkeypatch.setattr(fills, "PartsQueue", lambda *own: offered.update({own[5].gaps: own[3][1]}))
    monkeypatch.setattr(fills, "find_poses", lambda *_: ())
    known, arriving, entering = SimpleNamespace(lying=()), np.array([0.9, 0.1]), np.array([0.5, 0.5])
    made = queues.FollowedRow(None, None, None, known, arriving, (0,), touching=entering, seed=1)
    for fill in queues.FILLS:
        made.queue(fill, 60.0, 1)
    kinds = [offered[fill.gaps] is entering for fill in queues.FILLS]
    assert kinds == [offered[fill.gaps] is not arriving for fill in queues.FILLS] == [True, False, False]


@pytest.mark.parametrize("rates", [(8.0, 8.0, 8.0), (1.2, 1.2, 1.2), (0.3, 2.0, 2.0)])
@pytest.mark.parametrize("ends", [(np.inf,), (9.0,), (25.0,), (np.inf, 13.0)])
def test_fills_side_by_side_end_as_in_turn(rates, ends):
    fakes = rates[0], (rates[1], *ends), rates[2]
    assert followed(*fakes, jobs=2)[0] == followed(*fakes, jobs=1)[0]


def test_parts_of_a_row_come_in_exact_shares_in_random_order_and_are_counted_by_how_they_came(block):
    ways, shares = block.ways, np.zeros(len(block.ways.lying))
    shares[:3] = 0.5, 0.3, 0.2
    wanted = (int(ways.leaves_as[0]),)
    made = queues.FollowedRow(block.part, bowls.default(), block.aspects, ways, shares, wanted, seed=1)
    one = made.queue(FillLevel.LOW, 60.0, 1)
    drawn, entered, coming = one.supply.drawn_rows[::-1], one.entry_rows, one.supply.waiting
    entered = [*entered[: BLOCK - len(drawn) - 1], coming.row] if coming else entered
    rows = [*entered[: BLOCK - len(drawn)], *drawn]
    assert np.bincount(rows, minlength=3)[:3] / BLOCK == pytest.approx(shares[:3], abs=1.0 / BLOCK)
    assert rows != sorted(rows)
    one.follow(2.5)
    seen = one.result()
    assert seen.left_by_entry.sum(axis=0).tolist() == seen.whole.tolist()
    assert seen.returned_by_entry.sum() == seen.returned
    counted = made.count(FillLevel.LOW, seen)
    assert sum(n for n, _ in counted.counts_by_entry) == counted.offered > 0
    assert sum(k for _, k in counted.counts_by_entry) == counted.right
    assert counted.parts == 8 and made.queue(FillLevel.HIGH, 60.0, 1).plan.parts == 12


def test_what_comes_behind_its_ride_enters_two_pitches_before_a_sensor(block):
    """Parts that touch enter the track a whole row before it; without a sensor all do."""
    ways, wanted = block.ways, block.ways.lying[0]
    sorter = make_device("vision reject", "test", like=(wanted.aspect, wanted.heading, 1e-3), text="test")
    longest, shares = float(ways.lengths.max()), np.full(len(ways.lying), 1.0)

    def before(devices, fill):
        driven = replace(bowls.default(), devices=devices)
        row = queues.FollowedRow(block.part, driven, block.aspects, ways, shares, (0,), seed=1)
        return -row.queue(fill, 60.0, 1).track.start, stream.needed_spacing(devices, ways.lying, driven)

    for fill in (FillLevel.LOW, FillLevel.NORMAL):
        way, room = before((sorter,), fill)
        assert room > 0.0 and way == pytest.approx(
            2.0 * (room + (1.0 + 2.0 * fill.gaps) * longest), rel=1e-12
        )
        assert before((), fill)[0] > 1.5 * way
    assert before((sorter,), FillLevel.HIGH)[0] == pytest.approx(before((), FillLevel.HIGH)[0], rel=1e-12)


def left_queue(block, *rows):
    """A queue from (row of a state, parts that left in it, by the aspect on which they lay)."""
    whole = np.zeros((len(block.ways.states) + 1, len(block.aspects.names) + 1), int)
    for row, counts in rows:
        for aspect, count in counts.items():
            whole[row, -1 if aspect == "none" else block.aspects.names.index(aspect)] = count
    return QueuedParts(
        parts=12, on_track=9, is_poured=False, seconds=60.0, counted_seconds=50.0, returned=3,
        whole=whole, left_by_entry=whole[None], returned_by_entry=np.array([3]), delivered=float(whole.sum()),
        jams=0, climbs=0, velocity=0.05,
        gap=0.01, touching=0.2, pressure=np.zeros(0), depth_in_track=0.0, depth_in_part=0.0, partial=False,
    )  # fmt: skip


@pytest.mark.parametrize(("wanted", "up", "lying", "right"), [
    # of 16 that left 15 lie on A, 5 of them at a heading that is none of the known
    ("A@0", (), {"A@0": {"A": 4}, "A@90": {"A": 6}, "": {"A": 5, "none": 1}}, 4),
    ("A@0", ("A",), {"A@0": {"A": 4}, "A@90": {"A": 6}, "": {"A": 5, "none": 1}}, 15),
    # a wanted orientation counts beside an aspect that may be up
    ("B@0", ("A",), {"A@0": {"A": 3}, "B@0": {"B": 5}, "": {"A": 3, "none": 1}}, 5 + 6),
    # askew, a part is nearest in attitude to B and has A below it: one part, of eight that left
    ("B@0", ("A",), {"B@0": {"A": 2, "B": 3}, "": {"C": 1, "A": 2}}, 5 + 2),
])  # fmt: skip
def test_a_queue_counts_each_part_once_that_leaves_as_any_of_those_wanted(block, wanted, up, lying, right):
    seen = left_queue(block, *((block.names[name] if name else -1, row) for name, row in lying.items()))
    ways, rows = block.ways, (block.names[wanted],)
    row = queues.FollowedRow(block.part, BOWL, block.aspects, ways, None, rows, up, seed=1)
    counted = row.count(FillLevel.LOW, seen)
    assert (row.wanted_parts(seen), counted.right, counted.left) == (right, right, int(seen.whole.sum()))


def test_single_parts_and_draws_count_the_aspect_alike_and_round_ones_at_any_heading(block):
    part, ways, names = block.part, block.ways, block.names
    shares = np.full(len(ways.lying), 1.0 / len(ways.lying))
    bowl, rows = bowls.default(), (names["A@0"], names["A@90"])
    own = {"rows": rows, "count": 1, "run": RunSettings(1), "aspects": block.aspects}
    alone = short_trials.try_parts(part, bowl, ways, shares, rows[0], **own)
    free = short_trials.try_parts(part, bowl, ways, shares, rows[0], any_heading=("A",), **own)
    assert (list(alone.wrong), list(free.wrong)) == ([0, 1], [0, 0]) and free.purity == 1.0
    only = np.zeros(len(shares))
    only[rows[1]] = 1.0
    drawn = {"draws": 1, "tolerance": 1e-5, "run": RunSettings(1)}
    for up, held in (((), 0), (("A",), 1)):
        run = short_trials.robust_run(part, bowl, ways, only, rows[0], any_heading=up, **drawn)
        assert run.held == held
    disc = shapes.part(shapes.cylinder(10, 4, 48))
    ways = proposals.follow_orientations(disc, find(disc), bowls.default())
    flat = next(k for k, one in enumerate(ways.lying) if one.kind == "flat")
    own = (ways.lying[flat].aspect,)
    assert aspects_at_any_heading(ways.lying, flat, ()) == own
    assert aspects_at_any_heading(ways.lying, flat, (), heading_given=True) == ()
    request = DesignRequest(1.0, up=(own[0].lower(),), heading=None)
    assert proposals.find_equivalents(ways.lying, flat, request)[1] == own
