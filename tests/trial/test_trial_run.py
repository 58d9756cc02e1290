"""What a trial says in all, of few parts whose fates are given: each number reckoned by hand."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
import shapes

from feederscrew import bowl as bowls
from feederscrew.studies import trial as studies
from feederscrew.trial.course import PASSED, RETURNED, STOPPED, STUCK, TURNED
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


def test_what_leaves_in_no_known_orientation_is_never_the_wanted_one():
    """Of the first three in four leave askew, a quarter as they came; of the second all as they came."""
    made = run([0, 0, 0, 0, 1], [TURNED, TURNED, TURNED, PASSED, PASSED], out=[-1, -1, -1, 0, 1])
    np.testing.assert_allclose(made.leaving, [0.1875, 0.25, 0.5625], rtol=1e-12)
    assert made.wanted == 1 and made.efficiency == 0.25 and made.purity == 0.25
    askew = run([0, 1], [TURNED, TURNED], out=-1)
    assert askew.wanted is None and askew.efficiency == askew.purity == askew.parts == 0.0


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
