"""The benchmarks still run: a body of those that calibrate, and every small change that is tried applies."""

import ast
import importlib
import inspect
import shlex
import sys

import numpy as np
import pytest
import shapes
from command_lines import ROOT


@pytest.fixture
def root(request, monkeypatch):
    monkeypatch.setattr(sys, "path", [*sys.path, str(request.config.rootpath / "benchmarks")])
    return request.config.rootpath


SCRIPTS = [path for folder in ("benchmarks", "docs") for path in sorted((ROOT / folder).glob("*.py"))]


@pytest.mark.parametrize("path", SCRIPTS, ids=lambda path: f"{path.parent.name}/{path.stem}")
def test_a_script_asks_modules_for_names_that_they_have(path):
    """A function that was renamed left a benchmark behind, which nobody ran."""
    tree, modules = ast.parse(path.read_text()), {}
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("feederscrew"):
            home = importlib.import_module(node.module)
            for name in node.names:
                value = getattr(home, name.name, None)
                value = value or importlib.import_module(f"{node.module}.{name.name}")
                if inspect.ismodule(value):
                    modules[name.asname or name.name] = value
    attributes = [node for node in ast.walk(tree) if isinstance(node, ast.Attribute)]
    assert not [ast.unparse(node) for node in attributes if not _is_there(node, modules)]


def _is_there(node, modules):
    home = _value(node.value, modules)
    return not inspect.ismodule(home) or hasattr(home, node.attr)


def _value(node, modules):
    if isinstance(node, ast.Name):
        return modules.get(node.id)
    home = _value(node.value, modules) if isinstance(node, ast.Attribute) else None
    return getattr(home, node.attr, None) if inspect.ismodule(home) else None


@pytest.mark.usefixtures("root")
def test_every_rule_weighs_a_box():
    """A rule named a function that was gone once, so that no table of accuracy could be made again."""
    from bodies import Body

    body = Body("box", shapes.part(shapes.box(8.0, 12.0, 20.0)), drops=1)
    for name, p in body.rules.items():
        assert p.shape == (3,) and np.isclose(p.sum(), 1.0, rtol=1e-9, atol=0) and p[0] > p[2], name


def test_every_name_that_is_changed_is_there_with_something_to_change_and_with_tests(root, rng):
    import mutants

    for name, tests in mutants.TESTS.items():
        path, inside = mutants.located(name)
        text = path.read_text()
        (other, line), *_ = mutants.mutants(text, inside, 1, rng)
        assert ast.dump(ast.parse(text)) != ast.dump(ast.parse(other)) and line, name
        files = [word for word in shlex.split(tests) if word.endswith(".py")]
        assert files and all((root / file).is_file() for file in files), name
    for name in mutants.EXCUSED:
        path, inside = mutants.located(name)
        assert mutants.named(ast.parse(path.read_text()), inside), name
    with pytest.raises(SystemExit, match=r"there is no such module"):
        mutants.located("sorting_of_old.length")
    with pytest.raises(SystemExit, match=r"there is no gone"):
        mutants.named(ast.parse("here = 1"), ["gone"])


@pytest.mark.usefixtures("root")
def test_the_operators_change_the_function_that_is_named_and_no_other(rng):
    """A number, a minus, a comparison, a minimum, a condition and a sign, each by itself."""
    from mutants import difference, mutants

    text = "SIDE = 3.0\n\ndef least(a, b):\n    c = a\n    return min(c, -b) if a < 2 else b\n"
    inside = [difference(text, other) for other, _ in mutants(text, ["least"], 9, rng)]
    assert {line.partition("->")[2].strip() for line in inside} == {
        "c = -a", "return max(c, -b) if a < 2 else b", "return min(c, b) if a < 2 else b",
        "return min(c, -b) if a >= 2 else b", "return min(c, -b) if a < 3 else b",
        "return b if a < 2 else min(c, -b)",
    }  # fmt: skip
    constants = {difference(text, other) for other, _ in mutants(text, ["SIDE"], 9, rng)}
    assert constants == {"SIDE = 3.0   ->   SIDE = 3.75", "SIDE = 3.0   ->   SIDE = 2.4000000000000004"}
