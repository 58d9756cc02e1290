"""What the drive lets lie on little: over an edge across the track, and beside one along it."""

from dataclasses import replace

import numpy as np
import pytest
import shapes

from feederscrew import bowl as bowls
from feederscrew.mechanics.track_balance import seat
from feederscrew.rates import stream, tipping
from feederscrew.rates.tipping import over_period, steady
from feederscrew.resting.aspects import find
from feederscrew.tooling.devices.kinds import make_device
from feederscrew.tooling.orientations import orientations

BOWL = bowls.read(None, ["track.radius=100 m"])
CLEAR = 2.5e-4


@pytest.fixture(scope="module")
def upright():
    """A pin 10 mm wide and 14 mm high."""
    part = shapes.part(shapes.box(10, 10, 14))
    return next(one for one in orientations(part, find(part), BOWL.track) if one.height > 0.012)


def is_steady(one, kind, limit, bowl=BOWL, margin=CLEAR):
    (found,) = steady([make_device(kind, "test", limit=limit)], [one], bowl, margin)
    return found


def farthest(one):
    """Farthest that the force of the track acts from below the centre of mass [m]."""
    place = seat(one.posture, one.heading, one.touching, BOWL.track.bank)
    return float(np.abs(over_period(place, BOWL)[1][:, 0]).max())


def test_over_a_gap_a_part_rocks_over_where_little_carries_it(upright):
    """The gap leaves half its width less the gap: it goes over well below the force's farthest place only."""
    assert 2e-3 < farthest(upright) < 4.9e-3
    carried = np.array([0.01e-3, 0.05e-3, 0.1e-3, 2e-3, 4e-3])
    assert upright.gap == pytest.approx(5e-3, abs=1e-6)
    told = [is_steady(upright, "gap", upright.gap - one) for one in carried]
    assert told == [False, False, False, True, True]


def test_a_hole_across_the_track_is_judged_as_the_gap_it_is(upright):
    for limit in (upright.gap - 0.05e-3, upright.gap - 2e-3):
        corners = ((0.0, 0.0), (limit, 0.0), (limit, 0.1), (0.0, 0.1))
        (hole,) = steady([make_device("cut_out", "test", corners=corners)], [upright], BOWL, CLEAR)
        assert hole == is_steady(upright, "gap", limit)


@pytest.mark.parametrize("kind", ["narrowed_track", "canyon"])
def test_beside_an_edge_along_the_track_the_force_stays_within_what_is_left(upright, kind):
    """Ahead and behind half the width is left, to the side what the edge leaves."""
    ahead = 5e-3 - farthest(upright)
    limits = {"narrowed_track": (6e-3, 12e-3), "canyon": (4e-3, 0.0)}[kind]
    assert is_steady(upright, kind, limits[0], margin=min(ahead, 1e-3) - 1e-6)
    assert not is_steady(upright, kind, limits[0], margin=min(ahead, 1e-3) + 1e-6)
    assert is_steady(upright, kind, limits[1], margin=1.0)  # which takes nothing from it


def test_nothing_is_said_behind_rails_or_of_a_drive_that_is_not_followed(upright):
    limit = upright.gap - 0.01e-3
    rails, gap = make_device("rails", "test", span=(0.1, 0.11)), make_device("gap", "test", limit=limit)
    assert steady([rails, gap], [upright], BOWL, CLEAR).all()
    assert not steady([gap, rails], [upright], BOWL, CLEAR).any()
    assert is_steady(replace(upright, touching=None), "gap", limit)
    for more in ("drive.amplitude=0.5 mm", "drive.second_harmonic=0.3"):
        assert is_steady(upright, "gap", limit, bowls.read(None, ["track.radius=100 m", more]))


def test_what_rolls_along_the_track_rocks_over_a_gap_as_what_is_flat_does(upright):
    """What rolls across it is not followed: only what takes nothing from it leaves it as it is."""
    along = replace(upright, kind="rolling", posture=replace(upright.posture, axis=np.array([1.0, 0.0])))
    across = replace(along, posture=replace(along.posture, axis=np.array([0.0, 1.0])))
    for carried, steadily in ((0.01e-3, False), (2e-3, True)):
        assert is_steady(along, "gap", upright.gap - carried) == steadily
        assert not is_steady(across, "gap", upright.gap - carried)
    assert is_steady(across, "canyon", 0.0)


def test_what_is_round_is_sure_of_nothing_without_a_bank():
    """A pin along the track rolls off a level one; towards the wall of a banked one it rolls, and stays."""
    pin = shapes.part(shapes.cylinder(6, 20, 48))
    aspects = find(pin)

    def said(bank):
        bowl = bowls.read(None, ["track.width=30 mm", f"track.bank={bank} deg"])
        sorter = make_device("sorter", "test", like=("A", 0.0, 2e-3), sees="height")
        found = stream.follow_orientations(pin, aspects, bowl.track, [sorter], bowl=bowl)
        row = next(k for k, one in enumerate(found.lying) if one.kind == "rolling" and one.length > 0.019)
        return found.sure[row]

    assert not said(0.0) and said(3.0)


@pytest.mark.parametrize(
    ("kind", "limit", "takes"),
    [
        ("wiper", 3e-3, False),
        ("gap", 3e-3, True),
        ("narrowed_track", 9e-3, True),
        ("narrowed_track", 11e-3, False),
    ],
)
def test_a_blade_takes_nothing_from_under_a_part_and_a_gap_what_it_is_wide(upright, kind, limit, takes):
    assert bool(tipping._takes(make_device(kind, "test", limit=limit), upright)) == takes
