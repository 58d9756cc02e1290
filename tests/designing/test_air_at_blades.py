"""Where parts stand at a blade, a design tries the same chain with air along its face, as steady air."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
import shapes
import trimesh
from design_counts import short_trial, stopped_at

from feederscrew import bowl as bowls
from feederscrew.bowl.devices.kinds import make_device
from feederscrew.bowl.devices.trade import Action
from feederscrew.designing import assisting, exploring, hanging, texts
from feederscrew.designing.findings import MoveKind
from feederscrew.designing.policy import SearchPolicy
from feederscrew.designing.record import DesignRequest
from feederscrew.designing.search import Search
from feederscrew.feeding import stream
from feederscrew.resting.aspects import find
from feederscrew.sorting.isolating.rails import find_head
from feederscrew.trials.fills import JammedParts

# a sleeve of 7 mm, 9 mm long with its flange of 12 mm, as an eyelet: on its flange it stands at a blade
SLEEVE = np.array([(0, 0), (6, 0), (6, 1.5), (3.5, 1.5), (3.5, 9), (0, 9)], float)
BOWL = bowls.read(None, ["track.width=14 mm", "track.bank=3 deg"])


@pytest.fixture(scope="module")
def chain():
    """Rails with a blade behind them, and a trial in which what lies on an end stands at that."""
    part = shapes.part(trimesh.creation.revolve(SLEEVE, sections=32), "sleeve")
    aspects = find(part)
    lying = stream.follow_orientations(part, aspects, BOWL.track, (), bowl=BOWL).lying
    shares = np.full(len(lying), 1.0 / len(lying))
    row = hanging.head_rows(lying, shares, range(len(lying)))[0]
    rails = hanging.RailsSearch(lying, shares, row, (), DesignRequest(0.5), 1)
    proposal = next(rails.start()).proposal
    ways = stream.follow_orientations(part, aspects, BOWL.track, proposal.devices, bowl=BOWL)
    right = np.flatnonzero(hanging.same_head(ways.lying, find_head(ways.lying[row]))).tolist()
    stands = [k for k, one in enumerate(ways.lying) if one.kind == "flat"]
    blade = stopped_at("wiper", len(proposal.devices))
    ends = tuple({blade: 2} if k in stands else {} for k in range(len(ways.lying)))
    trial = short_trial(ways, right, held=stands, ends=ends, states=tuple(proposal.states(ways)))
    return SimpleNamespace(proposal=proposal, trial=trial, stands=stands, lying=ways.lying)


def tries(chain, proposal=None, stands=None):
    rows = chain.stands if stands is None else stands
    return list(assisting.assist(proposal or chain.proposal, chain.trial, rows, chain.lying))


def test_the_same_chain_is_tried_with_air_at_three_pressures(chain):
    changed = tries(chain)
    blade = assisting.blade_of(chain.proposal)
    assert len(changed) == len(assisting.PUSHES) and all(one.cost_class == 2 for one in changed)
    highest = max(chain.lying[row].height for row in chain.stands)
    pressures = []
    for one, push in zip(changed, assisting.PUSHES, strict=True):
        own = assisting.blade_of(one)
        assert own == replace(blade, air=own.air, text=own.text) and own.text == own.value_text()
        # over what passes below the blade, and not over what stands at it
        assert blade.limit < own.air.height - 0.5 * own.air.nozzle + 1e-6 and own.air.height < highest
        assert one.cuts[:-1] == chain.proposal.cuts[:-1]
        assert one.move.kind is MoveKind.AIR_ASSIST and "wiper" in texts.move_text(one.move)
        pressures.append(own.air.pressure)
        for row in chain.stands:  # by its definition, at the next step of a regulator
            lying = chain.lying[row]
            forces = own.air.at_face(lying, own.sweep, own.limit)
            holds = lying.grip * lying.posture.mass * lying.gravity
            assert np.mean([force.along for force in forces]) >= 0.999 * push * holds
    assert pressures[2] < pressures[0] < pressures[1]


def test_none_is_tried_where_air_would_meet_nothing_that_stands(chain):
    assert not tries(chain, tries(chain)[0])  # its blade has air
    assert not tries(chain, stands=chain.trial.wanted)
    bare = [cut for cut in chain.proposal.cuts if cut.device.action is not Action.OVERHEAD]
    assert not tries(chain, replace(chain.proposal, cuts=tuple(bare)))
    high = assisting.blade_of(chain.proposal).valued(0.05)
    cut = replace(chain.proposal.cuts[-1], device=high)
    assert not tries(chain, chain.proposal.with_cut(len(chain.proposal.cuts) - 1, cut, chain.proposal.move))


def test_where_parts_still_stand_in_a_queue_the_air_is_stronger_first(chain):
    proposal = tries(chain)[0]
    candidate = SimpleNamespace(
        proposal=proposal, trial=chain.trial, orientations=SimpleNamespace(lying=chain.lying)
    )
    jam = JammedParts(chain.lying[chain.stands[0]].name, len(proposal.devices), "wiper", 2)
    search = Search.begin(shapes.part(shapes.box(20, 12, 5)), DesignRequest(1.0), BOWL)
    first = next(exploring.mends_of_jams(search, candidate, [jam]))
    before, after = (assisting.blade_of(one).air for one in (proposal, first))
    assert after == before._replace(pressure=2.0 * before.pressure)
    assert first.cuts[:-1] == proposal.cuts[:-1]
    # the net gives 4 bar
    strong = assisting.with_air(proposal, before._replace(pressure=2.5e5))
    assert assisting.stronger(strong) is None and assisting.stronger(chain.proposal) is None


def test_a_blade_that_is_raised_keeps_its_air_as_high_over_its_edge(chain):
    proposal = tries(chain)[0]
    place, blade = assisting.blade_place(chain.proposal), assisting.blade_of(chain.proposal)
    higher = replace(chain.proposal.cuts[place], device=blade.valued(blade.limit + 1e-3))
    move = chain.proposal.move
    kept = assisting.keep_air(proposal, chain.proposal.with_cut(place, higher, move))
    own, air = assisting.blade_of(kept), assisting.blade_of(proposal).air
    assert own.limit == pytest.approx(blade.limit + 1e-3) and kept.move == move
    assert own.air == air._replace(height=pytest.approx(air.height + 1e-3))
    assert assisting.keep_air(chain.proposal, chain.proposal) is chain.proposal


def test_what_stands_at_the_blade_alone_does_not_count_against_a_chain(chain):
    """It counts where it stands elsewhere, or is wanted: air takes off neither."""
    trial, share = chain.trial, 1.0 / len(chain.lying)
    assert assisting.score(trial, chain.proposal) == pytest.approx(trial.efficiency)
    ends = tuple({stopped_at("rails", 1): 2} if k in chain.stands else {} for k in range(len(chain.lying)))
    at_rails = assisting.score(replace(trial, ends=ends), chain.proposal)
    assert at_rails == pytest.approx(trial.efficiency - 3.0 * share * len(chain.stands))


@pytest.mark.parametrize("shows", ["clean", "better", "the same"])
def test_the_class_of_air_tries_the_most_promising_chains_first(monkeypatch, chain, shows):
    """Until one is clean; one pressure where that changes nothing; a jet as well where air is not enough."""
    search = Search.begin(shapes.part(shapes.box(20, 12, 5)), DesignRequest(1.0, budget=24), BOWL)
    tried, blown, clean = [], [], shows == "clean"

    def candidate_of(proposal, efficiency=0.3, held=True):
        trial = chain.trial if held else replace(chain.trial, held=np.zeros_like(chain.trial.held))
        attempt = SimpleNamespace(efficiency=efficiency, clean=clean, rate=2.0, faults=())
        ways = SimpleNamespace(lying=chain.lying)
        return SimpleNamespace(proposal=proposal, trial=trial, attempt=attempt, orientations=ways, bowl=BOWL)

    def try_again(search, candidate, proposal, bowl):
        tried.append(proposal)
        search.state.chains.add(exploring.chain_key(bowl.track, proposal, chain.lying))
        return candidate_of(proposal, held=shows == "the same")

    def blow_off(proposal, trial, stands, lying):
        blown.append((proposal, stands))

    monkeypatch.setattr(exploring, "try_again", try_again)
    monkeypatch.setattr(exploring, "_screen", lambda search, candidate: candidate)
    monkeypatch.setattr(exploring, "_rows_that_stay", lambda candidate: chain.stands)
    monkeypatch.setattr(exploring, "_tracks", lambda search: [])
    monkeypatch.setattr(exploring.hanging, "blow_off", blow_off)
    gap = make_device("gap", "test", limit=2e-3)
    others = [replace(chain.proposal, before=(gap.valued(1e-3 * k),)) for k in range(1, 5)]
    scores = dict(zip((one.chain for one in others), (0.1, 0.4, 0.2, 0.3)))
    monkeypatch.setattr(assisting, "score", lambda trial, proposal: scores[proposal.chain])
    for number, one in enumerate(others):  # the fourth lets nothing leave
        exploring.note_standing(search, candidate_of(one, 0.3 * (number != 3)), chain.stands)
    exploring.note_standing(search, candidate_of(others[1]), chain.trial.wanted)  # only what hangs
    exploring.note_standing(search, candidate_of(others[1]), chain.stands[:1])  # once more, in a queue
    left_out = replace(search, request=replace(search.request, without=("air jet",)))
    assert not list(exploring.candidates(left_out, 2)) and not tried and not blown
    found = list(exploring.candidates(search, 2))
    count = {"clean": 1, "better": len(assisting.PUSHES), "the same": 1}[shows]
    assert len(tried) == SearchPolicy().assisted * count and len(found) == clean * len(tried)
    assert [one.before[0].limit for one in tried] == [2e-3] * count + [3e-3] * count
    assert len(search.state.failures) == (not clean) * len(tried)
    assert [len(rows) for _, rows in search.state.stood_at_blade] == [len(chain.stands)] * 3
    # then a jet before the rails of each of steel; where air alone was not enough, of the best with it
    with_air = [proposal for proposal, _ in blown if assisting.blade_of(proposal).air is not None]
    assert with_air == ([tried[0], tried[count]] if shows == "better" else [])
    assert len(blown) == len(with_air) + SearchPolicy().air_trials
