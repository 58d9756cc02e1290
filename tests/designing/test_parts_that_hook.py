"""Parts that hook: a status of its own, first in every answer, on every paper and in the bowl file."""

import json
import re

import numpy as np
import pytest
import shapes
from design_counts import proved

from feederscrew import bowl as bowls
from feederscrew.bowl.verified import HELD, Status
from feederscrew.designing import design, hazards, loop
from feederscrew.designing.findings import Hooking
from feederscrew.designing.record import Risk, RiskKind
from feederscrew.output import bowl_sheet, design_pages, designs, machine, marking, proof, tables
from feederscrew.resting.aspects import find
from feederscrew.sorting.orientations import orientations

PART = shapes.part(shapes.box(20, 12, 5))
HOOKING = Hooking(13, 13, 4e-3, 1.5e-3)
RISKS = (Risk(RiskKind.CLIMBS, "parts climbed"), Risk(RiskKind.HOOKS, "parts may hook", hooking=HOOKING))
WORDS = "holds if parts arrive single"


@pytest.fixture(scope="module")
def hooking():
    return proved(PART, bowls.default(), risks=RISKS)


def test_a_design_whose_parts_hook_does_not_hold_without_a_condition(hooking):
    plain = proved(PART, bowls.default(), risks=RISKS[:1])
    assert (plain.status, plain.condition, plain.why) == (Status.HOLDS, "", "")
    assert (hooking.status, hooking.why, hooking.cause) == (WORDS, hooking.condition, "")
    assert hooking.status in HELD and hooking.delivers and not hooking.shortfalls
    for text in ("13 of 13 pulls", "de-tangling drum", "bursts of air", "magazine", "4 mm", "1.5 mm"):
        assert text in hooking.condition
    # one that falls short says that first
    slow = proved(PART, bowls.default(), risks=RISKS, held=3)
    assert (slow.status, slow.condition) == (Status.FALLS_SHORT, "")
    ring = Hooking(20, 16, float("nan"), 1.5e-3)
    open_ring = proved(PART, bowls.default(), risks=(Risk(RiskKind.HOOKS, "", hooking=ring),))
    assert "16 of 20 pulls" in open_ring.condition and "nan" not in open_ring.condition


def test_every_answer_begins_with_the_status_and_its_condition(hooking, tmp_path):
    document = designs.document(hooking)
    assert (document["status"], document["why"]) == (WORDS, hooking.condition)
    condition = document["condition"]
    assert (condition["held"], condition["pulls"], condition["opening_mm"]) == (13, 13, pytest.approx(4.0))
    assert len(condition["separate_by"]) == 3 and "mouth" in condition["change_the_part"]
    assert designs.document(proved(PART, bowls.default()))["condition"] is None
    first, second, *_ = tables.text(designs.summary(hooking), "csv").splitlines()[1:]
    assert first == f"status,{WORDS}" and second.startswith("why,")
    page = design_pages.page(hooking)
    assert f"design of a bowl: {WORDS}" in page and "de-tangling drum" in page.split('id="loop"')[0]
    # the bowl file, read back
    path = tmp_path / "design.yaml"
    path.write_text(designs.bowl_file(hooking, ()))
    lines = path.read_text().splitlines()
    assert lines[0].startswith(f"# {WORDS}: A@0") and re.search("hook", lines[1])
    tried = bowls.verified(path)
    assert (tried.status, tried.condition) == (WORDS, hooking.condition)
    assert tried.sentence.endswith(f": {WORDS}")
    written = path.read_text()
    path.write_text(written.replace(f"status: {WORDS}", "status: holds"))
    assert "its status is 'holds', and it has a condition" in str(bowls.verified(path).faults)
    path.write_text(written)
    path.write_text(path.read_text().replace("purity: 1\n", "purity: 0.5\n"))
    assert "its status is 'holds if parts arrive single', and the purity" in str(bowls.verified(path).faults)


def test_every_paper_bears_the_condition_and_keeps_its_name(hooking):
    trial = designs.trial_of(hooking)
    mark = marking.of_trial(trial)
    assert mark == WORDS.upper() and marking.of_trial(designs.trial_of(proved(PART, bowls.default()))) == ""
    assert marking.file_name("bowl.stl", mark) == "bowl.stl"
    assert marking.file_name("bowl.stl", marking.MARK) == "bowl_falls_short.stl"
    built = design.build_machine(hooking, ())
    files = {file.name: file for file in design_pages.offers(hooking, (), built)}
    assert mark in files["bowl.png"].alt
    drawn = [file.name for file in files.values() if file.name.endswith(".dxf")]
    assert drawn and all(mark.encode() in bytes(files[name].make()) for name in drawn)
    # the drawing has the condition in words, once
    sheets = bowl_sheet.draw_sheets(built.drawn, trial, mark)
    words = f"{WORDS}: {hooking.condition}".split()
    lines = [text for text in sheets.texts() if set(text.split()) <= set(words) and len(text.split()) > 5]
    assert sorted(" ".join(lines).split()) == sorted(words)
    plain = bowl_sheet.draw_sheets(built.drawn, designs.trial_of(proved(PART, bowls.default())))
    assert not any("separate them" in text for text in plain.texts())
    # what a maker is asked for begins with it, its document has it
    first = machine.summary(built.sheet, trial).rows()[0]
    assert (first["quantity"], first["value"]) == (WORDS, hooking.condition)
    assert json.loads(files["bowl.json"].make())["verified"]["condition"] == hooking.condition
    assert "condition" not in proof.block(designs.trial_of(proved(PART, bowls.default())))
    # what a buyer signs is shown with parts that arrive single
    plans = [row["plan"] for row in designs.acceptance(hooking).rows() if row["plan"]]
    assert plans and all(plan.startswith("parts that arrive single: ") for plan in plans)
    plain = designs.acceptance(proved(PART, bowls.default())).rows()
    assert not any("single" in str(row["plan"]) for row in plain)


def test_the_exit_status_says_so(run, monkeypatch, hooking, tmp_path):
    shapes.box(20, 12, 5).export(tmp_path / "part.stl")
    monkeypatch.setattr(loop, "design", lambda *_, **__: hooking)
    done = run("design", tmp_path / "part.stl", "--target", "30/min")
    assert (done.exit_code, done.stdout.splitlines()[1].split(maxsplit=1)[1]) == (3, WORDS)
    (tmp_path / "list.csv").write_text(f"part,target\n{tmp_path / 'part.stl'},30/min\n")
    assert run("design", tmp_path / "list.csv", "--batch").exit_code == 3
    monkeypatch.setattr(loop, "design", lambda *_, **__: proved(PART, bowls.default()))
    assert run("design", tmp_path / "part.stl", "--target", "30/min").exit_code == 0


def test_the_search_takes_it_for_one_that_holds(hooking):
    alternatives = loop.alternatives([hooking], [], [1])
    assert (alternatives[0].status, alternatives[0].why) == (WORDS, "")
    assert loop.merit(hooking) > loop.merit(proved(PART, bowls.default(), held=3))


def test_an_open_ring_is_found_to_hook_and_a_closed_one_is_not():
    """A ring of 1.5 mm with a mouth of 3 mm: another one comes through it, and few pulls bring it back."""
    turns = np.radians(np.linspace(10.0, 350.0, 15))
    arcs = [np.column_stack([r * np.cos(turns), r * np.sin(turns)]) for r in (8.5, 7.0)]
    outline = np.concatenate([arcs[0], arcs[1][::-1]])
    ring, plate = (shapes.part(body) for body in (shapes.prism(outline, 1.5), shapes.box(12, 8, 1.5)))
    found = {}
    for part in (ring, plate):
        bowl = bowls.default()
        lying = orientations(part, find(part), bowl.track)
        risks = hazards.risks(next(one for one in lying if one.kind == "flat"), bowl, ())
        found[part] = next((risk.hooking for risk in risks if risk.kind is RiskKind.HOOKS), None)
    assert found[plate] is None
    hooking = found[ring]
    assert 0 < hooking.held <= hooking.pulls
    assert hooking.opening == pytest.approx(2.0 * 7e-3 * np.sin(np.radians(10.0)), rel=0.2)
    assert hooking.section == pytest.approx(1.5e-3, rel=0.2)
