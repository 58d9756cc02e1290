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


def least_forward_angle(friction, climb):
    """Vibration angle [rad] above which growing G brings forward slip before backward slip.

    Holds while the drive points up the track in space, tan(beta) tan(climb) < 1; beyond that no vibration
    slips the part forward.
    """
    return np.arctan2(np.sin(climb), np.cos(climb) * np.square(friction))


def test_acceleration_ratio_of_figure_5_6():
    # 60 Hz and 0.5 mm give A w^2 = 71 m/s2, as the theory of that figure says
    assert limits.acceleration_ratio(0.5e-3, 60.0, 1.0) == pytest.approx(71.06, abs=0.01)


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
    assert least_forward_angle(friction, climb) / DEG == pytest.approx(4.68, abs=5e-3)


def test_no_backward_slip_before_the_hop_on_a_steep_drive():
    assert limits.backward_ratio(1.2, 50 * DEG, climb=3 * DEG) == np.inf
    assert limits.forward_ratio(1.2, 50 * DEG, climb=3 * DEG) < limits.hop_ratio(50 * DEG, 3 * DEG)


def test_a_steeper_track_than_friction_slides_at_rest():
    assert limits.backward_ratio(0.1, 20 * DEG, climb=10 * DEG) == 0.0
    assert limits.POINT_REGIMES[limits.regimes(0.0, 20 * DEG, 0.1, climb=10 * DEG)] == "backward"


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


def test_nothing_hops_without_a_vertical_drive():
    assert limits.hop_ratio(0.0) == np.inf
    assert limits.forward_limit(50.0, 0.0) == limits.backward_limit(50.0, 0.0) == 50.0


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


@given(frictions, st.floats(0.5, 15.0), st.floats(0.5, 88.0))
@settings(max_examples=150, deadline=None)
def test_the_least_forward_angle_parts_which_slip_comes_first(friction, climb, beta):
    climb, beta = climb * DEG, beta * DEG
    least = least_forward_angle(friction, climb)
    assume(abs(beta - least) > 1e-6 and friction > 1.01 * np.tan(climb))
    forward = limits.forward_ratio(friction, beta, 0.0, climb)
    backward = limits.backward_ratio(friction, beta, 0.0, climb)
    if np.tan(beta) * np.tan(climb) < 0.999:
        assert (forward < backward) == (beta > least)
    elif np.tan(beta) * np.tan(climb) > 1.001:
        assert forward == np.inf


@pytest.mark.parametrize(
    ("override", "line"),
    [
        (
            "drive.phase=20 deg",
            "drive.phase: is not 0, and this command knows a straight harmonic drive only"
            " - leave it out, or use feeder convey",
        ),
        (
            "drive.second_harmonic=0.1",
            "drive.second_harmonic: is not 0, and this command knows a straight harmonic drive only"
            " - leave it out, or use feeder convey",
        ),
        (
            "friction.static_backward=0.9",
            "friction.static_backward: is not friction.static, and this command knows one friction both"
            " ways only - leave it out, or use feeder convey",
        ),
    ],
)
def test_a_bowl_that_only_the_kernel_knows(override, line):
    with pytest.raises(ConfigError) as caught:
        limits.plain(bowls.read(None, [override]))
    assert str(caught.value) == line


def test_a_plain_bowl_passes_whatever_follows():
    bowl = bowls.read(None, ["friction.static=0.5", "drive.second_harmonic_phase=30 deg"])
    assert limits.plain(bowl) is bowl
