"""``feeder advise`` end to end, by the static rule; its trials are those of ``feeder tooling``."""

import json
from pathlib import Path

import pytest

PARTS = Path(__file__).parents[2] / "parts"


def test_a_part_is_graded_and_its_changes_are_written(run, tmp_path):
    done = run(
        "advise", PARTS / "washer_m6.stl", "--rule", "closed", "--static", "-o", tmp_path, "--format", "json"
    )
    assert done.exit_code == 0, done.stderr
    told = json.loads(done.stdout)
    assert told["grade"] in "ABCD" and told["reasons"] and len(told["changes"]) >= 2
    assert told["way"]["rate_per_minute"] > 0.0
    written = {path.name for path in (tmp_path / "washer_m6").iterdir()}
    assert {"advice.html", "advice.json", "changes.csv", "run.json"} <= written


def test_the_grade_alone_looks_for_no_change(run):
    done = run(
        "advise", PARTS / "washer_m6.stl", "--rule", "closed", "--static", "--grade-only", "--format", "json"
    )
    assert json.loads(done.stdout)["changes"] == []


def test_without_changes_the_reasons_are_printed_and_a_rule_is_named_as_one(run):
    """The table of no changes was a line of headings."""
    call = ("advise", PARTS / "washer_m6.stl", "--rule", "closed", "--static")
    alone = run(*call, "--grade-only")
    first, *lines = alone.stdout.splitlines()
    assert first.split() == ["reason", "grades", "less", "because"] and len(lines) >= 3
    said = " ".join(run(*call).stderr.split())
    assert "by the static rule" in said and "that was tried" not in said


@pytest.mark.parametrize("part", ["magnet.yaml"])
def test_a_part_card_has_no_shape_to_change(run, part):
    done = run("advise", PARTS / part, "--static")
    assert done.exit_code == 1 and "Error" in done.stderr and "Traceback" not in done.stderr
