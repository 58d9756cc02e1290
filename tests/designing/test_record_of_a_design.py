"""The figures of a design from what was counted, against closed forms."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
import shapes
from scipy.stats import binom

from feederscrew import bowl as bowls
from feederscrew.designing import acceptance_sheet, calm_drive, loop, queues
from feederscrew.designing.proposals import Proposal
from feederscrew.designing.record import (
    DesignRequest,
    DesignStudy,
    FilledQueue,
    RobustRun,
)
from feederscrew.errors import FeederError
from feederscrew.output import design_pages, designs
from feederscrew.output import tables as tables_of

PART = shapes.part(shapes.box(10, 10, 10))


def study(queue, held=20, **more):
    known = {"robust": RobustRun(20, held, "A@0 is lost"), "queues": (queue,), **more}
    return DesignStudy(PART, DesignRequest(40.0 / 60.0), bowls.default(), "A@0", 0, **known)


def queue(right=45, left=45, returned=5, jams=0):
    return FilledQueue("normal", 0.2, 12, 60.0, 60.0, float(left), right, left, returned, jams, 0)


def test_the_rate_counts_what_is_wanted_and_its_interval_is_that_of_the_share():
    found = queue(right=40, left=45)
    assert 60.0 * found.rate == pytest.approx(40.0)
    low, high = (end / found.rate * 40.0 / 50.0 for end in found.ends)
    for end, tail in ((low, 1.0 - binom.cdf(39, 50, low)), (high, binom.cdf(40, 50, high))):
        assert 0.01 < tail < 0.05, end  # a two-sided interval of 95 %, as near as Wilson's is


def test_it_holds_only_where_nothing_is_missing():
    assert study(queue()).status == "holds" and study(queue()).why == ""
    assert study(queue(jams=1)).status == "falls short"
    assert "1 jam in 60 s of queue" in study(queue(jams=1)).why
    assert "purity 88.9 %, 98 % are asked for" in study(queue(right=40)).why
    assert "18 of 20 draws of part, friction and drive sort: A@0 is lost" in study(queue(), held=18).why
    assert "of the 40/min asked for" in study(queue(right=30, left=30, returned=20)).why


def test_draws_that_fail_before_any_queue_are_what_it_lacks():
    """No queue was followed: a rate of 0 and a purity of nothing would tell of one."""
    without_queue = study(queue(), held=3, queues=())
    assert without_queue.status != "holds" and len(without_queue.shortfalls) == 1
    assert without_queue.shortfalls[0].startswith("3 of 20 draws")


def test_what_no_queue_was_followed_of_verifies_nothing(tmp_path):
    some = replace(study(queue()), queues=(), partial=True)
    (tmp_path / "design.yaml").write_text(designs.bowl_file(some, ()))
    assert bowls.verified(tmp_path / "design.yaml") is None
    assert "Nothing is verified" in (tmp_path / "design.yaml").read_text()


def test_a_queue_that_was_stopped_is_no_verdict_in_any_output(tmp_path):
    """Of 0.4 s of a queue: not 0 a minute, 8,150 jams an hour and a purity of nothing."""
    begun = replace(queue(0, 0, 0), seconds=0.4, counted=0.0, delivered=0.0, partial=True)
    for some in (study(begun, partial=True), study(queue(), partial=True)):
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
    assert designs.document(study(begun, partial=True))["queues"][0]["delivered_per_minute"] is None
    assert "stopped after 0.4 s" in study(begun, partial=True).why


def test_a_design_of_which_no_part_has_left_verifies_nothing():
    """Its purity is a share of nothing, and no number of a block."""
    text = designs.bowl_file(study(queue(0, 0, 50)), ())
    assert "\nverified:" not in text and "nan" not in text


def fills(right, left, returned, jams=0):
    """Queues at each fill; at low fill a quarter fewer parts come than at the others."""
    return tuple(
        FilledQueue(name, gaps, 12, 60.0 * more, 60.0, left / more, right, left, returned, jams, 0)
        for (name, gaps), more in zip(queues.FILLS, (4.0 / 3.0, 1.0, 1.0), strict=True)
    )


def test_the_rate_is_that_of_the_lowest_fill_with_the_share_of_all_of_them():
    low, normal, high = fills(45, 45, 180)
    some = study(
        queue(), queues=(low, replace(normal, right=60, left=60, returned=165, delivered=60.0), high)
    )
    assert some.slowest is low
    share = (45 + 60 + 45) / (3 * 225)
    assert 60.0 * some.delivered[0] == pytest.approx(0.75 * 225 * share)
    assert 60.0 * some.delivered[1] == pytest.approx(0.75 * 225 * 0.1923, rel=1e-3)  # Wilson, 150 of 675
    assert replace(some, slowed=0.7).worst == pytest.approx(0.7 * some.delivered[0])


def test_a_fill_that_surely_brings_too_little_is_told():
    low, normal, high = fills(60, 60, 180)
    some = study(queue(), queues=(low, normal, replace(high, right=15, left=15, delivered=15.0)))
    assert 60.0 * some.delivered[1] > 28.0 and some.status == "falls short"
    assert "at high fill 15/min are delivered (at most" in some.why


def test_a_queue_is_followed_for_longer_only_where_that_decides():
    def asked(*counts, **more):
        return queues.minutes(study(queue(), queues=fills(*counts, **more)))

    assert asked(55, 55, 182) == 1  # 41.3 a minute at low fill, at least 35.4, of which 36 are needed
    assert asked(80, 80, 182) == 0  # holds as it is
    assert asked(49, 49, 182) == 0  # what is so near to it is not told apart in six minutes
    assert asked(55, 55, 182, jams=1) == 0
    assert asked(79, 81, 182) == queues.MORE_TIMES  # 97.5 % pure, at most 99.3
    assert asked(78, 81, 182) == 0  # 9 of 243 are wrong, and 9 of all 426 may be: 2 of 100 such runs hold
    assert asked(72, 81, 182) == 0


@pytest.mark.parametrize(
    "counts, followed",
    [
        ([(45, 45), (45, 45), (45, 45)], ["low", "normal", "high"]),
        ([(44, 45), (44, 45), (44, 45)], ["low", "normal", "high"]),  # 3 of 135, of which 2.7 may: at the end
        ([(43, 45), (43, 45), (45, 45)], ["low", "normal"]),  # 4 of 90 and of the 135 to come
        ([(42, 45), (45, 45), (45, 45)], ["low"]),
        ([(20, 20), (45, 45), (45, 45)], ["low"]),  # 20 a minute, of 36
    ],
)
def test_what_surely_does_not_hold_is_followed_no_further(counts, followed):
    least, seen = 36.0 / 60.0, []
    for (right, left), (fill, gaps) in zip(counts, queues.FILLS):
        one = FilledQueue(fill, gaps, 12, 60.0, 60.0, float(left), right, left, 180, 0, 0)
        nothing = replace(one, right=0, left=0, seconds=10.0, counted=0.0)
        assert not queues.is_denied((*seen, nothing), nothing, least)
        jammed = replace(one, jams=1)
        assert queues.is_denied((*seen, jammed), jammed, least)
        seen.append(one)
        if queues.is_denied(tuple(seen), one, least):
            break
    assert [one.fill for one in seen] == followed


@pytest.mark.parametrize(
    ("left", "allowed"),
    [
        (14, 2),  # after 19 s: 132 in the three minutes
        (45, 8),  # 426
    ],
)
def test_of_a_short_time_as_many_may_be_wrong_as_the_whole_minutes_may_have(left, allowed):
    for wrong in (allowed, allowed + 1):
        one = FilledQueue("low", 0.5, 12, 19.0, 20.0, float(left), left - wrong, left, 10, 0, 0)
        assert queues.is_denied((one,), one, 0.1) is (wrong > allowed)


def test_what_is_followed_for_longer_is_one_queue_of_other_seeds():
    seeds = []

    class Known(queues.FollowedRow):
        def followed(self, fill, gaps, seed):
            seeds.append((fill, gaps, seed))
            return FilledQueue(fill, gaps, 12, 60.0, 58.0, 41.0, 41, 41, 180, 0, 1)

    row = Known(PART, None, None, None, None, (0,), seed=7, least=10.0)
    found = queues.longer(row, study(queue(), queues=fills(79, 81, 182)))
    assert seeds == [("low", queues.FILLS[0][1], seed) for seed in (8, 9, 10)]
    low, normal, high = found
    assert (low.seconds, normal.seconds, high.seconds) == (80.0 + 180.0, 60.0, 60.0)
    assert (low.counted, low.delivered, low.climbs) == (60.0 + 3 * 58.0, 60.75 + 123.0, 3)
    assert (low.right, low.left, low.returned) == (79 + 123, 81 + 123, 722)


def test_no_jam_is_at_most_three_in_the_time_it_was_looked_for():
    assert study(queue()).jams_per_hour_high == pytest.approx(3.0 / 60.0 * 3600.0)
    none = DesignStudy(PART, DesignRequest(1.0), None, None, None)
    assert none.status == "none" and none.why and np.isinf(none.jams_per_hour_high)


def proofs_of(monkeypatch, first, second, results):
    """Prove a candidate whose studies are known by their bowls; the studies, and what was tried meanwhile."""
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


def candidates_of(bowl, other, proposal="rails"):
    """A candidate at a drive, and one that is clean at another drive."""
    clean, ways = SimpleNamespace(clean=True, faults=()), SimpleNamespace(lying=())
    chain = SimpleNamespace(cuts=(), devices=(), name=proposal)
    first = SimpleNamespace(
        bowl=bowl, proposal=chain, weights=None, tried=None, orientations=ways, attempt=clean,
        plain_bowl=lambda search: None,
    )  # fmt: skip
    return first, SimpleNamespace(**vars(first) | {"bowl": replace(bowl, drive=other)})


@pytest.mark.parametrize(("speeds", "proved"), [(1.3, 2), (1.0, 1)])
def test_what_draws_lose_at_a_device_is_tried_again_at_a_faster_drive(monkeypatch, speeds, proved):
    """A fifth of the draws stop what is wanted: its chain is driven 1.3 times as fast, and proved again.

    Where the drive that is asked for is the same one, nothing is tried.
    """
    bowl, asked = bowls.default(), []
    other = replace(bowl, drive=replace(bowl.drive, amplitude=speeds * bowl.drive.amplitude))
    first, second = candidates_of(bowl, other.drive)
    lost = study(queue(), robust=RobustRun(20, 16, "A@0 is lost (stopped at rails) in 4 of 20"))
    results = {other: study(queue(), robust=RobustRun(20, 19, "")), bowl: lost}
    monkeypatch.setattr(loop.proposals, "better", lambda *chain: None)

    def driven_for(search, made, proposal, weights):
        asked.append(search.least)
        return other

    monkeypatch.setattr(loop.exploring, "driven_for", driven_for)
    studies, tried = proofs_of(monkeypatch, first, second, results)
    assert asked == [pytest.approx(loop.FASTER * calm_drive.speed(bowl))]
    assert len(studies) == proved == len(tried) + 1


def test_what_draws_carry_through_is_tried_with_another_value(monkeypatch):
    bowl = bowls.default()
    first, second = candidates_of(bowl, replace(bowl.drive, frequency=2.0 * bowl.drive.frequency))
    carried = study(queue(), robust=RobustRun(20, 16, "B@0 is carried through in 4 of 20"))
    monkeypatch.setattr(loop.proposals, "better", lambda *chain: "a narrower track")
    studies, tried = proofs_of(monkeypatch, first, second, {bowl: carried, second.bowl: study(queue())})
    assert len(studies) == 2 and tried == [("a narrower track", bowl, 0.0)]


def test_what_jams_in_a_queue_is_tried_livelier_and_then_with_a_pressure_break(monkeypatch):
    """Parts that hop 0.2 mm jam for another reason: there the parts that back up are taken off."""
    bowl = bowls.default()
    calm = replace(bowl, drive=replace(bowl.drive, amplitude=0.1 * bowl.drive.amplitude))
    lively = replace(bowl.drive, frequency=50.0, amplitude=7e-4)
    first, second = candidates_of(calm, lively)
    jammed = study(replace(queue(), jams=1))
    monkeypatch.setattr(loop.calm_drive, "livelier", lambda made, own: second.bowl)
    monkeypatch.setattr(loop, "replace", lambda one, **more: one)  # proposals and bowls are stand-ins
    monkeypatch.setattr(loop.exploring, "replace", lambda one, **more: one)
    monkeypatch.setattr(loop.proposals, "relieved", lambda candidate: "with a pressure break")
    studies, tried = proofs_of(monkeypatch, first, second, {calm: jammed, second.bowl: jammed})
    assert [one.jams for one in studies] == [1, 1, 1] and [one[1] for one in tried] == [second.bowl] * 3
    assert [one[0] for one in tried[1:]] == ["with a pressure break"] * 2
    studies, tried = proofs_of(monkeypatch, first, second, {calm: jammed, second.bowl: study(queue())})
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


@pytest.mark.parametrize("measured", ["nan", "inf", "1_0", "\u0663", "many", "1e999"])
def test_a_sheet_holds_plain_numbers(tmp_path, measured):
    path = tmp_path / "sheet.csv"
    head = ",".join(acceptance_sheet.SHEET_COLUMNS)
    path.write_text(f"{head}\njams,low,0,0,1,1,{measured},100\n")
    assert acceptance_sheet.is_sheet(path)
    with pytest.raises(FeederError, match=r"sheet\.csv:2"):
        acceptance_sheet.sheet(path)


def test_a_sheet_is_read_within_bounds(tmp_path):
    path = tmp_path / "sheet.csv"
    line = "\x1b[31mjams,low,0,0,1,1,2,100\n"
    path.write_text(",".join(acceptance_sheet.SHEET_COLUMNS) + "\n" + line)
    (found,) = acceptance_sheet.sheet(path)
    assert found.quantity.isprintable() and found.measured == 2.0
    path.write_text(",".join(acceptance_sheet.SHEET_COLUMNS) + "\n" + 20_000 * line)
    with pytest.raises(FeederError, match="kB"):
        acceptance_sheet.sheet(path)
    path.write_bytes(b"\xff\xfe" + path.read_bytes()[:100])
    with pytest.raises(FeederError, match="UTF-8"):
        acceptance_sheet.sheet(path)
