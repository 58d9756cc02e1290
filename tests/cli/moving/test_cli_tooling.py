"""``feeder tooling`` from the command line, and devices in what ``feeder rate`` prints."""

import json
from types import SimpleNamespace

import numpy as np
import pytest
import shapes

WIDE = ("--set", "track.width=200 mm")
ROW = {
    "aspect", "heading_deg", "share", "length_mm", "width_mm", "height_mm", "wall_distance_mm", "balcony_mm",
    "canyon_mm", "gap_mm", "isolated", "devices", "margin_mm", "efficiency", "purity", "left_over",
}  # fmt: skip
CUT = {"device", "value_mm", "margin_pass_mm", "margin_reject_mm", "smallest", "largest", "returns"}


@pytest.fixture
def block(tmp_path):
    shapes.box(20, 12, 5).export(tmp_path / "block.stl")
    return "block.stl"


def told(run, *arguments):
    result = run(*arguments, "--format", "json")
    assert result.exit_code == 0, result.output
    return json.loads(result.stdout)


def test_the_chain_of_one_orientation(run, block):
    document = told(run, "tooling", block, "--aspect", "A", "--heading", "90deg", *WIDE)
    assert document["isolated_static"] is True
    assert document["rule"] == "recommended"
    assert len(document["orientations"]) == 6
    assert all(set(row) >= ROW for row in document["orientations"])
    assert sum(row["share"] for row in document["orientations"]) == pytest.approx(1.0, abs=1e-9)
    tried, *others = document["trial"]  # the chain that is proposed, then what its trial denied
    assert document["isolated"] == tried["sorts"] == (document["status"] == "confirmed")
    assert bool(tried["denied"]) != tried["sorts"] and all(other["denied"] for other in others)
    assert {row["isolated"] for row in document["orientations"]} == {document["isolated"], None}
    assert tried["orientation"] == "A@90" and tried["parts"] >= 4
    assert tried["efficiency_static"] == pytest.approx(document["efficiency_static"])
    alone = told(run, "tooling", block, "--aspect", "A", "--heading", "90deg", "--static", *WIDE)
    assert alone["trial"] == [] and alone["status"] == "static"
    assert {row["aspect"] for row in alone["orientations"]} == {
        row["aspect"] for row in document["orientations"]
    }
    for cut in (*document["chain"], *alone["chain"]):
        assert set(cut) >= (CUT - {"value_mm"} if cut.keys() & {"outline_mm", "angle_deg"} else CUT)
        margins = [cut[name] for name in ("margin_pass_mm", "margin_reject_mm") if cut[name] is not None]
        assert min(margins, default=1.0) >= 0.25


def test_rate_reads_the_chain(run, block, tmp_path):
    document = told(
        run, "tooling", block, "--aspect", "A", "--heading", "90deg", "--launch", "feed", "--static", *WIDE
    )
    lines = "".join(f"  - {cut['device']}: {cut['text']}\n" for cut in document["chain"])
    (tmp_path / "tooling.yaml").write_text(f"track: {{width: 200 mm}}\ndevices:\n{lines}")
    wanted = ("--aspect", "A", "--heading", "90deg", "--config", "tooling.yaml")
    made = told(run, "rate", block, *wanted, "--launch", "feed")
    assert made["answer"].endswith("launch feed")
    own = [told(run, *call) for call in (("rate", block, *wanted), ("tooling", block, *wanted))]
    chances = [
        {(one["aspect"], round(one["heading_deg"], 3)): one for one in each["orientations"]} for each in own
    ]
    for way, one in chances[0].items():
        assert one["p_recommended"] == pytest.approx(chances[1][way]["share"], abs=1e-12)
    assert made["purity"] == pytest.approx(1.0)
    assert made["efficiency"] == pytest.approx(document["efficiency"], rel=1e-9)
    assert made["parts_per_minute"] == pytest.approx(made["offered_per_minute"] * made["efficiency"])
    wanted = next(row for row in made["orientations"] if row["passes"] > 0.5)
    margins = [cut["margin_pass_mm"] for cut in document["chain"] if cut["device"] != "separation"]
    assert wanted["margin_mm"] == pytest.approx(min(margins))
    assert all(row["margin_mm"] < 0.0 for row in made["orientations"] if row["passes"] < 0.5)
    wanted = ("--aspect", "A", "--heading", "90deg", "--config", "tooling.yaml")
    doubtful = told(run, "rate", block, *wanted, "--play", "1 mm", "--launch", "feed")
    assert 0.5 < doubtful["passes_devices"] < 1.0
    assert doubtful["efficiency"] < made["efficiency"]


def test_orientations_that_hardly_come_are_not_counted():
    from feederscrew.output import tooling as tables

    good, bad = (SimpleNamespace(isolated=isolated, efficiency=0.3) for isolated in (True, False))
    designs = good, bad, good, good
    study = SimpleNamespace(
        shares=np.array([0.6, 0.395, 0.005, 0.0]), designs=designs, isolates=lambda k: designs[k].isolated
    )
    said = "orientations in which 0.5 % or more of the parts come can be isolated"
    assert tables.isolation_words(study) == f"2 of 3 {said} (1 rarer not counted)"
    assert (
        tables.isolation_words(study, 0.5)
        == f"0 of 3 {said} with an efficiency of 50 % or more (1 rarer not counted)"
    )
