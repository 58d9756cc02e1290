"""The suite itself: what it counts as entered, and what skips without an extra."""

import inspect
import os
import subprocess
import sys

import entered
from command_lines import ROOT

SOURCE = """
import functools

def plain(a, b=2, *, c=3):
    return a + b + c

@functools.cache
def cached():
    return plain(1)

def steps(count):
    yield from range(count)

def never():
    return (lambda: 1)()

class Thing:
    @property
    def size(self):
        return 4

    @staticmethod
    def other(a):
        return a
"""


def test_a_function_counts_once_it_is_entered(tmp_path, monkeypatch):
    monkeypatch.setattr(entered, "ENTERED", set())
    monkeypatch.setattr(entered, "WAITING", {})
    names = {"__name__": "sample"}
    exec(compile(SOURCE, str(tmp_path / "sample.py"), "exec"), names)
    signature = inspect.signature(names["plain"])
    entered.replace_all(names, str(tmp_path / "sample.py"), entered.ROOT / "sample.py")
    assert inspect.signature(names["plain"]) == signature and not entered.ENTERED
    assert [names["cached"](), names["cached"](), names["plain"](1, c=0)] == [6, 6, 3]
    assert inspect.signature(names["plain"]) == signature
    thing = names["Thing"]()
    assert [thing.size, thing.other(5), *names["steps"](2)] == [4, 5, 0, 1]
    there = ("cached", "plain", "steps", "Thing.size", "Thing.other")
    assert {f"sample.py:{name}" for name in there} == entered.ENTERED  # never is not entered


def test_every_function_of_the_program_is_counted_but_those_that_numba_reads():
    functions = entered.everything()
    assert {"feederscrew/base/units.py:quantity_text", "cli/options.py:part"} & functions
    compiled = "/kernel/", "feederscrew/motion/steady.py", "feederscrew/resting/walks.py"
    assert not [name for name in functions if any(path in name for path in compiled)]
    assert entered.ENTERED & functions and set(entered.WAITING) <= functions


def without(names, *call):
    """What a Python process says that does not find some packages and programs."""
    own = {**os.environ, "PYTHONPATH": str(ROOT / "tests/without"), "TESTS_WITHOUT": names}
    done = subprocess.run([sys.executable, *call], cwd=ROOT, capture_output=True, text=True, env=own)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def test_what_is_hidden_by_make_test_without_is_not_found_and_its_tests_skip():
    asked = (
        "import importlib.util as i, shutil as s; "
        "print([i.find_spec(n) is None for n in ('lxml', 'yaml')], s.which('sh'), s.which('env') is None)"
    )
    assert without("lxml,sh", "-c", asked) == "[True, False] None False\n"
    assert without("", "-c", asked).startswith("[False, False] /")
    body = "tests/cad/test_leans.py::test_a_step_higher_than_the_plate_is_one_exact_body"
    said = without("OCP", "-m", "pytest", "-m", "extra", "-rs", "-p", "no:cacheprovider", body)
    assert "1 skipped" in said and "needs OCP: pip install 'feederscrew[cad]'" in said


def test_no_parameter_of_a_test_is_a_solid(request):
    """A solid that lives to the end of the program is told as leaked, in two screens after the last test."""
    values = [
        value
        for item in request.session.items
        for value in getattr(getattr(item, "callspec", None), "params", {}).values()
    ]
    assert not [value for value in values if type(value).__module__.startswith("manifold3d")]
