"""Many parts: how they are named, shared out, kept and taken up again."""

import hashlib
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path
from types import SimpleNamespace

import pytest
import shapes
from command_lines import NUT, PARTS, ROOT, called, rows

from feederscrew.base.errors import FeederError
from feederscrew.designing import loop
from feederscrew.jobs import batch
from feederscrew.jobs.batch import batch_run, summary, task, work
from feederscrew.jobs.batch.inputs import read_orders
from feederscrew.output import batch as batch_output
from feederscrew.part import gate, load, topology
from feederscrew.resting.aspects import find

TABLES_ONLY = batch.Choices(rule="closed", pictures=False)  # nothing is simulated


def block(path, *size):
    shapes.box(*size).export(path)


def statuses(path):
    return {row["folder"]: row["status"] for row in rows(path)}


def tree(root):
    """Every file's bytes by its path."""
    files = sorted(path for path in Path(root).rglob("*") if path.is_file())
    return {path.relative_to(root).as_posix(): path.read_bytes() for path in files}


def asked(*sources, **options):
    return batch.gather([str(source) for source in sources], **options)


def ran(requests, out, jobs=2, **options):
    options.setdefault("choices", TABLES_ONLY)
    return batch.run(requests, out, workers=options.pop("workers", batch.Processes(jobs)), **options)


def of(request, choices=TABLES_ONLY):
    return task.Task.of(request, choices, Path(request.source).read_bytes())


def worked(request, rule="closed", **choices):
    """The outcome of one part, with some choices."""
    outcome = work.work(of(request, batch.Choices(**{"rule": rule, "pictures": False} | choices)))
    assert outcome.status == task.DONE, outcome.reason
    return outcome


def copied(each):
    """In place of the work: what the store keeps of a part hangs on its file and its options alone."""
    files = {"aspects.csv": each.data, "convey.json": each.choices.rule.encode()}
    row = {"orientation": "A@0", "rule": each.choices.rule, "parts_per_minute": 12.0}
    own = (each.request.name, each.key, each.request.source, each.sha256)
    return task.Outcome(*own, task.DONE, "", row, {}, (), files)


class Here:
    """A crew without processes: the work, or ``copied``, is done where it is asked for."""

    def __init__(self, stop_after=None, job=copied):
        self.done, self.stop_after, self.job = [], stop_after, job

    def outcomes(self, tasks):
        for each in tasks:
            if len(self.done) == self.stop_after:
                raise KeyboardInterrupt
            self.done.append(each.request.name)
            yield self.job(each)


def dies_over_the_second(each):
    """A worker that is killed by one part, whoever computes it."""
    if each.request.name == "b":
        os.kill(os.getpid(), signal.SIGKILL)
    return task.Outcome.failed(each, "computed")


def says_where(each):
    """The process that computes."""
    return task.Outcome.failed(each, str(os.getpid()))


@pytest.fixture
def three(tmp_path):
    """Three boxes in a folder, and the requests for them."""
    (tmp_path / "in").mkdir()
    for name, size in zip("abc", (3.0, 5.0, 7.0)):
        block(tmp_path / f"in/{name}.stl", 10.0, 6.0, size)
    return asked(tmp_path / "in")


@pytest.fixture
def here(tmp_path, monkeypatch):
    """An empty folder to work in."""
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_a_folder_gives_its_parts_and_a_pattern_each_of_them_once(here):
    (here / "deep/deeper").mkdir(parents=True)
    for name in ("b.stl", "a.STL", "notes.txt", ".hidden.stl", "deep/x.stl", "deep/deeper/y.stl"):
        shutil.copy(NUT, here / name)
    (here / "bowl.yaml").write_text("gravity: 9.81 m/s2\n")
    shutil.copy(PARTS / "magnet.yaml", here / "card.yaml")
    assert [request.name for request in asked(".")] == ["a", "b", "card"]
    deep = asked("deep/**/*.stl", "deep/x.stl")
    assert [Path(request.source).name for request in deep] == ["y.stl", "x.stl"]


def test_every_part_has_a_folder_of_its_own_on_any_system():
    for files, folders in {
        ("1/nut.stl", "2/nut.stl"): ["nut", "nut-2"],
        ("1/nut.stl", "2/NUT.stl"): ["nut", "NUT-2"],
        ("1/nut.stl", "2/nut.stl", "nut-2.stl"): ["nut", "nut-3", "nut-2"],
        ("con.stl", "a:b.stl", "end. .stl"): ["con_", "a_b", "end"],
        ("1/\u00e9.stl", "2/e\u0301.stl"): ["\u00e9", "\u00e9-2"],
        (f"{'n' * 200}.stl",): ["n" * 80],
    }.items():
        assert [request.name for request in asked(*files)] == folders


def test_bowls_multiply_the_parts_and_a_list_gives_each_its_own_options(here):
    (here / "bowls").mkdir()
    for name, frequency in (("slow", 60), ("fast", 90)):
        (here / f"bowls/{name}.yaml").write_text(f"drive:\n  frequency: {frequency} Hz\n")
    requests = asked(NUT, configs=["bowls"])
    assert [request.name for request in requests] == ["squarenut_m5-fast", "squarenut_m5-slow"]
    assert [round(request.conditions.bowl.drive.frequency) for request in requests] == [90, 60]
    text = "part,density,units,config\n# a comment\nnut.stl,brass,in,\nsub/pin.stl,,,bowls/fast.yaml\n"
    (here / "list.csv").write_text(text)
    first, second = asked(here / "list.csv")
    assert first.options == (("units", "in"), ("density", "brass"))
    assert second.source == str(here / "sub/pin.stl")
    assert round(second.conditions.bowl.drive.frequency) == 90


FAULTS = {
    "prt,density\n": "list.csv:1: has no column 'part' - begin with a line such as part,units,density,",
    "part,densty\n": "list.csv:1: unknown column 'densty' - did you mean density?",
    "part,units\na.stl,mm,7\n": "list.csv:2: has more cells than the first line - quote cells with",
    "part,units\n,mm\n": "list.csv:2: names no part - fill its first column, or remove the line",
    "part\n\xe9": "list.csv:2: byte 0xe9 is not UTF-8 - save the file as UTF-8 text",
    'part\n"a': "list.csv: is not CSV (unexpected end of data) - check its quotes and commas",
    "part,config\nnut.stl,gone.yaml\n": "list.csv:2: gone.yaml: no such file - check the path",
    "part\n# none\n": "list.csv: lists no part - write a line a part",
}
OF_DESIGNS = {
    "part,target,aspect\na.stl,fast,\n": "list.csv:2: target 'fast' is no rate",
    "part,target,aspect\n,40/min,\n": "list.csv:2: names no part",
    "part,rate\na.stl,3\n": "is not the head of a list",
    "part,target,aspect\n": "lists no part",
}


@pytest.mark.parametrize("text", FAULTS | OF_DESIGNS)
def test_a_fault_of_a_list_names_its_line(here, text):
    Path("list.csv").write_bytes(text.encode("latin-1"))
    with pytest.raises(FeederError) as fault:
        (read_orders if text in OF_DESIGNS else asked)("list.csv")
    assert (FAULTS | OF_DESIGNS)[text] in fault.value.lines[0]


def test_what_gives_no_part_cannot_move_one_or_has_no_place_is_told_before_any_work(here, tmp_path, three):
    Path("empty").mkdir()
    told = {"empty": "holds no part file", "empty/*.stl": "fits no file", "gone.csv": "no such file"}
    for source, what in told.items():
        with pytest.raises(FeederError, match=what):
            asked(source)
    with pytest.raises(FeederError, match="is 0 mm, so nothing moves"):
        asked(NUT, overrides=["drive.amplitude=0 mm"])
    # nor is a folder of others used
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine/thesis.pdf").write_text("mine")
    with pytest.raises(FeederError, match=r"holds other files, such as thesis.pdf - give an empty folder"):
        ran(three, tmp_path / "mine", workers=Here())
    busy = pytest.raises(FeederError, match="another batch is at work in it - wait for it, or stop it")
    with batch_run.Store(tmp_path / "out"), busy:
        ran(three, tmp_path / "out", workers=Here())


def test_the_key_hangs_on_everything_that_the_results_hang_on():
    [request], [other_bowl] = asked(NUT), asked(NUT, overrides=["friction.wall=0.11"])
    others = (batch.Choices(pictures=False, **own) for own in ({"rule": "csa"}, {"drops": 10}))
    tasks = [of(request), of(other_bowl), *(of(request, choices) for choices in others)]
    keys = {each.key for each in (*tasks, task.Task.of(request, TABLES_ONLY, b"other"))}
    assert len(keys) == 5 and of(request).key == of(asked(NUT)[0]).key


def test_the_row_is_what_the_commands_say_with_the_warnings_of_rate(run):
    """A cap rolls back down the climb: `feeder rate` warns of it, and so does the table of a batch."""
    for part in (NUT, PARTS / "cap_14x10.stl"):
        outcome = worked(asked(part)[0])
        row = outcome.row
        own = ("--aspect", row["aspect"], "--heading", f"{row['heading_deg']:.12f}deg", "--rule", "closed")
        alone = run("rate", part, *own, "--format", "json")
        answer, warned = json.loads(alone.stdout), alone.stderr.splitlines()
        for end in ("_low", "", "_high"):
            assert row[f"parts_per_minute{end}"] == pytest.approx(answer[f"parts_per_minute{end}"], rel=1e-9)
        lines = [line.removeprefix("Warning: ") for line in warned if line.startswith("Warning: ")]
        assert bool(lines) == (part != NUT) and all(text in outcome.warnings for text in lines)
        table = run("aspects", part, "--rule", "closed", "--format", "csv", "-q").stdout
        assert outcome.files["aspects.csv"].decode() == table and "note" not in row


def test_a_rate_of_zero_says_why_and_a_bug_on_one_part_is_a_reason_and_no_more(tmp_path, monkeypatch):
    (tmp_path / "low.yaml").write_text("devices:\n  - wiper: 1 mm\n")
    row = worked(*asked(NUT, configs=[str(tmp_path / "low.yaml")])).row
    assert row["parts_per_minute"] == 0.0
    assert row["note"] == "wiper (1 mm) rejects the orientation you want; rate is 0"
    monkeypatch.setattr(work, "shares", lambda *_, **own: 1 / 0)
    outcome = work.work(of(asked(NUT)[0]))
    assert (outcome.status, outcome.files) == ("failed", {})
    assert outcome.reason == f"{NUT}: unexpected ZeroDivisionError: division by zero - please report it"


@pytest.mark.long
def test_processes_write_the_bytes_of_one_and_the_index_is_in_pages(tmp_path, three, monkeypatch):
    """Pages of one part each: the picture stays in the part's folder, and a later run takes its page away."""
    monkeypatch.setattr(summary, "INDEX_ROWS", 1)
    one, two, choices = tmp_path / "one", tmp_path / "two", batch.Choices(rule="closed")
    for out, jobs in ((one, 1), (two, 2)):
        ran(three[:2], out, jobs=jobs, choices=choices)
    assert tree(one) == tree(two)
    assert {"summary.csv", "contact_sheet.png", "parts/a/thumbnail.png"} <= set(tree(one))
    first, second = ((one / name).read_text() for name in ("index.html", "index_2.html"))
    for page, name, other in ((first, "a", "b"), (second, "b", "a")):
        assert f'src="parts/{name}/thumbnail.png"' in page and f"parts/{other}/" not in page
        assert 'href="index_2.html"' in page and len(page) < 2e4 and not re.search(r"https?:|base64", page)
    assert "page 2 of 2" in second
    ran(three[:1], one, workers=Here())
    assert not (one / "index_2.html").exists() and "page 1" not in (one / "index.html").read_text()


def test_a_stopped_run_lists_what_is_done_and_resume_repeats_what_is_missing_or_changed(tmp_path, three):
    out = tmp_path / "out"
    for count in (1, 2):  # the second run begins anew, in place of the first
        with pytest.raises(batch.StoppedBatchError) as caught:
            ran(three, out, workers=Here(stop_after=count))
        assert (caught.value.done, caught.value.total) == (count, 3)
        assert caught.value.summary == out / "summary.csv"
        assert list(statuses(out / "summary.csv").values()).count("done") == count
    with pytest.raises(batch.StoppedBatchError) as caught:  # what is kept is done, also what comes later
        ran(three[::-1], out, workers=Here(stop_after=0), resume=True)
    assert caught.value.done == 2
    assert statuses(out / "summary.csv") == {"a": "done", "b": "done", "c": "not computed"}
    second, third, fourth = Here(), Here(), Here()
    assert ran(three, out, workers=second, resume=True).reused == 2
    assert set(statuses(out / "summary.csv").values()) == {"done"}
    whole = tree(out)
    block(three[1].source, 1.0, 2.0, 3.0)
    ran(three, out, workers=third, resume=True)
    (out / "parts/a/aspects.csv").write_text("meddled with")
    ran(three, out, workers=fourth, resume=True)
    assert (second.done, third.done, fourth.done) == (["c"], ["b"], ["a"])
    assert {name for name, data in tree(out).items() if whole[name] != data} >= {"parts/b/aspects.csv"}
    assert tree(out)["parts/a/aspects.csv"] == whole["parts/a/aspects.csv"]


def test_a_stopped_run_over_an_ended_one_writes_its_summary_beside(tmp_path, three):
    """Results of other options that lie there still are not those asked for: 'not computed'."""
    out = tmp_path / "out"
    ran(three, out, workers=Here())
    before, other = (out / "summary.csv").read_bytes(), batch.Choices(rule="csa", pictures=False)
    with pytest.raises(batch.StoppedBatchError) as caught:
        ran(three, out, workers=Here(stop_after=1), choices=other)
    assert caught.value.summary == out / "summary_partial.csv"
    assert list(statuses(caught.value.summary).values()) == ["done", "not computed", "not computed"]
    assert (out / "summary.csv").read_bytes() == before
    ran(three, out, workers=Here(), choices=other, resume=True)
    assert not caught.value.summary.exists() and (out / "summary.csv").read_bytes() != before


def test_resume_says_how_many_it_computes_and_why(tmp_path, three, monkeypatch):
    out, away = tmp_path / "out", tmp_path / "away"

    def stale(requests=three, rule="closed"):
        return batch.count_stale(requests, out, batch.Choices(rule=rule, pictures=False))

    assert stale() == {"new": 3} and not out.exists()
    ran(three, out, workers=Here())
    assert stale() == {} and stale(rule="csa") == {"other options or bowl": 3}
    (out / "parts/a/aspects.csv").write_text("meddled with")
    block(three[1].source, 1.0, 2.0, 3.0)
    assert stale() == {"results changed or incomplete": 1, "another file": 1}
    monkeypatch.setattr(task, "__version__", "9.9")
    monkeypatch.setattr(batch_run, "__version__", "9.9")
    assert stale(three[2:]) == {"another version of the program or a library": 1}
    Path(three[2].source).rename(away)
    ran(three[2:], out, workers=Here())
    away.rename(three[2].source)
    assert stale(three[2:]) == {"failed for want of its file or of memory": 1}


def test_a_folder_is_read_one_folder_deeper_or_what_is_left_out_is_said(tmp_path):
    tree = tmp_path / "parts"
    for name in ("left/nut.stl", "right/nut.stl", "right/bolt.stl", "right/deeper/pin.stl", ".git/no.stl"):
        (tree / name).parent.mkdir(parents=True, exist_ok=True)
        block(tree / name, 1.0, 2.0, 3.0)

    def names():
        return [Path(r.source).relative_to(tree).as_posix() for r in batch.gather([str(tree)])]

    assert names() == ["left/nut.stl", "right/bolt.stl", "right/nut.stl"]
    (said,) = batch.find_folders_within([str(tree)])
    assert said == f"{tree}: holds no part itself: read 3 parts in 2 folders of it"
    block(tree / "own.stl", 1.0, 2.0, 3.0)
    assert names() == ["own.stl"]
    (said,) = batch.find_folders_within([str(tree)])
    assert said.endswith(f": 3 parts in 2 folders of it left out - add '{tree}/*/*.stl'")
    assert batch.find_folders_within([str(tree / "right"), str(tree / "own.stl")])[0].startswith(
        f"{tree}/right"
    )
    assert batch.find_folders_within([str(tree / "left")]) == ()


def test_rows_of_equal_names_have_their_folder():
    paths = ["1/a/nut.stl", "2/a/nut.stl", "bolt.stl", "3/b/bolt.stl", "pin.stl"]
    requests = [task.Request(path, task.Conditions("bowl", None, ())) for path in paths]
    rows = summary.rows(SimpleNamespace(), requests, finished=set())
    assert [row["part"] for row in rows] == [
        "1/a/nut.stl",
        "2/a/nut.stl",
        "bolt.stl",
        "b/bolt.stl",
        "pin.stl",
    ]


FORGED = {
    "rate": lambda record: record["row"].update(
        parts_per_minute=99999.0, parts_per_minute_low=53.9, parts_per_minute_high=86.7
    ),
    "text": lambda record: record["row"].update(mass_g="x"),
    "negative": lambda record: record["row"].update(parts_per_minute=-1.0, parts_per_minute_low=-2.0),
    "list": lambda record: record.update(row=[]),
    "null": lambda record: record.update(row=None),
    "inputs": lambda record: record.update(inputs=["a"]),
    "files": lambda record: record.update(files=[]),
    "warnings": lambda record: record.update(warnings=[{}]),
    "status": lambda record: record.update(status=3),
    "missing": lambda record: record.pop("key"),
}


def test_resume_believes_no_record_that_was_changed(tmp_path, three):
    """A record of 99,999 parts a minute beside 53.9 to 86.7 went into the summary; others were tracebacks."""
    out = tmp_path / "out"
    ran(three, out, workers=Here())
    path = out / "parts/a/run.json"
    whole, choices = path.read_text(), batch.Choices(rule="closed", pictures=False)
    for name, forge in FORGED.items():
        for is_signed in (False, True):
            document = json.loads(whole)
            record = document["batch"]
            forge(record)
            if is_signed:
                record.pop("digest")
                record["digest"] = hashlib.sha256(json.dumps(record, sort_keys=True).encode()).hexdigest()
            path.write_text(json.dumps(document))
            stale = batch.count_stale(three, out, choices)
            assert stale == {"results changed or incomplete": 1}, (name, is_signed)
    for text in ("[]", "null", '{"batch": null}', "[" * 4000, ""):
        path.write_text(text)
        assert batch.count_stale(three, out, choices) == {"results changed or incomplete": 1}, text[:9]
    again = Here()
    assert ran(three, out, workers=again, resume=True).reused == 2 and again.done == ["a"]
    assert path.read_text() == whole


def test_tables_stay_until_new_ones_are_there_and_what_a_killed_run_left_is_put_back_or_cleared(
    tmp_path, three
):
    """They were taken away first: a run that was killed left neither."""
    out, crew = tmp_path / "out", Here()
    ran(three, out, workers=Here())
    (out / "contact_sheet_7.png").write_bytes(b"of an earlier run")
    tables = {name: data for name, data in tree(out).items() if "/" not in name}
    with pytest.raises(KeyboardInterrupt):
        ran(three[:2], out, workers=Here(stop_after=1))
    assert tables.items() <= tree(out).items()
    ran(three[:2], out, workers=Here())
    assert len(rows(out / "summary.csv")) == 2 and not (out / "contact_sheet_7.png").exists()
    before, left = tree(out), out / ".batch-killed/replaced"
    left.mkdir(parents=True)
    (out / "parts/a").rename(left / "a")
    (out / ".batch-abc/new").mkdir(parents=True)
    (out / ".batch-abc/new/aspects.csv").write_text("half")
    assert ran(three[:2], out, workers=crew, resume=True).reused == 2
    assert tree(out) == before and crew.done == [] and not list(out.glob(".batch-*"))


def test_a_part_whose_worker_dies_is_tried_again_then_told_and_tried_once_more_by_resume(tmp_path, three):
    crew, again = batch.Processes(2, job=dies_over_the_second), Here()
    first, second, third = (row["reason"] for row in ran(three, tmp_path / "out", workers=crew).rows)
    assert [first, third] == [f"{three[k].source}: computed" for k in (0, 2)]
    assert second.startswith(f"{three[1].source}: its process ended 3 times before it was done")
    ran(three, tmp_path / "out", workers=again, resume=True)
    assert again.done == ["b"]
    # processes are replaced after some parts, and tasks are read only when one is free
    crew, taken = batch.Processes(1, job=says_where, lifetime=2), []
    outcomes = crew.outcomes(taken.append(each) or of(each) for each in three)
    places = [next(outcomes).reason.split()[-1]]
    assert len(taken) == 2  # the process works at the second while the first is put in place
    places += [outcome.reason.split()[-1] for outcome in outcomes]
    assert places[0] == places[1] != places[2] and len(taken) == 3


@pytest.mark.long
@pytest.mark.skipif(os.name == "nt", reason="signals of POSIX")
def test_killed_at_any_moment_and_resumed_it_ends_with_the_same_bytes(tmp_path, three):
    rest = ["batch", str(tmp_path / "in"), "--rule", "closed", "--no-pictures", "-q", "-o"]
    called(*rest, tmp_path / "whole", "--jobs", "1")
    call = [sys.executable, "-c", "from feederscrew_cli.main import feeder; feeder()", *rest]
    call += [str(tmp_path / "out"), "--jobs", "2", "--resume"]
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL, "start_new_session": True}
    for goal in (1, 2):
        child = subprocess.Popen(call, cwd=ROOT, **quiet)
        while len(list(tmp_path.glob("out/parts/*"))) < goal and child.poll() is None:
            time.sleep(0.01)
        os.killpg(child.pid, signal.SIGKILL)
        assert child.wait() == -signal.SIGKILL
    subprocess.run(call, check=True, cwd=ROOT, capture_output=True)
    assert tree(tmp_path / "out") == tree(tmp_path / "whole")


def test_each_line_is_designed_for_its_own_target_and_a_fault_stops_no_other(run, monkeypatch):
    """What else is wrong with such a list: test_cli_status.py."""
    designs = []

    def refuse(part, bowl, keys, request, **_search):
        designs.append((part.name, round(60.0 * request.target, 9), request.aspect))
        raise FeederError(part.source, "is not designed here", "go on")

    monkeypatch.setattr(loop, "design", refuse)
    lines = f"{PARTS / 'washer_m6.stl'},30/min,A\n{PARTS / 'dowel_6x20.stl'},,\n"
    Path("list.csv").write_text(f"# two\npart,target,aspect\n{lines}")
    done = run("design", "--batch", "list.csv", "--target", "45/min", "-o", "out")
    assert done.exit_code == 1 and done.stderr.count("is not designed here") == 2
    assert designs == [("washer_m6", 30.0, "A"), ("dowel_6x20", 45.0, None)]
    table = rows(Path("out/designs/designs.csv"))
    assert [float(row["target_per_minute"]) for row in table] == pytest.approx([30.0, 45.0])
    assert [row["status"] for row in table] == ["failed", "failed"]


def test_a_list_asks_for_an_aspect_and_a_density_a_batch_for_a_launch_and_drops(here):
    block("block.stl", 8.0, 12.0, 20.0)
    Path("list.csv").write_text("part,aspect,density\nblock.stl,,\nblock.stl,C,brass\nblock.stl,q,\n")
    usual, wanted, unknown = asked("list.csv", density="abs")
    assert (usual.aspect, wanted.aspect, wanted.name) == (None, "C", "block-2")
    made, other = (worked(request, pictures=True) for request in (wanted, usual))
    assert made.row["aspect"] == "C" and made.row["orientation"].startswith("C@")
    masses = [(each.row["material"], round(each.row["mass_g"], 9)) for each in (made, other)]
    assert masses == [("brass", 1.92 * 8.47), ("abs", 1.92 * 1.05)]  # of the parts that name none
    thumbnail, part = made.files[work.THUMBNAIL], load("block.stl")
    assert thumbnail == batch_output.thumbnail(part, find(part), "C") != other.files[work.THUMBNAIL]
    failed = work.work(of(unknown))
    assert failed.reason == "list.csv:4: aspect of block.stl: there is no aspect 'q' - choose one of A, B, C"
    placed, fed = (worked(usual, "recommended", launch=launch) for launch in ("place", "feed"))
    assert placed.row["answer"].endswith("launch place") and fed.row["answer"].endswith("launch feed")
    assert placed.key != fed.key and placed.effective["launch"] == "place"
    row = worked(usual, "recommended", drops=200).row
    assert row["answer"] == "drop test, launch feed" and row["aspect"] == row["drop_aspect"]
    assert row["p_orientation"] <= row["p_drop"]


def test_tiles_name_the_orientation_and_fill_sheets():
    store = SimpleNamespace(file=lambda folder, name: b"PNG")
    row = {"folder": "block", "status": task.DONE, "orientation": "C@90", "parts_per_minute": 12.0}
    for count in (1, summary.TILES + 1):
        sheets = list(summary.sheets(store, [row] * count))
        assert sheets[0][0] == (b"PNG", "block", "C@90: 12 / min")
        assert sum(map(len, sheets)) == count and len(sheets) == -(-count // summary.TILES)
    note = "a part card has no outline: no rate"
    card = row | {"orientation": None, "parts_per_minute": None, "note": note}
    assert next(summary.sheets(store, [card]))[0][2] == note


def test_a_failed_part_is_not_advised_what_a_batch_has_no_option_for():
    for advice in (topology.SAVE_SHELLS, gate.CLOSE_IN_CAD, gate.UNITE_IN_CAD):
        reason = task.Outcome.failed(of(asked(NUT)[0]), f"is not closed - {advice}").reason
        assert "allow_open" not in reason and reason.endswith(re.split(r"[,;] or pass", advice)[0])
