"""Dual angles, reciprocal screws, tipping axes and contact reactions."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from screw_samples import (
    directions,
    displacements,
    few,
    grid,
    lines,
    near,
    points,
    random_screws,
    sizes,
    vectors,
)

from feederscrew.screw import (
    Point,
    Screw,
    Twist,
    Wrench,
    displacement,
    dual_angle,
    poinsot,
    reactions,
    reciprocal_twists,
    reciprocity,
    tipping_twists,
)

X = Screw.on_axis((0, 0, 0), (1, 0, 0))


@pytest.mark.parametrize("angle", [1e-9, 0.3, np.pi / 2, 3.0, np.pi - 1e-9])
@pytest.mark.parametrize("distance", [-2.0, 0.0, 5.0])
def test_skew_lines(angle, distance):
    other = Screw.on_axis((7, 0, distance), (np.cos(angle), np.sin(angle), 0), pitch=3.0)
    between = dual_angle(X, other)
    assert between.real == pytest.approx(angle, rel=1e-7 if angle > 3.1 else 1e-15, abs=0)
    near(np.pi - between.real, np.pi - angle)
    assert between.dual == pytest.approx(distance, rel=1e-12, abs=1e-15)


@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_parallel_lines_are_a_distance_apart(sense):
    between = dual_angle(X, Screw.on_axis((9, 3, -4), (sense, 0, 0)))
    assert between.real == (0.0 if sense > 0 else np.pi)
    assert between.dual == pytest.approx(5.0, rel=1e-15)


def test_parallel_up_to_rounding_is_parallel():
    unit = np.array([0.1, 0.7, -0.3])
    first, second = Screw.on_axis((0, 0, 0), unit), Screw.on_axis((1, 2, 3), unit / 3.0 * 1.1)
    lever = np.cross([1, 2, 3], unit) / np.linalg.norm(unit)
    assert dual_angle(first, second).dual == pytest.approx(np.linalg.norm(lever), rel=1e-12)


def test_a_free_vector_has_an_angle_and_no_distance():
    between = dual_angle(X, Wrench((0, 0, 0), (0, 0, 2)))
    assert between.real == np.pi / 2
    assert np.isnan(between.dual)
    assert np.isnan(dual_angle(X, Screw((0, 0, 0), (0, 0, 0))).real)


@few
@given(vectors, directions, vectors, directions, points, displacements)
def test_dual_angle_is_invariant_and_symmetric(p, u, q, v, point, moved):
    a, b = Screw.on_axis(p, u, 2.0, 0.3), Screw.on_axis(q, v, 0.1, -2.0)
    wanted, sine = dual_angle(a, b), np.linalg.norm(np.cross(u, v)) / np.linalg.norm(u) / np.linalg.norm(v)
    for got in (dual_angle(b, a), dual_angle(a.at(point), b), dual_angle(moved @ a, moved @ b)):
        near(got.real, wanted.real, 1.0)
        near(got.dual, wanted.dual, 30.0 / max(sine, 1e-2))


@few
@given(vectors, directions, vectors, directions)
def test_cosine_of_the_dual_angle_is_the_product_of_the_lines(p, u, q, v):
    """Kotelnikov's transfer: u.v = cos a for crossing lines becomes dual for skew ones."""
    a, b = Screw.on_axis(p, u), Screw.on_axis(q, v)
    product, cosine = a.dot(b), dual_angle(a, b).cos()
    near([product.real, product.dual], [cosine.real, cosine.dual], 20.0)


@few
@given(lines(Twist), lines(Wrench))
def test_reciprocal_product_from_angle_distance_and_pitches(twist, wrench):
    size = [np.abs(s.moment).max() / s.magnitude + 20.0 for s in (twist, wrench)]
    power = reciprocity(twist, wrench) * twist.magnitude * wrench.magnitude
    near(power, twist.reciprocal(wrench), twist.magnitude * wrench.magnitude * np.prod(size))


def test_a_pitch_chosen_by_the_condition_makes_two_screws_reciprocal():
    angle, distance, pitch = 0.4, 3.0, 0.7
    wrench = Wrench.on_axis((0, 0, distance), (np.cos(angle), np.sin(angle), 0), 5.0, pitch)
    twist = Twist.on_axis((0, 0, 0), (1, 0, 0), 2.0, distance * np.tan(angle) - pitch)
    near(twist.reciprocal(wrench), 0.0, 10.0)
    near(reciprocity(twist, wrench), 0.0, 10.0)
    assert np.isnan(reciprocity(twist, Wrench((0, 0, 0), (1, 0, 0))))


@pytest.mark.parametrize("count", range(7))
@pytest.mark.parametrize("size", [1e-6, 1.0, 1e6])
def test_freedoms_left_by_k_contacts(count, size):
    rng = np.random.default_rng(count)
    wrenches = Wrench.on_axis(size * rng.normal(size=(count, 3)), rng.normal(size=(count, 3)))
    twists = reciprocal_twists(wrenches)
    assert twists.shape == (6 - count,)
    near(twists.magnitude, np.ones(6 - count))
    lever = np.abs(twists.moment).max(initial=0.0) + 4 * size
    near(twists[:, None].reciprocal(wrenches) if count < 6 else 0.0, np.zeros((6 - count, count)), lever)


def test_forces_through_one_point_leave_the_turns_about_it():
    centre = Point("C", (1, 2, 3))
    twists = reciprocal_twists(Wrench(np.eye(3), np.zeros((3, 3)), centre))
    near(twists.at(centre).velocity, np.zeros((3, 3)), 1.0)
    assert np.linalg.matrix_rank(twists.angular_velocity) == 3


def test_couples_leave_the_translations():
    twists = reciprocal_twists(Wrench(np.zeros((3, 3)), np.eye(3)))
    np.testing.assert_array_equal(twists.angular_velocity, np.zeros((3, 3)))
    assert np.linalg.matrix_rank(twists.velocity) == 3


def test_a_repeated_contact_takes_no_further_freedom():
    wrench = Wrench.on_axis([(0, 0, 0), (1, 0, 0), (0, 0, 5)], [(0, 0, 1)] * 3)
    assert reciprocal_twists(wrench).shape == (4,)


def test_a_batch_leaves_one_number_of_freedoms():
    rng = np.random.default_rng(9)
    wrenches = Wrench(*rng.normal(size=(2, 7, 5, 3)), Point("P", rng.normal(size=(7, 1, 3))))
    twists = reciprocal_twists(wrenches)
    assert twists.shape == (7, 1)
    near(twists.reciprocal(wrenches), np.zeros((7, 5)), 10.0)
    mixed = Wrench(np.array([np.eye(3), np.ones((3, 3))]), np.zeros((2, 3, 3)))
    with pytest.raises(ValueError, match=r"^the sets of wrenches are of ranks 1, 3, not of one$"):
        reciprocal_twists(mixed)


def fixture(size=1.0):
    """Three floor points, two on a long wall at y = 0, one end stop at x = 0; all contacts at floor level."""
    places = size * np.array([(1, 1, 0), (5, 1, 0), (3, 4, 0), (1, 0, 0), (5, 0, 0), (0, 2, 0)], dtype=float)
    inward = [(0, 0, 1)] * 3 + [(0, 1, 0)] * 2 + [(1, 0, 0)]
    return places, Wrench.on_axis(places, inward)


@pytest.mark.parametrize("size", [1e-9, 1e-3, 1.0, 1e9])
def test_a_block_tips_about_the_line_through_its_other_floor_points(size):
    places, contacts = fixture(size)
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


def test_a_slide_is_a_slide_in_every_axis_system():
    _, contacts = fixture()
    for turn in ((0.3, -1.0, 2.0), (1.0, 1.0, 0.1)):
        moved = displacement(Twist(turn, (3, 1, -2)))
        slide = tipping_twists(moved @ contacts)[5]
        np.testing.assert_array_equal(slide.angular_velocity, [0, 0, 0])
        near(slide.velocity, moved.rotation[:, 0], 1.0)


def test_each_tipping_twist_opens_its_contact_and_no_other():
    _, contacts = fixture()
    products = tipping_twists(contacts)[:, None].reciprocal(contacts)
    assert (np.diag(products) > 0.1).all()
    near(products - np.diag(np.diag(products)), np.zeros((6, 6)), 1.0)


def test_weight_over_the_middle_loads_three_points_alike():
    places, contacts = fixture()
    weight = poinsot([(0, 0, -9.0)], places[:3].mean(axis=0, keepdims=True))
    near(reactions(contacts, weight), [3, 3, 3, 0, 0, 0])


@few
@given(st.integers(0, 10**6), sizes, sizes)
def test_reactions_balance_the_external_wrench(seed, force, lever):
    rng = np.random.default_rng(seed)
    contacts = Wrench.on_axis(lever * rng.normal(size=(6, 3)), rng.normal(size=(6, 3)))
    external = Wrench(force * rng.normal(size=3), force * lever * rng.normal(size=3))
    matrix = np.concatenate([contacts.resultant, contacts.moment / lever], axis=-1).T
    pushes = reactions(contacts, external)
    direct = np.linalg.solve(matrix, -np.concatenate([external.resultant, external.moment / lever]))
    np.testing.assert_allclose(
        pushes, direct, rtol=0, atol=1e-14 * np.linalg.cond(matrix) * np.abs(direct).max()
    )
    left = (pushes * contacts).sum() + external
    near(left.resultant, np.zeros(3), 10 * np.abs(pushes).max())
    near(left.moment, np.zeros(3), 30 * np.abs(pushes).max() * lever)


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
    _, contacts = fixture()
    doubled = contacts[[0, 1, 2, 3, 4, 4]]
    with pytest.raises(ValueError, match=r"^1 of 1 sets of six wrenches are not independent$"):
        tipping_twists(doubled)
    with pytest.raises(ValueError, match=r"^there are 5 wrenches, not six$"):
        reactions(contacts[:5], Wrench((0, 0, 1), (0, 0, 0)))
    with pytest.raises(ValueError, match=r"^wrenches need an axis that counts them"):
        reciprocal_twists(contacts[0])


@few
@given(grid, grid)
def test_a_reaction_vanishes_as_the_load_reaches_its_tipping_axis(x, along):
    places, contacts = fixture()
    edge = places[0] + along * (places[1] - places[0])
    at_edge = reactions(contacts, poinsot([(0, 0, -1.0)], [edge]))
    near(at_edge[2], 0.0, 30.0)
    beyond = reactions(contacts, poinsot([(0, 0, -1.0)], [edge - (0, 1.0, 0)]))
    assert beyond[2] < 0.0
