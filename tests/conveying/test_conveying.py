"""The event integration against every steady motion that has a formula."""

import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scipy.optimize import brentq

from feederscrew.conveying import answer, steady
from feederscrew.conveying.operating_point import (
    FLIGHT,
    FORWARD,
    Numbers,
    checked,
    law,
    numbers,
    plain,
    with_numbers,
)
from feederscrew.conveying.point_motion import land
from feederscrew.conveying.waves import PERIOD_RAD, Wave, gain, harmonic, onward, reached, travel, value
from feederscrew.mechanics import limits

DEG = math.pi / 180.0
ROUNDING = 4.0 * np.finfo(float).eps
FRICTIONS = st.floats(0.02, 3.0)


def travel_of(setting):
    """The row of results of one setting."""
    out = np.empty(steady.COLUMNS)
    steady.survey(setting, out)
    return out


def thrown_at(throw, angle=30 * DEG, climb=0.0, friction=0.3, restitution=0.0):
    return plain(throw * math.cos(climb) / math.sin(angle), angle, climb, friction, restitution)


def burst(p):
    """Start and end [rad] of a slip of relative acceleration sin t - p, and its way over 2 pi."""
    if p >= 1.0:
        return math.inf, -math.inf, 0.0
    start = math.asin(p)
    end = brentq(
        lambda t: math.cos(start) - math.cos(t) - p * (t - start), math.pi - start, start + 2.0 * math.pi,
        xtol=1e-15, rtol=ROUNDING,
    )  # fmt: skip
    span = end - start
    way = math.sin(start) - math.sin(end) + math.cos(start) * span - 0.5 * p * span * span
    return start, end, way / (2.0 * math.pi)


@pytest.mark.parametrize(
    ("ratio", "beta", "climb", "friction"),
    [(0.5, 30, 0, 0.3), (0.5, 30, 3, 0.3), (1.0, 30, 3, 0.8), (0.35, 30, 6, 0.3), (0.9, 20, 2, 0.6)],
)
def test_two_burst_velocity(ratio, beta, climb, friction):
    """A part slips forward once, back once, and sticks in between: p is onset ratio / ratio of each slip."""
    where = {"beta": beta * DEG, "climb": climb * DEG}
    start, end, forward = burst(float(limits.forward_ratio(friction, **where)) / ratio)
    start_back, end_back, backward = burst(float(limits.backward_ratio(friction, **where)) / ratio)
    assert end <= math.pi + start_back and math.pi + end_back <= 2.0 * math.pi + start  # no slip runs on
    push, lift = math.cos(beta * DEG), friction * math.sin(beta * DEG)
    out = travel_of(plain(ratio, beta * DEG, climb * DEG, friction))
    assert (out[steady.STATUS], out[steady.PERIOD]) == (steady.PERIODIC, 1)
    wanted = (push + lift) * forward - (push - lift) * backward
    assert out[steady.VELOCITY] == pytest.approx(wanted, rel=0, abs=1e-14)


@pytest.mark.parametrize(("periods", "throw"), [(0.5, 1.368461), (1, 3.296908), (2, 6.362265), (3, 9.477681)])
def test_throw_number_of_a_whole_flight(periods, throw):
    assert answer.throw_of_flight(periods) == pytest.approx(throw, abs=5e-7)


@pytest.mark.parametrize("above", [1e-4, 1e-6, 1e-8, 1e-10])
def test_grazing_flight(above):
    """Just above throw number 1 it lasts 4 sqrt(2 (throw - 1)); the error is of higher order."""
    periods = 4.0 * math.sqrt(2.0 * (1.0 + above - 1.0)) / (2.0 * math.pi)
    assert travel_of(thrown_at(1.0 + above, climb=2 * DEG))[steady.FLIGHT_TIME] == pytest.approx(
        periods, rel=above
    )


@pytest.mark.parametrize("periods", [0.3, 0.7, 1.0])
@pytest.mark.parametrize("climb", [0.0, 3 * DEG])
def test_ideal_throw(periods, climb):
    """A part grips on landing: v = g p^2 cos(angle + climb) / (2 f sin(angle)), with w = g = 1."""
    angle = 30 * DEG
    setting = thrown_at(answer.throw_of_flight(periods), angle, climb, friction=1e12)
    velocity = 0.5 * periods**2 * PERIOD_RAD * math.cos(angle + climb) / math.sin(angle)
    assert travel_of(setting)[steady.VELOCITY] == pytest.approx(velocity / setting.ratio, rel=1e-9)


@pytest.mark.parametrize(
    ("e", "low", "high"),
    [(0.0, math.pi, 3.7242), (0.2, 2.094, 2.544), (0.3, 1.692, 2.127), (0.5, 1.047, 1.527)],
)
def test_regular_bounce_lives_within_its_window(e, low, high):
    """Throw numbers where a part goes on bouncing with a flight of one period, from a start a little off."""
    least = math.pi * (1.0 - e) / (1.0 + e)
    most = math.hypot(least, 2.0 * (1.0 + e * e) / (1.0 + e) ** 2)
    assert (least, most) == pytest.approx((low, high), abs=6e-4)
    for throw in (*(least + share * (most - least) for share in (0.05, 0.5, 0.9)), most * 1.01) if e else ():
        rules, out = law(thrown_at(throw, restitution=e)), np.empty(steady.COLUMNS)
        steady.steady(rules, steady.thrown(rules, 0), out)
        settles = out[steady.PERIOD] == 1 and out[steady.FLIGHT_TIME] == pytest.approx(1.0, rel=1e-9)
        assert settles == (throw < most)


@pytest.mark.parametrize(("beta", "climb", "friction"), [(30, 3, 0.8), (15, 0, 0.3), (40, 5, 0.5)])
def test_thresholds_by_bisection(beta, climb, friction):
    where = {"beta": beta * DEG, "climb": climb * DEG}
    wanted = (limits.forward_ratio(friction, **where), limits.backward_ratio(friction, **where),
              limits.hop_ratio(**where))  # fmt: skip
    for phase, limit in enumerate(wanted, 1):
        low, high = 0.01, 8.0
        while low < 0.5 * (low + high) < high:
            middle = 0.5 * (low + high)
            out = travel_of(plain(middle, beta * DEG, climb * DEG, friction))
            low, high = (low, middle) if out[steady.FRACTIONS + phase] > 0 else (middle, high)
        assert high == pytest.approx(float(limit), rel=1e-14)


def test_bristles_landings_and_several_velocities():
    even = plain(0.8, 0.0, 0.0, 0.4)
    assert travel_of(even)[steady.VELOCITY] == pytest.approx(0.0, abs=1e-14)
    assert travel_of(even._replace(static=0.2, kinetic=0.2))[steady.VELOCITY] > 0.01
    out = travel_of(thrown_at(1.712, 20 * DEG, restitution=0.3))
    assert (out[steady.LOW], out[steady.HIGH]) == pytest.approx((0.149, 0.929), abs=2e-3)
    rules = law(plain(2.0, 0.6, 0.0, 0.3, 0.5))
    after = land(rules, 0.0, 1.0, 0.4)
    assert (after.phase, after.rising) == (FLIGHT, 0.2)
    assert after.speed == pytest.approx(1.0 - 0.3 * 1.5 * 0.4)
    assert land(rules, 0.0, -0.1, 0.4).speed == 0.0
    # A last bounce passes on a plastic impulse.
    after = land(law(plain(0.5, 0.3, 0.0, 0.3, 0.5)), 0.0, 1.0, 1e-9)
    assert (after.phase, after.rising) == (FORWARD, 0.0)
    assert 1.0 - after.speed == pytest.approx(0.3e-9, rel=1e-6)


@pytest.mark.parametrize("twofold", [(0.0, 0.0), (0.3, -0.4), (1.1, 0.2)])
def test_integrals_of_a_harmonic(twofold):
    a = harmonic(Wave(-0.3, 0.7, 0.5, *twofold))
    for span in (1e-5, 1e-2, 0.499, 0.501, 3.0):
        t, w = np.polynomial.legendre.leggauss(40)
        t = 0.5 * span * (t + 1.0)
        values = np.array([value(a, 1.1 + x) for x in t])
        arc = onward(a, 1.1)
        assert gain(arc, span) == pytest.approx(0.5 * span * values @ w, rel=1e-12)
        assert travel(arc, span) == pytest.approx(0.5 * span * ((span - t) * values) @ w, rel=1e-12)
        assert reached(arc, span) == pytest.approx(value(a, 1.1 + span), abs=1e-15)
    assert value(a, a.rises[0]) == pytest.approx(0.0, abs=4e-15)
    assert value(a, a.rises[0] + 0.1) > 0.0 > value(a, a.falls[0] + 0.1)


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        ({"ratio": 0.0}, "amplitude is zero"),
        ({"kinetic": 0.7}, "kinetic friction is above static"),
        ({"kinetic_back": 0.7}, "kinetic friction is above static"),
        ({"restitution": 1.0}, "restitution"),
        ({"angle": 1.6}, "vibration angle"),
        ({"kinetic_back": -0.1}, "negative"),
        ({"climb": math.nan}, "not finite"),
    ],
)
def test_settings_that_are_no_track(change, reason):
    with pytest.raises(ValueError, match=reason):
        checked(plain(1.0, 0.5, 0.0, 0.4)._replace(**change))


def velocity(five, friction):
    """Over A w cos(angle), with the status and the period."""
    setting = with_numbers(five, friction)
    out = travel_of(setting)
    return out[steady.VELOCITY] / math.cos(setting.angle), out[steady.STATUS], out[steady.PERIOD]


@settings(max_examples=60, deadline=None, derandomize=True)
@given(
    coupling=st.floats(0.01, 2.0),
    steepness=st.floats(-0.9, 0.9),
    throw=st.floats(0.05, 4.0),
    restitution=st.sampled_from([0.0, 0.0, 0.3]),
    phase=st.floats(-math.pi, math.pi),
    frictions=st.tuples(FRICTIONS, FRICTIONS),
)
def test_velocity_depends_on_five_numbers_only(coupling, steepness, throw, restitution, phase, frictions):
    five = Numbers(coupling, steepness, throw, restitution, phase)
    assert numbers(with_numbers(five, frictions[0])) == pytest.approx(five)
    one, other = (velocity(five, friction) for friction in frictions)
    assert one[1] == other[1]
    assume(one[1] == steady.PERIODIC)  # an average of a chaotic motion is another one after rounding
    assume(one[2] <= 8)  # periods: of many long ones, close to each other, it may settle on another
    assert one[0] == pytest.approx(other[0], rel=0, abs=1e-9)


@pytest.mark.parametrize(
    ("throw", "steepness", "want"),
    [(1.0, 0.0, 0.67361), (0.8, 0.0, 0.59810), (0.5, 0.0, 0.43513), (1.0, 0.35, 0.37017)],
)
def test_elliptical_drive_at_small_friction(throw, steepness, want):
    """cos a with a + k sin a = (pi/2)(1 + tan(climb)/mu), reached as the coupling falls."""
    a = brentq(lambda a: a + throw * math.sin(a) - 0.5 * math.pi * (1.0 + steepness), 0.0, math.pi)
    level, errors = math.cos(a), []
    assert level == pytest.approx(want, abs=5e-6)
    for coupling in (0.01, 0.001, 0.0001):
        there, status, _ = velocity(Numbers(coupling, steepness, throw * (1 - 1e-9), 0.0, -90 * DEG), 0.3)
        assert status == steady.PERIODIC
        errors.append(abs(there - level))
    assert 1e-3 * level > errors[2] < errors[1] < errors[0]
    back, *_ = velocity(Numbers(0.0001, -steepness, throw * (1 - 1e-9), 0.0, 90 * DEG), 0.3)
    assert back == pytest.approx(-level, abs=1e-3)
    with pytest.raises(ValueError, match="coupling"):
        with_numbers(Numbers(0.0, steepness, throw, 0.0), 0.4)


@pytest.mark.parametrize("throw", [1.0, math.nextafter(1.0, 2.0), 1.0 + 1e-15, 1.0 + 1e-12, 1.0 + 1e-9])
def test_a_throw_number_of_one_is_no_jump(throw):
    """A hop too short to be told from none changes nothing."""
    for coupling in np.geomspace(0.02, 1.0, 25):
        just, below = (velocity(Numbers(coupling, 0.0, k, 0.0), 0.3)[0] for k in (throw, 1.0 - 1e-9))
        assert just == pytest.approx(below, abs=1e-6)
