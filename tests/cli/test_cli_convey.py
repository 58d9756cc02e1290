"""``feeder convey`` from the command line."""

import json
from pathlib import Path

import pytest
from command_lines import NUT, names, rows

POINT = ("--set", "drive.peak_to_peak=1 mm", "--set", "drive.vibration_angle=25 deg")
MAP = ("--vary", "drive.vibration_angle=10:60:8", "--vary", "drive.amplitude=0.05mm:0.6mm:7")
CONTRACT = {
    "status", "period", "throw_number", "mu_forward", "mu_backward", "longest_flight_periods",
    "hardest_impact_mm_s", "validity", "margins", "regime", "friction_doubt", "bowl",
}  # fmt: skip
HERE = Path("results/defaults")


def test_json_of_a_point_and_what_is_said_of_steady_states(run_json, run):
    document = run_json("convey", *POINT)
    assert set(document) >= CONTRACT
    assert document["velocity_low_mm_s"] <= document["velocity_mm_s"] <= document["velocity_high_mm_s"]
    assert set(document["fractions"]) == {"stick", "forward", "backward", "flight"}
    assert sum(document["fractions"].values()) == pytest.approx(1.0)
    # no steady state is an answer, and several are a warning
    result = run("convey", "--set", "track.climb=20 deg", "--set", "friction.static=0.3", "--format", "json")
    document = json.loads(result.stdout)
    assert (result.exit_code, document["status"], document["velocity_mm_s"]) == (0, "no steady state", None)
    slides = "no steady state: the part slides down the track without stopping, and no velocity is steady"
    assert result.stderr == f"Warning: {slides}\n"
    smooth = ("--set", "friction.static=0", "--set", "friction.kinetic=0", "--set", "track.climb=0 deg")
    result = run("convey", *smooth)
    assert result.stderr.startswith("Warning: no steady state: without friction a part on the level keeps")
    assert result.stdout.splitlines()[1].split() == ["velocity", "[mm/s]", "no", "steady", "velocity"]
    document = run_json("convey", *smooth)
    assert (document["velocity_mm_s"], document["unsteady"]) == (None, "keeps its speed")
    for command in (("convey", "--best-phase"), ("rate", NUT, "--aspect", "A", "--rule", "closed")):
        refused = run(*command, *smooth)
        assert refused.exit_code == 1 and "raise friction.static and friction.kinetic" in refused.stderr
    values = ("drive.amplitude=0.4975 mm", "drive.frequency=50 Hz", "drive.vibration_angle=20 deg")
    values += ("track.climb=0 deg", "friction.static=0.3", "restitution=0.3")
    result = run("convey", *(word for value in values for word in ("--set", value)))
    assert result.stderr.startswith("Warning: several steady velocities, 23.4")


def test_maps_and_curves_hold_what_a_point_says(run, run_json):
    table = rows(run("convey", *MAP, "--format", "csv").stdout)
    assert len(table) == 56 and {row["status"] for row in table} <= {"periodic", "averaged"}
    columns = "vibration_angle_deg amplitude_mm velocity_mm_s velocity_low_mm_s velocity_high_mm_s"
    assert list(table[0]) == [*columns.split(), "regime", "throw_number", "status"]
    curve = rows(run("convey", "--vary", "drive.amplitude=0.02mm:0.2mm:5", "--format", "csv").stdout)
    assert [row["amplitude_mm"] for row in curve] == ["0.02", "0.065", "0.11", "0.155", "0.2"]
    steep = next(row for row in table if row["vibration_angle_deg"] == "60")
    for row, angle, amplitude in ((steep, 60, 0.05), (curve[2], 25, 0.11)):
        own = (f"drive.vibration_angle={angle} deg", f"drive.amplitude={amplitude} mm")
        alone = run_json("convey", "--set", own[0], "--set", own[1])["velocity_mm_s"]
        assert float(row["velocity_mm_s"]) == pytest.approx(alone, rel=1e-5)


def test_files(run):
    for own in (POINT, (*MAP, "--bowl"), ("--bowl",), ("--vary", "drive.amplitude=0.02mm:0.2mm:5")):
        run("convey", *own, "-o", "results")
    kinds = {"convey_map", "convey_radius", "convey_curve"}
    tables = {f"{kind}.{end}" for kind in kinds for end in ("csv", "png")}
    assert names(HERE) == tables | {"convey.png", "convey.json", "run.json"}
    before = {path: path.read_bytes() for path in HERE.glob("convey_[mr]*")}
    run("convey", *MAP, "--bowl", "-o", "results")
    assert all(path.read_bytes() == content for path, content in before.items())


def test_best_phase(run):
    ellipse = "drive.amplitude=0.3mm friction.static=0.3 drive.vibration_angle=15deg restitution=0"
    sets = [word for value in ellipse.split() for word in ("--set", value)]
    done = run("convey", *sets, "--best-phase", "-o", "results")
    assert done.exit_code == 0 and "best drive.phase [deg]" in done.stdout
    assert "at 0.5 times the friction, best / straight [mm/s]" in done.stdout
    best = json.loads((HERE / "convey_phase.json").read_text())["best_phase"]
    assert best["velocity_mm_s"] > best["straight_mm_s"]
    assert best["nine_tenths_from_deg"] < best["phase_deg"] < best["nine_tenths_to_deg"]
    assert [row["friction"] for row in best["over_friction"]] == [0.5, 0.8, 1.0, 1.2, 1.5]
    assert names(HERE) == {"convey_phase.json", "convey_phase.csv", "convey_phase.png", "run.json"}
    table = rows(HERE / "convey_phase.csv")
    assert len(table) == 180 and float(table[0]["phase_deg"]) == -180.0
    assert max(float(row["velocity_mm_s"]) for row in table) <= best["velocity_mm_s"] * (1 + 1e-5)
