"""``feeder design`` from the command line, and what other commands make of its bowl file."""

import csv
import functools
import json
import re
from importlib import import_module
from pathlib import Path

import pytest
import shapes
from command_lines import called, rows

from feederscrew import bowl as bowls
from feederscrew.designing import design, fill_verdicts, loop
from feederscrew.output import report_page as report
from feederscrew.output.report_page import CHAPTERS
from feederscrew.trials import fills

FIELDS = {
    "status", "wanted", "outcome", "target_per_minute", "delivered_per_minute", "delivered_low",
    "delivered_high", "purity", "purity_low", "jams", "jams_per_hour_high", "queue_seconds", "robust",
    "chain", "why", "trial_parts", "bowl", "warnings",
}  # fmt: skip
TARGET = ("--target", "40/min")


@pytest.fixture(scope="module", autouse=True)
def short_queues():
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(fills, "TOUCHING_PARTS", 4)
        patch.setattr(loop, "longest_time", lambda target: 8.0)
        patch.setattr(fill_verdicts, "FIRST_LOOK_S", 2.0)
        for module in (fill_verdicts, import_module("feederscrew.bowl.verified")):
            patch.setattr(module, "SHOWN_PURITY", 1e-3)  # which the parts of two seconds do not show
        yield


def design_of(folder, sizes, *more):
    """The document of the design of boxes, whose files lie in a folder."""
    paths = [folder / f"block_{k}.stl" for k in range(len(sizes))]
    for path, size in zip(paths, sizes, strict=True):
        shapes.box(*size).export(path)
    own = ("--jobs", "1", "--no-pictures", "--format", "json")
    return json.loads(called("design", *paths, *TARGET, *more, *own).stdout)


@pytest.fixture(scope="module")
def designed(tmp_path_factory):
    """The design of a cube: its document, its folder, and the part and bowl file that it wrote."""
    folder = tmp_path_factory.mktemp("design")
    document = design_of(folder, [(10, 10, 10)], "--draws", "2", "-o", folder)
    return document, folder / "block_0", (folder / "block_0.stl", "--config", folder / "block_0/design.yaml")


def rewritten(folder, to, **values):
    """The bowl file of a design with other figures of its trial."""
    text = (folder / "design.yaml").read_text()
    for word, rate in values.items():
        text = re.sub(rf"  {word}: .*", f"  {word}: {rate}/min", text)
    Path(to).write_text(text)
    return text


def test_a_block_that_may_lie_along_or_across_needs_no_sensor(tmp_path):
    document = design_of(tmp_path, [(14, 10, 2)], "--up", "a", "--draws", "2")
    assert (document["status"], document["up"], document["purity"]) == ("holds", ["a"], 1.0)
    assert "vision reject" not in str(document["chain"])


def test_a_cube_needs_no_device_and_its_files_say_what_was_tried(designed):
    document, folder, _ = designed
    bowl = document["bowl"]
    assert set(document) >= FIELDS
    assert (document["status"], document["chain"], document["why"]) == ("holds", [], "")
    assert (document["wanted"], document["jams"], document["purity"]) == ("A@0", 0, 1.0)
    assert document["robust"]["draws"] == document["robust"]["held"] == 2
    assert 36.0 <= document["delivered_low"] <= document["delivered_per_minute"] <= document["delivered_high"]
    shortest = min(fill["seconds"] for fill in document["queues"])
    assert document["jams_per_hour_high"] == pytest.approx(3.0 * 3600.0 / shortest, rel=2e-3)
    read, tried = bowls.read(folder / "design.yaml"), bowls.verified(folder / "design.yaml")
    assert 2e3 * read.drive.amplitude == pytest.approx(bowl["peak_to_peak_mm"], rel=1e-9)
    assert 2e3 * read.track.radius == pytest.approx(bowl["diameter_mm"], rel=1e-9)
    assert 60.0 * tried.delivered == pytest.approx(document["delivered_per_minute"], rel=1e-3)
    assert f"of {document['wanted']}, purity" in tried.sentence
    page = (folder / "design.html").read_text()
    assert document["status"] in page and 'id="trial"' in page and "trial-views" in page
    assert 'data-views="solid-bowl"' in page
    solid, machine = (json.loads((folder / name).read_text()) for name in ("bowl_solid.json", "bowl.json"))
    assert solid["diameter_mm"] == pytest.approx(bowl["diameter_mm"])
    assert machine["bowl_mass_kg"] == pytest.approx(solid["solid_mass_kg"], rel=1e-5)
    assert (folder / "bowl.pdf").read_bytes()[:5] == b"%PDF-"
    assert (folder / "bowl.stl").stat().st_size == 84 + 50 * solid["solid_facets"]


def test_rate_leads_with_the_lower_of_trial_and_rule_until_something_changes(designed, run):
    document, folder, own = designed
    done = run("rate", *own, "--format", "json")
    rate = json.loads(done.stdout)
    tried = rate["verified"]["parts_per_minute"]
    assert rate["parts_per_minute"] == min(rate["parts_per_minute_static"], tried)
    assert tried == pytest.approx(document["delivered_per_minute"], rel=1e-3)
    assert "its trial delivers" in done.stderr
    changed = run("rate", *own, "--set", "friction.static=0.4", "--format", "json")
    assert json.loads(changed.stdout)["verified"] is None
    assert "void: the bowl has been changed since it was tried - run feeder design again" in changed.stderr
    Path("other.yaml").write_text(rewritten(folder, "same.yaml").replace('version: "', 'version: "9'))
    assert "void: version 9" in run("rate", own[0], "--config", "other.yaml").stderr


def test_the_acceptance_sheet_is_read_back_filled_in(designed, run, run_json):
    sheet = designed[1] / "acceptance.csv"
    table = rows(sheet)
    demands = {(row["low"], row["high"], row["sample"]) for row in table if row["fill"]}
    assert demands == {("40", "", "600"), ("98", "", "149"), ("", "1", "10800")}
    empty = run("compare", sheet)
    assert empty.exit_code == 1 and "nothing was measured - fill in the column 'measured'" in empty.stderr
    for word, value, sample, verdict in (
        *(("frequency of the drive", "50", "", "agrees"), ("frequency of the drive", "100", "", "does not")),
        *(("good parts", "1000", "", "agrees"), ("good parts", "39.9", "", "does not")),
        *(("yield", "100", "149", "agrees"), ("yield", "97", "100", "does not")),
        *(
            ("jams", "0", "10800", "agrees"),
            ("jams", "0", "60", "not shown"),
            ("jams", "400", "60", "does not"),
        ),
    ):
        with Path("filled.csv").open("w", newline="") as file:
            filled = csv.DictWriter(file, table[0])
            filled.writeheader()
            for row in table:
                own = {"measured": value, "sample": sample} if row["quantity"].startswith(word) else {}
                filled.writerow(row | own)
        answer = run_json("compare", "filled.csv")
        verdicts = {line["verdict"] for line in answer["lines"] if line["quantity"].startswith(word)}
        assert (verdicts, answer["accepted"]) == ({verdict}, verdict == "agrees"), (word, value)
        printed = run("compare", "filled.csv").stdout
        assert all(verdict in line for line in printed.splitlines() if line.startswith(word)), printed


def test_a_trial_that_counted_several_aspects_as_one_leads_though_the_rule_says_less(designed, run_json):
    _, folder, own = designed
    text = rewritten(folder, "up.yaml", delivered=900, delivered_low=800, delivered_high=1000)
    for up, tried in (("", None), ('  up: "A, B"\n', 900.0)):
        Path("up.yaml").write_text(text.replace("  target:", f"{up}  target:"))
        for line in (("rate", own[0]), ("bowl", own[0], *TARGET)):
            answer = run_json(*line, "--config", "up.yaml")
            rule = answer["parts_per_minute_static"]
            assert rule < 800.0 and answer["parts_per_minute"] == pytest.approx(tried or rule)


def test_report_bowl_and_batch_lead_with_a_trial_that_delivers_less(designed, run, run_json, monkeypatch):
    _, folder, (part, *with_design) = designed
    chapters = [chapter for chapter in CHAPTERS if chapter[0] in ("rate", "bowl")]
    monkeypatch.setattr(report, "page", functools.partial(report.page, chapters=chapters))
    rewritten(folder, "slow.yaml", target=4, delivered=5, delivered_low=4, delivered_high=6)
    own = ("--config", "slow.yaml")
    done = run("report", part, *own, "--format", "md", "-o", "paper")
    assert done.stderr.count("its trial delivers 5/min") == 1, "it was said twice"
    page = next(Path("paper").rglob("report.md")).read_text()
    assert "5.00 a minute" in page and "as its trial showed; the rule says" in page
    assert "its trial delivers 5/min (4 to 6)" in page
    sized, rule = (run_json("bowl", part, *TARGET, *bowl) for bowl in (own, with_design))
    assert sized["parts_per_minute"] == pytest.approx(5.0)
    assert sized["parts_per_minute_static"] == rule["parts_per_minute_static"] > 5.0
    shown = run("bowl", part, *TARGET, *own).stdout
    assert "rate as its trial showed [1/min]" in shown and "5 (4, 6): holds" in shown
    tuned = run_json("tune", part, "--aspect", "A", "--target", "20/min", *own)
    assert tuned["verified"]["parts_per_minute"] == pytest.approx(5.0) and "parts_per_minute" not in tuned
    run("batch", part, *own, "--no-pictures", "-o", "many")
    (row,) = rows(Path("many/summary.csv"))
    assert float(row["parts_per_minute"]) == pytest.approx(5.0)
    assert "its trial delivers 5/min" in row["warnings"]


def test_two_cubes_run_in_one_bowl(tmp_path, monkeypatch):
    monkeypatch.setattr(design, "build_machine", lambda study, settings: design.Built())  # no solid
    document = design_of(tmp_path, [(9, 9, 9), (11, 11, 11)], "--draws", "1", "-o", tmp_path)
    assert (document["status"], document["shared"]) == ("holds", True)
    parts, changes = document["parts"], document["changeover"]
    assert [member["part"] for member in parts] == ["block_0", "block_1"]
    assert all(row["how"] == "set" for row in changes)  # the drive, if anything
    shared = ("diameter_mm", "track_width_mm", "bank_deg")
    assert len({tuple(member["bowl"][name] for name in shared) for member in parts}) == 1
    head, *lines = (tmp_path / "family/changeover.csv").read_text().splitlines()
    assert head == "what,how,block_0,block_1" and len(lines) == len(changes)
    page = (tmp_path / "family/family.html").read_text()
    assert "one bowl for several parts: holds" in page
    assert ("changeover.csv" in page) == bool(changes)  # where one drive serves both, nothing is changed
    for name in ("block_0", "block_1"):
        written = (tmp_path / name / "design.yaml").read_text()
        assert f"{name}/design.html" in page and written.startswith("# holds: ")
