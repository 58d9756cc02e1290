"""The machine that is drawn makes the drive that was tried, and every paper of it says the same."""

import json
import re
import shlex
from dataclasses import replace
from functools import reduce
from operator import attrgetter, getitem
from pathlib import Path

import awkward
import numpy as np
import pytest
import shapes
from design_counts import proved
from matplotlib.text import Text

from feederscrew import bowl as bowls
from feederscrew.arrivals.plate_test import throw_number
from feederscrew.base.errors import ArgumentError, FeederError
from feederscrew.bowl import reading
from feederscrew.bowl.reading import settings_of_text
from feederscrew.bowl.record import shares, vibration_angle
from feederscrew.bowl.size import Size
from feederscrew.bowl.verified import Status
from feederscrew.designing import calm_drive, design
from feederscrew.designing.record import Alternative
from feederscrew.machine import drive_sizing, springs
from feederscrew.machine import sheet as machines
from feederscrew.machine.drive_sizing import can_make
from feederscrew.machine.springs import analyse_springs, greatest_amplitude, leaf_stress, stroke
from feederscrew.motion import conveying as answer
from feederscrew.output import (
    bowl_sheet,
    design_pages,
    designs,
    machine,
    machine_figures,
    marking,
    tooling_drawing,
)
from feederscrew.resting.aspects import find
from feederscrew.sorting.orientations import CUT_BORDER_RADIUS_M

STEEL_PART = shapes.part(shapes.box(12.0, 10.0, 8.0))
ABS = 1050.0  # [kg/m3]
INERTIA = ABS / shapes.STEEL * STEEL_PART.inertia
PART = replace(STEEL_PART, density=ABS, mass=ABS * STEEL_PART.volume, inertia=INERTIA)
ONE = ("track.radius=150 mm", "track.climb=3.5 deg", "track.width=14 mm", "drive.frequency=50 Hz")
# makers' strokes peak to peak [mm], as the key sizing.greatest_acceleration names them
STROKES = {50.0: 2.0, 60.0: 1.5, 100.0: 0.6, 120.0: 0.4}
BOWL = """
drive: {amplitude: 0.42 mm, frequency: 50 Hz, vibration_angle: 25 deg}
track: {radius: 150 mm, climb: 3.7 deg, width: 14 mm, bank: 2 deg}
devices:
  - separation: {climb: -2 deg}
  - separation: {climb: 3.7 deg}
  - gap: 5 mm
"""
NUMBER = r"(-?\d+(?:\.\d+)?(?:e-?\d+)?)"
# each quantity as every paper says it: by the key of a document or of the bowl file, the row of a table, or
# the words around it
SAID = {
    "diameter": ("design bowl.diameter_mm", "bowl_solid diameter_mm", "file track.radius 2e3",
        "picture D #", "drawing Ø#", "quotation bowl diameter [mm]", "summary diameter [mm]"),
    "track width": ("design bowl.track_width_mm", "file track.width 1e3", "picture track #",
        "drawing track #", "quotation track width [mm]"),
    "climb": ("design bowl.climb_deg", "file track.climb deg", "picture climb #", "quotation climb [deg]",
        "drawing climb, bank\n#"),
    "turns": ("bowl turns", "bowl_solid solid_turns", "picture , # turns", "quotation turns",
        "drawing turns\n#"),
    "height of the outlet": ("bowl bowl_depth_mm", "bowl_solid outlet_height_mm",
        "file sizing.outlet_height 1e3", "drawing outlet # over", "quotation bowl depth [mm]"),
    "stroke": ("design bowl.peak_to_peak_mm", "bowl peak_to_peak_mm", "file drive.amplitude 2e3",
        "picture # mm peak to peak", "drawing : # mm peak to peak", "sheet stroke, peak to peak [mm]",
        "acceptance stroke at the rim, peak to peak"),
    "frequency": ("design bowl.frequency_hz", "bowl drive_frequency_hz", "file drive.frequency 1",
        "picture # Hz, ", "drawing drive\n# Hz", "acceptance frequency of the drive"),
    "angle at the track": ("design bowl.vibration_angle_deg",
        "design bowl.vibration_angle_at_the_track_deg", "bowl vibration_angle_deg",
        "file drive.vibration_angle deg", "picture #° to the track",
        "sheet vibration angle [deg]=# to the track", "drawing #° to the track",
        "summary vibration angle at the track [deg]", "acceptance vibration angle"),
    "angle at the springs": ("design bowl.vibration_angle_at_the_springs_deg", "bowl spring_angle_deg",
        "file machine.spring_angle deg", "sheet springs=motion there # deg", "picture #° at the springs",
        "drawing #° at the springs", "acceptance vibration angle at the springs"),
    "throw number": ("design bowl.throw_number", "bowl throw_number", "sheet G, throw number=, #",
        "summary throw number"),
    "radius of the springs": ("bowl spring_radius_mm", "file machine.spring_radius 1e3",
        "picture springs on\nradius #", "sheet springs=radius # mm"),
    "leaves": ("bowl leaves", "file machine.leaves 1", "picture # leaves", "sheet leaves=# of"),
    "natural frequency": ("bowl natural_frequency_hz", "sheet natural frequency [Hz]",
        "drawing natural frequency\n# Hz"),
    "mass of the bowl": ("bowl bowl_mass_kg", "bowl_solid solid_mass_kg", "file machine.bowl_mass 1",
        "picture bowl # kg", "drawing steel, # kg", "sheet on the springs, empty"),
    "inertia of the bowl": ("bowl bowl_inertia_kg_m2", "bowl_solid solid_inertia_kg_m2",
        "file machine.bowl_inertia 1", "picture kg, # kg m²", "drawing # kg m²"),
    "fill": ("bowl full_bowl.mass_kg", "picture full # kg", "sheet full bowl [kg]",
        "quotation full bowl [kg]", "drawing fill, hopper\n# kg"),
    "velocity": ("bowl velocity_mm_s", "picture # mm/s", "sheet velocity at this stroke [mm/s]"),
}  # fmt: skip
ROOT = Path(__file__).parents[2]
BLOCK = re.compile(r"```console\n\$ feeder (.*)\n((?:(?!```).*\n)*)```")
NUMBER_BOWL = re.compile(r"(?<![\w^])-?\d+(?:\.\d+)?(?!\w)")
NEAR = 0.02  # relative; the rate of a bowl left alone hangs on hops, and on the processor


def sized(bowl):
    rise = np.pi * 0.3 * np.tan(bowl.track.climb)
    return Size(0.3, {}, 0.014, 1e-3, 1e-3, bowl.track.climb, 0.09, 0.09 / rise, rise)


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
    first = machine.summary(sheet)["value"][:2]
    assert "42" in first[0] and "15.6" in first[1]
    document = machine.document(sheet)
    assert "15.6 deg to the track" in document["warnings"][0] and not document["springs_make_this_drive"]
    assert document["drive_of_the_springs"]["throw_number"] == pytest.approx(other.machine.throw_number)


@pytest.fixture(scope="module")
def two_axis():
    phased = ("drive.vibration_angle=16 deg", "drive.phase=-60 deg", "drive.amplitude=0.322 mm")
    one = proved(PART, bowls.read(None, (*ONE, *phased)))
    built = design.build_machine(one, ())
    return design.with_machine(one, built), built


def test_a_drive_out_of_phase_stands_first_in_every_output_and_its_bowl_is_filled_and_tuned(two_axis):
    study, built = two_axis
    sheet = built.sheet
    first, table, document = machine.summary(sheet), designs.summary(study), designs.document(study)
    assert (first["quantity"][0], table["quantity"][1]) == ("drive", "drive")
    assert "-60 deg" in first["value"][0] and "phase -60 deg" in table["value"][1]
    own = machine.document(sheet)
    assert (own["drive_kind"], own["phase_deg"]) == ("two-axis drive", pytest.approx(-60.0))
    assert document["bowl"]["phase_deg"] == pytest.approx(-60.0)
    assert any("phase" in text.get_text() for text in machine_figures.bowl(sheet).texts)
    for text in (
        first["value"][0],
        *[line for line in document["warnings"] if "magnets" in line][:1],
        "\n".join(bowl_sheet.draw_sheets(built.drawn).texts(0)),
        design_pages.page(study, built).partition("leaves as")[0],
        designs.bowl_file(study, (), sheet).splitlines()[1],
    ):
        assert "two magnets" in text
    assert any("two magnets" in line for line in document["warnings"])
    # a block of ABS of 1.05 g/cm3, half of it air between: not solid steel
    fill, rules = sheet.fill, sheet.bowl.sizing
    assert fill.mass / fill.volume == pytest.approx(0.5 * ABS, rel=1e-6)
    assert fill.volume == pytest.approx(np.pi * 0.15**2 * sheet.depth * 0.3333, rel=1e-6)
    assert rules.least_detuning <= sheet.detuning <= rules.greatest_detuning
    assert sheet.stress <= rules.fatigue_stress
    assert sheet.stroke.peak_to_peak == pytest.approx(2.0 * study.bowl.drive.amplitude)


def test_a_bowl_of_the_library_has_the_machine_of_the_command():
    bowl = replace(awkward.bowl("machine.leaves=7", "sizing.sheet=2.5 mm", "track.hand=left"), devices=())
    again = bowls.record(design.settings_of(bowl, {"drive.vibration_angle"}))
    for name in ("drive", "friction", "track", "machine", "sizing"):
        for field, value in vars(getattr(bowl, name)).items():
            told = getattr(getattr(again, name), field)
            assert told == (pytest.approx(value, rel=1e-9) if isinstance(value, float) else value), field


def test_a_bowl_without_a_part_says_what_it_assumes():
    given = "sizing.fill_density=1.05 g/cm3"
    for texts, density, said in (((), 7850.0, "steel assumed"), ((given,), ABS, "fill_density")):
        sheet = machines.machine(bowls.settings(None, (*ONE, *texts)))
        assert sheet.fill.mass / sheet.fill.volume == pytest.approx(0.5 * density)
        assert said in rows(machine.summary(sheet))["full bowl [kg]"]


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


def test_a_design_whose_drawn_springs_do_not_make_its_angle_holds_but_for_its_machine():
    steep = (*ONE, "drive.vibration_angle=35 deg", "drive.amplitude=0.15 mm")
    one = proved(PART, bowls.read(None, steep))
    assert one.status == "holds"
    settings = bowls.settings(None, steep)
    row = Alternative(1, one.status, chain=("gap: 9 mm",))
    found = design.with_machine(replace(one, alternatives=(row,)), design.Built(machines.machine(settings)))
    assert found.status is Status.NO_MACHINE and "the springs make it" in found.why
    assert found.verdict.tooling_status is Status.HOLDS  # what was tried is not denied
    assert found.alternatives[0].status is Status.NO_MACHINE and found.alternatives[0].reasons
    assert found.cause == "drive" and found.nearest.rate == one.request.target
    assert "springs that stand at" in found.nearest.change and found.nearest.draws_held == 20
    # the machine that is named stands no steeper than the rules let it, and makes the drive, on leaves that
    # last: its angle and circle are those of words
    angle, circle = (
        float(text)
        for text in re.findall(r"at ([\d.]+) deg on a circle of ([\d.]+)", found.nearest.change)[0]
    )
    assert np.radians(angle) <= found.bowl.sizing.steepest_spring_angle
    bowl = replace(
        found.bowl,
        machine=replace(found.bowl.machine, spring_angle=np.radians(angle), spring_radius=5e-4 * circle),
    )
    assert can_make(bowl) is None and can_make(found.bowl) is not None
    # papers of its tooling bear no mark: its trial holds
    assert marking.of_trial(designs.trial_of(found)) == ""
    # at 50 deg the springs would stand steeper on every circle
    steeper = bowls.record(bowls.settings(None, (*steep, "drive.vibration_angle=50 deg")))
    assert design.nearest_machine(steeper) == "" != design.nearest_machine(bowls.record(settings))


@pytest.mark.parametrize("name", [None, "d300-60hz"])
def test_the_machine_that_is_drawn_makes_the_drive_that_is_chosen(name):
    """Angle, tuning, stress and pull with the mass of the solid; the leaves of an owned machine are kept."""
    settings = bowls.settings(None) if name is None else unit_settings(name)
    given = frozenset(one.key.name for one in settings if one.is_own)
    bowl = calm_drive.drive_at(calm_drive.section(PART, find(PART), bowls.record(settings), given), 0.08)
    study = proved(PART, bowl)
    built = design.build_machine(study, settings)
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


@pytest.mark.parametrize("unit", drive_sizing.DRIVE_UNITS, ids=lambda one: one.name)
def test_the_bowl_file_of_a_drive_unit_is_a_tuned_machine(unit):
    bowl = bowls.record(settings_of_text(drive_sizing.bowl_file(unit), "bowl.yaml"))
    assert bowl.drive.frequency == unit.frequency in STROKES
    assert 2.0 * bowl.track.radius == pytest.approx(unit.diameter) and can_make(bowl) is None
    assert 15.0 < np.degrees(bowl.drive.vibration_angle) < 25.0
    assert np.degrees(bowl.machine.spring_angle) == pytest.approx(30.0)
    assert 1.03 <= analyse_springs(bowl.machine).natural_frequency / unit.frequency <= 1.08
    assert bowl.machine.leaves <= 12
    assert 2e3 * greatest_amplitude(bowl) == pytest.approx(STROKES[unit.frequency], rel=1e-6)
    assert bowl.sizing.mains_frequency == unit.mains and bowl.machine.base_mass > 3.0 * bowl.machine.bowl_mass


def unit_settings(name):
    return settings_of_text(drive_sizing.bowl_file(drive_sizing.unit(name)), "bowl.yaml")


def owned(name):
    settings = unit_settings(name)
    given = frozenset(one.key.name for one in settings if one.is_own)
    return calm_drive.PlainBowl(bowls.record(settings), given)


@pytest.mark.parametrize(("name", "frequency"), [("d300-100hz", 100.0), ("d300-60hz", 60.0)])
def test_a_design_keeps_an_owned_machine_and_looks_for_its_stroke(name, frequency):
    made = owned(name)
    slow, fast, strongest = (calm_drive.drive_at(made, velocity) for velocity in (0.05, 0.08, np.inf))
    for bowl in (slow, fast):
        assert bowl.drive.frequency == frequency
        assert bowl.drive.vibration_angle == pytest.approx(made.bowl.drive.vibration_angle)
    assert 1.0 < throw_number(slow) < throw_number(fast) and calm_drive.speed(fast) >= 0.08
    assert strongest.drive.amplitude <= greatest_amplitude(made.bowl)


def test_a_frequency_controller_runs_an_owned_machine_below_its_natural_frequency():
    made = owned("d300-100hz")
    bowl = replace(made.bowl, sizing=replace(made.bowl.sizing, control="frequency"))
    driven = calm_drive.drive_at(replace(made, bowl=bowl), 0.06)
    natural = analyse_springs(made.bowl.machine).natural_frequency
    assert natural / driven.drive.frequency == pytest.approx(1.055, abs=1e-3)
    assert drive_sizing.unit("D300-50Hz").frequency == 50.0
    with pytest.raises(ArgumentError, match="d300-100hz"):
        drive_sizing.unit("d301")


@pytest.fixture(scope="module")
def papers(tmp_path_factory):
    """What a design writes: documents and tables as they are, pictures and the drawing as their words."""
    path = tmp_path_factory.mktemp("papers") / "bowl.yaml"
    path.write_text(BOWL)
    study = proved(STEEL_PART, bowls.read(path))
    built = design.build_machine(study, ())
    assert not built.why, built.why
    study = design.with_machine(study, built)
    offered = {one.name: one for one in design_pages.offers(study, (), built)}
    written = path.parent / "design.yaml"
    written.write_text(offered["design.yaml"].make())
    return {
        "page": offered["design.html"].make(),
        "files": set(offered),
        "study": study,
        "built": built,
        **{name: json.loads(offered[f"{name}.json"].make()) for name in ("design", "bowl", "bowl_solid")},
        "summary": rows(designs.summary(study)),
        "acceptance": rows(offered["acceptance.csv"].view(), "computed"),
        "sheet": rows(machine.summary(built.sheet)),
        "quotation": rows(machine.summary(built.drawn)),
        "picture": words(machine_figures.bowl(built.sheet)),
        "drawing": drawn_words(built.drawn),
        "file": bowls.read(written),
        "path": written,
    }


def rows(frame, column="value"):
    return dict(zip(frame["quantity"], frame[column]))


def words(figure):
    return "\n".join(one.get_text() for one in figure.findobj(Text))


def drawn_words(study, tried=None):
    drawing = bowl_sheet.draw_sheets(study, tried)
    return "\n".join(text for sheet in range(len(drawing.sheets)) for text in drawing.texts(sheet))


def number(pattern, text):
    """The number of a pattern, where '#' stands for it."""
    escaped = re.escape(pattern).replace(r"\#", NUMBER)
    assert re.search(escaped, text), f"{pattern!r} is not in {text!r}"
    return float(re.search(escaped, text)[1])


def said(papers, source):
    """What one paper says: of a bowl file times a factor, of a table the number in the words behind '='."""
    paper, what = source.split(" ", 1)
    if paper == "file":
        name, factor = what.split()
        return attrgetter(name)(papers["file"]) * (np.degrees(1.0) if factor == "deg" else float(factor))
    if isinstance(papers[paper], str):
        return number(what, papers[paper])
    row, _, pattern = what.partition("=")
    cell = reduce(getitem, row.split("."), papers[paper])
    return number(pattern or "#", cell) if isinstance(cell, str) else float(cell)


@pytest.mark.parametrize("quantity", SAID)
def test_every_paper_of_a_design_says_one_number(papers, quantity):
    """Rounded to three digits at the coarsest."""
    values = [said(papers, source) for source in SAID[quantity]]
    assert values == pytest.approx([values[0]] * len(values), rel=5.1e-3)


def test_edges_title_block_and_page_are_of_the_trial(papers):
    study = papers["study"]
    assert study.status == "holds" and study.drive_mismatch is None
    assert papers["bowl"]["springs_make_this_drive"] and papers["bowl"]["drive_kind"] == "leaf-spring drive"
    for text in (papers["drawing"], tooling_drawing.SHOP):
        broken = re.search(r"edges broken at most ([\d.]+) mm", text)[1]
        assert broken == f"{1e3 * CUT_BORDER_RADIUS_M:g}"
    tried = designs.trial_of(papers["study"])
    drawn = drawn_words(papers["built"].drawn, tried)
    assert re.search(r"orientation\nA@0\n", drawn) and re.search(r"rate of its trial\n60/min", drawn)
    assert "all that pass" not in drawn and "FALLS SHORT" not in drawn
    short = drawn_words(papers["built"].drawn, replace(tried, status="falls short"))
    assert "FALLS SHORT - not for manufacture" in short
    # the links lead to files that lie beside the page; the springs are those of the bowl's own sheet
    page = papers["page"]
    links = re.findall(r'<td><a href="([^"]+)">', page)
    assert {"bowl.pdf", "bowl.dxf", "bowl.stl", "design.yaml"} <= set(links) <= papers["files"]
    springs = page.partition('id="springs"')[2].partition("</section>")[0]
    for quantity in ("springs", "leaves", "vibration angle [deg]"):
        assert f">{papers['sheet'][quantity]}</td>" in springs
    assert 'id="bowl.png"' in springs


def test_the_file_of_a_design_makes_the_same_bowl_and_warns_of_the_same_again(papers, run):
    """Height, turns, mass and fill of the solid that `feeder bowl` makes of the part and the file."""
    alone = json.loads(run("bowl", "--config", papers["path"], "--format", "json").stdout)
    own = papers["bowl"]
    assert set(alone["warnings"]) <= set(papers["study"].warnings)
    assert alone["turns"] is None  # the devices lead the track another way
    assert alone["bowl_depth_mm"] == pytest.approx(own["bowl_depth_mm"], rel=1e-6)
    assert alone["full_bowl"]["mass_kg"] == pytest.approx(own["full_bowl"]["mass_kg"], rel=1e-5)
    assert alone["spring_angle_deg"] == pytest.approx(own["spring_angle_deg"])
    # it takes the drive that was tried, and says the smaller stroke of the static rule
    own = papers["study"]
    settings = reading.settings_of_text(papers["path"].read_text(), "design.yaml")
    sheet = machines.size_machine(settings, STEEL_PART, own.request.target, as_tried=True)
    static = machines.size_machine(settings, STEEL_PART, own.request.target)
    assert sheet.bowl.drive == own.bowl.drive and static.bowl.drive.amplitude < own.bowl.drive.amplitude
    tried = "the drive is the one that was tried, 0.84 mm peak to peak: the static rule takes"
    assert sheet.remarks[0] == f"{tried} {2e3 * static.bowl.drive.amplitude:.3g} mm for 30/min"
    assert set(sheet.remarks) <= set(own.warnings)
    assert sheet.fill.mass == pytest.approx(papers["bowl"]["full_bowl"]["mass_kg"], rel=1e-6)


@pytest.mark.thorough
def test_the_page_is_true(run, monkeypatch):
    examples = BLOCK.findall((ROOT / "docs/bowl.md").read_text())
    assert len(examples) == 2
    monkeypatch.chdir(ROOT)
    for line, shown in examples:
        printed = run(*shlex.split(line)).stdout
        whole = not shown.endswith("...\n")  # one that is cut keeps its first lines
        for was, now in zip(shown.removesuffix("...\n").splitlines(), printed.splitlines(), strict=whole):
            assert " ".join(NUMBER_BOWL.sub("#", was).split()) == " ".join(NUMBER_BOWL.sub("#", now).split())
            if "left alone" not in was:
                before, after = (np.array(NUMBER_BOWL.findall(one), dtype=float) for one in (was, now))
                np.testing.assert_allclose(after, before, rtol=NEAR, atol=1e-9)


def test_of_devices_that_were_tried_no_sheet_says_that_feeder_trial_tries_them():
    """The page of a design of 25 minutes of trials sent its reader to feeder trial with each device."""
    drive = "amplitude: 0.6 mm, frequency: 50 Hz, vibration_angle: 25 deg"
    text = f"drive: {{{drive}}}\ndevices:\n  - narrowed_track: 18 mm\n"
    sheet = machines.machine(settings_of_text(text, "bowl.yaml"))
    for as_tried in (False, True):
        remarks = replace(sheet, as_tried=as_tried).remarks
        assert any("feeder trial" in remark for remark in remarks) != as_tried


def test_a_bowl_that_was_tried_is_sized_though_the_static_rule_lets_nothing_through():
    """The rule warns, and names what it finds; it refuses the same file where nothing was tried."""
    text = BOWL.replace("gap: 5 mm", "narrowed_track: 1 mm")
    settings = settings_of_text(text, "bowl.yaml")
    with pytest.raises(FeederError):
        machines.size_machine(settings, STEEL_PART, 0.5)
    sheet = machines.size_machine(settings, STEEL_PART, 0.5, as_tried=True)
    assert sheet.bowl.drive.amplitude == pytest.approx(0.42e-3) and sheet.order.target == 0.5
    assert sheet.remarks[0].startswith("the drive is the one that was tried, 0.84 mm peak to peak")
    assert "static rule finds none for 30/min" in sheet.remarks[0]
    assert sheet.as_tried and not machines.machine(settings).as_tried
    # it is sized for the parts that the track carries, and filled with them
    assert sheet.order.flow.parts > 0.0 and sheet.filled_with == machines.PART
