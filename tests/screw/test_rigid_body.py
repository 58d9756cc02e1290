"""Momentum screw and dual Euler equation against sums over particles and the thesis; contacts of a block."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from screw_samples import few, grid, near, random_screws, same, sizes

from feederscrew.screw import ORIGIN, Body, Point, Twist, Wrench, force_screw, reactions, tipping_twists

seeds = st.integers(0, 10**6)


def cloud(rng, count=9):
    """Heavy points and the body they make; every formula below is checked against plain sums over them."""
    masses, places = rng.uniform(0.1, 1.0, size=count), rng.normal(size=(count, 3))
    centre = masses @ places / masses.sum()
    arms = places - centre
    inertia = np.einsum("n,nij->ij", masses, (arms**2).sum(-1)[:, None, None] * np.eye(3))
    inertia -= np.einsum("n,ni,nj->ij", masses, arms, arms)
    return masses, places, Body(masses.sum(), inertia, Point("G", centre))


@few
@given(seeds)
def test_momentum_screw_is_the_sum_over_the_particles(seed):
    """Eqs. [2.1] to [2.4]."""
    rng = np.random.default_rng(seed)
    masses, places, body = cloud(rng)
    twist = random_screws(rng, Twist)
    arms = places - twist.reference.coordinates
    speeds = twist.velocity + np.cross(twist.angular_velocity, arms)
    momentum = body.momentum(twist)
    near(momentum.linear, masses @ speeds, 10.0)
    near(momentum.angular, masses @ np.cross(arms, speeds), 30.0)
    same(body.momentum(twist.at(ORIGIN)), momentum)
    near(twist.reciprocal(momentum), (masses * (speeds**2).sum(-1)).sum(), 50.0)  # twice the kinetic energy


@few
@given(seeds)
def test_dual_euler_is_newton_and_euler_for_every_particle(seed):
    """Eq. [4.6], at any point of the body; its power is the rate of the kinetic energy."""
    rng = np.random.default_rng(seed)
    masses, places, body = cloud(rng)
    twist, rate = random_screws(rng, Twist), random_screws(rng, Twist)
    spin, turn = twist.angular_velocity, rate.angular_velocity
    arms = places - twist.reference.coordinates
    start = rate.at(twist.reference).velocity + np.cross(spin, twist.velocity)  # acceleration of A itself
    accelerations = start + np.cross(turn, arms) + np.cross(spin, np.cross(spin, arms))
    forces = masses[:, None] * accelerations
    wrench = force_screw(body, twist, rate)
    near(wrench.force, forces.sum(0), 100.0)
    near(wrench.moment, np.cross(arms, forces).sum(0), 300.0)
    same(force_screw(body, twist.at(body.centre), rate), wrench, reach=300.0)
    near(twist.reciprocal(wrench), rate.reciprocal(body.momentum(twist)), 300.0)


def test_at_the_centre_of_mass_it_is_newton_and_euler_written_out():
    """Eqs. [4.4] to [4.6]. The print swaps the momenta in w x q + eps (w x H + v x q)."""
    rng = np.random.default_rng(11)
    *_, body = cloud(rng)
    (w, v), (dw, dv) = rng.normal(size=(2, 2, 3))
    wrench = force_screw(body, Twist(w, v, body.centre), Twist(dw, dv, body.centre))
    near(wrench.force, body.mass * (dv + np.cross(w, v)))
    near(wrench.moment, body.inertia @ dw + np.cross(w, body.inertia @ w))


MASS, SPIN, TURN = 1.982e-3, 3.7, -52.0  # [kg], theta' [rad/s], theta'' [rad/s2]
SPEED, RATE = np.array([0.11, -0.07]), np.array([-1.9, 2.3])  # [m/s], [m/s2] along the two axes of the floor
INERTIAS = {  # of the thesis's two parts [g mm2]: I_yx and I_zx are their products
    "arc_chute": [[95.32, 0.0, -24.48], [0.0, 109.57, 0.0], [-24.48, 0.0, 114.75]],
    "magnet": [[755.91, -10.91, 0.0], [-10.91, 755.09, 0.0], [0.0, 0.0, 49.92]],
}


def printed_screws(inertia, upright):
    """Momentum, twist (x) momentum and the rest of the force screw, turning clockwise about one axis."""
    level = [axis for axis in range(3) if axis != upright]
    (spin, speed), (turn, rate) = np.zeros((2, 2, 3))
    spin[upright], turn[upright] = -SPIN, -TURN
    speed[level], rate[level] = SPEED, RATE
    centre = Point("C", np.zeros(3))
    body, twist = Body(MASS, inertia, centre), Twist(spin, speed, centre)
    momentum = body.momentum(twist)
    centripetal = twist.cross(momentum)
    return momentum, centripetal, force_screw(body, twist, Twist(turn, rate, centre)) - centripetal


@pytest.mark.parametrize("part", INERTIAS)
def test_on_the_floor_and_on_the_track(part):
    """X upright: eqs. [4.7] to [4.12] of the Arc Chute, eqs. [4.38] to [4.42] of the Magnet.

    On the track X and Z change places: eqs. [4.30], [4.31] and [4.55], [4.56]. [4.56] prints the terms with
    theta' with the other sign than [4.31]; a wall makes them zero.
    """
    inertia = 1e-9 * np.array(INERTIAS[part])
    (i_xx, i_yx, i_zx), (v_1, v_2), (a_1, a_2) = inertia[0], SPEED, RATE
    momentum, centripetal, rate = printed_screws(inertia, 0)
    np.testing.assert_allclose(momentum.linear, MASS * np.array([0.0, v_1, v_2]), rtol=1e-15)
    np.testing.assert_allclose(momentum.angular, -SPIN * inertia[0], rtol=1e-15)
    np.testing.assert_allclose(centripetal.force, MASS * SPIN * np.array([0, v_2, -v_1]), rtol=1e-14)
    np.testing.assert_allclose(centripetal.moment, SPIN**2 * np.array([0, -i_zx, i_yx]), rtol=1e-14)
    np.testing.assert_allclose(rate.force, MASS * np.array([0.0, a_1, a_2]), rtol=1e-14)
    np.testing.assert_allclose(rate.moment, -TURN * np.array([i_xx, i_yx, i_zx]), rtol=1e-12, atol=1e-22)
    _, centripetal, rate = printed_screws(inertia[::-1, ::-1], 2)
    np.testing.assert_allclose(centripetal.force, MASS * SPIN * np.array([v_2, -v_1, 0.0]), rtol=1e-14)
    np.testing.assert_allclose(rate.force, MASS * np.array([a_1, a_2, 0.0]), rtol=1e-14)
    np.testing.assert_allclose(rate.moment, -TURN * np.array([i_zx, i_yx, i_xx]), rtol=1e-12, atol=1e-22)


@pytest.mark.parametrize(
    ("mass", "inertia", "says"),
    [
        (0.0, np.eye(3), r"^mass is 0.0, not a positive number$"),
        (1.0, np.diag([1.0, 1.0, -1.0]), r"^inertia is not symmetric and positive definite$"),
        (1.0, [[1, 0.1, 0], [0, 1, 0], [0, 0, 1]], r"^inertia is not symmetric and positive definite$"),
        (1.0, np.ones((2, 3)), r"^inertia has shape \(2, 3\), not \(\.\.\., 3, 3\)$"),
    ],
)
def test_wrong_bodies(mass, inertia, says):
    with pytest.raises(ValueError, match=says):
        Body(mass, inertia, ORIGIN)


def block(size=1.0):
    """Three floor points, two on a long wall at y = 0, one end stop at x = 0; all contacts at floor level."""
    places = size * np.array([(1, 1, 0), (5, 1, 0), (3, 4, 0), (1, 0, 0), (5, 0, 0), (0, 2, 0)], dtype=float)
    inward = [(0, 0, 1)] * 3 + [(0, 1, 0)] * 2 + [(1, 0, 0)]
    return places, Wrench.on_axis(places, inward)


@pytest.mark.parametrize("size", [1e-9, 1e-3, 1e9])
def test_a_block_tips_about_the_line_through_its_other_floor_points(size):
    places, contacts = block(size)
    twists = tipping_twists(contacts)
    for lifted, (first, second) in enumerate([(1, 2), (0, 2), (0, 1)]):
        line = places[second] - places[first]
        unit = line / np.linalg.norm(line)
        axis = twists[lifted].axis
        near(np.cross(axis.direction, unit), np.zeros(3), 1.0)
        near(np.cross(axis.foot - places[first], unit), np.zeros(3), 10 * size)
        near(twists[lifted].pitch, 0.0, size)
    assert twists[5].pitch == np.inf  # off its end stop a block slides
    np.testing.assert_allclose(twists[5].velocity, [1, 0, 0], atol=1e-12)
    products = twists[:, None].reciprocal(contacts)
    assert (np.diag(products) > 0.1 * min(size, 1.0)).all()  # each opens its own contact, and no other
    near(products - np.diag(np.diag(products)), np.zeros((6, 6)), 10.0 * max(size, 1.0))


@few
@given(seeds, sizes, sizes)
def test_reactions_balance_the_external_wrench(seed, force, lever):
    rng = np.random.default_rng(seed)
    contacts = Wrench.on_axis(lever * rng.normal(size=(6, 3)), rng.normal(size=(6, 3)))
    external = Wrench(force * rng.normal(size=3), force * lever * rng.normal(size=3))
    pushes = reactions(contacts, external)
    left = (pushes * contacts).sum() + external
    near(left.resultant, np.zeros(3), 10 * np.abs(pushes).max())
    near(left.moment, np.zeros(3), 30 * np.abs(pushes).max() * lever)


@few
@given(grid, grid)
def test_a_reaction_vanishes_as_the_load_reaches_its_tipping_axis(x, along):
    places, contacts = block()

    def load(place):
        return Wrench.on_axis(place, (0, 0, -1.0))

    near(reactions(contacts, 9.0 * load(places[:3].mean(axis=0))), [3, 3, 3, 0, 0, 0])
    edge = places[0] + along * (places[1] - places[0])
    near(reactions(contacts, load(edge))[2], 0.0, 30.0)
    assert reactions(contacts, load(edge - (0, 1.0, 0)))[2] < 0.0


def test_reactions_of_a_batch_are_those_of_its_rows():
    rng = np.random.default_rng(10)
    contacts = Wrench(*rng.normal(size=(2, 4, 6, 3)), Point("P", rng.normal(size=(4, 6, 3))))
    external = random_screws(rng, Wrench, 4)
    moving = Wrench(external.resultant, external.moment, Point("G", rng.normal(size=(4, 3))))
    for load in (external, moving):
        together = reactions(contacts, load)
        assert together.shape == (4, 6)
        for i in range(4):
            near(together[i], reactions(contacts[i], load[i]), 10 * np.abs(together[i]).max())


def test_contacts_that_do_not_hold_the_body():
    _, contacts = block()
    doubled = contacts[[0, 1, 2, 3, 4, 4]]
    with pytest.raises(ValueError, match=r"^1 of 1 sets of six wrenches are not independent$"):
        tipping_twists(doubled)
    with pytest.raises(ValueError, match=r"^there are 5 wrenches, not six$"):
        reactions(contacts[:5], Wrench((0, 0, 1), (0, 0, 0)))
    with pytest.raises(ValueError, match=r"^wrenches need an axis that counts them"):
        tipping_twists(contacts[0])
