"""The folders are the pipeline: a stage imports only stages before it, and heavy libraries have one door."""

import ast
import re
from collections import Counter
from functools import cache
from graphlib import TopologicalSorter
from pathlib import Path

from feederscrew.bowl.devices.kinds import KINDS

ROOT = Path(__file__).parent.parent
ORDER = [
    "base", "part", "resting", "bowl", "motion", "arrivals", "sorting", "feeding", "cad", "machine", "trials",
    "designing", "output", "thesis", "jobs",
]  # fmt: skip
DOORS = {
    "trimesh": {"feederscrew/part"}, "yaml": {"feederscrew/base/documents.py"},
    "pandas": {"feederscrew/output", "feederscrew/base/records.py"},
    "matplotlib": {"feederscrew/output", "feederscrew/base/records.py", "feederscrew/thesis/figures.py"},
    "embreex": {"feederscrew/output"}, "ezdxf": {"feederscrew/base/dxf.py"},
    "manifold3d": {"feederscrew/part", "feederscrew/sorting/solid.py", "feederscrew/cad/facets.py",
                   "feederscrew/designing/changes.py"},
    "OCP": {"feederscrew/output/solid_files.py", "feederscrew/cad/exact"},
    "click": {"cli"}, "numba": {"feederscrew/base/geometry"}, "llvmlite": {"feederscrew/base/geometry"},
    "werkzeug": {"feederscrew/jobs/serving", "cli/serve.py"},
}  # fmt: skip
FILES = sorted([*ROOT.glob("feederscrew/**/*.py"), *ROOT.glob("cli/*.py")])


@cache
def tree(path):
    return ast.parse(path.read_text())


@cache
def nodes(path):
    return tuple(ast.walk(tree(path)))


@cache
def imports(path, *, types=True):
    """Every dotted name a file imports: at its top, in a function, when it is needed, or for its types."""
    names, left_out = [], set()
    for node in () if types else tree(path).body:
        if isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING":
            left_out |= {id(inner) for inner in ast.walk(node)}
    for node in nodes(path):
        if id(node) in left_out:
            continue
        if isinstance(node, ast.Import):
            names += [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path} imports relatively"
            names += [f"{node.module}.{alias.name}" for alias in node.names]
        elif isinstance(node, ast.Call) and getattr(node.func, "id", "") == "heavy":
            names.append(node.args[0].value)
    return tuple(names)


def stage(dotted):
    """The stage of 'feederscrew.part.hull': 'part'; None outside."""
    head, *rest = dotted.split(".")
    return rest[0] if head == "feederscrew" and rest and rest[0] in ORDER else None


def module(path):
    """The dotted name of a file: 'feederscrew.part.hull'."""
    return ".".join(path.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__")


DOTTED = re.compile(r"feederscrew\.[\w.]+")
FROM_OURS = re.compile(r"^\s*from (feederscrew\.[\w.]+) import ", re.MULTILINE)  # not parsed: slow


def test_a_stage_imports_only_stages_before_it_and_a_heavy_library_through_its_one_door():
    for path in FILES:
        place, here = str(path.relative_to(ROOT)), stage(module(path))
        allowed = {None, *ORDER[: ORDER.index(here) + 1]} if here else {None, *ORDER}
        for name in imports(path):
            assert here is None or not name.startswith("feederscrew_cli"), f"{place}: {name}"
            assert stage(name) in allowed, f"{place} imports {name}"
        for name in imports(path, types=False):
            doors = DOORS.get(name.split(".")[0], {place})
            assert place.startswith(tuple(doors)), f"{place} imports {name}, not through {doors}"
        texts = (getattr(node, "value", None) for node in nodes(path))
        for text in (text for text in texts if isinstance(text, str) and DOTTED.fullmatch(text)):
            assert here is None or stage(text) in allowed, f"{place}: {text}"


def test_there_are_at_most_16_packages_and_130_arrows_between_them():
    """With the command line. An arrow: some module of one stage imports from another, be it for a type."""
    assert len(ORDER) + 1 <= 16
    arrows = {(stage(module(path)), stage(name)) for path in FILES for name in imports(path)}
    between = {(here, there) for here, there in arrows if here and there and here != there}
    assert 14 <= len(between) <= 100  # 298 between 37 rooms, before these became stages


def test_every_stage_of_the_order_and_every_own_module_that_is_imported_exists():
    """mypy takes a missing module for one without types, and an import within a function runs late."""
    library = ROOT / "feederscrew"
    stages = {path.relative_to(library).parts[0].removesuffix(".py") for path in library.glob("**/*.py")}
    assert stages - {"__init__", "__main__"} == set(ORDER)
    assert all((library / name / "__init__.py").exists() for name in ORDER)
    names = {module(path) for path in FILES if path.parts[-2] != "cli"}
    for path in [*FILES, *(path for folder in ("tests", "docs", "benchmarks") for path in sources(folder))]:
        for name in FROM_OURS.findall(path.read_text()):
            assert name in names, f"{path} imports {name}"


def sources(folder):
    return (ROOT / folder).glob("**/*.py")


def test_no_imports_go_in_a_circle():
    names = {module(path) for path in FILES}
    graph = {}
    for path in FILES:
        wanted = (name if name in names else name.rpartition(".")[0] for name in imports(path, types=False))
        graph[module(path)] = {name for name in wanted if name in names} - {module(path)}
    TopologicalSorter(graph).prepare()  # raises CycleError, which names the circle
    # No class name occurs twice.
    tops = (node for path in FILES for node in tree(path).body)
    names = Counter(node.name for node in tops if isinstance(node, ast.ClassDef))
    assert not [name for name, count in names.items() if count > 1]


OTHERWISE = {"gap", "step"}  # kinds whose names have other uses


def test_a_device_is_known_by_name_in_its_own_folder_only():
    words = ROOT / "feederscrew/output/page/words.py"  # a glossary for people, on which nothing decides
    others = [path for path in FILES if "devices" not in path.parts and path != words]
    named_once = set(KINDS) - OTHERWISE
    assert len(others) < len(FILES) and set(KINDS) > OTHERWISE
    for path in others:
        for node in nodes(path):
            assert getattr(node, "value", None) not in named_once, f"{path}:{node.lineno}"
            told = [node.left, *node.comparators] if isinstance(node, ast.Compare) else []
            by_kind = any(getattr(one, "attr", "") == "kind" for one in told)
            assert not (by_kind and {getattr(one, "value", "") for one in told} & set(KINDS)), path
