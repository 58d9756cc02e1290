"""Rules for make."""

import shutil
import subprocess

import pytest

from feederscrew.output import depfile


def test_a_rule_names_targets_and_inputs_and_lets_an_input_go():
    text = depfile.rule(["out/a.csv", "out/a.png"], ["a.stl", "bowl.yaml"])
    assert text == "out/a.csv out/a.png: a.stl \\\n  bowl.yaml\na.stl:\nbowl.yaml:\n"


@pytest.mark.skipif(shutil.which("make") is None, reason="needs make")
def test_make_reads_odd_names(tmp_path):
    names = ["my part.stl", "a$b.stl", "a#b.stl"]
    for name in names:
        (tmp_path / name).touch()
    depfile.write(tmp_path / "x.d", ["out.csv"], names)
    (tmp_path / "Makefile").write_text("all: out.csv\ninclude x.d\nout.csv:\n\t@touch $@; echo made\n")
    calls = [subprocess.run(["make", "-s"], cwd=tmp_path, capture_output=True, text=True) for _ in range(2)]
    assert [call.stdout for call in calls] == ["made\n", ""], calls[0].stderr
