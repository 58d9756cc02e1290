"""``feeder rate`` from the command line."""

import csv
import io
import json
from pathlib import Path

import pytest

PART = Path(__file__).parents[3] / "parts" / "lbracket_30x20x15.stl"
BOWL = """\
drive:
  peak_to_peak: 1 mm
  frequency: 50 Hz
friction:
  static: 0.4
devices:
  - wiper: 18 mm
  - yield:
      D: 0.9
"""
FACTORS = {
    *("velocity_mm_s", "pitch_mm", "length_mm", "gap_mm", "p_orientation", "p_aspect", "p_heading"),
    *("passes_devices", "fill", "aspect", "heading_deg", "rule", "orientations"),
}


@pytest.fixture
def config(tmp_path):
    (tmp_path / "bowl.yaml").write_text(BOWL)
    return tmp_path / "bowl.yaml"


def test_json(run, config):
    result = run("rate", PART, "--aspect", "D", "--config", config, "--fill", "0.5", "--format", "json")
    document = json.loads(result.stdout)
    assert result.exit_code == 0
    assert set(document) >= FACTORS
    stay = sum(row["p_recommended"] * row["track"] for row in document["orientations"])
    chain = document["velocity_mm_s"] / document["pitch_mm"] * document["p_orientation"] / stay * 0.9 * 0.5
    assert 0.5 < stay < 1.0
    assert document["parts_per_minute"] == pytest.approx(60.0 * chain)
    assert document["p_aspect"] * document["p_heading"] == pytest.approx(document["p_orientation"])
    assert (
        document["parts_per_minute_low"] <= document["parts_per_minute"] <= document["parts_per_minute_high"]
    )


def test_files(run, config):
    result = run("rate", PART, "--aspect", "D", "--config", config, "-o", "results")
    folder = Path("results", PART.stem)
    assert {path.name for path in folder.iterdir()} == {"rate.json", "orientations.csv", "run.json"}
    rows = list(csv.DictReader(io.StringIO((folder / "orientations.csv").read_text())))
    assert list(rows[0])[-4:] == ["track", "wiper_1", "yield_2", "passes"]
    assert "correctly oriented parts per minute" in result.stdout


def test_an_orientation_that_a_device_returns(run, config):
    result = run("rate", PART, "--aspect", "A", "--config", config)
    assert result.exit_code == 0
    hops, returned = result.stderr.splitlines()
    assert hops.startswith("Warning: parts hop 0.3 mm high and 2.2 mm far")
    assert returned == "Warning: wiper (18 mm) rejects the orientation you want; rate is 0"


@pytest.mark.parametrize(
    ("arguments", "status", "line"),
    [
        (
            ("--aspect", "A", "--set", "track.climb=40 deg"),
            1,
            "Error: track.climb: is steeper than friction holds: the part slides down continuously - "
            "lower the climb or raise the friction",
        ),
        (
            ("--aspect", "A", "--fill", "1.2"),
            2,
            "Error: Invalid value for '--fill': '1.2' is out of range - give more than 0 and at most 1 "
            "(see feeder rate --help)",
        ),
    ],
)
def test_faults_are_one_line(run, arguments, status, line):
    result = run("rate", PART, *arguments)
    assert (result.exit_code, result.stderr) == (status, line + "\n")
