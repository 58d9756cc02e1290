"""A part that has come past the last device leaves: it does not fall off the end of what is drawn."""

import numpy as np
import shapes
import trimesh

from feederscrew import bowl as bowls
from feederscrew.rates import stream
from feederscrew.resting.aspects import find
from feederscrew.running import RunSettings
from feederscrew.trial.queue import QueuePlan, queue_of

CORNERS = [(-5, -5, 5), (5, 5, 5), (5, -5, -5), (-5, 5, 5), (-5, -5, -5), (5, 5, -5), (5, -5, 5), (-5, 5, -5)]
FACES = [
    (0, 3, 4), (2, 0, 4), (4, 3, 7), (7, 2, 4), (0, 1, 3), (6, 0, 2), (6, 1, 0), (3, 1, 7), (5, 2, 7),
    (7, 1, 5), (5, 6, 2), (1, 6, 5),
]  # fmt: skip
"""A cube as a mesh program wrote it, by another diagonal on each face."""


def test_every_cube_of_a_queue_on_a_bare_track_leaves():
    part = shapes.part(trimesh.Trimesh(CORNERS, FACES, process=False))
    aspects = find(part)
    bowl = bowls.read(None, ["track.width=20 mm", "track.bank=3 deg", "track.climb=3.5 deg"])
    known = stream.orientations(part, aspects, bowl.track, bowl=bowl)
    states = known.lying, known.states
    seen = queue_of(part, bowl, aspects, *states, np.ones(1), QueuePlan(12, 2.0), RunSettings(1))
    assert seen.returned == 0 and seen.jams == 0
    assert seen.leaving[0] == seen.leaving.sum() > 2
