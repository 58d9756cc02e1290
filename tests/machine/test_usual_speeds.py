"""The range of usual speeds is that of makers' strokes, and a design's drive keeps to it."""

from dataclasses import replace

import numpy as np
import pytest

from feederscrew import bowl as bowls
from feederscrew.designing import calm_drive
from feederscrew.machine.drive_sizing import STROKES_M
from feederscrew.motion import conveying
from feederscrew.motion.conveying import answer

ANGLES = np.radians((15.0, 20.0, 25.0, 30.0))


def test_the_greatest_usual_speed_is_that_of_the_strokes_that_makers_state():
    """2.0 mm at 50 Hz, 1.5 at 60, 0.6 at 100, 0.4 at 120: a point mass on a track of 3 deg, friction 0.6."""
    plain, speeds = bowls.default(), {}
    for frequency, stroke in STROKES_M.items():
        drives = [replace(plain.drive, frequency=frequency, amplitude=0.5 * stroke, vibration_angle=angle)
                  for angle in ANGLES]  # fmt: skip
        speeds[frequency] = max(float(answer(replace(plain, drive=drive)).velocity) for drive in drives)
    greatest = max(speeds.values())
    assert greatest == speeds[50.0] and plain.sizing.fastest == pytest.approx(greatest, rel=0.02)
    for chosen in (0.127, 0.146, 0.179, 0.204):  # that designs have chosen
        assert conveying.speed_remark(chosen, plain.sizing) == []
    assert conveying.speed_remark(1.1 * greatest, plain.sizing)


@pytest.mark.parametrize(
    "line", ["track.bank=3 deg", "sizing.fastest=90 mm/s", "machine.controller=frequency"]
)
def test_a_design_takes_no_drive_beyond_the_usual_speeds(line):
    bowl = bowls.record(bowls.settings(None, (line,)))
    plain, rules = calm_drive.PlainBowl(bowl, frozenset((line.partition("=")[0],))), bowl.sizing
    for velocity in (0.001, 0.08, np.inf):
        made = calm_drive.drive_at(plain, velocity, hops=True)
        assert conveying.speed_remark(calm_drive.speed(made), rules) == []
    fastest = calm_drive.speed(calm_drive.drive_at(plain, np.inf, hops=True))
    assert fastest > 0.8 * rules.fastest  # and none is slower for it than need be


def test_a_stroke_that_the_user_gave_is_kept_at_any_speed():
    lines = ("sizing.fastest=30 mm/s", "drive.peak_to_peak=1.4 mm")
    bowl = bowls.record(bowls.settings(None, lines))
    plain = calm_drive.PlainBowl(bowl, frozenset(line.partition("=")[0] for line in lines))
    made = calm_drive.drive_at(plain, 0.05)
    assert made.drive.amplitude == pytest.approx(0.7e-3) and calm_drive.speed(made) > 0.03
