"""The tutorial's two jobs, from the file to the tooling, as its page says."""

import re
import shlex

import pytest
from command_lines import ROOT, called, names

from feederscrew.output import style
from feederscrew_cli.main import feeder

PAGE = ROOT / "docs/tutorial.md"
BLOCK = re.compile(r"```console sampled\n\$ feeder (.*)\n((?:(?!```).*\n)*)```")
FILES = {"tooling.dxf", "tooling.svg", "tooling.stl", "tooling.yaml", "tooling.png", "tooling.csv"}


def parsed(command, words):
    """The options of a line as its command reads them, which is not run."""
    return feeder.get_command(None, command).make_context(command, words).params


def fates_of(printed):
    """Rows of a table of `feeder trial`: the counts by their columns, and whether the trial disagrees."""
    head, _, *rows = printed.splitlines()
    columns = head.split()
    for row in (row.split() for row in rows if row[:1].strip()):
        yield dict(zip(columns, row)) | {"disagrees": row[-1]}


@pytest.mark.long
def test_the_jobs_of_the_tutorial(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(style, "png", lambda figure: b"")  # test_tooling_files.py looks at pictures
    (tmp_path / "docs").symlink_to(PAGE.parent)
    printed = []
    for line, shown in BLOCK.findall(PAGE.read_text()):
        command, *words = shlex.split(line)
        if command == "tune":  # the README's is run
            assert parsed(command, words)["target"] == 1.0
            continue
        words += ["--static"] * (command == "tooling")  # the trial takes the first chain of both
        printed.append(called(command, *words).stdout)
        assert printed[-1].split("\n")[0].split() == shown.split("\n")[0].split(), line
    assert len(printed) == 8
    screw, terminal = (
        dict(re.split(r"  +", row, maxsplit=1) for row in printed[k].splitlines()) for k in (2, 6)
    )
    assert float(screw["correctly oriented parts per minute"].split()[0]) > 30.0
    purities = [float(job["purity, correctly oriented of what leaves [%]"]) for job in (screw, terminal)]
    assert 95.0 < purities[0] <= 100.0 == purities[1]  # no verdict on a screw on its head is sure
    fates = [list(fates_of(job)) for job in (printed[3], printed[7])]
    across = next(fate for fate in fates[0] if fate["heading"] == "90.00")
    assert across["tried"] == "3" and across["passed"] == "0"
    on_its_head = next(fate for fate in fates[0] if fate["aspect"] == "B")
    assert on_its_head["tried"] == "3" and on_its_head["passed"] == "0" and "stopped" not in on_its_head
    for job in fates:
        often = [fate for fate in job if fate["aspect"] in "AB"]  # C of the screw comes in 0.05 %
        assert len(often) >= 4
        # how many roll back across the groove the rule is not sure of
        assert not [fate for fate in often if fate["disagrees"] == "yes" and fate is not across]
    for name in ("countersunk_m4x12", "ring_terminal"):
        assert names(tmp_path / "build/tutorial" / name) > FILES


def test_both_jobs_are_designed_by_one_command_each():
    """Designs take minutes: their lines are read here as the command reads them."""
    lines = re.findall(r"^feeder design (docs/.*)$", PAGE.read_text(), re.MULTILINE)
    values = [parsed("design", shlex.split(line.replace("docs/", f"{PAGE.parent}/"))) for line in lines]
    wanted = [(value["outcome"], value["target"]) for value in values]
    assert wanted == [("hanging", pytest.approx(1.0)), ("lying", pytest.approx(40 / 60))]
