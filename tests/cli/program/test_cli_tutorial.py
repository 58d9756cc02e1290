"""The tutorial's two jobs, from the file to the tooling, as its page says."""

import re
import shlex
from pathlib import Path

import pytest
from click.testing import CliRunner

from feederscrew_cli.main import feeder

PAGE = Path(__file__).parents[3] / "docs" / "tutorial.md"
BLOCK = re.compile(r"```console sampled\n\$ feeder (.*)\n((?:(?!```).*\n)*)```")
FILES = {"tooling.dxf", "tooling.svg", "tooling.stl", "tooling.yaml", "tooling.png", "tooling.csv"}


@pytest.mark.long
@pytest.mark.thorough
def test_the_jobs_of_the_tutorial(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "docs").symlink_to(PAGE.parent)
    told = []
    for line, shown in BLOCK.findall(PAGE.read_text()):
        words = shlex.split(line)
        words += ["--static"] * (words[0] == "tooling")  # what a trial says goes to stderr
        done = CliRunner().invoke(feeder, words)
        assert done.exit_code == 0, f"{line}: {done.output}"
        assert done.stdout.split("\n")[0].split() == shown.split("\n")[0].split(), line
        told.append(done.stdout)
    assert len(told) == 9
    screw, terminal = (
        dict(re.split(r"  +", row, maxsplit=1) for row in told[k].splitlines()) for k in (2, 7)
    )
    assert float(screw["correctly oriented parts per minute"].split()[0]) > 60.0
    for job in (screw, terminal):
        assert float(job["purity, correctly oriented of what leaves [%]"]) == 100.0
    for job in (told[3], told[8]):
        fates = {row.split()[0]: row.split() for row in job.splitlines()}
        assert fates["A"] and "yes" not in job.split()  # no orientation against the static rule
    for name in ("countersunk_m4x12", "ring_terminal"):
        assert {path.name for path in (tmp_path / "build/tutorial" / name).iterdir()} > FILES
