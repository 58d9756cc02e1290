"""Which functions of the program the tests enter: the figure that `make test` prints, and its floor.

A function begins with a stand-in for its code, which notes the first call and puts the code in its place: the
figure costs nothing afterwards. Left out are functions within functions, declarations of a protocol, and
files whose functions numba compiles, because it reads their code. What another process enters is not seen:
the figure is a lower limit.
"""

import dis
import functools
import importlib.machinery
import inspect
import re
from pathlib import Path
from types import CodeType, FunctionType, ModuleType

import pytest

ROOT = Path(__file__).parents[2]
FLOOR = 0.95  # share of the functions, below which `make test` fails; 0.968 in November 2026
ROOMS = ("feederscrew", "cli")
WAITING: dict[str, tuple[FunctionType, CodeType, bool]] = {}  # not entered yet, of what has been imported
ENTERED: set[str] = set()
LIST = ".pytest_cache/not_entered.txt"


def _stand_in(*args, **kwargs):
    return __import__("entered").enter("key")(*args, **kwargs)


def enter(key):
    """Put the code of a function into its place; return the function."""
    function, code, signed = WAITING[key]
    ENTERED.add(key)
    function.__code__ = code
    if signed and hasattr(function, "__signature__"):
        del function.__signature__
    return function


def watch():
    """Let every module of the program that is imported from now on be watched."""
    execute = importlib.machinery.SourceFileLoader.exec_module

    def executed(loader, module):
        execute(loader, module)
        path = Path(module.__file__).resolve()
        if path in _watched():
            replace_all(vars(module), str(module.__file__), path)

    importlib.machinery.SourceFileLoader.exec_module = executed


@functools.cache
def _watched():
    """Sources of the program whose functions numba does not compile."""
    text = (ROOT / "feederscrew/base/geometry/compiled.py").read_text()
    patterns = re.findall(r'"([\w/*]+\.py)"', text.partition("SOURCES = {\n")[2].partition("\n}")[0])
    assert len(patterns) > 5, "base/geometry/compiled.py lists its sources otherwise"
    globs = ((ROOT / "feederscrew").glob(pattern) for pattern in ("base/geometry/compiled.py", *patterns))
    left_out = {path for found in globs for path in found}
    return {path for room in ROOMS for path in (ROOT / room).rglob("*.py")} - left_out


def replace_all(names, filename, path):
    """Replace the code of every function and method among the names of a module or class."""
    for value in list(names.values()):
        if isinstance(value, type) and value.__module__ == names.get("__module__", names.get("__name__")):
            replace_all({"__module__": value.__module__, **vars(value)}, filename, path)
            continue
        for function in _functions(value):
            code = function.__code__
            if code.co_filename == filename and not code.co_freevars and "<" not in code.co_qualname:
                _replace(function, code, f"{path.relative_to(ROOT)}:{code.co_qualname}")


def _functions(value):
    """The functions behind a name, whatever they are wrapped in."""
    if isinstance(value, (ModuleType, str, int, float, tuple, frozenset, dict, list)):
        return
    for wrapping in ("__wrapped__", "__func__", "fget", "func", "callback"):
        if inspect.getattr_static(value, wrapping, None) is not None:  # loads no library
            yield from _functions(getattr(value, wrapping))
    if isinstance(value, FunctionType):
        yield value


def _replace(function, code, key):
    if key in WAITING or key in ENTERED or _is_declaration(code):
        return
    signed = not hasattr(function, "__signature__")
    if signed:
        function.__signature__ = inspect.signature(function)
    WAITING[key] = function, code, signed
    constants = tuple(key if value == "key" else value for value in _stand_in.__code__.co_consts)
    function.__code__ = _stand_in.__code__.replace(
        co_consts=constants, co_name=code.co_name, co_qualname=code.co_qualname, co_filename=code.co_filename,
        co_firstlineno=code.co_firstlineno,
    )  # fmt: skip


def _is_declaration(code):
    """Whether a function is a docstring alone, as those of a protocol, which nothing enters."""
    first, *rest = code.co_consts or (None,)
    return isinstance(first, str) and set(rest) <= {None} and len(list(dis.get_instructions(code))) <= 3


@functools.cache
def everything():
    """Every function that could be entered."""
    found = set()
    for path in _watched():
        codes = [compile(path.read_text(), str(path), "exec")]
        while codes:
            code = codes.pop()
            codes += [value for value in code.co_consts if isinstance(value, CodeType)]
            is_function = code.co_flags & inspect.CO_NEWLOCALS and code.co_flags & inspect.CO_OPTIMIZED
            named = not code.co_freevars and "<" not in code.co_qualname
            if is_function and named and not _is_declaration(code):
                found.add(f"{path.relative_to(ROOT)}:{code.co_qualname}")
    return found


def pytest_sessionfinish(session):
    """Hand what a process entered to the one that prints the figure, and hold that to the floor."""
    config = session.config
    if hasattr(config, "workeroutput"):
        config.workeroutput["entered"] = sorted(ENTERED)
    elif _is_whole(config) and session.exitstatus == pytest.ExitCode.OK and _share() < FLOOR:
        session.exitstatus = pytest.ExitCode.TESTS_FAILED


@pytest.hookimpl(optionalhook=True)  # of pytest-xdist
def pytest_testnodedown(node):
    ENTERED.update(getattr(node, "workeroutput", {}).get("entered", ()))


def pytest_terminal_summary(terminalreporter, config):
    if _is_whole(config):
        share, missing = _share(), sorted(everything() - ENTERED)
        (ROOT / LIST).parent.mkdir(exist_ok=True)
        (ROOT / LIST).write_text("".join(f"{name}\n" for name in missing))
        text = f"functions that a test entered: {100.0 * share:.1f} %, floor {100.0 * FLOOR:.0f} %"
        terminalreporter.write_line(f"{text}; {len(missing)} others: {LIST}", red=share < FLOOR)


def _is_whole(config):
    """Whether every test is run."""
    whole = config.args_source is pytest.Config.ArgsSource.TESTPATHS
    return whole and not (config.option.markexpr or config.option.keyword)


def _share():
    names = everything()
    return len(names & ENTERED) / len(names)


watch()
