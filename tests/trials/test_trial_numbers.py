"""What a trial tells of the parts that were counted in it, against sums done by hand."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from feederscrew import bowl as bowls
from feederscrew.motion import conveying as answer
from feederscrew.trials import course, result, runs
from feederscrew.trials.course import HANGING, PASSED, RETURNED, STOPPED, STUCK, TURNED
from feederscrew.trials.queue_counts import MAX_QUEUE_DEPTH_M
from feederscrew.trials.result import TrialRun

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
    pairs = zip("ABC", lengths)
    lying = tuple(SimpleNamespace(name=name, length=long, returned=False) for name, long in pairs)
    known = SimpleNamespace(
        lying=lying, states=lying, lengths=np.array([20e-3, 12e-3, 15e-3]), through=np.array(through),
        sure=np.ones(3, bool), margin=np.array([1e-3, -2e-4, -3e-4]), passes=np.ones((3, 1)),
    )  # fmt: skip
    course = SimpleNamespace(
        entry_rows=entered, fates=fates, orientations=out[None], velocities=velocities, end_stations=ended,
        depths=1e-3 * depths,
    )  # fmt: skip
    bowl, shares = SimpleNamespace(devices=(), drive=None), np.array([0.5, 0.3, 0.2])
    return TrialRun(bowl, throw_number=0.8, orientations=known, shares=shares, course=course)


def driven(*velocities):
    return trial([(*one[:3], velocity, *one[4:]) for one, velocity in zip(PARTS, velocities)])


def test_what_leaves_is_weighed_by_the_shares_in_which_orientations_come(monkeypatch):
    """Half of 0.5 leaves as 0; a quarter of 0.5 and half of 0.3 as 1; all of 0.2 as none that is known."""
    found = trial()
    np.testing.assert_allclose(found.leaving_shares, [0.25, 0.275, 0.0, 0.2], rtol=1e-12)
    assert found.main_row == 1 and found.efficiency == pytest.approx(0.275)
    assert found.purity == pytest.approx(0.275 / 0.725)
    assert found.tried_counts.tolist() == [4, 2, 1] and found.jams == 1
    np.testing.assert_allclose(found.depths, [0.3e-3, 0.0, 0.5e-3])
    # (0.125 (0.04 + 0.05 + 0.06 + 0.05) + 0.15 0.02 + 0.2 0.03) / 0.85; it may all roll back
    assert found.velocity == pytest.approx(0.04) and np.isnan(found.roll_back_velocity)
    back = driven(-0.04, -0.05, -0.06, -0.05, -0.02, -0.9, -0.03)
    assert back.velocity == pytest.approx(-0.04) == back.roll_back_velocity and back.parts == 0.0
    assert driven(-0.04, -0.05, 0.06, -0.05, -0.02, -0.9, -0.03).velocity == pytest.approx(0.06)
    # 40 mm/s over a mean of 16.6 mm, of which 0.275 leave; or one a length of what most leave in
    assert trial().parts == pytest.approx(0.275 * 40.0 / 16.6)
    assert trial(lengths=(20e-3, 80e-3, 15e-3)).parts == pytest.approx(0.5)
    # with 10 mm between them, which a camera needs: 149 a minute were told where feeder rate said 68
    monkeypatch.setattr(result.stream, "needed_spacing", lambda *_: 10e-3)
    assert trial().parts == pytest.approx(0.275 * 40.0 / 26.6)
    assert trial([(0, RETURNED, GONE, 0.04, 1, 0.0)]).parts == 0.0


def test_what_was_tried_is_set_beside_the_static_rule(monkeypatch):
    """Of a verdict with 0.25 mm or less to spare nothing is odd; elsewhere 19 of 20 have to hold."""
    monkeypatch.setattr(result, "steady", lambda devices, lying, bowl, margin: np.ones(len(lying), bool))
    found = trial()
    assert found.agreeing_counts.tolist() == [2, 1, 0]  # what is turned has left: it was not returned
    assert found.is_odd.tolist() == [True, False, True] and not found.sorts
    assert found.differs.tolist() == (found.agreeing_counts < 0.95 * found.tried_counts).tolist()
    np.testing.assert_allclose(found.ends[0], [0.150, 0.850], atol=5e-4)  # Wilson, 2 of 4
    kept = [(0, PASSED, 0, 0.04, 1, 0.0)] * 19 + [(1, RETURNED, GONE, 0.04, 1, 0.0)]
    for missed, fine in ((1, True), (2, False)):
        some = trial([*kept, *[(0, RETURNED, GONE, 0.04, 1, 0.0)] * missed])
        assert some.sorts == fine and some.is_odd.any() != fine
    assert not trial([*kept, (2, PASSED, 2, 0.04, 1, 0.0)]).sorts
    kept = [(0, PASSED, 0, 0.04, 1, 0.0)] * 60  # one that stands in the way is no sorting
    assert trial(kept).sorts and trial(kept).jams == 0
    assert not any(trial([*kept, (0, fate, GONE, 0.04, 1, 0.0)]).sorts for fate in (HANGING, STOPPED, STUCK))


@pytest.mark.parametrize("speed", [0.04, -0.04])
def test_a_user_is_told_what_is_odd_what_is_deep_and_that_nothing_travels(speed, monkeypatch):
    monkeypatch.setattr(result, "steady", lambda devices, lying, bowl, margin: np.ones(len(lying), bool))
    odd, deep, *more = trial([(0, RETURNED, GONE, speed, 1, 0.5), (1, RETURNED, GONE, speed, 1, 0.2)]).remarks
    assert odd == "A: 0 of 1 do what the static verdict says (passes, margin 1.00 mm)"
    assert deep.startswith("A: up to 0.5 mm deep in the track or a device")
    assert more == ([] if speed > 0.0 else ["the part does not travel up the track: see feeder convey"])


def test_a_user_is_told_of_a_queue_that_was_deeper_than_its_limit(monkeypatch):
    monkeypatch.setattr(result, "steady", lambda devices, lying, bowl, margin: np.ones(len(lying), bool))
    run = trial([(0, PASSED, 0, 0.04, 1, 0.0)] * 60)
    for deep, told in ((0.99, 0), (1.01, 1)):
        for where in ("depth_in_track", "depth_in_part"):
            depths = {"depth_in_track": 0.0, "depth_in_part": 0.0, where: deep * MAX_QUEUE_DEPTH_M}
            crowd = SimpleNamespace(**depths, depth=max(depths.values()))
            assert sum("deep in each other" in said for said in replace(run, queue=crowd).remarks) == told


@pytest.mark.parametrize("way", [30e-3, 900e-3])
def test_what_creeps_is_followed_to_the_end_and_its_places_are_noted_for_three_times_as_long(way):
    bowl = bowls.default()
    speed = float(answer.answer(bowl).velocity)
    station, lying = SimpleNamespace(begin=0.2, exit=0.2 + way), [SimpleNamespace(length=40e-3)]
    seconds, patience, least, back, interval, places = course.limits_at(bowl, station, lying)
    assert seconds == pytest.approx(way / (0.03 * speed) + 1.0)
    assert patience == pytest.approx(20e-3 / speed) and patience > 0.5 and back == pytest.approx(20e-3)
    assert least == pytest.approx(0.03 * patience * speed)
    periods = interval * bowl.drive.frequency
    assert periods == pytest.approx(round(periods)) and periods >= 1.0
    assert 300 * (interval - 1.0 / bowl.drive.frequency) <= way / speed <= 300 * interval
    assert places * interval >= 3.0 * way / speed


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
