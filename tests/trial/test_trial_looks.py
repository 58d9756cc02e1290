"""In which orientation the trial finds a part that lies a little askew."""

from dataclasses import replace

import numpy as np
import pytest
import shapes

from feederscrew.bowl.record import Track
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
