"""What rests between two edges, against closed forms; what a hole lets go for certain."""

from dataclasses import replace

import numpy as np
import pytest
import shapely
import shapes

from feederscrew import bowl as bowls
from feederscrew.bowl.record import Track
from feederscrew.part import load
from feederscrew.rates.tipping import is_surely_gone
from feederscrew.resting.aspects import find
from feederscrew.tooling.devices.base import UNSURE
from feederscrew.tooling.devices.kinds import make_device
from feederscrew.tooling.falling import fits_as_it_lies, lets_go, may_rest, surely_gone
from feederscrew.tooling.fates import course
from feederscrew.tooling.isolating.chain import margin_at
from feederscrew.tooling.orientations import orientations, travelling
from feederscrew.tooling.verdicts import verdict

TRACK = Track(climb=0.0, bank=0.0, radius=100.0, width=0.2)
RADIUS = 5e-3
DISC = shapely.Point(0.0, 0.0).buffer(RADIUS, 64)
SQUARE = shapely.box(-5e-3, -5e-3, 5e-3, 5e-3)


@pytest.fixture(scope="module")
def block():
    """A block of 20 x 12 x 5 mm that lies flat, its long side along the wall."""
    part = shapes.part(shapes.box(20, 12, 5))
    every = orientations(part, find(part), TRACK)
    one = next(k for k in every if abs(k.height - 5e-3) < 1e-6 and abs(k.length - 20e-3) < 1e-6)
    return replace(one, grip=0.6, wall_grip=0.6)


@pytest.mark.parametrize(("width", "rests"), [(9.8e-3, True), (10.2e-3, False)])
def test_a_disc_rests_between_edges_nearer_than_its_diameter(width, rests):
    assert may_rest(DISC, width, 0.0) == rests


@pytest.mark.parametrize(("width", "rests"), [(5.2e-3, True), (9.8e-3, True), (10.2e-3, False)])
def test_a_disc_leans_on_a_wall_with_an_edge_nearer_than_its_diameter(width, rests):
    assert may_rest(DISC, width, 0.0, wall=True) == rests


@pytest.mark.parametrize(("width", "rests"), [(13.9e-3, True), (14.3e-3, False)])
def test_friction_holds_a_square_on_its_corner_between_edges_nearer_than_its_diagonal(width, rests):
    assert may_rest(SQUARE, width, 0.3) == rests
    assert not may_rest(SQUARE, width, 0.0)  # it goes over: its weight is highest there


def test_friction_holds_a_plate_that_else_slips_through():
    plate = shapely.box(-10e-3, -2.5e-3, 10e-3, 2.5e-3)
    assert not may_rest(plate, 12e-3, 0.0)
    assert may_rest(plate, 12e-3, 0.6)


def test_a_plate_lies_or_slips_down_by_the_wall_where_its_middle_is_beside_the_edge():
    """Of a slender plate of length 2 a at an angle t, its end at the wall, over an edge c from it.

    Its centre is a sin(t) - c tan(t) higher than the edge: lowest where it lies, if c < a, else nowhere.
    """
    plate = shapely.box(-10e-3, -0.1e-3, 10e-3, 0.1e-3)
    assert may_rest(plate, 9.9e-3, 0.0, wall=True)
    assert not may_rest(plate, 10.1e-3, 0.0, wall=True)


def test_what_is_hollow_may_catch_an_edge():
    hook = SQUARE.difference(shapely.box(0.0, 0.0, 5e-3, 5e-3))
    assert may_rest(hook, 14.3e-3, 0.0)


@pytest.mark.parametrize(
    ("kind", "limit", "goes"),
    [
        ("narrowed_track", 5e-3, True),
        ("canyon", 12.5e-3, True),
        ("gap", 12e-3, False),
        ("gap", 21e-3, True),
        ("wiper", 4e-3, True),
    ],
)
def test_a_gap_shorter_than_the_part_may_hold_it(block, kind, limit, goes):
    device = make_device(kind, "test", limit=limit)
    assert lets_go(device, block) == goes
    assert is_surely_gone([device], [block], [[1.0, 0.0]]) == [goes]
    assert is_surely_gone([device], [block], [[1.0, 1.0]]) == [True]  # it passes


@pytest.mark.parametrize(
    ("length", "width", "fits"), [(20.6, 12.3, True), (20.4, 12.3, False), (20.6, 12.2, False)]
)
def test_a_part_fits_through_a_hole_as_it_lies_with_room_all_round(block, length, width, fits):
    """A quarter of a millimetre; the wall needs none."""
    corners = 1e-3 * np.array([(0.0, 0.0), (length, 0.0), (length, width), (0.0, width)])
    assert fits_as_it_lies(block, corners) == fits


def test_a_tall_part_does_not_drop_through_a_hole_as_long_as_it_is(block):
    """It tips ahead as it comes, and its diagonal is longer than the hole."""
    corners = ((0.0, 0.0), (20.55e-3, 0.0), (20.55e-3, 13e-3), (0.0, 13e-3))
    hole = make_device("cut_out", "test", corners=corners)
    assert fits_as_it_lies(block, np.array(corners))
    assert not lets_go(hole, replace(block, grip=1.5))
    wide = make_device("cut_out", "test", corners=tuple((1.1 * x, y) for x, y in corners))
    assert lets_go(wide, block)


def test_a_blade_with_a_sweep_may_lay_over_what_turns_along_it(block):
    """At mu = 0.6 over the side 6 mm beside the weight, from 10 mm on."""
    low, high = (make_device("wiper", "test", limit=limit, sweep=0.5) for limit in (9.9e-3, 10.1e-3))
    assert is_surely_gone([low], [block], [[1.0, 0.0]]) == [True]
    assert is_surely_gone([high], [block], [[1.0, 0.0]]) == [False]
    assert is_surely_gone([replace(high, sweep=0.5 * np.pi)], [block], [[1.0, 0.0]]) == [
        True
    ]  # straight across


def test_a_design_does_not_count_on_what_may_catch_the_edge_of_a_canyon():
    """The bracket of parts/ on its two legs, over a strip of 18.85 mm: in a trial it stops there."""
    bracket, bowl = load("parts/lbracket_30x20x15.stl"), bowls.read(None, [])
    every = travelling(orientations(bracket, find(bracket), bowl.track), bowl)
    legs, alone = (next(one for one in every if one.name == name) for name in ("A@90", "A@270"))
    canyon = make_device("canyon", "c", limit=18.85e-3)
    assert verdict(canyon, legs, every).margin < -3e-3 and not surely_gone(canyon, legs)
    assert margin_at(canyon, legs, every) == -UNSURE and margin_at(canyon, alone, every) > 1e-3
    assert margin_at(canyon, replace(legs, grip=0.0), every) < -3e-3  # placed, not travelling
    flow, k = course([canyon], every), every.index(legs)
    assert flow.leaving[k].sum() == 0.0 and flow.doubtful[k] == pytest.approx(flow.starts[k])
    falls = next(k for k, one in enumerate(every) if surely_gone(canyon, one) and one.canyon < 18e-3)
    assert flow.doubtful[falls] == 0.0
