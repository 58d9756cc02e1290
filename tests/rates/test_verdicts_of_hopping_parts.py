"""Verdicts of parts that a drive throws: their margins less hop and flight, and what landings may turn."""

import math
from dataclasses import replace

import numpy as np
import pytest
import shapes
from scipy.optimize import brentq

from feederscrew import bowl as bowls
from feederscrew.conveying.answer import throw_number
from feederscrew.conveying.hop import hop
from feederscrew.rates import stream, tipping
from feederscrew.rates.tipping import steady
from feederscrew.resting.aspects import find
from feederscrew.tooling.devices.base import UNSURE
from feederscrew.tooling.devices.kinds import make_device
from feederscrew.tooling.isolating.chain import candidates
from feederscrew.tooling.verdicts import verdict

FAST = ("drive.frequency=100 Hz", "drive.vibration_angle=20 deg", "track.bank=3 deg", "restitution=0.3")
AMPLITUDE = {0.9: 0.0655, 1.8: 0.1309, 2.4: 0.1746}  # [mm] by throw number, at 100 Hz


def thrown(throw, *more):
    return bowls.read(None, (*FAST, f"drive.amplitude={AMPLITUDE[throw]} mm", *more))


def lying(bowl, *sizes, chain=()):
    part = shapes.part(shapes.box(*sizes))
    return stream.follow_orientations(part, find(part), bowl.track, chain, bowl=bowl)


def one_of(bowl, *sizes, length):
    """The orientation of the lowest aspect of a box that is so long [mm] along the track."""
    found = [
        one for one in lying(bowl, *sizes).lying if math.isclose(one.length, 1e-3 * length, rel_tol=1e-3)
    ]
    return min(found, key=lambda one: one.height)


@pytest.mark.parametrize(
    ("kind", "values", "less"),
    [
        ("gap", {"limit": 8e-3}, "flight"),
        ("gap", {"limit": 18e-3}, "flight"),
        ("wiper", {"limit": 6e-3}, "hop"),
        ("wiper", {"limit": 4e-3}, "hop"),
        ("height_bar", {"limit": 6e-3}, "hop"),
        ("narrowed_track", {"limit": 10e-3}, "hop"),
        ("narrowed_track", {"limit": 4e-3}, "hop"),
        ("sorter", {"sees": "side"}, "hop"),
        ("sorter", {}, ""),
        ("rails", {"span": (4e-3, 8e-3)}, ""),
    ],
)
def test_a_margin_is_less_the_hop_or_the_flight_to_either_side(kind, values, less):
    """Over a gap the way of a flight; under a blade and beside a ledge the height of the hop."""
    bowl = thrown(1.8)
    known = hop(bowl)
    one = one_of(bowl, 20, 12, 5, length=20)
    assert (one.hop, one.flight) == (known.height, known.flight) and 0.0 < one.hop < one.flight
    values = values | ({"like": (one.aspect, one.heading, 2e-3)} if kind == "sorter" else {})
    device, still = make_device(kind, "", **values), replace(one, hop=0.0, flight=0.0)
    by = getattr(one, less) if less else 0.0
    found, before = verdict(device, one, (one,)), verdict(device, still, (still,))
    assert abs(before.margin) > 2.0 * by
    assert found.margin == pytest.approx(before.margin - math.copysign(by, before.margin), abs=1e-12)
    assert found.passes == before.passes


@pytest.mark.parametrize(("hops", "passes"), [(0.9, 1.0), (-0.9, 0.0), (1.1, 1.0), (-1.1, 0.0)])
def test_within_a_hop_nothing_is_sure_either_way(hops, passes):
    one = one_of(thrown(2.4), 20, 12, 5, length=20)
    found = verdict(make_device("wiper", "", limit=5e-3 + hops * one.hop), one)
    assert found.passes == passes
    assert found.sure == (abs(hops) > 1.0) == (abs(found.margin) > UNSURE)


def test_a_drive_that_does_not_throw_changes_nothing():
    for one in lying(thrown(0.9), 20, 12, 5).lying:
        assert (one.hop, one.flight, one.may_tip) == (0.0, 0.0, False)
    assert not any(one.may_yaw for one in lying(thrown(0.9, "track.bank=0 deg"), 20, 10, 5).lying)


def test_a_design_keeps_its_margin_beside_the_hop():
    every = lying(thrown(2.4), 20, 12, 5).lying
    wanted = int(np.argmin([one.height - one.length for one in every]))
    for device, margins in candidates(every, wanted, 2.5e-4).items():
        assert margins[wanted] >= 2.5e-4 - 1e-9, device.kind


@pytest.mark.parametrize(("length", "tips"), [(11.9, True), (12.1, False)])
def test_the_track_drags_the_foot_away_below_what_is_higher_than_its_friction_allows(length, tips):
    """mu h > b: 0.6 x 10 mm against half the length; the hop at the throw number 1.8 is 0.04 mm."""
    assert one_of(thrown(1.8), length, 25, 20, length=length).may_tip == tips


@pytest.mark.parametrize(("x", "y", "share"), [(4.0, 9.0, 1.0), (9.0, 4.0, 0.25 * 1.3**2)])
def test_the_energy_of_a_landing_lifts_a_part_over_its_side(x, y, share):
    """sqrt(h^2 + b^2) - h = 1 mm at h = 7.5 mm, b = 4 mm; across, (1 + e)^2 / 4 of the energy, by hand."""
    bowl = thrown(1.8, "friction.static=0.05", "friction.wall=0.6")
    one = one_of(thrown(1.8), 30, 30.1, 15, length=30)
    contact = 1e-3 * np.array([[-x, -9.0], [x, -9.0], [x, y], [-x, y]])
    assert one.posture.height == pytest.approx(7.5e-3)
    for energy, tips in ((1.02e-3, True), (0.98e-3, False)):
        assert tipping.may_tip(contact, one, bowl, energy / share) == tips
    assert tipping.may_tip(contact, one, bowl, 0.98e-3 / share, margin=2e-4)


def test_the_energy_is_that_of_the_hardest_landing():
    """The parabola of a plastic point mass between take-off, sin(a) = 1 / k, and landing; nothing below 1."""
    bowl = thrown(1.8, "restitution=0")
    k, rate = throw_number(bowl), 2.0 * math.pi * bowl.drive.frequency
    weight = bowl.gravity * math.cos(bowl.track.climb)

    def gap(turn):
        way = turn - leaves
        return k * (math.sin(leaves) - math.sin(turn) + math.cos(leaves) * way) - 0.5 * way**2

    leaves = math.asin(1.0 / k)
    lands = brentq(gap, leaves + 1.0, leaves + 6.0)
    speed = weight / rate * (k * (math.cos(leaves) - math.cos(lands)) - (lands - leaves))
    assert tipping.landing_energy(bowl) == pytest.approx(speed**2 / (2.0 * bowl.gravity), rel=5e-3)
    assert tipping.landing_energy(thrown(0.9)) == 0.0


@pytest.mark.parametrize(("wide", "yaws"), [(11.0, True), (13.0, False)])
def test_the_wall_turns_what_it_holds_before_its_corner(wide, yaws):
    """mu d > x: 0.6 x 10 mm against half of what lies at the wall, thrown or pressed on by a bank."""
    for bowl in (thrown(1.8), thrown(1.8, "track.bank=0 deg"), thrown(0.9)):
        assert one_of(bowl, 20, wide, 4, length=wide).may_yaw == yaws
    assert one_of(bowl, 20, wide, 4, length=wide).may_yaw == yaws
    assert not one_of(bowl, 20, wide, 4, length=20).may_yaw


def test_what_is_round_has_no_heading_to_lose():
    part = shapes.part(shapes.cylinder(7, 5, 48))
    flat = stream.follow_orientations(part, find(part), thrown(1.8).track, bowl=thrown(1.8)).lying[0]
    assert flat.kind == "flat" and not flat.may_yaw


def test_no_verdict_of_what_may_turn_is_sure_unless_every_heading_is_returned():
    bowl = thrown(1.8)
    known = lying(bowl, 20, 10, 4)
    assert known.sure.tolist() == [not one.may_turn for one in known.lying]
    flat = known.lying[0].aspect
    yaws = np.array([one.may_yaw and not one.may_tip for one in known.lying])
    assert yaws[[one.aspect == flat for one in known.lying]].any()
    high = lying(bowl, 20, 10, 4, chain=(make_device("narrowed_track", "", limit=1e-3),))
    rows = np.array([one.aspect == flat for one in high.lying])
    assert high.sure[rows].all() and (high.through[rows] == 0.0).all()


def test_a_ledge_that_leaves_little_of_a_foot_does_not_hold_what_lands_on_it():
    """Half a width of 6 mm over a ledge: 1.3 mm remain of the 10 mm high block; 5.9 mm hold it."""
    bowl = thrown(2.4)
    one = one_of(bowl, 30, 12, 10, length=30)
    for limit, holds in ((7.3e-3, False), (11.9e-3, True)):
        device = make_device("narrowed_track", "", limit=limit)
        assert verdict(device, one).passes == 1.0
        assert steady((device,), [one], bowl, 2.5e-4).tolist() == [holds]
