"""The event integration against every steady motion that has a formula."""

import math

import numpy as np
import pytest
import steady_formulas

from feederscrew.conveying import answer, steady
from feederscrew.conveying.operating_point import FLIGHT, FORWARD, checked, law, plain
from feederscrew.conveying.point_motion import land
from feederscrew.conveying.waves import PERIOD_RAD, Wave, gain, harmonic, onward, reached, travel, value
from feederscrew.mechanics import limits

DEG = math.pi / 180.0


def travel_of(setting):
    """The row of results of one setting."""
    out = np.empty(steady.COLUMNS)
    steady.survey(setting, out)
    return out


def thrown_at(throw, angle=30 * DEG, climb=0.0, friction=0.3, restitution=0.0):
    return plain(throw * math.cos(climb) / math.sin(angle), angle, climb, friction, restitution)


@pytest.mark.parametrize(
    ("ratio", "beta", "climb", "friction"),
    [(0.5, 30, 0, 0.3), (0.5, 30, 3, 0.3), (1.0, 30, 3, 0.8), (0.35, 30, 6, 0.3), (0.9, 20, 2, 0.6)],
)
def test_two_burst_velocity(ratio, beta, climb, friction):
    wanted = steady_formulas.two_burst_velocity(ratio, beta * DEG, climb * DEG, friction)
    found = travel_of(plain(ratio, beta * DEG, climb * DEG, friction))
    assert found[steady.STATUS] == steady.PERIODIC
    assert found[steady.PERIOD] == 1
    assert found[steady.VELOCITY] == pytest.approx(wanted, rel=0, abs=1e-14)


@pytest.mark.parametrize(("periods", "throw"), [(0.5, 1.368461), (1, 3.296908), (2, 6.362265), (3, 9.477681)])
def test_throw_number_of_a_whole_flight(periods, throw):
    assert answer.throw_of_flight(periods) == pytest.approx(throw, abs=5e-7)


@pytest.mark.parametrize("periods", [0.01, 0.1, 0.5, 0.9, 0.999])
def test_flight_of_a_throw_number(periods):
    found = travel_of(thrown_at(answer.throw_of_flight(periods)))
    assert found[steady.FLIGHT_TIME] == pytest.approx(periods, rel=1e-12)


@pytest.mark.parametrize("above", [1e-4, 1e-6, 1e-8, 1e-10])
def test_grazing_flight(above):
    found = travel_of(thrown_at(1.0 + above, climb=2 * DEG))
    assert found[steady.FLIGHT_TIME] == pytest.approx(steady_formulas.grazing_flight(1.0 + above), rel=above)


@pytest.mark.parametrize("periods", [0.3, 0.7, 1.0])
@pytest.mark.parametrize("climb", [0.0, 3 * DEG])
def test_ideal_throw(periods, climb):
    angle = 30 * DEG
    throw = answer.throw_of_flight(periods)
    setting = thrown_at(throw, angle, climb, friction=1e12)
    velocity = steady_formulas.ideal_throw_velocity(
        periods, angle, climb, frequency=1.0 / PERIOD_RAD, gravity=1.0
    )
    # with w = g = 1 the amplitude is the ratio itself
    assert travel_of(setting)[steady.VELOCITY] == pytest.approx(velocity / setting.ratio, rel=1e-9)


@pytest.mark.parametrize(
    ("restitution", "low", "high"),
    [(0.0, math.pi, 3.7242), (0.2, 2.094, 2.544), (0.3, 1.692, 2.127), (0.5, 1.047, 1.527)],
)
def test_regular_bounce_lives_within_its_window(restitution, low, high):
    window = steady_formulas.bounce_window(1, restitution)
    assert window == pytest.approx((low, high), abs=6e-4)
    inside = (0.05, 0.5, 0.9) if restitution else ()
    for share in inside:
        assert settles_on_one_period(window[0] + share * (window[1] - window[0]), restitution)
    if restitution:
        assert not settles_on_one_period(window[1] * 1.01, restitution)


def settles_on_one_period(throw, restitution):
    """Whether a start a little off the regular bounce comes to a flight of one period."""
    rules, out = law(thrown_at(throw, restitution=restitution)), np.empty(steady.COLUMNS)
    steady.steady(rules, steady.thrown(rules, 0), out)
    return out[steady.PERIOD] == 1 and out[steady.FLIGHT_TIME] == pytest.approx(1.0, rel=1e-9)


def bisected(happens, low, high):
    while high - low > 2e-16 * high:
        middle = 0.5 * (low + high)
        if middle in (low, high):
            break
        low, high = (low, middle) if happens(middle) else (middle, high)
    return high


@pytest.mark.parametrize(("beta", "climb", "friction"), [(30, 3, 0.8), (15, 0, 0.3), (40, 5, 0.5)])
def test_thresholds_by_bisection(beta, climb, friction):
    def share(phase):
        return lambda ratio: (
            travel_of(plain(ratio, beta * DEG, climb * DEG, friction))[steady.FRACTIONS + phase] > 0
        )

    where = {"beta": beta * DEG, "climb": climb * DEG}
    assert bisected(share(1), 0.01, 3.0) == pytest.approx(
        float(limits.forward_ratio(friction, **where)), rel=1e-14
    )
    assert bisected(share(2), 0.01, 3.0) == pytest.approx(
        float(limits.backward_ratio(friction, **where)), rel=1e-14
    )
    assert bisected(share(3), 0.01, 8.0) == pytest.approx(float(limits.hop_ratio(**where)), rel=1e-14)


def test_bristles_carry_a_part_that_is_shaken_along_the_track_only():
    even = plain(0.8, 0.0, 0.0, 0.4)
    assert travel_of(even)[steady.VELOCITY] == pytest.approx(0.0, abs=1e-14)
    assert travel_of(even._replace(static=0.2, kinetic=0.2))[steady.VELOCITY] > 0.01


def test_several_velocities_at_one_setting():
    found = travel_of(thrown_at(1.712, 20 * DEG, restitution=0.3))
    assert found[steady.LOW] == pytest.approx(0.149, abs=2e-3)
    assert found[steady.HIGH] == pytest.approx(0.929, abs=2e-3)


def test_landing_keeps_to_the_friction_cone():
    rules = law(plain(2.0, 0.6, 0.0, 0.3, 0.5))
    after = land(rules, 0.0, 1.0, 0.4)
    assert (after.phase, after.rising) == (FLIGHT, 0.2)
    assert after.speed == pytest.approx(1.0 - 0.3 * 1.5 * 0.4)
    assert land(rules, 0.0, -0.1, 0.4).speed == 0.0


def test_a_last_bounce_passes_on_a_plastic_impulse():
    rules = law(plain(0.5, 0.3, 0.0, 0.3, 0.5))
    after = land(rules, 0.0, 1.0, 1e-9)
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


def test_series_of_short_spans_keep_their_digits():
    arc = onward(harmonic(Wave(0.0, 1.0, 0.0, 0.0, 0.0)), 0.0)  # sin: its twofold integral is x - sin x
    assert travel(arc, 1e-4) == pytest.approx(1e-12 / 6.0, rel=1e-8)
    assert travel(arc, 0.5) == pytest.approx(travel(arc, math.nextafter(0.5, 1.0)), rel=1e-14)


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
