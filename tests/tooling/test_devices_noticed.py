"""What devices make of a part and of their own values, against sums done by hand."""

from dataclasses import replace

import awkward
import numpy as np
import pytest
import shapely
import shapes

from feederscrew import bowl as bowls
from feederscrew.resting.aspects import find
from feederscrew.tooling.devices.base import UNSURE
from feederscrew.tooling.devices.blades import SQUARE_FACE_RAD
from feederscrew.tooling.devices.kinds import make_device
from feederscrew.tooling.orientations import orientations, travelling
from feederscrew.tooling.verdicts import DeviceEncounter, verdict

BOWL = bowls.read(None, ["track.radius=100 m", "track.bank=0 deg", "track.width=40 mm"])
NARROW = replace(BOWL.track, width=20e-3)
GRAVITY, STEEL = 9.80665, 7850.0


def still(mesh, height):
    """Orientations of that height [mm] on a track that does not shake: friction alone holds them, 0.6."""
    part = shapes.part(mesh)
    every = travelling(orientations(part, find(part), BOWL.track), BOWL)
    return [
        replace(one, swing=0.0, speed=0.05, grip=0.6)
        for one in every
        if one.height == pytest.approx(1e-3 * height, rel=1e-6)
    ]


@pytest.mark.parametrize(
    ("sweep", "along", "ahead"),
    [(30.0, 2.0, 1.732051), (50.0, 1.305407, 0.839100), (90.0, 1.0, 0.0)],  # 1 / sin and 1 / tan
)
def test_a_swept_blade_leans_ahead_from_the_wall_to_the_free_edge(sweep, along, ahead):
    """Its face is 20 mm / sin(sweep) long and ends 20 mm / tan(sweep) farther ahead than it begins."""
    wiper = make_device(
        "wiper", "test", limit=6e-3, sweep=np.radians(sweep), contour=((0.0, 6e-3), (9e-3, 4e-3))
    )
    every = awkward.lying()
    standing = wiper.standing(NARROW, every)
    (blade,) = standing.blades
    ring = shapely.get_coordinates(blade.solid)[:-1]
    lower, tall = ring[ring[:, 1] < 7e-3], ring[ring[:, 1] > 7e-3]
    edge = np.array([(0.0, 6e-3), (9e-3 * along, 4e-3), (20e-3 * along, 4e-3)])
    np.testing.assert_allclose(lower[np.argsort(lower[:, 0])], edge, rtol=1e-6, atol=1e-12)
    np.testing.assert_allclose(sorted(tall[:, 0]), [0.0, 20e-3 * along], rtol=1e-6, atol=1e-12)
    assert tall[:, 1].min() > max(one.height for one in every)
    (x, y), way = blade.foot, np.array([np.cos(blade.heading), np.sin(blade.heading)])
    end = np.array([x, y]) + 20e-3 * along * way
    np.testing.assert_allclose(end - [x, 0.0], [20e-3 * ahead, 20e-3], rtol=1e-6, atol=1e-9)
    assert y == 0.0 and standing.length == pytest.approx(end[0])
    assert wiper.goes_on(20e-3) == pytest.approx(20e-3 * ahead, rel=1e-6, abs=1e-12)


@pytest.mark.parametrize(
    ("pressure", "least", "most"), [(9e3, 0.2, 0.5), (3e4, 0.5, 4.5), (2e5, 4.5, 9.0), (5e5, 9.0, 30.0)]
)
def test_a_jet_is_felt_as_long_as_it_meets_the_tall_end_of_a_part(pressure, least, most):
    """Of nine places along 16 mm two lie in the tall 4 mm; over the rest it blows at nothing.

    The part weighs 128 mm2 x 8 mm of steel and tips over a foot 4 mm wide about an edge 12 mm below the jet.
    Half the force at any place moves nothing, and twice in the mean all of it the 36 mm to the free edge.
    """
    steps = [(0, 0), (16, 0), (16, 4), (4, 4), (4, 20), (0, 20)]
    lying = [one for one in still(shapes.prism(steps, 8.0), 20) if one.length > 15.9e-3 and one.width < 9e-3]
    jet = make_device("jet", "test", nozzle=0.8e-3, pressure=pressure, height=12e-3)
    share = jet.jet.thrust / (1024e-9 * STEEL * GRAVITY * 4.0 / 12.0)
    assert len(lying) == 2 and least < share < most  # the tall end ahead, or behind
    told = {0.2: 36e-3 * (1.0 - share), 0.5: 0.0, 4.5: -UNSURE, 9.0: -36e-3}[least]
    for one in lying:
        assert jet.most(DeviceEncounter(one)) == pytest.approx(share, rel=0.015)  # rays to 11 deg askew
        assert jet.factor(DeviceEncounter(one)) == pytest.approx(2.0 / 9.0 * share, rel=0.015)
        assert verdict(jet, one).margin == pytest.approx(told, rel=0.01, abs=0.0)


def test_a_slope_under_a_jet_is_held_by_the_friction_of_what_presses_it_down():
    """A face that rises at 60 deg takes T sin2 of a level jet outwards and T sin cos down."""
    slope = np.radians(60.0)
    rise = 10.0 * np.tan(slope)
    outline = [(0, 0), (16, 0), (16, 2 + rise), (10, 2 + rise), (0, 2)]
    area = 16.0 * 2.0 + 0.5 * 10.0 * rise + 6.0 * rise
    middle = (16.0 * 2.0 * 8.0 + 0.5 * 10.0 * rise * 20.0 / 3.0 + 6.0 * rise * 13.0) / area
    (one,) = [
        one
        for one in still(shapes.prism(outline, 60.0), 2.0 + rise)
        if one.length > 59e-3 and one.distance == pytest.approx(1e-3 * middle, rel=1e-3)
    ]
    side = (16.0 - middle) / 10.0  # of its weight, at 10 mm: less than what friction holds
    jet = make_device("jet", "test", nozzle=0.5e-3, pressure=2e4, height=10e-3)
    taken = np.sin(slope) ** 2 - 0.6 * np.sin(slope) * np.cos(slope)
    force = area * 60e-9 * STEEL * GRAVITY * min(0.6, side)
    assert jet.factor(DeviceEncounter(one)) == pytest.approx(taken * jet.jet.thrust / force, rel=0.03)


def test_a_gap_is_not_sure_of_what_it_is_as_much_too_long_for_as_the_part_travels_on():
    """From the gap that it passes as placed, up to so much more, nothing is sure; beyond that it falls."""
    judged = 0
    for one in awkward.lying():
        if one.falls_off or one.gap <= 0.0:
            continue
        more = make_device("gap", "test", limit=one.gap).more(DeviceEncounter(one))
        within, beyond = (make_device("gap", "test", limit=one.gap + more + step) for step in (-1e-6, 1e-6))
        assert not verdict(within, one).sure and verdict(beyond, one).sure
        assert verdict(beyond, one).margin == pytest.approx(-1e-6, rel=1e-3)
        judged += abs(one.carry - one.carry_ahead) > 1e-5
    assert judged > 3


@pytest.fixture(scope="module")
def rod():
    """A rod along the wall, of R = 3 mm and 20 mm long: over a slot w wide it sinks R - sqrt(R2 - w2 / 4)."""
    part = shapes.part(shapes.cylinder(3.0, 20.0, 256))
    every = travelling(orientations(part, find(part), BOWL.track), BOWL)
    return next(one for one in every if one.kind == "rolling" and one.rolls_along)


@pytest.mark.parametrize(("wide", "rides"), [(2.75, True), (2.87, False)])
def test_over_a_shorter_hole_a_rod_only_dips(rod, wide, rides):
    """By a sixth, of a hole of 12 mm under 10 mm ahead; but what an edge is rounded by costs nothing.

    (s - 0.05 mm) / 6 = 0.1 mm - 0.05 mm, so s = 0.35 mm and w = 2 sqrt(9 - 2.65^2) = 2.81 mm. Placed it falls
    2 mm over the edge, of which it travels 1 mm.
    """
    low, high = rod.distance - 0.5e-3 * wide, rod.distance + 0.5e-3 * wide
    hole = make_device("cut_out", "test", corners=((0.0, low), (12e-3, low), (12e-3, high), (0.0, high)))
    found = verdict(hole, replace(rod, climbs=0.1e-3, carry=1e-3))
    assert found.passes == 0.0 and found.margin == pytest.approx(-UNSURE if rides else -1e-3, rel=1e-2)
    assert hole.goes_on(40e-3) == 12e-3


def test_what_no_width_carries_fails_on_every_ledge_by_as_far_as_its_foot_reaches():
    """A block 12 x 5 mm and 20 high at a bank of 30 deg: 10 tan 30 = 5.8 mm is beyond its foot's 2.5 mm."""
    part = shapes.part(shapes.box(20, 12, 5))
    every = orientations(part, find(part), BOWL.track)
    tall = next(one for one in every if one.height > 19e-3 and one.length > 11e-3)
    one = replace(tall, track=replace(BOWL.track, bank=np.radians(30.0)))
    found = verdict(make_device("narrowed_track", "test", limit=11e-3), one)
    assert found.passes == 0.0
    assert found.margin == pytest.approx(
        -1e-3 * np.hypot(6.0, 2.5 + 10.0 * np.tan(np.radians(30.0))), rel=1e-3
    )


@pytest.mark.parametrize(
    ("sweep", "own", "fate"),
    [
        (30.0, None, "returned"), (58.0, None, "returned"), (60.0, None, "stopped"),
        (60.0, 0.5, "returned"), (64.0, 0.5, "stopped"), (90.0, 0.0, "stopped"),
    ],
)  # fmt: skip
def test_a_face_sweeps_off_below_a_right_angle_less_its_angle_of_friction(rod, sweep, own, fate):
    """atan 0.6 = 31 deg of the track, atan 0.5 = 27 deg of the face; one straight across stops all."""
    wiper = make_device(
        "wiper",
        "test",
        limit=1e-3,
        sweep=np.radians(sweep) if sweep < 90.0 else SQUARE_FACE_RAD,
        friction=own,
    )
    assert wiper.fate(DeviceEncounter(replace(rod, grip=0.6))) == fate
