"""In which orientation the trial finds a part that lies a little askew."""

from dataclasses import replace

import awkward
import numpy as np
import pytest
import shapes
from scipy import stats

from feederscrew.bowl.record import Track
from feederscrew.geometry import vectors
from feederscrew.resting.aspects import find
from feederscrew.tooling.orientations import orientations
from feederscrew.trial import part_poses
from feederscrew.trial.looks import OTHER, Looks
from feederscrew.trial.shape import solid_of

TRACK = Track(climb=0.0, bank=0.0, radius=0.15, width=0.2)


@pytest.mark.parametrize(("degrees", "known"), [(0.0, True), (9.5, True), (-9.5, True), (22.0, False)])
def test_a_part_that_lies_turned_by_up_to_ten_degrees_is_in_its_orientation(degrees, known):
    part = shapes.part(shapes.box(20, 12, 5))
    every = orientations(part, find(part), TRACK)
    solid, length, principal = solid_of(part)
    looks = Looks(every, solid, length, principal, TRACK.radius)
    states = [
        part_poses.pose_on_track(one, principal, length, TRACK, place=0.01, turn=np.radians(degrees))
        for one in every
    ]
    assert looks.of(states).tolist() == (list(range(len(every))) if known else [OTHER] * len(every))


def test_a_part_that_lies_askew_is_on_an_aspect_of_which_any_heading_counts():
    part = shapes.part(shapes.box(20, 12, 5))
    every = orientations(part, find(part), TRACK)
    free = [replace(one, any_heading=one.aspect == "A") for one in every]
    solid, length, principal = solid_of(part)
    looks = Looks(free, solid, length, principal, TRACK.radius)
    states = [
        part_poses.pose_on_track(one, principal, length, TRACK, place=0.01, turn=np.radians(33.0))
        for one in every
    ]
    found = looks.of(states)
    assert {one.aspect for one in every} > {"A"}
    for one, place in zip(every, found, strict=True):
        assert place == OTHER if one.aspect != "A" else every[place].aspect == "A"
    along = next(k for k, one in enumerate(every) if one.name == "A@0")
    assert found[along] == along  # 33 deg from along it is nearer to that than to across


PARTS = 1200
BOWL = awkward.bowl("track.climb=0 deg", "track.bank=0 deg", "drive.frequency=40 Hz")
PART = shapes.part(shapes.box(20, 12, 5))
EVERY = orientations(PART, find(PART), BOWL.track)
FLAT = next(k for k, one in enumerate(EVERY) if one.height < 6e-3 and one.length > 15e-3)


@pytest.fixture(scope="module")
def laid():
    """States (N, 13) and times (N,) [s] of parts laid flat along the wall, their solid and its unit [m]."""
    solid, length, principal = solid_of(PART)
    states, times = part_poses.laid_down(BOWL, EVERY, np.full(PARTS, FLAT), solid, principal, length, seed=4)
    return states, times, solid, length, principal


def is_even(values, low, high):
    return stats.kstest(values, stats.uniform(low, high - low).cdf).pvalue > 0.01


def test_parts_begin_at_any_phase_of_the_drive(laid):
    assert is_even(laid[1], 0.0, 1.0 / 40.0)


def test_parts_begin_within_the_play_of_the_wall_evenly(laid):
    """The corner that is nearest to the wall is 0 to 0.05 mm from it."""
    states, _, solid, length, _ = laid
    radius = BOWL.track.radius / length
    gaps = []
    for state in states:
        spots = state[:3] + vectors.product(solid.corners, part_poses.matrix(state).T)
        gaps.append(radius - np.hypot(spots[:, 0], radius - spots[:, 1]).max())
    assert is_even(np.array(gaps) * length, 0.0, 5e-5)


def test_parts_begin_turned_and_tilted_a_little(laid):
    """Headings evenly to 0.1 deg either way; tilts of 0.2 deg about an axis in any direction."""
    states, _, _, length, principal = laid
    exact = part_poses.matrix(part_poses.pose_on_track(EVERY[FLAT], principal, length, BOWL.track, place=0.0))
    turns = [vectors.product(part_poses.matrix(state), exact.T) for state in states]
    yaws = np.degrees([np.arctan2(turn[1, 0] - turn[0, 1], turn[0, 0] + turn[1, 1]) for turn in turns])
    assert is_even(yaws, -0.1, 0.1)
    axes = np.degrees([(turn[2, 1], -turn[2, 0]) for turn in turns])  # angle times direction of the axis
    angles = np.hypot(*axes.T)
    assert np.sqrt((angles**2).mean()) == pytest.approx(0.2, rel=0.05)
    assert stats.kstest(angles, stats.halfnorm(scale=0.2).cdf).pvalue > 0.01
    assert is_even(np.arctan2(axes[:, 1], axes[:, 0]), -np.pi, np.pi)
    assert all(
        part_poses.lowest(laid[2].corners, state) == pytest.approx(0.0, abs=1e-9) for state in states[:50]
    )
