"""``feeder tooling`` from the command line, and devices in what ``feeder rate`` prints."""

import json
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
import shapes
from command_lines import BRACKET, names

import feederscrew as fs
from feederscrew.designing import short_trials
from feederscrew.output import tooling as tables
from feederscrew.sorting.isolating import design as designing

WIDE = ("--set", "track.width=200 mm")
ROW = {
    "aspect", "heading_deg", "share", "length_mm", "width_mm", "height_mm", "wall_distance_mm", "balcony_mm",
    "canyon_mm", "gap_mm", "isolated", "devices", "margin_mm", "efficiency", "purity", "left_over",
}  # fmt: skip
CUT = {"device", "value_mm", "margin_pass_mm", "margin_reject_mm", "smallest", "largest", "returns"}
WANTED = ("block.stl", "--aspect", "A", "--heading", "90deg")


@pytest.fixture
def block(tmp_path):
    shapes.box(20, 12, 5).export(tmp_path / "block.stl")


def test_the_chain_of_one_orientation(run_json, block):
    document, static = (run_json("tooling", *WANTED, *more, *WIDE) for more in ((), ("--static",)))
    states = document["orientations"]
    assert document["isolated_static"] is True and document["rule"] == "recommended"
    assert len(states) == 6 and all(set(row) >= ROW for row in states)
    assert sum(row["share"] for row in states) == pytest.approx(1.0, abs=1e-9)
    tried, *others = document["trial"]  # the chain that is proposed, then what its trial denied
    assert document["isolated"] == tried["sorts"] == (document["status"] == "confirmed")
    assert bool(tried["denied"]) != tried["sorts"] and all(other["denied"] for other in others)
    assert {row["isolated"] for row in states} == {document["isolated"], None}
    assert tried["orientation"] == "A@90" and tried["parts"] >= 4
    assert tried["efficiency_static"] == pytest.approx(document["efficiency_static"])
    assert static["trial"] == [] and static["status"] == "static"
    assert {row["aspect"] for row in static["orientations"]} == {row["aspect"] for row in states}
    # a trial may have moved a value of its chain: what is asked for the static rule's has
    for cut, least in [(cut, 0.2) for cut in document["chain"]] + [(cut, 0.25) for cut in static["chain"]]:
        assert set(cut) >= (CUT - {"value_mm"} if cut.keys() & {"outline_mm", "angle_deg"} else CUT)
        margins = [cut[name] for name in ("margin_pass_mm", "margin_reject_mm") if cut[name] is not None]
        assert min(margins, default=1.0) >= least


@pytest.mark.parametrize("where", ["search", "trial"])
@pytest.mark.parametrize("wanted", [WANTED, WANTED[:1]], ids=["one", "all"])
def test_an_interrupt_prints_and_writes_what_is_there(run, block, monkeypatch, tmp_path, where, wanted):
    """It left nothing; what was not tried is not proved, and no drawing is made of it."""
    calls = []

    def stop_at(count, of):
        def work(*arguments, **values):
            calls.append(of)
            if len(calls) == count:
                raise KeyboardInterrupt
            return of(*arguments, **values)

        return work

    owner, name = (designing, "design_with_track") if where == "search" else (short_trials, "try_parts")
    count = 2 if (where, wanted) == ("search", WANTED[:1]) else 1  # of all orientations the first is searched
    monkeypatch.setattr(owner, name, stop_at(count, getattr(owner, name)))
    result = run("tooling", *wanted, *WIDE, "-o", "out")
    assert "not proved: stopped before all was searched and tried" in result.stderr
    folder = tmp_path / "out/block"
    document = json.loads((folder / "tooling.json").read_text())
    statuses = {row["status"] for row in document["orientations"]} - {None}
    assert document["partial"]
    assert statuses <= {"not proved", "none"} and statuses
    own = {"tooling.csv", "tooling.json", "tooling.png", "run.json"}
    assert names(folder) == own | ({"tooling.yaml"} if wanted is WANTED else set())
    assert (folder / "tooling.csv").read_text().count("\n") == 1 + len(document["orientations"])


def test_rate_reads_the_chain(run_json, block, tmp_path):
    feed = ("--launch", "feed")
    document = run_json("tooling", *WANTED, *feed, "--static", *WIDE)
    lines = "".join(f"  - {cut['device']}: {cut['text']}\n" for cut in document["chain"])
    (tmp_path / "tooling.yaml").write_text(f"track: {{width: 200 mm}}\ndevices:\n{lines}")
    own = (*WANTED, "--config", "tooling.yaml")
    rate = run_json("rate", *own, *feed)
    assert rate["answer"].endswith("launch feed") and rate["purity"] == pytest.approx(1.0)
    assert rate["efficiency"] == pytest.approx(document["efficiency"], rel=1e-9)
    assert rate["parts_per_minute"] == pytest.approx(rate["offered_per_minute"] * rate["efficiency"])
    wanted = next(row for row in rate["orientations"] if row["passes"] > 0.5)
    margins = [cut["margin_pass_mm"] for cut in document["chain"] if cut["device"] != "spacing section"]
    assert wanted["margin_mm"] == pytest.approx(min(margins))
    assert all(row["margin_mm"] < 0.0 for row in rate["orientations"] if row["passes"] < 0.5)
    doubtful = run_json("rate", *own, "--play", "1 mm", *feed)
    assert 0.5 < doubtful["passes_devices"] < 1.0 and doubtful["efficiency"] < rate["efficiency"]
    shares = [  # of the floor that feeds: the same by both commands
        {(row["aspect"], round(row["heading_deg"], 3)): row[share] for row in run_json(*call)["orientations"]}
        for call, share in ((("rate", *own), "p_recommended"), (("tooling", *own, "--static"), "share"))
    ]
    for orientation, p in shares[0].items():
        assert p == pytest.approx(shares[1][orientation], abs=1e-12)


def test_orientations_that_hardly_come_are_not_counted():
    good, bad = (SimpleNamespace(isolated=isolated, efficiency=0.3) for isolated in (True, False))
    designs = good, bad, good, good
    shares, isolates = np.array([0.6, 0.395, 0.005, 0.0]), lambda k: designs[k].isolated
    study = SimpleNamespace(shares=shares, designs=designs, isolates=isolates, partial=False)
    said = "orientations in which 0.5 % or more of the parts come can be isolated"
    for least, words in ((), f"2 of 3 {said}"), ((0.5,), f"0 of 3 {said} with an efficiency of 50 % or more"):
        assert tables.isolation_words(study, *least) == f"{words} (1 rarer not counted)"
    study.designs, study.partial = (good, None, None, good), True  # stopped at the second
    assert tables.isolation_words(study) == f"1 of 1 {said} (1 rarer not counted, 2 not searched)"


def test_the_nearest_that_a_cut_returns_is_the_one_its_margin_is_of():
    """A@0 was listed as returned, by 0.098 mm, beside 'others fail by 0.3044'; no word of a trial was said.

    Of the bracket the camera tells A@90 by 3.52 mm; D@270, which the bare track drops, by 2.40.
    """
    limits = fs.ToolingSearch(rule="csa", vary=False)
    part = fs.load(BRACKET)
    study = fs.tooling(part, fs.read_bowl(), "A@270", without="cut-out", cost_class="sensor", search=limits)
    (place,) = [k for k, cut in enumerate(study.design.cuts) if "A@90" in cut.returns]
    loose = [
        replace(cut, margin_reject=1.0) if k == place else cut for k, cut in enumerate(study.design.cuts)
    ]
    designs = [one and replace(one, cuts=tuple(loose)) for one in study.designs]
    shown = replace(study, designs=tuple(designs))
    assert tables.document(shown)["chain"][place]["margin_reject_mm"] == pytest.approx(3.522, abs=1e-3)
    assert "no chain was tried" in tables.remarks(study)[0]
    # of all orientations or of one: its shares are not those that feeder aspects prints of a drop
    for told in (study, replace(study, wanted=None)):
        assert tables.remarks(told)[-1] == "Orientation shares: csa"
