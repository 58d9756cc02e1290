"""What is wrong with a machine whose stroke is not the one it was drawn for."""

import re
from types import SimpleNamespace

import numpy as np
import pytest
from two_masses import GIVEN

from feederscrew import bowl as bowls
from feederscrew.machine import condition

DRIVE, DRAWN, FULL = 100.0, 105.0, 104.0  # [Hz] the drive, and the empty and the full machine's own
FILLED, STROKES = np.array([1.0, 0.0]), np.array([0.8, 1.0])
STROKE = 0.4e-3  # [m] of the empty machine, peak to peak; 0.8 of it of the full one
PEAK = 0.5 * STROKE * (2.0 * np.pi * DRIVE) ** 2  # [m/s2]


def causes(natural=(FULL, DRAWN), **values):
    sheet = SimpleNamespace(
        bowl=bowls.read(None, (*GIVEN, "machine.damping=0.001", f"drive.frequency={DRIVE} Hz")),
        emptying=SimpleNamespace(levels=FILLED, strokes=STROKES, natural_frequencies=np.array(natural)),
        stroke=SimpleNamespace(peak_to_peak=STROKE, acceleration=PEAK, frequency=DRIVE, angle=np.pi / 9.0),
    )
    return condition.diagnose(sheet, values).causes


def own(natural, ratio):
    """Above and below the drive at so many times the stroke, |1 / (1 - q^2)| of the force's at rest."""
    g = ratio / (1.0 - (DRIVE / natural) ** 2)
    return DRIVE / np.sqrt(1.0 - 1.0 / g), DRIVE / np.sqrt(1.0 + 1.0 / g)


def hertz(said):
    return [float(one) for one in re.findall(r"([\d.]+) Hz", said)]


@pytest.mark.parametrize("fill, natural, full", [(0.0, DRAWN, 1.0), (0.5, 104.5, 0.9), (1.0, FULL, 0.8)])
def test_too_small_a_stroke_is_that_of_a_stiffer_machine_or_of_one_below_the_drive(fill, natural, full):
    """Too many leaves lift the natural frequency farther above the drive; a broken one drops it below."""
    stiff, soft = own(natural, 0.6)
    many, broken, weak = causes(stroke=0.6 * full * STROKE, fill=fill)
    assert many.endswith("too many leaves, or a lighter bowl - take a leaf off")
    assert "a leaf is broken or loose" in broken and "60 % of its setting" in weak
    assert hertz(many) == pytest.approx([stiff, natural], rel=1e-3) and stiff > natural
    assert hertz(broken) == pytest.approx([soft], rel=1e-3) and soft < DRIVE


def test_too_large_a_stroke_is_that_of_a_machine_nearer_to_the_drive():
    stiff, _ = own(DRAWN, 1.5)
    missing, high = causes(stroke=1.5 * STROKE)
    assert "a leaf is missing, or the bowl is heavier - add a leaf" in missing
    assert hertz(missing) == pytest.approx([stiff, DRAWN], rel=1e-3) and DRIVE < stiff < DRAWN
    assert "set 50 % too high" in high


@pytest.mark.parametrize(("ratio", "said"), [
    (1.5, "too many leaves, or a lighter bowl - take a leaf off before"),
    (0.6, "a leaf is broken or loose"),
])  # fmt: skip
def test_of_a_machine_below_the_drive_more_leaves_bring_it_nearer(ratio, said):
    """Drawn for 95 Hz at a drive of 100 Hz: what is stiffer moves more, what is softer less."""
    first, *others = causes((94.0, 95.0), stroke=ratio * STROKE)
    now = DRIVE / np.sqrt(1.0 + abs(1.0 - (DRIVE / 95.0) ** 2) / ratio)
    assert said in first and hertz(first) == pytest.approx([now, 95.0], rel=1e-3)
    assert (now > 95.0) == (ratio > 1.0)
    assert all(one.startswith("or ") for one in others) and not first.startswith("or ")


@pytest.mark.parametrize(("share", "said"), [
    (np.cos(np.radians(20.0)), "does what it should"),  # 0.94: within what it is told by
    (np.sin(np.radians(20.0)), "the accelerometer stands upright, not along the motion"),
    (0.25, "only one half-wave pulls"),
    (4.0, "both half-waves pull"),
    (1.44, "the drive runs at 120 Hz, not at 100 Hz"),
])  # fmt: skip
def test_acceleration_over_stroke_is_the_square_of_the_frequency(share, said):
    assert said in causes(stroke=STROKE, acceleration=share * PEAK)[0]
    high = f"the controller is set {100.0 * 399.0:.0f} % too high - turn it down"
    assert causes(stroke=400.0 * STROKE) == (high,)  # which no tuning explains
