"""Parts that come down out of level rock from corner to corner; gears have teeth."""

from dataclasses import replace

import awkward
import numpy as np
import pytest
import shapes

from feederscrew.bowl.record import Friction
from feederscrew.dropping.kernel import body
from feederscrew.geometry import vectors
from feederscrew.resting.aspects import find
from feederscrew.running import RunSettings
from feederscrew.tooling.devices.kinds import make_device
from feederscrew.tooling.orientations import orientations
from feederscrew.trial import course, part_poses, runs, staging
from feederscrew.trial.looks import OTHER, Looks
from feederscrew.trial.shape import solid_of

TALL = shapes.part(shapes.box(8, 8, 20))
HALF, HIGH, FALL = 4e-3, 10e-3, 0.3  # [m], [m/s] of the block, and of its fall
BOWL = awkward.bowl("track.radius=50 m", "track.climb=0 deg", "track.bank=0 deg", "restitution=0")
STILL = replace(BOWL, drive=replace(BOWL.drive, amplitude=0.0), friction=Friction(2.0, 2.0, 0.0, 2.0, 2.0))
EVERY = orientations(TALL, find(TALL), BOWL.track)
UPRIGHT = next(k for k, one in enumerate(EVERY) if one.height > 19e-3)


def tilted(state, angle, heading=0.0):
    """A state (13,) turned by an angle [rad] about the axis across the track, then by a heading."""
    c, s, a, b = np.cos(angle), np.sin(angle), np.cos(heading), np.sin(heading)
    pitch = np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])
    turn = vectors.product(np.array([[a, -b, 0.0], [b, a, 0.0], [0.0, 0.0, 1.0]]), pitch)
    out = np.array(state)
    out[body.Q : body.Q + 4] = part_poses.quaternion(vectors.product(turn, part_poses.matrix(state)))
    return out


def highest_rise(degrees):
    """How far [m] the centre of mass of the tall block rises after it came down on its foot out of level."""
    solid, length, principal = solid_of(TALL)
    known, one = runs.setting(solid, length, STILL), EVERY[UPRIGHT]
    state = part_poses.pose_on_track(one, principal, length, STILL.track, place=0.0, aside=5e-3)
    state = tilted(state, np.radians(degrees))
    state[body.Z] -= part_poses.lowest(solid.corners, state) - 1e-9
    state[body.VZ] = -FALL / np.sqrt(STILL.gravity * length)
    stage = staging.plain(STILL.track, EVERY, 0.1)
    follow = runs.past(known, stage, limits=(0.08, 1.0, 0.0, 1.0), interval=1e-3, places=90)
    path = runs.ride(follow, state[None], np.zeros(1)).paths[0]
    return np.nanmax(path[:, 3]) - HIGH


@pytest.mark.parametrize("degrees", [0.03, 0.1, -0.1, 0.5])
def test_a_block_that_comes_down_out_of_level_rocks_as_far_as_two_impacts_let_it(degrees):
    """Closed form: one corner stops, and about it the block turns until the other strikes (Housner 1963)."""
    square = HALF**2 + HIGH**2
    about = square / 3.0 + square
    first = FALL * HALF / about
    second = first * (square / 3.0 + HIGH**2 - HALF**2) / about
    rise = 0.5 * about * second**2 / STILL.gravity
    assert highest_rise(degrees) == pytest.approx(rise, rel=0.15)


@pytest.mark.parametrize(
    ("degrees", "heading", "up", "right"),
    [(0.0, 0.0, 0.0, True), (20.0, 0.0, 0.0, True), (-20.0, 8.0, 0.5, True), (12.0, 30.0, 0.1, False)],
)
def test_what_rocks_or_flies_is_named_by_the_face_on_which_it_comes_to_lie(degrees, heading, up, right):
    """The block tips at atan(8 / 20), 21.8 deg; a heading counts to 10 deg."""
    solid, length, principal = solid_of(TALL)
    looks = Looks(EVERY, solid, length, principal, BOWL.track.radius)
    state = part_poses.pose_on_track(EVERY[UPRIGHT], principal, length, BOWL.track, place=0.03, aside=2e-3)
    state = tilted(state, np.radians(degrees), np.radians(heading))
    state[body.Z] += up
    assert looks.of([state]).tolist() == [UPRIGHT if right else OTHER]
    over = looks.of([tilted(state, np.radians(25.0 - degrees), -np.radians(heading))])
    assert over[0] != UPRIGHT and EVERY[over[0]].height < 9e-3


@pytest.mark.parametrize(
    "device",
    [make_device("canyon", "c", limit=7e-3), make_device("rails", "r", span=(3.5e-3, 7.5e-3))],
    ids=lambda one: one.kind,
)
def test_a_gear_sinks_into_no_cut_with_its_teeth(device):
    part, bowl = shapes.part(shapes.spur_gear()), awkward.bowl()
    every = orientations(part, find(part), bowl.track)
    on_teeth = [k for k, one in enumerate(every) if one.height > 12e-3]
    seen = course.course(part, bowl, every, course.Sending(on_teeth, 4), (device,), run=RunSettings(1))
    assert seen.depths.max() < 1e-4
