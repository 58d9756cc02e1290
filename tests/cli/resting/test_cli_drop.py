"""``feeder drop``: its columns, its files, its errors."""

import contextlib
import csv
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

from feederscrew import bowl as bowls
from feederscrew.dropping import ensemble
from feederscrew.output import plate as plate_output
from feederscrew.output.tables import data_frame
from feederscrew.studies.drop import shake as plate_study
from feederscrew_cli import interrupt

PARTS = Path(__file__).parents[3] / "parts"
COLUMNS = [
    *("aspect", "height_mm", "count", "p_drop", "p_drop_low", "p_drop_high", "p_gentle", "p_violent"),
    *("p_restitution", "unsettled_share"),
]


@pytest.fixture
def stl(tmp_path):
    path = tmp_path / "box.stl"
    shapes.box(10.0, 13.0, 17.0).export(path)
    return path


def document(done):
    assert done.exit_code == 0, done.output
    return json.loads(done.stdout)


def test_json_is_the_contract(run, stl):
    told = document(run("drop", stl, "--drops", "600", "--seed", "7", "--format", "json"))
    assert list(told)[:6] == ["part", "drops", "seed", "launch", "partial", "unsettled"]
    assert told["drops"] == 600 and told["seed"] == 7 and told["launch"]["name"] == "feed"
    ranges = ("height_mm", "spin_rad_s", "speed_mm_s", "restitution", "friction")
    assert set(told["launch"]) == {"name", *ranges, "axis"}
    assert [list(row) for row in told["aspects"]] == [COLUMNS] * 3
    assert sum(row["count"] for row in told["aspects"]) + told["unsettled"] == 600
    assert told["until"] is None and told["traces"] == []
    wide = max(row["p_drop_high"] - row["p_drop_low"] for row in told["aspects"])
    assert told["widest"] < 0.5 * wide <= told["widest"] + 0.12  # what the launch leaves open beside it
    assert all(row["p_drop_low"] <= row["p_drop"] <= row["p_drop_high"] for row in told["aspects"])


def test_the_files(run, stl, tmp_path):
    done = run("drop", stl, "--drops", "300", "-o", "results")
    assert done.exit_code == 0, done.output
    folder = tmp_path / "results/box"
    assert {path.name for path in folder.iterdir()} == {"drop.csv", "drop.json", "drop.png", "run.json"}
    rows = list(csv.DictReader((folder / "drop.csv").read_text().splitlines()))
    assert list(rows[0]) == COLUMNS and [row["aspect"] for row in rows] == ["A", "B", "C"]
    assert [float(row["height_mm"]) for row in rows] == [5.0, 6.5, 8.5]  # half the sides of the box
    before = (folder / "drop.png").read_bytes()
    run("drop", stl, "--drops", "300", "-o", "results")
    assert (folder / "drop.png").read_bytes() == before


def test_one_value_of_restitution_scatters_and_says_what_that_does(run, stl):
    done = run("drop", stl, "--drops", 400, "--restitution", "0.5", "--format", "json")
    assert document(done)["launch"]["restitution"] == pytest.approx([0.361436, 0.638564])
    assert re.search(
        r"restitution 0\.5 scatters from 0\.361 to 0\.639, .* reaches [\d.]+ % further", done.stderr
    )
    exact = run("drop", stl, "--drops", 400, "--restitution", "0.5:0.5", "--format", "json")
    assert document(exact)["launch"]["restitution"] == [0.5, 0.5] and "scatters" not in exact.stderr
    assert {row["p_restitution"] for row in document(exact)["aspects"]} == {0.0}


@pytest.mark.parametrize(
    ("arguments", "status", "line"),
    [
        (("--height", "99 m"), 2, "Error: --height: '99 m' is out of range - give 0 mm to 13000 mm"),
        (("--until", "90%"), 2, "Error: --until: '90%' is out of range - give 0.01% to 50%"),
        (("--trace", "3"), 2, "Error: --trace writes files: give -o DIR as well (see feeder drop --help)"),
    ],
)
def test_faults_are_one_line(run, stl, arguments, status, line):
    done = run("drop", stl, *arguments)
    told = done.stderr.splitlines()  # and nothing is said of a compiler
    assert done.exit_code == status and len(told) == 1 and told[0].startswith(line)
    assert done.stdout == ""


def test_traces_are_written(run, stl, tmp_path):
    call = ("drop", stl, "--drops", "40", "--trace", "3", "-o", "results", "--format", "json")
    told = document(run(*call))
    folder = tmp_path / "results/box"
    names = ["drop.csv", "drop.json", "drop.png", "drop_trace.png", "drop_traces.csv", "run.json"]
    assert sorted(path.name for path in folder.iterdir()) == names
    rows = list(csv.DictReader((folder / "drop_traces.csv").read_text().splitlines()))
    assert [each["drop"] for each in told["traces"]] == [1, 2, 3]
    for each in told["traces"]:
        mine = [row for row in rows if row["drop"] == str(each["drop"])]
        assert {row["aspect"] for row in mine} == {each["aspect"]}
        assert float(mine[-1]["time_s"]) >= each["counted_s"] and each["still"]
    before = {name: (folder / name).read_bytes() for name in names[:-1]}
    document(run(*call))
    assert {name: (folder / name).read_bytes() for name in names[:-1]} == before
    document(run(*call, "--no-pictures"))
    assert sorted(path.name for path in folder.iterdir()) == [
        name for name in names if not name.endswith(".png")
    ]


def start(stl, folder, *more, **streams):
    """The program on its own."""
    code = "from feederscrew_cli.main import feeder; feeder()"
    call = [str(each) for each in (sys.executable, "-c", code, "drop", stl, "-o", "results", *more)]
    environment = os.environ | {"PYTHONPATH": str(PARTS.parent)}
    return subprocess.Popen(call, cwd=folder, env=environment, stdout=subprocess.PIPE, text=True, **streams)


def heard(terminal, until):
    """What comes out of a terminal, up to a pattern or to the end."""
    text = ""
    with contextlib.suppress(OSError):  # how Linux says that nobody writes to it any more
        while not re.search(until, text) and (more := os.read(terminal, 4096)):
            text += more.decode()
    return text


@pytest.mark.skipif(os.name == "nt", reason="no interrupt to send")
def test_an_interrupt_prints_and_writes_what_is_there(run, stl, tmp_path):
    import pty

    terminal, stderr = pty.openpty()
    call = ("--drops", "10000000", "--trace", "2", "--format", "csv", "--jobs", "1")
    running = start(stl, tmp_path, *call, stderr=stderr)
    os.close(stderr)
    assert "1000/10000000" in heard(terminal, "] +1000/")
    running.send_signal(signal.SIGINT)
    err = heard(terminal, "Wrote .*\n").replace("\r\n", "\n")
    os.close(terminal)
    out, _ = running.communicate(timeout=60)
    assert running.returncode == 130, err
    folder = tmp_path / "results/box"
    told = json.loads((folder / "drop.json").read_text())
    assert f"Warning: partial: stopped after {told['drops']} drops\n" in err and "Traceback" not in err
    assert told["partial"] and told["drops"] % 250 == 0 and len(told["traces"]) == 2
    rows = list(csv.DictReader(out.splitlines()))
    assert out == (folder / "drop.csv").read_text()
    assert [row["partial"] for row in rows] == ["True"] * 3
    assert sum(int(row["count"]) for row in rows) == told["drops"] - told["unsettled"]
    assert "partial: stopped" in json.loads((folder / "run.json").read_text())["drop"]["warnings"][-1]
    whole = document(run("drop", stl, "--drops", told["drops"], "--format", "json"))
    assert [row["count"] for row in whole["aspects"]] == [int(row["count"]) for row in rows]


def test_an_interrupt_before_the_first_drop_leaves_nothing(run, stl, tmp_path, monkeypatch):
    def stop(*told):
        raise KeyboardInterrupt

    monkeypatch.setattr(ensemble, "sample", stop)
    done = run("drop", stl, "-o", "results")
    assert done.exit_code == 130 and done.stdout == ""
    assert done.stderr.strip() == "Stopped." and not (tmp_path / "results").exists()


def test_an_interrupt_that_a_library_drops_is_heard_at_the_next_word():
    before = signal.getsignal(signal.SIGINT)
    with interrupt.noted() as again:
        again()
        with contextlib.suppress(KeyboardInterrupt):
            signal.raise_signal(signal.SIGINT)
            pytest.fail("nothing was raised")
        with pytest.raises(KeyboardInterrupt):
            again()
    assert signal.getsignal(signal.SIGINT) is before


def test_an_interrupt_is_held_back_and_then_heard():
    done = []
    with pytest.raises(KeyboardInterrupt), interrupt.held_back():
        signal.raise_signal(signal.SIGINT)
        done.append("all")
    assert done == ["all"] and signal.getsignal(signal.SIGINT) is signal.default_int_handler
    with pytest.raises(KeyboardInterrupt), interrupt.held_back():
        signal.raise_signal(signal.SIGINT)
        signal.raise_signal(signal.SIGINT)
        done.append("too much")
    assert done == ["all"]


LAUNCHES = """# made up; 100 frames/s
toss,frames_100Hz,x0_m,y0_m,z0_m,qw0,qx0,qy0,qz0,vx0,vy0,vz0,wx0,wy0,wz0,xe_m,ye_m,face_up_end
4,80,0,0,0.00851,1,0,0,0,0,0,0,0,0,0,0,0,+z
7,90,0,0,0.00851,0,1,0,0,0.2,0,0,0,0,0,0.02,0,-z
"""


def test_launches_of_a_file_are_followed_one_by_one(run, stl, tmp_path):
    (tmp_path / "launches.csv").write_text(LAUNCHES)
    call = ("drop", stl, "--launches", "launches.csv", "--friction", "0.3", "--drops", "5")
    told = document(run(*call, "--format", "json"))
    assert [(row["toss"], row["face_up"], row["p"]) for row in told["tosses"]] == [(4, "+z", 1), (7, "-z", 1)]
    assert told["tosses"][0]["x_mm"] == pytest.approx(0.0, abs=1.0)
    assert told["tosses"][1]["x_mm"] > 3.0
    assert told["runs"] == 5 and told["frame_s"] == 0.01 and told["friction"] == [0.3, 0.3]
    assert told["measured"]["told"] == 1.0 and told["measured"]["median_off_mm"] < 20.0
    done = run(*call, "-o", "results")
    assert "100.0 % of the upper sides are as measured" in done.stderr
    folder = tmp_path / "results/box"
    assert {path.name for path in folder.iterdir()} == {
        "tosses.csv", "tosses.json", "tosses.png", "run.json",
    }  # fmt: skip
    inputs = json.loads((folder / "run.json").read_text())["drop launches"]["inputs"]
    assert [Path(one["path"]).name for one in inputs] == ["box.stl", "launches.csv"]


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (("--launch", "roll"), "--launch cannot be combined with --launches - leave one of them out"),
        (("--spin", "3 rad/s"), "--spin cannot be combined with --launches - leave one of them out"),
        (("--plate",), "--launches is for a plane at rest - leave out --launches or --plate"),
    ],
)
def test_launches_of_a_file_say_what_a_preset_would(run, stl, options, said):
    done = run("drop", stl, "--launches", "launches.csv", *options)
    assert done.exit_code == 2 and said in done.stderr


HEAD = ["bowl", "amplitude_mm", "throw_number"]


PLATE_COLUMNS = [
    *HEAD, "aspect", "height_mm", "p_start", "p_plate", "p_plate_low", "p_plate_high", "p_limit",
    "p_limit_low", "p_limit_high", "velocity_mm_s", "velocity_low_mm_s", "velocity_high_mm_s",
]  # fmt: skip


RATES = [*HEAD, "from", "to", "count", "rate_per_s", "rate_low_per_s", "rate_high_per_s"]


SHORT = ("--plate", "--drops", 30, "--seconds", "0.5")


BOWL = Path(__file__).parents[3] / "configs/bowl.yaml"


AT_REST = "Error: {0} is for a plane at rest - leave out {0} or --plate"


@pytest.fixture
def plate_stl(tmp_path):
    path = tmp_path / "box.stl"
    shapes.box(4.0, 5.0, 6.0).export(path)
    return path


def rows(path):
    return list(csv.DictReader(path.read_text().splitlines()))


def test_json_of_one_plate(run, plate_stl):
    told = document(
        run(
            "drop", plate_stl, *SHORT, "--config", BOWL, "--set", "drive.amplitude=0.4 mm", "--format", "json"
        )
    )
    assert list(told) == ["part", "seed", "launch", "partial", "plates"]
    (plate,) = told["plates"]
    assert plate["bowl"] == "bowl" and plate["amplitude_mm"] == pytest.approx(0.4)
    assert plate["drops"] == 30 and plate["seconds"] == pytest.approx(0.5)
    assert plate["restitution"] == pytest.approx([0.1446, 0.2554], abs=1e-4)  # parts hop: it scatters
    assert plate["friction"] == [0.6, 0.6]
    assert plate["velocity_low_mm_s"] <= plate["velocity_mm_s"] <= plate["velocity_high_mm_s"]
    assert [list(row) for row in plate["aspects"]] == [PLATE_COLUMNS[3:]] * 3
    assert plate["unsettled"] == 0
    assert sum(row["p_start"] for row in plate["aspects"]) == pytest.approx(1.0)
    assert list(plate["rates"][0]) == RATES[3:]
    seen = sum(row["count"] for row in plate["rates"] if row["from"] != row["to"])
    assert plate["transitions_seen"] == seen


def test_the_files_and_the_trend(run, plate_stl, tmp_path):
    own = ("--set", "drive.amplitude=0.5 mm", "--amplitude", "78%,80%,0.41 mm")
    done = run("drop", plate_stl, *SHORT, *own, "-o", "results")
    assert done.exit_code == 0, done.output
    folder = tmp_path / "results/box"
    tables = {f"plate{table}.csv" for table in ("", "_drives", "_rates", "_time")}
    assert {path.name for path in folder.iterdir()} == tables | {"plate.json", "plate.png", "run.json"}
    drives = rows(folder / "plate_drives.csv")
    assert list(drives[0])[:3] == HEAD and len(drives) == 3
    assert f"travels at {float(drives[0]['velocity_mm_s']):.4g} mm/s" in done.stderr
    plates = rows(folder / "plate.csv")
    assert list(plates[0]) == PLATE_COLUMNS and len(plates) == 9
    assert [float(row["amplitude_mm"]) for row in plates[::3]] == pytest.approx([0.39, 0.40, 0.41])
    assert list(rows(folder / "plate_rates.csv")[0]) == RATES
    course = rows(folder / "plate_time.csv")
    assert list(course[0]) == [*HEAD, "time_s", "aspect", "p"]
    assert float(course[-1]["time_s"]) == pytest.approx(0.5) and len(course) % 9 == 0
    told = json.loads((folder / "run.json").read_text())["drop plate"]
    assert told["effective"]["defaults"]["drive.amplitude"] == "0.5 mm"


@pytest.mark.parametrize(
    ("arguments", "status", "line"),
    [
        (("--config", "b.yaml"), 2, "Error: --config is for a vibrating plate - give --plate as well"),
        (("--plate", "--until", "1%"), 2, AT_REST.format("--until")),
        (("--plate", "--amplitude", "0.4"), 2, "Error: --amplitude: drive.amplitude: '0.4' has no unit"),
    ],
)  # fmt: skip
def test_faults_are_one_line_of_plate(run, plate_stl, arguments, status, line):
    done = run("drop", plate_stl, *arguments)
    told = [each for each in done.stderr.splitlines() if each.startswith("Error")]
    assert done.exit_code == status and len(told) == 1 and told[0].startswith(line)
    assert done.stdout == ""


def test_a_plate_that_was_stopped_is_marked_everywhere():
    part, bowl = shapes.part(shapes.box(4.0, 5.0, 6.0)), bowls.record(bowls.settings(path=None, overrides=()))
    study = plate_study(part, [bowl, bowl], "place", names=["one", "two"], drops=10, seconds=0.2)
    whole, cut = study.plates
    stopped = replace(study, plates=(whole, replace(cut, partial=True)))
    for table in (plate_output.plates, plate_output.rates, plate_output.course):
        marks = data_frame(table(stopped)).groupby("bowl")["partial"].agg(["min", "max"])
        assert marks.to_numpy().tolist() == [[False, False], [True, True]]
        assert "partial" not in table(study)
    assert plate_output.drives(stopped)["partial"].tolist() == [False, True]
    assert plate_output.document(stopped)["partial"]
    line = f"partial: stopped after 10 parts on the plate of two at {1e3 * bowl.drive.amplitude:.4g} mm"
    assert plate_output.remarks(stopped)[-1] == line
