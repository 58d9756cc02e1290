"""The best phase of an elliptical drive: where it lies, what it gains, how little friction then matters."""

from dataclasses import replace

import numpy as np
import pytest

from feederscrew import bowl as bowls
from feederscrew.conveying import answer
from feederscrew.errors import ConfigError

DEG = np.pi / 180.0


def at_the_hop(friction, angle, *overrides):
    """A level track, driven at the throw number 1."""
    rise = 9.81 / (2.0 * np.pi * 50.0) ** 2 * (1 - 1e-9)
    drive = f"drive.amplitude={float(rise / np.sin(angle * DEG)) * 1e3!r} mm", "drive.frequency=50 Hz"
    track = "track.climb=0 deg", "restitution=0", f"friction.static={friction}", "gravity=9.81 m/s2"
    return bowls.read(None, (*drive, f"drive.vibration_angle={float(angle)!r} deg", *track, *overrides))


def share(bowl, velocity):
    """Of the plate's greatest speed along the track."""
    return velocity / (answer.greatest_speed(bowl) * np.cos(bowl.drive.vibration_angle))


@pytest.mark.parametrize(
    ("coupling", "want"), [(0.035, -80), (0.088, -65), (0.12, -60), (0.18, -45), (0.29, -20), (0.46, 0)]
)
def test_best_phase_depends_on_friction_times_angle(coupling, want):
    bowl = at_the_hop(0.3, np.degrees(np.arctan(coupling / 0.3)))
    found = answer.best_phase(bowl)
    assert np.degrees(found.phase) == pytest.approx(want, abs=2.6)  # to the next 5 deg
    assert 0.57 < share(bowl, found.velocity) < 0.674
    assert found.lowest <= found.phase <= found.highest


def test_at_its_best_phase_the_velocity_hardly_depends_on_friction_and_angle():
    best, straight = [], []
    for friction in (0.2, 0.8):
        for angle in (10, 30):
            bowl = at_the_hop(friction, angle)
            found = answer.best_phase(bowl)
            best.append(share(bowl, found.velocity))
            straight.append(share(bowl, found.straight))
    assert (min(best), max(best)) == pytest.approx((0.577, 0.673), abs=2e-3)
    assert (min(straight), max(straight)) == pytest.approx((0.08, 0.58), abs=6e-3)


def test_it_is_the_greatest_of_all_answers():
    bowl = at_the_hop(0.3, 20, "track.climb=3 deg", "drive.phase=40 deg")  # its own phase does not matter
    found = answer.best_phase(bowl)
    at = [
        answer.answer(answer.with_phase(bowl, x)).velocity for x in (found.phase, 0.0, found.phase + 2 * DEG)
    ]
    assert found.velocity == pytest.approx(at[0], rel=1e-9)
    assert found.straight == pytest.approx(at[1], rel=1e-9)
    assert found.velocity >= at[2]
    assert found.cells["velocity"].max() <= found.velocity
    edges = [answer.answer(answer.with_phase(bowl, x)).velocity for x in (found.lowest, found.highest)]
    assert min(edges) >= 0.9 * found.velocity
    assert list(found.frictions) == list(answer.FRICTION_FACTORS)
    assert found.best_over_friction[2] == pytest.approx(found.velocity)
    lower = answer.answer(answer.scaled(answer.with_phase(bowl, found.phase), friction=0.5)).velocity
    assert found.best_over_friction[0] == pytest.approx(lower, rel=1e-9)


def test_no_phase_helps_on_a_climb_that_is_too_steep():
    bowl = at_the_hop(0.3, 20)
    steep = replace(bowl, track=replace(bowl.track, climb=30 * DEG))
    with pytest.raises(ConfigError) as caught:
        answer.best_phase(steep)
    assert str(caught.value) == (
        "drive.phase: has no steady velocity at any value: the part slides down the track without stopping"
        " - lower track.climb, or raise the friction"
    )
