"""In which orientation the trial finds a part that lies a little askew."""

import numpy as np
import pytest
import shapes

from feederscrew.bowl.record import Track
from feederscrew.resting.aspects import find
from feederscrew.tooling.orientations import orientations
from feederscrew.trial import whereabouts
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
        whereabouts.laid(one, principal, length, TRACK, place=0.01, turn=np.radians(degrees)) for one in every
    ]
    assert looks.of(states).tolist() == (list(range(len(every))) if known else [OTHER] * len(every))
