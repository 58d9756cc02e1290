"""The same bytes whatever kernels BLAS would choose: nothing that is printed may pass through them."""

import ast
import os
import subprocess
import sys

import pytest
from command_lines import ROOT

CORES = ("Prescott", "Haswell")  # without AVX, with AVX2 and FMA; either falls back where it must
NUT = "parts/squarenut_m5.stl"
CALLS = [
    line.split()
    for line in f"""
drop {NUT} --drops 60 --seed 1
drop {NUT} --plate --drops 4 --seconds 0.2 --seed 1 --no-pictures
aspects {NUT}
aspects parts/hexbolt_m8x25.stl
rate {NUT} --aspect A
floor {NUT} --aspect A
track {NUT} --aspect A
headings {NUT} --aspect A
inertia {NUT}
convey
""".strip().splitlines()
]
SCRIPT = """
import sys
from click.testing import CliRunner
from feederscrew.arrivals import arrival
from feederscrew.arrivals import aspects_study as aspects
from feederscrew_cli.main import feeder
aspects.MAX_DROPS, arrival.FIRST_PARTS, arrival.MAX_ARRIVALS, arrival.LONGER_TIME_PARTS = 500, 60, 60, 60
calls, part, out = eval(sys.argv[1])
batch = ["batch", part, "-o", out, "--jobs", "1", "--no-pictures"]
for words in (*([*words, "--format", "csv"] for words in calls), batch):
    done = CliRunner().invoke(feeder, [*words, "-q"])
    assert done.exit_code == 0, (words, done.output, done.exception)
    print("$", *words[:-1])
    print(done.stdout)
"""


@pytest.mark.long
def test_commands_and_a_batch_give_the_same_bytes_under_every_kernel(tmp_path):
    """What the commands print with one of the kernels of OpenBLAS; a batch writes into a folder."""
    answers = []
    for core in CORES:
        out = tmp_path / core
        out.mkdir()
        (out / "parts").symlink_to(ROOT / "parts")
        call = [sys.executable, "-c", SCRIPT, repr((CALLS, NUT, "made"))]
        own = os.environ | {"OPENBLAS_CORETYPE": core, "PYTHONPATH": str(ROOT)}
        done = subprocess.run(call, capture_output=True, text=True, cwd=out, env=own)
        assert done.returncode == 0, done.stderr
        tables = {path.relative_to(out): path.read_bytes() for path in sorted(out.rglob("*.csv"))}
        answers.append((done.stdout, tables))
    printed, tables = answers[0]
    assert printed.count("$ ") == len(CALLS) + 1 and tables and answers[0] == answers[1]


SPARSE = {"adoption.py", "barriers.py"}  # products of scipy's sparse matrices, which do without BLAS
FREE = {"output", "screws.py"}  # pictures; the algebra of screws, which no command prints
CALLS_BLAS = set("dot inner matmul tensordot vdot cov corrcoef polyfit convolve correlate".split())


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
        if not FREE & set(path.relative_to(package).parts)
        for line, what in offences(path)
    }
    assert found == {}, "use feederscrew.base.geometry.vectors"
