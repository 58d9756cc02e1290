"""The event integration against every steady motion that has a formula, and a general solver."""

import math

import numpy as np
import pytest
from conveying_agreement import agreed
from conveying_reference import Reference, random_settings
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scipy.optimize import brentq

from feederscrew.motion import conveying as answer
from feederscrew.motion import limits, operating_point, steady, waves
from feederscrew.motion.limits import effective
from feederscrew.motion.operating_point import FLIGHT, FORWARD, STICK, Numbers, OperatingPoint, law, plain
from feederscrew.motion.point_motion import TALLY, at_rest, land, turn
from feederscrew.motion.waves import PERIOD_RAD, Wave, gain, harmonic, onward, travel, value

DEG = math.pi / 180.0
ROUNDING = 4.0 * np.finfo(float).eps
FRICTIONS = st.floats(0.02, 3.0)
EVERYTHING = plain(1.1, 25 * DEG, 3 * DEG, 0.35)._replace(
    static_back=0.6, kinetic_back=0.5, lead=0.6, second=0.35, second_phase=1.1, second_turn=0.4
)


def travel_of(setting):
    out = np.empty(steady.COLUMNS)
    steady.survey(setting, out, steady.memory())
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
    out = travel_of(thrown_at(1.0 + above, climb=2 * DEG))
    assert out[steady.FLIGHT_TIME] == pytest.approx(periods, rel=above)


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
        steady.steady(rules, steady.thrown(rules, 0), out, steady.memory(), 0, steady.TRANSIENT)
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
        assert waves.reached(arc, span) == pytest.approx(value(a, 1.1 + span), abs=1e-15)
    assert value(a, a.rises[0]) == pytest.approx(0.0, abs=4e-15)
    assert value(a, a.rises[0] + 0.1) > 0.0 > value(a, a.falls[0] + 0.1)


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        ({"ratio": 0.0}, "amplitude is zero"),
        ({"kinetic": 0.7}, "kinetic friction is above static"),
        ({"kinetic_back": 0.7}, "kinetic friction is above static"),
        ({"restitution": 1.0}, "restitution"), ({"angle": 1.6}, "vibration angle"),
        ({"kinetic_back": -0.1}, "negative"), ({"climb": math.nan}, "not finite"),
    ],
)  # fmt: skip
def test_settings_that_are_no_track(change, reason):
    with pytest.raises(ValueError, match=reason):
        operating_point.checked(plain(1.0, 0.5, 0.0, 0.4)._replace(**change))


def velocity(five, friction):
    """Over A w cos(angle), with the status and the period."""
    setting = operating_point.with_numbers(five, friction)
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
    assert operating_point.numbers(operating_point.with_numbers(five, frictions[0])) == pytest.approx(five)
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
        operating_point.with_numbers(Numbers(0.0, steepness, throw, 0.0), 0.4)


@pytest.mark.parametrize("throw", [1.0, math.nextafter(1.0, 2.0), 1.0 + 1e-15, 1.0 + 1e-12, 1.0 + 1e-9])
def test_a_throw_number_of_one_is_no_jump(throw):
    """A hop too short to be told from none changes nothing."""
    for coupling in np.geomspace(0.02, 1.0, 25):
        just, below = (velocity(Numbers(coupling, 0.0, k, 0.0), 0.3)[0] for k in (throw, 1.0 - 1e-9))
        assert just == pytest.approx(below, abs=1e-6)


def random_waves(count):
    rng = np.random.default_rng(4)
    for level, sine, cosine, weight, phase in rng.normal(size=(count, 5)):
        second = math.exp(2.0 * weight)
        yield waves.Wave(level, sine, cosine, second * math.cos(phase), second * math.sin(phase))


def test_zeros_and_bends_are_all_there():
    angles = np.linspace(0.0, PERIOD_RAD, 4001)
    for wave in random_waves(100):
        bends = waves.find_bends(wave)
        for curve, zeros in ((waves.slope(wave), bends), (wave, waves.crossings(wave, bends, 0))):
            zeros = np.array([zero for zero in zeros if zero < np.inf])
            sampled = np.array([waves.height(curve, x) for x in angles]) > 0.0
            changes = angles[np.flatnonzero(sampled[1:] != sampled[:-1])] + 0.5 * angles[1]
            assert len(zeros) == len(changes)
            np.testing.assert_allclose(np.sort(zeros), changes, rtol=0, atol=0.51 * angles[1])
            assert max((abs(waves.height(curve, x)) for x in zeros), default=0.0) < 1e-14 * 1e3
    # Rises and falls alternate, and a touched zero is no crossing.
    crossing = [a for a in map(harmonic, random_waves(60)) if a.rises[0] < math.inf]
    assert len(crossing) > 30
    for a in crossing:
        assert all(waves.above(a, angle) == (value(a, angle) > 0.0) for angle in np.linspace(0.0, 6.2, 32))
    wave = waves.Wave(-1.0, 1.0, 0.0, 0.0, 0.0)  # sin - 1
    assert np.isinf(waves.crossings(wave, waves.find_bends(wave), 0)).all()


def test_a_drive_without_second_harmonic_is_the_plain_one_with_its_closed_forms():
    for row in random_settings(60, np.random.default_rng(6)):
        ratio, angle, climb, friction = row
        own = travel_of(plain(*row, 0.2))
        np.testing.assert_array_equal(own, travel_of(plain(*row, 0.2)._replace(second=0.0, second_phase=1.0)))
        throw = float(limits.throw_number(ratio, angle, climb))
        assert own[steady.THROW] == pytest.approx(throw, rel=1e-14)
        assert own[steady.REGIME] == limits.regimes(ratio, angle, friction, climb=climb)


# Of the last, most are with everything: friction of its own each way, bank and wall, lead, second harmonic.
@pytest.mark.parametrize(
    ("count", "seed", "restitution", "extras", "least"),
    [
        (20, 2, 0.0, 0, 14), (20, 2, 0.3, 0, 14), (12, 3, 0.0, 5, 8), (20, 11, 0.0, 8, 14),
        (20, 11, 0.3, 8, 14),
    ],
)  # fmt: skip
def test_random_settings_agree_with_a_general_solver(count, seed, restitution, extras, least):
    rng, results, hops = np.random.default_rng(seed), [], 0
    low, high = (0, 0, 0, -1, 1, 0.05, -3, -0.5), (0.3, 0.3, 0.3, 1, 2, 0.6, 3, 1.5)
    for ratio, angle, climb, kinetic in random_settings(count, rng):
        drawn = rng.uniform(low[:extras], high[:extras]) if extras else np.array([])
        more, bank, wall, lead, bristles, *second = (*drawn, *(0, 0, 0, 0, 1, 0, 0, 0)[extras:])
        pair, back = (kinetic + more, kinetic), (bristles * kinetic + more, bristles * kinetic)
        ratio /= 1.0 + 4.0 * second[0]
        level = [float(effective(mu, wall, bank)) for mu in (*pair, *back)]
        setting = OperatingPoint(ratio, angle, climb, *level, restitution, lead, *second)
        reference = Reference(ratio, angle, climb, *pair, restitution, bank, wall, lead, back, tuple(second))
        results.append(agreed(setting, reference))
        hops += bool(results[-1]) and travel_of(setting)[steady.HOPS] > 0.0
    assert results.count(True) >= least
    assert results.count(False) == 0
    assert extras < 8 or hops >= 3


def test_compiled_equals_plain_bit_by_bit():
    """A hypotenuse and a power of 2 of the libraries had other last bits: what was printed twice differed."""
    rng = np.random.default_rng(13)
    rows = [
        plain(*row, restitution)._replace(lead=lead, second=share, second_phase=phase, second_turn=turned)
        for row in random_settings(30, rng)
        for restitution in (0.0, 0.4)
        for lead, share, phase, turned in rng.uniform((-3, 0, -3, 0), (3, 1, 3, 1), (2, 4))
    ]
    np.testing.assert_array_equal(
        answer.sweep(np.array(rows)), [travel_of(setting).copy() for setting in rows]
    )


def test_a_second_harmonic_carries_a_part_along_a_level_track():
    """Shaken to and fro, a part stays where it is; a second mode along the track ratchets it either way."""
    even = plain(1.5, 0.0, 0.0, 0.4)
    assert travel_of(even)[steady.VELOCITY] == pytest.approx(0.0, abs=1e-12)

    def both_ways(turned):
        uneven = even._replace(second=0.3, second_turn=turned)
        return [
            travel_of(uneven._replace(second_phase=0.5 * math.pi * way))[steady.VELOCITY] for way in (1, -1)
        ]

    there, back = both_ways(0.0)
    assert abs(there) > 0.05 and back == pytest.approx(-there, rel=1e-12)
    there, back = both_ways(30 * DEG)
    assert there * back < 0.0 and abs(there + back) > 0.02


def test_limits_of_slip_and_hop_of_any_drive():
    """Friction at the limit rides, a little less slips; without extras they are the closed forms."""
    setting = EVERYTHING._replace(ratio=0.5)
    for name, limit, phase in zip(("static", "static_back"), answer.limits_of_slip(setting), (1, 2)):
        held = setting._replace(static=9.0, static_back=9.0, kinetic=0.2, kinetic_back=0.2)
        for factor, slips in ((1.0 + 1e-12, False), (1.0 - 1e-9, True)):
            out = travel_of(held._replace(**{name: limit * factor}))
            assert (out[steady.FRACTIONS + phase] > 0.0) == slips
    without = setting._replace(lead=0.0, second=0.0)
    barely = without._replace(second=1e-300)
    assert answer.limits_of_slip(barely) == pytest.approx(answer.limits_of_slip(without), rel=1e-12)
    setting = EVERYTHING._replace(static=5.0, static_back=5.0)
    throw = travel_of(setting)[steady.THROW]
    for share, hops in ((1.0 - 1e-9, False), (1.0 + 1e-6, True)):
        out = travel_of(setting._replace(ratio=setting.ratio * share / throw))
        assert (out[steady.FRACTIONS + 3] > 0.0) == hops


def sticky(ratio, angle, climb, static, kinetic):
    """Unbanked, with a kinetic friction of its own; angles in degrees."""
    own = plain(ratio, angle * DEG, climb * DEG, static)
    return own._replace(kinetic=kinetic, kinetic_back=kinetic)


def run(rules, state, count):
    """States at the start of each of a number of periods after one, and the sums over them."""
    states, tally = [], np.zeros(TALLY)
    for _ in range(count):
        state = turn(rules, state, tally)
        states.append(state)
    return states, tally


def test_between_kinetic_and_static_friction():
    """A gentle drive lets it ride; pushed, it slides down: the climb is steeper than kinetic friction."""
    out = travel_of(sticky(0.1812, 30, 6, 0.6, 0.08))
    assert (out[steady.STATUS], out[steady.VELOCITY], out[steady.RUNAWAY]) == (steady.PERIODIC, 0.0, 1.0)
    assert out[steady.FRACTIONS + STICK] == pytest.approx(1.0)
    out = travel_of(sticky(0.773, 38.6, 7.6, 0.581, 0.057))  # it sticks, and slips up
    assert out[steady.VELOCITY] == pytest.approx(0.264, abs=2e-3)
    shares = (out[steady.FRACTIONS + STICK], out[steady.FRACTIONS + FORWARD])
    assert shares == pytest.approx((0.47, 0.53), abs=1e-2)
    # An impact passes on what the weight would have in the time of the flight: tan(climb) still decides.
    held, lost = (plain(4.0, 30 * DEG, 0.1, math.tan(0.1) * share) for share in (1.01, 0.99))
    assert travel_of(held)[steady.FRACTIONS + FLIGHT] > 0.5
    assert travel_of(held)[steady.STATUS] == steady.PERIODIC
    assert travel_of(lost)[steady.STATUS] == steady.NO_STEADY_STATE
    late = run(law(lost), at_rest(law(lost)), 3000)[0][-100:]
    assert (np.diff([state.speed for state in late]) < 0.0).all()
    # A motion without a period along the normal runs away by its trend; a frictionless one as well.
    setting = OperatingPoint(2.96, 30 * DEG, 5.6 * DEG, 0.1, 0.09, 0.1, 0.09, 0.7)
    for own in (setting, plain(0.5, 30 * DEG, 0.0, 0.0)):
        assert travel_of(own)[steady.STATUS] == steady.NO_STEADY_STATE
    held = travel_of(setting._replace(climb=2 * DEG))
    assert (held[steady.STATUS], held[steady.RUNAWAY]) == (steady.AVERAGED, 0.0)


@pytest.mark.parametrize("ratio", [0.5, 2.1126, 4.0])
@pytest.mark.parametrize("restitution", [0.0, 0.3])
def test_without_friction_on_the_level_no_velocity_is_steady(ratio, restitution):
    """A force along the track is missing: at 2.1126 it gave -0.906 to 0.906, the plate's own speed."""
    for setting in (plain(ratio, 25 * DEG, 0.0, 0.0, restitution), plain(ratio, 0.0, 0.0, 0.0)):
        out = travel_of(setting)
        assert (out[steady.STATUS], out[steady.RUNAWAY]) == (steady.NO_STEADY_STATE, 1.0)
        assert np.isnan(out[steady.VELOCITY]) and np.isnan(out[steady.LOW])
    # with some friction there is one, with kinetic friction alone missing it holds from rest only
    assert travel_of(plain(ratio, 25 * DEG, 0.0, 1e-3))[steady.RUNAWAY] == 0.0
    held = travel_of(sticky(ratio, 25, 0, 20.0, 0.0))
    assert (held[steady.STATUS], held[steady.RUNAWAY]) == (steady.PERIODIC, 1.0)


@pytest.mark.parametrize("friction", [0.02, 0.002, 0.0002])
def test_a_start_from_rest_that_settles_slowly_settles(friction):
    """The speed that closes in over thousands of periods is a fixed point, found at once."""
    rules = law(plain(0.9 / math.sin(5 * DEG), 5 * DEG, 0.0, friction)._replace(lead=-1.2))
    state, period = steady.settle(rules, at_rest(rules))
    assert period == 1
    assert run(rules, state, 1)[0][0].speed == pytest.approx(state.speed, rel=0, abs=1e-12)
    other = at_rest(rules)._replace(speed=-state.speed)
    again, _ = steady.settle(rules, other._replace(phase=2 if other.speed < 0.0 else 1))
    assert again.speed == pytest.approx(state.speed, rel=0, abs=1e-8)


@pytest.mark.parametrize("seed", range(3))
def test_leaps_lead_where_patience_does(seed):
    """Where friction is even, the speed leaps to where it tends; it must be where it goes without a leap."""
    rng = np.random.default_rng(seed)
    for restitution in (0.0, 0.3):
        friction, angle = rng.uniform(0.05, 0.4), rng.uniform(0.1, 1.2)
        ratio = rng.uniform(0.8, 3.5) / math.sin(angle)
        setting = plain(ratio, angle, rng.uniform(0.0, 0.03), friction, restitution)
        out, rules = travel_of(setting), law(setting)
        if out[steady.STATUS] == steady.PERIODIC and 96 % out[steady.PERIOD] == 0:
            late = run(rules, at_rest(rules), 1500)[0][-1]
            patient = run(rules, late, 96)[1][0] / (96 * 2.0 * math.pi)  # a multiple of most periods
            assert out[steady.VELOCITY] == pytest.approx(patient, rel=0, abs=1e-9)
    # Speeds that fall by the same each period make no series to be summed: the slide ends where it ends.
    slide = plain(7.48549979, 0.2197702, 0.1607226, 0.20579626, 0.3)
    assert travel_of(slide)[steady.VELOCITY] == pytest.approx(-0.09144, abs=1e-6)
