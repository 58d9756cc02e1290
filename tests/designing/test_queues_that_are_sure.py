"""Queues end as soon as they surely hold, and no sooner: the sequential test against its closed forms."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
import shapes
from design_counts import queue

from feederscrew import bowl as bowls
from feederscrew.designing import proposals, queues, short_trials
from feederscrew.designing.record import DesignRequest, share_interval
from feederscrew.rates import stream
from feederscrew.resting.aspects import find
from feederscrew.running import RunSettings
from feederscrew.tooling.devices.kinds import make_device
from feederscrew.trial.queue import PARTS_IN_SHARES as BLOCK
from feederscrew.trial.queue import QueuedParts

TARGET = 0.5  # [1/s] asked for
LEAST = 0.9 * TARGET


def fills(right, wrong=0, seconds=30.0, returned=0, jams=0, **more):
    """Three fills of so many seconds, with what left all of them in equal parts as near as may be."""
    made = []
    for k, (fill, gaps) in enumerate(queues.FILLS):
        one, off, back = (total // 3 + (k < total % 3) for total in (right, wrong, returned))
        times = {"seconds": seconds, "counted": 0.9 * seconds} | more
        made.append(queue(one, one + off, back, jams * (k == 2), fill, gaps, **times))
    return tuple(made)


@pytest.mark.parametrize(
    ("right", "wrong", "seconds", "sure"),
    [
        # of the parts that are planned 2 % may be wrong; chance that more are of those to come, at 2 % wrong
        (96, 0, 40.0, True),  # more than 2 of 48: 0.071
        (95, 1, 40.0, False),  # more than 1 of 48: 0.249
        (100, 0, 20.0, True),  # 150 are planned, whatever the minutes would bring; more than 3 of 50: 0.018
        (99, 1, 20.0, True),  # more than 2 of 50: 0.078
        (98, 2, 20.0, False),  # more than 1 of 50: 0.264
        (148, 3, 30.0, True),  # none to come
        (147, 4, 30.0, False),
        (300, 0, 50.0, True),
        (0, 0, 50.0, False),
    ],
)
def test_the_parts_still_to_come_do_not_turn_the_verdict(right, wrong, seconds, sure):
    assert queues.is_sure(fills(right, wrong, seconds), LEAST) is sure
    assert not queues.is_sure(fills(right, wrong, seconds, jams=1), LEAST)
    assert not queues.is_sure(fills(right, wrong, seconds)[:2], LEAST)


def test_three_minutes_of_what_is_asked_for_have_left_before_it_is_sure():
    """So jams a part are as well known as of a bowl that brings no more than that."""
    rates = [target for target in (1.0, 1.2, 1.24, 1.26) if queues.is_sure(fills(225, 0, 45.0), 0.9 * target)]
    assert rates == [1.0, 1.2, 1.24]  # 225 parts in 180 s: 1.25 a second


def test_the_rate_s_lower_end_is_what_is_asked_for():
    """A third of what is offered comes back: 240 of 360 leave, in 40.5 s counted of each fill."""
    (one, *_), slow = (fills(240, 0, 45.0, returned=120, counted=counted) for counted in (40.5, 80.0))
    pace = 80.0 / 40.5 * 120.0 / 80.0
    assert one.pace == pytest.approx(pace)
    # Wilson's lower end of 240 of 360 is 0.6168: what is asked for decides by the number of parts
    assert pace * 0.6168 > 240.0 / 180.0
    assert slow[0].pace * 0.6168 == pytest.approx(0.9252, rel=1e-3)
    assert queues.is_sure(slow, 0.9 * 0.92) and not queues.is_sure(slow, 0.9 * 0.93)


def chances(purity, rate, draws, seed):
    """Shares of runs that end early, hold at the end, do the one and not the other; the mean time [1]."""
    rng, early, held, other, time = np.random.default_rng(seed), 0, 0, 0, 0.0
    count = 3 * round(rate * 10.0)  # parts that leave all three fills in 10 s
    for _ in range(draws):
        wrong = rng.random((6, count)) > purity
        at_end = wrong.sum() <= (1.0 - queues.PURE) * wrong.size + 1e-9
        off = [int(wrong[:k].sum()) for k in range(2, 6)]
        sure = [queues.is_sure(fills(count * k - n, n, 10.0 * k), LEAST) for k, n in zip(range(2, 6), off)]
        early, held, other = early + any(sure), held + at_end, other + (any(sure) and not at_end)
        time += (2 + sure.index(True)) / 6.0 if any(sure) else 1.0
    return early / draws, held / draws, other / draws, time / draws


@pytest.mark.parametrize("purity", [0.96, 0.98, 0.995])
@pytest.mark.parametrize("rate", [0.7, 0.8])
def test_it_errs_seldom_at_any_purity(purity, rate):
    """Few runs end early that the whole minutes would deny, 0.03 of them at the most; docs/design.md."""
    early, held, other, _ = chances(purity, rate, 400, 5)
    assert other <= 0.03 and early <= held + other
    assert purity < queues.PURE or early > 0.2


@pytest.mark.parametrize(
    ("right", "wrong", "seconds", "least", "enough"),
    [
        (150, 0, 20.0, LEAST, True),
        (149, 0, 59.0, LEAST, False),
        (147, 3, 20.0, LEAST, True),
        (146, 4, 20.0, LEAST, False),
        (150, 0, 19.0, LEAST, False),  # each fill for 20 s at least
        (179, 0, 20.0, 0.9, False),
        (180, 0, 20.0, 0.9, True),  # at 60 a minute the 180 of three minutes
    ],
)
def test_so_many_pure_parts_are_enough(right, wrong, seconds, least, enough):
    assert queues.has_enough(fills(right, wrong, seconds), least) is enough
    assert not queues.has_enough(fills(right, wrong, seconds)[:2], least)
    assert not queues.has_enough(fills(right, wrong, seconds, jams=1), least)


def holding(purity, parts, runs):
    """Share of runs that hold, of a row of which so many parts leave all fills in 10 s."""
    rng, held = np.random.default_rng(2), 0
    for _ in range(runs):
        wrong = 0
        for seconds in (20, 30, 40, 50, 60):
            wrong += rng.binomial(parts * (2 if seconds == 20 else 1), 1.0 - purity)
            left = parts * seconds // 10
            some = fills(left - wrong, wrong, float(seconds))
            if queues.has_enough(some, LEAST) or (seconds == 60 and wrong <= (1.0 - queues.PURE) * left):
                held += 1
                break
            if queues.is_denied(some, some[-1], 0.0):
                break
    return held / runs


@pytest.mark.parametrize(("purity", "share"), [(0.96, 0.07), (0.97, 0.27), (0.98, 0.70), (0.99, 0.985)])
def test_what_is_impure_holds_seldom_however_often_it_is_looked_at(purity, share):
    """At 144 parts a minute, looks included: docs/design.md."""
    assert holding(purity, 72, 600) == pytest.approx(share, abs=0.045)


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


@pytest.mark.parametrize(
    ("right", "wrong", "least", "settled"),
    [
        (145, 5, LEAST, False),  # no other of the 105 to come: 0.120
        (144, 6, LEAST, True),
        (147, 3, LEAST, False),
        (150, 0, LEAST, True),
        (150, 0, 10.0, False),  # too slow by what has left so far
    ],
)
def test_more_of_a_queue_is_followed_only_while_it_may_turn_the_verdict(right, wrong, least, settled):
    """Of 150 and 105 to come 5 may be wrong: chance of what decides, at 2 % wrong."""
    assert queues.is_settled(fills(right, wrong, 50.0), least, 105) is settled


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
    """A row whose queues are fakes, by fill."""

    def queue(self, gaps, seed):
        return self.part[gaps]

    def count(self, fill, gaps, seen):
        one = seen.queue
        times = {"seconds": one.time, "counted": 0.95 * one.time, "partial": seen.partial}
        return queue(
            int(one.rate * one.time), returned=0, jams=int(one.time >= one.jams_at), fill=fill, **times
        )


def followed(*fakes, whole=False, **more):
    """The fills of three queues, each a rate or what a fake is made of: name, seconds, whether it stopped."""
    fakes = [FakeQueue(*(one if isinstance(one, tuple) else (one,))) for one in fakes]
    by_gap = dict(zip((gaps for _, gaps in queues.FILLS), fakes))
    bowl = SimpleNamespace(drive=SimpleNamespace(frequency=50.0))
    row = replace(FakeRow(by_gap, bowl, None, None, None, (0,), 1, least=LEAST), **more)
    made = queues.filled(row, whole=whole)
    return [(one.fill, one.seconds, one.partial) for one in made], made


def test_fast_clean_fills_end_after_twenty_seconds_each():
    """450 parts in a minute of queue; the statement stands on no less than 60 s."""
    said, bars = [], []
    fills, made = followed(8.0, 8.0, 8.0, tell=said.append, progress=lambda *bar: bars.append(bar))
    assert fills == [(fill, 20.0, False) for fill, _ in queues.FILLS] and queues.is_complete(made)
    assert [text.split(" at ")[1] for text in said] == [f"{fill} fill, to 20 s" for fill, _ in queues.FILLS]
    assert bars == [(500 * k, 9000) for k in range(1, 7)]


@pytest.mark.parametrize(
    ("rate", "whole", "seconds"),
    [
        (1.2, False, 30.0),  # 108 of 150 parts, and more than 3 of 42 to come: 0.01
        (0.55, False, 60.0),
        (1.2, True, 50.0),  # 180 parts; after 40 s there were 144
    ],
)
def test_slower_fills_go_on_in_turn_until_they_are_sure(rate, whole, seconds):
    fills, _ = followed(rate, rate, rate, whole=whole)
    assert [one for _, one, _ in fills] == [seconds] * 3


INF = np.inf


@pytest.mark.parametrize(
    ("fakes", "fills"),
    [
        ((2.0, (2.0, 9.0), 2.0), [("low", 20.0, False), ("normal", 10.0, False)]),  # a jam where it is seen
        ((0.3, 2.0, 2.0), [("low", 20.0, False)]),  # surely too slow after its first seconds
        ((2.0, (2.0, INF, 13.0), 2.0), [("low", 20.0, False), ("normal", 13.0, True)]),  # stopped by the user
        ((2.0, (2.0, INF, 0.0), 2.0), [("low", 20.0, True)]),
    ],
)
def test_what_denies_it_or_is_stopped_ends_it_where_it_is_seen(fakes, fills):
    assert followed(*fakes)[0] == fills
    if fills[-1][1] == 13.0:
        assert followed(*fakes, jobs=2)[0] == fills


def test_a_late_jam_denies_what_went_on_and_a_stop_at_once_is_handed_on():
    fills, made = followed(1.2, 1.2, (1.2, 25.0))
    assert [one for _, one, _ in fills] == [30.0] * 3 and made[-1].jams == 1
    assert not queues.is_complete(made)
    with pytest.raises(KeyboardInterrupt):
        followed(*[(2.0, INF, 0.0)] * 3)


def test_touching_parts_come_as_they_entered_the_track(monkeypatch):
    """Parts apart come in the shares behind the ride, touching ones in those before it."""
    offered = {}
    monkeypatch.setattr(
        queues,
        "PartsQueue",
        lambda part, bowl, aspects, parts, poses, plan, seed: offered.update({plan.gaps: parts[1]}),
    )
    monkeypatch.setattr(queues.short_trials, "counted", lambda *_: ())
    known, arriving, entering = SimpleNamespace(lying=()), np.array([0.9, 0.1]), np.array([0.5, 0.5])
    made = queues.FollowedRow(None, None, None, known, arriving, (0,), 1, touching=entering)
    for _, gaps in queues.FILLS:
        made.queue(gaps, 1)
    assert [offered[gaps] is entering for _, gaps in queues.FILLS] == [False, False, True]
    assert [offered[gaps] is arriving for _, gaps in queues.FILLS] == [True, True, False]


@pytest.mark.parametrize("rates", [(8.0, 8.0, 8.0), (1.2, 1.2, 1.2), (0.3, 2.0, 2.0)])
@pytest.mark.parametrize("jams_at", [INF, 9.0, 25.0])
def test_fills_side_by_side_end_as_in_turn(rates, jams_at):
    """On two cores the outcome is that of one, also where one fill denies what others go on with."""
    fakes = rates[0], (rates[1], jams_at), rates[2]
    assert followed(*fakes, jobs=2) == followed(*fakes, jobs=1)


def test_parts_of_a_row_come_in_exact_shares_in_random_order_and_are_counted_by_how_they_came(block):
    ways, shares = block.ways, np.zeros(len(block.ways.lying))
    shares[:3] = 0.5, 0.3, 0.2
    wanted = (int(ways.leaves_as[0]),)
    made = queues.FollowedRow(block.part, bowls.default(), block.aspects, ways, shares, wanted, 1)
    one = made.queue(0.5, 1)
    drawn = one.drawn[::-1]
    entered = [*one.entered[: BLOCK - len(drawn) - 1], one.coming[0]] if one.coming else one.entered
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


def test_what_comes_behind_its_ride_enters_two_pitches_before_a_sensor():
    """Parts that touch enter the track a whole row before it; without a sensor all do."""
    part, bowl = shapes.part(shapes.box(20, 12, 5)), bowls.default()
    aspects = find(part)
    ways = proposals.known_through(part, aspects, bowl)
    wanted = ways.lying[0]
    sorter = make_device("sorter", "test", like=(wanted.aspect, wanted.heading, 1e-3), text="test")
    longest = float(ways.lengths.max())

    def before(devices, gaps):
        driven = replace(bowl, devices=devices)
        row = queues.FollowedRow(part, driven, aspects, ways, np.full(len(ways.lying), 1.0), (0,), 1)
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
        parts=12, on_track=9, poured=False, seconds=60.0, counted=50.0, delivered=float(whole.sum()),
        whole=whole, left_by_entry=whole[None], returned_by_entry=np.array([3]), returned=3,
        jams=0, climbs=0, velocity=0.05,
        gap=0.01, touching=0.2, pressure=np.zeros(0), depth=0.0, partial=False,
    )  # fmt: skip


@pytest.mark.parametrize(
    ("wanted", "up", "lying", "right"),
    [
        # of 16 that left 15 lie on A, 5 of them at a heading that is none of the known
        ("A@0", (), {"A@0": {"A": 4}, "A@90": {"A": 6}, "": {"A": 5, "none": 1}}, 4),
        ("A@0", ("A",), {"A@0": {"A": 4}, "A@90": {"A": 6}, "": {"A": 5, "none": 1}}, 15),
        # a wanted orientation counts beside an aspect that may be up
        ("B@0", ("A",), {"A@0": {"A": 3}, "B@0": {"B": 5}, "": {"A": 3, "none": 1}}, 5 + 6),
        # askew, a part is nearest in attitude to B and has A below it: one part, of eight that left
        ("B@0", ("A",), {"B@0": {"A": 2, "B": 3}, "": {"C": 1, "A": 2}}, 5 + 2),
    ],
)
def test_a_queue_counts_each_part_once_that_leaves_as_any_of_those_wanted(block, wanted, up, lying, right):
    seen = left_queue(block, *((block.names[name] if name else -1, row) for name, row in lying.items()))
    ways, rows = block.ways, (block.names[wanted],)
    row = queues.FollowedRow(block.part, None, block.aspects, ways, None, rows, 1, any_heading=up)
    counted = row.count("low", 0.5, seen)
    assert (row.wanted_parts(seen), counted.right, counted.left) == (right, right, int(seen.whole.sum()))


def test_single_parts_and_draws_count_the_aspect_alike(block):
    part, ways, names = block.part, block.ways, block.names
    shares = np.full(len(ways.lying), 1.0 / len(ways.lying))
    bowl, rows = bowls.default(), (names["A@0"], names["A@90"])
    own = {"rows": rows, "each": 1, "run": RunSettings(1), "aspects": block.aspects}
    alone = short_trials.single(part, bowl, ways, shares, rows[0], **own)
    free = short_trials.single(part, bowl, ways, shares, rows[0], any_heading=("A",), **own)
    assert (list(alone.wrong), list(free.wrong)) == ([0, 1], [0, 0])
    assert free.purity == 1.0
    only = np.zeros(len(shares))
    only[rows[1]] = 1.0
    drawn = {"draws": 1, "tolerance": 1e-5, "run": RunSettings(1)}
    for up, held in (((), 0), (("A",), 1)):
        run = short_trials.robust_run(part, bowl, ways, only, rows[0], any_heading=up, **drawn)
        assert run.held == held


def test_what_is_round_in_plan_counts_at_any_heading_unless_one_is_asked_for():
    disc = shapes.part(shapes.cylinder(10, 4, 48))
    ways = proposals.known_through(disc, find(disc), bowls.default())
    lying = [k for k, one in enumerate(ways.lying) if one.kind == "flat"]
    assert lying
    for k in lying:
        assert short_trials.aspects_at_any_heading(ways.lying, k, ()) == (ways.lying[k].aspect,)
        assert short_trials.aspects_at_any_heading(ways.lying, k, (), heading_given=True) == ()
    request = DesignRequest(1.0, up=(ways.lying[lying[0]].aspect.lower(),), heading=None)
    assert proposals.free_headings(ways.lying, lying[0], request) == (ways.lying[lying[0]].aspect,)
