"""What becomes of a part that a device does not let pass: returned, stopped; and how long that takes."""

import math
from dataclasses import replace

import numpy as np
import pytest
import shapely

from feederscrew import bowl as bowls
from feederscrew.tooling import clearing
from feederscrew.tooling import foot as feet
from feederscrew.tooling.devices import hole_shapes
from feederscrew.tooling.devices.kinds import made
from feederscrew.tooling.falling_through import falls_through
from feederscrew.tooling.foot import Footprint

BOWL = bowls.read(None, ("track.climb=0 deg", "track.bank=0 deg"))


@pytest.mark.parametrize("friction", [0.1, 0.3, 0.6])
def test_a_face_clears_itself_below_a_right_angle_minus_its_friction_angle(friction):
    edge = clearing.limit(friction)
    assert math.degrees(edge) == pytest.approx(90.0 - math.degrees(math.atan(friction)))
    below = [clearing.along_blade(BOWL, share * edge, friction) for share in (0.5, 0.9)]
    assert below[0] > below[1] > 0.0
    assert clearing.along_blade(BOWL, edge + 1e-9, friction) == 0.0


def test_what_is_swept_is_faster_off_a_smoother_face_and_a_bank_holds_it_back():
    sweep = math.radians(30.0)
    slow, fast = (clearing.along_blade(BOWL, sweep, friction) for friction in (0.3, 0.1))
    banked = replace(BOWL, track=replace(BOWL.track, bank=math.radians(3.0)))
    assert 1e-3 < slow < fast < 15e-3
    assert clearing.along_blade(banked, sweep, 0.3) < slow


def test_only_what_a_face_sweeps_blocks_the_track():
    class One:
        track, distance = replace(BOWL.track, width=0.02), 0.005

    swept = made("wiper", "here", limit=6e-3, sweep=math.radians(30.0), friction=0.3)
    speed = clearing.along_blade(BOWL, math.radians(30.0), 0.3)
    assert clearing.seconds(swept, One, BOWL) == pytest.approx(0.015 / speed)
    assert clearing.seconds(made("gap", "here", limit=6e-3), One, BOWL) == 0.0


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


def test_a_hole_at_the_free_edge_holds_nothing_that_is_narrower_along_the_track():
    cut = 1e-3 * np.array([[0, 45], [60, 45], [60, 50], [0, 50]], float)
    assert falls_through(Slab, cut)


def test_three_points_do_not_carry_a_part_over_a_hole_larger_than_itself():
    points = 1e-3 * np.array([[-7.0, -4.0], [7.0, -4.0], [0.0, 4.0]])
    foot = Footprint(rings=(), edges=np.empty((0, 2, 2)), points=points)
    hole = hole_shapes.polygon(1e-3 * np.array([[0, 0.3], [60, 0.3], [60, 39], [0, 39]]), 0.15)
    assert feet.least(feet.standing(foot, 6e-3, 0.15), hole)[0] < 0.0
    small = hole_shapes.polygon(1e-3 * np.array([[0, 30], [5, 30], [5, 39], [0, 39]]), 0.15)
    whole = feet.least(feet.standing(foot, 6e-3, 0.15), small)[0]
    assert whole == pytest.approx(shapely.Polygon(points).exterior.distance(shapely.Point(0, 0)), abs=1e-6)
