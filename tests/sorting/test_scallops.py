"""Dish-out and cap selector: verdicts in closed form, and what a file says of them."""

import numpy as np
import pytest
import shapely.affinity
import trimesh
from on_track import block, device, lying, pick, read
from round_bodies import revolved

from feederscrew.base.errors import Faults
from feederscrew.bowl.devices.kinds import KINDS
from feederscrew.sorting.verdicts import DeviceEncounter, verdict


def arc_at(leaves, radius, x):
    """Distance from the wall [m] of the border of a round bay, so far beside its middle [mm]."""
    return 1e-3 * (leaves + radius - np.sqrt(radius**2 - x**2))


@pytest.mark.parametrize(("leaves", "radius"), [(4.0, 14.0), (3.1, 17.0), (4.6, 15.3)])
def test_a_block_bridges_a_bay_by_what_is_left_below_its_ends(leaves, radius):
    """Over the middle its ends rest up to the arc at half its length, c lies at b / 2: y(a / 2) - b / 2."""
    bay = device("dish-out", limit=1e-3 * leaves, radius=1e-3 * radius)
    for length, width in ((20, 12), (12, 20)):
        lies = pick(lying(block()), length=length, height=5)
        expected = arc_at(leaves, radius, 0.5 * length) - 0.5e-3 * width
        assert verdict(bay, lies).margin == pytest.approx(expected, abs=3e-5)
        # a track that is everywhere as narrow as the waist carries neither
        assert verdict(device("narrowed track", limit=1e-3 * leaves), lies).passes == 0.0


def test_a_bay_that_is_deeper_than_its_radius_goes_on_straight():
    """Its sides are 2 r apart: what is longer keeps its ends up to its outer side, and misses by nothing."""
    bay, lies = device("dish-out", limit=4e-3, radius=8e-3), pick(lying(block()), length=20, height=5)
    ring = bay.ring(20e-3)
    assert ring[0].tolist() == [0.0, 20e-3] and ring[-1].tolist() == [16e-3, 20e-3]
    assert ring[:, 1].min() == pytest.approx(4e-3)
    assert verdict(bay, lies).margin > 3e-3
    assert bay.fate(DeviceEncounter(pick(lying(block()), length=12, height=5))) == "returned"


def test_what_a_file_says_of_a_bay_comes_back_as_it_was(tmp_path):
    bay = read(tmp_path, "dish-out: {leaves: 7 mm, radius: 12 mm}").devices[0]
    assert (bay.limit, bay.radius) == (7e-3, 12e-3)
    assert bay.value_text() == "{leaves: 7 mm, radius: 12 mm}"
    assert bay.document_values() == {"value_mm": 7.0, "radius_mm": 12.0}
    assert not bay.misfits(20e-3) and bay.misfits(6e-3)
    with pytest.raises(Faults, match="radius"):
        read(tmp_path, "dish-out: {leaves: 7 mm, radius: 0 mm}")


def test_the_outline_of_a_shallow_bay_is_an_arc_of_its_radius():
    ring = device("dish-out", limit=12e-3, radius=30e-3).ring(20e-3)
    centre = [0.5 * (ring[0, 0] + ring[-1, 0]), 42e-3]
    assert np.hypot(*(ring - centre).T) == pytest.approx(np.full(len(ring), 30e-3))


CUP = [(0.0, 0.0), (0.0, 7.0), (10.0, 7.0), (10.0, 5.5), (1.5, 5.5), (1.5, 0.0)]  # [mm] height and radius


@pytest.fixture(scope="module")
def cup():
    """A cup of 14 x 10 mm with a mouth of 11 mm: on its mouth and on its bottom; its other orientations."""
    every = lying(trimesh.Trimesh(**trimesh.triangles.to_kwargs(revolved(CUP, 180))))
    flat = sorted((one for one in every if one.kind == "flat"), key=lambda one: one.foot.mouth)
    return {"bottom": flat[0], "mouth": flat[-1], "all": every}


def selector(land, length, tongue, reach):
    """A cap selector of four lengths [mm]."""
    sizes = {"limit": land, "length": length, "tongue": tongue, "reach": reach}
    return device("cap selector", **{name: 1e-3 * size for name, size in sizes.items()})


def held(foot, bay):
    """By how much a foot on a straight track holds the weight over a bay: hulls of what is left, everywhere.

    Own, by shapely alone: shares nothing with the verdict.
    """
    rings = sorted(map(shapely.Polygon, foot.foot.rings), key=lambda ring: -ring.area)
    area = rings[0].difference(rings[1]) if len(rings) > 1 else rings[0]
    hole = shapely.Polygon(bay.ring(50e-3))
    least = np.inf
    for place in np.linspace(-8e-3, bay.length + 8e-3, 600):
        weight = shapely.Point(place, foot.distance)
        left = shapely.affinity.translate(area, place, foot.distance).difference(hole).convex_hull
        inside = left.contains(weight)
        least = min(least, left.exterior.distance(weight) if inside else -left.distance(weight))
    return least


def test_a_mouth_is_as_wide_as_the_rim_is_inside(cup):
    assert cup["mouth"].foot.mouth == pytest.approx(5.5e-3, rel=1e-3)
    assert cup["bottom"].foot.mouth == 0.0
    assert all(one.foot.mouth == 0.0 for one in lying(block()))


@pytest.mark.parametrize("sizes", [(2.1, 20.0, 3.0, 11.0), (3.4, 22.5, 4.0, 9.3), (4.5, 21.0, 5.0, 10.0)])
def test_on_its_mouth_a_cup_falls_by_its_way_to_the_land(cup, sizes):
    """The tongue within the mouth and the ends beyond the rim hold nothing: d - land; the bottom rides on."""
    bay = selector(*sizes)
    falls, rides = (verdict(bay, cup[name]).margin for name in ("mouth", "bottom"))
    assert falls == pytest.approx(1e-3 * sizes[0] - cup["mouth"].distance, abs=2e-5)
    assert rides == pytest.approx(held(cup["bottom"], bay), abs=3e-5) and rides > 1e-4
    assert bay.fate(DeviceEncounter(cup["mouth"])) == "returned"


def test_a_tongue_that_reaches_the_rim_holds_a_cup_up(cup):
    """Its corners meet the rim sqrt(5.5^2 - 2.5^2) = 4.90 mm beyond the weight: at a reach of 11.90 mm."""
    assert verdict(selector(3.0, 21.0, 5.0, 11.8), cup["mouth"]).passes == 0.0
    assert verdict(selector(3.0, 21.0, 5.0, 12.0), cup["mouth"]).passes == 1.0


def test_a_selector_is_proposed_for_what_has_a_mouth_alone(cup):
    kind, every = KINDS["cap selector"], cup["all"]

    def proposed(wanted, others):
        met = [[DeviceEncounter(one, every) for one in some] for some in (wanted, others)]
        return kind.proposals(*met, every, "test")

    (bay,) = proposed([cup["bottom"]], [cup["mouth"]])
    assert verdict(bay, cup["bottom"]).margin > 1e-3 and verdict(bay, cup["mouth"]).margin < -1e-3
    assert not proposed([cup["mouth"]], [cup["bottom"]])  # its rim would fall first
    assert not proposed([cup["bottom"]], [one for one in every if one.kind == "rolling"])


def test_what_rolls_may_ride_over_a_selector(cup):
    """From edge to edge: no verdict that returns it is sure, as trials of a cap show."""
    rolls = [one for one in cup["all"] if one.kind == "rolling"]
    verdicts = [verdict(selector(3.85, 22.1, 3.0, 11.8), one) for one in rolls]
    assert verdicts and all(not judged.sure for judged in verdicts)


def test_what_a_file_says_of_a_selector_comes_back_as_it_was(tmp_path):
    words = "{land: 2 mm, length: 20 mm, tongue: 4 mm, reach: 11 mm}"
    bay = read(tmp_path, f"cap selector: {words}").devices[0]
    assert bay.value_text() == words and bay.lengths == (2e-3, 20e-3, 4e-3, 11e-3)
    assert bay.document_values() == {"value_mm": 2.0, "length_mm": 20.0, "tongue_mm": 4.0, "reach_mm": 11.0}
    assert not bay.misfits(16e-3) and bay.misfits(11e-3)
    with pytest.raises(Faults, match="no tongue in its bay"):
        read(tmp_path, "cap selector: {land: 2 mm, length: 20 mm, tongue: 4 mm, reach: 1 mm}")


def test_a_hole_may_have_two_sides_in_one_line(tmp_path):
    """As a bay with a tongue has on both sides of it: they do not meet, so that it does not cross itself."""
    bay = selector(2.0, 20.0, 4.0, 11.0)
    corners = ", ".join(f"[{1e3 * x:.9g} mm, {1e3 * y:.9g} mm]" for x, y in bay.ring(16e-3))
    hole = read(tmp_path, f"cut-out: [{corners}]").devices[0]
    assert np.array(hole.corners) == pytest.approx(bay.ring(16e-3))
