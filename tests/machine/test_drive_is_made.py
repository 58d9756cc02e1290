"""The machine that is drawn makes the drive that was tried, or every paper says that it does not."""

from dataclasses import replace

import awkward
import numpy as np
import pytest
import shapes
from design_counts import proved

from feederscrew import bowl as bowls
from feederscrew.bowl.reading import settings_of_text
from feederscrew.bowl.record import shares, vibration_angle
from feederscrew.conveying import answer
from feederscrew.designing import calm_drive, design
from feederscrew.dropping.plate_test import throw_number
from feederscrew.errors import ArgumentError
from feederscrew.machine import drive_sizing, sizing, springs
from feederscrew.machine.drive_sizing import can_make
from feederscrew.machine.springs import analyse_springs, greatest_amplitude, leaf_stress, stroke
from feederscrew.output import bowl_sheet, design_pages, designs, machine_figures
from feederscrew.output import machine as machine_output
from feederscrew.resting.aspects import find
from feederscrew.studies import bowl as machines

STEEL_PART = shapes.part(shapes.box(12.0, 10.0, 8.0))
ABS = 1050.0  # [kg/m3]
PART = replace(
    STEEL_PART, density=ABS, mass=ABS * STEEL_PART.volume, inertia=ABS / shapes.STEEL * STEEL_PART.inertia
)


ONE = ("track.radius=150 mm", "track.climb=3.5 deg", "track.width=14 mm", "drive.frequency=50 Hz")


def sized(bowl):
    """A size for a bowl of 300 mm."""
    rise = np.pi * 0.3 * np.tan(bowl.track.climb)
    return sizing.Size(0.3, {}, 0.014, 1e-3, 1e-3, bowl.track.climb, 0.09, 0.09 / rise, rise)


def at_track(machine):
    return np.degrees(float(vibration_angle(machine, 0.15, np.radians(3.5))))


@pytest.mark.parametrize("wanted", [10.0, 14.0, 16.0, 20.0, 25.0, 30.0, 37.0])
def test_springs_are_moved_outwards_and_then_stood_up_until_they_make_the_angle(wanted):
    """25 deg at 150 mm are 42 deg at 90 mm, which nobody builds: a larger circle needs 33."""
    bowl = bowls.read(None, (*ONE, f"drive.vibration_angle={wanted} deg"))
    made = drive_sizing.machine_for(bowl, sized(bowl), set(), exact=True)
    assert at_track(made) == pytest.approx(wanted, abs=0.1)
    assert made.spring_radius + 0.5 * made.leaf_width <= 0.15 + 1e-9
    assert made.spring_angle <= bowl.sizing.steepest_spring_angle + 1e-9
    rise, turn = shares(made)
    by_hand = np.arctan(np.tan(made.spring_angle) * made.spring_radius / 0.15 * rise / turn)
    assert np.degrees(by_hand) == pytest.approx(wanted + 3.5, abs=0.1)
    if wanted == 14.0:  # a usual angle keeps the usual circle
        assert made.spring_radius == pytest.approx(0.09, rel=0.03)
        assert made.spring_angle < bowl.sizing.greatest_spring_angle


@pytest.mark.parametrize("kept", ["spring_angle", "spring_radius"])
def test_what_the_user_gave_of_the_springs_stays(kept):
    bowl = bowls.read(None, (*ONE, "drive.vibration_angle=20 deg", "machine.spring_angle=28 deg"))
    made = drive_sizing.machine_for(bowl, sized(bowl), {kept}, exact=True)
    assert getattr(made, kept) == getattr(bowl.machine, kept)
    assert at_track(made) == pytest.approx(20.0, abs=0.1)


def test_springs_too_near_make_less_and_both_drives_are_told():
    """The angle of 25 deg that springs of 30 deg at 90 mm make is 15.61 deg: throw number 1.15, not 1.80."""
    settings = bowls.settings(
        None,
        (*ONE, "drive.vibration_angle=25 deg", "drive.amplitude=0.425 mm", "machine.spring_radius=90 mm",
         "machine.spring_angle=30 deg", "machine.bowl_mass=6 kg", "machine.base_mass=25.2 kg",
         "machine.bowl_inertia=0.06 kg m2", "machine.base_inertia=0.252 kg m2"),
    )  # fmt: skip
    bowl = bowls.record(settings)
    other = drive_sizing.can_make(bowl)
    assert other is not None and other.other_angle and not other.two_axis
    assert np.degrees(other.machine.track_angle) == pytest.approx(15.61, abs=0.01)
    assert np.degrees(other.wanted.spring_angle) == pytest.approx(42.0, abs=0.3)
    ratio = other.machine.throw_number / other.wanted.throw_number
    assert ratio == pytest.approx(np.sin(np.radians(15.61)) / np.sin(np.radians(25.0)), rel=1e-3)
    plain = replace(bowl, drive=replace(bowl.drive, vibration_angle=np.radians(15.61)))
    assert other.machine.velocity == pytest.approx(answer.answer(plain).velocity, rel=0.01)
    sheet = machines.machine(settings)
    first = machine_output.summary(sheet)["value"][:2]
    assert "42" in first[0] and "15.6" in first[1]
    document = machine_output.document(sheet)
    assert "15.6 deg to the track" in document["warnings"][0]
    assert not document["springs_make_this_drive"]
    assert document["drive_of_the_springs"]["throw_number"] == pytest.approx(other.machine.throw_number)


@pytest.fixture(scope="module")
def two_axis():
    phased = ("drive.vibration_angle=16 deg", "drive.phase=-60 deg", "drive.amplitude=0.322 mm")
    one = proved(PART, bowls.read(None, (*ONE, *phased)))
    built = design.built(one, ())
    return design.with_machine(one, built), built


def test_a_drive_out_of_phase_stands_first_in_every_output(two_axis):
    study, built = two_axis
    sheet = built.sheet
    rows, table, document = machine_output.summary(sheet), designs.summary(study), designs.document(study)
    assert (rows["quantity"][0], table["quantity"][1]) == ("drive", "drive")
    assert "-60 deg" in rows["value"][0] and "phase -60 deg" in table["value"][1]
    own = machine_output.document(sheet)
    assert (own["drive_kind"], own["phase_deg"]) == ("two-axis drive", pytest.approx(-60.0))
    assert document["bowl"]["phase_deg"] == pytest.approx(-60.0)
    assert any("phase" in text.get_text() for text in machine_figures.bowl(sheet).texts)
    for text in (
        rows["value"][0],
        *[line for line in document["warnings"] if "magnets" in line][:1],
        "\n".join(bowl_sheet.draw_sheets(built.drawn).texts(0)),
        design_pages.page(study, built).partition("leaves as")[0],
        designs.bowl_file(study, (), sheet).splitlines()[1],
    ):
        assert "two magnets" in text
    assert any("two magnets" in line for line in document["warnings"])


def test_a_bowl_of_the_library_has_the_machine_of_the_command():
    """Every number of a bowl as settings again, machine and sizing among them."""
    bowl = replace(awkward.bowl("machine.leaves=7", "sizing.sheet=2.5 mm", "track.hand=left"), devices=())
    again = bowls.record(design.settings_of(bowl, {"drive.vibration_angle"}))
    for name in ("drive", "friction", "track", "machine", "sizing"):
        for field, value in vars(getattr(bowl, name)).items():
            told = getattr(getattr(again, name), field)
            assert told == (pytest.approx(value, rel=1e-9) if isinstance(value, float) else value), field


def test_a_design_is_filled_with_its_part_and_tuned_at_the_stroke_that_was_tried(two_axis):
    """A block of ABS of 1.05 g/cm3, half of it air between: not solid steel."""
    study, built = two_axis
    sheet, fill, rules = built.sheet, built.sheet.fill, built.sheet.bowl.sizing
    assert fill.mass / fill.volume == pytest.approx(0.5 * ABS, rel=1e-6)
    assert fill.volume == pytest.approx(np.pi * 0.15**2 * sheet.depth * 0.3333, rel=1e-6)
    assert rules.least_detuning <= sheet.detuning <= rules.greatest_detuning
    assert sheet.stress <= rules.fatigue_stress
    assert sheet.stroke.peak_to_peak == pytest.approx(2.0 * study.bowl.drive.amplitude)


@pytest.mark.parametrize(
    ("texts", "density", "said"),
    [((), 7850.0, "steel assumed"), (("sizing.fill_density=1.05 g/cm3",), ABS, "fill_density")],
)
def test_a_bowl_without_a_part_says_what_it_assumes(texts, density, said):
    sheet = machines.machine(bowls.settings(None, (*ONE, *texts)))
    assert sheet.fill.mass / sheet.fill.volume == pytest.approx(0.5 * density)
    rows = machine_output.summary(sheet)
    assert said in dict(zip(rows["quantity"], rows["value"]))["full bowl [kg]"]


def test_longer_leaves_where_none_of_the_usual_length_tunes_a_slow_drive():
    """At 14 Hz a light bowl on leaves of 40 x 80 mm is far above the drive: no force would move it."""
    light = bowls.read(None, ("machine.bowl_mass=1.5 kg", "machine.bowl_inertia=0.008 kg m2"))
    bowl = replace(light, drive=replace(light.drive, frequency=14.0, amplitude=1e-3))
    at_springs = stroke(bowl).springs
    assert not springs.tuned_leaf_sets(bowl.machine, 14.0, at_springs, bowl.sizing)
    made = drive_sizing.on_leaves(bowl, ())
    assert made.leaf_length > bowl.machine.leaf_length
    assert 1.03 <= analyse_springs(made).natural_frequency / 14.0 <= 1.08
    assert leaf_stress(made, at_springs) <= bowl.sizing.fatigue_stress
    assert drive_sizing.on_leaves(bowl, {"leaf_length"}) == bowl.machine


def test_a_design_whose_drawn_springs_do_not_make_its_angle_does_not_hold():
    steep = (*ONE, "drive.vibration_angle=50 deg", "drive.amplitude=0.15 mm")
    one = proved(PART, bowls.read(None, steep))
    assert one.status == "holds"
    settings = bowls.settings(None, steep)
    found = design.with_machine(one, design.Built(machines.machine(settings)))
    assert found.status == "falls short" and "the springs make it" in found.why
    assert found.cause == "drive" and found.nearest.rate == one.request.target
    assert "springs that stand at" in found.nearest.change and found.nearest.draws_held == 20


@pytest.mark.parametrize("name", [None, "d300-60hz"])
def test_the_machine_that_is_drawn_makes_the_drive_that_is_chosen(name):
    """Angle, tuning, stress and pull with the mass of the solid; the leaves of an owned machine are kept."""
    settings = bowls.settings(None) if name is None else unit_settings(name)
    given = frozenset(one.key.name for one in settings if one.is_own)
    bowl = calm_drive.driven(calm_drive.section(PART, find(PART), bowls.record(settings), given), 0.08)
    study = proved(PART, bowl)
    built = design.built(study, settings)
    made = design.with_machine(study, built)
    assert made.drive_mismatch is None and made.machine_lacks == () and made.status == "holds"
    under = made.bowl.machine
    assert 1.03 <= analyse_springs(under).natural_frequency / bowl.drive.frequency <= 1.08
    assert under.leaves <= 18 and 1e-3 <= under.leaf_thickness <= 4e-3
    assert leaf_stress(under, stroke(made.bowl).springs) <= bowl.sizing.fatigue_stress
    if name is not None:
        own = bowls.record(settings).machine
        for word in ("leaves", "leaf_thickness", "leaf_length", "spring_angle", "spring_radius", "bowl_mass"):
            assert getattr(under, word) == pytest.approx(getattr(own, word)), word
    assert designs.bowl_file(made, settings, built.sheet)  # it is read back and compared


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


def unit_settings(name):
    """The settings of a drive unit's bowl file."""
    return settings_of_text(drive_sizing.bowl_file(drive_sizing.unit(name)), "bowl.yaml")


def owned(name):
    """A bowl on a drive unit, and which keys its file gives."""
    settings = unit_settings(name)
    given = frozenset(one.key.name for one in settings if one.is_own)
    return calm_drive.PlainBowl(bowls.record(settings), given, None)


@pytest.mark.parametrize(("name", "frequency"), [("d300-100hz", 100.0), ("d300-60hz", 60.0)])
def test_a_design_keeps_an_owned_machine_and_looks_for_its_stroke(name, frequency):
    made = owned(name)
    slow, fast, strongest = (calm_drive.driven(made, velocity) for velocity in (0.05, 0.08, np.inf))
    for bowl in (slow, fast):
        assert bowl.drive.frequency == frequency
        assert bowl.drive.vibration_angle == pytest.approx(made.bowl.drive.vibration_angle)
    assert 1.0 < throw_number(slow) < throw_number(fast)
    assert calm_drive.speed(fast) >= 0.08
    assert strongest.drive.amplitude <= greatest_amplitude(made.bowl)


def test_a_frequency_controller_runs_an_owned_machine_below_its_natural_frequency():
    made = owned("d300-100hz")
    bowl = replace(made.bowl, sizing=replace(made.bowl.sizing, control="frequency"))
    driven = calm_drive.driven(replace(made, bowl=bowl), 0.06)
    natural = analyse_springs(made.bowl.machine).natural_frequency
    assert natural / driven.drive.frequency == pytest.approx(1.055, abs=1e-3)


def test_an_unknown_drive_unit_is_refused():
    assert drive_sizing.unit("D300-50Hz").frequency == 50.0
    with pytest.raises(ArgumentError, match="d300-100hz"):
        drive_sizing.unit("d301")
