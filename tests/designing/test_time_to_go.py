"""The guess of the time to go: stages by their own pace, and what is denied comes again."""

import csv
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from feederscrew.base.running import RunSettings
from feederscrew.designing import progress
from feederscrew.designing.progress import (
    USUAL_QUEUE_WORK,
    USUAL_S,
    WRITING_S,
    Clock,
    SearchProgress,
    SearchStage,
    TrialBudget,
)


@pytest.fixture
def at(monkeypatch):
    """Sets the clock [s] that a search reads."""
    now = [0.0]
    monkeypatch.setattr(progress, "time", SimpleNamespace(monotonic=lambda: now[0]))

    def set_to(seconds):
        now[0] = seconds

    return set_to


def run(clock, at, stage, seconds, done=1, total=1):
    """One stage from now on, for some seconds."""
    begun = clock.begun + clock.seconds
    clock.begin(stage)
    at(begun + seconds)
    clock.reach(stage, done, total)
    clock.end()


def test_a_stage_counts_by_its_own_pace_as_soon_as_it_has_one(at):
    clock = Clock()
    clock.begin(SearchStage.DRAWS)
    at(1.0)
    clock.reach(SearchStage.DRAWS, 1, 20)  # 5 %: as usual, less the time gone
    assert clock.rest_of_stage(SearchStage.DRAWS) == pytest.approx(USUAL_S[SearchStage.DRAWS] - 1.0)
    at(30.0)
    clock.reach(SearchStage.DRAWS, 5, 20)  # 6 s each
    assert clock.rest_of_stage(SearchStage.DRAWS) == pytest.approx(90.0)
    at(120.0)
    clock.reach(SearchStage.DRAWS, 20, 20)
    assert clock.rest_of_stage(SearchStage.DRAWS) == 0.0
    # a queue takes 50 s as usual, then the files are written
    assert clock.each(SearchStage.QUEUE) == 50.0
    assert clock.rest(1, 16) == pytest.approx(50.0 + WRITING_S)


def test_a_queue_counts_to_its_end_at_the_pace_of_those_that_were_denied(at):
    """Two that were refused after 20 s and 40 s, at a tenth and a fifth of a whole one."""
    clock = Clock()
    run(clock, at, SearchStage.QUEUE, 20.0, 9_000, 90_000)
    run(clock, at, SearchStage.QUEUE, 40.0, 18_000, 90_000)
    assert clock.each(SearchStage.QUEUE) == pytest.approx(200.0)
    clock.begin(SearchStage.QUEUE)
    at(70.0)
    clock.reach(SearchStage.QUEUE, 900, 90_000)  # a hundredth
    assert clock.rest_of_stage(SearchStage.QUEUE) == pytest.approx(190.0)
    at(100.0)
    clock.reach(SearchStage.QUEUE, 9000, 90_000)  # a tenth: by its own pace
    assert clock.rest_of_stage(SearchStage.QUEUE) == pytest.approx(9 * 40.0)
    at(460.0)
    clock.reach(SearchStage.QUEUE, 90_000, 90_000)
    slow = (10.0 + 60.0) / (10.0 + 2 * 50.0)  # two queues took 30 s each, for 50 s
    assert clock.rest(3, 16) == pytest.approx(WRITING_S * slow)


def test_a_queue_that_is_denied_by_its_first_parts_does_not_say_how_long_a_whole_one_is(at):
    """Of caps two of the first four were wrong: 2,450 s to go were said, and 760 s were right."""
    clock = Clock()
    run(
        clock, at, SearchStage.QUEUE, 30.0, 300, 24_000
    )  # by 4 parts: some 600 s at each fill seemed to be left
    assert clock.each(SearchStage.QUEUE) == pytest.approx(30.0 * USUAL_QUEUE_WORK / 300)
    run(clock, at, SearchStage.QUEUE, 300.0, 3_000, 24_000)  # of both 3,300: enough to count to the end
    assert clock.each(SearchStage.QUEUE) == pytest.approx(330.0 * 24_000 / 3_300)


def test_one_that_takes_longer_than_usual_goes_on_for_a_quarter_as_long(at):
    clock = Clock()
    clock.begin(SearchStage.QUEUE)
    at(100.0)
    clock.reach(SearchStage.QUEUE, 900, 90_000)
    assert clock.rest_of_stage(SearchStage.QUEUE) == pytest.approx(25.0)


def test_the_guess_is_of_the_case_that_the_next_proof_holds(at):
    """Whether it does nobody knows: a round that was denied makes it no longer."""
    clock = Clock()
    run(clock, at, SearchStage.TRIAL, 10.0)
    clock.begin(SearchStage.TRIAL)
    # trials at their own pace; the rest as usual on a machine that took 20 s where 12 s are usual
    slow = 20.0 / 12.0
    assert clock.rest(1, 16) == pytest.approx(4 * 10.0 + (5.0 + 50.0 + WRITING_S) * slow)
    run(clock, at, SearchStage.DRAWS, 10.0, 20, 20)
    run(clock, at, SearchStage.QUEUE, 80.0)
    clock.begin(SearchStage.TRIAL)  # goes on: it was denied
    slow = 110.0 / (10.0 + 2 * 2.0 + 5.0 + 50.0)
    assert clock.rest(1, 16) == pytest.approx(4 * 5.0 + 10.0 + 80.0 + WRITING_S * slow)
    assert clock.rest(9, 16) == pytest.approx(1 * 5.0 + 10.0 + 80.0 + WRITING_S * slow)
    # a long proof is followed to its end, whatever it shows
    clock.begin(SearchStage.LONG_PROOF)
    clock.reach(SearchStage.LONG_PROOF, 1, 4)
    at(150.0)
    clock.reach(SearchStage.LONG_PROOF, 2, 4)
    assert clock.rest(9, 16) == pytest.approx(clock.rest_of_stage(SearchStage.LONG_PROOF))


def test_a_share_that_was_told_does_not_go_back(at):
    """A queue of eyelets was at 61 % after 851 s and at 54 % after 867 s: it had become longer."""
    told = []
    said = SearchProgress(report=lambda stage, done, total, gone, rest: told.append((done, done / total)))
    run_settings = said.watch(RunSettings(), SearchStage.QUEUE, TrialBudget([], 16, 20))
    looks = [(100, 400), (200, 400), (210, 600), (360, 600), (600, 600), (20, 400)]
    for second, (done, total) in enumerate(looks):
        at(10.0 * (second + 1))
        run_settings.progress(done, total)
    counts, shares = zip(*told)
    assert counts == tuple(done for done, _ in looks)
    assert shares == pytest.approx([0.25, 0.5, 0.5, 0.6, 1.0, 0.05])  # another queue begins anew


TRACES = Path(__file__).parents[1] / "data" / "design_times.csv"


def traces():
    """Of each design that was recorded its events: seconds, stage, event, share of the stage."""
    designs = {}
    with TRACES.open(encoding="utf-8") as file:
        for row in csv.DictReader(file):
            event = float(row["seconds"]), row["stage"], row["event"], float(row["share"])
            designs.setdefault(row["design"], []).append(event)
    return designs


def factors(events, at):
    """How many times too much or too little guesses are, in the last round and from a quarter of the time.

    A share that falls is of a total that grew: what is done is not undone.
    """
    at(0.0)
    clock, trials, wrong, done = Clock(), 0, [], 0.0
    *events, (end, *_) = events
    proofs = [
        place for place, (_, stage, event, _) in enumerate(events) if (stage, event) == ("draws", "begin")
    ]
    queues = [
        place for place, (_, stage, event, _) in enumerate(events) if (stage, event) == ("queue", "begin")
    ]
    # from the first trial behind the last proof that was denied
    behind = [place for place in (*proofs[:-1], *queues[:-1]) if place < proofs[-1]]
    first = max(behind, default=-1)
    while first >= 0 and events[first][1] != "trial":
        first += 1
    for place, (seconds, name, event, share) in enumerate(events):
        at(seconds)
        stage = SearchStage(name)
        if event == "begin":
            clock.begin(stage)
            trials, done = trials + (stage is SearchStage.TRIAL), 0.0
        else:
            done = max(1e6 * share, done)
            clock.reach(stage, round(done), round(done / share) if share else 1_000_000)
        if place >= first and seconds >= end / 4 and end - seconds >= 10.0:  # what is printed goes by tens
            wrong.append(clock.rest(max(trials - 1, 0), 16) / (end - seconds))
    clock.end()
    return [max(factor, 1.0 / factor) for factor in wrong]


def test_the_time_to_go_if_it_holds_is_true(at):
    """Five recorded designs that hold, on two cores that were theirs.

    Under a load that changes they are not: of seven designs 52 of 71 guesses were within a factor of 1.5.
    """
    wrong = np.concatenate([factors(events, at) for events in traces().values()])
    assert len(traces()) == 5 and len(wrong) > 10
    assert np.mean(wrong <= 1.5) >= 0.9
