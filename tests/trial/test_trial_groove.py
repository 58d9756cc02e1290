"""The trial's V: what lies in it slides on both faces, and rolls no more."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from feederscrew import bowl as bowls
from feederscrew.dropping.kernel import body
from feederscrew.part import load
from feederscrew.resting.aspects import find
from feederscrew.tooling.devices.kinds import make_device
from feederscrew.tooling.fates import at_entry
from feederscrew.tooling.orientations import orientations, travelling
from feederscrew.trial import course, part_poses, queue, runs, shape, staging

DOWEL = load(Path(__file__).resolve().parents[2] / "parts" / "dowel_6x20.stl")
BOWL = bowls.read(None, ["friction.wall=0.9", "track.width=30 mm", "track.climb=0 deg"])
DEG = np.radians(1.0)


def in_groove(bowl, angle, radius=50.0):
    """The dowel along a groove, laid against its wall; and the bowl."""
    bowl = replace(bowl, track=replace(bowl.track, radius=radius))
    chain = (make_device("groove", "g", angle=angle * DEG),)
    every = at_entry(travelling(orientations(DOWEL, find(DOWEL), bowl.track), bowl), chain)
    one = next(one for one in every if one.name == "A@0")
    solid, length, principal = shape.solid_of(DOWEL)
    solid = shape.rounded(solid, course.axes(every, principal))
    state = part_poses.pose_on_track(one, principal, length, one.track, place=0.0)
    state[body.Z] -= part_poses.lowest(solid.corners, state)
    state = part_poses.clear(state, solid, one.track, length, 0.0, one.wall_leans)
    way = staging.plain(bowl.track, every, min(1.0, radius), staging.at_entry(chain, bowl.track, every))
    return bowl, every, runs.setting(solid, length, bowl), way, state


def gone(known, way, state, seconds):
    limits = (seconds, 2.0 * seconds, 0.0, 10.0)
    return runs.ride(runs.past(known, way, limits=limits, interval=1.0, places=1), state[None], np.zeros(1))


@pytest.mark.parametrize("angle", [20.0, 45.0])
def test_both_faces_brake_as_friction_over_the_cosine(angle):
    """The wall's own friction, 0.9, is not met: the leaning wall is made as the track."""
    still = replace(BOWL, drive=replace(BOWL.drive, amplitude=0.0))
    _, _, known, way, state = in_groove(still, angle)
    assert state[1] * known.length == pytest.approx(3e-3 * np.tan(angle * DEG), rel=0.01)
    state[body.VX] = 0.8
    ride = gone(known, way, state, 0.3)
    friction = BOWL.friction.kinetic / np.cos(angle * DEG)
    assert ride.distances[0] == pytest.approx(known.length * 0.5 * 0.64 / friction, rel=0.03)
    assert ride.depths[0] < 2e-5


def test_what_is_off_the_bottom_comes_back_to_it():
    """Up the inner face by 2 mm: it slides or rolls down to where both faces carry it."""
    still = replace(BOWL, drive=replace(BOWL.drive, amplitude=0.0))
    _, _, known, way, state = in_groove(still, 35.0, radius=0.15)
    bottom = state[1]
    state[1] += 2e-3 / known.length
    end = gone(known, way, state, 0.5).states[0]
    off = known.radius - np.hypot(end[0], known.radius - end[1])
    assert off == pytest.approx(bottom, abs=0.02)


def test_the_lean_of_the_wall_goes_from_stretch_to_stretch():
    rows = staging.leaning(
        ((0.0, None, 30.0 * DEG, 60.0 * DEG), (0.1, None, 6.0 * DEG, 0.0)), 0.0, 0.0, 0.02, 1.0
    )
    axis, wall = rows[:, 4:6], rows[:, 6:8]
    np.testing.assert_allclose(wall[0], axis[0])
    np.testing.assert_allclose(wall[1], [np.sin(-30.0 * DEG), np.cos(30.0 * DEG)], atol=1e-12)
    np.testing.assert_allclose(axis[1], [np.sin(30.0 * DEG), np.cos(30.0 * DEG)], atol=1e-12)
    np.testing.assert_allclose(wall[3], axis[3])


def test_a_queue_lies_in_the_groove_from_its_entry_but_not_on_the_steeper_way():
    bowl, every, *_ = in_groove(BOWL, 30.0, radius=0.15)
    chain = (make_device("groove", "g", angle=30.0 * DEG), make_device("separation", "s", angle=-5.0 * DEG))
    made_of_it = queue.crowded(bowl, every, chain, 0.1)
    first = made_of_it.stage.air.slopes[:2]
    assert [(climb, bank) for _, climb, bank, _ in first] == [(None, pytest.approx(30.0 * DEG)), (None, None)]
    assert all(place < -1.0 for place, *_ in first)
    assert any(climb is not None and place > 0.0 for place, climb, *_ in made_of_it.stage.air.slopes)


def test_a_dowel_along_a_groove_passes_it():
    bowl, every, *_ = in_groove(replace(BOWL, track=replace(BOWL.track, climb=3.0 * DEG)), 30.0, radius=0.15)
    row = [k for k, one in enumerate(every) if one.name == "A@0"]
    chain = (make_device("groove", "g", angle=30.0 * DEG), make_device("bank", "b", angle=8.0 * DEG))
    found = course.course(DOWEL, bowl, every, course.Sending(row, 2), chain)
    assert list(found.fates) == [course.PASSED] * 2
    assert found.depths.max() < 5e-5
