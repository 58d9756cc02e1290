"""The study of aspects: one record that commands, batch, report and library share."""

import numpy as np
import pytest
import shapes

from feederscrew.errors import FeederError
from feederscrew.output import offers
from feederscrew.output.aspects import files, tables
from feederscrew.part import load
from feederscrew.resting.rules import recommended
from feederscrew.studies.aspects import NEEDED, aspects

CARD = "parts/arc_chute.yaml"


def test_without_a_drop_test_the_closed_form_is_recommended():
    study = aspects(shapes.part(shapes.box(10.0, 20.0, 30.0)), surface="soft")
    assert study.tally is None
    assert study.recommended is study.aspects.recommended
    np.testing.assert_allclose(study.aspects.chances["surface"], study.aspects.chances["quasistatic"])
    assert not study.doubtful


def test_a_drop_test_is_made_where_no_closed_form_is_good_enough():
    begun = []
    part = shapes.part(shapes.box(10.0, 20.0, 30.0))
    study = aspects(part, launch="flip", before=begun.append)
    assert begun == [NEEDED] == [study.tally.counts.sum()]
    assert study.recommended.rule == "drop test, launch flip"
    np.testing.assert_array_equal(study.aspects.chances["recommended"], study.tally.p)
    assert aspects(part, launch="flip", drops=0).tally is None


def test_a_launch_chooses_the_rule_and_a_surface_given_wins():
    part = shapes.part(shapes.box(10.0, 20.0, 30.0))
    fed, soft = aspects(part, launch="feed"), aspects(part, launch="feed", surface="soft")
    assert fed.recommended.rule == "tempered hops, launch feed"
    assert soft.recommended.rule == "surface, soft, launch feed"
    placed = aspects(part, launch="place")
    assert placed.recommended.p.tolist() == placed.aspects.chances["quasistatic"].tolist()


def test_a_drop_test_that_disagrees_with_the_closed_form_says_so(monkeypatch):
    monkeypatch.setitem(recommended.WIDTHS, ("feed", False), 0.001)
    monkeypatch.setattr(recommended, "LAUNCHED", 0.001)
    study = aspects(shapes.part(shapes.box(10.0, 20.0, 30.0)), drops=2000)
    (said,) = study.aspects.warnings
    assert said.startswith(
        "the drop test and the closed form (tempered hops) disagree beyond their intervals: A "
    )
    assert said.endswith("% - the interval is widened to hold both")
    assert study.recommended.high[0] - study.recommended.low[0] > 0.01


def test_a_surface_may_be_named_or_a_number():
    part = shapes.part(shapes.box(10.0, 20.0, 30.0))
    named, number = (aspects(part, surface=surface).aspects for surface in ("medium", 1.2))
    assert named.chances["surface"].tolist() == number.chances["surface"].tolist()


def test_the_files_are_offered_and_made_only_when_asked_for(monkeypatch):
    study = aspects(shapes.part(shapes.box(10.0, 20.0, 30.0)))
    offered = offers.by_name(files.offers(study, tipping=True))
    assert sorted(offered) == [
        "aspects.csv", "aspects.json", "aspects.png", "graph.csv", "graph.png", "names.yaml",
        "probabilities.png",
    ]  # fmt: skip
    assert all(offer.alt for offer in offered.values() if offer.is_picture)
    assert offered["aspects.csv"].make().startswith("aspect,kind,faces,stable,")


def test_a_card_offers_no_view_and_has_no_graph():
    study = aspects(load(CARD))
    assert "aspects.png" not in offers.by_name(files.offers(study))
    assert tables.remarks(study) == ["a part card has no shape to draw: no aspects.png"]
    with pytest.raises(FeederError, match="has no shape to tumble"):
        study.transitions
