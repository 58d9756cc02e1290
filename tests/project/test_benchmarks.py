"""The benchmarks still run: a body of those that calibrate, and every small change that is tried applies."""

import ast
import shlex
import sys

import numpy as np
import pytest
import shapes


@pytest.fixture
def root(request, monkeypatch):
    """The folder of the project, whose benchmarks can be imported."""
    monkeypatch.setattr(sys, "path", [*sys.path, str(request.config.rootpath / "benchmarks")])
    return request.config.rootpath


@pytest.mark.usefixtures("root")
def test_every_closed_form_that_was_tried_weighs_a_box():
    """One named a function that was gone, so that no table of accuracy could be made again."""
    from bodies import Body

    body = Body("box", shapes.part(shapes.box(8.0, 12.0, 20.0)), drops=1)
    for name, p in body.rules.items():
        assert p.shape == (3,) and np.isclose(p.sum(), 1.0, rtol=1e-9, atol=0), name
        assert p[0] > p[2], name


def test_every_named_change_is_made_in_one_place_and_leaves_a_module_that_can_be_read(root):
    from named_mutants import NAMED

    for name, old, new, test in NAMED:
        text = (root / "feederscrew" / name).read_text()
        assert text.count(old) == 1, f"{name}: {old!r} is in it {text.count(old)} times"
        assert ast.dump(ast.parse(text)) != ast.dump(ast.parse(text.replace(old, new))), f"{name}: {old!r}"
        assert (root / shlex.split(test)[0]).is_file(), test


def test_every_file_that_is_changed_has_tests_and_every_excuse_a_file(root):
    from mutants import EQUIVALENT, FILES

    for name, tests in FILES.items():
        assert (root / "feederscrew" / name).is_file(), name
        assert tests and all((root / test).is_file() for test in tests), name
    assert {name for name, _ in EQUIVALENT} <= set(FILES)


def test_the_change_that_is_asked_for_is_made_and_no_other(root, rng):
    """A minus, a comparison, a minimum and two numbers, each by itself."""
    from mutants import difference, mutants

    text = "def least(a, b):\n    return min(a, -b) if a < 2 else 3.0\n"
    made = {difference(text, other).partition("->")[2].strip() for other, _ in mutants(text, 9, rng)}
    assert made == {
        "return max(a, -b) if a < 2 else 3.0",
        "return min(a, b) if a < 2 else 3.0",
        "return min(a, -b) if a >= 2 else 3.0",
        "return min(a, -b) if a < 3 else 3.0",
        "return min(a, -b) if a < 2 else 3.75",
    }
