"""Say what a release is, step by step, and check it; build and try its files; tag it.

Example: python docs/release.py          (the steps, and what stands in the way)
         python docs/release.py --build  (sdist and wheel in dist/, tried on each Python at hand)
         python docs/release.py --tag    (both, and the tag if nothing stands in the way)
"""

import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
STEPS = (
    "make test                    format, lint and every test are green on a clean tree",
    "make docs, make site         every output, table and picture of the pages is as the program is",
    "make bench                   docs/speed.md is measured; no wait is slower without a reason",
    "python docs/validation.py    the measured sets; a changed error has a reason in CHANGELOG.md",
    "CHANGELOG.md                 Added, Changed, Fixed, Removed since the last release, and the date",
    "make release                 sdist and wheel, tried on each Python at hand, and git tag v{version}",
)
LEAST = (3, 11)
PART = "lbracket_30x20x15.stl"


def version():
    """Return the version that the package says it has."""
    return re.search(r'__version__ = "(.*)"', (ROOT / "feederscrew/base/version.py").read_text())[1]


def faults():
    """Return what stands in the way of a release, a line each."""
    here = version()
    top = re.search(r"^## (.*)$", (ROOT / "CHANGELOG.md").read_text(), re.MULTILINE)[1]
    if not re.fullmatch(rf"{re.escape(here)}, \d{{4}}-\d\d-\d\d", top):
        yield f"CHANGELOG.md begins with '{top}', not with '{here}, ' and a date"
    if f"version: {here}\n" not in (ROOT / "CITATION.cff").read_text():
        yield f"CITATION.cff does not say {here}"
    if subprocess.run(["git", "status", "--porcelain"], cwd=ROOT, capture_output=True, text=True).stdout:
        yield "there are changes that are not committed"


def run(*call, cwd):
    """Run a program that must end well; return what it prints."""
    done = subprocess.run([str(word) for word in call], cwd=cwd, capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"{' '.join(map(str, call))} ended with {done.returncode}:\n{done.stdout}{done.stderr}")
    return done.stdout


def pythons():
    """Return the newest Python of each minor version from LEAST on, by its version."""
    folders = [
        Path(folder) for folder in os.environ["PATH"].split(os.pathsep) if not folder.endswith("shims")
    ]
    folders += (Path.home() / ".pyenv/versions").glob("*/bin")
    programs = {}
    for folder in folders:
        for path in folder.glob("python3.[0-9][0-9]"):
            minor = tuple(map(int, path.name.removeprefix("python").split(".")))
            if minor >= LEAST:
                programs.setdefault(minor, path)
    return dict(sorted(programs.items()))


def environment(python, folder, *packages):
    """Make an environment with packages; return its folder of programs."""
    run(python, "-m", "venv", folder, cwd=ROOT)
    programs = folder / ("Scripts" if os.name == "nt" else "bin")
    pip = (programs / "python", "-m", "pip", "install", "--quiet", "--disable-pip-version-check")
    run(*pip, *packages, cwd=ROOT)
    return programs


def build():
    """Build sdist and wheel in dist/, the wheel from the sdist, and try both outside the checkout."""
    shutil.rmtree(ROOT / "dist", ignore_errors=True)
    with tempfile.TemporaryDirectory() as place:
        tools = environment(sys.executable, Path(place) / "build", "build", "uv")
        run(tools / "python", "-m", "build", "--outdir", ROOT / "dist", ROOT, cwd=place)
        [sdist], [wheel] = (ROOT / "dist").glob("*.tar.gz"), (ROOT / "dist").glob("*.whl")
        programs_of = pythons()
        first = next(iter(programs_of))
        for minor, package in [(first, sdist), *((minor, wheel) for minor in programs_of)]:
            home = Path(place) / f"{minor[0]}{minor[1]}{package.suffix}"
            programs = home / tools.name
            run(tools / "uv", "venv", "--quiet", "--python", programs_of[minor], home, cwd=place)
            run(
                tools / "uv", "pip", "install", "--quiet", "--python", programs / "python", package, cwd=place
            )
            shutil.copy(ROOT / "parts" / PART, home)
            run(programs / "python", "-m", "feederscrew", "--version", cwd=home)
            run(programs / "feeder", "aspects", PART, "-o", "results", cwd=home)
            run(programs / "feeder", "tooling", PART, "--static", "-o", "results", cwd=home)
            if not list(home.glob("results/*/aspects.png")):
                sys.exit(f"Python {minor[0]}.{minor[1]}: no picture was written")
            print(f"Python {minor[0]}.{minor[1]}: {package.name} installed, aspects and tooling run")


def main():
    """Print the steps and what is missing; the exit status is 1 if something is."""
    print(f"A release of feeder {version()}:\n")
    for number, step in enumerate(STEPS, 1):
        print(f"  {number}. {step.format(version=version())}")
    missing = list(faults())
    print(
        "\n"
        + "\n".join([f"missing: {line}" for line in missing] or ["Nothing is missing that can be checked."])
    )
    if {"--build", "--tag"} & set(sys.argv):
        build()
    if "--tag" in sys.argv and not missing:
        run("git", "tag", "-a", f"v{version()}", "-m", f"feeder {version()}", cwd=ROOT)
        print(f"tagged v{version()}")
    return int(bool(missing) and "--build" not in sys.argv)


if __name__ == "__main__":
    sys.exit(main())
