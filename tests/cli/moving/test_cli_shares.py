"""One answer for how often a part lies on each aspect: the same in every command, and named."""

import csv
import io
import json
from pathlib import Path

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
    shown = run("rate", block, "--aspect", "A", "--config", config).stdout
    assert "whose probabilities" in shown and "fed onto the moving floor, 100 parts, seed 1" in shown
    for answer, option in (("launch drop", ("--launch", "drop")), ("csa", ("--rule", "csa"))):
        for bowl in ((), ("--config", config)):
            made = told(run, "rate", block, "--aspect", "A", *bowl, *option)
            assert made["answer"].endswith(answer)
    assert told(run, "rate", block, "--aspect", "A")["answer"].endswith("launch feed")


def test_tune_says_that_it_keeps_the_shares_of_the_drive_it_was_given(run, block, config):
    drive = ("--aspect", "A", "--target", "1/min", "--set", "drive.peak_to_peak=0.2 mm")
    said = "Warning: the shares of the aspects are those on the floor at the bowl's own drive"
    for answer, says in (((), True), (("--launch", "feed"), False)):
        lines = run("tune", block, *drive, "--config", config, *answer).stderr.splitlines()
        assert any(line.startswith(said) for line in lines) == says


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


def test_a_drop_test_that_was_written_is_read(run, block):
    run("drop", block, "--drops", "300", "-o", "out", "--no-pictures")
    made = told(run, "rate", block, "--aspect", "A", "--probabilities", "out/block/drop.csv")
    with Path("out/block/drop.csv").open() as file:
        row = next(csv.DictReader(file))
    assert made["p_aspect"] == pytest.approx(float(row["p_drop"]), abs=1e-6)
    assert made["answer"] == "out/block/drop.csv, 300 parts"


def test_likeliest_is_one_aspect_everywhere(run):
    """Of this cap CSA, PMI and the recommended answer each rank another aspect first, or another second."""
    table = told(run, "aspects", CAP)["aspects"]
    first = max(table, key=lambda row: row["p_recommended"])["aspect"]
    said = f"Aspect {first}, the likeliest (drop test, launch feed)"
    for command in ("floor", "track"):
        assert said in run(command, CAP).stderr.splitlines()
    shares = {row["aspect"]: row["p_recommended"] for row in table}
    laid = run("headings", CAP, "--format", "csv", "--set", "track.width=40 mm")
    assert "Aspect share: drop test, launch feed" in laid.stderr.splitlines()
    total = dict.fromkeys(shares, 0.0)
    for row in csv.DictReader(io.StringIO(laid.stdout)):
        total[row["aspect"]] += float(row["aspect_share"])
    assert total == pytest.approx(shares, abs=1e-4)
    known = told(run, "rate", CAP, "--aspect", first)
    assert known["p_aspect"] == pytest.approx(shares[first], abs=1e-9)


def test_compare_holds_the_answer_for_the_launch_of_the_file(run, block, tmp_path):
    (tmp_path / "c.csv").write_text("# launch: drop\naspect,tray\nA,60\nB,30\nC,10\n")
    found = []
    for option in ((), ("--launch", "drop"), ("--launch", "roll")):
        pairs = told(run, "compare", block, "--with", "c.csv", *option)["comparisons"]
        found += [c["total_variation"] for c in pairs if (c["first"], c["second"]) == ("tray", "recommended")]
    assert found[0] == found[1] != found[2]


def test_rate_tune_and_batch_take_the_same_answer(run, block, config):
    given = ("--config", config, "--set", "drive.peak_to_peak=0.3 mm")
    rate = told(run, "rate", block, "--aspect", "A", *given)
    fed = "fed onto the moving floor, 100 parts, seed 1"
    (row,) = told(run, "batch", block, *given, "-o", "all", "--no-pictures", "--jobs", "1")["parts"]
    names = ("aspect", "p_orientation", "parts_per_minute", "parts_per_minute_low", "answer")
    assert {name: row[name] for name in names} == {name: rate[name] for name in names}
    assert rate["answer"] == fed
    setting = told(run, "tune", block, "--aspect", "A", "--target", "5/min", *given)["settings"][0]
    densities = [one["parts_per_minute"] / one["velocity_mm_s"] for one in (setting, rate)]
    assert densities[0] == pytest.approx(densities[1], rel=1e-9)


@pytest.mark.parametrize("option", [("--launch", "drop"), ("--rule", "csa")])
def test_a_batch_with_a_launch_or_a_rule_feeds_nothing(run, block, config, option):
    call = ("batch", block, "--config", config, "-o", "all", "--no-pictures", "--jobs", "1", *option)
    (row,) = told(run, *call)["parts"]
    assert row["answer"].endswith({"drop": "launch drop", "csa": "csa"}[option[1]])
