"""The package as a user gets it: a wheel from the sdist, installed elsewhere, run far from the sources."""

import json
import os
import re
import subprocess
import sys
import tarfile
import venv
import zipfile
from email import message_from_bytes
from email.message import Message
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


LINK = re.compile(r"(!?)\[[^\]]*\]\(([^)]*)\)")


def metadata_of(place) -> list[Message]:
    """What an index reads of the sdist and of the wheel."""
    [sdist], [wheel] = place.glob("*.tar.gz"), place.glob("*.whl")
    with tarfile.open(sdist) as archive, zipfile.ZipFile(wheel) as packed:
        [inside] = [name for name in archive.getnames() if name.count("/") == 1 and name.endswith("PKG-INFO")]
        [beside] = [name for name in packed.namelist() if name.endswith(".dist-info/METADATA")]
        texts = [archive.extractfile(inside).read(), packed.read(beside)]
    return [message_from_bytes(text) for text in texts]


def test_a_page_of_an_index_has_no_picture_and_no_link_that_leads_nowhere(place):
    for metadata in metadata_of(place):
        page = metadata.get_payload()
        assert metadata["Description-Content-Type"] == "text/markdown"
        assert "## The main job" in page and page.count("```") >= 8
        assert [target for _, target in LINK.findall(page) if "://" not in target] == []
        assert [url for url in metadata.get_all("Project-URL", []) if "https://" not in url] == []


def test_with_an_address_of_the_files_pictures_and_links_of_the_page_are_absolute(tmp_path):
    """The addresses stand in one table of pyproject.toml; as they are there now they are empty."""
    for name in ("README.md", "LICENSE", "hatch_build.py", "feederscrew/base/version.py"):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_bytes((ROOT / name).read_bytes())
    project = (ROOT / "pyproject.toml").read_text()
    for name in ("pages", "pictures"):
        assert project.count(f'{name} = ""') == 1
        project = project.replace(f'{name} = ""', f'{name} = "https://host.invalid/{name}/"')
    (tmp_path / "pyproject.toml").write_text(project)
    page = ran(sys.executable, "-m", "hatchling", "metadata", "readme", cwd=tmp_path)
    ours = LINK.findall((ROOT / "README.md").read_text())
    kinds = {"": "pages", "!": "pictures"}
    assert LINK.findall(page) == [(of, f"https://host.invalid/{kinds[of]}/{target}") for of, target in ours]


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
