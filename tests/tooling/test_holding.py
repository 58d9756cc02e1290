"""What a blade lays over, what wedges, what leans on the wall, and what turns over an edge: closed forms."""

from dataclasses import replace

import awkward
import numpy as np
import pytest
import shapes
from on_track import LEVEL, block, device, lying, pick

from feederscrew.rates import stream
from feederscrew.resting.aspects import find
from feederscrew.tooling import falling, verdicts
from feederscrew.tooling.devices.base import UNSURE
from feederscrew.tooling.orientations import head_first, place
from feederscrew.tooling.verdicts import verdict


@pytest.fixture(scope="module")
def pin():
    return replace(pick(lying(block(6, 6, 20)), height=20), grip=0.5)


@pytest.mark.parametrize(("low", "lays"), [(7.4e-3, False), (7.6e-3, True)])
def test_a_blade_lays_a_pin_over_from_a_height_on(pin, low, lays):
    """z = mu L + b (1 - mu^2) / mu = 0.5 6 mm + 3 mm 0.75 / 0.5 = 7.5 mm."""
    assert falling.may_lay_over(pin, low) == lays
    margin = verdict(device("wiper", limit=low), pin).margin
    assert margin == pytest.approx(-UNSURE if lays else low - 20e-3)
    placed = verdict(device("wiper", limit=7.6e-3), replace(pin, grip=0.0))
    assert placed.margin == pytest.approx(-12.4e-3)  # what does not travel


@pytest.mark.parametrize("sweep", [0.3, 0.7])
def test_a_swept_blade_lays_a_pin_aside_from_a_height_on(pin, sweep):
    """Over a side 3 mm from the weight: mu z cos(a) = 3 mm, a the lesser of both its angles to the push."""
    height = 3e-3 / (0.5 * max(np.cos(sweep), np.sin(sweep)))
    assert not falling.may_lay_aside(pin, 0.99 * height, sweep)
    assert falling.may_lay_aside(pin, 1.01 * height, sweep)


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
    assert verdict(device("profile", corners=corners), pin).margin == pytest.approx(margin, rel=2e-2, abs=0.0)


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
    chain = [
        device(kind, limit=limit) for kind, limit in (("wiper", 8e-3), ("gap", 10.5e-3), ("wiper", 4e-3))
    ]
    stage = stream.follow_orientations(block(), find(block()), LEVEL, chain)
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
            margin = verdict(device("tip", limit=limit), one, every).margin
            assert margin <= min(lacks, certain) + 1e-12
            assert min(abs(margin - lacks), abs(margin - certain)) < 1e-12
            bounds.add(bool(lacks < certain))
    assert bounds == {True, False}


def momentum(about_first, about_second):
    """Moment about the second point of points (4, 2) that turn about the first, and both sums of squares."""
    velocity = np.column_stack([-about_first[:, 1], about_first[:, 0]])
    moment = (about_second[:, 0] * velocity[:, 1] - about_second[:, 1] * velocity[:, 0]).sum()
    return max(moment, 0.0), (about_first**2).sum(), (about_second**2).sum()  # none where it goes back


CROSS = np.array([[1, 0], [-1, 0], [0, 1], [0, -1]])


def test_the_rear_that_follows_a_part_down_a_step_lifts_it_by_what_its_momentum_keeps():
    """It falls from the slope on which its rear stands on the upper track and its front on the lower one.

    Turned about the front end, points of the part keep the moment of their momentum about the rear end as
    that lands; what is left of the energy lifts the centre of mass.
    """
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
        moment, first, second = momentum(
            points + [-front, one.posture.height], points + [-rear, one.posture.height]
        )
        turn = verdicts.turn_over(one, every, False)
        _, margin = verdicts.over_step(one, every, height)
        lacks = turn.rear_lift - moment**2 / second / first * max(fall, 0.0)
        if margin > 0.0 and height < turn.sure:
            assert margin <= lacks + 1e-9
            least.append(abs(margin - lacks) < 1e-9)
    assert max(uneven) > 0.5 and any(least)


def test_what_leans_over_a_ledge_goes_on_by_what_its_momentum_keeps():
    """It turns about the edge until its inner corner lands, 2 mm lower, and on about that.

    Points of the part keep the moment of their momentum about the corner; what is left of the energy lifts
    the centre of mass towards its barrier over the second track.
    """
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


def test_the_rear_side_is_a_barrier_of_its_own_and_a_face_holds_what_its_momentum_does_not_lift():
    """Corners of a skew body seen across the track: its barriers by trying every angle."""
    uneven, every = [], place(awkward.lying())
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


def lifted(corners, side):
    """Rise [m] of the weight over the edge to a side, of corners (V, 2) to that side and down.

    Turned on by small angles, the lowest corner is as far below the weight as it is high; the first highest.
    """
    turns = np.linspace(0.0, 0.5 * np.pi, 20001)
    heights = (side * corners[:, :1] * np.sin(turns) + corners[:, 1:] * np.cos(turns)).max(axis=0)
    falls = np.flatnonzero(np.diff(heights) < 0.0)
    return heights[falls[0] if len(falls) else -1] - heights[0]
