"""Every orientation that comes often is tried once before one of them is tried for the fifth time."""

from collections import Counter
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
import shapes
from design_counts import design_study, end_at, lost, queue

from feederscrew import bowl as bowls
from feederscrew.bowl.devices.kinds import make_device
from feederscrew.designing import calm_drive, exploring, loop, proposals
from feederscrew.designing.findings import Cause, Move, MoveKind
from feederscrew.designing.record import Attempt, DesignRequest
from feederscrew.designing.search import Candidate, Search, TrackAtBank
from feederscrew.trials.course import Fate
from feederscrew.trials.fills import LeavingPose, PoseKind

PART = shapes.part(shapes.box(20, 12, 5))
BOWL = bowls.default()
PLAIN = calm_drive.PlainBowl(BOWL, frozenset())
# a cap with a pin: six headings of A, then B; C, the pin up, comes last of those that come often
SHARES = {"A@270": 0.21, "A@125": 0.15, "A@54": 0.12, "A@1": 0.11, "A@180": 0.10, "A@9": 0.10, "B@4": 0.09}
SHARES |= {"C@86": 0.08, "D@0": 0.04}


@pytest.fixture
def trials(monkeypatch):
    """A search of which every trial is noted by its orientation, and none is clean but those named."""
    names, clean = [], {}
    lying = [SimpleNamespace(name=name, aspect=name[0], returned=False) for name in SHARES]
    weights = np.array(list(SHARES.values()))
    ways = SimpleNamespace(lying=lying)
    search = Search.begin(PART, DesignRequest(1.0, budget=24), BOWL)
    rows = exploring._rows_to_try(ways, weights, search)
    search.state.tracks.append(TrackAtBank(PLAIN, ways, weights, rows, 1.0))
    monkeypatch.setattr(exploring.proposals, "propose_no_device", lambda *_: None)
    monkeypatch.setattr(exploring.hanging, "head_rows", lambda *_: [])
    monkeypatch.setattr(exploring, "_promise", lambda search, track, row, way: 10.0 * weights[row])
    monkeypatch.setattr(exploring, "_screen", lambda search, candidate: candidate)
    monkeypatch.setattr(exploring.short_trials, "lost_by_motion", lambda trial: [])
    monkeypatch.setattr(exploring.proposals, "lost_at", lambda trial, kind: True)

    def proposal_of(row, kind, value):
        device = make_device(kind, "test", limit=value, text=f"{1e3 * value:.6g} mm")
        return proposals.Proposal(row, (), (device,), Move(MoveKind.PROPOSED))

    def proposed(search, track, row, way):
        # the pin can only be told by a camera
        if lying[row].aspect == "C" and way.cost_class < 3:
            return None
        return proposal_of(row, "gap", 5e-3 + 1e-4 * len(names))

    def tried(search, plain_bowl, proposal, weights, driven=None):
        name = lying[proposal.row].name
        names.append(name)
        search.state.tried[name] += 1
        rate, cost_class = clean.get(name, (0.0, 1))
        faults = () if rate else (lost(name, end_at(Fate.RETURNED, "gap", len(names))),)
        attempt = Attempt(
            name, name[0], proposal.chain, proposal.move, 0.0, 0.1, 2, 0.3, 1.0, 0.0, rate, faults,
            Cause.DEVICE, cost_class=cost_class,
        )  # fmt: skip
        search.state.attempts.append(attempt)
        trial = SimpleNamespace(rows=[], ends=(), efficiency=0.3)
        return Candidate(proposal, BOWL, ways, weights, trial, attempt)

    monkeypatch.setattr(exploring, "_propose", proposed)
    monkeypatch.setattr(exploring, "try_proposal", tried)
    monkeypatch.setattr(
        exploring.proposals,
        "mend_proposal",
        lambda proposal, *_: proposal_of(proposal.row, "gap", 0.02 + 1e-3 * len(names)),
    )
    return SimpleNamespace(search=search, names=names, clean=clean)


def test_no_orientation_has_five_trials_before_each_that_comes_often_has_one(trials):
    assert not list(exploring.candidates(trials.search, 1))
    tried, often = Counter(), {name for name, share in SHARES.items() if share >= 0.05}
    looked_at = often - {"A@9"}  # six rows are proposed, and one of each aspect beside them
    for name in trials.names:
        assert tried[name] < 4 or looked_at <= {*tried}, (name, tried)
        tried[name] += 1
    assert max(tried.values()) > 4 and tried["C@86"] == 1 and "D@0" not in tried


@pytest.mark.parametrize("rows", [(), (0,), (0, 5)])
def test_rails_of_each_head_have_trials_though_the_static_rule_used_up_those_of_steel(
    monkeypatch, trials, rows
):
    """A drawn cup had eight trials of one chain of the rule, and none of the rails that carry it."""
    tried, search = [], trials.search
    monkeypatch.setattr(exploring.hanging, "head_rows", lambda *_: list(rows))

    def noted(search, idea, cost_class):
        tried.append((idea.row, cost_class, search.is_spent))
        return iter(())

    monkeypatch.setattr(exploring, "_rails_by_trials", noted)
    assert not list(exploring.candidates(search, 1))
    assert sorted(tried) == [(row, 1, False) for row in rows]


def test_what_stood_at_rails_of_steel_is_blown_off_in_the_class_of_air(monkeypatch, trials):
    """The chain that was tried last first; each once, and none where the user leaves air out."""
    search, blown = trials.search, []
    trials.clean |= dict.fromkeys(SHARES, (2.0, 2))

    def stood_at(number, efficiency=0.3, hangs=True):
        proposal = SimpleNamespace(hangs=hangs, name=number, cuts=())
        seen = SimpleNamespace(wanted=[0])
        ways = search.state.tracks[0].orientations
        attempt = SimpleNamespace(efficiency=efficiency)
        return SimpleNamespace(proposal=proposal, trial=seen, orientations=ways, attempt=attempt, bowl=BOWL)

    def blow_off(proposal, trial, stands, lying):
        blown.append((proposal.name, stands))
        device = make_device("gap", "test", limit=1e-3 * (1 + proposal.name), text=f"{proposal.name} mm")
        return proposals.Proposal(1, (), (device,), Move(MoveKind.JET_BEFORE))

    monkeypatch.setattr(exploring.hanging, "blow_off", blow_off)
    monkeypatch.setattr(exploring, "_chains", lambda *_: iter(()))
    monkeypatch.setattr(
        exploring, "try_again",
        lambda search, one, proposal, bowl: exploring.try_proposal(search, None, proposal, None),
    )  # fmt: skip
    for number in range(4):
        exploring.note_standing(search, stood_at(number), [0, 3, 3, 2])
    exploring.note_standing(search, stood_at(7), [0])  # what hangs, behind what a cut was to return
    exploring.note_standing(search, stood_at(6), [])
    exploring.note_standing(search, stood_at(8, hangs=False), [3])
    exploring.note_standing(search, stood_at(9, efficiency=0.0), [3])
    assert not list(exploring.candidates(search, 1)) and not blown
    found = list(exploring.candidates(search, 2))
    assert blown == [(7, ()), (3, (3, 2)), (2, (3, 2))]
    assert (
        [one.proposal.move.kind for one in found]
        == [MoveKind.JET_BEFORE] * 3
        == [one.proposal.move.kind for one in search.state.clean]
    )
    still = replace(search, request=replace(search.request, without=("air jet",)))
    assert not list(exploring.candidates(still, 2)) and len(blown) == 3


def test_what_is_clean_and_dearer_waits_for_its_class(trials):
    trials.clean["C@86"] = 2.0, 3
    assert not [one for one in exploring.candidates(trials.search, 1) if one.attempt.aspect == "C"]
    assert "C@86" in trials.names
    trials.search.state.attempts.clear()
    first = next(exploring.candidates(trials.search, 3))
    assert first.attempt.wanted == "C@86" and trials.search.state.waiting == []


def test_a_wanted_orientation_that_counts_at_any_heading_goes_by_its_aspect(block):
    row = block.names["A@0"]
    one = proposals.Proposal(row, (), (), Move(MoveKind.NO_DEVICE))
    assert one.wanted_name(block.ways) == "A@0"
    assert replace(one, any_heading=("A",)).wanted_name(block.ways) == "A"
    assert replace(one, any_heading=("B",)).wanted_name(block.ways) == "A@0"


@pytest.mark.parametrize(
    ("clean", "losing", "tried", "calmed"),
    [
        ({"narrowed"}, (), ["gap", "narrowed"], []),
        (
            {"calmer"},
            {"gap", "narrowed"},
            ["gap", "narrowed", "canyon"],
            ["gap"],
        ),  # three at most, no section
        (set(), (), ["gap", "narrowed", "canyon"], []),
    ],
)
def test_what_an_impure_queue_lets_through_meets_one_device_after_the_other(
    monkeypatch, clean, losing, tried, calmed
):
    """Past a second sensor, which was proved; until a short trial is clean."""
    seen, calm = [], []

    def chain(name):
        return SimpleNamespace(chain=name, cost_class=3)

    def outcome(name):
        own = SimpleNamespace(loses_wanted=name in losing)
        return SimpleNamespace(proposal=chain(name), attempt=SimpleNamespace(clean=name in clean), trial=own)

    def try_again(search, candidate, changed, bowl):
        seen.append(changed.chain)
        return outcome(changed.chain)

    def try_calmer(search, one):
        calm.append(one.proposal.chain)
        return outcome("calmer")

    left = ("gap", "narrowed", "canyon", "cut-out")
    monkeypatch.setattr(proposals, "add_second_sensor", lambda _: chain("sensor"))
    monkeypatch.setattr(proposals, "purify", lambda *_: map(chain, left))
    monkeypatch.setattr(proposals, "spread_apart", lambda *_: chain("spacing section"))
    monkeypatch.setattr(exploring, "try_again", try_again)
    monkeypatch.setattr(exploring, "try_calmer", try_calmer)
    search = Search.begin(PART, DesignRequest(0.5), BOWL)
    candidate = SimpleNamespace(
        proposal=chain("one"), bowl=BOWL, orientations=SimpleNamespace(lying=()), shown=()
    )
    proved = [SimpleNamespace(proposal=chain("sensor"), bowl=BOWL)]
    impure = design_study(PART, queue(220, 225))
    changed = loop._change_by_proof(search, impure, candidate, proved)
    assert seen == tried and calm == calmed
    assert (changed is None) == (not clean) and (not clean or changed.attempt.clean)


def test_a_drop_of_each_kind_comes_once_for_what_left_a_queue(monkeypatch):
    """Of a bracket gaps of 6.6 and 5.7 mm came, which both stop it, and the narrowed track too late."""

    def dropped(kind, number=0):
        cut = SimpleNamespace(device=SimpleNamespace(kind=kind))
        return SimpleNamespace(cuts=(cut, *own.cuts), chain=(kind, number))

    def add_drop(proposal, rows, wanted, lying, kinds):
        return next((dropped(kind) for kind in ("gap", "narrowed track") if kind not in kinds), None)

    own = SimpleNamespace(cuts=("camera",), chain=("camera",))
    moved = SimpleNamespace(cuts=("wider",), chain=("wider",))
    first = {1: dropped("gap", 1), 2: dropped("gap", 2), 3: moved}
    monkeypatch.setattr(proposals, "_cut_more", lambda proposal, trial, row, lying: first[row])
    monkeypatch.setattr(proposals, "add_drop", add_drop)
    lying = tuple(SimpleNamespace(name=f"{name}@0") for name in "ABCD")
    candidate = SimpleNamespace(
        proposal=own, trial=SimpleNamespace(wanted=(0,)), orientations=SimpleNamespace(lying=lying)
    )
    left = [(LeavingPose(PoseKind.ORIENTATION, one.name[0], one.name), 1) for one in lying]
    found = [one.chain for one in proposals.purify(candidate, left)]
    assert found == [("gap", 1), ("wider",), ("narrowed track", 0)]


@pytest.mark.parametrize(("cost_class", "count"), [(1, 0), (2, 2), (3, 0)])
def test_air_for_what_stands_comes_on_top_of_the_trials_that_are_allowed(monkeypatch, cost_class, count):
    """Of an eyelet it took the trials of the class of sensors, whose second camera was then never tried."""
    search = Search.begin(PART, DesignRequest(0.5, budget=1), BOWL)
    search.state.attempts.append(None)
    search.state.reach = 1
    monkeypatch.setattr(exploring, "try_again", lambda search, *_: search.state.attempts.append(None))
    mends = [SimpleNamespace(chain=name, cost_class=cost_class) for name in "ab"]
    list(loop._try_mends(search, SimpleNamespace(bowl=BOWL), mends, (), 3))
    assert len(search.state.attempts) == 1 + count and search.is_spent and search.limit == 1 + count
    # the class of sensors keeps what was its own
    monkeypatch.setattr(exploring, "_tracks", lambda _: [])
    list(exploring.candidates(replace(search, request=replace(search.request, budget=4)), 3))
    assert search.state.reach == 4 + count
