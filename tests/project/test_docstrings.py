"""A function that computes says so in its docstring: the unit of every quantity, the shape of every array."""

import ast
import functools
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2] / "feederscrew"
STAGES = "arrivals bowl feeding machine motion resting sorting trials".split()
UNIT = re.compile(r"\[[^\]\n]{1,60}\]")
SHAPE = re.compile(r"\((?:[A-Za-z0-9.][A-Za-z0-9_+* .]*)?(?:,[^)\n]*)+\)")
ENTRY = re.compile(
    r"^(?:[a-z_, ]+ : .*\b(?:float|array_like)\b|\(.*\) float\b|float\b)"
)  # a line of Parameters or Returns
RUNNING = re.compile(
    r"``\w+``(?: and ``\w+``)?(?: \([^)]*\))? \[|\bReturns (?:\([^)]*\) )?\["
)  # in a sentence
MARK = re.compile(r"# eqs?\. (\[[^]]+\])")  # a step that follows a numbered equation
SOURCE = re.compile(r"^References$|^Source\b|\bSource: |\beqs?\. [\[(]", re.MULTILINE)
PAGE = re.compile(r'(docs/(?:method/)?\w+\.md)(?:,\s"([^"]+)")?')
NOT_QUANTITIES = tuple(
    f"np.{name}" for name in "any all flatnonzero isfinite isnan isclose array_equal".split()
)
WITHOUT = {  # what returns a sum that is a text
    "bowl.documentation.template", "bowl.documentation.schema_text", "resting.aspects.form_remarks",
}  # fmt: skip


def functions():
    """Public functions of the stages of numerics: name, node and source."""
    for stage in STAGES:
        for path in sorted((ROOT / stage).rglob("*.py")):
            source = path.read_text(encoding="utf-8")
            lines = source.split("\n")
            name = ".".join(path.relative_to(ROOT).with_suffix("").parts)
            for node in ast.parse(source).body:
                is_overload = "overload" in map(ast.unparse, getattr(node, "decorator_list", ()))
                if isinstance(node, ast.FunctionDef) and not node.name.startswith("_") and not is_overload:
                    yield f"{name}.{node.name}", node, "\n".join(lines[node.lineno - 1 : node.end_lineno])


def numeric(value):
    """Whether an expression is plainly a number or an array of numbers."""
    match value:
        case ast.Tuple(elts=elements):
            return any(map(numeric, elements))
        case ast.BinOp(op=ast.Add() | ast.Sub() | ast.Mult() | ast.Div() | ast.Pow(), left=left, right=right):
            return not any(isinstance(side, (ast.List, ast.JoinedStr)) for side in (left, right))
        case ast.UnaryOp(op=ast.USub(), operand=operand):
            return not isinstance(operand, ast.Constant)
        case ast.IfExp(body=one, orelse=other):
            return numeric(one) or numeric(other)
        case ast.Call(func=function):
            name = ast.unparse(function)
            return name in ("float", "abs") or (
                name.startswith(("np.", "math.")) and not name.startswith(NOT_QUANTITIES)
            )
    return False


def returns_numbers(node):
    """Whether a function plainly returns numbers that it computes."""
    returned = [step.value for step in ast.walk(node) if isinstance(step, ast.Return) and step.value]
    return any(map(numeric, returned))


def computes(node, doc):
    """Whether a function plainly takes or returns quantities."""
    return returns_numbers(node) or any(map(ENTRY.match, doc.splitlines()))


def has_units(node, doc):
    """Whether a docstring says a unit, and one in every line of its sections that holds floats."""
    entries = [line for line in doc.splitlines() if ENTRY.match(line)]
    return bool(UNIT.search(doc)) and all(map(UNIT.search, entries))


def has_source(name, doc):
    """Whether a function, its module or a folder around it names a paper, an equation or a page."""
    parts = name.split(".")
    files = [ROOT.joinpath(*parts[:-1]).with_suffix(".py")]
    files += [ROOT.joinpath(*parts[:count], "__init__.py") for count in range(1, len(parts) - 1)]
    return any(map(SOURCE.search, [doc, *map(module_docstring, files)]))


@functools.cache
def module_docstring(path):
    return ast.get_docstring(ast.parse(path.read_text(encoding="utf-8"))) or ""


@pytest.fixture(scope="module")
def known():
    every = [(name, node, source, ast.get_docstring(node) or "") for name, node, source in functions()]
    return [one for one in every if one[0] not in WITHOUT]


def test_every_docstring_begins_a_sentence_says_shapes_and_names_the_equations_it_follows(known):
    """`name : array of float` says too little: (N, 3) float [m] does not."""
    poor = re.compile(r"^[a-z_, ]+ : (?:(?:np\.)?nd)?arrays?(?: of \w+)?$")
    assert [name for name, _, _, doc in known if not doc[:1].isupper()] == []
    assert [name for name, _, _, doc in known for line in doc.splitlines() if poor.match(line)] == []
    for name, _, source, doc in known:
        assert all(mark in doc or "References" in doc for mark in MARK.findall(source)), name


def test_under_raises_stand_faults_alone():
    """The pages of the site took a paragraph behind them for the name of a fault."""
    names = re.compile(r"[\w.]+(?:, [\w.]+)*")
    for path in ROOT.rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if not isinstance(node, ast.FunctionDef | ast.ClassDef):
                continue
            _, _, faults = (ast.get_docstring(node) or "").partition("\nRaises\n------\n")
            lines = re.split(r"\n\n\w+\n-{3,}\n", faults)[0].splitlines()
            odd = [line for line in lines if line and line[0] != " " and not names.fullmatch(line)]
            assert odd == [], (path.name, node.name)


def test_what_computes_says_the_unit_of_each_quantity_and_has_a_source(known):
    """The source in its own docstring, in that of its module, or in that of a folder around it."""
    able = [(name, node, doc) for name, node, _, doc in known if computes(node, doc) or RUNNING.search(doc)]
    assert len(able) > 290
    assert [name for name, node, doc in able if not has_units(node, doc)] == []
    assert [name for name, _, doc in able if not has_source(name, doc)] == []
    judging = ("sorting.", "bowl.devices.")  # there many functions select, sort or read
    plain = tuple(f"{name}." for name in STAGES if name not in ("sorting", "trials"))
    for among, least in ((plain, 0.95), (judging, 0.6)):
        named = [(name, node, doc) for name, node, doc in able if name.startswith(among)]
        named = [one for one in named if among == judging or not one[0].startswith(judging)]
        docs = [doc for _, node, doc in named if returns_numbers(node)]
        assert sum(bool(SOURCE.search(doc)) for doc in docs) >= least * len(docs)


def test_a_page_that_is_a_source_is_there_with_its_section():
    texts = [path.read_text(encoding="utf-8") for path in ROOT.rglob("*.py")]
    named = {place for text in texts for place in PAGE.findall(text)}
    assert len(named) > 8
    for page, section in named:
        assert not section or section in (ROOT.parent / page).read_text(encoding="utf-8"), (page, section)
