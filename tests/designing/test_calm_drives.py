"""Drives of a design: leaf springs first, the calmest that is fast enough, at any friction."""

import itertools
from dataclasses import replace

import numpy as np
import pytest

from feederscrew import bowl as bowls
from feederscrew.arrivals.plate_test import throw_number
from feederscrew.base.errors import ArgumentError
from feederscrew.designing import calm_drive
from feederscrew.designing.calm_drive import DriveKind
from feederscrew.designing.record import DesignRequest
from feederscrew.machine.springs import greatest_amplitude
from feederscrew.motion.hop import hop


def plain(*overrides, drive=DriveKind.LEAF_SPRING):
    given = frozenset(one.partition("=")[0] for one in overrides)
    bowl = bowls.record(bowls.settings(None, overrides or ("track.bank=3 deg",)))
    return calm_drive.PlainBowl(bowl, given, drive)


@pytest.mark.parametrize(("velocity", "frequency"), [(0.0, None), (0.08, 100.0), (0.14, None), (0.2, 50.0)])
def test_a_leaf_spring_drive_is_fast_enough_at_any_friction(velocity, frequency):
    """A point mass makes 145 mm/s at 100 Hz, 15 deg and throw number 3.0, and twice that at 50 Hz."""
    made = calm_drive.drive_at(plain(), velocity)
    asked = max(velocity, calm_drive.LEAST_VELOCITY_M_S)
    assert made.drive.phase == 0.0 and made.drive.frequency in (50.0, 100.0)
    if frequency is not None:
        assert made.drive.frequency == frequency and (hop(made).height > 0.1e-3) == (frequency == 50.0)
    assert 14.9 < np.degrees(made.drive.vibration_angle) < 30.1 and throw_number(made) <= 3.0 + 1e-3
    assert made.drive.amplitude <= greatest_amplitude(made)
    weaker = replace(made, drive=replace(made.drive, amplitude=0.9 * made.drive.amplitude))
    assert calm_drive.speed(made) >= asked > calm_drive.slowest(weaker)
    assert calm_drive.slowest(made) >= calm_drive.LEAST_VELOCITY_KEPT * asked


def test_the_slower_the_more_friction_matters_and_a_part_without_tooling_may_creep():
    """At 50 Hz, 25 deg and throw number 0.9 a point mass makes 27 mm/s; 10 mm/s at 0.6 of the friction."""
    made, fast, slow = (calm_drive.drive_at(plain(), velocity, hops=True) for velocity in (0.025, 0.1, 0.012))
    assert calm_drive.slowest(made) >= calm_drive.LEAST_VELOCITY_KEPT * 0.025 and throw_number(made) > 1.0
    assert throw_number(fast) > 2.0 and throw_number(slow) <= calm_drive.CALM_THROW_NUMBER
    assert calm_drive.velocity_kept(fast) > 0.9 and calm_drive.velocity_kept(slow) < 0.75
    calm, through = (calm_drive.drive_at(plain(), 0.01, hops=hops) for hops in (True, False))
    assert throw_number(calm) <= calm_drive.CALM_THROW_NUMBER
    assert calm_drive.speed(through) >= calm_drive.LEAST_VELOCITY_M_S


@pytest.mark.parametrize("velocity", (0.05, 0.1, 0.15))
def test_no_drive_of_a_lower_hop_is_fast_enough(velocity):
    """Against every leaf-spring drive at the mains, on a finer grid of throw numbers."""
    made = calm_drive.drive_at(plain(), velocity)
    for frequency in (50.0, 100.0):
        for angle in np.radians((15.0, 20.0, 25.0, 30.0)):
            for throw in np.arange(1.1, 3.01, 0.2):
                drive = replace(made.drive, frequency=frequency, vibration_angle=angle)
                other = replace(made, drive=drive)
                other = calm_drive.with_amplitude(other, drive.amplitude * throw / throw_number(other))
                kept = calm_drive.slowest(other) / calm_drive.LEAST_VELOCITY_KEPT
                enough = min(calm_drive.speed(other), kept)
                assert enough < velocity or hop(other).height > 0.8 * hop(made).height


def test_what_the_user_says_of_drive_mains_controller_or_machine_is_kept():
    mains, free = "machine.mains=60 Hz", "machine.controller=frequency"  # which takes the lowest hop
    for line, velocity, frequency in ((mains, 0.08, 120.0), (mains, 0.2, 60.0), (free, 0.06, 140.0)):
        made = calm_drive.drive_at(plain(line), velocity)
        assert made.drive.frequency == frequency
    assert hop(made).height < hop(calm_drive.drive_at(plain(), 0.06)).height
    owned = plain("drive.amplitude=0.52 mm", "drive.frequency=50 Hz", "drive.vibration_angle=20 deg")
    assert calm_drive.drive_at(owned, 0.3) == owned.bowl and calm_drive.find_calmer(owned, owned.bowl) is None
    made = calm_drive.drive_at(plain("drive.frequency=80 Hz"), 0.1)
    assert made.drive.frequency == 80.0 and throw_number(made) > 1.5
    made = calm_drive.drive_at(plain("drive.vibration_angle=28 deg"), 0.06)
    assert np.degrees(made.drive.vibration_angle) == pytest.approx(28.0)
    made = calm_drive.drive_at(plain("drive.amplitude=0.2 mm"), 0.06)
    assert made.drive.amplitude == 0.2e-3 and made.drive.frequency == 100.0  # the rest is looked for
    machine = ("machine.supply=60 Hz half wave", "machine.spring_angle=25 deg", "machine.spring_radius=90 mm")
    made = calm_drive.drive_at(plain(*machine), 0.1)
    assert made.drive.frequency == 60.0
    assert np.degrees(made.drive.vibration_angle) == pytest.approx(13.2, abs=1.5)


def test_two_magnets_only_where_they_are_asked_for():
    given, owned = plain("drive.phase=-60 deg"), plain("drive.phase=0 deg", drive=DriveKind.TWO_AXIS)
    leaves, two = plain(drive=DriveKind.ANY), plain(drive=DriveKind.TWO_AXIS)
    for bowl, phase in ((leaves, 0.0), (two, -60.0), (given, -60.0), (owned, 0.0)):
        assert np.degrees(calm_drive.drive_at(bowl, 0.1).drive.phase) == pytest.approx(phase)
    made = calm_drive.drive_at(two, 0.1)
    assert throw_number(made) <= calm_drive.CALM_THROW_NUMBER + 1e-3
    assert calm_drive.slowest(made) > 0.8 * calm_drive.speed(made)
    with pytest.raises(ArgumentError, match="leaf-spring or two-axis or any"):
        DesignRequest(1.0, drive="hydraulic")
    for drive in DriveKind:  # where none is fast enough the fastest is taken
        fastest, fast = (calm_drive.speed(calm_drive.drive_at(plain(drive=drive), v)) for v in (9.0, 0.14))
        assert fastest > 0.14 and fastest >= fast


def test_a_calmer_drive_hops_half_as_high_until_it_does_not_hop_and_a_livelier_one_much_higher():
    bowl, heights = calm_drive.drive_at(plain(), 0.2), []
    while bowl is not None:
        heights.append(hop(bowl).height)
        bowl = calm_drive.find_calmer(plain(), bowl)
    assert len(heights) > 3 and heights[-1] == 0.0
    assert all(low <= calm_drive.CALMER_HOP * high for high, low in itertools.pairwise(heights))
    made = plain(drive=DriveKind.TWO_AXIS)
    first = calm_drive.drive_at(made, 0.14)
    second = calm_drive.find_calmer(made, first)
    assert throw_number(second) <= calm_drive.CALM_THROW_NUMBER + 1e-3
    assert calm_drive.LEAST_VELOCITY_M_S <= calm_drive.speed(second) < 0.75 * calm_drive.speed(first)
    calm = calm_drive.drive_at(plain(), 0.05)
    lively = calm_drive.find_livelier(plain(), calm)
    assert 1.0 <= hop(lively).height / (calm_drive.LIVELIER_HOP * hop(calm).height) < 2.0
    assert calm_drive.find_livelier(plain("drive.amplitude=0.2 mm"), calm) is None
