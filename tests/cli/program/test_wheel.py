"""The package as a user gets it: built as a wheel, installed elsewhere, run far from the repository."""

import json
import os
import shutil
import subprocess
import sys
import venv
from pathlib import Path

import numpy
import pytest

from feederscrew_cli.main import COMMANDS

pytestmark = pytest.mark.long  # all of them, so that one process has them and makes the wheel once
ROOT = Path(__file__).parents[3]
SOURCES = (
    "pyproject.toml",
    "setup.py",
    "README.md",
    "LICENSE",
    "MANIFEST.in",
    "build_backend",
    "feederscrew",
    "cli",
)
CACHES = shutil.ignore_patterns("__pycache__", "*.nbi", "*.nbc", "*.kernel")
PART = "lbracket_30x20x15.stl"
COUNTS = "aspect,counted\nA,40\nB,30\nC,20\nD,10\nE,10\n"
DEAD = ("--set", "restitution=0")  # one start and a short way to its period: quick where nothing is compiled
STEEP = (*DEAD, "--set", "track.climb=20 deg")  # few settings convey
EXACT = ("--rule", "quasistatic")  # nothing is dropped or fed: minutes without a compiler
CALLS = {
    "config": ["init", "bowl.yaml"],
    "aspects": [PART, "--rule", "closed", "-o", "results"],
    "inertia": [PART, "-o", "results"],
    "compare": ["--help"],  # drops the part
    "drop": [PART, "--drops", "1", "--jobs", "1"],
    "calibrate": [PART, "--with", "counts.csv"],
    "slide": ["--config", "bowl.yaml"],
    "convey": ["--config", "bowl.yaml"],
    "rate": [PART, "--aspect", "A", *EXACT],
    "tune": [PART, "--aspect", "A", "--target", "20/min", *STEEP, *EXACT],
    "floor": [PART, "--aspect", "A", "--config", "bowl.yaml"],
    "track": [PART, "--aspect", "A", "--config", "bowl.yaml"],
    "headings": ["--help"],  # feeds parts onto the floor
    "bowl": ["--help"],  # minutes without a compiler
    "tooling": ["--help"],
    "trial": ["--help"],
    "design": ["--help"],
    "batch": [PART, "-o", "results/all", "--no-pictures", "--jobs", "1", *EXACT],
    "report": ["--help"],  # its files are asked for by name, above
    "reproduce": [],  # `aspects` draws
    "doctor": [],
    "serve": ["--help"],
}
RUN = """
import json, sys
from click.testing import CliRunner
from feederscrew_cli.main import feeder
done = {}
for name, arguments in json.loads(sys.argv[1]).items():
    result = CliRunner().invoke(feeder, [name, *arguments])
    done[name] = [result.exit_code, result.output[-500:]]
print(json.dumps(done))
"""


def ran(*call, **keywords):
    """What a program prints that must end well."""
    done = subprocess.run([str(word) for word in call], capture_output=True, text=True, **keywords)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.fixture(scope="module")
def place(tmp_path_factory):
    """A virtual environment that holds the wheel and sees the libraries, but not this repository."""
    tree, home = tmp_path_factory.mktemp("tree"), tmp_path_factory.mktemp("home")
    for name in SOURCES:
        copy = shutil.copytree if (ROOT / name).is_dir() else shutil.copy
        copy(ROOT / name, tree / name, **({"ignore": CACHES} if copy is shutil.copytree else {}))
    pip = [sys.executable, "-m", "pip", "--quiet", "--disable-pip-version-check"]
    ran(*pip, "wheel", "--no-build-isolation", "--no-deps", "--no-index", "-w", home, tree, cwd=home)
    venv.create(home / "venv", symlinks=os.name != "nt")
    [packages] = (home / "venv").glob("**/site-packages")
    (packages / "libraries.pth").write_text(str(Path(numpy.__file__).parent.parent))
    [wheel] = home.glob("*.whl")
    ran(*pip, "--python", home / "venv", "install", "--no-deps", "--no-index", wheel, cwd=home)
    return home


def environment():
    kept = {key: value for key, value in os.environ.items() if key not in ("PYTHONPATH", "NUMBA_CACHE_DIR")}
    return kept | {"NUMBA_DISABLE_JIT": "1"}  # nothing to compile: what is tested is that all is there


def test_nothing_lands_in_site_packages_but_our_own_names(place):
    [packages] = (place / "venv").glob("**/site-packages")
    names = {path.name for path in packages.iterdir()} - {"libraries.pth", "__pycache__"}
    assert {name for name in names if not name.endswith(".dist-info")} == {"feederscrew", "feederscrew_cli"}


def test_no_file_of_the_packages_is_left_behind(place):
    [packages] = (place / "venv").glob("**/site-packages")
    for folder, name in (("feederscrew", "feederscrew"), ("cli", "feederscrew_cli")):
        ours = {p.relative_to(ROOT / folder) for p in (ROOT / folder).rglob("*") if p.is_file()}
        there = {p.relative_to(packages / name) for p in (packages / name).rglob("*") if p.is_file()}
        assert {p for p in ours if p.suffix not in (".pyc", ".nbi", ".nbc", ".kernel")} <= there


def test_every_command_runs_there(place):
    shutil.copy(ROOT / "parts" / PART, place)
    (place / "counts.csv").write_text(COUNTS)
    [program] = (place / "venv").glob("*/feeder*")
    assert "feeder" in ran(program, "--version", cwd=place, env=environment())
    python = program.with_name(Path(sys.executable).name)
    assert "feeder, version" in ran(python, "-m", "feederscrew", "--version", cwd=place, env=environment())
    assert CALLS.keys() == COMMANDS.keys()
    done = json.loads(ran(python, "-c", RUN, json.dumps(CALLS), cwd=place, env=environment()))
    assert "drive.amplitude" in done.pop("tune")[1]
    assert {name: output for name, (status, output) in done.items() if status} == {}
