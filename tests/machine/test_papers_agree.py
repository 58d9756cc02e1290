"""Every paper of one run says the same of one quantity: documents, tables, pictures, drawing, bowl file."""

import json
import re
import shlex
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import shapes
from design_counts import proved
from matplotlib.text import Text

from feederscrew import bowl as bowls
from feederscrew.bowl import reading
from feederscrew.designing import design
from feederscrew.output import bowl_sheet, design_pages, designs, machine, machine_figures, tooling_drawing
from feederscrew.studies import bowl as machines
from feederscrew.tooling.orientations import CUT_BORDER_RADIUS_M

PART = shapes.part(shapes.box(12.0, 10.0, 8.0))
BOWL = """
drive: {amplitude: 0.42 mm, frequency: 50 Hz, vibration_angle: 25 deg}
track: {radius: 150 mm, climb: 3.7 deg, width: 14 mm, bank: 2 deg}
devices:
  - separation: {climb: -2 deg}
  - separation: {climb: 3.7 deg}
  - gap: 5 mm
"""
NUMBER = r"(-?\d+(?:\.\d+)?(?:e-?\d+)?)"


@pytest.fixture(scope="module")
def papers(tmp_path_factory):
    """What a design writes: documents and tables as they are, pictures and the drawing as their words."""
    path = tmp_path_factory.mktemp("papers") / "bowl.yaml"
    path.write_text(BOWL)
    study = proved(PART, bowls.read(path))
    built = design.built(study, ())
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


def said(p):
    """Each quantity as every paper says it."""
    design, bowl, solid, file = p["design"]["bowl"], p["bowl"], p["bowl_solid"], p["file"]
    sheet, long, picture, drawing = p["sheet"], p["quotation"], p["picture"], p["drawing"]
    drive, track, made, mm = file.drive, file.track, file.machine, 1e3
    yield "diameter", (
        design["diameter_mm"], solid["diameter_mm"], 2.0 * mm * track.radius, float(number("D #", picture)),
        number("Ø#", drawing), number("#", long["bowl diameter [mm]"]),
        number("#", p["summary"]["diameter [mm]"]),
    )  # fmt: skip
    yield "track width", (
        design["track_width_mm"], mm * track.width, number("track #", picture), number("track #", drawing),
        number("#", long["track width [mm]"]),
    )  # fmt: skip
    yield "climb", (
        design["climb_deg"], np.degrees(track.climb), number("climb #", picture),
        number("#", long["climb [deg]"]), number("climb, bank\n#", drawing),
    )  # fmt: skip
    yield "turns", (
        bowl["turns"], solid["solid_turns"], number(", # turns", picture), number("#", long["turns"]),
        number("turns\n#", drawing),
    )  # fmt: skip
    yield "height of the outlet", (
        bowl["bowl_depth_mm"], solid["outlet_height_mm"], mm * file.sizing.outlet_height,
        number("outlet # over", drawing), number("#", long["bowl depth [mm]"]),
    )  # fmt: skip
    yield "stroke", (
        design["peak_to_peak_mm"], bowl["peak_to_peak_mm"], 2.0 * mm * drive.amplitude,
        number("# mm peak to peak", picture), number(": # mm peak to peak", drawing),
        number("#", sheet["stroke, as on a sticker [mm]"]),
        float(p["acceptance"]["stroke on the sticker, peak to peak"]),
    )  # fmt: skip
    yield "frequency of the drive", (
        design["frequency_hz"], bowl["drive_frequency_hz"], drive.frequency, number("# Hz, ", picture),
        number("drive\n# Hz", drawing), float(p["acceptance"]["frequency of the drive"]),
    )  # fmt: skip
    yield "angle at the track", (
        design["vibration_angle_deg"], design["vibration_angle_at_the_track_deg"],
        bowl["vibration_angle_deg"],
        np.degrees(drive.vibration_angle), number("# to the track", sheet["vibration angle [deg]"]),
        number("#° to the track", picture), number("#° to the track", drawing),
        number("#", p["summary"]["vibration angle at the track [deg]"]),
        float(p["acceptance"]["vibration angle"]),
    )  # fmt: skip
    yield "angle at the springs", (
        design["vibration_angle_at_the_springs_deg"], bowl["spring_angle_deg"],
        np.degrees(made.spring_angle),
        number("motion there # deg", sheet["springs"]), number("#° at the springs", picture),
        number("#° at the springs", drawing), float(p["acceptance"]["vibration angle at the springs"]),
    )  # fmt: skip
    yield "throw number", (
        design["throw_number"], bowl["throw_number"], number(", #", sheet["G, throw number"]),
        number("#", p["summary"]["throw number"]),
    )  # fmt: skip
    yield "radius of the springs", (
        bowl["spring_radius_mm"], mm * made.spring_radius, number("springs on\nradius #", picture),
        number("radius # mm", sheet["springs"]),
    )  # fmt: skip
    yield "leaves", (
        bowl["leaves"], made.leaves, number("# leaves", picture), number("# of", sheet["leaves"]),
    )  # fmt: skip
    yield "natural frequency", (
        bowl["natural_frequency_hz"], number("#", sheet["natural frequency [Hz]"]),
        number("natural frequency\n# Hz", drawing),
    )  # fmt: skip
    yield "mass of the bowl", (
        bowl["bowl_mass_kg"], solid["solid_mass_kg"], made.bowl_mass, number("bowl # kg", picture),
        number("steel, # kg", drawing), number("#", sheet["on the springs, empty"]),
    )  # fmt: skip
    yield "inertia of the bowl", (
        bowl["bowl_inertia_kg_m2"], solid["solid_inertia_kg_m2"], made.bowl_inertia,
        number("kg, # kg m²", picture), number("# kg m²", drawing),
    )  # fmt: skip
    yield "fill", (
        bowl["full_bowl"]["mass_kg"], number("full # kg", picture), number("#", sheet["full bowl [kg]"]),
        number("#", long["full bowl [kg]"]), number("fill, hopper\n# kg", drawing),
    )  # fmt: skip
    yield "velocity", (
        bowl["velocity_mm_s"], number("# mm/s", picture),
        number("#", sheet["velocity at this stroke [mm/s]"]),
    )  # fmt: skip


def test_every_paper_of_a_design_says_one_number(papers):
    """Rounded to three digits at the coarsest."""
    for name, values in said(papers):
        assert values == pytest.approx([values[0]] * len(values), rel=5.1e-3), name
    assert len(list(said(papers))) == 17


def test_a_design_of_an_angle_that_a_larger_circle_makes_holds_and_its_edges_are_as_tried(papers):
    study = papers["study"]
    assert study.status == "holds" and study.drive_mismatch is None
    assert papers["bowl"]["springs_make_this_drive"] and papers["bowl"]["drive_kind"] == "leaf-spring drive"
    for text in (papers["drawing"], tooling_drawing.SHOP):
        broken = re.search(r"edges broken at most ([\d.]+) mm", text)[1]
        assert broken == f"{1e3 * CUT_BORDER_RADIUS_M:g}"


def test_the_file_of_a_design_makes_the_same_bowl_again(papers, run):
    """Height, turns, mass and fill of the solid that `feeder bowl` makes of the part and the file."""
    alone, own = (
        json.loads(run("bowl", "--config", papers["path"], "--format", "json").stdout),
        papers["bowl"],
    )
    assert set(alone["warnings"]) <= set(papers["study"].warnings)
    assert alone["turns"] is None  # the devices lead the track another way
    assert alone["bowl_depth_mm"] == pytest.approx(own["bowl_depth_mm"], rel=1e-6)
    assert alone["full_bowl"]["mass_kg"] == pytest.approx(own["full_bowl"]["mass_kg"], rel=1e-5)
    assert alone["spring_angle_deg"] == pytest.approx(own["spring_angle_deg"])


def test_a_design_warns_of_what_feeder_bowl_warns_of_for_its_part_and_rate(papers):
    """It takes the drive that was tried, and says the smaller stroke of the static rule."""
    own = papers["study"]
    settings = reading.settings_of_text(papers["path"].read_text(), "design.yaml")
    sheet = machines.bowl(settings, PART, own.request.target, as_tried=True)
    static = machines.bowl(settings, PART, own.request.target)
    assert sheet.bowl.drive == own.bowl.drive and static.bowl.drive.amplitude < own.bowl.drive.amplitude
    stroke = 2e3 * static.bowl.drive.amplitude
    assert sheet.remarks[0] == (
        "the drive is the one that was tried, 0.84 mm peak to peak: "
        f"the static rule takes {stroke:.3g} mm for 30/min"
    )
    assert set(sheet.remarks) <= set(own.warnings)
    assert sheet.fill.mass == pytest.approx(papers["bowl"]["full_bowl"]["mass_kg"], rel=1e-6)


def test_the_title_block_has_orientation_and_rate_of_the_trial(papers):
    tried = designs.trial_of(papers["study"])
    drawn = drawn_words(papers["built"].drawn, tried)
    assert re.search(r"orientation\nA@0\n", drawn) and re.search(r"rate of its trial\n60/min", drawn)
    assert "all that pass" not in drawn and "FALLS SHORT" not in drawn
    short = drawn_words(papers["built"].drawn, replace(tried, status="falls short"))
    assert "FALLS SHORT - not for manufacture" in short


def test_the_page_shows_the_springs_and_leads_to_each_file_to_build_from(papers):
    """The links lead to files that lie beside the page; the springs are those of the bowl's own sheet."""
    page = papers["page"]
    links = re.findall(r'<td><a href="([^"]+)">', page)
    assert {"bowl.pdf", "bowl.dxf", "bowl.stl", "design.yaml"} <= set(links) <= papers["files"]
    springs = page.partition('id="springs"')[2].partition("</section>")[0]
    for quantity in ("springs", "leaves", "vibration angle [deg]"):
        assert f"<td>{papers['sheet'][quantity]}</td>" in springs
    assert 'id="bowl.png"' in springs


ROOT = Path(__file__).parents[2]
BLOCK = re.compile(r"```console\n\$ feeder (.*)\n((?:(?!```).*\n)*)```")
NUMBER_BOWL = re.compile(r"(?<![\w^])-?\d+(?:\.\d+)?(?!\w)")
NEAR = 0.02  # relative; the rate of a bowl left alone hangs on hops, and on the processor


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
