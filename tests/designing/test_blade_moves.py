"""A silhouette blade is moved by what trials deny: farther, or back where wanted ones are lost."""

from types import SimpleNamespace

import numpy as np
import pytest
import shapes
from design_counts import carried, end_at, lost

from feederscrew.bowl.devices.kinds import make_device
from feederscrew.bowl.record import Track
from feederscrew.designing import proposals
from feederscrew.designing.findings import Move, MoveKind
from feederscrew.resting.aspects import find
from feederscrew.sorting.isolating.chain import judge_cut
from feederscrew.sorting.orientations import orientations
from feederscrew.trials.course import Fate

ANGLE = [(0, 0), (20, 0), (20, 4), (5, 4), (5, 12), (0, 12)]  # [mm]
LEVEL = Track(climb=0.0, bank=0.0, radius=100.0, width=0.2)


@pytest.fixture(scope="module")
def angle():
    """Orientations of an angle, and the places of the one with its leg off the wall, and at it."""
    part = shapes.part(shapes.prism(ANGLE, 15))
    every = orientations(part, find(part), LEVEL)
    rows = [k for k, own in enumerate(every) if abs(own.height - 12e-3) < 1e-5 and own.length < 15.1e-3]
    at_wall, off_wall = sorted(rows, key=lambda k: every[k].distance)
    return every, off_wall, at_wall


@pytest.fixture
def chain(angle):
    every, wanted, other = angle
    sizes = {"limit": 9e-3, "reach": 12e-3, "leaves": 15e-3, "sweep": np.radians(30.0)}
    blade = make_device("silhouette blade", "test", **sizes).rewritten()
    must = np.arange(len(every)) == other
    cut = judge_cut(every, wanted, blade, must, blade, blade)
    return proposals.Proposal(wanted, (cut,), (), Move(MoveKind.PROPOSED))


def test_it_reaches_farther_by_half_of_what_the_wanted_one_has_to_spare(angle, chain):
    every, wanted, other = angle
    (before,), trial = chain.cuts, SimpleNamespace(wanted=[wanted])
    worst = carried(every[other].name, other).counted_in_draws(2, 20)
    (after,) = proposals.mend_proposal(chain, trial, every, worst).cuts
    by = 0.5 * (before.margin_pass - proposals.MARGINS[-1])
    assert after.device.reach == pytest.approx(before.device.reach + by, abs=5e-5)
    assert after.device.leaves == pytest.approx(before.device.leaves - by, abs=5e-5)
    assert 0.0 < after.margin_pass < before.margin_pass and every[other].name in after.returns


def test_it_goes_back_by_a_quarter_of_what_the_others_fail_by(angle, chain):
    every, *_ = angle
    (before,) = chain.cuts
    (after,) = proposals.ease_cut(chain, 1, every).cuts
    by = 0.25 * (before.margin_reject - proposals.MARGINS[-1])
    assert after.device.reach == pytest.approx(before.device.reach - by, abs=5e-5)
    assert after.device.leaves == pytest.approx(before.device.leaves + by, abs=5e-5)
    assert after.margin_pass > before.margin_pass and after.margin_reject > 0.0


def test_one_at_which_the_wanted_part_is_lost_in_draws_goes_back(angle, chain):
    every, wanted, _ = angle
    worst = lost(every[wanted].name, end_at(Fate.RETURNED, "silhouette blade"), row=wanted).counted_in_draws(
        2, 20
    )
    changed = proposals.mend_proposal(chain, SimpleNamespace(wanted=[wanted]), every, worst)
    assert changed.cuts[0].device.reach < chain.cuts[0].device.reach


def test_it_is_not_moved_beyond_what_it_leaves():
    blade = make_device("silhouette blade", "test", limit=6e-3, reach=5e-3, leaves=6e-3, sweep=0.5)
    assert blade.cutting_more(6e-4) is None and blade.cutting_more(-5.1e-3) is None
    assert blade.cutting_more(2e-4).reach == pytest.approx(5.2e-3)
    assert make_device("gap", "test", limit=6e-3).cutting_more(1e-3) is None
