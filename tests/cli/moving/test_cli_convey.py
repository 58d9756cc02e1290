"""``feeder convey`` from the command line."""

import csv
import io
import json
import subprocess
import sys
from pathlib import Path

import pytest

POINT = (
    *("--set", "drive.peak_to_peak=1 mm", "--set", "drive.frequency=50 Hz"),
    *("--set", "drive.vibration_angle=25 deg"),
)
MAP = ("--vary", "drive.vibration_angle=10:60:8", "--vary", "drive.amplitude=0.05mm:0.6mm:7")
CONTRACT = {
    *("status", "period", "velocity_mm_s", "velocity_low_mm_s", "velocity_high_mm_s", "throw_number"),
    *("mu_forward", "mu_backward", "fractions", "longest_flight_periods", "hardest_impact_mm_s"),
    *("sensitivity", "validity", "margins", "regime", "friction_doubt", "bowl"),
}


def told(result):
    return [line for line in result.stderr.splitlines() if not line.startswith("Compiling")]


def test_json_of_a_point(run):
    result = run("convey", *POINT, "--format", "json")
    document = json.loads(result.stdout)
    assert result.exit_code == 0
    assert set(document) >= CONTRACT
    assert document["velocity_low_mm_s"] <= document["velocity_mm_s"] <= document["velocity_high_mm_s"]
    assert set(document["fractions"]) == {"stick", "forward", "backward", "flight"}
    assert sum(document["fractions"].values()) == pytest.approx(1.0)
    assert set(document["sensitivity"]) == {"amplitude", "friction", "angle"}


def test_no_steady_state_is_an_answer_and_a_warning(run):
    result = run("convey", "--set", "track.climb=20 deg", "--set", "friction.static=0.3", "--format", "json")
    document = json.loads(result.stdout)
    assert result.exit_code == 0
    assert document["status"] == "no steady state"
    assert document["velocity_mm_s"] is None
    assert told(result) == [
        "Warning: no steady state: the part slides down the track without stopping, and no velocity is steady"
    ]


def test_map_as_csv(run):
    result = run("convey", *MAP, "--format", "csv")
    rows = list(csv.DictReader(io.StringIO(result.stdout)))
    assert len(rows) == 56
    assert list(rows[0]) == [
        *("vibration_angle_deg", "amplitude_mm", "velocity_mm_s", "velocity_low_mm_s", "velocity_high_mm_s"),
        *("regime", "throw_number", "status"),
    ]
    assert {row["status"] for row in rows} <= {"periodic", "averaged"}
    own = ("--set", "drive.vibration_angle=60 deg", "--set", "drive.amplitude=0.05 mm")
    alone = run("convey", *own, "--format", "json")
    last_angle = next(row for row in rows if row["vibration_angle_deg"] == "60")
    assert float(last_angle["velocity_mm_s"]) == pytest.approx(
        json.loads(alone.stdout)["velocity_mm_s"], rel=1e-5
    )


def test_files(run):
    run("convey", *POINT, "-o", "results")
    run("convey", *MAP, "--bowl", "-o", "results")
    run("convey", "--bowl", "-o", "results")
    files = {path.name for path in Path("results/defaults").iterdir()}
    pictures = {"convey.png", "convey_map.png", "convey_radius.png"}
    assert files == {*pictures, "convey.json", "convey_map.csv", "convey_radius.csv", "run.json"}
    before = {name: Path("results/defaults", name).read_bytes() for name in files}
    run("convey", *MAP, "--bowl", "-o", "results")
    assert all(Path("results/defaults", name).read_bytes() == content for name, content in before.items())


def test_one_key_varied_is_a_curve(run):
    result = run("convey", "--vary", "drive.amplitude=0.02mm:0.2mm:5", "--format", "csv", "-o", "results")
    rows = list(csv.DictReader(io.StringIO(result.stdout)))
    assert [row["amplitude_mm"] for row in rows] == ["0.02", "0.065", "0.11", "0.155", "0.2"]
    alone = json.loads(run("convey", "--set", "drive.amplitude=0.11 mm", "--format", "json").stdout)
    assert float(rows[2]["velocity_mm_s"]) == pytest.approx(alone["velocity_mm_s"], rel=1e-5)
    files = {path.name for path in Path("results/defaults").iterdir()}
    assert files == {"convey_curve.csv", "convey_curve.png", "run.json"}


@pytest.mark.parametrize(
    ("arguments", "status", "line"),
    [
        (
            ("--set", "drive.amplitude=0 mm"),
            1,
            "Error: drive.amplitude: is 0 mm, so nothing moves - give more than 0 mm",
        ),
        (
            ("--vary", "drive.amplitude=0:1:3", "--bowl"),
            2,
            "Error: --bowl cannot be combined with exactly one --vary - leave one of them out "
            "(see feeder convey --help)",
        ),
        (
            ("--set", "drive.phase=20 deg", "--bowl"),
            1,
            "Error: drive.phase: is not 0 deg, an elliptical drive is not a screw motion to follow inwards"
            " - leave out --bowl, or the phase",
        ),
    ],
)
def test_faults_are_one_line(run, arguments, status, line):
    result = run("convey", *arguments)
    assert (result.exit_code, result.stderr) == (status, line + "\n")


def test_one_point_needs_no_compiler():
    code = (
        "import sys\nfrom click.testing import CliRunner\nfrom feederscrew_cli.main import feeder\n"
        "print(CliRunner().invoke(feeder, ['convey']).exit_code, 'numba' in sys.modules)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "0 False\n"


ELLIPSE = (
    *("--set", "drive.amplitude=0.3 mm", "--set", "drive.frequency=50 Hz", "--set", "friction.static=0.3"),
    *("--set", "drive.vibration_angle=15 deg", "--set", "restitution=0"),
)


def test_best_phase(run, tmp_path):
    assert run("convey", *ELLIPSE, "--best-phase", "-o", str(tmp_path)).exit_code == 0
    best = json.loads((tmp_path / "defaults/convey_phase.json").read_text())["best_phase"]
    printed = json.loads(run("convey", *ELLIPSE, "--best-phase", "--format", "json").stdout)
    assert printed["best_phase"] == best
    assert best["velocity_mm_s"] > best["straight_mm_s"]
    assert best["nine_tenths_from_deg"] < best["phase_deg"] < best["nine_tenths_to_deg"]
    assert [row["friction"] for row in best["over_friction"]] == [0.5, 0.8, 1.0, 1.2, 1.5]
    assert {"phase_deg", "velocity_mm_s", "straight_mm_s", "gain"} <= set(best)
    names = {path.name for path in (tmp_path / "defaults").iterdir()}
    assert names == {"convey_phase.json", "convey_phase.csv", "convey_phase.png", "run.json"}
    rows = list(csv.DictReader(io.StringIO((tmp_path / "defaults/convey_phase.csv").read_text())))
    assert len(rows) == 180
    assert float(rows[0]["phase_deg"]) == -180.0
    assert max(float(row["velocity_mm_s"]) for row in rows) <= best["velocity_mm_s"] * (1 + 1e-5)
    table = run("convey", *ELLIPSE, "--best-phase").stdout
    assert "best drive.phase [deg]" in table
    assert "at 0.5 times the friction, best / straight [mm/s]" in table


def test_several_velocities_are_told(run):
    values = ("drive.amplitude=0.4975 mm", "drive.frequency=50 Hz", "drive.vibration_angle=20 deg")
    values += ("track.climb=0 deg", "friction.static=0.3", "restitution=0.3")
    result = run("convey", *(word for value in values for word in ("--set", value)))
    assert told(result)[0].startswith("Warning: several steady velocities, 23.4")
