"""Small changes of a part: volumes by closed forms, one body each, and what is no part to be changed."""

import math

import numpy as np
import pytest
import trimesh

import feederscrew as fs
from feederscrew.base.errors import MeshError
from feederscrew.designing.changes import LEAST_VOLUME, MOST_VOLUME, ChangeKind, list_changes
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


HEADED = (((-6, -6, 20), (6, 6, 24)), ((-2, -2, 0), (2, 2, 20)))  # a square head on a square shank


def turned_over(boxes):
    """The boxes upside down: the head at the lower end."""
    return [((*low[:2], -high[2]), (*high[:2], -low[2])) for low, high in boxes]


@pytest.mark.parametrize("is_high", [True, False])
def test_a_head_grows_towards_its_neck_and_round_a_bore(is_high):
    """(144 - 16) mm2 round the neck, a fifth of 4 mm; the part does not get longer."""
    boxes = HEADED if is_high else turned_over(HEADED)
    part = solid_of(*boxes)
    bored = bored_by(part, [trimesh.creation.box(bounds=np.array([(-1, -1, -30), (1, 1, 30)], float))])
    for each in (part, bored):
        (change,) = (one for one in of_kind(each, ChangeKind.THICKER_HEAD) if one.axis == 2)
        changed = loaded(change)
        assert change.size == pytest.approx(0.8 * MM) and change.high_end is is_high
        assert changed.volume - each.volume == pytest.approx(128 * 0.8 * MM**3, rel=2e-3)
        assert np.ptp(change.vertices[:, 2]) == pytest.approx(24 * MM)
        added = (changed.volume * changed.centre_of_mass - each.volume * each.centre_of_mass)[2]
        height = added / (changed.volume - each.volume) / MM
        assert height == pytest.approx(19.6 if is_high else -19.6, abs=0.05)


def test_a_flange_grows_to_every_side_over_its_own_height():
    """Half a millimetre round a square of 12 mm: its sides, and four quarters of a circle."""
    part = solid_of(*HEADED)
    (change,) = (one for one in of_kind(part, ChangeKind.WIDER_FLANGE) if one.axis == 2)
    ring = 48 * 0.5 + math.pi * 0.25
    assert change.size == pytest.approx(0.5 * MM)
    assert loaded(change).volume - part.volume == pytest.approx(4 * ring * MM**3, rel=2e-3)
    assert np.ptp(change.vertices, axis=0) / MM == pytest.approx([13, 13, 24])


def test_a_lug_stands_on_one_side_of_each_end_that_is_large_enough():
    """A tenth of the part high, a fifth of the end's narrower side wide and twice that long."""
    part = solid_of(*STEPPED)
    lugs = {one.high_end: one for one in of_kind(part, ChangeKind.LUG) if one.axis == 2}
    for is_high, side, lead in ((True, 2.0, 10.0), (False, 2.4, 20.0)):
        changed = loaded(lugs[is_high])
        volume = (changed.volume - part.volume) / MM**3
        assert lugs[is_high].size == pytest.approx(0.8 * MM)
        assert volume == pytest.approx(0.8 * side * 2 * side, rel=5e-3)
        ends = lugs[is_high].vertices[:, 2] / MM
        assert (ends.min(), ends.max()) == pytest.approx((0.0, 8.8) if is_high else (-0.8, 8.0))
        moved = (changed.volume * changed.centre_of_mass - part.volume * part.centre_of_mass)[0]
        assert moved / (volume * MM**4) == pytest.approx(lead - side / 2, abs=0.05)
    shank_end = [
        one for one in of_kind(solid_of(*HEADED), ChangeKind.LUG) if one.axis == 2 and not one.high_end
    ]
    assert not shank_end, "16 of 144 mm2 is no end to stand a lug on"


def test_a_chamfer_is_cut_where_it_takes_most():
    """Of the box about an angle one corner is empty: a chamfer there would take nothing."""
    part = solid_of(((0, 0, 0), (20, 4, 10)), ((0, 4, 0), (4, 12, 10)))
    (change,) = (one for one in of_kind(part, ChangeKind.CHAMFER) if one.axis == 2)
    assert part.volume - loaded(change).volume == pytest.approx(0.5 * 2.4**2 * 10 * MM**3, rel=1e-6)


def test_a_change_of_less_than_two_thousandths_is_none():
    """A chamfer of 0.3 mm along a plate of 100 x 100 x 1 takes 0.45 thousandths of it."""
    plate = solid_of(((0, 0, 0), (100, 100, 1)))
    assert [one.axis for one in of_kind(plate, ChangeKind.CHAMFER)] == [2]
    thick = solid_of(((0, 0, 0), (20, 20, 1)))  # 2.25 thousandths
    assert {one.axis for one in of_kind(thick, ChangeKind.CHAMFER)} == {0, 2}


def bored_by(part, tools):
    """A part without what the tools take."""
    mesh = trimesh.Trimesh(part.vertices / MM, part.faces)
    left = trimesh.boolean.difference([mesh, *tools], engine="manifold")
    return fs.load((left.vertices, left.faces), units="mm")


def disc(radius, low, high, at=(0.0, 0.0)):
    """A round bar of 64 sides along z [mm]."""
    bar = trimesh.creation.cylinder(radius=radius, height=high - low, sections=64)
    return bar.apply_translation((*at, 0.5 * (low + high)))


PLATE = ((0, 0, 0), (30, 20, 4))


@pytest.mark.parametrize(
    ("low", "high"), [(1.5, 9.0), (-5.0, 2.5), (-5.0, 9.0)], ids=["above", "below", "through"]
)
def test_a_hole_that_is_blind_on_either_side_keeps_its_depth_as_it_moves(low, high):
    part = bored_by(solid_of(PLATE), [disc(2.0, low, high, (9.0, 10.0))])
    (change,) = of_kind(part, ChangeKind.MOVED_HOLE)
    moved = loaded(change)
    assert moved.volume == pytest.approx(part.volume, rel=1e-5)
    taken = 30 * 20 * 4 - part.volume / MM**3
    way = (moved.centre_of_mass - part.centre_of_mass) / MM
    assert way == pytest.approx([3.0 * taken * MM**3 / part.volume, 0.0, 0.0], abs=1e-4)


def test_a_kidney_is_moved_as_it_is_and_its_middle_is_in_the_material():
    ring = trimesh.boolean.difference(
        [disc(6.0, -1, 5, (13, 10)), disc(3.5, -2, 6, (13, 10))], engine="manifold"
    )
    half = trimesh.creation.box(bounds=np.array([(0, 0, -1), (13, 20, 5)], float))
    kidney = trimesh.boolean.intersection([ring, half], engine="manifold")
    part = bored_by(solid_of(((0, 0, 0), (36, 20, 4))), [kidney])
    (change,) = (one for one in of_kind(part, ChangeKind.MOVED_HOLE) if one.axis == 2)
    moved = loaded(change)
    assert moved.volume == pytest.approx(part.volume, rel=1e-5)
    taken = 36 * 20 * 4 - part.volume / MM**3
    shift = (moved.centre_of_mass - part.centre_of_mass)[0] / MM * part.volume / MM**3 / taken
    assert abs(shift) == pytest.approx(3.6, abs=1e-3)


def test_what_is_no_hole_is_not_moved():
    plate = solid_of(PLATE)
    groove = trimesh.boolean.difference(
        [disc(5.0, 2, 9, (12, 10)), disc(1.5, 0, 9, (12, 10))], engine="manifold"
    )
    round_a_pin = bored_by(plate, [groove])
    cavity = bored_by(plate, [disc(3.0, 1, 3, (12, 10))])
    stepped = bored_by(plate, [disc(2.0, -1, 9, (12, 10)), disc(4.0, 2, 9, (12, 10))])
    box = trimesh.creation.box(bounds=np.array([(2, 5, 1), (32, 35, 9)], float))
    hollow = bored_by(solid_of(((0, 0, 0), (42, 40, 6))), [box])  # 900 of 1,680 mm2: there is room to move it
    for part in (round_a_pin, cavity, stepped, hollow):
        assert not [one for one in of_kind(part, ChangeKind.MOVED_HOLE) if one.axis == 2]


def test_a_flat_needs_the_wall_for_it():
    """A tube of 10 mm: a flat 1 mm deep leaves nothing of a wall of 1.2 mm, and 2 mm of one of 3 mm."""
    for bore, is_cut in ((3.8, False), (2.0, True)):
        part = bored_by(
            fs.load((disc(5.0, 0, 30).vertices, disc(5.0, 0, 30).faces), units="mm"), [disc(bore, -1, 31)]
        )
        flats = of_kind(part, ChangeKind.FLAT)
        assert bool(flats) is is_cut
    half = math.acos(0.8)
    taken = 30 * 25 * (half - math.sin(half) * math.cos(half))
    assert part.volume - loaded(flats[0]).volume == pytest.approx(taken * MM**3, rel=2e-2)


@pytest.mark.parametrize("degrees", [0.0, 33.0])
@pytest.mark.parametrize(("wide", "is_closed"), [(3.8, True), (4.2, False)])
def test_a_slot_narrower_than_a_third_is_closed_at_any_angle(wide, is_closed, degrees):
    """12 mm is the narrower side of the part; what is written is the width of the slot, not of its shadow."""
    beside = 0.5 * (20 - wide)
    boxes = [((0, 0, 0), (20, 9, 10)), ((0, 9, 0), (beside, 12, 10)), ((20 - beside, 9, 0), (20, 12, 10))]
    bodies = [trimesh.creation.box(bounds=np.array(box, float)) for box in boxes]
    mesh = trimesh.boolean.union(bodies, engine="manifold")
    mesh.apply_transform(trimesh.transformations.rotation_matrix(math.radians(degrees), (0, 0, 1)))
    part = fs.load((mesh.vertices, mesh.faces), units="mm")
    slots = [one for one in of_kind(part, ChangeKind.CLOSED_SLOT) if one.axis == 2]
    assert bool(slots) is is_closed
    if is_closed:
        assert slots[0].size == pytest.approx(3.0 * MM, rel=1e-3)  # the shorter side of 3.8 x 3
        assert loaded(slots[0]).volume - part.volume == pytest.approx(wide * 3 * 10 * MM**3, rel=2e-3)


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
