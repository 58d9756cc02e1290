"""Limits of slip and hop against the thesis's formula, published examples and a search over the cycle."""

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from feederscrew import bowl as bowls
from feederscrew.errors import ConfigError
from feederscrew.mechanics import limits

DEG = np.pi / 180.0
ratios = st.floats(0.0, 6.0)
betas = st.floats(0.0, 90.0).map(lambda angle: angle * DEG)
headings = st.floats(-180.0, 180.0).map(lambda angle: angle * DEG)
climbs = st.floats(-20.0, 20.0).map(lambda angle: angle * DEG)
frictions = st.floats(0.0, 2.0)


def forces(ratio, beta, heading, climb):
    """Normal force and what drives the part up the track, over its weight, sampled over a cycle."""
    s = np.sin(np.linspace(0.0, 2.0 * np.pi, 721))
    normal = np.cos(climb) - ratio * s * np.sin(beta)
    return normal, ratio * s * np.cos(beta) * np.cos(heading) - np.sin(climb)


def test_published_limit_by_hand():
    """Eqs. [4.27], [4.28]."""
    # beta 30 deg, G = 1: cos 30 / (1 - 1/2) = sqrt(3)
    assert limits.published_limit(1.0, 30 * DEG) == pytest.approx(np.sqrt(3.0), rel=1e-14)
    assert limits.published_limit(1.0, 30 * DEG, 60 * DEG) == pytest.approx(np.sqrt(3.0) / 2, rel=1e-14)
    assert limits.published_limit(4.0, 30 * DEG) == pytest.approx(-2.0 * np.sqrt(3.0), rel=1e-14)


def test_example_of_a_climbing_track():
    friction, climb, beta = 0.8, 3 * DEG, 30 * DEG
    forward = limits.forward_ratio(friction, beta, climb=climb)
    backward = limits.backward_ratio(friction, beta, climb=climb)
    assert limits.throw_number(forward, beta, climb) == pytest.approx(0.3366, abs=5e-5)
    assert limits.throw_number(backward, beta, climb) == pytest.approx(0.8021, abs=5e-5)
    assert limits.throw_number(limits.hop_ratio(beta, climb), beta, climb) == pytest.approx(1.0, rel=1e-15)
    least = np.arctan2(np.sin(climb), np.cos(climb) * friction**2)  # steeper drives slip forward first
    assert least / DEG == pytest.approx(4.68, abs=5e-3)


def test_regimes_of_one_row():
    codes = limits.regimes(np.array([0.2, 0.6, 1.2, 3.0]), 30 * DEG, 0.5, climb=3 * DEG)
    assert [limits.POINT_REGIMES[code] for code in codes] == ["stick", "forward", "both", "hop"]
    turned = limits.regimes(np.array([0.2, 0.6, 1.2, 3.0]), 30 * DEG, 0.5, np.pi, climb=-3 * DEG)
    assert [limits.POINT_REGIMES[code] for code in turned] == ["stick", "backward", "both", "hop"]


def test_friction_at_a_limit_rides():
    friction = float(limits.forward_limit(0.6, 30 * DEG))
    assert limits.regimes(0.6, 30 * DEG, friction) == limits.RIDE
    assert limits.regimes(0.6, 30 * DEG, np.nextafter(friction, 0.0)) == limits.FORWARD


def test_the_hop_itself_hops_in_spite_of_rounding():
    assert 2.0 * np.sin(30 * DEG) < 1.0
    assert limits.regimes(2.0, 30 * DEG, 0.5) == limits.HOP
    assert np.isnan(limits.forward_limit(2.0, 30 * DEG))


@given(ratios, betas, headings, climbs)
@settings(max_examples=150, deadline=None)
def test_limits_are_the_worst_instant_of_the_cycle(ratio, beta, heading, climb):
    normal, drive = forces(ratio, beta, heading, climb)
    assume(normal.min() > 1e-6)
    forward = limits.forward_limit(ratio, beta, heading, climb)
    backward = limits.backward_limit(ratio, beta, heading, climb)
    assert forward == pytest.approx((drive / normal).max(), rel=1e-9, abs=1e-9)
    assert backward == pytest.approx((-drive / normal).max(), rel=1e-9, abs=1e-9)


@given(frictions, betas, headings, climbs)
@settings(max_examples=150, deadline=None)
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


@given(ratios, betas, headings, climbs)
@settings(max_examples=150, deadline=None)
def test_a_reversed_drive_on_a_reversed_climb_swaps_the_limits(ratio, beta, heading, climb):
    forward = limits.forward_limit(ratio, beta, heading, climb)
    backward = limits.backward_limit(ratio, beta, heading + np.pi, -climb)
    assume(np.isfinite(forward) and np.isfinite(backward))
    assert forward == pytest.approx(backward, rel=1e-6, abs=1e-9)


@given(ratios, betas, st.floats(-89.0, 89.0).map(lambda angle: angle * DEG))
@settings(max_examples=150, deadline=None)
def test_level_forward_limit_is_the_published_one_below_the_hop(ratio, beta, heading):
    """Eq. [4.27]."""
    assume(ratio * np.sin(beta) < 0.999)
    published = limits.published_limit(ratio, beta, heading)
    assert limits.forward_limit(ratio, beta, heading) == pytest.approx(published, rel=1e-12, abs=1e-15)


@pytest.mark.parametrize(
    ("override", "fault"),
    [
        (
            "drive.phase=20 deg",
            "drive.phase: is not 0, and this command knows a straight harmonic drive only",
        ),
        ("drive.second_harmonic=0.1", "drive.second_harmonic: is not 0"),
        ("friction.static_backward=0.9", "friction.static_backward: is not friction.static"),
    ],
)
def test_a_bowl_that_only_the_kernel_knows(override, fault):
    with pytest.raises(ConfigError, match=fault):
        limits.plain(bowls.read(None, [override]))
