"""The studies of drops, plates, comparisons and calibrations: their records and what they offer."""

import numpy as np
import pytest
import shapes

import feederscrew as fs
from feederscrew.output import calibrate as calibrate_output
from feederscrew.output import compare as compare_output
from feederscrew.output import plate as plate_output
from feederscrew.studies.compare import calibrate, compare
from feederscrew.studies.drop import shake


@pytest.fixture(scope="module")
def box():
    return shapes.part(shapes.box(10.0, 20.0, 30.0))


@pytest.fixture(scope="module")
def counts(tmp_path_factory):
    path = tmp_path_factory.mktemp("counts") / "counts.csv"
    path.write_text("aspect,tray\nA,70\nB,20\nC,10\n")
    return path


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
    assert [offer.name for offer in calibrate_output.offers(study)] == ["calibrate.csv", "calibrate.json"]
