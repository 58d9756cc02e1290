"""What a blade lays over, what wedges, leans on the wall or turns over an edge: closed forms and matrices."""

import math
from dataclasses import replace

import awkward
import numpy as np
import pytest
import shapes
from hypothesis import given, settings
from hypothesis import strategies as st
from on_track import LEVEL, device, lying, pick
from on_track import block as part

from feederscrew.bowl.devices.base import UNSURE
from feederscrew.bowl.devices.kinds import KINDS
from feederscrew.feeding import stream
from feederscrew.resting.aspects import find
from feederscrew.sorting import falling, verdicts
from feederscrew.sorting.fates import course
from feederscrew.sorting.isolating.chain import DesignConstraints
from feederscrew.sorting.isolating.design import design
from feederscrew.sorting.orientations import head_first, place
from feederscrew.sorting.verdicts import verdict


@pytest.fixture(scope="module")
def pin():
    return replace(pick(lying(part(6, 6, 20)), height=20), grip=0.5)


def test_a_blade_lays_a_pin_over_from_a_height_on_and_a_swept_one_aside(pin):
    """z = mu L + b (1 - mu^2) / mu = 0.5 6 mm + 3 mm 0.75 / 0.5 = 7.5 mm. Aside over a side 3 mm from the
    weight: mu z cos(a) = 3 mm, a the lesser of both its angles to the push."""
    for low, lays in ((7.4e-3, False), (7.6e-3, True)):
        assert falling.may_lay_over(pin, low) == lays
        margin = verdict(device("wiper", limit=low), pin).margin
        assert margin == pytest.approx(-UNSURE if lays else low - 20e-3)
    for sweep in (0.3, 0.7):
        height = 3e-3 / (0.5 * max(np.cos(sweep), np.sin(sweep)))
        assert not falling.may_lay_aside(pin, 0.99 * height, sweep)
        assert falling.may_lay_aside(pin, 1.01 * height, sweep)
    placed = verdict(device("wiper", limit=7.6e-3), replace(pin, grip=0.0))
    assert placed.margin == pytest.approx(-12.4e-3)  # what does not travel


@pytest.mark.parametrize(
    ("wide", "high", "margin"),
    [
        (9.0, 7.6, -UNSURE),  # an opening above the part lays it over as a blade does
        (4.0, 30.0, -2e-3),  # met at the foot: it stands
        # Held up at its foot by a quarter of a millimetre it stands; that edge worn, its top is pushed over.
        (6.0 - 0.235, 12.0, -UNSURE), (6.0 - 0.265, 12.0, -8e-3),
    ],
)  # fmt: skip
def test_an_opening_lays_over_what_it_does_not_hold_at_its_foot(pin, wide, high, margin):
    corners = ((0.0, 0.0), (1e-3 * wide, 0.0), (1e-3 * wide, 1e-3 * high), (0.0, 1e-3 * high))
    assert verdict(device("profile gate", corners=corners), pin).margin == pytest.approx(
        margin, rel=2e-2, abs=0.0
    )


@pytest.mark.parametrize(("grip", "wedges"), [(0.57, False), (0.585, True)])
def test_a_hexagon_wedges_where_friction_exceeds_the_slope_of_its_sides(grip, wedges):
    """Its sides lean by 30 degrees from upright: tan 30 deg = 0.577."""
    turn = np.radians(60.0 * np.arange(6))
    prism = shapes.prism(6.0 * np.column_stack([np.cos(turn), np.sin(turn)]), 30)
    bar = replace(pick(lying(prism), height=6.0 * np.sqrt(3.0)), grip=grip)
    middle = bar.distance
    assert falling.may_wedge(bar, (middle - 4e-3, middle + 4e-3)) == wedges
    assert not falling.may_wedge(bar, (middle - 2.5e-3, middle + 2.5e-3))  # it lies on its flat


@pytest.fixture(scope="module")
def headed():
    """A pin with a round head, lying along the track, its head ahead."""
    head = shapes.cylinder(5.0, 4.0, 64)
    head.apply_translation([0, 0, 12.0])
    every = lying(head.union(shapes.cylinder(2.0, 20.0, 64)))
    one = next(one for one in every if one.length > 0.02 and head_first(one))
    return replace(one, heading=np.pi, distance=6.2e-3)  # straight along the track, on the rails' middle


@pytest.mark.parametrize(("lean", "certain"), [(1e-2, False), (-1e-2, True)])
def test_a_head_that_comes_first_wedges_where_the_sides_are_steeper_than_friction(headed, lean, certain):
    """Where the edges of a slot of width w meet a head of radius R it leans by acos(w / 2 R) from upright."""
    slot, radius = 6e-3, 5e-3
    angle = np.arccos(0.5 * slot / radius)
    rails = device("rails", span=(headed.distance - 0.5 * slot, headed.distance + 0.5 * slot))
    grip = np.tan(angle + lean + np.pi / 64 * (1 if lean > 0 else -1))
    own, free = (verdict(rails, replace(headed, grip=grip)) for grip in (grip, 0.0))
    assert free.margin == pytest.approx(2e-3, rel=0.01)  # 6 mm lets 4 mm down and holds 10 mm
    assert own.sure == certain and own.margin == (pytest.approx(free.margin) if certain else 0.0)


def test_a_part_leans_on_the_wall_as_high_as_it_is_there():
    """A block of 6 mm with a rib of 10 mm along one side: that side at the wall, or the other."""
    rib = shapes.box(22, 3, 10)
    rib.apply_translation([0.0, 5.0, 2.0])  # both begin at the same level
    one = replace(pick(lying(shapes.box(22, 13, 6).union(rib)), height=10), climbs=3e-4)
    dips = {falling.wall_holds(replace(one, heading=one.heading + turn), 4e-3) for turn in (0.0, np.pi)}
    low, high = (3e-4 * (2.0 * height - one.posture.height) / 4e-3 for height in (6e-3, 10e-3))
    assert sorted(dips) == pytest.approx([low, high], rel=1e-9)


def test_the_margin_of_what_returns_is_that_of_the_first_device_that_does():
    limits = ("wiper", 8e-3), ("gap", 10.5e-3), ("wiper", 4e-3)
    chain = [device(kind, limit=limit) for kind, limit in limits]
    stage = stream.follow_orientations(part(), find(part()), LEVEL, chain)
    along = stage.lying.index(pick(stage.lying, 20, 5))
    assert stage.margins[along, 1:] == pytest.approx([3e-3, -0.5e-3, -1e-3], rel=1e-2)
    assert stage.margin[along] == pytest.approx(-0.5e-3, rel=1e-2)


@pytest.mark.parametrize("bank", [0.0, 3.0, 12.0])
def test_a_blade_meets_the_foremost_place_higher_than_it_and_tips_over_what_is_behind_the_weight(bank):
    """Each face cut at the blade's height by itself; the vertical through the centre of mass meets the track
    nearer to the wall on a bank, and the part tips over the foot's rear border at that place."""
    lays, mu = [], 0.5
    climb_c, climb_s = np.cos(np.radians(3.0)), np.sin(np.radians(3.0))
    for one in awkward.lying():
        if one.falls_off or one.kind != "flat":
            continue
        leant = replace(one, grip=mu, track=replace(one.track, bank=np.radians(bank), climb=np.radians(3.0)))
        points, faces = one.posture.surface, one.posture.solid.faces
        ahead, height = np.cos(one.heading) * points[:, 0] - np.sin(one.heading) * points[:, 1], points[:, 2]
        behind = max(-rear_border(one.foot.corners, -one.posture.height * np.tan(np.radians(bank))), 0.0)
        for share in (0.13, 0.37, 0.61, 0.83):
            low = share * height.max()
            kept = [at for face in faces for at in above([(ahead[k], height[k]) for k in face], low)]
            reach = max(x for x, _ in kept)
            level = min(z for x, z in kept if x >= reach - 1e-7)
            push = (mu * climb_c - climb_s) / (1.0 - mu**2)
            tips = push * (level - mu * (behind + reach)) + one.posture.height * climb_s - behind * climb_c
            assert falling.may_lay_over(leant, low) == (tips > 0.0) or abs(tips) < 1e-8
            lays.append(bool(tips > 0.0))
    assert 0.1 < np.mean(lays) < 0.9


def rear_border(corners, across):
    """Where the convex hull of points (K, 2) is left by a line along the track at some distance across."""
    places = []
    for a in corners:
        for b in corners:
            if (a[1] - across) * (b[1] - across) <= 0.0 and a[1] != b[1]:
                places.append(a[0] + (across - a[1]) / (b[1] - a[1]) * (b[0] - a[0]))
    return min(places, default=corners[:, 0].min())


def above(corners, low):
    """Corners of a triangle, how far ahead and how high, from a height on, and where its sides cross that."""
    for (x, z), (u, w) in zip(corners, [*corners[1:], corners[0]]):
        if z >= low:
            yield x, z
        if (z - low) * (w - low) < 0.0:
            yield x + (low - z) / (w - z) * (u - x), low


def test_beyond_a_ledge_a_margin_is_the_least_of_what_it_lacks_and_what_turns_it():
    """Widths from where a part just fails to stand to where nothing is left of the ledge."""
    bounds, every = set(), place(awkward.lying())
    for one in every:
        if one.falls_off or not np.isfinite(one.balcony):
            continue
        for share in (0.05, 0.3, 0.6, 0.9):
            limit = share * one.balcony
            lacks, (_, certain) = one.balcony - limit, verdicts.beyond_ledge(one, every, limit)
            margin = verdict(device("tipping ledge", limit=limit), one, every).margin
            assert margin <= min(lacks, certain) + 1e-12
            assert min(abs(margin - lacks), abs(margin - certain)) < 1e-12
            bounds.add(bool(lacks < certain))
    assert bounds == {True, False}
    # The rear side is a barrier of its own: corners of a skew body seen across the track, at every angle.
    uneven = []
    for one in every:
        if one.falls_off or one.kind != "flat":
            continue
        turn = verdicts.turn_over(one, every, False)
        points = one.posture.solid.vertices - one.posture.solid.centre_of_mass
        corners = points @ np.array([one.axes[0], -one.axes[2]]).T  # ahead and down
        assert turn.lift == pytest.approx(lifted(corners, 1.0), abs=2e-8)
        assert turn.rear_lift == pytest.approx(lifted(corners, -1.0), abs=2e-8)
        uneven.append(abs(turn.lift - turn.rear_lift) / one.height)
    assert max(uneven) > 0.05


def momentum(about_first, about_second):
    """Moment about the second point of points (4, 2) that turn about the first, and both sums of squares."""
    velocity = np.column_stack([-about_first[:, 1], about_first[:, 0]])
    moment = (about_second[:, 0] * velocity[:, 1] - about_second[:, 1] * velocity[:, 0]).sum()
    return max(moment, 0.0), (about_first**2).sum(), (about_second**2).sum()  # none where it goes back


CROSS = np.array([[1, 0], [-1, 0], [0, 1], [0, -1]])


def test_the_rear_that_follows_a_part_down_a_step_lifts_it_by_what_its_momentum_keeps():
    """It falls from the slope on which its rear stands on the upper track and its front on the lower one.
    Turned about the front end, points of the part keep the moment of their momentum about the rear end as
    that lands; what is left of the energy lifts the centre of mass."""
    uneven, least, every = [], [], place(awkward.lying())
    for one in every:
        foot = one.foot.corners[:, 0]
        if one.kind != "flat" or len(foot) < 3:
            continue
        front, rear, height = foot.max(), foot.min(), 0.1 * np.ptp(foot)
        uneven.append(abs(front + rear) / height)
        slope = np.arcsin(height / (front - rear))
        fall = (front * np.sin(slope) + one.posture.height * np.cos(slope)) - one.posture.height
        points = np.sqrt(awkward.square_of_gyration(one)) * CROSS
        ends = points + [-front, one.posture.height], points + [-rear, one.posture.height]
        moment, first, second = momentum(*ends)
        turn = verdicts.turn_over(one, every, False)
        _, margin = verdicts.over_step(one, every, height)
        lacks = turn.rear_lift - moment**2 / second / first * max(fall, 0.0)
        if margin > 0.0 and height < turn.sure:
            assert margin <= lacks + 1e-9
            least.append(abs(margin - lacks) < 1e-9)
    assert max(uneven) > 0.5 and any(least)


def test_what_leans_over_a_ledge_goes_on_by_what_its_momentum_keeps():
    """It turns about the edge until its inner corner lands, 2 mm lower, and on about that. Points of the part
    keep the moment of their momentum about the corner; what is left of the energy lifts the centre of mass
    towards its barrier over the second track."""
    least, drop, every = [], 2e-3, place(awkward.lying())
    low = tuple(replace(one, length=4e-3, height=4e-3) for one in every)  # the drop is half of that
    for one in every:
        turn = verdicts.turn_over(one, low, True)
        for width in (0.3 * one.distance, 0.7 * one.distance, 0.9 * one.distance):
            over, height = one.distance - width, one.posture.height
            reach = one.foot.corners[:, 1].max() + over if len(one.foot.corners) else 0.0
            if drop >= turn.sure or not drop < reach or np.arcsin(drop / reach) >= turn.angle:
                continue
            tilt = np.arcsin(drop / reach)
            fell = over * np.sin(tilt) + height * (1.0 - np.cos(tilt))
            points = np.sqrt(awkward.square_of_gyration(one, 0)) * CROSS
            moment, first, second = momentum(points + [over, height], points + [over - reach, height])
            missed = turn.lift - (drop - fell) - moment**2 / second / first * fell
            turned, margin = verdicts.beyond_ledge(one, low, width)
            assert bool(turned) == (missed <= 0.0)
            if not turned:
                assert margin <= missed + 1e-9
                least.append(abs(margin - missed) < 1e-9)
    assert len(least) > 5 and any(least)


def lifted(corners, side):
    """Rise [m] of the weight over the edge to a side, of corners (V, 2) to that side and down. Turned on by
    small angles, the lowest corner is as far below the weight as it is high; the first highest."""
    turns = np.linspace(0.0, 0.5 * np.pi, 20001)
    heights = (side * corners[:, :1] * np.sin(turns) + corners[:, 1:] * np.cos(turns)).max(axis=0)
    falls = np.flatnonzero(np.diff(heights) < 0.0)
    return heights[falls[0] if len(falls) else -1] - heights[0]


A, B, C = 20e-3, 12e-3, 5e-3  # the sides of the block
PLAIN = DesignConstraints(without=("cut-out",))


@pytest.fixture(scope="module")
def block():
    return lying(part())


def at(every, length, height):
    """The place in a sequence of what is so long and so high [m]."""
    return every.index(pick(every, 1e3 * length, 1e3 * height))


def test_a_block_turns_over_an_edge_as_its_closed_forms_say(block):
    one = block[at(block, A, C)]
    turn, edge = verdicts.turn_over(one, block, False), math.hypot(A / 2, C / 2)
    assert turn.angle == pytest.approx(math.atan2(A, C)) and turn.lift == pytest.approx(edge - C / 2)
    assert turn.sure == pytest.approx(A * (A / 2) / edge)  # the slope of its foot over the step is that angle
    assert (turn.onto, turn.beyond) == (at(block, C, A), at(block, A, C))
    ledge = verdicts.turn_over(one, block, True)
    assert ledge.lift == pytest.approx(math.hypot(B / 2, C / 2) - C / 2) and ledge.onto == at(block, A, B)
    # A face holds what lands on it as long as its momentum allows.
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
    # A ledge turns only what its drop takes past the barrier.
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
    # A ledge turns what its weight lies beyond.
    flow = course([device("tipping ledge", limit=4e-3)], block)
    for k, one in enumerate(block):
        if one.distance <= 4e-3:
            assert flow.matrices[0][k, k] == 1.0
            assert flow.verdicts[0][k].margin == pytest.approx(abs(one.balcony - 4e-3))
    k = at(block, A, B)  # its middle is 2.5 mm from the wall
    assert course([device("tipping ledge", limit=2e-3)], block).matrices[0][k, k] == 0.0
    soft = course([device("tipping ledge", limit=2.6e-3)], block, sigma=1e-4).matrices[0]
    assert soft[k, k] == pytest.approx(0.5 * math.erfc(-1.0 / math.sqrt(2.0)), abs=2e-3)


def test_turning_brings_more_where_returning_wastes():
    every = lying(part(20, 12, 10), replace(LEVEL, climb=np.radians(3.0)))  # a ledge turns what lies flat
    shares, wanted = np.array([one.chances["recommended"] for one in every]), at(every, A, B)
    allowed = PLAIN, replace(PLAIN, turn=True)
    plain, turned = (design(every, shares, wanted, constraints=one) for one in allowed)
    assert turned.isolated and turned.efficiency > 1.5 * plain.efficiency
    assert any(KINDS[cut.device.kind].action.turns for cut in turned.cuts)
    flow = course(turned.devices, every)
    assert turned.efficiency == pytest.approx((shares * flow.leaving[:, wanted]).sum())
    short = design(every, shares, wanted, efficiency=0.99, constraints=PLAIN)
    assert "the efficiency asked for is missed by" in short.reasons[-1]
    assert "`turn` allows" in short.reasons[-1]
