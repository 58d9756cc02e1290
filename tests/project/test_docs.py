"""The documents against the program: every example runs, every command is as it says."""

import contextlib
import io
import re
import subprocess
import sys
from pathlib import Path

import pytest

LOOKED_AT = True  # the library page shows the size of a picture
ROOT = Path(__file__).parents[2]
EXAMPLE = re.compile(r"```python\n(.*?)```\n(?:\n```\n(.*?)```)?", re.DOTALL)


@pytest.mark.thorough
def test_the_examples_of_the_library_page_print_what_it_shows(monkeypatch):
    monkeypatch.chdir(ROOT)
    names = {"__name__": "library"}
    examples = EXAMPLE.findall((ROOT / "docs/library.md").read_text())
    assert len(examples) >= 5
    for code, shown in examples:
        printed = io.StringIO()
        with contextlib.redirect_stdout(printed):
            exec(compile(code, "docs/library.md", "exec"), names)
        assert printed.getvalue() == shown


@pytest.mark.parametrize("name", ["commands", "equations", "rules", "bowl_file", "validation", "designs"])
def test_a_generated_page_is_as_the_program_is(name):
    call = [sys.executable, f"docs/{name}.py", "--check"]
    done = subprocess.run(call, capture_output=True, text=True, cwd=ROOT)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", ""), f"run: python docs/{name}.py"


def test_the_modules_that_the_pages_name_are_there():
    pages = [ROOT / "README.md", *(ROOT / "docs").rglob("*.md")]
    named = {path for page in pages for path in re.findall(r"`([\w/]+/\w+\.py)`", page.read_text())}
    assert len(named) > 10
    rooms = (ROOT, ROOT / "feederscrew")
    assert not [path for path in named if not any((room / path).exists() for room in rooms)]
