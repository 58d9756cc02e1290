"""Headings against the wall: closed forms, a brute-force search, what stays on the track."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import shapes
import trimesh
from mechanics_samples import DEG, box_posture, rectangle

from feederscrew.base.errors import FeederError
from feederscrew.base.geometry.polygons import outline, turned
from feederscrew.bowl.record import Track
from feederscrew.motion.headings import headings, rests, stable_row
from feederscrew.part import load
from feederscrew.resting.aspects import find
from feederscrew.resting.posture import Posture, posture

TRACK = Track(climb=0.0, bank=0.0, radius=0.15, width=0.025)


def plan_posture(plan, height=2e-3):
    """A flat plate of a given outline with a peg on it, so that no turn but the whole maps it to itself."""
    corners = np.array([[x, y, z] for x, y in plan for z in (0.0, 2 * height)])
    corners = np.vstack([corners, [*(0.5 * plan[0] + 0.1 * plan[1]), 8 * height]])
    return Posture("A", "flat", 0.01, height, np.eye(3) * 1e-7, plan, plan, 0.0, corners=corners)


def by_search(corners, radius, count=40_000):
    """Rests and shares on a fine circle of directions: where the bowl's axis is a local farthest point."""
    angle = 2 * np.pi * np.arange(count) / count
    along = corners @ np.array([np.cos(angle), np.sin(angle)])
    if np.isinf(radius):
        reach = -along.max(axis=0)
    else:
        square = radius**2 - (corners**2).sum(axis=1)[:, None]
        reach = (np.sqrt(square + along**2) - along).min(axis=0)
    tops = (reach > np.roll(reach, 1)) & (reach >= np.roll(reach, -1))
    dips = (reach < np.roll(reach, 1)) & (reach <= np.roll(reach, -1))
    borders = np.sort(angle[dips])
    shares = np.mod(np.diff(np.append(borders, borders[0] + 2 * np.pi)), 2 * np.pi) / (2 * np.pi)
    return angle[tops], shares


@pytest.mark.parametrize("radius", [np.inf, 100.0, 0.15, 0.04])
def test_shares_of_a_rectangle(radius):
    """The corners' directions bound the ranges, whatever the radius: 4 atan(3) / 2 pi for the long sides."""
    wall = rests(rectangle(0.03, 0.01), radius)
    assert len(wall.share) == 4
    assert np.sort(wall.share)[2:].sum() == pytest.approx(4 * np.arctan(3) / (2 * np.pi), rel=1e-12)
    assert wall.share.sum() == pytest.approx(1.0)


@pytest.mark.parametrize("radius", [np.inf, 0.2, 0.06])
@pytest.mark.parametrize("seed", range(6))
def test_rests_match_a_search(seed, radius):
    rng = np.random.default_rng(seed)
    corners = outline(rng.uniform(-0.012, 0.012, (14, 2)))
    corners = corners - corners.mean(axis=0)
    wall = rests(corners, radius, merge=0.0)
    directions, shares = by_search(corners, radius)
    assert np.sort(np.mod(wall.outward, 2 * np.pi)) == pytest.approx(np.sort(directions), abs=5e-4)
    assert np.sort(wall.share) == pytest.approx(np.sort(shares), abs=2e-4)


def test_blunt_corners_and_ends():
    """A corner that stands 0.05 mm out of a 30 mm side touches a straight wall, not a curved one."""
    blunt = np.array([[-15, -5], [1, -5.05], [15, -5], [15, 5], [-15, 5]]) * 1e-3
    straight, curved = rests(blunt, np.inf, merge=0.0), rests(blunt, 0.15, merge=0.0)
    assert len(straight.share) == len(curved.share) == 4
    long_side = curved.touching[np.argmin(np.abs(curved.outward + np.pi / 2))]
    assert np.abs(long_side[:, 0]) == pytest.approx([0.015, 0.015])
    assert (np.abs(straight.touching[..., 0] - 1e-3) < 1e-9).any()
    # A blunt, faceted end has a shallow dip in its middle, which belongs to neither side.
    bend = np.linspace(-0.25, 0.25, 12)
    end = 0.025 * np.column_stack([np.cos(bend), np.sin(bend)]) - [0.005, 0.0]
    wall = rests(np.concatenate([end, [[-0.012, 0.007], [-0.012, -0.007]]]), 0.15)
    sides = wall.share[np.abs(np.abs(wall.outward) - np.pi / 2) < 0.5]
    assert len(sides) == 2
    assert sides[0] == pytest.approx(sides[1], rel=1e-9)


def test_a_mirror_image_is_another_heading_and_turning_the_body_turns_them():
    """A scalene triangle's mirror image has the mirrored headings with the same shares."""
    plan = np.array([[-10, -4], [14, -4], [-4, 8]]) * 1e-3
    first, second = (headings(plan_posture(p), TRACK) for p in (plan, (plan * [1, -1])[::-1]))
    assert (first.mirrors == -1).all()
    assert second.shares == pytest.approx(first.shares)
    assert second.headings == pytest.approx(np.mod(np.pi - first.headings, 2 * np.pi), abs=1e-9)
    plan = outline(np.random.default_rng(2).uniform(-0.01, 0.01, (9, 2)))
    plan = plan - plan.mean(axis=0)
    first, second = (headings(plan_posture(p), TRACK) for p in (plan, turned(plan, 0.4)))
    assert np.mod(first.headings - second.headings, 2 * np.pi) == pytest.approx([0.4] * len(first.headings))
    assert second.widths == pytest.approx(first.widths)


@pytest.mark.parametrize("error", [0.0, 3e-7, -3e-7])
@pytest.mark.parametrize(
    ("count", "mirrors"),
    [(4, {0: 180, 90: None, 180: 0, 270: None}), (6, {0: 180, 60: 120, 120: 60, 180: 0, 240: 300, 300: 240})],
)
def test_equal_headings_come_from_0_on_whatever_the_rounding(count, mirrors, error):
    """Every side of a regular polygon is as good; one is laid on 0, and rounding makes it no 360."""
    k = np.arange(count)
    angle = 2.0 * np.pi * k / count - np.pi / 2 + np.pi / count + error + 1e-9 * k
    lying = headings(plan_posture(0.01 * np.column_stack([np.cos(angle), np.sin(angle)])), TRACK)
    assert np.degrees(lying.headings) == pytest.approx(list(mirrors), abs=1e-4)
    named = [None if row < 0 else round(np.degrees(lying.headings[row])) for row in lying.mirrors]
    assert named == list(mirrors.values())


@pytest.mark.parametrize(
    ("length", "width", "order"),
    [(0.01 * (1.0 + 1e-6), 0.01, [0, 90, 180, 270]), (0.01, 0.011, [90, 270, 0, 180])],
)
def test_the_more_frequent_heading_comes_first_by_more_than_rounding(length, width, order):
    lying = headings(plan_posture(rectangle(length, width)), TRACK)
    assert np.degrees(lying.headings) == pytest.approx(order)


def test_a_hole_tells_headings_apart_that_the_hull_does_not():
    """A bar with an off-centre hole: its hull looks the same after half a turn, the solid does not."""
    hole = shapes.box(4, 4, 3.9)
    hole.apply_translation((6.0, 0, 0))
    hole.invert()
    bar = shapes.box(30, 10, 4)
    for mesh, turns in ((bar, 2), (trimesh.util.concatenate(bar, hole), 1)):
        part = shapes.part(mesh)
        assert set(headings(posture(part, find(part), "A"), TRACK).turns.tolist()) == {turns}


@pytest.mark.parametrize(("share", "falls"), [(0.999, True), (1.001, False)])
def test_a_part_falls_once_its_foot_has_no_track_below(share, falls):
    """The free edge curves away: the part's two ends carry it until their chord passes the foot."""
    distance = 0.005 + 0.15 - np.sqrt(0.15**2 - 0.015**2)
    assert headings(box_posture(), TRACK).distances[0] == pytest.approx(distance)
    least = 0.15 - np.hypot(0.15 - distance, 0.015)
    assert bool(headings(box_posture(), Track(0.0, 0.0, 0.15, share * least)).falls_off[0]) is falls
    # A part that tips ahead does not fall off.
    assert not headings(box_posture(0.006, 0.01, 0.04), replace(TRACK, climb=20 * DEG)).falls_off.any()


@pytest.mark.parametrize(("width", "falls"), [(0.0169, True), (0.0171, False)])
def test_a_bridge_falls_where_its_outer_leg_has_no_track_below(width, falls):
    """Across the track: legs of 3 mm, 20 mm from outside to outside; the hull of its foot hides the span."""
    bridge = [(-10, 0), (-7, 0), (-7, 6), (7, 6), (7, 0), (10, 0), (10, 10), (-10, 10)]
    part = shapes.part(shapes.subdivided(shapes.prism(bridge, 8), 1))
    aspects = find(part)
    legs = posture(part, aspects, aspects.names[int(np.argmin(np.abs(aspects.heights - 748e-3 / 116)))])
    lying = headings(legs, Track(climb=0.0, bank=0.0, radius=100.0, width=width))
    across = np.isclose(lying.lengths, 0.008, rtol=1e-3)
    assert across.any() and (lying.falls_off[across] == falls).all() and not lying.falls_off[~across].any()


@pytest.mark.parametrize("facets", [16, 32, 64])
@pytest.mark.parametrize("bank", [6.0, 12.0, 15.0, 20.0])
def test_a_pin_on_a_track_banked_towards_its_wall_falls_off_nowhere(facets, bank):
    """It rolls into the corner at the wall: only what is beyond the free edge falls off."""
    part = shapes.part(shapes.cylinder(3.0, 20.0, facets))
    aspects = find(part)
    pin = posture(part, aspects, aspects.names[aspects.kinds.index("rolling")])
    lying = headings(pin, replace(TRACK, bank=bank * DEG))
    assert not lying.falls_off.any() and not lying.overhangs.any()


def test_a_screw_across_a_climbing_track_rolls_and_does_not_fall_off():
    """Its strip of contact is narrow at the free end, and the weight's line passes behind it."""
    part = load(Path(__file__).parents[2] / "parts/shcs_m3x8_simple.stl")
    screw, climbing = posture(part, find(part), "A"), replace(TRACK, climb=3 * DEG)
    lying = headings(screw, climbing)
    assert screw.kind == "rolling" and 90.0 in np.degrees(lying.headings).round(3)
    assert not lying.falls_off.any() and not lying.overhangs.any()
    assert headings(screw, replace(climbing, width=0.001)).falls_off.all()


def test_laid_anywhere_it_settles_in_its_range():
    lying, border = headings(box_posture(), TRACK), np.degrees(np.arctan(3.0))
    for laid, settled in ((border - 1, 0), (border + 1, 90), (-170, 0)):
        assert np.degrees(lying.headings[stable_row(lying, laid * DEG)]) == pytest.approx(settled)
    assert stable_row(lying) == 0


@pytest.mark.parametrize(
    ("radius", "width", "heading", "fault"),
    [
        (0.02, 0.025, None, "track.radius: 20 mm is less than the part's 31.62 mm across - "),
        (0.15, 0.008, 90, "aspect A, heading 90 deg: the part needs 30.08 mm of track and falls off - "),
        (0.15, 0.002, None, "aspect A: the part falls off the track in every heading - "),
    ],
)
def test_faults(radius, width, heading, fault):
    with pytest.raises(FeederError, match=fault):
        lying = headings(box_posture(), Track(0.0, 0.0, radius, width))
        stable_row(lying, heading and heading * DEG)
