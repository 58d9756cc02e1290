"""``feeder drop``: its columns, its files, its errors."""

import csv
import json
from pathlib import Path

import pytest
import shapes

PARTS = Path(__file__).parent.parent / "parts"
COLUMNS = ["aspect", "height_mm", "count", "p_drop", "p_drop_low", "p_drop_high", "p_gentle", "p_violent"]


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
    assert told["drops"] == 600 and told["seed"] == 7 and told["launch"]["name"] == "tumble"
    assert set(told["launch"]) == {
        "name",
        "height_mm",
        "spin_rad_s",
        "speed_mm_s",
        "restitution",
        "friction",
        "forward",
    }
    assert [list(row) for row in told["aspects"]] == [COLUMNS] * 3
    assert sum(row["count"] for row in told["aspects"]) + told["unsettled"] == 600
    assert all(row["p_drop_low"] <= row["p_drop"] <= row["p_drop_high"] for row in told["aspects"])


def test_the_seed_and_not_the_jobs_decides(run, stl):
    def call(seed, jobs):
        rows = document(run("drop", stl, "--drops", 700, "--seed", seed, "--jobs", jobs, "--format", "json"))
        return [row["count"] for row in rows["aspects"]]

    assert call(1, 1) == call(1, 2) != call(2, 1)


def test_the_files(run, stl, tmp_path):
    done = run("drop", stl, "--drops", "300", "-o", "results")
    assert done.exit_code == 0, done.output
    folder = tmp_path / "results/box"
    assert {path.name for path in folder.iterdir()} == {"drop.csv", "drop.json", "drop.png", "run.json"}
    rows = list(csv.DictReader((folder / "drop.csv").read_text().splitlines()))
    assert list(rows[0]) == COLUMNS and [row["aspect"] for row in rows] == ["A", "B", "C"]
    before = (folder / "drop.png").read_bytes()
    run("drop", stl, "--drops", "300", "-o", "results")
    assert (folder / "drop.png").read_bytes() == before


def test_until_narrows_the_intervals(run, stl):
    told = document(run("drop", stl, "--until", "2%", "--format", "json"))
    assert told["drops"] % 2000 == 0
    assert max(row["p_drop_high"] - row["p_drop_low"] for row in told["aspects"]) <= 0.04


def test_own_conditions_are_told(run, stl):
    told = document(
        run("drop", stl, "--drops", 50, "--height", "20 mm", "--friction", "0.3", "--format", "json")
    )
    assert told["launch"]["name"] == "own"
    assert told["launch"]["height_mm"] == pytest.approx([20.0, 20.0])
    assert told["launch"]["friction"] == [0.3, 0.3]


@pytest.mark.parametrize(
    ("arguments", "status", "line"),
    [
        (("--height", "20"), 1, "Error: --height: '20' has no unit - write 20 mm"),
        (
            ("--until", "90%"),
            1,
            "Error: --until: '90%' is out of range - stay from 0.0001 to 0.5 (for this part)",
        ),
        (("--launch", "kick"), 2, "Error: Invalid value for '--launch'"),
        (("--drops", "0"), 2, "Error: Invalid value for '--drops'"),
    ],
)
def test_faults_are_one_line(run, stl, arguments, status, line):
    done = run("drop", stl, *arguments)
    told = [each for each in done.stderr.splitlines() if not each.startswith("Compiling")]
    assert done.exit_code == status and len(told) == 1 and told[0].startswith(line)
    assert done.stdout == ""


def test_a_card_cannot_be_dropped(run):
    done = run("drop", PARTS / "arc_chute.yaml")
    assert done.exit_code == 1 and "has no shape to tumble" in done.stderr
