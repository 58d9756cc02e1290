"""Whether there is a steady state: states and thresholds on both sides, and motions that settle slowly."""

import math

import numpy as np
import pytest

from feederscrew.conveying import steady
from feederscrew.conveying.operating_point import FLIGHT, FORWARD, STICK, OperatingPoint, law, plain
from feederscrew.conveying.point_motion import TALLY, at_rest, turn

DEG = math.pi / 180.0


def surveyed(setting):
    out = np.empty(steady.COLUMNS)
    steady.survey(setting, out)
    return out


def sticky(ratio, angle, climb, static, kinetic, restitution=0.0):
    """Unbanked, with a kinetic friction of its own; angles in degrees."""
    here = plain(ratio, angle * DEG, climb * DEG, static, restitution)
    return here._replace(kinetic=kinetic, kinetic_back=kinetic)


def speeds(setting, count):
    """Speed along the track at the start of each period [A w]."""
    rules = law(setting)
    state, tally, found = at_rest(rules), np.zeros(TALLY), []
    for _ in range(count):
        state = turn(rules, state, tally)
        found.append(state.speed)
    return np.array(found)


def test_between_kinetic_and_static_friction_a_gentle_drive_lets_it_ride():
    found = surveyed(sticky(0.1812, 30, 6, 0.6, 0.08))
    assert found[steady.STATUS] == steady.PERIODIC
    assert found[steady.VELOCITY] == 0.0
    assert found[steady.FRACTIONS + STICK] == pytest.approx(1.0)
    assert found[steady.RUNAWAY] == 1.0  # pushed, it slides down: the climb is steeper than kinetic friction


def test_between_kinetic_and_static_friction_a_part_may_stick_and_slip_up():
    found = surveyed(sticky(0.773, 38.6, 7.6, 0.581, 0.057))
    assert found[steady.VELOCITY] == pytest.approx(0.264, abs=2e-3)
    assert found[steady.FRACTIONS + STICK] == pytest.approx(0.47, abs=1e-2)
    assert found[steady.FRACTIONS + FORWARD] == pytest.approx(0.53, abs=1e-2)


@pytest.mark.parametrize(("beyond", "status"), [(-1e-3, steady.PERIODIC), (1e-3, steady.NO_STEADY_STATE)])
def test_both_sides_of_one_friction(beyond, status):
    """With static and kinetic friction alike, climbs up to the angle of friction have a steady state."""
    setting = plain(0.9, 30 * DEG, math.atan(0.3 * (1.0 + beyond)), 0.3)
    assert surveyed(setting)[steady.STATUS] == status
    assert surveyed(setting)[steady.RUNAWAY] == float(beyond > 0.0)


def test_both_sides_of_one_friction_where_the_part_flies():
    """An impact passes on what the weight would have in the time of the flight: tan(climb) still decides."""
    climb, held, lost = 0.1, *(math.tan(0.1) * share for share in (1.01, 0.99))
    assert surveyed(plain(4.0, 30 * DEG, climb, held))[steady.FRACTIONS + FLIGHT] > 0.5
    assert surveyed(plain(4.0, 30 * DEG, climb, held))[steady.STATUS] == steady.PERIODIC
    assert surveyed(plain(4.0, 30 * DEG, climb, lost))[steady.STATUS] == steady.NO_STEADY_STATE
    late = speeds(plain(4.0, 30 * DEG, climb, lost), 3000)[-100:]
    assert (np.diff(late) < 0.0).all()


def test_a_velocity_that_keeps_growing_is_no_average():
    """A motion without a period along the normal, which runs away by its trend."""
    setting = OperatingPoint(2.96, 30 * DEG, 5.6 * DEG, 0.1, 0.09, 0.1, 0.09, 0.7)
    assert surveyed(setting)[steady.STATUS] == steady.NO_STEADY_STATE
    held = surveyed(setting._replace(climb=2 * DEG))
    assert held[steady.STATUS] == steady.AVERAGED
    assert held[steady.RUNAWAY] == 0.0


def test_a_frictionless_level_track_decides_no_velocity():
    assert surveyed(plain(0.5, 30 * DEG, 0.0, 0.0))[steady.STATUS] == steady.NO_STEADY_STATE


@pytest.mark.parametrize("friction", [0.02, 0.002, 0.0002])
def test_a_start_from_rest_that_settles_slowly_settles(friction):
    """The speed that closes in over thousands of periods is a fixed point, found at once."""
    setting = plain(0.9 / math.sin(5 * DEG), 5 * DEG, 0.0, friction)._replace(lead=-1.2)
    rules = law(setting)
    state, period = steady.settle(rules, at_rest(rules))
    assert period == 1
    assert turn(rules, state, np.zeros(TALLY)).speed == pytest.approx(state.speed, rel=0, abs=1e-12)
    other = at_rest(rules)._replace(speed=-state.speed)
    again, _ = steady.settle(rules, other._replace(phase=2 if other.speed < 0.0 else 1))
    assert again.speed == pytest.approx(state.speed, rel=0, abs=1e-8)


def patient(setting):
    """Velocity after 1,500 periods without any leap, over 96 more: a multiple of every period to 4, 6, 8."""
    rules = law(setting)
    state, tally = at_rest(rules), np.zeros(TALLY)
    for _ in range(1500):
        state = turn(rules, state, tally)
    tally = np.zeros(TALLY)
    for _ in range(96):
        state = turn(rules, state, tally)
    return tally[0] / (96 * 2.0 * math.pi)


@pytest.mark.parametrize("seed", range(3))
def test_leaps_lead_where_patience_does(seed):
    """Where friction is even, the speed leaps to where it tends; it must be where it goes without a leap."""
    rng = np.random.default_rng(seed)
    for restitution in (0.0, 0.3):
        friction, angle = rng.uniform(0.05, 0.4), rng.uniform(0.1, 1.2)
        ratio = rng.uniform(0.8, 3.5) / math.sin(angle)
        setting = plain(ratio, angle, rng.uniform(0.0, 0.03), friction, restitution)
        found = surveyed(setting)
        if found[steady.STATUS] == steady.PERIODIC and 96 % found[steady.PERIOD] == 0:
            assert found[steady.VELOCITY] == pytest.approx(patient(setting), rel=0, abs=1e-9)


def test_no_leap_out_of_a_steady_slide():
    """Speeds that fall by the same each period make no series to be summed: the slide ends where it ends."""
    setting = plain(7.48549979, 0.2197702, 0.1607226, 0.20579626, 0.3)
    assert surveyed(setting)[steady.VELOCITY] == pytest.approx(-0.09144, abs=1e-6)


def test_a_further_start_joins_what_is_known():
    setting = plain(2.5, 0.5, 0.02, 0.3, 0.3)
    rules = law(setting)
    state, period = steady.settle(rules, at_rest(rules))
    known = []
    for _ in range(period):
        state = turn(rules, state, np.zeros(TALLY))
        known.append(steady.noted(state))
    _, joined = steady.follow(rules, at_rest(rules), np.array(known), steady.TRANSIENT)
    assert joined == steady.JOINS
    alone, other = np.empty(steady.COLUMNS), surveyed(setting)
    velocities = []
    for start in range(7):
        thrown = steady.thrown(rules, start)
        if thrown.rising > 0.0:
            steady.steady(rules, thrown, alone)
            velocities.append(alone[steady.VELOCITY])
    assert other[steady.LOW] == pytest.approx(min(*velocities, other[steady.VELOCITY]), abs=1e-9)
    assert other[steady.HIGH] == pytest.approx(max(*velocities, other[steady.VELOCITY]), abs=1e-9)
