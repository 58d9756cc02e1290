"""Our twists against spatialmath's, where it is right, and where it is not."""

import numpy as np
import pytest

from feederscrew.screw import Displacement, Twist, displacement, finite_twist

spatialmath = pytest.importorskip("spatialmath")
pytestmark = pytest.mark.needs("spatialmath")

SIZES = [1e-9, 1e-3, 1.0, 1e3, 1e9]


def theirs(twist):
    return spatialmath.Twist3(np.concatenate([twist.velocity, twist.angular_velocity]))


def draw(seed):
    return Twist(*np.random.default_rng(seed).normal(size=(2, 3)))


@pytest.mark.parametrize("seed", range(20))
@pytest.mark.parametrize("size", SIZES)
def test_pitch_and_angle(seed, size):
    twist = size * draw(seed)
    other = theirs(twist)
    assert twist.pitch == pytest.approx(other.pitch, rel=1e-12)
    assert twist.magnitude == pytest.approx(other.theta, rel=1e-12, abs=0)


@pytest.mark.parametrize("seed", range(20))
@pytest.mark.parametrize("size", [1e-9, 1e-3, 1.0])
def test_line(seed, size):
    foot = np.ravel(theirs(size * draw(seed)).line().pp)
    ours = (size * draw(seed)).axis.foot
    np.testing.assert_allclose(ours, foot, rtol=0, atol=1e-12 * np.abs(foot).max())


@pytest.mark.parametrize("seed", range(20))
def test_pole_of_a_unit_twist(seed):
    twist = draw(seed).unit()
    np.testing.assert_allclose(
        twist.axis.foot, theirs(twist).pole, rtol=0, atol=1e-12 * np.abs(twist.moment).max()
    )


@pytest.mark.parametrize("seed", range(20))
def test_exponential_and_logarithm(seed):
    twist = draw(seed)
    pose = theirs(twist).exp()
    np.testing.assert_allclose(displacement(twist).matrix, pose.A, rtol=0, atol=1e-12)
    log = finite_twist(Displacement(pose.R, pose.t))
    np.testing.assert_allclose(
        np.r_[log.velocity, log.angular_velocity], pose.log(twist=True), rtol=0, atol=1e-11
    )


@pytest.mark.parametrize("size", [0.5, 2.0, 10.0])
def test_their_pole_moves_with_the_magnitude_of_the_twist(size):
    """They divide w x v by |w| once, not twice: right for unit twists alone. The line cannot depend on it."""
    twist = Twist.on_axis((1, 2, 0), (0, 0, 1), magnitude=size)
    np.testing.assert_allclose(theirs(twist).pole, [size, 2 * size, 0], atol=1e-14)
    np.testing.assert_allclose(twist.axis.foot, [1, 2, 0], atol=1e-14)


def test_their_translations_have_neither_pole_nor_pitch():
    slide = Twist((0, 0, 0), (1, 2, 3))
    with pytest.warns(RuntimeWarning, match="invalid value"):
        assert np.isnan(theirs(slide).pole).all()
    with pytest.warns(RuntimeWarning, match="invalid value"):
        assert np.isnan(theirs(slide).pitch)
    assert slide.pitch == np.inf
    np.testing.assert_allclose(slide.direction, np.array([1, 2, 3]) / np.sqrt(14), rtol=1e-15)


def test_their_line_is_refused_for_a_large_twist():
    """Rounding of a large moment is held against an absolute limit, so a fast turn has no line."""
    twist = 1e9 * draw(0)
    with pytest.raises(ValueError, match="invalid Plucker coordinates"):
        theirs(twist).line()
    np.testing.assert_allclose(twist.axis.foot, draw(0).axis.foot, rtol=1e-12)
