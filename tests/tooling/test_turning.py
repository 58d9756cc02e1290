"""Steps and ledges that turn parts over: closed forms of a block, matrices, and chains of them."""

import math
from dataclasses import replace

import numpy as np
import pytest
import shapes
from hypothesis import given, settings
from hypothesis import strategies as st
from on_track import LEVEL, device, lying, pick
from on_track import block as part

from feederscrew.tooling import verdicts
from feederscrew.tooling.devices.kinds import KINDS
from feederscrew.tooling.fates import course
from feederscrew.tooling.isolating.chain import DesignConstraints
from feederscrew.tooling.isolating.design import design
from feederscrew.tooling.isolating.proposal import Goal

A, B, C = 20e-3, 12e-3, 5e-3  # the sides of the block
PLAIN = DesignConstraints(without=("cut_out",))


@pytest.fixture(scope="module")
def block():
    return lying(part())


def at(every, length, height):
    """The place in a sequence of what is so long and so high [m]."""
    return every.index(pick(every, 1e3 * length, 1e3 * height))


def test_a_block_pitches_over_its_leading_edge(block):
    one = block[at(block, A, C)]
    turn, edge = verdicts.turn_over(one, block, False), math.hypot(A / 2, C / 2)
    assert turn.angle == pytest.approx(math.atan2(A, C)) and turn.lift == pytest.approx(edge - C / 2)
    assert turn.sure == pytest.approx(A * (A / 2) / edge)  # the slope of its foot over the step is that angle
    assert (turn.onto, turn.beyond) == (at(block, C, A), at(block, A, C))
    ledge = verdicts.turn_over(one, block, True)
    assert ledge.lift == pytest.approx(math.hypot(B / 2, C / 2) - C / 2) and ledge.onto == at(block, A, B)


def test_a_face_holds_what_lands_on_it_as_long_as_its_momentum_allows(block):
    low, tall = block[at(block, B, C)], block[at(block, C, B)]
    arm, corner = (B**2 + C**2) / 12.0, (B**2 + C**2) / 4.0
    kept = ((arm + (B**2 - C**2) / 4.0) / (arm + corner)) ** 2  # of a block that rocks over its short side
    rise = math.sqrt(corner) - B / 2
    assert verdicts.turn_over(low, block, False).holds == pytest.approx(rise / kept + B / 2 - C / 2)
    assert verdicts.turn_over(tall, block, False).holds == math.inf  # a long side takes all: nothing turns on
    for height in (4.5e-3, 12e-3):
        turned, margin = verdicts.over_step(low, block, height)
        assert margin < 0.0  # between the barrier and what is sure, and then beyond what the short side holds
        assert {place for place, _ in turned} == {at(block, C, B), at(block, B, C)}
    (one,), margin = verdicts.over_step(tall, block, 8e-3)
    foot_on_edge = C * (C / 2) / math.sqrt(corner)
    assert one == (at(block, B, C), 1.0) and margin == pytest.approx(8e-3 - foot_on_edge, rel=1e-4)


def test_a_ledge_turns_only_what_its_drop_takes_past_the_barrier(block):
    assert verdicts.below_ledge(block) == pytest.approx(A / 2)
    tall, flat, across = (block[at(block, *sizes)] for sizes in ((A, B), (A, C), (B, C)))
    (one,), margin = verdicts.beyond_ledge(tall, block, 2e-3)  # standing on its long narrow side
    assert one == (at(block, A, C), 1.0) and margin > 0.0
    assert verdicts.beyond_ledge(flat, block, 5e-3)[1] < 0.0  # the second track is too high for it
    over, reach, height = A / 2 - 7e-3, A - 7e-3, C / 2  # it leans at 50 degrees, and its barrier is at 76
    tilt = math.asin(A / 2 / reach)
    left = A / 2 - (height * (1.0 - math.cos(tilt)) + over * math.sin(tilt))  # to fall, which may pitch it
    turned, margin = verdicts.beyond_ledge(across, block, 7e-3)
    assert not turned and margin == pytest.approx(math.hypot(B / 2, C / 2) - C / 2 - left, rel=1e-4)


def test_what_falls_over_an_edge_comes_to_lie_on_the_face_that_was_ahead_or_inwards():
    """An angle of unequal legs: no two of its faces look alike."""
    every = lying(shapes.prism(shapes.l_profile(17.0, 11.0, 3.0), 26.0))
    for one in every:
        for side, over_ledge in enumerate((False, True)):
            turn = verdicts.turn_over(one, every, over_ledge)
            assert every[turn.onto].axes[2] @ one.axes[side] < -0.4, (one.name, side)


@settings(max_examples=3, deadline=None)
@given(st.permutations([4.0, 9.0, 17.0]), st.floats(0.5, 3.0))
def test_a_block_that_pitches_twice_lies_as_before(sides, size):
    every = lying(part(*(size * side for side in sides)))
    for k, one in enumerate(every):
        onto = verdicts.turn_over(one, every, False).onto
        assert onto != k and verdicts.turn_over(every[onto], every, False).onto == k
        assert every[onto].length == pytest.approx(one.height, rel=1e-6)


def test_a_step_is_a_matrix_of_shares_that_grows_with_its_height(block):
    heights = [0.1e-3, 1e-3, 4e-3, 8e-3, 15e-3, 25e-3]
    flow = course([device("step", limit=height) for height in heights], block)
    np.testing.assert_allclose(flow.matrices.sum(axis=2), 1.0)
    np.testing.assert_allclose(flow.matrices[0], np.eye(len(block)))  # lower than every barrier
    stay, tall = np.einsum("dii->di", flow.matrices), at(block, C, A)
    assert (np.diff(stay, axis=0) <= 1e-12).all() and not stay[-1][tall]
    turn = verdicts.turn_over(block[tall], block, False)
    ((onto, share),), margin = verdicts.over_step(block[tall], block, 0.5 * (turn.lift + turn.sure))
    assert onto == turn.onto and share == pytest.approx(0.5)
    assert margin == pytest.approx(-0.5 * (turn.sure - turn.lift))
    assert not flow.decided[tall] and course([device("step", limit=8e-3)], block).decided[tall]


def test_a_ledge_turns_what_its_weight_lies_beyond(block):
    flow = course([device("tip", limit=4e-3)], block)
    for k, one in enumerate(block):
        if one.distance <= 4e-3:
            assert flow.matrices[0][k, k] == 1.0
            assert flow.verdicts[0][k].margin == pytest.approx(abs(one.balcony - 4e-3))
    k = at(block, A, B)  # its middle is 2.5 mm from the wall
    assert course([device("tip", limit=2e-3)], block).matrices[0][k, k] == 0.0
    soft = course([device("tip", limit=2.6e-3)], block, sigma=1e-4).matrices[0]
    assert soft[k, k] == pytest.approx(0.5 * math.erfc(-1.0 / math.sqrt(2.0)), abs=2e-3)


def test_turning_brings_more_where_returning_wastes():
    every = lying(part(20, 12, 10), replace(LEVEL, climb=np.radians(3.0)))  # a ledge turns what lies flat
    shares, wanted = np.array([one.chances["recommended"] for one in every]), at(every, A, B)
    plain, turned = (
        design(every, shares, wanted, constraints=replace(PLAIN, turn=turn)) for turn in (False, True)
    )
    assert turned.isolated and turned.efficiency > 1.5 * plain.efficiency
    assert any(KINDS[cut.device.kind].turns for cut in turned.cuts)
    flow = course(turned.devices, every)
    assert turned.efficiency == pytest.approx((shares * flow.leaving[:, wanted]).sum())
    short = design(every, shares, wanted, goal=Goal(efficiency=0.99), constraints=PLAIN)
    assert "the efficiency asked for is missed by" in short.reasons[-1]
    assert "`turn` allows" in short.reasons[-1]
