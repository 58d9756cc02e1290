"""The tutorial's two jobs, from the file to the tooling, as its page says."""

import re
import shlex
from pathlib import Path

import pytest
from click.testing import CliRunner

from feederscrew.output import style
from feederscrew_cli.main import feeder

PAGE = Path(__file__).parents[3] / "docs" / "tutorial.md"
BLOCK = re.compile(r"```console sampled\n\$ feeder (.*)\n((?:(?!```).*\n)*)```")
FILES = {"tooling.dxf", "tooling.svg", "tooling.stl", "tooling.yaml", "tooling.png", "tooling.csv"}


@pytest.mark.long
@pytest.mark.thorough
def test_the_jobs_of_the_tutorial(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(style, "png", lambda figure: b"")  # test_tooling_files.py looks at pictures
    (tmp_path / "docs").symlink_to(PAGE.parent)
    told = []
    for line, shown in BLOCK.findall(PAGE.read_text()):
        words = shlex.split(line)
        if words[0] == "tune":  # the README's is run; of this one the line is read as the command reads it
            assert feeder.get_command(None, "tune").make_context("tune", words[1:]).params["target"] == 1.0
            continue
        words += ["--static"] * (words[0] == "tooling")  # what a trial says goes to stderr
        done = CliRunner().invoke(feeder, words)
        assert done.exit_code == 0, f"{line}: {done.output}"
        assert done.stdout.split("\n")[0].split() == shown.split("\n")[0].split(), line
        told.append(done.stdout)
    assert len(told) == 8
    screw, terminal = (
        dict(re.split(r"  +", row, maxsplit=1) for row in told[k].splitlines()) for k in (2, 6)
    )
    assert float(screw["correctly oriented parts per minute"].split()[0]) > 60.0
    purities = [float(job["purity, correctly oriented of what leaves [%]"]) for job in (screw, terminal)]
    assert 70.0 < purities[0] < 100.0 == purities[1]  # no verdict on a screw across the track is sure
    across = next(row.split() for row in told[3].splitlines() if row.split()[:2] == ["A", "90.00"])
    assert across[4:6] == ["0", "0"]  # in the trial none of them passes or turns
    for job in (told[3], told[7]):
        fates = [row.split() for row in job.splitlines()[2:]]
        often = [fate for fate in fates if float(fate[2]) >= 0.5]  # [%] C of the screw comes in 0.05 %
        assert len(often) >= 4
        assert not [fate for fate in often if fate[-1] == "yes"]  # none against the static rule
    for name in ("countersunk_m4x12", "ring_terminal"):
        assert {path.name for path in (tmp_path / "build/tutorial" / name).iterdir()} > FILES


def test_both_jobs_are_designed_by_one_command_each():
    """Designs take minutes: their lines are read here as the command reads them."""
    command, asked = feeder.get_command(None, "design"), []
    for line in re.findall(r"^feeder design (docs/.*)$", PAGE.read_text(), re.MULTILINE):
        words = shlex.split(line.replace("docs/", f"{PAGE.parent}/"))
        values = command.make_context("design", words).params
        asked.append((values["outcome"], values["target"]))
    assert asked == [("hanging", pytest.approx(1.0)), ("lying", pytest.approx(40 / 60))]
