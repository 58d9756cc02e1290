"""``feeder floor``: the contract of its JSON, its files, its faults."""

import csv
import json
from pathlib import Path

import pytest

PARTS = Path(__file__).parents[3] / "parts"
BRACKET, CARD = PARTS / "lbracket_30x20x15.stl", PARTS / "arc_chute.yaml"
INSTANT = (
    "normal_force_N", "alignment_acceleration_rad_s2", "stable_heading_deg", "limiting_friction",
    "acceleration_y_m_s2", "acceleration_z_m_s2", "normal_line_offset_mm", "tips",
)  # fmt: skip
GENTLE = ("--set", "drive.amplitude=0.05 mm", "--set", "drive.vibration_angle=20 deg")


def document(run, *arguments):
    result = run("floor", *arguments, "--format", "json")
    assert result.exit_code == 0, result.output
    return json.loads(result.stdout)


def test_contract(run):
    found = document(run, BRACKET, "--aspect", "A", "--heading", "30deg", *GENTLE)
    assert set(INSTANT) <= set(found["instant"])
    assert found["regime"] in ("stick", "slide", "hop", "tip")
    assert found["heading_deg"] == pytest.approx(30)
    lengths = {len(column) for column in found["cycle"].values()}
    assert lengths == {72}
    assert set(found["cycle"]["state"]) <= {"stick", "slide", "hop", "tip"}


def test_as_published_names_the_omitted_terms(run):
    found = document(run, CARD, "--aspect", "5", *GENTLE, "--set", "drive.direction=10 deg", "--as-published")
    rows = {row["quantity"]: row for row in found["difference"]}
    assert rows["normal_force_N"]["omitted_term"] == "-"
    assert "a wall to take the force across" in rows["limiting_friction"]["omitted_term"]
    assert found["instant"]["normal_line_offset_mm"] == rows["normal_line_offset_mm"]["as_published"]


def test_files(run, tmp_path):
    result = run("floor", BRACKET, *GENTLE, "-o", "out")
    assert result.exit_code == 0, result.output
    names = {p.name for p in (tmp_path / "out/lbracket_30x20x15").iterdir()}
    maps = {
        f"floor_{kind}.{end}"
        for kind in ("beta_friction", "frequency_amplitude", "heading")
        for end in ("csv", "png")
    }
    assert names == maps | {"floor.json", "floor_cycle.csv", "floor_cycle.png", "floor_plan.png", "run.json"}
    table = (tmp_path / "out/lbracket_30x20x15/floor_beta_friction.csv").read_text()
    rows = list(csv.DictReader(table.splitlines()))
    assert {"beta_deg", "friction", "acceleration_z_m_s2", "regime"} <= set(rows[0])
