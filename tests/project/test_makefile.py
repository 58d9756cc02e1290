"""The Makefile, driven in a copy of the tree with a stand-in for the program; nothing is installed."""

import os
import re
import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PROGRAM = """#!/bin/sh
echo "$1 $2 $3" >> calls
for word; do case $word in parts/*|configs/*) stem=$(basename "${word%.*}");; esac; done
mkdir -p results/$stem && echo data > results/$stem/$1.csv && echo data > results/$stem/$1.png
"""


@pytest.fixture
def tree(tmp_path):
    """A project with two parts, a card and a bowl, whose program only notes its calls."""
    shutil.copy(ROOT / "Makefile", tmp_path)
    shutil.copy(ROOT / "pyproject.toml", tmp_path)
    for name in ("parts/nut.stl", "parts/lbracket_30x20x15.stl", "parts/card.yaml", "configs/bowl.yaml"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text("")
    (tmp_path / ".venv/bin").mkdir(parents=True)
    (tmp_path / ".venv/bin/feeder").write_text(PROGRAM)
    (tmp_path / ".venv/bin/feeder").chmod(0o755)
    for stamp in (".ready", ".ready-to-test"):
        (tmp_path / ".venv" / stamp).write_text("")
    return tmp_path


def make(tree, *targets):
    environment = {key: value for key, value in os.environ.items() if not key.startswith("MAKE")}
    done = subprocess.run(["make", *targets], cwd=tree, capture_output=True, text=True, env=environment)
    assert done.returncode == 0, done.stderr
    return done.stdout + done.stderr


def calls(tree):
    """What the program was called for since this was last asked."""
    log = tree / "calls"
    lines = sorted(log.read_text().splitlines()) if log.exists() else []
    log.unlink(missing_ok=True)
    return lines


def newer(path, than):
    seconds = than.stat().st_mtime + 5.0
    os.utime(path, (seconds, seconds))


def test_make_alone_lists_every_public_target(tree):
    listed = {line.split()[1] for line in make(tree).splitlines()}
    phony = next(line for line in (ROOT / "Makefile").read_text().splitlines() if line.startswith(".PHONY"))
    assert listed == set(phony.split()[1:])


def test_every_part_gets_its_aspects_once(tree):
    make(tree, "-j2", "all-aspects")
    assert calls(tree) == [
        "aspects parts/card.yaml -o", "aspects parts/lbracket_30x20x15.stl -o", "aspects parts/nut.stl -o",
    ]  # fmt: skip
    make(tree, "-j2", "all-aspects")
    assert calls(tree) == []


def test_a_changed_part_is_made_again_alone(tree):
    make(tree, "all-aspects", "inertia")
    calls(tree)
    newer(tree / "parts/nut.stl", than=tree / "results/nut/aspects.csv")
    make(tree, "all-aspects")
    assert calls(tree) == ["aspects parts/nut.stl -o"]


def test_a_changed_bowl_makes_its_maps_again(tree):
    make(tree, "maps")
    assert calls(tree) == ["slide --config configs/bowl.yaml"]
    make(tree, "maps")
    assert calls(tree) == []
    newer(tree / "configs/bowl.yaml", than=tree / "results/bowl/slide.csv")
    make(tree, "maps")
    assert calls(tree) == ["slide --config configs/bowl.yaml"]


def test_the_demo_says_where_the_pictures_are(tree):
    said = make(tree, "demo")
    end = said[-1500:]
    for name in ("aspects", "tooling", "bowl"):
        assert f"results/hexbolt_m8x25/{name}.png" in end
    assert "feeder design parts/" in said[-400:]
    assert [call.split()[0] for call in calls(tree)] == ["aspects", "bowl", "tooling"]


@pytest.mark.parametrize(("goal", "extra"), [("demo", "--editable ."), ("test", "--editable '.[test]'")])
def test_a_bare_machine_gets_its_environment_first(tree, goal, extra):
    shutil.rmtree(tree / ".venv")
    steps = make(tree, "-n", goal).splitlines()
    assert steps[0].endswith("-m venv .venv")
    assert any(step.endswith(extra) for step in steps)


def test_the_environment_follows_pyproject(tree):
    assert "-m venv" not in make(tree, "-n", "demo")
    newer(tree / "pyproject.toml", than=tree / ".venv/.ready")
    assert "-m venv .venv" in make(tree, "-n", "demo")


def test_test_formats_lints_and_tests(tree):
    steps = make(tree, "-n", "test")
    for step in ("ruff format --check .", "ruff check .", "-m mypy", "pytest -n 2"):
        assert step in steps


def test_the_site_has_every_page_once_and_no_other(tree):
    """Its configuration lies where mkdocs looks for it; a page that nobody can reach was built once."""
    [build] = [step for step in make(tree, "-n", "site").splitlines() if "mkdocs build" in step]
    assert "--strict" in build and "--config-file" not in build
    config = (ROOT / "mkdocs.yml").read_text()
    pages = re.findall(r"- ([\w/]+\.md)$", config.partition("\nnav:")[2], re.MULTILINE)
    made = ["api.md", "changelog.md", "overview.md"]  # by docs/site/pages.py
    there = [path.relative_to(ROOT / "docs").as_posix() for path in (ROOT / "docs").rglob("*.md")]
    assert sorted(pages) == sorted([*made, *(page for page in there if not page.startswith("measured"))])


def test_ci_runs_what_a_newcomer_runs_before_it_installs_more():
    script = ROOT / ".ci/run"
    assert os.access(script, os.X_OK)
    steps = [line.strip() for line in script.read_text().splitlines() if not line.startswith("#")]
    demo, test = steps.index("make --quiet demo > /dev/null"), steps.index("make test")
    assert demo < test and not any("install" in step for step in steps[:test])
    assert "-m pytest -m extra" in steps[-1]


def test_the_newest_python_is_sought_by_its_number(tree):
    for name in ("python3.9", "python3.11", "python3.12"):
        (tree / "bin" / name).parent.mkdir(exist_ok=True)
        (tree / "bin" / name).write_text("")
    tried = make(tree, "-n", "test-newest", f"PLACES={tree / 'bin'}").splitlines()
    assert tried[0] == f"{tree / 'bin/python3.12'} -m venv --clear .venv-newest"
