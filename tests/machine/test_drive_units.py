"""Usual drive units: what their bowl files say, and what a design makes of them."""

from dataclasses import replace

import numpy as np
import pytest

from feederscrew import bowl as bowls
from feederscrew.bowl.reading import settings_of_text
from feederscrew.designing import calm_drive
from feederscrew.dropping.plate_test import throw_number
from feederscrew.errors import ArgumentError
from feederscrew.machine import drive_sizing
from feederscrew.machine.drive_sizing import can_make
from feederscrew.machine.springs import analyse_springs, greatest_amplitude

# makers' strokes peak to peak [mm], as the key sizing.greatest_acceleration names them
STROKES = {50.0: 2.0, 60.0: 1.5, 100.0: 0.6, 120.0: 0.4}


@pytest.mark.parametrize("unit", drive_sizing.DRIVE_UNITS, ids=lambda one: one.name)
def test_the_bowl_file_of_a_drive_unit_is_a_tuned_machine(unit):
    bowl = bowls.record(settings_of_text(drive_sizing.bowl_file(unit), "bowl.yaml"))
    assert bowl.drive.frequency == unit.frequency in STROKES
    assert 2.0 * bowl.track.radius == pytest.approx(unit.diameter)
    assert can_make(bowl) is None
    assert 15.0 < np.degrees(bowl.drive.vibration_angle) < 25.0
    assert np.degrees(bowl.machine.spring_angle) == pytest.approx(30.0)
    assert 1.03 <= analyse_springs(bowl.machine).natural_frequency / unit.frequency <= 1.08
    assert bowl.machine.leaves <= 12
    assert 2e3 * greatest_amplitude(bowl) == pytest.approx(STROKES[unit.frequency], rel=1e-6)
    assert bowl.sizing.mains_frequency == unit.mains
    assert bowl.machine.base_mass > 3.0 * bowl.machine.bowl_mass


def owned(name, *overrides):
    """A bowl on a drive unit, and which keys its file gives."""
    listed = settings_of_text(drive_sizing.bowl_file(drive_sizing.unit(name)), "bowl.yaml")
    given = {one.key.name for one in listed if one.is_own}
    bowl = bowls.adjust(bowls.record(listed), overrides) if overrides else bowls.record(listed)
    return calm_drive.PlainBowl(bowl, frozenset(given), None)


@pytest.mark.parametrize(("name", "frequency"), [("d300-100hz", 100.0), ("d300-60hz", 60.0)])
def test_a_design_keeps_an_owned_machine_and_looks_for_its_stroke(name, frequency):
    made = owned(name)
    slow, fast = (calm_drive.driven(made, velocity) for velocity in (0.05, 0.08))
    for bowl in (slow, fast):
        assert bowl.drive.frequency == frequency
        assert bowl.drive.vibration_angle == pytest.approx(made.bowl.drive.vibration_angle)
    assert 1.0 < throw_number(slow) < throw_number(fast)
    assert calm_drive.speed(fast) >= 0.08
    strongest = calm_drive.driven(made, np.inf)
    assert strongest.drive.amplitude <= greatest_amplitude(made.bowl)


def test_a_frequency_controller_runs_an_owned_machine_below_its_natural_frequency():
    made = owned("d300-100hz")
    bowl = replace(made.bowl, sizing=replace(made.bowl.sizing, control="frequency"))
    driven = calm_drive.driven(replace(made, bowl=bowl), 0.06)
    natural = analyse_springs(made.bowl.machine).natural_frequency
    assert natural / driven.drive.frequency == pytest.approx(1.055, abs=1e-3)


def test_each_drive_unit_has_a_line_and_a_name_of_its_own():
    names = [one.name for one in drive_sizing.DRIVE_UNITS]
    assert len(set(names)) == len(names) == len(drive_sizing.lines()) >= 6
    for one, line in zip(drive_sizing.DRIVE_UNITS, drive_sizing.lines(), strict=True):
        assert line.startswith(one.name) and f"{one.frequency:.0f} Hz" in line
        assert "typical, not from a data sheet" in line


def test_an_unknown_drive_unit_is_refused():
    assert drive_sizing.unit("D300-50Hz").frequency == 50.0
    with pytest.raises(ArgumentError, match="d300-100hz"):
        drive_sizing.unit("d301")
