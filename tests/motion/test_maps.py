"""Grids over two quantities, and the sliding map against [4.27] and its own regimes."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from feederscrew import bowl
from feederscrew.base.geometry import grids
from feederscrew.motion import limits
from feederscrew.motion.slide import sliding_map

DEG = math.pi / 180.0


def slide(beta, *overrides, **how):
    return sliding_map(bowl.read(None, overrides), beta * DEG, **how)


def test_a_grid_is_a_long_table():
    first = grids.GridAxis("angle_deg", np.radians([0.0, 90.0]), DEG)
    second = grids.GridAxis("ratio", np.array([1.0, 2.0, 3.0]))

    def function(angle, ratio):
        return {"product": np.cos(angle) * ratio, "regime": (ratio > 1) * 1}

    columns = grids.evaluate(first, second, function, ("low", "high")).columns()
    assert columns["angle_deg"].tolist() == pytest.approx([0, 0, 0, 90, 90, 90])
    assert columns["ratio"].tolist() == [1, 2, 3, 1, 2, 3]
    assert columns["product"].tolist() == pytest.approx([1, 2, 3, 0, 0, 0])
    assert columns["regime"].tolist() == ["low", "high", "high"] * 2


@given(st.floats(0.5, 89.0))
@settings(max_examples=20, deadline=None)
def test_mu_limit_is_4_27_below_the_hop_and_nothing_past_it_and_a_map_reaches_over_the_published_range(beta):
    grid = slide(beta).grid
    assert min(grid.shares()["hop"], slide(90).grid.shares()["hop"]) > 0.1
    assert grid.first.in_unit[[0, -1]] == pytest.approx([-90, 90])
    assert grid.second.values[0] == 0.0 and grid.second.values[-1] >= 3.0
    columns = grid.columns()
    ratio, angle = columns["acceleration_ratio"], columns["alpha_minus_theta_deg"] * DEG
    hop = ratio * math.sin(beta * DEG) >= 1 - 1e-9
    assert np.isnan(columns["mu_limit"][hop]).all() and (columns["regime"][hop] == "hop").all()
    published = ratio * math.cos(beta * DEG) * np.cos(angle) / (1 - ratio * math.sin(beta * DEG))
    assert columns["mu_limit"][~hop] == pytest.approx(published[~hop], rel=1e-9, abs=1e-12)


def test_as_published_keeps_what_is_negative_and_a_reversed_drive_swaps_forward_and_backward():
    complete, published = (slide(20, as_published=flag).grid for flag in (False, True))
    limit, printed = (grid.values["mu_limit"] for grid in (complete, published))
    assert np.nanmin(limit) == 0.0 and published.unanswered("mu_limit") == 0
    at_pole_angle = np.isclose(np.abs(complete.first.in_unit), 90, rtol=1e-12, atol=0)
    assert (printed[(complete.codes == limits.HOP) & ~at_pole_angle[:, None]] < 0).all()
    assert (printed == limit)[~np.isnan(limit)].all()
    # a reversed drive swaps forward and backward on a level track
    grid = slide(25, "drive.direction=180 deg", "track.climb=0 deg", "friction.static=0.4").grid
    ahead, reversed_ = (np.flatnonzero(np.isclose(grid.first.in_unit, angle))[0] for angle in (0, 180))
    swap = np.array([limits.RIDE, limits.BACKWARD, limits.FORWARD, limits.BOTH, limits.HOP])
    assert (grid.codes[ahead] == swap[grid.codes[reversed_]]).all()
    assert np.isnan(grid.values["mu_limit"][reversed_]).all()


@given(st.floats(0.0, 90.0), st.floats(0.05, 2.0))
@settings(max_examples=30, deadline=None)
def test_the_surface_rises_from_zero_to_its_cut(beta, highest):
    sliding = slide(beta)
    top = sliding.grid.second.values[-1]
    angles, ratios, friction = sliding.sheet(highest)
    assert (friction[:, 0] == 0).all() and friction.max() <= highest
    assert (np.diff(friction, axis=1) >= 0).all() and ratios.max() <= top
    middle = len(angles) // 2
    if sliding.level_line(highest, angles[middle, 0]) < top and beta < 89.0:
        assert friction[middle, -1] == pytest.approx(highest, rel=1e-9)
