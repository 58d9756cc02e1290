"""The balance gap: verdicts in closed form, what is proposed, and what a file says of it."""

import numpy as np
import pytest
import shapes
import trimesh
from on_track import block, coming, device, lying, pick, read
from round_bodies import revolved

from feederscrew import bowl as bowls
from feederscrew.base.errors import Faults
from feederscrew.bowl.devices.kinds import KINDS
from feederscrew.bowl.record import Track
from feederscrew.sorting.falling import surely_gone
from feederscrew.sorting.verdicts import DeviceEncounter, verdict

FORK = [(0, 0), (40, 0), (40, 2), (14, 2), (14, 10), (40, 10), (40, 12), (0, 12)]  # [mm] seen from above
# from the closed end: 14 x 12 mm about 7 mm, two prongs of 26 x 2 mm about 27 mm
BEHIND = 1e-3 * (14 * 12 * 7 + 2 * 26 * 2 * 27) / (14 * 12 + 2 * 26 * 2)
AHEAD, HEIGHT = 40e-3 - BEHIND, 5e-3
CAP = [(0, 0), (0, 4), (45, 4), (45, 3.2), (12, 3.2), (12, 0)]  # [mm] along its axis, and radius: of a pen


def swing_of(way):
    """Of the top of a nose about the edge that the weight passes, and the slip of a quarter of its height."""
    return np.hypot(way, HEIGHT) + 0.25 * HEIGHT


def gap(length, clearance, hold):
    """A balance gap of three lengths [mm]."""
    return device("balance gap", limit=1e-3 * length, clearance=1e-3 * clearance, hold=1e-3 * hold)


def flat_ends(every):
    """A fork flat along the track: with its light end ahead, and with its heavy end."""
    along = [one for one in every if one.length > 39e-3 and abs(one.height - HEIGHT) < 1e-6]
    return sorted(along, key=lambda one: -one.ahead)


@pytest.fixture(scope="module")
def fork():
    return lying(shapes.prism(FORK, 5))


def test_a_fork_reaches_ahead_of_its_weight_by_hand(fork):
    light, heavy = flat_ends(fork)
    assert (light.ahead, light.behind) == pytest.approx((AHEAD, BEHIND), rel=1e-4)
    assert (heavy.ahead, heavy.behind) == pytest.approx((BEHIND, AHEAD), rel=1e-4)
    assert heavy.nose_swing == pytest.approx(swing_of(BEHIND), rel=1e-4)


@pytest.mark.parametrize(("length", "clearance", "hold"), [(19, 6, 15), (22, 5.5, 10), (24.5, 6, 12)])
def test_a_fork_passes_with_its_light_end_ahead_alone(fork, length, clearance, hold):
    own, (light, heavy) = gap(length, clearance, hold), flat_ends(fork)
    # its nose on the far edge; below the bar; its top beyond the bar's 1.5 mm; its weight within 12 mm
    reach = AHEAD - (1e-3 * length - BEHIND) - 1e-3 * (hold + 1.5)
    expected = min(AHEAD - 1e-3 * length, 1e-3 * clearance - HEIGHT, reach, 6e-3)
    assert verdict(own, light).margin == pytest.approx(expected, abs=5e-6)
    assert verdict(own, heavy).margin == pytest.approx(swing_of(BEHIND) - 1e-3 * length, abs=5e-6)
    assert own.fate(DeviceEncounter(heavy)) == "returned" and surely_gone(own, heavy)
    # a gap alone is the same for both ends
    alone = device("gap", limit=1e-3 * length)
    assert verdict(alone, light).passes == verdict(alone, heavy).passes == 0.0


def test_what_may_meet_the_far_edge_as_it_tips_is_not_sure(fork):
    """Between its way ahead and the way by which the top of its nose swings."""
    _, heavy = flat_ends(fork)
    for length, fate in ((1e3 * BEHIND + 0.1, "stopped"), (1e3 * swing_of(BEHIND) - 0.1, "stopped")):
        own = gap(length, 6, 10)
        judged = verdict(own, heavy)
        assert judged.passes == 0.0 and not judged.sure
        assert own.fate(DeviceEncounter(heavy)) == fate


def test_what_travels_tips_later_by_its_carry():
    _, heavy = flat_ends(coming(shapes.prism(FORK, 5)))
    assert heavy.carry_ahead > 1e-3 and heavy.flight == 0.0
    expected = swing_of(heavy.ahead + heavy.carry_ahead) - 25e-3
    assert verdict(gap(25, 6, 10), heavy).margin == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize(("length", "clearance", "hold", "sure"), [
    (20, 5.8, 10, True),  # 0.8 mm over 10 mm: 4.6 deg
    (20, 5.9, 10, False),  # 5.1 deg
    (20, 5.5, 17.9, True),  # its top is 40 - 20 mm beyond the far edge
    (20, 5.5, 18.6, False),  # the bar is 1.5 mm thick
    (14, 9, 30, True),  # its tail reaches the near edge to the end: no bar is needed
])  # fmt: skip
def test_a_tail_needs_a_bar_that_holds_it(fork, length, clearance, hold, sure):
    light, _ = flat_ends(fork)
    judged = verdict(gap(length, clearance, hold), light)
    assert (judged.passes == 1.0 and judged.sure) == sure and judged.sure == sure


def test_a_tail_with_a_step_below_it_is_not_sure():
    """A block on two feet, 2 mm over the track between them: the tail meets the far edge by its own foot."""
    ring = [(0, 0), (12, 0), (12, 2), (36, 2), (36, 0), (40, 0), (40, 5), (0, 5)]
    along = [one for one in lying(shapes.prism(ring, 12)) if one.length > 39e-3 and one.height < 5.01e-3]
    light = next(one for one in along if len(one.foot.rings) == 2 and one.ahead > one.behind)
    judged = verdict(gap(1e3 * light.behind + 2.0, 5.5, 10), light)
    assert judged.passes == 0.0 and not judged.sure


def test_what_is_too_high_stands_at_the_bar(fork):
    own, on_edge = gap(20, 6, 10), [one for one in fork if abs(one.height - 12e-3) < 1e-6]
    light = max(on_edge, key=lambda one: one.ahead)
    assert verdict(own, light).margin == pytest.approx(-6e-3, abs=1e-6)
    assert own.fate(DeviceEncounter(light)) == "stopped"


def proposed(every, wanted):
    met = [[DeviceEncounter(one, every) for one in every if (one is wanted) == own] for own in (True, False)]
    return KINDS["balance gap"].proposals(*met, every, "test")


def test_it_is_proposed_where_the_weight_is_off_the_middle():
    for mesh, climb in ((shapes.prism(FORK, 5), 0.0), (revolved(CAP, 48), 6.0)):
        body = (
            mesh
            if isinstance(mesh, trimesh.Trimesh)
            else trimesh.Trimesh(**trimesh.triangles.to_kwargs(mesh))
        )
        every = coming(body, bowls.read(None, [f"track.bank={climb} deg", "track.width=18 mm"]))
        along = [one for one in every if one.length > 0.9 * max(own.length for own in every)]
        low = min(one.height for one in along)
        light, *_, heavy = sorted(
            (one for one in along if one.height < 1.01 * low), key=lambda one: -one.ahead
        )
        (own,) = proposed(every, light)
        passes, falls = verdict(own, light, every), verdict(own, heavy, every)
        assert passes.margin > 2.5e-4 and falls.margin < -4e-4
        assert light.behind < own.limit < light.ahead and surely_gone(own, heavy)
        assert not proposed(every, heavy)
    every = lying(block())
    assert not any(proposed(every, one) for one in every)


def test_the_way_to_the_hold_down_is_shorter_nearer_to_the_axis():
    """Radius 150 mm, 23 mm of gap: the far edge is 23.09 mm along the wall, the bar 14 mm farther."""
    own, bend = gap(23, 8.3, 14), Track(climb=0.0, bank=0.0, radius=0.15, width=0.02)
    every = lying(block(), bend)
    bar = 0.15 * np.arcsin(23 / 150) + 14e-3
    assert own.features(bend, every).blades[0].foot[0] == pytest.approx(bar, rel=1e-9)
    for one in every[:2]:
        assert own.hold_below(one) == pytest.approx((0.15 - one.distance) * bar / 0.15 - 23e-3, rel=1e-9)


def test_what_a_file_says_of_it_comes_back_as_it_was(tmp_path):
    words = "{gap: 23 mm, clearance: 8.3 mm, hold: 14 mm}"
    own = read(tmp_path, f"balance gap: {words}").devices[0]
    assert own.value_text() == words and own.lengths == pytest.approx((23e-3, 8.3e-3, 14e-3))
    assert own.document_values() == pytest.approx({"value_mm": 23.0, "clearance_mm": 8.3, "hold_mm": 14.0})
    assert "hold-down 8.3 mm over the track, 14 mm behind it" in own.value_words
    with pytest.raises(Faults, match="hold"):
        read(tmp_path, "balance gap: {gap: 23 mm, clearance: 8.3 mm}")


def test_its_bar_stands_at_a_way_behind_its_gap(fork):
    track = pick(fork, height=5).track
    features = gap(20, 6, 10).features(track, fork)
    (opening,), (bar,) = features.openings, features.blades
    far = track.radius * np.arcsin(20e-3 / track.radius)  # at the wall
    assert bar.foot[0] - far == pytest.approx(10e-3, abs=1e-9) and opening.end >= far
    assert bar.solid.bounds[:3] == pytest.approx((0.0, 6e-3, track.extent))
