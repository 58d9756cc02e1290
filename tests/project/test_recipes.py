"""Each recipe of docs/contributing.md, applied to a copy of the project, does what the page says."""

import json
import os
import re
import shlex
import shutil
import subprocess
import sys

import pytest
from command_lines import ROOT

PAGE = (ROOT / "docs/contributing.md").read_text()
BLOCK = re.compile(r"<!-- (new|in|runs|shows) ?(.*?) ?-->\n```(?:python|sh|)\n(.*?)```", re.DOTALL)
CHANGE = re.compile(r"(\S+) (after|instead of) (.*)", re.DOTALL)
CHAPTERS = {chapter.splitlines()[0]: BLOCK.findall(chapter) for chapter in PAGE.split("\n## ")[1:]}
RECIPES = {title: blocks for title, blocks in CHAPTERS.items() if blocks}
RUN = """  # one process for pages and commands: each imports the library
import importlib, json, sys
from click.testing import CliRunner
pages, calls, sys.argv = sys.argv[1].split(), json.loads(sys.argv[2]), ["page", "--check"]
sys.path.insert(0, "docs")
if any([importlib.import_module(page).main() for page in pages]):
    sys.exit("a page is out of date")
from feederscrew_cli.main import feeder
ends = [CliRunner().invoke(feeder, words) for words in calls]
print(json.dumps([[end.exit_code, end.output] for end in ends]))
"""
COPIED = ("feederscrew", "cli", "docs", "configs", "parts")
PAGES = ("commands", "bowl_file")  # that are made from the program; of rules alone there is a third


@pytest.fixture
def copy(tmp_path):
    """A copy of the sources, compiled or not, and of the pages; the commands under their installed name."""
    ignore = shutil.ignore_patterns("*.png", "*.pyc.*")
    for name in COPIED:
        shutil.copytree(ROOT / name, tmp_path / name, ignore=ignore)
    (tmp_path / "feederscrew_cli").symlink_to("cli")
    shutil.copy(ROOT / "pyproject.toml", tmp_path)
    for path in sorted((tmp_path / "docs/measured").glob("*.csv"))[1:]:  # each is answered by drops anew
        path.unlink()
    return tmp_path


def apply(root, where, text):
    name, how, line = CHANGE.fullmatch(where).groups()
    old = (root / name).read_text()
    assert old.count(f"{line}\n") == 1, f"{name} has not one line: {line}"
    (root / name).write_text(old.replace(f"{line}\n", (f"{line}\n" if how == "after" else "") + text))


def run(root, *call):
    environment = os.environ | {"PYTHONPATH": str(root)}
    done = subprocess.run(call, cwd=root, env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout + done.stderr


def follow(root, names):
    """Do what recipes say; the process that shows their results checks the pages first."""
    blocks = [block for name in names for block in RECIPES[name]]
    for kind, where, text in blocks:
        if kind == "new":
            (root / where).write_text(text)
        elif kind == "in":
            apply(root, where, text)
    lines = [line for kind, _, text in blocks if kind == "runs" for line in text.strip().split(" && ")]
    for line in dict.fromkeys(lines):
        run(root, sys.executable, *shlex.split(line)[1:])
    pages = (*PAGES, *(["rules"] if any("rule" in name for name in names) else []))
    shown = [(where, shlex.split(text)[1:]) for kind, where, text in blocks if kind == "shows"]
    calls = json.dumps([words for _, words in shown])
    said = run(root, sys.executable, "-c", RUN, " ".join(pages), calls).splitlines()[-1]
    for (where, words), (status, output) in zip(shown, json.loads(said), strict=True):
        assert status == 0 and where in output, (words, output)  # a fault may name what is not there


def test_every_recipe_is_here():
    assert list(RECIPES) == [
        "A new device", "A new probability rule", "A new picture", "A new key of the bowl file",
        "A new column of a table", "A new file format",
    ]  # fmt: skip
    assert all(blocks[-1][0] == "shows" for blocks in RECIPES.values())


def test_the_recipes_do_what_they_say_and_leave_lint_and_pages_as_they_should_be(copy):
    """Import order, units of docstrings and files that are made from a key were forgotten once.

    All are followed on one copy; each by itself where `.ci/run` asks for types and docstrings too.
    """
    follow(copy, list(RECIPES))
    for check in (["check"], ["format", "--check"]):
        run(copy, sys.executable, "-m", "ruff", *check, "--no-cache", "feederscrew", "cli", "docs")


@pytest.mark.skipif("FEEDER_RECIPES" not in os.environ, reason="half a minute each: .ci/run asks for them")
@pytest.mark.thorough
@pytest.mark.parametrize("name", list(RECIPES))
def test_after_a_recipe_types_and_docstrings_hold(copy, name):
    """The tests that read every module are run on the copy."""
    shutil.copytree(ROOT / "tests", copy / "tests", ignore=shutil.ignore_patterns("__pycache__"))
    follow(copy, [name])
    names = ("project/test_docstrings", "test_layers", "bowl/test_bowl", "bowl/test_json_schema")
    tests = [f"tests/{name}.py" for name in (*names, "test_api_settings")]
    own = ("--basetemp", str(copy / "temporary"))  # else two runs at once clear away each other's
    run(copy, sys.executable, "-m", "pytest", "-q", "-x", "-p", "no:cacheprovider", *own, *tests)
    run(copy, sys.executable, "-m", "mypy", "--cache-dir", str(copy / ".mypy_cache"))
