"""What may come more often than was seen is tried, and what passes is named with its break-even share."""

from dataclasses import replace

import numpy as np
import pytest
import shapes
from design_counts import design_study, queue, short_trial

from feederscrew import bowl as bowls
from feederscrew.arrivals.entry import Shares
from feederscrew.designing import exploring, hazards, short_trials
from feederscrew.designing.findings import FaultKind
from feederscrew.designing.record import DesignRequest, RiskKind
from feederscrew.designing.search import Search
from feederscrew.designing.short_trials import break_even, find_denials
from feederscrew.output import designs


@pytest.mark.parametrize(
    ("wanted", "wrong", "passing"), [(0.8, 0.0, 1.0), (0.4, 0.004, 0.5), (1.0, 0.0, 0.1)]
)
def test_at_the_break_even_share_the_purity_is_what_is_asked_for(wanted, wrong, passing):
    share = break_even(wanted, wrong, passing)
    good, bad = (1.0 - share) * wanted, (1.0 - share) * wrong + share * passing
    assert 0.0 < share < 0.2 and good / (good + bad) == pytest.approx(0.98)
    assert break_even(wanted, wanted, passing) == 0.0  # the others are too many already


def test_a_bolt_whose_80_percent_leave_bears_1_6_percent_on_its_head():
    assert break_even(0.797, 0.0, 1.0) == pytest.approx(0.016, abs=1e-4)


def known(ways, *highs, shares):
    """The orientations with shares and upper ends, of the first ones; of the others none at all."""
    count = len(ways.lying)
    all_shares, ends = np.zeros(count), np.zeros((count, 2))
    all_shares[: len(shares)], ends[: len(highs), 1] = shares, highs
    return replace(ways, rules={**ways.rules, "recommended": all_shares}, interval=ends), all_shares


@pytest.mark.parametrize(("high", "rule", "tried"), [
    (0.0075, "recommended", [1]),  # 0 of 400
    (0.0049, "recommended", []),
    (np.nan, "recommended", []),
    (0.0075, "csa", []),  # a rule without an interval
])  # fmt: skip
def test_what_was_not_seen_is_tried_where_it_may_come_often(block, monkeypatch, high, rule, tried):
    ways, shares = known(block.ways, 1.0, high, shares=(1.0, 0.0))
    ways = replace(ways, rules={**ways.rules, "csa": shares})
    asked = []

    def try_parts(part, bowl, orientations, own, targets, *, rows, count, **more):
        asked.extend(rows)
        return replace(short_trial(ways, (), tuple(rows)), rows=np.array(rows), velocity=9.0, **{
            name: np.array([2 * (name in ("parts", "wrong"))] * len(rows)) for name in short_trials.COUNTED
        }, ends=({},) * len(rows))  # fmt: skip

    monkeypatch.setattr(short_trials, "try_parts", try_parts)
    request = DesignRequest(0.5, rule=rule)
    search = Search.begin(block.part, request, bowls.default(), shares=Shares(block.aspects))
    trial = replace(
        short_trial(ways, (0,)), shares=shares, rows=np.array([0]), ends=({},),
        **{name: np.array([2 * (name in ("parts", "right"))]) for name in short_trials.COUNTED},
    )  # fmt: skip
    proposal = type("Chain", (), {"row": 0, "rows": (0,), "any_heading": ()})
    more = exploring.try_untried(search, bowls.default(), trial, shares, proposal)
    assert asked == tried and more.rows.tolist() == [0, *tried]
    assert (more.velocity, more.purity, more.efficiency) == (trial.velocity, 1.0, 1.0)


@pytest.mark.parametrize(("share", "denied"), [(0.0, False), (0.004, False), (0.006, True)])
def test_only_what_comes_often_denies_a_chain(ways, share, denied):
    shares = np.zeros(len(ways.lying))
    shares[:3] = 1.0 - 2.0 * share, share, share
    trial = replace(short_trial(ways, (0,), (1,), (2,)), shares=shares)
    kinds = {fault.kind for fault in find_denials(trial) if fault.row in (1, 2)}
    assert (FaultKind.STAYS in kinds) == denied


def test_what_passes_is_a_risk_with_its_break_even_share_at_the_worst_fill(ways):
    shares, highs = np.zeros(len(ways.lying)), np.full(len(ways.lying), 0.0075)
    shares[0] = 1.0
    trial = replace(short_trial(ways, (0,), (1,), (2,)), shares=shares)
    fills = queue(90, returned=10, fill="low"), queue(30, returned=70, fill="high")
    leaves, stands = hazards.seldom_risks(trial, highs, fills)
    assert (leaves.kind, stands.kind) == (RiskKind.LEAVES, RiskKind.STANDS)
    seldom = leaves.seldom
    assert seldom.orientation == ways.lying[1].name and (seldom.left, seldom.parts) == (2, 2)
    assert seldom.break_even == pytest.approx(break_even(0.3, 0.0, 1.0)) and seldom.may_spoil
    assert not replace(seldom, share_high=0.005).may_spoil
    assert stands.seldom.break_even is None and not stands.seldom.may_spoil
    name = seldom.orientation
    assert (
        f"{name} leaves too (2 of 2 parts tried): from 0.61 % of {name} on, purity is below 98 %"
        in leaves.text
    )
    # of trials alone; and in the files
    (alone, _) = hazards.seldom_risks(trial, highs, ())
    assert alone.seldom.break_even == pytest.approx(break_even(1.0, 0.0, 1.0))
    found = designs.document(design_study(shapes.part(shapes.box(10, 10, 10)), risks=(leaves,)))["findings"][
        0
    ]
    assert found["seldom"]["break_even"] == pytest.approx(seldom.break_even) and found["kind"] == "leaves"


def test_what_is_wanted_or_comes_back_is_no_risk(ways):
    trial = replace(short_trial(ways, (0,)), shares=np.eye(len(ways.lying))[0])
    assert hazards.seldom_risks(trial, np.ones(len(ways.lying)), ()) == ()
