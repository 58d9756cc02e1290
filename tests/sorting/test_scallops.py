"""Dish-out: its verdict in closed form, its file, and that a trial does as the verdict says."""

import numpy as np
import pytest
from on_track import block, device, lying, pick, read

from feederscrew.errors import Faults
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
