"""The folder of results: all files or none, never another input's."""

import json
import multiprocessing
import os
import shutil
import subprocess

import pytest

from feederscrew.errors import FeederError
from feederscrew.output import folder as result_folder
from feederscrew.output.folder import ResultFolder, safe_name

PART = {"parts/nut.stl": "aa" * 32}


def run(root, files, command="aspects", identity=PART, **more):
    with ResultFolder(root, "nut", identity) as folder:
        for name, content in files.items():
            folder.write(name, content)
        folder.keep(command, **more)


def record(root):
    return json.loads((root / "nut/run.json").read_text())


def tree(root):
    return {
        str(path.relative_to(root)): path.read_bytes() for path in sorted(root.rglob("*")) if path.is_file()
    }


def test_files_and_their_record(tmp_path):
    run(
        tmp_path / "res",
        {"a.csv": "x\n", "deep/b.png": b"\x89PNG"},
        arguments=["aspects", "parts/nut.stl"],
        effective={"density_g_cm3": 7.85},
        warnings=["odd"],
    )
    assert sorted(tree(tmp_path / "res")) == ["nut/a.csv", "nut/deep/b.png", "nut/run.json"]
    entry = record(tmp_path / "res")["aspects"]
    assert entry["arguments"] == ["aspects", "parts/nut.stl"]
    assert entry["effective"] == {"density_g_cm3": 7.85}
    assert entry["warnings"] == ["odd"]
    assert entry["files"] == ["a.csv", "deep/b.png"]
    assert [i["sha256"] for i in entry["inputs"]] == ["aa" * 32]
    assert {"python", "numpy", "scipy", "trimesh"} <= set(entry["libraries"])


def test_the_record_does_not_depend_on_where_one_stands(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    run("res", {"a.csv": "x\n"})
    before = tree(tmp_path)
    (tmp_path / "parts").mkdir()
    monkeypatch.chdir(tmp_path / "parts")
    run("../res", {"a.csv": "x\n"}, identity={"nut.stl": "aa" * 32})
    assert tree(tmp_path) == before


def test_commands_share_a_folder_and_keep_each_others_files(tmp_path):
    run(tmp_path, {"a.csv": "1", "a.png": b"2"})
    run(tmp_path, {"i.csv": "3"}, command="inertia")
    run(tmp_path, {"a.csv": "4"})  # without its picture this time
    assert {name: content for name, content in tree(tmp_path).items() if "run" not in name} == {
        "nut/a.csv": b"4",
        "nut/i.csv": b"3",
    }
    assert list(record(tmp_path)) == ["aspects", "inertia"]


@pytest.mark.parametrize("fault", [KeyboardInterrupt, RuntimeError])
def test_a_run_that_stops_leaves_nothing(tmp_path, fault):
    with pytest.raises(fault), ResultFolder(tmp_path / "a/b", "nut", PART) as folder:
        folder.write("a.csv", "x")
        raise fault
    assert list(tmp_path.iterdir()) == []


def test_a_failure_while_writing_leaves_nothing(tmp_path, monkeypatch):
    def full(path, content):
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content[:1])
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("feederscrew.output.folder._write", full)
    with pytest.raises(
        FeederError, match=r"nut: cannot be written \(No space left on device\) - give another"
    ):
        run(tmp_path / "res", {"a.csv": "xyz"})
    assert list(tmp_path.iterdir()) == []


def test_another_parts_results_are_not_overwritten(tmp_path):
    run(tmp_path, {"a.csv": "x\n"})
    before = tree(tmp_path)
    with pytest.raises(FeederError) as caught:
        run(tmp_path, {"a.csv": "y\n"}, identity={"other/nut.stl": "bb" * 32})
    owner = os.path.relpath("parts/nut.stl", tmp_path / "nut")
    assert str(caught.value) == (
        f"{tmp_path / 'nut'}: holds the results of another file, {owner}"
        " - give another folder to `directory`, or rename the file"
    )
    assert tree(tmp_path) == before


@pytest.mark.parametrize(
    "identity",
    [{"parts/nut.stl": "bb" * 32}, {"copy/nut.stl": "aa" * 32}],
    ids=["the file changed", "the file moved"],
)
def test_the_same_part_may_be_run_again(tmp_path, identity):
    run(tmp_path, {"a.csv": "x\n"})
    run(tmp_path, {"a.csv": "y\n"}, identity=identity)
    assert (tmp_path / "nut/a.csv").read_text() == "y\n"


def test_another_part_on_standard_input_is_another_part(tmp_path):
    run(tmp_path, {"a.csv": "x\n"}, identity={"-": "aa" * 32})
    run(tmp_path, {"a.csv": "x\n"}, identity={"-": "aa" * 32})
    with pytest.raises(FeederError, match="another file, - -"):
        run(tmp_path, {"a.csv": "y\n"}, identity={"-": "bb" * 32})


@pytest.mark.parametrize(
    ("first", "second", "told"),
    [
        ({}, PART, "a run without a file - give another folder to `directory`, or rename the file"),
        (PART, {}, "another file, {} - give another folder to `directory`"),
    ],
    ids=["defaults first", "file first"],
)
def test_defaults_and_a_file_do_not_mix(tmp_path, first, second, told):
    run(tmp_path, {"a.csv": "x\n"}, identity=first)
    with pytest.raises(FeederError) as caught:
        run(tmp_path, {"b.csv": "y\n"}, command="slide", identity=second)
    owner = os.path.relpath(next(iter(PART)), tmp_path / "nut")
    assert str(caught.value) == f"{tmp_path / 'nut'}: holds the results of {told.format(owner)}"
    assert {path.name for path in (tmp_path / "nut").iterdir()} == {"a.csv", "run.json"}


@pytest.mark.parametrize("text", ["{", "[]", '{"aspects": 3}', '{"aspects": {}}', "\xff"])
def test_a_record_of_something_else_is_refused(tmp_path, text):
    (tmp_path / "nut").mkdir()
    (tmp_path / "nut/run.json").write_bytes(text.encode("latin-1"))
    with pytest.raises(FeederError, match=r"run.json: is not a record of a run - remove"):
        run(tmp_path, {"a.csv": "x\n"})


def test_o_names_a_file(tmp_path):
    (tmp_path / "res").write_text("")
    with pytest.raises(FeederError) as caught:
        run(tmp_path / "res", {"a.csv": ""})
    assert (
        str(caught.value)
        == f"{tmp_path / 'res'}: is a file, not a folder - give another folder to `directory`"
    )


def test_a_folder_that_may_not_be_written(tmp_path, monkeypatch):
    monkeypatch.setattr(os, "access", lambda path, mode: False)
    with pytest.raises(FeederError) as caught:
        run(tmp_path / "res", {"a.csv": ""})
    assert str(caught.value) == f"{tmp_path}: may not be written to - give another folder to `directory`"


@pytest.mark.parametrize("name", ["../a", "/a", "", "run.json", "a\\b"])
def test_a_result_stays_in_its_folder(tmp_path, name):
    with (
        pytest.raises(ValueError, match="not a name for a result"),
        ResultFolder(tmp_path, "nut", PART) as folder,
    ):
        folder.write(name, "x")


def test_a_forged_record_deletes_nothing_outside(tmp_path):
    (tmp_path / "precious").write_text("x")
    run(tmp_path, {"a.csv": "x\n"})
    text = (tmp_path / "nut/run.json").read_text().replace('"a.csv"', '"../precious"')
    (tmp_path / "nut/run.json").write_text(text)
    run(tmp_path, {"b.csv": "x\n"})
    assert (tmp_path / "precious").exists()


def _one(root, command):
    run(root, {f"{command}.csv": command}, command=command)


def test_commands_that_run_at_once_all_get_into_the_record(tmp_path):
    commands = [f"c{k}" for k in range(8)]
    with multiprocessing.get_context("spawn").Pool(2) as pool:
        pool.starmap(_one, [(tmp_path, command) for command in commands])
    assert sorted(record(tmp_path)) == commands
    assert len(tree(tmp_path)) == 9


@pytest.mark.parametrize(
    ("name", "safe"),
    [
        ("nut", "nut"),
        ("a:b?", "a_b_"),
        ("con", "con_"),
        ("COM1.x", "COM1.x_"),
        ("dots..", "dots"),
        ("..", "_"),
        ("", "_"),
    ],
)
def test_names_that_every_file_system_takes(name, safe):
    assert safe_name(name) == safe


# Rules for make


def test_a_rule_names_targets_and_inputs_and_lets_an_input_go():
    text = result_folder.rule(["out/a.csv", "out/a.png"], ["a.stl", "bowl.yaml"])
    assert text == "out/a.csv out/a.png: a.stl \\\n  bowl.yaml\na.stl:\nbowl.yaml:\n"


@pytest.mark.skipif(shutil.which("make") is None, reason="needs make")
def test_make_reads_odd_names(tmp_path):
    names = ["my part.stl", "a$b.stl", "a#b.stl"]
    for name in names:
        (tmp_path / name).touch()
    result_folder.write_rule(tmp_path / "x.d", ["out.csv"], names)
    (tmp_path / "Makefile").write_text("all: out.csv\ninclude x.d\nout.csv:\n\t@touch $@; echo made\n")
    calls = [subprocess.run(["make", "-s"], cwd=tmp_path, capture_output=True, text=True) for _ in range(2)]
    assert [call.stdout for call in calls] == ["made\n", ""], calls[0].stderr
