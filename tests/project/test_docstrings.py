"""What a public numeric function says of its arrays and numbers: kind, shape and unit."""

import ast
import re
from pathlib import Path

import pytest

PACKAGE = Path(__file__).parents[2] / "feederscrew"
ROOMS = ("geometry", "part", "resting", "screw", "mechanics", "conveying", "dropping", "tooling", "rates",
         "trial", "machine", "solidbowl")  # fmt: skip
ALGEBRA = {"geometry/vectors.py", "geometry/coordinates.py", "geometry/groups.py"}  # of any unit
NUMERIC = re.compile(r"\b(float|array|array_like)\b")
UNIT = re.compile(r"\[[^\]]+\]")
SHAPE = re.compile(r"\(.*\)|array_like|array|: float|^float|(tuple|list|sequence|dict|range)\b", re.I)


def entries(docstring):
    """The lines of Parameters, Returns and Yields that name a value, each with what is said below it."""
    section, lines = "", docstring.splitlines()
    for place, line in enumerate(lines):
        if place + 1 < len(lines) and re.fullmatch("-{3,}", lines[place + 1]):
            section = line
        elif section in ("Parameters", "Returns", "Yields") and line[:1].strip("- "):
            below = []
            for following in lines[place + 1 :]:
                if not following.startswith("    "):
                    break
                below.append(following)
            yield line, " ".join(below)


def public_functions(room):
    for path in sorted((PACKAGE / room).rglob("*.py")):
        for one in ast.parse(path.read_text()).body:
            if isinstance(one, ast.FunctionDef) and not one.name.startswith("_"):
                yield path.relative_to(PACKAGE).as_posix(), one.name, ast.get_docstring(one) or ""


def numbers_of(room):
    """Place, line and explanation of each value that is a number or an array of them."""
    for path, name, docstring in public_functions(room):
        for line, below in entries(docstring):
            if NUMERIC.search(line):
                yield f"{path} {name}: {line}", line, below


@pytest.mark.parametrize("room", ROOMS)
def test_every_number_has_a_unit(room):
    without = [
        place
        for place, line, below in numbers_of(room)
        if not UNIT.search(line + below) and place.split()[0] not in ALGEBRA
    ]
    assert without == []


@pytest.mark.parametrize("room", ROOMS)
def test_every_number_has_a_shape(room):
    assert [place for place, line, _ in numbers_of(room) if not SHAPE.search(line)] == []


@pytest.mark.parametrize("room", ROOMS)
def test_every_public_function_has_a_docstring(room):
    assert [f"{path} {name}" for path, name, docstring in public_functions(room) if not docstring] == []
