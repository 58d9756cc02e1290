"""``feeder slide`` from the command line to its files."""

import csv
import io
import json
import math
from pathlib import Path

import pytest

UNDRAWN = True  # others look at pictures
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


def test_the_table_sums_up_the_bowls_own_point(run):
    result = run("slide", "--beta", "20", "--beta", "40 deg", "--beta", "20")
    head, _, *lines = result.stdout.splitlines()
    assert head.split("  ")[0] == "at the bowl's own point"
    assert (head.count("beta = 20 deg"), head.count("beta = 40 deg")) == (1, 1)
    assert any(line.split() == ["regime", "slips", "both", "ways", "hops"] for line in lines)
    assert "mu_limit is empty in" in result.stderr


def test_the_angle_is_the_bowls_own_unless_given(run):
    own = json.loads(run("slide", "--format", "json", "--set", "drive.vibration_angle=33 deg").stdout)
    assert own["maps"][0]["beta_deg"] == pytest.approx(33)
    assert own["bowl"]["drive.vibration_angle"] == "33 deg"
    point = own["maps"][0]["operating_point"]
    assert point["regime"] == "hop"
    assert point["acceleration_ratio"] == pytest.approx(0.21e-3 * (100 * math.pi) ** 2 / 9.81)


def test_as_published_is_negative_past_the_hop(run):
    found = rows(run("slide", "--beta", "20", "--format", "csv", "--as-published").stdout)
    past = [row for row in found if row["regime"] == "hop" and abs(float(row["alpha_minus_theta_deg"])) < 90]
    assert past and all(float(row["mu_limit"]) < 0 for row in past)


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


def test_a_map_without_a_hop_says_so(run):
    told = "beta = 0 deg: the drive does not lift the part, so no cell hops.\n"
    assert run("slide", "--beta", "0").stderr == told
    assert run("slide", "--beta", "0", "-q").stderr == ""


@pytest.mark.parametrize("angle", ["1e-308", "1e-9", "0"])
def test_a_vibration_angle_of_next_to_nothing(run, angle):
    result = run("slide", "--beta", angle, "--format", "json")
    assert (result.exit_code, result.exception) == (0, None)
