"""What the library hands over: a short text, the table and the picture of the command; faults by argument."""

import html
import json
import re
from dataclasses import replace

import pytest
import shapes

import feederscrew as fs
from feederscrew.output import tables

BOWL = fs.read_bowl(None, ("track.width=40 mm", "drive.amplitude=0.05 mm"))


@pytest.fixture(scope="module")
def part():
    return shapes.part(shapes.box(8.0, 12.0, 20.0))


STUDIES = {  # function: its record, and the pictures by name
    "aspects": (lambda part: fs.aspects(part, drops=0), ["probabilities"]),
    "inertia": (fs.inertia, []),
    "drop": (lambda part: fs.drop(part, drops=20), ["drop"]),
    "slide": (lambda _: fs.slide(BOWL, ["20 deg"]), ["slide_curves"]),
    "convey": (lambda _: fs.convey(BOWL), ["convey"]),
    "floor": (lambda part: fs.floor(part, BOWL, heading="10 deg"), ["floor_plan", "floor_heading"]),
    "track": (lambda part: fs.track(part, BOWL, "A"), ["track_part", "track_cycle"]),
    "headings": (lambda part: fs.headings(part, BOWL), ["headings_A"]),
}


@pytest.mark.parametrize("name", STUDIES)
def test_a_record_is_short_has_a_table_and_its_pictures(part, name):
    make, pictures = STUDIES[name]
    record = make(part)
    assert len(repr(record)) <= 400 and "\n" not in repr(record)
    frame = record.to_frame()
    assert len(frame) >= 1 and len(frame.columns) >= 2
    for picture in pictures:
        assert record.plot(picture).get_axes(), picture
    with pytest.raises(fs.FeederError, match=f"^name: {type(record).__name__} has no picture 'pie'"):
        record.plot("pie")
    with pytest.raises(fs.FeederError, match="has no table 'pie'"):
        record.to_frame("pie")


def test_a_table_is_the_file_of_its_command(run, tmp_path):
    shapes_file = tmp_path / "box.stl"
    shapes.box(8.0, 12.0, 20.0).export(shapes_file)
    drive = ("--set", "track.width=40 mm", "--set", "drive.amplitude=0.05 mm")
    said = run("headings", shapes_file, *drive, "--format", "csv", "-q").stdout
    table = fs.headings(fs.load(shapes_file), BOWL).to_frame()
    assert tables.text(tables.frame(dict(table)), "csv") == said
    told = json.loads(run("inertia", shapes_file, "--format", "json", "-q").stdout)
    assert told["mass_g"] == pytest.approx(1e3 * fs.load(shapes_file).mass)


NOTEBOOK_STUDIES = {  # function: its record, and what its text says
    "part": (lambda part: part, "8 x 12 x 20 mm"),
    "bowl": (lambda _: BOWL, "2 overrides: amplitude 0.05 mm at 50 Hz"),
    "changed bowl": (lambda _: replace(BOWL, gravity=9.8), "changed"),
    "aspects": (lambda part: fs.aspects(part, drops=0), r"part rests on .*[ABC] \d\d(\.\d)? %, [ABC] "),
    "shares": (lambda part: fs.shares(part, BOWL, launch="feed", rule="csa"), r"[ABC] \d\d(\.\d)? %, [ABC] "),
    "find_aspects": (lambda part: fs.find_aspects(part), r"[ABC] \d\d(\.\d)? %, [ABC] "),
    "inertia": (fs.inertia, r"\d g, centre of mass .* principal moments"),
    "drop": (lambda part: fs.drop(part, drops=20), r"20 drops, [ABC] \d+"),
    "shake": (lambda part: fs.shake(part, BOWL, drops=6, seconds=0.2), r"throw number 0\.\d+: [ABC] \d+"),
    "slide": (lambda _: fs.slide(BOWL, ["20 deg"]), "at 20 deg"),
    "convey": (lambda _: fs.convey(BOWL, amplitude="0.3 mm"), r"\d mm/s up the track, periodic"),
    "floor": (lambda part: fs.floor(part, BOWL, "A", heading="10 deg"), "on A at 10 deg: "),
    "track": (lambda part: fs.track(part, BOWL, "A"), r"on A at heading [\d.]+ deg: "),
    "headings": (lambda part: fs.headings(part, BOWL, "A"), r"A at [\d.]+, [\d.]+ deg"),
    "rate": (
        lambda part: fs.rate(part, BOWL, "A", rule="csa", amplitude="0.3 mm"),
        r"A at heading [\d.]+ deg: [\d.]+ parts/min \([\d.]+ to [\d.]+\), efficiency \d+",
    ),
}


@pytest.mark.parametrize("name", NOTEBOOK_STUDIES)
def test_a_record_says_its_answer_and_shows_its_table(part, name):
    make, says = NOTEBOOK_STUDIES[name]
    record = make(part)
    text = repr(record)
    assert re.search(says, text), text
    assert len(text) < 600 and "array>" not in text and "\n" not in text
    shown = record._repr_html_()
    assert html.escape(text) in shown
    if name == "part":
        assert 'src="data:image/png;base64,' in shown and len(shown) < 60_000
    else:
        assert "<table" in shown and "<td>" in shown


def test_what_a_file_is_called_is_escaped(part):
    named = replace(part, name="<b>x\x1b[31m</b>", material="<script>alert(1)</script>")
    for shown in (
        named._repr_html_(),
        fs.inertia(named)._repr_html_(),
        fs.aspects(named, drops=0)._repr_html_(),
    ):
        assert "<b>" not in shown and "<script" not in shown and "\x1b" not in shown
    assert "\x1b" not in repr(named)


def test_a_bowl_shows_what_was_given(tmp_path):
    (tmp_path / "mine.yaml").write_text("drive: {frequency: 60 Hz}\ndevices:\n  - wiper: 10 mm\n")
    bowl = fs.read_bowl(tmp_path / "mine.yaml", amplitude="0.3 mm")
    assert re.search(r"mine\.yaml, 1 override: amplitude 0\.3 mm at 60 Hz .* devices: wiper", repr(bowl))
    shown = bowl._repr_html_()
    assert "drive.frequency" in shown and "wiper: 10 mm" in shown and "track.width" not in shown


def test_a_design_is_a_record_too(part):
    from feederscrew.designing.families import FamilyStudy
    from feederscrew.designing.record import DesignRequest, DesignStudy, NearestDesign

    near = NearestDesign(20.0 / 60.0, "a lower rate")
    study = DesignStudy(part, DesignRequest(target=1.0), None, None, None, nearest=near)
    assert re.search(r"DesignStudy\(part: none - .*nearest that holds: 20/min", repr(study))
    assert "<table" in study._repr_html_()
    family = FamilyStudy((study,))
    assert repr(family).startswith("FamilyStudy(none, ") and "<table" in family._repr_html_()
