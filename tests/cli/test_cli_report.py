"""``feeder report`` from the command line."""

import functools
import re
from pathlib import Path

from command_lines import BRACKET, names

from feederscrew.output import report_page as report
from feederscrew.output.report_page import CHAPTERS

ON_OCCASION = ("bowl", "tooling", "trial")  # chapters of a target or a machine, of devices, of parts sent
LIGHT = [chapter for chapter in CHAPTERS if chapter[0] in ("aspects", "part", "headings", "repeat")]


def test_one_file_with_every_chapter(run):
    done = run("report", BRACKET, "--aspect", "B", "-o", "out")
    assert done.exit_code == 0, done.output
    folder = Path("out", BRACKET.stem)
    text = (folder / "report.html").read_text()
    anchors = [anchor for anchor, *_ in CHAPTERS if anchor not in ON_OCCASION]
    assert names(folder) == {"report.html", "run.json"}
    assert re.findall(r'<section id="(\w+)">', text) == anchors
    tiles = re.findall(r'<div class="tile"><span>(.*?)</span><strong>(.*?)</strong>', text)
    labels = ["wanted", "travels", "leaves correctly oriented", "lies along the wall at"]
    assert [label for label, _ in tiles] == labels and tiles[0][1] == "aspect B"
    for picture in ("tipping", "headings_B", "convey_map", "track_map", "floor_plan"):
        assert f'<figure id="{picture}.png" class=' in text
    assert f"feeder report {BRACKET} --aspect B</pre>" in text
    assert done.stderr.endswith("Wrote out/lbracket_30x20x15 (report.html, run.json)\n")


def test_markdown_with_its_pictures_beside_it(run, monkeypatch):
    monkeypatch.setattr(report, "page", functools.partial(report.page, chapters=LIGHT))
    done = run("report", BRACKET, "--format", "md", "--density", "abs")
    assert done.exit_code == 0, done.output
    assert done.stderr.count("for plastic on steel the table has 0.33 static") == 1
    folder = Path("results", BRACKET.stem)
    shown = re.findall(r"\]\((report/[^)]+)\)", (folder / "report.md").read_text())
    assert {"report/aspects.png", "report/headings_A.png", "report/aspects.csv"} <= set(shown)
    assert all((folder / name).stat().st_size > 60 for name in shown)
