"""Small changes to the physics, one at a time, and whether the tests notice: `make mutants`.

Examples: python benchmarks/mutants.py --each 12 --seed 1
          python benchmarks/mutants.py sorting.tipping.goes_over machine.sizing
          python benchmarks/mutants.py sorting.falling.may_wedge --tests tests/sorting/test_holding.py

A name is that of a module, function, method or constant below `feederscrew`. The operators change numbers,
signs, sums, products, comparisons, conditions, minima and sines of what has that name, in a copy of the
repository. Of each name so many changes are drawn, and its tests are run on each until one fails. A change
that survives is printed with its line: either a test is missing, or the change has no consequence.
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

ROOT = Path(__file__).parent.parent
SIZING = "tests/machine/test_sizing_rules.py"
ROCKING = "tests/feeding/test_rocking_noticed.py"
HOLDING = "tests/sorting/test_holding.py"
VERDICTS = "tests/sorting/test_verdicts.py"
LEDGES = f"{VERDICTS} {HOLDING} tests/sorting/test_tipping.py"
RATES = "tests/feeding/test_rate.py"
CONDITION = "tests/machine/test_condition.py"
JUDGED = "tests/resting/test_judged_by_measurement.py"
TIPPING = "tests/sorting/test_tipping.py"
SIGNS = "tests/trials/test_trial_signs.py"
TESTS = {  # by name; more than one file, or `-k`, as on a command line
    "machine.sizing": f"{SIZING} tests/cli/test_cli_bowl.py",
    "machine.condition._of_stroke": CONDITION,
    "machine.condition._why": CONDITION,
    "sorting.tipping.goes_over": ROCKING,
    "sorting.tipping": f"{RATES} {ROCKING} {TIPPING}",
    "feeding.well_oriented": RATES,
    "feeding.stream.Orientations.sure": "tests/sorting/test_tipping.py -k round",
    "resting.rules.recommended.HOP_SHARES": JUDGED,
    "resting.rules.recommended.LAUNCH_WIDTH": JUDGED,
    "resting.rules.recommended.WIDTH_FLOOR": JUDGED,
    "sorting.verdicts.WORN": HOLDING,
    "sorting.falling": HOLDING,
    "sorting.verdicts": HOLDING,
    "bowl.devices.blades": f"{VERDICTS} tests/sorting/test_clearing.py",
    "bowl.devices.ledges": LEDGES,
    "bowl.devices.ledges.TippingLedge.judged": HOLDING,
    "bowl.devices.openings": LEDGES,
    "bowl.devices.pneumatics.AirJet": VERDICTS,
    "trials.course": "tests/trials/test_trial_numbers.py tests/trials/test_trial_course.py",
    "trials.result": "tests/trials/test_trial_numbers.py tests/cli/test_cli_trial.py",
    "trials.queue.PartsQueue.enter": "tests/trials/test_trial_queue.py -k 'enter or wait'",
    "trials.kernel.steps._want_no_strike": f"{SIGNS} -k 'slides and 0.2'",
    "trials.kernel.steps._stand_share": f"{SIGNS} -k stand",
    "trials.kernel.steps._add_forces": f"{SIGNS} -k air",
    "trials.kernel.track_contacts.wall_friction": f"{SIGNS} -k 'brake and 0.7'",
    "trials.kernel.steps.lift_island": "tests/trials/test_trial_queue.py -k pushed_apart",
    "arrivals.kernel.falling._press_on": "tests/arrivals/test_drop.py",
}
EXCUSED = {  # constants whose value within reason has no consequence, and why
    "machine.sizing.DIAMETER_TOLERANCE_M": "a bound below every length that is printed",
    "machine.sizing.MAX_SIZING_ITERATIONS": "the search ends by itself long before",
    "machine.sizing.STROKE_SAMPLES": "strokes so near each other find the same one",
    "sorting.tipping.REST_ANGULAR_SPEED": "a part that comes down so slowly is at rest at once",
    "sorting.tipping.TIPPING_PHASES": "any number of instants that shows a stroke",
    "sorting.tipping.MAX_FORCE_OFFSET_HEIGHTS": "any width beyond every force: it tips over the ends alone",
    "sorting.falling.FAR": "any length beyond every foot",
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
FACTORS = (1.25, 0.8)  # of a number that is changed; a whole one becomes the next


def changes(node):
    """Return what the operators make of a node: a list of new nodes, empty where none applies."""
    match node:
        case ast.Constant(value=int() | float()) if not isinstance(node.value, bool) and node.value:
            whole = isinstance(node.value, int)
            return [
                ast.Constant(v) for v in ([node.value + 1] if whole else [node.value * f for f in FACTORS])
            ]
        case ast.UnaryOp(op=ast.USub() | ast.Not()):
            return [node.operand]
        case ast.BinOp() if type(node.op) in SWAPPED:
            return [ast.BinOp(node.left, SWAPPED[type(node.op)](), node.right)]
        case ast.BoolOp():
            return [ast.BoolOp(SWAPPED[type(node.op)](), node.values)]
        case ast.Compare(ops=[op]) if type(op) in SWAPPED:
            return [ast.Compare(node.left, [SWAPPED[type(op)]()], node.comparators)]
        case ast.IfExp():
            return [ast.IfExp(node.test, node.orelse, node.body)]
        case ast.Assign(value=ast.Name()):
            return [ast.Assign(node.targets, ast.UnaryOp(ast.USub(), node.value))]
        case ast.Attribute() if node.attr in NAMES:
            return [ast.Attribute(node.value, NAMES[node.attr], node.ctx)]
        case ast.Name() if node.id in NAMES:
            return [ast.Name(NAMES[node.id], node.ctx)]
    return []


class Changer(ast.NodeTransformer):
    """Makes one change, by its number in the order of the nodes; without a number it only counts them."""

    def __init__(self, chosen=None):
        self.chosen, self.count, self.line = chosen, 0, 0

    def visit(self, node):
        """Change the node if its number is the chosen one, else its children."""
        for new in changes(node):
            self.count += 1
            if self.count - 1 == self.chosen:
                self.line = node.lineno
                return ast.copy_location(new, node)
        return self.generic_visit(node)


def located(name, root=ROOT):
    """Return the file of a dotted name, and the names inside of it."""
    parts = name.split(".")
    for count in range(len(parts), 0, -1):
        path = (root / "feederscrew").joinpath(*parts[:count]).with_suffix(".py")
        if path.is_file():
            return path, parts[count:]
    raise SystemExit(f"{name}: there is no such module below feederscrew")


def named(tree, names):
    """Return the node of nested names in a module: a class, a function or what assigns a constant."""
    for name in names:
        below = [node for node in tree.body if name in _names(node)]
        if not below:
            raise SystemExit(f"{'.'.join(names)}: there is no {name}")
        tree = below[0]
    return tree


def _names(node):
    """The names that a statement gives."""
    targets = getattr(node, "targets", [getattr(node, "target", None)])
    assigned = [
        one.id for target in targets if target for one in ast.walk(target) if isinstance(one, ast.Name)
    ]
    return [getattr(node, "name", None), *assigned]


def mutants(text, names, each, rng):
    """Yield (text, line): a module with one change in what has these names; all of it without any."""
    counter = Changer()
    counter.generic_visit(named(ast.parse(text), names))
    for chosen in sorted(rng.permutation(counter.count)[:each]):
        tree, changer = ast.parse(text), Changer(chosen)
        changer.generic_visit(named(tree, names))
        yield ast.unparse(ast.fix_missing_locations(tree)), changer.line


def difference(text, other):
    """Return the line of a module that a change is in, before and after, as ``unparse`` writes it."""
    before, after = ast.unparse(ast.parse(text)).splitlines(), other.splitlines()
    pairs = [(a.strip(), b.strip()) for a, b in zip(before, after) if a != b]
    return "   ->   ".join(pairs[0]) if pairs else "no change"


def excused(name, text, line):
    """Return why a change in a line has no consequence; empty where it should have one."""
    module = ".".join(name.split(".")[: len(name.split(".")) - len(located(name)[1])])
    for node in ast.parse(text).body:
        if isinstance(node, ast.Assign) and node.lineno <= line <= node.end_lineno:
            return next((EXCUSED[f"{module}.{n}"] for n in _names(node) if f"{module}.{n}" in EXCUSED), "")
    return ""


def notices(folder, tests, seconds, **others):
    """Return whether one of the tests fails on what is in the folder; one that never ends fails."""
    environment = os.environ | {"PYTHONPATH": f"{folder}:{folder / 'tests'}", "PYTHONDONTWRITEBYTECODE": "1"}
    line = [sys.executable, "-m", "pytest", "-x", "-q", "-p", "no:cacheprovider", *shlex.split(tests)]
    try:
        done = subprocess.run(
            line, cwd=folder, env=environment | others, capture_output=True, timeout=seconds
        )
    except subprocess.TimeoutExpired:
        return True
    return done.returncode != 0


def tried(folder, name, tests, chosen):
    """Try changes of one name; how many are noticed, and how many there were."""
    path, inside = located(name, folder)
    text, noticed, count = path.read_text(), 0, 0
    plain = {"NUMBA_DISABLE_JIT": "1"} if ".kernel." in name else {}  # sooner done than compiled anew
    if notices(folder, tests, chosen.seconds, **plain):
        raise SystemExit(f"{name}: its tests fail before anything is changed")
    rng = np.random.default_rng([chosen.seed, *name.encode()])  # the same changes alone and with others
    for other, line in mutants(text, inside, chosen.each, rng):
        path.write_text(other)
        found = notices(folder, tests, chosen.seconds, **plain)
        noticed, count = noticed + found, count + 1
        if not found:
            reason = excused(name, text, line)
            print(f"{name}:{line}: {difference(text, other)}   {reason}".rstrip(), flush=True)
    path.write_text(text)
    print(f"{name}: {noticed} of {count} noticed", flush=True)
    return np.array([noticed, count])


def main(chosen):
    """Try every name, and print the changes that survive."""
    with tempfile.TemporaryDirectory() as made:
        folder, whole = Path(made), np.zeros(2, int)
        for name in COPIED:
            copy = shutil.copytree if (ROOT / name).is_dir() else shutil.copy
            copy(ROOT / name, folder / name)
        (folder / "feederscrew_cli").symlink_to(folder / "cli")
        for name in chosen.names or TESTS:
            tests = chosen.tests or TESTS.get(name)
            if not tests:
                raise SystemExit(f"{name}: say which tests should notice, --tests 'tests/...'")
            whole += tried(folder, name, tests, chosen)
    print(f"{whole[0]} of {whole[1]} small changes are noticed")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("names", nargs="*", help="below feederscrew; without any, all of the table TESTS")
    parser.add_argument("--tests", help="those that should notice, of a name that is not in the table")
    parser.add_argument("--each", type=int, default=12, help="changes of each name")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--seconds", type=float, default=300.0, help="after which a test counts as failed")
    main(parser.parse_args())
