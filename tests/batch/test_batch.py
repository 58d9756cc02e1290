"""Many parts: how they are named, shared out, kept and taken up again."""

import csv
import io
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
import shapes
from click.testing import CliRunner

from feederscrew import batch, errors
from feederscrew.batch import batch_run, summary, task, work
from feederscrew.batch import work as works
from feederscrew.batch.inputs import read_orders
from feederscrew.designing import loop
from feederscrew.errors import FeederError
from feederscrew.output import batch as batch_output
from feederscrew.part import gate, load, topology
from feederscrew.resting.aspects import find
from feederscrew_cli.main import feeder

ROOT = Path(__file__).parents[2]
PARTS = ROOT / "parts"
NUT = PARTS / "squarenut_m5.stl"
TABLES_ONLY = batch.Choices(rule="closed", pictures=False)  # nothing is simulated


def block(path, x, y, z):
    """A box with corners at the origin and (x, y, z) as an ASCII STL."""
    corners = np.array([[i, j, k] for i in (0, x) for j in (0, y) for k in (0, z)], dtype=float)
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    text = "solid block\n"
    for a, b, c, d in quads:
        for triangle in ((a, b, c), (a, c, d)):
            rows = "".join("vertex {} {} {}\n".format(*corners[k]) for k in triangle)
            text += f"facet normal 0 0 0\nouter loop\n{rows}endloop\nendfacet\n"
    Path(path).write_text(text + "endsolid block\n")


def tree(root):
    """Every file's bytes by its path."""
    return {
        p.relative_to(root).as_posix(): p.read_bytes() for p in sorted(Path(root).rglob("*")) if p.is_file()
    }


def asked(*sources, **options):
    return batch.gather([str(source) for source in sources], **options)


def ran(requests, out, jobs=2, **options):
    options.setdefault("choices", TABLES_ONLY)
    return batch.run(requests, out, workers=options.pop("workers", batch.Processes(jobs)), **options)


def of(request, choices=TABLES_ONLY):
    return task.Task.of(request, choices, Path(request.source).read_bytes())


def copied(each):
    """In place of the work: what the store keeps of a part hangs on its file and its options alone."""
    files = {"aspects.csv": each.data, "convey.json": each.choices.rule.encode()}
    row = {"orientation": "A@0", "rule": each.choices.rule, "parts_per_minute": 12.0}
    return task.Outcome(
        each.request.name, each.key, each.request.source, each.sha256, task.DONE, "", row, {}, (), files
    )


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

    def each(self, function, items):
        return map(function, items)


def dies_over_the_second(each):
    """A worker that is killed by one part, whoever computes it."""
    if each.request.name == "b":
        os.kill(os.getpid(), signal.SIGKILL)
    return task.Outcome.failed(each, "computed")


@pytest.fixture
def three(tmp_path):
    """Three boxes in a folder, and the requests for them."""
    folder = tmp_path / "in"
    folder.mkdir()
    for name, size in {"a": 3.0, "b": 5.0, "c": 7.0}.items():
        block(folder / f"{name}.stl", 10.0, 6.0, size)
    return asked(folder)


def test_a_folder_gives_its_parts_by_name_and_leaves_other_files(tmp_path):
    for name in ("b.stl", "a.STL", "notes.txt", ".hidden.stl"):
        (tmp_path / name).write_bytes(NUT.read_bytes())
    (tmp_path / "bowl.yaml").write_text("gravity: 9.81 m/s2\n")
    (tmp_path / "card.yaml").write_bytes((PARTS / "magnet.yaml").read_bytes())
    assert [request.name for request in asked(tmp_path)] == ["a", "b", "card"]


def test_patterns_reach_into_folders_and_a_part_counts_once(tmp_path):
    (tmp_path / "deep/deeper").mkdir(parents=True)
    for name in ("deep/x.stl", "deep/deeper/y.stl"):
        (tmp_path / name).write_bytes(b"x")
    found = asked(f"{tmp_path}/**/*.stl", tmp_path / "deep/x.stl")
    assert [Path(request.source).name for request in found] == ["y.stl", "x.stl"]


@pytest.mark.parametrize(
    ("names", "folders"),
    [
        (["1/nut.stl", "2/nut.stl"], ["nut", "nut-2"]),
        (["1/nut.stl", "2/NUT.stl"], ["nut", "NUT-2"]),
        (["1/nut.stl", "2/nut.stl", "nut-2.stl"], ["nut", "nut-3", "nut-2"]),
        (["con.stl", "a:b.stl", "end. .stl"], ["con_", "a_b", "end"]),
        (["1/\u00e9.stl", "2/e\u0301.stl"], ["\u00e9", "\u00e9-2"]),
        ([f"{'n' * 200}.stl"], ["n" * 80]),
    ],
)
def test_every_part_has_a_folder_of_its_own_on_any_system(names, folders):
    assert [request.name for request in asked(*names)] == folders


def test_several_bowls_multiply_the_parts(tmp_path):
    for name in ("slow", "fast"):
        (tmp_path / f"{name}.yaml").write_text("drive:\n  frequency: 60 Hz\n")
    (tmp_path / "fast.yaml").write_text("drive:\n  frequency: 90 Hz\n")
    found = asked(NUT, configs=[str(tmp_path)])
    assert [request.name for request in found] == ["squarenut_m5-fast", "squarenut_m5-slow"]
    assert [round(request.conditions.bowl.drive.frequency) for request in found] == [90, 60]


def test_a_list_gives_each_part_its_own_options(tmp_path):
    (tmp_path / "fast.yaml").write_text("drive:\n  frequency: 90 Hz\n")
    (tmp_path / "list.csv").write_text(
        "part,density,units,config\n# a comment\nnut.stl,brass,in,\nsub/pin.stl,,,fast.yaml\n"
    )
    first, second = asked(tmp_path / "list.csv")
    assert first.options == (("units", "in"), ("density", "brass"))
    assert second.source == str(tmp_path / "sub/pin.stl")
    assert round(second.conditions.bowl.drive.frequency) == 90


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("prt,density\n", "list.csv:1: has no column 'part' - begin with a line such as part,units,density,"),
        ("part,densty\n", "list.csv:1: unknown column 'densty' - did you mean density?"),
        (
            "part,units\na.stl,mm,7\n",
            "list.csv:2: has more cells than the first line - quote cells with commas",
        ),
        ("part,units\n,mm\n", "list.csv:2: names no part - fill its first column, or remove the line"),
        ("part\n\xe9", "list.csv:2: byte 0xe9 is not UTF-8 - save the file as UTF-8 text"),
        ('part\n"a', "list.csv: is not CSV (unexpected end of data) - check its quotes and commas"),
        ("part,config\nnut.stl,gone.yaml\n", "list.csv:2: gone.yaml: no such file - check the path"),
        ("part\n# none\n", "list.csv: lists no part - write a line a part"),
    ],
)
def test_a_fault_of_a_list_names_its_line(tmp_path, monkeypatch, text, line):
    monkeypatch.chdir(tmp_path)
    Path("list.csv").write_bytes(text.encode("latin-1"))
    with pytest.raises(FeederError) as fault:
        asked("list.csv")
    assert fault.value.lines[0].startswith(line)


@pytest.mark.parametrize(
    ("typed", "what"),
    [("empty", "holds no part file"), ("empty/*.stl", "fits no file"), ("gone.csv", "no such file")],
)
def test_what_gives_no_part_is_told(tmp_path, monkeypatch, typed, what):
    monkeypatch.chdir(tmp_path)
    Path("empty").mkdir()
    with pytest.raises(FeederError, match=what):
        asked(typed)
    with pytest.raises(FeederError, match="is 0 mm, so nothing moves"):  # before any work as well
        asked(NUT, overrides=["drive.amplitude=0 mm"])


def test_the_key_hangs_on_everything_that_the_results_hang_on():
    [request] = asked(NUT)
    [other_bowl] = asked(NUT, overrides=["friction.wall=0.11"])
    keys = {
        of(request).key,
        of(other_bowl).key,
        of(request, batch.Choices(rule="csa", pictures=False)).key,
        of(request, batch.Choices(drops=10, pictures=False)).key,
        task.Task.of(request, TABLES_ONLY, b"other").key,
    }
    assert len(keys) == 5
    assert of(request).key == of(asked(NUT)[0]).key


def test_the_row_is_what_the_commands_say(run):
    outcome = works.work(of(asked(NUT)[0]))
    said = ["--aspect", outcome.row["aspect"], "--heading", f"{outcome.row['heading_deg']:.12f}deg"]
    rates = json.loads(run("rate", NUT, *said, "--rule", "closed", "--format", "json", "-q").stdout)
    assert outcome.row["parts_per_minute"] == pytest.approx(rates["parts_per_minute"], rel=1e-9)
    assert (
        outcome.files["aspects.csv"].decode()
        == run("aspects", NUT, "--rule", "closed", "--format", "csv", "-q").stdout
    )


def test_a_rate_of_zero_says_why(tmp_path):
    (tmp_path / "low.yaml").write_text("devices:\n  - wiper: 1 mm\n")
    (request,) = asked(NUT, configs=[str(tmp_path / "low.yaml")])
    row = works.work(of(request)).row
    assert row["parts_per_minute"] == 0.0
    assert row["note"] == "wiper (1 mm) rejects the orientation you want; rate is 0"
    (request,) = asked(NUT)
    assert "note" not in works.work(of(request)).row


def test_a_bug_on_one_part_is_a_reason_and_no_more(monkeypatch):
    monkeypatch.setattr(works, "shares", lambda *given, **named: 1 / 0)
    outcome = works.work(of(asked(NUT)[0]))
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


def test_a_bad_part_gets_a_row_with_its_reason(tmp_path, three):
    (tmp_path / "in/b.stl").write_bytes(b"")
    found = ran(asked(tmp_path / "in", "gone.stl"), tmp_path / "out", workers=Here(job=works.work))
    rows = list(csv.DictReader(io.StringIO((tmp_path / "out/summary.csv").read_text())))
    assert [row["status"] for row in rows] == ["done", "failed", "done", "failed"]
    assert rows[1]["reason"] == f"{tmp_path}/in/b.stl: is empty - export the part again"
    assert found.faults[1] == "gone.stl: no such file - check the path"


def test_resume_repeats_only_what_is_missing_or_changed(tmp_path, three):
    out = tmp_path / "out"
    with pytest.raises(KeyboardInterrupt):
        ran(three, out, workers=Here(stop_after=2))
    assert statuses(out / "summary.csv") == {"a": "done", "b": "done", "c": "not computed"}
    second, third, fourth = Here(), Here(), Here()
    assert ran(three, out, workers=second, resume=True).reused == 2
    assert second.done == ["c"]
    whole = tree(out)
    block(three[1].source, 1.0, 2.0, 3.0)
    ran(three, out, workers=third, resume=True)
    (out / "parts/a/aspects.csv").write_text("meddled with")
    ran(three, out, workers=fourth, resume=True)
    assert (third.done, fourth.done) == (["b"], ["a"])
    assert {name for name, data in tree(out).items() if whole[name] != data} >= {"parts/b/aspects.csv"}
    assert tree(out)["parts/a/aspects.csv"] == whole["parts/a/aspects.csv"]


def statuses(path):
    with path.open(newline="") as file:
        return {row["folder"]: row["status"] for row in csv.DictReader(file)}


def test_a_stopped_run_lists_what_is_done_and_says_how_much_that_is(tmp_path, three):
    out = tmp_path / "out"
    for count in (1, 2):  # the second run begins anew, in place of the first
        with pytest.raises(batch.StoppedBatchError) as caught:
            ran(three, out, workers=Here(stop_after=count))
        assert (caught.value.done, caught.value.total) == (count, 3)
        assert caught.value.summary == out / "summary.csv"
        assert list(statuses(out / "summary.csv").values()).count("done") == count
    with pytest.raises(batch.StoppedBatchError) as caught:  # what is kept is done, also what comes later
        ran(three[::-1], out, workers=Here(stop_after=0), resume=True)
    assert caught.value.done == 2 and statuses(out / "summary.csv")["c"] == "not computed"
    ran(three, out, workers=Here(), resume=True)
    assert set(statuses(out / "summary.csv").values()) == {"done"}


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
    out = tmp_path / "out"

    def stale(requests=three, **options):
        return batch.count_stale(
            requests, out, batch.Choices(**{"rule": "closed", "pictures": False} | options)
        )

    choices = batch.Choices(rule="closed", pictures=False)
    assert stale() == {"new": 3} and not out.exists()
    ran(three, out, workers=Here(), choices=choices)
    assert stale() == {}
    assert stale(rule="csa") == {"other options or bowl": 3}
    (out / "parts/a/aspects.csv").write_text("meddled with")
    block(three[1].source, 1.0, 2.0, 3.0)
    assert stale() == {"results changed or incomplete": 1, "another file": 1}
    monkeypatch.setattr(task, "__version__", "9.9")
    monkeypatch.setattr(batch_run, "__version__", "9.9")
    assert stale(three[2:]) == {"another version of the program or a library": 1}
    Path(three[2].source).rename(tmp_path / "away")
    ran(three[2:], out, workers=Here(), choices=choices)
    (tmp_path / "away").rename(three[2].source)
    assert stale(three[2:]) == {"failed for want of its file or of memory": 1}


def test_tables_of_the_last_run_stay_until_the_new_ones_are_there(tmp_path, three):
    """They were taken away first: a run that was killed left neither."""
    out = tmp_path / "out"
    ran(three, out, workers=Here())
    (out / "contact_sheet_7.png").write_bytes(b"of an earlier run")
    before = tree(out)
    tables = {name for name in before if "/" not in name}
    with pytest.raises(KeyboardInterrupt):
        ran(three[:2], out, workers=Here(stop_after=1))
    assert {name: tree(out)[name] for name in tables} == {name: before[name] for name in tables}
    ran(three[:2], out, workers=Here())
    assert len((out / "summary.csv").read_text().splitlines()) == 3
    assert not (out / "contact_sheet_7.png").exists()


def test_what_a_killed_run_left_is_put_back_or_cleared_away(tmp_path, three):
    out = tmp_path / "out"
    ran(three[:2], out, workers=Here())
    before = tree(out)
    left = out / ".batch-killed" / "replaced"
    left.mkdir(parents=True)
    (out / "parts/a").rename(left / "a")
    (out / ".batch-abc/new").mkdir(parents=True)
    (out / ".batch-abc/new/aspects.csv").write_text("half")
    crew = Here()
    assert ran(three[:2], out, workers=crew, resume=True).reused == 2
    assert tree(out) == before and crew.done == [] and not list(out.glob(".batch-*"))


def test_a_part_whose_worker_dies_is_tried_again_then_told_and_tried_once_more_by_resume(tmp_path, three):
    crew = batch.Processes(2, job=dies_over_the_second)
    found = ran(three, tmp_path / "out", workers=crew)
    reasons = [row["reason"] for row in found.rows]
    assert [reasons[0], reasons[2]] == [f"{three[k].source}: computed" for k in (0, 2)]
    assert reasons[1].startswith(f"{three[1].source}: its process ended 3 times before it was done")
    again = Here()
    ran(three, tmp_path / "out", workers=again, resume=True)
    assert again.done == ["b"]


def test_processes_are_replaced_after_some_parts(three):
    tasks = [of(request) for request in three]
    crew = batch.Processes(1, job=says_where, lifetime=2)
    places = [outcome.reason.split()[-1] for outcome in crew.outcomes(tasks)]
    assert (places[0] == places[1], places[1] == places[2]) == (True, False)


def says_where(each):
    """The process that computes."""
    return task.Outcome.failed(each, str(os.getpid()))


def test_tasks_are_read_only_when_a_process_is_free(three):
    taken = []

    def reading():
        for request in [*three, *three]:
            taken.append(request.name)
            yield of(request)

    outcomes = batch.Processes(1, job=says_where).outcomes(reading())
    next(outcomes)
    assert len(taken) == 2  # the process works at the second while the first is put in place
    outcomes.close()


def test_a_folder_of_others_is_refused(tmp_path, three):
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine/thesis.pdf").write_text("mine")
    with pytest.raises(FeederError, match=r"holds other files, such as thesis.pdf - give an empty folder"):
        ran(three, tmp_path / "mine", workers=Here())
    with (
        batch_run.Store(tmp_path / "out"),
        pytest.raises(FeederError, match="another batch is at work in it - wait for it, or stop it"),
    ):
        ran(three, tmp_path / "out", workers=Here())


@pytest.fixture(scope="module")
def uninterrupted(tmp_path_factory):
    """Blocks in a folder, the call of a batch of them up to its ``-o``, and what a whole run of it leaves."""
    folder, out = tmp_path_factory.mktemp("in"), tmp_path_factory.mktemp("whole")
    for number in range(4):
        block(folder / f"block_{number}.stl", 4.0 + 0.5 * number, 6.0, 3.0)
    rest = ["batch", str(folder), "--rule", "closed", "--no-pictures", "-q", "-o"]
    done = CliRunner().invoke(feeder, [*rest, str(out), "--jobs", "1"])
    assert done.exit_code == 0, done.output
    call = [sys.executable, "-c", "from feederscrew_cli.main import feeder; feeder()", *rest]
    return call, tree(out)


def begun(*call):
    """A batch in a session of its own."""
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    return subprocess.Popen(call, cwd=ROOT, start_new_session=True, **quiet)


@pytest.mark.long
@pytest.mark.skipif(os.name == "nt", reason="signals of POSIX")
def test_killed_at_any_moment_and_resumed_it_ends_with_the_same_bytes(tmp_path, uninterrupted):
    call, whole = uninterrupted
    call = [*call, str(tmp_path), "--jobs", "2", "--resume"]
    for goal in (1, 3):
        child = begun(*call)
        while len(list(tmp_path.glob("parts/*"))) < goal and child.poll() is None:
            time.sleep(0.01)
        os.killpg(child.pid, signal.SIGKILL)
        assert child.wait() == -signal.SIGKILL
    subprocess.run(call, check=True, cwd=ROOT, capture_output=True)
    assert tree(tmp_path) == whole


def test_a_row_has_the_warnings_of_rate(tmp_path):
    """A cap rolls back down the climb: `feeder rate` warns of it, and so does the table of a batch."""
    cap = PARTS / "cap_14x10.stl"
    (row,) = ran(asked(cap), tmp_path, workers=Here(job=works.work)).rows
    alone = CliRunner().invoke(feeder, ["rate", str(cap), "--rule", "closed"]).stderr
    said = [line.removeprefix("Warning: ") for line in alone.splitlines() if line.startswith("Warning: ")]
    assert said and all(text in row["warnings"] for text in said)
    low, rate, high = (
        row[f"parts_per_minute{end}"] for end in ("_low", "", "_high")
    )  # the interval of rate as well
    assert low < rate < high


def test_a_density_is_of_the_parts_that_name_none(tmp_path):
    block(tmp_path / "one.stl", 10, 20, 30)
    block(tmp_path / "two.stl", 10, 20, 30)
    (tmp_path / "list.csv").write_text("part,density\none.stl,brass\ntwo.stl,\n")
    requests = asked(tmp_path / "list.csv", density="abs")
    rows = ran(requests, tmp_path / "out", workers=Here(job=works.work)).rows
    assert [(row["material"], row["mass_g"]) for row in rows] == [
        ("brass", pytest.approx(6.0 * 8.47)),
        ("abs", pytest.approx(6.0 * 1.05)),
    ]


HEAD = "part,target,aspect\n"


@pytest.fixture
def list_of_two(tmp_path, request, monkeypatch):
    for name in ("washer_m6.stl", "dowel_6x20.stl"):
        shutil.copy(request.config.rootpath / "parts" / name, tmp_path)
    monkeypatch.chdir(tmp_path)
    (tmp_path / "list.csv").write_text(f"# two\n{HEAD}washer_m6.stl,30/min,A\ndowel_6x20.stl,,\n")
    return tmp_path


def test_each_line_is_designed_for_its_own_target_and_a_fault_stops_no_other(list_of_two, run, monkeypatch):
    asked = []

    def refuse(part, bowl, given, request, **_search):
        asked.append((part.name, 60.0 * request.target, request.aspect))
        raise errors.FeederError(part.source, "is not designed here", "go on")

    monkeypatch.setattr(loop, "design", refuse)
    done = run("design", "--batch", "list.csv", "--target", "45/min", "-o", "out")
    assert done.exit_code == 1 and done.stderr.count("is not designed here") == 2
    assert asked == [("washer_m6", pytest.approx(30.0), "A"), ("dowel_6x20", pytest.approx(45.0), None)]
    with (list_of_two / "out/designs/designs.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert [float(row["target_per_minute"]) for row in rows] == pytest.approx([30.0, 45.0])
    assert [row["status"] for row in rows] == ["failed", "failed"]


@pytest.mark.parametrize(
    ("call", "said"),
    [
        (["--batch", "list.csv"], "list.csv:4 has no target"),
        (["--batch", "list.csv", "washer_m6.stl", "--target", "45/min"], "--batch goes with one list"),
        (["--batch", "list.csv", "--target", "45/min", "--aspect", "A"], "--aspect is of one part"),
        (["washer_m6.stl"], "Missing option '--target'"),
    ],
)
def test_a_wrong_call_begins_nothing(list_of_two, run, monkeypatch, call, said):
    monkeypatch.setattr(loop, "design", None)
    done = run("design", *call)
    assert done.exit_code == 2 and said in done.stderr


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (HEAD + "a.stl,fast,\n", "list.csv:2: target 'fast' is no rate"),
        (HEAD + ",40/min,\n", "list.csv:2: names no part"),
        ("part,rate\na.stl,3\n", "is not the head of a list"),
        (HEAD, "lists no part"),
    ],
)
def test_a_wrong_list_is_one_line(tmp_path, text, said):
    (tmp_path / "list.csv").write_text(text)
    with pytest.raises(errors.ConfigError) as fault:
        read_orders(str(tmp_path / "list.csv"))
    assert said in str(fault.value)


@pytest.fixture
def wanted_block(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    shapes.box(8.0, 12.0, 20.0).export(tmp_path / "block.stl")
    return tmp_path / "block.stl"


def row(request, rule="closed", **choices):
    choices["rule"] = rule
    made = work.work(task.Task.of(request, batch.Choices(**choices), Path(request.source).read_bytes()))
    assert made.status == task.DONE, made.reason
    return made


def test_a_list_asks_for_an_aspect(wanted_block, tmp_path):
    (tmp_path / "list.csv").write_text("part,aspect\nblock.stl,\nblock.stl,C\nblock.stl,q\n")
    usual, wanted, none = batch.gather(["list.csv"])
    assert (usual.aspect, wanted.aspect) == (None, "C") and wanted.name == "block-2"
    made = row(wanted)
    assert made.row["aspect"] == "C" and made.row["orientation"].startswith("C@")
    part = load(str(wanted_block))
    assert made.files[work.THUMBNAIL] == batch_output.thumbnail(part, find(part), "C")
    assert made.files[work.THUMBNAIL] != row(usual).files[work.THUMBNAIL]
    failed = work.work(task.Task.of(none, batch.Choices(), wanted_block.read_bytes()))
    assert failed.reason == "list.csv:4: aspect of block.stl: there is no aspect 'q' - choose one of A, B, C"


def test_the_launch_and_the_drops_are_the_answer(wanted_block):
    (asked,) = batch.gather([str(wanted_block)])
    placed, fed = (row(asked, "recommended", launch=launch, pictures=False) for launch in ("place", "feed"))
    assert placed.row["answer"].endswith("launch place") and fed.row["answer"].endswith("launch feed")
    assert placed.key != fed.key and placed.effective["launch"] == "place"
    dropped = row(asked, "recommended", drops=200, pictures=False)
    assert dropped.row["answer"] == "drop test, launch feed"
    assert dropped.row["aspect"] == dropped.row["drop_aspect"]
    assert dropped.row["p_orientation"] <= dropped.row["p_drop"]


@pytest.mark.parametrize("count", [1, summary.TILES + 1])
def test_tiles_name_the_orientation_and_fill_sheets(count):
    made = {"folder": "block", "status": task.DONE, "orientation": "C@90", "parts_per_minute": 12.0}

    class Store:
        def file(self, folder, name):
            return b"PNG"

    sheets = list(summary.sheets(Store(), [made] * count))
    assert sheets[0][0] == (b"PNG", "block", "C@90: 12 / min")
    assert sum(map(len, sheets)) == count and len(sheets) == -(-count // summary.TILES)
    card = {
        **made,
        "orientation": None,
        "parts_per_minute": None,
        "note": "a part card has no outline: no rate",
    }
    assert next(summary.sheets(Store(), [card]))[0][2] == "a part card has no outline: no rate"


@pytest.mark.parametrize("advice", [topology.SAVE_SHELLS, gate.CLOSE_IN_CAD, gate.UNITE_IN_CAD])
def test_a_failed_part_is_not_advised_what_a_batch_has_no_option_for(wanted_block, advice):
    (asked,) = batch.gather([str(wanted_block)])
    failed = task.Outcome.failed(task.Task.of(asked, batch.Choices(), b""), f"is not closed - {advice}")
    assert "allow_open" not in failed.reason
    assert failed.reason.endswith(re.split(r"[,;] or pass", advice)[0])
