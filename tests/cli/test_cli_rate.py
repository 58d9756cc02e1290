"""``feeder rate`` and ``tune`` from the command line."""

import json
from pathlib import Path

import pytest
from command_lines import BRACKET, PARTS, names, rows

from feederscrew import __version__ as VERSION
from feederscrew import bowl as bowls
from feederscrew.bowl.verified import body_fingerprint, fingerprint
from feederscrew.motion import hop
from feederscrew.part import load

BOWL = """\
drive: {peak_to_peak: 1 mm, frequency: 50 Hz}
friction: {static: 0.4}
devices:
  - wiper: 18 mm
  - yield:
      D: 0.9
"""
FACTORS = {"velocity_mm_s", "pitch_mm", "length_mm", "gap_mm", "p_orientation", "passes_devices", "rule"}
TUNE_BOWL = ("--set", "drive.frequency=50 Hz", "--set", "restitution=0", "--set", "friction.static=0.4")
PLAIN = ("--rule", "quasistatic")  # the floor feeds nothing, which is most of the work


def test_a_rate_is_the_product_of_its_factors_and_is_written(run_json, run):
    Path("bowl.yaml").write_text(BOWL)
    own = ("rate", BRACKET, "--aspect", "D", "--config", "bowl.yaml")
    document = run_json(*own, "--fill", "0.5", "-o", "results")
    assert set(document) >= FACTORS
    stay = sum(row["p_recommended"] * row["track"] for row in document["orientations"])
    chain = document["velocity_mm_s"] / document["pitch_mm"] * document["p_orientation"] / stay * 0.9 * 0.5
    assert 0.5 < stay < 1.0 and document["parts_per_minute"] == pytest.approx(60.0 * chain)
    assert document["p_aspect"] * document["p_heading"] == pytest.approx(document["p_orientation"])
    low, rate, high = (document[f"parts_per_minute{end}"] for end in ("_low", "", "_high"))
    assert low <= rate <= high
    folder = Path("results", BRACKET.stem)
    assert names(folder) == {"rate.json", "orientations.csv", "run.json"}
    assert list(rows(folder / "orientations.csv")[0])[-4:] == [
        "track",
        "wiper_1",
        "measured_yield_2",
        "passes",
    ]
    returned = run("rate", BRACKET, "--aspect", "A", "--config", "bowl.yaml")
    assert returned.exit_code == 0 and "correctly oriented parts per minute" in returned.stdout
    hops, rejects, name = returned.stderr.splitlines()
    assert hops.startswith("Warning: parts hop 0.3 mm high and 2.2 mm far")
    assert rejects == "Warning: wiper (18 mm) rejects the orientation you want; rate is 0"
    assert name.startswith("A@2: aspect A, turned 2 deg")


def test_a_setting_reaches_the_target(run_json, run):
    tune = ("tune", BRACKET, "--aspect", "A", *TUNE_BOWL, *PLAIN)
    settings = run_json(*tune, "--target", "12/min")["settings"]
    assert all(row["parts_per_minute"] == pytest.approx(12.0, rel=0.03) for row in settings)
    first = settings[0]
    amplitude = f"{first['key']}={first['value']!r} {first['unit']}"
    there = run_json("rate", BRACKET, "--aspect", "A", *TUNE_BOWL, *PLAIN, "--set", amplitude)
    assert there["parts_per_minute"] == pytest.approx(first["parts_per_minute"], rel=1e-9)
    # the table says at which friction the rate is met
    assert run(*tune, "--target", "6/min", "--worst", "-o", ".").stdout.startswith("6/min at worst friction ")
    document = json.loads(Path(BRACKET.stem, "tune.json").read_text())
    assert document["target_met"] == "at the worst friction"
    settings = document["settings"]
    assert all(row["parts_per_minute_low"] == pytest.approx(6.0, rel=0.04) for row in settings)
    assert max(row["parts_per_minute"] for row in settings) > 6.5


HANGING = """drive: {amplitude: 0.2 mm, frequency: 100 Hz, vibration_angle: 30 deg}
track: {width: 14.3 mm}
devices:
  - narrowed_track: 6.65 mm
  - rails: {from: 1.75 mm, to: 4.75 mm}
"""
TRIED = """status: holds, wanted: hanging, outcome: hanging, target: 5/min, delivered: 5/min,
 delivered_low: 5/min, delivered_high: 5/min, purity: 1, jams: 0, queue_seconds: 60 s,
 draws: 20, draws_held: 20"""


def test_a_trial_in_which_parts_hang_is_that_of_the_state_they_leave_in(run):
    """It was called void: what lies before the rails was compared with what hangs behind them."""
    screw, path = PARTS / "shcs_m3x8_simple.stl", Path("b.yaml")
    path.write_text(HANGING)
    part, prints = load(screw), fingerprint(bowls.read(path))
    own = f'version: "{VERSION}", part: "{part.sha256[:16]}", body: "{body_fingerprint(part)}"'
    path.write_text(f'{HANGING}verified: {{{TRIED}, {own}, bowl: "{prints}"}}\n')
    done = run("rate", screw, "--config", path, "--rule", "csa", "--format", "json")
    answer = json.loads(done.stdout)
    assert "is void" not in done.stderr and answer["verified"]["wanted"] == "hanging"
    hops = [remark for remark in hop.remark(bowls.read(path)) if remark in done.stderr]
    assert hop.remark(bowls.read(path)) and not hops  # it was tried as it hops
    assert answer["parts_per_minute"] == pytest.approx(5.0)
