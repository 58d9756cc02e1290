"""``feeder slide`` from the command line to its files."""

import csv
import io
import json
import math
from pathlib import Path

import pytest

COLUMNS = "beta_deg,alpha_minus_theta_deg,acceleration_ratio,mu_limit,mu_forward,mu_backward,regime"


def rows(text):
    return list(csv.DictReader(io.StringIO(text)))


def test_csv_is_the_whole_map(run):
    result = run("slide", "--beta", "20", "--format", "csv")
    assert result.exit_code == 0
    assert result.stdout.splitlines()[0] == COLUMNS
    for row in rows(result.stdout):
        ratio, angle = float(row["acceleration_ratio"]), math.radians(float(row["alpha_minus_theta_deg"]))
        b = math.radians(20)
        if ratio * math.sin(b) >= 1:
            assert (row["mu_limit"], row["regime"]) == ("", "hop")
        else:
            limit = ratio * math.cos(b) * math.cos(angle) / (1 - ratio * math.sin(b))
            assert float(row["mu_limit"]) == pytest.approx(limit, rel=1e-4, abs=1e-6)


def test_files_of_a_run(run):
    result = run("slide", "--beta", "10", "--beta", "40", "-o", "results", "-q")
    assert (result.exit_code, result.stderr) == (0, "")
    folder = Path("results/defaults")
    pictures = [f"slide_{kind}_beta{b}.png" for b in (10, 40) for kind in ("surface", "contours", "regimes")]
    assert {p.name for p in folder.iterdir()} == {"run.json", "slide.csv", "slide_curves.png", *pictures}
    assert (folder / "slide.csv").read_text().splitlines()[0] == COLUMNS
    assert json.loads((folder / "run.json").read_text())["slide"]["effective"]["drive.frequency"] == "50 Hz"
    before = {p.name: p.read_bytes() for p in folder.iterdir()}
    run("slide", "--beta", "10", "--beta", "40", "-o", "results", "-q")
    assert before == {p.name: p.read_bytes() for p in folder.iterdir()}


@pytest.mark.parametrize(
    ("beta", "told"),
    [
        ("120", "'120' is out of range - give 0 deg to 90 deg"),
        ("nan", "'nan' is not a number - write digits with a decimal point, as in 0.4"),
        ("20 mm", "'20 mm' is a length, not an angle - give it in deg"),
    ],
)
def test_a_wrong_angle_is_a_wrong_call(run, beta, told):
    result = run("slide", "--beta", beta)
    assert (result.exit_code, result.stdout) == (2, "")
    assert result.stderr == f"Error: Invalid value for '--beta': {told} (see feeder slide --help)\n"
