"""``feeder design`` from the command line, and what other commands make of its bowl file."""

import csv
import functools
import io
import json
import re
from pathlib import Path

import pytest
import shapes

from feederscrew import bowl as bowls
from feederscrew.designing import design, queues
from feederscrew.output import report
from feederscrew.output.report import CHAPTERS
from feederscrew_cli import progress

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


@pytest.fixture
def cubes(tmp_path, monkeypatch):
    """Two cubes of other sizes, queues that are soon over, and no solid."""
    monkeypatch.setattr(design, "built", lambda study, settings: design.Built())
    monkeypatch.setattr(queues, "TOUCHING_PARTS", 4)
    monkeypatch.setattr(queues, "FILL_SECONDS", 2.0)
    monkeypatch.setattr(queues, "FILLS", queues.FILLS[1:])
    found = [tmp_path / "small.stl", tmp_path / "large.stl"]
    for path, size in zip(found, (9, 11), strict=True):
        shapes.box(size, size, size).export(path)
    return found


def test_two_cubes_run_in_one_bowl(run, cubes, tmp_path):
    few = ("--draws", "1", "--jobs", "1", "--no-pictures", "--format", "json")
    done = run("design", *cubes, "--target", "40/min", *few, "-o", "results")
    assert done.exit_code == 0, done.output
    document = json.loads(done.stdout)
    assert (document["status"], document["shared"]) == ("holds", True)
    assert [one["part"] for one in document["parts"]] == ["small", "large"]
    assert all(row["how"] == "set" for row in document["changeover"])  # the drive, if anything
    bowls = [one["bowl"] for one in document["parts"]]
    assert len({(one["diameter_mm"], one["track_width_mm"], one["bank_deg"]) for one in bowls}) == 1
    first, *rows = (tmp_path / "results/family/changeover.csv").read_text().splitlines()
    assert first == "what,how,small,large" and len(rows) == len(document["changeover"])
    page = (tmp_path / "results/family/family.html").read_text()
    assert "one bowl for several parts: holds" in page and "changeover.csv" in page
    assert all(f"{one}/design.html" in page for one in ("small", "large"))
    for name in ("small", "large"):
        assert (tmp_path / "results" / name / "design.yaml").read_text().startswith("# holds: ")


@pytest.mark.parametrize(
    ("more", "line"),
    [
        (("--aspect", "A"), "--aspect is of one part - design that one alone (see feeder design --help)"),
        (("--up", "A,B"), "--up is of one part - design that one alone (see feeder design --help)"),
        (("--heading", "90"), "--heading is of one part - design that one alone (see feeder design --help)"),
    ],
)
def test_what_is_of_one_part_is_refused_of_several(run, cubes, more, line):
    done = run("design", *cubes, "--target", "40/min", *more)
    assert (done.exit_code, done.stdout, done.stderr) == (2, "", f"Error: {line}\n")


class Terminal(io.StringIO):
    def isatty(self):
        return True


@pytest.fixture
def now(monkeypatch):
    """A clock that is set by hand."""
    clock = [0.0]
    monkeypatch.setattr(progress.time, "monotonic", lambda: clock[0])
    return clock


def test_a_bar_of_the_stage_and_the_time_to_go(monkeypatch, now):
    screen = Terminal()
    monkeypatch.setattr(progress.sys, "stderr", screen)
    shown = progress.StageBar()
    shown.reach("draws", 5, 20, 30.0, 90.0)
    bar = screen.getvalue()
    assert "draws: 5 of 20" in bar and "30 s gone, about 90 s to go" in bar and "\n" not in bar
    assert bar.count("#") == round(progress.StageBar.WIDTH / 4)
    shown.clear()
    assert screen.getvalue().endswith("\r\033[K")
    before = screen.getvalue()
    shown.clear()
    assert screen.getvalue() == before
