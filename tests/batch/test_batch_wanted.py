"""The aspect that a list asks for, the launch, and what the summary and the pictures call them."""

import re
from pathlib import Path

import pytest
import shapes

from feederscrew import batch
from feederscrew.batch import summary, task, work
from feederscrew.output import batch as batch_output
from feederscrew.part import gate, load, topology
from feederscrew.resting.aspects import find


@pytest.fixture
def block(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    shapes.box(8.0, 12.0, 20.0).export(tmp_path / "block.stl")
    return tmp_path / "block.stl"


def row(request, rule="closed", **choices):
    choices["rule"] = rule
    made = work.work(task.Task.of(request, batch.Choices(**choices), Path(request.source).read_bytes()))
    assert made.status == task.DONE, made.reason
    return made


def test_a_list_asks_for_an_aspect(block, tmp_path):
    (tmp_path / "list.csv").write_text("part,aspect\nblock.stl,\nblock.stl,C\nblock.stl,q\n")
    usual, wanted, none = batch.gather(["list.csv"])
    assert (usual.aspect, wanted.aspect) == (None, "C") and wanted.name == "block-2"
    made = row(wanted)
    assert made.row["aspect"] == "C" and made.row["orientation"].startswith("C@")
    part = load(str(block))
    assert made.files[work.THUMBNAIL] == batch_output.thumbnail(part, find(part), "C")
    assert made.files[work.THUMBNAIL] != row(usual).files[work.THUMBNAIL]
    failed = work.work(task.Task.of(none, batch.Choices(), block.read_bytes()))
    assert failed.reason == "list.csv:4: aspect of block.stl: there is no aspect 'q' - choose one of A, B, C"


def test_the_launch_and_the_drops_are_the_answer(block):
    (asked,) = batch.gather([str(block)])
    placed, fed = (row(asked, "recommended", launch=launch, pictures=False) for launch in ("place", "feed"))
    assert placed.row["answer"].endswith("launch place") and fed.row["answer"].endswith("launch feed")
    assert placed.key != fed.key and placed.effective["launch"] == "place"
    dropped = row(asked, "recommended", drops=200, pictures=False)
    assert dropped.row["answer"] == "drop test, launch feed"
    assert dropped.row["aspect"] == dropped.row["drop_aspect"]
    assert dropped.row["p_orientation"] <= dropped.row["p_drop"]


@pytest.mark.parametrize("count", [1, summary.TILES + 1])
def test_tiles_name_the_orientation_and_fill_sheets(count):
    made = {"folder": "block", "status": task.DONE, "orientation": "C@90", "parts_per_minute": 12.0}

    class Store:
        def file(self, folder, name):
            return b"PNG"

    sheets = list(summary.sheets(Store(), [made] * count))
    assert sheets[0][0] == (b"PNG", "block", "C@90: 12 / min")
    assert sum(map(len, sheets)) == count and len(sheets) == -(-count // summary.TILES)
    card = {
        **made,
        "orientation": None,
        "parts_per_minute": None,
        "note": "a part card has no outline: no rate",
    }
    assert next(summary.sheets(Store(), [card]))[0][2] == "a part card has no outline: no rate"


@pytest.mark.parametrize("advice", [topology.SAVE_SHELLS, gate.CLOSE_IN_CAD, gate.UNITE_IN_CAD])
def test_a_failed_part_is_not_advised_what_a_batch_has_no_option_for(block, advice):
    (asked,) = batch.gather([str(block)])
    failed = task.Outcome.failed(task.Task.of(asked, batch.Choices(), b""), f"is not closed - {advice}")
    assert "allow_open" not in failed.reason
    assert failed.reason.endswith(re.split(r"[,;] or pass", advice)[0])
