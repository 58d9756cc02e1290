"""The loop of a design: parts that turn on the way to the tooling, and what a stopped one hands over."""

import functools
from dataclasses import replace
from types import SimpleNamespace

import design_counts
import numpy as np
import pytest
import shapes

from feederscrew import bowl as bowls
from feederscrew.arrivals.ensemble import wilson
from feederscrew.arrivals.entry import Shares
from feederscrew.base.columns import values
from feederscrew.base.errors import FeederError
from feederscrew.base.running import RunSettings
from feederscrew.bowl.verified import Status
from feederscrew.designing import (
    calm_drive,
    exploring,
    families,
    loop,
    proposals,
    queues,
    short_trials,
)
from feederscrew.designing.design import complete_design
from feederscrew.designing.proof import RobustRun
from feederscrew.designing.record import DesignRequest
from feederscrew.designing.short_trials import robust_run
from feederscrew.machine.drive_sizing import drive_shortfall
from feederscrew.output import designs, marking, next_tries
from feederscrew.resting.aspects import find
from feederscrew.trials import fills, long_ride
from feederscrew.trials.fills import FillLevel
from feederscrew.trials.long_ride import LEFT, RideOfTrack
from feederscrew.trials.trial import TrialQueue, trial
from feederscrew.trials.wanted import states_of_name

NAMES = ("A@0", "A@180", "B@0")
CUBE = shapes.part(shapes.box(10, 10, 10))
REQUEST = DesignRequest(40.0 / 60.0, draws=2, rule="csa")
SHARES = Shares(find(CUBE))


def ridden(entering, wanted, *changes):
    """Ten parts of each; changes are (row, what it becomes, how many)."""
    entered = np.repeat([0, 1, 2], 10)
    ended = entered.copy()
    for row, becomes, count in changes:
        places = np.flatnonzero((entered == row) & (ended == row))[:count]
        ended[places] = becomes
    ride = RideOfTrack(NAMES, entered, ended, np.zeros(30, bool), np.full(30, 0.45), np.ones(30))
    entering = np.array(entering)
    return long_ride.LongRide(ride, entering, ride.arriving_shares(entering), wanted)


def test_each_orientation_says_how_many_stay_turn_and_leave():
    rows = ridden([0.5, 0.3, 0.2], (0,), (1, 0, 2), (2, LEFT, 10)).rows()
    low, high = (float(end[0]) for end in wilson([8], 10))
    assert values(long_ride.LONG_RIDE_COLUMNS, rows[1]) == {
        "orientation": "A@180", "parts": 10, "stays": 8, "stays_low": low, "stays_high": high,
        "becomes": {"A@0": 2}, "left": 0, "share_entering": 0.3,
        "share_arriving": pytest.approx(0.24 / 0.8),
    }  # fmt: skip
    assert (rows[2].stays, rows[2].left, rows[2].becomes) == (0, 10, {})
    table = designs.long_ride(rows)
    assert list(table["becomes"]) == ["-", "A@0: 2", "-"] and list(table["left"]) == [0, 0, 10]
    assert list(table["arriving [%]"]) == [70.0, 30.0, 0.0]
    # of A@0, half of all, one in ten becomes B; a fifth of A@180 becomes A@0
    seen = ridden([0.5, 0.3, 0.2], (0,), (0, 2, 1), (1, 0, 2))
    assert seen.losses == pytest.approx([0.05, 0.0, 0.0]) and seen.gains == pytest.approx([0.0, 0.06, 0.0])
    assert seen.distance == pytest.approx(0.45)


@pytest.mark.parametrize(("entering", "wanted", "changes", "said"), [
    ([0.5, 0.3, 0.2], (0,), (), ()),
    ([0.9, 0.05, 0.05], (0,), ((1, 0, 5),), ()),  # 2.5 % of 92.5
    ([0.5, 0.3, 0.2], (0,), ((1, 0, 2),), ("2 of 10 parts of A@180 turned or left on 450 mm", "50 to 56 %")),
    ([0.5, 0.3, 0.2], (0, 1), ((1, 0, 9),), ()),  # both are wanted: which of them does not matter
    ([0.5, 0.3, 0.2], (0,), ((1, 2, 10),), ()),
    ([0.5, 0.3, 0.2], (0,), ((0, LEFT, 3),), ("3 of 10 parts of A@0 turned or left",)),
])  # fmt: skip
def test_a_design_that_depends_on_what_turns_says_so_and_no_other_does(entering, wanted, changes, said):
    warning = ridden(entering, wanted, *changes).warning
    assert all(text in warning for text in said) and (warning == "") == (not said)


def test_those_that_turn_ride_again(monkeypatch):
    """Only what comes often rides, and what is wanted; what turned rides twice, with other seeds."""
    asked = []

    def ride(part, bowl, lying, rows, *, repeats, run):
        asked.append((tuple(rows), repeats, run.seed))
        entered = np.repeat(rows, repeats)
        ones = np.ones(len(entered))
        ended = np.where(entered == 1, 0, entered)
        return RideOfTrack(tuple("PQRST"), entered, ended, ones < 0.0, ones, ones)

    monkeypatch.setattr(long_ride, "ride_of_track", ride)
    run = DesignRequest(0.5, seed=7).run
    seen = long_ride.long_ride(None, None, (), np.array([0.2, 0.6, 0.04, 0.04, 0.12]), [3], run)
    assert asked == [((1, 0, 4, 3), 6, 7), ((1,), 6, 8)]
    assert seen.ride.counts[1].tolist() == [12, 0, 0, 0, 0, 0]
    assert seen.arriving == pytest.approx([0.8, 0.0, 0.04, 0.04, 0.12])


def test_a_proof_is_of_the_mix_that_arrives_and_of_the_one_that_enters(monkeypatch):
    """Apart parts come as the ride has made them, touching as they entered; draws are half of each."""
    seen, drawn = [], []
    first, queues_filled = long_ride.long_ride, queues.follow_fills

    def ride(*values):
        found = first(*values)
        mix = np.arange(1.0, len(found.entering) + 1.0)
        return replace(found, arriving=mix / mix.sum())

    def filled(row, **more):
        seen.append((row.shares, row.touching))
        return queues_filled(row, **more)

    def robust_run(part, bowl, known, shares, *_, **__):
        drawn.append(shares)
        return RobustRun(1, 1)

    monkeypatch.setattr(loop, "robust_run", robust_run)
    monkeypatch.setattr(loop, "long_ride", ride)
    monkeypatch.setattr(queues, "follow_fills", filled)
    request = DesignRequest(0.5, draws=1, rule="csa")
    found = loop.design(CUBE, bowls.default(), frozenset(), request, shares=SHARES, with_nearest=False)
    ride = found.proof.long_ride
    for apart, touching in seen:
        assert np.array_equal(apart, ride.arriving) and np.array_equal(touching, ride.entering)
    assert seen and drawn == [pytest.approx(0.5 * (ride.arriving + ride.entering))] * len(drawn) != []
    (row,) = designs.document(found)["long_ride"][:1]
    assert row["parts"] >= long_ride.RIDING_PARTS and row["stays"] + row["left"] <= row["parts"]


@pytest.fixture(autouse=True)
def short(monkeypatch):
    monkeypatch.setattr(fills, "TOUCHING_PARTS", 3)
    monkeypatch.setattr(loop, "longest_time", lambda target: 1.0)
    monkeypatch.setattr(long_ride, "RIDE_M", 0.05)
    monkeypatch.setattr(exploring, "entry_shares", lambda *_: SHARES)


def stopping(word):
    """What is told, and a user who stops it as soon as a word comes."""
    said = []

    def told(text):
        said.append(text)
        if word in text:
            raise KeyboardInterrupt

    return said, told


@pytest.mark.parametrize(("word", "why", "bowl"), [
    ("trial 1", "0 short trials made", False),
    ("draws:", "no draw was tried; no queue was followed", True),
    ("queue:", "2 of 2 draws sort, 2 are asked for; no queue was followed", True),
    ("at normal fill", "2 of 2 draws sort, 2 are asked for; the queue at high fill was", True),
])  # fmt: skip
def test_it_hands_over_what_was_proved_so_far_and_no_verdict(word, why, bowl):
    said, told = stopping(word)
    found = loop.design(CUBE, bowls.default(), frozenset(), REQUEST, tell=told)
    assert found.partial and found.status == "not proved" and why in found.why
    assert (found.bowl is not None) == bowl and len(found.attempts) == bowl
    assert word in said[-1] and said[0] == "trial 1: A@0, no device"


def test_what_denies_a_proof_is_told_before_the_search_goes_on(monkeypatch):
    """After 'clean, 71.9/min' of 60 asked for came the next trial: nothing said that the queue had jammed."""
    said = []
    turned = design_counts.lost("A@0", design_counts.TURNED_ON_TRACK).counted_in_draws(2, 2)
    monkeypatch.setattr(loop, "robust_run", lambda *_, **__: RobustRun(2, 0, turned))
    own = {"shares": SHARES, "with_nearest": False, "tell": said.append}
    found = loop.design(CUBE, bowls.default(), frozenset(), REQUEST, **own)
    first = next(n for n, text in enumerate(said) if text.startswith("A@0 does not hold: "))
    lack = said[first].removeprefix("A@0 does not hold: ")
    assert lack in found.shortfalls and "0 of 2 draws" in lack and said[first - 1].startswith("draws:")


STEEP = ("drive.vibration_angle=60 deg", "drive.amplitude=0.2 mm", "drive.frequency=50 Hz")


@pytest.fixture
def steep(monkeypatch):
    """A cube at a drive that no leaf springs make: its draws sort and its queues hold, at every drive."""
    drives = []

    def filled(row, **more):
        drives.append(row.bowl.drive)
        return tuple(design_counts.queue(fill=level, gaps=level.gaps, seconds=60.0) for level in FillLevel)

    monkeypatch.setattr(loop, "robust_run", lambda *_, **__: RobustRun(2, 2))
    monkeypatch.setattr(queues, "follow_fills", filled)
    settings, plain = bowls.settings(None, STEEP), bowls.read(None, STEEP)
    given = frozenset(line.partition("=")[0] for line in STEEP)
    complete = functools.partial(complete_design, settings=settings)
    design = functools.partial(loop.design, CUBE, plain, given, REQUEST, shares=SHARES, complete=complete)
    return design, drives, settings


def test_a_drive_that_no_springs_make_comes_with_a_flatter_one_that_was_proved(steep):
    design, drives, settings = steep
    found = complete_design(design(), settings)
    assert found.status is Status.NO_MACHINE and found.verdict.tooling_status is Status.HOLDS
    assert found.alternatives[0].status is Status.NO_MACHINE
    assert marking.of_trial(designs.trial_of(found)) == ""
    # the chain was proved at two drives, the second flatter and no slower: springs make that one
    asked, flatter = drives
    assert flatter.vibration_angle < asked.vibration_angle == pytest.approx(np.radians(60.0))
    near, bowls_of = found.nearest, [replace(found.bowl, drive=drive) for drive in drives]
    assert calm_drive.speed(bowls_of[1]) >= calm_drive.speed(bowls_of[0]) > 0.0
    assert dict(near.settings) == {
        "drive.vibration_angle": f"{np.degrees(flatter.vibration_angle):.3g} deg",
        "drive.amplitude": f"{1e3 * flatter.amplitude:.4g} mm",
    }
    shortfalls = [drive_shortfall(replace(bowl, devices=()), frozenset()) for bowl in bowls_of]
    assert shortfalls[0] and not shortfalls[1]
    # status, JSON and the first call to paste say the same
    assert "flatter angle" in found.why and near.rate == REQUEST.target and near.proofs == 1
    written = designs.document(found)["nearest"]
    assert written["settings"] == dict(near.settings) and "flatter angle" in written["change"]
    first = next_tries.entries(found)[0]
    assert first["settings"] == dict(near.settings) and first["evidence"] == "holds"
    assert all(f"{key}={text}" in first["command"] for key, text in near.settings)


def test_a_flatter_drive_whose_queues_do_not_hold_is_named_with_what_denied_it(steep, monkeypatch):
    design, drives, settings = steep
    holds = queues.follow_fills

    def jam_if_flatter(row, **more):
        jams = int(row.bowl.drive.vibration_angle < np.radians(59.0))
        return tuple(replace(each, jams=jams) for each in holds(row, **more))

    monkeypatch.setattr(queues, "follow_fills", jam_if_flatter)
    near = complete_design(design(), settings).nearest
    assert near.rate is None and not near.settings and len(near.denied) == near.proofs == len(drives) - 1 > 0
    assert all("flatter angle" in text and "jam" in text for text in near.denied)


def test_a_family_is_stopped_with_the_parts_that_were_reached(monkeypatch):
    """Or, where each holds for itself, while all are tried with one chain."""
    _, told = stopping("draws:")
    pair = [CUBE, replace(CUBE, name="other")]
    found = families.family(pair, bowls.default(), frozenset(), REQUEST, tell=told)
    assert (found.partial, found.status, len(found.members)) == (True, "not proved", 1)
    holds = {"partial": False, "status": "holds", "devices": (), "bowl": None}
    monkeypatch.setattr(families.loop, "design", lambda part, *_, **__: SimpleNamespace(part=part, **holds))
    monkeypatch.setattr(families, "_unify_chains", lambda *_: told("draws:"))
    found = families.family(pair, bowls.default(), frozenset(), REQUEST)
    assert (found.partial, found.status, len(found.members)) == (True, "not proved", 2)


def test_parts_that_a_stopped_trial_has_not_tried_are_no_verdict(monkeypatch):
    ways = proposals.follow_orientations(CUBE, find(CUBE), bowls.default())
    shares = np.full(len(ways.lying), 1.0 / len(ways.lying))
    seen = SimpleNamespace(partial=True, orientations=np.zeros((1, 1)), fates=np.zeros(1))
    monkeypatch.setattr(short_trials.course, "course", lambda *_, **__: seen)
    with pytest.raises(KeyboardInterrupt):
        short_trials.try_parts(CUBE, bowls.default(), ways, shares, 0, rows=(0,), count=2, run=RunSettings(1))
    drawn = robust_run(CUBE, bowls.default(), ways, shares, 0, draws=3, tolerance=1e-5, run=RunSettings(1))
    assert drawn.partial and drawn.draws == 0


@pytest.mark.parametrize(("asked", "said"), [

    ({"aspect": ""}, "there is no aspect '' - choose one of A"),
    ({"up": "A,Q"}, "has no aspect 'Q' - choose one of A"),
    ({"without": "wipr"}, "unknown device 'wipr'"),
    ({"aspect": "a", "heading": 0.7}, "has no stable heading"),
])  # fmt: skip
def test_design_refuses_it_before_anything_is_tried(asked, said):
    tried = []
    with pytest.raises(FeederError) as fault:
        loop.design(CUBE, bowls.default(), frozenset(), DesignRequest(0.5, **asked), tell=tried.append)
    assert said in str(fault.value) and not tried


@pytest.mark.parametrize("line", ["design --target 9/min", "tooling", "rate", "trial", "tune --target 9/min"])
def test_every_command_refuses_an_aspect_alike(line, run):
    shapes.box(10, 10, 10).export("cube.stl")
    done = run(*line.split(), "cube.stl", "--aspect", "Q", "--rule", "csa")
    assert done.exit_code == 2 and done.stdout == ""
    assert "Error: --aspect of cube.stl: there is no aspect 'Q' - choose one of A" in done.stderr


def test_a_trial_at_one_fill_is_the_queue_of_the_design(monkeypatch):
    """The same gaps, the same arrivals, the same that is wanted: the same parts leave."""
    rows = []
    follow = queues.follow_fills
    monkeypatch.setattr(queues, "follow_fills", lambda row, **more: rows.append(row) or follow(row, **more))
    request = replace(REQUEST, up=("A",))
    found = loop.design(CUBE, bowls.default(), frozenset(), request, shares=SHARES, with_nearest=False)
    level = fills.FillLevel.HIGH
    proved = next(queue for queue in found.proof.queues if queue.fill == level)
    own = {"aspect_shares": SHARES, "rule": "csa", "parts": 1, "seconds": proved.seconds}
    again = TrialQueue("high", wanted=found.wanted, up=request.up)
    run = trial(CUBE, found.bowl, queue=again, **own).runs[0]
    assert run.filled == proved and run.filled.parts == level.parts == run.queue.parts
    assert (rows[-1].states, rows[-1].any_heading) == states_of_name(
        run.orientations, run.shares, found.wanted, request.up
    )
    fewer = trial(CUBE, found.bowl, queue=TrialQueue("low", 2), **own | {"seconds": 0.2}).runs[0]
    assert (fewer.filled.fill, fewer.filled.parts, fewer.filled_wanted) == ("low", 2, "A@0")
    for wrong, poured in (
        (("full",), False),
        (("low",), True),
        (("low", 2, "Q@3"), False),
        (("low", 0), False),
    ):
        with pytest.raises(FeederError):
            trial(CUBE, found.bowl, queue=TrialQueue(*wrong), poured=poured, **own)
