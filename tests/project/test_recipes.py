"""Each recipe of docs/contributing.md, applied to a copy of the project, does what the page says."""

import os
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs/contributing.md").read_text()
BLOCK = re.compile(r"<!-- (new|in|shows) (.*?) -->\n```(?:python|sh|)\n(.*?)```", re.DOTALL)
CHANGE = re.compile(r"(\S+) (after|instead of) (.*)", re.DOTALL)
RECIPES = {
    chapter.splitlines()[0]: blocks
    for chapter in PAGE.split("\n## ")[1:]
    if (blocks := BLOCK.findall(chapter))
}
RUN = "from feederscrew_cli.main import feeder; feeder()"


@pytest.fixture
def copy(tmp_path):
    """A copy of the sources; the commands under their installed name."""
    ignore = shutil.ignore_patterns("__pycache__", "*.nbi", "*.nbc")
    shutil.copytree(ROOT / "feederscrew", tmp_path / "feederscrew", ignore=ignore)
    shutil.copytree(ROOT / "cli", tmp_path / "feederscrew_cli", ignore=ignore)
    (tmp_path / "parts").symlink_to(ROOT / "parts")
    return tmp_path


def apply(root, kind, where, text):
    if kind == "new":
        (root / where).write_text(text)
        return
    name, how, line = CHANGE.fullmatch(where).groups()
    old = (root / name).read_text()
    assert old.count(f"{line}\n") == 1, f"{name} has not one line: {line}"
    (root / name).write_text(old.replace(f"{line}\n", (f"{line}\n" if how == "after" else "") + text))


def test_every_recipe_is_here():
    assert list(RECIPES) == [
        "A new device", "A new probability rule", "A new picture", "A new key of the bowl file",
    ]  # fmt: skip


@pytest.mark.parametrize("name", list(RECIPES))
def test_a_recipe_does_what_it_says(copy, name):
    *changes, (kind, shown, command) = RECIPES[name]
    assert kind == "shows"
    for change in changes:
        apply(copy, *change)
    call = [sys.executable, "-c", RUN, *shlex.split(command)[1:]]
    environment = os.environ | {"PYTHONPATH": str(copy)}
    done = subprocess.run(call, cwd=copy, env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert shown in done.stdout + done.stderr
