"""The Makefile, driven in a copy of the tree with a stand-in for the program; nothing is installed."""

import os
import re
import shutil
import subprocess

import pytest
from command_lines import ROOT

PROGRAM = """#!/bin/sh
echo "$1 $2 $3" >> calls
for word; do case $word in parts/*|configs/*) stem=$(basename "${word%.*}");; esac; done
mkdir -p results/$stem && echo data > results/$stem/$1.csv && echo data > results/$stem/$1.png
"""


@pytest.fixture
def tree(tmp_path):
    """A project with two parts, a card and a bowl, whose program only notes its calls."""
    for name in ("Makefile", "pyproject.toml"):
        shutil.copy(ROOT / name, tmp_path)
    stamps = (".venv/.ready", ".venv/.ready-to-test")
    parts = ("parts/nut.stl", "parts/lbracket_30x20x15.stl", "parts/card.yaml", "configs/bowl.yaml")
    for name in (".venv/bin/feeder", *stamps, *parts):
        (tmp_path / name).parent.mkdir(exist_ok=True, parents=True)
        (tmp_path / name).write_text(PROGRAM if name.endswith("feeder") else "")
    (tmp_path / ".venv/bin/feeder").chmod(0o755)
    return tmp_path


def make(tree, *targets):
    environment = {key: value for key, value in os.environ.items() if not key.startswith("MAKE")}
    done = subprocess.run(["make", *targets], cwd=tree, capture_output=True, text=True, env=environment)
    assert done.returncode == 0, done.stderr
    return done.stdout + done.stderr


def calls(tree, *targets):
    (tree / "calls").write_text("")
    make(tree, *targets)
    return sorted((tree / "calls").read_text().splitlines())


def newer(path, than):
    seconds = than.stat().st_mtime + 5.0
    os.utime(path, (seconds, seconds))


def test_make_alone_lists_every_public_target(tree):
    listed = {line.split()[1] for line in make(tree).splitlines()}
    phony = next(line for line in (ROOT / "Makefile").read_text().splitlines() if line.startswith(".PHONY"))
    assert listed == set(phony.split()[1:])


def test_what_has_changed_is_made_again_alone(tree):
    parts = ("card.yaml", "lbracket_30x20x15.stl", "nut.stl")
    assert calls(tree, "-j2", "all-aspects") == [f"aspects parts/{part} -o" for part in parts]
    assert calls(tree, "-j2", "all-aspects") == []
    newer(tree / "parts/nut.stl", than=tree / "results/nut/aspects.csv")
    assert calls(tree, "all-aspects") == ["aspects parts/nut.stl -o"]
    assert calls(tree, "maps") == ["slide --config configs/bowl.yaml"] and calls(tree, "maps") == []
    newer(tree / "configs/bowl.yaml", than=tree / "results/bowl/slide.csv")
    assert calls(tree, "maps") == ["slide --config configs/bowl.yaml"]


def test_the_demo_says_where_the_pictures_are(tree):
    said = make(tree, "demo")
    for name in ("aspects", "tooling", "bowl"):
        assert f"results/hexbolt_m8x25/{name}.png" in said[-1500:]
    assert "feeder design parts/" in said[-400:]
    lines = (tree / "calls").read_text().splitlines()
    assert sorted(line.split()[0] for line in lines) == ["aspects", "bowl", "tooling"]


@pytest.mark.parametrize(("goal", "extra"), [("demo", "--editable ."), ("test", "--editable '.[test]'")])
def test_a_bare_machine_gets_its_environment_first_and_it_follows_pyproject(tree, goal, extra):
    assert "-m venv" not in make(tree, "-n", goal)
    newer(tree / "pyproject.toml", than=tree / ".venv/.ready")
    assert "-m venv .venv" in make(tree, "-n", goal)
    shutil.rmtree(tree / ".venv")
    steps = make(tree, "-n", goal).splitlines()
    assert steps[0].endswith("-m venv .venv") and any(step.endswith(extra) for step in steps)


def test_test_formats_lints_and_tests_and_ci_runs_it_before_it_installs_more(tree):
    made = make(tree, "-n", "test")
    for step in ("ruff format --check .", "ruff check .", "-m mypy", "pytest -n 2"):
        assert step in made
    script = ROOT / ".ci/run"
    assert os.access(script, os.X_OK)
    steps = [line.strip() for line in script.read_text().splitlines() if not line.startswith("#")]
    demo, test = steps.index("make --quiet demo > /dev/null"), steps.index("make test")
    assert demo < test and not any("install" in step for step in steps[:test])
    assert "-m pytest -m extra" in steps[-1]


def test_the_site_has_every_page_once_and_no_other(tree):
    """Its configuration lies where mkdocs looks for it; a page that nobody can reach was built once."""
    [build] = [step for step in make(tree, "-n", "site").splitlines() if "mkdocs build" in step]
    assert "--strict" in build and "--config-file" not in build
    config = (ROOT / "mkdocs.yml").read_text()
    pages = re.findall(r"- ([\w/]+\.md)$", config.partition("\nnav:")[2], re.MULTILINE)
    books = (f"notebooks/{book.stem}.md" for book in (ROOT / "docs/notebooks").glob("*.ipynb"))
    made = ["api.md", "changelog.md", "overview.md", *books]  # by docs/site/pages.py
    there = [path.relative_to(ROOT / "docs").as_posix() for path in (ROOT / "docs").rglob("*.md")]
    assert sorted(pages) == sorted([*made, *(page for page in there if not page.startswith("measured"))])
