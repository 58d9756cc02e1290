"""The momentum screw, the dual Euler equation and the spatial triangle."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from screw_samples import few, near, random_screws, same

from feederscrew.screw import (
    ORIGIN,
    Body,
    Dual,
    Momentum,
    Point,
    Twist,
    Wrench,
    dual_angle,
    force_screw,
    spatial_triangle,
    twist_rate,
)

CENTRE = Point("G", (0.4, -0.2, 0.7))
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
    assert type(momentum) is Momentum
    near(momentum.linear, masses @ speeds, 10.0)
    near(momentum.angular, masses @ np.cross(arms, speeds), 30.0)
    same(body.momentum(twist.at(ORIGIN)), momentum)
    near(twist.reciprocal(momentum), (masses * (speeds**2).sum(-1)).sum(), 50.0)  # twice the kinetic energy


@few
@given(seeds)
def test_inertia_about_a_point_is_the_sum_over_the_particles(seed):
    rng = np.random.default_rng(seed)
    masses, places, body = cloud(rng)
    arms = places - np.array([1, 2, 3])
    wanted = np.einsum("n,nij->ij", masses, (arms**2).sum(-1)[:, None, None] * np.eye(3))
    near(
        body.inertia_about(Point("A", (1, 2, 3))),
        wanted - np.einsum("n,ni,nj->ij", masses, arms, arms),
        100.0,
    )


@few
@given(seeds)
def test_dual_euler_is_newton_and_euler_for_every_particle(seed):
    """Eq. [4.6]."""
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


def test_at_the_centre_of_mass_it_is_newton_and_euler_written_out():
    """Eqs. [4.4] to [4.6]."""
    rng = np.random.default_rng(11)
    *_, body = cloud(rng)
    (w, v), (dw, dv) = rng.normal(size=(2, 2, 3))
    wrench = force_screw(body, Twist(w, v, body.centre), Twist(dw, dv, body.centre))
    near(wrench.force, body.mass * (dv + np.cross(w, v)))
    near(wrench.moment, body.inertia @ dw + np.cross(w, body.inertia @ w))


@few
@given(seeds)
def test_every_point_of_the_body_tells_the_same_wrench(seed):
    rng = np.random.default_rng(seed)
    *_, body = cloud(rng)
    twist, rate = random_screws(rng, Twist), random_screws(rng, Twist)
    same(force_screw(body, twist.at(body.centre), rate), force_screw(body, twist, rate), reach=300.0)


@few
@given(seeds)
def test_the_rate_of_the_twist_gives_back_the_wrench(seed):
    rng = np.random.default_rng(seed)
    *_, body = cloud(rng)
    twist, wrench = random_screws(rng, Twist), random_screws(rng, Wrench)
    rate = twist_rate(body, twist, wrench)
    assert rate.reference is twist.reference
    weak = np.linalg.eigvalsh(body.inertia)[0]
    same(force_screw(body, twist, rate), wrench.at(twist.reference), reach=300.0 / weak)


@few
@given(seeds)
def test_power_of_the_wrench_is_the_rate_of_kinetic_energy(seed):
    rng = np.random.default_rng(seed)
    *_, body = cloud(rng)
    twist, rate = random_screws(rng, Twist), random_screws(rng, Twist)
    power = twist.reciprocal(force_screw(body, twist, rate))
    near(power, rate.reciprocal(body.momentum(twist)), 300.0)  # d/dt of V o H / 2


def symmetric_top(equatorial=2.0, polar=3.0, mass=1.5):
    return Body(mass, np.diag([equatorial, equatorial, polar]), CENTRE)


@pytest.mark.parametrize("time", [0.0, 0.4, 3.0])
def test_free_symmetric_top(time):
    """Omega turns about the figure axis at n = (C - A) / A times the spin, with no wrench at all."""
    top, across, spin = symmetric_top(), 0.8, 5.0
    nod = (3.0 - 2.0) / 2.0 * spin
    omega = (across * np.cos(nod * time), across * np.sin(nod * time), spin)
    change = (-nod * across * np.sin(nod * time), nod * across * np.cos(nod * time), 0.0)
    still = (0.0, 0.0, 0.0)
    wrench = force_screw(top, Twist(omega, still, CENTRE), Twist(change, still, CENTRE))
    near(wrench.moment, np.zeros(3), 15.0)
    rate = twist_rate(top, Twist(omega, still, CENTRE), Wrench(still, still, CENTRE))
    near(rate.angular_velocity, change, 5.0)


def test_heavy_top_in_steady_precession():
    """About its fixed tip: M = (C n - A' W cos t) W sin t about the nodal line, n the total axial spin."""
    height, tilt, precession, axial = 0.5, 0.6, 1.3, 7.0
    top = Body(1.5, np.diag([2.0, 2.0, 3.0]), Point("G", (0, 0, height)))
    omega = np.array([0.0, precession * np.sin(tilt), axial])  # components along the nodal frame
    frame = np.array([0.0, precession * np.sin(tilt), precession * np.cos(tilt)])
    change = np.cross(frame - omega, omega)  # body components turn back as the body outruns the frame
    wrench = force_screw(top, Twist(omega, (0, 0, 0)), Twist(change, (0, 0, 0)))
    about_tip = 2.0 + 1.5 * height**2
    wanted = (3.0 * axial - about_tip * precession * np.cos(tilt)) * precession * np.sin(tilt)
    near(wrench.moment, [wanted, 0, 0])
    circle = height * np.sin(tilt) * precession**2  # of the centre of mass, towards the vertical
    near(wrench.force @ [0, np.sin(tilt), np.cos(tilt)], 0.0, 10.0)
    near(np.linalg.norm(wrench.force), 1.5 * circle)


def test_free_motion_keeps_momentum_and_energy():
    """Fourth-order steps of the dual Euler equation: the error falls sixteenfold when the step halves."""
    body = Body(1.5, np.diag([1.0, 2.0, 3.5]), CENTRE)
    start = Twist((1.0, 0.2, -0.7), (0.3, 0.1, 0.5))

    def drift(steps):
        twist, step = start, 2.0 / steps
        for _ in range(steps):
            rates = [twist_rate(body, twist, Wrench((0, 0, 0), (0, 0, 0)))]
            for part in (0.5, 0.5, 1.0):
                rates.append(twist_rate(body, twist + part * step * rates[-1], Wrench((0, 0, 0), (0, 0, 0))))
            twist = twist + step / 6 * (rates[0] + 2 * rates[1] + 2 * rates[2] + rates[3])
        return [
            abs(twist.reciprocal(body.momentum(twist)) - start.reciprocal(body.momentum(start))),
            abs(np.linalg.norm(body.momentum(twist).linear) - np.linalg.norm(body.momentum(start).linear)),
        ]

    ratio = np.array(drift(20)) / np.array(drift(40))
    assert (ratio > 12).all()


@few
@given(seeds)
def test_spatial_triangle_closes(seed):
    rng = np.random.default_rng(seed)
    *_, body = cloud(rng)
    triangle = spatial_triangle(body, random_screws(rng, Twist), random_screws(rng, Twist))
    n_p, n_f, f_p = triangle.sides
    size = 100.0 / np.sin([n_p.real, n_f.real, f_p.real]).min()
    near((n_f + f_p).real, n_p.real, size)
    near((n_f + f_p).dual, n_p.dual, size**2)
    same(triangle.rate + triangle.centripetal, triangle.force)


@few
@given(seeds)
def test_dual_laws_of_the_cosine_and_of_the_sines(seed):
    rng = np.random.default_rng(seed)
    *_, body = cloud(rng)
    triangle = spatial_triangle(body, random_screws(rng, Twist), random_screws(rng, Twist))
    n, p, f = (screw.norm for screw in (triangle.rate, triangle.centripetal, triangle.force))
    n_p, n_f, f_p = triangle.sides
    for got, wanted in (
        (n * n + p * p + 2.0 * n * p * n_p.cos(), f * f),
        (f * n_f.sin(), p * n_p.sin()),
        (f * f_p.sin(), n * n_p.sin()),
    ):
        size = 100.0 * (f.real + n.real + p.real) * (1 + sum(abs(x.dual) for x in (n, p, f, *triangle.sides)))
        near(got.real, wanted.real, size)
        near(got.dual, wanted.dual, size)


def test_centripetal_screw_from_the_dual_angle_of_velocity_and_momentum():
    """|p| = |V| |H| sin of their dual angle, and p lies along their common normal."""
    rng = np.random.default_rng(12)
    *_, body = cloud(rng)
    twist = random_screws(rng, Twist)
    momentum = body.momentum(twist)
    centripetal = twist.cross(momentum)
    angle = dual_angle(twist, momentum)
    wanted = twist.norm * momentum.norm * angle.sin()
    near([centripetal.norm.real, centripetal.norm.dual], [wanted.real, wanted.dual], 10.0)
    for side in (twist, momentum):
        met = dual_angle(centripetal, side)
        near([met.real, met.dual], [np.pi / 2, 0.0], 10.0)


def test_a_body_at_rest_has_no_centripetal_screw():
    triangle = spatial_triangle(symmetric_top(), Twist((0, 0, 0), (0, 0, 0)), Twist((1, 2, 3), (4, 5, 6)))
    n_p, n_f, f_p = triangle.sides
    assert np.isnan([n_p.real, f_p.real]).all()
    near([n_f.real, n_f.dual], [0.0, 0.0], 1.0)
    assert isinstance(n_f, Dual)


def test_a_batch_is_its_rows():
    rng = np.random.default_rng(13)
    *_, body = cloud(rng)
    twists, rates = random_screws(rng, Twist, 5), random_screws(rng, Twist, 5)
    wrench, triangle = force_screw(body, twists, rates), spatial_triangle(body, twists, rates)
    for i in range(5):
        same(wrench[i], force_screw(body, twists[i], rates[i]), reach=100.0)
        near(triangle.sides[0].dual[i], spatial_triangle(body, twists[i], rates[i]).sides[0].dual, 100.0)


def test_many_bodies_at_once():
    rng = np.random.default_rng(14)
    bodies = [cloud(rng)[2] for _ in range(3)]
    centres = Point("G", [body.centre.coordinates for body in bodies])
    batch = Body([body.mass for body in bodies], [body.inertia for body in bodies], centres)
    twist, wrench = random_screws(rng, Twist), random_screws(rng, Wrench)
    together = twist_rate(batch, twist, wrench)
    for i, body in enumerate(bodies):
        same(together[i], twist_rate(body, twist, wrench), reach=1000.0)


def test_erratum_the_printed_expansion_of_the_cross_product_swaps_the_momenta():
    """Between [4.5] and [4.6] I_A omega stands where q belongs; [2.4] and [4.4] give w x q + eps (...)."""
    rng = np.random.default_rng(15)
    *_, body = cloud(rng)
    (w, v) = rng.normal(size=(2, 3))
    twist = Twist(w, v, body.centre)  # AG = 0
    right = twist.cross(body.momentum(twist))
    near(right.force, body.mass * np.cross(w, v))
    near(right.moment, np.cross(w, body.inertia @ w))
    printed_first = np.cross(w, body.inertia @ w)  # a moment, where a force is due
    assert np.abs(printed_first - right.force).max() > 0.1
    near(printed_first, right.moment)


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
        Body(mass, inertia, CENTRE)
