"""Around the commands: the version, options by the environment, a bowl file that is not read, the cache."""

import builtins
import json
from pathlib import Path

import pytest
from command_lines import NUT, names

from feederscrew import __version__
from feederscrew.arrivals import simulation_cache
from feederscrew.base import caches

EXACT = ("--rule", "quasistatic")  # nothing is dropped or fed


def test_the_version_has_a_short_option_and_help_names_glossary_and_samples(run):
    assert run("-V").stdout == run("--version").stdout == f"feeder, version {__version__}\n"
    said = run("--help").stdout
    assert "docs/glossary.md" in said and "feeder sample" in said and "FEEDER_<OPTION>" in said


def test_an_option_that_is_not_typed_is_that_of_the_environment_and_it_is_said(run, monkeypatch):
    monkeypatch.setenv("FEEDER_FORMAT", "json")
    monkeypatch.setenv("FEEDER_SET", "drive.amplitude=0.3mm friction.static=0.5")
    done = run("convey")
    kept = run("convey", "--set", "drive.amplitude=0.3mm", "--set", "friction.static=0.5", "--format", "csv")
    assert json.loads(done.stdout)["velocity_mm_s"] > 0.0
    assert "FEEDER_FORMAT in the environment gives --format" in done.stderr
    assert kept.stdout.startswith("quantity") or "," in kept.stdout  # what is typed comes first
    assert "FEEDER" not in kept.stderr
    monkeypatch.setenv("FEEDER_FORMAT", "jsn")
    assert run("convey").exit_code == 2


def test_a_bowl_file_in_the_folder_that_is_not_read_is_said(run):
    """25.0 mm/s and not 153.6, in silence."""
    Path("bowl.yaml").write_text("drive: {amplitude: 0.3 mm}\n")
    line = "bowl.yaml in this folder is not read: add --config bowl.yaml to use it\n"
    for call in (("convey",), ("slide",), ("config", "show"), ("rate", NUT, "--rule", "csa")):
        done = run(*call)
        assert done.exit_code == 0 and done.stderr.count(line) == 1, call
    assert line not in run("convey", "--config", "bowl.yaml").stderr + run("convey", "-q").stderr
    Path("bowl.yaml").unlink()
    assert line not in run("convey").stderr


@pytest.mark.parametrize(
    "call",
    [
        ("headings", "--aspect", "A"), ("track", "--aspect", "A"), ("rate", "--aspect", "A", *EXACT),
        ("tooling", "--static", "--aspect", "A", "--class", "steel", *EXACT),
        ("trial", "--aspect", "A", "--parts", "1", "--seconds", "0.05", *EXACT),
    ],
)  # fmt: skip
def test_each_command_that_takes_a_part_into_a_bowl_says_which_friction_its_material_has(run, call):
    """tooling and trial of a part of plastic took 0.6 in silence; rate, bowl and design said so."""
    name, *options = call
    done = run(name, NUT, "--density", "abs", *options)
    assert done.exit_code == 0, done.output
    assert done.stderr.count("for plastic on steel the table has 0.33 static") == 1


def test_the_cache_is_listed_and_cleared_of_its_own_files_alone(run, monkeypatch, tmp_path):
    folder = tmp_path / "kept"
    monkeypatch.setenv(caches.SIMULATIONS_VARIABLE, str(folder))
    assert run("cache").stdout == f"{folder}: 0 simulations, 0 MB\n"
    simulation_cache.write({"what": "a test"}, {})
    (folder / "mine.txt").write_text("mine")
    (folder / f"link{simulation_cache.ENTRY_SUFFIX}").symlink_to(folder / "mine.txt")
    assert run("cache").stdout.startswith(f"{folder}: 1 simulations, ")
    assert "1 simulations kept; feeder cache clear" in run("doctor").stdout
    cleared = run("cache", "clear")
    assert (cleared.exit_code, cleared.stdout) == (0, "") and "Deleted 1 simulations" in cleared.stderr
    assert names(folder) == {"mine.txt", f"link{simulation_cache.ENTRY_SUFFIX}"}
    folder.chmod(0o777)  # others may write there: not used, nothing deleted
    assert "other users may write to it" in run("cache", "clear").stderr
    monkeypatch.setenv(caches.SIMULATIONS_VARIABLE, "")
    assert run("cache").stdout.startswith("no cache")


def test_what_a_command_needs_is_said_of_the_command(run, monkeypatch):
    """'--serve' is no option."""
    real = builtins.__import__

    def without(name, *rest):
        if name.startswith("werkzeug"):
            raise ImportError(name)
        return real(name, *rest)

    monkeypatch.setattr(builtins, "__import__", without)
    done = run("serve")
    line = "Error: feeder serve: needs werkzeug, which is not installed - pip install 'feederscrew[serve]'\n"
    assert (done.exit_code, done.stderr) == (1, line)
