"""``feeder compare``: measured aspects against the rules."""

import csv
import io
import json
import tracemalloc

import numpy as np
import pytest
import shapes

from feederscrew.errors import FeederError
from feederscrew.resting import profiles
from feederscrew.thesis.tables import table


@pytest.fixture
def card(request):
    return request.config.rootpath / "parts" / "arc_chute.yaml"


@pytest.fixture
def measured(tmp_path):
    """Table 3-4 as a user would type it."""
    printed = table("3-4")
    lines = [",".join([name, *printed.rows[name].values()]) for name in printed.rows]
    path = tmp_path / "measured.csv"
    path.write_text("\n".join(["# Table 3-4", f"aspect,{','.join(printed.columns)}", *lines]) + "\n")
    return path


@pytest.fixture
def counts(tmp_path):
    path = tmp_path / "counts.csv"
    path.write_text("aspect,drops\n1,20\n2,50\n3,40\n4,60\n5,130\n")
    return path


def rows(result):
    return {(row["first"], row["second"]): row for row in csv.DictReader(io.StringIO(result.stdout))}


def test_table_3_12_comes_out(run, card, measured):
    result = run("compare", card, "--with", measured, "--format", "csv")
    assert result.exit_code == 0, result.output
    found = rows(result)
    assert len(found) == 9 * 8 // 2
    for name in table("3-12").rows:
        first, second = name.split(" - ")
        row = found.get((first, second)) or found[(second, first)]
        text = table("3-12").text(name, "deviation")
        assert row["deviation"].startswith(text.rstrip("0"))
    assert result.stderr == (f"{measured}: fractions: MDBT_78, MDBT_80, MDBT_82, MDFT_78, MDFT_80, MDFT_82\n")


def test_counts_are_tested(run, card, counts):
    document = json.loads(run("compare", card, "--with", counts, "--format", "json").stdout)
    found = {(c["first"], c["second"]): c for c in document["comparisons"]}
    assert found[("drops", "PMI")]["degrees_of_freedom"] == 4
    assert 0.0 <= found[("drops", "PMI")]["p_value"] < 1e-4
    assert found[("PMI", "CSA")]["p_value"] is None
    kinds = {p["name"]: p["kind"] for p in document["profiles"]}
    assert kinds == {"drops": "counts", "PMI": "rule", "CSA": "rule", "STABILITY": "rule"}
    assert document["aspects"] == ["1", "2", "3", "4", "5"]


def test_the_table_is_about_what_was_measured_the_nearest_rule_first(run, card, measured):
    rows = [line.split() for line in run("compare", card, "--with", measured).stdout.splitlines()[1:]]
    whole = list(
        csv.DictReader(io.StringIO(run("compare", card, "--with", measured, "--format", "csv").stdout))
    )
    rules = {"PMI", "CSA", "STABILITY"}
    assert not [row for row in rows if {row[0], row[1]} <= rules]
    assert len(rows) == len(whole) - 3
    first = [float(row[3]) for row in rows if row[0] == rows[0][0] and row[1] in rules]
    assert len(first) == 3 and first == sorted(first)


def test_files(run, card, counts, tmp_path):
    result = run("compare", card, "--with", counts, "-o", "out", "--format", "csv")
    folder = tmp_path / "out" / "arc_chute"
    assert (folder / "compare.csv").read_text() == result.stdout
    assert (folder / "compare.png").stat().st_size > 5000
    record = json.loads((folder / "run.json").read_text())["compare"]
    assert len(record["inputs"]) == 2
    first = (folder / "compare.png").read_bytes()
    run("compare", card, "--with", counts, "-o", "out")
    assert (folder / "compare.png").read_bytes() == first


def test_faults_are_one_line_each_and_nothing_is_written(run, card, tmp_path):
    (tmp_path / "bad.csv").write_text("aspect,x\n1,2\n2,x\n9,1\n")
    result = run("compare", card, "--with", "bad.csv", "-o", "out")
    assert result.exit_code == 1
    assert result.stderr.splitlines() == [
        "Error: bad.csv:3: x: 'x' is not a number - write digits with a decimal point",
        "Error: bad.csv:4: the part has no aspect '9' - known are 1, 2, 3, 4, 5",
        "Error: bad.csv: has no row for aspect 3, 4, 5 - add it, 0 if never seen",
    ]
    assert not (tmp_path / "out").exists()


@pytest.fixture
def stl(tmp_path):
    path = tmp_path / "box.stl"
    shapes.box(10.0, 13.0, 17.0).export(path)
    return path


def calibrate_counts(tmp_path, text):
    path = tmp_path / "counts.csv"
    path.write_text(text)
    return path


def test_counts_give_their_exponent_back(run, stl, tmp_path):
    from feederscrew.part import load
    from feederscrew.resting.aspects import find
    from feederscrew.resting.exact_tumbling import exact, require_ground

    part = load(stl)
    aspects = find(part)
    p = exact(require_ground(part, aspects), part, aspects, exponent=1.3).probabilities["surface"]
    lines = [f"{name},{round(20000 * share)}" for name, share in zip(aspects.names, p)]
    done = run(
        "calibrate",
        stl,
        "--with",
        calibrate_counts(tmp_path, "\n".join(["aspect,tray", *lines])),
        "--format",
        "json",
        "-o",
        "r",
    )
    assert done.exit_code == 0, done.output
    told = json.loads(done.stdout)
    (row,) = told["calibrations"]
    assert (
        row["exponent"] == pytest.approx(1.3, abs=0.01) and row["exponent_low"] < 1.3 < row["exponent_high"]
    )
    assert row["p_value"] > 0.9 and row["degrees_of_freedom"] == 1
    assert told["p_surface"]["tray"] == pytest.approx(dict(zip(aspects.names, p)), abs=1e-3)
    assert {path.name for path in (tmp_path / "r/box").iterdir()} == {
        "calibrate.csv",
        "calibrate.json",
        "run.json",
    }


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (
            "aspect,tray\nA,0.5\nB,0.3\nC,0.2\n",
            "has no column of counts - give whole numbers of parts, not shares",
        ),
        ("aspect,tray\nA,5\nB,3\nQ,2\n", "Q"),
    ],
)
def test_faults_are_told(run, stl, tmp_path, text, words):
    done = run("calibrate", stl, "--with", calibrate_counts(tmp_path, text))
    assert done.exit_code == 1 and words in done.stderr and done.stdout == ""


ROUND = 5e-4  # of a printed share


@pytest.fixture(scope="module")
def files(request):
    return sorted((request.config.rootpath / "docs/measured").glob("*.csv"))


def sets_rows(text):
    return list(csv.DictReader(line for line in text.splitlines() if line[0] != "#"))


def test_the_files_hold_what_was_published(files, request):
    root = request.config.rootpath
    printed = {
        row["x_over_y"]: row for row in sets_rows((root / "tests/data/square_cuboids.csv").read_text())
    }
    heads = [profiles.parse_count_sheet(profiles.read_count_text(path)[0], str(path)) for path in files]
    cuboids = [table for table in heads if table.head.series == "square cuboids"]
    assert len(cuboids) == len(printed) == 8
    for sheet in cuboids:
        ratio = sheet.head.note.split()[2]
        counts = sorted(int(row[1]) for _, row in sheet.rows)
        share, tosses = float(printed[ratio]["p_square"]), int(printed[ratio]["n"])
        assert sum(counts) == tosses
        assert any(abs(count / tosses - share) <= 0.5 / tosses for count in counts)


def test_each_set_is_compared_with_every_answer(run, files, tmp_path):
    done = run("compare", *files, "--format", "csv", "-o", "out")
    assert done.exit_code == 0, done.output
    found = {row["set"]: row for row in csv.DictReader(io.StringIO(done.stdout))}
    assert "Warning" not in done.stderr  # every mesh is the one that was counted
    coin, mean = found["coin"], found["square cuboids, mean of 8"]
    assert coin["launch"] == "flip" and found["arc_chute, MDBT_80"]["recommended"] == ""
    assert float(found["arc_chute, MDBT_80"]["PMI"]) == pytest.approx(0.405, abs=ROUND)
    assert mean["parts"] == "5197"
    single = [float(row["CSA"]) for name, row in found.items() if name.startswith("cuboid_")]
    assert float(mean["CSA"]) == pytest.approx(np.mean(single), abs=1e-5)
    assert (tmp_path / "out/measured/compare.csv").read_text() == done.stdout
    assert (tmp_path / "out/measured/compare.png").stat().st_size > 20_000
    record = json.loads((tmp_path / "out/measured/run.json").read_text())["compare"]
    assert len(record["inputs"]) == 2 * len(files)


def test_a_file_without_a_part_and_one_with_a_fault(run, tmp_path):
    (tmp_path / "a.csv").write_text("aspect,x\nA,1\n")
    (tmp_path / "b.csv").write_text("# part: none.stl\naspect,x\nA,1\n")
    done = run("compare", "a.csv", "b.csv")
    assert done.exit_code == 1
    assert done.stderr.splitlines() == [
        "Error: a.csv: does not say which part was counted - add a line '# part: FILE' at its top",
        "Error: none.stl: no such file - check the path",
    ]


def test_a_feeding_test_stands_beside_the_static_rules(run, tmp_path):
    """The same file for compare and calibrate; here with shares of a launch, so that nothing is dropped."""
    shapes.box(8.0, 12.0, 20.0).export(tmp_path / "block.stl")
    (tmp_path / "bowl.yaml").write_text(
        "track: {width: 40 mm}\ndevices:\n  - wiper: 15 mm\n  - wiper: 10 mm\n"
    )
    head = "# part: block.stl\n# config: bowl.yaml\n# launch: feed\n"
    (tmp_path / "c.csv").write_text(
        head + "device,passed,rejected\nwiper_2,88,12\ntrack,100,0\nwiper_1,93,4\n"
    )
    done = run("compare", "block.stl", "--with", "c.csv", "--format", "csv", "-o", "out")
    assert done.exit_code == 0, done.output
    sets_rows = list(csv.DictReader(io.StringIO(done.stdout)))
    assert [row["device"] for row in sets_rows] == ["wiper_2", "track", "wiper_1"]
    assert (tmp_path / "out/block/devices.csv").read_text() == done.stdout
    aspects = json.loads(run("aspects", "block.stl", "--format", "json").stdout)["aspects"]
    p = {round(2 * one["height_mm"]): one["p_recommended"] for one in aspects}
    assert float(sets_rows[2]["predicted"]) == pytest.approx(p[8] + p[12], abs=1e-5)  # 20 mm does not pass
    assert float(sets_rows[0]["predicted"]) == pytest.approx(p[8] / (p[8] + p[12]), abs=1e-5)
    assert float(sets_rows[0]["measured"]) == pytest.approx(0.88) and sets_rows[1]["agrees"] == "True"
    shown = run("compare", "c.csv").stdout.splitlines()
    assert max(map(len, shown)) <= 100 and "0.880 (0.802 to 0.930)" in shown[1]
    many = json.loads(run("compare", "c.csv", "--format", "json").stdout)
    assert many["sets"] == [] and many["feeding_tests"][0]["config"] == "bowl.yaml"
    fitted = json.loads(run("calibrate", "block.stl", "--with", "c.csv", "--format", "json").stdout)
    (found,) = fitted["calibrations"]
    assert found["counts"] == "devices" and found["exponent_low"] < found["exponent"] < 8.0
    assert found["degrees_of_freedom"] in (None, 1)


@pytest.mark.parametrize("counts", ["/dev/zero", "faulty.csv"])
def test_floods_are_refused_early(run, request, tmp_path, counts):
    """Both took gigabytes once."""
    part = request.config.rootpath / "parts/arc_chute.yaml"
    (tmp_path / "faulty.csv").write_text("aspect,x\n" + "nobody,1\n" * 1_300_000)
    done = run("compare", part, "--with", counts)
    line = f"{counts}: has more than 1 MB - name a CSV file with one row an aspect"
    assert (done.exit_code, done.stderr) == (1, f"Error: {line}\n")
    tracemalloc.start()
    with pytest.raises(FeederError, match=line):
        profiles.read_profile(counts, ["1"])
    most = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert most < 10e6
