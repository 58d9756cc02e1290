"""The figures of a design from what was counted, against closed forms."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
import shapes
from design_counts import design_study, queue
from scipy.stats import binom

from feederscrew import bowl as bowls
from feederscrew.designing import acceptance_sheet, calm_drive, loop, queues
from feederscrew.designing.proposals import Proposal
from feederscrew.designing.record import (
    DesignRequest,
    DesignStudy,
    RobustRun,
)
from feederscrew.errors import FeederError
from feederscrew.output import design_pages, designs
from feederscrew.output import tables as tables_of

PART = shapes.part(shapes.box(10, 10, 10))


def study(*queues, **more):
    return design_study(PART, *queues, **more)


def test_the_rate_counts_what_is_wanted_and_its_interval_is_that_of_the_share():
    found = queue(40, 45)
    assert 60.0 * found.rate == pytest.approx(40.0)
    low, high = (end / found.rate * 40.0 / 50.0 for end in found.ends)
    for end, tail in ((low, 1.0 - binom.cdf(39, 50, low)), (high, binom.cdf(40, 50, high))):
        assert 0.01 < tail < 0.05, end  # a two-sided interval of 95 %, as near as Wilson's is


@pytest.mark.parametrize(
    ("counts", "held", "why"),
    [
        ({}, 20, ""),
        ({"jams": 1}, 20, "1 jam in 60 s of queue"),
        ({"right": 40, "left": 45}, 20, "purity 88.9 %, 98 % are asked for"),
        ({}, 18, "18 of 20 draws of part, friction and drive sort: A@0 is lost"),
        ({"right": 30, "returned": 20}, 20, "of the 40/min asked for"),
    ],
)
def test_it_holds_only_where_nothing_is_missing(counts, held, why):
    some = study(queue(**counts), held=held)
    assert (some.status, some.why == "") == (("falls short", False) if why else ("holds", True))
    assert why in some.why


def test_of_what_was_no_queue_or_no_part_nothing_is_said_or_verified(tmp_path):
    """A rate of 0 and a purity of nothing would tell of a queue; a share of nothing is no number."""
    without_queue = study(held=3, queues=())
    assert without_queue.status != "holds" and len(without_queue.shortfalls) == 1
    assert without_queue.shortfalls[0].startswith("3 of 20 draws")
    (tmp_path / "design.yaml").write_text(designs.bowl_file(study(queues=(), partial=True), ()))
    assert bowls.verified(tmp_path / "design.yaml") is None
    assert "Nothing is verified" in (tmp_path / "design.yaml").read_text()
    text = designs.bowl_file(study(queue(0, returned=50)), ())
    assert "\nverified:" not in text and "nan" not in text


def test_a_queue_that_was_stopped_is_no_verdict_in_any_output(tmp_path):
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


def fills(right, left, returned, jams=0):
    """Queues at each fill; at low fill a quarter fewer parts come than at the others."""
    return tuple(
        queue(right, left, returned, jams, name, gaps, seconds=60.0 * more, delivered=left / more)
        for (name, gaps), more in zip(queues.FILLS, (4.0 / 3.0, 1.0, 1.0), strict=True)
    )


def test_the_rate_is_that_of_the_lowest_fill_with_the_share_of_all_of_them():
    low, normal, high = fills(45, 45, 180)
    some = study(low, replace(normal, right=60, left=60, returned=165, delivered=60.0), high)
    assert some.slowest is low
    share = (45 + 60 + 45) / (3 * 225)
    assert 60.0 * some.delivered[0] == pytest.approx(0.75 * 225 * share)
    assert 60.0 * some.delivered[1] == pytest.approx(0.75 * 225 * 0.1923, rel=1e-3)  # Wilson, 150 of 675
    assert replace(some, slowed=0.7).worst == pytest.approx(0.7 * some.delivered[0])
    low, normal, high = fills(60, 60, 180)  # a fill that surely brings too little
    some = study(low, normal, replace(high, right=15, left=15, delivered=15.0))
    assert 60.0 * some.delivered[1] > 28.0 and some.status == "falls short"
    assert "at high fill 15/min are delivered (at most" in some.why


@pytest.mark.parametrize(
    ("counts", "jams", "minutes"),
    [
        ((55, 55, 182), 0, 1),  # 41.3 a minute at low fill, at least 35.4, of which 36 are needed
        ((80, 80, 182), 0, 0),  # holds as it is
        ((49, 49, 182), 0, 0),  # what is so near to it is not told apart in six minutes
        ((55, 55, 182), 1, 0),
        ((79, 81, 182), 0, queues.MORE_TIMES),  # 97.5 % pure, at most 99.3
        ((78, 81, 182), 0, 0),  # 9 of 243 are wrong, and 9 of all 426 may be: 2 of 100 such runs hold
        ((72, 81, 182), 0, 0),
    ],
)
def test_a_queue_is_followed_for_longer_only_where_that_decides(counts, jams, minutes):
    assert queues.minutes(study(*fills(*counts, jams))) == minutes


@pytest.mark.parametrize(
    "right, left, followed",
    [
        ((45, 45, 45), 45, 3),
        ((44, 44, 44), 45, 3),  # 3 of 135, of which 2.7 may: at the end
        ((43, 43, 45), 45, 2),  # 4 of 90 and of the 135 to come
        ((42, 45, 45), 45, 1),
        ((20, 45, 45), 20, 1),  # 20 a minute, of 36
    ],
)
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
        def followed(self, fill, gaps, seed):
            seeds.append((fill, gaps, seed))
            return queue(41, 41, 180, 0, fill, gaps, counted=58.0, climbs=1)

    row = Known(PART, None, None, None, None, (0,), seed=7, least=10.0)
    found = queues.longer(row, study(*fills(79, 81, 182)))
    assert seeds == [("low", queues.FILLS[0][1], seed) for seed in (8, 9, 10)]
    low, normal, high = found
    assert (low.seconds, normal.seconds, high.seconds) == (80.0 + 180.0, 60.0, 60.0)
    assert (low.counted, low.delivered, low.climbs) == (60.0 + 3 * 58.0, 60.75 + 123.0, 3)
    assert (low.right, low.left, low.returned) == (79 + 123, 81 + 123, 722)


def test_no_jam_is_at_most_three_in_the_time_it_was_looked_for():
    assert study().jams_per_hour_high == pytest.approx(3.0 / 60.0 * 3600.0)
    none = DesignStudy(PART, DesignRequest(1.0), None, None, None)
    assert none.status == "none" and none.why and np.isinf(none.jams_per_hour_high)


@pytest.fixture
def prove(monkeypatch):
    """Prove a candidate whose studies are known by their bowls; the studies, and what was tried meanwhile."""

    def call(first, second, results):
        tried, proofs = [], []
        search = SimpleNamespace(least=0.0, kept_keys=frozenset(), request=DesignRequest(1.0), spent=False)

        def attempted(search, made, proposal, weights, driven=None):
            tried.append((proposal, driven, search.least))
            return second

        monkeypatch.setattr(loop, "proved", lambda search, candidate, whole: results[candidate.bowl])
        monkeypatch.setattr(loop.exploring, "attempted", attempted)
        monkeypatch.setattr(loop.exploring, "_screened", lambda search, candidate: candidate)
        loop._prove(search, first, proofs)
        assert search.least == 0.0
        return [one for one, _ in proofs], tried

    return call


def candidates_of(bowl, other):
    """A candidate at a drive, and one that is clean at another drive."""
    clean, ways = SimpleNamespace(clean=True, faults=()), SimpleNamespace(lying=())
    chain = SimpleNamespace(cuts=(), devices=(), name="rails")
    first = SimpleNamespace(
        bowl=bowl, proposal=chain, weights=None, tried=None, orientations=ways, attempt=clean,
        plain_bowl=lambda search: None,
    )  # fmt: skip
    return first, SimpleNamespace(**vars(first) | {"bowl": replace(bowl, drive=other)})


BOWL = bowls.default()


@pytest.mark.parametrize(("speeds", "proved"), [(1.3, 2), (1.0, 1)])
def test_what_draws_lose_at_a_device_is_tried_again_at_a_faster_drive(monkeypatch, prove, speeds, proved):
    """A fifth of the draws stop what is wanted: its chain is driven 1.3 times as fast, and proved again.

    Where the drive that is asked for is the same one, nothing is tried.
    """
    asked, other = [], replace(BOWL, drive=replace(BOWL.drive, amplitude=speeds * BOWL.drive.amplitude))
    lost = study(robust=RobustRun(20, 16, "A@0 is lost (stopped at rails) in 4 of 20"))
    monkeypatch.setattr(loop.proposals, "better", lambda *chain: None)

    def driven_for(search, made, proposal, weights):
        asked.append(search.least)
        return other

    monkeypatch.setattr(loop.exploring, "driven_for", driven_for)
    studies, tried = prove(*candidates_of(BOWL, other.drive), {other: study(held=19), BOWL: lost})
    assert asked == [pytest.approx(loop.FASTER * calm_drive.speed(BOWL))]
    assert len(studies) == proved == len(tried) + 1


def test_what_draws_carry_through_is_tried_with_another_value(monkeypatch, prove):
    first, second = candidates_of(BOWL, replace(BOWL.drive, frequency=2.0 * BOWL.drive.frequency))
    carried = study(robust=RobustRun(20, 16, "B@0 is carried through in 4 of 20"))
    monkeypatch.setattr(loop.proposals, "better", lambda *chain: "a narrower track")
    studies, tried = prove(first, second, {BOWL: carried, second.bowl: study()})
    assert len(studies) == 2 and tried == [("a narrower track", BOWL, 0.0)]


def test_what_jams_in_a_queue_is_tried_livelier_and_then_with_a_pressure_break(monkeypatch, prove):
    """Parts that hop 0.2 mm jam for another reason: there the parts that back up are taken off."""
    calm = replace(BOWL, drive=replace(BOWL.drive, amplitude=0.1 * BOWL.drive.amplitude))
    first, second = candidates_of(calm, replace(BOWL.drive, frequency=50.0, amplitude=7e-4))
    jammed = study(queue(jams=1))
    monkeypatch.setattr(loop.calm_drive, "livelier", lambda made, own: second.bowl)
    monkeypatch.setattr(loop, "replace", lambda one, **more: one)  # proposals and bowls are stand-ins
    monkeypatch.setattr(loop.exploring, "replace", lambda one, **more: one)
    monkeypatch.setattr(loop.proposals, "relieved", lambda candidate: "with a pressure break")
    studies, tried = prove(first, second, {calm: jammed, second.bowl: jammed})
    assert [one.jams for one in studies] == [1, 1, 1] and [one[1] for one in tried] == [second.bowl] * 3
    assert [one[0] for one in tried[1:]] == ["with a pressure break"] * 2
    studies, tried = prove(first, second, {calm: jammed, second.bowl: study()})
    assert [one.jams for one in studies] == [1, 0] and len(tried) == 1


@pytest.mark.parametrize(("fault", "count"), [("B stays (stopped at wiper)", 1), ("B is carried through", 0)])
def test_what_stays_at_a_blade_is_tried_at_a_livelier_drive(monkeypatch, fault, count):
    drives = []
    wiper = SimpleNamespace(device=SimpleNamespace(overhead=True, hangs=False, name="wiper"))
    proposal = Proposal(0, (wiper,), (), "proposed")
    first = SimpleNamespace(
        bowl="calm", proposal=proposal, weights=None, attempt=SimpleNamespace(faults=(fault,)),
        plain_bowl=lambda search: None,
    )  # fmt: skip
    clean = SimpleNamespace(attempt=SimpleNamespace(clean=True, rate=2.0))
    search = SimpleNamespace(spent=False, passed=[], request=DesignRequest(1.0))
    monkeypatch.setattr(loop.exploring, "_screened", lambda search, candidate: candidate)
    monkeypatch.setattr(loop.exploring, "attempted", lambda *given: drives.append(given[-1]) or clean)
    monkeypatch.setattr(loop.calm_drive, "livelier", lambda made, own: bowls.default())
    assert loop.exploring._livened(search, first) is (clean if count else None)
    assert len(drives) == len(search.passed) == count


HEAD = ",".join(acceptance_sheet.SHEET_COLUMNS) + "\n"
LINE = "\x1b[31mjams,low,0,0,1,1,2,100\n"


@pytest.mark.parametrize(
    ("content", "fault"),
    [
        *(
            (f"{HEAD}jams,low,0,0,1,1,{measured},100\n".encode(), r"sheet\.csv:2")
            for measured in ("nan", "inf", "1_0", "\u0663", "many", "1e999")
        ),
        ((HEAD + 20_000 * LINE).encode(), "kB"),
        (b"\xff\xfe" + HEAD.encode(), "UTF-8"),
    ],
)
def test_a_sheet_holds_plain_numbers_and_is_read_within_bounds(tmp_path, content, fault):
    path = tmp_path / "sheet.csv"
    path.write_text(HEAD + LINE)
    (found,) = acceptance_sheet.sheet(path)
    assert acceptance_sheet.is_sheet(path) and found.quantity.isprintable() and found.measured == 2.0
    path.write_bytes(content)
    with pytest.raises(FeederError, match=fault):
        acceptance_sheet.sheet(path)
