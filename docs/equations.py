"""Write docs/equations.md: from the number of an equation in the thesis to its function and its test.

Functions and tests say "eq. [4.27]" or "eqs. [4.14] to [4.19]", in a docstring or a comment; this page
is made from these words alone.

Example: python docs/equations.py          (writes docs/equations.md)
         python docs/equations.py --check  (status 1, and the differences, if it is out of date)
"""

import ast
import re
import sys
from pathlib import Path

import generated

ROOT = Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs" / "equations.md"
STAGES = ("motion", "resting", "thesis")  # where equations are computed
NUMBER = r"\[(?:\d\.\d+|section \d\.\d|Table \d-\d+)\]"
MARK = re.compile(rf"\beqs?\. ({NUMBER}(?:(?:, | and | to ){NUMBER})*)", re.IGNORECASE)
HEAD = """# From an equation of the thesis to its function and its test

Chapter 3 prints its equations without numbers: in place of a [3.4], say, there is the section or the table
that an equation stands by. [4.1] to [4.3] are mass properties, kept in `parts/arc_chute.yaml`; the
Magnet's are in `parts/magnet.yaml`. Where the print has a slip, the test shows it, and `feeder reproduce`
lists it.

Functions are named from `feederscrew` on, tests from `tests`. This page is made by `docs/equations.py`.

| Equation | What it says | Function | Test |
|---|---|---|---|
"""
MEANINGS = {
    "2.1": "twist: angular velocity and velocity of a point",
    "2.2": "linear momentum of a body",
    "2.3": "angular momentum of a body about a point",
    "2.4": "momentum screw",
    "section 3.1": "the general equation: probability by polar moment of inertia over height (PMI)",
    "Table 3-2": "probability by solid angle over height (CSA)",
    "Table 3-3": "probability by contact area over height (stability)",
    "Table 3-12": "deviation between two profiles",
    "4.4": "twist (x) momentum screw",
    "4.5": "force screw (wrench)",
    "4.6": "dual Euler equation: wrench = twist (x) momentum + rate of the momentum",
    "4.7": "floor: twist of the Arc Chute",
    "4.8": "floor: its momentum screw",
    "4.9": "floor: its twist (x) momentum",
    "4.10": "floor: rate of its momentum",
    "4.11": "floor: their sum",
    "4.12": "floor: that sum by components",
    "4.13": "floor: wrench of weight, drive, normal force and friction",
    "4.14": "floor: forces upright",
    "4.15": "floor: forces across the heading",
    "4.16": "floor: forces along the heading",
    "4.17": "floor: moments about the upright axis",
    "4.18": "floor: moments about Y', which give the line of the normal force",
    "4.19": "floor: moments about Z'",
    "4.20": "floor: normal force",
    "4.21": "floor: acceleration across the heading",
    "4.22": "floor: acceleration along the heading",
    "4.23": "floor: alignment acceleration",
    "4.25": "floor: condition of sliding",
    "4.26": "floor: friction of a sliding part",
    "4.27": "floor: limiting friction over heading, drive and vibration angle",
    "4.28": "floor: limiting friction of an aligned part",
    "4.29": "track: wrench on the Arc Chute",
    "4.30": "track: rate of its momentum",
    "4.31": "track: dual Euler equation by components",
    "4.32": "track: forces along the track",
    "4.33": "track: forces across the track",
    "4.34": "track: forces normal to the track",
    "4.35": "track: moments about X",
    "4.36": "track: moments about Y",
    "4.37": "track: moments about Z",
    "4.38": "floor: twist of the Magnet",
    "4.39": "floor: its momentum screw",
    "4.40": "floor: its twist (x) momentum",
    "4.41": "floor: rate of its momentum",
    "4.42": "floor: their sum by components",
    "4.43": "floor: wrench on the Magnet",
    "4.44": "floor: forces upright",
    "4.45": "floor: forces across the heading",
    "4.46": "floor: forces along the heading",
    "4.47": "floor: moments about the upright axis",
    "4.48": "floor: moments about Y'",
    "4.49": "floor: moments about Z'",
    "4.50": "floor: normal force",
    "4.51": "floor: acceleration across the heading",
    "4.52": "floor: acceleration along the heading",
    "4.53": "floor: alignment acceleration",
    "4.54": "track: wrench on the Magnet",
    "4.55": "track: rate of its momentum",
    "4.56": "track: dual Euler equation by components",
    "4.57": "track: forces along the track",
    "4.58": "track: forces across the track",
    "4.59": "track: forces upright",
    "4.60": "track: moments about X",
    "4.61": "track: moments about Y",
    "4.62": "track: moments about Z",
}
NUMBERS = list(MEANINGS)


def page():
    """Return the page as the sources are now.

    Raises
    ------
    SystemExit
        If a mark is of no known equation, or an equation lacks a function or a test.
    """
    library = ROOT / "feederscrew"
    functions = _places([path for stage in STAGES for path in library.glob(f"{stage}/**/*.py")], library)
    tests = _places((ROOT / "tests").glob("**/test_*.py"), ROOT / "tests")
    strange = sorted({*functions, *tests} - {*NUMBERS})
    lacking = [number for number in NUMBERS if number not in functions or number not in tests]
    if strange or lacking:
        raise SystemExit(f"equations unknown: {strange}; without function or test: {lacking}")
    rows = (
        f"| {_shown(number)} | {meaning} | {_joined(functions[number])} | {_joined(tests[number])} |\n"
        for number, meaning in MEANINGS.items()
    )
    return HEAD + "".join(rows)


def marked(text):
    """Return the numbers that a text marks, a range by all it holds: '4.27', 'section 3.1'."""
    found = []
    for match in MARK.finditer(text):
        for piece in re.split(r", | and (?=\[)", match[1]):
            first, *last = (NUMBERS.index(number) if number in NUMBERS else number for number in _bare(piece))
            found += NUMBERS[first : last[0] + 1] if last else [piece.strip("[]")]
    return found


def _bare(piece):
    return [end.strip("[]") for end in piece.split(" to ")]


def _places(paths, root):
    """Return where each equation is marked: functions, classes or tests by its number, in order."""
    places = {}
    for path in sorted(paths):
        module, lines = ".".join(path.relative_to(root).with_suffix("").parts), path.read_text().splitlines()
        owners = _owners(ast.parse("\n".join(lines)), module, len(lines))
        for owner, line in zip(owners, lines):
            for number in marked(line):
                places.setdefault(number, {})[owner] = None
    return {number: list(found) for number, found in places.items()}


def _owners(tree, module, count):
    """Return the innermost function or class of each line by its dotted name, else the module."""
    owners = [module] * count

    def walk(node, name):
        for child in ast.iter_child_nodes(node):
            if isinstance(child, (ast.FunctionDef, ast.ClassDef)):
                inner = f"{name}.{child.name}"
                owners[child.lineno - 1 : child.end_lineno] = [inner] * (child.end_lineno - child.lineno + 1)
                walk(child, inner)

    walk(tree, module)
    return owners


def _shown(number):
    return f"[{number}]" if number[0].isdigit() else number


def _joined(names):
    return ", ".join(f"`{name}`" for name in names)


def main():
    """Write or check; the exit status."""
    check = generated.is_checking(__doc__)
    return generated.bring_up(PAGE, page(), check)


if __name__ == "__main__":
    sys.exit(main())
