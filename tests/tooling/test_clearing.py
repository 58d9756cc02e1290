"""What becomes of a part that a device does not let pass: returned, stopped; and how long that takes."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import shapely
import shapes

from feederscrew import bowl as bowls
from feederscrew.errors import ArgumentError
from feederscrew.part import load
from feederscrew.resting.aspects import find
from feederscrew.studies.rate import rate, shares
from feederscrew.studies.tooling import tooling
from feederscrew.tooling import falling, footprints
from feederscrew.tooling.devices import openings
from feederscrew.tooling.devices.kinds import make_device
from feederscrew.tooling.devices.pneumatics import Nozzles
from feederscrew.tooling.falling import falls_through, may_lay_aside
from feederscrew.tooling.fates import course
from feederscrew.tooling.footprints import Footprint
from feederscrew.tooling.isolating import chain, hole_search
from feederscrew.tooling.isolating.design import DESIGN_MARGIN_M
from feederscrew.tooling.isolating.proposal import design_task, propose
from feederscrew.tooling.orientations import orientations, travelling
from feederscrew.tooling.verdicts import verdict

BOWL = bowls.read(None, ("track.climb=0 deg", "track.bank=0 deg"))
PARTS = Path(__file__).resolve().parents[2] / "parts"


@pytest.mark.parametrize("friction", [0.1, 0.3, 0.6])
def test_a_face_clears_itself_below_a_right_angle_minus_its_friction_angle(friction):
    edge = falling.clearing_limit(friction)
    assert math.degrees(edge) == pytest.approx(90.0 - math.degrees(math.atan(friction)))
    below = [falling.along_blade(BOWL, share * edge, friction) for share in (0.5, 0.9)]
    assert below[0] > below[1] > 0.0
    assert falling.along_blade(BOWL, edge + 1e-9, friction) == 0.0


def test_only_what_a_face_sweeps_blocks_the_track():
    class One:
        track, distance = replace(BOWL.track, width=0.02), 0.005

    swept = make_device("wiper", "here", limit=6e-3, sweep=math.radians(30.0), friction=0.3)
    speed = falling.along_blade(BOWL, math.radians(30.0), 0.3)
    assert falling.clearing_time(swept, One, BOWL) == pytest.approx(0.015 / speed)
    assert falling.clearing_time(make_device("gap", "here", limit=6e-3), One, BOWL) == 0.0


class Slab:
    """A box 20 x 18 x 4 mm, lying."""

    heading, track = 0.3, replace(BOWL.track, width=0.05)

    class posture:
        corners = np.array([[x, y, z] for x in (-0.01, 0.01) for y in (-9e-3, 9e-3) for z in (0.0, 4e-3)])


@pytest.mark.parametrize(
    ("long", "wide", "through"),
    [(60, 40, True), (60, 5, True), (60, 4, False), (21, 5, True), (19, 5, False)],
)
def test_a_hole_lets_through_what_some_tipped_shadow_of_the_part_fits_into(long, wide, through):
    """The slab goes on edge through a slit wider than it is thick, and longer than the side along it."""
    cut = 1e-3 * np.array([[0, 3], [long, 3], [long, 3 + wide], [0, 3 + wide]], float)
    slab = type("Turned", (Slab,), {"heading": 0.0})
    assert falls_through(slab, cut) == through


@pytest.mark.parametrize("heading", [0.0, math.pi])
def test_a_part_may_tip_about_either_end(heading):
    """A wedge is the shortest from above where its long face stands upright: its thin end tips up, or down.

    That is 30 * 14 / sqrt(30^2 + 14^2) = 12.7 mm; about its other end no shadow is shorter than its back.
    """
    back, tip = np.array([[15, 0], [15, 14]]), np.array([[-15, 0]])
    ends = np.concatenate([back, tip])

    class Wedge(Slab):
        class posture:
            corners = 1e-3 * np.array([[x, y, z] for x, z in ends for y in (-6, 6)], float)

    def let_through(long):
        cut = 1e-3 * np.array([[0, 3], [long, 3], [long, 23], [0, 23]], float)
        return falls_through(type("Turned", (Wedge,), {"heading": heading}), cut)

    assert let_through(13.9) and not let_through(13.0)


def test_a_convex_hole_says_what_any_hole_does():
    """With a side bent inwards by a hair a hole is not convex: then its border is swept by the shadow."""
    rng, told = np.random.default_rng(7), []
    for _ in range(60):
        hole = shapely.MultiPoint(rng.uniform(0.0, 1.0, (6, 2)) * [50e-3, 35e-3] + [0.0, 5e-3]).convex_hull
        ring = shapely.get_coordinates(shapely.geometry.polygon.orient(hole))[:-1]
        middle = 0.5 * (ring[0] + ring[-1])
        bent = np.vstack([ring, middle + 1e-6 * (ring.mean(axis=0) - middle)])
        told.append(falls_through(Slab, ring))
        assert told[-1] == falls_through(Slab, bent)
    assert 10 < sum(told) < 50


def test_three_points_do_not_carry_a_part_over_a_hole_larger_than_itself():
    points = 1e-3 * np.array([[-7.0, -4.0], [7.0, -4.0], [0.0, 4.0]])
    foot = Footprint(rings=(), edges=np.empty((0, 2, 2)), points=points)
    hole = openings.polygon(1e-3 * np.array([[0, 0.3], [60, 0.3], [60, 39], [0, 39]]), 0.15)
    assert footprints.least(footprints.standing(foot, 6e-3, 0.15), hole)[0] < 0.0
    small = openings.polygon(1e-3 * np.array([[0, 30], [5, 30], [5, 39], [0, 39]]), 0.15)
    whole = footprints.least(footprints.standing(foot, 6e-3, 0.15), small)[0]
    assert whole == pytest.approx(shapely.Polygon(points).exterior.distance(shapely.Point(0, 0)), abs=1e-6)


def test_a_sorter_blows_off_what_looks_other_than_its_own_by_more_than_its_play():
    part = shapes.part(shapes.box(20, 12, 5))
    every = orientations(part, find(part), replace(BOWL.track, width=0.04))
    along, across = (next(one for one in every if abs(one.length - size) < 1e-6) for size in (0.02, 0.012))
    own = {"like": (along.aspect, along.heading, 5e-4)}
    sorter = make_device("sorter", "here", **own)
    assert verdict(sorter, along, every).margin == pytest.approx(4e-4)  # its play without the blur
    assert verdict(sorter, across, every).margin == pytest.approx(5e-4 - 8e-3 + 1e-4, abs=2e-4)
    weak = make_device("sorter", "here", **own, time=1e-4)
    assert verdict(weak, across, every).passes == 1.0 and not verdict(weak, across, every).sure
    blind = make_device("sorter", "here", **own, sees="height")
    assert verdict(blind, across, every).passes == verdict(blind, along, every).passes == 1.0


def test_other_ways_up_that_count_are_not_returned():
    part = shapes.part(shapes.box(22, 13, 6))
    own = {"rule": "csa", "without": "cut_out"}
    one = tooling(part, BOWL, "A", **own).design
    both = tooling(part, BOWL, "A", up="a,B", **own).design
    assert both.isolated and both.efficiency > one.efficiency and both.purity > 0.999
    assert not any(name.startswith("B") for cut in both.cuts for name in cut.returns)
    with pytest.raises(ArgumentError, match=r"up: .* has no aspect 'Q' - choose one of A, B, C"):
        tooling(part, BOWL, "A", up="Q", **own)


def test_play_and_tolerance_are_added_to_every_margin():
    part = shapes.part(shapes.box(22, 13, 6))
    own = {"rule": "csa", "without": "cut_out"}
    loose = tooling(part, BOWL, "A", play=2e-4, tolerance=1e-4, **own)
    assert loose.margin == pytest.approx(DESIGN_MARGIN_M + 3e-4)
    ends = [end for cut in loose.design.cuts for end in (cut.margin_pass, cut.margin_reject)]
    assert min(end for end in ends if end == end) >= DESIGN_MARGIN_M + 3e-4 - 1e-9


def test_a_cutter_leaves_round_corners_and_a_smaller_hole():
    part = shapes.part(shapes.box(20, 12, 5))
    every = orientations(part, find(part), replace(BOWL.track, width=0.04))
    along, across = (
        next(k for k, one in enumerate(every) if abs(one.length - size) < 1e-6 and one.height < 0.006)
        for size in (0.02, 0.012)
    )
    square = make_device(
        "cut_out", "here", corners=((0.0, 0.0), (0.013, 0.0), (0.013, 0.0115), (0.0, 0.0115))
    )
    given = design_task(every, np.ones(len(every)) / len(every), along, 2.5e-4, 1.0, ())
    cut = chain.judge_cut(every, along, square, np.arange(len(every)) == across, square, square)
    assert min(cut.margin_pass, cut.margin_reject) > 2.5e-4
    found, held = hole_search.round_corners(given, (cut, [across]), 1e-3)
    area = shapely.Polygon(found.device.corners).area
    assert area == pytest.approx(shapely.Polygon(square.corners).area - (2.0 - 0.5 * np.pi) * 1e-6, rel=1e-3)
    assert held == [across] and found.margin_reject <= cut.margin_reject
    assert hole_search.round_corners(given, (cut, [across]), 6e-3) is None  # no such cutter goes in


def test_a_swept_face_may_lay_what_is_slender_across_the_track_over_to_the_side():
    """A plate on its long edge, 20 x 4 mm of foot and 12 high: mu z cos 30 deg = 0.6 x 6 x 0.87 > 2."""
    part = shapes.part(shapes.box(20, 12, 4))
    every = travelling(orientations(part, find(part), BOWL.track), BOWL)
    plate = next(one for one in every if one.length > 0.0199 and abs(one.height - 0.012) < 1e-6)
    square, swept = (
        make_device("wiper", "here", limit=6e-3, **own) for own in ({}, {"sweep": math.radians(30.0)})
    )
    assert verdict(square, plate, every).sure and not verdict(swept, plate, every).sure
    least = 2e-3 / math.cos(math.radians(30.0)) / 0.6
    assert may_lay_aside(plate, 1.01 * least, math.radians(30.0))
    assert not may_lay_aside(plate, 0.99 * least, math.radians(30.0))


def test_a_drive_out_of_phase_clears_faster():
    drive = BOWL.drive
    ahead = replace(BOWL, drive=replace(drive, phase=math.radians(-30.0)))
    against = replace(BOWL, drive=replace(drive, phase=math.radians(120.0)))
    sweep = math.radians(30.0)
    known = falling.along_blade(BOWL, sweep, 0.3)
    assert falling.along_blade(ahead, sweep, 0.3) > 1.1 * known
    assert falling.along_blade(against, sweep, 0.3) == 0.0


def test_several_nozzles_meet_every_orientation_and_one_blows_at_the_lowest_centre_of_mass():
    bracket = load(PARTS / "lbracket_30x20x15.stl")
    every = orientations(bracket, find(bracket), bowls.default().track)
    nozzles = Nozzles(2e-3, 3e5, count=4)
    heights = nozzles.heights(every)
    assert len(heights) == 4 and np.all(np.diff(heights) > 0.0)
    assert 0.0 < heights[0] < 3e-3 < heights[-1] < max(one.height for one in every)  # its legs are 3 mm thick
    assert min(nozzles.push(one, every)[0] for one in every) > 0.5 * nozzles.thrust
    lowest = min(one.posture.height for one in every)
    assert Nozzles(2e-3, 3e5).heights(every) == pytest.approx([lowest])
    assert Nozzles(2e-3, 3e5, 1e-3, 3).heights(every)[0] == 1e-3


def test_what_is_not_sure_to_be_returned_counts_against_a_chain():
    """A wiper may lay an upright block over, docs/tooling.md, section 1: the block may leave as well."""
    part, bowl = shapes.part(shapes.box(6, 6, 20)), bowls.read(None, ["track.width=30 mm"])
    every = travelling(orientations(part, find(part), bowl.track), bowl)
    tall = np.array([one.height > 0.019 for one in every])
    low, high = make_device("wiper", "w", limit=10e-3), make_device("gap", "g", limit=22e-3)
    flow = course([low], every)
    np.testing.assert_array_equal(flow.doubtful, np.where(tall, flow.starts, 0.0))
    assert not course([low, high], every).doubtful[tall].any()  # the gap is sure of it
    known = shares(part, bowl, rule="csa")
    lying = next(one for one in every if one.length > 0.019)
    found = rate(
        part, bowl, lying.aspect, heading=lying.heading, rule="csa", aspect_shares=known, devices=(low,)
    ).rate
    chance = found.orientations.rules["csa"]
    leaves = chance[~tall] @ found.orientations.leaves[~tall]
    doubt = (chance * found.orientations.stays)[tall].sum()
    row = chance[found.row] * found.orientations.leaves[found.row]
    assert found.purity == pytest.approx(row / (leaves + doubt)) and doubt > 0.0
    made_of_it = design_task(every, chance, found.row, 2.5e-4, 1.0, (low,))
    told_of_it = propose(made_of_it, (), np.zeros(len(every), bool))
    assert told_of_it.hopeful == pytest.approx(chance[found.row] / chance[~tall].sum())
    assert told_of_it.purity == pytest.approx(
        chance[found.row] / (chance[~tall].sum() + (chance * flow.starts)[tall].sum())
    )


def test_what_rolls_along_a_bank_may_miss_every_device():
    """Off the wall a gate does not meet it: a pin that lies across the track may leave."""
    part = shapes.part(shapes.cylinder(3.0, 20.0, 64))
    bowl = bowls.read(None, ["track.width=30 mm", "track.bank=6 deg"])
    every = travelling(orientations(part, find(part), bowl.track), bowl)
    across = np.array([one.along_a_bank for one in every])
    assert across.any() and not across.all()
    flow = course([make_device("gap", "g", limit=2e-3)], every)
    np.testing.assert_allclose(flow.doubtful[across], flow.starts[across] - flow.leaving.sum(axis=1)[across])
