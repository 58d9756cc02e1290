"""A banked track with an upright wall against forces split by vectors."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from feederscrew import bowl as bowls
from feederscrew.mechanics import limits

DEG = np.pi / 180.0
frictions = st.floats(0.0, 2.0)
banks = st.floats(0.0, 80.0).map(lambda angle: angle * DEG)
climbs = st.floats(-20.0, 20.0).map(lambda angle: angle * DEG)


def shared(bank, climb, push):
    """What floor and wall press with against a force square to the tangent, by their normals in space."""
    tangent = np.array([np.cos(climb), 0.0, np.sin(climb)])
    inward, square = np.array([0.0, 1.0, 0.0]), np.array([-np.sin(climb), 0.0, np.cos(climb)])
    floor = np.cos(bank) * square - np.sin(bank) * inward  # leans to the wall, since it falls towards it
    assert abs(tangent @ floor) < 1e-15
    columns = np.array([[floor @ square, 0.0], [floor @ inward, 1.0]])
    return np.linalg.solve(columns, [push, 0.0])


@given(frictions, frictions, banks, climbs, st.floats(0.1, 30.0))
@settings(max_examples=100, deadline=None)
def test_effective_friction_is_that_of_both_normals(friction, wall, bank, climb, push):
    on_floor, on_wall = shared(bank, climb, push)
    assert on_floor > 0.0 and on_wall > -1e-12
    held = friction * on_floor + wall * on_wall
    assert limits.effective(friction, wall, bank) * push == pytest.approx(held, rel=1e-12, abs=1e-12)
    assert limits.of_floor(held / push, wall, bank) == pytest.approx(friction, rel=1e-9, abs=1e-12)


def test_the_level_bowl_of_a_banked_one():
    here = bowls.read(
        None,
        ["friction.static=0.4", "friction.kinetic=0.3", "friction.wall=0.8", "track.bank=12 deg",
         "friction.static_backward=0.6", "friction.kinetic_backward=0.5"],
    )  # fmt: skip
    level = limits.level(here)
    assert level.friction.static == pytest.approx(0.57898, abs=5e-6)
    assert level.friction.kinetic == pytest.approx(0.57898 - 0.1 / np.cos(12 * DEG), abs=5e-6)
    assert level.friction.backward == pytest.approx((0.57898 + 0.2 / np.cos(12 * DEG), 0.681216), abs=5e-6)
    assert level.track == replace(here.track, bank=0.0)
    assert limits.level(level).friction == level.friction
    assert (level.drive, level.restitution, level.gravity) == (here.drive, here.restitution, here.gravity)
