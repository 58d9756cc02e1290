"""Small changes of a part: volumes by closed forms, one body each, and what is no part to be changed."""

import math

import numpy as np
import pytest
import trimesh

import feederscrew as fs
from feederscrew.advising.changes import LEAST_VOLUME, MOST_VOLUME, ChangeKind, list_changes
from feederscrew.errors import MeshError
from feederscrew.sorting.orientations import orientations, shoulders

MM = 1e-3


def solid_of(*boxes):
    """A part of boxes that touch, each (low, high) in mm."""
    bodies = [trimesh.creation.box(bounds=np.array(box, float)) for box in boxes]
    mesh = trimesh.boolean.union(bodies, engine="manifold") if len(bodies) > 1 else bodies[0]
    return fs.load((mesh.vertices, mesh.faces), units="mm")


def of_kind(part, kind):
    return [change for change in list_changes(part) if change.kind is kind]


def loaded(change):
    return fs.load((change.vertices, change.faces), units="m")


BLOCK = ((0, 0, 0), (20, 12, 5))
STEPPED = (BLOCK, ((0, 0, 5), (10, 12, 8)))  # a block, half of it higher


def test_a_chamfer_takes_its_triangle_along_the_edge():
    part = solid_of(BLOCK)
    lengths = {0: (20.0, 5.0), 1: (12.0, 5.0), 2: (5.0, 12.0)}  # by axis: along it, the smaller side across
    chamfers = of_kind(part, ChangeKind.CHAMFER)
    assert sorted(change.axis for change in chamfers) == [0, 1, 2]
    for change in chamfers:
        long, thin = lengths[change.axis]
        size = 0.2 * thin
        assert change.size == pytest.approx(size * MM)
        assert part.volume - loaded(change).volume == pytest.approx(0.5 * size**2 * long * MM**3, rel=1e-6)


def test_a_flat_takes_a_segment_of_the_circle():
    mesh = trimesh.creation.cylinder(radius=3.0, height=20.0, sections=720)
    part = fs.load((mesh.vertices, mesh.faces), units="mm")
    (change,) = of_kind(part, ChangeKind.FLAT)
    assert (change.axis, change.size) == (2, pytest.approx(0.6 * MM, rel=1e-4))
    half = math.acos(1.0 - 0.6 / 3.0)
    segment = 9.0 * (half - math.sin(half) * math.cos(half))
    assert part.volume - loaded(change).volume == pytest.approx(20.0 * segment * MM**3, rel=1e-3)


def test_a_moved_hole_leaves_the_volume_and_moves_the_centre():
    plate = trimesh.creation.box(bounds=np.array([(0, 0, 0), (30, 20, 2)], float))
    hole = trimesh.creation.cylinder(radius=2.0, height=6.0, sections=64).apply_translation((10, 10, 1))
    mesh = trimesh.boolean.difference([plate, hole], engine="manifold")
    part = fs.load((mesh.vertices, mesh.faces), units="mm")
    (change,) = of_kind(part, ChangeKind.MOVED_HOLE)
    moved = loaded(change)
    assert moved.volume == pytest.approx(part.volume, rel=1e-5)
    taken = 30 * 20 * 2 - part.volume / MM**3
    way = (moved.centre_of_mass - part.centre_of_mass) / MM  # away from the middle: to smaller x, by 3 mm
    assert way == pytest.approx([3.0 * taken * MM**3 / part.volume, 0.0, 0.0], abs=1e-4)


def test_a_part_made_symmetric_is_its_own_mirror_image():
    part = solid_of(BLOCK, ((0, 0, 5), (5, 12, 7)))
    changed = [loaded(change) for change in of_kind(part, ChangeKind.MADE_SYMMETRIC)]
    assert len(changed) == 1  # along x alone: from z it would add more than may be added
    assert changed[0].centre_of_mass[0] == pytest.approx(10 * MM)
    assert changed[0].volume - part.volume == pytest.approx(5 * 12 * 2 * MM**3)


def test_a_slot_is_closed_and_a_wide_opening_is_not():
    clip = solid_of(((0, 0, 0), (20, 2, 10)), ((0, 2, 0), (9, 12, 10)), ((11, 2, 0), (20, 12, 10)))
    (change,) = of_kind(clip, ChangeKind.CLOSED_SLOT)
    assert loaded(change).volume - clip.volume == pytest.approx(2 * 10 * 10 * MM**3, rel=1e-3)
    bracket = solid_of(((0, 0, 0), (20, 2, 10)), ((0, 2, 0), (2, 12, 10)))
    assert all(
        loaded(change).volume < 1.1 * bracket.volume for change in of_kind(bracket, ChangeKind.CLOSED_SLOT)
    )


@pytest.mark.parametrize("file", ["hexbolt_m8x25", "lbracket_30x20x15", "cap_14x10"])
def test_each_change_is_one_closed_body_near_the_part(file):
    part = fs.load(f"parts/{file}.stl")
    changes = list_changes(part)
    assert len(changes) >= 3
    assert len({change.text for change in changes}) == len(changes)
    for change in changes:
        changed = loaded(change)  # which refuses what is no single closed body
        assert LEAST_VOLUME <= change.share <= MOST_VOLUME
        assert abs(changed.volume / part.volume - 1.0) <= MOST_VOLUME


def test_a_bolt_with_a_lug_can_be_followed_over_a_slot():
    """Its tilted aspect is of facets in one plane but for 10 um: no corner touches within a micrometre."""
    part = fs.load("parts/hexbolt_m8x25.stl")
    bowl = fs.read_bowl()
    high = [change for change in of_kind(part, ChangeKind.LUG) if change.high_end]
    changed = loaded(high[0])
    for lying in orientations(changed, fs.find_aspects(changed), bowl.track):
        shoulders(lying, 0.009)


def test_what_has_no_body_is_refused():
    card = fs.load("parts/magnet.yaml")
    with pytest.raises(MeshError, match="part card"):
        list_changes(card)
    mesh = trimesh.creation.box((10, 6, 4))
    opened = fs.load((mesh.vertices, mesh.faces[2:]), units="mm", allow_open=True)
    with pytest.raises(MeshError, match="open surface"):
        list_changes(opened)
