"""A test that needs an extra skips without it, and what is hidden by `make test-without` is not there."""

import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[2]


def without(names, *call):
    """What a Python process says that does not find some packages and programs."""
    own = {**os.environ, "PYTHONPATH": str(ROOT / "tests/without"), "FEEDER_WITHOUT": names}
    done = subprocess.run([sys.executable, *call], cwd=ROOT, capture_output=True, text=True, env=own)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def test_what_is_hidden_is_not_found():
    asked = (
        "import importlib.util as i, shutil as s; "
        "print([i.find_spec(n) is None for n in ('lxml', 'yaml')], s.which('sh'), s.which('env') is None)"
    )
    assert without("lxml,sh", "-c", asked) == "[True, False] None False\n"
    assert without("", "-c", asked).startswith("[False, False] /")


def test_a_test_that_needs_an_extra_skips_without_it():
    body = "tests/solidbowl/test_leans.py::test_a_step_higher_than_the_plate_is_one_exact_body"
    told = without("OCP", "-m", "pytest", "-m", "extra", "-rs", "-p", "no:cacheprovider", body)
    assert "1 skipped" in told and "needs OCP: pip install 'feederscrew[cad]'" in told
