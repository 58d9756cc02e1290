"""``feeder compare`` and ``calibrate``: measured aspects and feeding tests against the rules."""

import json
import tracemalloc
from pathlib import Path

import numpy as np
import pytest
import shapes
from command_lines import CARD, ROOT, names, rows

from feederscrew.base.errors import FeederError
from feederscrew.part import load
from feederscrew.resting import profiles
from feederscrew.resting.aspects import find, require_ground
from feederscrew.resting.exact_tumbling import tumble_classes
from feederscrew.thesis.tables import table

FILES = sorted((ROOT / "docs/measured").glob("*.csv"))
RULES = {"PMI", "CSA", "STABILITY"}


def test_table_3_12_comes_out_and_the_table_shows_what_was_measured_the_nearest_rule_first(run, tmp_path):
    printed, measured = table("3-4"), tmp_path / "measured.csv"  # as a user would type it
    lines = [",".join([name, *printed.rows[name].values()]) for name in printed.rows]
    measured.write_text("\n".join(["# Table 3-4", f"aspect,{','.join(printed.columns)}", *lines]) + "\n")
    result = run("compare", CARD, "--with", measured, "--format", "csv")
    assert result.exit_code == 0, result.output
    whole = {(row["first"], row["second"]): row for row in rows(result.stdout)}
    assert len(whole) == 9 * 8 // 2
    for name in table("3-12").rows:
        first, second = name.split(" - ")
        pair = whole.get((first, second)) or whole[(second, first)]
        assert pair["deviation"].startswith(table("3-12").text(name, "deviation").rstrip("0"))
    assert result.stderr == f"{measured}: fractions: MDBT_78, MDBT_80, MDBT_82, MDFT_78, MDFT_80, MDFT_82\n"
    shown = [line.split() for line in run("compare", CARD, "--with", measured).stdout.splitlines()[1:]]
    assert not [row for row in shown if {row[0], row[1]} <= RULES] and len(shown) == len(whole) - 3
    nearest = [float(row[3]) for row in shown if row[0] == shown[0][0] and row[1] in RULES]
    assert len(nearest) == 3 and nearest == sorted(nearest)


def test_counts_are_tested_and_written(run, run_json, tmp_path):
    (tmp_path / "counts.csv").write_text("aspect,drops\n1,20\n2,50\n3,40\n4,60\n5,130\n")
    call = ("compare", CARD, "--with", "counts.csv")
    document = run_json(*call)
    pairs = {(pair["first"], pair["second"]): pair for pair in document["comparisons"]}
    assert pairs["drops", "PMI"]["degrees_of_freedom"] == 4
    assert 0.0 <= pairs["drops", "PMI"]["p_value"] < 1e-4 and pairs["PMI", "CSA"]["p_value"] is None
    kinds = {profile["name"]: profile["kind"] for profile in document["profiles"]}
    assert kinds == {"drops": "counts"} | dict.fromkeys(RULES, "rule")
    assert document["aspects"] == ["1", "2", "3", "4", "5"]
    result, folder = run(*call, "-o", "out", "--format", "csv"), tmp_path / "out/arc_chute"
    assert (folder / "compare.csv").read_text() == result.stdout
    picture, record = (folder / "compare.png").read_bytes(), json.loads((folder / "run.json").read_text())
    assert len(picture) > 5000 and len(record["compare"]["inputs"]) == 2
    run(*call, "-o", "out")
    assert (folder / "compare.png").read_bytes() == picture


@pytest.mark.parametrize(
    "call, lines",
    {
        f"compare {CARD} --with bad.csv": (
            "bad.csv:3: x: 'x' is not a number - write digits with a decimal point",
            "bad.csv:4: the part has no aspect '9' - known are 1, 2, 3, 4, 5",
            "bad.csv: has no row for aspect 3, 4, 5 - add it, 0 if never seen",
        ),
        "calibrate box.stl --with shares.csv": (
            "shares.csv: has no column of counts - give whole numbers of parts, not shares",
        ),
        "compare alone.csv gone.csv": (
            "alone.csv: does not say which part was counted - add a line '# part: FILE' at its top",
            "none.stl: no such file - check the path",
        ),
    }.items(),
)  # fmt: skip
def test_each_fault_is_a_line_and_nothing_is_written(run, tmp_path, call, lines):
    shapes.box(10.0, 13.0, 17.0).export(tmp_path / "box.stl")
    texts = {"bad": "aspect,x\n1,2\n2,x\n9,1\n", "shares": "aspect,tray\nA,0.5\nB,0.3\nC,0.2\n"}
    texts |= {"alone": "aspect,x\nA,1\n", "gone": "# part: none.stl\naspect,x\nA,1\n"}
    for name, text in texts.items():
        (tmp_path / f"{name}.csv").write_text(text)
    done = run(*call.split(), "-o", "out")
    assert (done.exit_code, done.stdout, (tmp_path / "out").exists()) == (1, "", False)
    assert done.stderr.splitlines() == [f"Error: {line}" for line in lines]


def test_counts_give_their_exponent_back(run_json, tmp_path):
    shapes.box(10.0, 13.0, 17.0).export(tmp_path / "box.stl")
    part = load(tmp_path / "box.stl")
    aspects = find(part)
    ground = require_ground(part, aspects)
    p = tumble_classes(ground, part, aspects.stable, exponent=1.3).probabilities["surface"]
    shares = dict(zip(aspects.names, p))
    lines = [f"{name},{round(20000 * share)}\n" for name, share in shares.items()]
    (tmp_path / "counts.csv").write_text("aspect,tray\n" + "".join(lines))
    document = run_json("calibrate", "box.stl", "--with", "counts.csv", "-o", "r")
    (row,) = document["calibrations"]
    assert row["exponent"] == pytest.approx(1.3, abs=0.01)
    assert row["exponent_low"] < 1.3 < row["exponent_high"]
    assert row["p_value"] > 0.9 and row["degrees_of_freedom"] == 1
    assert document["p_surface"]["tray"] == pytest.approx(shares, abs=1e-3)
    assert names(tmp_path / "r/box") == {"calibrate.csv", "calibrate.json", "run.json"}


def test_the_files_hold_what_was_published():
    """Square cuboids: counts and tosses of each set are those of the paper's table."""
    printed = {row["x_over_y"]: row for row in rows(ROOT / "tests/data/square_cuboids.csv")}
    sheets = [profiles.parse_count_sheet(profiles.read_count_text(path)[0], str(path)) for path in FILES]
    cuboids = [sheet for sheet in sheets if sheet.head.series == "square cuboids"]
    assert len(cuboids) == len(printed) == 8
    for sheet in cuboids:
        row = printed[sheet.head.note.split()[2]]
        counts, tosses = [int(cells[1]) for _, cells in sheet.rows], int(row["n"])
        assert sum(counts) == tosses
        assert any(abs(count / tosses - float(row["p_square"])) <= 0.5 / tosses for count in counts)


def test_each_set_is_compared_with_every_answer(run, tmp_path):
    done = run("compare", *FILES, "--format", "csv", "-o", "out")
    assert done.exit_code == 0, done.output
    sets = {row["set"]: row for row in rows(done.stdout)}
    assert "Warning" not in done.stderr  # every mesh is the one that was counted
    mean, chute = sets["square cuboids, mean of 8"], sets["arc_chute, MDBT_80"]
    assert sets["coin"]["launch"] == "flip" and chute["recommended"] == "" and mean["parts"] == "5197"
    assert float(chute["PMI"]) == pytest.approx(0.405, abs=5e-4)  # of a printed share
    single = [float(row["CSA"]) for name, row in sets.items() if name.startswith("cuboid_")]
    assert float(mean["CSA"]) == pytest.approx(np.mean(single), abs=1e-5)
    folder = tmp_path / "out/measured"
    assert (folder / "compare.csv").read_text() == done.stdout
    assert (folder / "compare.png").stat().st_size > 20_000
    assert len(json.loads((folder / "run.json").read_text())["compare"]["inputs"]) == 2 * len(FILES)


def test_a_feeding_test_stands_beside_the_static_rules(run, run_json, tmp_path):
    """The same file for compare and calibrate; here with shares of a launch, so that nothing is dropped."""
    shapes.box(8.0, 12.0, 20.0).export(tmp_path / "block.stl")
    Path("bowl.yaml").write_text("track: {width: 40 mm}\ndevices:\n  - wiper: 15 mm\n  - wiper: 10 mm\n")
    head = "# part: block.stl\n# config: bowl.yaml\n# launch: feed\ndevice,passed,rejected\n"
    (tmp_path / "c.csv").write_text(head + "wiper_2,88,12\ntrack,100,0\nwiper_1,93,4\n")
    done = run("compare", "block.stl", "--with", "c.csv", "--format", "csv", "-o", "out")
    assert done.exit_code == 0, done.output
    second, track, first = rows(done.stdout)
    assert [row["device"] for row in (second, track, first)] == ["wiper_2", "track", "wiper_1"]
    assert (tmp_path / "out/block/devices.csv").read_text() == done.stdout
    aspects = run_json("aspects", "block.stl")["aspects"]
    p = {round(2 * row["height_mm"]): row["p_recommended"] for row in aspects}
    assert float(first["predicted"]) == pytest.approx(p[8] + p[12], abs=1e-5)  # 20 mm does not pass
    assert float(second["predicted"]) == pytest.approx(p[8] / (p[8] + p[12]), abs=1e-5)
    assert float(second["measured"]) == pytest.approx(0.88) and track["agrees"] == "True"
    shown = run("compare", "c.csv").stdout.splitlines()
    assert max(map(len, shown)) <= 100 and "0.880 (0.802 to 0.930)" in shown[1]
    many = run_json("compare", "c.csv")
    assert many["sets"] == [] and many["feeding_tests"][0]["config"] == "bowl.yaml"
    (fit,) = run_json("calibrate", "block.stl", "--with", "c.csv")["calibrations"]
    assert fit["counts"] == "devices" and fit["exponent_low"] < fit["exponent"] < 8.0
    assert fit["degrees_of_freedom"] in (None, 1)


@pytest.mark.parametrize("counts", ["/dev/zero", "faulty.csv"])
def test_floods_are_refused_early(tmp_path, monkeypatch, counts):
    """Both took gigabytes once."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "faulty.csv").write_text("aspect,x\n" + "nobody,1\n" * 1_300_000)
    line = f"{counts}: has more than 1 MB - name a CSV file with one row an aspect"
    tracemalloc.start()
    with pytest.raises(FeederError, match=line):
        profiles.read_profile(counts, ["1"])
    most = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert most < 10e6
