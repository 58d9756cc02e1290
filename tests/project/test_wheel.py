"""The package as a user gets it: a wheel from the sdist, installed elsewhere, run far from the sources."""

import json
import os
import subprocess
import sys
import tarfile
import venv
from pathlib import Path

import numpy
import pytest
from command_lines import BRACKET, ROOT, names

from feederscrew_cli.main import COMMANDS

pytestmark = pytest.mark.long  # both, so that one process has them and makes the wheel once
PART = BRACKET.name
STEEP = ("--set", "restitution=0", "--set", "track.climb=20 deg")  # few settings convey: soon over
EXACT = ("--rule", "quasistatic")  # nothing is dropped or fed: minutes without a compiler
# minutes without a compiler
HELP = ("advise", "compare", "headings", "bowl", "tooling", "trial", "design", "report", "serve")
ON_A = [PART, "--aspect", "A"]
CALLS = dict.fromkeys(HELP, ("--help",)) | dict.fromkeys(
    ("reproduce", "doctor", "cache"), ()
)  # `aspects` draws
CALLS |= dict.fromkeys(("slide", "convey"), ("--config", "bowl.yaml"))
CALLS |= dict.fromkeys(("floor", "track"), (*ON_A, "--config", "bowl.yaml"))
CALLS = {"sample": ["--all"], "config": ["init", "bowl.yaml"]} | CALLS | {
    "aspects": [PART, "--rule", "closed", "-o", "results"], "inertia": [PART, "-o", "results"],
    "drop": [PART, "--drops", "1", "--jobs", "1"], "calibrate": [PART, "--with", "counts.csv"],
    "rate": [*ON_A, *EXACT], "tune": [*ON_A, "--target", "20/min", *STEEP, *EXACT],
    "batch": [PART, "-o", "results/all", "--no-pictures", "--jobs", "1", *EXACT],
}  # fmt: skip
RUN = """
import json, sys
from click.testing import CliRunner
from feederscrew_cli.main import feeder
run = lambda *call: CliRunner().invoke(feeder, call)
done = {name: run(name, *arguments) for name, arguments in json.loads(sys.argv[1]).items()}
print(json.dumps({name: [end.exit_code, end.output[-500:]] for name, end in done.items()}))
"""


def ran(*call, **keywords):
    """What a program prints that must end well."""
    done = subprocess.run([str(word) for word in call], capture_output=True, text=True, **keywords)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.fixture(scope="module")
def place(tmp_path_factory):
    """A virtual environment that holds the wheel and sees the libraries, but not this repository."""
    home = tmp_path_factory.mktemp("home")
    ran(sys.executable, "-m", "hatchling", "build", "-t", "sdist", "-d", home, cwd=ROOT)
    [sdist] = home.glob("*.tar.gz")
    pip = [sys.executable, "-m", "pip", "--quiet", "--disable-pip-version-check"]
    ran(*pip, "wheel", "--no-build-isolation", "--no-deps", "--no-index", "-w", home, sdist, cwd=home)
    venv.create(home / "venv", symlinks=os.name != "nt")
    [packages] = (home / "venv").glob("**/site-packages")
    (packages / "libraries.pth").write_text(str(Path(numpy.__file__).parent.parent))
    [wheel] = home.glob("*.whl")
    ran(*pip, "--python", home / "venv", "install", "--no-deps", "--no-index", wheel, cwd=home)
    return home


def test_the_sdist_holds_what_is_needed_to_go_on_from_it(place):
    """Of two names of one folder the builder keeps one: a wheel from such an sdist had no command line."""
    [sdist] = place.glob("*.tar.gz")
    with tarfile.open(sdist) as archive:
        held = [Path(*Path(name).parts[1:]) for name in archive.getnames()]
    assert len(held) == len(set(held))
    folders = "feederscrew feederscrew_cli cli docs parts configs tests benchmarks".split()
    for folder in folders:
        ours = {path.relative_to(ROOT) for path in (ROOT / folder).rglob("*") if path.is_file()}
        assert {path for path in ours if "__pycache__" not in path.parts} <= set(held), folder
    assert {Path("Makefile"), Path("LICENSE"), Path("CHANGELOG.md")} <= set(held)


def test_all_files_of_the_packages_land_in_site_packages_under_our_own_names(place):
    [packages] = (place / "venv").glob("**/site-packages")
    landed = names(packages) - {"libraries.pth", "__pycache__"}
    assert {name for name in landed if not name.endswith(".dist-info")} == {"feederscrew", "feederscrew_cli"}
    parts = [path.name for path in (ROOT / "parts").iterdir() if path.suffix in (".stl", ".step", ".yaml")]
    assert names(packages / "feederscrew/jobs/samples/parts") >= set(parts)
    for folder, name in (("feederscrew", "feederscrew"), ("cli", "feederscrew_cli")):
        ours, there = (
            {path.relative_to(root) for path in root.rglob("*") if path.is_file()}
            for root in (ROOT / folder, packages / name)
        )
        assert {path for path in ours if path.suffix not in (".pyc", ".nbi", ".nbc", ".kernel")} <= there


def test_every_command_runs_there(place):
    kept = {key: value for key, value in os.environ.items() if key not in ("PYTHONPATH", "NUMBA_CACHE_DIR")}
    own = {"cwd": place, "env": kept | {"NUMBA_DISABLE_JIT": "1"}}  # nothing to compile: is all there?
    [program] = (place / "venv").glob("*/feeder*")
    python = program.with_name(Path(sys.executable).name)
    for call in ([program], [python, "-m", "feederscrew"]):
        assert "feeder, version" in ran(*call, "--version", **own)
    assert CALLS.keys() == COMMANDS.keys()
    done = json.loads(ran(python, "-c", RUN, json.dumps(CALLS), **own))
    assert "drive.amplitude" in done.pop("tune")[1]
    assert {name: output for name, (status, output) in done.items() if status} == {}
