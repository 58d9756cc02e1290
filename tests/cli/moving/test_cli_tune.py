"""``feeder tune`` from the command line."""

import json
from pathlib import Path

import pytest
from click.testing import CliRunner

from feederscrew_cli.main import feeder

PART = Path(__file__).parents[3] / "parts" / "lbracket_30x20x15.stl"
BOWL = ("--set", "drive.frequency=50 Hz", "--set", "restitution=0", "--set", "friction.static=0.4")
PLAIN = ("--rule", "quasistatic")  # the floor feeds nothing, which is most of the work


def told(result):
    return [line for line in result.stderr.splitlines() if not line.startswith("Compiling")]


@pytest.fixture(scope="module")
def tuned(tmp_path_factory):
    """The table of one call and the folder it wrote."""
    out = tmp_path_factory.mktemp("tuned")
    call = ("tune", PART, "--aspect", "A", "--target", "12/min", *BOWL, "-o", out)
    done = CliRunner().invoke(feeder, [str(word) for word in call])
    assert done.exit_code == 0, done.output
    return done.stdout, out / PART.stem


def test_a_setting_that_reaches_the_target(run, tuned):
    settings = json.loads((tuned[1] / "tune.json").read_text())["settings"]
    assert all(one["parts_per_minute"] == pytest.approx(12.0, rel=0.03) for one in settings)
    first = settings[0]
    amplitude = f"{first['key']}={first['value']!r} {first['unit']}"
    back = run("rate", PART, "--aspect", "A", *BOWL, "--set", amplitude, "--format", "json")
    there = json.loads(back.stdout)["parts_per_minute"]
    assert there == pytest.approx(first["parts_per_minute"], rel=1e-9)


def test_an_unreachable_target_is_one_line(run):
    result = run("tune", PART, "--aspect", "A", "--target", "100000/min", *BOWL, *PLAIN)
    assert result.exit_code == 2
    (line,) = told(result)
    assert line.startswith("Error: --target: no setting reaches 100000/min: the most is ")


def test_the_table_fits_a_terminal(tuned):
    lines = tuned[0].splitlines()
    assert max(map(len, lines)) <= 100
    assert lines[2].startswith("drive.")
    assert lines[0].startswith("12/min at this friction ")
    assert lines[0].endswith("to hop")


def test_the_table_says_at_which_friction_the_rate_is_met(run):
    asked = ("tune", PART, "--aspect", "A", "--target", "6/min", *BOWL, *PLAIN, "--worst")
    assert run(*asked, "-o", ".").stdout.startswith("6/min at worst friction ")
    [written] = Path().glob("**/tune.json")
    document = json.loads(written.read_text())
    assert document["target_met"] == "at the worst friction"
    assert document["target_per_minute"] == pytest.approx(6.0)
    rows = document["settings"]
    assert all(one["parts_per_minute_low"] == pytest.approx(6.0, rel=0.04) for one in rows)
    assert max(one["parts_per_minute"] for one in rows) > 6.5
