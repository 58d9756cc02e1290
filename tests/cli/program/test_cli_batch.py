"""``feeder batch``: what it prints, writes and leaves with."""

import json
import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from feederscrew import batch as batches
from feederscrew_cli import progress

ROOT = Path(__file__).parents[3]
NUT = ROOT / "parts/squarenut_m5.stl"
WASHER = ROOT / "parts/washer_m6.stl"


def test_a_batch_writes_a_summary_and_a_folder_a_part(run, tmp_path):
    done = run("batch", NUT, WASHER, "-o", "out", "--jobs", "1", "--no-pictures", "--format", "csv")
    assert done.exit_code == 0
    assert done.stderr == "Wrote out (2 parts; open index.html)\n"
    assert done.stdout == (tmp_path / "out/summary.csv").read_text()
    assert sorted(p.name for p in (tmp_path / "out/parts").iterdir()) == ["squarenut_m5", "washer_m6"]
    record = json.loads((tmp_path / "out/parts/washer_m6/run.json").read_text())["batch"]
    assert set(record["files"]) == {
        "aspects.csv",
        "aspects.json",
        "convey.json",
        "names.yaml",
        "orientations.csv",
        "rate.json",
    }
    assert record["effective"]["drive.frequency"] == "50 Hz"


def test_a_bad_part_is_one_line_and_status_1_and_resume_says_what_it_kept(run, tmp_path):
    (tmp_path / "bad.stl").write_bytes(b"")
    call = ("batch", NUT, "bad.stl", "-o", "out", "--jobs", "1", "--no-pictures", "--rule", "closed")
    done = run(*call)
    assert done.exit_code == 1
    assert done.stderr.startswith(
        "Error: bad.stl: is empty - export the part again\nWrote out (2 parts; open index.html)\n"
    )
    again = run(*call, "--resume")
    assert again.exit_code == 1
    assert "Wrote out (2 parts, 1 of them as they were; open index.html)\n" in again.stderr


def test_a_batch_that_is_stopped_names_resume_and_resume_says_why(run, tmp_path, monkeypatch):
    class StopsAfterOne(batches.Processes):
        def outcomes(self, tasks):
            yield next(super().outcomes(tasks))
            raise KeyboardInterrupt

    call = ("batch", NUT, WASHER, "-o", "out", "--jobs", "1", "--no-pictures", "--rule", "csa")
    with monkeypatch.context() as patch:
        patch.setattr(batches, "crew", lambda jobs, scheduler: StopsAfterOne(jobs))
        done = run(*call)
    assert (done.exit_code, done.stdout) == (130, "")
    assert done.stderr.splitlines()[-1] == "Stopped: 1 of 2 parts is done; go on with --resume"
    rows = (tmp_path / "out/summary.csv").read_text().splitlines()
    assert [(",done," in row, ",not computed," in row) for row in rows[1:]] == [(True, False), (False, True)]
    again = run(*call, "--resume")
    assert again.exit_code == 0 and again.stderr.splitlines()[0] == "Computes 1 of 2 parts: 1 new"
    assert "Computes" not in run(*call, "--resume").stderr


@pytest.mark.parametrize(
    ("option", "value"), [("--density", "stel"), ("--density", ""), ("--set", "drive.frequency=50 mm"),
                          ("--rule", "closd"), ("--scheduler", "nonsense")]
)  # fmt: skip
def test_a_wrong_value_of_an_option_ends_a_batch_before_any_part(run, tmp_path, option, value):
    done = run("batch", NUT, WASHER, "-o", "out", option, value)
    assert (done.exit_code, done.stdout, len(done.stderr.splitlines())) == (2, "", 1)
    assert option in done.stderr and not list((tmp_path).glob("out/parts/*"))


def test_every_fault_of_a_file_of_names_is_a_line(run, tmp_path):
    """The first of two faults was a traceback."""
    (tmp_path / "names.yaml").write_text("aspects:\n  A: 3\n  B: 4\n")
    (tmp_path / "list.csv").write_text(f"part,names\n{NUT},names.yaml\n")
    done = run("batch", "list.csv", "-o", "out")
    assert (done.exit_code, len(done.stderr.splitlines())) == (1, 2) and "names.yaml:2:6" in done.stderr


def test_drops_add_a_drop_test_with_a_seed_from_the_part(run, tmp_path):
    done = run("batch", NUT, "-o", "out", "--jobs", "1", "--no-pictures", "--drops", "50", "--format", "json")
    [row] = json.loads(done.stdout)["parts"]
    assert row["drops"] == 50
    dropped = json.loads((tmp_path / "out/parts/squarenut_m5/drop.json").read_text())
    assert row["p_drop"] == max(aspect["p_drop"] for aspect in dropped["aspects"])
    record = json.loads((tmp_path / "out/parts/squarenut_m5/run.json").read_text())["batch"]
    assert dropped["seed"] == int(record["inputs"][0]["sha256"][:8], 16)


@pytest.mark.parametrize(
    ("call", "status", "line"),
    [
        (["nut.stl"], 2, "Error: Missing option '-o' - say where the results go (see feeder batch --help)"),
        (["nut.stl", "-o", "out", "--jobs", "0"], 2, "'0' is not a number of processes - give 1, 2, ..."),
    ],
)
def test_a_wrong_call_is_one_line(run, call, status, line):
    done = run("batch", *call)
    assert done.exit_code == status
    assert line in done.stderr
    assert done.stderr.count("\n") == 1


@pytest.mark.skipif(os.name == "nt", reason="signals of POSIX")
@pytest.mark.parametrize("name", ["SIGINT", "SIGTERM", "SIGHUP"])
def test_an_interrupt_that_a_library_drops_still_ends_the_program(name):
    code = (
        "import time\nfrom feederscrew_cli.interrupt import ended_within\nwith ended_within(0.2):\n"
        "    while True:\n        try:\n            print('ready', flush=True)\n            time.sleep(60)\n"
        "        except KeyboardInterrupt:\n            pass\n"
    )
    child = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    assert child.stdout.readline() == b"ready\n"
    child.send_signal(getattr(signal, name))
    assert child.communicate(timeout=8.0)[1] == b"Stopped.\n"
    assert child.returncode == 130


def test_a_long_run_says_where_it_is_in_a_file_too(monkeypatch, capsys):
    """A line every 15 s where stderr is no terminal: here at once, after 2 of 4 in 3 s."""
    clock = iter([100.0, 100.5, 103.0, 120.0])
    monkeypatch.setattr(progress.time, "monotonic", lambda: next(clock))
    monkeypatch.setattr(progress, "LINE_EVERY_S", 2.0)
    with progress.Progress(None, what="orientations") as shown:
        shown.reach(1, 4)
        shown.reach(2, 4)
    assert capsys.readouterr().err == "orientations: 2 of 4 after 3 s, about 3 s to go\n"
