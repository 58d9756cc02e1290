"""``feeder batch``: what it prints, writes and leaves with."""

import io
import json
import os
import signal
import subprocess
import sys

import pytest
from command_lines import NUT, PARTS, names, rows

from feederscrew.jobs import batch as batches
from feederscrew_cli import progress

WASHER = PARTS / "washer_m6.stl"
QUICK = ("-o", "out", "--jobs", "1", "--no-pictures")


def test_a_batch_writes_a_summary_and_a_folder_a_part_with_drops_of_a_seed_of_its_own(run, tmp_path):
    done = run("batch", NUT, WASHER, *QUICK, "--drops", "50", "--format", "csv")
    assert (done.exit_code, done.stderr) == (0, "Wrote out (2 parts; open index.html)\n")
    assert done.stdout == (tmp_path / "out/summary.csv").read_text()
    assert names(tmp_path / "out/parts") == {"squarenut_m5", "washer_m6"}
    for row in rows(done.stdout):
        folder = tmp_path / "out/parts" / row["folder"]
        record, dropped = (json.loads((folder / name).read_text()) for name in ("run.json", "drop.json"))
        tables = {"aspects.csv", "aspects.json", "convey.json", "drop.csv", "drop.json", "names.yaml"}
        record = record["batch"]
        assert set(record["files"]) == tables | {"orientations.csv", "rate.json"}
        assert record["effective"]["drive.frequency"] == "50 Hz" and row["drops"] == "50"
        assert float(row["p_drop"]) == max(aspect["p_drop"] for aspect in dropped["aspects"])
        assert dropped["seed"] == int(record["inputs"][0]["sha256"][:8], 16)


def test_a_bad_part_is_one_line_a_row_and_status_1_and_resume_says_what_it_kept(run, tmp_path):
    (tmp_path / "bad.stl").write_bytes(b"")
    call = ("batch", NUT, "bad.stl", "gone.stl", *QUICK, "--rule", "closed")
    done, again = run(*call), run(*call, "--resume")
    faults = ["bad.stl: is empty - export the part again", "gone.stl: no such file - check the path"]
    lines = [*(f"Error: {fault}" for fault in faults), "Wrote out (3 parts; open index.html)"]
    assert (done.exit_code, again.exit_code) == (1, 1) and done.stderr.splitlines()[:3] == lines
    assert [row["reason"] for row in rows(tmp_path / "out/summary.csv")] == ["", *faults]
    assert "Wrote out (3 parts, 1 of them as they were; open index.html)\n" in again.stderr


def test_a_batch_that_is_stopped_names_resume_and_resume_says_why(run, tmp_path, monkeypatch):
    class StopsAfterOne(batches.Processes):
        def outcomes(self, tasks):
            yield next(super().outcomes(tasks))
            raise KeyboardInterrupt

    call = ("batch", NUT, WASHER, *QUICK, "--rule", "csa")
    with monkeypatch.context() as patch:
        patch.setattr(batches, "crew", lambda jobs, scheduler: StopsAfterOne(jobs))
        done = run(*call)
    assert (done.exit_code, done.stdout) == (130, "")
    assert done.stderr.splitlines()[-1] == "Stopped: 1 of 2 parts is done; go on with --resume"
    assert [row["status"] for row in rows(tmp_path / "out/summary.csv")] == ["done", "not computed"]
    again = run(*call, "--resume")
    assert again.exit_code == 0 and again.stderr.splitlines()[0] == "Computes 1 of 2 parts: 1 new"
    assert "Computes" not in run(*call, "--resume").stderr


def test_each_fault_of_a_list_and_of_its_files_is_a_line_with_its_place(run, tmp_path):
    """The first of two faults of a file of names was a traceback."""
    (tmp_path / "names.yaml").write_text("aspects:\n  A: 3\n  B: 4\n")
    unknown = f"list.csv:3: {NUT}: density: no material is called"
    for text, faults, begin in (
        (f"part,names\n{NUT},names.yaml\n", 2, "names.yaml:2:6: "),
        (f"part,density\n{NUT},steel\n{NUT},heavy\n", 1, unknown),
    ):
        (tmp_path / "list.csv").write_text(text)
        done = run("batch", "list.csv", *QUICK, "--rule", "closed")
        assert done.exit_code == 1 and done.stderr.count("Error: ") == faults
        assert done.stderr.startswith(f"Error: {begin}")


@pytest.mark.skipif(os.name == "nt", reason="signals of POSIX")
@pytest.mark.parametrize("name", ["SIGINT", "SIGTERM", "SIGHUP"])
def test_an_interrupt_that_a_library_drops_still_ends_the_program(name):
    code = "import contextlib, time\nfrom feederscrew_cli.interrupt import end_within\n"
    code += "with end_within(0.2):\n    while True:\n        with contextlib.suppress(KeyboardInterrupt):\n"
    code += "            print('ready', flush=True)\n            time.sleep(60)\n"
    child = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    assert child.stdout.readline() == b"ready\n"
    child.send_signal(getattr(signal, name))
    assert child.communicate(timeout=8.0)[1] == b"Stopped.\n"
    assert child.returncode == 128 + getattr(signal, name)


def test_a_long_run_says_where_it_is_in_a_file_and_by_a_bar_with_the_time_to_go(monkeypatch, capsys):
    """A line every 15 s where stderr is no terminal, by the pace since the first: compiling is no pace."""
    clock = iter([100.0, 116.0, 117.0, 119.0, 140.0])
    monkeypatch.setattr(progress.time, "monotonic", lambda: next(clock))
    monkeypatch.setattr(progress, "LINE_EVERY_S", 2.0)
    with progress.Progress(None, what="orientations") as shown:
        shown.reach(1, 4)
        shown.reach(2, 4)
        shown.reach(3, 4)
    lines = "orientations: 1 of 4 after 16 s\norientations: 3 of 4 after 19 s, about 2 s to go\n"
    assert capsys.readouterr().err == lines
    screen = io.StringIO()
    screen.isatty = lambda: True
    monkeypatch.setattr(progress.sys, "stderr", screen)
    monkeypatch.setattr(progress.time, "monotonic", lambda: 0.0)
    shown = progress.StageBar()
    shown.reach("draws", 5, 20, 30.0, 90.0)
    bar = screen.getvalue()
    assert "draws: 5 of 20" in bar and "30 s gone, about 90 s to go if it holds" in bar and "\n" not in bar
    for _ in range(2):  # what is cleared is cleared once
        shown.clear()
        assert screen.getvalue() == f"{bar}\r\033[K"
