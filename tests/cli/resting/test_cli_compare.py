"""``feeder compare``: measured aspects against the rules."""

import csv
import io
import json

import pytest

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
