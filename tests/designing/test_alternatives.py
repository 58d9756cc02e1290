"""The best design of each cost class, the cheapest first, and how its search takes turns."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
import shapes

from feederscrew import bowl as bowls
from feederscrew.designing import exploring, loop, proposals
from feederscrew.designing.exploring import Search
from feederscrew.designing.loop import alternatives
from feederscrew.designing.record import Attempt, DesignRequest, DesignStudy, FilledQueue, RobustRun
from feederscrew.output import designs
from feederscrew.output import tables as tables_of
from feederscrew.tooling.devices.kinds import make_device
from feederscrew.tooling.isolating.chain import Cut

PART = shapes.part(shapes.box(10, 10, 10))
GAP = make_device("gap", "test", limit=9e-3, text="9 mm")
SORTER = make_device("sorter", "test", like=("A", 0.0, 1e-3), text="{of: A@0, play: 1 mm}")


def study(*devices, right=45, left=45, returned=5, jams=0, **more):
    rows = tuple(
        FilledQueue(fill, 0.2, 12, 60.0, 60.0, float(left), right, left, returned, jams, 0)
        for fill in ("low", "normal", "high")
    )
    bowl = replace(bowls.default(), devices=devices)
    known = {"robust": RobustRun(20, 20, ""), "queues": rows, **more}
    return DesignStudy(PART, DesignRequest(40.0 / 60.0), bowl, "A@0", 0, **known)


def attempt(cost_class, faults=("B@0 is carried through",), efficiency=0.2):
    return Attempt(
        "A@0", ("gap: 9 mm",), "test", 0.0, 0.05, 8, efficiency, 0.5, 0.0, 1.0, faults, cost_class=cost_class
    )


def test_each_class_has_its_best_design_the_cheapest_first():
    rows = alternatives([study(GAP, right=30), study(GAP, SORTER), study(GAP)], [], [1, 2, 3])
    assert [one.cost_class for one in rows] == [1, 2, 3]
    assert [one.status for one in rows] == ["holds", "none", "holds"]
    assert rows[0].delivered[0] == pytest.approx(45.0 / 60.0) and rows[0].purity == 1.0
    assert rows[0].efficiency == pytest.approx(45.0 / 50.0)  # of 45 that left and 5 that came back
    assert rows[2].sees == ("outline",) and "tells" in rows[1].why


def test_a_class_that_was_tried_and_not_proved_says_why_and_one_that_was_not_says_so():
    one, two, three = alternatives([study(GAP)], [attempt(3), attempt(3, ("x",), 0.1)], [1])
    assert (one.status, two.status, three.status) == ("holds", "not tried", "none")
    assert "--alternatives" in two.why and three.why == "A@0: B@0 is carried through"


def test_what_was_stopped_shows_no_figures():
    (one, *_) = alternatives([study(GAP, partial=True)], [], [1])
    assert (one.status, one.delivered, one.purity, one.efficiency) == ("not proved", None, None, None)


def test_the_document_has_every_key_of_every_class_and_says_what_it_needs():
    rows = alternatives([study(GAP), study(SORTER)], [], [1, 2, 3])
    found = designs.document(study(GAP, alternatives=rows))["alternatives"]
    names = {"class", "status", "delivered_per_minute", "purity", "yield", "chain", "needs"}
    assert len(found) == 3 and all(names <= set(one) for one in found)
    assert found[0]["delivered_per_minute"] == pytest.approx(45.0) and found[0]["needs"] == []
    assert found[2]["needs"] == ["camera from above", "a valve", "compressed air"]
    printed = tables_of.text(designs.summary(study(GAP, alternatives=rows)), "table")
    assert "with steel alone" in printed and "yield 90 %" in " ".join(printed.split())


@pytest.fixture
def searching(monkeypatch):
    """A search of which no chain is looked for or tried: what is asked of it is noted."""
    bowl, asked = bowls.default(), []
    search = Search(PART, DesignRequest(0.5, budget=10), bowl, frozenset(), lambda text: None)
    shares = np.array([0.6, 0.1])
    ways = SimpleNamespace(
        lying=[SimpleNamespace(name="A@0", aspect="A"), SimpleNamespace(name="B@0", aspect="B")]
    )
    for place, bank in enumerate((3.0, 0.0)):
        track = replace(bowl.track, bank=np.radians(bank))
        made_bowl = SimpleNamespace(bowl=replace(bowl, track=track))
        search.tracks.append(
            exploring._BankedTrack(made_bowl, ways, shares, [0, 1], exploring.BANK_RANK**place)
        )
    monkeypatch.setattr(exploring.proposals, "bare", lambda *_: None)
    monkeypatch.setattr(exploring, "_promise", lambda search, track, row, way: shares[row])

    def proposed(search, track, row, way):
        asked.append((round(np.degrees(track.plain_bowl.bowl.track.bank)), row, way))
        device = make_device("gap", "test", limit=5e-3 + 1e-3 * len(asked), text=f"{5 + len(asked)} mm")
        return proposals.Proposal(row, (), (device,), "test")

    def tried_out(search, made_bowl, proposal, weights):
        search.attempts.append(attempt(1))
        search.chains.add(exploring.chain_key(made_bowl.bowl.track, proposal, ways.lying))
        yield from ()

    monkeypatch.setattr(exploring, "_proposed", proposed)
    monkeypatch.setattr(exploring, "_tried_out", tried_out)
    return search, asked


def test_the_oftener_orientation_comes_first_on_either_bank_before_a_smaller_margin_of_another(searching):
    search, asked = searching
    assert not list(exploring.candidates(search, 1))
    first = [(bank, row) for bank, row, _ in asked[:2]]
    assert first[0] == (3, 0) and all(row == 0 for _, row in first)
    assert {bank for bank, _, _ in asked[:6]} == {3, 0}  # no bank has all trials for itself


def test_a_class_uses_its_share_of_the_trials_and_the_next_has_the_rest(searching):
    search, _ = searching
    list(exploring.candidates(search, 1))
    assert len(search.attempts) == 5  # half of ten
    list(exploring.candidates(search, 2))
    assert len(search.attempts) == 7  # the first two 70 %
    list(exploring.candidates(search, 3))
    assert len(search.attempts) == 10


def test_only_what_is_rare_is_worth_a_device_that_turns_others_into_it(searching):
    search, asked = searching
    search.request = replace(search.request, budget=1000)
    list(exploring.candidates(search, 1))
    assert {row for _, row, way in asked if way.turns} == {1}


def test_the_same_chain_is_not_tried_twice_nor_one_that_differs_by_a_hair():
    track = bowls.default().track
    lying = [SimpleNamespace(name="A@0")]

    def key(*devices):
        return exploring.chain_key(track, proposals.Proposal(0, (), devices, "test"), lying)

    first = make_device("sorter", "test", like=("A", 0.0, 1e-3), also=(("B", 1.0),)).rewritten()
    other = make_device("sorter", "test", like=("B", 1.0, 1e-3), also=(("A", 0.0),)).rewritten()
    assert first.text != other.text and key(first) == key(other)
    near, far = (make_device("gap", "test", limit=limit).rewritten() for limit in (9.05e-3, 9.5e-3))
    assert exploring._is_alike(key(GAP), key(near)) and not exploring._is_alike(key(GAP), key(far))
    assert not exploring._is_alike(key(GAP), key(GAP, GAP))


@pytest.mark.parametrize("every, classes", [(False, [1]), (True, [1, 2, 3])])
def test_it_stops_at_the_first_class_that_holds_unless_alternatives_are_asked(monkeypatch, every, classes):
    asked = []

    def candidates(search, cost_class):
        asked.append(cost_class)
        yield SimpleNamespace(number=cost_class)

    def prove(search, candidate, proofs):
        chain = (SORTER,) if candidate.number == 3 else (GAP,)
        many = 20 * candidate.number  # the dearest brings most
        proofs.append((study(*chain, right=40 + many, left=40 + many), candidate))

    monkeypatch.setattr(exploring, "candidates", candidates)
    monkeypatch.setattr(loop, "_prove", prove)
    found = loop.design(PART, bowls.default(), (), DesignRequest(40.0 / 60.0, alternatives=every))
    assert asked == classes and found.status == "holds"
    assert found.alternatives[0].status == "holds" and len(found.alternatives) == 3
    assert found.alternatives[2].status == ("holds" if every else "not tried")
    assert found.devices == (GAP,)  # the cheapest of those that hold


def test_too_small_a_yield_says_which_rate_or_share_would_hold():
    """Of 50 parts a minute a fifth leaves: 10/min, and for 40/min four fifths have to."""
    made_study = study(GAP, right=10, left=10, returned=40)
    low = 60.0 * made_study.delivered[1] / 0.9
    assert made_study.cause == "arrival"
    assert f"{low:.2g}/min would hold" in made_study.why and "80 % come so" in made_study.why


def test_what_is_impure_names_the_fill_and_the_device_that_others_came_through():
    cut = Cut(GAP, 1e-3, 1e-3, GAP, GAP, ("B@0",))
    found = study(GAP, right=40, left=45, cuts=(cut,))
    low, normal, high = found.queues
    rows = (low, replace(normal, left_instead=(("B@0", 2),)), replace(high, left_instead=(("B@0", 9),)))
    assert "B@0: 11 of 135 (most at high fill, through the gap)" in replace(found, queues=rows).why
    bare = replace(found, queues=rows, cuts=())
    assert "B@0: 11 of 135 (most at high fill)" in bare.why


@pytest.mark.parametrize("isolates", [True, False])
def test_more_is_asked_of_a_chain_only_where_less_isolates(searching, monkeypatch, isolates):
    """First the least margin without a turning device; the rest only where that has a chain."""
    search, _ = searching
    way = next(way for way in proposals.recipes_of(1, search.request) if way.turns and way.margin == 5e-4)
    ways, chain = [], proposals.Proposal(0, (), (), "test")
    monkeypatch.setattr(
        exploring,
        "_proposed",
        lambda search, track, row, way: ways.append(way) or (chain if isolates else None),
    )
    idea = exploring._Idea(search.tracks[0], 1, way)
    assert exploring._proposal(search, idea) is (chain if isolates else None)
    tried = [(way.turns, way.margin) for way in ways]
    assert tried == ([(False, 5e-4), (True, 2.5e-4), (True, 5e-4)] if isolates else [(False, 5e-4)])
    exploring._proposal(search, idea)
    assert len(ways) == len(tried)  # each is looked for once
