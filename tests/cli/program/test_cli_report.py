"""``feeder report`` from the command line."""

import functools
import re
from pathlib import Path

import pytest

from feederscrew.output import report
from feederscrew.output.report import CHAPTERS

PARTS = Path(__file__).parents[3] / "parts"
PART = PARTS / "lbracket_30x20x15.stl"
ON_OCCASION = ("bowl", "tooling", "trial")  # chapters of a target or a machine, of devices, of parts sent
LIGHT = [chapter for chapter in CHAPTERS if chapter[0] in ("aspects", "part", "headings", "repeat")]


@pytest.fixture
def light(monkeypatch):
    """Leave out the chapters that take long."""
    monkeypatch.setattr(report, "page", functools.partial(report.page, chapters=LIGHT))


def test_one_file_with_every_chapter(run):
    done = run("report", PART, "--aspect", "B", "-o", "out")
    assert done.exit_code == 0, done.output
    folder = Path("out", PART.stem)
    assert sorted(path.name for path in folder.iterdir()) == ["report.html", "run.json"]
    text = (folder / "report.html").read_text()
    assert re.findall(r'<section id="(\w+)">', text) == [
        anchor for anchor, *_ in CHAPTERS if anchor not in ON_OCCASION
    ]
    tiles = re.findall(r'<div class="tile"><span>(.*?)</span><strong>(.*?)</strong>', text)
    assert [label for label, _ in tiles] == [
        "wanted",
        "travels",
        "leaves correctly oriented",
        "lies along the wall at",
    ]
    assert tiles[0][1] == "aspect B"
    for picture in (
        "tipping.png",
        "headings_B.png",
        "convey_map.png",
        "track_map.png",
        "floor_plan.png",
    ):
        assert f'<figure id="{picture}" class=' in text
    assert f"feeder report {PART} --aspect B</pre>" in text
    assert done.stderr.endswith("Wrote out/lbracket_30x20x15 (report.html, run.json)\n")


def test_markdown_with_its_pictures_beside_it(run, light):
    done = run("report", PART, "--format", "md")
    assert done.exit_code == 0, done.output
    folder = Path("results", PART.stem)
    text = (folder / "report.md").read_text()
    shown = re.findall(r"\]\((report/[^)]+)\)", text)
    assert {"report/aspects.png", "report/headings_A.png", "report/aspects.csv"} <= set(shown)
    assert all((folder / name).stat().st_size > 60 for name in shown)


@pytest.mark.parametrize(
    ("arguments", "status", "line"),
    [
        (("--config", "none.yaml"), 1, "Error: none.yaml: "),
        (("--format", "pdf"), 2, "Error: Invalid value for '--format': 'pdf' is not one of 'html', 'md'."),
    ],
)
def test_faults_are_one_line_and_leave_nothing(run, arguments, status, line):
    done = run("report", PART, *arguments)
    assert (done.exit_code, done.stderr.count("\n")) == (status, 1)
    assert done.stderr.startswith(line)
    assert not Path("results").exists()
