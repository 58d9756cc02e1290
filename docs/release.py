"""Say what a release is, step by step, and check what can be checked.

Example: python docs/release.py
"""

import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
STEPS = (
    "make test                    format, lint and every test are green on a clean tree",
    "make docs                    every output, table and picture of the pages is as the program is",
    "make bench                   docs/speed.md is measured; no wait is slower without a reason",
    "python docs/validation.py    the measured sets; a changed error has a reason in CHANGELOG.md",
    "CHANGELOG.md                 Added, Changed, Fixed since the last release, and the date",
    "git tag v{version}              on the commit that all of this was done on",
)


def version():
    """Return the version that the package says it has."""
    return re.search(r'__version__ = "(.*)"', (ROOT / "feederscrew/__init__.py").read_text())[1]


def faults():
    """Return what stands in the way of a release, a line each."""
    here = version()
    top = re.search(r"^## (\S+?),? (.*)$", (ROOT / "CHANGELOG.md").read_text(), re.MULTILINE)
    if top[1] != here:
        yield f"CHANGELOG.md begins with {top[1]}, not with {here}"
    if "not yet" in top[2]:
        yield f"CHANGELOG.md says of {here}: {top[2]}"
    if subprocess.run(["git", "status", "--porcelain"], cwd=ROOT, capture_output=True, text=True).stdout:
        yield "there are changes that are not committed"


def main():
    """Print the steps and what is missing; the exit status is 1 if something is."""
    print(f"A release of feeder {version()}:\n")
    for number, step in enumerate(STEPS, 1):
        print(f"  {number}. {step.format(version=version())}")
    missing = list(faults())
    print(
        "\n"
        + (
            "\n".join(f"missing: {line}" for line in missing)
            or "Nothing is missing that can be checked here."
        )
    )
    return int(bool(missing))


if __name__ == "__main__":
    sys.exit(main())
