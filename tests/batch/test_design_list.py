"""Designs of a list: each with its target, faults in the table, nothing begun without a target."""

import csv
import shutil

import pytest

from feederscrew import errors
from feederscrew.batch.inputs import read_orders
from feederscrew.designing import loop

HEAD = "part,target,aspect\n"


@pytest.fixture
def list_of_two(tmp_path, request, monkeypatch):
    for name in ("washer_m6.stl", "dowel_6x20.stl"):
        shutil.copy(request.config.rootpath / "parts" / name, tmp_path)
    monkeypatch.chdir(tmp_path)
    (tmp_path / "list.csv").write_text(f"# two\n{HEAD}washer_m6.stl,30/min,A\ndowel_6x20.stl,,\n")
    return tmp_path


def test_each_line_is_designed_for_its_own_target_and_a_fault_stops_no_other(list_of_two, run, monkeypatch):
    asked = []

    def refuse(part, bowl, given, request, **_search):
        asked.append((part.name, 60.0 * request.target, request.aspect))
        raise errors.FeederError(part.source, "is not designed here", "go on")

    monkeypatch.setattr(loop, "design", refuse)
    done = run("design", "--batch", "list.csv", "--target", "45/min", "-o", "out")
    assert done.exit_code == 1 and done.stderr.count("is not designed here") == 2
    assert asked == [("washer_m6", pytest.approx(30.0), "A"), ("dowel_6x20", pytest.approx(45.0), None)]
    with (list_of_two / "out/designs/designs.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert [float(row["target_per_minute"]) for row in rows] == pytest.approx([30.0, 45.0])
    assert [row["status"] for row in rows] == ["failed", "failed"]


@pytest.mark.parametrize(
    ("call", "said"),
    [
        (["--batch", "list.csv"], "list.csv:4 has no target"),
        (["--batch", "list.csv", "washer_m6.stl", "--target", "45/min"], "--batch goes with one list"),
        (["--batch", "list.csv", "--target", "45/min", "--aspect", "A"], "--aspect is of one part"),
        (["washer_m6.stl"], "Missing option '--target'"),
    ],
)
def test_a_wrong_call_begins_nothing(list_of_two, run, monkeypatch, call, said):
    monkeypatch.setattr(loop, "design", None)
    done = run("design", *call)
    assert done.exit_code == 2 and said in done.stderr


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (HEAD + "a.stl,fast,\n", "list.csv:2: target 'fast' is no rate"),
        (HEAD + ",40/min,\n", "list.csv:2: names no part"),
        ("part,rate\na.stl,3\n", "is not the head of a list"),
        (HEAD, "lists no part"),
    ],
)
def test_a_wrong_list_is_one_line(tmp_path, text, said):
    (tmp_path / "list.csv").write_text(text)
    with pytest.raises(errors.ConfigError) as fault:
        read_orders(str(tmp_path / "list.csv"))
    assert said in str(fault.value)
