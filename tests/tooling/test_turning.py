"""Steps and ledges that turn parts over: closed forms of a block, matrices, and chains of them."""

import math
from dataclasses import replace

import numpy as np
import pytest
import shapes
from hypothesis import given, settings
from hypothesis import strategies as st

from feederscrew import bowl as bowls
from feederscrew.resting.aspects import find
from feederscrew.tooling import verdicts
from feederscrew.tooling.devices.kinds import KINDS, make_device
from feederscrew.tooling.fates import course
from feederscrew.tooling.isolating.chain import DesignConstraints
from feederscrew.tooling.isolating.design import design
from feederscrew.tooling.isolating.proposal import Goal
from feederscrew.tooling.orientations import orientations

TRACK = bowls.read(None, ("track.radius=100 m", "track.width=200 mm", "track.bank=0 deg")).track
A, B, C = 20e-3, 12e-3, 5e-3  # the sides of the block
LYING = {"length": A, "width": B, "height": C}
PLAIN = DesignConstraints(without=("cut_out",))


def block(a=20, b=12, c=5):
    part = shapes.part(shapes.box(a, b, c))
    return orientations(part, find(part), TRACK)


def pick(every, length, height):
    return next(
        k for k, one in enumerate(every)
        if one.length == pytest.approx(length, rel=1e-6) and one.height == pytest.approx(height, rel=1e-6)
    )  # fmt: skip


@pytest.fixture(scope="module")
def lying():
    return block()


def test_a_block_pitches_over_its_leading_edge(lying):
    one = lying[pick(lying, A, C)]
    turn = verdicts.turn_over(one, lying, False)
    edge = math.hypot(A / 2, C / 2)
    assert turn.angle == pytest.approx(math.atan2(A, C))
    assert turn.lift == pytest.approx(edge - C / 2)
    assert turn.sure == pytest.approx(A * (A / 2) / edge)  # the slope of its foot over the step is that angle
    assert turn.onto == pick(lying, C, A) and turn.beyond == pick(lying, A, C)
    ledge = verdicts.turn_over(one, lying, True)
    assert ledge.lift == pytest.approx(math.hypot(B / 2, C / 2) - C / 2)
    assert ledge.onto == pick(lying, A, B)


def test_a_face_holds_what_lands_on_it_as_long_as_its_momentum_allows(lying):
    low, tall = lying[pick(lying, B, C)], lying[pick(lying, C, B)]
    arm, corner = (B**2 + C**2) / 12.0, (B**2 + C**2) / 4.0
    kept = ((arm + (B**2 - C**2) / 4.0) / (arm + corner)) ** 2  # of a block that rocks over its short side
    rise = math.sqrt(corner) - B / 2
    assert verdicts.turn_over(low, lying, False).holds == pytest.approx(rise / kept + B / 2 - C / 2)
    assert (
        verdicts.turn_over(tall, lying, False).holds == math.inf
    )  # a long side takes all of it: nothing turns on
    for height in (4.5e-3, 12e-3):
        turned, margin = verdicts.over_step(low, lying, height)
        assert margin < 0.0  # between the barrier and what is sure, and then beyond what the short side holds
        assert {place for place, _ in turned} == {pick(lying, C, B), pick(lying, B, C)}
    (one,), margin = verdicts.over_step(tall, lying, 8e-3)
    foot_on_edge = C * (C / 2) / math.sqrt(corner)
    assert one == (pick(lying, B, C), 1.0) and margin == pytest.approx(8e-3 - foot_on_edge, rel=1e-4)


def test_a_ledge_turns_only_what_its_drop_takes_past_the_barrier(lying):
    assert verdicts.below_ledge(lying) == pytest.approx(A / 2)
    tall = lying[pick(lying, A, B)]  # standing on its long narrow side
    (one,), margin = verdicts.beyond_ledge(tall, lying, 2e-3)
    assert one == (pick(lying, A, C), 1.0) and margin > 0.0
    flat = lying[pick(lying, A, C)]  # the second track is too high for it
    assert verdicts.beyond_ledge(flat, lying, 5e-3)[1] < 0.0
    across = lying[pick(lying, B, C)]  # leans at 50 degrees, and its barrier is at 76
    over, reach, height = A / 2 - 7e-3, A - 7e-3, C / 2
    tilt = math.asin(A / 2 / reach)
    fell = height * (1.0 - math.cos(tilt)) + over * math.sin(tilt)
    turned, margin = verdicts.beyond_ledge(across, lying, 7e-3)
    assert not turned
    left = A / 2 - fell  # to fall, which may pitch it
    assert margin == pytest.approx(math.hypot(B / 2, C / 2) - C / 2 - left, rel=1e-4)


def test_what_falls_over_an_edge_comes_to_lie_on_the_face_that_was_ahead_or_inwards():
    """An angle of unequal legs: no two of its faces look alike."""
    part = shapes.part(shapes.prism(shapes.l_profile(17.0, 11.0, 3.0), 26.0))
    every = orientations(part, find(part), TRACK)
    for one in every:
        for turn, side in (
            (verdicts.turn_over(one, every, False), 0),
            (verdicts.turn_over(one, every, True), 1),
        ):
            assert every[turn.onto].axes[2] @ one.axes[side] < -0.4, (one.name, side)


@settings(max_examples=3, deadline=None)
@given(st.permutations([4.0, 9.0, 17.0]), st.floats(0.5, 3.0))
def test_a_block_that_pitches_twice_lies_as_before(sides, size):
    every = block(*(size * side for side in sides))
    for k, one in enumerate(every):
        onto = verdicts.turn_over(one, every, False).onto
        assert onto != k
        assert verdicts.turn_over(every[onto], every, False).onto == k
        assert every[onto].length == pytest.approx(one.height, rel=1e-6)


def test_a_step_is_a_matrix_of_shares_that_grows_with_its_height(lying):
    heights = [0.1e-3, 1e-3, 4e-3, 8e-3, 15e-3, 25e-3]
    found = course([make_device("step", "test", limit=h) for h in heights], lying)
    np.testing.assert_allclose(found.matrices.sum(axis=2), 1.0)
    np.testing.assert_allclose(found.matrices[0], np.eye(len(lying)))  # lower than every barrier
    stay = np.einsum("dii->di", found.matrices)
    assert (np.diff(stay, axis=0) <= 1e-12).all()
    tall = pick(lying, C, A)
    assert not stay[-1][tall]
    turn = verdicts.turn_over(lying[tall], lying, False)
    ((onto, share),), margin = verdicts.over_step(lying[tall], lying, 0.5 * (turn.lift + turn.sure))
    assert onto == turn.onto and share == pytest.approx(0.5)
    assert margin == pytest.approx(-0.5 * (turn.sure - turn.lift))
    assert not found.decided[tall]
    assert course([make_device("step", "test", limit=8e-3)], lying).decided[tall]


def test_a_ledge_turns_what_its_weight_lies_beyond(lying):
    found = course([make_device("tip", "test", limit=4e-3)], lying)
    for k, one in enumerate(lying):
        beyond = one.distance > 4e-3
        assert beyond or found.matrices[0][k, k] == 1.0
        assert beyond or found.verdicts[0][k].margin == pytest.approx(abs(one.balcony - 4e-3))
    k = pick(lying, A, B)  # its middle is 2.5 mm from the wall
    assert course([make_device("tip", "test", limit=2e-3)], lying).matrices[0][k, k] == 0.0
    soft = course([make_device("tip", "test", limit=2.6e-3)], lying, sigma=1e-4).matrices[0]
    assert soft[k, k] == pytest.approx(0.5 * math.erfc(-1.0 / math.sqrt(2.0)), abs=2e-3)


def test_turning_brings_more_where_returning_wastes():
    lying = block(20, 12, 10)  # a ledge turns what lies flat onto its side, which holds it
    shares = np.array([one.chances["recommended"] for one in lying])
    wanted = pick(lying, A, B)
    plain, turned = (
        design(lying, shares, wanted, constraints=replace(PLAIN, turn=turn)) for turn in (False, True)
    )
    assert turned.isolated
    assert turned.efficiency > 1.5 * plain.efficiency
    assert any(KINDS[cut.device.kind].turns for cut in turned.cuts)
    flow = course(turned.devices, lying)
    assert turned.efficiency == pytest.approx((shares * flow.leaving[:, wanted]).sum())
    short = design(lying, shares, wanted, goal=Goal(efficiency=0.99), constraints=PLAIN)
    assert "the efficiency asked for is missed by" in short.reasons[-1]
    assert "`turn` allows" in short.reasons[-1]
