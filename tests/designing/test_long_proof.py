"""A long proof shows the agreed jams an hour: in runs that are kept, on any number of cores."""

import base64
import json
import signal
import subprocess
import sys
import textwrap
import threading
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import shapes
from design_counts import design_study, queue

from feederscrew import bowl as bowls
from feederscrew.arrivals import simulation_cache
from feederscrew.base.running import RunSettings
from feederscrew.base.units import HOUR
from feederscrew.designing import acceptance_sheet, evidence, families, long_proof, loop
from feederscrew.designing.long_proof import LongPlan, RunCounts, follow_long
from feederscrew.designing.progress import SearchProgress, SearchStage
from feederscrew.designing.record import ProofKind
from feederscrew.trials import fills
from feederscrew.trials.fills import FedRow, FillLevel

PART = shapes.part(shapes.box(10, 10, 10))
PLAN = LongPlan(3, 0.2)
AGREED = 1.0 / HOUR


@pytest.fixture(autouse=True)
def cache(monkeypatch, tmp_path):
    monkeypatch.setenv("FEEDER_CACHE", str(tmp_path / "cache"))
    monkeypatch.setattr(fills, "TOUCHING_PARTS", 3)
    # a thread that another test left would make a process that begins anew, with rows of twelve parts
    monkeypatch.setattr(threading, "active_count", lambda: 1)
    return tmp_path / "cache"


@pytest.fixture
def row(block):
    shares = np.full(len(block.ways.lying), 1.0 / len(block.ways.lying))
    return FedRow(block.part, bowls.default(), block.aspects, block.ways, shares, (0,))


@pytest.fixture
def followed(monkeypatch):
    """The runs that were followed, and not read, in this process."""
    seen, follow = [], long_proof._follow
    monkeypatch.setattr(long_proof, "_follow", lambda row, run, *more: seen.append(run) or follow(row, run))
    return seen


def test_one_jam_an_hour_takes_three_hours_and_another_rate_its_own_time():
    """-ln 0.05 = 2.9957 of the agreed rate, whatever the runs (Garwood 1937)."""
    plan = LongPlan.to_show(AGREED)
    assert plan.runs * plan.seconds == pytest.approx(2.9957 * HOUR, rel=1e-4)
    assert plan.seconds <= long_proof.RUN_S < plan.seconds * (plan.runs + 1) / (plan.runs - 1)
    assert LongPlan.to_show(1.0, 300.0) == LongPlan(1, pytest.approx(2.9957, rel=1e-4))
    assert evidence.rate_at_most(0, plan.runs * plan.seconds) == pytest.approx(AGREED)


def test_the_lower_bound_of_a_rate_is_that_of_garwood():
    """Of 1 event 0.0513, of 2 0.355, of 10 5.43 (95 %, one-sided), tables of the Poisson mean."""
    for count, mean in ((1, 0.0513), (2, 0.3554), (10, 5.4254)):
        assert evidence.rate_at_least(count, 2.0) == pytest.approx(mean / 2.0, rel=1e-3)
    assert evidence.rate_at_least(0, 2.0) == 0.0


def test_runs_are_added_up_alike_on_one_core_and_several_and_are_not_made_twice(row, followed, cache):
    told, said = [], []
    run = RunSettings(1, 1, progress=lambda done, total: told.append((done, total)))
    alone = follow_long(row, PLAN, AGREED, run, said.append)
    assert [filled.fill for filled in alone] == [*FillLevel]
    assert all(filled.seconds == pytest.approx(0.6) and not filled.partial for filled in alone)
    assert len(followed) == len(set(followed)) == 9 and told == [(n, 9) for n in range(10)]
    assert len({each.seed for each in followed}) == 3  # of each fill three seeds
    again = follow_long(row, PLAN, AGREED, run, said.append)
    assert again == alone and len(followed) == 9 and "9 of them kept" in said[-1] and "kept" not in said[0]
    simulation_cache.clear()
    assert follow_long(row, PLAN, AGREED, replace(run, jobs=2)) == alone
    assert len(list(cache.iterdir())) == 9
    other = replace(row, bowl=replace(row.bowl, restitution=0.5 * row.bowl.restitution))
    assert follow_long(other, PLAN, AGREED, replace(run, jobs=2)) and len(list(cache.iterdir())) == 18


def write_again(file, change):
    """Change the arrays of a kept run, and sign it as the cache does."""
    entry = json.loads(file.read_bytes())
    change(entry["arrays"])
    entry["sha256"] = simulation_cache._digest([entry["key"], entry["arrays"]])
    file.write_bytes(simulation_cache._line(entry))


def encoded(value, kind="<i8"):
    return base64.b64encode(np.asarray(value, kind).tobytes()).decode()


@pytest.mark.parametrize("change", [
    lambda arrays: arrays["jams"].update(data=encoded(-1)),
    lambda arrays: arrays["jams"].update(kind="float", data=encoded(0.0, "<f8")),
    lambda arrays: arrays["seconds"].update(data=encoded(1e4, "<f8")),
    lambda arrays: arrays["counted"].update(data=encoded(np.nan, "<f8")),
    lambda arrays: arrays["delivered"].update(data=encoded(99999.0, "<f8")),
    lambda arrays: arrays["left"].update(shape=[1, 1, 1], data=encoded(1)),
    lambda arrays: arrays.pop("climbs"),
])  # fmt: skip
def test_a_run_that_contradicts_itself_is_followed_again(row, followed, cache, change):
    first = follow_long(row, LongPlan(1, 0.1), AGREED, RunSettings())
    write_again(min(cache.iterdir()), change)
    assert follow_long(row, LongPlan(1, 0.1), AGREED, RunSettings()) == first and len(followed) == 4


def test_a_file_that_was_changed_is_not_believed(row, followed, cache):
    first = follow_long(row, LongPlan(1, 0.1), AGREED, RunSettings())
    file = min(cache.iterdir())
    data = json.loads(file.read_bytes())
    data["arrays"]["jams"]["data"] = encoded(7)
    file.write_bytes(json.dumps(data, sort_keys=True).encode())
    assert follow_long(row, LongPlan(1, 0.1), AGREED, RunSettings()) == first and len(followed) == 4


def test_what_the_user_stops_is_marked_and_goes_on(row, followed):
    def stop(done, total):
        if done == 4:
            raise KeyboardInterrupt

    some = follow_long(row, PLAN, AGREED, RunSettings(progress=stop))
    assert len(followed) == 4 and all(filled.partial for filled in some)
    assert [filled.seconds for filled in some] == pytest.approx([0.2, 0.2, 0.4])  # the fullest first
    whole = follow_long(row, PLAN, AGREED, RunSettings())
    assert len(followed) == len(set(followed)) == 9 and not any(filled.partial for filled in whole)


KILLED = """
    import sys
    sys.path[:0] = {paths}
    import numpy as np, shapes
    from feederscrew import bowl
    from feederscrew.designing import long_proof, proposals
    from feederscrew.resting.aspects import find
    from feederscrew.base.running import RunSettings
    from feederscrew.trials import fills
    fills.TOUCHING_PARTS = 3
    part = shapes.part(shapes.box(20, 12, 5))
    aspects = find(part)
    ways = proposals.follow_orientations(part, aspects, bowl.default())
    shares = np.full(len(ways.lying), 1.0 / len(ways.lying))
    row = fills.FedRow(part, bowl.default(), aspects, ways, shares, (0,))
    run = RunSettings(1, 2, progress=lambda done, total: print(done, flush=True))
    long_proof.follow_long(row, long_proof.LongPlan(300, 0.2), 1.0 / 3600.0, run)
"""


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="looks for processes in /proc")
def test_a_proof_that_is_killed_goes_on_where_it_was_and_leaves_no_process(row, followed, cache):
    paths = [str(Path(shapes.__file__).parent)]
    script = textwrap.dedent(KILLED).format(paths=paths)
    with subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, text=True) as child:
        for line in child.stdout:
            if int(line) >= 3:
                break
        beside = Path(f"/proc/{child.pid}/task/{child.pid}/children").read_text().split()
        child.send_signal(signal.SIGKILL)
    kept = len(list(cache.glob(f"*{simulation_cache.ENTRY_SUFFIX}")))
    assert kept >= 3 and len(beside) == 2
    until = time.monotonic() + 20.0
    while any(is_at_work(number) for number in beside) and time.monotonic() < until:
        time.sleep(0.02)
    assert not any(is_at_work(number) for number in beside)
    follow_long(row, LongPlan(2, 0.2), AGREED, RunSettings())
    assert len(followed) <= 3  # of six: the first of each fill at least were kept


def is_at_work(number):
    try:
        return Path(f"/proc/{number}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False


def test_a_fill_ends_where_its_jams_refuse_what_was_agreed(row, monkeypatch):
    """8 jams in one hour refuse 1 an hour (a mean of 1 gives 5 or more in 0.4 %); 4 in 4 h do not."""
    made, plan, jams = [], LongPlan(4, HOUR), {FillLevel.HIGH: 8, FillLevel.NORMAL: 0, FillLevel.LOW: 1}
    rows, states = len(row.orientations.lying), len(row.orientations.states)
    none = np.zeros((rows, states + 1, len(row.aspects.names) + 1), int), np.zeros((rows, 1), int)

    def follow(row, run, *more):
        made.append(run)
        return RunCounts(run.seconds, 0.0, 0.0, jams[run.fill], 0, 0, *none)

    monkeypatch.setattr(long_proof, "_follow", follow)
    low, normal, high = follow_long(row, plan, AGREED, RunSettings())
    assert (high.jams, high.seconds, high.partial) == (8, HOUR, False)
    assert (normal.jams, normal.seconds, low.jams, low.seconds) == (0, 4 * HOUR, 4, 4 * HOUR)
    assert len(made) == 9


def long_study(**more):
    own = design_study(PART, **more)
    request = replace(own.request, proof="long", agreed_jams=AGREED)
    return replace(own, request=request).proved_by(row="a row of parts")


def filled(fill, jams=0):
    return queue(7000, returned=70, fill=fill, seconds=3.0 * HOUR, counted=3.0 * HOUR, jams=jams)


@pytest.mark.parametrize(("jams", "status"), [(0, "holds"), (1, "falls short")])
def test_a_design_holds_by_its_long_proof_and_the_sheet_says_what_was_shown(monkeypatch, jams, status):
    told, asked = [], []

    def follow(row, plan, agreed, run, tell):
        asked.append((row, plan, agreed, run.seed))
        run.tell(1, 1)
        return tuple(filled(fill, jams * (fill is FillLevel.HIGH)) for fill in FillLevel)

    monkeypatch.setattr(long_proof, "follow_long", follow)
    made = loop.prove_long(long_study(), SearchProgress(report=lambda *values: told.append(values)))
    assert asked == [("a row of parts", LongPlan.to_show(AGREED), AGREED, 1)]
    assert told[0][:3] == (SearchStage.LONG_PROOF, 1, 1)
    assert made.status == status and len(made.proof.queues) == 3
    sheet = [acceptance_sheet.lines_of_fill(filled, 0.5, AGREED)[-1] for filled in made.proof.queues]
    assert [line.computed for line in sheet] == pytest.approx([0.0, 0.0, jams / 3.0])
    # 3.00 and 4.74 of the mean are the bounds of no event and of one
    assert [line.computed_high for line in sheet] == pytest.approx(
        [0.9986, 0.9986, 0.9986 + jams * 0.5827], rel=1e-3
    )
    assert ("at high fill 1 jam in 180 min" in made.why and "1.58 an hour" in made.why) == bool(jams)


def test_no_design_is_followed_long_that_was_not_asked_for(monkeypatch):
    monkeypatch.setattr(long_proof, "follow_long", lambda *_: pytest.fail("followed"))
    some = replace(long_study(), request=design_study(PART).request)
    assert loop.prove_long(some, SearchProgress()) is some


@pytest.mark.parametrize("proof", [*ProofKind])
def test_a_family_is_followed_long_once_with_the_values_of_all(monkeypatch, proof):
    asked, shown = [], []

    def member(part, plain, keys, request, **more):
        asked.append(request.proof)
        return replace(design_study(part), request=request)

    monkeypatch.setattr(families.loop, "design", member)
    monkeypatch.setattr(families.loop, "prove_long", lambda study, said: shown.append(study) or study)
    parts = [shapes.part(shapes.box(10, 10, 10), name) for name in ("one", "two")]
    request = replace(design_study(PART).request, proof=proof)
    study = families.family(parts, bowls.default(), (), request)
    assert asked == [ProofKind.USUAL] * len(asked) and len(study.members) == 2
    assert [one.request.proof for one in shown] == [ProofKind.LONG] * (2 if proof is ProofKind.LONG else 0)


def test_what_is_left_of_a_long_proof_is_told():
    said = SearchProgress(report=lambda *values: told.append(values))
    told, study = [], long_study()
    run = said.watch(study.request.run, SearchStage.LONG_PROOF, loop.TrialBudget([], 1, 1))
    run.tell(80, 90)  # kept
    said.clock.since -= 60.0
    said.clock.last -= 60.0
    run.tell(82, 90)
    assert told[-1][4] == pytest.approx(8 * 30.0, rel=0.05)
