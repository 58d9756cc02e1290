"""The studies of drops, plates, comparisons and calibrations: their records and what they offer."""

import numpy as np
import pytest
import shapes

import feederscrew as fs
from feederscrew.output import compare as compare_output
from feederscrew.output import drop as drop_output
from feederscrew.output import offers
from feederscrew.output import plate as plate_output
from feederscrew.studies.aspects import aspects
from feederscrew.studies.calibrate import calibrate
from feederscrew.studies.compare import compare
from feederscrew.studies.drop import drop
from feederscrew.studies.plate import shake

OWN = {"fall": "5 mm"}


@pytest.fixture(scope="module")
def box():
    return shapes.part(shapes.box(10.0, 20.0, 30.0))


@pytest.fixture(scope="module")
def counts(tmp_path_factory):
    path = tmp_path_factory.mktemp("counts") / "counts.csv"
    path.write_text("aspect,tray\nA,70\nB,20\nC,10\n")
    return path


def test_the_library_returns_what_the_study_counts(box):
    study = drop(box, "drop", **OWN, drops=40, seed=4)
    again = fs.drop(box, launch="drop", drops=40, seed=4, **OWN)
    assert again.tally.counts.tolist() == study.result.tally.counts.tolist()
    assert study.drops == 40
    assert list(study.rules) == ["csa", "surface"]


def test_traces_are_offered_where_there_are_some(box):
    plain, followed = (drop(box, "drop", drops=20, traced=k) for k in (0, 2))
    assert sorted(offers.by_name(drop_output.offers(plain))) == ["drop.csv", "drop.json", "drop.png"]
    assert "drop_traces.csv" in offers.by_name(drop_output.offers(followed))
    assert followed.telling in followed.result.traces


def test_a_drop_test_becomes_the_recommended_answer(box):
    study = aspects(box, drops=60)
    assert study.recommended.rule == "drop test, launch feed"
    np.testing.assert_array_equal(study.recommended.p, study.tally.p)


def test_a_plate_offers_its_tables_and_counts_what_it_saw(box):
    study = shake(box, [fs.read_bowl()], "place", drops=6, seconds=0.1)
    (only,) = study.plates
    assert study.names == ("bowl",) and not study.partial
    assert only.transitions == only.occupancy.counts.sum() - np.trace(only.occupancy.counts)
    assert 0 <= only.unsettled <= 6
    assert [offer.name for offer in plate_output.offers(study)] == [
        "plate.csv", "plate_rates.csv", "plate_time.csv", "plate_drives.csv", "plate.json", "plate.png",
    ]  # fmt: skip


def test_a_comparison_holds_every_pair_and_offers_one_picture(box, counts):
    study = compare(box, counts)
    profiles = [profile.name for profile in study.profiles]
    assert profiles[0] == "tray" and len(profiles) == 1 + len(study.rules)
    assert len(study.comparisons) == len(profiles) * (len(profiles) - 1) // 2
    assert [offer.name for offer in compare_output.offers(study)] == ["compare.csv", "compare.png"]


def test_a_calibration_has_a_fit_for_every_column(box, counts):
    study = calibrate(box, counts)
    assert [fit.name for fit in study.fits] == ["tray"]
    assert [offer.name for offer in compare_output.calibration_offers(study)] == [
        "calibrate.csv",
        "calibrate.json",
    ]
