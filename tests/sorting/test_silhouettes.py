"""The silhouette blade: verdicts in closed form, what it proposes, and what a file says of it."""

import numpy as np
import pytest
import shapes
from on_track import device, lying, read

from feederscrew.base.errors import Faults
from feederscrew.bowl.devices.kinds import KINDS
from feederscrew.bowl.devices.silhouettes import PLAY_M, BladeCandidate, choose_blades, nearest_above
from feederscrew.sorting.isolating.chain import fewest
from feederscrew.sorting.verdicts import DeviceEncounter, verdict

# [mm] an angle of 20 x 12 mm, its long leg 4 mm thick and its short one 5 mm; 15 mm long
ANGLE = [(0.0, 0.0), (20.0, 0.0), (20.0, 4.0), (5.0, 4.0), (5.0, 12.0), (0.0, 12.0)]


@pytest.fixture(scope="module")
def angle():
    """The angle on its broad leg, along the wall: its upright leg at the wall, and at the free edge."""
    every = lying(shapes.prism(ANGLE, 15))
    flat = [one for one in every if abs(one.height - 12e-3) < 1e-5 and abs(one.width - 20e-3) < 1e-4]
    flat = [one for one in flat if one.foot.corners.shape[0] and one.length < 15.1e-3]
    at_wall = min(flat, key=lambda one: one.distance)
    off_wall = max(flat, key=lambda one: one.distance)
    return {"at": at_wall, "off": off_wall, "all": every}


def blade(limit, reach, leaves, sweep=30.0):
    """A silhouette blade of lengths [mm] and a sweep [deg]."""
    sizes = {"limit": 1e-3 * limit, "reach": 1e-3 * reach, "leaves": 1e-3 * leaves}
    return device("silhouette blade", sweep=np.radians(sweep), **sizes)


def centre():
    """How far the weight of the angle lies from the outside of its upright leg [m], by hand."""
    long, short = 20.0 * 4.0, 5.0 * 8.0
    return 1e-3 * (long * 10.0 + short * 2.5) / (long + short)


def test_a_leg_off_the_wall_leaves_the_blade_room(angle):
    """It ends r off the wall, the leg begins at 15 mm; w is left, the weight at 12.5 mm; play 0.5 mm."""
    assert angle["at"].distance == pytest.approx(centre(), abs=2e-4)  # the track bends
    assert angle["off"].distance == pytest.approx(20e-3 - centre(), abs=2e-4)
    for reach, leaves in ((13.0, 19.0), (8.0, 13.5)):
        expected = min(15e-3 - 1e-3 * reach, 1e-3 * leaves - angle["off"].balcony) - PLAY_M
        assert verdict(blade(6, reach, leaves), angle["off"]).margin == pytest.approx(expected, abs=1e-4)


def test_within_its_play_off_the_wall_no_verdict_is_sure(angle):
    """The leg begins at 15 mm: a blade of 14.7 mm leaves it 0.3 mm of 0.5 mm, and so does the track."""
    for reach, leaves in ((14.7, 19.0), (8.0, 1e3 * angle["off"].balcony + 0.3)):
        judged = verdict(blade(6, reach, leaves), angle["off"])
        assert judged.passes == 0.0 and not judged.sure


def test_material_below_the_edge_is_twice_as_far_off_as_the_blade_is_higher(angle):
    """The broad leg is 4 mm high: a blade 5 mm over the track has 1 mm of room above it; it counts twice."""
    own = verdict(blade(5, 8, 19), angle["off"])
    assert own.margin == pytest.approx(2e-3, abs=2e-5)


@pytest.mark.parametrize(("reach", "leaves"), [(8.0, 11.5), (12.0, 15.0), (9.0, 16.0)])
def test_a_leg_at_the_wall_is_pushed_off_what_is_left(angle, reach, leaves):
    """Pushed by the reach, its weight lies that and 7.5 mm off the wall; it stands 6 mm over the edge."""
    pushed = angle["at"].balcony + 1e-3 * (reach - leaves)
    own = verdict(blade(6, reach, leaves), angle["at"])
    assert own.margin == pytest.approx(-min(1e-3 * reach, pushed, 6e-3), abs=1e-4)
    assert blade(6, reach, leaves).fate(DeviceEncounter(angle["at"])) == "returned"
    assert blade(6, reach, leaves, 85.0).fate(DeviceEncounter(angle["at"])) == "stopped"


def test_one_that_is_pushed_and_still_carried_is_not_sure(angle):
    judged = verdict(blade(6, 3, 19), angle["at"])
    assert judged.passes == 0.0 and not judged.sure


def test_what_the_narrowed_track_does_not_carry_falls_without_a_push(angle):
    leaves = 1e3 * angle["off"].balcony - 2.0
    assert verdict(blade(6, 3, leaves), angle["off"]).margin == pytest.approx(-2e-3, abs=1e-6)


def test_a_blade_is_proposed_that_tells_an_angle_from_its_mirror_pose(angle):
    kind, every = KINDS["silhouette blade"], angle["all"]

    def proposed(wanted, others):
        met = [[DeviceEncounter(one, every) for one in some] for some in (wanted, others)]
        return kind.proposals(*met, every, "test")

    (first, *_) = proposed([angle["off"]], [angle["at"]])
    assert verdict(first, angle["off"]).margin >= 2.4e-4 and verdict(first, angle["at"]).margin <= -9.9e-4
    assert not proposed([angle["off"]], [])


def test_blades_are_proposed_the_lowest_first_and_leave_a_third_of_the_way(angle):
    """Against the mirror pose, 7.5 mm off the wall: a room of 0.5 mm takes 1 mm of 15 mm off the reach."""
    kind, every = KINDS["silhouette blade"], angle["all"]
    wanted = angle["off"]
    met = [[DeviceEncounter(one, every) for one in some] for some in ([wanted], [angle["at"]])]
    (first, *_) = kind.proposals(*met, every, "test")
    reach = min(15e-3 - 1e-3, wanted.balcony)
    assert first.reach == pytest.approx(reach, abs=6e-5)
    carried = wanted.balcony + PLAY_M
    least = min(angle["at"].balcony + first.reach, carried + 6.0 * 5e-4)
    assert first.leaves == pytest.approx(carried + (least - carried) / 3.0, abs=6e-5)


def test_of_a_tee_the_lowest_blade_is_in_front():
    """A plate of 12 x 12 mm and 5 mm with a web of 3 mm along its middle, 11 mm high with it.

    With its web along the track it leaves 4.5 mm of room above 5 mm. On its sides it is 12 mm high; with its
    plate at the wall only a blade above 11 mm pushes it so far that it falls.
    """
    outline = [(0, 0), (12, 0), (12, 5), (7.5, 5), (7.5, 11), (4.5, 11), (4.5, 5), (0, 5)]
    every, kind = lying(shapes.prism(outline, 12)), KINDS["silhouette blade"]
    upright = [one for one in every if abs(one.height - 11e-3) < 1e-5 and one.balcony < 6.5e-3]
    wanted = next(one for one in upright if nearest_above(one, 6e-3) > 4e-3)
    others = [one for one in every if one is not wanted]
    met = [[DeviceEncounter(one, every) for one in some] for some in ([wanted], others)]
    heights = [one.limit for one in kind.proposals(*met, every, "test")]
    assert heights == sorted(heights) and heights[0] < 11e-3
    assert heights[-1] == pytest.approx(11.3e-3)  # 0.25 mm above what is wanted, and a step of the shop
    # 2.75 mm above the plate, and half of the 3.25 mm up to the top of the web. At 6.8 mm there would be
    # 1.8 mm, but with its web at the wall the tee has its upper 0.7 mm in the way there
    assert any(abs(height - 7.75e-3) < 1e-6 for height in heights)
    cuts = [(one.reach, one.leaves) for one in kind.proposals(*met, every, "test")]
    assert len(set(cuts)) == len(cuts)  # none is proposed at two clearances


def test_a_blade_gives_way_to_one_with_more_room_that_returns_what_it_alone_does():
    def candidate(height, returned, leaves=7.0):
        return BladeCandidate(frozenset(returned), height, 3.5, leaves, room_of_edge=height)

    low, high, tall = candidate(5.0, {0, 1, 2}), candidate(8.0, {0, 1}), candidate(9.0, {0})
    assert choose_blades([low, high, tall], frozenset()) == [low]  # 2 is returned by it alone
    assert choose_blades([low, high, tall], frozenset({2})) == [high]
    assert choose_blades([low, high, candidate(9.0, {0, 1}, leaves=6.0)], frozenset({2})) == [high]
    other = candidate(6.0, {2, 3})
    assert choose_blades([low, high, other], frozenset()) == [high, other]  # the other one returns 2
    assert choose_blades([low, high], frozenset({0, 1, 2})) == [low]  # it alone returns nothing
    assert not choose_blades([], frozenset())


def test_what_touches_a_blade_at_its_rim_alone_fails_by_that(angle):
    """The upright leg ends 12 mm over the track: a blade at 11.7 mm has 0.3 mm of it."""
    assert verdict(blade(11.7, 12, 15), angle["at"]).margin == pytest.approx(-0.3e-3, abs=1e-6)


def test_behind_its_end_a_blade_leaves_room_to_fall(angle):
    """Its foot half a room in, its end r / tan(a) on, and one room of 1.3 times the longest part."""
    track, every = angle["at"].track, angle["all"]
    made = blade(6, 12, 15).features(track, every)
    longest = max(one.length for one in every)
    assert made.length == pytest.approx(1.5 * 1.3 * longest + 12e-3 / np.tan(np.radians(30.0)))
    (plate,), (cut,) = made.blades, made.openings
    assert plate.foot == (pytest.approx(0.65 * longest), 0.0) and plate.solid.bounds[1] == 6e-3
    assert plate.solid.bounds[2] == pytest.approx(12e-3 / np.sin(np.radians(30.0)))
    assert cut.span == (15e-3, track.extent) and cut.end == pytest.approx(made.length)


def test_of_chains_as_long_the_one_that_pushes_farther_is_taken():
    low, high = blade(5, 8, 19), blade(7, 8, 19)
    margins = {low: np.array([1e-3, -6e-4]), high: np.array([1e-3, -9e-4])}
    shares = np.array([0.0, 1.0])
    assert fewest(margins, shares, 5e-4) == (high,)
    gaps = device("gap", limit=5e-3), device("gap", limit=6e-3)
    assert fewest(dict(zip(gaps, margins.values())), shares, 5e-4) == gaps[:1]  # else the first one


def test_what_a_file_says_of_a_blade_comes_back_as_it_was(tmp_path):
    words = "{clearance: 5 mm, reach: 3.5 mm, leaves: 8 mm, sweep: 30 deg, friction: 0.2}"
    own = read(tmp_path, f"silhouette blade: {words}").devices[0]
    assert own.value_text() == words
    assert (own.limit, own.reach, own.leaves, own.friction) == (5e-3, 3.5e-3, 8e-3, 0.2)
    assert own.document_values() == {
        "value_mm": 5.0, "reach_mm": 3.5, "leaves_mm": 8.0, "sweep_deg": pytest.approx(30.0), "friction": 0.2
    }  # fmt: skip
    assert not own.misfits(20e-3) and own.misfits(3e-3)
    with pytest.raises(Faults, match="reaches over the free edge"):
        read(tmp_path, "silhouette blade: {clearance: 5 mm, reach: 9 mm, leaves: 8 mm, sweep: 30 deg}")


def test_behind_rails_a_blade_has_no_meaning(tmp_path):
    with pytest.raises(Faults, match="no meaning for parts that hang"):
        read(
            tmp_path,
            "rails: {from: 3 mm, to: 7 mm}",
            f"silhouette blade: {KINDS['silhouette blade'].trade.example}",
        )
