"""Signs, limits and rules of devices that a level, symmetric block would not show."""

from dataclasses import replace

import awkward
import numpy as np
import pytest
import shapes

from feederscrew.bowl.record import Track
from feederscrew.resting.aspects import find
from feederscrew.tooling import falling, verdicts
from feederscrew.tooling.devices.base import UNSURE
from feederscrew.tooling.devices.kinds import make_device
from feederscrew.tooling.orientations import head_first, orientations, place
from feederscrew.tooling.verdicts import verdict

LEVEL = Track(climb=0.0, bank=0.0, radius=100.0, width=0.2)


@pytest.mark.parametrize("bank", [0.0, 3.0, 12.0])
def test_a_blade_meets_the_foremost_place_higher_than_it_and_tips_over_what_is_behind_the_weight(bank):
    """Each face cut at the blade's height by itself; the vertical through the centre of mass meets the track
    nearer to the wall on a bank, and the part tips over the foot's rear border at that place."""
    lays, mu = [], 0.5
    for one in awkward.lying():
        if one.falls_off or one.kind != "flat":
            continue
        leant = replace(one, grip=mu, track=replace(one.track, bank=np.radians(bank), climb=np.radians(3.0)))
        c, s = np.cos(one.heading), np.sin(one.heading)
        points = one.posture.surface
        ahead, height = c * points[:, 0] - s * points[:, 1], points[:, 2]
        behind = max(-rear_border(one.foot.corners, -one.posture.height * np.tan(np.radians(bank))), 0.0)
        for share in (0.13, 0.37, 0.61, 0.83):
            low = share * height.max()
            kept = [
                place
                for face in one.posture.solid.faces
                for place in above([(ahead[k], height[k]) for k in face], low)
            ]
            reach = max(place[0] for place in kept)
            level = min(place[1] for place in kept if place[0] >= reach - 1e-7)
            c, s = np.cos(np.radians(3.0)), np.sin(np.radians(3.0))
            push = (mu * c - s) / (1.0 - mu**2)
            tips = push * (level - mu * (behind + reach)) + one.posture.height * s - behind * c
            assert falling.may_lay_over(leant, low) == (tips > 0.0) or abs(tips) < 1e-8
            lays.append(bool(tips > 0.0))
    assert 0.1 < np.mean(lays) < 0.9


def rear_border(corners, across):
    """Where the convex hull of points (K, 2) is left by a line along the track at some distance across."""
    places = []
    for a in corners:
        for b in corners:
            if (a[1] - across) * (b[1] - across) <= 0.0 and a[1] != b[1]:
                share = (across - a[1]) / (b[1] - a[1])
                places.append(a[0] + share * (b[0] - a[0]))
    return min(places, default=corners[:, 0].min())


@pytest.fixture(scope="module")
def pin():
    part = shapes.part(shapes.box(6, 6, 20))
    every = orientations(part, find(part), LEVEL)
    return replace(next(one for one in every if one.height > 19e-3), grip=0.5)


@pytest.mark.parametrize(("held", "stands"), [(0.235e-3, False), (0.265e-3, True)])
def test_what_an_opening_holds_by_a_quarter_of_a_millimetre_wears_off(pin, held, stands):
    """Held up at its foot a pin stands before the gate; if that edge is gone, its top is pushed over."""
    corners = ((0.0, 0.0), (6e-3 - held, 0.0), (6e-3 - held, 12e-3), (0.0, 12e-3))
    margin = verdict(make_device("profile", "test", corners=corners), pin).margin
    assert margin == (pytest.approx(-8e-3, abs=1e-4) if stands else -UNSURE)


@pytest.fixture(scope="module")
def headed():
    """A pin with a round head, lying along the track, its head ahead."""
    head = shapes.cylinder(5.0, 4.0, 64)
    head.apply_translation([0, 0, 12.0])
    part = shapes.part(head.union(shapes.cylinder(2.0, 20.0, 64)))
    every = orientations(part, find(part), LEVEL)
    found = next(one for one in every if one.length > 0.02 and head_first(one))
    return replace(found, heading=np.pi, distance=6.2e-3)  # straight along the track, on the rails' middle


@pytest.mark.parametrize(("lean", "certain"), [(1e-2, False), (-1e-2, True)])
def test_a_head_that_comes_first_wedges_where_the_sides_are_steeper_than_friction(headed, lean, certain):
    """Where the edges of a slot of width w meet a head of radius R it leans by acos(w / 2 R) from upright."""
    slot, radius = 6e-3, 5e-3
    angle = np.arccos(0.5 * slot / radius)
    span = (headed.distance - 0.5 * slot, headed.distance + 0.5 * slot)
    device = make_device("rails", "test", span=span)
    found = verdict(device, replace(headed, grip=np.tan(angle + lean + np.pi / 64 * (1 if lean > 0 else -1))))
    free = verdict(device, replace(headed, grip=0.0))
    assert free.margin == pytest.approx(2e-3, rel=0.01)  # 6 mm lets 4 mm down and holds 10 mm
    assert found.sure == certain
    assert found.margin == (pytest.approx(free.margin) if certain else 0.0)


def test_beyond_a_ledge_a_margin_is_the_least_of_what_it_lacks_and_what_turns_it():
    """Widths from where a part just fails to stand to where nothing is left of the ledge."""
    seen = set()
    every = place(awkward.lying())
    for one in every:
        if one.falls_off or not np.isfinite(one.balcony):
            continue
        for share in (0.05, 0.3, 0.6, 0.9):
            limit = share * one.balcony
            lacks = one.balcony - limit
            _, certain = verdicts.beyond_ledge(one, every, limit)
            found = verdict(make_device("tip", "test", limit=limit), one, every).margin
            assert found <= min(lacks, certain) + 1e-12
            assert min(abs(found - lacks), abs(found - certain)) < 1e-12
            seen.add(bool(lacks < certain))
    assert seen == {True, False}


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
        down = np.array([[np.cos(slope), np.sin(slope)], [-np.sin(slope), np.cos(slope)]])
        centre = down @ [-front, one.posture.height]  # from the front end
        fall = centre[1] - one.posture.height
        spread = awkward.square_of_gyration(one)
        points = np.sqrt(spread) * np.array([[1, 0], [-1, 0], [0, 1], [0, -1]])
        ahead, behind = points + [-front, one.posture.height], points + [-rear, one.posture.height]
        velocity = np.column_stack([-ahead[:, 1], ahead[:, 0]])
        moment = (behind[:, 0] * velocity[:, 1] - behind[:, 1] * velocity[:, 0]).sum()
        kept = max(moment, 0.0) / (behind**2).sum()  # none where it goes back
        left = kept**2 * (behind**2).sum() / (ahead**2).sum()
        turn = verdicts.turn_over(one, every, False)
        _, margin = verdicts.over_step(one, every, height)
        lacks = turn.rear_lift - left * max(fall, 0.0)
        if margin > 0.0 and height < turn.sure:
            assert margin <= lacks + 1e-9
            least.append(abs(margin - lacks) < 1e-9)
    assert max(uneven) > 0.5 and any(least)


def test_what_leans_over_a_ledge_goes_on_by_what_its_momentum_keeps():
    """It turns about the edge until its inner corner lands, 2 mm lower, and on about that.

    Points of the part keep the moment of their momentum about the corner; what is left of the energy lifts
    the centre of mass towards its barrier over the second track.
    """
    least, turns, every = [], [], place(awkward.lying())
    low = tuple(replace(one, length=4e-3, height=4e-3) for one in every)  # the drop is half of that
    for one in every:
        turn = verdicts.turn_over(one, low, True)
        for width in (0.3 * one.distance, 0.7 * one.distance, 0.9 * one.distance):
            over, height, drop = one.distance - width, one.posture.height, 2e-3
            reach = one.foot.corners[:, 1].max() + over if len(one.foot.corners) else 0.0
            if drop >= turn.sure or not drop < reach or np.arcsin(drop / reach) >= turn.angle:
                continue
            tilt = np.arcsin(drop / reach)
            fell = over * np.sin(tilt) + height * (1.0 - np.cos(tilt))
            spread = np.sqrt(awkward.square_of_gyration(one, 0))
            points = spread * np.array([[1, 0], [-1, 0], [0, 1], [0, -1]])
            edge, corner = points + [over, height], points + [over - reach, height]
            velocity = np.column_stack([-edge[:, 1], edge[:, 0]])
            moment = (corner[:, 0] * velocity[:, 1] - corner[:, 1] * velocity[:, 0]).sum()
            left = max(moment, 0.0) ** 2 / (corner**2).sum() / (edge**2).sum() * fell
            missed = turn.lift - (drop - fell) - left
            turned, margin = verdicts.beyond_ledge(one, low, width)
            turns.append(bool(turned))
            assert turns[-1] == (missed <= 0.0)
            if not turned:
                assert margin <= missed + 1e-9
                least.append(abs(margin - missed) < 1e-9)
    assert len(least) > 5 and any(least)


def above(corners, low):
    """Corners of a triangle, how far ahead and how high, from a height on, and where its sides cross that."""
    for (x, z), (u, w) in zip(corners, [*corners[1:], corners[0]]):
        if z >= low:
            yield x, z
        if (z - low) * (w - low) < 0.0:
            yield x + (low - z) / (w - z) * (u - x), low


def test_the_rear_side_is_a_barrier_of_its_own_and_a_face_holds_what_its_momentum_does_not_lift():
    """Corners of a skew body seen across the track: its barriers by trying every angle."""
    every = place(awkward.lying())
    uneven = []
    for one in every:
        if one.falls_off or one.kind != "flat":
            continue
        turn = verdicts.turn_over(one, every, False)
        points = one.posture.solid.vertices - one.posture.solid.centre_of_mass
        seen = points @ np.array([one.axes[0], -one.axes[2]]).T  # ahead and down
        assert turn.lift == pytest.approx(lifted(seen, 1.0), abs=2e-8)
        assert turn.rear_lift == pytest.approx(lifted(seen, -1.0), abs=2e-8)
        uneven.append(abs(turn.lift - turn.rear_lift) / one.height)
    assert max(uneven) > 0.05


def lifted(seen, side):
    """Rise [m] of the weight over the edge to a side, of corners (V, 2) to that side and down.

    Turned on by small angles, the lowest corner is as far below the weight as it is high; the first highest.
    """
    turns = np.linspace(0.0, 0.5 * np.pi, 20001)
    heights = (side * seen[:, :1] * np.sin(turns) + seen[:, 1:] * np.cos(turns)).max(axis=0)
    falls = np.flatnonzero(np.diff(heights) < 0.0)
    return heights[falls[0] if len(falls) else -1] - heights[0]
