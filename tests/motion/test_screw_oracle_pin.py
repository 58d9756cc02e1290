"""Our screws against pinocchio's; runs where `pin` is installed (it is too heavy to depend on)."""

import numpy as np
import pytest

from feederscrew.motion.screws import ORIGIN, Body, Momentum, Point, Twist, Wrench, force_screw

pin = pytest.importorskip("pinocchio")
pytestmark = [pytest.mark.filterwarnings("ignore::DeprecationWarning"), pytest.mark.needs("pinocchio")]


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


@pytest.mark.parametrize("size", [1e-9, 1.0, 1e9])
def test_products_momentum_and_dual_euler(size):
    rng = np.random.default_rng(3)
    for _ in range(20):
        twist, other, momentum = draw(Twist, rng, size), draw(Twist, rng, size), draw(Momentum, rng, size)
        wrench, rate = draw(Wrench, rng, size), draw(Twist, rng, size**2)
        bulk = np.linalg.norm(motion(twist).vector) * np.linalg.norm(force(wrench).vector)
        wanted = motion(twist).dot(force(wrench))
        assert twist.reciprocal(wrench) == pytest.approx(wanted, rel=0, abs=1e-12 * bulk)
        bracket = twist.cross(other)
        agree(Twist(bracket.resultant, bracket.moment, bracket.reference), motion(twist).cross(motion(other)))
        agree(twist.cross(momentum), motion(twist).cross(force(momentum)))
        arms = rng.normal(size=(3, 3))
        body = Body(rng.uniform(0.5, 2.0), arms @ arms.T + np.eye(3), Point("G", rng.normal(size=3)))
        theirs = pin.Inertia(body.mass, body.centre.coordinates, np.array(body.inertia))
        agree(body.momentum(twist), theirs * motion(twist))
        gyroscopic = theirs.vxiv(motion(twist))
        agree(force_screw(body, twist, rate), theirs * motion(rate) + gyroscopic)
