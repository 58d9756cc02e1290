"""Five numbers decide the velocity, and an elliptical drive at small friction has a closed form."""

import math

import numpy as np
import pytest
import steady_formulas
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scipy.optimize import brentq

from feederscrew.conveying import steady
from feederscrew.conveying.operating_point import Numbers, numbers, with_numbers

DEG = math.pi / 180.0
FRICTIONS = st.floats(0.02, 3.0)
LONGEST = 8  # periods


def velocity(found, friction):
    """Over A w cos(angle), with the status and the period."""
    setting, out = with_numbers(found, friction), np.empty(steady.COLUMNS)
    steady.survey(setting, out)
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
    found = Numbers(coupling, steepness, throw, restitution, phase)
    one, other = (velocity(found, friction) for friction in frictions)
    assert one[1] == other[1]
    assume(one[1] == steady.PERIODIC)  # an average of a chaotic motion is another one after rounding
    assume(one[2] <= LONGEST)  # as is the one that it settles on of many long ones, close to each other
    assert one[0] == pytest.approx(other[0], rel=0, abs=1e-9)


def test_numbers_of_a_setting_come_back():
    found = Numbers(0.2, 0.3, 1.5, 0.1, 0.7)
    assert numbers(with_numbers(found, 0.4)) == pytest.approx(found)
    with pytest.raises(ValueError, match="coupling"):
        with_numbers(found._replace(coupling=0.0), 0.4)


@pytest.mark.parametrize(
    ("throw", "steepness", "want"),
    [(1.0, 0.0, 0.67361), (0.8, 0.0, 0.59810), (0.5, 0.0, 0.43513), (1.0, 0.35, 0.37017)],
)
def test_elliptical_drive_at_small_friction(throw, steepness, want):
    """cos a with a + k sin a = (pi/2)(1 + tan(climb)/mu), reached as the coupling falls."""
    level = steady_formulas.elliptical_velocity(throw, steepness)
    assert level == pytest.approx(want, abs=5e-6)
    a = brentq(lambda a: a + throw * math.sin(a) - 0.5 * math.pi * (1.0 + steepness), 0.0, math.pi)
    assert level == pytest.approx(math.cos(a), rel=1e-12)
    errors = []
    for coupling in (0.01, 0.001, 0.0001):
        there, status, _ = velocity(Numbers(coupling, steepness, throw * (1 - 1e-9), 0.0, -90 * DEG), 0.3)
        assert status == steady.PERIODIC
        errors.append(abs(there - level))
    assert errors[2] < 1e-3 * level
    assert errors[2] < errors[1] < errors[0]
    back, *_ = velocity(Numbers(0.0001, -steepness, throw * (1 - 1e-9), 0.0, 90 * DEG), 0.3)
    assert back == pytest.approx(-level, abs=1e-3)


@pytest.mark.parametrize("throw", [1.0, math.nextafter(1.0, 2.0), 1.0 + 1e-15, 1.0 + 1e-12, 1.0 + 1e-9])
def test_a_throw_number_of_one_is_no_jump(throw):
    """A hop too short to be told from none changes nothing."""
    for coupling in np.geomspace(0.02, 1.0, 25):
        just, below = (velocity(Numbers(coupling, 0.0, k, 0.0), 0.3)[0] for k in (throw, 1.0 - 1e-9))
        assert just == pytest.approx(below, abs=1e-6)
