"""Limits of slip and hop against the thesis's formula, published examples and a search over the cycle."""

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from feederscrew import bowl as bowls
from feederscrew.base.errors import ConfigError
from feederscrew.motion import limits

DEG = np.pi / 180.0
OFTEN = settings(max_examples=150, deadline=None)
FRICTIONS = st.floats(0.0, 2.0)


def angles(low, high):
    return st.floats(low, high).map(lambda angle: angle * DEG)


RATIOS, BETAS, HEADINGS, CLIMBS = (
    st.floats(0.0, 6.0), angles(0.0, 90.0), angles(-180.0, 180.0), angles(-20.0, 20.0),
)  # fmt: skip


def test_published_examples():
    """Eqs. [4.27], [4.28]: beta 30 deg, G = 1 gives cos 30 / (1 - 1/2) = sqrt(3)."""
    wanted = {(1.0, 0.0): np.sqrt(3.0), (1.0, 60.0): np.sqrt(3.0) / 2, (4.0, 0.0): -2.0 * np.sqrt(3.0)}
    for (ratio, heading), limit in wanted.items():
        assert limits.published_limit(ratio, 30 * DEG, heading * DEG) == pytest.approx(limit, rel=1e-14)
    friction, climb, beta = 0.8, 3 * DEG, 30 * DEG
    forward = limits.forward_ratio(friction, beta, climb=climb)
    backward = limits.backward_ratio(friction, beta, climb=climb)
    assert limits.throw_number(forward, beta, climb) == pytest.approx(0.3366, abs=5e-5)
    assert limits.throw_number(backward, beta, climb) == pytest.approx(0.8021, abs=5e-5)
    assert limits.throw_number(limits.hop_ratio(beta, climb), beta, climb) == pytest.approx(1.0, rel=1e-15)
    least = np.arctan2(np.sin(climb), np.cos(climb) * friction**2)  # steeper drives slip forward first
    assert least / DEG == pytest.approx(4.68, abs=5e-3)


@pytest.mark.parametrize(("heading", "climb", "slip"), [(0.0, 3, "forward"), (np.pi, -3, "backward")])
def test_regimes_of_one_row_and_at_a_limit(heading, climb, slip):
    codes = limits.regimes(np.array([0.2, 0.6, 1.2, 3.0]), 30 * DEG, 0.5, heading, climb=climb * DEG)
    assert [limits.POINT_REGIMES[code] for code in codes] == ["stick", slip, "both", "hop"]
    friction = float(limits.forward_limit(0.6, 30 * DEG))
    assert limits.regimes(0.6, 30 * DEG, friction) == limits.RIDE
    assert limits.regimes(0.6, 30 * DEG, np.nextafter(friction, 0.0)) == limits.FORWARD
    assert 2.0 * np.sin(30 * DEG) < 1.0  # the hop itself hops in spite of rounding
    assert limits.regimes(2.0, 30 * DEG, 0.5) == limits.HOP
    assert np.isnan(limits.forward_limit(2.0, 30 * DEG))


@given(RATIOS, BETAS, HEADINGS, CLIMBS)
@OFTEN
def test_limits_are_the_worst_instant_of_the_cycle(ratio, beta, heading, climb):
    """Of normal force and what drives the part up; a reversed drive on the reversed climb swaps them."""
    s = np.sin(np.linspace(0.0, 2.0 * np.pi, 721))
    normal = np.cos(climb) - ratio * s * np.sin(beta)
    drive = ratio * s * np.cos(beta) * np.cos(heading) - np.sin(climb)
    assume(normal.min() > 1e-6)
    forward = limits.forward_limit(ratio, beta, heading, climb)
    assert forward == pytest.approx((drive / normal).max(), rel=1e-9, abs=1e-9)
    backward = limits.backward_limit(ratio, beta, heading, climb)
    assert backward == pytest.approx((-drive / normal).max(), rel=1e-9, abs=1e-9)
    reversed_drive = limits.backward_limit(ratio, beta, heading + np.pi, -climb)
    assert forward == pytest.approx(reversed_drive, rel=1e-6, abs=1e-9)


@given(FRICTIONS, BETAS, HEADINGS, CLIMBS)
@OFTEN
def test_slip_starts_where_its_limit_meets_the_friction(friction, beta, heading, climb):
    where = (beta, heading, climb)
    pairs = (limits.forward_ratio, limits.forward_limit), (limits.backward_ratio, limits.backward_limit)
    for onset, limit in pairs:
        ratio = float(onset(friction, *where))
        assume(ratio < 1e6)
        lightest = np.cos(climb) - ratio * np.sin(beta)
        if ratio == 0.0:
            assert limit(0.0, *where) >= friction - 1e-12
        elif lightest > 1e-6:
            assert limit(ratio, *where) == pytest.approx(friction, rel=1e-6, abs=1e-9)
            assert limit(ratio * 0.99, *where) <= friction + 1e-9


@given(RATIOS, BETAS, angles(-89.0, 89.0))
@OFTEN
def test_level_forward_limit_is_the_published_one_below_the_hop(ratio, beta, heading):
    """Eq. [4.27]."""
    assume(ratio * np.sin(beta) < 0.999)
    published = limits.published_limit(ratio, beta, heading)
    assert limits.forward_limit(ratio, beta, heading) == pytest.approx(published, rel=1e-12, abs=1e-15)


@pytest.mark.parametrize(
    ("override", "fault"),
    [
        ("drive.phase=20 deg", "drive.phase: is not 0, and this command knows a straight harmonic drive"),
        ("drive.second_harmonic=0.1", "drive.second_harmonic: is not 0"),
        ("friction.static_backward=0.9", "friction.static_backward: is not friction.static"),
    ],
)
def test_a_bowl_that_only_the_kernel_knows(override, fault):
    with pytest.raises(ConfigError, match=fault):
        limits.plain(bowls.read(None, [override]))


@given(FRICTIONS, FRICTIONS, angles(0.0, 80.0), CLIMBS, st.floats(0.1, 30.0))
@settings(max_examples=100, deadline=None)
def test_effective_friction_is_that_of_both_normals(friction, wall, bank, climb, push):
    """What floor and wall press with against a force square to the tangent, by their normals in space."""
    tangent = np.array([np.cos(climb), 0.0, np.sin(climb)])
    inward, square = np.array([0.0, 1.0, 0.0]), np.array([-np.sin(climb), 0.0, np.cos(climb)])
    floor = np.cos(bank) * square - np.sin(bank) * inward  # leans to the wall, since it falls towards it
    assert abs(tangent @ floor) < 1e-15
    columns = np.array([[floor @ square, 0.0], [floor @ inward, 1.0]])
    on_floor, on_wall = np.linalg.solve(columns, [push, 0.0])
    assert on_floor > 0.0 and on_wall > -1e-12
    held = friction * on_floor + wall * on_wall
    assert limits.effective(friction, wall, bank) * push == pytest.approx(held, rel=1e-12, abs=1e-12)
    assert limits.of_floor(held / push, wall, bank) == pytest.approx(friction, rel=1e-9, abs=1e-12)
