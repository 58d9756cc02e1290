"""A function that computes says so in its docstring: the unit of every quantity, the shape of every array."""

import ast
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2] / "feederscrew"
ROOMS = (
    "bowl",
    "conveying",
    "dropping",
    "machine",
    "mechanics",
    "rates",
    "resting",
    "screw",
    "tooling",
    "trial",
)
UNIT = re.compile(r"\[[^\]\n]{1,60}\]")
SHAPE = re.compile(r"\((?:[A-Za-z0-9.][A-Za-z0-9_+* .]*)?(?:,[^)\n]*)+\)")
ENTRY = re.compile(
    r"^(?:[a-z_, ]+ : .*\b(?:float|array_like)\b|\(.*\) float\b|float\b)"
)  # a line of Parameters or Returns
MARK = re.compile(r"# eqs?\. (\[[^]]+\])")  # a step that follows a numbered equation
SOURCE = re.compile(r"^References$|^Source\b|\beqs?\. [\[(]", re.MULTILINE)
PAGE = re.compile(r'(docs/(?:method/)?\w+\.md)(?:,\s"([^"]+)")?')
NOT_QUANTITIES = (
    "np.any",
    "np.all",
    "np.flatnonzero",
    "np.isfinite",
    "np.isnan",
    "np.isclose",
    "np.array_equal",
)
WITHOUT = {  # what returns a sum that is a text
    "bowl.documentation.template", "bowl.documentation.schema_text", "resting.aspects.form_remarks",
}  # fmt: skip


def functions():
    """Public functions of the rooms of numerics: name, node and source."""
    for room in ROOMS:
        for path in sorted((ROOT / room).rglob("*.py")):
            source = path.read_text(encoding="utf-8")
            name = ".".join(path.relative_to(ROOT).with_suffix("").parts)
            for node in ast.parse(source).body:
                if isinstance(node, ast.FunctionDef) and not node.name.startswith("_"):
                    yield f"{name}.{node.name}", node, ast.get_source_segment(source, node)


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


def computes(node, doc):
    """Whether a function plainly takes or returns quantities."""
    returned = [step.value for step in ast.walk(node) if isinstance(step, ast.Return) and step.value]
    return any(map(numeric, returned)) or any(map(ENTRY.match, doc.splitlines()))


def told(node, doc):
    """Whether a docstring says a unit, and one in every line of its sections that holds floats."""
    entries = [line for line in doc.splitlines() if ENTRY.match(line)]
    return bool(UNIT.search(doc)) and all(map(UNIT.search, entries))


def sourced(name, doc):
    """Whether a function, its module or a folder around it names a paper, an equation or a page."""
    parts = name.split(".")
    files = [ROOT.joinpath(*parts[:-1]).with_suffix(".py")]
    files += [ROOT.joinpath(*parts[:count], "__init__.py") for count in range(1, len(parts) - 1)]
    docs = [ast.get_docstring(ast.parse(path.read_text(encoding="utf-8"))) or "" for path in files]
    return any(map(SOURCE.search, [doc, *docs]))


@pytest.fixture(scope="module")
def known():
    every = [(name, node, source, ast.get_docstring(node) or "") for name, node, source in functions()]
    return [one for one in every if one[0] not in WITHOUT]


def test_every_function_has_a_docstring_that_begins_a_sentence(known):
    assert [name for name, _, _, doc in known if not doc[:1].isupper()] == []


def test_what_computes_says_the_unit_of_each_quantity(known):
    able = [(name, told(node, doc)) for name, node, _, doc in known if computes(node, doc)]
    assert len(able) > 200
    assert [name for name, fine in able if not fine] == []


def test_what_computes_has_a_source(known):
    """In its own docstring, in that of its module, or in that of a folder around it."""
    without = [name for name, node, _, doc in known if computes(node, doc) and not sourced(name, doc)]
    assert without == []


def test_most_formulas_of_the_mechanics_name_their_source_where_they_stand(known):
    """In their own docstrings: 103 of 230 once; the others select, sort or read."""
    rooms = ("bowl", "conveying", "dropping", "machine", "mechanics", "rates", "resting", "screw")
    for among, least in ((rooms, 0.95), (("tooling",), 0.6)):
        able = [doc for name, node, _, doc in known if name.split(".")[0] in among and computes(node, doc)]
        assert sum(bool(SOURCE.search(doc)) for doc in able) >= least * len(able)


def test_a_page_that_is_a_source_is_there_with_its_section():
    texts = [path.read_text(encoding="utf-8") for path in ROOT.rglob("*.py")]
    named = {one for text in texts for one in PAGE.findall(text)}
    assert len(named) > 8
    for page, section in named:
        assert not section or section in (ROOT.parent / page).read_text(encoding="utf-8"), (page, section)


def test_a_line_on_an_array_says_its_shape(known):
    """`name : array of float` says too little: (N, 3) float [m] does not."""
    poor = re.compile(r"^[a-z_, ]+ : (?:(?:np\.)?nd)?arrays?(?: of \w+)?$")
    assert [name for name, _, _, doc in known for line in doc.splitlines() if poor.match(line)] == []


def test_what_follows_a_numbered_equation_names_it(known):
    missing = []
    for name, _, source, doc in known:
        missing += [
            (name, mark) for mark in MARK.findall(source) if mark not in doc and "References" not in doc
        ]
    assert missing == []
