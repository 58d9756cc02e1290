"""Small changes to the physics, one at a time, and whether the tests notice: `make mutants`.

Example: python benchmarks/mutants.py --each 12 --seed 1

Numbers, signs, operators, comparisons, and minima are changed in thirteen files of a copy of the repository;
of each file so many changes are drawn, and its own tests are run on them until one fails. What survives is
printed with its line: either a test is missing, or the change has no consequence.
"""

import argparse
import ast
import os
import shlex
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from named_mutants import EQUIVALENT, NAMED

ROOT = Path(__file__).parent.parent
FILES = {
    "machine/sizing.py": ("tests/machine/test_sizing_rules.py", "tests/cli/moving/test_cli_bowl.py"),
    "machine/throughput.py": ("tests/machine/test_sizing_rules.py", "tests/cli/moving/test_cli_bowl.py"),
    "rates/rocking.py": ("tests/rates/test_rocking.py", "tests/rates/test_rocking_noticed.py"),
    "rates/steadiness.py": (
        "tests/rates/test_rate_noticed.py",
        "tests/rates/test_rocking_noticed.py",
        "tests/rates/test_steadiness.py",
    ),
    "rates/tipping.py": (
        "tests/rates/test_rate_noticed.py",
        "tests/rates/test_rocking_noticed.py",
        "tests/rates/test_tipping.py",
    ),
    "rates/well_oriented.py": (
        "tests/rates/test_rate.py",
        "tests/rates/test_rate_noticed.py",
        "tests/rates/test_passing.py",
    ),
    "tooling/devices/blades.py": (
        "tests/tooling/test_devices_noticed.py",
        "tests/tooling/test_verdicts.py",
        "tests/tooling/test_clearing.py",
    ),
    "tooling/devices/ledges.py": (
        "tests/tooling/test_devices_noticed.py",
        "tests/tooling/test_verdicts.py",
        "tests/tooling/test_holding.py",
        "tests/rates/test_steadiness.py",
    ),
    "tooling/devices/openings.py": (
        "tests/tooling/test_devices_noticed.py",
        "tests/tooling/test_verdicts.py",
        "tests/tooling/test_holding.py",
        "tests/rates/test_steadiness.py",
    ),
    "tooling/holding.py": ("tests/tooling/test_holding.py", "tests/tooling/test_holding_noticed.py"),
    "tooling/turning.py": ("tests/tooling/test_turning.py", "tests/tooling/test_holding_noticed.py"),
    "trial/course.py": ("tests/studies/test_trial_numbers.py", "tests/trial/test_trial_course.py"),
    "trial/result.py": ("tests/studies/test_trial_numbers.py", "tests/cli/moving/test_cli_trial.py"),
}
COPIED = (
    "feederscrew",
    "cli",
    "tests",
    "parts",
    "configs",
    "docs",
    "benchmarks",
    "pyproject.toml",
    "README.md",
)
SWAPPED = {
    ast.Add: ast.Sub, ast.Sub: ast.Add, ast.Mult: ast.Div, ast.Div: ast.Mult,
    ast.Lt: ast.GtE, ast.LtE: ast.Gt, ast.Gt: ast.LtE, ast.GtE: ast.Lt,
    ast.Eq: ast.NotEq, ast.NotEq: ast.Eq, ast.And: ast.Or, ast.Or: ast.And,
}  # fmt: skip
NAMES = {"min": "max", "max": "min", "sin": "cos", "cos": "sin", "argmin": "argmax", "argmax": "argmin"}
NAMES |= {"any": "all", "all": "any"}
GROWN = 1.25  # times a number that is changed; a whole one becomes the next


class Changer(ast.NodeTransformer):
    """Changes the node of a number, in the order they are met; without one it only counts them."""

    def __init__(self, chosen=None):
        self.chosen, self.met, self.line = chosen, -1, 0

    def visit(self, node):
        """Change a node where it is the one, and look on inside."""
        new = changed(node)
        if new is not None:
            self.met += 1
            if self.met == self.chosen:
                self.line = node.lineno if hasattr(node, "lineno") else 0
                return ast.copy_location(new, node)
        return super().generic_visit(node)


def changed(node):
    """A node's small change, or None of one that has none."""
    if isinstance(node, ast.Constant) and type(node.value) in (int, float) and node.value not in (0, 0.0):
        return ast.Constant(node.value * GROWN if isinstance(node.value, float) else node.value + 1)
    if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub | ast.Not):
        return node.operand
    if isinstance(node, ast.BinOp) and type(node.op) in SWAPPED:
        return ast.BinOp(node.left, SWAPPED[type(node.op)](), node.right)
    if isinstance(node, ast.BoolOp):
        return ast.BoolOp(SWAPPED[type(node.op)](), node.values)
    if isinstance(node, ast.Compare) and len(node.ops) == 1 and type(node.ops[0]) in SWAPPED:
        return ast.Compare(node.left, [SWAPPED[type(node.ops[0])]()], node.comparators)
    if isinstance(node, ast.Attribute) and node.attr in NAMES:
        return ast.Attribute(node.value, NAMES[node.attr], node.ctx)
    return ast.Name(NAMES[node.id], node.ctx) if isinstance(node, ast.Name) and node.id in NAMES else None


def mutants(text, each, rng):
    """Texts with one change, and the lines they are in."""
    counter = Changer()
    counter.visit(ast.parse(text))
    for chosen in sorted(rng.permutation(counter.met + 1)[:each]):
        changer = Changer(chosen)
        tree = changer.visit(ast.parse(text))
        yield ast.unparse(ast.fix_missing_locations(tree)), changer.line


def difference(text, other):
    """The line of a module that a change is in, before and after, as ``unparse`` writes it."""
    before, after = ast.unparse(ast.parse(text)).splitlines(), other.splitlines()
    pairs = [(a.strip(), b.strip()) for a, b in zip(before, after) if a != b]
    return "   ->   ".join(pairs[0]) if pairs else "no change"


def notices(folder, tests, seconds, **others):
    """Whether one of the tests fails on what is in the folder; one that never ends fails."""
    shown = others | {"PYTHONPATH": f"{folder}:{folder / 'tests'}", "PYTHONDONTWRITEBYTECODE": "1"}
    line = [sys.executable, "-m", "pytest", "-x", "-q", "-p", "no:cacheprovider", *tests]
    try:
        done = subprocess.run(line, cwd=folder, env=os.environ | shown, capture_output=True, timeout=seconds)
    except subprocess.TimeoutExpired:
        return True
    return done.returncode != 0


def named(folder, seconds, rows=NAMED):
    """Try the changes that once stayed unnoticed; what of them does not apply any more is printed too."""
    noticed = 0
    for name, old, new, test in rows:
        path = folder / "feederscrew" / name
        text = path.read_text() if path.exists() else ""
        if text.count(old) != 1:
            print(f"{name}: {old!r} is in it {text.count(old)} times, not once", flush=True)
            continue
        path.write_text(text.replace(old, new))
        plain = {"NUMBA_DISABLE_JIT": "1"} if name.startswith("trial/kernel") else {}
        found = notices(folder, shlex.split(test), seconds, **plain)  # sooner done than compiled anew
        noticed += found
        print(f"{name}: {old!r} as {new!r} {'noticed' if found else 'NOT NOTICED'}", flush=True)
        path.write_text(text)
    print(f"{noticed} of {len(rows)} named changes are noticed", flush=True)


def excused(name, line):
    """Say why a change to a line has no consequence; empty where it should have one."""
    told = (why for (file, part), why in EQUIVALENT.items() if file == name and part in line)
    return next(told, "")


def copied(folder):
    """Copy what the tests need to a folder."""
    for name in COPIED:
        copy = shutil.copytree if (ROOT / name).is_dir() else shutil.copy
        copy(ROOT / name, folder / name)
    (folder / "feederscrew_cli").symlink_to(folder / "cli")


def main(chosen):
    """Try every file, and print what survives."""
    killed, tried = 0, 0
    with tempfile.TemporaryDirectory() as made:
        folder = Path(made)
        copied(folder)
        if not chosen.files:
            named(folder, chosen.seconds)
        for name in () if chosen.named else chosen.files or FILES:
            rng = np.random.default_rng(
                [chosen.seed, *name.encode()]
            )  # the same changes alone and with others
            path = folder / "feederscrew" / name
            text = path.read_text()
            if notices(folder, FILES[name], chosen.seconds):
                raise SystemExit(f"{name}: its tests fail before anything is changed")
            for other, line in mutants(text, chosen.each, rng):
                path.write_text(other)
                noticed = notices(folder, FILES[name], chosen.seconds)
                killed, tried = killed + noticed, tried + 1
                if not noticed:
                    told = difference(text, other)
                    print(f"{name}:{line}: {told}   {excused(name, told)}".rstrip(), flush=True)
            path.write_text(text)
            print(f"{name}: done, {killed} of {tried} noticed so far", flush=True)
    if tried:
        print(f"{killed} of {tried} small changes are noticed")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument(
        "files",
        nargs="*",
        choices=[[], *FILES],
        help="of feederscrew/; without any, all thirteen and those once unnoticed",
    )
    parser.add_argument("--named", action="store_true", help="only those that once stayed unnoticed")
    parser.add_argument("--each", type=int, default=12, help="changes of each file")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--seconds", type=float, default=300.0, help="after which a test counts as failed")
    main(parser.parse_args())
