"""``feeder compare FILE...``: many measured sets, each with its own part."""

import csv
import io
import json
import tracemalloc

import numpy as np
import pytest
import shapes

from feederscrew.errors import FeederError
from feederscrew.resting import profiles

ROUND = 5e-4  # of a printed share


@pytest.fixture(scope="module")
def files(request):
    return sorted((request.config.rootpath / "docs/measured").glob("*.csv"))


def rows(text):
    return list(csv.DictReader(line for line in text.splitlines() if line[0] != "#"))


def test_the_files_hold_what_was_published(files, request):
    root = request.config.rootpath
    printed = {row["x_over_y"]: row for row in rows((root / "tests/data/square_cuboids.csv").read_text())}
    heads = [profiles.parse_count_sheet(profiles.read_count_text(path)[0], str(path)) for path in files]
    cuboids = [table for table in heads if table.head.series == "square cuboids"]
    assert len(cuboids) == len(printed) == 8
    for table in cuboids:
        ratio = table.head.note.split()[2]
        counts = sorted(int(row[1]) for _, row in table.rows)
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


def test_for_people_and_for_programs(run, files):
    some = [path for path in files if path.stem in ("short_cube", "t_shape")]
    done = run("compare", *some)
    table = done.stdout.splitlines()
    assert max(map(len, table)) <= 100 and "Left out of the table: QUASISTATIC" in done.stderr  # 146 once
    assert "recommended" in table[0] and "PMI" in table[0]
    assert table[0].split()[:4] == ["set", "launch", "parts", "inside"] and len(table) == 3
    told = json.loads(run("compare", *some, "--format", "json").stdout)
    cube = told["sets"][0]
    assert cube["launch"] == "drop" and cube["fractions"] == [0.62, 0.38]
    assert sum(cube["answers"]["recommended"]) == pytest.approx(1.0, abs=1e-9)
    assert cube["recommended"]["low"][1] <= cube["answers"]["recommended"][1]


def test_another_mesh_than_the_one_counted_is_a_warning(run, files, tmp_path):
    (cube,) = [path for path in files if path.stem == "short_cube"]
    text = cube.read_text().replace("# part: ", f"# part: {cube.parent}/").replace("# mesh: c0", "# mesh: ff")
    (tmp_path / "c.csv").write_text(text)
    done = run("compare", "c.csv")
    assert done.exit_code == 0
    line, left_out = done.stderr.splitlines()
    assert left_out.startswith("Left out of the table: ")
    assert line.startswith("Warning: c.csv: counted with another part file: its mesh is ff5f7fbd, that of ")
    old = run("compare", cube.parent / "short_cube.stl", "--with", "c.csv")
    assert line in old.stderr.splitlines() and old.exit_code == 0
    counts = cube.parent / "cuboid_047.csv"
    told = run("calibrate", cube.parent / "cuboid_075.stl", "--with", counts).stderr
    assert f"Warning: {counts}: counted with another part file" in told


def test_a_file_without_a_part_and_one_with_a_fault(run, tmp_path):
    (tmp_path / "a.csv").write_text("aspect,x\nA,1\n")
    (tmp_path / "b.csv").write_text("# part: none.stl\naspect,x\nA,1\n")
    done = run("compare", "a.csv", "b.csv")
    assert done.exit_code == 1
    assert done.stderr.splitlines() == [
        "Error: a.csv: does not say which part was counted - add a line '# part: FILE' at its top",
        "Error: none.stl: no such file - check the path",
    ]


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
    rows = list(csv.DictReader(io.StringIO(done.stdout)))
    assert [row["device"] for row in rows] == ["wiper_2", "track", "wiper_1"]
    assert (tmp_path / "out/block/devices.csv").read_text() == done.stdout
    aspects = json.loads(run("aspects", "block.stl", "--format", "json").stdout)["aspects"]
    p = {round(2 * one["height_mm"]): one["p_recommended"] for one in aspects}
    assert float(rows[2]["predicted"]) == pytest.approx(p[8] + p[12], abs=1e-5)  # 20 mm does not pass
    assert float(rows[0]["predicted"]) == pytest.approx(p[8] / (p[8] + p[12]), abs=1e-5)
    assert float(rows[0]["measured"]) == pytest.approx(0.88) and rows[1]["agrees"] == "True"
    shown = run("compare", "c.csv").stdout.splitlines()
    assert max(map(len, shown)) <= 100 and "0.880 (0.802 to 0.930)" in shown[1]
    many = json.loads(run("compare", "c.csv", "--format", "json").stdout)
    assert many["sets"] == [] and many["feeding_tests"][0]["config"] == "bowl.yaml"
    fitted = json.loads(run("calibrate", "block.stl", "--with", "c.csv", "--format", "json").stdout)
    (found,) = fitted["calibrations"]
    assert found["counts"] == "devices" and found["exponent_low"] < found["exponent"] < 8.0
    assert found["degrees_of_freedom"] in (None, 1)


def test_the_example_of_a_feeding_test_is_one(request):
    text, sha256 = profiles.read_count_text(request.config.rootpath / "docs/measured/example/feeding.csv")
    known = profiles.device_counts(profiles.parse_count_sheet(text, "feeding.csv"), "feeding.csv", sha256)
    assert known.names == ("wiper", "gap") and known.head.config == "bowl.yaml"
    page = (request.config.rootpath / "docs/counts.md").read_text()
    assert all(
        f"{name},{on:.0f},{off:.0f}" in page
        for name, on, off in zip(known.names, known.passed, known.rejected)
    )


def test_counts_by_device_name_their_bowl_and_are_no_shares(run, request, tmp_path):
    part = request.config.rootpath / "parts/lbracket_30x20x15.stl"
    (tmp_path / "c.csv").write_text("device,passed,rejected\nwiper,3,4\n")
    for command in ("compare", "calibrate"):
        done = run(command, part, "--with", "c.csv")
        what = "c.csv: counts by device but does not name the bowl - add a line '# config: FILE' at its top"
        assert (done.exit_code, done.stderr) == (1, f"Error: {what}\n")
    done = run("rate", part, "--aspect", "A", "--probabilities", "c.csv")
    what = "c.csv:1: counts by device, which does not say how often the part lies on each aspect"
    assert (done.exit_code, done.stderr) == (1, f"Error: {what} - give counts by aspect or by orientation\n")
