"""Figures of a design from what its queues counted; queues end as soon as they surely hold, and no sooner."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
import shapes
from design_counts import carried, design_study, lost, queue, stays, stopped_at
from scipy.stats import binom

from feederscrew import bowl as bowls
from feederscrew.designing import calm_drive, loop, proposals, queues, short_trials
from feederscrew.designing.findings import Move, MoveKind
from feederscrew.designing.policy import USUAL_POLICY
from feederscrew.designing.proposals import Proposal
from feederscrew.designing.record import DesignRequest, DesignStudy, RobustRun, share_interval
from feederscrew.designing.search import Search
from feederscrew.output import design_pages, designs
from feederscrew.output import tables as tables_of
from feederscrew.rates import stream
from feederscrew.resting.aspects import find
from feederscrew.running import RunSettings
from feederscrew.tooling.devices.kinds import make_device
from feederscrew.trial.queue import PARTS_IN_SHARES as BLOCK
from feederscrew.trial.queue import QueuedParts

PART = shapes.part(shapes.box(10, 10, 10))
BOWL = bowls.default()
TARGET = 0.5  # [1/s] asked for
LEAST = 0.9 * TARGET
IMPURE = (0.96, 0.088, 0.196), (0.97, 0.21, 0.459), (0.98, 0.48, 0.78), (0.99, 0.834, 0.989)


def study(*queues, **more):
    return design_study(PART, *queues, **more)


def test_the_rate_counts_what_is_wanted_of_the_lowest_fill_with_the_share_of_all():
    found = queue(40, 45)
    assert 60.0 * found.rate == pytest.approx(40.0)
    low, high = (end / found.rate * 40.0 / 50.0 for end in found.ends)
    for end, tail in ((low, 1.0 - binom.cdf(39, 50, low)), (high, binom.cdf(40, 50, high))):
        assert 0.01 < tail < 0.05, end  # a two-sided interval of 95 %, as near as Wilson's is
    assert study().jams_per_hour_high == pytest.approx(-np.log(0.05) / 60.0 * 3600.0)
    none = DesignStudy(PART, DesignRequest(1.0), None, None, None)
    assert none.status == "none" and none.why and np.isinf(none.jams_per_hour_high)
    low, normal, high = uneven_fills(45, 45, 180)
    some = study(low, replace(normal, right=60, left=60, returned=165, delivered=60.0), high)
    assert some.slowest is low
    share = (45 + 60 + 45) / (3 * 225)
    assert 60.0 * some.delivered[0] == pytest.approx(0.75 * 225 * share)
    assert 60.0 * some.delivered[1] == pytest.approx(0.75 * 225 * 0.1923, rel=1e-3)  # Wilson, 150 of 675
    assert replace(some, slowed=0.7).worst == pytest.approx(0.7 * some.delivered[0])
    low, normal, high = uneven_fills(60, 60, 180)  # a fill that surely brings too little
    some = study(low, normal, replace(high, right=15, left=15, delivered=15.0))
    assert 60.0 * some.delivered[1] > 28.0 and some.status == "falls short"
    assert "at high fill 15/min are delivered (at most" in some.why


@pytest.mark.parametrize(("counts", "held", "why"), [
    ({}, 20, ""),
    ({"jams": 1}, 20, "1 jam in 60 s of queue"),
    ({"right": 40, "left": 45}, 20, "purity 88.9 %, 98 % are asked for"),
    ({}, 18, "18 of 20 draws of part, friction and drive sort: A@0 is lost"),
    ({"right": 30, "returned": 20}, 20, "of the 40/min asked for"),
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


def uneven_fills(right, left, returned, jams=0):
    return tuple(
        queue(right, left, returned, jams, name, gaps, seconds=60.0 * more, delivered=left / more)
        for (name, gaps), more in zip(queues.FILLS, (4.0 / 3.0, 1.0, 1.0), strict=True)
    )


@pytest.mark.parametrize(("counts", "jams", "minutes"), [
    ((55, 55, 182), 0, 1),  # 41.3 a minute at low fill, at least 35.4, of which 36 are needed
    ((80, 80, 182), 0, 0),  # holds as it is
    ((49, 49, 182), 0, 0),  # what is so near to it is not told apart in six minutes
    ((55, 55, 182), 1, 0),
    ((79, 81, 182), 0, queues.MORE_TIMES),  # 97.5 % pure, at most 99.3
    ((78, 81, 182), 0, 0),  # 9 of 243 are wrong, and 9 of all 426 may be: 2 of 100 such runs hold
])  # fmt: skip
def test_a_queue_is_followed_for_longer_only_where_that_decides(counts, jams, minutes):
    assert queues.minutes(study(*uneven_fills(*counts, jams))) == minutes


@pytest.mark.parametrize("right, left, followed", [
    ((45, 45, 45), 45, 3),
    ((44, 44, 44), 45, 3),  # 3 of 135, of which 2.7 may: at the end
    ((43, 43, 45), 45, 2),  # 4 of 90 and of the 135 to come
    ((42, 45, 45), 45, 1),
    ((20, 45, 45), 20, 1),  # 20 a minute, of 36
])  # fmt: skip
def test_what_surely_does_not_hold_is_followed_no_further(right, left, followed):
    least, seen = 36.0 / 60.0, []
    for count, (fill, gaps) in zip(right, queues.FILLS):
        one = queue(count, left, 180, 0, fill, gaps)
        nothing, jammed = replace(one, right=0, left=0, seconds=10.0, counted=0.0), replace(one, jams=1)
        assert not queues.is_denied((*seen, nothing), nothing, least)
        assert queues.is_denied((*seen, jammed), jammed, least)
        seen.append(one)
        if queues.is_denied(tuple(seen), one, least):
            break
    assert len(seen) == followed


@pytest.mark.parametrize(("left", "allowed"), [(14, 2), (45, 8)])  # after 19 s: 132 and 426 in three minutes
def test_of_a_short_time_as_many_may_be_wrong_as_the_whole_minutes_may_have(left, allowed):
    for wrong in (allowed, allowed + 1):
        one = queue(left - wrong, left, 10, 0, "low", 0.5, seconds=19.0, counted=20.0)
        assert queues.is_denied((one,), one, 0.1) is (wrong > allowed)


def test_what_is_followed_for_longer_is_one_queue_of_other_seeds():
    seeds = []

    class Known(queues.FollowedRow):
        def follow_fill(self, fill, gaps, seed):
            seeds.append((fill, gaps, seed))
            return queue(41, 41, 180, 0, fill, gaps, counted=58.0, climbs=1)

    row = Known(PART, None, None, None, None, (0,), seed=7, least=10.0)
    found = queues.follow_longer(row, study(*uneven_fills(79, 81, 182)))
    assert seeds == [("low", queues.FILLS[0][1], seed) for seed in (8, 9, 10)]
    low, normal, high = found
    assert (low.seconds, normal.seconds, high.seconds) == (80.0 + 180.0, 60.0, 60.0)
    assert (low.counted, low.delivered, low.climbs) == (60.0 + 3 * 58.0, 60.75 + 123.0, 3)
    assert (low.right, low.left, low.returned) == (79 + 123, 81 + 123, 722)


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
    chain = SimpleNamespace(cuts=(), devices=(), name="rails")
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
    assert [one.jams for one in studies] == [1, 1, 1] and [one[1] for one in tried] == [second.bowl] * 3
    assert [one[0] for one in tried[1:]] == ["with a pressure break"] * 2
    studies, tried = prove(first, second, {calm: jammed, second.bowl: study()})
    assert [one.jams for one in studies] == [1, 0] and len(tried) == 1


@pytest.mark.parametrize(("fault", "count"), [(stays("B", stopped_at("wiper")), 1), (carried("B"), 0)])
def test_what_stays_at_a_blade_is_tried_at_a_livelier_drive(monkeypatch, fault, count):
    drives = []
    wiper = SimpleNamespace(device=SimpleNamespace(overhead=True, hangs=False, kind="wiper"))
    proposal = Proposal(0, (wiper,), (), Move(MoveKind.PROPOSED))
    first = SimpleNamespace(
        bowl="calm", proposal=proposal, weights=None, attempt=SimpleNamespace(faults=(fault,)),
        plain_bowl=lambda search: None,
    )  # fmt: skip
    clean = SimpleNamespace(attempt=SimpleNamespace(clean=True, rate=2.0))
    search = Search.begin(None, DesignRequest(1.0), BOWL)
    monkeypatch.setattr(loop.exploring, "_screen", lambda search, candidate: candidate)
    monkeypatch.setattr(loop.exploring, "try_proposal", lambda *given: drives.append(given[-1]) or clean)
    monkeypatch.setattr(loop.calm_drive, "find_livelier", lambda made, own: bowls.default())
    assert loop.exploring._find_livelier(search, first) is (clean if count else None)
    assert len(drives) == len(search.state.clean) == count


def fills(right, wrong=0, seconds=30.0, returned=0, jams=0, **more):
    """Three fills of so many seconds, with what left all of them in equal parts as near as may be."""
    made = []
    for k, (fill, gaps) in enumerate(queues.FILLS):
        one, off, back = (total // 3 + (k < total % 3) for total in (right, wrong, returned))
        times = {"seconds": seconds, "counted": 0.9 * seconds} | more
        made.append(queue(one, one + off, back, jams * (k == 2), fill, gaps, **times))
    return tuple(made)


def is_settled(some, least):
    return queues.is_settled(some, least, 105)


@pytest.mark.parametrize(("rule", "right", "wrong", "seconds", "least", "answer"), [
    # of the parts that are planned 2 % may be wrong; chance that more are of those to come, at 2 % wrong
    (queues.is_sure, 96, 0, 40.0, LEAST, True),  # more than 2 of 48: 0.071
    (queues.is_sure, 95, 1, 40.0, LEAST, False),  # more than 1 of 48: 0.249
    # 150 are planned, whatever the minutes would bring; more than 3 of 50: 0.018
    (queues.is_sure, 100, 0, 20.0, LEAST, True),
    (queues.is_sure, 99, 1, 20.0, LEAST, True),  # more than 2 of 50: 0.078
    (queues.is_sure, 98, 2, 20.0, LEAST, False),  # more than 1 of 50: 0.264
    (queues.is_sure, 148, 3, 30.0, LEAST, True),  # none to come
    (queues.is_sure, 147, 4, 30.0, LEAST, False),
    (queues.is_sure, 0, 0, 50.0, LEAST, False),
    (queues.has_enough, 149, 0, 59.0, LEAST, False),
    (queues.has_enough, 147, 3, 20.0, LEAST, True),
    (queues.has_enough, 146, 4, 20.0, LEAST, False),
    (queues.has_enough, 150, 0, 14.0, LEAST, False),  # each fill for 15 s at least
    (queues.has_enough, 179, 0, 20.0, 0.9, False),
    (queues.has_enough, 180, 0, 20.0, 0.9, True),  # at 60 a minute the 180 of three minutes
    # of 150 and 105 to come 5 may be wrong
    (is_settled, 145, 5, 50.0, LEAST, False),  # no other of the 105 to come: 0.120
    (is_settled, 144, 6, 50.0, LEAST, True),
    (is_settled, 147, 3, 50.0, LEAST, False),
    (is_settled, 150, 0, 50.0, LEAST, True),
    (is_settled, 150, 0, 50.0, 10.0, False),  # too slow by what has left so far
])  # fmt: skip
def test_the_parts_still_to_come_do_not_turn_the_verdict(rule, right, wrong, seconds, least, answer):
    """Sure, or of enough pure parts, is a queue of all fills without a jam."""
    assert rule(fills(right, wrong, seconds), least) is answer
    if rule is not is_settled:
        assert not rule(fills(right, wrong, seconds, jams=1), least)
        assert not rule(fills(right, wrong, seconds)[:2], least)


def test_three_minutes_have_left_before_it_is_sure_and_the_lower_end_is_what_is_asked_for():
    """So jams a part are as well known as of a bowl that brings no more than that."""
    rates = [target for target in (1.0, 1.2, 1.24, 1.26) if queues.is_sure(fills(225, 0, 45.0), 0.9 * target)]
    assert rates == [1.0, 1.2, 1.24]  # 225 parts in 180 s: 1.25 a second
    # a third of what is offered comes back: 240 of 360 leave, in 40.5 s counted of each fill
    (one, *_), slow = (fills(240, 0, 45.0, returned=120, counted=counted) for counted in (40.5, 80.0))
    pace = 80.0 / 40.5 * 120.0 / 80.0
    assert one.pace == pytest.approx(pace)
    # Wilson's lower end of 240 of 360 is 0.6168: what is asked for decides by the number of parts
    assert pace * 0.6168 > 240.0 / 180.0 and slow[0].pace * 0.6168 == pytest.approx(0.9252, rel=1e-3)
    assert queues.is_sure(slow, 0.9 * 0.92) and not queues.is_sure(slow, 0.9 * 0.93)


def chances(purity, rate, draws, seed):
    """Shares of runs that end early, hold at the end, do the one and not the other."""
    rng, counts = np.random.default_rng(seed), np.zeros(3)
    looks = queues.rounds()
    count, begun = round(3.0 * rate * queues.LOOK_EVERY_S), round(looks[0] / queues.LOOK_EVERY_S)
    for _ in range(draws):  # parts that leave all three fills between two looks
        wrong = rng.random((begun - 1 + len(looks), count)) > purity
        at_end = wrong.sum() <= (1.0 - queues.PURE) * wrong.size + 1e-9
        off = [(k, int(wrong[:k].sum())) for k in range(begun, len(wrong))]
        sure = [queues.is_sure(fills(count * k - n, n, s), LEAST) for (k, n), s in zip(off, looks)]
        counts += any(sure), at_end, any(sure) and not at_end
    return counts / draws


@pytest.mark.parametrize("purity", [0.96, 0.98, 0.995])
@pytest.mark.parametrize("rate", [0.7, 0.8])
def test_it_errs_seldom_at_any_purity(purity, rate):
    """Few runs end early that the whole minutes would deny, 0.03 of them at the most; docs/design.md."""
    early, held, other = chances(purity, rate, 400, 5)
    assert other <= 0.03 and early <= held + other
    assert purity < queues.PURE or early > 0.2


def holding(purity, rate, runs):
    """Share of runs that hold, of a row of which so many parts a second leave each fill."""
    rng, held = np.random.default_rng(2), 0
    for _ in range(runs):
        wrong = left = 0
        for seconds in queues.rounds():
            more = round(3.0 * rate * seconds) - left
            wrong, left = wrong + rng.binomial(more, 1.0 - purity), left + more
            some = fills(left - wrong, wrong, seconds)
            sure = queues.has_enough(some, LEAST) or queues.is_sure(some, LEAST)
            if sure or (seconds == queues.FILL_SECONDS and wrong <= (1.0 - queues.PURE) * left):
                held += 1
                break
            if queues.is_denied(some, some[-1], 0.0):
                break
    return held / runs


@pytest.mark.parametrize("purity, share, faster", IMPURE)
def test_what_is_impure_holds_seldom_however_often_it_is_looked_at(purity, share, faster):
    """At 48 and 100 parts a minute of each fill, looks included: docs/design.md."""
    assert holding(purity, 48.0 / 60.0, 250) == pytest.approx(share, abs=0.07)
    assert holding(purity, 100.0 / 60.0, 250) == pytest.approx(faster, abs=0.07)


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
    assert share_interval([one], 2.0) == pytest.approx(both, abs=1e-12)


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
        self.time = seconds
        tell(self.periods, 0)

    def result(self, partial=False):
        return SimpleNamespace(queue=self, partial=partial)


class FakeRow(queues.FollowedRow):
    def queue(self, gaps, seed):
        return self.part[gaps]

    def count(self, fill, gaps, seen):
        one = seen.queue
        more = {"seconds": one.time, "counted": 0.95 * one.time, "partial": seen.partial, "fill": fill}
        return queue(int(one.rate * one.time), returned=0, jams=int(one.time >= one.jams_at), **more)


def followed(*fakes, whole=False, **more):
    """The fills of three queues, each a rate or what a fake is made of: name, seconds, whether it stopped."""
    fakes = [FakeQueue(*(one if isinstance(one, tuple) else (one,))) for one in fakes]
    by_gap = dict(zip((gaps for _, gaps in queues.FILLS), fakes))
    bowl = SimpleNamespace(drive=SimpleNamespace(frequency=50.0))
    row = replace(FakeRow(by_gap, bowl, None, None, None, (0,), 1, least=LEAST), **more)
    made = queues.follow_fills(row, whole=whole)
    return [(one.fill, one.seconds, one.partial) for one in made], made


def test_fast_clean_fills_end_after_fifteen_seconds_each_and_a_late_jam_denies_what_went_on():
    """360 parts in 45 s of queue; the statement stands on no less than that."""
    said, bars = [], []
    fills, made = followed(8.0, 8.0, 8.0, tell=said.append, progress=lambda *bar: bars.append(bar))
    assert fills == [(fill, 15.0, False) for fill, _ in queues.FILLS] and queues.is_complete(made)
    assert [text.split(" at ")[1] for text in said] == [f"{fill} fill, to 15 s" for fill, _ in queues.FILLS]
    assert bars == [(250 * k, 9000) for k in range(1, 10)]
    fills, made = followed(1.2, 1.2, (1.2, 25.0))
    assert [one for _, one, _ in fills] == [25.0] * 3 and made[-1].jams == 1
    assert not queues.is_complete(made)
    with pytest.raises(KeyboardInterrupt):
        followed(*[(2.0, np.inf, 0.0)] * 3)
    # slower ones go on in turn: to 90 of 150 parts, and more than 3 of 60 to come, 0.03; to the three minutes
    # of what is asked for, 90 parts; to the end; of whole ones to 162 parts, where after 40 s there were 144
    slower = (1.2, False, 25.0), (0.55, False, 55.0), (0.52, False, 60.0), (1.2, True, 45.0)
    for rate, whole, seconds in slower:
        assert [one for _, one, _ in followed(*[rate] * 3, whole=whole)[0]] == [seconds] * 3


@pytest.mark.parametrize(("fakes", "fills"), [
    ((2.0, (2.0, 9.0), 2.0), [("low", 15.0, False), ("normal", 10.0, False)]),  # a jam where it is seen
    # surely too slow, which is said after 20 s
    ((0.3, 2.0, 2.0), [("low", 20.0, False), ("normal", 15.0, False), ("high", 15.0, False)]),
    # stopped by the user
    ((2.0, (2.0, np.inf, 13.0), 2.0), [("low", 15.0, False), ("normal", 13.0, True)]),
    ((2.0, (2.0, np.inf, 0.0), 2.0), [("low", 15.0, True)]),
])  # fmt: skip
def test_what_denies_it_or_is_stopped_ends_it_where_it_is_seen(fakes, fills):
    assert followed(*fakes)[0] == fills


def test_touching_parts_come_as_they_entered_the_track(monkeypatch):
    offered = {}  # apart they come in the shares behind the ride
    monkeypatch.setattr(queues, "PartsQueue", lambda *own: offered.update({own[5].gaps: own[3][1]}))
    monkeypatch.setattr(queues.short_trials, "find_poses", lambda *_: ())
    known, arriving, entering = SimpleNamespace(lying=()), np.array([0.9, 0.1]), np.array([0.5, 0.5])
    made = queues.FollowedRow(None, None, None, known, arriving, (0,), 1, touching=entering)
    for _, gaps in queues.FILLS:
        made.queue(gaps, 1)
    kinds = [offered[gaps] is entering for _, gaps in queues.FILLS]
    assert kinds == [offered[gaps] is not arriving for _, gaps in queues.FILLS] == [False, False, True]


@pytest.mark.parametrize("rates", [(8.0, 8.0, 8.0), (1.2, 1.2, 1.2), (0.3, 2.0, 2.0)])
@pytest.mark.parametrize("ends", [(np.inf,), (9.0,), (25.0,), (np.inf, 13.0)])
def test_fills_side_by_side_end_as_in_turn(rates, ends):
    fakes = rates[0], (rates[1], *ends), rates[2]
    assert followed(*fakes, jobs=2)[0] == followed(*fakes, jobs=1)[0]


def test_parts_of_a_row_come_in_exact_shares_in_random_order_and_are_counted_by_how_they_came(block):
    ways, shares = block.ways, np.zeros(len(block.ways.lying))
    shares[:3] = 0.5, 0.3, 0.2
    wanted = (int(ways.leaves_as[0]),)
    made = queues.FollowedRow(block.part, bowls.default(), block.aspects, ways, shares, wanted, 1)
    one = made.queue(0.5, 1)
    drawn, entered, coming = one.drawn_rows[::-1], one.entry_rows, one.next_part
    entered = [*entered[: BLOCK - len(drawn) - 1], coming[0]] if coming else entered
    rows = [*entered[: BLOCK - len(drawn)], *drawn]
    assert np.bincount(rows, minlength=3)[:3] / BLOCK == pytest.approx(shares[:3], abs=1.0 / BLOCK)
    assert rows != sorted(rows)
    one.follow(2.5)
    seen = one.result()
    assert seen.left_by_entry.sum(axis=0).tolist() == seen.whole.tolist()
    assert seen.returned_by_entry.sum() == seen.returned
    counted = made.count("low", 0.5, seen)
    assert sum(n for n, _ in counted.counts_by_entry) == counted.offered > 0
    assert sum(k for _, k in counted.counts_by_entry) == counted.right
    assert counted.parts == 8 and made.queue(0.0, 1).plan.parts == 12


def test_what_comes_behind_its_ride_enters_two_pitches_before_a_sensor(block):
    """Parts that touch enter the track a whole row before it; without a sensor all do."""
    ways, wanted = block.ways, block.ways.lying[0]
    sorter = make_device("sorter", "test", like=(wanted.aspect, wanted.heading, 1e-3), text="test")
    longest, shares = float(ways.lengths.max()), np.full(len(ways.lying), 1.0)

    def before(devices, gaps):
        driven = replace(bowls.default(), devices=devices)
        row = queues.FollowedRow(block.part, driven, block.aspects, ways, shares, (0,), 1)
        return -row.queue(gaps, 1).track.start, stream.needed_spacing(devices, ways.lying, driven)

    for gaps in (0.5, 0.2):
        way, room = before((sorter,), gaps)
        assert room > 0.0 and way == pytest.approx(2.0 * (room + (1.0 + 2.0 * gaps) * longest), rel=1e-12)
        assert before((), gaps)[0] > 1.5 * way
    assert before((sorter,), 0.0)[0] == pytest.approx(before((), 0.0)[0], rel=1e-12)


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
        gap=0.01, touching=0.2, pressure=np.zeros(0), depth=0.0, partial=False,
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
    row = queues.FollowedRow(block.part, None, block.aspects, ways, None, rows, 1, any_heading=up)
    counted = row.count("low", 0.5, seen)
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
    assert short_trials.aspects_at_any_heading(ways.lying, flat, ()) == own
    assert short_trials.aspects_at_any_heading(ways.lying, flat, (), heading_given=True) == ()
    request = DesignRequest(1.0, up=(own[0].lower(),), heading=None)
    assert proposals.find_equivalents(ways.lying, flat, request)[1] == own
