"""Rocking over two sides against closed forms."""

from dataclasses import replace

import numpy as np
import pytest
import shapes

from feederscrew import bowl as bowls
from feederscrew.rates import tipping
from feederscrew.rates.tipping import ROCKING_STEPS, Rocker, goes_over, seat_in_groove
from feederscrew.resting.aspects import find
from feederscrew.tooling.orientations import gyration, orientations

PERIOD = 1.0 / 60.0
STEADY = Rocker(
    near=2e-3, far=3e-3, height=10e-3, spread=4e-5,
    force=np.full(ROCKING_STEPS, 9.81), offset=np.zeros(ROCKING_STEPS),
)  # fmt: skip


@pytest.mark.parametrize(
    ("offset", "over"), [(1.99e-3, False), (2.01e-3, True), (-2.99e-3, False), (-3.01e-3, True)]
)
def test_a_steady_force_turns_a_part_over_from_its_sides_on(offset, over):
    assert goes_over(replace(STEADY, offset=np.full(ROCKING_STEPS, offset)), PERIOD) == over


@pytest.mark.parametrize("share", [0.97, 1.03])
def test_one_push_turns_it_over_from_the_rate_that_lifts_the_centre_of_mass(share, monkeypatch):
    """From the rate W the tilt is W T sinh(t / T) - r / h (cosh(t / T) - 1): it turns if W < r / (h T)."""
    count, step = 4000, 1e-4
    monkeypatch.setattr(tipping, "ROCKING_STEPS", count)
    monkeypatch.setattr(tipping, "FOLLOWED", 1)
    moment = STEADY.spread + STEADY.near**2 + STEADY.height**2
    time = np.sqrt(moment / (9.81 * STEADY.height))
    rate = share * STEADY.near / (STEADY.height * time)
    offset = np.zeros(count)
    offset[0] = rate / step * moment / 9.81 + STEADY.near
    pushed = replace(STEADY, force=np.full(count, 9.81), offset=offset)
    assert goes_over(pushed, count * step) == (share > 1.0)


def test_a_part_that_comes_down_on_its_other_side_keeps_less_of_its_rate(monkeypatch):
    """Pushed to 0.97 of what turns it over the near side, it does not go over the nearer other side."""
    moment = STEADY.spread + STEADY.near**2 + STEADY.height**2
    kept = (STEADY.spread + STEADY.height**2 - STEADY.near**2) / moment
    assert 0.9 < kept < 1.0
    count, step = 8000, 1e-4
    monkeypatch.setattr(tipping, "ROCKING_STEPS", count)
    monkeypatch.setattr(tipping, "FOLLOWED", 1)
    rate = 0.97 * STEADY.near / STEADY.height * np.sqrt(9.81 * STEADY.height / moment)
    offset = np.zeros(count)
    offset[0] = rate / step * moment / 9.81 + STEADY.near
    for far, over in ((STEADY.near, False), (0.8 * STEADY.near, True)):
        pushed = replace(STEADY, far=far, force=np.full(count, 9.81), offset=offset)
        assert goes_over(pushed, count * step) == over


def test_a_pin_on_the_track_rocks_with_its_own_inertia():
    """The gyration about a side is that of the box; near and far sides are half its width away."""
    part, bowl = shapes.part(shapes.box(10, 10, 40)), bowls.read(None, [])
    upright = next(one for one in orientations(part, find(part), bowl.track) if one.height > 0.03)
    found = tipping.rocker(seat_in_groove(upright, 0.0), lambda angle: gyration(upright, angle), bowl)
    assert (found.near, found.far) == pytest.approx((5e-3, 5e-3), rel=1e-9)
    assert found.spread == pytest.approx((0.01**2 + 0.04**2) / 12.0, rel=1e-9)
    assert np.all(found.force >= 0.0) and found.force.mean() == pytest.approx(9.81, rel=0.02)


def test_a_part_that_gains_support_in_time_comes_back():
    """A force 0.1 mm beyond the near side turns it over, but not where that side moves on past the force."""
    pushed = replace(STEADY, offset=np.full(ROCKING_STEPS, 2.1e-3))
    assert goes_over(pushed, PERIOD) and not goes_over(replace(pushed, growth=0.1), PERIOD)
    assert goes_over(replace(pushed, growth=1e-5), PERIOD, start=ROCKING_STEPS // 2)
    grown = [replace(pushed, growth=growth) for growth in np.geomspace(1e-4, 0.1, 60)]
    over = [goes_over(one, PERIOD) for one in grown]
    assert 10 < sum(over) < 50
    assert all([goes_over(one, PERIOD, start=k) for one in grown] == over for k in (7, ROCKING_STEPS // 2))
