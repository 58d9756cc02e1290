"""What a blade lays over, what wedges between rails and what leans on the wall, against closed forms."""

from dataclasses import replace

import numpy as np
import pytest
import shapes

from feederscrew.bowl.record import Track
from feederscrew.rates import stream
from feederscrew.resting.aspects import find
from feederscrew.tooling import falling
from feederscrew.tooling.devices.kinds import make_device
from feederscrew.tooling.orientations import orientations
from feederscrew.tooling.verdicts import UNSURE, verdict

TRACK = Track(climb=0.0, bank=0.0, radius=100.0, width=0.2)


def lying(mesh, height):
    """The orientation of a part that is so high [mm]."""
    part = shapes.part(mesh)
    every = orientations(part, find(part), TRACK)
    return next(one for one in every if abs(one.height - 1e-3 * height) < 1e-6)


@pytest.fixture(scope="module")
def pin():
    return replace(lying(shapes.box(6, 6, 20), 20), grip=0.5)


@pytest.mark.parametrize(("low", "lays"), [(7.4e-3, False), (7.6e-3, True)])
def test_a_blade_lays_a_pin_over_from_a_height_on(pin, low, lays):
    """z = mu L + b (1 - mu^2) / mu = 0.5 6 mm + 3 mm 0.75 / 0.5 = 7.5 mm."""
    assert falling.may_lay_over(pin, low) == lays
    margin = verdict(make_device("wiper", "here", limit=low), pin).margin
    assert margin == pytest.approx(-UNSURE if lays else low - 20e-3)
    free = make_device("wiper", "here", limit=7.6e-3)
    assert verdict(free, replace(pin, grip=0.0)).margin == pytest.approx(-12.4e-3)  # one that is only placed


def test_an_opening_above_the_part_lays_it_over_as_a_blade_does(pin):
    corners = ((0.0, 0.0), (9e-3, 0.0), (9e-3, 7.6e-3), (0.0, 7.6e-3))
    assert verdict(make_device("profile", "here", corners=corners), pin).margin == -UNSURE
    narrow = ((0.0, 0.0), (4e-3, 0.0), (4e-3, 30e-3), (0.0, 30e-3))  # met at the foot: it stands
    assert verdict(make_device("profile", "here", corners=narrow), pin).margin == pytest.approx(
        -2e-3, rel=1e-3
    )


@pytest.mark.parametrize(("grip", "wedges"), [(0.57, False), (0.585, True)])
def test_a_hexagon_wedges_where_friction_exceeds_the_slope_of_its_sides(grip, wedges):
    """Its sides lean by 30 degrees from upright: tan 30 deg = 0.577."""
    turn = np.radians(60.0 * np.arange(6))
    bar = lying(shapes.prism(6.0 * np.column_stack([np.cos(turn), np.sin(turn)]), 30), 6.0 * np.sqrt(3.0))
    along = replace(bar, grip=grip, heading=bar.heading)
    middle = bar.distance
    assert falling.may_wedge(along, (middle - 4e-3, middle + 4e-3)) == wedges
    assert not falling.may_wedge(along, (middle - 2.5e-3, middle + 2.5e-3))  # it lies on its flat


def test_a_part_leans_on_the_wall_as_high_as_it_is_there():
    """A block of 6 mm with a rib of 10 mm along one side: that side at the wall, or the other."""
    rib = shapes.box(22, 3, 10)
    rib.apply_translation([0.0, 5.0, 2.0])  # both begin at the same level
    one = replace(lying(shapes.box(22, 13, 6).union(rib), 10), climbs=3e-4)
    dips = {falling.wall_holds(replace(one, heading=one.heading + turn), 4e-3) for turn in (0.0, np.pi)}
    mass = one.posture.height
    low, high = (3e-4 * (2.0 * height - mass) / 4e-3 for height in (6e-3, 10e-3))
    assert sorted(dips) == pytest.approx([low, high], rel=1e-9)


def test_the_margin_of_what_returns_is_that_of_the_first_device_that_does():
    part = shapes.part(shapes.box(20, 12, 5))
    kinds = (("wiper", 8e-3), ("gap", 10.5e-3), ("wiper", 4e-3))
    chain = [make_device(kind, "here", limit=limit) for kind, limit in kinds]
    known = stream.follow_orientations(part, find(part), TRACK, chain)
    along = next(k for k, one in enumerate(known.lying) if one.height < 6e-3 and one.length > 0.015)
    assert known.margins[along, 1:] == pytest.approx([3e-3, -0.5e-3, -1e-3], rel=1e-2)
    assert known.margin[along] == pytest.approx(-0.5e-3, rel=1e-2)


@pytest.mark.parametrize("sweep", [0.3, 0.7])
def test_a_swept_blade_lays_a_pin_aside_from_a_height_on(pin, sweep):
    """Over a side 3 mm from the weight: mu z cos(a) = 3 mm, a the lesser of both its angles to the push."""
    height = 3e-3 / (0.5 * max(np.cos(sweep), np.sin(sweep)))
    assert not falling.may_lay_aside(pin, 0.99 * height, sweep)
    assert falling.may_lay_aside(pin, 1.01 * height, sweep)
