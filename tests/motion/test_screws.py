"""Arithmetic, products, pitch, axis and degenerate cases of screws, and the examples of their page."""

import doctest
import re
from pathlib import Path

import numpy as np
import pytest
import screw_samples
from hypothesis import given
from hypothesis import strategies as st
from screw_samples import displacements, few, grid, lines, moved, near, points, same, screws, sizes, vectors

from feederscrew.motion import screws as screw
from feederscrew.motion.screws import ORIGIN, Body, Dual, Momentum, Point, Screw, Twist, Wrench, force_screw

seeds = st.integers(0, 10**6)
UNEVEN = "^inertia is not symmetric and positive definite$"
MASS, SPIN, TURN = 1.982e-3, 3.7, -52.0  # [kg], theta' [rad/s], theta'' [rad/s2]
SPEED, RATE = np.array([0.11, -0.07]), np.array([-1.9, 2.3])  # [m/s], [m/s2] along the two axes of the floor
INERTIAS = {  # of the thesis's two parts [g mm2]: I_yx and I_zx are their products
    "arc_chute": [[95.32, 0.0, -24.48], [0.0, 109.57, 0.0], [-24.48, 0.0, 114.75]],
    "magnet": [[755.91, -10.91, 0.0], [-10.91, 755.09, 0.0], [0.0, 0.0, 49.92]],
}


@few
@given(screws(), screws(), points, points)
def test_sums_do_not_depend_on_the_reference(a, b, there, further):
    same(a.at(there).at(further), a.at(further))
    size = max(np.abs(s.resultant).max() for s in (a, b)) * 10 + max(np.abs(s.moment).max() for s in (a, b))
    assert (a + b).reference is a.reference
    for left, right in ((b + a, a + b), (a.at(there) + b, a + b), ((a + b) - b, a)):
        near(left.at(ORIGIN).resultant, right.at(ORIGIN).resultant, size)
        near(left.at(ORIGIN).moment, right.at(ORIGIN).moment, size)


@few
@given(lines(), screws(), points, displacements, grid)
def test_axis_pitch_magnitude_and_products_go_with_the_body(a, b, point, displacement, along):
    lever = np.abs(a.moment).max() / a.magnitude + 10.0
    spread = [np.abs(s.resultant).max() * 20 + np.abs(s.moment).max() for s in (a, b)]
    for first, second in (
        (a.at(point), b),
        (a, b.at(point)),
        (moved(a, displacement), moved(b, displacement)),
    ):
        near(first.magnitude, a.magnitude)
        near(first.pitch, a.pitch, lever)
        near(first.dot(second).real, a.dot(b).real, a.magnitude * b.magnitude)
        near(second.reciprocal(first), a.reciprocal(b), np.prod(spread))
    axis = a.at(point).axis
    there = a.at(Point("A", axis.foot + along * axis.direction))
    near(there.moment, a.pitch * a.resultant, (lever + 20.0) * a.magnitude)
    near(np.dot(axis.foot - point.coordinates, axis.direction), 0.0, lever + 20.0)


def test_pure_screws_and_kinds():
    force = Wrench.on_axis((1, 2, 3), (0, 0, 2), magnitude=7)
    assert force.pitch == 0.0
    np.testing.assert_array_equal(force.axis.foot, [1, 2, 0])
    np.testing.assert_array_equal(force.moment, [14, -7, 0])
    couple = Wrench((0, 0, 0), (0, 3, 4))
    assert (couple.pitch, couple.magnitude) == (np.inf, 5.0)
    assert np.isnan(couple.axis.foot).all()
    np.testing.assert_array_equal(couple.axis.direction, [0, 0.6, 0.8])
    np.testing.assert_array_equal(couple.at(Point("P", (9, 8, 7))).moment, couple.moment)
    same(Wrench.on_axis((np.nan,) * 3, couple.direction, couple.magnitude, couple.pitch), couple)
    zero = Screw((0, 0, 0), (0, 0, 0))
    assert zero.magnitude == 0.0
    assert np.isnan([zero.pitch, *zero.axis.foot, *zero.axis.direction]).all()
    np.testing.assert_array_equal(zero.unit().moment, np.zeros(3))
    # They do not mix; only a twist carries a momentum into a wrench.
    twist, momentum, wrench = (kind((1, 2, 3), (4, 5, 6)) for kind in (Twist, Momentum, Wrench))
    assert type(twist.cross(momentum)) is Wrench
    pairs = (momentum, twist), (twist, wrench), (momentum, momentum), (twist, twist)
    assert {type(a.cross(b)) for a, b in pairs} == {Screw}
    with pytest.raises(ValueError, match=r"^a Twist and a Wrench do not add$"):
        twist + wrench
    with pytest.raises(ValueError, match=r"do not subtract$"):
        twist - wrench
    with pytest.raises(ValueError, match=r"^two screws have three products"):
        twist * wrench


def test_batches():
    """Sums, factors and products of many screws, whose points may differ, are those of each one."""
    rng = np.random.default_rng(3)
    a = Twist(*rng.normal(size=(2, 4, 5, 3)), Point("P", rng.normal(size=(4, 5, 3))))
    b, factors = Momentum(*rng.normal(size=(2, 5, 3))), np.arange(1.0, 6.0)
    product, pitches, feet = a.cross(b), a.pitch, a.axis.foot
    assert (a.shape, product.shape, pitches.shape, feet.shape) == ((4, 5), (4, 5), (4, 5), (4, 5, 3))
    for i in range(4):
        for j in range(5):
            same(product[i, j], a[i, j].cross(b[j]))
            same((factors * a)[i, j], a[i, j] / (1.0 / factors[j]))
            near(pitches[i, j], a[i, j].pitch)
            near(feet[i, j], a[i][j].axis.foot)
    assert a[:, 2:].shape == (4, 3)
    wanted = (a.moment - np.cross(a.resultant, a.reference.coordinates)).sum(axis=1)
    near(a.sum().at(ORIGIN).moment, wanted, 10.0)
    odd = Wrench([[0, 0, 1], [0, 0, 0], [0, 0, 0]], [[0, 0, 2], [0, 0, 2], [0, 0, 0]])
    np.testing.assert_array_equal(odd.pitch, [2.0, np.inf, np.nan])
    np.testing.assert_array_equal(odd.magnitude, [1.0, 2.0, 0.0])


@few
@given(vectors, vectors.filter(lambda v: v[0] != 0.0))
def test_dual_numbers_are_a_ring_with_quotients(p, q):
    """With eps^2 = 0: section 2.2 of the thesis."""
    a, b, c = Dual(p[0], p[1]), Dual(q[0], q[1]), Dual(p[2], q[2])
    for left, right in ((a * b, b * a), (a * (b + c), a * b + a * c), (a / b * b, a), (a - b + b, a)):
        near([left.real, left.dual], [right.real, right.dual], 1e3)
    assert (Dual(0.0, 1.0) * Dual(0.0, 1.0)).dual == 0.0
    assert not np.isfinite((a / Dual(0.0, 2.0)).dual)


def test_erratum_the_printed_quotient_of_dual_numbers_has_its_sign_reversed():
    a, b, c, d = 2.0, 3.0, 5.0, 7.0
    printed = Dual(a * c / c**2, (a * d - b * c) / c**2)
    right = Dual(a, b) / Dual(c, d)
    assert (right * Dual(c, d)).dual == pytest.approx(b, rel=1e-15)
    assert right.dual == pytest.approx(-printed.dual, rel=1e-15)


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda: Screw((1, 2), (1, 2, 3)), "shape"),
        (lambda: Screw((1, 2, 3, 4), (1, 2, 3, 4)), "shape"),
        (lambda: Screw(np.ones((2, 3)), np.ones((4, 3))), "broadcast"),
        (lambda: Screw((1, 2, np.nan), (1, 2, 3)), "^resultant has an entry that is not finite$"),
        (lambda: Screw((1, 2, 3), (1, 2, 3)) / 0.0, "not finite$"),
        (lambda: Point("C", (1, 2)), r"^point C has shape \(2,\), not \(\.\.\., 3\)$"),
        (lambda: Screw.on_axis((0, 0, 0), (0, 0, 0)), "^direction has no length$"),
        (lambda: Body(0.0, np.eye(3), ORIGIN), r"^mass is 0.0, not a positive number$"),
        (lambda: Body(1.0, np.diag([1.0, 1.0, -1.0]), ORIGIN), UNEVEN),
        (lambda: Body(1.0, [[1, 0.1, 0], [0, 1, 0], [0, 0, 1]], ORIGIN), UNEVEN),
        (lambda: Body(1.0, np.ones((2, 3)), ORIGIN), r"^inertia has shape \(2, 3\), not \(\.\.\., 3, 3\)$"),
    ],
)
def test_wrong_calls(make, says):
    with pytest.raises(ValueError, match=says):
        make()


def test_the_examples_of_the_page_run():
    """Each of docs/method/screws.md prints what it says, in one session, as a reader would type them."""
    page = Path(__file__).parents[2] / "docs" / "method" / "screws.md"
    blocks = re.findall(r"^```python\n(.*?)^```$", page.read_text(), re.MULTILINE | re.DOTALL)
    assert len(blocks) >= 6 and all(">>>" in block for block in blocks)
    examples = doctest.DocTestParser().get_doctest("\n".join(blocks), {}, page.name, str(page), 0)
    report = []
    failed, tried = doctest.DocTestRunner(verbose=False).run(examples, out=report.append)
    assert not failed, "".join(report)
    assert tried > 20


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
    twist = screw_samples.random_screws(rng, Twist)
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
    """Eqs. [4.4] to [4.6], at any point of the body; its power is the rate of the kinetic energy."""
    rng = np.random.default_rng(seed)
    masses, places, body = cloud(rng)
    twist, rate = screw_samples.random_screws(rng, Twist), screw_samples.random_screws(rng, Twist)
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
    """X upright: eqs. [4.7] to [4.12], [4.38] to [4.42]; with Z: eqs. [4.30], [4.31], eqs. [4.55], [4.56]."""
    inertia = 1e-9 * np.array(INERTIAS[part])
    (i_xx, i_yx, i_zx), (v_1, v_2), (a_1, a_2) = inertia[0], SPEED, RATE
    momentum, centripetal, rate = printed_screws(inertia, 0)
    np.testing.assert_allclose(momentum.linear, MASS * np.array([0.0, v_1, v_2]), rtol=1e-15)
    np.testing.assert_allclose(momentum.angular, -SPIN * inertia[0], rtol=1e-15)
    np.testing.assert_allclose(centripetal.force, MASS * SPIN * np.array([0, v_2, -v_1]), rtol=1e-14)
    np.testing.assert_allclose(centripetal.moment, SPIN**2 * np.array([0, -i_zx, i_yx]), rtol=1e-14)
    np.testing.assert_allclose(rate.force, MASS * np.array([0.0, a_1, a_2]), rtol=1e-14)
    np.testing.assert_allclose(rate.moment, -TURN * np.array([i_xx, i_yx, i_zx]), rtol=1e-12, atol=1e-22)
    # [4.56] prints the terms with theta' with the other sign than [4.31]; a wall makes them zero.
    _, centripetal, rate = printed_screws(inertia[::-1, ::-1], 2)
    np.testing.assert_allclose(centripetal.force, MASS * SPIN * np.array([v_2, -v_1, 0.0]), rtol=1e-14)
    np.testing.assert_allclose(rate.force, MASS * np.array([a_1, a_2, 0.0]), rtol=1e-14)
    np.testing.assert_allclose(rate.moment, -TURN * np.array([i_zx, i_yx, i_xx]), rtol=1e-12, atol=1e-22)


def block(size=1.0):
    """Three floor points, two on a long wall at y = 0, one end stop at x = 0; all contacts at floor level."""
    places = size * np.array([(1, 1, 0), (5, 1, 0), (3, 4, 0), (1, 0, 0), (5, 0, 0), (0, 2, 0)], dtype=float)
    inward = [(0, 0, 1)] * 3 + [(0, 1, 0)] * 2 + [(1, 0, 0)]
    return places, Wrench.on_axis(places, inward)


@pytest.mark.parametrize("size", [1e-9, 1e-3, 1e9])
def test_a_block_tips_about_the_line_through_its_other_floor_points(size):
    places, contacts = block(size)
    twists = screw.tipping_twists(contacts)
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
    pushes = screw.reactions(contacts, external)
    left = (pushes * contacts).sum() + external
    near(left.resultant, np.zeros(3), 10 * np.abs(pushes).max())
    near(left.moment, np.zeros(3), 30 * np.abs(pushes).max() * lever)


def test_contacts_that_do_not_hold_the_body():
    _, contacts = block()
    doubled = contacts[[0, 1, 2, 3, 4, 4]]
    with pytest.raises(ValueError, match=r"^1 of 1 sets of six wrenches are not independent$"):
        screw.tipping_twists(doubled)
    with pytest.raises(ValueError, match=r"^there are 5 wrenches, not six$"):
        screw.reactions(contacts[:5], Wrench((0, 0, 1), (0, 0, 0)))
    with pytest.raises(ValueError, match=r"^wrenches need an axis that counts them"):
        screw.tipping_twists(contacts[0])
