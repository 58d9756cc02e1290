"""Our screws against pinocchio's; runs where `pin` is installed (it is too heavy to depend on)."""

import numpy as np
import pytest

from feederscrew.screw import (
    ORIGIN,
    Body,
    Displacement,
    Momentum,
    Point,
    Twist,
    Wrench,
    displacement,
    finite_twist,
    force_screw,
)

pin = pytest.importorskip("pinocchio")
pytestmark = [pytest.mark.filterwarnings("ignore::DeprecationWarning"), pytest.mark.needs("pinocchio")]

SIZES = [1e-9, 1e-4, 1.0, 1e4, 1e9]
seeds = pytest.mark.parametrize("seed", range(20))
sizes = pytest.mark.parametrize("size", SIZES)


def motion(twist):
    twist = twist.at(ORIGIN)
    return pin.Motion(twist.velocity, twist.angular_velocity)


def force(screw):
    screw = screw.at(ORIGIN)
    return pin.Force(screw.resultant, screw.moment)


def draw(kind, rng, size=1.0):
    return kind(*(size * rng.normal(size=(2, 3))), Point("P", rng.normal(size=3)))


def agree(screw, theirs):
    """Relative to the larger of the two halves: each half mixes the two under a change of reference."""
    ours, theirs = screw.at(ORIGIN), np.concatenate([theirs.angular, theirs.linear])
    if not isinstance(screw, Twist):
        theirs = np.roll(theirs, 3)
    ours = np.concatenate([ours.resultant, ours.moment])
    np.testing.assert_allclose(ours, theirs, rtol=0, atol=1e-12 * np.abs(theirs).max())


@seeds
@sizes
def test_rigid_motion(seed, size):
    rng = np.random.default_rng(seed)
    moved = displacement(draw(Twist, rng))
    theirs = pin.SE3(moved.rotation, moved.translation)
    twist, wrench = draw(Twist, rng, size), draw(Wrench, rng, size)
    agree(moved @ twist, theirs.act(motion(twist)))
    agree(moved @ wrench, theirs.act(force(wrench)))
    agree(moved.inverse() @ wrench, theirs.actInv(force(wrench)))


@seeds
@sizes
def test_reciprocal_product(seed, size):
    rng = np.random.default_rng(seed)
    twist, wrench = draw(Twist, rng, size), draw(Wrench, rng, size)
    wanted = motion(twist).dot(force(wrench))
    bulk = np.linalg.norm(motion(twist).vector) * np.linalg.norm(force(wrench).vector)
    assert twist.reciprocal(wrench) == pytest.approx(wanted, rel=0, abs=1e-12 * bulk)


@seeds
@sizes
def test_dual_cross_product(seed, size):
    rng = np.random.default_rng(seed)
    a, b, momentum = draw(Twist, rng, size), draw(Twist, rng, size), draw(Momentum, rng, size)
    bracket = a.cross(b)
    agree(Twist(bracket.resultant, bracket.moment, bracket.reference), motion(a).cross(motion(b)))
    agree(a.cross(momentum), motion(a).cross(force(momentum)))


@seeds
@pytest.mark.parametrize("angle", [1e-6, 0.1, 1.0, 3.0, np.pi - 1e-9])
def test_exponential_and_logarithm(seed, angle):
    rng = np.random.default_rng(seed)
    twist = draw(Twist, rng)
    twist = Twist(angle * twist.direction, twist.moment, twist.reference)
    theirs = pin.exp6(motion(twist))
    np.testing.assert_allclose(displacement(twist).matrix, theirs.homogeneous, rtol=0, atol=1e-12)
    ours = finite_twist(Displacement(theirs.rotation, theirs.translation))
    agree(ours, pin.log6(theirs))


@seeds
@sizes
def test_momentum_and_dual_euler(seed, size):
    rng = np.random.default_rng(seed)
    arms = rng.normal(size=(3, 3))
    body = Body(rng.uniform(0.5, 2.0), arms @ arms.T + np.eye(3), Point("G", rng.normal(size=3)))
    theirs = pin.Inertia(body.mass, body.centre.coordinates, np.array(body.inertia))
    twist, rate = draw(Twist, rng, size), draw(Twist, rng, size**2)
    agree(body.momentum(twist), theirs * motion(twist))
    gyroscopic = theirs.vxiv(motion(twist))
    agree(force_screw(body, twist, rate), theirs * motion(rate) + gyroscopic)
