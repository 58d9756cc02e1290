"""What becomes of a part that a device does not let pass: returned, stopped, held at an edge."""

import math
from dataclasses import replace

import numpy as np
import pytest
import shapely
import shapes
from on_track import block, coming, device, load, lying, named, pick

from feederscrew import bowl as bowls
from feederscrew.base.errors import ArgumentError
from feederscrew.base.running import RunSettings
from feederscrew.bowl.devices import openings
from feederscrew.bowl.devices.base import UNSURE
from feederscrew.resting.aspects import find
from feederscrew.sorting import falling, footprints
from feederscrew.sorting.falling import falls_through, fits_as_it_lies, lets_go, may_rest, surely_gone
from feederscrew.sorting.fates import course
from feederscrew.sorting.footprints import Footprint
from feederscrew.sorting.isolating import chain, hole_search
from feederscrew.sorting.isolating.chain import design_task, propose
from feederscrew.sorting.isolating.design import DESIGN_MARGIN_M
from feederscrew.sorting.orientations import add_travel, orientations
from feederscrew.sorting.tipping import is_surely_gone
from feederscrew.sorting.tooling import ToolingSearch, tooling
from feederscrew.sorting.verdicts import verdict
from feederscrew.trials.course import SentParts
from feederscrew.trials.course import course as run_course

BOWL = bowls.read(None, ("track.climb=0 deg", "track.bank=0 deg"))
BROAD = replace(BOWL.track, width=0.04)
SWEEP = math.radians(30.0)
BANKED = bowls.read(None, ["track.width=30 mm", "track.bank=6 deg"])
OWN = {"search": ToolingSearch(rule="csa"), "without": "cut-out"}


def rectangle(length, width, first=0.0):
    """Corners [m] of a rectangle [mm] that begins so far off the wall."""
    return 1e-3 * np.array([[0, first], [length, first], [length, first + width], [0, first + width]], float)


def test_a_face_clears_itself_below_a_right_angle_minus_its_friction_angle():
    """Only what it sweeps blocks the track, and a drive out of phase clears it faster."""
    for friction in (0.1, 0.3, 0.6):
        edge = falling.clearing_limit(friction)
        assert math.degrees(edge) == pytest.approx(90.0 - math.degrees(math.atan(friction)))
        slow, fast = (falling.along_blade(BOWL, share * edge, friction) for share in (0.9, 0.5))
        assert fast > slow > 0.0 and falling.along_blade(BOWL, edge + 1e-9, friction) == 0.0

    class One:
        track, distance = replace(BOWL.track, width=0.02), 0.005

    speed = falling.along_blade(BOWL, SWEEP, 0.3)
    swept = device("wiper", limit=6e-3, sweep=SWEEP, friction=0.3)
    assert falling.clearing_time(swept, One, BOWL) == pytest.approx(0.015 / speed)
    assert falling.clearing_time(device("gap", limit=6e-3), One, BOWL) == 0.0
    drives = (replace(BOWL.drive, phase=math.radians(phase)) for phase in (-30.0, 120.0))
    ahead, against = (replace(BOWL, drive=drive) for drive in drives)
    assert falling.along_blade(ahead, SWEEP, 0.3) > 1.1 * speed
    assert falling.along_blade(against, SWEEP, 0.3) == 0.0


@pytest.mark.parametrize(("throw", "least", "most"), [(0.95, 0.6, 1.7), (1.8, 0.6, 1.7)])
def test_what_hops_clears_a_blade_as_fast_as_in_the_trial(throw, least, most):
    # the speed of a block along a swept wiper, from where it begins to slide to the free edge
    stroke = 1e3 * throw * 9.80665 / ((100.0 * math.pi) ** 2 * math.sin(math.radians(20.0)))
    track = ("track.bank=3 deg", "track.climb=3 deg", "track.radius=150 mm", "track.width=14 mm")
    drive = (f"drive.amplitude={stroke:.5f} mm", "drive.frequency=50 Hz", "drive.vibration_angle=20 deg")
    bowl = bowls.read(None, (*track, *drive, "drive.phase=0 deg"))
    part = shapes.part(shapes.box(16, 12, 8), "block")
    here = add_travel(orientations(part, find(part), bowl.track), bowl)
    row = next(k for k, one in enumerate(here) if abs(one.height - 8e-3) < 1e-6 and one.length > 0.015)
    blade = device("wiper", limit=5e-3, sweep=SWEEP, friction=0.3)
    followed = run_course(part, bowl, here, SentParts([row], 4), (blade,), run=RunSettings(1))
    ride, speeds = followed.rides[1], []
    for path, seconds in zip(ride.paths, ride.seconds):
        path = path[np.isfinite(path[:, 0])]
        off = 0.15 - np.hypot(path[:, 1], 0.15 - path[:, 2])
        begins = np.flatnonzero(off > off[0] + 7e-4)[0]
        speeds.append((0.014 - off[begins]) / (path[0, 0] + seconds - path[begins, 0]))
    assert least < np.median(speeds) / falling.along_blade(bowl, SWEEP, 0.3) < most


class Slab:
    """A box 20 x 18 x 4 mm, lying."""

    heading, track = 0.3, replace(BOWL.track, width=0.05)

    class posture:
        corners = np.array([[x, y, z] for x in (-0.01, 0.01) for y in (-9e-3, 9e-3) for z in (0.0, 4e-3)])


class Wedge(Slab):
    """30 mm long and 14 mm high at its back, thin at its tip."""

    class posture:
        corners = 1e-3 * np.array([[x, y, z] for x, z in ((15, 0), (15, 14), (-15, 0)) for y in (-6.0, 6.0)])


@pytest.mark.parametrize(
    ("body", "heading", "length", "width", "through"),
    [
        # The slab goes on edge through a slit wider than it is thick, and longer than the side along it.
        (Slab, 0.0, 60, 40, True), (Slab, 0.0, 60, 5, True), (Slab, 0.0, 60, 4, False),
        (Slab, 0.0, 21, 5, True), (Slab, 0.0, 19, 5, False),
        # A wedge is the shortest from above where its long face stands upright, either end ahead:
        # 30 * 14 / sqrt(30^2 + 14^2) = 12.7 mm; about its other end no shadow is shorter than its back.
        (Wedge, 0.0, 13.9, 20, True), (Wedge, 0.0, 13.0, 20, False),
        (Wedge, math.pi, 13.9, 20, True), (Wedge, math.pi, 13.0, 20, False),
    ],
)  # fmt: skip
def test_a_hole_lets_through_what_some_shadow_of_the_part_fits(body, heading, length, width, through):
    part = type("Turned", (body,), {"heading": heading})
    assert falls_through(part, rectangle(length, width, 3)) == through


def test_a_convex_hole_says_what_any_hole_does():
    """With a side bent inwards by a hair a hole is not convex: then its border is swept by the shadow."""
    rng, verdicts = np.random.default_rng(7), []
    for _ in range(40):
        hole = shapely.MultiPoint(rng.uniform(0.0, 1.0, (6, 2)) * [50e-3, 35e-3] + [0.0, 5e-3]).convex_hull
        ring = shapely.get_coordinates(shapely.geometry.polygon.orient(hole))[:-1]
        middle = 0.5 * (ring[0] + ring[-1])
        verdicts.append(falls_through(Slab, ring))
        bent = np.vstack([ring, middle + 1e-6 * (ring.mean(axis=0) - middle)])
        assert verdicts[-1] == falls_through(Slab, bent)
    assert 7 < sum(verdicts) < 33


def test_three_points_do_not_carry_a_part_over_a_hole_larger_than_itself():
    points = 1e-3 * np.array([[-7.0, -4.0], [7.0, -4.0], [0.0, 4.0]])
    foot = footprints.axial_foot(Footprint((), np.empty((0, 2, 2)), points), 6e-3, 0.15)
    large, small = (openings.polygon(rectangle(*size), 0.15) for size in ((60, 38.7, 0.3), (5, 9, 30)))
    assert footprints.least(foot, large)[0] < 0.0
    whole = shapely.Polygon(points).exterior.distance(shapely.Point(0, 0))
    assert footprints.least(foot, small)[0] == pytest.approx(whole, abs=1e-6)


def test_a_sorter_blows_off_what_looks_other_than_its_own_by_more_than_its_play():
    every = lying(block(), BROAD)
    along, across = pick(every, 20), pick(every, 12)
    own = {"like": (along.aspect, along.heading, 5e-4)}
    sorter = device("vision reject", **own)
    assert verdict(sorter, along, every).margin == pytest.approx(4e-4)  # its play without the blur
    assert verdict(sorter, across, every).margin == pytest.approx(5e-4 - 8e-3 + 1e-4, abs=2e-4)
    weak = verdict(device("vision reject", **own, time=1e-4), across, every)
    assert weak.passes == 1.0 and not weak.sure
    blind = device("vision reject", **own, sees="height")
    assert verdict(blind, across, every).passes == verdict(blind, along, every).passes == 1.0
    # A cutter leaves round corners and a smaller hole.
    along, across = (every.index(pick(every, length, 5)) for length in (20, 12))
    square = device("cut-out", corners=tuple(map(tuple, rectangle(13, 11.5))))
    task = design_task(every, np.ones(len(every)) / len(every), along, 2.5e-4, 1.0, ())
    cut = chain.judge_cut(every, along, square, np.arange(len(every)) == across, square, square)
    assert min(cut.margin_pass, cut.margin_reject) > 2.5e-4
    rounded, held = hole_search.round_corners(task, (cut, [across]), 1e-3)
    areas = [shapely.Polygon(one.corners).area for one in (rounded.device, square)]
    assert areas[0] == pytest.approx(areas[1] - (2.0 - 0.5 * np.pi) * 1e-6, rel=1e-3)
    assert held == [across] and rounded.margin_reject <= cut.margin_reject
    assert hole_search.round_corners(task, (cut, [across]), 6e-3) is None  # no such cutter goes in


def test_other_ways_up_that_count_are_not_returned_and_play_is_added_to_every_margin():
    plate = block(22, 13, 6)
    single, both = (tooling(plate, BOWL, "A", **up, **OWN).design for up in ({}, {"up": "a,B"}))
    assert both.isolated and both.efficiency > single.efficiency and both.purity > 0.999
    assert not any(name.startswith("B") for cut in both.cuts for name in cut.returns)
    with pytest.raises(ArgumentError, match=r"up: .* has no aspect 'Q' - choose one of A, B, C"):
        tooling(plate, BOWL, "A", up="Q", **OWN)
    loose = tooling(plate, BOWL, "A", play=2e-4, tolerance=1e-4, **OWN)
    assert loose.margin == pytest.approx(DESIGN_MARGIN_M + 3e-4)
    ends = [end for cut in loose.design.cuts for end in (cut.margin_pass, cut.margin_reject)]
    assert min(end for end in ends if end == end) >= DESIGN_MARGIN_M + 3e-4 - 1e-9


def test_what_is_laid_over_is_not_sure_and_counts_against_a_chain_as_does_what_a_bank_takes_past_devices():
    """A plate on its long edge, 20 x 4 mm of foot and 12 high: mu z cos 30 deg = 0.6 x 6 x 0.87 > 2."""
    every = coming(block(20, 12, 4), BOWL)
    plate = pick(every, 20, 12)
    square, swept = (device("wiper", limit=6e-3, **own) for own in ({}, {"sweep": SWEEP}))
    assert verdict(square, plate, every).sure and not verdict(swept, plate, every).sure
    least = 2e-3 / math.cos(SWEEP) / 0.6
    assert falling.may_lay_aside(plate, 1.01 * least, SWEEP)
    assert not falling.may_lay_aside(plate, 0.99 * least, SWEEP)
    # A wiper may lay an upright block over, docs/tooling.md, section 1: the block may leave as well.
    every = coming(block(6, 6, 20))
    tall = np.array([one.height > 0.019 for one in every])
    low, high = device("wiper", limit=10e-3), device("gap", limit=22e-3)
    flow = course([low], every)
    np.testing.assert_array_equal(flow.doubtful, np.where(tall, flow.starts, 0.0))
    assert not course([low, high], every).doubtful[tall].any()  # the gap is sure of it
    chance, row = np.array([one.chances["csa"] for one in every]), every.index(pick(every, 20))
    proposed = propose(design_task(every, chance, row, 2.5e-4, 1.0, (low,)), (), np.zeros(len(every), bool))
    others = chance[~tall].sum()
    assert proposed.hopeful == pytest.approx(chance[row] / others)
    assert proposed.purity == pytest.approx(chance[row] / (others + (chance * flow.starts)[tall].sum()))
    # Off the wall a gate does not meet it: a pin that lies across the track may leave.
    every = coming(shapes.cylinder(3.0, 20.0, 64), BANKED)
    across = np.array([one.along_a_bank for one in every])
    assert across.any() and not across.all()
    flow = course([device("gap", limit=2e-3)], every)
    np.testing.assert_allclose(flow.doubtful[across], flow.starts[across] - flow.leaving.sum(axis=1)[across])


DISC = shapely.Point(0.0, 0.0).buffer(5e-3, 64)
SQUARE = shapely.box(-5e-3, -5e-3, 5e-3, 5e-3)
PLATE = shapely.box(-10e-3, -2.5e-3, 10e-3, 2.5e-3)
THIN = shapely.box(-10e-3, -0.1e-3, 10e-3, 0.1e-3)
HOOK = SQUARE.difference(shapely.box(0.0, 0.0, 5e-3, 5e-3))


@pytest.mark.parametrize(
    ("body", "width", "friction", "wall", "rests"),
    [
        # a disc rests between edges nearer than its diameter, or a wall and such an edge
        (DISC, 9.8, 0.0, False, True), (DISC, 10.2, 0.0, False, False),
        (DISC, 5.2, 0.0, True, True), (DISC, 9.8, 0.0, True, True), (DISC, 10.2, 0.0, True, False),
        # a square on its corner by friction, nearer than its diagonal; else it goes over, highest there
        (SQUARE, 13.9, 0.3, False, True), (SQUARE, 14.3, 0.3, False, False),
        (SQUARE, 13.9, 0.0, False, False), (SQUARE, 14.3, 0.0, False, False),
        (PLATE, 12.0, 0.0, False, False), (PLATE, 12.0, 0.6, False, True),  # else it slips through
        # The centre of a slender plate of length 2 a at an angle t, its end at the wall, over an edge c from
        # it, is a sin(t) - c tan(t) higher than the edge: lowest where it lies, if c < a, else nowhere.
        (THIN, 9.9, 0.0, True, True), (THIN, 10.1, 0.0, True, False),
        (HOOK, 14.3, 0.0, False, True),  # what is hollow may catch an edge
    ],
)  # fmt: skip
def test_what_rests_between_two_edges(body, width, friction, wall, rests):
    assert may_rest(body, 1e-3 * width, friction, wall=wall) == rests


@pytest.fixture(scope="module")
def flat():
    """A block of 20 x 12 x 5 mm that lies flat, its long side along the wall."""
    return replace(pick(lying(block()), 20, 5), grip=0.6, wall_grip=0.6)


@pytest.mark.parametrize(
    ("kind", "values", "goes"),
    [
        ("narrowed track", {"limit": 5e-3}, True), ("canyon", {"limit": 12.5e-3}, True),
        ("gap", {"limit": 12e-3}, False),  # shorter than the part: it may hold it
        ("gap", {"limit": 21e-3}, True), ("wiper", {"limit": 4e-3}, True),
        # a sweep may lay over what turns along it: at mu = 0.6 over the side 6 mm off its weight, from 10 mm
        ("wiper", {"limit": 9.9e-3, "sweep": 0.5}, True), ("wiper", {"limit": 10.1e-3, "sweep": 0.5}, False),
        ("wiper", {"limit": 10.1e-3, "sweep": 0.5 * np.pi}, True),  # straight across
    ],
)  # fmt: skip
def test_what_goes_for_certain(flat, kind, values, goes):
    one = device(kind, **values)
    assert is_surely_gone([one], [flat], [[1.0, 0.0]]) == [goes]
    assert "sweep" in values or lets_go(one, flat) == goes
    assert is_surely_gone([one], [flat], [[1.0, 1.0]]) == [True]  # it passes


def test_a_part_fits_through_a_hole_as_it_lies_with_room_all_round_but_tips_ahead_as_it_comes(flat):
    """A quarter of a millimetre; the wall needs none. The diagonal of a tall part is longer than the hole."""
    for length, width, fits in ((20.6, 12.3, True), (20.4, 12.3, False), (20.6, 12.2, False)):
        assert fits_as_it_lies(flat, rectangle(length, width)) == fits
    short, wide = (rectangle(share * 20.55, 13.0) for share in (1.0, 1.1))
    assert fits_as_it_lies(flat, short)
    assert not lets_go(device("cut-out", corners=tuple(map(tuple, short))), replace(flat, grip=1.5))
    assert lets_go(device("cut-out", corners=tuple(map(tuple, wide))), flat)


def test_a_design_does_not_count_on_what_may_catch_the_edge_of_a_canyon():
    """The bracket of parts/ on its two legs, over a strip of 18.85 mm: in a trial it stops there."""
    every = coming(load("lbracket_30x20x15"), bowls.read(None, []))
    legs, alone = named(every, "A@90", "A@270")
    canyon = device("canyon", limit=18.85e-3)
    assert verdict(canyon, legs, every).margin < -3e-3 and not surely_gone(canyon, legs)
    assert chain.margin_at(canyon, legs, every) == -UNSURE and chain.margin_at(canyon, alone, every) > 1e-3
    assert chain.margin_at(canyon, replace(legs, grip=0.0), every) < -3e-3  # placed, not travelling
    flow, k = course([canyon], every), every.index(legs)
    assert flow.leaving[k].sum() == 0.0 and flow.doubtful[k] == pytest.approx(flow.starts[k])
    falls = next(k for k, one in enumerate(every) if surely_gone(canyon, one) and one.canyon < 18e-3)
    assert flow.doubtful[falls] == 0.0
