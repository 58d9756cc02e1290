"""Our displacements and screws against scipy's, which is always installed: exponentials and rigid motions."""

import numpy as np
import pytest
from scipy.linalg import expm, logm

from feederscrew.screw import (
    ORIGIN,
    Body,
    Displacement,
    Point,
    Twist,
    Wrench,
    displacement,
    finite_twist,
    force_screw,
)

seeds = pytest.mark.parametrize("seed", range(10))


def hat(w):
    """The matrix of a cross product with w."""
    return np.array([[0.0, -w[2], w[1]], [w[2], 0.0, -w[0]], [-w[1], w[0], 0.0]])


def matrix(twist):
    """A twist as the 4 x 4 matrix whose exponential is its displacement."""
    twist = twist.at(ORIGIN)
    out = np.zeros((4, 4))
    out[:3, :3], out[:3, 3] = hat(twist.angular_velocity), twist.velocity
    return out


def draw(kind, rng, size=1.0):
    return kind(*(size * rng.normal(size=(2, 3))), Point("P", rng.normal(size=3)))


def both(screw):
    screw = screw.at(ORIGIN)
    return np.concatenate([screw.resultant, screw.moment])


@seeds
@pytest.mark.parametrize("angle", [1e-6, 0.1, 1.0, 3.0])
def test_a_displacement_is_the_exponential_of_its_twist_and_back(seed, angle):
    twist = draw(Twist, np.random.default_rng(seed))
    twist = Twist(angle * twist.direction, twist.moment, twist.reference)
    wanted = expm(matrix(twist))
    np.testing.assert_allclose(displacement(twist).matrix, wanted, rtol=0, atol=1e-12)
    back = finite_twist(Displacement(wanted[:3, :3], wanted[:3, 3]))
    np.testing.assert_allclose(matrix(back), logm(wanted).real, rtol=0, atol=1e-9)


@seeds
def test_a_moved_twist_is_its_matrix_between_the_motion_and_its_inverse(seed):
    rng = np.random.default_rng(seed)
    moved, twist = displacement(draw(Twist, rng)), draw(Twist, rng)
    wanted = moved.matrix @ matrix(twist) @ np.linalg.inv(moved.matrix)
    np.testing.assert_allclose(matrix(moved @ twist), wanted, rtol=0, atol=1e-12)


@seeds
def test_power_does_not_depend_on_where_both_are_moved_to(seed):
    rng = np.random.default_rng(seed)
    moved, twist, wrench = displacement(draw(Twist, rng)), draw(Twist, rng), draw(Wrench, rng)
    force, moment = np.split(both(wrench), 2)
    power = force @ twist.at(ORIGIN).velocity + moment @ twist.at(ORIGIN).angular_velocity
    assert twist.reciprocal(wrench) == pytest.approx(power, rel=1e-12)
    assert (moved @ twist).reciprocal(moved @ wrench) == pytest.approx(power, rel=0, abs=1e-11)


@seeds
def test_the_bracket_of_twists_is_that_of_their_matrices(seed):
    rng = np.random.default_rng(seed)
    a, b = draw(Twist, rng), draw(Twist, rng)
    bracket = a.cross(b)
    found = Twist(bracket.resultant, bracket.moment, bracket.reference)
    wanted = matrix(a) @ matrix(b) - matrix(b) @ matrix(a)
    np.testing.assert_allclose(matrix(found), wanted, rtol=0, atol=1e-12)


@seeds
def test_momentum_and_force_are_summed_over_the_points_of_a_body(seed):
    """Points of a rigid body, their momenta and their mass times acceleration, moments about the origin."""
    rng = np.random.default_rng(seed)
    places, masses = rng.normal(size=(7, 3)), rng.uniform(0.1, 1.0, 7)
    centre = masses @ places / masses.sum()
    arms = places - centre
    inertia = sum(m * ((r @ r) * np.eye(3) - np.outer(r, r)) for m, r in zip(masses, arms))
    body = Body(masses.sum(), inertia, Point("G", centre))
    twist, rate = draw(Twist, rng), draw(Twist, rng)
    w, v = twist.at(ORIGIN).angular_velocity, twist.at(ORIGIN).velocity
    wdot, vdot = rate.at(ORIGIN).angular_velocity, rate.at(ORIGIN).velocity
    speeds = v + np.cross(w, places)
    momentum = masses[:, None] * speeds
    total = np.concatenate([momentum.sum(axis=0), np.cross(places, momentum).sum(axis=0)])
    np.testing.assert_allclose(both(body.momentum(twist)), total, rtol=1e-10, atol=1e-12)
    gain = masses[:, None] * (vdot + np.cross(wdot, places) + np.cross(w, speeds))
    total = np.concatenate([gain.sum(axis=0), np.cross(places, gain).sum(axis=0)])
    np.testing.assert_allclose(both(force_screw(body, twist, rate)), total, rtol=1e-10, atol=1e-11)
