"""``feeder rate`` from the command line."""

import csv
import io
import json
from pathlib import Path

import pytest
from click.testing import CliRunner

from feederscrew import __version__ as VERSION
from feederscrew import bowl as bowls
from feederscrew.bowl.verified import body_fingerprint, fingerprint
from feederscrew.part import load
from feederscrew_cli.main import feeder

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


TUNE_BOWL = ("--set", "drive.frequency=50 Hz", "--set", "restitution=0", "--set", "friction.static=0.4")


PLAIN = ("--rule", "quasistatic")  # the floor feeds nothing, which is most of the work


@pytest.fixture(scope="module")
def tuned(tmp_path_factory):
    """The table of one call and the folder it wrote."""
    out = tmp_path_factory.mktemp("tuned")
    call = ("tune", PART, "--aspect", "A", "--target", "12/min", *TUNE_BOWL, "-o", out)
    done = CliRunner().invoke(feeder, [str(word) for word in call])
    assert done.exit_code == 0, done.output
    return done.stdout, out / PART.stem


def test_a_setting_that_reaches_the_target(run, tuned):
    settings = json.loads((tuned[1] / "tune.json").read_text())["settings"]
    assert all(one["parts_per_minute"] == pytest.approx(12.0, rel=0.03) for one in settings)
    first = settings[0]
    amplitude = f"{first['key']}={first['value']!r} {first['unit']}"
    back = run("rate", PART, "--aspect", "A", *TUNE_BOWL, "--set", amplitude, "--format", "json")
    there = json.loads(back.stdout)["parts_per_minute"]
    assert there == pytest.approx(first["parts_per_minute"], rel=1e-9)


def test_the_table_says_at_which_friction_the_rate_is_met(run):
    asked = ("tune", PART, "--aspect", "A", "--target", "6/min", *TUNE_BOWL, *PLAIN, "--worst")
    assert run(*asked, "-o", ".").stdout.startswith("6/min at worst friction ")
    [written] = Path().glob("**/tune.json")
    document = json.loads(written.read_text())
    assert document["target_met"] == "at the worst friction"
    assert document["target_per_minute"] == pytest.approx(6.0)
    rows = document["settings"]
    assert all(one["parts_per_minute_low"] == pytest.approx(6.0, rel=0.04) for one in rows)
    assert max(one["parts_per_minute"] for one in rows) > 6.5


HANGING = """drive: {amplitude: 0.149 mm, frequency: 100 Hz, vibration_angle: 30 deg}
track: {width: 14.3 mm}
devices:
  - narrowed_track: 6.65 mm
  - rails: {from: 1.75 mm, to: 4.75 mm}
"""
TRIED = """verified:
  status: holds
  wanted: hanging
  outcome: hanging
  target: 5/min
  delivered: 5/min
  delivered_low: 5/min
  delivered_high: 5/min
  purity: 1
  jams: 0
  queue_seconds: 60 s
  draws: 20
  draws_held: 20
"""


def test_a_trial_in_which_parts_hang_is_that_of_the_state_they_leave_in(run, tmp_path):
    """It was called void: what lies before the rails was compared with what hangs behind them."""
    screw, path = PART.with_name("shcs_m3x8_simple.stl"), tmp_path / "b.yaml"
    path.write_text(HANGING)
    part, prints = load(screw), fingerprint(bowls.read(path))
    own = f'  version: "{VERSION}"\n  part: "{part.sha256[:16]}"\n  body: "{body_fingerprint(part)}"\n'
    path.write_text(f'{HANGING}{TRIED}{own}  bowl: "{prints}"\n')
    done = run("rate", screw, "--config", path, "--rule", "csa", "--format", "json")
    answer = json.loads(done.stdout)
    assert "is void" not in done.stderr and answer["verified"]["wanted"] == "hanging"
    assert answer["parts_per_minute"] == pytest.approx(5.0)
