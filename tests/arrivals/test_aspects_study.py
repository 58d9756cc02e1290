"""The study of aspects: one record that commands, batch, report and library share."""

import numpy as np
import pytest
import shapes
from command_lines import CARD, NUT

from feederscrew.arrivals.aspects_study import MAX_DROPS, aspects
from feederscrew.arrivals.drop import drop
from feederscrew.base.errors import FeederError
from feederscrew.output import aspects as aspects_output
from feederscrew.output import offers
from feederscrew.part import load

BOX, OTHER = (shapes.part(shapes.box(10.0, 20.0, height)) for height in (30.0, 31.0))


def test_without_a_drop_test_the_closed_form_is_recommended_for_a_surface_by_name_or_number():
    study = aspects(BOX, surface="soft")
    assert study.tally is None and study.recommended is study.aspects.recommended and not study.doubtful
    np.testing.assert_allclose(study.aspects.chances["surface"], study.aspects.chances["quasistatic"])
    named, number = (aspects(BOX, surface=surface).aspects for surface in ("medium", 1.2))
    assert named.chances["surface"].tolist() == number.chances["surface"].tolist()


@pytest.mark.thorough
def test_a_drop_test_is_the_answer_and_made_once_in_a_run():
    begun = []
    study, again = (aspects(OTHER, before=begun.append, jobs=jobs) for jobs in (1, 2))
    assert begun == [MAX_DROPS] and again.tally is study.tally
    assert study.tally.widest <= 0.016 and study.tally.unsettled == 0
    assert study.recommended.rule == "drop test, launch feed"
    np.testing.assert_array_equal(study.aspects.chances["recommended"], study.tally.p)
    np.testing.assert_array_equal(study.recommended.low, study.tally.low)
    assert aspects(OTHER, drops=0).recommended.rule == "tempered hops, launch feed"


@pytest.mark.thorough
def test_the_answer_is_that_of_a_drop_test_of_another_seed():
    """A nut rolls over its sides without a rolling class: closed forms are 0.09 off."""
    nut = load(NUT)
    study, test = aspects(nut), drop(nut, "feed", drops=4000, seed=11).result.tally
    assert np.abs(study.recommended.p - test.p).max() < 0.03
    assert np.abs(study.aspects.closed.p - test.p).max() > 0.05
    assert (study.recommended.low < test.p).all() and (test.p < study.recommended.high).all()


def test_another_part_or_launch_is_another_answer_and_a_test_that_was_stopped_is_not_kept():
    few = [aspects(OTHER, drops=250), aspects(OTHER, drops=250, launch="place"), aspects(BOX, drops=250)]
    assert len({tuple(study.tally.counts) for study in few}) == 3
    part = shapes.part(shapes.box(10.0, 20.0, 33.0))

    def stop(done, total, widest):
        raise KeyboardInterrupt

    stopped = aspects(part, drops=500, jobs=1, progress=stop)
    assert stopped.aspects.warnings == (f"partial: stopped after {stopped.tally.counts.sum()} drops",)
    assert aspects(part, drops=500, jobs=1).tally.counts.sum() == 500


def test_a_card_offers_no_view_and_has_no_graph():
    study = aspects(load(CARD))
    assert "aspects.png" not in offers.by_name(aspects_output.offers(study))
    assert aspects_output.remarks(study) == ["a part card has no shape to draw: no aspects.png"]
    with pytest.raises(FeederError, match="has no shape to tumble"):
        study.transitions
