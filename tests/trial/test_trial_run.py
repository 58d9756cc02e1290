"""What a trial says in all, of few parts whose fates are given: each number reckoned by hand."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
import shapes

from feederscrew import bowl as bowls
from feederscrew.studies import trial as studies
from feederscrew.trial.course import HANGING, PASSED, RETURNED, ROLLED_BACK, STOPPED, STUCK, TURNED
from feederscrew.trial.result import TrialRun

SHARES, LENGTHS = np.array([0.75, 0.25]), np.array([0.02, 0.04])


def run(entered, fates, *, velocities=None, ended=None, out=None):
    """Parts of two orientations, offered as 3 to 1 and 20 and 40 mm long, on a track with one device."""
    entered, fates = np.array(entered), np.array(fates)
    leave = np.where(fates <= TURNED, entered if out is None else out, -2)
    seen = SimpleNamespace(
        entered=entered,
        fates=fates,
        velocities=np.full(len(fates), 0.06) if velocities is None else np.array(velocities),
        ended=np.ones(len(fates), int) if ended is None else np.array(ended),
        orientations=np.array([entered, entered, leave]),
    )
    lying = tuple(SimpleNamespace(length=length) for length in LENGTHS)
    known = SimpleNamespace(lying=lying, states=lying, lengths=LENGTHS)
    return TrialRun(bowls.default(), 0.5, known, SHARES, seen)


def test_the_velocity_is_that_of_parts_that_travel_up_beside_those_that_roll_back():
    """The first orientation travels at 40 mm/s, a third of the second at 80, the rest of it rolls back."""
    made = run([0, 0, 1, 1, 1], [PASSED] * 2 + [PASSED, ROLLED_BACK, ROLLED_BACK],
               velocities=[0.03, 0.05, 0.08, -0.02, -0.04])  # fmt: skip
    up = (0.75 * 0.04 + 0.25 / 3.0 * 0.08) / (0.75 + 0.25 / 3.0)
    assert made.velocity == pytest.approx(up, rel=1e-12)
    assert made.rolling_back == pytest.approx(-0.03, rel=1e-12)
    back = run([0, 1], [ROLLED_BACK] * 2, velocities=[-0.01, -0.05])
    assert back.velocity == back.rolling_back == pytest.approx(-0.02, rel=1e-12)


@pytest.mark.parametrize(
    ("fate", "ended", "counts"),
    [
        (STOPPED, 0, False),  # it sticks on the bare track
        (STUCK, 0, False),
        (STOPPED, 1, True),  # it came to the device, as fast as the bare track brought it
        (STUCK, 1, True),
        (RETURNED, 0, True),
        (PASSED, 2, True),
    ],
)
def test_what_sticks_on_the_bare_track_is_left_out_of_the_velocity(fate, ended, counts):
    made = run([0, 0], [PASSED, fate], velocities=[0.06, 0.02], ended=[2, ended])
    assert made.velocity == pytest.approx(0.04 if counts else 0.06, rel=1e-12)


def test_parts_come_one_behind_the_other_and_leave_as_the_efficiency_says():
    """Of parts 25 mm long in the mean 60 mm/s bring 2.4 a second."""
    made = run([0, 0, 1, 1], [PASSED, PASSED, RETURNED, RETURNED])
    assert made.efficiency == 0.75
    assert made.parts == pytest.approx(0.75 * 0.06 / 0.025, rel=1e-12)
    assert run([0, 0, 1, 1], [RETURNED] * 4).parts == 0.0


def test_what_leaves_in_no_known_orientation_is_never_the_wanted_one():
    """Of the first three in four leave askew, a quarter as they came; of the second all as they came."""
    made = run([0, 0, 0, 0, 1], [TURNED, TURNED, TURNED, PASSED, PASSED], out=[-1, -1, -1, 0, 1])
    np.testing.assert_allclose(made.leaving, [0.1875, 0.25, 0.5625], rtol=1e-12)
    assert made.wanted == 1 and made.efficiency == 0.25 and made.purity == 0.25
    askew = run([0, 1], [TURNED, TURNED], out=-1)
    assert askew.wanted is None and askew.efficiency == askew.purity == askew.parts == 0.0


def test_no_more_parts_leave_than_lie_one_behind_the_other():
    """All leave as the second, 40 mm long: 1.5 a second however many come."""
    made = run([0, 0, 1, 1], [TURNED, TURNED, PASSED, PASSED], out=1)
    assert made.wanted == 1 and made.efficiency == 1.0
    assert made.parts == pytest.approx(0.06 / 0.04, rel=1e-12)


@pytest.mark.parametrize(
    ("fate", "jams"),
    [(PASSED, 0), (TURNED, 0), (RETURNED, 0), (HANGING, 1), (STOPPED, 1), (ROLLED_BACK, 0), (STUCK, 1)],
)
def test_what_hangs_stops_or_sticks_jams(fate, jams):
    assert run([0, 1], [PASSED, fate]).jams == jams


def test_what_should_pass_the_bare_track_and_does_not_is_odd_though_no_margin_is_told():
    bowl = bowls.read(None, ["track.width=60 mm"])
    seen = studies.trial(shapes.part(shapes.box(20, 12, 5)), [bowl], "A", parts=4, seed=1).runs[0]
    tried = seen.tried > 0
    assert seen.predicted[tried].all() and seen.sure[tried].all() and np.isnan(seen.margin[tried]).all()
    assert not seen.odd.any()
    lost = replace(seen, course=replace(seen.course, fates=np.full(4, RETURNED)))
    np.testing.assert_array_equal(lost.odd, tried)
    (first, *_) = lost.remarks
    assert first.endswith(f"0 of {seen.tried[tried][0]} do what the static verdict says (passes)")
