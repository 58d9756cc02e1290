"""What became of parts: each fate where mechanics leaves no other, and the way on behind a lower track."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
import shapes

from feederscrew import bowl as bowls
from feederscrew.dropping.kernel import body
from feederscrew.resting.aspects import find
from feederscrew.running import RunSettings
from feederscrew.tooling.devices.kinds import make_device
from feederscrew.tooling.orientations import orientations
from feederscrew.trial import course, part_poses, queue, runs, shape, staging
from feederscrew.trial.looks import Looks

OWN = [
    "drive.amplitude=0.15 mm", "drive.frequency=60 Hz", "drive.vibration_angle=20 deg", "restitution=0.2",
    "friction.static=0.4", "track.radius=50 m", "track.width=60 mm", "track.climb=2 deg", "track.bank=0 deg",
]  # fmt: skip
PART = shapes.part(shapes.box(20, 12, 5))
BOWL = bowls.read(None, OWN)
EVERY = orientations(PART, find(PART), BOWL.track)
ALONG = next(k for k, one in enumerate(EVERY) if one.height < 6e-3 and one.length > 0.015)
HEADED = shapes.prism([(-2.5, 0), (2.5, 0), (2.5, 14), (5, 14), (5, 17), (-5, 17), (-5, 14), (-2.5, 14)], 5)
RAILS = make_device("rails", "r", span=(3.4e-3, 8.6e-3))


def sent(*devices, bowl=BOWL):
    """The flat block along the wall past devices."""
    return course.course(PART, bowl, EVERY, course.Sending([ALONG], 1), devices, run=RunSettings(3))


def test_a_pin_across_a_climb_rolls_back_as_a_solid_cylinder_does():
    """From rest at 2/3 of g sin(climb): over the second half of its time at 3/4 of the speed it ends with."""
    pin, climb = shapes.part(shapes.cylinder(4.0, 10.0, 48)), np.radians(0.2)
    calm = replace(BOWL.drive, amplitude=1e-8)
    bowl = replace(BOWL, drive=calm, track=replace(BOWL.track, climb=climb))
    every = orientations(pin, find(pin), bowl.track)
    across = [k for k, one in enumerate(every) if one.kind == "rolling" and one.width > 9.9e-3]
    seen = course.course(pin, bowl, every, course.Sending(across[:1], 1), (), run=RunSettings(1))
    assert seen.fates[0] == course.ROLLED_BACK and seen.ended[0] == 0
    ride, rolls = seen.rides[0], 2.0 / 3.0 * bowl.gravity * np.sin(climb)
    assert ride.distances[0] == pytest.approx(-0.5 * rolls * ride.seconds[0] ** 2, rel=0.02)
    assert seen.velocities[0] == pytest.approx(-0.75 * rolls * ride.seconds[0], rel=0.05)


def headed(laid):
    """What became of a headed part over rails that has not come past them in its time; a moment will do."""
    part = shapes.part(HEADED)
    still = replace(BOWL, drive=replace(BOWL.drive, amplitude=0.0), track=replace(BOWL.track, climb=0.0))
    every = orientations(part, find(part), still.track)
    solid, length, principal = shape.solid_of(part)
    known, stage = runs.setting(solid, length, still), staging.stage(RAILS, still.track, every)
    lying = next(k for k in every if k.height < 6e-3 and k.length > 0.016)
    along = replace(lying, heading=np.pi, distance=6e-3)
    state = part_poses.pose_on_track(along, principal, length, still.track, place=0.02, aside=laid)
    ride = runs.ride(
        runs.past(known, stage, limits=(0.3, 1.0, 0.0, 1.0), interval=0.1, places=1), state[None], np.zeros(1)
    )
    assert ride.outcomes[0] == runs.RUNNING
    looks = Looks(every, solid, length, principal, still.track.radius)
    fate = course.fate_at(stage, ride.outcomes[0], ride.states[0], looks, length)
    return fate, length * ride.states[0][body.Z]


def test_a_headed_part_whose_time_is_up_between_rails_hangs_there():
    fate, height = headed(0.0)
    assert fate == course.HANGING and height < -4e-3
    fate, height = headed(20e-3)  # beside the slot it lies on the track
    assert fate == course.STOPPED and height == pytest.approx(2.5e-3, abs=1e-5)


@pytest.mark.parametrize(
    ("drop", "low", "fate"),
    [  # [mm] of the track behind the station, and of the part's lowest point
        (0.0, -0.11, course.HANGING),
        (0.0, -0.09, course.STOPPED),
        (3.0, -3.0, course.STOPPED),  # it lies on the lower track
        (3.0, -3.11, course.HANGING),
    ],
)
def test_a_part_hangs_where_it_reaches_below_the_track_it_has_come_to(drop, low, fate):
    corners = np.array([[-1.0, 0.0, -0.5], [1.0, 0.0, 0.5]])
    looks = SimpleNamespace(corners=corners, radius=100.0)
    state = np.zeros(body.STATE)
    state[:3], state[body.Q] = (2.0, 0.0, low / 4.0 + 0.5), 1.0  # of a unit of 4 mm
    station = SimpleNamespace(below=True, drop=1e-3 * drop, cut=(3e-3, 9e-3))
    assert course.fate_at(station, runs.RUNNING, state, looks, 4e-3) == fate
    above = SimpleNamespace(below=False, drop=1e-3 * drop, cut=(3e-3, 9e-3))
    assert course.fate_at(above, runs.RUNNING, state, looks, 4e-3) == course.STOPPED
    before = SimpleNamespace(below=False, drop=1e-3 * drop, cut=(13e-3, 19e-3))  # it reaches as far as 12 mm
    assert course.fate_at(before, runs.STANDS, state, looks, 4e-3) == course.STUCK


def test_a_blade_stops_a_part_at_its_own_place_in_the_chain():
    seen = sent(make_device("gap", "g", limit=2e-3), make_device("wiper", "w", limit=4e-3))
    assert seen.fates[0] == course.STOPPED and seen.ended[0] == 2


def test_what_has_gone_down_a_step_goes_over_the_next_gap_as_on_any_track():
    seen = sent(make_device("step", "s", limit=3e-3), make_device("gap", "g", limit=2e-3))
    assert seen.fates[0] == course.PASSED and seen.orientations[-1][0] == ALONG
    assert seen.depths[0] < 5e-5
    before, after = (ride.states[0][body.Z] * seen.length for ride in seen.rides[1:])
    assert before == pytest.approx(2.5e-3 - 3e-3, abs=5e-6)  # flat on the lower track, then on the next one
    assert after == pytest.approx(2.5e-3, abs=5e-6)


@pytest.mark.parametrize("way", [0.0, 0.11])
def test_what_went_down_beside_a_ledge_comes_to_the_wall_and_what_stayed_up_does_not(way):
    """At a ledge 6 mm from the wall and 5 mm high, in a bowl of 150 mm; the unit of length is 4 mm."""
    known, station = SimpleNamespace(length=4e-3, radius=37.5), SimpleNamespace(drop=5e-3, aside=6e-3)
    states = np.zeros((2, body.STATE))
    angle = way / 0.15
    for state, off, height in zip(states, (9e-3, 2e-3), (-3e-3, 2e-3)):
        reach = (0.15 - off) / 4e-3
        state[:3] = reach * np.sin(angle), 37.5 - reach * np.cos(angle), height / 4e-3
        state[body.Q] = 1.0
    down, up = course.led_on(states, station, 0.03, known)
    for state, off, height in ((down, 3e-3, 2e-3), (up, 2e-3, 2e-3)):
        x, y, z = 4e-3 * state[:3]
        assert 0.15 - np.hypot(x, 0.15 - y) == pytest.approx(off, abs=1e-9)
        assert 0.15 * np.arctan2(x, 0.15 - y) == pytest.approx(0.03, abs=1e-9)
        assert z == pytest.approx(height, abs=1e-9)


def test_a_jet_behind_a_step_blows_at_what_lies_on_the_lower_track():
    """All of it meets the side of the block, which it quickens by the thrust over the mass."""
    jet = make_device("jet", "j", nozzle=2e-3, pressure=2e4, height=2.5e-3)
    drive, track = replace(BOWL.drive, amplitude=0.0), replace(BOWL.track, climb=0.0)
    still = replace(BOWL, drive=drive, track=track)
    line = queue.crowded(still, EVERY, (make_device("step", "s", limit=8e-3), jet), 0.1)
    solid, length, principal = shape.solid_of(PART)
    known = replace(runs.setting(solid, length, still), friction=np.zeros(5))
    x, y, z = (line.stage.air.jets[f"mouth_{e}"][0] for e in "xyz")
    assert z == pytest.approx(2.5e-3 - 8e-3) and y < 1e-3
    parts = queue.PartsOnTrack(known, line, 1)
    state = part_poses.pose_on_track(EVERY[ALONG], principal, length, track, place=x, aside=1e-3)
    state[body.Z] -= 8e-3 / length
    parts.lay(0, state)
    parts.ride(0)
    seconds = 1.0 / BOWL.drive.frequency
    speed = parts.arrays.states[0, body.VY] * length / known.unit
    (one,) = jet.standing(track, EVERY).jets
    assert speed == pytest.approx(one.thrust / PART.mass * seconds, rel=0.05)
