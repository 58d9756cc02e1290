"""``feeder report`` from the command line."""

import functools
import json
import re
from pathlib import Path

import pytest

from feederscrew.output import report
from feederscrew.output.report import CHAPTERS

PARTS = Path(__file__).parents[3] / "parts"
UNDRAWN = True  # test_plots.py and others look at pictures
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


def test_same_input_same_bytes_wherever_it_is_written(run, light):
    run("report", PART, "-o", "one", "--set", "track.bank=5 deg")
    run("report", PART, "-o", "two", "--set", "track.bank=5 deg", "-q")
    one, two = (Path(place, PART.stem, "report.html").read_bytes() for place in ("one", "two"))
    assert one == two
    assert b"track.bank" in one and b"<td>5 deg</td><td>--set</td>" in one


def test_what_was_told_is_recorded(run, light):
    done = run("report", PARTS / "magnet.yaml")
    line = (
        "How it lies along the wall: part card: the card of aspect 1 has no outline - give the part as a mesh"
    )
    assert done.exit_code == 0
    assert f"Warning: {line}\n" in done.stderr
    record = json.loads(Path("results/magnet/run.json").read_text())["report"]
    assert record["warnings"].count(line) == 1
    assert record["effective"]["track.climb"] == "3 deg"


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
