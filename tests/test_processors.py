"""The same bytes whatever kernels BLAS would choose: nothing that is printed may pass through them."""

import ast
import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parent.parent
CORES = ("Prescott", "Haswell", "Zen")  # without AVX, with AVX2 and FMA; any of them falls back where it must
NUT = "parts/squarenut_m5.stl"
CALLS = (
    ("drop", NUT, "--drops", "60", "--seed", "1"),
    ("drop", NUT, "--plate", "--drops", "4", "--seconds", "0.2", "--seed", "1", "--no-pictures"),
    ("aspects", NUT),
    ("aspects", "parts/hexbolt_m8x25.stl"),
    ("rate", NUT, "--aspect", "A"),
    ("floor", NUT, "--aspect", "A"),
    ("track", NUT, "--aspect", "A"),
    ("headings", NUT, "--aspect", "A"),
    ("inertia", NUT),
    ("convey",),
)
SCRIPT = """
import sys
from click.testing import CliRunner
from feederscrew_cli.main import feeder
for words in eval(sys.argv[1]):
    done = CliRunner().invoke(feeder, [*words, "--format", "csv", "-q"])
    assert done.exit_code == 0, (words, done.output, done.exception)
    print("$", *words)
    print(done.stdout)
"""
BATCH = """
import sys
from click.testing import CliRunner
from feederscrew_cli.main import feeder
words = ["batch", *sys.argv[2:], "-o", sys.argv[1], "--jobs", "1", "--no-pictures", "-q"]
done = CliRunner().invoke(feeder, words)
assert done.exit_code == 0, (done.output, done.exception)
"""


def run(script, core, *words):
    """What a script prints with one of the kernels of OpenBLAS."""
    done = subprocess.run(
        [sys.executable, "-c", script, *words],
        capture_output=True,
        text=True,
        cwd=ROOT,
        env=os.environ | {"OPENBLAS_CORETYPE": core},
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_commands_print_the_same_bytes_under_every_kernel():
    first, *others = (run(SCRIPT, core, repr(CALLS)) for core in CORES)
    assert first.count("$ ") == len(CALLS)
    assert all(other == first for other in others)


def test_a_batch_writes_the_same_bytes_under_every_kernel(tmp_path):
    for core in CORES[:2]:
        run(BATCH, core, str(tmp_path / core), NUT)
    first, second = (
        {
            path.relative_to(tmp_path / core): path.read_bytes()
            for path in sorted((tmp_path / core).rglob("*.csv"))
        }
        for core in CORES[:2]
    )
    assert first and first == second


SPARSE = {"adoption.py", "barriers.py"}  # products of scipy's sparse matrices, which do without BLAS
FREE = {"output", "screw"}  # pictures; the algebra of screws, which no command prints
CALLS_BLAS = {
    "dot",
    "inner",
    "matmul",
    "tensordot",
    "vdot",
    "cov",
    "corrcoef",
    "polyfit",
    "convolve",
    "correlate",
}


def offences(path):
    """Lines of a module that numpy would hand to BLAS or LAPACK."""
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.BinOp) and isinstance(node.op, ast.MatMult) and path.name not in SPARSE:
            yield node.lineno, "@"
        if not isinstance(node, ast.Call) or not isinstance(node.func, ast.Attribute):
            continue
        called = ast.unparse(node.func)
        if "(" in called:  # a method of what another call returns, which is looked at by itself
            continue
        lengths = called == "np.linalg.norm" and any(word.arg == "axis" for word in node.keywords)
        if called.startswith(("np.linalg.", "linalg.")) and not lengths:
            yield node.lineno, called
        if called.startswith("np.") and called.removeprefix("np.") in CALLS_BLAS:
            yield node.lineno, called


def test_no_module_hands_its_numbers_to_blas():
    package = ROOT / "feederscrew"
    found = {
        f"{path.relative_to(package)}:{line}": what
        for path in sorted(package.rglob("*.py"))
        if path.relative_to(package).parts[0] not in FREE
        for line, what in offences(path)
    }
    assert found == {}, "use feederscrew.geometry.vectors"
