"""Ends of a track: parts leave behind the last device, and fall over an edge where they do not hold on."""

from dataclasses import replace

import numpy as np
import pytest
import shapes
import trimesh

from feederscrew import bowl as bowls
from feederscrew.dropping.kernel import body
from feederscrew.rates import stream
from feederscrew.resting.aspects import find
from feederscrew.running import RunSettings
from feederscrew.tooling.devices.kinds import make_device
from feederscrew.tooling.orientations import orientations
from feederscrew.trial import part_poses, runs, shape, staging
from feederscrew.trial.queue import QueuePlan, queue_of

CORNERS = [(-5, -5, 5), (5, 5, 5), (5, -5, -5), (-5, 5, 5), (-5, -5, -5), (5, 5, -5), (5, -5, 5), (-5, 5, -5)]
FACES = [
    (0, 3, 4), (2, 0, 4), (4, 3, 7), (7, 2, 4), (0, 1, 3), (6, 0, 2), (6, 1, 0), (3, 1, 7), (5, 2, 7),
    (7, 1, 5), (5, 6, 2), (1, 6, 5),
]  # fmt: skip
"""A cube as a mesh program wrote it, by another diagonal on each face."""


@pytest.mark.parametrize("order", [range(8), (3, 7, 1, 0, 5, 2, 6, 4), (6, 5, 2, 7, 4, 1, 0, 3)])
@pytest.mark.parametrize(("speed", "falls"), [(0.5, False), (0.68, False), (0.8, True)])
def test_a_cube_stands_over_an_edge_whatever_order_its_corners_have(order, speed, falls):
    """It slides from 8 mm before an edge on. As it brakes, what carries it is 2 mm ahead of its centre."""
    place = np.argsort(order)
    mesh = trimesh.Trimesh(
        np.array(CORNERS)[list(order)], place[np.roll(FACES, order[0], axis=0)], process=False
    )
    part = shapes.part(mesh)
    level = ["track.radius=50 m", "track.climb=0 deg", "track.bank=0 deg", "friction.static=0.4"]
    bowl = bowls.read(None, [*level, "track.width=40 mm", "restitution=0"])
    bowl = replace(bowl, drive=replace(bowl.drive, amplitude=0.0))
    every = orientations(part, find(part), bowl.track)
    solid, length, principal = shape.solid_of(part)
    edge = staging.stage(make_device("gap", "here", limit=0.03), bowl.track, every)
    state = part_poses.pose_on_track(every[0], principal, length, bowl.track, place=-8e-3, aside=5e-3)
    state[body.VX] = speed
    known = runs.setting(solid, length, bowl)
    past = runs.past(known, edge, limits=(0.5, 1.0, 0.0, 10.0), interval=1.0, places=1)
    end = runs.ride(past, state[None], np.zeros(1))
    assert (end.states[0, body.Z] < 0.0) == falls
    if not falls:
        assert end.distances[0] == pytest.approx(length * speed**2 / (2.0 * 0.4), rel=1e-3)


def test_every_cube_of_a_queue_on_a_bare_track_leaves():
    part = shapes.part(trimesh.Trimesh(CORNERS, FACES, process=False))
    aspects = find(part)
    bowl = bowls.read(None, ["track.width=20 mm", "track.bank=3 deg", "track.climb=3.5 deg"])
    known = stream.follow_orientations(part, aspects, bowl.track, bowl=bowl)
    states = known.lying, known.states
    seen = queue_of(part, bowl, aspects, *states, np.ones(1), QueuePlan(12, 2.0), RunSettings(1))
    assert seen.returned == 0 and seen.jams == 0
    assert seen.leaving[0] == seen.leaving.sum() > 2
