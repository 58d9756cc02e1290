"""What a trial tells of the parts that were counted in it, against sums done by hand."""

from types import SimpleNamespace

import numpy as np
import pytest

from feederscrew import bowl as bowls
from feederscrew.conveying import answer
from feederscrew.trial import course, part_poses, result, runs
from feederscrew.trial.course import HANGING, PASSED, RETURNED, ROLLED_BACK, STOPPED, STUCK, TURNED
from feederscrew.trial.result import TrialRun

UNKNOWN, GONE = -1, -2  # orientations a part left in
PARTS = (  # orientation laid down in, fate, orientation at the end, velocity [m/s], station, depth [mm]
    (0, PASSED, 0, 0.04, 1, 0.1),
    (0, PASSED, 0, 0.05, 1, 0.3),
    (0, TURNED, 1, 0.06, 1, 0.2),
    (0, RETURNED, GONE, 0.05, 1, 0.0),
    (1, PASSED, 1, 0.02, 1, 0.0),
    (1, STUCK, GONE, 0.9, 0, 0.0),  # on the bare track: its velocity is none
    (2, TURNED, UNKNOWN, 0.03, 1, 0.5),
)


def trial(parts=PARTS, through=(1.0, 0.0, 0.0), lengths=(20e-3, 12e-3, 15e-3)):
    """A trial of three orientations that come in shares of 0.5, 0.3 and 0.2."""
    entered, fates, out, velocities, ended, depths = (np.array(column) for column in zip(*parts))
    lying = tuple(
        SimpleNamespace(name=name, length=long, returned=False) for name, long in zip("ABC", lengths)
    )
    known = SimpleNamespace(
        lying=lying, states=lying, lengths=np.array([20e-3, 12e-3, 15e-3]), through=np.array(through),
        sure=np.ones(3, bool), margin=np.array([1e-3, -2e-4, -3e-4]), passes=np.ones((3, 1)),
    )  # fmt: skip
    course = SimpleNamespace(
        entered=entered, fates=fates, orientations=out[None], velocities=velocities, ended=ended,
        depths=1e-3 * depths,
    )  # fmt: skip
    bowl = SimpleNamespace(devices=(), drive=None)
    return TrialRun(
        bowl, throw_number=0.8, orientations=known, shares=np.array([0.5, 0.3, 0.2]), course=course
    )


def driven(*velocities):
    return trial([(*one[:3], velocity, *one[4:]) for one, velocity in zip(PARTS, velocities)])


def test_what_leaves_is_weighed_by_the_shares_in_which_orientations_come():
    """Half of 0.5 leaves as 0; a quarter of 0.5 and half of 0.3 as 1; all of 0.2 as none that is known."""
    found = trial()
    np.testing.assert_allclose(found.leaving, [0.25, 0.275, 0.0, 0.2], rtol=1e-12)
    assert found.wanted == 1 and found.efficiency == pytest.approx(0.275)
    assert found.purity == pytest.approx(0.275 / 0.725)
    assert found.tried.tolist() == [4, 2, 1] and found.jams == 1
    np.testing.assert_allclose(found.depths, [0.3e-3, 0.0, 0.5e-3])


def test_the_velocity_is_that_of_what_travels_by_the_same_shares():
    """(0.125 (0.04 + 0.05 + 0.06 + 0.05) + 0.15 0.02 + 0.2 0.03) / 0.85; it may all roll back."""
    assert trial().velocity == pytest.approx(0.04)
    assert np.isnan(trial().rolling_back)
    back = driven(-0.04, -0.05, -0.06, -0.05, -0.02, -0.9, -0.03)
    assert back.velocity == pytest.approx(-0.04) == back.rolling_back and back.parts == 0.0
    assert driven(-0.04, -0.05, 0.06, -0.05, -0.02, -0.9, -0.03).velocity == pytest.approx(0.06)


def test_parts_come_as_offered_but_no_closer_than_one_behind_the_other():
    """40 mm/s over a mean of 16.6 mm, of which 0.275 leave; or one a length of what most leave in."""
    assert trial().parts == pytest.approx(0.275 * 40.0 / 16.6)
    assert trial(lengths=(20e-3, 80e-3, 15e-3)).parts == pytest.approx(0.5)
    assert trial([(0, RETURNED, GONE, 0.04, 1, 0.0)]).parts == 0.0


def test_what_was_tried_is_set_beside_the_static_rule(monkeypatch):
    """Of a verdict with 0.25 mm or less to spare nothing is odd; elsewhere 19 of 20 have to hold."""
    monkeypatch.setattr(result, "steady", lambda devices, lying, bowl, margin: np.ones(len(lying), bool))
    found = trial()
    assert found.holding.tolist() == [2, 1, 0]  # what is turned has left: it was not returned
    assert found.odd.tolist() == [True, False, True] and not found.sorts
    assert found.differs.tolist() == (found.holding < 0.95 * found.tried).tolist()
    np.testing.assert_allclose(found.ends[0], [0.150, 0.850], atol=5e-4)  # Wilson, 2 of 4
    kept = [(0, PASSED, 0, 0.04, 1, 0.0)] * 19 + [(1, RETURNED, GONE, 0.04, 1, 0.0)]
    for missed, fine in ((1, True), (2, False)):
        some = trial([*kept, *[(0, RETURNED, GONE, 0.04, 1, 0.0)] * missed])
        assert some.sorts == fine and some.odd.any() != fine
    assert not trial([*kept, (2, PASSED, 2, 0.04, 1, 0.0)]).sorts


@pytest.mark.parametrize("speed", [0.04, -0.04])
def test_a_user_is_told_what_is_odd_what_is_deep_and_that_nothing_travels(speed, monkeypatch):
    monkeypatch.setattr(result, "steady", lambda devices, lying, bowl, margin: np.ones(len(lying), bool))
    told = [*trial([(0, RETURNED, GONE, speed, 1, 0.5), (1, RETURNED, GONE, speed, 1, 0.2)]).remarks]
    assert told[0] == "A: 0 of 1 do what the static verdict says (passes, margin 1.00 mm)"
    assert told[1].startswith("A: up to 0.5 mm deep in the track or a device")
    assert told[2:] == ([] if speed > 0.0 else ["the part does not travel up the track: see feeder convey"])


@pytest.mark.parametrize("fate", [HANGING, STOPPED, STUCK])
def test_one_that_stands_in_the_way_is_no_sorting(fate):
    kept = [(0, PASSED, 0, 0.04, 1, 0.0)] * 60
    assert trial(kept).sorts and trial(kept).jams == 0
    assert not trial([*kept, (0, fate, GONE, 0.04, 1, 0.0)]).sorts


def test_what_went_down_a_ledge_goes_on_at_the_wall_of_the_lower_track():
    """In units of 10 mm, 15 of them about the axis: 3 mm down and 4 mm aside are led back, no others."""
    known = SimpleNamespace(length=10e-3, radius=15.0)
    angles, off = np.array([0.1, 0.2]), np.array([0.6, 0.3])  # off the wall
    states = np.zeros((2, 13))
    states[:, 0] = (15.0 - off) * np.sin(angles)
    states[:, 1] = 15.0 - (15.0 - off) * np.cos(angles)
    states[:, 2] = (-0.25, 0.05)  # the first lies on the lower track
    for aside, down in ((4e-3, (1.0, 0.0)), (0.0, (1.0, 1.0))):  # over a step all go down
        station = SimpleNamespace(drop=3e-3, aside=aside)
        found = course._led_on(states, station, 0.12, known)
        from_axis = found[:, :2] - [0.0, 15.0]
        np.testing.assert_allclose(found[:, 2], states[:, 2] + 0.3 * np.array(down))
        np.testing.assert_allclose(np.hypot(*from_axis.T), 15.0 - off + aside / 10e-3 * np.array(down))
        np.testing.assert_allclose(np.arctan2(found[:, 0], -from_axis[:, 1]), 0.12 / 0.15)


@pytest.mark.parametrize("way", [30e-3, 900e-3])
def test_what_creeps_is_followed_to_the_end_and_its_places_are_noted_for_three_times_as_long(way):
    bowl = bowls.default()
    speed = float(answer.answer(bowl).velocity)
    station, lying = SimpleNamespace(begin=0.2, exit=0.2 + way), [SimpleNamespace(length=40e-3)]
    found = course._limits(bowl, station, lying)
    seconds, patience, least, back = found["limits"]
    assert seconds == pytest.approx(way / (0.03 * speed) + 1.0)
    assert patience == pytest.approx(20e-3 / speed) and patience > 0.5 and back == pytest.approx(20e-3)
    assert least == pytest.approx(0.03 * patience * speed)
    periods = found["interval"] * bowl.drive.frequency
    assert periods == pytest.approx(round(periods)) and periods >= 1.0
    assert 300 * (found["interval"] - 1.0 / bowl.drive.frequency) <= way / speed <= 300 * found["interval"]
    assert found["places"] * found["interval"] >= 3.0 * way / speed


def test_a_velocity_is_the_mean_over_the_second_half_of_a_path_round_the_bowl():
    """Of 9 places the last 5: at 30 mm/s along a wall of 150 mm, twice as fast before; 10 mm off the wall."""
    times = np.arange(9) * 0.5
    way = np.concatenate([0.06 * times[:5], 0.12 + 0.03 * (times[5:] - 2.0)])
    path = np.full((12, 3), np.nan)
    path[:9] = np.column_stack([times, 0.14 * np.sin(way / 0.15), 0.15 - 0.14 * np.cos(way / 0.15)])
    four, three = (np.where(np.arange(12)[:, None] < count, path, np.nan) for count in (4, 3))
    outcomes = [runs.PASSED, runs.RETURNED, runs.PASSED, runs.STANDS]
    found = course.velocities(SimpleNamespace(paths=[path, path, four, three], outcomes=outcomes), 0.15)
    np.testing.assert_allclose(found, [0.03, np.nan, 0.06, np.nan], rtol=1e-9)


@pytest.mark.parametrize(
    ("outcome", "rear", "front", "low", "fate"),
    [  # a device from 100 to 130 mm under whose track there is room; in mm
        (runs.RETURNED, 90.0, 110.0, -9.0, RETURNED),
        (runs.ROLLED, 90.0, 110.0, 0.0, ROLLED_BACK),
        (runs.RUNNING, 90.0, 110.0, -3.11, HANGING),  # 0.1 mm under the lower track
        (runs.RUNNING, 90.0, 110.0, -3.09, STOPPED),
        (runs.RUNNING, 80.0, 99.55, 0.0, STOPPED),  # within half a millimetre of it
        (runs.RUNNING, 80.0, 99.45, 0.0, STUCK),
        (runs.RUNNING, 130.45, 150.0, 0.0, STOPPED),
        (runs.RUNNING, 130.55, 150.0, 0.0, STUCK),
        (runs.STANDS, 90.0, 110.0, -3.11, STOPPED),
    ],
)
def test_where_a_part_stands_says_what_became_of_it(outcome, rear, front, low, fate, monkeypatch):
    """In units of 10 mm; the track behind the device is 3 mm lower."""
    monkeypatch.setattr(part_poses, "extents", lambda *_: (0.1 * rear, 0.1 * front, 0.1 * low))
    looks = SimpleNamespace(corners=None, radius=15.0)
    for below in (True, False):
        station = SimpleNamespace(below=below, drop=3e-3, cut=(0.1, 0.13))
        found = course._CourseCollector._fate(SimpleNamespace(looks=looks), station, outcome, None, 10e-3)
        assert found == (STOPPED if fate == HANGING and not below else fate)


def test_what_leaves_otherwise_than_it_may_was_turned_wherever_it_turned():
    """Two stations; all come to the last one as they were laid down, and one leaves it as none is known."""
    for may, fates in (([[1, 0], [0, 1]], [PASSED, TURNED, PASSED, TURNED, RETURNED]),
                       ([[0, 1], [0, 1]], [TURNED, PASSED, PASSED, TURNED, RETURNED])):  # fmt: skip
        found = course._CourseCollector((None, None), np.array([0, 0, 1, 1, 0]), None)
        assert (found.orientations[0] == [0, 0, 1, 1, 0]).all() and (found.orientations[1:] < UNKNOWN).all()
        found.orientations[1] = [0, 0, 1, 1, 0]
        found.orientations[2] = [0, 1, 1, UNKNOWN, GONE]
        found.fates[:] = [PASSED, PASSED, PASSED, PASSED, RETURNED]
        made = found.course(1.0, np.eye(3), np.array(may, bool), False)
        assert made.fates.tolist() == fates
