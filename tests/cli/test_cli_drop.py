"""``feeder drop``: its columns, its files, its errors; the plate and the launches of a file."""

import contextlib
import json
import os
import re
import signal
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest
import shapes
from command_lines import ROOT, names, rows

from feederscrew import bowl as bowls
from feederscrew.arrivals.drop import shake as plate_study
from feederscrew.output import plate as plate_output
from feederscrew.output.tables import data_frame
from feederscrew_cli import interrupt

COLUMNS = [
    *("aspect", "height_mm", "count", "p_drop", "p_drop_low", "p_drop_high", "p_gentle", "p_violent"),
    *("p_restitution", "unsettled_share"),
]
HEAD = ["bowl", "amplitude_mm", "throw_number"]
PLATE_COLUMNS = [
    *HEAD, "aspect", "height_mm", "p_start", "p_plate", "p_plate_low", "p_plate_high", "p_limit",
    "p_limit_low", "p_limit_high", "velocity_mm_s", "velocity_low_mm_s", "velocity_high_mm_s",
]  # fmt: skip
RATES = [*HEAD, "from", "to", "count", "rate_per_s", "rate_low_per_s", "rate_high_per_s"]
SHORT = ("--plate", "--drops", 30, "--seconds", "0.5")


@pytest.fixture
def stl(request, tmp_path):
    shapes.box(*getattr(request, "param", (10.0, 13.0, 17.0))).export(tmp_path / "box.stl")
    return tmp_path / "box.stl"


small = pytest.mark.parametrize("stl", [(4.0, 5.0, 6.0)], indirect=True)


def test_the_contract_and_files_that_are_the_same_bytes_each_time(run_json, stl, tmp_path):
    call = ("drop", stl, "--drops", "300", "--seed", "7", "--trace", "3", "-o", "results")
    document, folder = run_json(*call), tmp_path / "results/box"
    assert list(document)[:6] == ["part", "drops", "seed", "launch", "partial", "unsettled"]
    assert (document["drops"], document["seed"], document["launch"]["name"]) == (300, 7, "feed")
    ranges = {"height_mm", "spin_rad_s", "speed_mm_s", "restitution", "friction"}
    assert set(document["launch"]) == {"name", "axis"} | ranges and document["until"] is None
    aspects, traces = document["aspects"], document["traces"]
    assert [list(row) for row in aspects] == [COLUMNS] * 3
    assert sum(row["count"] for row in aspects) + document["unsettled"] == 300
    wide = max(row["p_drop_high"] - row["p_drop_low"] for row in aspects)
    assert document["widest"] < 0.5 * wide <= document["widest"] + 0.12  # and what the launch leaves open
    assert all(row["p_drop_low"] <= row["p_drop"] <= row["p_drop_high"] for row in aspects)
    tables = {"drop.csv", "drop.json", "drop_traces.csv", "run.json"}
    assert names(folder) == tables | {"drop.png", "drop_trace.png"}
    table = rows(folder / "drop.csv")
    assert list(table[0]) == COLUMNS and [row["aspect"] for row in table] == ["A", "B", "C"]
    assert [float(row["height_mm"]) for row in table] == [5.0, 6.5, 8.5]  # half the sides of the box
    assert [trace["drop"] for trace in traces] == [1, 2, 3]
    for trace in traces:
        path = [row for row in rows(folder / "drop_traces.csv") if row["drop"] == str(trace["drop"])]
        assert {row["aspect"] for row in path} == {trace["aspect"]} and trace["still"]
        assert float(path[-1]["time_s"]) >= trace["counted_s"]
    files = {path: path.read_bytes() for path in folder.iterdir() if path.name != "run.json"}
    run_json(*call)
    assert {path: path.read_bytes() for path in files} == files
    run_json(*call, "--no-pictures")
    assert names(folder) == tables


def test_one_value_of_restitution_scatters_and_says_what_that_does(run, stl):
    call = ("drop", stl, "--drops", 400, "--restitution")
    done, exact = (run(*call, value, "--format", "json") for value in ("0.5", "0.5:0.5"))
    one, two = json.loads(done.stdout), json.loads(exact.stdout)
    assert one["launch"]["restitution"] == pytest.approx([0.361436, 0.638564])
    said = r"restitution 0\.5 scatters from 0\.361 to 0\.639, .* reaches [\d.]+ % further"
    assert re.search(said, done.stderr) and "scatters" not in exact.stderr
    assert two["launch"]["restitution"] == [0.5, 0.5]
    assert {row["p_restitution"] for row in two["aspects"]} == {0.0}


def terminal_text(terminal, until):
    """What comes out of a terminal, up to a pattern or to the end."""
    text = ""
    with contextlib.suppress(OSError):  # how Linux says that nobody writes to it any more
        while not re.search(until, text) and (more := os.read(terminal, 4096)):
            text += more.decode()
    return text


@pytest.mark.skipif(os.name == "nt", reason="no interrupt to send")
def test_an_interrupt_prints_and_writes_what_is_there(run_json, stl, tmp_path):
    import pty

    terminal, stderr = pty.openpty()
    code = "from feederscrew_cli.main import feeder; feeder()"
    call = [sys.executable, "-c", code, "drop", stl, "-o", "results", "--drops", "10000000", "--trace", "2"]
    call = [*map(str, call), "--format", "csv", "--jobs", "1"]
    own = {"env": os.environ | {"PYTHONPATH": str(ROOT)}, "cwd": tmp_path, "text": True}
    running = subprocess.Popen(call, stdout=subprocess.PIPE, stderr=stderr, **own)
    os.close(stderr)
    assert "1000/10000000" in terminal_text(terminal, "] +1000/")
    running.send_signal(signal.SIGINT)
    err = terminal_text(terminal, "Wrote .*\n").replace("\r\n", "\n")
    os.close(terminal)
    out, _ = running.communicate(timeout=60)
    assert running.returncode == 130, err
    folder = tmp_path / "results/box"
    document = json.loads((folder / "drop.json").read_text())
    drops = document["drops"]
    assert f"Warning: partial: stopped after {drops} drops\n" in err and "Traceback" not in err
    assert document["partial"] and drops % 250 == 0 and len(document["traces"]) == 2
    assert out == (folder / "drop.csv").read_text()
    assert [row["partial"] for row in rows(out)] == ["True"] * 3
    assert "partial: stopped" in json.loads((folder / "run.json").read_text())["drop"]["warnings"][-1]
    whole = run_json("drop", stl, "--drops", drops)
    assert [str(row["count"]) for row in whole["aspects"]] == [row["count"] for row in rows(out)]


def test_an_interrupt_is_held_back_and_one_that_a_library_drops_is_heard_at_the_next_word():
    before = signal.getsignal(signal.SIGINT)
    with interrupt.note_interrupts() as again:
        again()
        with contextlib.suppress(KeyboardInterrupt):
            signal.raise_signal(signal.SIGINT)
            pytest.fail("nothing was raised")
        with pytest.raises(KeyboardInterrupt):
            again()
    assert signal.getsignal(signal.SIGINT) is before
    done = []
    with pytest.raises(KeyboardInterrupt), interrupt.hold_interrupts():
        signal.raise_signal(signal.SIGINT)
        done.append("all")
    with pytest.raises(KeyboardInterrupt), interrupt.hold_interrupts():
        signal.raise_signal(signal.SIGINT)
        signal.raise_signal(signal.SIGINT)
        done.append("too much")
    assert done == ["all"] and signal.getsignal(signal.SIGINT) is signal.default_int_handler


LAUNCHES = """# made up; 100 frames/s
toss,frames_100Hz,x0_m,y0_m,z0_m,qw0,qx0,qy0,qz0,vx0,vy0,vz0,wx0,wy0,wz0,xe_m,ye_m,face_up_end
4,80,0,0,0.00851,1,0,0,0,0,0,0,0,0,0,0,0,+z
7,90,0,0,0.00851,0,1,0,0,0.2,0,0,0,0,0,0.02,0,-z
"""


def test_launches_of_a_file_are_followed_one_by_one(run, run_json, stl, tmp_path):
    (tmp_path / "launches.csv").write_text(LAUNCHES)
    call = ("drop", stl, "--launches", "launches.csv", "--friction", "0.3", "--drops", "5")
    document = run_json(*call)
    first, second = document["tosses"]
    assert [first[name] for name in ("toss", "face_up", "p")] == [4, "+z", 1]
    assert [second[name] for name in ("toss", "face_up", "p")] == [7, "-z", 1]
    assert first["x_mm"] == pytest.approx(0.0, abs=1.0) and second["x_mm"] > 3.0
    assert (document["runs"], document["frame_s"], document["friction"]) == (5, 0.01, [0.3, 0.3])
    assert document["measured"]["told"] == 1.0 and document["measured"]["median_off_mm"] < 20.0
    assert "100.0 % of the upper sides are as measured" in run(*call, "-o", "results").stderr
    folder = tmp_path / "results/box"
    assert names(folder) == {"tosses.csv", "tosses.json", "tosses.png", "run.json"}
    inputs = json.loads((folder / "run.json").read_text())["drop launches"]["inputs"]
    assert [Path(file["path"]).name for file in inputs] == ["box.stl", "launches.csv"]


@small
def test_json_of_one_plate(run_json, stl):
    own = ("--config", ROOT / "configs/bowl.yaml", "--set", "drive.amplitude=0.4 mm")
    document = run_json("drop", stl, *SHORT, *own)
    assert list(document) == ["part", "seed", "launch", "partial", "plates"]
    (plate,) = document["plates"]
    assert (plate["bowl"], plate["drops"], plate["unsettled"]) == ("bowl", 30, 0)
    assert [plate["amplitude_mm"], plate["seconds"]] == pytest.approx([0.4, 0.5])
    assert plate["restitution"] == pytest.approx([0.1446, 0.2554], abs=1e-4)  # parts hop: it scatters
    assert plate["friction"] == [0.6, 0.6]
    assert plate["velocity_low_mm_s"] <= plate["velocity_mm_s"] <= plate["velocity_high_mm_s"]
    assert [list(row) for row in plate["aspects"]] == [PLATE_COLUMNS[3:]] * 3
    assert sum(row["p_start"] for row in plate["aspects"]) == pytest.approx(1.0)
    assert list(plate["rates"][0]) == RATES[3:]
    transitions = sum(row["count"] for row in plate["rates"] if row["from"] != row["to"])
    assert plate["transitions_seen"] == transitions


@small
def test_the_files_of_plates_and_the_trend(run, stl, tmp_path):
    own = ("--set", "drive.amplitude=0.5 mm", "--amplitude", "78%,80%,0.41 mm")
    done = run("drop", stl, *SHORT, *own, "-o", "results")
    assert done.exit_code == 0, done.output
    folder = tmp_path / "results/box"
    tables = {f"plate{table}.csv" for table in ("", "_drives", "_rates", "_time")}
    assert names(folder) == tables | {"plate.json", "plate.png", "run.json"}
    plates, drives = rows(folder / "plate.csv"), rows(folder / "plate_drives.csv")
    assert list(drives[0])[:3] == HEAD and len(drives) == 3
    assert f"travels at {float(drives[0]['velocity_mm_s']):.4g} mm/s" in done.stderr
    assert list(plates[0]) == PLATE_COLUMNS and len(plates) == 9
    assert [float(row["amplitude_mm"]) for row in plates[::3]] == pytest.approx([0.39, 0.40, 0.41])
    assert list(rows(folder / "plate_rates.csv")[0]) == RATES
    course = rows(folder / "plate_time.csv")
    assert list(course[0]) == [*HEAD, "time_s", "aspect", "p"]
    assert float(course[-1]["time_s"]) == pytest.approx(0.5) and len(course) % 9 == 0
    record = json.loads((folder / "run.json").read_text())["drop plate"]
    assert record["effective"]["defaults"]["drive.amplitude"] == "0.5 mm"


def test_a_plate_that_was_stopped_is_marked_everywhere():
    part, bowl = shapes.part(shapes.box(4.0, 5.0, 6.0)), bowls.record(bowls.settings(path=None, overrides=()))
    study = plate_study(part, [bowl, bowl], "place", names=["one", "two"], drops=10, seconds=0.2)
    whole, cut = study.plates
    stopped = replace(study, plates=(whole, replace(cut, partial=True)))
    for table in (type(study).table, type(study).rates_table, type(study).course_table):
        marks = data_frame(table(stopped)).groupby("bowl")["partial"].agg(["min", "max"])
        assert marks.to_numpy().tolist() == [[False, False], [True, True]]
        assert "partial" not in table(study)
    assert stopped.drives_table()["partial"].tolist() == [False, True]
    assert plate_output.document(stopped)["partial"]
    line = f"partial: stopped after 10 parts on the plate of two at {1e3 * bowl.drive.amplitude:.4g} mm"
    assert plate_output.remarks(stopped)[-1] == line
