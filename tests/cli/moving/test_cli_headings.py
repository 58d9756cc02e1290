"""``feeder headings``: the contract of its JSON, its pictures, its faults."""

import json
from pathlib import Path

import numpy as np
import pytest
import shapes

PARTS = Path(__file__).parents[3] / "parts"
BRACKET = PARTS / "lbracket_30x20x15.stl"
CONTRACT = {"heading_deg", "share", "length_mm", "width_mm", "falls_off"}


def rows(run, *arguments):
    result = run("headings", *arguments, "--format", "json")
    assert result.exit_code == 0, result.output
    return json.loads(result.stdout)["headings"]


def test_a_bar_at_a_straight_wall(run, tmp_path):
    shapes.box(30, 10, 5).export(tmp_path / "bar.stl")
    found = rows(run, "bar.stl", "--aspect", "A", "--set", "track.radius=100 m")
    assert set(found[0]) >= CONTRACT
    long_side = [row for row in found if row["length_mm"] == pytest.approx(30, rel=1e-3)]
    assert sum(row["share"] for row in long_side) == pytest.approx(4 * np.arctan(3) / (2 * np.pi), rel=1e-6)
    assert [row["heading_deg"] for row in long_side] == [0.0]  # half a turn maps the bar to itself


def test_files(run, tmp_path):
    result = run("headings", BRACKET, "--aspect", "A", "-o", "out")
    assert result.exit_code == 0, result.output
    names = {p.name for p in (tmp_path / "out/lbracket_30x20x15").iterdir()}
    assert names == {"headings.csv", "headings.json", "headings_A.png", "run.json"}
