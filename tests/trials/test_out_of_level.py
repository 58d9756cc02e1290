"""Parts out of level: how they rock, in which orientation they are found, and how askew a trial lays them."""

from dataclasses import replace

import awkward
import numpy as np
import pytest
import shapes
from block_rides import ALONG, LENGTH, PART, PRINCIPAL, SOLID, laid, lying, ridden, sent, still
from scipy import stats

from feederscrew.arrivals.kernel import body
from feederscrew.base.geometry import vectors
from feederscrew.bowl.devices.kinds import make_device
from feederscrew.bowl.record import Friction, Track
from feederscrew.trials import part_poses, staging
from feederscrew.trials.looks import OTHER, Looks
from feederscrew.trials.shape import solid_of

TALL = shapes.part(shapes.box(8, 8, 20))
HALF, HIGH, FALL = 4e-3, 10e-3, 0.3  # [m], [m/s] of the block, and of its fall
BOWL = awkward.bowl("track.radius=50 m", "track.climb=0 deg", "track.bank=0 deg", "restitution=0")
STILL = replace(still(BOWL), friction=Friction(2.0, 2.0, 0.0, 2.0, 2.0))
EVERY = lying(TALL, BOWL)
UPRIGHT = next(k for k, one in enumerate(EVERY) if one.height > 19e-3)
ROUND = replace(BOWL, track=Track(climb=0.0, bank=0.0, radius=0.15, width=0.2))
BLOCKS = lying(PART, ROUND)
PARTS = 1200
LAID_BOWL = awkward.bowl("track.climb=0 deg", "track.bank=0 deg", "drive.frequency=40 Hz")


def tilted(state, angle, heading=0.0):
    """A state (13,) turned by an angle [rad] about the axis across the track, then by a heading."""
    c, s, a, b = np.cos(angle), np.sin(angle), np.cos(heading), np.sin(heading)
    pitch = np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])
    turn = vectors.product(np.array([[a, -b, 0.0], [b, a, 0.0], [0.0, 0.0, 1.0]]), pitch)
    out = np.array(state)
    out[body.Q : body.Q + 4] = part_poses.quaternion(vectors.product(turn, part_poses.matrix(state)))
    return out


@pytest.mark.parametrize("degrees", [0.03, 0.1, -0.1, 0.5])
def test_a_block_that_comes_down_out_of_level_rocks_as_far_as_two_impacts_let_it(degrees):
    """Closed form: one corner stops, and about it the block turns until the other strikes (Housner 1963)."""
    solid, length, _ = solid_of(TALL)
    state = tilted(laid(TALL, EVERY[UPRIGHT], STILL, aside=5e-3), np.radians(degrees))
    state[body.Z] -= part_poses.lowest_height(solid.corners, state) - 1e-9
    state[body.VZ] = -FALL / np.sqrt(STILL.gravity * length)
    stage = staging.stage_bare_track(STILL.track, EVERY, 0.1)
    _, ride = ridden(TALL, STILL, state, 0.08, stage, back=1.0, interval=1e-3, places=90)
    square = HALF**2 + HIGH**2
    about = square / 3.0 + square
    second = FALL * HALF / about * (square / 3.0 + HIGH**2 - HALF**2) / about
    rise = 0.5 * about * second**2 / STILL.gravity
    assert np.nanmax(ride.paths[0][:, 3]) - HIGH == pytest.approx(rise, rel=0.15)


@pytest.mark.parametrize(("degrees", "heading", "up", "right"), [
    (0.0, 0.0, 0.0, True), (20.0, 0.0, 0.0, True), (-20.0, 8.0, 0.5, True), (12.0, 30.0, 0.1, False),
])  # fmt: skip
def test_what_rocks_or_flies_is_named_by_the_face_on_which_it_comes_to_lie(degrees, heading, up, right):
    """The block tips at atan(8 / 20), 21.8 deg; a heading counts to 10 deg."""
    looks = Looks(EVERY, *solid_of(TALL), BOWL.track.radius)
    state = laid(TALL, EVERY[UPRIGHT], BOWL, place=0.03, aside=2e-3)
    state = tilted(state, np.radians(degrees), np.radians(heading))
    state[body.Z] += up
    assert looks.find_orientations([state]).tolist() == [UPRIGHT if right else OTHER]
    over = looks.find_orientations([tilted(state, np.radians(25.0 - degrees), -np.radians(heading))])
    assert over[0] != UPRIGHT and EVERY[over[0]].height < 9e-3


def test_a_gear_sinks_into_no_cut_with_its_teeth():
    part, bowl = shapes.part(shapes.spur_gear()), awkward.bowl()
    on_teeth = [k for k, one in enumerate(lying(part, bowl)) if one.height > 12e-3]
    for kind, size in (("canyon", {"limit": 7e-3}), ("rails", {"span": (3.5e-3, 7.5e-3)})):
        assert sent(part, bowl, on_teeth, 4, (make_device(kind, "c", **size),)).depths.max() < 1e-4


def looked_at(every, degrees):
    looks = Looks(every, SOLID, LENGTH, PRINCIPAL, ROUND.track.radius)
    states = [laid(PART, one, ROUND, place=0.01, turn=np.radians(degrees)) for one in BLOCKS]
    return looks.find_orientations(states)


@pytest.mark.parametrize(("degrees", "same"), [(0.0, True), (9.5, True), (-9.5, True), (22.0, False)])
def test_a_part_that_lies_turned_by_up_to_ten_degrees_is_in_its_orientation(degrees, same):
    count = len(BLOCKS)
    assert looked_at(BLOCKS, degrees).tolist() == (list(range(count)) if same else [OTHER] * count)


def test_a_part_that_lies_askew_is_on_an_aspect_of_which_any_heading_counts():
    looks = looked_at([replace(one, any_heading=one.aspect == "A") for one in BLOCKS], 33.0)
    assert {one.aspect for one in BLOCKS} > {"A"}
    for one, row in zip(BLOCKS, looks, strict=True):
        assert row == OTHER if one.aspect != "A" else BLOCKS[row].aspect == "A"
    along = next(k for k, one in enumerate(BLOCKS) if one.name == "A@0")
    assert looks[along] == along  # 33 deg from along it is nearer to that than to across


def is_even(values, low, high):
    return stats.kstest(values, stats.uniform(low, high - low).cdf).pvalue > 0.01


def test_parts_begin_at_any_phase_anywhere_in_the_play_of_the_wall_turned_and_tilted_a_little():
    """0 to 0.05 mm from the wall, turned evenly to 0.1 deg either way, tilted by 0.2 deg about any axis."""
    every, rows = lying(PART, LAID_BOWL), np.full(PARTS, ALONG)
    states, times = part_poses.lay_down(LAID_BOWL, every, rows, SOLID, PRINCIPAL, LENGTH, seed=4)
    assert is_even(times, 0.0, 1.0 / 40.0)
    radius, gaps = LAID_BOWL.track.radius / LENGTH, []
    for state in states:
        spots = state[:3] + vectors.product(SOLID.corners, part_poses.matrix(state).T)
        gaps.append(radius - np.hypot(spots[:, 0], radius - spots[:, 1]).max())
    assert is_even(np.array(gaps) * LENGTH, 0.0, 5e-5)
    exact = part_poses.matrix(laid(PART, every[ALONG], LAID_BOWL))
    turns = [vectors.product(part_poses.matrix(state), exact.T) for state in states]
    yaws = np.degrees([np.arctan2(turn[1, 0] - turn[0, 1], turn[0, 0] + turn[1, 1]) for turn in turns])
    assert is_even(yaws, -0.1, 0.1)
    axes = np.degrees([(turn[2, 1], -turn[2, 0]) for turn in turns])  # angle times direction of the axis
    angles = np.hypot(*axes.T)
    assert np.sqrt((angles**2).mean()) == pytest.approx(0.2, rel=0.05)
    assert stats.kstest(angles, stats.halfnorm(scale=0.2).cdf).pvalue > 0.01
    assert is_even(np.arctan2(axes[:, 1], axes[:, 0]), -np.pi, np.pi)
    lowest = [part_poses.lowest_height(SOLID.corners, state) for state in states[:50]]
    assert lowest == pytest.approx([0.0] * 50, abs=1e-9)
