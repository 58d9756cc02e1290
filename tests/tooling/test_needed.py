"""A design has no device without which its numbers are the same, or says what that is for."""

from dataclasses import replace

import numpy as np
import pytest
import shapes
import trimesh

from feederscrew import bowl as bowls
from feederscrew.output import tooling as tables
from feederscrew.resting.aspects import find
from feederscrew.studies.tooling import tooling
from feederscrew.tooling.devices.kinds import make_device
from feederscrew.tooling.isolating import chain, proposal
from feederscrew.tooling.isolating.proposal import design_task, propose
from feederscrew.tooling.orientations import orientations, travelling

BOWL = bowls.read(None, [])
MARGIN = 2.5e-4
CSK = [(0, 0), (2.5, 0), (2.5, 13.2), (5.0, 15.7), (5.0, 16), (0, 16)]  # [mm] radius, height
INSERT = [(1.6, 0), (2.3, 0), (2.3, 2), (2, 2.4), (2, 2.9), (2.3, 3.3), (2.3, 5.7), (1.6, 5.7), (1.6, 0)]


def flange_nut():
    """A hexagon of 10 mm on a flange of 14.2 mm, with a bore of 6 mm."""
    turn = np.pi / 3 * np.arange(6)
    hexagon = shapes.prism(np.column_stack([np.cos(turn), np.sin(turn)]) * 10 / np.sqrt(3), 6.0)
    hexagon.apply_translation([0, 0, 3] - hexagon.bounds.mean(axis=0))
    flange = trimesh.creation.revolve([(0, 0), (7.1, 0), (7.1, 0.9), (5.2, 2), (0, 2)], sections=12)
    return hexagon.union(flange).difference(shapes.cylinder(3, 30, 12))


def housing():
    """An open box with a lug at one side."""
    inside, lug = shapes.box(20, 12, 9), shapes.box(4, 6, 2)
    inside.apply_translation([0, 0, 2])
    lug.apply_translation([13.5, 2, -3.5])
    return shapes.box(24, 16, 9).difference(inside).union(lug)


PARTS = {
    "countersunk_m5": lambda: trimesh.creation.revolve(CSK, sections=24),
    "insert_m3": lambda: trimesh.creation.revolve(INSERT, sections=24),
    "flange_nut_m6": flange_nut,
    "housing": housing,
}


@pytest.fixture(scope="module")
def block():
    part = shapes.part(shapes.box(20, 12, 5))
    aspects = find(part)
    every = travelling(orientations(part, aspects, BOWL.track), BOWL)
    return every, np.array([one.chances["csa"] for one in every])


def cut(every, wanted, kind, **values):
    device = make_device(kind, "design", **values)
    must = np.array([chain.margin_at(device, one, every) <= -MARGIN for one in every])
    return chain.judge_cut(every, wanted, device, must, device, device), must


def test_a_device_that_changes_no_number_is_left_out_and_what_drops_parts_stays(block):
    every, shares = block
    wanted = next(k for k, one in enumerate(every) if one.name == "A@0")  # 20 mm along the track
    given = design_task(every, shares, wanted, MARGIN, 1.0, ())
    first, gone = cut(every, wanted, "narrowed_track", limit=every[wanted].balcony + 1e-3)
    again, also = cut(every, wanted, "narrowed_track", limit=every[wanted].balcony + 2e-3)
    other, more = cut(every, wanted, "sorter", like=("A", 0.0, 2e-3), sees="height")
    assert gone.any() and not (also & ~gone).any()
    both = proposal.propose_needed(given, (first, again), gone | also | ~given.stays)
    assert [one.device.limit for one in both.cuts] == [first.device.limit]
    alone = propose(given, (first,), gone | ~given.stays)
    assert (both.isolated, both.efficiency, both.purity) == (alone.isolated, alone.efficiency, alone.purity)
    assert (more & ~gone).any()
    kept = proposal.propose_needed(given, (first, other), gone | more | ~given.stays)
    assert [one.device.kind for one in kept.cuts if not one.device.leans] == ["narrowed_track", "sorter"]


def test_one_that_alone_returns_a_share_by_the_margin_stays(block):
    every, shares = block
    wanted = next(k for k, one in enumerate(every) if one.name == "A@0")
    given = design_task(every, shares, wanted, MARGIN, 1.0, ())
    first, gone = cut(every, wanted, "narrowed_track", limit=every[wanted].balcony + 1e-3)
    met = np.array([one.name in first.returns for one in every])
    rare = replace(given, coming=np.where(met, 1e-6, given.coming), shares=np.where(met, 1e-6, shares))
    assert proposal.propose_needed(given, (first,), gone | ~given.stays).cuts
    assert not proposal.propose_needed(rare, (first,), gone | ~given.stays).cuts


@pytest.mark.parametrize("name", PARTS)
def test_no_device_of_these_parts_is_idle(name):
    part = shapes.part(PARTS[name](), name)
    study = tooling(part, BOWL, "A", rule="csa", verdicts=1)
    found, every = study.design, study.orientations
    own = [one for one in found.cuts if not one.device.serves]
    assert own and all(one.device.serves for one in found.cuts if one not in own)
    given = design_task(every, study.shares, found.wanted, study.margin, 1.0, ())
    whole = propose(given, own, np.zeros(len(every), bool))
    for one in own:
        rest = propose(given, [other for other in own if other is not one], np.zeros(len(every), bool))
        assert abs(rest.purity - whole.purity) + abs(rest.efficiency - whole.efficiency) > 1e-3
    rows = tables.document(study)["chain"]
    assert all(bool(row["returns"] or row.get("stops")) != bool(row["serves"]) for row in rows)
