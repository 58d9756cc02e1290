"""One answer for how often a part lies on each aspect: the same in every command, and named."""

import csv
import io
import json
import re
from pathlib import Path

import numpy as np
import pytest
import shapes

PARTS = Path(__file__).parents[3] / "parts"
CAP = PARTS / "cap_14x10.stl"  # CSA and PMI rank B first or second, the recommended answer A


@pytest.fixture
def block(tmp_path):
    shapes.box(8.0, 12.0, 20.0).export(tmp_path / "block.stl")
    return "block.stl"


@pytest.fixture
def config(tmp_path):
    (tmp_path / "bowl.yaml").write_text("drive: {peak_to_peak: 0.1 mm}\ntrack: {width: 40 mm}\n")
    return "bowl.yaml"


def told(run, *call):
    done = run(*call, "--format", "json")
    assert done.exit_code == 0, done.output
    return json.loads(done.stdout)


def test_a_bowl_file_feeds_its_own_floor_and_names_it(run, block, config):
    shown = run("rate", block, "--aspect", "A", "--config", config, "--fed", "30", "--seed", "3").stdout
    assert "whose probabilities" in shown and "fed onto the moving floor, 30 parts, seed 3" in shown
    usual = [told(run, "rate", block, "--aspect", "A", *own) for own in ((), ("--config", config))]
    assert all(one["answer"].startswith("fed onto the moving floor, ") for one in usual)
    for answer, option in (("launch drop", ("--launch", "drop")), ("csa", ("--rule", "csa"))):
        for bowl in ((), ("--config", config)):
            made = told(run, "rate", block, "--aspect", "A", *bowl, *option)
            assert made["answer"].endswith(answer)


@pytest.mark.parametrize("command", ["rate", "track"])
def test_a_file_of_the_defaults_changes_no_command_and_no_file(run, block, command):
    """Of a part whose orientation is left open; all that is printed and every table."""
    run("config", "init", "defaults.yaml")
    found = []
    for folder, own in (("without", ()), ("with", ("--config", "defaults.yaml"))):
        call = (command, block, "--format", "csv", "-o", folder, *own)
        done = run(*call) if command == "rate" else run(*call, "--no-pictures")
        assert done.exit_code == 0, done.output
        tables = {path.name: path.read_bytes() for path in Path(folder).rglob("*.csv")}
        found.append((done.stdout, tables))
    assert found[0][1] and found[0] == found[1]


@pytest.mark.thorough
def test_parts_are_fed_onto_the_floor_until_the_shares_are_known(run, block):
    shares = [told(run, "rate", block, "--aspect", "A", "--seed", seed) for seed in ("1", "2")]
    assert shares[0]["p_aspect"] == pytest.approx(shares[1]["p_aspect"], abs=0.05)
    parts = int(re.search(r"([0-9]+) parts, seed 1", shares[0]["answer"])[1])
    p = shares[0]["p_aspect"]
    assert 1.96 * np.sqrt(p * (1.0 - p) / parts) <= 0.021
    refused = run("rate", block, "--aspect", "A", "--fed", "9", "--launch", "drop")
    assert refused.exit_code == 2 and "--fed is for parts on the moving floor" in refused.stderr


def test_probabilities_take_the_place_of_an_answer(run, block, tmp_path):
    (tmp_path / "c.csv").write_text("aspect,tray\nA,10\nB,30\nC,60\n")
    made = told(run, "rate", block, "--aspect", "C", "--probabilities", "c.csv")
    assert made["p_aspect"] == pytest.approx(0.6) and made["answer"] == "c.csv, 100 parts"
    for other in (("--launch", "drop"), ("--rule", "csa"), ("--rule", "recommended")):
        done = run("rate", block, "--aspect", "C", "--probabilities", "c.csv", *other)
        assert done.exit_code == 2 and f"--probabilities takes the place of {other[0]}" in done.stderr
    tuned = told(run, "tune", block, "--aspect", "C", "--target", "5/min", "--probabilities", "c.csv")
    other = told(run, "tune", block, "--aspect", "C", "--target", "1/min")
    per_metre = [each["settings"][0] for each in (tuned, other)]
    counted, ours = (one["parts_per_minute"] / one["velocity_mm_s"] for one in per_metre)
    assert counted > 1.5 * ours


def test_likeliest_is_one_aspect_everywhere(run):
    """In a bowl: what arrives from its moving floor, in every command."""
    known = told(run, "rate", CAP, "--aspect", "A")
    answer = known["answer"]
    said = f"Aspect A, the likeliest ({answer})"
    for command in ("floor", "track"):
        assert said in run(command, CAP).stderr.splitlines()
    laid = run("headings", CAP, "--format", "csv", "--set", "track.width=40 mm")
    assert f"Aspect share: {answer}" in laid.stderr.splitlines()
    total = dict.fromkeys("ABC", 0.0)
    for row in csv.DictReader(io.StringIO(laid.stdout)):
        total[row["aspect"]] += float(row["aspect_share"])
    assert total["A"] == max(total.values()) == pytest.approx(known["p_aspect"], abs=1e-4)


@pytest.mark.thorough
def test_rate_tune_and_batch_take_the_same_answer(run, block, config):
    given = ("--config", config, "--set", "drive.peak_to_peak=0.3 mm")
    rate = told(run, "rate", block, "--aspect", "A", *given)
    (row,) = told(run, "batch", block, *given, "-o", "all", "--no-pictures", "--jobs", "1")["parts"]
    names = ("aspect", "p_orientation", "parts_per_minute", "parts_per_minute_low", "answer")
    assert {name: row[name] for name in names} == {name: rate[name] for name in names}
    assert rate["answer"].startswith("fed onto the moving floor, ")
    given += ("--launch", "feed")  # another drive lets others arrive from its floor
    rate = told(run, "rate", block, "--aspect", "A", *given)
    setting = told(run, "tune", block, "--aspect", "A", "--target", "5/min", *given)["settings"][0]
    densities = [one["parts_per_minute"] / one["velocity_mm_s"] for one in (setting, rate)]
    assert densities[0] == pytest.approx(densities[1], rel=1e-9)
