"""``feeder drop --plate``: its columns, its files, its trend, its errors."""

import csv
import json
from dataclasses import replace
from pathlib import Path

import pytest
import shapes

from feederscrew import bowl as bowls
from feederscrew.output import plate as plate_output
from feederscrew.output.tables import data_frame
from feederscrew.studies.drop import shake as plate_study

HEAD = ["bowl", "amplitude_mm", "throw_number"]
COLUMNS = [
    *HEAD, "aspect", "height_mm", "p_start", "p_plate", "p_plate_low", "p_plate_high", "p_limit",
    "p_limit_low", "p_limit_high", "velocity_mm_s", "velocity_low_mm_s", "velocity_high_mm_s",
]  # fmt: skip
RATES = [*HEAD, "from", "to", "count", "rate_per_s", "rate_low_per_s", "rate_high_per_s"]
SHORT = ("--plate", "--drops", 30, "--seconds", "0.5")
BOWL = Path(__file__).parents[3] / "configs/bowl.yaml"
AT_REST = "Error: {0} is for a plane at rest - leave out {0} or --plate"


@pytest.fixture
def stl(tmp_path):
    path = tmp_path / "box.stl"
    shapes.box(4.0, 5.0, 6.0).export(path)
    return path


def document(done):
    assert done.exit_code == 0, done.output
    return json.loads(done.stdout)


def rows(path):
    return list(csv.DictReader(path.read_text().splitlines()))


def test_json_of_one_plate(run, stl):
    told = document(
        run("drop", stl, *SHORT, "--config", BOWL, "--set", "drive.amplitude=0.4 mm", "--format", "json")
    )
    assert list(told) == ["part", "seed", "launch", "partial", "plates"]
    (plate,) = told["plates"]
    assert plate["bowl"] == "bowl" and plate["amplitude_mm"] == pytest.approx(0.4)
    assert plate["drops"] == 30 and plate["seconds"] == pytest.approx(0.5)
    assert plate["restitution"] == pytest.approx([0.1446, 0.2554], abs=1e-4)  # parts hop: it scatters
    assert plate["friction"] == [0.6, 0.6]
    assert plate["velocity_low_mm_s"] <= plate["velocity_mm_s"] <= plate["velocity_high_mm_s"]
    assert [list(row) for row in plate["aspects"]] == [COLUMNS[3:]] * 3
    assert plate["unsettled"] == 0
    assert sum(row["p_start"] for row in plate["aspects"]) == pytest.approx(1.0)
    assert list(plate["rates"][0]) == RATES[3:]
    seen = sum(row["count"] for row in plate["rates"] if row["from"] != row["to"])
    assert plate["transitions_seen"] == seen


def test_the_files_and_the_trend(run, stl, tmp_path):
    own = ("--set", "drive.amplitude=0.5 mm", "--amplitude", "78%,80%,0.41 mm")
    done = run("drop", stl, *SHORT, *own, "-o", "results")
    assert done.exit_code == 0, done.output
    folder = tmp_path / "results/box"
    tables = {f"plate{table}.csv" for table in ("", "_drives", "_rates", "_time")}
    assert {path.name for path in folder.iterdir()} == tables | {"plate.json", "plate.png", "run.json"}
    drives = rows(folder / "plate_drives.csv")
    assert list(drives[0])[:3] == HEAD and len(drives) == 3
    assert f"travels at {float(drives[0]['velocity_mm_s']):.4g} mm/s" in done.stderr
    plates = rows(folder / "plate.csv")
    assert list(plates[0]) == COLUMNS and len(plates) == 9
    assert [float(row["amplitude_mm"]) for row in plates[::3]] == pytest.approx([0.39, 0.40, 0.41])
    assert list(rows(folder / "plate_rates.csv")[0]) == RATES
    course = rows(folder / "plate_time.csv")
    assert list(course[0]) == [*HEAD, "time_s", "aspect", "p"]
    assert float(course[-1]["time_s"]) == pytest.approx(0.5) and len(course) % 9 == 0
    told = json.loads((folder / "run.json").read_text())["drop plate"]
    assert told["effective"]["defaults"]["drive.amplitude"] == "0.5 mm"


def test_several_bowl_files_are_several_plates(run, stl, tmp_path):
    for name, friction in (("wet", 0.1), ("dry", 0.7)):
        text = f"drive: {{amplitude: 0.2 mm}}\nfriction: {{static: {friction}}}\n"
        (tmp_path / f"{name}.yaml").write_text(text)
    call = ("--config", tmp_path / "wet.yaml", "--config", tmp_path / "dry.yaml", "--launch", "place")
    told = document(run("drop", stl, *SHORT, *call, "--format", "json"))
    assert [plate["bowl"] for plate in told["plates"]] == ["wet", "dry"]
    wet, dry = (plate["velocity_mm_s"] for plate in told["plates"])
    assert wet < 0.5 * dry


@pytest.mark.parametrize(
    ("arguments", "status", "line"),
    [
        (("--config", "b.yaml"), 2, "Error: --config is for a vibrating plate - give --plate as well"),
        (("--plate", "--until", "1%"), 2, AT_REST.format("--until")),
        (("--plate", "--amplitude", "0.4"), 2, "Error: --amplitude: drive.amplitude: '0.4' has no unit"),
    ],
)  # fmt: skip
def test_faults_are_one_line(run, stl, arguments, status, line):
    done = run("drop", stl, *arguments)
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
