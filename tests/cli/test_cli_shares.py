"""One answer for how often a part lies on each aspect: the same in every command, and named."""

import re
from pathlib import Path

import numpy as np
import pytest
import shapes
from command_lines import PARTS, rows

CAP = PARTS / "cap_14x10.stl"  # CSA and PMI rank B first or second, the recommended answer A
OWN = ("block.stl", "--aspect", "A")
FED = "fed onto the moving floor, "


@pytest.fixture(autouse=True)
def files(tmp_path):
    shapes.box(8.0, 12.0, 20.0).export(tmp_path / "block.stl")
    (tmp_path / "bowl.yaml").write_text("drive: {peak_to_peak: 0.1 mm}\ntrack: {width: 40 mm}\n")


def test_a_bowl_file_feeds_its_own_floor_and_names_it(run, run_json):
    shown = run("rate", *OWN, "--config", "bowl.yaml", "--fed", "30", "--seed", "3").stdout
    assert "whose probabilities" in shown and f"{FED}30 parts, seed 3" in shown
    for bowl in ((), ("--config", "bowl.yaml")):
        assert run_json("rate", *OWN, *bowl)["answer"].startswith(FED)
        for answer, option in (("launch drop", ("--launch", "drop")), ("csa", ("--rule", "csa"))):
            assert run_json("rate", *OWN, *bowl, *option)["answer"].endswith(answer)


@pytest.mark.parametrize("command", ["rate", "track"])
def test_a_file_of_the_defaults_changes_no_command_and_no_file(run, command):
    """Of a part whose orientation is left open; all that is printed and every table."""
    run("config", "init", "defaults.yaml")
    answers = []
    for folder, own in (("without", ()), ("with", ("--config", "defaults.yaml"))):
        more = () if command == "rate" else ("--no-pictures",)
        done = run(command, "block.stl", "--format", "csv", "-o", folder, *own, *more)
        assert done.exit_code == 0, done.output
        answers.append((done.stdout, {path.name: path.read_bytes() for path in Path(folder).rglob("*.csv")}))
    assert answers[0][1] and answers[0] == answers[1]


@pytest.mark.thorough
def test_parts_are_fed_onto_the_floor_until_the_shares_are_known(run_json):
    """Two seeds agree, and 1.96 standard errors of a proportion are within 2.5 %."""
    first, second = (run_json("rate", *OWN, "--seed", seed) for seed in ("1", "2"))
    p = first["p_aspect"]
    assert p == pytest.approx(second["p_aspect"], abs=0.05)
    parts = int(re.search(r"([0-9]+) parts, seed 1", first["answer"])[1])
    assert 1.96 * np.sqrt(p * (1.0 - p) / parts) <= 0.026


def test_probabilities_take_the_place_of_an_answer(run_json):
    Path("c.csv").write_text("aspect,tray\nA,10\nB,30\nC,60\n")
    counted = ("block.stl", "--aspect", "C", "--probabilities", "c.csv")
    rate = run_json("rate", *counted)
    assert rate["p_aspect"] == pytest.approx(0.6) and rate["answer"] == "c.csv, 100 parts"
    own = ("--target", "1/min", "--rule", "csa")
    tuned = run_json("tune", *counted, "--target", "5/min"), run_json("tune", *counted[:3], *own)
    densities = [row["parts_per_minute"] / row["velocity_mm_s"] for row in (t["settings"][0] for t in tuned)]
    assert densities[0] > 1.5 * densities[1]


def test_likeliest_is_one_aspect_everywhere(run, run_json):
    """In a bowl: what arrives from its moving floor, in every command."""
    rate = run_json("rate", CAP, "--aspect", "A")
    for command in ("floor", "track"):
        assert f"Aspect A, the likeliest ({rate['answer']})" in run(command, CAP).stderr.splitlines()
    headings = run("headings", CAP, "--format", "csv", "--set", "track.width=40 mm")
    assert f"Aspect share: {rate['answer']}" in headings.stderr.splitlines()
    total = dict.fromkeys("ABC", 0.0)
    for row in rows(headings.stdout):
        total[row["aspect"]] += float(row["aspect_share"])
    assert total["A"] == max(total.values()) == pytest.approx(rate["p_aspect"], abs=1e-4)


@pytest.mark.thorough
def test_rate_tune_and_batch_take_the_same_answer(run_json):
    own = ("--config", "bowl.yaml", "--set", "drive.peak_to_peak=0.3 mm")
    rate = run_json("rate", *OWN, *own)
    (row,) = run_json("batch", OWN[0], *own, "-o", "all", "--no-pictures", "--jobs", "1")["parts"]
    same = ("aspect", "p_orientation", "parts_per_minute", "parts_per_minute_low", "answer")
    assert {name: row[name] for name in same} == {name: rate[name] for name in same}
    assert rate["answer"].startswith(FED)
    own += ("--launch", "feed")  # another drive lets others arrive from its floor
    rate = run_json("rate", *OWN, *own)
    setting = run_json("tune", *OWN, "--target", "5/min", *own)["settings"][0]
    densities = [found["parts_per_minute"] / found["velocity_mm_s"] for found in (setting, rate)]
    assert densities[0] == pytest.approx(densities[1], rel=1e-9)
