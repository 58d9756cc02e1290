"""The library names arguments, the commands name options."""

import ast
import re
from pathlib import Path

import pytest

from feederscrew_cli import argument_names
from feederscrew_cli.main import feeder

LIBRARY = Path(__file__).parents[3] / "feederscrew"
OPTION = re.compile(r"(?:^|[\s(`])(--[a-z]\S*)")
SAID = {
    ("settings.py", "--set"),  # the column of 'config show' that says where a value came from
    ("alternatives.py", "--alternatives"),
    ("record.py", "--up"), ("nearest.py", "--up"),  # what a design offers its user to type
    ("bowl.py", "--aspect"), ("bowl.py", "--config"),  # the command line that finds devices
    *(("site.py", f"--{name}") for name in ("density", "drive", "set", "target", "units")),  # of its design
}  # fmt: skip


def sentences(path):
    """The texts of a module that are not its docstrings."""
    tree = ast.parse(path.read_text())
    documented = {
        id(node.body[0].value)
        for node in ast.walk(tree)
        if isinstance(node, (ast.Module, ast.FunctionDef, ast.ClassDef)) and node.body
        if isinstance(node.body[0], ast.Expr)
    }
    for node in ast.walk(tree):
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in documented:
            yield node.value


def test_no_sentence_of_the_library_names_an_option():
    found = {
        (path.name, option)
        for path in LIBRARY.rglob("*.py")
        for text in sentences(path)
        for option in OPTION.findall(text)
    }
    assert found == SAID


@pytest.mark.parametrize(
    ("command", "text", "told"),
    [
        ("aspects", "pass `allow_open` to compute", "pass --allow-open to compute"),
        ("batch", "pass `allow_open` to compute", "pass allow_open to compute"),
        ("batch", "start again with `resume`", "start again with --resume"),
        ("config", "or pass `replace`", "or pass --force"),
        ("slide", "another folder to `directory`", "another folder to -o"),
    ],
)
def test_an_argument_goes_by_its_option_where_the_command_has_one(command, text, told):
    assert argument_names.translated(text, argument_names.options(feeder.commands[command])) == told
