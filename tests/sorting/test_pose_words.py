"""Poses in words, and which of them each device lets pass: of parts whose features are known."""

import numpy as np
import pytest
import shapes
import trimesh

from feederscrew.bowl.devices.kinds import make_device
from feederscrew.bowl.record import Track
from feederscrew.resting.aspects import find
from feederscrew.sorting.device_poses import find_device_poses
from feederscrew.sorting.orientations import HANGING, hang, neck, orientations
from feederscrew.sorting.pose_words import describe_pose

TRACK = Track(climb=0.0, bank=0.0, radius=0.15, width=0.03)


def on_track(mesh):
    part = shapes.part(mesh)
    return orientations(part, find(part), TRACK)


def plate_with_hole():
    """A plate 24 x 12 x 3 with a hole of 6 nearer to one end."""
    ring = shapes.prism([(-12, -6), (12, -6), (12, 6), (-12, 6)], 3)
    drill = trimesh.creation.cylinder(radius=3.0, height=10.0, sections=48)
    drill.apply_translation([7.0, 0.0, 0.0])
    return ring.difference(drill)


def screw():
    head, shank = shapes.cylinder(4.0, 3.0, 32), shapes.cylinder(2.0, 14.0, 32)
    shank.apply_translation([0.0, 0.0, 8.4])
    return trimesh.boolean.union([head, shank])


def test_a_hole_is_ahead_or_behind_as_its_middle_lies():
    flat = [one for one in on_track(plate_with_hole()) if "largest" in one.posture.lies]
    assert len(flat) >= 2
    told = set()
    for one in flat:
        # where the hole is on the track, from the file's axes: its middle is at x = 7 mm of the plate
        centre = one.solid.centre_of_mass
        x, y, _ = one.axes @ (np.array([7e-3, 0.0, 0.0]) - centre) - one.axes @ (-centre)
        words = describe_pose(one)
        side = ("ahead" if x > 0 else "behind") if abs(x) > abs(y) else ("free edge" if y > 0 else "wall")
        assert words.startswith("on its largest face") and "hole" in words and words.endswith(side)
        assert ("along" if abs(x) > abs(y) else "across") in words
        told.add(side)
    assert {"ahead", "behind"} <= told


def test_a_head_leads_or_follows_and_what_hangs_is_said_to():
    lying = [one for one in on_track(screw()) if neck(one) is not None]
    words = {describe_pose(one) for one in lying}
    assert any("head ahead" in text for text in words) and any("head behind" in text for text in words)
    for one in lying:  # the head's middle is the file's origin, the tip at z = 15 mm
        way = one.axes @ np.array([0.0, 0.0, 1.0])
        assert ("head behind" in describe_pose(one)) == (way[0] > 0.0)
    assert describe_pose(hang(lying[0], (3e-3, 8e-3))).startswith("hanging by its head")


def test_the_heavier_side_is_up_or_down():
    cone = trimesh.creation.cone(radius=8.0, height=12.0, sections=32)
    standing = [one for one in on_track(cone) if one.posture.lies and one.kind == "flat"]
    assert standing and all("heavier side down" in describe_pose(one) for one in standing)


@pytest.mark.parametrize("width", [9.0, 14.0])
def test_each_pose_passes_or_goes_back_as_the_verdict_has_it_and_goes_on_no_farther(width):
    rows = on_track(shapes.box(20.0, 12.0, 5.0))
    wiper = make_device("wiper", "b", limit=8e-3)
    narrow = make_device("narrowed track", "b", limit=width * 1e-3, text=f"{width} mm")
    shares = np.full(len(rows), 1.0 / len(rows))
    first, second = find_device_poses((wiper, narrow), rows, shares)
    groups = first.passes, (*first.returns, *first.stops)  # a square blade may stop what it does not return
    passed, returned = ({one.orientation.name for one in group} for group in groups)
    assert passed == {one.name for one in rows if one.height < 8e-3 and not one.returned}
    assert returned == {one.name for one in rows if one.height > 8e-3 and not one.returned} and returned
    came = {one.orientation.name for one in (*second.passes, *second.returns, *second.stops)}
    assert came == passed
    for one in rows:  # the weight must lie on what is left of the track
        if one.name in passed and one.distance > 1.1e-3 * width:
            assert one.name in {pose.orientation.name for pose in second.returns}
    assert sum(one.share for one in (*first.passes, *first.returns, *first.stops)) <= 1.0 + 1e-9


def test_a_head_in_the_rails_goes_on_hanging_and_the_wanted_pose_is_the_first():
    rows = on_track(screw())
    rails = make_device("rails", "b", span=(3e-3, 8e-3))
    kept = next(k for k, one in enumerate(rows) if neck(one) is not None)
    shares = np.linspace(1.0, 2.0, len(rows))
    shares[kept] = 1e-4  # rarer than what is shown otherwise
    (poses,) = find_device_poses((rails,), rows, shares / shares.sum(), (kept,))
    assert poses.passes[0].orientation.name == rows[kept].name
    assert poses.passes[0].becomes.startswith(HANGING)
    names = {one.orientation.name for one in (*poses.passes, *poses.returns, *poses.stops)}
    assert rows[kept].name in names
