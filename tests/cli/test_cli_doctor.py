"""``feeder doctor``: the installation, told without importing it."""

import platform
import tomllib
from importlib import metadata

from command_lines import ROOT

from feederscrew_cli import doctor

NEEDS = "click>=8|numpy>=1|nowhere; extra == 'dist'|click; extra == 'step'|ruff; extra == 'test'".split("|")


def test_it_lists_versions_extras_kernels_and_completion(run, monkeypatch, tmp_path):
    monkeypatch.setattr(metadata, "requires", lambda name: NEEDS)
    done = run("doctor")
    assert (done.exit_code, done.stderr) == (0, "")
    table = dict(line.split(maxsplit=1) for line in done.stdout.splitlines() if line.startswith("  "))
    assert table["numpy"] == metadata.version("numpy")
    assert table["python"].startswith(platform.python_version())
    assert table["dist"] == "missing nowhere: pip install 'feederscrew[dist]'"
    assert table["state"] == "none is kept: FEEDER_CACHE is empty"
    assert table["step"] == f"click {metadata.version('click')}" and "test" not in table
    monkeypatch.undo()  # every extra of the project is told but those of developers
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    needed, extras = doctor.requirements()
    assert set(extras) == set(project["optional-dependencies"]) - set(doctor.DEVELOPERS)
    assert len(needed) == len(project["dependencies"])
    # it counts the kernels of the folder that numba is told
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path))
    assert dict(doctor.kernels())["state"].startswith("none yet")
    (tmp_path / "sweep.kernel").touch()
    assert doctor.kernels() == [("state", "1 functions kept"), ("place", str(tmp_path))]
    # ... unless others may write there
    tmp_path.chmod(0o777)
    state = dict(doctor.kernels())
    assert state["place"] != str(tmp_path) and "other users may write to it" in state["not used"]
