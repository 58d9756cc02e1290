"""``feeder advise`` end to end, by the static rule; its trials are those of ``feeder tooling``."""

import json
from pathlib import Path

import pytest
import shapes

from feederscrew.designing import advice
from feederscrew.designing.changes import list_changes

PARTS = Path(__file__).parents[2] / "parts"


def test_a_part_is_graded_and_its_changes_are_written(run, tmp_path, monkeypatch):
    """A cube, with two of its changes: all those of a washer are judged in tests/designing/test_advice.py."""
    monkeypatch.setattr(advice, "list_changes", lambda part: list_changes(part)[:2])
    shapes.box(20.0, 20.0, 20.0).export(tmp_path / "cube.stl")
    done = run("advise", "cube.stl", "--rule", "closed", "--static", "-o", tmp_path, "--format", "json")
    assert done.exit_code == 0, done.stderr
    told = json.loads(done.stdout)
    assert told["grade"] in "ABCD" and told["reasons"] and len(told["changes"]) == 2
    assert told["way"]["rate_per_minute"] > 0.0
    written = {path.name for path in (tmp_path / "cube").iterdir()}
    assert {"advice.html", "advice.json", "changes.csv", "run.json"} <= written
    said = " ".join(done.stderr.split())
    assert "by the static rule" in said and "that was tried" not in said


def test_the_grade_alone_looks_for_no_change_and_prints_its_reasons(run, tmp_path):
    """The table of no changes was a line of headings."""
    shapes.box(12.0, 12.0, 4.0).export(tmp_path / "plate.stl")
    call = ("advise", "plate.stl", "--rule", "closed", "--static", "--grade-only")
    assert json.loads(run(*call, "--format", "json").stdout)["changes"] == []
    first, *lines = run(*call).stdout.splitlines()
    assert first.split() == ["reason", "grades", "less", "because"] and len(lines) >= 3


@pytest.mark.parametrize("part", ["magnet.yaml"])
def test_a_part_card_has_no_shape_to_change(run, part):
    done = run("advise", PARTS / part, "--static")
    assert done.exit_code == 1 and "Error" in done.stderr and "Traceback" not in done.stderr
