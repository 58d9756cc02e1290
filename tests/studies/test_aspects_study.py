"""The study of aspects: one record that commands, batch, report and library share."""

import numpy as np
import pytest
import shapes

import feederscrew as fs
from feederscrew.errors import FeederError
from feederscrew.output import aspects as aspects_output
from feederscrew.output import compare as compare_output
from feederscrew.output import offers
from feederscrew.output import plate as plate_output
from feederscrew.part import load
from feederscrew.studies.aspects import MAX_DROPS, aspects
from feederscrew.studies.compare import calibrate, compare
from feederscrew.studies.drop import drop, shake

CARD = "parts/arc_chute.yaml"


def test_without_a_drop_test_the_closed_form_is_recommended():
    study = aspects(shapes.part(shapes.box(10.0, 20.0, 30.0)), surface="soft")
    assert study.tally is None
    assert study.recommended is study.aspects.recommended
    np.testing.assert_allclose(study.aspects.chances["surface"], study.aspects.chances["quasistatic"])
    assert not study.doubtful


@pytest.mark.thorough
def test_a_drop_test_is_the_answer_and_made_once_in_a_run():
    begun = []
    part = shapes.part(shapes.box(10.0, 20.0, 31.0))
    study, again = (aspects(part, before=begun.append, jobs=jobs) for jobs in (1, 2))
    assert begun == [MAX_DROPS] and again.tally is study.tally
    assert study.tally.widest <= 0.016 and study.tally.unsettled == 0
    assert study.recommended.rule == "drop test, launch feed"
    np.testing.assert_array_equal(study.aspects.chances["recommended"], study.tally.p)
    np.testing.assert_array_equal(study.recommended.low, study.tally.low)
    assert aspects(part, drops=0).recommended.rule == "tempered hops, launch feed"


@pytest.mark.thorough
def test_the_answer_is_that_of_a_drop_test_of_another_seed():
    """A nut rolls over its sides without a rolling class: closed forms are 0.09 off."""
    part = load("parts/squarenut_m5.stl")
    study = aspects(part)
    test = drop(part, "feed", drops=4000, seed=11).result.tally
    assert np.abs(study.recommended.p - test.p).max() < 0.03
    assert np.abs(study.aspects.closed.p - test.p).max() > 0.05
    assert (study.recommended.low < test.p).all() and (test.p < study.recommended.high).all()


def test_another_part_or_launch_is_another_answer():
    part = shapes.part(shapes.box(10.0, 20.0, 31.0))
    few = [aspects(part, drops=250), aspects(part, drops=250, launch="place")]
    few += [aspects(shapes.part(shapes.box(10.0, 20.0, 32.0)), drops=250)]
    assert len({tuple(study.tally.counts) for study in few}) == 3


def test_a_test_that_was_stopped_is_not_kept():
    part = shapes.part(shapes.box(10.0, 20.0, 33.0))

    def stop(done, total, widest):
        raise KeyboardInterrupt

    stopped = aspects(part, drops=500, jobs=1, progress=stop)
    assert stopped.aspects.warnings == (f"partial: stopped after {stopped.tally.counts.sum()} drops",)
    assert aspects(part, drops=500, jobs=1).tally.counts.sum() == 500


def test_a_surface_may_be_named_or_a_number():
    part = shapes.part(shapes.box(10.0, 20.0, 30.0))
    named, number = (aspects(part, surface=surface).aspects for surface in ("medium", 1.2))
    assert named.chances["surface"].tolist() == number.chances["surface"].tolist()


def test_a_card_offers_no_view_and_has_no_graph():
    study = aspects(load(CARD))
    assert "aspects.png" not in offers.by_name(aspects_output.offers(study))
    assert aspects_output.remarks(study) == ["a part card has no shape to draw: no aspects.png"]
    with pytest.raises(FeederError, match="has no shape to tumble"):
        study.transitions


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
    assert [offer.name for offer in compare_output.calibration_offers(study)] == [
        "calibrate.csv",
        "calibrate.json",
    ]
