"""Parts of a queue that a blade holds or that are poured: what pushes them, and how they go on."""

from dataclasses import replace

import awkward
import numpy as np
import pytest
import shapes

from feederscrew import bowl as bowls
from feederscrew.bowl.record import Friction
from feederscrew.conveying import answer
from feederscrew.dropping.kernel import body
from feederscrew.resting.aspects import find
from feederscrew.tooling.devices.kinds import make_device
from feederscrew.tooling.orientations import orientations
from feederscrew.trial import part_poses, queue
from feederscrew.trial.shape import solid_of

OWN = [
    "drive.amplitude=0.15 mm", "drive.frequency=60 Hz", "drive.vibration_angle=20 deg", "restitution=0.2",
    "friction.static=0.4", "track.radius=50 m", "track.width=60 mm", "track.climb=2 deg", "track.bank=0 deg",
]  # fmt: skip
BOWL = bowls.read(None, OWN)
PART = shapes.part(shapes.box(20, 12, 5))
ASPECTS = find(PART)
LENGTH = solid_of(PART)[1]
BLADE = make_device("wiper", "w", limit=4e-3)
SLOPE = np.radians(5.0)


def slope():
    """A still track that falls and has no friction, with a blade; it is banked, or a row would slip out."""
    smooth = awkward.bowl("track.radius=50 m", "restitution=0")
    still, track = replace(smooth.drive, amplitude=0.0), replace(smooth.track, climb=-SLOPE)
    slippery = Friction(0.0, 0.0, 0.0, 0.0, 0.0)
    return replace(smooth, drive=still, track=track, friction=slippery, devices=(BLADE,))


def blocks(bowl, *planned):
    """A queue of flat blocks while it moves."""
    every = orientations(PART, ASPECTS, bowl.track)
    shares = np.array([one.height < 6e-3 and one.length > 0.015 for one in every], float)
    return queue.PartsQueue(PART, bowl, ASPECTS, (every, shares), every, queue.QueuePlan(*planned), 3)


def ways(row):
    """How far along the wall its parts are [m]."""
    return part_poses.ways_along_wall(row.crowd.arrays.states, row.part_in_bowl.radius) * LENGTH


@pytest.mark.parametrize("parts", [1, 3])
def test_a_row_pushes_what_a_blade_holds_with_its_weight_down_the_slope(parts):
    row = blocks(slope(), parts, 1.0, 0.0)
    for turn in range(30):
        row.ride(turn)
    row.pressure[:], row.touch = 0.0, []  # without the impact
    for turn in range(30, 40):
        row.ride(turn)
    found, weight = row.result(), PART.mass * 9.81
    assert found.pressure[0] == pytest.approx((parts - 1) * weight * np.sin(SLOPE), abs=1e-3 * weight)
    assert found.touching == pytest.approx(1.0 - 1.0 / parts)
    assert found.jams == found.returned == 0


def test_the_gap_of_a_row_is_the_mean_free_way_between_its_blocks():
    still, level = replace(BOWL.drive, amplitude=0.0), replace(BOWL.track, climb=0.0)
    row = blocks(replace(BOWL, drive=still, track=level), 5, 1.0, 0.5)
    row.ride(0)
    free = -np.diff(ways(row)) - 0.02  # [m] from block to block, each 20 mm long
    assert free.min() > 0.0 and row.result().gap == pytest.approx(free.mean(), rel=0.01)


def test_what_stands_at_a_blade_for_a_second_is_taken_out():
    row, seen = blocks(slope(), 1, 3.0, 0.0), []
    while not row.jams and len(seen) < 200:
        seen.append(ways(row)[0])
        row.ride(len(seen) - 1)
    came = np.sqrt(2.0 * (seen[-1] - seen[0]) / (9.81 * np.sin(SLOPE)))
    assert row.time == pytest.approx(came + 1.0, abs=2.5 / row.bowl.drive.frequency)
    assert row.jams == 1 and row.whole == row.returned == 0


def test_nothing_of_a_driven_row_passes_a_blade_under_which_it_does_not_go():
    row = blocks(replace(BOWL, devices=(BLADE,)), 3, 7.0)
    for turn in range(420):
        row.ride(turn)
    found = row.result()
    assert found.jams >= 1 and found.returned == 0 and found.delivered == 0.0
    assert found.touching > 0.03 and found.pressure[0] > 0.0


def test_poured_parts_come_to_lie_and_travel():
    row = blocks(BOWL, 3, 2.0, None)
    for turn in range(60):
        row.ride(turn)
    before = ways(row)
    for turn in range(60, 120):
        row.ride(turn)
    velocities = ways(row) - before  # [m/s] over the last second
    onwards = velocities > 0.0  # not one that left and was poured again
    assert onwards.sum() >= 2 and row.result().poured
    assert velocities[onwards] == pytest.approx(answer.answer(BOWL).velocity, rel=0.05)
    heights = row.crowd.arrays.states[onwards, body.Z] * LENGTH
    assert np.abs(heights[:, None] - [2.5e-3, 6e-3, 10e-3]).min(axis=1).max() < 1e-5  # on a face
    assert row.depth * LENGTH < 1e-4
