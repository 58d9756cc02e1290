"""The policy of the search: each value says on which data it was chosen, and the search goes by it."""

import csv
from dataclasses import fields, replace
from pathlib import Path
from types import SimpleNamespace

import pytest
import shapes
from design_counts import lost

from feederscrew import bowl as bowls
from feederscrew.designing import exploring, policy, proposals
from feederscrew.designing.findings import Move, MoveKind
from feederscrew.designing.policy import USUAL_POLICY, SearchPolicy
from feederscrew.designing.proof import RobustRun
from feederscrew.designing.record import DesignRequest
from feederscrew.designing.search import Search, TrackAtBank

DESIGNS = Path(__file__).parents[2] / "docs" / "designs.csv"


def test_every_value_says_on_which_parts_it_was_chosen():
    with DESIGNS.open(newline="") as file:
        designed = {row["part"] for row in csv.DictReader(file)}
    for field in fields(SearchPolicy):
        basis = policy.basis_of(field.name)
        assert basis.finding and set(basis.parts) <= designed, field.name
    assert {basis.parts for basis in map(policy.basis_of, ("faster", "lower_rate_trials"))} == {
        ("shcs_m3x8_simple",),
        ("cap_14x10",),
    }
    with pytest.raises(KeyError):
        policy.basis_of("luck")


def test_a_search_beside_another_begins_anew_and_counts_with_it():
    """It shares the trials that were made and the drive that was asked for, and nothing that was tried."""
    first = Search.begin(shapes.part(shapes.box(20, 12, 5)), DesignRequest(0.5, budget=10), bowls.default())
    first.state.reserve, first.state.nearest_limit = 2.0, 3
    first.state.attempts.append(None)
    first.state.lost_behind.append(((0.0, 0), ("gap",)))
    other = first.beside(replace(first.request, target=0.25))
    assert other.request.target == 0.25 and first.request.target == 0.5
    assert other.state.attempts is first.state.attempts and other.progress is first.progress
    assert (other.state.start, other.state.reserve, other.limit) == (1, 2.0, 10)
    assert not other.state.lost_behind and not other.state.chains


@pytest.mark.parametrize(("mends", "trials"), [(0, 1), (2, 3)])
def test_a_proposal_is_mended_as_often_as_the_policy_says(monkeypatch, block, mends, trials):
    """Each mend is another trial; a policy is passed on to whatever the search does."""
    search = Search.begin(
        block.part, DesignRequest(0.5), bowls.default(), policy=replace(USUAL_POLICY, mends=mends)
    )
    made = []

    def tried(search, plain_bowl, proposal, weights):
        made.append(proposal)
        return failing(proposal, len(made))

    def failing(proposal, number):
        attempt = SimpleNamespace(
            clean=False, efficiency=0.1 * number, faults=(lost(f"A@{number}"),), stopped=0.0
        )
        return SimpleNamespace(
            proposal=proposal, orientations=block.ways, attempt=attempt, worst=None, bowl=search.plain,
            trial=SimpleNamespace(rows=(), efficiency=0.1), robust=RobustRun(0, 0),
            is_nearly_robust=lambda policy: False,
        )  # fmt: skip

    def as_it_is(search, candidate):
        yield from ()
        return candidate

    def none_livelier(search, candidate):
        yield from ()

    monkeypatch.setattr(exploring, "try_proposal", tried)
    monkeypatch.setattr(exploring, "_screen", lambda search, candidate: candidate)
    monkeypatch.setattr(exploring, "_find_calmer", as_it_is)
    monkeypatch.setattr(exploring, "_find_livelier", none_livelier)
    monkeypatch.setattr(proposals, "mend_proposal", lambda proposal, *_: proposal)
    plain = exploring.calm_drive.PlainBowl(search.plain, frozenset())
    track = TrackAtBank(plain, block.ways, None, [0], 1.0)
    proposal = proposals.Proposal(0, (), (), Move(MoveKind.NO_DEVICE))
    assert not list(exploring._try_and_mend(search, track, proposal))
    assert len(made) == trials
