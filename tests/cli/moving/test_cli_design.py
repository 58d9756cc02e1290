"""``feeder design`` from the command line, and what other commands make of its bowl file."""

import csv
import functools
import json
import re
from pathlib import Path

import pytest
import shapes

from feederscrew import bowl as bowls
from feederscrew.designing import queues
from feederscrew.output import report
from feederscrew.output.report import CHAPTERS

FIELDS = {
    "status", "wanted", "outcome", "target_per_minute", "delivered_per_minute", "delivered_low",
    "delivered_high", "purity", "purity_low", "jams", "jams_per_hour_high", "queue_seconds", "robust",
    "chain", "why", "trial_parts", "bowl", "warnings",
}  # fmt: skip


def designed_block(folder, size, *more):
    """The document of a block's design, with short queues."""
    from click.testing import CliRunner

    from feederscrew_cli.main import feeder

    shapes.box(*size).export(folder / "cube.stl")
    patch = pytest.MonkeyPatch()
    patch.setattr(queues, "TOUCHING_PARTS", 4)
    patch.setattr(queues, "FILL_SECONDS", 2.0)
    patch.setattr(queues, "FILLS", queues.FILLS[1:])
    line = ["design", folder / "cube.stl", "--target", "40/min", "--draws", "2", "--jobs", "1", *more]
    try:
        done = CliRunner().invoke(feeder, [*map(str, line), "--format", "json", "--no-pictures"])
    finally:
        patch.undo()
    assert done.exit_code == 0, done.output
    return json.loads(done.stdout)


@pytest.fixture(scope="module")
def designed(tmp_path_factory):
    """The design of a cube: its document and its folder."""
    folder = tmp_path_factory.mktemp("design")
    return designed_block(folder, (10, 10, 10), "-o", folder), folder / "cube"


def test_a_block_that_may_lie_along_or_across_needs_no_sensor(tmp_path):
    document = designed_block(tmp_path, (14, 10, 2), "--up", "a")
    assert (document["status"], document["up"]) == ("holds", ["a"])
    assert "sorter" not in str(document["chain"])
    assert document["wanted"].startswith("A@") and "or" not in document["wanted"]
    assert document["purity"] == 1.0


def test_a_cube_needs_no_device_and_the_contract_is_kept(designed):
    document, _ = designed
    assert set(document) >= FIELDS
    assert (document["status"], document["chain"], document["why"]) == ("holds", [], "")
    assert document["wanted"] == "A@0" and document["delivered_low"] >= 0.9 * 40.0
    assert document["robust"]["draws"] == document["robust"]["held"] == 2
    assert document["jams"] == 0 and document["purity"] == 1.0
    assert document["delivered_low"] <= document["delivered_per_minute"] <= document["delivered_high"]
    assert document["jams_per_hour_high"] == pytest.approx(3.0 * 3600.0 / document["queue_seconds"])


def test_the_bowl_file_reads_back_as_what_was_tried(designed):
    document, folder = designed
    bowl, tried = bowls.read(folder / "design.yaml"), bowls.verified(folder / "design.yaml")
    assert 2e3 * bowl.drive.amplitude == pytest.approx(document["bowl"]["peak_to_peak_mm"], rel=1e-9)
    assert 2e3 * bowl.track.radius == pytest.approx(document["bowl"]["diameter_mm"], rel=1e-9)
    assert 60.0 * tried.delivered == pytest.approx(document["delivered_per_minute"], rel=1e-3)
    assert f"of {document['wanted']}, purity" in tried.sentence
    page = (folder / "design.html").read_text()
    assert document["status"] in page and 'id="trial"' in page and "trial-views" in page
    assert (folder / "acceptance.csv").read_text().startswith("quantity,fill,computed,low,high,unit,measured")


def test_rate_leads_with_the_lower_of_trial_and_rule_until_something_changes(designed, run):
    document, folder = designed
    line = ("rate", folder.parent / "cube.stl", "--config", folder / "design.yaml", "--format", "json")
    told = run(*line)
    rate = json.loads(told.stdout)
    own, tried = rate["parts_per_minute_static"], rate["verified"]["parts_per_minute"]
    assert rate["parts_per_minute"] == min(own, tried)
    assert tried == pytest.approx(document["delivered_per_minute"], rel=1e-3)
    assert "its trial delivers" in told.stderr
    changed = run(*line, "--set", "friction.static=0.4")
    assert json.loads(changed.stdout)["verified"] is None
    assert "void: the bowl has been changed since it was tried - run feeder design again" in changed.stderr
    text = (folder / "design.yaml").read_text().replace('version: "', 'version: "9')
    Path("other.yaml").write_text(text)
    other = run("rate", folder.parent / "cube.stl", "--config", "other.yaml")
    assert "void: version 9" in other.stderr


def test_the_bowl_is_there_as_a_solid_that_turns_on_the_page(designed):
    document, folder = designed
    solid, machine = (json.loads((folder / name).read_text()) for name in ("bowl_solid.json", "bowl.json"))
    assert solid["diameter_mm"] == pytest.approx(document["bowl"]["diameter_mm"])
    assert machine["bowl_mass_kg"] == pytest.approx(solid["solid_mass_kg"], rel=1e-5)
    assert (folder / "bowl.pdf").read_bytes()[:5] == b"%PDF-"
    assert (folder / "bowl.stl").stat().st_size == 84 + 50 * solid["solid_facets"]
    assert 'data-views="solid-bowl"' in (folder / "design.html").read_text()


def test_the_acceptance_sheet_is_read_back_filled_in(designed, run):
    _, folder = designed
    rows = (folder / "acceptance.csv").read_text().splitlines()
    none = run("compare", folder / "acceptance.csv")
    assert none.exit_code == 1 and "nothing was measured - fill in the column 'measured'" in none.stderr

    def filled(word, value, sample=""):
        found = [row.rsplit(",", 2)[0] + f",{value},{sample}" if word in row else row for row in rows]
        Path("filled.csv").write_text("\n".join(found) + "\n")
        done = run("compare", "filled.csv", "--format", "json")
        assert done.exit_code == 0, done.stderr
        return json.loads(done.stdout)

    assert filled("frequency of the drive", "50")["accepted"]
    assert not filled("frequency of the drive", "100")["accepted"]
    assert filled("good parts at the discharge", "1000")["accepted"]
    assert not filled("good parts at the discharge", "1")["accepted"]
    assert filled("yield", "99", "50")["accepted"] and not filled("yield", "80", "50")["accepted"]
    Path("odd.csv").write_text("\n".join([rows[0], rows[1].rsplit(",", 2)[0] + ",many,"]) + "\n")
    odd = run("compare", "odd.csv")
    assert "measured: 'many' is not a number - write a number alone" in odd.stderr


def test_a_trial_that_counted_several_aspects_as_one_leads_though_the_rule_says_less(designed, run):
    _, folder = designed
    text = (folder / "design.yaml").read_text()
    for word, rate in (("delivered", 900), ("delivered_low", 800), ("delivered_high", 1000)):
        text = re.sub(rf"  {word}: .*", f"  {word}: {rate}/min", text)
    part = folder.parent / "cube.stl"
    for up, told in (("", None), ('  up: "A, B"\n', 900.0)):
        Path("up.yaml").write_text(text.replace("  target:", f"{up}  target:"))
        lines = ("rate", part), ("bowl", part, "--target", "40/min")
        for line in lines:
            found = json.loads(run(*line, "--config", "up.yaml", "--format", "json").stdout)
            own = found["parts_per_minute_static"]
            assert own < 800.0 and found["parts_per_minute"] == pytest.approx(told or own)


def test_report_bowl_and_batch_lead_with_a_trial_that_delivers_less(designed, run, monkeypatch):
    _, folder = designed
    wanted = [chapter for chapter in CHAPTERS if chapter[0] in ("rate", "bowl")]
    monkeypatch.setattr(report, "page", functools.partial(report.page, chapters=wanted))
    text = (folder / "design.yaml").read_text()
    for word, rate in (("target", 4), ("delivered", 5), ("delivered_low", 4), ("delivered_high", 6)):
        text = re.sub(rf"  {word}: .*", f"  {word}: {rate}/min", text)
    Path("slow.yaml").write_text(text)
    part, own = folder.parent / "cube.stl", ("--config", "slow.yaml")
    run("report", part, *own, "--format", "md", "-o", "paper")
    page = next(Path("paper").rglob("report.md")).read_text()
    assert "5.00 a minute" in page and "as its trial showed; the rule says" in page
    assert "its trial delivers 5/min (4 to 6)" in page
    line = ("bowl", part, "--target", "40/min", "--format", "json", "--config")
    sized, rule = (json.loads(run(*line, path).stdout) for path in ("slow.yaml", folder / "design.yaml"))
    assert sized["parts_per_minute"] == pytest.approx(5.0)
    assert sized["parts_per_minute_static"] == rule["parts_per_minute_static"] > 5.0
    shown = run("bowl", part, "--target", "40/min", *own).stdout
    assert "rate as its trial showed [1/min]" in shown and "5 (4, 6): holds" in shown
    tuned = json.loads(
        run("tune", part, "--aspect", "A", "--target", "20/min", *own, "--format", "json").stdout
    )
    assert tuned["verified"]["parts_per_minute"] == pytest.approx(5.0) and "parts_per_minute" not in tuned
    run("batch", part, *own, "--no-pictures", "-o", "many")
    (row,) = csv.DictReader(Path("many/summary.csv").read_text().splitlines())
    assert (
        float(row["parts_per_minute"]) == pytest.approx(5.0) and "its trial delivers 5/min" in row["warnings"]
    )
