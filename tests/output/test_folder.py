"""The folder of results: all files or none, never another input's."""

import json
import multiprocessing
import os
import re
import shutil
import signal
import subprocess
import sys
import threading
import time
from types import SimpleNamespace

import pytest

from feederscrew.base.errors import FeederError
from feederscrew.output import folder as result_folder
from feederscrew.output import offers
from feederscrew.output.folder import ResultFolder, safe_name

PART = {"parts/nut.stl": "aa" * 32}
ANOTHER = "give another folder to `directory`"


def run(root, files, command="aspects", identity=PART, **more):
    folder = ResultFolder(root, "nut", identity)
    for name, content in files.items():
        folder.write(name, content)
    folder.keep(command, **more)


def record(root):
    return json.loads((root / "nut/run.json").read_text())


def tree(root):
    return {str(path.relative_to(root)): path.read_bytes() for path in root.rglob("*") if path.is_file()}


def refused(root, files, identity=PART):
    with pytest.raises(FeederError) as caught:
        run(root, files, identity=identity)
    return str(caught.value)


def test_files_and_their_record(tmp_path):
    values = {"arguments": ["aspects", "parts/nut.stl"], "warnings": ["odd"]}
    values["effective"] = {"density_g_cm3": 7.85}
    run(tmp_path / "res", {"a.csv": "x\n", "deep/b.png": b"\x89PNG"}, **values)
    assert sorted(tree(tmp_path / "res")) == ["nut/a.csv", "nut/deep/b.png", "nut/run.json"]
    entry = record(tmp_path / "res")["aspects"]
    assert {name: entry[name] for name in values} == values and entry["files"] == ["a.csv", "deep/b.png"]
    assert [one["sha256"] for one in entry["inputs"]] == ["aa" * 32]
    assert {"python", "numpy", "scipy", "numba"} <= set(entry["libraries"])
    # Names that every file system takes.
    names = {"nut": "nut", "a:b?": "a_b_", "con": "con_", "COM1.x": "COM1.x_", "dots..": "dots"}
    names |= {"..": "_", "": "_"}
    assert {name: safe_name(name) for name in names} == names


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
    files = {name: content for name, content in tree(tmp_path).items() if "run" not in name}
    assert files == {"nut/a.csv": b"4", "nut/i.csv": b"3"}
    assert list(record(tmp_path)) == ["aspects", "inertia"]


def test_nothing_is_on_disk_before_keep(tmp_path):
    ResultFolder(tmp_path / "a/b", "nut", PART).write("a.csv", "x")
    assert list(tmp_path.iterdir()) == []


def test_a_failure_while_writing_leaves_nothing(tmp_path, monkeypatch):
    def full(path, content):
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content[:1])
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("feederscrew.output.folder._write", full)
    line = refused(tmp_path / "res", {"a.csv": "xyz"})
    assert "nut: cannot be written (No space left on device) - give another" in line
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("first", "second", "owner"),
    [
        (PART, {"other/nut.stl": "bb" * 32}, "another file, {}"),
        ({}, PART, "a run without a file"),
        (PART, {}, "another file, {}"),
        ({"-": "aa" * 32}, {"-": "bb" * 32}, "another file, -"),  # standard input
    ],
)
def test_another_parts_results_are_not_overwritten(tmp_path, first, second, owner):
    run(tmp_path, {"a.csv": "x\n"}, identity=first)
    run(tmp_path, {"a.csv": "x\n"}, identity=first)
    before, line = tree(tmp_path), refused(tmp_path, {"b.csv": "y\n"}, second)
    owner = owner.format(os.path.relpath("parts/nut.stl", tmp_path / "nut"))
    assert line.startswith(f"{tmp_path / 'nut'}: holds the results of {owner} - {ANOTHER}")
    assert tree(tmp_path) == before


@pytest.mark.parametrize("identity", [{"parts/nut.stl": "bb" * 32}, {"copy/nut.stl": "aa" * 32}])
def test_a_part_that_changed_or_moved_may_be_run_again(tmp_path, identity):
    run(tmp_path, {"a.csv": "x\n"})
    run(tmp_path, {"a.csv": "y\n"}, identity=identity)
    assert (tmp_path / "nut/a.csv").read_text() == "y\n"


@pytest.mark.parametrize("text", ["{", "[]", '{"aspects": 3}', '{"aspects": {}}', "\xff"])
def test_a_record_of_something_else_is_refused(tmp_path, text):
    (tmp_path / "nut").mkdir()
    (tmp_path / "nut/run.json").write_bytes(text.encode("latin-1"))
    assert re.search(r"run.json: is not a record of a run - remove", refused(tmp_path, {"a.csv": "x\n"}))


def test_what_is_no_folder_or_may_not_be_written(tmp_path, monkeypatch):
    (tmp_path / "file").write_text("")
    assert refused(tmp_path / "file", {}) == f"{tmp_path / 'file'}: is a file, not a folder - {ANOTHER}"
    monkeypatch.setattr(os, "access", lambda path, mode: False)
    assert refused(tmp_path / "res", {}) == f"{tmp_path}: may not be written to - {ANOTHER}"


def test_a_result_stays_in_its_folder_and_a_forged_record_deletes_nothing_outside(tmp_path):
    for name in ("../a", "/a", "", "run.json", "a\\b"):
        with pytest.raises(ValueError, match="not a name"):
            ResultFolder(tmp_path, "nut", PART).write(name, "x")
    (tmp_path / "precious").write_text("x")
    run(tmp_path, {"a.csv": "x\n"})
    text = (tmp_path / "nut/run.json").read_text().replace('"a.csv"', '"../precious"')
    (tmp_path / "nut/run.json").write_text(text)
    run(tmp_path, {"b.csv": "x\n"})
    assert (tmp_path / "precious").exists()


def run_named(root, command):
    run(root, {f"{command}.csv": command}, command=command)


def test_commands_that_run_at_once_all_get_into_the_record(tmp_path):
    commands = [f"c{k}" for k in range(8)]
    with multiprocessing.get_context("spawn").Pool(2) as pool:
        pool.starmap(run_named, [(tmp_path, command) for command in commands])
    assert sorted(record(tmp_path)) == commands
    assert len(tree(tmp_path)) == 9


@pytest.mark.skipif(shutil.which("make") is None, reason="needs make")
def test_make_reads_a_rule_with_odd_names(tmp_path):
    text = result_folder.rule(["out/a.csv", "out/a.png"], ["a.stl", "bowl.yaml"])
    assert text == "out/a.csv out/a.png: a.stl \\\n  bowl.yaml\na.stl:\nbowl.yaml:\n"  # an input may go
    names = ["my part.stl", "a$b.stl", "a#b.stl"]
    for name in names:
        (tmp_path / name).touch()
    result_folder.write_rule(tmp_path / "x.d", ["out.csv"], names)
    (tmp_path / "Makefile").write_text("all: out.csv\ninclude x.d\nout.csv:\n\t@touch $@; echo made\n")
    calls = [subprocess.run(["make", "-s"], cwd=tmp_path, capture_output=True, text=True) for _ in range(2)]
    assert [call.stdout for call in calls] == ["made\n", ""], calls[0].stderr


def test_pages_are_made_beside_the_rest_on_two_cores(monkeypatch):
    made, own = {}, os.getpid()
    monkeypatch.setattr(threading, "active_count", lambda: 1)

    def where():
        return "here" if os.getpid() == own else "beside"

    def fails():
        return where() if os.getpid() == own else 1 // 0

    names = ("a.html", "b.png", "c.csv", "d.png")
    offered = [offers.Offer(name, fails if name == "d.png" else where) for name in names]
    files = SimpleNamespace(write=made.__setitem__, left_out=[])
    offers.write(files, offered, jobs=2)
    beside = "beside" if sys.platform.startswith("linux") else "here"
    assert made == {"c.csv": "here", "a.html": beside, "b.png": beside, "d.png": "here"}
    assert not multiprocessing.active_children()


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="nothing is made beside")
def test_an_interrupt_ends_what_is_made_beside_and_keeps_the_tables(monkeypatch):
    made = {}
    monkeypatch.setattr(threading, "active_count", lambda: 1)
    offered = [offers.Offer("slow.png", lambda: time.sleep(60.0)), offers.Offer("a.csv", str)]
    offered.append(offers.Offer("b.html", lambda: time.sleep(0.2) or "page"))
    offered.append(offers.Offer("own.png", lambda: time.sleep(60.0), is_apart=True))
    files = SimpleNamespace(write=made.__setitem__, left_out=[])
    # as a terminal sends it: to the process, whose main thread it wakes; raised in a thread it would not
    timer = threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT))
    timer.start()
    before = time.monotonic()
    offers.write(files, offered, jobs=2)
    assert time.monotonic() - before < 30.0  # neither picture of a minute was waited for
    assert (made, files.left_out) == ({"a.csv": "", "b.html": "page"}, ["own.png", "slow.png"])
    assert not multiprocessing.active_children()
